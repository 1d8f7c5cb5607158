// Supply and temperature: the two voltages, the two sensors, and which of their limits are passed.
// In: figures from the tester's hand, WT. Out: VT and IT, and the codes that a change raises.
// Never switches the bridges: the motor does that with the codes.
#pragma once

#include <cstdint>
#include <string>

namespace axisgate::mcode::twin {

/// Figures of the model, since the reference gives none: the ranges in which the supplies count as good, and the shut-down temperature.
inline constexpr double plus_v_low = 10, plus_v_high = 60, aux_low = 10, aux_high = 30, shut_down_temperature = 85;

struct Supply {
    bool has_aux = true;  ///< LMM has none
    double plus_v = 48;
    double aux = 24;
    double bridge = 25;      ///< deg C
    double controller = 27;  ///< deg C
    bool warned = false;
    bool over_temperature = false;
    bool plus_v_reported = false;
    bool aux_reported = false;

    [[nodiscard]] bool plus_v_good() const noexcept { return plus_v >= plus_v_low && plus_v <= plus_v_high; }
    [[nodiscard]] bool aux_good() const noexcept { return has_aux && aux >= aux_low && aux <= aux_high; }
    [[nodiscard]] bool aux_unused() const noexcept { return !has_aux || aux < 1; }
    /// First field of VT: 0 both in range, 1 aux out or unused, 2 +V out, 3 both [L6214-6220].
    [[nodiscard]] int status() const noexcept { return (aux_good() ? 0 : 1) + (plus_v_good() ? 0 : 2); }
    [[nodiscard]] double hottest() const noexcept { return bridge > controller ? bridge : controller; }
    /// `status, aux, +V`; without aux `status, +V` [L6236-6238].
    [[nodiscard]] std::string voltages() const;
    /// `bridge, controller` [L3638].
    [[nodiscard]] std::string temperatures() const;
};

}  // namespace axisgate::mcode::twin
