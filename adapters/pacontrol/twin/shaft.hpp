// The shaft of one axis: the control's counter, the true place of the mechanics, the encoder, the following error between them.
// In: paths, a hand that holds or pushes the shaft, load. Out: positions and speeds at any instant; when the lag grows too large.
// Never decides to move or to stop. shaft = counter - origin - what the shaft did not follow.
// Where the mechanics have freedoms (gateway/core/shaft.hpp, in 0.001 AE) that place is the demand, and the true place comes behind it.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "adapters/pacontrol/twin/path.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::pacontrol::twin {

/// All places in AE.
class Shaft {
public:
    explicit Shaft(const ShaftFreedoms& mechanics = {}, std::uint64_t seed = 0)
        : mechanics_(mechanics, seed),
          lags_(mechanics.follow_ms != 0 || mechanics.most_acceleration != 0),
          rest_lag_(0.001 * static_cast<double>(mechanics.friction_increments) + 1e-3) {}

    [[nodiscard]] double position(Instant t) const noexcept { return running_ ? path_.position(t) : rest_; }  ///< the control's counter
    [[nodiscard]] double velocity(Instant t) const noexcept {                                                 ///< AE/s, signed
        if (lags_) return followed(t).velocity() / increments;
        return running_ && !held_ ? path_.velocity(t) : 0;
    }
    /// The true place of the mechanics; the home switch's edge is at 0.
    [[nodiscard]] double place(Instant t) const noexcept { return mechanics_.differs() ? followed(t).position() / increments : demand(t); }
    [[nodiscard]] double place() const noexcept { return place(now_); }  ///< at the last instant seen
    [[nodiscard]] double encoder(Instant t) const noexcept {             ///< counted by the encoder
        return (mechanics_.differs() ? followed(t).shown() / increments : demand(t)) + origin_;
    }
    [[nodiscard]] double rest() const noexcept { return rest_; }                          ///< the counter while it stands ...
    [[nodiscard]] double rest_place() const noexcept { return rest_ - origin_ - lost_; }  ///< ... and the shaft, if nobody holds it
    [[nodiscard]] double offset() const noexcept { return origin_ + lost_; }              ///< counter less shaft
    [[nodiscard]] double lag(Instant t) const noexcept {
        return lost_ + (held_ ? position(t) - held_at_ : 0) + extra_lag_ + load_ * velocity(t) * 0.001 +
               (lags_ ? followed(t).following_error() / increments : 0);
    }
    /// The largest that has occurred since power on.
    [[nodiscard]] double greatest_lag(Instant t) const noexcept { return std::max(greatest_lag_, std::abs(lag(t))); }
    /// When the lag passes `most` because the shaft is held; `never`.
    [[nodiscard]] Instant lag_passes(double most) const noexcept {
        if (!held_ || !running_) return never;
        return path_.when(held_at_ + path_.direction() * (most - path_.direction() * (lost_ + extra_lag_)));
    }
    [[nodiscard]] bool running() const noexcept { return running_; }
    [[nodiscard]] const Path& path() const noexcept { return path_; }
    [[nodiscard]] bool held() const noexcept { return held_; }
    [[nodiscard]] double extra_lag() const noexcept { return extra_lag_; }
    [[nodiscard]] double load() const noexcept { return load_; }

    // --- motion ---
    void seen(Instant t) noexcept { now_ = std::max(now_, t); }
    void note_lag(Instant t) noexcept { greatest_lag_ = greatest_lag(t); }
    void run(const Path& path) noexcept {
        path_ = path;
        running_ = true;
    }
    /// Lets the mechanics follow up to `t`, before anything changes there. `held`: by its motor; without it the shaft drifts, and the
    /// counter counts that. The instant at which the lag passed `most` (0: any lag is admitted), or `never`.
    Instant follow(Instant t, bool held_by_motor, double most) noexcept {
        if (!mechanics_.differs()) return never;
        Instant passed = never;
        if (held_by_motor) {
            const auto place = [&](Instant at) { return demand(at) * increments; };
            const auto passes = [&](const ShaftPoint& p) {
                const double lag = std::abs(lost_ + extra_lag_ + (lags_ ? (p.demand - p.position) / increments : 0));
                greatest_lag_ = std::max(greatest_lag_, lag);
                return most > 0 && lags_ && lag > most;
            };
            passed = mechanics_.advance_until(t, place, passes);
            if (passed != never) mechanics_.advance(t, place);
        } else if (!held_) {
            const double before = mechanics_.position();
            mechanics_.advance_without_power(t);
            const double drift = (mechanics_.position() - before) / increments;
            rest_ += drift;
            held_at_ += drift;
        }
        followed_ = std::max(followed_, t);
        return passed;
    }
    /// When the lag has to be looked at again; `never` while it cannot change.
    [[nodiscard]] Instant lag_due() const noexcept {
        const bool settled =
            !running_ && std::abs(mechanics_.following_error()) <= rest_lag_ * increments && std::abs(mechanics_.velocity()) < 1;
        return lags_ && !settled ? followed_ + lag_period : never;
    }
    /// The path has ended.
    void arrive(Instant t) noexcept {
        note_lag(t);
        greatest_lag_ = std::max(greatest_lag_, load_ * path_.peak() * 0.001);
        rest_ = path_.last();
        running_ = false;
        keep_lost();
    }
    /// Stands at once where the counter is.
    void freeze(Instant t) noexcept {
        if (running_) rest_ = path_.position(t);
        running_ = false;
    }
    /// What a held shaft did not follow is lost for good.
    void keep_lost() noexcept {
        if (!held_) return;
        lost_ += rest_ - held_at_;
        held_at_ = rest_;
    }

    // --- the counter while it stands ---
    void count(double by) noexcept {
        rest_ += by;
        still();
    }
    /// The present place is the zero point, which the counter calls so; nothing is lost any more.
    void zero(double counter) noexcept {
        origin_ += counter - rest_;
        rest_ = counter;
        if (std::exchange(lost_, 0) != 0) still();
    }
    /// The counter has another value here.
    void rename(double counter) noexcept {
        origin_ += counter - rest_;
        held_at_ += counter - rest_;
        rest_ = counter;
    }
    /// The encoder's position becomes the counter's.
    void take_over() noexcept {
        const double behind = lags_ ? mechanics_.position() / increments - demand(now_) : 0;
        rest_ += behind - lost_;
        held_at_ = rest_;
        lost_ = 0;
        if (lags_) still();
    }
    /// A hand that holds it does so here.
    void hold_here() noexcept { held_at_ = rest_; }
    void boot(double counter, double place) noexcept {
        running_ = false;
        lost_ = greatest_lag_ = 0;
        rest_ = held_at_ = counter;
        origin_ = counter - place;
        still();
    }

    // --- the tester's hand ---
    void hold(bool held, Instant t) noexcept {
        note_lag(t);
        if (held) {
            held_at_ = position(t);
        } else {
            lost_ += position(t) - held_at_;
        }
        held_ = held;
    }
    /// `counted`: the counter goes with it.
    void push(double way, bool counted) noexcept {
        if (counted) {
            rest_ += way;
            held_at_ += way;
        } else {
            lost_ -= way;
        }
        still();
    }
    void set_extra_lag(double ae) noexcept { extra_lag_ = ae; }
    void set_load(double share) noexcept { load_ = share; }

private:
    static constexpr double increments = 1000;  ///< of an AE, in the mechanics
    static constexpr Duration lag_period = std::chrono::milliseconds(20);

    [[nodiscard]] double demand(Instant t) const noexcept { return position(t) - origin_ - lost_ - (held_ ? position(t) - held_at_ : 0); }
    /// A question about a later instant must not change the mechanics.
    [[nodiscard]] const axisgate::Shaft& followed(Instant t) const noexcept {
        if (t <= followed_) return mechanics_;
        ahead_ = mechanics_;
        ahead_.advance(t, [&](Instant at) { return demand(at) * increments; });
        return ahead_;
    }
    /// The mechanics are where the counter says, at rest.
    void still() noexcept {
        if (mechanics_.differs()) mechanics_.set(demand(now_) * increments, std::max(now_, followed_));
    }

    axisgate::Shaft mechanics_;
    mutable axisgate::Shaft ahead_;  ///< a copy for questions about later instants
    bool lags_ = false;              ///< they can be behind the demand
    double rest_lag_ = 0;            ///< AE, that may remain at rest
    Instant followed_{};
    double rest_ = 0;
    double origin_ = 0;
    double lost_ = 0;     ///< that the shaft did not follow
    double held_at_ = 0;  ///< commanded position at which the shaft was taken hold of
    double extra_lag_ = 0;
    double greatest_lag_ = 0;
    double load_ = 0;  ///< 0..1: the lag of a moving axis, 1 ms of its way at full load
    Instant now_{};    ///< of the last advance
    Path path_;
    bool running_ = false;
    bool held_ = false;
};

}  // namespace axisgate::pacontrol::twin
