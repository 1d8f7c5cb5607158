// What the parts of one drive have in common: its line, its options, and how each part reaches the others.
// In: the line's setup, the drive's options. Out: members. Never lets one drive look into another.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "adapters/linmot/motion_commands.hpp"
#include "adapters/linmot/wire.hpp"
#include "gateway/drive/bus.hpp"
#include "gateway/drive/part.hpp"

namespace axisgate::linmot {
using drive::Turn;

class Drive;
using Part = drive::Part<Drive>;

/// What the drives of a line have in common.
struct Bus : drive::Bus {
    explicit Bus(const Catalogue& of_family) : drive::Bus(of_family), motions(of_family) {}
    Motions motions;
    ChecksumRule checksum;
    std::size_t drives = 0;  ///< on the line
};

/// The drive's options of the site, read once (README.md).
struct DriveOptions {
    bool warn_inferred = false;       ///< warn_word = inferred
    bool inferred = true;             ///< messages that stand in no page of the maker may be sent
    bool stop_by_off3 = false;        ///< quick_stop = off3
    bool keeps_limits = true;         ///< drive_limits: the site's limits of position go into its RAM
    bool streams = false;             ///< set_points = auto or stream
    std::vector<std::string> faults;  ///< options that could not be read
};
[[nodiscard]] DriveOptions drive_options(const DriveSetup& setup, const Bus& bus);

/// What a move uses that names no rate, in the drive's counts; nothing: the drive does not tell it.
struct Limits {
    static constexpr std::uint16_t upids[] = {0x14BE, 0x14BF, 0x14C0};  ///< read before a drive is served
    std::optional<std::uint32_t> velocity, acceleration, deceleration;
    [[nodiscard]] std::optional<std::uint32_t>& at(std::size_t i) noexcept {
        return i == 0 ? velocity : i == 1 ? acceleration : deceleration;
    }
};

}  // namespace axisgate::linmot
