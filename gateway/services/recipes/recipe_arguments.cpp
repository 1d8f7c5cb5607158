// Checks each parameter by its type, then replaces its name in texts by the argument.
#include "gateway/services/recipes/recipe_arguments.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "gateway/services/recipes/recipe_label.hpp"
#include "gateway/services/recipes/recipe_read.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
bool listed(std::string_view list, std::string_view key) { return list.find(fmt::format(" {} ", key)) != std::string_view::npos; }

bool good_name(std::string_view s) {
    return !s.empty() && s.size() <= 64 && std::ranges::all_of(s, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' || c == '.';
    });
}

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

json::value sample(std::string_view type, const json::object& p) {
    if (type == "boolean") return false;
    if (type == "text") return "text";
    if (type == "axis") return "axis";
    for (const auto* key : {"min", "max"}) {
        if (const auto* b = p.if_contains(key); b && b->is_number()) return *b;
    }
    return 1;
}
}  // namespace

std::string pointer_token(std::string_view key) {
    std::string s;
    for (const char c : key)
        s += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
    return s;
}

void RecipeFaults::fault(std::string pointer, std::string text, std::string remedy) {
    if (faults_.size() < 100) faults_.push_back({std::move(pointer), std::move(text), std::move(remedy), false});
}

void RecipeFaults::unknown(const json::object& o, std::string_view known, const std::string& at) {
    for (const auto& [k, v] : o) {
        if (known.find(' ') == std::string_view::npos || !listed(known, k))
            fault(at + "/" + pointer_token(k), fmt::format("{} is not known here", std::string_view(k)),
                  known.empty() ? "remove it" : fmt::format("remove it, or use one of:{}", known.substr(0, known.size() - 1)));
    }
}

void RecipeArguments::read_arguments(const json::object& document, const json::object* arguments) {
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
        const std::string at = "/parameters/" + pointer_token(name);
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
                fault("/arguments/" + pointer_token(name), fmt::format("{} {}", name, why), "correct the argument");
            values_[name] = *given;
        } else if (d) {
            values_[name] = *d;
        } else if (arguments) {
            fault("/arguments/" + pointer_token(name), fmt::format("{} is missing, and it has no default", name),
                  fmt::format("give it: a {}", type));
            values_[name] = sample(type, p);
        } else {
            values_[name] = sample(type, p);
        }
    }
    if (!arguments) return;
    for (const auto& [k, v] : *arguments) {
        if (!list || !list->get_object().contains(k))
            fault("/arguments/" + pointer_token(k), fmt::format("the recipe has no parameter {}", std::string_view(k)), "remove it");
    }
}

json::value RecipeArguments::put_in(const json::value& v, const std::string& at, std::size_t depth) {
    if (depth > 16) {
        fault(at, "this is nested too deeply", "write it flatter");
        return nullptr;
    }
    if (v.is_object()) {
        json::object o;
        for (const auto& [k, x] : v.get_object())
            o[k] = put_in(x, at + "/" + pointer_token(k), depth + 1);
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
