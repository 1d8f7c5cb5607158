// TextLines splits a byte stream into lines, for protocols whose messages are lines of text; TextDecoder is the decoder of such protocols
// without their sentences. At most one incomplete line per direction is kept, and no byte is lost.
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

/// text_of: the bytes of a run as text, valid as long as the frame. bytes_of: text as the argument of Frame::run and for_each_run.
[[nodiscard]] inline std::string_view text_of(const Frame& frame) noexcept {
    return {reinterpret_cast<const char*>(frame.data().data()), frame.data().size()};
}
[[nodiscard]] inline std::span<const std::uint8_t> bytes_of(std::string_view text) noexcept {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

class TextLines {
public:
    /// A line ends with `end`, which is not part of it, and each character of `starts` begins a new line. Empty lines are skipped.
    TextLines(char end, std::string_view starts, std::size_t longest) : end_(end), starts_(starts), longest_(longest) {}
    /// An incomplete line that a start character has cut off, or that has reached `longest` bytes, is passed on as a line, too.
    template <class F>
    void push(std::string_view bytes, F&& line) {
        for (const char c : bytes) {
            const bool over = c == end_ || starts_.find(c) != starts_.npos || line_.size() >= longest_;
            if (over && !line_.empty()) line(std::string_view(std::exchange(line_, {})));
            if (c != end_) line_ += c;
        }
    }
    /// The incomplete line.
    [[nodiscard]] std::string take_rest() { return std::exchange(line_, {}); }

private:
    char end_;
    std::string_view starts_;
    std::size_t longest_;
    std::string line_;
};

/// A recording may begin and end within a line. In protocols whose lines carry a checksum, such a fragment is not taken for a complete
/// line.
class TextDecoder : public Decoder {
public:
    explicit TextDecoder(const TextLines& lines) : streams_{Stream{lines}, Stream{lines}} {}
    std::vector<std::string> on_frame(const Frame& frame, std::optional<bool> to_drive) final;
    std::vector<std::string> finish() final;

protected:
    /// Empty if the line is not a telegram of this protocol.
    [[nodiscard]] virtual std::optional<std::string> sentence(std::string_view line) const = 0;

private:
    struct Stream {
        TextLines lines;
        bool begun = false;  ///< the next line is complete at its beginning
    };
    std::array<Stream, 2> streams_;  ///< one for each direction; an unknown direction uses the first
};

}  // namespace axisgate::drive
