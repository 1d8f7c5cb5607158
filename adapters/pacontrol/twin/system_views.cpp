// SM, SN and SR. In: numbers. Out: values of the moment. Never reads an axis that is not built.
#include "adapters/pacontrol/twin/system_views.hpp"

namespace axisgate::pacontrol::twin {
namespace {
constexpr bool within(std::int64_t n, std::int64_t first) { return n >= first && n < first + Axes::most; }
}  // namespace

const Axis* SystemViews::axis_of(std::int64_t n, std::int64_t first) const {
    return n - first < axes_.count() ? &axes_.at(static_cast<int>(n - first + 1)) : nullptr;
}

std::optional<bool> SystemViews::flag(std::int64_t n) const {
    if (within(n, 51)) return axis_of(n, 51) != nullptr && axis_of(n, 51)->state().referenced;
    if (within(n, 91)) return axis_of(n, 91) != nullptr && axis_of(n, 91)->traverse().busy();
    if (within(n, 231)) return axis_of(n, 231) != nullptr && axis_of(n, 231)->state().fault != 0;
    return std::nullopt;
}

std::optional<std::int32_t> SystemViews::integer(std::int64_t n) const {
    if (n == 10) return error_.shown();
    if (within(n, 71)) return axis_of(n, 71) != nullptr ? axis_of(n, 71)->shown().status().number : 0;
    return std::nullopt;
}

std::optional<double> SystemViews::real(std::int64_t n) const {
    if (within(n, 51)) return axis_of(n, 51) != nullptr ? axis_of(n, 51)->state().off_position : 0.0;
    if (within(n, 71)) return axis_of(n, 71) != nullptr ? axis_of(n, 71)->traverse().last_target() : 0.0;
    return std::nullopt;
}

}  // namespace axisgate::pacontrol::twin
