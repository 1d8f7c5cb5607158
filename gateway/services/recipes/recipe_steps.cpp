// A command is made as for POST .../commands, a register write by the offsets of the standard map or by the mappings. Nothing is submitted
// here.
#include "gateway/services/recipes/recipe_steps.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/axis/process_data.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/site/mapping.hpp"

namespace axisgate {
namespace {
using Kind = RecipeStep::Kind;

std::string pointer_in(const RecipeStep& s, std::string_view member) {
    return fmt::format("{}/{}{}{}", s.pointer, name_of(s.kind), member.empty() ? "" : "/", member);
}

std::optional<AxisPlace> axis_of(std::string_view name, const std::string& pointer, const SitePort& sites, std::vector<SiteFault>& faults) {
    auto place = find_axis(sites, name);
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

/// A unit with another device's language: its registers are orders of that language, which no single command can represent.
bool speaks_otherwise(const RecipeStep& s, const Site& site, std::vector<SiteFault>& faults) {
    const auto profile = std::ranges::find(site.profiles, std::get<RegisterWish>(s.wish).unit, &ProfileSpec::unit);
    if (profile == site.profiles.end()) return false;
    faults.push_back(
        {pointer_in(s, "unit"),
         fmt::format("unit {} speaks the language {}: a recipe does not write its registers", profile->unit, name_of(profile->language)),
         "give the axis a command, or write the standard map (unit 1) or a mapping", false});
    return true;
}

std::optional<StepCommand> register_of(const RecipeStep& s, const SitePort& sites, std::vector<SiteFault>& faults) {
    const auto& wish = std::get<RegisterWish>(s.wish);
    if (!as_number(wish.value)) {
        faults.push_back({pointer_in(s, "value"), "value must be a number, true or false", "write what the register shall hold", false});
        return std::nullopt;
    }
    const auto wrong_type = [&](std::string_view is) {
        if (!wish.type || *wish.type == is) return false;
        faults.push_back({pointer_in(s, "type"), fmt::format("the register at {} of unit {} is of type {}", wish.address, wish.unit, is),
                          fmt::format("write \"type\": \"{}\", or leave it out", is), false});
        return true;
    };
    const auto site = sites.site();
    if (speaks_otherwise(s, site->site, faults)) return std::nullopt;
    StepCommand out;
    Command& c = out.command;
    if (registers::is_standard_unit(wish.unit)) {
        const auto axis = std::ranges::find(site->site.axes, wish.address / registers::registers_per_axis + 1, &AxisSpec::number);
        const auto rows = registers::standard_registers();
        const auto reg = std::ranges::find(rows, wish.address % registers::registers_per_axis, &registers::RegisterRow::offset);
        const auto point = reg == rows.end() || !reg->writable ? std::nullopt : axis_point_named(reg->point);
        if (axis == site->site.axes.end() || !point) {
            faults.push_back({pointer_in(s, "address"),
                              fmt::format("nothing that can be written begins at {} of the standard map", wish.address),
                              "axis n has its set-points at (n-1)*64 + 32, 33, 34, 36, 38, 40, 42, 44", false});
            return std::nullopt;
        }
        if (wrong_type(name_of(reg->type))) return std::nullopt;
        auto body = process_data(s, *point, wish.value, faults);
        if (!body) return std::nullopt;
        out.axis = axis->name;
        c.axis = axis_at(sites, site, static_cast<std::size_t>(axis - site->site.axes.begin())).id();
        c.body = std::move(*body);
        return out;
    }
    const auto& mappings = site->site.map();
    const auto m = std::ranges::find_if(mappings, [&wish](const Mapping& x) {
        return x.unit == wish.unit && x.address == wish.address && (x.table == MapTable::holding_registers || x.table == MapTable::coils) &&
               x.access != MapAccess::read;
    });
    if (m == mappings.end()) {
        faults.push_back({pointer_in(s, "address"),
                          fmt::format("no mapping that can be written begins at {} of unit {}", wish.address, wish.unit),
                          "see /api/v1/mappings", false});
        return std::nullopt;
    }
    if (wrong_type(name_of(m->type))) return std::nullopt;
    std::array<std::uint8_t, 128> bytes{};
    Mapping plain = *m;  // the given value is that of the register, so the scale is not applied
    plain.scale = 1;
    plain.offset = 0;
    if (m->type == MapType::string || !encode(plain, wish.value, bytes.data())) {
        faults.push_back({pointer_in(s, "value"),
                          fmt::format("{} does not fit a register of type {}", to_text(wish.value), name_of(m->type)),
                          "write a value of its range", false});
        return std::nullopt;
    }
    const Value meant = decode(*m, bytes.data());
    const auto place = find_axis(sites, m->axis);
    if (!place) return std::nullopt;
    out.axis = m->axis;
    c.axis = place->id();
    auto body = std::holds_alternative<AxisPoint>(m->what)
                    ? process_data(s, std::get<AxisPoint>(m->what), meant, faults)
                    : write_of(*place, std::get<Point>(m->what), meant, pointer_in(s, "value"), faults);
    if (!body) return std::nullopt;
    c.body = std::move(*body);
    return out;
}

std::optional<CommandBody> plain_command(const RecipeStep& s, double scale, std::string_view unit, std::vector<SiteFault>& faults,
                                         bool form_alone) {
    auto made = make_command(std::get<CommandWish>(s.wish), scale, unit);
    if (!made.body && !(form_alone && made.range_only)) {
        for (auto& f : made.faults)
            faults.push_back({pointer_in(s, "") + f.pointer, f.text, f.remedy, false});
    }
    return std::move(made.body);
}

std::optional<CommandBody> parameter_write(const RecipeStep& s, const AxisPlace& place, std::vector<SiteFault>& faults) {
    const auto& wish = std::get<ParameterWish>(s.wish);
    if (!known(wish.value)) {
        faults.push_back({pointer_in(s, "value"), "value must be a number, a text, true or false", "correct it", false});
        return std::nullopt;
    }
    const auto point = parameter_of(place, wish.parameter, pointer_in(s, "parameter"), faults);
    return point ? write_of(place, *point, wish.value, pointer_in(s, "value"), faults) : std::nullopt;
}

std::optional<CommandBody> action_of(const RecipeStep& s, const AxisPlace& place, std::vector<SiteFault>& faults) {
    const auto& wish = std::get<ActionWish>(s.wish);
    Action action{wish.name, wish.argument};
    std::vector<Fault> wrong;
    read_arguments(place, action, nullptr, "", wrong);
    for (auto& f : wrong)
        faults.push_back({pointer_in(s, "argument"), std::move(f.text), std::move(f.remedy), false});
    if (!wrong.empty()) return std::nullopt;
    return action;
}

std::optional<CommandBody> hand_of(const RecipeStep& s, std::vector<SiteFault>& faults) {
    const auto& wish = std::get<SimulateWish>(s.wish);
    if (known(wish.value)) return Hand{wish.input, wish.value};
    faults.push_back({pointer_in(s, "value"), "value must be a number, a text, true or false",
                      "see what GET /api/v1/drives/{drive}/hand?describe=1 offers", false});
    return std::nullopt;
}

std::optional<CommandBody> body_of(const RecipeStep& s, const AxisPlace& place, std::vector<SiteFault>& faults) {
    switch (s.kind) {
        case Kind::set_parameter:
            return parameter_write(s, place, faults);
        case Kind::read_parameter:
            if (const auto point = parameter_of(place, std::get<ParameterWish>(s.wish).parameter, pointer_in(s, "parameter"), faults))
                return ReadParameter{*point};
            return std::nullopt;
        case Kind::enable:
            return Enable{};
        case Kind::disable:
            return Disable{};
        case Kind::home:
        case Kind::command:
            return plain_command(s, place.spec().increments_per_unit, place.spec().unit, faults, false);
        case Kind::action:
            return action_of(s, place, faults);
        case Kind::simulate:
            return hand_of(s, faults);
        default:
            return std::nullopt;
    }
}
}  // namespace

std::optional<StepCommand> command_of(const RecipeStep& s, const SitePort& sites, std::vector<SiteFault>& faults) {
    if (s.kind == Kind::write_register) return register_of(s, sites, faults);
    const auto place = axis_of(s.axis, pointer_in(s, "axis"), sites, faults);
    auto body = place ? body_of(s, *place, faults) : std::nullopt;
    if (!body) return std::nullopt;
    StepCommand out;
    out.axis = s.axis;
    out.command.axis = place->id();
    out.command.body = std::move(*body);
    out.command.until_done = s.until_done;
    return out;
}

std::optional<Command> read_of(const RecipeStep& s, const SitePort& sites, std::vector<SiteFault>& faults) {
    const bool nested = s.kind == Kind::branch || s.kind == Kind::repeat;
    const std::string at = pointer_in(s, s.kind == Kind::branch   ? "condition"
                                         : s.kind == Kind::repeat ? "until"
                                                                  : "") +
                           (nested ? "/" : "/");
    const auto place = axis_of(s.condition->axis, at + "axis", sites, faults);
    if (!place || !s.condition->reads_drive()) return std::nullopt;
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
            if (auto made = command_of(s, sites, faults)) s.axis = std::move(made->axis);
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
                          presence == Presence::device ? fmt::format("{} is a real drive now: {} cannot be simulated on it", s.axis,
                                                                     std::get<SimulateWish>(s.wish).input)
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
