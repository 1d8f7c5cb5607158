// Each command becomes the step that sends it again; times between commands become waits if they matter. Numbers are written such that the
// step sends the same count.
#include "gateway/services/recipes/recipe_record.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "gateway/registers/register_map.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/recipes/recipe.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
namespace reg = registers::reg;

/// The shortest decimal that gives the same count.
double in_units(std::int64_t counts, double per_unit) {
    const double exact = static_cast<double>(counts) / per_unit;
    for (int digits = 6; digits < 17; ++digits) {
        const double d = std::strtod(fmt::format("{:.{}g}", exact, digits).c_str(), nullptr);
        if (std::llround(d * per_unit) == counts) return d;
    }
    return exact;
}
json::value number_or_count(double d) {
    if (std::nearbyint(d) == d && std::fabs(d) < 1e15) return static_cast<std::int64_t>(d);
    return d;
}
double length_s(Duration d) { return std::chrono::duration<double>(d).count(); }
double tenths(Duration d) { return std::round(length_s(d) * 10) / 10; }
json::object wait_step(Duration d) { return {{"wait_s", number_or_count(tenths(std::min(d, RecipeRecord::longest_pause)))}}; }
/// "modbus 192.0.2.7" for commands that came neither from the page nor from the API; otherwise empty.
std::string comment_of(const Origin& o) { return has_users(o.door) ? std::string() : o.text(); }
/// Steps of a recipe carry its name; actions of the gateway itself have no client.
bool by_hand(const Origin& o) {
    if (!has_clients(o.door)) return false;
    return !o.who || !(o.who->starts_with("recipe ") && o.who->find(" by ") != std::string::npos);
}
}  // namespace

RecipeRecord::RecipeRecord(std::vector<AxisPlace> axes, Instant from, Instant to) : axes_(std::move(axes)), from_(from), to_(to) {}

std::optional<std::size_t> RecipeRecord::place_of(AxisId axis) const {
    const auto it = std::ranges::find_if(axes_, [&](const AxisPlace& p) { return p.id() == axis; });
    return it == axes_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(it - axes_.begin()));
}

void RecipeRecord::leave_out(std::string text) {
    if (left_out_.size() < most_left_out && std::ranges::find(left_out_, text) == left_out_.end()) left_out_.push_back(std::move(text));
}

void RecipeRecord::take(const FlightRecord& r) {
    const bool inside = r.at >= from_ && r.at <= to_;
    switch (r.kind) {
        case FlightKind::command:
            if (!inside) return;
            if (const auto c = unpack<CommandRecord>(r.payload); c && by_hand(c->command.origin)) command(c->command, r.at);
            return;
        case FlightKind::set_point:
            if (!inside) return;
            if (const auto i = place_of(AxisId{r.index}))
                leave_out(fmt::format("{}: a stream of set-points; a recipe has steps, not cycles", axes_[*i].spec().name));
            return;
        case FlightKind::hand:
            if (inside) hand(r);
            return;
        case FlightKind::result:
            if (const auto result = unpack<Result>(r.payload); result && result->outcome == Outcome::refused) {
                std::erase_if(drafts_, [&](const Draft& d) {
                    if (d.ticket == no_ticket || d.ticket != result->ticket) return false;
                    const auto* name = d.body.if_contains("command");
                    leave_out(fmt::format("{}: {} was refused: {}", axes_[d.axis].spec().name,
                                          name ? std::string(name->get_string()) : d.word, result->text));
                    return true;
                });
            }
            return;
        case FlightKind::picture:
            picture(r);
            return;
        default:
            return;
    }
}

void RecipeRecord::picture(const FlightRecord& r) {
    if (r.at < from_ || r.at > to_) return;
    const auto axis = place_of(AxisId{r.index});
    const auto p = axis ? unpack<PictureRecord>(r.payload) : std::nullopt;
    if (!p) return;
    const bool moving = (p->flags & flag_moving) != 0;
    for (auto d = drafts_.rbegin(); d != drafts_.rend(); ++d) {  // the newest motion of the axis
        if (d->axis != *axis || d->after != After::motion) continue;
        if (moving) {
            d->seen_moving = true;
            d->stood.reset();
        } else if (d->seen_moving && !d->stood) {
            d->stood = r.at;
        }
        return;
    }
}

void RecipeRecord::add(std::string word, json::object body, std::size_t axis, const Command& c, Instant at, After after) {
    if (drafts_.size() >= most_recipe_steps) {
        full_ = true;
        return;
    }
    Draft d;
    d.word = std::move(word);
    d.body = std::move(body);
    d.axis = axis;
    d.at = at;
    d.ticket = c.ticket;
    d.after = after;
    if (auto comment = comment_of(c.origin); !comment.empty()) d.body["comment"] = std::move(comment);
    drafts_.push_back(std::move(d));
}

void RecipeRecord::command(const Command& c, Instant at) {
    const auto i = place_of(c.axis);
    if (!i) return;
    const AxisPlace& place = axes_[*i];
    const std::string& axis = place.spec().name;
    const double per_unit = place.spec().increments_per_unit;
    const auto simple = [&](std::string_view name) { add("command", {{"axis", axis}, {"command", name}}, *i, c, at, After::nothing); };
    if (const auto* m = std::get_if<Move>(&c.body)) return move(*m, *i, c, at);
    if (const auto* p = std::get_if<ProcessData>(&c.body)) return set_points(*p, *i, c, at);
    if (const auto* a = std::get_if<Action>(&c.body)) return action(*a, *i, c, at);
    if (std::holds_alternative<Enable>(c.body)) return add("enable", {{"axis", axis}}, *i, c, at, After::nothing);
    if (std::holds_alternative<Disable>(c.body)) return add("disable", {{"axis", axis}}, *i, c, at, After::nothing);
    if (std::holds_alternative<QuickStop>(c.body) || std::holds_alternative<Halt>(c.body) || std::holds_alternative<ResetFault>(c.body))
        return simple(name_of(c.body));
    if (const auto* h = std::get_if<Home>(&c.body)) {
        json::object body{{"axis", axis}};
        if (h->method != 0) body["method"] = h->method;
        return add("home", std::move(body), *i, c, at, After::motion);
    }
    if (const auto* s = std::get_if<SetPosition>(&c.body))
        return add("command", {{"axis", axis}, {"command", "set_position"}, {"position", number_or_count(in_units(s->position, per_unit))}},
                   *i, c, at, After::nothing);
    if (const auto* w = std::get_if<WriteParameter>(&c.body)) {
        if (place.catalogue && known(w->value))
            add("set_parameter", {{"axis", axis}, {"parameter", place.catalogue->id_of(w->point)}, {"value", to_json(w->value)}}, *i, c, at,
                After::nothing);
        return;
    }
    if (const auto* h = std::get_if<Hand>(&c.body))
        return add("simulate", {{"axis", axis}, {"input", h->name}, {"value", to_json(h->value)}}, *i, c, at, After::pause);
    if (std::holds_alternative<Native>(c.body))
        return leave_out(fmt::format("{}: a message in the drive's own language has no step", axis));
    if (std::holds_alternative<StartTogether>(c.body))
        return leave_out(fmt::format("{}: a common start of several axes has no step", axis));
}

void RecipeRecord::move(const Move& m, std::size_t axis, const Command& c, Instant at) {
    const AxisPlace& place = axes_[axis];
    const double per_unit = place.spec().increments_per_unit;
    const bool velocity = m.kind == Move::Kind::velocity;
    if (m.hold_ms) {
        const auto until = at + std::chrono::milliseconds(*m.hold_ms);
        for (auto d = drafts_.rbegin(); d != drafts_.rend(); ++d) {
            if (d->axis != axis) continue;
            if (d->held_until && at <= *d->held_until && (m.renew_only || d->held_target == m.target)) {
                d->held_until = until;
                return;
            }
            break;
        }
        if (m.renew_only) return;
    }
    json::object body{{"axis", place.spec().name}, {"command", name_of(c.body)}};
    const auto put = [&](std::string_view key, std::optional<std::int64_t> counts) {
        if (counts) body[key] = number_or_count(in_units(*counts, per_unit));
    };
    put(velocity ? "velocity" : "position", m.target);
    if (!velocity) put("velocity", m.velocity);
    put("acceleration", m.acceleration);
    put("deceleration", m.deceleration);
    if (m.prepare_only) body["prepare"] = true;
    const auto before = drafts_.size();
    add("command", std::move(body), axis, c, at, m.prepare_only ? After::nothing : velocity ? After::pause : After::motion);
    if (m.hold_ms && drafts_.size() > before) {
        drafts_.back().held_until = at + std::chrono::milliseconds(*m.hold_ms);
        drafts_.back().held_target = m.target;
    }
}

/// Registers of the standard map; a panel's repetitions without a change become one step.
void RecipeRecord::set_points(const ProcessData& d, std::size_t axis, const Command& c, Instant at) {
    const AxisSpec& spec = axes_[axis].spec();
    if (spec.number < 1) return leave_out(fmt::format("{}: set-points of an axis without a number have no registers", spec.name));
    const auto write = [&](std::uint16_t offset, auto value) {
        if (!value) return;
        const auto [held, fresh] = registers_.try_emplace({axis, offset}, static_cast<std::int64_t>(*value));
        if (!fresh && held->second == static_cast<std::int64_t>(*value)) return;
        held->second = static_cast<std::int64_t>(*value);
        add("write_register",
            {{"unit", 1},
             {"address", (spec.number - 1) * int{registers::registers_per_axis} + int{offset}},
             {"value", static_cast<std::int64_t>(*value)}},
            axis, c, at, After::pause);
    };
    write(reg::mode, d.mode);
    write(reg::target_position, d.target_position);
    write(reg::profile_velocity, d.profile_velocity);
    write(reg::profile_acceleration, d.profile_acceleration);
    write(reg::profile_deceleration, d.profile_deceleration);
    write(reg::target_velocity, d.target_velocity);
    write(reg::homing_method, d.homing_method);
    write(reg::controlword, d.controlword);
}

void RecipeRecord::action(const Action& a, std::size_t axis, const Command& c, Instant at) {
    const AxisPlace& place = axes_[axis];
    json::object body{{"axis", place.spec().name}, {"name", a.name}};
    std::string argument = a.argument;
    const auto* known_command = place.catalogue ? place.catalogue->command(a.name) : nullptr;
    if (argument.empty() && known_command && a.values.size() == known_command->arguments.size()) {
        for (std::size_t i = 0; i < a.values.size(); ++i) {
            const CommandArgument& given = known_command->arguments[i];
            const auto counts = given.scale == 1 ? std::nullopt : as_number(a.values[i]);
            argument += fmt::format("{}{}={}", i == 0 ? "" : " ", given.name,
                                    counts ? fmt::format("{:.12g}", *counts * given.scale) : to_text(a.values[i]));
        }
    }
    if (!argument.empty()) body["argument"] = argument;
    add("action", std::move(body), axis, c, at, After::pause);
}

void RecipeRecord::hand(const FlightRecord& r) {
    const auto h = unpack<HandRecord>(r.payload);
    if (!h || !by_hand(h->origin)) return;
    for (std::size_t i = 0; i < axes_.size(); ++i) {  // the first of its axes represents the drive
        const auto& site = *axes_[i].site;
        const auto drive = index_of_name(site.site.drives, axes_[i].spec().drive);
        if (!drive || *drive >= site.drive_ids.size() || site.drive_ids[*drive] != DriveId{r.index}) continue;
        Command c;
        c.origin = h->origin;
        for (const auto& [name, value] : h->items)
            add("simulate", {{"axis", axes_[i].spec().name}, {"input", name}, {"value", to_json(value)}}, i, c, r.at, After::pause);
        return;
    }
}

json::object RecipeRecord::document() const {
    json::array steps;
    bool full = full_;
    const auto put = [&](json::object step) {
        if (steps.size() < most_recipe_steps) return steps.push_back(std::move(step));
        full = true;
    };
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
        const Draft& d = drafts_[i];
        const bool last = i + 1 == drafts_.size();
        const Instant next = last ? to_ : drafts_[i + 1].at;
        Duration pause = d.after == After::nothing ? Duration{} : next - d.at;
        json::object body = d.body;
        if (d.after == After::motion) {
            const bool ended = d.stood ? *d.stood <= next : !d.seen_moving && pause > unseen_motion;
            if (ended || last) {  // the last motion is always awaited, because a recipe ends when its axes stand
                const double took = length_s((d.stood ? *d.stood : next) - d.at);
                if (d.word != "home") body["wait_s"] = static_cast<std::int64_t>(std::clamp(std::ceil(3 * took), 10.0, 3600.0));
                pause = {};
            } else if (d.word == "home") {
                body["wait_s"] = 0;
            }
        }
        const bool ran_out = d.held_until && *d.held_until < next;
        if (ran_out) pause = *d.held_until - d.at;
        const auto comment = body.if_contains("comment") ? body.at("comment") : json::value();
        body.erase("comment");
        json::object step{{d.word, std::move(body)}};
        if (!comment.is_null()) step["comment"] = comment;
        put(std::move(step));
        if (pause >= shortest_pause && (!last || d.held_until)) put(wait_step(pause));
        if (ran_out || (last && d.held_until)) put({{"command", {{"axis", axes_[d.axis].spec().name}, {"command", "halt"}}}});
    }
    json::array left_out;
    for (const auto& text : left_out_)
        left_out.emplace_back(text);
    if (full && left_out.size() < most_left_out)
        left_out.emplace_back(fmt::format("more than {} steps: what came later is left out", most_recipe_steps));
    return {{"steps", std::move(steps)}, {"left_out", std::move(left_out)}};
}

}  // namespace axisgate
