// One gateway's DDS door and another participant with a bus of its own, over the loopback interface: states, events, commands, set-points.
#include "gateway/doors/dds/door.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <vector>

#include "gateway/doors/dds/words.hpp"
#include "gateway/doors/http/words.hpp"
#include "tests/unit/dds/own_domain.hpp"
#include "tests/unit/http/fake_gateway.hpp"

namespace axisgate::dds {
namespace {
/// The reported events except refusals: those that a fixture waits for take some time.
template <class Events>
Events but_refusals(Events all) {
    std::erase_if(all, [](const auto& e) { return e.kind == "refused"; });
    return all;
}

using http::test::FakeGateway;
using http::test::standing;
using std::chrono::steady_clock;

class DdsDoorTest : public ::testing::Test {
protected:
    boost::asio::io_context context{1};
    FakeGateway gateway;
    Instant now = at_ns(1'000'000'000);
    std::unique_ptr<DdsDoor> door;
    Bus peer{[] {}};
    std::vector<axisgate_CommandResult> results;
    bool found = false;          ///< the probe of SetUp was answered: its later answers do not count
    std::uint64_t repeated = 0;  ///< counted before the test
    int wanted = 0;              ///< how often the door has requested a call after the next change

    void SetUp() override {
        gateway.set_picture("feeder", standing(6400));
        door = make("hall", 7);
        ASSERT_EQ(door->start(), "");
        ASSERT_EQ(peer.open({test::own_domain(2), "plant", "lo"},
                            {Topic::gateway_state, Topic::axis_command, Topic::parameter_write, Topic::set_point},
                            {Topic::gateway_state, Topic::axis_state, Topic::event, Topic::command_result}),
                  "");
        // Both have found each other: the door's state has arrived, and an impossible command is answered.
        ASSERT_TRUE(until([this] {
            (void)peer.write(command("probe", "nobody", "halt"));
            take_results();
            return !results.empty();
        }));
        results.clear();
        found = true;
        // All earlier probes have arrived before this one.
        ASSERT_TRUE(peer.write(command("last", "nobody", "halt")));
        ASSERT_TRUE(answered());
        results.clear();
        repeated = door->counters().repeated;
    }
    void TearDown() override {
        peer.close();
        bool stopped = false;
        door->stop([&stopped] { stopped = true; });
        EXPECT_TRUE(until([&stopped] { return stopped; }));
    }
    std::unique_ptr<DdsDoor> make(const char* name, std::uint64_t instance) {
        return std::make_unique<DdsDoor>(
            context, gateway.ports(), [this] { return now; },
            DoorSettings{{test::own_domain(2), "plant", "lo"},
                         name,
                         "0.1",
                         [] { return std::string("http://127.0.0.1:8080/"); },
                         instance,
                         [this] { ++wanted; }});
    }
    /// Runs the door until the condition is true; false after 10 s.
    bool until(const std::function<bool()>& holds) {
        const auto limit = steady_clock::now() + std::chrono::seconds(10);
        while (!holds()) {
            if (steady_clock::now() > limit) return false;
            now += std::chrono::milliseconds(20);
            (void)context.run_for(std::chrono::milliseconds(20));
            context.restart();
        }
        return true;
    }
    void take_results() {
        (void)peer.take<axisgate_CommandResult>(64, [this](const auto& r, const Bus::Seen& seen) {
            if (seen.valid && (!found || std::string_view(r.id) != "probe")) results.push_back(r);
        });
    }
    bool answered(std::size_t n = 1) {
        return until([this, n] {
            take_results();
            return results.size() >= n;
        });
    }
    static axisgate_AxisCommand command(const char* id, const char* axis, const char* word, std::uint64_t instance = 0) {
        axisgate_AxisCommand c{};
        put_text(c.gateway, "hall");
        put_text(c.axis, axis);
        put_text(c.source, "yard anna");
        put_text(c.id, id);
        put_text(c.command, word);
        c.instance = instance;
        return c;
    }
};

TEST_F(DdsDoorTest, SaysWhereItIs) { EXPECT_EQ(door->address(), "hall@plant:" + std::to_string(test::own_domain(2)) + "%lo"); }

TEST_F(DdsDoorTest, TellsTheStateOfTheGatewayAndOfEachAxisAndItsEvents) {
    std::vector<axisgate_GatewayState> gateways;
    std::vector<axisgate_AxisState> axes;
    std::vector<axisgate_Event> events;
    gateway.tell(http::test::event("it stands", "feeder", Severity::warning, "alarm"));
    ASSERT_TRUE(until([&] {
        (void)peer.take<axisgate_GatewayState>(64, [&](const auto& s, const auto&) { gateways.push_back(s); });
        (void)peer.take<axisgate_AxisState>(64, [&](const auto& s, const auto&) {
            if (std::string_view(s.axis) == "feeder") axes.push_back(s);
        });
        (void)peer.take<axisgate_Event>(64, [&](const auto& s, const auto&) { events.push_back(s); });
        return !gateways.empty() && !axes.empty() && !events.empty();
    }));
    EXPECT_STREQ(gateways[0].gateway, "hall");
    EXPECT_EQ(gateways[0].instance, 7u);
    EXPECT_STREQ(gateways[0].http, "http://127.0.0.1:8080/");
    EXPECT_EQ(gateways[0].axes, 2u);
    EXPECT_EQ(gateways[0].axes_online, 1u);
    EXPECT_EQ(axes[0].position, 6400);
    EXPECT_EQ(axes[0].increments_per_unit, 3200);
    EXPECT_STREQ(axes[0].unit, "mm");
    EXPECT_STREQ(axes[0].authority, "http");
    EXPECT_TRUE(axes[0].online && axes[0].simulated && axes[0].referenced && axes[0].target_reached && !axes[0].moving);
    EXPECT_STREQ(events[0].text, "it stands");
    EXPECT_STREQ(events[0].severity, "warning");
    // Changes are reported.
    gateway.set_picture("feeder", standing(9600));
    ASSERT_TRUE(until([&] {
        (void)peer.take<axisgate_AxisState>(64, [&](const auto& s, const auto&) {
            if (std::string_view(s.axis) == "feeder") axes.push_back(s);
        });
        return axes.back().position == 9600;
    }));
}

TEST_F(DdsDoorTest, ACommandIsCarriedOutOnceAndAnsweredOnceMoreWhenItIsSentAgain) {
    auto c = command("1", "feeder", "move_absolute");
    double position = 2, velocity = 1;
    c.position = &position;
    c.velocity = &velocity;
    c.until_done = true;
    ASSERT_TRUE(peer.write(c));
    ASSERT_TRUE(peer.write(c)) << "while it is under way";
    ASSERT_TRUE(until([this] { return door->counters().repeated == repeated + 1; }));
    ASSERT_EQ(gateway.submitted.size(), 1u);
    const Command& done = gateway.submitted[0];
    EXPECT_EQ(std::get<Move>(done.body).target, 6400);
    EXPECT_EQ(std::get<Move>(done.body).velocity, 3200);
    EXPECT_TRUE(done.until_done);
    EXPECT_EQ(done.origin.door, dds::clients);
    EXPECT_EQ(AuthorityClient::of(done.origin).text(), "dds yard anna");
    Result r;
    r.outcome = Outcome::done;
    r.text = "there";
    gateway.finish(r);
    ASSERT_TRUE(answered());
    EXPECT_STREQ(results[0].outcome, "done");
    EXPECT_STREQ(results[0].text, "there");
    EXPECT_STREQ(results[0].id, "1");
    EXPECT_EQ(results[0].instance, 7u);
    EXPECT_FALSE(results[0].repeated);
    ASSERT_TRUE(peer.write(c)) << "after it: a requester that came back";
    ASSERT_TRUE(answered(2));
    EXPECT_TRUE(results[1].repeated);
    EXPECT_NE(door->metrics().find("axisgate_dds_commands_repeated_total " + std::to_string(door->counters().repeated)), std::string::npos);
    EXPECT_STREQ(results[1].text, "there");
    EXPECT_EQ(gateway.submitted.size(), 1u);
}

TEST_F(DdsDoorTest, WhatCannotBeCarriedOutIsRefusedInWords) {
    auto late = command("a", "feeder", "enable", 6);  // made for an earlier start of the gateway
    auto wrong = command("b", "feeder", "move_absolute");
    auto none = command("", "feeder", "enable");
    ASSERT_TRUE(peer.write(late));
    ASSERT_TRUE(answered(1));
    ASSERT_TRUE(peer.write(wrong));
    ASSERT_TRUE(answered(2));
    ASSERT_TRUE(peer.write(none));
    ASSERT_TRUE(answered(3));
    EXPECT_STREQ(results[0].outcome, "failed");
    EXPECT_STREQ(results[0].reason, "no_answer");
    EXPECT_NE(std::string(results[0].text).find("started anew"), std::string::npos);
    EXPECT_STREQ(results[1].outcome, "refused");
    EXPECT_NE(std::string(results[1].text).find("position"), std::string::npos) << results[1].text;
    EXPECT_NE(std::string(results[2].text).find("source and an id"), std::string::npos);
    EXPECT_TRUE(gateway.submitted.empty());
}

TEST_F(DdsDoorTest, AParameterIsWrittenAsItsTypeAndWithinItsRange) {
    axisgate_ParameterWrite w{};
    put_text(w.gateway, "hall");
    put_text(w.axis, "feeder");
    put_text(w.source, "yard");
    put_text(w.id, "p1");
    put_text(w.parameter, "AC");
    put_text(w.value, "0");
    ASSERT_TRUE(peer.write(w));
    ASSERT_TRUE(answered(1));
    EXPECT_STREQ(results[0].reason, "out_of_range");
    put_text(w.id, "p2");
    put_text(w.value, "30000");
    ASSERT_TRUE(peer.write(w));
    ASSERT_TRUE(until([this] { return gateway.submitted.size() == 1; }));
    EXPECT_EQ(as_integer(std::get<WriteParameter>(gateway.submitted[0].body).value), 30000);
    put_text(w.id, "p3");
    put_text(w.parameter, "ML");
    put_text(w.value, "x");
    ASSERT_TRUE(peer.write(w));
    ASSERT_TRUE(answered(2));
    EXPECT_STREQ(results[1].reason, "not_writable");
}

TEST_F(DdsDoorTest, TwoGatewaysWithOneNameAreToldApartByTheirInstances) {
    axisgate_GatewayState s{};
    put_text(s.gateway, "hall");
    s.instance = 99;
    ASSERT_TRUE(peer.write(s));
    ASSERT_TRUE(until([this] { return but_refusals(gateway.noted).size() == 2; }));
    EXPECT_EQ(but_refusals(gateway.noted)[1].severity, Severity::warning);
    EXPECT_NE(but_refusals(gateway.noted)[1].text.find("called hall as well"), std::string::npos);
    ASSERT_TRUE(peer.write(command("n1", "feeder", "enable")));
    ASSERT_TRUE(answered(1));
    EXPECT_STREQ(results[0].outcome, "refused");
    EXPECT_TRUE(gateway.submitted.empty());
    ASSERT_TRUE(peer.write(command("n2", "feeder", "enable", 7)));
    ASSERT_TRUE(until([this] { return gateway.submitted.size() == 1; }));
    ASSERT_TRUE(peer.write(command("n3", "feeder", "quick_stop"))) << "a stop is for both";
    ASSERT_TRUE(until([this] { return gateway.submitted.size() == 2; }));
    EXPECT_TRUE(std::holds_alternative<QuickStop>(gateway.submitted[1].body));
    ASSERT_TRUE(peer.write(command("n4", "feeder", "halt", 6))) << "and for whichever start of it";
    ASSERT_TRUE(until([this] { return gateway.submitted.size() == 3; }));
}

TEST_F(DdsDoorTest, AStopToOnesOwnNameIsCarriedOutHereAndSentToTheOther) {
    axisgate_GatewayState s{};
    put_text(s.gateway, "hall");
    s.instance = 99;
    ASSERT_TRUE(peer.write(s));
    ASSERT_TRUE(until([this] { return but_refusals(gateway.noted).size() == 2; }));
    Bus second([] {});
    ASSERT_EQ(second.open({test::own_domain(2), "plant", "lo"}, {}, {Topic::axis_command}), "");
    std::vector<axisgate_AxisCommand> received;
    std::vector<Result> came;
    FleetOrder o;
    o.gateway = "hall";
    o.axis = "feeder";
    o.wish = CommandWish::named("halt");
    o.origin = {http::clients, std::make_shared<const std::string>("anna"), std::make_shared<const std::string>("anna")};
    door->command(o, [&came](const Result& r) { came.push_back(r); });
    ASSERT_EQ(gateway.submitted.size(), 1u) << "at once";
    EXPECT_TRUE(std::holds_alternative<Halt>(gateway.submitted[0].body));
    Result r;
    r.outcome = Outcome::accepted;
    gateway.finish(r);
    ASSERT_TRUE(until([&] {
        (void)peer.write(s);
        (void)second.take<axisgate_AxisCommand>(64, [&](const auto& c, const auto&) { received.push_back(c); });
        return !received.empty();
    }));
    EXPECT_STREQ(received[0].command, "halt");
    EXPECT_TRUE(came.empty()) << "the other one has not answered";
    ASSERT_TRUE(until([&] { return !came.empty(); })) << "it is not heard any more";
    EXPECT_TRUE(good(came[0]));
    EXPECT_NE(came[0].text.find("another gateway called hall has not answered"), std::string::npos) << came[0].text;
    second.close();
}

TEST_F(DdsDoorTest, AStopWithoutSourceOrIdIsCarriedOut) {
    auto c = command("", "feeder", "quick_stop");
    put_text(c.source, "");
    ASSERT_TRUE(peer.write(c));
    ASSERT_TRUE(until([this] { return gateway.submitted.size() == 1; }));
    EXPECT_TRUE(std::holds_alternative<QuickStop>(gateway.submitted[0].body));
}

TEST_F(DdsDoorTest, SetPointsGoTheirWayAndTheirEndIsALostClient) {
    axisgate_SetPoint s{};
    put_text(s.gateway, "hall");
    put_text(s.axis, "feeder");
    put_text(s.source, "streamer");
    put_text(s.mode, "velocity");
    s.value = 2;
    double acceleration = 10;
    s.acceleration = &acceleration;
    s.good_for_ms = 300;
    ASSERT_TRUE(until([&] {
        (void)peer.write(s);
        return !gateway.set_points.empty();
    }));
    EXPECT_EQ(gateway.set_points[0].value, 6400);
    EXPECT_EQ(gateway.set_points[0].mode, SetPoint::Mode::velocity);
    EXPECT_EQ(gateway.set_points[0].acceleration, 32000);
    EXPECT_FALSE(gateway.set_points[0].deceleration);
    EXPECT_EQ(gateway.set_points[0].good_for, std::chrono::milliseconds(300));
    EXPECT_EQ(gateway.set_points[0].origin.door, dds::clients);
    EXPECT_TRUE(gateway.lost.empty());
    peer.close();
    ASSERT_TRUE(until([this] { return !gateway.lost.empty(); }));
    EXPECT_EQ(gateway.lost[0].first, (AuthorityClient{dds::clients, "streamer"}));
    EXPECT_EQ(gateway.lost[0].second, LossCause::set_points_silent);
}

TEST_F(DdsDoorTest, ACommanderIsLostWhenTheLastWriterThatItCommandedByIsGone) {
    Bus second([] {});
    ASSERT_EQ(second.open({test::own_domain(2), "plant", "lo"}, {Topic::axis_command, Topic::parameter_write}, {}), "");
    auto reset = command("w1", "slide", "reset_fault");
    ASSERT_TRUE(peer.write(command("c1", "feeder", "enable")));
    ASSERT_TRUE(until([&] { return gateway.submitted.size() == 1; }));
    ASSERT_TRUE(until([&] {  // the same client on another axis, by another writer
        (void)second.write(reset);
        return gateway.submitted.size() == 2;
    }));
    peer.close();
    const Instant later = now + std::chrono::milliseconds(300);
    ASSERT_TRUE(until([&] { return now >= later; }));
    EXPECT_TRUE(gateway.lost.empty()) << "it is still there";
    second.close();
    ASSERT_TRUE(until([&] { return !gateway.lost.empty(); }));
    ASSERT_EQ(gateway.lost.size(), 1u);
    EXPECT_EQ(gateway.lost[0].first, (AuthorityClient{dds::clients, "yard anna"}));
    EXPECT_EQ(gateway.lost[0].second, dds::loss_deadline);
}

TEST_F(DdsDoorTest, ACommanderThatAnotherHasReplacedIsNotMissedNorOneThatWroteParametersAndStays) {
    Bus second([] {});
    ASSERT_EQ(second.open({test::own_domain(2), "plant", "lo"}, {Topic::axis_command}, {}), "");
    ASSERT_TRUE(peer.write(command("c1", "feeder", "enable")));
    ASSERT_TRUE(until([&] { return gateway.submitted.size() == 1; }));
    auto other = command("o1", "feeder", "halt");
    put_text(other.source, "panel");
    ASSERT_TRUE(until([&] {
        (void)second.write(other);
        return gateway.submitted.size() == 2;
    }));
    peer.close();
    second.close();
    ASSERT_TRUE(until([&] { return !gateway.lost.empty(); }));
    const Instant later = now + std::chrono::milliseconds(300);
    ASSERT_TRUE(until([&] { return now >= later; }));
    ASSERT_EQ(gateway.lost.size(), 1u) << "the one that commanded last";
    EXPECT_EQ(gateway.lost[0].first.name, "panel");
}

TEST_F(DdsDoorTest, WhoWritesAndIsGoneBeforeItIsReadIsLostAfterItsCommand) {
    // Behind many others, so that the end of its writer is known before its command is read.
    for (int i = 0; i < 500; ++i)
        ASSERT_TRUE(peer.write(command(("n" + std::to_string(i)).c_str(), ("nobody " + std::to_string(i)).c_str(), "enable")));
    ASSERT_TRUE(peer.write(command("c1", "feeder", "enable")));
    peer.close();
    ASSERT_TRUE(until([&] { return !gateway.lost.empty(); }));
    ASSERT_EQ(gateway.submitted.size(), 1u);
    EXPECT_EQ(gateway.lost[0].second, dds::loss_deadline);
}

/// Another gateway of the domain, with a site and axes of its own, on the same thread.
class DdsFleetTest : public DdsDoorTest {
protected:
    FakeGateway yard_gateway;
    std::unique_ptr<DdsDoor> yard;
    std::vector<Result> came;

    void SetUp() override {
        DdsDoorTest::SetUp();
        yard_gateway.set_picture("feeder", standing(3200));
        yard = std::make_unique<DdsDoor>(
            context, yard_gateway.ports(), [this] { return now; },
            DoorSettings{{test::own_domain(2), "plant", "lo"}, "yard", "0.1", {}, 8});
        ASSERT_EQ(yard->start(), "");
        ASSERT_TRUE(until([this] { return axes_of("yard") == 2 && axes_of("hall") == 2; }));
    }
    void TearDown() override {
        yard->stop([] {});
        DdsDoorTest::TearDown();
    }
    std::size_t axes_of(std::string_view name) {
        for (const auto& g : door->fleet()) {
            if (g.name == name && g.alive) return g.axes.size();
        }
        return 0;
    }
    static FleetOrder order(const char* gateway_name, CommandWish wish) {
        FleetOrder o;
        o.gateway = gateway_name;
        o.axis = "feeder";
        o.wish = std::move(wish);
        o.until_done = true;
        o.origin = {http::clients, std::make_shared<const std::string>("anna"), std::make_shared<const std::string>("anna")};
        return o;
    }
    void give(FleetOrder o) {
        door->command(std::move(o), [this](const Result& r) { came.push_back(r); });
    }
};

TEST_F(DdsFleetTest, ShowsEveryGatewayWithItsAxes) {
    const auto list = door->fleet();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(list[0].name, "hall");
    EXPECT_TRUE(list[0].here);
    EXPECT_FALSE(list[1].here);
    EXPECT_EQ(list[1].instance, 8u);
    EXPECT_EQ(list[1].axes[0].name, "feeder");
    EXPECT_EQ(list[1].axes[0].position, 3200);
    EXPECT_FALSE(list[1].namesake);
    ASSERT_FALSE(but_refusals(gateway.noted).empty());
    EXPECT_EQ(but_refusals(gateway.noted)[0].text, "the gateway yard is in the domain");
}

TEST_F(DdsFleetTest, TellsHowOldItsWordsAreWhateverTheOtherClockSays) {
    constexpr std::int64_t hour_ns = 3'600'000'000'000;
    axisgate_GatewayState g{};
    put_text(g.gateway, "far");
    g.instance = 9;
    g.at_unix_ns = gateway.now_unix_ns() + 3 * hour_ns;
    axisgate_AxisState a{};
    put_text(a.gateway, "far");
    put_text(a.axis, "lift");
    a.instance = 9;
    a.at_unix_ns = g.at_unix_ns - 700'000'000;
    const auto far = [this] {
        for (const auto& x : door->fleet()) {
            if (x.name == "far") return x;
        }
        return FleetGateway{};
    };
    const auto published = [&] { return (void)peer.write(g), far().instance == 9; };
    ASSERT_TRUE(until(published));
    Bus writer([] {});
    ASSERT_EQ(writer.open({test::own_domain(2), "plant", "lo"}, {Topic::axis_state}, {}), "");
    ASSERT_TRUE(until([&] { return (void)writer.write(a), published() && !far().axes.empty(); }));
    EXPECT_EQ(far().clock_ahead_ns, 3 * hour_ns);
    EXPECT_EQ(far().axes[0].age_ms, 700);
    EXPECT_LE(far().silent_ms, 40);
    const Instant later = now + std::chrono::milliseconds(500);
    ASSERT_TRUE(until([&] { return now >= later; }));
    EXPECT_GE(far().silent_ms, 400);
    EXPECT_LE(far().silent_ms, 600);
}

TEST_F(DdsDoorTest, AStrangersFloodIsBoundedAndCountedAndOthersAreServed) {
    axisgate_GatewayState g{};
    axisgate_AxisCommand c = command("", "nobody", "enable");
    put_text(c.gateway, "elsewhere");
    for (std::uint64_t n = 1; n <= 3000; ++n) {
        put_text(g.gateway, "stranger " + std::to_string(n));
        g.instance = 1000 + n;
        (void)peer.write(g);
        put_text(c.axis, "nobody " + std::to_string(n));
        (void)peer.write(c);
        if (n % 100 == 0) (void)context.poll(), context.restart();
    }
    ASSERT_TRUE(until([this] { return door->fleet().size() == Fleet::gateways_most; }));
    ASSERT_TRUE(peer.write(command("after", "feeder", "enable")));
    ASSERT_TRUE(until([this] { return gateway.submitted.size() == 1; }));
    EXPECT_EQ(door->fleet().size(), Fleet::gateways_most);
    EXPECT_EQ(door->metrics().find("axisgate_dds_left_out_total 0\n"), std::string::npos) << door->metrics();
}

TEST_F(DdsDoorTest, AChangeIsToldAtOnceAndNotInTheNextTurnOnly) {
    ASSERT_TRUE(until([this] { return wanted > 0; })) << "the door asks to hear of it";
    std::int64_t seen = 0;
    const auto look = [&] {
        (void)peer.take<axisgate_AxisState>(64, [&](const auto& s, const auto&) {
            if (std::string_view(s.axis) == "feeder") seen = s.position;
        });
    };
    gateway.set_picture("feeder", standing(12800));
    now += DdsDoor::turn;
    const auto before = wanted;
    door->on_change();
    const auto limit = steady_clock::now() + std::chrono::seconds(5);
    while (seen != 12800 && steady_clock::now() < limit)
        look();
    EXPECT_EQ(seen, 12800) << "no turn of the door has run";
    ASSERT_TRUE(until([&] { return wanted > before; })) << "and asks again";
}

TEST_F(DdsFleetTest, ACommandToAnotherGatewayIsCarriedOutOnceHoweverOftenItIsSent) {
    auto move = CommandWish::named("move_absolute");
    move.position = 2.0;
    move.velocity = 1.5;
    give(order("yard", std::move(move)));
    ASSERT_TRUE(until([this] { return yard->counters().repeated >= 2; })) << "sent again while nothing is answered";
    ASSERT_EQ(yard_gateway.submitted.size(), 1u);
    EXPECT_TRUE(gateway.submitted.empty());
    EXPECT_EQ(std::get<Move>(yard_gateway.submitted[0].body).target, 6400);
    EXPECT_EQ(std::get<Move>(yard_gateway.submitted[0].body).velocity, 4800);
    EXPECT_EQ(AuthorityClient::of(yard_gateway.submitted[0].origin).text(), "dds hall anna");
    EXPECT_TRUE(came.empty());
    Result r;
    r.outcome = Outcome::done;
    r.text = "there";
    yard_gateway.finish(r);
    ASSERT_TRUE(until([this] { return !came.empty(); }));
    EXPECT_EQ(came[0].outcome, Outcome::done);
    EXPECT_EQ(came[0].text, "there");
    const auto repeated_before = yard->counters().repeated;
    const Instant later = now + std::chrono::seconds(2);
    ASSERT_TRUE(until([&] { return now > later; }));
    EXPECT_EQ(came.size(), 1u);
    EXPECT_EQ(yard->counters().repeated, repeated_before) << "what is answered is not sent any more";
    EXPECT_EQ(yard_gateway.submitted.size(), 1u);
}

TEST_F(DdsFleetTest, ACommandToThisGatewayStaysHere) {
    give(order("hall", CommandWish::named("enable")));
    ASSERT_EQ(gateway.submitted.size(), 1u);
    EXPECT_EQ(gateway.submitted[0].origin.door, http::clients);
}

TEST_F(DdsFleetTest, WhatCannotBeSentIsRefusedBeforeIt) {
    const Instant settled = now + Fleet::heard_within;
    ASSERT_TRUE(until([&] { return now > settled; }));
    give(order("nowhere", CommandWish::named("enable")));
    give(order("yard", CommandWish::named("move_absolute")));
    auto other = order("yard", CommandWish::named("enable"));
    other.axis = "crane";
    give(other);
    ASSERT_EQ(came.size(), 3u);
    EXPECT_EQ(came[0].reason, Reason::unknown_point);
    EXPECT_EQ(came[1].reason, Reason::out_of_range);
    EXPECT_EQ(came[2].reason, Reason::unknown_point);
}

TEST_F(DdsFleetTest, AGatewayThatIsGoneEndsItsCommandsWithoutAWordOfSuccess) {
    give(order("yard", CommandWish::named("enable")));
    ASSERT_TRUE(until([this] { return yard_gateway.submitted.size() == 1; }));
    yard->stop([] {});
    ASSERT_TRUE(until([this] { return !came.empty(); }));
    EXPECT_EQ(came[0].outcome, Outcome::failed);
    EXPECT_EQ(came[0].reason, Reason::no_answer);
    EXPECT_EQ(axes_of("yard"), 0u);
    EXPECT_EQ(gateway.noted.back().severity, Severity::warning);
    give(order("yard", CommandWish::named("enable")));
    EXPECT_EQ(came.back().reason, Reason::line_down);
}
}  // namespace
}  // namespace axisgate::dds
