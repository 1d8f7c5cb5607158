#include "adapters/cia402/drive_handshake.hpp"

#include <fmt/core.h>

#include <cstdlib>

#include "adapters/cia402/drive_words.hpp"

namespace axisgate::cia402_drive {
namespace {
/// CiA 402-2, homing mode: bits 13, 12 and 10 are 0 while homing is in progress; bit 12 without a search before means that it has ended
/// already.
bool homing_begun(const AxisKnown& known, const Job& job, unsigned sw, Instant now) {
    const bool was_attained = job.status & 0x1000u, attained = sw & 0x1000u;
    if (sw & 0x2000u) return true;
    if (!attained) return (sw & 0x400u) == 0;
    if (!was_attained || job.begun) return true;
    const auto* home = std::get_if<Home>(&job.command.body);
    const auto method = home && home->method != 0 ? home->method : known.homing_method;
    return (method == 35 || method == 37) && now >= *job.went + std::chrono::milliseconds(100);  // it ends where it begins
}
}  // namespace

void word_taken(AxisKnown& known, Job& job, const Step& s, Instant now) {
    const auto word = static_cast<std::uint16_t>(canopen::low_first(s.bytes));
    if ((known.cw & start_bit) != 0 && (word & start_bit) == 0) known.low_since = now;
    known.cw = word;
    if ((word & 0x0Fu) != 0x0F) known.left_at = now;
    if (!s.edge) return;
    job.went = now;
    job.from = known.fb.position;
    job.turned = known.turns();
    known.acknowledged = false;
}

bool met(AxisKnown& known, Job& job, const Step& s, const canopen::SdoEnd& end, Instant now) {
    const auto raw = canopen::low_first(end.data);
    if (s.awaits == Step::Awaits::homing) return homing_begun(known, job, static_cast<unsigned>(raw), now);
    if (s.awaits == Step::Awaits::off) return false;
    const bool shown = (raw & s.mask) == s.want;
    if (shown && s.awaits == Step::Awaits::mode) known.mode = static_cast<int>(signed_of(end.data));
    if (shown && s.awaits == Step::Awaits::release) job.released = known.acknowledged;
    if (s.awaits != Step::Awaits::acknowledge) return shown;
    known.acknowledged = shown;
    if (shown) known.no_acknowledge = false;
    // If the drive has started a motion without acknowledgement before, the acknowledgement is not awaited.
    const bool known_to_move = known.no_acknowledge && now >= *job.went + std::chrono::milliseconds(50) && has_begun(known, job);
    if (!shown && known_to_move) unacknowledged(job);
    return shown || known_to_move;
}

bool has_begun(const AxisKnown& known, const Job& job) {
    const auto* m = std::get_if<Move>(&job.command.body);
    if (!m) return false;
    const std::int64_t target = m->target + (m->kind == Move::Kind::relative ? job.here : 0), way = std::llabs(target - job.from);
    if (way == 0 || 2 * std::llabs(known.fb.position - target) < way) return true;
    return known.turns() && (!job.turned || known.no_acknowledge);
}
void unacknowledged(Job& job) {
    job.text = "the drive does not set status bit 12 (set-point acknowledge); the axis shows that it has taken the set-point";
}

std::string not_met(const AxisKnown& known, const Step& s, const canopen::SdoEnd& end) {
    const auto ms = milliseconds_of(s.patience);
    const auto raw = static_cast<std::uint16_t>(canopen::low_first(end.data));
    switch (s.awaits) {
        case Step::Awaits::mode:
            return fmt::format(
                "the drive has taken mode {} (6060h) twice, and still shows mode {} (6061h) {} ms after the second time: nothing was "
                "begun. Where it needs longer, set its option mode_timeout_ms",
                static_cast<int>(static_cast<std::int8_t>(s.want)), signed_of(end.data), ms);
        case Step::Awaits::release:
            return fmt::format("the drive still acknowledges the set-point before after {} ms, so that it takes no other one: {}", ms,
                               status_in_words(raw, known.mode));
        case Step::Awaits::acknowledge:
        case Step::Awaits::homing:
            return fmt::format("the drive has not begun within {} ms: {}. Where it needs longer, set its option start_timeout_ms", ms,
                               status_in_words(raw, known.mode));
        case Step::Awaits::value:
        case Step::Awaits::off:
            break;
    }
    return "the drive has acknowledged, and " + (s.away_from ? fmt::format("still shows position {}", signed_of(end.data))
                                                             : "stays in another state: " + status_in_words(raw, known.mode));
}

}  // namespace axisgate::cia402_drive
