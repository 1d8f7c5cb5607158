// The mirror and the fleet without a bus: the telegrams about axes of other gateways, states that are too old for an answer, the effect of
// a stop, axes that are refused.
#include "gateway/doors/dds/mirror.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

namespace axisgate::dds {
namespace {
using namespace std::chrono_literals;
using mirror::Telegram;
using testing::HasSubstr;
using testing::StartsWith;

struct MirrorTest : ::testing::Test {
    static constexpr std::int64_t unix_ns = 1'700'000'000'000'000'000;
    Instant now = at_ns(3'600'000'000'000);
    std::vector<axisgate_AxisCommand> sent;
    Fleet fleet{"hall-1", 1, [this](const axisgate_AxisCommand& c) { sent.push_back(c); }};
    std::vector<Telegram> published;
    Mirror end{fleet, [this](const std::string& text) {
                   ASSERT_TRUE(text.ends_with('\n'));
                   published.push_back(mirror::telegram_of(text.substr(0, text.size() - 1)).value());
               }};
    std::uint64_t next = 1;

    void SetUp() override {
        gateway("hall-1", 1);
        gateway("hall-2", 2);
        axis("hall-2", 2, "feeder", 1);
    }
    void gateway(const char* name, std::uint64_t instance, bool alive = true) {
        axisgate_GatewayState g{};
        put_text(g.gateway, name);
        g.instance = instance;
        g.at_unix_ns = unix_ns;
        (void)fleet.on_gateway(g, alive, unix_ns, now);
    }
    axisgate_AxisState state(const char* gateway, std::uint64_t instance, const char* name, std::uint64_t sequence) const {
        axisgate_AxisState s{};
        put_text(s.gateway, gateway);
        put_text(s.axis, name);
        put_text(s.family, "uim342");
        put_text(s.unit, "mm");
        put_text(s.demand_source, "drive");
        s.instance = instance;
        s.increments_per_unit = 100;
        s.online = true;
        s.statusword = 0x0227;
        s.mode = 1;
        s.position = 500;
        s.position_demand = 510;
        s.at_unix_ns = unix_ns - 40'000'000;
        s.count = sequence;
        return s;
    }
    void take(const axisgate_AxisState& s) {
        fleet.on_axis(s, true, true);
        end.on_axis(s.gateway, s.axis, unix_ns);
    }
    void axis(const char* gateway, std::uint64_t instance, const char* name, std::uint64_t sequence) {
        take(state(gateway, instance, name, sequence));
    }
    std::uint64_t say(const char* address, const std::string& body) {
        const std::string text = mirror::text_of({Telegram::Kind::request, next, address, body});
        end.receive(text.substr(0, 9), unix_ns, now);  // in pieces
        end.receive(text.substr(9), unix_ns, now);
        return next++;
    }
    void result(const axisgate_AxisCommand& c, const char* outcome, std::uint64_t sequence) {
        axisgate_CommandResult r{};
        put_text(r.gateway, c.gateway);
        put_text(r.axis, c.axis);
        put_text(r.source, c.source);
        put_text(r.id, c.id);
        r.instance = c.instance;
        put_text(r.outcome, outcome);
        put_text(r.reason, "none");
        r.count = sequence;
        fleet.on_result(r);
    }
};

TEST_F(MirrorTest, AStateIsToldWhenItIsAskedForAndWhenItComes) {
    axis("hall-2", 2, "feeder", 2);
    EXPECT_TRUE(published.empty()) << "nobody has asked yet";
    const auto number = say("hall-2/feeder", "state");
    ASSERT_EQ(published.size(), 1u);
    EXPECT_EQ(published[0].kind, Telegram::Kind::state);
    EXPECT_EQ(published[0].number, number);
    const auto s = mirror::state_of(published[0].body).value();
    EXPECT_EQ(s.position, 500);
    EXPECT_EQ(s.demand, 510);
    EXPECT_EQ(s.demand_source, DemandSource::drive);
    EXPECT_EQ(s.statusword, 0x0227);
    EXPECT_EQ(s.age_ms, 40);
    axis("hall-2", 2, "feeder", 3);
    ASSERT_EQ(published.size(), 2u);
    EXPECT_EQ(published[1].number, 0u) << "unasked";
    now += 40s;
    end.on_turn(unix_ns, now);
    axis("hall-2", 2, "feeder", 4);
    EXPECT_EQ(published.size(), 2u) << "nobody asks any more";
    EXPECT_EQ(end.watched(), 0u);
}

TEST_F(MirrorTest, WhoIsGoneIsToldAndComesBack) {
    say("hall-2/feeder", "state");
    gateway("hall-2", 2, false);
    end.on_turn(unix_ns, now);
    ASSERT_EQ(published.size(), 2u);
    EXPECT_EQ(published[1].kind, Telegram::Kind::gone);
    EXPECT_EQ(published[1].body, "the gateway hall-2 is gone");
    end.on_turn(unix_ns, now);
    EXPECT_EQ(published.size(), 2u) << "once";
    gateway("hall-2", 5);
    axis("hall-2", 5, "feeder", 1);
    ASSERT_EQ(published.size(), 3u);
    EXPECT_EQ(published[2].kind, Telegram::Kind::state);
}

TEST_F(MirrorTest, TheLeaseEndsAGatewayThatIsNotHeard) {
    say("hall-2/feeder", "state");
    now += std::chrono::milliseconds(lease_ms + 1);
    (void)fleet.on_turn(now);
    end.on_turn(unix_ns, now);
    ASSERT_EQ(published.size(), 2u);
    EXPECT_EQ(published[1].kind, Telegram::Kind::gone);
}

TEST_F(MirrorTest, ADriveThatDoesNotAnswerThereIsGoneAndHearsAStop) {
    say("hall-2/feeder", "state");
    auto silent = state("hall-2", 2, "feeder", 2);
    silent.online = false;
    take(silent);
    ASSERT_EQ(published.size(), 2u);
    EXPECT_THAT(published[1].body, HasSubstr("does not answer its own gateway"));
    say("hall-2/feeder", "enable wait=5000");
    ASSERT_EQ(published.size(), 3u);
    EXPECT_EQ(mirror::answer_of(published[2].body)->reason, Reason::line_down);
    EXPECT_TRUE(sent.empty());
    say("hall-2/feeder", "halt wait=5000");
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_STREQ(sent[0].command, "halt");
}

TEST_F(MirrorTest, NoMirrorOfAMirrorNorOfOnesOwnAxis) {
    auto mirrored = state("hall-2", 2, "seen", 2);
    put_text(mirrored.family, "remote");
    take(mirrored);
    axis("hall-1", 1, "own", 1);
    for (const auto& [address, why] : {std::pair{"hall-2/seen", "is a mirror itself"},
                                       {"hall-1/own", "is an axis of this gateway"},
                                       {"hall-9/feeder", "there is no gateway hall-9"},
                                       {"hall-2/nobody", "has no such axis"}}) {
        published.clear();
        say(address, "state");
        say(address, "enable wait=5000");
        ASSERT_EQ(published.size(), 2u) << address;
        EXPECT_EQ(published[0].kind, Telegram::Kind::gone);
        EXPECT_THAT(published[0].body, HasSubstr(why));
        EXPECT_EQ(mirror::answer_of(published[1].body)->outcome, Outcome::refused);
    }
    for (const auto* address : {"hall-2/seen", "hall-1/own"}) {
        published.clear();
        say(address, "halt wait=5000");
        ASSERT_EQ(published.size(), 1u) << address;
        EXPECT_EQ(mirror::answer_of(published[0].body)->outcome, Outcome::refused);
    }
    EXPECT_TRUE(sent.empty());
}

TEST_F(MirrorTest, ACommandGoesInTheUnitOfTheAxisAndComesBackWithItsOneResult) {
    const auto number = say("hall-2/feeder", "move_absolute p=-250 v=1000 a=50 wait=5000");
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_STREQ(sent[0].source, "hall-1 mirror");
    EXPECT_EQ(sent[0].instance, 2u);
    EXPECT_FALSE(sent[0].until_done);
    EXPECT_EQ(*sent[0].position, -2.5);
    EXPECT_EQ(*sent[0].velocity, 10);
    EXPECT_EQ(*sent[0].acceleration, 0.5);
    EXPECT_EQ(sent[0].deceleration, nullptr);
    EXPECT_TRUE(published.empty());
    result(sent[0], "accepted", 7);
    result(sent[0], "accepted", 8);
    ASSERT_EQ(published.size(), 1u);
    EXPECT_EQ(published[0].number, number);
    EXPECT_EQ(mirror::answer_of(published[0].body)->outcome, Outcome::accepted);
}

TEST_F(MirrorTest, AStateFromBeforeAnAnswerIsNotTold) {
    say("hall-2/feeder", "state");
    say("hall-2/feeder", "move_absolute p=0 v=100 wait=5000");
    result(sent.at(0), "accepted", 7);
    published.clear();
    axis("hall-2", 2, "feeder", 7);
    EXPECT_TRUE(published.empty()) << "it was told before the command was answered, and comes after the answer";
    const auto number = say("hall-2/feeder", "state");
    EXPECT_TRUE(published.empty()) << "the question waits for a newer one";
    axis("hall-2", 2, "feeder", 8);
    ASSERT_EQ(published.size(), 1u);
    EXPECT_EQ(published[0].number, number);
    axis("hall-2", 2, "feeder", 0);
    EXPECT_EQ(published.size(), 2u) << "an older program does not count: what it says is taken";
}

TEST_F(MirrorTest, NobodyWaitsLongerThanItsRequestSaysAndNothingIsSentAgainThen) {
    say("hall-2/feeder", "enable wait=1200");
    for (int i = 0; i < 20; ++i) {
        now += 200ms;
        gateway("hall-2", 2);
        (void)fleet.on_turn(now);
    }
    EXPECT_EQ(sent.size(), 2u) << "at once and after 0.6 s; then nobody waits any more";
    ASSERT_EQ(published.size(), 1u);
    EXPECT_EQ(mirror::answer_of(published[0].body)->reason, Reason::no_answer);
}

TEST_F(MirrorTest, AStopEndsWhatWaitsSoThatItIsNotSentAgainAfterIt) {
    axis("hall-2", 2, "other", 1);
    say("hall-2/feeder", "move_absolute p=0 v=100 wait=5000");
    say("hall-2/other", "enable wait=5000");
    say("hall-2/feeder", "halt wait=5000");
    ASSERT_EQ(published.size(), 1u);
    EXPECT_EQ(published[0].number, 1u);
    EXPECT_EQ(mirror::answer_of(published[0].body)->reason, Reason::interrupted);
    sent.clear();
    now += 600ms;
    gateway("hall-2", 2);
    (void)fleet.on_turn(now);
    std::set<std::string> again;
    for (const auto& c : sent)
        again.insert(c.command);
    EXPECT_EQ(again, (std::set<std::string>{"enable", "halt"})) << "the motion is over, the other axis has nothing to do with it";
}

TEST_F(MirrorTest, ParametersAreWhatTheFleetKnows) {
    for (const auto& [name, value] :
         {std::pair{"UNIT", "mm"}, {"INCREMENTS_PER_UNIT", "100"}, {"FAMILY", "uim342"}, {"AGE", "40"}, {"HOLDER", "-"}}) {
        published.clear();
        say("hall-2/feeder", std::string("read name=") + name);
        ASSERT_EQ(published.size(), 1u);
        EXPECT_EQ(mirror::answer_of(published[0].body)->text, value) << name;
    }
}

}  // namespace
}  // namespace axisgate::dds
