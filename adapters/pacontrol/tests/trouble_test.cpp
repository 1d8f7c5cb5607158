// Bad input and bad luck: wrong checks, half frames, 8-bit bytes, late and lost answers, operators, ends of motions that nobody heard.
#include "adapters/pacontrol/tests/fake_bench.hpp"

namespace axisgate::pacontrol::test {
namespace {

/// Spoils the next `n` answers.
struct Spoil {
    int left;
    std::function<void(std::vector<std::uint8_t>&)> how;
    void operator()(std::vector<std::uint8_t>& b) {
        if (left > 0) {
            --left;
            how(b);
        }
    }
};

TEST(PacontrolTrouble, DamagedAnswersAreNamedAndTheCommandIsAskedAgain) {
    struct Row {
        const char* says;
        std::function<void(std::vector<std::uint8_t>&)> how;
    };
    const Row rows[] = {
        {"check", [](auto& b) { b[b.size() - 2] = b[b.size() - 2] == '9' ? '8' : '9'; }},
        {"no EOT", [](auto& b) { b.back() = 'x'; }},
        {"frame inside a frame",
         [](auto& b) {
             b.insert(b.begin() + 6, {SOH, STX});
         }},
        {"8 bits", [](auto& b) { b[4] |= 0x80; }},
        {"EOT before ETX", [](auto& b) { b[6] = EOT; }},
        {"fields", [](auto& b) { b = framed("0;1;1", CheckForm::with_etx); }},
    };
    for (const Row& row : rows) {
        SCOPED_TRACE(row.says);
        Bench b(1);
        b.start();
        b.control.n[3] = 4711;
        b.spoil = Spoil{1, row.how};
        const Result r = b.ask(ReadParameter{Bench::point("N[3]")});
        EXPECT_EQ(r.outcome, Outcome::done) << r.text;
        EXPECT_EQ(r.value, Value{std::int64_t{4711}});
        b.run(1s);
        EXPECT_GE(b.adapter.counters().garbled, 1u);
        EXPECT_NE(b.notice_text("protocol").find(row.says), std::string::npos) << b.notice_text("protocol");
        EXPECT_TRUE(b.links.back().online) << "no restart";
    }
}

TEST(PacontrolTrouble, ALineOfEightBitsIsNeverBelievedAndSaysWhatIsWrong) {
    Bench b(1);
    b.spoil = [](std::vector<std::uint8_t>& x) {
        for (auto& c : x)
            c |= 0x80;
    };
    b.start();
    EXPECT_FALSE(b.links.back().online);
    EXPECT_NE(b.notice_text("protocol").find("7N1"), std::string::npos);
    b.spoil = nullptr;
    EXPECT_TRUE(b.run_until([&] { return b.links.back().online; }, 10s));
}

TEST(PacontrolTrouble, AFrameThatTheControlCouldNotReadIsSentAgainWhateverItWas) {
    for (const std::uint16_t q : {std::uint16_t{16}, std::uint16_t{17}, std::uint16_t{18}}) {
        Enabled b;
        int refusals = 2;
        b.control.script = [&](const Request& r) {
            return r.code == 0x0A94 && refusals-- > 0 ? FakeControl::refuse(q) : FakeControl::Verdict{};
        };
        const Result r = b.ask(absolute(5000), true);
        EXPECT_EQ(r.outcome, Outcome::done) << r.text;
        EXPECT_EQ(std::ranges::count(b.reported(), "0A94;1;1;5.0"), 3) << "it was not executed: no risk of moving twice";
    }
}

TEST(PacontrolTrouble, AnAnswerToACommandThatWasGivenUpIsNotTakenForAnother) {
    Bench b(1);
    b.start();
    b.control.n[1] = 111;
    b.control.n[2] = 222;
    bool first = true;
    b.control.script = [&](const Request& q) {
        if (q.code == 0x1906 && q.parameter == 1 && std::exchange(first, false)) return FakeControl::late(205ms);
        return FakeControl::Verdict{};
    };
    const Ticket one = b.command(ReadParameter{Bench::point("N[1]")});
    const Ticket two = b.command(ReadParameter{Bench::point("N[2]")});
    EXPECT_EQ(b.answer(one).value, Value{std::int64_t{111}});
    EXPECT_EQ(b.answer(two).value, Value{std::int64_t{222}});
    EXPECT_GE(b.adapter.counters().unexpected, 1u);
    EXPECT_TRUE(std::ranges::any_of(b.sent, [](const auto& s) { return s.text == "1900;0;0;0"; })) << "a barrier tells late from new";
}

TEST(PacontrolTrouble, EveryDelayOfOneAnswerGivesEveryReadItsOwnValue) {
    for (int ms = 10; ms < 700; ms += 23) {
        SCOPED_TRACE(ms);
        Bench b(1, 9600);
        b.start();
        for (std::uint32_t i = 1; i <= 8; ++i)
            b.control.n[i] = i * 1111;
        bool first = true;
        b.control.script = [&](const Request& q) {
            if (q.code == 0x1906 && q.parameter == 3 && std::exchange(first, false))
                return FakeControl::late(std::chrono::milliseconds(ms));
            return FakeControl::Verdict{};
        };
        std::vector<Ticket> t;
        for (int i = 1; i <= 8; ++i)
            t.push_back(b.command(ReadParameter{Bench::point("N[" + std::to_string(i) + "]")}));
        for (std::size_t i = 0; i < t.size(); ++i)
            EXPECT_EQ(b.answer(t[i]).value, Value{static_cast<std::int64_t>((i + 1) * 1111)});
    }
}

TEST(PacontrolTrouble, AnAnswerOfTheOtherTypeIsSomebodyElsesUnlessTheControlIsLikeThat) {
    Bench b(1);
    b.start();
    b.control.r[1] = 640;
    int wrong = 1;
    b.control.script = [&](const Request& q) {
        return q.code == 0x1907 && wrong-- > 0 ? FakeControl::say(framed("0;1;1;0;0;7", CheckForm::with_etx)) : FakeControl::Verdict{};
    };
    EXPECT_EQ(b.ask(ReadParameter{Bench::point("R[1]")}).value, Value{640.0});
    wrong = 1000;
    EXPECT_EQ(b.ask(ReadParameter{Bench::point("R[1]")}).value, Value{7.0}) << "a control that always answers so can be read all the same";
}

TEST(PacontrolTrouble, AnUnaskedAcknowledgementIsCountedAndToldAndItsStatusIsTaken) {
    Bench b(1);
    b.start();
    b.run(45ms);
    const auto before = b.adapter.counters().unexpected;
    const bool idle = b.run_until([&] { return b.sent.back().at + 5ms < b.now && b.adapter.deadline() > b.now; }, 1s);
    ASSERT_TRUE(idle);
    b.raw(framed("0;1;9;205;0;0", CheckForm::with_etx));
    EXPECT_EQ(b.adapter.counters().unexpected, before + 1);
    EXPECT_NE(b.notice_text("protocol").find("nobody waits for"), std::string::npos);
    EXPECT_EQ(b.feedback().error_code, 205);
}

TEST(PacontrolTrouble, AnUnexpectedEndOfProcessingEndsNothing) {
    Enabled b;
    const Ticket home = b.command(Home{}, true);
    b.run(500ms);
    const auto polls = b.sent.size();
    ASSERT_TRUE(b.run_until([&] { return b.sent.size() > polls; }, 1s));
    b.run(10ms);  // the poll has been answered, the next one is not due yet
    ASSERT_EQ(b.sent.size(), polls + 1);
    b.raw(framed("0;1;31;0;1;0.0000", CheckForm::with_etx));  // nobody has polled
    EXPECT_FALSE(b.results.contains(home)) << "not asked for, not believed";
    EXPECT_EQ(b.answer(home).outcome, Outcome::done);
    EXPECT_TRUE(b.control.axes[0].referenced);
}

TEST(PacontrolTrouble, AnUnansweredStartIsUnknownNotDoneAndThePositionIsReadBack) {
    for (const bool executed : {false, true}) {
        Enabled b;
        b.control.axes[0].position = 7.5;
        b.control.script = [&](const Request& q) {
            return q.code == 0x0A94 ? (executed ? FakeControl::unanswered() : FakeControl::lost()) : FakeControl::Verdict{};
        };
        const Result r = b.ask(absolute(100000), true);
        EXPECT_EQ(r.outcome, Outcome::failed);
        EXPECT_EQ(r.reason, Reason::no_answer);
        EXPECT_NE(r.text.find("not known"), std::string::npos) << r.text;
        EXPECT_NE(r.text.find("position read back is"), std::string::npos) << r.text;
        EXPECT_EQ(std::ranges::count(b.reported(), "0A94;1;1;100.0"), 1) << "never sent twice";
        b.run(500ms);
        EXPECT_EQ(b.feedback().moving, executed) << "what it really does is seen";
        EXPECT_FALSE(b.feedback().target_reached);
    }
}

TEST(PacontrolTrouble, AMotionWhoseEndWasNeverHeardIsUnknownAndIsToldWithItsPosition) {
    Enabled b;
    const Ticket go = b.command(absolute(20000), true);
    b.run(500ms);
    b.control.silent = true;
    const Result r = b.answer(go);
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.reason, Reason::no_answer);
    EXPECT_NE(r.text.find("never heard"), std::string::npos) << r.text;
    b.run(5s);
    b.control.silent = false;
    b.run(8s);
    EXPECT_EQ(b.feedback().position, 20000);
    EXPECT_FALSE(b.feedback().target_reached) << "it stands there, but nobody heard of its end";
    EXPECT_NE(b.notice_text("motion").find("20.0"), std::string::npos) << b.notice_text("motion");
}

TEST(PacontrolTrouble, AnOperatorWhoSwitchesTheModeIsToldAndObeyed) {
    for (const int mode : {1, 2, 20}) {
        SCOPED_TRACE(mode);
        Enabled b(2);
        const Ticket go = b.command(absolute(100000), true, 0);
        b.run(500ms);
        b.mark();
        b.control.set_mode(mode, b.now);
        const Result r = b.answer(go);
        EXPECT_EQ(r.outcome, Outcome::failed);
        EXPECT_EQ(r.reason, Reason::interrupted);
        EXPECT_NE(r.text.find(status_text(mode)), std::string::npos) << r.text;
        EXPECT_NE(b.notice_text("mode").find("not by this gateway"), std::string::npos) << b.notice_text("mode");
        EXPECT_EQ(b.feedback(0).power, AxisFeedback::Power::off);
        EXPECT_EQ(b.feedback(1).power, AxisFeedback::Power::off);
        b.run(3s);
        EXPECT_TRUE(b.reported().empty()) << "nothing is switched back by itself";
        b.control.mode = 1;
        b.run(500ms);
        EXPECT_EQ(b.enable().outcome, Outcome::accepted) << "no restart";
        EXPECT_EQ(b.ask(absolute(1000, 5000), true).outcome, Outcome::done);
        EXPECT_EQ(std::ranges::count(b.reported(), "0A8D;1;1;5.0"), 1) << "overrides were dropped with ONLINE and are sent anew";
    }
}

TEST(PacontrolTrouble, AStopAtTheControlInterruptsAndEnableGoesTheSafeWay) {
    Enabled b;
    const Ticket go = b.command(absolute(100000), true);
    b.run(500ms);
    b.control.axes[0].stop(b.now, 2);
    b.control.mode = 35;
    const Result r = b.answer(go);
    EXPECT_EQ(r.reason, Reason::interrupted);
    EXPECT_NE(r.text.find("35 (ONLINE stopped)"), std::string::npos) << r.text;
    EXPECT_TRUE(b.feedback().quick_stopping);
    EXPECT_EQ(b.ask(absolute(0)).reason, Reason::wrong_state);
    EXPECT_EQ(b.enable().outcome, Outcome::accepted);
    EXPECT_EQ(b.ask(absolute(0), true).outcome, Outcome::done);
}

/// The operating status of an acknowledgement may be that of before: the start of ONLINE is neither sent again nor given up.
TEST(PacontrolTrouble, AStartOfOnlineThatIsNotShownYetIsWaitedFor) {
    Bench b(2);
    b.start();
    b.control.axes[0].referenced = b.control.axes[1].referenced = true;
    Instant started = never;
    b.control.script = [&](const Request& q) {
        if (q.code == 0x0603 && started == never) {
            started = b.now;
            return FakeControl::say(framed("0;1;1;0;0;0", CheckForm::with_etx));
        }
        if (started != never && b.now < started + 300ms && q.code != 0x0603)
            return FakeControl::say(framed(q.code == 0x190C ? "0;1;1;0;1;0.0" : "0;1;1;0;0;0", CheckForm::with_etx));
        return FakeControl::Verdict{};
    };
    b.mark();
    const Ticket x = b.command(Enable{}, true, 0), y = b.command(Enable{}, true, 1);
    const Result first = b.answer(x), second = b.answer(y);
    EXPECT_EQ(first.outcome, Outcome::done) << first.text;
    EXPECT_EQ(second.outcome, Outcome::done) << second.text;
    EXPECT_EQ(std::ranges::count(b.reported(), "0603;0;0;0"), 1);
}

TEST(PacontrolTrouble, AMalfunctionOfOneAxisIsItsOwn) {
    Enabled b(2);
    const Ticket one = b.command(absolute(100000), true, 0), two = b.command(absolute(20000), true, 1);
    b.run(500ms);
    b.control.axes[0].stop(b.now, 4);
    const Result r = b.answer(one);
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_NE(r.text.find("malfunction"), std::string::npos) << r.text;
    EXPECT_TRUE(b.feedback(0).fault);
    EXPECT_FALSE(b.feedback(1).fault);
    EXPECT_EQ(b.answer(two).outcome, Outcome::done);
}

TEST(PacontrolTrouble, AFaultKeepsItsNumberUntilTheAxisIsInOrder) {
    Enabled b(1);
    (void)b.command(absolute(100000), true);
    b.run(500ms);
    b.control.axes[0].stop(b.now, 4);
    b.control.error = 531;
    b.control.mode = 39;
    b.run(1s);
    ASSERT_TRUE(b.feedback().fault);
    EXPECT_EQ(b.feedback().error_code, 531);
    b.control.error = 0;  // the number goes first; the axis says later that it is in order
    b.control.mode = 1;
    b.run(1s);
    EXPECT_TRUE(b.feedback().fault);
    EXPECT_EQ(b.feedback().error_code, 531) << "the same fault, not one without a number";
    b.control.axes[0].rest = 0;
    b.control.axes[0].stop(b.now, 0);
    b.run(1s);
    EXPECT_FALSE(b.feedback().fault);
    EXPECT_EQ(b.feedback().error_code, 0);
    EXPECT_EQ(b.notices_of("axis"), 1u) << "told once";
}

TEST(PacontrolTrouble, LimitSwitchesAreLowActive) {
    Bench b(1);
    b.start();
    EXPECT_FALSE(b.feedback().internal_limit);
    EXPECT_EQ(b.feedback().native_status >> 16 & 0xFF, 7u) << "ready, both switches free";
    b.control.axes[0].positive_free = false;
    b.control.axes[0].rest = 4;
    b.run(1s);
    EXPECT_TRUE(b.feedback().internal_limit);
    EXPECT_TRUE(b.feedback().fault) << "0100 0104h of the manual [L3186]";
    EXPECT_EQ(b.feedback().native_status, 0x00050401u);
}

TEST(PacontrolTrouble, EndOfProcessingThatNeverComesIsBounded) {
    Enabled b(1, {{"processing_timeout_ms", "2000"}});
    b.control.reference_time = 1h;
    const Result r = b.ask(Home{}, true);
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.reason, Reason::no_answer);
    EXPECT_NE(r.text.find("end of processing was not reported"), std::string::npos) << r.text;
    EXPECT_TRUE(good(b.ask(QuickStop{}))) << "and the axis can still be stopped";
}

TEST(PacontrolTrouble, AProcessThatRanBeforeTheGatewayStartedIsFoundAndWaitedFor) {
    Bench b(1);
    b.control.mode = 31;
    b.control.pending = 0;
    b.control.reference_ends = b.now + 2s;
    b.start(1s);
    EXPECT_TRUE(b.links.back().online);
    EXPECT_GE(std::ranges::count(b.sent, "EOT", &Bench::Sent::text), 5);
    EXPECT_TRUE(good(b.ask(ReadParameter{Bench::point("N[1]")})));
    EXPECT_LT(b.now, time_zero + 1h + 3s);
}

TEST(PacontrolTrouble, LineDownAnswersEverythingAndComesBack) {
    Enabled b(2);
    std::vector<Ticket> t{b.command(absolute(100000), true, 0), b.command(Home{}, true, 1)};
    for (int i = 0; i < 10; ++i)
        t.push_back(b.command(ReadParameter{Bench::point("N[1]")}));
    b.run(50ms);
    t.push_back(b.command(Halt{}, true, 0));
    b.line(false);
    for (const auto x : t)
        EXPECT_TRUE(b.results.contains(x));
    EXPECT_EQ(b.results.at(t[1]).reason, Reason::line_down);
    EXPECT_EQ(b.ask(Enable{}).reason, Reason::line_down);
    EXPECT_EQ(b.adapter.deadline(), never);
    b.line(true);
    b.run(2s);
    EXPECT_TRUE(b.links.back().online);
}

TEST(PacontrolTrouble, ManyCommandsAreBusyAndNoneIsLost) {
    Bench b(1);
    b.start();
    std::vector<Ticket> t;
    for (int i = 0; i < 200; ++i)
        t.push_back(b.command(ReadParameter{Bench::point("N[1]")}));
    std::size_t busy = 0;
    for (const auto x : t)
        busy += b.answer(x).reason == Reason::busy;
    EXPECT_GE(busy, 130u);
    EXPECT_LE(busy, 136u);
}

// --- speed -----------------------------------------------------------------------------------------------------------------------

TEST(PacontrolSpeed, PollsOfEightAxesUseTheLine) {
    Bench c(8, 9600);
    c.control.axes.resize(8);
    c.control.latency = Duration::zero();
    c.start();
    for (std::uint16_t i = 0; i < 8; ++i)
        EXPECT_EQ(c.enable(i).outcome, Outcome::accepted);
    for (std::uint16_t i = 0; i < 8; ++i)
        EXPECT_EQ(c.ask(absolute(400000, 10000), false, i).outcome, Outcome::accepted);
    const Instant begun = c.now;
    const Duration used = c.wire_used;
    c.run(20s);
    const double share = seconds(c.wire_used - used) / seconds(c.now - begun);
    RecordProperty("share_of_the_line_percent", std::to_string(100 * share));
    EXPECT_GE(share, 0.95);
    EXPECT_LE(share, 1.01);
    std::set<Instant> seen;
    for (const auto& [axis, f] : c.feedbacks) {
        if (axis == AxisId{5} && f.at >= begun) seen.insert(f.at);
    }
    EXPECT_GT(seen.size(), 20u) << "and every axis is heard of about once a second at least";
}

}  // namespace
}  // namespace axisgate::pacontrol::test
