// Reads each line in every variant of the given format: candump's log and screen, hex, the text of a trace. The text may have any origin;
// nothing throws.
#include "gateway/runtime/recording.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <boost/json/value.hpp>
#include <charconv>
#include <vector>

#include "gateway/core/json_read.hpp"
#include "gateway/core/text.hpp"
#include "gateway/services/recorder/axr.hpp"
#include "gateway/wire/frame_import.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

constexpr std::string_view blanks = " \t";

/// Removes the next word from the front; empty at the end.
std::string_view take_word(std::string_view& rest) {
    const auto begin = std::min(rest.find_first_not_of(blanks), rest.size());
    const auto end = std::min(rest.find_first_of(blanks, begin), rest.size());
    const auto word = rest.substr(begin, end - begin);
    rest.remove_prefix(end);
    return word;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// Pairs of hex digits, which may be separated by blanks and : , .
std::optional<std::vector<std::uint8_t>> hex_bytes(std::string_view text) {
    std::vector<std::uint8_t> out;
    int high = -1;
    for (const char c : text) {
        const int d = hex_digit(c);
        if (d < 0) {
            if (high < 0 && std::string_view(" \t:,.").find(c) != std::string_view::npos) continue;
            return std::nullopt;
        }
        if (high < 0) {
            high = d;
        } else {
            out.push_back(static_cast<std::uint8_t>(high << 4 | d));
            high = -1;
        }
    }
    if (high >= 0) return std::nullopt;
    return out;
}

/// Identifier and data: "04280095#01", "123#R", or candump's screen form "04280095 [1] 01".
std::optional<Frame> can_frame(std::string_view id_text, std::string_view data_text) {
    constexpr std::uint32_t error_flag = 0x20000000u;
    std::uint32_t id = 0;
    const auto [p, ec] = std::from_chars(id_text.data(), id_text.data() + id_text.size(), id, 16);
    if (ec != std::errc{} || p != id_text.data() + id_text.size() || id_text.size() < 3 || id_text.size() > 8) return std::nullopt;
    Frame f;
    f.kind = (id & error_flag) && id_text.size() == 8 ? Frame::Kind::can_error : Frame::Kind::can;
    f.extended = id_text.size() > 3;
    f.id = id & 0x1FFFFFFFu;
    if (data_text.starts_with('R') || data_text.starts_with("remote")) {
        f.remote = true;
        return f;
    }
    const auto data = hex_bytes(data_text);
    if (!data || data->size() > 8) return std::nullopt;
    f.assign(*data);
    return f;
}

/// "04280095#01" and "error 00000040#..." are CAN, anything else is a run of bytes.
bool read_frames(std::string_view text, RecordedFrame& r, const RecordingEvents& events) {
    const auto begin = text.find_first_not_of(blanks);
    text.remove_prefix(std::min(begin, text.size()));
    const bool report = text.starts_with("error ");
    if (report) text.remove_prefix(6);
    if (const auto hash = text.find('#'); hash != std::string_view::npos) {
        const auto f = can_frame(text.substr(0, hash), text.substr(hash + 1));
        if (!f) return false;
        r.frame = *f;
        if (report) r.frame.kind = Frame::Kind::can_error;
        events.frame(r);
        return true;
    }
    const auto bytes = hex_bytes(text);
    if (!bytes || report) return false;
    for_each_run(*bytes, [&](const Frame& f) {
        r.frame = f;
        events.frame(r);
    });
    return true;
}

/// Seconds with a fraction ("1436509052.249713"), or a date and time of day in UTC ("2026-01-02 03:04:05.678901").
std::optional<std::int64_t> nanoseconds_of(std::string_view stamp) {
    if (stamp.find('-') != std::string_view::npos && stamp.find(':') != std::string_view::npos)
        return parse_time(stamp.ends_with('Z') || stamp.find('+') != std::string_view::npos ? std::string(stamp)
                                                                                            : std::string(stamp) + "Z");
    const auto dot = std::min(stamp.find('.'), stamp.size());
    const auto whole = parse_whole(stamp.substr(0, dot), 0, 9'000'000'000);
    std::string fraction(stamp.substr(std::min(dot + 1, stamp.size())));
    if (!whole || fraction.size() > 9) return std::nullopt;
    fraction.resize(9, '0');
    const auto ns = parse_whole(fraction, 0, 999'999'999);
    if (!ns) return std::nullopt;
    return *whole * 1'000'000'000 + *ns;
}

/// "(...)" at the front, which may contain blanks.
bool take_stamp(std::string_view& rest, RecordedFrame& r) {
    if (!rest.starts_with('(')) return true;
    const auto close = rest.find(')');
    if (close == std::string_view::npos) return false;
    r.stamp = rest.substr(0, close + 1);
    r.at_ns = nanoseconds_of(trimmed(rest.substr(1, close - 1)));
    rest.remove_prefix(close + 1);
    return true;
}

/// `device > AA 05`, `twin < 04280095#01` behind stamp and line: the form of trace_text.
std::optional<bool> read_trace_text(std::string_view rest, RecordedFrame& r, const RecordingEvents& events) {
    const auto side = take_word(rest);
    if (side != "device" && side != "twin") return std::nullopt;
    const auto arrow = take_word(rest);
    if (arrow != ">" && arrow != "<") return false;
    r.to_drive = arrow == ">";
    return read_frames(rest, r, events);
}

bool candump_line(std::string_view line, const RecordingEvents& events) {
    RecordedFrame r;
    if (!take_stamp(line, r)) return false;
    r.line = take_word(line);
    if (r.line.empty()) return false;
    if (const auto done = read_trace_text(line, r, events)) return *done;
    auto id = take_word(line);
    if (id == "TX" || id == "RX") {  // the screen form with -x: direction and two flags
        r.to_drive = id == "TX";
        for (int flag = 0; flag < 2; ++flag) {
            if (take_word(line).size() != 1) return false;
        }
        id = take_word(line);
    }
    std::optional<Frame> f;
    if (const auto hash = id.find('#'); hash != std::string_view::npos) {
        f = can_frame(id.substr(0, hash), id.substr(hash + 1));
        const auto direction = take_word(line);
        if (direction == "T" || direction == "R") r.to_drive = direction == "T";
    } else {
        if (!take_word(line).starts_with('[')) return false;
        line = line.substr(0, line.find('\''));  // -a: the data again as characters
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        f = can_frame(id, line);
    }
    if (!f) return false;
    r.frame = *f;
    events.frame(r);
    return true;
}

bool hex_line(std::string_view line, const RecordingEvents& events) {
    RecordedFrame r;
    if (line.starts_with('(')) {
        if (!take_stamp(line, r)) return false;
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        if (!line.starts_with('>') && !line.starts_with('<') && !hex_bytes(line)) {
            r.line = take_word(line);
            return read_trace_text(line, r, events).value_or(false);
        }
    }
    if (line.starts_with('>') || line.starts_with('<')) {
        r.to_drive = line.front() == '>';
        line.remove_prefix(1);
    }
    const auto bytes = hex_bytes(line);
    if (!bytes) return false;
    for_each_run(*bytes, [&](const Frame& f) {
        r.frame = f;
        events.frame(r);
    });
    return true;
}

std::string_view text_at(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_string() ? std::string_view(v->get_string()) : std::string_view();
}
bool flag_at(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_bool() && v->get_bool();
}

bool trace_entry(const json::value& entry, const RecordingEvents& events) {
    if (!entry.is_object()) return false;
    const auto& o = entry.get_object();
    RecordedFrame r;
    r.stamp = text_at(o, "at");
    r.at_ns = parse_time(r.stamp);
    if (const auto* v = o.if_contains("to_drive"); v && v->is_bool()) r.to_drive = v->get_bool();
    const auto* data_text = o.if_contains("data");
    if (!data_text || !data_text->is_string()) return false;
    const auto data = hex_bytes(text_at(o, "data"));
    if (!data) return false;
    const auto kind = text_at(o, "kind");
    if (kind == "bytes") {
        for_each_run(*data, [&](const Frame& f) {
            r.frame = f;
            events.frame(r);
        });
        return true;
    }
    const auto* id = o.if_contains("id");
    if ((kind != "can" && kind != "can_error") || !id || !id->is_int64() || id->get_int64() < 0 || id->get_int64() > 0x1FFFFFFF ||
        data->size() > 8) {
        return false;
    }
    r.frame.kind = kind == "can" ? Frame::Kind::can : Frame::Kind::can_error;
    r.frame.id = static_cast<std::uint32_t>(id->get_int64());
    r.frame.extended = flag_at(o, "extended");
    r.frame.remote = flag_at(o, "remote");
    r.frame.assign(*data);
    events.frame(r);
    return true;
}

void read_trace(std::string_view text, const RecordingEvents& events) {
    JsonFault unread;
    const auto parsed = read_json(text, unread);
    if (!parsed && unread.twice) return events.fault(unread.line, fmt::format("{} ({}): keep one of them", unread.text, unread.pointer));
    const json::array* list = nullptr;
    if (parsed && parsed->is_array()) list = &parsed->get_array();
    if (parsed && parsed->is_object()) {
        if (const auto* v = parsed->get_object().if_contains("frames"); v && v->is_array()) list = &v->get_array();
    }
    if (!list) return events.fault(0, "this is not a trace: it should be the JSON of GET /api/v1/lines/{name}/trace");
    for (std::size_t i = 0; i < list->size(); ++i) {
        if (!trace_entry((*list)[i], events)) events.fault(i + 1, "not a frame; expected kind, id (null for bytes) and data in hex");
    }
}

void read_capture(std::string_view bytes, const RecordingEvents& events) {
    CaptureEvents capture;
    capture.frame = [&](const CapturedFrame& f) {
        RecordedFrame r;
        r.at_ns = f.at_unix_ns;
        r.stamp = fmt::format("({}.{:06})", f.at_unix_ns / 1'000'000'000, f.at_unix_ns % 1'000'000'000 / 1000);
        r.line = f.interface;
        r.to_drive = f.to_drive;
        r.frame = f.frame;
        events.frame(r);
    };
    capture.fault = events.fault;
    read_pcapng(bytes, capture);
}

void read_flight(std::string_view bytes, const RecordingEvents& events) {
    const Axr axr = read_axr(bytes);
    if (!axr.fault.empty()) return events.fault(0, axr.fault);
    const auto frames = axr.section(axr_frames);
    if (frames.empty()) return events.fault(0, "the recording contains no frames");
    read_capture({frames.data(), frames.size()}, events);
}
}  // namespace

std::optional<RecordingFormat> recording_format_named(std::string_view name) noexcept {
    if (name == "candump") return RecordingFormat::candump;
    if (name == "hex") return RecordingFormat::hex;
    if (name == "trace") return RecordingFormat::trace;
    if (name == "pcapng") return RecordingFormat::pcapng;
    if (name == "axr") return RecordingFormat::axr;
    return std::nullopt;
}

RecordingFormat recording_format_of(std::string_view bytes) noexcept {
    if (is_pcapng(bytes)) return RecordingFormat::pcapng;
    if (bytes.starts_with(axr_magic.substr(0, 4))) return RecordingFormat::axr;
    while (!bytes.empty()) {
        const auto end = std::min(bytes.find('\n'), bytes.size());
        std::string_view line = trimmed(bytes.substr(0, end));
        bytes.remove_prefix(std::min(end + 1, bytes.size()));
        if (line.empty() || line.front() == '#') continue;
        if (line.front() == '[' || line.front() == '{') return RecordingFormat::trace;
        if (line.front() == '(') line.remove_prefix(std::min(line.find(')'), line.size() - 1) + 1);
        line = trimmed(line);
        if (line.empty() || line.front() == '>' || line.front() == '<') return RecordingFormat::hex;
        // The first word of a line of candump is an interface, that of hex bytes is hex.
        return hex_bytes(take_word(line)) ? RecordingFormat::hex : RecordingFormat::candump;
    }
    return RecordingFormat::hex;
}

void read_recording(std::string_view text, RecordingFormat format, const RecordingEvents& events) {
    if (format == RecordingFormat::trace) return read_trace(text, events);
    if (format == RecordingFormat::pcapng) return read_capture(text, events);
    if (format == RecordingFormat::axr) return read_flight(text, events);
    for (std::size_t n = 1; !text.empty(); ++n) {
        const auto end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        line = line.substr(0, line.find_last_not_of(" \t\r") + 1);
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        if (line.empty() || line.front() == '#') continue;
        const bool good = format == RecordingFormat::candump ? candump_line(line, events) : hex_line(line, events);
        if (!good) {
            events.fault(
                n, fmt::format("not a line of format {}: {}", format == RecordingFormat::candump ? "candump" : "hex", line.substr(0, 80)));
        }
    }
}

std::string recording_place(const std::string& file, RecordingFormat format, std::size_t place) {
    if (place == 0) return file;
    const bool lines = format == RecordingFormat::candump || format == RecordingFormat::hex;
    return fmt::format("{}{}{}", file, lines ? ":" : ": frame ", place);
}

}  // namespace axisgate
