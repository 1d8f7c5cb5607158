// The configuration of this host: the TOML file, environment and --set as one checked value, or all faults at once with place and remedy.
// No file that the configuration names is opened here.
#pragma once

#include <any>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

struct DoorDescriptor;

/// The settings of the gateway. Each door has settings of its own type, which its keys fill.
struct Config {
    std::string data_dir = "./var";       ///< [data] dir
    bool low_word_first = false;          ///< [modbus] word_order = "high_first" | "low_first": of the registers, for all doors
    MapGaps map_gaps = MapGaps::zero;     ///< [modbus] gaps = "zero" | "refuse": the answer to reads of unmapped registers in user maps
    std::int64_t watchdog_ms = 5000;      ///< [modbus] watchdog_ms, 0..600000; 0: no monitoring of silence. For all doors
    std::int64_t authority_lease_s = 30;  ///< [authority] lease_s, 1..3600: how long a command reserves an axis of mode "lease"
    std::string lines_pty_dir = "/tmp";   ///< [lines] pty_dir: folder below which a site's pty: lines may put their links
    std::string log_level = "info";       ///< [log] level: trace debug info warning error off
    std::string log_file;                 ///< [log] file; empty: standard error
    std::int64_t spin_us = 0;             ///< [runtime] spin_us, 0..1000: how long the hot loop polls before it sleeps
    std::int64_t hot_cpu = -1;            ///< [runtime] hot_cpu: processor for the hot loop; -1: any
    /// [users] local_role: role of requests from this computer without a sign-in; none: a sign-in is always necessary, for example behind a
    /// proxy.
    std::string users_local_role = "engineer";
    std::int64_t users_session_idle_min = 60;  ///< [users] session_idle_min, 1..1440
    std::int64_t users_session_max_h = 12;     ///< [users] session_max_h, 1..720
    bool users_new_code = false;               ///< [users] new_code: print another code for the first sign-in, as long as there is no user
    std::int64_t trace_frames = 4096;          ///< [limits] trace_frames per line
    std::int64_t recorder_trend_minutes = 10;  ///< [recorder] trend_minutes, 1..1440
    std::int64_t recorder_trend_mb = 48;       ///< [recorder] trend_mb, 1..4096: memory of the trends of all axes
    std::int64_t recorder_stretch_mb = 32;     ///< [recorder] stretch_mb, 1..1024: memory of the stretch that can be frozen
    std::int64_t recorder_inputs_mb = 32;      ///< [recorder] inputs_mb, 0..1024: of the inputs since the start, for replay
    std::int64_t recorder_disk_mb = 512;       ///< [recorder] disk_mb, 1..1000000: of all recordings
    /// [recorder] trend_disk_mb, 0..100000: of the trends on the disk; 0: in memory only; empty: 200, and only of axes that the site marks
    std::optional<std::int64_t> recorder_trend_disk_mb;
    std::int64_t recorder_captures_mb = 64;    ///< [recorder] captures_mb, 1..100000: of all captures, on the disk
    std::string recorder_freeze_on = "fault";  ///< [recorder] freeze_on: kinds of alarms, with commas; empty: none

    /// The settings of a door, by their type; default-constructed if no key has set one.
    template <class Settings>
    [[nodiscard]] const Settings& of() const {
        static const Settings by_default{};
        const auto found = of_doors.find(std::type_index(typeid(Settings)));
        return found == of_doors.end() ? by_default : *std::any_cast<Settings>(&found->second);
    }
    template <class Settings>
    [[nodiscard]] Settings& of() {
        std::any& kept = of_doors[std::type_index(typeid(Settings))];
        if (!kept.has_value()) kept.emplace<Settings>();
        return *std::any_cast<Settings>(&kept);
    }
    std::map<std::type_index, std::any> of_doors;
};

struct ConfigFault {
    std::string place;  ///< "axisgate.toml:12", "--set http.bind", "AXISGATE_HTTP_BIND"
    std::string text;
    std::string remedy;
    bool warning = false;  ///< `serve` starts in spite of it
};

struct ConfigSources {
    std::string file_name;  ///< for messages; empty: no file was given
    std::optional<std::string> file_text;
    std::vector<std::string> environment;  ///< "AXISGATE_HTTP_BIND=..." entries; others are ignored
    std::vector<std::string> overrides;    ///< "section.key=value" of --set, with the highest priority
};

/// Reads all sources. Unknown sections, keys and values are faults.
[[nodiscard]] Config read_config(const ConfigSources& sources, std::vector<ConfigFault>& faults);
/// The same with the given doors instead of the program's.
[[nodiscard]] Config read_config(const ConfigSources& sources, std::vector<ConfigFault>& faults,
                                 std::span<const DoorDescriptor* const> doors);

/// The parts of "HOST:PORT" or "[V6]:PORT"; empty if the text has another form.
struct HostPort {
    std::string host;
    std::uint16_t port = 0;
};
[[nodiscard]] std::optional<HostPort> parse_host_port(std::string_view text);

}  // namespace axisgate
