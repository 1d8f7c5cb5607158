// Reads and checks a complete document: each entry by itself, then the relations between entries. All faults are collected, each with place
// and remedy.
#include "gateway/site/site.hpp"

#include <fmt/core.h>
#include <boost/json/serialize.hpp>

#include <algorithm>
#include <cmath>
#include <set>

#include "gateway/site/document_fields.hpp"
#include "gateway/site/mapping.hpp"
#include "gateway/site/site_check.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

bool good_name(std::string_view s) {
    if (s.empty() || s.size() > 64) return false;
    return std::ranges::all_of(s, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    });
}

std::string read_name(DocumentFields& f, std::string_view example) {
    std::string name = f.text("name", true, example);
    if (!name.empty() && !good_name(name)) {
        f.fault("name", fmt::format("\"{}\" cannot be a name", name), "use 1 to 64 letters, digits, - _ and .");
    }
    return name;
}

/// A heading for the user: only its length and its characters are checked.
std::string read_group(DocumentFields& f) {
    std::string group = f.text("group", false, "infeed");
    const bool plain = std::ranges::none_of(group, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
    if (group.size() > 64 || !plain || (!group.empty() && (group.front() == ' ' || group.back() == ' '))) {
        f.fault("group", "this cannot be a group",
                "write at most 64 bytes of text without line breaks and without blanks at its ends, such as \"infeed\"");
    }
    return group;
}

/// Empty: the member is missing. An empty text is not a family.
std::string read_family(DocumentFields& f, std::string_view example) {
    std::string name = f.text("family", false, example);
    if (const auto* v = f.get("family"); v && v->is_string() && name.empty())
        f.fault("family", "family is an empty text", fmt::format("write the name of a family, as {}, or leave it out", example));
    return name;
}

LineTiming read_timing(const json::value* v, const std::string& pointer, std::vector<SiteFault>& faults) {
    LineTiming m;
    if (!v) return m;
    DocumentFields f(*v, pointer, faults);
    using std::chrono::milliseconds;
    if (const auto x = f.integer("reply_timeout_ms", 0, 60'000)) m.reply_timeout = milliseconds(*x);
    if (const auto x = f.integer("poll_period_ms", 0, 60'000)) m.poll_period = milliseconds(*x);
    if (const auto x = f.integer("pause_ms", 0, 10'000)) m.pause = milliseconds(*x);
    if (const auto x = f.integer("stale_after_ms", 0, 600'000)) m.stale_after = milliseconds(*x);
    if (const auto x = f.integer("retries", -1, 20)) m.retries = static_cast<int>(*x);
    if (const auto x = f.integer("silent_limit", 1, 1000)) m.silent_limit = static_cast<int>(*x);
    if (const auto x = f.integer("retry_pause_min_ms", 1, 600'000)) m.retry_pause_min = milliseconds(*x);
    if (const auto x = f.integer("retry_pause_max_ms", 1, 600'000)) m.retry_pause_max = milliseconds(*x);
    if (m.retry_pause_max < m.retry_pause_min) {
        f.fault("retry_pause_max_ms", "the longest pause is shorter than the first", "make retry_pause_max_ms at least retry_pause_min_ms");
    }
    f.unknown_keys();
    return m;
}

/// Sites written before "timing" existed use "manners": it is read and never written. If a member is in both, that of "manners" counts,
/// because only an old client writes it.
LineTiming read_line_timing(DocumentFields& line, const std::string& pointer, std::vector<SiteFault>& faults) {
    const json::value* now = line.get("timing");
    const json::value* before = line.get("manners");
    if (!before) return read_timing(now, pointer + "/timing", faults);
    if (!now || !now->is_object() || !before->is_object()) return read_timing(before, pointer + "/manners", faults);
    json::object both = now->get_object();
    for (const auto& [key, value] : before->get_object())
        both.insert_or_assign(key, value);
    const json::value merged(std::move(both));
    return read_timing(&merged, pointer + "/manners", faults);
}

FailSafe read_fail_safe(const json::value* v, const std::string& pointer, std::vector<SiteFault>& faults) {
    FailSafe s;
    if (!v) return s;
    DocumentFields f(*v, pointer, faults);
    for (const LossCause cause : loss_causes()) {
        const auto* entry = f.get(name_of(cause));
        if (!entry) continue;
        if (entry->is_string()) s.of(cause) = fail_safe_action_of(std::string_view(entry->get_string()));
        if (!s.of(cause))
            f.fault(name_of(cause), "this is not a fail-safe action",
                    "use nothing, halt, quick_stop or disable; leave it out to halt velocity moves alone");
    }
    s.watchdog_ms = f.integer("watchdog_ms", 0, 600'000);
    f.unknown_keys();
    return s;
}

template <class T, class Read>
void read_list(const json::object& document, std::string_view key, std::vector<T>& into, std::vector<SiteFault>& faults, Read&& read) {
    const auto* v = document.if_contains(key);
    if (!v || v->is_null()) return;
    const std::string base = "/" + std::string(key);
    if (!v->is_array()) {
        faults.push_back({base, fmt::format("{} must be a list", key), "write [...]"});
        return;
    }
    if (v->get_array().size() > max_axes) {
        faults.push_back(
            {base, fmt::format("{} has {} entries", key, v->get_array().size()), fmt::format("at most {} are possible", max_axes)});
        return;
    }
    std::set<std::string> names;
    for (std::size_t i = 0; i < v->get_array().size(); ++i) {
        const std::string pointer = fmt::format("{}/{}", base, i);
        DocumentFields f(v->get_array()[i], pointer, faults);
        T item = read(f, pointer);
        f.unknown_keys();
        if (!item.name.empty() && !names.insert(item.name).second) {
            f.fault("name", fmt::format("the name {} is there twice", item.name), "give each a name of its own");
        }
        into.push_back(std::move(item));
    }
}

void read_units(const json::value* list, Site& site, std::vector<SiteFault>& faults) {
    if (!list || list->is_null()) return;
    if (!list->is_array()) {
        faults.push_back({"/modbus_units", "modbus_units must be a list", "write [{\"unit\": 2, \"gaps\": \"refuse\"}]"});
        return;
    }
    for (std::size_t i = 0; i < list->get_array().size(); ++i) {
        DocumentFields f(list->get_array()[i], fmt::format("/modbus_units/{}", i), faults);
        if (!f.get("unit")) f.fault("unit", "unit is missing", "write \"unit\": 2, a Modbus unit with a map of its own");
        const auto unit = f.integer("unit", 2, 254);
        const auto gaps = map_gaps_named(f.text("gaps", true, "refuse"));
        if (!gaps && f.get("gaps"))
            f.fault("gaps", "this is not a way to show gaps",
                    "use zero or refuse; leave the entry out for what the host's [modbus] gaps says");
        f.unknown_keys();
        if (unit && gaps && !site.gaps.emplace(static_cast<std::uint8_t>(*unit), *gaps).second)
            f.fault("unit", fmt::format("unit {} is there twice", *unit), "keep one of the two entries");
    }
}

/// The description that the drive names, if it exists; d.description is its name.
std::shared_ptr<const Description> read_description(DocumentFields& f, DriveSpec& d, const Family* family, const Families& families) {
    if (!f.get("description")) return nullptr;
    d.description = f.text("description", false, "maker-model-1.eds");
    if (d.description.empty()) return nullptr;
    if (family && !family->takes_description) {
        f.fault("description", fmt::format("drive {}: drives of the family {} are known by its page alone", d.name, family->name),
                "leave it out");
        return nullptr;
    }
    auto found = families.descriptions ? families.descriptions->find(d.description) : nullptr;
    if (!found)
        f.fault("description", fmt::format("drive {}: there is no description {}", d.name, d.description),
                fmt::format("there are: {}. Add one with POST /api/v1/descriptions",
                            families.descriptions ? families.descriptions->names() : "none"));
    return found;
}

LineSpec read_line(DocumentFields& f, const Families& families, const std::string& pointer, std::vector<SiteFault>& faults) {
    LineSpec l;
    l.name = read_name(f, "can0");
    l.uri = f.text("uri", true, "twin");
    l.family = read_family(f, families.entries.empty() ? "uim342" : families.entries.front().family->name);
    l.bitrate = static_cast<std::uint32_t>(f.integer("bitrate", 0, 100'000'000).value_or(0));
    l.options = f.options("options");
    l.timing = read_line_timing(f, pointer, faults);
    return l;
}

std::string read_address(DocumentFields& f, const Family* family) {
    const auto* a = f.get("address");
    if (!a) return family ? std::string(family->factory_address) : std::string();
    if (a->is_int64() || a->is_uint64()) return json::serialize(*a);
    if (!a->is_string()) {
        f.fault("address", "an address is a number or a text", "write \"address\": 5");
        return {};
    }
    if (a->get_string().empty()) f.fault("address", "the address is empty", "write the drive's address, or leave it out for the factory's");
    return std::string(a->get_string());
}

PresenceRule read_presence(DocumentFields& f) {
    const std::string presence = f.get("presence") ? f.text("presence", false, "auto") : "auto";
    if (presence == "device") return PresenceRule::device;
    if (presence == "twin") return PresenceRule::twin;
    if (presence != "auto") f.fault("presence", fmt::format("\"{}\" is not a presence", presence), "use device, twin or auto");
    return PresenceRule::automatic;
}

/// The catalogue of a drive whose family makes one per drive, from its description or its options.
std::shared_ptr<const Catalogue> read_own_catalogue(DocumentFields& f, const DriveSpec& d, const FamilyEntry& family,
                                                    const std::shared_ptr<const Description>& description, const Families& families) {
    OwnCatalogue own;
    if (description) own.catalogue = families.descriptions->made(family.catalogue, description.get(), d.options);
    if (!own.catalogue) {
        own = family.family->own_catalogue({*family.catalogue, d.options, description.get()});
        if (description && own.catalogue) families.descriptions->keep(family.catalogue, description, d.options, own.catalogue);
    }
    if (!own.fault.empty())
        f.fault(description ? "description" : "options", fmt::format("drive {}: {}", d.name, own.fault), "mend it, or leave it out");
    return own.catalogue;
}

DriveSpec read_drive(DocumentFields& f, Site& site, const Families& families) {
    DriveSpec d;
    d.name = read_name(f, "feeder");
    d.line = f.text("line", true, "can0");
    const LineSpec* line = site.line(d.line);
    d.family = read_family(f, line && !line->family.empty() ? line->family : "uim342");
    if (line && d.family == line->family) d.family.clear();  // that of the line: it changes with the line
    const FamilyEntry family = families.find(site.family_of(d));
    d.address = read_address(f, family.family);
    d.presence = read_presence(f);
    d.options = f.options("options");
    const auto description = read_description(f, d, family.family, families);
    if (family.family && family.family->own_catalogue) {
        if (auto own = read_own_catalogue(f, d, family, description, families)) site.own_catalogues[d.name] = std::move(own);
    }
    return d;
}

void read_limits(DocumentFields& f, AxisSpec& a) {
    if (const auto x = f.number("increments_per_unit", "3200")) {
        a.increments_per_unit = *x;
        if (!(*x >= 1e-9 && *x <= 1e12))
            f.fault("increments_per_unit", "increments_per_unit must be above 0, from 1e-9 to 1e12",
                    "write how many increments of the drive make one unit; turn the direction round in the drive");
    }
    a.position_min = f.number("position_min", "-100");
    a.position_max = f.number("position_max", "100");
    a.velocity_max = f.number("velocity_max", "50");
    a.acceleration_max = f.number("acceleration_max", "500");
    a.deceleration_min = f.number("deceleration_min", "20");
}

void check_limits(DocumentFields& f, const AxisSpec& a) {
    if (a.position_min && a.position_max && *a.position_min >= *a.position_max) {
        f.fault("position_max", fmt::format("axis {}: position_max must be above position_min", a.name), "exchange them");
    }
    for (const auto& [key, x] : {std::pair{"velocity_max", a.velocity_max}, std::pair{"acceleration_max", a.acceleration_max},
                                 std::pair{"deceleration_min", a.deceleration_min}}) {
        if (x && !(*x > 0)) f.fault(key, fmt::format("axis {}: {} must be above 0", a.name, key), "leave it out for no limit");
    }
}

/// The rules of an axis: statements that cannot be read, authority, and stored parameters.
void read_rules(DocumentFields& f, AxisSpec& a) {
    if (const auto* word = f.get("unread_statements")) {
        const bool refuse = word->is_string() && word->get_string() == "refuse";
        if (!refuse && !(word->is_string() && word->get_string() == "allow"))
            f.fault("unread_statements", fmt::format("axis {}: this is no rule for statements that cannot be read", a.name),
                    "use allow or refuse");
        a.unread_statements = !refuse;
    }
    if (const auto* mode = f.get("authority_mode")) {
        if (mode->is_string() && mode->get_string() == "lease") {
            a.authority_mode = AuthorityMode::lease;
        } else if (!mode->is_string() || mode->get_string() != "free") {
            f.fault("authority_mode", fmt::format("axis {}: this is not an authority mode", a.name), "use free or lease");
        }
    }
    if (const auto* word = f.get("stored_parameters")) {
        const auto rule = word->is_string() ? stored_parameters_named(std::string_view(word->get_string())) : std::nullopt;
        if (!rule)
            f.fault("stored_parameters", fmt::format("axis {}: this is no rule for stored parameters", a.name),
                    "use ignore, compare or write");
        a.stored_parameters = rule.value_or(StoredParameters::ignore);
    }
}

AxisSpec read_axis(DocumentFields& f, const std::string& pointer, std::vector<SiteFault>& faults) {
    AxisSpec a;
    a.name = read_name(f, "feeder");
    a.drive = f.text("drive", true, "feeder");
    a.channel = static_cast<int>(f.integer("channel", 1, 256).value_or(1));
    if (!f.get("number"))
        f.fault("number", fmt::format("axis {}: number is missing", a.name), "write \"number\": 1, its place in the register map");
    a.number = static_cast<int>(f.integer("number", 1, max_axes).value_or(0));
    a.group = read_group(f);
    a.trend_on_disk = f.flag("trend_on_disk");
    a.unit = f.get("unit") ? f.text("unit", false, "mm") : "";
    read_limits(f, a);
    read_rules(f, a);
    a.fail_safe = read_fail_safe(f.get("fail_safe"), pointer + "/fail_safe", faults);
    check_limits(f, a);
    return a;
}
}  // namespace

std::optional<Site> parse_site(const json::value& document, const Families& families, std::vector<SiteFault>& faults) {
    const std::size_t before = faults.size();
    if (!document.is_object()) {
        faults.push_back({"", "a site is an object", "write {\"lines\": [], \"drives\": [], \"axes\": [], \"mappings\": []}"});
        return std::nullopt;
    }
    const auto& o = document.get_object();
    for (const auto& [k, v] : o) {
        if (k != "lines" && k != "drives" && k != "axes" && k != "mappings" && k != "modbus_units" && k != "profiles" &&
            k != "assemblies") {
            faults.push_back({"/" + std::string(k), fmt::format("{} is not known here", std::string_view(k)),
                              "a site has lines, drives, axes, mappings, modbus_units, profiles and assemblies"});
        }
    }
    Site site;
    read_list(o, "lines", site.lines, faults,
              [&](DocumentFields& f, const std::string& pointer) { return read_line(f, families, pointer, faults); });
    read_list(o, "drives", site.drives, faults, [&](DocumentFields& f, const std::string&) { return read_drive(f, site, families); });
    read_list(o, "axes", site.axes, faults, [&](DocumentFields& f, const std::string& pointer) { return read_axis(f, pointer, faults); });
    const json::array none;
    const json::array* entries = &none;
    if (const auto* m = o.if_contains("mappings"); m && !m->is_null()) {
        if (m->is_array()) {
            entries = &m->get_array();
        } else {
            faults.push_back({"/mappings", "mappings must be a list", "write []"});
        }
    }
    read_units(o.if_contains("modbus_units"), site, faults);
    read_profiles(o.if_contains("profiles"), site, faults);
    read_assemblies(o.if_contains("assemblies"), site, faults);
    check_relations(site, families, faults);
    // In their full form from here on, with assigned ids and defaults.
    if (auto mappings = parse_mappings(*entries, site, families, faults))
        site.mappings = std::make_shared<const std::vector<Mapping>>(std::move(*mappings));
    check_profile_units(site, faults);
    // If the mappings have faults, the content of a range is not known.
    if (faults.size() == before) check_assemblies(site, faults);
    if (faults.size() != before) return std::nullopt;
    return site;
}

}  // namespace axisgate
