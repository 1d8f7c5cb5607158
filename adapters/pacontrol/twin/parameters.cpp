// The profile of the parameters. In: numbers. Out: limits. No figure here is the manual's, bar the four of
// its examples: language 3 is allowed, four axes are the most of a control with four, 0 the least, inputs may be numbered from 1.
#include "adapters/pacontrol/twin/parameters.hpp"

namespace axisgate::pacontrol::twin {
namespace {

constexpr float far = 1e7F;
// 1 AE is thought of as 1 mm on a spindle of 10 mm per rotation.
constexpr std::array<Limits<float>, axis_parameters + 1> plausible{{
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

Limits<std::int32_t> plausible_system(std::size_t number, int axes) {
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

/// A speed or acceleration is put out in motor steps: what the step generator cannot do is found when AUTOMATIC or ONLINE starts. The
/// manual prints no figure of it; these are the model's own, in steps/s and steps/s2.
constexpr double slowest = 0.1, fastest = 1e8, flattest = 1, steepest = 1e10;
constexpr double most_steps = 2147483647.0;  // 31 bits [L4097]

}  // namespace

Profile::Profile() : axis_(plausible) {}

bool Profile::set_axis(std::size_t number, const Limits<float>& l) {
    if (number < 1 || number > axis_parameters || !(l.least <= l.usual && l.usual <= l.largest)) return false;
    axis_[number] = l;
    return true;
}

bool Profile::set_system(std::size_t number, const Limits<std::int32_t>& l) {
    if (number < 1 || number > system_parameters || !(l.least <= l.usual && l.usual <= l.largest)) return false;
    system_[number] = l;
    return true;
}

Limits<std::int32_t> Profile::system(std::size_t number, int axes) const {
    return system_.at(number).value_or(plausible_system(number, axes));
}

AxisParameters Profile::usual_axis(bool absolute) const {
    AxisParameters p{};
    for (std::size_t i = 1; i < p.size(); ++i)
        p[i] = axis_[i].usual;
    p[ap::absolute] = absolute ? 1.0F : 0.0F;
    return p;
}

SystemParameters Profile::usual_system(int axes) const {
    SystemParameters p{};
    for (std::size_t i = 1; i < p.size(); ++i)
        p[i] = system(i, axes).usual;
    return p;
}

std::uint16_t inconsistent(const AxisParameters& p) noexcept {
    if (p[ap::area_min] >= p[ap::area_max]) return 0x33;
    const double steps = static_cast<double>(p[ap::motor_steps]) / static_cast<double>(p[ap::gear]);  // for one AE
    const auto rate = [&](std::size_t number) { return static_cast<double>(p[number]) * steps; };
    struct Row {
        std::size_t number, bound;  ///< no faster than parameter `bound`; 0: none
        std::uint16_t too_high;     ///< too low is the next number
    };
    constexpr std::array<Row, 5> speeds{{{ap::traverse_speed, 0, 0x60},
                                         {ap::reference_speed, 0, 0x62},
                                         {ap::manual_speed, 0, 0x64},
                                         {ap::creep_speed, ap::reference_speed, 0x66},
                                         {ap::start_stop_speed, ap::traverse_speed, 0x68}}};
    for (const Row& r : speeds) {
        if (rate(r.number) > fastest || (r.bound != 0 && p[r.number] > p[r.bound])) return r.too_high;
        const bool none = r.number == ap::start_stop_speed && p[r.number] == 0;  // ramps from rest
        if (!none && rate(r.number) < slowest) return static_cast<std::uint16_t>(r.too_high + 1);
    }
    if (rate(ap::acceleration) > steepest) return 0x6A;
    if (rate(ap::acceleration) < flattest) return 0x6B;
    if ((static_cast<double>(p[ap::area_max]) - static_cast<double>(p[ap::area_min])) * steps > most_steps) return 0x6D;
    return 0;
}

}  // namespace axisgate::pacontrol::twin
