// The twin: all 216 motion commands, the special cases of the manual, profiles in closed form, the command table, curves, streams.
#include <cmath>

#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {
constexpr std::int64_t v1 = 100'000, a1 = 1'000'000;  // 0.1 m/s, 10 m/s2

// --- motion commands --------------------------------------------------------------------------------------------------------
/// Valid values for each argument.
std::vector<std::int64_t> harmless(const CatalogueCommand& c) {
    std::vector<std::int64_t> v;
    for (const auto& a : c.arguments) {
        std::int64_t n = 1;
        if (a.name == "position" || a.name == "increment" || a.name == "event_position") n = a.type == ValueType::i16 ? 3000 : 30'000;
        if (a.name == "velocity") n = a.type == ValueType::u16 ? 50'000 : v1;
        if (a.name == "acceleration" || a.name == "deceleration") n = a.type == ValueType::u16 ? 60'000 : a1;
        if (a.name == "upid") n = 0x14BE;
        if (a.name == "control_word") n = 0x3F;
        if (a.name == "current_limit") n = 2000;
        if (a.name.starts_with("force") || a.name == "target_force") n = 500;
        if (a.name == "curve_time") n = 10'000;
        if (a.name == "time_scale") n = 10'000;
        if (a.name == "amplitude_scale") n = 1000;
        v.push_back(n);
    }
    return v;
}

TEST(LinmotTwin, EveryCommandOfTheCatalogueIsExecuted) {
    std::size_t executed = 0;
    for (const auto& c : page().commands()) {
        if (c.id.size() != 5 || !c.id.ends_with("xh")) continue;
        const auto header = static_cast<std::uint16_t>(std::stoul(c.id.substr(0, 3), nullptr, 16) << 4);
        EXPECT_TRUE(twin::Drive::listed(header)) << c.id;
        Bench b;
        b.enable();
        b.drive().table[1] = {};
        b.drive().table[1][4] = 0;  // No Operation
        auto& curve = b.drive().curves[1];
        curve.info.resize(70);
        curve.info[32] = 0x10;
        curve.info[33] = 0x27;
        for (int i = 0; i < 5; ++i)
            Bench::put(curve.data, i * 10'000, 4);
        if (c.id == "100xh" || c.id == "102xh") b.motion("110xh", {1, 0});
        const auto before = b.drive().commands_done();
        b.motion(c.id, harmless(c));
        EXPECT_GT(b.drive().commands_done(), before) << c.id << " " << c.name;
        EXPECT_EQ(b.state(), 8) << c.id << " " << c.name << " error " << b.drive().error_code();
        EXPECT_EQ(b.sub() & 15, b.count) << c.id << ": the count comes back";
        ++executed;
    }
    EXPECT_EQ(executed, 216u);
}

TEST(LinmotTwin, HeadersThatAreInNoListAreUnknown) {
    std::size_t listed = 0;
    for (int master = 0; master < 256; ++master) {
        for (int s = 0; s < 16; ++s)
            listed += twin::Drive::listed(static_cast<std::uint16_t>(master << 8 | s << 4));
    }
    EXPECT_EQ(listed, 216u);
    Bench b;
    b.enable();
    (void)b.tell({0, 2, 0x51, 0x00});
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x0481);
}

TEST(LinmotTwin, TheCountAloneDecides) {
    Bench b;
    b.enable();
    b.motion("010xh", {30'000, v1, a1, a1});
    b.run(1s);
    EXPECT_EQ(b.position(), 30'000);
    b.count = static_cast<std::uint8_t>(b.count - 1);
    b.motion("011xh", {30'000, v1, a1, a1});  // another command, the same count
    b.run(1s);
    EXPECT_EQ(b.position(), 30'000) << "not executed";
    b.motion("011xh", {30'000, v1, a1, a1});
    b.run(1s);
    EXPECT_EQ(b.position(), 60'000);
}

TEST(LinmotTwin, OutsideOperationEnabledACommandIsAnError) {
    Bench b;
    b.control(0x3E);
    b.control(0x37);
    b.run(400ms);
    ASSERT_EQ(b.state(), 6);
    b.motion("000xh");
    EXPECT_EQ(b.state(), 6);
    b.motion("010xh", {30'000, v1, a1, a1});
    EXPECT_EQ(b.drive().state_var(), 0x0486);
    b.motion("050xh", {1, 0});
    EXPECT_EQ(b.drive().state_var(), 0x0486) << "the first code stays";
}

TEST(LinmotTwin, DemandTargetAndActualGiveThreeTargets) {
    const auto ends = [](const char* id) {
        Bench b;
        b.enable();
        (void)b.hand("lag_ms", Value{10.0});
        b.motion("010xh", {5'000'000, 1'000'000, a1, a1});
        b.run(200ms);  // 50 mm in the ramp of 100 ms, then 100 mm at 1 m/s
        b.motion(id, {100'000, 1'000'000, a1, a1});
        b.run(5s);
        return b.position();
    };
    EXPECT_NEAR(ends("012xh"), 5'000'000 + 100'000, 1) << "the former target";
    EXPECT_NEAR(ends("011xh"), 1'500'000 + 100'000, 1) << "the demand position";
    EXPECT_NEAR(ends("015xh"), 1'400'000 + 100'000, 1) << "the actual position, 10 ms behind at 1 m/s";
}

TEST(LinmotTwin, TransitionsAreJudgedOnTheDemandAndInTheirDirection) {
    Bench b;
    b.enable();
    b.motion("01Exh", {50'000, 20'000, a1, a1});
    EXPECT_NE(b.sub() & 0x10, 0) << "armed";
    b.motion("010xh", {100'000, v1, a1, a1});
    b.run(150ms);
    EXPECT_LT(b.position(), 80'000) << "slower since it passed 5 mm upwards";
    EXPECT_NEAR(b.drive().mechanics().velocity, 200'000, 1);
    b.run(5s);
    EXPECT_EQ(b.position(), 100'000) << "the target is unchanged";
    b.motion("010xh", {0, v1, a1, a1});
    b.run(1100ms);
    EXPECT_EQ(b.position(), 0) << "downwards it is no event";
    EXPECT_NE(b.sub() & 0x10, 0) << "and it stays armed";
    b.motion("008xh");
    EXPECT_EQ(b.sub() & 0x10, 0);
    EXPECT_EQ(b.drive().status_word() & 0x100, 0);
}

TEST(LinmotTwin, AnEventStartsAgainAtEachEdge) {
    Bench b;
    b.enable();
    b.motion("01Bxh", {10'000, v1, a1, a1});
    for (int i = 1; i <= 3; ++i) {
        (void)b.hand("trigger", Value{true});
        b.run(500ms);
        EXPECT_EQ(b.position(), 10'000 * i);
        (void)b.hand("trigger", Value{false});
    }
    b.motion("000xh");
    EXPECT_NE(b.sub() & 0x10, 0) << "an armed event survives other commands";
}

TEST(LinmotTwin, TriggerModesInhibitAndDelay) {
    Bench b;
    b.enable();
    b.motion("002xh", {0x170C, 4});
    b.motion("002xh", {0x170D, 100});
    b.motion("002xh", {0x170F, 50});
    b.motion("01Bxh", {10'000, 1'000'000, 10 * a1, 10 * a1});
    (void)b.hand("trigger", Value{true});
    b.run(49ms);
    EXPECT_EQ(b.position(), 0);
    (void)b.hand("trigger", Value{false});
    (void)b.hand("trigger", Value{true});  // within the inhibit time
    b.run(500ms);
    EXPECT_EQ(b.position(), 10'000) << "one edge, delayed";
}

TEST(LinmotTwin, AsymmetricRampsOvershootAndReturn) {
    // 1 m/s, acceleration 10, deceleration 2 m/s2: the stopping distance is 250 mm.
    Bench b;
    b.enable();
    b.motion("010xh", {5'000'000, 1'000'000, a1, 200'000});
    b.run(300ms);
    const double here = b.position();
    EXPECT_NEAR(here, 500'000 + 2'000'000, 1);
    b.motion("010xh", {static_cast<std::int64_t>(here) + 1'000'000, 1'000'000, a1, 200'000});  // 100 mm ahead
    b.run(500ms);
    EXPECT_NEAR(b.position(), here + 2'500'000, 2) << "it overshoots to where it stands";
    b.run(5s);
    EXPECT_NEAR(b.position(), here + 1'000'000, 1) << "and comes back";
}

TEST(LinmotTwin, ProfilesAreClosedForm) {
    struct Row {
        double distance, v, a, d;
    };
    for (const Row& r : {Row{1e6, 1e7, 1e8, 1e8}, Row{1e6, 1e6, 1e7, 2e7}, Row{300, 1e6, 1e7, 1e7}, Row{-5e6, 2e6, 3e7, 1e7}}) {
        twin::Profile p;
        const Instant t0 = at_ns(0);
        p.move(t0, {0, 0}, r.distance, {r.v, r.a, r.d});
        const double D = std::fabs(r.distance);
        double peak = std::sqrt(2 * r.a * r.d * D / (r.a + r.d));
        double plateau = 0;
        if (peak > r.v) {
            peak = r.v;
            plateau = (D - peak * peak / (2 * r.a) - peak * peak / (2 * r.d)) / peak;
        }
        const double t1 = peak / r.a, total = t1 + plateau + peak / r.d;
        EXPECT_NEAR(seconds(p.end() - t0), total, 1e-8);
        const auto at = [&](double t) { return p.at(t0 + Duration{static_cast<std::int64_t>(t * 1e9)}); };
        const double sign = r.distance < 0 ? -1 : 1;
        EXPECT_NEAR(at(t1 / 2).position * sign, r.a * t1 * t1 / 8, 1e-3 + 1e-6 * D);
        EXPECT_NEAR(at(t1 + plateau / 2).velocity * sign, peak, 1e-3 * peak);
        EXPECT_EQ(at(total + 1).position, r.distance);
    }
}

TEST(LinmotTwin, PredefinedValuesAreReadAtEachStartAndIndexingLatchesThem) {
    Bench b;
    b.enable();
    b.motion("002xh", {0x14BE, 10'000});
    b.motion("020xh", {100'000});
    b.run(500ms);
    EXPECT_NEAR(b.drive().mechanics().velocity, 100'000, 1);
    b.motion("027xh");
    b.run(1s);
    b.motion("071xh", {0});
    b.motion("002xh", {0x14BE, 1'000'000});
    (void)b.hand("encoder", Value{std::int64_t{100'000}});
    b.run(300ms);
    EXPECT_LE(std::fabs(b.drive().mechanics().velocity), 100'000 + 1) << "latched at the call";
    b.motion("008xh");
    b.run(3s);
    b.motion("020xh", {2'000'000});
    b.run(600ms);
    EXPECT_GT(b.drive().mechanics().velocity, 500'000);
}

TEST(LinmotTwin, RamIsLostAndRomStays) {
    Bench b;
    b.motion("002xh", {0x14BE, 77});
    EXPECT_EQ(b.drive().ram(0x14BE), 77u);
    b.motion("002xh", {0x1716, 0x1234'0000});
    EXPECT_EQ(b.drive().ram(0x1716), 0u) << "a Bool takes bit 0 of the 32 bits";
    Out out;
    (void)b.hand("power", Value{false});
    (void)b.hand("power", Value{true});
    EXPECT_EQ(b.drive().ram(0x14BE), 100'000u);
    b.count = 0;
    b.enable();
    b.motion("002xh", {0x14BE, 77});
    const auto revision = b.twin->non_volatile_revision();
    b.motion("24Exh", {0x14BE});
    EXPECT_GT(b.twin->non_volatile_revision(), revision);
    (void)b.hand("power", Value{false});
    (void)b.hand("power", Value{true});
    EXPECT_EQ(b.drive().ram(0x14BE), 77u);
}

TEST(LinmotTwin, ThePressCurrentStays) {
    Bench b;
    b.enable();
    b.motion("0C5xh", {50'000, v1, a1, 1200});
    b.run(2s);
    EXPECT_EQ(b.drive().ram(0x13A6), 1200u);
    b.motion("0C6xh", {0, v1, a1, 3000});
    EXPECT_EQ(b.drive().ram(0x13A6), 3000u);
    EXPECT_EQ(b.drive().memory.rom(0x13A6), 3000u);
    b.motion("0C5xh", {50'000, v1, a1, 0});
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x0463);
}

TEST(LinmotTwin, AfterAnAbortItStandsAfterAFreezeItGoesOn) {
    for (const bool freeze : {false, true}) {
        Bench b;
        b.enable();
        b.motion("010xh", {500'000, v1, a1, a1});
        b.run(200ms);
        b.control(freeze ? 0x1F : 0x2F);
        b.run(200ms);
        const double here = b.position();
        EXPECT_EQ(b.drive().status_word() & 0x2000, 0);
        b.control(0x3F);
        b.run(2s);
        EXPECT_EQ(b.position(), freeze ? 500'000 : here);
    }
}

TEST(LinmotTwin, FatalErrorsAreNotAcknowledgedAndALevelIsNoEdge) {
    Bench b;
    b.enable();
    (void)b.hand("inject_error", Value{std::int64_t{0x0D}});
    EXPECT_EQ(b.drive().state_var(), 0x040D);
    EXPECT_NE(b.drive().status_word() & 0x1000, 0);
    for (int i = 0; i < 3; ++i) {
        b.control(0x3E);
        b.control(0xBE);
    }
    EXPECT_EQ(b.state(), 4);
    Bench c;
    c.control(0xBE);
    c.enable();
    c.control(0xBF);
    (void)c.hand("inject_error", Value{std::int64_t{0x40}});
    c.run(1s);
    EXPECT_EQ(c.drive().state_var(), 0x0440) << "the bit was set before: no edge";
    c.control(0x3E);
    c.control(0xBE);
    EXPECT_EQ(c.state(), 2);
}

TEST(LinmotTwin, AnErrorOfASensorIsAcknowledgedWhenItsWarningIsGone) {
    Bench b;
    b.enable();
    (void)b.hand("ptc_1", Value{true});
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x0406);
    b.control(0x3E);
    b.control(0xBE);
    EXPECT_EQ(b.state(), 4);
    (void)b.hand("ptc_1", Value{false});
    b.control(0x3E);
    b.control(0xBE);
    EXPECT_EQ(b.state(), 2);
}

TEST(LinmotTwin, AHeldMotorRaisesTheLagErrorAtItsInstant) {
    Bench b;
    b.enable();
    (void)b.hand("stall", Value{true});
    b.motion("010xh", {1'000'000, 10'000, a1, a1});  // 10 mm/s: 5 mm behind after half a second
    b.run(490ms);
    EXPECT_EQ(b.state(), 8);
    b.run(2s);  // no request meanwhile
    EXPECT_EQ(b.drive().state_var(), 0x040B);
}

TEST(LinmotTwin, ControlWordSourcesBitByBit) {
    Bench b;
    b.enable();
    EXPECT_EQ(b.hand("control_mask", Value{std::int64_t{0x08}}), "");  // the PC tool holds bit 3 at 0
    EXPECT_EQ(b.state(), 6);
    b.control(0x3F);
    EXPECT_EQ(b.state(), 6);
    EXPECT_EQ(b.hand("control_mask", Value{std::int64_t{0}}), "");
    EXPECT_EQ(b.state(), 8);
    EXPECT_EQ(b.hand("copy_mask", Value{std::int64_t{0}}), "");
    EXPECT_EQ(b.state(), 1) << "a mask of 0 blocks the interface";
}

TEST(LinmotTwin, ASmallerSeriesHasLess) {
    for (const auto* id : {"004xh", "0B0xh", "050xh", "208xh", "263xh"}) {
        Bench b(Bench::Options{{"series", "b1100"}});
        b.enable();
        b.motion(id, {1, 1, 1});
        b.run(1s);
        EXPECT_EQ(b.drive().state_var(), 0x0481) << id;
    }
    Bench none(Bench::Options{{"keys", "none"}});
    none.enable();
    none.motion("380xh", {1000, v1, a1, 10});
    none.run(1s);
    EXPECT_EQ(none.drive().state_var(), 0x0481) << "no force key";
}

/// An entry: header, parameters, the next entry.
void entry(Bench& b, std::uint16_t id, std::uint16_t header, const std::vector<std::pair<std::int64_t, int>>& values, std::uint16_t next) {
    std::vector<std::uint8_t> v;
    Bench::put(v, 0xA701, 2);
    Bench::put(v, next, 2);
    Bench::put(v, header, 2);
    for (const auto& [value, n] : values)
        Bench::put(v, value, n);
    v.resize(64);
    std::copy(v.begin(), v.end(), b.drive().table[id].begin());
}

TEST(LinmotTwin, ACommandTableLoopsFiveTimesAndEnds) {
    Bench b;
    b.enable();
    entry(b, 5, 0x2400, {{0, 4}}, 6);
    entry(b, 6, 0x0100, {{500'000, 4}, {1'000'000, 4}, {10 * a1, 4}, {10 * a1, 4}}, 7);
    entry(b, 7, 0x2110, {}, 8);
    entry(b, 8, 0x0100, {{0, 4}, {1'000'000, 4}, {10 * a1, 4}, {10 * a1, 4}}, 9);
    entry(b, 9, 0x2110, {}, 10);
    entry(b, 10, 0x2410, {{1, 4}}, 11);
    entry(b, 11, 0x2500, {{5, 4}, {6, 2}, {12, 2}}, 0xFFFF);
    entry(b, 12, 0x0000, {}, 0xFFFF);
    b.motion("200xh", {5});
    int strokes = 0;
    bool out = false;
    for (int i = 0; i < 2000; ++i) {
        b.run(1ms);
        const bool far = b.position() > 400'000;
        if (far && !out) ++strokes;
        out = far;
    }
    EXPECT_EQ(strokes, 5);
    EXPECT_EQ(b.drive().ram(0x1E72), 5u);
    EXPECT_EQ(b.position(), 0);
    b.motion("200xh", {99});
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x048A);
}

TEST(LinmotTwin, WaitsHoldTheTable) {
    Bench b;
    b.enable();
    entry(b, 1, 0x2100, {{5000, 4}}, 2);  // 0.5 s
    entry(b, 2, 0x0100, {{100'000, 4}, {v1, 4}, {a1, 4}, {a1, 4}}, 3);
    entry(b, 3, 0x2220, {{50'000, 4}}, 4);  // actual position above 5 mm
    entry(b, 4, 0x2400, {{7, 4}}, 5);
    entry(b, 5, 0x2130, {}, 6);  // a rising edge
    entry(b, 6, 0x2400, {{8, 4}}, 0);
    b.motion("200xh", {1});
    b.run(490ms);
    EXPECT_EQ(b.position(), 0);
    b.run(40ms);
    EXPECT_EQ(b.drive().ram(0x1E72), 0u);
    EXPECT_GT(b.position(), 0);
    b.run(400ms);
    EXPECT_EQ(b.drive().ram(0x1E72), 7u);
    (void)b.hand("trigger", Value{true});
    b.run(10ms);
    EXPECT_EQ(b.drive().ram(0x1E72), 8u);
}

TEST(LinmotTwin, CurvesRunThroughTheirPointsAndTheirAmplitudeIsBounded) {
    Bench b;
    b.enable();
    auto& c = b.drive().curves[3];
    c.info.resize(70);
    c.info[32] = 0x50;
    c.info[33] = 0xC3;  // 50000 x 10 us = 0.5 s
    for (const int p : {0, 10'000, 40'000, 100'000})
        Bench::put(c.data, p, 4);
    b.motion("040xh", {3});
    b.run(250ms);
    EXPECT_NEAR(b.position(), 25'000, 1);
    EXPECT_NE(b.sub() & 0x20, 0);
    b.run(300ms);
    EXPECT_EQ(b.position(), 100'000);
    b.motion("042xh", {3, 2'100'000});  // 2000 %: from 10 mm by 200 mm
    b.run(600ms);
    EXPECT_EQ(b.position(), 2'100'000);
    EXPECT_EQ(b.state(), 8);
    b.motion("042xh", {3, 100'001 - 2'000'002});
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x0489);
    Bench d;
    d.enable();
    d.motion("040xh", {9});
    d.run(1s);
    EXPECT_EQ(d.drive().state_var(), 0x0462);
}

TEST(LinmotTwin, StreamsArePlayedLateAndWatched) {
    Bench b;
    b.enable();
    for (int i = 1; i <= 20; ++i) {
        b.motion("030xh", {i * 1000});
        b.run(3ms);
    }
    EXPECT_NEAR(b.position(), 19'000, 1500) << "1.5 periods behind";
    b.run(50ms);
    EXPECT_EQ(b.drive().error_code(), 0x83) << "no set point was left";
    Bench fast;
    fast.enable();
    fast.motion("030xh", {1});
    fast.run(1ms);
    fast.motion("030xh", {2});
    EXPECT_EQ(fast.drive().error_code(), 0x84);
    Bench slow;
    slow.enable();
    slow.motion("030xh", {1});
    slow.run(6ms);
    slow.motion("030xh", {2});
    EXPECT_EQ(slow.drive().error_code(), 0x85);
}

TEST(LinmotTwin, LimitSwitchesCountWhenHomed) {
    Bench b;
    b.enable();
    (void)b.hand("limit_negative", Value{true});
    EXPECT_EQ(b.state(), 8) << "not homed";
    (void)b.hand("limit_negative", Value{false});
    b.motion("009xh", {0});
    (void)b.hand("limit_positive", Value{true});
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x0488);
    EXPECT_EQ(b.drive().status_word() >> 11 & 1, 0) << "the home is gone";
}

TEST(LinmotTwin, TelegramsForOthersAndBrokenOnesGetNoAnswer) {
    Bench b;
    EXPECT_TRUE(b.ask("01 12 03 02 01 00 04").empty());
    EXPECT_TRUE(b.ask("01 11 03 02 01 00 05").empty());
    EXPECT_FALSE(b.ask("FF 01 11 03 02 01 00 04").empty());
    EXPECT_TRUE(b.ask("01 11 03").empty());
    EXPECT_FALSE(b.ask("02 01 00 04").empty()) << "the rest comes later";
    EXPECT_FALSE(b.ask("01 11 05 02 01 00 00 00 04").empty()) << "surplus data are ignored";
}

}  // namespace
}  // namespace axisgate::linmot::test
