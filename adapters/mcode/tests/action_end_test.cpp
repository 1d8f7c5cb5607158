// Actions that are answered at their end: a program that was started, a drive that was restarted; and the instant of a feedback.
// In: a real twin on a bus in virtual time, commands with and without until_done. Out: one result each, when and why it comes.
#include <functional>

#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test {
namespace {

constexpr std::uint32_t runs = 32;  // AxisFeedback::native_status: BY

struct One : LineBench {
    explicit One(std::uint32_t rate = 115200) : LineBench("a", rate) {
        run(8s);
        EXPECT_TRUE(online());
        EXPECT_EQ(wait(Enable{}).outcome, Outcome::done);
    }
    void store(const std::string& text) {
        const Result r = wait(Action{"program.download", text});
        ASSERT_EQ(r.outcome, Outcome::done) << r.text;
    }
    bool busy() const { return (feedback.at(AxisId{0}).native_status & runs) != 0; }
    std::size_t answers(Ticket t) const {
        return static_cast<std::size_t>(std::ranges::count_if(results, [&](const Result& r) { return r.ticket == t; }));
    }
};

TEST(McodeActionEnd, AStartedProgramIsDoneWhenItHasEnded) {
    One b;
    b.store("LB AA\nVM=100000\nMR 100000\nH\nE\nLB BB\nE\n");
    const Ticket waits = b.command(Action{"program.start", "AA"}, 0, true);
    b.run(500ms);
    EXPECT_TRUE(b.busy());
    EXPECT_EQ(b.answers(waits), 0U);
    b.run(5s);
    ASSERT_EQ(b.answers(waits), 1U);
    EXPECT_EQ(b.result(waits)->outcome, Outcome::done) << b.result(waits)->text;
    EXPECT_FALSE(b.busy());
    EXPECT_EQ(b.feedback[AxisId{0}].position, 100000);
    // One that is over before the first look, and one that nobody waits for.
    const Ticket brief = b.command(Action{"program.start", "BB"}, 0, true);
    b.run(1s);
    ASSERT_EQ(b.answers(brief), 1U);
    EXPECT_EQ(b.result(brief)->outcome, Outcome::done) << b.result(brief)->text;
    EXPECT_EQ(b.wait(Action{"program.start", "AA"}).outcome, Outcome::accepted);
    b.run(100ms);
    EXPECT_TRUE(b.busy());
    // A start that the drive refuses is no start.
    const Ticket none = b.command(Action{"program.start", "ZZ"}, 0, true);
    b.run(5s);
    ASSERT_EQ(b.answers(none), 1U);
    EXPECT_EQ(b.result(none)->outcome, Outcome::refused);
}

TEST(McodeActionEnd, AnErrorOnItsWayIsNamed) {
    One b;
    b.store("LB AA\nMA 5\nH 500\nE\n");
    ASSERT_EQ(b.wait(Disable{}).outcome, Outcome::done);
    const Ticket t = b.command(Action{"program.start", "AA"}, 0, true);
    b.run(3s);
    ASSERT_EQ(b.answers(t), 1U);
    EXPECT_EQ(b.result(t)->outcome, Outcome::done);
    EXPECT_EQ(b.result(t)->code, 94) << b.result(t)->text;
    EXPECT_NE(b.result(t)->text.find("error 94"), std::string::npos) << b.result(t)->text;
}

TEST(McodeActionEnd, AProgramThatIsEndedOrLostHasFailed) {
    struct Case {
        const char* what;
        Reason reason;
        std::function<void(One&)> act;
    };
    const Case cases[] = {
        {"quick stop", Reason::interrupted, [](One& b) { (void)b.command(QuickStop{}); }},
        {"program.end", Reason::interrupted,
         [](One& b) {
             (void)b.command(Action{"program.end", ""});
         }},
        {"reset", Reason::interrupted,
         [](One& b) {
             (void)b.command(Action{"reset", ""});
         }},
        {"silence", Reason::no_answer, [](One& b) { b.hand(0, "silent", Value{true}); }},
        {"the line", Reason::line_down,
         [](One& b) {
             b.adapter.on_line(false, b.now, b.out);
             b.drain();
         }},
        {"the site", Reason::line_down,
         [](One& b) {
             LineSetup none = b.setup;
             none.drives.clear();
             b.adapter.configure(none, b.now, b.out);
             b.drain();
         }},
    };
    for (const Case& c : cases) {
        One b;
        b.store("LB AA\nMR 51200\nH\nMR -51200\nH\nBR AA\nE\n");
        const Ticket t = b.command(Action{"program.start", "AA"}, 0, true);
        b.run(2s);
        ASSERT_EQ(b.answers(t), 0U) << c.what;
        ASSERT_TRUE(b.busy()) << c.what;
        c.act(b);
        b.run(15s);
        ASSERT_EQ(b.answers(t), 1U) << c.what;
        EXPECT_EQ(b.result(t)->outcome, Outcome::failed) << c.what << b.result(t)->text;
        EXPECT_EQ(b.result(t)->reason, c.reason) << c.what << b.result(t)->text;
    }
    // A halt stops its motion and leaves the program: it is still waited for.
    One b;
    b.store("LB AA\nMR 51200\nH\nH 5000\nE\n");
    const Ticket t = b.command(Action{"program.start", "AA"}, 0, true);
    b.run(300ms);
    (void)b.command(Halt{});
    b.run(2s);
    EXPECT_EQ(b.answers(t), 0U);
    b.run(6s);
    ASSERT_EQ(b.answers(t), 1U);
    EXPECT_EQ(b.result(t)->outcome, Outcome::done) << b.result(t)->text;
}

TEST(McodeActionEnd, ARestartIsDoneWhenTheDriveIsSetUpAgain) {
    One b;
    const Ticket t = b.command(Action{"reset", ""}, 0, true);
    b.run(15s);
    ASSERT_EQ(b.answers(t), 1U);
    EXPECT_EQ(b.result(t)->outcome, Outcome::done) << b.result(t)->text;
    EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done) << "it answers again";
    // It does not come back.
    const Ticket lost = b.command(Action{"reset", ""}, 0, true);
    while (b.sent.back().bytes.find('\x03') == std::string::npos)
        b.run(1ms);
    b.hand(0, "power", Value{false});
    b.run(10s);
    EXPECT_EQ(b.answers(lost), 0U) << "it may come yet";
    b.run(30s);
    ASSERT_EQ(b.answers(lost), 1U);
    EXPECT_EQ(b.result(lost)->outcome, Outcome::failed);
    EXPECT_EQ(b.result(lost)->reason, Reason::no_answer);
}

/// A position belongs to its instant, also when a code that was read later is shown with it.
TEST(McodeActionEnd, AFeedbackIsAsOldAsItsOldestPart) {
    One b(4800);
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = 10000;
    ASSERT_EQ(b.wait(m).outcome, Outcome::accepted);
    b.run(2s);
    std::vector<double> from;  // where the axis was at the bench's zero, by each feedback
    Instant before{};
    std::size_t again = 0;
    b.on_feedback = [&](AxisId, const AxisFeedback& f) {
        from.push_back(static_cast<double>(f.position) - 10000 * std::chrono::duration<double>(f.at.time_since_epoch()).count());
        EXPECT_LE(f.at, b.now);
        again += f.at == before;
        before = f.at;
    };
    for (int i = 0; i < 5; ++i) {
        const std::string bad = "PR NONSENSE";
        (void)b.command(Native{{bad.begin(), bad.end()}, true});
        b.run(1s);
    }
    ASSERT_GT(from.size(), 20U);
    EXPECT_GT(again, 0U) << "an error was shown between two polls";
    const auto [low, high] = std::ranges::minmax(from);
    EXPECT_LE(high - low, 10000 * 0.03) << "30 ms";
    b.on_feedback = {};
}

}  // namespace
}  // namespace axisgate::mcode::test
