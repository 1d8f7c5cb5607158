// Configuration of this host: the TOML file, environment and --set, as one checked value.
// In: text of the file, environment entries, overrides. Out: Config, or all faults at once with place and remedy.
// Never opens anything that it names.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/line_uri.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

struct Config {
    std::string data_dir = "./var";            ///< [data] dir
    std::string http_bind = "127.0.0.1:8080";  ///< [http] bind; empty: no HTTP door
    std::string http_tls_cert, http_tls_key;   ///< [http] tls_cert, tls_key
    bool http_tls_self_signed = false;  ///< [http] tls = "off" | "self_signed": a certificate of our own making, in the data directory
    /// [http] allowed_hosts: names of this host beside its addresses and localhost; others get 421.
    std::vector<std::string> http_allowed_hosts;
    std::string modbus_bind = "127.0.0.1:1502";  ///< [modbus] bind; empty: no Modbus/TCP door
    bool modbus_low_word_first = false;          ///< [modbus] word_order = "high_first" | "low_first"
    std::int64_t modbus_watchdog_ms = 5000;      ///< [modbus] watchdog_ms, 0..600000; 0: a silent client is not watched
    std::int64_t modbus_idle_timeout_s = 60;     ///< [modbus] idle_timeout_s, 1..86400
    std::int64_t modbus_max_connections = 1024;  ///< [modbus] max_connections, 1..8192
    std::vector<std::string> modbus_allow;       ///< [modbus] allow: addresses and networks that may connect; empty: all
    std::vector<std::string> modbus_functions;   ///< [modbus] functions: function codes that are served; empty: all
    bool modbus_read_only = false;               ///< [modbus] read_only: writes but a pure stop get exception 1
    MapGaps modbus_gaps = MapGaps::zero;         ///< [modbus] gaps = "zero" | "refuse": reads of user maps where nothing is mapped
    std::int64_t authority_lease_s = 30;         ///< [authority] lease_s, 1..3600: how long a command holds an axis of mode "lease"
    std::string lines_pty_dir = "/tmp";          ///< [lines] pty_dir: folder below which a site's pty: lines may put their links
    std::string enip_bind = "127.0.0.1:44818";   ///< [enip] bind, IPv4, TCP and UDP; empty: no EtherNet/IP door
    bool enip_bind_named = false;                ///< somebody chose it: then a port that is taken is a fault
    std::int64_t enip_io_port = 2222;            ///< [enip] io_port, 0..65535: UDP, implicit data; originators use 2222 unless told
    bool enip_io_port_named = false;             ///< as enip_bind_named
    bool dds_enabled = false;                    ///< [dds] enabled
    std::int64_t dds_domain = 0;                 ///< [dds] domain, 0..232
    std::string dds_partition = "plant";         ///< [dds] partition: gateways of another one see nothing of this one
    std::string dds_name;                        ///< [dds] name of this gateway in the domain, 1..63 bytes; empty: the host's name
    std::string dds_interface = "lo";            ///< [dds] interface: network interface; lo: this machine alone
    std::string dds_security;        ///< [dds] security: folder made by `axisgate pki`; empty: off, everybody in the domain is believed
    std::string log_level = "info";  ///< [log] level: trace debug info warning error off
    std::string log_file;            ///< [log] file; empty: standard error
    std::int64_t spin_us = 0;        ///< [runtime] spin_us, 0..1000: how long the hot loop polls before it sleeps
    std::int64_t hot_cpu = -1;       ///< [runtime] hot_cpu: processor for the hot loop; -1: any
    std::int64_t max_http_connections = 512;  ///< [limits] http_connections
    /// [users] local_role: of requests from this machine without a sign-in; none: sign in always, as behind a proxy.
    std::string users_local_role = "engineer";
    std::int64_t users_session_idle_min = 60;  ///< [users] session_idle_min, 1..1440
    std::int64_t users_session_max_h = 12;     ///< [users] session_max_h, 1..720
    bool users_new_code = false;               ///< [users] new_code: print another code for the first sign-in, while there is no user
    std::int64_t trace_frames = 4096;          ///< [limits] trace_frames per line
    std::int64_t recorder_trend_minutes = 10;  ///< [recorder] trend_minutes, 1..1440
    std::int64_t recorder_trend_mb = 48;       ///< [recorder] trend_mb, 1..4096: memory of the trends of all axes
    std::int64_t recorder_stretch_mb = 32;     ///< [recorder] stretch_mb, 1..1024: memory of the stretch that can be frozen
    std::int64_t recorder_inputs_mb = 32;      ///< [recorder] inputs_mb, 0..1024: of the inputs since the start, for replay
    std::int64_t recorder_disk_mb = 512;       ///< [recorder] disk_mb, 1..1000000: of all recordings
    /// [recorder] trend_disk_mb, 0..100000: of the trends on the disk; 0: in memory alone; none: 200, of the axes alone that the site marks
    std::optional<std::int64_t> recorder_trend_disk_mb;
    std::int64_t recorder_captures_mb = 64;    ///< [recorder] captures_mb, 1..100000: of all captures, on the disk
    std::string recorder_freeze_on = "fault";  ///< [recorder] freeze_on: kinds of alarms, with commas; empty: none
    /// [modbus_rtu] port: path of a serial port, or the URI of a byte line (serial:, tcp:, tcp-listen:, pty:); empty: no Modbus RTU door
    std::string modbus_rtu_port;
    std::int64_t modbus_rtu_baud = 19200;   ///< [modbus_rtu] baud, 50..12000000 bit/s, where the URI does not say
    std::string modbus_rtu_format = "8E1";  ///< [modbus_rtu] format, 8 data bits, where the URI does not say
    std::int64_t modbus_rtu_unit = 1;       ///< [modbus_rtu] unit, 1..247: slave address of this gateway
};

struct ConfigFault {
    std::string place;  ///< "axisgate.toml:12", "--set http.bind", "AXISGATE_HTTP_BIND"
    std::string text;
    std::string remedy;
    bool warning = false;  ///< `serve` goes on without it
};

struct ConfigSources {
    std::string file_name;  ///< for messages; empty: no file was given
    std::optional<std::string> file_text;
    std::vector<std::string> environment;  ///< "AXISGATE_HTTP_BIND=..." entries; others are ignored
    std::vector<std::string> overrides;    ///< "section.key=value" of --set, strongest
};

/// Reads all sources. Unknown sections, keys and values are faults.
[[nodiscard]] Config read_config(const ConfigSources& sources, std::vector<ConfigFault>& faults);

/// The serial port of the Modbus RTU door.
struct RtuPort {
    bool used = false;
    LineUri uri;
    std::string name;        ///< for people: "/dev/ttyUSB0"; of other kinds of line the URI without options
    std::uint32_t baud = 0;  ///< bit/s, for the silence between frames; also where the line itself has no rate
    SerialFormat format;
    std::string fault;  ///< why it cannot be, and what would be right
};
[[nodiscard]] RtuPort rtu_port(const Config& config);

/// "HOST:PORT" or "[V6]:PORT" taken apart; nothing if it is not one.
struct HostPort {
    std::string host;
    std::uint16_t port = 0;
};
[[nodiscard]] std::optional<HostPort> parse_host_port(std::string_view text);

}  // namespace axisgate
