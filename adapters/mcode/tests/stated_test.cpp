// What lines, actions and parameter writes are read as before they are sent; what an axis tells of its rates and its course; and motions
// that are ordered behind a quick stop on its way. In: bodies of commands; a drive's twin. Out: the motion, the rates, or unread.
#include "adapters/mcode/native.hpp"
#include "adapters/mcode/tests/line_bench.hpp"

namespace axisgate::mcode::test::before_sending {
namespace {
using Kind = Stated::Kind;

Native line(std::string_view text) {
    Native n;
    n.send.assign(text.begin(), text.end());
    return n;
}
Stated of(std::string_view text) { return stated(catalogue(), 1, line(text)); }
Stated of_action(std::string name, std::string argument = {}) {
    return stated(catalogue(), 1, Action{std::move(name), std::move(argument), {}});
}
Stated of_write(std::string_view id, std::int64_t value) {
    return stated(catalogue(), 1, WriteParameter{*catalogue().find(id), Value{value}});
}

TEST(MCodeStated, Lines) {
    struct Row {
        const char* text;
        Kind kind;
    };
    for (const Row& r : {Row{"PR P", Kind::nothing}, {"SL 0", Kind::nothing},        {"E", Kind::nothing},    {"P=0", Kind::nothing},
                         {"DE=1", Kind::nothing},    {"S", Kind::nothing},           {"X1=5", Kind::nothing}, {"AS=1", Kind::nothing},
                         {"JE=0", Kind::nothing},    {"' a comment", Kind::nothing}, {"EX 1", Kind::unread},  {"BR K1", Kind::unread},
                         {"RS", Kind::unread},       {"AS=3", Kind::unread},         {"JE=1", Kind::unread},  {"IS=1,7,1", Kind::unread},
                         {"MA R1", Kind::unread},    {"JP 5", Kind::unread},         {"100", Kind::unread},   {"SC 1", Kind::unread},
                         {"HM 1", Kind::homing},     {"HI 2", Kind::homing},         {"MA 5", Kind::motion},  {"mr -5", Kind::motion}})
        EXPECT_EQ(of(r.text).kind, r.kind) << r.text;
    EXPECT_EQ(of("\x1B").kind, Kind::nothing) << "the escape character stops";
}

TEST(MCodeStated, TargetsAndRates) {
    Stated s = of("MA -2000");
    EXPECT_EQ(s.move.kind, Move::Kind::absolute);
    EXPECT_EQ(s.move.target, -2000);
    EXPECT_EQ(of("MR 7").move.kind, Move::Kind::relative);
    s = of("SL -900");
    EXPECT_EQ(s.move.kind, Move::Kind::velocity);
    EXPECT_EQ(s.move.target, -900);
    EXPECT_EQ(of("VM=5000").sets, (DriveRates{5000, 0, 0, 0}));
    EXPECT_EQ(of("A = 300").sets.acceleration, 300);
    EXPECT_EQ(of("D=400").sets, (DriveRates{0, 0, 400, 400})) << "a stop brakes with D";
    EXPECT_EQ(of_write("VM", 1234).sets.velocity, 1234);
    EXPECT_EQ(of_write("JE", 1).kind, Kind::unread);
    EXPECT_EQ(of_action("program.start", "1").kind, Kind::unread);
    EXPECT_EQ(of_action("program.list").kind, Kind::nothing);
    EXPECT_EQ(of_action("MR", "-30").move.target, -30);
    EXPECT_EQ(of_action("calibrate").kind, Kind::unread);
}

Move run_at(std::int64_t speed) {
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = speed;
    return m;
}

TEST(MCodeRates, AreReadAtTheStartAndAgainBehindALine) {
    LineBench b("!", 115200);
    b.run(5s);
    ASSERT_TRUE(b.online());
    const AxisFeedback& axis = b.feedback[AxisId{0}];
    EXPECT_GT(axis.rates.velocity, 0);
    EXPECT_GT(axis.rates.acceleration, 0);
    EXPECT_GT(axis.rates.deceleration, 0);
    EXPECT_EQ(axis.rates.quick_stop, axis.rates.deceleration);
    (void)b.wait(line("D=123456"));
    b.run(2s);
    EXPECT_EQ(axis.rates.deceleration, 123'456);
    EXPECT_EQ(axis.rates.quick_stop, 123'456);
}

TEST(MCodeRates, TheCourseIsThatOfTheOrderElseWhatTheFlagsSay) {
    LineBench b("!", 115200);
    b.run(5s);
    const AxisFeedback& axis = b.feedback[AxisId{0}];
    ASSERT_TRUE(good(b.wait(Enable{})));
    ASSERT_TRUE(good(b.wait(run_at(20'000))));
    b.run(200ms);
    EXPECT_EQ(axis.course, Course::endless);
    ASSERT_TRUE(good(b.wait(Halt{})));
    b.run(2s);
    (void)b.wait(line("MR 2000000"));
    b.run(200ms);
    EXPECT_TRUE(axis.moving);
    EXPECT_EQ(axis.course, Course::to_target) << "MP says so; the line is nobody's order";
    ASSERT_TRUE(good(b.wait(QuickStop{})));
    b.run(2s);
    (void)b.wait(line("SL 5000"));
    b.run(500ms);
    EXPECT_EQ(axis.course, Course::endless);
}

TEST(MCodePower, AnInputThatStopsIsToldUntilTheAxisIsEnabledAgain) {
    LineBench b("!", 115200);
    b.run(5s);
    const AxisFeedback& axis = b.feedback[AxisId{0}];
    (void)b.wait(line("IS=1,5,0"));
    ASSERT_TRUE(good(b.wait(Enable{})));
    ASSERT_TRUE(good(b.wait(run_at(20'000))));
    b.run(500ms);
    EXPECT_FALSE(axis.safe_stop);
    b.hand(0, "active_inputs", Value{std::int64_t{1}});
    b.run(2s);
    EXPECT_EQ(axis.velocity, 0);
    EXPECT_TRUE(axis.safe_stop) << "error 91";
    b.hand(0, "active_inputs", Value{std::int64_t{0}});
    b.run(2s);
    EXPECT_TRUE(axis.safe_stop) << "its level is not known";
    ASSERT_TRUE(good(b.wait(Enable{})));
    b.run(500ms);
    EXPECT_FALSE(axis.safe_stop);
}

TEST(MCodeStop, AMotionBehindAQuickStopOnItsWayIsNotCarriedOut) {
    LineBench b("!", 115200);
    b.run(5s);
    ASSERT_TRUE(good(b.wait(Enable{})));
    ASSERT_TRUE(good(b.wait(run_at(20'000))));
    b.run(1s);
    const Ticket stop = b.command(QuickStop{});
    b.run(2ms);
    const Ticket move = b.command(run_at(10'000));
    b.run(3s);
    ASSERT_TRUE(b.result(stop) && b.result(move));
    EXPECT_EQ(b.result(stop)->outcome, Outcome::accepted);
    EXPECT_EQ(b.result(move)->outcome, Outcome::refused);
    EXPECT_EQ(b.result(move)->reason, Reason::interrupted);
    EXPECT_EQ(b.feedback[AxisId{0}].velocity, 0) << "the stop's effect stays";
    // Who enables it first means it.
    (void)b.command(QuickStop{});
    (void)b.command(Enable{});
    EXPECT_TRUE(good(b.wait(run_at(10'000))));
    b.run(1s);
    EXPECT_NE(b.feedback[AxisId{0}].velocity, 0);
}

}  // namespace
}  // namespace axisgate::mcode::test::before_sending
