// Site names: what a new site means for everything that the store keeps by name: which axes and drives are there, and which of them are
// those of before under another name.
// In: documents as the store keeps them. Out: SiteChange. Never asks who meant what: a site may come as a whole, from the history, or back
// after a trial, and an axis that stands where another one stood and whose name is gone is that one.
#pragma once

#include <boost/json/value.hpp>

#include "gateway/site/site.hpp"
#include "gateway/store/records.hpp"

namespace axisgate {

[[nodiscard]] SiteChange names_between(const boost::json::value& before, const boost::json::value& after);
/// Of a site that stays as it is.
[[nodiscard]] SiteChange names_of(const Site& site);

}  // namespace axisgate
