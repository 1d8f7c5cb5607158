// Motion, part stream: the drive's own position stream (031xh) for set-points over the lane, where the line can hold its period.
// In: the newest set-point. Out: one motion command each period, with place and speed on the way there; its answers say where the axis is,
// so nothing else is asked. The newest set-point is held when none comes: a stream that starves is an error of the drive (0083h), and who
// is silent is the engine's to judge. Never streams on a line without a bit rate, nor beside another drive: their periods cannot be kept.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {
namespace {
constexpr Duration shortest_period = std::chrono::milliseconds(2), longest_period = std::chrono::milliseconds(5);  // [L3914-3944]
constexpr Duration for_the_drive = std::chrono::microseconds(700);  ///< to answer, and for the host: what LinRS takes is not public
constexpr std::size_t stream_bytes = 10;                            ///< of 031xh: header, place, speed
}  // namespace

/// 0: this line cannot hold a stream.
Duration Drive::stream_period() const noexcept {
    if (bus_.bit_rate == 0 || bus_.drives != 1) return {};
    const Duration exchange = bus_.wire(wire_size(stream_bytes, bus_.checksum) + wire_size(default_size, bus_.checksum)) + for_the_drive;
    const Duration period = std::max<Duration>(shortest_period, std::chrono::ceil<std::chrono::milliseconds>(exchange));
    return period <= longest_period ? period : Duration{};
}

void Drive::begin_stream(Turn& t) {
    if (status_.state() != state::enabled)
        return end_stream(Reason::wrong_state, fmt::format("drive {} is in {}: enable it first", title(), state_text()), t);
    stream_.on = true;
    stream_.ending = false;
    stream_.period = stream_period();
    stream_.lead.begin(demand_.known() && fb_.moving ? demand_.at(t.now).position : static_cast<double>(status_.position));
    stream_.next = stream_.heard = t.now;
    to_target_ = false;
    demand_.forget();
}

void Drive::send_stream(Turn& t) {
    if (stream_.ending) return send({motion_telegram(*bus_.motions.named("03Fxh"), next_count(), {}), Purpose::stream}, t);
    const SetPoint& p = *stream_.newest;
    const auto rate = [](const std::optional<std::int64_t>& given, const std::optional<std::uint32_t>& own, double per, double fallback) {
        return given ? static_cast<double>(*given) : own && *own > 0 ? *own * per : fallback;
    };
    const drive::LeadRamps ramps{rate(p.velocity, vmax_, 10, 100'000), rate(p.acceleration, acc_, 100, 10'000'000),
                                 rate(p.deceleration, dec_, 100, 10'000'000)};
    const double place = stream_.lead.towards(static_cast<double>(p.value), ramps, seconds(stream_.period));
    const std::vector<Value> values{
        Value{static_cast<std::int64_t>(std::clamp(std::round(place), double{INT32_MIN}, double{INT32_MAX}))},
        Value{static_cast<std::int64_t>(std::clamp(std::round(stream_.lead.velocity() / 10), double{INT32_MIN}, double{INT32_MAX}))}};
    stream_.next = std::max(stream_.next + stream_.period, t.now);
    send({motion_telegram(*bus_.motions.named("031xh"), next_count(), values), Purpose::stream}, t);
}

void Drive::stream_answered(Turn& t) {
    if (std::exchange(stream_.ending, false)) {
        stream_ = {};
        demand_.rest(static_cast<double>(status_.position));
        poll_.soon(t.now);
        return;
    }
    if (!stream_.on) return;
    stream_.heard = t.now;
    if (status_.state() == state::enabled) return demand_.rest(stream_.lead.place());
    end_stream(Reason::drive_refused,
               in_error() ? fmt::format("drive {}: {}", title(), error_text()) : fmt::format("drive {} went to {}", title(), state_text()),
               t);
}

/// The drive has left it already, or never began.
void Drive::end_stream(Reason reason, std::string why, Turn& t) {
    stream_ = {};
    t.out.stream_ends.push_back({axis_, reason, std::move(why)});
}

}  // namespace axisgate::linmot
