// Command arguments: what a client gives a catalogue command by name, checked and brought into the one form that adapters read.
// In: a command of the catalogue, and a JSON object or text with its arguments. Out: one value per argument in the catalogue's order, in
// the drive's own counts; or a fault per argument. Never guesses: an unknown name, a missing value or one outside its range is a fault.
#pragma once

#include <boost/json/object.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/core/catalogue.hpp"

namespace axisgate {

struct ArgumentFault {
    std::string argument;  ///< its name, as given or as the catalogue has it
    std::string text;      ///< "position: 300000 is outside -214748.3648..214748.3647 mm"
    std::string remedy;
};
struct CheckedArguments {
    /// As many as the command has arguments, in their order; meaningless if there are faults. Numbers are in the drive's counts: what was
    /// given divided by CommandArgument::scale, rounded to the nearest count for whole types.
    std::vector<Value> values;
    std::vector<ArgumentFault> faults;
};

/// By name, in the catalogue's units: {"position": 12.5, "velocity": 0.1}. What has a default may be left out.
[[nodiscard]] CheckedArguments check_arguments(const CatalogueCommand& command, const boost::json::object& given);
/// The same as one text, for what carries texts alone (recipes, command lines): "position=12.5 velocity=0.1"; blanks or commas between
/// them.
[[nodiscard]] CheckedArguments check_arguments(const CatalogueCommand& command, std::string_view given);

}  // namespace axisgate
