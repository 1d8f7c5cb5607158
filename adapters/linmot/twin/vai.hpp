// The VA interpolator with its memory: the former target, the last limits, the motion that waits behind the running one, a frozen one.
// In: orders, where the demand and the slider are. Out: a profile. Never knows what else may lead the demand.
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
    /// The limits of commands that carry none: 14BEh to 14C0h.
    [[nodiscard]] Ramps predefined() const;
    void power_on() noexcept { used_ = false; }

    /// Stands there; the former target stays.
    void rest(double position, Instant now) noexcept { profile_.rest(position, now); }
    /// Stands there, and that is the former target of what comes.
    void stand(double position, Instant now) noexcept { profile_.rest(position, now), target_ = position; }
    void set_target(double target) noexcept { target_ = target; }
    void target_end() noexcept { target_ = profile_.target(); }

    /// The drive's own moves: to a place, or endless.
    void move(Point from, double target, const Ramps& ramps, Instant now) noexcept;
    void run(Point from, double direction, const Ramps& ramps, Instant now) noexcept { profile_.run(now, from, direction, ramps); }
    /// Those of commands: their limits are kept.
    void start(const Order& order, Point from, Point actual, Instant now) noexcept;
    void endless(Point from, double direction, const Ramps& ramps, Instant now) noexcept;
    /// Other limits for what runs.
    void change(Point from, const Ramps& ramps, Instant now) noexcept;
    void stop(Point from, double deceleration, Instant now) noexcept;

    /// Brakes, and keeps what ran for `thaw`; `led`: by a curve or the encoder, `moved`: it was in motion.
    void freeze(Point from, bool led, bool moved, Instant now) noexcept;
    void thaw(Point from, Instant now) noexcept;

    // --- the motion behind the running one -----------------------------------------------------------------------------------
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
    double target_ = 0;  ///< the former target of 2xh and Bxh commands
    bool used_ = false;
    Ramps last_ramps_{};
    std::optional<Order> after_;
    Frozen frozen_;
};

}  // namespace axisgate::linmot::twin
