// Laws of the rehearsal, for every family, wire, cause and action: each cell of the report has its figures, and they agree with the
// selected action.
#include "gateway/engine/rehearsal.hpp"
#include "gateway/site/ways_in.hpp"

#include <gtest/gtest.h>

#include "gateway/doors/dds/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class Rehearsals : public Laws {
protected:
    Site site_with(LossCause cause, std::optional<FailSafeAction> action) {
        Site s = world->twins(e, 2);
        for (AxisSpec& a : s.axes) {
            if (cause != LossCause::none) a.fail_safe.of(cause) = action;
            a.fail_safe.watchdog_ms = 300;
        }
        return s;
    }
    RehearsalCell play(LossCause cause, std::optional<FailSafeAction> action, RehearsalSteps steps = {}) {
        RehearsalWish w;
        w.axis = "a1";
        w.cause = cause;
        w.steps = steps;
        w.lease = 2s;
        return rehearse(families(), site_with(cause, action), {}, w);
    }
    /// The gateway is killed, and another one starts after `away`.
    RehearsalCell restart(Duration away, std::optional<FailSafeAction> action) {
        RehearsalWish w;
        w.axis = "a1";
        w.cause = LossCause::none;
        w.restart = true;
        w.steps = RehearsalSteps::all();
        w.gateway_away = away;
        return rehearse(families(), site_with(LossCause::motion_unowned, action), {}, w);
    }
    /// The other gateway ends a velocity move that is not renewed, before its drive can be reached again.
    [[nodiscard]] bool ends_by_itself_before(LossCause cause) const {
        return cause == LossCause::line_lost && e.catalogue->document().at("drive_watchdog").as_object().contains("stops_velocity_moves");
    }
    [[nodiscard]] bool streams() const { return e.catalogue->offers_mode(8) || e.catalogue->offers_mode(9); }
    /// Clients over HTTP or DDS write no registers, so they have no old image.
    [[nodiscard]] static bool has_image(LossCause cause) {
        return cause != LossCause::lease_ended && cause != LossCause::set_points_silent && cause != dds::loss_deadline;
    }
};

TEST_P(Rehearsals, EachCellHasItsFigures) {
    for (const LossCause cause : loss_causes()) {
        std::vector<std::optional<FailSafeAction>> choices{std::nullopt};
        choices.insert(choices.end(), fail_safe_actions.begin(), fail_safe_actions.end());
        for (const auto& choice : choices) {
            SCOPED_TRACE(std::string(name_of(cause)) + " " + (choice ? std::string(name_of(*choice)) : "by default"));
            const RehearsalCell cell = play(cause, choice);
            if (cause == LossCause::set_points_silent && !e.catalogue->offers_mode(8) && !e.catalogue->offers_mode(9)) {
                EXPECT_NE(cell.fault.find("does not follow"), std::string::npos) << cell.fault;
                continue;
            }
            ASSERT_EQ(cell.fault, "");
            EXPECT_GT(cell.speed, 0);
            EXPECT_GE(cell.travel, 0);
            const double wait_ms = cause == LossCause::lease_ended         ? 2000
                                   : cause == modbus::loss_silent          ? 300
                                   : cause == LossCause::line_lost         ? 2000
                                   : cause == LossCause::motion_unowned    ? 300
                                   : cause == LossCause::set_points_silent ? 500
                                                                           : 0;
            if (choice == FailSafeAction::nothing) {
                EXPECT_FALSE(cell.noticed_ms) << "nobody acts";
                EXPECT_EQ(cell.taken, FailSafeAction::nothing);
                EXPECT_TRUE(cell.standstill_ms || cell.watched_ms >= 15000);
                continue;
            }
            const bool goes_on = !choice && cell.motion == "position" && cause != LossCause::gateway_ends;
            ASSERT_EQ(cell.noticed_ms.has_value(), !goes_on) << "by default a motion to a target goes on";
            if (goes_on) continue;
            ASSERT_TRUE(cell.standstill_ms);
            EXPECT_GE(*cell.noticed_ms, wait_ms - 1);
            EXPECT_LE(*cell.noticed_ms, wait_ms + (cause == LossCause::motion_unowned ? 8000 : 2500)) << "a gateway has to start for it";
            EXPECT_EQ(cell.ended_by, ends_by_itself_before(cause) ? "drive" : name_of(cause));
            EXPECT_FALSE(cell.moved_again) << "nobody has asked for it";
            ASSERT_TRUE(cell.reaction_ms);
            EXPECT_LE(*cell.reaction_ms, *cell.standstill_ms);
            EXPECT_LE(*cell.standstill_ms - *cell.noticed_ms, 3000);
        }
    }
}

/// From the doors' own descriptors: a new way is rehearsed here as soon as it is in the table.
TEST_P(Rehearsals, WhatWasBegunByAnyWayInIsEndedByALossOfIt) {
    int rehearsed = 0;
    for (const DoorWords* door : known_doors()) {
        for (const WayIn& way : door->ways) {
            if (way.streams && !e.catalogue->offers_mode(8) && !e.catalogue->offers_mode(9)) continue;
            SCOPED_TRACE(way.name);
            ++rehearsed;
            bool ended = false;
            for (const LossCause cause : way.losses) {
                EXPECT_EQ(door_that_tells(cause), way.door);
                const RehearsalCell cell = play(cause, FailSafeAction::halt);
                EXPECT_EQ(cell.fault, "") << name_of(cause);
                ended = cell.taken == FailSafeAction::halt && cell.standstill_ms.has_value();
                if (ended) break;
            }
            EXPECT_TRUE(ended) << "nothing ends what was begun so";
        }
    }
    EXPECT_GE(rehearsed, 6);
}

/// Requests of other clients and refused commands do not change whose loss ends the motion, and the repeated words of the lost client begin
/// nothing.
TEST_P(Rehearsals, NothingThatComesBetweenChangesWhoseLossEndsTheMotion) {
    for (const LossCause cause : loss_causes()) {
        if (cause == LossCause::set_points_silent && !streams()) continue;
        for (const auto action : {FailSafeAction::halt, FailSafeAction::quick_stop, FailSafeAction::disable}) {
            SCOPED_TRACE(std::string(name_of(cause)) + " " + std::string(name_of(action)));
            const RehearsalCell cell = play(cause, action, RehearsalSteps::all());
            ASSERT_EQ(cell.fault, "");
            const bool by_itself = ends_by_itself_before(cause);
            EXPECT_EQ(cell.ended_by, by_itself ? "drive" : name_of(cause));
            EXPECT_EQ(cell.taken, by_itself && action != FailSafeAction::disable ? cell.taken : action);
            ASSERT_TRUE(cell.standstill_ms);
            EXPECT_EQ(cell.moved_again, has_image(cause) ? std::optional(false) : std::nullopt);
        }
    }
}

TEST_P(Rehearsals, AMotionToATargetThatGoesOnEndsThereAndNothingBeginsItAgain) {
    const RehearsalCell cell = play(modbus::loss_closed, FailSafeAction::nothing, RehearsalSteps::all());
    ASSERT_EQ(cell.fault, "");
    EXPECT_EQ(cell.motion, "position");
    EXPECT_FALSE(cell.noticed_ms);
    ASSERT_TRUE(cell.standstill_ms);
    EXPECT_EQ(cell.ended_by, "target");
    EXPECT_EQ(cell.moved_again, false);
}

TEST_P(Rehearsals, AGatewayThatIsStartedAgainEndsWhatItFindsUnlessTheDriveHasDoneSo) {
    const auto& says = e.catalogue->document().at("drive_watchdog").as_object();
    const bool by_itself = says.at("available").as_bool() || says.contains("stops_velocity_moves");
    for (const Duration away : {Duration(300ms), Duration(5s)}) {
        SCOPED_TRACE(milliseconds_of(away));
        const RehearsalCell cell = restart(away, FailSafeAction::quick_stop);
        ASSERT_EQ(cell.fault, "");
        EXPECT_EQ(situation_of(cell), "gateway_restarts");
        EXPECT_EQ(cell.chosen, FailSafeAction::quick_stop);
        ASSERT_TRUE(cell.standstill_ms);
        if (away > 3s) {
            EXPECT_EQ(cell.ended_by, by_itself ? "drive" : "motion_unowned");
        } else {
            EXPECT_TRUE(cell.ended_by == "motion_unowned" || (by_itself && cell.ended_by == "drive")) << cell.ended_by;
        }
        EXPECT_EQ(cell.noticed_ms.has_value(), cell.ended_by == "motion_unowned");
        EXPECT_EQ(cell.moved_again, false) << "its controller has written its image all the time";
    }
}

TEST_P(Rehearsals, WhenTheGatewayIsGoneADriveWithAWatchdogStopsByItselfAndAnyOtherGoesOn) {
    const auto& says = e.catalogue->document().at("drive_watchdog").as_object();
    EXPECT_GT(says.at("description").as_string().size(), 20u);
    const RehearsalCell cell = play(LossCause::none, std::nullopt);
    ASSERT_EQ(cell.fault, "");
    EXPECT_GT(cell.speed, 0);
    EXPECT_FALSE(cell.noticed_ms) << "there is nobody who could";
    EXPECT_EQ(cell.taken, FailSafeAction::nothing);
    if (says.contains("stops_velocity_moves") && cell.motion == "velocity") {
        ASSERT_TRUE(cell.reaction_ms && cell.standstill_ms) << "whoever stands behind the line ends a velocity move that nobody renews";
        EXPECT_LE(*cell.standstill_ms, 5000);
        return;
    }
    if (!says.at("available").as_bool()) {
        EXPECT_FALSE(cell.reaction_ms);
        EXPECT_FALSE(cell.standstill_ms);
        EXPECT_GE(cell.watched_ms, 15000);
        return;
    }
    ASSERT_TRUE(cell.reaction_ms && cell.standstill_ms);
    EXPECT_GE(*cell.reaction_ms, 900) << "as delivered: 1000 ms after the last heartbeat";
    EXPECT_LE(*cell.standstill_ms, 2500);
}

TEST_P(Rehearsals, TheSameSiteGivesTheSameFigures) {
    const RehearsalCell a = play(modbus::loss_closed, FailSafeAction::halt), b = play(modbus::loss_closed, FailSafeAction::halt);
    EXPECT_EQ(a.standstill_ms, b.standstill_ms);
    EXPECT_EQ(a.travel, b.travel);
    EXPECT_TRUE(a.standstill_ms);
}

TEST_P(Rehearsals, AnAxisThatIsNotThereIsSaid) {
    RehearsalWish w;
    w.axis = "nobody";
    EXPECT_EQ(rehearse(families(), site_with(w.cause, std::nullopt), {}, w).fault, "there is no such axis");
}

INSTANTIATE_TEST_SUITE_P(Families, Rehearsals, testing::ValuesIn(subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
