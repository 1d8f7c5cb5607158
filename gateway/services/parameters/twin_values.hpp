// The twin of one drive in a gateway of its own and in virtual time: which values it shows to an adapter, and the memory with which it
// would show other ones. Values are given to it as a person would do it: they are written over the wire, and stored. So each family keeps
// the form of its memory to itself, and a value counts as adopted only if the twin shows it after its power was off. The functions take up
// to a second of processor time, so they must not run on the hot or the service thread.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "gateway/core/twin.hpp"
#include "gateway/services/parameters/drive_sweep.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// One axis of a site, whose drive is simulated.
struct TwinPlace {
    const Families& families;
    Site site;         ///< only the line, the drive and its axes are used
    std::string axis;  ///< of the site
    [[nodiscard]] const DriveSpec& drive() const;
};
/// The site with the axis' line, its drive alone, and the drive's axes.
[[nodiscard]] Site only_its_drive(Site site, const std::string& axis);

struct TwinValues {
    std::map<std::string, Value, std::less<>> values;
    std::map<std::string, std::string, std::less<>> refused;  ///< reasons
    std::string fault;                                        ///< the twin could not be read, and why; empty: it was read
};
[[nodiscard]] TwinValues read_twin(const TwinPlace& place, const NonVolatile& memory, const std::vector<JobPoint>& points);

struct Adoption {
    NonVolatile memory;                   ///< with which the twin starts as this drive
    std::vector<std::string> adopted;     ///< the twin shows the drive's value now, and did not before
    std::vector<JobFailure> not_adopted;  ///< the twin still shows another value, and why
};
/// `held`: what the drive holds.
[[nodiscard]] Adoption adopt(const TwinPlace& place, NonVolatile memory, const std::vector<JobPoint>& points,
                             const std::vector<SnapshotValue>& held);

}  // namespace axisgate
