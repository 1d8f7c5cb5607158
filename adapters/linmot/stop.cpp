// A stop that the drive does not show is sent again until the drive has had the time to show it, at least four times; then it is reported
// as failed.
#include "adapters/linmot/stop.hpp"

#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"
#include "adapters/linmot/native.hpp"

namespace axisgate::linmot {
namespace {
constexpr int at_once = 4;  ///< transmissions that follow one another without a pause
constexpr Duration look_again = std::chrono::milliseconds(5);
}  // namespace

void Stops::add(const Command& command, Turn& t) {
    const bool off = !std::holds_alternative<Halt>(command.body);
    const auto ends = [&](const Command& c) {
        return drive::is_motion(c.body) || std::holds_alternative<Action>(c.body) || (off && std::holds_alternative<Enable>(c.body));
    };
    drive_.jobs.interrupt(ends, name_of(command.body), t);
    drive_.motion.no_target();
    if (!lane_.add({command}))
        drive_.tickets.refused(command.ticket, Reason::busy, fmt::format("{} stops of {} are on their way already", limit, drive_.title()),
                               t.out);
}

void Stops::take_back(CommandBody stop, Turn& t) {
    if (!empty()) return;  // a client's stop is in progress, and is newer
    Command own;
    own.axis = drive_.axis();
    own.body = std::move(stop);
    // Tables, curves and the drive's own program can be accessed without power.
    const auto moves = [&](const Command& c) {
        const bool by_name =
            std::holds_alternative<Action>(c.body) && stated(drive_.bus.catalogue, 1, c.body).kind != Stated::Kind::nothing;
        return drive::is_motion(c.body) || by_name;
    };
    drive_.jobs.interrupt(moves, std::holds_alternative<Disable>(own.body) ? "the loss of its power" : "a motion that was not expected", t);
    drive_.motion.no_target();
    (void)lane_.add({std::move(own)});
}

void Stops::over(Outcome outcome, Reason reason, std::string text, Turn& t) {
    drive_.tickets.answer(lane_.first()->command.ticket, outcome, reason, std::move(text), t.out);
    lane_.remove(lane_.first());
    drive_.poll.soon(t.now);
}

std::optional<Telegram> Stops::request(Turn& t) {
    const Feedback& feedback = drive_.feedback;
    ControlWord& control = drive_.control;
    while (Stop* s = lane_.first()) {
        // Control words end a stream; a halt is a motion command, so the stream must be ended before it.
        if (drive_.stream.on() && !std::holds_alternative<Halt>(s->command.body)) drive_.stream.forget();
        const std::uint8_t main = feedback.status().state();
        drive_.homing.no_release();
        if (std::holds_alternative<Disable>(s->command.body)) {
            drive_.demand.forget();
            return control.write(cw_off);
        }
        if (std::holds_alternative<QuickStop>(s->command.body)) {
            if (!feedback.known() || main >= state::enabled)
                return control.write(static_cast<std::uint16_t>(cw_on & ~(drive_.options.stop_by_off3 ? cw_quick_stop : cw_abort)));
            if (main == state::tests || main == state::ready_to_operate) return control.write(cw_off);
        } else if (main == state::homing || (main > state::enabled && main != state::aborting && main != state::quick_stop)) {
            return control.write(cw_on);  // halt: a search or another motion of the drive ends when its control bit is reset
        } else if (!feedback.known() || main == state::enabled) {
            MotionOrders& motion = drive_.motion;
            if (s->step == 0) s->count = motion.next_count(t.now);
            s->step = 1;
            const std::vector<Value> values{std::int64_t{drive_.demand.deceleration()}};
            return motion.telegram(*drive_.bus.motions.named("017xh"), s->count, values);
        }
        over(Outcome::accepted, Reason::none, {}, t);  // there is no motion that this drive could stop
    }
    return std::nullopt;
}

void Stops::answered(Turn& t) {
    Stop* s = lane_.first();
    if (!s) return;
    const Status& status = drive_.feedback.status();
    const std::uint8_t main = status.state();
    bool done = true;
    if (std::holds_alternative<Disable>(s->command.body))
        done = main < state::enabled;
    else if (std::holds_alternative<QuickStop>(s->command.body))
        done = main != state::enabled;
    else if (main == state::enabled && s->step == 1)
        done = (status.sub_state() & 0x0F) == s->count;
    if (!done) {
        if (s->limit == never) s->limit = t.now + shown_within;
        if (++s->tries < at_once) return;  // sent again at once: the same control word, the same count
        s->not_before = t.now + look_again;
        if (t.now < s->limit) return;
        return over(Outcome::failed, Reason::drive_refused,
                    fmt::format("drive {} stays in {} after {}; its control word may be held by inputs, parameters or another tool",
                                drive_.title(), drive_.feedback.state_text(), name_of(s->command.body)),
                    t);
    }
    drive_.demand.stops(t);
    drive_.feedback.publish(t);
    over(Outcome::accepted, Reason::none, {}, t);
}

void Stops::silent(Turn& t) {
    Stop* s = lane_.first();
    if (s && ++s->silences >= 2)
        over(Outcome::failed, Reason::no_answer,
             fmt::format("drive {} does not answer; whether it has stopped is not known", drive_.title()), t);
}

}  // namespace axisgate::linmot
