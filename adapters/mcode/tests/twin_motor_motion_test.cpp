// Tests of motion: MA, MR, SL, settling, refusals, scaling, backlash, counters, pause, limits and homing. "Trap n": section of the known
// traps.
#include "adapters/mcode/tests/twin_motor_bench.hpp"

#include <cmath>
#include <random>

namespace axisgate::mcode::twin::test {
namespace {

using Kind = MotorEvent::Kind;

TEST(McodeMotion, MovesEndAtTheirTargetAndTellIt) {
    MotorBench b;
    EXPECT_EQ(b.start("MA", 20000), 0);
    EXPECT_EQ(*b.motor.text(Word::MD, b.now), "MA");
    EXPECT_EQ(b.get("MV"), 1);
    EXPECT_EQ(b.get("MP"), 1);
    b.rest();
    EXPECT_EQ(b.get("P"), 20000);
    EXPECT_EQ(b.count(Kind::finished), 1);
    EXPECT_EQ(b.start("MA", 3000), 0);
    b.rest();
    EXPECT_EQ(b.get("P"), 3000);
    EXPECT_EQ(b.start("MR", -51200), 0);
    b.rest();
    EXPECT_EQ(b.get("P"), 3000 - 51200);
    EXPECT_EQ(b.get("C1"), 3000 - 51200);
    EXPECT_EQ(b.get("C2"), std::round((3000 - 51200) * 4000 / 51200.0));
    EXPECT_EQ(*b.motor.text(Word::MD, b.now), "MR");
    EXPECT_EQ(b.errors(), Codes{});
}

TEST(McodeMotion, MvAndMpStayOneForMtAndHt) {  // trap 9
    MotorBench b;
    b.start("MR", 3840000);
    b.pass_ms(5767);
    EXPECT_EQ(b.get("P"), 3840000);
    EXPECT_EQ(b.get("V"), 0);
    EXPECT_EQ(b.get("MV"), 1);
    EXPECT_EQ(b.get("MP"), 1);
    b.pass_ms(998);
    EXPECT_EQ(b.get("MV"), 1);
    EXPECT_EQ(b.get("MP"), 1);
    EXPECT_EQ(b.count(Kind::finished), 0);
    b.pass_ms(2);
    EXPECT_EQ(b.get("MV"), 0);
    EXPECT_EQ(b.get("MP"), 0);
    EXPECT_EQ(b.count(Kind::finished), 1);
    EXPECT_EQ(b.motor.deadline(), never);  // at rest a twin costs nothing

    b.set("MT", 0);
    b.set("HT", 0);
    b.start("MR", 100);
    EXPECT_LT(b.rest(), 0.1);
    EXPECT_EQ(b.shown("current"), Value{std::int64_t{25}});  // both 0: the run current stays
}

TEST(McodeMotion, ThreeStops) {  // trap 8
    MotorBench b;
    b.start("SL", 500000);
    b.pass_ms(1000);
    b.motor.stop_at_once(b.now);
    EXPECT_EQ(b.get("V"), 0);
    EXPECT_EQ(b.get("MV"), 0);
    const double there = b.get("P");
    b.pass_ms(100);
    EXPECT_EQ(b.get("P"), there);

    b.start("SL", 500000);
    b.pass_ms(1000);
    EXPECT_EQ(b.start("SL", 0), 0);
    b.pass_ms(100);
    EXPECT_NEAR(b.get("V"), 400000, 1);  // D = 1000000
    EXPECT_EQ(b.get("VC"), 1);
    b.pass_ms(400);
    EXPECT_EQ(b.get("V"), 0);
    b.rest();
    EXPECT_EQ(b.count(Kind::finished), 1);
    EXPECT_EQ(b.errors(), Codes{});

    b.set("IS", {4, 5, 0});
    b.start("SL", 500000);
    b.pass_ms(1000);
    b.hand("inputs", std::int64_t{7});
    b.pass_ms(100);
    EXPECT_NEAR(b.get("V"), 400000, 1);
    EXPECT_EQ(b.errors(), (Codes{91}));
    b.rest();
    b.hand("inputs", std::int64_t{15});
    b.pass_ms(1);
    b.motor.tell(false, true, b.now);
    b.hand("inputs", std::int64_t{7});
    b.pass_ms(1);
    ASSERT_EQ(b.count(Kind::end_program), 1);
    EXPECT_EQ(b.events[0].code, 48);
    EXPECT_EQ(b.errors(), Codes{});  // nothing moved
    b.motor.pause(b.now);
    b.hand("inputs", std::int64_t{15});
    b.hand("inputs", std::int64_t{7});
    b.pass_ms(1);
    EXPECT_EQ(b.count(Kind::end_program), 0);  // ignored when the program is paused
}

TEST(McodeMotion, VmInMotionActsOnTheNextMoveAndSlAtOnce) {  // trap 10
    MotorBench b;
    b.start("MR", 5000000);
    b.pass_ms(1000);
    EXPECT_EQ(b.get("V"), 768000);
    EXPECT_EQ(b.set("VM", 100000), 0);
    b.pass_ms(500);
    EXPECT_EQ(b.get("V"), 768000);
    b.rest();
    b.start("MR", -500000);
    b.pass_ms(1000);
    EXPECT_EQ(b.get("V"), -100000);
    b.rest();

    b.start("SL", 200000);
    b.pass_ms(1000);
    EXPECT_EQ(b.get("V"), 200000);  // not bounded by VM
    EXPECT_EQ(b.get("VC"), 0);
    b.start("SL", 400000);
    b.pass_ms(100);
    EXPECT_NEAR(b.get("V"), 300000, 1);
    EXPECT_EQ(b.get("VC"), 1);
    b.start("SL", -200000);
    b.pass_ms(1000);
    EXPECT_EQ(b.get("V"), -200000);
    EXPECT_EQ(b.get("MP"), 0);
}

TEST(McodeMotion, MsRescalesAndEncoderModeChangesUnitsAndDefaults) {  // trap 11
    MotorBench b;
    b.start("MA", 51200);
    b.rest();
    EXPECT_EQ(b.set("MS", 2), 0);
    EXPECT_EQ(b.get("VI"), 8);
    EXPECT_EQ(b.get("VM"), 6000);
    EXPECT_EQ(b.get("A"), 7813);
    EXPECT_EQ(b.get("D"), 7813);
    EXPECT_EQ(b.get("C2"), 4000);
    EXPECT_EQ(b.get("P"), 51200);
    b.start("MR", 400);  // a turn now
    b.rest();
    EXPECT_EQ(b.get("C2"), 8000);
    EXPECT_EQ(b.set("MS", 256), 0);
    EXPECT_EQ(b.get("VM"), 768000);
    for (const int bad : {0, 3, 512, 255})
        EXPECT_EQ(b.set("MS", bad), 21) << bad;

    EXPECT_EQ(b.set("EE", 1), 0);
    EXPECT_EQ(b.get("VI"), 78);
    EXPECT_EQ(b.get("VM"), 60000);
    EXPECT_EQ(b.get("A"), 78125);
    EXPECT_EQ(b.get("D"), 78125);
    EXPECT_EQ(b.get("P"), 8000);  // follows C2
    EXPECT_EQ(b.set("MS", 128), 8);
    EXPECT_EQ(b.set("MS", 256), 0);
    EXPECT_EQ(b.set("A", 44000001), 21);
    EXPECT_EQ(b.set("VM", 200001), 77);
    b.set("P", 0);
    b.start("MR", 4000);
    b.rest();
    EXPECT_EQ(b.get("P"), 4000);
    EXPECT_EQ(b.get("C2"), 12000);
    EXPECT_EQ(b.get("C1"), 51200 + 400 + 51200);
    EXPECT_EQ(b.set("EE", 0), 0);
    EXPECT_EQ(b.get("VM"), 768000);
    EXPECT_EQ(b.get("P"), b.get("C1"));
}

TEST(McodeMotion, MaWithThirdFieldNeverStops) {  // trap 13
    MotorBench b;
    EXPECT_EQ(b.start("MA", {100000, 0, 1}), 0);
    b.pass_ms(3000);
    EXPECT_EQ(b.get("V"), 768000);
    EXPECT_EQ(b.get("MP"), 0);
    EXPECT_EQ(b.get("MV"), 1);
    EXPECT_EQ(b.count(Kind::finished), 1);   // the position was reached
    EXPECT_EQ(b.start("MA", {0, 0, 0}), 0);  // sample 9.11 ends so
    b.rest();
    EXPECT_EQ(b.get("P"), 0);
    EXPECT_EQ(b.start("MA", {1, 2}), 21);
    EXPECT_EQ(b.start("MA", {1, 0, 2}), 21);
    EXPECT_EQ(b.start("MA", 2147483648.0), 21);
}

TEST(McodeMotion, BacklashMathematicalAndMechanical) {  // trap 19
    MotorBench b;
    b.set("BE", 1);
    b.set("BL", 1000);
    b.start("MR", 100000);
    b.rest();
    EXPECT_EQ(b.get("P"), 100000);
    b.start("MR", -50000);
    b.rest();
    EXPECT_EQ(b.get("P"), 49000);
    b.start("MR", -50000);  // the same way: nothing is added
    b.rest();
    EXPECT_EQ(b.get("P"), -1000);
    b.start("MR", 100000);
    b.rest();
    EXPECT_EQ(b.get("P"), 100000);

    b.set("BM", 1);
    b.set("BL", 15000);
    b.start("MR", 100000);  // with the sign of BL: one move
    EXPECT_EQ(b.rest() > 0, true);
    EXPECT_EQ(b.get("P"), 200000);
    b.start("MR", -100000);
    double least = 1e9;
    for (int i = 0; i < 2000; ++i) {
        b.pass_ms(1);
        least = std::min(least, b.get("P"));
    }
    EXPECT_NEAR(least, 85000, 30);  // overrun by BL, then a second move
    b.rest();
    EXPECT_EQ(b.get("P"), 100000);
}

TEST(McodeMotion, CountersWrapWithoutError) {  // trap 25
    MotorBench b;
    b.set("C1", 2147483647);
    EXPECT_EQ(b.get("P"), 2147483647);  // C1 supplies P
    b.start("MR", 1);
    b.rest();
    EXPECT_EQ(b.get("C1"), -2147483648.0);
    EXPECT_EQ(b.get("P"), -2147483648.0);
    EXPECT_EQ(b.errors(), Codes{});
    b.set("P", 0);
    EXPECT_EQ(b.get("C1"), -2147483648.0);  // P only moves the origin
    b.set("C2", 2147483647);
    b.start("MR", 13);
    b.rest();
    EXPECT_EQ(b.get("C2"), -2147483648.0);
    EXPECT_EQ(b.get("P"), 13);
}

TEST(McodeMotion, PCanBeWrittenInMotion) {
    MotorBench b;
    b.start("SL", 100000);
    b.pass_ms(1000);
    b.set("P", 0);
    EXPECT_EQ(b.get("P"), 0);
    b.pass_ms(1000);
    EXPECT_NEAR(b.get("P"), 100000, 1);
    b.start("MA", 500000);
    b.rest();
    EXPECT_EQ(b.get("P"), 500000);
}

TEST(McodeMotion, EveryRefusalHasItsCode) {
    MotorBench b;
    b.set("DE", 0);
    EXPECT_EQ(b.start("MR", 100), 94);
    EXPECT_EQ(b.start("SL", 5000), 94);
    EXPECT_EQ(b.start("HI", 1), 94);
    b.set("DE", 1);
    b.hand("supply_voltage", 0.0);
    EXPECT_EQ(b.errors(), (Codes{79}));
    EXPECT_EQ(b.start("MR", 100), 96);
    b.hand("supply_voltage", 48.0);
    EXPECT_EQ(b.start("SL", 5000001), 21);
    EXPECT_EQ(b.start("SL", 500), 97);  // below VI = 1000
    EXPECT_EQ(b.set("VI", 768000), 22);
    EXPECT_EQ(b.set("VI", 0), 21);
    EXPECT_EQ(b.set("VM", 1000), 23);
    EXPECT_EQ(b.set("VM", 2560001), 77);
    EXPECT_EQ(b.set("VM", 2560000), 0);
    EXPECT_EQ(b.set("A", 65), 21);
    EXPECT_EQ(b.set("D", 8e9), 21);  // E-51
    EXPECT_EQ(b.get("D"), 1000000);
    EXPECT_EQ(b.set("HT", 65036), 21);
    EXPECT_EQ(b.set("HT", 65035), 0);
    EXPECT_EQ(b.set("MT", 501), 21);
    EXPECT_EQ(b.set("MF", 91), 76);
    EXPECT_EQ(b.set("MF", 2560001), 76);
    EXPECT_EQ(b.set("MV", 1), 25);
    EXPECT_EQ(b.start("HM", 5), 81);
    EXPECT_EQ(b.start("HM", 1), 80);
    b.set("HT", 500);
    b.set("AT", 2);
    b.set("A", 1100000000);
    b.set("VM", 100000);
    EXPECT_EQ(b.start("MR", 100), 98);
    b.set("A", 1000000);
    EXPECT_EQ(b.start("MR", 100), 0);
    b.rest();
    b.set("DT", 3);
    b.set("D", 1100000000);
    EXPECT_EQ(b.start("MR", 100), 99);
    b.set("DT", 1);
    b.set("MS", 128);
    EXPECT_EQ(b.start("SL", 1280001), 77);
    EXPECT_EQ(b.start("SL", 1280000), 0);
    EXPECT_EQ(b.set("RD", 1), 95);
    EXPECT_EQ(b.start("HI", 1), 85);
    EXPECT_EQ(b.start("SC", 1), 89);
    b.pass_ms(500);
    EXPECT_EQ(b.start("SL", 0), 0);
    for (const char* move : {"MR", "MA"})
        EXPECT_EQ(b.start(move, 100), 85) << move;  // motion has to come to a stop first
    b.rest();
    b.set("MS", 256);
    b.set("VI", 1);
    EXPECT_EQ(b.set("MS", 1), 0);
    EXPECT_EQ(b.start("MR", 1), 90);  // VI was scaled to nothing
}

TEST(McodeMotion, SavingIsRefusedDuringMovesAndNotDuringSlews) {
    MotorBench b;
    b.start("SL", 100000);
    EXPECT_FALSE(b.motor.busy(false, b.now));
    EXPECT_TRUE(b.motor.busy(true, b.now));
    b.start("MA", 0);
    EXPECT_TRUE(b.motor.busy(false, b.now));
    b.rest();
    EXPECT_FALSE(b.motor.busy(true, b.now));
}

TEST(McodeMotion, PauseStopsWithARampAndResumeReachesTheTarget) {
    MotorBench b;
    b.start("MA", 2000000);
    b.pass_ms(1000);
    b.motor.pause(b.now);
    b.pass_ms(100);
    EXPECT_LT(b.get("V"), 768000);
    EXPECT_GT(b.get("V"), 0);
    b.pass_ms(3000);
    EXPECT_EQ(b.get("MV"), 0);
    const double there = b.get("P");
    EXPECT_LT(there, 1000000);
    EXPECT_EQ(b.count(Kind::finished), 0);  // not a completion
    b.motor.resume(b.now);
    EXPECT_EQ(b.get("MV"), 1);
    b.rest();
    EXPECT_EQ(b.get("P"), 2000000);
    EXPECT_EQ(b.count(Kind::finished), 1);

    b.start("SL", -300000);
    b.pass_ms(1000);
    b.motor.pause(b.now);
    b.pass_ms(50);
    b.motor.resume(b.now);  // before it stands
    b.pass_ms(1000);
    EXPECT_EQ(b.get("V"), -300000);
}

TEST(McodeMotion, LimitSwitchesStopTheirOwnDirection) {
    for (int mode = 1; mode <= 6; ++mode) {
        MotorBench b;
        b.set("LM", mode);
        b.set("IS", {1, 2, 0});
        b.set("IS", {2, 3, 0});
        b.start("SL", 400000);
        b.pass_ms(1000);
        b.hand("limit_negative", true);  // not of this direction
        b.pass_ms(10);
        EXPECT_EQ(b.get("V"), 400000);
        b.hand("limit_negative", false);
        b.hand("limit_positive", true);
        EXPECT_EQ(b.get("V"), mode >= 4 ? 0 : 400000) << mode;
        b.pass_ms(100);
        EXPECT_NEAR(b.get("V"), mode >= 4 ? 0 : 300000, 1) << mode;
        b.rest();
        EXPECT_EQ(b.count(Kind::end_program), mode % 3 == 0 ? 1 : 0);
        EXPECT_EQ(b.errors(), (Codes{83})) << mode;
        EXPECT_EQ(b.start("MR", 100), 83);  // held: away only
        EXPECT_EQ(b.start("SL", 2000), 83);
        EXPECT_EQ(b.start("MR", -100), 0);
        b.rest();
        b.hand("limit_positive", false);
        EXPECT_EQ(b.start("MR", 100), 0);
        b.rest();
        EXPECT_EQ(b.count(Kind::finished), 2);
    }
}

TEST(McodeMotion, SoftLimitsAnswerAsLmSays) {
    MotorBench b;
    EXPECT_EQ(b.set("LS", {0, -102400, 1}), 0);
    EXPECT_EQ(b.set("LS", {1, 102400, 1}), 0);
    EXPECT_EQ(b.set("LS", {0, 102400, 1}), 21);
    EXPECT_EQ(b.set("LS", {2, 0, 1}), 21);
    EXPECT_EQ(*b.motor.text(Word::LS, b.now), "LS=0, -102400, 1\r\nLS=1, 102400, 1");
    b.set("LM", 5);
    b.start("SL", 200000);
    b.rest();
    EXPECT_EQ(b.errors(), (Codes{83}));
    EXPECT_NEAR(b.get("P"), 102400, 1);
    EXPECT_EQ(b.start("MR", 10), 83);
    b.set("LM", 1);
    b.start("MA", -500000);
    b.rest();
    EXPECT_EQ(b.errors(), (Codes{84}));
    EXPECT_LT(b.get("P"), -102400);
    EXPECT_GT(b.get("P"), -500000);
    EXPECT_EQ(b.start("MA", -1000000), 84);
    EXPECT_EQ(b.start("MA", 0), 0);
    b.rest();
    EXPECT_EQ(b.get("P"), 0);
}

TEST(McodeMotion, HomingSeeksAtVmAndStopsWhereTheSwitchReleases) {
    // The switch covers 0.05 turns from turn 2 (2560 steps from 102400) or from turn -2.
    struct Row {
        int type;
        double at;
        double stop;  // turns: the edge from which the creep leaves the switch
    };
    for (const Row& r : {Row{1, -2, -1.95}, Row{3, 2, 2.0}}) {
        MotorBench b;
        b.set("VM", 20000);
        b.set("A", 10000000);
        b.set("D", 10000000);
        b.set("IS", {1, 1, 0});
        b.hand("home_position", r.at);
        EXPECT_EQ(b.start("HM", r.type), 0);
        EXPECT_EQ(b.start("MA", 0), 85);
        EXPECT_EQ(b.start("SL", 0), 85);
        EXPECT_EQ(b.get("MP"), 0);
        b.rest();
        EXPECT_NEAR(b.get("P") / 51200, r.stop, 2e-4) << r.type;
        EXPECT_EQ(b.get("I1"), 0);
        EXPECT_EQ(b.count(Kind::finished), 1);
        EXPECT_EQ(b.errors(), Codes{});
    }
    for (const int type : {2, 4}) {  // creep on in the same direction, until the tester opens the switch
        MotorBench b;
        b.set("IS", {1, 1, 0});
        b.start("HM", type);
        b.pass_ms(2000);
        EXPECT_EQ(b.get("V"), type == 2 ? -768000 : 768000);
        b.hand("home_switch", true);
        b.pass_ms(2000);
        EXPECT_EQ(b.get("V"), type == 2 ? -1000 : 1000);
        b.hand("home_switch", false);
        EXPECT_EQ(b.get("V"), 0);
        b.rest();
        EXPECT_EQ(b.count(Kind::finished), 1);
    }
}

TEST(McodeMotion, HomingAndLimits) {  // trap 21
    for (const int mode : {1, 4}) {
        MotorBench b;
        b.set("LM", mode);
        b.set("IS", {1, 1, 0});
        b.set("IS", {2, 2, 0});
        b.set("IS", {3, 3, 0});
        b.set("VM", 50000);
        b.hand("limit_negative_position", -1.0);
        b.hand("home_position", 1.0);
        b.start("HM", 1);  // the switch lies the other way: the limit turns the search once
        b.rest();
        EXPECT_EQ(b.errors(), Codes{}) << mode;
        EXPECT_NEAR(b.get("P") / 51200, 1.05, 2e-4) << mode;  // creeps plus, out of the far edge
        b.hand("home_position", std::string("none"));
        b.hand("home_switch", false);
        b.hand("limit_positive_position", 2.0);
        b.start("HM", 1);
        b.rest();
        EXPECT_EQ(b.errors(), (Codes{82})) << mode;
    }
    for (const int mode : {2, 3, 5, 6}) {
        MotorBench b;
        b.set("LM", mode);
        b.set("IS", {1, 1, 0});
        b.set("IS", {3, 3, 0});
        b.hand("limit_negative_position", -1.0);
        b.start("HM", 1);
        b.rest();
        EXPECT_EQ(b.count(Kind::end_program), mode % 3 == 0 ? 1 : 0);
        EXPECT_EQ(b.errors(), (Codes{84})) << mode;
    }
}

TEST(McodeMotion, HomingToTheIndexAndToItsOffset) {
    for (const int type : {1, 2, 3, 4}) {
        MotorBench b;
        b.set("VI", 20000);
        b.start("MA", 12345);
        b.rest();
        EXPECT_EQ(b.get("I6"), 0);
        EXPECT_EQ(b.start("HI", type), 0);
        b.rest();
        EXPECT_EQ(b.get("I6"), 1) << type;
        EXPECT_EQ(std::fmod(b.get("P"), 51200), 0) << type;
        EXPECT_EQ(b.set("FS", 10246), 0);
        EXPECT_EQ(b.start("HF", type), 0);
        b.rest();
        EXPECT_NEAR(std::fmod(b.get("P") + 10 * 51200.0, 51200), 10246, 1) << type;
    }
    MotorBench open({lmdo, 23});
    EXPECT_EQ(open.start("HI", 1), 37);
    EXPECT_EQ(open.set("EE", 1), 37);
    EXPECT_EQ(open.read_error("ST"), 37);
    EXPECT_EQ(open.read_error("AF"), 37);
    EXPECT_EQ(open.start("MR", 100), 0);
}

TEST(McodeMotion, ReversedDirectionTurnsTheShaftTheOtherWay) {
    MotorBench b;
    b.start("MR", 51200);
    b.rest();
    EXPECT_EQ(b.set("RD", 1), 0);
    b.set("IS", {1, 2, 0});
    b.hand("limit_positive_position", 1.5);
    b.start("MR", 51200);  // away from that switch now
    b.rest();
    EXPECT_EQ(b.errors(), Codes{});
    EXPECT_EQ(b.get("P"), 102400);
}

TEST(McodeMotion, RandomCommandsKeepTheInvariants) {
    std::mt19937_64 random(503);
    MotorBench b;
    double steps = 0;
    for (int n = 0; n < 300; ++n) {
        b.set("VM", 2000 + static_cast<double>(random() % 2000000));
        b.set("A", 10000 + static_cast<double>(random() % 50000000));
        b.set("D", 10000 + static_cast<double>(random() % 50000000));
        b.set("AT", static_cast<double>(1 + random() % 3));
        b.set("DT", static_cast<double>(1 + random() % 3));
        b.set("AJ", static_cast<double>(random() % 128));
        const double vm = b.get("VM");
        const double d = static_cast<double>(static_cast<std::int64_t>(random() % 2000000) - 1000000);
        const int code = b.start("MR", d);
        if (code == 98 || code == 99) continue;
        ASSERT_EQ(code, 0);
        steps += d;
        while (b.get("MV") == 1) {
            ASSERT_LE(std::abs(b.get("V")), vm);
            b.pass_ms(random() % 300 + 1);
        }
        ASSERT_EQ(b.get("P"), steps);
        ASSERT_EQ(b.get("C1"), b.get("P"));
        ASSERT_EQ(b.get("C2"), nearest(steps * 4000 / 51200));
    }
    EXPECT_GT(b.count(Kind::finished), 200);
    EXPECT_EQ(b.errors(), Codes{});
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
