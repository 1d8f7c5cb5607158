// Reads the arguments of a catalogue command from JSON members or text: names, types, scales and ranges. All faults are reported together.
#include "gateway/core/command_arguments.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "gateway/core/json_read.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

bool whole(ValueType type) { return range_of(type).has_value() && type != ValueType::boolean; }

std::string range_text(const CommandArgument& a) {
    const auto own = range_of(a.type);
    const double low = a.min.value_or(own ? static_cast<double>(own->min) * a.scale : -INFINITY);
    const double high = a.max.value_or(own ? static_cast<double>(own->max) * a.scale : INFINITY);
    return fmt::format("{:.10g}..{:.10g}{}{}", low, high, a.unit.empty() ? "" : " ", a.unit);
}

/// Converts one value in its unit to counts; returns the fault, or an empty text.
std::string into_counts(const CommandArgument& a, const Value& given, Value& into) {
    if (a.type == ValueType::text || a.type == ValueType::bytes) {
        if (!std::holds_alternative<std::string>(given)) return fmt::format("{} takes a text", a.name);
        into = given;
        return {};
    }
    if (a.type == ValueType::boolean) {
        const auto b = as_integer(given);
        if (!b || (*b != 0 && *b != 1)) return fmt::format("{} takes true or false", a.name);
        into = *b == 1;
        return {};
    }
    const auto number = std::holds_alternative<bool>(given) ? std::nullopt : as_number(given);
    if (!number || !std::isfinite(*number)) return fmt::format("{} takes a number, not {}", a.name, to_text(given));
    const double counts = *number / a.scale;
    if (!whole(a.type)) {
        if ((a.min && *number < *a.min) || (a.max && *number > *a.max))
            return fmt::format("{}: {} is outside {}", a.name, *number, range_text(a));
        into = counts;
        return {};
    }
    const double nearest = std::nearbyint(counts);
    if (a.scale == 1 && nearest != counts) return fmt::format("{} takes a whole number, not {}", a.name, *number);
    const auto own = *range_of(a.type);
    // An i64's largest value is not a double: the next double above it is out of range.
    const bool fits =
        nearest >= static_cast<double>(own.min) && (own.max == INT64_MAX ? nearest < 0x1p63 : nearest <= static_cast<double>(own.max));
    if (!fits || (a.min && *number < *a.min) || (a.max && *number > *a.max))
        return fmt::format("{}: {} is outside {}", a.name, *number, range_text(a));
    into = static_cast<std::int64_t>(nearest);
    return {};
}

std::string names_of(const CatalogueCommand& command) {
    std::string list;
    for (const auto& a : command.arguments)
        list += (list.empty() ? "" : ", ") + a.name;
    return list;
}

CheckedArguments check(const CatalogueCommand& command, const std::vector<std::pair<std::string, Value>>& given) {
    CheckedArguments checked;
    for (const auto& [name, value] : given) {
        if (std::ranges::find(command.arguments, name, &CommandArgument::name) != command.arguments.end()) continue;
        checked.faults.push_back({name, fmt::format("{} has no argument {}", command.name, name),
                                  command.arguments.empty() ? "it takes none by name" : "its arguments are " + names_of(command)});
    }
    for (const auto& a : command.arguments) {
        const auto found = std::ranges::find(given, a.name, &std::pair<std::string, Value>::first);
        const Value& wanted = found != given.end() ? found->second : a.fallback;
        if (!known(wanted)) {
            const std::string_view why = found != given.end() ? "takes one value" : "is missing";
            checked.faults.push_back({a.name, fmt::format("{} {}", a.name, why), "give a value in " + range_text(a)});
            continue;
        }
        Value counts;
        if (auto fault = into_counts(a, wanted, counts); !fault.empty()) {
            checked.faults.push_back({a.name, std::move(fault), "give a value in " + range_text(a)});
        }
        checked.values.push_back(std::move(counts));
    }
    return checked;
}
}  // namespace

CheckedArguments check_arguments(const CatalogueCommand& command, const json::object& given) {
    std::vector<std::pair<std::string, Value>> list;
    for (const auto& [name, value] : given)
        list.emplace_back(std::string(name), value_of_json(value));
    return check(command, list);
}

CheckedArguments check_arguments(const CatalogueCommand& command, std::string_view given) {
    std::vector<std::pair<std::string, Value>> list;
    std::vector<ArgumentFault> faults;
    constexpr std::string_view between = " ,;\t\r\n";
    while (true) {
        const auto begin = given.find_first_not_of(between);
        if (begin == std::string_view::npos) break;
        given.remove_prefix(begin);
        const auto word = given.substr(0, given.find_first_of(between));
        given.remove_prefix(word.size());
        const auto equals = word.find('=');
        const std::string name(word.substr(0, equals));
        if (equals == std::string_view::npos || name.empty()) {
            faults.push_back({std::string(word), fmt::format("{} is no argument", word), "write name=value"});
            continue;
        }
        if (std::ranges::find(list, name, &std::pair<std::string, Value>::first) != list.end()) {
            faults.push_back({name, fmt::format("{} stands twice", name), "give it once"});
            continue;
        }
        const auto text = word.substr(equals + 1);
        double number = 0;
        const auto [end, ec] = std::from_chars(text.data(), text.data() + text.size(), number);
        Value value = std::string(text);
        const auto argument = std::ranges::find(command.arguments, name, &CommandArgument::name);
        const bool is_text =
            argument != command.arguments.end() && (argument->type == ValueType::text || argument->type == ValueType::bytes);
        if (!is_text && (text == "true" || text == "false"))
            value = text == "true";
        else if (!is_text && ec == std::errc{} && end == text.data() + text.size())
            value = number;
        list.emplace_back(name, std::move(value));
    }
    auto checked = check(command, list);
    checked.faults.insert(checked.faults.begin(), faults.begin(), faults.end());
    return checked;
}

}  // namespace axisgate
