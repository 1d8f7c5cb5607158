// The 64 registers of one axis in the standard map: their names and types, and the conversion from an AxisPicture and to a ProcessData. It
// does not know which axis it serves, and does not check values; the engine does that.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "gateway/axis/image.hpp"
#include "gateway/core/command.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/registers/unit_map.hpp"
#include "gateway/registers/words.hpp"

namespace axisgate::registers {

inline constexpr std::uint16_t registers_per_axis = 64;
inline constexpr std::size_t block_size = 2 * registers_per_axis;  ///< bytes

/// Offsets within an axis' 64 registers.
namespace reg {
inline constexpr std::uint16_t statusword = 0, mode_display = 1, position = 2, velocity = 4, position_demand = 6, error_code = 8, flags = 9,
                               native_status = 10, age = 12, heartbeat = 14, family = 15, setpoints_accepted = 16, authority = 17,
                               mapping_revision = 18, refusal_reason = 20, refusals = 21, fail_safe_cause = 22, stop_latch = 23,
                               controlword = 32, mode = 33, target_position = 34, profile_velocity = 36, profile_acceleration = 38,
                               profile_deceleration = 40, target_velocity = 42, homing_method = 44, channel_selector = 48,
                               channel_request = 50, channel_state = 51, channel_value = 52, channel_error = 54;
}  // namespace reg

struct RegisterRow {
    std::uint16_t offset;
    MapType type;
    bool writable;
    std::string_view point;  ///< the name for mappings and display; empty: a register of the parameter channel
    std::string_view name;   ///< for people
    [[nodiscard]] constexpr std::uint16_t width() const noexcept { return type == MapType::u32 || type == MapType::i32 ? 2 : 1; }
};
/// 0, 1 and 255 are the standard map.
[[nodiscard]] constexpr bool is_standard_unit(std::int64_t unit) noexcept { return unit == 0 || unit == 1 || unit == 255; }
/// Every register of an axis with a meaning, in ascending order. Offsets that are not listed read 0 and cannot be written.
[[nodiscard]] std::span<const RegisterRow> standard_registers() noexcept;

/// Writes registers 0..47 of `block` (block_size bytes), except age and heartbeat, which depend on the instant of the request, and the
/// counters of the door (20, 21); these stay 0. Position and position demand show the low 32 bits of the increments, so that differences
/// stay correct when a count passes 2^31. The velocity stops at the limits of i32. Registers 48..63 are not written.
void render(const AxisPicture& picture, std::uint32_t mapping_revision, WordOrder order, std::uint8_t* block) noexcept;

/// Register 12: age of the drive's last report in ms; 0xFFFFFFFF if there was none, or if it is older than that.
[[nodiscard]] std::uint32_t age_ms(const AxisPicture& picture, Instant now) noexcept;
/// Register 14: whole seconds of the gateway's time line, modulo 65536.
[[nodiscard]] std::uint16_t heartbeat(Instant now) noexcept;

[[nodiscard]] bool is_writable(std::uint16_t offset) noexcept;
/// Name of the value to which a register belongs; empty: none.
[[nodiscard]] std::string_view name_at(std::uint16_t offset) noexcept;
/// Checks whether `count` registers from `offset` (both within one axis) may be written: illegal_address if one of them is not writable,
/// illegal_value if the write begins or ends in the middle of a 32-bit value.
[[nodiscard]] Verdict check_write_offsets(std::uint16_t offset, std::uint16_t count) noexcept;

/// The set-points (offsets 32..44) of a write that check_write_offsets has accepted. `data` has 2 * count bytes.
[[nodiscard]] ProcessData process_data(std::uint16_t offset, std::uint16_t count, const std::uint8_t* data, WordOrder order) noexcept;

/// The 64 bits of coils and discrete inputs: flags in bits 0..15, the status word in 16..31, the rest 0.
[[nodiscard]] std::uint64_t bits_of(const AxisPicture& picture) noexcept;

}  // namespace axisgate::registers
