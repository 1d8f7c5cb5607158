// Divides the available descriptors in proportion to the configured numbers.
#include "gateway/runtime/descriptor_limits.hpp"

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "gateway/runtime/doors.hpp"

namespace axisgate {

FittedShares fit_to_descriptors(const std::vector<DoorShare>& wanted, std::uint64_t hard_limit) {
    FittedShares f;
    std::uint64_t shared = 0, kept = descriptors_kept;
    for (const DoorShare& door : wanted) {
        f.shares.push_back(door.wanted);
        (door.key.empty() ? kept : shared) += door.wanted;
    }
    const std::uint64_t needed = kept + shared;
    if (needed <= hard_limit || shared == 0) return f;
    const std::uint64_t left = hard_limit > kept ? hard_limit - kept : 0;
    std::string lessened;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
        const DoorShare& door = wanted[i];
        if (door.key.empty() || door.wanted == 0) continue;
        f.shares[i] = std::min(door.wanted, std::max(left * door.wanted / shared, least_share));
        lessened += fmt::format("{}{}{} instead of {}", lessened.empty() ? "" : ", ", door.key,
                                lessened.empty() ? fmt::format(" is {}", f.shares[i]) : fmt::format(" {}", f.shares[i]), door.wanted);
    }
    f.told = fmt::format(
        "this process may have {} open files, and all that its doors may let in needs {}: {}; raise the hard limit (LimitNOFILE= of the "
        "unit, "
        "ulimit -Hn)",
        hard_limit, needed, lessened);
    return f;
}

namespace {
/// Raises the limit to the hard one; returns the present number.
std::uint64_t raise_descriptor_limit() {
    rlimit limit{};
    if (getrlimit(RLIMIT_NOFILE, &limit) != 0) return UINT64_MAX;
    if (limit.rlim_cur < limit.rlim_max) {
        const rlim_t before = limit.rlim_cur;
        limit.rlim_cur = limit.rlim_max;
        if (setrlimit(RLIMIT_NOFILE, &limit) != 0) {
            spdlog::warn("the limit of open files stays as it is: {}", std::strerror(errno));
            limit.rlim_cur = before;
        }
    }
    return limit.rlim_cur;
}
}  // namespace

void fit_doors(Config& c) {
    const std::uint64_t descriptors = raise_descriptor_limit();
    const auto doors = all_doors();
    std::vector<DoorShare> wanted;
    for (const DoorDescriptor* door : doors)
        wanted.push_back({door->clients.key, door->clients.most ? door->clients.most(c) : 0});
    const FittedShares fitted = fit_to_descriptors(wanted, descriptors);
    if (fitted.told.empty()) return;
    spdlog::warn("{}", fitted.told);
    for (std::size_t i = 0; i < doors.size(); ++i) {
        if (doors[i]->clients.lessen && fitted.shares[i] > 0) doors[i]->clients.lessen(c, fitted.shares[i]);
    }
}

}  // namespace axisgate
