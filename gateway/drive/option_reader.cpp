// OptionReader: words, switches and numbers of a site's options.
// In: the options as text. Out: values, and one sentence for each that could not be read, with what would be right and what is used.
// Never takes half of a number: what stands behind it makes it none.
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
    const auto said = text(name);
    if (said.empty()) return *words.begin();
    if (const auto* w = std::ranges::find(words, said); w != words.end()) return *w;
    std::string list;
    for (std::size_t i = 0; i < words.size(); ++i)
        list += fmt::format("{}{}", i == 0 ? "" : i + 1 == words.size() ? " or " : ", ", words.begin()[i]);
    fault(fmt::format("option {} = {}: write {}; {} is used", name, said, list, *words.begin()));
    return *words.begin();
}

bool OptionReader::flag(const std::string& name, bool otherwise, std::string_view yes, std::string_view no) {
    const auto said = text(name);
    const bool is_switch = yes == "on" && no == "off";
    if (said == yes || (is_switch && (said == "true" || said == "1"))) return true;
    if (said == no || (is_switch && (said == "false" || said == "0"))) return false;
    if (!said.empty()) fault(fmt::format("option {} = {}: write {} or {}; {} is used", name, said, yes, no, otherwise ? yes : no));
    return otherwise;
}

std::int64_t OptionReader::whole(const std::string& name, std::int64_t low, std::int64_t high, std::int64_t otherwise) {
    const auto said = text(name);
    if (said.empty()) return otherwise;
    std::int64_t v = 0;
    const auto [p, ec] = std::from_chars(said.data(), said.data() + said.size(), v);
    if (ec == std::errc{} && p == said.data() + said.size() && v >= low && v <= high) return v;
    fault(fmt::format("option {} = {}: write a whole number {}..{}; {} is used", name, said, low, high, otherwise));
    return otherwise;
}

Duration OptionReader::milliseconds(const std::string& name, std::int64_t low, std::int64_t high, Duration otherwise) {
    return std::chrono::milliseconds(whole(name, low, high, milliseconds_of(otherwise)));
}

}  // namespace axisgate::drive
