// Wire of the example drive: one line of text per telegram, with a checksum. `@051R21=1500*7F` asks drive 05, axis 1; `#` begins its
// answer. In: bytes, telegrams. Out: telegrams, bytes. No state but the line that is being received.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace axisgate::example {

struct Telegram {
    enum class Kind : char { read = '?', value = '=', refused = '!' };
    int address = 1;         ///< 1..99
    int axis = 1;            ///< 1..4
    std::string item;        ///< three characters: "R06" a register, "S00" the state of the axis
    Kind kind = Kind::read;  ///< a request has read or value, an answer value or refused
    std::string text;        ///< the value, or the code of the refusal; empty with read
    [[nodiscard]] bool operator==(const Telegram&) const = default;
};

inline constexpr std::size_t longest = 64;  ///< bytes of a telegram; what goes on without an end is dropped
[[nodiscard]] std::string text_of(const Telegram& telegram, bool request);
/// Without its end; nothing if the form or the checksum is wrong. `request`: which of the two it was.
[[nodiscard]] std::optional<Telegram> telegram_of(std::string_view line, bool& request);

/// Bytes to lines: a line begins anew with each `@` or `#`.
class Framer {
public:
    template <class F>
    void push(std::string_view bytes, F&& line) {
        for (const char c : bytes) {
            if (c == '@' || c == '#' || line_.size() >= longest) line_.clear();
            if (c != '\r') line_ += c;
            if (c == '\r') line(std::string_view(line_));
            if (c == '\r') line_.clear();
        }
    }

private:
    std::string line_;
};

}  // namespace axisgate::example
