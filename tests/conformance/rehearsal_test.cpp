// Conformance, rehearsal: every family on every wire, every cause and action: each cell of the report has its figures, and they fit what
// was chosen. In: all_families(). Out: laws over RehearsalCell. Never names a family.
#include "gateway/engine/rehearsal.hpp"
#include "gateway/site/ways_in.hpp"

#include <gtest/gtest.h>

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
    RehearsalCell play(LossCause cause, std::optional<FailSafeAction> action) {
        RehearsalWish w;
        w.axis = "a1";
        w.cause = cause;
        w.lease = 2s;
        return rehearse(families(), site_with(cause, action), {}, w);
    }
};

TEST_P(Rehearsals, EachCellHasItsFigures) {
    for (const LossCause cause : loss_causes) {
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
                                   : cause == LossCause::modbus_silent     ? 300
                                   : cause == LossCause::line_lost         ? 2000
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
            EXPECT_LE(*cell.noticed_ms, wait_ms + 2500);
            ASSERT_TRUE(cell.reaction_ms);
            EXPECT_LE(*cell.reaction_ms, *cell.standstill_ms);
            EXPECT_LE(*cell.standstill_ms - *cell.noticed_ms, 3000);
        }
    }
}

/// The doors' own descriptors: a new way in is rehearsed here the day it is in the table.
TEST_P(Rehearsals, WhatWasBegunByAnyWayInIsEndedByALossOfIt) {
    int rehearsed = 0;
    for (const auto& door : ways_of_all_doors) {
        for (const WayIn& way : door) {
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
    const RehearsalCell a = play(LossCause::modbus_closed, FailSafeAction::halt), b = play(LossCause::modbus_closed, FailSafeAction::halt);
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
