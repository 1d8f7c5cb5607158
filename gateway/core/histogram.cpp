// Counts durations in fixed buckets. The buckets are separate and the reader adds them, so that the observing thread writes only two
// numbers.
#include "gateway/core/histogram.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate {

void Histogram::observe(Duration d, std::uint64_t times) noexcept {
    const std::int64_t ns = std::max<std::int64_t>(0, d.count());
    const auto at = static_cast<std::size_t>(std::ranges::lower_bound(bounds, ns) - bounds.begin());
    buckets_[at].add(times);
    sum_ns_.add(static_cast<std::uint64_t>(ns) * times);
}

Histogram::Reading Histogram::read() const noexcept {
    Reading r;
    for (std::size_t i = 0; i < buckets_.size(); ++i)
        r.buckets[i] = buckets_[i].value();
    r.sum_ns = sum_ns_.value();
    return r;
}

std::uint64_t Histogram::Reading::count() const noexcept {
    std::uint64_t n = 0;
    for (const auto b : buckets)
        n += b;
    return n;
}

double Histogram::Reading::quantile(double q) const noexcept {
    const std::uint64_t all = count();
    if (all == 0) return 0;
    const double rank = std::clamp(q, 0.0, 1.0) * static_cast<double>(all);
    double below = 0;
    for (std::size_t i = 0; i < bounds.size(); ++i) {
        const auto here = static_cast<double>(buckets[i]);
        if (here > 0 && below + here >= rank) {
            const double low = i == 0 ? 0 : static_cast<double>(bounds[i - 1]);
            return (low + (static_cast<double>(bounds[i]) - low) * std::max(0.0, rank - below) / here) * 1e-9;
        }
        below += here;
    }
    return static_cast<double>(bounds.back()) * 1e-9;
}

std::string metric_head(std::string_view name, std::string_view type, std::string_view help) {
    return fmt::format("# HELP {0} {1}\n# TYPE {0} {2}\n", name, help, type);
}

std::string metric_lines(std::string_view name, const Histogram::Reading& reading, std::string_view labels) {
    std::string s;
    const std::string_view comma = labels.empty() ? "" : ",";
    std::uint64_t up_to = 0;
    for (std::size_t i = 0; i < Histogram::bounds.size(); ++i) {
        up_to += reading.buckets[i];
        s += fmt::format("{}_bucket{{{}{}le=\"{:g}\"}} {}\n", name, labels, comma, static_cast<double>(Histogram::bounds[i]) * 1e-9, up_to);
    }
    up_to += reading.buckets.back();
    const std::string set = labels.empty() ? std::string() : fmt::format("{{{}}}", labels);
    s += fmt::format("{}_bucket{{{}{}le=\"+Inf\"}} {}\n", name, labels, comma, up_to);
    s += fmt::format("{0}_sum{1} {2:.9f}\n{0}_count{1} {3}\n", name, set, static_cast<double>(reading.sum_ns) * 1e-9, up_to);
    return s;
}

}  // namespace axisgate
