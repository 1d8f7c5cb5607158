// One case for each word that has members of its own.
#include "gateway/services/recipes/recipe_wish.hpp"

#include "gateway/core/json_read.hpp"
#include "gateway/services/command_reader.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
using Kind = RecipeStep::Kind;

std::string text_in(const json::object& body, std::string_view key) {
    const auto* v = body.if_contains(key);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}
/// A value out of its range is reported as a fault of the document elsewhere.
int whole_in(const json::object& body, std::string_view key) {
    const auto* v = body.if_contains(key);
    const double d = v && v->is_number() ? v->to_number<double>() : 0;
    return d >= 0 && d <= 65535 ? static_cast<int>(d) : 0;
}
Value value_in(const json::object& body) {
    const auto* v = body.if_contains("value");
    return v ? value_of_json(*v) : Value{};
}

/// The members of POST /axes/{name}/commands, without those of the recipe itself.
CommandWish command_in(Kind kind, const json::object& body) {
    json::object o;
    for (const auto& [k, v] : body) {
        if (k != "axis" && k != "wait_s") o[k] = v;
    }
    if (kind == Kind::home) o["command"] = "home";
    return read_command_wish(o);
}
}  // namespace

StepWish read_step_wish(Kind kind, const json::object& body) {
    switch (kind) {
        case Kind::set_parameter:
        case Kind::read_parameter:
            return ParameterWish{text_in(body, "parameter"), value_in(body)};
        case Kind::home:
        case Kind::command:
            return command_in(kind, body);
        case Kind::action:
            return ActionWish{text_in(body, "name"), text_in(body, "argument")};
        case Kind::write_register: {
            RegisterWish wish{whole_in(body, "unit"), whole_in(body, "address"), std::nullopt, value_in(body)};
            if (body.contains("type")) wish.type = text_in(body, "type");
            return wish;
        }
        case Kind::simulate:
            return SimulateWish{text_in(body, "input"), value_in(body)};
        default:
            return {};
    }
}

}  // namespace axisgate
