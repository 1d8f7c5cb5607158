// Reading a recipe: the document and the arguments of a run become steps, or faults with their places.
// In: JSON. Out: steps, or faults, all at once. Never asks a drive.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/json/serialize.hpp>
#include <cmath>

#include "gateway/axis/points.hpp"
#include "gateway/services/recipes/recipe.hpp"
#include "gateway/services/recipes/recipe_words.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
using Kind = RecipeStep::Kind;
using Op = RecipeCondition::Op;

constexpr std::string_view condition_members = " axis point parameter is is_not at_least at_most above below tolerance ";
bool is_condition_point(std::string_view name) {
    const auto* row = point_named(name);
    return row && row->recipe != PointInRecipe::no;
}
constexpr double default_wait_s = 10, default_home_s = 120, default_timeout_s = 30, default_run_s = 3600;

bool listed(std::string_view list, std::string_view key) { return list.find(fmt::format(" {} ", key)) != std::string_view::npos; }
Duration seconds_of(double s) { return Duration{static_cast<std::int64_t>(std::llround(s * 1e9))}; }

/// A pointer's token (RFC 6901).
std::string token(std::string_view key) {
    std::string s;
    for (const char c : key)
        s += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return s;
}

/// The same words stand under a field of a form, where nobody writes quotes: they say what such a text looks like.
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

bool good_name(std::string_view s) {
    return !s.empty() && s.size() <= 64 && std::ranges::all_of(s, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    });
}

class RecipeReader {
public:
    RecipeReader(std::vector<SiteFault>& faults, bool with_arguments) : faults_(faults), with_arguments_(with_arguments) {}

    void fault(std::string pointer, std::string text, std::string remedy) {
        if (faults_.size() < 100) faults_.push_back({std::move(pointer), std::move(text), std::move(remedy), false});
    }

    // --- parameters and arguments --------------------------------------------------------------------------------------
    bool fits(const json::value& v, std::string_view type, const json::object& p, std::string& why) {
        const auto bound = [&](std::string_view key, bool upper) {
            const auto* b = p.if_contains(key);
            if (!b || !b->is_number() || !v.is_number()) return true;
            const double x = v.to_number<double>(), y = b->to_number<double>();
            if (upper ? x <= y : x >= y) return true;
            why = fmt::format("must be {} {}", upper ? "at most" : "at least", y);
            return false;
        };
        if (type == "boolean") {
            why = "must be true or false";
            return v.is_bool();
        }
        if (type == "text" || type == "axis") {
            why = fmt::format("must be a text of at most {} bytes", most_recipe_text_bytes);
            return v.is_string() && v.get_string().size() <= most_recipe_text_bytes;
        }
        why = type == "integer" ? "must be a whole number" : "must be a number";
        if (!v.is_number() || !std::isfinite(v.to_number<double>())) return false;
        if (type == "integer" && v.is_double() && v.get_double() != std::nearbyint(v.get_double())) return false;
        return bound("min", false) && bound("max", true);
    }

    void parameters(const json::object& document, const json::object* arguments) {
        const auto* list = document.if_contains("parameters");
        if (list && !list->is_object()) {
            fault("/parameters", "parameters must be an object",
                  "write \"parameters\": {\"distance\": {\"type\": \"number\", \"default\": 10}}");
            return;
        }
        if (list && list->get_object().size() > most_recipe_parameters)
            fault("/parameters", fmt::format("{} parameters are more than {}", list->get_object().size(), most_recipe_parameters),
                  "leave some out");
        for (const auto& [k, v] : list ? list->get_object() : json::object()) {
            const std::string name(k);
            const std::string at = "/parameters/" + token(name);
            if (!good_name(name)) fault(at, "a parameter's name has 1 to 64 letters, digits, - _ .", "choose another name");
            if (!v.is_object()) {
                fault(at, "a parameter is an object", "write {\"type\": \"number\", \"default\": 10}");
                continue;
            }
            const auto& p = v.get_object();
            unknown(p, " type default min max unit description ", at);
            const auto* t = p.if_contains("type");
            const std::string type = t && t->is_string() ? std::string(t->get_string()) : "";
            if (!listed(" number integer boolean text axis ", type) || type.empty()) {
                fault(at + "/type", "type must be number, integer, boolean, text or axis", "write \"type\": \"number\"");
                continue;
            }
            std::string why;
            const auto* d = p.if_contains("default");
            if (d && !fits(*d, type, p, why)) {
                fault(at + "/default", "the default " + why, "correct the default, or the type");
                continue;
            }
            const auto* given = arguments ? arguments->if_contains(name) : nullptr;
            if (given) {
                if (!fits(*given, type, p, why))
                    fault("/arguments/" + token(name), fmt::format("{} {}", name, why), "correct the argument");
                values_[name] = *given;
            } else if (d) {
                values_[name] = *d;
            } else if (with_arguments_) {
                fault("/arguments/" + token(name), fmt::format("{} is missing, and it has no default", name),
                      fmt::format("give it: a {}", type));
                values_[name] = sample(type, p);
            } else {
                values_[name] = sample(type, p);
            }
        }
        if (!arguments) return;
        for (const auto& [k, v] : *arguments) {
            if (!list || !list->get_object().contains(k))
                fault("/arguments/" + token(k), fmt::format("the recipe has no parameter {}", std::string_view(k)), "remove it");
        }
    }

    static json::value sample(std::string_view type, const json::object& p) {
        if (type == "boolean") return false;
        if (type == "text") return "text";
        if (type == "axis") return "axis";
        for (const auto* key : {"min", "max"}) {
            if (const auto* b = p.if_contains(key); b && b->is_number()) return *b;
        }
        return 1;
    }

    /// The value with every "${name}" in it replaced; a text that is nothing else takes the argument's own type.
    json::value put_in(const json::value& v, const std::string& at, std::size_t depth = 0) {
        if (depth > 16) {
            fault(at, "this is nested too deeply", "write it flatter");
            return nullptr;
        }
        if (v.is_object()) {
            json::object o;
            for (const auto& [k, x] : v.get_object())
                o[k] = put_in(x, at + "/" + token(k), depth + 1);
            return o;
        }
        if (v.is_array()) {
            json::array a;
            for (std::size_t i = 0; i < v.get_array().size(); ++i)
                a.push_back(put_in(v.get_array()[i], fmt::format("{}/{}", at, i), depth + 1));
            return a;
        }
        if (!v.is_string()) return v;
        const std::string_view s = v.get_string();
        if (s.size() > most_recipe_text_bytes)
            fault(at, fmt::format("{} bytes are more than {}", s.size(), most_recipe_text_bytes), "shorten the text");
        std::string out;
        for (std::size_t i = 0; i < s.size();) {
            const auto open = s.find("${", i);
            const auto close = open == std::string_view::npos ? open : s.find('}', open);
            if (close == std::string_view::npos) {
                out += s.substr(i);
                break;
            }
            const std::string name(s.substr(open + 2, close - open - 2));
            const auto* value = values_.if_contains(name);
            if (!value) {
                fault(at, fmt::format("there is no parameter {} to stand for ${{{}}}", name, name),
                      "add it to \"parameters\", or correct the name");
                return v;
            }
            if (open == 0 && close + 1 == s.size()) return *value;
            out += s.substr(i, open - i);
            out += plain_text(*value);
            i = close + 1;
        }
        if (out.size() > most_recipe_text_bytes) {
            fault(at, fmt::format("with its arguments the text has more than {} bytes", most_recipe_text_bytes), "shorten it");
            out.clear();
        }
        return json::value(out);
    }

    // --- members ---------------------------------------------------------------------------------------------------------
    void unknown(const json::object& o, std::string_view known, const std::string& at) {
        for (const auto& [k, v] : o) {
            if (known.find(' ') == std::string_view::npos || !listed(known, k))
                fault(at + "/" + token(k), fmt::format("{} is not known here", std::string_view(k)),
                      known.empty() ? "remove it" : fmt::format("remove it, or use one of:{}", known.substr(0, known.size() - 1)));
        }
    }
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
        c.parameter = has_parameter;
        c.point = text(o, has_point ? "point" : "parameter", at, true);
        if (has_point && !c.point.empty() && !is_condition_point(c.point)) {
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
            c.value = *v;
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
                fault(at + "/" + token(k),
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
        const std::string in = at + "/" + std::string(word->word);
        if (s.kind == Kind::wait || s.kind == Kind::message) {
            const json::object wrapped{{"value", put_in(*member, in)}};
            const auto& x = wrapped.at("value");
            if (s.kind == Kind::message) {
                if (!member->is_string()) fault(in, "message must be a text, such as \"tool changed\"", "fill it in");
                s.text = plain_text(x);
            } else {
                const double d = x.is_number() ? x.to_number<double>() : -1;
                if (!(d >= 0 && d <= most_recipe_seconds)) {
                    fault(in, fmt::format("wait_s must be a number of seconds from 0 to {}", most_recipe_seconds), "correct it");
                } else {
                    s.limit = seconds_of(d);
                }
            }
            return s;
        }
        if (!member->is_object()) {
            fault(in, fmt::format("{} must be an object", word->word), fmt::format("it has the members{}", word->members));
            return s;
        }
        if (s.kind == Kind::branch || s.kind == Kind::repeat) return compound(s, member->get_object(), in, word->members, depth);
        s.body = put_in(*member, in).get_object();
        unknown(s.body, word->members, in);
        simple(s, in);
        return s;
    }

    void simple(RecipeStep& s, const std::string& in) {
        const auto& o = s.body;
        if (s.kind == Kind::write_register) {
            for (const auto* key : {"unit", "address", "value"})
                require(o, key, in);
            (void)number(o, "unit", in, 1, 0, 255);
            (void)number(o, "address", in, 0, 0, 65535);
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

    RecipeStep compound(RecipeStep& s, const json::object& o, const std::string& in, std::string_view members, std::size_t depth) {
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
            return std::move(s);
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
        return std::move(s);
    }

    [[nodiscard]] std::size_t rows() const noexcept { return rows_; }
    [[nodiscard]] const json::object& values() const noexcept { return values_; }

private:
    std::vector<SiteFault>& faults_;
    bool with_arguments_;
    json::object values_;
    std::size_t rows_ = 0;
};
}  // namespace

std::optional<Recipe> read_recipe(const json::object& document, const json::object* arguments, std::vector<SiteFault>& faults) {
    const auto before = faults.size();
    RecipeReader r(faults, arguments != nullptr);
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
    r.parameters(document, arguments);
    out.steps = r.steps(document.if_contains("steps"), "/steps", 1);
    if (faults.size() == before && out.steps.empty()) r.fault("/steps", "the recipe has no steps", "add one");
    out.count = r.rows();
    if (faults.size() != before) return std::nullopt;
    return out;
}

json::object whole_arguments(const json::object& document, const json::object& arguments) {
    json::object out;
    const auto* list = document.if_contains("parameters");
    if (!list || !list->is_object()) return out;
    for (const auto& [k, v] : list->get_object()) {
        if (const auto* given = arguments.if_contains(k)) {
            out[k] = *given;
        } else if (const auto* d = v.is_object() ? v.get_object().if_contains("default") : nullptr) {
            out[k] = *d;
        }
    }
    return out;
}

}  // namespace axisgate
