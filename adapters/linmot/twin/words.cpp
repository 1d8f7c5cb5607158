// Status word, StateVar and warn word are 0 while the software does not run.
#include <algorithm>
#include <cmath>

#include "adapters/linmot/twin/states.hpp"

namespace axisgate::linmot::twin {
namespace {
void set(std::uint16_t& word, int bit, bool on) { word = static_cast<std::uint16_t>(word | (on ? 1u << bit : 0u)); }
/// The sub state of state 9 before its end: its phases have equal shares of that time.
std::uint8_t phase_of(int phases, Duration past, Duration whole) {
    const double share = whole > Duration::zero() ? std::min(seconds(past) / seconds(whole), 1.0) : 1;
    return static_cast<std::uint8_t>(1 + std::min(phases - 1, static_cast<int>(share * phases)));
}
}  // namespace

std::uint16_t States::status_word(Instant now) const {
    if (!running_) return 0;
    std::uint16_t s = 0;
    set(s, 0, powered());
    set(s, 1, cw(0));
    set(s, 2, cw(3));
    set(s, 3, in_error() || stops_by_error());
    set(s, 4, cw(1));
    set(s, 5, cw(2));
    set(s, 6, state_ == not_ready);
    set(s, 7, warn_word(now) != 0);
    set(s, 8, body_.armed.kind != Armed::Kind::none);
    set(s, 9, (state_ >= homing && state_ <= to_initial) || state_ >= to_position);
    set(s, 10, body_.follower.in_target(now));
    set(s, 11, body_.follower.homed());
    set(s, 12, fatal_ && in_error());
    set(s, 13, moves(now));
    return s;
}

std::uint16_t States::state_var(Instant now) const {
    if (!running_) return 0;
    std::uint8_t low = sub_;
    const int phases = body_.setup.manners.homing_phases;
    if (state_ == homing && phases != 0 && !arrived()) low = phase_of(phases, now - since_, motion_end() - since_);
    if (in_error()) low = static_cast<std::uint8_t>(error_);
    if (state_ == operation_enabled) {
        low = static_cast<std::uint8_t>((body_.buffer.echo & 0x0F) | (body_.armed.kind != Armed::Kind::none ? 0x10 : 0) |
                                        (moves(now) ? 0x20 : 0) | (body_.follower.in_target(now) ? 0x40 : 0) |
                                        (body_.follower.homed() ? 0x80 : 0));
    }
    return static_cast<std::uint16_t>(state_ << 8 | low);
}

std::uint16_t States::warn_word(Instant now) const {
    if (!running_) return 0;
    std::uint16_t w = body_.monitor.warnings(now);
    const double behind = std::fabs(demand(now) - body_.follower.actual(now).position);
    const double moving_limit = body_.memory.number(0x1473), standing_limit = body_.memory.number(0x1475);
    set(w, 4, powered() && moving_limit > 0 && behind > moving_limit / 2);
    set(w, 5, body_.setup.series == Series::e1100 && powered() && !moves(now) && standing_limit > 0 && behind > standing_limit / 2);
    set(w, 7, !body_.follower.homed());
    return w;
}

double States::demand(Instant now) const { return powered() ? body_.demand.at(now).position : body_.follower.actual(now).position; }

}  // namespace axisgate::linmot::twin
