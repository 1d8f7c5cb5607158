// AxisDemand: where the axis should be, worked out from the orders that the drive acknowledged (brief ramps: cut-in speed, AC, DC, SD).
// In: the beginnings and ends of motions, statuses, positions. Out: demand and its source. Never told by the drive: MS[1] has the position
// alone and DV[4] the end of the motion. In open loop the position is itself a count of steps.
#pragma once

#include <optional>

#include "adapters/uim342/feedback.hpp"
#include "gateway/axis/demand.hpp"

namespace axisgate::uim342 {

class AxisDemand : public Part {
public:
    using Part::Part;

    /// BG has been acknowledged. Ack and later positions come with the same delay from the drive, so their difference is free of it.
    void begins(const Motion& motion, Instant now) noexcept;
    /// A halt by JV = 0 runs down with DC, ST with SD; SD = 0 is no ramp.
    void stops(bool soft, Instant now) noexcept;
    void rests(std::int64_t position) noexcept;
    void forget() noexcept;
    /// `started_by_itself`: it stood, nothing was ordered, and now it moves.
    void at_status(bool started_by_itself, Instant now) noexcept;
    /// Called with each position: it and the demand belong to one instant.
    void at_position(Instant now) noexcept;
    void show(AxisFeedback& fb) const noexcept;

private:
    [[nodiscard]] std::optional<DemandRamps> ramps(std::int64_t speed) const noexcept;

    Demand demand_;
    DemandSource source_ = DemandSource::none;
    std::int64_t position_ = 0;
};

}  // namespace axisgate::uim342
