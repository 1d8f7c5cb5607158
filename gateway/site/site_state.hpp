// SiteState: a checked site that is in force, with the ids that its lines, drives and axes have in the running engine.
// In: made by the engine when it puts a site in force. Out: shared with every reader. Never changed after that.
#pragma once

#include <cstdint>
#include <vector>

#include "gateway/core/ids.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// A site in force: immutable, shared with every reader. Ids are those of the running engine.
struct SiteState {
    Site site;
    std::uint64_t revision = 0;      ///< counts up with each change; also the strong ETag of /site
    std::vector<AxisId> axis_ids;    ///< by index in site.axes
    std::vector<DriveId> drive_ids;  ///< by index in site.drives
    std::vector<LineId> line_ids;    ///< by index in site.lines
};

/// What `wanted` would be in place of `now`: who keeps its name keeps its id, as in the engine; who is new has one that nobody has yet.
[[nodiscard]] SiteState as_if_in_force(const SiteState& now, Site wanted);

}  // namespace axisgate
