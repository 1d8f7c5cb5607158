// The PDOs of an axis as they are in force on its node, and the choice among the PDOs that a node with a fixed mapping has by itself
// (CiA 402-5 names the usual ones: status word alone, with mode, with position, with velocity). Pure: no transfer is made here.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "adapters/cia402/wire.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate::cia402_drive {

/// Where the PDOs of an axis come from.
enum class PdoPlan : std::uint8_t {
    free,  ///< the gateway's mapping
    file,  ///< the mapping that the drive has, and that cannot be changed
    few,   ///< the part of the gateway's mapping that the drive accepts
    sdo    ///< no PDOs with the values of the axis: they are read by SDO
};
[[nodiscard]] std::string_view name_of(PdoPlan plan) noexcept;

struct AxisPdos {
    PdoPlan plan = PdoPlan::free;
    std::vector<canopen::Pdo> reports;                     ///< transmit PDOs, sent at a SYNC; at most `most_reports`
    std::array<std::optional<canopen::Pdo>, 3> targets{};  ///< receive PDOs by SetPoint::Mode: position, velocity, torque
    static constexpr std::size_t most_reports = 4;
    /// True if a report carries the object, given by its address on the first axis.
    [[nodiscard]] bool carries(Address object) const noexcept;
};

/// The TPDOs of `found` that carry the status word and the position of the axis, and as many of mode, velocity and demand as there are, in
/// as few PDOs as possible. They are enabled, with transmission type `turns`. Empty: status word or position is in none of them.
[[nodiscard]] std::vector<canopen::Pdo> own_reports(std::span<const canopen::Pdo> found, std::uint8_t node, std::size_t axis, int turns);
/// The object that takes the targets of a stream in this mode of the drive.
[[nodiscard]] Address target_object(SetPoint::Mode kind, int mode) noexcept;
/// The RPDO of `found` that carries `target` and otherwise only entries whose values the gateway knows (control word, mode, other targets,
/// offsets, gaps); the shortest of them. It is enabled, with transmission type 1.
[[nodiscard]] std::optional<canopen::Pdo> own_target(std::span<const canopen::Pdo> found, std::uint8_t node, Address target);

/// The values of a receive PDO.
struct TargetValues {
    std::uint16_t controlword = 0;
    int mode = 0;
    Address target;  ///< the object that gets `value`; other targets and offsets are 0
    std::int64_t value = 0;
};
[[nodiscard]] std::vector<std::uint8_t> target_bytes(const canopen::PdoMapping& mapping, const TargetValues& values);

}  // namespace axisgate::cia402_drive
