// The values that the CiA 402 profile keeps about orders on their way, halted motions, and recently switched power, with feedback in an
// unfavourable order.
#include "tests/unit/axis/cia402_words.hpp"

namespace axisgate {
namespace {
using namespace cia402;
using cia402_bench::bert, cia402_bench::Bench, cia402_bench::controller, cia402_bench::enable, cia402_bench::only, cia402_bench::place,
    cia402_bench::say, cia402_bench::speed, cia402_bench::word;

/// The order for the speed has no answer yet when the axis is stopped: the same speed is a new order once the axis is enabled again.
TEST(Cia402Remembered, ASpeedOnItsWayIsForgottenByAQuickStop) {
    Bench b;
    enable(b, mode_profile_velocity);
    ASSERT_TRUE(only<Move>(b.profile.on_process_data(speed(500), controller)));
    (void)word(b, 0x0B);
    (void)say(b, speed(0));
    for (const int step : {0x00, 0x06, 0x07, 0x0F})
        (void)word(b, static_cast<std::uint16_t>(step));
    ASSERT_EQ(b.profile.state(), PowerState::operation_enabled);
    const auto again = say(b, speed(500));
    ASSERT_TRUE(only<Move>(again));
    EXPECT_EQ(only<Move>(again)->target, 500);
}

/// A homing that the drive has accepted ends the earlier speed: at its end the axis rests, and later motions are shown as requested.
TEST(Cia402Remembered, AfterAHomingTheAxisTurnsNoMore) {
    Bench b;
    enable(b, mode_profile_velocity);
    ASSERT_TRUE(only<Move>(say(b, speed(500))));
    b.obey(b.profile.on_command(Home{35}, bert));
    b.drive.moving = false;
    b.drive.homing_attained = b.drive.target_reached = true;
    b.say();
    ASSERT_EQ(b.picture().mode, mode_homing);
    Move to;
    to.target = 77;
    const auto asked = b.profile.on_command(to, bert);
    ASSERT_TRUE(only<Move>(asked));
    EXPECT_EQ(b.picture().mode, mode_profile_position) << "nothing runs beside it";
}

/// An axis that stands short of its target, because of a limit or a flickering flag, has not arrived.
TEST(Cia402Remembered, WhatWaitsDoesNotBeginWhereTheAxisStandsShortOfItsTarget) {
    Bench b;
    enable(b, mode_profile_position);
    ASSERT_TRUE(only<Move>(say(b, place(1000, 0x3F))));
    (void)say(b, place(2000, 0x0F));
    ASSERT_TRUE(say(b, place(2000, 0x1F)).waits);
    b.drive.moving = false;
    b.drive.target_reached = false;
    EXPECT_FALSE(b.say());
    b.drive.target_reached = true;
    const auto next = b.say();
    ASSERT_TRUE(next && std::holds_alternative<Move>(*next));
    EXPECT_EQ(std::get<Move>(*next).target, 2000);
}

/// A drive may report the end of a halt as "target reached" for a moment. The target is still that of the halted motion.
TEST(Cia402Remembered, AHaltedMotionGoesOnThoughItsHaltWasCalledReached) {
    Bench b;
    enable(b, mode_profile_position);
    ASSERT_TRUE(only<Move>(say(b, place(1000, 0x3F))));
    (void)word(b, 0x0F);
    ASSERT_TRUE(only<Halt>(word(b, 0x10F)));
    b.drive.moving = false;
    for (const bool reached : {true, false}) {
        b.drive.target_reached = reached;
        b.say();
    }
    const auto on = word(b, 0x0F);
    ASSERT_TRUE(only<Move>(on));
    EXPECT_EQ(only<Move>(on)->target, 1000);
}

/// Feedback that was read at the instant of the drive's acknowledgement may still show the former power state.
TEST(Cia402Remembered, FeedbackOfTheInstantOfTheAcknowledgementDoesNotUndoPower) {
    Bench b;
    (void)word(b, 0x06);
    (void)word(b, 0x07);
    ProcessData d;
    d.controlword = 0x0F;
    const auto on = b.profile.on_process_data(d, controller);
    ASSERT_TRUE(only<Enable>(on));
    b.now += std::chrono::milliseconds(1);
    b.profile.on_order_result(on.orders.front(), true, b.now);
    ASSERT_EQ(b.profile.state(), PowerState::operation_enabled);
    b.drive.at = b.now;  // power is still off in it
    (void)b.profile.on_feedback(b.drive, b.now);
    EXPECT_EQ(b.profile.state(), PowerState::operation_enabled);
    b.say();  // later feedback counts
    EXPECT_NE(b.profile.state(), PowerState::operation_enabled);
}

}  // namespace
}  // namespace axisgate
