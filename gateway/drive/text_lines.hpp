// Text lines: a byte stream as lines, for languages whose messages are lines of text; and their decoder, all but the sentences.
// In: frames. Out: lines; sentences for people. Never keeps more than one line of a direction, and loses no byte without giving it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gateway/core/family.hpp"
#include "gateway/core/frame.hpp"

namespace axisgate::drive {

/// The bytes of a run as text, for as long as the frame is; and text as what Frame::run and for_each_run take.
[[nodiscard]] inline std::string_view text_of(const Frame& frame) noexcept {
    return {reinterpret_cast<const char*>(frame.data().data()), frame.data().size()};
}
[[nodiscard]] inline std::span<const std::uint8_t> bytes_of(std::string_view text) noexcept {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class TextLines {
public:
    /// A line ends with `end`, which is not part of it, and begins anew with each of `starts`. Empty ones are none.
    TextLines(char end, std::string_view starts, std::size_t longest) : end_(end), starts_(starts), longest_(longest) {}
    /// What was cut off by a start, or came to `longest` bytes without an end, is given as a line, too.
    template <class F>
    void push(std::string_view bytes, F&& line) {
        for (const char c : bytes) {
            const bool over = c == end_ || starts_.find(c) != starts_.npos || line_.size() >= longest_;
            if (over && !line_.empty()) line(std::string_view(std::exchange(line_, {})));
            if (c != end_) line_ += c;
        }
    }
    /// What has begun and not ended.
    [[nodiscard]] std::string take_rest() { return std::exchange(line_, {}); }

private:
    char end_;
    std::string_view starts_;
    std::size_t longest_;
    std::string line_;
};

/// A recording may begin and end within a line. Of a language whose lines carry a check: what is left of one is not taken for a whole one.
class TextDecoder : public Decoder {
public:
    explicit TextDecoder(const TextLines& lines) : streams_{Stream{lines}, Stream{lines}} {}
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) final;
    std::vector<std::string> finish() final;

protected:
    /// Nothing: it is no telegram of this language.
    [[nodiscard]] virtual std::optional<std::string> sentence(std::string_view line) const = 0;

private:
    struct Stream {
        TextLines lines;
        bool begun = false;  ///< what comes now is not cut off at its beginning
    };
    std::array<Stream, 2> streams_;  ///< one for each direction; one whose direction is not known is the first's
};

}  // namespace axisgate::drive
