// Demand is the demand position: one of VA interpolator, time curve, master encoder and stream controls it. When control passes from one to
// another, the demand does not jump; a jump is error 000Bh. When a motion ends, the demand stays where it is.
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
    /// Another source than the VA interpolator controls the demand.
    [[nodiscard]] bool led() const noexcept { return play_.active || stream_.active() || coupling_.active(); }
    [[nodiscard]] bool moves(Instant now) const noexcept { return led() || !vai_.profile().over(now); }
    [[nodiscard]] bool indexes() const noexcept { return index_.has_value(); }
    [[nodiscard]] const Profile& profile() const noexcept { return vai_.profile(); }
    [[nodiscard]] const Stream& stream() const noexcept { return stream_; }
    /// When the time curve ends; `never`: none is in progress.
    [[nodiscard]] Instant curve_end() const noexcept { return play_.active ? play_.end() : never; }

    /// For calls that do not change the source of the demand.
    [[nodiscard]] Interpolator& vai() noexcept { return vai_; }
    [[nodiscard]] const Interpolator& vai() const noexcept { return vai_; }
    [[nodiscard]] Coupling& coupling() noexcept { return coupling_; }
    [[nodiscard]] const Coupling& coupling() const noexcept { return coupling_; }

    // --- all leads end ---
    /// The power is off: the demand is the position of the slider.
    void drop(double position, Instant now);
    /// Decelerates to standstill; Interpolator::thaw continues.
    void brake(Instant now);
    /// Motions of the drive itself.
    void go(double target, const Ramps& ramps, Instant now);
    void jog(double direction, const Ramps& ramps, Instant now);
    /// A curve or the encoder no longer controls the demand.
    void leave(Instant now);
    void leave_all(Instant now) { leave(now), stream_.end(); }

    // --- a lead begins ---
    void start(const Order& order, Point actual, Instant now);
    void stop(double deceleration, Instant now);
    /// Position indexing: the counts of the encoder are added to the base, one unit per count (choice E-23); the limits are latched
    /// [L2043].
    void index(double base, const Ramps& ramps, Instant now);
    void step_index(Instant now);
    void end_index() noexcept { index_.reset(); }
    [[nodiscard]] Fault play(std::uint8_t sub, const Bytes& b, Instant now);
    /// A set-point of 03h, or the end of the stream.
    [[nodiscard]] Fault take(std::uint8_t sub, const Bytes& b, Instant now);
    /// A jump that exceeds the lag limit is reported as the error that it would cause.
    [[nodiscard]] Fault couple(Coupling::Mode mode, Instant now);
    void uncouple(Instant now);

    // --- time ---
    void step_coupling(Instant now);
    /// The next set-point of a stream is reached.
    bool pass(Instant now) { return stream_.pass(now); }
    /// A stream has not received a set-point in time: error 0083h, and the demand rests.
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
