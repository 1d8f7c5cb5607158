// Points of CiA 301 and CiA 402 that the simulated drive keeps beside those of the other files: error control, event-driven PDOs, limits of
// speed and torque, the list of errors, homing speeds, limit switches.
#include "adapters/cia402/tests/twin_bench.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using namespace std::chrono_literals;
using canopen::Abort;

void inject(Bench& b, std::int64_t code) { ASSERT_EQ(b.twin->set_hand("inject_error", Value{code}, b.now, b.out), ""); }

TEST(Cia402TwinStandard, ReadyGoesToEnabledAtOnceAndAFaultWhoseCauseStaysIsNotReset) {
    Bench b;
    b.word(0x06);
    b.word(0x0F);
    EXPECT_EQ(b.status() & 0x6Fu, 0x27u);
    inject(b, 0x4210);
    EXPECT_EQ(b.status() & 0x4Fu, 0x08u);
    b.word(0x80);
    EXPECT_EQ(b.status() & 0x4Fu, 0x08u) << "the cause persists";
    b.word(0);
    inject(b, 0);
    EXPECT_EQ(b.status() & 0x4Fu, 0x08u) << "not by itself";
    b.word(0x80);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u);
}

TEST(Cia402TwinStandard, TheErrorListKeepsFour) {
    Bench b;
    for (const int code : {0x2310, 0x3110, 0x3210, 0x4210, 0x5113})
        inject(b, code);
    for (const auto& [sub, code] : {std::pair{1, 0x5113}, {2, 0x4210}, {3, 0x3210}, {4, 0x3110}})
        EXPECT_EQ(b.read(0x1003, static_cast<std::uint8_t>(sub)), code) << sub;
    ASSERT_EQ(b.write(0x1003, 0, 0, 1), Abort::none);
    EXPECT_EQ(b.read(0x1003, 1), 0);
    EXPECT_NE(b.write(0x1003, 0, 1, 1), Abort::none) << "only 0 can be written";
}

TEST(Cia402TwinStandard, ResetOfCommunicationKeepsTheAxis) {
    Bench b;
    ASSERT_EQ(b.write(0x1017, 0, 100, 2), Abort::none);
    ASSERT_EQ(b.write(0x6081, 0, 777, 4), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.pass(1s);
    b.out.clear();
    b.send(canopen::nmt_frame(canopen::NmtCommand::reset_communication, 5));
    ASSERT_EQ(b.count(0x705), 1u) << "the boot-up message";
    EXPECT_EQ(b.read(0x1017), 0);
    EXPECT_EQ(b.read(0x6081), 777);
    EXPECT_EQ(b.read(0x606C), 5000);
}

TEST(Cia402TwinStandard, GuardingIsAnsweredAndItsEndStopsTheDrive) {
    Bench b;
    ASSERT_EQ(b.write(0x100C, 0, 100, 2), Abort::none);
    ASSERT_EQ(b.write(0x100D, 0, 3, 1), Abort::none);
    ASSERT_EQ(b.write(0x6007, 0, 2, 2), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    Frame ask = canopen::data_frame(0x705, {});
    ask.remote = true;
    std::vector<unsigned> answers;
    for (int i = 0; i < 10; ++i) {
        b.out.clear();
        b.send(ask);
        ASSERT_EQ(b.count(0x705), 1u);
        answers.push_back(b.out.frames[0].frame.data()[0]);
        b.pass(100ms);
    }
    for (std::size_t i = 0; i < answers.size(); ++i)
        EXPECT_EQ(answers[i], (i % 2 == 0 ? 0x00u : 0x80u) | 0x7Fu);
    EXPECT_EQ(b.read(0x606C), 5000);
    b.pass(3s);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "the life time of 300 ms is over";
    EXPECT_EQ(b.read(0x606C), 0);
}

TEST(Cia402TwinStandard, EventDrivenPdosAndRemoteFrames) {
    Bench b;
    ASSERT_EQ(b.write(0x1800, 1, 0x185, 4), Abort::none) << "bit 30 is 0: remote frames are answered";
    b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
    // A PDO of type 255 that contains the status word is sent when the word changes; a received one acts at once.
    b.out.clear();
    b.send(canopen::data_frame(0x205, std::array<std::uint8_t, 2>{6, 0}));
    ASSERT_EQ(b.count(0x185), 1u);
    EXPECT_EQ(b.out.frames[0].frame.data()[0] & 0x6Fu, 0x21u);
    b.out.clear();
    b.pass(5s);
    EXPECT_EQ(b.count(0x185), 0u) << "nothing has changed";
    Frame ask = canopen::data_frame(0x185, {});
    ask.remote = true;
    b.send(ask);
    EXPECT_EQ(b.count(0x185), 1u);
    // A measured value alone is no event; with a timer it is sent all the same.
    ASSERT_EQ(b.write(0x1801, 2, 255, 1), Abort::none);
    ASSERT_EQ(b.write(0x1801, 1, 0x285, 4), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.out.clear();
    b.pass(1s);
    EXPECT_EQ(b.count(0x285), 0u);
    ASSERT_EQ(b.write(0x1801, 1, 0x80000285, 4), Abort::none);
    ASSERT_EQ(b.write(0x1801, 5, 50, 2), Abort::none);
    ASSERT_EQ(b.write(0x1801, 1, 0x285, 4), Abort::none);
    b.out.clear();
    b.pass(1s);
    EXPECT_EQ(b.count(0x285), 20u);
}

TEST(Cia402TwinStandard, RelativeMovesCountFromTheLastTarget) {
    Bench b;
    b.enable(1);
    ASSERT_EQ(b.write(0x607A, 0, 10'000, 4), Abort::none);
    b.word(0x1F), b.word(0x0F);
    b.pass(300ms);
    ASSERT_EQ(b.write(0x607A, 0, 500, 4), Abort::none);
    b.word(0x7F), b.word(0x0F);
    b.pass(5s);
    EXPECT_EQ(b.read(0x6064), 10'500);
}

TEST(Cia402TwinStandard, TheLimitsOfSpeedAndAccelerationHold) {
    for (const std::uint16_t limit : {std::uint16_t{0x607F}, std::uint16_t{0x6080}}) {
        Bench b;
        ASSERT_EQ(b.write(limit, 0, 4000, 4), Abort::none);
        ASSERT_EQ(b.write(0x60C5, 0, 2000, 4), Abort::none);
        ASSERT_EQ(b.write(0x60C6, 0, 1000, 4), Abort::none);
        b.enable(3);
        ASSERT_EQ(b.write(0x60FF, 0, 9000, 4), Abort::none);
        b.pass(1s);
        EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 2000, 2) << "60C5h is below 6083h";
        b.pass(5s);
        EXPECT_EQ(b.read(0x606C), 4000) << std::hex << limit;
        ASSERT_EQ(b.write(0x60FF, 0, 0, 4), Abort::none);
        b.pass(1s);
        EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 3000, 2) << "60C6h is below 6084h";
    }
}

TEST(Cia402TwinStandard, TheVelocityWindowSaysReached) {
    Bench b;
    ASSERT_EQ(b.write(0x606D, 0, 1000, 2), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.pass(70ms);  // 50000/s2: 3500/s
    EXPECT_EQ(b.status() & 0x400u, 0u);
    b.pass(15ms);
    EXPECT_NE(b.status() & 0x400u, 0u) << "4250/s is in the window";
}

TEST(Cia402TwinStandard, TheTorqueIsLimited) {
    Bench b;
    ASSERT_EQ(b.write(0x6072, 0, 40, 2), Abort::none);
    b.enable(10);
    ASSERT_EQ(b.write(0x6071, 0, 100, 2), Abort::none);
    b.pass(1s);
    EXPECT_EQ(b.read(0x6077), 40);
    EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 2000, 1);
}

TEST(Cia402TwinStandard, HomingHasTwoSpeedsAndEndsWithItsStartBit) {
    Bench b(Bench::Options{{"travel", "20000"}});
    ASSERT_EQ(b.write(0x6099, 1, 8000, 4), Abort::none);
    ASSERT_EQ(b.write(0x6099, 2, 500, 4), Abort::none);
    b.enable(6);
    ASSERT_EQ(b.write(0x6098, 0, 1, 1), Abort::none);
    b.word(0x1F);
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), -8000) << "to the switch";
    b.pass(3s);
    EXPECT_EQ(b.read(0x606C), 500) << "back to the index";
    b.word(0x0F);
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), 0);
    EXPECT_EQ(b.status() & 0x3000u, 0u) << "neither attained nor failed";
    b.pass(60s);
    EXPECT_EQ(b.status() & 0x3000u, 0u);
}

TEST(Cia402TwinStandard, ALimitSwitchStopsTheWayIntoIt) {
    Bench b;
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.pass(1s);
    ASSERT_EQ(b.twin->set_hand("limit_positive", Value{true}, b.now, b.out), "");
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), 0);
    EXPECT_NE(b.status() & 0x800u, 0u);
    EXPECT_EQ(b.read(0x60FD) & 3, 2);
    ASSERT_EQ(b.write(0x60FF, 0, -5000, 4), Abort::none);
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), -5000) << "the way back is free";
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
