// The 28 instructions: validation, GETs, acknowledgements, error reports and their history.
// In: telegrams for this drive. Out: at most one answer each.
// Never executes a wrong instruction in part. SETs are in sets.cpp.
#include <algorithm>
#include <cmath>

#include "adapters/uim342/twin/device_reports.hpp"
#include "adapters/uim342/twin/telegrams.hpp"

namespace axisgate::uim342::twin {
namespace {

/// The lengths that make a control word a GET or a SET (bit n: DL = n): the length alone tells them apart.
struct Shape {
    std::uint16_t get = 0;
    std::uint16_t set = 0;
    bool indexed = false;  ///< d0 is a sub-index
    [[nodiscard]] constexpr bool known() const { return (get | set) != 0; }
};

constexpr std::uint16_t dl(int n) { return static_cast<std::uint16_t>(1u << n); }

constexpr std::array<Shape, 128> make_shapes() {
    std::array<Shape, 128> s{};
    // The manual's own examples send two bytes for 32-bit values: 1..4 are taken, the missing ones are 0.
    constexpr auto short_forms = static_cast<std::uint16_t>(dl(1) | dl(2) | dl(3) | dl(4));
    s[PP] = {dl(1), dl(2), true};
    for (const auto cw : {IC, IE, QE, MT, IL, TG})
        s[cw] = {dl(1), dl(3), true};
    s[ML] = s[SN] = {dl(0), 0, false};
    s[ER] = {dl(1), static_cast<std::uint16_t>(dl(2) | dl(3)), true};
    s[MS] = {dl(1), dl(2), true};
    s[SY] = {0, dl(1), true};
    s[MO] = s[MF] = {dl(0), dl(1), false};
    s[BG] = s[ST] = s[OG] = {0, dl(0), false};
    for (const auto cw : {AC, DC, SS, SD, JV, SP, PR, PA, BL})
        s[cw] = {dl(0), short_forms, false};
    s[DV] = {dl(1), 0, true};
    s[DI] = {dl(0), dl(4), false};
    return s;
}
constexpr auto shapes = make_shapes();

/// MS[1] [L909-918]. The speed has 24 bits: it saturates, because a wrapped speed would show the wrong direction.
void fill_speed_and_position(Telegram& reply, const Axis& axis, Instant now) noexcept {
    const auto speed = std::clamp(whole(axis.speed(now)), -8'388'607, 8'388'607);
    reply.d[0] = 1;
    put(reply, 1, static_cast<std::uint32_t>(speed), 3);
    put(reply, 4, static_cast<std::uint32_t>(axis.position(now)), 4);
    reply.dl = 8;
}

/// DV[1], 0.1 A: nothing while off, the working current in motion, the idle share of it at rest.
std::int32_t motor_current(const Axis& axis, const Settings& s) noexcept {
    if (!axis.driver_on()) return 0;
    return axis.moving() ? s.mt[1] : s.mt[1] * s.mt[2] / 100;
}

/// Refusals of a specimen that insists on more than the manual's drive: whole values, and settings at rest only.
Fault strict_fault(const Manners& manners, const Telegram& t, bool is_set, bool moving) noexcept {
    if (!is_set) return Fault::none;
    constexpr auto of_values = static_cast<std::uint16_t>(dl(1) | dl(2) | dl(3) | dl(4));
    if (!manners.short_values && shapes[t.function()].set == of_values && t.dl != 4) return Fault::syntax;
    constexpr std::array<std::uint8_t, 9> settings{AC, DC, SS, SD, BL, IE, IL, TG, MT};
    const bool setting = std::ranges::find(settings, t.function()) != settings.end();
    return manners.settings_at_rest && setting && moving ? Fault::running : Fault::none;
}
}  // namespace

/// Order of validation: control word, length, sub-index, value, state (section 3.1 of our reading).
void Device::instruct(const Telegram& t, Instant now, Out& out) {
    const Shape& shape = shapes[t.function()];
    const bool is_get = t.dl <= 8 && ((shape.get >> t.dl) & 1u) != 0;
    const bool is_set = t.dl <= 8 && ((shape.set >> t.dl) & 1u) != 0;
    const std::uint8_t sub = shape.indexed && t.dl > 0 ? t.d[0] : std::uint8_t{0};
    if (!is_get && !is_set) {
        DeviceReports(*this).report(Fault::syntax, t, sub, now, out);
        return;
    }
    if (const Fault fault = strict_fault(manners_, t, is_set, axis_.moving()); fault != Fault::none)
        return DeviceReports(*this).report(fault, t, sub, now, out);
    Telegram reply;
    reply.producer = link_.node;
    reply.consumer = t.producer;
    reply.cw = t.function();
    Fault fault{};
    if (is_get) {
        fault = shape.indexed ? get_indexed(t, now, reply) : get(t, now, reply);
    } else {
        fault = shape.indexed ? set_indexed(t, now, reply, out) : set(t, now, reply, out);
    }
    if (fault != Fault::none) {
        DeviceReports(*this).report(fault, t, sub, now, out);
    } else if (t.wants_ack() && t.function() != SY && (manners_.broadcast_acknowledge || t.consumer == link_.node)) {
        link_.send(reply, now, out);
    }
}

// --- GET ----------------------------------------------------------------------------------------------------------------

Fault Device::get(const Telegram& t, Instant now, Telegram& reply) {
    const Settings& s = memory_.ram();
    switch (t.function()) {
        case ML:
            DeviceReports::fill_model(*this, reply);
            return Fault::none;
        case SN:
            put(reply, 0, memory_.serial(), 4);
            put(reply, 4, identity_.manufacturer, 2);
            put(reply, 6, identity_.vendor, 2);
            reply.dl = 8;
            return Fault::none;
        case MO:
            put_value(reply, axis_.driver_on() ? 1 : 0, 1);
            return Fault::none;
        case MF:
            put_value(reply, wanted_.pending_group, 1);
            return Fault::none;
        case DI:
            put_ports(reply, inputs_.latched(), flags_.output);
            return Fault::none;
        default:
            break;
    }
    const std::size_t group = wanted_.take_group();
    const Group& g = s.group[group];
    const auto present = [&](std::int32_t of_group, std::int32_t actual) {
        put_value(reply, static_cast<std::uint32_t>(group == 0 ? actual : of_group), 4);
    };
    switch (t.function()) {
        case AC:
            put_value(reply, g.ac, 4);
            break;
        case DC:
            put_value(reply, g.dc, 4);
            break;
        case SS:
            put_value(reply, s.ss, 4);
            break;
        case SD:
            put_value(reply, s.sd, 4);
            break;
        case BL:
            put_value(reply, s.bl, 4);
            break;
        case JV:
            put_value(reply, static_cast<std::uint32_t>(whole(axis_.speed(now))), 4);
            break;
        case SP:
            present(g.sp, whole(axis_.speed(now)));
            break;
        case PR:
            present(g.pr, axis_.relative(now));
            break;
        case PA:
            present(g.pa, axis_.position(now));
            break;
        default:
            return Fault::syntax;
    }
    return Fault::none;
}

Fault Device::get_indexed(const Telegram& t, Instant now, Telegram& reply) const {
    const Settings& s = memory_.ram();
    const std::uint8_t i = t.d[0];
    const auto word = [&](const auto& array) {
        if (i >= array.size()) return Fault::sub_index;
        put_indexed(reply, i, array[i], 2);
        return Fault::none;
    };
    switch (t.function()) {
        case MS:
            if (i > 1) return Fault::sub_index;
            if (i == 0) {
                DeviceReports::fill_status(*this, reply, now);
            } else {
                fill_speed_and_position(reply, axis_, now);
            }
            return Fault::none;
        case DV: {
            const std::array<std::int32_t, 5> desired{wanted_.ptp ? 1 : 0, motor_current(axis_, s), wanted_.speed, wanted_.relative,
                                                      wanted_.absolute};
            if (i >= desired.size()) return Fault::sub_index;
            put_indexed(reply, i, static_cast<std::uint32_t>(desired[i]), 4);
            return Fault::none;
        }
        case PP:  // what is stored, not what is active: it acts after a reboot
            if (i != 5 && i != 7 && i != 8) return Fault::sub_index;
            put_indexed(reply, i, i == 5 ? memory_.flash().bit_rate : (i == 7 ? memory_.flash().node : memory_.flash().group), 1);
            return Fault::none;
        case IE: {
            const auto slot = ie_slot(i);
            if (!slot) return Fault::sub_index;
            put_indexed(reply, i, s.ie[*slot], 2);
            return Fault::none;
        }
        case ER: {
            const ErrorEntry* const e = history_.slot(i);
            if (e == nullptr) return Fault::sub_index;
            reply.d = {i, e->code, e->cw, e->sub, 0, 0, 0, 0};
            reply.dl = 6;
            return Fault::none;
        }
        case QE:
            if (i == 3) {
                put_indexed(reply, i, battery_low_ ? 0 : 1, 2);
                return Fault::none;
            }
            return word(s.qe);
        case IC:
            return word(s.ic);
        case MT:
            return word(s.mt);
        case IL:
            return word(s.il);
        case TG:
            return word(s.tg);
        default:
            return Fault::syntax;
    }
}

// --- error history ------------------------------------------------------------------------------------------------------

Fault Device::clear_error(const Telegram& t, Telegram& reply) {
    ErrorEntry* const e = history_.slot(t.d[0]);
    if (e == nullptr) return Fault::sub_index;
    if (t.d[1] != 0 || (t.dl == 3 && t.d[2] != 0)) return Fault::data;
    *e = {};
    reply.d = {t.d[0], 0, 0, 0, 0, 0, 0, 0};
    reply.dl = 6;
    return Fault::none;
}

}  // namespace axisgate::uim342::twin
