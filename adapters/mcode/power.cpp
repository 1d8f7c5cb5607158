// Power: the bridges on (DE), and faults reset.
// In: Enable, ResetFault. Out: lines; the power that was read behind them.
// Never calls an axis powered that reads DE = 0.
#include <fmt/core.h>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

void Power::plan(const Command& c, Turn&) {
    if (std::holds_alternative<Enable>(c.body)) {
        job().send("DE=1");
        return;
    }
    if (feedback().flags().stalled) job().send("ST=0");
    if (feedback().flags().locked) job().send("CF");
    job().send("ER=0");
}

Verb::Proof Power::proof(const Step& step, Duration) const {
    const auto& flags = feedback().flags();
    if (step.text == "DE=1") return flags.de ? Proof::taken : Proof::lost;
    if (step.text == "ST=0") return flags.stalled ? Proof::lost : Proof::taken;
    if (step.text == "CF") return flags.locked ? Proof::lost : Proof::taken;
    return Proof::none;
}

void Power::done(Turn& t) {
    if (std::holds_alternative<Enable>(job().command.body)) {
        drive_.errors.clear_input_stop();
        feedback().powered(t);
        if (!feedback().flags().de) return fail(Reason::drive_refused, fmt::format("{} took DE=1 but is off", name()), t);
    } else {
        drive_.errors.clear_fault();
        drive_.errors.clear_last();
        feedback().show(t);
    }
    succeed({}, t);
}

}  // namespace axisgate::mcode
