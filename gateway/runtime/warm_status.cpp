// Warm status: metrics are written topic by topic: the program, lines, drives, axes, doors.
// In: reports, counters. Out: text. Never waits.
#include "gateway/runtime/warm_status.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/core/histogram.hpp"
#include "gateway/runtime/axis_metrics.hpp"
#include "gateway/runtime/process_metrics.hpp"
#include "gateway/runtime/warm_lines.hpp"

namespace axisgate {

std::vector<std::string> WarmStatus::not_ready() const {
    auto list = threads_.hot.reports()->complaints;
    if (doors_waiting) {
        for (auto& door : doors_waiting())
            list.push_back(std::move(door));
    }
    if (!threads_.cold.healthy()) list.push_back("the database cannot be written: see the log for the reason");
    return list;
}

std::string WarmStatus::metrics() const {
    std::string s;
    const auto head = [&](std::string_view name, std::string_view type, std::string_view help) {
        s += fmt::format("# HELP {} {}\n# TYPE {} {}\n", name, help, name, type);
    };
    head("axisgate_build_info", "gauge", "Version of the program.");
    s += fmt::format("axisgate_build_info{{version=\"{}\"}} 1\n", AXISGATE_VERSION);
    head("axisgate_uptime_seconds", "gauge", "Time since the start.");
    s += fmt::format("axisgate_uptime_seconds {:.3f}\n", uptime_s());
    head("axisgate_mapping_info", "gauge", "Revision of the register mapping (register 18).");
    s += fmt::format("axisgate_mapping_info{{revision=\"{:08x}\"}} 1\n", mapping_revision(site_.site()->site));
    s += process_metrics();
    head("axisgate_hot_turns_total", "counter", "Turns of the hot loop.");
    s += fmt::format("axisgate_hot_turns_total {}\n", threads_.hot.turns().counted());
    const auto spread = [&](std::string_view name, std::string_view help, const Histogram& h) {
        const auto reading = h.read();
        s += metric_head(name, "histogram", help) + metric_lines(name, reading);
        return reading;
    };
    const auto turns = spread("axisgate_hot_turn_seconds", "Work of the hot loop between two sleeps.", threads_.hot.turns().times());
    head("axisgate_hot_turn_p999_seconds", "gauge", "99.9 % of all turns of the hot loop took no longer.");
    s += fmt::format("axisgate_hot_turn_p999_seconds {:.9f}\n", turns.quantile(0.999));
    (void)spread("axisgate_hot_wake_delay_seconds", "How long after its time a timer of the hot loop rang.",
                 threads_.hot.turns().wake_delays());
    (void)spread("axisgate_write_to_frame_seconds",
                 "From a command's being taken to its first frame having left on a real line (one command per line at a time is measured).",
                 threads_.hot.write_to_frame());
    (void)spread("axisgate_store_batch_seconds", "Transactions written to the database.", threads_.cold.batch_times());
    head("axisgate_queue_full_total", "counter", "Items that found the queue between two threads full.");
    for (const auto& [queue, full] : {std::pair{"commands", threads_.hot.commands().full()},
                                      {"jobs", threads_.hot.jobs().full()},
                                      {"store_from_hot", threads_.cold.from_hot().full()},
                                      {"store_from_service", threads_.cold.from_service().full()}})
        s += fmt::format("axisgate_queue_full_total{{queue=\"{}\"}} {}\n", queue, full);
    head("axisgate_store_batches_total", "counter", "Transactions written to the database.");
    s += fmt::format("axisgate_store_batches_total {}\n", threads_.cold.batches());
    head("axisgate_store_write_seconds_total", "counter", "Time spent writing to the database.");
    s += fmt::format("axisgate_store_write_seconds_total {:.6f}\n", static_cast<double>(threads_.cold.write_ns()) * 1e-9);
    head("axisgate_store_faults_total", "counter", "Transactions that could not be written.");
    s += fmt::format("axisgate_store_faults_total {}\n", threads_.cold.faults());
    head("axisgate_lost_events_total", "counter", "Events that found their queue full.");
    s += fmt::format("axisgate_lost_events_total {}\n", threads_.hot.lost_events() + events_.lost());

    const auto reports = threads_.hot.reports();
    head("axisgate_fail_safe_total", "counter", "Axes that were stopped because the client that commanded them was lost, by cause.");
    for (const LossCause cause : loss_causes)
        s += fmt::format("axisgate_fail_safe_total{{cause=\"{}\"}} {}\n", name_of(cause), reports->losses[static_cast<std::size_t>(cause)]);
    const auto& site = *site_.site();
    const auto per_line = [&](std::string_view name, std::string_view type, std::string_view help, auto&& value) {
        head(name, type, help);
        for (std::size_t i = 0; i < site.line_ids.size(); ++i) {
            const auto id = index_of(site.line_ids[i]);
            if (id < reports->lines.size())
                s += fmt::format("{}{{line=\"{}\"}} {}\n", name, site.site.lines[i].name, value(reports->lines[id]));
        }
    };
    per_line("axisgate_line_up", "gauge", "1: the line can carry frames.",
             [](const LineReport& r) { return r.status.state == LineStatus::State::up ? 1 : 0; });
    per_line("axisgate_line_frames_received_total", "counter", "Frames or runs of bytes that arrived.",
             [](const LineReport& r) { return r.status.frames_in; });
    per_line("axisgate_line_frames_sent_total", "counter", "Frames or runs of bytes that left.",
             [](const LineReport& r) { return r.status.frames_out; });
    per_line("axisgate_line_dropped_total", "counter", "Frames that found the send queue full.",
             [](const LineReport& r) { return r.status.dropped; });
    per_line("axisgate_line_queued", "gauge", "Frames that wait to be sent.", [](const LineReport& r) { return r.status.queued; });
    per_line("axisgate_line_received_bytes_total", "counter", "Bytes that arrived.", [](const LineReport& r) { return r.status.bytes_in; });
    per_line("axisgate_line_sent_bytes_total", "counter", "Bytes that left.", [](const LineReport& r) { return r.status.bytes_out; });
    per_line("axisgate_line_errors_total", "counter", "Errors of the line or its controller.",
             [](const LineReport& r) { return r.status.errors; });
    per_line("axisgate_line_reopened_total", "counter", "Times the line came back.", [](const LineReport& r) { return r.status.reopened; });
    per_line("axisgate_line_load_ratio", "gauge", "Share of the bit rate in use.",
             [](const LineReport& r) { return fmt::format("{:.4f}", r.status.load); });
    per_line("axisgate_line_exchanges_total", "counter", "Requests that got their answer.",
             [](const LineReport& r) { return r.counters.exchanges; });
    per_line("axisgate_line_timeouts_total", "counter", "Requests without an answer.",
             [](const LineReport& r) { return r.counters.timeouts; });
    per_line("axisgate_line_retries_total", "counter", "Requests sent again.", [](const LineReport& r) { return r.counters.retries; });
    per_line("axisgate_line_refused_total", "counter", "Requests that a drive refused.",
             [](const LineReport& r) { return r.counters.refused; });
    per_line("axisgate_line_garbled_total", "counter", "Frames or bytes that were not the protocol.",
             [](const LineReport& r) { return r.counters.garbled; });
    per_line("axisgate_line_unexpected_total", "counter", "Well formed frames that nobody had asked for.",
             [](const LineReport& r) { return r.counters.unexpected; });

    // Read once: the figures of one answer agree with each other.
    std::vector<AxisPicture> pictures;
    pictures.reserve(site.axis_ids.size());
    for (const AxisId id : site.axis_ids)
        pictures.push_back(axes_.picture(id));
    std::vector<DriveStatus> drives;
    for (std::size_t i = 0; i < site.drive_ids.size(); ++i) {
        drives.push_back(drives_.drive_status(site.drive_ids[i]));
        const auto axis = std::ranges::find(site.site.axes, site.site.drives[i].name, &AxisSpec::drive);
        const auto index = static_cast<std::size_t>(axis - site.site.axes.begin());
        if (index < pictures.size()) show_presence(drives.back(), pictures[index]);
    }
    const auto per_drive = [&](std::string_view name, std::string_view help, auto&& value) {
        head(name, "gauge", help);
        for (std::size_t i = 0; i < drives.size(); ++i)
            s += fmt::format("{}{{drive=\"{}\"}} {}\n", name, site.site.drives[i].name, value(drives[i]));
    };
    per_drive("axisgate_drive_online", "1: the drive or its twin answers.",
              [](const DriveStatus& d) { return d.presence != Presence::offline ? 1 : 0; });
    per_drive("axisgate_drive_simulated", "1: the embedded twin serves the axes.",
              [](const DriveStatus& d) { return d.presence == Presence::twin ? 1 : 0; });
    per_drive("axisgate_drive_device_online", "1: the real drive answers.", [](const DriveStatus& d) { return d.device_online ? 1 : 0; });
    per_drive("axisgate_drive_silent_exchanges", "Exchanges in a row that the drive has not answered.",
              [](const DriveStatus& d) { return d.silent_exchanges; });
    per_drive("axisgate_drive_retry_pause_seconds", "Pause before a silent drive is asked again; 0: it is asked as usual.",
              [](const DriveStatus& d) { return fmt::format("{:.3f}", static_cast<double>(d.retry_pause_ms) * 1e-3); });
    s += axis_metrics(site, pictures, monotonic_now());
    if (door_metrics) s += door_metrics();
    return s;
}

}  // namespace axisgate
