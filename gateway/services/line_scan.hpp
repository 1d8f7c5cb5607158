// The request for a scan of a line, its document, and the ports of this machine at which a line can be. The scan itself is started
// elsewhere.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/fault.hpp"
#include "gateway/services/ports/lines.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

/// A line of the site in force.
struct LinePlace {
    std::string name;
    LineId id = no_line;
};
[[nodiscard]] std::optional<LinePlace> find_line(const SitePort& sites, const std::string& name);

[[nodiscard]] ScanWish read_scan_wish(const boost::json::object& body, std::vector<Fault>& faults);
[[nodiscard]] boost::json::object scan_document(const ScanReport& report, std::string_view line);
/// The present ports of the system, each with the line of the site that uses it.
[[nodiscard]] boost::json::array host_ports_document(const LinePort& lines, const Site& site);

}  // namespace axisgate
