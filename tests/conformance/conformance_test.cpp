// One suite for every family by enumeration: every folder of adapters/ is tested, and a new family changes nothing here. It checks the laws
// of adapter.hpp and twin.hpp through the engine, on twins.
#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <set>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class EveryFamily : public Laws {
protected:
    World& w = *world;

    void enable() { order(a1, Enable{}); }
};

TEST_P(EveryFamily, CatalogueIsWhole) {
    const auto& doc = e.catalogue->document();
    EXPECT_EQ(e.catalogue->family(), e.family->name);
    EXPECT_GT(e.catalogue->parameters().size(), 0u);
    EXPECT_GT(e.catalogue->commands().size(), 0u);
    EXPECT_GT(e.catalogue->errors().size(), 0u);
    for (const auto* key : {"title", "maker", "description"})
        EXPECT_TRUE(doc.if_contains(key)) << key;
    for (const auto& p : e.catalogue->parameters()) {
        EXPECT_GT(p.description.size(), 10u) << p.id;
        EXPECT_FALSE(p.storage.empty()) << p.id;
        const auto own = range_of(p.type);
        if (own && p.min) EXPECT_GE(*p.min, static_cast<double>(own->min)) << p.id;
        if (own && p.max) EXPECT_LE(*p.max, static_cast<double>(own->max)) << p.id;
        EXPECT_EQ(e.catalogue->find(p.count ? p.id + "[" + std::to_string(p.first) + "]" : p.id).has_value(), true) << p.id;
    }
    EXPECT_EQ(e.family->check_address(e.family->factory_address), "");
    EXPECT_NE(e.family->check_address(""), "");
    EXPECT_NE(e.family->check_address("no such address\n"), "");
}

TEST_P(EveryFamily, ComesUpAndShowsThatItIsSimulated) {
    start();
    const auto p = w.picture(a1);
    EXPECT_EQ(p.presence, Presence::twin);
    EXPECT_NE(p.flags & flag_simulated, 0);
    EXPECT_NE(p.statusword & cia402::sw_simulated, 0);
    EXPECT_EQ(p.flags & (flag_stale | flag_fault), 0);
    EXPECT_EQ(power_state_of(p.statusword), PowerState::switch_on_disabled) << "nothing is enabled because something started";
    EXPECT_EQ(p.flags & flag_moving, 0);
    EXPECT_EQ(p.family_number, e.catalogue->number());
}

TEST_P(EveryFamily, WhatIsShownAsOnlineCanBeCommanded) {
    // From the first step in which `online` is shown, so that a script that waits for it is not refused.
    site = w.apply(w.twins(e, 2));
    a1 = site->axis_ids.at(0);
    for (const AxisId a : site->axis_ids) {
        ASSERT_TRUE(w.run_until_true([&] { return (w.picture(a).flags & flag_online) != 0; }, 10s));
        EXPECT_TRUE(w.picture(a).ever_seen);
        const Result* r = w.wait(w.command(a, Enable{}, true), 5s);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
    }
}

TEST_P(EveryFamily, EnableMoveStopDisable) {
    start();
    const std::int64_t home = w.picture(a1).position;
    enable();
    EXPECT_EQ(power_state_of(w.picture(a1).statusword), PowerState::operation_enabled);
    EXPECT_EQ(w.picture(a1).position, home) << "nothing moves because it was enabled";
    const Ticket go = w.command(a1, move_to(home + 8000), true);
    ASSERT_TRUE(w.run_until_true([&] { return w.picture(a1).flags & flag_moving; }, 2s));
    ASSERT_TRUE(w.run_until_true([&] { return w.picture(a1).position > home + 1000; }, 5s)) << "the position is seen moving";
    EXPECT_LT(w.picture(a1).position, home + 8000) << "a model that jumps to its target is none";
    EXPECT_EQ(w.result(go), nullptr) << "it is not done before it is";
    const Result* r = w.wait(go, 20s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::done) << r->text;
    w.run_for(300ms);
    EXPECT_EQ(w.picture(a1).position, home + 8000);
    EXPECT_NE(w.picture(a1).statusword & cia402::sw_target_reached, 0);

    Move back = move_to(-4000);
    back.kind = Move::Kind::relative;
    r = w.wait(w.command(a1, back, true), 20s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    w.run_for(300ms);
    EXPECT_EQ(w.picture(a1).position, home + 4000);

    r = w.wait(w.command(a1, Disable{}, true), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    EXPECT_EQ(power_state_of(w.picture(a1).statusword), PowerState::switch_on_disabled);
    r = w.wait(w.command(a1, move_to(0)), 2s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::refused);
    EXPECT_EQ(r->reason, Reason::wrong_state);
    EXPECT_FALSE(r->text.empty());
}

TEST_P(EveryFamily, HaltAndQuickStopEndAMotion) {
    start();
    enable();
    turn(a1, -3000);
    w.run_for(500ms);
    EXPECT_NEAR(static_cast<double>(now().velocity), -3000, 60);
    const auto before = now().position;
    w.run_for(500ms);
    EXPECT_LT(now().position, before - 1000);
    order(a1, Halt{});
    EXPECT_EQ(power_state_of(now().statusword), PowerState::operation_enabled);
    EXPECT_FALSE(moving(a1));
    turn(a1, -3000);
    order(a1, QuickStop{});
    EXPECT_FALSE(moving(a1));
    EXPECT_EQ(power_state_of(now().statusword), PowerState::quick_stop_active);
}

TEST_P(EveryFamily, AVelocityMoveIsTakenByCommandAndByRegistersOrByNeither) {
    start();
    enable();
    turn(a1);
    order(a1, Halt{});
    ProcessData go;
    go.mode = cia402::mode_profile_velocity;
    go.controlword = 0x0F;
    go.target_velocity = 4000;
    const Result* r = ask(a1, go, false);
    ASSERT_TRUE(r);
    EXPECT_EQ(good(*r), has_velocity) << published(r);
    if (!has_velocity) EXPECT_EQ(r->reason, Reason::not_supported) << published(r);
    w.run_for(2s);
    EXPECT_EQ(speed(a1) > 3000, has_velocity) << "what was refused moves nothing, what was taken does";
}

TEST_P(EveryFamily, AHeldMoveEndsWhenItIsNotRenewed) {
    start();
    enable();
    Move jog = move_to(2000, Move::Kind::velocity);
    jog.hold_ms = 600;
    const Result* r = w.wait(w.command(a1, jog), 5s);
    ASSERT_TRUE(r);
    if (r->reason == Reason::not_supported) {  // then nothing is held either: a renewal finds nothing, and nothing moves
        lacks_velocity(*r);
        jog.renew_only = true;
        r = w.wait(w.command(a1, jog), 1s);
        ASSERT_TRUE(r);
        EXPECT_EQ(r->reason, Reason::wrong_state) << published(r);
        w.run_for(2s);
        EXPECT_EQ(speed(a1), 0);
        EXPECT_EQ(events("hold"), 0);
        return;
    }
    ASSERT_TRUE(good(*r)) << published(r);
    Move renewal = jog;
    renewal.renew_only = true;
    for (int i = 0; i < 6; ++i) {  // renewed: it continues far beyond its time
        w.run_for(400ms);
        r = w.wait(w.command(a1, i % 2 ? jog : renewal), 1s);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    }
    EXPECT_TRUE(w.picture(a1).flags & flag_moving);
    const auto released = w.now;
    ASSERT_TRUE(w.run_until_true([&] { return (w.picture(a1).flags & flag_moving) == 0; }, 5s)) << "nobody holds it, and it goes on";
    EXPECT_GE(w.now - released, 550ms) << "it must not end before its time";
    EXPECT_EQ(std::ranges::count(w.events, std::string("hold"), &Event::kind), 1);
    EXPECT_EQ(power_state_of(w.picture(a1).statusword), PowerState::operation_enabled) << "halted, not switched off";
    // A halt, or another motion, ends the hold, so that a later motion of another client is not halted.
    r = w.wait(w.command(a1, jog), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    r = w.wait(w.command(a1, Halt{}, true), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    r = w.wait(w.command(a1, renewal), 1s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->reason, Reason::wrong_state) << "a renewal that comes after the halt starts nothing";
    w.run_for(500ms);
    EXPECT_FALSE(w.picture(a1).flags & flag_moving);
    Move on = jog;
    on.hold_ms.reset();
    r = w.wait(w.command(a1, on), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    w.run_for(2s);
    EXPECT_TRUE(w.picture(a1).flags & flag_moving);
    EXPECT_EQ(std::ranges::count(w.events, std::string("hold"), &Event::kind), 1);
}

TEST_P(EveryFamily, NothingGoesOnBecauseItIsEnabledAgain) {
    start();
    for (const bool quick : {false, true}) {
        enable();
        Move far = move_to(100000);
        far.kind = Move::Kind::relative;
        const Ticket go = w.command(a1, far, true);
        ASSERT_TRUE(w.run_until_true([&] { return w.picture(a1).flags & flag_moving; }, 5s));
        w.run_for(500ms);
        const Result* r = quick ? w.wait(w.command(a1, QuickStop{}, true), 10s) : w.wait(w.command(a1, Disable{}, true), 10s);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
        ASSERT_TRUE(w.wait(go, 2s));
        ASSERT_TRUE(w.run_until_true([&] { return !(w.picture(a1).flags & flag_moving); }, 10s));
        w.run_for(500ms);
        const auto here = w.picture(a1).position;
        enable();
        for (int i = 0; i < 20; ++i) {
            w.run_for(100ms);
            EXPECT_EQ(w.picture(a1).flags & flag_moving, 0) << "an interrupted motion goes on";
        }
        EXPECT_EQ(w.picture(a1).position, here);
    }
}

TEST_P(EveryFamily, StopInterruptsAWatchedMotionWithOneResultEach) {
    start();
    enable();
    const Ticket go = w.command(a1, move_to(w.picture(a1).position + 100000), true);
    w.run_for(500ms);
    const Ticket stop = w.command(a1, QuickStop{}, true);
    const Result* r = w.wait(go, 2s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::failed);
    EXPECT_EQ(r->reason, Reason::interrupted);
    ASSERT_TRUE(w.wait(stop, 5s));
    w.run_for(2s);
    for (const auto& [t, list] : w.results)
        EXPECT_EQ(list.size(), 1u) << "ticket " << t;
}

TEST_P(EveryFamily, EveryReadableParameterCanBeReadAndIsInItsRange) {
    start();
    std::size_t read = 0;
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size(); ++i) {
        const Parameter& p = e.catalogue->parameters()[i];
        if (!p.readable()) continue;
        const Result* r = w.wait(w.command(a1, ReadParameter{{i, p.count ? p.first : std::uint16_t{0}}}), 3s);
        ASSERT_TRUE(r) << p.id;
        if (r->reason == Reason::wrong_state || r->reason == Reason::not_supported) {
            EXPECT_FALSE(r->text.empty()) << p.id;
            continue;
        }
        ASSERT_TRUE(good(*r)) << p.id << ": " << r->text;
        EXPECT_TRUE(known(r->value)) << p.id;
        ++read;
        const auto v = as_number(r->value);
        if (!v) continue;
        if (p.min) EXPECT_GE(*v, *p.min) << p.id;
        if (p.max) EXPECT_LE(*v, *p.max) << p.id;
    }
    EXPECT_GT(read, e.catalogue->parameters().size() / 4);
}

TEST_P(EveryFamily, ReadOnlyUnknownAndOutOfRangeAreRefusedBeforeTheWire) {
    start();
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size(); ++i) {
        const Parameter& p = e.catalogue->parameters()[i];
        const Point point{i, p.count ? p.first : std::uint16_t{0}};
        Value bad;
        Reason reason = Reason::out_of_range;
        if (!p.writable()) {
            bad = std::int64_t{0};
            reason = Reason::not_writable;
        } else if (p.max && p.type != ValueType::text) {
            bad = *p.max + 1 > *p.max ? *p.max + 1 : std::numeric_limits<double>::infinity();
        } else {
            continue;
        }
        const auto before = w.engine.line_report(site->line_ids[0], w.now).counters.exchanges;
        const Ticket t = w.command(a1, WriteParameter{point, bad});
        const Result* r = w.result(t);
        ASSERT_TRUE(r) << p.id << ": refused at once, without asking the drive";
        EXPECT_EQ(r->outcome, Outcome::refused) << p.id;
        EXPECT_EQ(r->reason, reason) << p.id << ": " << r->text;
        EXPECT_NE(r->text.find(p.id), std::string::npos) << r->text;
        EXPECT_EQ(w.engine.line_report(site->line_ids[0], w.now).counters.exchanges, before);
    }
    const Ticket t = w.command(a1, ReadParameter{{60000, 0}});
    ASSERT_TRUE(w.result(t));
    EXPECT_EQ(w.result(t)->reason, Reason::unknown_point);
}

TEST_P(EveryFamily, AWriteIsAnsweredWhenItIsOnDiskAndSaysSoWhenItIsNot) {
    start();
    std::optional<Point> point;
    Value value;
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size() && !point; ++i) {
        const Parameter& p = e.catalogue->parameters()[i];
        if (p.access != Access::read_write || p.count) continue;
        const Result* now = w.wait(w.command(a1, ReadParameter{{i, 0}}), 3s);
        if (!now || !good(*now) || !e.catalogue->check_write({i, 0}, now->value).fault.empty()) continue;
        const Result* r = w.wait(w.command(a1, WriteParameter{{i, 0}, now->value}), 3s);
        if (r && good(*r)) {
            point = Point{i, 0};
            value = now->value;
            EXPECT_EQ(r->outcome, Outcome::done);
        }
    }
    if (!has_settings()) {
        const Result* r = ask(a1, WriteParameter{first_point(0), Value{std::int64_t{1}}}, false);
        ASSERT_TRUE(r);
        EXPECT_EQ(r->reason, Reason::not_writable) << published(r);
        return;
    }
    ASSERT_TRUE(point) << "no parameter of this family can be written";
    w.store_fault = "the disk is full";
    const Result* r = w.wait(w.command(a1, WriteParameter{*point, value}), 3s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::failed);
    EXPECT_EQ(r->reason, Reason::not_stored);
    EXPECT_NE(r->text.find("the disk is full"), std::string::npos);
}

TEST_P(EveryFamily, ASilentDriveCostsOnlyItself) {
    start(2);
    if (site->axis_ids.size() < 2) {
        // If a line can have only one drive, its catalogue must say so, and the fault affects only that drive.
        ASSERT_EQ(addresses(e, 2).size(), 1u);
        ASSERT_EQ(hand("silent", Value{true}), "");
        ASSERT_TRUE(w.run_until_true([&] { return !(now().flags & flag_online); }, 10s)) << "a silent drive is found out";
        ASSERT_EQ(hand("silent", Value{false}), "");
        EXPECT_TRUE(w.run_until_true([&] { return online(a1) && !(now().flags & flag_stale); }, 8s)) << "it heals by itself";
        return;
    }
    const AxisId a2 = site->axis_ids[1];
    const auto count = [&](AxisId a, Duration d) {
        std::set<std::int64_t> seen;
        const Instant end = w.now + d;
        while (w.now < end) {
            w.run_for(2ms);
            seen.insert(ns_of(w.picture(a).at));
        }
        return seen.size();
    };
    const auto usual = count(a1, 4s);
    ASSERT_EQ(w.engine.set_hand(site->drive_ids[1], {{"silent", Value{true}}}, {}, w.now), "");
    ASSERT_TRUE(w.run_until_true([&] { return !(w.picture(a2).flags & flag_online); }, 10s)) << "a silent drive is found out";
    EXPECT_NE(w.picture(a2).flags & flag_stale, 0);
    w.run_for(2s);
    const auto beside = count(a1, 4s);
    EXPECT_GT(static_cast<double>(beside), 0.8 * static_cast<double>(usual)) << "the other drive keeps its rate";
    const Result* r = w.wait(w.command(a2, Enable{}), 5s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->reason, Reason::no_answer) << r->text;
    ASSERT_EQ(w.engine.set_hand(site->drive_ids[1], {{"silent", Value{false}}}, {}, w.now), "");
    EXPECT_TRUE(w.run_until_true([&] { return online(a2) && !(w.picture(a2).flags & flag_stale); }, 8s)) << "it heals by itself";
}

TEST_P(EveryFamily, AFullLineServesEverybody) {
    // The poll period is far shorter than the line can carry: each drive still gets its share, and commands go before polls.
    Site wanted = w.twins(e, 30);
    wanted.lines.at(0).timing.poll_period = 1ms;
    site = w.apply(std::move(wanted));
    const auto all = [&](std::uint16_t flag, bool on) {
        return std::ranges::all_of(site->axis_ids, [&](AxisId a) { return ((w.picture(a).flags & flag) != 0) == on; });
    };
    ASSERT_TRUE(w.run_until_true([&] { return all(flag_online, true); }, 30s)) << "not all twins come up";
    w.run_for(3s);
    std::vector<Ticket> tickets;
    for (const AxisId a : site->axis_ids)
        tickets.push_back(w.command(a, Enable{}, true));
    for (const Ticket t : tickets) {
        const Result* r = w.wait(t, 60s);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
    }
    for (int i = 0; i < 20; ++i) {
        w.run_for(500ms);
        EXPECT_TRUE(all(flag_stale, false));
    }
    for (const Event& event : w.events)
        EXPECT_FALSE(event.kind == "drive" && event.severity == Severity::warning) << event.text;
}

TEST_P(EveryFamily, ALineThatIsCutAtAnyMomentComesToRestAndBack) {
    // Full, lossy and late, so that it is cut with every kind of work unfinished. A line that is down has no deadlines.
    Site wanted = w.make_site(e, e.cable(), 16, "device");
    wanted.lines.at(0).timing.poll_period = 5ms;
    site = w.apply(std::move(wanted));
    const auto list = addresses(e, 16);
    for (std::size_t i = 0; i < site->drive_ids.size(); ++i)
        w.plug_in("line", site->drive_ids[i], e, list[i], e.kind());
    const auto all = [&](std::uint16_t flag, bool on) {
        return std::ranges::all_of(site->axis_ids, [&](AxisId a) { return ((w.picture(a).flags & flag) != 0) == on; });
    };
    ASSERT_TRUE(w.run_until_true([&] { return all(flag_online, true); }, 30s)) << "not all come up";
    std::mt19937_64 random(11);
    FaultLine& cable = *w.cables.at("line");
    for (int i = 0; i < 200; ++i) {
        FaultRates to, from;
        to.loss = from.loss = static_cast<double>(random() % 100) / 1000.0;
        from.delay = static_cast<double>(random() % 100) / 1000.0;
        from.delay_max = std::chrono::milliseconds(1 + random() % 40);
        cable.set_rates(to, from);
        if (i % 4 == 0) (void)w.command(site->axis_ids[random() % site->axis_ids.size()], Enable{}, true);
        w.run_for(std::chrono::microseconds(random() % 200'000));
        cable.cut(w.now);
        const auto before = w.steps;
        w.run_for(100ms);
        ASSERT_LT(w.steps - before, 1000u) << "the engine turns although the line is down (cut " << i << ")";
        cable.heal(w.now);
        w.samples.clear();
    }
    cable.set_rates({}, {});
    EXPECT_TRUE(w.run_until_true([&] { return all(flag_online, true) && all(flag_stale, false); }, 60s)) << "not all come back";
}

TEST_P(EveryFamily, PowerCycleIsSurvived) {
    start();
    enable();
    ASSERT_EQ(w.engine.set_hand(site->drive_ids[0], {{"power", Value{false}}}, {}, w.now), "");
    ASSERT_TRUE(w.run_until_true([&] { return !(w.picture(a1).flags & flag_online); }, 10s));
    ASSERT_EQ(w.engine.set_hand(site->drive_ids[0], {{"power", Value{true}}}, {}, w.now), "");
    ASSERT_TRUE(w.run_until_true([&] { return online(a1); }, 10s));
    for (int looks = 0; looks < 100 && !HasFailure(); ++looks, w.run_for(10ms))
        EXPECT_NE(power_state_of(w.picture(a1).statusword), PowerState::operation_enabled) << "it does not enable by itself";
    enable();
    const Result* r = w.wait(w.command(a1, move_to(w.picture(a1).position + 500), true), 10s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
}

TEST_P(EveryFamily, CommandsInFlightAreAnsweredWhenTheirDriveIsRemoved) {
    start();
    std::vector<Ticket> tickets;
    for (int i = 0; i < 5; ++i)
        tickets.push_back(
            w.command(a1, ReadParameter{{0, e.catalogue->parameters()[0].count ? e.catalogue->parameters()[0].first : std::uint16_t{0}}}));
    w.apply(Site{});
    w.run_for(5s);
    for (const auto t : tickets) {
        ASSERT_EQ(w.results[t].size(), 1u);
    }
    EXPECT_EQ(w.picture(a1).number, 0) << "gone from the map";
}

TEST_P(EveryFamily, AFurtherChannelComesToLifeWithoutARestart) {
    const int most = e.catalogue->most_channels();
    start();
    Site next = w.twins(e, 1);
    AxisSpec further = next.axes.at(0);
    further.name = "further";
    further.number = 99;
    further.channel = most == 1 ? 2 : std::min(most, 12);
    next.axes.push_back(further);
    if (most == 1) {
        std::vector<SiteFault> faults;
        EXPECT_FALSE(parse_site(to_json(next), families(), faults)) << "its drives have one axis each";
        ASSERT_EQ(faults.size(), 1u);
        EXPECT_EQ(faults[0].pointer, "/axes/1/channel");
        return;
    }
    // The remaining drive continues its move undisturbed.
    enable();
    const Ticket on_its_way = w.command(a1, move_to(20'000), true);
    ASSERT_TRUE(w.run_until_true([&] { return w.picture(a1).position > 500; }, 20s)) << "it moves";
    const std::uint64_t source = w.picture(a1).source;
    const auto state = w.apply(std::move(next));
    const AxisId b = state->axis_ids.at(1);
    std::int64_t before = w.picture(a1).position;
    ASSERT_TRUE(w.run_until_true(
        [&] {
            const auto& p = w.picture(a1);
            EXPECT_GE(p.position, before) << "it never jumps back";
            EXPECT_EQ(power_state_of(p.statusword), PowerState::operation_enabled);
            before = p.position;
            return ::testing::Test::HasFailure() || !w.results[on_its_way].empty();
        },
        60s));
    ASSERT_FALSE(HasFailure());
    EXPECT_TRUE(good(*w.result(on_its_way))) << w.result(on_its_way)->text;
    EXPECT_EQ(w.picture(a1).position, 20'000);
    EXPECT_EQ(w.picture(a1).source, source) << "what was read of it holds still";
    ASSERT_TRUE(w.run_until_true([&] { return online(a1) && online(b); }, 20s)) << "both";
    const Result* r = w.wait(w.command(b, Enable{}, true), 10s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
    const std::int64_t home = w.picture(b).position;
    r = w.wait(w.command(b, move_to(home + 2000), true), 20s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
    EXPECT_EQ(w.picture(a1).position, 20'000) << "the other one stood";
}

TEST_P(EveryFamily, TooManyCommandsAreBusyAndNoneIsLost) {
    start();
    std::vector<Ticket> tickets;
    const Point p{0, e.catalogue->parameters()[0].count ? e.catalogue->parameters()[0].first : std::uint16_t{0}};
    for (int i = 0; i < 200; ++i)
        tickets.push_back(w.command(a1, ReadParameter{p}));
    EXPECT_LE(std::ranges::count_if(tickets, [&](Ticket t) { return w.results[t].empty(); }), 64) << "on their way at once, to one axis";
    w.run_for(30s);
    std::size_t busy = 0;
    for (const auto t : tickets) {
        ASSERT_EQ(w.results[t].size(), 1u);
        busy += w.result(t)->reason == Reason::busy;
    }
    EXPECT_GT(busy, 0u);
    EXPECT_LT(busy, 180u);
}

TEST_P(EveryFamily, GarbageOnTheWireHarmsNobody) {
    const LineKind kind = e.kind();
    {
        std::mt19937_64 random(42);
        auto adapter = e.family->make_adapter(*e.catalogue, kind);
        TwinSetup t;
        t.address = std::string(e.family->factory_address);
        t.kind = kind;
        auto twin = e.family->make_twin(*e.catalogue, t);
        auto decoder = e.family->make_decoder(*e.catalogue, kind);
        LineSetup setup;
        setup.kind = kind;
        setup.bit_rate = e.family->default_bit_rate;
        DriveSetup d;
        d.id = DriveId{0};
        d.name = "d";
        d.address = t.address;
        d.axes.push_back({AxisId{0}, 1});
        setup.drives.push_back(d);
        Out out;
        Instant now = at_ns(1);
        twin->power_on({}, now, out);
        adapter->configure(setup, now, out);
        adapter->on_line(true, now, out);
        for (int i = 0; i < 20000; ++i) {
            std::array<std::uint8_t, 64> bytes{};
            for (auto& b : bytes)
                b = static_cast<std::uint8_t>(random());
            Frame f;
            if (kind == LineKind::can) {
                f = Frame::can_extended(static_cast<std::uint32_t>(random()), std::span(bytes).first(random() % 9));
                if (random() % 16 == 0) f.kind = Frame::Kind::can_error;
                if (random() % 16 == 0) f.remote = true;
            } else {
                f = Frame::run(std::span(bytes).first(1 + random() % 63));
            }
            now += std::chrono::microseconds(random() % 5000);
            f.at = now;
            out.clear();
            adapter->on_frame(f, now, out);
            twin->on_frame(f, now, out);
            (void)decoder->on_frame(f, std::nullopt);
            if (adapter->deadline() <= now) adapter->on_deadline(now, out);
            if (twin->deadline() <= now) twin->on_deadline(now, out);
            ASSERT_LT(out.frames.size(), 1000u) << "a frame does not cause a storm";
        }
        (void)decoder->finish();
    }
}

TEST_P(EveryFamily, ATwinAtRestCostsNothing) {
    const LineKind kind = e.kind();
    {
        TwinSetup t;
        t.address = std::string(e.family->factory_address);
        t.kind = kind;
        auto twin = e.family->make_twin(*e.catalogue, t);
        Out out;
        Instant now = at_ns(1);
        twin->power_on({}, now, out);
        for (int i = 0; i < 1000 && twin->deadline() != never; ++i) {
            now = twin->deadline();
            out.clear();
            twin->on_deadline(now, out);
        }
        EXPECT_EQ(twin->deadline(), never);
        for (const auto& h : twin->hand()) {
            EXPECT_FALSE(h.description.empty()) << h.name;
        }
        std::set<std::string> names;
        for (const auto& h : twin->hand())
            names.insert(h.name);
        for (const auto* must : {"power", "silent", "inject_error", "stall"})
            EXPECT_TRUE(names.contains(must)) << must;
        EXPECT_NE(twin->set_hand("no_such_thing", Value{true}, now, out), "");
    }
}

TEST_P(EveryFamily, WhatCrossesTheLineCanBeReadByPeople) {
    start();
    enable();
    w.wait(w.command(a1, move_to(w.picture(a1).position + 500), true), 10s);
    const auto log = w.engine.frame_log(site->line_ids[0])->read(1, 100000, 0);
    ASSERT_GT(log.entries.size(), 20u);
    auto decoder =
        e.family->make_decoder(*e.catalogue, log.entries.front().frame.kind == Frame::Kind::bytes ? LineKind::bytes : LineKind::can);
    std::size_t lines = 0;
    for (const auto& entry : log.entries) {
        for (const auto& text : decoder->on_frame(entry.frame, entry.to_drive)) {
            ++lines;
            EXPECT_EQ(text.find("unknown"), std::string::npos) << text;
            EXPECT_EQ(text.find('\n'), std::string::npos) << text;
        }
    }
    EXPECT_GT(lines, 10u);
}

TEST_P(EveryFamily, AdapterTakesTheSameSetupAgainWithoutDisturbance) {
    start();
    enable();
    const Ticket go = w.command(a1, move_to(w.picture(a1).position + 8000), true);
    w.run_for(300ms);
    Site same = site->site;
    w.apply(same);
    const Result* r = w.wait(go, 20s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::done) << r->text;
}

INSTANTIATE_TEST_SUITE_P(Families, EveryFamily, testing::ValuesIn(law_subjects()), name_of_subject);

TEST(Catalogues, EveryErrorHasACauseAndSomethingToDo) {
    for (const auto& f : families().entries)
        for (const ErrorCode& e : f.catalogue->errors()) {
            EXPECT_FALSE(e.cause.empty()) << f.family->name << " " << e.code << " " << e.name;
            EXPECT_FALSE(e.remedy.empty()) << f.family->name << " " << e.code << " " << e.name;
        }
}

TEST(Conformance, ThereAreFamiliesAndTheirNumbersDiffer) {
    ASSERT_FALSE(families().entries.empty());
    std::set<int> numbers;
    for (const auto& e : families().entries)
        EXPECT_TRUE(numbers.insert(e.catalogue->number()).second);
}

}  // namespace
}  // namespace axisgate::test
