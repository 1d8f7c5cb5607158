// Motions of single axes. In: tasks, orders, time. Out: moves, command errors.
// Never checks the operating mode beyond ONLINE: the commands' gates and the image do.
#include "adapters/pacontrol/twin/motions.hpp"

namespace axisgate::pacontrol::twin {

bool Motions::fulfilled(const Condition& c) const noexcept {
    const bool is = c.type == 1   ? with_.signals.input(c.number)
                    : c.type == 2 ? with_.signals.output(c.number)
                                  : with_.signals.elements().flags.get(c.number);
    return is == c.value;
}

std::uint16_t Motions::start_with(int n, const Motion& m, const std::optional<Condition>& c, Instant now) {
    Axis& a = with_.axes.at(n);
    if (const std::uint16_t q = a.traverse().may_start(m, now); q != 0) return q;
    if (!with_.operation.online()) return quit::not_executable;  // starting, stopped, malfunction: nothing begins
    with_.orders.of(n).running = c;
    if (c && !fulfilled(*c)) {
        a.traverse().finish(now);
        a.traverse().skipped_by_condition();  // counts as finished, no error [L820]
        return quit::ok;
    }
    a.traverse().start(m, now);
    with_.operation.settle(now);
    return quit::ok;
}

std::uint16_t Motions::start_move(int n, double value, bool relative, Task task, Instant now) {
    AxisOrders& orders = with_.orders.of(n);
    const Axis& a = with_.axes.at(n);
    Motion m;
    m.task = task;
    m.target = relative ? a.shaft().position(now) + value : value;
    const double own =
        static_cast<double>(a.parameters()[task == Task::manual && !model_.manual_at_traverse ? ap::manual_speed : ap::traverse_speed]);
    m.speed = task == Task::manual && !model_.manual_at_traverse ? own : orders.overrides.speed.value_or(own);
    m.acceleration = orders.overrides.acceleration.value_or(static_cast<double>(a.parameters()[ap::acceleration]));
    m.limits_monitored = orders.limits_monitored;
    const std::uint16_t q = start_with(n, m, orders.next, now);
    if (q == 0) orders.next.reset();  // for one move only
    return q;
}

std::uint16_t Motions::start_task(int n, const AxisTask& task, Instant now) {
    with_.operation.advance(now);
    if (!with_.settings.has_axis(n)) return quit::no_axis;
    Axis& a = with_.axes.at(n);
    const auto place = [&](bool g26) {
        if (a.running()) return quit::moves;
        g26 ? a.set_position_g26(task.value, true) : a.set_position_g29(task.value);
        with_.operation.settle(now);
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
            if (!with_.operation.online()) return quit::not_executable;
            a.traverse().start_reference(now);
            with_.operation.settle(now);
            return quit::ok;
        case AxisTask::Kind::set_g26:
            return place(true);
        case AxisTask::Kind::set_g29:
            return place(false);
        case AxisTask::Kind::delete_g29:
            if (a.running()) return quit::moves;
            a.delete_g29();
            with_.operation.settle(now);
            return quit::ok;
        case AxisTask::Kind::reset_displaced:
            with_.axes.clear_displaced();
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
    if (task.while_input && conditional) condition = Condition{*task.while_input, 1, with_.orders.of(n).condition_input};
    return start_with(n, m, condition, now);
}

void Motions::set_axis_on(int n, bool on, Instant now) {
    with_.operation.advance(now);
    if (on) {
        (void)with_.axes.at(n).switch_on(now, with_.operation.online());
    } else {
        with_.axes.at(n).switch_off(now);
    }
    with_.operation.settle(now);
}

void Motions::disable_drive(int n, bool disabled, Instant now) {
    with_.operation.advance(now);
    with_.axes.at(n).disable(disabled, now);
    with_.operation.settle(now);
}

void Motions::interrupt_axis(int n, Instant now) {
    with_.operation.advance(now);
    with_.axes.at(n).traverse().interrupt(now);
    with_.operation.settle(now);
}

void Motions::change_axis_speed(int n, std::uint32_t permille, Instant now) {
    with_.operation.advance(now);
    if (!model_.ep || permille == 0 || permille > 1000) return;
    with_.axes.at(n).traverse().change_speed(static_cast<double>(with_.axes.at(n).parameters()[ap::traverse_speed]) * permille / 1000, now);
    with_.operation.settle(now);
}

void Motions::check_conditions(Instant now) {
    for (int n = 1; n <= with_.axes.count(); ++n) {
        std::optional<Condition>& c = with_.orders.of(n).running;
        if (!with_.axes.at(n).running()) {
            if (!with_.axes.at(n).traverse().busy()) c.reset();
        } else if (c && !fulfilled(*c)) {
            with_.axes.at(n).traverse().finish_by_condition(now);
        }
    }
    with_.operation.settle(now);
}

void Motions::jog(int n, int direction, Instant now) {
    with_.operation.advance(now);
    Axis& a = with_.axes.at(n);
    a.traverse().finish(now);
    if (direction == 0 || a.running() || with_.operation.mode().column() != gate::manual) return with_.operation.settle(now);
    Motion m;
    m.task = Task::jog;
    m.free = true;
    m.target = direction > 0 ? a.traverse().area_max() : a.traverse().area_min();
    m.speed = static_cast<double>(a.parameters()[ap::manual_speed]);
    m.acceleration = static_cast<double>(a.parameters()[ap::acceleration]);
    if (a.traverse().may_start(m, now) == quit::ok) a.traverse().start(m, now);
    with_.operation.settle(now);
}

}  // namespace axisgate::pacontrol::twin
