// Rehearsals: one cell after the other is asked for, and when the last one is there the report is dated and kept.
// In: cells from the port. Out: a document per rehearsal, named by its time; one event at its end. Never keeps more than so many.
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

std::string in_words(const RehearsalCell& c) {
    if (!c.fault.empty()) return "no figures: " + c.fault;
    if (c.cause == LossCause::none) {
        if (!c.reaction_ms) return fmt::format("the drive goes on by itself: watched for {:.1f} s", c.watched_ms / 1000);
        return c.standstill_ms
                   ? fmt::format("the drive stops by itself after {:.1f} ms, at rest after {:.1f} ms", *c.reaction_ms, *c.standstill_ms)
                   : fmt::format("the drive slows down by itself after {:.1f} ms, and it still moved {:.1f} s later", *c.reaction_ms,
                                 c.watched_ms / 1000);
    }
    if (!c.noticed_ms && !c.standstill_ms) return fmt::format("it goes on: watched for {:.1f} s", c.watched_ms / 1000);
    if (!c.noticed_ms) return fmt::format("nothing is done: the motion to its target ended after {:.1f} ms", *c.standstill_ms);
    if (!c.standstill_ms)
        return fmt::format("{} after {:.1f} ms, and it still moved {:.1f} s later", name_of(c.taken), *c.noticed_ms, c.watched_ms / 1000);
    return fmt::format("{} after {:.1f} ms, at rest after {:.1f} ms", name_of(c.taken), *c.noticed_ms, *c.standstill_ms);
}
}  // namespace

json::object to_json(const RehearsalCell& c) {
    return {{"axis", c.axis},
            {"cause", c.cause == LossCause::none ? "gateway_gone" : name_of(c.cause)},
            {"chosen", c.chosen ? json::value(name_of(*c.chosen)) : json::value(nullptr)},
            {"taken", name_of(c.taken)},
            {"motion", c.motion},
            {"speed", rounded(c.speed)},
            {"noticed_ms", ms_or_null(c.noticed_ms)},
            {"reaction_ms", ms_or_null(c.reaction_ms)},
            {"standstill_ms", ms_or_null(c.standstill_ms)},
            {"watched_ms", ms_or_null(c.watched_ms)},
            {"travel", rounded(c.travel)},
            {"text", in_words(c)}};
}

/// Whether the drive of this axis follows streamed set-points of position or velocity: else they cannot be missed.
bool Rehearsals::streams(const SiteState& state, const std::string& axis) const {
    const Site& site = state.site;
    const auto& a = *std::ranges::find(site.axes, axis, &AxisSpec::name);
    const auto page = catalogue_of(site, *std::ranges::find(site.drives, a.drive, &DriveSpec::name), sites_.families());
    return page && (page->offers_mode(8) || page->offers_mode(9));
}

std::string Rehearsals::start(std::vector<std::string> axes, const Origin& origin) {
    if (run_) return "a rehearsal is under way already: wait for its report";
    Run run;
    run.site = sites_.site();
    const auto& known = run.site->site.axes;
    if (axes.empty()) {
        for (const auto& a : known)
            axes.push_back(a.name);
    }
    if (axes.empty()) return "the site has no axis yet";
    for (const auto& name : axes) {
        if (std::ranges::find(known, name, &AxisSpec::name) == known.end()) return fmt::format("there is no axis {}", name);
        for (const LossCause cause : loss_causes) {
            if (of_streams_alone(cause) && !streams(*run.site, name)) {
                run.left_out.push_back(name);
            } else {
                run.left.emplace_back(name, cause);
            }
        }
        run.left.emplace_back(name, LossCause::none);  // what the drive does when the gateway is gone without a word
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
    auto [axis, cause] = std::move(run_->left.front());
    run_->left.pop_front();
    player_.rehearse(run_->site, std::move(axis), cause, [weak = weak_from_this()](RehearsalCell cell) {
        const auto self = weak.lock();
        if (!self || !self->run_) return;
        self->run_->cells.push_back(std::move(cell));
        self->next();
    });
}

void Rehearsals::end() {
    const Run run = std::move(*run_);
    run_.reset();
    json::array cells, left_out;
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
