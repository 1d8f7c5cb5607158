// Motion in closed form: the derived figures, the shape of each plan, and agreement with a small numerical integrator.
// In: plans made directly and by the wire. Out: positions and speeds at many instants.
// The integrator is this file's own and shares nothing with the plans.
#include "adapters/uim342/twin/motion.hpp"

#include <random>

#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

using twin::MotionState;
using twin::Profile;
using twin::Ramps;

Instant at_s(double s) { return time_zero + Duration{static_cast<std::int64_t>(std::llround(s * 1e9))}; }
double end_s(const Profile& p) { return seconds(p.end() - time_zero); }

Ramps ramps(double a, double d, double ss = 0) {
    Ramps r;
    r.acceleration = a;
    r.deceleration = d;
    r.cut_in = ss;
    return r;
}

TEST(TwinProfile, DerivedFigures) {
    const Profile trapezoid = Profile::move(time_zero, {}, 20000, 10000, ramps(10000, 10000));
    EXPECT_EQ(trapezoid.end() - time_zero, std::chrono::seconds(3));
    EXPECT_DOUBLE_EQ(trapezoid.at(at_s(1.0)).velocity, 10000);
    EXPECT_DOUBLE_EQ(trapezoid.at(at_s(1.0)).position, 5000);
    EXPECT_DOUBLE_EQ(trapezoid.at(at_s(1.5)).position, 10000);
    EXPECT_DOUBLE_EQ(trapezoid.at(at_s(2.0)).position, 15000);

    const Profile triangle = Profile::move(time_zero, {}, 3200, 10000, ramps(10000, 10000));
    EXPECT_NEAR(end_s(triangle), 1.1314, 5e-5);
    EXPECT_NEAR(triangle.at(at_s(end_s(triangle) / 2)).velocity, 5656.85, 0.01);

    const Profile stop = Profile::stop(time_zero, {0, 10000}, 1'600'000, 0);
    EXPECT_EQ(stop.end() - time_zero, std::chrono::microseconds(6250));
    EXPECT_NEAR(stop.at(at_s(0.006249999)).position, 31.25, 1e-6);
    EXPECT_EQ(stop.end_position(), 31);
}

TEST(TwinProfile, CutInSpeed) {
    // Steps to 1000, ramps to 5000, and back; D = 2*(25e6-1e6)/(2*8000) + 5000 = 8000.
    const Profile p = Profile::move(time_zero, {}, 8000, 5000, ramps(8000, 8000, 1000));
    EXPECT_EQ(p.end() - time_zero, std::chrono::seconds(2));
    EXPECT_DOUBLE_EQ(p.at(time_zero).velocity, 1000);
    EXPECT_DOUBLE_EQ(p.at(at_s(0.5)).velocity, 5000);
    EXPECT_NEAR(p.at(p.end() - Duration{1}).velocity, 1000, 1e-3);
    EXPECT_EQ(p.at(p.end()).velocity, 0);
    // Not above the cut-in speed: constant speed, T = D / vt.
    const Profile slow = Profile::move(time_zero, {}, -500, 250, ramps(8000, 8000, 1000));
    EXPECT_EQ(slow.end() - time_zero, std::chrono::seconds(2));
    EXPECT_DOUBLE_EQ(slow.at(at_s(1)).velocity, -250);
    // Equal.
    const Profile equal = Profile::move(time_zero, {}, 1000, 1000, ramps(8000, 8000, 1000));
    EXPECT_EQ(equal.end() - time_zero, std::chrono::seconds(1));
    // Stop from above, from at and from below the cut-in speed.
    EXPECT_EQ(Profile::stop(time_zero, {0, 5000}, 8000, 1000).end() - time_zero, std::chrono::milliseconds(500));
    EXPECT_EQ(Profile::stop(time_zero, {0, 1000}, 8000, 1000).end(), time_zero);
    EXPECT_EQ(Profile::stop(time_zero, {0, -999}, 8000, 1000).end(), time_zero);
    // No rate: at once.
    EXPECT_EQ(Profile::stop(time_zero, {7.4, 10000}, 0, 0).end(), time_zero);
    EXPECT_EQ(Profile::stop(time_zero, {7.4, 10000}, 0, 0).end_position(), 7);
}

TEST(TwinProfile, JogUpDownAndReverse) {
    const Profile up = Profile::jog(time_zero, {100, 2000}, 4000, ramps(1000, 500));
    EXPECT_EQ(up.end(), never);
    EXPECT_DOUBLE_EQ(up.at(at_s(2)).velocity, 4000);
    EXPECT_DOUBLE_EQ(up.at(at_s(3)).position, 100 + 6000 + 4000);
    const Profile down = Profile::jog(time_zero, {0, 2000}, 1000, ramps(1000, 500));
    EXPECT_DOUBLE_EQ(down.at(at_s(1)).velocity, 1500);
    EXPECT_DOUBLE_EQ(down.at(at_s(2)).velocity, 1000);
    // 2000 -> 0 with 500 (4 s), then to -1000 with 1000 (1 s).
    const Profile back = Profile::jog(time_zero, {0, 2000}, -1000, ramps(1000, 500));
    EXPECT_NEAR(back.at(at_s(4)).velocity, 0, 1e-9);
    EXPECT_NEAR(back.at(at_s(4)).position, 4000, 1e-6);
    EXPECT_NEAR(back.at(at_s(5)).velocity, -1000, 1e-9);
    // With a cut-in speed of 500: 2000 -> 500 (3 s), 0, -500 -> -1000 (0.5 s).
    const Profile step = Profile::jog(time_zero, {0, 2000}, -1000, ramps(1000, 500, 500));
    EXPECT_NEAR(step.at(at_s(2.999999)).velocity, 500, 1e-2);
    EXPECT_NEAR(step.at(at_s(3.000001)).velocity, -500, 1e-2);
    EXPECT_NEAR(step.at(at_s(3.5)).velocity, -1000, 1e-9);
    // To 0: a stop; from rest to 0: nothing.
    EXPECT_EQ(Profile::jog(time_zero, {0, 2000}, 0, ramps(1000, 500)).end() - time_zero, std::chrono::seconds(4));
    EXPECT_EQ(Profile::jog(time_zero, {}, 0, ramps(1000, 500)).end(), time_zero);
    // Below the cut-in speed from above it: ramp to the cut-in speed, then the step.
    const Profile below = Profile::jog(time_zero, {0, 2000}, 100, ramps(1000, 500, 1000));
    EXPECT_NEAR(below.at(at_s(1.9999)).velocity, 1000, 0.1);
    EXPECT_DOUBLE_EQ(below.at(at_s(2.0001)).velocity, 100);
}

/// From 2^31 pulse/s with 1 pulse/s^2 far beyond the target and back at 1 pulse/s: longer than instants reach.
TEST(TwinProfile, LongerThanTimeIsNever) {
    const Profile p = Profile::move(time_zero, {0, 2147483648.0}, 0, 1, ramps(1, 1));
    EXPECT_EQ(p.end(), never);
    EXPECT_GT(p.at(at_s(1e9)).velocity, 1e9);
}

TEST(TwinProfile, SpeedZeroStops) {
    EXPECT_FALSE(Profile::move(time_zero, {0, 1000}, 500, 0, ramps(1000, 500)).reaches_target());
    EXPECT_EQ(Profile::move(time_zero, {0, 1000}, 500, 0, ramps(1000, 500)).end() - time_zero, std::chrono::seconds(2));
    EXPECT_TRUE(Profile::move(time_zero, {500, 0}, 500, 0, ramps(1000, 500)).reaches_target());
}

TEST(TwinProfile, SameTargetWhileBrakingForItStaysExact) {
    Ramps r = ramps(7000, 3333, 123);
    r.backlash = 10000;  // an overshoot by a rounding would cost a second
    const Profile first = Profile::move(time_zero, {}, 54321, 9876, r);
    for (int i = 1; i < 100; ++i) {
        const Instant t = time_zero + (first.end() - time_zero) * i / 100;
        const Profile again = Profile::move(t, first.at(t), 54321, 9876, r);
        EXPECT_EQ(again.end_position(), 54321);
        EXPECT_NEAR(seconds(again.end() - first.end()), 0, 2e-3) << i;
        EXPECT_LE(again.at(again.end() - Duration{1000}).position, 54321.001) << "no overshoot at " << i;
    }
}

TEST(TwinProfile, BacklashIsMadeButNotCounted) {
    Ramps r = ramps(1000, 1000);
    r.backlash = 125;
    r.last_direction = 1;
    // Reverse: the first 125 pulses take 0.5 s at 1000 pulse/s^2, then the counter moves.
    const Profile p = Profile::move(time_zero, {1000, 0}, 1000 - 875, 100000, r);
    EXPECT_DOUBLE_EQ(p.at(at_s(0.25)).position, 1000);
    EXPECT_DOUBLE_EQ(p.at(at_s(0.25)).velocity, -250);
    EXPECT_NEAR(p.at(at_s(0.5)).position, 1000, 1e-9);
    EXPECT_LT(p.at(at_s(0.51)).position, 1000);
    EXPECT_EQ(p.end() - time_zero, std::chrono::seconds(2));  // 1000 motor pulses, triangle
    EXPECT_NEAR(p.at(p.end() - Duration{1}).position, 125, 1e-6);
    EXPECT_EQ(p.end_position(), 125);
    // Same direction, and never moved before: nothing to take up.
    r.last_direction = -1;
    EXPECT_LT(Profile::move(time_zero, {1000, 0}, 125, 100000, r).at(at_s(0.1)).position, 1000);
    r.last_direction = 0;
    EXPECT_LT(Profile::move(time_zero, {1000, 0}, 125, 100000, r).at(at_s(0.1)).position, 1000);
    // More than the acceleration covers, at constant speed, and in a jog; reversal under way.
    r.last_direction = 1;
    const Profile slow = Profile::jog(time_zero, {}, -100, r);  // 5 pulses in the ramp of 0.1 s, 120 at 100 pulse/s
    EXPECT_DOUBLE_EQ(slow.at(at_s(1.2)).position, 0);
    EXPECT_NEAR(slow.at(at_s(1.3)).position, 0, 1e-9);
    EXPECT_NEAR(slow.at(at_s(2.3)).position, -100, 1e-9);
    const Profile turn = Profile::jog(time_zero, {0, 500}, -500, r);  // 0.5 s and 125 pulses on, then 0.5 s uncounted
    EXPECT_NEAR(turn.at(at_s(0.5)).position, 125, 1e-9);
    EXPECT_NEAR(turn.at(at_s(1.0)).position, 125, 1e-9);
    EXPECT_NEAR(turn.at(at_s(2.0)).position, -375, 1e-9);
}

TEST(TwinProfile, FirstDeparture) {
    const Profile p = Profile::move(time_zero, {}, 20000, 10000, ramps(10000, 10000));
    EXPECT_NEAR(seconds(p.first_departure(time_zero, 0, 5000) - time_zero), 1.0, 1e-8);
    EXPECT_NEAR(seconds(p.first_departure(time_zero, 0, 10000) - time_zero), 1.5, 1e-8);
    EXPECT_NEAR(seconds(p.first_departure(at_s(1.2), 0, 10000) - time_zero), 1.5, 1e-8);
    EXPECT_EQ(p.first_departure(at_s(1.7), 0, 10000), at_s(1.7));
    EXPECT_EQ(p.first_departure(time_zero, 0, 20001), never);
    EXPECT_EQ(Profile::rest(3).first_departure(time_zero, 0, 4), never);
    EXPECT_NEAR(seconds(Profile::jog(time_zero, {}, -100, ramps(1e9, 1e9)).first_departure(time_zero, 0, 1000) - time_zero), 10, 1e-3);
    // Over there and back: leaves on the way out.
    const Profile back = Profile::jog(time_zero, {0, 1000}, -1000, ramps(1000, 1000));
    EXPECT_EQ(back.first_departure(time_zero, 0, 501) - time_zero > std::chrono::seconds(2), true);
    EXPECT_NEAR(seconds(back.first_departure(time_zero, 0, 375) - time_zero), 0.5, 1e-6);
}

// --- against a numerical integrator ----------------------------------------------------------------------------------------

/// What section 4.2 and 4.3 say, step by step: one small step of time after the other, no planning ahead.
struct Integrator {
    enum class Goal { none, jog, move, stop } goal = Goal::none;
    double p = 0, v = 0;          // signed
    double want = 0, target = 0;  // jog speed, move target
    double speed = 0, a = 1, d = 1, ss = 0, rate = 1;
    static constexpr double dt = 1e-5;

    static double sign(double x) { return x < 0 ? -1 : 1; }

    /// Slows down by r; below `floor` it stands at `to`.
    void slow(double r, double floor, double to) {
        const double next = std::abs(v) - r * dt;
        v = next <= floor ? sign(v) * to : sign(v) * next;
    }
    void step() {
        switch (goal) {
            case Goal::none:
                v = 0;
                return;
            case Goal::stop:
                slow(rate, ss, 0);
                if (v == 0) goal = Goal::none;
                break;
            case Goal::jog: {
                const double w = std::abs(want);
                if (v != 0 && (want == 0 || v * want < 0)) {
                    slow(d, ss, 0);
                } else if (w > 0) {
                    const double s = v == 0 ? std::min(ss, w) : std::abs(v);
                    if (s < w) {
                        v = sign(want) * std::min(w, std::max(s, std::min(ss, w)) + a * dt);
                    } else if (s > w) {
                        v = sign(want) * s;
                        slow(d, std::max(w, std::min(ss, s)), w);
                    } else {
                        v = sign(want) * s;
                    }
                } else {
                    goal = Goal::none;
                }
                break;
            }
            case Goal::move: {
                const double left = target - p;
                if (v == 0 && left == 0) {
                    goal = Goal::none;
                    return;
                }
                const double s = std::abs(v);
                const double ahead = v == 0 ? std::abs(left) : left * sign(v);
                const double brake = s > ss ? (s * s - ss * ss) / (2 * d) : 0;
                if (v != 0 && (ahead <= 0 || brake > ahead + s * dt * 2 + 0.5)) {
                    slow(d, ss, 0);
                    break;
                }
                const double dir = v == 0 ? sign(left) : sign(v);
                const double low = std::min(ss, speed);
                double s2 = std::max(s, low);
                s2 = s2 > speed ? std::max(speed, s2 - d * dt <= std::max(speed, std::min(ss, s2)) ? speed : s2 - d * dt)
                                : std::min(speed, s2 + a * dt);
                s2 = std::min(s2, std::max(low, std::sqrt(ss * ss + 2 * d * ahead)));
                if (s2 * dt >= ahead || (ss == 0 && ahead < 1e-3)) {
                    p = target;
                    v = 0;
                    goal = Goal::none;
                    return;
                }
                v = dir * s2;
                break;
            }
        }
        p += v * dt;
    }
};

/// Random motions by the wire; position and speed of the twin against the integrator at every millisecond.
TEST(TwinMotion, AgreesWithTheIntegratorInRandomSequences) {
    std::mt19937 random(20231101);
    const auto between = [&](int low, int high) { return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1)); };
    double worst_position = 0;
    for (int sequence = 0; sequence < 24; ++sequence) {
        Bench b;
        b.setup({"95 01"});
        Integrator i;
        i.ss = sequence % 3 == 0 ? 0 : between(50, 1500);
        b.setup({"9B " + le32(static_cast<int>(i.ss))});
        for (int leg = 0; leg < 7; ++leg) {
            const int a = between(3000, 60000);
            const int d = between(3000, 60000);
            const int v = between(200, 9000);
            const int what = between(0, 5);
            if (what == 5 && b.stopped() == false) {
                i.goal = Integrator::Goal::stop;
                i.rate = 1'600'000;
                b.setup({"97"});
            } else {
                b.setup({"99 " + le32(a), "9A " + le32(d)});
                i.a = a;
                i.d = d;
                i.speed = v;
                if (what <= 1) {
                    const int to = what == 0 ? v : -v;
                    i.goal = Integrator::Goal::jog;
                    i.want = to;
                    b.setup({"9D " + le32(to), "96"});
                } else {
                    const int to = between(-6000, 6000);
                    i.goal = Integrator::Goal::move;
                    i.target = to;
                    b.setup({"A0 " + le32(to), "9E " + le32(between(0, 1) == 0 ? v : -v), "96"});  // the sign of SP says nothing
                }
            }
            const int duration_ms = between(50, 900);
            for (int ms = 0; ms < duration_ms; ++ms) {
                double low = i.v, high = i.v;
                for (int k = 0; k < 100; ++k) {
                    i.step();
                    low = std::min(low, i.v);
                    high = std::max(high, i.v);
                }
                b.pass_ms(1);
                const TwinMechanics m = b.mechanics();
                const double error = std::abs(m.position - i.p);
                worst_position = std::max(worst_position, error);
                ASSERT_LT(error, 0.6) << "sequence " << sequence << " leg " << leg << " ms " << ms << " what " << what;
                // Instants of speed steps may differ by microseconds: the speed lies within what was seen in this millisecond.
                Integrator next = i;
                for (int k = 0; k < 20; ++k) {
                    next.step();
                    low = std::min(low, next.v);
                    high = std::max(high, next.v);
                }
                // The last pulses at the cut-in speed take milliseconds each: there the positions decide alone.
                if (std::abs(i.target - m.position) < 3) continue;
                ASSERT_GT(m.velocity, low - 2) << "sequence " << sequence << " leg " << leg << " ms " << ms;
                ASSERT_LT(m.velocity, high + 2) << "sequence " << sequence << " leg " << leg << " ms " << ms;
            }
            // Do not carry the small error over to the next leg.
            const TwinMechanics m = b.mechanics();
            i.p = m.position;
            i.v = m.velocity;
        }
    }
    RecordProperty("worst_position_error_milli_pulses", static_cast<int>(worst_position * 1000));
    EXPECT_GT(worst_position, 0) << "the two are computed in different ways";
}

/// Continuous position, speed never above the larger of the new and the old one, exact end: for many random replans, by the plans alone.
TEST(TwinMotion, PropertiesOfRandomPlans) {
    std::mt19937 random(342);
    std::uniform_real_distribution<double> unit(0, 1);
    for (int round = 0; round < 3000; ++round) {
        const double ss = round % 4 == 0 ? 0 : unit(random) * 2000;
        Ramps r = ramps(100 + unit(random) * 100000, 100 + unit(random) * 100000, ss);
        if (round % 7 == 0) r.acceleration = twin::no_ramp;
        if (round % 11 == 0) r.deceleration = twin::no_ramp;
        if (round % 3 == 0) {
            r.backlash = std::floor(unit(random) * 300);
            r.last_direction = round % 2 == 0 ? 1 : -1;
        }
        const double vt = 1 + unit(random) * 20000;
        MotionState from;
        from.position = std::floor((unit(random) - 0.5) * 20000);
        if (round % 5 != 0) from.velocity = (unit(random) - 0.5) * 2 * 15000;
        const bool move = round % 2 == 0;
        const double target = std::floor((unit(random) - 0.5) * 20000);
        const Profile p =
            move ? Profile::move(time_zero, from, target, vt, r) : Profile::jog(time_zero, from, unit(random) < 0.5 ? vt : -vt, r);
        const double limit = std::max(vt, std::abs(from.velocity)) * (1 + 1e-9) + 1e-6;
        ASSERT_LE(p.size(), 8u);
        for (std::size_t s = 0; s < p.size(); ++s) {
            const auto& g = p[s];
            ASSERT_GT(g.duration, 0) << round;
            if (s > 0) {
                const auto& before = p[s - 1];
                ASSERT_NEAR(g.begin, before.begin + before.duration, 1e-9);
                ASSERT_NEAR(g.position, before.position_at(before.duration), 1e-4) << round << " piece " << s;
            } else {
                ASSERT_EQ(g.position, from.position);
            }
            ASSERT_LE(std::abs(g.velocity), limit) << round;
            if (g.duration < 1e300) {
                ASSERT_LE(std::abs(g.velocity_at(g.duration)), limit) << round;
            }
        }
        if (move) {
            ASSERT_TRUE(p.reaches_target());
            ASSERT_EQ(p.end_position(), target);
            ASSERT_NE(p.end(), never);
            if (p.size() > 0) {
                const auto& last = p[p.size() - 1];
                ASSERT_NEAR(last.position_at(last.duration), target, 1e-3) << round;
            }
            ASSERT_EQ(p.at(p.end()).position, target);
            ASSERT_EQ(p.at(p.end()).velocity, 0);
        } else {
            ASSERT_EQ(p.end(), never);
            ASSERT_NEAR(std::abs(p.at(at_s(5000)).velocity), vt, 1e-6);
        }
        // By samples too: no jump larger than the speed allows.
        const double length = move ? end_s(p) : 3;
        double previous = p.at(time_zero).position;
        for (int k = 1; k <= 200; ++k) {
            const double now = p.at(at_s(length * k / 200)).position;
            ASSERT_LE(std::abs(now - previous), limit * length / 200 + 1e-3) << round;
            previous = now;
        }
    }
}

// --- by the wire -----------------------------------------------------------------------------------------------------------

constexpr const char* rt_in_position = "5A 29 00 00 00 ";

TEST(TwinMotion, PointToPointByTheWire) {
    Bench b;
    b.setup({"95 01", "9F 20 4E 00 00", "9E 10 27 00 00"});
    const double began = seconds(b.now() - time_zero);
    EXPECT_EQ(b.ask("96"), "16 00 00 00 00");
    EXPECT_FALSE(b.stopped());
    EXPECT_FALSE(b.in_position());
    b.pass_ms(1000);
    EXPECT_EQ(b.position(), 5000);
    EXPECT_EQ(b.speed(), 10000);
    EXPECT_EQ(b.ask("9E"), "1E 10 27 00 00");
    EXPECT_EQ(b.ask("91 01"), "11 01 10 27 00 88 13 00 00");
    b.pass_ms(500);
    EXPECT_EQ(b.relative(), 10000);
    const Lines end = b.pass_ms(2000);
    EXPECT_EQ(end, Lines{rt_in_position + le32(20000)});
    EXPECT_NEAR(b.last_at() - began, 3.000, 1e-9);
    EXPECT_TRUE(b.stopped());
    EXPECT_TRUE(b.in_position());
    EXPECT_EQ(b.position(), 20000);
    EXPECT_EQ(b.drive().deadline(), never);
    // The short one.
    b.setup({"9F 80 0C 00 00", "96"});
    EXPECT_FALSE(b.in_position());
    const double second = seconds(b.now() - time_zero);
    EXPECT_EQ(b.pass_ms(2000), Lines{rt_in_position + le32(23200)});
    EXPECT_NEAR(b.last_at() - second, 1.1314, 5e-5);
    EXPECT_EQ(b.relative(), 3200);
    // The flag is cleared by MS[0]=0; the notification by IE[8].
    EXPECT_EQ(b.ask("91 00 00").substr(0, 11), "11 00 05 01");
    b.setup({"87 08 00 00", "96"});
    EXPECT_TRUE(b.pass_ms(2000).empty());
    EXPECT_TRUE(b.in_position());
    EXPECT_EQ(b.position(), 26400);
}

TEST(TwinMotion, RepeatedBegin) {
    Bench b;
    b.setup({"95 01", "9F 64 00 00 00", "9E E8 03 00 00", "96"});
    b.pass_ms(1000);
    EXPECT_EQ(b.position(), 100);
    b.setup({"96"});
    b.pass_ms(1000);
    EXPECT_EQ(b.position(), 200) << "PR moves again by PR";
    b.setup({"A0 C8 00 00 00"});
    EXPECT_EQ(b.send("96"), (Lines{"16 00 00 00 00", rt_in_position + le32(200)})) << "PA is there at once";
    EXPECT_TRUE(b.in_position());
    EXPECT_TRUE(b.stopped());
}

TEST(TwinMotion, NegativeTargetsAndSignOfTheSpeed) {
    Bench b;
    b.setup({"95 01", "A0 " + le32(-5000), "9E E8 03 00 00", "96"});
    EXPECT_EQ(b.pass_ms(6000), Lines{rt_in_position + le32(-5000)});
    b.setup({"A0 " + le32(5000), "9E " + le32(-2000), "96"});
    EXPECT_EQ(b.pass_ms(10000), Lines{rt_in_position + le32(5000)});
    b.setup({"9D " + le32(-3000), "96"});
    b.pass_ms(2000);
    EXPECT_EQ(b.speed(), -3000);
    EXPECT_EQ(b.ask("91 01").substr(0, 14), "11 01 48 F4 FF");  // 24 bits
}

TEST(TwinMotion, ReplanUnderWay) {
    Bench b;
    b.setup({"95 01", "A0 " + le32(100000), "9E 10 27 00 00", "96"});
    b.pass_ms(2000);
    EXPECT_EQ(b.position(), 15000);
    // Back to 10000: 1 s and 5000 pulses to brake, then 10000 pulses back.
    b.setup({"A0 " + le32(10000), "96"});
    EXPECT_EQ(b.relative(), 0) << "a BG is a start of motion";
    b.pass_ms(1000);
    EXPECT_EQ(b.position(), 20000);
    EXPECT_EQ(b.speed(), 0);
    EXPECT_FALSE(b.stopped());
    EXPECT_EQ(b.pass_ms(3000), Lines{rt_in_position + le32(10000)});
    // PR under way adds to where it is.
    b.setup({"A0 " + le32(100000), "96"});
    b.pass_ms(2000);
    const int there = b.position();
    b.setup({"9F " + le32(20000), "96"});
    EXPECT_EQ(b.pass_ms(10000), Lines{rt_in_position + le32(there + 20000)});
    // JV under way, without and with BG; the old target is forgotten.
    b.setup({"A0 " + le32(500000), "96"});
    b.pass_ms(1500);
    b.setup({"9D " + le32(2000)});
    b.pass_ms(1000);
    EXPECT_EQ(b.speed(), 10000);
    b.setup({"96"});
    b.pass_ms(1000);
    EXPECT_EQ(b.speed(), 2000);
    EXPECT_TRUE(b.pass_ms(100000).empty());
    EXPECT_EQ(b.speed(), 2000);
    EXPECT_EQ(b.drive().deadline(), never) << "a jog at its speed has nothing to wait for";
    b.setup({"9D 00 00 00 00", "96"});
    b.pass_ms(200);
    EXPECT_TRUE(b.stopped());
    EXPECT_FALSE(b.in_position());
}

TEST(TwinMotion, ValuesActAtTheNextBegin) {
    Bench b;
    b.setup({"95 01", "9D 10 27 00 00", "96"});
    b.pass_ms(500);
    b.setup({"99 A0 86 01 00", "9B E8 03 00 00"});  // AC = 100000, SS = 1000
    b.pass_ms(100);
    EXPECT_EQ(b.speed(), 6000) << "AC in motion: the profile under way goes on";
    b.setup({"96"});
    b.pass_ms(40);
    EXPECT_EQ(b.speed(), 10000);
    // SD acts at once; the cut-in speed of the last BG.
    b.setup({"9C 20 A1 07 00", "97"});  // 500,000: (10000 - 1000) / 500000 = 18 ms
    b.pass_ms(17.99);
    EXPECT_FALSE(b.stopped());
    b.pass_ms(0.02);
    EXPECT_TRUE(b.stopped());
}

TEST(TwinMotion, RampTimes) {
    Bench b;
    b.setup({"86 04 01 00", "99 F4 01 00 00", "9A E8 03 00 00", "95 01"});  // 500 ms up, 1000 ms down
    EXPECT_EQ(b.ask("99 61 EA 00 00"), "0F 00 33 99 00 00 00");             // 60001 ms
    EXPECT_EQ(b.ask("9A 61 EA 00 00"), "0F 00 33 9A 00 00 00");
    b.setup({"9D 10 27 00 00", "96"});
    b.pass_ms(250);
    EXPECT_EQ(b.speed(), 5000);
    b.pass_ms(250);
    EXPECT_EQ(b.speed(), 10000);
    b.setup({"9D 00 00 00 00", "96"});
    b.pass_ms(500);
    EXPECT_EQ(b.speed(), 5000) << "slowing down takes DC ms";
    b.pass_ms(500.001);
    EXPECT_TRUE(b.stopped());
    // A stop stays a rate.
    b.setup({"9D 10 27 00 00", "96"});
    b.pass_ms(1000);
    b.setup({"97"});
    b.pass_ms(6.24);
    EXPECT_FALSE(b.stopped());
    b.pass_ms(0.02);
    EXPECT_TRUE(b.stopped());
    // PTP: 0.5 s up, 1 s down, 2500 + 5000 pulses, the rest at full speed.
    b.setup({"9F " + le32(17500), "9E 10 27 00 00", "96"});
    const Instant began = b.now();
    b.pass_ms(5000);
    EXPECT_EQ(b.last_instant() - began, std::chrono::milliseconds(2500));
    // From the cut-in speed; not above it: no ramp.
    b.setup({"9B D0 07 00 00", "9D 10 27 00 00", "96"});
    b.pass_ms(250);
    EXPECT_EQ(b.speed(), 6000);
    b.setup({"97"});
    b.pass_ms(100);
    b.setup({"9D DC 05 00 00", "96"});
    EXPECT_EQ(b.speed(), 1500);
    // SD = 0 (possible here alone): at once.
    b.setup({"9C 00 00 00 00", "97"});
    EXPECT_TRUE(b.stopped());
    // The unit changes at once, the numbers stay.
    b.setup({"86 04 00 00"});
    EXPECT_EQ(b.ask("99"), "19 F4 01 00 00");
}

TEST(TwinMotion, StopRampsDifferByTheirRates) {
    Bench b;
    b.setup({"95 01", "9D 10 27 00 00", "96"});
    b.pass_ms(2000);
    const int before = b.position();
    b.setup({"97"});
    EXPECT_TRUE(b.pass_ms(1000).empty()) << "a stop is no arrival";
    EXPECT_EQ(b.position(), before + 31);
    EXPECT_FALSE(b.in_position());
    EXPECT_EQ(b.drive().deadline(), never);
    b.setup({"97"});  // at rest: nothing
    EXPECT_TRUE(b.stopped());
    EXPECT_EQ(b.ask("96"), "16 00 00 00 00");
}

TEST(TwinMotion, DriverOffInMotionAndNoMotionByDriverOn) {
    Bench b;
    b.setup({"95 01", "9D 10 27 00 00", "96"});
    b.pass_ms(1000);
    b.setup({"95 00"});
    EXPECT_FALSE(b.stopped()) << "the shaft runs out";
    EXPECT_EQ(b.position(), 5000);
    EXPECT_TRUE(b.pass_ms(1000).empty());
    EXPECT_TRUE(b.stopped());
    EXPECT_EQ(b.position(), 5313) << "10000^2 / (2 * 50 turns/s^2 * 3200)";
    b.setup({"95 01"});
    b.pass_ms(1000);
    EXPECT_EQ(b.position(), 5313) << "values stay pending, nothing moves by MO=1";
    b.setup({"96"});
    b.pass_ms(1000);
    EXPECT_EQ(b.position(), 10313);
}

TEST(TwinMotion, SpeedSaturatesInTwentyFourBits) {
    Bench b;
    b.setup({"95 01", "9C FF FF FF FF", "9A 40 D2 DF 03", "99 40 D2 DF 03", "9D " + le32(20'000'000), "96"});
    b.pass_ms(1000);
    EXPECT_EQ(b.ask("91 01").substr(3, 11), "01 FF FF 7F");
    EXPECT_EQ(b.speed(), 20'000'000);
    b.setup({"9D " + le32(-20'000'000), "96"});
    b.pass_ms(10000);
    EXPECT_EQ(b.ask("91 01").substr(3, 11), "01 01 00 80");
    EXPECT_EQ(b.speed(), -20'000'000);
}

TEST(TwinMotion, CounterWrapsAtThirtyTwoBits) {
    Bench b;
    b.setup({"95 01", "99 40 D2 DF 03", "9C FF FF FF FF", "9A 40 D2 DF 03", "A0 " + le32(2147483000), "9E " + le32(100'000'000), "96"});
    EXPECT_EQ(b.pass_ms(60000), (Lines{"5A 00 19 00 00 00", rt_in_position + le32(2147483000)})) << "too fast for any motor, too";
    b.setup({"9F " + le32(1000), "96"});
    EXPECT_EQ(b.pass_ms(60000), (Lines{rt_in_position + le32(2147484000)}));
    EXPECT_EQ(b.position(), -2147483296);
    EXPECT_EQ(b.relative(), 1000);
    b.setup({"A0 " + le32(-2147483000), "96"});  // near by: the counter is where it says
    EXPECT_EQ(b.pass_ms(1000), Lines{rt_in_position + le32(-2147483000)});
    EXPECT_EQ(b.relative(), 296);
}

TEST(TwinMotion, BacklashByTheWire) {
    Bench b;
    b.setup({"AD 0A 00 00 00", "95 01", "9B E8 03 00 00", "9F 64 00 00 00", "9E E8 03 00 00"});  // SS = SP = 1000: constant speed
    const auto took_ms = [&] {
        b.setup({"96"});
        const Instant began = b.now();
        b.pass_ms(1000);
        return seconds(b.last_instant() - began) * 1000;
    };
    EXPECT_NEAR(took_ms(), 100, 1e-6);
    EXPECT_NEAR(took_ms(), 100, 1e-6);
    b.setup({"9F " + le32(-100)});
    EXPECT_NEAR(took_ms(), 110, 1e-6) << "10 pulses more on a reversal";
    EXPECT_EQ(b.position(), 100) << "that the counter does not count";
    EXPECT_NEAR(took_ms(), 100, 1e-6);
    b.setup({"9F 64 00 00 00"});
    EXPECT_NEAR(took_ms(), 110, 1e-6);
}

TEST(TwinMotion, RelativePositionRule) {
    Bench b;
    b.setup({"95 01", "9F E8 03 00 00", "9E 10 27 00 00", "96"});
    b.pass_ms(2000);
    EXPECT_EQ(b.relative(), 1000);
    b.pass_ms(2000);
    EXPECT_EQ(b.relative(), 1000) << "frozen at rest";
    b.setup({"9D 10 27 00 00", "96"});
    EXPECT_EQ(b.relative(), 0);
    b.pass_ms(1000);
    EXPECT_EQ(b.relative(), 5000);
    EXPECT_EQ(b.position(), 6000);
    b.setup({"97"});
    b.pass_ms(1000);
    EXPECT_EQ(b.relative(), 5031);
    b.setup({"A1"});
    EXPECT_EQ(b.relative(), 0);
    EXPECT_EQ(b.position(), 0);
}

TEST(TwinMotion, GroupBeginStartsInTheSameInstant) {
    Bench b;
    b.add(can_setup("6"));
    for (unsigned n : {5u, 6u}) {
        b.address(n);
        b.setup({"95 01", "9D " + le32(n == 5 ? 1000 : -2000), "99 " + le32(n == 5 ? 1000 : 2000)});
    }
    b.address(5);
    EXPECT_TRUE(b.send_to(10, "16").empty());
    b.pass_ms(1000);
    EXPECT_DOUBLE_EQ(b.mechanics(0).position, 500);
    EXPECT_DOUBLE_EQ(b.mechanics(1).position, -1000);
    EXPECT_TRUE(b.send_to(0, "17").empty());
    EXPECT_TRUE(b.send_to(0, "16").size() == 2) << "both are on their SD ramp: two reports, though nobody asked for an answer";
    b.pass_ms(100);
    EXPECT_EQ(b.mechanics(0).velocity, 0);
    EXPECT_EQ(b.mechanics(1).velocity, 0);
}

TEST(TwinMotion, WireAndShaftAgreeInClosedLoop) {
    Bench b;
    b.setup({"95 01", "A0 " + le32(12345), "9E 10 27 00 00", "96"});
    for (int i = 0; i < 310; ++i) {
        b.pass_ms(7.3);
        EXPECT_EQ(b.position(), std::lround(b.mechanics().position));
        EXPECT_EQ(b.speed(), std::lround(b.mechanics().velocity));
    }
    EXPECT_EQ(b.position(), 12345);
}

}  // namespace
}  // namespace axisgate::uim342::test
