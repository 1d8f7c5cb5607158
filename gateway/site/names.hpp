// Finds names of a site that cannot be part of a request's path: an axis with such a name could not be stopped by its name.
#pragma once

#include <vector>

#include "gateway/site/site.hpp"

namespace axisgate {

/// Names that cannot be part of an address of the API: for an axis, a name that does not begin with a letter or digit; for a line or drive,
/// "." and "..". parse_site accepts them, because existing sites with such names must open; the code that accepts a new name calls this
/// function, and opening a site reports the names. A name that `before` has for the same kind of object is left out; nullptr: none is left
/// out.
[[nodiscard]] std::vector<SiteFault> names_to_change(const Site& site, const Site* before);

}  // namespace axisgate
