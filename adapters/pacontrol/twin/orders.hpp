// What was ordered for the moves of each axis and holds from then on: speed, acceleration, conditions, the watch on limit switches.
// In: orders, power, changes of the mode. Out: the same, when a move starts and while it runs. Never starts or ends a move.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace axisgate::pacontrol::twin {

/// 0A8D, 0A8E: instead of the axis parameters, up to home position.
struct Overrides {
    std::optional<double> speed, acceleration;  ///< AE/s, AE/s^2
};

/// 0AA3, G123: the element that has to have this value, or the move ends.
struct Condition {
    bool value = true;
    std::uint8_t type = 1;  ///< 1 input, 2 output, 3 flag
    std::int32_t number = 1;
};

struct AxisOrders {
    Overrides overrides;
    std::optional<Condition> next;     ///< of 0AA3, for the next move
    std::optional<Condition> running;  ///< of the move that runs
    int condition_input = 1;           ///< of control bits 8 and 9
    bool limits_monitored = true;

    void order(const Condition& c) {
        next = c;
        if (c.type == 1) condition_input = c.number;
    }
    /// AUTOMATIC or ONLINE was entered.
    void begin() {
        limits_monitored = true;
        condition_input = 1;
        next.reset();
    }
    /// Home position or the manual mode was entered.
    void end() {
        overrides = {};
        next.reset();
    }
};

class Orders {
public:
    explicit Orders(int axes) : axes_(static_cast<std::size_t>(axes)) {}
    [[nodiscard]] AxisOrders& of(int n) { return axes_.at(static_cast<std::size_t>(n - 1)); }  ///< n = 1..
    /// As many axes as this; those that are there keep what was ordered for them.
    void fit(int axes) { axes_.resize(static_cast<std::size_t>(axes)); }
    void begin() {
        for (AxisOrders& a : axes_)
            a.begin();
    }
    /// Power on.
    void forget() { axes_.assign(axes_.size(), {}); }

private:
    std::vector<AxisOrders> axes_;
};

}  // namespace axisgate::pacontrol::twin
