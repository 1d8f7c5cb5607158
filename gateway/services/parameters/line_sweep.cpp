// A drive of another family often answers with bytes that its own decoder reads: the frames that came are shown to every decoder.
#include "gateway/services/parameters/line_sweep.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/only_reads.hpp"

namespace axisgate {

Site site_of(const LineSweepWish& wish, const Families& families) {
    Site site;
    LineSpec line;
    line.name = LineSweep::line_name;
    line.uri = wish.uri;
    line.family = wish.family;
    line.bitrate = wish.bit_rate;
    line.options = wish.options;
    line.options[only_reads_option] = "";
    line.options.erase("specimen");
    DriveSpec drive;
    drive.name = LineSweep::drive_name;
    drive.line = line.name;
    drive.address = wish.address;
    drive.presence = PresenceRule::device;
    drive.options = wish.options;
    drive.options[only_reads_option] = "";
    AxisSpec axis;
    axis.name = LineSweep::axis_name;
    axis.drive = drive.name;
    axis.channel = wish.channel;
    axis.number = 1;
    const auto entry = families.find(wish.family);
    if (entry.family && entry.family->own_catalogue)
        if (auto own = entry.family->own_catalogue({*entry.catalogue, drive.options, nullptr}); own.catalogue)
            site.own_catalogues[drive.name] = std::move(own.catalogue);
    site.lines.push_back(std::move(line));
    site.drives.push_back(std::move(drive));
    site.axes.push_back(std::move(axis));
    return site;
}

LineSweep::LineSweep(RehearsalGateway& gateway) : gateway_(gateway), give_up_(gateway.now() + start_limit) {
    if (const auto axis = find_axis(gateway_, axis_name); axis && axis->catalogue) {
        axis_ = *axis;
        plan_ = sweep_plan(*axis_.catalogue);
    } else {
        fault_ = "its family has no catalogue";
        over_ = true;
    }
}

void LineSweep::turn() {
    if (over_) return;
    if (started_) {
        over_ = *swept_;
        return;
    }
    const DriveStatus status = gateway_.engine().drive_status(axis_.site->drive_ids.front());
    identity_ = status.text;
    if (gateway_.answers(axis_.id())) {
        started_ = true;
        (void)start_sweep(jobs_, gateway_, axis_name, axis_.id(), plan_.points, {}, [kept = sweep_, swept = swept_](Sweep sweep) {
            *kept = std::move(sweep);
            *swept = true;
        });
        over_ = *swept_;
    } else if (gateway_.now() >= give_up_) {
        over_ = true;
        const auto limit = std::chrono::duration_cast<std::chrono::seconds>(start_limit).count();
        const DriveSpec& drive = axis_.site->site.drives.front();
        fault_ = fmt::format("no {} at address {} answers within {} s{}{}", axis_.family, drive.address, limit,
                             identity_.empty() ? "" : ": " + identity_, other_family());
    }
}

std::string LineSweep::fault() const { return fault_; }

std::string LineSweep::other_family() const {
    ComparisonInput c;
    const auto entry = gateway_.families().find(axis_.family);
    c.family = entry.family;
    c.page = entry.catalogue;
    for (const SeenFrame& f : frames())
        if (f.to_drive == false) c.frames.push_back({f.frame, false});
    if (c.frames.empty()) return "; nothing was received";
    c.kind = c.frames.front().frame.kind == Frame::Kind::bytes ? LineKind::bytes : LineKind::can;
    const std::string other = check_family(gateway_.families(), c);
    return other.empty() ? "" : "; frames were received, and " + other;
}

std::vector<SeenFrame> LineSweep::frames() const {
    std::vector<SeenFrame> out;
    const auto log = gateway_.engine().frame_log(axis_.site->line_ids.front());
    if (!log) return out;
    return seen_frames(log->read_newest(most_frames, 0).entries);
}

DriveComparisonInput LineSweep::input(NonVolatile memory, Duration tolerance) const {
    return {{gateway_.families(), axis_.site->site, axis_name}, std::move(memory), plan_, *sweep_, identity_, frames(), tolerance};
}

}  // namespace axisgate
