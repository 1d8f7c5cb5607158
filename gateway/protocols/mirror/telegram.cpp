// Telegrams of a mirror line: their words, order and check (Fletcher's 16-bit checksum over all bytes before the '*').
// A number must be the whole word: trailing characters make the telegram invalid.
#include "gateway/protocols/mirror/telegram.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <charconv>

namespace axisgate::mirror {
namespace {
constexpr std::size_t tail = 6;  // "*HHHH\n"

std::uint16_t check_of(std::string_view text) {
    unsigned a = 0, b = 0;
    for (const char c : text) {
        a = (a + static_cast<unsigned char>(c)) % 255;
        b = (b + a) % 255;
    }
    return static_cast<std::uint16_t>(b << 8 | a);
}

template <class N>
std::optional<N> number(std::string_view text, int base = 10) {
    N n{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n, base);
    return !text.empty() && error == std::errc{} && end == text.data() + text.size() ? std::optional(n) : std::nullopt;
}

/// Returns the next word; the rest begins after one space.
std::string_view word(std::string_view& rest) {
    const auto space = rest.find(' ');
    const std::string_view w = rest.substr(0, space);
    rest = space == rest.npos ? std::string_view() : rest.substr(space + 1);
    return w;
}
template <class E>
std::optional<E> named(std::string_view name, E last) {
    for (int i = 0; i <= static_cast<int>(last); ++i) {
        if (name_of(static_cast<E>(i)) == name) return static_cast<E>(i);
    }
    return std::nullopt;
}
bool is_name(std::string_view s) {
    return !s.empty() && s.size() <= 63 && std::ranges::all_of(s, [](char c) { return c > ' ' && c != '\x7f' && c != '/'; });
}
}  // namespace

std::string check_address(std::string_view address) {
    const auto slash = address.find('/');
    if (slash != address.npos && is_name(address.substr(0, slash)) && is_name(address.substr(slash + 1))) return {};
    return "an axis of another gateway is named GATEWAY/AXIS, as the fleet lists them: hall-2/feeder";
}

std::string text_of(const Telegram& t) {
    std::string s = fmt::format("{}{} {} {}", static_cast<char>(t.kind), t.number, t.address, t.body);
    s.resize(std::min(s.size(), longest - tail));
    for (char& c : s) {
        if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') c = ' ';
    }
    return s + fmt::format("*{:04X}\n", check_of(s));
}

std::optional<Telegram> telegram_of(std::string_view line) {
    if (line.size() < tail || line[line.size() - 5] != '*') return std::nullopt;
    const auto check = number<std::uint16_t>(line.substr(line.size() - 4), 16);
    line.remove_suffix(5);
    if (!check || *check != check_of(line)) return std::nullopt;
    Telegram t;
    t.kind = static_cast<Telegram::Kind>(line[0]);
    if (std::string_view("?!=-").find(line[0]) == std::string_view::npos) return std::nullopt;
    line.remove_prefix(1);
    const auto n = number<std::uint64_t>(word(line));
    t.address = word(line);
    t.body = line;
    if (!n || !check_address(t.address).empty()) return std::nullopt;
    t.number = *n;
    return t;
}

std::string body_of(const Order& o) {
    std::string s = o.verb;
    if (!o.name.empty()) s += " name=" + o.name;
    const auto put = [&s](const char* key, const std::optional<std::int64_t>& v) {
        if (v) s += fmt::format(" {}={}", key, *v);
    };
    put("p", o.position);
    put("v", o.velocity);
    put("a", o.acceleration);
    put("d", o.deceleration);
    put("method", o.method);
    put("hold", o.hold_ms);
    if (o.renew) s += " renew=1";
    if (o.wait_ms != 0) s += fmt::format(" wait={}", o.wait_ms);
    return s;
}

std::optional<Order> order_of(std::string_view body) {
    Order o;
    o.verb = word(body);
    while (!body.empty()) {
        const std::string_view item = word(body);
        const auto equals = item.find('=');
        if (equals == item.npos) return std::nullopt;
        const std::string_view key = item.substr(0, equals), text = item.substr(equals + 1);
        if (key == "name") {
            o.name = text;
            continue;
        }
        const auto n = number<std::int64_t>(text);
        if (!n) return std::nullopt;
        if (key == "renew") {
            o.renew = *n != 0;
        } else if (key == "wait") {
            o.wait_ms = *n;
        } else {
            auto* place = key == "p"        ? &o.position
                          : key == "v"      ? &o.velocity
                          : key == "a"      ? &o.acceleration
                          : key == "d"      ? &o.deceleration
                          : key == "method" ? &o.method
                          : key == "hold"   ? &o.hold_ms
                                            : nullptr;
            if (!place) return std::nullopt;
            *place = *n;
        }
    }
    return o.verb.empty() ? std::nullopt : std::optional(std::move(o));
}

std::string body_of(const Answer& a) { return fmt::format("{} {} {} {}", name_of(a.outcome), name_of(a.reason), a.code, a.text); }

std::optional<Answer> answer_of(std::string_view body) {
    const auto outcome = named(word(body), Outcome::failed);
    const auto reason = named(word(body), Reason::internal);
    const auto code = number<std::int32_t>(word(body));
    if (!outcome || !reason || !code) return std::nullopt;
    return Answer{*outcome, *reason, *code, std::string(body)};
}

std::string body_of(const State& s) {
    unsigned flags = 0, bit = 1;
    for (const bool f : {s.simulated, s.stale, s.referenced, s.moving, s.target_reached, s.fault, s.warning}) {
        flags |= f ? bit : 0;
        bit <<= 1;
    }
    return fmt::format("{:02X} {:04X} {} {} {} {} {} {} {}", flags, s.statusword, s.mode, s.position, s.demand, name_of(s.demand_source),
                       s.velocity, s.error_code, s.age_ms);
}

std::optional<State> state_of(std::string_view body) {
    State s;
    const auto flags = number<unsigned>(word(body), 16);
    const auto statusword = number<std::uint16_t>(word(body), 16);
    const auto mode = number<std::int16_t>(word(body));
    const auto position = number<std::int64_t>(word(body)), demand = number<std::int64_t>(word(body));
    const auto source = named(word(body), DemandSource::open_loop);
    const auto velocity = number<std::int64_t>(word(body));
    const auto error = number<std::uint16_t>(word(body));
    const auto age = number<std::int64_t>(word(body));
    if (!flags || !statusword || !mode || !position || !demand || !source || !velocity || !error || !age || *age < 0) return std::nullopt;
    unsigned bit = 1;
    for (bool* f : {&s.simulated, &s.stale, &s.referenced, &s.moving, &s.target_reached, &s.fault, &s.warning}) {
        *f = (*flags & bit) != 0;
        bit <<= 1;
    }
    s.statusword = *statusword;
    s.mode = *mode;
    s.position = *position;
    s.demand = *demand;
    s.demand_source = *source;
    s.velocity = *velocity;
    s.error_code = *error;
    s.age_ms = *age;
    return s;
}

}  // namespace axisgate::mirror
