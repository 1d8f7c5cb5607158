// Fail-safe matrix: what each axis does when its command is lost, by cause: what the site names, and what holds where it names nothing;
// what its drive keeps by itself. In: the site, pictures, states of drives. Out: documents; a changed site; which rehearsal is wished for.
// Never stops or moves anything.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/drives.hpp"
#include "gateway/services/ports/port_set.hpp"
#include "gateway/services/ports/rehearsal.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/refusal.hpp"

namespace axisgate {

using MatrixPorts = PortSet<AxisPort, DrivePort, RehearsalPort, SitePort>;

/// All causes of a loss, with what is done where the site says nothing.
[[nodiscard]] boost::json::array loss_causes_document();
/// What the axis with this index does, did, and what its drive would do.
[[nodiscard]] boost::json::object fail_safe_row(const MatrixPorts& ports, const SiteState& site, std::size_t index);
/// The whole choice of an axis in place of the one before; null is the default, as it is told.
[[nodiscard]] Refusable<Site> with_fail_safe(const Site& before, const Families& families, std::string_view axis,
                                             const boost::json::object& choice);

struct RehearsalChoice {
    std::vector<std::string> axes;  ///< empty: all
    RehearsalSteps steps = RehearsalSteps::all();
};
[[nodiscard]] RehearsalChoice read_rehearsal_choice(const boost::json::object& body, std::vector<Fault>& faults);

}  // namespace axisgate
