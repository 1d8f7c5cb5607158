// Drive, part start: finding the control, losing it, and what that means for what was on its way.
// In: answers and silences. Out: links, failed commands, probes after growing pauses.
// Never takes the end of a motion for granted that nobody saw: it is published as not known, with the position that is read back later.
#include <fmt/core.h>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {

void Drive::forget_all() {
    port.forget();
    forget();
    stops.forget();
    polls.clear();
    polls.start_over();
}

void Drive::line_up(Turn& t) {
    forget_all();
    presence.begin(t.now);
    port.restart(t.now);
    tell_setup(options.faults, t);
}

void Drive::line_down(std::string_view why, Turn& t) {
    remove(why, t);
    presence.report(std::string(why), t.out);
}

void Drive::remove(std::string_view why, Turn& t) {
    fail_all(Reason::line_down, std::string(why), t);
    forget_all();
    presence.close();
}

void Drive::found(Turn& t) {
    const bool again = presence.ever_found();
    presence.found();
    presence.made_ready();  // nothing has to be read before commands are taken
    mode = -1;
    port.lose_step();  // answers to older probes may still be on their way
    polls.hurry(t.now);
    presence.report(again ? "the PA-CONTROL answers again" : "the PA-CONTROL answers", t.out);
}

void Drive::count_silence(Turn& t) {
    const bool was_ready = ready();
    std::string why = "no answer";
    switch (presence.silent(t.now)) {
        case drive::Presence::Silence::counted:
            if (presence.is(Phase::probing)) presence.report("no answer yet", t.out);
            return;
        case drive::Presence::Silence::still_absent:
            return presence.report(std::move(why), t.out);
        case drive::Presence::Silence::lost:
            break;
    }
    if (was_ready) why = fmt::format("{} requests in a row were not answered", presence.silences());
    fail_all(Reason::no_answer, fmt::format("the PA-CONTROL {} does not answer: {}", name(), why), t);
    forget_all();
    presence.report(std::move(why), t.out);
}

void Drive::fail_axis(Axis& a, Reason reason, const std::string& text, Turn& t) {
    const Motion was = std::exchange(a.motion, Motion{});
    if (was.active()) {
        const bool position = was.kind == Motion::Kind::position || was.kind == Motion::Kind::manual;
        a.lost = was.kind == Motion::Kind::reference ? std::string("the end of a reference run was never heard")
                 : position                          ? fmt::format("the end of a motion to {} was never heard", axis_text(was.target))
                                                     : std::string("the end of a motion was never heard");
    }
    jobs.over(a, Outcome::failed, reason, was.active() ? text + "; whether the motion has ended is not known" : text, t);
    feedback.end_waits(a, reason, text + "; the end of the motion was never heard: whether it was reached is not known", t, false);
    a.renewal.stop();
    a.queue.clear();
    tickets.fail_axis(a.id, reason, text, t.out);
}

void Drive::fail_all(Reason reason, const std::string& text, Turn& t) {
    stops.fail_all(reason, text, t);
    for (Axis& a : axes) {
        if (a.used()) fail_axis(a, reason, text, t);
    }
}

}  // namespace axisgate::pacontrol
