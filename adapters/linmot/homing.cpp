// Homing: the drive's own search (control word bit 11, done at StateVar 090Fh), or its place given a name (Master Homing).
// In: home commands, states. Out: control words. Never leaves the bit set when the search has ended.
#include <fmt/core.h>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

void Drive::begin_home(const Home& home, Turn& t) {
    if (status_.state() != state::enabled) {
        return end_job(Outcome::refused, Reason::wrong_state,
                       fmt::format("drive {} is in {}: enable it first", title(), in_error() ? error_text() : state_text()), t);
    }
    if (home.method == 35 || home.method == 37) {
        to_target_ = false;
        fb_.homing_attained = true;
        return begin_motion(*bus_.motions.named("009xh"), {std::int64_t{0}}, t);
    }
    if (home.method != 0)
        return end_job(Outcome::refused, Reason::not_supported,
                       "a LinMot drive homes as its parameters say: method 0; or where it stands: 35, 37", t);
}

std::optional<Telegram> Drive::home_request(Turn& t) {
    if (job_.step++ == 0) {
        fb_.homing_attained = fb_.homing_error = false;
        to_target_ = false;
        demand_.forget();
        return control(static_cast<std::uint16_t>(cw_on | cw_home));
    }
    if (status_.state() == state::homing) {
        homing_ = true;
        end_job(Outcome::accepted, Reason::none, {}, t);
        return std::nullopt;
    }
    if (in_error()) {
        fb_.homing_error = true;
        end_job(Outcome::refused, Reason::drive_refused, fmt::format("drive {}: {}", title(), error_text()), t, status_.sub_state());
        return std::nullopt;
    }
    if (job_.step > 6) {
        fb_.homing_error = true;
        (void)control(cw_on);
        end_job(Outcome::failed, Reason::drive_refused,
                fmt::format("drive {} does not begin to home; it stays in {}", title(), state_text()), t);
        return std::nullopt;
    }
    job_.not_before = t.now + std::chrono::milliseconds(10);
    return request(id_, Main::response, 1);
}

/// With each status: has the search ended, or was it ended?
void Drive::watch_homing(Turn& t) {
    if ((cw_ & cw_home) == 0) return;
    if (status_.state() == state::homing) {
        homing_ = true;
        if (status_.sub_state() != finished) return;
        homing_ = false;
        release_home_ = true;
        fb_.homing_attained = true;
        demand_.rest(static_cast<double>(status_.position));
        return;
    }
    if (homing_) {
        homing_ = false;
        fb_.homing_error = true;
        release_home_ = status_.state() == state::enabled;
        notices_.tell(Severity::warning, axis_, "homing", 0,
                      fmt::format("drive {} has not ended its homing; it is in {}", title(), state_text()), t.now, t.out);
    }
}

}  // namespace axisgate::linmot
