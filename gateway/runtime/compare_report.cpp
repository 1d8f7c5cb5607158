// The text lists the first differences only; JSON has all of them.
#include "gateway/runtime/compare_report.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/array.hpp>

namespace axisgate {
namespace json = boost::json;
namespace {

constexpr std::size_t most_listed = 50;

double ms(Duration d) { return seconds(d) * 1000; }
double s(Instant at) { return seconds(at - time_zero); }

std::string plural(std::size_t n, std::string_view noun) { return fmt::format("{} {}{}", n, noun, n == 1 ? "" : "s"); }

std::string joined(const std::vector<std::string>& list) {
    std::string out;
    for (const auto& x : list)
        out += (out.empty() ? "" : ", ") + x;
    return out;
}

std::string score_text(const SpecimenScore& score) {
    std::string text = plural(score.differences(), "difference");
    std::string parts;
    const auto add = [&parts](std::size_t n, std::string_view what) {
        if (n != 0) parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", n, what);
    };
    add(score.values, "in values");
    add(score.missing, "missing");
    add(score.extra, "extra");
    add(score.times, "in reply times");
    return parts.empty() ? text : text + ": " + parts;
}

void put_difference(std::string& out, const Difference& d, std::size_t tried) {
    out += fmt::format("{:<8} {:.6f} s", name_of(d.kind), s(d.at));
    if (d.kind == Difference::Kind::late || d.kind == Difference::Kind::early)
        out += fmt::format("  after {:.1f} ms, range {:.1f} to {:.1f} ms", ms(d.reply), ms(d.least), ms(d.most));
    out += '\n';
    if (!d.request.empty()) out += fmt::format("  request: {}\n", d.request);
    if (!d.recorded.empty()) out += fmt::format("  drive:   {}\n", d.recorded);
    if (!d.twin.empty()) out += fmt::format("  twin:    {}\n", d.twin);
    if (tried > 1)
        out += d.explained_by.empty() ? "  no specimen explains it\n" : fmt::format("  specimens without it: {}\n", joined(d.explained_by));
}

json::object score_json(const SpecimenScore& score) {
    return {{"specimen", score.specimen}, {"differences", score.differences()},
            {"values", score.values},     {"missing", score.missing},
            {"extra", score.extra},       {"times", score.times},
            {"freedoms", score.freedoms}};
}
}  // namespace

std::string comparison_text(const ComparisonInput& input, const Comparison& c) {
    std::string out = fmt::format("{} at {}: {} to the drive, {} from it, in {:.3f} s\n", input.family->name, joined(input.addresses),
                                  plural(c.requests, "message"), c.answers, seconds(c.span));
    if (c.longest_reply != Duration::zero())
        out += fmt::format("replies after {:.1f} to {:.1f} ms, half of them within {:.1f} ms\n", ms(c.shortest_reply), ms(c.longest_reply),
                           ms(c.median_reply));
    const auto manual = std::ranges::find(c.scores, "0", &SpecimenScore::specimen);
    if (manual != c.scores.end()) out += fmt::format("specimen 0, the drive of the manual: {}\n", score_text(*manual));
    const SpecimenScore& best = c.scores.front();
    if (c.scores.size() > 1)
        out += fmt::format("the best of {} specimens is {}: {}\n", c.scores.size(), best.specimen, score_text(best));
    else if (best.specimen != "0")
        out += fmt::format("specimen {}: {}\n", best.specimen, score_text(best));
    for (const auto& line : c.best_in_words)
        out += fmt::format("  {}\n", line);
    out += '\n';
    for (std::size_t i = 0; i < std::min(c.differences.size(), most_listed); ++i)
        put_difference(out, c.differences[i], c.scores.size());
    if (c.differences.size() > most_listed) out += fmt::format("... and {} more, which --json lists\n", c.differences.size() - most_listed);
    if (!c.changes.empty()) out += "the drive changed while it was recorded:\n";
    for (const auto& x : c.changes)
        out += fmt::format("  from {:.6f} s on, with no write that changes the twin\n    request: {}\n    before:  {}\n    after:   {}\n",
                           s(x.at), x.request, x.before, x.after);
    if (!c.measured.empty()) out += "measured values that differ, which are not counted:\n";
    for (const auto& m : c.measured)
        out +=
            fmt::format("  {}, largest difference {} at {:.6f} s\n{}    drive: {}\n    twin:  {}\n", plural(m.answers, "answer"), m.largest,
                        s(m.at), m.request.empty() ? std::string() : fmt::format("    request: {}\n", m.request), m.recorded, m.twin);
    out += fmt::format("{} of {} equal", c.equal, plural(c.answers, "message"));
    if (!c.differences.empty() && c.scores.size() > 1)
        out += fmt::format("; {} explained by no specimen", plural(c.unexplained(), "difference"));
    return out + "\n";
}

json::object comparison_json(const ComparisonInput& input, const Comparison& c) {
    json::array scores, words, differences, measured, changes, addresses;
    for (const auto& a : input.addresses)
        addresses.emplace_back(a);
    for (const auto& x : c.scores)
        scores.push_back(score_json(x));
    for (const auto& x : c.best_in_words)
        words.emplace_back(x);
    for (const auto& d : c.differences) {
        json::object o{{"kind", name_of(d.kind)}, {"at_s", s(d.at)}, {"request", d.request}, {"drive", d.recorded}, {"twin", d.twin}};
        if (d.kind == Difference::Kind::late || d.kind == Difference::Kind::early) {
            o["reply_ms"] = ms(d.reply);
            o["least_ms"] = ms(d.least);
            o["most_ms"] = ms(d.most);
        }
        o["specimens_without"] = json::array(d.explained_by.begin(), d.explained_by.end());
        differences.push_back(std::move(o));
    }
    for (const auto& m : c.measured)
        measured.push_back(json::object{{"request", m.request},
                                        {"answers", m.answers},
                                        {"largest", m.largest},
                                        {"at_s", s(m.at)},
                                        {"drive", m.recorded},
                                        {"twin", m.twin}});
    for (const auto& x : c.changes)
        changes.push_back(json::object{{"at_s", s(x.at)}, {"request", x.request}, {"before", x.before}, {"after", x.after}});
    return {
        {"version", AXISGATE_VERSION},
        {"family", input.family->name},
        {"addresses", std::move(addresses)},
        {"requests", c.requests},
        {"answers", c.answers},
        {"equal", c.equal},
        {"span_s", seconds(c.span)},
        {"reply_ms", json::object{{"shortest", ms(c.shortest_reply)}, {"median", ms(c.median_reply)}, {"longest", ms(c.longest_reply)}}},
        {"best", c.scores.empty() ? std::string() : c.scores.front().specimen},
        {"best_in_words", std::move(words)},
        {"scores", std::move(scores)},
        {"differences", std::move(differences)},
        {"unexplained", c.unexplained()},
        {"measured", std::move(measured)},
        {"changes", std::move(changes)}};
}

}  // namespace axisgate
