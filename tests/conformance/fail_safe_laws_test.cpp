// The matrix of loss of command: each cause and action, for each family and wire. The site's action is carried out at once and once, the
// axis shows the cause, and without a choice of the site a motion without an end is ended. Judged by the axis' picture and the twin's
// mechanics.
#include <gtest/gtest.h>

#include "gateway/doors/enip/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class FailSafeLaws : public Laws {
protected:
    static constexpr Duration watchdog = 400ms, lease = 3s, bound = 6s;
    const AuthorityClient plc{modbus::clients, "192.0.2.7"};
    std::uint64_t next_ticket = 1;

    void begin_with(LossCause cause, std::optional<FailSafeAction> action) {
        world = fresh();
        const bool behind = cause == LossCause::line_lost;
        Site s = behind ? world->make_site(e, e.cable(), 1, "device") : world->twins(e);
        s.axes.at(0).fail_safe.of(cause) = action;
        s.axes.at(0).fail_safe.watchdog_ms = cause == modbus::loss_silent ? 400 : 0;
        if (cause == LossCause::lease_ended) s.axes.at(0).authority_mode = AuthorityMode::lease;
        world->engine.set_lease(lease);
        if (!behind) return start(std::move(s));
        site = world->apply(std::move(s));
        a1 = site->axis_ids.at(0);
        d1 = site->drive_ids.at(0);
        world->plug_in("line", d1, e, addresses(e, 1).at(0), e.kind());
        ASSERT_TRUE(world->run_until_true([&] { return online(a1); }, 20s));
        world->run_for(1s);
    }
    const Result* tell(CommandBody body) {
        Command c;
        c.ticket = make_ticket(1, next_ticket++);
        c.axis = a1;
        c.body = std::move(body);
        c.origin.door = modbus::clients;
        c.origin.who = std::make_shared<const std::string>("192.0.2.7:50000");
        const Ticket t = c.ticket;
        world->engine.on_command(std::move(c), world->now);
        world->received_at = world->now;
        return world->wait(t, 5s);
    }
    /// By the PLC: a velocity move if the drive has one, otherwise a long way. Returns false if it has none and `endless` is required.
    [[nodiscard]] bool set_off(bool endless) {
        const Result* on = tell(Enable{});
        EXPECT_TRUE(on && good(*on)) << published(on);
        EXPECT_TRUE(world->run_until_true([&] { return power_state_of(now().statusword) == PowerState::operation_enabled; }, 5s));
        Move m = endless ? move_to(4000, Move::Kind::velocity) : move_to(400'000, Move::Kind::relative);
        const Result* r = tell(m);
        if (endless && r && r->reason == Reason::not_supported) {
            lacks_velocity(*r);
            return false;
        }
        EXPECT_TRUE(r && good(*r)) << published(r);
        EXPECT_TRUE(world->run_until_true([&] { return moving(a1); }, 5s));
        return true;
    }
    /// Causes the loss; returns when the axis has been informed at the latest.
    void lose(LossCause cause) {
        switch (cause) {
            case modbus::loss_silent:
                world->received_at = world->now;
                return world->run_for(watchdog + 100ms);
            case LossCause::lease_ended:
                return world->run_for(lease + 100ms);
            case LossCause::line_lost:
                world->cables.at("line")->cut(world->now);
                world->run_for(300ms);
                world->cables.at("line")->heal(world->now);
                EXPECT_TRUE(world->run_until_true([&] { return online(a1); }, 30s)) << "the line does not heal";
                return;
            case LossCause::gateway_ends:
                return world->engine.shut_down(world->now);
            default:
                world->engine.on_client_lost(plc, cause, world->now);
        }
    }
    /// The axis stands, and this is not only shown by its status word.
    void at_rest() {
        world->run_for(500ms);
        const auto place = now().position;
        world->run_for(500ms);
        EXPECT_EQ(now().position, place);
    }
    [[nodiscard]] bool rests() {
        return world->run_until_true([&] { return !moving(a1) && online(a1); }, bound);
    }
};

TEST_P(FailSafeLaws, WhatTheSiteNamesHappensForEachCause) {
    for (const LossCause cause : loss_causes()) {
        if (cause == LossCause::set_points_silent) continue;  // StreamLaws: it needs a stream
        for (const FailSafeAction action : fail_safe_actions) {
            SCOPED_TRACE(std::string(name_of(cause)) + " " + std::string(name_of(action)));
            begin_with(cause, action);
            ASSERT_TRUE(set_off(false));
            lose(cause);
            if (action == FailSafeAction::nothing) {
                world->run_for(500ms);
                EXPECT_TRUE(moving(a1)) << "it goes on";
                EXPECT_EQ(now().fail_safe_cause, 0);
                EXPECT_EQ(events("fail_safe"), 0);
                continue;
            }
            ASSERT_TRUE(rests());
            EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(cause));
            EXPECT_EQ(world->engine.losses(cause), 1u);
            EXPECT_EQ(events("fail_safe"), 1);

            at_rest();
            if (cause == LossCause::line_lost) continue;  // whether a drive that was absent counts as lost depends on its family
            const auto wanted = action == FailSafeAction::halt         ? PowerState::operation_enabled
                                : action == FailSafeAction::quick_stop ? PowerState::quick_stop_active
                                                                       : PowerState::switch_on_disabled;
            EXPECT_EQ(power_state_of(now().statusword), wanted);
        }
    }
}

TEST_P(FailSafeLaws, WithoutAChoiceAMotionWithoutAnEndIsEnded) {
    for (const LossCause cause : loss_causes()) {
        if (cause == LossCause::set_points_silent) continue;
        SCOPED_TRACE(name_of(cause));
        begin_with(cause, std::nullopt);
        if (!set_off(true)) return;
        lose(cause);
        ASSERT_TRUE(rests());
        EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(cause));
        at_rest();
        if (cause == LossCause::line_lost) continue;
        EXPECT_EQ(power_state_of(now().statusword), cause == LossCause::gateway_ends || cause == LossCause::motion_unowned
                                                        ? PowerState::quick_stop_active
                                                        : PowerState::operation_enabled);
    }
}

TEST_P(FailSafeLaws, WithoutAChoiceAMotionToATargetGoesOnUnlessTheGatewayEnds) {
    for (const LossCause cause : loss_causes()) {
        if (cause == LossCause::set_points_silent) continue;
        SCOPED_TRACE(name_of(cause));
        begin_with(cause, std::nullopt);
        ASSERT_TRUE(set_off(false));
        lose(cause);
        world->run_for(2s);
        EXPECT_EQ(moving(a1), cause != LossCause::gateway_ends);
        EXPECT_EQ(now().fail_safe_cause != 0, cause == LossCause::gateway_ends);
    }
}

TEST_P(FailSafeLaws, AnEnabledAxisAtRestIsSwitchedOffWhereTheSiteSaysDisable) {
    for (const LossCause cause : loss_causes()) {
        if (cause == LossCause::set_points_silent) continue;
        SCOPED_TRACE(name_of(cause));
        begin_with(cause, FailSafeAction::disable);
        const Result* on = tell(Enable{});
        ASSERT_TRUE(on && good(*on)) << published(on);
        ASSERT_TRUE(world->run_until_true([&] { return power_state_of(now().statusword) == PowerState::operation_enabled; }, 5s));
        lose(cause);
        EXPECT_TRUE(world->run_until_true([&] { return power_state_of(now().statusword) == PowerState::switch_on_disabled; }, bound));
        EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(cause));
    }
}

/// A scanner goes into program mode, and its connection ends before the axis has come to rest on its gentle ramp.
TEST_P(FailSafeLaws, ALossBehindAnotherIsAsSharpAsIfItWereTheFirst) {
    world = fresh();
    Site s = world->twins(e);
    s.axes.at(0).fail_safe.of(enip::loss_idle) = FailSafeAction::halt;
    s.axes.at(0).fail_safe.of(enip::loss_timed_out) = FailSafeAction::quick_stop;
    start(std::move(s));
    const Result* on = tell(Enable{});
    ASSERT_TRUE(on && good(*on)) << published(on);
    Move m = move_to(4000, Move::Kind::velocity);
    m.acceleration = m.deceleration = 1000;
    const Result* r = tell(m);
    if (r && r->reason == Reason::not_supported) return lacks_velocity(*r);
    ASSERT_TRUE(r && good(*r)) << published(r);
    ASSERT_TRUE(world->run_until_true([&] { return speed(a1) > 3000; }, 20s));
    lose(enip::loss_idle);
    world->run_for(300ms);
    ASSERT_GT(speed(a1), 1000) << "its ramp takes four seconds";
    lose(enip::loss_idle);
    EXPECT_EQ(events("fail_safe"), 1) << "the same again is nothing new";
    lose(enip::loss_timed_out);
    ASSERT_TRUE(world->run_until_true([&] { return power_state_of(now().statusword) == PowerState::quick_stop_active; }, 1s));
    EXPECT_EQ(events("fail_safe"), 2);
    EXPECT_EQ(now().fail_safe_cause, static_cast<std::uint16_t>(enip::loss_timed_out));
    ASSERT_TRUE(rests());
}

TEST_P(FailSafeLaws, ADriveThatHasAWatchdogHasItProgrammedAndStopsWhenItDoesNotHearTheGateway) {
    if (!e.catalogue->document().at("drive_watchdog").at("available").as_bool()) {
        begin_with(LossCause::line_lost, FailSafeAction::nothing);
        EXPECT_EQ(world->engine.drive_status(d1).watchdog.state, DriveWatchdog::State::unknown) << "what its family has not is not shown";
        return;
    }
    begin_with(LossCause::line_lost, FailSafeAction::nothing);
    const auto watchdog = world->engine.drive_status(d1).watchdog;
    ASSERT_EQ(watchdog.state, DriveWatchdog::State::armed);
    ASSERT_GT(watchdog.time, 0ms);
    if (!set_off(true)) ASSERT_TRUE(set_off(false));
    world->run_for(3 * watchdog.time);
    ASSERT_TRUE(moving(a1)) << "while it hears the gateway it goes on";
    const auto& cable = world->cables.at("line");
    cable->cut(world->now);
    world->run_for(watchdog.time + 2s);
    cable->heal(world->now);
    ASSERT_TRUE(world->run_until_true([&] { return online(a1); }, 30s));
    world->run_for(500ms);
    EXPECT_FALSE(moving(a1)) << "it has stopped, and the line's return starts nothing";
    at_rest();
    ASSERT_EQ(world->engine.drive_status(d1).watchdog, watchdog) << "and it is armed again";
    const Result* on = tell(Enable{});
    ASSERT_TRUE(on && good(*on)) << published(on);
}

TEST_P(FailSafeLaws, ALeaseThatAnotherClientLetsExpireIsNothingToTheMotion) {
    begin_with(LossCause::lease_ended, FailSafeAction::quick_stop);
    ASSERT_TRUE(set_off(false));
    HoldAxis give;
    give.kind = HoldAxis::Kind::release;
    const Result* r = tell(give);
    ASSERT_TRUE(r && good(*r)) << published(r);
    HoldAxis take;
    take.lease_s = 1;
    r = ask(a1, take);
    ASSERT_TRUE(r && good(*r)) << published(r);
    world->run_for(2s);
    EXPECT_EQ(now().fail_safe_cause, 0);
    EXPECT_TRUE(moving(a1));
}

INSTANTIATE_TEST_SUITE_P(Families, FailSafeLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
