// SetPointStream: one target per cycle.
// In: the newest set-point, what is known of the axis. Out: RPDOs of the connection set, which are the first axis'.
#include "adapters/cia402/demand.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/cia402/drive_axis.hpp"

namespace axisgate::cia402_drive {

void SetPointStream::follow(const SetPoint& p) {
    if (!drive_.listens() || drive_.place() > 0) return;  // the engine asks nobody who has no cyclic mode
    if (newest_ && newest_->mode != p.mode) end();
    newest_ = p;
}
void SetPointStream::end() noexcept {
    state_ = State::none;
    newest_.reset();
    led_.stand();
}

Job SetPointStream::begin() {
    Job job;
    job.command.axis = drive_.id();
    plan_stream(drive_.known, newest_->mode, drive_.node.line.cycle, job);
    state_ = State::starting;
    return job;
}
void SetPointStream::begun(std::int64_t here) {
    state_ = newest_ ? static_cast<State>(static_cast<int>(State::position) + static_cast<int>(newest_->mode)) : State::none;
    led_.begin(static_cast<double>(here));
}

void SetPointStream::before_sync(Duration cycle, Turn& t) {
    const AxisKnown& known = drive_.known;
    const std::uint32_t node = drive_.node.number;
    if (!drive_.listens() || state_ < State::position || !newest_ || known.fb.power != AxisFeedback::Power::on) return;
    const SetPoint& p = *newest_;
    const auto rate = [&](const std::optional<std::int64_t>& v, std::size_t own) {
        return static_cast<double>(v.value_or(known.rates[own]));
    };
    const drive::LeadRamps ramps{rate(p.velocity, 0), rate(p.acceleration, 1), rate(p.deceleration, 2)};
    if (state_ == State::torque)
        return t.out.send(canopen::data_frame(0x400u + node, bytes_of(std::clamp<std::int64_t>(p.value, INT16_MIN, INT16_MAX), 2)));
    if (state_ == State::velocity) {
        const double v = led_.speed_towards(static_cast<double>(p.value), ramps, seconds(cycle));
        return t.out.send(canopen::data_frame(0x300u + node, bytes_of(std::llround(v), 4)));
    }
    const double place =
        std::clamp(led_.towards(static_cast<double>(p.value), ramps, seconds(cycle)), double{INT32_MIN}, double{INT32_MAX});
    t.out.send(canopen::data_frame(0x200u + node, bytes_of(std::llround(place), 4)));
}

}  // namespace axisgate::cia402_drive
