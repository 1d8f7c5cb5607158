// Names: which names of a site no request can carry in its path, so that what is called so could not be stopped by its name.
#pragma once

#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

/// Names that cannot be part of an address of the API: of an axis, one that does not begin with a letter or digit; of a line or drive, "."
/// and "..". parse_site takes them, because sites that have them are to open: whoever takes a name in asks here, and whoever opens a site
/// tells them. A name that `before` has for the same kind of thing is left out; nullptr: none is.
[[nodiscard]] std::vector<SiteFault> names_to_change(const Site& site, const Site* before);

}  // namespace axisgate
