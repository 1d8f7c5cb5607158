#include "adapters/linmot/wire.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::linmot {
namespace {
constexpr std::uint8_t data_byte = 0x02;
constexpr std::size_t shortest = 2, longest = 63;  // of the length byte

constexpr std::uint8_t reverse8(std::uint8_t b) {
    b = static_cast<std::uint8_t>((b & 0xF0) >> 4 | (b & 0x0F) << 4);
    b = static_cast<std::uint8_t>((b & 0xCC) >> 2 | (b & 0x33) << 2);
    return static_cast<std::uint8_t>((b & 0xAA) >> 1 | (b & 0x55) << 1);
}
constexpr std::uint16_t reverse16(std::uint16_t w) {
    return static_cast<std::uint16_t>(reverse8(static_cast<std::uint8_t>(w)) << 8 | reverse8(static_cast<std::uint8_t>(w >> 8)));
}
}  // namespace

std::uint16_t checksum(std::span<const std::uint8_t> telegram, const ChecksumRule& rule) noexcept {
    const auto bytes = telegram.subspan(std::min<std::size_t>(rule.from, telegram.size()));
    if (rule.kind == ChecksumRule::Kind::sum) {
        std::uint32_t sum = 0;
        for (const auto b : bytes)
            sum += b;
        return static_cast<std::uint16_t>(sum);
    }
    const bool reflected = rule.kind == ChecksumRule::Kind::crc_reflected;
    std::uint16_t crc = reflected ? reverse16(rule.start) : rule.start;
    for (const auto b : bytes) {
        crc = static_cast<std::uint16_t>(crc ^ (reflected ? reverse8(b) : b) << 8);
        for (int i = 0; i < 8; ++i)
            crc = static_cast<std::uint16_t>(crc & 0x8000 ? crc << 1 ^ 0x1021 : crc << 1);
    }
    return reflected ? reverse16(crc) : crc;
}

std::uint16_t Telegram::u16(std::size_t at) const noexcept {
    const auto byte = [&](std::size_t i) { return i < size ? storage[i] : std::uint8_t{0}; };
    return static_cast<std::uint16_t>(byte(at) | byte(at + 1) << 8);
}
bool Telegram::operator==(const Telegram& o) const noexcept {
    return id == o.id && sub == o.sub && main == o.main && std::ranges::equal(data(), o.data());
}

std::vector<std::uint8_t> pack(const Telegram& t, const ChecksumRule& rule) {
    std::vector<std::uint8_t> bytes{start_byte, t.id, static_cast<std::uint8_t>(t.size + 3), data_byte, t.sub, t.main};
    bytes.insert(bytes.end(), t.data().begin(), t.data().end());
    if (rule.size() != 0) {
        const std::uint16_t sum = checksum(bytes, rule);
        bytes.push_back(static_cast<std::uint8_t>(sum));
        bytes.push_back(static_cast<std::uint8_t>(sum >> 8));
    }
    bytes.push_back(end_byte);
    return bytes;
}

void Framer::push(std::span<const std::uint8_t> bytes, const OnTelegram& telegram, const OnJunk& junk) {
    held_.insert(held_.end(), bytes.begin(), bytes.end());
    look(telegram, junk);
}

void Framer::reset(const OnJunk& junk) {
    if (!held_.empty() && junk) junk(held_, "a telegram that does not end");
    held_.clear();
}

void Framer::look(const OnTelegram& telegram, const OnJunk& junk) {
    std::size_t at = 0;
    const std::span<const std::uint8_t> all(held_);
    const auto drop = [&](std::size_t n, std::string_view why) {
        if (junk) junk(all.subspan(at, n), why);
        at += n;
    };
    while (at < all.size()) {
        const auto rest = all.subspan(at);
        if (rest[0] != start_byte) {
            std::size_t n = 1;
            while (n < rest.size() && rest[n] != start_byte)
                ++n;
            drop(n, "no telegram begins here");
            continue;
        }
        if (rest.size() < 4) {
            if (rest.size() == 3 && (rest[2] < shortest || rest[2] > longest)) {
                drop(1, "no telegram has that length");
                continue;
            }
            break;
        }
        const std::size_t length = rest[2];
        if (length < shortest || length > longest || rest[3] != data_byte) {
            drop(1, length < shortest || length > longest ? "no telegram has that length" : "the data start is missing");
            continue;
        }
        const std::size_t whole = length + 4 + rule_.size();
        if (rest.size() < whole) break;
        if (rest[whole - 1] != end_byte) {
            drop(1, "the telegram end is not where the length says");
            continue;
        }
        const std::size_t data_end = length + 3;
        if (rule_.size() != 0) {
            const auto sum = static_cast<std::uint16_t>(rest[data_end] | rest[data_end + 1] << 8);
            if (sum != checksum(rest.first(data_end), rule_)) {
                drop(1, "the checksum is wrong");
                continue;
            }
        }
        Telegram t;
        t.id = rest[1];
        t.sub = rest[4];
        t.main = length > 2 ? rest[5] : std::uint8_t{0};
        for (std::size_t i = 6; i < data_end; ++i)
            t.add(rest[i]);
        telegram(t, rest.first(whole));
        at += whole;
    }
    held_.erase(held_.begin(), held_.begin() + static_cast<std::ptrdiff_t>(at));
}

Telegram request(std::uint8_t id, Main main, std::uint8_t sub) {
    Telegram t;
    t.id = id;
    t.sub = sub;
    t.main = static_cast<std::uint8_t>(main);
    return t;
}
Telegram request16(std::uint8_t id, Main main, std::uint8_t sub, std::uint16_t value) {
    Telegram t = request(id, main, sub);
    t.add16(value);
    return t;
}
Telegram request48(std::uint8_t id, Main main, std::uint8_t sub, std::uint16_t index, std::uint32_t value) {
    Telegram t = request16(id, main, sub, index);
    t.add32(value);
    return t;
}

std::optional<Status> status_of(const Telegram& t, std::size_t base) noexcept {
    if (t.main != 0 || t.size < base) return std::nullopt;
    const bool placed = base >= default_size;
    return Status{t.storage[0], t.u16(1), t.u16(3), placed ? static_cast<std::int32_t>(t.u32(5)) : 0, placed};
}
std::optional<ConfigAnswer> config_of(const Telegram& t) noexcept {
    if (t.main != 0 || t.size != 7) return std::nullopt;
    return ConfigAnswer{t.sub, t.storage[0], t.u16(1), t.u32(3)};
}

std::string communication_text(std::uint8_t code) {
    switch (code) {
        case 0x00:
            return "ok";
        case 0x02:
            return "a command is running";
        case 0x04:
            return "the block is not finished";
        case 0x05:
            return "busy";
        case 0xC0:
            return "no such parameter";
        case 0xC1:
            return "wrong parameter type";
        case 0xC2:
            return "outside the range";
        case 0xC3:
            return "the parameter cannot be used that way";
        case 0xC5:
            return "a list was not started";
        case 0xC6:
            return "end of the list";
        case 0xD0:
            return "odd address";
        case 0xD1:
            return "wrong size";
        case 0xD4:
            return "it is there already, or it is missing";
        case 0xD7:
            return "the motion control software is not stopped";
        default:
            return fmt::format("code {:02X}h", code);
    }
}
std::string_view type_name(std::uint8_t code) noexcept {
    static constexpr std::array<std::string_view, 16> names{
        "BOOL",   "UINT8",   "SINT8",         "UINT16",      "SINT16",    "UINT32",     "SINT32",    "LIN_FLOAT",
        "STRING", "CAP_DIR", "RADIO_DIR_BIT", "RADIO_DIR16", "ENUM_DIR8", "ENUM_DIR16", "STRINGLET", "CAP_DIRLET"};
    return code < names.size() ? names[code] : "?";
}

}  // namespace axisgate::linmot
