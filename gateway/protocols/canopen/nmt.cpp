// NMT and error control: frames, and the supervision of heartbeats and guarding by time.
#include "gateway/protocols/canopen/nmt.hpp"

#include <algorithm>
#include <array>

namespace axisgate::canopen {

std::string_view name_of(NmtCommand command) noexcept {
    switch (command) {
        case NmtCommand::start:
            return "start";
        case NmtCommand::stop:
            return "stop";
        case NmtCommand::pre_operational:
            return "enter pre-operational";
        case NmtCommand::reset_node:
            return "reset node";
        case NmtCommand::reset_communication:
            return "reset communication";
    }
    return "unknown command";
}
std::string_view name_of(NmtState state) noexcept {
    switch (state) {
        case NmtState::boot_up:
            return "boot-up";
        case NmtState::stopped:
            return "stopped";
        case NmtState::operational:
            return "operational";
        case NmtState::pre_operational:
            return "pre-operational";
    }
    return "unknown state";
}
std::optional<NmtCommand> nmt_command_of(std::uint8_t byte) noexcept {
    switch (byte) {
        case 1:
        case 2:
        case 128:
        case 129:
        case 130:
            return static_cast<NmtCommand>(byte);
        default:
            return std::nullopt;
    }
}
std::optional<NmtState> nmt_state_of(std::uint8_t byte) noexcept {
    switch (byte) {
        case 0:
        case 4:
        case 5:
        case 127:
            return static_cast<NmtState>(byte);
        default:
            return std::nullopt;
    }
}

Frame nmt_frame(NmtCommand command, std::uint8_t node) noexcept {
    const std::array<std::uint8_t, 2> bytes{static_cast<std::uint8_t>(command), node};
    return data_frame(nmt_id, bytes);
}
std::optional<NmtCommand> nmt_for(const Frame& frame, std::uint8_t node) noexcept {
    if (!is_data(frame, nmt_id) || frame.size != 2 || (frame.storage[1] != 0 && frame.storage[1] != node)) return std::nullopt;
    return nmt_command_of(frame.storage[0]);
}
Frame heartbeat_frame(std::uint8_t node, NmtState state) noexcept {
    const std::array<std::uint8_t, 1> bytes{static_cast<std::uint8_t>(state)};
    return data_frame(std::uint32_t{error_control_base} + node, bytes);
}

NodeNews HeartbeatWatch::on_frame(const Frame& frame, Instant now) noexcept {
    if (!is_data(frame, std::uint32_t{error_control_base} + node_)) return NodeNews::nothing;
    const auto state = frame.size == 1 ? nmt_state_of(frame.storage[0]) : std::nullopt;
    if (!state) {
        ++malformed_;
        return NodeNews::nothing;
    }
    const bool was_lost = lost_, changed = state_ != state;
    lost_ = false;
    state_ = state;
    if (time_ > Duration{}) deadline_ = now + time_;
    if (*state == NmtState::boot_up) return NodeNews::started;
    if (was_lost) return NodeNews::back;
    return changed ? NodeNews::state : NodeNews::nothing;
}
NodeNews HeartbeatWatch::on_deadline(Instant now) noexcept {
    if (now < deadline_) return NodeNews::nothing;
    deadline_ = never;
    lost_ = true;
    return NodeNews::lost;
}

std::optional<Frame> HeartbeatProducer::on_deadline(Instant now, std::uint8_t node, NmtState state) noexcept {
    if (now < next_) return std::nullopt;
    next_ += period_;
    if (next_ <= now) next_ = now + period_;
    return heartbeat_frame(node, state);
}

void GuardMaster::set(Duration guard_time, std::uint8_t life_factor, Instant now) noexcept {
    guard_time_ = guard_time;
    life_factor_ = std::max<std::uint8_t>(life_factor, 1);
    next_ = guard_time > Duration{} ? now : never;
    silent_since_ = now;
    toggle_ = false;
    lost_ = false;
    state_.reset();
}
NodeNews GuardMaster::on_frame(const Frame& frame, Instant now) noexcept {
    if (guard_time_ <= Duration{} || !is_data(frame, std::uint32_t{error_control_base} + node_) || frame.size != 1)
        return NodeNews::nothing;
    const std::uint8_t byte = frame.storage[0];
    const auto state = nmt_state_of(byte & 0x7Fu);
    if (!state) return NodeNews::nothing;
    if (byte == 0) {  // boot-up: the toggle bit of the next answer is clear
        toggle_ = false;
        lost_ = false;
        state_ = *state;
        silent_since_ = now;
        return NodeNews::started;
    }
    // A node that was silent may have been reset, so that its toggle bit carries no information.
    if (((byte & 0x80u) != 0) != toggle_ && !lost_) {
        ++wrong_toggles_;
        return NodeNews::nothing;
    }
    toggle_ = (byte & 0x80u) == 0;
    const bool was_lost = lost_, changed = state_ != state;
    lost_ = false;
    state_ = *state;
    silent_since_ = now;
    if (was_lost) return NodeNews::back;
    return changed ? NodeNews::state : NodeNews::nothing;
}
GuardMaster::Step GuardMaster::on_deadline(Instant now) noexcept {
    if (now < next_) return {};
    Step step;
    next_ += guard_time_;
    if (next_ <= now) next_ = now + guard_time_;
    step.ask = remote_frame(std::uint32_t{error_control_base} + node_);
    if (!lost_ && now - silent_since_ >= guard_time_ * life_factor_) {
        lost_ = true;
        step.news = NodeNews::lost;
    }
    return step;
}

std::optional<Frame> GuardSlave::on_frame(const Frame& frame, Instant now, std::uint8_t node, NmtState state) noexcept {
    if (!is_remote(frame, std::uint32_t{error_control_base} + node)) return std::nullopt;
    if (life_ > Duration{}) deadline_ = now + life_;
    const std::array<std::uint8_t, 1> bytes{static_cast<std::uint8_t>(static_cast<std::uint8_t>(state) | (toggle_ ? 0x80u : 0u))};
    toggle_ = !toggle_;
    return data_frame(std::uint32_t{error_control_base} + node, bytes);
}
bool GuardSlave::on_deadline(Instant now) noexcept {
    if (now < deadline_) return false;
    deadline_ = never;
    return true;
}

}  // namespace axisgate::canopen
