// The demand: which of the VA interpolator, a time curve, the encoder or a stream leads it, and how the lead passes over.
// In: what the interpreter and the states begin and end, time. Out: position and velocity at an instant, what becomes due, errors.
// Never jumps when a lead ends: it rests where it was.
#pragma once

#include <optional>

#include "adapters/linmot/twin/coupling.hpp"
#include "adapters/linmot/twin/stream.hpp"
#include "adapters/linmot/twin/vai.hpp"

namespace axisgate::linmot::twin {

class Demand {
public:
    Demand(Memory& memory, const MasterEncoder& master, const Curves& curves, const Winding& winding)
        : memory_(memory), master_(master), curves_(curves), vai_(memory), coupling_(memory, master, curves, winding), stream_(memory) {}

    [[nodiscard]] Point at(Instant now) const;
    /// Something else than the VA interpolator leads.
    [[nodiscard]] bool led() const noexcept { return play_.active || stream_.active() || coupling_.active(); }
    [[nodiscard]] bool moves(Instant now) const noexcept { return led() || !vai_.profile().over(now); }
    [[nodiscard]] bool indexes() const noexcept { return index_.has_value(); }
    [[nodiscard]] const Profile& profile() const noexcept { return vai_.profile(); }
    [[nodiscard]] const Stream& stream() const noexcept { return stream_; }
    /// When the time curve is over; `never`: none runs.
    [[nodiscard]] Instant curve_end() const noexcept { return play_.active ? play_.end() : never; }

    /// Their own matters, in which no lead passes over.
    [[nodiscard]] Interpolator& vai() noexcept { return vai_; }
    [[nodiscard]] const Interpolator& vai() const noexcept { return vai_; }
    [[nodiscard]] Coupling& coupling() noexcept { return coupling_; }
    [[nodiscard]] const Coupling& coupling() const noexcept { return coupling_; }

    // --- all leads end ---
    /// The power is off: it stands where the slider is.
    void drop(double position, Instant now);
    /// Brakes to rest by itself; Interpolator::thaw goes on.
    void brake(Instant now);
    /// The drive's own moves.
    void go(double target, const Ramps& ramps, Instant now);
    void jog(double direction, const Ramps& ramps, Instant now);
    /// A curve or the encoder leads no more.
    void leave(Instant now);
    void leave_all(Instant now) { leave(now), stream_.end(); }

    // --- a lead begins ---
    void start(const Order& order, Point actual, Instant now);
    void stop(double deceleration, Instant now);
    /// Position indexing: the encoder's counts are added to the base, one unit per count (choice E-23); the limits are latched [L2043].
    void index(double base, const Ramps& ramps, Instant now);
    void step_index(Instant now);
    void end_index() noexcept { index_.reset(); }
    [[nodiscard]] Fault play(std::uint8_t sub, const Bytes& b, Instant now);
    /// A set-point of 03h, or its end.
    [[nodiscard]] Fault take(std::uint8_t sub, const Bytes& b, Instant now);
    /// What would make it jump further than the lag limit is the error that the jump would be.
    [[nodiscard]] Fault couple(Coupling::Mode mode, Instant now);
    void uncouple(Instant now);

    // --- time ---
    void step_coupling(Instant now);
    /// The next set-point of a stream is reached.
    bool pass(Instant now) { return stream_.pass(now); }
    /// A stream has had no set-point for too long: 0083h, and it rests.
    [[nodiscard]] Fault starve(Instant now);

private:
    struct Index {
        double base = 0;
        Ramps ramps;
    };
    Memory& memory_;
    const MasterEncoder& master_;
    const Curves& curves_;
    Interpolator vai_;
    Coupling coupling_;
    Stream stream_;
    Play play_;
    std::optional<Index> index_;
};

}  // namespace axisgate::linmot::twin
