// Divides the available descriptors in proportion to the configured numbers.
#include "gateway/runtime/descriptor_limits.hpp"

#include <fmt/core.h>
#include <spdlog/spdlog.h>
#include <sys/resource.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "gateway/protocols/cip/adapter.hpp"
#include "gateway/runtime/config.hpp"

namespace axisgate {

FittedShares fit_to_descriptors(const DoorShares& wanted, std::uint64_t hard_limit) {
    FittedShares f{wanted, {}};
    const std::uint64_t both = wanted.modbus + wanted.http, needed = descriptors_kept + wanted.enip + both;
    if (needed <= hard_limit || both == 0) return f;
    const std::uint64_t kept = descriptors_kept + wanted.enip;
    const std::uint64_t left = hard_limit > kept ? hard_limit - kept : 0;
    const auto share = [&](std::uint64_t of) { return of == 0 ? 0 : std::min(of, std::max(left * of / both, least_share)); };
    f.shares.modbus = share(wanted.modbus);
    f.shares.http = share(wanted.http);
    f.told = fmt::format(
        "this process may have {} open files, and all that its doors may let in needs {}: [modbus] max_connections is {} instead of {}, "
        "[limits] http_connections {} instead of {}; raise the hard limit (LimitNOFILE= of the unit, ulimit -Hn)",
        hard_limit, needed, f.shares.modbus, wanted.modbus, f.shares.http, wanted.http);
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
    const auto of = [](bool open, std::int64_t most) { return open ? static_cast<std::uint64_t>(most) : 0; };
    const auto fitted =
        fit_to_descriptors({of(!c.modbus_bind.empty(), c.modbus_max_connections), of(!c.http_bind.empty(), c.max_http_connections),
                            of(!c.enip_bind.empty(), cip::Adapter::most_sessions)},
                           descriptors);
    if (fitted.told.empty()) return;
    spdlog::warn("{}", fitted.told);
    if (fitted.shares.modbus > 0) c.modbus_max_connections = static_cast<std::int64_t>(fitted.shares.modbus);
    if (fitted.shares.http > 0) c.max_http_connections = static_cast<std::int64_t>(fitted.shares.http);
}

}  // namespace axisgate
