// Power and FaultReset: the driver on, and what stands after a fault taken away.
// In: Enable, ResetFault. Out: ST, MO, JV; MS[0]=0, ER[0]=0.
// Never lets a motion of before begin with the driver.
#include <fmt/core.h>

#include "adapters/uim342/drive.hpp"

namespace axisgate::uim342 {

/// A residual action may move the motor when the driver turns on [L1264]: ST before and after MO=1, and only then, with the
/// driver on as the manual wants it, a jog speed of 0 in place of whatever was set before.
void Power::plan(const Command&, Turn& t) {
    if (drive_.feedback.status().lock)
        return refuse(Reason::wrong_state, "the drive is locked after an emergency stop: reset the fault first", t);
    Job& j = job();
    j.partial = j.exact = true;
    j.add(drive_.act(cw::ST));
    j.add(drive_.set(cw::MO, 1));
    j.add(drive_.act(cw::ST));
    j.add(drive_.set(cw::JV, 0));
    if (drive_.options.notify && drive_.known.notifies == false) j.add(drive_.set(cw::IE, 1, 8));  // the driver is on: RAM alone
}

void Power::done(Turn& t) {
    drive_.polls.soon(t.now);
    accept("", t);
}

/// MS[0]=0 clears PAIF, TLIF and ERR [L920]; a lock is left by MO=0 (erratum E-39); ER[0]=0 takes the shown error away.
void FaultReset::plan(const Command&, Turn&) {
    job().partial = true;
    if (drive_.feedback.status().lock) job().add(drive_.set(cw::MO, 0));
    job().add(drive_.set(cw::MS, 0, 0));
    if (drive_.errors.any_latest()) job().add(drive_.set(cw::ER, 0, 0));
}

void FaultReset::failed(const Step& step, Failure how, Turn& t) {
    if (step.message.function() == cw::ER && how.reason == Reason::drive_refused) return done(t);  // the flags are cleared; that counts
    Verb::failed(step, std::move(how), t);
}

void FaultReset::done(Turn& t) {
    Feedback& feedback = drive_.feedback;
    const Status& s = feedback.status();
    drive_.polls.soon(t.now);
    feedback.fault_reset();
    if (s.err || s.tlif || s.lock) {
        feedback.derive(t);
        return fail(Reason::drive_refused,
                    fmt::format("after MS[0]=0 the drive still shows{}{}{}", s.tlif ? " a stall" : "", s.lock ? " a lock" : "",
                                s.err ? " an error" : ""),
                    t, feedback.fb().error_code);
    }
    drive_.errors.cleared();
    feedback.update(t);
    accept("", t);
}

}  // namespace axisgate::uim342
