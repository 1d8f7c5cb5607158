// What the control shows of an axis, where that is not its state of the moment: a status that follows late, and a position that is
// refreshed now and then. Without the freedoms of AxisModel both are the state itself, and nothing here is used.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>

#include "adapters/pacontrol/twin/traverse.hpp"

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

/// Of one axis.
class AxisShown {
public:
    struct Status {
        std::uint8_t number = 0;  ///< as Axis::status
        bool running = false;
        bool operator==(const Status&) const = default;
    };

    AxisShown(const AxisModel& model, const AxisState& state, const Shaft& shaft, const Traverse& traverse)
        : model_(model), state_(state), shaft_(shaft), traverse_(traverse), status_(model.status_behind), position_(model.position_every) {}
    AxisShown(const AxisShown&) = delete;
    AxisShown& operator=(const AxisShown&) = delete;

    /// As of the last `settle`.
    [[nodiscard]] Status status() const noexcept { return status_.delays() ? status_.shown() : own_status(); }
    /// AE, at the instant of the last `before`.
    [[nodiscard]] double position(Instant t) const noexcept { return position_.samples() ? position_.value() : own_position(t); }

    /// Before anything changes at `t`.
    void before(Instant t) {
        position_.follow(t, [&](Instant at) { return own_position(at); });
    }
    /// After anything may have changed at `t`.
    void settle(Instant t) {
        if (status_.delays()) status_.follow(own_status(), t);
    }
    void boot() { status_.set(own_status()); }

private:
    [[nodiscard]] Status own_status() const noexcept;
    [[nodiscard]] double own_position(Instant t) const noexcept {
        return model_.measured_position ? shaft_.encoder(t) : shaft_.position(t);
    }

    const AxisModel& model_;
    const AxisState& state_;
    const Shaft& shaft_;
    const Traverse& traverse_;
    Delayed<Status> status_;
    Sampled position_;
};

/// 0 in position, 1 moving, 2 stopped, 4 malfunction, 8 measuring mode [L2960].
[[nodiscard]] inline std::uint8_t status_of(const AxisState& state, const Shaft& shaft, const Traverse& traverse) noexcept {
    if (state.measuring) return 8;
    if (state.fault != 0) return 4;
    if (shaft.running()) return 1;
    return traverse.stopped() ? 2 : 0;
}

inline AxisShown::Status AxisShown::own_status() const noexcept {
    const bool hidden = !model_.reference_shown && shaft_.running() && traverse_.task() == Task::reference && state_.fault == 0;
    return hidden ? Status{} : Status{status_of(state_, shaft_, traverse_), shaft_.running()};
}

}  // namespace axisgate::pacontrol::twin
