// Errors and gaps of the manual, one test each by number, for those that no other test names: how they are settled, seen from outside.
// Those of print alone (wrong cross references, lost pictures, words) have nothing to be seen.
#include "adapters/pacontrol/tests/twin_bench.hpp"
#include "adapters/pacontrol/tests/twin_image_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

TEST(TwinErrata, E02_E03_SohIsOneAndAllFieldsButTheCodeAreDecimal) {
    Bench b;
    b.good("0906;16;0;10");
    EXPECT_EQ(b.raw.back()[0], 1);
    EXPECT_EQ(b.raw.back()[1], 2);
    EXPECT_EQ(b.value("1906;0016;0;0"), 10) << "sixteen, not 22; leading zeros are read [L2309]";
    EXPECT_EQ(b.value("1906;22;0;0"), 0);
    EXPECT_EQ(b.quit("0A94;1;1;5"), 20) << "QUIT is decimal as well: 14h";
    EXPECT_EQ(b.quit("0A99;1;0;0"), 19);
}

TEST(TwinErrata, E06_RealsOfEverySizeHaveSevenDigits) {
    Bench b;
    const std::vector<std::pair<const char*, const char*>> rows{{"0", "0.000000"},         {"1", "1.000000"},    {"-12.5", "-12.50000"},
                                                                {"50000", "50000.00"},     {"0.5", "0.5000000"}, {"1234567", "1234567"},
                                                                {"99999.999", "100000.0"}, {"-640", "-640.0000"}};
    for (const auto& [asked, reported] : rows) {
        const std::string text = b.ask(std::string("0907;1;1;") + asked);
        const std::string got = text.substr(text.rfind(';') + 1);
        EXPECT_EQ(std::stod(got), std::stod(reported)) << asked << " -> " << got;
        if (std::string_view(asked) != "1234567" && std::string_view(asked) != "0.5") EXPECT_EQ(got, reported) << asked;
    }
}

TEST(TwinErrata, E07_E48_EightModulesAndOneHundredAndTwelveBytesAtMost) {
    for (std::size_t n = 0; n <= 16; ++n)
        EXPECT_EQ(with_modules(n).bytes(), 16 + 12 * std::min<std::size_t>(n, 8));
    EXPECT_EQ(ImageShape{}.bytes(), 8u);
}

TEST(TwinErrata, E08_TheWordOfTheSystemErrorCanBeChosen) {
    for (const std::size_t w : {1, 2, 3}) {
        ImageShape s = with_modules(0);
        s.error_word = w;
        Rig r(s);
        r.control.operation().raise(150, r.now);
        r.cycle();
        for (std::size_t k = 1; k <= 3; ++k)
            EXPECT_EQ(r.get(8 + 2 * k, 2), k == w ? 150u : 0u) << w << " " << k;
    }
}

TEST(TwinErrata, E10_E11_BitFourIsG26BitFiveIsG29AndBitEightIsReferenced) {
    Rig r(with_modules(1));
    r.control.axis(1).set_referenced(false);
    r.online();
    EXPECT_EQ(r.status(1) & referenced, 0u);
    r.axis(1, on | 1u << 5 | start, 10);
    r.cycle();
    EXPECT_EQ(r.real(r.module(1) + 8), 10.0F);
    EXPECT_EQ(r.status(1) & referenced, 0u) << "G29 leaves the reference as it is";
    r.axis(1, on);
    r.cycle();
    r.axis(1, on | 1u << 4 | start, 20);
    r.cycle();
    EXPECT_EQ(r.real(r.module(1) + 8), 20.0F);
    EXPECT_EQ(r.status(1) & referenced, referenced) << "G26 references";
}

TEST(TwinErrata, E15_StatusesAreDecimal) {
    Bench b;
    b.online();
    EXPECT_EQ(b.value("190B;0;0;0"), 31) << "31 decimal";
}

TEST(TwinErrata, E18_StartsActAtTheirEdgeStopAndCancelAsLevels) {
    Rig r(with_modules(0));
    r.ctrl(0x0017);
    r.run(100ms);
    ASSERT_EQ(r.get(5, 1), 31u);
    r.command(0x0A81, 0);
    r.run(500ms);
    EXPECT_EQ(r.get(5, 1), 1u) << "the start bit still stands";
    r.ctrl(0x0005);
    r.run(50ms);
    r.ctrl(0x0015);
    r.run(100ms);
    EXPECT_EQ(r.get(5, 1), 1u) << "no start while stop is demanded";
}

TEST(TwinErrata, E19_E21_StopIsForAutomaticAndOnlineAndAWrongModeIsFourteenHex) {
    Bench b;
    EXPECT_EQ(b.quit("0600;0;0;0"), 20) << "home position";
    b.online();
    EXPECT_EQ(b.quit("0600;0;0;0"), 0);
    b.home();
    b.good("0602;0;0;0");
    EXPECT_EQ(b.quit("0600;0;0;0"), 0);
    EXPECT_EQ(b.quit("0A94;1;1;5"), 20);
    b.good("0A41;0;0;0");
}

TEST(TwinErrata, E22_SettingAnAxisParameterEchoesIt) {
    Bench b;
    const Fields f = b.get("0800;774;1;1234.5");
    EXPECT_EQ(f.type, 1);
    EXPECT_EQ(f.data, 1234.5);
}

TEST(TwinErrata, E23_TheControlItselfTellsTheLimitsOfItsParameters) {
    Bench b;
    for (int n = 1; n <= 20; ++n) {
        const std::string p = std::to_string(n);
        EXPECT_LE(b.value("1702;" + p + ";0;0"), b.value("1701;" + p + ";0;0")) << n;
    }
    for (int n = 1; n <= 50; ++n) {
        const std::string p = std::to_string(256 + n);
        const double least = b.value("1802;" + p + ";1;0"), most = b.value("1801;" + p + ";1;0"), now = b.value("1800;" + p + ";1;0");
        EXPECT_LE(least, now) << n;
        EXPECT_LE(now, most) << n;
    }
}

TEST(TwinErrata, E25_E26_E27_E28_TheCommandsOfTheAxisThatTheOverviewMixesUp) {
    Bench b;
    EXPECT_EQ(b.get("190D;1;1;0").type, 1) << "speed";
    EXPECT_EQ(b.get("190E;1;1;0").type, 1) << "encoder";
    EXPECT_EQ(b.get("190F;1;1;0").type, 1) << "largest following error";
    EXPECT_EQ(b.get("1915;1;1;0").type, 1) << "following error in microsteps";
    b.hand("temperature", 40.03);
    EXPECT_NEAR(b.value("1920;1;1;0"), 40.03, 1e-3);
    Rig r;
    r.control.axis(1).outside().temperature = 40.03;
    r.command(0x1920, 1);
    EXPECT_EQ(r.get(0, 4), 0x42201EB8u);
}

TEST(TwinErrata, E29_E35_E62_SystemElements) {
    Bench b;
    EXPECT_EQ(b.value("1934;51;0;0"), 1) << "SM51: axis 1 is referenced";
    EXPECT_EQ(b.quit("1934;1;0;0"), 37);
    EXPECT_EQ(b.quit("1935;1;0;0"), 38);
    EXPECT_EQ(b.quit("1937;1;1;0"), 39);
    b.hand("axis2.inject_error", std::int64_t{529});
    EXPECT_EQ(b.value("1934;232;0;0"), 1) << "SM232: axis 2 is FAULT";
    EXPECT_EQ(b.value("1934;231;0;0"), 0);
    // FW22 is M337 to M352.
    Bench w;
    w.good("0904;352;0;1");
    EXPECT_EQ(w.value("1905;337;0;0"), 0x8000);
}

TEST(TwinErrata, E31_TheDatumOfAConditionIsConditionTypeNumber) {
    Bench b;
    b.online();
    b.good("0AA3;1;0;" + std::to_string(0x01020007));  // while output 7 = 1
    EXPECT_EQ(b.get("0A87;1;1;5").end, 1);
    EXPECT_EQ(b.position(1), 0);
    b.good("0902;7;0;1");
    b.good("0AA3;1;0;" + std::to_string(0x01020007));
    b.good("0A94;1;1;5");
    b.stand(1);
    EXPECT_EQ(b.position(1), 5);
}

TEST(TwinErrata, E36_E63_TheCodesOfTheAxisInterfaceAreCommandErrors) {
    Rig r(with_modules(1));
    r.online();
    const auto refused = [&](std::uint32_t bits) {
        r.axis(1, on | 1u << 16);
        r.cycle();
        r.axis(1, on | bits | start, 10);
        r.cycle();
        return std::pair(r.get(r.module(1) + 4, 2), r.get(r.module(1) + 6, 2));
    };
    EXPECT_EQ(refused(absolute | relative), (std::pair{0x14u, 0x14u}));
    EXPECT_EQ(refused(0), (std::pair{0x15u, 0u}));
    r.control.axis(1).set_referenced(false);
    EXPECT_EQ(refused(absolute), (std::pair{0x2Bu, 525u}));
    EXPECT_EQ(r.command(0x0A94, 1, real_bits(1)), 0x4014u) << "and axis commands of the CMD interface are blocked";
}

TEST(TwinErrata, E37_ProgramsAreDummiesThatEndByThemselves) {
    Bench b(setup(1, {{"programs", "START:200,BAD:100:510"}}));
    b.good("0602;0;0;0");
    b.pass(1s);
    EXPECT_EQ(b.status(), 1);
    b.hand("program", std::string("BAD"));
    b.good("0602;0;0;0");
    b.pass(1s);
    EXPECT_EQ(b.status(), 19);
    EXPECT_EQ(b.value("1909;0;0;0"), 510);
}

TEST(TwinErrata, E43_E50_ElementsAndParametersCountFromOne) {
    Bench b;
    b.good("0902;1;0;1");
    EXPECT_EQ(b.value("1902;1;0;0"), 1);
    for (const char* text :
         {"1900;0;0;0", "1902;0;0;0", "1904;0;0;0", "1906;0;0;0", "1907;0;1;0", "1700;0;0;0", "1800;256;1;0", "190C;0;1;0"})
        EXPECT_NE(b.quit(text), 0) << text;
}

TEST(TwinErrata, E46_E49_GatesThatTheManualGivesTwice) {
    Bench b;
    b.good("0909;0;0;0");
    b.online();
    EXPECT_EQ(b.quit("0909;0;0;0"), 20);
    EXPECT_EQ(b.quit("0AA0;1;0;0"), 0);
    b.good("0AA1;1;0;0");
    b.home();
    EXPECT_EQ(b.quit("0AA0;1;0;0"), 20) << "not in home position";
    b.good("0602;0;0;0");
    EXPECT_EQ(b.quit("0AA0;1;0;0"), 0) << "AUTOMATIC too";
}

TEST(TwinErrata, E52_E53_SixteenAxesInTheLowSixteenBits) {
    Bench b(setup(16));
    b.online();
    for (const int n : {1, 9, 16})
        b.good("0A94;" + std::to_string(n) + ";1;200");
    EXPECT_EQ(b.value("1911;0;0;0"), 0x8101);
    EXPECT_EQ(b.quit("0A94;17;1;200"), 32);
    Rig r;
    r.command(0x1911, 0);
    EXPECT_EQ(r.get(0, 2), 0u);
}

TEST(TwinErrata, E57_FeStandsAsLongAsAnErrorExists) {
    Rig r;
    EXPECT_EQ(r.get(4, 2) & 0x8000u, 0u);
    r.control.operation().raise(150, r.now);
    r.run(1s);
    EXPECT_EQ(r.get(4, 2) & 0x8000u, 0x8000u);
    r.command(0x0909, 0);
    EXPECT_EQ(r.get(4, 2) & 0x8000u, 0u);
}

TEST(TwinErrata, E60_TheUpperHalfOfSixteenBitDataIsIgnored) {
    Rig r;
    EXPECT_EQ(r.command(0x0905, 17, 0xABCD45F2u), 0x2000u);
    EXPECT_EQ(r.get(0, 4), 0x45F2u);
}

TEST(TwinErrata, E61_IntegersRoundHalfAwayFromZeroAndAreClamped) {
    Rig r(with_modules(1));
    r.ctrl(0x8007);
    const std::vector<std::pair<double, std::uint32_t>> rows{
        {12.345, 12345}, {-12.345, static_cast<std::uint32_t>(-12345)}, {25.045, 25045}, {9e6, 0x7FFFFFFF}};
    for (const auto& [x, n] : rows) {
        r.control.axis(1).set_position_g26(x, true);
        r.cycle();
        EXPECT_EQ(r.get(r.module(1) + 8, 4), n) << x;
    }
}

TEST(TwinErrata, E64_ARefusedCommandIsOver) {
    Bench b;
    const Fields f = b.get("0A87;1;1;5");
    EXPECT_EQ(f.quit, 20);
    EXPECT_EQ(f.end, 1);
}

TEST(TwinErrata, E66_AnEmergencyStopEndsInAMalfunctionStop) {
    Bench b;
    b.online();
    b.good("0A94;1;1;1000");
    b.pass(500ms);
    b.hand("emergency_stop", true);
    b.stand(1);
    EXPECT_LT(b.position(1), 1000);
    EXPECT_EQ(b.status(), 39);
    b.home();
    b.good("0602;0;0;0");
    b.hand("emergency_stop", true);
    b.pass(1s);
    EXPECT_EQ(b.status(), 19);
}

TEST(TwinErrata, E67_ASpeedOfZeroDuringAMoveIsIgnored) {
    Rig r(with_modules(1));
    r.online();
    r.axis(1, on | absolute | start, 50);
    r.run(20ms);
    r.axis(1, on | absolute | start, 50, 0);
    r.run(20ms);
    EXPECT_TRUE(r.control.axis(1).running());
    r.wait_for_rest(1);
    EXPECT_NEAR(static_cast<double>(r.real(r.module(1) + 8)), 50, 1e-3);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
