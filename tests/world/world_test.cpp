// Seeded stories with faults, then healing: safety all the time, liveness at the end; and presence, from the device to its twin and back.
// For every family on each of its wires. A failing seed fails again; AXISGATE_SEED=17 plays this one only.
#include "tests/world/world.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "tests/world/story.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

constexpr std::uint64_t stories = 200, stories_per_test = 10;
constexpr int turns = 40;

class Stories : public testing::TestWithParam<std::tuple<FamilyEntry, std::uint64_t>> {};

TEST_P(Stories, LawsHoldAndEverythingHeals) {
    const auto& [e, block] = GetParam();
    const auto wires = wires_of(e);
    const char* one = std::getenv("AXISGATE_SEED");
    const std::uint64_t only = one ? std::strtoull(one, nullptr, 10) : 0;
    for (std::uint64_t seed = block * stories_per_test + 1; seed <= (block + 1) * stories_per_test; ++seed) {
        if (only != 0 && seed != only) continue;
        const Subject& subject = wires[seed / 4 % wires.size()];  // each wire gets each kind of story
        SCOPED_TRACE("AXISGATE_SEED=" + std::to_string(seed) + " on " + subject.text());
        const auto first = run_story(subject, seed, turns).fingerprint;
        if (seed % 50 == 1) EXPECT_EQ(run_story(subject, seed, turns).fingerprint, first) << "the same seed gives the same world";
    }
}

INSTANTIATE_TEST_SUITE_P(
    Worlds, Stories, testing::Combine(testing::ValuesIn(families().entries), testing::Range<std::uint64_t>(0, stories / stories_per_test)),
    [](const auto& i) { return std::string(std::get<0>(i.param).family->name) + "_" + std::to_string(std::get<1>(i.param)); });

TEST(StoryPlan, TheSeedsHaveEveryKindOfDay) {
    // All pairs of properties of a plan occur, so that no law is tested without its condition.
    std::set<std::string> met;
    for (std::uint64_t seed = 1; seed <= stories; ++seed) {
        const StoryPlan p(seed);
        EXPECT_EQ(p.garbling + p.faulty + p.limits, 1) << "limits are asked of a wire without faults";
        const std::pair<const char*, bool> all[] = {
            {"garbling", p.garbling},         {"faulty", p.faulty},           {"limits", p.limits},
            {"two_lines", p.two_lines},       {"two_clients", p.two_clients}, {"restart", p.restart},
            {"site_changes", p.site_changes}, {"bad_store", p.bad_store}};
        for (const auto& [a, has_a] : all) {
            for (const auto& [b, has_b] : all) {
                if (has_a && has_b) met.insert(std::string(a) + " " + b);
            }
        }
    }
    for (const char* kind :
         {"faulty two_lines", "faulty two_clients", "faulty restart", "faulty site_changes", "faulty bad_store", "limits two_clients",
          "limits restart", "garbling two_lines", "garbling restart", "two_lines restart", "site_changes two_clients"}) {
        EXPECT_TRUE(met.contains(kind)) << kind;
    }
}

TEST(StoryPlan, EachFaultHappens) {
    // Every planned property really occurs.
    for (const Wire wire : {Wire::can, Wire::serial}) {
        const auto subject = std::ranges::find(subjects(), wire, &Subject::wire);
        ASSERT_NE(subject, subjects().end());
        SCOPED_TRACE(subject->text());
        std::map<std::string, std::uint64_t> met;
        for (std::uint64_t seed = 1; seed <= 40; ++seed) {
            for (const auto& [name, times] : run_story(*subject, seed, turns).faults)
                met[name] += times;
        }
        for (const char* name : {"lost", "doubled", "late", "slow drift", "not heard by the drives", "drives not heard", "cable cut",
                                 "swallowed", "bit turned over", "cut short", "foreign", "drive silent", "drive without power",
                                 "store late", "store full", "restart", "site changed", "refused for a lease"}) {
            EXPECT_GT(met[name], 0u) << name;
        }
        for (const char* name : {"reordered", "bus-off"})
            EXPECT_EQ(met[name] > 0, wire == Wire::can) << name;
    }
}

class PresenceStory : public testing::TestWithParam<Subject> {
protected:
    const Subject& e = GetParam();
    World w;
    std::shared_ptr<const SiteState> site;
    AxisId a{};
    DriveId d{};
    void start(std::string_view rule, bool plugged) {
        site = w.apply(w.make_site(e, e.cable(), 1, rule));
        a = site->axis_ids[0];
        d = site->drive_ids[0];
        if (plugged) plug();
    }
    void plug() { w.plug_in("line", d, e, addresses(e, 1)[0], e.kind()); }
    bool serves(Presence p) const { return w.picture(a).presence == p && (w.picture(a).flags & flag_online); }
    bool published(std::string_view kind, std::string_view part) const {
        for (const auto& ev : w.events) {
            if (ev.kind == kind && ev.text.find(part) != std::string::npos) return true;
        }
        return false;
    }
};

TEST_P(PresenceStory, DeviceRuleIsOfflineWithoutADevice) {
    start("device", false);
    w.run_for(10s);
    EXPECT_EQ(w.picture(a).flags & (flag_online | flag_simulated), 0);
    EXPECT_NE(w.picture(a).flags & flag_stale, 0);
    const Result* r = w.wait(w.command(a, Enable{}), 5s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->reason, Reason::no_answer);
    plug();
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 12s)) << "found without a restart";
    EXPECT_EQ(w.picture(a).flags & flag_simulated, 0);
}

TEST_P(PresenceStory, AutoTakesTheDeviceIfItAnswers) {
    start("auto", true);
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 5s));
    EXPECT_EQ(w.picture(a).flags & flag_simulated, 0);
}

TEST_P(PresenceStory, AutoTakesTheTwinIfNobodyAnswersAndGivesItBackAtRestAfterComparing) {
    start("auto", false);
    ASSERT_TRUE(w.run_until_true([&] { return serves(Presence::twin); }, 5s));
    EXPECT_NE(w.picture(a).flags & flag_simulated, 0);
    EXPECT_TRUE(published("presence", "simulated"));
    // A value is written while the twin serves; the device has another one.
    std::optional<Point> point;
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size() && !point; ++i) {
        const Parameter& p = e.catalogue->parameters()[i];
        if (p.access != Access::read_write || p.count || p.type == ValueType::text || !p.allowed.empty() || !p.max) continue;
        const Result* now = w.wait(w.command(a, ReadParameter{{i, 0}}), 3s);
        if (!now || !good(*now)) continue;
        const auto v = as_integer(now->value);
        // The value after the next one, too: the next one may not be a valid address or code.
        for (std::int64_t other = v.value_or(0) + 1; v && !point && other <= *v + 2; ++other) {
            if (static_cast<double>(other) > *p.max) continue;
            const Result* r = w.wait(w.command(a, WriteParameter{{i, 0}, Value{other}}), 3s);
            if (!r || !good(*r)) continue;
            const Result* again = w.wait(w.command(a, ReadParameter{{i, 0}}), 3s);
            if (again && good(*again) && as_integer(again->value) == other) point = Point{i, 0};
        }
    }
    const bool settings = std::ranges::any_of(e.catalogue->parameters(), &Parameter::writable);
    ASSERT_EQ(point.has_value(), settings);
    const Result* r = w.wait(w.command(a, Enable{}, true), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    Move m;
    m.target = w.picture(a).position + 40000;
    m.velocity = 4000;
    m.acceleration = 20000;
    m.deceleration = 20000;
    const Ticket go = w.command(a, m, true);
    w.run_for(1s);
    plug();
    w.run_for(3s);
    EXPECT_EQ(w.picture(a).presence, Presence::twin) << "not while it moves";
    EXPECT_NE(w.picture(a).flags & flag_moving, 0);
    r = w.wait(go, 20s);
    ASSERT_TRUE(r);
    EXPECT_TRUE(good(*r)) << r->text;
    ASSERT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 12s));
    if (point) EXPECT_TRUE(published("parameters_differ", e.catalogue->id_of(*point))) << "the difference is told";
    w.run_for(1s);
    EXPECT_EQ(w.picture(a).flags & (flag_moving | flag_simulated), 0);
    EXPECT_NE(power_state_of(w.picture(a).statusword), PowerState::operation_enabled) << "nothing is enabled by the change";
}

TEST_P(PresenceStory, TheTwinDoesNotTakeOverACommandedAxis) {
    start("auto", true);
    ASSERT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 5s));
    w.run_for(1s);
    const Result* r = w.wait(w.command(a, Enable{}, true), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    w.cables.at("line")->cut(w.now);
    w.run_for(5s);
    EXPECT_EQ(w.picture(a).flags & (flag_online | flag_simulated), 0) << "lost while it was enabled: nobody serves it";
    EXPECT_NE(w.picture(a).flags & flag_stale, 0);
    EXPECT_EQ(w.picture(a).presence, Presence::offline) << "the axis and its drive say the same";
    EXPECT_EQ(w.engine.drive_status(d).presence, Presence::offline);
    ProcessData word;
    word.controlword = cia402::cw_enable_voltage;  // a quick stop by registers: the drive did not receive it, and nothing is released
    r = w.wait(w.command(a, word), 5s);
    ASSERT_TRUE(r);
    EXPECT_FALSE(good(*r));
    w.run_for(1s);
    EXPECT_EQ(w.picture(a).presence, Presence::offline);
    r = w.wait(w.command(a, Disable{}, true), 5s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::accepted) << "taken, and never done: nobody heard it";
    EXPECT_EQ(r->reason, Reason::none);
    for (const auto* part : {"nobody answers", "taken as disabled", "its twin takes over", "not known"})
        EXPECT_NE(r->text.find(part), std::string::npos) << r->text;
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::twin); }, 5s)) << "now nobody commands it any more";
    w.cables.at("line")->heal(w.now);
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 12s));
}

TEST_P(PresenceStory, AControlWord0ThatLetsGoIsAccepted) {
    start("auto", true);
    ASSERT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 5s));
    w.run_for(1s);
    const Result* r = w.wait(w.command(a, Enable{}, true), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    w.cables.at("line")->cut(w.now);
    w.run_for(5s);
    EXPECT_NE(w.engine.drive_status(d).text.find("disable the axis to let the twin take over"), std::string::npos)
        << w.engine.drive_status(d).text;
    ProcessData word;
    word.controlword = 0;
    r = w.wait(w.command(a, word), 5s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::accepted) << r->text;
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::twin); }, 5s));
}

TEST_P(PresenceStory, AnIdleAxisIsTakenOverWhenItsDeviceGoesAway) {
    start("auto", true);
    ASSERT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 5s));
    w.run_for(1s);
    w.buses.at("line")->remove(d);
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::twin); }, 10s));
    plug();
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 12s));
}

TEST_P(PresenceStory, ADeviceThatCameBackAtRestIsFollowedByItsTwinWhenItGoesAgain) {
    start("auto", true);
    ASSERT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 5s));
    w.run_for(1s);
    const Result* r = w.wait(w.command(a, Enable{}, true), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    w.buses.at("line")->remove(d);  // its power fails while it is commanded
    w.run_for(8s);
    EXPECT_EQ(w.picture(a).flags & (flag_online | flag_simulated), 0);
    plug();
    ASSERT_TRUE(w.run_until_true([&] { return serves(Presence::device); }, 12s));
    w.run_for(2s);
    EXPECT_NE(power_state_of(w.picture(a).statusword), PowerState::operation_enabled);
    w.buses.at("line")->remove(d);
    EXPECT_TRUE(w.run_until_true([&] { return serves(Presence::twin); }, 10s)) << "nobody commands it: the first loss is over";
}

INSTANTIATE_TEST_SUITE_P(Families, PresenceStory, testing::ValuesIn(subjects()), name_of_subject);

class WorldSite : public testing::TestWithParam<Subject> {};

TEST_P(WorldSite, ChangesTouchOnlyWhatChanged) {
    const Subject& e = GetParam();
    World w;
    // Two drives, or two channels of the one that a line of this family can have, if it can have two.
    const bool two_drives = addresses(e, 2).size() == 2;
    const int channels = two_drives ? 1 : std::min(2, e.catalogue->most_channels());
    auto doc = w.twins(e, 2, channels);
    auto site = w.apply(doc);
    ASSERT_EQ(site->axis_ids.size(), two_drives ? 2u : static_cast<std::size_t>(channels));
    const AxisId a1 = site->axis_ids[0];
    ASSERT_TRUE(w.run_until_true(
        [&] { return (w.picture(a1).flags & flag_online) && (w.picture(site->axis_ids.back()).flags & flag_online); }, 20s));
    w.run_for(1s);
    const Result* r = w.wait(w.command(a1, Enable{}, true), 5s);
    ASSERT_TRUE(r && good(*r));
    Move m;
    m.target = w.picture(a1).position + 20000;
    m.velocity = 4000;
    m.acceleration = 20000;
    m.deceleration = 20000;
    const Ticket go = w.command(a1, m, true);
    w.run_for(1s);
    if (two_drives) doc.drives.pop_back();
    if (doc.axes.size() > 1) doc.axes.pop_back();
    doc.axes[0].unit = "deg";
    doc.axes[0].number = 7;
    const auto changed = w.change(doc);
    EXPECT_EQ(changed->axis_ids[0], a1);
    EXPECT_EQ(w.picture(a1).number, 7);
    EXPECT_EQ(w.image.by_number(7), a1);
    EXPECT_EQ(w.image.by_number(1), no_axis);
    EXPECT_NE(w.picture(a1).flags & flag_moving, 0) << "the motion goes on";
    r = w.wait(go, 20s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::done) << r->text;
}

INSTANTIATE_TEST_SUITE_P(Families, WorldSite, testing::ValuesIn(subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
