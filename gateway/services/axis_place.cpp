// Axis place: looked up in the site in force.
// In: a name. Out: the place, or nothing. Never keeps anything from call to call.
#include "gateway/services/axis_place.hpp"

#include <utility>

namespace axisgate {

AxisPlace axis_at(const Gateway& gateway, std::shared_ptr<const SiteState> site, std::size_t index) {
    AxisPlace place;
    place.site = std::move(site);
    place.index = index;
    if (const DriveSpec* drive = place.site->site.drive(place.spec().drive)) {
        place.line = drive->line;
        if (const LineSpec* line = place.site->site.line(drive->line)) {
            place.family = line->family;
            place.catalogue = catalogue_of(place.site->site, *drive, gateway.families()).get();  // lives as long as the site
        }
    }
    return place;
}

std::optional<AxisPlace> find_axis(const Gateway& gateway, std::string_view name) {
    auto site = gateway.site();
    const auto index = index_of_name(site->site.axes, name);
    if (!index) return std::nullopt;
    return axis_at(gateway, std::move(site), *index);
}

}  // namespace axisgate
