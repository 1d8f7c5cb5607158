// The wire format of the example drive: one line of text per telegram, with a checksum. `@051R21=1500*7F` addresses drive 05, axis 1; `#`
// begins its answer.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "gateway/drive/text_lines.hpp"

namespace axisgate::example {

struct Telegram {
    enum class Kind : char { read = '?', value = '=', refused = '!' };
    int address = 1;         ///< 1..99
    int axis = 1;            ///< 1..4
    std::string item;        ///< three characters: "R06" a register, "S00" the state of the axis
    Kind kind = Kind::read;  ///< a request has read or value, an answer value or refused
    std::string text;        ///< the value, or the code of the refusal; empty in a read request
    [[nodiscard]] bool operator==(const Telegram&) const = default;
};

inline constexpr std::size_t longest = 64;  ///< bytes of a telegram; a longer line is not a telegram
[[nodiscard]] std::string text_of(const Telegram& telegram, bool request);
/// Without its line end; empty if the form or the checksum is wrong. `request` selects requests or answers.
[[nodiscard]] std::optional<Telegram> telegram_of(std::string_view line, bool& request);

/// The lines of a byte stream; a telegram begins with `@` or `#`.
[[nodiscard]] inline drive::TextLines lines() { return {'\r', "@#", longest}; }

}  // namespace axisgate::example
