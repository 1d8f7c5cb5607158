// Fills the picture of an axis from its parts, without allocating memory.
#include <algorithm>

#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/publisher.hpp"

namespace axisgate::engine {

void Publisher::publish(Axis& a, Instant now) {
    AxisPicture& p = machine_.image.picture(a.id);
    a.profile.fill(p);
    p.number = static_cast<std::uint16_t>(a.spec.number);
    p.family_number = a.drive->catalogue->number();
    p.source = a.source;
    p.authority = a.authority.door();
    p.authority_since = a.authority.since();
    p.authority_until = a.authority.until();
    const auto write = [](std::array<char, 64>& into, std::string_view text) {
        into.fill(0);
        std::copy_n(text.begin(), std::min(text.size(), into.size() - 1), into.begin());
    };
    if (a.authority_shown != a.authority.revision()) {
        a.authority_shown = a.authority.revision();
        write(p.authority_holder, a.authority.holder().name);
        write(p.authority_commander, a.authority.commander().door == Door::none ? std::string() : a.authority.commander().text());
    }
    // An axis is online when it can be commanded: its drive answers and has reported its position.
    const bool answers = a.drive->answers();
    const bool online = answers && p.current;
    p.presence = answers ? a.drive->serving : Presence::offline;  // like the status of the drive
    const auto put = [](std::uint16_t& word, std::uint16_t bit, bool on) {
        word = on ? static_cast<std::uint16_t>(word | bit) : static_cast<std::uint16_t>(word & ~bit);
    };
    const bool simulated = a.drive->serving == Presence::twin || a.profile.feedback().simulated, stale = a.stale || !online;
    put(p.flags, flag_online, online);
    if (a.at_limit) p.statusword |= cia402::sw_internal_limit;
    p.fail_safe_cause = static_cast<std::uint16_t>(a.latch.cause);
    if (p.stop_latch != a.latch.bits || a.latch_shown != a.latch.by) {
        p.stop_latch = a.latch.bits;
        a.latch_shown = a.latch.by;
        write(p.stop_latch_by, a.latch.bits & StopLatch::by_client ? a.latch.by.text() : std::string());
    }
    p.streaming = a.stream.on;
    p.stream_mode = a.stream.mode;
    p.set_points = a.stream.taken;
    p.set_points_refused = a.stream.refused;
    p.set_point_refusal = a.stream.refusal;
    put(p.flags, flag_fail_safe, a.latch.cause != LossCause::none);
    put(p.flags, flag_simulated, simulated);
    put(p.flags, flag_stale, stale);
    put(p.statusword, cia402::sw_simulated, simulated);
    put(p.statusword, cia402::sw_stale, stale);
    if (p.flags & flag_moving) machine_.last_stir = now;
    machine_.image.publish(a.id);
    if (tap_) tap_->picture(a.id, p, now);
}

void Publisher::event(Event e, Instant now) {
    if (tap_) tap_->event(e, now);
    host_.on_event(std::move(e), now);
}

void Publisher::answer(const Result& result) {
    if (tap_) tap_->result(result, machine_.now);
    host_.on_result(result);
}

void Publisher::refuse(const Command& c, Reason reason, std::string text) {
    Result r;
    r.ticket = c.ticket;
    r.axis = c.axis;
    r.outcome = Outcome::refused;
    r.reason = reason;
    r.text = std::move(text);
    answer(r);
}

void Publisher::sample(const Sample& sample, Instant now) {
    if (tap_) tap_->sample(sample, now);
    host_.on_sample(sample);
}

/// Another drive, channel or twin serves the axis: earlier feedback becomes invalid, here and for the readers of the image.
void Publisher::new_source(Axis& a) {
    a.source = ++sources_;
    a.reported.clear();
    machine_.image.picture(a.id).source = a.source;
    machine_.image.publish(a.id);
}

}  // namespace axisgate::engine
