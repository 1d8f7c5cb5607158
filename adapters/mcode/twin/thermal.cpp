// Supply and temperature: which figure passes which limit, and how the drive prints them.
// In: figures. Out: text.
// Never rounds up a fault: the limits compare the unrounded figures.
#include "adapters/mcode/twin/thermal.hpp"

#include <cmath>

namespace axisgate::mcode::twin {

std::string Supply::voltages() const {
    std::string s = std::to_string(status());
    if (has_aux) s += ", " + std::to_string(std::lround(aux));
    return s + ", " + std::to_string(std::lround(plus_v));
}

std::string Supply::temperatures() const { return std::to_string(std::lround(bridge)) + ", " + std::to_string(std::lround(controller)); }

}  // namespace axisgate::mcode::twin
