// What is known at once: positions after references, the axis status after measuring, polls that do not pile up.
#include "adapters/pacontrol/tests/fake_bench.hpp"

namespace axisgate::pacontrol::test {
namespace {

TEST(PacontrolFeedback, AReferenceRunIsOverOnlyWhenItsPositionIsKnown) {
    Enabled b(3);
    for (auto& a : b.control.axes)
        a.position = 77;
    b.run(3s);
    ASSERT_EQ(b.feedback(1).position, 77000);
    const Result r = b.ask(Action{"reference", "1,2"}, true);
    EXPECT_EQ(r.outcome, Outcome::done) << r.text;
    for (const std::uint16_t i : {std::uint16_t{0}, std::uint16_t{1}}) {
        EXPECT_EQ(b.feedback(i).position, 0) << "axis " << i + 1 << ", at the instant of the result";
        EXPECT_TRUE(b.feedback(i).referenced);
    }
    EXPECT_EQ(b.feedback(2).position, 77000);
}

TEST(PacontrolFeedback, HomingAndG26TellTheNewPositionWithTheirResult) {
    Enabled b;
    b.control.axes[0].position = 77;
    b.run(1s);
    EXPECT_EQ(b.ask(Home{}, true).outcome, Outcome::done);
    EXPECT_EQ(b.feedback().position, 0);
    EXPECT_EQ(b.action("set_position_g26", "12.5").outcome, Outcome::done);
    EXPECT_EQ(b.feedback().position, 12500);
    EXPECT_EQ(b.action("set_position_g26").outcome, Outcome::done);
    EXPECT_EQ(b.feedback().position, 0);
    b.mark();
    EXPECT_EQ(b.action("set_position_g29", "3").outcome, Outcome::done);
    b.run(20ms);
    EXPECT_EQ(b.sent.at(b.mark_at + 1).text, "190C;1;1;0") << "the next thing on the line is the position";
    EXPECT_EQ(b.feedback().position, 3000);
}

TEST(PacontrolFeedback, TheAxisStatusIsReadAnewAfterMeasuring) {
    Enabled b;
    b.run(1s);
    const auto status = [&] { return b.feedback().native_status >> 8 & 0xFFu; };
    EXPECT_EQ(b.action("measure", "on").outcome, Outcome::done);
    EXPECT_EQ(status(), 8u);
    b.mark();
    EXPECT_EQ(b.action("measure", "off").outcome, Outcome::done);
    EXPECT_EQ(b.enable().outcome, Outcome::accepted) << "not refused for what was";
    EXPECT_EQ(b.ask(absolute(1000), true).outcome, Outcome::done);
    EXPECT_TRUE(std::ranges::any_of(b.sent.begin() + static_cast<std::ptrdiff_t>(b.mark_at),
                                    b.sent.begin() + static_cast<std::ptrdiff_t>(b.mark_at) + 6,
                                    [](const auto& s) { return s.text == "1910;1;0;0"; }))
        << "within the next few exchanges, not with the slow round";
    EXPECT_EQ(status(), 0u);
    const Ticket go = b.command(absolute(90000), true);
    b.run(200ms);
    EXPECT_EQ(status(), 1u) << "moving";
    EXPECT_TRUE(good(b.answer(go)));
}

TEST(PacontrolFeedback, PollsThatCommandsAskForDoNotPileUp) {
    Enabled b;
    for (int round = 0; round < 200; ++round) {
        for (int i = 0; i < 8; ++i)
            b.command(Action{"set_position_g29", std::to_string(round)});
        b.run(8ms);
    }
    ASSERT_TRUE(b.run_until([&] { return b.results.size() == b.tickets; }));
    const std::size_t before = b.sent.size();
    b.run(200ms);
    std::size_t positions = 0;
    for (std::size_t i = before; i < b.sent.size(); ++i)
        positions += b.sent[i].text == "190C;1;1;0";
    EXPECT_LE(positions, 6u) << "one for each cycle of 50 ms: none is left over from the storm";
}

}  // namespace
}  // namespace axisgate::pacontrol::test
