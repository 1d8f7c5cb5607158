// Drive, part presence: finding the control, losing it, and what that means for what was on its way.
// In: answers and silences. Out: links, failed commands, probes after growing pauses.
// Never takes the end of a motion for granted that nobody saw: it is told as not known, with the position that is read back later.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/pacontrol/drive.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {

void Drive::link(bool online, std::string text, Turn& t) {
    online_link_ = online;
    t.out.links.push_back({setup_.id, online, silent_, online ? Duration::zero() : retry_pause_, std::move(text)});
}

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
    phase_ = Phase::probing;
    silent_ = 0;
    retry_pause_ = manners_.pause_min;
    next_probe_ = t.now;
    quiet_until_ = t.now;
    for (const auto& f : options_.faults)
        notice(Severity::warning, "setup", 0, f, t);
}

void Drive::line_down(Turn& t, std::string_view why) {
    fail_all(Reason::line_down, std::string(why), t);
    forget();
    phase_ = Phase::down;
    next_probe_ = never;
    link(false, std::string(why), t);
}

void Drive::found(Turn& t) {
    phase_ = Phase::ready;
    next_probe_ = never;
    silent_ = 0;
    mode_ = -1;
    out_of_step_ = true;  // answers to older probes may still be on their way
    cycle_at_ = t.now;
    link(true, ever_seen_ ? "the PA-CONTROL answers again" : "the PA-CONTROL answers", t);
    ever_seen_ = true;
}

void Drive::count_silence(Turn& t) {
    ++silent_;
    const auto limit = static_cast<std::uint32_t>(manners_.silent_limit);
    switch (phase_) {
        case Phase::down:
            return;
        case Phase::ready:
            if (silent_ >= limit) go_absent(t, fmt::format("{} requests in a row were not answered", silent_));
            return;
        case Phase::probing:
            if (silent_ >= limit) return go_absent(t, "no answer");
            return link(false, "no answer yet", t);
        case Phase::absent:
            retry_pause_ = std::min(retry_pause_ * 2, manners_.pause_max);
            next_probe_ = t.now + retry_pause_;
            return link(false, "no answer", t);
    }
}

void Drive::go_absent(Turn& t, std::string why) {
    const std::string text = fmt::format("the PA-CONTROL {} does not answer: {}", setup_.name, why);
    fail_all(Reason::no_answer, text, t);
    forget();
    phase_ = Phase::absent;
    retry_pause_ = manners_.pause_min;
    next_probe_ = t.now + retry_pause_;
    link(false, std::move(why), t);
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
