// Tests of the closed-form profiles: times and places against independent formulas, S ramps, and invariants over random moves.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "adapters/mcode/twin/profile.hpp"

namespace axisgate::mcode::twin::test {
namespace {

constexpr Instant start{};

Kinematics factory() { return {1000, 768000, {1, 0, 1e6}, {1, 0, 1e6}}; }

double length(const Profile& p) { return seconds(p.end() - start); }

TEST(McodeProfile, TheWorkedExampleOfTheManualTakes5Point7660Seconds) {
    // [L7217-7239, E-22]: ramps of 0.767 s and 294911.5 steps, cruise 4.2320 s.
    const Profile p = Profile::move(start, {}, 3840000, factory(), false);
    EXPECT_NEAR(length(p), 2 * 0.767 + (3840000.0 - 2 * 294911.5) / 768000, 1e-6);
    EXPECT_NEAR(length(p), 5.7660, 5e-5);
    EXPECT_NEAR(p.at(start + std::chrono::microseconds(767000)).position, 294911.5, 1e-3);
    EXPECT_NEAR(p.at(start + std::chrono::microseconds(767000)).velocity, 768000, 1e-3);
    EXPECT_EQ(p.at(p.end()).position, 3840000);
    EXPECT_EQ(p.at(p.end()).velocity, 0);
}

TEST(McodeProfile, ShortMovesReachThePeakOfTheFormula) {
    struct Row {
        double distance, a, d, vi;
    };
    for (const Row& r : {Row{100000, 1e6, 1e6, 1000}, Row{51200, 2e6, 5e5, 100}, Row{-51200, 5e5, 2e6, 20000}, Row{1, 1e6, 1e6, 1000},
                         Row{-2, 66, 66, 1}}) {
        Kinematics k = factory();
        k.vi = r.vi;
        k.up.rate = r.a;
        k.down.rate = r.d;
        const Profile p = Profile::move(start, {}, r.distance, k, false);
        const double l = std::abs(r.distance);
        const double peak = std::sqrt((2 * l * r.a * r.d + r.vi * r.vi * (r.a + r.d)) / (r.a + r.d));
        ASSERT_LT(peak, k.vm);
        const double up = (peak - r.vi) / r.a, down = (peak - r.vi) / r.d;
        EXPECT_NEAR(length(p), up + down, 1e-8) << r.distance;
        EXPECT_NEAR(std::abs(p.at(start + Duration{static_cast<std::int64_t>(up * 1e9)}).velocity), peak, peak * 1e-6) << r.distance;
    }
}

TEST(McodeProfile, SpeedBeginsAndEndsAtVi) {
    const Profile p = Profile::move(start, {}, 200000, factory(), false);
    EXPECT_NEAR(p.at(start).velocity, 1000, 1e-9);
    EXPECT_NEAR(p.at(p.end() - Duration{100}).velocity, 1000, 1);
    EXPECT_EQ(p.at(p.end()).velocity, 0);
}

/// Independent shapes: acceleration of the S ramps as functions of time, integrated by small steps.
double shape(int type, double flat, double u) {
    const double rise = (1 - flat) / 2;
    const double part = u < rise ? u / rise : u > 1 - rise ? (1 - u) / rise : 1.0;
    return type == 3 ? (1 - std::cos(std::numbers::pi * part)) / 2 : part;
}

TEST(McodeProfile, SRampsFollowTheirShapeWithin256Points) {
    for (const int type : {2, 3}) {
        for (const int half : {0, 32, 64, 100}) {
            const RampTable table(type, half);
            const double flat = 2.0 * half / 256;
            const int n = 200000;
            double sum = 0;
            for (int i = 0; i < n; ++i)
                sum += shape(type, flat, (i + 0.5) / n) / n;
            double v = 0, s = 0;
            for (int i = 0; i < n; ++i) {
                v += shape(type, flat, (i + 0.5) / n) / n / sum;
                s += v / n;
                if (i % 5000 != 4999) continue;
                const double u = (i + 1.0) / n;
                EXPECT_NEAR(table.speed(u), v, 2e-4) << type << ' ' << half << ' ' << u;
                EXPECT_NEAR(table.travel(u), s, 2e-4) << type << ' ' << half << ' ' << u;
            }
            EXPECT_DOUBLE_EQ(table.speed(1), 1);
            EXPECT_NEAR(table.travel(1), 0.5, 1e-12);
            EXPECT_NEAR(sum, (1 + flat) / 2, 1e-6);  // so that T = 2*dv/(A*(1+f)) [E-23]
        }
    }
}

TEST(McodeProfile, AnSRampTakesTwiceAsLongAndItsPeakAccelerationIsA) {
    for (const int type : {2, 3}) {
        Kinematics k = factory();
        k.up = {type, 0, 1e6};
        k.down = {1, 0, 1e6};
        const Profile p = Profile::slew(start, {}, 768000, k);
        const double t = 2 * 767000 / 1e6;
        const auto v = [&](double s) { return p.at(start + Duration{static_cast<std::int64_t>(s * 1e9)}).velocity; };
        EXPECT_NEAR(v(t), 768000, 1e-3);
        EXPECT_LT(v(t - 0.01), 768000);
        EXPECT_NEAR(v(t / 2), (768000 + 1000) / 2.0, 1);
        double steepest = 0;
        for (double s = 0; s < t; s += 0.001)
            steepest = std::max(steepest, (v(s + 0.001) - v(s)) / 0.001);
        EXPECT_NEAR(steepest, 1e6, 1e4);
        k.up.half_flat = 127;  // almost linear
        const Profile q = Profile::slew(start, {}, 768000, k);
        EXPECT_NEAR(q.at(start + std::chrono::milliseconds(400)).velocity, 1000 + 1e6 * 0.4, 6000);
    }
}

TEST(McodeProfile, SlewChangesUnderWayAndStops) {
    Kinematics k = factory();
    const Profile p = Profile::slew(start, {}, 200000, k);
    EXPECT_EQ(p.end(), never);
    const Instant later = start + std::chrono::seconds(1);
    const Travel there = p.at(later);
    EXPECT_EQ(there.velocity, 200000);
    const Profile faster = Profile::slew(later, there, 400000, k);
    EXPECT_NEAR(faster.at(later + std::chrono::milliseconds(100)).velocity, 300000, 1e-6);
    EXPECT_EQ(faster.changing(later + std::chrono::milliseconds(100)), 1);
    const Profile slower = Profile::slew(later, there, 50000, k);
    EXPECT_NEAR(slower.at(later + std::chrono::milliseconds(100)).velocity, 100000, 1e-6);
    EXPECT_EQ(slower.changing(later + std::chrono::milliseconds(100)), -1);
    const Profile back = Profile::slew(later, there, -200000, k);
    EXPECT_NEAR(back.at(later + std::chrono::milliseconds(198)).velocity, 2000, 1e-6);
    EXPECT_NEAR(back.at(later + std::chrono::milliseconds(399)).velocity, -200000, 1100);
    const Profile stop = Profile::slew(later, there, 0, k);
    EXPECT_NEAR(seconds(stop.end() - later), 0.199, 1e-9);
    EXPECT_EQ(stop.end_position(), std::round(stop.end_position()));
    EXPECT_NEAR(stop.end_position(), there.position + (200000 + 1000) / 2.0 * 0.199, 0.6);
}

TEST(McodeProfile, AMoveThatCannotStopInTimeComesBack) {
    const Kinematics k = factory();
    const Travel running{100000, 300000};
    const Profile p = Profile::move(start, running, 100100, k, false);
    EXPECT_EQ(p.end_position(), 100100);
    double furthest = 0;
    for (Instant t = start; t < p.end(); t += std::chrono::milliseconds(1))
        furthest = std::max(furthest, p.at(t).position);
    EXPECT_NEAR(furthest, 100000 + (300000.0 * 300000 - 1e6) / 2e6, 50);
    const Profile on = Profile::move(start, running, 100100, k, true);
    EXPECT_EQ(on.end(), never);
    EXPECT_GT(on.at(start + std::chrono::seconds(10)).velocity, 767000);
}

TEST(McodeProfile, CrossingsAreTheInstantsAtWhichThePlaceIsPassed) {
    const Kinematics k = factory();
    const Profile p = Profile::move(start, {0, 50000}, -80000, k, false);  // forward, back, and to the target
    const Instant forward = p.crossing(start, 500);
    const Instant back = p.crossing(start, 500, -1);
    EXPECT_LT(forward, back);
    EXPECT_GT(p.at(forward).velocity, 0);
    EXPECT_LT(p.at(back).velocity, 0);
    EXPECT_NEAR(p.at(forward).position, 500, 0.01);
    EXPECT_NEAR(p.at(back).position, 500, 0.01);
    EXPECT_GE(p.at(forward).position, 500);
    EXPECT_LE(p.at(back).position, 500);
    EXPECT_EQ(p.crossing(start, -80001), never);
    EXPECT_LE(p.crossing(start, -80000), p.end());
    EXPECT_EQ(p.crossing(p.end(), 0), never);
    const Profile slew = Profile::slew(start, {}, 1000, k);
    EXPECT_NEAR(seconds(slew.crossing(start, 5000) - start), 5, 1e-6);
}

TEST(McodeProfile, RandomMovesEndExactlyNeverJumpBeyondViAndNeverExceedVm) {
    std::mt19937_64 random(20160530);
    const auto pick = [&](double low, double high) { return std::uniform_real_distribution<>(low, high)(random); };
    for (int n = 0; n < 400; ++n) {
        Kinematics k;
        k.vi = std::floor(pick(1, 20000));
        k.vm = std::floor(k.vi + pick(1, 800000));
        k.up = {static_cast<int>(random() % 3 + 1), static_cast<int>(random() % 128), std::floor(std::pow(10, pick(3, 7)))};
        k.down = {static_cast<int>(random() % 3 + 1), static_cast<int>(random() % 128), std::floor(std::pow(10, pick(3, 7)))};
        const double target = std::floor(pick(-1e6, 1e6));
        const Travel from{std::floor(pick(-1e5, 1e5)), n % 2 == 0 ? 0.0 : pick(-k.vm, k.vm)};
        const Profile p = Profile::move(start, from, target, k, false);
        ASSERT_NE(p.end(), never) << n;
        ASSERT_EQ(p.at(p.end()).position, target) << n;
        const double step = length(p) / 2000;
        const double steepest = std::max(k.up.rate, k.down.rate) * 1.001 * step;
        Travel last = p.at(start);
        for (int i = 1; i < 2000; ++i) {
            const Travel t = p.at(start + Duration{static_cast<std::int64_t>(i * step * 1e9)});
            ASSERT_LE(std::abs(t.velocity), std::max(k.vm, std::abs(from.velocity)) * (1 + 1e-9)) << n;
            // Continuous, but for the jumps of VI at starts and ends.
            ASSERT_LE(std::abs(t.velocity - last.velocity), steepest + 2 * k.vi + 1) << n << ' ' << i;
            // Position is the integral of speed.
            ASSERT_NEAR(t.position - last.position, (t.velocity + last.velocity) / 2 * step, (steepest + 2 * k.vi + 1) * step + 1e-6) << n;
            last = t;
        }
        const double before = p.at(p.end() - Duration{1}).position;
        ASSERT_NEAR(before, target, 0.01 + k.vm * 1e-8) << n;  // nothing is left to jump over
    }
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
