// The 28 traps of this control, one test each, by number: what goes easily wrong in a model or in a reader of the manual.
// In: frames of the serial port, words of the Profibus and Interbus images, the tester's hand. Out: what comes back.
// Never looks inside the control: every trap can be seen from outside, or it is none.
#include <fmt/core.h>

#include <cmath>

#include "adapters/pacontrol/tests/twin_bench.hpp"
#include "adapters/pacontrol/tests/twin_image_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

std::string tail(const Bytes& b, std::size_t n) {
    std::string s;
    for (std::size_t i = b.size() - n; i < b.size(); ++i)
        s += fmt::format("{:02X}", b[i]);
    return s;
}
/// With exactly this check, even none.
Bytes frame_of(std::string_view text, std::string_view check) {
    Bytes b = frame(text, "0");
    b.resize(b.size() - 2);
    b.insert(b.end(), check.begin(), check.end());
    b.push_back(4);
    return b;
}
std::string last_field(const std::string& text) { return text.substr(text.rfind(';') + 1); }
/// The different statuses that the polls of the next `d` tell, one poll a millisecond.
std::vector<int> statuses(Bench& b, Duration d) {
    std::vector<int> list;
    for (const Instant end = b.now + d; b.now < end; b.pass(1ms)) {
        const auto texts = b.bytes({4});  // none while the acknowledgement waits for a transition that is due at once
        if (texts.empty()) continue;
        const int s = Bench::fields(texts.back()).status;
        if (list.empty() || list.back() != s) list.push_back(s);
    }
    return list;
}
/// Time until the axis stands again.
Duration way(Bench& b, std::string_view text) {
    const Instant begun = b.now;
    EXPECT_EQ(b.get(text).end, 0) << text;
    for (int i = 0; i < 60'000; ++i) {
        b.pass(1ms);
        if (b.get_poll().end == 1) break;
    }
    return b.now - begun;
}

TEST(TwinTraps, T01_TheCheckOfAReplyHasTheEtxInItThatOfARequestNot) {
    Bench b;
    b.hand("I5", true);
    EXPECT_EQ(b.one(b.bytes(frame("1900;5;0;0", "6")), "check 6"), "0;1;1;0;0;1");
    EXPECT_EQ(tail(b.raw.back(), 4), "03353704");
    EXPECT_EQ(b.one(b.bytes(frame("1900;5;0;0", "5")), "check 5, with ETX"), "16;1;1;0;0;0") << "the reply's rule does not fit a request";
}

TEST(TwinTraps, T02_ZeroSwitchesTheCheckOffAndThereIsNoPaddingAndNoHex) {
    Bench b;
    EXPECT_EQ(Bench::fields(b.one(b.bytes(frame("1900;5;0;0", "0")), "0")).quit, 0);
    for (const char* bad : {"", "-0", "+0", "0x0", "0000", " 0"})
        EXPECT_EQ(Bench::fields(b.one(b.bytes(frame_of("1900;5;0;0", bad)), bad)).quit, 16) << bad;
    EXPECT_EQ(Bench::fields(b.one(b.bytes(frame("1906;7;0;0", "2")), "right")).quit, 0);
    EXPECT_EQ(b.ask("0906;1;0;2"), "0;1;1;0;0;2");
    EXPECT_EQ(tail(b.raw.back(), 4), "03353804") << "58";
    EXPECT_EQ(b.ask("0906;1;0;11"), "0;1;1;0;0;11");
    EXPECT_EQ(tail(b.raw.back(), 3), "033804") << "8, not 08 and not 008";
    // XOR of this text is 95 = 5Fh.
    const char* long_check = "0A87;2;1;5552.0";
    EXPECT_EQ(Bench::fields(b.one(b.bytes(frame(long_check, "5F")), "hex")).quit, 16);
    EXPECT_EQ(Bench::fields(b.one(b.bytes(frame(long_check, "95")), "decimal")).quit, 20) << "read; only not in home position";
}

TEST(TwinTraps, T03_ALoneEotIsAPollTheOneThatEndsAFrameIsNot) {
    Bench b;
    b.bytes(frame("1900;5;0;0"));
    EXPECT_EQ(b.raw.size(), 1u);
    b.bytes({4});
    EXPECT_EQ(b.raw.size(), 2u);
    b.bytes({4, 4, 4});
    EXPECT_EQ(b.raw.size(), 5u);
    Bytes both = frame("1906;1;0;0");
    both.push_back(4);
    b.bytes(both);
    EXPECT_EQ(b.raw.size(), 7u);
}

TEST(TwinTraps, T04_RealsHaveSevenSignificantDigits) {
    Bench b;
    EXPECT_EQ(last_field(b.ask("0907;1;1;640.0")), "640.0000");
    EXPECT_EQ(last_field(b.ask("0907;2;1;1255")), "1255.000");
    EXPECT_EQ(last_field(b.ask("0907;3;1;0")), "0.000000");
    b.online();
    b.good("0A86;1;1;1255");
    EXPECT_EQ(last_field(b.ask("190C;1;1;0")), "1255.000");
}

TEST(TwinTraps, T05_AWaitingMoveBeginsWithItsStartPositionAndEndsWithBe) {
    Bench b;
    b.online();
    b.good("0A86;1;1;50");
    const Fields first = b.get("0A87;1;1;300");
    EXPECT_EQ(first.end, 0);
    EXPECT_EQ(first.data, 50) << "neither the target nor nothing";
    double before = first.data;
    int polls = 0;
    for (;; ++polls) {
        b.pass(50ms);
        const Fields f = b.get_poll();
        EXPECT_GE(f.data, before);
        before = f.data;
        if (f.end == 1) break;
        ASSERT_LT(polls, 1000);
    }
    EXPECT_GT(polls, 3);
    EXPECT_EQ(before, 300);
}

TEST(TwinTraps, T06_OnlyPollsWhileAWaitingMoveRuns) {
    Bench b;
    b.online();
    EXPECT_EQ(b.get("0A87;1;1;1000").end, 0);
    EXPECT_EQ(b.quit("1900;1;0;0"), 20);
    EXPECT_EQ(b.quit("0906;9;0;4"), 20);
    EXPECT_EQ(b.get_poll().end, 0) << "the move goes on";
    for (int i = 0; i < 200 && b.get_poll().end == 0; ++i)
        b.pass(50ms);
    EXPECT_EQ(b.value("1906;9;0;0"), 0) << "it was not executed";
    b.good("0A94;1;1;0");
    EXPECT_EQ(b.quit("1900;1;0;0"), 0);
    EXPECT_EQ(b.axis_status(1), 1);
}

TEST(TwinTraps, T07_AManualMoveThatIsNotRenewedStands) {
    Bench b;
    b.online();
    b.good("0A90;1;1;1000");
    b.pass(900ms);
    EXPECT_EQ(b.axis_status(1), 1);
    b.pass(300ms);
    const int s = b.axis_status(1);
    EXPECT_TRUE(s == 0 || s == 2) << s;
    const double stands = b.position(1);
    EXPECT_LT(stands, 1000);
    b.pass(2s);
    EXPECT_EQ(b.position(1), stands);
}

TEST(TwinTraps, T08_OnlyTheChangeOfSfIsACommand) {
    Rig r;
    r.command(0x0906, 7, 11);
    r.put(0, 99, 4);
    r.run(50ms);
    r.put(6, 0x1906u | (r.sf ? 0x8000u : 0u), 2);
    r.run(50ms);
    EXPECT_EQ(r.get(0, 4), 11u) << "another code and other data, but no toggle: the old answer stands";
    EXPECT_EQ(r.command(0x1906, 7), 0x2000u);
    EXPECT_EQ(r.get(0, 4), 11u);
}

TEST(TwinTraps, T09_WordCommandsTakeAnElementNotTheNumberOfAWord) {
    Bench b;
    b.hand("inputs", std::int64_t{0x00038001});  // I1, I16; I17, I18
    EXPECT_EQ(b.value("1901;10;0;0"), 0x8001);
    EXPECT_EQ(b.value("1901;16;0;0"), 0x8001);
    EXPECT_EQ(b.value("1901;17;0;0"), 3);
}

TEST(TwinTraps, T10_WritingAWordReplacesAllSixteen) {
    Bench b;
    b.good("0905;17;0;17906");  // 45F2h
    EXPECT_EQ(b.value("1905;17;0;0"), 0x45F2);
    EXPECT_EQ(b.value("1904;18;0;0"), 1);
    b.good("0905;17;0;0");
    EXPECT_EQ(b.value("1905;17;0;0"), 0);
    EXPECT_EQ(b.value("1904;18;0;0"), 0);
}

TEST(TwinTraps, T11_StatusesAreDecimalNineStandsForAnErrorAndTransitionsAreSeen) {
    Bench b;
    b.hand("inject_error", std::int64_t{205});
    EXPECT_EQ(b.ask("190B;0;0;0"), "0;1;9;205;0;9");
    Bench modes(setup(1, {{"start_ms", "300"}, {"programs", "START:60000"}}));
    modes.bytes(frame("0603;0;0;0"));
    EXPECT_EQ(statuses(modes, 500ms), (std::vector<int>{30, 31}));
    modes.good("0A94;1;1;1000");
    modes.pass(500ms);
    modes.bytes(frame("0600;0;0;0"));
    EXPECT_EQ(statuses(modes, 3s), (std::vector<int>{32, 35}));
    modes.home();
    modes.bytes(frame("0602;0;0;0"));
    EXPECT_EQ(statuses(modes, 500ms), (std::vector<int>{10, 11}));
    // 12 lasts as long as axes brake; this model's programs move none, so 13 follows at once.
    modes.bytes(frame("0600;0;0;0"));
    EXPECT_EQ(statuses(modes, 3s), (std::vector<int>{13, 15}));
}

TEST(TwinTraps, T12_ErrorsAreResetInHomePositionAloneAndWhatStaysIsNamed) {
    Bench b;
    b.online();
    EXPECT_EQ(b.quit("0909;0;0;0"), 20);
    Bench lasting(setup(1, {{"lasting_errors", "301"}}));
    lasting.hand("inject_error", std::int64_t{301});
    const Fields f = lasting.get("0909;0;0;0");
    EXPECT_EQ(f.quit, 21);
    EXPECT_EQ(f.data, 301);
    EXPECT_EQ(f.status, 9);
    Bench other;
    other.hand("inject_error", std::int64_t{302});
    EXPECT_EQ(other.ask("0909;0;0;0"), "0;1;1;0;0;0");
}

TEST(TwinTraps, T13_AnAxisParameterIsOneDecimalNumberAndReal) {
    Bench b;
    const Fields f = b.get("1800;774;1;0");  // 0306h: axis 3, acceleration
    EXPECT_EQ(f.quit, 0);
    EXPECT_EQ(f.type, 1);
    b.good("0800;774;1;1234.5");
    EXPECT_EQ(b.value("1800;774;1;0"), 1234.5);
    EXPECT_EQ(b.value("1800;262;1;0"), f.data) << "axis 1 has its own";
    EXPECT_NE(b.value("1800;518;1;0"), 1234.5) << "and axis 2";
}

TEST(TwinTraps, T14_StopCancelAndErrorResetAreLowActive) {
    Rig r(with_modules(0));
    r.online();
    r.run(100ms);
    EXPECT_EQ(r.get(5, 1), 31u) << "0007h idles";
    r.ctrl(0x0005);
    r.run(100ms);
    EXPECT_EQ(r.get(5, 1), 35u) << "bit 1 low stops";
    r.ctrl(0x0000);
    r.run(100ms);
    EXPECT_EQ(r.get(5, 1), 1u) << "bit 2 low cancels";
}

TEST(TwinTraps, T15_TheIntegerBitIsLatchedAndNeverConcernsTheCmdInterface) {
    Rig r(with_modules(1));
    r.online();
    r.command(0x0A81, 0);
    r.run(50ms);
    r.ctrl(0x8007);
    r.cycle();
    EXPECT_EQ(r.get(8, 2) & 0x8000u, 0x8000u) << "in home position it follows";
    r.ctrl(0x8017);
    r.run(100ms);
    r.axis(1, on | g26 | start, 0);
    r.put(r.module(1) + 8, 25045, 4);
    r.cycle();
    EXPECT_EQ(r.get(r.module(1) + 8, 4), 25045u);
    r.ctrl(0x0007);
    r.run(50ms);
    EXPECT_EQ(r.get(8, 2) & 0x8000u, 0x8000u) << "no effect in ONLINE";
    EXPECT_EQ(r.get(r.module(1) + 8, 4), 25045u);
    r.command(0x190C, 1);
    EXPECT_EQ(r.get(0, 4), real_bits(25.045F));
}

TEST(TwinTraps, T16_G29TakesTheSoftwareLimitsAlongG26DoesNot) {
    Bench b;
    b.good("0800;265;1;500");
    b.online();
    b.good("0A86;1;1;100");  // G29 at 0
    EXPECT_EQ(b.quit("0A94;1;1;610"), 65);
    b.good("0A94;1;1;550");
    Bench c;
    c.good("0800;265;1;500");
    c.online();
    c.good("0A94;1;1;123");
    c.stand(1);
    c.good("0A85;1;0;0");  // G26 where it stands
    EXPECT_EQ(c.quit("0A94;1;1;510"), 65);
    EXPECT_EQ(c.quit("0A94;1;1;490"), 0);
}

TEST(TwinTraps, T17_LimitSwitchesAreOneWhenFree) {
    Bench b;
    EXPECT_EQ(b.value("1921;1;0;0"), 0x01010100);
    b.hand("limit_positive", true);
    EXPECT_EQ(static_cast<std::uint32_t>(b.value("1921;1;0;0")) & 0x00FFFF00u, 0x00000100u);
    b.hand("limit_positive", false);
    b.hand("limit_negative", true);
    EXPECT_EQ(static_cast<std::uint32_t>(b.value("1921;1;0;0")) & 0x00FFFF00u, 0x00010000u);
    Rig r(with_modules(1));
    EXPECT_EQ(r.status(1) & 0x600u, 0x600u) << "bits 9 and 10 of the axis interface too";
    r.control.axis(1).set_limit(true, true, r.now);
    r.cycle();
    EXPECT_EQ(r.status(1) & 0x600u, 0x200u);
}

TEST(TwinTraps, T18_AStartThatIsHeldMovesOnceAndKeepsActive) {
    Rig r(with_modules(1));
    r.online();
    r.axis(1, on | relative | start, 20);
    r.cycle();
    r.wait_for_rest(1);
    r.run(1s);
    EXPECT_NEAR(static_cast<double>(r.real(r.module(1) + 8)), 20, 1e-3) << "20 and not 40";
    EXPECT_EQ(r.status(1) & active, active);
    r.axis(1, on | relative, 20);
    r.cycle();
    EXPECT_EQ(r.status(1) & active, 0u);
}

TEST(TwinTraps, T19_AnAxisErrorStopsItsAxisAloneAndAxisCommandsAreBlocked) {
    Rig r(with_modules(2));
    r.online();
    EXPECT_EQ(r.command(0x0A87, 1, real_bits(5.0F)), 0x4014u);
    r.axis(1, on | absolute | start, 200);
    r.axis(2, on | absolute | start, 200);
    r.run(50ms);
    r.control.axis(1).set_limit(true, true, r.now);
    r.run(200ms);
    EXPECT_EQ(r.status(1) & axis_error, axis_error);
    EXPECT_EQ(r.get(r.module(1) + 6, 2), 529u);
    EXPECT_EQ(r.status(2) & axis_error, 0u);
    r.run(3s);
    EXPECT_NEAR(static_cast<double>(r.real(r.module(2) + 8)), 200, 1e-3);
    EXPECT_LT(r.real(r.module(1) + 8), 199);
}

TEST(TwinTraps, T20_OverridesAndTheMonitoringOfLimitsEndWithOnline) {
    Bench b;
    b.online();
    const Duration plain = way(b, "0A89;1;1;1000");
    b.good("0A8D;1;1;100");
    EXPECT_GT(way(b, "0A89;1;1;1000"), plain + 2s);
    b.good("0AA2;1;0;0");
    b.home();
    b.online();
    EXPECT_LE(way(b, "0A89;1;1;1000"), plain + 5ms);
    b.hand("limit_positive", true);
    EXPECT_EQ(b.quit("0A94;1;1;5000"), 64);
}

TEST(TwinTraps, T21_InAutomaticTheModulesOverwriteTheirFlags) {
    Rig r(with_modules(1));
    r.ctrl(0x000F);
    r.run(100ms);
    ASSERT_EQ(r.get(5, 1), 11u);
    EXPECT_EQ(r.command(0x0904, 3, 1), 0x2000u);
    r.cycle();
    r.command(0x1904, 3);
    EXPECT_EQ(r.get(0, 4), 0u) << "M3 is of the first module";
    EXPECT_EQ(r.command(0x0904, 200, 1), 0x2000u);
    r.cycle();
    r.command(0x1904, 200);
    EXPECT_EQ(r.get(0, 4), 1u) << "M200 is of none";
}

TEST(TwinTraps, T22_SpeedHasALimitAccelerationHasNone) {
    for (const auto bad : std::initializer_list<std::uint16_t>{0, 1001, 65535}) {
        Rig r(with_modules(1));
        r.online();
        r.axis(1, on | absolute | start, 20, bad);
        r.cycle();
        EXPECT_EQ(r.get(r.module(1) + 4, 2), 0x29u) << bad;
        r.run(500ms);
        EXPECT_EQ(r.real(r.module(1) + 8), 0.0F);
    }
    const auto ramp = [](std::uint16_t acceleration) {
        Rig r(with_modules(1));
        r.online();
        r.axis(1, on | absolute | start, 20, 1000, acceleration);
        int cycles = 0;
        for (; cycles < 60'000 && r.real(r.module(1) + 8) < 5; ++cycles)
            r.cycle(100us);
        return cycles;
    };
    EXPECT_NEAR(ramp(2000) / (ramp(1000) / std::sqrt(2.0)), 1.0, 0.02) << "5 AE from standstill: half the ramp, 1 / sqrt 2 of the time";
}

TEST(TwinTraps, T23_AConditionThatIsFalseAtTheStartEndsTheMoveWithoutError) {
    Bench b;
    b.online();
    b.good("0AA3;1;0;16842757");  // while input 5 = 1
    const Fields f = b.get("0A87;1;1;1000");
    EXPECT_EQ(f.quit, 0);
    EXPECT_EQ(f.end, 1);
    EXPECT_EQ(f.error, 0);
    b.pass(1s);
    EXPECT_EQ(b.position(1), 0);
    Rig r(with_modules(1));
    r.online();
    r.axis(1, on | absolute | 1u << 8 | start, 20);  // while input 1 = 1
    r.run(500ms);
    EXPECT_EQ(r.real(r.module(1) + 8), 0.0F);
    EXPECT_EQ(r.status(1) & 1u << 11, 1u << 11);
    EXPECT_EQ(r.status(1) & (cmd_error | axis_error), 0u);
}

TEST(TwinTraps, T24_CommandsThatTheOverviewLacksOrMisnumbersAreThere) {
    Bench b;
    b.online();
    for (const char* text : {"0A96;1;1;0", "0A97;1;0;0", "0A98;1;0;0", "0A97;1;0;0", "0A9A;1;1;0", "190E;1;1;0", "1934;51;0;0",
                             "1935;10;0;0", "1937;51;1;0", "190F;1;1;0"})
        EXPECT_NE(b.quit(text), 19) << text;
    EXPECT_EQ(b.quit("0A99;1;0;0"), 19) << "this one is in no list";
    EXPECT_EQ(b.quit("0934;51;0;0"), 19) << "the overview's number";
}

TEST(TwinTraps, T25_OnlineNeedsPowerOnTheExternalStop) {
    Bench b;
    b.hand("external_stop", false);
    EXPECT_EQ(b.quit("0603;0;0;0"), 44);
    EXPECT_EQ(b.status(), 1);
    b.hand("external_stop", true);
    b.online();
}

TEST(TwinTraps, T26_EndingAMeasuringModeThatIsNotIsNoError) {
    Bench b;
    b.online();
    b.good("0A86;1;1;7");
    b.good("0AA1;1;0;0");
    b.pass(500ms);
    EXPECT_EQ(b.axis_status(1), 0);
    EXPECT_EQ(b.position(1), 7);
}

TEST(TwinTraps, T27_ParametersBelongToHomePosition) {
    Bench b;
    const std::vector<const char*> all{"0700;3;0;1",     "1700;3;0;0",   "1701;3;0;0",   "1702;3;0;0",
                                       "0800;262;1;500", "1800;262;1;0", "1801;262;1;0", "1802;262;1;0"};
    for (const char* text : all)
        EXPECT_EQ(b.quit(text), 0) << text;
    b.online();
    for (const char* text : all)
        EXPECT_EQ(b.quit(text), 20) << text;
    b.home();
    b.hand("panel", std::string("manual"));
    for (const char* text : all)
        EXPECT_EQ(b.quit(text), 20) << text;
}

TEST(TwinTraps, T28_InterbusZerosStopOnceCommandsHaveComeAndNotBefore) {
    ImageShape s;
    s.interbus = true;
    Rig r(s);
    r.run(500ms);
    EXPECT_EQ(r.get(5, 1), 1u);
    EXPECT_EQ(r.get(4, 1) & 0x80u, 0u) << "zeros at start-up are none";
    r.command(0x0603, 0);
    r.run(100ms);
    r.command(0x0A94, 1, real_bits(400.0F));
    r.run(100ms);
    ASSERT_EQ(r.get(5, 1), 31u);
    r.in.assign(8, 0);
    r.run(2s);
    EXPECT_EQ(r.get(5, 1), 39u);
    r.sf = false;
    r.command(0x190C, 1);
    EXPECT_LT(std::bit_cast<float>(r.get(0, 4)), 400.0F);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
