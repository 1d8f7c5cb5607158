// Drive, part demand: the way of a streamed set-point into a drive that follows one target per SYNC.
// In: the newest set-point, the cycle. Out: the next target, within the speed and the ramps of the set-point; RPDOs.
// Never gives a drive a step that its ramps do not allow: in a cyclic mode nobody else would plan the way.
#include <algorithm>
#include <cmath>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {

void Drive::follow(const SetPoint& p) {
    if (!listens()) return;
    if (newest_ && newest_->mode != p.mode) end_stream();
    newest_ = p;
}
void Drive::end_stream() noexcept {
    stream_ = Stream::none;
    newest_.reset();
    led_.stand();
}

/// The drive's own place is its first target, and only then the mode is another.
Drive::Job Drive::stream_job() const {
    Job job;
    job.stream = true;
    job.command.axis = axis_;
    write(job, object::cycle, milliseconds_of(std::min<Duration>(line_.cycle, std::chrono::milliseconds(255))), 1, true);
    write(job, object::cycle_index, -3, 1, true);
    if (cw_ & 0x10u) word(job, static_cast<std::uint16_t>((cw_ & 0x100u) | 0x0Fu));
    job.steps.push_back({Step::Kind::read, object::position, {}});
    const auto mode = newest_->mode;
    if (mode == SetPoint::Mode::position) {
        write(job, object::target_position, 0, 4);
        job.steps.back().from_here = true;
    } else {
        write(job, mode == SetPoint::Mode::velocity ? object::target_velocity : object::target_torque, 0,
              mode == SetPoint::Mode::velocity ? 4 : 2);
    }
    enter_mode(job, 8 + static_cast<int>(mode));
    if (cw_ != 0x0F) word(job, 0x0F);
    return job;
}

void Drive::before_sync(Duration cycle, Turn& t) {
    if (!listens() || stream_ < Stream::position || !newest_ || fb_.power != AxisFeedback::Power::on) return;
    lead(t, cycle);
}

void Drive::lead(Turn& t, Duration cycle) {
    const SetPoint& p = *newest_;
    const auto rate = [&](const std::optional<std::int64_t>& v, std::size_t own) { return static_cast<double>(v.value_or(profile_[own])); };
    const drive::LeadRamps ramps{rate(p.velocity, 0), rate(p.acceleration, 1), rate(p.deceleration, 2)};
    if (stream_ == Stream::torque)
        return t.out.send(canopen::data_frame(0x400u + node_, bytes_of(std::clamp<std::int64_t>(p.value, INT16_MIN, INT16_MAX), 2)));
    if (stream_ == Stream::velocity) {
        const double v = led_.speed_towards(static_cast<double>(p.value), ramps, seconds(cycle));
        return t.out.send(canopen::data_frame(0x300u + node_, bytes_of(std::llround(v), 4)));
    }
    const double place =
        std::clamp(led_.towards(static_cast<double>(p.value), ramps, seconds(cycle)), double{INT32_MIN}, double{INT32_MAX});
    t.out.send(canopen::data_frame(0x200u + node_, bytes_of(std::llround(place), 4)));
}

}  // namespace axisgate::cia402_drive
