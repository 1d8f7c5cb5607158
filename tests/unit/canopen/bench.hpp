// Frames as text ("581#4B41600034120000"), and the frames that a client or server has sent since the last question.
#pragma once

#include <gtest/gtest.h>

#include <charconv>
#include <chrono>
#include <string>
#include <vector>

#include "gateway/core/text.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen::test {
using namespace std::chrono_literals;

inline Frame frame(std::string_view text) {
    const auto mark = text.find('#');
    std::uint32_t id = 0;
    std::from_chars(text.data(), text.data() + mark, id, 16);
    if (text.substr(mark + 1) == "R") return remote_frame(id);
    return data_frame(id, from_hex(text.substr(mark + 1)).value());
}
inline std::string text(const Frame& f) {
    std::string id(3, '0');
    const char* digits = "0123456789ABCDEF";
    for (std::size_t i = 0; i < 3; ++i)
        id[i] = digits[f.id >> (8 - 4 * i) & 15];
    return id + "#" + (f.remote ? "R" : to_hex(f.data()));
}
/// The sent frames; the list is emptied.
inline std::vector<std::string> taken(std::vector<Frame>& out) {
    std::vector<std::string> t;
    for (const auto& f : out)
        t.push_back(text(f));
    out.clear();
    return t;
}
using Texts = std::vector<std::string>;
inline std::vector<std::uint8_t> bytes_of_text(std::string_view text) { return {text.begin(), text.end()}; }
/// `n` bytes that do not repeat soon.
inline std::vector<std::uint8_t> pattern(std::size_t n) {
    std::vector<std::uint8_t> b(n);
    for (std::size_t i = 0; i < n; ++i)
        b[i] = static_cast<std::uint8_t>(i * 31 + i / 7 + 1);
    return b;
}

}  // namespace axisgate::canopen::test
