// The control: motions by command and by module, conditions, elements, parameters.
// In: tasks, values. Out: command errors, values. Never checks the operating mode: the commands' gates and the image do.
#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/twin/control.hpp"

namespace axisgate::pacontrol::twin {

// --- motions ---

bool Control::fulfilled(const Condition& c) const noexcept {
    const bool is = c.type == 1   ? signals_.input(c.number)
                    : c.type == 2 ? signals_.output(c.number)
                                  : signals_.elements().flags.get(c.number);
    return is == c.value;
}

std::uint16_t Control::start_with(int n, const Motion& m, const std::optional<Condition>& c, Instant now) {
    Axis& a = axis(n);
    if (const std::uint16_t q = a.traverse().may_start(m, now); q != 0) return q;
    if (mode_.status() != status::online) return quit::not_executable;  // starting, stopped, malfunction: nothing begins
    orders_.of(n).running = c;
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
    AxisOrders& orders = orders_.of(n);
    const Axis& a = axis(n);
    Motion m;
    m.task = task;
    m.target = relative ? a.shaft().position(now) + value : value;
    const double own = static_cast<double>(
        a.parameters()[task == Task::manual && !setup_.axis.manual_at_traverse ? ap::manual_speed : ap::traverse_speed]);
    m.speed = task == Task::manual && !setup_.axis.manual_at_traverse ? own : orders.overrides.speed.value_or(own);
    m.acceleration = orders.overrides.acceleration.value_or(static_cast<double>(a.parameters()[ap::acceleration]));
    m.limits_monitored = orders.limits_monitored;
    const std::uint16_t q = start_with(n, m, orders.next, now);
    if (q == 0) orders.next.reset();  // for one move only
    return q;
}

std::uint16_t Control::start_task(int n, const AxisTask& task, Instant now) {
    advance(now);
    if (!settings_.has_axis(n)) return quit::no_axis;
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
    if (task.while_input && conditional) condition = Condition{*task.while_input, 1, orders_.of(n).condition_input};
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

void Control::check_conditions(Instant now) {
    for (int n = 1; n <= axes(); ++n) {
        std::optional<Condition>& c = orders_.of(n).running;
        if (!axis(n).running()) {
            if (!axis(n).traverse().busy()) c.reset();
        } else if (c && !fulfilled(*c)) {
            axis(n).traverse().finish_by_condition(now);
        }
    }
    settle(now);
}

// --- elements ---

void Control::check_stop_input(Instant now) {
    if (!signals_.external_stop_open()) return;
    const std::uint8_t c = mode_.column();
    if (c == gate::automatic || c == gate::online) (void)stop(now);
}

void Control::set_input(std::int64_t n, bool on, Instant now) {
    advance(now);
    const bool before = signals_.elements().inputs.get(n);
    signals_.set_input(n, on);
    if (on && !before && n == settings_.system()[sp::start_input]) (void)start_automatic(now);
    check_stop_input(now);
    check_conditions(now);
}

void Control::set_external_stop(bool powered, Instant now) {
    advance(now);
    signals_.set_external_stop(powered);
    check_stop_input(now);
    check_conditions(now);
}

void Control::set_output(std::int64_t n, bool on, Instant now) {
    signals_.set_output(n, on);
    check_conditions(now);
}

void Control::set_flag(std::int64_t n, bool on, Instant now) {
    signals_.set_flag(n, on);
    check_conditions(now);
}

void Control::set_output_word(std::int64_t n, std::uint16_t word, Instant now) {
    signals_.set_output_word(n, word);
    check_conditions(now);
}

void Control::set_flag_word(std::int64_t n, std::uint16_t word, Instant now) {
    signals_.set_flag_word(n, word);
    check_conditions(now);
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
