// Requests one cell after the other; after the last one the report is dated and stored. There is one event at the end, and a limited number
// of reports.
#include "gateway/services/fail_safe/rehearsals.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <cmath>

#include "gateway/core/text.hpp"
#include "gateway/site/ways_in.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
const std::string kind = "rehearsal";

json::value ms_or_null(const std::optional<double>& ms) { return ms ? json::value(std::round(*ms * 1000) / 1000) : json::value(nullptr); }
double rounded(double v) { return std::round(v * 1e6) / 1e6; }

std::string what_was_done(const RehearsalCell& c) {
    const double stood = c.standstill_ms.value_or(0);
    if (c.cause == LossCause::none && !c.noticed_ms) {
        if (!c.reaction_ms) return fmt::format("the drive goes on by itself: watched for {:.1f} s", c.watched_ms / 1000);
        return c.standstill_ms ? fmt::format("the drive stops by itself after {:.1f} ms, at rest after {:.1f} ms", *c.reaction_ms, stood)
                               : fmt::format("the drive slows down by itself after {:.1f} ms, and it still moved {:.1f} s later",
                                             *c.reaction_ms, c.watched_ms / 1000);
    }
    if (!c.noticed_ms && !c.standstill_ms) return fmt::format("it goes on: watched for {:.1f} s", c.watched_ms / 1000);
    if (!c.noticed_ms && c.ended_by == "target")
        return fmt::format("nothing is done: the motion to its target ended after {:.1f} ms", stood);
    if (!c.noticed_ms) return fmt::format("at rest after {:.1f} ms", stood);
    if (!c.standstill_ms)
        return fmt::format("{} after {:.1f} ms, and it still moved {:.1f} s later", name_of(c.taken), *c.noticed_ms, c.watched_ms / 1000);
    return fmt::format("{} after {:.1f} ms, at rest after {:.1f} ms", name_of(c.taken), *c.noticed_ms, stood);
}

std::string in_words(const RehearsalCell& c) {
    if (!c.fault.empty()) return "no figures: " + c.fault;
    std::string text = what_was_done(c);
    if (!c.ended_by.empty() && c.ended_by != situation_of(c)) text += "; ended by " + c.ended_by;
    if (c.moved_again) text += *c.moved_again ? "; it moved again when its client came back" : "; it stayed when its client came back";
    return text;
}
}  // namespace

json::object to_json(const RehearsalCell& c) {
    return {{"axis", c.axis},
            {"cause", situation_of(c)},
            {"chosen", c.chosen ? json::value(name_of(*c.chosen)) : json::value(nullptr)},
            {"taken", name_of(c.taken)},
            {"motion", c.motion},
            {"speed", rounded(c.speed)},
            {"noticed_ms", ms_or_null(c.noticed_ms)},
            {"reaction_ms", ms_or_null(c.reaction_ms)},
            {"standstill_ms", ms_or_null(c.standstill_ms)},
            {"watched_ms", ms_or_null(c.watched_ms)},
            {"travel", rounded(c.travel)},
            {"ended_by", c.ended_by.empty() ? json::value(nullptr) : json::value(c.ended_by)},
            {"moved_again", c.moved_again ? json::value(*c.moved_again) : json::value(nullptr)},
            {"text", in_words(c)}};
}

/// True if the drive of this axis follows streamed set-points of position or velocity; otherwise they cannot be lost.
bool Rehearsals::streams(const SiteState& state, const std::string& axis) const {
    const Site& site = state.site;
    const auto& a = *std::ranges::find(site.axes, axis, &AxisSpec::name);
    const auto page = catalogue_of(site, *std::ranges::find(site.drives, a.drive, &DriveSpec::name), sites_.families());
    return page && (page->offers_mode(8) || page->offers_mode(9));
}

std::string Rehearsals::start(std::vector<std::string> axes, RehearsalSteps steps, const Origin& origin) {
    if (run_) return "a rehearsal is under way already: wait for its report";
    Run run;
    run.steps = steps;
    run.site = sites_.site();
    const auto& known = run.site->site.axes;
    if (axes.empty()) {
        for (const auto& a : known)
            axes.push_back(a.name);
    }
    if (axes.empty()) return "the site has no axis yet";
    for (const auto& name : axes) {
        if (std::ranges::find(known, name, &AxisSpec::name) == known.end()) return fmt::format("there is no axis {}", name);
        RehearsalWish wish;
        wish.axis = name;
        wish.steps = steps;
        for (const LossCause cause : loss_causes()) {
            wish.cause = cause;
            if (of_streams_alone(cause) && !streams(*run.site, name)) {
                run.left_out.push_back(name);
            } else {
                run.left.push_back(wish);
            }
        }
        wish.cause = LossCause::none;  // the drive's own reaction when the gateway is gone without notice
        run.left.push_back(wish);
        wish.restart = true;
        if (steps.has(RehearsalStep::gateway_restart)) run.left.push_back(wish);
    }
    run.total = run.left.size();
    run.who = origin.who ? *origin.who : "";
    run.began_unix_ns = clock_.now_unix_ns();
    run_ = std::move(run);
    next();
    return "";
}

void Rehearsals::next() {
    if (run_->left.empty()) return end();
    RehearsalWish wish = std::move(run_->left.front());
    run_->left.pop_front();
    player_.rehearse(run_->site, std::move(wish), [weak = weak_from_this()](RehearsalCell cell) {
        const auto self = weak.lock();
        if (!self || !self->run_) return;
        self->run_->cells.push_back(std::move(cell));
        self->next();
    });
}

void Rehearsals::end() {
    const Run run = std::move(*run_);
    run_.reset();
    json::array cells, left_out, steps;
    for (const RehearsalStep step : rehearsal_steps)
        if (run.steps.has(step)) steps.emplace_back(name_of(step));
    for (const auto& axis : run.left_out)
        left_out.emplace_back(axis);
    std::size_t without = 0;
    for (const auto& c : run.cells) {
        cells.push_back(to_json(c));
        without += c.fault.empty() ? 0 : 1;
    }
    const std::int64_t now = clock_.now_unix_ns();
    json::object report{
        {"at", format_time(run.began_unix_ns)},
        {"ended_at", format_time(now)},
        {"who", run.who},
        {"site_revision", run.site->revision},
        {"on", "models of the drives, in their own time; limits of position were left out so that they do not end the motion first"},
        {"steps", std::move(steps)},
        {"without_figures", without},
        {"without_set_points", std::move(left_out)},
        {"cells", std::move(cells)}};
    last_ = report;
    Document d;
    d.name = fmt::format("{:020}", run.began_unix_ns);
    d.text = json::serialize(report);
    d.who = run.who;
    d.at_unix_ns = now;
    const auto before = documents_.documents(kind);
    for (std::size_t i = 0; i + kept <= before.size(); ++i)
        documents_.delete_document(kind, before[i].name, [](const std::string&) {});
    documents_.save_document(kind, std::move(d), [](const std::string&) {});
    Event e;
    e.kind = "rehearsal";
    e.who = run.who;
    e.severity = without == 0 ? Severity::info : Severity::warning;
    e.text = fmt::format("loss of command was rehearsed on models: {} cells, {} without figures", run.total, without);
    events_.note(std::move(e));
}

json::object Rehearsals::state() const {
    if (!last_) {
        const auto all = documents_.documents(kind);
        boost::system::error_code ec;
        auto v = all.empty() ? json::value() : json::parse(all.back().text, ec);
        if (!ec && v.is_object()) last_ = std::move(v.get_object());
    }
    return {{"state", run_    ? "running"
                      : last_ ? "done"
                              : "none"},
            {"done", run_ ? run_->cells.size() : 0},
            {"total", run_ ? run_->total : 0},
            {"report", last_ ? json::value(*last_) : json::value(nullptr)}};
}

}  // namespace axisgate
