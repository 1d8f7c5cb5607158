// What the control shows of itself as elements that nobody can set: SM, SN and SR [L3921-L3951].
// In: numbers of elements. Out: values, computed from the axes and the error that stands. Never stores anything.
#pragma once

#include <optional>

#include "adapters/pacontrol/twin/axes.hpp"
#include "adapters/pacontrol/twin/system_error.hpp"

namespace axisgate::pacontrol::twin {

/// Nothing: there is no such element. Axes that are not built read as 0.
class SystemViews {
public:
    SystemViews(const Axes& axes, const SystemError& error) : axes_(axes), error_(error) {}
    [[nodiscard]] std::optional<bool> flag(std::int64_t n) const;             ///< SM
    [[nodiscard]] std::optional<std::int32_t> integer(std::int64_t n) const;  ///< SN
    [[nodiscard]] std::optional<double> real(std::int64_t n) const;           ///< SR

private:
    /// The axis whose element `n` is in the view of the axes 1..16 that begins at `first`.
    [[nodiscard]] const Axis* axis_of(std::int64_t n, std::int64_t first) const;

    const Axes& axes_;
    const SystemError& error_;
};

}  // namespace axisgate::pacontrol::twin
