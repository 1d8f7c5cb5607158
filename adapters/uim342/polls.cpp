// Polls: one read per place on the line.
// In: what is due. Out: an exchange, or none.
// Never two polls at once for what was missed.
#include "adapters/uim342/polls.hpp"

#include "adapters/uim342/drive.hpp"

namespace axisgate::uim342 {

void Polls::begin(Instant now) noexcept { timer_.begin(now, drive_.bus.timing.poll_period, drive_.slot()); }

void Polls::stop() noexcept {
    timer_.stop();
    speed_next_ = false;
    drive_.errors.no_read();
}

bool Polls::overdue(Instant now) const noexcept { return command_last_ && timer_.late(now, drive_.bus.timing.poll_period); }

bool Polls::wants(Instant now) const noexcept {
    return speed_next_ || timer_.due(now) || drive_.errors.to_read() || drive_.start.reading().pending();
}

void Polls::go(Turn& t) {
    if (drive_.errors.to_read()) return drive_.errors.read(t);
    // The rest of the reading goes between polls; on a line that is too slow for all of them, in turn with them.
    const bool due = speed_next_ || timer_.due(t.now);
    if (drive_.start.reading().pending() && (!due || list_turn_)) {
        list_turn_ = false;
        return drive_.start.read_next(t);
    }
    list_turn_ = true;
    if (!due) return;
    command_last_ = false;
    const Message m = drive_.get(cw::MS, speed_next_ ? 1 : 0);
    const bool moves = drive_.feedback.fb().moving || drive_.homing.under_way() || !drive_.jobs.idle();
    if (!speed_next_) timer_.asked(t.now, pace_.period(drive_.bus.timing.poll_period, moves));
    speed_next_ = !speed_next_;
    if (!drive_.exchanges.makes_way(m, 0, Priority::poll, t)) drive_.exchanges.send({m, Purpose::poll}, 0, Priority::poll, t);
}

}  // namespace axisgate::uim342
