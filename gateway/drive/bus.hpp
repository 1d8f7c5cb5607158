// Bus holds what the drives of one line share: the catalogue of their family, the timing and bit rate of the line, the order of
// transmission (Turns) and the line's counters. It sends nothing and does not know the drives.
#pragma once

#include <cstddef>
#include <cstdint>

#include "gateway/core/adapter.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/drive/option_reader.hpp"
#include "gateway/drive/timing.hpp"
#include "gateway/drive/turn.hpp"
#include "gateway/drive/turns.hpp"

namespace axisgate::drive {

/// A family that shares more values derives its own bus from this one.
struct Bus {
    explicit Bus(const Catalogue& of_family) noexcept : catalogue(of_family) {}

    /// Sets timing and bit rate of the line. `defaults` are the family's.
    void take(const LineSetup& setup, const Timing& defaults) noexcept;
    /// Transmission time of `bytes` on a serial line; zero if the bit rate is not known (TCP).
    [[nodiscard]] Duration wire(std::size_t bytes) const noexcept;

    /// Returns false and counts a garbled frame if the frame does not carry bytes: a serial line has no other kind of frame.
    [[nodiscard]] bool is_run(const Frame& frame) noexcept {
        if (frame.kind != Frame::Kind::bytes) ++counters.garbled;
        return frame.kind == Frame::Kind::bytes;
    }

    const Catalogue& catalogue;
    Timing timing;
    std::uint32_t bit_rate = 0;  ///< bit/s; 0: not known
    std::uint8_t bits_per_byte = 10;
    Turns turns;  ///< the sender reports here when an exchange begins and ends
    AdapterCounters counters;
    Duration on_wire{};  ///< time of the longest request and its answer, in families that calculate with one number
};

/// Reports options of the line that could not be read as notices of the line.
void tell_faults(OptionReader& options, Turn& t);

}  // namespace axisgate::drive
