// Twin, motion: acknowledgements of moves, one command in progress, watchdog, limits, reference, conditions, interruption, measuring.
// In: commands, hand, time. Out: positions, statuses and errors as told on the wire.
#include <cmath>

#include "adapters/pacontrol/tests/twin_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

// Defaults of the profile: 500 AE/s, 1000 AE/s^2, no start-stop speed: a ramp of 0.5 s over 125 AE.

// T-05: first the start position, growing ones at the polls, the last with BE = 1.
TEST(TwinMotion, AbsoluteMoveIsPolled) {
    Bench b;
    b.online();
    b.good("0A86;2;1;100");
    Fields f = b.get("0A87;2;1;1100");
    EXPECT_EQ(f.text, "0;0;31;0;1;100.0000");
    double before = f.data;
    int polls = 0;
    for (; polls < 100; ++polls) {
        b.pass(100ms);
        f = b.get_poll();
        if (f.end == 1) break;
        EXPECT_GT(f.data, before);
        EXPECT_EQ(f.type, 1);
        before = f.data;
    }
    EXPECT_EQ(f.text, "0;1;31;0;1;1100.000");
    EXPECT_EQ(polls, 24) << "1000 AE at 500 AE/s and a ramp of 0.5 s: 2.5 s";
    EXPECT_EQ(b.get("0A89;2;1;-50").text, "0;0;31;0;1;1100.000");
    b.pass(3s);
    EXPECT_EQ(b.poll(), "0;1;31;0;1;1050.000");
}

// T-06, E-69: only polls and stops while it runs; after 0A94 everything.
TEST(TwinMotion, OneCommandInProgress) {
    Bench b;
    b.online();
    EXPECT_EQ(b.get("0A87;1;1;1000").end, 0);
    for (const char* other : {"1900;5;0;0", "0A94;2;1;10", "0906;1;0;1", "0A92;1;0;0", "0602;0;0;0"})
        EXPECT_EQ(b.quit(other), 20) << other;
    EXPECT_EQ(b.get_poll().end, 0) << "the move goes on, the poll is about it";
    EXPECT_EQ(b.quit("9999;0;0;0"), 19);
    b.pass(500ms);
    EXPECT_EQ(b.get("0A93;1;0;0").end, 0) << "standstill takes a ramp";
    b.pass(2s);
    const Fields f = b.get_poll();
    EXPECT_EQ(f.end, 1);
    EXPECT_EQ(b.axis_status(1), 2) << "stopped";
    EXPECT_EQ(f.data, b.position(1));
    b.good("0A94;1;1;1000");
    EXPECT_EQ(b.value("1911;0;0;0"), 1);
    b.good("0A95;3;1;50");
    EXPECT_EQ(b.value("1911;0;0;0"), 5) << "two axes at once";
    EXPECT_EQ(b.quit("0A94;1;1;0"), 42) << "still moves";
    b.stand(1);
    EXPECT_EQ(b.axis_status(1), 0);
    EXPECT_EQ(b.axis_status(3), 0);
}

TEST(TwinMotion, StopAtOnceOrAtStandstill) {
    Bench b;
    b.online();
    b.good("0A94;1;1;1000");
    b.pass(1s);
    EXPECT_EQ(b.get("0A9A;1;0;0").end, 1) << "does not wait";
    EXPECT_EQ(b.axis_status(1), 1);
    b.pass(600ms);
    EXPECT_EQ(b.axis_status(1), 2);
    EXPECT_EQ(b.get("0A93;1;0;0").end, 1) << "stands already";
}

// 0600 and 0A81 pass a move in progress.
TEST(TwinMotion, StopAndCancelPassAMoveInProgress) {
    Bench b;
    b.online();
    EXPECT_EQ(b.get("0A87;1;1;1000").end, 0);
    b.pass(500ms);
    EXPECT_EQ(b.quit("0600;0;0;0"), 0);
    b.pass(1s);
    EXPECT_EQ(b.get_poll().status, 35);
    EXPECT_EQ(b.quit("0A81;0;0;0"), 0);
    EXPECT_EQ(b.status(), 1);
}

// T-07: a manual move lives by 0A92.
TEST(TwinMotion, ManualMoveIsWatched) {
    Bench b;
    b.online();
    EXPECT_EQ(b.ask("0A90;1;1;100"), "0;1;31;0;1;0.000000") << "acknowledged at once with the start position";
    for (int i = 0; i < 4; ++i) {
        b.pass(900ms);
        EXPECT_GT(b.value("0A92;1;0;0"), 15.0 * (i + 1));
        EXPECT_EQ(b.axis_status(1), 1);
    }
    b.pass(1100ms);
    EXPECT_EQ(b.axis_status(1), 2) << "1 s and a ramp of 20 ms";
    EXPECT_NEAR(b.position(1), 20 * 4.6, 1) << "20 AE/s, the manual speed (E-32)";
    EXPECT_EQ(b.get("0A91;1;1;1").end, 1);
    b.pass(500ms);
    EXPECT_EQ(b.axis_status(1), 0) << "a short way ends by itself";

    Bench fast(setup(1, {{"manual_speed", "traverse"}}));
    fast.online();
    fast.good("0A90;1;1;100");
    fast.pass(700ms);
    EXPECT_EQ(fast.position(1), 100);
}

// T-16: G26 keeps the software limits, G29 takes them along.
TEST(TwinMotion, LimitsAndTheirShift) {
    Bench b;
    b.good("0800;265;1;500");
    b.good("0800;264;1;-500");
    b.online();
    EXPECT_EQ(b.quit("0A94;1;1;501"), 65);
    b.good("0A86;1;1;100");
    EXPECT_EQ(b.position(1), 100);
    EXPECT_EQ(b.quit("0A94;1;1;610"), 65);
    b.good("0A94;1;1;550");
    b.stand(1);
    b.good("0A85;1;0;0");
    EXPECT_EQ(b.position(1), 0);
    EXPECT_EQ(b.quit("0A94;1;1;610"), 65) << "G26 does not move them: -400..600 since the G29";
    EXPECT_EQ(b.value("1914;1;1;0"), 500) << "the stored parameter (E-68)";
    b.home();
    b.online();
    Bench c;
    c.good("0800;265;1;500");
    c.online();
    c.good("0A94;1;1;200");
    c.stand(1);
    c.good("0A85;1;0;0");
    EXPECT_EQ(c.quit("0A94;1;1;510"), 65);
    c.good("0A94;1;1;490");
    c.stand(1);
    c.good("0A96;1;1;-20");
    EXPECT_EQ(c.position(1), -20);
    EXPECT_EQ(c.quit("0A95;1;1;530"), 65) << "relative targets are checked too";
    c.good("0A95;1;1;510");
}

TEST(TwinMotion, ReferenceIsDemanded) {
    Bench b(setup(2, {{"absolute", "off"}}));
    b.online();
    EXPECT_EQ(b.value("1934;51;0;0"), 0);
    EXPECT_EQ(b.quit("0A94;1;1;10"), 43);
    EXPECT_EQ(b.quit("0A94;1;1;99999"), 65) << "value before state";
    b.good("0A86;1;1;50");
    EXPECT_EQ(b.value("1934;51;0;0"), 0) << "G29 does not reference";
    b.good("0A83;1;0;0");
    EXPECT_EQ(b.value("1934;51;0;0"), 1);
    EXPECT_EQ(b.position(1), 50) << "released, position unchanged";
    b.good("0A85;2;0;0");
    EXPECT_EQ(b.value("1934;52;0;0"), 1) << "E-34";
    b.good("0A94;2;1;10");
}

TEST(TwinMotion, ReferenceRun) {
    Bench b(setup(2, {{"absolute", "off"}}), {{"axis1.shaft", 40.0}, {"axis2.shaft", -3.0}});
    b.online();
    Fields f = b.get("0A84;1;0;0");
    EXPECT_EQ(f.end, 0) << "end of processing is the end of the run (E-30)";
    EXPECT_EQ(f.type, 0);
    EXPECT_EQ(b.quit("1900;1;0;0"), 20);
    b.pass(400ms);
    EXPECT_LT(b.control().axis(1).shaft().velocity(b.now), -49) << "reference speed";
    b.pass(2s);
    f = b.get_poll();
    EXPECT_EQ(f.end, 1);
    EXPECT_EQ(f.quit, 0);
    EXPECT_EQ(b.position(1), 0);
    EXPECT_EQ(b.value("1934;51;0;0"), 1);
    EXPECT_NEAR(b.twin().mechanics(1, b.now).position, 0, 1e-6) << "stands at the edge of the switch";
    EXPECT_EQ(b.get("0A84;2;0;0").end, 0) << "from within the switch";
    b.pass(5s);
    EXPECT_EQ(b.get_poll().quit, 0);
    EXPECT_NEAR(b.twin().mechanics(2, b.now).position, 0, 1e-6);
}

TEST(TwinMotion, ReferenceRunByHand) {
    Bench b(setup(1, {{"absolute", "off"}}), {{"axis1.shaft", 1000.0}});
    b.online();
    b.get("0A84;1;0;0");
    b.pass(1s);
    b.hand("home_switch", true);
    b.pass(500ms);
    EXPECT_EQ(b.get_poll().end, 0) << "creeps off the switch";
    b.hand("home_switch", false);
    b.pass(500ms);
    EXPECT_EQ(b.get_poll().text, "0;1;31;0;0;0");
    EXPECT_EQ(b.value("1934;51;0;0"), 1);
    // A switch that is never left.
    b.hand("home_switch", true);
    b.get("0A84;1;0;0");
    b.pass(60s);
    const Fields f = b.get_poll();
    EXPECT_EQ(f.end, 1);
    EXPECT_NE(f.quit, 0);
    EXPECT_EQ(f.status, 39);
    EXPECT_EQ(f.error, 525);
    EXPECT_EQ(b.value("1934;51;0;0"), 0);
}

TEST(TwinMotion, StopOfAReferenceRun) {
    Bench b(setup(1, {{"absolute", "off"}}), {{"axis1.shaft", 1000.0}});
    b.online();
    b.get("0A84;1;0;0");
    b.pass(1s);
    EXPECT_EQ(b.quit("0A93;1;0;0"), 0);
    b.pass(1s);
    EXPECT_EQ(b.get_poll().end, 1);
    EXPECT_EQ(b.value("1934;51;0;0"), 0);
    EXPECT_EQ(b.axis_status(1), 2);
}

// Limit switches: into one E529 (serial: 37, 39); towards one 40h; away from it free; monitoring off passes over.
TEST(TwinMotion, LimitSwitches) {
    Bench b;
    b.online();
    EXPECT_EQ(b.get("0A87;1;1;1000").end, 0);
    b.pass(1s);
    b.hand("limit_positive", true);
    const Fields f = b.get_poll();
    EXPECT_EQ(f.end, 1);
    EXPECT_EQ(f.quit, 64);
    EXPECT_EQ(f.error, 529);
    EXPECT_EQ(f.status, 39);
    EXPECT_EQ(b.axis_status(1), 4);
    EXPECT_EQ(b.value("1921;1;0;0"), 0x01000104) << "ready, positive reached, negative free, malfunction [L3186]";
    b.home();
    EXPECT_EQ(b.axis_status(1), 2);
    b.online();
    EXPECT_EQ(b.quit("0A94;1;1;5000"), 64);
    b.good("0A94;1;1;0");
    b.pass(200ms);
    EXPECT_EQ(b.axis_status(1), 1) << "away from it";
    b.stand(1);
    b.good("0AA2;1;0;0");
    b.good("0A94;1;1;300");
    b.stand(1);
    EXPECT_EQ(b.position(1), 300);
    b.home();
    b.online();
    EXPECT_EQ(b.quit("0A94;1;1;400"), 64) << "T-20: monitoring is on again";
    b.good("0AA2;0;0;0");
    b.good("0A94;1;1;400");
    EXPECT_EQ(b.quit("0AA2;9;0;0"), 32);
    EXPECT_EQ(b.quit("0AA2;1;0;2"), 41);
}

// T-17: 01h is "not actuated".
TEST(TwinMotion, ExtendedStatus) {
    Bench b;
    EXPECT_EQ(b.value("1921;2;0;0"), 0x01010100);
    b.hand("axis2.limit_negative", true);
    EXPECT_EQ(b.value("1921;2;0;0"), 0x01010000);
    b.hand("axis2.power_pack", false);
    EXPECT_EQ(b.value("1921;2;0;0"), 0x00010004);
}

// T-20: overrides end with ONLINE.
TEST(TwinMotion, Overrides) {
    Bench b;
    const auto time_of = [&](double way) {
        const Instant t = b.now;
        EXPECT_EQ(b.get("0A89;1;1;" + std::to_string(way)).end, 0);
        for (int i = 0; i < 100000 && b.control().axis(1).running(); ++i)
            b.pass(1ms);
        b.poll();
        return seconds(b.now - t);
    };
    b.online();
    EXPECT_NEAR(time_of(1000), 2.5, 0.002);
    b.good("0A8D;1;1;250");
    EXPECT_NEAR(time_of(1000), 4.25, 0.002);
    b.good("0A8E;1;1;100");
    EXPECT_NEAR(time_of(1000), 4 + 2.5, 0.002);
    EXPECT_EQ(b.quit("0A8D;1;1;0"), 41);
    EXPECT_EQ(b.quit("0A8D;1;1;100001"), 41);
    EXPECT_EQ(b.quit("0A8E;1;1;-1"), 41);
    b.home();
    b.online();
    EXPECT_NEAR(time_of(1000), 2.5, 0.002);
}

TEST(TwinMotion, SpeedWhileMoving) {
    Bench ep;
    ep.online();
    ep.good("0A94;1;1;5000");
    ep.pass(1s);
    ep.good("0A8D;1;1;100");
    ep.pass(1s);
    EXPECT_NEAR(ep.value("190D;1;1;0"), 100, 1e-3);
    ep.stand(1);
    EXPECT_EQ(ep.position(1), 5000);
    Bench other(setup(1, {{"model", "other"}}));
    other.online();
    other.good("0A94;1;1;5000");
    EXPECT_EQ(other.quit("0A8D;1;1;100"), 42) << "while moving only on the EP [L3496]";
    EXPECT_EQ(other.quit("1915;1;1;0"), 21);
    EXPECT_EQ(other.quit("1920;1;1;0"), 21);
    EXPECT_EQ(other.quit("190F;1;1;0"), 21);
}

// T-23: not fulfilled at the start: finished without motion and without error. Lost under way: stands, for the next move only.
TEST(TwinMotion, Conditions) {
    Bench b;
    b.online();
    b.good("0AA3;1;0;16842757");  // while input 5 = 1
    EXPECT_EQ(b.ask("0A87;1;1;1000"), "0;1;31;0;1;0.000000");
    EXPECT_TRUE(b.control().axis(1).traverse().stopped_by_condition());
    EXPECT_EQ(b.axis_status(1), 2);
    b.hand("I5", true);
    b.good("0AA3;1;0;16842757");
    EXPECT_EQ(b.get("0A87;1;1;1000").end, 0);
    b.pass(1s);
    EXPECT_EQ(b.get_poll().end, 0);
    b.hand("I5", false);
    b.pass(1s);
    const Fields f = b.get_poll();
    EXPECT_EQ(f.end, 1);
    EXPECT_EQ(f.quit, 0);
    EXPECT_LT(f.data, 1000);
    EXPECT_EQ(b.get("0A87;1;1;1000").end, 0) << "the next move has no condition";
    b.pass(5s);
    EXPECT_EQ(b.get_poll().data, 1000);
    b.good("0AA3;0;0;" + std::to_string(0x00030007));  // all axes, while flag 7 = 0
    b.good("0A94;2;1;1000");
    b.pass(200ms);
    EXPECT_EQ(b.axis_status(2), 1);
    b.good("0904;7;0;1");
    b.pass(1s);
    EXPECT_EQ(b.axis_status(2), 2);
    for (const auto& [data, quit] : std::vector<std::pair<int, int>>{
             {0x01010401, 35}, {0x01020401, 36}, {0x01030401, 37}, {0x01040001, 41}, {0x02010001, 41}, {0x01010000, 35}})
        EXPECT_EQ(b.quit("0AA3;1;0;" + std::to_string(data)), quit) << data;
}

TEST(TwinMotion, OffInterruptsAndOnGoesOnByTheMode) {
    struct Case {
        const char* mode;
        bool goes_on;
    };
    for (const Case& c : {Case{"0", false}, Case{"1", true}, Case{"3", true}, Case{"4", true}}) {
        Bench b(setup(1, {{"switch_on_mode", c.mode}}));
        b.online();
        b.good("0A94;1;1;1000");
        b.pass(1s);
        b.good("0A98;1;0;0");
        b.pass(1s);
        const double stood = b.position(1);
        EXPECT_LT(stood, 1000);
        EXPECT_FALSE(b.twin().mechanics(1, b.now).powered);
        EXPECT_EQ(b.quit("0A94;1;1;0"), 55) << "not switched on";
        EXPECT_EQ(b.value("1937;51;1;0") > 0, true) << "SR51";
        b.good("0A97;1;0;0");
        EXPECT_EQ(b.axis_status(1), c.goes_on ? 1 : 2) << c.mode;
        b.pass(5s);
        EXPECT_EQ(b.position(1), c.goes_on ? 1000 : stood) << c.mode;
    }
}

TEST(TwinMotion, DisplacedWhileOff) {
    Bench b(setup(1, {{"switch_on_mode", "4"}, {"max_displacement", "2"}}));
    b.online();
    b.refused("position", std::int64_t{5000});
    b.good("0A98;1;0;0");
    b.hand("position", std::int64_t{1500});
    b.good("0A97;1;0;0");
    b.good("0A94;1;1;0");
    b.stand(1);
    b.good("0A98;1;0;0");
    b.hand("position", std::int64_t{5000});
    EXPECT_EQ(b.position(1), 5) << "the encoder sees it";
    b.good("0A97;1;0;0");
    EXPECT_EQ(b.quit("0A94;1;1;0"), 56);
    EXPECT_TRUE(b.control().axis(1).state().displaced);
    b.home();
    b.online();
    b.good("0A94;1;1;0");
}

TEST(TwinMotion, EnableModes) {
    const std::vector<std::pair<int, AxisPower>> modes{
        {0, AxisPower::idle}, {1, AxisPower::idle}, {2, AxisPower::halt}, {3, AxisPower::safe}};
    for (const auto& [mode, state] : modes) {
        Bench b(setup(1));
        b.good("0800;306;1;" + std::to_string(mode));
        b.online();
        b.good("0A97;1;0;0");
        b.good("0A98;1;0;0");
        EXPECT_EQ(b.control().axis(1).state().power, state) << mode;
        b.home();
        EXPECT_EQ(b.control().axis(1).state().power == AxisPower::on, mode == 1) << "1: operational again after ONLINE [L722]";
    }
}

TEST(TwinMotion, AHeldShaft) {
    Bench b;
    b.online();
    EXPECT_EQ(b.get("0A87;1;1;1000").end, 0);
    b.pass(1s);
    b.hand("stall", true);
    const double held = b.twin().mechanics(1, b.now).position / 1000;
    b.pass(10ms);
    EXPECT_NEAR(b.control().axis(1).shaft().lag(b.now), 5, 0.01);
    b.pass(1s);
    const Fields f = b.get_poll();
    EXPECT_EQ(f.end, 1);
    EXPECT_NE(f.quit, 0);
    EXPECT_EQ(f.status, 39);
    EXPECT_NE(f.error, 0);
    EXPECT_NEAR(f.data, held, 1e-3) << "the encoder knows where it stands";
    EXPECT_EQ(b.axis_status(1), 4);
    b.home();
    EXPECT_EQ(b.value("1909;0;0;0"), 0);
}

TEST(TwinMotion, FollowingErrorByHand) {
    Bench b;
    b.hand("following_error", std::int64_t{5000});
    EXPECT_NEAR(b.value("1915;1;1;0"), 5.0 / 10 * 3200, 1e-3) << "microsteps (E-27)";
    EXPECT_EQ(b.value("1909;0;0;0"), 0);
    b.hand("following_error", std::int64_t{10001});
    EXPECT_NE(b.value("1909;0;0;0"), 0);
    EXPECT_EQ(b.axis_status(1), 4);
}

TEST(TwinMotion, MeasuringMode) {
    Bench b;
    b.online();
    b.good("0AA1;1;0;0");  // T-26: not in the mode: acknowledged, nothing done
    EXPECT_EQ(b.axis_status(1), 0);
    b.good("0AA0;1;0;0");
    EXPECT_EQ(b.axis_status(1), 8);
    EXPECT_EQ(b.quit("0A94;1;1;10"), 46);
    b.hand("position", std::int64_t{3250});
    EXPECT_EQ(b.position(1), 0);
    EXPECT_EQ(b.value("190E;1;1;0"), 3.25) << "the encoder stays alive";
    b.good("0AA1;1;0;0");
    EXPECT_EQ(b.position(1), 3.25) << "take-over (parameter 23h)";
    b.good("0A94;1;1;100");
    EXPECT_EQ(b.quit("0AA0;1;0;0"), 42);
    b.stand(1);
    Bench none(setup(1, {{"measuring", "off"}}));
    none.online();
    EXPECT_EQ(none.quit("0AA0;1;0;0"), 108);
}

TEST(TwinMotion, MeasuringEndsWithSynchronisation) {
    Bench b;
    b.good("0800;290;1;1");  // 22h; 500 pulses on 10 AE: an edge each 0.005 AE
    b.online();
    b.good("0AA0;1;0;0");
    b.hand("position", std::int64_t{3252});
    b.good("0AA1;1;0;0");
    EXPECT_NEAR(b.position(1), 3.255, 1e-6) << "the next edge in positive direction";
    b.good("0AA0;1;0;0");
    b.hand("encoder_broken", true);
    EXPECT_NE(b.quit("0AA1;1;0;0"), 0);
    EXPECT_EQ(b.value("1909;0;0;0"), 560);
}

// T-19: with the axis extension an axis error is its own; axis commands of the CMD interface are refused.
TEST(TwinMotion, AxisModules) {
    Bench b(setup(2, {{"axis_modules", "on"}}));
    b.online();
    EXPECT_EQ(b.quit("0A87;1;1;10"), 20);
    EXPECT_EQ(b.quit("0A97;1;0;0"), 20);
    AxisTask task;
    task.value = 1000;
    EXPECT_EQ(b.control().motions().start_task(1, task, b.now), 0);
    EXPECT_EQ(b.control().motions().start_task(2, task, b.now), 0);
    b.pass(500ms);
    b.hand("limit_positive", true);
    EXPECT_EQ(b.axis_status(1), 4);
    EXPECT_EQ(b.axis_status(2), 1);
    EXPECT_EQ(b.status(), 31);
    EXPECT_EQ(b.value("1909;0;0;0"), 0);
    EXPECT_EQ(b.control().axis(1).state().fault, 529);
    b.hand("limit_positive", false);
    b.control().operation().reset_axis_error(1, b.now);
    EXPECT_EQ(b.control().motions().start_task(1, task, b.now), 0);
}

// T-22: values of the module interface.
TEST(TwinMotion, ModuleSpeedsAndRamps) {
    Bench b(setup(1, {{"axis_modules", "on"}}));
    b.online();
    const auto start = [&](std::uint32_t acceleration, std::uint32_t speed) {
        AxisTask task;
        task.kind = AxisTask::Kind::relative;
        task.value = 10;
        task.acceleration_permille = acceleration;
        task.speed_permille = speed;
        return b.control().motions().start_task(1, task, b.now);
    };
    EXPECT_EQ(start(1000, 0), 41);
    EXPECT_EQ(start(1000, 1001), 41);
    EXPECT_EQ(start(0, 1000), 41);
    EXPECT_EQ(start(65536, 1000), 41);
    const auto time = [&] {
        const Instant t = b.now;
        for (int i = 0; i < 10000 && b.control().axis(1).running(); ++i)
            b.pass(1ms);
        return seconds(b.now - t);
    };
    ASSERT_EQ(start(1000, 1000), 0);
    const double one = time();
    ASSERT_EQ(start(4000, 1000), 0);
    EXPECT_NEAR(time(), one / 2, 0.002) << "above 1000 per mill is legal: a quarter of the time squared";
}

TEST(TwinMotion, FreeTraverseNeedsNoReference) {
    Bench b(setup(1, {{"absolute", "off"}, {"axis_modules", "on"}}));
    b.online();
    AxisTask task;
    task.kind = AxisTask::Kind::free_positive;
    task.value = 20'000;  // past the software limit
    EXPECT_EQ(b.control().motions().start_task(1, task, b.now), 0);
    b.pass(500ms);
    b.control().motions().interrupt_axis(1, b.now);
    b.stand(1);
    task.kind = AxisTask::Kind::absolute;
    task.value = 10;
    EXPECT_EQ(b.control().motions().start_task(1, task, b.now), 43);
    task.kind = AxisTask::Kind::free_positive;
    task.value = -5;
    EXPECT_EQ(b.control().motions().start_task(1, task, b.now), 65) << "not in that direction";
    task.kind = AxisTask::Kind::to_max;
    EXPECT_EQ(b.control().motions().start_task(1, task, b.now), 43);
}

TEST(TwinMotion, DeleteG29) {
    Bench b;
    b.online();
    b.good("0A86;1;1;100");
    AxisTask task;
    task.kind = AxisTask::Kind::delete_g29;
    EXPECT_EQ(b.control().motions().start_task(1, task, b.now), 0);
    EXPECT_EQ(b.position(1), 0);
    EXPECT_EQ(b.quit("0A94;1;1;10050"), 65);
}

// The ramp law (E-33): trapezoid, triangle, start-stop speed; the place is what the speed integrates to.
TEST(TwinMotion, PathsAreConsistent) {
    struct Case {
        double x0, x1, entry, speed, floor, a;
    };
    for (const Case& c :
         {Case{0, 1000, 0, 500, 0, 1000}, Case{0, 10, 0, 500, 0, 1000}, Case{100, -50, 0, 20, 5, 100}, Case{0, 1000, 300, 100, 0, 1000},
          Case{0, 10, 300, 100, 0, 1000}, Case{0, 3, 0, 2, 10, 50}, Case{5, 5, 0, 1, 0, 1}}) {
        const Path p = Path::to(c.x0, c.x1, c.entry, c.speed, c.floor, c.a, time_zero);
        EXPECT_EQ(p.position(p.end()), c.x1);
        EXPECT_EQ(p.velocity(p.end()), 0);
        const double total = seconds(p.end() - time_zero);
        double x = c.x0;
        const int steps = 20000;
        for (int i = 0; i < steps; ++i) {
            const auto at = [&](double k) { return time_zero + Duration{static_cast<std::int64_t>(total * 1e9 * k / steps)}; };
            x += p.velocity(at(i + 0.5)) * total / steps;
            if (i % 1000 == 999) {
                EXPECT_NEAR(p.position(at(i + 1)), x, 0.02 + std::abs(c.x1 - c.x0) * 1e-3);
                const Instant when = p.when(p.position(at(i + 1)));
                EXPECT_NEAR(seconds(when - time_zero), seconds(at(i + 1) - time_zero), 1e-4 * (1 + total));
            }
        }
    }
    EXPECT_EQ(Path::to(0, 10, 0, 1, 0, 1, time_zero).when(11), never);
    EXPECT_EQ(Path::to(0, 10, 0, 1, 0, 1, time_zero).when(-1), never);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
