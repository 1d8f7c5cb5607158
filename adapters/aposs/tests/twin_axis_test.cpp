// An axis of the simulated MACS on the bus: direct mode, ramps, units, homing, limits, errors, current, masters and markers. The expected
// values are those of the manual.
#include <tuple>

#include "adapters/aposs/tests/macs_bench.hpp"

namespace axisgate::aposs::test {
namespace {

TEST(ApossTwin, TheDirectModeDoesWhatTheManualPrintsAndRefusesTheRest) {
    Macs b;
    EXPECT_EQ(say(b, "SET TIMER 1 / 3"), "SET TIMER 1 / 3");
    EXPECT_EQ(b.get(14), 1);
    EXPECT_EQ(b.get(14, 1), 3);
    EXPECT_EQ(say(b, "SET REVERS x(2) 9602 // as printed"), "SET REVERS x(2) 9602 // as printed");
    EXPECT_EQ(b.get(63, 1), 9602);
    EXPECT_EQ(say(b, "GET REVERS x(2)"), "GET REVERS x(2): 9602");
    EXPECT_NE(say(b, "SET REVERS 3").find("refused"), std::string::npos);
    EXPECT_NE(say(b, "SET SYNCFACTM 0").find("refused"), std::string::npos);
    EXPECT_NE(say(b, "SET NOSUCH 1").find("no parameter"), std::string::npos);
    EXPECT_NE(say(b, "POSA 100").find("MOTOR ON"), std::string::npos);
    EXPECT_NE(say(b, "SYNCC").find("not supported"), std::string::npos);
    EXPECT_NE(say(b, "POSA x(3) 100").find("no axis"), std::string::npos);
    EXPECT_NE(say(b, std::string(300, 'A')).find("200 characters"), std::string::npos);
    EXPECT_NE(say(b, ""), "");
    for (const char* line : {"MOTOR ON", "VEL 100", "POSA 1000"})
        EXPECT_EQ(say(b, line), line);
    b.pass(2s);
    EXPECT_EQ(say(b, "APOS"), "APOS: 1000");
    EXPECT_EQ(say(b, "POSR -400"), "POSR -400");
    b.pass(2s);
    EXPECT_EQ(say(b, "CPOS"), "CPOS: 600");
    EXPECT_EQ(say(b, "CVEL 10"), "CVEL 10");
    b.pass(1s);
    EXPECT_EQ(b.position_of(0), 600) << "CVEL alone starts nothing";
    EXPECT_EQ(say(b, "CSTART"), "CSTART");
    b.pass(3s);
    EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 3333, 5) << "10 % of 1000 rpm";
    EXPECT_EQ(say(b, "MOTOR STOP"), "MOTOR STOP");
    b.pass(2s);
    EXPECT_EQ(b.read(0x606C), 0);
    EXPECT_EQ(say(b, "MOTOR OFF"), "MOTOR OFF");
    EXPECT_EQ(say(b, "SAVEPROM"), "SAVEPROM");
    EXPECT_EQ(seen(b, "eprom_writes"), 1);
    b.off_and_on();
    EXPECT_EQ(b.get(14, 1), 3);
}

TEST(ApossTwin, RampsHaveTheFormOfRamptypeAndAChangedJerkWaitsForTheNextMotion) {
    Macs b;
    ASSERT_EQ(b.set(1, 3000), Abort::none);
    ASSERT_EQ(b.set(31, 500), Abort::none);
    ASSERT_EQ(b.set(34, 100), Abort::none);  // DFLTACC
    ASSERT_EQ(b.set(33, 100), Abort::none);
    ASSERT_EQ(b.set(32, 2), Abort::none);
    EXPECT_EQ(b.read(0x6086), 0) << "JERKMIN 0: as a trapezoid (E-12)";
    ASSERT_EQ(b.set(98, 200), Abort::none);
    EXPECT_EQ(b.read(0x6086), 3);
    for (std::uint8_t k = 1; k <= 4; ++k)
        EXPECT_EQ(b.read(0x60A4, k), 1'000'000) << "0.001 qc/ms^3; 0 is that of JERKMIN";
    ASSERT_EQ(b.set(101, 100), Abort::none);
    EXPECT_EQ(b.read(0x60A4, 3), 2'000'000);
    EXPECT_EQ(b.read(0x60A4, 4), 1'000'000);
    b.enable_axis(0);
    b.go(0, 1'000'000);
    b.pass(100ms);
    const auto first = b.read(0x606B);
    EXPECT_NEAR(static_cast<double>(first), 5000, 10) << "jerk t^2 / 2";
    ASSERT_EQ(b.set(98, 10), Abort::none);
    b.pass(100ms);
    EXPECT_NEAR(static_cast<double>(b.read(0x606B)), 20'000, 20) << "the motion under way has the old one";
    ASSERT_EQ(b.set(32, 1), Abort::none);
    EXPECT_EQ(b.read(0x6086), 1);
}

TEST(ApossTwin, UserUnitsAndLimitsInQuadCounts) {
    Macs b;
    ASSERT_EQ(b.set(23, 8000), Abort::none);  // POSFACT_Z / POSFACT_N: 8 qc for one UU
    ASSERT_EQ(b.set(112, 2), Abort::none);    // FEEDDIST
    ASSERT_EQ(b.set(114, 3), Abort::none);    // POSENCQC: 8 * 3 / 2
    ASSERT_EQ(b.set(5, 12'000), Abort::none);
    ASSERT_EQ(b.set(20, 1), Abort::none);
    b.enable_axis(0);
    b.go(0, 1000);
    b.pass(3s);
    EXPECT_EQ(b.position_of(0), 1000);
    EXPECT_NEAR(b.twin->mechanics(1, b.now).position, 12'000, 0.01) << "1000 UU, which are 12000 qc, the limit itself";
    b.go(0, 1001);
    EXPECT_EQ(b.error(), 0x8612) << "beyond: the limit is in qc";
}

TEST(ApossTwin, ANegativeDirectionTurnsUserUnitsAndNoLimit) {
    Macs b;
    ASSERT_EQ(b.set(28, -1), Abort::none);
    ASSERT_EQ(b.set(28, 5), Abort::value) << "means nothing (E-09)";
    ASSERT_EQ(b.set(4, -5000), Abort::none);
    ASSERT_EQ(b.set(19, 1), Abort::none);
    b.enable_axis(0);
    b.go(0, 4000);
    b.pass(3s);
    EXPECT_EQ(b.position_of(0), 4000);
    EXPECT_NEAR(b.twin->mechanics(1, b.now).position, -4000, 0.01);
    b.go(0, 6000);
    EXPECT_EQ(b.error(), 0x8612) << "NEGLIMIT is in qc and stands where it stood";
}

TEST(ApossTwin, HomingTypesGoToTheirSwitchAndIndex) {
    struct Row {
        int type, velocity;
        double zero;  // the input is low below 5000 and from 5600 on; an index pulse every 2000
    };
    for (const Row& row : {Row{1, 10, 5000}, Row{0, 10, 4000}, Row{3, 10, 5600}, Row{2, 10, 6000}}) {
        SCOPED_TRACE(row.type);
        Macs b;
        ASSERT_EQ(b.set(45, 3), Abort::none);   // I_REFSWITCH: input 3
        ASSERT_EQ(b.set(41, 50), Abort::none);  // HOME_RAMP
        ASSERT_EQ(b.set(40, row.type), Abort::none);
        ASSERT_EQ(b.set(42, -150), Abort::none);
        ASSERT_EQ(b.set(3, 1), Abort::none);
        b.enable_axis(0, 6);
        ASSERT_EQ(b.write(0x6098, 0, -1, 1), Abort::none);
        ASSERT_EQ(b.write(0x6040, 0, 0x1F, 2), Abort::none);
        for (int i = 0; i < 9000; ++i) {
            b.pass(1ms);
            const double at = b.twin->mechanics(1, b.now).position;
            const bool on = at >= 5000 && at < 5600;
            if (on != (seen(b, "inputs") == 4)) b.hand("inputs", Value{std::int64_t{on ? 4 : 0}});
        }
        EXPECT_EQ(b.status_of(0) & 0x3000, 0x1000) << "attained";
        EXPECT_NEAR(b.twin->mechanics(1, b.now).position, row.zero - 150, 5) << "at HOME_OFFSET from the switch or index";
        EXPECT_NEAR(static_cast<double>(b.position_of(0)), 0, 1) << "and the zero is there";
        EXPECT_EQ(b.get(3), 255);
    }
}

TEST(ApossTwin, HomingWithoutASwitchOrWithoutAnIndexFails) {
    Macs b;
    b.enable_axis(0, 6);
    ASSERT_EQ(b.write(0x6098, 0, -1, 1), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0x1F, 2), Abort::none);
    EXPECT_EQ(b.status_of(0) & 0x3000, 0x2000) << "no reference switch (E-76)";
    ASSERT_EQ(b.write(0x6040, 0, 0x0F, 2), Abort::none);
    ASSERT_EQ(b.set(45, -1), Abort::none);  // input 1, active when it is low
    b.hand("index", Value{false});
    b.hand("inputs", Value{std::int64_t{1}});
    ASSERT_EQ(b.write(0x6040, 0, 0x1F, 2), Abort::none);
    b.pass(200ms);
    b.hand("inputs", Value{std::int64_t{0}});
    b.pass(500ms);
    b.hand("inputs", Value{std::int64_t{1}});
    b.pass(10s);
    EXPECT_EQ(b.error(), 0x7305) << "more than a turn without an index";
}

TEST(ApossTwin, APositionErrorIsCountedInRoundsOfTheAxes) {  // 2 axes, 300 ms: more than 7 times [L6003-6032] (E-35)
    for (const auto& [time, low, high] : {std::tuple{0, 0, 40}, {300, 7 * 40, 8 * 40}, {79, 40, 80}}) {
        SCOPED_TRACE(time);
        Macs b;
        ASSERT_EQ(b.set(111, time), Abort::none);
        ASSERT_EQ(b.set(15, 100), Abort::none);
        b.enable_axis(0);
        b.hand("stall", Value{true});
        ASSERT_EQ(b.write(0x607A, 0, 100'000, 4), Abort::none);
        ASSERT_EQ(b.write(0x6040, 0, 0x3F, 2), Abort::none);
        int ms = 0, behind = -1;
        while (b.error() == 0 && ms < 5000) {
            b.pass(1ms);
            ++ms;
            if (behind < 0 && b.read(0x60F4) > 100) behind = ms;
        }
        EXPECT_GE(ms - behind, low - 1);
        EXPECT_LE(ms - behind, high + 1);
    }
}

TEST(ApossTwin, AfterALimitErrorTheOtherDirectionIsFreeAndTheSameOneIsError98) {
    Macs b;
    ASSERT_EQ(b.set(5, 5000), Abort::none);
    ASSERT_EQ(b.set(20, 1), Abort::none);
    b.enable_axis(0, 3);
    ASSERT_EQ(b.write(0x60FF, 0, 8000, 4), Abort::none);
    b.pass(3s);
    EXPECT_EQ(b.error(), 0x8612);
    const auto beyond = b.position_of(0);
    EXPECT_GT(beyond, 5000) << "in speed mode the error comes when it is already outside";
    ASSERT_EQ(b.write(0x60FF, 0, 0, 4), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0x80, 2), Abort::none);
    b.enable_axis(0, 3);
    ASSERT_EQ(b.write(0x60FF, 0, 500, 4), Abort::none);
    EXPECT_EQ(b.error(), 0xFF62) << "98";
    ASSERT_EQ(b.write(0x60FF, 0, 0, 4), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0, 2), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0x80, 2), Abort::none);
    b.enable_axis(0, 3);
    ASSERT_EQ(b.write(0x60FF, 0, -3000, 4), Abort::none);
    b.pass(3s);
    EXPECT_EQ(b.error(), 0);
    EXPECT_LT(b.position_of(0), 5000);
    // Inside the limits again: the next error is a limit error, too.
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.pass(6s);
    EXPECT_EQ(b.error(), 0x8612);
}

TEST(ApossTwin, ALimitSwitchCallsTheErrorOrStops) {  // ENDSWMOD [L3716]
    for (const int mode : {0, 1}) {
        SCOPED_TRACE(mode);
        Macs b;
        ASSERT_EQ(b.set(44, mode), Abort::none);
        ASSERT_EQ(b.set(46, 2), Abort::none);  // I_POSLIMITSW
        b.enable_axis(0);
        b.go(0, 100'000);
        b.pass(500ms);
        b.hand("inputs", Value{std::int64_t{2}});
        b.pass(3s);
        EXPECT_EQ(b.error(), mode == 0 ? 0x8612 : 0);
        EXPECT_EQ(b.status_of(0) & 0x6F, mode == 0 ? 0x08 : 0x27);
        EXPECT_EQ(b.read(0x606C), 0);
        const auto here = b.position_of(0);
        if (mode == 0) {
            ASSERT_EQ(b.write(0x6040, 0, 0x80, 2), Abort::none);
            b.enable_axis(0);
            b.go(0, here + 1000);
            EXPECT_EQ(b.error(), 0xFF62) << "98";
            ASSERT_EQ(b.write(0x6040, 0, 0x80, 2), Abort::none);
            b.enable_axis(0);
        }
        b.go(0, here - 1000);
        b.pass(3s);
        EXPECT_EQ(b.position_of(0), here - 1000) << "the other way is free";
    }
}

TEST(ApossTwin, EachErrorConditionHasItsWay) {  // ERRCOND [L3664-3714], O_BRAKE, O_ERROR, O_AXMOVE
    for (int condition = 0; condition <= 5; ++condition) {
        SCOPED_TRACE(condition);
        Macs b;
        ASSERT_EQ(b.set(43, condition), Abort::none);
        ASSERT_EQ(b.set(48, 1), Abort::none);                // O_BRAKE: output 1
        ASSERT_EQ(b.set(64, -2), Abort::none);               // O_AXMOVE: output 2, low
        ASSERT_EQ(b.write(0x2200, 109, 3, 4), Abort::none);  // O_ERROR: output 3
        b.enable_axis(0);
        EXPECT_EQ(seen(b, "outputs"), 2) << "nothing moves: low is active";
        b.go(0, 1'000'000);
        b.pass(1s);
        EXPECT_EQ(seen(b, "outputs"), 0);
        b.hand("inject_error", Value{std::int64_t{89}});
        const bool reported = b.reported(0xFF59);
        const auto at_once = seen(b, "outputs");
        EXPECT_TRUE(reported);
        if (condition == 5) {
            EXPECT_EQ(b.status_of(0) & 0x6F, 0x27) << "the error routine decides";
            continue;
        }
        EXPECT_EQ(at_once & 1, condition == 1 ? 1 : 0) << "brake at once";
        EXPECT_EQ(at_once & 4, 4);
        const auto from = b.position_of(0);
        b.pass(5s);
        const auto way = b.position_of(0) - from;
        if (condition <= 1) EXPECT_LT(way, 2000) << "coast: friction alone in this model";
        if (condition == 2 || condition == 3) EXPECT_GT(way, 1000) << "by a ramp";
        EXPECT_EQ(seen(b, "outputs") & 1, condition == 1 || condition == 3 ? 1 : 0) << "with 3 when it stands";
        EXPECT_EQ(b.twin->mechanics(1, b.now).powered, condition == 2 || condition == 3) << "and stays under control";
        b.hand("inject_error", Value{std::int64_t{0}});
        EXPECT_EQ(say(b, "ERRCLR"), "ERRCLR");
        EXPECT_EQ(seen(b, "outputs") & 5, condition == 1 || condition == 3 ? 1 : 0) << "the brake is not released by ERRCLR";
        EXPECT_EQ(say(b, "OUT 1 0"), "OUT 1 0");
        EXPECT_EQ(seen(b, "outputs") & 1, 0);
    }
}

TEST(ApossTwin, GuardingIsLostUntilItIsSwitchedOff) {  // error 88 [L1569-1581]
    Macs b;
    b.enable_axis(0);
    b.hand("bus_silent", Value{true});
    b.pass(5s);
    EXPECT_EQ(b.error(), 0) << "nothing is guarded";
    ASSERT_EQ(b.set(0, 10), Abort::none);  // DRIVETYPE: Danfoss, guarded
    b.pass(2s);
    EXPECT_EQ(b.error(), 0xFF58);
    EXPECT_EQ(say(b, "ERRCLR"), "ERRCLR");
    b.pass(1s);
    EXPECT_EQ(b.error(), 0xFF58) << "ERRCLR alone lets it return";
    ASSERT_EQ(b.set(0, -10), Abort::none);
    EXPECT_EQ(say(b, "ERRCLR"), "ERRCLR");
    b.pass(5s);
    EXPECT_EQ(b.error(), 0);
}

TEST(ApossTwin, TooMuchCurrentIsError99UntilItHasFallen) {  // [L6169-6240] (E-64)
    Macs b;
    ASSERT_EQ(b.set(94, 2500), Abort::none);
    ASSERT_EQ(b.set(118, 5000), Abort::none);
    b.enable_axis(0);
    b.hand("load", Value{1.0});
    b.pass(5s);
    EXPECT_EQ(b.error(), 0) << "without I2TFTIME it is not watched";
    ASSERT_EQ(b.set(117, 1000), Abort::none);
    b.pass(1s);
    EXPECT_NEAR(static_cast<double>(b.read(0x2700, 27)), 6250 * 0.632, 30);
    for (int ms = 0; ms < 2000 && b.error() == 0; ++ms)
        b.pass(1ms);
    EXPECT_EQ(b.error(), 0xFF63);
    ASSERT_EQ(b.write(0x6040, 0, 0x80, 2), Abort::none);
    EXPECT_EQ(b.error(), 0xFF63) << "too hot to be cleared";
    b.pass(2s);
    ASSERT_EQ(b.write(0x6040, 0, 0, 2), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0x80, 2), Abort::none);
    EXPECT_EQ(b.error(), 0);
}

TEST(ApossTwin, AStifferLoopLagsLess) {  // plausible, not measured (E-17): orders alone
    double lag[4] = {};
    const std::tuple<int, int, int> rows[] = {{30, 0, 0}, {60, 0, 0}, {30, 1000, 0}, {30, 0, 9}};
    for (std::size_t i = 0; i < 4; ++i) {
        const auto [gain, forward, simulated] = rows[i];
        Macs b;
        ASSERT_EQ(b.set(11, gain), Abort::none);
        ASSERT_EQ(b.set(36, forward), Abort::none);
        ASSERT_EQ(b.set(27, simulated), Abort::none);
        b.enable_axis(0);
        b.go(0, 100'000);
        b.pass(3s);
        lag[i] = static_cast<double>(b.read(0x60F4));
        if (i == 0) EXPECT_NEAR(static_cast<double>(b.read(0x2500, 29)), 200, 15) << "REG_NORMTRACKERR: percent of the way of 1 ms";
    }
    EXPECT_GT(lag[0], 0);
    EXPECT_NEAR(lag[1], lag[0] / 2, 1);
    EXPECT_EQ(lag[2], 0) << "feed-forward";
    EXPECT_EQ(lag[3], 0) << "ENCODERTYPE 9: the command position is copied";
    Macs soft;
    ASSERT_EQ(soft.set(11, 1), Abort::none);
    ASSERT_EQ(soft.set(33, 100), Abort::none);
    soft.enable_axis(0);
    soft.go(0, 1'000'000);
    soft.pass(5s);
    EXPECT_EQ(soft.error(), 0x8611) << "so soft that POSERR is exceeded";
}

TEST(ApossTwin, MastersOfThreeKindsLeadTheSecondAxis) {
    Macs b;
    b.enable_axis(0);
    b.enable_axis(1);
    ASSERT_EQ(b.set(31, 10, 1), Abort::none);  // RAMPMIN: it can follow at once
    ASSERT_EQ(b.set(34, 100, 1), Abort::none);
    ASSERT_EQ(b.set(67, 6, 1), Abort::none);  // MENCODERTYPE: simulation
    EXPECT_EQ(say(b, "SYNCP x(2)"), "SYNCP x(2)");
    EXPECT_EQ(say(b, "SYSVAR[4105] x(2) = 5"), "SYSVAR[4105] x(2) = 5");
    b.pass(200ms);
    EXPECT_NEAR(static_cast<double>(b.position_of(1)), 1000, 30);
    EXPECT_EQ(say(b, "SYSVAR[4105] x(2) = 0"), "SYSVAR[4105] x(2) = 0");
    b.pass(1s);
    const auto first = b.position_of(1);
    EXPECT_NEAR(static_cast<double>(first), 1000, 2);
    ASSERT_EQ(b.set(108, 1, 1), Abort::none);  // MENCCONTROL: soft change
    ASSERT_EQ(b.set(67, 0, 1), Abort::none);   // another source goes on from there
    b.pass(1s);
    EXPECT_EQ(b.position_of(1), first);
    b.hand("axis2.encoder", Value{std::int64_t{300}});
    b.pass(1s);
    EXPECT_EQ(b.position_of(1), first + 300) << "the master's encoder turned by hand";
    for (const char* line : {"PULSACC 1000", "PULSVEL 1000"})
        EXPECT_EQ(say(b, line), line);
    b.pass(2s);
    EXPECT_NEAR(static_cast<double>(b.position_of(1) - first - 300), 1500, 20) << "the virtual master";
    ASSERT_EQ(b.write(0x2200, 117, 100, 4), Abort::none);  // VMENCTYP: from axis 1, in force from the next PULSVEL on
    b.pass(1s);
    EXPECT_NEAR(static_cast<double>(b.position_of(1) - first - 300), 2500, 20);
    EXPECT_EQ(say(b, "PULSVEL 0"), "PULSVEL 0");
    b.pass(3s);
    const auto stands = b.position_of(1);
    b.pass(1s);
    EXPECT_EQ(b.position_of(1), stands) << "axis 1 stands";
    EXPECT_EQ(b.position_of(0), 0);
}

TEST(ApossTwin, MarkersOfInputsReachTheSynchronisation) {
    Macs b;
    b.enable_axis(0);
    b.enable_axis(1);
    ASSERT_EQ(b.set(60, 42, 1), Abort::none);  // SYNCMTYPM: input 4, rising
    ASSERT_EQ(b.set(61, 52, 1), Abort::none);  // SYNCMTYPS: input 5, rising
    ASSERT_EQ(b.set(62, 6, 1), Abort::none);
    ASSERT_EQ(b.set(58, 30'000, 1), Abort::none);
    ASSERT_EQ(b.set(59, 30'000, 1), Abort::none);
    b.hand("gear", Value{std::string("marker")});
    b.go(0, 20'000);
    b.pass(300ms);
    const auto master = b.position_of(0);
    b.hand("inputs", Value{std::int64_t{8}});
    b.pass(100ms);
    const auto slave = b.position_of(1);
    b.hand("inputs", Value{std::int64_t{24}});
    b.pass(5s);
    EXPECT_NEAR(static_cast<double>(b.position_of(1) - b.position_of(0)), static_cast<double>(slave - master), 80)
        << "the way between the two markers";
    EXPECT_GT(b.position_of(1), 20'100);
    EXPECT_NE(say(b, "SYNCSTAT x(2)"), "SYNCSTAT x(2): none");
}

TEST(ApossTwin, ASoftwareLimitStopsTheSlaveOfAGear) {
    Macs b;
    ASSERT_EQ(b.set(5, 5000, 1), Abort::none);
    ASSERT_EQ(b.set(20, 1, 1), Abort::none);
    b.enable_axis(0);
    b.enable_axis(1);
    b.hand("gear", Value{std::string("position")});
    b.go(0, 20'000);
    b.pass(5s);
    EXPECT_EQ(b.read(0x683F) & 0xFFFF, 0x8612) << "after it was passed";
    EXPECT_GT(b.position_of(1), 5000);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x27) << "the master goes on";
    EXPECT_EQ(b.position_of(0), 20'000);
}

TEST(ApossTwin, DeforiginMovesTheLimitsThatAreInRam) {  // [L1926] (E-63)
    Macs b;
    b.enable_axis(0);
    b.go(0, 1000);
    b.pass(2s);
    EXPECT_EQ(say(b, "DEFORIGIN"), "DEFORIGIN");
    EXPECT_EQ(b.position_of(0), 0);
    EXPECT_EQ(b.get(5), 499'000);
    EXPECT_EQ(b.get(4), -501'000);
    EXPECT_EQ(say(b, "MAPOS x(2)"), "MAPOS x(2): 1000") << "the other axis' master is not at zero for that";
    b.off_and_on();
    EXPECT_EQ(b.get(5), 500'000) << "the EPROM has them as they were";
    ASSERT_EQ(b.set(27, 1), Abort::none);
    EXPECT_NE(say(b, "DEFORIGIN").find("absolute"), std::string::npos);
}

TEST(ApossTwin, EscEndsTheProgramAsItsConditionSays) {  // ESCCOND [L5111-5150]
    for (int condition = 0; condition <= 2; ++condition) {
        SCOPED_TRACE(condition);
        Macs b;
        b.hand("program", Value{true});
        ASSERT_EQ(b.write(0x2200, 106, 6, 4), Abort::none);  // I_BREAK: input 6
        ASSERT_EQ(b.set(70, condition), Abort::none);
        ASSERT_EQ(b.set(48, -1), Abort::none);  // O_BRAKE: low
        EXPECT_EQ(say(b, "OUT 1 1"), "OUT 1 1");
        EXPECT_EQ(say(b, "OUT 3 1"), "OUT 3 1");
        b.enable_axis(0);
        b.go(0, 100'000);
        b.pass(1s);
        b.hand("inputs", Value{std::int64_t{32}});
        EXPECT_EQ(seen(b, "program"), 0);
        EXPECT_EQ(seen(b, "outputs"), condition == 0 ? 4 : condition == 1 ? 0 : 0xFE) << "the brake in each case";
        b.pass(3s);
        EXPECT_EQ(b.read(0x606C), 0);
        EXPECT_LT(b.position_of(0), 90'000);
    }
}

TEST(ApossTwin, WithoutReverseNoWayBack) {  // REVERS 2 (E-59)
    Macs b;
    ASSERT_EQ(b.set(63, 2), Abort::none);
    b.enable_axis(0);
    b.go(0, 1000);
    b.pass(2s);
    b.go(0, 500);
    b.pass(2s);
    EXPECT_EQ(b.position_of(0), 1000);
    EXPECT_EQ(b.error(), 0) << "it ends where it began";
    ASSERT_EQ(b.write(0x6060, 0, 3, 1), Abort::none);
    ASSERT_EQ(b.write(0x60FF, 0, -500, 4), Abort::none);
    b.pass(1s);
    EXPECT_EQ(b.position_of(0), 1000);
}

}  // namespace
}  // namespace axisgate::aposs::test
