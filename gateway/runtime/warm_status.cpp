// Metrics are written topic by topic: the program, lines, drives, axes, doors.
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

namespace {
struct LineMetric {
    std::string_view name, type, help;
    std::string (*value)(const LineReport&);
};
constexpr LineMetric line_figures[] = {
    {"axisgate_line_up", "gauge", "1: the line can carry frames.",
     [](const LineReport& r) { return r.status.state == LineStatus::State::up ? std::string("1") : std::string("0"); }},
    {"axisgate_line_frames_received_total", "counter", "Frames or runs of bytes that arrived.",
     [](const LineReport& r) { return std::to_string(r.status.frames_in); }},
    {"axisgate_line_frames_sent_total", "counter", "Frames or runs of bytes that left.",
     [](const LineReport& r) { return std::to_string(r.status.frames_out); }},
    {"axisgate_line_dropped_total", "counter", "Frames that found the send queue full.",
     [](const LineReport& r) { return std::to_string(r.status.dropped); }},
    {"axisgate_line_queued", "gauge", "Frames that wait to be sent.", [](const LineReport& r) { return std::to_string(r.status.queued); }},
    {"axisgate_line_received_bytes_total", "counter", "Bytes that arrived.",
     [](const LineReport& r) { return std::to_string(r.status.bytes_in); }},
    {"axisgate_line_sent_bytes_total", "counter", "Bytes that left.",
     [](const LineReport& r) { return std::to_string(r.status.bytes_out); }},
    {"axisgate_line_errors_total", "counter", "Errors of the line or its controller.",
     [](const LineReport& r) { return std::to_string(r.status.errors); }},
    {"axisgate_line_reopened_total", "counter", "Times the line came back.",
     [](const LineReport& r) { return std::to_string(r.status.reopened); }},
    {"axisgate_line_load_ratio", "gauge", "Share of the bit rate in use.",
     [](const LineReport& r) { return fmt::format("{:.4f}", r.status.load); }},
    {"axisgate_line_exchanges_total", "counter", "Requests that got their answer.",
     [](const LineReport& r) { return std::to_string(r.counters.exchanges); }},
    {"axisgate_line_timeouts_total", "counter", "Requests without an answer.",
     [](const LineReport& r) { return std::to_string(r.counters.timeouts); }},
    {"axisgate_line_retries_total", "counter", "Requests sent again.",
     [](const LineReport& r) { return std::to_string(r.counters.retries); }},
    {"axisgate_line_refused_total", "counter", "Requests that a drive refused.",
     [](const LineReport& r) { return std::to_string(r.counters.refused); }},
    {"axisgate_line_garbled_total", "counter", "Frames or bytes that were not the protocol.",
     [](const LineReport& r) { return std::to_string(r.counters.garbled); }},
    {"axisgate_line_unexpected_total", "counter", "Well formed frames that nobody had asked for.",
     [](const LineReport& r) { return std::to_string(r.counters.unexpected); }},
};

struct DriveMetric {
    std::string_view name, help;
    std::string (*value)(const DriveStatus&);
};
constexpr DriveMetric drive_figures[] = {
    {"axisgate_drive_online", "1: the drive or its twin answers.",
     [](const DriveStatus& d) { return d.presence != Presence::offline ? std::string("1") : std::string("0"); }},
    {"axisgate_drive_simulated", "1: the embedded twin serves the axes.",
     [](const DriveStatus& d) { return d.presence == Presence::twin ? std::string("1") : std::string("0"); }},
    {"axisgate_drive_device_online", "1: the real drive answers.",
     [](const DriveStatus& d) { return d.device_online ? std::string("1") : std::string("0"); }},
    {"axisgate_drive_silent_exchanges", "Exchanges in a row that the drive has not answered.",
     [](const DriveStatus& d) { return std::to_string(d.silent_exchanges); }},
    {"axisgate_drive_retry_pause_seconds", "Pause before a silent drive is asked again; 0: it is asked as usual.",
     [](const DriveStatus& d) { return fmt::format("{:.3f}", static_cast<double>(d.retry_pause_ms) * 1e-3); }},
};

std::string line_metrics(const SiteState& site, const Reports& reports) {
    std::string s;
    for (const LineMetric& m : line_figures) {
        s += metric_head(m.name, m.type, m.help);
        for (std::size_t i = 0; i < site.line_ids.size(); ++i) {
            const auto id = index_of(site.line_ids[i]);
            if (id < reports.lines.size())
                s += fmt::format("{}{{line=\"{}\"}} {}\n", m.name, site.site.lines[i].name, m.value(reports.lines[id]));
        }
    }
    return s;
}

std::string drive_metrics(const SiteState& site, const std::vector<DriveStatus>& drives) {
    std::string s;
    for (const DriveMetric& m : drive_figures) {
        s += metric_head(m.name, "gauge", m.help);
        for (std::size_t i = 0; i < drives.size(); ++i)
            s += fmt::format("{}{{drive=\"{}\"}} {}\n", m.name, site.site.drives[i].name, m.value(drives[i]));
    }
    return s;
}
}  // namespace

std::string WarmStatus::hot_metrics() const {
    std::string s;
    const auto head = [&](std::string_view name, std::string_view type, std::string_view help) { s += metric_head(name, type, help); };
    const auto spread = [&](std::string_view name, std::string_view help, const Histogram& h) {
        const auto reading = h.read();
        s += metric_head(name, "histogram", help) + metric_lines(name, reading);
        return reading;
    };
    head("axisgate_hot_turns_total", "counter", "Turns of the hot loop.");
    s += fmt::format("axisgate_hot_turns_total {}\n", threads_.hot.turns().counted());
    const auto turns = spread("axisgate_hot_turn_seconds", "Work of the hot loop between two sleeps.", threads_.hot.turns().times());
    head("axisgate_hot_turn_p999_seconds", "gauge", "99.9 % of all turns of the hot loop took no longer.");
    s += fmt::format("axisgate_hot_turn_p999_seconds {:.9f}\n", turns.quantile(0.999));
    (void)spread("axisgate_hot_wake_delay_seconds", "How long after its time a timer of the hot loop rang.",
                 threads_.hot.turns().wake_delays());
    (void)spread("axisgate_write_to_frame_seconds",
                 "From a command's being taken to its first frame having left on a real line (one command per line at a time is measured).",
                 threads_.hot.write_to_frame());
    (void)spread("axisgate_store_batch_seconds", "Transactions written to the database.", threads_.cold.batch_times());
    return s;
}

std::string WarmStatus::queue_metrics() const {
    std::string s;
    const auto head = [&](std::string_view name, std::string_view type, std::string_view help) { s += metric_head(name, type, help); };
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
    return s;
}

std::string WarmStatus::metrics() const {
    std::string s;
    const auto head = [&](std::string_view name, std::string_view type, std::string_view help) { s += metric_head(name, type, help); };
    head("axisgate_build_info", "gauge", "Version of the program.");
    s += fmt::format("axisgate_build_info{{version=\"{}\"}} 1\n", AXISGATE_VERSION);
    head("axisgate_uptime_seconds", "gauge", "Time since the start.");
    s += fmt::format("axisgate_uptime_seconds {:.3f}\n", uptime_s());
    head("axisgate_mapping_info", "gauge", "Revision of the register mapping (register 18).");
    s += fmt::format("axisgate_mapping_info{{revision=\"{:08x}\"}} 1\n", mapping_revision(site_.site()->site));
    s += process_metrics();
    s += hot_metrics() + queue_metrics();
    const auto reports = threads_.hot.reports();
    head("axisgate_fail_safe_total", "counter", "Axes that were stopped because the client that commanded them was lost, by cause.");
    for (const LossCause cause : loss_causes())
        s += fmt::format("axisgate_fail_safe_total{{cause=\"{}\"}} {}\n", name_of(cause), reports->losses[static_cast<std::size_t>(cause)]);
    const auto& site = *site_.site();
    s += line_metrics(site, *reports);
    // Read once, so that the values of one answer fit together.
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
    s += drive_metrics(site, drives);
    s += axis_metrics(site, pictures, monotonic_now());
    if (door_metrics) s += door_metrics();
    return s;
}

}  // namespace axisgate
