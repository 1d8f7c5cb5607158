// Wire of the UIM342: packing and unpacking, and the fixed words of its codes.
// In: identifier bits and data bytes. Out: message members, names of codes. Little-endian throughout, as the manual's examples are.
// Never trusts a length: a byte that DL does not cover is not read.
#include "adapters/uim342/wire.hpp"

#include <algorithm>
#include <cstring>

namespace axisgate::uim342 {

Message message(std::uint8_t id, std::uint8_t cw, std::span<const std::uint8_t> data) noexcept {
    Message m;
    m.id = id;
    m.cw = cw;
    m.dl = static_cast<std::uint8_t>(std::min<std::size_t>(data.size(), m.d.size()));
    std::copy_n(data.begin(), m.dl, m.d.begin());
    return m;
}

/// All eight bytes at once, then those that DL does not cover are none: byte by byte, the processor waits for its own stores.
static std::array<std::uint8_t, 8> data_of(const Frame& f) noexcept {
    static constexpr auto covered = [] {
        std::array<std::array<std::uint8_t, 8>, 9> by_length{};
        for (std::size_t n = 0; n <= 8; ++n)
            std::fill_n(by_length[n].begin(), n, std::uint8_t{0xFF});
        return by_length;
    }();
    std::uint64_t bytes = 0, mask = 0;
    std::memcpy(&bytes, f.storage.data(), sizeof bytes);
    std::memcpy(&mask, covered[f.size].data(), sizeof mask);
    bytes &= mask;
    std::array<std::uint8_t, 8> d;
    std::memcpy(d.data(), &bytes, sizeof bytes);
    return d;
}

std::uint64_t get_uint(const std::uint8_t* p, unsigned width) noexcept {
    std::uint64_t v = 0;
    for (unsigned i = 0; i < width; ++i)
        v |= std::uint64_t{p[i]} << (8 * i);
    return v;
}
std::uint16_t get_u16(const std::uint8_t* p) noexcept { return static_cast<std::uint16_t>(get_uint(p, 2)); }
std::uint32_t get_u32(const std::uint8_t* p) noexcept { return static_cast<std::uint32_t>(get_uint(p, 4)); }
std::int32_t get_i32(const std::uint8_t* p) noexcept { return static_cast<std::int32_t>(get_u32(p)); }
std::int32_t get_i24(const std::uint8_t* p) noexcept { return static_cast<std::int32_t>(get_uint(p, 3) << 8) >> 8; }
void put_uint(std::uint8_t* p, unsigned width, std::uint64_t v) noexcept {
    for (unsigned i = 0; i < width; ++i)
        p[i] = static_cast<std::uint8_t>(v >> (8 * i));
}
void put_u16(std::uint8_t* p, std::uint16_t v) noexcept { put_uint(p, 2, v); }

Frame to_can(const Message& m, std::uint8_t producer) noexcept { return Frame::can_extended(can_id(producer, m.id, m.cw), m.data()); }

std::optional<CanMessage> from_can(const Frame& f) noexcept {
    if (f.kind != Frame::Kind::can || !f.extended || f.remote || f.size > 8 || (f.id & can_id_reserved) != 0) return std::nullopt;
    CanMessage m;
    m.producer = producer_of(f.id);
    m.consumer = consumer_of(f.id);
    m.message.id = m.producer;
    m.message.cw = static_cast<std::uint8_t>(f.id);
    m.message.dl = static_cast<std::uint8_t>(f.size);
    m.message.d = data_of(f);
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

namespace {
struct Word {
    std::uint8_t code;
    std::string_view text;
};
constexpr std::array error_words{
    Word{0x00, "no error"},
    Word{0x32, "syntax error"},
    Word{0x33, "data error"},
    Word{0x34, "sub-index error"},
    Word{0x3C, "SD is less than DC"},
    Word{0x3D, "not allowed while the motor runs"},
    Word{0x3E, "BG is not allowed while the driver is off"},
    Word{0x3F, "BG is not allowed during an emergency stop"},
    Word{0x41, "OG is not allowed while the motor runs"},
};
constexpr std::array alarm_words{
    Word{0x0A, "emergency stop and lock"},       Word{0x19, "speed over its limit"}, Word{0x1A, "below the lower working limit"},
    Word{0x1B, "above the upper working limit"}, Word{0x1D, "motor stall"},          Word{0x1E, "encoder error"},
    Word{0x1F, "encoder battery low"},
};
std::string_view text_in(std::span<const Word> words, std::uint8_t code, std::string_view otherwise) noexcept {
    const auto w = std::ranges::find(words, code, &Word::code);
    return w == words.end() ? otherwise : w->text;
}

/// -1: whatever it is. Gateways by the second byte, as public programs list them.
struct ModelRow {
    int a, b, c;
    Model model;
};
constexpr std::array models{
    ModelRow{0x20, 0x0A, 0x11, {"UIM342XS"}},    ModelRow{0x21, 0x0A, 0x11, {"UIM342S"}},     ModelRow{0x22, 0x14, 0x13, {"UIM342C02"}},
    ModelRow{0x22, 0x28, 0x13, {"UIM342C04"}},   ModelRow{0x22, 0x50, 0x13, {"UIM342C08"}},   ModelRow{0x22, 0x50, 0x19, {"UIM342H08"}},
    ModelRow{0x19, 0x0D, -1, {"UIM2513", true}}, ModelRow{0x19, 0x16, -1, {"UIM2522", true}}, ModelRow{0x19, 0x17, -1, {"UIM2523", true}},
    ModelRow{0x19, 0x21, -1, {"UIM2533", true}}, ModelRow{0x5A, -1, -1, {"MMC90x", true}},
};
}  // namespace

std::string_view error_text(std::uint8_t code) noexcept { return text_in(error_words, code, "an error that the manual does not name"); }
std::string_view alarm_text(std::uint8_t code) noexcept { return text_in(alarm_words, code, {}); }

Model model_of(const Message& ml) noexcept {
    if (ml.dl < 3) return {};
    const auto is = [](int wanted, std::uint8_t byte) { return wanted < 0 || wanted == byte; };
    const auto row =
        std::ranges::find_if(models, [&](const ModelRow& r) { return is(r.a, ml.d[0]) && is(r.b, ml.d[1]) && is(r.c, ml.d[2]); });
    return row == models.end() ? Model{} : row->model;
}

}  // namespace axisgate::uim342
