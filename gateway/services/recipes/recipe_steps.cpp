// Recipe steps: a command goes through the reader of POST .../commands, a register by the standard map's offsets or the mappings.
// In: steps, the site. Out: commands, faults with pointers. Never submits anything.
#include "gateway/services/recipes/recipe_steps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/axis/process_data.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/command_reader.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
using Kind = RecipeStep::Kind;

std::optional<Value> scalar(const json::value& v) {
    if (v.is_bool()) return Value{v.get_bool()};
    if (v.is_int64()) return Value{v.get_int64()};
    if (v.is_double()) return Value{v.get_double()};
    if (v.is_string()) return Value{std::string(v.get_string())};
    return std::nullopt;
}

std::string text_of(const RecipeStep& s, std::string_view key) {
    const auto* v = s.body.if_contains(key);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}

std::string pointer_in(const RecipeStep& s, std::string_view member) {
    return fmt::format("{}/{}{}{}", s.pointer, name_of(s.kind), member.empty() ? "" : "/", member);
}

std::optional<AxisPlace> axis_of(const RecipeStep& s, std::string_view name, const std::string& pointer, const SitePort& sites,
                                 std::vector<SiteFault>& faults) {
    auto place = find_axis(sites, name);
    (void)s;
    if (!place) faults.push_back({pointer, fmt::format("there is no axis {}", name), "see /api/v1/axes", false});
    return place;
}

std::optional<Point> parameter_of(const AxisPlace& place, std::string_view name, const std::string& pointer,
                                  std::vector<SiteFault>& faults) {
    const auto point = place.catalogue ? place.catalogue->find(name) : std::nullopt;
    if (!point)
        faults.push_back({pointer, fmt::format("a {} has no parameter {}", place.family, name),
                          fmt::format("see /api/v1/families/{}/parameters", place.family), false});
    return point;
}

std::optional<CommandBody> write_of(const AxisPlace& place, Point point, const Value& value, const std::string& pointer,
                                    std::vector<SiteFault>& faults) {
    const std::string id = place.catalogue->id_of(point);
    if (!place.catalogue->parameter(point)->writable()) {
        faults.push_back({pointer, fmt::format("{} can only be read", id), "leave the step out", false});
        return std::nullopt;
    }
    auto checked = place.catalogue->check_write(point, value);
    if (!checked.fault.empty()) {
        faults.push_back({pointer, checked.fault, "write a value that the catalogue allows", false});
        return std::nullopt;
    }
    return WriteParameter{point, std::move(checked.value)};
}

/// The command reader's object: the step's members without those that are the recipe's own.
json::object command_body(const RecipeStep& s) {
    json::object o;
    for (const auto& [k, v] : s.body) {
        if (k != "axis" && k != "wait_s") o[k] = v;
    }
    if (s.kind == Kind::home) o["command"] = "home";
    return o;
}

// --- registers ----------------------------------------------------------------------------------------------------------------

std::optional<CommandBody> process_data(const RecipeStep& s, AxisPoint point, const Value& value, std::vector<SiteFault>& faults) {
    ProcessData d;
    const auto n = as_integer(value);
    if (!n || !put_process_data(d, point, *n)) {
        faults.push_back({pointer_in(s, "value"), fmt::format("{} does not fit {}", to_text(value), name_of(point)),
                          "write a whole number of its type", false});
        return std::nullopt;
    }
    return d;
}

/// A unit that speaks another device's language: its registers are orders of that language, which no single command is.
bool speaks_otherwise(const RecipeStep& s, const Site& site, std::vector<SiteFault>& faults) {
    const auto* unit = s.body.if_contains("unit");
    const auto profile =
        unit && unit->is_int64() ? std::ranges::find(site.profiles, unit->get_int64(), &ProfileSpec::unit) : site.profiles.end();
    if (profile == site.profiles.end()) return false;
    faults.push_back(
        {pointer_in(s, "unit"),
         fmt::format("unit {} speaks the language {}: a recipe does not write its registers", profile->unit, name_of(profile->language)),
         "give the axis a command, or write the standard map (unit 1) or a mapping", false});
    return true;
}

std::optional<Command> register_of(RecipeStep& s, const SitePort& sites, std::vector<SiteFault>& faults) {
    const int unit = s.body.at("unit").to_number<int>(), address = s.body.at("address").to_number<int>();
    const auto* type = s.body.if_contains("type");
    const auto value = scalar(s.body.at("value"));
    if (!value || std::holds_alternative<std::string>(*value)) {
        faults.push_back({pointer_in(s, "value"), "value must be a number, true or false", "write what the register shall hold", false});
        return std::nullopt;
    }
    const auto wrong_type = [&](std::string_view is) {
        if (!type || (type->is_string() && type->get_string() == is)) return false;
        faults.push_back({pointer_in(s, "type"), fmt::format("the register at {} of unit {} is of type {}", address, unit, is),
                          fmt::format("write \"type\": \"{}\", or leave it out", is), false});
        return true;
    };
    const auto site = sites.site();
    if (speaks_otherwise(s, site->site, faults)) return std::nullopt;
    Command c;
    if (registers::is_standard_unit(unit)) {
        const auto axis = std::ranges::find(site->site.axes, address / registers::registers_per_axis + 1, &AxisSpec::number);
        const auto rows = registers::standard_registers();
        const auto reg = std::ranges::find(rows, address % registers::registers_per_axis, &registers::RegisterRow::offset);
        const auto point = reg == rows.end() || !reg->writable ? std::nullopt : axis_point_named(reg->point);
        if (axis == site->site.axes.end() || !point) {
            faults.push_back({pointer_in(s, "address"),
                              fmt::format("nothing that can be written begins at {} of the standard map", address),
                              "axis n has its set-points at (n-1)*64 + 32, 33, 34, 36, 38, 40, 42, 44", false});
            return std::nullopt;
        }
        if (wrong_type(name_of(reg->type))) return std::nullopt;
        auto body = process_data(s, *point, *value, faults);
        if (!body) return std::nullopt;
        s.axis = axis->name;
        c.axis = axis_at(sites, site, static_cast<std::size_t>(axis - site->site.axes.begin())).id();
        c.body = std::move(*body);
        return c;
    }
    const auto& mappings = site->site.map();
    const auto m = std::ranges::find_if(mappings, [&](const Mapping& x) {
        return x.unit == unit && x.address == address && (x.table == MapTable::holding_registers || x.table == MapTable::coils) &&
               x.access != MapAccess::read;
    });
    if (m == mappings.end()) {
        faults.push_back({pointer_in(s, "address"), fmt::format("no mapping that can be written begins at {} of unit {}", address, unit),
                          "see /api/v1/mappings", false});
        return std::nullopt;
    }
    if (wrong_type(name_of(m->type))) return std::nullopt;
    std::array<std::uint8_t, 128> bytes{};
    Mapping plain = *m;  // what the register holds is given, so it goes in without the scale and comes out with it
    plain.scale = 1;
    plain.offset = 0;
    if (m->type == MapType::string || !encode(plain, *value, bytes.data())) {
        faults.push_back({pointer_in(s, "value"), fmt::format("{} does not fit a register of type {}", to_text(*value), name_of(m->type)),
                          "write a value of its range", false});
        return std::nullopt;
    }
    const Value meant = decode(*m, bytes.data());
    const auto place = find_axis(sites, m->axis);
    if (!place) return std::nullopt;
    s.axis = m->axis;
    c.axis = place->id();
    auto body = std::holds_alternative<AxisPoint>(m->what)
                    ? process_data(s, std::get<AxisPoint>(m->what), meant, faults)
                    : write_of(*place, std::get<Point>(m->what), meant, pointer_in(s, "value"), faults);
    if (!body) return std::nullopt;
    c.body = std::move(*body);
    return c;
}

std::optional<CommandBody> plain_command(const RecipeStep& s, double scale, std::string_view unit, std::vector<SiteFault>& faults,
                                         bool form_alone) {
    auto read = read_command(command_body(s), scale, unit);
    if (!read.body && !(form_alone && read.range_only)) {
        for (auto& f : read.faults)
            faults.push_back({pointer_in(s, "") + f.pointer, f.text, f.remedy, false});
    }
    return std::move(read.body);
}
}  // namespace

std::optional<Command> command_of(RecipeStep& s, const SitePort& sites, std::vector<SiteFault>& faults) {
    if (s.kind == Kind::write_register) return register_of(s, sites, faults);
    const auto place = axis_of(s, s.axis, pointer_in(s, "axis"), sites, faults);
    if (!place) return std::nullopt;
    Command c;
    c.axis = place->id();
    c.until_done = s.until_done;
    const auto text = [&](std::string_view key) { return text_of(s, key); };
    switch (s.kind) {
        case Kind::set_parameter: {
            const auto value = scalar(s.body.at("value"));
            if (!value) {
                faults.push_back({pointer_in(s, "value"), "value must be a number, a text, true or false", "correct it", false});
                return std::nullopt;
            }
            const auto point = parameter_of(*place, text("parameter"), pointer_in(s, "parameter"), faults);
            auto body = point ? write_of(*place, *point, *value, pointer_in(s, "value"), faults) : std::nullopt;
            if (!body) return std::nullopt;
            c.body = std::move(*body);
            return c;
        }
        case Kind::read_parameter: {
            const auto point = parameter_of(*place, text("parameter"), pointer_in(s, "parameter"), faults);
            if (!point) return std::nullopt;
            c.body = ReadParameter{*point};
            return c;
        }
        case Kind::enable:
            c.body = Enable{};
            return c;
        case Kind::disable:
            c.body = Disable{};
            return c;
        case Kind::home:
        case Kind::command: {
            auto body = plain_command(s, place->spec().increments_per_unit, place->spec().unit, faults, false);
            if (!body) return std::nullopt;
            c.body = std::move(*body);
            return c;
        }
        case Kind::action: {
            Action action{text("name"), text("argument")};
            std::vector<Fault> wrong;
            read_arguments(*place, action, nullptr, "", wrong);
            for (auto& f : wrong)
                faults.push_back({pointer_in(s, "argument"), std::move(f.text), std::move(f.remedy), false});
            if (!wrong.empty()) return std::nullopt;
            c.body = std::move(action);
            return c;
        }
        case Kind::simulate: {
            auto value = scalar(s.body.at("value"));
            if (!value) {
                faults.push_back({pointer_in(s, "value"), "value must be a number, a text, true or false",
                                  "see what GET /api/v1/drives/{drive}/hand?describe=1 offers", false});
                return std::nullopt;
            }
            c.body = Hand{text("input"), std::move(*value)};
            return c;
        }
        default:
            return std::nullopt;
    }
}

std::optional<Command> read_of(const RecipeStep& s, const SitePort& sites, std::vector<SiteFault>& faults) {
    const bool nested = s.kind == Kind::branch || s.kind == Kind::repeat;
    const std::string at = pointer_in(s, s.kind == Kind::branch   ? "condition"
                                         : s.kind == Kind::repeat ? "until"
                                                                  : "") +
                           (nested ? "/" : "/");
    const auto place = axis_of(s, s.condition->axis, at + "axis", sites, faults);
    if (!place || !s.condition->parameter) return std::nullopt;
    const auto point = parameter_of(*place, s.condition->point, at + "parameter", faults);
    if (!point) return std::nullopt;
    Command c;
    c.axis = place->id();
    c.body = ReadParameter{*point};
    c.until_done = true;
    return c;
}

void check_recipe(Recipe& recipe, const SitePort& sites, std::vector<SiteFault>& faults) {
    for_each_step(recipe.steps, [&](RecipeStep& s) {
        if (faults.size() >= 100) return;
        if (s.condition) {
            (void)read_of(s, sites, faults);
        } else if (s.kind != Kind::wait && s.kind != Kind::message && s.kind != Kind::repeat && s.kind != Kind::branch) {
            (void)command_of(s, sites, faults);
        }
    });
}

void check_simulated(const Recipe& recipe, const SitePort& sites, const AxisPort& axes, std::vector<SiteFault>& faults) {
    for_each_step(recipe.steps, [&](const RecipeStep& s) {
        if (s.kind != Kind::simulate || faults.size() >= 100) return;
        const auto place = find_axis(sites, s.axis);
        const auto presence = place ? axes.picture(place->id()).presence : Presence::twin;
        if (presence == Presence::twin) return;
        faults.push_back({pointer_in(s, "axis"),
                          presence == Presence::device
                              ? fmt::format("{} is a real drive now: {} cannot be simulated on it", s.axis, text_of(s, "input"))
                              : fmt::format("{} is not simulated now: nobody answers for it", s.axis),
                          "simulate the drive in the site, or take the step out", false});
    });
}

void check_recipe_form(const Recipe& recipe, const Site& site, std::vector<SiteFault>& faults) {
    for_each_step(recipe.steps, [&](const RecipeStep& s) {
        if (faults.size() < 100 && s.kind == Kind::write_register) (void)speaks_otherwise(s, site, faults);
        if (faults.size() < 100 && (s.kind == Kind::command || s.kind == Kind::home)) (void)plain_command(s, 1, "", faults, true);
    });
}

std::vector<std::string> commanded_axes(const Recipe& recipe) {
    std::vector<std::string> out;
    for_each_step(recipe.steps, [&](const RecipeStep& s) {
        const bool commands = !s.condition && !s.axis.empty() && s.kind != Kind::read_parameter;
        if (commands && std::ranges::find(out, s.axis) == out.end()) out.push_back(s.axis);
    });
    return out;
}

}  // namespace axisgate
