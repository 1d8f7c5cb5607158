// Wire: lines of MCode as bytes: address, checksum, terminator; and what may stand in a line.
// In: text. Out: bytes for the link, or what is wrong with the text.
// Never executes or waits; knows no drive.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate::mcode {

inline constexpr char ctrl_c = 0x03, ack = 0x06, lf = 0x0A, cr = 0x0D, nak = 0x15, esc = 0x1B;
/// Characters of one line: text, blanks and comment together [L626, L4897].
inline constexpr std::size_t line_limit = 64;
/// Name of a drive that is alone on its line, in single mode [L5002].
inline constexpr char single_name = '!';

/// ((-sum) & 7F) | 80 over all characters, the address and blanks included [L6867-6868].
[[nodiscard]] char checksum(std::string_view text) noexcept;
/// `text` ends with its checksum: the low seven bits of the sum are 0 [L6889].
[[nodiscard]] bool checksum_good(std::string_view text) noexcept;

/// How a drive is spoken to.
struct Link {
    char name = single_name;  ///< single_name: single mode, CR ends a line; else party mode, LF ends it
    bool with_checksum = false;
    [[nodiscard]] bool party() const noexcept { return name != single_name; }
};
/// The bytes of one command.
[[nodiscard]] std::string request(const Link& link, std::string_view text);
/// The escape character for this drive alone: ESC, with the name in front in party mode (ES = 3) [L2742-2744].
[[nodiscard]] std::string escape(const Link& link);

/// Empty if `text` can be sent as one line, else why not.
[[nodiscard]] std::string check_line(std::string_view text);
/// Empty if `address` is `!` or one of a-z, A-Z, 0-9 [L2462], else what would be right.
[[nodiscard]] std::string check_address(std::string_view address);

/// First word of a line in upper case ("MA" of "ma 100"); empty if it begins with no letter.
[[nodiscard]] std::string word_of(std::string_view text);

}  // namespace axisgate::mcode
