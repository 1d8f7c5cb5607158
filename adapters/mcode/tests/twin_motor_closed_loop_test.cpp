// Tests of the closed loops: encoder mode with stall, dead band and position maintenance, and hMT with make-up, limits and locked rotor.
#include "adapters/mcode/tests/twin_motor_bench.hpp"

#include <cmath>
#include <random>

namespace axisgate::mcode::twin::test {
namespace {

using Kind = MotorEvent::Kind;

TEST(McodeClosedLoop, OpenLoopLosesStepsSilently) {
    MotorBench b;
    b.start("MR", 512000);
    b.pass_ms(500);
    b.hand("stall", true);
    const double c2 = b.get("C2");
    b.pass_ms(200);
    b.hand("stall", false);
    b.rest();
    EXPECT_EQ(b.get("P"), 512000);
    EXPECT_LT(b.get("C2"), 40000);
    EXPECT_GT(b.get("C2"), c2);
    EXPECT_EQ(b.errors(), Codes{});
    EXPECT_EQ(b.get("ST"), 0);
}

TEST(McodeClosedLoop, AStallStopsAtSfAndStOutlivesTheError) {  // trap 7; figures of [L7354]
    MotorBench b;
    b.set("EE", 1);
    b.set("SF", 30);
    b.set("A", 20000);
    b.set("MT", 50);
    b.start("MR", 2048);
    while (b.get("P") < 2000)
        b.pass(std::chrono::microseconds(100));
    b.hand("stall", true);
    const double bound_at = b.get("P"), c1 = b.get("C1");
    b.pass_ms(200);
    EXPECT_EQ(b.errors(), (Codes{86}));
    EXPECT_EQ(b.get("ST"), 1);
    EXPECT_EQ(b.get("P"), bound_at);               // follows C2
    EXPECT_NEAR(b.get("C1") - c1, 30 * 12.8, 26);  // steps for SF counts were given
    EXPECT_EQ(b.get("MV"), 0);
    EXPECT_EQ(b.count(Kind::finished), 0);
    b.hand("stall", false);
    EXPECT_EQ(b.start("MR", 100), 0);  // motion commands still work
    b.rest();
    EXPECT_EQ(b.get("P"), bound_at + 100);
    EXPECT_EQ(b.get("ST"), 1);
    EXPECT_EQ(b.set("ST", 1), 21);
    EXPECT_EQ(b.set("ST", 0), 0);
    EXPECT_EQ(b.get("ST"), 0);
}

TEST(McodeClosedLoop, WithSmTheMoveGoesOnAndIsCorrected) {
    MotorBench b;
    b.set("EE", 1);
    b.set("SM", 1);
    b.set("VI", 500);
    b.start("MR", 40000);
    b.pass_ms(500);
    b.hand("stall", true);
    b.pass_ms(20);
    EXPECT_EQ(b.errors(), (Codes{86}));
    EXPECT_EQ(b.get("MV"), 1);
    b.hand("stall", false);
    b.pass_ms(1100);
    EXPECT_LT(b.get("P"), 40000);
    while (b.get("V") != 500 && b.get("MV") == 1)
        b.pass_ms(1);
    EXPECT_EQ(b.get("V"), 500);  // the correction, at VI
    EXPECT_EQ(b.start("MR", 10), 93);
    b.rest();
    EXPECT_EQ(b.get("P"), 40000);
    EXPECT_EQ(b.count(Kind::finished), 1);
}

TEST(McodeClosedLoop, ARotorThatStaysHeldEndsInAPositionError) {
    MotorBench b;
    b.set("EE", 1);
    b.set("SM", 1);
    b.hand("stall", true);
    b.start("MR", 400);
    b.rest();
    const Codes codes = b.errors();
    EXPECT_EQ(codes.front(), 86);
    EXPECT_EQ(codes.back(), 92);
    EXPECT_EQ(b.get("P"), 0);
    EXPECT_EQ(b.motor.deadline(), never);
}

TEST(McodeClosedLoop, DeadBandDecidesWhatIsDone) {
    for (const int db : {5, 500}) {
        MotorBench b;
        b.set("EE", 1);
        b.set("DB", db);
        b.set("SF", 1000);
        b.start("MR", 2048);
        b.pass_ms(100);
        b.hand("stall", true);  // 100 counts are lost on the way, less than SF
        while (b.shown("position") == b.shown("position") && b.get("C1") / 12.8 - b.get("C2") < 100)
            b.pass(std::chrono::microseconds(100));
        b.hand("stall", false);
        b.rest();
        EXPECT_EQ(b.errors(), Codes{});
        EXPECT_NEAR(b.get("P"), 2048, db) << db;
        EXPECT_EQ(b.get("P") == 2048, db == 5);
    }
}

TEST(McodeClosedLoop, PositionMaintenanceBringsTheShaftBack) {
    MotorBench b;
    b.set("EE", 1);
    b.hand("position", 10.0);
    EXPECT_EQ(b.get("P"), 10);  // P follows the encoder
    b.pass_ms(1000);
    EXPECT_EQ(b.get("P"), 10);
    b.set("PM", 1);  // within SF = 15
    b.rest();
    EXPECT_EQ(b.get("P"), 0);
    b.hand("position", 200.0);  // beyond SF with SM = 0
    b.pass_ms(100);
    EXPECT_EQ(b.get("P"), 200);
    EXPECT_EQ(b.get("MV"), 0);
    b.set("SM", 1);
    EXPECT_EQ(b.start("MR", 5), 93);
    EXPECT_NEAR(b.get("V"), -78, 0);
    b.rest();
    EXPECT_EQ(b.get("P"), 0);
    EXPECT_EQ(b.count(Kind::finished), 0);
}

TEST(McodeClosedLoop, LoadAboveTheCurrentStopsTheShaft) {
    MotorBench b;
    b.set("EE", 1);
    b.hand("load", 0.5);
    b.start("MR", 4000);
    b.pass_ms(500);
    EXPECT_EQ(b.errors(), (Codes{86}));
    b.set("RC", 60);
    b.start("MR", 4000);
    b.rest();
    EXPECT_EQ(b.get("P"), 4000);
    EXPECT_EQ(b.errors(), Codes{});
}

TEST(McodeClosedLoop, HmtModesAndTheirRefusals) {
    MotorBench b;
    EXPECT_EQ(b.get("AF"), 128);
    EXPECT_EQ(b.set("MS", 8), 0);
    EXPECT_EQ(b.set("AS", 1), 21);  // MS >= 10
    b.set("MS", 256);
    EXPECT_EQ(b.set("EE", 1), 0);
    EXPECT_EQ(b.get("VM"), 60000);
    EXPECT_EQ(b.set("AS", 1), 0);
    EXPECT_EQ(b.get("EE"), 1);
    EXPECT_EQ(b.get("VM"), 768000);  // step pulses again [L696]
    EXPECT_EQ(b.set("MS", 128), 8);  // locked [L7194]
    EXPECT_EQ(b.set("EE", 0), 0);
    EXPECT_EQ(b.get("AF"), 128 + 16 + 64);
    EXPECT_EQ(b.set("MS", 5), 21);
    b.start("SL", 100000);
    EXPECT_EQ(b.set("AS", 0), 87);
    b.motor.stop_at_once(b.now);
    EXPECT_EQ(b.set("AS", 0), 0);
    EXPECT_EQ(b.errors(), Codes{});
    MotorBench open({lmdo, 23});
    EXPECT_EQ(open.set("AS", 1), 37);
}

TEST(McodeClosedLoop, TorqueModeMovesAtOnce) {  // trap 24
    MotorBench b;
    EXPECT_EQ(b.set("AS", 3), 0);
    EXPECT_EQ(b.get("MV"), 0);  // TS = 0 [E-49]
    EXPECT_EQ(b.set("TS", 46511), 21);
    EXPECT_EQ(b.set("TS", 2560001), 77);
    EXPECT_EQ(b.set("TS", 51200), 0);
    b.pass_ms(500);
    EXPECT_EQ(b.get("V"), 0);
    EXPECT_EQ(b.get("AV"), 51200);
    EXPECT_GT(b.get("P"), 0);
    EXPECT_EQ(b.get("MV"), 1);
    b.set("TD", 0);
    b.pass_ms(500);
    EXPECT_EQ(b.get("AV"), -51200);
    EXPECT_EQ(b.set("AS", 0), 87);
    EXPECT_EQ(b.start("MR", 10), 85);
    b.hand("load", 0.3);  // above TQ = 25 %
    EXPECT_EQ(b.get("AV"), 0);
    b.pass_ms(1999);
    EXPECT_EQ(b.get("LR"), 0);
    b.pass_ms(2);
    EXPECT_EQ(b.get("LR"), 1);
    EXPECT_EQ(b.errors(), (Codes{104}));
    b.set("TQ", 40);  // the bridges are on: it turns again
    b.pass_ms(500);
    EXPECT_EQ(b.get("AV"), -51200);
    EXPECT_EQ(b.start("CF", std::vector<double>{}), 0);
    EXPECT_EQ(b.get("LR"), 0);
    b.motor.stop_at_once(b.now);
    EXPECT_EQ(b.get("AV"), 0);
    b.pass_ms(1000);
    EXPECT_EQ(b.get("MV"), 0);
    EXPECT_EQ(b.set("AS", 0), 0);
    // A saved torque mode does not move by itself.
    b.set("AS", 3);
    NonVolatile m;
    b.motor.save(m);
    b.motor.restart(b.now);
    b.motor.factory(b.now);
    b.motor.load(m, b.now);
    EXPECT_EQ(b.get("AS"), 3);
    EXPECT_EQ(b.get("MV"), 0);
}

TEST(McodeClosedLoop, MakeUpEndsEveryMoveAtItsTarget) {
    for (const int mode : {0, 1, 2}) {
        MotorBench b;
        b.set("AS", 1);
        b.set("MU", mode);
        b.set("LG", 2000000);
        b.start("MR", 1500000);
        b.pass_ms(1000);
        b.hand("stall", true);
        b.pass_ms(300);
        EXPECT_NEAR(b.get("LL"), 768000 * 0.3, 1) << mode;
        EXPECT_EQ(b.status() & 4, 4);
        b.hand("stall", false);
        b.pass_ms(100);
        EXPECT_GT(b.get("AV"), mode == 0 ? 100000 : 1500000) << mode;
        b.pass_ms(300);
        EXPECT_EQ(b.get("LL") > 0, mode == 0) << mode;
        const double took = 1.7 + b.rest();
        // With MU = 1 and 2 the move ends when it would have ended; with MU = 0 later by the time of the hold and of a second ramp.
        const double whole = 2 * 0.767 + (1500000.0 - 2 * 294911.5) / 768000 + 1;  // MT and HT
        EXPECT_NEAR(took, whole + (mode == 0 ? 0.3 + 0.767 - 294911.5 / 768000 : 0), 0.005) << mode;
        EXPECT_EQ(b.get("P"), 1500000) << mode;
        EXPECT_EQ(b.get("C2"), std::round(1500000.0 * 4000 / 51200));
        EXPECT_EQ(b.get("LL"), 0);
        EXPECT_EQ(b.count(Kind::finished), 1);
        EXPECT_EQ(b.errors(), Codes{});
    }
}

TEST(McodeClosedLoop, AShaftThatIsTurnedAtRestIsBroughtBack) {
    MotorBench b;
    b.set("AS", 2);
    b.set("MU", 1);
    b.set("MF", 100000);
    b.hand("position", 50000.0);
    EXPECT_EQ(b.get("MV"), 1);
    b.pass_ms(100);
    EXPECT_EQ(b.get("AV"), -100000);
    EXPECT_LT(b.get("LL"), 0);  // lead
    b.rest();
    EXPECT_EQ(b.get("P"), 0);
    b.set("DE", 0);
    b.hand("position", 777.0);
    EXPECT_EQ(b.get("P"), 777);  // free: it stays, and nothing is owed
    EXPECT_EQ(b.get("LL"), 0);
}

TEST(McodeClosedLoop, LagLimitLockedRotorAndTheirTrips) {
    MotorBench b;
    b.set("AS", 1);
    b.set("LT", 100);
    EXPECT_EQ(b.arm("TA", {4 + 8}), 0);
    EXPECT_EQ(b.arm("TA", {32}), 21);
    b.arm("TA", {4 + 8});
    b.motor.enable_trips(32, b.now);
    b.start("SL", 512000);
    b.pass_ms(1000);
    b.hand("stall", true);
    EXPECT_EQ(b.status() & 4, 0);
    b.pass_ms(1);  // 1.3 full steps are 333 steps
    EXPECT_EQ(b.status() & 4, 4);
    b.pass_ms(98);
    EXPECT_EQ(b.errors(), Codes{});
    EXPECT_EQ(b.get("LR"), 0);
    b.pass_ms(3);
    EXPECT_EQ(b.trips(Word::TA), 1);
    EXPECT_EQ(b.get("LR"), 1);
    EXPECT_EQ(b.errors(), (Codes{104}));
    EXPECT_EQ(b.get("MV"), 0);
    EXPECT_EQ(b.start("MR", 10), 94);  // bridges off
    b.hand("stall", false);
    EXPECT_EQ(b.start("CF", std::vector<double>{}), 0);
    EXPECT_EQ(b.get("LR"), 0);
    EXPECT_EQ(b.get("LL"), 0);
    EXPECT_EQ(b.start("MR", 10), 0);
    b.rest();

    b.set("LT", 60000);
    b.start("SL", 512000);
    b.pass_ms(1000);
    b.hand("stall", true);
    b.pass_ms(199);
    EXPECT_EQ(b.status() & 2, 0);
    b.events.clear();
    b.pass_ms(2);  // LG = 102400
    EXPECT_EQ(b.trips(Word::TA), 1);
    EXPECT_EQ(b.errors(), (Codes{107}));
    EXPECT_EQ(b.status() & 2, 2);
    b.motor.stop_at_once(b.now);
    b.pass_ms(0);
    EXPECT_EQ(b.errors(), (Codes{108}));  // lag is left at the end
    b.hand("stall", false);
    b.hand("position", b.get("P") + 200000);
    EXPECT_EQ(b.errors(), (Codes{106}));  // lead
    b.rest();
}

TEST(McodeClosedLoop, TheCountThatWrapsWithHmtIsAnError) {
    MotorBench b;
    b.set("AS", 1);
    b.set("P", 2147483000);
    b.start("MR", 1000);
    b.rest();
    EXPECT_EQ(b.get("P"), -2147483296.0);
    EXPECT_EQ(b.errors(), (Codes{105}));
}

TEST(McodeClosedLoop, AnythingInAnyOrderKeepsTimeAndPlaceInBounds) {
    std::mt19937_64 random(7);
    const auto pick = [&](std::initializer_list<const char*> names) { return std::string(names.begin()[random() % names.size()]); };
    for (const std::uint8_t product : {lmdo, lmdc, lmm}) {
        MotorBench b({product, 23});
        for (int n = 0; n < 1500; ++n) {
            const double some = static_cast<double>(static_cast<std::int64_t>(random() % 400001) - 200000);
            const double small = static_cast<double>(random() % 5);
            switch (random() % 8) {
                case 0:
                    (void)b.start(pick({"MA", "MR", "SL"}), {some, 0.0});
                    break;
                case 1:
                    (void)b.start(pick({"MA", "MR"}), {some, 0.0, 1.0});
                    break;
                case 2:
                    (void)b.start(pick({"HM", "HI", "HF", "SC", "SL"}), small);
                    break;
                case 3:
                    (void)b.set(pick({"AS", "EE", "MU", "PM", "SM", "DE", "LM", "JE", "TD", "BE", "BM", "AT", "DT", "RD", "FL"}), small);
                    break;
                case 4:
                    (void)b.set(pick({"MS", "SF", "DB", "MT", "HT", "LT", "AJ", "RC", "TQ", "BL", "VI", "EL"}),
                                static_cast<double>(random() % 300));
                    break;
                case 5:
                    (void)b.set(pick({"P", "C1", "C2", "VM", "A", "D", "TS", "FS", "MF"}), std::abs(some));
                    (void)b.set("IS", {1 + small, static_cast<double>(random() % 16), static_cast<double>(random() % 2)});
                    (void)b.set("LS", {static_cast<double>(random() % 2), some, static_cast<double>(random() % 2)});
                    break;
                case 6:
                    for (const char* name : {"stall", "load", "inputs", "home_position", "limit_positive_position", "position"}) {
                        if (random() % 4 != 0) continue;
                        const double v = std::string(name) == "position" ? some : static_cast<double>(random() % 2);
                        (void)b.motor.set_hand(name, Value{v}, b.now);
                    }
                    break;
                default:
                    switch (random() % 5) {
                        case 0:
                            b.motor.stop_at_once(b.now);
                            break;
                        case 1:
                            b.motor.pause(b.now);
                            break;
                        case 2:
                            b.motor.resume(b.now);
                            break;
                        case 3:
                            (void)b.arm("TP", {some});
                            b.motor.enable_trips(2, b.now);
                            break;
                        default:
                            (void)b.arm("TR", {std::abs(some) + 1000});
                            b.motor.enable_trips(16 + 1, b.now);
                            break;
                    }
                    break;
            }
            b.pass_ms(static_cast<std::int64_t>(random() % 700));
            ASSERT_FALSE(::testing::Test::HasFatalFailure()) << n;
            const double p = b.get("P"), v = b.get("V");
            ASSERT_TRUE(p >= -2147483648.0 && p <= 2147483647.0) << n;
            ASSERT_LE(std::abs(v), 5e6) << n;
            ASSERT_TRUE(std::isfinite(b.motor.mechanics(b.now).position)) << n;
        }
        // Left alone and let go it comes to rest, or runs for ever in a motion that asks for nothing.
        for (const char* name : {"stall", "load"})
            b.hand(name, Value{std::int64_t{0}});
        b.motor.enable_trips(0, b.now);
        b.motor.stop_at_once(b.now);
        (void)b.set("JE", 0);
        b.pass_ms(600'000);
        EXPECT_EQ(b.motor.deadline(), never);
        EXPECT_EQ(b.get("MV"), 0);
    }
}

TEST(McodeClosedLoop, CalibrationTurnsHalfATurnAndReports) {
    MotorBench b;
    EXPECT_EQ(b.start("SC", 2), 21);
    EXPECT_EQ(b.start("SC", 1), 0);
    EXPECT_EQ(b.start("MR", 5), 88);
    b.rest();
    EXPECT_EQ(b.get("P"), 25600);
    EXPECT_EQ(b.errors(), Codes{});
    for (const int fault : {1, 2, 3}) {
        b.hand("encoder_fault", std::int64_t{fault});
        b.start("SC", 1);
        b.rest();
        EXPECT_EQ(b.errors(), (Codes{99 + static_cast<int>(fault)}));
    }
    b.start("SC", 1);
    b.set("DE", 0);
    EXPECT_EQ(b.errors(), (Codes{109}));
    EXPECT_EQ(b.start("SC", 1), 103);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
