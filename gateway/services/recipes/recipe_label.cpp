// Makes the label of a step, such as "Step 4.3 (pass 2 of 5): set_parameter AC of feeder = 20000", as one line of bounded length. A recipe
// contains no secrets.
#include "gateway/services/recipes/recipe_label.hpp"

#include <fmt/core.h>

#include <boost/json/serialize.hpp>

namespace axisgate {
namespace {
namespace json = boost::json;
using Kind = RecipeStep::Kind;

std::string member(const json::object& body, std::string_view key) {
    const auto* v = body.if_contains(key);
    return v ? plain_text(*v) : std::string();
}

/// Steps counted from 1: "/steps/3/repeat/steps/2" is 4.3; the sides of an `if` are named, since both begin at 1.
std::string number_of(std::string_view pointer) {
    std::string out;
    while (!pointer.empty()) {
        pointer.remove_prefix(1);
        const auto end = pointer.find('/');
        const auto token = pointer.substr(0, end);
        pointer = end == std::string_view::npos ? std::string_view() : pointer.substr(end);
        if (token == "then" || token == "else") {
            out += fmt::format("{}{}", out.empty() ? "" : ".", token);
        } else if (!token.empty() && token[0] >= '0' && token[0] <= '9') {
            std::size_t n = 0;
            for (const char c : token)
                n = n * 10 + static_cast<std::size_t>(c - '0');
            out += fmt::format("{}{}", out.empty() ? "" : ".", n + 1);
        }
    }
    return out;
}

/// Members of the body that are not in the line yet.
std::string others(const json::object& body, std::string_view named) {
    std::string out;
    for (const auto& [k, v] : body) {
        if (named.find(fmt::format(" {} ", std::string_view(k))) == std::string_view::npos)
            out += fmt::format(", {} = {}", std::string_view(k), plain_text(v));
    }
    return out;
}

std::string what_of(const RecipeStep& s, const json::object& body) {
    const std::string word(name_of(s.kind));
    switch (s.kind) {
        case Kind::set_parameter:
            return fmt::format("{} {} of {} = {}", word, member(body, "parameter"), s.axis, member(body, "value"));
        case Kind::read_parameter:
            return fmt::format("{} {} of {}", word, member(body, "parameter"), s.axis);
        case Kind::command:
            return fmt::format("{} {} of {}{}", word, member(body, "command"), s.axis, others(body, " axis command wait_s "));
        case Kind::action:
            return fmt::format("{} {} of {}{}", word, member(body, "name"), s.axis, others(body, " axis name wait_s "));
        case Kind::write_register:
            return fmt::format("{} {} of unit {} = {}", word, member(body, "address"), member(body, "unit"), member(body, "value"));
        case Kind::simulate:
            return fmt::format("{} {} of {} = {}", word, member(body, "input"), s.axis, member(body, "value"));
        case Kind::enable:
        case Kind::disable:
        case Kind::home:
            return fmt::format("{} {}{}", word, s.axis, others(body, " axis wait_s "));
        case Kind::wait_for:
        case Kind::check:
        case Kind::branch:
            return word + (s.condition ? " " + to_text(*s.condition) : "");
        case Kind::wait:
            return fmt::format("{} {}", word, std::chrono::duration<double>(s.limit).count());
        case Kind::repeat:
            return fmt::format("{} {} times{}", word, s.times, s.condition ? ", until " + to_text(*s.condition) : "");
        case Kind::message:
            return fmt::format("{} {}", word, s.text);
    }
    return word;
}
}  // namespace

std::string plain_text(const json::value& v) {
    if (v.is_string()) return std::string(v.get_string());
    if (v.is_double()) return fmt::format("{}", v.get_double());
    return json::serialize(v);
}

std::string step_text(const RecipeStep& step, const json::object& body) {
    std::string what = what_of(step, body);
    if (what.size() > most_recipe_label_bytes) what.resize(most_recipe_label_bytes);  // the label is longer and is cut before this length
    return what;
}

std::string label_of(const RecipeStep& step, std::string_view pass) {
    std::string out = fmt::format("Step {}{}: {}", number_of(step.pointer), pass.empty() ? "" : fmt::format(" (pass {})", pass), step.what);
    if (out.size() <= most_recipe_label_bytes) return out;
    std::size_t n = most_recipe_label_bytes - 3;  // cuts before a character of several bytes, never inside it
    while (n > 0 && (static_cast<unsigned char>(out[n]) & 0xC0u) == 0x80u)
        --n;
    return out.substr(0, n) + "...";
}

}  // namespace axisgate
