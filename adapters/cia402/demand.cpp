// Axis, part demand: the way of a streamed set-point into a drive that follows one target per SYNC.
// In: the newest set-point, the cycle. Out: the next target, within the speed and the ramps of the set-point; RPDOs.
// Never gives a drive a step that its ramps do not allow: in a cyclic mode nobody else would plan the way.
#include <algorithm>
#include <cmath>

#include "adapters/cia402/drive_axis.hpp"

namespace axisgate::cia402_drive {

void Axis::follow(const SetPoint& p) {
    if (!listens() || place_ > 0) return;  // the engine asks nobody who has no cyclic mode
    if (newest_ && newest_->mode != p.mode) end_stream();
    newest_ = p;
}
void Axis::end_stream() noexcept {
    stream_ = Stream::none;
    newest_.reset();
    led_.stand();
}

void Axis::before_sync(Duration cycle, Turn& t) {
    if (!listens() || stream_ < Stream::position || !newest_ || known_.fb.power != AxisFeedback::Power::on) return;
    lead(t, cycle);
}

void Axis::lead(Turn& t, Duration cycle) {
    const SetPoint& p = *newest_;
    const auto rate = [&](const std::optional<std::int64_t>& v, std::size_t own) {
        return static_cast<double>(v.value_or(known_.rates[own]));
    };
    const drive::LeadRamps ramps{rate(p.velocity, 0), rate(p.acceleration, 1), rate(p.deceleration, 2)};
    if (stream_ == Stream::torque)
        return t.out.send(canopen::data_frame(0x400u + node_.number, bytes_of(std::clamp<std::int64_t>(p.value, INT16_MIN, INT16_MAX), 2)));
    if (stream_ == Stream::velocity) {
        const double v = led_.speed_towards(static_cast<double>(p.value), ramps, seconds(cycle));
        return t.out.send(canopen::data_frame(0x300u + node_.number, bytes_of(std::llround(v), 4)));
    }
    const double place =
        std::clamp(led_.towards(static_cast<double>(p.value), ramps, seconds(cycle)), double{INT32_MIN}, double{INT32_MAX});
    t.out.send(canopen::data_frame(0x200u + node_.number, bytes_of(std::llround(place), 4)));
}

}  // namespace axisgate::cia402_drive
