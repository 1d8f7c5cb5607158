// Together: one drive's share of a joint start.
// In: the adapter's orders, statuses. Out: whether it is ready, begun, ended (Bus::share_done).
// Never begins by itself: the BG is the adapter's.
#include <fmt/core.h>

#include "adapters/uim342/drive.hpp"

namespace axisgate::uim342 {

bool Together::is_place(const CommandBody& body) noexcept {
    const auto* together = std::get_if<StartTogether>(&body);
    return together && together->axes.empty();
}

bool Together::join() { return drive_.jobs.queue.push(Command{no_ticket, drive_.axis(), StartTogether{}, false, {}}); }

void Together::plan(const Command&, Turn& t) {
    job().waiting = true;
    drive_.bus.share_ready(drive_, t);
}

std::string Together::not_startable() const {
    const std::string& name = drive_.name();
    const Status& s = drive_.feedback.status();
    if (!drive_.presence.is(drive::Presence::Phase::ready)) return fmt::format("{} does not answer", name);
    if (!s.on) return fmt::format("{} is off", name);
    if (s.lock) return fmt::format("{} is locked", name);
    const bool ramp = drive_.stops.ramp() && drive_.feedback.fb().moving;
    return !drive_.stops.empty() || ramp ? fmt::format("{} is being stopped", name) : std::string();
}

void Together::begun(bool until_done, Turn& t) {
    if (drive_.jobs.is(*this)) (void)drive_.jobs.hand_over();
    broadcast_until_ = t.now + 4 * drive_.bus.timing.reply_timeout;  // it may wait in the line's queue behind other frames
    drive_.feedback.begin_motion(prepared_.value_or(Motion{Motion::Kind::unknown}), t);
    pending_ = true;
    until_done_ = until_done;
}

/// Asked behind the joint BG: had the drive refused that, its report would have come before this.
void Together::at_status(Instant sent, Turn& t) {
    const Motion& motion = drive_.feedback.motion();
    if (!pending_ || sent < motion.begun) return;
    broadcast_until_ = t.now;
    if (!until_done_) return over({true}, t);
    pending_ = false;
    drive_.waits.add({Waits::Until::share, no_ticket, motion.target}, t);
}

void Together::over(Share share, Turn& t) {
    if (std::exchange(pending_, false)) drive_.bus.share_done(drive_, std::move(share), t);
}

void Together::leave(Turn& t) {
    if (drive_.jobs.is(*this)) (void)drive_.jobs.hand_over();
    (void)drive_.jobs.queue.interrupt([](const Command& c) { return is_place(c.body); }, "", drive_.tickets, t);
    pending_ = false;
    drive_.waits.forget_share();
}

}  // namespace axisgate::uim342
