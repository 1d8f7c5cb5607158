// Plans of parameters, of objects by their numbers, and of the family's actions.
#include <fmt/core.h>

#include <charconv>

#include "adapters/cia402/drive_node.hpp"
#include "adapters/cia402/drive_plans.hpp"

namespace axisgate::cia402_drive {

std::string plan_parameter(const Node& node, std::size_t axis, Job& job, Reason& reason) {
    const auto* read = std::get_if<ReadParameter>(&job.command.body);
    const auto* to = std::get_if<WriteParameter>(&job.command.body);
    const Point point = read ? read->point : to->point;
    reason = Reason::unknown_point;
    const Parameter* p = node.catalogue().parameter(point);
    const auto place = p ? place_of(*p, point, static_cast<int>(axis), node.places) : std::nullopt;
    if (!place) return "no object of the drive";
    if (read) return job.steps.push_back({Step::Kind::read, *place, {}}), "";
    const auto type = type_of(p->type);
    auto bytes = type ? canopen::encode(*type, to->value) : std::nullopt;
    reason = Reason::out_of_range;
    if (!bytes) return fmt::format("{}: {} is no value of its type", p->id, to_text(to->value));
    job.steps.push_back({Step::Kind::write, *place, std::move(*bytes)});
    return {};
}

namespace {
bool hex(std::string_view text, unsigned& n) {
    const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), n, 16);
    return ec == std::errc{} && p == text.data() + text.size();
}
/// "6064:00" at the beginning of a longer text.
std::optional<Address> address_in(std::string_view s) {
    unsigned index = 0, sub = 0;
    if (s.size() < 8 || s[4] != ':' || !hex(s.substr(0, 4), index) || !hex(s.substr(5, 2), sub)) return std::nullopt;
    return Address{static_cast<std::uint16_t>(index), static_cast<std::uint8_t>(sub)};
}
}  // namespace

std::optional<ObjectWrite> object_write(const Catalogue& catalogue, std::string_view s) {
    const auto a = address_in(s);
    if (!a || s[7] != '=' || s.size() > 300) return std::nullopt;
    const std::string_view text = s.substr(8);
    std::vector<std::uint8_t> bytes;
    if (text.starts_with('x')) {
        for (std::size_t i = 1; i < text.size(); i += 2) {
            unsigned b = 0;
            if (i + 2 > text.size() || !hex(text.substr(i, 2), b)) return std::nullopt;
            bytes.push_back(static_cast<std::uint8_t>(b));
        }
    } else {
        const Parameter* p = parameter_at(catalogue, *a);
        const auto value = p ? parse_value(text, p->type) : std::nullopt;
        auto encoded = value ? canopen::encode(*type_of(p->type), *value) : std::nullopt;
        if (!encoded) return std::nullopt;
        bytes = std::move(*encoded);
    }
    if (bytes.empty()) return std::nullopt;
    return ObjectWrite{*a, std::move(bytes)};
}

/// "6064:00?", "6081:00=20000" where the catalogue has the type, "2100:01=x01FF" in bytes, in the order on the bus.
std::string plan_native(const Node& node, Job& job, const Native& native, Reason& reason) {
    const std::string_view s(reinterpret_cast<const char*>(native.send.data()), native.send.size());
    if (const auto a = address_in(s); a && s[7] == '?' && s.size() == 8) {
        job.read(*a);
        job.steps.back().literal = true;
        return {};
    }
    auto write = object_write(node.catalogue(), s);
    reason = Reason::out_of_range;
    if (!write) return "write 6064:00? to read an object, 6081:00=20000 to write one of the catalogue, 2100:01=x01FF for bytes of any";
    job.steps.push_back({Step::Kind::write, write->address, std::move(write->bytes)});
    job.steps.back().literal = true;
    return {};
}

std::string plan_action(const Node& node, const AxisKnown& known, Job& job, const Action& action, Instant now, Reason& reason) {
    static constexpr std::pair<std::string_view, canopen::NmtCommand> commands[] = {
        {"nmt_start", canopen::NmtCommand::start},
        {"nmt_reset_node", canopen::NmtCommand::reset_node},
        {"nmt_reset_communication", canopen::NmtCommand::reset_communication}};
    const bool is_known = node.catalogue().command(action.name) != nullptr;
    if (!is_known) return fmt::format("a {} has no {}", node.dialect.noun, action.name);
    reason = Reason::out_of_range;
    if (!action.argument.empty()) return action.name + " takes no argument";
    if (action.name == "store_parameters") {
        const Duration between = node.dialect.between_stores;
        reason = Reason::busy;
        if (node.stored_at && now < *node.stored_at + between)
            return fmt::format("its EPROM wears out: stored {} s ago, wait until {} s have passed between two",
                               milliseconds_of(now - *node.stored_at) / 1000, milliseconds_of(between) / 1000);
        return job.write(object::store, 0x65766173, 4), "";
    }
    if (action.name == "restore_defaults") return job.write(object::restore, 0x64616F6C, 4), "";
    for (const auto& [name, command] : commands) {
        if (name != action.name) continue;
        reason = Reason::wrong_state;
        if (command != canopen::NmtCommand::start && known.fb.moving) return "the axis moves: stop it first";
        Step s;
        s.kind = Step::Kind::nmt;
        s.nmt = command;
        job.steps.push_back(s);
        return {};
    }
    reason = Reason::not_supported;
    return action.name + " cannot be done on this line";
}

}  // namespace axisgate::cia402_drive
