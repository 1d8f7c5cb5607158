#include "adapters/aposs/twin/filters.hpp"

#include <array>
#include <cstdlib>
#include <utility>

namespace axisgate::aposs {

double velocity_filter_us(std::int64_t time, std::int64_t resolution) {
    if (std::abs(time) > 999) return static_cast<double>(std::abs(time));
    constexpr std::array<std::pair<int, int>, 11> table{{{250, 39500},
                                                         {256, 38600},
                                                         {500, 19500},
                                                         {512, 19000},
                                                         {1000, 9500},
                                                         {1024, 9300},
                                                         {2000, 4500},
                                                         {2048, 4400},
                                                         {2500, 3500},
                                                         {4096, 1900},
                                                         {5000, 1400}}};
    for (const auto& [counts, us] : table)
        if (counts == std::abs(resolution)) return us;
    // E-36: agrees with the table except for one row.
    return std::max(0.0, std::round((1e7 / static_cast<double>(std::max<std::int64_t>(1, std::abs(resolution))) - 500) / 100) * 100);
}

double VelocityFilter::step(double v, double tau_us, double limit, bool gives_back) {
    const double full = tau_us / 1000;
    if (!begun_) old_ = v;  // begins at the position of the master
    begun_ = true;
    if (tau_ < 0 || limit <= 0) tau_ = full;
    if (limit > 0) {
        if (std::fabs(error_) > limit) fading_ = true;
        if (std::fabs(error_) < limit / 5) fading_ = false;
        tau_ = fading_ ? std::max(std::min(5.0, full), tau_ - 1) : std::min(full, tau_ + 1);
    }
    old_ = pt(old_, v, tau_);
    if (!gives_back) return old_;
    error_ += v - old_;
    const double back = error_ * std::min(1.0, 1000 / (std::max(tau_ * 1000, 100.0) * 10));
    error_ -= back;
    return old_ + back;
}

double marker_filter(std::int64_t par, std::int64_t time, double velocity, std::int64_t pulse) {
    if (par & 1) return static_cast<double>(std::max<std::int64_t>(time / 300, 1));
    return pulse > 0 ? std::fabs(velocity) * static_cast<double>(time) / (static_cast<double>(pulse) * 3) : 1;
}

void MarkerAverage::add(double distance, double nominal, double markers) {
    distance_ = pt(distance_, distance, std::max(markers, 100.0));
    sum_ += distance - nominal;
    filtered_sum_ = pt(filtered_sum_, sum_, markers);
}

}  // namespace axisgate::aposs
