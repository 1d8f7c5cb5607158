// How each situation is reached and each value is observed. A value that only an order can show is observed on a copy, so that one question
// never changes the answer to the next.
#include "tests/unit/axis/forgetting_bench.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"

#include <fmt/core.h>

namespace axisgate::forgetting {
namespace {
using namespace cia402_bench;
constexpr std::uint16_t on_word = 0x0F;
constexpr int steps_most = 12;  // from any state to operation enabled

Origin who(Door door, const char* name) {
    Origin o;
    o.door = door;
    o.client = std::make_shared<const std::string>(name);
    return o;
}
SetPoint point(SetPoint::Mode mode, std::int64_t value) {
    SetPoint p;
    p.mode = mode;
    p.value = value;
    return p;
}
Move move(Move::Kind kind, std::int64_t target) {
    Move m;
    m.kind = kind;
    m.target = target;
    return m;
}
std::string text(const Move& m) {
    return fmt::format("{} {}", m.kind == Move::Kind::velocity ? "velocity" : m.kind == Move::Kind::relative ? "by" : "to", m.target);
}
std::string speeds_of(const Move& m) {
    return fmt::format("{} {} {}", m.velocity.value_or(0), m.acceleration.value_or(0), m.deceleration.value_or(0));
}
}  // namespace

Origin plc() { return who(modbus::clients, "plc"); }
Origin panel() { return who(http::clients, "panel"); }
Origin stranger() { return who(modbus::clients, "stranger"); }

Cia402Axis::Decision Subject::write(const ProcessData& d, const Origin& by) {
    auto r = profile.on_process_data(d, by);
    return r;
}

/// A word of "plc" that a perfect drive carries out.
Cia402Axis::Decision Subject::control(std::uint16_t cw) {
    ProcessData d;
    d.controlword = cw;
    auto r = write(d, plc());
    obey(r);
    return r;
}

/// The values that "plc" has written and not used.
void Subject::values() {
    ProcessData d;
    d.target_position = 3000;
    d.profile_velocity = 200;
    d.profile_acceleration = 300;
    d.profile_deceleration = 400;
    d.homing_method = 17;
    if (picture().mode == mode_profile_position) d.target_velocity = 55;
    obey(write(d, plc()));
}

void Subject::enabled(std::int16_t mode) {
    ProcessData d;
    d.mode = mode;
    d.homing_method = 17;
    d.profile_velocity = 200;
    d.profile_acceleration = 300;
    d.profile_deceleration = 400;
    obey(write(d, plc()));
    for (const int word : {0x06, 0x07, 0x0F})
        (void)control(static_cast<std::uint16_t>(word));
}

void Subject::run_to(std::int32_t target) {
    ProcessData d;
    d.target_position = target;
    d.controlword = 0x1F;
    obey(write(d, plc()));
}

Subject::Subject(Situation situation) {
    using enum Situation;
    drive.position = 70;
    drive.referenced = true;
    say();
    {
        ProcessData d;
        d.controlword = 0x06;
        obey(write(d, panel()));
    }
    const auto end_edge = [&] { (void)control(on_word); };
    const auto turn = [&] {
        enabled(mode_profile_velocity);
        ProcessData d;
        d.target_velocity = 500;
        obey(write(d, plc()));
        drive.velocity = 500;
        say();
    };
    const auto wait = [&] {
        enabled(mode_profile_position);
        run_to(1000);
        end_edge();
        run_to(2000);
        end_edge();
    };
    const auto run = [&] {
        enabled(mode_profile_position);
        run_to(1000);
    };
    const auto off = [&] {
        ProcessData d;
        d.mode = mode_profile_position;
        obey(write(d, plc()));
        (void)control(0x06);
        (void)control(0x07);
    };
    switch (situation) {
        case switched_on:
            off();
            break;
        case being_enabled: {
            off();
            values();
            ProcessData d;
            d.controlword = on_word;
            open = write(d, plc()).orders;
            d = {};
            d.target_velocity = 55;
            obey(write(d, plc()));
            return;
        }
        case standing:
            enabled(mode_profile_position);
            break;
        case moving:
            run();
            break;
        case waiting:
            wait();
            break;
        case halted:
            wait();
            (void)control(on_word | cw_halt);
            break;
        case turning:
            turn();
            break;
        case turning_halted:
            turn();
            (void)control(on_word | cw_halt);
            drive.velocity = 0;
            say();
            break;
        case searching:
            enabled(mode_homing);
            (void)control(0x1F);
            drive.homing = drive.moving = true;
            drive.target_reached = false;
            say();
            break;
        case homing_refused: {
            enabled(mode_homing);
            ProcessData d;
            d.controlword = 0x1F;
            answer(write(d, plc()), false);
            break;
        }
        case following:
        case following_speed:
            run();
            values();
            profile.follow(situation == following ? point(SetPoint::Mode::position, 40) : point(SetPoint::Mode::velocity, 90));
            return;
        case quick_stopped:
            run();
            (void)control(0x1B);
            break;
        case reacting:
        case faulty:
            wait();
            drive.fault = true;
            drive.moving = situation == reacting;
            say();
            break;
        case being_disabled: {
            run();
            values();
            ProcessData d;
            d.controlword = 0x17;
            open = write(d, plc()).orders;
            d = {};
            d.target_velocity = 55;
            obey(write(d, plc()));
            return;
        }
        case unheard:
        case silent:
            wait();
            profile.on_presence(situation == silent ? Presence::offline : Presence::device);
            {
                ProcessData d;
                d.target_position = 3000;
                d.target_velocity = 55;
                (void)write(d, plc());
            }
            return;
        case count:
            break;
    }
    values();
}

void Subject::answer_open() {
    for (const auto& o : std::exchange(open, {})) {
        now += std::chrono::milliseconds(1);
        if (std::holds_alternative<Enable>(o)) drive.power = Power::on;
        if (std::holds_alternative<Disable>(o)) drive.power = Power::off;
        profile.on_order_result(o, true, now);
    }
}

/// The drive answers, without further feedback.
void Subject::answer(const Cia402Axis::Decision& d, bool good) {
    if (!d.orders.empty()) answer_open();
    for (const auto& o : d.orders) {
        now += std::chrono::milliseconds(1);
        if (good && std::holds_alternative<Enable>(o)) drive.power = Power::on;
        if (good && std::holds_alternative<Disable>(o)) drive.power = Power::off;
        profile.on_order_result(o, good, now);
    }
}

void Subject::apply(Event event) {
    using enum Event;
    const std::uint16_t cw = picture().controlword;
    const auto word = [&](unsigned w, const Origin& by) {
        ProcessData d;
        d.controlword = static_cast<std::uint16_t>(w);
        answer(write(d, by));
    };
    const auto without = [&](unsigned bits) { return static_cast<unsigned>(cw & ~bits); };
    const auto follow = [&](const SetPoint& p) {
        if (!profile.may_follow().refused) profile.follow(p);
    };
    const auto said = [&](bool good = true) {
        if (picture().presence == Presence::offline) return;  // no side could report anything
        now += std::chrono::milliseconds(1);
        drive.at = now;
        const auto next = profile.on_feedback(drive, now);
        if (next) profile.on_order_result(*next, good, now);
    };
    const std::int16_t other = picture().mode == mode_profile_velocity ? mode_profile_position : mode_profile_velocity;
    ProcessData d;
    switch (event) {
        case halt_bit:
            return word(cw | cw_halt, plc());
        case end_of_halt_bit:
            return word(without(cw_halt), plc());
        case set_point:
            word(without(cw_new_setpoint), plc());
            return word(cw | cw_new_setpoint, plc());
        case set_point_at_once:
            word(without(cw_new_setpoint), plc());
            return word(cw | cw_new_setpoint | cw_change_immediately, plc());
        case set_point_with_halt_bit:
            word(without(cw_new_setpoint), plc());
            return word(cw | cw_new_setpoint | cw_halt, plc());
        case end_of_bit_4:
            return word(without(cw_new_setpoint), plc());
        case quick_stop_bit:
            return word(without(cw_quick_stop), plc());
        case disable_voltage:
            return word(without(cw_enable_voltage), plc());
        case shutdown:
            return word(0x06, plc());
        case disable_operation:
            return word(0x07, plc());
        case enable_operation:
            return word(on_word, plc());
        case fault_reset_bit:
            return word(cw | cw_fault_reset, plc());
        case same_mode:
            d.mode = picture().mode;
            return answer(write(d, plc()));
        case another_mode:
            d.mode = other;
            return answer(write(d, plc()));
        case another_mode_and_velocity:
            d.mode = other;
            d.target_velocity = 77;
            return answer(write(d, plc()));
        case another_mode_and_back: {
            const std::int16_t present = picture().mode;
            d.mode = other;
            answer(write(d, plc()));
            d.mode = present;
            return answer(write(d, plc()));
        }
        case target_velocity_zero:
            d.target_velocity = 0;
            return answer(write(d, plc()));
        case target_of_another:
            d.target_position = 4000;
            return answer(write(d, panel()));
        case speeds_of_another:
            d.profile_velocity = 21;
            d.profile_acceleration = 31;
            d.profile_deceleration = 41;
            return answer(write(d, panel()));
        case enable_operation_by_another:
            return word(on_word, panel());
        case enable_operation_by_a_stranger:
            return word(on_word, stranger());
        case enable:
            return answer(profile.on_command(Enable{}, panel()));
        case disable:
            return answer(profile.on_command(Disable{}, panel()));
        case quick_stop:
            return answer(profile.on_command(QuickStop{}, panel()));
        case halt:
            return answer(profile.on_command(Halt{}, panel()));
        case reset_fault:
            return answer(profile.on_command(ResetFault{}, panel()));
        case home:
            return answer(profile.on_command(Home{35}, panel()));
        case home_refused:
            return answer(profile.on_command(Home{35}, panel()), false);
        case set_position:
            return answer(profile.on_command(SetPosition{5}, panel()));
        case set_position_refused:
            return answer(profile.on_command(SetPosition{5}, panel()), false);
        case move_absolute:
            return answer(profile.on_command(move(Move::Kind::absolute, 600), panel()));
        case move_relative:
            return answer(profile.on_command(move(Move::Kind::relative, 600), panel()));
        case move_velocity:
            return answer(profile.on_command(move(Move::Kind::velocity, 600), panel()));
        case move_refused:
            return answer(profile.on_command(move(Move::Kind::absolute, 600), panel()), false);
        case start_together:
            return answer(profile.on_command(StartTogether{{}}, panel()));
        case stream_position:
            return follow(point(SetPoint::Mode::position, 41));
        case stream_velocity:
            return follow(point(SetPoint::Mode::velocity, 91));
        case end_of_stream:
            return profile.end_following();
        case same_again:
            return said();
        case arrived:
            drive.moving = drive.homing = false;
            drive.velocity = 0;
            drive.target_reached = true;
            return said();
        case power_lost:
            drive.power = Power::off;
            return said();
        case fault:
            drive.fault = true;
            return said();
        case stopped_at_the_drive:
            drive.quick_stopping = true;
            return said();
        case silence:
            return profile.on_presence(Presence::offline);
        case same_presence:
            return profile.on_presence(picture().presence);
        case another_drive:
        case another_drive_that_is_on:
            profile.on_presence(picture().presence == Presence::device ? Presence::twin : Presence::device);
            if (event == another_drive) return;
            drive.power = Power::on;
            drive.fault = drive.moving = drive.homing = drive.quick_stopping = false;
            return said();
        case count:
            return;
    }
}

std::string Subject::first_order(const Cia402Axis::Decision& d) const {
    for (const auto& o : d.orders) {
        if (const auto* m = std::get_if<Move>(&o)) return text(*m);
    }
    return "none";
}

/// A mode that its client has not written just before, because a repeated mode does not end another client's activity.
void Subject::choose(std::int16_t mode, const Origin& by) {
    ProcessData d;
    d.mode = picture().mode;
    obey(write(d, by));
    d.mode = mode;
    obey(write(d, by));
}

/// Brings the axis to operation enabled by the words of "plc", from any state.
void Subject::enable_again() {
    answer_open();
    if (profile.state() == PowerState::not_ready_to_switch_on) {
        if (picture().presence == Presence::offline) profile.on_presence(Presence::twin);
        say();
    }
    drive.fault = drive.quick_stopping = false;
    say();
    for (int i = 0; i < steps_most && profile.state() != PowerState::operation_enabled; ++i) {
        const auto state = profile.state();
        (void)control(state == PowerState::switched_on ? 0x0F : state == PowerState::switch_on_disabled ? 0x06 : 0x07);
        if (state == PowerState::quick_stop_active) (void)control(0x0F);
    }
    (void)control(on_word);
}

Seen Subject::look() const {
    Seen seen;
    const auto at = [&](Value v) -> std::string& { return seen[static_cast<std::size_t>(v)]; };
    const AxisPicture p = picture();
    const bool heard = profile.state() != PowerState::not_ready_to_switch_on;
    at(Value::controlword) = std::to_string(p.controlword);
    at(Value::mode) = std::to_string(p.mode);
    at(Value::shown_target) = std::to_string(p.target_position);
    at(Value::shown_velocity) = std::to_string(p.target_velocity);
    at(Value::shown_speeds) = fmt::format("{} {} {}", p.profile_velocity, p.profile_acceleration, p.profile_deceleration);
    at(Value::homing_method) = std::to_string(p.homing_method);
    at(Value::set_points) = std::to_string(p.setpoints_accepted);
    // In profile velocity bit 12 shows only the drive's speed, and in homing the drive's own "attained".
    const bool shown = p.mode != mode_profile_velocity && p.mode != mode_homing;
    at(Value::bit_12) = shown && (p.statusword & sw_mode_12) ? "1" : "0";
    at(Value::bit_13) = p.statusword & sw_mode_13 ? "1" : "0";
    const auto active = profile.active_target();
    at(Value::active) = active ? std::to_string(*active) : "none";
    at(Value::halt) = profile.may_follow().text.find("halt") != std::string::npos ? "1" : "0";
    at(Value::quick_stop) = profile.state() == PowerState::quick_stop_active ? "1" : "0";
    at(Value::referenced) = p.flags & flag_referenced ? "1" : "0";
    at(Value::position) = std::to_string(p.position);
    at(Value::commanded) = profile.commanded() ? "1" : "0";
    {
        Subject s = *this;
        s.profile.end_following();
        at(Value::mode_after_stream) = std::to_string(s.picture().mode);
    }
    at(Value::ordered_velocity) = "none";
    if (heard && p.mode == mode_profile_velocity && at(Value::halt) == "0") {
        Subject s = *this;
        s.answer_open();
        s.drive.moving = true;
        for (const std::int64_t speed : {500, 600, 55, 77}) {
            s.drive.velocity = speed;
            s.say();
            if (s.picture().flags & flag_target_reached) at(Value::ordered_velocity) = std::to_string(speed);
        }
    }
    if (profile.state() == PowerState::operation_enabled && p.mode != mode_profile_velocity && at(Value::halt) == "0") {
        // A speed that causes no order is the one that the drive is assumed to have. The question comes from a client that has written no
        // values before, and that first writes the present mode and another speed, so that both are new and not repeated.
        for (const std::int32_t speed : {500, 600, 55, 77}) {
            Subject s = *this;
            s.choose(mode_profile_velocity, stranger());
            ProcessData d;
            d.target_velocity = 1;
            (void)s.write(d, stranger());
            d.target_velocity = speed;
            if (s.write(d, stranger()).orders.empty() && s.open.empty()) at(Value::ordered_velocity) = std::to_string(speed);
        }
    }
    at(Value::waiting) = at(Value::end_of_halt) = "none";
    if (profile.state() == PowerState::operation_enabled) {
        Subject s = *this;
        ProcessData d;
        d.controlword = p.controlword & static_cast<std::uint16_t>(~cw_halt);
        const auto released = s.write(d, plc());
        at(Value::end_of_halt) = first_order(released);
        if (!released.orders.empty()) s.obey(released);  // otherwise the waiting set-point would begin unobserved
        s.drive.moving = s.drive.homing = false;
        s.drive.target_reached = true;
        const auto next = s.say();
        if (next && std::holds_alternative<Move>(*next)) at(Value::waiting) = text(std::get<Move>(*next));
    }
    {
        Subject s = *this;
        s.enable_again();
        s.choose(mode_profile_position, plc());
        ProcessData d;
        d.controlword = 0x3F;
        const auto r = s.write(d, plc());
        at(Value::target) = at(Value::speeds) = r.refused ? r.text : "none";
        for (const auto& o : r.orders) {
            if (const auto* m = std::get_if<Move>(&o)) {
                at(Value::target) = std::to_string(m->target);
                at(Value::speeds) = speeds_of(*m);
            }
        }
    }
    return seen;
}

}  // namespace axisgate::forgetting
