// Node numbers, objects, PDOs and data types of a CiA 402 drive on CANopen. A type is never guessed: an object that the catalogue does not
// have has none. CANopen itself is in gateway/protocols/canopen.
#pragma once

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/protocols/canopen/pdo.hpp"
#include "gateway/protocols/canopen/sync_turns.hpp"

namespace axisgate::cia402_drive {
using canopen::Address;

/// 1..127; 0: the text is not a node number.
[[nodiscard]] int node_of(std::string_view address) noexcept;
/// Empty, or what a valid address would be.
[[nodiscard]] std::string check_address(std::string_view address);

namespace object {
inline constexpr Address device_type{0x1000, 0}, error_register{0x1001, 0}, watched_heartbeat{0x1016, 1}, heartbeat{0x1017, 0},
    vendor{0x1018, 1}, product{0x1018, 2}, revision{0x1018, 3}, store{0x1010, 1}, restore{0x1011, 1}, connection_lost_option{0x6007, 0},
    error_code{0x603F, 0}, controlword{0x6040, 0}, statusword{0x6041, 0}, quick_stop_option{0x605A, 0}, mode{0x6060, 0},
    mode_shown{0x6061, 0}, demand{0x6062, 0}, position{0x6064, 0}, velocity{0x606C, 0}, target_torque{0x6071, 0},
    target_position{0x607A, 0}, home_offset{0x607C, 0}, profile_velocity{0x6081, 0}, profile_acceleration{0x6083, 0},
    profile_deceleration{0x6084, 0}, quick_stop_deceleration{0x6085, 0}, position_min_limit{0x607D, 1}, position_max_limit{0x607D, 2},
    homing_method{0x6098, 0}, interpolated_position{0x60C1, 1}, cycle{0x60C2, 1}, cycle_index{0x60C2, 2}, target_velocity{0x60FF, 0},
    modes{0x6502, 0};
}  // namespace object

/// TPDO 1: status word, position, mode shown. TPDO 2: velocity, demand. Objects that a drive lacks are left out. Both are sent at the SYNCs
/// of their node. A second axis has TPDO 3 and 4. RPDO 1, 2, 3: target position, velocity, torque; they take effect at the SYNC. Control
/// words are sent by SDO, so that each is acknowledged.
[[nodiscard]] canopen::Pdo status_pdo(std::uint8_t node, std::size_t axis = 0, bool mode = true);
[[nodiscard]] canopen::Pdo motion_pdo(std::uint8_t node, std::size_t axis = 0, bool velocity = true, bool demand = true);
/// `interpolated`: position by 60C1h, for mode 7.
[[nodiscard]] canopen::Pdo target_pdo(std::uint8_t node, std::uint16_t number, bool interpolated = false);
inline constexpr std::uint32_t status_base = 0x180, motion_base = 0x280, per_axis = 0x200;
/// Bits of an axis in its cycle: status (7 bytes) and motion (8); and of a target (4).
inline constexpr std::uint32_t axis_bits = canopen::most_bits(7) + canopen::most_bits(8), target_bits = canopen::most_bits(4);
inline constexpr int most_axes = 2;  ///< the connection set has four transmit PDOs, two for each axis

/// The bytes of an integer for an object, low byte first.
[[nodiscard]] std::vector<std::uint8_t> bytes_of(std::int64_t value, std::size_t size);
[[nodiscard]] std::int64_t signed_of(std::span<const std::uint8_t> bytes) noexcept;

/// A native statement that writes an object: "6081:00=20000" where the catalogue has the type, "2100:01=x01FF" as bytes on the bus. Empty:
/// it is no such statement.
struct ObjectWrite {
    Address address;
    std::vector<std::uint8_t> bytes;
};
[[nodiscard]] std::optional<ObjectWrite> object_write(const Catalogue& catalogue, std::string_view line);

/// Indexes of catalogue rows, and their indexes on a drive as the site states them.
using Places = std::map<std::uint16_t, std::uint16_t>;

/// The address of a parameter in the object dictionary; empty: it has none. `axis` counts from 0, for rows that have an index per axis.
[[nodiscard]] std::optional<Address> place_of(const Parameter& parameter, Point point, int axis = 0, const Places& places = {});
/// "object_2300" = "9216" in the options of a drive: rows at 2300h are at 2400h (9216) on this drive.
[[nodiscard]] Places moved_places(const std::map<std::string, std::string>& options);
/// Objects of the profile are 800h higher for each further axis (CiA 402, several devices in one node).
[[nodiscard]] constexpr Address of_axis(Address a, std::size_t axis) noexcept {
    return a.index >= 0x6000 && a.index < 0xA000 ? Address{static_cast<std::uint16_t>(a.index + 0x800 * axis), a.sub} : a;
}
/// The same object of the first axis.
[[nodiscard]] constexpr Address of_first_axis(Address a) noexcept {
    return a.index >= 0x6800 && a.index < 0xA000 ? Address{static_cast<std::uint16_t>(0x6000 + (a.index - 0x6000) % 0x800), a.sub} : a;
}
[[nodiscard]] std::optional<canopen::DataType> type_of(ValueType type) noexcept;
/// The catalogue row of an object; nullptr if there is none.
[[nodiscard]] const Parameter* parameter_at(const Catalogue& catalogue, Address address);

}  // namespace axisgate::cia402_drive
