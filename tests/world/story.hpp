// Story: one seeded day of a gateway: which wires and clients it has, what goes wrong and when, and the laws that hold all the time.
// In: a subject and a seed. Out: failed laws, a fingerprint that is equal for equal runs, what went wrong how often. Never depends on real
// time.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "tests/world/world.hpp"

namespace axisgate::test {

/// What the seed makes of a world. Several hold at once.
struct StoryPlan {
    explicit StoryPlan(std::uint64_t seed);
    bool garbling;      ///< bits turned over, frames cut short, foreign bytes: what was ordered may come as another order, so no law about
                        ///< motion
    bool faulty;        ///< losses, doubles, lateness, cuts: what a wire does that keeps its bits
    bool limits;        ///< the site limits positions; only on a wire without faults
    bool two_lines;     ///< beside a line of another subject, which has no faults and must not feel those of the first
    bool two_clients;   ///< axes are held by leases
    bool restart;       ///< the gateway is killed in the middle, and another one starts
    bool site_changes;  ///< under load
    bool bad_store;     ///< late, and full from time to time
};

struct StoryEnd {
    std::uint64_t fingerprint = 0;
    std::map<std::string, std::uint64_t> faults;  ///< what went wrong how often, by name
};
/// `turns`: commands given.
StoryEnd run_story(const Subject& subject, std::uint64_t seed, int turns);

}  // namespace axisgate::test
