// The twin: functions that follow the master encoder (cams, triggered cams, winding), warnings before errors, and thermal models.
#include <cmath>

#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {
constexpr std::int64_t speed = 1'000'000, rate = 10'000'000;  // 1 m/s, 100 m/s2

/// A curve with straight segments over a number of counts.
void curve(Bench& b, std::uint16_t id, std::initializer_list<int> points, int x_length = 1000) {
    auto& c = b.drive().curves[id];
    c.info.assign(70, 0);
    for (int i = 0; i < 4; ++i)
        c.info[static_cast<std::size_t>(32 + i)] = static_cast<std::uint8_t>(x_length >> 8 * i);
    for (const int p : points)
        Bench::put(c.data, p, 4);
}
void turn(Bench& b, std::int64_t to) { (void)b.hand("encoder", Value{to}); }
void move(Bench& b, std::int64_t to) {
    b.motion("010xh", {to, speed, rate, rate});
    b.run(2s);
    ASSERT_EQ(b.position(), static_cast<double>(to));
}

TEST(LinmotFollow, TheEncoderIsCountedByItsTypeDecodingAndDirection) {
    Bench b;
    const auto count = [&](std::int64_t type, std::int64_t decoding, std::int64_t direction, std::int64_t source = 1) {
        for (const auto& [upid, v] : {std::pair{0x128E, type}, {0x128F, decoding}, {0x1290, direction}, {0x172A, source}})
            b.motion("002xh", {upid, v});
        return b.drive().master();
    };
    turn(b, 1000);
    EXPECT_EQ(count(2, 0, 0), 250);
    EXPECT_EQ(count(2, 1, 0), 500);
    EXPECT_EQ(count(1, 2, 0), 1000);
    EXPECT_EQ(count(1, 2, 1), -1000);
    EXPECT_EQ(count(4, 2, 0), 500) << "4x on step and direction acts as 2x ...";
    EXPECT_EQ(b.drive().ram(0x128F), 2u) << "... and the parameter keeps what was written";
    EXPECT_EQ(count(5, 1, 0), 500);
    EXPECT_EQ(count(3, 2, 0), 0) << "there is no type 3";
    EXPECT_EQ(count(2, 2, 0, 0), 0) << "no source";
}

TEST(LinmotFollow, CamsAreLaidFromThePlaceToTheTargetAndFollowTheCount) {
    Bench b;
    b.enable();
    curve(b, 1, {0, 10'000, 40'000, 60'000});
    move(b, 20'000);
    b.motion("112xh", {1, 100, 140'000});  // from 2 mm to 14 mm, at counts 100 to 1100
    move(b, 140'000);
    b.motion("124xh", {1, 1100, 20'000, 500});  // back, at counts 1100 to 1600
    b.motion("102xh");                          // at count 0: the start of cam 1
    EXPECT_NE(b.sub() & 0x20, 0);
    b.run(2s);
    EXPECT_EQ(b.position(), 20'000);
    EXPECT_EQ(b.drive().ram(0x1BA9), 0u);
    b.motion("100xh");
    EXPECT_EQ(b.drive().ram(0x1BA9), 1u);
    const auto at = [&](std::int64_t count) {
        turn(b, count);
        return b.position();
    };
    EXPECT_EQ(at(100), 20'000);
    EXPECT_NEAR(at(600), 20'000 + 2 * 25'000, 1e-6) << "in the middle: between 10000 and 40000, twice as high";
    EXPECT_NEAR(at(1100), 140'000, 1e-6);
    EXPECT_NEAR(at(1350), 140'000 - 120'000 * 25.0 / 60, 1e-6);
    EXPECT_NEAR(at(5000), 20'000, 1e-6) << "endless: it rests at the end of the last cam";
    EXPECT_NEAR(at(600), 70'000, 1e-6) << "and goes back where the encoder goes back";
    b.motion("101xh");
    EXPECT_EQ(at(1100), 70'000) << "uncoupled";
}

TEST(LinmotFollow, ModuloCamsComeAgainAndAnEncoderThatTurnsCarriesThem) {
    Bench b;
    b.enable();
    b.motion("002xh", {0x1527, 1});
    curve(b, 1, {0, 10'000, 0}, 1000);
    b.motion("110xh", {1, 0});
    b.motion("100xh");
    (void)b.hand("encoder_speed", Value{std::int64_t{1000}});
    for (int lap = 0; lap < 3; ++lap) {
        b.run(250ms);
        EXPECT_NEAR(b.position(), 5000, 1e-3) << lap;
        EXPECT_NEAR(b.drive().mechanics().velocity, 20'000, 1e-6);
        b.run(500ms);
        EXPECT_NEAR(b.position(), 5000, 1e-3);
        EXPECT_NEAR(b.drive().mechanics().velocity, -20'000, 1e-6);
        b.run(250ms);
    }
}

TEST(LinmotFollow, AnAmplitudeActsNowOrAtTheNextStart) {
    Bench b;
    b.enable();
    b.motion("002xh", {0x1527, 1});
    curve(b, 1, {0, 10'000, 0}, 1000);
    b.motion("115xh", {1, 0, 2000, 1000});  // 200 %
    b.motion("100xh");
    turn(b, 500);
    EXPECT_EQ(b.position(), 20'000) << "at once";
    b.motion("118xh", {500, 1000});
    EXPECT_EQ(b.position(), 20'000) << "not yet";
    turn(b, 750);
    EXPECT_EQ(b.position(), 10'000);
    turn(b, 1500);
    EXPECT_EQ(b.position(), 5000) << "from its next start on";
}

TEST(LinmotFollow, CamStartEnableLetsTheRunningCamEnd) {
    Bench b;
    b.enable();
    b.motion("002xh", {0x1527, 1});
    curve(b, 1, {0, 10'000, 0}, 1000);
    b.motion("110xh", {1, 0});
    b.motion("100xh");
    (void)b.hand("encoder_speed", Value{std::int64_t{1000}});
    b.run(500ms);
    b.motion("002xh", {0x1528, 0});
    EXPECT_EQ(b.drive().ram(0x1BA9), 1u);
    b.run(499ms);
    EXPECT_EQ(b.drive().ram(0x1BA9), 1u);
    b.run(300ms);
    EXPECT_EQ(b.drive().ram(0x1BA9), 0u) << "it has vanished at the start that it was not allowed";
    EXPECT_NEAR(b.position(), 0, 1e-2);
    b.motion("002xh", {0x1528, 1});
    b.run(1s);
    EXPECT_EQ(b.drive().ram(0x1BA9), 1u);
    EXPECT_GT(b.position(), 1000);
    b.motion("117xh");
    const double here = b.position();
    b.run(300ms);
    EXPECT_EQ(b.position(), here) << "its only cam is disabled";
}

TEST(LinmotFollow, TheCounterIsSetAndAJumpIsALagError) {
    Bench b;
    b.enable();
    curve(b, 1, {0, 100'000}, 1000);
    b.motion("110xh", {1, 0});
    turn(b, 700);
    b.motion("104xh", {250});
    EXPECT_EQ(b.drive().master(), 250);
    turn(b, 800);
    EXPECT_EQ(b.drive().master(), 350);
    b.motion("104xh", {1000});
    b.motion("100xh");  // the end of the curve is 10 mm away: more than the permitted lag
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x040B);
    Bench none;
    none.enable();
    none.motion("110xh", {9, 0});
    none.run(1s);
    EXPECT_EQ(none.drive().state_var(), 0x0462) << "no such curve";
}

TEST(LinmotFollow, ATriggerStartsACamAfterItsDelay) {
    Bench b;
    b.enable();
    curve(b, 2, {0, 10'000}, 400);
    move(b, 5000);
    b.motion("06Axh", {2, 100, 25'000, 1000});
    EXPECT_EQ(b.drive().ram(0x154A), 2u);
    EXPECT_EQ(b.drive().ram(0x154C), 100u);
    EXPECT_NE(b.sub() & 0x10, 0) << "armed";
    (void)b.hand("encoder_speed", Value{std::int64_t{1000}});
    b.run(300ms);
    (void)b.hand("trigger", Value{true});
    b.run(99ms);
    EXPECT_EQ(b.position(), 5000) << "100 counts of delay";
    b.run(501ms);
    EXPECT_NEAR(b.position(), 15'000, 1e-2);
    b.run(1s);
    EXPECT_NEAR(b.position(), 25'000, 1e-2);
    EXPECT_EQ(b.sub() & 0x20, 0) << "over";
    (void)b.hand("trigger", Value{false});
    b.motion("06Exh", {2, 0, -500, 200});
    EXPECT_EQ(b.drive().ram(0x154B), 2u);
    move(b, 0);
    (void)b.hand("trigger", Value{true});
    b.run(1s);
    EXPECT_EQ(b.position(), 0) << "a falling edge is asked";
    (void)b.hand("trigger", Value{false});
    b.run(100ms);
    EXPECT_NEAR(b.position(), -2500, 5);
    b.motion("064xh", {2, 100});
    b.run(50ms);
    EXPECT_NE(b.sub() & 0x20, 0);
}

TEST(LinmotFollow, WindingGoesToAndFroByTheEncodersRevolutions) {
    Bench b(Bench::Options{{"winding", "0,40000,10000,30000,1000,2000,4,0,0"}});
    b.enable();
    b.motion("002xh", {0x1291, 1000});
    b.motion("301xh", {2});
    turn(b, 1999);
    EXPECT_EQ(b.position(), 0) << "two revolutions first";
    std::vector<double> ends;
    double before = 0;
    bool up = true;
    for (std::int64_t c = 2000; c < 12'000; c += 2) {
        turn(b, c);
        const double here = b.position();
        if ((here < before) == up) {
            ends.push_back(before);
            up = !up;
        }
        before = here;
    }
    // 4 revolutions from 1000 to 2000 counts per stroke: 4 ln 2 = 2.77 strokes, then one per 2000 counts, between 1 mm and 3 mm.
    ASSERT_GE(ends.size(), 5u);
    EXPECT_GT(ends[0], 36'000);
    EXPECT_LT(ends[0], 40'000);
    EXPECT_NEAR(ends[3], 10'000, 50);
    EXPECT_NEAR(ends[4], 30'000, 50);
    // While the adaptation is held, the ends stay where they are.
    Bench h(Bench::Options{{"winding", "0,40000,20000,20000,1000,1000,4,0,0"}});
    h.enable();
    h.motion("002xh", {0x1291, 1000});
    h.motion("300xh");
    turn(h, 1000);
    h.motion("304xh");
    turn(h, 2000);
    EXPECT_NEAR(h.position(), 5000, 1) << "left has come a quarter of its way, and stays";
    turn(h, 4000);
    EXPECT_NEAR(h.position(), 5000, 1);
    h.motion("305xh");
    turn(h, 5000);
    EXPECT_NEAR(h.position(), 30'000, 1) << "from there on it goes on";
}

TEST(LinmotFollow, DisturbanceMovesTheEndsAndACurveShapesTheStroke) {
    for (const bool anti : {false, true}) {
        Bench b(Bench::Options{{"winding", std::string("0,40000,0,40000,1000,1000,100,4,2000,") + (anti ? "antiparallel" : "parallel")}});
        b.enable();
        b.motion("300xh");
        turn(b, 2000);  // two of four strokes: the full disturbance
        EXPECT_NEAR(b.position(), 2000, 1);
        turn(b, 2999);
        EXPECT_NEAR(b.position(), anti ? 39'000 : 41'000, 60);
    }
    Bench c(Bench::Options{{"winding", "0,40000,0,40000,1000,1000,100,0,0"}});
    c.enable();
    curve(c, 7, {0, 0, 100});
    c.motion("310xh", {7});
    turn(c, 500);
    EXPECT_NEAR(c.position(), 0, 1e-6) << "the curve stands in its first half";
    turn(c, 750);
    EXPECT_NEAR(c.position(), 20'000, 1e-6);
    Bench small(Bench::Options{{"series", "b1100"}});
    small.enable();
    small.motion("300xh");
    small.run(1s);
    EXPECT_EQ(small.drive().state_var(), 0x0481) << "not on the smaller series";
}

TEST(LinmotFollow, TheRunModesCommandsAreWhatTheTwinWasGiven) {
    Bench b(Bench::Options{{"trig_rise", "30000"}, {"trig_fall", "-20000"}});
    b.enable();
    b.motion("0DExh");
    b.run(2s);
    EXPECT_EQ(b.position(), 30'000);
    b.motion("0DFxh");
    b.run(2s);
    EXPECT_EQ(b.position(), -20'000);
}

TEST(LinmotFollow, WhatIsArmedOrComesLaterLeavesARunningCurve) {
    Bench b;
    b.enable();
    curve(b, 1, {0, 10'000}, 50'000);  // half a second
    b.motion("040xh", {1});
    b.run(100ms);
    b.motion("01Axh", {50'000, speed, rate, rate});
    b.motion("018xh", {20'000, speed, rate, rate});
    b.run(100ms);
    EXPECT_NEAR(b.position(), 4000, 1) << "the curve goes on";
    b.run(1s);
    EXPECT_EQ(b.position(), 20'000) << "then what was to come after it";
}

TEST(LinmotFollow, AFrozenCurveEndsAtTheLastTarget) {
    for (const bool moved : {true, false}) {
        Bench b;
        b.enable();
        if (moved) move(b, 10'000);
        curve(b, 1, {0, 100'000}, 50'000);
        b.motion("040xh", {1});
        b.run(250ms);
        b.control(0x1F);
        b.run(1s);
        EXPECT_GT(b.position(), 40'000);
        b.control(0x3F);
        b.run(2s);
        EXPECT_EQ(b.position(), moved ? 10'000 : 0) << "the last target, or the initial position if there never was one";
    }
}

TEST(LinmotFollow, AForcedBitBeatsX4AndX4TheInterface) {
    Bench b(Bench::Options{{"force", "8"}});
    b.enable();
    auto o = b.drive().outside();
    o.x4_mask = 0x08;  // enable operation from an input that is low, but forced to 1
    b.drive().set_outside(o, b.now);
    EXPECT_EQ(b.state(), 8);
    Bench x;
    x.enable();
    o = x.drive().outside();
    o.x4_mask = 0x08;
    x.drive().set_outside(o, x.now);
    EXPECT_EQ(x.state(), 6);
    x.control(0x3F);
    EXPECT_EQ(x.state(), 6) << "the interface does not reach this bit";
    o.x4_word = 0x08;
    x.drive().set_outside(o, x.now);
    EXPECT_EQ(x.state(), 8);
}

TEST(LinmotFollow, TheSmallerSeriesHas31EntriesFlashAndNoLagOfStanding) {
    Bench b(Bench::Options{{"series", "b1100"}});
    b.enable();
    EXPECT_TRUE(b.tell({7, 8, 0, 0}).empty()) << "no command table over a serial interface";
    EXPECT_TRUE(b.tell({8, 4, 1, 0}).empty()) << "nor curves";
    b.drive().table[31] = {};
    b.motion("200xh", {31});
    EXPECT_EQ(b.state(), 8);
    b.drive().table[32] = {};
    b.motion("200xh", {32});
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x048A);
    for (const bool small : {false, true}) {
        Bench s(small ? Bench::Options{{"series", "b1100"}} : Bench::Options{});
        s.enable();
        (void)s.hand("stall", Value{true});
        s.motion("010xh", {15'000, speed, rate, rate});
        s.run(1s);
        EXPECT_EQ(s.drive().warn_word() >> 5 & 1, small ? 0 : 1);
    }
}

// --- monitoring -----------------------------------------------------------------------------------------------------------------
TEST(LinmotMonitor, AWarningComesBeforeItsError) {
    struct Row {
        const char* what;
        Value warns, errs;
        int bit;
        int code;
    };
    for (const Row& r :
         {Row{"temperature", 75.0, 90.0, 6, 0x10}, Row{"motor_supply", 22.0, 18.0, 2, 0x03}, Row{"motor_supply", 86.0, 95.0, 3, 0x04}}) {
        Bench b;
        b.enable();
        (void)b.hand(r.what, r.warns);
        EXPECT_NE(b.drive().warn_word() >> r.bit & 1, 0) << r.what;
        EXPECT_NE(b.drive().status_word() & 0x80, 0);
        EXPECT_EQ(b.state(), 8) << r.what;
        (void)b.hand(r.what, r.errs);
        b.run(1s);
        EXPECT_EQ(b.drive().state_var(), 0x0400 | r.code) << r.what;
    }
    for (const auto& [what, bit, code] : {std::tuple{"ptc_1", 8, 0x06}, std::tuple{"ptc_2", 9, 0x0F}, std::tuple{"motor_hot", 0, 0x20}}) {
        Bench b;
        b.enable();
        (void)b.hand(what, Value{true});
        b.run(150ms);
        EXPECT_NE(b.drive().warn_word() >> bit & 1, 0) << what;
        EXPECT_EQ(b.state(), 8) << what << ": the warning comes first";
        b.run(2s);
        EXPECT_EQ(b.drive().state_var(), 0x0400 | code) << what;
    }
    Bench small(Bench::Options{{"series", "b1100"}});
    small.enable();
    (void)small.hand("temperature", Value{90.0});
    small.run(1s);
    EXPECT_EQ(small.drive().state_var(), 0x0417) << "its only sensor is the core's";
}

TEST(LinmotMonitor, TheResistorWarmsBetweenItsSwitchingVoltages) {
    Bench b;
    b.enable();
    b.drive().memory.set_ram(0x101D, 1);
    EXPECT_NEAR(b.drive().ram(0x1C0D), 250, 1);
    (void)b.hand("motor_supply", Value{89.0});  // on above 88 V: 792 W into 50 J/K
    b.run(1s);
    const auto one = b.drive().ram(0x1C0D);
    EXPECT_NEAR(one, 250 + 10 * 89.0 * 89 / 10 / 50, 5) << "the first second heats its own body alone, nearly";
    (void)b.hand("motor_supply", Value{87.0});
    b.run(1s);
    EXPECT_GT(b.drive().ram(0x1C0D), one + 100) << "on until it is below 86 V";
    b.run(60s);
    EXPECT_EQ(b.drive().error_code(), 0x15);
    EXPECT_NE(b.drive().warn_word() & 0x400, 0);
    (void)b.hand("motor_supply", Value{72.0});
    b.run(3600s);
    EXPECT_NEAR(b.drive().ram(0x1C0D), 250, 10) << "and cools to its environment";
    EXPECT_EQ(b.drive().warn_word() & 0x400, 0);
}

TEST(LinmotMonitor, ACurrentThatLastsOverloadsTheMotor) {
    Bench b;
    b.enable();
    (void)b.hand("current", Value{std::int64_t{10'000}});
    bool warned = false;
    for (int i = 0; i < 600 && b.state() == 8; ++i) {
        b.run(100ms);
        warned |= (b.drive().warn_word() & 2) != 0 && b.state() == 8;
    }
    EXPECT_TRUE(warned);
    b.run(1s);
    EXPECT_EQ(b.drive().state_var(), 0x0423);
}

TEST(LinmotMonitor, ShortLowOfTheSafetyInputIsNoStop) {
    Bench b;
    b.enable();
    (void)b.hand("safe_voltage_enable", Value{false});
    b.run(400us);
    (void)b.hand("safe_voltage_enable", Value{true});
    b.run(1ms);
    EXPECT_EQ(b.state(), 8);
    (void)b.hand("safe_voltage_enable", Value{false});
    b.run(499us);
    EXPECT_EQ(b.state(), 8);
    b.run(1us);
    EXPECT_EQ(b.state(), 1);
}

TEST(LinmotMonitor, TheBrakeHasItsTime) {
    Bench b;
    for (const int upid : {0x1716, 0x1717, 0x1718})
        b.drive().memory.set_ram(static_cast<std::uint16_t>(upid), 1);
    b.drive().memory.set_ram(0x171B, 40);
    b.drive().memory.set_ram(0x171C, 30);
    b.enable();
    b.control(0x2F);
    EXPECT_EQ(b.state(), 12);
    b.run(100ms);
    b.control(0x3F);
    b.run(29ms);
    EXPECT_EQ(b.state(), 12) << "the brake is being released";
    b.run(1ms);
    EXPECT_EQ(b.state(), 8);
    b.motion("010xh", {10'000'000, speed, rate, rate});
    b.run(500ms);
    b.control(0x3B);  // 1 m/s to 0 with 10 m/s2: 100 ms, then 40 ms for the brake
    b.run(139ms);
    EXPECT_EQ(b.state(), 14);
    EXPECT_NE(b.drive().status_word() & 1, 0);
    b.run(2ms);
    EXPECT_EQ(b.state(), 1);
    EXPECT_EQ(b.drive().status_word() & 1, 0);
}

}  // namespace
}  // namespace axisgate::linmot::test
