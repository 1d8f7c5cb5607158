// AxisDemand: where the axis should be, worked out from the moves that the drive has acknowledged: its default response has the position
// alone. In: beginnings and ends of motions. Out: demand and its source in the feedback. Forgotten where a motion is not the gateway's own.
#pragma once

#include "adapters/linmot/drive_part.hpp"
#include "gateway/axis/demand.hpp"

namespace axisgate::linmot {

class AxisDemand : public Part {
public:
    using Part::Part;

    /// A move is being sent, at these rates in the drive's counts.
    void ordered(const Move& move, std::uint32_t velocity, std::uint32_t acceleration, std::uint32_t deceleration) noexcept;
    /// The end of an endless one.
    void ordered_stop(const Move& move, std::uint32_t deceleration) noexcept;
    /// The drive has taken it.
    void moves(Turn& t);
    void stops(Turn& t);
    void rest(double place) { demand_.rest(place); }
    void forget() noexcept { demand_.forget(); }
    void at_status(AxisFeedback& feedback, Turn& t);

    /// Of the last move, in counts of 1e-5 m/s^2; 0: none.
    [[nodiscard]] std::uint32_t ordered_deceleration() const noexcept { return d_; }
    /// Of the last move; else the drive's own; else 1 m/s^2. Counts of 1e-5 m/s^2.
    [[nodiscard]] std::uint32_t deceleration() const noexcept;
    /// Where it should be now if it moves, else where it is.
    [[nodiscard]] double place(Instant now) const;

private:
    Demand demand_;
    Move move_;
    std::uint32_t v_ = 0, a_ = 0, d_ = 0;  ///< of the last move; 0: the drive's own
};

}  // namespace axisgate::linmot
