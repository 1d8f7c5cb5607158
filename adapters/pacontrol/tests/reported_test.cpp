// What is told is true: whose fault it is, why a reference run ended, that a stop at the control is one, and how old everything is.
// In: the adapter against the embedded control at 9600 baud, and against the fake one. Out: feedback, results, notices.
// Never waits for real time.
#include "adapters/pacontrol/tests/fake_bench.hpp"
#include "adapters/pacontrol/tests/rig.hpp"

namespace axisgate::pacontrol::test {
namespace {

AxisId id(int n) { return AxisId{static_cast<std::uint16_t>(n)}; }

// --- whose fault -----------------------------------------------------------------------------------------------------------------

TEST(PacontrolReported, OneLimitSwitchIsTheFaultOfItsAxisAlone) {
    Rig r(4);
    r.move_all(4);
    r.run(1s);
    r.history.clear();
    r.hand("axis2.limit_positive", true);
    r.run(2s);
    EXPECT_TRUE(r.feedback[id(1)].fault);
    EXPECT_EQ(r.feedback[id(1)].error_code, 529);
    EXPECT_TRUE(r.feedback[id(1)].internal_limit);
    for (const auto& [axis, f] : r.history) {
        if (axis == id(1)) continue;
        EXPECT_FALSE(f.fault) << "axis " << index_of(axis) + 1 << " has stopped with it, and is in order";
        EXPECT_EQ(f.error_code, 0);
    }
    for (const int n : {0, 2, 3}) {
        EXPECT_TRUE(r.feedback[id(n)].quick_stopping) << "stopped by the control, and locked until it is reset";
        EXPECT_TRUE(r.feedback[id(n)].warning);
        EXPECT_FALSE(r.feedback[id(n)].moving);
    }
    EXPECT_EQ(std::ranges::count(r.notices, Severity::alarm, &Notice::severity), 0) << "the fault of axis 2 is the one alarm";
    const Result enabled = r.answer(r.command(Enable{}, 0));
    EXPECT_EQ(enabled.reason, Reason::wrong_state);
    EXPECT_NE(enabled.text.find("reset the fault of axis 2"), std::string::npos) << enabled.text;
    r.hand("axis2.limit_positive", false);
    EXPECT_EQ(r.answer(r.command(ResetFault{}, 1, true)).outcome, Outcome::done);
    r.run(1s);
    for (int n = 0; n < 4; ++n) {
        EXPECT_FALSE(r.feedback[id(n)].fault);
        EXPECT_FALSE(r.feedback[id(n)].quick_stopping);
        EXPECT_EQ(r.feedback[id(n)].power, AxisFeedback::Power::off);
        EXPECT_EQ(r.ask(Enable{}, n), Outcome::accepted);
    }
}

TEST(PacontrolReported, AnErrorOfTheControlItselfIsTheFaultOfAllAxes) {
    Rig r(3);
    r.move_all(3);
    r.hand("inject_error", std::int64_t{501});
    r.run(3s);
    for (int n = 0; n < 3; ++n) {
        EXPECT_TRUE(r.feedback[id(n)].fault) << n + 1;
        EXPECT_EQ(r.feedback[id(n)].error_code, 501);
    }
}

TEST(PacontrolReported, AStatusThatIsNeverReadDoesNotHideAFault) {
    Enabled b(2);
    b.control.script = [](const Request& q) {
        return q.code == 0x1910 || q.code == 0x1921 ? FakeControl::refuse(21) : FakeControl::Verdict{};
    };
    b.control.error = 501;
    b.control.mode = 39;
    b.run(3s);
    EXPECT_TRUE(b.feedback(0).fault && b.feedback(1).fault);
}

// --- stops at the control --------------------------------------------------------------------------------------------------------

TEST(PacontrolReported, AfterAStopAtTheControlEnableMakesMovesPossibleAgain) {
    Rig r(2);
    r.move_all(2);
    r.run(500ms);
    r.hand("external_stop", false);
    r.run(1s);
    for (int n = 0; n < 2; ++n) {
        EXPECT_TRUE(r.feedback[id(n)].quick_stopping) << n + 1;
        EXPECT_FALSE(r.feedback[id(n)].moving);
    }
    const Result barred = r.answer(r.command(Enable{}, 0));
    EXPECT_EQ(barred.outcome, Outcome::refused) << "the input carries no power yet";
    EXPECT_NE(barred.text.find("external-stop"), std::string::npos) << barred.text;
    r.hand("external_stop", true);
    for (int n = 0; n < 2; ++n) {
        EXPECT_EQ(r.ask(Enable{}, n), Outcome::accepted);
        r.run(300ms);
        EXPECT_FALSE(r.feedback[id(n)].quick_stopping);
        EXPECT_FALSE(r.feedback[id(n)].moving) << "nothing moves because something was enabled";
    }
    Move m;
    m.target = 1000;
    for (int n = 0; n < 2; ++n)
        EXPECT_EQ(r.answer(r.command(m, n, true)).outcome, Outcome::done);
}

TEST(PacontrolReported, AParameterThatWaitsForHomePositionIsAReasonToGoThere) {
    Enabled b(2, {{"when", "wait"}});
    const Ticket write = b.command(WriteParameter{Bench::point("AP6"), Value{12.5}}, false, 1);
    const Ticket read = b.command(ReadParameter{Bench::point("AP6")}, false, 1);
    b.run(500ms);
    EXPECT_FALSE(b.results.contains(write)) << "an axis is on";
    const Instant begun = b.now;
    EXPECT_TRUE(good(b.ask(Disable{}, false, 0)));
    EXPECT_TRUE(good(b.ask(Disable{}, false, 1)));
    const Result r = b.answer(write);
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    EXPECT_LT(b.now - begun, 2s) << "not the time-out of the waiting";
    EXPECT_EQ(b.answer(read).value, Value{12.5});
    EXPECT_EQ(std::ranges::count(b.reported(), "0A81;0;0;0"), 1);
}

// --- reference runs --------------------------------------------------------------------------------------------------------------

struct Aborted {
    const char* hand;
    Value value;
    const char* says;
    Reason reason;
    bool error;
};

TEST(PacontrolReported, WhatAbortedAReferenceRunIsTold) {
    for (const Aborted& a : {Aborted{"external_stop", Value{false}, "stop input", Reason::interrupted, false},
                             Aborted{"inject_error", Value{std::int64_t{501}}, "E501", Reason::drive_refused, true},
                             Aborted{"axis1.inject_error", Value{std::int64_t{531}}, "E531", Reason::drive_refused, true},
                             Aborted{"axis2.inject_error", Value{std::int64_t{532}}, "E532", Reason::drive_refused, true},
                             Aborted{"panel", Value{std::string("home")}, "ONLINE has ended", Reason::interrupted, false}}) {
        for (const bool until_done : {true, false}) {
            SCOPED_TRACE(a.hand);
            Rig r(2);
            EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
            Move away;
            away.target = 400'000;
            EXPECT_EQ(r.answer(r.command(away, 0, true)).outcome, Outcome::done);
            const Ticket home = r.command(Home{}, 0, until_done);
            r.run(1s);
            ASSERT_TRUE(r.feedback[id(0)].moving);
            r.notices.clear();
            r.hand(a.hand, a.value);
            r.run(3s);
            ASSERT_TRUE(r.results.contains(home));
            if (until_done) {
                EXPECT_EQ(r.results[home].outcome, Outcome::failed);
                EXPECT_EQ(r.results[home].reason, a.reason) << r.results[home].text;
                EXPECT_NE(r.results[home].text.find(a.says), std::string::npos) << r.results[home].text;
            }
            EXPECT_NE(r.notice_of("homing").find(a.says), std::string::npos)
                << "also for who had the answer already: " << r.notice_of("homing");
            EXPECT_EQ(r.feedback[id(0)].homing_error, a.error);
            EXPECT_FALSE(r.feedback[id(0)].homing_attained);
        }
    }
}

// --- age -------------------------------------------------------------------------------------------------------------------------

struct Crowd {
    int axes, moving;
    const char* model;
};

/// Of each axis the instant that is told is never newer than its last 190C, and never older than what counts as stale on a byte line.
TEST(PacontrolReported, TheAgeIsThatOfTheOldestPartAndNeverStale) {
    for (const Crowd& c : {Crowd{3, 0, "ep"}, Crowd{16, 0, "ep"}, Crowd{16, 0, "other"}, Crowd{3, 1, "ep"}, Crowd{16, 8, "other"},
                           Crowd{16, 4, "ep"}, Crowd{16, 16, "other"}, Crowd{16, 16, "ep"}}) {
        SCOPED_TRACE(testing::Message() << c.axes << " axes, " << c.moving << " moving, " << c.model);
        Rig r(c.axes, {{"model", c.model}});
        r.move_all(c.moving);
        r.run(5s);
        Duration oldest{};
        for (int step = 0; step < 2500; ++step) {
            r.run(2ms);
            for (int n = 0; n < c.axes; ++n) {
                const AxisFeedback& f = r.feedback[id(n)];
                oldest = std::max(oldest, r.now - f.at);
                const auto asked = std::find_if(r.handed.rbegin(), r.handed.rend(),
                                                [&](const auto& h) { return h.text.starts_with("190C;" + std::to_string(n + 1) + ";"); });
                ASSERT_NE(asked, r.handed.rend());
                ASSERT_LE(f.at, asked->at + 60ms) << "axis " << n + 1 << ": newer than its position";
            }
        }
        std::printf("%d axes, %d moving, %s: what is told is at most %lld ms old\n", c.axes, c.moving, c.model,
                    static_cast<long long>(milliseconds_of(oldest)));
        EXPECT_LT(oldest, 3s);
    }
}

TEST(PacontrolReported, EndsAreHeardSoonThoughSixteenMove) {
    Rig r(16, {{"model", "other"}});
    r.move_all(15);
    EXPECT_EQ(r.ask(Enable{}, 15), Outcome::accepted);
    Move m;
    m.target = 10'000;
    m.velocity = 10'000;
    EXPECT_EQ(r.ask(m, 15), Outcome::accepted);
    while (r.axis(15).running())
        r.run(1ms);
    const Instant ended = r.now;
    while (!r.feedback[id(15)].target_reached && r.now - ended < 10s)
        r.run(1ms);
    std::printf("the end of one of sixteen motions is heard after %lld ms\n", static_cast<long long>(milliseconds_of(r.now - ended)));
    EXPECT_LT(r.now - ended, 2s);
}

}  // namespace
}  // namespace axisgate::pacontrol::test
