// Errors of motions that typed lines seldom reach: velocities below VI, S-curves that are too short, make-up that is owed; the variable
// current.
#include "adapters/mcode/tests/twin_motor_bench.hpp"

namespace axisgate::mcode::twin::test {
namespace {

TEST(McodeMotion, ASlewBelowViIsRefused) {  // error 97
    MotorBench b;
    b.set("VI", 1000);
    EXPECT_EQ(b.start("SL", 999), 97);
    EXPECT_EQ(b.get("MV"), 0);
    EXPECT_EQ(b.start("SL", -1000), 0);
}

TEST(McodeMotion, AnSCurveOfLessThanItsPointsIsRefused) {  // errors 98 and 99
    MotorBench b;
    b.set("VI", 1000);
    b.set("VM", 2000);
    b.set("AT", 2);
    b.set("DT", 2);
    b.set("A", 1'000'000'000);
    EXPECT_EQ(b.start("MR", 1000), 98);
    b.set("A", 1'000'000);
    b.set("D", 1'000'000'000);
    EXPECT_EQ(b.start("MR", 1000), 99);
    b.set("DT", 1);
    EXPECT_EQ(b.start("MR", 1000), 0) << "a linear ramp has no table";
}

TEST(McodeClosedLoop, MakeUpThatIsOwedEndsWhereTheDriveIsDisabled) {  // error 110
    for (const bool held : {true, false}) {
        MotorBench b;
        b.set("AS", 1);
        b.set("MU", 1);
        b.set("LG", 2'000'000);
        b.start("MR", 1'500'000);
        b.pass_ms(1000);
        b.hand("stall", held);
        b.pass_ms(100);
        b.set("DE", 0);
        EXPECT_EQ(b.errors(), held ? Codes{110} : Codes{});
        EXPECT_EQ(b.get("LL"), 0);
        EXPECT_EQ(b.get("MV"), 0);
    }
}

TEST(McodeClosedLoop, TheVariableCurrentFollowsTheLoad) {  // AS = 2 [L1488]
    const auto current = [](MotorBench& b) { return as_integer(b.shown("current")).value_or(-1); };
    MotorBench b;
    b.set("RC", 80);
    b.set("AS", 2);
    b.start("SL", 100'000);
    b.pass_ms(10);
    EXPECT_EQ(current(b), 80) << "full for a change of the speed";
    b.pass_ms(1000);
    EXPECT_EQ(current(b), 20) << "without load a quarter";
    b.hand("load", 0.5);
    EXPECT_EQ(current(b), 50);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
