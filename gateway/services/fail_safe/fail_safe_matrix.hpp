// The action of each axis for each cause of loss of command: the site's choice or the default, and the functions of its drive. It makes
// documents, a changed site, and the request for a rehearsal; nothing is stopped or moved here.
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

/// All causes of loss, with their default actions.
[[nodiscard]] boost::json::array loss_causes_document();
/// The actions of the axis with this index, the last loss, and the functions of its drive.
[[nodiscard]] boost::json::object fail_safe_row(const MatrixPorts& ports, const SiteState& site, std::size_t index);
/// Replaces the whole choice of an axis; null is the default, as in the document.
[[nodiscard]] Refusable<Site> with_fail_safe(const Site& before, const Families& families, std::string_view axis,
                                             const boost::json::object& choice);

struct RehearsalChoice {
    std::vector<std::string> axes;  ///< empty: all
    RehearsalSteps steps = RehearsalSteps::all();
};
[[nodiscard]] RehearsalChoice read_rehearsal_choice(const boost::json::object& body, std::vector<Fault>& faults);

}  // namespace axisgate
