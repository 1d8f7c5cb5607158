// The checksum is the low byte of the sum of all characters before the `*`, in hex.
#include "adapters/example/wire.hpp"

#include <fmt/core.h>

#include "gateway/core/text.hpp"

namespace axisgate::example {
namespace {
std::string check_of(std::string_view text) {
    unsigned sum = 0;
    for (const char c : text)
        sum += static_cast<std::uint8_t>(c);
    return fmt::format("*{:02X}", sum & 0xFF);
}
}  // namespace

std::string text_of(const Telegram& t, bool request) {
    std::string s = fmt::format("{}{:02}{}{}{}{}", request ? '@' : '#', t.address, t.axis, t.item, static_cast<char>(t.kind), t.text);
    return s + check_of(s) + '\r';
}

std::optional<Telegram> telegram_of(std::string_view line, bool& request) {
    if (line.size() < 11 || line.size() > longest || line.substr(line.size() - 3) != check_of(line.substr(0, line.size() - 3))) return {};
    const char kind = line[7];
    request = line[0] == '@';
    if ((!request && line[0] != '#') || !is_digit(line[1]) || !is_digit(line[2]) || line[3] < '1' || line[3] > '4') return {};
    if (kind != (request ? '?' : '!') && kind != '=') return {};
    return Telegram{(line[1] - '0') * 10 + line[2] - '0', line[3] - '0', std::string(line.substr(4, 3)), static_cast<Telegram::Kind>(kind),
                    std::string(line.substr(8, line.size() - 11))};
}

}  // namespace axisgate::example
