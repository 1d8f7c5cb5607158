// Finds entries by their names and shows them with their present state.
#include "gateway/services/site/site_entries.hpp"

#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"

namespace axisgate {

std::size_t entries_of(const Site& site, Collection collection) {
    switch (collection) {
        case Collection::lines:
            return site.lines.size();
        case Collection::drives:
            return site.drives.size();
        case Collection::axes:
            return site.axes.size();
    }
    return 0;
}

std::optional<std::size_t> entry_named(const Site& site, Collection collection, std::string_view name) {
    switch (collection) {
        case Collection::lines:
            return index_of_name(site.lines, name);
        case Collection::drives:
            return index_of_name(site.drives, name);
        case Collection::axes:
            return index_of_name(site.axes, name);
    }
    return std::nullopt;
}

boost::json::object entry_document(const EntryPorts& ports, const std::shared_ptr<const SiteState>& site, Collection collection,
                                   std::size_t i) {
    switch (collection) {
        case Collection::lines:
            return line_document(*site, i, i < site->line_ids.size() ? ports.get<LinePort>().line_report(site->line_ids[i]) : LineReport{});
        case Collection::drives:
            return drive_document(*site, i,
                                  i < site->drive_ids.size() ? ports.get<DrivePort>().drive_status(site->drive_ids[i]) : DriveStatus{});
        case Collection::axes:
            break;
    }
    const auto& clock = ports.get<ClockPort>();
    const AxisPlace place = axis_at(ports.get<SitePort>(), site, i);
    const AxisPicture picture = place.id() == no_axis ? AxisPicture{} : ports.get<AxisPort>().picture(place.id());
    return axis_document(
        {place.spec(), place.line, place.family, place.catalogue, picture, clock.to_unix_ns(picture.at), clock.now_unix_ns()});
}

}  // namespace axisgate
