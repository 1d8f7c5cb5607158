// Control characters are never shown in a sentence.
#include "gateway/drive/text_lines.hpp"

#include <algorithm>

namespace axisgate::drive {
namespace {
std::string shown(std::string text) {
    std::ranges::replace_if(
        text, [](char c) { return c < ' ' || c > '~'; }, '.');
    return text;
}
}  // namespace

std::vector<std::string> TextDecoder::on_frame(const Frame& frame, std::optional<bool> to_drive) {
    std::vector<std::string> reported;
    Stream& s = streams_[to_drive.value_or(true) ? 0 : 1];
    if (frame.kind == Frame::Kind::can_error) return reported;  // reported by the CAN controller; not text of the protocol
    s.lines.push(text_of(frame), [&](std::string_view line) {
        const bool first = !std::exchange(s.begun, true);
        const std::string_view what = first ? "the end of a telegram that began before the recording: " : "unknown, no telegram: ";
        reported.push_back(shown(sentence(line).value_or(std::string(what) + std::string(line))));
    });
    return reported;
}

std::vector<std::string> TextDecoder::finish() {
    std::vector<std::string> reported;
    for (Stream& s : streams_)
        if (const std::string rest = s.lines.take_rest(); !rest.empty())
            reported.push_back(shown("a telegram that had not ended when the recording did: " + rest));
    return reported;
}

}  // namespace axisgate::drive
