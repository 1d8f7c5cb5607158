// The line and the drive port: the hot thread's newest reports and records, its scans and the conditions of its twins. Bounded by the hot
// thread's ring of jobs; further requests are answered busy.
#pragma once

#include "gateway/runtime/warm_events.hpp"
#include "gateway/runtime/warm_threads.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/lines.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

class WarmLines final : public LinePort {
public:
    WarmLines(const WarmThreads& threads, WarmEvents& events) : threads_(threads), events_(events) {}
    [[nodiscard]] LineReport line_report(LineId line) const override;
    [[nodiscard]] Trace trace(LineId line, std::uint64_t since, std::size_t limit) const override;
    void start_scan(LineId line, ScanWish wish, Origin origin, std::function<void(std::string)> then) override;
    void cancel_scan(LineId line, std::function<void(ScanReport)> then) override;
    void scan_report(LineId line, std::function<void(ScanReport)> then) override;
    [[nodiscard]] std::vector<SystemPort> host_ports() const override;

private:
    const WarmThreads& threads_;
    WarmEvents& events_;
};

/// Sets the serving side of the drive from a picture of one of its axes. Reports of drives are up to 200 ms old and pictures are not;
/// without this, values in one answer could contradict each other.
void show_presence(DriveStatus& status, const AxisPicture& axis);

class WarmDrives final : public DrivePort {
public:
    WarmDrives(const WarmThreads& threads, const SitePort& site) : threads_(threads), site_(site) {}
    /// Its presence is as new as the pictures of its axes; the rest is at most 200 ms old.
    [[nodiscard]] DriveStatus drive_status(DriveId drive) const override;
    void hand(DriveId drive, std::function<void(std::optional<std::vector<HandItem>>)> then) override;
    void set_hand(DriveId drive, std::vector<std::pair<std::string, Value>> items, Origin origin,
                  std::function<void(std::string)> then) override;
    void adopt(DriveId drive, NonVolatile memory, Origin origin, std::function<void(std::string)> then) override;

private:
    const WarmThreads& threads_;
    const SitePort& site_;
};

}  // namespace axisgate
