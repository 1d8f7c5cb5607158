// Stops: halt by VAI Stop, quick stop by /Abort (or OFF3, an option), disable by the switch on bit. They overtake all that waits.
// In: urgent commands. Out: one telegram each, ended by what the drive shows. Never waits for more than the exchange in progress.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr std::size_t most_stops = 16;
}

void Drive::follow(const SetPoint& p) {
    if (p.axis != axis_ || !presence_.online()) return;
    if (streams_ && p.mode == SetPoint::Mode::position && stream_period() > Duration{} && !stream_.ending) {
        stream_.newest = p;
        return;
    }
    if (stream_.on) stream_.ending = true;  // another mode
    set_points_.put(p);
}

void Drive::submit(const Command& command, Turn& t) {
    if (is_urgent(command.body) || drive::is_motion(command.body)) {
        set_points_.clear();
        stream_.newest.reset();
        stream_.ending = stream_.on;
    } else if (stream_.on && !stream_.ending) {
        drive::Tickets::refuse(
            command, Reason::busy,
            fmt::format("drive {} follows a stream that leaves no time for other exchanges: end the stream first", title()), t.out);
        return;
    }
    switch (drive::admit(command, title(), presence_, queue_, tickets_, t)) {
        case drive::Admission::urgent:
            return begin_stop(command, t);
        default:
            return;
    }
}

void Drive::begin_stop(const Command& command, Turn& t) {
    const std::string_view by = name_of(command.body);
    const bool off = !std::holds_alternative<Halt>(command.body);
    const auto ends = [&](const Command& c) {
        return drive::is_motion(c.body) || std::holds_alternative<Action>(c.body) || (off && std::holds_alternative<Enable>(c.body));
    };
    (void)queue_.interrupt(ends, by, tickets_, t);
    if (job_.active && ends(job_.command)) {
        if (exchange_.active() && exchange_.request().purpose == Purpose::job) exchange_.no_repeats();
        end_job(Outcome::failed, Reason::interrupted, drive::CommandQueue::interrupted_by(by), t);
    }
    to_target_ = false;
    if (stops_.size() >= most_stops) {
        tickets_.refused(command.ticket, Reason::busy, fmt::format("{} stops of {} are on their way already", most_stops, title()), t.out);
        return;
    }
    stops_.push_back({command});
}

void Drive::end_stop(Outcome outcome, Reason reason, std::string text, Turn& t) {
    tickets_.answer(stops_.front().command.ticket, outcome, reason, std::move(text), t.out);
    stops_.pop_front();
    poll_.soon(t.now);
}

std::optional<Telegram> Drive::stop_request(Turn& t) {
    while (!stops_.empty()) {
        Stop& s = stops_.front();
        // Control words end a stream by themselves; a halt is a motion command, and the stream is left before it.
        if (stream_.on && !std::holds_alternative<Halt>(s.command.body)) stream_ = {};
        const std::uint8_t main = status_.state();
        release_home_ = false;
        if (std::holds_alternative<Disable>(s.command.body)) {
            demand_.forget();
            return control(cw_off);
        }
        if (std::holds_alternative<QuickStop>(s.command.body)) {
            if (!status_known_ || main >= state::enabled)
                return control(static_cast<std::uint16_t>(cw_on & ~(stop_by_off3_ ? cw_quick_stop : cw_abort)));
            if (main == state::tests || main == state::ready_to_operate) return control(cw_off);
        } else if (main == state::homing || (main > state::enabled && main != state::aborting && main != state::quick_stop)) {
            return control(cw_on);  // halt: a search or a move of the drive's own ends when its bit is taken back
        } else if (!status_known_ || main == state::enabled) {
            const Motion& stop = *bus_.motions.named("017xh");
            if (s.step == 0) s.count = next_count();
            s.step = 1;
            const std::vector<Value> values{std::int64_t{move_d_ ? move_d_ : dec_.value_or(100'000)}};
            return motion_telegram(stop, s.count, values);
        }
        end_stop(Outcome::accepted, Reason::none, {}, t);  // nothing moves that this drive could stop
    }
    return std::nullopt;
}

void Drive::stop_answered(Turn& t) {
    if (stops_.empty()) return;
    Stop& s = stops_.front();
    const std::uint8_t main = status_.state();
    bool done = true;
    if (std::holds_alternative<Disable>(s.command.body))
        done = main < state::enabled;
    else if (std::holds_alternative<QuickStop>(s.command.body))
        done = main != state::enabled;
    else if (main == state::enabled && s.step == 1)
        done = (status_.sub_state() & 0x0F) == s.count;
    if (!done) {
        if (++s.tries < 4) return;  // sent again at once: the same word, the same count
        return end_stop(Outcome::failed, Reason::drive_refused,
                        fmt::format("drive {} stays in {} after {}; its control word may be held by inputs, parameters or another tool",
                                    title(), state_text(), name_of(s.command.body)),
                        t);
    }
    demand_stops(t);
    tell(t);
    end_stop(Outcome::accepted, Reason::none, {}, t);
}

}  // namespace axisgate::linmot
