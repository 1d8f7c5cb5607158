// Drive, part motion: each command as a short list of transfers, and what follows from their answers.
// In: commands, answers to their steps. Out: steps, the one result. A control word that moves is the last of its list.
#include <fmt/core.h>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {
namespace {
constexpr std::uint16_t on_word = 0x0F, halt_bit = 0x100, start_bit = 0x10, go_word = 0x3F;
bool fits_i32(std::int64_t v) { return v >= INT32_MIN && v <= INT32_MAX; }
}  // namespace

void Drive::write(Job& job, Address a, std::int64_t v, std::size_t size, bool optional) const {
    job.steps.push_back({Step::Kind::write, a, bytes_of(v, size), 0, 0, optional});
}
void Drive::word(Job& job, std::uint16_t cw) const { write(job, object::controlword, cw, 2); }
void Drive::enter_mode(Job& job, int mode) const {
    if (mode_ != mode) write(job, object::mode, mode, 1);
}

void Drive::begin(Command command, Turn& t) {
    Job job;
    job.command = std::move(command);
    Reason reason = Reason::not_supported;
    std::string why = plan(job, reason);
    if (!why.empty()) return void(tickets_.refused(job.command.ticket, reason, std::move(why), t.out));
    job_ = std::move(job);
}

/// Empty, or why it is refused.
std::string Drive::plan(Job& job, Reason& reason) const {
    const CommandBody& body = job.command.body;
    const unsigned state = fb_.statusword.value_or(0) & 0x6Fu;
    const bool on = state == 0x27;
    const auto until = [&](std::uint32_t mask, std::uint32_t want) {
        job.steps.push_back({Step::Kind::until, object::statusword, {}, mask, want});
    };
    if (std::holds_alternative<Enable>(body)) {
        reason = Reason::wrong_state;
        if (fb_.fault) return "the drive is in a fault: reset it first";
        // Nothing may move because of this: no speed is wanted, and positioning waits for its start bit.
        if (offers(3) || offers(9)) write(job, object::target_velocity, 0, 4, true);
        if (offers(1)) write(job, object::mode, 1, 1);
        if (!on && state != 0x07) {
            word(job, 0x06), until(0x6F, 0x21);
            word(job, 0x07), until(0x6F, 0x23);
        } else if (!on) {  // out of a quick stop, when it has ended
            job.steps.push_back({Step::Kind::until, object::velocity, {}, 0xFFFFFFFFu, 0, true});
        }
        word(job, on_word), until(0x6F, 0x27);
        return {};
    }
    if (std::holds_alternative<ResetFault>(body)) {
        if (!fb_.fault) return job.steps.push_back({Step::Kind::read, object::error_code, {}}), "";
        for (const int cw : {0x00, 0x80, 0x00})
            word(job, static_cast<std::uint16_t>(cw));
        return {};
    }
    if (const auto* home = std::get_if<Home>(&body)) {
        if (!offers(6)) return "this drive has no homing mode (6502h)";
        reason = Reason::wrong_state;
        if (!on) return "the axis is off: enable it first";
        reason = Reason::out_of_range;
        if (home->method < -128 || home->method > 127) return "a homing method is a number from -128 to 127";
        return plan_homing(job, home->method == 0 ? std::nullopt : std::optional(home->method)), "";
    }
    if (const auto* set = std::get_if<SetPosition>(&body)) {
        if (!offers(6)) return "this drive has no homing mode (6502h), by which a position is set";
        reason = Reason::wrong_state;
        if (!on) return "the axis is off: enable it first";
        if (fb_.moving) return "the axis moves: stop it first";
        reason = Reason::out_of_range;
        if (!fits_i32(set->position)) return "a position is a number of 32 bits";
        write(job, object::home_offset, set->position, 4);
        plan_homing(job, 37);
        until(0x1000, 0x1000);
        word(job, on_word);
        if (homing_method_ != 37) write(job, object::homing_method, homing_method_, 1, true);
        return {};
    }
    if (const auto* move = std::get_if<Move>(&body)) return plan_move(job, *move, reason);
    if (std::holds_alternative<ReadParameter>(body) || std::holds_alternative<WriteParameter>(body)) return plan_parameter(job, reason);
    if (const auto* native = std::get_if<Native>(&body)) return plan_native(job, *native, reason);
    if (const auto* action = std::get_if<Action>(&body)) return plan_action(job, *action, reason);
    return fmt::format("a CiA 402 drive on this line has no {}", name_of(body));
}

void Drive::plan_homing(Job& job, std::optional<std::int16_t> method) const {
    if (method) write(job, object::homing_method, *method, 1);
    enter_mode(job, 6);
    word(job, on_word);
    word(job, on_word | start_bit);
}

std::string Drive::plan_move(Job& job, const Move& m, Reason& reason) const {
    const int mode = m.kind == Move::Kind::velocity ? 3 : 1;
    if (m.prepare_only) return "a CiA 402 drive on this line prepares no motion: start it alone";
    if (!offers(mode)) return fmt::format("this drive has no {} mode (6502h)", mode == 3 ? "profile velocity" : "profile position");
    reason = Reason::wrong_state;
    if ((fb_.statusword.value_or(0) & 0x6Fu) != 0x27) return "the axis is off: enable it first";
    reason = Reason::out_of_range;
    if (!fits_i32(m.target)) return "a target is a number of 32 bits";
    const auto rate = [&](Address a, const std::optional<std::int64_t>& v) {
        if (v) write(job, a, *v, 4);
        return !v || (*v > 0 && *v <= UINT32_MAX);
    };
    if (!rate(object::profile_acceleration, m.acceleration) || !rate(object::profile_deceleration, m.deceleration) ||
        (mode == 1 && !rate(object::profile_velocity, m.velocity)))
        return "velocity, acceleration and deceleration are numbers from 1 to 4294967295";
    if (mode == 3) {
        write(job, object::target_velocity, m.target, 4);
        enter_mode(job, 3);
        if (cw_ != on_word) word(job, on_word);
        return {};
    }
    // A halt stands until the new target goes: without it the drive would go on to the old one.
    if (cw_ & start_bit) word(job, static_cast<std::uint16_t>((cw_ & halt_bit) | on_word));
    enter_mode(job, 1);
    if (m.kind == Move::Kind::relative) job.steps.push_back({Step::Kind::read, object::position, {}});
    write(job, object::target_position, m.target, 4);
    job.steps.back().from_here = m.kind == Move::Kind::relative;
    word(job, go_word);
    word(job, on_word);
    return {};
}

/// A stop is planned when its turn has come: what is on then counts.
Drive::Job Drive::stop_job(const Command& c) const {
    Job job;
    job.command = c;
    const bool may_be_on = fb_.power == AxisFeedback::Power::on || (cw_ & 0x0Fu) == on_word;
    if (std::holds_alternative<Disable>(c.body)) {
        if (may_be_on && !fb_.fault) {
            if ((fb_.statusword.value_or(0) & 0x6Fu) != 0x07) word(job, 0x07);
            job.steps.push_back({Step::Kind::until, object::velocity, {}, 0xFFFFFFFFu, 0, true, false, std::chrono::seconds(5)});
        }
        word(job, 0x00);
        if (!fb_.fault)
            job.steps.push_back({Step::Kind::until, object::statusword, {}, 0x4F, 0x40, true, false, std::chrono::milliseconds(200)});
    } else if (std::holds_alternative<QuickStop>(c.body)) {
        word(job, 0x0B);
    } else {
        word(job, static_cast<std::uint16_t>((cw_ & 0x0Fu) | halt_bit));
    }
    return job;
}

void Drive::step_done(Job& job, const canopen::SdoEnd& end, Turn& t) {
    const Step& s = job.steps[job.at];
    const bool of_stop = is_urgent(job.command.body);
    const auto drop = [&] {
        if (of_stop) {
            stops_.remove(stops_.first());
        } else {
            job_.reset();
        }
    };
    if (!end.done() && !s.optional) {
        const std::string text = "the drive refuses: " + canopen::to_text(end);
        if (job.stream) {
            t.out.stream_ends.push_back({axis_, Reason::drive_refused, text});
            end_stream();
        }
        tickets_.refused(job.command.ticket, Reason::drive_refused, text, t.out, static_cast<std::int32_t>(end.abort));
        return drop();
    }
    if (end.done() && s.kind == Step::Kind::write && s.address == object::controlword)
        cw_ = static_cast<std::uint16_t>(canopen::low_first(s.bytes));
    if (end.done() && s.kind == Step::Kind::write && s.address == object::mode) mode_ = static_cast<int>(signed_of(s.bytes));
    if (s.kind == Step::Kind::read) {
        job.here = signed_of(end.data);
        job.data = end.data;
    }
    // What the drive has just answered is newer than its last PDO: who hears "enabled" finds it shown, and may go on at once.
    if (s.kind == Step::Kind::until && s.address == object::statusword && end.done()) {
        fb_.native_status = static_cast<std::uint32_t>(canopen::low_first(end.data));
        judge(t);
    }
    if (s.kind == Step::Kind::until && end.done() && (canopen::low_first(end.data) & s.mask) != s.want) {
        if (job.give_up == never) job.give_up = t.now + s.patience;
        job.wait_until = t.now + std::chrono::milliseconds(10);
        if (t.now < job.give_up) return;
        if (!s.optional) {
            tickets_.failed(
                job.command.ticket, Reason::drive_refused,
                fmt::format("the drive has acknowledged, and stays in another state: status word {:04X}h", canopen::low_first(end.data)),
                t.out);
            return drop();
        }
    }
    job.give_up = never;
    job.wait_until = {};
    if (++job.at < job.steps.size()) return;
    Job done = std::move(job);
    drop();
    finish(done, t);
}

void Drive::finish(Job& job, Turn& t) {
    const CommandBody& body = job.command.body;
    check_at_ = std::min(check_at_, t.now + std::max<Duration>(3 * line_.cycle, std::chrono::milliseconds(150)));
    if (job.stream) {
        stream_ = newest_ ? static_cast<Stream>(static_cast<int>(Stream::position) + static_cast<int>(newest_->mode)) : Stream::none;
        led_.begin(static_cast<double>(job.here));
        return;
    }
    if (is_urgent(body)) order_ = Order::none;
    if (const auto* m = std::get_if<Move>(&body)) {
        order_ = m->kind == Move::Kind::velocity ? Order::velocity : Order::position;
        fresh_ = 1;
        fb_.target_reached = false;  // the old "reached" must not stand for the new target
        fb_.moving = true;
        if (m->velocity && order_ == Order::position) profile_[0] = *m->velocity;
        if (m->acceleration) profile_[1] = *m->acceleration;
        if (m->deceleration) profile_[2] = *m->deceleration;
        emit(t);
    }
    if (std::holds_alternative<Home>(body)) {
        order_ = Order::homing;
        fb_.homing = fb_.moving = true;
        fb_.homing_attained = fb_.homing_error = fb_.target_reached = false;
        emit(t);
    }
    if (std::holds_alternative<SetPosition>(body)) fb_.referenced = true;
    Value value;
    std::string text;
    const auto* read = std::get_if<ReadParameter>(&body);
    const auto* to = std::get_if<WriteParameter>(&body);
    if (to) value = to->value;
    if (read) {
        const Parameter* p = catalogue().parameter(read->point);
        const auto type = p ? type_of(p->type) : std::nullopt;
        value = type ? canopen::decode(*type, job.data).value_or(Value{}) : Value{};
        if (!known(value)) {
            tickets_.failed(job.command.ticket, Reason::drive_refused,
                            fmt::format("{}: the drive gives {} bytes, which are none of its type", p ? p->id : "?", job.data.size()),
                            t.out);
            return;
        }
        if (p && p->type == ValueType::boolean) value = Value{as_integer(value).value_or(0) != 0};
    }
    if (to) {  // what the gateway itself goes by
        const Parameter* p = catalogue().parameter(to->point);
        const auto place = p ? place_of(*p, to->point) : std::nullopt;
        const auto n = as_integer(to->value);
        if (place == object::homing_method && n) homing_method_ = *n;
        if (place == object::profile_velocity && n) profile_[0] = *n;
        if (place == object::profile_acceleration && n) profile_[1] = *n;
        if (place == object::profile_deceleration && n) profile_[2] = *n;
    }
    if (std::holds_alternative<Native>(body)) {
        const Step& last = job.steps.back();
        const Parameter* p = parameter_at(catalogue(), last.address);
        const auto type = p ? type_of(p->type) : std::nullopt;
        const auto decoded = type ? canopen::decode(*type, job.data) : std::nullopt;
        if (last.kind == Step::Kind::write) {
            text = "written";
        } else if (decoded) {
            text = to_text(*decoded);
        } else {
            for (const std::uint8_t b : job.data)
                text += fmt::format("{}{:02X}", text.empty() ? "" : " ", b);
        }
    }
    const bool done = read || to;
    if (done && axis_ != no_axis) t.out.samples.push_back({axis_, read ? read->point : to->point, value, Quality::good, t.now, 0});
    if (const auto* home = std::get_if<Home>(&body); home && home->method != 0) homing_method_ = home->method;
    tickets_.answer(job.command.ticket, done ? Outcome::done : Outcome::accepted, Reason::none, std::move(text), t.out, 0, std::move(value),
                    job.data);
    if (const auto* action = std::get_if<Action>(&body); action && action->name == "nmt_reset_node") {
        presence_.lose(t.now, std::chrono::seconds(1));  // its boot-up message brings it back at once
        forget(Reason::interrupted, "the drive restarts", t);
    }
}

}  // namespace axisgate::cia402_drive
