// Bytes: reads and writes little-endian numbers as CIP transmits them.
// Nothing is read beyond the end: missing bytes set `bad` and read as 0.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <vector>

namespace axisgate::cip {

using Bytes = std::vector<std::uint8_t>;
using View = std::span<const std::uint8_t>;

class Reader {
public:
    /// `alone`: the bytes are to hold exactly one value.
    explicit Reader(View bytes, bool alone = false) noexcept : rest_(bytes), alone_(alone) {}
    /// Whether there are more bytes than its one value has.
    [[nodiscard]] bool too_long_for(std::size_t bytes) const noexcept { return alone_ && rest_.size() > bytes; }
    [[nodiscard]] std::uint8_t u8() noexcept { return static_cast<std::uint8_t>(number(1)); }
    [[nodiscard]] std::uint16_t u16() noexcept { return static_cast<std::uint16_t>(number(2)); }
    [[nodiscard]] std::uint32_t u32() noexcept { return static_cast<std::uint32_t>(number(4)); }
    [[nodiscard]] View take(std::size_t n) noexcept {
        if (n > rest_.size()) {
            bad_ = true;
            rest_ = {};
            return {};
        }
        const View taken = rest_.first(n);
        rest_ = rest_.subspan(n);
        return taken;
    }
    void skip(std::size_t n) noexcept { (void)take(n); }
    [[nodiscard]] View rest() const noexcept { return rest_; }
    [[nodiscard]] std::size_t left() const noexcept { return rest_.size(); }
    [[nodiscard]] bool bad() const noexcept { return bad_; }  ///< more bytes were requested than there were

private:
    std::uint64_t number(std::size_t n) noexcept {
        std::uint64_t v = 0;
        const View bytes = take(n);
        for (std::size_t i = bytes.size(); i-- > 0;)
            v = (v << 8) | bytes[i];
        return v;
    }
    View rest_;
    bool alone_;
    bool bad_ = false;
};

inline void put(Bytes& to, std::uint64_t value, std::size_t bytes) {
    const std::size_t at = to.size();
    to.resize(at + bytes);  // resized once, not byte by byte
    for (std::size_t i = 0; i < bytes; ++i)
        to[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}
inline void put8(Bytes& to, std::uint8_t v) { to.push_back(v); }
inline void put16(Bytes& to, std::uint16_t v) { put(to, v, 2); }
inline void put32(Bytes& to, std::uint32_t v) { put(to, v, 4); }
inline void put_bytes(Bytes& to, View v) { to.insert(to.end(), v.begin(), v.end()); }
/// SHORT_STRING: a length and at most 255 characters.
inline void put_short_string(Bytes& to, std::string_view s) {
    s = s.substr(0, 255);
    to.push_back(static_cast<std::uint8_t>(s.size()));
    to.insert(to.end(), s.begin(), s.end());
}
/// STRING: a length of 16 bits.
inline void put_string(Bytes& to, std::string_view s) {
    s = s.substr(0, 65535);
    put16(to, static_cast<std::uint16_t>(s.size()));
    to.insert(to.end(), s.begin(), s.end());
}
inline void set16(std::uint8_t* p, std::uint16_t v) noexcept {
    p[0] = static_cast<std::uint8_t>(v);
    p[1] = static_cast<std::uint8_t>(v >> 8);
}
inline void set32(std::uint8_t* p, std::uint32_t v) noexcept {
    set16(p, static_cast<std::uint16_t>(v));
    set16(p + 2, static_cast<std::uint16_t>(v >> 16));
}

/// An IPv4 address and a port, both in host byte order.
struct Endpoint {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
    bool operator==(const Endpoint&) const = default;
};
/// A sockaddr_in as in the standard's items: in network byte order.
inline void put_sockaddr(Bytes& to, Endpoint e) {
    const std::uint8_t head[] = {0, 2, static_cast<std::uint8_t>(e.port >> 8), static_cast<std::uint8_t>(e.port)};
    put_bytes(to, head);
    for (int shift = 24; shift >= 0; shift -= 8)
        to.push_back(static_cast<std::uint8_t>(e.address >> shift));
    to.insert(to.end(), 8, 0);
}

}  // namespace axisgate::cip
