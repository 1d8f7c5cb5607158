// The interpreter, second part: time curves, cams, winding and force (motion commands of 04h to 06h, 10h to 12h, 30h, 31h and 38h). Errors
// 0062h, 0089h, 000Bh.
#include "adapters/linmot/twin/bytes.hpp"
#include "adapters/linmot/twin/commands.hpp"

namespace axisgate::linmot::twin {
using Kind = Armed::Kind;

Fault Interpreter::curve(std::uint16_t header, const Bytes& b, Instant now) {
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    if (header >> 8 == 0x05) return modify(body_.curves, sub, b);
    const bool on_trigger = sub == 6 || sub == 7 || sub >= 0x0A;
    if (!on_trigger) return body_.demand.play(sub, b, now);
    const auto kind = sub == 6 || sub == 0x0A || sub == 0x0E ? Kind::rising : Kind::falling;
    arm(kind, Armed::What::curve, sub <= 7 ? 5 : sub <= 0x0C ? 2 : 3, b);
    return 0;
}

Fault Interpreter::cam(std::uint16_t header, const Bytes& b, Instant now) {
    const auto master = static_cast<std::uint8_t>(header >> 8);
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    Coupling& coupling = body_.demand.coupling();
    body_.demand.step_coupling(now);
    if (master == 0x10) return cams(sub, b, now);
    if (master == 0x06) {
        if (sub == 4) return shot(sub, b, now);
        if (const Fault fault = coupling.preset(sub, b)) return fault;
        return arm(Coupling::rising(sub) ? Kind::rising : Kind::falling, Armed::What::cam, sub, b), Fault{0};
    }
    const double here = body_.demand.at(now).position;
    const Fault fault = coupling.define(master - 0x11u, sub, b, body_.follower.actual(now).position);
    const bool switches = sub == 6 || sub == 7;
    if (switches && coupling.mode() == Coupling::Mode::cams && !coupling.cams_used()) body_.demand.vai().rest(here, now);
    return fault;
}

Fault Interpreter::cams(std::uint8_t sub, const Bytes& b, Instant now) {
    Demand& demand = body_.demand;
    switch (sub) {
        case 0:
            if (!demand.coupling().cams_used()) return 0x62;
            demand.uncouple(now);
            body_.memory.set_ram(0x1BA9, body_.memory.ram(0x1528) != 0 ? 1 : 0);
            return couple(Coupling::Mode::cams, now);
        case 1:
            return demand.uncouple(now), Fault{0};
        case 2: {  // to the position that belongs to the present count, with the predefined values
            demand.uncouple(now);
            const auto to = demand.coupling().place(body_.master.count(now));
            if (!to) return 0x62;
            return start({0, to->position, demand.vai().predefined()}, now), Fault{0};
        }
        default:
            body_.master.name(signed32(b, 2), now);
            return demand.coupling().renamed(now), Fault{0};
    }
}

Fault Interpreter::shot(std::uint8_t sub, const Bytes& b, Instant now) {
    if (const Fault fault = body_.demand.coupling().prepare_shot(sub, b, body_.demand.at(now).position, now)) return fault;
    return couple(Coupling::Mode::shot, now);
}

Fault Interpreter::winding(std::uint16_t header, const Bytes& b, Instant now) {
    const int sub = header >> 4 & 0x0F;
    Coupling& coupling = body_.demand.coupling();
    if (header >> 8 == 0x30 && sub >= 4) return coupling.hold_adaptation(sub == 4, now), Fault{0};
    if (const Fault fault = coupling.prepare_winding(header, b, now)) return fault;
    return couple(Coupling::Mode::winding, now);
}

Fault Interpreter::couple(Coupling::Mode mode, Instant now) {
    body_.force.end_watch();
    return body_.demand.couple(mode, now);
}

void Interpreter::force(std::uint8_t sub, const Bytes& b, Instant now) {
    if (sub == 2) return body_.force.retarget(at16(b, 2));
    const auto acceleration = [&](std::size_t at) { return at32(b, at) * Interpolator::acceleration_count; };
    Order o{0, signed32(b, 2), {at32(b, 6) * Interpolator::velocity_count, acceleration(10), acceleration(10)}};
    if (sub == 1) {
        o.sub = 3;
        o.ramps.deceleration = acceleration(14);
        body_.force.end();
        return start(o, now);
    }
    body_.force.watch(sub, b);
    start(o, now);
    states_.check(now);
}

}  // namespace axisgate::linmot::twin
