// Changes of the site's own register maps, assemblies and profiles. Each is a changed document that is checked as a whole.
#pragma once

#include <boost/json/array.hpp>
#include <boost/json/object.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/registers/profiles/language.hpp"
#include "gateway/services/refusal.hpp"
#include "gateway/site/assembly.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {

// --- mappings ---
// Null if the id does not exist.
[[nodiscard]] const Mapping* mapping_named(const Site& site, std::string_view id);

struct EditedMapping {
    Site site;
    std::string id;  ///< of the entry
};
[[nodiscard]] Refusable<EditedMapping> with_mapping(const Site& before, const Families& families, const boost::json::object& entry);
/// The entry replaces `id`; without an id of its own it keeps that one.
[[nodiscard]] Refusable<EditedMapping> with_mapping_replaced(const Site& before, const Families& families, const std::string& id,
                                                             const boost::json::object& entry);

/// The selected mappings: those that fit every given condition.
struct MappingChoice {
    std::int64_t unit = 0;  ///< 0: of any
    std::optional<std::string> axis;
    std::optional<std::vector<std::string>> ids;
};
struct RemovedMappings {
    Site site;
    boost::json::array removed;  ///< their ids
};
/// An id that does not exist is refused.
[[nodiscard]] Refusable<RemovedMappings> without_mappings(const Site& before, const Families& families, const MappingChoice& choice);

/// A unit of registers: the setting for its gaps, of the site or of the host, and the number of its mappings.
[[nodiscard]] boost::json::object unit_document(const Site& site, std::uint8_t unit, MapGaps of_host);
[[nodiscard]] boost::json::array units_document(const Site& site, MapGaps of_host);

// --- free places, and templates ---
// The first place with this number of free registers, or bits, in a row, at a multiple of `align`.
[[nodiscard]] Refusable<std::uint32_t> next_free(const Site& site, std::int64_t unit, MapTable table, std::uint32_t words,
                                                 std::uint32_t align);
struct TemplateWish {
    std::string axis;
    std::int64_t unit = 0;
    std::optional<std::int64_t> address;  ///< empty: the next free place
    bool dry_run = false;
};
[[nodiscard]] TemplateWish read_template_wish(const boost::json::object& body, std::vector<Fault>& faults);
/// The registers of the standard map as mappings of the requested unit.
[[nodiscard]] boost::json::array template_entries(const TemplateWish& wish, std::int64_t address, MapWordOrder order);
struct AddedMappings {
    Site site;
    boost::json::array added;
};
[[nodiscard]] Refusable<AddedMappings> with_mappings(const Site& before, const Families& families, const boost::json::array& entries);

// --- assemblies and profiles ---
[[nodiscard]] const AssemblySpec* assembly_of(const Site& site, std::int64_t instance);
/// All of them, including those of profiles, with the content of their bytes.
[[nodiscard]] boost::json::array assembly_list(const Site& site, const registers::Languages& pages);
[[nodiscard]] Refusable<Site> with_assembly(const Site& before, const Families& families, std::int64_t instance, boost::json::object entry);
[[nodiscard]] Refusable<Site> without_assembly(const Site& before, const std::string& instance);

[[nodiscard]] const ProfileSpec* profile_of(const Site& site, std::int64_t unit);
[[nodiscard]] boost::json::object language_document(ProfileLanguage language, const registers::Language& page);
[[nodiscard]] Refusable<Site> with_profile(const Site& before, const Families& families, std::int64_t unit, boost::json::object entry);
[[nodiscard]] Refusable<Site> without_profile(const Site& before, const Families& families, const std::string& unit);

}  // namespace axisgate
