// The state machine follows the control word at each write, and the axis at each read. A command acts once per count, a bit at its edge.
#include "gateway/registers/profiles/linmot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gateway/axis/cia402.hpp"

namespace axisgate::registers {
namespace {
constexpr std::uint16_t switch_on = 1u << 0, voltage = 1u << 1, no_quick_stop = 1u << 2, operation = 1u << 3, no_abort = 1u << 4,
                        no_freeze = 1u << 5, acknowledge = 1u << 7, jog_plus_bit = 1u << 8, jog_minus_bit = 1u << 9, home_bit = 1u << 11;
/// Go to position, special mode, clearance check, go to initial position, phase search: they use the drive's own configuration, which does
/// not exist here.
constexpr std::uint16_t unsupported = (1u << 6) | (1u << 10) | (1u << 12) | (1u << 13) | (1u << 15);
constexpr double counts_per_velocity = 10, counts_per_acceleration = 100;  // 1e-6 m/s and 1e-5 m/s^2 in 0.1 um
}  // namespace

LinMotMap::Meaning LinMotMap::meaning_of(const LanguageRow& row) {
    constexpr std::array<std::string_view, 10> names{"state_var", "status_word", "warn_word",    "position", "position_demand",
                                                     "velocity",  "error",       "control_word", "header",   "parameter"};
    const auto it = std::ranges::find(names, std::string_view(row.meaning));
    return static_cast<Meaning>(std::min<std::ptrdiff_t>(it - names.begin(), 9));
}

LinMotMap::LinMotMap(const DoorPort& port, Setup setup) : ProfileMap(port, std::move(setup)) {
    for (const auto& row : language().rows)
        meanings_.push_back(meaning_of(row));
}

LinMotMap::State LinMotMap::state() const {
    if (error_ != 0 || flag(0, flag_fault)) return State::error;
    if (powered(state_) && !enabled(0)) return state_ == State::quick_stop ? State::quick_stop : State::switch_on_disabled;
    return state_;
}

std::uint16_t LinMotMap::state_var() const {
    const State s = state();
    std::uint16_t sub = 0;
    if (s == State::error) sub = error_ != 0 ? error_ : static_cast<std::uint16_t>(language().error_of("fault"));
    if (s == State::enabled) {
        const bool moving = flag(0, flag_moving);
        sub = static_cast<std::uint16_t>(count_ | (moving ? 0x20 : 0) | (flag(0, flag_target_reached) && !moving ? 0x40 : 0) |
                                         (flag(0, flag_referenced) ? 0x80 : 0));
    }
    if (s == State::homing && homed_) sub = 0x0F;
    if (s == State::jog_plus || s == State::jog_minus) sub = flag(0, flag_moving) ? 0x01 : 0x0F;
    return static_cast<std::uint16_t>((static_cast<unsigned>(s) << 8) | (sub & 0xFFu));
}

std::uint16_t LinMotMap::warn_word() const {
    return static_cast<std::uint16_t>((flag(0, flag_referenced) ? 0u : 1u << 7) | (flag(0, flag_warning) ? 1u << 14 : 0u));
}

std::uint16_t LinMotMap::status_word() const {
    const State s = state();
    const bool moving = flag(0, flag_moving);
    std::uint32_t w = 0;
    if (powered(s)) w |= 1u << 0;
    if ((control_ & switch_on) != 0) w |= 1u << 1;
    if ((control_ & operation) != 0) w |= 1u << 2;
    if (s == State::error) w |= 1u << 3;
    if ((control_ & voltage) != 0) w |= 1u << 4;
    if ((control_ & no_quick_stop) != 0) w |= 1u << 5;
    if (s == State::locked) w |= 1u << 6;
    if (warn_word() != 0) w |= 1u << 7;
    if (s == State::homing || s == State::jog_plus || s == State::jog_minus) w |= 1u << 9;
    if (flag(0, flag_target_reached) && !moving) w |= 1u << 10;
    if (flag(0, flag_referenced)) w |= 1u << 11;
    if (moving) w |= 1u << 13;
    return static_cast<std::uint16_t>(w);
}

bool LinMotMap::shown(std::size_t row, Instant, std::uint32_t& bits) {
    const LanguageRow& r = language().rows[row];
    switch (meanings_[row]) {
        case Meaning::state_var:
            bits = state_var();
            return true;
        case Meaning::status_word:
            bits = status_word();
            return true;
        case Meaning::warn_word:
            bits = warn_word();
            return true;
        case Meaning::position:
            bits = bits_of(r.type, position(0));
            return true;
        case Meaning::position_demand:
            bits = bits_of(r.type, static_cast<double>(picture(0).position_demand) / axis(0).increments_per_count);
            return true;
        case Meaning::velocity:
            bits = bits_of(r.type, velocity(0) / counts_per_velocity);
            return true;
        case Meaning::error:
            bits = state() == State::error ? state_var() & 0xFFu : 0u;
            return true;
        case Meaning::control_word:
            bits = control_;
            return true;
        case Meaning::header:
        case Meaning::parameter:
            bits = buffer_[std::min<std::size_t>(r.address - std::size_t{1}, parameter_words)];
            return true;
    }
    return false;
}

double LinMotMap::parameter(std::size_t byte) const {
    const std::size_t word = byte / 2;
    return number_of(MapType::i32, (std::uint32_t{buffer_[word + 1]} << 16) | buffer_[word]);
}

void LinMotMap::give(CommandBody body, Asked asked, WritePlan& plan) {
    order(plan, 0, std::move(body), (static_cast<std::uint32_t>(asked) << 24) | (++sequence_ & 0xFF'FFFFu),
          asked == Asked::enable || asked == Asked::home ? Answer::done : Answer::acknowledged);
}

void LinMotMap::fail(Reason why, WritePlan& plan) {
    log(why, fmt::format("axis {}: the motion command {:03X}h is refused: {}", axis(0).name, buffer_[0] >> 4,
                         why == Reason::wrong_state ? "the drive is not in operation"
                                                    : "the axis behind has no such motion, or a value of it is 0"));
    if (flag(0, flag_moving)) give(QuickStop{}, Asked::nothing, plan);
}
/// The error word is for the master's program, the text for people; the sender of the write reports it.
void LinMotMap::log(Reason why, std::string text) {
    error_ = static_cast<std::uint16_t>(language().error_of(why));
    (void)refused(0, why, std::move(text));
}

Verdict LinMotMap::taken(std::span<const Written> rows, WritePlan& plan) {
    std::optional<std::uint16_t> control, header;
    for (const Written& w : rows) {
        if (meanings_[w.row] == Meaning::control_word) control = static_cast<std::uint16_t>(w.bits);
        if (meanings_[w.row] == Meaning::header) header = static_cast<std::uint16_t>(w.bits);
    }
    if (control && (*control & ~control_ & unsupported) != 0)
        return refused(
            0, Reason::not_supported,
            fmt::format("axis {}: control word {:04X}h asks for what only a LinMot drive has configured", axis(0).name, *control));
    for (const Written& w : rows) {
        const auto address = language().rows[w.row].address;
        if (meanings_[w.row] == Meaning::header || meanings_[w.row] == Meaning::parameter)
            buffer_[std::min<std::size_t>(address - std::size_t{1}, parameter_words)] = static_cast<std::uint16_t>(w.bits);
    }
    if (control) take_control(*control, plan);
    if (header) take_command(*header, plan);
    return Verdict::good;
}

/// The count of the motion command and every set bit count as written before: cleared bits switch off, power may come on, nothing moves.
void LinMotMap::adopted(std::span<const Written> rows, WritePlan& plan) {
    std::optional<std::uint16_t> control;
    for (const Written& w : rows) {
        const auto word = static_cast<std::uint16_t>(w.bits);
        if (meanings_[w.row] == Meaning::control_word) {
            control = word;
        } else {
            buffer_[std::min<std::size_t>(language().rows[w.row].address - std::size_t{1}, parameter_words)] = word;
            if (meanings_[w.row] == Meaning::header) count_ = static_cast<std::uint8_t>(word & 0xF);
        }
    }
    if (!control) return;
    constexpr std::uint16_t edges = acknowledge | home_bit | jog_plus_bit | jog_minus_bit;
    // Freezing ends with a motion to the old target when its bit returns; here the bit had returned before.
    if (state_ == State::freezing && (*control & no_freeze) != 0) target_known_ = false;
    control_ = static_cast<std::uint16_t>(control_ | (*control & edges));
    if (enabled(0)) power_asked_ = true;  // a cleared bit removes the power, no matter which client has requested it
    take_control(static_cast<std::uint16_t>(*control & ~unsupported), plan);
}

void LinMotMap::off(State to, WritePlan& plan) {
    if (std::exchange(power_asked_, false)) give(Disable{}, Asked::nothing, plan);
    state_ = to;
}

void LinMotMap::take_control(std::uint16_t word, WritePlan& plan) {
    const std::uint16_t before = std::exchange(control_, word);
    if ((word & ~before & acknowledge) != 0 && state() == State::error) {
        error_ = 0;
        if (flag(0, flag_fault)) give(ResetFault{}, Asked::nothing, plan);
        off(State::locked, plan);
    }
    if (state_ != State::tests && state() == State::switch_on_disabled && powered(state_)) {  // another client has switched the power off
        state_ = State::locked;
        power_asked_ = false;
    }
    if (state_ == State::locked && (word & switch_on) == 0) state_ = State::switch_on_disabled;
    if (state_ == State::locked || state() == State::error) {
        if ((word & (voltage | switch_on)) != (voltage | switch_on)) off(State::locked, plan);
        return;
    }
    if ((word & voltage) == 0) return off(State::switch_on_disabled, plan);
    if ((word & no_quick_stop) == 0) {
        if (powered(state_) && state_ != State::quick_stop) {
            state_ = State::quick_stop;
            give(QuickStop{}, Asked::nothing, plan);
        } else if (!powered(state_)) {
            off(State::switch_on_disabled, plan);
        }
        return;
    }
    if (state_ == State::quick_stop) off(State::switch_on_disabled, plan);
    if ((word & switch_on) == 0) return off(State::ready_to_switch_on, plan);
    if ((word & operation) == 0) return off(State::ready_to_operate, plan);
    if (!powered(state_) && state_ != State::tests) {
        state_ = State::tests;
        power_asked_ = true;
        return give(Enable{}, Asked::enable, plan);
    }
    if (powered(state_)) take_special(before, plan);
}

void LinMotMap::take_special(std::uint16_t before, WritePlan& plan) {
    const auto rose = [&](std::uint16_t bit) { return (before & bit) == 0 && (control_ & bit) != 0; };
    const auto low = [&](std::uint16_t bit) { return (control_ & bit) == 0; };
    switch (state_) {
        case State::aborting:
        case State::freezing:
            if (low(state_ == State::aborting ? no_abort : no_freeze)) return;
            if (state_ == State::freezing && target_known_) go(target_, axis(0).velocity, axis(0).acceleration, axis(0).acceleration, plan);
            state_ = State::enabled;
            break;
        case State::homing:
            if (!low(home_bit)) return;
            if (!homed_) give(Halt{}, Asked::nothing, plan);
            state_ = State::enabled;
            break;
        case State::jog_plus:
        case State::jog_minus:
            if (!low(state_ == State::jog_plus ? jog_plus_bit : jog_minus_bit)) return;
            give(Halt{}, Asked::nothing, plan);
            state_ = State::enabled;
            break;
        default:
            break;
    }
    if (low(no_abort) || low(no_freeze)) {
        if (low(no_abort)) target_known_ = false;
        state_ = low(no_abort) ? State::aborting : State::freezing;
        return give(Halt{}, Asked::nothing, plan);
    }
    if (rose(home_bit)) {
        state_ = State::homing;
        homed_ = false;
        return give(Home{}, Asked::home, plan);
    }
    if (rose(jog_plus_bit) || rose(jog_minus_bit)) {
        if (!axis(0).velocity) return fail(Reason::not_supported, plan);
        state_ = rose(jog_plus_bit) ? State::jog_plus : State::jog_minus;
        run(rose(jog_plus_bit) ? *axis(0).velocity : -*axis(0).velocity, plan);
    }
}

void LinMotMap::take_command(std::uint16_t header, WritePlan& plan) {
    const auto count = static_cast<std::uint8_t>(header & 0xF);
    if (count == count_) return;
    count_ = count;
    const unsigned command = header >> 4;
    if (command == 0x000) return;
    if (command == 0x001) return take_control(buffer_[1], plan);
    const State s = state();
    if (command == 0x009) return give(SetPosition{increments(0, parameter(2))}, Asked::motion, plan);
    if (s == State::ready_to_operate) return fail(Reason::wrong_state, plan);
    if (s == State::enabled) motion_command(header, plan);
}

void LinMotMap::go(double target, std::optional<double> velocity, std::optional<double> acceleration, std::optional<double> deceleration,
                   WritePlan& plan) {
    Move m;
    m.kind = Move::Kind::absolute;
    m.target = increments(0, target);
    if (velocity) m.velocity = positive_increments(0, *velocity);
    if (acceleration) m.acceleration = positive_increments(0, *acceleration);
    if (deceleration) m.deceleration = positive_increments(0, *deceleration);
    target_ = target;
    target_known_ = true;
    give(m, Asked::motion, plan);
}

void LinMotMap::run(double velocity, WritePlan& plan) {
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = increments(0, velocity);
    if (axis(0).acceleration) m.acceleration = m.deceleration = positive_increments(0, *axis(0).acceleration);
    target_known_ = false;
    give(m, Asked::motion, plan);
}

void LinMotMap::motion_command(std::uint16_t header, WritePlan& plan) {
    const unsigned group = header >> 8, sub = (header >> 4) & 0xFu;
    const double demand = static_cast<double>(picture(0).position_demand) / axis(0).increments_per_count;
    const bool own = group == 0x01;  // speed and ramps are in the command, or otherwise in the site's entry
    if (group != 0x01 && group != 0x02) return fail(Reason::not_supported, plan);
    if (sub == 0x7) return give(Halt{}, Asked::motion, plan);
    if (group == 0x02 && (sub == 0xE || sub == 0xF)) {
        if (!axis(0).velocity) return fail(Reason::not_supported, plan);
        return run(sub == 0xE ? *axis(0).velocity : -*axis(0).velocity, plan);
    }
    if (sub > 0x6 || (group == 0x02 && sub > 0x4)) return fail(Reason::not_supported, plan);
    const double value = parameter(2);
    const double target = sub == 1   ? demand + value
                          : sub == 2 ? (target_known_ ? target_ : demand) + value
                          : sub >= 5 ? position(0) + value
                                     : value;
    const auto unsigned_parameter = [&](std::size_t byte) {
        return static_cast<double>(static_cast<std::uint32_t>(static_cast<std::int64_t>(parameter(byte))));
    };
    if (own) {
        if (unsigned_parameter(6) == 0 || unsigned_parameter(10) == 0 || unsigned_parameter(14) == 0)
            return fail(Reason::not_supported, plan);
        return go(target, unsigned_parameter(6) * counts_per_velocity, unsigned_parameter(10) * counts_per_acceleration,
                  unsigned_parameter(14) * counts_per_acceleration, plan);
    }
    go(target, axis(0).velocity, axis(0).acceleration, axis(0).acceleration, plan);
}

void LinMotMap::on_own_result(std::uint32_t note, const Result& result) {
    switch (static_cast<Asked>(note >> 24)) {
        case Asked::enable:
            if (state_ != State::tests) return;
            state_ = good(result) ? State::enabled : State::locked;
            if (!good(result)) log(result.reason, result.text);
            return;
        case Asked::home:
            if (state_ != State::homing) return;
            homed_ = good(result);
            if (!good(result)) log(result.reason, result.text);
            return;
        case Asked::motion:  // a later order may have ended the motion
            if (!good(result) && (note & 0xFF'FFFFu) == (sequence_ & 0xFF'FFFFu)) log(result.reason, result.text);
            return;
        case Asked::nothing:
            return;
    }
}

}  // namespace axisgate::registers
