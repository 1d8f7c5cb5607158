// The system error that stands: the one that the front panel shows and that every acknowledgement carries.
// In: numbers [L2770]. Out: the gravest of them. Never decides what an error stops or whether it can be reset.
#pragma once

#include <cstdint>

#include "gateway/core/instant.hpp"

namespace axisgate::pacontrol::twin {

class SystemError {
public:
    /// `shown`, `cleared`: how long after a change the control shows the new number, or that there is none.
    explicit SystemError(Duration shown = {}, Duration cleared = {}) : shown_after_(shown), cleared_after_(cleared) {}

    [[nodiscard]] std::uint16_t number() const noexcept { return number_; }  ///< 1..999, 0: none
    [[nodiscard]] bool stands() const noexcept { return number_ != 0; }
    /// As everybody is told: behind the number, as of the last `follow`.
    [[nodiscard]] std::uint16_t shown() const noexcept {
        return shown_after_ == Duration::zero() && cleared_after_ == Duration::zero() ? number_ : shown_;
    }
    void follow(Instant now) noexcept {
        if (number_ != coming_) {
            coming_ = number_;
            due_ = now + (number_ == 0 ? cleared_after_ : shown_after_);
        }
        if (now >= due_) shown_ = coming_;
    }
    /// When another number is shown; `never`.
    [[nodiscard]] Instant due() const noexcept { return shown() == number_ || shown_ == coming_ ? never : due_; }
    /// Power on: there is none, and none is shown.
    void forget() noexcept { number_ = shown_ = coming_ = 0; }
    /// Of two the graver class stays: the lower number.
    void note(std::uint16_t number) noexcept {
        if (number_ == 0 || number < number_) number_ = number;
    }
    void clear() noexcept { number_ = 0; }

private:
    Duration shown_after_, cleared_after_;
    Instant due_{};
    std::uint16_t number_ = 0, shown_ = 0, coming_ = 0;
};

}  // namespace axisgate::pacontrol::twin
