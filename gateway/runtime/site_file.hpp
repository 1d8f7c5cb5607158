// Reads a site document from the disk. Every fault is one line for standard error that names file and line.
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
    std::vector<std::string> faults;        ///< "site.json:12: ... (/axes/0/number); the remedy"
    std::vector<Description> descriptions;  ///< that were not on the shelf and lay beside the file; now on the shelf, but not stored
};
/// Descriptions that drives of the site name and the shelf lacks are read from files of their name in the folder of the site file.
[[nodiscard]] SiteFile read_site_file(const std::string& path, const Families& families);

/// The stored memories of a site's twins and values of its axes.
[[nodiscard]] SiteMemory read_site_memory(StoreReader& store, const Site& site);

}  // namespace axisgate
