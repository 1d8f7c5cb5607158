// Laws for every way of commanding an axis: limits, the profile that applies, loss of command. Control words are written as a PLC does.
#include <gtest/gtest.h>

#include "gateway/doors/modbus/words.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class CommandLaws : public Laws {
protected:
    std::int64_t begin = 0;
    std::uint64_t next_ticket = 1;
    const AuthorityClient plc{modbus::clients, "192.0.2.7"};

    void begin_with(FailSafe fail_safe = {}) {
        world = fresh();
        Site s = world->twins(e);
        s.axes.at(0).fail_safe = fail_safe;
        start(std::move(s));
        begin = now().position;
    }
    /// Applies the site again with limits `room` increments above and below the axis.
    void limit(std::int64_t room) {
        Site s = site->site;
        s.axes.at(0).position_max = static_cast<double>(begin + room) / s.axes.at(0).increments_per_unit;
        s.axes.at(0).position_min = static_cast<double>(begin - room) / s.axes.at(0).increments_per_unit;
        site = world->apply(std::move(s));
    }
    Ticket modbus(const ProcessData& d) {
        Command c;
        c.ticket = make_ticket(1, next_ticket++);
        c.axis = a1;
        c.body = d;
        c.origin.door = modbus::clients;
        c.origin.who = std::make_shared<const std::string>("192.0.2.7:50000");
        const Ticket t = c.ticket;
        world->engine.on_command(std::move(c), world->now);
        return t;
    }
    Result answer(Ticket t) {
        const Result* r = world->wait(t, 10s);
        EXPECT_TRUE(r) << "no result";
        return r ? *r : Result{};
    }
    Result word(int cw) {
        ProcessData d;
        d.controlword = static_cast<std::uint16_t>(cw);
        return answer(modbus(d));
    }
    void enable_by_words() {
        for (const int cw : {0x06, 0x07, 0x0F})
            ASSERT_TRUE(good(word(cw)));
        ASSERT_EQ(power_state_of(now().statusword), PowerState::operation_enabled);
    }
    void enable(std::int16_t mode) {
        ProcessData d;
        d.mode = mode;
        d.profile_velocity = 2000;
        d.profile_acceleration = 20000;
        d.profile_deceleration = 20000;
        ASSERT_TRUE(good(answer(modbus(d))));
        enable_by_words();
    }
    Result set_point(std::int64_t target, int cw = 0x1F) {
        (void)word(0x0F);
        ProcessData d;
        d.target_position = static_cast<std::int32_t>(target);
        d.controlword = static_cast<std::uint16_t>(cw);
        return answer(modbus(d));
    }
    bool goes() const { return moving(a1); }
    /// Returns false if this drive has no velocity mode, and has said so.
    bool turns(std::int32_t velocity) {
        ProcessData d;
        d.target_velocity = velocity;
        const Result r = answer(modbus(d));
        if (r.reason == Reason::not_supported) {
            lacks_velocity(r);
            EXPECT_FALSE(goes());
            return false;
        }
        EXPECT_TRUE(good(r)) << r.text;
        EXPECT_TRUE(world->run_until_true([&] { return goes() && std::abs(now().velocity) > std::abs(velocity) / 2; }, 5s));
        return true;
    }
};

TEST_P(CommandLaws, ASetPointThatWaitsKeepsTheLimits) {
    begin_with();
    limit(5000);
    enable(cia402::mode_profile_position);
    ASSERT_TRUE(good(set_point(begin + 4000)));
    ASSERT_TRUE(world->run_until_true([&] { return goes(); }, 2s));
    const Result beyond = set_point(begin + 8000);
    EXPECT_EQ(beyond.outcome, Outcome::refused);
    EXPECT_EQ(beyond.reason, Reason::out_of_range) << beyond.text;
    const Result further = set_point(1500, 0x5F);  // relative to its target: 5500
    EXPECT_EQ(further.reason, Reason::out_of_range) << further.text;
    const auto before = world->events.size();
    const Result back = set_point(-2000, 0x5F);
    EXPECT_TRUE(good(back)) << back.text;
    EXPECT_TRUE(std::any_of(world->events.begin() + static_cast<std::ptrdiff_t>(before), world->events.end(), [](const Event& x) {
        return x.text.find("waits") != std::string::npos;
    })) << "a set-point that waits is an event like any other";
    std::int64_t highest = begin;
    for (int i = 0; i < 1200; ++i) {
        world->run_for(10ms);
        highest = std::max(highest, now().position);
    }
    EXPECT_LE(highest, begin + 5000);
    EXPECT_EQ(now().position, begin + 2000) << "and what fits is done in its turn";
}

TEST_P(CommandLaws, WhatWaitsIsLookedAtAgainWhenItsTurnHasCome) {
    begin_with();
    enable(cia402::mode_profile_position);
    ASSERT_TRUE(good(set_point(begin + 4000)));
    ASSERT_TRUE(world->run_until_true([&] { return goes(); }, 2s));
    ASSERT_TRUE(good(set_point(begin + 8000)));
    SetPosition here{begin};
    const Result* renamed = ask(a1, here, false);
    ASSERT_TRUE(renamed);
    EXPECT_EQ(renamed->reason, Reason::wrong_state) << "a waiting target does not get another meaning: " << renamed->text;
    limit(5000);
    world->run_for(12s);
    EXPECT_EQ(now().position, begin + 4000);
    EXPECT_EQ(events("limit"), 1) << "what was not begun is told";
}

TEST_P(CommandLaws, ASetPointNeedsAVelocity) {
    begin_with();
    enable(cia402::mode_profile_position);
    ProcessData none;
    none.profile_velocity = 0;
    ASSERT_TRUE(good(answer(modbus(none))));
    const Result r = set_point(begin + 4000);
    EXPECT_EQ(r.reason, Reason::out_of_range) << r.text;
    world->run_for(1s);
    EXPECT_EQ(now().position, begin);
}

TEST_P(CommandLaws, AClientThatIsGoneDoesNotLeaveTheAxisTurning) {
    begin_with();
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    world->engine.on_client_lost({modbus::clients, "192.0.2.8"}, modbus::loss_closed, world->now);
    world->run_for(500ms);
    ASSERT_TRUE(goes()) << "somebody else's end is nothing to this axis";
    world->engine.on_client_lost(plc, modbus::loss_closed, world->now);
    ASSERT_TRUE(world->run_until_true([&] { return !goes(); }, 5s));
    EXPECT_EQ(events("fail_safe"), 1);
    EXPECT_EQ(now().fail_safe_cause, 1);
    EXPECT_NE(now().flags & flag_fail_safe, 0);
    EXPECT_EQ(world->engine.losses(modbus::loss_closed), 1u);
    EXPECT_EQ(power_state_of(now().statusword), PowerState::operation_enabled) << "halted, not switched off";
    world->run_for(300ms);  // the position of a standing axis is read once more
    const auto rest = now().position;
    world->run_for(2s);
    EXPECT_EQ(now().position, rest) << "it does not go on by itself";
    ASSERT_TRUE(turns(-2000));
    EXPECT_EQ(now().fail_safe_cause, 0) << "the next command ends it";
}

TEST_P(CommandLaws, WhoHasTakenOverIsNotStoppedForWhoCameBefore) {
    begin_with();
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = -2000;
    const Result* r = world->wait(world->command(a1, m), 5s);
    ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
    world->engine.on_client_lost(plc, modbus::loss_closed, world->now);
    world->run_for(2s);
    EXPECT_TRUE(goes());
    EXPECT_EQ(events("fail_safe"), 0);
}

TEST_P(CommandLaws, AMotionToATargetGoesOnUnlessTheSiteSaysOtherwise) {
    begin_with();
    enable(cia402::mode_profile_position);
    ASSERT_TRUE(good(set_point(begin + 4000)));
    world->engine.on_client_lost(plc, modbus::loss_closed, world->now);
    world->run_for(8s);
    EXPECT_EQ(now().position, begin + 4000) << "a client may connect for each of its requests";
    EXPECT_EQ(events("fail_safe"), 0);
}

TEST_P(CommandLaws, WhatTheSiteNamesHoldsForEveryMotion) {
    for (const auto action : {FailSafeAction::halt, FailSafeAction::quick_stop, FailSafeAction::disable}) {
        SCOPED_TRACE(name_of(action));
        FailSafe f;
        f.of(modbus::loss_closed) = action;
        begin_with(f);
        enable(cia402::mode_profile_position);
        ASSERT_TRUE(good(set_point(begin + 40000)));
        ASSERT_TRUE(world->run_until_true([&] { return goes(); }, 2s));
        world->run_for(500ms);
        world->engine.on_client_lost(plc, modbus::loss_closed, world->now);
        ASSERT_TRUE(world->run_until_true([&] { return !goes(); }, 5s));
        world->run_for(1s);
        EXPECT_LT(now().position, begin + 30000);
        const auto wanted = action == FailSafeAction::halt         ? PowerState::operation_enabled
                            : action == FailSafeAction::quick_stop ? PowerState::quick_stop_active
                                                                   : PowerState::switch_on_disabled;
        EXPECT_EQ(power_state_of(now().statusword), wanted);
        const Result* off = world->wait(world->command(a1, Disable{}, true), 5s);
        ASSERT_TRUE(off && good(*off));
    }
}

TEST_P(CommandLaws, TheActualPositionIsTheFirstTargetUnlessItsOwnClientWroteOne) {
    begin_with();
    ProcessData d;
    d.mode = cia402::mode_profile_position;
    d.profile_velocity = 2000;
    d.target_position = static_cast<std::int32_t>(begin + 3000);
    ASSERT_TRUE(good(answer(modbus(d))));
    enable_by_words();
    EXPECT_EQ(now().target_position, begin + 3000);
    world->run_for(2s);
    EXPECT_EQ(now().position, begin) << "nothing moves because it was enabled";
    ASSERT_TRUE(good(word(0x1F)));
    world->run_for(6s);
    EXPECT_EQ(now().position, begin + 3000);
}

TEST_P(CommandLaws, AnAxisWhoseLineIsBrokenIsNotShownAsMoving) {
    site = world->apply(world->make_site(e, e.cable(), 1, "device"));
    a1 = site->axis_ids.at(0);
    world->plug_in("line", site->drive_ids.at(0), e, addresses(e, 1).at(0), e.kind());
    ASSERT_TRUE(world->run_until_true([&] { return online(a1); }, 20s));
    world->run_for(1s);
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    world->cables.at("line")->cut(world->now);
    world->run_for(100ms);
    EXPECT_FALSE(goes()) << "nobody knows what it does";
    EXPECT_EQ(now().flags & flag_online, 0);
    EXPECT_NE(now().flags & flag_stale, 0);
}

TEST_P(CommandLaws, AConnectedClientThatIsSilentDoesNotLeaveTheAxisTurning) {
    begin_with();
    enable(cia402::mode_profile_velocity);
    if (!turns(2000)) return;
    world->received_at = world->now;
    for (int i = 0; i < 20; ++i) {
        world->run_for(500ms);
        world->received_at = world->now;
    }
    ASSERT_TRUE(goes()) << "it asks, and so it is there";
    world->run_for(4900ms);
    EXPECT_TRUE(goes());
    ASSERT_TRUE(world->run_until_true([&] { return !goes(); }, 2s));
    EXPECT_EQ(now().fail_safe_cause, 2);
    EXPECT_EQ(events("fail_safe"), 1);
}

INSTANTIATE_TEST_SUITE_P(Families, CommandLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
