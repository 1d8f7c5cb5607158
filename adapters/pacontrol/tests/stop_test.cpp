// Stops: they overtake what waits, leave after the exchange in progress at most, pass a reference run, and harden when they are refused.
#include "adapters/pacontrol/tests/fake_bench.hpp"
#include "adapters/pacontrol/tests/rig.hpp"

namespace axisgate::pacontrol::test {
namespace {

TEST(PacontrolStop, HaltAndQuickStopEndAMotion) {
    for (const CommandBody& body : {CommandBody{Halt{}}, CommandBody{QuickStop{}}}) {
        Enabled b;
        const Ticket go = b.command(absolute(100000), true);
        b.run(500ms);
        b.mark();
        const Result r = b.ask(body, true);
        EXPECT_EQ(r.outcome, Outcome::done) << r.text;
        EXPECT_EQ(b.reported(), (Lines{"0A9A;1;1;0"}));
        EXPECT_EQ(b.answer(go).reason, Reason::interrupted);
        EXPECT_FALSE(b.feedback().moving);
        EXPECT_FALSE(b.feedback().target_reached);
        EXPECT_EQ(b.feedback().power, AxisFeedback::Power::on);
        EXPECT_LT(b.feedback().position, 100000);
    }
}

TEST(PacontrolStop, LeavesBeforeEverythingThatWaitsAfterTheExchangeInProgressAtMost) {
    Enabled b(4, {}, 9600);
    std::vector<Ticket> reads;
    for (int i = 0; i < 40; ++i)
        reads.push_back(b.command(ReadParameter{Bench::point("N[1]")}, false, static_cast<std::uint16_t>(i % 4)));
    const Ticket move = b.command(absolute(20000), true, 2);
    b.run(100ms);
    b.mark();
    const Instant asked = b.now;
    const Ticket stop = b.command(QuickStop{}, false, 2);
    b.run_until([&] { return b.sent.size() > b.mark_at; });
    EXPECT_EQ(b.sent.at(b.mark_at).text, "0A9A;3;1;0") << "nothing else before it";
    EXPECT_EQ(b.sent.at(b.mark_at).priority, Priority::urgent);
    EXPECT_LT(b.sent.at(b.mark_at).at - asked, 60ms) << "one request and its answer at 9600 baud";
    EXPECT_EQ(b.answer(move).reason, Reason::interrupted);
    EXPECT_TRUE(good(b.answer(stop)));
    for (const auto t : reads)
        EXPECT_TRUE(good(b.answer(t))) << "values are not ended by a stop";
    for (const auto& s : b.sent)
        EXPECT_EQ(s.text.find("0A94;3"), std::string::npos) << "the interrupted motion has not been sent";
}

TEST(PacontrolStop, AStartThatIsOnTheLineIsStoppedBehindItsAnswer) {
    Enabled b(1, {}, 9600);
    const Ticket go = b.command(absolute(100000), true);
    b.run_until([&] { return b.sent.back().text == "0A94;1;1;100.0"; });
    const Ticket stop = b.command(Halt{}, true);
    EXPECT_EQ(b.answer(go).reason, Reason::interrupted);
    EXPECT_EQ(b.answer(stop).outcome, Outcome::done);
    EXPECT_FALSE(b.control.axes[0].running);
    EXPECT_EQ(b.reported().back(), "0A9A;1;1;0");
}

TEST(PacontrolStop, PassesAReferenceRun) {
    Enabled b(2);
    const Ticket home = b.command(Home{}, true, 0);
    b.run(500ms);
    b.mark();
    const Result r = b.ask(QuickStop{}, true, 0);
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    EXPECT_EQ(b.reported(), (Lines{"0A93;1;1;0"})) << "0A9A does not pass while a command is being processed";
    EXPECT_EQ(b.answer(home).reason, Reason::interrupted);
    EXPECT_EQ(b.ask(absolute(1000), true, 1).outcome, Outcome::done) << "the line is free again";
}

TEST(PacontrolStop, DisableOfAnotherAxisDuringAReferenceRunStopsAtOnceAndSwitchesOffAtItsEnd) {
    Enabled b(2);
    EXPECT_TRUE(good(b.ask(absolute(100000), false, 1)));
    const Ticket home = b.command(Home{}, true, 0);
    b.run(500ms);
    b.mark();
    const Ticket off = b.command(Disable{}, false, 1);
    b.run(100ms);
    EXPECT_FALSE(b.control.axes[1].running);
    EXPECT_EQ(b.reported(), (Lines{"0A93;2;1;0"}));
    EXPECT_TRUE(good(b.answer(off)));
    EXPECT_EQ(b.reported().at(1), "0A98;2;0;0");
    b.run(5s);
    EXPECT_TRUE(b.results.contains(home)) << "its end is found by the axis' status";
}

TEST(PacontrolStop, ARefusedStopBecomesOneOfAllAxes) {
    Enabled b(2);
    EXPECT_TRUE(good(b.ask(absolute(100000), false, 0)));
    EXPECT_TRUE(good(b.ask(absolute(100000), false, 1)));
    b.control.script = [](const Request& q) { return q.code == 0x0A9A ? FakeControl::refuse(20) : FakeControl::Verdict{}; };
    b.mark();
    const Result r = b.ask(QuickStop{}, false, 0);
    EXPECT_EQ(r.outcome, Outcome::accepted);
    EXPECT_EQ(b.reported(), (Lines{"0A9A;1;1;0", "0600;0;0;0"}));
    EXPECT_FALSE(b.control.axes[0].running || b.control.axes[1].running);
    EXPECT_EQ(b.notices_of("stop"), 1u);
}

TEST(PacontrolStop, InAutomaticTheProgramIsStopped) {
    Bench b(1);
    b.control.mode = 11;
    b.start();
    b.mark();
    const Result r = b.ask(QuickStop{});
    EXPECT_EQ(r.outcome, Outcome::accepted);
    EXPECT_EQ(b.reported(), (Lines{"0600;0;0;0"}));
    EXPECT_EQ(b.control.mode, 15);
}

TEST(PacontrolStop, AtHomeTheControlIsAskedAndNothingIsChanged) {
    Bench b(1);
    b.start();
    b.mark();
    for (const CommandBody& body : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        const Result r = b.ask(body, true);
        EXPECT_TRUE(good(r)) << r.text;
    }
    EXPECT_EQ(b.reported(), (Lines{"190B;0;0;0", "190B;0;0;0", "190B;0;0;0"}));
}

TEST(PacontrolStop, ADisableTakesThePowerThatTheEnableModeGivesAtHome) {
    Rig r(2);  // the model's axes have enable mode 1
    r.run(2s);
    for (const int axis : {0, 1})
        ASSERT_EQ(r.axis(axis).state().power, twin::AxisPower::on) << "by its own rule";
    r.handed.clear();
    const Result off = r.answer(r.command(Disable{}, 0, true));
    EXPECT_EQ(off.outcome, Outcome::done) << off.text;
    EXPECT_EQ(r.axis(0).state().power, twin::AxisPower::idle);
    EXPECT_EQ(r.axis(1).state().power, twin::AxisPower::on) << "the other one was not asked for";
    EXPECT_EQ(std::ranges::count_if(r.handed, [](const auto& x) { return x.text.starts_with("0603"); }), 1);
    r.run(5s);
    EXPECT_EQ(r.axis(0).state().power, twin::AxisPower::idle) << "it is not given back to where it would have power";
    // A way over home position, to leave a fault, gives power to both: what was disabled is disabled again.
    r.hand("axis2.inject_error", Value{std::int64_t{531}});
    r.run(1s);
    EXPECT_TRUE(good(r.answer(r.command(ResetFault{}, 1, true))));
    r.run(2s);
    EXPECT_EQ(r.axis(0).state().power, twin::AxisPower::idle);
}

TEST(PacontrolStop, ADisableThatCannotTakeThePowerIsNotCalledDone) {
    struct Case {
        std::map<std::string, std::string> options;
        int mode;
        bool external_stop;
        const char* says;
    };
    for (const Case& c : {Case{{{"online", "manual"}}, 1, true, "online.start"}, Case{{}, 1, false, "external stop"},
                          Case{{}, 2, true, "operator"}, Case{{}, 11, true, "automatic.cancel"}, Case{{}, 15, true, "automatic.cancel"}}) {
        SCOPED_TRACE(c.says);
        Bench b(1, 0, c.options);
        b.control.axis_parameters[1 << 8 | 0x32] = 1;
        b.control.mode = c.mode;
        b.control.external_stop = c.external_stop;
        b.start();
        b.run(1s);
        const Result r = b.ask(Disable{}, true);
        EXPECT_EQ(r.outcome, Outcome::failed) << r.text;
        EXPECT_NE(r.text.find(c.says), std::string::npos) << r.text;
        for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}})
            EXPECT_TRUE(good(b.ask(stop, true))) << "nothing that was commanded moves";
    }
}

TEST(PacontrolStop, SilenceIsNeverTakenForAStop) {
    Enabled b;
    EXPECT_TRUE(good(b.ask(absolute(100000))));
    b.control.silent = true;
    const Result r = b.ask(Disable{});
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.reason, Reason::no_answer);
    b.run(3s);
    const Result again = b.ask(QuickStop{});
    EXPECT_EQ(again.reason, Reason::no_answer) << "tried even while nobody answers";
}

TEST(PacontrolStop, AnAxisThatRunsOnAfterItsStopIsStoppedWithAllOthers) {
    Enabled b;
    EXPECT_TRUE(good(b.ask(absolute(400000))));
    b.control.script = [&](const Request& q) {
        return q.code == 0x0A9A ? FakeControl::Verdict{true, false, {}, {}, {}} : FakeControl::Verdict{};
    };
    b.mark();
    EXPECT_EQ(b.ask(Halt{}).outcome, Outcome::accepted);
    b.run(11s);
    EXPECT_EQ(b.reported(), (Lines{"0A9A;1;1;0", "0600;0;0;0"}));
    EXPECT_FALSE(b.control.axes[0].running);
}

TEST(PacontrolStop, StopsAreBounded) {
    Enabled b(1, {}, 300);
    std::vector<Ticket> t;
    for (int i = 0; i < 60; ++i)
        t.push_back(b.command(Halt{}));
    std::size_t busy = 0;
    for (const auto x : t)
        busy += b.answer(x, 600s).reason == Reason::busy;
    EXPECT_GT(busy, 0u);
    EXPECT_LT(busy, 40u);
}

}  // namespace
}  // namespace axisgate::pacontrol::test
