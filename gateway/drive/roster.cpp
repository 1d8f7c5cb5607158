#include "gateway/drive/roster.hpp"

namespace axisgate::drive {

bool same_drive(const DriveSetup& a, const DriveSetup& b) {
    return a.id == b.id && a.name == b.name && a.address == b.address && a.options == b.options &&
           std::ranges::equal(a.axes, b.axes,
                              [](const AxisSetup& x, const AxisSetup& y) { return x.id == y.id && x.channel == y.channel; });
}

}  // namespace axisgate::drive
