// Conformance, ways in: what holds for whoever commands an axis: limits on every way down, the profile that counts, loss of command.
// In: all_families(), on twins, with control words as a PLC writes them. Out: laws. Never names a family.
#include <gtest/gtest.h>

#include "tests/world/world.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class EveryFamilyCommands : public testing::TestWithParam<FamilyEntry> {
protected:
    const FamilyEntry& e = GetParam();
    World w;
    std::shared_ptr<const SiteState> site;
    AxisId a1 = no_axis;
    std::int64_t begin = 0;
    std::uint64_t next_ticket = 1;
    const AuthorityClient plc{Door::modbus, "192.0.2.7"};

    void start(FailSafe fail_safe = {}) {
        Site s = w.make_site(e, "twin", 1);
        s.axes.at(0).fail_safe = fail_safe;
        site = w.apply(std::move(s));
        a1 = site->axis_ids.at(0);
        ASSERT_TRUE(w.run_until_true([&] { return (w.picture(a1).flags & flag_online) != 0; }, 10s));
        w.run_for(1s);
        begin = w.picture(a1).position;
    }
    /// The site again, with limits `room` increments up and down from where the axis is.
    void limit(std::int64_t room) {
        Site s = site->site;
        s.axes.at(0).position_max = static_cast<double>(begin + room) / s.axes.at(0).increments_per_unit;
        s.axes.at(0).position_min = static_cast<double>(begin - room) / s.axes.at(0).increments_per_unit;
        site = w.apply(std::move(s));
    }
    Ticket modbus(const ProcessData& d) {
        Command c;
        c.ticket = make_ticket(Door::modbus, next_ticket++);
        c.axis = a1;
        c.body = d;
        c.origin.door = Door::modbus;
        c.origin.who = std::make_shared<const std::string>("192.0.2.7:50000");
        const Ticket t = c.ticket;
        w.engine.on_command(std::move(c), w.now);
        return t;
    }
    Result answer(Ticket t) {
        const Result* r = w.wait(t, 10s);
        EXPECT_TRUE(r) << "no result";
        return r ? *r : Result{};
    }
    Result word(std::uint16_t cw) {
        ProcessData d;
        d.controlword = cw;
        return answer(modbus(d));
    }
    void enable(std::int16_t mode) {
        ProcessData d;
        d.mode = mode;
        d.profile_velocity = 2000;
        d.profile_acceleration = 20000;
        d.profile_deceleration = 20000;
        ASSERT_TRUE(good(answer(modbus(d))));
        for (const int cw : {0x06, 0x07, 0x0F}) ASSERT_TRUE(good(word(static_cast<std::uint16_t>(cw))));
        ASSERT_EQ(power_state_of(w.picture(a1).statusword), PowerState::operation_enabled);
    }
    Result set_point(std::int64_t target, std::uint16_t cw = 0x1F) {
        (void)word(0x0F);
        ProcessData d;
        d.target_position = static_cast<std::int32_t>(target);
        d.controlword = cw;
        return answer(modbus(d));
    }
    bool moving() const { return (w.picture(a1).flags & flag_moving) != 0; }
    bool turns(std::int32_t velocity) {
        ProcessData d;
        d.target_velocity = velocity;
        const Result r = answer(modbus(d));
        if (r.reason == Reason::not_supported) return false;
        EXPECT_TRUE(good(r)) << r.text;
        EXPECT_TRUE(w.run_until_true([&] { return moving() && std::abs(w.picture(a1).velocity) > std::abs(velocity) / 2; }, 5s));
        return true;
    }
    auto events(std::string_view kind) const { return std::ranges::count(w.events, std::string(kind), &Event::kind); }
};

TEST_P(EveryFamilyCommands, ASetPointThatWaitsKeepsTheLimits) {
    start();
    limit(5000);
    enable(cia402::mode_profile_position);
    ASSERT_TRUE(good(set_point(begin + 4000)));
    ASSERT_TRUE(w.run_until_true([&] { return moving(); }, 2s));
    const Result beyond = set_point(begin + 8000);
    EXPECT_EQ(beyond.outcome, Outcome::refused);
    EXPECT_EQ(beyond.reason, Reason::out_of_range) << beyond.text;
    const Result further = set_point(1500, 0x5F);  // relative to where it is going: 5500
    EXPECT_EQ(further.reason, Reason::out_of_range) << further.text;
    const auto before = w.events.size();
    const Result back = set_point(-2000, 0x5F);
    EXPECT_TRUE(good(back)) << back.text;
    EXPECT_TRUE(std::any_of(w.events.begin() + static_cast<std::ptrdiff_t>(before), w.events.end(), [](const Event& x) { return x.text.find("waits") != std::string::npos; }))
        << "a set-point that waits is an event like any other";
    std::int64_t highest = begin;
    for (int i = 0; i < 1200; ++i) {
        w.run_for(10ms);
        highest = std::max(highest, w.picture(a1).position);
    }
    EXPECT_LE(highest, begin + 5000);
    EXPECT_EQ(w.picture(a1).position, begin + 2000) << "and what fits is done in its turn";
}

TEST_P(EveryFamilyCommands, WhatWaitsIsLookedAtAgainWhenItsTurnHasCome) {
    start();
    enable(cia402::mode_profile_position);
    ASSERT_TRUE(good(set_point(begin + 4000)));
    ASSERT_TRUE(w.run_until_true([&] { return moving(); }, 2s));
    ASSERT_TRUE(good(set_point(begin + 8000)));
    SetPosition here{begin};
    const Result* renamed = w.wait(w.command(a1, here), 5s);
    ASSERT_TRUE(renamed);
    EXPECT_EQ(renamed->reason, Reason::wrong_state) << "a waiting target does not get another meaning: " << renamed->text;
    limit(5000);
    w.run_for(12s);
    EXPECT_EQ(w.picture(a1).position, begin + 4000);
    EXPECT_EQ(events("limit"), 1) << "what was not begun is told";
}

TEST_P(EveryFamilyCommands, ASetPointNeedsAVelocity) {
    start();
    enable(cia402::mode_profile_position);
    ProcessData none;
    none.profile_velocity = 0;
    ASSERT_TRUE(good(answer(modbus(none))));
    const Result r = set_point(begin + 4000);
    EXPECT_EQ(r.reason, Reason::out_of_range) << r.text;
    w.run_for(1s);
    EXPECT_EQ(w.picture(a1).position, begin);
}

TEST_P(EveryFamilyCommands, AClientThatIsGoneDoesNotLeaveTheAxisTurning) {
    start();
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    w.engine.on_client_lost({Door::modbus, "192.0.2.8"}, LossCause::modbus_closed, w.now);
    w.run_for(500ms);
    ASSERT_TRUE(moving()) << "somebody else's end is nothing to this axis";
    w.engine.on_client_lost(plc, LossCause::modbus_closed, w.now);
    ASSERT_TRUE(w.run_until_true([&] { return !moving(); }, 5s));
    EXPECT_EQ(events("fail_safe"), 1);
    EXPECT_EQ(w.picture(a1).fail_safe_cause, 1);
    EXPECT_NE(w.picture(a1).flags & flag_fail_safe, 0);
    EXPECT_EQ(w.engine.losses(LossCause::modbus_closed), 1u);
    EXPECT_EQ(power_state_of(w.picture(a1).statusword), PowerState::operation_enabled) << "halted, not switched off";
    w.run_for(300ms);  // the place of a standing axis is read once more
    const auto rest = w.picture(a1).position;
    w.run_for(2s);
    EXPECT_EQ(w.picture(a1).position, rest) << "it does not go on by itself";
    ASSERT_TRUE(turns(-2000));
    EXPECT_EQ(w.picture(a1).fail_safe_cause, 0) << "the next command ends it";
}

TEST_P(EveryFamilyCommands, WhoHasTakenOverIsNotStoppedForWhoCameBefore) {
    start();
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = -2000;
    const Result* r = w.wait(w.command(a1, m), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    w.engine.on_client_lost(plc, LossCause::modbus_closed, w.now);
    w.run_for(2s);
    EXPECT_TRUE(moving());
    EXPECT_EQ(events("fail_safe"), 0);
}

TEST_P(EveryFamilyCommands, AMotionToATargetGoesOnUnlessTheSiteSaysOtherwise) {
    start();
    enable(cia402::mode_profile_position);
    ASSERT_TRUE(good(set_point(begin + 4000)));
    w.engine.on_client_lost(plc, LossCause::modbus_closed, w.now);
    w.run_for(8s);
    EXPECT_EQ(w.picture(a1).position, begin + 4000) << "a client may connect for each of its requests";
    EXPECT_EQ(events("fail_safe"), 0);
}

TEST_P(EveryFamilyCommands, WhatTheSiteNamesHoldsForEveryMotion) {
    for (const auto action : {FailSafeAction::halt, FailSafeAction::quick_stop, FailSafeAction::disable}) {
        SCOPED_TRACE(name_of(action));
        FailSafe f;
        f.of(LossCause::modbus_closed) = action;
        start(f);
        enable(cia402::mode_profile_position);
        ASSERT_TRUE(good(set_point(begin + 40000)));
        ASSERT_TRUE(w.run_until_true([&] { return moving(); }, 2s));
        w.run_for(500ms);
        w.engine.on_client_lost(plc, LossCause::modbus_closed, w.now);
        ASSERT_TRUE(w.run_until_true([&] { return !moving(); }, 5s));
        w.run_for(1s);
        EXPECT_LT(w.picture(a1).position, begin + 30000);
        const auto wanted = action == FailSafeAction::halt         ? PowerState::operation_enabled
                            : action == FailSafeAction::quick_stop ? PowerState::quick_stop_active
                                                                   : PowerState::switch_on_disabled;
        EXPECT_EQ(power_state_of(w.picture(a1).statusword), wanted);
        const Result* off = w.wait(w.command(a1, Disable{}, true), 5s);
        ASSERT_TRUE(off && good(*off));
    }
}

TEST_P(EveryFamilyCommands, TheActualPositionIsTheFirstTargetUnlessItsOwnClientWroteOne) {
    start();
    ProcessData d;
    d.mode = cia402::mode_profile_position;
    d.profile_velocity = 2000;
    d.target_position = static_cast<std::int32_t>(begin + 3000);
    ASSERT_TRUE(good(answer(modbus(d))));
    for (const int cw : {0x06, 0x07, 0x0F}) ASSERT_TRUE(good(word(static_cast<std::uint16_t>(cw))));
    EXPECT_EQ(w.picture(a1).target_position, begin + 3000);
    w.run_for(2s);
    EXPECT_EQ(w.picture(a1).position, begin) << "nothing moves because it was enabled";
    ASSERT_TRUE(good(word(0x1F)));
    w.run_for(6s);
    EXPECT_EQ(w.picture(a1).position, begin + 3000);
}

TEST_P(EveryFamilyCommands, AnAxisWhoseLineIsBrokenIsNotShownAsMoving) {
    const LineKind kind = e.family->uses_can ? LineKind::can : LineKind::bytes;
    site = w.apply(w.make_site(e, kind == LineKind::can ? "can:x" : "tcp:127.0.0.1:1", 1, "device"));
    a1 = site->axis_ids.at(0);
    w.plug_in("line", site->drive_ids.at(0), e, addresses(e, 1).at(0), kind);
    ASSERT_TRUE(w.run_until_true([&] { return (w.picture(a1).flags & flag_online) != 0; }, 20s));
    w.run_for(1s);
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    w.cables.at("line")->cut(w.now);
    w.run_for(100ms);
    EXPECT_FALSE(moving()) << "nobody knows what it does";
    EXPECT_EQ(w.picture(a1).flags & flag_online, 0);
    EXPECT_NE(w.picture(a1).flags & flag_stale, 0);
}

TEST_P(EveryFamilyCommands, AConnectedClientThatIsSilentDoesNotLeaveTheAxisTurning) {
    start();
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    w.heard_at = w.now;
    for (int i = 0; i < 20; ++i) {
        w.run_for(500ms);
        w.heard_at = w.now;
    }
    ASSERT_TRUE(moving()) << "it asks, and so it is there";
    w.run_for(4900ms);
    EXPECT_TRUE(moving());
    ASSERT_TRUE(w.run_until_true([&] { return !moving(); }, 2s));
    EXPECT_EQ(w.picture(a1).fail_safe_cause, 2);
    EXPECT_EQ(events("fail_safe"), 1);
}

INSTANTIATE_TEST_SUITE_P(Families, EveryFamilyCommands, testing::ValuesIn(families().entries), [](const auto& i) { return std::string(i.param.family->name); });

}  // namespace
}  // namespace axisgate::test
