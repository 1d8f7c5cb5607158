// Wire: checksum as the two's complement of the sum with bit 7 set [L6867]; the name in front, CR or LF behind by the kind of line.
// In: text of one line. Out: its bytes; why a text is no line.
// Never accepts a byte that could end a line early.
#include "adapters/mcode/wire.hpp"

#include <fmt/core.h>

#include "gateway/core/text.hpp"

namespace axisgate::mcode {
namespace {
unsigned sum_of(std::string_view text) noexcept {
    unsigned sum = 0;
    for (const char c : text)
        sum += static_cast<std::uint8_t>(c);
    return sum;
}
}  // namespace

char checksum(std::string_view text) noexcept { return static_cast<char>(((0U - sum_of(text)) & 0x7FU) | 0x80U); }
bool checksum_good(std::string_view text) noexcept { return !text.empty() && (sum_of(text) & 0x7FU) == 0; }

std::string request(const Link& link, std::string_view text) {
    std::string out;
    if (link.party()) out += link.name;
    out += text;
    if (link.with_checksum) out += checksum(out);
    out += link.party() ? lf : cr;
    return out;
}

std::string escape(const Link& link) {
    std::string out;
    if (link.party()) out += link.name;
    out += esc;
    return out;
}

std::string check_line(std::string_view text) {
    if (text.empty()) return "the line is empty";
    if (text.size() > line_limit) {
        return fmt::format("the line has {} characters; {} are allowed, blanks and comment included", text.size(), line_limit);
    }
    for (std::size_t i = 0; i < text.size(); ++i) {
        const auto c = static_cast<std::uint8_t>(text[i]);
        if (c < 0x20 || c > 0x7E) return fmt::format("character {} is 0x{:02X}: one line of printable ASCII is wanted", i + 1, c);
    }
    return {};
}

std::string check_address(std::string_view address) {
    if (address.size() == 1 && (address[0] == single_name || is_letter(address[0]) || is_digit(address[0]))) return {};
    return fmt::format("{} is not an address: write ! for a drive in single mode, or its name in party mode, one of a-z, A-Z, 0-9",
                       address.empty() ? "nothing" : address);
}

std::string word_of(std::string_view text) {
    std::size_t i = 0;
    while (i < text.size() && text[i] == ' ')
        ++i;
    std::string w;
    while (i < text.size() && (is_letter(text[i]) || (!w.empty() && (is_digit(text[i]) || text[i] == '_')))) {
        const char c = text[i++];
        w += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
    }
    return w;
}

}  // namespace axisgate::mcode
