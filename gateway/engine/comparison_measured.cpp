// Positions, speeds, temperatures and the like are found in two ways. The page of data has parameters that can only be read and have a
// unit; and the recording is played again with a shaft that was moved and with another pace: a number that differs then follows from
// mechanics. The second way needs no knowledge of the family, and also finds the bits that tell whether the axis still moves.
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "gateway/core/text.hpp"
#include "gateway/engine/comparison_parts.hpp"

namespace axisgate::comparison {
namespace {
bool is_word(char c) noexcept { return is_digit(c) || is_letter(c) || c == '_' || c == '.' || c == '-' || c == '+'; }
bool is_hex(char c) noexcept { return is_digit(c) || (c >= 'A' && c <= 'F'); }
bool is_hex_byte(std::string_view w) noexcept { return w.size() == 2 && is_hex(w[0]) && is_hex(w[1]); }

/// A decimal number, or hex digits with at least one of 0 to 9 and perhaps an h.
bool is_number(std::string_view w) {
    if (parse_number(w)) return true;
    if (w.ends_with('h')) w.remove_suffix(1);
    return std::ranges::all_of(w, is_hex) && std::ranges::any_of(w, is_digit);
}

std::optional<double> value_of(std::string_view w) {
    if (const auto v = parse_number(w)) return v;
    if (w.ends_with('h')) w.remove_suffix(1);
    if (w.empty() || w.size() > 8) return std::nullopt;
    double v = 0;
    for (const char c : w)
        v = v * 16 + (is_digit(c) ? c - '0' : c - 'A' + 10);
    return v;
}

/// The bytes in front of the meaning ("04280095#01  5 -> host  ..."), which follow from it and have checksums.
std::string_view without_bytes(std::string_view sentence) {
    const auto end = sentence.find("  ");
    if (end == std::string_view::npos) return sentence;
    const auto front = sentence.substr(0, end);
    const bool bytes = std::ranges::all_of(front, [](char c) { return is_hex(c) || c == ' ' || c == '#' || c == 'R'; });
    return bytes ? sentence.substr(end + 2) : sentence;
}

std::size_t mixed(std::size_t a, std::size_t b) noexcept { return a ^ (b + 0x9E3779B97F4A7C15ULL + (a << 6) + (a >> 2)); }
}  // namespace

Shape shape_of(std::string_view sentence) {
    const std::string_view s = without_bytes(sentence);
    Shape shape;
    bool byte_before = false;
    std::string_view word_before, label;
    for (std::size_t at = 0; at < s.size();) {
        if (!is_word(s[at])) {
            if (s[at] == '=') label = word_before;
            if (s[at] != ' ' && s[at] != '=') label = {};
            if (s[at] != ' ') byte_before = false;
            shape.text += s[at++];
            continue;
        }
        std::size_t end = at;
        while (end < s.size() && is_word(s[end]))
            ++end;
        std::string_view word = s.substr(at, end - at);
        if (word.size() > 1 && word.back() == '.') word.remove_suffix(1);  // the end of a sentence
        // Behind "[" or around ":" a number names an object ("6064h:00", "ER[2]").
        const bool name = (at > 0 && (s[at - 1] == '[' || s[at - 1] == ':')) || (at + word.size() < s.size() && s[at + word.size()] == ':');
        const bool byte = is_hex_byte(word) && (byte_before || is_number(word));
        if (!name && (byte || is_number(word))) {
            shape.text += '#';
            shape.numbers.push_back(word);
            shape.labels.push_back(label);
        } else {
            shape.text += word;
        }
        byte_before = byte;
        label = {};
        word_before = word;
        at += word.size();
    }
    return shape;
}

Measured::Measured(const Catalogue& page) {
    for (const Parameter& p : page.parameters()) {
        const bool state = p.storage == "status" || p.storage == "state";
        if (p.access == Access::read && state && !p.unit.empty() && p.unit != "ms" && !p.name.starts_with("target_")) names_.insert(p.name);
    }
}

std::size_t Measured::key(const Requests& requests, const Message& m, const Shape& shape, std::size_t number) {
    const std::hash<std::string> hash;
    std::size_t k = mixed(hash(shape.text), m.stream);
    if (m.prompt && m.cause != none) k = mixed(k, hash(shape_of(requests.text[m.cause]).text));
    return mixed(k, number);
}

void Measured::learn(const Requests& requests, const std::vector<Message>& a, const std::vector<Message>& b) {
    // Answers to the same request, in their order.
    std::map<std::tuple<std::size_t, std::uint32_t>, std::vector<const Message*>> others;
    for (const Message& m : b)
        if (m.prompt) others[{m.cause, m.stream}].push_back(&m);
    std::map<std::tuple<std::size_t, std::uint32_t>, std::size_t> used;
    for (const Message& m : a) {
        if (!m.prompt) continue;
        const auto it = others.find({m.cause, m.stream});
        const std::size_t number = used[{m.cause, m.stream}]++;
        if (it == others.end() || number >= it->second.size() || it->second[number]->text == m.text) continue;
        const Shape mine = shape_of(m.text), other = shape_of(it->second[number]->text);
        if (mine.text != other.text) {
            places_.insert(key(requests, m, mine, none));  // the words differ, too: a state that follows from mechanics
            continue;
        }
        for (std::size_t i = 0; i < mine.numbers.size(); ++i)
            if (mine.numbers[i] != other.numbers[i]) places_.insert(key(requests, m, mine, i));
    }
}

bool Measured::only(const Requests& requests, const Message& recorded, const Message& twin, double& largest) const {
    const Shape r = shape_of(recorded.text), t = shape_of(twin.text);
    largest = 0;
    if (r.text != t.text) return places_.contains(key(requests, twin, t, none));
    bool differs = false;
    for (std::size_t i = 0; i < t.numbers.size(); ++i) {
        if (r.numbers[i] == t.numbers[i]) continue;
        if (!names_.contains(t.labels[i]) && !places_.contains(key(requests, twin, t, i))) return false;
        differs = true;
        const auto a = value_of(r.numbers[i]), b = value_of(t.numbers[i]);
        if (a && b) largest = std::max(largest, std::abs(*a - *b));
    }
    return differs;
}

}  // namespace axisgate::comparison
