// Configuration: one table of keys serves the file, the environment and --set.
// In: texts. Out: values, or faults with file, line and remedy. Never stops at the first fault.
#include "gateway/runtime/config.hpp"

// The library asserts what hostile text makes untrue ("[*x]"), and in a release build tells the compiler that it holds. It checks the same
// again in plain code and reports it: its assertions are left out, and so is what a release build makes of them.
#ifdef NDEBUG
#undef NDEBUG
#endif
#define TOML_ASSERT(expr) static_cast<void>(0)
#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <functional>

#include "gateway/doors/http/hosts.hpp"
#include "gateway/doors/modbus/access.hpp"

namespace axisgate {
namespace {
using Fault = std::optional<std::string>;  // the remedy, if the text cannot be the value

/// What a value may be written as in TOML: a number in place of a text is a slip ("port = 5"), and not the text "5".
enum class Written : std::uint8_t { as_text, as_number, as_switch, as_list };

struct Key {
    std::string_view section, name;
    Fault (*set)(Config&, const std::string&);
    Written written = Written::as_text;
};

Fault set_integer(std::int64_t& into, const std::string& s, std::int64_t low, std::int64_t high) {
    std::int64_t v = 0;
    const auto [p, ec] = std::from_chars(s.data(), s.data() + s.size(), v);
    if (ec != std::errc{} || p != s.data() + s.size() || v < low || v > high)
        return fmt::format("write a whole number from {} to {}", low, high);
    into = v;
    return {};
}
Fault set_bool(bool& into, const std::string& s) {
    if (s == "true" || s == "1" || s == "on") {
        into = true;
    } else if (s == "false" || s == "0" || s == "off") {
        into = false;
    } else {
        return "write true or false";
    }
    return {};
}
Fault set_bind(std::string& into, const std::string& s) {
    if (!s.empty() && s != "off" && !parse_host_port(s)) return "write HOST:PORT, such as 127.0.0.1:1502 or [::1]:1502, or off";
    into = s == "off" ? "" : s;
    return {};
}
Fault set_text(std::string& into, const std::string& s) {
    into = s;
    return {};
}

/// A name that is also a step of a path, and for a partition no pattern: DDS takes * and ? for wildcards.
Fault set_dds_name(std::string& into, const std::string& s) {
    const auto good = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    };
    if (s.empty() || s.size() > 63 || s == "." || s == ".." || !std::ranges::all_of(s, good))
        return "write 1 to 63 letters, digits, - _ or .";
    into = s;
    return {};
}

std::string_view without_blanks(std::string_view s) {
    const auto first = s.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view() : s.substr(first, s.find_last_not_of(" \t") + 1 - first);
}

std::vector<std::string> split_list(const std::string& s) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < s.size();) {
        const auto comma = std::min(s.find(',', i), s.size());
        if (const auto one = without_blanks(std::string_view(s).substr(i, comma - i)); !one.empty()) out.emplace_back(one);
        i = comma + 1;
    }
    return out;
}

/// A list as the file has it, ["a", "b"], in the form with bare commas; any other text as it is, also [::1],[::2]. A shell may have eaten
/// the quotes.
std::string bare_list(const std::string& text) {
    std::string_view s = without_blanks(text);
    if (s.size() < 2 || s.front() != '[' || s.back() != ']') return text;
    s = s.substr(1, s.size() - 2);
    std::string out;
    for (bool more = true; more;) {
        const auto comma = std::min(s.find(','), s.size());
        auto one = without_blanks(s.substr(0, comma));
        more = comma < s.size();
        s.remove_prefix(std::min(comma + 1, s.size()));
        const bool quoted = one.size() >= 2 && (one.front() == '"' || one.front() == '\'') && one.back() == one.front();
        if (quoted) one = one.substr(1, one.size() - 2);
        if (one.find_first_of(quoted ? "\"'" : "\"'[]") != std::string_view::npos) return text;
        if (!one.empty()) out += (out.empty() ? "" : ",") + std::string(one);
    }
    return out;
}

const Key keys[] = {
        {"data", "dir",
         [](Config& c, const std::string& s) -> Fault { return s.empty() ? Fault("name a directory") : set_text(c.data_dir, s); }},
        {"http", "bind", [](Config& c, const std::string& s) { return set_bind(c.http_bind, s); }},
        {"http", "tls_cert", [](Config& c, const std::string& s) { return set_text(c.http_tls_cert, s); }},
        {"http", "tls_key", [](Config& c, const std::string& s) { return set_text(c.http_tls_key, s); }},
        {"http", "tls",
         [](Config& c, const std::string& s) -> Fault {
             if (s != "off" && s != "self_signed") return "write off or self_signed; certificates of your own are tls_cert and tls_key";
             c.http_tls_self_signed = s == "self_signed";
             return {};
         }},
        {"users", "local_role",
         [](Config& c, const std::string& s) -> Fault {
             for (const auto* r : {"none", "viewer", "operator", "engineer", "administrator"}) {
                 if (s == r) return set_text(c.users_local_role, s);
             }
             return "write none, viewer, operator, engineer or administrator";
         }},
        {"users", "session_idle_min", [](Config& c, const std::string& s) { return set_integer(c.users_session_idle_min, s, 1, 1440); },
         Written::as_number},
        {"users", "session_max_h", [](Config& c, const std::string& s) { return set_integer(c.users_session_max_h, s, 1, 720); },
         Written::as_number},
        {"users", "new_code", [](Config& c, const std::string& s) { return set_bool(c.users_new_code, s); }, Written::as_switch},
        {"http", "allowed_hosts",
         [](Config& c, const std::string& s) -> Fault {
             c.http_allowed_hosts = split_list(s);
             const auto is_name = [](const std::string& one) {
                 return http::host_is_written_right(one) && (one.ends_with(']') || one.find(':') == std::string::npos);
             };
             if (std::ranges::all_of(c.http_allowed_hosts, is_name)) return {};
             return "write names without scheme, port and path, such as [\"axisgate.example\"]";
         },
         Written::as_list},
        {"modbus", "bind", [](Config& c, const std::string& s) { return set_bind(c.modbus_bind, s); }},
        {"modbus", "word_order",
         [](Config& c, const std::string& s) -> Fault {
             if (s != "high_first" && s != "low_first") return "write high_first or low_first";
             c.modbus_low_word_first = s == "low_first";
             return {};
         }},
        {"modbus", "gaps",
         [](Config& c, const std::string& s) -> Fault {
             const auto gaps = map_gaps_named(s);
             if (!gaps) return "write zero or refuse";
             c.modbus_gaps = *gaps;
             return {};
         }},
        {"modbus", "idle_timeout_s", [](Config& c, const std::string& s) { return set_integer(c.modbus_idle_timeout_s, s, 1, 86400); },
         Written::as_number},
        {"modbus", "watchdog_ms", [](Config& c, const std::string& s) { return set_integer(c.modbus_watchdog_ms, s, 0, 600'000); },
         Written::as_number},
        {"modbus", "max_connections", [](Config& c, const std::string& s) { return set_integer(c.modbus_max_connections, s, 1, 8192); },
         Written::as_number},
        {"modbus", "allow",
         [](Config& c, const std::string& s) -> Fault {
             c.modbus_allow = split_list(s);
             for (const auto& one : c.modbus_allow) {
                 if (!modbus::parse_network(one))
                     return "write addresses or networks, such as [\"127.0.0.0/8\", \"192.168.1.20\", \"fd00::/8\"]";
             }
             return {};
         },
         Written::as_list},
        {"modbus", "functions",
         [](Config& c, const std::string& s) -> Fault {
             c.modbus_functions = split_list(s);
             for (const auto& one : c.modbus_functions) {
                 std::int64_t ignored = 0;
                 if (set_integer(ignored, one, 1, 127)) return "write function codes from 1 to 127, such as [3, 4, 6, 16]";
             }
             return {};
         },
         Written::as_list},
        {"modbus", "read_only", [](Config& c, const std::string& s) { return set_bool(c.modbus_read_only, s); }, Written::as_switch},
        {"authority", "lease_s", [](Config& c, const std::string& s) { return set_integer(c.authority_lease_s, s, 1, 3600); },
         Written::as_number},
        {"lines", "pty_dir",
         [](Config& c, const std::string& s) -> Fault {
             return s.starts_with('/') ? set_text(c.lines_pty_dir, s) : Fault("name a folder by its whole path, such as /run/axisgate");
         }},
        {"modbus_rtu", "port", [](Config& c, const std::string& s) { return set_text(c.modbus_rtu_port, s == "off" ? "" : s); }},
        {"modbus_rtu", "baud",
         [](Config& c, const std::string& s) {
             return set_integer(c.modbus_rtu_baud, s, SerialSettings::min_baud, SerialSettings::max_baud);
         },
         Written::as_number},
        {"modbus_rtu", "format",
         [](Config& c, const std::string& s) -> Fault {
             const auto format = parse_serial_format(s);
             if (!format || format->data_bits != 8) return "write 8E1, 8O1, 8N1 or 8N2: Modbus RTU has 8 data bits";
             return set_text(c.modbus_rtu_format, s);
         }},
        {"modbus_rtu", "unit", [](Config& c, const std::string& s) { return set_integer(c.modbus_rtu_unit, s, 1, 247); },
         Written::as_number},
        {"enip", "bind",
         [](Config& c, const std::string& s) {
             c.enip_bind_named = true;
             return set_bind(c.enip_bind, s);
         }},
        {"enip", "io_port",
         [](Config& c, const std::string& s) {
             c.enip_io_port_named = true;
             return set_integer(c.enip_io_port, s, 0, 65535);
         },
         Written::as_number},
        {"dds", "enabled", [](Config& c, const std::string& s) { return set_bool(c.dds_enabled, s); }, Written::as_switch},
        {"dds", "domain", [](Config& c, const std::string& s) { return set_integer(c.dds_domain, s, 0, 232); }, Written::as_number},
        {"dds", "partition", [](Config& c, const std::string& s) { return set_dds_name(c.dds_partition, s); }},
        {"dds", "name", [](Config& c, const std::string& s) { return set_dds_name(c.dds_name, s); }},
        {"dds", "interface", [](Config& c, const std::string& s) { return set_dds_name(c.dds_interface, s); }},
        {"dds", "security", [](Config& c, const std::string& s) { return set_text(c.dds_security, s == "off" ? "" : s); }},
        {"log", "level",
         [](Config& c, const std::string& s) -> Fault {
             for (const auto* l : {"trace", "debug", "info", "warning", "error", "off"}) {
                 if (s == l) return set_text(c.log_level, s);
             }
             return "write trace, debug, info, warning, error or off";
         }},
        {"log", "file", [](Config& c, const std::string& s) { return set_text(c.log_file, s); }},
        {"runtime", "spin_us", [](Config& c, const std::string& s) { return set_integer(c.spin_us, s, 0, 1000); }, Written::as_number},
        {"runtime", "hot_cpu", [](Config& c, const std::string& s) { return set_integer(c.hot_cpu, s, -1, 1023); }, Written::as_number},
        {"limits", "http_connections", [](Config& c, const std::string& s) { return set_integer(c.max_http_connections, s, 1, 8192); },
         Written::as_number},
        {"limits", "trace_frames", [](Config& c, const std::string& s) { return set_integer(c.trace_frames, s, 64, 1'000'000); },
         Written::as_number},
        {"recorder", "trend_minutes", [](Config& c, const std::string& s) { return set_integer(c.recorder_trend_minutes, s, 1, 1440); },
         Written::as_number},
        {"recorder", "trend_mb", [](Config& c, const std::string& s) { return set_integer(c.recorder_trend_mb, s, 1, 4096); },
         Written::as_number},
        {"recorder", "stretch_mb", [](Config& c, const std::string& s) { return set_integer(c.recorder_stretch_mb, s, 1, 1024); },
         Written::as_number},
        {"recorder", "inputs_mb", [](Config& c, const std::string& s) { return set_integer(c.recorder_inputs_mb, s, 0, 1024); },
         Written::as_number},
        {"recorder", "disk_mb", [](Config& c, const std::string& s) { return set_integer(c.recorder_disk_mb, s, 1, 1'000'000); },
         Written::as_number},
        {"recorder", "trend_disk_mb",
         [](Config& c, const std::string& s) { return set_integer(c.recorder_trend_disk_mb.emplace(), s, 0, 100'000); },
         Written::as_number},
        {"recorder", "captures_mb", [](Config& c, const std::string& s) { return set_integer(c.recorder_captures_mb, s, 1, 100'000); },
         Written::as_number},
        {"recorder", "freeze_on", [](Config& c, const std::string& s) { return set_text(c.recorder_freeze_on, s); }},
};

std::string known_names(std::string_view section) {
    std::string s;
    for (const auto& k : keys) {
        if (section.empty()) {
            const std::string name = fmt::format("[{}]", k.section);
            if (s.find(name) == std::string::npos) s += (s.empty() ? "" : " ") + name;
        } else if (k.section == section) {
            s += (s.empty() ? "" : ", ") + std::string(k.name);
        }
    }
    return s;
}

const Key* find_key(std::string_view section, std::string_view name) {
    for (const auto& k : keys) {
        if (k.section == section && k.name == name) return &k;
    }
    return nullptr;
}

/// What to write, if the value is written as something that this key never is.
Fault wrong_kind(const toml::node& node, Written written) {
    if (written == Written::as_text && !node.is_string()) return "write a text in double quotes";
    if (written == Written::as_list && !node.is_array() && !node.is_string()) return "write a list in square brackets";
    return {};
}

std::optional<std::string> text_of(const toml::node& node) {
    if (const auto* s = node.as_string()) return s->get();
    if (const auto* i = node.as_integer()) return std::to_string(i->get());
    if (const auto* b = node.as_boolean()) return b->get() ? "true" : "false";
    if (const auto* a = node.as_array()) {
        std::string s;
        for (const auto& x : *a) {
            const auto* t = x.as_string();
            const auto* n = x.as_integer();
            if (!t && !n) return std::nullopt;
            s += (s.empty() ? "" : ",") + (t ? t->get() : std::to_string(n->get()));
        }
        return s;
    }
    return std::nullopt;
}

bool has_foreign(std::string_view text) {
    return std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) >= 0x80; });
}

/// Whether a line with letters beyond ASCII is one that the TOML library reads without looking such a letter up as white space or as a part
/// of a key, which it does not do safely: a comment, or `key = "..."` or `key = ["...", "..."]` with all of them inside the quotes.
bool foreign_letters_are_quoted(std::string_view line) {
    const auto skip = [&](auto&& wanted) {
        while (!line.empty() && wanted(line.front()))
            line.remove_prefix(1);
    };
    const auto blank = [](char c) { return c == ' ' || c == '\t'; };
    // Strings of several lines begin so, and an empty string beside another would be taken for them.
    if (line.find("'''") != std::string_view::npos || line.find("\"\"\"") != std::string_view::npos) return false;
    skip(blank);
    if (!line.starts_with('#')) {
        const std::size_t before = line.size();
        skip([](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; });
        if (line.size() == before) return false;
        skip(blank);
        if (!line.starts_with('=')) return false;
        line.remove_prefix(1);
        while (!line.empty() && line.front() != '#') {
            const char quote = line.front();
            line.remove_prefix(1);
            if (quote == '"' || quote == '\'') {
                while (!line.empty() && line.front() != quote)
                    line.remove_prefix(quote == '"' && line.front() == '\\' && line.size() > 1 ? 2 : 1);
                if (line.empty()) return false;
                line.remove_prefix(1);
            } else if (!blank(quote) && quote != '[' && quote != ',' && quote != ']' && quote != '\r') {
                return false;
            }
        }
    }
    return true;
}

/// Line of the first letter beyond ASCII that stands where it must not; 0: there is none.
std::size_t line_of_foreign_letter(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        const std::string_view line = text.substr(0, end);
        if (has_foreign(line) && !foreign_letters_are_quoted(line)) return number;
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return 0;
}

/// Where each value that counts was written.
using Places = std::map<const Key*, std::string>;

void read_config_file(Config& c, const ConfigSources& sources, Places& places, std::vector<ConfigFault>& faults) {
    const auto place = [&](const toml::source_region& r) { return fmt::format("{}:{}", sources.file_name, r.begin.line); };
    // TOML knows no control characters but tab and line ends, and the parser does not take NUL as a fault but as a reason to end.
    for (std::size_t i = 0, line = 1; i < sources.file_text->size(); ++i) {
        const auto byte = static_cast<unsigned char>((*sources.file_text)[i]);
        line += byte == '\n';
        if ((byte >= 0x20 && byte != 0x7F) || byte == '\t' || byte == '\n' || byte == '\r') continue;
        faults.push_back({fmt::format("{}:{}", sources.file_name, line),
                          fmt::format("the line has the control character {:02X} in it", byte), "write the line again as plain text"});
        return;
    }
    if (const std::size_t line = line_of_foreign_letter(*sources.file_text)) {
        faults.push_back({fmt::format("{}:{}", sources.file_name, line), "the line has a letter beyond ASCII outside of quotes",
                          "keys are plain ASCII; put texts in double quotes"});
        return;
    }
    const toml::parse_result parsed = toml::parse(*sources.file_text, std::string_view(sources.file_name));
    if (!parsed) {
        faults.push_back(
            {place(parsed.error().source()), std::string(parsed.error().description()), "mend the line; strings stand in double quotes"});
        return;
    }
    for (const auto& [section, node] : parsed.table()) {
        const auto* table = node.as_table();
        const std::string names = known_names(section.str());
        if (!table || names.empty()) {
            faults.push_back({place(node.source()), fmt::format("[{}] is not a section", section.str()), "sections: " + known_names("")});
            continue;
        }
        for (const auto& [name, value] : *table) {
            const Key* key = find_key(section.str(), name.str());
            if (!key) {
                faults.push_back({place(value.source()), fmt::format("[{}] has no key {}", section.str(), name.str()), "keys: " + names});
                continue;
            }
            const auto text = text_of(value);
            const auto kind = wrong_kind(value, key->written);
            const Fault fault = !text ? Fault("write a text, a number, true or false") : kind ? kind : key->set(c, *text);
            if (!fault) places[key] = place(value.source());
            if (fault)
                faults.push_back({place(value.source()),
                                  fmt::format("{}.{}: {} is not possible", section.str(), name.str(), text.value_or("this value")),
                                  *fault});
        }
    }
}
}  // namespace

std::optional<HostPort> parse_host_port(std::string_view text) {
    const auto colon = text.rfind(':');
    if (colon == std::string_view::npos || colon == 0) return std::nullopt;
    std::string_view host = text.substr(0, colon), port = text.substr(colon + 1);
    if (host.front() == '[') {
        if (host.size() < 3 || host.back() != ']') return std::nullopt;
        host = host.substr(1, host.size() - 2);
    } else if (host.find(':') != std::string_view::npos) {
        return std::nullopt;
    }
    std::uint32_t n = 0;
    const auto [p, ec] = std::from_chars(port.data(), port.data() + port.size(), n);
    if (port.empty() || ec != std::errc{} || p != port.data() + port.size() || n > 65535) return std::nullopt;
    return HostPort{std::string(host), static_cast<std::uint16_t>(n)};
}

Config read_config(const ConfigSources& sources, std::vector<ConfigFault>& faults) {
    Config c;
    Places places;
    if (sources.file_text) read_config_file(c, sources, places, faults);
    const auto apply = [&](std::string_view section, std::string_view name, const std::string& value, const std::string& place) {
        const Key* key = find_key(section, name);
        if (!key) {
            const std::string names = known_names(section);
            faults.push_back({place, fmt::format("there is no key {}.{}", section, name),
                              names.empty() ? "sections: " + known_names("") : "keys: " + names});
            return;
        }
        if (const Fault fault = key->set(c, key->written == Written::as_list ? bare_list(value) : value))
            faults.push_back({place, fmt::format("{}.{}: \"{}\" is not possible", section, name, value), *fault});
        else
            places[key] = place;
    };
    for (const auto& entry : sources.environment) {
        constexpr std::string_view prefix = "AXISGATE_";
        const auto equals = entry.find('=');
        if (!entry.starts_with(prefix) || equals == std::string::npos) continue;
        std::string name = entry.substr(prefix.size(), equals - prefix.size());
        std::ranges::transform(name, name.begin(), [](unsigned char x) { return static_cast<char>(std::tolower(x)); });
        // The longest section that fits: "modbus_rtu_port" is [modbus_rtu] port, not [modbus] rtu_port.
        const Key* best = nullptr;
        for (const auto& k : keys) {
            if (name == fmt::format("{}_{}", k.section, k.name)) best = &k;
        }
        if (!best) continue;  // other programs of the house may use the prefix too
        apply(best->section, best->name, entry.substr(equals + 1), entry.substr(0, equals));
    }
    for (const auto& o : sources.overrides) {
        const auto equals = o.find('=');
        const auto dot = o.find('.');
        if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
            faults.push_back({"--set " + o, "this is not section.key=value", "write for example --set http.bind=127.0.0.1:8081"});
            continue;
        }
        apply(o.substr(0, dot), o.substr(dot + 1, equals - dot - 1), o.substr(equals + 1), "--set " + o.substr(0, equals));
    }
    if (const RtuPort port = rtu_port(c); !port.fault.empty()) {
        faults.push_back({places[find_key("modbus_rtu", "port")], "modbus_rtu.port: " + port.fault,
                          "write the path of a serial port, such as /dev/ttyUSB0, or off"});
    }
    if (c.http_tls_cert.empty() != c.http_tls_key.empty()) {
        faults.push_back({sources.file_name.empty() ? "configuration" : sources.file_name, "http.tls_cert and http.tls_key go together",
                          "give both or none"});
    }
    if (c.http_tls_self_signed && !c.http_tls_cert.empty()) {
        faults.push_back({sources.file_name.empty() ? "configuration" : sources.file_name,
                          "http.tls = self_signed and http.tls_cert are both there", "leave one of them out"});
    }
    return c;
}

RtuPort rtu_port(const Config& c) {
    RtuPort r;
    if (c.modbus_rtu_port.empty()) return r;
    r.used = true;
    const bool is_path = c.modbus_rtu_port.starts_with('/');
    const LineUriResult parsed = parse_line_uri(is_path ? "serial:" + c.modbus_rtu_port : c.modbus_rtu_port,
                                                static_cast<std::uint32_t>(c.modbus_rtu_baud), c.modbus_rtu_format);
    r.uri = parsed.uri;
    r.name = c.modbus_rtu_port.substr(0, c.modbus_rtu_port.find('?'));
    if (r.name.starts_with("serial:")) r.name = r.uri.path;
    r.fault = parsed.fault;
    if (!r.fault.empty()) return r;
    using Kind = LineUri::Kind;
    const bool says_rate = r.uri.kind == Kind::serial || (r.uri.kind == Kind::pty && r.uri.serial.baud != 0);
    r.baud = says_rate ? r.uri.serial.baud : static_cast<std::uint32_t>(c.modbus_rtu_baud);
    r.format = says_rate ? r.uri.serial.format : parse_serial_format(c.modbus_rtu_format).value_or(SerialFormat{});
    if (r.uri.kind == Kind::can || r.uri.kind == Kind::twin || r.uri.kind == Kind::udp || r.uri.kind == Kind::udp_listen) {
        r.fault = "Modbus RTU needs a line that carries bytes in order";
    } else if (r.format.data_bits != 8) {
        r.fault = "Modbus RTU has 8 data bits";
    }
    return r;
}

}  // namespace axisgate
