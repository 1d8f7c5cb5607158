// Drive: what is shown of its axis: the feedback that its polls and its own commands add up to.
// In: flags, positions and errors as they were read, the motion that this gateway began. Out: one feedback per reading.
// Never calls a target reached that the position has not reached.
#include <algorithm>
#include <array>
#include <cstdlib>

#include "adapters/mcode/drive.hpp"

namespace axisgate::mcode {

bool is_fault_code(int code) noexcept {
    switch (code) {
        case 13:
        case 14:
        case 70:
        case 72:
        case 75:
        case 78:
        case 79:
        case 82:
        case 86:
        case 92:
        case 96:
        case 98:
        case 99:
        case 104:
        case 105:
        case 111:
            return true;
        default:
            return false;
    }
}

void Drive::derive(Turn& t) {
    if (!de_) enabled_ = false;
    fb_.power = de_ && enabled_ ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    // In torque mode V reads 0 whatever the shaft does [L5995].
    fb_.moving = mv_ && (fb_.velocity != 0 || vc_ || encoder_mode() || torque_ || motion_.kind == Motion::Kind::home);
    fb_.fault = fault_ != 0 || stalled_ || locked_;
    fb_.error_code = static_cast<std::uint16_t>(fault_ != 0 ? fault_ : stalled_ ? 86 : locked_ ? 104 : last_error_);
    fb_.internal_limit = last_error_ == 83 || last_error_ == 84;
    fb_.warning = last_error_ == 71 || fb_.internal_limit;
    fb_.native_status = (mv_ ? 1U : 0U) | (mp_ ? 2U : 0U) | (vc_ ? 4U : 0U) | (de_ ? 8U : 0U) | (ef_ ? 16U : 0U) | (running_ ? 32U : 0U) |
                        (stalled_ ? 64U : 0U) | (locked_ ? 128U : 0U) | (input_ ? 256U : 0U);
    if (motion_.ended) {
        if (fb_.moving) fb_.target_reached = false;  // a program, or somebody else, moves it
        return;
    }
    if (motion_.kind == Motion::Kind::position && !fb_.moving && (!encoder_mode() || !mv_)) {
        if (fb_.position == motion_.target ||
            (encoder_mode() && !fb_.fault && std::llabs(fb_.position - motion_.target) <= 65000 && !mv_ && !ef_)) {
            fb_.target_reached = true;
            motion_.ended = true;
        } else if (!mv_) {
            motion_.ended = true;
        }
    } else if (motion_.kind == Motion::Kind::home && !mv_) {
        motion_.ended = true;
        if (ef_ || fb_.fault) {
            fb_.homing_error = true;
        } else {
            zero_after_home_ = true;
            Command c;
            c.axis = axis_;
            c.body = SetPosition{0};
            queue_.push_front(std::move(c));
        }
    }
    (void)t;
}

/// Bridges that a fault has switched off hold nothing, although DE is 1 [L3983, L8452].
void Drive::take_demand(std::optional<std::int64_t> lag) {
    const bool bridges_off =
        (locked_ && !torque_) || fault_ == 13 || fault_ == 14 || fault_ == 72 || fault_ == 75 || fault_ == 79 || fault_ == 96;
    AxisDemand::Reading r;
    r.at = heard_at_;
    r.position = fb_.position;
    r.velocity = fb_.velocity;
    r.lag = lag;
    r.hmt = hmt_mode_;
    r.energised = de_ && !bridges_off;
    r.moving = mv_;
    r.changing = vc_;
    r.stalled = stalled_;
    r.program = running_;
    r.homing = motion_.kind == Motion::Kind::home && !motion_.ended;
    if (old_firmware_ && demand_.wants_shape()) demand_.shape(true);
    demand_.read(r, fb_);
}

void Drive::demand_lost() noexcept {
    demand_.lost();
    fb_.demand_source = DemandSource::none;
    hmt_mode_ = 0;
    shape_refused_ = program_ran_ = false;
}

/// A step's line: the drive took it, or nobody knows, or it was refused. Somebody's text may be known too, but its moves are not ours.
void Drive::step_said(const Step& step, Verdict v) {
    if (v == Verdict::refused) return demand_.refused();
    program_told(step.text);
    if (v == Verdict::waiting || v == Verdict::garbled) return demand_.doubt(step.text);
    const bool ours =
        job_.kind == JobKind::move || job_.kind == JobKind::home || job_.kind == JobKind::set_position || job_.kind == JobKind::write;
    demand_.said(step.text, heard_at_, ours);
    const auto w = word_of(step.text);
    if (w == "EX") program_ran_ = true;
    // Said by somebody: what the next move would find is read anew.
    constexpr std::array<std::string_view, 10> values{"VI", "VM", "A", "D", "EE", "AS", "MS", "IP", "IC", "DC"};
    if (!ours && std::ranges::find(values, w) != values.end()) relearn_ = true;
}

/// LL is a luxury: a drive that does not answer such polls is asked without it, before it counts as away.
void Drive::lag_missed(Instant now) noexcept {
    if (!asks_lag_) return;
    lag_misses_ = std::min(lag_misses_ + 1, 2);
    lag_again_ = now + std::chrono::seconds(10);
}

void Drive::emit(Turn& t) {
    if (axis_ == no_axis || !seen_) return;
    fb_.at = read_at_;  // what an acknowledgement or an error code adds is newer
    fb_.homing = motion_.kind == Motion::Kind::home && (!motion_.ended || zero_after_home_);
    t.out.feedback.push_back({axis_, fb_});
    if (fb_.power != AxisFeedback::Power::on) {
        // DE is 1 from the factory: as long as this gateway has not enabled it the axis is shown as off, and nobody wants it anywhere.
        AxisFeedback& shown = t.out.feedback.back().value;
        shown.demand_source = DemandSource::none;
        shown.position_demand = shown.position;
    }
}

}  // namespace axisgate::mcode
