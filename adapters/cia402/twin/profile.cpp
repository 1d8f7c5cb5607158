// A profile has at most a stop, a way back and its constant speed: 16 segments.
#include "adapters/cia402/twin/profile.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace axisgate::cia402_drive::twin {
namespace {
constexpr double pi = std::numbers::pi;
constexpr int halvings = 100;  ///< to find the top speed of a short way

class Planner {
public:
    Planner(const Motion& from, const Ramps& ramps) : r_(ramps) { plan_.end = from; }
    void to_speed(double to) {
        if (r_.shape != Shape::jerk) {
            at().acceleration = 0;  // these two begin at the present speed
        } else if (eases_first(to * at().velocity < 0 ? 0 : to)) {
            ease();
        }
        if (to * at().velocity < 0) ramp(0);
        ramp(to);
    }
    void cruise(double seconds) {
        if (seconds > 0) add({seconds});
    }
    Motion& at() { return plan_.end; }
    [[nodiscard]] Profile take() { return std::move(plan_); }

private:
    void add(const Segment& s) {
        plan_.end = along(plan_.end, s, s.seconds);
        plan_.segments.push_back(s);
    }
    /// The jerks of a change of speed in this direction: build-up and reduction of the acceleration, and its maximum.
    struct Rates {
        double most, build, take;
    };
    [[nodiscard]] Rates rates(bool faster) const {
        return faster ? Rates{r_.up, r_.jerk[0], r_.jerk[1]} : Rates{r_.down, r_.jerk[2], r_.jerk[3]};
    }
    /// The present acceleration has the wrong direction, or is so high that the speed would be exceeded.
    [[nodiscard]] bool eases_first(double to) {
        const double a = at().acceleration, dv = to - at().velocity;
        if (a == 0) return false;
        const Rates r = rates(std::fabs(to) > std::fabs(at().velocity));
        return a * dv <= 0 || r.build <= 0 || r.take <= 0 || a * a / (2 * r.take) > std::fabs(dv) || std::fabs(a) > r.most;
    }
    void ease() {
        const double a = at().acceleration;
        const double jerk = rates(a * at().velocity >= 0).take;
        if (jerk > 0) add({std::fabs(a) / jerk, a, -std::copysign(jerk, a)});
        at().acceleration = 0;
    }
    void ramp(double to) {
        const double dv = to - at().velocity, size = std::fabs(dv), side = std::copysign(1.0, dv);
        if (size == 0) return;
        const Rates r = rates(std::fabs(to) > std::fabs(at().velocity));
        if (r_.shape == Shape::sine) {
            add({size / r.most, 0, 0, dv});
        } else if (r_.shape == Shape::linear || r.build <= 0 || r.take <= 0) {
            add({size / r.most, side * r.most});
        } else {
            const double a = std::fabs(at().acceleration), whole = size + a * a / (2 * r.build);  // as if the acceleration had begun at 0
            const double peak = std::max(a, std::min(r.most, std::sqrt(2 * whole / (1 / r.build + 1 / r.take))));
            const double level = whole - peak * peak / 2 * (1 / r.build + 1 / r.take);
            if (peak > a) add({(peak - a) / r.build, side * a, side * r.build});
            if (level > 0) add({level / peak, side * peak});
            add({peak / r.take, side * peak, -side * r.take});
        }
        at().velocity = to;
        at().acceleration = 0;
    }
    const Ramps& r_;
    Profile plan_;
};
/// The way to this speed and then to standstill.
double way_over(const Motion& from, double velocity, const Ramps& r) {
    Planner p(from, r);
    p.to_speed(velocity);
    p.to_speed(0);
    return p.at().position - from.position;
}
}  // namespace

Motion along(const Motion& m, const Segment& s, double t) {
    Motion to{m.position + t * (m.velocity + t * (s.acceleration / 2 + t * s.jerk / 6)), m.velocity + t * (s.acceleration + t * s.jerk / 2),
              s.acceleration + t * s.jerk};
    if (s.swing != 0 && s.seconds > 0) {
        const double w = pi / s.seconds;
        to.position += s.swing * (t / 2 - std::sin(w * t) / (2 * w));
        to.velocity += s.swing * (1 - std::cos(w * t)) / 2;
        to.acceleration += s.swing * w * std::sin(w * t) / 2;
    }
    return to;
}

Profile profile_to_speed(const Motion& from, double velocity, const Ramps& ramps) {
    Planner p(from, ramps);
    p.to_speed(velocity);
    return p.take();
}

Profile profile_to_place(const Motion& from, double target, const Ramps& r) {
    Planner p(from, r);
    const double v = p.at().velocity, towards = std::copysign(1.0, target - p.at().position);
    const double beyond = towards * way_over(p.at(), 0, r) - std::fabs(target - p.at().position);
    if (v * towards < 0 || beyond > 1e-9 || (v == 0 && p.at().acceleration != 0)) p.to_speed(0);  // it cannot stop in time
    const double way = target - p.at().position, side = std::copysign(1.0, way), length = std::fabs(way),
                 speed = std::fabs(p.at().velocity);
    double top = r.velocity;
    if (r.shape != Shape::jerk) {  // half a cosine covers the same way as a line
        top = std::min(top, std::sqrt((2 * r.up * r.down * length + r.down * speed * speed) / (r.up + r.down)));
    } else if (side * way_over(p.at(), side * top, r) > length) {
        double low = 0;
        for (int i = 0; i < halvings; ++i) {
            const double middle = (low + top) / 2;
            (side * way_over(p.at(), side * middle, r) > length ? top : low) = middle;
        }
        top = low;
    }
    if (top > 0) {
        const double left = length - side * way_over(p.at(), side * top, r);
        p.to_speed(side * top);
        p.cruise(left / top);
        p.to_speed(0);
        p.at().position = target;
    }
    p.at().velocity = p.at().acceleration = 0;
    return p.take();
}

}  // namespace axisgate::cia402_drive::twin
