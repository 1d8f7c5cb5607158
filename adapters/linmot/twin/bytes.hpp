// Values in the data of LinRS telegrams, low byte first, and the communication states. The data may be too short: missing bytes read as 0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace axisgate::linmot::twin {

inline std::uint16_t at16(std::span<const std::uint8_t> d, std::size_t i) {
    const auto byte = [&](std::size_t k) { return k < d.size() ? d[k] : std::uint8_t{0}; };
    return static_cast<std::uint16_t>(byte(i) | byte(i + 1) << 8);
}
inline std::uint32_t at32(std::span<const std::uint8_t> d, std::size_t i) { return at16(d, i) | std::uint32_t{at16(d, i + 2)} << 16; }
/// A signed value for calculations.
inline double signed16(std::span<const std::uint8_t> d, std::size_t i) { return static_cast<std::int16_t>(at16(d, i)); }
inline double signed32(std::span<const std::uint8_t> d, std::size_t i) { return static_cast<std::int32_t>(at32(d, i)); }
inline void put(std::vector<std::uint8_t>& v, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i)
        v.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}
enum Comm : std::uint8_t {
    ok = 0,
    unfinished = 4,
    no_upid = 0xC0,
    usage = 0xC3,
    not_started = 0xC5,
    list_end = 0xC6,
    wrong_size = 0xD1,
    missing = 0xD4,
    not_stopped = 0xD7
};

}  // namespace axisgate::linmot::twin
