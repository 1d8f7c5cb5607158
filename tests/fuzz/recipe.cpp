// Fuzz target for recipes as JSON, with arguments, and the label of every step: the document, and behind a line "---" the arguments. Laws:
// a recipe or faults with places and texts, never both; the number of steps is correct; a good document stays good with its own defaults.
#include "gateway/services/recipes/recipe_read.hpp"

#include <boost/json.hpp>

#include "gateway/core/json_read.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;
namespace json = boost::json;

namespace {
std::optional<json::object> object_of(std::string_view text) {
    boost::system::error_code ec;
    json::value v = json::parse(text, ec);
    if (ec || !v.is_object()) return std::nullopt;
    return std::move(v.get_object());
}

std::optional<Recipe> read(const json::object& document, const json::object* arguments) {
    std::vector<SiteFault> faults;
    auto recipe = read_recipe(document, arguments, faults);
    require(recipe.has_value() == faults.empty(), "a recipe or faults, never both and never neither");
    for (const auto& f : faults) {
        require(f.pointer.empty() || f.pointer[0] == '/', "a fault has a place");
        require(!f.text.empty(), "a fault has words");
        require(arguments || !f.pointer.starts_with("/arguments"), "nobody is blamed for arguments that were not given");
    }
    if (!recipe) return recipe;
    std::size_t count = 0;
    for_each_step(recipe->steps, [&](const RecipeStep& s) {
        ++count;
        require(!label_of(s, "").empty(), "a step can be shown");
        (void)is_motion(s);
    });
    require(count == recipe->count, "steps are counted as they are");
    return recipe;
}
}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size > 32 * 1024) return 0;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const auto cut = text.find("\n---\n");
    const auto document = object_of(text.substr(0, cut));
    if (!document) return 0;
    const auto alone = read(*document, nullptr);
    const auto arguments = cut == std::string_view::npos ? json::object() : object_of(text.substr(cut + 5)).value_or(json::object());
    (void)read(*document, &arguments);
    if (!alone) return 0;
    const auto whole = whole_arguments(*document, arguments);
    for (const auto& [name, value] : arguments)
        require(whole.contains(name), "an argument that was given stays");
    (void)read(*document, &whole);
    return 0;
}
