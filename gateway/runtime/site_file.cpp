// Site file: a fault's line is found by the JSON pointer of the place that is wrong.
// In: a path. Out: a site or all its faults; JSON that is none has only one. Never stops at the first fault.
#include "gateway/runtime/site_file.hpp"

#include <fmt/core.h>

#include "gateway/core/json_read.hpp"
#include "gateway/runtime/files.hpp"

namespace axisgate {

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
