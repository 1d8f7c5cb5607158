// The named arguments of a catalogue command, checked and converted to the form for adapters: one value per argument in the catalogue's
// order, in the drive's own counts. An unknown name, a missing value and one out of its range are faults of their own.
#pragma once

#include <boost/json/object.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/catalogue.hpp"

namespace axisgate {

struct ArgumentFault {
    std::string argument;  ///< its name, as given or as in the catalogue
    std::string text;      ///< "position: 300000 is outside -214748.3648..214748.3647 mm"
    std::string remedy;
};
struct CheckedArguments {
    /// One value per argument of the command, in their order; without meaning if there are faults. Numbers are in the drive's counts: the
    /// given value divided by CommandArgument::scale, rounded to the nearest count for whole types.
    std::vector<Value> values;
    std::vector<ArgumentFault> faults;
};

/// By name, in the catalogue's units: {"position": 12.5, "velocity": 0.1}. Arguments with a default may be left out.
[[nodiscard]] CheckedArguments check_arguments(const CatalogueCommand& command, const boost::json::object& given);
/// The same as one text, for recipes and command lines: "position=12.5 velocity=0.1", separated by blanks or commas.
[[nodiscard]] CheckedArguments check_arguments(const CatalogueCommand& command, std::string_view given);

}  // namespace axisgate
