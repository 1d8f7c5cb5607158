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
        Master& m = masters_[place_of(k)];
        simulations_[place_of(k)].since = now;
        m.zero = turned(k, now);
        m.from = source_of(k);
        m.count = m.before = m.seen = raw(m.from, k, now);
        forget_markers(k, now);
    }
}

Coupling::Origin Coupling::source_of(int axis) const {
    const auto code = encoder_of(axes_[place_of(axis)]->value("MENCODERTYPE"), true).value_or(EncoderCode{});
    if (code.source == Encoder::simulation) return {Source::simulation, 0};
    if (code.source == Encoder::axis_command) return {Source::command, code.number};
    if (virtual_.drives_masters()) return {Source::virtual_master, 0};
    return {Source::encoder, code.source == Encoder::incremental ? code.number : 0};
}
std::int64_t Coupling::turned(int axis, Instant now) const {
    return (axis > 0 ? std::llround(axes_[0]->place(now)) : 0) + by_hand[place_of(axis)];
}
std::int64_t Coupling::raw(const Origin& from, int axis, Instant now) const {
    const bool of_axis = from.number >= 1 && from.number <= axes;
    switch (from.source) {
        case Source::simulation:
            return simulated(axis, now);
        case Source::command:
            return of_axis ? std::llround(axes_[place_of(from.number - 1)]->servo().shaft().demand(now).position) : 0;
        case Source::virtual_master:
            return virtual_.place();
        case Source::encoder:
            break;
    }
    if (of_axis) return std::llround(axes_[place_of(from.number - 1)]->encoder(now));
    return turned(axis, now) - masters_[place_of(axis)].zero;
}
std::int64_t Coupling::master(int axis, Instant now) {
    Master& m = masters_[place_of(axis)];
    const Origin from = source_of(axis);
    if (from != m.from) {
        const auto virtual_one = [](const Origin& o) { return o.source == Source::virtual_master; };
        const bool soft = (axes_[place_of(axis)]->value("MENCCONTROL") & 1) != 0 || from.source == Source::command || virtual_one(from) ||
                          virtual_one(m.from);
        m.from = from;
        m.seen = raw(from, axis, now);
        if (!soft) m.before = m.count = m.seen;
    }
    m.count += raw(from, axis, now) - m.seen;
    m.seen = raw(from, axis, now);
    return m.count;
}
void Coupling::define_master_origin(int axis, Instant now) {
    const auto was = master(axis, now);
    Master& m = masters_[place_of(axis)];
    const bool soft = (axes_[place_of(axis)]->value("MENCCONTROL") & 2) != 0;
    if (!soft && m.from.source == Source::simulation) {
        simulate(axis, simulations_[place_of(axis)].speed, now);
        simulations_[place_of(axis)].place = 0;
    }
    if (!soft && m.from.source == Source::encoder) {
        if (m.from.number >= 1 && m.from.number <= axes) {
            MacsAxis& other = *axes_[place_of(m.from.number - 1)];
            other.shift_origin(other.encoder(now));  // the other axis uses the same encoder
            other.reset_encoder(now);
        } else {
            m.zero = turned(axis, now);
        }
    }
    m.count = 0;
    m.before -= was;
    m.seen = raw(m.from, axis, now);
    if (auto& known = known_[place_of(axis)].master) *known -= was;
    of(axis).shift_master(was);
}
void Coupling::define_origin(int axis, Instant now) {
    MacsAxis& a = *axes_[place_of(axis)];
    a.define_origin(now);
    if ((a.value("ENCCONTROL") & 2) == 0) a.reset_encoder(now);
}
void Coupling::forget_markers(int axis, Instant now) { known_[place_of(axis)] = {axes_[place_of(axis)]->place(now), {}, {}}; }

double Coupling::master_index(int axis) const {
    const MacsAxis& a = *axes_[place_of(axis)];
    return masters_[place_of(axis)].from.source == Source::virtual_master ? static_cast<double>(a.value("VMENCRES"))
                                                                          : 4 * std::fabs(static_cast<double>(a.value("MENCODER")));
}
double Coupling::slave_index(int axis) const {
    const MacsAxis& a = *axes_[place_of(axis)];
    return static_cast<double>(a.value("ENCODERTYPE") == 9 ? a.value("ENCODERFREQ") : 4 * a.value("ENCODER"));
}
/// Markers that have passed before SYNCM: those that were observed, and index pulses passed since they were forgotten.
void Coupling::remember(int axis, SyncInput& here) const {
    const MacsAxis& slave = *axes_[place_of(axis)];
    const Known& known = known_[place_of(axis)];
    here.master_marker = known.master;
    here.slave_marker = known.slave;
    const auto kind = marker_of(slave.value("SYNCMTYPS"), false).value_or(MarkerCode{});
    if (!here.slave_marker && !kind.external && slave.index_pulses)
        here.slave_marker = index_between(known.from, here.slave, slave_index(axis));
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
    remember(axis, here);
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
    // The master of axis k is encoder k - 1 here, whose own latch input has that number; a virtual or simulated master uses that of the
    // axis.
    const int master_input = axis > 0 ? axis : 1;
    if (kind_m.external) {
        if (edge(kind_m, master_input)) in.master_marker = in.master;
    } else if (m.from.source != Source::simulation && (kind_m.gate == 0 || terminals_.active(kind_m.gate))) {
        if (const auto index = index_between(static_cast<double>(m.before), static_cast<double>(in.master), master_index(axis)))
            in.master_marker = std::llround(*index);
    }
    if (kind_s.external) {
        if (edge(kind_s, axis + 1)) in.slave_marker = in.slave;
    } else if (slave.index_pulses) {
        in.slave_marker = index_between(slave_before_[place_of(axis)], in.slave, slave_index(axis));
    }
    if (in.master_marker) known_[place_of(axis)].master = in.master_marker;
    if (in.slave_marker) known_[place_of(axis)].slave = in.slave_marker;
    m.before = in.master;
    slave_before_[place_of(axis)] = in.slave;
    return in;
}

bool Coupling::watches(int axis) const { return (axes_[place_of(axis)]->value("SYNCMFPAR") & 64) != 0; }
bool Coupling::ticks() const { return leads(0) || leads(1) || watches(0) || watches(1) || !virtual_.stands(); }
void Coupling::tick(Instant at) {
    const int source = virtual_.axis();
    virtual_.step(source >= 1 && source <= axes ? axes_[place_of(source - 1)]->servo().shaft().demand(at).velocity : 0);
    for (int k = 0; k < axes; ++k) {
        if (!leads(k) && !watches(k)) continue;
        MacsAxis& slave = *axes_[place_of(k)];
        if (leads(k) && !slave.servo().takes_orders()) end(k);
        const SyncInput in = input(k, at);
        if (watches(k)) of(k).watch(slave.sync_parameters(), in);
        if (!leads(k)) continue;
        auto& shaft = slave.servo().shaft();
        const double here = shaft.demand(at).position, there = of(k).step(slave.sync_parameters(), in);
        if (there != here || shaft.demand(at).velocity != 0) shaft.step_to(there, 0.001, at);
    }
    inputs_before_ = terminals_.inputs;
}

}  // namespace axisgate::aposs
