// Decoder of the UIM342: text for frames.
// In: frames, or bytes cut anywhere, of both directions. Out: a line per message; bytes that are none are told with the next message, and
// what the recording has of a message at its edges as that.
// Never holds more than half a frame and 64 strange bytes per direction.
#include "adapters/uim342/decoder.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/uim342/native.hpp"
#include "adapters/uim342/wire_instructions.hpp"

namespace axisgate::uim342 {
namespace {
constexpr std::size_t junk_limit = 64;

std::string id_text(std::uint8_t id) { return id == global_id ? "all" : id == host_id ? "host" : fmt::format("{}", id); }

std::string bytes_text(std::span<const std::uint8_t> data) { return fmt::format("{:02X}", fmt::join(data, " ")); }

/// Classes of linux/can/error.h.
std::string controller_text(std::uint32_t classes) {
    struct Row {
        std::uint32_t bit;
        std::string_view text;
    };
    constexpr std::array rows{Row{0x001, "transmit time-out"},
                              Row{0x002, "lost arbitration"},
                              Row{0x004, "controller problem"},
                              Row{0x008, "protocol violation"},
                              Row{0x010, "transceiver"},
                              Row{0x020, "no acknowledgement on the bus"},
                              Row{0x040, "bus off"},
                              Row{0x080, "bus error"},
                              Row{0x100, "controller restarted"}};
    std::string s;
    for (const auto& r : rows) {
        if (classes & r.bit) s += fmt::format("{}{}", s.empty() ? "" : ", ", r.text);
    }
    return s.empty() ? "unknown class" : s;
}
}  // namespace

std::string LineDecoder::can_line(const Frame& f) {
    const std::string raw = to_text(f);
    if (f.kind == Frame::Kind::can_error) return fmt::format("{}  CAN controller: {}", raw, controller_text(f.id & 0x1FF));
    if (f.kind != Frame::Kind::can) return fmt::format("{}  unknown: bytes on a CAN line", raw);
    const auto m = from_can(f);
    if (!m) {
        return fmt::format("{}  unknown: not SimpleCAN ({})", raw,
                           !f.extended  ? "11-bit identifier"
                           : f.remote   ? "remote frame"
                           : f.size > 8 ? "more than 8 bytes"
                                        : "reserved bits of the identifier are set");
    }
    const bool to_drive = m->producer == host_id || (m->consumer != host_id && m->message.wants_ack());
    return fmt::format("{}  {} -> {}  {}", raw, id_text(m->producer), id_text(m->consumer),
                       to_drive ? describe_request(m->message) : describe_answer(m->message));
}

void LineDecoder::flush_junk(Stream& s, std::vector<std::string>& lines) {
    const bool first = !std::exchange(s.begun, true);
    if (s.junk.empty()) return;
    if (first && s.junk.size() < uimessage_size && s.junk.back() == 0xCC) {
        lines.push_back(fmt::format("{}  the end of a UIMessage that began before the recording", bytes_text(s.junk)));
    } else if (s.junk.size() == uimessage_size && s.junk.front() == 0xAA && s.junk.back() == 0xCC) {
        const std::span<const std::uint8_t> b(s.junk);
        lines.push_back(fmt::format("{}  unknown: a frame with a wrong CRC (it has {:04X}; ID to d8 gives {:04X}, AA to d8 {:04X})",
                                    bytes_text(b), get_u16(&s.junk[13]), crc16(b.subspan(1, 12)), crc16(b.first(13))));
    } else {
        lines.push_back(fmt::format("{}  unknown: {} bytes that are no UIMessage", bytes_text(s.junk), s.junk.size()));
    }
    s.junk.clear();
}

std::vector<std::string> LineDecoder::on_frame(const Frame& frame, std::optional<bool> to_drive) {
    std::vector<std::string> lines;
    if (kind_ == LineKind::can) {
        lines.push_back(can_line(frame));
        return lines;
    }
    if (frame.kind != Frame::Kind::bytes) {
        lines.push_back(to_text(frame) + "  unknown: a CAN frame on a byte line");
        return lines;
    }
    Stream& s = streams_[!to_drive ? 2 : *to_drive ? 1 : 0];
    s.framer.push(
        frame.data(),
        [&](const UiCheck& check, const UiBytes& raw) {
            flush_junk(s, lines);
            const Message& m = check.message;
            const bool down = to_drive.value_or(m.wants_ack() || m.id == global_id);
            const std::string_view sure = to_drive || m.wants_ack() || m.id == global_id ? "" : " (direction not known)";
            const std::string_view crc = check.proved == CrcMode::twelve     ? "CRC good, ID to d8"
                                         : check.proved == CrcMode::thirteen ? "CRC good, AA to d8"
                                                                             : "no CRC";
            lines.push_back(fmt::format("{}  {} {}  {}{} [{}]", bytes_text(raw), down ? "to" : "from", id_text(m.id),
                                        down ? describe_request(m) : describe_answer(m), sure, crc));
        },
        [&](std::uint8_t b) {
            s.junk.push_back(b);
            if (s.junk.size() == junk_limit) flush_junk(s, lines);
        });
    return lines;
}

std::vector<std::string> LineDecoder::finish() {
    std::vector<std::string> lines;
    for (Stream& s : streams_) {
        std::span<const std::uint8_t> rest = s.framer.pending();
        std::vector<std::uint8_t> all(s.junk);
        all.insert(all.end(), rest.begin(), rest.end());
        if (!s.begun && !s.junk.empty()) {
            // No message was whole: a start byte among these may be one of its data, and the end is the last that a message can follow.
            std::size_t end = 0;
            for (std::size_t i = 1; i < uimessage_size && i <= all.size(); ++i) {
                if (all[i - 1] == 0xCC && (i == all.size() || all[i] == 0xAA || all[i] == 0xAD)) end = i;
            }
            if (end != 0) {
                s.junk.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(end));
                rest = std::span(all).subspan(end);
            } else if (all.size() < uimessage_size) {
                lines.push_back(
                    fmt::format("{}  bytes of a UIMessage that began before the recording and ended after it", bytes_text(all)));
                s.junk.clear();
                rest = {};
            }
        }
        flush_junk(s, lines);
        if (!rest.empty()) {
            lines.push_back(fmt::format("{}  the first {} of the {} bytes of a UIMessage that had not ended when the recording did",
                                        bytes_text(rest), rest.size(), uimessage_size));
        }
        s.framer.reset();
    }
    return lines;
}

}  // namespace axisgate::uim342
