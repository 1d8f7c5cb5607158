// Passes frames to the adapters that use their identifiers, and distributes the output of an adapter's call; the order of the distribution
// is fixed in `drain`. Feedback and samples of a side that does not serve the drive are ignored.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/clients.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/loss_of_command.hpp"
#include "gateway/engine/motions.hpp"
#include "gateway/engine/orders.hpp"
#include "gateway/engine/presences.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/routing.hpp"
#include "gateway/engine/scans.hpp"
#include "gateway/engine/streams.hpp"
#include "gateway/engine/supervisor.hpp"

namespace axisgate::engine {

void Side::on_frame(const Frame& frame) { routing.received(*this, frame); }
void Side::on_sent(const Frame& frame) { routing.sent(*this, frame); }
void Side::on_line_state(bool now_up, const std::string& text) { routing.line_state(*this, now_up, text); }

void Routing::received(Side& side, const Frame& frame) {
    machine_.now = std::max(machine_.now, frame.at);
    side.unit.log->record(frame, false, side.twin);
    if (FlightTap* tap = publisher_.tap()) tap->frame(side.unit.id, frame, false, side.twin);
    bool was_taken = false;
    for (std::size_t i = 0; i < side.speakers.size(); ++i) {
        Speaker& s = *side.speakers[i];
        if (!s.receives(frame)) continue;
        was_taken = true;
        ask(s, machine_.now, [&](Out& out) { s.adapter->on_frame(frame, machine_.now, out); });
    }
    if (!was_taken) {
        ++side.unclaimed;
        side.touched();
    }
}

void Routing::sent(Side& side, const Frame& frame) {
    side.unit.log->record(frame, true, side.twin);
    if (FlightTap* tap = publisher_.tap()) tap->frame(side.unit.id, frame, true, side.twin);
    auto& f = side.followed;
    if (f.handed_on && f.frame.same(frame)) {
        write_to_frame_.observe(frame.at - f.since);
        f.ticket = no_ticket;
        f.handed_on = false;
    }
}

void Routing::line_state(Side& side, bool up, const std::string& why) {
    if (FlightTap* tap = publisher_.tap(); tap && !side.twin) tap->line_state(side.unit.id, up, why, machine_.now);
    presences_.line_state(side, up, why, machine_.now);
}

/// Distributes the output of one call of an adapter. Feedback is applied before results, so that a client that gets "accepted" finds the
/// new state in the image.
void Routing::drain(Speaker& by, Out& out, Instant now) {
    Side& side = by.side;
    side.touched();
    for (const auto& n : out.notices) {  // the reason of a failed homing must be known before the feedback reports the failure
        if (Axis* a = n.kind == "homing" ? machine_.axis(n.axis) : nullptr) a->homing_why = n.text;
    }
    for (auto& tx : out.frames) {
        tx.frame.sender = by.number;
        if (FlightTap* tap = publisher_.tap()) tap->handed(side.unit.id, tx.frame, side.twin, orders_.client_of(tx.order), now);
        const bool taken = side.line->send(tx.frame, tx.priority, now);  // the line counts frames that a full queue refuses
        if (publisher_.tap() && !taken && !side.twin) publisher_.tap()->send_refused(side.unit.id, now);
        if (auto& f = side.followed; taken && f.ticket != no_ticket && !f.handed_on && tx.priority != Priority::poll) {
            f.handed_on = true;
            f.frame = tx.frame;
        }
    }
    for (const auto& l : out.links)
        presences_.link(side, l, now);
    for (const auto& f : out.feedback)
        feedback(side, f.axis, f.value, now);
    const Presence mine = side.twin ? Presence::twin : Presence::device;
    for (auto& s : out.samples) {
        Axis* a = machine_.axis(s.axis);
        if (!a || a->drive->serving != mine) continue;
        s.source = a->source;
        a->reported[s.point] = s.value;
        publisher_.sample(s, now);
    }
    for (const auto& n : out.notices) {
        if (Scans::is_probe(n.drive)) continue;  // the report of the scan contains the notice
        const Axis* a = machine_.axis(n.axis);
        const Drive* d = a ? a->drive : machine_.drive(n.drive);
        if (d && d->serving != mine) continue;
        Event e;
        e.severity = n.severity;
        e.kind = n.kind;
        e.code = n.code;
        e.text = n.text;
        e.axis = a ? a->spec.name : "";
        e.drive = d ? d->spec.name : "";
        e.line = side.unit.spec.name;
        publisher_.event(std::move(e), now);
    }
    for (const auto& r : out.results)
        orders_.result(r, now);
    for (const auto& end : out.stream_ends)
        streams_.refused(side, end, now);
}

void Routing::feedback(Side& side, AxisId id, const AxisFeedback& value, Instant now) {
    Axis* a = machine_.axis(id);
    if (!a || a->drive->serving != (side.twin ? Presence::twin : Presence::device)) return;
    const bool first = !machine_.image.picture(id).current;
    auto next = a->profile.on_feedback(value, now);
    a->stale = now - value.at > a->drive->line->stale_after;
    if (first) a->last_deceleration = 0;  // its power may have been off
    if (a->profile.feedback().moving || first) a->rests_from.reset();
    if (!a->profile.feedback().moving && !a->rests_from) a->rests_from = value.at;
    if (bool& lost = a->drive->device_lost_while_commanded; lost && !side.twin) {
        // The drive has returned and has reported that no motion is in progress: its next silence is judged by its state then.
        lost = std::ranges::any_of(a->drive->axes, [&](AxisId x) {
            const auto& p = machine_.axes[index_of(x)]->profile;
            return p.commanded() || p.state() == PowerState::not_ready_to_switch_on;
        });
    }
    motions_.look(*a, now);
    if (a->lost_line) loss_.act(*a, LossCause::line_lost, now);
    if (value.fault != a->was_fault || (value.fault && value.error_code != a->last_error)) {
        Event e;
        e.axis = a->spec.name;
        e.drive = a->drive->spec.name;
        e.code = value.error_code;
        if (value.fault) {
            const ErrorCode* known = a->drive->catalogue->error(value.error_code);
            e.severity = Severity::alarm;
            e.kind = "fault";
            e.text = known                   ? fmt::format("fault {}: {}", value.error_code, known->text)
                     : value.error_code != 0 ? fmt::format("fault, drive's code {}", value.error_code)
                                             : "fault; the drive gives no number for it";
        } else {
            e.kind = "fault_cleared";
            e.text = "the fault is cleared";
            e.code = a->last_error;
        }
        a->was_fault = value.fault;
        a->last_error = value.error_code;
        publisher_.event(std::move(e), now);
    }
    if (a->stream.on && a->profile.state() != PowerState::operation_enabled)
        streams_.end(*a, Reason::wrong_state, fmt::format("the axis is {} now", name_of(a->profile.state())), now);
    supervisor_.look(*a, now);
    publisher_.publish(*a, now);
    if (next) {
        if (std::holds_alternative<QuickStop>(*next)) {
            Event e;
            e.severity = Severity::warning;
            e.kind = "fault_reaction";
            e.axis = a->spec.name;
            e.code = value.error_code;
            e.text = "the drive reports a fault and still moves: it is stopped";
            publisher_.event(std::move(e), now);
        }
        orders_.give(*a, nullptr, std::move(*next), a->waiting, now);
    }
    clients_.track(*a, now);
}

}  // namespace axisgate::engine
