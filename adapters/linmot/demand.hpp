// AxisDemand calculates the demand position of the axis from the moves that the drive has acknowledged, because the default response
// contains the actual position only. It is unknown during motions that the gateway did not order.
#pragma once

#include "adapters/linmot/drive_part.hpp"
#include "gateway/axis/demand.hpp"

namespace axisgate::linmot {

class AxisDemand : public Part {
public:
    using Part::Part;

    /// A move is being sent, with these rates in the drive's counts.
    void ordered(const Move& move, std::uint32_t velocity, std::uint32_t acceleration, std::uint32_t deceleration) noexcept;
    /// The stop of an endless move.
    void ordered_stop(const Move& move, std::uint32_t deceleration) noexcept;
    /// The drive has accepted it.
    void moves(Turn& t);
    void stops(Turn& t);
    void rest(double place) { demand_.rest(place); }
    void forget() noexcept { demand_.forget(); }
    void at_status(AxisFeedback& feedback, Turn& t);

    /// Of the last move, in counts of 1e-5 m/s^2; 0: none.
    [[nodiscard]] std::uint32_t ordered_deceleration() const noexcept { return d_; }
    /// Of the last move; else that of the drive; else 1 m/s^2. Counts of 1e-5 m/s^2.
    [[nodiscard]] std::uint32_t deceleration() const noexcept;
    /// The calculated position during a motion, else the actual position.
    [[nodiscard]] double place(Instant now) const;

private:
    Demand demand_;
    Move move_;
    std::uint32_t v_ = 0, a_ = 0, d_ = 0;  ///< of the last move; 0: that of the drive
};

}  // namespace axisgate::linmot
