// Wire of the UIM342: packing and unpacking, and the fixed words of its codes.
// In: identifier bits and data bytes. Out: message members, names of codes. Little-endian throughout, as the manual's examples are.
// Never trusts a length: a byte that DL does not cover is not read.
#include "adapters/uim342/wire.hpp"

#include <algorithm>

namespace axisgate::uim342 {

Message message(std::uint8_t id, std::uint8_t cw, std::span<const std::uint8_t> data) noexcept {
    Message m;
    m.id = id;
    m.cw = cw;
    m.dl = static_cast<std::uint8_t>(std::min<std::size_t>(data.size(), m.d.size()));
    std::copy_n(data.begin(), m.dl, m.d.begin());
    return m;
}

std::uint16_t get_u16(const std::uint8_t* p) noexcept { return static_cast<std::uint16_t>(p[0] | p[1] << 8); }
std::uint32_t get_u32(const std::uint8_t* p) noexcept {
    return p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16 | std::uint32_t{p[3]} << 24;
}
std::int32_t get_i32(const std::uint8_t* p) noexcept { return static_cast<std::int32_t>(get_u32(p)); }
std::int32_t get_i24(const std::uint8_t* p) noexcept {
    const std::uint32_t v = p[0] | std::uint32_t{p[1]} << 8 | std::uint32_t{p[2]} << 16;
    return static_cast<std::int32_t>(v & 0x80'0000u ? v | 0xFF00'0000u : v);
}
void put_u16(std::uint8_t* p, std::uint16_t v) noexcept {
    p[0] = static_cast<std::uint8_t>(v);
    p[1] = static_cast<std::uint8_t>(v >> 8);
}
void put_u32(std::uint8_t* p, std::uint32_t v) noexcept {
    put_u16(p, static_cast<std::uint16_t>(v));
    put_u16(p + 2, static_cast<std::uint16_t>(v >> 16));
}

Frame to_can(const Message& m, std::uint8_t producer) noexcept { return Frame::can_extended(can_id(producer, m.id, m.cw), m.data()); }

std::optional<CanMessage> from_can(const Frame& f) noexcept {
    if (f.kind != Frame::Kind::can || !f.extended || f.remote || f.size > 8 || (f.id & can_id_reserved) != 0) return std::nullopt;
    CanMessage m;
    m.producer = producer_of(f.id);
    m.consumer = consumer_of(f.id);
    m.message = message(m.producer, static_cast<std::uint8_t>(f.id), f.data());
    return m;
}

Status status_of(const Message& ms0) noexcept {
    Status s;
    const std::uint8_t a = ms0.d[1], b = ms0.d[2];
    s.mode = a & 0x03;
    s.on = a & 0x04;
    s.in1 = a & 0x08;
    s.in2 = a & 0x10;
    s.in3 = a & 0x20;
    s.op1 = a & 0x40;
    s.stop = b & 0x01;
    s.paif = b & 0x02;
    s.tlif = b & 0x08;
    s.lock = b & 0x20;
    s.err = b & 0x80;
    s.relative_position = get_i32(&ms0.d[4]);
    s.raw = a | std::uint32_t{b} << 8 | std::uint32_t{ms0.d[3]} << 16;
    return s;
}

Notification notification_of(const Message& rt) noexcept {
    Notification n;
    if (rt.dl == 0) return n;
    const std::uint8_t d0 = rt.d[0];
    n.code = d0;
    if (d0 == 0x00) {
        if (rt.dl < 2) return n;
        n.kind = Notification::Kind::alarm;
        n.code = rt.d[1];
    } else if (d0 <= 0x06) {
        n.kind = Notification::Kind::input;
        n.input = static_cast<std::uint8_t>((d0 + 1) / 2);
        n.rising = d0 % 2 == 0;
    } else if (d0 == 0x29) {
        n.kind = Notification::Kind::finished;
        n.has_position = rt.dl == 8;
        if (n.has_position) n.position = get_i32(&rt.d[4]);
    }
    return n;
}

bool error_known(std::uint8_t code) noexcept {
    return code == 0x32 || code == 0x33 || code == 0x34 || (code >= 0x3C && code <= 0x3F) || code == 0x41;
}

std::string_view error_text(std::uint8_t code) noexcept {
    switch (code) {
        case 0x00:
            return "no error";
        case 0x32:
            return "syntax error";
        case 0x33:
            return "data error";
        case 0x34:
            return "sub-index error";
        case 0x3C:
            return "SD is less than DC";
        case 0x3D:
            return "not allowed while the motor runs";
        case 0x3E:
            return "BG is not allowed while the driver is off";
        case 0x3F:
            return "BG is not allowed during an emergency stop";
        case 0x41:
            return "OG is not allowed while the motor runs";
        default:
            return "an error that the manual does not name";
    }
}

std::string_view alarm_text(std::uint8_t code) noexcept {
    switch (code) {
        case 0x0A:
            return "emergency stop and lock";
        case 0x19:
            return "speed over its limit";
        case 0x1A:
            return "below the lower working limit";
        case 0x1B:
            return "above the upper working limit";
        case 0x1D:
            return "motor stall";
        case 0x1E:
            return "encoder error";
        case 0x1F:
            return "encoder battery low";
        default:
            return {};
    }
}

Model model_of(const Message& ml) noexcept {
    if (ml.dl < 3) return {};
    const std::uint8_t a = ml.d[0], b = ml.d[1], c = ml.d[2];
    if (a == 0x20 && b == 0x0A && c == 0x11) return {"UIM342XS"};
    if (a == 0x21 && b == 0x0A && c == 0x11) return {"UIM342S"};
    if (a == 0x22 && c == 0x13) {
        if (b == 0x14) return {"UIM342C02"};
        if (b == 0x28) return {"UIM342C04"};
        if (b == 0x50) return {"UIM342C08"};
    }
    if (a == 0x22 && b == 0x50 && c == 0x19) return {"UIM342H08"};
    // Gateways by the second byte, as public programs list them.
    if (a == 0x19) {
        switch (b) {
            case 0x0D:
                return {"UIM2513", true};
            case 0x16:
                return {"UIM2522", true};
            case 0x17:
                return {"UIM2523", true};
            case 0x21:
                return {"UIM2533", true};
            default:
                break;
        }
    }
    if (a == 0x5A) return {"MMC90x", true};
    return {};
}

}  // namespace axisgate::uim342
