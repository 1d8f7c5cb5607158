// The interpreter of motion commands, first part: general commands and those of the VA interpolator. Errors 0063h, 0081h and 0086h. A
// header whose count did not change has no effect, and a command is carried out completely or not at all.
#include "adapters/linmot/twin/commands.hpp"

#include <algorithm>

#include "adapters/linmot/twin/bytes.hpp"

namespace axisgate::linmot::twin {
namespace {
double velocity32(const Bytes& b, std::size_t at) { return at32(b, at) * Interpolator::velocity_count; }
double acceleration32(const Bytes& b, std::size_t at) { return at32(b, at) * Interpolator::acceleration_count; }
// 16-bit factors are neutral (choice O-19).
double velocity16(const Bytes& b, std::size_t at) { return at16(b, at) * Interpolator::velocity_count; }
double acceleration16(const Bytes& b, std::size_t at) { return at16(b, at) * Interpolator::acceleration_count; }

/// Sub IDs of each master ID, one bit each [L548-901].
constexpr std::uint16_t subs_of(std::uint8_t master) {
    switch (master) {
        case 0x00:
            return 0x031F;
        case 0x01:
            return 0xFFFF;
        case 0x02:
            return 0xFD9F;
        case 0x03:
            return 0x8007;
        case 0x04:
            return 0xD4FF;
        case 0x05:
            return 0x0077;
        case 0x06:
            return 0x7E10;
        case 0x07:
            return 0xC003;
        case 0x09:
            return 0xFDFF;
        case 0x0A:
            return 0x3D9F;
        case 0x0B:
            return 0x3D1F;
        case 0x0C:
            return 0xFDFF;
        case 0x0D:
            return 0xC0F3;
        case 0x10:
            return 0x0017;
        case 0x11:
        case 0x12:
            return 0x01FF;
        case 0x20:
            return 0x0307;
        case 0x21:
            return 0x031F;
        case 0x22:
            return 0xCFFF;
        case 0x24:
            return 0x730F;
        case 0x25:
            return 0xFFCF;
        case 0x26:
            return 0x003D;
        case 0x30:
            return 0x0033;
        case 0x31:
            return 0x0003;
        case 0x38:
            return 0x003F;
        default:
            return 0;
    }
}
}  // namespace

bool Interpreter::listed(std::uint16_t header) noexcept {
    return (subs_of(static_cast<std::uint8_t>(header >> 8)) >> (header >> 4 & 0x0F) & 1) != 0;
}

bool Interpreter::has(std::uint16_t header) const noexcept {
    if (!listed(header)) return false;
    const auto master = static_cast<std::uint8_t>(header >> 8);
    if (master == 0x38) return body_.setup.force_key;
    if (body_.setup.series == Series::e1100) return true;
    switch (master) {
        case 0x05:
        case 0x0B:
        case 0x30:
            return false;  // winding by the text of the manual (E-28)
        case 0x04:
        case 0x06:
        case 0x10:
        case 0x11:
        case 0x12:
        case 0x31:
            return body_.setup.curve_key;
        default:
            break;
    }
    const std::uint16_t h = header & 0xFFF0;
    return h != 0x0040 && h != 0x2080 && h != 0x2090 && h != 0x2630;
}

void Interpreter::write(std::span<const std::uint8_t> bytes, Instant now) {
    CommandBuffer& buffer = body_.buffer;
    std::copy_n(bytes.begin(), std::min(bytes.size(), buffer.bytes.size()), buffer.bytes.begin());
    const std::uint16_t header = at16(buffer.bytes, 0);
    if ((header & 0x0F) == (buffer.echo & 0x0F)) return;  // only the count decides [L545-547]
    buffer.echo = static_cast<std::uint8_t>(header & 0x0F);
    buffer.last_header = header;
    execute(header, buffer.bytes, false, now);
    states_.evaluate(now);
}

void Interpreter::execute(std::uint16_t header, const Bytes& b, bool from_table, Instant now) {
    if (const Fault fault = carry_out(header, b, from_table, now)) states_.raise(fault, now);
}

namespace {
/// Whether a command starts a motion at once: commands that wait, branch, arm a trigger, define something or queue do not.
bool moves_at_once(std::uint8_t master, std::uint8_t sub) {
    const bool waits_or_branches = master >= 0x20 && master <= 0x26;
    const bool arms = (master == 1 || master == 2 || master == 9 || master == 0x0A || master == 0x0B || master == 0x0C)
                          ? sub >= 0x0A && !((master == 2 || master == 0x0C) && sub >= 0x0E)
                          : (master == 4 && sub >= 6) || (master == 6 && sub >= 9);
    const bool defines = (master >= 0x10 && master <= 0x12 && (master != 0x10 || sub == 4)) || (master == 0x30 && sub >= 4);
    return master != 0 && !waits_or_branches && !arms && !defines && sub != 8 && master != 5;
}
}  // namespace

Fault Interpreter::carry_out(std::uint16_t header, const Bytes& b, bool from_table, Instant now) {
    const auto master = static_cast<std::uint8_t>(header >> 8);
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    const bool anywhere = master == 0 && sub <= 8;
    if (states_.in_error()) {
        if (!anywhere) return 0;  // ignored: the first code stays (choice O-01)
    } else if (!has(header)) {
        return 0x81;
    } else if (!anywhere && states_.state() != operation_enabled) {
        return 0x86;
    }
    ++commands_done_;
    // An immediate motion command clears the queue, and ends a sequence of the command table unless it belongs to it (choices O-08, O-16).
    if (moves_at_once(master, sub)) {
        body_.demand.vai().forget_queued();
        if (!from_table) body_.table.end();
    }
    switch (master) {
        case 0x00:
            return general(sub, b, now), Fault{0};
        case 0x01:
        case 0x02:
        case 0x09:
        case 0x0A:
        case 0x0B:
        case 0x0C:
        case 0x0D:
        case 0x07:
            return interpolator(header, b, now);
        case 0x03:
            return body_.demand.take(sub, b, now);
        case 0x04:
        case 0x05:
            return curve(header, b, now);
        case 0x06:
        case 0x10:
        case 0x11:
        case 0x12:
            return cam(header, b, now);
        case 0x30:
        case 0x31:
            return winding(header, b, now);
        case 0x38:
            return force(sub, b, now), Fault{0};
        default:
            return table(header, b, from_table, now);
    }
}

void Interpreter::general(std::uint8_t sub, const Bytes& b, Instant now) {
    const auto masked = [&](std::uint16_t& word) { word = static_cast<std::uint16_t>((word & ~at16(b, 2)) | (at16(b, 4) & at16(b, 2))); };
    Demand& demand = body_.demand;
    switch (sub) {
        case 1:
            return states_.write(at16(b, 2), now);
        case 2:
            if (const auto* f = body_.memory.facts(at16(b, 2)); f && f->live()) {  // others: ignored (choice O-24)
                demand.step_coupling(now);
                const double here = demand.at(now).position;
                body_.memory.set_ram(at16(b, 2), at32(b, 4));
                // "Cam enabled" was cleared: the demand rests there.
                if (demand.coupling().mode() != Coupling::Mode::none && !demand.coupling().active()) demand.vai().rest(here, now);
            }
            return;
        case 3:
            return masked(x4_outputs_);
        case 4:
            return masked(x6_outputs_);
        case 8:
            body_.armed = {};
            return demand.end_index();
        case 9:
            return rename(b, now);
        default:
            return;
    }
}

/// Homing at the actual position, without state 9 [L1000-1004].
void Interpreter::rename(const Bytes& b, Instant now) {
    Follower& follower = body_.follower;
    const double here = follower.place(now).position;
    const double shift = signed32(b, 2) - (here + follower.offset());
    body_.memory.set_ram(0x13C7, at32(b, 2));
    body_.memory.set_ram(0x13CA, static_cast<std::uint32_t>(static_cast<std::int32_t>(body_.memory.number(0x13CA) + shift)));
    follower.rename(shift);
    body_.demand.vai().stand(here + follower.offset(), now);
}

/// Master 0Dh: a target that the drive knows: the captured position, that of a trigger, or a parameter.
Order Interpreter::order_of_position(std::uint8_t sub, const Bytes& b) const {
    if (sub == 0) return {0, body_.follower.captured() + signed32(b, 2), {velocity32(b, 6), acceleration32(b, 10), acceleration32(b, 14)}};
    if (sub == 1) return {0, signed16(b, 2), {velocity16(b, 4), acceleration16(b, 6), acceleration16(b, 6)}};
    if (sub >= 0x0E) return {0, sub == 0x0E ? body_.setup.trig_rise : body_.setup.trig_fall, body_.demand.vai().predefined()};
    return {static_cast<std::uint8_t>(sub >= 6 ? 3 : 0),
            body_.memory.number((sub & 1) == 0 ? 0x1E72 : 0x1E73),
            {velocity32(b, 2), acceleration32(b, 6), acceleration32(b, 10)}};
}

/// The order waits for an edge of the trigger input.
void Interpreter::arm_order(const Order& o) {
    const bool transition = o.sub >= 0x0E;
    body_.armed = {};
    body_.armed.kind = transition      ? (o.sub == 0x0E ? Armed::Kind::upwards : Armed::Kind::downwards)
                       : o.sub <= 0x0B ? Armed::Kind::rising
                                       : Armed::Kind::falling;
    body_.armed.what = transition ? Armed::What::change : Armed::What::vai;
    body_.armed.position = o.value;
    body_.armed.order = o;
    body_.armed.order.sub = o.sub == 0x0B || o.sub == 0x0D ? 2 : 0;
}

Fault Interpreter::interpolator(std::uint16_t header, const Bytes& b, Instant now) {
    Demand& demand = body_.demand;
    const auto master = static_cast<std::uint8_t>(header >> 8);
    const auto sub = static_cast<std::uint8_t>(header >> 4 & 0x0F);
    const auto v32 = [&](std::size_t at) { return velocity32(b, at); };
    const auto a32 = [&](std::size_t at) { return acceleration32(b, at); };
    const auto v16 = [&](std::size_t at) { return velocity16(b, at); };
    const auto a16 = [&](std::size_t at) { return acceleration16(b, at); };
    Order o;
    o.sub = sub;
    o.ramps = demand.vai().predefined();
    bool press = false, endless = false;
    switch (master) {
        case 0x01:
            if (sub == 7) return demand.stop(a32(2), now), Fault{0};
            if (sub == 9) {
                o = {0, static_cast<double>(body_.outside.analog), {v32(2), a32(6), a32(10)}};
                break;
            }
            o.value = signed32(b, 2);
            o.ramps = {v32(6), a32(10), a32(14)};
            break;
        case 0x02:
            if (sub == 7) return demand.stop(Interpolator::quick_deceleration, now), Fault{0};
            endless = sub >= 0x0E;
            o.value = signed32(b, 2);
            break;
        case 0x09:
            if (sub == 7) return demand.stop(a16(2), now), Fault{0};
            o.value = signed16(b, 2);
            o.ramps = {v16(4), a16(6), a16(8)};
            break;
        case 0x0A:
            if (sub == 7) return demand.stop(Interpolator::quick_deceleration, now), Fault{0};
            o.value = signed16(b, 2);
            break;
        case 0x0B:
            o.value = signed32(b, 2);
            o.ramps.velocity = v32(6);
            break;
        case 0x0C:
            endless = sub >= 0x0E;
            if (endless) {
                o.ramps = {v32(2), a32(6), a32(6)};
                break;
            }
            o.value = signed32(b, 2);
            o.ramps = {v32(6), a32(10), a32(10)};
            press = sub >= 5 && sub <= 7;
            if (press) {
                const std::uint16_t most = at16(b, 14);
                if (most == 0) return 0x63;
                body_.memory.set_ram(0x13A6, most);  // controller set A is active; the value is kept [L2687-2750]
                o.sub = sub == 5 ? 0 : sub == 6 ? 3 : 4;
            }
            break;
        case 0x0D:
            o = order_of_position(sub, b);
            break;
        case 0x07:
            o.value = signed32(b, 2);
            if (sub == 0 || sub == 0x0E) o.ramps = {v32(6), a32(10), a32(14)};
            if (sub <= 1) return demand.index(o.value, o.ramps, now), Fault{0};
            demand.end_index();
            o.sub = 0;
            break;
        default:
            return 0;
    }
    if (endless || o.sub < 0x0A) {
        begin(o, endless, now);
    } else {
        arm_order(o);
    }
    return 0;
}

/// A motion of the interpolator, at once or after the motion in progress.
void Interpreter::begin(Order o, bool endless, Instant now) {
    Demand& demand = body_.demand;
    const bool behind = !endless && o.sub == 8;
    if (behind) o.sub = 0;
    if (behind && states_.moves(now)) return demand.vai().queue(o);
    demand.leave_all(now);
    body_.force.end_watch();
    if (endless) return demand.vai().endless(demand.at(now), o.sub == 0x0E ? 1 : -1, o.ramps, now);
    start(o, now);
}

void Interpreter::start(const Order& order, Instant now) { body_.demand.start(order, body_.follower.actual(now), now); }

void Interpreter::start_queued(Instant now) {
    const Order order = *body_.demand.vai().queued();
    body_.demand.vai().forget_queued();
    start(order, now);
}

// --- events -------------------------------------------------------------------------------------------------------------------
void Interpreter::arm(Armed::Kind kind, Armed::What what, std::uint8_t sub, const Bytes& b) {
    body_.armed = {};
    body_.armed.kind = kind;
    body_.armed.what = what;
    body_.armed.order.sub = sub;
    body_.armed.bytes = b;
}

void Interpreter::fire(Instant now) {
    if (states_.state() != operation_enabled) return;
    const Armed e = body_.armed;
    Fault fault = 0;
    switch (e.what) {
        case Armed::What::vai:
            return start(e.order, now);
        case Armed::What::change:
            return body_.demand.vai().change(body_.demand.at(now), e.order.ramps, now);
        case Armed::What::table:
            return start_entry(at16(e.bytes, 2), now);
        case Armed::What::cam:
            fault = shot(e.order.sub, e.bytes, now);
            break;
        case Armed::What::curve:
            fault = body_.demand.play(e.order.sub, e.bytes, now);
            break;
    }
    if (fault != 0) states_.raise(fault, now);
}

void Interpreter::edge(bool rising, Instant now) {
    body_.table.edge(rising);
    if (body_.armed.kind == (rising ? Armed::Kind::rising : Armed::Kind::falling)) fire(now);
    step_table(now);
}

}  // namespace axisgate::linmot::twin
