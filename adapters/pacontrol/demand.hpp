// Demands: where each axis should be: by 1915 where the control tells it, else by the order that it acknowledged.
// In: acknowledgements of orders, 1911, positions, axis parameters. Out: demand_source and position_demand of the feedback.
// Never guesses: whatever else may have moved the axis leaves its demand unknown until it stands, and then it is where it stands.
#pragma once

#include "adapters/pacontrol/polls.hpp"

namespace axisgate::pacontrol {

class Demands : public Part {
public:
    using Part::Part;

    // --- what the control acknowledged, or not ------------------------------------------------------------------------------
    /// Every acknowledged command passes here, whoever asked for it: verb, action or native text.
    void follow(const Sent& sent, const Reply& reply, Instant now);
    /// Sent, and whether it is carried out is not known.
    void not_acknowledged(const Request& request);

    // --- what is read ---------------------------------------------------------------------------------------------------------
    void seen_running(Axis& a, Instant now);
    void seen_standing(Axis& a);
    void rest(Axis& a, std::int64_t position);
    void following_answered(Axis& a, double microsteps_behind, Instant now);
    void following_refused(Axis& a, const Reply& reply);
    void parameter_answered(Axis& a, std::uint8_t which, const Reply& reply, Instant now);
    void parameters_may_have_changed();

    // --- what is published -----------------------------------------------------------------------------------------------------
    /// Source and demand that belong to the position that was received last.
    void show(Axis& a, Instant now);
    [[nodiscard]] static std::int64_t following_error(const Axis& a) noexcept;
    /// What a motion takes and a stop brakes with: the overrides in force, else the axis parameters, which are read in home position alone.
    /// One acceleration is both ramps and that of a stop [L3756]. 0: not known.
    [[nodiscard]] static DriveRates rates(const Axis& a) noexcept;
    /// By more than two full steps: the shaft is held, or has lost steps.
    [[nodiscard]] static bool stands_behind(const Axis& a) noexcept;

private:
    void ordered(Axis& a, double start, double target, Instant now);
    void brake(Axis& a, Instant now);
    void doubt(Axis& a);
    void guide(Axis& a);
};

}  // namespace axisgate::pacontrol
