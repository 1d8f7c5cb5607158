// Profiles: units of registers that speak another device's language, whatever drives are behind their axes.
// In: the entries of a site's `profiles`. Out: checked entries; all faults at once, each with its place and a remedy.
// Never knows what stands at an address: that is gateway/registers/profiles.
#pragma once

#include <boost/json/object.hpp>
#include <boost/json/value.hpp>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {

enum class MapWordOrder : std::uint8_t;
struct Site;
struct SiteFault;

/// Whose registers a unit speaks; the names are those of the documents and of schema/profiles.
enum class ProfileLanguage : std::uint8_t { cia402, lexium, pacontrol, linmot };
inline constexpr std::size_t profile_language_count = 4;
[[nodiscard]] std::string_view name_of(ProfileLanguage language) noexcept;
[[nodiscard]] std::optional<ProfileLanguage> profile_language_named(std::string_view name) noexcept;
/// Axes that one unit of the language has at most.
[[nodiscard]] std::size_t most_axes(ProfileLanguage language) noexcept;

struct ProfileAxis {
    std::string axis;
    /// Counts of the language for one unit of the axis (mm, deg), > 0. Absent: as the language has it: increments (cia402, lexium), the
    /// unit itself (pacontrol), 0.1 micrometre of an axis in mm (linmot).
    std::optional<double> counts_per_unit;
    std::optional<double> velocity;      ///< unit/s, > 0: where the language starts from, and its 100 %
    std::optional<double> acceleration;  ///< unit/s^2, > 0
    bool operator==(const ProfileAxis&) const = default;
};

struct ProfileSpec {
    std::uint8_t unit = 2;  ///< 2..254, without mappings and other profiles
    ProfileLanguage language = ProfileLanguage::cia402;
    std::optional<MapWordOrder> word_order;  ///< of 32-bit values; absent: the language's own
    std::vector<ProfileAxis> axes;           ///< in the order in which the language numbers them
    /// On EtherNet/IP: assembly instances of the language's image, and the instance of its objects (lexium). Absent: it has none there.
    std::optional<std::uint16_t> input_assembly, output_assembly, object_instance;
    bool operator==(const ProfileSpec&) const = default;
};

/// Reads `profiles` into the site, whose axes must have been read.
void read_profiles(const boost::json::value* list, Site& site, std::vector<SiteFault>& faults);
/// Faults of units that a mapping of the site has as well.
void check_profile_units(const Site& site, std::vector<SiteFault>& faults);
[[nodiscard]] boost::json::object to_json(const ProfileSpec& profile);

}  // namespace axisgate
