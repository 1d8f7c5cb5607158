// Ranges of values are checked by command_arguments.hpp, not here.
#include "adapters/linmot/motion_commands.hpp"

#include <fmt/core.h>

namespace axisgate::linmot {
namespace {
std::size_t size_of(ValueType type) { return type == ValueType::i16 || type == ValueType::u16 ? 2 : 4; }
}  // namespace

Motions::Motions(const Catalogue& catalogue) {
    const auto* list = catalogue.document().if_contains("commands");
    if (!list || !list->is_array()) return;
    for (const auto& v : list->get_array()) {
        const auto& o = v.get_object();
        const auto* kind = o.if_contains("kind");
        const auto* wire = o.if_contains("wire");
        if (!kind || !kind->is_string() || kind->get_string() != "motion_command" || !wire || !wire->is_object()) continue;
        Motion m;
        m.command = catalogue.command(std::string_view(o.at("id").as_string()));
        m.header = static_cast<std::uint16_t>(wire->get_object().at("header").as_int64());
        const auto* inferred = o.if_contains("inferred");
        m.inferred = inferred && inferred->is_bool() && inferred->get_bool();
        m.anywhere = m.header <= 0x0080 && m.header != 0x0090;  // general commands except Master Homing
        by_header_.emplace(m.header, m);
    }
}

const Motion* Motions::named(std::string_view id_or_name) const noexcept {
    for (const auto& [header, m] : by_header_) {
        if (m.command->id == id_or_name || m.command->name == id_or_name) return &m;
    }
    return nullptr;
}
const Motion* Motions::of_header(std::uint16_t header) const noexcept {
    const auto it = by_header_.find(static_cast<std::uint16_t>(header & 0xFFF0));
    return it == by_header_.end() ? nullptr : &it->second;
}

std::vector<std::uint8_t> Motions::pack(const Motion& motion, std::uint8_t count, std::span<const Value> values) {
    std::vector<std::uint8_t> bytes;
    const auto add = [&](std::int64_t v, std::size_t n) {
        for (std::size_t i = 0; i < n; ++i)
            bytes.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(v) >> 8 * i));
    };
    add(motion.header | (count & 0x0F), 2);
    for (std::size_t i = 0; i < motion.command->arguments.size(); ++i) {
        add(i < values.size() ? as_integer(values[i]).value_or(0) : 0, size_of(motion.command->arguments[i].type));
    }
    return bytes;
}

std::optional<std::vector<Value>> Motions::unpack(const Motion& motion, std::span<const std::uint8_t> buffer) {
    std::vector<Value> values;
    std::size_t at = 2;
    for (const auto& a : motion.command->arguments) {
        const std::size_t n = size_of(a.type);
        if (at + n > buffer.size()) return std::nullopt;
        std::uint32_t raw = 0;
        for (std::size_t i = 0; i < n; ++i)
            raw |= std::uint32_t{buffer[at + i]} << 8 * i;
        at += n;
        std::int64_t v = raw;
        if (a.type == ValueType::i16) v = static_cast<std::int16_t>(raw);
        if (a.type == ValueType::i32) v = static_cast<std::int32_t>(raw);
        values.emplace_back(v);
    }
    return values;
}

std::string Motions::describe(std::span<const std::uint8_t> buffer) const {
    if (buffer.size() < 2) return "motion command without a header";
    const auto header = static_cast<std::uint16_t>(buffer[0] | buffer[1] << 8);
    const Motion* m = of_header(header);
    if (!m) return fmt::format("motion command {:04X}h, unknown", header);
    std::string text = fmt::format("{} ({}), count {}", m->command->name, m->command->id, header & 0x0F);
    const auto values = unpack(*m, buffer);
    if (!values) return text + ", bytes are missing";
    for (std::size_t i = 0; i < values->size(); ++i) {
        const auto& a = m->command->arguments[i];
        text += fmt::format("{} {} {:.10g}{}{}", i == 0 ? ":" : ",", a.name, static_cast<double>(*as_integer((*values)[i])) * a.scale,
                            a.unit.empty() ? "" : " ", a.unit);
    }
    return text + (m->inferred ? " [layout inferred]" : "");
}

}  // namespace axisgate::linmot
