// Stops: which command stops an axis in which operating status, and what its answer means.
// In: stops that wait, acknowledgements, silences. Out: the next stop, results, a stop of all axes where one was not enough.
// Off is what is known to have no power, and nothing else is called that.
#include "adapters/pacontrol/stop.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "adapters/pacontrol/wire_number.hpp"

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr std::uint8_t unread_stop_tries = 8;                 // of one stop that the control could not read
constexpr Duration braking_limit = std::chrono::seconds(10);  // of an axis that was stopped, before it takes a motion
constexpr Duration supervise_after = std::chrono::seconds(10);
constexpr Duration switch_off_limit = std::chrono::seconds(10);  // of the start of ONLINE, as for an enable

bool moves(const CommandBody& b) {
    if (const auto* action = std::get_if<Action>(&b))
        return action->name == "reference" || action->name == "traverse_until_input" || action->name == "manual_move";
    return drive::is_motion(b);
}
/// No order of this line moves an axis in this operating status.
bool nobody_commands(int mode) {
    return is_home(mode) || is_manual(mode) || mode == status::auto_stopped || mode == status::auto_stopped_malfunction ||
           mode == status::none;
}
}  // namespace

void Stops::interrupt(Axis& a, std::string_view by, bool power_off, Turn& t) {
    const std::string text = drive::CommandQueue::interrupted_by(by);
    const auto ends = [&](const Command& c) { return moves(c.body) || (power_off && std::holds_alternative<Enable>(c.body)); };
    for (Axis& x : drive_.axes) {
        const Job& j = x.job;
        // Its own, or one of several axes that includes this one.
        if (!j.active() || !((&x == &a && ends(j.command)) || std::ranges::find(j.places, a.place()) != j.places.end())) continue;
        if (j.processing) drive_.processing.foreign = true;
        drive_.jobs.over(x, Outcome::failed, Reason::interrupted, text, t);
    }
    a.queue.interrupt(ends, by, drive_.tickets, t);
    if (a.motion.active()) drive_.feedback.end_motion(a, false, Reason::interrupted, text, t);
    drive_.feedback.end_waits(a, Reason::interrupted, text, t);
    a.prepared = false;
    a.renewal.stop();
}

void Stops::submit(Axis& a, const Command& c, Turn& t) {
    const Kind kind = std::holds_alternative<Disable>(c.body) ? Kind::off : std::holds_alternative<Halt>(c.body) ? Kind::halt : Kind::quick;
    interrupt(a, name_of(c.body), kind == Kind::off, t);
    if (waiting_.add({.kind = kind, .axis = a.place(), .command = c})) return;
    drive_.tickets.refused(c.ticket, Reason::busy, fmt::format("{} stops wait already", Control::stop_limit), t.out);
}

void Stops::keep_off() {
    for (const Axis& a : drive_.axes) {
        if (a.off_ordered && drive_.powered_at_home(a)) add(Kind::off, a);
    }
}

void Stops::fail_all(Reason reason, const std::string& text, Turn& t) {
    waiting_.each(
        [&](const Stop& s) { drive_.tickets.failed(s.command.ticket, reason, text + ": whether the axis stops is not known", t.out); });
    waiting_.clear();
}

bool Stops::may_go(const Stop& s) const noexcept { return !s.blind && !(s.stopped && drive_.processing.active); }

bool Stops::ready() const noexcept {
    bool any = false;
    waiting_.each([&](const Stop& s) { any = any || may_go(s); });
    return any;
}

/// Nothing that was commanded moves in home position, but ONLINE alone can take power from the axis.
bool Stops::goes_online(const Stop& s) const noexcept {
    return s.kind == Kind::off && drive_.mode == status::home && drive_.error == 0 && drive_.options.online_auto &&
           !drive_.axes[s.axis].no_switch && drive_.powered_at_home(drive_.axes[s.axis]);
}

Request Stops::request_of(const Stop& s) const {
    const std::uint32_t axis = drive_.axes[s.axis].number();
    const bool standing = nobody_commands(drive_.mode), off = s.kind == Kind::off;
    if (s.level == 1 || (s.level == 0 && is_automatic(drive_.mode) && !standing)) return request_for(code::stop);
    if (s.level >= 2) return request_for(code::abort_online);
    // Nothing that was commanded moves there: the control is asked whether that is so.
    if (standing) return request_for(goes_online(s) ? code::start_online : code::get_state);
    if (off && drive_.mode == status::online_started) return request_for(code::get_state);  // no axis is commanded before it runs
    // 0A93 passes while a command is being processed, 0A9A and 0A98 do not.
    if (drive_.processing.active) return request_for(code::abort_move, axis);
    // 0A9A first: a motion that is only switched off counts as interrupted, and the next 0A97 would let it go on.
    if (off && s.stopped) return request_for(code::axis_off, axis);
    return request_for(s.by_abort || drive_.stop_axis_missing ? code::abort_move : code::stop_axis, axis);
}

const CommandBody* Stops::locking(const Axis& a) const noexcept {
    static const CommandBody quick{QuickStop{}}, off{Disable{}};
    const CommandBody* which = nullptr;
    waiting_.each([&](const Stop& s) {
        if (s.axis == a.place() && s.kind != Kind::halt) which = s.kind == Kind::off ? &off : &quick;
    });
    return which;
}

void Stops::send(Turn& t) {
    sent_ = nullptr;
    waiting_.each([&](Stop& s) {
        if (!sent_ && may_go(s)) sent_ = &s;
    });
    if (!sent_) return;
    const Request r = request_of(*sent_);
    if (r.code == code::abort_online) drive_.leaving = true;
    ++sent_->tries;
    drive_.port.send({Purpose::stop, sent_->axis, r, false, {}, sent_->command.ticket}, Priority::urgent, t);
}

void Stops::over(Stop& s, Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code) {
    const Stop was = s;
    waiting_.remove(&s);
    if (outcome == Outcome::accepted && was.kind != Kind::off)
        return drive_.feedback.accepted(drive_.axes[was.axis], was.command, Wait::For::standstill, 0, std::move(text), t);
    if (outcome == Outcome::accepted && was.command.until_done) outcome = Outcome::done;
    drive_.tickets.answer(was.command.ticket, outcome, reason, std::move(text), t.out, code);
}

/// A stop where no axis is commanded, or was not a moment ago.
void Stops::found_standing(Stop& s, Turn& t) {
    Axis& a = drive_.axes[s.axis];
    s.tries = 0;
    if (s.limit == never) s.limit = t.now + switch_off_limit;
    if (t.now < s.limit && (!nobody_commands(drive_.mode) || goes_online(s))) return;
    if (s.kind == Kind::off && !a.no_switch && (!is_home(drive_.mode) || drive_.powered_at_home(a))) {
        const bool by_hand = drive_.mode == status::home && drive_.error == 0;
        return over(s, Outcome::failed, Reason::wrong_state,
                    "nothing that was commanded moves, but the axis may have power, and only ONLINE can take it: " +
                        (by_hand ? "start it with the action online.start, then disable again" : drive_.why_not_online()),
                    t);
    }
    drive_.feedback.publish(a, t);
    over(s, Outcome::accepted, Reason::none,
         drive_.mode_text() + ": no axis is commanded" +
             (s.kind == Kind::off && a.no_switch ? "; the control does not switch the axis, so it may have power" : ""),
         t);
}

void Stops::refused(Stop& s, std::uint16_t code, const Sent& sent, Turn& t) {
    ++drive_.bus.counters.refused;
    const bool online = is_online(drive_.mode), automatic = is_automatic(drive_.mode);
    if (!online && !automatic) return found_standing(s, t);
    const std::string text = fmt::format("{}: {}", describe(sent.request), describe_quit(code));
    const bool all = sent.request.code == code::stop;
    if (code == quit::axis_unknown || s.level >= 2 || (automatic && all))
        return over(s, Outcome::refused, Reason::drive_refused, text, t, code);
    if (!all && sent.request.code != code::abort_online)
        drive_.notice(Severity::warning, "stop", code, text + "; all axes are stopped instead (0600)", t, drive_.axes[s.axis].id);
    if (online) ++s.level;
}

/// What the control does not have or does not take now, and what is done instead.
bool Stops::goes_another_way(Stop& s, std::uint16_t what, const Reply& reply, Turn& t) {
    const bool unknown = reply.quit == quit::unknown_command, not_now = reply.quit == quit::not_executable;
    if (what == code::stop_axis && (unknown || (not_now && t.now < drive_.busy_until))) {
        ++drive_.bus.counters.refused;
        if (unknown) drive_.stop_axis_missing = true;
        s.by_abort = true;
        s.tries = 0;
        return true;
    }
    if (what != code::axis_off || !(unknown || not_now) || (drive_.mode != status::online && drive_.mode != status::online_stopped))
        return false;
    Axis& a = drive_.axes[s.axis];
    drive_.power.has_no_switch(a, reply.quit, t);
    drive_.polls.hurry(t.now);
    over(s, Outcome::failed, Reason::drive_refused,
         "the axis was stopped, but it keeps its power: the control does not switch it off (0A98: " + describe_quit(reply.quit) + ")", t,
         reply.quit);
    return true;
}

/// 0A93 tells whether something is still being processed, of whichever axis.
void Stops::abort_answered(Stop& s, const Reply& reply, Instant now) {
    Processing& p = drive_.processing;
    const bool of_another = p.active && p.axis != s.axis;
    if (of_another) {
        p.hidden = true;
        if (!reply.end) p.next_poll = now;
    } else if (reply.end) {
        p = {};
    } else {
        drive_.begin_processing(s.axis, code::abort_move, true, now);
    }
}

void Stops::answered(const Sent& sent, const Reply& reply, Turn& t) {
    if (!sent_ || waiting_.empty()) return;
    Stop& s = *sent_;
    Axis& a = drive_.axes[s.axis];
    if (drive_.port.out_of_step() && !drive_.processing.active) {
        s.blind = true;  // this may have been a late answer to something else: the stop is repeated when that is sorted out
        return;
    }
    const std::uint16_t what = sent.request.code;
    const bool off = s.kind == Kind::off, place_known = reply.real && number_of(reply);
    if (goes_another_way(s, what, reply, t)) return;
    if (off && what == code::stop_axis) {
        if (reply.quit == 0 && place_known) drive_.feedback.learn_position(a, reply, t);
        if (reply.quit != 0) ++drive_.bus.counters.refused;  // it is switched off all the same
        a.stopping_until = t.now + braking_limit;
        s.stopped = true;
        s.tries = 0;
        return;
    }
    if (what == code::start_online) {
        if (reply.quit == 0) drive_.started_by_us = true;
        if (reply.quit == 0 || drive_.mode != status::home) return found_standing(s, t);
        ++drive_.bus.counters.refused;
        return over(
            s, Outcome::failed, Reason::drive_refused,
            fmt::format("the axis may have power, and ONLINE, where it is switched off, does not start: {}", describe_quit(reply.quit)), t,
            reply.quit);
    }
    if (reply.quit != 0) return refused(s, reply.quit, sent, t);
    if (what == code::get_state) return found_standing(s, t);
    if (what == code::abort_move) {
        abort_answered(s, reply, t.now);
        if (off) {
            s.stopped = true;
            return;
        }
    }
    drive_.polls.hurry(t.now);
    a.stopping_until = t.now + braking_limit;
    if (what == code::axis_off || what == code::abort_online) {
        a.on = false;
        a.off_ordered = off;
        drive_.give_back_due = true;
    } else {
        if (place_known) drive_.feedback.learn_position(a, reply, t);
        supervised_ = s.axis;
        supervise_at_ = t.now + supervise_after;
    }
    if (off && what == code::stop) {
        // Stopped with all others, and not switched off.
        const bool online = is_online(drive_.mode);
        return over(s, Outcome::failed, online ? Reason::drive_refused : Reason::wrong_state,
                    "all axes were stopped (0600), but the axis could not be switched off" +
                        (online ? std::string() : ": " + drive_.why_not_online()),
                    t);
    }
    drive_.feedback.publish(a, t);
    over(s, Outcome::accepted, Reason::none, what == code::stop ? "the control was stopped (0600): all axes" : "", t);
}

void Stops::not_read(const Reply& reply, Turn& t) {
    if (!sent_ || waiting_.empty() || ++sent_->tries < unread_stop_tries) return;
    over(*sent_, Outcome::failed, Reason::drive_refused, describe_quit(reply.quit), t, reply.quit);
}

void Stops::silent(Turn& t) {
    if (!sent_ || waiting_.empty()) return;
    const int tries = sent_->tries;
    if (tries < (drive_.ready() ? drive_.bus.timing.retries + 1 : 1)) {
        ++drive_.bus.counters.retries;
        return;
    }
    over(*sent_, Outcome::failed, Reason::no_answer,
         fmt::format("the stop was sent {} time{} and not acknowledged: whether the axis stops is not known", tries, tries == 1 ? "" : "s"),
         t);
}

void Stops::in_step() {
    waiting_.each([](Stop& s) { s.blind = false; });
}

/// An axis that still runs that long after its stop: all axes are stopped.
void Stops::on_deadline(Turn& t) {
    if (supervise_at_ > t.now) return;
    supervise_at_ = never;
    const Axis& a = drive_.axes[supervised_];
    if (!a.running || a.motion.active() || !drive_.ready() || waiting_.size() >= Control::stop_limit) return;
    drive_.notice(Severity::warning, "stop", 0,
                  fmt::format("axis {} still runs {} s after it was stopped: all axes are stopped (0600)", a.channel,
                              milliseconds_of(supervise_after) / 1000),
                  t, a.id);
    (void)waiting_.add({.axis = supervised_, .level = 1});
}

}  // namespace axisgate::pacontrol
