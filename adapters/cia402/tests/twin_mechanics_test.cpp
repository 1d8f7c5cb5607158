// The mechanics of the simulated CiA 402 drive that differ from its demand: lag, overshoot, finite force, friction, play, noise, drift, and
// switches with hysteresis, as the objects of the drive show them.
#include <cmath>
#include <set>

#include "adapters/cia402/tests/free_bench.hpp"
#include "adapters/cia402/twin/homing.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using namespace std::chrono_literals;
using canopen::Abort;

TEST(Cia402Mechanics, TheShaftLagsByItsTimeAndTheFollowingErrorShowsIt) {
    for (const int follow : {0, 20}) {
        FreeBench b({{"follow_ms", follow}});
        b.enable(3);
        ASSERT_EQ(b.write(0x60FF, 0, 10'000, 4), Abort::none);
        b.pass(1s);
        EXPECT_NEAR(static_cast<double>(b.read(0x60F4)), follow * 20, 12) << "twice the time constant times the speed";
        EXPECT_NEAR(static_cast<double>(b.read(0x6062) - b.read(0x6064)), follow * 20, 12);
        EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 10'000, 10);
        EXPECT_EQ(b.fault(), 0u);
        ASSERT_EQ(b.write(0x60FF, 0, 0, 4), Abort::none);
        b.pass(201ms);
        EXPECT_EQ((b.status() & 0x1000u) == 0, follow != 0) << "the demand stands; does the shaft?";
        b.pass(1s);
        EXPECT_NE(b.status() & 0x1000u, 0u);
        EXPECT_EQ(b.read(0x60F4), 0);
    }
}

TEST(Cia402Mechanics, WhereItIsDoesNotDependOnHowOftenItIsAsked) {
    FreeBench often({{"follow_ms", 15}, {"most_acceleration", 100'000}}), seldom({{"follow_ms", 15}, {"most_acceleration", 100'000}});
    for (FreeBench* b : {&often, &seldom}) {
        b->enable(1);
        b->move_to(8'000);
    }
    for (int i = 0; i < 700; ++i) {
        often.pass(1ms);
        (void)often.place();
    }
    seldom.pass(700ms);
    EXPECT_EQ(often.place(), seldom.place());
}

TEST(Cia402Mechanics, TheTargetIsReachedWhenTheShaftIsWithinTheWindowForItsTime) {
    for (const int window_ms : {0, 100}) {
        FreeBench b({{"follow_ms", 30}});
        ASSERT_EQ(b.write(0x6068, 0, window_ms, 2), Abort::none);
        b.enable(1);
        b.move_to(1'000);
        b.pass(10ms);
        while (b.read(0x6062) != 1'000)
            b.pass(1ms);
        EXPECT_EQ(b.status() & 0x400u, 0u) << "the demand is there, the shaft is not";
        EXPECT_LT(b.place(), 995);
        while (1'000 - b.read(0x6064) > 4)
            b.pass(1ms);
        b.pass(1ms);
        EXPECT_EQ((b.status() & 0x400u) != 0, window_ms == 0);
        b.pass(90ms);
        EXPECT_EQ((b.status() & 0x400u) != 0, window_ms == 0);
        b.pass(15ms);
        EXPECT_NE(b.status() & 0x400u, 0u);
    }
}

TEST(Cia402Mechanics, AWeaklyDampedShaftOvershoots) {
    for (const int damping : {100, 50}) {
        FreeBench b({{"follow_ms", 30}, {"damping_percent", damping}});
        b.enable(1);
        b.move_to(5'000);
        double furthest = 0;
        for (int i = 0; i < 2'000; ++i) {
            b.pass(1ms);
            furthest = std::max(furthest, b.place());
        }
        EXPECT_EQ(furthest > 5'005, damping == 50) << furthest;
        EXPECT_NEAR(b.place(), 5'000, 1);
        EXPECT_NE(b.status() & 0x400u, 0u);
    }
}

TEST(Cia402Mechanics, ACyclicTargetThatCannotBeFollowedEndsInTheDrivesOwnFollowingError) {
    for (const int force : {0, 40'000}) {
        FreeBench b({{"most_acceleration", force}});
        b.begin_stream();
        const double begin = seconds(b.now - Instant{});
        for (int i = 0; i < 60 && b.fault() == 0; ++i) {  // an acceleration of 500,000 increments/s^2 to 50,000 increments/s
            b.pass(20ms);
            const double t = seconds(b.now - Instant{}) - begin;
            b.lead(std::llround(t < 0.1 ? 250'000 * t * t : 2'500 + 50'000 * (t - 0.1)));
            b.sync();
        }
        EXPECT_EQ(b.fault(), force == 0 ? 0u : 0x8611u);
        b.pass(5s);
        EXPECT_EQ(b.status() & 0x4Fu, force == 0 ? 0x07u : 0x08u);
        if (force == 0) continue;
        EXPECT_EQ(b.read(0x1003, 1) & 0xFFFF, 0x8611);
        EXPECT_EQ(b.read(0x1003, 2), 0) << "it is reported once";
        EXPECT_FALSE(b.twin->mechanics(1, b.now).powered);
    }
}

TEST(Cia402Mechanics, AWeakMotorComesLaterAndAllTheSame) {
    FreeBench b({{"most_acceleration", 40'000}, {"follow_ms", 5}});
    b.enable(1);
    b.move_to(10'000);
    std::int64_t most = 0;
    for (int i = 0; i < 3'000; ++i) {
        b.pass(1ms);
        most = std::max(most, b.read(0x60F4));
    }
    EXPECT_GT(most, 150) << "its ramp is 50,000";
    EXPECT_EQ(b.fault(), 0u);
    EXPECT_NEAR(b.place(), 10'000, 1);
    EXPECT_NE(b.status() & 0x400u, 0u);
}

TEST(Cia402Mechanics, AShaftThatStallsAndIsReleasedComesBackByItself) {
    FreeBench b({{"follow_ms", 10}});
    b.enable(1);
    b.move_to(500);
    ASSERT_EQ(b.twin->set_hand("stall", Value{true}, b.now, b.out), "");
    b.pass(2s);
    EXPECT_EQ(b.place(), 0);
    EXPECT_EQ(b.status() & 0x400u, 0u);
    ASSERT_EQ(b.twin->set_hand("stall", Value{false}, b.now, b.out), "");
    b.pass(5ms);
    EXPECT_LT(b.place(), 400) << "not at once";
    b.pass(2s);
    EXPECT_NEAR(b.place(), 500, 1);
    EXPECT_NE(b.status() & 0x400u, 0u);
}

TEST(Cia402Mechanics, FrictionHoldsItBesideItsTarget) {
    for (const int friction : {0, 2}) {
        FreeBench b({{"follow_ms", 20}, {"friction_increments", friction}});
        b.enable(1);
        b.move_to(1'000);
        b.pass(3s);
        EXPECT_EQ(std::fabs(b.place() - 1'000) > 0.5, friction != 0) << b.place();
        EXPECT_LE(std::fabs(b.place() - 1'000), friction + 0.1);
        EXPECT_NE(b.status() & 0x400u, 0u) << "within the window";
    }
}

TEST(Cia402Mechanics, PlayMakesAPlaceDependOnTheDirection) {
    for (const int play : {0, 4}) {
        FreeBench b({{"backlash_increments", play}});
        b.enable(1);
        b.move_to(1'000);
        b.pass(3s);
        EXPECT_EQ(b.read(0x6064), 1'000 - play / 2);
        EXPECT_EQ(b.read(0x60F4), play / 2);
        b.move_to(2'000);
        b.pass(3s);
        b.move_to(1'000);
        b.pass(3s);
        EXPECT_EQ(b.read(0x6064), 1'000 + play / 2);
    }
}

TEST(Cia402Mechanics, TheEncoderFlickersByAnIncrement) {
    for (const int noise : {0, 1}) {
        FreeBench b({{"noise_increments", noise}});
        b.enable(1);
        std::set<std::int64_t> seen;
        for (int i = 0; i < 100; ++i) {
            b.pass(1ms);
            seen.insert(b.read(0x6064));
        }
        EXPECT_EQ(seen, noise == 0 ? std::set<std::int64_t>({0}) : std::set<std::int64_t>({-1, 0, 1}));
    }
}

TEST(Cia402Mechanics, WithoutPowerItDrifts) {
    for (const int drift : {0, 100}) {
        FreeBench b({{"drift_increments", drift}});
        b.pass(3s);
        EXPECT_EQ(b.place(), 0) << "it was never switched on";
        b.enable(1);
        b.pass(3s);
        EXPECT_EQ(b.place(), 0) << "power holds it";
        b.word(0);
        b.pass(100ms);
        EXPECT_NEAR(b.place(), drift * 0.28, drift * 0.02);
        b.pass(4s);
        EXPECT_NEAR(static_cast<double>(b.read(0x6064)), drift, 1);
        b.enable(1);
        EXPECT_NEAR(static_cast<double>(b.read(0x6062)), drift, 1) << "its demand begins where it is";
        b.pass(2s);
        EXPECT_NEAR(b.place(), drift, 1);
        EXPECT_EQ(b.fault(), 0u);
        ASSERT_EQ(b.twin->set_hand("power", Value{false}, b.now, b.out), "");
        b.now += 4s;
        EXPECT_NEAR(b.place(), 2 * drift, 2) << "nor without its supply";
    }
}

TEST(Cia402Mechanics, ASwitchIsReleasedLaterThanItWasOperated) {
    for (const int hysteresis : {0, 100}) {
        FreeBench b({{"switch_hysteresis_increments", hysteresis}}, {{"travel", "20000"}});
        b.enable(3);
        const auto next_place = [&](unsigned bit, bool on) {
            for (int i = 0; i < 20'000 && ((b.read(0x60FD) & bit) != 0) != on; ++i)
                b.pass(1ms);
            return b.place();
        };
        ASSERT_EQ(b.write(0x60FF, 0, 10'000, 4), Abort::none);
        EXPECT_NEAR(next_place(4, false), cam + hysteresis, 15);
        EXPECT_NEAR(next_place(2, true), 20'000, 15);
        ASSERT_EQ(b.write(0x60FF, 0, -10'000, 4), Abort::none);
        EXPECT_NEAR(next_place(2, false), 20'000 - hysteresis, 15);
        EXPECT_NEAR(next_place(4, true), cam, 15);
        EXPECT_NEAR(next_place(4, false), -cam - hysteresis, 15);
    }
}

TEST(Cia402Mechanics, AHomingFindsTheEdgeWhereTheSwitchChanges) {
    EXPECT_EQ(homing_way(17, 0, 20'000, 100).zero, -19'900) << "it leaves the limit switch";
    EXPECT_EQ(homing_way(18, 0, 20'000, 100).zero, 19'900);
    EXPECT_EQ(homing_way(19, 5'000, 20'000, 100).zero, -100) << "it leaves the home switch";
    EXPECT_EQ(homing_way(20, 5'000, 20'000, 100).zero, 0) << "it enters it";
    EXPECT_EQ(homing_way(23, -5'000, 20'000, 100).zero, -1'124);
    EXPECT_EQ(homing_way(24, -5'000, 20'000, 100).zero, -1'024);
    EXPECT_EQ(homing_way(26, -5'000, 20'000, 100).zero, 1'124);
    FreeBench b({{"switch_hysteresis_increments", 100}}, {{"travel", "20000"}});
    ASSERT_EQ(b.write(0x6098, 0, 17, 1), Abort::none);
    b.enable(6);
    b.word(0x1F);
    b.pass(20s);
    EXPECT_NE(b.status() & 0x1000u, 0u);
    EXPECT_EQ(b.place(), -19'900);
    EXPECT_EQ(b.read(0x6064), 0);
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
