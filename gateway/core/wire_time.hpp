// The length of a frame in bits, its duration, and the arbitration between two CAN frames (ISO 11898-1). The numbers are exact: the bit
// stream is built up to its checksum, and the stuff bits are counted in it.
#pragma once

#include <cstdint>

#include "gateway/core/frame.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate {

/// Recessive bits after every CAN frame before the next may start.
inline constexpr std::uint32_t can_intermission_bits = 3;

/// Bits from the start of frame to the end of frame inclusive, with stuff bits, without intermission. Classic CAN, 0..8 bytes.
[[nodiscard]] std::uint32_t can_bits(const Frame& frame) noexcept;
/// The 15-bit checksum of the frame (polynomial 0x4599).
[[nodiscard]] std::uint16_t can_crc(const Frame& frame) noexcept;
/// The smaller number wins the bus: identifier, then data before remote and standard before extended, as the bits are sent.
[[nodiscard]] std::uint32_t can_arbitration(const Frame& frame) noexcept;

/// `bits` at `bit_rate` bit/s, to the nearest nanosecond; zero if the rate is zero (unknown).
[[nodiscard]] constexpr Duration wire_time(std::uint64_t bits, std::uint32_t bit_rate) noexcept {
    if (bit_rate == 0) return Duration::zero();
    return Duration{static_cast<std::int64_t>((bits * 1'000'000'000ull + bit_rate / 2) / bit_rate)};
}

}  // namespace axisgate
