// The JSON of axes, drives, lines, frames, events and catalogues, with exactly the members that schema/openapi.yaml describes. All data are
// arguments; the gateway is not asked.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/axis/image.hpp"
#include "gateway/axis/points.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/event.hpp"
#include "gateway/core/family.hpp"
#include "gateway/core/line.hpp"
#include "gateway/core/records.hpp"
#include "gateway/engine/report.hpp"
#include "gateway/site/site.hpp"
#include "gateway/site/site_state.hpp"

namespace axisgate {

[[nodiscard]] std::string_view name_of(Quality quality) noexcept;
[[nodiscard]] std::string_view name_of(Access access) noexcept;  ///< "R", "W", "RW"

/// A value as JSON; null if it is unknown.
[[nodiscard]] boost::json::value to_json(const Value& value);

struct AxisView {
    const AxisSpec& spec;
    std::string_view line, family;
    const Catalogue* catalogue = nullptr;  ///< for the text of an error; may be missing
    const AxisPicture& picture;
    std::int64_t at_unix_ns = 0;                ///< of picture.at
    std::optional<std::int64_t> now_unix_ns{};  ///< for age_ms; without it that member is left out (the live feed)
};
/// The site's members, then those of the table, in its order.
[[nodiscard]] boost::json::object axis_document(const AxisView& view, AxisPointRows rows = axis_point_table);

[[nodiscard]] boost::json::object drive_document(const SiteState& site, std::size_t index, const DriveStatus& status);
[[nodiscard]] boost::json::object line_document(const SiteState& site, std::size_t index, const LineReport& report);
[[nodiscard]] boost::json::object event_document(const Event& event);
[[nodiscard]] boost::json::object frame_document(const TraceEntry& entry, const std::vector<std::string>& decoded = {});

/// A parameter of the catalogue. For an array `point` is the element, or the first one, and `id` says which: `N[17]`, or `N`.
[[nodiscard]] boost::json::object parameter_document(const Catalogue& catalogue, Point point, std::string_view id);
/// A command of this catalogue, with the question for a person before it is sent (`confirm` of the catalogue's document).
[[nodiscard]] boost::json::object command_document(const Catalogue& catalogue, const CatalogueCommand& command);
[[nodiscard]] boost::json::object error_document(const ErrorCode& error);
/// A family, with all members of its catalogue except the three lists.
[[nodiscard]] boost::json::object family_document(const FamilyEntry& entry);

/// Members of the documents above that only show the state: requests may contain them, and they are ignored. For an axis use
/// is_document_member.
[[nodiscard]] bool is_read_only_drive_member(std::string_view name) noexcept;
[[nodiscard]] bool is_read_only_line_member(std::string_view name) noexcept;

/// A parameter of an axis: the catalogue's entry, the live value, and the last write through the gateway.
[[nodiscard]] boost::json::object axis_parameter_document(const Catalogue& catalogue, Point point, std::string_view id,
                                                          const LiveParameter& live, const StoredParameter* stored, std::string_view text);

}  // namespace axisgate
