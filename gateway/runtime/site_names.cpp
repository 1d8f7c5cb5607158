// An entry is identified by its place: a drive by line and address, an axis by drive and channel. One former name is never assigned to two
// new ones.
#include "gateway/runtime/site_names.hpp"

#include <boost/json/serialize.hpp>
#include <map>

namespace axisgate {
namespace json = boost::json;
namespace {
/// An entry by the part that a renaming does not change: its place, as text.
struct Entry {
    std::string name, place, family;
};

std::string member(const json::value& entry, std::string_view key) {
    const auto* v = entry.is_object() ? entry.get_object().if_contains(key) : nullptr;
    if (!v) return {};
    return v->is_string() ? std::string(v->get_string()) : json::serialize(*v);
}
template <class Take>
void each(const json::value& document, std::string_view list, Take take) {
    const auto* all = document.is_object() ? document.get_object().if_contains(list) : nullptr;
    if (!all || !all->is_array()) return;
    for (const auto& v : all->get_array()) {
        if (!member(v, "name").empty()) take(v);
    }
}

struct Names {
    std::vector<Entry> drives, axes;
};
/// `former` has drives by their present name, so that an axis keeps its place although its drive has another name.
Names named_in(const json::value& document, const std::map<std::string, std::string>& former) {
    Names out;
    std::map<std::string, std::string> family_of_line, family_of_drive;
    each(document, "lines", [&](const json::value& l) { family_of_line[member(l, "name")] = member(l, "family"); });
    each(document, "drives", [&](const json::value& d) {
        const std::string own = member(d, "family"), family = own.empty() ? family_of_line[member(d, "line")] : own;
        family_of_drive[member(d, "name")] = family;
        out.drives.push_back({member(d, "name"), member(d, "line") + '\n' + member(d, "address") + '\n' + own, family});
    });
    each(document, "axes", [&](const json::value& a) {
        const std::string drive = member(a, "drive");
        const auto was = former.find(drive);
        out.axes.push_back(
            {member(a, "name"), (was == former.end() ? drive : was->second) + '\n' + member(a, "channel"), family_of_drive[drive]});
    });
    return out;
}

std::vector<NameChange> renamed(const std::vector<Entry>& before, const std::vector<Entry>& after) {
    std::map<std::string, const Entry*> here;
    for (const Entry& e : after)
        here[e.name] = &e;
    std::map<std::string, const Entry*> gone, there;  // by place; if several had the same place, the last one
    for (const Entry& e : before) {
        there[e.name] = &e;
        if (!here.contains(e.name)) gone[e.place] = &e;
    }
    std::vector<NameChange> out;
    for (const Entry& e : after) {
        if (there.contains(e.name)) continue;
        const auto it = gone.find(e.place);
        if (it == gone.end() || it->second->family != e.family) continue;
        out.push_back({it->second->name, e.name});
        gone.erase(it);
    }
    return out;
}
}  // namespace

SiteChange names_between(const json::value& before, const json::value& after) {
    SiteChange change;
    change.renamed_drives = renamed(named_in(before, {}).drives, named_in(after, {}).drives);
    std::map<std::string, std::string> former;
    for (const auto& c : change.renamed_drives)
        former[c.to] = c.from;
    const Names now = named_in(after, former);
    change.renamed_axes = renamed(named_in(before, {}).axes, now.axes);
    change.axes.emplace();
    change.drives.emplace();
    for (const Entry& e : now.axes)
        change.axes->push_back({e.name, e.family});
    for (const Entry& e : now.drives)
        change.drives->push_back(e.name);
    return change;
}

SiteChange names_of(const Site& site) {
    const json::value document = to_json(site);
    return names_between(document, document);
}

}  // namespace axisgate
