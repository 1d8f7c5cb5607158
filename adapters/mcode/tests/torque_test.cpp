// Torque mode (AS = 3): the drive presses on by itself, V reads 0 and SL does not end it; every stop of the gateway must.
// In: torque mode by a parameter, by a native line, by a stored program; then stops. Out: shafts that stand, results, one warning.
#include <fmt/core.h>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

struct Press : LineBench {
    explicit Press(std::string_view names = "ab", std::map<std::string, std::string> options = {})
        : LineBench(names, 19200, std::move(options)) {
        run(8s);
        for (std::size_t i = 0; i < setup.drives.size(); ++i) {
            EXPECT_EQ(wait(Enable{}, i).outcome, Outcome::done) << i;
            line("TS=51200", i);
        }
    }
    void line(const std::string& text, std::size_t i = 0) {
        const auto r = wait(Native{{text.begin(), text.end()}}, i);
        EXPECT_TRUE(good(r)) << text << ": " << r.text;
    }
    double speed(std::size_t i = 0) { return bus->twin(DriveId{static_cast<std::uint16_t>(i)})->mechanics(1, now).velocity; }
    std::string read(const std::string& text, std::size_t i = 0) {
        const auto r = wait(Native{{text.begin(), text.end()}}, i);
        return to_text(r.value);
    }
    std::size_t reported() const {
        return static_cast<std::size_t>(std::ranges::count_if(notices, [](const Notice& n) { return n.kind == "torque"; }));
    }
};

TEST(McodeTorque, ItIsSeenAsMovingAndEveryStopEndsIt) {
    for (const std::string_view names : {"!", "ab"}) {
        for (const int kind : {0, 1, 2}) {
            const auto what = fmt::format("{} {}", names, kind);
            Press b(names);
            b.line("AS=3");
            b.run(1s);
            EXPECT_NE(b.speed(), 0) << what;
            EXPECT_TRUE(b.feedback.at(AxisId{0}).moving) << what;
            EXPECT_EQ(b.feedback.at(AxisId{0}).velocity, 0) << what << ": V does not tell";
            const CommandBody stop = kind == 0 ? CommandBody{QuickStop{}} : kind == 1 ? CommandBody{Halt{}} : CommandBody{Disable{}};
            EXPECT_TRUE(good(b.wait(stop))) << what;
            b.run(1s);
            EXPECT_EQ(b.speed(), 0) << what;
            EXPECT_FALSE(b.feedback.at(AxisId{0}).moving) << what;
            EXPECT_EQ(b.reported(), kind == 2 ? 0U : 1U) << what;
            EXPECT_EQ(b.feedback.at(AxisId{0}).power == AxisFeedback::Power::on, kind != 2) << what;
            // Nothing comes back by itself, and the axis can be used.
            if (kind != 2) {
                Move m;
                m.kind = Move::Kind::relative;
                m.target = 1000;
                m.velocity = 20000;
                EXPECT_TRUE(good(b.wait(m))) << what;
                b.run(2s);
                EXPECT_TRUE(b.feedback.at(AxisId{0}).target_reached) << what;
                EXPECT_EQ(b.speed(), 0) << what;
            }
        }
    }
}

/// The stop comes before any poll could tell: its own confirmation does.
TEST(McodeTorque, AStopThatComesBeforeItIsKnownEndsItToo) {
    Press b;
    b.line("AS=3");
    EXPECT_TRUE(good(b.wait(Halt{})));
    b.run(1s);
    EXPECT_EQ(b.speed(), 0);
    EXPECT_EQ(b.reported(), 1U);
}

TEST(McodeTorque, AStoppedShaftThatPressesIsStoppedAsWell) {
    Press b;
    b.line("AS=3");
    b.run(500ms);
    b.hand(0, "stall", Value{true});
    b.run(500ms);
    EXPECT_EQ(b.speed(), 0);
    EXPECT_TRUE(b.feedback.at(AxisId{0}).moving) << "it presses";
    EXPECT_TRUE(good(b.wait(QuickStop{})));
    b.run(500ms);
    b.hand(0, "stall", Value{false});
    b.run(1s);
    EXPECT_EQ(b.speed(), 0) << "let go, it stays where it is";
}

TEST(McodeTorque, ALineThatStopsAllDoesNotForgetIt) {
    Press b("abc");
    for (const Duration pause : {Duration{0}, Duration{1s}}) {
        for (const std::size_t i : {0U, 2U}) {
            Move m;
            m.kind = Move::Kind::velocity;
            m.target = 50000;
            EXPECT_TRUE(good(b.wait(m, i)));
        }
        b.line("AS=3", 1);
        b.run(pause);
        std::vector<Ticket> tickets;
        for (std::size_t i = 0; i < 3; ++i)
            tickets.push_back(b.command(QuickStop{}, i));
        b.run(5s);
        for (std::size_t i = 0; i < 3; ++i) {
            ASSERT_TRUE(b.result(tickets[i])) << i;
            EXPECT_TRUE(good(*b.result(tickets[i]))) << b.result(tickets[i])->text;
            EXPECT_EQ(b.speed(i), 0) << i;
        }
    }
}

TEST(McodeTorque, AProgramThatWentIntoItIsStopped) {
    Press b;
    EXPECT_TRUE(good(b.wait(Action{"program.download", "LB SU\nTS=51200\nAS=3\nLB X1\nH 100\nBR X1\nE\n"})));
    EXPECT_TRUE(good(b.wait(Action{"program.start", "SU"})));
    b.run(1s);
    EXPECT_NE(b.speed(), 0);
    EXPECT_TRUE(good(b.wait(QuickStop{})));
    b.run(1s);
    EXPECT_EQ(b.speed(), 0);
    EXPECT_EQ(b.read("PR AS"), "0");
}

}  // namespace
}  // namespace axisgate::mcode::test
