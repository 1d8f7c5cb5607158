// Site file: a site document read from disk, with faults that name file and line.
// In: a path. Out: a checked site, or every fault as one line for standard error. Never changes the file.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/engine/engine.hpp"
#include "gateway/site/site.hpp"
#include "gateway/store/reader.hpp"

namespace axisgate {

struct SiteFile {
    std::optional<Site> site;
    std::vector<std::string> faults;        ///< "site.json:12: ... (/axes/0/number); what to do"
    std::vector<Description> descriptions;  ///< that were not on the shelf and lay beside the file: on the shelf now, nowhere else
};
/// Descriptions that drives of the site name and the shelf has not are read from files of their name in the site file's folder.
[[nodiscard]] SiteFile read_site_file(const std::string& path, const Families& families);

/// What twins and axes of a site had before, from the store.
[[nodiscard]] SiteMemory read_site_memory(StoreReader& store, const Site& site);

}  // namespace axisgate
