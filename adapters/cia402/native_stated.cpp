// The effect of an object write or an action on an axis, determined before it is sent: targets, rates for later motions, or that it cannot
// be determined. Mode and state of the drive are not known here: a target counts as a motion, and a control word that continues or starts
// an order in the drive counts as not readable.
#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/family.hpp"

namespace axisgate::cia402_drive {
namespace {
using Kind = Stated::Kind;

bool in(Address a, std::uint16_t from, std::uint16_t through) { return a.index >= from && a.index <= through; }

Stated moves(Move::Kind kind, std::int64_t target) {
    Stated s{Kind::motion};
    s.move.kind = kind;
    s.move.target = target;
    return s;
}

/// An object of the profile; the address is that of the first axis.
Stated of_profile(Address a, std::int64_t v) {
    Stated s{Kind::nothing};
    if (a == object::controlword) {
        const bool runs = (v & 0x0F) == 0x0F && (v & 0x100) == 0;
        s.kind = runs ? Kind::unread : Kind::nothing;
    } else if (a == object::mode) {
        s.kind = v == 0 || v == 1 || v == 6 ? Kind::nothing : Kind::unread;  // the others start at once when the axis is enabled
    } else if (a == object::target_position || a == object::interpolated_position) {
        return moves(Move::Kind::absolute, v);
    } else if (a == object::target_velocity) {
        return moves(Move::Kind::velocity, v);
    } else if (a == object::target_torque || in(a, 0x6042, 0x6042) || in(a, 0x60B0, 0x60B2) || in(a, 0x60C1, 0x60C1)) {
        s.kind = v == 0 && a == object::target_torque ? Kind::nothing : Kind::unread;  // torque, vl mode, offsets, further sets of data
    } else if (in(a, 0x6082, 0x6082)) {
        s.kind = v == 0 ? Kind::nothing : Kind::unread;  // the velocity at which the axis continues past its target
    } else if (v > 0) {
        if (a == object::profile_velocity) s.sets.velocity = v;
        if (a == object::profile_acceleration) s.sets.acceleration = v;
        if (a == object::profile_deceleration) s.sets.deceleration = v;
        if (a == object::quick_stop_deceleration) s.sets.quick_stop = v;
    }
    return s;
}

/// `p` is its row of the catalogue; nullptr if there is none.
Stated of_object(const Catalogue& catalogue, int channel, Address a, std::int64_t v, const Parameter* p) {
    if (a.index < 0x2000) return {Kind::nothing};  // communication, store, restore
    if (a.index < 0x6000) return {p && !p->live ? Kind::nothing : Kind::unread};
    if (a.index >= 0xA000) return {Kind::unread};
    const int axis = 1 + (a.index - 0x6000) / 0x800;
    if (axis > std::max(catalogue.most_channels(), 1)) return {Kind::unread};
    Stated s = of_profile(of_first_axis(a), v);
    s.channel = axis == channel ? 0 : axis;
    return s;
}

Stated of_native(const Catalogue& catalogue, int channel, const Native& native) {
    const auto write = object_write(catalogue, {reinterpret_cast<const char*>(native.send.data()), native.send.size()});
    if (!write) return {Kind::nothing};  // a read, or it is refused
    // The sign of an object of 16 or 8 bits is treated as that of one of 32 bits.
    const bool word = write->address == object::controlword || of_first_axis(write->address) == object::controlword;
    const std::int64_t v = word ? static_cast<std::int64_t>(canopen::low_first(write->bytes)) : signed_of(write->bytes);
    if (write->bytes.size() > 4 && write->address.index >= 0x6000) return {Kind::unread};
    const Address a = of_first_axis(write->address);
    const bool no_sign = in(a, 0x6081, 0x6085);
    return of_object(catalogue, channel, write->address, no_sign ? static_cast<std::int64_t>(canopen::low_first(write->bytes)) : v,
                     parameter_at(catalogue, write->address));
}
}  // namespace

Stated stated(const Catalogue& catalogue, int channel, const CommandBody& body) {
    if (const auto* native = std::get_if<Native>(&body)) return of_native(catalogue, channel, *native);
    if (const auto* write = std::get_if<WriteParameter>(&body)) {
        const Parameter* p = catalogue.parameter(write->point);
        const auto place = p ? place_of(*p, write->point, channel - 1) : std::nullopt;
        const auto v = as_integer(write->value);
        if (!place || !v) return {Kind::nothing};
        // Rows of the profile stand for the axis that was addressed.
        Stated s = of_object(catalogue, 1, of_first_axis(*place), *v, p);
        if (s.channel == 1) s.channel = 0;
        return s;
    }
    if (const auto* action = std::get_if<Action>(&body)) {
        // A restart may begin a program in the drive; drives of the plain CiA 402 family have none.
        const bool programs = catalogue.document().if_contains("dialect") != nullptr;
        const bool restarts = action->name == "nmt_reset_node" || action->name == "nmt_reset_communication";
        return {programs && restarts ? Kind::unread : Kind::nothing};
    }
    return {Kind::nothing};
}

}  // namespace axisgate::cia402_drive
