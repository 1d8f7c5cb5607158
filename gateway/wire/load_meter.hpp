// The fraction of the last second for which something was busy. The second is divided into slices of 100 ms, so that no clock and no
// allocation is needed.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "gateway/core/instant.hpp"

namespace axisgate {

class LoadMeter {
public:
    /// Adds work that ended at `at`. Instants may repeat; work older than a second has no effect.
    void add(Instant at, Duration busy) noexcept {
        const std::int64_t slice = ns_of(at) / slice_ns;
        Slice& s = slices_[index(slice)];
        if (s.number > slice) return;
        if (s.number < slice) s = {slice, 0};
        s.busy_ns += busy.count();
    }
    /// The fraction of the second before `now`. The oldest slice counts in proportion to its part inside that second.
    [[nodiscard]] double share(Instant now) const noexcept {
        const std::int64_t current = ns_of(now) / slice_ns;
        const double oldest_part = 1.0 - static_cast<double>(ns_of(now) % slice_ns) / static_cast<double>(slice_ns);
        double busy = 0;
        for (const Slice& s : slices_) {
            const std::int64_t age = current - s.number;
            if (age < 0 || age > 10) continue;
            busy += static_cast<double>(s.busy_ns) * (age == 10 ? oldest_part : 1.0);
        }
        return std::clamp(busy / 1e9, 0.0, 1.0);
    }

private:
    static constexpr std::int64_t slice_ns = 100'000'000;
    struct Slice {
        std::int64_t number = -1'000'000;
        std::int64_t busy_ns = 0;
    };
    [[nodiscard]] static std::size_t index(std::int64_t slice) noexcept { return static_cast<std::size_t>(((slice % 11) + 11) % 11); }
    std::array<Slice, 11> slices_{};
};

}  // namespace axisgate
