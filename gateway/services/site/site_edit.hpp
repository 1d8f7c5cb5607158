// Site edit: changes of one line, drive or axis as changes of the whole site document.
// In: the document, a name, what was asked. Out: the changed document, or why it is refused.
// Never checks what parse_site checks: the changed document goes through that as a whole.
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
/// The change, or why it cannot be.
using Edited = Refusable<Edit>;

/// `document` has the lists "lines", "drives", "axes" and "mappings", as to_json(Site) gives them.
/// Members that only tell the state are taken out of `entry` first.
[[nodiscard]] Edited add_entry(boost::json::object document, Collection collection, boost::json::object entry);
/// The name in `entry` may be another: then what hangs on the old name follows (409 for an axis that mappings name).
[[nodiscard]] Edited replace_entry(boost::json::object document, Collection collection, std::string_view name, boost::json::object entry);
/// RFC 7396.
[[nodiscard]] Edited patch_entry(boost::json::object document, Collection collection, std::string_view name, boost::json::object patch);
/// `cascade`: what hangs on it goes too; else 409 that names it.
[[nodiscard]] Edited remove_entry(boost::json::object document, Collection collection, std::string_view name, bool cascade);

/// RFC 7396, MergePatch(target, patch).
void merge_patch(boost::json::value& target, const boost::json::value& patch);
/// Whether a mapping names the axis: its member `axis`, or a `point` that begins with the name and one of `.` `/` `:`.
[[nodiscard]] bool mapping_names(const boost::json::value& mapping, std::string_view axis);

}  // namespace axisgate
