// One table of keys serves the file, the environment and --set. All faults are collected, each with file, line and remedy.
#include "gateway/runtime/config.hpp"

// The library asserts conditions that hostile text violates ("[*x]"); in a release build the assertion tells the compiler that the
// condition holds. The library checks the same again in plain code and reports it, so its assertions are removed.
#ifdef NDEBUG
#undef NDEBUG
#endif
#define TOML_ASSERT(expr) static_cast<void>(0)
#define TOML_EXCEPTIONS 0
#include <toml++/toml.h>

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "gateway/runtime/doors.hpp"

namespace axisgate {
namespace {
using setting::Key, setting::Unfit, setting::Written;

std::string_view without_blanks(std::string_view s) {
    const auto first = s.find_first_not_of(" \t");
    return first == std::string_view::npos ? std::string_view() : s.substr(first, s.find_last_not_of(" \t") + 1 - first);
}

/// A list in the form of the file, ["a", "b"], or with plain commas; any other text is unchanged, including [::1],[::2]. A shell may have
/// removed the quotes.
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

const Key own_keys[] = {
    {"data", "dir",
     [](Config& c, const std::string& s) -> Unfit { return s.empty() ? Unfit("name a directory") : setting::any_text(c.data_dir, s); }},
    {"users", "local_role",
     [](Config& c, const std::string& s) -> Unfit {
         for (const auto* r : {"none", "viewer", "operator", "engineer", "administrator"}) {
             if (s == r) return setting::any_text(c.users_local_role, s);
         }
         return "write none, viewer, operator, engineer or administrator";
     }},
    {"users", "session_idle_min",
     [](Config& c, const std::string& s) { return setting::whole_number(c.users_session_idle_min, s, 1, 1440); }, Written::as_number},
    {"users", "session_max_h", [](Config& c, const std::string& s) { return setting::whole_number(c.users_session_max_h, s, 1, 720); },
     Written::as_number},
    {"users", "new_code", [](Config& c, const std::string& s) { return setting::on_or_off(c.users_new_code, s); }, Written::as_switch},
    {"modbus", "word_order",
     [](Config& c, const std::string& s) -> Unfit {
         if (s != "high_first" && s != "low_first") return "write high_first or low_first";
         c.low_word_first = s == "low_first";
         return {};
     }},
    {"modbus", "gaps",
     [](Config& c, const std::string& s) -> Unfit {
         const auto gaps = map_gaps_named(s);
         if (!gaps) return "write zero or refuse";
         c.map_gaps = *gaps;
         return {};
     }},
    {"modbus", "watchdog_ms", [](Config& c, const std::string& s) { return setting::whole_number(c.watchdog_ms, s, 0, 600'000); },
     Written::as_number},
    {"authority", "lease_s", [](Config& c, const std::string& s) { return setting::whole_number(c.authority_lease_s, s, 1, 3600); },
     Written::as_number},
    {"lines", "pty_dir",
     [](Config& c, const std::string& s) -> Unfit {
         return s.starts_with('/') ? setting::any_text(c.lines_pty_dir, s)
                                   : Unfit("name a folder by its whole path, such as /run/axisgate");
     }},
    {"log", "level",
     [](Config& c, const std::string& s) -> Unfit {
         for (const auto* l : {"trace", "debug", "info", "warning", "error", "off"}) {
             if (s == l) return setting::any_text(c.log_level, s);
         }
         return "write trace, debug, info, warning, error or off";
     }},
    {"log", "file", [](Config& c, const std::string& s) { return setting::any_text(c.log_file, s); }},
    {"runtime", "spin_us", [](Config& c, const std::string& s) { return setting::whole_number(c.spin_us, s, 0, 1000); },
     Written::as_number},
    {"runtime", "hot_cpu", [](Config& c, const std::string& s) { return setting::whole_number(c.hot_cpu, s, -1, 1023); },
     Written::as_number},
    {"limits", "trace_frames", [](Config& c, const std::string& s) { return setting::whole_number(c.trace_frames, s, 64, 1'000'000); },
     Written::as_number},
    {"recorder", "trend_minutes",
     [](Config& c, const std::string& s) { return setting::whole_number(c.recorder_trend_minutes, s, 1, 1440); }, Written::as_number},
    {"recorder", "trend_mb", [](Config& c, const std::string& s) { return setting::whole_number(c.recorder_trend_mb, s, 1, 4096); },
     Written::as_number},
    {"recorder", "stretch_mb", [](Config& c, const std::string& s) { return setting::whole_number(c.recorder_stretch_mb, s, 1, 1024); },
     Written::as_number},
    {"recorder", "inputs_mb", [](Config& c, const std::string& s) { return setting::whole_number(c.recorder_inputs_mb, s, 0, 1024); },
     Written::as_number},
    {"recorder", "disk_mb", [](Config& c, const std::string& s) { return setting::whole_number(c.recorder_disk_mb, s, 1, 1'000'000); },
     Written::as_number},
    {"recorder", "trend_disk_mb",
     [](Config& c, const std::string& s) { return setting::whole_number(c.recorder_trend_disk_mb.emplace(), s, 0, 100'000); },
     Written::as_number},
    {"recorder", "captures_mb",
     [](Config& c, const std::string& s) { return setting::whole_number(c.recorder_captures_mb, s, 1, 100'000); }, Written::as_number},
    {"recorder", "freeze_on", [](Config& c, const std::string& s) { return setting::any_text(c.recorder_freeze_on, s); }},
};

/// The keys of the gateway and of the doors.
class Keys {
public:
    explicit Keys(std::span<const DoorDescriptor* const> doors) {
        for (const Key& k : own_keys)
            all_.push_back(&k);
        for (const DoorDescriptor* door : doors) {
            for (const Key& k : door->settings)
                all_.push_back(&k);
        }
    }
    /// The names of a section's keys; without a section, the names of all sections.
    [[nodiscard]] std::string names(std::string_view section) const {
        std::string s;
        for (const Key* k : all_) {
            if (section.empty()) {
                const std::string name = fmt::format("[{}]", k->section);
                if (s.find(name) == std::string::npos) s += (s.empty() ? "" : " ") + name;
            } else if (k->section == section) {
                s += (s.empty() ? "" : ", ") + std::string(k->name);
            }
        }
        return s;
    }
    [[nodiscard]] const Key* find(std::string_view section, std::string_view name) const {
        const auto it = std::ranges::find_if(all_, [&](const Key* k) { return k->section == section && k->name == name; });
        return it == all_.end() ? nullptr : *it;
    }
    /// Finds a key by its name in the environment: "modbus_rtu_port".
    [[nodiscard]] const Key* find_joined(std::string_view name) const {
        const Key* best = nullptr;
        for (const Key* k : all_) {
            if (name == fmt::format("{}_{}", k->section, k->name)) best = k;
        }
        return best;
    }

private:
    std::vector<const Key*> all_;
};

/// The remedy for a value of a kind that this key never has.
Unfit wrong_kind(const toml::node& node, Written written) {
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

/// Whether a line with characters beyond ASCII is one of those that the TOML library reads safely: a comment, or `key = "..."` or `key =
/// ["...", "..."]` with all such characters inside the quotes. Elsewhere it looks them up as white space or parts of a key, which is not
/// safe.
bool foreign_letters_are_quoted(std::string_view line) {
    const auto skip = [&](auto&& wanted) {
        while (!line.empty() && wanted(line.front()))
            line.remove_prefix(1);
    };
    const auto blank = [](char c) { return c == ' ' || c == '\t'; };
    // Multi-line strings begin like this, and an empty string beside another could be taken for their beginning.
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

/// The line of the first character beyond ASCII at a forbidden place; 0: none.
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

/// The place of each value in force.
using Places = std::map<const Key*, std::string>;

void read_config_file(Config& c, const Keys& keys, const ConfigSources& sources, Places& places, std::vector<ConfigFault>& faults) {
    const auto place = [&](const toml::source_region& r) { return fmt::format("{}:{}", sources.file_name, r.begin.line); };
    // TOML permits no control characters except tab and line ends. The parser does not report NUL as a fault but ends there.
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
        const std::string names = keys.names(section.str());
        if (!table || names.empty()) {
            faults.push_back({place(node.source()), fmt::format("[{}] is not a section", section.str()), "sections: " + keys.names("")});
            continue;
        }
        for (const auto& [name, value] : *table) {
            const Key* key = keys.find(section.str(), name.str());
            if (!key) {
                faults.push_back({place(value.source()), fmt::format("[{}] has no key {}", section.str(), name.str()), "keys: " + names});
                continue;
            }
            const auto text = text_of(value);
            const auto kind = wrong_kind(value, key->written);
            const Unfit fault = !text ? Unfit("write a text, a number, true or false") : kind ? kind : key->set(c, *text);
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

Config read_config(const ConfigSources& sources, std::vector<ConfigFault>& faults) { return read_config(sources, faults, all_doors()); }

Config read_config(const ConfigSources& sources, std::vector<ConfigFault>& faults, std::span<const DoorDescriptor* const> doors) {
    const Keys keys(doors);
    Config c;
    Places places;
    if (sources.file_text) read_config_file(c, keys, sources, places, faults);
    const auto apply = [&](std::string_view section, std::string_view name, const std::string& value, const std::string& place) {
        const Key* key = keys.find(section, name);
        if (!key) {
            const std::string names = keys.names(section);
            faults.push_back({place, fmt::format("there is no key {}.{}", section, name),
                              names.empty() ? "sections: " + keys.names("") : "keys: " + names});
            return;
        }
        if (const Unfit fault = key->set(c, key->written == Written::as_list ? bare_list(value) : value))
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
        const Key* best = keys.find_joined(name);
        if (!best) continue;  // other programs may use the prefix, too
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
    const KeyPlace place_of = [&](std::string_view section, std::string_view name) {
        const auto written = places.find(keys.find(section, name));
        return written != places.end() ? written->second : sources.file_name.empty() ? "configuration" : sources.file_name;
    };
    for (const DoorDescriptor* door : doors) {
        if (door->check) door->check(c, place_of, faults);
    }
    return c;
}

}  // namespace axisgate
