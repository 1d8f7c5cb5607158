// Interpolator is the VA interpolator with its memory: the previous target, the last limits, a queued motion and a frozen motion.
#pragma once

#include <cstdint>
#include <optional>

#include "adapters/linmot/twin/memory.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

class Interpolator {
public:
    static constexpr double velocity_count = 10, acceleration_count = 100;  ///< 1e-6 m/s and 1e-5 m/s2 in 0.1 um
    static constexpr double quick_deceleration = 1e8;                       ///< 10 m/s2: the parameter has no UPID (E-44)

    explicit Interpolator(const Memory& memory) : memory_(memory) {}

    [[nodiscard]] const Profile& profile() const noexcept { return profile_; }
    /// The limits of commands without limits: 14BEh to 14C0h.
    [[nodiscard]] Ramps predefined() const;
    void power_on() noexcept { used_ = false; }

    /// Standstill here; the previous target is kept.
    void rest(double position, Instant now) noexcept { profile_.rest(position, now); }
    /// Standstill here, which is the previous target of the next motion.
    void stand(double position, Instant now) noexcept { profile_.rest(position, now), target_ = position; }
    void set_target(double target) noexcept { target_ = target; }
    void target_end() noexcept { target_ = profile_.target(); }

    /// Motions of the drive itself: to a position, or endless.
    void move(Point from, double target, const Ramps& ramps, Instant now) noexcept;
    void run(Point from, double direction, const Ramps& ramps, Instant now) noexcept { profile_.run(now, from, direction, ramps); }
    /// Motions of commands, whose limits are stored.
    void start(const Order& order, Point from, Point actual, Instant now) noexcept;
    void endless(Point from, double direction, const Ramps& ramps, Instant now) noexcept;
    /// Other limits for the motion in progress.
    void change(Point from, const Ramps& ramps, Instant now) noexcept;
    void stop(Point from, double deceleration, Instant now) noexcept;

    /// Decelerates, and stores the motion for `thaw`. `led`: a curve or the encoder controlled the demand; `moved`: it was in motion.
    void freeze(Point from, bool led, bool moved, Instant now) noexcept;
    void thaw(Point from, Instant now) noexcept;

    // --- the queued motion -------------------------------------------------------------------------------------------------
    void queue(const Order& order) noexcept { after_ = order; }
    void forget_queued() noexcept { after_.reset(); }
    [[nodiscard]] const std::optional<Order>& queued() const noexcept { return after_; }

private:
    struct Frozen {
        bool motion = false, endless = false;
        double target = 0, direction = 1;
    };
    const Memory& memory_;
    Profile profile_;
    double target_ = 0;  ///< the previous target for 2xh and Bxh commands
    bool used_ = false;
    Ramps last_ramps_{};
    std::optional<Order> after_;
    Frozen frozen_;
};

}  // namespace axisgate::linmot::twin
