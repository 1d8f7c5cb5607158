// The model where an outsider with the manual in hand found it wanting: every start check, statuses while axes still move, switches at the
// ends of travel, profiles of limits, the largest following error, axis ON as a level.
// In: texts of commands, images, options, the hand. Out: what the control says.
// Never looks at the model's inside where a command tells it.
#include "adapters/pacontrol/tests/twin_bench.hpp"
#include "adapters/pacontrol/tests/twin_image_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

std::string put(int axis, int number, double value) { return "0800;" + std::to_string(axis << 8 | number) + ";1;" + std::to_string(value); }

TEST(TwinTruth, EveryStartCheckCanOccur) {  // [L4067, L4084-L4097]
    using Values = std::vector<std::pair<int, double>>;
    const std::pair<int, Values> rows[] = {
        {0x33, {{8, 10}, {9, 10}}},     {0x60, {{1, 100'000}, {7, 0.1}}},
        {0x61, {{1, 0.001}, {7, 100}}}, {0x62, {{2, 100'000}, {7, 0.1}}},
        {0x63, {{2, 0.001}, {7, 100}}}, {0x64, {{3, 100'000}, {7, 0.1}}},
        {0x65, {{3, 0.001}, {7, 100}}}, {0x66, {{4, 60}}},
        {0x67, {{4, 0.001}, {7, 100}}}, {0x68, {{5, 600}}},
        {0x69, {{5, 0.001}, {7, 100}}}, {0x6A, {{6, 1'000'000}, {7, 0.1}}},
        {0x6B, {{6, 0.001}}},           {0x6D, {{8, -1e7}, {9, 1e7}}},
    };
    for (const auto& [quit, values] : rows) {
        for (const char* start : {"0603;0;0;0", "0602;0;0;0"}) {
            Bench b;
            for (const auto& [number, value] : values)
                b.good(put(2, number, value));
            EXPECT_EQ(b.quit(start), quit) << std::hex << quit << " by " << start;
            EXPECT_EQ(b.status(), 1);
        }
    }
    Bench b;
    b.good(put(2, 5, 0));  // none: it ramps from rest
    b.good("0603;0;0;0");
}

TEST(TwinTruth, StopIsRecognisedWhileTheAxesOfAProgramStillMove) {  // 12, 17
    Bench b(setup(2, {{"programs", "START:20000:0:A1=400/A2=50/A1=0"}}));
    b.good(put(1, 6, 100));  // a ramp of seconds
    b.good(put(2, 6, 100));
    b.good("0602;0;0;0");
    b.pass(1500ms);  // at 112 AE, still rising
    EXPECT_EQ(b.status(), 11);
    EXPECT_EQ(b.value("1911;0;0;0"), 1) << "the program moves axis 1";
    EXPECT_EQ(b.get("0600;0;0;0").end, 0);
    EXPECT_EQ(b.status(), 12) << "until all axes stand";
    b.pass(10s);
    EXPECT_EQ(b.status(), 15);
    const double stopped = b.position(1);
    EXPECT_GT(stopped, 10);
    EXPECT_LT(stopped, 400);
    b.bytes(frame("0602;0;0;0"));
    b.pass(500ms);
    EXPECT_EQ(b.status(), 11);
    EXPECT_EQ(b.value("1911;0;0;0"), 1) << "it goes on from the stopped place";
    b.hand("inject_error", std::int64_t{501});
    EXPECT_EQ(b.status(), 17) << "malfunction recognised, the axis still brakes";
    b.pass(10s);
    EXPECT_EQ(b.status(), 19);
}

TEST(TwinTruth, AProgramDoesItsMovesInTurnAndEnds) {
    Bench b(setup(2, {{"programs", "START:6000:0:A1=40/A2=50"}}));
    b.good("0602;0;0;0");
    b.pass(1500ms);
    EXPECT_EQ(b.position(1), 40);
    EXPECT_EQ(b.position(2), 50);
    b.pass(6s);
    EXPECT_EQ(b.status(), 1);
    Bench not_referenced(setup(1, {{"programs", "START:6000:0:A1=40"}, {"absolute", "off"}}));
    not_referenced.bytes(frame("0602;0;0;0"));
    not_referenced.pass(1s);
    EXPECT_EQ(not_referenced.get("1909;0;0;0").data, 525) << "no reference point [L716]";
    EXPECT_EQ(not_referenced.status(), 19);
}

TEST(TwinTruth, TheLargestFollowingErrorIsTheOneThatOccurred) {  // 190F
    Bench b(setup(1));
    EXPECT_EQ(b.value("190F;1;1;0"), 0) << "not the limit of parameter 17";
    b.online();
    b.hand("following_error", 2000.0);  // 2 AE of 10 in a revolution
    EXPECT_NEAR(b.value("190F;1;1;0"), 640, 0.1);
    b.hand("following_error", -1000.0);
    EXPECT_NEAR(b.value("1915;1;1;0"), -320, 0.1);
    EXPECT_NEAR(b.value("190F;1;1;0"), 640, 0.1) << "the largest stays";
    b.hand("following_error", 0.0);
    b.hand("stall", true);
    b.good("0A94;1;1;100.0");
    b.pass(5s);
    EXPECT_EQ(b.axis_status(1), 4);
    EXPECT_NEAR(b.value("190F;1;1;0"), 3200, 10) << "the monitor's limit was reached: 10 AE";
    b.hand("power", false);
    b.hand("power", true);
    EXPECT_EQ(b.value("190F;1;1;0"), 0);
}

TEST(TwinTruth, OtherModelsHaveNoEncoderPosition) {
    Bench b(setup(1, {{"model", "other"}}));
    for (const char* q : {"190E;1;1;0", "190F;1;1;0", "1915;1;1;0", "1920;1;1;0"})
        EXPECT_EQ(b.quit(q), 0x15) << q;
}

TEST(TwinTruth, LimitsAreAProfile) {
    Bench b(setup(4, {{"limits", "AP1:1:2000,AP6:5:300:200,SP1:0:3,SP2:0:4:3,nonsense,AP99:1:2,AP2:9:1"}}));
    EXPECT_EQ(b.value("1801;257;1;0"), 2000);
    EXPECT_EQ(b.value("1802;257;1;0"), 1);
    EXPECT_EQ(b.value("1801;262;1;0"), 300);
    EXPECT_EQ(b.value("1800;262;1;0"), 200);
    EXPECT_EQ(b.quit("0800;262;1;301.0"), 0x29);
    EXPECT_EQ(b.value("1701;1;0;0"), 3);
    EXPECT_EQ(b.value("1701;2;0;0"), 4);
    EXPECT_EQ(b.value("1700;2;0;0"), 3);
    EXPECT_EQ(b.quit("190C;4;1;0"), 0x20) << "three axes by system parameter 2";
    EXPECT_EQ(b.value("1801;258;1;0"), 100'000) << "what is not named, or makes no sense, stays";
    b.online();
    EXPECT_EQ(b.quit("0A8D;1;1;2001.0"), 0x29) << "the speed override keeps the limits of the parameter [L3496]";
}

TEST(TwinTruth, TheNumberOfAxesIsAnOption) {
    Bench b(setup(1, {{"axes", "6"}}));
    EXPECT_EQ(b.quit("190C;6;1;0"), 0);
    EXPECT_EQ(b.quit("190C;7;1;0"), 0x20);
    EXPECT_EQ(b.value("1700;2;0;0"), 6);
    EXPECT_TRUE(b.twin().fit_axes(8, b.now));
    EXPECT_EQ(b.quit("190C;7;1;0"), 0x20) << "whatever the site uses";
}

TEST(TwinTruth, RotarySwitchesHoldTheProfibusAddress) {  // [L329-L348, L4072]
    Bench b(setup(1, {{"profibus_switches", "16"}}));
    EXPECT_EQ(b.value("1700;17;0;0"), 16);
    EXPECT_EQ(b.quit("0700;17;0;5"), 0x39);
    Bench wrong(setup(1, {{"profibus_switches", "1"}}));
    EXPECT_EQ(wrong.get("190B;0;0;0").error, 205) << "1 is the master's: cannot be realised";
    EXPECT_EQ(wrong.status(), 9);
    Bench none;
    EXPECT_EQ(none.value("1700;17;0;0"), 0);
    none.good("0700;17;0;5");
}

TEST(TwinTruth, SwitchesStandAtTheEndsOfTravel) {
    Bench b(setup(1, {{"travel", "-20:120"}}));
    b.online();
    b.good("0A94;1;1;500.0");
    b.pass(5s);
    EXPECT_EQ(b.get("1909;0;0;0").data, 529);
    EXPECT_NEAR(b.position(1), 120, 0.001);
    EXPECT_EQ(b.value("1921;1;0;0"), 0x01000104) << "positive switch actuated, by the place of the shaft";
    b.home();
    EXPECT_EQ(b.get("190B;0;0;0").error, 0);
    b.online();
    EXPECT_EQ(b.quit("0A94;1;1;130.0"), 0x40) << "not further onto it";
    b.good("0A94;1;1;100.0");
    b.pass(3s);
    EXPECT_EQ(b.value("1921;1;0;0"), 0x01010100) << "off it again";
    b.good("0A94;1;1;-100.0");
    b.pass(5s);
    EXPECT_EQ(b.get("1909;0;0;0").data, 530);
    EXPECT_NEAR(b.position(1), -20, 0.001);
    b.home();
    b.online();
    b.good("0AA2;1;0;0");
    b.good("0A94;1;1;-50.0");
    b.pass(3s);
    EXPECT_EQ(b.position(1), -50) << "monitoring is off";
}

TEST(TwinTruth, JoggingInWinpac) {
    for (const char* panel : {"manual", "winpac"}) {
        Bench b(setup(1));
        b.hand("panel", std::string(panel));
        b.hand("jog", std::int64_t{1});
        b.pass(1s);
        EXPECT_EQ(b.status(), std::string(panel) == "winpac" ? 20 : 3) << panel;
        EXPECT_GT(b.position(1), 5) << panel;
        b.hand("jog", std::int64_t{0});
        b.pass(1s);
        EXPECT_EQ(b.value("1911;0;0;0"), 0);
    }
}

TEST(TwinTruth, AxisCommandsAreBlockedByModulesButForTheConditionThatTheyNeed) {  // [L640, L820]
    Bench b(setup(1, {{"axis_modules", "on"}}));
    b.online();
    for (const char* q : {"0A83;1;0;0", "0A84;1;0;0", "0A94;1;1;5.0", "0A97;1;0;0", "0AA2;1;0;0", "0AA2;0;0;0"})
        EXPECT_EQ(b.quit(q), 0x14) << q;
    b.good("0AA3;1;0;16842757");
}

// --- the axis interface ------------------------------------------------------------------------------------------------------------

TEST(TwinTruth, AxisOnIsALevel) {  // [L727-L738]
    Rig r(with_modules(2), 2);
    r.axis(1, 0);
    r.axis(2, on);
    r.online();
    r.run(50ms);
    EXPECT_EQ(r.status(1) & 1u, 0u) << "a 0 that has stood there from the start disables";
    EXPECT_NE(r.status(1) & (1u << 4), 0u) << "IDLE";
    EXPECT_NE(r.status(2) & 1u, 0u);
    r.axis(1, start | absolute, 10.0F);
    r.run(50ms);
    EXPECT_NE(r.status(1) & cmd_error, 0u);
    EXPECT_EQ(r.get(Rig::module(1) + 4, 2), 0x37u) << "not switched on";
    r.axis(1, on);
    r.cycle();
    EXPECT_NE(r.status(1) & 1u, 0u);
    r.axis(1, on | start | absolute, 10.0F);
    r.cycle();
    r.wait_for_rest(1);
    EXPECT_NEAR(static_cast<double>(r.real(Rig::module(1) + 8)), 10, 0.001);
    r.axis(1, 0);
    r.run(100ms);
    EXPECT_EQ(r.status(1) & 1u, 0u);
}

TEST(TwinTruth, TheTraverseToTheEndOfTheRangeTakesTheParameterAsItStands) {  // bit 14 after G29 [L814]
    Rig r(with_modules(1), 1);
    r.control.axis(1).set_parameter(ap::area_max, 500);
    r.axis(1, on);
    r.online();
    r.axis(1, on | start | g29, 100.0F);  // limits are -9900..600 now
    r.run(50ms);
    r.axis(1, on);
    r.run(50ms);
    r.axis(1, on | start | 1u << 14, 0.0F);
    r.cycle();
    r.wait_for_rest(1);
    EXPECT_NEAR(static_cast<double>(r.real(Rig::module(1) + 8)), 500, 0.001) << "an absolute position, not the shifted limit";
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
