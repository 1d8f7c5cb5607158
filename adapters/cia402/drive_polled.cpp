// A value that the drive does not have is left out; a value that it refuses for once keeps what was read before.
#include "adapters/cia402/drive_polled.hpp"

#include "adapters/cia402/drive_axis.hpp"

namespace axisgate::cia402_drive {
namespace {
constexpr std::array round{object::statusword, object::position, object::mode_shown, object::velocity};
constexpr Duration between_rounds = std::chrono::milliseconds(20), between_rounds_at_rest = std::chrono::milliseconds(100);
}  // namespace

bool Polled::skipped(std::size_t value) const noexcept {
    const AxisKnown& known = drive_.known;
    return (round[value] == object::mode_shown && !known.has_mode) || (round[value] == object::velocity && !known.has_velocity);
}

Step Polled::next() const {
    Step s;
    s.literal = true;
    s.address = of_axis(round[at_], drive_.place());
    return s;
}

bool Polled::answered(const canopen::SdoEnd& end, drive::Turn& t) {
    if (end.done())
        values_[at_] = round[at_] == object::statusword ? static_cast<std::int64_t>(canopen::low_first(end.data)) : signed_of(end.data);
    ++at_;
    while (at_ < round.size() && skipped(at_))
        ++at_;
    if (at_ < round.size()) return false;
    at_ = 0;
    drive_.feedback.on_values(static_cast<std::uint32_t>(values_[0]), values_[1], static_cast<int>(values_[2]), values_[3], t);
    look_at_ = t.now + (drive_.quick() ? between_rounds : between_rounds_at_rest);
    return true;
}

}  // namespace axisgate::cia402_drive
