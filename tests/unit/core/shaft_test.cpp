// The mechanics between a demand and the encoder: the lag of the loop, overshoot, finite force, friction, backlash, noise and drift, and
// that none of them depends on the instants at which they are asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "gateway/core/shaft.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

constexpr Instant begin = time_zero + 1s;

ShaftFreedoms only(std::int64_t ShaftFreedoms::*which, std::int64_t value) {
    ShaftFreedoms f;
    f.*which = value;
    return f;
}
Shaft at_rest(const ShaftFreedoms& f, double position = 0) {
    Shaft s(f, 7);
    s.set(position, begin);
    return s;
}
double t_of(Instant t) { return seconds(t - begin); }

TEST(Shaft, WithoutAFreedomItIsItsDemand) {
    EXPECT_FALSE(Shaft().differs());
    EXPECT_FALSE(Shaft(shaft_freedoms({{"damping_percent", 50}})).differs()) << "nothing rings without a loop";
    for (const auto* name :
         {"follow_ms", "most_acceleration", "friction_increments", "backlash_increments", "noise_increments", "drift_increments"})
        EXPECT_TRUE(Shaft(shaft_freedoms({{name, 3}})).differs()) << name;
    Shaft s = at_rest({});
    s.advance(begin + 500ms, [](Instant t) { return 1000 * t_of(t); });
    EXPECT_NEAR(s.position(), 500, 1e-6);
    EXPECT_NEAR(s.velocity(), 1000, 1e-6);
    EXPECT_NEAR(s.shown(), 500, 1e-6);
}

TEST(Shaft, AtConstantSpeedItLagsByTwiceTheTimeConstantTimesTheSpeed) {
    for (const std::int64_t ms : {5, 20, 100}) {
        Shaft s = at_rest(only(&ShaftFreedoms::follow_ms, ms));
        s.advance(begin + 3s, [](Instant t) { return 10'000 * t_of(t); });
        const double lag = 2 * static_cast<double>(ms) / 1000 * 10'000;
        EXPECT_NEAR(s.following_error(), lag, 0.01 * lag + 10) << ms << " ms; within the way of one step";
        EXPECT_NEAR(s.velocity(), 10'000, 1);
        s.advance(begin + 10s, [](Instant) { return 30'000.0; });
        EXPECT_DOUBLE_EQ(s.position(), 30'000) << "it settles at its demand";
    }
}

double highest(Shaft s, double target) {
    double most = 0;
    for (int i = 1; i < 2000; ++i) {
        s.advance(begin + i * 1ms, [&](Instant) { return target; });
        most = std::max(most, s.position());
    }
    return most;
}

TEST(Shaft, BelowFullDampingItOvershootsAndSettles) {
    ShaftFreedoms f = only(&ShaftFreedoms::follow_ms, 20);
    EXPECT_LE(highest(at_rest(f), 1000), 1000.5);
    f.damping_percent = 30;
    EXPECT_NEAR(highest(at_rest(f), 1000), 1372, 60) << "exp(-pi*0.3/sqrt(1-0.09)) of the step";
    Shaft s = at_rest(f);
    s.advance(begin + 5s, [](Instant) { return 1000.0; });
    EXPECT_DOUBLE_EQ(s.position(), 1000);
    for (const std::int64_t damping : {1, 100, 1000}) {
        f.damping_percent = damping;
        EXPECT_LT(highest(at_rest(f), 1000), 2050) << damping << " %: the integration is stable";
    }
}

TEST(Shaft, AMotorOfFiniteForceStaysBehindAFasterDemandAndCatchesUp) {
    Shaft s = at_rest(only(&ShaftFreedoms::most_acceleration, 1000));
    const auto demand = [](Instant t) { return std::min(5000.0, 50'000 * t_of(t) * t_of(t)); };  // 100,000/s^2 for 0.3 s
    s.advance(begin + 300ms, demand);
    EXPECT_NEAR(s.velocity(), 300, 5) << "0.3 s at 1000/s^2";
    EXPECT_NEAR(s.position(), 45, 3);
    EXPECT_GT(s.following_error(), 4000);
    EXPECT_DOUBLE_EQ(s.force(), 1);
    double most = 0;
    for (int i = 301; i < 8000; ++i) {
        s.advance(begin + i * 1ms, demand);
        most = std::max(most, s.position());
    }
    EXPECT_NEAR(s.position(), 5000, 0.01) << "it brakes in time and does not swing for ever";
    EXPECT_LT(most, 5100);
}

TEST(Shaft, ItIsStillForceAndNotTheLoopThatLimitsAFastFollower) {
    Shaft strong = at_rest(only(&ShaftFreedoms::most_acceleration, 1'000'000));
    strong.advance(begin + 1s, [](Instant t) { return 500 * t_of(t) * t_of(t); });  // 1000/s^2
    EXPECT_LT(strong.following_error(), 10);
    EXPECT_LT(strong.force(), 0.01);
}

TEST(Shaft, AMotorThatIsStrongEnoughLacksNothing) {
    ShaftFreedoms f = only(&ShaftFreedoms::follow_ms, 10);
    f.most_acceleration = 20'000;
    Shaft strong = at_rest(f), weak = at_rest(f);
    strong.advance(begin + 1s, [](Instant t) { return 5000 * t_of(t) * t_of(t); });  // 10,000/s^2
    EXPECT_GT(strong.following_error(), 150);
    EXPECT_LT(strong.lack(), 15);
    weak.advance(begin + 1s, [](Instant t) { return 20'000 * t_of(t) * t_of(t); });  // 40,000/s^2
    EXPECT_NEAR(weak.lack(), 10'000 - 400, 250) << "the half of the way, and without the lag at its speed";
    EXPECT_DOUBLE_EQ(weak.force(), 1);
}

TEST(Shaft, ANewNumberingChangesNothingElse) {
    ShaftFreedoms f = only(&ShaftFreedoms::follow_ms, 20);
    f.backlash_increments = 4;
    f.drift_increments = 100;
    Shaft here = at_rest(f), there = at_rest(f);
    here.advance(begin + 50ms, [](Instant) { return 100.0; });
    there.advance(begin + 50ms, [](Instant) { return 100.0; });
    there.shift(1000);
    here.advance(begin + 100ms, [](Instant) { return 100.0; });
    there.advance(begin + 100ms, [](Instant) { return 1100.0; });
    EXPECT_NEAR(there.shown(), here.shown() + 1000, 1e-6);
    here.advance_without_power(begin + 200ms);
    there.advance_without_power(begin + 200ms);
    there.shift(-1000);
    here.advance_without_power(begin + 1s);
    there.advance_without_power(begin + 1s);
    EXPECT_NEAR(there.position(), here.position(), 1e-6);
}

TEST(Shaft, FrictionKeepsItFromItsDemand) {
    Shaft s = at_rest(only(&ShaftFreedoms::friction_increments, 5));
    s.advance(begin + 1s, [](Instant) { return 4.0; });
    EXPECT_DOUBLE_EQ(s.position(), 0) << "5 increments do not move it";
    s.advance(begin + 2s, [](Instant) { return 100.0; });
    EXPECT_DOUBLE_EQ(s.position(), 95);
    s.advance(begin + 3s, [](Instant) { return 0.0; });
    EXPECT_DOUBLE_EQ(s.position(), 5);

    ShaftFreedoms loop = only(&ShaftFreedoms::follow_ms, 20);
    loop.friction_increments = 5;
    Shaft r = at_rest(loop);
    r.advance(begin + 1s, [](Instant) { return 4.0; });
    EXPECT_DOUBLE_EQ(r.position(), 0);
    r.advance(begin + 5s, [](Instant) { return 1000.0; });
    EXPECT_GT(std::abs(r.following_error()), 0.1);
    EXPECT_LE(std::abs(r.following_error()), 5);
    EXPECT_DOUBLE_EQ(r.velocity(), 0);
}

TEST(Shaft, BacklashIsPlayBetweenMotorAndEncoder) {
    Shaft s = at_rest(only(&ShaftFreedoms::backlash_increments, 10));
    s.advance(begin + 1s, [](Instant) { return 100.0; });
    EXPECT_DOUBLE_EQ(s.position(), 100);
    EXPECT_DOUBLE_EQ(s.shown(), 95);
    s.advance(begin + 2s, [](Instant) { return 92.0; });
    EXPECT_DOUBLE_EQ(s.shown(), 95) << "a way back of less than the play is not seen";
    s.advance(begin + 3s, [](Instant) { return 80.0; });
    EXPECT_DOUBLE_EQ(s.shown(), 85);
}

TEST(Shaft, NoiseFlickersWithinItsBounds) {
    Shaft s = at_rest(only(&ShaftFreedoms::noise_increments, 2), 50);
    std::set<double> seen;
    for (int i = 1; i < 500; ++i) {
        s.advance(begin + i * 1ms, [](Instant) { return 50.0; });
        seen.insert(s.shown());
        EXPECT_DOUBLE_EQ(s.position(), 50);
    }
    EXPECT_EQ(seen, (std::set<double>{48, 49, 50, 51, 52}));
    Shaft other(only(&ShaftFreedoms::noise_increments, 2), 8);
    other.set(50, begin);
    int differ = 0;
    for (int i = 1; i < 500; ++i) {
        s.set(50, begin + i * 1ms);
        other.set(50, begin + i * 1ms);
        differ += s.shown() != other.shown();
    }
    EXPECT_GT(differ, 200) << "drives of another seed flicker differently";
}

TEST(Shaft, DriftsWithoutPowerAndStaysThere) {
    Shaft s = at_rest(only(&ShaftFreedoms::drift_increments, -300), 1000);
    s.advance(begin + 10ms, [](Instant) { return 1000.0; });
    s.advance_without_power(begin + 310ms);
    EXPECT_NEAR(s.shown(), 1000 - 300 * (1 - std::exp(-1)), 1) << "0.3 s after it was switched off";
    s.advance_without_power(begin + 10s);
    EXPECT_NEAR(s.shown(), 700, 0.01);
    s.advance_without_power(begin + 1h);
    EXPECT_NEAR(s.shown(), 700, 0.01);
    s.set(700, begin + 1h);
    s.advance(begin + 1h + 5s, [](Instant) { return 700.0; });
    EXPECT_DOUBLE_EQ(s.shown(), 700) << "with power again it stands";
}

TEST(Shaft, ItDoesNotMatterWhenItIsAsked) {
    ShaftFreedoms f;
    f.follow_ms = 15;
    f.damping_percent = 50;
    f.most_acceleration = 40'000;
    f.friction_increments = 2;
    f.backlash_increments = 3;
    f.noise_increments = 1;
    f.drift_increments = 40;
    const auto demand = [](Instant t) { return 3000 * std::sin(t_of(t)); };
    Shaft often = at_rest(f), seldom = at_rest(f);
    for (Instant now = begin; now < begin + 6s; now += 370us) {
        if (now < begin + 5s)
            often.advance(now, demand);
        else
            often.advance_without_power(now);
    }
    often.advance_without_power(begin + 6s);
    seldom.advance(begin + 5s - 1ns, demand);
    seldom.advance_without_power(begin + 6s);
    EXPECT_DOUBLE_EQ(often.position(), seldom.position());
    EXPECT_DOUBLE_EQ(often.shown(), seldom.shown());
}

/// The loop of the shaft, in steps of a microsecond.
struct Fine {
    double x = 0, v = 0;
    template <class Demand>
    void until(double t, double period, double damping, Demand&& demand) {
        for (; at < t; at += 1e-6) {
            const double d = demand(at + 0.5e-6);
            v += ((d - x) / (period * period) - 2 * damping / period * v) * 1e-6;
            x += v * 1e-6;
        }
    }
    double at = 0;
};

TEST(Shaft, BetweenItsEventsTheSolutionIsThatOfTheLoop) {
    const auto ramp = [](double t) {  // accelerates for 100 ms, moves for 200 ms, brakes
        const double a = 20'000, up = std::min(t, 0.1), even = std::clamp(t - 0.1, 0.0, 0.2), down = std::clamp(t - 0.3, 0.0, 0.1);
        return a * up * up / 2 + a * 0.1 * even + a * 0.1 * down - a * down * down / 2;
    };
    for (const std::int64_t damping : {40, 100, 200}) {
        ShaftFreedoms f = only(&ShaftFreedoms::follow_ms, 10);
        f.damping_percent = damping;
        Shaft s = at_rest(f);
        Fine fine;
        for (int ms = 7; ms < 500; ms += 7) {
            s.advance(begin + ms * 1ms, [&](Instant t) { return ramp(t_of(t)); });
            fine.until(ms * 0.001, 0.01, static_cast<double>(damping) / 100, ramp);
            EXPECT_NEAR(s.position(), fine.x, 0.5) << damping << " %, " << ms << " ms";
            EXPECT_NEAR(s.velocity(), fine.v, 20) << damping << " %, " << ms << " ms";
        }
    }
}

TEST(Shaft, ItIsCalculatedOnlyAsOftenAsItIsAskedFor) {
    ShaftFreedoms f = only(&ShaftFreedoms::follow_ms, 10);
    f.noise_increments = f.backlash_increments = 2;
    int calls = 0;
    Shaft s = at_rest(f);
    for (int i = 1; i <= 50; ++i)
        s.advance(begin + i * 20ms, [&](Instant t) { return ++calls, 1000 * t_of(t); });
    EXPECT_LT(calls, 300) << "a second of a motion, asked for fifty times";
    s.advance(begin + 2s, [](Instant) { return 1000.0; });
    ASSERT_TRUE(s.rests());
    calls = 0;
    s.advance(begin + 12s, [&](Instant) { return ++calls, 1000.0; });
    EXPECT_LT(calls, 20) << "ten seconds at rest";
    EXPECT_DOUBLE_EQ(s.position(), 1000);
}

TEST(Shaft, AMotionWithinALongRestIsNotOverlooked) {
    Shaft s = at_rest(only(&ShaftFreedoms::follow_ms, 10));
    s.advance(begin + 1s, [](Instant) { return 0.0; });
    s.advance(begin + 4s, [](Instant t) { return t_of(t) < 3 ? 0.0 : 500.0; });
    EXPECT_DOUBLE_EQ(s.position(), 500);
    s.advance(begin + 4s + 20ms, [](Instant t) { return 500 + 1000 * (t_of(t) - 4); });
    EXPECT_NEAR(s.position(), 506, 3) << "it has just begun to follow";
}

TEST(Shaft, ItEndsAtTheFirstMillisecondOfACondition) {
    const auto far = [](const ShaftPoint& p) { return p.demand - p.position > 100; };
    for (const auto asked : {3ms, 20ms, 700ms}) {
        Shaft s = at_rest(only(&ShaftFreedoms::most_acceleration, 1000));
        Instant ended = never;
        for (Instant now = begin + asked; ended == never && now < begin + 2s; now += asked)
            ended = s.advance_until(
                now, [](Instant t) { return 1000 * t_of(t) * t_of(t); }, far);  // 2000/s^2
        EXPECT_NEAR(seconds(ended - begin), std::sqrt(100 / (1000 - 500.0)), 0.004) << "asked for each " << asked.count() << " ms";
        EXPECT_EQ(s.point().at, ended);
        EXPECT_GT(s.following_error(), 100);
        EXPECT_LT(s.following_error(), 102);
    }
    Shaft soft = at_rest(only(&ShaftFreedoms::follow_ms, 20));
    const Instant ended = soft.advance_until(
        begin + 1s, [](Instant t) { return 10'000 * t_of(t); }, far);
    EXPECT_NEAR(seconds(ended - begin), 0.011, 0.002) << "where nothing but the condition ends the linear movement";
    EXPECT_LT(soft.following_error(), 112);
}

TEST(Shaft, ADemandThatTakesAnotherCourseIsFollowedFromThere) {
    for (const auto every : {30'000us, 30'500us}) {
        Shaft s = at_rest(only(&ShaftFreedoms::follow_ms, 2));
        constexpr double speed = 10'000, lag = 4e-3 * speed;
        double from = 0;
        Instant since = begin;
        // An order that continues the motion; of the time before, it knows nothing.
        const auto demand = [&](Instant t) { return from + speed * std::max(0.0, seconds(t - since)); };
        s.advance(begin + every, demand);
        for (int i = 1; i < 20; ++i) {
            const double here = demand(begin + i * every);
            since = begin + i * every, from = here;
            for (const auto after : {1ms, 4ms, 15ms, 29ms}) {
                s.advance(since + after, demand);
                EXPECT_NEAR(s.following_error(), lag, 3) << i << ", " << after.count() << " ms after it";
                EXPECT_NEAR(s.velocity(), speed, 700) << i << ", " << after.count() << " ms after it";
            }
            s.advance(since + every, demand);
        }
    }
}

TEST(Shaft, ALongGapIsNotCalculated) {
    ShaftFreedoms f = only(&ShaftFreedoms::follow_ms, 20);
    f.friction_increments = 5;
    Shaft s = at_rest(f);
    s.advance(begin + 1s, [](Instant) { return 4.0; });
    int calls = 0;
    s.advance(begin + 24h, [&](Instant) { return ++calls, 4.0; });
    EXPECT_DOUBLE_EQ(s.position(), 0) << "nothing has changed";
    EXPECT_LE(calls, 20'002);
    s.advance(begin + 48h, [](Instant) { return 5000.0; });
    EXPECT_DOUBLE_EQ(s.position(), 5000) << "the motion was long ago";
    s.advance(begin + 72h, [](Instant t) { return 5000 + 1000 * (t_of(t) - 48 * 3600); });
    EXPECT_NEAR(s.following_error(), 40, 2) << "and one that goes on has its lag";
}

}  // namespace
}  // namespace axisgate
