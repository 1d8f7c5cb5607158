// The status port: doors, readiness and metrics, collected from the other owners and threads.
#pragma once

#include <functional>

#include "gateway/runtime/warm_events.hpp"
#include "gateway/runtime/warm_site.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/status.hpp"

namespace axisgate {

class WarmStatus final : public StatusPort {
public:
    WarmStatus(const WarmThreads& threads, const WarmEvents& events, const WarmSite& site, const AxisPort& axes, const DrivePort& drives)
        : threads_(threads), events_(events), site_(site), axes_(axes), drives_(drives) {}
    void set_doors(std::vector<DoorInfo> doors) { doors_ = std::move(doors); }
    /// Further lines for metrics, of the doors of the hot thread.
    std::function<std::string()> door_metrics;
    /// Doors that wait for their address or interface, one sentence each.
    std::function<std::vector<std::string>()> doors_waiting;
    /// Of the EtherNet/IP door, if it is open.
    std::function<std::string()> door_eds;

    [[nodiscard]] std::vector<DoorInfo> doors() const override { return doors_; }
    [[nodiscard]] double uptime_s() const override { return seconds(monotonic_now() - started_); }
    [[nodiscard]] std::vector<std::string> not_ready() const override;
    [[nodiscard]] std::string metrics() const override;
    [[nodiscard]] std::string eds() const override { return door_eds ? door_eds() : std::string(); }

private:
    [[nodiscard]] std::string hot_metrics() const;
    [[nodiscard]] std::string queue_metrics() const;

    const WarmThreads& threads_;
    const WarmEvents& events_;
    const WarmSite& site_;
    const AxisPort& axes_;
    const DrivePort& drives_;
    std::vector<DoorInfo> doors_;
    Instant started_ = monotonic_now();
};

}  // namespace axisgate
