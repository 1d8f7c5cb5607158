// Drive, part feedback: what its PDOs, EMCY and heartbeats tell.
// In: frames that nobody asked for. Out: feedback when both PDOs of one SYNC are here; notices. Never mixes two instants in one picture.
#include <fmt/core.h>

#include <cstdlib>
#include <utility>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {

void Drive::after_sync(Instant) { status_new_ = motion_new_ = false; }

void Drive::on_emergency(const canopen::Emergency& e, Turn& t) {
    if (!presence_.online()) return presence_.heard(t.now);
    const ErrorCode* known = catalogue().error(e.code);
    if (e.code != 0) fb_.error_code = e.code;
    if (!gate_.admits(e, t.now)) return;
    notices_.tell(Severity::info, axis_, "emergency", e.code,
                  fmt::format("EMCY {}{}", canopen::to_text(e), known ? ": " + known->text : ""), t.now, t.out);
}

void Drive::on_heartbeat(const Frame& f, Turn& t) {
    const auto news = heartbeat_.on_frame(f, t.now);
    if (news == canopen::NodeNews::started) {
        // Whatever was set up in it is gone, and so are its zero and what was ordered.
        const auto place = fb_.position;
        fb_ = {};
        fb_.position = place;
        order_ = Order::none;
        cw_ = 0;
        if (presence_.online() && !presence_.is(Presence::Phase::restarting)) {
            forget(Reason::interrupted, "the drive has restarted", t);
            return presence_.begin(t.now);
        }
    }
    presence_.heard(t.now);
}

void Drive::on_status(std::span<const std::uint8_t> b, Turn& t) {
    if (!listens()) return presence_.heard(t.now);
    if (b.size() != 7) {
        ++line_.counters.garbled;
        return;
    }
    fb_.native_status = static_cast<std::uint32_t>(canopen::low_first(b.first(2)));
    fb_.position = signed_of(b.subspan(2, 4));
    mode_ = static_cast<int>(signed_of(b.subspan(6, 1)));
    status_new_ = true;
    if (motion_new_) learnt(t);
}
void Drive::on_motion(std::span<const std::uint8_t> b, Turn& t) {
    if (!listens()) return presence_.heard(t.now);
    if (b.size() != 8) {
        ++line_.counters.garbled;
        return;
    }
    fb_.velocity = signed_of(b.first(4));
    fb_.position_demand = signed_of(b.subspan(4, 4));
    motion_new_ = true;
    if (status_new_) learnt(t);
}

void Drive::learnt(Turn& t) {
    status_new_ = motion_new_ = false;
    deaf_ = 0;
    presence_.answered();
    ++line_.counters.exchanges;  // a SYNC is the question, both PDOs are the answer
    check_at_ = t.now + std::max<Duration>(3 * line_.cycle, std::chrono::milliseconds(150));
    judge(t);
}

void Drive::judge(Turn& t) {
    const unsigned sw = fb_.native_status, six = sw & 0x6Fu;
    const bool enabled = six == 0x27, quick = six == 0x07, reacting = (sw & 0x4Fu) == 0x0F, was_fault = fb_.fault;
    fb_.statusword = static_cast<std::uint16_t>(sw & 0x7Fu);
    fb_.power = enabled || quick || reacting ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb_.fault = (sw & 0x4Fu) == 0x08 || reacting;
    fb_.warning = sw & 0x80u;
    fb_.internal_limit = sw & 0x800u;
    fb_.quick_stopping = quick;
    fb_.demand_source = fb_.power == AxisFeedback::Power::on && !fb_.fault ? DemandSource::drive : DemandSource::none;
    const bool halted = cw_ & 0x100u;
    if (!enabled || halted) {
        if (order_ == Order::homing) fb_.homing = false;
        order_ = Order::none;
    }
    if (!enabled) end_stream();
    if (order_ == Order::homing) {
        if (mode_ == 6 && (sw & 0x2000u)) fb_.homing = false, fb_.homing_error = true, order_ = Order::none;
        if (mode_ == 6 && (sw & 0x1000u) && (sw & 0x400u)) {
            fb_.homing = false;
            fb_.homing_attained = fb_.referenced = true;
            order_ = Order::none;
        }
    }
    // Bit 10 of the motion before may stand in the first status after a new set-point: it counts from the second one on.
    const bool fresh = std::exchange(fresh_, fresh_ > 0 ? fresh_ - 1 : 0) > 0;
    fb_.target_reached = order_ == Order::position && mode_ == 1 && (sw & 0x400u) && !fresh;
    const bool on_its_way = (order_ == Order::position && !fb_.target_reached) || fb_.homing;
    fb_.moving = fb_.velocity != 0 || on_its_way || (stream_ >= Stream::position && led_.velocity() != 0);
    if (fb_.power != AxisFeedback::Power::on) fb_.moving = fb_.velocity != 0;
    if (!fb_.fault) fb_.error_code = 0;
    if (fb_.fault && !was_fault && fb_.error_code == 0) {  // its EMCY was lost: the fault is told with its number
        need_code_ = true;
        return;
    }
    if (!need_code_) emit(t);
}

void Drive::emit(Turn& t) {
    fb_.at = t.now;
    if (axis_ != no_axis) t.out.feedback.push_back({axis_, fb_});
}

}  // namespace axisgate::cia402_drive
