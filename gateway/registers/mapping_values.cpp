// Converts between the value of a point and its registers. A whole number that fits is never rounded.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace {

/// Writes `size` registers of `bits`, the highest first or last; each register is big-endian.
void put(std::uint64_t bits, std::size_t registers, MapWordOrder order, std::uint8_t* out) noexcept {
    for (std::size_t i = 0; i < registers; ++i) {
        const std::size_t from_top = order == MapWordOrder::high_first ? i : registers - 1 - i;
        const auto word = static_cast<std::uint16_t>(bits >> (16 * (registers - 1 - from_top)));
        out[2 * i] = static_cast<std::uint8_t>(word >> 8);
        out[2 * i + 1] = static_cast<std::uint8_t>(word);
    }
}
std::uint64_t get(const std::uint8_t* in, std::size_t registers, MapWordOrder order) noexcept {
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < registers; ++i) {
        const std::size_t from = order == MapWordOrder::high_first ? i : registers - 1 - i;
        bits = bits << 16 | static_cast<std::uint64_t>(in[2 * from] << 8 | in[2 * from + 1]);
    }
    return bits;
}

struct Whole {
    std::int64_t min;
    std::int64_t max;
    std::size_t registers;
};
/// u64 is limited by the type Value: 0..2^63-1.
std::optional<Whole> whole_of(MapType t) noexcept {
    switch (t) {
        case MapType::boolean:
            return Whole{0, 1, 1};
        case MapType::u16:
            return Whole{0, 0xFFFF, 1};
        case MapType::i16:
            return Whole{-0x8000, 0x7FFF, 1};
        case MapType::u32:
            return Whole{0, 0xFFFF'FFFF, 2};
        case MapType::i32:
            return Whole{-0x8000'0000LL, 0x7FFF'FFFF, 2};
        case MapType::u64:
            return Whole{0, std::numeric_limits<std::int64_t>::max(), 4};
        case MapType::i64:
            return Whole{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max(), 4};
        default:
            return std::nullopt;
    }
}

/// The registers for a number that the type cannot show: the nearest end of the range, or the mark. NaN has no nearest end.
void put_unfit(const Mapping& m, double wanted, std::uint8_t* out) noexcept {
    const bool clamped = m.on_overflow == MapOverflow::clamp && !std::isnan(wanted);
    if (m.type == MapType::f32) {
        const float end = std::copysign(std::numeric_limits<float>::max(), wanted < 0 ? -1.0F : 1.0F);
        put(std::bit_cast<std::uint32_t>(clamped ? end : std::numeric_limits<float>::quiet_NaN()), 2, m.word_order, out);
    } else if (m.type == MapType::f64) {
        const double end = std::copysign(std::numeric_limits<double>::max(), wanted < 0 ? -1.0 : 1.0);
        put(std::bit_cast<std::uint64_t>(clamped ? end : std::numeric_limits<double>::quiet_NaN()), 4, m.word_order, out);
    } else if (const auto whole = whole_of(m.type)) {
        std::uint64_t bits = static_cast<std::uint64_t>(wanted < 0 ? whole->min : whole->max);
        if (!clamped) bits = m.type == MapType::boolean ? 0 : whole->min < 0 ? static_cast<std::uint64_t>(whole->min) : ~std::uint64_t{0};
        put(bits, whole->registers, m.word_order, out);
    }
}

}  // namespace

bool encode(const Mapping& m, const Value& value, std::uint8_t* out) noexcept {
    if (m.type == MapType::string) {
        const auto* text = std::get_if<std::string>(&value);
        const std::size_t room = 2u * m.length;
        std::memset(out, 0, room);
        if (!text) return false;
        std::memcpy(out, text->data(), std::min(text->size(), room));  // a longer text is cut at its end
        return true;
    }
    const bool plain = m.scale == 1 && m.offset == 0;
    const auto unfit = [&](double wanted) {
        put_unfit(m, wanted, out);
        return false;
    };
    if (const auto whole = whole_of(m.type)) {
        std::int64_t n = 0;
        if (const auto exact = as_integer(value); exact && plain) {
            n = *exact;
        } else if (const auto x = as_number(value)) {
            const double y = std::round(*x * m.scale + m.offset);
            if (!(std::fabs(y) < 9.2e18)) return unfit(y);
            n = static_cast<std::int64_t>(y);
        } else {
            return unfit(std::numeric_limits<double>::quiet_NaN());
        }
        if (m.type == MapType::boolean) n = n != 0;
        if (n < whole->min || n > whole->max) return unfit(static_cast<double>(n));
        put(static_cast<std::uint64_t>(n), whole->registers, m.word_order, out);
        return true;
    }
    const auto x = as_number(value);
    if (!x) return unfit(std::numeric_limits<double>::quiet_NaN());
    const double y = *x * m.scale + m.offset;
    if (!std::isfinite(y)) return unfit(y);
    if (m.type == MapType::f64) {
        put(std::bit_cast<std::uint64_t>(y), 4, m.word_order, out);
        return true;
    }
    if (std::fabs(y) > static_cast<double>(std::numeric_limits<float>::max())) return unfit(y);
    put(std::bit_cast<std::uint32_t>(static_cast<float>(y)), 2, m.word_order, out);
    return true;
}

Value decode(const Mapping& m, const std::uint8_t* in) {
    if (m.type == MapType::string) {
        const auto* begin = reinterpret_cast<const char*>(in);
        const std::size_t room = 2u * m.length;
        return std::string(begin, std::find(begin, begin + room, '\0'));
    }
    double y = 0;
    if (const auto whole = whole_of(m.type)) {
        std::uint64_t bits = get(in, whole->registers, m.word_order);
        const unsigned spare = static_cast<unsigned>(64 - 16 * whole->registers);
        if (m.type == MapType::boolean) return bits != 0;
        std::int64_t n = static_cast<std::int64_t>(bits);
        if (whole->min < 0 && spare > 0) n = static_cast<std::int64_t>(bits << spare) >> spare;
        if (m.type == MapType::u64 && n < 0) return {};
        if (m.scale == 1 && m.offset == 0) return n;
        y = static_cast<double>(n);
    } else if (m.type == MapType::f32) {
        y = static_cast<double>(std::bit_cast<float>(static_cast<std::uint32_t>(get(in, 2, m.word_order))));
    } else {
        y = std::bit_cast<double>(get(in, 4, m.word_order));
    }
    if (!std::isfinite(y)) return {};
    const double x = (y - m.offset) / m.scale;
    // If the value is a whole number except for the arithmetic of the scale, it is treated as one.
    const double nearest = std::round(x);
    if (std::fabs(nearest) < 9e15 && std::fabs(x - nearest) <= 1e-9 * std::max(1.0, std::fabs(x)))
        return static_cast<std::int64_t>(nearest);
    return x;
}

}  // namespace axisgate
