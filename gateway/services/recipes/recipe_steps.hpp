// Makes the command of a step for this gateway, or the faults with pointers and remedies. Registers go through the same mappings and checks
// as writes of the Modbus door. Nothing is submitted here.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gateway/services/ports/axes.hpp"
#include "gateway/services/ports/site.hpp"
#include "gateway/services/recipes/recipe.hpp"

namespace axisgate {

struct StepCommand {
    Command command;   ///< without an origin
    std::string axis;  ///< its axis; for write_register the register map determines it
};
/// The command of a step that is one (not a wait, a condition or a message).
[[nodiscard]] std::optional<StepCommand> command_of(const RecipeStep& step, const SitePort& sites, std::vector<SiteFault>& faults);
/// The read of a condition's parameter.
[[nodiscard]] std::optional<Command> read_of(const RecipeStep& step, const SitePort& sites, std::vector<SiteFault>& faults);
/// Checks every step against the site: axes, parameters, values, registers. Fills in the axes of write_register.
void check_recipe(Recipe& recipe, const SitePort& sites, std::vector<SiteFault>& faults);
/// Checks that the axes of `simulate` steps are simulated now, because such a condition must never be set at a real drive.
void check_simulated(const Recipe& recipe, const SitePort& sites, const AxisPort& axes, std::vector<SiteFault>& faults);
/// Checks a document without arguments, perhaps made for another site, for steps that no similar site could carry out: the form of the
/// commands, and registers of units with another device's language.
void check_recipe_form(const Recipe& recipe, const Site& site, std::vector<SiteFault>& faults);
/// Every axis that it can command or read; those that it commands first.
[[nodiscard]] std::vector<std::string> commanded_axes(const Recipe& recipe);

}  // namespace axisgate
