// The system error that stands: the one that the front panel shows and that every acknowledgement carries.
// In: numbers [L2770]. Out: the gravest of them. Never decides what an error stops or whether it can be reset.
#pragma once

#include <cstdint>

namespace axisgate::pacontrol::twin {

class SystemError {
public:
    [[nodiscard]] std::uint16_t number() const noexcept { return number_; }  ///< 1..999, 0: none
    [[nodiscard]] bool stands() const noexcept { return number_ != 0; }
    /// Of two the graver class stays: the lower number.
    void note(std::uint16_t number) noexcept {
        if (number_ == 0 || number < number_) number_ = number;
    }
    void clear() noexcept { number_ = 0; }

private:
    std::uint16_t number_ = 0;
};

}  // namespace axisgate::pacontrol::twin
