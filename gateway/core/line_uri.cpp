// Reads scheme, place and options of a line, or reports a fault with an example. An unknown option is refused, because a typing error would
// otherwise be found on the machine.
#include "gateway/core/line_uri.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <set>

#include "gateway/core/text.hpp"

namespace axisgate {
namespace {

constexpr std::size_t max_length = 1024;

constexpr std::string_view can_example = "can:can0";
constexpr std::string_view serial_example = "serial:/dev/ttyUSB0?baud=9600&format=8N1";
constexpr std::string_view pty_example = "pty:/tmp/drive";
constexpr std::string_view paced_example = "pty:/tmp/drive?baud=9600&format=8N1";

LineUriResult fault(std::string what, std::string_view example) {
    LineUriResult r;
    r.fault = fmt::format("{}; right is for example {}", what, example);
    return r;
}

std::optional<std::uint32_t> number(std::string_view text) noexcept {
    std::uint32_t v = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), v);
    if (text.empty() || error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
    return v;
}

bool is_letter_or_digit(char c) noexcept { return is_letter(c) || is_digit(c); }

/// The fault in a host name, or an empty text.
std::string host_fault(std::string_view host, bool bracketed) {
    if (host.empty()) return "the host is missing";
    if (host.size() > 253) return "the host's name is longer than 253 characters";
    const std::string_view extra = bracketed ? ":.%-_" : ".-_";
    for (const char c : host) {
        if (is_letter_or_digit(c) || extra.find(c) != std::string_view::npos) continue;
        return fmt::format("a host's name has no '{}'", c);
    }
    if (bracketed && host.find(':') == std::string_view::npos) return "square brackets are for IPv6 addresses alone";
    return {};
}

LineUriResult parse_endpoint(std::string_view scheme, std::string_view rest, LineUri::Kind kind) {
    const bool listen = kind == LineUri::Kind::tcp_listen || kind == LineUri::Kind::udp_listen;
    const std::string example = fmt::format("{}:{}", scheme, listen ? "127.0.0.1:4001" : "192.168.1.50:503");
    const std::string v6_example = fmt::format("{}:{}", scheme, listen ? "[::1]:4001" : "[::1]:503");
    if (rest.find('?') != std::string_view::npos) return fault("a TCP or UDP line takes no options", example);
    std::string_view host, port;
    const bool bracketed = rest.starts_with('[');
    if (bracketed) {
        const auto close = rest.find(']');
        if (close == std::string_view::npos || close + 1 >= rest.size() || rest[close + 1] != ':') {
            return fault("an IPv6 address is written [ADDRESS]:PORT", v6_example);
        }
        host = rest.substr(1, close - 1);
        port = rest.substr(close + 2);
    } else {
        const auto colon = rest.rfind(':');
        if (colon == std::string_view::npos) return fault("the port is missing", example);
        host = rest.substr(0, colon);
        port = rest.substr(colon + 1);
        if (host.find(':') != std::string_view::npos) {
            return fault("an IPv6 address is written in square brackets", v6_example);
        }
    }
    if (const std::string wrong = host_fault(host, bracketed); !wrong.empty()) return fault(wrong, example);
    const auto value = number(port);
    if (!value || *value > 65535 || (*value == 0 && !listen)) {
        return fault(fmt::format("\"{}\" is not a port ({}..65535)", port, listen ? 0 : 1), example);
    }
    LineUriResult r;
    r.uri.kind = kind;
    r.uri.host = host;
    r.uri.port = static_cast<std::uint16_t>(*value);
    return r;
}

LineUriResult parse_can(std::string_view rest) {
    if (rest.find('?') != std::string_view::npos)
        return fault("a CAN line takes no options: its bit rate is set where the interface is", can_example);
    // The rules of the kernel for an interface's name.
    const bool bad = rest.empty() || rest.size() > 15 || rest == "." || rest == ".." ||
                     std::ranges::any_of(rest, [](char c) { return c <= ' ' || c == '/' || c == ':' || c == '\x7f'; });
    if (bad)
        return fault(fmt::format("\"{}\" is not the name of a network interface (1..15 characters, no space, '/' or ':')", rest),
                     can_example);
    LineUriResult r;
    r.uri.kind = LineUri::Kind::can;
    r.uri.interface = rest;
    return r;
}

/// One `key=value` of a serial line; empty if it is correct.
std::string set_serial(SerialSettings& s, std::string_view key, std::string_view value) {
    const auto flag = [&](bool& to) -> std::string {
        if (value != "0" && value != "1") return fmt::format("{} is 0 or 1, not \"{}\"", key, value);
        to = value == "1";
        return {};
    };
    const auto delay = [&](std::uint8_t& to) -> std::string {
        const auto v = number(value);
        if (!v || *v > SerialSettings::max_rts_ms)
            return fmt::format("{} is a number of milliseconds, 0..{}, not \"{}\"", key, SerialSettings::max_rts_ms, value);
        to = static_cast<std::uint8_t>(*v);
        return {};
    };
    if (key == "baud") {
        const auto v = number(value);
        if (!v || *v < SerialSettings::min_baud || *v > SerialSettings::max_baud) {
            return fmt::format("baud is a number of bit/s, {}..{}, not \"{}\"", SerialSettings::min_baud, SerialSettings::max_baud, value);
        }
        s.baud = *v;
        return {};
    }
    if (key == "format") {
        const auto f = parse_serial_format(value);
        if (!f) return fmt::format("format is data bits (7, 8), parity (N, E, O) and stop bits (1, 2), not \"{}\"", value);
        s.format = *f;
        return {};
    }
    if (key == "rs485") {
        if (value != "0" && value != "1" && value != "auto") return fmt::format("rs485 is 0, 1 or auto, not \"{}\"", value);
        s.rs485 = value == "0" ? Rs485::off : value == "1" ? Rs485::on : Rs485::automatic;
        return {};
    }
    if (key == "rts_before_ms") return delay(s.rts_before_ms);
    if (key == "rts_after_ms") return delay(s.rts_after_ms);
    if (key == "rtscts") return flag(s.rtscts);
    return fmt::format("a serial line has no option \"{}\" (it has baud, format, rs485, rts_before_ms, rts_after_ms, rtscts)", key);
}

/// The `key=value&key=value` after the question mark; the fault, or an empty text.
template <class Set>
std::string read_options(std::string_view options, std::set<std::string_view>& seen, const Set& set) {
    for (;;) {
        const auto amp = options.find('&');
        const std::string_view item = options.substr(0, amp);
        const auto equals = item.find('=');
        if (equals == std::string_view::npos || equals == 0) return fmt::format("\"{}\" is not of the form option=value", item);
        const std::string_view key = item.substr(0, equals);
        if (!seen.insert(key).second) return fmt::format("{} is said twice", key);
        if (std::string wrong = set(key, item.substr(equals + 1)); !wrong.empty()) return wrong;
        if (amp == std::string_view::npos) return {};
        options.remove_prefix(amp + 1);
    }
}

LineUriResult parse_serial(std::string_view rest, std::uint32_t default_baud, std::string_view default_format) {
    LineUriResult r;
    r.uri.kind = LineUri::Kind::serial;
    if (default_baud != 0) r.uri.serial.baud = default_baud;
    if (const auto f = parse_serial_format(default_format)) r.uri.serial.format = *f;

    const auto question = rest.find('?');
    const std::string_view path = rest.substr(0, question);
    if (!path.starts_with('/') || path.size() < 2)
        return fault(fmt::format("\"{}\" is not the whole path of a serial port", path), serial_example);
    r.uri.path = path;
    if (question == std::string_view::npos) return r;

    std::set<std::string_view> seen;
    const auto set = [&](std::string_view key, std::string_view value) { return set_serial(r.uri.serial, key, value); };
    if (const std::string wrong = read_options(rest.substr(question + 1), seen, set); !wrong.empty()) return fault(wrong, serial_example);
    const SerialSettings& s = r.uri.serial;
    if (s.rs485 == Rs485::off && (seen.contains("rts_before_ms") || seen.contains("rts_after_ms"))) {
        return fault("rts_before_ms and rts_after_ms are for RS-485 alone", "serial:/dev/ttyS1?rs485=1&rts_after_ms=1");
    }
    if (s.rs485 != Rs485::off && s.rtscts) {
        return fault("rtscts=1 and rs485 both need the RTS line: use one of them", "serial:/dev/ttyS1?rs485=1");
    }
    return r;
}

LineUriResult parse_pty(std::string_view rest, std::string_view default_format) {
    const auto question = rest.find('?');
    const std::string_view path = rest.substr(0, question);
    if (path.empty() || path.ends_with('/')) return fault("the path of the link to the pseudo-terminal is missing", pty_example);
    LineUriResult r;
    r.uri.kind = LineUri::Kind::pty;
    r.uri.path = path;
    r.uri.serial.baud = 0;
    if (question == std::string_view::npos) return r;
    if (const auto f = parse_serial_format(default_format)) r.uri.serial.format = *f;
    std::set<std::string_view> seen;
    const auto set = [&](std::string_view key, std::string_view value) -> std::string {
        if (key != "baud" && key != "format")
            return fmt::format("a pseudo-terminal has no option \"{}\" (it has baud and format, the pace of its bytes)", key);
        return set_serial(r.uri.serial, key, value);
    };
    if (const std::string wrong = read_options(rest.substr(question + 1), seen, set); !wrong.empty()) return fault(wrong, paced_example);
    if (r.uri.serial.baud == 0) return fault("a pseudo-terminal has a format only together with baud", paced_example);
    return r;
}

}  // namespace

std::optional<SerialFormat> parse_serial_format(std::string_view text) noexcept {
    if (text.size() != 3) return std::nullopt;
    SerialFormat f;
    if (text[0] != '7' && text[0] != '8') return std::nullopt;
    if (text[2] != '1' && text[2] != '2') return std::nullopt;
    f.data_bits = static_cast<std::uint8_t>(text[0] - '0');
    f.stop_bits = static_cast<std::uint8_t>(text[2] - '0');
    switch (text[1]) {
        case 'N':
        case 'n':
            f.parity = Parity::none;
            return f;
        case 'E':
        case 'e':
            f.parity = Parity::even;
            return f;
        case 'O':
        case 'o':
            f.parity = Parity::odd;
            return f;
        default:
            return std::nullopt;
    }
}

std::string to_text(const SerialFormat& f) {
    const char parity = f.parity == Parity::none ? 'N' : f.parity == Parity::even ? 'E' : 'O';
    return fmt::format("{}{}{}", f.data_bits, parity, f.stop_bits);
}

LineUriResult parse_line_uri(std::string_view text, std::uint32_t default_baud, std::string_view default_format) {
    constexpr std::string_view any_example =
        "can:can0, serial:/dev/ttyUSB0?baud=9600&format=8N1, tcp:HOST:PORT, tcp-listen:HOST:PORT, udp:HOST:PORT, "
        "udp-listen:HOST:PORT, pty:PATH, dds or twin";
    if (text.empty()) return fault("the line URI is empty", any_example);
    if (text.size() > max_length) return fault(fmt::format("the line URI is longer than {} characters", max_length), any_example);
    if (std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; })) {
        return fault("the line URI holds a control character", any_example);
    }
    if (text == "twin") return {};
    if (text == "dds") {
        LineUriResult r;
        r.uri.kind = LineUri::Kind::dds;
        return r;
    }
    const auto colon = text.find(':');
    const std::string_view scheme = text.substr(0, colon);
    if (colon != std::string_view::npos) {
        const std::string_view rest = text.substr(colon + 1);
        if (scheme == "can") return parse_can(rest);
        if (scheme == "serial") return parse_serial(rest, default_baud, default_format);
        if (scheme == "tcp") return parse_endpoint(scheme, rest, LineUri::Kind::tcp);
        if (scheme == "tcp-listen") return parse_endpoint(scheme, rest, LineUri::Kind::tcp_listen);
        if (scheme == "udp") return parse_endpoint(scheme, rest, LineUri::Kind::udp);
        if (scheme == "udp-listen") return parse_endpoint(scheme, rest, LineUri::Kind::udp_listen);
        if (scheme == "pty") return parse_pty(rest, default_format);
        if (scheme == "twin") return fault("twin stands alone", "twin");
        if (scheme == "dds") return fault("dds stands alone: the drives' addresses say which gateway, hall-2/feeder", "dds");
    }
    return fault(fmt::format("\"{}\" is not a kind of line", scheme), any_example);
}

std::string to_text(const LineUri& u) {
    const std::string endpoint =
        u.host.find(':') == std::string::npos ? fmt::format("{}:{}", u.host, u.port) : fmt::format("[{}]:{}", u.host, u.port);
    switch (u.kind) {
        case LineUri::Kind::can:
            return "can:" + u.interface;
        case LineUri::Kind::tcp:
            return "tcp:" + endpoint;
        case LineUri::Kind::tcp_listen:
            return "tcp-listen:" + endpoint;
        case LineUri::Kind::udp:
            return "udp:" + endpoint;
        case LineUri::Kind::udp_listen:
            return "udp-listen:" + endpoint;
        case LineUri::Kind::pty:
            if (u.serial.baud == 0) return "pty:" + u.path;
            return fmt::format("pty:{}?baud={}&format={}", u.path, u.serial.baud, to_text(u.serial.format));
        case LineUri::Kind::twin:
            return "twin";
        case LineUri::Kind::dds:
            return "dds";
        case LineUri::Kind::serial:
            break;
    }
    const SerialSettings& s = u.serial;
    std::string t = fmt::format("serial:{}?baud={}&format={}", u.path, s.baud, to_text(s.format));
    if (s.rs485 != Rs485::off) {
        t += s.rs485 == Rs485::on ? "&rs485=1" : "&rs485=auto";
        if (s.rts_before_ms != 0) t += fmt::format("&rts_before_ms={}", s.rts_before_ms);
        if (s.rts_after_ms != 0) t += fmt::format("&rts_after_ms={}", s.rts_after_ms);
    }
    if (s.rtscts) t += "&rtscts=1";
    return t;
}

}  // namespace axisgate
