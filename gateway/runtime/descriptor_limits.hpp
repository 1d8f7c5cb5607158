// The number of clients that the doors may accept with the file descriptors that the system grants to this process.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate {

struct DoorShares {
    std::uint64_t modbus = 0, http = 0, enip = 0;  ///< number of connections
    bool operator==(const DoorShares&) const = default;
};
/// Descriptors of the process for everything else: lines, the database, files, timers, a spare one for each door.
inline constexpr std::uint64_t descriptors_kept = 128;
/// EtherNet/IP keeps the bound of its protocol; Modbus and HTTP share the rest in the configured proportion, and get at least this number
/// each.
inline constexpr std::uint64_t least_share = 8;

struct FittedShares {
    DoorShares shares;
    std::string told;  ///< empty: all configured connections fit
};
[[nodiscard]] FittedShares fit_to_descriptors(const DoorShares& wanted, std::uint64_t hard_limit);

struct Config;
/// Raises the soft limit of open files to the hard one, and reduces the numbers of connections if that is not sufficient, with a warning.
void fit_doors(Config& config);

}  // namespace axisgate
