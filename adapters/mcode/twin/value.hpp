// Values of MCode: 32-bit integers and doubles, the operators between them and how they are printed.
// In: operands, an operator, a print format. Out: a value, or nothing where there is none (division by zero); digits.
// Never raises an error code: that is the statement's.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace axisgate::mcode::twin {

/// An integer (carried in 64 bits, checked at the write) or a double. Only F registers and numbers with a point are doubles.
struct Number {
    bool real = false;
    std::int64_t i = 0;
    double d = 0;

    static constexpr Number of(std::int64_t v) noexcept { return {false, v, 0}; }
    static constexpr Number of_real(double v) noexcept { return {true, 0, v}; }
    [[nodiscard]] constexpr double as_double() const noexcept { return real ? d : static_cast<double>(i); }
    /// The fraction is dropped, toward zero [L1249, L2813]; beyond 64 bits the nearest end, not-a-number 0.
    [[nodiscard]] std::int64_t as_integer() const noexcept;
    [[nodiscard]] bool truth() const noexcept { return real ? d != 0 : i != 0; }
};

enum class Operator : std::uint8_t { add, subtract, multiply, divide, bit_and, bit_or, bit_xor };

/// `a op b`. `real`: the target is an F register, so that 30/25 is 1.2 [L6281-6355]; else integers stay integers, and their quotient is
/// cut toward zero. Bit operators work on 32-bit integers. Nothing: division by zero.
[[nodiscard]] std::optional<Number> apply(Operator op, const Number& a, const Number& b, bool real) noexcept;

/// PF: width 0..16, decimals, notation 1 scientific, justify 1 left [L4744-4768].
struct PrintFormat {
    int width = 10;
    int decimals = 6;
    bool scientific = false;
    bool left = false;
    bool pad = false;         ///< of the model: see to_text
    bool sign_blank = false;  ///< of the model: a whole number from 0 on has a blank where others have their sign
    auto operator<=>(const PrintFormat&) const = default;
};
/// Digits of a value: integers plain, doubles by `format`. The width is kept and never cuts, nor pads unless the model is made so
/// (E-12): every printed reply of the manual is unpadded.
[[nodiscard]] std::string to_text(const Number& n, const PrintFormat& format);

}  // namespace axisgate::mcode::twin
