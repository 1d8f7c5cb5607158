// Profiles of the simulated servo: three shapes of ramps, from any speed and acceleration, to a speed or to a position. The speed never
// jumps; with limited jerk the acceleration does not either.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "adapters/cia402/tests/twin_bench.hpp"
#include "adapters/cia402/twin/profile.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using namespace std::chrono_literals;

double length(const Profile& p) {
    double s = 0;
    for (const Segment& x : p.segments)
        s += x.seconds;
    return s;
}
/// Samples the profile in small steps: the highest speed, acceleration and jerk.
struct Seen {
    double velocity = 0, up = 0, down = 0, jump = 0;
};
Seen seen(Motion at, const Profile& p, bool jerks) {
    Seen most;
    for (const Segment& s : p.segments) {
        const Motion first = along(at, s, 0);
        EXPECT_NEAR(first.velocity, at.velocity, 1e-6);
        most.jump = std::max(most.jump, std::fabs(first.acceleration - at.acceleration));
        for (int i = 0; i <= 50; ++i) {
            const Motion m = along(at, s, s.seconds * i / 50);
            most.velocity = std::max(most.velocity, std::fabs(m.velocity));
            (m.acceleration * m.velocity >= 0 ? most.up : most.down) =
                std::max(m.acceleration * m.velocity >= 0 ? most.up : most.down, std::fabs(m.acceleration));
        }
        at = along(at, s, s.seconds);
    }
    if (jerks) most.jump = std::max(most.jump, std::fabs(at.acceleration));
    return most;
}

TEST(Cia402Profile, JerkminOfTheManual) {  // 100 qc/ms, 0.2 qc/ms^2, 0.001 qc/ms^3: 200 ms acceleration, 300 ms constant speed, 200 ms
                                           // deceleration
    Ramps r{100'000, 200'000, 200'000, Shape::jerk, {1e6, 1e6, 1e6, 1e6}};
    const Profile p = profile_to_speed({}, 100'000, r);
    ASSERT_EQ(p.segments.size(), 3u);
    EXPECT_NEAR(p.segments[0].seconds, 0.2, 1e-9);
    EXPECT_NEAR(p.segments[1].seconds, 0.3, 1e-9);
    EXPECT_NEAR(p.segments[2].seconds, 0.2, 1e-9);
    EXPECT_NEAR(p.end.velocity, 100'000, 1e-9);
    r.jerk = {2e6, 1e6, 4e6, 0.5e6};  // a different jerk for each ramp
    const Profile q = profile_to_place({}, 1'000'000, r);
    ASSERT_EQ(q.segments.size(), 7u);
    EXPECT_NEAR(q.segments[0].seconds, 0.1, 1e-9);
    EXPECT_NEAR(q.segments[2].seconds, 0.2, 1e-9);
    EXPECT_NEAR(q.segments[4].seconds, 0.05, 1e-9);
    EXPECT_NEAR(q.segments[6].seconds, 0.4, 1e-9);
    EXPECT_EQ(q.end.position, 1'000'000);
}

TEST(Cia402Profile, ASineTakesAsLongAsALine) {
    const Ramps line{1000, 5000, 2000}, sine{1000, 5000, 2000, Shape::sine};
    for (const double way : {10.0, 300.0, 5000.0, -700.0})
        EXPECT_NEAR(length(profile_to_place({}, way, line)), length(profile_to_place({}, way, sine)), 1e-9) << way;
    const Profile up = profile_to_speed({}, 1000, sine);
    ASSERT_EQ(up.segments.size(), 1u);
    EXPECT_NEAR(along({}, up.segments[0], 0.1).velocity, 500, 1e-9) << "v = vmax * (1 - cos(pi t / T)) / 2";
    EXPECT_NEAR(along({}, up.segments[0], 0.05).velocity, 1000 * (1 - std::cos(M_PI / 4)) / 2, 1e-9);
}

TEST(Cia402Profile, FromAnywhereToAnywhereWithoutAJump) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> unit(-1, 1);
    for (int i = 0; i < 600; ++i) {
        SCOPED_TRACE(i);
        const auto shape = static_cast<Shape>(i % 3);
        Ramps r{1000 * std::fabs(unit(random)) + 10, 5000 * std::fabs(unit(random)) + 50, 5000 * std::fabs(unit(random)) + 50, shape};
        for (double& j : r.jerk)
            j = 100'000 * std::fabs(unit(random)) + 500;
        Motion from{1000 * unit(random), r.velocity * unit(random), 0};
        if (shape == Shape::jerk) from.acceleration = 0.5 * std::min(r.up, r.down) * unit(random);
        const double target = 3000 * unit(random);
        const Profile p = profile_to_place(from, target, r);
        EXPECT_LE(p.segments.size(), 16u);
        EXPECT_EQ(p.end.position, target);
        EXPECT_EQ(p.end.velocity, 0);
        Motion at = from;
        for (const Segment& s : p.segments)
            at = along(at, s, s.seconds);
        EXPECT_NEAR(at.position, target, 0.01);
        EXPECT_NEAR(at.velocity, 0, 0.01);
        if (shape != Shape::jerk) continue;
        const Seen most = seen(from, p, true);
        EXPECT_LT(most.jump, 1) << "of the acceleration";
        EXPECT_LE(std::max(most.up, most.down), std::max(r.up, r.down) + 1);
    }
}

TEST(Cia402Twin, TheFormOfTheRampsIsAnObject) {
    Bench b;
    EXPECT_EQ(b.write(0x6086, 0, 2, 2), canopen::Abort::value) << "jerk free: not this one";
    ASSERT_EQ(b.write(0x6086, 0, 3, 2), canopen::Abort::none);
    ASSERT_EQ(b.write(0x60A3, 0, 2, 1), canopen::Abort::none);
    ASSERT_EQ(b.write(0x60A4, 1, 50'000, 4), canopen::Abort::none);
    ASSERT_EQ(b.write(0x60A4, 2, 50'000, 4), canopen::Abort::none);
    b.enable(1);
    ASSERT_EQ(b.write(0x607A, 0, 100'000, 4), canopen::Abort::none);
    b.word(0x1F);
    b.pass(100ms);
    EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 250, 2) << "50000 / s^3 in 0.1 s: jerk t^2 / 2";
    b.pass(60s);
    EXPECT_EQ(b.read(0x6064), 100'000);
}

TEST(Cia402Twin, TheTorqueOfModeFourRisesBySlope) {  // 6087h, 6074h
    Bench b;
    ASSERT_EQ(b.write(0x6087, 0, 200, 4), canopen::Abort::none);
    b.enable(4);
    ASSERT_EQ(b.write(0x6071, 0, 100, 2), canopen::Abort::none);
    b.pass(250ms);
    EXPECT_EQ(b.read(0x6074), 50) << "1/1000 of the rated torque each s";
    EXPECT_EQ(b.read(0x6077), 50);
    b.pass(250ms);
    EXPECT_EQ(b.read(0x6077), 100);
    const auto v = b.read(0x606C);
    EXPECT_NEAR(static_cast<double>(v), 100 * 50 * 0.5 / 2, 5) << "half of what the torque would have given at once";
    ASSERT_EQ(b.write(0x6060, 0, 10, 1), canopen::Abort::none);
    ASSERT_EQ(b.write(0x6071, 0, -100, 2), canopen::Abort::none);
    EXPECT_EQ(b.read(0x6077), -100) << "CST takes what comes";
}

TEST(Cia402Twin, PolarityTurnsWhatIsInUserUnits) {  // 607Eh, bits 7 and 6
    Bench b;
    EXPECT_EQ(b.write(0x607E, 0, 1, 1), canopen::Abort::value);
    ASSERT_EQ(b.write(0x607E, 0, 0xC0, 1), canopen::Abort::none);
    b.enable(1);
    ASSERT_EQ(b.write(0x607A, 0, 1000, 4), canopen::Abort::none);
    b.word(0x1F);
    b.pass(100ms);
    EXPECT_GT(b.read(0x606C), 0);
    b.pass(2s);
    EXPECT_EQ(b.read(0x6064), 1000);
    EXPECT_NEAR(b.twin->mechanics(1, b.now).position, -1000, 0.01);
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
