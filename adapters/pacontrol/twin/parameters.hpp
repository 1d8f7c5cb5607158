// System and axis parameters of the twin: their profile (default, least, largest) and their values.
// In: numbers and values. Out: values, or that the number or the value is none.
// The manual prints no ranges and no defaults (E-23): the profile here is a plausible machine, served by 1701/1702/1801/1802, and can be
// replaced piece by piece.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace axisgate::pacontrol::twin {

/// Numbers of axis parameters that the model acts upon [L2231-2330].
namespace ap {
inline constexpr std::size_t traverse_speed = 0x01;    ///< AE/s
inline constexpr std::size_t reference_speed = 0x02;   ///< AE/s
inline constexpr std::size_t manual_speed = 0x03;      ///< AE/s
inline constexpr std::size_t creep_speed = 0x04;       ///< AE/s
inline constexpr std::size_t start_stop_speed = 0x05;  ///< AE/s
inline constexpr std::size_t acceleration = 0x06;      ///< AE/s^2
inline constexpr std::size_t gear = 0x07;              ///< AE per motor rotation
inline constexpr std::size_t area_min = 0x08;          ///< AE
inline constexpr std::size_t area_max = 0x09;          ///< AE
inline constexpr std::size_t encoder_pulses = 0x0F;
inline constexpr std::size_t following_error = 0x11;  ///< AE; 0: not monitored
inline constexpr std::size_t rotation_monitoring = 0x19;
inline constexpr std::size_t motor_steps = 0x1A;
inline constexpr std::size_t full_steps = 0x1B;
inline constexpr std::size_t limits_exchanged = 0x1C;
inline constexpr std::size_t zero_to_switch = 0x21;  ///< AE
inline constexpr std::size_t synchronise = 0x22;
inline constexpr std::size_t take_over = 0x23;
inline constexpr std::size_t absolute = 0x25;
inline constexpr std::size_t enable_mode = 0x32;  ///< 1: at once after initialisation [L722]; the other values are the model's own
}  // namespace ap

/// Numbers of system parameters that the model acts upon [L2068-2088].
namespace sp {
inline constexpr std::size_t axes = 0x02;
inline constexpr std::size_t start_input = 0x03;
inline constexpr std::size_t stop_input = 0x04;
inline constexpr std::size_t readiness_output = 0x06;
inline constexpr std::size_t malfunction_output = 0x07;
inline constexpr std::size_t autostart = 0x08;
inline constexpr std::size_t profibus_address = 0x11;
}  // namespace sp

inline constexpr std::size_t axis_parameters = 0x32;
inline constexpr std::size_t system_parameters = 0x14;

template <class T>
struct Limits {
    T least{}, usual{}, largest{};
};

using AxisParameters = std::array<float, axis_parameters + 1>;
using SystemParameters = std::array<std::int32_t, system_parameters + 1>;

/// What the parameters of a control may be and are at first: a plausible machine, of which single entries can be replaced.
class Profile {
public:
    Profile();
    /// `least` <= `usual` <= `largest`, a number 1..50 or 1..20; what is none is left as it is: false.
    bool set_axis(std::size_t number, const Limits<float>& limits);
    bool set_system(std::size_t number, const Limits<std::int32_t>& limits);
    /// Of axis parameter `number` 1..50.
    [[nodiscard]] const Limits<float>& axis(std::size_t number) const { return axis_.at(number); }
    /// Of system parameter `number` 1..20 for a control with `axes` axes.
    [[nodiscard]] Limits<std::int32_t> system(std::size_t number, int axes) const;
    /// `absolute`: axis parameter 25h.
    [[nodiscard]] AxisParameters usual_axis(bool absolute) const;
    [[nodiscard]] SystemParameters usual_system(int axes) const;

private:
    std::array<Limits<float>, axis_parameters + 1> axis_;
    std::array<std::optional<Limits<std::int32_t>>, system_parameters + 1> system_;
};

/// What entering ONLINE or AUTOMATIC finds wrong with them: a command error 33h, 60h..6Bh, 6Dh, or 0 [L4067, L4084-L4097].
[[nodiscard]] std::uint16_t inconsistent(const AxisParameters& p) noexcept;

}  // namespace axisgate::pacontrol::twin
