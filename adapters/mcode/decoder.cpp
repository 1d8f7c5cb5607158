// Decoder of MCode: lines are put together from runs, each direction by itself; an answer is read by the question before it.
// In: runs of bytes. Out: one sentence per line, with what its words mean.
// Never guesses a direction: unknown ones are marked with `--`.
#include "adapters/mcode/decoder.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "adapters/mcode/wire.hpp"

namespace axisgate::mcode {
namespace {
constexpr std::array<std::string_view, 3> arrows{"<-", "->", "--"};

std::string visible(std::string_view text) {
    std::string s;
    for (const char c : text) {
        const auto b = static_cast<std::uint8_t>(c);
        if (b >= 0x20 && b <= 0x7E) {
            s += c;
        } else {
            s += fmt::format("<{:02X}>", b);
        }
    }
    return s;
}
}  // namespace

void LineDecoder::flush(std::size_t direction, std::string_view end, std::vector<std::string>& lines) {
    std::string text = std::move(held_[direction]);
    held_[direction].clear();
    bool doubtful = !std::exchange(begun_[direction], true);
    if (text.empty() && direction != 1) return;
    if (text.empty() && end == "CR") return;
    constexpr std::string_view only_end = "the end of a line that began before the recording";
    std::string what, sum;
    if (!text.empty() && static_cast<std::uint8_t>(text.back()) >= 0x80) {
        const bool right = checksum_good(text);
        sum = fmt::format(" [checksum {:02X} {}]", static_cast<std::uint8_t>(text.back()), right ? "good" : "wrong");
        text.pop_back();
        doubtful = doubtful && !right;
        if (doubtful && text.empty()) {
            lines.push_back(fmt::format("{} {}{}", arrows[direction], only_end, sum));
            return;
        }
    }
    const bool strange = std::ranges::any_of(text, [](char c) { return static_cast<std::uint8_t>(c) > 0x7E; });
    if (direction == 1) {
        if (text.empty()) {
            what = doubtful ? fmt::format("wakes the party line, or {}", only_end) : "wakes the party line";
            doubtful = false;
        } else if (end == "LF") {
            const char name = text.front();
            const std::string who = name == '*' ? "all" : name == '^' ? "queue" : visible(std::string_view(&text.front(), 1));
            what = fmt::format("to {}: {}", who, visible(std::string_view(text).substr(1)));
        } else {
            what = visible(text);
        }
    } else {
        what = visible(text);
    }
    if (strange) what += "  unknown: bytes that are no MCode";
    lines.push_back(fmt::format("{} {}{}{}{}", arrows[direction], what, sum, end.empty() ? "  (not ended)" : "",
                                doubtful ? "  (first in the recording: perhaps only the end of a line)" : ""));
}

void LineDecoder::put(std::size_t direction, char c, std::vector<std::string>& lines) {
    std::string& held = held_[direction];
    const auto control = [&](std::string_view text) {
        std::string name = direction == 1 && held.size() == 1 ? fmt::format(" for {}", visible(held)) : std::string();
        if (name.empty() && !held.empty()) flush(direction, "", lines);
        held.clear();
        begun_[direction] = true;
        lines.push_back(fmt::format("{} {}{}", arrows[direction], text, name));
    };
    switch (c) {
        case lf:
            return flush(direction, "LF", lines);
        case cr:
            return flush(direction, "CR", lines);
        case ack:
            return control("ACK");
        case nak:
            return control("NAK");
        case esc:
            return control("ESC: stop at once");
        case 0x05:
            return control("CTRL+E: stop at once");
        case ctrl_c:
            return control("CTRL+C: reset");
        case '>':
        case '?':
            if (direction != 1 && held.empty()) {
                lines.push_back(fmt::format("{} {}", arrows[direction], c == '>' ? "prompt" : "prompt ? (an error stands: read ER)"));
                return;
            }
            break;
        default:
            break;
    }
    held += c;
    if (held.size() >= longest) flush(direction, "", lines);
}

std::vector<std::string> LineDecoder::on_frame(const Frame& frame, std::optional<bool> to_drive) {
    std::vector<std::string> lines;
    if (frame.kind != Frame::Kind::bytes) {
        lines.push_back(to_text(frame) + "  unknown: a CAN frame on a byte line");
        return lines;
    }
    const std::size_t direction = !to_drive ? 2 : *to_drive ? 1 : 0;
    for (const std::uint8_t b : frame.data())
        put(direction, static_cast<char>(b), lines);
    return lines;
}

std::vector<std::string> LineDecoder::finish() {
    std::vector<std::string> lines;
    for (std::size_t d = 0; d < held_.size(); ++d) {
        if (!held_[d].empty()) flush(d, "", lines);
    }
    return lines;
}

}  // namespace axisgate::mcode
