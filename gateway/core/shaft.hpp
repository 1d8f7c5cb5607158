// The mechanics that real machines have and a demand curve does not: a motor of finite force that follows its demand with an error, rings
// and settles, sticks by friction, a gear with backlash, an encoder that flickers by an increment, and an axis that drifts when its power
// is gone. Twins call it where they calculate the position that the drive measures; without a freedom it returns the demand.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>

#include "gateway/core/freedom.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate {

/// Values of the freedoms of the same names, in increments and seconds of the twin's axis.
struct ShaftFreedoms {
    std::int64_t follow_ms = 0;            ///< time constant of the position loop, without feed-forward; 0: the shaft is at its demand
    std::int64_t damping_percent = 100;    ///< below 100 it overshoots and rings before it settles
    std::int64_t most_acceleration = 0;    ///< increments/s^2 that the motor's force gives the load; 0: no limit
    std::int64_t friction_increments = 0;  ///< it stays where it is while its demand is not further away than this
    std::int64_t backlash_increments = 0;  ///< play between the motor and the encoder at the load
    std::int64_t noise_increments = 0;     ///< the encoder shows up to this much more or less, changing each millisecond
    std::int64_t drift_increments = 0;     ///< without power it moves this far within about a second, and stays there

    [[nodiscard]] bool none() const noexcept {
        return follow_ms == 0 && most_acceleration == 0 && friction_increments == 0 && backlash_increments == 0 && noise_increments == 0 &&
               drift_increments == 0;
    }
    bool operator==(const ShaftFreedoms&) const = default;
};
/// Reads them by their names.
[[nodiscard]] ShaftFreedoms shaft_freedoms(const FreedomValues& values);

/// What it is at one instant: increments, increments/s.
struct ShaftPoint {
    Instant at{};                       ///< a whole millisecond
    double position = 0, velocity = 0;  ///< of the motor
    double load = 0;                    ///< position behind the backlash
    double demand = 0, demand_velocity = 0;
    double force = 0;  ///< the share of the motor's force that is needed, 0..1; 0 without a limit
};

/// The movement of the undisturbed loop within 1 ms, 2 ms ... from a position and a velocity, both relative to its steady movement.
struct ShaftTransition {
    double position_of_position = 1, position_of_velocity = 0, velocity_of_position = 0, velocity_of_velocity = 1;
};

/// Its answers are those of whole milliseconds and do not depend on the instants at which they are asked for. Where its loop is linear it
/// advances in strides with the exact solution of the loop for a demand of second order; milliseconds are calculated one by one where
/// force or friction end that. A shaft that rests is passed over in growing steps for as long as its demand is the same at
/// their ends: callers advance it before each change of the demand. Of a gap of more
/// than `longest_gap` only the last part is calculated: at its beginning the shaft is at its demand, or where it stood if the demand is
/// the same.
class Shaft {
public:
    static constexpr Duration step = std::chrono::milliseconds(1);
    static constexpr Duration stride = 16 * step;
    static constexpr Duration longest_gap = std::chrono::seconds(20);

    explicit Shaft(const ShaftFreedoms& freedoms = {}, std::uint64_t seed = 0);

    /// True if it differs from its demand in any way; without it the calls below need not be made.
    [[nodiscard]] bool differs() const noexcept { return differs_; }
    /// At rest at this position from now on: power-on, a new reference of the position, a hand that has moved it.
    void set(double position, Instant now);
    /// Everything is numbered anew: each position becomes more by this.
    void shift(double by) noexcept;
    /// Advances until `now`; `demand` is a function of an Instant: the demand position at that instant, in increments. It is called for
    /// instants since the last call, several times for some of them.
    template <class Demand>
    void advance(Instant now, Demand&& demand) {
        (void)advance_until(now, demand, [](const ShaftPoint&) { return false; });
    }
    /// As `advance`, but it stops at the first millisecond at which `ends` is true of its ShaftPoint. That instant, or `never`.
    template <class Demand, class Ends>
    Instant advance_until(Instant now, Demand&& demand, Ends&& ends);
    /// It stays where it is as long as its demand does.
    [[nodiscard]] bool rests() const noexcept { return rests(now_); }
    /// While the drive has no power: the shaft drifts from where it was switched off, whatever the demand is. Call `advance` for the
    /// instant of switching off before.
    void advance_without_power(Instant now);

    /// As of the last advance.
    [[nodiscard]] const ShaftPoint& point() const noexcept { return now_; }
    /// Position and velocity of the motor as of the last advance, increments and increments/s.
    [[nodiscard]] double position() const noexcept { return now_.position; }
    [[nodiscard]] double velocity() const noexcept { return now_.velocity; }
    /// Position of the load, behind the backlash.
    [[nodiscard]] double load() const noexcept { return now_.load; }
    /// As the encoder at the load shows it, with noise.
    [[nodiscard]] double shown() const noexcept;
    /// The demand minus the motor's position.
    [[nodiscard]] double following_error() const noexcept { return now_.demand - now_.position; }
    /// The following error beyond that of a motor that is strong enough: what it lacks to the lag of its loop at its speed, increments.
    [[nodiscard]] double lack() const noexcept { return lack(now_); }
    [[nodiscard]] double lack(const ShaftPoint& p) const noexcept;
    [[nodiscard]] double force() const noexcept { return now_.force; }

private:
    static constexpr std::size_t steps = static_cast<std::size_t>(stride / step);
    using Transitions = std::array<ShaftTransition, steps>;

    [[nodiscard]] static Instant on_grid(Instant t, Duration grid = step) noexcept {
        const Duration since = t - time_zero;
        return t - since % grid;
    }
    [[nodiscard]] bool rests(const ShaftPoint& p) const noexcept {
        const double off = p.demand - p.position;
        return p.velocity == 0 && p.demand_velocity == 0 && (off == 0 || (off < 0 ? -off : off) <= friction_);
    }
    template <class Demand>
    [[nodiscard]] Instant rests_until(Instant now, Demand&& demand) const;
    template <class Demand, class Ends>
    Instant cross(ShaftPoint& p, Instant end, Demand&& demand, Ends&& ends) const;
    /// To a demand half-way and at the end, in one step; false: force or friction act in between.
    [[nodiscard]] bool leap(ShaftPoint& p, std::size_t milliseconds, double half_way, double demand) const noexcept;
    void one_step(ShaftPoint& p, double demand) const noexcept;
    void move_freely(ShaftPoint& p, std::size_t milliseconds, double half_way, double demand) const noexcept;
    [[nodiscard]] bool limited(const ShaftPoint& p) const noexcept;
    [[nodiscard]] double acceleration_wanted(const ShaftPoint& p) const noexcept;
    void settle(ShaftPoint& p) const noexcept;
    void skip_to(Instant at, double demand) noexcept;
    void drag_load(ShaftPoint& p) const noexcept {
        p.load = p.load < p.position - play_ ? p.position - play_ : p.load > p.position + play_ ? p.position + play_ : p.load;
    }

    bool differs_, loop_, remembers_;  ///< `loop_`: it can be behind its demand; `remembers_`: its place depends on former demands
    double period_ = 0, damping_ = 1, most_ = 0, friction_ = 0, play_ = 0, drift_ = 0;
    std::uint64_t noise_span_, noise_;
    std::shared_ptr<const Transitions> transitions_;
    ShaftPoint firm_;  ///< at the last multiple of `stride`, or where it was set
    ShaftPoint now_;   ///< at the last millisecond that was asked for, calculated from `firm_`
    double drift_from_ = 0;
    Instant off_since_ = never;
};

template <class Demand, class Ends>
Instant Shaft::advance_until(Instant now, Demand&& demand, Ends&& ends) {
    off_since_ = never;
    const Instant until = on_grid(now);
    if (until <= now_.at) return never;
    if (until - now_.at > longest_gap) skip_to(until - longest_gap, demand(until - longest_gap));
    if (!remembers_) {
        const double before = demand(until - step);
        firm_.at = until;
        firm_.demand = demand(until);
        firm_.position = firm_.load = firm_.demand;
        firm_.velocity = firm_.demand_velocity = (firm_.demand - before) / seconds(step);
        now_ = firm_;
        return ends(now_) ? until : never;
    }
    if (firm_.at < now_.at && !rests(now_)) {  // a demand that has taken another course no longer tells what it was before
        const double other = demand(firm_.at) - firm_.demand;
        if (other > 1e-9 || other < -1e-9) firm_ = now_;
    }
    for (;;) {
        if (rests(firm_)) {
            const Instant same = rests_until(until, demand);
            firm_.at = std::max(firm_.at, on_grid(same, stride));
            if (same == until) {
                now_ = firm_;
                now_.at = until;
                return ends(now_) ? until : never;
            }
        }
        const Instant end = on_grid(firm_.at, stride) + stride;
        const bool whole = end <= until;
        ShaftPoint next = firm_;
        const Instant ended = cross(next, whole ? end : until, demand, ends);
        now_ = next;
        if (whole || ended != never) firm_ = next;
        if (ended != never || !whole) return ended;
        if (end == until) return never;
    }
}

/// The demand is looked at in steps that double: a shaft that has rested for long is passed over by few calls.
template <class Demand>
Instant Shaft::rests_until(Instant now, Demand&& demand) const {
    Instant same = firm_.at;
    for (Duration by = stride; same < now; by *= 2) {
        const Instant probe = std::min(same + by, now);
        const double off = demand(probe) - firm_.demand;
        if (off > 1e-9 || off < -1e-9) break;
        same = probe;
    }
    return same;
}

template <class Demand, class Ends>
Instant Shaft::cross(ShaftPoint& p, Instant end, Demand&& demand, Ends&& ends) const {
    const auto n = static_cast<std::size_t>((end - p.at) / step);
    if (n > 1) {
        ShaftPoint far = p;
        if (leap(far, n, demand(p.at + (end - p.at) / 2), demand(end)) && !ends(far)) {
            p = far;
            return never;
        }
    }
    while (p.at < end) {
        one_step(p, demand(p.at + step));
        if (ends(p)) return p.at;
    }
    return never;
}

}  // namespace axisgate
