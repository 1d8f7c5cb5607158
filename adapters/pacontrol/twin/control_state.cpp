// The control: motions by command and by module, conditions, elements, parameters.
// In: tasks, values. Out: command errors, values. Never checks the operating mode: the commands' gates and the image do.
#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/twin/control.hpp"

namespace axisgate::pacontrol::twin {

// --- motions ---

bool Control::fulfilled(const Condition& c) const noexcept {
    const bool is = c.type == 1 ? input(c.number) : c.type == 2 ? output(c.number) : elements_.flags.get(c.number);
    return is == c.value;
}

std::uint16_t Control::start_with(int n, const Motion& m, const std::optional<Condition>& c, Instant now) {
    Axis& a = axis(n);
    if (const std::uint16_t q = a.traverse().may_start(m, now); q != 0) return q;
    if (mode_.status() != status::online) return quit::not_executable;  // starting, stopped, malfunction: nothing begins
    condition_[static_cast<std::size_t>(n - 1)] = c;
    if (c && !fulfilled(*c)) {
        a.traverse().finish(now);
        a.traverse().skipped_by_condition();  // counts as finished, no error [L820]
        return quit::ok;
    }
    a.traverse().start(m, now);
    settle(now);
    return quit::ok;
}

std::uint16_t Control::start_move(int n, double value, bool relative, Task task, Instant now) {
    const auto i = static_cast<std::size_t>(n - 1);
    const Axis& a = axis(n);
    Motion m;
    m.task = task;
    m.target = relative ? a.shaft().position(now) + value : value;
    const double own = static_cast<double>(
        a.parameters()[task == Task::manual && !setup_.axis.manual_at_traverse ? ap::manual_speed : ap::traverse_speed]);
    m.speed = task == Task::manual && !setup_.axis.manual_at_traverse ? own : overrides_[i].speed.value_or(own);
    m.acceleration = overrides_[i].acceleration.value_or(static_cast<double>(a.parameters()[ap::acceleration]));
    m.limits_monitored = limits_monitored_[i];
    const std::uint16_t q = start_with(n, m, next_condition_[i], now);
    if (q == 0) next_condition_[i].reset();  // for one move only
    return q;
}

std::uint16_t Control::start_task(int n, const AxisTask& task, Instant now) {
    advance(now);
    if (!has_axis(n)) return quit::no_axis;
    const auto i = static_cast<std::size_t>(n - 1);
    Axis& a = axis(n);
    const auto place = [&](bool g26) {
        if (a.running()) return quit::moves;
        g26 ? a.set_position_g26(task.value, true) : a.set_position_g29(task.value);
        settle(now);
        return quit::ok;
    };
    Motion m;
    m.acceleration = static_cast<double>(a.parameters()[ap::acceleration]) * static_cast<double>(task.acceleration_permille) / 1000;
    m.speed = static_cast<double>(a.parameters()[ap::traverse_speed]) * static_cast<double>(task.speed_permille) / 1000;
    m.limits_monitored = task.limits_monitored;
    std::optional<Condition> condition;
    switch (task.kind) {
        case AxisTask::Kind::reference:
            if (const std::uint16_t q = a.traverse().may_reference(); q != 0) return q;
            if (mode_.status() != status::online) return quit::not_executable;
            a.traverse().start_reference(now);
            settle(now);
            return quit::ok;
        case AxisTask::Kind::set_g26:
            return place(true);
        case AxisTask::Kind::set_g29:
            return place(false);
        case AxisTask::Kind::delete_g29:
            if (a.running()) return quit::moves;
            a.delete_g29();
            settle(now);
            return quit::ok;
        case AxisTask::Kind::reset_displaced:
            axes_.clear_displaced();
            return quit::ok;
        case AxisTask::Kind::absolute:
            m.target = task.value;
            break;
        case AxisTask::Kind::relative:
            m.target = a.shaft().position(now) + task.value;
            break;
        case AxisTask::Kind::to_max:
            m.target = static_cast<double>(a.parameters()[ap::area_max]);  // "the axis parameter as absolute position" [L814]
            break;
        case AxisTask::Kind::to_min:
            m.target = static_cast<double>(a.parameters()[ap::area_min]);
            break;
        case AxisTask::Kind::free_positive:
        case AxisTask::Kind::free_negative: {
            const bool positive = task.kind == AxisTask::Kind::free_positive;
            m.free = true;
            m.target = task.value;
            if (positive ? m.target < a.shaft().position(now) : m.target > a.shaft().position(now)) return quit::outside_range;
            break;
        }
    }
    if (task.acceleration_permille == 0 || task.acceleration_permille > 65535 || task.speed_permille == 0 || task.speed_permille > 1000)
        return quit::value;
    const bool conditional = task.kind == AxisTask::Kind::absolute || task.kind == AxisTask::Kind::relative;
    if (task.while_input && conditional) condition = Condition{*task.while_input, 1, condition_input_[i]};
    return start_with(n, m, condition, now);
}

void Control::set_axis_on(int n, bool on, Instant now) {
    advance(now);
    if (on) {
        (void)axis(n).switch_on(now, mode_.status() == status::online);
    } else {
        axis(n).switch_off(now);
    }
    settle(now);
}

void Control::disable_drive(int n, bool disabled, Instant now) {
    advance(now);
    axis(n).disable(disabled, now);
    settle(now);
}

void Control::interrupt_axis(int n, Instant now) {
    advance(now);
    axis(n).traverse().interrupt(now);
    settle(now);
}

void Control::resume_axis(int n, Instant now) {
    advance(now);
    if (mode_.status() == status::online) axis(n).traverse().resume(now);
    settle(now);
}

void Control::change_axis_speed(int n, std::uint32_t permille, Instant now) {
    advance(now);
    if (!setup_.axis.ep || permille == 0 || permille > 1000) return;
    axis(n).traverse().change_speed(static_cast<double>(axis(n).parameters()[ap::traverse_speed]) * permille / 1000, now);
    settle(now);
}

void Control::set_condition(int n, const Condition& c) {
    const auto i = static_cast<std::size_t>(n - 1);
    next_condition_[i] = c;
    if (c.type == 1) condition_input_[i] = c.number;
}

void Control::check_conditions(Instant now) {
    for (int n = 1; n <= axes(); ++n) {
        const auto i = static_cast<std::size_t>(n - 1);
        if (!axis(n).running()) {
            if (!axis(n).traverse().busy()) condition_[i].reset();
        } else if (condition_[i] && !fulfilled(*condition_[i])) {
            axis(n).traverse().finish_by_condition(now);
        }
    }
    settle(now);
}

// --- elements ---

bool Control::input(std::int64_t n) const noexcept {
    return elements_.inputs.get(n) || (n != 0 && n == system_[sp::stop_input] && external_stop_);
}

bool Control::output(std::int64_t n) const noexcept {
    if (n != 0 && n == system_[sp::readiness_output]) return error_ == 0;
    if (n != 0 && n == system_[sp::malfunction_output]) return error_ != 0;
    return elements_.outputs.get(n);
}

void Control::check_stop_input(Instant now) {
    if (system_[sp::stop_input] == 0 || external_stop_powered()) return;
    const std::uint8_t c = mode_.column();
    if (c == gate::automatic || c == gate::online) (void)stop(now);
}

void Control::set_input(std::int64_t n, bool on, Instant now) {
    advance(now);
    const bool before = elements_.inputs.get(n);
    elements_.inputs.set(n, on);
    if (on && !before && n == system_[sp::start_input]) (void)start_automatic(now);
    check_stop_input(now);
    check_conditions(now);
}

void Control::set_external_stop(bool powered, Instant now) {
    advance(now);
    external_stop_ = powered;
    check_stop_input(now);
    check_conditions(now);
}

void Control::set_output(std::int64_t n, bool on, Instant now) {
    elements_.outputs.set(n, on);
    check_conditions(now);
}

void Control::set_flag(std::int64_t n, bool on, Instant now) {
    if (elements_.flags.get(n) != on) ++revision_;
    elements_.flags.set(n, on);
    check_conditions(now);
}

void Control::set_output_word(std::int64_t n, std::uint16_t word, Instant now) {
    elements_.outputs.set_word_of(n, word);
    check_conditions(now);
}

void Control::set_flag_word(std::int64_t n, std::uint16_t word, Instant now) {
    if (elements_.flags.word_of(n) != word) ++revision_;
    elements_.flags.set_word_of(n, word);
    check_conditions(now);
}

void Control::set_n(std::int64_t n, std::int32_t v) noexcept {
    if (elements_.n.get(n) != v) ++revision_;
    elements_.n.set(n, v);
}

void Control::set_r(std::int64_t n, float v) noexcept {
    if (!std::isfinite(v)) return;  // an image may hold any bits
    if (elements_.r.get(n) != v) ++revision_;
    elements_.r.set(n, v);
}

/// The view of axis n = 1..16 that begins at element `first`; axes that are not built read as 0 [L3921-3951].
std::optional<bool> Control::system_flag(std::int64_t n) const {
    const auto of = [&](std::int64_t first) -> const Axis* {
        return n - first < axes() ? &axis(static_cast<int>(n - first + 1)) : nullptr;
    };
    const auto within = [&](std::int64_t first) { return n >= first && n < first + 16; };
    if (within(51)) return of(51) != nullptr && of(51)->state().referenced;
    if (within(91)) return of(91) != nullptr && of(91)->traverse().busy();
    if (within(231)) return of(231) != nullptr && of(231)->state().fault != 0;
    return std::nullopt;
}

std::optional<std::int32_t> Control::system_integer(std::int64_t n) const {
    if (n == 10) return error_;
    if (n >= 71 && n < 87) return n - 71 < axes() ? axis(static_cast<int>(n - 70)).status() : 0;
    return std::nullopt;
}

std::optional<double> Control::system_real(std::int64_t n) const {
    if (n >= 51 && n < 67) return n - 51 < axes() ? axis(static_cast<int>(n - 50)).state().off_position : 0.0;
    if (n >= 71 && n < 87) return n - 71 < axes() ? axis(static_cast<int>(n - 70)).traverse().last_target() : 0.0;
    return std::nullopt;
}

// --- parameters ---

std::uint16_t Control::set_system_parameter(std::int64_t number, const Datum& data) {
    if (number < 1 || number > static_cast<std::int64_t>(system_parameters)) return quit::no_system_parameter;
    const auto i = static_cast<std::size_t>(number);
    const auto limits = system_limits(i);
    const double v = std::round(data.value);
    if (v < limits.least || v > limits.largest || (i == sp::profibus_address && v == 1)) return quit::value;  // 1 is the master's
    if (i == sp::profibus_address && setup_.profibus_switches != 0) return quit::profibus_address;
    if (system_[i] != static_cast<std::int32_t>(v)) ++revision_;
    system_[i] = static_cast<std::int32_t>(v);
    return quit::ok;
}

std::uint16_t Control::set_axis_parameter(std::int64_t parameter, const Datum& data) {
    const std::int64_t n = parameter >> 8;
    const auto number = static_cast<std::size_t>(parameter & 0xFF);
    if (parameter < 0 || !has_axis(n)) return quit::no_axis;
    if (number < 1 || number > axis_parameters) return quit::no_axis_parameter;
    const auto v = single(data);
    const auto& limits = axis_limits(number);
    if (!v || *v < limits.least || *v > limits.largest) return quit::value;
    Axis& a = axis(static_cast<int>(n));
    if (a.parameters()[number] != *v) ++revision_;
    a.set_parameter(number, *v);
    return quit::ok;
}

bool Control::select_program(const std::string& name) {
    for (std::size_t i = 0; i < setup_.programs.size(); ++i) {
        if (setup_.programs[i].name != name) continue;
        if (program_ != i) ++revision_;
        program_ = i;
        return true;
    }
    return false;
}

}  // namespace axisgate::pacontrol::twin
