// MasterEncoder is the count that cams, winding and indexing follow [L4403-4470], from edges and their speed, and the parameters 128Eh to
// 1290h and 172Ah.
#pragma once

#include <algorithm>
#include <cstdint>

#include "adapters/linmot/twin/memory.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::linmot::twin {

class MasterEncoder {
public:
    explicit MasterEncoder(const Memory& memory) noexcept : memory_(memory) {}

    /// From now on; `edges` are four per period, `speed` is edges/s.
    void set(double edges, double speed, Instant now) noexcept { edges_ = edges, speed_ = speed, since_ = now; }
    void power_on() noexcept { offset_ = 0; }
    /// By 104xh: defines the present count.
    void name(double count, Instant now) noexcept { offset_ += count - this->count(now); }

    [[nodiscard]] double edges(Instant now) const noexcept { return edges_ + speed_ * std::max(0.0, seconds(now - since_)); }
    [[nodiscard]] double count(Instant now) const noexcept { return offset_ + edges(now) * factor(); }
    [[nodiscard]] double speed() const noexcept { return speed_ * factor(); }  ///< counts/s

private:
    /// Counts per edge. Without a source or type nothing is counted; type 3 is none; 4x with step and direction has the effect of 2x
    /// [L4431-4437].
    [[nodiscard]] double factor() const noexcept {
        const auto type = memory_.ram(0x128E);
        if (memory_.ram(0x172A) == 0 || type == 0 || type == 3 || type > 5) return 0;
        const auto decoding = std::min<std::uint32_t>(memory_.ram(0x128F), type >= 4 ? 1 : 2);
        return (memory_.ram(0x1290) != 0 ? -0.25 : 0.25) * static_cast<double>(1u << decoding);
    }

    const Memory& memory_;
    double edges_ = 0, speed_ = 0;
    Instant since_{};
    double offset_ = 0;
};

}  // namespace axisgate::linmot::twin
