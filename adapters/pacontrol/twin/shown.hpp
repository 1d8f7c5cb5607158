// What the control shows of an axis, where that is not its state of the moment: a status that follows late, and a position that is
// refreshed now and then. Without the freedoms of AxisModel both are the state itself, and nothing here is used.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "gateway/core/instant.hpp"

namespace axisgate::pacontrol::twin {

/// A value that everybody sees `behind` the instant at which it changed.
template <class T>
class Delayed {
public:
    explicit Delayed(Duration behind) : behind_(behind) {}
    [[nodiscard]] bool delays() const noexcept { return behind_ > Duration::zero(); }
    /// As of the last `follow`.
    [[nodiscard]] const T& shown() const noexcept { return shown_; }
    /// It is `value` now. To be called at each instant at which it may have changed, and before it is asked for.
    void follow(const T& value, Instant now) {
        if (!delays()) return;
        if (value != (changes_.empty() ? shown_ : changes_.back().value)) changes_.push_back({now + behind_, value});
        while (!changes_.empty() && changes_.front().at <= now) {
            shown_ = changes_.front().value;
            changes_.pop_front();
        }
    }
    void set(const T& value) {
        changes_.clear();
        shown_ = value;
    }

private:
    struct Change {
        Instant at;
        T value;
    };
    Duration behind_;
    T shown_{};
    std::deque<Change> changes_;  ///< that are not shown yet; as many as happen within `behind_`
};

/// A value that everybody sees as it was at the last multiple of a period.
class Sampled {
public:
    explicit Sampled(Duration period) : period_(period) {}
    [[nodiscard]] bool samples() const noexcept { return period_ > Duration::zero(); }
    [[nodiscard]] double value() const noexcept { return value_; }
    /// To be called before a change at `now`, and before it is asked for; `at` gives the value at an instant since the last call.
    template <class At>
    void follow(Instant now, At&& at) {
        if (!samples()) return;
        const Instant tick = time_zero + (now - time_zero) / period_ * period_;
        if (tick <= last_) return;
        last_ = tick;
        value_ = at(tick);
    }

private:
    Duration period_;
    Instant last_ = Instant::min();
    double value_ = 0;
};

}  // namespace axisgate::pacontrol::twin
