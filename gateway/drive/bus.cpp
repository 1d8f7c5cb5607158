#include "gateway/drive/bus.hpp"

#include <utility>

#include "gateway/core/wire_time.hpp"

namespace axisgate::drive {

void Bus::take(const LineSetup& setup, const Timing& defaults) noexcept {
    timing = timing_of(setup.timing, defaults);
    bit_rate = setup.bit_rate;
    bits_per_byte = setup.bits_per_byte;
}

Duration Bus::wire(std::size_t bytes) const noexcept { return wire_time(std::uint64_t{bytes} * bits_per_byte, bit_rate); }

void tell_faults(OptionReader& options, Turn& t) {
    for (auto& fault : options.take_faults())
        t.out.notices.push_back({Severity::warning, no_drive, no_axis, "setup", 0, std::move(fault), t.now});
}

}  // namespace axisgate::drive
