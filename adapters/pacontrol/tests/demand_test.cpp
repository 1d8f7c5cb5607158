// Where an axis should be, against a control that is scripted: what it refuses, what it does not answer, what moves it by itself.
// In: commands, scripts. Out: source and demand of the feedback, and what was asked on the line.
#include "adapters/pacontrol/tests/fake_bench.hpp"

namespace axisgate::pacontrol::test {
namespace {

constexpr std::uint32_t speed_parameter = 257, start_stop_parameter = 261, ramp_parameter = 262, gear_parameter = 263;  // of axis 1

/// Ten units a second, at once for practical purposes; what 1915 says, if it says anything.
struct Known : Bench {
    explicit Known(double gear = 0, std::optional<double> lag = {}, const std::function<void(Known&)>& before = {}) : Bench(1, 9600) {
        control.axis_parameters = {{speed_parameter, 10}, {start_stop_parameter, 0}, {ramp_parameter, 1e6}, {gear_parameter, gear}};
        control.axes[0].lag = lag;
        if (before) before(*this);
        start();
        EXPECT_EQ(enable().outcome, Outcome::accepted);
        run(500ms);
    }
    DemandSource source() const { return last_feedback.at(AxisId{0}).demand_source; }
    std::int64_t behind() { return feedback().position_demand - feedback().position; }
    std::size_t asked(const std::string& head) const {
        return static_cast<std::size_t>(std::ranges::count_if(sent, [&](const Sent& s) { return s.text.starts_with(head); }));
    }
};

TEST(PacontrolDemand, AShaftThatIsHeldFallsBehindTheComputedDemand) {
    for (const int sign : {1, -1}) {
        Known b;
        EXPECT_EQ(b.source(), DemandSource::computed);
        b.command(absolute(sign * 100'000));
        b.run(2s);
        EXPECT_LE(std::llabs(b.behind()), 10 * 4) << "10 increments/ms, acknowledgements of different length";
        b.control.axes[0].held = true;
        b.run(1s);
        EXPECT_NEAR(static_cast<double>(sign * b.behind()), 10'000, 10 * 200) << "told within the last cycle";
        b.run(1s);
        EXPECT_NEAR(static_cast<double>(sign * b.behind()), 20'000, 10 * 200);
        EXPECT_EQ(b.source(), DemandSource::computed);
    }
}

TEST(PacontrolDemand, MicrostepsAreTurnedIntoIncrementsByTheGear) {
    for (const double lag : {320.0, -320.0}) {
        Known b(5, lag);  // a tenth of a revolution of 5 units
        EXPECT_EQ(b.source(), DemandSource::drive);
        EXPECT_EQ(b.feedback().position_demand, 0) << "190C is the step motor's counter";
        EXPECT_EQ(b.feedback().position, lag > 0 ? -500 : 500);
        EXPECT_TRUE(good(b.ask(absolute(20'000), true)));
        EXPECT_EQ(b.feedback().position_demand, 20'000);
        EXPECT_EQ(b.behind(), lag > 0 ? 500 : -500);
        Move m = absolute(1'000);
        m.kind = Move::Kind::relative;
        EXPECT_TRUE(good(b.ask(m, true)));
        EXPECT_EQ(b.feedback().position_demand, 21'000) << "relative to the counter, not to the shaft";
        // The ends of these are judged by their targets.
        EXPECT_TRUE(good(b.action("cmd_put_condition_move_axis", "16842757")));
        EXPECT_TRUE(good(b.ask(m, true)));
        EXPECT_TRUE(good(b.ask(Action{"manual_move", "by -2"}, true)));
        EXPECT_EQ(b.feedback().position_demand, 20'000);
    }
}

TEST(PacontrolDemand, InPositionByTheCounterAloneIsNotTheTarget) {
    for (const double lag : {0.0, 30.0, -30.0, 40.0, -40.0, 8000.0}) {
        SCOPED_TRACE(lag);
        Known b(5, 0.0);
        const auto warnings = b.notices_of("motion");
        b.control.axes[0].lag = lag;
        const auto r = b.ask(absolute(20'000), true);
        EXPECT_EQ(r.outcome, Outcome::done) << "the control has done its work";
        b.run(500ms);
        const bool behind = std::fabs(lag) > 32;  // two full steps of 200
        EXPECT_EQ(b.feedback().target_reached, !behind);
        EXPECT_EQ(b.feedback().warning, behind);
        EXPECT_EQ(b.notices_of("motion") - warnings, behind ? 1u : 0u);
        b.control.axes[0].lag = 0;  // turned back by hand
        b.run(2s);
        EXPECT_TRUE(b.feedback().target_reached);
        EXPECT_FALSE(b.feedback().warning);
    }
}

TEST(PacontrolDemand, WithoutAGearMicrostepsMeanNothingAndAreNotAsked) {
    Known b(0, 320.0);
    b.command(absolute(50'000));
    b.run(8s);
    EXPECT_EQ(b.asked("1915"), 0u);
    EXPECT_EQ(b.source(), DemandSource::computed);
}

TEST(PacontrolDemand, AControlThatRefuses1915IsAskedNoMore) {
    for (const auto& [code, times] : {std::pair<std::uint16_t, std::size_t>{19, 1}, {21, 1}, {47, 1}, {20, 3}}) {
        SCOPED_TRACE(code);
        Known b(5, 320.0, [&, q = code](Known& k) {
            k.control.script = [q](const Request& r) { return r.code == 0x1915 ? FakeControl::refuse(q) : FakeControl::Verdict{}; };
        });
        EXPECT_TRUE(good(b.ask(absolute(50'000), true)));
        b.run(10s);
        EXPECT_EQ(b.asked("1915"), times);
        EXPECT_EQ(b.source(), DemandSource::computed);
        EXPECT_EQ(b.feedback().position, 50'000);
    }
}

TEST(PacontrolDemand, WhatRulesSpeedAndRampMustBeKnown) {
    for (const std::uint32_t missing : {speed_parameter, ramp_parameter}) {
        Known b(0, {}, [&](Known& k) { k.control.axis_parameters[missing] = 0; });
        EXPECT_EQ(b.source(), DemandSource::computed) << "standing needs neither";
        const Ticket go = b.command(absolute(20'000), true);
        b.run(500ms);
        EXPECT_EQ(b.source(), DemandSource::none);
        EXPECT_EQ(b.feedback().position_demand, b.feedback().position);
        EXPECT_TRUE(good(b.answer(go)));
        EXPECT_EQ(b.source(), DemandSource::computed) << "and a finished move its target alone";
        EXPECT_EQ(b.behind(), 0);
        b.command(absolute(0, 10'000, 100'000));
        b.run(500ms);
        EXPECT_EQ(b.source(), DemandSource::computed) << "overrides say it";
    }
}

TEST(PacontrolDemand, ASpeedThatChangesUnderWayIsFollowed) {
    Known b;
    const Ticket go = b.command(absolute(100'000), true);
    b.run(2s);
    EXPECT_EQ(b.action("override.speed", "40").outcome, Outcome::done);
    b.run(1s);
    EXPECT_EQ(b.source(), DemandSource::computed);
    EXPECT_GT(b.feedback().position_demand, 40'000);
    EXPECT_LE(std::llabs(b.behind()), 40 * 8) << "the acknowledgements' lengths, twice";
    EXPECT_TRUE(good(b.answer(go)));
    EXPECT_EQ(b.feedback().position_demand, 100'000);
}

TEST(PacontrolDemand, AnOrderWithoutAnAcknowledgementLeavesDoubtUntilTheAxisStands) {
    for (const bool carried_out : {false, true}) {
        Known b;
        b.control.script = [&](const Request& q) {
            return q.code != 0x0A94 ? FakeControl::Verdict{} : carried_out ? FakeControl::unanswered() : FakeControl::lost();
        };
        EXPECT_EQ(b.ask(absolute(20'000)).outcome, Outcome::failed);
        b.control.script = {};
        if (carried_out) {
            b.run(300ms);
            EXPECT_EQ(b.source(), DemandSource::none) << "it runs, and since when nobody knows";
        }
        b.run(3s);
        EXPECT_EQ(b.source(), DemandSource::computed);
        EXPECT_EQ(b.feedback().position_demand, carried_out ? 20'000 : 0);
        EXPECT_EQ(b.behind(), 0);
    }
}

TEST(PacontrolDemand, AnOverrideWithoutAnAcknowledgementLeavesTheSpeedInDoubt) {
    Known b;
    b.control.script = [](const Request& q) { return q.code == 0x0A8D ? FakeControl::unanswered() : FakeControl::Verdict{}; };
    EXPECT_EQ(b.ask(absolute(20'000, 20'000)).outcome, Outcome::failed);
    b.control.script = {};
    b.run(500ms);
    EXPECT_EQ(b.source(), DemandSource::computed);
    b.command(absolute(50'000));
    b.run(500ms);
    EXPECT_EQ(b.source(), DemandSource::none) << "10 or 20 units a second";
    EXPECT_TRUE(good(b.ask(absolute(0, 20'000))));
    b.run(500ms);
    EXPECT_EQ(b.source(), DemandSource::computed);
    EXPECT_LE(std::llabs(b.behind()), 20 * 4);
}

TEST(PacontrolDemand, AMalfunctionOfTheAxisOrOfTheControlEndsIt) {
    for (const bool of_axis : {false, true}) {
        Known b(5, 0.0);
        b.command(absolute(100'000));
        b.run(1s);
        EXPECT_EQ(b.source(), DemandSource::drive);
        b.control.axes[0].stop(b.now, of_axis ? 4 : 0);
        if (!of_axis) b.control.error = 529;
        b.run(400ms);
        EXPECT_EQ(b.source(), DemandSource::none) << "although ONLINE goes on";
        EXPECT_EQ(b.feedback().position_demand, b.feedback().position);
    }
}

TEST(PacontrolDemand, NativeOrdersAreOrdersAndManualMovesAreNobodys) {
    Known b;
    const auto native = [&](std::string_view text) {
        Native n;
        n.is_text = true;
        n.send.assign(text.begin(), text.end());
        return b.ask(n);
    };
    EXPECT_TRUE(good(native("0A8D;1;1;20.0")));
    EXPECT_TRUE(good(native("0A94;1;1;60.0")));
    b.run(1s);
    EXPECT_EQ(b.source(), DemandSource::computed);
    EXPECT_NEAR(static_cast<double>(b.feedback().position), 20'000, 20 * 250) << "at the speed that was set in the same way";
    EXPECT_LE(std::llabs(b.behind()), 20 * 4);
    EXPECT_TRUE(good(native("0A9A;1;1;0")));
    b.run(500ms);
    EXPECT_EQ(b.behind(), 0);
    const Ticket manual = b.command(Action{"manual_move", "to 0"}, true);
    b.run(500ms);
    EXPECT_EQ(b.source(), DemandSource::none) << "at which speed the manual does not say";
    EXPECT_TRUE(good(b.answer(manual)));
    EXPECT_EQ(b.source(), DemandSource::computed);
    EXPECT_EQ(b.feedback().position_demand, 0);
}

TEST(PacontrolDemand, AnAxisThatSomethingElseMovesHasNoDemandUntilItStands) {
    Known b;
    b.control.axes[0].go(30, b.now);
    b.run(500ms);
    EXPECT_TRUE(b.feedback().moving);
    EXPECT_EQ(b.source(), DemandSource::none);
    b.run(4s);
    EXPECT_EQ(b.source(), DemandSource::computed);
    EXPECT_EQ(b.feedback().position_demand, 30'000);
}

TEST(PacontrolDemand, AStopAtTheControlEndsIt) {
    Known b(5, 0.0);
    EXPECT_EQ(b.source(), DemandSource::drive);
    b.command(absolute(100'000));
    b.run(1s);
    b.control.axes[0].stop(b.now, 2);
    b.control.mode = 35;
    b.run(300ms);
    EXPECT_EQ(b.source(), DemandSource::none);
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    b.run(500ms);
    EXPECT_EQ(b.source(), DemandSource::drive);
    EXPECT_EQ(b.behind(), 0);
}

TEST(PacontrolDemand, ParametersThatAnOperatorMayHaveChangedAreReadAnew) {
    Known b;
    EXPECT_TRUE(good(b.ask(Disable{})));
    b.run(500ms);
    b.control.mode = 2;
    b.control.axis_parameters[speed_parameter] = 40;
    b.control.axes[0].speed = 40;
    b.run(500ms);
    b.control.mode = 1;
    b.run(400ms);
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    b.run(300ms);
    b.command(absolute(200'000));
    b.run(2s);
    EXPECT_EQ(b.source(), DemandSource::computed);
    EXPECT_LE(std::llabs(b.behind()), 40 * 4);
}

TEST(PacontrolDemand, ParametersThatAreNotToldNowAreAskedOnceASecond) {
    Bench b;
    b.control.script = [](const Request& r) { return r.code == 0x1800 ? FakeControl::refuse(20) : FakeControl::Verdict{}; };
    b.start(10s);
    const auto asked = std::ranges::count_if(b.sent, [](const Bench::Sent& s) { return s.text.starts_with("1800"); });
    EXPECT_GE(asked, 5);
    EXPECT_LE(asked, 10);
    b.control.script = {};
    b.control.axis_parameters = {{speed_parameter, 10}, {ramp_parameter, 1e6}};
    b.run(2s);
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    b.run(500ms);
    b.command(absolute(50'000));
    b.run(1s);
    EXPECT_EQ(b.feedback().demand_source, DemandSource::computed);
}

}  // namespace
}  // namespace axisgate::pacontrol::test
