// What commands of the twin carry: one integer or real, and how a real is written on the serial port.
// In: numbers, decimal text. Out: the same, by the manual's printed forms.
// Never includes the adapter's number code: it is the second reading of the manual.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::pacontrol::twin {

/// Command data or acknowledge data. `real` is TYP_PAR_2 / TYP_QUIT [L1149-1153]; integers of 32 bits fit the double exactly.
struct Datum {
    bool real = false;
    double value = 0;

    [[nodiscard]] static Datum integer(double v) noexcept { return {false, v}; }
    [[nodiscard]] static Datum number(double v) noexcept { return {true, v}; }
};

/// Largest integer of the wire: the manual gives +/-2147483647 [L2060].
inline constexpr double integer_limit = 2147483647.0;

/// The nearest integer, halves away from zero (E-61), held to 32 bits.
[[nodiscard]] std::int32_t whole(const Datum& d) noexcept;
/// The nearest single (IEEE 754); nothing if it does not fit.
[[nodiscard]] std::optional<float> single(const Datum& d) noexcept;

/// Forms in which the manual prints reals (E-06): `640.0000`, `640.000`, `640.0`.
enum class RealForm : std::uint8_t { seven_digits, three_decimals, shortest };

/// An integer in plain decimal; a real in fixed notation, by default with 7 significant digits, the sign extra: `640.0000`, `0.000000`.
[[nodiscard]] std::string to_wire(const Datum& d, RealForm form = RealForm::seven_digits);
/// Decimal text with an optional sign and, for reals, one point. Nothing for anything else, `1e5` and `nan` included. The stated type
/// decides: a fraction in an integer field is rounded (E-59).
[[nodiscard]] std::optional<Datum> from_wire(std::string_view text, bool real);

}  // namespace axisgate::pacontrol::twin
