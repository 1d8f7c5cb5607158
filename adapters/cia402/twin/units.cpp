// A factor of 0 counts as 1.
#include "adapters/cia402/twin/units.hpp"

namespace axisgate::cia402_drive::twin {

void AxisObjects::note_error(std::uint16_t code, std::uint8_t error_register) {
    put(0x603F, code);
    put(0x1001, error_register);
    for (std::uint8_t i = 4; i > 1; --i)
        put(0x1003, get(0x1003, static_cast<std::uint8_t>(i - 1)), i);
    put(0x1003, code, 1);
    (void)d_.set_bytes({0x1003, 0}, std::vector<std::uint8_t>{0});
}

void UserUnits::read() {
    per_unit_ = ratio(0x608F) * ratio(0x6091) / ratio(0x6092);
    per_speed_ = per_unit_ * ratio(0x6096);
    const auto polarity = static_cast<unsigned>(o_.get(0x607E));
    turn_ = (polarity & 0x80u) ? -1 : 1;
    turn_speed_ = (polarity & 0x40u) ? -1 : 1;
}
double UserUnits::ratio(std::uint16_t index) const {
    const auto over = static_cast<double>(o_.get(index, 1)), under = static_cast<double>(o_.get(index, 2));
    return over > 0 && under > 0 ? over / under : 1;
}

std::pair<double, double> UserUnits::limits() const {
    if (o_.get(0x607D, 1) >= o_.get(0x607D, 2)) return {0, 0};
    const double a = place_of(0x607D, 1), b = place_of(0x607D, 2);
    return {std::min(a, b), std::max(a, b)};
}

/// 60A3h is the number of jerks: 1 for all, 2 for acceleration and deceleration, 4 for each phase its own.
void UserUnits::form(Ramps& r) const {
    const auto type = o_.get(0x6086), jerks = o_.get(0x60A3);
    r.shape = type == 1 ? Shape::sine : type == 3 ? Shape::jerk : Shape::linear;
    for (std::uint8_t k = 0; k < 4; ++k) {
        const std::uint8_t sub = static_cast<std::uint8_t>(jerks >= 4 ? k + 1 : jerks == 2 ? k / 2 + 1 : 1);
        r.jerk.at(k) = way_of(0x60A4, sub);
    }
}
Ramps UserUnits::ramps() const {
    Ramps r{std::min(way_of(0x6081) * per_speed_ / per_unit_, fastest()), std::min(rate_of(0x6083), rate_of(0x60C5)),
            std::min(rate_of(0x6084), rate_of(0x60C6))};
    form(r);
    return r;
}
Ramps UserUnits::braking(std::int64_t option) const {
    const double down = rate_of(option == 1 || option == 5 ? 0x6084 : option == 2 || option == 6 ? 0x6085 : 0x60C6);
    Ramps r{0, down, down};
    if (option == 1 || option == 5) form(r);
    return r;
}

}  // namespace axisgate::cia402_drive::twin
