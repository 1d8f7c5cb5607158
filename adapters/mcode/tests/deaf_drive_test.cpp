// A drive that is deaf behind its answers, and one that acknowledges nothing: no order is told as accepted that it has not received.
// In: twins with freedoms, lines that are lost on their way. Out: results, and what the shaft did.
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

Move by(std::int64_t way, std::int64_t speed = 4000) {
    Move m;
    m.kind = Move::Kind::relative;
    m.target = way;
    m.velocity = speed;
    m.acceleration = m.deceleration = 20'000;
    return m;
}

struct DeafDrive : LineBench {
    explicit DeafDrive(std::map<std::string, std::string> options = {}, std::string_view name = "!", std::uint32_t rate = 115200)
        : LineBench(name, rate, std::move(options)) {
        run(8s);
        EXPECT_TRUE(online());
    }
    AxisFeedback& axis() { return feedback[AxisId{0}]; }
    double place() { return bus->twin(DriveId{0})->mechanics(1, now).position; }
    /// The first `times` lines that begin with this do not arrive.
    void lose(std::string start, int times) {
        lost = 0;
        on_way = [this, start = std::move(start), times](std::string s) {
            return s.starts_with(start) && ++lost <= times ? std::string() : s;
        };
    }
    int lost = 0;
};

TEST(McodeTurnaround, IsLearnedFromRequestsThatWereSentAtOnceAndLost) {
    Turnaround pause;
    Instant now = at_ns(1'000'000'000);
    const auto lose = [&](Duration behind) {
        pause.answered(now);
        now += behind;
        pause.sends(now);
        return pause.lost(pause.at_once());
    };
    for (int i = 0; i < 10; ++i)
        EXPECT_FALSE(lose(30ms)) << "it was not sent at once: another fault";
    EXPECT_FALSE(lose(0ms));
    pause.received(false);
    EXPECT_TRUE(lose(0ms));
    EXPECT_EQ(pause.pause(), Turnaround::first);
    EXPECT_FALSE(lose(5ms));
    pause.received(true);
    EXPECT_FALSE(lose(5ms)) << "one that was received lies between";
    EXPECT_TRUE(lose(5ms));
    EXPECT_EQ(pause.pause(), Turnaround::longest);
    EXPECT_FALSE(lose(25ms));
    EXPECT_FALSE(lose(25ms));
}

TEST(McodeDeafDrive, IsServedAsAnyOther) {
    for (const char* ms : {"2", "20"}) {
        for (const char* delivered : {"0", "2"}) {
            SCOPED_TRACE(std::string(ms) + " ms, delivered with EM = " + delivered);
            DeafDrive b({{"turnaround_ms", ms}, {"delivered_em", delivered}});
            ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
            const double from = b.place();
            ASSERT_EQ(b.wait(by(8000)).outcome, Outcome::accepted);
            b.run(5s);
            EXPECT_NEAR(b.place() - from, 8000, 2);
            const auto timeouts = b.adapter.counters().timeouts;
            b.run(5s);
            EXPECT_LE(b.adapter.counters().timeouts, timeouts) << "its pause is known";
            EXPECT_EQ(b.wait(Disable{}).outcome, Outcome::done);
        }
    }
}

TEST(McodeTurnaround, ARequestThatWasNotSentAtOnceSaysNothing) {
    Turnaround pause;
    Instant now = at_ns(1'000'000'000);
    pause.answered(now);
    pause.sends(now);
    EXPECT_FALSE(pause.lost(pause.at_once()));
    pause.sends(now += 120ms);
    pause.received(pause.at_once());  // the poll behind the lost line
    pause.answered(now);
    pause.sends(now);
    EXPECT_TRUE(pause.lost(pause.at_once())) << "the second in a row";
}

TEST(McodeTrailingAck, IsAwaitedWhereADriveSendsOne) {
    TrailingAck first, behind, none;
    EXPECT_TRUE(first.expected()) << "not known yet";
    first.stood(AckPlace::before);
    EXPECT_FALSE(first.expected());
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(none.expected());
        none.stood(AckPlace::none);
    }
    EXPECT_FALSE(none.expected());
    behind.stood(AckPlace::behind);
    for (int i = 0; i < 10; ++i)
        behind.stood(AckPlace::none);
    EXPECT_TRUE(behind.expected()) << "some of its answers may be spoiled";
    behind.forget();
    EXPECT_TRUE(behind.expected());
}

/// An acknowledgement behind the data comes while the next request is sent: it would be taken for the answer to that, or spoil it.
TEST(McodeDeafDrive, AnAcknowledgementBehindTheDataSpoilsNoRequest) {
    for (const char* sums : {"0", "1"}) {
        SCOPED_TRACE(std::string("delivered with CK = ") + sums);
        DeafDrive b({{"answer_order", "1"}, {"turnaround_ms", "16"}, {"ck", sums}, {"delivered_ck", sums}}, "a", 9600);
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        for (const std::int64_t way : {8000, -3000}) {
            const double from = b.place();
            ASSERT_EQ(b.wait(by(way)).outcome, Outcome::accepted);
            b.run(6s);
            EXPECT_NEAR(b.place() - from, static_cast<double>(way), 2);
        }
        const auto timeouts = b.adapter.counters().timeouts;
        b.run(5s);
        EXPECT_EQ(b.adapter.counters().timeouts, timeouts);
        EXPECT_EQ(b.wait(Disable{}).outcome, Outcome::done);
    }
}

/// Without checksums an acknowledgement is CR LF, and each line that a program prints ends with one.
TEST(McodeDeafDrive, OutputOfAProgramAcknowledgesNoLine) {
    DeafDrive b({{"chatter_ms", "200"}, {"turnaround_ms", "20"}, {"ck", "0"}});
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    int made = 0;
    for (const std::int64_t way : {4000, -3000, 2500, -1000, 5000, -6000}) {
        const double from = b.place();
        if (b.wait(by(way)).outcome != Outcome::accepted) continue;
        b.run(5s);
        EXPECT_NEAR(b.place() - from, static_cast<double>(way), 2) << "accepted means that it goes";
        ++made;
    }
    EXPECT_GE(made, 4);
}

/// Its acknowledgement is lost each time: the axis shows that the stop was received.
TEST(McodeDeafDrive, AStopThatIsNotAcknowledgedIsJudgedByTheAxis) {
    for (const int kind : {0, 1, 2}) {
        SCOPED_TRACE(kind);
        DeafDrive b;
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        Move m = by(4000);
        m.kind = Move::Kind::velocity;
        m.velocity.reset();
        ASSERT_EQ(b.wait(m).outcome, Outcome::accepted);
        b.run(1s);
        b.on_cable = [](std::string s) { return s == "\x06" ? std::string() : s; };
        const Result r = b.wait(kind == 0 ? CommandBody{Halt{}} : kind == 1 ? CommandBody{QuickStop{}} : CommandBody{Disable{}});
        EXPECT_TRUE(good(r)) << r.text;
        b.run(2s);
        EXPECT_EQ(b.axis().velocity, 0);
    }
}

TEST(McodeQuietDrive, AMoveThatWasLostIsSaidAgainOnce) {
    for (const int times : {1, 2}) {
        DeafDrive b({{"em", "2"}});
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        const double from = b.place();
        b.lose("MA ", times);
        ASSERT_EQ(b.wait(by(8000)).outcome, Outcome::accepted);
        EXPECT_EQ(b.lost, times + 1);
        b.run(200ms);
        EXPECT_TRUE(b.axis().moving || b.axis().velocity != 0) << "accepted means that it goes";
        b.run(5s);
        EXPECT_NEAR(b.place() - from, 8000, 2);
    }
}

TEST(McodeQuietDrive, WhatItNeverReceivedIsNotAccepted) {
    for (const char* line : {"MA ", "VM=", "A=", "HM "}) {
        SCOPED_TRACE(line);
        DeafDrive b({{"em", "2"}});
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        const double from = b.place();
        b.lose(line, 1000);
        const Result r = std::string_view(line) == "HM " ? b.wait(Home{19}) : b.wait(by(8000));
        EXPECT_EQ(r.outcome, Outcome::failed);
        EXPECT_FALSE(r.text.empty());
        b.run(3s);
        EXPECT_NEAR(b.place(), from, 1);
    }
    DeafDrive b({{"em", "2"}});
    ASSERT_EQ(b.wait(Disable{}).outcome, Outcome::done);
    b.lose("DE=1", 1000);
    EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::failed);
}

TEST(McodeQuietDrive, AMoveBeginsWithTheSpeedThatWasAskedFor) {
    DeafDrive b({{"em", "2"}});
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    b.lose("VM=", 1);
    ASSERT_EQ(b.wait(by(20'000, 2000)).outcome, Outcome::accepted);
    b.run(2s);
    EXPECT_EQ(b.axis().velocity, 2000);
}

TEST(McodeQuietDrive, AStopIsSaidUntilItActs) {
    for (const int kind : {0, 1, 2}) {
        SCOPED_TRACE(kind);
        DeafDrive b({{"em", "2"}});
        ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        Move m = by(4000);
        m.kind = Move::Kind::velocity;
        m.velocity.reset();
        ASSERT_EQ(b.wait(m).outcome, Outcome::accepted);
        b.run(1s);
        ASSERT_NE(b.axis().velocity, 0);
        b.lose(kind == 2 ? "DE=0" : "SL 0", 5);
        const Result r = b.wait(kind == 0 ? CommandBody{Halt{}} : kind == 1 ? CommandBody{QuickStop{}} : CommandBody{Disable{}});
        EXPECT_TRUE(good(r)) << r.text;
        EXPECT_GE(b.lost, 6);
        b.run(2s);
        EXPECT_EQ(b.axis().velocity, 0);
        b.lose(kind == 2 ? "DE=0" : "SL 0", 1000);
        if (kind == 2) {
            b.on_way = {};
            ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
            b.lose("DE=0", 1000);
            EXPECT_EQ(b.wait(Disable{}).outcome, Outcome::failed) << "never heard, and told so";
        }
    }
}

/// A search is stopped by the escape character alone, which nobody acknowledges.
TEST(McodeDeafDrive, AnEscapeCharacterIsSaidUntilItActs) {
    DeafDrive b;
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    const std::string input = "IS=1,1,0";  // the home switch, which the search does not find
    ASSERT_EQ(b.wait(Native{{input.begin(), input.end()}, true}).outcome, Outcome::done);
    const Result begun = b.wait(Home{19});
    ASSERT_EQ(begun.outcome, Outcome::accepted) << begun.text;
    b.run(500ms);
    ASSERT_NE(b.axis().velocity, 0);
    b.lose("\x1B", 4);
    const Result r = b.wait(Halt{});
    EXPECT_TRUE(good(r)) << r.text;
    EXPECT_GE(b.lost, 5);
    b.run(1s);
    EXPECT_EQ(b.axis().velocity, 0);
}

TEST(McodeDeafDrive, BlanksInFrontOfNumbersAreNumbersAllTheSame) {
    DeafDrive b({{"number_form", "2"}});
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    const double from = b.place();
    ASSERT_EQ(b.wait(by(4000)).outcome, Outcome::accepted);
    b.run(4s);
    EXPECT_NEAR(b.place() - from, 4000, 2);
    EXPECT_TRUE(b.axis().target_reached);
    EXPECT_EQ(b.wait(ReadParameter{*catalogue().find("VM")}).value, Value{std::int64_t{4000}});
}

TEST(McodeDeafDrive, AMoveThatShowsLateHasNotEnded) {
    DeafDrive b({{"moving_late_ms", "300"}});
    ASSERT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    for (const std::int64_t way : {200, 4000, 20'000}) {
        SCOPED_TRACE(way);
        const double from = b.place();
        ASSERT_EQ(b.wait(by(way)).outcome, Outcome::accepted);
        b.on_feedback = [&](AxisId, const AxisFeedback& fb) {
            if (fb.target_reached) EXPECT_NEAR(b.place() - from, static_cast<double>(way), 2);
        };
        b.run(8s);
        EXPECT_TRUE(b.axis().target_reached);
        b.on_feedback = {};
    }
}

}  // namespace
}  // namespace axisgate::mcode::test
