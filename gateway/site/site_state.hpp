// SiteState is a site in force, with the ids of its lines, drives and axes in the running engine. The engine makes it, and all readers
// share it.
#pragma once

#include <cstdint>
#include <vector>

#include "gateway/core/ids.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// Never changed. Ids are those of the running engine.
struct SiteState {
    Site site;
    std::uint64_t revision = 0;      ///< increased with each change; also the strong ETag of /site
    std::vector<AxisId> axis_ids;    ///< by index in site.axes
    std::vector<DriveId> drive_ids;  ///< by index in site.drives
    std::vector<LineId> line_ids;    ///< by index in site.lines
};

/// The state that `wanted` would have in place of `now`: an object with the same name keeps its id, as in the engine; a new object gets a
/// new id.
[[nodiscard]] SiteState as_if_in_force(const SiteState& now, Site wanted);

}  // namespace axisgate
