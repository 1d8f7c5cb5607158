// Finds which axes and drives of a new site exist in the store under the same name, and which are former ones under another name. The
// intention of the user is not needed: a site may come as a whole, from the history, or after a rolled-back trial. An axis at the place of
// a former one whose name does not exist any more is that axis.
#pragma once

#include <boost/json/value.hpp>

#include "gateway/site/site.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {

[[nodiscard]] SiteChange names_between(const boost::json::value& before, const boost::json::value& after);
/// For a site that stays as it is.
[[nodiscard]] SiteChange names_of(const Site& site);

}  // namespace axisgate
