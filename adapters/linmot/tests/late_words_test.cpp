// A drive that shows its state late: an order that is not shown yet is not one that was refused, and no count is used twice.
#include <cmath>

#include "adapters/linmot/tests/line_bench.hpp"

namespace axisgate::linmot::test {
namespace {
Move ordered_to(std::int64_t target, Move::Kind kind = Move::Kind::absolute) {
    Move m;
    m.kind = kind;
    m.target = target;
    if (kind != Move::Kind::velocity) m.velocity = 1'000'000;
    m.acceleration = m.deceleration = 10'000'000;
    return m;
}
double shaft_speed(LineBench& b) { return std::fabs(b.drive().mechanics().velocity); }

/// Each drive of these shows its words so much later.
class LateWords : public testing::TestWithParam<const char*> {
protected:
    LineBench b{1, 115200, {{"status_late_ms", GetParam()}}};
    void SetUp() override {
        b.run(1s);
        ASSERT_TRUE(b.enable());
    }
};

TEST_P(LateWords, EachStopIsMadeAndAnswered) {
    for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        ASSERT_TRUE(b.enable()) << name_of(stop);
        const Result r = b.ask(ordered_to(200'000, Move::Kind::velocity));
        ASSERT_TRUE(good(r)) << r.text;
        b.run(100ms);
        EXPECT_GT(shaft_speed(b), 100'000) << name_of(stop) << ": accepted, and not executed";
        const Result stopped = b.ask(stop);
        EXPECT_TRUE(good(stopped)) << name_of(stop) << ": " << stopped.text;
        b.run(1s);
        EXPECT_EQ(shaft_speed(b), 0) << name_of(stop);
        EXPECT_FALSE(b.axis().moving);
    }
}

TEST_P(LateWords, AMoveIsReachedWhenItIsMade) {
    for (const std::int64_t target : {300'000, -100'000}) {
        const Result r = b.ask(ordered_to(target));
        ASSERT_TRUE(good(r)) << r.text;
        for (int i = 0; i < 3000 && !b.axis().target_reached; ++i)
            b.run(1ms);
        EXPECT_TRUE(b.axis().target_reached);
        EXPECT_EQ(b.axis().position, target);
    }
}

TEST_P(LateWords, ANewOrderHasACountThatTheDriveHasNotHad) {
    ASSERT_TRUE(good(b.ask(ordered_to(200'000, Move::Kind::velocity))));
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(good(b.ask(Halt{})));
        ASSERT_TRUE(good(b.ask(ordered_to(i % 2 == 0 ? -200'000 : 200'000, Move::Kind::velocity))));
        b.run(200ms);
        EXPECT_GT(shaft_speed(b), 100'000) << i;
    }
}

TEST_P(LateWords, AFaultIsResetAndAHomingBegins) {
    b.drive().inject(0x0B, b.now);
    b.run(1s);
    ASSERT_TRUE(b.axis().fault);
    const Result reset = b.ask(ResetFault{});
    EXPECT_TRUE(good(reset)) << reset.text;
    b.run(600ms);
    EXPECT_FALSE(b.axis().fault);
    ASSERT_TRUE(b.enable());
    const Result home = b.ask(Home{});
    EXPECT_TRUE(good(home)) << home.text;
    b.run(2s);
    EXPECT_TRUE(b.axis().homing_attained);
}

INSTANTIATE_TEST_SUITE_P(Milliseconds, LateWords, testing::Values("8", "37", "160", "500"),
                         [](const auto& i) { return std::string(i.param); });

TEST(LinmotLateBits, MotionAndInTargetAreThoseOfStateVar) {
    LineBench b(1, 115200, {{"motion_active_late_ms", "500"}, {"in_target_late_ms", "500"}});
    b.run(1s);
    ASSERT_TRUE(b.enable());
    b.run(1s);
    ASSERT_TRUE(good(b.ask(ordered_to(400'000))));
    b.run(40ms);
    EXPECT_TRUE(b.axis().moving) << "the status word does not show it yet";
    EXPECT_FALSE(b.axis().target_reached);
    b.run(1s);
    EXPECT_EQ(b.axis().position, 400'000);
    EXPECT_TRUE(b.axis().target_reached);
}

}  // namespace
}  // namespace axisgate::linmot::test
