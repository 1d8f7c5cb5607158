// Drive, part feedback: what PDOs, EMCY and heartbeats tell.
// In: frames that nobody asked for. Out: feedback when both PDOs of one SYNC are here; notices. Never mixes two instants in one picture.
#include <fmt/core.h>

#include <cstdlib>
#include <utility>

#include "adapters/cia402/drive.hpp"

namespace axisgate::cia402_drive {

void Drive::on_emergency(const canopen::Emergency& e, Turn& t) {
    if (!node_.presence.online()) return node_.presence.heard(t.now);
    const std::uint16_t number = node_.number_of(e.code);
    const ErrorCode* known = node_.catalogue().error(number);
    // An EMCY does not say of which axis it is: each that shows a fault then tells it by this code.
    for (const auto& a : axes_)
        a->on_error_code(number);
    if (!gate_.admits(e, t.now)) return;
    const auto left_out = gate_.take_kept_back();
    node_.notices.tell(e.code == 0 ? Severity::info : Severity::warning, first_axis(), "emergency", number,
                       fmt::format("EMCY {}{}{}", canopen::to_text(e), known ? ": " + known->text : "",
                                   left_out ? fmt::format(" ({} before it were left out)", left_out) : ""),
                       t.now, t.out);
}

void Drive::on_heartbeat(const Frame& f, Turn& t) {
    const auto news = heartbeat_.on_frame(f, t.now);
    Presence& presence = node_.presence;
    // Its answers may be one on the bus, where both send the same bits at the same time: heartbeats drift apart.
    if (news != canopen::NodeNews::started && double_beat_.beat(t.now)) tell_two_nodes("heartbeats come in the gaps of others", t);
    if (news == canopen::NodeNews::started) {
        double_beat_.restarted();
        for (const auto& a : axes_)
            a->restarted();
        if (presence.online() && !presence.is(Presence::Phase::restarting)) {
            forget(Reason::interrupted, "the drive has restarted", t);
            return presence.begin(t.now);
        }
    }
    presence.heard(t.now);
    // It has left the operational state by itself: no PDOs come, and its watch of the gateway may be what it tells of.
    if (news == canopen::NodeNews::state && heartbeat_.state() == canopen::NmtState::pre_operational &&
        presence.is(Presence::Phase::ready) && listeners() > 0)
        start();
}

bool Drive::on_pdo(const Frame& f, Turn& t) {
    for (const auto& place : axes_) {
        Axis& a = *place;
        const std::uint32_t shift = per_axis * static_cast<std::uint32_t>(a.place()) + node_.number;
        const bool status = canopen::is_data(f, status_base + shift);
        if (!status && !canopen::is_data(f, motion_base + shift)) continue;
        if (!a.listens()) {
            node_.presence.heard(t.now);
        } else if (status) {
            a.on_status(f.data(), t);
        } else {
            a.on_motion(f.data(), t);
        }
        return true;
    }
    if (axes_.empty() && (canopen::is_data(f, status_base + node_.number) || canopen::is_data(f, motion_base + node_.number)))
        return node_.presence.heard(t.now), true;
    return false;
}

/// Whatever was set up in it is gone, and so are its zero and what was ordered.
void Axis::restarted() {
    const auto place = known_.fb.position;
    known_.fb = {};
    known_.fb.position = place;
    known_.order = Order::none;
    known_.cw = 0;
}

void Axis::on_status(std::span<const std::uint8_t> b, Turn& t) {
    if (b.size() != 7) {
        ++node_.line.counters.garbled;
        return;
    }
    known_.fb.native_status = static_cast<std::uint32_t>(canopen::low_first(b.first(2)));
    known_.fb.position = signed_of(b.subspan(2, 4));
    known_.mode = static_cast<int>(signed_of(b.subspan(6, 1)));
    status_new_ = true;
    if (motion_new_) learnt(t);
}
void Axis::on_motion(std::span<const std::uint8_t> b, Turn& t) {
    if (b.size() != 8) {
        ++node_.line.counters.garbled;
        return;
    }
    known_.fb.velocity = signed_of(b.first(4));
    known_.fb.position_demand = signed_of(b.subspan(4, 4));
    motion_new_ = true;
    if (status_new_) learnt(t);
}

void Axis::learnt(Turn& t) {
    status_new_ = motion_new_ = false;
    deaf_ = 0;
    node_.presence.answered();
    ++node_.line.counters.exchanges;  // a SYNC is the question, both PDOs are the answer
    check_at_ = t.now + std::max<Duration>(3 * node_.line.cycle, std::chrono::milliseconds(150));
    judge(t);
}

void Axis::judge(Turn& t) {
    const unsigned sw = known_.fb.native_status, six = sw & 0x6Fu;
    const bool enabled = six == 0x27, quick = six == 0x07, reacting = (sw & 0x4Fu) == 0x0F, was_fault = known_.fb.fault;
    known_.fb.statusword = static_cast<std::uint16_t>(sw & 0x7Fu);
    known_.fb.power = enabled || quick || reacting ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    known_.fb.fault = (sw & 0x4Fu) == 0x08 || reacting;
    known_.fb.warning = sw & 0x80u;
    known_.fb.internal_limit = sw & 0x800u;
    known_.fb.quick_stopping = quick;
    known_.fb.demand_source = known_.fb.power == AxisFeedback::Power::on && !known_.fb.fault ? DemandSource::drive : DemandSource::none;
    const bool halted = known_.cw & 0x100u;
    if (!enabled || halted) {
        if (known_.order == Order::homing) known_.fb.homing = false;
        known_.order = Order::none;
    }
    if (!enabled) end_stream();
    if (known_.order == Order::homing) {
        if (known_.mode == 6 && (sw & 0x2000u)) known_.fb.homing = false, known_.fb.homing_error = true, known_.order = Order::none;
        if (known_.mode == 6 && (sw & 0x1000u) && (sw & 0x400u)) {
            known_.fb.homing = false;
            known_.fb.homing_attained = known_.fb.referenced = true;
            known_.order = Order::none;
        }
    }
    // Bit 10 of the motion before may stand in the first status after a new set-point: it counts from the second one on.
    const bool fresh = std::exchange(fresh_, fresh_ > 0 ? fresh_ - 1 : 0) > 0;
    known_.fb.target_reached = known_.order == Order::position && known_.mode == 1 && (sw & 0x400u) && !fresh;
    const bool on_its_way = (known_.order == Order::position && !known_.fb.target_reached) || known_.fb.homing;
    known_.fb.moving = known_.fb.velocity != 0 || on_its_way || (stream_ >= Stream::position && led_.velocity() != 0);
    if (known_.fb.power != AxisFeedback::Power::on) known_.fb.moving = known_.fb.velocity != 0;
    if (!known_.fb.fault) known_.fb.error_code = 0;
    if (known_.fb.fault && !was_fault && known_.fb.error_code == 0) {  // its EMCY was lost: the fault is told with its number
        need_code_ = true;
        return;
    }
    if (!need_code_) emit(t);
}

void Axis::emit(Turn& t) {
    known_.fb.at = t.now;
    t.out.feedback.push_back({id_, known_.fb});
}

}  // namespace axisgate::cia402_drive
