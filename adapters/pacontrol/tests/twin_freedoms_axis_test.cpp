// The freedoms of the twin, part two: what an axis does and shows, and its mechanics. Positions are in AE; one increment is 0.001 AE.
#include "adapters/pacontrol/tests/twin_freedoms_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

/// True position of axis 1, AE.
double place(Bench& b) { return b.twin().mechanics(1, b.now).position / 1000; }
double encoder(Bench& b) { return b.value("190E;1;1;0"); }
int mask(Bench& b) { return static_cast<int>(b.value("1911;0;0;0")); }

// --- what it does, and what it shows of that ---

TEST(TwinFreedomsAxis, AMotionBeginsLate) {
    Bench b(specimen_with({{"motion_start_ms", 200}}));
    b.online();
    b.good("0A94;1;1;100");
    EXPECT_EQ(b.axis_status(1), 1) << "it has the task";
    b.pass(200ms);
    EXPECT_EQ(b.position(1), 0);
    EXPECT_EQ(b.value("190D;1;1;0"), 0);
    b.pass(100ms);
    EXPECT_NEAR(b.position(1), 5, 0.01) << "1000 AE/s^2 for 0.1 s";
    b.stand(1);
    EXPECT_EQ(b.position(1), 100);
    b.good("0A94;1;1;0");
    b.pass(100ms);
    b.good("0A9A;1;0;0");
    EXPECT_EQ(b.axis_status(1), 2) << "stopped before it has begun";
    b.good("0A84;1;0;0");
    b.pass(200ms);
    EXPECT_NEAR(place(b), 100, 1e-9) << "a reference run, too";
    b.pass(100ms);
    EXPECT_LT(place(b), 99);
}

TEST(TwinFreedomsAxis, TheStatusFollowsLate) {
    Bench b(specimen_with({{"status_late_ms", 300}}));
    b.online();
    b.good("0A94;1;1;100");
    b.pass(299ms);
    EXPECT_EQ(b.axis_status(1), 0);
    EXPECT_EQ(mask(b), 0);
    EXPECT_GT(b.position(1), 10) << "it moves";
    b.pass(1ms);
    EXPECT_EQ(b.axis_status(1), 1);
    EXPECT_EQ(mask(b), 1);
    EXPECT_EQ(static_cast<int>(b.value("1921;1;0;0")) & 0xFF, 1);
    EXPECT_EQ(b.value("1935;71;0;0"), 1);
    while (b.control().axis(1).running())
        b.pass(1ms);
    b.pass(298ms);
    EXPECT_EQ(b.axis_status(1), 1);
    EXPECT_EQ(b.position(1), 100);
    b.pass(3ms);
    EXPECT_EQ(b.axis_status(1), 0);
    EXPECT_EQ(mask(b), 0);
}

TEST(TwinFreedomsAxis, ThePositionIsRefreshedNowAndThen) {
    Bench b(specimen_with({{"position_every_ms", 250}}));
    b.online();
    b.pass(250ms - (b.now - time_zero) % 250ms);
    b.good("0A94;1;1;400");
    b.pass(249ms);
    EXPECT_EQ(b.position(1), 0);
    b.pass(1ms);
    const double first = b.position(1);
    EXPECT_NEAR(first, 31.25, 0.01);
    b.pass(200ms);
    EXPECT_EQ(b.position(1), first);
    b.stand(1);
    const Instant standing = b.now;
    b.pass(250ms);
    EXPECT_EQ(b.position(1), 400);
    b.good("0A86;1;1;7");
    EXPECT_EQ(b.position(1), (b.now - time_zero) / 250ms > (standing + 250ms - time_zero) / 250ms ? 7 : 400);
    b.pass(250ms);
    EXPECT_EQ(b.position(1), 7);
}

TEST(TwinFreedomsAxis, ThePositionIsTheEncoders) {
    Bench counter(specimen_with({{"follow_ms", 4}})), measured(specimen_with({{"follow_ms", 4}, {"measured_position", 1}}));
    for (Bench* b : {&counter, &measured}) {
        b->online();
        b->good("0A94;1;1;2000");
        b->pass(1s);
    }
    EXPECT_NEAR(counter.position(1), 375, 0.01);
    EXPECT_NEAR(measured.position(1), 371.25, 0.5) << "about 4 AE behind";
}

TEST(TwinFreedomsAxis, AReferenceRunIsAcknowledgedAtOnce) {
    Bench b(specimen_with({{"reference_acknowledged", 1}, {"absolute_system", 0}}));
    b.online();
    EXPECT_EQ(b.get("0A84;1;0;0").text, "0;1;31;0;0;0");
    EXPECT_EQ(b.axis_status(1), 1) << "no command is in progress, so others are taken";
    EXPECT_EQ(b.value("1934;51;0;0"), 0);
    b.stand(1);
    EXPECT_EQ(b.value("1934;51;0;0"), 1);
}

TEST(TwinFreedomsAxis, AReferenceRunIsNotShown) {
    Bench b(specimen_with({{"reference_status", 0}, {"reference_acknowledged", 1}, {"absolute_system", 0}}));
    b.online();
    b.good("0A84;1;0;0");
    EXPECT_TRUE(b.control().axis(1).running());
    EXPECT_EQ(b.axis_status(1), 0);
    EXPECT_EQ(mask(b), 0);
    EXPECT_EQ(b.quit("0A94;1;1;1"), 42) << "it moves all the same";
    b.stand(1);
    b.good("0A94;1;1;100");
    EXPECT_EQ(b.axis_status(1), 1) << "other motions are shown";
}

TEST(TwinFreedomsAxis, AnAxisIsOnLate) {
    for (const int awaited : {0, 1}) {
        SCOPED_TRACE(awaited);
        Bench b(specimen_with({{"axis_on_ms", 400}, {"axis_on_acknowledged", awaited}}));
        b.online();
        b.good("0A98;1;0;0");
        EXPECT_EQ(b.get("0A97;1;0;0").end, awaited == 0 ? 1 : 0);
        b.pass(399ms);
        EXPECT_EQ(b.get_poll().end, awaited == 0 ? 1 : 0);
        EXPECT_EQ(b.quit("0A94;1;1;5"), 55);
        EXPECT_FALSE(b.twin().mechanics(1, b.now).powered);
        b.pass(1ms);
        EXPECT_EQ(b.quit("0A94;1;1;5"), 0);
        b.stand(1);
        b.good("0A98;1;0;0");
        b.good("0A97;1;0;0");
        b.pass(100ms);
        b.good("0A98;1;0;0");
        b.pass(1s);
        EXPECT_FALSE(b.twin().mechanics(1, b.now).powered) << "switched off meanwhile";
    }
}

TEST(TwinFreedomsAxis, ReferencesThatGo) {
    const auto referenced = [](Bench& b) { return b.value("1934;51;0;0"); };
    Bench b(specimen_with({{"absolute_system", 0}, {"reference_outlives", 0}, {"null_references", 0}}));
    Bench zero(specimen_with({{"absolute_system", 0}}));
    for (Bench* x : {&b, &zero}) {
        x->online();
        EXPECT_EQ(referenced(*x), 0) << "no absolute system";
        x->good("0A85;1;0;0");
    }
    EXPECT_EQ(referenced(zero), 1);
    EXPECT_EQ(referenced(b), 0);
    b.good("0A96;1;1;0.0");
    EXPECT_EQ(referenced(b), 1);
    b.home();
    zero.home();
    EXPECT_EQ(referenced(zero), 1);
    EXPECT_EQ(referenced(b), 0);
}

TEST(TwinFreedomsAxis, SwitchesHaveHysteresis) {
    for (const std::int64_t wide : {0, 200}) {
        SCOPED_TRACE(wide);
        Bench b(specimen_with({{"switch_hysteresis_increments", wide}}, 1, {{"travel", "-50:50"}}));
        const auto closed = [&] { return (static_cast<int>(b.value("1921;1;0;0")) & 0x10000) == 0; };
        b.online();
        b.good("0A94;1;1;49.9");
        b.stand(1);
        EXPECT_FALSE(closed()) << "it has not been on it";
        b.good("0A94;1;1;60");
        b.pass(2s);
        EXPECT_TRUE(closed());
        EXPECT_NEAR(place(b), 50, 1e-3);
        b.home();
        b.online();
        b.good("0A94;1;1;49.9");
        b.stand(1);
        EXPECT_EQ(closed(), wide != 0);
        EXPECT_EQ(b.quit("0A94;1;1;49.95"), wide != 0 ? 64 : 0);
        b.stand(1);
        b.good("0A94;1;1;49.7");
        b.stand(1);
        EXPECT_FALSE(closed());
        b.good("0A94;1;1;-1");
        b.stand(1);
        b.good("0A94;1;1;0.1");
        b.stand(1);
        EXPECT_EQ(b.control().axis(1).switches().home(), wide != 0);
        b.good("0A84;1;0;0");
        b.stand(1);
        EXPECT_EQ(b.value("1934;51;0;0"), 1);
        EXPECT_NEAR(place(b), 0, 1e-3) << "a reference run ends at the edge where it closes";
    }
}

// --- mechanics ---

TEST(TwinFreedomsAxis, TheShaftFollows) {
    Bench b(specimen_with({{"follow_ms", 4}}));
    b.online();
    b.good("0A94;1;1;2000");
    b.pass(1s);
    EXPECT_NEAR(place(b), 371.25, 0.5) << "2 * 4 ms at 500 AE/s behind 375";
    EXPECT_NEAR(b.value("1915;1;1;0"), 3.75 / 10 * 3200, 160);
    EXPECT_NEAR(b.value("190D;1;1;0"), 500, 0.1);
    b.pass(10s);
    EXPECT_NEAR(place(b), 2000, 1e-3);
    EXPECT_NEAR(b.value("190F;1;1;0"), 3.75 / 10 * 3200, 160);
}

TEST(TwinFreedomsAxis, TheShaftOvershoots) {
    const auto farthest = [](std::int64_t damping) {
        Bench b(specimen_with({{"follow_ms", 8}, {"damping_percent", damping}}));
        b.online();
        b.good("0A94;1;1;100");
        double most = 0;
        for (int i = 0; i < 2000; ++i) {
            b.pass(1ms);
            most = std::max(most, place(b));
        }
        EXPECT_NEAR(place(b), 100, 2e-3);
        return most;
    };
    EXPECT_LT(farthest(100), 100.002);
    EXPECT_GT(farthest(40), 100.01);
}

TEST(TwinFreedomsAxis, AWeakMotorEndsInTheFollowingError) {
    Bench b(specimen_with({{"most_acceleration", 1'200'000}})), strong(specimen_with({{"most_acceleration", 8'000'000}}));
    for (Bench* x : {&b, &strong}) {
        x->online();
        x->good("0A8E;1;1;2400");
        x->good("0A94;1;1;1000");
        x->pass(300ms);
    }
    EXPECT_EQ(b.axis_status(1), 4) << "10 AE behind after 0.13 s at half the acceleration";
    EXPECT_EQ(b.get("1909;0;0;0").data, 531);
    EXPECT_EQ(b.status(), 39);
    const double here = place(b);
    EXPECT_LT(here, 15);
    b.pass(1s);
    EXPECT_NEAR(place(b), here, 1e-3) << "it stands";
    EXPECT_NEAR(b.position(1), here, 1e-3) << "and the encoder's position is taken over";
    EXPECT_EQ(strong.axis_status(1), 1);
    strong.pass(10s);
    EXPECT_NEAR(place(strong), 1000, 1e-3);
    b.home();
    b.online();
    b.good("0A8E;1;1;100");
    b.good("0A8D;1;1;50");
    b.good("0A94;1;1;100");
    b.pass(10s);
    EXPECT_NEAR(place(b), 100, 1e-3) << "it can follow a slow path";
}

TEST(TwinFreedomsAxis, AShaftWithFrictionStopsBesideItsTarget) {
    Bench b(specimen_with({{"follow_ms", 8}, {"friction_increments", 20}})), free(specimen_with({{"follow_ms", 8}}));
    for (Bench* x : {&b, &free}) {
        x->online();
        x->good("0A94;1;1;100");
        x->pass(3s);
    }
    EXPECT_GT(std::abs(place(b) - 100), 1e-3);
    EXPECT_LE(std::abs(place(b) - 100), 0.0201);
    EXPECT_NEAR(place(free), 100, 1e-5);
    EXPECT_EQ(b.twin().deadline(), never) << "at rest nothing has to be looked at";
}

TEST(TwinFreedomsAxis, TheGearHasPlay) {
    Bench b(specimen_with({{"backlash_increments", 50}}));
    const auto at_10 = [&](const char* from) {
        b.good(from);
        b.stand(1);
        b.good("0A94;1;1;10");
        b.stand(1);
        return encoder(b);
    };
    b.online();
    EXPECT_NEAR(at_10("0A94;1;1;0") + 0.05, at_10("0A94;1;1;20"), 1e-4);
}

TEST(TwinFreedomsAxis, TheEncoderIsNoisy) {
    Bench b(specimen_with({{"noise_increments", 3}}));
    std::set<double> seen;
    for (int i = 0; i < 200; ++i) {
        b.pass(3ms);
        seen.insert(encoder(b));
    }
    EXPECT_EQ(seen.size(), 7u);
    EXPECT_NEAR(*seen.begin(), -0.003, 1e-9);
    EXPECT_NEAR(*seen.rbegin(), 0.003, 1e-9);
    EXPECT_EQ(b.position(1), 0) << "the counter is not";
}

TEST(TwinFreedomsAxis, AnAxisWithoutPowerDrifts) {
    Bench b(specimen_with({{"drift_increments", 500}}));
    b.online();
    b.good("0A94;1;1;10");
    b.stand(1);
    b.pass(1s);
    EXPECT_NEAR(place(b), 10, 1e-3);
    b.good("0A98;1;0;0");
    b.pass(200ms);
    EXPECT_GT(place(b), 10.1);
    EXPECT_LT(place(b), 10.4);
    b.pass(3s);
    EXPECT_NEAR(place(b), 10.5, 1e-3);
    EXPECT_NEAR(b.position(1), 10.5, 1e-3) << "the control counts it";
    b.good("0A97;1;0;0");
    b.pass(1s);
    EXPECT_NEAR(place(b), 10.5, 1e-3) << "and holds it where it is";
}

/// All names of the page have a test in these two files.
TEST(TwinFreedomsAxis, EveryFreedomOfThePageHasATest) {
    const std::set<std::string> tested{"reply_ms",
                                       "reply_spread_ms",
                                       "late_per_mille",
                                       "late_ms",
                                       "lost_per_mille",
                                       "chunk_bytes",
                                       "chunk_pause_ms",
                                       "noise_per_mille",
                                       "boot_ms",
                                       "initialise_ms",
                                       "start_ms",
                                       "home_ms",
                                       "busy_ms",
                                       "motion_start_ms",
                                       "status_late_ms",
                                       "position_every_ms",
                                       "measured_position",
                                       "reference_acknowledged",
                                       "reference_status",
                                       "axis_on_ms",
                                       "axis_on_acknowledged",
                                       "switching_commands",
                                       "system_elements",
                                       "ep_functions",
                                       "measuring_mode",
                                       "absolute_system",
                                       "reference_outlives",
                                       "null_references",
                                       "online_resumes",
                                       "excluded_command",
                                       "wrong_mode_error",
                                       "error_shown_ms",
                                       "error_cleared_ms",
                                       "error_message",
                                       "power_on_message",
                                       "io_scan_ms",
                                       "parameter_store_ms",
                                       "idle_poll",
                                       "frame_silence_ms",
                                       "frame_silence_answer",
                                       "real_form",
                                       "reply_check_form",
                                       "request_check_form",
                                       "follow_ms",
                                       "damping_percent",
                                       "most_acceleration",
                                       "friction_increments",
                                       "backlash_increments",
                                       "noise_increments",
                                       "drift_increments",
                                       "switch_hysteresis_increments"};
    std::set<std::string> page;
    for (const Freedom& f : freedoms_page().freedoms())
        page.insert(f.name);
    EXPECT_EQ(page, tested);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
