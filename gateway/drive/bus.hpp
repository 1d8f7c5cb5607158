// Bus: what the drives of one line share: their family's page, the line's timing and speed, whose turn it is, what was counted.
// In: the line's setup. Out: members that the adapter and its drives use. Never sends, and never knows a drive.
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

/// A family that shares more adds it to one of these by deriving.
struct Bus {
    explicit Bus(const Catalogue& of_family) noexcept : catalogue(of_family) {}

    /// Timing and speed of the line; `defaults` are the family's.
    void take(const LineSetup& setup, const Timing& defaults) noexcept;
    /// Time of so many bytes on a serial line; none where the rate is not known (TCP).
    [[nodiscard]] Duration wire(std::size_t bytes) const noexcept;

    /// On a line of bytes anything else is counted as no word of its language.
    [[nodiscard]] bool is_run(const Frame& frame) noexcept {
        if (frame.kind != Frame::Kind::bytes) ++counters.garbled;
        return frame.kind == Frame::Kind::bytes;
    }

    const Catalogue& catalogue;
    Timing timing;
    std::uint32_t bit_rate = 0;  ///< bit/s; 0: not known
    std::uint8_t bits_per_byte = 10;
    Turns turns;  ///< who sends says there when an exchange begins and ends
    AdapterCounters counters;
    Duration on_wire{};  ///< of the longest request with its answer, where a family reckons with one number
};

/// What could not be read in a line's options is told as notices of the line.
void tell_faults(OptionReader& options, Turn& t);

}  // namespace axisgate::drive
