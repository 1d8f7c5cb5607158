// What is learnt from a default response: the axis' picture, alarms, samples of the drive's own words.
// In: status word, StateVar, position. Out: feedback, samples, notices. Never shows what the drive did not say; the speed is the change of
// its position over the last tenth of a second.
#include <fmt/core.h>

#include <cmath>

#include "adapters/linmot/drive.hpp"

namespace axisgate::linmot {

bool Drive::in_error() const noexcept { return status_.state() == state::error || status_.state() == state::setup_error; }

std::string Drive::error_text() const {
    const std::uint8_t code = status_.sub_state();
    const ErrorCode* e = bus_.catalogue.error(code);
    if (!e) return fmt::format("error {:02X}h, which is in no list of the motion control software", code);
    return fmt::format("error {:04X}h, {}: {} {}", code, e->text, e->cause, e->remedy);
}

std::string Drive::state_text() const {
    const auto* list = bus_.catalogue.document().if_contains("states");
    for (const auto& s : list->get_array()) {
        if (s.get_object().at("code").as_int64() == status_.state())
            return fmt::format("state {}, {}", status_.state(), std::string_view(s.get_object().at("name").as_string()));
    }
    return fmt::format("state {}", status_.state());
}

void Drive::sample(std::string_view id, Value value, Turn& t) {
    if (const auto point = bus_.catalogue.find(id)) t.out.samples.push_back({axis_, *point, std::move(value), Quality::good, t.now, 0});
}

void Drive::learn(const Status& s, Turn& t) {
    const bool first = !status_known_;
    const Status before = status_;
    status_ = s;
    status_known_ = true;
    motion_fresh_ = false;
    if (s.state() == state::enabled && !(job_.active && job_.number == -1)) count_ = s.sub_state() & 0x0F;
    if (!cw_known_) {
        // After a restart of the gateway: the control word as the status word shows it [O-27].
        cw_ = static_cast<std::uint16_t>(0x0030 | (s.bit(1) ? 1 : 0) | (s.bit(4) ? 2 : 0) | (s.bit(5) ? 4 : 0) | (s.bit(2) ? 8 : 0) |
                                         (s.state() == state::homing ? cw_home : 0));
        if (s.state() == state::aborting) cw_ = static_cast<std::uint16_t>(cw_ & ~cw_abort);
        cw_known_ = true;
    }
    if (in_error()) {
        if (told_error_ != s.sub_state()) {
            told_error_ = s.sub_state();
            notices_.tell(Severity::alarm, axis_, "alarm", s.sub_state(), fmt::format("drive {}: {}", title(), error_text()), t.now, t.out);
        }
        if (homing_) fb_.homing_error = true;
        homing_ = false;
        to_target_ = false;
    } else {
        told_error_ = 0;
    }
    if (!first && s.state() == state::not_ready && before.state() > state::disabled && job_.active == false && cw_ != cw_off) {
        notices_.tell(Severity::warning, axis_, "presence", 0, fmt::format("drive {} has restarted", title()), t.now, t.out);
        cw_ = cw_off;
    }
    track_.emplace_back(t.now, s.position);
    while (track_.size() > 2 && t.now - track_.front().first > std::chrono::milliseconds(100))
        track_.pop_front();
    watch_homing(t);
    tell(t);
    if (axis_ == no_axis) return;
    if (first || before.status != s.status) sample("StatusWord", std::int64_t{s.status}, t);
    if (first || before.state_var != s.state_var) sample("StateVar", std::int64_t{s.state_var}, t);
}

void Drive::tell(Turn& t) {
    if (axis_ == no_axis || !status_known_) return;
    const Status& s = status_;
    const std::uint8_t main = s.state(), sub = s.sub_state();
    fb_.power = main >= state::enabled ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    fb_.fault = in_error();
    fb_.warning = s.bit(bit::warning);
    fb_.referenced = s.bit(bit::homed);
    fb_.error_code = in_error() ? sub : std::uint16_t{0};
    fb_.internal_limit = fb_.fault && (sub == 0x07 || sub == 0x08 || sub == 0x87 || sub == 0x88);
    fb_.quick_stopping = main == state::aborting || main == state::quick_stop;
    // Its own state, as CiA 402 codes it. Not below: there it follows from the control word that this gateway keeps, not from a client's.
    const bool standing_by = main == state::tests || main == state::ready_to_operate;
    fb_.statusword = fb_.quick_stopping       ? std::optional<std::uint16_t>(0x0007)
                     : main >= state::enabled ? std::optional<std::uint16_t>(0x0027)
                     : standing_by            ? std::optional<std::uint16_t>(0x0023)
                                              : std::nullopt;
    fb_.homing = main == state::homing && sub != finished;
    const bool own_motion = (main == state::homing || main == 10 || main == state::initial || main == 15) && sub != finished;
    const bool braking = main == state::aborting || main == state::freezing || main == state::quick_stop;
    const bool shifts = track_.size() > 1 && std::abs(std::int64_t{track_.back().second} - (track_.end() - 2)->second) > 10;
    fb_.moving =
        main >= state::enabled && (s.bit(bit::moving) || own_motion || ((main == 16 || main == 17) && sub == 1) || (braking && shifts));
    fb_.position = s.position;
    fb_.velocity = 0;
    if (fb_.moving && track_.size() > 1) {
        const double dt = seconds(track_.back().first - track_.front().first);
        if (dt > 0) fb_.velocity = std::llround((double{1} * track_.back().second - track_.front().second) / dt);
    }
    if (!fb_.moving && track_.size() > 1) track_.erase(track_.begin(), track_.end() - 1);
    fb_.target_reached = to_target_ && !motion_fresh_ && !fb_.moving && s.bit(bit::in_target) && main == state::enabled;
    fb_.native_status = std::uint32_t{s.state_var} << 16 | s.status;
    fb_.at = t.now;
    demand_at_status(t);
    t.out.feedback.push_back({axis_, fb_});
}

}  // namespace axisgate::linmot
