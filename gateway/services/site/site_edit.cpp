// A new name of a line or drive is also put into the entries that refer to it; an axis that mappings name keeps its name until they are
// changed. A missing or wrong name renames nothing; parse_site refuses it.
#include "gateway/services/site/site_edit.hpp"

#include <fmt/core.h>

#include <optional>
#include <vector>

#include "gateway/services/documents.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {

bool is_read_only(Collection collection, std::string_view name) {
    switch (collection) {
        case Collection::lines:
            return is_read_only_line_member(name);
        case Collection::drives:
            return is_read_only_drive_member(name);
        case Collection::axes:
            return is_document_member(name);
    }
    return false;
}

json::object without_state(Collection collection, const json::object& entry) {
    json::object out;
    for (const auto& [k, v] : entry) {
        if (!is_read_only(collection, k)) out[k] = v;
    }
    return out;
}

std::string_view text_member(const json::value& entry, std::string_view key) {
    if (!entry.is_object()) return {};
    const auto* v = entry.get_object().if_contains(key);
    return v && v->is_string() ? std::string_view(v->get_string()) : std::string_view();
}

json::array& list_in(json::object& document, std::string_view name) {
    auto& v = document[name];
    if (!v.is_array()) v = json::array();
    return v.get_array();
}

std::optional<std::size_t> position_in(const json::array& list, std::string_view name) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (text_member(list[i], "name") == name) return i;
    }
    return std::nullopt;
}

/// The list whose entries refer to this one, and the member with the reference.
struct Hanging {
    std::string_view list, key;
};
std::optional<Hanging> hanging(Collection collection) {
    switch (collection) {
        case Collection::lines:
            return Hanging{"drives", "line"};
        case Collection::drives:
            return Hanging{"axes", "drive"};
        case Collection::axes:
            return std::nullopt;
    }
    return std::nullopt;
}

std::vector<std::size_t> mappings_of(json::object& document, std::string_view axis) {
    std::vector<std::size_t> out;
    const json::array& list = list_in(document, "mappings");
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (mapping_names(list[i], axis)) out.push_back(i);
    }
    return out;
}

ServiceRefusal absent(Collection collection, std::string_view name) { return no_such(item_name(collection), name); }

ServiceRefusal name_taken(Collection collection, std::string_view name) {
    return {ServiceRefusal::Why::conflict,
            fmt::format("there is a {} {} already: choose another name, or change that one", item_name(collection), name)};
}

/// Puts `entry` at index `i`, whose name was `old_name`, and changes references to the new name.
Edited put_entry(json::object document, Collection collection, std::size_t i, std::string_view old_name, json::object entry) {
    const std::string new_name(text_member(entry, "name"));
    if (!new_name.empty() && new_name != old_name) {
        if (position_in(list_in(document, list_name(collection)), new_name)) return name_taken(collection, new_name);
        if (const auto h = hanging(collection)) {
            for (auto& x : list_in(document, h->list)) {
                if (text_member(x, h->key) == old_name) x.get_object()[h->key] = new_name;
            }
        } else if (const auto m = mappings_of(document, old_name); !m.empty()) {
            return ServiceRefusal{
                ServiceRefusal::Why::conflict,
                fmt::format("mapping {} names the axis {}: change it before the axis gets another name", m.front(), old_name)};
        }
    }
    list_in(document, list_name(collection))[i] = std::move(entry);
    return Edit{std::move(document), new_name, fmt::format("/{}/{}", list_name(collection), i)};
}

/// A missing name, or one that is not a text, is refused by parse_site; nothing is renamed then.
json::object with_name(json::object entry, std::string_view name) {
    if (!entry.contains("name")) entry["name"] = name;
    return entry;
}

void erase_entry(json::object& document, Collection collection, std::string_view name) {
    if (const auto h = hanging(collection)) {
        std::vector<std::string> dependents;
        for (const auto& x : list_in(document, h->list)) {
            if (text_member(x, h->key) == name) dependents.emplace_back(text_member(x, "name"));
        }
        for (const auto& d : dependents)
            erase_entry(document, collection == Collection::lines ? Collection::drives : Collection::axes, d);
    } else {
        const auto doomed = mappings_of(document, name);
        json::array& mappings = list_in(document, "mappings");
        for (auto it = doomed.rbegin(); it != doomed.rend(); ++it)
            mappings.erase(mappings.begin() + static_cast<std::ptrdiff_t>(*it));
    }
    json::array& list = list_in(document, list_name(collection));
    if (const auto i = position_in(list, name)) list.erase(list.begin() + static_cast<std::ptrdiff_t>(*i));
}
}  // namespace

std::string_view list_name(Collection collection) noexcept {
    switch (collection) {
        case Collection::lines:
            return "lines";
        case Collection::drives:
            return "drives";
        case Collection::axes:
            return "axes";
    }
    return "axes";
}

std::string_view item_name(Collection collection) noexcept {
    switch (collection) {
        case Collection::lines:
            return "line";
        case Collection::drives:
            return "drive";
        case Collection::axes:
            return "axis";
    }
    return "axis";
}

Edited add_entry(json::object document, Collection collection, json::object entry) {
    json::array& list = list_in(document, list_name(collection));
    const std::string name(text_member(entry, "name"));
    if (!name.empty() && position_in(list, name)) return name_taken(collection, name);
    list.push_back(without_state(collection, entry));
    std::string pointer = fmt::format("/{}/{}", list_name(collection), list.size() - 1);
    return Edit{std::move(document), name, std::move(pointer)};
}

Edited replace_entry(json::object document, Collection collection, std::string_view name, json::object entry) {
    const auto i = position_in(list_in(document, list_name(collection)), name);
    if (!i) return absent(collection, name);
    return put_entry(std::move(document), collection, *i, name, with_name(without_state(collection, entry), name));
}

Edited patch_entry(json::object document, Collection collection, std::string_view name, json::object patch) {
    const auto i = position_in(list_in(document, list_name(collection)), name);
    if (!i) return absent(collection, name);
    json::value entry = list_in(document, list_name(collection))[*i];
    merge_patch(entry, without_state(collection, patch));
    return put_entry(std::move(document), collection, *i, name, std::move(entry.get_object()));
}

Edited remove_entry(json::object document, Collection collection, std::string_view name, bool cascade) {
    if (!position_in(list_in(document, list_name(collection)), name)) return absent(collection, name);
    if (!cascade) {
        std::string holders;
        if (const auto h = hanging(collection)) {
            for (const auto& x : list_in(document, h->list)) {
                if (text_member(x, h->key) == name) holders += (holders.empty() ? "" : ", ") + std::string(text_member(x, "name"));
            }
            if (!holders.empty()) {
                return ServiceRefusal{ServiceRefusal::Why::conflict,
                                      fmt::format("{} {} is still used by {}: {}; remove them first, or add ?cascade=1",
                                                  item_name(collection), name, h->list, holders)};
            }
        } else {
            for (const auto m : mappings_of(document, name))
                holders += (holders.empty() ? "" : ", ") + std::to_string(m);
            if (!holders.empty()) {
                return ServiceRefusal{
                    ServiceRefusal::Why::conflict,
                    fmt::format("axis {} is still named by the mappings {}; remove them first, or add ?cascade=1", name, holders)};
            }
        }
    }
    erase_entry(document, collection, name);
    return Edit{std::move(document), std::string(name), {}};
}

void merge_patch(json::value& target, const json::value& patch) {
    if (!patch.is_object()) {
        target = patch;
        return;
    }
    if (!target.is_object()) target = json::object();
    for (const auto& [k, v] : patch.get_object()) {
        if (v.is_null()) {
            target.get_object().erase(k);
        } else {
            merge_patch(target.get_object()[k], v);
        }
    }
}

bool mapping_names(const json::value& mapping, std::string_view axis) {
    if (text_member(mapping, "axis") == axis) return true;
    const auto point = text_member(mapping, "point");
    return point.size() > axis.size() && point.starts_with(axis) &&
           std::string_view("./:").find(point[axis.size()]) != std::string_view::npos;
}

}  // namespace axisgate
