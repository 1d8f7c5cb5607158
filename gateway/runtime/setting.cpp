// Kinds of values that several tables share.
#include "gateway/runtime/setting.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>

#include "gateway/runtime/config.hpp"

namespace axisgate::setting {

Unfit whole_number(std::int64_t& into, const std::string& s, std::int64_t low, std::int64_t high) {
    std::int64_t v = 0;
    const auto [p, ec] = std::from_chars(s.data(), s.data() + s.size(), v);
    if (ec != std::errc{} || p != s.data() + s.size() || v < low || v > high)
        return fmt::format("write a whole number from {} to {}", low, high);
    into = v;
    return {};
}
Unfit on_or_off(bool& into, const std::string& s) {
    if (s == "true" || s == "1" || s == "on") {
        into = true;
    } else if (s == "false" || s == "0" || s == "off") {
        into = false;
    } else {
        return "write true or false";
    }
    return {};
}
Unfit address(std::string& into, const std::string& s) {
    if (!s.empty() && s != "off" && !parse_host_port(s)) return "write HOST:PORT, such as 127.0.0.1:1502 or [::1]:1502, or off";
    into = s == "off" ? "" : s;
    return {};
}
Unfit any_text(std::string& into, const std::string& s) {
    into = s;
    return {};
}

Unfit plain_name(std::string& into, const std::string& s) {
    const auto good = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_' || c == '.';
    };
    if (s.empty() || s.size() > 63 || s == "." || s == ".." || !std::ranges::all_of(s, good))
        return "write 1 to 63 letters, digits, - _ or .";
    into = s;
    return {};
}

std::vector<std::string> list_of(const std::string& s) {
    std::vector<std::string> out;
    for (std::size_t i = 0; i < s.size();) {
        const auto comma = std::min(s.find(',', i), s.size());
        const auto one = std::string_view(s).substr(i, comma - i);
        const auto first = one.find_first_not_of(" \t");
        if (first != std::string_view::npos) out.emplace_back(one.substr(first, one.find_last_not_of(" \t") + 1 - first));
        i = comma + 1;
    }
    return out;
}

}  // namespace axisgate::setting
