// RealShaft is the shaft of the machine behind the one that the controller calculates: it follows with an error, sticks, has play, and
// drifts without power. The difference is an error of the encoder of the servo, so that the checks of the servo see it. Positions in qc.
#pragma once

#include <optional>

#include "adapters/aposs/twin/manners.hpp"
#include "adapters/cia402/twin/mechanics.hpp"

namespace axisgate::aposs {

class RealShaft {
public:
    using Calculated = cia402_drive::twin::Mechanics;
    RealShaft(const Manners& manners, int axis)
        : shaft_(manners.shaft, manners.seed + static_cast<std::uint64_t>(axis)),
          friction_(static_cast<double>(manners.shaft.friction_increments)) {}

    /// Follows until `now`: called before each change of the motion, and before the position is read. While the motor has no power and
    /// stands, the calculated shaft is taken along by the drift, so that enabling does not move it back.
    void follow(Calculated& by, bool powered, Instant now);
    /// It differs from the calculated shaft and has not come to rest.
    [[nodiscard]] bool unsettled(const Calculated& by, bool powered, Instant now) const;
    /// The encoder errs by this in addition (the tester's hand).
    void misread(Calculated& by, double jump);

    [[nodiscard]] double place(const Calculated& by, Instant now) const {
        return shaft_.differs() ? shaft_.position() : by.shaft(now).position;
    }
    /// Empty: that of the calculated shaft.
    [[nodiscard]] std::optional<double> velocity() const { return shaft_.differs() ? std::optional(shaft_.velocity()) : std::nullopt; }

private:
    Shaft shaft_;
    double friction_;
    double jump_ = 0, deviation_ = 0;
    bool was_on_ = false;  ///< it drifts only from where it was held
};

}  // namespace axisgate::aposs
