// Node: what is shown of its axis: the feedback that its polls and its own commands add up to.
// In: flags, positions and errors as they were read, the motion that this gateway began. Out: one feedback per reading.
// Never calls a target reached that the position has not reached.
#include <cstdlib>

#include "adapters/mcode/node.hpp"

namespace axisgate::mcode {

void Node::derive(Turn& t) {
    if (!de_) enabled_ = false;
    fb_.power = de_ && enabled_ ? AxisFeedback::Power::on : AxisFeedback::Power::off;
    // In torque mode V reads 0 whatever the shaft does [L5995].
    fb_.moving = mv_ && (fb_.velocity != 0 || vc_ || encoder_mode_ || torque_ || motion_.kind == Motion::Kind::home);
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
    if (motion_.kind == Motion::Kind::position && !fb_.moving && (!encoder_mode_ || !mv_)) {
        if (fb_.position == motion_.target ||
            (encoder_mode_ && !fb_.fault && std::llabs(fb_.position - motion_.target) <= 65000 && !mv_ && !ef_)) {
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

void Node::emit(Turn& t) {
    if (axis_ == no_axis || !seen_) return;
    fb_.at = t.now;
    fb_.homing = motion_.kind == Motion::Kind::home && (!motion_.ended || zero_after_home_);
    t.out.feedback.push_back({axis_, fb_});
}

}  // namespace axisgate::mcode
