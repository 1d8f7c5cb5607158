#include "gateway/drive/option_reader.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

namespace axisgate::drive {

std::string_view OptionReader::text(const std::string& name) const {
    const auto it = options_.find(name);
    return it == options_.end() ? std::string_view() : std::string_view(it->second);
}

std::string_view OptionReader::word(const std::string& name, std::initializer_list<std::string_view> words) {
    const auto reported = text(name);
    if (reported.empty()) return *words.begin();
    if (const auto* w = std::ranges::find(words, reported); w != words.end()) return *w;
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i)
        list += fmt::format("{}{}", i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words.begin()[i]);
    fault(fmt::format("option {} = {}: write {}; {} is used", name, reported, list, *words.begin()));
    return *words.begin();
}

bool OptionReader::flag(const std::string& name, bool otherwise, std::string_view yes, std::string_view no) {
    const auto reported = text(name);
    const bool is_switch = yes == "on" && no == "off";
    if (reported == yes || (is_switch && (reported == "true" || reported == "1"))) return true;
    if (reported == no || (is_switch && (reported == "false" || reported == "0"))) return false;
    if (!reported.empty()) fault(fmt::format("option {} = {}: write {} or {}; {} is used", name, reported, yes, no, otherwise ? yes : no));
    return otherwise;
}

std::int64_t OptionReader::whole(const std::string& name, std::int64_t low, std::int64_t high, std::int64_t otherwise) {
    const auto reported = text(name);
    if (reported.empty()) return otherwise;
    std::int64_t v = 0;
    const auto [p, ec] = std::from_chars(reported.data(), reported.data() + reported.size(), v);
    if (ec == std::errc{} && p == reported.data() + reported.size() && v >= low && v <= high) return v;
    fault(fmt::format("option {} = {}: write a whole number {}..{}; {} is used", name, reported, low, high, otherwise));
    return otherwise;
}

Duration OptionReader::milliseconds(const std::string& name, std::int64_t low, std::int64_t high, Duration otherwise) {
    return std::chrono::milliseconds(whole(name, low, high, milliseconds_of(otherwise)));
}

}  // namespace axisgate::drive
