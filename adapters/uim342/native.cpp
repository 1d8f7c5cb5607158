// Native: parsing and describing.
// In: what a person typed; messages. Out: messages; words. Names and meanings of bits from the manual's chapters 3.7, 4 and 5.
// Never fails on a strange message: it is described as far as it can be read, and said to be strange.
#include "adapters/uim342/native.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <optional>

#include "adapters/uim342/wire_instructions.hpp"

namespace axisgate::uim342 {
namespace {

std::string_view trimmed(std::string_view s) {
    constexpr std::string_view blank = " \t\r\n";
    const auto first = s.find_first_not_of(blank);
    if (first == std::string_view::npos) return {};
    return s.substr(first, s.find_last_not_of(blank) - first + 1);
}

std::optional<std::int64_t> number(std::string_view s) {
    bool negative = false;
    if (s.starts_with('-') || s.starts_with('+')) {
        negative = s.front() == '-';
        s.remove_prefix(1);
    }
    int base = 10;
    if (s.starts_with("0x") || s.starts_with("0X")) {
        base = 16;
        s.remove_prefix(2);
    }
    if (s.empty() || s.front() == '-' || s.front() == '+') return std::nullopt;
    std::int64_t v = 0;
    const auto [p, ec] = std::from_chars(s.data(), s.data() + s.size(), v, base);
    if (ec != std::errc{} || p != s.data() + s.size()) return std::nullopt;
    return negative ? -v : v;
}

std::string indices_text(const Instruction& i) {
    std::string s;
    for (const auto n : i.indices)
        s += fmt::format("{}{}[{}]", s.empty() ? "" : ", ", i.name, n);
    return s;
}

/// One instruction; on failure `fault` says what is wrong.
std::optional<Message> parse_one(std::uint8_t node, std::string_view text, std::string& fault) {
    const auto equals = text.find('=');
    const std::string_view left = trimmed(text.substr(0, equals));
    const auto open = left.find('[');
    const std::string_view name = trimmed(left.substr(0, open));
    const Instruction* i = instruction_named(name);
    if (!i || i->cw == cw::RT) {
        fault = fmt::format("{} is not an instruction of the UIM342; write for example MO=1, PR, MT[0] or JV=-1000", name);
        return std::nullopt;
    }
    std::uint8_t index = 0;
    if (open != std::string_view::npos) {
        if (!i->indexed) {
            fault = fmt::format("{} has no index", i->name);
            return std::nullopt;
        }
        const auto close = left.find(']', open);
        const auto n = close == left.size() - 1 ? number(trimmed(left.substr(open + 1, close - open - 1))) : std::nullopt;
        if (!n || *n < 0 || *n > 255) {
            fault = fmt::format("the index of {} must be written in brackets, as in {}", i->name, indices_text(*i));
            return std::nullopt;
        }
        index = static_cast<std::uint8_t>(*n);
    } else if (i->indexed) {
        fault = fmt::format("{} needs an index: {}", i->name, indices_text(*i));
        return std::nullopt;
    }
    if (equals == std::string_view::npos) {
        if (i->get_dl >= 0 && i->cw != cw::MF) return make_get(node, *i, index);
        if (i->set_dl >= 0 && i->data == Data::none) return make_set(node, *i, index, 0);
        fault = fmt::format("{} needs a value", i->name);
        return std::nullopt;
    }
    if (i->set_dl < 0) {
        fault = fmt::format("{} can only be read", i->name);
        return std::nullopt;
    }
    if (i->data == Data::none) {
        fault = fmt::format("{} takes no value", i->name);
        return std::nullopt;
    }
    const auto v = number(trimmed(text.substr(equals + 1)));
    const Range r = i->cw == cw::DI ? Range{0, 1} : range_of(i->data);
    if (!v || *v < r.min || *v > r.max) {
        fault = fmt::format("{} takes a whole number {}..{}", name_of_request(i->cw, index), r.min, r.max);
        return std::nullopt;
    }
    return make_set(node, *i, index, *v);
}

std::string_view action_text(std::uint8_t edge) {
    constexpr std::array<std::string_view, 12> names{"none",
                                                     "driver off",
                                                     "emergency stop",
                                                     "stop",
                                                     "origin, then reverse relative move",
                                                     "origin, then emergency stop",
                                                     "origin, then stop",
                                                     "reverse jog",
                                                     "jog",
                                                     "reverse relative move",
                                                     "relative move",
                                                     "absolute move"};
    const std::size_t a = edge & 0x7F;
    return a < names.size() ? names[a] : std::string_view("an action that the manual does not name");
}

std::string edge_text(std::uint8_t edge) {
    // FG = 0 runs the action at power-on as well [L1000].
    return fmt::format("{}{}", action_text(edge), !(edge & 0x80) && (edge & 0x7F) ? " (also at power-on)" : "");
}

std::string status_text(const Message& m) {
    const Status s = status_of(m);
    std::string t = fmt::format("{}, driver {}, {}",
                                s.mode == 0   ? "JOG"
                                : s.mode == 1 ? "PTP"
                                              : "mode unknown",
                                s.on ? "on" : "off", s.stop ? "stationary" : "moving");
    if (s.paif) t += ", in position";
    if (s.tlif) t += ", STALL";
    if (s.lock) t += ", LOCKED";
    if (s.err) t += ", ERROR";
    t += fmt::format(", IN1..3 {}{}{}, OP1 {}, relative position {}", int(s.in1), int(s.in2), int(s.in3), int(s.op1), s.relative_position);
    return t;
}

std::string notification_text(const Message& m) {
    const Notification n = notification_of(m);
    switch (n.kind) {
        case Notification::Kind::alarm: {
            const auto t = alarm_text(n.code);
            return fmt::format("notification: alarm 0x{:02X} ({})", n.code, t.empty() ? "not named by the manual" : t);
        }
        case Notification::Kind::input:
            return fmt::format("notification: IN{} {}", n.input, n.rising ? "rising" : "falling");
        case Notification::Kind::finished:
            return n.has_position ? fmt::format("notification: PTP finished at {}", n.position)
                                  : std::string("notification: PTP finished (too short: no position)");
        case Notification::Kind::unknown:
            break;
    }
    return "notification that the manual does not name: " + hex_of(m);
}

std::string value_text(const Instruction& i, std::uint8_t index, std::int64_t v) {
    switch (i.cw) {
        case cw::MO:
            return fmt::format("{} (driver {})", v, v ? "on" : "off");
        case cw::DV:
            if (index == 0) return fmt::format("{} ({})", v, v == 0 ? "JOG" : v == 1 ? "PTP" : "mode unknown");
            if (index == 1) return fmt::format("{} (desired current {}.{} A)", v, v / 10, v % 10);
            if (index > 4) return fmt::format("{}", v);
            return fmt::format("{} (desired {})", v, index == 2 ? "speed" : index == 3 ? "relative position" : "absolute position");
        case cw::IL:
            if (index == 3) return fmt::format("{} (after a stall: {})", v, v ? "driver off" : "stop and hold");
            return fmt::format("0x{:04X} (falling: {}; rising: {})", v, edge_text(static_cast<std::uint8_t>(v)),
                               edge_text(static_cast<std::uint8_t>(v >> 8)));
        case cw::TG:
            return fmt::format("{} ({})", v, v == 0 ? "continuous" : v <= 60000 ? "low pass, ms" : v == 60001 ? "one time" : "not allowed");
        case cw::DI:
            return fmt::format("IN1..3 {}{}{}, OP1 {}", v & 1, v >> 1 & 1, v >> 2 & 1, v >> 8 & 1);
        default:
            return fmt::format("{}", v);
    }
}

}  // namespace

NativeScript parse_native(std::uint8_t node, std::string_view text) {
    NativeScript s;
    while (true) {
        const auto end = text.find(';');
        const std::string_view one = trimmed(text.substr(0, end));
        if (!one.empty()) {
            if (s.messages.size() == native_limit) {
                s.fault = fmt::format("at most {} instructions in one line", native_limit);
                return s;
            }
            const auto m = parse_one(node, one, s.fault);
            if (!m) return s;
            s.messages.push_back(*m);
        }
        if (end == std::string_view::npos) break;
        text.remove_prefix(end + 1);
    }
    if (s.messages.empty()) s.fault = "nothing to send; write for example MO=1, PR, MT[0] or JV=-1000";
    return s;
}

NativeScript parse_native(std::uint8_t node, std::span<const std::uint8_t> bytes) {
    NativeScript s;
    const std::size_t all = bytes.size();
    while (!bytes.empty()) {
        if (s.messages.size() == native_limit) {
            s.fault = fmt::format("at most {} messages at once", native_limit);
            return s;
        }
        if (bytes.size() < 2 || bytes[1] > 8 || bytes.size() < 2u + bytes[1]) {
            const std::size_t place = all - bytes.size() + 1;
            const std::string what =
                bytes.size() < 2 ? fmt::format("byte {} (0x{:02X}) is a CW without its DL", place, bytes[0])
                : bytes[1] > 8   ? fmt::format("byte {} is 0x{:02X}, which is no DL", place + 1, bytes[1])
                                 : fmt::format("byte {} announces {} data bytes, and {} follow", place + 1, bytes[1], bytes.size() - 2);
            s.fault = what + ": a message is CW, DL (0..8) and exactly DL data bytes";
            return s;
        }
        s.messages.push_back(message(node, bytes[0], bytes.subspan(2, bytes[1])));
        bytes = bytes.subspan(2u + bytes[1]);
    }
    if (s.messages.empty()) s.fault = "nothing to send; a message is CW, DL (0..8) and DL data bytes";
    return s;
}

std::string name_of_request(std::uint8_t cw, std::uint8_t index) {
    const Instruction* i = instruction(cw);
    if (!i) return fmt::format("CW {:02X}", cw & 0x7F);
    return i->indexed ? fmt::format("{}[{}]", i->name, index) : std::string(i->name);
}

std::string hex_of(const Message& m) {
    return fmt::format("{:02X} {:02X}{}{:02X}", m.cw, m.dl, m.dl == 0 ? "" : " ", fmt::join(m.data(), " "));
}

std::string describe_error(std::uint8_t code) { return fmt::format("0x{:02X} ({})", code, error_text(code)); }

std::string describe_request(const Message& m) {
    const Instruction* i = instruction(m.cw);
    if (!i) return fmt::format("unknown control word: {}", hex_of(m));
    std::string s;
    switch (form_of(m)) {
        case Form::unknown:
            return fmt::format("{} with a data length that the manual does not have: {}", i->name, hex_of(m));
        case Form::get:
            s = name_of_request(m.cw, m.d[0]);
            break;
        case Form::set: {
            s = name_of_request(m.cw, m.d[0]);
            if (i->cw == cw::SY) {
                s += m.d[0] == 1 ? " (reboot)" : m.d[0] == 2 ? " (factory defaults)" : " (not named by the manual)";
            } else if (i->cw == cw::DI) {
                s += fmt::format("={}", m.d[0] & 1);
                if (m.d[1] != 1) s += fmt::format(" (d1 is {:02X}, not 01)", m.d[1]);
            } else if (i->cw == cw::ER || i->cw == cw::MS) {
                s += fmt::format("={}", m.d[1]);
            } else if (i->data != Data::none) {
                Message whole = m;  // short data words are zero-extended (erratum E-10)
                whole.dl = 8;
                for (std::uint8_t k = m.dl; k < 8; ++k)
                    whole.d[k] = 0;
                const std::int64_t v = value_of(m, whole).value_or(0);
                s += i->cw == cw::IL || i->cw == cw::TG ? "=" + value_text(*i, m.d[0], v) : fmt::format("={}", v);
                if (m.dl < i->set_dl) s += fmt::format(" ({} data bytes, zero-extended)", m.dl);
            }
            break;
        }
    }
    if (!m.wants_ack() && i->cw != cw::SY) s += " (no acknowledgement)";
    return s;
}

std::string describe_answer(const Message& m) {
    if (m.cw & ack_bit) return fmt::format("not an answer, bit 7 of the control word is set: {}", hex_of(m));
    const Instruction* i = instruction(m.cw);
    if (!i) return fmt::format("unknown control word: {}", hex_of(m));
    const auto strange = [&] { return fmt::format("{} of a length that the manual does not have: {}", i->name, hex_of(m)); };
    switch (i->cw) {
        case cw::RT:
            return notification_text(m);
        case cw::ER: {
            const auto r = error_report_of(m);
            if (!r) return strange();
            if (r->code == 0) return fmt::format("ER[{}] = no error", r->slot);
            const std::string about = name_of_request(r->cw, r->index);
            if (r->slot == 0) return fmt::format("error {} about {}", describe_error(r->code), about);
            return fmt::format("ER[{}] = {} about {}", r->slot, describe_error(r->code), about);
        }
        case cw::ML: {
            if (m.dl < 6) return strange();
            const Model model = model_of(m);
            return fmt::format("ML = {}, firmware {} ({})", model.name.empty() ? "a model that the manual does not have" : model.name,
                               get_u16(&m.d[4]), hex_of(m).substr(6));  // the data alone
        }
        case cw::SN:
            if (m.dl < 8) return strange();
            return fmt::format("SN = {}, manufacturer {}, vendor {}", get_u32(m.d.data()), get_u16(&m.d[4]), get_u16(&m.d[6]));
        case cw::MS:
            if (m.dl < 8 || m.d[0] > 1) return strange();
            if (m.d[0] == 0) return "MS[0] = " + status_text(m);
            return fmt::format("MS[1] = speed {}, position {}", get_i24(&m.d[1]), get_i32(&m.d[4]));
        case cw::BG:
            return "BG done";
        case cw::ST:
            return "ST done";
        case cw::OG:
            return "OG done";
        default:
            break;
    }
    const std::uint8_t index = i->indexed && m.dl > 0 ? m.d[0] : 0;
    Message request;
    request.cw = i->cw;
    const auto v = value_of(request, m);
    if (!v) return strange();
    return fmt::format("{} = {}", name_of_request(i->cw, index), value_text(*i, index, *v));
}

}  // namespace axisgate::uim342
