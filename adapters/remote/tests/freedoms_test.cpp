// The freedoms of the remote family: the simulated gateway does each of them. Those that all families share are tested in
// tests/unit/wire/specimen_twin_test.cpp.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "adapters/remote/twin/twin.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/specimen.hpp"
#include "gateway/protocols/mirror/telegram.hpp"

namespace axisgate::remote::test {
namespace {
using namespace std::chrono_literals;
using mirror::Telegram;
using testing::SizeIs;

const Catalogue& page() {
    static const Catalogue c = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/remote.json");
        std::stringstream s;
        s << f.rdbuf();
        std::vector<std::string> faults;
        auto parsed = Catalogue::parse(s.str(), faults);
        for (const auto& fault : faults)
            ADD_FAILURE() << fault;
        return *std::move(parsed);
    }();
    return c;
}

struct Gateway {
    explicit Gateway(const FreedomValues& freedoms) {
        TwinSetup setup;
        setup.address = "hall-2/feeder";
        setup.freedoms = freedoms;
        setup.seed = 3;
        twin = twin::make_twin(setup);
        Out out;
        twin->power_on({}, now, out);
        take(out);
    }
    void take(const Out& out) {
        for (const auto& tx : out.frames) {
            at.push_back(tx.frame.at);
            framer.push({reinterpret_cast<const char*>(tx.frame.data().data()), tx.frame.size},
                        [&](std::string_view line) { sent.push_back(mirror::telegram_of(line).value()); });
        }
    }
    /// Sends an order; what it is answered at once.
    std::vector<Telegram> order(const std::string& body) {
        sent.clear();
        const std::string text = mirror::text_of({Telegram::Kind::request, ++number, "hall-2/feeder", body});
        Out out;
        twin->on_frame(Frame::run({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}), now, out);
        take(out);
        return sent;
    }
    mirror::Answer answer(const std::string& body) {
        const auto t = order(body);
        if (t.size() != 1 || t[0].kind != Telegram::Kind::answer) return ADD_FAILURE() << body << " was not answered", mirror::Answer{};
        return mirror::answer_of(t[0].body).value();
    }
    [[nodiscard]] bool accepted(const std::string& body) { return answer(body).outcome == Outcome::accepted; }
    mirror::State state() {
        const auto t = order("state");
        if (t.size() != 1 || t[0].kind != Telegram::Kind::state) return ADD_FAILURE() << "no state", mirror::State{};
        return mirror::state_of(t[0].body).value();
    }
    void pass(Duration d) {
        const Instant end = now + d;
        while (twin->deadline() <= end) {
            now = twin->deadline();
            Out out;
            twin->on_deadline(now, out);
            take(out);
        }
        now = end;
    }
    void hand(const std::string& name, bool on) {
        Out out;
        EXPECT_EQ(twin->set_hand(name, Value{on}, now, out), "");
    }

    std::unique_ptr<Twin> twin;
    mirror::Framer framer;
    std::vector<Telegram> sent;
    std::vector<Instant> at;
    std::uint64_t number = 0;
    Instant now = time_zero + 1s;
};
Gateway enabled(const FreedomValues& freedoms) {
    Gateway g(freedoms);
    EXPECT_TRUE(g.accepted("enable"));
    return g;
}

TEST(RemoteFreedoms, ThePageListsThemAndSeedZeroIsToday) {
    EXPECT_GE(page().freedoms().size(), 12u);
    EXPECT_THAT(specimen_in_words(page(), specimen_values(page(), "0")), testing::IsEmpty());
    std::set<FreedomValues> all{specimen_values(page(), "0")};
    for (const auto name : named_specimens)
        EXPECT_TRUE(all.insert(specimen_values(page(), name)).second) << name;
    Gateway manual = enabled({}), zero = enabled(specimen_values(page(), "0"));
    for (Gateway* g : {&manual, &zero}) {
        EXPECT_TRUE(g->accepted("move_absolute p=3000"));
        EXPECT_EQ(g->twin->deadline(), never);
        g->now += 400ms;
    }
    EXPECT_EQ(manual.state(), zero.state());
}

TEST(RemoteFreedoms, StatesFromSamples) {
    Gateway g({{"sample_ms", 500}});  // samples at 1.0 s, 1.5 s ...
    EXPECT_TRUE(g.accepted("enable"));
    g.now += 100ms;
    EXPECT_EQ(g.state().statusword, 0x0240) << "the sample is from before";
    EXPECT_EQ(g.state().age_ms, 100);
    EXPECT_TRUE(g.accepted("move_velocity v=1000"));
    g.now += 300ms;
    EXPECT_FALSE(g.state().moving);
    g.now += 100ms;
    mirror::State s = g.state();
    EXPECT_TRUE(s.moving);
    EXPECT_EQ(s.age_ms, 0);
    const auto there = s.position;
    g.now += 450ms;
    s = g.state();
    EXPECT_EQ(s.position, there);
    EXPECT_EQ(s.age_ms, 450);
    EXPECT_EQ(g.answer("read name=AGE").text, "450");
    EXPECT_TRUE(g.accepted("halt"));
    g.now += 2s;
    EXPECT_FALSE(g.state().moving);
}

TEST(RemoteFreedoms, ResultsOfMotionsComeLate) {
    Gateway g = enabled({{"result_late_ms", 1500}});
    EXPECT_THAT(g.order("move_absolute p=100"), SizeIs(0));
    const auto asked = g.number;
    g.now += 1s;
    EXPECT_EQ(g.state().position, 100) << "the motion is over, and its result is not there";
    EXPECT_TRUE(g.accepted("halt")) << "a stop is answered at once";
    EXPECT_THAT(g.order("home method=99"), SizeIs(0)) << "a refusal is a result, too";
    g.sent.clear();
    g.at.clear();
    g.pass(500ms);
    ASSERT_THAT(g.sent, SizeIs(1));
    EXPECT_EQ(g.sent[0].number, asked);
    EXPECT_EQ(g.at[0], time_zero + 2500ms);
    g.pass(1s);
    ASSERT_THAT(g.sent, SizeIs(2));
    EXPECT_EQ(mirror::answer_of(g.sent[1].body).value().outcome, Outcome::refused);
    EXPECT_THAT(g.order("move_absolute p=0"), SizeIs(0));
    g.hand("power", false);
    g.sent.clear();
    g.pass(5s);
    EXPECT_THAT(g.sent, SizeIs(0)) << "a gateway without power gives no result";
}

TEST(RemoteFreedoms, LateResultsAreLimited) {
    Gateway g = enabled({{"result_late_ms", 4000}});
    for (int i = 0; i < 64; ++i)
        EXPECT_THAT(g.order("move_absolute p=1"), SizeIs(0));
    EXPECT_THAT(g.order("move_absolute p=1"), SizeIs(1));
}

TEST(RemoteFreedoms, EnablingTakesItsTime) {
    Gateway g = enabled({{"enable_ms", 500}});
    g.now += 499ms;
    EXPECT_EQ(g.state().statusword, 0x0240);
    EXPECT_FALSE(g.accepted("move_absolute p=5"));
    EXPECT_FALSE(g.accepted("home"));
    g.now += 1ms;
    EXPECT_EQ(g.state().statusword, 0x0227);
    EXPECT_TRUE(g.accepted("enable"));
    EXPECT_TRUE(g.accepted("move_absolute p=5")) << "an axis that is enabled stays so";
}

TEST(RemoteFreedoms, StatesUnasked) {
    Gateway g({{"unasked_ms", 50}});
    g.pass(175ms);
    ASSERT_THAT(g.sent, SizeIs(3));
    EXPECT_EQ(g.sent[2].kind, Telegram::Kind::state);
    EXPECT_EQ(g.sent[2].number, 0u);
    g.hand("gone", true);
    g.pass(200ms);
    EXPECT_THAT(g.sent, SizeIs(3));
    g.hand("gone", false);
    g.hand("power", false);
    EXPECT_EQ(g.twin->deadline(), never);
    g.hand("power", true);
    g.pass(50ms);
    EXPECT_THAT(g.sent, SizeIs(4));
}

TEST(RemoteFreedoms, TheOtherGatewayRestartsOnce) {
    for (const std::int64_t told : {0, 1}) {
        Gateway g({{"restart_after_ms", 5000}, {"restart_ms", 2000}, {"restart_told", told}, {"result_late_ms", 4000}});
        EXPECT_TRUE(g.accepted("enable"));
        EXPECT_THAT(g.order("home"), SizeIs(0));
        EXPECT_THAT(g.order("move_velocity v=1000"), SizeIs(0));
        g.pass(4999ms);
        EXPECT_TRUE(g.state().moving);
        EXPECT_THAT(g.order("move_velocity v=1000"), SizeIs(0));
        g.sent.clear();
        g.pass(1s);
        const auto answers = g.order("state");
        ASSERT_THAT(answers, SizeIs(told));
        if (told) EXPECT_EQ(answers[0].kind, Telegram::Kind::gone);
        g.pass(999ms);
        EXPECT_THAT(g.order("enable"), SizeIs(told));
        g.pass(3s);
        EXPECT_THAT(g.sent, SizeIs(told)) << "a result that it had not sent is lost";
        const mirror::State s = g.state();
        EXPECT_FALSE(s.moving) << "a gateway stops its axes before it ends";
        EXPECT_EQ(s.statusword, 0x0227) << "the drive is as it was left";
        EXPECT_TRUE(s.referenced);
        g.pass(60s);
        EXPECT_FALSE(g.state().moving) << "once";
    }
    Gateway ordinary = enabled({{"restart_after_ms", 5000}});
    ordinary.pass(7999ms);
    EXPECT_EQ(ordinary.order("state")[0].kind, Telegram::Kind::gone) << "3 s by default";
    ordinary.pass(1ms);
    EXPECT_EQ(ordinary.order("state")[0].kind, Telegram::Kind::state);
}

TEST(RemoteFreedoms, OptionalParts) {
    Gateway all = enabled({}), none = enabled({{"homing", 0}, {"set_position", 0}, {"demand", 0}, {"reads", 0}});
    for (const auto* body : {"home", "set_position p=5"}) {
        EXPECT_TRUE(all.accepted(body)) << body;
        EXPECT_EQ(none.answer(body).reason, Reason::not_supported) << body;
    }
    EXPECT_EQ(all.answer("read name=UNIT").text, "mm");
    EXPECT_EQ(none.answer("read name=UNIT").reason, Reason::not_supported);
    for (Gateway* g : {&all, &none}) {
        EXPECT_TRUE(g->accepted("move_absolute p=700"));
        g->now += 5s;
        EXPECT_EQ(g->state().position, 700);
    }
    EXPECT_EQ(all.state().demand, 700);
    EXPECT_EQ(all.state().demand_source, DemandSource::drive);
    EXPECT_EQ(none.state().demand, 0);
    EXPECT_EQ(none.state().demand_source, DemandSource::none);
}

TEST(RemoteFreedoms, LimitsOfTheOtherGateway) {
    Gateway g = enabled({{"limit_increments", 1000}});
    EXPECT_EQ(g.answer("move_absolute p=1001").reason, Reason::out_of_range);
    EXPECT_TRUE(g.accepted("move_absolute p=-1000"));
    g.now += 5s;
    EXPECT_EQ(g.answer("move_relative p=-1").reason, Reason::out_of_range);
    EXPECT_TRUE(g.accepted("move_relative p=1500"));
}

TEST(RemoteFreedoms, StartPosition) {
    Gateway g = enabled({{"start_position_increments", -700}});
    EXPECT_EQ(g.state().position, -700);
    EXPECT_EQ(g.state().demand, -700);
    EXPECT_TRUE(g.accepted("move_absolute p=-600"));
    g.now += 2s;
    EXPECT_NEAR(g.twin->mechanics(1, g.now).position, 100, 1e-6);
}

// --- mechanics -----------------------------------------------------------------------------------------------------------------------

TEST(RemoteFreedoms, TheShaftFollowsWithAnErrorOvershootsAndSettles) {
    Gateway g = enabled({{"follow_ms", 30}, {"damping_percent", 30}});
    EXPECT_TRUE(g.accepted("move_absolute p=8000 v=4000 a=20000 d=20000"));
    g.now += 1500ms;
    EXPECT_NEAR(static_cast<double>(g.state().demand - g.state().position), 0.3 * 2 * 0.03 * 4000, 10);
    g.now += 710ms;  // beyond the window of 10 increments, on its way to the top of the overshoot
    mirror::State s = g.state();
    EXPECT_FALSE(s.moving);
    EXPECT_FALSE(s.target_reached) << "the demand has arrived, the shaft has not";
    EXPECT_GT(std::abs(s.velocity), 100);
    std::int64_t most = 0;
    for (int i = 0; i < 1000; ++i) {
        g.now += 2ms;
        most = std::max(most, g.state().position);
    }
    EXPECT_GT(most, 8005);
    s = g.state();
    EXPECT_TRUE(s.target_reached);
    EXPECT_EQ(s.position, 8000);
}

TEST(RemoteFreedoms, AMotorThatCannotFollowIsAFaultIfTheDriveWatches) {
    for (const std::int64_t watched : {0, 1000}) {
        Gateway g = enabled({{"most_acceleration", 2000}, {"following_error_increments", watched}});
        EXPECT_TRUE(g.accepted("move_velocity v=4000 a=20000 d=20000"));
        g.now += 10s;
        EXPECT_EQ(g.state().fault, watched != 0);
        EXPECT_EQ(g.state().moving, watched == 0);
        EXPECT_EQ(g.twin->mechanics(1, g.now).powered, watched == 0);
    }
    Gateway held = enabled({{"following_error_increments", 1000}});
    held.hand("stall", true);
    EXPECT_TRUE(held.accepted("move_velocity v=1000 a=10000 d=10000"));
    held.now += 1s;
    EXPECT_FALSE(held.state().fault);
    held.now += 100ms;
    EXPECT_TRUE(held.state().fault);
    EXPECT_TRUE(held.accepted("reset_fault"));
    EXPECT_FALSE(held.state().fault);
}

TEST(RemoteFreedoms, FrictionBacklashAndNoise) {
    Gateway stuck = enabled({{"friction_increments", 15}});
    EXPECT_TRUE(stuck.accepted("move_absolute p=1000"));
    stuck.now += 3s;
    EXPECT_EQ(stuck.state().position, 985);
    EXPECT_FALSE(stuck.state().target_reached) << "outside its window of 10";
    Gateway loose = enabled({{"backlash_increments", 20}});
    EXPECT_TRUE(loose.accepted("move_absolute p=1000"));
    loose.now += 3s;
    EXPECT_EQ(loose.state().position, 990);
    EXPECT_TRUE(loose.state().target_reached);
    EXPECT_TRUE(loose.accepted("set_position p=0"));
    EXPECT_EQ(loose.state().position, 0);
    Gateway noisy = enabled({{"noise_increments", 1}});
    std::set<std::int64_t> seen;
    for (int i = 0; i < 100; ++i) {
        noisy.now += 1ms;
        seen.insert(noisy.state().position);
    }
    EXPECT_EQ(seen, (std::set<std::int64_t>{-1, 0, 1}));
}

TEST(RemoteFreedoms, DriftsWhenItIsSwitchedOff) {
    Gateway g({{"drift_increments", 100}});
    g.now += 5s;
    EXPECT_EQ(g.state().position, 0) << "it was never on";
    EXPECT_TRUE(g.accepted("enable"));
    g.now += 1s;
    EXPECT_TRUE(g.accepted("disable"));
    g.now += 5s;
    EXPECT_EQ(g.state().position, 100);
    EXPECT_TRUE(g.accepted("enable"));
    g.now += 1s;
    EXPECT_EQ(g.state().position, 100);
    EXPECT_EQ(g.state().demand, 100) << "enabling takes the place where it is";
}

}  // namespace
}  // namespace axisgate::remote::test
