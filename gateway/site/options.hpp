// Options: what a family lets a site say of a line, of a drive and of its twin, as its catalogue lists them.
// In: names and values as text. Out: empty, or what is wrong and what would be right. Never applies one: that is the family's own work.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/catalogue.hpp"
#include "gateway/site/site.hpp"

namespace axisgate {

/// Where an option belongs. A twin's stand beside those of its drive, or of its line for all twins of that.
enum class OptionOf : std::uint8_t { line, drive, twin };

/// Empty if one of `places` has this option with this value; else "modell is no option of uim342: crc, in_flight, ...", or
/// "home_input = 9: write 1 to 3".
[[nodiscard]] std::string check_option(const Catalogue& catalogue, std::initializer_list<OptionOf> places, std::string_view name,
                                       std::string_view value);

/// One entry of a site whose options nobody will read as they stand.
struct OptionFault {
    std::string line, drive;  ///< which; a drive's has both
    std::string text;
    bool adapter_says = false;  ///< its name is the adapter's own: that says so when it is configured
};
/// All of a site. They do not make it unusable: an option that is not understood counts as not given.
[[nodiscard]] std::vector<OptionFault> check_options(const Site& site, const Families& families);

}  // namespace axisgate
