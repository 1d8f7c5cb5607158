// Checks the relations between lines, drives and axes of a site. Single entries are checked when they are read (site_read.cpp); mappings,
// profiles and assemblies where they are read.
#pragma once

#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

/// Every fault with its place and remedy, in the order of the document's lists.
void check_relations(const Site& site, const Families& families, std::vector<SiteFault>& faults);

}  // namespace axisgate
