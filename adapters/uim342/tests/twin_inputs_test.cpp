// Inputs: sampling grid, three trigger modes, eleven actions on six edges, notification masks, power-on execution, lock.
// In: levels by the hand, configuration by the wire. Out: notifications and motions.
// Never calls an action directly.
#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

std::string byte(int n) {
    char s[4];
    std::snprintf(s, sizeof s, "%02X", n);
    return s;
}
constexpr const char* rt_lock = "5A 00 0A 00 00 00";
constexpr const char* rt_arrived = "5A 29 00 00 00 ";

/// One of the six edges.
struct EdgeCase {
    int input;  // 0..2
    bool rising;
    std::string group() const { return "98 " + byte(2 + 2 * input + (rising ? 0 : 1)); }
    std::string notification() const { return "5A " + byte(2 * input + (rising ? 2 : 1)); }
    std::string logic(int action) const {
        const std::string falling = byte(rising ? 0x80 : 0x80 | action);
        const std::string rise = byte(rising ? 0x80 | action : 0x80);
        return "B4 " + byte(input) + " " + falling + " " + rise;
    }
    int before() const { return rising ? 0 : 1 << input; }
    int after() const { return rising ? 1 << input : 0; }
};

const EdgeCase edges[] = {{0, false}, {0, true}, {1, false}, {1, true}, {2, false}, {2, true}};

/// A drive with the action on one edge and the edge's group set to AC 20000, DC 5000, SP, PR, PA.
struct Rig {
    Bench b;
    EdgeCase e;
    Rig(const EdgeCase& edge, int action, int sp = -2000, int pr = 3000, int pa = 777) : e(edge) {
        b.inputs(e.before());
        b.pass_ms(1);
        b.setup({e.logic(action), e.group(), "99 " + le32(20000), e.group(), "9A " + le32(5000), e.group(), "9E " + le32(sp), e.group(),
                 "9F " + le32(pr), e.group(), "A0 " + le32(pa), "95 01"});
    }
    /// Runs at `velocity` until it is there and the position is some thousand.
    void run(int velocity) {
        b.setup({"9D " + le32(velocity), "96"});
        b.pass_ms(1000);
        ASSERT_EQ(b.speed(), velocity);
    }
    Lines trigger() {
        Lines lines = b.inputs(e.after());
        for (auto& l : b.pass_ms(1))
            lines.push_back(l);
        return lines;
    }
};

TEST(TwinInputs, EdgesAreSeenOnTheMillisecondGridAndNotified) {
    Bench b;
    for (const EdgeCase& e : edges) {
        b.inputs(e.before());
        b.pass_ms(2);
        b.pass(std::chrono::microseconds(300));
        EXPECT_TRUE(b.inputs(e.after()).empty()) << "between two samples";
        EXPECT_EQ((b.status1() >> (3 + e.input)) & 1u, e.rising ? 0u : 1u);
        EXPECT_EQ(b.pass(std::chrono::microseconds(700)), Lines{e.notification()});
        EXPECT_EQ(ns_of(b.last_instant()) % 1'000'000, 0);
        EXPECT_EQ((b.status1() >> (3 + e.input)) & 1u, e.rising ? 1u : 0u);
        EXPECT_TRUE(b.pass_ms(10).empty());
        b.inputs(0);
        b.pass_ms(2);
    }
    // A pulse between two samples is not seen.
    b.pass(std::chrono::microseconds(100));
    EXPECT_TRUE(b.inputs(7).empty());
    b.pass(std::chrono::microseconds(500));
    EXPECT_TRUE(b.inputs(0).empty());
    EXPECT_TRUE(b.pass_ms(5).empty());
    // All three at once: IN1 first. On the grid: at once.
    b.pass(Duration{1'000'000 - ns_of(b.now()) % 1'000'000});
    EXPECT_EQ(b.inputs(7), (Lines{"5A 02", "5A 04", "5A 06"}));
    EXPECT_EQ(b.inputs(5), Lines{"5A 03"});
}

TEST(TwinInputs, MasksGateTheMessageNotTheAction) {
    for (const EdgeCase& e : edges) {
        Rig r(e, 0x03);
        r.b.setup({"87 " + byte(e.input) + " 00 00"});
        r.run(1000);
        EXPECT_TRUE(r.trigger().empty());
        r.b.pass_ms(1000);
        EXPECT_TRUE(r.b.stopped());
        r.b.setup({"87 " + byte(e.input) + " 01 00"});
        r.b.inputs(e.before());
        EXPECT_EQ(r.b.pass_ms(1).size() + 1, 1u + (ns_of(r.b.now()) % 1'000'000 == 0 ? 0u : 1u));
        EXPECT_EQ(r.trigger(), Lines{e.notification()});
    }
}

TEST(TwinInputs, Action01DriverOff) {
    for (const EdgeCase& e : edges) {
        Rig r(e, 0x01);
        r.run(1000);
        EXPECT_EQ(r.trigger(), Lines{e.notification()});
        EXPECT_EQ(r.b.ask("95"), "15 00");
        EXPECT_FALSE(r.b.stopped()) << "the shaft is free and runs out";
        EXPECT_TRUE(r.b.pass_ms(10).empty());
        EXPECT_TRUE(r.b.stopped());
    }
}

TEST(TwinInputs, Action02EmergencyStopOnSd) {
    for (const EdgeCase& e : edges) {
        Rig r(e, 0x02);
        r.run(10000);
        r.b.setup({"9C " + le32(100000)});  // 100 ms, 500 pulses
        const int before = r.b.position();
        EXPECT_EQ(r.trigger(), Lines{e.notification()});
        EXPECT_EQ(r.b.ask("96"), "0F 00 3F 96 00 00 00");
        EXPECT_FALSE(r.b.locked());
        EXPECT_TRUE(r.b.pass_ms(98.9).empty());
        EXPECT_FALSE(r.b.stopped());
        r.b.pass_ms(0.2);
        EXPECT_TRUE(r.b.stopped());
        EXPECT_EQ(r.b.position(), before + 500);
        EXPECT_EQ(r.b.ask("96"), "16 00 00 00 00");
    }
}

TEST(TwinInputs, Action03StopOnTheGroupsDc) {
    for (const EdgeCase& e : edges) {
        Rig r(e, 0x03);
        r.run(10000);
        const int before = r.b.position();
        EXPECT_EQ(r.trigger(), Lines{e.notification()});
        r.b.pass_ms(1998.9);  // 10000 / 5000 = 2 s
        EXPECT_FALSE(r.b.stopped());
        r.b.pass_ms(0.2);
        EXPECT_TRUE(r.b.stopped());
        EXPECT_EQ(r.b.position(), before + 10000);
        EXPECT_FALSE(r.b.in_position());
    }
}

/// The time of a deceleration belongs to the whole way from the desired speed: half the speed is gone in half the time.
TEST(TwinInputs, StopInTimeWhileStillAccelerating) {
    Bench b;
    b.setup({"86 04 01 00", "99 E8 03 00 00", "98 02", "9A E8 03 00 00", "B4 00 80 83", "95 01", "9D 10 27 00 00", "96"});
    b.pass_ms(500);
    EXPECT_EQ(b.speed(), 5000);
    b.inputs(1);
    b.pass_ms(250);
    EXPECT_EQ(b.speed(), 2500);
    b.pass_ms(250.001);
    EXPECT_TRUE(b.stopped());
}

TEST(TwinInputs, StartByAnInputClearsTheInPositionFlag) {
    Rig r(edges[1], 0x08);
    r.b.setup({"A0 64 00 00 00", "9E E8 03 00 00", "96"});
    r.b.pass_ms(1000);
    EXPECT_TRUE(r.b.in_position());
    (void)r.trigger();
    EXPECT_FALSE(r.b.in_position());
}

TEST(TwinInputs, BeginIsAllowedOnTheDcRamp) {
    Rig r(edges[1], 0x03);
    r.run(10000);
    (void)r.trigger();
    r.b.pass_ms(100);
    EXPECT_EQ(r.b.ask("A1"), "0F 00 41 A1 00 00 00");
    EXPECT_EQ(r.b.ask("96"), "16 00 00 00 00");
    r.b.pass_ms(1000);
    EXPECT_EQ(r.b.speed(), 10000);
}

TEST(TwinInputs, Action04OriginThenReverseMove) {
    for (const EdgeCase& e : edges) {
        for (const int velocity : {1000, -1000}) {
            Rig r(e, 0x04);
            r.run(velocity);
            EXPECT_EQ(r.trigger(), Lines{e.notification()});
            EXPECT_LE(std::abs(r.b.position()), 1);  // 1 ms after the origin
            // 1000 pulse/s brake with DC 5000: 100 pulses beyond the origin, then |PR| = 3000 back from the origin.
            const int target = velocity > 0 ? -3000 : 3000;
            EXPECT_EQ(r.b.pass_ms(20000), Lines{rt_arrived + le32(target)});
            EXPECT_TRUE(r.b.in_position());
            EXPECT_EQ(r.b.ask("AE 00"), "2E 00 00 00 00 00") << "the mode word is the one that was set";
        }
    }
}

TEST(TwinInputs, Action05OriginThenEmergencyStop) {
    for (const EdgeCase& e : edges) {
        Rig r(e, 0x05);
        r.run(10000);
        EXPECT_EQ(r.trigger(), Lines{e.notification()});
        r.b.pass_ms(100);
        EXPECT_TRUE(r.b.stopped());
        EXPECT_EQ(r.b.position(), 31);
        EXPECT_EQ(r.b.relative(), 31);
    }
}

TEST(TwinInputs, Action06OriginThenStop) {
    for (const EdgeCase& e : edges) {
        Rig r(e, 0x06);
        r.run(-1000);
        EXPECT_EQ(r.trigger(), Lines{e.notification()});
        r.b.pass_ms(1000);
        EXPECT_TRUE(r.b.stopped());
        EXPECT_EQ(r.b.position(), -100);  // 1000^2 / (2 * 5000)
        EXPECT_EQ(r.b.relative(), -100);
        // With the driver off the origin is set all the same.
        r.b.setup({"95 00"});
        r.b.inputs(e.before());
        r.b.pass_ms(1);
        (void)r.trigger();
        EXPECT_EQ(r.b.position(), 0);
    }
}

TEST(TwinInputs, Action07ReverseJog) {
    for (const EdgeCase& e : edges) {
        for (const int velocity : {1000, -1000}) {
            Rig r(e, 0x07);
            r.run(velocity);
            EXPECT_EQ(r.trigger(), Lines{e.notification()});
            r.b.pass_ms(1000);
            EXPECT_EQ(r.b.speed(), velocity > 0 ? -2000 : 2000);
            EXPECT_FALSE(r.b.stopped());
        }
        Rig rest(e, 0x07);
        (void)rest.trigger();
        rest.b.pass_ms(1000);
        EXPECT_EQ(rest.b.speed(), -2000) << "never moved: negative";
        Rig after(e, 0x07);
        after.run(-1000);
        after.b.setup({"97"});
        after.b.pass_ms(100);
        (void)after.trigger();
        after.b.pass_ms(1000);
        EXPECT_EQ(after.b.speed(), 2000) << "at rest: against the last direction";
    }
}

TEST(TwinInputs, Action08Jog) {
    for (const EdgeCase& e : edges) {
        for (const int sp : {2000, -2000}) {
            Rig r(e, 0x08, sp);
            EXPECT_EQ(r.trigger(), Lines{e.notification()});
            r.b.pass_ms(49);
            EXPECT_EQ(r.b.speed(), sp / 2) << "with the group's AC";
            r.b.pass_ms(100);
            EXPECT_EQ(r.b.speed(), sp);
            EXPECT_EQ(r.b.ask("AE 02"), "2E 02 00 00 00 00");
        }
    }
}

TEST(TwinInputs, Action09ReverseRelativeMove) {
    for (const EdgeCase& e : edges) {
        for (const int velocity : {1000, -1000}) {
            for (const int pr : {3000, -3000}) {
                Rig r(e, 0x09, 2000, pr);
                r.run(velocity);
                const int at = r.b.position();
                r.b.inputs(e.after());  // on the grid
                EXPECT_EQ(r.b.pass_ms(20000), Lines{rt_arrived + le32(velocity > 0 ? at - 3000 : at + 3000)});
            }
        }
    }
}

TEST(TwinInputs, Action0ARelativeMove) {
    for (const EdgeCase& e : edges) {
        for (const int pr : {3000, -3000}) {
            Rig r(e, 0x0A, -2000, pr);
            (void)r.trigger();
            EXPECT_EQ(r.b.pass_ms(20000), Lines{rt_arrived + le32(pr)});
            EXPECT_TRUE(r.b.in_position());
            EXPECT_EQ(r.b.relative(), pr);
        }
    }
}

TEST(TwinInputs, Action0BAbsoluteMove) {
    for (const EdgeCase& e : edges) {
        for (const int velocity : {1000, -1000}) {
            Rig r(e, 0x0B);
            r.run(velocity);
            (void)r.trigger();
            EXPECT_EQ(r.b.pass_ms(20000), Lines{rt_arrived + le32(777)});
        }
    }
}

TEST(TwinInputs, StartsNeedTheDriverAndNoEmergencyStop) {
    for (const int action : {0x04, 0x07, 0x08, 0x09, 0x0A, 0x0B}) {
        Rig off(edges[1], action);
        off.b.setup({"95 00"});
        EXPECT_EQ(off.trigger(), Lines{"5A 02"});
        EXPECT_TRUE(off.b.pass_ms(3000).empty());
        EXPECT_TRUE(off.b.stopped());
        EXPECT_EQ(off.b.position(), 0);
        off.b.setup({"95 01"});
        EXPECT_TRUE(off.b.pass_ms(3000).empty()) << "and nothing is kept for later";

        Rig stopping(edges[1], action);
        stopping.run(10000);
        stopping.b.setup({"97"});
        (void)stopping.trigger();
        EXPECT_TRUE(stopping.b.pass_ms(3000).empty());
        EXPECT_TRUE(stopping.b.stopped());
    }
    // A slow stop does not soften an emergency stop.
    Rig r(edges[1], 0x03);
    r.run(10000);
    r.b.setup({"97"});
    (void)r.trigger();
    r.b.pass_ms(6);
    EXPECT_TRUE(r.b.stopped());
}

TEST(TwinInputs, LockBySetting) {
    for (const int action : {0x02, 0x05}) {
        Rig r(edges[1], action);
        r.b.setup({"95 00", "86 03 01 00", "95 01"});
        r.run(10000);
        EXPECT_EQ(r.trigger(), (Lines{"5A 02", rt_lock}));
        EXPECT_TRUE(r.b.locked());
        EXPECT_TRUE(r.b.error());
        EXPECT_EQ(r.b.ask("96"), "0F 00 3F 96 00 00 00");
        r.b.pass_ms(1000);
        EXPECT_TRUE(r.b.stopped());
        EXPECT_TRUE(r.b.locked());
        EXPECT_EQ(r.b.ask("96"), "0F 00 3F 96 00 00 00") << "locked: no start";
        EXPECT_EQ(r.b.ask("91 00 00").substr(9, 2), "21") << "MS[0]=0 leaves LOCK and STOP";
        EXPECT_EQ(r.b.ask("A1"), "21");
        // Another edge while locked is no new entry.
        r.b.inputs(0);
        r.b.pass_ms(1);
        EXPECT_EQ(r.trigger(), Lines{"5A 02"});
        r.b.setup({"95 00"});
        EXPECT_FALSE(r.b.locked());
        r.b.setup({"95 01", "96"});
        r.b.pass_ms(2000);
        EXPECT_EQ(r.b.speed(), 10000);
    }
    // The lock holds input motions too, and the driver may be off when it comes.
    Bench b;
    b.setup({"86 03 01 00", "B4 00 80 82", "B4 01 80 88", "98 04", "9E E8 03 00 00"});
    EXPECT_EQ(b.inputs(1), (Lines{"5A 02", rt_lock}));
    b.setup({"95 01"});
    EXPECT_EQ(b.inputs(3), Lines{"5A 04"});
    b.pass_ms(100);
    EXPECT_TRUE(b.stopped());
    EXPECT_EQ(b.ask("96"), "0F 00 3F 96 00 00 00");
    EXPECT_TRUE(b.send("7E 01").empty());
    EXPECT_FALSE(b.locked());
}

TEST(TwinInputs, LowPassFilter) {
    Bench b;
    b.setup({"B5 00 64 00", "B4 00 82 82", "95 01", "9D E8 03 00 00", "96"});
    b.inputs(1);
    EXPECT_TRUE(b.pass_ms(50).empty());
    EXPECT_EQ(b.status1() & 8u, 0u) << "the level is the filtered one";
    b.inputs(0);
    EXPECT_TRUE(b.pass_ms(500).empty());
    EXPECT_FALSE(b.stopped());
    const Instant up = b.now();
    b.inputs(1);
    EXPECT_EQ(b.pass_ms(150), Lines{"5A 02"});
    EXPECT_EQ(b.last_instant() - up, std::chrono::milliseconds(100));
    EXPECT_TRUE(b.stopped());
    const Instant down = b.now();
    b.inputs(0);
    EXPECT_EQ(b.pass_ms(150), Lines{"5A 01"});
    EXPECT_EQ(b.last_instant() - down, std::chrono::milliseconds(100));
    // Jitter starts the time anew.
    for (int i = 0; i < 10; ++i) {
        b.inputs(1);
        EXPECT_TRUE(b.pass_ms(60).empty());
        b.inputs(0);
        EXPECT_TRUE(b.pass_ms(2).empty());
    }
    b.inputs(1);
    EXPECT_TRUE(b.pass_ms(99.9).empty());
    EXPECT_EQ(b.pass_ms(0.1), Lines{"5A 02"});
    // A new filter time while a change is judged: from the next sample on.
    b.inputs(0);
    EXPECT_TRUE(b.pass_ms(90).empty());
    b.setup({"B5 00 32 00"});
    EXPECT_TRUE(b.pass_ms(49).empty());
    EXPECT_EQ(b.pass_ms(1), Lines{"5A 01"});
    b.inputs(1);
    EXPECT_TRUE(b.pass_ms(10).empty());
    EXPECT_EQ(b.send("B5 00 00 00"), (Lines{"35 00 00 00", "5A 02"})) << "unfiltered: the present sample counts";
}

TEST(TwinInputs, OneTimeTrigger) {
    Bench b;
    b.setup({"98 02", "9E E8 03 00 00", "98 03", "9E 18 FC FF FF", "B5 00 61 EA", "B4 00 88 88", "95 01"});
    EXPECT_EQ(b.inputs(1), Lines{"5A 02"});
    b.pass_ms(1000);
    EXPECT_EQ(b.speed(), 1000);
    EXPECT_EQ(b.ask("B4 00"), "34 00 00 00") << "the actions are spent";
    EXPECT_EQ(b.inputs(0), Lines{"5A 01"}) << "notifications go on";
    b.pass_ms(1000);
    EXPECT_EQ(b.speed(), 1000);
    // Set again: one more time.
    b.setup({"B4 00 88 88"});
    EXPECT_EQ(b.inputs(1), Lines{"5A 02"});
    EXPECT_EQ(b.ask("B4 00"), "34 00 00 00");
    EXPECT_EQ(b.inputs(0), Lines{"5A 01"});
    b.pass_ms(1000);
    EXPECT_EQ(b.speed(), 1000);
    // The EEPROM kept the first setting.
    (void)b.send("7E 01");
    EXPECT_EQ(b.ask("B4 00"), "34 00 88 88");
    // The first change spends it, whichever edge it is.
    Bench first;
    first.setup({"98 02", "9E E8 03 00 00", "B5 00 61 EA", "B4 00 80 88", "95 01"});
    first.inputs(1);
    first.pass_ms(1);
    first.setup({"97"});
    first.pass_ms(10);
    first.setup({"B4 00 80 88"});
    first.inputs(0);
    first.pass_ms(1);
    first.inputs(1);
    first.pass_ms(100);
    EXPECT_TRUE(first.stopped());
}

TEST(TwinInputs, RisingAndFallingBytesAreNotMixed) {
    Bench b;
    b.setup({"98 02", "9E E8 03 00 00", "98 03", "9E D0 07 00 00", "B4 00 88 83", "95 01"});  // falling: jog, rising: stop
    b.inputs(1);
    b.pass_ms(100);
    EXPECT_TRUE(b.stopped());
    b.inputs(0);
    b.pass_ms(1000);
    EXPECT_EQ(b.speed(), 2000) << "group 3 is the falling edge's";
    b.inputs(1);
    b.pass_ms(1000);
    EXPECT_TRUE(b.stopped());
}

TEST(TwinInputs, PowerOnExecutionHasAnInvertedFlag) {
    const auto boots_into = [](const char* il, bool enable) {
        Bench b;
        b.setup({"98 02", "9E E8 03 00 00", "98 03", "9E D0 07 00 00", il});
        if (enable) b.setup({"86 00 01 00"});
        (void)b.send("7E 01");
        b.pass_ms(1000);
        return b.speed();
    };
    EXPECT_EQ(boots_into("B4 00 08 08", true), 1000) << "FG = 0: runs; falling first, rising last";
    EXPECT_EQ(boots_into("B4 00 88 88", true), 0) << "FG = 1: waits for an edge";
    EXPECT_EQ(boots_into("B4 00 08 88", true), 2000) << "d1 is the falling edge";
    EXPECT_EQ(boots_into("B4 00 88 08", true), 1000);
    EXPECT_EQ(boots_into("B4 00 08 08", false), 0) << "without the driver nothing moves";
    EXPECT_EQ(boots_into("B4 00 00 00", true), 0);
}

TEST(TwinInputs, PowerOnExecutionDisregardsLevelsAndWaitsForTheDelay) {
    Bench b;
    b.inputs(7);
    b.setup({"86 00 01 00", "90 03 C8 00", "98 06", "9E E8 03 00 00", "98 06", "9F F4 01 00 00", "B4 02 80 0A"});
    (void)b.send("7E 01");
    EXPECT_TRUE(b.pass_ms(199).empty());
    EXPECT_EQ(b.ask("95"), "15 00");
    EXPECT_EQ(b.pass_ms(5000), Lines{rt_arrived + le32(500)});
    b.inputs(0);
    b.hand("power", false);
    b.hand("power", true);
    EXPECT_EQ(b.pass_ms(5000), Lines{rt_arrived + le32(500)});
    // Power-on is not a change: a one-time trigger is still armed.
    b.setup({"95 00", "B5 02 61 EA"});
    (void)b.send("7E 01");
    b.pass_ms(5000);
    EXPECT_EQ(b.ask("B4 02"), "34 02 80 0A");
}

TEST(TwinInputs, PowerOnActionsWithoutTheDriver) {
    // The ones that are no motion act: here emergency stop with the lock, and driver off after the automatic enable.
    Bench b;
    b.setup({"86 03 01 00", "B4 01 80 02"});
    EXPECT_EQ(b.send("7E 01"), Lines{rt_lock});
    EXPECT_TRUE(b.locked());
    Bench off;
    off.setup({"86 00 01 00", "B4 00 01 80"});
    (void)off.send("7E 01");
    EXPECT_EQ(off.ask("95"), "15 00");
}

TEST(TwinInputs, HomingAsTheManualCombinesIt) {
    // Jog towards the switch; IN1 rising: origin, then back by |PR|; one time.
    Bench b;
    b.setup({"98 02", "9E E8 03 00 00", "98 02", "9F C8 00 00 00", "B5 00 61 EA", "B4 00 80 84", "95 01", "9D D0 07 00 00", "96"});
    b.pass_ms(3000);
    EXPECT_EQ(b.inputs(1), Lines{"5A 02"});
    b.pass_ms(100);
    b.inputs(0);
    b.pass_ms(5000);
    EXPECT_EQ(b.position(), -200);
    EXPECT_TRUE(b.in_position());
    EXPECT_EQ(b.ask("B4 00"), "34 00 00 00");
}

TEST(TwinInputs, SpeedZeroInAGroupStops) {
    // A switch whose group was never given a speed must not let the axis run on.
    for (const int action : {0x07, 0x08, 0x09, 0x0A, 0x0B}) {
        Rig r(edges[1], action, 0);
        r.run(10000);
        (void)r.trigger();
        EXPECT_TRUE(r.b.pass_ms(2100).empty());
        EXPECT_TRUE(r.b.stopped()) << action;
    }
}

}  // namespace
}  // namespace axisgate::uim342::test
