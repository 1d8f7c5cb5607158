// An adapter that only asks. A comparison must not change the drive that it looks at, but most adapters write when they have found a drive:
// the mode of its link, its PDOs, its monitoring of the gateway. The comparison gives its line and its drive this option, which no page
// offers, so that no site can name it. Commands of clients are carried out all the same.
#pragma once

#include <map>
#include <string>

namespace axisgate {

inline constexpr const char* only_reads_option = "only_reads";

/// The adapter sends nothing by itself that changes the drive, and asks for nothing whose reading changes it.
[[nodiscard]] inline bool only_reads(const std::map<std::string, std::string>& options) { return options.contains(only_reads_option); }

}  // namespace axisgate
