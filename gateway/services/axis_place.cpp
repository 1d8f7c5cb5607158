// Looks up an axis by name in the site in force.
#include "gateway/services/axis_place.hpp"

#include <fmt/core.h>

#include <utility>

#include "gateway/core/command_arguments.hpp"

namespace axisgate {

AxisPlace axis_at(const SitePort& sites, std::shared_ptr<const SiteState> site, std::size_t index) {
    AxisPlace place;
    place.site = std::move(site);
    place.index = index;
    if (const DriveSpec* drive = place.site->site.drive(place.spec().drive)) {
        place.line = drive->line;
        if (place.site->site.line(drive->line)) {
            place.family = place.site->site.family_of(*drive);
            place.catalogue = catalogue_of(place.site->site, *drive, sites.families()).get();  // lives as long as the site
        }
    }
    return place;
}

std::optional<AxisPlace> find_axis(const SitePort& sites, std::string_view name) {
    auto site = sites.site();
    const auto index = index_of_name(site->site.axes, name);
    if (!index) return std::nullopt;
    return axis_at(sites, std::move(site), *index);
}

void read_arguments(const AxisPlace& place, Action& action, const boost::json::object* by_name, const std::string& pointer,
                    std::vector<Fault>& faults) {
    const CatalogueCommand* command = place.catalogue ? place.catalogue->command(action.name) : nullptr;
    if (!command) {  // the adapter refuses an unknown command; without a catalogue entry no argument can be given by name
        if (by_name && !by_name->empty())
            faults.push_back({pointer + std::string(by_name->begin()->key()),
                              fmt::format("a {} lists no command {}", place.family, action.name),
                              fmt::format("see /api/v1/families/{}/commands", place.family)});
        return;
    }
    if (command->arguments.empty() && (!by_name || by_name->empty())) return;
    auto checked = by_name ? check_arguments(*command, *by_name) : check_arguments(*command, action.argument);
    for (auto& f : checked.faults)
        faults.push_back({pointer + f.argument, std::move(f.text), std::move(f.remedy)});
    action.values = std::move(checked.values);
}

}  // namespace axisgate
