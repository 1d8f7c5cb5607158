// Targets stay within the position limits (607Dh), speeds and torques within those of the objects.
#include "adapters/cia402/twin/orders.hpp"

#include <algorithm>
#include <cmath>

namespace axisgate::cia402_drive::twin {

void Orders::reset(int mode) {
    mode_ = mode;
    halted_ = reached_ = acknowledged_ = limited_ = false;
    forget();
}
void Orders::forget() {
    step_.reset();
    reading_.reset();
    inside_.reset();
    target_.reset();
    buffered_.reset();
}
void Orders::enabled(unsigned cw) {
    halted_ = (cw & 0x100u) != 0;
    acknowledged_ = (cw & 0x10u) != 0;
    reached_ = false;
}
void Orders::taken_off() {
    forget();
    halted_ = false;
}
bool Orders::set_mode(int mode) {
    if (mode == mode_ || mode == 0) return false;
    mode_ = mode;
    forget();
    reached_ = acknowledged_ = false;
    return true;
}

void Orders::act(Instant now) {
    if (halted_) return;
    limited_ = false;
    if (mode_ == 3 || mode_ == 9) {
        const auto [low, high] = u_.limits();
        const double most = u_.fastest(), v = std::clamp(u_.velocity_of(0x60FF), -most, most);
        Ramps r = u_.ramps();
        if (mode_ == 9) {
            r.up = r.down = 1e7;
            r.shape = Shape::linear;
        }
        r.velocity = std::fabs(v);
        if (low < high && v != 0) {  // towards a position limit, the motion is a positioning to that limit
            const double end = v > 0 ? high : low;
            if ((end - m_.demand(now).position) * v <= 0) {
                limited_ = true;
                r.velocity = 0;
                return m_.stop(r, now);
            }
            return m_.move(end, r, now);
        }
        m_.run(v, r, now);
    }
    if (mode_ == 4 || mode_ == 10) {
        const auto most = std::min<std::int64_t>(o_.get(0x6072), 5000);
        // In mode 4 the torque follows its slope (6087h); in mode 10 it follows the target at once.
        m_.push(static_cast<double>(std::clamp<std::int64_t>(o_.get(0x6071), -most, most)) * per_mille,
                mode_ == 4 ? o_.rate(0x6087) * per_mille : 0, std::min(u_.speed_of(0x6080), 100'000.0), now);
    }
}

double Orders::target_time() const {
    const Duration between = sync_time();
    if (!knows_target_time && between > Duration::zero()) return seconds(between);
    return static_cast<double>(o_.get(0x60C2, 1)) * std::pow(10.0, static_cast<double>(o_.get(0x60C2, 2)));
}
Duration Orders::sync_time() const {
    const Duration period = std::chrono::microseconds(o_.of_node(0x1006));
    return period > Duration::zero() ? period : between_syncs_;
}

void Orders::sync(unsigned cw, Instant now) {
    constexpr Duration pause = std::chrono::milliseconds(500);  // of a master that has begun anew
    between_syncs_ = sync_at_ == never || now - sync_at_ > pause ? Duration::zero() : now - sync_at_;
    sync_at_ = now;
    if ((mode_ != 8 && mode_ != 7) || halted_) return;
    if (mode_ == 7 && (cw & 0x10u) == 0) return;
    const auto [low, high] = u_.limits();
    double to = mode_ == 8 ? u_.place_of(0x607A) : u_.place_of(0x60C1, 1);
    limited_ = low < high && (to < low || to > high);
    if (low < high) to = std::clamp(to, low, high);
    // 60C2h is the time between two targets: SYNCs may come more often, and a SYNC without a new target continues the last step.
    const double time = target_time();
    const bool on_its_way = step_ && step_->to == to && seconds(now - step_->at) < time - std::min(time / 4, 0.0005);
    if (on_its_way) return;
    step_ = Step{to, now};
    const auto at = m_.demand(now);
    if (at.position == to && at.velocity == 0) return;  // it stays where it is, and does not move
    m_.step_to(to, time, now);
}

void Orders::set_point(bool relative, bool at_once, Instant now) {
    double to = u_.place_of(0x607A);
    if (relative) to += buffered_.value_or(target_.value_or(m_.demand(now).position)) - u_.zero();
    const auto [low, high] = u_.limits();
    limited_ = low < high && (to < low || to > high);
    if (low < high) to = std::clamp(to, low, high);
    acknowledged_ = true;
    reached_ = false;
    reading_.reset();
    inside_.reset();
    if (!at_once && target_ && m_.moves(now)) {
        buffered_ = to;
        return;
    }
    target_ = to;
    go(now);
}
void Orders::go(Instant now) {
    const Ramps r = u_.ramps();
    if (target_ && r.velocity > 0 && !halted_) m_.move(*target_, r, now);
}

void Orders::halt(bool on, Instant now) {
    halted_ = on;
    step_.reset();
    if (on) {
        if (m_.moves(now)) m_.stop(u_.braking(o_.get(0x605D)), now);
        return;
    }
    if (mode_ == 1 && target_ && !reached_) go(now);
    act(now);
}

std::optional<Instant> Orders::arrival() const {
    // A positioning that was halted waits for the end of the halt and has no event of its own.
    if (!target_ || reached_ || halted_) return std::nullopt;
    if (readings_within && !buffered_) {  // an axis that is blocked outside the window needs no check
        if (reading_) return reading_at_ + window_time();
        if (settles() || m_.misreads()) return std::max(m_.end(), reading_at_ + std::chrono::milliseconds(1));
    }
    if (m_.differs() && !m_.held() && !buffered_) {
        constexpr Duration often = std::chrono::milliseconds(4), seldom = std::chrono::milliseconds(50), usual = std::chrono::seconds(1);
        return std::max(m_.end(), looked_at_ + (looked_at_ < m_.end() + usual ? often : seldom));
    }
    if (!settles()) return std::nullopt;
    return m_.end() + (buffered_ ? Duration{} : window_time());
}
void Orders::arrive(unsigned cw, Instant at) {
    if (halted_) return;
    if (readings_within && target_ && !reached_ && !buffered_ && m_.demand(at).position == *target_) return take_reading(at);
    if (target_ && !reached_ && !buffered_ && m_.differs() && !m_.held() && m_.demand(at).position == *target_) return take_look(at);
    if (target_ && !reached_ && settles() && m_.demand(at).position == *target_) {
        if (buffered_) {
            target_ = std::exchange(buffered_, std::nullopt);
            acknowledged_ = (cw & 0x10u) != 0;
            return go(at);
        }
        reached_ = at >= m_.end() + window_time();
    } else if (target_ && !reached_ && !m_.held() && settles()) {
        target_.reset();  // it has stopped before the target: halt, or speed 0
    }
}

void Orders::take_reading(Instant at) {
    if (reading_ && at < reading_at_ + window_time()) return;
    const double here = m_.read(at);
    reached_ = reading_ && in_window(at) && std::fabs(here - *reading_) < *readings_within;
    reading_ = !reached_ && in_window(at) ? std::optional(here) : std::nullopt;
    reading_at_ = at;
}
void Orders::take_look(Instant at) {
    looked_at_ = at;
    if (!in_window(at)) return inside_.reset();
    if (!inside_) inside_ = at;
    reached_ = at >= *inside_ + window_time();
}
bool Orders::in_window(Instant at) const {
    const auto window = o_.get(0x6067);
    return window == 0xFFFFFFFF || std::fabs(m_.read(at) - m_.demand(at).position) <= u_.way_of(0x6067);
}

/// At the end of the positioning the shaft is within the position window (6067h; FFFFFFFFh: no window).
bool Orders::settles() const {
    if ((!m_.held() && !m_.lags()) || (m_.differs() && !m_.held()) || o_.get(0x6067) == 0xFFFFFFFF) return true;
    return std::fabs(m_.shaft(m_.end()).position - m_.demand(m_.end()).position) <= u_.way_of(0x6067);
}

}  // namespace axisgate::cia402_drive::twin
