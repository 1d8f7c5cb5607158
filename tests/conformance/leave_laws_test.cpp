// Laws of a site change that removes or replaces a moving axis, for every family, wire and kind of change: the axis is stopped first, by
// the drive's own means, before its line is closed. Judged by the mechanics of the drives behind the cable, which remain when the gateway
// releases them.
#include <gtest/gtest.h>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class LeaveLaws : public Laws {
protected:
    const std::string address = addresses(e, 1).at(0);

    /// A drive behind a cable, with this presence rule, enabled and turning.
    void turning(std::string_view presence) {
        world = fresh();
        site = world->apply(world->make_site(e, e.cable(), 1, presence));
        a1 = site->axis_ids.at(0);
        d1 = site->drive_ids.at(0);
        world->plug_in("line", d1, e, address, e.kind());
        ASSERT_TRUE(world->run_until_true([&] { return online(a1); }, 30s)) << "it does not come up";
        world->run_for(1s);
        ASSERT_NO_FATAL_FAILURE(order(a1, Enable{}));
        ASSERT_NO_FATAL_FAILURE(turn(a1));
    }
    /// Of the drive behind the cable, whichever side serves the axis.
    [[nodiscard]] TwinMechanics device() const { return world->buses.at("line")->twin(d1)->mechanics(1, world->now); }
    [[nodiscard]] std::ptrdiff_t published(Severity severity, std::string_view part) const {
        return std::ranges::count_if(world->events, [&](const Event& v) {
            return v.kind == "site" && v.axis == "a1" && v.severity == severity && v.text.find(part) != std::string::npos;
        });
    }
};

/// Each removes the axis, or replaces it.
struct Change {
    const char* name;
    void (*make)(Site&, const FamilyEntry&);
};
constexpr Change changes[] = {
    {"axis removed", [](Site& s, const FamilyEntry&) { s.axes.clear(); }},
    {"drive removed", [](Site& s, const FamilyEntry&) { s.axes.clear(), s.drives.clear(); }},
    {"line removed", [](Site& s, const FamilyEntry&) { s = {}; }},
    {"axis renamed", [](Site& s, const FamilyEntry&) { s.axes[0].name = "other"; }},
    {"drive's options", [](Site& s, const FamilyEntry&) { s.drives[0].options.emplace("of_no_meaning", "1"); }},
    {"line's timing", [](Site& s, const FamilyEntry&) { s.lines[0].timing.retries = 3; }},
    {"presence to twin", [](Site& s, const FamilyEntry&) { s.drives[0].presence = PresenceRule::twin; }},
    {"presence to auto", [](Site& s, const FamilyEntry&) { s.drives[0].presence = PresenceRule::automatic; }},
};

TEST_P(LeaveLaws, WhatASiteChangeTakesAwayInMotionIsStoppedFirst) {
    for (const Change& change : changes) {
        SCOPED_TRACE(change.name);
        ASSERT_NO_FATAL_FAILURE(turning("device"));
        Site next = site->site;
        change.make(next, e);
        std::shared_ptr<const SiteState> in_force;
        const Instant asked = world->now;
        world->engine.change_site(std::move(next), {}, 2, world->now, [&](std::shared_ptr<const SiteState> s) {
            in_force = std::move(s);
            EXPECT_EQ(device().velocity, 0) << "it is let go while it turns";
        });
        ASSERT_FALSE(in_force) << "it cannot stand at once";
        // Nothing may begin on this axis any more.
        const Result* r = ask(a1, move_to(100), false);
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::refused);
        EXPECT_EQ(r->reason, Reason::busy) << r->text;
        // Every client may stop it until it is removed.
        const Ticket stop = world->command(a1, QuickStop{}, false);
        const Result* stopped = world->result(stop);
        EXPECT_FALSE(stopped && stopped->reason == Reason::busy) << stopped->text;
        ASSERT_TRUE(world->run_until_true([&] { return in_force != nullptr; }, 10s));
        EXPECT_LT(world->now - asked, 4s) << "by its own ramp, not by the limit of the wait";
        EXPECT_EQ(published(Severity::warning, "is stopped"), 1);
        EXPECT_EQ(published(Severity::alarm, ""), 0);
        const double place = device().position;
        world->run_for(3s);
        EXPECT_EQ(device().velocity, 0);
        EXPECT_EQ(device().position, place) << "and nothing begins anew";
    }
}

TEST_P(LeaveLaws, ATwinInMotionIsStoppedBeforeTheDeviceTakesItsPlace) {
    ASSERT_NO_FATAL_FAILURE(turning("twin"));
    ASSERT_NE(now().flags & flag_simulated, 0);
    const double place = device().position;
    Site next = site->site;
    next.drives[0].presence = PresenceRule::device;
    std::shared_ptr<const SiteState> in_force;
    world->engine.change_site(std::move(next), {}, 2, world->now, [&](std::shared_ptr<const SiteState> s) { in_force = std::move(s); });
    double last = speed(a1);
    ASSERT_GT(last, 0);
    ASSERT_TRUE(world->run_until_true(
        [&] {
            if (!in_force) last = speed(a1);
            return in_force != nullptr;
        },
        10s));
    EXPECT_EQ(last, 0) << "it was turning when it was taken away";
    ASSERT_TRUE(world->run_until_true([&] { return online(a1) && !(now().flags & flag_simulated); }, 30s)) << "the device serves";
    world->run_for(2s);
    EXPECT_EQ(device().velocity, 0);
    EXPECT_EQ(device().position, place) << "what was ordered of the twin is not the device's";
    EXPECT_NE(power_state_of(now().statusword), PowerState::operation_enabled);
}

TEST_P(LeaveLaws, ADriveThatIsNotHeardIsStoppedAndDoesNotKeepTheSiteFromChanging) {
    ASSERT_NO_FATAL_FAILURE(turning("device"));
    ASSERT_EQ(world->buses.at("line")->set_hand(d1, "silent", Value{true}, world->now), "");
    ASSERT_TRUE(world->run_until_true([&] { return !(now().flags & flag_online); }, 20s));
    ASSERT_NE(device().velocity, 0);
    (void)world->change({});
    EXPECT_EQ(published(Severity::alarm, "not known"), 1);
    world->run_for(1s);
    EXPECT_EQ(device().velocity, 0) << "it heard the stop";
}

TEST_P(LeaveLaws, WhatStandsOrStaysIsChangedAtOnce) {
    ASSERT_NO_FATAL_FAILURE(turning("device"));
    Site next = site->site;
    next.axes[0].unit = "deg";
    next.axes[0].number = 9;
    const Instant asked = world->now;
    site = world->change(std::move(next));
    EXPECT_EQ(world->now, asked);
    EXPECT_NE(device().velocity, 0) << "its name for people changes, not its way";
    order(a1, Halt{});
    next = site->site;
    next.drives[0].presence = PresenceRule::twin;
    const Instant again = world->now;
    (void)world->change(std::move(next));
    EXPECT_EQ(world->now, again);
    EXPECT_EQ(published(Severity::warning, ""), 0);
}

INSTANTIATE_TEST_SUITE_P(Families, LeaveLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
