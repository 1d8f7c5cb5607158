// Lines, drives and axes one by one, as documents with their live state, and a changed entry as a checked site. Drives are not asked.
#pragma once

#include <boost/json/object.hpp>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>

#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/clock.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/lines.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/site/site_edit.hpp"

namespace axisgate {

/// The ports for the document of a line, a drive or an axis.
using EntryPorts = PortSet<AxisPort, ClockPort, DrivePort, LinePort, SitePort>;

[[nodiscard]] std::size_t entries_of(const Site& site, Collection collection);
[[nodiscard]] std::optional<std::size_t> entry_named(const Site& site, Collection collection, std::string_view name);
[[nodiscard]] boost::json::object entry_document(const EntryPorts& ports, const std::shared_ptr<const SiteState>& site,
                                                 Collection collection, std::size_t index);

}  // namespace axisgate
