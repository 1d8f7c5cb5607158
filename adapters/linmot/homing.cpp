// Either the drive searches its home position (control word bit 11, complete at StateVar 090Fh), or the present position is redefined
// (Master Homing). The bit is always reset when the search has ended.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

void Homing::begin(Turn& t) {
    const Feedback& feedback = drive_.feedback;
    const std::int16_t method = std::get<Home>(job().command.body).method;
    if (feedback.status().state() != state::enabled)
        return refuse(Reason::wrong_state, fmt::format("drive {} is in {}: enable it first", drive_.title(), feedback.error_or_state()), t);
    if (method == 35 || method == 37) {
        drive_.motion.no_target();
        drive_.feedback.homing_attained();
        return drive_.motion.begin_motion(*drive_.bus.motions.named("009xh"), {std::int64_t{0}});
    }
    if (method != 0) refuse(Reason::not_supported, "a LinMot drive homes as its parameters say: method 0; or where it stands: 35, 37", t);
}

std::optional<Telegram> Homing::request(Turn& t) {
    Feedback& feedback = drive_.feedback;
    if (job().step++ == 0) {
        feedback.homing_begins();
        drive_.motion.no_target();
        drive_.demand.forget();
        job().limit = t.now + shown_within;
        return drive_.control.write(static_cast<std::uint16_t>(cw_on | cw_home));
    }
    if (feedback.status().state() == state::homing) {
        searching_ = true;
        accept({}, t);
        return std::nullopt;
    }
    if (feedback.in_error()) {
        feedback.homing_failed();
        return refused(Reason::drive_refused, fmt::format("drive {}: {}", drive_.title(), feedback.error_text()), t,
                       feedback.status().sub_state());
    }
    if (job().step > 6 && t.now >= job().limit) {
        feedback.homing_failed();
        release_ = true;  // a search that begins after this answer must not go on
        fail(Reason::drive_refused, fmt::format("drive {} does not begin to home; it stays in {}", drive_.title(), feedback.state_text()),
             t);
        return std::nullopt;
    }
    job().not_before = t.now + std::chrono::milliseconds(10);
    if (job().step % 6 == 0) return drive_.control.write(static_cast<std::uint16_t>(cw_on | cw_home));
    return linmot::request(drive_.id(), Main::response, 1);
}

void Homing::watch(Turn& t) {
    Feedback& feedback = drive_.feedback;
    const Status& s = feedback.status();
    if (s.state() != state::homing) ended_at_.reset();
    if ((drive_.control.word() & cw_home) == 0) return;
    if (s.state() == state::homing) {
        searching_ = s.sub_state() != finished;
        if (searching_) return;
        release_ = true;
        if (!ended_at_) ended_at_ = t.now;
        feedback.homing_attained();
        return drive_.demand.rest(s.position);
    }
    if (!std::exchange(searching_, false)) return;
    feedback.homing_failed();
    release_ = s.state() == state::enabled;
    drive_.notice(Severity::warning, "homing", 0,
                  fmt::format("drive {} has not ended its homing; it is in {}", drive_.title(), feedback.state_text()), t);
}

void Homing::release(Turn& t) {
    release_ = false;
    drive_.exchanges.send({drive_.control.write(static_cast<std::uint16_t>(drive_.control.word() & ~cw_home)), Purpose::release}, t);
}

}  // namespace axisgate::linmot
