// The profiles of a site: units whose registers are those of another device, for any drives. The entries of `profiles` are checked; all
// faults are reported at once, each with place and remedy. The content of the registers is in gateway/registers/profiles.
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

/// The device whose registers a unit has; the names are those of the documents and of schema/profiles.
enum class ProfileLanguage : std::uint8_t { cia402, lexium, pacontrol, linmot };
inline constexpr std::size_t profile_language_count = 4;
[[nodiscard]] std::string_view name_of(ProfileLanguage language) noexcept;
[[nodiscard]] std::optional<ProfileLanguage> profile_language_named(std::string_view name) noexcept;
/// The largest number of axes of one unit.
[[nodiscard]] std::size_t most_axes(ProfileLanguage language) noexcept;

struct ProfileAxis {
    std::string axis;
    /// Counts of the profile per unit of the axis (mm, deg), > 0. Absent: the profile's own choice: increments (cia402, lexium), the unit
    /// itself (pacontrol), 0.1 micrometre for an axis in mm (linmot).
    std::optional<double> counts_per_unit;
    std::optional<double> velocity;      ///< unit/s, > 0: initial value of the profile, and its 100 %
    std::optional<double> acceleration;  ///< unit/s^2, > 0
    bool operator==(const ProfileAxis&) const = default;
};

struct ProfileSpec {
    std::uint8_t unit = 2;  ///< 2..254, without mappings and other profiles
    ProfileLanguage language = ProfileLanguage::cia402;
    std::optional<MapWordOrder> word_order;  ///< of 32-bit values; absent: that of the profile
    std::vector<ProfileAxis> axes;           ///< in the order of their numbers in the profile
    /// For EtherNet/IP: the assembly instances of the profile's image, and the instance of its objects (lexium). Absent: it has none.
    std::optional<std::uint16_t> input_assembly, output_assembly, object_instance;
    bool operator==(const ProfileSpec&) const = default;
};

/// Reads `profiles` into the site, whose axes must have been read.
void read_profiles(const boost::json::value* list, Site& site, std::vector<SiteFault>& faults);
/// Reports units that are also used by mappings of the site.
void check_profile_units(const Site& site, std::vector<SiteFault>& faults);
[[nodiscard]] boost::json::object to_json(const ProfileSpec& profile);

}  // namespace axisgate
