// Laws of the site's limits of position, for every family: they apply to velocity moves, too, by command and by registers.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class LimitLaws : public Laws {
protected:
    World& w = *world;
    static constexpr std::int64_t limit = 10'000;  // 100 units of 100 increments

    void begin() {
        Site wanted = w.twins(e);
        wanted.axes[0].position_min = -100;
        wanted.axes[0].position_max = 100;
        start(std::move(wanted));
        order(a1, Enable{});
    }
    const Result* jog(std::int64_t velocity) { return ask(a1, move_to(velocity, Move::Kind::velocity), false); }
    /// Writes registers and returns the answer.
    Result write(auto&& fill) {
        ProcessData d;
        fill(d);
        const Result* r = w.wait(w.command(a1, d), 10s);
        return r ? *r : Result{};
    }
    Result word(int cw) {
        return write([&](ProcessData& d) { d.controlword = static_cast<std::uint16_t>(cw); });
    }
    /// For a drive without a velocity mode: it says so, and a positioning beyond the limit is refused, so that nothing leads out of it.
    void no_velocity_leads_nowhere(const Result& refusal) {
        EXPECT_EQ(refusal.reason, Reason::not_supported);
        lacks_velocity(refusal);
        for (const std::int64_t target : {limit + 100, -limit - 100}) {
            const Result* r = ask(a1, move_to(target));
            ASSERT_TRUE(r);
            EXPECT_EQ(r->reason, Reason::out_of_range) << published(r);
        }
        w.run_for(2s);
        EXPECT_EQ(speed(a1), 0);
        EXPECT_EQ(now().position, 0);
    }
    /// It comes to rest at the limit: not further beyond than one late feedback explains, and not far before it.
    void rests_at(std::int64_t place) {
        ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) == 0; }, 30s));
        w.run_for(500ms);
        EXPECT_LE(std::llabs(now().position - place), 1'500) << "at " << now().position;
        EXPECT_LE(std::llabs(now().position), limit + 300) << "beyond its limit, at " << now().position;
        EXPECT_NE(now().statusword & cia402::sw_internal_limit, 0);
        EXPECT_EQ(limit_events(Severity::warning), 1);
        EXPECT_EQ(limit_events(Severity::alarm), 0) << "the guard was early enough";
        w.events.clear();
    }
    [[nodiscard]] std::ptrdiff_t limit_events(Severity severity) const {
        return std::ranges::count_if(w.events, [&](const Event& v) { return v.kind == "limit" && v.severity == severity; });
    }
    /// The axis moves outwards at 4000, and the limit changes.
    [[nodiscard]] bool runs_when_the_limit_moves(std::int64_t ramp, std::int64_t ahead) {
        Move m = move_to(4'000, Move::Kind::velocity);
        m.acceleration = m.deceleration = ramp;  // some drives have one ramp for both
        const Result* r = ask(a1, m, false);
        if (r && r->reason == Reason::not_supported) {
            lacks_velocity(*r);
            return false;
        }
        EXPECT_TRUE(r && good(*r)) << published(r);
        EXPECT_TRUE(w.run_until_true([&] { return now().position > 2'500 && now().velocity > 3'800; }, 5s));
        Site narrower = site->site;
        narrower.axes[0].position_max = static_cast<double>(now().position + ahead) / narrower.axes[0].increments_per_unit;
        w.events.clear();
        site = w.apply(std::move(narrower));
        return true;
    }
};

TEST_P(LimitLaws, AVelocityMoveIsHaltedAtTheLimitAndMayOnlyGoBack) {
    begin();
    for (const std::int64_t direction : {1, -1}) {
        const Result* r = jog(direction * 5'000);
        ASSERT_TRUE(r);
        if (r->reason == Reason::not_supported) return no_velocity_leads_nowhere(*r);
        ASSERT_TRUE(good(*r)) << r->text;
        ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) != 0; }, 5s));
        rests_at(direction * limit);
        const Move out = move_to(direction * limit);
        r = w.wait(w.command(a1, out, true), 30s);  // back by a positioning, whatever it did before
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
        EXPECT_EQ(now().statusword & cia402::sw_internal_limit, 0) << "another motion has begun and ended since";
        r = jog(direction * 5'000);
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::refused) << "outwards";
        EXPECT_EQ(r->reason, Reason::out_of_range);
        EXPECT_NE(r->text.find(direction > 0 ? "position_max" : "position_min"), std::string::npos) << r->text;
    }
}

TEST_P(LimitLaws, AVelocityMoveThatIsBeyondALimitIsStoppedQuicklyWithAnAlarm) {
    begin();
    if (!runs_when_the_limit_moves(20'000, -500)) return;
    ASSERT_TRUE(w.run_until_true([&] { return power_state_of(now().statusword) == PowerState::quick_stop_active; }, 2s));
    ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) == 0; }, 5s));
    EXPECT_EQ(limit_events(Severity::alarm), 1);
    EXPECT_EQ(limit_events(Severity::warning), 0) << "no halt: it has no room for that";
    EXPECT_EQ(now().stop_latch, 0b11);
    EXPECT_NE(now().statusword & cia402::sw_internal_limit, 0);
    w.run_for(1s);
    EXPECT_EQ(speed(a1), 0);
}

/// Its own ramp needs 4000, and there are 1000 left.
TEST_P(LimitLaws, AVelocityMoveWithNoRoomLeftOnItsRampIsStoppedQuicklyWithAnAlarm) {
    begin();
    if (!runs_when_the_limit_moves(2'000, 1'000)) return;
    ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) == 0; }, 15s));
    EXPECT_EQ(limit_events(Severity::alarm), 1);
    EXPECT_EQ(limit_events(Severity::warning), 0);
    EXPECT_EQ(power_state_of(now().statusword), PowerState::quick_stop_active);
}

TEST_P(LimitLaws, ARampThatIsTheDrivesOwnIsReckonedWith) {
    // The move names no deceleration: the drive brakes with that of the previous move.
    begin();
    Move gentle = move_to(1'000);
    gentle.acceleration = gentle.deceleration = 4'000;
    const Result* r = w.wait(w.command(a1, gentle, true), 30s);
    ASSERT_TRUE(r && good(*r)) << published(r);
    Move m = move_to(5'000, Move::Kind::velocity);
    m.acceleration.reset();
    m.deceleration.reset();
    r = ask(a1, m, false);
    ASSERT_TRUE(r);
    if (r->reason == Reason::not_supported) return lacks_velocity(*r);
    ASSERT_TRUE(good(*r)) << r->text;
    ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) != 0; }, 5s));
    ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) == 0; }, 30s));
    EXPECT_LE(now().position, limit + 300);
}

TEST_P(LimitLaws, RegistersDoNotLeadOutEither) {
    begin();
    (void)write([](ProcessData& d) {
        d.mode = cia402::mode_profile_velocity;
        d.profile_acceleration = d.profile_deceleration = 20'000;
    });
    for (const int cw : {0x06, 0x07, 0x0F})
        (void)word(cw);
    const Result go = write([](ProcessData& d) { d.target_velocity = -5'000; });
    if (go.reason == Reason::not_supported) return no_velocity_leads_nowhere(go);
    ASSERT_TRUE(good(go)) << go.text;
    ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) != 0; }, 5s));
    rests_at(-limit);
}

/// The target alone is within the limits; with the control word it is not.
TEST_P(LimitLaws, ASetPointOfWordsIsLookedAtAsWhatItIs) {
    begin();
    order(a1, move_to(limit * 4 / 5));
    (void)write([](ProcessData& d) {
        d.mode = cia402::mode_profile_position;
        d.profile_velocity = 5'000;
        d.profile_acceleration = d.profile_deceleration = 20'000;
    });
    for (const int cw : {0x06, 0x07, 0x0F})
        ASSERT_TRUE(good(word(cw)));
    const Result target = write([&](ProcessData& d) { d.target_position = limit / 2; });
    ASSERT_TRUE(good(target)) << target.text;
    const Result relative = word(0x5F);
    EXPECT_EQ(relative.outcome, Outcome::refused) << relative.text;
    EXPECT_EQ(relative.reason, Reason::out_of_range) << relative.text;
    EXPECT_NE(relative.text.find("position_max"), std::string::npos) << relative.text;
    w.run_for(1s);
    EXPECT_EQ(speed(a1), 0);
    EXPECT_EQ(now().position, limit * 4 / 5);
    ASSERT_TRUE(good(word(0x0F)));
    const Result absolute = word(0x1F);
    ASSERT_TRUE(good(absolute)) << absolute.text;
    ASSERT_TRUE(w.run_until_true([&] { return now().position == limit / 2; }, 30s));
}

/// The page's drive_limits are what is shown of the drive: written and acknowledged if the site limits the axis.
TEST_P(LimitLaws, ADriveThatKeepsLimitsByItselfHasThoseOfTheSite) {
    const bool available = e.catalogue->document().at("drive_limits").at("available").as_bool();
    begin();
    const auto state = [&] { return w.engine.drive_status(d1).limits.state; };
    EXPECT_EQ(state(), available ? DriveLimits::State::armed : DriveLimits::State::unknown) << w.engine.drive_status(d1).limits.text;
    Site open = site->site;
    open.axes[0].position_min = open.axes[0].position_max = std::nullopt;
    site = w.apply(std::move(open));
    EXPECT_TRUE(w.run_until_true([&] { return state() == DriveLimits::State::unknown; }, 10s)) << "the site gives none any more";
}

/// The gateway that gave a velocity move is gone; the next one knows no order, and finds the axis in motion.
class FoundLaws : public LimitLaws {
protected:
    /// The next gateway, as soon as the drive has reported; null if the drive has no velocity move, or ends it by itself.
    std::unique_ptr<World> found(FailSafeAction rule) {
        Site wanted = w.make_site(e, e.cable(), 1, "device");
        wanted.axes[0].position_min = -100;
        wanted.axes[0].position_max = 100;
        if (rule == FailSafeAction::nothing) wanted.axes[0].fail_safe.of(LossCause::motion_unowned) = rule;
        site = w.apply(wanted);
        a1 = site->axis_ids.at(0);
        w.plug_in("line", DriveId{0}, e, addresses(e, 1)[0], e.kind());
        EXPECT_TRUE(w.run_until_true([&] { return online(a1); }, 20s));
        w.run_for(1s);
        order(a1, Enable{});
        const Result* r = jog(-1'000);
        EXPECT_TRUE(r);
        if (r->reason == Reason::not_supported) {
            lacks_velocity(*r);
            return nullptr;
        }
        EXPECT_TRUE(good(*r)) << r->text;
        EXPECT_TRUE(w.run_until_true([&] { return now().position < -500; }, 5s));
        auto next = std::make_unique<World>(2, w.plant);
        next->now = w.now + 300ms;
        site = next->apply(wanted);
        EXPECT_TRUE(next->run_until_true([&] { return (next->picture(a1).flags & flag_online) != 0; }, 8s));
        EXPECT_NE(next->picture(a1).flags & flag_moving, 0);
        if (e.catalogue->document().at("drive_watchdog").as_object().contains("stops_velocity_moves")) return nullptr;
        return next;
    }
    static std::ptrdiff_t alarms(const World& next, std::string_view kind) {
        return std::ranges::count_if(next.events, [&](const Event& v) { return v.kind == kind && v.severity == Severity::alarm; });
    }
    static std::ptrdiff_t events_of(const World& next, std::string_view kind) {
        return std::ranges::count_if(next.events, [&](const Event& v) { return v.kind == kind; });
    }
    static bool rests(World& next, AxisId axis) {
        return next.run_until_true([&] { return (next.picture(axis).flags & flag_moving) == 0; }, 15s);
    }
};

TEST_P(FoundLaws, AMotionThatNobodyOwnsIsStoppedAndTold) {
    const auto next = found(FailSafeAction::quick_stop);
    if (!next) return;
    const std::int64_t place = next->picture(a1).position;
    ASSERT_TRUE(rests(*next, a1)) << "it goes on at " << next->picture(a1).position;
    EXPECT_LE(std::llabs(next->picture(a1).position - place), 3'000) << "at once, and not at its limit";
    EXPECT_EQ(alarms(*next, "fail_safe"), 1);
    EXPECT_EQ(next->picture(a1).fail_safe_cause, static_cast<std::uint16_t>(LossCause::motion_unowned));
    next->run_for(2s);
    EXPECT_EQ(next->picture(a1).flags & flag_moving, 0);
}

TEST_P(FoundLaws, WhereTheSiteLetsItGoOnItIsStoppedAtTheLimit) {
    const auto next = found(FailSafeAction::nothing);
    if (!next) return;
    const bool enabled = power_state_of(next->picture(a1).statusword) == PowerState::operation_enabled;
    ASSERT_TRUE(rests(*next, a1)) << "it goes on at " << next->picture(a1).position;
    next->run_for(500ms);
    EXPECT_LE(std::llabs(next->picture(a1).position), limit + 300);
    if (!enabled) {  // the drive reports no power, and moves: this is a contradiction, whatever action the site selects
        EXPECT_EQ(alarms(*next, "state"), 1);
        return;
    }
    EXPECT_GE(std::llabs(next->picture(a1).position), limit - 1'500) << "found is not stopped: it goes on to the limit";
    EXPECT_EQ(alarms(*next, "limit"), 1);
    EXPECT_EQ(events_of(*next, "motion"), 1) << "and it is told that it moves";
}

/// Each order that would lead beyond the limit is refused with it, at rest and in motion, from every client; and the shaft never goes
/// there.
TEST_P(LimitLaws, NoWayInLeadsOut) {
    begin();
    double farthest = 0;
    const auto refused = [&](const CommandBody& body, const std::string& what) {
        SCOPED_TRACE(what);
        const Result* r = ask(a1, body, false);
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::refused) << published(r);
        EXPECT_EQ(r->reason, Reason::out_of_range) << published(r);
        EXPECT_NE(r->text.find("position_m"), std::string::npos) << r->text;
    };
    const auto pass = [&](Duration d) {
        for (const Instant end = w.now + d; w.now < end;) {
            w.run_for(10ms);
            farthest = std::max(farthest, std::fabs(mechanics(a1).position));
        }
    };
    const auto all_ways = [&](const char* when) {
        for (const std::int64_t way : {1, -1}) {
            const std::string at = std::string(when) + (way > 0 ? ", up" : ", down");
            refused(move_to(way * (limit + 1)), at + ", absolute");
            refused(move_to(way * (2 * limit + 1), Move::Kind::relative), at + ", relative");
            Move later = move_to(way * (limit + 1));
            later.prepare_only = true;
            refused(later, at + ", prepared");
        }
    };
    all_ways("at rest");
    order(a1, move_to(limit - 2000), false);
    ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) != 0; }, 5s));
    all_ways("on the way");
    // Some drives count a distance from their target.
    refused(move_to(2500, Move::Kind::relative), "on the way, relative to its target");
    pass(8s);
    EXPECT_EQ(now().position, limit - 2000);
    // A prepared move is checked again when it begins, because the limits may have become narrower.
    Move far = move_to(limit - 100);
    far.prepare_only = true;
    const Result* r = ask(a1, far, false);
    ASSERT_TRUE(r);
    if (good(*r)) {
        Site narrower = site->site;
        narrower.axes[0].position_max = static_cast<double>(limit - 1000) / narrower.axes[0].increments_per_unit;
        site = w.apply(std::move(narrower));
        StartTogether go;
        go.axes = {a1};
        refused(go, "a group start");
    } else {
        EXPECT_EQ(r->reason, Reason::not_supported) << published(r);
    }
    // A held move leads no further than others.
    order(a1, move_to(0));
    Move held = move_to(4000, Move::Kind::velocity);
    held.hold_ms = 60'000;
    r = ask(a1, held, false);
    ASSERT_TRUE(r);
    const bool holds = r->reason != Reason::not_supported;
    if (holds) {
        ASSERT_TRUE(good(*r)) << published(r);
    } else {
        lacks_velocity(*r);
    }
    EXPECT_LE(farthest, limit + 300) << "the shaft has been beyond";
    farthest = 0;
    pass(5s);
    EXPECT_EQ(farthest > limit / 2, holds) << "it has been on its way to the limit, at most at " << farthest;
    EXPECT_EQ(speed(a1), 0);
    EXPECT_LE(farthest, limit + 300) << "the shaft has been beyond";
}

INSTANTIATE_TEST_SUITE_P(Families, LimitLaws, testing::ValuesIn(law_subjects()), name_of_subject);
INSTANTIATE_TEST_SUITE_P(Families, FoundLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
