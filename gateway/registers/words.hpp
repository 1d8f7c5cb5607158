// 16-bit registers as bytes, and 32-bit values as two registers in either order.
#pragma once

#include <cstdint>

#include "gateway/site/mapping.hpp"

namespace axisgate::registers {

/// The order of the two registers of a 32-bit value. Bytes within a register are always big-endian.
using WordOrder = MapWordOrder;

[[nodiscard]] constexpr std::uint16_t get16(const std::uint8_t* p) noexcept {
    return static_cast<std::uint16_t>((std::uint32_t{p[0]} << 8) | p[1]);
}
constexpr void put16(std::uint8_t* p, std::uint16_t v) noexcept {
    p[0] = static_cast<std::uint8_t>(v >> 8);
    p[1] = static_cast<std::uint8_t>(v);
}
[[nodiscard]] constexpr std::uint32_t get32(const std::uint8_t* p, WordOrder order) noexcept {
    const std::uint32_t a = get16(p);
    const std::uint32_t b = get16(p + 2);
    return order == WordOrder::high_first ? (a << 16) | b : (b << 16) | a;
}
constexpr void put32(std::uint8_t* p, std::uint32_t v, WordOrder order) noexcept {
    const auto high = static_cast<std::uint16_t>(v >> 16);
    const auto low = static_cast<std::uint16_t>(v);
    put16(p, order == WordOrder::high_first ? high : low);
    put16(p + 2, order == WordOrder::high_first ? low : high);
}

}  // namespace axisgate::registers
