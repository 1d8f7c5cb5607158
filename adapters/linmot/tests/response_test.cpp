// Responses with other contents, and telegrams that are no answers: a drive whose response is configured otherwise is served as far as it
// tells its position, and what it lacks is said once.
#include "adapters/linmot/tests/line_bench.hpp"

namespace axisgate::linmot::test {
namespace {
constexpr std::uint16_t upid_of_rate = 0x14BE;

Move to(std::int64_t target) {
    Move m;
    m.target = target;
    m.velocity = 1'000'000;
    m.acceleration = m.deceleration = 10'000'000;
    return m;
}
Result rate_of(LineBench& b) { return b.ask(ReadParameter{page().find("14BEh").value()}); }
std::size_t told(const LineBench& b) { return static_cast<std::size_t>(std::ranges::count(b.notices, "not_served", &Notice::kind)); }

void is_served(LineBench& b, std::string_view how) {
    SCOPED_TRACE(how);
    b.run(1s);
    ASSERT_TRUE(b.links[DriveId{0}].online) << b.links[DriveId{0}].text;
    ASSERT_TRUE(b.enable());
    for (const std::int64_t target : {200'000, -70'000}) {
        const Result r = b.ask(to(target));
        ASSERT_TRUE(good(r)) << r.text;
        b.run(2s);
        EXPECT_EQ(b.axis().position, target);
        EXPECT_FALSE(b.axis().moving);
    }
    EXPECT_TRUE(b.links[DriveId{0}].online);
    EXPECT_EQ(told(b), 0u);
}

TEST(LinmotResponse, OtherContentsAreRead) {
    for (const char* content : {"0", "1", "2", "3"}) {
        LineBench b(1, 115200, {{"response_content", content}});
        is_served(b, content);
        EXPECT_EQ(as_integer(rate_of(b).value), std::int64_t{b.drive().ram(upid_of_rate)})
            << "a RAM value stands behind all of the response";
        ASSERT_TRUE(good(b.ask(to(5'000'000))));
        b.run(100ms);
        EXPECT_TRUE(good(b.ask(QuickStop{})));
        b.run(1s);
        EXPECT_FALSE(b.axis().moving);
    }
}

/// A response shows the state of some time ago, and the line is fast: each order takes effect before a response shows it.
TEST(LinmotResponse, AStateOfSomeTimeAgoIsNotTakenForARefusal) {
    for (const char* late : {"60", "250", "500"}) {
        SCOPED_TRACE(late);
        LineBench b(1, 115200, {{"status_late_ms", late}});
        b.run(1s);
        ASSERT_TRUE(b.enable());
        const Result home = b.ask(Home{});
        EXPECT_TRUE(good(home)) << home.text;
        b.run(5s);
        EXPECT_TRUE(b.axis().referenced);
        const Result move = b.ask(to(9'000'000));
        EXPECT_TRUE(good(move)) << move.text;
        b.run(100ms);
        const Result halt = b.ask(Halt{});
        EXPECT_TRUE(good(halt)) << halt.text;
        b.run(2s);
        EXPECT_FALSE(b.axis().moving);
        const Result stop = b.ask(QuickStop{});
        EXPECT_TRUE(good(stop)) << stop.text;
        const Result off = b.ask(Disable{});
        EXPECT_TRUE(good(off)) << off.text;
        EXPECT_EQ(b.axis().power, AxisFeedback::Power::off);
    }
}

/// The drive waits in state 1 and shows bit 1 of the control word late: no safe input has taken its power.
TEST(LinmotResponse, PowerThatIsNotShownYetWasNotTakenAway) {
    LineBench b(1, 115200, {{"status_late_ms", "300"}});
    b.drive().write_control_word(0, b.now);  // by another tool
    b.run(3s);
    ASSERT_EQ(b.drive().state(), 1);
    const Ticket t = b.submit(Enable{});
    for (int i = 0; i < 5000 && b.results[t].empty(); ++i) {
        b.run(1ms);
        ASSERT_FALSE(b.axis().safe_stop) << i << " ms behind the order";
    }
    ASSERT_EQ(b.results[t].size(), 1u);
    EXPECT_TRUE(good(b.results[t][0])) << b.results[t][0].text;
    EXPECT_EQ(b.hand("safe_voltage_enable", Value{false}), "");
    b.run(500ms);
    EXPECT_TRUE(b.axis().safe_stop) << "an input that takes it is still seen";
}

/// A drive whose inputs keep bit 1 from the beginning is told after a while.
TEST(LinmotResponse, PowerThatIsNeverShownIsMissing) {
    LineBench b;
    EXPECT_EQ(b.hand("safe_voltage_enable", Value{false}), "");
    b.run(1s);
    EXPECT_FALSE(good(b.ask(Enable{})));
    EXPECT_TRUE(b.axis().safe_stop || b.drive().state() == 0);
}

/// The search begins behind the answer that said it did not: it is ended.
TEST(LinmotResponse, ASearchThatBeginsTooLateDoesNotGoOn) {
    LineBench b(1, 115200, {{"status_late_ms", "500"}});
    b.run(1s);
    ASSERT_TRUE(b.enable());
    b.hand("control_mask", Value{std::int64_t{0x0800}});  // somebody else holds bit 11 at 0
    const Result home = b.ask(Home{});
    EXPECT_EQ(home.reason, Reason::drive_refused) << home.text;
    b.run(1s);
    b.hand("control_mask", Value{std::int64_t{0}});
    b.run(3s);
    EXPECT_EQ(b.drive().state(), 8) << "bit 11 stayed in the control word";
}

TEST(LinmotResponse, ADriveThatAnswersNoReadOfItsRamIsServed) {
    for (const char* content : {"0", "1", "2"}) {
        LineBench b(1, 115200, {{"ram_access", "0"}, {"response_content", content}});
        is_served(b, content);
        EXPECT_NE(b.links[DriveId{0}].text.find("does not answer reads of RAM values"), std::string::npos) << b.links[DriveId{0}].text;
    }
}

TEST(LinmotResponse, ADriveWithoutAnyPositionIsToldOnce) {
    LineBench b(1, 115200, {{"response_content", "3"}, {"ram_access", "0"}});
    b.run(10s);
    EXPECT_FALSE(b.links[DriveId{0}].online);
    EXPECT_NE(b.links[DriveId{0}].text.find("without a position"), std::string::npos) << b.links[DriveId{0}].text;
    EXPECT_NE(b.links[DriveId{0}].text.find("set the content of the response back"), std::string::npos);
    EXPECT_EQ(told(b), 1u);
    EXPECT_TRUE(b.feedback.empty()) << "a position of 0 would be invented";
    // It may move by another master: a stop is sent, and its status word is the judge.
    b.drive().write_control_word(0x3E, b.now);
    b.drive().write_control_word(0x3F, b.now);
    b.run(1s);
    ASSERT_EQ(b.drive().state_var() >> 8, 8);
    EXPECT_TRUE(good(b.ask(Disable{})));
    EXPECT_LT(b.drive().state_var() >> 8, 8);
}

TEST(LinmotResponse, ContentsThatAreSetBackAreFoundAgain) {
    LineBench b;
    Out out;
    LineAdapter alone{page()};
    alone.configure(b.setup, b.now, out);
    alone.on_line(true, b.now, out);
    const auto answer = [&](const char* hex) {
        out.clear();
        alone.on_frame(Frame::run(bytes_of(hex)), b.now, out);
    };
    answer("01 11 10 02 00 00 00 37 04 C1 08 05 00 00 00 00 00 00 00 04");
    EXPECT_TRUE(out.links.empty()) << "once may be the late answer to a read of another master";
    ASSERT_EQ(out.frames.size(), 1u) << "it is asked again at once";
    answer("01 11 0C 02 00 00 00 37 04 C1 08 05 00 00 00 04");
    ASSERT_FALSE(out.feedback.empty());
    EXPECT_EQ(out.feedback.back().value.position, 5);
}

TEST(LinmotResponse, WhatIsNoAnswerIsNotTakenForOne) {
    LineBench b(1, 115200, {{"unsolicited_ms", "100"}, {"foreign_ms", "70"}});
    is_served(b, "responses without a request");
    const std::int64_t rate = b.drive().ram(upid_of_rate);
    for (int i = 0; i < 400; ++i) {
        const Result r = rate_of(b);
        ASSERT_TRUE(good(r)) << r.text;
        ASSERT_EQ(as_integer(r.value), rate) << "the value of a RAM read is never that of a response";
        b.run(1ms);
    }
    EXPECT_TRUE(b.links[DriveId{0}].online);
}

TEST(LinmotResponse, ADoubledAnswerToARamReadDoesNotLoseTheDrive) {
    LineBench b;
    b.run(1s);
    Out out;
    LineAdapter alone{page()};
    alone.configure(b.setup, b.now, out);
    alone.on_line(true, b.now, out);
    const auto answer = [&](const char* hex) { alone.on_frame(Frame::run(bytes_of(hex)), b.now, out); };
    const char* value = "01 11 10 02 00 00 00 37 04 C1 08 05 00 00 00 A0 86 01 00 04";
    answer("01 11 0C 02 00 00 00 37 04 C1 08 05 00 00 00 04");
    for (int i = 0; i < 3; ++i)
        answer(value);
    const Instant later = b.now + 30ms;
    alone.on_deadline(later, out);  // a poll is outstanding now
    alone.on_frame(Frame::run(bytes_of(value)), later, out);
    ASSERT_FALSE(out.links.empty());
    EXPECT_TRUE(out.links.back().online) << out.links.back().text;
    EXPECT_EQ(alone.counters().unexpected, 1u);
}

}  // namespace
}  // namespace axisgate::linmot::test
