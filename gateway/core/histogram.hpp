// Durations counted in fixed buckets, for /metrics: one thread observes, any thread reads. Observing allocates nothing and takes no lock;
// two numbers of a reading may belong to slightly different instants.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "gateway/core/counter.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate {

class Histogram {
public:
    /// Upper ends of the buckets in nanoseconds, in steps of 1, 2, 5 from 1 us to 10 s; one further bucket is for longer durations.
    static constexpr std::array<std::int64_t, 22> bounds{
        1'000,       2'000,       5'000,         10'000,        20'000,        50'000,        100'000,    200'000,
        500'000,     1'000'000,   2'000'000,     5'000'000,     10'000'000,    20'000'000,    50'000'000, 100'000'000,
        200'000'000, 500'000'000, 1'000'000'000, 2'000'000'000, 5'000'000'000, 10'000'000'000};

    /// `times` observations of this duration. A negative duration counts as 0.
    void observe(Duration d, std::uint64_t times = 1) noexcept;

    struct Reading {
        std::array<std::uint64_t, bounds.size() + 1> buckets{};  ///< not cumulative; the last one is beyond all bounds
        std::uint64_t sum_ns = 0;
        [[nodiscard]] std::uint64_t count() const noexcept;
        /// `q` is 0..1, the result in seconds, interpolated within its bucket; beyond all bounds it is the last bound. 0 if nothing was
        /// observed.
        [[nodiscard]] double quantile(double q) const noexcept;
    };
    [[nodiscard]] Reading read() const noexcept;

private:
    std::array<Counter, bounds.size() + 1> buckets_;
    Counter sum_ns_;
};

/// `# HELP` and `# TYPE` of a metric.
[[nodiscard]] std::string metric_head(std::string_view name, std::string_view type, std::string_view help);
/// The lines of one histogram (`name_bucket`, `name_sum`, `name_count`), without its head. `labels`: `door="modbus"`, or nothing.
[[nodiscard]] std::string metric_lines(std::string_view name, const Histogram::Reading& reading, std::string_view labels = {});

}  // namespace axisgate
