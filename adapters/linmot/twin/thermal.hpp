// Heat in a chain of bodies: power goes into the first, each gives it to the next through a resistance, the last to the environment.
// In: power, capacities in J/K, resistances in K/W, time. Out: temperatures in degrees. Never measures: it is the drive's own reckoning
// of its resistor and its motor [L4583-4617, L4731-4772].
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace axisgate::linmot::twin {

template <std::size_t bodies>
struct HeatChain {
    struct Body {
        double capacity = 1;
        double resistance = 1;  ///< towards the next one, or the environment
    };
    std::array<double, bodies> temperature{};
    void settle(double environment) noexcept { temperature.fill(environment); }
    /// Steps of at most 50 ms, or a thousandth of a long time: each takes the neighbours as they were and its own end for its loss, which
    /// is stable for every length.
    void run(double seconds, double power, const std::array<Body, bodies>& body, double environment) noexcept {
        if (!(seconds > 0)) return;
        const double step = std::max(0.05, seconds / 1000);
        for (double left = seconds; left > 1e-12;) {
            const double h = std::min(step, left);
            left -= h;
            double from_before = power;
            for (std::size_t i = 0; i < bodies; ++i) {
                const double r = std::max(1e-6, body[i].resistance), c = std::max(1e-6, body[i].capacity);
                const double next = i + 1 < bodies ? temperature[i + 1] : environment;
                const double now = (temperature[i] + h / c * (from_before + next / r)) / (1 + h / (c * r));
                from_before = (now - next) / r;
                temperature[i] = now;
            }
        }
    }
};

}  // namespace axisgate::linmot::twin
