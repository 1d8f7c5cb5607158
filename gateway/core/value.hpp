// One value of a parameter or point in catalogue units, with the type from the catalogue. Values are never scaled or converted: the drive
// gets the value that the user wrote, or the write is refused.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace axisgate {

/// monostate: unknown. Integers of every width are int64, floats are double, bytes are a text of hex pairs.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

enum class ValueType : std::uint8_t { boolean, u8, i8, u16, i16, i24, u32, i32, i64, f32, f64, text, bytes };

[[nodiscard]] std::string_view name_of(ValueType type) noexcept;
[[nodiscard]] std::optional<ValueType> value_type_named(std::string_view name) noexcept;

[[nodiscard]] inline bool known(const Value& v) noexcept { return v.index() != 0; }

/// The value as an integer: booleans are 0 or 1, doubles only if they are whole and fit.
[[nodiscard]] std::optional<std::int64_t> as_integer(const Value& v) noexcept;
/// 0 and 1, and values that convert to one of them.
[[nodiscard]] std::optional<bool> as_flag(const Value& v) noexcept;
/// The value as a double; empty for texts and unknown values.
[[nodiscard]] std::optional<double> as_number(const Value& v) noexcept;
/// For people and logs: `true`, `-12`, `3.5`, the text itself, or `unknown`.
[[nodiscard]] std::string to_text(const Value& v);
/// Reads a value of the type from text (decimal, 0x hex, `true`); empty if it is not one.
[[nodiscard]] std::optional<Value> parse_value(std::string_view text, ValueType type);
/// Smallest and largest value of an integer type; empty for floats, texts and bytes.
struct IntegerRange {
    std::int64_t min;
    std::int64_t max;
};
[[nodiscard]] std::optional<IntegerRange> range_of(ValueType type) noexcept;

}  // namespace axisgate
