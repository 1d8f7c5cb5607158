// An axis of the site in force with its drive, line, id and catalogue. It keeps the site alive in which it was found.
#pragma once

#include <boost/json/object.hpp>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/fault.hpp"
#include "gateway/services/ports/site.hpp"

namespace axisgate {

struct AxisPlace {
    std::shared_ptr<const SiteState> site;
    std::size_t index = 0;
    std::string line, family;
    const Catalogue* catalogue = nullptr;
    [[nodiscard]] const AxisSpec& spec() const { return site->site.axes[index]; }
    [[nodiscard]] AxisId id() const { return index < site->axis_ids.size() ? site->axis_ids[index] : no_axis; }
};
[[nodiscard]] std::optional<AxisPlace> find_axis(const SitePort& sites, std::string_view name);
[[nodiscard]] AxisPlace axis_at(const SitePort& sites, std::shared_ptr<const SiteState> site, std::size_t index);
/// Puts the arguments of a family's action into Action::values: from `by_name`, or from the action's text as "name=value ...". A command
/// without typed arguments keeps its text. There is one fault per argument, with `pointer` before its name.
void read_arguments(const AxisPlace& place, Action& action, const boost::json::object* by_name, const std::string& pointer,
                    std::vector<Fault>& faults);
/// Index by name in one of the site's lists.
template <class Spec>
[[nodiscard]] std::optional<std::size_t> index_of_name(const std::vector<Spec>& list, std::string_view name) {
    for (std::size_t i = 0; i < list.size(); ++i) {
        if (list[i].name == name) return i;
    }
    return std::nullopt;
}

}  // namespace axisgate
