// Verbs of CiA 402 over the UIM342: what goes over the wire, in which order, and what happens when a step fails.
#include "adapters/uim342/tests/fake_bench.hpp"

namespace axisgate::uim342::test {
namespace {

struct Started {
    Bench b;
    FakeNode& f;
    explicit Started(bool enabled = true, std::map<std::string, std::string> options = {}) : f(b.add(5, std::move(options))) {
        b.start();
        if (enabled) EXPECT_EQ(b.ask(Enable{}).outcome, Outcome::accepted);
        b.run(100ms);
        b.mark();
    }
};

/// The drive falls silent, refuses, or answers something else at one instruction.
auto at(std::uint8_t cw, FakeNode::Verdict v) {
    return [cw, v](const Message& m) { return m.cw == cw && form_of(m) == Form::set ? v : FakeNode::Verdict{}; };
}

// --- power -----------------------------------------------------------------------------------------------------------------------

TEST(Uim342Enable, StopsBeforeAndAfterAndLeavesNoOldTarget) {
    Started s(false);
    const Result r = s.b.ask(Enable{});
    EXPECT_EQ(r.outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"97", "95 01", "97", "9D 00 00 00 00"}));
    EXPECT_EQ(s.b.feedback().power, AxisFeedback::Power::on);
}

TEST(Uim342Enable, NothingThatSetsAMotionIsSentWhileTheDriverIsOff) {
    Started s(false);
    for (const auto& m : {absolute(100, 50), relative(100, 50), jog(100)}) {
        const Result r = s.b.ask(m);
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_EQ(r.reason, Reason::wrong_state);
    }
    EXPECT_TRUE(s.b.received(5).empty()) << "a PA kept in the drive would act when it turns on [L1264]";
}

TEST(Uim342Enable, EveryStepMayFail) {
    struct Row {
        std::uint8_t cw;
        const char* last;  ///< the last instruction that was sent
    };
    for (const Row& row : {Row{0x97, "97"}, Row{0x95, "95 01"}, Row{0x9D, "9D 00 00 00 00"}}) {
        for (const bool silent : {false, true}) {
            SCOPED_TRACE(testing::Message() << std::hex << int(row.cw) << (silent ? " silent" : " refused"));
            Started s(false);
            FakeNode::Verdict v;
            if (silent)
                v.answer = v.execute = false;
            else
                v.error = 0x33;
            s.f.script = at(row.cw, v);
            const Result r = s.b.ask(Enable{});
            EXPECT_NE(r.outcome, Outcome::accepted);
            EXPECT_NE(r.outcome, Outcome::done);
            EXPECT_EQ(r.reason, silent ? Reason::no_answer : Reason::drive_refused);
            EXPECT_EQ(s.b.received(5).back(), row.last);
            if (silent) EXPECT_EQ(std::ranges::count(s.b.received(5), row.last), 3) << "two repeats";
        }
    }
}

TEST(Uim342Enable, ADriveThatAcknowledgesWithOffIsNotEnabled) {
    Started s(false);
    s.f.script = at(0x95, FakeNode::say_instead(message(5, 0x15, std::array<std::uint8_t, 1>{0})));
    const Result r = s.b.ask(Enable{});
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(s.b.feedback().power, AxisFeedback::Power::off);
}

TEST(Uim342Enable, ALockedDriveIsNotEnabled) {
    Started s(false);
    s.f.lock = true;
    s.b.run(200ms);
    EXPECT_TRUE(s.b.feedback().fault);
    EXPECT_TRUE(s.b.feedback().quick_stopping);
    EXPECT_EQ(s.b.ask(Enable{}).reason, Reason::wrong_state);
    EXPECT_TRUE(s.b.received(5).empty());
}

/// The flags of MS[0] can be older than BG, by which a move would be at its end before it has begun.
TEST(Uim342Moves, AStatusFromBeforeBGIsNotTheEndOfTheMotion) {
    for (const bool relative_move : {false, true}) {
        Started s;
        s.f.paif = true;
        s.b.run(100ms);
        const Message before = s.f.say(0x11, s.f.status());
        bool late = true;
        s.f.script = [&](const Message& m) {
            FakeNode::Verdict v;
            if (late && m.function() == cw::MS && form_of(m) == Form::get && m.d[0] == 0) v.instead = before;
            return v;
        };
        ASSERT_EQ(s.b.ask(relative_move ? relative(1000, 500) : absolute(1000, 500)).outcome, Outcome::accepted);
        for (int i = 0; i < 10; ++i) {
            s.b.run(50ms);
            EXPECT_TRUE(s.b.feedback().moving && !s.b.feedback().target_reached) << i;
        }
        s.f.position = 998;
        s.f.stop = s.f.paif = true;
        s.f.speed = 0;
        s.b.run(100ms);
        EXPECT_TRUE(!s.b.feedback().moving && s.b.feedback().target_reached) << "it is where it was sent to";
        s.f.position = 0;
        ASSERT_EQ(s.b.ask(absolute(5000, 500)).outcome, Outcome::accepted);
        s.b.run(1900ms);
        EXPECT_TRUE(s.b.feedback().moving);
        s.b.run(300ms);
        EXPECT_FALSE(s.b.feedback().moving) << "a status that goes on saying so is believed in the end";
    }
}

TEST(Uim342Disable, GoesAtOnce) {
    Started s;
    EXPECT_EQ(s.b.ask(Disable{}).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"95 00"}));
    EXPECT_EQ(s.b.feedback().power, AxisFeedback::Power::off);
    for (const auto& x : s.b.sent) {
        if (x.message == message(5, 0x95, std::array<std::uint8_t, 1>{0})) EXPECT_EQ(x.priority, Priority::urgent);
    }
}

// --- motions ---------------------------------------------------------------------------------------------------------------------

TEST(Uim342Move, AbsoluteSendsOnlyWhatDiffers) {
    Started s;
    EXPECT_EQ(s.b.ask(absolute(3200, 1000, 10000, 10000)).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"A0 80 0C 00 00", "9E E8 03 00 00", "96"})) << "AC and DC are as wanted already; SP after PA";
    s.b.mark();
    EXPECT_EQ(s.b.ask(absolute(-3200, 1000, 5000, 20000)).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"9A 20 4E 00 00", "99 88 13 00 00", "A0 80 F3 FF FF", "9E E8 03 00 00", "96"}));
    s.b.mark();
    EXPECT_EQ(s.b.ask(absolute(0, 1000, 5000, 20000)).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5).size(), 3u) << "and now they are known to be set";
}

TEST(Uim342Move, RelativeAndVelocity) {
    Started s;
    EXPECT_EQ(s.b.ask(relative(-3200, 500)).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"9F 80 F3 FF FF", "9E F4 01 00 00", "96"}));
    s.b.mark();
    EXPECT_EQ(s.b.ask(jog(-1000)).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"9D 18 FC FF FF", "96"})) << "four data bytes always: two would be +64536 (E-10)";
}

TEST(Uim342Move, SpeedIsSentAgainAfterAJog) {
    // E-46: JV and SP share one register; without SP the motion would run at |JV|.
    Started s;
    s.b.ask(absolute(100, 700));
    s.f.finish();
    s.b.ask(jog(4000));
    s.b.ask(QuickStop{});
    ASSERT_TRUE(s.b.run_until([&] { return !s.b.feedback().moving; }, 1s));
    s.b.mark();
    EXPECT_EQ(s.b.ask(absolute(200)).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"A0 C8 00 00 00", "9E BC 02 00 00", "96"})) << "the last positioning speed, 700";
}

TEST(Uim342Move, WithoutAnySpeedItIsRefused) {
    Started s;
    const Result r = s.b.ask(absolute(100));
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::out_of_range);
    EXPECT_TRUE(s.b.received(5).empty());
}

TEST(Uim342Move, SpeedOfTheDriveIsUsedIfItHasOne) {
    Bench b;
    FakeNode& f = b.add(5);
    f.values[0x2E02] = le(static_cast<std::uint32_t>(-900), 4);
    f.on = true;
    b.start();
    b.mark();
    EXPECT_EQ(b.ask(absolute(100)).outcome, Outcome::accepted);
    EXPECT_EQ(b.received(5), lines({"A0 64 00 00 00", "9E 84 03 00 00", "96"}));
}

TEST(Uim342Move, RangesAreCheckedBeforeTheWire) {
    Started s;
    for (const Move& m :
         {absolute(std::int64_t{1} << 31, 100), absolute(-(std::int64_t{1} << 31) - 1, 100), absolute(1, 0), absolute(1, -5),
          absolute(1, std::int64_t{1} << 31), absolute(1, 100, 0), absolute(1, 100, 65'000'001), absolute(1, 100, 100, 65'000'001)}) {
        const Result r = s.b.ask(m);
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_EQ(r.reason, Reason::out_of_range) << r.text;
    }
    EXPECT_TRUE(s.b.received(5).empty());
    EXPECT_EQ(s.b.ask(absolute(std::numeric_limits<std::int32_t>::min(), 1)).outcome, Outcome::accepted);
}

TEST(Uim342Move, RampsAsTimesAreConverted) {
    Bench b;
    FakeNode& f = b.add(5);
    f.values[0x0604] = le(1, 2);
    f.values[0x19FF] = le(100, 4);
    f.values[0x1AFF] = le(100, 4);
    f.values[0x1BFF] = le(200, 4);  // SS
    f.on = true;
    b.start();
    b.mark();
    // (1000 - 200) / 3000 = 266.67 ms, (1000 - 200) / 8000 = 100 ms: that one the drive has.
    const Result r = b.ask(absolute(100, 1000, 3000, 8000));
    EXPECT_EQ(r.outcome, Outcome::accepted);
    EXPECT_EQ(b.received(5), lines({"99 0B 01 00 00", "A0 64 00 00 00", "9E E8 03 00 00", "96"}));
    EXPECT_NE(r.text.find("AC = 267 ms"), std::string::npos) << r.text;
    b.mark();
    // Slower than the cut-in speed: no ramp at all, nothing to convert.
    EXPECT_EQ(b.ask(absolute(200, 150, 3000, 3000)).outcome, Outcome::accepted);
    EXPECT_EQ(b.received(5).size(), 3u);
    b.mark();
    const Result slow = b.ask(absolute(100, 1000000, 10, 10));
    EXPECT_EQ(slow.outcome, Outcome::refused);
    EXPECT_NE(slow.text.find("60000 ms"), std::string::npos) << slow.text;
    EXPECT_TRUE(b.received(5).empty());
}

TEST(Uim342Move, AcceptedComesAfterAFeedbackThatIsNotThereYet) {
    Started s;
    s.f.paif = true;
    s.b.run(200ms);
    ASSERT_TRUE(s.b.feedback().target_reached);
    const std::size_t before = s.b.feedbacks.size();
    const Ticket t = s.b.command(absolute(5000, 100));
    ASSERT_TRUE(s.b.run_until([&] { return s.b.results.contains(t); }));
    ASSERT_GT(s.b.feedbacks.size(), before);
    EXPECT_FALSE(s.b.feedback().target_reached);
    EXPECT_TRUE(s.b.feedback().moving);
}

TEST(Uim342Move, AnOldInPositionFlagIsNotTakenForTheNewMotion) {
    // A drive that clears PAIF late, and whose first status after BG is still that of before.
    Started s;
    bool begun = false;
    s.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x96) begun = true;
        if (begun && m.cw == 0x91 && m.d[0] == 0) {
            begun = false;
            v.instead = message(5, 0x11, std::array<std::uint8_t, 8>{0, 0x05, 0x03, 0, 0, 0, 0, 0});
        }
        return v;
    };
    s.b.command(absolute(5000, 100));
    s.b.run(3ms);
    EXPECT_FALSE(s.b.feedback().target_reached);
    s.b.feedbacks.clear();
    s.b.run(300ms);
    for (const auto& fb : s.b.feedbacks)
        EXPECT_TRUE(fb.value.moving && !fb.value.target_reached) << "still on its way";
    s.f.finish();
    s.b.run(100ms);
    EXPECT_TRUE(s.b.feedback().target_reached);
}

TEST(Uim342Move, AMotionThatEndsAtOnceIsShown) {
    Started s;
    s.f.instant_motion = true;
    EXPECT_EQ(s.b.ask(absolute(0, 100)).outcome, Outcome::accepted);
    EXPECT_TRUE(s.b.run_until([&] { return s.b.feedback().target_reached; }, 200ms)) << "PA where it stands already";
}

TEST(Uim342Move, ItsEndIsShown) {
    Started s;
    EXPECT_EQ(s.b.ask(absolute(5000, 100)).outcome, Outcome::accepted) << "what takes time is watched by what the axis shows";
    s.b.run(1s);
    EXPECT_TRUE(s.b.feedback().moving && !s.b.feedback().target_reached);
    s.f.finish();
    s.b.run(50ms);
    EXPECT_EQ(s.b.feedback().position, 5000);
    EXPECT_TRUE(s.b.feedback().target_reached && !s.b.feedback().moving);

    s.b.ask(jog(2000));
    s.b.run(50ms);
    EXPECT_EQ(s.b.feedback().velocity, 2000) << "the speed is there";
}

TEST(Uim342Move, AnotherEndThanTheTargetIsShownAsThat) {
    struct Row {
        const char* what;
        std::function<void(Started&)> then;
        std::function<bool(const AxisFeedback&)> shows;
    };
    const auto stands = [](const AxisFeedback& f) { return !f.moving; };
    const auto faulty = [](const AxisFeedback& f) { return f.fault; };
    const auto off = [](const AxisFeedback& f) { return f.power == AxisFeedback::Power::off; };
    const std::vector<Row> rows{
        {"stopped by the client", [](Started& s) { s.b.command(QuickStop{}); }, stands},
        {"halted", [](Started& s) { s.b.command(Halt{}); }, stands},
        {"disabled", [](Started& s) { s.b.command(Disable{}); }, off},
        {"stopped by an input action", [](Started& s) { s.f.stop = true; }, stands},
        {"switched off by an input action",
         [](Started& s) {
             s.f.on = false;
             s.f.stop = true;
         },
         off},
        {"stalled", [](Started& s) { s.f.tlif = s.f.err = s.f.stop = true; }, faulty},
        {"alarm",
         [](Started& s) {
             s.b.say(message(5, cw::RT, std::array<std::uint8_t, 5>{0, 0x1E}));
         },
         faulty},
    };
    for (const Row& row : rows) {
        SCOPED_TRACE(row.what);
        Started s;
        s.b.ask(absolute(5000, 100));
        s.b.run(100ms);
        ASSERT_FALSE(row.shows(s.b.feedback()));
        s.b.feedbacks.clear();
        row.then(s);
        s.b.run(2s);
        bool shown = false;  // an alarm is until the next status that has no error
        for (const auto& fb : s.b.feedbacks) {
            shown = shown || row.shows(fb.value);
            EXPECT_FALSE(fb.value.target_reached);
        }
        EXPECT_TRUE(shown);
    }
}

TEST(Uim342Move, EveryStepMayBeRefusedAndNothingStarts) {
    struct Row {
        std::uint8_t cw, code;
    };
    for (const Row& row : {Row{0x9A, 0x3C}, Row{0x99, 0x33}, Row{0xA0, 0x33}, Row{0x9E, 0x32}, Row{0x96, 0x3E}, Row{0x96, 0x3F}}) {
        SCOPED_TRACE(testing::Message() << std::hex << int(row.cw));
        Started s;
        s.f.script = at(row.cw, FakeNode::refuse(row.code));
        const Result r = s.b.ask(absolute(100, 100, 111, 222));
        EXPECT_EQ(r.outcome, Outcome::refused);
        EXPECT_EQ(r.reason, Reason::drive_refused);
        EXPECT_EQ(r.code, row.code);
        EXPECT_FALSE(r.text.empty());
        if (row.cw != 0x96) EXPECT_EQ(std::ranges::count(s.b.received(5), "96"), 0);
        EXPECT_FALSE(s.b.feedback().moving);
        s.b.run(200ms);
        EXPECT_FALSE(s.b.feedback().fault) << "a refusal of ours is no fault of the axis";
        EXPECT_TRUE(s.b.feedback().warning);
    }
}

TEST(Uim342Move, EveryStepMayBeSilent) {
    for (const std::uint8_t cw : Bytes{0x9A, 0x99, 0xA0, 0x9E}) {
        SCOPED_TRACE(testing::Message() << std::hex << int(cw));
        Started s;
        s.f.script = at(cw, FakeNode::answer_if(false));
        const Result r = s.b.ask(absolute(100, 100, 111, 222));
        EXPECT_EQ(r.outcome, Outcome::failed);
        EXPECT_EQ(r.reason, Reason::no_answer);
        const auto h = s.b.received(5);
        EXPECT_EQ(std::ranges::count_if(h, [&](const auto& l) { return std::stoul(l.substr(0, 2), nullptr, 16) == cw; }), 3)
            << "two repeats";
        EXPECT_EQ(std::ranges::count(h, "96"), 0) << "nothing starts that could not be set";
    }
}

TEST(Uim342Move, BeginIsNeverRepeated) {
    for (const bool executed : {true, false}) {
        Started s;
        s.f.script = at(0x96, executed ? FakeNode::answer_if(false) : FakeNode::lost());
        const Result r = s.b.ask(absolute(100, 100));
        EXPECT_EQ(r.outcome, Outcome::failed);
        EXPECT_EQ(r.reason, Reason::no_answer);
        EXPECT_NE(r.text.find("not known"), std::string::npos) << r.text;
        s.b.run(100ms);
        EXPECT_EQ(std::ranges::count(s.b.received(5), "96"), 1);
        EXPECT_EQ(s.b.feedback().moving, executed) << "the status tells afterwards";
        EXPECT_FALSE(s.b.feedback().target_reached);
        EXPECT_TRUE(s.b.link()->online);
    }
}

TEST(Uim342Move, AnAlteredValueStartsNothing) {
    Started s;
    s.f.script = at(0xA0, FakeNode::say_instead(message(5, 0x2E, std::array<std::uint8_t, 5>{4, 0x65, 0, 0, 0})));
    const Result r = s.b.ask(absolute(100, 100));
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.reason, Reason::drive_refused);
    EXPECT_EQ(std::ranges::count(s.b.received(5), "96"), 0);
}

TEST(Uim342Move, OneLostFrameIsRepeatedAndHeals) {
    for (const bool down : {true, false}) {
        Started s;
        bool once = true;
        s.b.lose = [&](const Frame& f, bool to_drive) {
            const std::uint8_t wanted = down ? 0xA0 : 0x2E;
            if (to_drive == down && (f.id & 0xFF) == wanted && once) {
                once = false;
                return true;
            }
            return false;
        };
        EXPECT_EQ(s.b.ask(absolute(100, 100)).outcome, Outcome::accepted);
        EXPECT_FALSE(once);
        EXPECT_EQ(s.b.adapter.counters().retries, 1u);
        EXPECT_EQ(std::ranges::count(s.b.received(5), "96"), 1);
    }
}

TEST(Uim342Move, ManyWaitTheSixtyFifthIsRefused) {
    Started s;
    s.f.script = [](const Message&) { return FakeNode::late(40ms); };
    std::vector<Ticket> tickets;
    for (int i = 0; i < 80; ++i)
        tickets.push_back(s.b.command(ReadParameter{Bench::point("AC")}));
    std::size_t busy = 0;
    for (const Ticket t : tickets) {
        if (s.b.results.contains(t)) {
            EXPECT_EQ(s.b.results[t].reason, Reason::busy);
            ++busy;
        }
    }
    EXPECT_GE(busy, 15u);
    EXPECT_LE(busy, 16u);
    s.f.script = nullptr;
    s.b.run(3s);
    for (const Ticket t : tickets)
        EXPECT_TRUE(s.b.results.contains(t));
}

TEST(Uim342Move, CommandsKeepTheirOrder) {
    Started s;
    std::vector<Ticket> t{s.b.command(WriteParameter{Bench::point("AC"), Value{std::int64_t{11}}}), s.b.command(absolute(7, 7)),
                          s.b.command(WriteParameter{Bench::point("AC"), Value{std::int64_t{12}}}),
                          s.b.command(ReadParameter{Bench::point("BL")})};
    s.b.run(100ms);
    EXPECT_EQ(s.b.received(5), lines({"99 0B 00 00 00", "A0 07 00 00 00", "9E 07 00 00 00", "96", "99 0C 00 00 00", "AD"}));
    for (const Ticket x : t)
        EXPECT_TRUE(good(s.b.results[x]));
}

// --- origin and homing -----------------------------------------------------------------------------------------------------------

TEST(Uim342Home, OriginWhereItStands) {
    for (const std::int16_t method : Methods{0, 35, 37}) {
        Started s;
        s.f.position = 777;
        s.b.run(200ms);
        EXPECT_EQ(s.b.ask(Home{method}).outcome, Outcome::accepted);
        EXPECT_EQ(s.b.received(5), lines({"A1"}));
        EXPECT_TRUE(s.b.feedback().referenced);
        EXPECT_TRUE(s.b.feedback().homing_attained);
        EXPECT_EQ(s.b.feedback().position, 0);
        EXPECT_EQ(s.b.ask(Home{method}).outcome, Outcome::accepted);
        EXPECT_EQ(s.b.notices_of("presence"), 0u) << "a zero that we made is no restart";
    }
}

TEST(Uim342Home, OriginIsRefusedWhileTheMotorRuns) {
    Started s;
    s.b.ask(jog(100));
    const Result r = s.b.ask(Home{35});
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.code, 0x41);
    EXPECT_FALSE(s.b.feedback().referenced);
}

TEST(Uim342Home, SetPositionOnlyToZero) {
    Started s;
    s.f.position = 55;
    EXPECT_EQ(s.b.ask(SetPosition{0}).outcome, Outcome::accepted);
    EXPECT_EQ(s.f.position, 0);
    const Result r = s.b.ask(SetPosition{100});
    EXPECT_EQ(r.outcome, Outcome::refused);
    EXPECT_EQ(r.reason, Reason::not_supported);
    EXPECT_NE(r.text.find("OG"), std::string::npos);
}

TEST(Uim342Home, MethodsThatTheDriveCannotFollow) {
    Started s;
    for (const std::int16_t m : Methods{1, 2, 14, 17, 20, 22, 23, 30, 33, 34, 36, -1, 99}) {
        const Result r = s.b.ask(Home{m});
        EXPECT_EQ(r.outcome, Outcome::refused) << m;
        EXPECT_EQ(r.reason, Reason::not_supported) << m;
        EXPECT_GT(r.text.size(), 20u) << m;
    }
    EXPECT_TRUE(s.b.received(5).empty());
}

/// A switch at input 2: what the drive would do at its edge, played by hand.
struct Homing : Started {
    Homing(bool active_high = true)
        : Started(true,
                  {{"home_input", "2"}, {"home_velocity", "500"}, {"home_active", active_high ? "high" : "low"}, {"home_timeout_s", "5"}}),
          high(active_high) {
        set_switch(false);
        b.run(200ms);
        b.mark();
    }
    void set_switch(bool active) { f.inputs = static_cast<std::uint8_t>(active == high ? f.inputs | 2 : f.inputs & ~2); }
    /// The armed edge comes: the action runs, the input is spent.
    void edge(bool active) {
        set_switch(active);
        const bool rising = active == high;
        const auto& il = f.values[0x3401];
        const std::uint8_t action = (rising ? il[1] : il[0]) & 0x7F;
        ASSERT_TRUE(action == 0x03 || action == 0x06) << "the input is not armed for this edge";
        EXPECT_EQ(f.values[0x3501], le(60001, 2));
        if (action == 0x06) f.position = f.speed / 100;  // origin at the edge, then a few pulses of ramp
        f.speed = 0;
        f.stop = true;
        f.values[0x3401] = le(0, 2);
    }
    bool high;
};

TEST(Uim342Home, SearchIntoTheSwitch) {
    for (const bool high : {true, false}) {
        Homing s(high);
        const auto before = s.f.values;
        const auto groups = s.f.group;
        const Ticket t = s.b.command(Home{20});
        ASSERT_TRUE(s.b.run_until([&] { return s.f.speed != 0; }, 1s));
        EXPECT_EQ(s.f.speed, 500) << "method 20 enters the switch in the positive direction";
        const auto h = s.b.received(5);
        EXPECT_EQ(std::ranges::count(h, "B4 01 01"), 0);
        EXPECT_NE(std::ranges::find(h, high ? "B4 01 80 86" : "B4 01 86 80"), h.end()) << "d1 falling, d2 rising, FG = 1";
        s.b.run(300ms);
        EXPECT_EQ(s.b.results[t].outcome, Outcome::accepted);
        EXPECT_TRUE(s.b.feedback().homing && !s.b.feedback().homing_attained);
        EXPECT_EQ(s.b.read("AC").outcome, Outcome::done) << "values can be read meanwhile";
        s.edge(true);
        ASSERT_TRUE(s.b.run_until([&] { return s.b.feedback().homing_attained; }, 1s));
        EXPECT_TRUE(s.b.feedback().referenced);
        EXPECT_FALSE(s.b.feedback().homing_error);
        s.b.run(200ms);
        for (const std::uint16_t key : Words{0x3401, 0x3501})
            EXPECT_EQ(s.f.values[key], before.at(key)) << "put back";
        EXPECT_EQ(s.f.group, groups);
        EXPECT_EQ(s.f.values[0x1AFF], before.at(0x1AFF));
    }
}

TEST(Uim342Home, SearchOutOfTheSwitchApproachesItFirst) {
    Homing s;
    const Ticket t = s.b.command(Home{19});
    ASSERT_TRUE(s.b.run_until([&] { return s.b.results.contains(t); }, 1s));
    EXPECT_EQ(s.b.results[t].outcome, Outcome::accepted) << "the motion was acknowledged";
    EXPECT_EQ(s.f.speed, 500) << "towards the switch, on the positive side";
    s.b.run(200ms);
    s.edge(true);
    ASSERT_TRUE(s.b.run_until([&] { return s.f.speed != 0; }, 1s));
    EXPECT_EQ(s.f.speed, -500) << "method 19 leaves it in the negative direction";
    EXPECT_FALSE(s.b.feedback().referenced);
    s.b.run(200ms);
    s.edge(false);
    s.b.run(300ms);
    EXPECT_TRUE(s.b.feedback().homing_attained);
    EXPECT_TRUE(s.b.feedback().referenced);
}

TEST(Uim342Home, SearchBeginsTheOtherWayIfTheSwitchIsActive) {
    Homing s;
    s.set_switch(true);
    s.b.run(200ms);
    s.b.command(Home{22});
    ASSERT_TRUE(s.b.run_until([&] { return s.f.speed != 0; }, 1s));
    EXPECT_EQ(s.f.speed, 500) << "method 22 enters in the negative direction; first it has to get out";
    s.edge(false);
    ASSERT_TRUE(s.b.run_until([&] { return s.f.speed == -500; }, 1s));
}

TEST(Uim342Home, SearchesThatFail) {
    struct Row {
        const char* what;
        std::function<void(Homing&)> then;
        const char* why;
    };
    const std::vector<Row> rows{
        {"stopped without an edge",
         [](Homing& s) {
             s.f.speed = 0;
             s.f.stop = true;
         },
         "without the switch having changed"},
        {"stopped by the client", [](Homing& s) { s.b.command(QuickStop{}); }, "interrupted by quick_stop"},
        {"driver off",
         [](Homing& s) {
             s.f.on = false;
             s.f.stop = true;
         },
         "the driver is off"},
        {"stall", [](Homing& s) { s.f.tlif = s.f.err = s.f.stop = true; }, "a fault ended it"},
        {"never found", [](Homing&) {}, "the switch was not found within"},
        {"out of reach", [](Homing& s) { s.f.silent = true; }, "has not answered"},
    };
    for (const Row& row : rows) {
        SCOPED_TRACE(row.what);
        Homing s;
        s.b.command(Home{20});
        ASSERT_TRUE(s.b.run_until([&] { return s.f.speed != 0; }, 1s));
        s.b.run(100ms);
        row.then(s);
        ASSERT_TRUE(s.b.run_until([&] { return s.b.notices_of("homing") == 1; }, 10s)) << "whoever waits is told by it";
        const auto reported = std::ranges::find(s.b.notices, "homing", &Notice::kind);
        EXPECT_NE(reported->text.find(row.why), std::string::npos) << reported->text;
        EXPECT_TRUE(s.b.feedback().homing_error);
        s.b.run(500ms);
        EXPECT_FALSE(s.b.feedback().homing_attained);
        EXPECT_FALSE(s.b.feedback().referenced);
        if (s.f.silent) continue;
        EXPECT_TRUE(s.f.stop) << "it does not go on running";
        if (!s.f.on) {
            EXPECT_NE(s.f.values[0x3401], le(0x8080, 2)) << "with the driver off a SET would go to EEPROM";
            s.b.ask(Enable{});
            s.b.run(100ms);
        }
        EXPECT_EQ(s.f.values[0x3401], le(0x8080, 2)) << "the input is not armed any more";
        EXPECT_EQ(s.f.values[0x3501], le(0, 2));
    }
}

TEST(Uim342Home, TheInputIsDisarmedBeforeTheNextMotion) {
    Homing s;
    s.b.command(Home{20});
    ASSERT_TRUE(s.b.run_until([&] { return s.f.speed != 0; }, 1s));
    s.b.command(Disable{});
    s.b.run(200ms);
    s.b.mark();
    s.b.command(Enable{});
    s.b.command(absolute(10, 10));
    s.b.run(300ms);
    const auto h = s.b.received(5);
    const auto disarmed = std::ranges::find(h, "B4 01 80 80"), begun = std::ranges::find(h, "96");
    ASSERT_NE(disarmed, h.end());
    ASSERT_NE(begun, h.end());
    EXPECT_LT(disarmed, begun);
}

// --- fault -----------------------------------------------------------------------------------------------------------------------

TEST(Uim342Fault, StallIsAFaultUntilItIsReset) {
    Started s;
    s.f.tlif = s.f.err = true;
    s.b.say(message(5, cw::RT, std::array<std::uint8_t, 5>{0x00, 0x1D}));
    s.b.run(1ms);
    EXPECT_TRUE(s.b.feedback().fault) << "at once, not with the next poll";
    EXPECT_EQ(s.b.feedback().error_code, 0x1D);
    ASSERT_EQ(s.b.notices_of("alarm"), 1u);
    EXPECT_EQ(s.b.notices.back().severity, Severity::alarm);
    EXPECT_EQ(s.b.notices.back().code, 0x1D);
    s.b.run(300ms);
    EXPECT_TRUE(s.b.feedback().fault);
    s.b.mark();
    EXPECT_EQ(s.b.ask(ResetFault{}).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"91 00 00"}));
    EXPECT_FALSE(s.b.feedback().fault);
    EXPECT_EQ(s.b.feedback().error_code, 0);
}

TEST(Uim342Fault, ALockIsLeftByMotorOff) {
    Started s;
    s.f.lock = s.f.err = true;
    s.b.run(200ms);
    EXPECT_TRUE(s.b.feedback().fault);
    EXPECT_EQ(s.b.ask(absolute(1, 1)).reason, Reason::wrong_state);
    s.b.mark();
    EXPECT_EQ(s.b.ask(ResetFault{}).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"95 00", "91 00 00"}));
    EXPECT_FALSE(s.b.feedback().fault);
    EXPECT_EQ(s.b.feedback().power, AxisFeedback::Power::off);
}

TEST(Uim342Fault, WhatDoesNotGoAwayIsSaid) {
    Started s;
    s.f.tlif = true;
    s.f.script = [&](const Message& m) {
        FakeNode::Verdict v;
        if (m.cw == 0x91 && m.dl == 2) v.instead = message(5, 0x11, s.f.status());
        return v;
    };
    s.b.run(200ms);
    const Result r = s.b.ask(ResetFault{});
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_NE(r.text.find("stall"), std::string::npos) << r.text;
    EXPECT_TRUE(s.b.feedback().fault);
}

TEST(Uim342Fault, AnErrorOfUnknownOriginIsAFaultAndItsCodeIsRead) {
    Started s;
    s.f.err = true;
    s.f.last_error = {0, 0x40, 0x99, 0, 0, 0};
    s.b.run(200ms);
    EXPECT_TRUE(s.b.feedback().fault);
    EXPECT_EQ(s.b.feedback().error_code, 0x40) << "codes that the manual leaves free are passed on";
    s.b.mark();
    EXPECT_EQ(s.b.ask(ResetFault{}).outcome, Outcome::accepted);
    EXPECT_EQ(s.b.received(5), lines({"91 00 00", "8F 00 00"})) << "and the shown error is taken away";
    EXPECT_FALSE(s.b.feedback().fault);
}

TEST(Uim342Fault, AlarmsByKind) {
    struct Row {
        std::uint8_t code;
        bool fault, warning, limit;
        Severity severity;
    };
    for (const Row& r : {Row{0x19, true, false, false, Severity::alarm}, Row{0x1A, true, false, true, Severity::alarm},
                         Row{0x1B, true, false, true, Severity::alarm}, Row{0x1E, true, false, false, Severity::alarm},
                         Row{0x1F, false, true, false, Severity::warning}}) {
        Started s;
        s.f.err = true;
        s.b.say(message(5, cw::RT, std::array<std::uint8_t, 5>{0, r.code}));
        s.b.run(200ms);
        EXPECT_EQ(s.b.feedback().fault, r.fault) << int(r.code);
        EXPECT_EQ(s.b.feedback().warning, r.warning) << int(r.code);
        EXPECT_EQ(s.b.feedback().internal_limit, r.limit) << int(r.code);
        EXPECT_EQ(s.b.feedback().error_code, r.code);
        ASSERT_EQ(s.b.notices_of("alarm"), 1u);
        EXPECT_EQ(s.b.notices.back().severity, r.severity);
    }
}

TEST(Uim342Fault, OffByItselfIsNoticedAndItsRamReadAgain) {
    Started s;
    s.f.values[0x19FF] = le(1234, 4);
    s.f.on = false;
    s.b.run(300ms);
    EXPECT_EQ(s.b.feedback().power, AxisFeedback::Power::off);
    EXPECT_EQ(s.b.notices_of("presence"), 1u);
    EXPECT_EQ(s.b.sample("AC"), Value{std::int64_t{1234}});
}

// --- notifications ---------------------------------------------------------------------------------------------------------------

TEST(Uim342Notify, InputEventsOfOneByte) {
    Started s;
    s.f.inputs = 2;
    s.b.say(message(5, cw::RT, std::array<std::uint8_t, 1>{0x04}));
    s.b.run(1ms);
    ASSERT_EQ(s.b.notices_of("input"), 1u);
    EXPECT_EQ(s.b.notices.back().text, "IN2 rising");
    EXPECT_EQ(s.b.feedback().native_status & 0x10u, 0x10u) << "IN2 in MS[0].d1";
}

TEST(Uim342Notify, FinishedCarriesItsPositionInD4) {
    Started s;
    s.b.setup.timing.poll_period = 5s;
    s.b.configure();
    s.b.command(absolute(-1000, 100));
    s.b.run(30ms);
    ASSERT_FALSE(s.b.feedback().target_reached);
    s.f.finish();
    s.b.say(message(5, cw::RT, std::array<std::uint8_t, 8>{0x29, 0, 0, 0, 0x18, 0xFC, 0xFF, 0xFF}));
    s.b.run(1us);
    EXPECT_TRUE(s.b.feedback().target_reached) << "the notification ends it, without a poll";
    EXPECT_EQ(s.b.feedback().position, -1000);
}

TEST(Uim342Notify, TheEndOfTheMotionBeforeIsNotThatOfTheNewOne) {
    Started s;
    s.b.command(absolute(5000, 100));
    s.b.run(50ms);
    s.b.say(message(5, cw::RT, std::array<std::uint8_t, 8>{0x29, 0, 0, 0, 0x10, 0x27, 0, 0}));  // at 10000: another target
    s.b.run(100ms);
    EXPECT_TRUE(s.b.feedback().moving);
    EXPECT_FALSE(s.b.feedback().target_reached);
}

TEST(Uim342Notify, NeverAnAnswerAndAnyTime) {
    Started s;
    bool once = true;
    s.b.lose = [&](const Frame&, bool to_drive) {
        if (to_drive && once) {
            once = false;
            s.b.say(message(5, cw::RT, std::array<std::uint8_t, 1>{0x01}));
        }
        return false;
    };
    EXPECT_EQ(s.b.read("AC").value, Value{std::int64_t{10000}});
    EXPECT_EQ(s.b.notices_of("input"), 1u);
}

TEST(Uim342Notify, AChatteringInputDoesNotFillTheJournal) {
    Started s;
    for (int i = 0; i < 500; ++i) {
        s.b.say(message(5, cw::RT, std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(1 + i % 2)}));
        s.b.run(2ms);
    }
    EXPECT_LE(s.b.notices_of("input"), 32u);
    EXPECT_GE(s.b.notices_of("input"), 20u);
    s.b.say(message(5, cw::RT, std::array<std::uint8_t, 5>{0, 0x1D}));
    s.b.run(1ms);
    EXPECT_EQ(s.b.notices_of("alarm"), 1u) << "alarms are never left out";
}

TEST(Uim342Notify, UnknownAndShortOnes) {
    Started s;
    const auto before = s.b.adapter.counters().garbled;
    s.b.say(message(5, cw::RT, std::array<std::uint8_t, 1>{0x77}));
    s.b.say(message(5, cw::RT));
    s.b.say(message(5, cw::RT, std::array<std::uint8_t, 5>{0x29}));
    s.b.run(1ms);
    EXPECT_EQ(s.b.adapter.counters().garbled, before + 3);
    EXPECT_FALSE(s.b.feedback().target_reached);
}

TEST(Uim342Notify, AReportThatNobodyAskedFor) {
    Started s;
    s.b.say(message(5, cw::ER, std::array<std::uint8_t, 6>{0, 0x33, 0x81, 5}));
    s.f.err = true;
    s.f.last_error = {0, 0x33, 0x81, 5, 0, 0};
    s.b.run(200ms);
    ASSERT_EQ(s.b.notices_of("error_report"), 1u);
    EXPECT_NE(s.b.notices.back().text.find("PP[5]"), std::string::npos) << s.b.notices.back().text;
    EXPECT_TRUE(s.b.feedback().fault) << "somebody else works on this drive";
    EXPECT_EQ(s.b.feedback().error_code, 0x33);
}

}  // namespace
}  // namespace axisgate::uim342::test
