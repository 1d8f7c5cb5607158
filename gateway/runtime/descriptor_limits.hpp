// The number of clients that the doors may accept with the file descriptors that the system grants to this process.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

/// Number of connections of a door.
struct DoorShare {
    std::string_view key;      ///< key of the configuration, such as "[modbus] max_connections"; empty: the protocol sets the number
    std::uint64_t wanted = 0;  ///< 0: the door is closed
};
/// Descriptors of the process for everything else: lines, the database, files, timers, a spare one for each door.
inline constexpr std::uint64_t descriptors_kept = 128;
/// Doors with a key share the remaining descriptors in the configured proportion, and get at least this number each.
inline constexpr std::uint64_t least_share = 8;

struct FittedShares {
    std::vector<std::uint64_t> shares;  ///< in the order of `wanted`
    std::string told;                   ///< empty: all configured connections fit
};
[[nodiscard]] FittedShares fit_to_descriptors(const std::vector<DoorShare>& wanted, std::uint64_t hard_limit);

struct Config;
/// Raises the soft limit of open files to the hard one, and reduces the numbers of connections if that is not sufficient, with a warning.
void fit_doors(Config& config);

}  // namespace axisgate
