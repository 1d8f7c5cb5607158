// Freedoms: the choices that a manual or a standard leaves to a drive, and that real drives make in different ways (reply time, optional
// objects, order of messages, strength of the motor). A family's page lists them under "freedoms"; a specimen has one value for each.
// Values are whole numbers in the unit of the freedom; twins receive them in TwinSetup::freedoms.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace axisgate {

/// Values by the name of their freedom.
using FreedomValues = std::map<std::string, std::int64_t, std::less<>>;

struct Freedom {
    std::string name;                                           ///< snake_case with its unit last ("reply_ms"), unique in the page
    std::string unit;                                           ///< "ms", "per_mille", "increments" ...; empty: a plain number
    std::int64_t min = 0, max = 0;                              ///< both inclusive
    std::int64_t fallback = 0;                                  ///< "default": the drive as its manual shows it, which is specimen 0
    std::string description;                                    ///< a sentence without a full stop
    std::string source;                                         ///< line of the manual, section of the standard, "silent", public report
    std::vector<std::pair<std::int64_t, std::string>> values;   ///< the only values, with their meaning; empty: min..max decides
    std::map<std::string, std::int64_t, std::less<>> extremes;  ///< "named": its value in named specimens, where it is not the default
};

/// The value of a freedom; `fallback`, which must be the page's default, if the map does not have it.
[[nodiscard]] inline std::int64_t freedom(const FreedomValues& of, std::string_view name, std::int64_t fallback = 0) {
    const auto it = of.find(name);
    return it == of.end() ? fallback : it->second;
}

}  // namespace axisgate
