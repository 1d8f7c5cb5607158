// The base of the parts of one drive: access to the line, to the options, and to the other parts.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/motion_commands.hpp"
#include "adapters/linmot/wire.hpp"
#include "adapters/linmot/wire_sharing.hpp"
#include "gateway/drive/bus.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::linmot {
using drive::Turn;

class Drive;
using Part = drive::Part<Drive>;

/// A drive may show the effect of an order so long after it has answered the order: its response may have been made up before. The manual
/// prints no time; until then an effect that is not shown is no refusal.
inline constexpr Duration shown_within = std::chrono::seconds(1);

/// The members that the drives of a line share.
struct Bus : drive::Bus {
    explicit Bus(const Catalogue& of_family) : drive::Bus(of_family), motions(of_family) {}
    Motions motions;
    ChecksumRule checksum;
    std::size_t drives = 0;  ///< on the line
    SharedLine shared;
};

/// The options of the drive in the site, read once (README.md).
struct DriveOptions {
    bool warn_inferred = false;       ///< warn_word = inferred
    bool inferred = true;             ///< messages that no page of the manufacturer describes may be sent
    bool stop_by_off3 = false;        ///< quick_stop = off3
    bool keeps_limits = true;         ///< drive_limits: the site's position limits are written to the drive's RAM
    bool streams = false;             ///< set_points = auto or stream
    std::vector<std::string> faults;  ///< texts about options that could not be read
};
[[nodiscard]] DriveOptions drive_options(const DriveSetup& setup, const Bus& bus);

/// The values that a move without rates uses, in the drive's counts; empty: the drive has not reported them.
struct Limits {
    static constexpr std::uint16_t upids[] = {0x14BE, 0x14BF, 0x14C0};  ///< read before commands are accepted
    std::optional<std::uint32_t> velocity, acceleration, deceleration;
    [[nodiscard]] std::optional<std::uint32_t>& at(std::size_t i) noexcept {
        return i == 0 ? velocity : i == 1 ? acceleration : deceleration;
    }
};

}  // namespace axisgate::linmot
