// Encoders of the simulated MACS: changes of the source, zeros, jumps of absolute encoders, the two readings of a target window.
#include <gtest/gtest.h>

#include "adapters/aposs/tests/macs_bench.hpp"

namespace axisgate::aposs::test {
namespace {

std::int64_t number_of(Macs& b, const std::string& line) {
    const std::string reported = say(b, line);
    const auto colon = reported.rfind(": ");
    return colon == std::string::npos ? INT64_MIN : std::strtoll(reported.c_str() + colon + 2, nullptr, 10);
}
void does(Macs& b, std::initializer_list<const char*> lines) {
    for (const char* line : lines)
        ASSERT_EQ(say(b, line), line);
}

/// [L5834-5887]: the encoder of axis 1 is the master of axis 2, and an origin command changes the axis only, or the encoder.
TEST(ApossEncoder, SoftZeroOfTheManual) {
    for (const bool soft : {true, false}) {
        SCOPED_TRACE(soft);
        Macs b;
        does(b, {"SET ENCODERTYPE 10 / 20", "SET MENCODERTYPE 30 / 10", soft ? "SET ENCCONTROL 2" : "SET ENCCONTROL 0"});
        b.enable_axis(0);
        b.enable_axis(1);
        for (const int axis : {0, 1})
            b.go(axis, 25'000);
        b.pass(20s);
        ASSERT_EQ(number_of(b, "APOS x(1)"), 25'000);
        ASSERT_EQ(number_of(b, "MAPOS x(2)"), 25'000);
        ASSERT_EQ(number_of(b, "SYSVAR[42]"), 25'000);
        does(b, {"DEFORIGIN x(1)"});
        EXPECT_EQ(number_of(b, "APOS x(1)"), 0);
        EXPECT_EQ(number_of(b, "MAPOS x(2)"), soft ? 25'000 : 0) << "its encoder was set to 0 under it";
        EXPECT_EQ(number_of(b, "SYSVAR[42]"), 25'000) << "encoder 2 is another one";
    }
}

TEST(ApossEncoder, SoftZeroOfAMaster) {  // "If MENCCONTROL was set of x(2) to 2, then also a DEFMORIGIN x(2) could be executed"
    for (const bool soft : {true, false}) {
        SCOPED_TRACE(soft);
        Macs b;
        does(b, {"SET MENCODERTYPE x(2) 10", soft ? "SET MENCCONTROL x(2) 2" : "SET MENCCONTROL x(2) 0"});
        b.enable_axis(0);
        b.go(0, 5'000);
        b.pass(10s);
        ASSERT_EQ(number_of(b, "MAPOS x(2)"), 5'000);
        does(b, {"DEFMORIGIN x(2)"});
        EXPECT_EQ(number_of(b, "MAPOS x(2)"), 0);
        EXPECT_EQ(number_of(b, "APOS x(1)"), soft ? 5'000 : 0) << "the encoder is that of axis 1";
        b.go(0, soft ? 5'100 : 100);
        b.pass(5s);
        EXPECT_EQ(number_of(b, "MAPOS x(2)"), 100);
    }
    // The zero of a simulated master and of an own encoder, with a coupled slave that must not move.
    Macs b;
    b.enable_axis(1);
    does(b, {"SET MENCODERTYPE x(2) 6", "SYNCP x(2)", "SYSVAR[4105] x(2) = 1"});
    b.pass(2s);
    does(b, {"SYSVAR[4105] x(2) = 0"});
    b.pass(2s);
    const auto there = b.position_of(1);
    EXPECT_EQ(there, number_of(b, "SYSVAR[4105] x(2)"));
    does(b, {"DEFMORIGIN x(2)"});
    b.pass(2s);
    EXPECT_EQ(number_of(b, "SYSVAR[4105] x(2)"), 0) << "the simulation itself is at 0";
    EXPECT_EQ(b.position_of(1), there);
}

TEST(ApossEncoder, AnotherMasterIsAJumpUnlessItIsSoft) {  // MENCCONTROL bit 0 [L5889-5910]
    for (const int soft : {0, 1}) {
        SCOPED_TRACE(soft);
        Macs b;
        b.hand("axis2.encoder", Value{std::int64_t{3'000}});
        ASSERT_EQ(number_of(b, "MAPOS x(2)"), 3'000);
        ASSERT_EQ(b.set(108, soft, 1), Abort::none);
        does(b, {"SET MENCODERTYPE x(2) 6"});
        EXPECT_EQ(number_of(b, "MAPOS x(2)"), soft ? 3'000 : 0) << "the simulation is at 0";
        does(b, {"SET MENCODERTYPE x(2) -1"});
        EXPECT_EQ(number_of(b, "MAPOS x(2)"), soft ? 3'000 : 0) << "a linked command value never jumps [L4800]";
        does(b, {"SET MENCODERTYPE x(2) 0"});
        EXPECT_EQ(number_of(b, "MAPOS x(2)"), 3'000);
        // A coupled slave follows the jump.
        b.enable_axis(1);
        does(b, {"SYNCP x(2)", "SET MENCODERTYPE x(2) 6"});
        b.pass(5s);
        EXPECT_EQ(b.position_of(1), soft ? 0 : -3'000);
    }
}

TEST(ApossEncoder, JumpsOfALinearAbsoluteEncoderAreMadeGoodAHundredTimes) {  // ENCODERTYPE 3 and 4 [L2961-2967]
    const auto moving = [](std::int64_t type) {
        auto b = std::make_unique<Macs>();
        EXPECT_EQ(b->set(27, type), Abort::none);
        EXPECT_EQ(b->set(2, 4'000), Abort::none);  // ENCODER
        EXPECT_EQ(b->set(15, 1'500), Abort::none);
        b->enable_axis(0, 3);
        EXPECT_EQ(b->write(0x60FF, 0, 2'000, 4), Abort::none);
        b->pass(3s);
        return b;
    };
    const auto b = moving(3);
    const auto before = b->position_of(0);
    b->hand("misread", Value{std::int64_t{2'001}});  // more than half the resolution
    b->pass(90ms);
    EXPECT_NEAR(static_cast<double>(b->position_of(0) - before), 180, 4) << "by its last velocity";
    EXPECT_NEAR(static_cast<double>(number_of(*b, "SYSVAR[16]")), 91, 1) << "each reading is counted";
    EXPECT_EQ(b->error(), 0);
    b->hand("misread", Value{std::int64_t{0}});
    b->pass(1s);
    EXPECT_EQ(b->error(), 0) << "it was a short one";
    b->hand("misread", Value{std::int64_t{-2'001}});
    b->pass(99ms);
    EXPECT_EQ(b->error(), 0);
    b->pass(100ms);
    EXPECT_EQ(b->error(), 0x8611) << "after 100 readings nothing is made good, and POSERR is exceeded";
    EXPECT_GT(number_of(*b, "SYSVAR[16]"), 190);

    const auto small = moving(4);
    small->hand("misread", Value{std::int64_t{2'000}});
    small->pass(100ms);
    EXPECT_EQ(small->error(), 0x8611) << "a jump that is not larger than half the resolution is none";
    EXPECT_EQ(number_of(*small, "SYSVAR[16]"), 0);
    const auto other = moving(1);
    other->hand("misread", Value{std::int64_t{2'001}});
    other->pass(100ms);
    EXPECT_EQ(other->error(), 0x8611) << "other absolute encoders are believed";
    const auto within = moving(1);
    within->hand("misread", Value{std::int64_t{1'000}});
    within->pass(1s);
    EXPECT_EQ(within->error(), 0) << "less than POSERR";
}

TEST(ApossEncoder, ATargetIsReachedByTwoReadings) {  // TESTWIN, TESTTIM, TESTVAL [L2044-2077, L2856-2900]
    constexpr int never = -1;
    // ms until the target is reached: a window of 50 qc, and a shaft that oscillates by `swing` qc with a period of 7 ms.
    const auto after = [](int testwin, int testtim, int testval, int swing) {
        Macs b;
        EXPECT_EQ(b.set(8, testwin), Abort::none);
        EXPECT_EQ(b.set(24, testtim), Abort::none);
        EXPECT_EQ(b.set(25, testval), Abort::none);
        EXPECT_EQ(b.set(15, 100'000), Abort::none);
        b.enable_axis(0);
        b.hand("swing", Value{std::int64_t{swing}});
        b.go(0, 100);
        for (int ms = 0; ms < 3'000; ++ms) {
            if ((b.status_of(0) & 0x400) != 0) return ms;
            b.pass(1ms);
        }
        EXPECT_EQ(b.error(), 0) << "to be stuck is no error [L2060]";
        return never;
    };
    const int end = after(0, 7, 1, 40);  // no window: only the command position
    ASSERT_GT(end, 50);
    EXPECT_NEAR(after(50, 7, 1, 0), end + 7, 1) << "two readings of a shaft that stands";
    EXPECT_NEAR(after(50, 7, 1, 40), end + 7, 1) << "and one swing apart they are the same, too";
    EXPECT_EQ(after(50, 3, 1, 40), never) << "within the window, and no two readings agree";
    EXPECT_GE(after(50, 3, 20, 40), end + 3) << "of seven pairs at least one does";
    EXPECT_NEAR(after(50, 3, 0, 40), end + 3, 1) << "TESTVAL 0: the time within the window alone, as CANopen has it";
    EXPECT_GE(after(30, 7, 1, 40), end + 7) << "read once it is in the window";

    // A shaft that is held outside the window does not reach it either.
    Macs stuck;
    ASSERT_EQ(stuck.set(8, 10), Abort::none);
    ASSERT_EQ(stuck.set(24, 5), Abort::none);
    ASSERT_EQ(stuck.set(15, 100'000), Abort::none);
    stuck.enable_axis(0);
    stuck.hand("stall", Value{true});
    stuck.go(0, 100);
    stuck.pass(5s);
    EXPECT_EQ(stuck.status_of(0) & 0x400, 0);
    EXPECT_EQ(stuck.error(), 0);
}

}  // namespace
}  // namespace axisgate::aposs::test
