// One seeded day of a gateway: its wires and clients, the faults and their times, and the laws that hold all the time. Equal runs give an
// equal fingerprint; nothing depends on real time.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "tests/world/world.hpp"

namespace axisgate::test {

/// The properties of a world that the seed selects. Several may apply at once.
struct StoryPlan {
    explicit StoryPlan(std::uint64_t seed);
    bool garbling;      ///< inverted bits, truncated frames, foreign bytes: an order may become another order, so there is no law about
                        ///< motion
    bool faulty;        ///< losses, doubles, delays, cuts: the faults of a wire that keeps its bits
    bool limits;        ///< the site limits positions; only on a wire without faults
    bool two_lines;     ///< beside a line of another subject without faults, which must not be affected by the first one
    bool two_clients;   ///< axes are held by leases
    bool restart;       ///< the gateway is killed in the middle, and another one starts
    bool site_changes;  ///< under load
    bool bad_store;     ///< late, and full from time to time
};

struct StoryEnd {
    std::uint64_t fingerprint = 0;
    std::map<std::string, std::uint64_t> faults;  ///< number of faults by name
};
/// `turns` is the number of commands.
StoryEnd run_story(const Subject& subject, std::uint64_t seed, int turns);

}  // namespace axisgate::test
