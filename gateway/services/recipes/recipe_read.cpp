// Makes steps of the document and the arguments of a run, or reports all faults together with their places.
#include "gateway/services/recipes/recipe_read.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "gateway/axis/points.hpp"
#include "gateway/core/json_read.hpp"
#include "gateway/services/recipes/recipe_arguments.hpp"
#include "gateway/services/recipes/recipe_label.hpp"
#include "gateway/services/recipes/recipe_wish.hpp"
#include "gateway/services/recipes/recipe_words.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
using Kind = RecipeStep::Kind;
using Op = RecipeCondition::Op;

constexpr std::string_view condition_members = " axis point parameter is is_not at_least at_most above below tolerance ";
const AxisPointRow* condition_point(std::string_view name) {
    const auto* row = point_named(name);
    return row && row->recipe != PointInRecipe::no ? row : nullptr;
}
constexpr double default_wait_s = 10, default_home_s = 120, default_timeout_s = 30, default_run_s = 3600;

Duration seconds_of(double s) { return Duration{static_cast<std::int64_t>(std::llround(s * 1e9))}; }

/// The same text is shown below a field of a form, where nobody writes quotes, so it shows an example of the value.
std::string example(std::string_view key) {
    constexpr std::array<std::pair<std::string_view, std::string_view>, 6> examples{{{"axis", "feeder"},
                                                                                     {"parameter", "AC"},
                                                                                     {"command", "halt"},
                                                                                     {"name", "program.start"},
                                                                                     {"point", "position"},
                                                                                     {"on_failure", "halt"}}};
    for (const auto& [k, word] : examples) {
        if (k == key) return fmt::format(", such as \"{}\"", word);
    }
    return {};
}

class RecipeReader : public RecipeArguments {
public:
    using RecipeArguments::RecipeArguments;

    // --- members ---------------------------------------------------------------------------------------------------------
    std::string text(const json::object& o, std::string_view key, const std::string& at, bool required) {
        const auto* v = o.if_contains(key);
        if (!v || v->is_null()) {
            if (required) fault(at, fmt::format("{} is missing", key), fmt::format("add \"{}\"", key));
            return {};
        }
        if (!v->is_string() || (required && v->get_string().empty())) {
            fault(at + "/" + std::string(key), fmt::format("{} must be a text{}", key, example(key)), "fill it in");
            return {};
        }
        return std::string(v->get_string());
    }
    double number(const json::object& o, std::string_view key, const std::string& at, double otherwise, double low, double high) {
        const auto* v = o.if_contains(key);
        if (!v || v->is_null()) return otherwise;
        const double d = v->is_number() ? v->to_number<double>() : std::nan("");
        if (!(d >= low && d <= high)) {
            fault(at + "/" + std::string(key), fmt::format("{} must be a number from {} to {}", key, low, high), "correct it");
            return otherwise;
        }
        return d;
    }
    void whole(const json::object& o, std::string_view key, const std::string& at, double high) {
        const double d = number(o, key, at, 0, 0, high);
        if (d != std::nearbyint(d))
            fault(at + "/" + std::string(key), fmt::format("{} must be a whole number from 0 to {}", key, high), "correct it");
    }
    void require(const json::object& o, std::string_view key, const std::string& at) {
        const auto* v = o.if_contains(key);
        if (!v || v->is_null()) fault(at, fmt::format("{} is missing", key), fmt::format("add \"{}\"", key));
    }

    std::optional<RecipeCondition> condition(const json::object& o, const std::string& at) {
        const auto before = faults_.size();
        RecipeCondition c;
        c.axis = text(o, "axis", at, true);
        const bool has_point = o.contains("point"), has_parameter = o.contains("parameter");
        if (has_point == has_parameter) {
            fault(at, has_point ? "point and parameter are both there" : "point is missing",
                  "add \"point\" (a member of the axis' document), or \"parameter\" (read from the drive)");
            return std::nullopt;
        }
        c.point = text(o, has_point ? "point" : "parameter", at, true);
        if (has_point) c.row = condition_point(c.point);
        if (has_point && !c.point.empty() && !c.row) {
            std::string list;
            for (const auto p : recipe_points())
                list += (list.empty() ? "" : ", ") + std::string(p);
            fault(at + "/point", fmt::format("an axis has no point {}", c.point), "use one of: " + list);
        }
        int found = 0;
        for (const auto& [op, word] : recipe_comparisons) {
            const auto* v = o.if_contains(word);
            if (!v) continue;
            ++found;
            c.op = op;
            c.value = value_of_json(*v);
            const bool order = op != Op::is && op != Op::is_not;
            if ((order && !v->is_number()) || v->is_object() || v->is_array() || v->is_null())
                fault(fmt::format("{}/{}", at, word),
                      fmt::format("{} needs {}", word, order ? "a number" : "a number, a text, true or false"), "correct the value");
        }
        if (found != 1)
            fault(at, found == 0 ? "it does not say what the value is compared with" : "it says more than one comparison",
                  "write exactly one of: is, is_not, at_least, at_most, above, below");
        c.tolerance = number(o, "tolerance", at, 0, 0, 1e15);
        return faults_.size() == before ? std::optional(std::move(c)) : std::nullopt;
    }

    // --- steps -----------------------------------------------------------------------------------------------------------
    std::vector<RecipeStep> steps(const json::value* list, const std::string& at, std::size_t depth) {
        std::vector<RecipeStep> out;
        if (!list || !list->is_array()) {
            fault(at, "this must be a list of steps", "write [ ... ]");
            return out;
        }
        if (depth > most_recipe_nesting) {
            fault(at, fmt::format("steps are nested more than {} deep", most_recipe_nesting), "write them flatter");
            return out;
        }
        const auto& a = list->get_array();
        for (std::size_t i = 0; i < a.size(); ++i) {
            if (rows_ >= most_recipe_steps) {
                fault(at, fmt::format("the recipe has more than {} steps", most_recipe_steps), "use repeat, or divide it");
                return out;
            }
            out.push_back(step(a[i], fmt::format("{}/{}", at, i), depth));
        }
        return out;
    }

    RecipeStep step(const json::value& v, const std::string& at, std::size_t depth) {
        RecipeStep s;
        s.pointer = at;
        s.row = rows_++;
        if (!v.is_object()) {
            fault(at, "a step is an object with one word", "write {\"enable\": {\"axis\": \"feeder\"}}");
            return s;
        }
        const RecipeWord* word = nullptr;
        const json::value* member = nullptr;
        for (const auto& [k, x] : v.get_object()) {
            if (k == "comment") {
                s.comment = text(v.get_object(), "comment", at, false);
                if (s.comment.size() > most_recipe_text_bytes) fault(at + "/comment", "the comment is too long", "shorten it");
                continue;
            }
            const auto it = std::ranges::find(recipe_words, std::string_view(k), &RecipeWord::word);
            if (it == recipe_words.end() || word) {
                std::string list;
                for (const auto& w : recipe_words)
                    list += (list.empty() ? "" : ", ") + std::string(w.word);
                fault(at + "/" + pointer_token(k),
                      it == recipe_words.end() ? fmt::format("there is no step {}", std::string_view(k)) : "a step has one word only",
                      it == recipe_words.end() ? "use one of: " + list : "make a step of each");
                if (it == recipe_words.end()) return s;
                continue;
            }
            word = &*it;
            member = &x;
        }
        if (!word) {
            if (faults_.empty() || faults_.back().pointer != at)
                fault(at, "the step says nothing", "write {\"enable\": {\"axis\": \"feeder\"}}");
            return s;
        }
        s.kind = word->kind;
        body(s, *member, at + "/" + std::string(word->word), word->members, depth);
        return s;
    }

    /// Reads the members under the step's word.
    void body(RecipeStep& s, const json::value& member, const std::string& in, std::string_view members, std::size_t depth) {
        if (s.kind == Kind::wait || s.kind == Kind::message) {
            const json::object wrapped{{"value", put_in(member, in)}};
            const auto& x = wrapped.at("value");
            if (s.kind == Kind::message) {
                if (!member.is_string()) fault(in, "message must be a text, such as \"tool changed\"", "fill it in");
                s.text = plain_text(x);
            } else {
                const double d = x.is_number() ? x.to_number<double>() : -1;
                if (!(d >= 0 && d <= most_recipe_seconds)) {
                    fault(in, fmt::format("wait_s must be a number of seconds from 0 to {}", most_recipe_seconds), "correct it");
                } else {
                    s.limit = seconds_of(d);
                }
            }
        } else if (!member.is_object()) {
            fault(in, fmt::format("{} must be an object", name_of(s.kind)), fmt::format("it has the members{}", members));
        } else if (s.kind == Kind::branch || s.kind == Kind::repeat) {
            compound(s, member.get_object(), in, members, depth);
        } else {
            const json::value put = put_in(member, in);
            const auto& o = put.get_object();
            unknown(o, members, in);
            simple(s, o, in);
            s.wish = read_step_wish(s.kind, o);
            s.what = step_text(s, o);
            return;
        }
        s.what = step_text(s, {});
    }

    void simple(RecipeStep& s, const json::object& o, const std::string& in) {
        if (s.kind == Kind::write_register) {
            for (const auto* key : {"unit", "address", "value"})
                require(o, key, in);
            whole(o, "unit", in, 255);
            whole(o, "address", in, 65535);
            s.limit = seconds_of(default_timeout_s);
            return;
        }
        s.axis = text(o, "axis", in, true);
        const auto wait = [&](double otherwise) {
            const double d = number(o, "wait_s", in, otherwise, 0, most_recipe_seconds);
            s.until_done = d > 0;
            s.limit = seconds_of(d > 0 ? d : default_timeout_s);
        };
        switch (s.kind) {
            case Kind::set_parameter:
                require(o, "value", in);
                [[fallthrough]];
            case Kind::read_parameter:
                (void)text(o, "parameter", in, true);
                s.until_done = true;
                s.limit = seconds_of(default_timeout_s);
                break;
            case Kind::enable:
            case Kind::disable:
                wait(default_wait_s);
                break;
            case Kind::home:
                wait(default_home_s);
                break;
            case Kind::command:
                (void)text(o, "command", in, true);
                wait(0);
                break;
            case Kind::action:
                (void)text(o, "name", in, true);
                (void)text(o, "argument", in, false);
                wait(0);
                break;
            case Kind::simulate:
                (void)text(o, "input", in, true);
                require(o, "value", in);
                s.limit = seconds_of(default_timeout_s);
                break;
            case Kind::wait_for:
                s.condition = condition(o, in);
                s.limit = seconds_of(number(o, "timeout_s", in, default_timeout_s, 0, most_recipe_seconds));
                break;
            case Kind::check:
                s.condition = condition(o, in);
                s.text = text(o, "text", in, false);
                s.limit = seconds_of(default_timeout_s);
                break;
            default:
                break;
        }
    }

    void compound(RecipeStep& s, const json::object& o, const std::string& in, std::string_view members, std::size_t depth) {
        unknown(o, members, in);
        s.limit = seconds_of(default_timeout_s);
        const auto* condition_word = s.kind == Kind::branch ? "condition" : "until";
        const auto* c = o.if_contains(condition_word);
        if (c && c->is_object()) {
            const auto at = in + "/" + condition_word;
            const auto bound = put_in(*c, at);
            unknown(bound.get_object(), condition_members, at);
            s.condition = condition(bound.get_object(), at);
            if (s.condition) s.axis = s.condition->axis;
        } else if (c || s.kind == Kind::branch) {
            fault(c ? in + "/" + condition_word : in, fmt::format("{} must be an object", condition_word),
                  "write {\"axis\": \"feeder\", \"point\": \"referenced\", \"is\": true}");
        }
        if (s.kind == Kind::branch) {
            s.steps = steps(o.if_contains("then"), in + "/then", depth + 1);
            if (o.contains("else")) s.otherwise = steps(o.if_contains("else"), in + "/else", depth + 1);
            return;
        }
        const auto* t = o.if_contains("times");
        const json::value times = t ? put_in(*t, in + "/times") : json::value(nullptr);
        const double n = times.is_number() ? times.to_number<double>() : 0;
        if (!(n >= 1 && n <= static_cast<double>(most_recipe_repeats)) || n != std::nearbyint(n)) {
            fault(t ? in + "/times" : in, fmt::format("times must be a whole number from 1 to {}", most_recipe_repeats),
                  "a repeat always has an end: give its bound");
        } else {
            s.times = static_cast<std::int64_t>(n);
        }
        s.steps = steps(o.if_contains("steps"), in + "/steps", depth + 1);
    }

    [[nodiscard]] std::size_t rows() const noexcept { return rows_; }

private:
    std::size_t rows_ = 0;
};
}  // namespace

std::optional<Recipe> read_recipe(const json::object& document, const json::object* arguments, std::vector<SiteFault>& faults) {
    const auto before = faults.size();
    RecipeReader r(faults);
    Recipe out;
    r.unknown(document, " name description parameters steps timeout_s on_failure changed_at changed_by ", "");
    out.description = r.text(document, "description", "", false);
    if (out.description.size() > most_recipe_text_bytes)
        r.fault("/description", fmt::format("the description has more than {} bytes", most_recipe_text_bytes), "shorten it");
    out.limit = seconds_of(r.number(document, "timeout_s", "", default_run_s, 0.001, most_recipe_seconds));
    const std::string on_failure = r.text(document, "on_failure", "", false);
    if (!on_failure.empty() && on_failure != "halt" && on_failure != "quick_stop")
        r.fault("/on_failure", "on_failure must be halt or quick_stop", "say how the axes are stopped that the run has set in motion");
    out.quick_stop = on_failure == "quick_stop";
    r.read_arguments(document, arguments);
    out.steps = r.steps(document.if_contains("steps"), "/steps", 1);
    if (faults.size() == before && out.steps.empty()) r.fault("/steps", "the recipe has no steps", "add one");
    out.count = r.rows();
    if (faults.size() != before) return std::nullopt;
    return out;
}

}  // namespace axisgate
