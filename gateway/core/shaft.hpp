// The mechanics that real machines have and a demand curve does not: a motor of finite force that follows its demand with an error, rings
// and settles, sticks by friction, a gear with backlash, an encoder that flickers by an increment, and an axis that drifts when its power
// is gone. Twins call it where they calculate the position that the drive measures; without a freedom it returns the demand.
#pragma once

#include <cstdint>

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

/// Advances on a fixed grid of one millisecond, so that its answers do not depend on when they are asked for. Of a gap of more than
/// `longest_gap` only the last part is calculated: at its beginning the shaft is at its demand, or where it stood if the demand is the
/// same.
class Shaft {
public:
    static constexpr Duration step = std::chrono::milliseconds(1);
    static constexpr Duration longest_gap = std::chrono::seconds(20);

    explicit Shaft(const ShaftFreedoms& freedoms = {}, std::uint64_t seed = 0) : free_(freedoms), seed_(seed) {}

    /// True if it differs from its demand in any way; without it the calls below need not be made.
    [[nodiscard]] bool differs() const noexcept { return !free_.none(); }
    /// At rest at this position from now on: power-on, a new reference of the position, a hand that has moved it.
    void set(double position, Instant now);
    /// Everything is numbered anew: each position becomes more by this.
    void shift(double by) noexcept;
    /// Advances until `now`; `demand` is a function of an Instant: the demand position at that instant, in increments. It is called for
    /// instants since the last call, in order.
    template <class Demand>
    void advance(Instant now, Demand&& demand) {
        off_since_ = never;
        if (now - last_ > longest_gap) {
            last_ = on_grid(now - longest_gap);
            skip_to(demand(last_));
        }
        while (last_ + step <= now) {
            last_ += step;
            one_step(demand(last_));
        }
    }
    /// It stays where it is as long as its demand does.
    [[nodiscard]] bool rests() const noexcept {
        const double off = demand_ - x_;
        return v_ == 0 && demand_velocity_ == 0 && (off == 0 || (off < 0 ? -off : off) <= static_cast<double>(free_.friction_increments));
    }
    /// As `advance`, for a shaft that rests and whose demand has not changed since the last advance: without the steps.
    void pass_time(Instant now) noexcept {
        off_since_ = never;
        if (now > last_) last_ = time_zero + (now - time_zero) / step * step;
    }
    /// While the drive has no power: the shaft drifts from where it was switched off, whatever the demand is. Call `advance` for the
    /// instant of switching off before.
    void advance_without_power(Instant now);

    /// Position and velocity of the motor as of the last advance, increments and increments/s.
    [[nodiscard]] double position() const noexcept { return x_; }
    [[nodiscard]] double velocity() const noexcept { return v_; }
    /// Position of the load, behind the backlash.
    [[nodiscard]] double load() const noexcept { return load_; }
    /// As the encoder at the load shows it, with noise.
    [[nodiscard]] double shown() const noexcept;
    /// The demand at the last step minus the motor's position.
    [[nodiscard]] double following_error() const noexcept { return demand_ - x_; }
    /// The following error beyond that of a motor that is strong enough: what it lacks to the lag of its loop at its speed, increments.
    [[nodiscard]] double lack() const noexcept;
    /// The share of the motor's force that the last step needed, 0..1; 0 without a limit.
    [[nodiscard]] double force() const noexcept { return force_; }

private:
    [[nodiscard]] static Instant on_grid(Instant t) noexcept { return time_zero + (t - time_zero) / step * step; }
    void skip_to(double demand) noexcept;
    void one_step(double demand);
    [[nodiscard]] double acceleration(double error) noexcept;
    void drag_load() noexcept;

    ShaftFreedoms free_;
    std::uint64_t seed_;
    Instant last_{};
    double x_ = 0, v_ = 0, load_ = 0, demand_ = 0, demand_velocity_ = 0, force_ = 0, drift_from_ = 0;
    Instant off_since_ = never;
};

}  // namespace axisgate
