// A thermal model of a chain of bodies: power heats the first, each heats the next through a resistance, and the last the environment.
// Power in W, capacities in J/K, resistances in K/W, temperatures in degrees. The drive calculates its resistor and its motor in this way
// [L4583-4617, L4731-4772].
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace axisgate::linmot::twin {

template <std::size_t bodies>
struct HeatChain {
    struct Body {
        double capacity = 1;
        double resistance = 1;  ///< to the next body, or to the environment
    };
    std::array<double, bodies> temperature{};
    void settle(double environment) noexcept { temperature.fill(environment); }
    /// Steps of at most 50 ms, or one thousandth of a long time. Each body uses the old temperatures of its neighbours and its own new one,
    /// which is stable for every step length.
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
