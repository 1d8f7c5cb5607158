// The profile of the parameters; see twin_parameters.hpp. In: numbers. Out: limits. No figure here is the manual's, bar the four of
// its examples: language 3 is allowed, four axes are the most of a control with four, 0 the least, inputs may be numbered from 1.
#include "adapters/pacontrol/twin_parameters.hpp"

namespace axisgate::pacontrol::twin {
namespace {

constexpr float far = 1e7F;
// 1 AE is thought of as 1 mm on a spindle of 10 mm per rotation.
constexpr std::array<Limits<float>, axis_parameters + 1> profile{{
    {},
    {0.001F, 500, 100'000},     // 01 traverse speed
    {0.001F, 50, 100'000},      // 02 reference speed
    {0.001F, 20, 100'000},      // 03 manual speed
    {0.001F, 5, 100'000},       // 04 creep speed
    {0, 0, 100'000},            // 05 start-stop speed
    {0.001F, 1000, 1'000'000},  // 06 acceleration
    {0.001F, 10, 100'000},      // 07 gear factor
    {-far, -10'000, far},       // 08 minimum traverse area
    {-far, 10'000, far},        // 09 maximum traverse area
    {0, 2, 20},                 // 0A motor phase current
    {0, 1, 20},                 // 0B motor standstill current
    {0, 0, far},                // 0C not used
    {0, 0, far},                // 0D not used
    {0, 0, far},                // 0E not used
    {0, 500, 100'000},          // 0F encoder pulses per revolution
    {0, 0, far},                // 10 not used
    {0, 10, 100'000},           // 11 maximum following error
    {0, 0, far},                // 12 not used
    {0, 0, far},                // 13 not used
    {0, 0, far},                // 14 not used
    {0, 0, far},                // 15 not used
    {0, 0, far},                // 16 not used
    {0, 0, far},                // 17 not used
    {0, 0, 1},                  // 18 direction of rotation
    {0, 1, 1},                  // 19 rotation monitoring activated
    {1, 3200, 100'000},         // 1A motor steps per rotation
    {1, 200, 10'000},           // 1B full motor steps per rotation
    {0, 0, 1},                  // 1C limit switches exchanged
    {0, 0, 100},                // 1D display unit
    {0, 0, 10},                 // 1E ramp type: kept, inert (E-33)
    {0, 0, 1},                  // 1F invert encoder direction
    {0, 0, 1},                  // 20 limit switch type
    {-far, 0, far},             // 21 distance zero point to reference switch
    {0, 0, 1},                  // 22 synchronisation to the encoder
    {0, 1, 1},                  // 23 take-over of the encoder
    {0, 0, 1},                  // 24 brake in measuring mode
    {0, 1, 1},                  // 25 absolute system activated
    {0, 250, 100'000},          // 26 transmission clock
    {0, 20, 100'000},           // 27 pause clock
    {0, 0, 10},                 // 28 code
    {0, 1, 1},                  // 29 multiturn
    {0, 25, 64},                // 2A data bits via SSI
    {0, 0, 10},                 // 2B bit 25 function
    {0, 10, far},               // 2C feed
    {-far, 0, far},             // 2D offset to reference point
    {0, 0, 1},                  // 2E invert direction
    {1, 4096, far},             // 2F increments per rotation
    {0, 4096, far},             // 30 revolutions
    {0, 24, 64},                // 31 data bits for position
    {0, 1, 3},                  // 32 enable mode
}};

}  // namespace

const Limits<float>& axis_limits(std::size_t number) { return profile.at(number); }

Limits<std::int32_t> system_limits(std::size_t number, int axes) {
    switch (number) {
        case 0x01:
            return {0, 0, 10};  // language
        case sp::axes:
            return {0, axes, axes};
        case sp::stop_input:
            return {0, 16, 1024};  // 0: not defined
        case sp::start_input:
        case 0x05:  // manual release input
        case sp::readiness_output:
        case sp::malfunction_output:
        case 0x0F:  // teleservice activate input
        case 0x10:
            return {0, 0, 1024};  // teleservice contact output
        case sp::autostart:
            return {0, 0, 1};
        case sp::profibus_address:
            return {0, 0, 126};
        case 0x13:
            return {0, 0, 1};  // Profibus diagnosis
        case 0x14:
            return {0, 0, 10};  // basic operating mode
        default:
            return {0, 0, 0x7FFFFFFF};  // currently not used
    }
}

AxisParameters usual_axis_parameters() {
    AxisParameters p{};
    for (std::size_t i = 1; i < p.size(); ++i)
        p[i] = profile[i].usual;
    return p;
}

SystemParameters usual_system_parameters(int axes) {
    SystemParameters p{};
    for (std::size_t i = 1; i < p.size(); ++i)
        p[i] = system_limits(i, axes).usual;
    return p;
}

std::uint16_t inconsistent(const AxisParameters& p) noexcept {
    if (p[ap::area_min] >= p[ap::area_max]) return 0x33;
    if (p[ap::creep_speed] > p[ap::reference_speed]) return 0x66;
    if (p[ap::start_stop_speed] > p[ap::traverse_speed]) return 0x68;
    return 0;
}

}  // namespace axisgate::pacontrol::twin
