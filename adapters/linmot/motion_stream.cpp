// Each motion command is a position and a speed that the drive can reach within one period.
#include "adapters/linmot/motion_stream.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr Duration shortest_period = std::chrono::milliseconds(2), longest_period = std::chrono::milliseconds(5);  // [L3914-3944]
constexpr Duration for_the_drive = std::chrono::microseconds(700);  ///< time of the drive for an answer, and of the host; the value for
                                                                    ///< LinRS is not public
constexpr std::size_t stream_bytes = 10;                            ///< of 031xh: header, position, speed
}  // namespace

Duration stream_period(const Bus& bus, std::size_t response) noexcept {
    if (bus.bit_rate == 0 || bus.drives != 1 || response < default_size) return {};  // the answers must have the position
    const Duration exchange = bus.wire(wire_size(stream_bytes, bus.checksum) + wire_size(response, bus.checksum)) + for_the_drive;
    const Duration period = std::max<Duration>(shortest_period, std::chrono::ceil<std::chrono::milliseconds>(exchange));
    return period <= longest_period ? period : Duration{};
}

bool PositionStream::take(const SetPoint& p) {
    if (drive_.options.streams && p.mode == SetPoint::Mode::position &&
        stream_period(drive_.bus, drive_.start.response_size()) > Duration{} && !state_.ending) {
        state_.newest = p;
        return true;
    }
    if (state_.on) state_.ending = true;  // the mode has changed
    return false;
}

void PositionStream::interrupt() noexcept {
    state_.newest.reset();
    state_.ending = state_.on;
}

void PositionStream::begin(Turn& t) {
    const Feedback& feedback = drive_.feedback;
    if (feedback.status().state() != state::enabled)
        return end(Reason::wrong_state, fmt::format("drive {} is in {}: enable it first", drive_.title(), feedback.state_text()), t);
    state_.on = true;
    state_.ending = false;
    state_.period = stream_period(drive_.bus, drive_.start.response_size());
    state_.lead.begin(drive_.demand.place(t.now));
    state_.next = state_.received = t.now;
    drive_.motion.no_target();
    drive_.motion.no_orphan();
    drive_.demand.forget();
}

void PositionStream::send(Turn& t) {
    MotionOrders& motion = drive_.motion;
    const Motions& motions = drive_.bus.motions;
    if (state_.ending)
        return drive_.exchanges.send({motion.telegram(*motions.named("03Fxh"), motion.next_count(t.now), {}), Purpose::stream}, t);
    const SetPoint& p = *state_.newest;
    const auto rate = [](const std::optional<std::int64_t>& given, const std::optional<std::uint32_t>& own, double per, double fallback) {
        return given ? static_cast<double>(*given) : own && *own > 0 ? *own * per : fallback;
    };
    const Limits& own = drive_.limits;
    const drive::LeadRamps ramps{rate(p.velocity, own.velocity, 10, 100'000), rate(p.acceleration, own.acceleration, 100, 10'000'000),
                                 rate(p.deceleration, own.deceleration, 100, 10'000'000)};
    const double place = state_.lead.towards(static_cast<double>(p.value), ramps, seconds(state_.period));
    const std::vector<Value> values{
        Value{static_cast<std::int64_t>(std::clamp(std::round(place), double{INT32_MIN}, double{INT32_MAX}))},
        Value{static_cast<std::int64_t>(std::clamp(std::round(state_.lead.velocity() / 10), double{INT32_MIN}, double{INT32_MAX}))}};
    state_.next = std::max(state_.next + state_.period, t.now);
    drive_.exchanges.send({motion.telegram(*motions.named("031xh"), motion.next_count(t.now), values), Purpose::stream}, t);
}

void PositionStream::answered(Turn& t) {
    const Feedback& feedback = drive_.feedback;
    if (std::exchange(state_.ending, false)) {
        forget();
        drive_.demand.rest(feedback.status().position);
        drive_.poll.soon(t.now);
        return;
    }
    if (!state_.on) return;
    state_.received = t.now;
    if (feedback.status().state() == state::enabled) return drive_.demand.rest(state_.lead.place());
    end(Reason::drive_refused,
        feedback.in_error() ? fmt::format("drive {}: {}", drive_.title(), feedback.error_text())
                            : fmt::format("drive {} went to {}", drive_.title(), feedback.state_text()),
        t);
}

/// The drive has left the stream already, or has never begun it.
void PositionStream::end(Reason reason, std::string why, Turn& t) {
    forget();
    t.out.stream_ends.push_back({drive_.axis(), reason, std::move(why)});
}

std::optional<Duration> PositionStream::patience() const noexcept { return state_.ending ? std::nullopt : std::optional(state_.period); }
bool PositionStream::received_lately(Instant now) const noexcept { return now - state_.received < drive_.bus.timing.reply_timeout; }

}  // namespace axisgate::linmot
