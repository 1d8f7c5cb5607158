// FaultLine: each fault by itself, the same faults for the same seed, order, cutting and healing; in virtual time.
// In: a scripted inner line. Out: pass or fail. Never sleeps.
#include "gateway/wire/fault_line.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/wire/twin_bus.hpp"
#include "tests/unit/wire/twin_bus_fixture.hpp"

namespace axisgate {
namespace {

using namespace test;

constexpr Instant t0 = time_zero + std::chrono::seconds(1);

/// A line that takes everything and says what it is told to.
class Inner final : public Line {
public:
    LineEvents* events = nullptr;
    std::vector<Frame> taken;
    std::vector<std::pair<Instant, Priority>> how;
    bool good = true;
    std::vector<std::pair<Instant, Frame>> script;  // frames that it will say, in order of time
    std::size_t reported = 0;

    void open(LineEvents& e, Instant) override { events = &e; }
    void close() override { events = nullptr; }
    bool send(const Frame& f, Priority p, Instant now) override {
        taken.push_back(f);
        how.emplace_back(now, p);
        return good;
    }
    [[nodiscard]] Instant deadline() const override { return reported < script.size() ? script[reported].first : never; }
    void on_deadline(Instant now) override {
        while (reported < script.size() && script[reported].first <= now) {
            Frame f = script[reported].second;
            f.at = script[reported].first;
            ++reported;
            events->on_frame(f);
        }
    }
    [[nodiscard]] LineStatus status(Instant) const override {
        LineStatus s;
        s.state = LineStatus::State::up;
        s.dropped = 5;
        s.text = "inner";
        return s;
    }
};

struct World {
    explicit World(const FaultRates& out, const FaultRates& in = {}, std::uint64_t seed = 1) {
        auto i = std::make_unique<Inner>();
        inner = i.get();
        line = std::make_unique<FaultLine>(std::move(i), FaultPlan{seed, out, in});
        line->open(owner, t0);
        inner->events->on_line_state(true, "inner up");
    }
    void send(const Frame& f, Instant at = t0) { (void)line->send(f, Priority::command, at); }
    void say(const Frame& f, Instant at = t0) {
        Frame g = f;
        g.at = at;
        inner->events->on_frame(g);
    }
    Owner owner;
    Inner* inner = nullptr;
    std::unique_ptr<FaultLine> line;
};

FaultRates rates(double FaultRates::*what, double value = 1.0) {
    FaultRates r;
    r.*what = value;
    return r;
}

TEST(FaultLine, withoutFaultsIsTheLineItself) {
    World w({});
    EXPECT_TRUE(w.owner.up());
    w.send(can(1, {1, 2}));
    w.say(can(2));
    Frame sent = can(1);
    w.inner->events->on_sent(sent);
    ASSERT_EQ(w.inner->taken.size(), 1u);
    EXPECT_TRUE(w.inner->taken[0].same(can(1, {1, 2})));
    ASSERT_EQ(w.owner.frames.size(), 1u);
    EXPECT_EQ(w.owner.frames[0].at, t0);
    EXPECT_EQ(w.owner.sent.size(), 1u);
    EXPECT_EQ(w.line->deadline(), never);
    EXPECT_EQ(w.line->status(t0).text, "inner");
    w.inner->good = false;
    EXPECT_FALSE(w.line->send(can(3), Priority::urgent, t0));
    EXPECT_EQ(w.inner->how.back().second, Priority::urgent);
    EXPECT_EQ(&w.line->inner(), w.inner);
}

TEST(FaultLine, losesWithoutTheSenderKnowing) {
    World w(rates(&FaultRates::loss), rates(&FaultRates::loss));
    EXPECT_TRUE(w.line->send(can(1), Priority::command, t0));
    w.say(can(2));
    EXPECT_TRUE(w.inner->taken.empty());
    EXPECT_TRUE(w.owner.frames.empty());
    EXPECT_EQ(w.line->counters().lost, 2u);
}

TEST(FaultLine, doubles) {
    World w(rates(&FaultRates::duplicate), rates(&FaultRates::duplicate));
    w.send(can(1, {9}));
    w.say(can(2));
    ASSERT_EQ(w.inner->taken.size(), 2u);
    EXPECT_TRUE(w.inner->taken[1].same(can(1, {9})));
    EXPECT_EQ(w.owner.frames.size(), 2u);
}

int different_bits(const Frame& a, const Frame& b) {
    int n = std::popcount(a.id ^ b.id);
    for (std::size_t i = 0; i < a.size; ++i)
        n += std::popcount(static_cast<unsigned>(a.storage[i] ^ b.storage[i]));
    return n;
}

TEST(FaultLine, turnsOneBitOver) {
    World w(rates(&FaultRates::flip), rates(&FaultRates::flip));
    const Frame frames[] = {can(0x123, {1, 2, 3}), can(0x123), text("A")};
    for (int round = 0; round < 50; ++round) {
        for (const Frame& f : frames) {
            w.send(f);
            ASSERT_EQ(w.inner->taken.back().size, f.size);
            EXPECT_EQ(different_bits(w.inner->taken.back(), f), 1) << to_text(f);
            EXPECT_LT(w.inner->taken.back().id, 0x20000000u);
        }
    }
    w.say(text("B"));
    EXPECT_EQ(different_bits(w.owner.frames.back(), text("B")), 1);
}

TEST(FaultLine, endsFramesEarly) {
    World w(rates(&FaultRates::truncate));
    std::size_t arrived = 0;
    for (int i = 0; i < 200; ++i) {
        w.inner->taken.clear();
        w.send(text("0123456789"));
        if (w.inner->taken.empty()) continue;  // nothing left of it
        ++arrived;
        const std::string got = as_text(w.inner->taken[0]);
        EXPECT_LT(got.size(), 10u);
        EXPECT_EQ(got, std::string("0123456789").substr(0, got.size()));
    }
    EXPECT_GT(arrived, 100u);
    EXPECT_LT(arrived, 200u);
    w.inner->taken.clear();
    w.send(can(1));  // has nothing to lose
    EXPECT_EQ(w.inner->taken.size(), 1u);
}

TEST(FaultLine, insertsForeignBytes) {
    World w(rates(&FaultRates::insert));
    w.send(text("0123456789"));
    ASSERT_EQ(w.inner->taken.size(), 1u);
    const std::string got = as_text(w.inner->taken[0]);
    ASSERT_GT(got.size(), 10u);
    ASSERT_LE(got.size(), 18u);
    bool found = false;  // the original, interrupted once
    for (std::size_t place = 0; place <= 10; ++place)
        found = found || got.substr(0, place) + got.substr(place + got.size() - 10) == "0123456789";
    EXPECT_TRUE(found);

    w.inner->taken.clear();
    w.send(text(std::string(Frame::capacity, 'x')));  // more than one frame holds
    ASSERT_EQ(w.inner->taken.size(), 2u);
    const std::string all = as_text(w.inner->taken[0]) + as_text(w.inner->taken[1]);
    EXPECT_GE(std::ranges::count(all, 'x'), static_cast<std::ptrdiff_t>(Frame::capacity));
    EXPECT_GT(all.size(), Frame::capacity);

    w.inner->taken.clear();
    w.send(can(5, {1}));  // a foreign frame before it
    ASSERT_EQ(w.inner->taken.size(), 2u);
    EXPECT_TRUE(w.inner->taken[1].same(can(5, {1})));
    EXPECT_EQ(w.inner->taken[0].kind, Frame::Kind::can);
}

TEST(FaultLine, delaysWithinTheBoundAndKeepsTheOrder) {
    FaultRates r = rates(&FaultRates::delay, 0.5);
    r.delay_max = ms(3);
    World w(r, r);
    for (int i = 0; i < 200; ++i) {
        const Instant at = t0 + us(i * 100);
        w.line->on_deadline(at);
        w.send(can(static_cast<std::uint32_t>(i)), at);
        w.say(can(static_cast<std::uint32_t>(1000 + i)), at);
    }
    run(*w.line, t0 + ms(100));
    ASSERT_EQ(w.inner->taken.size(), 200u);
    ASSERT_EQ(w.owner.frames.size(), 200u);
    std::size_t late = 0;
    for (std::size_t i = 0; i < 200; ++i) {
        EXPECT_EQ(w.inner->taken[i].id, i);
        EXPECT_EQ(w.owner.frames[i].id, 1000 + i);
        const Duration by = w.owner.frames[i].at - (t0 + us(static_cast<std::int64_t>(i) * 100));
        EXPECT_GE(by, Duration::zero());
        EXPECT_LE(by, ms(3));
        late += by > Duration::zero() ? 1 : 0;
        const Duration sent_by = w.inner->how[i].first - (t0 + us(static_cast<std::int64_t>(i) * 100));
        EXPECT_GE(sent_by, Duration::zero());
        EXPECT_LE(sent_by, ms(3));
    }
    EXPECT_GT(late, 100u);
    EXPECT_GT(w.line->counters().delayed, 100u);
    EXPECT_EQ(w.line->deadline(), never);
}

TEST(FaultLine, lateCallsKeepTheOrderOfTimeWithTheInnerLine) {
    FaultRates r = rates(&FaultRates::delay, 0.3);
    r.delay_max = ms(5);
    const auto received = [&](bool late) {
        World w({}, r, 99);
        for (int i = 0; i < 100; ++i)
            w.inner->script.emplace_back(t0 + ms(i), can(static_cast<std::uint32_t>(i)));
        if (late) {
            w.line->on_deadline(t0 + ms(500));
        } else {
            run(*w.line, t0 + ms(500));
        }
        std::vector<std::pair<std::uint32_t, Instant>> v;
        for (const auto& f : w.owner.frames)
            v.emplace_back(f.id, f.at);
        return v;
    };
    const auto on_time = received(false);
    ASSERT_EQ(on_time.size(), 100u);
    EXPECT_TRUE(std::ranges::is_sorted(on_time, {}, [](const auto& e) { return e.second; }));
    EXPECT_EQ(received(true), on_time);
}

TEST(FaultLine, letsTheNextFrameOvertakeOnCanAndNeverOnBytes) {
    World w(rates(&FaultRates::reorder), rates(&FaultRates::reorder));
    for (std::uint32_t i = 1; i <= 4; ++i) {
        w.send(can(i));
        w.say(can(10 + i));
    }
    const auto ids = [](const std::vector<Frame>& list) {
        std::vector<std::uint32_t> v;
        for (const auto& f : list)
            v.push_back(f.id);
        return v;
    };
    EXPECT_EQ(ids(w.inner->taken), (std::vector<std::uint32_t>{2, 1, 4, 3}));
    EXPECT_EQ(ids(w.owner.frames), (std::vector<std::uint32_t>{12, 11, 14, 13}));
    EXPECT_EQ(w.line->counters().reordered, 4u);
    w.say(can(15));  // nobody comes to overtake it
    EXPECT_EQ(w.owner.frames.size(), 4u);
    EXPECT_EQ(w.line->deadline(), t0 + FaultLine::overtaken_at_most);
    run(*w.line, t0 + ms(20));
    ASSERT_EQ(w.owner.frames.size(), 5u);
    EXPECT_EQ(w.owner.frames[4].at, t0 + FaultLine::overtaken_at_most);
    for (const char* word : {"a", "b", "c"})
        w.send(text(word), t0 + ms(20));
    ASSERT_EQ(w.inner->taken.size(), 7u);
    EXPECT_EQ(as_text(w.inner->taken[4]) + as_text(w.inner->taken[5]) + as_text(w.inner->taken[6]), "abc");
}

TEST(FaultLine, getsSlowerUntilItsBoundAndKeepsTheOrder) {
    FaultRates r;
    r.drift = ms(10);
    r.drift_max = ms(25);
    World w({}, r);
    std::vector<std::int64_t> late_ms;
    for (int s = 0; s < 5; ++s) {
        const Instant at = t0 + std::chrono::seconds(s);
        run(*w.line, at);
        w.say(can(static_cast<std::uint32_t>(s)), at);
        run(*w.line, at + ms(500));
        ASSERT_EQ(w.owner.frames.size(), static_cast<std::size_t>(s) + 1);
        late_ms.push_back((w.owner.frames.back().at - at) / ms(1));
    }
    EXPECT_EQ(late_ms, (std::vector<std::int64_t>{0, 10, 20, 25, 25}));
    w.line->set_rates({}, r);  // other rates: it begins anew
    w.say(can(9), t0 + std::chrono::seconds(6));
    EXPECT_EQ(w.owner.frames.back().at, t0 + std::chrono::seconds(6));
}

TEST(FaultLine, goesBusOffAndComesBackByItself) {
    World w({}, {});
    w.line->bus_off(t0, ms(50));
    ASSERT_EQ(w.owner.frames.size(), 1u) << "the controller's own report";
    EXPECT_EQ(w.owner.frames[0].kind, Frame::Kind::can_error);
    EXPECT_EQ(w.owner.frames[0].id, 0x40u);
    run(*w.line, t0 + ms(10));
    EXPECT_FALSE(w.owner.up());
    EXPECT_EQ(w.line->status(t0).state, LineStatus::State::bus_off);
    EXPECT_NE(w.line->status(t0).text.find("bus-off"), std::string::npos);
    EXPECT_FALSE(w.line->send(can(1), Priority::urgent, t0 + ms(10)));
    EXPECT_EQ(w.line->deadline(), t0 + ms(50));
    run(*w.line, t0 + ms(60));
    EXPECT_TRUE(w.owner.up());
    EXPECT_EQ(w.line->status(t0).state, LineStatus::State::up);
    w.send(can(2), t0 + ms(60));
    EXPECT_EQ(w.inner->taken.size(), 1u);
}

TEST(FaultLine, isBoundedInWhatItHoldsBack) {
    FaultRates r = rates(&FaultRates::delay);
    r.delay_max = std::chrono::seconds(1000);
    World w(r, r);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < FaultLine::max_delayed + 10; ++i) {
        refused += w.line->send(can(1), Priority::command, t0) ? 0 : 1;
        w.say(can(2));
    }
    EXPECT_EQ(refused, 10u);
    EXPECT_EQ(w.line->counters().overflowed, 20u);
    EXPECT_EQ(w.line->status(t0).dropped, 15u);  // the inner line's five and these
}

std::vector<std::string> story(std::uint64_t seed) {
    FaultRates r;
    r.loss = 0.1;
    r.duplicate = 0.1;
    r.flip = 0.2;
    r.truncate = 0.1;
    r.insert = 0.1;
    r.delay = 0.2;
    r.delay_max = ms(2);
    World w(r, r, seed);
    for (int i = 0; i < 300; ++i) {
        const Instant at = t0 + us(i * 500);
        w.line->on_deadline(at);
        w.send(text("request " + std::to_string(i)), at);
        w.say(can(static_cast<std::uint32_t>(i), {1, 2, 3}), at);
    }
    run(*w.line, t0 + std::chrono::seconds(1));
    std::vector<std::string> log;
    for (std::size_t i = 0; i < w.inner->taken.size(); ++i)
        log.push_back(std::to_string(ns_of(w.inner->how[i].first)) + to_text(w.inner->taken[i]));
    for (const auto& f : w.owner.frames)
        log.push_back(std::to_string(ns_of(f.at)) + to_text(f));
    return log;
}

TEST(FaultLine, isAFunctionOfItsSeed) {
    EXPECT_EQ(story(42), story(42));
    EXPECT_NE(story(42), story(43));
}

TEST(FaultLine, trafficInOneDirectionLeavesTheOtherAsItWas) {
    const auto received = [](bool with_requests) {
        World w(rates(&FaultRates::loss, 0.5), rates(&FaultRates::loss, 0.5), 5);
        for (std::uint32_t i = 0; i < 100; ++i) {
            if (with_requests) w.send(can(i));
            w.say(can(i));
        }
        std::vector<std::uint32_t> v;
        for (const auto& f : w.owner.frames)
            v.push_back(f.id);
        return v;
    };
    EXPECT_EQ(received(false), received(true));
    EXPECT_GT(received(true).size(), 30u);
    EXPECT_LT(received(true).size(), 70u);
}

TEST(FaultLine, probabilitiesAreWhatTheySay) {
    World w(rates(&FaultRates::loss, 0.1));
    for (int i = 0; i < 10'000; ++i)
        w.send(can(1));
    EXPECT_NEAR(static_cast<double>(w.line->counters().lost), 1000, 100);
    w.line->set_rates({}, {});
    w.inner->taken.clear();
    for (int i = 0; i < 100; ++i)
        w.send(can(1));
    EXPECT_EQ(w.inner->taken.size(), 100u);
}

TEST(FaultLine, cutsAndHeals) {
    FaultRates r = rates(&FaultRates::delay);
    r.delay_max = ms(5);
    World w(r, r);
    w.send(can(1));
    w.say(can(2));
    w.line->cut(t0 + ms(1), "cable pulled");
    EXPECT_EQ(w.owner.states.size(), 1u);  // told from on_deadline, not from here
    EXPECT_EQ(w.line->deadline(), t0 + ms(1));
    run(*w.line, t0 + ms(20));
    ASSERT_EQ(w.owner.states.size(), 2u);
    EXPECT_EQ(w.owner.states[1], std::make_pair(false, std::string("cable pulled")));
    EXPECT_TRUE(w.line->is_cut());
    EXPECT_FALSE(w.line->send(can(3), Priority::urgent, t0 + ms(20)));
    w.say(can(4), t0 + ms(20));
    w.inner->events->on_sent(can(1));
    EXPECT_TRUE(w.owner.frames.empty());
    EXPECT_TRUE(w.owner.sent.empty());
    EXPECT_TRUE(w.inner->taken.empty());  // what was late is lost too
    EXPECT_EQ(w.line->counters().swallowed, 4u);
    EXPECT_EQ(w.line->status(t0).state, LineStatus::State::down);
    EXPECT_EQ(w.line->status(t0).text, "cable pulled");
    EXPECT_EQ(w.line->status(t0).dropped, 6u);

    w.line->set_rates({}, {});
    w.line->heal(t0 + ms(30));
    run(*w.line, t0 + ms(30));
    ASSERT_EQ(w.owner.states.size(), 3u);
    EXPECT_EQ(w.owner.states[2], std::make_pair(true, std::string("inner up")));
    w.say(can(5), t0 + ms(31));
    EXPECT_EQ(w.owner.frames.size(), 1u);
    EXPECT_TRUE(w.line->send(can(6), Priority::command, t0 + ms(31)));
}

TEST(FaultLine, healsOnlyAsFarAsTheInnerLineIsUp) {
    World w({});
    w.line->cut(t0);
    run(*w.line, t0);
    w.inner->events->on_line_state(false, "unplugged");  // meanwhile, unseen
    w.line->heal(t0 + ms(1));
    run(*w.line, t0 + ms(2));
    EXPECT_FALSE(w.owner.up());
    w.inner->events->on_line_state(true, "plugged in");
    EXPECT_TRUE(w.owner.up());
    EXPECT_EQ(w.owner.states.back().second, "plugged in");
}

TEST(FaultLine, canBeCutBeforeItIsOpened) {
    auto inner = std::make_unique<Inner>();
    Inner* raw = inner.get();
    FaultLine line(std::move(inner), {});
    Owner owner;
    line.cut(t0);
    EXPECT_EQ(line.deadline(), never);
    line.open(owner, t0);
    raw->events->on_line_state(true, "up");
    run(line, t0);
    ASSERT_EQ(owner.states.size(), 1u);
    EXPECT_FALSE(owner.states[0].first);
    line.close();
    EXPECT_EQ(raw->events, nullptr);
    EXPECT_EQ(line.deadline(), never);
}

TEST(FaultLine, leavesControllerReportsAlone) {
    World w({}, rates(&FaultRates::loss));
    Frame report = can(0x40, {0, 0, 0, 0, 0, 0, 0, 0});
    report.kind = Frame::Kind::can_error;
    w.say(report);
    EXPECT_EQ(w.owner.frames.size(), 1u);
}

TEST(FaultLine, worksAroundATwinBus) {
    auto bus = std::make_unique<TwinBus>(TwinBusOptions{LineKind::can, 1'000'000, 10, false});
    TwinBus& b = *bus;
    FaultPlan plan;
    plan.from_drive.duplicate = 1;
    FaultLine line(std::move(bus), plan);
    auto twin = std::make_unique<ScriptTwin>();
    twin->receives = [](const Frame&, Instant, Out& out) { out.send(can(2)); };
    b.add(DriveId{1}, std::move(twin), {}, t0);
    Owner owner;
    line.open(owner, t0);
    run(line, t0);
    EXPECT_TRUE(owner.up());
    EXPECT_TRUE(line.send(can(1), Priority::command, t0));
    run(line, t0 + ms(5));
    EXPECT_EQ(owner.frames.size(), 2u);
    EXPECT_EQ(owner.sent.size(), 1u);
}

}  // namespace
}  // namespace axisgate
