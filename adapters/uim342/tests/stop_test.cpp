// Stops of the UIM342 adapter: they overtake, they are confirmed, and nothing that was on its way outlives them.
#include "adapters/uim342/tests/fake_bench.hpp"

namespace axisgate::uim342::test {
namespace {

struct Running {
    Bench b;
    FakeNode& f;
    explicit Running(std::int64_t v = 1000) : f(b.add(5)) {
        b.start();
        b.ask(Enable{});
        if (v) b.ask(jog(v));
        b.run(100ms);
        b.mark();
    }
    auto script(std::uint8_t cw, FakeNode::Verdict v) {
        f.script = [cw, v](const Message& m) { return m.cw == cw && form_of(m) == Form::set ? v : FakeNode::Verdict{}; };
    }
};

TEST(Uim342Stop, QuickStopIsStUrgentAndAtOnce) {
    Running r;
    const Ticket t = r.b.command(QuickStop{});
    EXPECT_EQ(r.b.sent.back().message, message(5, 0x97));
    EXPECT_EQ(r.b.sent.back().priority, Priority::urgent);
    r.b.run(5ms);
    EXPECT_EQ(r.b.results[t].outcome, Outcome::accepted);
    EXPECT_TRUE(r.f.stop);
}

TEST(Uim342Stop, BesideTheExchangeInProgress) {
    Running r;
    r.script(0x99, FakeNode::answer_if(false));  // the drive is slow with AC
    const Ticket w = r.b.command(WriteParameter{Bench::point("AC"), Value{std::int64_t{5}}});
    r.b.run(1ms);
    const Ticket t = r.b.command(QuickStop{});
    r.b.run(5ms);
    ASSERT_TRUE(r.b.results.contains(t)) << "not after the time-out of the other exchange";
    EXPECT_EQ(r.b.results[t].outcome, Outcome::accepted);
    EXPECT_FALSE(r.b.results.contains(w)) << "a parameter write is no motion: it goes on";
    r.f.script = nullptr;
    r.b.run(200ms);
    EXPECT_EQ(r.b.results[w].outcome, Outcome::done);
}

TEST(Uim342Stop, WaitingMotionsEndInterrupted) {
    Running r(0);
    r.f.script = [](const Message&) { return FakeNode::late(30ms); };
    const Ticket a = r.b.command(absolute(1, 1)), p = r.b.command(ReadParameter{Bench::point("AC")}), c = r.b.command(absolute(2, 2)),
                 h = r.b.command(Home{35}), e = r.b.command(Enable{});
    r.b.run(40ms);
    r.b.command(QuickStop{});
    for (const Ticket t : {a, c, h, e}) {
        ASSERT_TRUE(r.b.results.contains(t));
        EXPECT_EQ(r.b.results[t].outcome, Outcome::failed);
        EXPECT_EQ(r.b.results[t].reason, Reason::interrupted);
    }
    r.b.run(1s);
    EXPECT_EQ(r.b.results[p].outcome, Outcome::done) << "a read is not a motion";
    EXPECT_EQ(std::ranges::count(r.b.received(5), "96"), 0) << "nothing began after the stop";
}

/// The line lets urgent frames overtake: a BG that waits in its queue must not start the axis after the stop.
TEST(Uim342Stop, ABeginThatTheStopOvertookIsStoppedToo) {
    for (const char* which : {"quick_stop", "halt", "disable"}) {
        SCOPED_TRACE(which);
        Running r(0);
        r.b.frame_time = 5ms;  // a slow line: frames wait
        // Stop exactly when BG has been given to the line but not yet been heard.
        const Ticket m = r.b.command(absolute(100000, 100));
        ASSERT_TRUE(r.b.run_until([&] { return r.b.sent.back().message == message(5, 0x96); }, 1s));
        CommandBody stop = QuickStop{};
        if (std::string_view(which) == "halt") stop = Halt{};
        if (std::string_view(which) == "disable") stop = Disable{};
        const Ticket t = r.b.command(stop);
        r.b.run(1s);
        EXPECT_EQ(r.b.results[m].reason, Reason::interrupted);
        EXPECT_EQ(r.b.results[t].outcome, Outcome::accepted) << r.b.results[t].text;
        EXPECT_TRUE(r.f.stop || !r.f.on) << "the axis must not run after the stop";
        EXPECT_FALSE(r.b.feedback().moving);
    }
}

TEST(Uim342Stop, AnEnableThatDisableOvertookIsSwitchedOffAgain) {
    Bench b;
    FakeNode& f = b.add(5);
    b.start();
    b.frame_time = 5ms;
    const Ticket e = b.command(Enable{});
    ASSERT_TRUE(b.run_until([&] { return b.sent.back().message == message(5, 0x95, std::array<std::uint8_t, 1>{1}); }, 1s));
    const Ticket d = b.command(Disable{});
    b.run(1s);
    EXPECT_EQ(b.results[e].reason, Reason::interrupted);
    EXPECT_EQ(b.results[d].outcome, Outcome::accepted);
    EXPECT_FALSE(f.on);
    EXPECT_EQ(b.feedback().power, AxisFeedback::Power::off);
}

TEST(Uim342Stop, ALostStopIsRepeatedThenTheTruthIsTold) {
    Running r;
    r.script(0x97, FakeNode::lost());
    const Result q = r.b.ask(QuickStop{});
    EXPECT_EQ(q.outcome, Outcome::failed);
    EXPECT_EQ(q.reason, Reason::no_answer);
    EXPECT_NE(q.text.find("not known"), std::string::npos);
    EXPECT_EQ(std::ranges::count(r.b.received(5), "97"), 3);
    EXPECT_TRUE(r.b.feedback().moving);
}

TEST(Uim342Stop, TheRampIsShownUntilItStands) {
    Running r;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x97) {
            v.execute = false;  // the ramp is long
            v.instead = message(5, 0x17);
        }
        return v;
    };
    EXPECT_EQ(r.b.ask(QuickStop{}).outcome, Outcome::accepted);
    r.b.run(200ms);
    EXPECT_TRUE(r.b.feedback().quick_stopping && r.b.feedback().moving);
    r.f.stop = true;
    r.f.speed = 0;
    r.b.run(50ms);
    EXPECT_FALSE(r.b.feedback().quick_stopping || r.b.feedback().moving);
}

TEST(Uim342Stop, AnAxisThatGoesOnIsStoppedAgain) {
    Running r;
    int stops = 0;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x97 && stops++ == 0) {
            v.execute = false;
            v.instead = message(5, 0x17);  // acknowledged, but nothing happens
        }
        return v;
    };
    r.b.ask(QuickStop{});
    r.b.run(2s);
    EXPECT_EQ(stops, 2) << "1000 pulse/s at SD 1600000 is over within a millisecond; 300 ms later it is asked why not";
    EXPECT_EQ(r.b.notices_of("stop"), 1u);
    EXPECT_TRUE(r.f.stop);
}

/// The flags of a drive can be later than its speed: an ST to a standing axis would end the motion that begins meanwhile.
TEST(Uim342Stop, AStatusThatIsLaterThanTheSpeedIsNoMotion) {
    Running r;
    int stops = 0;
    const Message moves = r.f.say(0x11, r.f.status());
    r.f.script = [&](const Message& m) {
        if (m.cw == 0x97) ++stops;
        FakeNode::Verdict v;
        if (m.function() == cw::MS && form_of(m) == Form::get && m.d[0] == 0) v.instead = moves;
        return v;
    };
    r.b.ask(QuickStop{});
    r.b.run(2s);
    EXPECT_EQ(stops, 1) << "it has stopped, and its speed says so";
    r.b.run(1s);
    EXPECT_EQ(stops, 2) << "a status that goes on saying so is believed in the end";
}

TEST(Uim342Enable, AStatusThatIsLaterThanTheDriverIsNoRestart) {
    Running r(0);
    r.b.ask(Disable{});
    r.b.run(100ms);
    const auto before = r.b.notices_of("presence");
    const Message off = r.f.say(0x11, r.f.status());
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.function() == cw::MS && form_of(m) == Form::get && m.d[0] == 0) v.instead = off;
        return v;
    };
    r.b.ask(Enable{});
    r.b.run(300ms);
    EXPECT_EQ(r.b.notices_of("presence"), before) << "it has not been seen on yet";
    r.f.script = {};
    r.b.run(100ms);
    EXPECT_EQ(r.b.feedback().power, AxisFeedback::Power::on);
    r.f.set_driver(false);
    r.b.run(100ms);
    EXPECT_EQ(r.b.notices_of("presence"), before + 1) << "now it has";
}

TEST(Uim342Disable, AStatusFromBeforeMO0IsNoRestart) {
    Running r(0);
    r.b.ask(Enable{});
    r.b.run(100ms);
    const auto before = r.b.notices_of("presence");
    const Message on = r.f.say(0x11, r.f.status());
    bool late = true;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (late && m.function() == cw::MS && form_of(m) == Form::get && m.d[0] == 0) v.instead = on;
        return v;
    };
    r.b.ask(Disable{});
    r.b.run(300ms);
    late = false;
    r.b.run(300ms);
    EXPECT_EQ(r.b.notices_of("presence"), before) << "it was told to switch off";
    EXPECT_EQ(r.b.feedback().power, AxisFeedback::Power::off);
}

// --- halt ------------------------------------------------------------------------------------------------------------------------

TEST(Uim342Halt, DeceleratesWithDcByJogSpeedZero) {
    Running r;
    EXPECT_EQ(r.b.ask(Halt{}).outcome, Outcome::accepted);
    r.b.run(50ms);
    EXPECT_FALSE(r.b.feedback().moving);
    EXPECT_EQ(r.b.received(5), lines({"9D 00 00 00 00", "96"}));
    for (const auto& s : r.b.sent) {
        if (s.at > r.b.now - 50ms && s.message.cw != 0x91) EXPECT_EQ(s.priority, Priority::urgent) << hex(s.message);
    }
    EXPECT_EQ(r.b.feedback().power, AxisFeedback::Power::on);
}

TEST(Uim342Halt, AtRestAndWithRampsAsTimesItIsSt) {
    Running rest(0);
    EXPECT_EQ(rest.b.ask(Halt{}).outcome, Outcome::accepted);
    EXPECT_EQ(rest.b.received(5), lines({"97"}));
    EXPECT_FALSE(rest.b.feedback().quick_stopping);

    Bench b;
    FakeNode& f = b.add(5);
    f.values[0x0604] = le(1, 2);
    f.on = true;
    b.start();
    b.ask(jog(100));
    b.mark();
    EXPECT_EQ(b.ask(Halt{}).outcome, Outcome::accepted);
    EXPECT_EQ(b.received(5), lines({"97"})) << "a ramp in ms to speed 0 is not defined";
}

TEST(Uim342Halt, AnInPositionFlagSurvivesAHaltAtRest) {
    Running r(0);
    r.f.paif = true;
    r.b.run(200ms);
    ASSERT_TRUE(r.b.feedback().target_reached);
    r.b.ask(Halt{});
    r.b.run(200ms);
    EXPECT_TRUE(r.b.feedback().target_reached);
}

TEST(Uim342Halt, EveryStepMayFailThenStStops) {
    for (const std::uint8_t cw : Bytes{0x9D, 0x96}) {
        for (const bool silent : {false, true}) {
            SCOPED_TRACE(testing::Message() << std::hex << int(cw) << (silent ? " silent" : " refused"));
            Running r;
            FakeNode::Verdict v;
            if (silent)
                v.answer = v.execute = false;
            else
                v.error = 0x3F;
            r.script(cw, v);
            const Result h = r.b.ask(Halt{});
            EXPECT_EQ(h.outcome, Outcome::accepted);
            EXPECT_EQ(std::ranges::count(r.b.received(5), "97"), cw == 0x96 && silent ? 2 : 1);
            EXPECT_TRUE(r.f.stop);
            EXPECT_EQ(r.b.notices_of("stop"), 1u);
            const auto sent = r.b.received(5);
            EXPECT_LE(std::ranges::count(sent, "96"), 1) << "BG is not repeated, here either";
        }
    }
}

TEST(Uim342Halt, WaitsForTheMotionExchangeInProgress) {
    // JV=0 must not overtake a PA that the following BG would then start.
    Running r;
    r.b.frame_time = 5ms;
    const Ticket m = r.b.command(absolute(100000, 100));
    ASSERT_TRUE(r.b.run_until([&] { return r.b.sent.back().message.cw == 0xA0; }, 1s));
    const Ticket h = r.b.command(Halt{});
    r.b.run(1s);
    EXPECT_EQ(r.b.results[m].reason, Reason::interrupted);
    EXPECT_EQ(r.b.results[h].outcome, Outcome::accepted);
    const auto sent = r.b.received(5);
    ASSERT_EQ(sent.size(), 3u);
    EXPECT_EQ(sent[0].substr(0, 2), "A0");
    EXPECT_EQ(sent[1], "9D 00 00 00 00");
    EXPECT_EQ(sent[2], "96");
    EXPECT_TRUE(r.f.stop);
}

TEST(Uim342Halt, NothingGetsBetweenItsTwoInstructions) {
    Running r;
    r.f.script = [](const Message&) { return FakeNode::late(20ms); };
    r.b.command(Halt{});
    r.b.command(absolute(100000, 100));
    r.b.run(2s);
    const auto h = r.b.received(5);
    ASSERT_GE(h.size(), 4u);
    EXPECT_EQ(h[0], "9D 00 00 00 00");
    EXPECT_EQ(h[1], "96");
    EXPECT_EQ(h[2].substr(0, 2), "A0");
}

TEST(Uim342Halt, DuringAnEmergencyRampItIsSt) {
    Running r;
    r.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x97) {
            v.execute = false;
            v.instead = message(5, 0x17);
        }
        return v;
    };
    r.b.ask(QuickStop{});
    r.b.mark();
    EXPECT_EQ(r.b.ask(Halt{}).outcome, Outcome::accepted);
    EXPECT_EQ(r.b.received(5), lines({"97"})) << "BG would be refused with 0x3F";
}

TEST(Uim342Halt, AStopBetweenMfAndItsValueBeginsThePairAnew) {
    Running r;
    // What gets in between may use the selection up, and AC of group 0 would be overwritten; and JV could go astray, so it is ST.
    r.f.script = [&](const Message& m) { return FakeNode::late(m.cw == 0x98 ? 10ms : 200us); };
    const Ticket w = r.b.command(WriteParameter{Bench::point("MF3.AC"), Value{std::int64_t{4711}}});
    r.b.run(3ms);
    r.b.command(Halt{});
    r.b.run(300ms);
    EXPECT_EQ(r.b.results[w].outcome, Outcome::done) << r.b.results[w].text;
    EXPECT_EQ(r.f.group[0x0319], le(4711, 4));
    EXPECT_EQ(r.f.values[0x19FF], le(10000, 4)) << "group 0 is untouched";
    EXPECT_TRUE(r.f.stop);
    EXPECT_EQ(r.b.received(5), lines({"98 03", "97", "98 03", "99 67 12 00 00"}));
}

// --- bounds ----------------------------------------------------------------------------------------------------------------------

TEST(Uim342Stop, MoreStopsThanCanBeWatchedAreStillSent) {
    Running r;
    r.script(0x97, FakeNode::answer_if(false));
    std::vector<Ticket> tickets;
    for (int i = 0; i < 10; ++i)
        tickets.push_back(r.b.command(QuickStop{}));
    EXPECT_EQ(std::ranges::count_if(r.b.sent, [](const auto& s) { return s.message.function() == 0x17 && s.priority == Priority::urgent; }),
              10);
    r.b.run(1s);
    for (const Ticket t : tickets)
        EXPECT_TRUE(r.b.results.contains(t));
}

TEST(Uim342Stop, ToADriveThatIsAbsentItIsSentOnceMoreAndTold) {
    Bench b;
    b.add(5, {}, false);
    b.start(2s);
    const auto before = b.sent.size();
    const Result r = b.ask(QuickStop{});
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.reason, Reason::no_answer);
    EXPECT_TRUE(std::any_of(b.sent.begin() + static_cast<std::ptrdiff_t>(before), b.sent.end(),
                            [](const auto& s) { return s.message.cw == 0x97; }));
}

// --- joint start and stop --------------------------------------------------------------------------------------------------------

struct Pair {
    Bench b;
    Pair(std::initializer_list<std::pair<std::uint8_t, std::uint8_t>> ids_and_groups, bool prepare = true) {
        for (const auto& [id, group] : ids_and_groups)
            b.add(id).values[0x0108] = le(group, 1);
        b.start();
        for (std::uint16_t a = 0; a < b.setup.drives.size(); ++a)
            b.ask(Enable{}, false, a);
        b.run(100ms);
        if (prepare) {
            for (std::uint16_t a = 0; a < 2; ++a)
                prepare_axis(a);
        }
        b.mark();
    }
    void prepare_axis(std::uint16_t a) {
        Move m = absolute(1000 + a, 100);
        m.prepare_only = true;
        const Result r = b.ask(m, false, a);
        EXPECT_EQ(r.outcome, Outcome::accepted);
        EXPECT_FALSE(b.feedback(a).moving);
    }
    std::vector<Message> broadcasts() const {
        std::vector<Message> list;
        for (std::size_t i = b.sent_mark; i < b.sent.size(); ++i) {
            if (b.sent[i].broadcast) list.push_back(b.sent[i].message);
        }
        return list;
    }
};
StartTogether both() { return {{AxisId{0}, AxisId{1}}}; }

TEST(Uim342Together, OneBeginToTheGroup) {
    Pair p{{5, 10}, {37, 10}, {6, 11}};
    const Result r = p.b.ask(both());
    EXPECT_EQ(r.outcome, Outcome::accepted) << r.text;
    EXPECT_EQ(p.broadcasts(), (std::vector{message(10, 0x16)})) << "no acknowledgement asked of a group";
    EXPECT_FALSE(p.b.fake(5).stop);
    EXPECT_FALSE(p.b.fake(37).stop);
    EXPECT_TRUE(p.b.fake(6).stop);
    for (std::uint16_t a = 0; a < 2; ++a) {
        EXPECT_TRUE(p.b.feedback(a).moving);
        EXPECT_FALSE(p.b.feedback(a).target_reached);
    }
    const auto received = [&](std::uint8_t id) {
        const auto& f = p.b.fake(id);
        return f.received_at[static_cast<std::size_t>(std::ranges::find(f.received, message(10, 0x16)) - f.received.begin())];
    };
    EXPECT_EQ(received(5), received(37)) << "in the same instant";
}

TEST(Uim342Together, ToAllIfThatIsEverybody) {
    Pair p{{5, 10}, {6, 11}};
    EXPECT_EQ(p.b.ask(both()).outcome, Outcome::accepted);
    EXPECT_EQ(p.broadcasts(), (std::vector{message(0, 0x16)}));
}

TEST(Uim342Together, WhoWouldStartToo) {
    struct Row {
        std::initializer_list<std::pair<std::uint8_t, std::uint8_t>> ids;
        const char* named;
    };
    for (const Row& row :
         {Row{{{5, 10}, {6, 10}, {7, 10}}, "d7"}, Row{{{5, 10}, {6, 11}, {7, 12}}, "d7"}, Row{{{5, 7}, {6, 7}, {7, 12}}, "d7"}}) {
        Pair p{row.ids};
        const Result r = p.b.ask(both());
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_EQ(r.reason, Reason::not_supported);
        EXPECT_NE(r.text.find(row.named), std::string::npos) << r.text;
        EXPECT_TRUE(p.broadcasts().empty());
        EXPECT_TRUE(p.b.fake(5).stop);
        EXPECT_EQ(p.b.read("AC").outcome, Outcome::done) << "the queue goes on";
    }
}

TEST(Uim342Together, ANewGroupCountsAfterTheRestartOnly) {
    Pair p{{5, 10}, {6, 10}, {7, 11}};
    p.b.write("PP[8]", 11, 0);
    EXPECT_EQ(p.b.ask(both()).outcome, Outcome::accepted) << "PP acts after a restart: it still hears group 10";
    EXPECT_EQ(p.broadcasts(), (std::vector{message(10, 0x16)}));
}

TEST(Uim342Together, MustBePreparedOnAndThere) {
    Pair p({{5, 10}, {6, 10}}, false);
    EXPECT_EQ(p.b.ask(both()).reason, Reason::wrong_state) << "nothing prepared";
    p.prepare_axis(0);
    p.prepare_axis(1);
    p.b.ask(Disable{}, false, 1);
    EXPECT_EQ(p.b.ask(both()).reason, Reason::wrong_state) << "one is off";
    p.b.fake(6).silent = true;
    p.b.run(1s);
    EXPECT_EQ(p.b.ask(both()).reason, Reason::no_answer);
    EXPECT_TRUE(p.broadcasts().empty());
    EXPECT_EQ(p.b.ask(StartTogether{{AxisId{0}, AxisId{9}}}).reason, Reason::line_down);
    EXPECT_EQ(p.b.ask(StartTogether{}).reason, Reason::out_of_range);
}

TEST(Uim342Together, OneAxisAloneIsItsOwnBegin) {
    Pair p{{5, 10}, {6, 10}};
    EXPECT_EQ(p.b.ask(StartTogether{{AxisId{0}}}).outcome, Outcome::accepted);
    EXPECT_EQ(p.b.received(5), lines({"96"}));
    EXPECT_TRUE(p.b.received(6).empty());
    EXPECT_EQ(p.b.ask(StartTogether{{AxisId{0}}}).reason, Reason::wrong_state) << "used up";
}

TEST(Uim342Together, WaitsForWhatStandsBefore) {
    Pair p({{5, 10}, {6, 10}}, false);
    // Everything at once: the prepared motions are still in the queues when the joint start comes.
    for (std::uint16_t a = 0; a < 2; ++a) {
        Move m = absolute(500, 100);
        m.prepare_only = true;
        p.b.command(m, false, a);
    }
    const Ticket t = p.b.command(both());
    const Ticket after = p.b.command(WriteParameter{Bench::point("AC"), Value{std::int64_t{99}}}, false, 1);
    p.b.run(200ms);
    EXPECT_EQ(p.b.results[t].outcome, Outcome::accepted) << p.b.results[t].text;
    EXPECT_EQ(p.b.results[after].outcome, Outcome::done);
    const auto h = p.b.received(6);
    EXPECT_LT(std::ranges::find(h, "16") - h.begin(), std::ranges::find(h, "99 63 00 00 00") - h.begin());
}

TEST(Uim342Together, ADriveThatRefusesIsNamed) {
    Pair p{{5, 10}, {6, 10}};
    p.b.fake(6).script = [](const Message& m) { return FakeNode::refuse_if(m.cw == 0x16, 0x3F); };
    const Result r = p.b.ask(both());
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.reason, Reason::drive_refused);
    EXPECT_EQ(r.code, 0x3F);
    EXPECT_NE(r.text.find("d6"), std::string::npos) << r.text;
    p.b.run(200ms);
    EXPECT_FALSE(p.b.feedback(1).fault) << "a refusal of ours";
    EXPECT_FALSE(p.b.feedback(1).moving);
}

TEST(Uim342Together, AStopOfOneEndsTheWhole) {
    Pair p{{5, 10}, {6, 10}};
    p.b.fake(6).latency = 30ms;
    const Ticket t = p.b.command(both());
    p.b.run(5ms);
    p.b.command(QuickStop{}, false, 1);
    p.b.run(1s);
    ASSERT_TRUE(p.b.results.contains(t));
    EXPECT_EQ(p.b.results[t].reason, Reason::interrupted);
    EXPECT_TRUE(p.b.fake(6).stop) << "also if the joint BG came behind the stop";
}

TEST(Uim342Together, AStopRightBehindTheJointBeginHoldsEvenIfItOvertakes) {
    Pair p{{5, 10}, {6, 10}};
    p.b.frame_time = 5ms;
    p.b.command(both());
    ASSERT_TRUE(p.b.run_until([&] { return !p.broadcasts().empty(); }, 1s));
    p.b.command(QuickStop{}, false, 1);
    p.b.run(1s);
    EXPECT_TRUE(p.b.fake(6).stop);
    EXPECT_FALSE(p.b.fake(5).stop);
}

TEST(Uim342Together, SecondOneIsBusyWhileTheFirstIsNotDone) {
    Pair p{{5, 10}, {6, 10}};
    p.b.fake(6).latency = 30ms;
    p.b.command(both());
    EXPECT_EQ(p.b.ask(both()).reason, Reason::busy);
}

TEST(Uim342Together, RemovalAndLineDownEndIt) {
    for (const bool removal : {false, true}) {
        Pair p{{5, 10}, {6, 10}};
        p.b.fake(6).latency = 30ms;
        const Ticket t = p.b.command(both());
        p.b.run(5ms);
        if (removal) {
            p.b.setup.drives.pop_back();
            p.b.configure();
        } else {
            p.b.line(false);
        }
        ASSERT_TRUE(p.b.results.contains(t));
        EXPECT_EQ(p.b.results[t].reason, Reason::line_down);
    }
}

TEST(Uim342Together, StartGroupByItsId) {
    Pair p{{5, 10}, {6, 10}, {7, 11}};
    EXPECT_EQ(p.b.ask(Action{"start_group", "10"}).outcome, Outcome::accepted);
    EXPECT_EQ(p.broadcasts(), (std::vector{message(10, 0x16)}));
    EXPECT_EQ(p.b.ask(Action{"start_group", "99"}).reason, Reason::wrong_state) << "nobody is in it";
    EXPECT_EQ(p.b.ask(Action{"start_group", "7"}).reason, Reason::wrong_state) << "a node ID";
    EXPECT_EQ(p.b.ask(Action{"start_group", "x"}).reason, Reason::out_of_range);
    EXPECT_EQ(p.b.ask(Action{"start_group", "3"}).reason, Reason::out_of_range);
}

TEST(Uim342Together, GlobalStop) {
    Pair p{{5, 10}, {6, 10}, {7, 11}};
    p.b.ask(jog(100), false, 2);
    p.b.ask(both());
    p.b.mark();
    const Result r = p.b.ask(Action{"global_stop", ""});
    EXPECT_EQ(r.outcome, Outcome::accepted) << r.text;
    EXPECT_EQ(p.b.sent[p.b.sent_mark].message, message(0, 0x17)) << "first of all, to all, without acknowledgement";
    EXPECT_EQ(p.b.sent[p.b.sent_mark].priority, Priority::urgent);
    for (const std::uint8_t id : Bytes{5, 6, 7}) {
        EXPECT_TRUE(p.b.fake(id).stop);
        EXPECT_EQ(std::ranges::count(p.b.received(id), "97"), 1) << "and each by itself, acknowledged";
    }
    p.b.fake(6).silent = true;
    const Result partly = p.b.ask(Action{"global_stop", ""});
    EXPECT_EQ(partly.outcome, Outcome::failed);
    EXPECT_NE(partly.text.find("d6"), std::string::npos) << partly.text;
}

}  // namespace
}  // namespace axisgate::uim342::test
