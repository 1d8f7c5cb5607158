// The fleet without a bus: a stop goes to every gateway of its name at once; a member that was seen before its axes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/doors/dds/fleet.hpp"
#include "gateway/doors/dds/mirror.hpp"
#include "gateway/doors/http/words.hpp"

namespace axisgate::dds {
namespace {
using namespace std::chrono_literals;
using testing::HasSubstr;

struct FleetStops : ::testing::Test {
    static constexpr std::int64_t unix_ns = 1'700'000'000'000'000'000;
    Instant now = at_ns(3'600'000'000'000);
    std::vector<axisgate_AxisCommand> sent;
    Fleet fleet{"hall-1", 1, [this](const axisgate_AxisCommand& c) { sent.push_back(c); }};
    std::vector<Result> came;

    void SetUp() override {
        (void)fleet.on_turn(now);
        now += 10s;
        gateway("hall-2", 2);
        axis("hall-2", 2, "feeder");
    }
    void gateway(const char* name, std::uint64_t instance, bool alive = true, std::uint32_t axes = 1) {
        axisgate_GatewayState g{};
        put_text(g.gateway, name);
        g.instance = instance;
        g.at_unix_ns = unix_ns;
        g.axes = axes;
        (void)fleet.on_gateway(g, alive, unix_ns, now);
    }
    void axis(const char* gateway_name, std::uint64_t instance, const char* name, const char* family = "uim342") {
        axisgate_AxisState s{};
        put_text(s.gateway, gateway_name);
        put_text(s.axis, name);
        put_text(s.family, family);
        put_text(s.unit, "mm");
        s.instance = instance;
        s.increments_per_unit = 100;
        s.online = true;
        s.count = 1;
        fleet.on_axis(s, true, true);
    }
    void give(const char* gateway_name, const char* command, const char* axis_name = "feeder", Duration wait = 10s) {
        FleetOrder o;
        o.gateway = gateway_name;
        o.axis = axis_name;
        o.wish = CommandWish::named(command);
        o.wait = wait;
        o.origin = {http::clients, std::make_shared<const std::string>("anna"), std::make_shared<const std::string>("anna")};
        fleet.command(
            o, [this](const Result& r) { came.push_back(r); }, now);
    }
    void answer(std::uint64_t instance, const char* outcome, const char* reason = "none", const char* text = "") {
        axisgate_CommandResult r{};
        put_text(r.gateway, sent.back().gateway);
        put_text(r.axis, sent.back().axis);
        put_text(r.source, sent.back().source);
        put_text(r.id, sent.back().id);
        r.instance = instance;
        put_text(r.outcome, outcome);
        put_text(r.reason, reason);
        put_text(r.text, text);
        fleet.on_result(r);
    }
    void pass(Duration time) {
        now += time;
        (void)fleet.on_turn(now);
    }
};

TEST_F(FleetStops, AStopGoesToAllOfItsNameAndEndsWhenAllHaveAnswered) {
    gateway("hall-2", 3);
    axis("hall-2", 3, "feeder");
    give("hall-2", "enable");
    ASSERT_EQ(came.size(), 1u) << "anything else must name the one that is meant";
    EXPECT_EQ(came[0].reason, Reason::wrong_state);
    for (const auto* word : {"halt", "quick_stop"}) {
        sent.clear();
        came.clear();
        give("hall-2", word);
        ASSERT_EQ(sent.size(), 1u) << word;
        EXPECT_STREQ(sent[0].command, word);
        EXPECT_EQ(sent[0].instance, 0u) << "for whichever of them reads it";
        answer(2, "accepted");
        EXPECT_TRUE(came.empty()) << "the other has not answered";
        answer(2, "accepted");
        EXPECT_TRUE(came.empty()) << "an answer counts once";
        answer(3, "accepted");
        ASSERT_EQ(came.size(), 1u);
        EXPECT_EQ(came[0].outcome, Outcome::accepted);
    }
}

TEST_F(FleetStops, OneOfSeveralThatDoesNotStopIsTheAnswer) {
    gateway("hall-2", 3);
    axis("hall-2", 3, "feeder");
    give("hall-2", "halt");
    ASSERT_EQ(sent.size(), 1u);
    answer(3, "failed", "no_answer", "the drive of feeder did not answer");
    answer(2, "accepted");
    ASSERT_EQ(came.size(), 1u);
    EXPECT_EQ(came[0].outcome, Outcome::failed);
    EXPECT_THAT(came[0].text, HasSubstr("the drive of feeder did not answer"));
    EXPECT_THAT(came[0].text, HasSubstr("one of 2 gateways"));
}

TEST_F(FleetStops, ANamesakeThatHasNoSuchAxisDoesNotSpoilTheAnswer) {
    gateway("hall-2", 3);
    give("hall-2", "halt");
    ASSERT_EQ(sent.size(), 1u);
    answer(3, "refused", "unknown_point", "hall-2 has no axis feeder");
    answer(2, "done");
    ASSERT_EQ(came.size(), 1u);
    EXPECT_EQ(came[0].outcome, Outcome::done);
}

TEST_F(FleetStops, TheGhostOfARestartCostsAStopNothingButItsLease) {
    // Killed and started anew: its old instance does not answer any more, and counts as alive until its lease is over.
    pass(500ms);
    gateway("hall-2", 4);
    axis("hall-2", 4, "feeder");
    give("hall-2", "quick_stop");
    ASSERT_EQ(sent.size(), 1u);
    answer(4, "accepted");
    for (int i = 0; i < 4; ++i) {
        pass(500ms);
        gateway("hall-2", 4);
    }
    ASSERT_EQ(came.size(), 1u) << "the ghost is gone";
    EXPECT_EQ(came[0].outcome, Outcome::accepted);
}

TEST_F(FleetStops, AStopIsSentToAGatewayThatIsGoneOrHasNotBeenHeardAndTheAnswerSaysSo) {
    gateway("hall-2", 2, false);
    for (const auto* name : {"hall-2", "hall-7"}) {
        sent.clear();
        came.clear();
        give(name, "halt");
        ASSERT_EQ(sent.size(), 1u) << name;
        EXPECT_TRUE(came.empty());
        pass(600ms);
        EXPECT_EQ(sent.size(), 2u) << "sent again: who has just come hears it";
        pass(2s);
        ASSERT_EQ(came.size(), 1u);
        EXPECT_FALSE(good(came[0]));
        EXPECT_THAT(came[0].text, HasSubstr("sent all the same"));
    }
    EXPECT_EQ(came[0].reason, Reason::unknown_point) << "hall-7 was never heard";
    came.clear();
    give("hall-7", "halt");
    answer(9, "accepted");
    ASSERT_EQ(came.size(), 1u) << "it was there after all";
    EXPECT_TRUE(good(came[0]));
}

TEST_F(FleetStops, AStopGoesOutForAnAxisThatHasNotBeenHeardYetAndWhenTooManyWait) {
    give("hall-2", "halt", "lift");
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_STREQ(sent[0].axis, "lift");
    answer(2, "accepted");
    ASSERT_EQ(came.size(), 1u);
    EXPECT_TRUE(good(came[0]));
    sent.clear();
    came.clear();
    for (std::size_t i = 0; i < 3 * Fleet::waiting_most; ++i)
        give("hall-2", "halt", ("axis " + std::to_string(i)).c_str());
    EXPECT_EQ(sent.size(), 3 * Fleet::waiting_most) << "each of them";
    EXPECT_LE(fleet.waiting(), 2 * Fleet::waiting_most) << "and no more wait than that";
    EXPECT_EQ(came.size() + fleet.waiting(), 3 * Fleet::waiting_most) << "the others are answered at once";
}

TEST_F(FleetStops, AStopOfSeveralEndsWhatWaitsForTheAxisOfEachOfThem) {
    give("hall-2", "enable");
    gateway("hall-2", 3);
    axis("hall-2", 3, "feeder");
    give("hall-2", "halt");
    ASSERT_EQ(came.size(), 1u);
    EXPECT_EQ(came[0].reason, Reason::interrupted);
}

TEST_F(FleetStops, AMirrorsStopGoesToNamesakesAndToWhomNobodyHasHeard) {
    std::vector<mirror::Telegram> published;
    Mirror end{fleet, [&published](const std::string& text) {
                   published.push_back(mirror::telegram_of(text.substr(0, text.size() - 1)).value());
               }};
    gateway("hall-2", 3);
    axis("hall-2", 3, "feeder");
    std::uint64_t number = 1;
    for (const auto* address : {"hall-2/feeder", "hall-2/lift", "hall-9/feeder"}) {
        sent.clear();
        end.receive(mirror::text_of({mirror::Telegram::Kind::request, number++, address, "quick_stop wait=5000"}), unix_ns, now);
        EXPECT_EQ(sent.size(), 1u) << address;
    }
    // A mirror of a mirror could be a circle: it is refused as before.
    axis("hall-2", 2, "seen", "remote");
    sent.clear();
    end.receive(mirror::text_of({mirror::Telegram::Kind::request, number++, "hall-2/seen", "quick_stop wait=5000"}), unix_ns, now);
    EXPECT_TRUE(sent.empty());
}

TEST_F(FleetStops, ACommandWaitsForAnAxisOfAMemberThatIsKnownBeforeItsAxes) {
    gateway("hall-3", 5, true, 2);
    axis("hall-3", 5, "slide");
    give("hall-3", "enable");
    EXPECT_TRUE(came.empty()) << "one of its two axes has not been heard";
    EXPECT_TRUE(sent.empty());
    pass(200ms);
    axis("hall-3", 5, "feeder");
    pass(20ms);
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_STREQ(sent[0].axis, "feeder");
    answer(5, "done");
    ASSERT_EQ(came.size(), 1u);
    EXPECT_TRUE(good(came[0]));
    came.clear();
    give("hall-3", "enable", "nobody");
    ASSERT_EQ(came.size(), 1u) << "all of its axes have been heard: there is none of that name";
    EXPECT_EQ(came[0].reason, Reason::unknown_point);
}

TEST_F(FleetStops, AnAxisThatIsNotHeardInTimeIsNotCalledUnknown) {
    gateway("hall-3", 5, true, 2);
    axis("hall-3", 5, "slide");
    give("hall-3", "enable", "feeder", 800ms);
    pass(400ms);
    EXPECT_TRUE(came.empty());
    pass(400ms);
    ASSERT_EQ(came.size(), 1u);
    EXPECT_EQ(came[0].outcome, Outcome::refused);
    EXPECT_EQ(came[0].reason, Reason::line_down) << "503: another time it is there";
    EXPECT_THAT(came[0].text, HasSubstr("has not been heard of yet"));
    came.clear();
    gateway("hall-3", 5, true, 2);
    give("hall-3", "enable", "feeder");
    gateway("hall-3", 5, false);
    pass(20ms);
    ASSERT_EQ(came.size(), 1u);
    EXPECT_THAT(came[0].text, HasSubstr("is gone"));
}

TEST_F(FleetStops, TheFirstMomentsOfThisGatewaySayThatNothingHasBeenHeardYet) {
    Fleet young("hall-1", 1, [](const axisgate_AxisCommand&) {});
    (void)young.on_turn(now);
    FleetOrder o;
    o.gateway = "hall-4";
    o.axis = "feeder";
    o.wish = CommandWish::named("enable");
    o.wait = 10s;
    std::vector<Result> results;
    young.command(
        o, [&results](const Result& r) { results.push_back(r); }, now);
    EXPECT_TRUE(results.empty()) << "it waits";
    (void)young.on_turn(now + std::chrono::milliseconds(lease_ms));
    ASSERT_EQ(results.size(), 1u);
    EXPECT_EQ(results[0].reason, Reason::unknown_point) << "who is there would have been heard by now";
}

TEST_F(FleetStops, AWishGoesOutWithAllItsMembersInTheUnitOfTheAxis) {
    FleetOrder o;
    o.gateway = "hall-2";
    o.axis = "feeder";
    o.origin = {http::clients, std::make_shared<const std::string>("anna"), std::make_shared<const std::string>("anna")};
    o.wish = CommandWish::named("move_velocity");
    o.wish.velocity = -2.5;
    o.wish.acceleration = 10.0;
    o.wish.hold_ms = 700.0;
    o.wish.renew = WishedFlag::yes;
    fleet.command(
        o, [this](const Result& r) { came.push_back(r); }, now);
    ASSERT_EQ(sent.size(), 1u);
    EXPECT_STREQ(sent[0].command, "move_velocity");
    ASSERT_TRUE(sent[0].velocity && sent[0].acceleration && sent[0].hold_ms);
    EXPECT_EQ(*sent[0].velocity, -2.5);
    EXPECT_EQ(*sent[0].acceleration, 10.0);
    EXPECT_EQ(*sent[0].hold_ms, 700);
    EXPECT_FALSE(sent[0].position || sent[0].deceleration || sent[0].method);
    EXPECT_TRUE(sent[0].renew);
    EXPECT_FALSE(sent[0].prepare);
    // All faults are reported before anything is sent, in the unit of that axis.
    o.wish.hold_ms = NoNumber{"\"700\""};
    o.wish.velocity = NoNumber{"\"fast\""};
    fleet.command(
        o, [this](const Result& r) { came.push_back(r); }, now);
    EXPECT_EQ(sent.size(), 1u);
    ASSERT_EQ(came.size(), 1u);
    EXPECT_EQ(came[0].reason, Reason::out_of_range);
    EXPECT_EQ(came[0].text, "velocity must be a number, not \"fast\"; write it in mm/s");
    // A stop has no members, and is sent all the same.
    o.wish.word = CommandWord::halt;
    o.wish.name = "halt";
    fleet.command(
        o, [this](const Result& r) { came.push_back(r); }, now);
    ASSERT_EQ(sent.size(), 2u);
    EXPECT_STREQ(sent[1].command, "halt");
    EXPECT_FALSE(sent[1].velocity || sent[1].acceleration || sent[1].hold_ms || sent[1].renew);
}

TEST_F(FleetStops, InventedGatewaysDoNotHideOneThatLives) {
    for (std::uint64_t n = 0; n < 300; ++n)
        gateway(("invented " + std::to_string(n)).c_str(), 1000 + n);
    gateway("hall-5", 5);
    axis("hall-5", 5, "feeder");
    const auto shown = [this](std::string_view name) {
        return std::ranges::count_if(fleet.list(unix_ns, now),
                                     [name](const FleetGateway& g) { return g.name == name && g.axes.size() == 1; });
    };
    EXPECT_EQ(shown("hall-2"), 1) << "that was there before them";
    EXPECT_EQ(shown("hall-5"), 1) << "that came after them";
    for (std::uint64_t n = 0; n < 300; ++n)
        gateway(("invented again " + std::to_string(n)).c_str(), 2000 + n);
    EXPECT_EQ(shown("hall-2") + shown("hall-5"), 2);
    EXPECT_LE(fleet.list(unix_ns, now).size(), Fleet::gateways_most);
    // They are gone after their lease, and new gateways replace them at once, not after ten minutes.
    pass(3s);
    for (std::uint64_t n = 0; n < Fleet::gateways_most; ++n)
        gateway(("late " + std::to_string(n)).c_str(), 3000 + n);
    gateway("hall-6", 6);
    axis("hall-6", 6, "feeder");
    EXPECT_EQ(shown("hall-6"), 1);
}

TEST_F(FleetStops, ANameThatWouldBreakALineIsLeftOut) {
    const auto before = fleet.left_out();
    for (const auto* name : {"hall\nready", "hall\x1b[2J", "hall\xff", "hall\u202e"})
        gateway(name, 77);
    EXPECT_EQ(fleet.left_out(), before + 4);
    EXPECT_EQ(fleet.list(unix_ns, now).size(), 1u);
    gateway("halle für größe", 78);
    EXPECT_EQ(fleet.list(unix_ns, now).size(), 2u);
}

}  // namespace
}  // namespace axisgate::dds
