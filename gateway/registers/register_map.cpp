// Which half of a 32-bit value an offset is, and whether it can be written, is derived from the one table at compile time. Positions keep
// their low 32 bits; velocities never wrap.
#include "gateway/registers/register_map.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

namespace axisgate::registers {
namespace {
using enum MapType;
constexpr std::array rows{
    RegisterRow{reg::statusword, u16, false, "statusword", "statusword"},
    RegisterRow{reg::mode_display, i16, false, "mode_display", "modes of operation display"},
    RegisterRow{reg::position, i32, false, "position", "position actual value"},
    RegisterRow{reg::velocity, i32, false, "velocity", "velocity actual value"},
    RegisterRow{reg::position_demand, i32, false, "position_demand", "position demand value"},
    RegisterRow{reg::error_code, u16, false, "error_code", "error code"},
    RegisterRow{reg::flags, u16, false, "flags", "flags"},
    RegisterRow{reg::native_status, u32, false, "native_status", "drive's own status"},
    RegisterRow{reg::age, u32, false, "age_ms", "age of the data, ms"},
    RegisterRow{reg::heartbeat, u16, false, "heartbeat", "heartbeat"},
    RegisterRow{reg::family, u16, false, "family", "family number"},
    RegisterRow{reg::setpoints_accepted, u16, false, "setpoints_accepted", "set-points accepted"},
    RegisterRow{reg::authority, u16, false, "authority", "command authority"},
    RegisterRow{reg::mapping_revision, u32, false, "mapping_revision", "revision of the mapping"},
    RegisterRow{reg::refusal_reason, u16, false, "refusal_reason", "reason of the last refusal"},
    RegisterRow{reg::refusals, u16, false, "refusals", "refusals"},
    RegisterRow{reg::fail_safe_cause, u16, false, "fail_safe_cause", "cause of the last fail-safe action"},
    RegisterRow{reg::stop_latch, u16, false, "stop_latch", "stop latch"},
    RegisterRow{reg::controlword, u16, true, "controlword", "controlword"},
    RegisterRow{reg::mode, i16, true, "mode", "modes of operation"},
    RegisterRow{reg::target_position, i32, true, "target_position", "target position"},
    RegisterRow{reg::profile_velocity, u32, true, "profile_velocity", "profile velocity"},
    RegisterRow{reg::profile_acceleration, u32, true, "profile_acceleration", "profile acceleration"},
    RegisterRow{reg::profile_deceleration, u32, true, "profile_deceleration", "profile deceleration"},
    RegisterRow{reg::target_velocity, i32, true, "target_velocity", "target velocity"},
    RegisterRow{reg::homing_method, i16, true, "homing_method", "homing method"},
    RegisterRow{reg::channel_selector, u32, true, "", "parameter channel: selector"},
    RegisterRow{reg::channel_request, u16, true, "", "parameter channel: request"},
    RegisterRow{reg::channel_state, u16, false, "", "parameter channel: state"},
    RegisterRow{reg::channel_value, i32, true, "", "parameter channel: value"},
    RegisterRow{reg::channel_error, u16, false, "", "parameter channel: error"},
};

enum class Part : std::uint8_t { fixed, whole, first, second };  // `fixed`: cannot be written

constexpr std::array<Part, registers_per_axis> parts = [] {
    std::array<Part, registers_per_axis> p{};
    for (const auto& row : rows) {
        if (!row.writable) continue;
        p[row.offset] = row.width() == 2 ? Part::first : Part::whole;
        if (row.width() == 2) p[row.offset + 1] = Part::second;
    }
    return p;
}();

std::int32_t saturated(std::int64_t v) noexcept {
    return static_cast<std::int32_t>(
        std::clamp<std::int64_t>(v, std::numeric_limits<std::int32_t>::min(), std::numeric_limits<std::int32_t>::max()));
}
}  // namespace

std::span<const RegisterRow> standard_registers() noexcept { return rows; }

void render(const AxisPicture& picture, std::uint32_t mapping_revision, WordOrder order, std::uint8_t* block) noexcept {
    std::memset(block, 0, 2 * std::size_t{reg::channel_selector});
    const auto word = [&](std::uint16_t offset, std::uint16_t v) { put16(block + 2 * std::size_t{offset}, v); };
    const auto pair = [&](std::uint16_t offset, std::uint32_t v) { put32(block + 2 * std::size_t{offset}, v, order); };
    word(reg::statusword, picture.statusword);
    word(reg::mode_display, static_cast<std::uint16_t>(picture.mode_display));
    pair(reg::position, static_cast<std::uint32_t>(picture.position));
    pair(reg::velocity, static_cast<std::uint32_t>(saturated(picture.velocity)));
    pair(reg::position_demand, static_cast<std::uint32_t>(picture.position_demand));
    word(reg::error_code, picture.error_code);
    word(reg::flags, picture.flags);
    pair(reg::native_status, picture.native_status);
    word(reg::family, picture.family_number);
    word(reg::setpoints_accepted, picture.setpoints_accepted);
    word(reg::authority, static_cast<std::uint16_t>(picture.authority));
    pair(reg::mapping_revision, mapping_revision);
    word(reg::fail_safe_cause, picture.fail_safe_cause);
    word(reg::stop_latch, picture.stop_latch);
    word(reg::controlword, picture.controlword);
    word(reg::mode, static_cast<std::uint16_t>(picture.mode));
    pair(reg::target_position, static_cast<std::uint32_t>(picture.target_position));
    pair(reg::profile_velocity, picture.profile_velocity);
    pair(reg::profile_acceleration, picture.profile_acceleration);
    pair(reg::profile_deceleration, picture.profile_deceleration);
    pair(reg::target_velocity, static_cast<std::uint32_t>(picture.target_velocity));
    word(reg::homing_method, static_cast<std::uint16_t>(picture.homing_method));
}

std::uint32_t age_ms(const AxisPicture& picture, Instant now) noexcept {
    constexpr std::int64_t most = std::numeric_limits<std::uint32_t>::max();
    if (!picture.ever_seen) return static_cast<std::uint32_t>(most);
    if (now <= picture.at) return 0;
    return static_cast<std::uint32_t>(std::min(milliseconds_of(now - picture.at), most));
}

std::uint16_t heartbeat(Instant now) noexcept { return static_cast<std::uint16_t>(ns_of(now) / 1'000'000'000); }

bool is_writable(std::uint16_t offset) noexcept { return offset < registers_per_axis && parts[offset] != Part::fixed; }
std::string_view name_at(std::uint16_t offset) noexcept {
    for (const auto& row : rows) {
        if (offset >= row.offset && offset < row.offset + row.width()) return row.name;
    }
    return {};
}

Verdict check_write_offsets(std::uint16_t offset, std::uint16_t count) noexcept {
    if (count == 0 || offset + count > registers_per_axis) return Verdict::no_address;
    for (std::uint16_t i = 0; i < count; ++i) {
        if (parts[offset + i] == Part::fixed) return Verdict::no_address;
    }
    if (parts[offset] == Part::second || parts[offset + count - 1] == Part::first) return Verdict::bad_value;
    return Verdict::good;
}

ProcessData process_data(std::uint16_t offset, std::uint16_t count, const std::uint8_t* data, WordOrder order) noexcept {
    ProcessData p;
    const auto has = [&](std::uint16_t r) { return r >= offset && r < offset + count; };
    const auto word = [&](std::uint16_t r) { return get16(data + 2 * std::size_t(r - offset)); };
    const auto pair = [&](std::uint16_t r) { return get32(data + 2 * std::size_t(r - offset), order); };
    if (has(reg::controlword)) p.controlword = word(reg::controlword);
    if (has(reg::mode)) p.mode = static_cast<std::int16_t>(word(reg::mode));
    if (has(reg::target_position)) p.target_position = static_cast<std::int32_t>(pair(reg::target_position));
    if (has(reg::profile_velocity)) p.profile_velocity = pair(reg::profile_velocity);
    if (has(reg::profile_acceleration)) p.profile_acceleration = pair(reg::profile_acceleration);
    if (has(reg::profile_deceleration)) p.profile_deceleration = pair(reg::profile_deceleration);
    if (has(reg::target_velocity)) p.target_velocity = static_cast<std::int32_t>(pair(reg::target_velocity));
    if (has(reg::homing_method)) p.homing_method = static_cast<std::int16_t>(word(reg::homing_method));
    return p;
}

std::uint64_t bits_of(const AxisPicture& picture) noexcept {
    return std::uint64_t{picture.flags} | (std::uint64_t{picture.statusword} << 16);
}

}  // namespace axisgate::registers
