// One key of the configuration and the function that reads its value. The gateway's own keys and those of each door are read alike.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate {
struct Config;
}  // namespace axisgate

namespace axisgate::setting {

/// The remedy, if the text cannot be the value; empty if the value was set.
using Unfit = std::optional<std::string>;

/// The forms of a value in TOML: a number in place of a text is a mistake ("port = 5"), and not the text "5".
enum class Written : std::uint8_t { as_text, as_number, as_switch, as_list };

struct Key {
    std::string_view section, name;
    Unfit (*set)(Config&, const std::string&);
    Written written = Written::as_text;
};

[[nodiscard]] Unfit whole_number(std::int64_t& into, const std::string& text, std::int64_t low, std::int64_t high);
[[nodiscard]] Unfit on_or_off(bool& into, const std::string& text);
/// HOST:PORT, or "off", which leaves it empty.
[[nodiscard]] Unfit address(std::string& into, const std::string& text);
[[nodiscard]] Unfit any_text(std::string& into, const std::string& text);
/// 1 to 63 letters, digits, - _ or .: a name that can be part of a path and contains no wildcard.
[[nodiscard]] Unfit plain_name(std::string& into, const std::string& text);
/// "a, b" as a and b.
[[nodiscard]] std::vector<std::string> list_of(const std::string& text);

}  // namespace axisgate::setting
