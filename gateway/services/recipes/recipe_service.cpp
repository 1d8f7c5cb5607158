// Calls a run when its deadline has come or an answer is available, and submits its requests as commands. No pointer into the site is kept,
// because the site may change during a run.
#include "gateway/services/recipes/recipe_service.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/serialize.hpp>

#include "gateway/core/text.hpp"
#include "gateway/services/axis_place.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/recipes/recipe_point.hpp"
#include "gateway/services/recipes/recipe_steps.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
json::object without_steps(json::object report) {
    report.erase("steps");
    return report;
}
}  // namespace

struct RecipeService::World final : RecipeWorld {
    World(const RecipeService& s, const Active& a) : service(s), active(a) {}
    const RecipeService& service;
    const Active& active;
    [[nodiscard]] Claim claim(std::string_view axis) const override {
        const auto place = find_axis(service.sites_, axis);
        if (!place) return {};
        return active.claims.claim(std::string(axis), service.axes_.picture(place->id()), active.origin, service.wall_);
    }
    [[nodiscard]] Value point(std::string_view axis, const AxisPointRow& row) const override {
        const auto site = service.sites_.site();
        const auto index = index_of_name(site->site.axes, axis);
        if (!index) return {};
        const AxisPicture picture = *index < site->axis_ids.size() ? service.axes_.picture(site->axis_ids[*index]) : AxisPicture{};
        const std::int64_t age_ns = service.wall_.now_unix_ns() - service.wall_.to_unix_ns(picture.at);
        return recipe_point(row, picture, site->site.axes[*index], std::max<std::int64_t>(0, age_ns / 1'000'000));
    }
};

Refusable<json::object> RecipeService::start(const std::string& name, Recipe recipe, json::object arguments, const Origin& origin) {
    using Why = ServiceRefusal::Why;
    if (const auto n = running(name); n != 0)
        return ServiceRefusal{Why::running, fmt::format("recipe {} is running already (run {}): wait for its end, or cancel it", name, n)};
    if (active_.size() >= most_runs || !reports_->room())
        return ServiceRefusal{Why::overloaded, fmt::format("{} recipes are running already: wait for one to end", active_.size())};
    auto axes = commanded_axes(recipe);
    for (const auto& other : active_) {
        for (const auto& axis : axes) {
            if (std::ranges::find(other->axes, axis) != other->axes.end())
                return ServiceRefusal{Why::running, fmt::format("axis {} is in use by recipe {} (run {})", axis, other->name, other->n),
                                      axis};
        }
    }
    auto a = std::make_shared<Active>();
    a->name = name;
    a->n = reports_->next(name);
    a->axes = std::move(axes);
    a->arguments = std::move(arguments);
    a->who = origin.who ? *origin.who : "";
    a->origin = {origin.door, std::make_shared<const std::string>(fmt::format("recipe {} by {}", name, a->who)), origin.client};
    a->run = std::make_unique<RecipeRun>(std::move(recipe), clock_());
    active_.push_back(a);
    std::string with;
    for (const auto& [k, v] : a->arguments)
        with += fmt::format("{} {} = {}", with.empty() ? " with" : ",", std::string_view(k), json_text(v));
    note(*a, Severity::info, fmt::format("recipe {} run {} started{}", name, a->n, with));
    keep(*a, clock_());
    due_now_ = true;
    if (rearm) rearm();
    return document(*a);
}

Refusable<json::object> RecipeService::cancel(const std::string& name, std::uint64_t n, const Origin& origin) {
    for (const auto& a : active_) {
        if (a->name != name || a->n != n) continue;
        (void)a->run->cancel(fmt::format("cancelled by {}", origin.who ? *origin.who : "nobody known"));
        due_now_ = true;
        if (rearm) rearm();
        return document(*a);
    }
    if (!report(name, n)) return ServiceRefusal{ServiceRefusal::Why::not_found, fmt::format("recipe {} has no run {}", name, n)};
    return ServiceRefusal{ServiceRefusal::Why::wrong_state, fmt::format("run {} of recipe {} has ended already", n, name)};
}

std::uint64_t RecipeService::running(const std::string& name) const {
    const auto it = std::ranges::find_if(active_, [&](const auto& a) { return a->name == name; });
    return it == active_.end() ? 0 : (*it)->n;
}

std::vector<json::object> RecipeService::in_progress() const {
    std::vector<json::object> out;
    for (const auto& a : active_)
        out.push_back(document(*a));
    return out;
}

std::optional<json::object> RecipeService::report(const std::string& name, std::uint64_t n) const {
    for (const auto& a : active_) {
        if (a->name == name && a->n == n) return document(*a);
    }
    return reports_->find(name, n);
}

std::vector<json::object> RecipeService::reports(const std::string& name) const {
    auto sorted = reports_->all(name);
    for (const auto& a : active_) {
        if (a->name == name) sorted[a->n] = document(*a);
    }
    std::vector<json::object> out;
    for (auto it = sorted.rbegin(); it != sorted.rend() && out.size() < kept_reports; ++it)
        out.push_back(without_steps(std::move(it->second)));
    return out;
}

void RecipeService::forget(const std::string& name) { reports_->forget(name); }

Instant RecipeService::deadline() const {
    if (due_now_) return time_zero;
    Instant next = never;
    for (const auto& a : active_) {
        next = std::min(next, a->run->deadline());
        if (a->run->revision() != a->published_revision) next = std::min(next, a->published + publish_period);
        if (a->run->revision() != a->kept_revision) next = std::min(next, a->kept + keep_period);
    }
    return next;
}

void RecipeService::on_deadline(Instant now) {
    due_now_ = false;
    const auto list = active_;
    for (const auto& a : list) {
        if (a->run->deadline() <= now) pump(a, now);
        const bool over = a->run->ended();
        if (a->run->revision() != a->published_revision && (over || a->published_revision == 0 || now - a->published >= publish_period)) {
            a->published = now;
            a->published_revision = a->run->revision();
            if (publish) publish(a->name, document(*a));
        }
        if (over) {
            ended(a);
        } else if (a->run->revision() != a->kept_revision && now - a->kept >= keep_period) {
            keep(*a, now);
        }
    }
}

void RecipeService::keep(Active& a, Instant now) {
    a.kept = now;
    a.kept_revision = a.run->revision();
    reports_->keep(a.name, a.who, document(a));
}

void RecipeService::pump(const std::shared_ptr<Active>& a, Instant now) {
    std::vector<RecipeRequest> requests;
    a->run->turn(now, World(*this, *a), requests);
    for (const auto& r : requests)
        carry_out(a, r);
}

void RecipeService::carry_out(const std::shared_ptr<Active>& a, const RecipeRequest& r) {
    Command command;
    if (r.what == RecipeRequest::What::stop) {
        const auto place = find_axis(sites_, r.axis);
        if (!place) return answer(a, r.number, {false, fmt::format("there is no axis {} any more", r.axis)});
        command.axis = place->id();
        if (a->run->recipe().quick_stop) {
            command.body = QuickStop{};
        } else {
            command.body = Halt{};
        }
        return submit(a, r.number, nullptr, std::move(command));
    }
    if (r.step->kind == RecipeStep::Kind::message) {
        note(*a, Severity::info, r.step->text);
        return answer(a, r.number, {true, {}});
    }
    std::vector<SiteFault> faults;
    std::optional<Command> made;
    if (r.what == RecipeRequest::What::read_parameter) {
        made = read_of(*r.step, sites_, faults);
    } else if (auto step = command_of(*r.step, sites_, faults)) {
        made = std::move(step->command);
    }
    if (!made)  // the site has changed since the run began
        return answer(a, r.number, {false, faults.empty() ? std::string("the step cannot be carried out") : faults.front().text});
    const bool mover = r.what == RecipeRequest::What::step && is_motion(*r.step) && !r.step->axis.empty();
    submit(a, r.number, mover ? r.step : nullptr, std::move(*made));
}

/// `mover` is the step whose command may set its axis in motion; it lives as long as the run.
void RecipeService::submit(const std::shared_ptr<Active>& a, std::uint32_t number, const RecipeStep* mover, Command command) {
    command.origin = a->origin;
    const AxisId id = command.axis;
    const CommandBody body = command.body;
    if (mover) a->claims.ask(mover->axis, axes_.picture(id));
    const Ticket ticket =
        axes_.submit(std::move(command), [self = weak_from_this(), active = std::weak_ptr(a), number, mover, id, body](const Result& r) {
            const auto me = self.lock();
            const auto run = active.lock();
            if (!me || !run) return;
            RecipeAnswer answer{good(r), r.text, r.value};
            if (mover) answer.motion = run->claims.answered(*mover, body, r, me->axes_.picture(id));
            if (!answer.good)
                answer.text = fmt::format("{} ({}{})", r.text.empty() ? std::string("it was refused") : r.text, name_of(r.reason),
                                          r.code == 0 ? std::string() : fmt::format(", the drive's code {}", r.code));
            me->answer(active, number, std::move(answer));
        });
    if (mover) a->claims.sent(mover->axis, ticket);
}

void RecipeService::answer(const std::weak_ptr<Active>& active, std::uint32_t number, RecipeAnswer answer) {
    const auto a = active.lock();
    if (!a) return;
    a->run->answer(number, std::move(answer));
    due_now_ = true;
    if (rearm) rearm();
}

void RecipeService::ended(const std::shared_ptr<Active>& a) {
    std::erase(active_, a);
    const bool failed = a->run->state() == RecipeRun::State::failed;
    std::string text = fmt::format("recipe {} run {} {}", a->name, a->n, name_of(a->run->state()));
    if (!a->run->text().empty()) text += fmt::format(" at {}: {}", a->run->where() ? a->run->where()->pointer : "", a->run->text());
    note(*a, failed ? Severity::warning : Severity::info, text);
    reports_->end(a->name, a->n, a->who, document(*a));
}

void RecipeService::note(const Active& a, Severity severity, std::string text, std::string axis) {
    Event e;
    e.severity = severity;
    e.kind = "recipe";
    e.axis = std::move(axis);
    e.text = std::move(text);
    e.who = a.who;
    e.door = std::string(name_of(a.origin.door));
    events_.note(std::move(e));
}

json::object RecipeService::document(const Active& a) const {
    const RecipeRun& run = *a.run;
    const auto time = [&](Instant i) { return i == Instant{} ? json::value(nullptr) : json::value(format_time(wall_.to_unix_ns(i))); };
    json::array steps, stops;
    std::size_t done = 0;
    for (const auto& row : run.rows()) {
        if (row.state != RecipeRow::State::not_run) ++done;
        json::object o{{"pointer", row.step->pointer},
                       {"label", label_of(*row.step, row.pass)},
                       {"step", name_of(row.step->kind)},
                       {"axis", text_or_null(row.step->axis)},
                       {"state", name_of(row.state)},
                       {"times", row.times},
                       {"started_at", time(row.started)},
                       {"ended_at", time(row.ended)},
                       {"text", row.text},
                       {"value", to_json(row.value)}};
        if (!row.step->comment.empty()) o["comment"] = row.step->comment;
        steps.push_back(std::move(o));
    }
    for (const auto& s : run.stops())
        stops.push_back({{"axis", s.axis}, {"stopped", s.good}, {"left_alone", s.left_alone}, {"text", s.text}});
    const RecipeStep* at = run.ended() ? run.where() : run.current();
    json::array axes;
    for (const auto& x : a.axes)
        axes.emplace_back(x);
    return {{"recipe", a.name},
            {"n", a.n},
            {"state", name_of(run.state())},
            {"started_at", time(run.started())},
            {"ended_at", time(run.ended_at())},
            {"started_by", a.who},
            {"arguments", a.arguments},
            {"axes", std::move(axes)},
            {"at_step", text_or_null(at ? at->pointer : "")},
            {"at_label", text_or_null(at ? label_of(*at, run.rows()[at->row].pass) : "")},
            {"begun", done},
            {"of", run.rows().size()},
            {"text", run.text()},
            {"stops", std::move(stops)},
            {"steps", std::move(steps)}};
}

}  // namespace axisgate
