// Look-ups, the document of a site, the differences between two sites, and the hash of the mappings. The document is read in site_read.cpp.
#include "gateway/site/site.hpp"

#include <fmt/core.h>
#include <boost/json/serialize.hpp>

#include <algorithm>
#include <cmath>
#include <map>

#include "gateway/core/line_uri.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {

std::string_view name_of(AuthorityMode mode) noexcept { return mode == AuthorityMode::lease ? "lease" : "free"; }
namespace {
namespace json = boost::json;

template <class T>
const T* by_name(const std::vector<T>& list, std::string_view name) noexcept {
    const auto it = std::ranges::find(list, name, &T::name);
    return it == list.end() ? nullptr : &*it;
}

void put_options(json::object& o, std::string_view key, const std::map<std::string, std::string>& options) {
    if (options.empty()) return;
    json::object x;
    for (const auto& [k, v] : options)
        x[k] = v;
    o[key] = std::move(x);
}

void put_number(json::object& o, std::string_view key, double d) {
    if (std::nearbyint(d) == d && std::fabs(d) < 9e15) {
        o[key] = static_cast<std::int64_t>(d);
    } else {
        o[key] = d;
    }
}

void put_optional(json::object& o, std::string_view key, const std::optional<double>& d) {
    if (d) put_number(o, key, *d);
}

json::object timing_json(const LineTiming& m) {
    const LineTiming fresh;
    json::object o;
    if (m.reply_timeout != fresh.reply_timeout) o["reply_timeout_ms"] = milliseconds_of(m.reply_timeout);
    if (m.poll_period != fresh.poll_period) o["poll_period_ms"] = milliseconds_of(m.poll_period);
    if (m.pause != fresh.pause) o["pause_ms"] = milliseconds_of(m.pause);
    if (m.stale_after != fresh.stale_after) o["stale_after_ms"] = milliseconds_of(m.stale_after);
    if (m.retries != fresh.retries) o["retries"] = m.retries;
    if (m.silent_limit != fresh.silent_limit) o["silent_limit"] = m.silent_limit;
    if (m.retry_pause_min != fresh.retry_pause_min) o["retry_pause_min_ms"] = milliseconds_of(m.retry_pause_min);
    if (m.retry_pause_max != fresh.retry_pause_max) o["retry_pause_max_ms"] = milliseconds_of(m.retry_pause_max);
    return o;
}
}  // namespace

std::string_view name_of(PresenceRule rule) noexcept {
    switch (rule) {
        case PresenceRule::device:
            return "device";
        case PresenceRule::twin:
            return "twin";
        case PresenceRule::automatic:
            return "auto";
    }
    return "auto";
}

std::string_view name_of(MapGaps gaps) noexcept { return gaps == MapGaps::zero ? "zero" : "refuse"; }
std::optional<MapGaps> map_gaps_named(std::string_view name) noexcept {
    for (const auto g : {MapGaps::zero, MapGaps::refuse}) {
        if (name_of(g) == name) return g;
    }
    return std::nullopt;
}

bool LineSpec::operator==(const LineSpec& o) const { return to_json(*this) == to_json(o); }

const LineSpec* Site::line(std::string_view name) const noexcept { return by_name(lines, name); }
const DriveSpec* Site::drive(std::string_view name) const noexcept { return by_name(drives, name); }
const AxisSpec* Site::axis(std::string_view name) const noexcept { return by_name(axes, name); }

std::string_view Site::family_of(const DriveSpec& drive) const noexcept {
    if (!drive.family.empty()) return drive.family;
    const LineSpec* l = line(drive.line);
    return l ? std::string_view(l->family) : std::string_view();
}

std::vector<std::string> Site::families_on(const LineSpec& line) const {
    std::vector<std::string> list;
    if (!line.family.empty()) list.push_back(line.family);
    for (const auto& d : drives) {
        if (d.line == line.name && !d.family.empty() && std::ranges::find(list, d.family) == list.end()) list.push_back(d.family);
    }
    return list;
}

LineKind kind_of(const LineSpec& line, const Families& families) {
    const auto uri = parse_line_uri(line.uri);
    if (!uri.good() || uri.uri.kind != LineUri::Kind::twin)
        return uri.good() && uri.uri.kind == LineUri::Kind::can ? LineKind::can : LineKind::bytes;
    const Family* family = families.find(line.family).family;
    if (!family) return LineKind::can;
    const bool wants_bytes = option(line.options, "kind", "") == "bytes" && family->uses_bytes;
    return family->uses_can && !wants_bytes ? LineKind::can : LineKind::bytes;
}

FamilyEntry Families::find(std::string_view name) const noexcept {
    for (const auto& e : entries) {
        if (e.family->name == name) return e;
    }
    return {};
}

std::shared_ptr<const Catalogue> catalogue_of(const Site& site, const DriveSpec& drive, const Families& families) {
    if (const auto own = site.own_catalogues.find(drive.name); own != site.own_catalogues.end()) return own->second;
    return {std::shared_ptr<const Catalogue>(), families.find(site.family_of(drive)).catalogue};
}

std::string Families::names() const {
    std::string s;
    for (const auto& e : entries)
        s += (s.empty() ? "" : ", ") + std::string(e.family->name);
    return s;
}

json::object to_json(const LineSpec& l) {
    json::object o{{"name", l.name}, {"uri", l.uri}};
    if (!l.family.empty()) o["family"] = l.family;
    if (l.bitrate) o["bitrate"] = l.bitrate;
    put_options(o, "options", l.options);
    if (auto m = timing_json(l.timing); !m.empty()) o["timing"] = std::move(m);
    return o;
}

json::object to_json(const DriveSpec& d) {
    json::object o{{"name", d.name}, {"line", d.line}, {"presence", std::string(name_of(d.presence))}};
    if (!d.family.empty()) o["family"] = d.family;
    if (!d.address.empty() && std::ranges::all_of(d.address, [](char c) { return c >= '0' && c <= '9'; }) && d.address.size() < 10) {
        o["address"] = std::stoll(d.address);
    } else {
        o["address"] = d.address;
    }
    put_options(o, "options", d.options);
    if (!d.description.empty()) o["description"] = d.description;
    return o;
}

json::object to_json(const AxisSpec& a) {
    json::object o{{"name", a.name}, {"drive", a.drive}, {"channel", a.channel}, {"number", a.number}, {"unit", a.unit}};
    put_number(o, "increments_per_unit", a.increments_per_unit);
    put_optional(o, "position_min", a.position_min);
    put_optional(o, "position_max", a.position_max);
    put_optional(o, "velocity_max", a.velocity_max);
    put_optional(o, "acceleration_max", a.acceleration_max);
    if (a.deceleration_min) put_optional(o, "deceleration_min", a.deceleration_min);
    if (!a.unread_statements) o["unread_statements"] = "refuse";
    if (!a.group.empty()) o["group"] = a.group;
    if (a.trend_on_disk) o["trend_on_disk"] = true;
    if (a.authority_mode != AuthorityMode::free) o["authority_mode"] = name_of(a.authority_mode);
    if (a.stored_parameters != StoredParameters::ignore) o["stored_parameters"] = name_of(a.stored_parameters);
    json::object fail_safe;
    for (const LossCause cause : loss_causes()) {
        if (const auto& action = a.fail_safe.of(cause)) fail_safe[name_of(cause)] = name_of(*action);
    }
    if (a.fail_safe.watchdog_ms) fail_safe["watchdog_ms"] = *a.fail_safe.watchdog_ms;
    if (!fail_safe.empty()) o["fail_safe"] = std::move(fail_safe);
    return o;
}

json::object to_json(const Site& site) {
    json::array lines, drives, axes;
    for (const auto& l : site.lines)
        lines.push_back(to_json(l));
    for (const auto& d : site.drives)
        drives.push_back(to_json(d));
    for (const auto& a : site.axes)
        axes.push_back(to_json(a));
    json::object o{
        {"lines", std::move(lines)}, {"drives", std::move(drives)}, {"axes", std::move(axes)}, {"mappings", to_json(site.map())}};
    json::array units;
    for (const auto& [unit, gaps] : site.gaps)
        units.push_back(json::object{{"unit", std::int64_t{unit}}, {"gaps", name_of(gaps)}});
    if (!units.empty()) o["modbus_units"] = std::move(units);
    json::array profiles;
    for (const auto& p : site.profiles)
        profiles.push_back(to_json(p));
    if (!profiles.empty()) o["profiles"] = std::move(profiles);
    json::array assemblies;
    for (const auto& a : site.assemblies)
        assemblies.push_back(to_json(a));
    if (!assemblies.empty()) o["assemblies"] = std::move(assemblies);
    return o;
}

namespace {
constexpr std::size_t most_mappings_published = 50;  // in one event

/// A number for the user: JSON's own writer prints 2.5 as 2.5E0.
std::string shown(const json::value& v) { return v.is_double() ? fmt::format("{}", v.get_double()) : json::serialize(v); }

/// A mapping for the user: "m7 (unit 2 holding_registers 4, feeder.position)".
std::string mapping_text(const json::object& m) {
    const auto text = [&](const char* key) {
        const auto* v = m.if_contains(key);
        return !v ? std::string("?") : v->is_string() ? std::string(v->get_string()) : shown(*v);
    };
    return fmt::format("{} (unit {} {} {}, {}.{})", text("id"), text("unit"), text("table"), text("address"), text("axis"), text("point"));
}

/// The changed members of each mapping; entries are identified by their ids, which all have after the check.
void compare_mappings(const json::array& from, const json::array& to, std::vector<std::string>& out) {
    const auto by_id = [](const json::array& list) {
        std::map<std::string, const json::object*, std::less<>> all;
        for (const auto& v : list) {
            const auto* o = v.if_object();
            const auto* id = o ? o->if_contains("id") : nullptr;
            if (id && id->is_string()) all.emplace(std::string(id->get_string()), o);
        }
        return all;
    };
    if (from == to) return;
    const auto before = by_id(from), after = by_id(to);
    const std::size_t had = out.size();
    for (const auto& [id, x] : before) {
        const auto it = after.find(id);
        if (it == after.end()) {
            out.push_back(fmt::format("mapping {}: removed", mapping_text(*x)));
            continue;
        }
        for (const auto& [k, v] : *x) {
            const auto* w = it->second->if_contains(k);
            if (!w || *w != v)
                out.push_back(
                    fmt::format("mapping {}: {} {} -> {}", mapping_text(*x), std::string_view(k), shown(v), w ? shown(*w) : "not set"));
        }
        for (const auto& [k, w] : *it->second) {
            if (!x->contains(k))
                out.push_back(fmt::format("mapping {}: {} not set -> {}", mapping_text(*x), std::string_view(k), shown(w)));
        }
    }
    for (const auto& [id, y] : after) {
        if (!before.contains(id)) out.push_back(fmt::format("mapping {}: added", mapping_text(*y)));
    }
    const std::size_t listed = out.size() - had;
    if (listed == 0) out.push_back("mappings: put into another order");
    if (listed > most_mappings_published) {
        out.resize(had + most_mappings_published);
        out.push_back(fmt::format("and {} more changes of mappings", listed - most_mappings_published));
    }
}
}  // namespace

std::vector<std::string> differences(const Site& from, const Site& to) {
    std::vector<std::string> out;
    const auto compare = [&](std::string_view what, const auto& a, const auto& b) {
        for (const auto& x : a) {
            const auto* y = by_name(b, x.name);
            if (!y) {
                out.push_back(fmt::format("{} {}: removed", what, x.name));
                continue;
            }
            const auto jx = to_json(x), jy = to_json(*y);
            for (const auto& [k, v] : jx) {
                const auto* w = jy.if_contains(k);
                if (!w || *w != v)
                    out.push_back(
                        fmt::format("{} {}: {} {} -> {}", what, x.name, std::string_view(k), shown(v), w ? shown(*w) : "not set"));
            }
            for (const auto& [k, w] : jy) {
                if (!jx.contains(k)) out.push_back(fmt::format("{} {}: {} not set -> {}", what, x.name, std::string_view(k), shown(w)));
            }
        }
        for (const auto& y : b) {
            if (!by_name(a, y.name)) out.push_back(fmt::format("{} {}: added", what, y.name));
        }
    };
    compare("line", from.lines, to.lines);
    compare("drive", from.drives, to.drives);
    compare("axis", from.axes, to.axes);
    for (unsigned unit = 2; unit <= 254 && from.gaps != to.gaps; ++unit) {
        const auto x = from.gaps.find(static_cast<std::uint8_t>(unit)), y = to.gaps.find(static_cast<std::uint8_t>(unit));
        const auto before = x == from.gaps.end() ? "not set" : name_of(x->second),
                   after = y == to.gaps.end() ? "not set" : name_of(y->second);
        if (before != after) out.push_back(fmt::format("modbus unit {}: gaps {} -> {}", unit, before, after));
    }
    for (unsigned unit = 2; unit <= 254 && from.profiles != to.profiles; ++unit) {
        const auto x = std::ranges::find(from.profiles, unit, &ProfileSpec::unit),
                   y = std::ranges::find(to.profiles, unit, &ProfileSpec::unit);
        const auto before = x == from.profiles.end() ? "not set" : json::serialize(to_json(*x)),
                   after = y == to.profiles.end() ? "not set" : json::serialize(to_json(*y));
        if (before != after) out.push_back(fmt::format("profile of unit {}: {} -> {}", unit, before, after));
    }
    std::map<std::uint16_t, std::pair<std::string, std::string>> instances;
    for (const auto& a : from.assemblies)
        instances[a.instance].first = json::serialize(to_json(a));
    for (const auto& a : to.assemblies)
        instances[a.instance].second = json::serialize(to_json(a));
    for (const auto& [instance, x] : instances) {
        const auto text = [](const std::string& s) { return s.empty() ? std::string("not set") : s; };
        if (x.first != x.second) out.push_back(fmt::format("assembly {}: {} -> {}", instance, text(x.first), text(x.second)));
    }
    if (from.mappings != to.mappings) compare_mappings(to_json(from.map()), to_json(to.map()), out);
    return out;
}

std::uint32_t mapping_revision(const Site& site) noexcept {
    // FNV-1a over the axes' positions, family names and scales, and the mappings.
    std::uint32_t h = 2166136261u;
    const auto mix = [&h](std::string_view s) {
        for (const unsigned char c : s)
            h = (h ^ c) * 16777619u;
        h = (h ^ 0xFFu) * 16777619u;
    };
    for (const auto& a : site.axes) {
        mix(a.name);
        mix(std::to_string(a.number));
        mix(a.unit);
        mix(std::to_string(a.increments_per_unit));
        if (const auto* d = site.drive(a.drive)) {
            if (const auto family = site.family_of(*d); site.line(d->line)) mix(family);
        }
    }
    // The parameter channel identifies a parameter by its position in the catalogue.
    for (const auto& [drive, catalogue] : site.own_catalogues) {
        mix(drive);
        for (const auto& p : catalogue->parameters())
            mix(p.id);
    }
    mix(json::serialize(to_json(site.map())));
    for (const auto& [unit, gaps] : site.gaps)
        mix(fmt::format("{} {}", unit, name_of(gaps)));
    for (const auto& p : site.profiles)
        mix(json::serialize(to_json(p)));
    for (const auto& a : site.assemblies)
        mix(json::serialize(to_json(a)));
    return h;
}

}  // namespace axisgate
