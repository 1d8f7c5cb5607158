// The frames that a CANopen node may plausibly send, and a check of the frames that an adapter may send, for the fuzz programs of all
// CANopen families.
#pragma once

#include <string>
#include <vector>

#include "adapters/cia402/wire.hpp"
#include "tests/fuzz/adapter_laws.hpp"

namespace axisgate::cia402_drive::fuzz {

inline std::string wrong_frame(const Frame& f, LineKind, const std::vector<std::string>& configured) {
    if (f.kind != Frame::Kind::can || f.extended || f.remote) return "no data frame with 11 bits";
    if (f.id == canopen::sync_id) return f.size == 0 ? "" : "a SYNC with data";
    const auto role = canopen::role_of(f.id);
    const unsigned node = role.service == canopen::Service::nmt && f.size == 2 ? f.storage[1] : role.node;
    if (std::ranges::find(configured, std::to_string(node)) == configured.end()) return "to a node that the site does not name";
    const bool to_node = role.service == canopen::Service::nmt || role.service == canopen::Service::sdo_request ||
                         role.service == canopen::Service::receive_pdo;
    return to_node ? "" : "what only a node sends";
}

inline Frame plausible(FuzzedDataProvider& in, LineKind, const std::vector<std::string>& addresses) {
    const auto node = static_cast<std::uint32_t>(std::stoi(addresses[in.ConsumeIntegralInRange<std::size_t>(0, addresses.size() - 1)]));
    const std::uint32_t base = in.PickValueInArray({0x580u, 0x580u, 0x580u, 0x180u, 0x280u, 0x080u, 0x700u});
    std::vector<std::uint8_t> bytes = in.ConsumeBytes<std::uint8_t>(base == 0x180 ? 7 : base == 0x700 ? 1 : 8);
    if (base == 0x580 && bytes.size() == 8 && in.ConsumeBool()) {
        bytes[0] = in.PickValueInArray<std::uint8_t>({0x60, 0x43, 0x4B, 0x4F, 0x80, 0x41, 0x00, 0x20});
        const auto index = in.PickValueInArray<std::uint16_t>({0x1000, 0x1001, 0x1018, 0x6040, 0x6041, 0x606C, 0x603F, 0x6502, 0x6064});
        bytes[1] = static_cast<std::uint8_t>(index);
        bytes[2] = static_cast<std::uint8_t>(index >> 8);
        bytes[3] = 0;
    }
    return canopen::data_frame(base + node, bytes);
}

/// `family` names the adapter; it has the nodes 5, 6 and 127.
inline int run(const char* family, const std::uint8_t* data, std::size_t size) {
    if (size < 4 || size > 16 * 1024) return 0;
    FuzzedDataProvider in(data, size);
    const FamilyEntry entry = axisgate::fuzz::families().find(family);
    const axisgate::fuzz::FamilyFrames frames{plausible, wrong_frame};
    axisgate::fuzz::run_adapter(entry, frames, in, {"5", "6", "127"});
    return 0;
}

}  // namespace axisgate::cia402_drive::fuzz
