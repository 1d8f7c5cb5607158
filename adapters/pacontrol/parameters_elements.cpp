// Elements: reading the `wire` keys, building requests, reading values.
// In: the catalogue; points with values; acknowledgements. Out: requests; values, cut out of bytes and bits where a point is a part.
// Never invents a code: a parameter without one stays unbound, and is refused by name.
#include "adapters/pacontrol/parameters_elements.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {
const CommandInfo* code_key(const boost::json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    if (!v || !v->is_string()) return nullptr;
    const auto& s = v->get_string();
    std::uint16_t code = 0;
    const auto [p, ec] = std::from_chars(s.data(), s.data() + s.size(), code, 16);
    return ec == std::errc{} && p == s.data() + s.size() ? command_info(code) : nullptr;
}

template <class T>
std::optional<T> number_key(const boost::json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    if (!v || !v->is_number()) return std::nullopt;
    boost::system::error_code ec;
    const auto n = v->to_number<T>(ec);
    return ec ? std::nullopt : std::optional<T>(n);
}

std::uint32_t parameter_of(const CommandInfo& c, const Binding& b, Point point, int channel) {
    const auto axis = static_cast<std::uint32_t>(channel);
    switch (c.parameter) {
        case Takes::nothing:
            return 0;
        case Takes::axis:
        case Takes::axis_or_all:
            return axis;
        case Takes::axis_parameter:
            return axis << 8 | b.number.value_or(point.element);
        case Takes::system_parameter:
            return b.number.value_or(point.element);
        case Takes::element:
            break;
    }
    std::uint32_t n = b.array ? point.element : b.number.value_or(0);
    if (b.array && b.number) n += *b.number;  // views on a part of the elements: number is what comes before the first
    // Words are named by any element inside them [L2419, L2483]: the first one.
    if (c.data == Carries::word || c.answer == Carries::word) n = n == 0 ? 0 : (n - 1) * 16 + 1;
    if (!b.drive && !b.array) n = b.number.value_or(0) + axis;  // SM51..66 and the like: number is what comes before axis 1
    return n;
}
}  // namespace

Elements::Elements(const Catalogue& catalogue) {
    bindings_.reserve(catalogue.parameters().size());
    for (const Parameter& p : catalogue.parameters()) {
        Binding b;
        b.read = code_key(p.wire, "read");
        b.write = code_key(p.wire, "write");
        const auto* scope = p.wire.if_contains("scope");
        b.drive = scope && scope->is_string() && scope->get_string() == "drive";
        b.number = number_key<std::uint16_t>(p.wire, "number");
        b.byte = number_key<std::uint8_t>(p.wire, "byte");
        b.bit = number_key<std::uint8_t>(p.wire, "bit");
        b.type = p.type;
        b.array = p.count != 0;
        bindings_.push_back(b);
    }
}

const Binding* Elements::binding(Point point) const noexcept {
    return point.parameter < bindings_.size() ? &bindings_[point.parameter] : nullptr;
}

Request Elements::read(const Binding& b, Point point, int channel) {
    return request_for(b.read->code, parameter_of(*b.read, b, point, channel));  // reads of reals carry the type too [L1350-L1357]
}

Request Elements::write(const Binding& b, Point point, int channel, const Value& value) {
    const double v = as_number(value).value_or(0);
    return request_for(b.write->code, parameter_of(*b.write, b, point, channel),
                       b.write->data == Carries::real ? real_text(v) : std::to_string(std::llround(v)));
}

Value Elements::value(const Binding& b, const Reply& reply) {
    const double v = number_of(reply).value_or(0);
    if (b.type == ValueType::f32 || b.type == ValueType::f64) return Value{v};
    if (b.type == ValueType::text || b.type == ValueType::bytes) return Value{reply.data};
    std::int64_t n = std::fabs(v) < 9e15 ? std::llround(v) : 0;
    if (b.byte) n = static_cast<std::int64_t>(static_cast<std::uint64_t>(n) >> (24u - 8u * std::min<unsigned>(*b.byte, 3)) & 0xFFu);
    if (b.bit) n = static_cast<std::int64_t>(static_cast<std::uint64_t>(n) >> *b.bit & 1u);
    if (b.type == ValueType::boolean) return Value{n != 0};
    return Value{n};
}

}  // namespace axisgate::pacontrol
