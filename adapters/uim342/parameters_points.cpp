// Points: reading the `wire` keys, and cutting values out of answers.
// In: the catalogue, answers. Out: bindings; values with the sign and width that the binding says.
// Never invents a binding: a parameter without a known control word stays unbound and is refused by name.
#include "adapters/uim342/parameters_points.hpp"

#include <fmt/format.h>

#include <charconv>
#include <string>

namespace axisgate::uim342 {
namespace {
/// A key as a number, written as a number or as text ("0x19").
std::optional<std::int64_t> key(const boost::json::object& o, std::string_view name) {
    const auto* v = o.if_contains(name);
    if (!v) return std::nullopt;
    if (v->is_int64()) return v->get_int64();
    if (v->is_uint64()) return static_cast<std::int64_t>(v->get_uint64());
    if (v->is_string()) {
        if (const auto parsed = parse_value({v->get_string().data(), v->get_string().size()}, ValueType::i64)) return as_integer(*parsed);
    }
    return std::nullopt;
}

std::uint8_t small(const boost::json::object& o, std::string_view name, std::uint8_t otherwise) {
    const auto v = key(o, name);
    return v && *v >= 0 && *v <= 255 ? static_cast<std::uint8_t>(*v) : otherwise;
}

bool is_signed(ValueType t) {
    return t == ValueType::i8 || t == ValueType::i16 || t == ValueType::i24 || t == ValueType::i32 || t == ValueType::i64;
}
}  // namespace

Points::Points(const Catalogue& catalogue) : catalogue_(&catalogue) {
    const auto parameters = catalogue.parameters();
    first_.assign(parameters.size(), 0xFFFF);
    for (std::size_t p = 0; p < parameters.size(); ++p) {
        const Parameter& parameter = parameters[p];
        const auto cw = key(parameter.wire, "cw");
        const Instruction* i = cw && *cw >= 0 && *cw <= 0xFF ? instruction(static_cast<std::uint8_t>(*cw)) : nullptr;
        if (!i) continue;
        first_[p] = static_cast<std::uint16_t>(bindings_.size());
        const std::uint16_t n = parameter.count == 0 ? 1 : parameter.count;
        for (std::uint16_t e = 0; e < n; ++e) {
            Binding b;
            const auto element = static_cast<std::uint16_t>(parameter.count == 0 ? 0 : parameter.first + e);
            b.point = {static_cast<std::uint16_t>(p), element};
            b.instruction = i;
            b.index = small(parameter.wire, "index", static_cast<std::uint8_t>(element));
            b.mf = small(parameter.wire, "mf", 0);
            b.byte = small(parameter.wire, "byte", 0);
            b.bytes = small(parameter.wire, "bytes", 0);
            b.bit = small(parameter.wire, "bit", 0);
            b.bits = small(parameter.wire, "bits", parameter.wire.contains("bit") ? 1 : 0);
            if (b.bytes == 0 && b.bits != 0) b.bytes = 1;
            b.part = b.bytes != 0 && b.byte + b.bytes <= 8;
            b.type = parameter.type;
            by_cw_[i->cw].push_back(static_cast<std::uint16_t>(bindings_.size()));
            bindings_.push_back(b);
        }
    }
}

const Binding* Points::binding(Point point) const noexcept {
    const Parameter* p = catalogue_->parameter(point);
    if (!p || first_[point.parameter] == 0xFFFF) return nullptr;
    return &bindings_[first_[point.parameter] + (p->count == 0 ? 0 : point.element - p->first)];
}

std::optional<Value> Points::value(const Binding& b, const Message& answer) {
    std::uint8_t at = 0, width = 0;
    if (b.part) {
        at = b.byte;
        width = b.bytes;
    } else {
        at = b.instruction->indexed ? 1 : 0;
        width = width_of(b.instruction->data);
        if (b.instruction->cw == cw::MS || width == 0) width = static_cast<std::uint8_t>(answer.dl > at ? answer.dl - at : 0);
    }
    if (width == 0 || at + width > answer.dl) return std::nullopt;
    const std::uint8_t* p = answer.d.data() + at;
    if (b.type == ValueType::text || b.type == ValueType::bytes) return Value{fmt::format("{:02X}", fmt::join(p, p + width, " "))};
    std::uint64_t raw = get_uint(p, width);
    unsigned bits = width * 8u;
    if (b.bits != 0) {
        raw >>= b.bit;
        bits = b.bits;
    }
    if (bits < 64) raw &= (std::uint64_t{1} << bits) - 1;
    auto v = static_cast<std::int64_t>(raw);
    if (is_signed(b.type) && bits < 64 && (raw >> (bits - 1) & 1)) v = static_cast<std::int64_t>(raw | ~((std::uint64_t{1} << bits) - 1));
    if (b.type == ValueType::boolean) return Value{v != 0};
    return Value{v};
}

}  // namespace axisgate::uim342
