// Drive, part presence: finding the control, losing it, and what that means for what was on its way.
// In: answers and silences. Out: links, failed commands, probes after growing pauses.
// Never takes the end of a motion for granted that nobody saw: it is told as not known, with the position that is read back later.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {

/// Everything that may have changed while nobody listened.
void Drive::forget() {
    exchange_ = {};
    framer_.reset();
    processing_ = {};
    out_of_step_ = true;
    heard_in_barrier_ = look_due_ = false;
    mode_ = -1;
    error_ = 0;
    started_by_us_ = leaving_ = give_back_due_ = false;
    supervise_at_ = never;
    polls_.clear();
    first_cycle_ = true;
    for (Axis& a : axes_) {
        a.fb = {};
        a.fb.position = a.fb.position_demand = a.counter;
        a.aim = {};
        a.position_known = a.missing = a.on = a.running = a.prepared = a.condition_set = a.extended_missing = false;
        a.status = a.limits = -1;
        a.counter_at = a.velocity_at = a.running_at = a.status_at = {};
        a.motion = {};
        a.speed.reset();
        a.acceleration.reset();
        a.renew_at = never;
    }
    system_flags_missing_ = false;
}

void Drive::line_up(Turn& t) {
    forget();
    presence_.begin(t.now);
    quiet_until_ = t.now;
    for (const auto& f : options_.faults)
        notice(Severity::warning, "setup", 0, f, t);
}

void Drive::line_down(Turn& t, std::string_view why) {
    fail_all(Reason::line_down, std::string(why), t);
    forget();
    presence_.close();
    presence_.report(std::string(why), t.out);
}

void Drive::found(Turn& t) {
    const bool again = presence_.ever_found();
    presence_.found();
    presence_.made_ready();  // nothing has to be read before commands are taken
    mode_ = -1;
    out_of_step_ = true;  // answers to older probes may still be on their way
    cycle_at_ = t.now;
    presence_.report(again ? "the PA-CONTROL answers again" : "the PA-CONTROL answers", t.out);
}

void Drive::count_silence(Turn& t) {
    const bool was_ready = presence_.is(Phase::ready);
    std::string why = "no answer";
    switch (presence_.silent(t.now)) {
        case drive::Presence::Silence::counted:
            if (presence_.is(Phase::probing)) presence_.report("no answer yet", t.out);
            return;
        case drive::Presence::Silence::still_absent:
            return presence_.report(std::move(why), t.out);
        case drive::Presence::Silence::lost:
            break;
    }
    if (was_ready) why = fmt::format("{} requests in a row were not answered", presence_.silences());
    fail_all(Reason::no_answer, fmt::format("the PA-CONTROL {} does not answer: {}", setup_.name, why), t);
    forget();
    presence_.report(std::move(why), t.out);
}

void Drive::fail_axis(Axis& a, Reason reason, const std::string& text, Turn& t) {
    if (a.motion.active()) {
        const bool position = a.motion.kind == Motion::Kind::position || a.motion.kind == Motion::Kind::manual;
        a.lost = a.motion.kind == Motion::Kind::reference ? std::string("the end of a reference run was never heard")
                 : position ? fmt::format("the end of a motion to {} was never heard", axis_text(a.motion.target))
                            : std::string("the end of a motion was never heard");
    }
    job_over(a, Outcome::failed, reason, a.motion.active() ? text + "; whether the motion has ended is not known" : text, t);
    end_waits(a, reason, text + "; the end of the motion was never heard: whether it was reached is not known", t, false);
    a.motion = {};
    a.renew_at = never;
    auto queue = std::move(a.queue);
    a.queue.clear();
    for (const Command& c : queue)
        result(a, c.ticket, Outcome::failed, reason, text, t);
}

void Drive::fail_all(Reason reason, const std::string& text, Turn& t) {
    for (Axis& a : axes_) {
        if (a.id != no_axis) fail_axis(a, reason, text, t);
    }
    auto stops = std::move(stops_);
    stops_.clear();
    for (const Stop& s : stops)
        result(axes_[s.axis], s.ticket, Outcome::failed, reason, text + ": whether the axis stops is not known", t);
}

}  // namespace axisgate::pacontrol
