// The wire format, decoder and adapter of the remote family: recorded telegrams, the loss of a gateway, stops during a command, and
// renewal.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "adapters/remote/adapter.hpp"
#include "adapters/remote/decoder.hpp"

namespace axisgate::remote::test {
namespace {
using namespace std::chrono_literals;
using mirror::Telegram;
using testing::ElementsAre;
using testing::HasSubstr;

Move move_of(Move::Kind kind, std::int64_t target) {
    Move m;
    m.kind = kind;
    m.target = target;
    return m;
}

const Catalogue& catalogue() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/remote.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}
Frame frame(const std::string& text) { return Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}); }

TEST(RemoteWire, GoldenTelegramsAreReadAndWrittenAgain) {
    std::ifstream f(AXISGATE_SOURCE_DIR "/adapters/remote/vectors.txt");
    std::string line;
    int seen = 0;
    while (std::getline(f, line)) {
        if (line.size() < 3 || (line[0] != '>' && line[0] != '<')) continue;
        const std::string text = line.substr(2);
        const auto t = mirror::telegram_of(text);
        ASSERT_TRUE(t) << line;
        EXPECT_EQ(mirror::text_of(*t), text + "\n");
        if (t->kind == Telegram::Kind::request) EXPECT_EQ(body_of(mirror::order_of(t->body).value()), t->body);
        if (t->kind == Telegram::Kind::answer) EXPECT_EQ(body_of(mirror::answer_of(t->body).value()), t->body);
        if (t->kind == Telegram::Kind::state) EXPECT_EQ(body_of(mirror::state_of(t->body).value()), t->body);
        ++seen;
        for (std::size_t i = 0; i < text.size(); ++i) {  // any other character makes it invalid
            std::string bad = text;
            bad[i] = bad[i] == 'Z' ? 'Y' : 'Z';
            EXPECT_FALSE(mirror::telegram_of(bad)) << bad;
        }
    }
    EXPECT_GE(seen, 30);
}

TEST(RemoteWire, AStopInTheMiddleOfARequestIsALineOfItsOwn) {
    const std::string request = mirror::text_of({Telegram::Kind::request, 1, "hall-2/feeder", "move_absolute p=5"});
    const std::string stop = "\n" + mirror::text_of({Telegram::Kind::request, 2, "hall-2/feeder", "halt"});
    std::vector<std::uint64_t> received;
    mirror::Framer framer;
    framer.push(request.substr(0, 20) + stop + request.substr(20), [&](std::string_view line) {
        if (const auto t = mirror::telegram_of(line)) received.push_back(t->number);
    });
    EXPECT_THAT(received, ElementsAre(2)) << "the stop is heard, what it cut is not";
}

TEST(RemoteWire, WhatNeverEndsIsDropped) {
    mirror::Framer framer;
    int lines = 0;
    framer.push(std::string(5000, 'x') + "\n" + mirror::text_of({Telegram::Kind::request, 2, "hall-2/feeder", "halt"}),
                [&](std::string_view) { ++lines; });
    EXPECT_EQ(lines, 1);
}

TEST(RemoteWire, AnAddressIsAGatewayAndAnAxis) {
    EXPECT_EQ(mirror::check_address("hall-2/feeder"), "");
    for (const auto* bad : {"", "feeder", "/feeder", "hall-2/", "hall 2/feeder", "a/b/c", "hall-2/fee\nder"})
        EXPECT_THAT(mirror::check_address(bad), HasSubstr("GATEWAY/AXIS")) << bad;
}

TEST(RemoteWire, TheDecoderSaysWhatItIs) {
    LineDecoder d;
    EXPECT_THAT(d.on_frame(frame(mirror::text_of({Telegram::Kind::request, 7, "hall-2/feeder", "halt"})), true),
                ElementsAre("hall-2/feeder is asked: halt (number 7)"));
    EXPECT_THAT(d.on_frame(frame("nonsense\n"), true), ElementsAre("unknown, no telegram: nonsense"));
}

// A bounded recording has the last runs: it begins and ends anywhere in a telegram.
TEST(RemoteWire, ARecordingCutAtAnyByteIsReadAndNothingOfItIsStrange) {
    const std::string all = "\n" + mirror::text_of({Telegram::Kind::request, 7, "hall-2/feeder", "halt"}) +
                            mirror::text_of({Telegram::Kind::answer, 7, "hall-2/feeder", "accepted"});
    for (std::size_t from = 0; from <= all.size(); ++from) {
        for (std::size_t to = from; to <= all.size(); ++to) {
            LineDecoder d;
            auto lines = d.on_frame(frame(all.substr(from, to - from)), std::nullopt);
            std::ranges::move(d.finish(), std::back_inserter(lines));
            for (const auto& line : lines)
                EXPECT_THAT(line, testing::Not(HasSubstr("unknown"))) << from << ".." << to;
            if (from <= 1 && to == all.size()) EXPECT_THAT(lines, testing::SizeIs(2));
        }
    }
}

/// The other end of the line, whose answers the test gives.
struct Bench : testing::Test {
    LineAdapter adapter{catalogue()};
    Instant now = time_zero + 1h;
    Out out;
    std::vector<Telegram> sent;
    std::vector<Result> results;
    std::vector<DriveLink> links;
    AxisFeedback feedback;
    std::size_t reported = 0;

    void SetUp() override {
        LineSetup line;
        DriveSetup d;
        d.id = DriveId{1};
        d.name = "feeder";
        d.address = "hall-2/feeder";
        d.axes = {{AxisId{10}, 1}};
        line.drives = {d};
        adapter.configure(line, now, out);
        adapter.on_line(true, now, out);
        take();
    }
    void take() {
        mirror::Framer framer;
        for (const auto& tx : out.frames)
            framer.push({reinterpret_cast<const char*>(tx.frame.data().data()), tx.frame.size}, [&](std::string_view line) {
                if (!line.empty()) sent.push_back(mirror::telegram_of(line).value());
            });
        results.insert(results.end(), out.results.begin(), out.results.end());
        links.insert(links.end(), out.links.begin(), out.links.end());
        for (const auto& f : out.feedback) {
            feedback = f.value;
            ++reported;
        }
        out.clear();
    }
    void say(Telegram::Kind kind, std::uint64_t number, std::string body) {
        const std::string text = mirror::text_of({kind, number, "hall-2/feeder", std::move(body)});
        for_each_run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                     [&](const Frame& f) { adapter.on_frame(f, now, out); });
        take();
    }
    static mirror::State standing() {
        mirror::State s;
        s.statusword = 0x0227;
        s.mode = 1;
        s.position = s.demand = 5;
        s.demand_source = DemandSource::drive;
        return s;
    }
    void come_up() {
        ASSERT_EQ(sent.size(), 1u);
        say(Telegram::Kind::state, sent[0].number, body_of(standing()));
        ASSERT_TRUE(links.back().online);
        sent.clear();
    }
    void pass(Duration time) {
        const Instant end = now + time;
        while (adapter.deadline() <= end) {
            now = std::max(now, adapter.deadline());
            adapter.on_deadline(now, out);
            take();
        }
        now = end;
    }
    Ticket ask(CommandBody body) {
        static std::uint64_t next = 0;
        Command c;
        c.ticket = Ticket{++next};
        c.axis = AxisId{10};
        c.body = std::move(body);
        adapter.on_command(c, now, out);
        take();
        return c.ticket;
    }
    [[nodiscard]] std::vector<Telegram> orders() const {
        std::vector<Telegram> list;
        for (const auto& t : sent)
            if (t.body != "state") list.push_back(t);
        return list;
    }
};

TEST_F(Bench, WhoIsToldToBeGoneIsOfflineAtOnceAndHisCommandsHaveFailed) {
    come_up();
    const Ticket move = ask(move_of(Move::Kind::absolute, 100));
    say(Telegram::Kind::gone, 0, "the gateway hall-2 is gone");
    EXPECT_FALSE(links.back().online);
    EXPECT_EQ(links.back().text, "the gateway hall-2 is gone");
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].ticket, move);
    EXPECT_EQ(results[0].reason, Reason::no_answer);
    // A later answer belongs to no request.
    say(Telegram::Kind::answer, orders().at(0).number, "accepted none 0 ");
    EXPECT_EQ(results.size(), 1u);
    // The gateway is back: its state is requested at once, and nothing else is sent.
    sent.clear();
    say(Telegram::Kind::state, 0, body_of(standing()));
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_EQ(sent[0].body, "state");
    say(Telegram::Kind::state, sent[0].number, body_of(standing()));
    EXPECT_TRUE(links.back().online);
    pass(5s);
    EXPECT_TRUE(orders().empty()) << "nothing moves because it is back";
}

TEST_F(Bench, AStopDoesNotWaitForACommandsAnswerAndEndsAMotionThatWaits) {
    come_up();
    ask(move_of(Move::Kind::absolute, 100));
    const Ticket stop = ask(Halt{});
    ASSERT_EQ(orders().size(), 2u);
    EXPECT_EQ(orders()[1].body, "halt wait=5000");
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].reason, Reason::interrupted);
    say(Telegram::Kind::answer, orders()[1].number, "accepted none 0 ");
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[1].ticket, stop);
    EXPECT_EQ(results[1].outcome, Outcome::accepted);
}

TEST_F(Bench, ACommandIsSentOnceAndAStopAgain) {
    come_up();
    ask(Enable{});
    pass(200ms);
    EXPECT_EQ(orders().size(), 1u);
    ask(Halt{});
    sent.clear();
    // States arrive meanwhile, so that the line does not count as lost.
    for (int i = 0; i < 40; ++i) {
        pass(50ms);
        for (const auto& t : std::exchange(sent, {})) {
            if (t.body == "state") say(Telegram::Kind::state, t.number, body_of(standing()));
            if (t.body != "state") EXPECT_EQ(t.body, "halt wait=5000");
        }
    }
    ASSERT_EQ(results.size(), 1u) << "the stop, after its repeats";
    EXPECT_EQ(results[0].reason, Reason::no_answer);
}

TEST_F(Bench, AVelocityMoveIsHeldAndRenewedUntilItHasEnded) {
    come_up();
    ask(move_of(Move::Kind::velocity, -300));
    ASSERT_EQ(orders().size(), 1u);
    EXPECT_EQ(orders()[0].body, "move_velocity v=-300 hold=2000 wait=5000");
    say(Telegram::Kind::answer, orders()[0].number, "accepted none 0 ");
    EXPECT_EQ(results.at(0).outcome, Outcome::accepted);
    EXPECT_TRUE(feedback.moving);
    sent.clear();
    mirror::State turns = standing();
    turns.moving = true;
    std::size_t renewed = 0;
    for (int i = 0; i < 60; ++i) {
        pass(50ms);
        for (const auto& t : std::exchange(sent, {})) {
            if (t.body == "state") say(Telegram::Kind::state, t.number, body_of(turns));
            if (t.body != "state") EXPECT_EQ(t.body, "move_velocity v=-300 hold=2000 renew=1 wait=600");
            renewed += t.body != "state";
        }
    }
    EXPECT_EQ(renewed, 5u) << "in three seconds";
    say(Telegram::Kind::state, 0, body_of(standing()));
    pass(2s);
    EXPECT_TRUE(orders().empty()) << "it has ended there: nothing is renewed";
}

/// The motion may turn before its answer comes, and a renewal that overtakes it is refused.
TEST_F(Bench, AVelocityMoveIsHeldWhileItsAnswerIsAwaited) {
    come_up();
    ask(move_of(Move::Kind::velocity, -300));
    const std::uint64_t order = orders().at(0).number;
    std::size_t renewed = 0;
    const auto pass_and_refuse = [&](int times) {
        for (int i = 0; i < times; ++i) {
            pass(50ms);
            for (const auto& t : std::exchange(sent, {})) {
                if (t.body == "state") say(Telegram::Kind::state, t.number, body_of(standing()));
                if (t.body.find("renew=1") == std::string::npos) continue;
                ++renewed;
                say(Telegram::Kind::answer, t.number, "refused wrong_state 0 not yet");
            }
        }
    };
    sent.clear();
    pass_and_refuse(60);
    EXPECT_EQ(renewed, 5u) << "in three seconds";
    pass(500ms);
    const auto on_its_way = orders();
    say(Telegram::Kind::answer, order, "accepted none 0 ");
    for (const auto& t : on_its_way)
        say(Telegram::Kind::answer, t.number, "refused wrong_state 0 not yet");
    sent.clear();
    pass(650ms);
    EXPECT_EQ(orders().size(), 1u) << "a refusal of a renewal from before the answer says nothing";
    ask(move_of(Move::Kind::velocity, 700));
    say(Telegram::Kind::answer, orders().back().number, "refused out_of_range 0 no");
    ask(move_of(Move::Kind::velocity, 800));
    pass(7s);
    EXPECT_EQ(results.back().reason, Reason::no_answer);
    sent.clear();
    pass(3s);
    for (const auto& t : orders())
        EXPECT_EQ(t.body.find("v=800"), std::string::npos) << "nobody knows whether it turns: it is not held";
}

/// A motion that the other gateway refuses ends nothing there, so the motion in progress is still renewed.
TEST_F(Bench, ARefusedMotionDoesNotEndTheRenewalOfTheOneUnderWay) {
    come_up();
    ask(move_of(Move::Kind::velocity, -300));
    say(Telegram::Kind::answer, orders().at(0).number, "accepted none 0 ");
    mirror::State turns = standing();
    turns.moving = true;
    for (const CommandBody& body : {CommandBody{Home{127}}, CommandBody{move_of(Move::Kind::velocity, 700)}}) {
        sent.clear();
        ask(body);
        ASSERT_EQ(orders().size(), 1u);
        say(Telegram::Kind::answer, orders()[0].number, "refused not_supported 0 no");
        std::size_t renewed = 0;
        for (int i = 0; i < 30; ++i) {
            pass(50ms);
            for (const auto& t : std::exchange(sent, {})) {
                if (t.body == "state") say(Telegram::Kind::state, t.number, body_of(turns));
                if (t.body.find("renew=1") != std::string::npos) {
                    EXPECT_EQ(t.body, "move_velocity v=-300 hold=2000 renew=1 wait=600");
                    ++renewed;
                }
            }
        }
        EXPECT_GE(renewed, 2u) << name_of(body);
    }
}

TEST_F(Bench, AStateFromBeforeAMotionIsThrownAway) {
    come_up();
    pass(300ms);
    ASSERT_FALSE(sent.empty());
    const std::uint64_t question = sent.back().number;
    mirror::State reached = standing();
    reached.target_reached = true;
    ask(move_of(Move::Kind::absolute, 100));
    say(Telegram::Kind::answer, orders().back().number, "accepted none 0 ");
    EXPECT_TRUE(feedback.moving && !feedback.target_reached);
    say(Telegram::Kind::state, question, body_of(reached));
    EXPECT_TRUE(feedback.moving && !feedback.target_reached) << "asked before the motion";
    pass(20ms);
    reached.age_ms = 20;
    say(Telegram::Kind::state, 0, body_of(reached));
    EXPECT_TRUE(feedback.moving && !feedback.target_reached) << "sampled before the motion, and sent behind it";
    say(Telegram::Kind::state, sent.back().number, body_of(reached));
    EXPECT_TRUE(feedback.moving && !feedback.target_reached) << "the same, as an answer to a later question";
    reached.age_ms = 18;
    say(Telegram::Kind::state, 0, body_of(reached));
    EXPECT_TRUE(!feedback.moving && feedback.target_reached);
}

TEST_F(Bench, AFaultIsShownHoweverOldItsStateIs) {
    come_up();
    ask(move_of(Move::Kind::absolute, 100));
    say(Telegram::Kind::answer, orders().back().number, "accepted none 0 ");
    mirror::State s = standing();
    s.statusword = 0x0208;
    s.fault = true;
    s.age_ms = 1000;
    say(Telegram::Kind::state, 0, body_of(s));
    EXPECT_TRUE(feedback.fault && !feedback.moving);
}

TEST_F(Bench, WhatIsStaleOrSimulatedThereIsSoHere) {
    come_up();
    EXPECT_EQ(feedback.at, now);
    EXPECT_FALSE(feedback.simulated);
    mirror::State s = standing();
    s.stale = s.simulated = true;
    s.age_ms = 1500;
    say(Telegram::Kind::state, 0, body_of(s));
    EXPECT_LT(feedback.at, now - 3s) << "a byte line's values are stale after 3 s";
    EXPECT_TRUE(feedback.simulated);
    s.stale = false;
    say(Telegram::Kind::state, 0, body_of(s));
    EXPECT_EQ(feedback.at, now - 1500ms);
}

}  // namespace
}  // namespace axisgate::remote::test
