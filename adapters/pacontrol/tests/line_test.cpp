// The adapter against the embedded control on a line with honest wire time (9600 baud 7N1), both as they are, in virtual time.
// In: commands, instants. Out: how much of the line is used, and how soon a stop is on it.
// Never looks inside either of them: what counts is what crosses the line, and when.
#include "adapters/pacontrol/tests/rig.hpp"

namespace axisgate::pacontrol::test {
namespace {

TEST(PacontrolLine, PollsOfEightMovingAxesUseWhatTheirBytesAllow) {
    constexpr int axes = 8;
    Rig r(axes);
    r.move_all(axes);
    r.run(1s);
    // From the end of an acknowledgement on: no frame that began before is counted.
    const Instant latest = r.now + 1s;
    for (const std::size_t had = r.answers.size(); r.answers.size() == had && r.now < latest;)
        r.run(1ms);
    const Instant begun = r.answers.back();
    const std::size_t before = r.transmitted + r.received;
    r.positions.clear();
    r.run(15s);
    const double bytes = static_cast<double>(r.transmitted + r.received - before);
    const double share = bytes * seconds(wire_time(bits, baud)) / seconds(r.now - begun);
    RecordProperty("share_of_the_line_percent", std::to_string(100 * share));
    std::printf("the polls of %d axes use %.2f %% of what their bytes allow\n", axes, 100 * share);
    EXPECT_GE(share, 0.95);
    EXPECT_LE(share, 1.001) << "one exchange at a time cannot use more";
    for (int i = 0; i < axes; ++i)
        EXPECT_GE(r.positions[AxisId{static_cast<std::uint16_t>(i)}].size(), 12u) << "axis " << i + 1 << " is heard of";
}

TEST(PacontrolLine, AStopIsOnTheWireAfterAtMostTheExchangeInProgress) {
    constexpr int axes = 8;
    Duration longest{};
    for (int k = 0; k < 40; ++k) {
        SCOPED_TRACE(k);
        Rig r(axes);
        r.move_all(axes);
        r.run(500ms + k * 1700us);
        for (int i = 0; i < axes; ++i)  // and commands that wait, beside the polls
            r.command(Action{"override.speed", "5"}, i);
        const Instant asked = r.now;
        const std::size_t mark = r.handed.size();
        // Handed over already and not answered yet: the exchange in progress.
        const bool in_progress =
            !r.handed.empty() && r.handed.back().at >= r.answers.back();  // the next one leaves at the instant of an answer
        const Ticket stop = r.command(QuickStop{}, 5);
        const Ticket other = r.command(Halt{}, 2);
        r.run(300ms);
        ASSERT_GE(r.handed.size(), mark + 2);
        EXPECT_EQ(r.handed[mark].text.substr(0, 6), "0A9A;6") << "nothing overtakes it";
        EXPECT_EQ(r.handed[mark + 1].text.substr(0, 6), "0A9A;3") << "the next one right behind it";
        const Duration waited = r.handed[mark].at - asked;
        const auto answer = std::ranges::lower_bound(r.answers, asked);
        ASSERT_NE(answer, r.answers.end());
        EXPECT_EQ(r.handed[mark].at, in_progress ? *answer : asked);
        longest = std::max(longest, waited);
        ASSERT_TRUE(r.results.contains(stop) && r.results.contains(other));
        EXPECT_TRUE(good(r.results[stop])) << r.results[stop].text;
    }
    std::printf("longest wait of a stop for the line: %.1f ms\n", 1e3 * seconds(longest));
    // The longest exchange of these: 0A8D;8;1;10.0 or a poll, and its acknowledgement of up to 25 bytes.
    EXPECT_LE(longest, wire_time(std::uint64_t{bits} * 48, baud));
    EXPECT_GT(longest, Duration::zero()) << "some came while an exchange was in progress";
}

Move to(std::int64_t target, std::int64_t velocity) {
    Move m;
    m.target = target;
    m.velocity = velocity;
    return m;
}

TEST(PacontrolLine, AnOperatorAtThePanelIsToldInTheManualsWordsAndNotFought) {
    for (const auto& [panel, words] :
         {std::pair{"manual", "2 (manual by front panel)"}, {"winpac", "20 (manual by WINPAC"}, {"home", "1 (home position)"}}) {
        SCOPED_TRACE(panel);
        Rig r(2);
        ASSERT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
        const Ticket go = r.command(to(400'000, 10'000), 0, true);
        r.run(2s);
        r.hand("panel", std::string(panel));
        const Result x = r.answer(go);
        EXPECT_EQ(x.outcome, Outcome::failed);
        EXPECT_EQ(x.reason, Reason::interrupted);
        EXPECT_NE(x.text.find(words), std::string::npos) << x.text;
        EXPECT_NE(r.notice_of("mode").find("not by this gateway"), std::string::npos) << r.notice_of("mode");
        const std::size_t mark = r.handed.size();
        r.run(3s);
        for (std::size_t i = mark; i < r.handed.size(); ++i)
            EXPECT_EQ(r.handed[i].text[0], '1') << r.handed[i].text << ": nothing but questions";
        EXPECT_LT(r.feedback[AxisId{0}].position, 400'000);
        r.hand("panel", std::string("home"));
        r.run(500ms);
        EXPECT_EQ(r.ask(Enable{}, 0), Outcome::accepted) << "no restart";
        EXPECT_EQ(r.answer(r.command(to(1000, 50'000), 0, true)).outcome, Outcome::done);
    }
}

TEST(PacontrolLine, AMoveWhoseEndNobodyHeardIsUnknownAndItsPositionIsReadBack) {
    Rig r(1);
    ASSERT_EQ(r.ask(Enable{}, 0), Outcome::accepted);
    const Ticket go = r.command(to(20'000, 10'000), 0, true);
    r.run(500ms);
    r.hand("silent", true);
    const Result x = r.answer(go);
    EXPECT_EQ(x.outcome, Outcome::failed);
    EXPECT_EQ(x.reason, Reason::no_answer);
    EXPECT_NE(x.text.find("not known"), std::string::npos) << x.text;
    r.run(10s);
    r.hand("silent", false);
    r.run(8s);
    EXPECT_EQ(r.feedback[AxisId{0}].position, 20'000);
    EXPECT_FALSE(r.feedback[AxisId{0}].target_reached) << "it stands there, and nobody saw it come";
    EXPECT_NE(r.notice_of("motion").find("the end of a motion to 20.0 was never heard; the position read back is 20.0"), std::string::npos)
        << r.notice_of("motion");
}

}  // namespace
}  // namespace axisgate::pacontrol::test
