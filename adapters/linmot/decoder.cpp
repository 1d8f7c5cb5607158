// A recording may begin or end within a telegram; the fragments get one line each. At most one incomplete telegram and one fragment are
// kept per direction.
#include "adapters/linmot/decoder.hpp"

#include <fmt/format.h>

#include <utility>

#include "adapters/linmot/wire_inferred.hpp"

namespace axisgate::linmot {
namespace {
constexpr std::size_t longest_telegram = 63 + 4;  // the length byte, and the bytes that it does not count

std::string hex(std::span<const std::uint8_t> data) { return fmt::format("{:02X}", fmt::join(data, " ")); }
std::string bits(const boost::json::object& document, const char* list, std::uint16_t word) {
    std::string s;
    const auto* names = document.if_contains(list);
    for (const auto& b : names->get_array()) {
        if ((word >> b.get_object().at("bit").as_int64() & 1) != 0)
            s += (s.empty() ? "" : " ") + std::string(b.get_object().at("name").as_string());
    }
    return s.empty() ? "none" : s;
}
}  // namespace

std::string LineDecoder::parameter_name(std::uint16_t upid) const {
    const auto point = catalogue_.find(fmt::format("{:04X}h", upid));
    return fmt::format("{:04X}h{}", upid, point ? " (" + catalogue_.parameter(*point)->name + ")" : std::string());
}

std::string LineDecoder::request_text(const Telegram& t) const {
    switch (static_cast<Main>(t.main)) {
        case Main::response:
            return t.sub == 1 ? "asks for the default response" : fmt::format("asks for response {:02X}h", t.sub);
        case Main::control_word:
            return fmt::format("control word {:04X}h: {}", t.u16(0), bits(catalogue_.document(), "control_bits", t.u16(0)));
        case Main::motion:
            return motions_.describe(t.data());
        case Main::ram:
            return fmt::format("{} RAM value of {}", t.sub == 0 ? "reads" : "message 03h of the", parameter_name(t.u16(0)));
        case Main::parameters: {
            static constexpr const char* what[] = {"reads the ROM value of", "writes the ROM value of", "writes RAM and ROM of",
                                                   "asks the usage of",      "asks the type of",        "asks the minimum of",
                                                   "asks the maximum of",    "asks the default of"};
            if (t.sub < 8)
                return fmt::format("{} {}{}", what[t.sub], parameter_name(t.u16(0)),
                                   t.size >= 6 ? fmt::format(": {}", t.u32(2)) : std::string());
            if (t.sub == 0x0A) return fmt::format("starts the list of parameters at {:04X}h", t.u16(0));
            return t.sub == 0x0B ? "next parameter of the list" : fmt::format("parameter message {:02X}h", t.sub);
        }
        case Main::program: {
            static constexpr const char* what[] = {"", "resets the drive, answer afterwards", "resets the drive, answer at once",
                                                   "stops the software", "starts the software"};
            return t.sub >= 1 && t.sub <= 4 ? what[t.sub] : fmt::format("program message {:02X}h", t.sub);
        }
        case Main::errors:
            return t.sub == 0   ? "asks the text of the present error"
                   : t.sub == 1 ? fmt::format("asks the text of error {:04X}h", t.u16(0))
                   : t.sub == 2 ? "asks the error counters"
                                : fmt::format("error message {:02X}h", t.sub);
        case Main::curves:
            return fmt::format("curve message {:02X}h{}", t.sub, t.size >= 2 ? fmt::format(", curve {}", t.u16(0)) : std::string());
        case Main::table:
            return fmt::format("command table message {:02X}h{}", t.sub,
                               t.size >= 2 ? fmt::format(", {} {}", t.sub == 7 ? "block" : "entry", t.u16(0)) : std::string());
    }
    return fmt::format("unknown main ID {:02X}h, sub ID {:02X}h", t.main, t.sub);
}

std::string LineDecoder::answer_text(const Telegram& t) const {
    if (t.sub == 0) {
        const auto s = status_of(t, t.size == size_without_position ? size_without_position : default_size);
        if (!s) return "unknown: a response that is no default response";
        const auto main = s->state();
        std::string where = fmt::format("state {}", main);
        for (const auto& x : catalogue_.document().at("states").get_array()) {
            if (x.get_object().at("code").as_int64() == main) where = std::string(x.get_object().at("name").as_string());
        }
        if (main == state::enabled) where += fmt::format(", count {}", s->sub_state() & 0x0F);
        if (main == state::error || main == state::setup_error) {
            const ErrorCode* e = catalogue_.error(s->sub_state());
            where += fmt::format(" {:02X}h{}", s->sub_state(), e ? " (" + e->text + ")" : std::string());
        }
        std::string more;
        if (t.size == ram_size)
            more = fmt::format(", value {}", t.u32(default_size));
        else if (t.size != default_size)
            more = ", reconfigured";
        const std::string place = s->placed ? fmt::format("position {:.4f} mm, ", s->position / 10'000.0) : std::string();
        return fmt::format("{}, {}status {:04X}h: {}{}", where, place, s->status, bits(catalogue_.document(), "status_bits", s->status),
                           more);
    }
    if (t.sub == 0x60) return fmt::format("program message done: {}", communication_text(t.storage[0]));
    if (t.sub == 0x71 && t.size >= 3) {
        std::string text(t.data().begin() + 3, t.data().end());
        return fmt::format("text of error {:04X}h: {}", t.u16(1), text.substr(0, text.find('\0')));
    }
    if (t.sub == 0x72 && t.size >= 5) return fmt::format("{} log entries, {} errors occurred", t.u16(1), t.u16(3));
    if (const auto a = config_of(t)) {
        const char* of = t.sub >= 0x80 ? "command table" : t.sub >= 0x50 ? "parameter" : "curve";
        return fmt::format("{} answer {:02X}h: {}, {} {}, value {}", of, t.sub, communication_text(a->communication),
                           of[0] == 'p' ? "UPID" : "number", of[0] == 'p' ? parameter_name(a->index) : std::to_string(a->index), a->value);
    }
    return fmt::format("unknown answer {:02X}h", t.sub);
}

std::string LineDecoder::describe(const Telegram& t, std::optional<bool> to_drive) const {
    const bool request = to_drive.value_or(t.main != 0 || t.size == 0);
    return fmt::format("ID {}  {}  {}{}{}", t.id, request ? "to the drive" : "from the drive", request ? request_text(t) : answer_text(t),
                       request && inferred(t.main, t.sub) ? " [inferred]" : "", to_drive ? "" : " (direction by its form)");
}

std::vector<std::string> LineDecoder::on_frame(const Frame& frame, std::optional<bool> to_drive) {
    std::vector<std::string> lines;
    if (frame.kind != Frame::Kind::bytes) {
        lines.push_back(to_text(frame) + "  unknown: a CAN frame on a byte line");
        return lines;
    }
    Stream& s = streams_[!to_drive ? 2 : *to_drive ? 1 : 0];
    s.framer.push(
        frame.data(),
        [&](const Telegram& t, std::span<const std::uint8_t> bytes) {
            begin(s, lines);
            lines.push_back(hex(bytes) + "  " + describe(t, to_drive));
        },
        [&](std::span<const std::uint8_t> bytes, std::string_view why) { strange(s, bytes, why, lines); });
    return lines;
}

void LineDecoder::strange(Stream& s, std::span<const std::uint8_t> bytes, std::string_view why, std::vector<std::string>& lines) {
    auto& reported = s.begun ? lines : s.strange;
    reported.push_back(hex(bytes) + "  unknown: " + std::string(why));
    if (s.begun) return;
    s.before.insert(s.before.end(), bytes.begin(), bytes.end());
    if (s.before.size() >= longest_telegram) begin(s, lines);
}

/// From here on, telegrams follow each other. The bytes before the first one are the end of another telegram, or not LinRS.
void LineDecoder::begin(Stream& s, std::vector<std::string>& lines) {
    if (std::exchange(s.begun, true) || s.before.empty()) return;
    if (s.before.size() < longest_telegram && s.before.back() == end_byte) {
        lines.push_back(hex(s.before) + "  the end of a telegram that began before the recording");
    } else {
        lines.insert(lines.end(), s.strange.begin(), s.strange.end());
    }
    s.before.clear();
    s.strange.clear();
}

std::vector<std::string> LineDecoder::finish() {
    std::vector<std::string> lines;
    for (Stream& s : streams_) {
        std::vector<std::uint8_t> rest;
        s.framer.reset([&](std::span<const std::uint8_t> bytes, std::string_view) { rest.assign(bytes.begin(), bytes.end()); });
        if (!s.before.empty()) {
            // No telegram was complete: a start byte among these bytes may be data, and the fragment is the last part that a telegram can
            // follow.
            std::vector<std::uint8_t> all(s.before);
            all.insert(all.end(), rest.begin(), rest.end());
            std::size_t end = 0;
            for (std::size_t i = 1; i < longest_telegram && i <= all.size(); ++i) {
                if (all[i - 1] == end_byte && (i == all.size() || all[i] == start_byte)) end = i;
            }
            if (end != 0) {
                s.before.assign(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(end));
                rest.assign(all.begin() + static_cast<std::ptrdiff_t>(end), all.end());
            } else if (all.size() < longest_telegram) {
                lines.push_back(hex(all) + "  bytes of a telegram that began before the recording and ended after it");
                s.before.clear();
                rest.clear();
            }
        }
        begin(s, lines);
        if (!rest.empty()) lines.push_back(hex(rest) + "  a telegram that had not ended when the recording did");
    }
    return lines;
}

}  // namespace axisgate::linmot
