// Example of a sentence: "node 5: read 6064h:00 position_actual_value = 1500". Control characters are never shown.
#include "adapters/cia402/decoder.hpp"

#include <fmt/format.h>

#include "gateway/protocols/canopen/emergency.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/protocols/canopen/sdo.hpp"

namespace axisgate::cia402_drive {
namespace {
std::string hex_of(std::span<const std::uint8_t> bytes) { return fmt::format("{:02X}", fmt::join(bytes, " ")); }
}  // namespace

/// The catalogue entry of an object. It may belong to a further axis (then `axis` counts from 2): 6864h is 6064h of the second axis.
const Parameter* CanDecoder::entry(Address a, int& axis) const {
    axis = 1;
    if (const Parameter* p = parameter_at(catalogue_, a)) return p;
    axis = 2;
    if (a.index >= 0x6800 && a.index < 0x7000) return parameter_at(catalogue_, {static_cast<std::uint16_t>(a.index - 0x800), a.sub});
    const Parameter* p = parameter_at(catalogue_, {static_cast<std::uint16_t>(a.index - 1), a.sub});
    const auto* step = p ? p->wire.if_contains("per_axis") : nullptr;
    return step && step->is_int64() && step->as_int64() == 1 ? p : nullptr;
}
std::string CanDecoder::name(Address a) const {
    int axis = 1;
    const Parameter* p = entry(a, axis);
    return canopen::to_text(a) + (p                                       ? " " + p->name + (axis == 1 ? "" : " of axis 2")
                                  : a.index >= 0x1600 && a.index < 0x1800 ? " receive PDO mapping"
                                  : a.index >= 0x1A00 && a.index < 0x1C00 ? " transmit PDO mapping"
                                                                          : "");
}
std::string CanDecoder::value(Address a, std::span<const std::uint8_t> bytes) const {
    int axis = 1;
    const Parameter* p = entry(a, axis);
    const auto type = p ? type_of(p->type) : std::nullopt;
    if (type && *type != canopen::DataType::visible_string) {
        const auto size = canopen::bytes_of(*type);
        const auto v = size && bytes.size() >= *size ? canopen::decode(*type, bytes.first(*size)) : std::nullopt;
        if (v) return to_text(*v);
    }
    return bytes.size() <= 4 ? fmt::format("{:X}h", canopen::low_first(bytes)) : hex_of(bytes);
}

std::string CanDecoder::sdo(const Frame& f, std::uint8_t number, bool request) {
    if (f.size != 8) return fmt::format("node {}: an SDO message with {} bytes, not 8", number, f.size);
    Node& node = nodes_[number];
    const std::uint8_t c = f.storage[0];
    const unsigned kind = c >> 5;
    const auto a = canopen::address_of(f);
    const auto data = f.data().subspan(4, c & 2u ? 4u - (c & 1u ? c >> 2 & 3u : 0u) : 4u);
    if (kind == 4)
        return fmt::format("node {}: {} of {}: {}", number, request ? "abort" : "refusal", name(a),
                           canopen::to_text(static_cast<canopen::Abort>(canopen::value_of(f))));
    if (request ? kind == 1 : kind == 2) {
        if (request && (c & 2u)) {
            const std::uint16_t i = a.index;
            if ((i >= 0x1600 && i < 0x1800) || (i >= 0x1A00 && i < 0x1C00))
                node.maps[i][a.sub] = static_cast<std::uint32_t>(canopen::low_first(data));
        }
        node.asked = a;
        const std::string what = c & 2u   ? value(a, data)
                                 : c & 1u ? fmt::format("{} bytes follow", canopen::value_of(f))
                                          : std::string("bytes follow");
        return fmt::format("node {}: {} {} = {}", number, request ? "write" : "read", name(a), what);
    }
    if (request && kind == 2) return fmt::format("node {}: read {}?", number, name(node.asked = a));
    if (!request && kind == 3) return fmt::format("node {}: written {}", number, name(a));
    if (kind == 0 || (!request && kind == 1) || (request && kind == 3)) {
        const std::size_t n = kind == (request ? 0u : 0u) ? 7u - (c >> 1 & 7u) : 0u;
        return fmt::format("node {}: segment of {}{}", number, name(node.asked), n ? ": " + hex_of(f.data().subspan(1, n)) : "");
    }
    return fmt::format("node {}: block transfer of {}: {}", number, name(node.asked), hex_of(f.data()));
}

std::string CanDecoder::pdo(const Frame& f, const canopen::Role& role) {
    const bool receive = role.service == canopen::Service::receive_pdo;
    const std::string head = fmt::format("node {}: {} {}:", role.node, receive ? "RPDO" : "TPDO", role.pdo);
    const auto& maps = nodes_[role.node].maps;
    const auto it = maps.find(static_cast<std::uint16_t>((receive ? 0x1600 : 0x1A00) + role.pdo - 1));
    canopen::PdoMapping mapping;
    if (it != maps.end())
        for (std::uint8_t i = 1; it->second.contains(0) && i <= it->second.at(0) && it->second.contains(i); ++i)
            mapping.push_back(canopen::mapped_entry(it->second.at(i)));
    std::vector<std::uint64_t> values;
    if (mapping.empty() || canopen::unpack(mapping, f.data(), values) == canopen::PdoLength::shorter)
        return head + " " + hex_of(f.data()) + " (mapping not seen)";
    std::string text = head;
    for (std::size_t i = 0; i < mapping.size(); ++i) {
        int axis = 1;
        const Parameter* p = entry(mapping[i].address, axis);
        text +=
            fmt::format("{} {} = {}", i ? "," : "", p ? p->name + (axis == 1 ? "" : " of axis 2") : canopen::to_text(mapping[i].address),
                        value(mapping[i].address, bytes_of(static_cast<std::int64_t>(values[i]), mapping[i].bits / 8u)));
    }
    return text;
}

std::vector<std::string> CanDecoder::on_frame(const Frame& f, std::optional<bool>) {
    if (f.kind != Frame::Kind::can) return {"a report of the CAN controller"};
    if (f.extended) return {fmt::format("{:08X} unknown: 29 bits are no message of CANopen's connection set", f.id)};
    const auto role = canopen::role_of(f.id);
    if (f.remote) return {fmt::format("node {}: {} is asked for by a remote frame", role.node, canopen::name_of(role.service))};
    switch (role.service) {
        case canopen::Service::nmt:
            if (f.size == 2 && canopen::nmt_command_of(f.storage[0]))
                return {fmt::format("NMT: {} {}", canopen::name_of(*canopen::nmt_command_of(f.storage[0])),
                                    f.storage[1] ? fmt::format("node {}", f.storage[1]) : "all nodes")};
            return {"NMT: " + hex_of(f.data())};
        case canopen::Service::sync:
            return {f.size == 1 ? fmt::format("SYNC {}", f.storage[0]) : "SYNC"};
        case canopen::Service::time:
            return {"time stamp: " + hex_of(f.data())};
        case canopen::Service::emergency: {
            const auto e = canopen::emergency_of(f, role.node);
            return {fmt::format("node {}: EMCY {}", role.node, e ? canopen::to_text(*e) : hex_of(f.data()))};
        }
        case canopen::Service::error_control: {
            const auto state = f.size == 1 ? canopen::nmt_state_of(f.storage[0] & 0x7Fu) : std::nullopt;
            return {fmt::format("node {}: {}", role.node, state ? std::string(canopen::name_of(*state)) : hex_of(f.data()))};
        }
        case canopen::Service::sdo_request:
            return {sdo(f, role.node, true)};
        case canopen::Service::sdo_answer:
            return {sdo(f, role.node, false)};
        case canopen::Service::transmit_pdo:
        case canopen::Service::receive_pdo:
            return {pdo(f, role)};
        case canopen::Service::other:
            break;
    }
    return {fmt::format("{:03X} unknown: {} is no message of CANopen's connection set", f.id, hex_of(f.data()))};
}

}  // namespace axisgate::cia402_drive
