// Drive, part stop: quick stop, halt and disable: before everything that waits, after the exchange in progress at most.
// In: the three urgent commands, supervision. Out: 0A9A (0A93 while something is processed), 0A98, 0600, 0A81, 0603; their results.
// Never lets a motion outlive a stop: what waits is ended as interrupted; a stop that is refused becomes one of all axes.
#include <fmt/core.h>

#include <algorithm>

#include "adapters/pacontrol/drive.hpp"

namespace axisgate::pacontrol {
namespace {
constexpr Duration supervise_after = std::chrono::seconds(10);
constexpr Duration switch_off_limit = std::chrono::seconds(10);  // of the start of ONLINE, as for an enable

bool is_motion(const CommandBody& b) {
    if (const auto* action = std::get_if<Action>(&b)) {
        return action->name == "reference" || action->name == "traverse_until_input" || action->name == "manual_move";
    }
    return std::holds_alternative<Move>(b) || std::holds_alternative<Home>(b) || std::holds_alternative<StartTogether>(b);
}
/// No order of this line moves an axis in this operating status.
bool nobody_commands(int mode) {
    return is_home(mode) || is_manual(mode) || mode == status::auto_stopped || mode == status::auto_stopped_malfunction ||
           mode == status::none;
}
}  // namespace

void Drive::interrupt_motions(Axis& a, std::string_view by, bool power_off, Turn& t) {
    const std::string text = fmt::format("interrupted by {}", by);
    const auto ends = [&](const Command& c) { return is_motion(c.body) || (power_off && std::holds_alternative<Enable>(c.body)); };
    if (a.job.active() && ends(a.job.command)) {
        if (a.job.processing) processing_.foreign = true;
        job_over(a, Outcome::failed, Reason::interrupted, text, t);
    }
    // A command of several axes that includes this one.
    for (Axis& x : axes_) {
        const bool member = x.job.active() && std::ranges::find(x.job.places, place(a)) != x.job.places.end();
        if (member && x.job.processing) processing_.foreign = true;
        if (member) job_over(x, Outcome::failed, Reason::interrupted, text, t);
    }
    for (auto it = a.queue.begin(); it != a.queue.end();) {
        if (!ends(*it)) {
            ++it;
            continue;
        }
        const Ticket ticket = it->ticket;
        it = a.queue.erase(it);
        result(a, ticket, Outcome::failed, Reason::interrupted, text, t);
    }
    if (a.motion.active()) end_motion(a, false, Reason::interrupted, text, t);
    end_waits(a, Reason::interrupted, text, t);
    a.prepared = false;
    a.renew_at = never;
}

void Drive::submit_stop(Axis& a, const Command& c, Turn& t) {
    Stop s;
    s.kind = std::holds_alternative<Disable>(c.body) ? Stop::Kind::off
             : std::holds_alternative<Halt>(c.body)  ? Stop::Kind::halt
                                                     : Stop::Kind::quick;
    s.axis = place(a);
    s.ticket = c.ticket;
    s.until_done = c.until_done;
    interrupt_motions(a, name_of(c.body), s.kind == Stop::Kind::off, t);
    if (stops_.size() >= stop_limit) {
        return result(a, s.ticket, Outcome::refused, Reason::busy, fmt::format("{} stops wait already", stop_limit), t);
    }
    stops_.push_back(s);
}

bool Drive::stop_ready() const noexcept {
    return std::ranges::any_of(stops_, [&](const Stop& s) {
        if (s.blind) return false;                  // has been sent; again when the answers are in step
        return !(s.stopped && processing_.active);  // 0A98 waits for the end of processing
    });
}

void Drive::send_stop(Turn& t) {
    const auto it = std::ranges::find_if(stops_, [&](const Stop& s) { return !s.blind && !(s.stopped && processing_.active); });
    if (it != stops_.begin()) {
        const Stop first = *it;
        stops_.erase(it);
        stops_.push_front(first);
    }
    Stop& s = stops_.front();
    Request r{code::stop_axis, static_cast<std::uint32_t>(s.axis) + 1, true, "0"};
    const bool standing = nobody_commands(mode_);
    if (s.level == 1 || (s.level == 0 && is_automatic(mode_) && !standing)) {
        r = {code::stop, 0, false, "0"};
    } else if (s.level >= 2) {
        leaving_ = true;
        r = {code::abort_online, 0, false, "0"};
    } else if (standing) {
        r = {code::get_state, 0, false, "0"};  // nothing that was commanded moves there: the control is asked whether that is so
        if (s.kind == Stop::Kind::off && goes_online_to_switch_off(axes_[s.axis])) r = {code::start_online, 0, false, "0"};
    } else if (s.kind == Stop::Kind::off && mode_ == status::online_started) {
        r = {code::get_state, 0, false, "0"};  // no axis is commanded before it runs
    } else if (processing_.active) {
        r.code = code::abort_move;  // 0A93 passes while a command is being processed, 0A9A and 0A98 do not
    } else if (s.kind == Stop::Kind::off && s.stopped) {
        // 0A9A first: a motion that is only switched off counts as interrupted, and the next 0A97 would let it go on.
        r = {code::axis_off, static_cast<std::uint32_t>(s.axis) + 1, false, "0"};
    }
    ++s.tries;
    send(Purpose::stop, r, s.axis, Priority::urgent, t);
}

void Drive::stop_over(Outcome outcome, Reason reason, std::string text, Turn& t, std::int32_t code) {
    if (stops_.empty()) return;
    const Stop s = stops_.front();
    stops_.pop_front();
    Axis& a = axes_[s.axis];
    if (outcome == Outcome::accepted && s.until_done && s.kind != Stop::Kind::off && s.ticket != no_ticket &&
        a.waits.size() < Axis::wait_limit) {
        add_wait(a, {Wait::For::standstill, s.ticket, 0});
        check_waits(a, t);
        return;
    }
    if (outcome == Outcome::accepted && s.until_done && s.kind == Stop::Kind::off) outcome = Outcome::done;
    result(a, s.ticket, outcome, reason, std::move(text), t, code);
}

/// Out of ONLINE an axis with enable mode 1 has power [L722]; so may one whose mode could not be read.
bool Drive::powered_at_home(const Axis& a) const noexcept {
    const Aim::Known& m = a.aim.parameters[Aim::enable_mode];
    return a.id != no_axis && !a.missing && (!m.read || !m.value || *m.value == 1);
}

bool Drive::goes_online_to_switch_off(const Axis& a) const noexcept {
    return mode_ == status::home && error_ == 0 && options_.online_auto && powered_at_home(a);
}

/// A stop where no axis is commanded, or was not a moment ago. Off is what is known to have no power, and nothing else is called that.
void Drive::stop_found_standing(Turn& t) {
    Stop& s = stops_.front();
    const Axis& a = axes_[s.axis];
    const bool off = s.kind == Stop::Kind::off;
    s.tries = 0;
    if (s.limit == never) s.limit = t.now + switch_off_limit;
    if (t.now < s.limit && (!nobody_commands(mode_) || (off && goes_online_to_switch_off(a)))) return;
    if (off && (!is_home(mode_) || powered_at_home(a))) {
        const bool by_hand = mode_ == status::home && error_ == 0;
        return stop_over(Outcome::failed, Reason::wrong_state,
                         fmt::format("nothing that was commanded moves, but the axis may have power, and only ONLINE can take it: {}",
                                     by_hand ? "start it with the action online.start, then disable again" : why_not_online()),
                         t);
    }
    emit(axes_[s.axis], t);
    stop_over(Outcome::accepted, Reason::none, fmt::format("operating status {}: no axis is commanded", status_text(mode_)), t);
}

/// What a way over home position has given power again, although it was disabled, is switched off anew.
void Drive::keep_off(Turn&) {
    for (const Axis& a : axes_) {
        if (!a.off_ordered || !powered_at_home(a) || stops_.size() >= stop_limit) continue;
        Stop s;
        s.kind = Stop::Kind::off;
        s.axis = place(a);
        stops_.push_back(s);
    }
}

void Drive::stop_answered(const Reply& reply, Turn& t) {
    if (stops_.empty()) return;
    Stop& s = stops_.front();
    Axis& a = axes_[s.axis];
    if (out_of_step_ && !processing_.active) {
        s.blind = true;  // this may have been a late answer to something else: the stop is repeated when that is sorted out
        return;
    }
    const std::uint16_t sent = exchange_.request.code;
    if (s.kind == Stop::Kind::off && sent == code::stop_axis) {
        if (reply.quit == 0 && reply.real && number_of(reply)) learn_position(a, *number_of(reply), t);
        if (reply.quit != 0) ++counters_.refused;  // it is switched off all the same
        s.stopped = true;
        s.tries = 0;
        return;
    }
    if (sent == code::start_online) {
        if (reply.quit == 0) started_by_us_ = true;
        if (reply.quit == 0 || mode_ != status::home) return stop_found_standing(t);
        ++counters_.refused;
        return stop_over(
            Outcome::failed, Reason::drive_refused,
            fmt::format("the axis may have power, and ONLINE, where it is switched off, does not start: {}", describe_quit(reply.quit)), t,
            reply.quit);
    }
    if (reply.quit != 0) {
        ++counters_.refused;
        if (is_online(mode_) || is_automatic(mode_)) {
            const std::string text = fmt::format("{}: {}", describe(exchange_.request), describe_quit(reply.quit));
            if (reply.quit == quit::axis_unknown || s.level >= 2 || (is_automatic(mode_) && sent == code::stop)) {
                return stop_over(Outcome::refused, Reason::drive_refused, text, t, reply.quit);
            }
            if (sent != code::abort_online && sent != code::stop) {
                notice(Severity::warning, "stop", reply.quit, text + "; all axes are stopped instead (0600)", t, a.id);
            }
            if (is_online(mode_)) ++s.level;
            return;
        }
        return stop_found_standing(t);
    }
    if (sent == code::get_state) return stop_found_standing(t);
    if (sent == code::abort_move) {
        if (!reply.end) {
            const bool other = processing_.active && processing_.axis != s.axis;
            if (other) {
                processing_.hidden = true;
            } else {
                processing_ = {};
                processing_.active = processing_.foreign = true;
                processing_.axis = processing_.owner = s.axis;
                processing_.code = code::abort_move;
                processing_.limit = t.now + options_.processing_limit;
            }
            processing_.next_poll = t.now;
        } else if (processing_.active && processing_.axis == s.axis) {
            processing_ = {};
        } else if (processing_.active) {
            processing_.hidden = true;
        }
        if (s.kind == Stop::Kind::off) {
            s.stopped = true;
            return;
        }
    }
    cycle_at_ = t.now;
    if (sent == code::axis_off || sent == code::abort_online) {
        a.on = false;
        a.off_ordered = s.kind == Stop::Kind::off;
        give_back_due_ = true;
    } else if (sent == code::stop_axis || sent == code::abort_move || sent == code::stop) {
        if (reply.real && number_of(reply)) learn_position(a, *number_of(reply), t);
        supervised_ = s.axis;
        supervise_at_ = t.now + supervise_after;
    }
    if (s.kind == Stop::Kind::off && sent == code::stop) {
        // Stopped with all others, and not switched off.
        const bool online = is_online(mode_);
        return stop_over(Outcome::failed, online ? Reason::drive_refused : Reason::wrong_state,
                         fmt::format("all axes were stopped (0600), but the axis could not be switched off{}{}", online ? "" : ": ",
                                     online ? "" : why_not_online()),
                         t);
    }
    emit(a, t);
    stop_over(Outcome::accepted, Reason::none, sent == code::stop ? "the control was stopped (0600): all axes" : "", t);
}

void Drive::stop_silent(Turn& t) {
    if (stops_.empty()) return;
    Stop& s = stops_.front();
    const int limit = presence_.is(Phase::ready) ? line_.timing.retries + 1 : 1;
    if (s.tries < limit) {
        ++counters_.retries;
        return;
    }
    stop_over(Outcome::failed, Reason::no_answer,
              fmt::format("the stop was sent {} time{} and not acknowledged: whether the axis stops is not known", s.tries,
                          s.tries == 1 ? "" : "s"),
              t);
}

/// An axis that still runs that long after its stop: all axes are stopped.
void Drive::supervise(Turn& t) {
    supervise_at_ = never;
    Axis& a = axes_[supervised_];
    if (!a.running || a.motion.active() || !presence_.is(Phase::ready) || stops_.size() >= stop_limit) return;
    notice(Severity::warning, "stop", 0,
           fmt::format("axis {} still runs {} s after it was stopped: all axes are stopped (0600)", a.channel,
                       milliseconds_of(supervise_after) / 1000),
           t, a.id);
    Stop s;
    s.axis = supervised_;
    s.level = 1;
    s.by_supervision = true;
    stops_.push_back(s);
}

}  // namespace axisgate::pacontrol
