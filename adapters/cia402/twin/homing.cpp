#include "adapters/cia402/twin/homing.hpp"

#include <array>
#include <cmath>

namespace axisgate::cia402_drive::twin {
namespace {
constexpr std::array methods{1,  2,  3,  4,  5,  6,  7,  8,  9,  10, 11, 12, 13, 14, 17, 18,
                             19, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30, 33, 34, 35, 37};
double index_below(double place) { return std::floor((place - 1) / index_way) * index_way; }
double index_above(double place) { return std::ceil((place + 1) / index_way) * index_way; }
}  // namespace

std::span<const int> homing_methods() noexcept { return methods; }

HomingWay homing_way(int method, double here, double travel, double hysteresis) {
    if (method == 35 || method == 37) return {true, {}, here, false};
    if (method == 33) return {true, {}, index_below(here), true};
    if (method == 34) return {true, {}, index_above(here), true};
    const bool to_edge = method >= 17 && method <= 30;  // like method - 16, but the zero is the edge itself
    const int m = to_edge ? method - 16 : method;
    if (m < 1 || m > 14 || travel <= 0) return {};

    if (m <= 2) {  // a limit switch, and the first index pulse on the way back
        const double end = m == 1 ? -travel : travel, edge = m == 1 ? end + hysteresis : end - hysteresis;
        return {true, {end}, to_edge ? edge : m == 1 ? index_above(edge) : index_below(edge), true};
    }
    // 3, 4: a home switch that is active from its edge to the positive end; 5, 6: to the negative end. The index pulse of 3 and 6 is to the
    // left of it. 3 and 5 leave the switch, 4 and 6 enter it.
    if (m <= 6) {
        const double edge = m == 3 ? -hysteresis : m == 5 ? hysteresis : 0;
        return {true, {0}, to_edge ? edge : m == 3 || m == 6 ? index_below(edge) : index_above(edge), true};
    }

    // 7 to 10 start to the right and reverse at the positive limit switch; 11 to 14 are mirrored. In order: outside the near edge, inside
    // it, inside the far edge, outside the far edge.
    const double side = m <= 10 ? 1 : -1;
    const int kind = (m - 7) % 4;
    const double released = kind == 0 || kind == 3 ? cam + hysteresis : cam;  // outside an edge: the axis leaves the cam
    const double edge = side * (kind < 2 ? -released : released);
    HomingWay way{true, {}, edge, true};
    if (side * here > cam) way.search.push_back(side * travel);
    way.search.push_back(edge);
    const bool lower = (kind == 0 || kind == 2) == (side > 0);
    if (!to_edge) way.zero = lower ? index_below(edge) : index_above(edge);
    return way;
}

}  // namespace axisgate::cia402_drive::twin
