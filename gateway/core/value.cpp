// Names of types, conversions, text. No conversion rounds silently.
#include "gateway/core/value.hpp"

#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace axisgate {
namespace {
struct TypeRow {
    ValueType type;
    std::string_view name;
};
constexpr std::array types{TypeRow{ValueType::boolean, "bool"}, TypeRow{ValueType::u8, "u8"},   TypeRow{ValueType::i8, "i8"},
                           TypeRow{ValueType::u16, "u16"},      TypeRow{ValueType::i16, "i16"}, TypeRow{ValueType::i24, "i24"},
                           TypeRow{ValueType::u32, "u32"},      TypeRow{ValueType::i32, "i32"}, TypeRow{ValueType::i64, "i64"},
                           TypeRow{ValueType::f32, "f32"},      TypeRow{ValueType::f64, "f64"}, TypeRow{ValueType::text, "text"},
                           TypeRow{ValueType::bytes, "bytes"}};
template <class... F>
struct Overload : F... {
    using F::operator()...;
};
template <class... F>
Overload(F...) -> Overload<F...>;
}  // namespace

std::string_view name_of(ValueType type) noexcept { return types[static_cast<std::size_t>(type)].name; }

std::optional<ValueType> value_type_named(std::string_view name) noexcept {
    for (const auto& row : types) {
        if (row.name == name) return row.type;
    }
    return std::nullopt;
}

std::optional<std::int64_t> as_integer(const Value& v) noexcept {
    if (const auto* i = std::get_if<std::int64_t>(&v)) return *i;
    if (const auto* b = std::get_if<bool>(&v)) return *b ? 1 : 0;
    if (const auto* d = std::get_if<double>(&v)) {
        if (std::isfinite(*d) && std::nearbyint(*d) == *d && std::fabs(*d) < 9.2e18) return static_cast<std::int64_t>(*d);
    }
    return std::nullopt;
}

std::optional<bool> as_flag(const Value& v) noexcept {
    const auto n = as_integer(v);
    if (!n || (*n != 0 && *n != 1)) return std::nullopt;
    return *n == 1;
}

std::optional<double> as_number(const Value& v) noexcept {
    if (const auto* d = std::get_if<double>(&v)) return *d;
    if (const auto i = as_integer(v)) return static_cast<double>(*i);
    return std::nullopt;
}

std::string to_text(const Value& v) {
    return std::visit(Overload{[](std::monostate) { return std::string("unknown"); },
                               [](bool b) { return std::string(b ? "true" : "false"); }, [](std::int64_t i) { return std::to_string(i); },
                               [](double d) { return fmt::format("{}", d); }, [](const std::string& s) { return s; }},
                      v);
}

std::optional<IntegerRange> range_of(ValueType type) noexcept {
    switch (type) {
        case ValueType::boolean:
            return IntegerRange{0, 1};
        case ValueType::u8:
            return IntegerRange{0, 0xFF};
        case ValueType::i8:
            return IntegerRange{-128, 127};
        case ValueType::u16:
            return IntegerRange{0, 0xFFFF};
        case ValueType::i16:
            return IntegerRange{-32768, 32767};
        case ValueType::i24:
            return IntegerRange{-8388608, 8388607};
        case ValueType::u32:
            return IntegerRange{0, 0xFFFFFFFFLL};
        case ValueType::i32:
            return IntegerRange{std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()};
        case ValueType::i64:
            return IntegerRange{std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()};
        default:
            return std::nullopt;
    }
}

std::optional<Value> parse_value(std::string_view text, ValueType type) {
    if (type == ValueType::text || type == ValueType::bytes) return Value{std::string(text)};
    if (type == ValueType::boolean) {
        if (text == "true" || text == "1") return Value{true};
        if (text == "false" || text == "0") return Value{false};
        return std::nullopt;
    }
    const char* const end = text.data() + text.size();
    if (type == ValueType::f32 || type == ValueType::f64) {
        double d = 0;
        const auto [p, ec] = std::from_chars(text.data(), end, d);
        if (ec != std::errc{} || p != end || !std::isfinite(d)) return std::nullopt;
        return Value{d};
    }
    std::int64_t i = 0;
    const bool hex = text.starts_with("0x") || text.starts_with("0X");
    const auto [p, ec] = std::from_chars(text.data() + (hex ? 2 : 0), end, i, hex ? 16 : 10);
    if (ec != std::errc{} || p != end) return std::nullopt;
    return Value{i};
}

}  // namespace axisgate
