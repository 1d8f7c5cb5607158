// LinRS pages: entry of 64 bytes, info block of 70 bytes, points of 4 bytes.
#include "adapters/linmot/parameters_tables.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

#include "gateway/core/command_arguments.hpp"
#include "gateway/core/text.hpp"

namespace axisgate::linmot {
namespace {
using Bytes = std::vector<std::uint8_t>;
constexpr std::uint16_t entry_version = 0xA701, no_entry = 0xFFFF, most_entry = 255;
constexpr std::size_t header_at = 4, parameters_end = 38, name_at = 38, name_size = 15, curve_name_at = 8, curve_name_size = 21;
constexpr double mm_per_count = 0.0001, seconds_per_tick = 1e-5;

std::uint32_t at(std::span<const std::uint8_t> b, std::size_t i, std::size_t n) {
    std::uint32_t v = 0;
    for (std::size_t k = 0; k < n && i + k < b.size(); ++k)
        v |= std::uint32_t{b[i + k]} << 8 * k;
    return v;
}
void put(Bytes& b, std::size_t i, std::uint32_t v, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k)
        b[i + k] = static_cast<std::uint8_t>(v >> 8 * k);
}
std::optional<Bytes> unhex(std::string_view s, std::size_t bytes) {
    auto b = from_hex(s);
    return s.size() == 2 * bytes && b && b->size() == bytes ? b : std::nullopt;
}
std::string_view trimmed(std::string_view s) {
    const auto begin = s.find_first_not_of(" \t\r\n");
    if (begin == std::string_view::npos) return {};
    return s.substr(begin, s.find_last_not_of(" \t\r\n") - begin + 1);
}
std::string name_of(std::span<const std::uint8_t> b, std::size_t i, std::size_t n) {
    std::string s;
    for (; s.size() < n && i < b.size() && b[i] != 0; ++i)
        s += static_cast<char>(b[i]);
    return s;
}
std::string name_fault(std::string_view name, std::size_t most) {
    const bool plain = std::ranges::all_of(name, [](char c) { return c >= 0x20 && c < 0x7F && c != ';'; });
    if (name.size() <= most && plain) return {};
    return fmt::format("name: at most {} ASCII characters and no semicolon", most);
}
std::optional<double> number(std::string_view s) {
    double n = 0;
    const auto [end, ec] = std::from_chars(s.data(), s.data() + s.size(), n);
    return ec == std::errc{} && end == s.data() + s.size() && std::isfinite(n) ? std::optional(n) : std::nullopt;
}

/// "key=value; key=value", and the text before the first of them.
struct Parts {
    std::map<std::string, std::string, std::less<>> of;
    std::string fault;
};
Parts parts_of(std::string_view text, std::initializer_list<std::string_view> keys) {
    Parts p;
    while (!text.empty()) {
        const auto part = trimmed(text.substr(0, text.find(';')));
        text.remove_prefix(std::min(text.size(), std::min(text.find(';'), text.size() - 1) + 1));
        if (part.empty()) continue;
        const auto equals = part.find('=');
        const auto key = trimmed(part.substr(0, equals));
        if (equals == std::string_view::npos || std::ranges::find(keys, key) == keys.end()) {
            p.fault = fmt::format("\"{}\" is not understood", part.substr(0, 40));
            return p;
        }
        if (!p.of.emplace(key, trimmed(part.substr(equals + 1))).second) {
            p.fault = fmt::format("{} stands twice", key);
            return p;
        }
    }
    return p;
}
}  // namespace

EntryBytes entry_of(const Motions& motions, std::string_view command, std::string_view arguments, std::uint16_t next,
                    std::string_view name) {
    const auto wrong = [](std::string why) { return EntryBytes{{}, std::move(why)}; };
    const Motion* m = motions.named(command);
    if (!m) return wrong(fmt::format("command: there is no motion command {}", command));
    const auto inner = check_arguments(*m->command, arguments);
    if (!inner.faults.empty()) return wrong(fmt::format("arguments: {}; {}", inner.faults[0].text, inner.faults[0].remedy));
    if (next > most_entry) return wrong(fmt::format("next: {} is no entry; write 1..{}, or leave it out", next, most_entry));
    if (auto fault = name_fault(name, name_size); !fault.empty()) return wrong(std::move(fault));
    Bytes entry(entry_size, 0);
    put(entry, 0, entry_version, 2);
    put(entry, 2, next == 0 ? no_entry : next, 2);
    std::ranges::copy(Motions::pack(*m, 0, inner.values), entry.begin() + header_at);
    std::ranges::copy(name, entry.begin() + name_at);
    return {std::move(entry), {}};
}

EntryBytes entry_of(const Motions& motions, std::string_view text) {
    const auto wrong = [](std::string why) { return EntryBytes{{}, std::move(why)}; };
    text = trimmed(text);
    if (text.empty()) return {};
    if (text.starts_with("hex=")) {
        auto bytes = unhex(trimmed(text.substr(4)), entry_size);
        return bytes ? EntryBytes{std::move(*bytes), {}} : wrong(fmt::format("hex: {} bytes are wanted", entry_size));
    }
    const auto first = text.substr(0, text.find(';'));
    const auto colon = first.find(':');
    const auto p = parts_of(text.substr(first.size()), {"next", "name"});
    if (!p.fault.empty()) return wrong(p.fault);
    std::uint16_t next = 0;
    if (const auto it = p.of.find("next"); it != p.of.end() && it->second != "none") {
        const auto n = number(it->second);
        if (!n || *n < 1 || *n > most_entry || *n != std::floor(*n))
            return wrong(fmt::format("next: {} is no entry; write 1..{}, or leave it out", it->second, most_entry));
        next = static_cast<std::uint16_t>(*n);
    }
    const auto name = p.of.find("name");
    return entry_of(motions, trimmed(first.substr(0, colon)),
                    colon == std::string_view::npos ? std::string_view() : first.substr(colon + 1), next,
                    name == p.of.end() ? std::string_view() : std::string_view(name->second));
}

std::string entry_text(const Motions& motions, std::span<const std::uint8_t> entry) {
    if (entry.empty()) return {};
    std::string text;
    if (const Motion* m = motions.of_header(static_cast<std::uint16_t>(at(entry, header_at, 2)))) {
        text = m->command->name;
        const auto values = Motions::unpack(*m, entry.subspan(header_at, parameters_end - header_at));
        for (std::size_t i = 0; values && i < values->size(); ++i) {
            const auto& a = m->command->arguments[i];
            text += fmt::format("{}{}={:.12g}", i == 0 ? ": " : " ", a.name, static_cast<double>(*as_integer((*values)[i])) * a.scale);
        }
        if (const auto next = at(entry, 2, 2); next != 0 && next != no_entry) text += fmt::format("; next={}", next);
        if (const auto name = name_of(entry, name_at, name_size + 1); !name.empty()) text += "; name=" + name;
    }
    // The text does not contain counts in the header, links of 0 and reserved bytes: if they are not zero, the entry is shown in bytes.
    const auto back = entry_of(motions, text);
    return std::ranges::equal(back.bytes, entry) ? text : "hex=" + to_hex(entry);
}

CurveBytes curve_of(std::uint16_t id, std::string_view text) {
    const auto wrong = [](std::string why) { return CurveBytes{{}, {}, std::move(why)}; };
    if (trimmed(text).empty()) return {};
    const auto p = parts_of(text, {"name", "x", "length", "points", "info"});
    if (!p.fault.empty()) return wrong(p.fault);
    const auto word = [&](std::string_view key) {
        const auto it = p.of.find(key);
        return it == p.of.end() ? std::string_view() : std::string_view(it->second);
    };
    const auto x = p.of.contains("x") ? word("x") : "time";
    if (x != "time" && x != "encoder") return wrong(fmt::format("x: {} is neither time nor encoder", x));
    const auto length = number(word("length"));
    const double ticks = length ? std::nearbyint(x == "time" ? *length / seconds_per_tick : *length) : 0;
    if (!length || ticks < 1 || ticks > 4294967295.0)
        return wrong(fmt::format("length: \"{}\" is not more than 0 {}", word("length"), x == "time" ? "s" : "counts"));
    if (auto fault = name_fault(word("name"), curve_name_size); !fault.empty()) return wrong(std::move(fault));
    CurveBytes c;
    std::size_t n = 0;
    for (std::string_view left = word("points"); !left.empty();) {
        const auto begin = left.find_first_not_of(" ,\t\r\n");
        if (begin == std::string_view::npos) break;
        left.remove_prefix(begin);
        const auto one = left.substr(0, left.find_first_of(" ,\t\r\n"));
        left.remove_prefix(one.size());
        const auto place = number(one);
        const double counts = place ? std::nearbyint(*place / mm_per_count) : 0;
        if (!place || counts < -2147483648.0 || counts > 2147483647.0)
            return wrong(fmt::format("point {}: {} is no position within -214748.3648..214748.3647 mm", n + 1, one));
        if (++n > most_points) return wrong(fmt::format("point {}: a curve has at most {}", n, most_points));
        c.data.resize(n * 4);
        put(c.data, (n - 1) * 4, static_cast<std::uint32_t>(static_cast<std::int32_t>(counts)), 4);
    }
    if (n < 2) return wrong(fmt::format("points: {} given, a curve has at least 2", n));
    if (p.of.contains("info")) {
        auto info = unhex(word("info"), word("info").size() / 2);
        if (!info || info->size() < 36 || info->size() % 2 != 0) return wrong("info: an info block in hex is wanted");
        c.info = std::move(*info);
        return c;
    }
    c.info.assign(curve_info_size, 0);
    put(c.info, 0, curve_info_size, 2);
    put(c.info, 2, x == "time" ? 0x0003 : 0x0103, 2);
    put(c.info, 4, static_cast<std::uint32_t>(n), 2);
    put(c.info, 6, 4, 2);
    std::ranges::copy(word("name"), c.info.begin() + curve_name_at);
    put(c.info, 30, id, 2);
    put(c.info, 32, static_cast<std::uint32_t>(ticks), 4);
    put(c.info, 36, x == "time" ? 0x001A : 0x001B, 2);
    put(c.info, 38, 0x0005, 2);
    return c;
}

std::string curve_text(std::uint16_t id, std::span<const std::uint8_t> info, std::span<const std::uint8_t> data) {
    if (info.empty() && data.empty()) return {};
    const bool by_encoder = at(info, 2, 2) == 0x0103;
    const double length = at(info, 32, 4);
    std::string text;
    if (const auto name = name_of(info, curve_name_at, curve_name_size + 1); name_fault(name, curve_name_size).empty() && !name.empty())
        text = fmt::format("name={}; ", name);
    text += fmt::format("x={}; length={:.12g}; points=", by_encoder ? "encoder" : "time", by_encoder ? length : length * seconds_per_tick);
    for (std::size_t i = 0; i + 4 <= data.size(); i += 4)
        text += fmt::format("{}{:.12g}", i == 0 ? "" : " ", static_cast<std::int32_t>(at(data, i, 4)) * mm_per_count);
    if (const auto back = curve_of(id, text); !std::ranges::equal(back.info, info)) text += "; info=" + to_hex(info);
    return text;
}

}  // namespace axisgate::linmot
