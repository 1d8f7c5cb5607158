// Coupling: sources, markers, steps.
// In: places. Out: steps of the slaves. Never asks a clock.
#include "adapters/aposs/twin/coupling.hpp"

#include <cmath>
#include <cstdlib>

namespace axisgate::aposs {
namespace {
std::size_t place_of(int axis) { return static_cast<std::size_t>(axis); }
}  // namespace

std::optional<double> index_between(double before, double after, double distance) {
    if (distance <= 0) return std::nullopt;
    const double a = std::floor(before / distance), b = std::floor(after / distance);
    if (a == b) return std::nullopt;
    return distance * (b > a ? b : b + 1);
}

void Coupling::power_on(Instant now) {
    sync_ = {};
    masters_ = {};
    simulations_ = {};
    virtual_.off();
    for (int k = 0; k < axes; ++k) {
        simulations_[place_of(k)].since = now;
        masters_[place_of(k)].seen = raw(Source::encoder, 0, k, now);
    }
}

std::pair<Coupling::Source, int> Coupling::source_of(int axis) const {
    const auto code = encoder_of(axes_[place_of(axis)]->value("MENCODERTYPE"), true).value_or(EncoderCode{});
    if (code.source == Encoder::simulation) return {Source::simulation, 0};
    if (code.source == Encoder::axis_command) return {Source::command, code.number};
    if (virtual_.drives_masters()) return {Source::virtual_master, 0};
    return {Source::encoder, 0};
}
std::int64_t Coupling::raw(Source source, int of_axis, int axis, Instant now) const {
    switch (source) {
        case Source::simulation:
            return simulated(axis, now);
        case Source::command:
            return of_axis >= 1 && of_axis <= axes ? std::llround(axes_[place_of(of_axis - 1)]->servo().shaft().demand(now).position) : 0;
        case Source::virtual_master:
            return virtual_.place();
        case Source::encoder:
            break;
    }
    return (axis > 0 ? std::llround(axes_[0]->place(now)) : 0) + by_hand[place_of(axis)];
}
std::int64_t Coupling::master(int axis, Instant now) {
    Master& m = masters_[place_of(axis)];
    const auto [source, of_axis] = source_of(axis);
    if (source != m.source || of_axis != m.of_axis) {
        m.source = source;
        m.of_axis = of_axis;
        m.seen = raw(source, of_axis, axis, now);
    }
    m.count += raw(source, of_axis, axis, now) - m.seen;
    m.seen = raw(source, of_axis, axis, now);
    return m.count;
}
void Coupling::define_master_origin(int axis, Instant now) {
    (void)master(axis, now);
    Master& m = masters_[place_of(axis)];
    m.before -= std::exchange(m.count, 0);
}

std::string Coupling::synchronise(int axis, SyncMode mode, Instant now) {
    MacsAxis& slave = *axes_[place_of(axis)];
    if (mode == SyncMode::none) {
        end(axis);
        return {};
    }
    if (!slave.servo().takes_orders()) return "axis " + std::to_string(axis + 1) + " is off: enable it first";
    if (const auto refused = slave.forbids(0, now); refused != 0) {
        slave.raise(refused, now);
        return "homing is due (error 6)";
    }
    masters_[place_of(axis)].before = master(axis, now);
    slave_before_[place_of(axis)] = slave.place(now);
    inputs_before_ = terminals_.inputs;
    SyncInput here;
    here.master = masters_[place_of(axis)].before;
    here.slave = slave.place(now);
    const auto demand = slave.servo().shaft().demand(now);
    of(axis).begin(mode, slave.sync_parameters(), here, demand.position, demand.velocity / 1000);
    return {};
}

void Coupling::simulate(int axis, std::int64_t speed, Instant now) {
    Simulation& s = simulations_[place_of(axis)];
    s.place = simulated(axis, now);
    s.speed = speed;
    s.since = now;
}
std::int64_t Coupling::simulated(int axis, Instant now) const {
    const Simulation& s = simulations_[place_of(axis)];
    return s.place + std::llround(static_cast<double>(s.speed) * seconds(now - s.since) * 1000);
}
void Coupling::stop_simulation(Instant now) {
    for (int k = 0; k < axes; ++k)
        simulate(k, 0, now);
}

bool Coupling::edge(const MarkerCode& code, int own_input) const {
    const int n = code.input > 0 ? code.input : own_input;
    const std::uint32_t bit = 1u << (n - 1);
    const bool was = (inputs_before_ & bit) != 0, is = (terminals_.inputs & bit) != 0;
    if (code.gate != 0 && !terminals_.active(code.gate)) return false;
    return code.external && was != is && is != code.falling;
}

SyncInput Coupling::input(int axis, Instant at) {
    MacsAxis& slave = *axes_[place_of(axis)];
    Master& m = masters_[place_of(axis)];
    SyncInput in;
    in.master = master(axis, at);
    in.slave = slave.place(at);
    const auto kind_m = marker_of(slave.value("SYNCMTYPM"), true).value_or(MarkerCode{});
    const auto kind_s = marker_of(slave.value("SYNCMTYPS"), false).value_or(MarkerCode{});
    // The master of axis k is encoder k - 1 here, whose own latch input has that number; a virtual or simulated one has its axis' own.
    const int master_input = axis > 0 ? axis : 1;
    if (kind_m.external) {
        if (edge(kind_m, master_input)) in.master_marker = in.master;
    } else if (m.source != Source::simulation && (kind_m.gate == 0 || terminals_.active(kind_m.gate))) {
        const double distance = m.source == Source::virtual_master ? static_cast<double>(slave.value("VMENCRES"))
                                                                   : 4 * std::fabs(static_cast<double>(slave.value("MENCODER")));
        if (const auto index = index_between(static_cast<double>(m.before), static_cast<double>(in.master), distance))
            in.master_marker = std::llround(*index);
    }
    const bool simulated = slave.value("ENCODERTYPE") == 9;
    if (kind_s.external) {
        if (edge(kind_s, axis + 1)) in.slave_marker = in.slave;
    } else if (slave.index_pulses) {
        const double distance = static_cast<double>(simulated ? slave.value("ENCODERFREQ") : 4 * slave.value("ENCODER"));
        in.slave_marker = index_between(slave_before_[place_of(axis)], in.slave, distance);
    }
    m.before = in.master;
    slave_before_[place_of(axis)] = in.slave;
    return in;
}

bool Coupling::ticks() const { return leads(0) || leads(1) || !virtual_.stands(); }
void Coupling::tick(Instant at) {
    const int source = virtual_.axis();
    virtual_.step(source >= 1 && source <= axes ? axes_[place_of(source - 1)]->servo().shaft().demand(at).velocity : 0);
    for (int k = 0; k < axes; ++k) {
        if (!leads(k)) continue;
        MacsAxis& slave = *axes_[place_of(k)];
        if (!slave.servo().takes_orders()) {
            end(k);
            continue;
        }
        const SyncInput in = input(k, at);
        auto& shaft = slave.servo().shaft();
        const double here = shaft.demand(at).position, there = of(k).step(slave.sync_parameters(), in);
        if (there != here || shaft.demand(at).velocity != 0) shaft.step_to(there, 0.001, at);
    }
    inputs_before_ = terminals_.inputs;
}

}  // namespace axisgate::aposs
