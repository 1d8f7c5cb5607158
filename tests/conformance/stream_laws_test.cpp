// Conformance, streamed set-points: what holds for whoever renews set-points in cycles: limits, authority, silence, stops, no event per
// cycle. In: all_families(), on twins. Out: laws. Where a drive does not follow streams, it says so by state and nothing moves. Never names
// a family.
#include <gtest/gtest.h>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;
using Mode = SetPoint::Mode;

class StreamLaws : public Laws {
protected:
    static constexpr Duration cycle = 20ms, good_for = 200ms;
    std::int64_t begin = 0;

    static Origin from(std::string who) { return {Door::ethernet_ip, std::make_shared<const std::string>(std::move(who)), {}}; }
    const Origin plc = from("192.0.2.9:50000"), other = from("192.0.2.8:50000");

    void begin_with(FailSafe fail_safe = {}, double room = 0) {
        world = fresh();
        Site s = world->twins(e);
        s.axes.at(0).fail_safe = fail_safe;
        start(std::move(s));
        begin = now().position;
        if (room > 0) {
            Site limited = site->site;
            AxisSpec& a = limited.axes.at(0);
            a.position_max = (static_cast<double>(begin) + room) / a.increments_per_unit;
            a.position_min = (static_cast<double>(begin) - room) / a.increments_per_unit;
            a.velocity_max = 5000 / a.increments_per_unit;
            site = world->apply(std::move(limited));
        }
        order(a1, Enable{});
        world->events.clear();
    }
    [[nodiscard]] bool follows(Mode mode) const { return e.catalogue->offers_mode(cia402::mode_of(mode)); }
    void say(std::int64_t value, Mode mode = Mode::position, const Origin* by = nullptr, std::int64_t velocity = 4000) {
        SetPoint p;
        p.axis = a1;
        p.mode = mode;
        p.value = value;
        if (mode == Mode::position) p.velocity = velocity;
        p.acceleration = p.deceleration = 20000;
        p.good_for = good_for;
        p.at = world->now;
        p.origin = by ? *by : plc;
        world->engine.on_set_point(p, world->now);
    }
    /// The same again and again.
    void stream(std::int64_t value, Mode mode, Duration time, const Origin* by = nullptr) {
        for (const Instant end = world->now + time; world->now < end; world->run_for(cycle))
            say(value, mode, by);
    }
    /// Where the drive does not follow this mode: true, and that has been looked at.
    bool does_not_follow(Mode mode) {
        if (follows(mode)) return false;
        stream(mode == Mode::position ? begin + 1000 : 1000, mode, 500ms);
        EXPECT_FALSE(now().streaming);
        EXPECT_EQ(now().set_point_refusal, Reason::not_supported);
        EXPECT_EQ(now().set_points, 0u);
        EXPECT_EQ(events("set_points"), 1) << "told once";
        EXPECT_FALSE(moving(a1));
        EXPECT_EQ(now().position, begin);
        return true;
    }
    [[nodiscard]] std::size_t results() const {
        std::size_t n = 0;
        for (const auto& [ticket, list] : world->results)
            n += list.size();
        return n;
    }
};

TEST_P(StreamLaws, APositionIsFollowedWithoutATicketAndWithoutAnEventPerCycle) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    const std::size_t before = results();
    for (int i = 1; i <= 100; ++i) {
        say(begin + i * 40);  // 2000 increments/s
        world->run_for(cycle);
        if (i % 10 == 0) EXPECT_NEAR(static_cast<double>(now().position), static_cast<double>(begin + i * 40), 1200) << "cycle " << i;
    }
    EXPECT_TRUE(now().streaming);
    EXPECT_EQ(now().mode_display, cia402::mode_cyclic_position);
    EXPECT_NE(now().statusword & cia402::sw_mode_12, 0) << "the drive follows the command value";
    EXPECT_EQ(now().set_points, 100u);
    EXPECT_EQ(now().set_points_refused, 0u);
    EXPECT_EQ(now().target_position, begin + 4000);
    stream(begin + 4000, Mode::position, 3s);
    EXPECT_EQ(now().position, begin + 4000);
    EXPECT_EQ(results(), before) << "no ticket, no result";
    EXPECT_EQ(events("set_points"), 1) << "the begin is one event, a renewal is none";
    EXPECT_EQ(events("command"), 0);
    EXPECT_EQ(events("fail_safe"), 0);
}

TEST_P(StreamLaws, TheNewestCounts) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    for (int i = 0; i < 500; ++i)
        say(begin + 1000 + i);  // all in one instant: the line has no room for them
    stream(begin + 500, Mode::position, 3s);
    EXPECT_EQ(now().position, begin + 500);
}

TEST_P(StreamLaws, TheSitesLimitsHold) {
    begin_with({}, 2000);
    if (does_not_follow(Mode::position)) return;
    stream(begin + 1000, Mode::position, 100ms);
    ASSERT_TRUE(now().streaming);
    const auto taken = now().set_points;
    for (int i = 0; i < 5; ++i) {
        say(begin + 2001);                                 // a place behind the limit
        say(begin + 1500, Mode::position, nullptr, 5001);  // a speed above it
        if (follows(Mode::velocity)) say(5001, Mode::velocity);
        world->run_for(cycle);
    }
    EXPECT_EQ(now().set_points, taken);
    EXPECT_GE(now().set_points_refused, 10u);
    EXPECT_EQ(now().set_point_refusal, Reason::out_of_range);
    EXPECT_LE(events("set_points"), 2) << "the begin, and the refusal once";
    stream(begin + 2001, Mode::position, 2s);  // a refused one keeps nothing alive
    EXPECT_FALSE(now().streaming);
    EXPECT_LE(now().position, begin + 1000);
    world->run_for(1s);
    stream(begin + 1800, Mode::position, 3s);
    EXPECT_EQ(now().position, begin + 1800) << "within the limits it goes on";
}

TEST_P(StreamLaws, ASpeedEndsAtTheLimitOfPosition) {
    begin_with({}, 6000);
    if (does_not_follow(Mode::velocity)) return;
    for (int i = 0; i < 300; ++i) {
        say(3000, Mode::velocity);
        world->run_for(cycle);
    }
    EXPECT_GE(events("limit"), 1);
    EXPECT_FALSE(moving(a1));
    EXPECT_LE(now().position, begin + 6000) << "and the client that went on did not push it further";
    EXPECT_GT(now().position, begin + 3000);
    world->run_for(1s);
    stream(-3000, Mode::velocity, 500ms);
    EXPECT_TRUE(moving(a1)) << "the other way is free";
}

TEST_P(StreamLaws, AStreamThatStopsIsALostClient) {
    begin_with();
    const Mode mode = follows(Mode::velocity) ? Mode::velocity : Mode::position;
    if (does_not_follow(mode)) return;
    stream(mode == Mode::velocity ? 2000 : begin + 40000, mode, 1s);
    ASSERT_TRUE(moving(a1));
    ASSERT_TRUE(world->run_until_true([&] { return !now().streaming; }, good_for + 100ms));
    ASSERT_TRUE(world->run_until_true([&] { return !moving(a1); }, 5s));
    EXPECT_EQ(events("fail_safe"), 1);
    EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(LossCause::set_points_silent));
    EXPECT_EQ(world->engine.losses(LossCause::set_points_silent), 1u);
    EXPECT_EQ(power_state_of(now().statusword), PowerState::operation_enabled) << "halted, not switched off";
    world->run_for(300ms);
    const auto rest = now().position;
    world->run_for(2s);
    EXPECT_EQ(now().position, rest);
    stream(rest, Mode::position, 200ms);
    EXPECT_EQ(now().fail_safe_cause, 0) << "the next stream ends it";
    EXPECT_TRUE(now().streaming);
}

TEST_P(StreamLaws, WhatTheSiteNamesForALostStreamIsDone) {
    FailSafe f;
    f.of(LossCause::set_points_silent) = FailSafeAction::disable;
    begin_with(f);
    if (does_not_follow(Mode::position)) return;
    stream(begin + 100, Mode::position, 3s);
    ASSERT_FALSE(moving(a1));
    ASSERT_TRUE(world->run_until_true([&] { return power_state_of(now().statusword) < PowerState::operation_enabled; }, 5s));
    EXPECT_EQ(events("fail_safe"), 1);
}

TEST_P(StreamLaws, AClientThatIsGoneEndsItsStream) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    stream(begin + 40000, Mode::position, 1s);
    world->engine.on_client_lost(AuthorityClient::of(other), LossCause::modbus_closed, world->now);
    EXPECT_TRUE(now().streaming) << "somebody else's end is nothing to this axis";
    world->engine.on_client_lost(AuthorityClient::of(plc), LossCause::modbus_closed, world->now);
    EXPECT_FALSE(now().streaming);
    ASSERT_TRUE(world->run_until_true([&] { return !moving(a1); }, 5s));
    EXPECT_LT(now().position, begin + 30000);
}

TEST_P(StreamLaws, AnotherClientDoesNotStreamIntoAHeldAxis) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    Command c;
    c.ticket = make_ticket(first_service_door, 1'000'000);
    c.axis = a1;
    c.body = HoldAxis{};
    c.origin = other;
    world->engine.on_command(c, world->now);
    const Result* r = world->wait(c.ticket, 1s);
    ASSERT_TRUE(r && good(*r)) << told(r);
    stream(begin + 1000, Mode::position, 500ms);
    EXPECT_FALSE(now().streaming);
    EXPECT_EQ(now().set_point_refusal, Reason::authority);
    EXPECT_EQ(now().position, begin);
    stream(begin + 300, Mode::position, 500ms, &other);
    EXPECT_TRUE(now().streaming);
    const auto taken = now().set_points;
    say(begin + 1000);
    EXPECT_EQ(now().set_points, taken);
    EXPECT_EQ(now().set_point_refusal, Reason::authority);
    EXPECT_TRUE(now().streaming) << "and the holder's goes on";
}

TEST_P(StreamLaws, OneStreamAtATime) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    for (int i = 0; i < 100; ++i) {
        say(begin + 400);
        say(begin + 4000, Mode::position, &other);
        world->run_for(cycle);
    }
    EXPECT_EQ(now().position, begin + 400);
    EXPECT_GE(now().set_points_refused, 100u);
    EXPECT_LE(events("set_points"), 4) << "the begin, and the refusal once a second";
}

TEST_P(StreamLaws, AStopHoldsAgainstAStreamThatGoesOn) {
    for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        SCOPED_TRACE(name_of(stop));
        begin_with();
        if (does_not_follow(Mode::position)) return;
        stream(begin + 40000, Mode::position, 1s);
        ASSERT_TRUE(moving(a1));
        (void)world->command(a1, stop);
        stream(begin + 40000, Mode::position, 5s);
        EXPECT_FALSE(moving(a1));
        EXPECT_FALSE(now().streaming);
        EXPECT_LT(now().position, begin + 30000);
        EXPECT_LE(events("set_points"), 8);
        const auto rest = now().position;
        world->run_for(good_for + 100ms);
        if (std::holds_alternative<Halt>(stop)) {
            stream(rest + 500, Mode::position, 3s);
            EXPECT_EQ(now().position, rest + 500) << "after a pause it may begin anew";
        }
    }
}

TEST_P(StreamLaws, AMoveOfSomebodyElseEndsIt) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    stream(begin + 200, Mode::position, 1s);
    const Ticket t = world->command(a1, move_to(begin + 3000), true);
    stream(begin + 200, Mode::position, 3s);
    const Result* r = world->wait(t, 5s);
    ASSERT_TRUE(r && r->outcome == Outcome::done) << told(r);
    EXPECT_EQ(now().position, begin + 3000);
    EXPECT_EQ(now().mode_display, cia402::mode_profile_position);
}

TEST_P(StreamLaws, AnAxisThatIsOffOrSilentRefuses) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    stream(begin, Mode::position, 300ms);
    ASSERT_EQ(hand("power", false), "");
    stream(begin + 1000, Mode::position, 20s);
    EXPECT_FALSE(now().streaming);
    EXPECT_NE(now().set_point_refusal, Reason::none);
    ASSERT_EQ(hand("power", true), "");
    ASSERT_TRUE(world->run_until_true([&] { return online(a1); }, 60s));
    world->run_for(1s);
    const auto rest = now().position;
    stream(rest + 1000, Mode::position, 1s);
    EXPECT_EQ(now().set_point_refusal, Reason::wrong_state) << "nothing moves because something has come back";
    EXPECT_EQ(now().position, rest);
}

TEST_P(StreamLaws, WhatIsTooOldOrGoodForTooLongIsRefused) {
    begin_with();
    SetPoint p;
    p.axis = a1;
    p.value = begin + 100;
    p.origin = plc;
    for (const Duration wrong : {Duration(0), Duration(19ms), Duration(10'001ms)}) {
        p.good_for = wrong;
        p.at = world->now;
        world->engine.on_set_point(p, world->now);
        EXPECT_EQ(now().set_point_refusal, Reason::out_of_range);
    }
    p.good_for = good_for;
    p.at = world->now - good_for - 1ms;
    world->engine.on_set_point(p, world->now);
    EXPECT_EQ(now().set_point_refusal, Reason::interrupted);
    EXPECT_EQ(now().set_points, 0u);
}

TEST_P(StreamLaws, AModeThatTheDriveHasNotIsRefusedByWord) {
    begin_with();
    for (const std::int16_t mode : {std::int16_t{2}, std::int16_t{4}, std::int16_t{-7}}) {
        if (e.catalogue->offers_mode(mode)) continue;
        ProcessData d;
        d.mode = mode;
        const Result* r = ask(a1, d, false);
        ASSERT_TRUE(r);
        EXPECT_EQ(r->reason, Reason::out_of_range) << told(r);
        EXPECT_NE(r->text.find("1, 3, 6"), std::string::npos) << r->text;
    }
}

INSTANTIATE_TEST_SUITE_P(Families, StreamLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
