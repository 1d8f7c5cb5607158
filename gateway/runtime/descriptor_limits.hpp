// Descriptor limits: how many clients the doors may let in with the descriptors that the system grants this process.
// In: what the configuration wants, the hard limit. Out: what fits, and a sentence where that is less.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate {

struct DoorShares {
    std::uint64_t modbus = 0, http = 0, enip = 0;  ///< connections
    bool operator==(const DoorShares&) const = default;
};
/// Of the process for all else: lines, the database, files, timers, a spare one for each door.
inline constexpr std::uint64_t descriptors_kept = 128;
/// What EtherNet/IP may have is its protocol's bound and stays; Modbus and HTTP share what is left as the configuration has them to one
/// another, and never fewer than this each.
inline constexpr std::uint64_t least_share = 8;

struct FittedShares {
    DoorShares shares;
    std::string told;  ///< empty: all that was wanted fits
};
[[nodiscard]] FittedShares fit_to_descriptors(const DoorShares& wanted, std::uint64_t hard_limit);

struct Config;
/// Raises the soft limit of open files to the hard one, and lessens what the doors may let in where that is not enough, with a warning.
void fit_doors(Config& config);

}  // namespace axisgate
