#include "adapters/cia402/wire.hpp"

#include <charconv>

namespace axisgate::cia402_drive {

int node_of(std::string_view text) noexcept {
    int n = 0;
    const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), n);
    return ec == std::errc{} && p == text.data() + text.size() && n >= canopen::first_node && n <= canopen::last_node ? n : 0;
}
std::string check_address(std::string_view address) {
    return node_of(address) != 0 ? std::string() : "a CANopen drive has a node number from 1 to 127";
}

namespace {
canopen::Pdo pdo(canopen::PdoDirection direction, std::uint16_t number, std::uint32_t id, canopen::PdoMapping mapping) {
    canopen::Pdo p;
    p.direction = direction;
    p.number = number;
    p.settings.id = id;
    p.settings.valid = true;
    p.settings.transmission = 1;
    p.mapping = std::move(mapping);
    return p;
}
}  // namespace

canopen::Pdo status_pdo(std::uint8_t node, std::size_t axis, bool mode) {
    canopen::PdoMapping mapping{{of_axis(object::statusword, axis), 16}, {of_axis(object::position, axis), 32}};
    if (mode) mapping.push_back({of_axis(object::mode_shown, axis), 8});
    return pdo(canopen::PdoDirection::transmit, static_cast<std::uint16_t>(1 + 2 * axis),
               status_base + per_axis * static_cast<std::uint32_t>(axis) + node, std::move(mapping));
}
canopen::Pdo motion_pdo(std::uint8_t node, std::size_t axis, bool velocity, bool demand) {
    canopen::PdoMapping mapping;
    if (velocity) mapping.push_back({of_axis(object::velocity, axis), 32});
    if (demand) mapping.push_back({of_axis(object::demand, axis), 32});
    return pdo(canopen::PdoDirection::transmit, static_cast<std::uint16_t>(2 + 2 * axis),
               motion_base + per_axis * static_cast<std::uint32_t>(axis) + node, std::move(mapping));
}
canopen::Pdo target_pdo(std::uint8_t node, std::uint16_t number, bool interpolated) {
    const canopen::MappedEntry targets[] = {
        {interpolated ? object::interpolated_position : object::target_position, 32}, {{0x60FF, 0}, 32}, {{0x6071, 0}, 16}};
    return pdo(canopen::PdoDirection::receive, number, 0x100u + 0x100u * number + node, {targets[number - 1u]});
}

std::vector<std::uint8_t> bytes_of(std::int64_t value, std::size_t size) {
    std::vector<std::uint8_t> bytes(size);
    canopen::put_low_first(static_cast<std::uint64_t>(value), bytes);
    return bytes;
}
std::int64_t signed_of(std::span<const std::uint8_t> bytes) noexcept {
    if (bytes.empty() || bytes.size() > 8) return 0;
    return canopen::as_signed(canopen::low_first(bytes), static_cast<std::uint8_t>(8 * bytes.size()));
}

std::optional<Address> place_of(const Parameter& p, Point point, int axis, const Places& places) {
    const auto* index = p.wire.if_contains("index");
    const auto* sub = p.wire.if_contains("sub");
    if (!index || !sub) return std::nullopt;
    const auto number = sub->as_int64() + (p.count ? point.element - p.first : 0);
    auto at = index->as_int64();
    if (const auto moved = places.find(static_cast<std::uint16_t>(at)); moved != places.end()) at = moved->second;
    if (const auto* step = p.wire.if_contains("per_axis"); step && step->is_int64()) at += step->as_int64() * axis;
    return Address{static_cast<std::uint16_t>(at), static_cast<std::uint8_t>(number)};
}
Places moved_places(const std::map<std::string, std::string>& options) {
    constexpr std::string_view prefix = "object_";
    const auto number = [](std::string_view text, int base) {
        std::uint16_t n = 0;
        const auto [p, ec] = std::from_chars(text.data(), text.data() + text.size(), n, base);
        return ec == std::errc{} && p == text.data() + text.size() ? n : std::uint16_t{0};
    };
    Places out;
    for (const auto& [name, value] : options) {
        if (!name.starts_with(prefix)) continue;
        const auto from = number(std::string_view(name).substr(prefix.size()), 16), to = number(value, 10);
        if (from != 0 && to != 0) out[from] = to;
    }
    return out;
}
std::optional<canopen::DataType> type_of(ValueType type) noexcept {
    using canopen::DataType;
    switch (type) {
        case ValueType::boolean:
            return DataType::boolean;
        case ValueType::u8:
            return DataType::unsigned8;
        case ValueType::i8:
            return DataType::integer8;
        case ValueType::u16:
            return DataType::unsigned16;
        case ValueType::i16:
            return DataType::integer16;
        case ValueType::i24:
            return DataType::integer24;
        case ValueType::u32:
            return DataType::unsigned32;
        case ValueType::i32:
            return DataType::integer32;
        case ValueType::i64:
            return DataType::integer64;
        case ValueType::f32:
            return DataType::real32;
        case ValueType::f64:
            return DataType::real64;
        case ValueType::text:
            return DataType::visible_string;
        case ValueType::bytes:
            return DataType::octet_string;
    }
    return std::nullopt;
}
const Parameter* parameter_at(const Catalogue& catalogue, Address a) {
    for (const Parameter& p : catalogue.parameters()) {
        const auto first = place_of(p, {0, p.first});
        if (first && first->index == a.index && a.sub >= first->sub && a.sub < first->sub + std::max<int>(1, p.count)) return &p;
    }
    return nullptr;
}

}  // namespace axisgate::cia402_drive
