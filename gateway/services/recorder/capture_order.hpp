// Reads the request for a fast capture, in units of the axes, and shows captures. Nothing is started here.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <string>
#include <vector>

#include "gateway/services/ports/captures.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

[[nodiscard]] CaptureOrder read_capture_order(const boost::json::value& body, const SiteState& site, std::vector<SiteFault>& faults);
/// The new name of one; empty if there is a fault.
[[nodiscard]] std::string read_capture_name(const boost::json::value& body, std::vector<SiteFault>& faults);
[[nodiscard]] boost::json::object capture_document(const CaptureInfo& info);

}  // namespace axisgate
