// The effect of an originator's renewed bytes: edges, values with their edge, streamed set-points, nothing at the start.
#include "gateway/doors/enip/output_lane.hpp"

#include <gtest/gtest.h>

namespace axisgate::enip {
namespace {

AxisPicture enabled_axis() {
    AxisPicture p;
    p.statusword = 0x0027;
    return p;
}
Wanted wanted(std::uint16_t word, std::int16_t mode = 1, std::int32_t target = 0) {
    Wanted w;
    w.controlword = word;
    w.mode = mode;
    w.target_position = target;
    return w;
}

TEST(EnipOutputLane, TheFirstImageIsHandedOnWholeThoughAllIsZero) {
    OutputLane lane;
    for (int i = 0; i < 2; ++i) {
        const auto step = lane.take({}, enabled_axis());
        ASSERT_TRUE(step.command);
        EXPECT_EQ(step.command->controlword, 0) << "whatever others have switched on";
        EXPECT_EQ(step.command->mode, std::int16_t{0});
        EXPECT_EQ(step.command->target_position, 0);
        EXPECT_EQ(step.command->profile_velocity, 0u);
        EXPECT_FALSE(step.command->target_velocity) << "a speed counts when it changes";
        EXPECT_FALSE(lane.take({}, enabled_axis()).command) << "renewed, not changed";
        lane.reset();
    }
    OutputLane speed_alone(has_target_velocity);
    EXPECT_FALSE(speed_alone.take({}, enabled_axis()).command) << "what it has not is never sent";
}

/// A controller that was running before its drive, and one whose drive was replaced by its twin: neither changes its image for that.
TEST(EnipOutputLane, AnotherDriveHasTheImageWholeAndIsNotMovedByIt) {
    OutputLane lane;
    AxisPicture axis;
    ASSERT_TRUE(lane.take(wanted(0x0F, 3), axis).command) << "nobody is there yet: it is refused";
    EXPECT_FALSE(lane.take(wanted(0x0F, 3), axis).command);
    for (const std::uint32_t source : {1u, 2u}) {
        axis = enabled_axis();
        axis.source = source;
        EXPECT_FALSE(lane.take(wanted(0x0F, 3), axis).command) << "it has not answered yet";
        axis.current = true;
        const auto step = lane.take(wanted(0x0F, 3), axis);
        ASSERT_TRUE(step.command) << source;
        EXPECT_EQ(step.command->mode, std::int16_t{3});
        EXPECT_FALSE(step.command->target_velocity) << "a speed counts when it changes";
        auto turning = wanted(0x0F, 3);
        turning.target_velocity = 500;
        const auto speed = lane.take(turning, axis);
        ASSERT_TRUE(speed.command);
        EXPECT_EQ(speed.command->target_velocity, 500);
        (void)lane.take(wanted(0x0F, 3), axis);
    }
}

TEST(EnipOutputLane, WhatWasNotTakenGoesWithTheNextImageThatDiffersAndIsNotRepeatedByItself) {
    OutputLane lane;
    ASSERT_TRUE(lane.take(wanted(0x06, 3), enabled_axis()).command);
    lane.begun();
    EXPECT_FALSE(lane.done(false).command) << "nothing has changed";
    EXPECT_FALSE(lane.take(wanted(0x06, 3), enabled_axis()).command) << "it would be refused with each image";
    const auto step = lane.take(wanted(0x07, 3), enabled_axis());
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->controlword, 0x07);
    EXPECT_EQ(step.command->mode, std::int16_t{3}) << "which the axis never had";
    lane.begun();
    EXPECT_FALSE(lane.done(true).command);
    // A refused stop is not held back by that either.
    const auto stop = lane.take(wanted(0x00, 3), enabled_axis());
    ASSERT_TRUE(stop.command);
    lane.begun();
    EXPECT_FALSE(lane.done(false).command);
    const auto next = lane.take(wanted(0x02, 3), enabled_axis());
    ASSERT_TRUE(next.command);
    EXPECT_EQ(next.command->controlword, 0x02);
}

TEST(EnipOutputLane, AnEdgeCarriesWhatHasChanged) {
    OutputLane lane;
    auto step = lane.take(wanted(0x0F), {});
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->controlword, 0x0F);
    EXPECT_EQ(step.command->mode, std::int16_t{1});
    EXPECT_EQ(step.command->target_position, 0);
    EXPECT_FALSE(lane.take(wanted(0x0F), {}).command) << "renewed, not changed";
    EXPECT_FALSE(lane.take(wanted(0x0F, 1, 500), {}).command) << "a target waits for its edge";
    step = lane.take(wanted(0x1F, 1, 500), {});
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->controlword, 0x1F);
    EXPECT_EQ(step.command->target_position, 500);
}

TEST(EnipOutputLane, BitsThatWereSetFromTheStartAreNoEdges) {
    OutputLane lane;
    auto step = lane.take(wanted(0x9F, 1, 500), {});
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->controlword, 0x0F);
    EXPECT_FALSE(lane.take(wanted(0x9F, 1, 500), {}).command);
    (void)lane.take(wanted(0x0F, 1, 500), {});
    step = lane.take(wanted(0x1F, 1, 500), {});
    ASSERT_TRUE(step.command) << "low once: now it is one";
    EXPECT_EQ(step.command->controlword, 0x1F);
    lane.reset();
    EXPECT_EQ(lane.take(wanted(0x1F, 1, 500), {}).command->controlword, 0x0F) << "after a loss as at the start";
}

TEST(EnipOutputLane, ASpeedIsFollowedOneCommandAtATimeAndAStopWaitsForNone) {
    OutputLane lane;
    Wanted w = wanted(0x0F, 3);
    ASSERT_TRUE(lane.take(w, {}).command);
    lane.begun();
    w.target_velocity = 100;
    EXPECT_FALSE(lane.take(w, {}).command) << "the command before it has no result yet";
    w.target_velocity = 200;
    EXPECT_FALSE(lane.take(w, {}).command);
    auto step = lane.done(true);
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->target_velocity, 200) << "the newest counts";
    lane.begun();
    w.controlword = 0x10F;
    step = lane.take(w, {});
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->controlword, 0x10F);
}

TEST(EnipOutputLane, TheSpeedOfTheFirstImageMovesNothing) {
    OutputLane lane;
    Wanted w = wanted(0x0F, 3);
    w.target_velocity = 100;
    auto step = lane.take(w, enabled_axis());
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->controlword, 0x0F);
    EXPECT_EQ(step.command->mode, std::int16_t{3});
    EXPECT_FALSE(step.command->target_velocity);
    for (int i = 0; i < 3; ++i)
        EXPECT_FALSE(lane.take(w, enabled_axis()).command) << "renewed, not changed";
    w.target_velocity = 101;
    step = lane.take(w, enabled_axis());
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->target_velocity, 101);
    w.target_velocity = 100;
    step = lane.take(w, enabled_axis());
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->target_velocity, 100) << "now it counts";
    lane.reset();
    step = lane.take(w, enabled_axis());
    ASSERT_TRUE(step.command);
    EXPECT_FALSE(step.command->target_velocity) << "after idle as at the start";
    w.target_velocity = 0;
    step = lane.take(w, enabled_axis());
    ASSERT_TRUE(step.command);
    EXPECT_EQ(step.command->target_velocity, 0) << "a stop that was never sent before is one";
}

TEST(EnipOutputLane, WhoEnablesTheAxisOrEndsItsHaltMeansTheSpeedThatStandsThere) {
    for (const std::uint16_t first : {std::uint16_t{0x07}, std::uint16_t{0x10F}}) {
        OutputLane lane;
        Wanted w = wanted(first, 3);
        w.target_velocity = 100;
        auto step = lane.take(w, enabled_axis());
        ASSERT_TRUE(step.command);
        EXPECT_FALSE(step.command->target_velocity) << first;
        w.controlword = 0x0F;
        step = lane.take(w, enabled_axis());
        ASSERT_TRUE(step.command);
        EXPECT_EQ(step.command->target_velocity, 100) << first;
    }
}

TEST(EnipOutputLane, AnAxisThatStandsHaltedStaysSoUntilSomethingIsWanted) {
    AxisPicture halted = enabled_axis();
    halted.controlword = 0x10F;
    OutputLane lane;
    EXPECT_EQ(lane.take(wanted(0x0F), halted).command->controlword, 0x10F);
    EXPECT_FALSE(lane.take(wanted(0x0F), halted).command);
    EXPECT_EQ(lane.take(wanted(0x1F, 1, 500), halted).command->controlword, 0x1F) << "a set-point of its own";
    lane.reset();
    EXPECT_EQ(lane.take(wanted(0x0F), halted).command->controlword, 0x10F);
    EXPECT_FALSE(lane.take(wanted(0x10F), halted).command) << "its own halt is none that was held";
    EXPECT_EQ(lane.take(wanted(0x0F), halted).command->controlword, 0x0F);
    lane.reset();
    Wanted w = wanted(0x0F, 3);
    EXPECT_EQ(lane.take(w, halted).command->controlword, 0x10F);
    w.target_velocity = 7;
    const auto step = lane.take(w, halted);
    EXPECT_EQ(step.command->controlword, 0x0F);
    EXPECT_EQ(step.command->target_velocity, 7);
}

TEST(EnipOutputLane, StreamedModesBecomeSetPointsOfAnEnabledAxis) {
    OutputLane lane;
    Wanted w = wanted(0x0F, 8, 1000);
    auto step = lane.take(w, {});
    ASSERT_TRUE(step.command);
    EXPECT_FALSE(step.command->mode) << "the set-point says it";
    EXPECT_FALSE(step.set_point) << "not enabled yet";
    step = lane.take(w, enabled_axis());
    EXPECT_FALSE(step.set_point) << "the place of the first image is where it begins, not where it goes";
    w.target_position = 1001;
    EXPECT_FALSE(lane.take(w, {}).set_point) << "not enabled";
    step = lane.take(w, enabled_axis());
    EXPECT_FALSE(step.command);
    ASSERT_TRUE(step.set_point);
    EXPECT_EQ(step.set_point->value, 1001);
    w.target_position = 1000;
    EXPECT_EQ(lane.take(w, enabled_axis()).set_point->value, 1000) << "back at the first one's: by now it counts";
    w.controlword = 0x10F;
    step = lane.take(w, enabled_axis());
    EXPECT_TRUE(step.command);
    EXPECT_FALSE(step.set_point) << "halt";
    w.controlword = 0x0F;
    w.mode = 9;
    w.target_velocity = -7;
    step = lane.take(w, enabled_axis());
    ASSERT_TRUE(step.set_point);
    EXPECT_EQ(step.set_point->mode, SetPoint::Mode::velocity);
    EXPECT_EQ(step.set_point->value, -7);
}
}  // namespace
}  // namespace axisgate::enip
