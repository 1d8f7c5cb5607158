// A running run is one document per recipe of a separate kind, so that a start finds it without reading all reports. Documents have at most
// 1,000,000 bytes; a larger report loses the ends of its texts, then all texts. The mark of a run is removed only after its report was
// ordered, so that a crash in between leaves both.
#include "gateway/services/recipes/recipe_reports.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/parse.hpp>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
const std::string under_way = "recipe_run_under_way";
constexpr std::size_t most_bytes = 1'000'000;  // the store accepts 1 MiB

std::string kind_of(std::string_view recipe) { return fmt::format("recipe_run {}", recipe); }
/// With leading zeros, so that the order of names is that of the numbers.
std::string name_of(std::uint64_t n) { return fmt::format("{:010}", n); }
std::uint64_t number_in(std::string_view name) { return static_cast<std::uint64_t>(parse_whole(name, 1, 9'999'999'999).value_or(0)); }

std::optional<json::object> parsed(const std::string& text) {
    boost::system::error_code ec;
    auto v = json::parse(text, ec);
    if (ec || !v.is_object()) return std::nullopt;
    return std::move(v.get_object());
}
std::uint64_t number_of(const json::object& report) {
    const auto* n = report.if_contains("n");
    return n && n->is_number() ? static_cast<std::uint64_t>(n->to_number<double>()) : 0;
}

/// Texts of steps may be long and many: a report that is too large loses their ends, then all of them.
std::string text_of(json::object report) {
    std::string text = json_text(report);
    for (const std::size_t most : {256u, 0u}) {
        auto* steps = report.if_contains("steps");
        if (text.size() <= most_bytes || !steps || !steps->is_array()) break;
        for (auto& s : steps->get_array()) {
            if (!s.is_object()) continue;
            for (auto& [key, value] : s.get_object()) {
                if ((key == "text" || key == "value" || key == "comment") && value.is_string() && value.get_string().size() > most)
                    value = std::string(std::string_view(value.get_string()).substr(0, most)) + "...";
            }
        }
        text = json_text(report);
    }
    return text;
}
}  // namespace

void RecipeReports::begin() {
    for (const auto& d : documents_.documents(under_way)) {
        auto report = parsed(d.text);
        const auto n = report ? number_of(*report) : 0;
        if (n == 0 || documents_.document(kind_of(d.name), name_of(n))) {  // the run had ended, and its report was stored
            documents_.delete_document(under_way, d.name, [](const std::string&) {});
            continue;
        }
        const std::string known = format_time(d.at_unix_ns);
        std::string text = fmt::format("the gateway was restarted while the run was under way; the last that is known is of {}", known);
        std::string axes;
        if (const auto* list = report->if_contains("axes"); list && list->is_array()) {
            for (const auto& a : list->get_array()) {
                if (a.is_string()) axes += fmt::format("{}{}", axes.empty() ? "" : ", ", std::string_view(a.get_string()));
            }
        }
        if (!axes.empty()) text += fmt::format("; nothing was stopped by the run: see to {}", axes);
        (*report)["state"] = "interrupted";
        (*report)["ended_at"] = known;
        (*report)["text"] = text;
        if (auto* steps = report->if_contains("steps"); steps && steps->is_array()) {
            for (auto& s : steps->get_array()) {
                auto* o = s.if_object();
                const auto* state = o ? o->if_contains("state") : nullptr;
                if (!state || *state != "running") continue;
                (*o)["state"] = "interrupted";
                (*o)["ended_at"] = known;
            }
        }
        const auto* at = report->if_contains("at_step");
        Event e;
        e.severity = Severity::warning;
        e.kind = "recipe";
        e.who = d.who;
        e.text = fmt::format("recipe {} run {} interrupted{}: {}", d.name, n,
                             at && at->is_string() ? fmt::format(" at {}", std::string_view(at->get_string())) : std::string(), text);
        events_.note(std::move(e));
        last_[d.name] = n;
        end(d.name, n, d.who, std::move(*report));
    }
}

std::uint64_t RecipeReports::next(const std::string& name) {
    std::vector<std::uint64_t> numbers;
    for (const auto& d : documents_.documents(kind_of(name)))
        numbers.push_back(number_in(d.name));
    auto& last = last_[name];
    for (const auto n : numbers)
        last = std::max(last, n);
    ++last;
    for (const auto n : numbers) {
        if (n != 0 && too_old(name, n)) remove(name, n);
    }
    return last;
}

bool RecipeReports::too_old(const std::string& name, std::uint64_t n) const {
    const auto it = last_.find(name);
    return it != last_.end() && n + kept <= it->second;
}

void RecipeReports::keep(const std::string& name, const std::string& who, const json::object& report) {
    // A report that cannot be stored now may be stored with the next one; an error is reported at the end of the run.
    documents_.save_document(under_way, {name, text_of(report), who, clock_.now_unix_ns()}, [](const std::string&) {});
}

void RecipeReports::end(const std::string& name, std::uint64_t n, const std::string& who, json::object report) {
    Document d{name_of(n), text_of(report), who, clock_.now_unix_ns()};
    unsaved_[{name, n}] = std::move(report);
    documents_.save_document(kind_of(name), std::move(d), [self = weak_from_this(), name, n](const std::string& fault) {
        if (const auto me = self.lock()) me->saved(name, n, fault);
    });
    // It follows in the same order on the disk: a crash between the two leaves both, and the next start knows which one counts.
    documents_.delete_document(under_way, name, [](const std::string&) {});
}

void RecipeReports::saved(const std::string& name, std::uint64_t n, const std::string& fault) {
    unsaved_.erase({name, n});  // a report that cannot be stored is not kept in memory either; the event has reported the end of the run
    if (fault.empty()) return;
    Event e;
    e.severity = Severity::warning;
    e.kind = "recipe";
    e.text = fmt::format("the report of run {} of recipe {} is not stored: {}", n, name, fault);
    events_.note(std::move(e));
}

std::optional<json::object> RecipeReports::find(const std::string& name, std::uint64_t n) const {
    if (too_old(name, n)) return std::nullopt;
    if (const auto it = unsaved_.find({name, n}); it != unsaved_.end()) return it->second;
    const auto d = documents_.document(kind_of(name), name_of(n));
    return d ? parsed(d->text) : std::nullopt;
}

std::map<std::uint64_t, json::object> RecipeReports::all(const std::string& name) const {
    std::map<std::uint64_t, json::object> out;
    for (const auto& d : documents_.documents(kind_of(name))) {
        const auto n = number_in(d.name);
        auto report = n != 0 && !too_old(name, n) ? parsed(d.text) : std::nullopt;
        if (report) out[n] = std::move(*report);
    }
    for (const auto& [key, report] : unsaved_) {
        if (key.first == name && !too_old(name, key.second)) out[key.second] = report;
    }
    return out;
}

void RecipeReports::remove(const std::string& name, std::uint64_t n) {
    documents_.delete_document(kind_of(name), name_of(n), [](const std::string&) {});
}

void RecipeReports::forget(const std::string& name) {
    std::erase_if(unsaved_, [&](const auto& u) {
        if (u.first.first != name) return false;
        remove(name, u.first.second);  // it is on its way to the disk, and the following deletion removes it again
        return true;
    });
    for (const auto& d : documents_.documents(kind_of(name)))
        remove(name, number_in(d.name));
    documents_.delete_document(under_way, name, [](const std::string&) {});
    last_.erase(name);
}

}  // namespace axisgate
