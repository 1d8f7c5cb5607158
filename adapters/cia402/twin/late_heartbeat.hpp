// The heartbeat of a simulated node, each one late by another time. The period counts from the instants at which a heartbeat is due, so the
// delays do not add up.
#pragma once

#include <algorithm>
#include <optional>

#include "gateway/core/specimen.hpp"
#include "gateway/protocols/canopen/nmt.hpp"

namespace axisgate::cia402_drive::twin {

class LateHeartbeat {
public:
    /// `most`: the largest delay; `seed`: decides the delays.
    void set_jitter(Duration most, std::uint64_t seed) noexcept {
        most_ = most;
        seed_ = seed;
    }
    /// A period of 0 switches it off.
    void set_period(Duration period, Instant now) noexcept {
        due_.set_period(period, now);
        late_ = never;
    }
    [[nodiscard]] Instant deadline() const noexcept { return std::min(due_.deadline(), late_); }
    [[nodiscard]] std::optional<Frame> on_deadline(Instant now, std::uint8_t node, canopen::NmtState state) {
        const auto due = due_.on_deadline(now, node, state);
        const bool was_late = late_ <= now;
        if (was_late) late_ = never;
        if (due && late_ == never) late_ = now + delay();
        if (!was_late && late_ > now) return std::nullopt;
        if (late_ <= now) late_ = never;
        return canopen::heartbeat_frame(node, state);
    }

private:
    [[nodiscard]] Duration delay() {
        if (most_ == Duration::zero()) return {};
        return Duration{
            static_cast<std::int64_t>(specimen_draw(seed_, "heartbeat", ++beats_) % static_cast<std::uint64_t>(most_.count() + 1))};
    }
    canopen::HeartbeatProducer due_;
    Duration most_{};
    Instant late_ = never;  ///< a heartbeat that was due before is sent then
    std::uint64_t seed_ = 0, beats_ = 0;
};

}  // namespace axisgate::cia402_drive::twin
