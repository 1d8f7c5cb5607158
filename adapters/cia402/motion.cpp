// Plans the steps of power, motion, homing and stop commands from the known state of the axis, or states why there are none. Nothing is
// sent here.
#include <fmt/core.h>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_plans.hpp"

namespace axisgate::cia402_drive {
namespace {
constexpr std::uint16_t on_word = 0x0F, halt_bit = 0x100, go_word = 0x3F;
bool is_halted(const AxisKnown& known) { return (known.cw & halt_bit) != 0; }
bool fits_i32(std::int64_t v) { return v >= INT32_MIN && v <= INT32_MAX; }

/// The drive continues the interrupted motion when halt is released (CiA 402-2, bit 8), and some drives refuse another mode while halt is
/// set. The order of the mode in force is therefore replaced by one that keeps the axis where it stands, and halt is released with it.
void leave_halt(const Node& node, const AxisKnown& known, Job& job) {
    const auto target_here = [&](Address target) {
        job.read(object::position);
        job.write(target, 0, 4);
        job.steps.back().from_here = true;
    };
    if (known.turns()) job.until_standstill(std::chrono::seconds(5));
    if (known.cw & start_bit) job.word(halt_bit | on_word);
    switch (known.mode) {
        case 1:
            target_here(object::target_position);
            job.await(Step::Awaits::release, object::statusword, 0x1000, 0, node.start_timeout);
            job.start_word(go_word);
            job.await(Step::Awaits::acknowledge, object::statusword, 0x1000, 0x1000, node.start_timeout);
            job.steps.back().optional = true;
            break;
        case 3:
        case 9:
            job.write(object::target_velocity, 0, 4);
            break;
        case 4:
        case 10:
            job.write(object::target_torque, 0, 2);
            break;
        case 7:
            target_here(object::interpolated_position);
            break;
        case 8:
            target_here(object::target_position);
            break;
        default:
            break;
    }
    job.word_seen(on_word);
    job.until_standstill(std::chrono::seconds(1));  // the place is the actual one, which a loaded axis reaches with a small step
}

/// A drive carries out the next set-point in the mode that it shows: a set-point for a mode that is not in force yet is lost.
void enter_mode(const Node& node, const AxisKnown& known, Job& job, int mode, bool halted) {
    if (known.mode == mode && known.ordered_mode == mode) return;
    if (halted) leave_halt(node, known, job);
    job.write(object::mode, mode, 1);
    if (!known.has_mode) return;
    job.await(Step::Awaits::mode, object::mode_shown, 0xFF, static_cast<std::uint8_t>(mode), node.mode_timeout);
}
/// Resets bit 4 of the previous motion; a halt remains in force until the new target is sent.
void take_start_back(const AxisKnown& known, Job& job) {
    if (known.cw & start_bit) job.word(static_cast<std::uint16_t>((known.cw & halt_bit) | on_word));
}

void plan_homing(const Node& node, const AxisKnown& known, Job& job, std::optional<std::int16_t> method) {
    if (method) job.write(object::homing_method, *method, 1);
    enter_mode(node, known, job, 6, is_halted(known));
    job.word(on_word);
    job.await(Step::Awaits::value, object::statusword, 0, 0, {});  // value before the step
    job.start_word(on_word | start_bit);
}

std::string plan_enable(const Node& node, const AxisKnown& known, Job& job, Instant now, Reason& reason) {
    reason = Reason::wrong_state;
    if (known.fb.fault) return "the drive is in a fault: reset it first";
    if (known.shows_on() && !known.on(now)) {  // from before a stop, so that it would be no answer to this Enable
        job.await(Step::Awaits::off, object::statusword, 0, 0, AxisKnown::oldest_report);
        job.steps.back().optional = true;
    }
    if (is_halted(known) && known.shows_on())
        leave_halt(node, known, job);
    else if (is_halted(known))  // halt alone is released; the power stays off
        job.word_seen(known.state() == 0x07 ? 0x0B : 0x06);
    // A change of mode must not move the axis: the target velocity is 0, and positioning waits for its start bit. A cyclic mode stays in
    // force until another one is shown, with the actual position as its target.
    if (known.offers(3) || known.offers(9)) job.write(object::target_velocity, 0, 4, true);
    if (known.mode == 7 || known.mode == 8) {
        job.read(object::position);
        job.write(known.mode == 7 ? object::interpolated_position : object::target_position, 0, 4, true);
        job.steps.back().from_here = true;
    }
    if (known.mode == 4 || known.mode == 10) job.write(object::target_torque, 0, 2, true);
    if (known.offers(1)) job.write(object::mode, 1, 1);
    if (!known.shows_on() && known.state() != 0x07) {
        job.word(0x06), job.until(0x6F, 0x21);
        job.word(0x07), job.until(0x6F, 0x23);
    } else if (!known.shows_on()) {  // out of a quick stop, when it has ended
        job.until_standstill();
    }
    job.word(on_word), job.until(0x6F, 0x27);
    return {};
}

std::string plan_set_position(const Node& node, const AxisKnown& known, Job& job, const SetPosition& set, Instant now, Reason& reason) {
    if (!known.offers(6)) return "this drive has no homing mode (6502h), by which a position is set";
    reason = Reason::wrong_state;
    if (!known.on(now)) return "the axis is off: enable it first";
    if (known.fb.moving) return "the axis moves: stop it first";
    reason = Reason::out_of_range;
    if (!fits_i32(set.position)) return "a position is a number of 32 bits";
    job.write(object::home_offset, set.position, 4);
    plan_homing(node, known, job, 37);
    job.until(0x1000, 0x1000);
    job.until_position(set.position, known.fb.position);
    job.word(on_word);
    if (known.homing_method != 37) job.write(object::homing_method, known.homing_method, 1, true);
    return {};
}

std::string plan_home(const Node& node, const AxisKnown& known, Job& job, const Home& home, Instant now, Reason& reason) {
    if (!known.offers(6)) return "this drive has no homing mode (6502h)";
    reason = Reason::wrong_state;
    if (!known.on(now)) return "the axis is off: enable it first";
    reason = Reason::out_of_range;
    if (home.method < -128 || home.method > 127) return "a homing method is a number from -128 to 127";
    plan_homing(node, known, job, home.method == 0 ? std::nullopt : std::optional(home.method));
    job.await(Step::Awaits::homing, object::statusword, 0, 0, node.start_timeout);
    return {};
}

std::string plan_move(const Node& node, const AxisKnown& known, Job& job, const Move& m, Instant now, Reason& reason) {
    const int mode = m.kind == Move::Kind::velocity ? 3 : 1;
    if (m.prepare_only) return fmt::format("a {} on this line prepares no motion: start it alone", node.dialect.noun);
    if (!known.offers(mode)) return fmt::format("this drive has no {} mode (6502h)", mode == 3 ? "profile velocity" : "profile position");
    reason = Reason::wrong_state;
    if (!known.on(now)) return "the axis is off: enable it first";
    reason = Reason::out_of_range;
    if (!fits_i32(m.target)) return "a target is a number of 32 bits";
    const auto rate = [&](Address a, const std::optional<std::int64_t>& v) {
        if (v) job.write(a, *v, 4);
        return !v || (*v > 0 && *v <= UINT32_MAX);
    };
    if (!rate(object::profile_acceleration, m.acceleration) || !rate(object::profile_deceleration, m.deceleration) ||
        (mode == 1 && !rate(object::profile_velocity, m.velocity)))
        return "velocity, acceleration and deceleration are numbers from 1 to 4294967295";
    if (mode == 3) {
        // The velocity is written after the change of mode: a change that is late would otherwise run at a velocity that was answered as
        // failed.
        if (known.mode != 3 || known.ordered_mode != 3) job.write(object::target_velocity, 0, 4);
        enter_mode(node, known, job, 3, is_halted(known));
        job.write(object::target_velocity, m.target, 4);
        if (known.cw != on_word) job.word(on_word);
        return {};
    }
    take_start_back(known, job);
    enter_mode(node, known, job, 1, is_halted(known));
    if (m.kind == Move::Kind::relative && job.counts_from)
        job.here = *job.counts_from;
    else if (m.kind == Move::Kind::relative)
        job.read(object::position);
    job.write(object::target_position, m.target, 4);
    job.steps.back().from_here = m.kind == Move::Kind::relative;
    job.await(Step::Awaits::release, object::statusword, 0x1000, 0, node.start_timeout);
    job.start_word(go_word);
    job.await(Step::Awaits::acknowledge, object::statusword, 0x1000, 0x1000, node.start_timeout);
    job.word(on_word);
    return {};
}
}  // namespace

std::string plan(const Node& node, const AxisKnown& known, std::size_t axis, Job& job, Instant now, Reason& reason) {
    const CommandBody& body = job.command.body;
    const std::string_view noun = node.dialect.noun;
    if (std::holds_alternative<ReadParameter>(body) || std::holds_alternative<WriteParameter>(body))
        return plan_parameter(node, axis, job, reason);
    if (const auto* native = std::get_if<Native>(&body)) return plan_native(node, job, *native, reason);
    if (const auto* action = std::get_if<Action>(&body)) return plan_action(node, known, job, *action, now, reason);
    if (!known.profile) return fmt::format("this {} has no objects of CiA 402 (6041h): its own program moves it", noun);
    if (std::holds_alternative<Enable>(body)) return plan_enable(node, known, job, now, reason);
    if (std::holds_alternative<ResetFault>(body)) {
        if (!known.fb.fault) return job.read(object::error_code), "";
        job.word(0x00), job.word(0x80);
        // Until the drive has seen it; a fault whose cause persists remains.
        job.until(0x08, 0x00);
        job.steps.back().optional = true;
        job.steps.back().patience = std::chrono::milliseconds(200);
        job.word(0x00);
        return {};
    }
    if (const auto* home = std::get_if<Home>(&body)) return plan_home(node, known, job, *home, now, reason);
    if (const auto* set = std::get_if<SetPosition>(&body)) return plan_set_position(node, known, job, *set, now, reason);
    if (const auto* move = std::get_if<Move>(&body)) return plan_move(node, known, job, *move, now, reason);
    return fmt::format("a {} on this line has no {}", noun, name_of(body));
}

bool plan_anew(const Node& node, const AxisKnown& known, std::size_t axis, Job& job, const Step& s, unsigned sw, Instant now) {
    if (!std::holds_alternative<Enable>(job.command.body) || s.address != object::statusword) return false;
    const bool left = s.awaits == Step::Awaits::off && (sw & 0x6Fu) != 0x27;
    const bool fallen = s.want == 0x27 && (sw & 0x4Fu) == 0x40, quick = (s.want == 0x21 || s.want == 0x23) && (sw & 0x6Fu) == 0x07;
    if (!left && (job.planned_anew || (!fallen && !quick))) return false;
    Job again;
    again.command = job.command;
    again.planned_anew = !left;
    Reason reason = Reason::none;
    if (!plan(node, known, axis, again, now, reason).empty()) return false;
    job = std::move(again);
    return true;
}

void plan_stop(const AxisKnown& known, Job& job) {
    const bool may_be_on = known.fb.power == AxisFeedback::Power::on || (known.cw & 0x0Fu) == on_word;
    if (std::holds_alternative<Disable>(job.command.body)) {
        if (may_be_on && !known.fb.fault) {
            if (known.state() != 0x07) job.word(0x07);
            job.until_standstill(std::chrono::seconds(5));
        }
        job.word(0x00);
        if (known.fb.fault) return;
        job.until(0x4F, 0x40);
        job.steps.back().optional = true;
        job.steps.back().patience = std::chrono::milliseconds(200);
    } else if (std::holds_alternative<QuickStop>(job.command.body)) {
        job.word(0x0B);
    } else if (known.fb.quick_stopping) {
        job.word(0x0B | halt_bit);  // the drive may have stopped by itself: another control word would enable it
    } else {
        job.word(static_cast<std::uint16_t>((known.cw & 0x0Fu) | halt_bit));
    }
}

AxisKnown::Interpolation interpolation_of(Duration cycle) noexcept {
    const auto ms = milliseconds_of(cycle);
    return ms <= 255 ? AxisKnown::Interpolation{ms, -3} : AxisKnown::Interpolation{std::min<std::int64_t>(ms / 10, 255), -2};
}

void plan_stream(const Node& node, const AxisKnown& known, SetPoint::Mode mode, Duration cycle, Job& job) {
    job.stream = true;
    const auto time = interpolation_of(cycle);
    job.write(object::cycle, time.value, 1, true);
    job.write(object::cycle_index, time.index, 1, true);
    const int entered = known.stream_mode(mode);
    const bool in_force = known.mode == entered && known.ordered_mode == entered;
    if (known.turns()) {  // the axis would be pulled back to the position that was read while it moved, so it must stand still first
        job.word(on_word | halt_bit);
        job.until_standstill();
    } else {
        take_start_back(known, job);
    }
    const auto target_here = [&] {
        job.read(object::position);
        if (mode == SetPoint::Mode::position) {
            job.write(entered == 7 ? object::interpolated_position : object::target_position, 0, 4);
            job.steps.back().from_here = true;
        }
    };
    target_here();
    if (mode == SetPoint::Mode::velocity) job.write(object::target_velocity, 0, 4);
    if (mode == SetPoint::Mode::torque) job.write(object::target_torque, 0, 2);
    enter_mode(node, known, job, entered, known.turns() || is_halted(known));
    if (!in_force) target_here();  // the change of mode may have taken some time
    // Bit 4 switches the interpolation on.
    const std::uint16_t cw = entered == 7 ? on_word | start_bit : on_word;
    if (known.cw != cw || entered == 7 || known.turns()) job.word(cw);
}

void plan_mode_back(const AxisKnown& known, Job& job) {
    if (known.mode != 0) job.write(object::mode, known.mode, 1, true);
}

}  // namespace axisgate::cia402_drive
