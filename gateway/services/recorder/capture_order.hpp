// Capture orders: what a body asks a fast capture for, in units of the axes, as a wish in increments; and a capture as it is shown.
// In: JSON, the site. Out: orders, or every fault with its place. Never arms one.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <string>
#include <vector>

#include "gateway/services/ports/captures.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

[[nodiscard]] CaptureOrder read_capture_order(const boost::json::value& body, const SiteState& site, std::vector<SiteFault>& faults);
/// The new name of one; empty where there is a fault.
[[nodiscard]] std::string read_capture_name(const boost::json::value& body, std::vector<SiteFault>& faults);
[[nodiscard]] boost::json::object capture_document(const CaptureInfo& info);

}  // namespace axisgate
