// Where the axis should be: worked out from what the drive acknowledged, and from nothing when nobody can tell.
// In: orders, positions and statuses of a fake drive that knows no ramps, so that the demand cannot come from it. Out: pass or fail.
#include "adapters/uim342/tests/fake_bench.hpp"

namespace axisgate::uim342::test {
namespace {

Move move(Move::Kind kind, std::int64_t target, std::optional<std::int64_t> v = {}) {
    Move m;
    m.kind = kind;
    m.target = target;
    m.velocity = v;
    return m;
}

/// AC = DC = 10000, SS = 0, SD = 1600000, on, at rest.
struct Enabled {
    Bench b;
    FakeNode& f;
    explicit Enabled(std::map<std::string, std::string> options = {}, std::function<void(FakeNode&)> before = {})
        : f(b.add(5, std::move(options))) {
        if (before) before(f);
        b.start(1s);
        EXPECT_EQ(b.ask(Enable{}).outcome, Outcome::accepted);
        b.run(100ms);
    }
    const AxisFeedback& fb() const { return b.feedback(); }
    /// The demand at an instant after the acknowledgement of the last order, as the newest feedback has it; `since` gets its time.
    double demand() {
        EXPECT_EQ(fb().demand_source, DemandSource::computed);
        return static_cast<double>(fb().position_demand);
    }
    void order(const Move& m) {
        EXPECT_EQ(b.ask(m).outcome, Outcome::accepted);
        begun = b.now;
    }
    /// Until a position has been answered at or after `ms` after the order: the seconds between the order and that answer.
    double wait(int ms) {
        b.run_until([&] { return b.now >= begun + std::chrono::milliseconds(ms); });
        const std::int64_t mark = ++marker;
        f.position = static_cast<std::int32_t>(mark);
        EXPECT_TRUE(b.run_until([&] { return fb().position == mark; }, 5s));
        return std::chrono::duration<double>(fb().at - begun).count();
    }
    bool none() { return fb().demand_source == DemandSource::none; }
    Instant begun{};
    std::int64_t marker = 0;
};

TEST(Uim342Demand, RestsWhereTheAxisWasSwitchedOn) {
    Bench b;
    FakeNode& f = b.add(5);
    f.position = 777;
    b.start(1s);
    EXPECT_EQ(b.feedback().demand_source, DemandSource::none) << "off: nobody wants it anywhere";
    EXPECT_EQ(b.ask(Enable{}).outcome, Outcome::accepted);
    b.run(100ms);
    EXPECT_EQ(b.feedback().demand_source, DemandSource::computed);
    EXPECT_EQ(b.feedback().position_demand, 777);
    f.position = 700;  // pushed against the holding current
    b.run(500ms);
    EXPECT_EQ(b.feedback().position, 700);
    EXPECT_EQ(b.feedback().position_demand, 777);
    EXPECT_EQ(b.ask(move(Move::Kind::relative, 1000, 5000)).outcome, Outcome::accepted);
    b.run(2s);
    EXPECT_EQ(b.feedback().position_demand, 1700) << "the drive adds to where it is, not to where it should be [L1476]";
    EXPECT_EQ(b.ask(Disable{}).outcome, Outcome::accepted);
    b.run(100ms);
    EXPECT_EQ(b.feedback().demand_source, DemandSource::none);
}

TEST(Uim342Demand, RunsAheadOfADriveThatDoesNotMove) {
    Enabled s;
    s.order(move(Move::Kind::absolute, -20000, 10000));  // 1 s up, 1 s along, 1 s down
    double t = s.wait(400);
    EXPECT_NEAR(s.demand(), -5000 * t * t, 60);
    t = s.wait(1300);
    EXPECT_NEAR(s.demand(), -5000 - 10000 * (t - 1), 60);
    t = s.wait(2500);
    EXPECT_NEAR(s.demand(), -20000 + 5000 * (3 - t) * (3 - t), 60);
    s.wait(3100);
    EXPECT_EQ(s.demand(), -20000) << "and waits there for the shaft";
    s.f.finish();
    s.b.run(200ms);
    EXPECT_EQ(s.fb().position, -20000);
    EXPECT_EQ(s.demand(), -20000);
}

TEST(Uim342Demand, GoesOnFromItsOwnSpeedWithANewOrder) {
    Enabled s;
    s.order(move(Move::Kind::velocity, 5000));
    const double t = s.wait(1000);
    EXPECT_NEAR(s.demand(), 1250 + 5000 * (t - 0.5), 60);
    s.order(move(Move::Kind::velocity, 2000));
    const double there = s.demand();
    const double u = s.wait(1000);
    // Down to 2000 with DC in 0.3 s (1050 on the way), then along; what passed between the last position and the order is unknown to the
    // test.
    EXPECT_NEAR(s.demand(), there + 1050 + 2000 * (u - 0.3), 5000 * 0.08);
    s.order(move(Move::Kind::relative, 1000, 2000));
    s.wait(3000);
    EXPECT_GT(s.demand(), there + 1050 + 2000 * 0.7 + 1000 - 400);
    EXPECT_LT(s.demand(), there + 1050 + 2000 * 1.2 + 1000 + 400);
}

TEST(Uim342Demand, CutInSpeedAndRampsAsTimes) {
    Enabled s({}, [](FakeNode& f) {
        f.values[0x1BFF] = le(1000, 4);  // SS
        f.values[0x0604] = le(1, 2);     // IC[4]: AC and DC are ms
        f.values[0x19FF] = le(500, 4);
        f.values[0x1AFF] = le(250, 4);
    });
    s.order(move(Move::Kind::absolute, 10000, 3000));  // 1000 -> 3000 in 0.5 s (1000 pulses); down in 0.25 s (500); 8500 along
    double t = s.wait(200);
    EXPECT_NEAR(s.demand(), 1000 * t + 2000 * t * t, 60);
    t = s.wait(1000);
    EXPECT_NEAR(s.demand(), 1000 + 3000 * (t - 0.5), 60);
    s.wait(4000);
    EXPECT_EQ(s.demand(), 10000);
}

TEST(Uim342Demand, StopsWithItsOwnRampAndHaltsWithThatOfTheMotion) {
    for (const bool halt : {false, true}) {
        Enabled s;
        s.f.values[0x1CFF] = le(40000, 4);  // SD, read again below
        ASSERT_EQ(s.b.read("SD").outcome, Outcome::done);
        s.order(move(Move::Kind::velocity, 8000));
        const double t = s.wait(2000);
        const double there = s.demand();
        EXPECT_NEAR(there, 3200 + 8000 * (t - 0.8), 80);
        s.f.speed = 8000;
        ASSERT_EQ((halt ? s.b.ask(Halt{}) : s.b.ask(QuickStop{})).outcome, Outcome::accepted);
        const double since = std::chrono::duration<double>(s.b.now - s.fb().at).count();
        EXPECT_LT(since, 0.2);
        s.f.stop = false;  // the fake stands at once: let it run down, or the motion would count as ended by itself
        s.begun = s.b.now;
        s.wait(1500);
        const double way = halt ? 8000.0 * 8000 / 20000 : 8000.0 * 8000 / 80000;
        EXPECT_NEAR(s.demand(), there + way + 8000 * since, 8000 * 0.08) << (halt ? "DC" : "SD");
    }
}

TEST(Uim342Demand, IsNobodysWhenSomebodyElseMovesTheAxis) {
    {
        Enabled s;
        ASSERT_EQ(s.b.native("JV=500").outcome, Outcome::done);
        ASSERT_EQ(s.b.native("BG").outcome, Outcome::done);
        s.wait(200);
        EXPECT_TRUE(s.none()) << "a native start: the gateway does not read what it means";
        s.f.stop = true;
        s.f.speed = 0;
        s.b.run(300ms);
        EXPECT_EQ(s.demand(), static_cast<double>(s.fb().position)) << "at rest, on: held there";
    }
    {
        Enabled s;
        s.f.stop = false;  // an input, or another master
        s.f.speed = 300;
        s.wait(200);
        EXPECT_TRUE(s.none());
    }
}

TEST(Uim342Demand, EndsWithAMotionThatEndsShortOfItself) {
    Enabled s;
    s.order(move(Move::Kind::absolute, 50000, 10000));
    s.wait(500);
    EXPECT_GT(s.demand(), 1000);
    s.f.stop = true;  // a switch, or another master's ST
    s.f.speed = 0;
    s.f.position = 4321;
    s.b.run(300ms);
    EXPECT_EQ(s.demand(), 4321) << "not 50000, where nobody wants it any more";
}

TEST(Uim342Demand, OriginAndInputsAndRestarts) {
    {
        Enabled s;
        s.f.position = 5000;
        s.b.run(300ms);
        ASSERT_EQ(s.b.ask(Home{37}).outcome, Outcome::accepted);
        s.b.run(300ms);
        EXPECT_EQ(s.fb().position, 0);
        EXPECT_EQ(s.demand(), 0);
    }
    {
        // IN1 may call the place 0 (its actions are not none): what was demanded in the old numbers is nothing any more.
        Enabled s({}, [](FakeNode& f) { f.values[0x3400] = le(0x8480, 2); });
        s.f.position = 5000;
        s.b.run(300ms);
        s.order(move(Move::Kind::absolute, 50000, 10000));
        s.wait(200);
        const std::array<std::uint8_t, 1> rising{0x01};
        s.b.say(message(5, 0x5A, rising));
        s.b.run(1ms);
        if (s.b.notices_of("input") == 0) GTEST_FAIL() << "the notification of an input was not understood";
        s.wait(400);
        EXPECT_TRUE(s.none());
    }
}

TEST(Uim342Demand, InOpenLoopThePositionIsTheDemand) {
    Enabled s({}, [](FakeNode& f) { f.values[0x0606] = le(0, 2); });
    EXPECT_EQ(s.fb().demand_source, DemandSource::open_loop);
    s.order(move(Move::Kind::absolute, 20000, 10000));
    s.wait(500);
    EXPECT_EQ(s.fb().demand_source, DemandSource::open_loop) << "nothing measures whether the shaft follows";
    ASSERT_EQ(s.b.ask(Disable{}).outcome, Outcome::accepted);
    s.b.run(200ms);
    EXPECT_TRUE(s.none());
}

TEST(Uim342Demand, AValueThatIsNotKnownIsNoZero) {
    // SS is not answered: from which speed the axis starts is not known, and so the demand is not.
    Enabled s(
        {}, [](FakeNode& f) { f.script = [](const Message& m) { return m.function() == 0x1B ? FakeNode::lost() : FakeNode::Verdict{}; }; });
    s.order(move(Move::Kind::velocity, 500));
    s.wait(300);
    EXPECT_TRUE(s.none());
}

}  // namespace
}  // namespace axisgate::uim342::test
