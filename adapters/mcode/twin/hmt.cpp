// ClosedLoop: make-up, the limits of lead and lag, locked rotor.
// In: the command and the rotor. Out: rotor states, codes, conditions of TA.
// Never loses a step with AS = 1 or 2: what the rotor owes stays in LL until it is made up, or the bridges go off.
#include "adapters/mcode/twin/hmt.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/mcode/twin/errors.hpp"

namespace axisgate::mcode::twin {
namespace {
constexpr int ta_active = 2, ta_locked = 4, ta_lag = 8, ta_lead = 16;
/// Fixed acceleration and start speed of make-up, in steps of 51200 per turn [L7578].
constexpr double makeup_acceleration = 16'763'806;
constexpr double makeup_start = 916;
/// Make-up is planned at most this far ahead; a rotor that cannot catch up is planned anew with the next command.
constexpr double horizon_s = 1e6;

}  // namespace

void ClosedLoop::stop() noexcept {
    is_.torque_runs = false;
    is_.lock_due = never;
    clear();
}

void ClosedLoop::resist(Instant now) noexcept {
    if (is_.lock_due == never && !is_.locked) start_timer(now);
    is_.at_bounds = true;
}

void ClosedLoop::turns() noexcept {
    is_.at_bounds = false;
    is_.lock_due = never;
}

bool ClosedLoop::make_up(Instant now) {
    const Profile& command = shaft_.command();
    const Travel from = shaft_.rotor(now);
    const double owed = command.at(now).position - from.position;
    turns();
    if (std::abs(owed) < 1e-9) {
        shaft_.join();
        return false;
    }
    const int way = owed < 0 ? -1 : 1;
    const double start_speed = from.velocity * way > 0 ? from.velocity : 0.0;
    if (settings_.whole(Word::MU) == 0 && command.end() != never) {
        // Without regard to time: the rotor makes the rest of the move as a move of its own, or creeps if it was held in the deceleration.
        const double target = command.end_position();
        const Profile rest = is_.while_braking ? Profile::creep(now, from.position, target, settings_.creep_speed())
                                               : Profile::move(now, {from.position, start_speed}, target, settings_.kinematics(), false);
        shaft_.chase(rest, rest.end());
        return true;
    }
    const double scale = settings_.steps_per_turn() / 51200;
    const double run = std::max(settings_[Word::VM], std::abs(command.at(now).velocity));
    const bool at_rest = command.end() <= now;
    double speed = run;
    if (settings_.whole(Word::MU) == 1) speed = at_rest ? settings_[Word::MF] : std::max(2 * run, settings_[Word::MF]);
    if (settings_.whole(Word::MU) == 2) speed = top_turns_per_second * settings_.steps_per_turn();
    speed = std::clamp(speed, 1.0, top_turns_per_second * settings_.steps_per_turn());
    Kinematics k;
    k.vi = std::min(makeup_start * scale, speed);
    k.vm = speed;
    k.up.rate = k.down.rate = makeup_acceleration * scale;
    const Profile run_after = Profile::slew(now, {from.position, start_speed}, way * speed, k);
    // Where both meet: the distance falls steadily once the rotor is the faster one.
    const auto open = [&](double s) {
        const Instant t = now + Duration{static_cast<std::int64_t>(s * 1e9)};
        return (command.at(t).position - run_after.at(t).position) * way > 0;
    };
    double low = 0, high = 1e-6;
    while (open(high) && high < horizon_s) {
        low = high;
        high *= 2;
    }
    Instant meeting = never;
    if (high < horizon_s) {
        for (int n = 0; n < 60 && high - low > 5e-10; ++n) {
            const double middle = (low + high) / 2;
            (open(middle) ? low : high) = middle;
        }
        meeting = now + Duration{static_cast<std::int64_t>(std::ceil(high * 1e9))};
    }
    shaft_.chase(run_after, meeting);
    return true;
}

void ClosedLoop::caught_up() noexcept {
    shaft_.join();
    is_.while_braking = false;
    clear();
}

bool ClosedLoop::waits_for_rotor() const noexcept {
    if (settings_.hmt_mode() == 3) return is_.torque_runs && shaft_.state() == Shaft::Rotor::held;
    return settings_.hmt_mode() != 0 && shaft_.state() != Shaft::Rotor::follows;
}

double ClosedLoop::bound() const noexcept {
    constexpr std::array full_steps{1.1, 1.3, 1.5, 1.7};
    const std::size_t n =
        settings_.hmt_mode() == 3 ? 0 : static_cast<std::size_t>(std::clamp<std::int64_t>(settings_.whole(Word::CB), 0, 3));
    return full_steps[n] * settings_[Word::MS];
}

Instant ClosedLoop::lag_due(Instant now) const noexcept {
    if (!settings_.makes_up()) return never;
    return std::min(
        {shaft_.lag_crossing(bound(), now), shaft_.lag_crossing(settings_[Word::LG], now), shaft_.lag_crossing(settings_[Word::LD], now)});
}

void ClosedLoop::judge_lag(Instant now) {
    if (!settings_.makes_up()) return;
    const double owed = shaft_.owed(now);
    constexpr double slack = 1e-6;
    const bool at_bounds = shaft_.state() == Shaft::Rotor::held && std::abs(owed) >= bound() - slack;
    if (at_bounds && !is_.at_bounds) {
        start_timer(now);
        trips_.status(ta_active, now);
    }
    is_.at_bounds = at_bounds;
    const bool behind = owed >= settings_[Word::LG] - slack;
    if (behind && !is_.lag_limit) {
        events_.raise(err::lag_reached);
        trips_.status(ta_lag, now);
    }
    is_.lag_limit = behind;
    const bool ahead = owed <= -settings_[Word::LD] + slack;
    if (ahead && !is_.lead_limit) {
        events_.raise(err::lead_reached);
        trips_.status(ta_lead, now);
    }
    is_.lead_limit = ahead;
}

void ClosedLoop::lock(Instant now) {
    is_.lock_due = never;
    is_.locked = true;
    events_.raise(err::locked_rotor);
    trips_.status(ta_locked, now);
}

int ClosedLoop::status(const Supply& supply, Instant now) const noexcept {
    int s = 128;  // initialised, as after each reset [L1339]
    if (is_.lead_limit) s |= 1;
    if (is_.lag_limit) s |= 2;
    if (is_.at_bounds) s |= 4;
    if (is_.locked) s |= 8;
    if (settings_.hmt_mode() != 0) s |= 16;
    if (supply.over_temperature || !supply.plus_v_good()) s |= 32;
    if (settings_.hmt_mode() != 0 && std::abs(shaft_.lag(now)) < 0.5) s |= 64;
    return s;
}

}  // namespace axisgate::mcode::twin
