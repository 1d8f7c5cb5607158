// Start-up, presence and polls of the UIM342 adapter: who is found, what is read, what a silence costs, how it heals.
#include "adapters/uim342/tests/fake_bench.hpp"

namespace axisgate::uim342::test {
namespace {

TEST(Uim342Startup, FirstAskedIsTheModelThenEverythingIsReadAndNothingWritten) {
    Bench b;
    FakeNode& f = b.add(5);
    b.start();
    ASSERT_FALSE(b.sent.empty());
    EXPECT_EQ(b.sent.front().message, message(5, 0x8B)) << "04 28 00 8B";
    ASSERT_TRUE(b.link());
    EXPECT_TRUE(b.link()->online);
    EXPECT_NE(b.link()->text.find("UIM342C02"), std::string::npos) << b.link()->text;
    for (const auto& m : f.received) {
        if (m == message(5, 0x98, std::array<std::uint8_t, 1>{0})) continue;  // MF=0 changes no value
        EXPECT_EQ(form_of(m), Form::get) << hex(m);
    }
    // Identity and parameters are known above without anybody having asked.
    EXPECT_EQ(b.sample("SN.serial"), Value{std::int64_t{67305985}});
    EXPECT_EQ(b.sample("SN.vendor"), Value{std::int64_t{2055}});
    EXPECT_EQ(b.sample("ML.firmware"), Value{std::int64_t{298}});
    EXPECT_EQ(b.sample("PP[5]"), Value{std::int64_t{0}});
    EXPECT_EQ(b.sample("PP[7]"), Value{std::int64_t{5}});
    EXPECT_EQ(b.sample("PP[8]"), Value{std::int64_t{10}});
    for (const char* id : {"IC[0]", "IC[1]", "IC[2]", "IC[3]", "IC[4]", "IC[5]", "IC[6]", "IC[7]",      "IE[0]",    "IE[1]",     "IE[2]",
                           "IE[8]", "MT[0]", "MT[1]", "MT[2]", "MT[3]", "QE[0]", "QE[1]", "QE[2]",      "QE[3]",    "QE[4]",     "AC",
                           "DC",    "SS",    "SD",    "BL",    "DV[0]", "DV[1]", "DV[2]", "DV[3]",      "DV[4]",    "IL[0]",     "IL[1]",
                           "IL[2]", "IL[3]", "TG[0]", "TG[1]", "TG[2]", "DI",    "MO",    "MS[0].STOP", "MS[1].SP", "ER[0].code"}) {
        EXPECT_TRUE(known(b.sample(id))) << id;
    }
    EXPECT_EQ(b.sample("SD"), Value{std::int64_t{1600000}});
    const auto& fb = b.feedback();
    EXPECT_EQ(fb.power, AxisFeedback::Power::off);
    EXPECT_FALSE(fb.moving || fb.fault || fb.referenced || fb.target_reached);
    EXPECT_TRUE(b.notices.empty());
    EXPECT_EQ(b.adapter.counters().timeouts, 0u);
}

TEST(Uim342Startup, MfIsClearedBeforeTheGroupValuesAreRead) {
    Bench b;
    FakeNode& f = b.add(5);
    f.mf = 3;  // somebody has left a group selected
    b.start();
    EXPECT_EQ(b.sample("AC"), Value{std::int64_t{10000}}) << "AC of group 0, not of the falling edge of IN1";
}

TEST(Uim342Startup, OneInstructionAtATimePerNodeSeveralNodesTogether) {
    Bench b;
    for (const std::uint8_t id : Bytes{5, 6, 7, 37, 69, 126})
        b.add(id);
    // Count what is on its way per node.
    std::map<std::uint8_t, int> open;
    int most = 0, together = 0;
    b.lose = [&](const Frame& f, bool to_drive) {
        const auto id = to_drive ? consumer_of(f.id) : producer_of(f.id);
        open[id] += to_drive ? 1 : -1;
        most = std::max(most, open[id]);
        int n = 0;
        for (const auto& [k, v] : open)
            n += v > 0;
        together = std::max(together, n);
        return false;
    };
    b.start();
    EXPECT_EQ(most, 1);
    EXPECT_GT(together, 2);
    for (std::uint16_t d = 0; d < 6; ++d)
        EXPECT_TRUE(b.link(d) && b.link(d)->online) << d;
}

TEST(Uim342Startup, IdsThatShareASidAreToldApart) {
    Bench b;
    b.add(5);
    FakeNode& far = b.add(37);
    far.position = 1234;
    b.start();
    EXPECT_EQ(b.feedback(0).position, 0);
    EXPECT_EQ(b.feedback(1).position, 1234);
    Frame f = to_can(message(37, 0x95, std::array<std::uint8_t, 1>{1}));
    EXPECT_EQ(f.id, 0x04284095u);
}

TEST(Uim342Startup, AGatewayAtTheAddressIsNotADrive) {
    Bench b;
    FakeNode& f = b.add(5);
    f.ml = {0x19, 0x0D, 0, 0, 0, 0, 0, 0};
    b.start();
    ASSERT_TRUE(b.link());
    EXPECT_FALSE(b.link()->online);
    EXPECT_NE(b.link()->text.find("UIM2513"), std::string::npos) << b.link()->text;
    EXPECT_EQ(b.ask(ReadParameter{Bench::point("AC")}).reason, Reason::no_answer);
}

TEST(Uim342Startup, ADriveThatRefusesItsModelIsNoUim342) {
    Bench b;
    FakeNode& f = b.add(5);
    f.script = [](const Message& m) { return FakeNode::refuse_if(m.function() == 0x0B, 0x32); };
    b.configure();
    b.line(true);
    const Ticket t = b.command(ReadParameter{Bench::point("AC")});
    b.run(500ms);
    ASSERT_TRUE(b.results.contains(t)) << "nobody waits for ever";
    EXPECT_FALSE(b.link()->online);
    f.script = nullptr;
    b.run(6s);
    EXPECT_TRUE(b.link()->online);
}

TEST(Uim342Startup, AnUnknownModelIsUsedAndNamed) {
    Bench b;
    FakeNode& f = b.add(5);
    f.ml = {0x23, 0x30, 0x15, 0, 1, 0, 0, 0};
    b.start();
    EXPECT_TRUE(b.link()->online);
    EXPECT_EQ(b.notices_of("model"), 1u);
}

TEST(Uim342Startup, AValueThatTheFirmwareDoesNotHaveIsLeftOut) {
    Bench b;
    FakeNode& f = b.add(5);
    f.script = [](const Message& m) {
        FakeNode::Verdict v;
        if (m.function() == 0x3D && m.d[0] == 2) v.error = 0x34;
        return v;
    };
    b.start();
    EXPECT_TRUE(b.link()->online);
    EXPECT_FALSE(known(b.sample("QE[2]")));
    EXPECT_TRUE(known(b.sample("QE[4]")));
    EXPECT_TRUE(b.feedback().warning) << "its ERR flag stands, and it is ours";
    EXPECT_FALSE(b.feedback().fault) << "a refused read is no fault of the axis";
    EXPECT_EQ(b.feedback().error_code, 0x34);
}

TEST(Uim342Startup, AnInstructionThatIsNeverAnsweredDoesNotHoldTheRest) {
    Bench b;
    FakeNode& f = b.add(5);
    f.script = [](const Message& m) {
        FakeNode::Verdict v;
        v.answer = !(m.function() == 0x34 && m.d[0] == 1);
        return v;
    };
    b.start(3s);
    EXPECT_TRUE(b.link()->online);
    EXPECT_FALSE(known(b.sample("IL[1]")));
    EXPECT_TRUE(known(b.sample("MO"))) << "the last value of the list";
    EXPECT_EQ(b.notices_of("protocol"), 1u);
}

TEST(Uim342Startup, StoredIdsThatDifferAreSaid) {
    Bench b;
    FakeNode& f = b.add(5);
    f.values[0x0107] = le(6, 1);
    f.values[0x0105] = le(2, 1);
    b.setup.bit_rate = 1'000'000;
    b.start();
    ASSERT_EQ(b.notices_of("setup"), 2u);
    EXPECT_NE(b.notices[0].text.find("ID 6"), std::string::npos) << b.notices[0].text;
    EXPECT_NE(b.notices[1].text.find("500000"), std::string::npos) << b.notices[1].text;
}

TEST(Uim342Startup, NotificationIsSwitchedOnOnlyIfAskedAndOnlyInRam) {
    for (const bool wanted : {false, true}) {
        Bench b;
        FakeNode& f = b.add(5, wanted ? std::map<std::string, std::string>{{"notify", "on"}} : std::map<std::string, std::string>{});
        f.values[0x0708] = le(0, 2);
        b.start();
        EXPECT_EQ(f.values[0x0708], le(0, 2)) << "never while the driver is off: that would be EEPROM";
        b.ask(Enable{});
        EXPECT_EQ(f.values[0x0708], le(wanted ? 1 : 0, 2));
    }
}

TEST(Uim342Startup, WrongOptionsAreNamed) {
    Bench b;
    b.add(5, {{"notify", "maybe"}, {"home_input", "4"}});
    b.setup.options["crc"] = "14";
    b.setup.options["in_flight"] = "many";
    b.start();
    EXPECT_EQ(b.notices_of("setup"), 4u);
}

// --- polls -----------------------------------------------------------------------------------------------------------------------

TEST(Uim342Poll, RestingAxesAreAskedFourTimesSlower) {
    Bench b;
    FakeNode& f = b.add(5);
    b.start();
    const auto polls = [&](Duration d) {
        b.mark();
        b.run(d);
        const auto list = b.received(5, true);
        EXPECT_EQ(std::ranges::count(list, "91 00"), std::ranges::count(list, "91 01"));
        return std::ranges::count(list, "91 00");
    };
    EXPECT_NEAR(static_cast<double>(polls(4s)), 50, 2) << "every 80 ms";
    f.stop = false;
    f.speed = 500;
    b.run(100ms);
    EXPECT_NEAR(static_cast<double>(polls(4s)), 200, 4) << "every 20 ms";
    EXPECT_TRUE(b.feedback().moving);
    EXPECT_EQ(b.feedback().velocity, 500);
    f.stop = true;
    f.speed = 0;
    b.run(100ms);
    EXPECT_NEAR(static_cast<double>(polls(4s)), 50, 2);
}

TEST(Uim342Poll, PeriodIsASetting) {
    Bench b;
    FakeNode& f = b.add(5);
    f.stop = false;
    b.setup.timing.poll_period = 100ms;
    b.start();
    b.mark();
    b.run(10s);
    EXPECT_NEAR(static_cast<double>(b.received(5, true).size()), 200, 6);
}

TEST(Uim342Poll, FeedbackFromStatusAndSpeed) {
    Bench b;
    FakeNode& f = b.add(5);
    b.start();
    f.on = true;
    f.paif = true;
    f.inputs = 0x0F;
    f.position = -1000;
    f.relative = -500;
    b.run(200ms);
    auto fb = b.feedback();
    EXPECT_EQ(fb.power, AxisFeedback::Power::on);
    EXPECT_TRUE(fb.target_reached);
    EXPECT_EQ(fb.position, -1000);
    EXPECT_EQ(fb.position_demand, -1000);
    EXPECT_EQ(fb.native_status, 0x00037Cu) << "d1 in the low byte, then d2, d3";
    f.stop = false;
    f.paif = false;
    f.speed = -8388607;
    f.position = std::numeric_limits<std::int32_t>::min();
    b.run(200ms);
    fb = b.feedback();
    EXPECT_TRUE(fb.moving);
    EXPECT_FALSE(fb.target_reached);
    EXPECT_EQ(fb.velocity, -8388607);
    EXPECT_EQ(fb.position, std::numeric_limits<std::int32_t>::min());
}

TEST(Uim342Poll, CommandsDoNotStarvePolls) {
    Bench b;
    b.add(5);
    b.start();
    b.mark();
    const Instant begin = b.now;
    int reads = 0;
    while (b.now < begin + 2s) {
        EXPECT_EQ(b.read("AC").outcome, Outcome::done);
        ++reads;
    }
    EXPECT_GT(reads, 500);
    const auto polls = std::ranges::count(b.received(5, true), "91 00");
    EXPECT_GE(polls, 15) << "the picture stays alive";
}

// --- silence ---------------------------------------------------------------------------------------------------------------------

TEST(Uim342Silence, AbsentFromTheBeginning) {
    Bench b;
    b.add(5, {}, false);
    b.configure();
    b.line(true);
    const Ticket t = b.command(ReadParameter{Bench::point("AC")});
    b.run(100ms);
    EXPECT_FALSE(b.results.contains(t)) << "nobody knows yet";
    b.run(100ms);
    ASSERT_TRUE(b.results.contains(t));
    EXPECT_EQ(b.results[t].reason, Reason::no_answer);
    ASSERT_TRUE(b.link());
    EXPECT_FALSE(b.link()->online);
    EXPECT_EQ(b.link()->silent_exchanges, 3u);
    // From now on every command is refused at once, and says so.
    const Result r = b.ask(Enable{});
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::no_answer);
}

TEST(Uim342Silence, PausesGrowUpToTheirLimit) {
    Bench b;
    b.add(5, {}, false);
    b.setup.timing.retry_pause_min = 200ms;
    b.setup.timing.retry_pause_max = 1s;
    b.configure();
    b.line(true);
    b.run(10s);
    std::vector<std::int64_t> gaps;
    for (std::size_t i = 1; i < b.sent.size(); ++i)
        gaps.push_back(milliseconds_of(b.sent[i].at - b.sent[i - 1].at));
    ASSERT_GE(gaps.size(), 8u);
    EXPECT_EQ(std::vector(gaps.begin(), gaps.begin() + 7), (std::vector<std::int64_t>{50, 50, 250, 450, 850, 1050, 1050}));
    for (const auto& s : b.sent)
        EXPECT_EQ(s.message, message(5, 0x8B)) << "an absent drive is asked for its model, nothing else";
    // The pause is shown as it grows.
    EXPECT_EQ(milliseconds_of(b.link()->retry_pause), 1000);
}

TEST(Uim342Silence, ASilentDriveCostsTheOthersNothing) {
    for (const LineKind kind : {LineKind::can, LineKind::bytes}) {
        Bench b(kind);
        FakeNode& live = b.add(5);
        live.stop = false;
        for (const std::uint8_t id : Bytes{6, 7, 8, 9, 10, 11, 12, 13})
            b.add(id, {}, false);
        b.start(5s);
        ASSERT_TRUE(b.link(0) && b.link(0)->online);
        // The longest time between two feedbacks of the living one.
        Duration longest{};
        Instant last = b.now;
        const std::size_t from = b.feedbacks.size();
        b.run(5s);
        for (std::size_t i = from; i < b.feedbacks.size(); ++i) {
            longest = std::max(longest, b.feedbacks[i].value.at - last);
            last = b.feedbacks[i].value.at;
        }
        EXPECT_LT(milliseconds_of(longest), kind == LineKind::can ? 25 : 60);
    }
}

TEST(Uim342Silence, ThreeMissedPollsThenHealingWithAFreshStart) {
    Bench b;
    FakeNode& f = b.add(5);
    b.start();
    const std::size_t links = b.links.size();
    f.silent = true;
    ASSERT_TRUE(b.run_until([&] { return b.links.size() > links; }, 2s));
    EXPECT_FALSE(b.link()->online);
    b.mark();
    f.values[0x19FF] = le(777, 4);  // RAM was lost
    f.silent = false;
    ASSERT_TRUE(b.run_until([&] { return b.link()->online; }, 6s)) << "its first answer is enough";
    b.run(200ms);
    EXPECT_EQ(b.sample("AC"), Value{std::int64_t{777}}) << "everything has been read again";
    EXPECT_EQ(b.read("AC").value, Value{std::int64_t{777}});
}

TEST(Uim342Silence, AnAbsentDriveThatSpeaksIsAskedAtOnce) {
    Bench b;
    FakeNode& f = b.add(5);
    f.silent = true;
    b.start(4s);
    ASSERT_FALSE(b.link()->online);
    f.silent = false;
    b.say(message(5, cw::RT, std::array<std::uint8_t, 1>{0x02}));
    b.run(10ms);
    EXPECT_TRUE(b.link()->online) << "not only after the pause";
}

TEST(Uim342Silence, ZeroIsKeptOnlyIfTheDriveWasNotRestarted) {
    struct Row {
        const char* what;
        std::int32_t before, after;
        bool on_after;
        bool kept;
    };
    for (const Row& r : {Row{"still on: only out of reach", 500, 900, true, true}, Row{"off, elsewhere: restarted", 500, 0, false, false},
                         Row{"off, but where it stood", 500, 500, false, true}, Row{"off, at 0: not to be told", 0, 0, false, false}}) {
        SCOPED_TRACE(r.what);
        Bench b;
        FakeNode& f = b.add(5);
        b.start();
        b.ask(Enable{});
        b.ask(Home{35});
        ASSERT_TRUE(b.feedback().referenced);
        f.position = r.before;
        b.run(200ms);
        f.silent = true;
        ASSERT_TRUE(b.run_until([&] { return !b.link()->online; }, 2s));
        f.silent = false;
        f.on = r.on_after;
        f.position = r.after;
        ASSERT_TRUE(b.run_until([&] { return b.link()->online; }, 6s));
        b.run(100ms);
        EXPECT_EQ(b.feedback().referenced, r.kept);
    }
}

TEST(Uim342Silence, ARestartBetweenTwoPollsIsNoticed) {
    Bench b;
    FakeNode& f = b.add(5);
    b.start();
    b.ask(Home{35});
    f.position = 4000;
    b.run(200ms);
    ASSERT_TRUE(b.feedback().referenced);
    f.values[0x19FF] = le(4321, 4);
    f.position = 0;  // power blip: counters begin at 0, RAM is gone
    b.run(300ms);
    EXPECT_FALSE(b.feedback().referenced);
    EXPECT_EQ(b.notices_of("presence"), 1u);
    EXPECT_EQ(b.sample("AC"), Value{std::int64_t{4321}}) << "read again";
}

TEST(Uim342Silence, AbsoluteEncoderCountsAsReferencedIfTheSiteSaysSo) {
    for (const bool reported : {false, true}) {
        Bench b;
        FakeNode& f =
            b.add(5, reported ? std::map<std::string, std::string>{{"referenced", "absolute"}} : std::map<std::string, std::string>{});
        f.values[0x0605] = le(1, 2);
        b.start();
        EXPECT_EQ(b.feedback().referenced, reported);
    }
}

// --- line and setup --------------------------------------------------------------------------------------------------------------

TEST(Uim342Line, DownFailsEverythingUpBeginsUnseen) {
    Bench b;
    FakeNode& f = b.add(5);
    b.start();
    f.script = [](const Message& m) { return FakeNode::answer_if(m.function() == 0x11); };
    const Ticket a = b.command(ReadParameter{Bench::point("AC")}), c = b.command(Enable{}), s = b.command(QuickStop{});
    b.run(5ms);
    b.line(false);
    for (const Ticket t : {a, c, s}) {
        ASSERT_TRUE(b.results.contains(t));
        EXPECT_TRUE(b.results[t].reason == Reason::line_down || b.results[t].reason == Reason::interrupted);
    }
    EXPECT_FALSE(b.link()->online);
    EXPECT_EQ(b.adapter.deadline(), never);
    EXPECT_EQ(b.ask(Enable{}).reason, Reason::line_down);
    f.script = nullptr;
    b.mark();
    b.line(true);
    b.run(300ms);
    EXPECT_TRUE(b.link()->online);
    EXPECT_EQ(b.received(5).front(), "8B");
    EXPECT_EQ(b.read("AC").outcome, Outcome::done);
}

TEST(Uim342Line, RemovedDrivesEndTheirCommandsOthersGoOn) {
    Bench b;
    b.add(5);
    FakeNode& gone = b.add(6);
    b.start();
    gone.silent = true;
    const Ticket t = b.command(ReadParameter{Bench::point("AC")}, false, 1);
    const auto links = b.links.size();
    b.setup.drives.pop_back();
    b.configure();
    ASSERT_TRUE(b.results.contains(t));
    EXPECT_EQ(b.results[t].outcome, Outcome::failed);
    EXPECT_EQ(b.results[t].reason, Reason::line_down);
    b.mark();
    b.run(500ms);
    EXPECT_EQ(b.links.size(), links) << "the other one was not disturbed";
    for (const auto& s : b.received(5))
        EXPECT_NE(s, "8B");
    EXPECT_EQ(b.ask(Enable{}, false, 1).reason, Reason::line_down);
    EXPECT_EQ(b.read("AC").outcome, Outcome::done);
}

TEST(Uim342Line, AddedAndChangedDrivesBegin) {
    Bench b;
    b.add(5);
    b.start();
    b.add(6);
    b.configure();
    b.run(300ms);
    EXPECT_TRUE(b.link(1) && b.link(1)->online);
    b.setup.drives[0].address = "7";
    b.fakes[7] = std::make_unique<FakeNode>(7);
    b.configure();
    b.run(300ms);
    EXPECT_EQ(b.read("PP[7]").value, Value{std::int64_t{7}});
}

TEST(Uim342Line, AddressesAreCheckedAndBelongToOneDrive) {
    for (const char* good : {"5", "126", "37"})
        EXPECT_EQ(check_address(good), "") << good;
    for (const char* bad : {"", "4", "127", "0", "x", "5 ", "-5", "0x05"})
        EXPECT_NE(check_address(bad), "") << bad;
    Bench b;
    b.add(5);
    b.add(5);
    b.start();
    ASSERT_TRUE(b.link(1));
    EXPECT_FALSE(b.link(1)->online);
    EXPECT_NE(b.link(1)->text.find("d5"), std::string::npos);
    EXPECT_TRUE(b.link(0)->online);
    EXPECT_EQ(b.ask(Enable{}, false, 1).reason, Reason::line_down);
    EXPECT_EQ(b.ask(Enable{}, false, 44).reason, Reason::line_down) << "an axis that nobody knows";
}

TEST(Uim342Line, WhatIsNotTheProtocolIsCounted) {
    Bench b;
    b.add(5);
    b.start();
    const auto before = b.adapter.counters();
    Frame report;
    report.kind = Frame::Kind::can_error;
    report.id = 0x40;
    report.size = 8;
    b.raw(report);
    Frame base = Frame::can_extended(0x123, std::array<std::uint8_t, 1>{1});
    base.extended = false;
    b.raw(base);
    b.raw(Frame::can_extended(0x05202015, std::array<std::uint8_t, 1>{1}));
    b.raw(Frame::can_extended(can_id(5, 4, 0x95), std::array<std::uint8_t, 1>{1}));  // bit 7 set in an answer
    EXPECT_EQ(b.adapter.counters().garbled, before.garbled + 4);
    b.raw(Frame::can_extended(can_id(77, 4, 0x15), std::array<std::uint8_t, 1>{1}));  // nobody of ours
    b.raw(Frame::can_extended(can_id(5, 4, 0x19), std::array<std::uint8_t, 4>{1}));   // nobody has asked
    EXPECT_EQ(b.adapter.counters().unexpected, before.unexpected + 2);
    EXPECT_EQ(b.read("AC").value, Value{std::int64_t{10000}});
}

// --- byte lines ------------------------------------------------------------------------------------------------------------------

TEST(Uim342Bytes, TheWindowIsBounded) {
    for (const auto& [option, most_allowed] : {std::pair{"", 4}, {"1", 1}, {"2", 2}}) {
        Bench b(LineKind::bytes);
        b.frame_time = 2800us;
        if (*option) b.setup.options["in_flight"] = option;
        int open = 0, most = 0;
        for (std::uint8_t id = 20; id < 30; ++id) {  // not 10: that is the nodes' group ID
            b.add(id).stop = false;
            b.fake(id).latency = 10ms;
        }
        b.on_sent = [&] { most = std::max(most, ++open); };
        b.lose = [&](const Frame&, bool to_drive) {
            if (!to_drive) --open;
            return false;
        };
        b.start(8s);
        EXPECT_LE(most, most_allowed);
        EXPECT_GT(most, most_allowed - 1);
        for (std::uint16_t d = 0; d < 10; ++d)
            EXPECT_TRUE(b.link(d) && b.link(d)->online);
        // Slow as the line is, nobody is forgotten: all are polled about equally often.
        b.mark();
        b.run(5s);
        std::size_t least = SIZE_MAX, often = 0;
        for (std::uint8_t id = 20; id < 30; ++id) {
            least = std::min(least, b.received(id, true).size());
            often = std::max(often, b.received(id, true).size());
        }
        EXPECT_GT(least, 20u);
        EXPECT_LE(often - least, 6u);
    }
}

TEST(Uim342Bytes, CrcAutoFindsTheRangeOfTheGateway) {
    for (const CrcMode gateway : {CrcMode::twelve, CrcMode::thirteen}) {
        Bench b(LineKind::bytes);
        b.crc = gateway;
        b.setup.options["crc"] = "auto";
        b.add(5);
        b.start(3s);
        EXPECT_TRUE(b.link()->online) << name_of(gateway);
        EXPECT_EQ(b.read("AC").value, Value{std::int64_t{10000}});
        EXPECT_EQ(b.adapter.counters().timeouts, gateway == CrcMode::twelve ? 0u : 1u) << "pinned after the first answer";
    }
}

TEST(Uim342Bytes, WithoutCrc) {
    Bench b(LineKind::bytes);
    b.crc = CrcMode::none;
    b.setup.options["crc"] = "none";
    b.add(5);
    b.start(2s);
    EXPECT_TRUE(b.link()->online);
}

TEST(Uim342Bytes, GarbageAndSplitRunsCostNothing) {
    Bench b(LineKind::bytes);
    FakeNode& f = b.add(5);
    b.start(2s);
    f.silent = true;
    const Ticket t = b.command(ReadParameter{Bench::point("BL")});
    b.run(120ms);
    const auto frame = to_uimessage(message(5, 0x2D, std::array<std::uint8_t, 4>{0xAA, 0xCC, 0xAD, 0x00}), CrcMode::twelve);
    std::vector<std::uint8_t> bytes{0xAA, 0x05, 0xCC, 0xAD};
    bytes.insert(bytes.end(), frame.begin(), frame.end());
    for (const auto v : bytes)
        b.raw(Frame::run(std::array<std::uint8_t, 1>{v}));
    ASSERT_TRUE(b.results.contains(t));
    EXPECT_EQ(b.results[t].value, Value{std::int64_t{0x00ADCCAA}});
    EXPECT_EQ(b.adapter.counters().garbled, 4u);
}

TEST(Uim342Bytes, PauseKeepsTheLineQuietAfterAnAnswer) {
    Bench b(LineKind::bytes);
    b.setup.timing.pause = 5ms;
    b.add(5);
    b.add(6);
    b.start(3s);
    Instant last{};
    Duration least = 1h;
    b.lose = [&](const Frame&, bool to_drive) {
        if (to_drive) {
            if (last != Instant{}) least = std::min(least, b.now - last);
        } else {
            last = b.now;
        }
        return false;
    };
    b.run(2s);
    EXPECT_GE(least, 5ms);
    EXPECT_TRUE(b.link(0)->online && b.link(1)->online);
}

}  // namespace
}  // namespace axisgate::uim342::test
