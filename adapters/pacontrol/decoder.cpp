// Decoder of the PA-CONTROL: text for frames.
// In: runs of bytes of both directions. Out: a line per frame or poll; what the recording has of a frame at its edges is told as that,
// bytes between frames as strange. Never holds more than one frame and what may be the end of one per direction.
#include "adapters/pacontrol/decoder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "adapters/pacontrol/wire_commands.hpp"

namespace axisgate::pacontrol {
namespace {
std::string hex(std::span<const std::uint8_t> data) { return fmt::format("{:02X}", fmt::join(data, " ")); }

/// "check 57 good", "check 60 leaves the ETX in or out against the rule", "check 0, not used", "check 12 wrong (57)".
std::string check_text(std::string_view text, std::string_view digits, CheckForm rule) {
    const auto form = form_of_check(text, digits, rule);
    if (!form) return fmt::format("check {} wrong, {} would be right", digits.empty() ? "missing" : digits, check_of(text, rule));
    if (*form == rule) return fmt::format("check {} good", digits);
    if (*form == CheckForm::zero) return fmt::format("check {}, not used", digits);
    return fmt::format("check {} as for the other direction, {} would be right", digits, check_of(text, rule));
}

std::string_view direction_text(std::size_t stream) {
    constexpr std::array<std::string_view, 3> texts{"from the control", "to the control", "direction not known"};
    return texts.at(stream);
}

/// Bytes as frames are written here: control symbols by their names, the text as it is.
std::string frame_text(std::span<const std::uint8_t> bytes) {
    std::string s;
    bool name = true;  // what was written last
    for (const auto b : bytes) {
        const std::string_view symbol = b == SOH ? "SOH" : b == STX ? "STX" : b == ETX ? "ETX" : b == EOT ? "EOT" : "";
        if (!s.empty() && (name || !symbol.empty())) s += ' ';
        name = !symbol.empty();
        name ? s += symbol : s += static_cast<char>(b);
    }
    return s;
}

/// Whether these can be what follows somewhere in a frame: STX, text, ETX and up to three digits, from any place of it on. `ended`: an EOT
/// came after them.
bool within_frame(std::span<const std::uint8_t> bytes, bool ended) {
    if (!bytes.empty() && bytes.front() == STX) bytes = bytes.subspan(1);
    const auto etx = std::ranges::find(bytes, ETX);
    const bool whole = etx != bytes.end();
    const std::span text(bytes.begin(), etx), digits(whole ? std::span(etx + 1, bytes.end()) : bytes);
    const auto is_text = [](std::uint8_t b) { return b >= 0x20 && b <= 0x7F; };
    const auto is_digits = [](std::span<const std::uint8_t> s) {
        return s.size() <= 3 && std::ranges::all_of(s, [](std::uint8_t b) { return b >= '0' && b <= '9'; });
    };
    if (whole)
        return std::ranges::all_of(text, is_text) && text.size() <= Framer::text_limit && is_digits(digits) && !(ended && digits.empty());
    return ended ? is_digits(digits) : std::ranges::all_of(text, is_text);
}
}  // namespace

void LineDecoder::flush(Stream& s, std::vector<std::string>& lines) {
    if (s.junk.empty()) return;
    lines.push_back(fmt::format("{}  unknown: {}", hex(s.junk), name_of(s.fault)));
    s.junk.clear();
}

/// An EOT outside of a frame: a poll, or the end of a frame whose beginning was not recorded. The very first byte to the control may be
/// either of them; from the control it is no poll.
void LineDecoder::ended(Stream& s, std::optional<bool> to_drive, std::vector<std::string>& lines) {
    const bool first = !std::exchange(s.begun, true);
    const std::string_view where = direction_text(static_cast<std::size_t>(&s - streams_.data()));
    const bool from = to_drive && !*to_drive;
    if (first && (s.junk.empty() ? from : within_frame(s.junk, true))) {
        s.junk.push_back(EOT);
        lines.push_back(fmt::format("{}  {}  the end of a frame that began before the recording", frame_text(s.junk), where));
        s.junk.clear();
        return;
    }
    const bool either = first && s.junk.empty();
    flush(s, lines);
    if (from) {
        lines.emplace_back("04  unknown: an EOT outside a frame, from the control");
    } else {
        lines.push_back(fmt::format("EOT  to the control  poll: asks for another acknowledgement{}{}",
                                    either ? ", or the end of a frame that began before the recording" : "",
                                    to_drive ? "" : " (direction not known)"));
    }
}

std::vector<std::string> LineDecoder::on_frame(const Frame& frame, std::optional<bool> to_drive) {
    std::vector<std::string> lines;
    if (frame.kind != Frame::Kind::bytes) {
        lines.push_back(to_text(frame) + "  unknown: a CAN frame on a byte line");
        return lines;
    }
    Stream& s = streams_[!to_drive ? 2 : *to_drive ? 1 : 0];
    const Framer::Sink sink{
        [&](std::string_view text, std::string_view digits) {
            flush(s, lines);
            s.begun = true;
            std::string fault, as_reply;
            const auto request = !to_drive || *to_drive ? request_of(text, fault) : std::nullopt;
            const auto reply = !request && (!to_drive || !*to_drive) ? reply_of(text, as_reply) : std::nullopt;
            const std::string_view sure = to_drive ? "" : " (direction not known)";
            if (request) {
                lines.push_back(fmt::format("SOH STX {} ETX {} EOT  to the control  {}{} [{}]", text, digits, describe(*request), sure,
                                            check_text(text, digits, CheckForm::text)));
            } else if (reply) {
                lines.push_back(fmt::format("SOH STX {} ETX {} EOT  from the control  {}{} [{}]", text, digits, describe(*reply), sure,
                                            check_text(text, digits, CheckForm::with_etx)));
            } else {
                lines.push_back(fmt::format("SOH STX {} ETX {} EOT  unknown: {}", text, digits, to_drive && *to_drive ? fault : as_reply));
            }
        },
        [&] { ended(s, to_drive, lines); },
        [&](FrameFault fault, std::span<const std::uint8_t> bytes) {
            if (fault != s.fault) flush(s, lines);
            s.fault = fault;
            s.junk.insert(s.junk.end(), bytes.begin(), bytes.end());
            if (fault != FrameFault::stray || s.junk.size() > tail_limit) s.begun = true;
            if (fault != FrameFault::stray || s.junk.size() >= (s.begun ? junk_limit : tail_limit + 1)) flush(s, lines);
        }};
    s.framer.push(frame.data(), sink);
    return lines;
}

std::vector<std::string> LineDecoder::finish() {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < streams_.size(); ++i) {
        Stream& s = streams_[i];
        const auto rest = s.framer.pending();
        if (!s.begun && rest.empty() && !s.junk.empty() && within_frame(s.junk, false)) {
            lines.push_back(fmt::format("{}  {}  bytes of a frame that began before the recording and ended after it", frame_text(s.junk),
                                        direction_text(i)));
            s.junk.clear();
        }
        flush(s, lines);
        if (!rest.empty())
            lines.push_back(fmt::format("{}  {}  a frame that had not ended when the recording did", frame_text(rest), direction_text(i)));
        s.framer.reset();
        s.begun = true;
    }
    return lines;
}

}  // namespace axisgate::pacontrol
