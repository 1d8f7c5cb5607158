// Site, checking: what lines, drives and axes of a site say of each other. Each entry by itself was checked when it was read
// (site_read.cpp), mappings, profiles and assemblies are checked where they are read.
#pragma once

#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

/// Every fault with its place and what would be right, in the order of the document's lists.
void check_relations(const Site& site, const Families& families, std::vector<SiteFault>& faults);

}  // namespace axisgate
