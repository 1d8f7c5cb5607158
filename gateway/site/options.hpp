// Checks the options of lines, drives and twins in a site against the lists in the catalogues of their families. The families apply the
// options.
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

/// The place of an option. The options of a twin are beside those of its drive, or of its line for all twins of that line.
enum class OptionOf : std::uint8_t { line, drive, twin };

/// Empty if one of `places` has this option and permits the value; otherwise "modell is no option of uim342: crc, in_flight, ...", or
/// "home_input = 9: write 1 to 3".
[[nodiscard]] std::string check_option(const Catalogue& catalogue, std::initializer_list<OptionOf> places, std::string_view name,
                                       std::string_view value);

/// An option of a site that will not be used.
struct OptionFault {
    std::string line, drive;  ///< a drive's option has both
    std::string text;
    bool adapter_says = false;  ///< the name belongs to the adapter, which reports the fault when it is configured
};
/// All such options of a site. They do not make it invalid: an option that is not understood counts as not given.
[[nodiscard]] std::vector<OptionFault> check_options(const Site& site, const Families& families);

}  // namespace axisgate
