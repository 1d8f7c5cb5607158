// The line of a fault is found by the JSON pointer of its place. All faults are reported together.
#include "gateway/runtime/site_file.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "gateway/core/json_read.hpp"
#include "gateway/runtime/clock.hpp"
#include "gateway/runtime/files.hpp"
#include "gateway/services/descriptions/description.hpp"

namespace axisgate {

namespace {

/// Names in /drives/N/description; other values are reported when the site is read.
std::vector<std::string> named_descriptions(const boost::json::value& document) {
    std::vector<std::string> names;
    const auto* object = document.if_object();
    const auto* drives = object ? object->if_contains("drives") : nullptr;
    if (drives == nullptr || !drives->is_array()) return names;
    for (const auto& d : drives->as_array()) {
        const auto* name = d.is_object() ? d.as_object().if_contains("description") : nullptr;
        if (name && name->is_string() && descriptions::check_name(name->as_string()).empty()) names.emplace_back(name->as_string());
    }
    return names;
}

void take_descriptions_beside(const std::string& path, const boost::json::value& document, DescriptionShelf& shelf, SiteFile& out) {
    for (const std::string& name : named_descriptions(document)) {
        const auto file = (std::filesystem::path(path).parent_path() / name).string();
        std::error_code none;
        if (shelf.find(name) || !std::filesystem::exists(file, none)) continue;
        std::string fault;
        const auto text = read_file(file, fault, descriptions::most_bytes);
        if (!text) {
            out.faults.push_back(fault);
            continue;
        }
        const auto read = descriptions::read(*text);
        for (const auto& f : read.faults)
            out.faults.push_back(fmt::format("{}:{}: {}", file, f.line, f.text));
        if (!read.faults.empty()) continue;
        Description d{{name, *text}, "--site " + path, unix_now_ns()};
        d.facts = descriptions::facts(d, read);
        out.descriptions.push_back(d);
        shelf.put(std::move(d));
    }
}
}  // namespace

SiteFile read_site_file(const std::string& path, const Families& families) {
    SiteFile out;
    std::string fault;
    const auto text = read_file(path, fault, 16u << 20);
    if (!text) {
        out.faults.push_back(fault);
        return out;
    }
    JsonFault unread;
    const auto document = read_json(*text, unread);
    if (!document) {
        out.faults.push_back(unread.twice ? fmt::format("{}:{}: {} ({}); keep one of them", path, unread.line, unread.text, unread.pointer)
                                          : fmt::format("{}:{}: this is not JSON ({}); every name in double quotes, no comma before a "
                                                        "closing bracket, nothing behind the end",
                                                        path, unread.line, unread.text));
        return out;
    }
    if (families.descriptions) take_descriptions_beside(path, *document, *families.descriptions, out);
    if (!out.faults.empty()) return out;
    std::vector<SiteFault> wrong;
    out.site = parse_site(*document, families, wrong);
    for (const auto& f : wrong) {
        out.faults.push_back(fmt::format("{}:{}: {} ({}); {}", path, line_of_pointer(*text, f.pointer), f.text,
                                         f.pointer.empty() ? "/" : f.pointer, f.remedy));
    }
    return out;
}

SiteMemory read_site_memory(StoreReader& store, const Site& site) {
    SiteMemory memory;
    for (const auto& d : site.drives) {
        if (auto m = store.load_twin(d.name)) memory.twins[d.name] = std::move(*m);
    }
    for (const auto& a : site.axes) {
        if (const auto rows = store.stored(a.name)) {
            for (const auto& row : *rows)
                memory.stored[a.name][row.parameter] = row.value;
        }
    }
    return memory;
}

}  // namespace axisgate
