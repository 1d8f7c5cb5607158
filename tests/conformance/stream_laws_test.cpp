// Laws of streamed set-points, for every family: limits, authority, silence, stops, no event per cycle. If a drive does not follow streams,
// its state says so and nothing moves.
#include <gtest/gtest.h>

#include "gateway/doors/dds/words.hpp"
#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;
using Mode = SetPoint::Mode;

class StreamLaws : public Laws {
protected:
    static constexpr Duration cycle = 20ms, good_for = 200ms;
    std::int64_t begin = 0;

    static Origin from(std::string who, Door door = enip::clients) {
        return {door, std::make_shared<const std::string>(std::move(who)), {}};
    }
    const Origin plc = from("192.0.2.9:50000"), other = from("192.0.2.8:50000"), member = from("yard anna", dds::clients);

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
    /// The same set-point again and again.
    void stream(std::int64_t value, Mode mode, Duration time, const Origin* by = nullptr) {
        for (const Instant end = world->now + time; world->now < end; world->run_for(cycle))
            say(value, mode, by);
    }
    /// Returns true if the drive does not follow this mode, after checking this.
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
        say(begin + 1000 + i);  // all at one instant: the line cannot carry them
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
        say(begin + 2001);                                 // a position beyond the limit
        say(begin + 1500, Mode::position, nullptr, 5001);  // a speed above it
        if (follows(Mode::velocity)) say(5001, Mode::velocity);
        world->run_for(cycle);
    }
    EXPECT_EQ(now().set_points, taken);
    EXPECT_GE(now().set_points_refused, 10u);
    EXPECT_EQ(now().set_point_refusal, Reason::out_of_range);
    EXPECT_LE(events("set_points"), 2) << "the begin, and the refusal once";
    stream(begin + 2001, Mode::position, 2s);  // a refused one does not renew the stream
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
    world->engine.on_client_lost(AuthorityClient::of(other), modbus::loss_closed, world->now);
    EXPECT_TRUE(now().streaming) << "somebody else's end is nothing to this axis";
    world->engine.on_client_lost(AuthorityClient::of(plc), modbus::loss_closed, world->now);
    EXPECT_FALSE(now().streaming);
    ASSERT_TRUE(world->run_until_true([&] { return !moving(a1); }, 5s));
    EXPECT_LT(now().position, begin + 30000);
}

TEST_P(StreamLaws, AClosedFeedEndsItsStreamAtOnceAndNothingElse) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    stream(begin + 40000, Mode::position, 1s);
    ASSERT_TRUE(now().streaming);
    world->engine.on_client_lost(AuthorityClient::of(other), LossCause::set_points_silent, world->now);
    EXPECT_TRUE(now().streaming);
    world->engine.on_client_lost(AuthorityClient::of(plc), LossCause::set_points_silent, world->now);
    EXPECT_FALSE(now().streaming) << "without waiting for good_for";
    EXPECT_EQ(events("fail_safe"), 1);
    EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(LossCause::set_points_silent));
    ASSERT_TRUE(world->run_until_true([&] { return !moving(a1); }, 5s));
    Command move;
    move.ticket = make_ticket(first_service_door, 1'000'000);
    move.axis = a1;
    move.body = move_to(begin);
    move.origin = plc;
    world->engine.on_command(move, world->now);
    ASSERT_TRUE(world->run_until_true([&] { return moving(a1); }, 5s));
    world->engine.on_client_lost(AuthorityClient::of(plc), LossCause::set_points_silent, world->now);
    world->run_for(60s);
    EXPECT_EQ(now().position, begin) << "a motion that it commanded otherwise goes on";
}

TEST_P(StreamLaws, OverDdsAStreamThatStopsHasMissedItsDeadline) {
    FailSafe f;
    f.of(LossCause::set_points_silent) = FailSafeAction::nothing;
    f.of(dds::loss_deadline) = FailSafeAction::disable;
    begin_with(f);
    if (does_not_follow(Mode::position)) return;
    stream(begin + 40000, Mode::position, 1s, &member);
    ASSERT_TRUE(now().streaming);
    const Instant last = world->now - cycle;
    ASSERT_TRUE(world->run_until_true([&] { return !now().streaming; }, good_for + 100ms));
    EXPECT_GE(world->now - last, good_for);
    EXPECT_LE(world->now - last, good_for + 50ms);
    EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(dds::loss_deadline));
    EXPECT_EQ(world->engine.losses(dds::loss_deadline), 1u);
    ASSERT_TRUE(world->run_until_true([&] { return power_state_of(now().statusword) < PowerState::operation_enabled; }, 5s));
}

TEST_P(StreamLaws, OverDdsAFeedThatEndsMissesItsDeadlineAtOnceAndACommanderThatIsGoneLeavesLivingSetPointsAlone) {
    begin_with();
    if (does_not_follow(Mode::position)) return;
    stream(begin + 40000, Mode::position, 500ms, &member);
    world->engine.on_client_lost(AuthorityClient::of(member), dds::loss_deadline, world->now);
    stream(begin + 40000, Mode::position, 300ms, &member);
    EXPECT_TRUE(now().streaming) << "its set-points are renewed, whichever of its writers is gone";
    EXPECT_EQ(events("fail_safe"), 0);
    world->engine.on_client_lost(AuthorityClient::of(member), LossCause::set_points_silent, world->now);
    EXPECT_FALSE(now().streaming) << "without waiting for good_for";
    EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(dds::loss_deadline));
    ASSERT_TRUE(world->run_until_true([&] { return !moving(a1); }, 5s));
}

TEST_P(StreamLaws, ARefusedSetPointIsAnsweredWithItsReason) {
    begin_with();
    SetPoint p;
    p.axis = a1;
    p.value = begin;
    p.at = world->now;
    p.good_for = 1ms;
    p.origin = plc;
    const auto no = world->engine.on_set_point(p, world->now);
    ASSERT_TRUE(no);
    EXPECT_EQ(no->reason, Reason::out_of_range) << no->text;
    p.axis = AxisId{999};
    ASSERT_TRUE(world->engine.on_set_point(p, world->now)) << "there is no such axis";
    p.axis = a1;
    p.good_for = good_for;
    EXPECT_EQ(world->engine.on_set_point(p, world->now).has_value(), !follows(Mode::position));
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
    ASSERT_TRUE(r && good(*r)) << published(r);
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
    ASSERT_TRUE(r && r->outcome == Outcome::done) << published(r);
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
        EXPECT_EQ(r->reason, Reason::out_of_range) << published(r);
        EXPECT_NE(r->text.find("1 (profile position)"), std::string::npos) << r->text;
    }
}

/// An adapter whose drive reaches each set-point within 20 ms, at any speed.
class InItsPeriod final : public PassingAdapter {
public:
    using PassingAdapter::PassingAdapter;
    [[nodiscard]] Duration interpolation_time(AxisId) const override { return 20ms; }
};

/// An adapter without set-points, whatever its page says.
class WithoutSetPoints final : public PassingAdapter {
public:
    using PassingAdapter::PassingAdapter;
    void on_set_point(const SetPoint& p, Instant now, Out& out) override { Adapter::on_set_point(p, now, out); }
};

/// The family that follows positions and speeds, with another adapter around its own.
struct StreamAdapters : testing::Test {
    static const FamilyEntry& base() {
        static const FamilyEntry& found = *std::ranges::find_if(
            families().entries, [](const FamilyEntry& f) { return f.catalogue->offers_mode(8) && f.catalogue->offers_mode(9); });
        return found;
    }
    std::unique_ptr<World> world;
    std::shared_ptr<const SiteState> site;
    AxisId axis = no_axis;
    Duration good_for = 500ms;

    void start(const Family& changed) {
        Families all = families();
        for (auto& f : all.entries) {
            if (f.family == base().family) f.family = &changed;
        }
        world = std::make_unique<World>(1, std::make_shared<Plant>(), all);
        Site s = world->make_site(base(), "twin", 1);
        s.axes.at(0).velocity_max = 50;       // 5000 increments/s
        s.axes.at(0).acceleration_max = 200;  // 20000 increments/s2
        site = world->apply(std::move(s));
        axis = site->axis_ids.at(0);
        ASSERT_TRUE(world->run_until_true([&] { return (picture().flags & flag_online) != 0; }, 20s));
        const Result* r = world->wait(world->command(axis, Enable{}, true), 20s);
        ASSERT_TRUE(r && good(*r)) << published(r);
        world->run_for(500ms);
        world->events.clear();
    }
    [[nodiscard]] AxisPicture picture() const { return world->picture(axis); }
    std::optional<Refusal> say(std::int64_t value, SetPoint::Mode mode = SetPoint::Mode::position) {
        SetPoint p;
        p.axis = axis;
        p.mode = mode;
        p.value = value;
        p.good_for = good_for;
        p.at = world->now;
        p.origin = {enip::clients, std::make_shared<const std::string>("192.0.2.9:50000"), {}};
        return world->engine.on_set_point(p, world->now);
    }
    [[nodiscard]] std::ptrdiff_t events() const {
        return std::ranges::count_if(world->events, [&](const Event& v) { return v.kind == "set_points"; });
    }
};

const Family& in_its_period() {
    static const Family changed = [] {
        Family f = *StreamAdapters::base().family;
        f.served_by = nullptr;
        f.make_adapter = [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> {
            return std::make_unique<InItsPeriod>(StreamAdapters::base().family->make_adapter(c, kind));
        };
        return f;
    }();
    return changed;
}

TEST_F(StreamAdapters, ARefusalSoonAfterAnotherIsToldAsSoonAsItMay) {
    start(in_its_period());
    good_for = 5s;
    const std::int64_t here = picture().position;
    EXPECT_TRUE(say(here + 101));
    EXPECT_FALSE(say(here + 100));
    world->events.clear();
    for (int i = 0; i < 60; ++i) {
        EXPECT_TRUE(say(here + 5000));
        if (i == 40) EXPECT_EQ(events(), 0) << "not twice in a second";
        world->run_for(20ms);
    }
    EXPECT_EQ(events(), 1) << "and not forgotten for it";
}

TEST_F(StreamAdapters, AStepIsNoGreaterThanTheSitesSpeedInTheInterpolationTime) {
    start(in_its_period());
    const std::int64_t here = picture().position;
    const auto jump = say(here + 101);
    ASSERT_TRUE(jump) << "the first one counts from where the axis is";
    EXPECT_EQ(jump->reason, Reason::out_of_range);
    EXPECT_NE(jump->text.find("velocity_max"), std::string::npos) << jump->text;
    EXPECT_FALSE(picture().streaming);
    for (std::int64_t i = 1; i <= 60; ++i) {
        EXPECT_FALSE(say(here + i * 100)) << "5000 increments/s for 20 ms";
        world->run_for(20ms);
    }
    const auto taken = picture().set_points;
    world->events.clear();
    for (int i = 0; i < 5; ++i) {
        EXPECT_TRUE(say(here + 6101));
        EXPECT_TRUE(say(here + 5899));
        world->run_for(20ms);
    }
    EXPECT_EQ(picture().set_points, taken);
    EXPECT_EQ(events(), 1) << "told once";
    EXPECT_FALSE(say(here + 5900)) << "from the last one that was taken";
    world->run_for(2s);  // its end

    EXPECT_TRUE(say(401, SetPoint::Mode::velocity)) << "20000 increments/s2 for 20 ms";
    world->run_for(600ms);  // after a refusal, the pause before a new stream
    EXPECT_FALSE(say(400, SetPoint::Mode::velocity));
    EXPECT_FALSE(say(800, SetPoint::Mode::velocity));
    EXPECT_TRUE(say(1201, SetPoint::Mode::velocity));
}

TEST_F(StreamAdapters, AnAdapterThatTakesNoSetPointsSaysSo) {
    static const Family changed = [] {
        Family f = *base().family;
        f.served_by = nullptr;
        f.make_adapter = [](const Catalogue& c, LineKind kind) -> std::unique_ptr<Adapter> {
            return std::make_unique<WithoutSetPoints>(base().family->make_adapter(c, kind));
        };
        return f;
    }();
    start(changed);
    (void)say(picture().position + 100);
    EXPECT_FALSE(picture().streaming);
    EXPECT_EQ(picture().set_point_refusal, Reason::not_supported);
    EXPECT_TRUE(say(picture().position + 100)) << "and whoever goes on is told";
}

INSTANTIATE_TEST_SUITE_P(Families, StreamLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
