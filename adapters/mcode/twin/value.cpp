// Values of MCode: integers stay integers where both operands are; everything else is worked out in doubles.
// In: operands. Out: results.
// Never undefined: overflow of 64 bits goes over to a double, and a shift or division that has no result gives none.
#include "adapters/mcode/twin/value.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

namespace axisgate::mcode::twin {

std::int64_t Number::as_integer() const noexcept {
    if (!real) return i;
    if (std::isnan(d)) return 0;
    constexpr double edge = 9.2e18;
    if (d >= edge) return std::numeric_limits<std::int64_t>::max();
    if (d <= -edge) return std::numeric_limits<std::int64_t>::min();
    return static_cast<std::int64_t>(d);
}

std::optional<Number> apply(Operator op, const Number& a, const Number& b, bool real) noexcept {
    const auto bits = [](const Number& n) { return static_cast<std::int32_t>(static_cast<std::uint32_t>(n.as_integer())); };
    switch (op) {
        case Operator::bit_and:
            return Number::of(bits(a) & bits(b));
        case Operator::bit_or:
            return Number::of(bits(a) | bits(b));
        case Operator::bit_xor:
            return Number::of(bits(a) ^ bits(b));
        default:
            break;
    }
    if (!real && !a.real && !b.real) {
        std::int64_t r = 0;
        switch (op) {
            case Operator::add:
                if (!__builtin_add_overflow(a.i, b.i, &r)) return Number::of(r);
                break;
            case Operator::subtract:
                if (!__builtin_sub_overflow(a.i, b.i, &r)) return Number::of(r);
                break;
            case Operator::multiply:
                if (!__builtin_mul_overflow(a.i, b.i, &r)) return Number::of(r);
                break;
            default:
                if (b.i == 0) return std::nullopt;
                if (b.i != -1) return Number::of(a.i / b.i);
                if (a.i != std::numeric_limits<std::int64_t>::min()) return Number::of(-a.i);
                break;
        }
    }
    const double x = a.as_double();
    const double y = b.as_double();
    switch (op) {
        case Operator::add:
            return Number::of_real(x + y);
        case Operator::subtract:
            return Number::of_real(x - y);
        case Operator::multiply:
            return Number::of_real(x * y);
        default:
            if (y == 0) return std::nullopt;
            return Number::of_real(x / y);
    }
}

std::string to_text(const Number& n, const PrintFormat& format) {
    if (!n.real) return (format.sign_blank && n.i >= 0 ? " " : "") + std::to_string(n.i);
    // 309 digits before the point and 16 after it is the longest.
    std::array<char, 352> buffer{};
    const int size = format.scientific ? std::snprintf(buffer.data(), buffer.size(), "%.*E", format.decimals, n.d)
                                       : std::snprintf(buffer.data(), buffer.size(), "%.*f", format.decimals, n.d);
    std::string s(buffer.data(), static_cast<std::size_t>(size < 0 ? 0 : size));
    const auto width = static_cast<std::size_t>(format.width);
    if (format.pad && s.size() < width) s.insert(format.left ? s.size() : 0, width - s.size(), ' ');
    return s;
}

}  // namespace axisgate::mcode::twin
