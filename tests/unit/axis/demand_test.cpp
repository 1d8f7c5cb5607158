// Orders compared with a reference that is stepped by a thousandth of a second, and laws over random orders.
#include "gateway/axis/demand.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace axisgate {
namespace {
using namespace std::chrono_literals;

Instant at_s(double s) { return Instant{} + 10s + std::chrono::duration_cast<Duration>(std::chrono::duration<double>(s)); }

TEST(Demand, KnowsNothingUntilToldWhereTheAxisRests) {
    Demand d;
    EXPECT_FALSE(d.known());
    d.rest(250);
    EXPECT_TRUE(d.known());
    EXPECT_EQ(d.at(at_s(5)).position, 250);
    EXPECT_EQ(d.at(at_s(5)).velocity, 0);
    EXPECT_TRUE(d.over(at_s(0)));
    d.forget();
    EXPECT_FALSE(d.known());
}

TEST(Demand, TrapezoidOfTextbook) {
    // 10000/s with 10000/s^2 over 20000: one second up, one along, one down.
    Demand d;
    d.rest(0);
    d.move(at_s(0), 20000, 10000, {10000, 10000, 0});
    EXPECT_NEAR(d.at(at_s(0.5)).position, 1250, 0.01);
    EXPECT_NEAR(d.at(at_s(1)).position, 5000, 0.01);
    EXPECT_NEAR(d.at(at_s(1.5)).velocity, 10000, 0.01);
    EXPECT_NEAR(d.at(at_s(2)).position, 15000, 0.01);
    EXPECT_NEAR(d.at(at_s(2.5)).position, 18750, 0.01);
    EXPECT_FALSE(d.over(at_s(2.999)));
    EXPECT_TRUE(d.over(at_s(3.001)));
    EXPECT_EQ(d.at(at_s(3.001)).position, 20000);
    EXPECT_EQ(d.at(at_s(60)).velocity, 0);
}

TEST(Demand, TriangleWhereTheSpeedIsNotReached) {
    Demand d;
    d.rest(0);
    d.move(at_s(0), -3200, 10000, {10000, 10000, 0});  // peak 5656.85 after 0.565685 s
    EXPECT_NEAR(d.at(at_s(0.565685)).velocity, -5656.85, 0.1);
    EXPECT_NEAR(d.at(at_s(0.565685)).position, -1600, 0.1);
    EXPECT_FALSE(d.over(at_s(1.1313)));
    EXPECT_TRUE(d.over(at_s(1.1315)));
    EXPECT_EQ(d.at(at_s(2)).position, -3200);
}

TEST(Demand, StartSpeedIsAStepAtBothEnds) {
    Demand d;
    d.rest(0);
    d.move(at_s(0), 4000, 2000, {1000, 1000, 1000});
    EXPECT_NEAR(d.at(at_s(0)).velocity, 1000, 1e-6);
    // Up and down 1 s and 1500 each, 1000 along at 2000: 2.5 s.
    EXPECT_NEAR(d.at(at_s(1)).position, 1500, 0.01);
    EXPECT_NEAR(d.at(at_s(2.4999)).velocity, 1000, 1);
    EXPECT_TRUE(d.over(at_s(2.5001)));
    d.rest(0);
    d.move(at_s(0), 500, 800, {1000, 1000, 1000});  // below the start speed: no ramp at all
    EXPECT_NEAR(d.at(at_s(0.25)).position, 200, 0.01);
    EXPECT_NEAR(d.at(at_s(0.6)).velocity, 800, 1e-6);
    EXPECT_TRUE(d.over(at_s(0.6251)));
}

TEST(Demand, WithoutRampsItGoesAndStandsAtOnce) {
    Demand d;
    d.rest(100);
    d.move(at_s(0), 1100, 500, {});
    EXPECT_EQ(d.at(at_s(0)).velocity, 500);
    EXPECT_NEAR(d.at(at_s(1)).position, 600, 1e-6);
    d.stop(at_s(1), {});
    EXPECT_NEAR(d.at(at_s(1.5)).position, 600, 1e-6);
    EXPECT_TRUE(d.over(at_s(1)));
}

TEST(Demand, RunGoesOnForEverAndStopsWithItsRamp) {
    Demand d;
    d.rest(0);
    d.run(at_s(0), -1000, {2000, 500, 0});
    EXPECT_NEAR(d.at(at_s(0.5)).position, -250, 1e-3);
    EXPECT_NEAR(d.at(at_s(3600)).velocity, -1000, 1e-6);
    EXPECT_FALSE(d.over(at_s(3600)));
    d.run(at_s(10), -250, {2000, 500, 0});  // slower: with the deceleration
    EXPECT_NEAR(d.at(at_s(11)).velocity, -500, 1e-3);
    EXPECT_NEAR(d.at(at_s(12)).velocity, -250, 1e-3);
    d.stop(at_s(20), {2000, 500, 0});
    EXPECT_FALSE(d.over(at_s(20.4)));
    EXPECT_TRUE(d.over(at_s(20.51)));
    EXPECT_EQ(d.at(at_s(21)).velocity, 0);
}

TEST(Demand, ReversalBrakesToRestFirst) {
    Demand d;
    d.rest(0);
    d.run(at_s(0), 1000, {1000, 2000, 0});
    const double there = d.at(at_s(2)).position;  // 1500
    EXPECT_NEAR(there, 1500, 1e-3);
    d.run(at_s(2), -1000, {1000, 2000, 0});
    EXPECT_NEAR(d.at(at_s(2.5)).velocity, 0, 1e-3);
    EXPECT_NEAR(d.at(at_s(2.5)).position, 1750, 1e-3);
    EXPECT_NEAR(d.at(at_s(3.5)).position, 1250, 1e-3);
    EXPECT_NEAR(d.at(at_s(4.5)).velocity, -1000, 1e-3);
    // A target behind it: the motion brakes and returns.
    d.rest(0);
    d.run(at_s(0), 1000, {1000, 1000, 0});
    d.move(at_s(2), 1600, 1000, {1000, 1000, 0});
    EXPECT_NEAR(d.at(at_s(3)).position, 2000, 1e-3);
    EXPECT_LT(d.at(at_s(3.5)).velocity, 0);
    EXPECT_EQ(d.at(at_s(10)).position, 1600);
}

TEST(Demand, SameTargetAgainWhileBrakingForItChangesNothing) {
    Demand d, again;
    for (Demand* x : {&d, &again}) {
        x->rest(0);
        x->move(at_s(0), 20000, 10000, {10000, 10000, 0});
    }
    for (int ms = 2100; ms < 3100; ms += 5) {
        if (ms % 25 == 0) again.move(at_s(ms / 1000.0), 20000, 10000, {10000, 10000, 0});
        ASSERT_NEAR(again.at(at_s(ms / 1000.0)).position, d.at(at_s(ms / 1000.0)).position, 1) << ms;
    }
}

/// Laws over random orders in random states: no jump of the position, never faster than the greater of order and present speed, never
/// steeper than the ramps (except steps to and from the start speed), and at the end exactly and permanently at the target.
TEST(Demand, LawsOverRandomOrders) {
    std::mt19937_64 seed(20261121);
    const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(seed); };
    for (int round = 0; round < 2000; ++round) {
        Demand d;
        d.rest(draw(-1000, 1000));
        double t = 0;
        double target = 0;
        bool ends = false;
        double fastest = 0, steepest = 0, step = 0;
        for (int order = 0; order < 4; ++order) {
            const DemandRamps r{round % 7 == 0 ? DemandRamps::at_once : draw(50, 5000),
                                round % 11 == 0 ? DemandRamps::at_once : draw(50, 5000), round % 3 == 0 ? draw(0, 300) : 0};
            const double speed = draw(1, 2000);
            fastest = std::max(std::abs(d.at(at_s(t)).velocity), speed);
            steepest = std::max(r.acceleration, r.deceleration);
            step = r.start_speed;
            switch (static_cast<int>(draw(0, 3))) {
                case 0:
                    d.run(at_s(t), draw(-1, 1) < 0 ? -speed : speed, r);
                    ends = false;
                    break;
                case 1:
                    d.stop(at_s(t), r);
                    ends = false;
                    break;
                default:
                    target = draw(-3000, 3000);
                    d.move(at_s(t), target, speed, r);
                    ends = true;
                    break;
            }
            const double dt = 0.001, until = t + draw(0.01, 3);
            DemandState before = d.at(at_s(t));
            for (t += dt; t < until; t += dt) {
                const DemandState now = d.at(at_s(t));
                ASSERT_LE(std::abs(now.velocity), fastest * 1.0001) << round;
                ASSERT_LE(std::abs(now.position - before.position), fastest * dt * 1.001 + 0.51) << round;
                const double faster = std::abs(now.velocity) - std::abs(before.velocity);
                if (steepest < DemandRamps::at_once) {
                    ASSERT_LE(faster, steepest * dt * 1.001 + step + 1e-6) << round;
                }
                before = now;
            }
        }
        if (!ends) continue;
        EXPECT_TRUE(d.over(at_s(t + 3600))) << round;
        EXPECT_EQ(d.at(at_s(t + 3600)).position, target) << round;
        EXPECT_EQ(d.at(at_s(t + 3600)).velocity, 0) << round;
    }
}

/// The closed form against the same physics in small steps, without a start speed.
TEST(Demand, AgreesWithAStepwiseReference) {
    std::mt19937_64 seed(7);
    const auto draw = [&](double low, double high) { return std::uniform_real_distribution<double>(low, high)(seed); };
    for (int round = 0; round < 200; ++round) {
        const double a = draw(200, 4000), dec = draw(200, 4000), speed = draw(50, 2000), way = draw(1, 5000);
        Demand d;
        d.rest(0);
        d.move(at_s(0), way, speed, {a, dec, 0});
        double p = 0, v = 0;
        const double dt = 1e-4;
        for (int i = 1; p < way && i < 2'000'000; ++i) {
            // Brakes as late as possible, otherwise accelerates up to the speed.
            const bool brakes = v * v / (2 * dec) >= way - p;
            v = brakes ? std::max(0.0, v - dec * dt) : std::min(speed, v + a * dt);
            if (v <= 0) break;
            p += v * dt;
            if (i % 100 == 0) {
                ASSERT_NEAR(d.at(at_s(i * dt)).position, p, speed * dt * 4 + 0.5) << "round " << round << " after " << i * dt << " s";
            }
        }
    }
}

}  // namespace
}  // namespace axisgate
