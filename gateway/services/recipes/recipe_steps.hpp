// Recipe steps: what a step of a recipe is for this gateway: the Command that it becomes, or why it cannot become one.
// In: steps with their wishes, the site in force. Out: commands; faults with pointers and remedies.
// Never submits anything. Registers go through the same mappings and checks as the Modbus door's writes.
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
    std::string axis;  ///< whose it is; of write_register the register map says it
};
/// The command of a step that is one (not a wait, a condition or a message).
[[nodiscard]] std::optional<StepCommand> command_of(const RecipeStep& step, const SitePort& sites, std::vector<SiteFault>& faults);
/// The read of a condition's parameter.
[[nodiscard]] std::optional<Command> read_of(const RecipeStep& step, const SitePort& sites, std::vector<SiteFault>& faults);
/// Every step against the site: axes, parameters, values, registers. Fills in the axes of write_register.
void check_recipe(Recipe& recipe, const SitePort& sites, std::vector<SiteFault>& faults);
/// Whether the axes that `simulate` steps speak of are simulated now: a real drive is never told what is not so.
void check_simulated(const Recipe& recipe, const SitePort& sites, const AxisPort& axes, std::vector<SiteFault>& faults);
/// What no site that is like this one could carry out, for a document without arguments and perhaps of another site: the form of the
/// commands, and registers of units that speak another device's language.
void check_recipe_form(const Recipe& recipe, const Site& site, std::vector<SiteFault>& faults);
/// Every axis that it can command or looks at; those that it commands first.
[[nodiscard]] std::vector<std::string> commanded_axes(const Recipe& recipe);

}  // namespace axisgate
