// The mechanics of a specimen of the UIM342: the encoder's lag, overshoot, a motor that lacks force (a stall in closed loop, lost steps in
// open loop), friction, backlash, noise and drift.
#include <gmock/gmock.h>

#include <set>

#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test::specimen_shafts {
namespace {
using testing::ElementsAre;
using testing::IsEmpty;

const std::string stall = "5A 00 1D 00 00 00";

/// Enabled; open loop: IC[6] = 0.
Bench enabled(FreedomValues freedoms, bool closed_loop = true) {
    TwinSetup s = can_setup();
    s.freedoms = std::move(freedoms);
    s.seed = 3;
    Bench b(s);
    if (!closed_loop) b.setup({"86 06 00 00"});
    b.setup({"95 01"});
    return b;
}
void jog(Bench& b, int speed) { b.setup({"9D " + le32(speed), "96"}); }
Lines move(Bench& b, int target, int speed, double ms) {
    b.setup({"A0 " + le32(target), "9E " + le32(speed), "96"});
    return b.pass_ms(ms);
}

TEST(Uim342Mechanics, InClosedLoopTheCounterShowsTheLag) {
    Bench b = enabled({{"follow_ms", 20}}), exact = enabled({});
    for (Bench* x : {&b, &exact}) {
        jog(*x, 3000);
        x->pass_ms(2000);
    }
    EXPECT_NEAR(exact.position() - b.position(), 2 * 0.02 * 3000, 6);
    EXPECT_EQ(b.speed(), 3000);
    b.setup({"97"});
    b.pass_ms(20);
    EXPECT_TRUE(b.stopped()) << "the pulses stand";
    EXPECT_GT(b.speed(), 200) << "the shaft does not";
    b.pass_ms(1000);
    EXPECT_EQ(b.speed(), 0);
}

TEST(Uim342Mechanics, ItOvershootsAndSettles) {
    Bench b = enabled({{"follow_ms", 30}, {"damping_percent", 30}});
    const Lines told = move(b, 3200, 10000, 1140);
    ASSERT_EQ(told.size(), 1u);
    EXPECT_NE(told[0], "5A 29 00 00 00 80 0C 00 00") << "the position of the moment";
    int most = 0;
    for (int i = 0; i < 1000; ++i) {
        b.pass_ms(1);
        most = std::max(most, static_cast<int>(b.position()));
    }
    EXPECT_GT(most, 3205);
    EXPECT_EQ(b.position(), 3200);
}

TEST(Uim342Mechanics, AMotorThatLacksForceStallsInClosedLoop) {
    Bench strong = enabled({{"most_acceleration", 12'000}});
    EXPECT_THAT(move(strong, 30000, 10000, 5000), ElementsAre("5A 29 00 00 00 " + le32(30000)));
    EXPECT_FALSE(strong.stalled());

    Bench weak = enabled({{"most_acceleration", 5'000}});
    const Lines told = move(weak, 30000, 10000, 5000);
    EXPECT_THAT(told, ElementsAre(stall));
    EXPECT_NEAR(weak.last_at(), 1 + 0.2, 0.02) << "100 pulses of QE[1] behind: half of 5000/s^2";
    EXPECT_TRUE(weak.stalled() && weak.stopped());
    EXPECT_FALSE(weak.in_position());
    EXPECT_NEAR(weak.position(), 200, 150) << "it gives up where it is";
    weak.pass_ms(5000);
    EXPECT_EQ(weak.mechanics().velocity, 0);
    EXPECT_TRUE(weak.mechanics().powered);
    weak.setup({"99 E8 03 00 00", "9A E8 03 00 00"});
    const int from = weak.position();
    EXPECT_THAT(move(weak, from + 1000, 500, 5000), ElementsAre("5A 29 00 00 00 " + le32(from + 1000))) << "with less, it follows";
}

TEST(Uim342Mechanics, TheStallIsTheSameHoweverOftenItIsAsked) {
    Bench often = enabled({{"most_acceleration", 5'000}}), seldom = enabled({{"most_acceleration", 5'000}});
    for (Bench* b : {&often, &seldom})
        jog(*b, 10000);
    for (int i = 0; i < 300; ++i) {
        often.pass_ms(1.7);
        (void)often.position();
    }
    seldom.pass_ms(510);
    EXPECT_EQ(often.position(), seldom.position());
    EXPECT_EQ(often.stalled(), seldom.stalled());
}

TEST(Uim342Mechanics, InOpenLoopItLosesStepsAndTheCounterDoesNotKnow) {
    Bench b = enabled({{"most_acceleration", 5'000}}, false);
    EXPECT_THAT(move(b, 30000, 10000, 6000), ElementsAre("5A 29 00 00 00 " + le32(30000))) << "no stall is told";
    EXPECT_EQ(b.position(), 30000);
    const double lost = 30000 - b.mechanics().position;
    EXPECT_GT(lost, 20000) << "it fell out of step while it accelerated";
    EXPECT_NEAR(std::remainder(lost, 64), 0, 1e-6) << "whole poles of four steps of 16 pulses";
    b.setup({"99 E8 03 00 00", "9A E8 03 00 00"});
    move(b, 29000, 500, 6000);
    EXPECT_NEAR(29000 - b.mechanics().position, lost, 0.1) << "from then on it follows, that much behind";

    Bench strong = enabled({{"most_acceleration", 12'000}, {"follow_ms", 50}}, false);
    move(strong, 30000, 10000, 6000);
    EXPECT_NEAR(strong.mechanics().position, 30000, 0.1) << "a rotor has no position loop that lags";
    jog(strong, 10000);
    strong.pass_ms(1500);
    EXPECT_EQ(strong.speed(), 10000) << "the speed of the pulses";
}

TEST(Uim342Mechanics, FrictionAndBacklash) {
    Bench stuck = enabled({{"friction_increments", 5}});
    move(stuck, 1000, 2000, 3000);
    EXPECT_EQ(stuck.position(), 995);
    EXPECT_TRUE(stuck.stopped());
    Bench loose = enabled({{"backlash_increments", 10}});
    move(loose, 1000, 2000, 3000);
    EXPECT_EQ(loose.position(), 995);
    move(loose, 0, 2000, 3000);
    EXPECT_EQ(loose.position(), 5);
    loose.setup({"A1"});
    EXPECT_EQ(loose.position(), 0) << "the origin is where the encoder is";
}

TEST(Uim342Mechanics, TheEncoderFlickers) {
    Bench b = enabled({{"noise_increments", 1}});
    std::set<int> seen;
    for (int i = 0; i < 100; ++i) {
        b.pass_ms(1);
        seen.insert(b.position());
    }
    EXPECT_EQ(seen, (std::set<int>{-1, 0, 1}));
    Bench open = enabled({{"noise_increments", 1}}, false);
    for (int i = 0; i < 100; ++i) {
        open.pass_ms(1);
        EXPECT_EQ(open.position(), 0) << "pulses do not";
    }
}

TEST(Uim342Mechanics, NoiseOfAnAbsoluteEncoderIsNoChangeOfItsMemory) {
    Bench b = enabled({{"noise_increments", 3}});
    b.setup({"95 00", "86 05 01 00", "95 01"});
    move(b, 1000, 2000, 3000);
    const auto before = b.drive().non_volatile_revision();
    for (int i = 0; i < 100; ++i) {
        b.pass_ms(1);
        (void)b.position();
    }
    EXPECT_EQ(b.drive().non_volatile_revision(), before);
}

TEST(Uim342Mechanics, ItDriftsWhenTheDriverIsOff) {
    for (const bool closed : {true, false}) {
        TwinSetup s = can_setup();
        s.freedoms = {{"drift_increments", 40}};
        Bench b(s);
        b.pass_ms(5000);
        EXPECT_EQ(b.mechanics().position, 0) << "it never had current";
        if (!closed) b.setup({"86 06 00 00"});
        b.setup({"95 01"});
        b.pass_ms(100);
        b.setup({"95 00"});
        b.pass_ms(5000);
        EXPECT_NEAR(b.mechanics().position, 40, 0.1);
        EXPECT_EQ(b.position(), closed ? 40 : 0) << "the encoder sees it, pulses do not";
        b.setup({"95 01"});
        b.pass_ms(5000);
        EXPECT_EQ(b.position(), closed ? 40 : 0);
        EXPECT_NEAR(b.mechanics().position, 40, 0.1) << "the driver holds it where it is";
        move(b, 1000, 2000, 3000);
        EXPECT_EQ(b.position(), 1000);
        EXPECT_NEAR(b.mechanics().position, closed ? 1000 : 1040, 0.1);
    }
}

TEST(Uim342Mechanics, TheHandWorksWithMechanicsToo) {
    Bench b = enabled({{"follow_ms", 10}, {"drift_increments", 40}});
    jog(b, 3000);
    b.pass_ms(1000);
    b.hand("stall", true);
    const int held = b.position();
    b.pass_ms(5);
    EXPECT_EQ(b.position(), held);
    EXPECT_EQ(b.pass_ms(2000), Lines{stall});
    b.hand("stall", false);
    b.pass_ms(1000);
    EXPECT_NEAR(b.position(), held, 1);
    b.setup({"95 00"});
    b.pass_ms(2000);
    b.hand("position", std::int64_t{123});
    EXPECT_EQ(b.position(), 123);
    b.pass_ms(5000);
    EXPECT_EQ(b.position(), 123) << "it stands where the hand has left it";
    b.setup({"95 01"});
    jog(b, 3000);
    b.pass_ms(2000);
    b.setup({"95 00"});  // the free shaft runs out
    b.pass_ms(5000);
    EXPECT_EQ(b.mechanics().velocity, 0);
    b.hand("power", false);
    b.hand("power", true);
    EXPECT_EQ(b.position(), 0);
}

}  // namespace
}  // namespace axisgate::uim342::test::specimen_shafts
