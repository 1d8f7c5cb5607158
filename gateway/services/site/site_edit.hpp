// Changes of one line, drive or axis as changes of the whole site document, which parse_site checks afterwards.
#pragma once

#include <boost/json/object.hpp>
#include <cstdint>
#include <string>
#include <string_view>

#include "gateway/services/refusal.hpp"

namespace axisgate {

enum class Collection : std::uint8_t { lines, drives, axes };
[[nodiscard]] std::string_view list_name(Collection collection) noexcept;  ///< "lines"
[[nodiscard]] std::string_view item_name(Collection collection) noexcept;  ///< "line"

/// A changed site document.
struct Edit {
    boost::json::object document;
    std::string name;     ///< of the entry, after the change
    std::string pointer;  ///< of the entry in the document: "/lines/2"; empty after a removal
};
/// The change, or the refusal.
using Edited = Refusable<Edit>;

/// `document` has the lists "lines", "drives", "axes" and "mappings", as to_json(Site) makes them. Members that only show the state are
/// removed from `entry` first.
[[nodiscard]] Edited add_entry(boost::json::object document, Collection collection, boost::json::object entry);
/// `entry` may contain another name: references to the old name are changed then (409 for an axis that mappings name).
[[nodiscard]] Edited replace_entry(boost::json::object document, Collection collection, std::string_view name, boost::json::object entry);
/// RFC 7396.
[[nodiscard]] Edited patch_entry(boost::json::object document, Collection collection, std::string_view name, boost::json::object patch);
/// `cascade`: entries that refer to it are removed, too; otherwise 409 that names them.
[[nodiscard]] Edited remove_entry(boost::json::object document, Collection collection, std::string_view name, bool cascade);

/// RFC 7396, MergePatch(target, patch).
void merge_patch(boost::json::value& target, const boost::json::value& patch);
/// True if a mapping names the axis: its member `axis`, or a `point` that begins with the name and one of `.` `/` `:`.
[[nodiscard]] bool mapping_names(const boost::json::value& mapping, std::string_view axis);

}  // namespace axisgate
