// Value: one value of a parameter or point, in catalogue units, and the type that the catalogue gives it.
// In: numbers, booleans, texts. Out: the same, checked against a type and a range; text for people.
// Never scales or converts units: what a user wrote is what the drive gets, or the write is refused.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

namespace axisgate {

/// monostate: not known. Integers of every width travel as int64, floats as double, bytes as text of hex pairs.
using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

enum class ValueType : std::uint8_t { boolean, u8, i8, u16, i16, i24, u32, i32, i64, f32, f64, text, bytes };

[[nodiscard]] std::string_view name_of(ValueType type) noexcept;
[[nodiscard]] std::optional<ValueType> value_type_named(std::string_view name) noexcept;

[[nodiscard]] inline bool known(const Value& v) noexcept { return v.index() != 0; }

/// The value as an integer: booleans are 0 or 1, doubles only if they are whole and fit.
[[nodiscard]] std::optional<std::int64_t> as_integer(const Value& v) noexcept;
/// 0 and 1, and what reads as one of them.
[[nodiscard]] std::optional<bool> as_flag(const Value& v) noexcept;
/// The value as a double; nothing for texts and unknown values.
[[nodiscard]] std::optional<double> as_number(const Value& v) noexcept;
/// For people and logs: `true`, `-12`, `3.5`, the text itself, or `unknown`.
[[nodiscard]] std::string to_text(const Value& v);
/// Reads a value of the type from text (decimal, 0x hex, `true`); nothing if it is not one.
[[nodiscard]] std::optional<Value> parse_value(std::string_view text, ValueType type);
/// Smallest and largest value that an integer type can carry; nothing for floats, texts and bytes.
struct IntegerRange {
    std::int64_t min;
    std::int64_t max;
};
[[nodiscard]] std::optional<IntegerRange> range_of(ValueType type) noexcept;

}  // namespace axisgate
