// CANopen messages: which identifier belongs to which service of which node (CiA 301, predefined connection set), and how frames are made.
// The meaning of the bytes is in the file of each service. Identifiers that were assigned to a node otherwise (PDOs) are known to its
// owner only.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "gateway/core/frame.hpp"

namespace axisgate::canopen {

inline constexpr std::uint8_t first_node = 1, last_node = 127;
inline constexpr std::uint16_t nmt_id = 0x000, sync_id = 0x080, emergency_base = 0x080, time_id = 0x100, sdo_answer_base = 0x580,
                               sdo_request_base = 0x600, error_control_base = 0x700;

/// Index and subindex of an entry in an object dictionary. Ordered by index, then subindex.
struct Address {
    std::uint16_t index = 0;
    std::uint8_t sub = 0;
    auto operator<=>(const Address&) const = default;
};
/// "6040h:00".
[[nodiscard]] std::string to_text(Address address);

enum class Service : std::uint8_t { nmt, sync, emergency, time, transmit_pdo, receive_pdo, sdo_answer, sdo_request, error_control, other };
[[nodiscard]] std::string_view name_of(Service service) noexcept;

/// The service and node of an identifier, unless it has been reassigned.
struct Role {
    Service service = Service::other;
    std::uint8_t node = 0;  ///< 1..127; 0 for nmt, sync, time and other
    std::uint8_t pdo = 0;   ///< 1..4 for PDOs, else 0
    bool operator==(const Role&) const = default;
};
[[nodiscard]] Role role_of(std::uint32_t id) noexcept;

/// A data frame with an 11-bit identifier. At most 8 bytes are used.
[[nodiscard]] Frame data_frame(std::uint32_t id, std::span<const std::uint8_t> data) noexcept;
/// A remote frame with an 11-bit identifier: node guarding, requested PDOs.
[[nodiscard]] Frame remote_frame(std::uint32_t id) noexcept;
/// Whether it is a CAN data frame with this 11-bit identifier.
[[nodiscard]] bool is_data(const Frame& frame, std::uint32_t id) noexcept;
[[nodiscard]] bool is_remote(const Frame& frame, std::uint32_t id) noexcept;

/// A little-endian number, as everywhere in CANopen. Reads as many bytes as there are, at most 8.
[[nodiscard]] std::uint64_t low_first(std::span<const std::uint8_t> bytes) noexcept;
void put_low_first(std::uint64_t value, std::span<std::uint8_t> into) noexcept;

}  // namespace axisgate::canopen
