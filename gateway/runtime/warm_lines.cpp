// Reports are copied from the hot thread's newest ones; scans and conditions are jobs that it carries out between two frames. The hot
// thread is never waited for.
#include "gateway/runtime/warm_lines.hpp"

#include <fmt/core.h>

#include "gateway/lines/host_ports.hpp"
#include "gateway/runtime/clock.hpp"

namespace axisgate {
namespace {
/// A report that is not available now.
ScanReport no_report() {
    ScanReport r;
    r.state = ScanReport::State::failed;
    r.text = too_much_asked;
    return r;
}
}  // namespace

LineReport WarmLines::line_report(LineId line) const {
    const auto r = threads_.hot.reports();
    return index_of(line) < r->lines.size() ? r->lines[index_of(line)] : LineReport{};
}

Trace WarmLines::trace(LineId line, std::uint64_t since, std::size_t limit) const {
    Trace out;
    const auto r = threads_.hot.reports();
    const auto log = index_of(line) < r->logs.size() ? r->logs[index_of(line)] : nullptr;
    if (!log) return out;
    auto part = log->read(since, limit, unix_ns_of(time_zero));
    out.missed = part.missed;
    out.next = part.next;
    out.entries = std::move(part.entries);
    return out;
}

void WarmLines::start_scan(LineId line, ScanWish wish, Origin origin, std::function<void(std::string)> then) {
    auto job = [this, line, wish = std::move(wish), origin = std::move(origin), then](Engine& engine, Instant now) mutable {
        std::string fault = engine.start_scan(line, std::move(wish), now);
        Event e;
        for (std::size_t i = 0; i < engine.site()->line_ids.size(); ++i) {
            if (engine.site()->line_ids[i] == line) e.line = engine.site()->site.lines[i].name;
        }
        threads_.answer([this, then, origin, fault = std::move(fault), e = std::move(e)]() mutable {
            if (fault.empty()) {
                e.kind = "scan";
                e.text = fmt::format("line {} is searched for drives", e.line);
                e.who = origin.who ? *origin.who : "";
                e.door = std::string(name_of(origin.door));
                events_.note(std::move(e));
            }
            then(std::move(fault));
        });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(too_much_asked); });
}

void WarmLines::scan_report(LineId line, std::function<void(ScanReport)> then) {
    auto job = [this, line, then](Engine& engine, Instant) {
        threads_.answer([then, r = engine.scan_report(line)]() mutable { then(std::move(r)); });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(no_report()); });
}

void WarmLines::cancel_scan(LineId line, std::function<void(ScanReport)> then) {
    auto job = [this, line, then](Engine& engine, Instant now) {
        engine.cancel_scan(line, now);
        threads_.answer([then, r = engine.scan_report(line)]() mutable { then(std::move(r)); });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(no_report()); });
}

std::vector<SystemPort> WarmLines::host_ports() const { return axisgate::host_ports(); }

void show_presence(DriveStatus& status, const AxisPicture& axis) {
    status.presence = axis.presence;
    if (axis.presence == Presence::offline) return;
    status.simulated = axis.presence == Presence::twin;
    if (axis.presence == Presence::device) status.device_online = true;
}

DriveStatus WarmDrives::drive_status(DriveId drive) const {
    const auto r = threads_.hot.reports();
    if (index_of(drive) >= r->drives.size()) return {};
    DriveStatus status = r->drives[index_of(drive)];
    const auto state = site_.site();
    const auto at = std::ranges::find(state->drive_ids, drive);
    if (at == state->drive_ids.end()) return status;
    const auto& name = state->site.drives[static_cast<std::size_t>(at - state->drive_ids.begin())].name;
    const auto axis = std::ranges::find(state->site.axes, name, &AxisSpec::drive);
    const auto index = static_cast<std::size_t>(axis - state->site.axes.begin());
    if (index < state->axis_ids.size()) show_presence(status, threads_.hot.image_for_readers().cell(state->axis_ids[index]).read());
    return status;
}

void WarmDrives::hand(DriveId drive, std::function<void(std::optional<std::vector<HandItem>>)> then) {
    auto job = [this, drive, then](Engine& engine, Instant) {
        Twin* twin = engine.twin(drive);
        std::optional<std::vector<HandItem>> items;
        if (twin) items = twin->hand();
        threads_.answer([then, items = std::move(items)]() mutable { then(std::move(items)); });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(std::nullopt); });
}

void WarmDrives::set_hand(DriveId drive, std::vector<std::pair<std::string, Value>> items, Origin origin,
                          std::function<void(std::string)> then) {
    auto job = [this, drive, items = std::move(items), origin = std::move(origin), then](Engine& engine, Instant now) {
        std::string fault = engine.set_hand(drive, items, origin, now);
        threads_.answer([then, fault = std::move(fault)]() mutable { then(std::move(fault)); });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(too_much_asked); });
}

void WarmDrives::adopt(DriveId drive, NonVolatile memory, Origin origin, std::function<void(std::string)> then) {
    auto job = [this, drive, memory = std::move(memory), origin = std::move(origin), then](Engine& engine, Instant now) {
        std::string fault = engine.adopt(drive, memory, origin, now);
        threads_.answer([then, fault = std::move(fault)]() mutable { then(std::move(fault)); });
    };
    if (!threads_.on_hot(std::move(job))) threads_.answer([then] { then(too_much_asked); });
}

}  // namespace axisgate
