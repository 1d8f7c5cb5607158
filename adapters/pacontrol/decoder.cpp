// Decoder of the PA-CONTROL: text for frames.
// In: runs of bytes of both directions. Out: a line per frame or poll; bytes between frames are told as strange.
// Never holds more than one frame and 64 strange bytes per direction.
#include "adapters/pacontrol/decoder.hpp"

#include <fmt/format.h>

#include <iterator>

#include "adapters/pacontrol/wire_commands.hpp"

namespace axisgate::pacontrol {
namespace {
std::string hex(std::span<const std::uint8_t> data) {
    std::string s;
    for (const auto b : data)
        fmt::format_to(std::back_inserter(s), "{}{:02X}", s.empty() ? "" : " ", b);
    return s;
}

/// "check 57 good", "check 60 leaves the ETX in or out against the rule", "check 0, not used", "check 12 wrong (57)".
std::string check_text(std::string_view text, std::string_view digits, CheckForm rule) {
    const auto form = form_of_check(text, digits, rule);
    if (!form) return fmt::format("check {} wrong, {} would be right", digits.empty() ? "missing" : digits, check_of(text, rule));
    if (*form == rule) return fmt::format("check {} good", digits);
    if (*form == CheckForm::zero) return fmt::format("check {}, not used", digits);
    return fmt::format("check {} as for the other direction, {} would be right", digits, check_of(text, rule));
}
}  // namespace

void LineDecoder::flush(Stream& s, std::vector<std::string>& lines) {
    if (s.junk.empty()) return;
    lines.push_back(fmt::format("{}  unknown: {}", hex(s.junk), name_of(s.fault)));
    s.junk.clear();
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
        [&] {
            flush(s, lines);
            if (to_drive && !*to_drive) {
                lines.emplace_back("04  unknown: an EOT outside a frame, from the control");
            } else {
                lines.push_back(
                    fmt::format("EOT  to the control  poll: asks for another acknowledgement{}", to_drive ? "" : " (direction not known)"));
            }
        },
        [&](FrameFault fault, std::span<const std::uint8_t> bytes) {
            if (fault != s.fault) flush(s, lines);
            s.fault = fault;
            s.junk.insert(s.junk.end(), bytes.begin(), bytes.end());
            if (fault != FrameFault::stray || s.junk.size() >= junk_limit) flush(s, lines);
        }};
    s.framer.push(frame.data(), sink);
    return lines;
}

std::vector<std::string> LineDecoder::finish() {
    std::vector<std::string> lines;
    for (Stream& s : streams_) {
        flush(s, lines);
        if (const auto rest = s.framer.pending(); !rest.empty())
            lines.push_back(fmt::format("{}  unknown: a frame that does not end", hex(rest)));
        s.framer.reset();
    }
    return lines;
}

}  // namespace axisgate::pacontrol
