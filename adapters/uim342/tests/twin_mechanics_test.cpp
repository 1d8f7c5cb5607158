// Mechanics of the UIM342 twin: what settings make of the shaft, how it runs out, what is too fast, where limits stop it, which bus it
// hears. In: instructions, the tester's hand, virtual time. Out: counters, turns, alarms. Never uses the adapter.
#include <gtest/gtest.h>

#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

double turns(Bench& b) {
    for (const HandItem& i : b.drive().hand()) {
        if (i.name == "shaft_turns") return as_number(i.value).value_or(-1e9);
    }
    return -1e9;
}

const std::string overspeed = "5A 00 19 00 00 00";
const std::string stall = "5A 00 1D 00 00 00";

/// Off, settings, restart, on.
Bench with(std::initializer_list<std::string_view> settings) {
    Bench b;
    b.setup(settings);
    EXPECT_TRUE(b.send("7E 01").empty());
    b.setup({"95 01"});
    return b;
}

void move(Bench& b, int pulses, int speed = 3200) {
    b.setup({"9F " + le32(pulses), "9E " + le32(speed), "96"});
    b.pass_ms(60000);
}

TEST(TwinMechanics, LimitAlarmsStopWithSd) {
    for (const int code : {0x1A, 0x1B}) {
        Bench b;
        b.setup({"9C " + le32(100000), "95 01", "9D 10 27 00 00", "96"});
        b.pass_ms(2000);
        const int before = b.position();
        b.hand("inject_error", code);
        EXPECT_EQ(b.ask("96"), "0F 00 3F 96 00 00 00") << "on the SD ramp";
        b.pass_ms(99);
        EXPECT_FALSE(b.stopped());
        b.pass_ms(1);
        EXPECT_TRUE(b.stopped());
        EXPECT_EQ(b.position() - before, 500) << "10000^2 / (2 * 100000)";
        EXPECT_EQ(b.status1() & 4u, 4u) << "the driver stays on";
    }
    for (const int code : {0x19, 0x1E}) {
        Bench b;
        b.setup({"95 01", "9D 10 27 00 00", "96"});
        b.pass_ms(2000);
        b.hand("inject_error", code);
        b.pass_ms(2000);
        EXPECT_EQ(b.speed(), 10000) << "what the drive does then is not printed";
    }
}

TEST(TwinMechanics, OverspeedIsToldOncePerStartAtItsInstant) {
    Bench b;
    b.setup({"9C " + le32(65000000), "99 " + le32(1'000'000), "95 01", "9D " + le32(320'000), "96"});
    EXPECT_TRUE(b.pass_ms(5000).empty()) << "6000 rpm of 3200 pulses are allowed";
    b.setup({"9D " + le32(400'000), "96"});
    const Instant began = b.now();
    EXPECT_EQ(b.pass_ms(5000), Lines{overspeed});
    EXPECT_NEAR(seconds(b.last_instant() - began), 0, 1e-6) << "just above the limit at once";
    EXPECT_EQ(b.speed(), 400'000);
    b.setup({"97"});
    b.pass_ms(1000);
    b.setup({"96"});
    const Instant again = b.now();
    EXPECT_EQ(b.pass_ms(5000), Lines{overspeed}) << "a new start";
    EXPECT_NEAR(seconds(b.last_instant() - again), 0.320, 1e-6);
    Bench half = with({"90 00 08 00"});  // 8 microsteps: 1600 pulses per turn
    half.setup({"9C " + le32(65000000), "99 " + le32(1'000'000), "9D " + le32(160'001), "96"});
    EXPECT_EQ(half.pass_ms(1000), Lines{overspeed});
    Bench held;
    held.setup({"86 06 00 00", "99 " + le32(1'000'000), "95 01"});
    held.hand("stall", true);
    held.setup({"9D " + le32(400'000), "96"});
    EXPECT_TRUE(held.pass_ms(1000).empty()) << "a shaft that is held is not fast";
}

TEST(TwinMechanics, TheShaftRunsOutWhenTheDriverGoesOff) {
    for (const bool closed : {true, false}) {
        Bench b;
        b.setup({closed ? "86 06 01 00" : "86 06 00 00", "95 01", "9D " + le32(-10000), "96"});
        b.pass_ms(1500);
        const int there = b.position();
        const double before = turns(b);
        b.setup({"95 00"});
        b.pass_ms(31.25);
        EXPECT_NEAR(b.mechanics().velocity, -5000, 1);
        EXPECT_EQ(b.stopped(), !closed) << "in open loop no pulses are sent, and nobody looks at the shaft";
        EXPECT_EQ(b.speed(), closed ? -5000 : 0);
        if (closed) EXPECT_EQ(b.ask("A1"), "0F 00 41 A1 00 00 00") << "no origin while it moves";
        b.pass_ms(31.25);
        EXPECT_TRUE(b.stopped());
        EXPECT_EQ(b.mechanics().velocity, 0);
        EXPECT_NEAR(turns(b) - before, -312.5 / 3200, 1e-3);
        EXPECT_EQ(b.position() - there, closed ? -313 : 0);
        EXPECT_EQ(b.drive().deadline(), never);
    }
    Bench caught;
    caught.setup({"95 01", "9D 10 27 00 00", "96"});
    caught.pass_ms(1000);
    caught.setup({"95 00"});
    caught.pass_ms(10);
    const int there = caught.position();
    caught.setup({"95 01"});
    EXPECT_TRUE(caught.stopped());
    caught.pass_ms(100);
    EXPECT_EQ(caught.position(), there) << "caught where it is";
    EXPECT_GT(there, 5050);
}

TEST(TwinMechanics, SpeedFollowsTheHeldShaft) {
    for (const bool closed : {true, false}) {
        Bench b;
        b.setup({closed ? "86 06 01 00" : "86 06 00 00", "BD 01 FF FF", "95 01", "9D E8 03 00 00", "96"});
        b.pass_ms(500);
        EXPECT_EQ(b.speed(), 1000);
        b.hand("stall", true);
        EXPECT_EQ(b.speed(), closed ? 0 : 1000) << "the encoder sees the shaft, open loop the pulses";
        EXPECT_EQ(b.ask("91 01").substr(3, 11), closed ? "01 00 00 00" : "01 E8 03 00");
        EXPECT_FALSE(b.stopped());
    }
}

TEST(TwinMechanics, SettingsActOnTheShaft) {
    Bench plain;
    plain.setup({"95 01"});
    move(plain, 3200);
    EXPECT_NEAR(turns(plain), 1, 1e-9);
    plain.setup({"A1"});
    EXPECT_NEAR(turns(plain), 1, 1e-9) << "an origin renumbers the counter, not the shaft";

    Bench fine = with({"90 00 40 00"});  // 64 microsteps
    move(fine, 3200);
    EXPECT_NEAR(turns(fine), 0.25, 1e-9);
    Bench late;
    late.setup({"90 00 40 00", "95 01"});
    move(late, 3200);
    EXPECT_NEAR(turns(late), 1, 1e-9) << "MT[0] acts after the next power-on [L1247]";

    Bench back;
    back.setup({"86 01 00 00", "95 01"});
    move(back, 3200);
    EXPECT_EQ(back.position(), 3200);
    EXPECT_NEAR(turns(back), -1, 1e-9) << "clockwise is positive now, at once [L777]";
    back.setup({"86 01 01 00"});
    EXPECT_EQ(back.position(), 3200) << "the counter keeps its number";
    EXPECT_NEAR(turns(back), -1, 1e-9);
    move(back, 3200);
    EXPECT_NEAR(turns(back), 0, 1e-9);
}

TEST(TwinMechanics, AWrongResolutionEndsInAStall) {
    struct Row {
        const char* what;
        std::initializer_list<std::string_view> settings;
        bool stalls;
        int after;  ///< pulses of the counter when the tolerance of 100 is used up
    };
    const std::initializer_list<std::string_view> lines{"BD 00 D0 07"}, bits{"86 05 01 00", "BD 02 14 00"},
        right{"86 05 01 00", "BD 02 11 00"}, cpr{"BD 04 80 0C", "BD 04 40 06"}, open{"86 06 00 00", "BD 00 D0 07"};
    for (const Row& row : {Row{"QE[0] = 2000", lines, true, 100}, Row{"QE[2] = 20, absolute", bits, true, 100 / 7 + 1},
                           Row{"QE[2] = 17", right, false, 0}, Row{"QE[4] = 1600", cpr, true, 100}, Row{"open loop", open, false, 0}}) {
        SCOPED_TRACE(row.what);
        Bench b = with(row.settings);
        b.setup({"9C " + le32(4'000'000'000u), "9F " + le32(3200), "9E " + le32(1000), "96"});
        const Lines reported = b.pass_ms(20000);
        EXPECT_EQ(std::ranges::count(reported, stall), row.stalls ? 1 : 0);
        EXPECT_EQ(b.stalled(), row.stalls);
        if (row.stalls) {
            EXPECT_NEAR(b.position(), row.after, 2);
        } else {
            EXPECT_TRUE(b.in_position());
        }
    }
}

TEST(TwinMechanics, BitRateActsAfterARestartAndTheHandSetsItBack) {
    TwinSetup s = can_setup();
    s.bit_rate = 500'000;
    Bench b(s);
    EXPECT_EQ(b.ask("81 05"), "01 05 02") << "as the line has it";
    b.setup({"81 05 00"});
    EXPECT_EQ(b.ask("95"), "15 00") << "not before a restart [L1064]";
    EXPECT_TRUE(b.send("7E 01").empty());
    EXPECT_TRUE(b.send("95").empty()) << "another rate: it hears nothing";
    EXPECT_TRUE(b.inputs(1).empty()) << "and is not heard";
    Bench later(s, b.drive().non_volatile());
    EXPECT_TRUE(later.send("95").empty()) << "FLASH outlives the power";
    later.hand("bit_rate_code", 2);
    EXPECT_EQ(later.ask("95"), "15 00");
    EXPECT_EQ(later.ask("81 05"), "01 05 02");
    Out out;
    EXPECT_NE(later.drive().set_hand("bit_rate_code", Value{std::int64_t{5}}, later.now(), out), "");
    s.bit_rate = 0;
    Bench unknown(s, b.drive().non_volatile());
    EXPECT_EQ(unknown.ask("95"), "15 00") << "nobody knows the rate of the line";
}

TEST(TwinMechanics, DesiredPositionOfARelativeMotion) {
    Bench b;
    b.setup({"95 01"});
    move(b, 1000);
    b.setup({"9F " + le32(-300)});
    EXPECT_EQ(b.ask("AE 04"), "2E 04 E8 03 00 00") << "of the motion that has begun";
    b.setup({"96"});
    EXPECT_EQ(b.ask("AE 04"), "2E 04 BC 02 00 00") << "1000 - 300: where the motion ends";
    EXPECT_EQ(b.ask("AE 03"), "2E 03 D4 FE FF FF");
}

}  // namespace
}  // namespace axisgate::uim342::test
