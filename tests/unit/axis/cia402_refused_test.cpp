// A refused order of another client leaves the motion, the mode and the words of the client that moves the axis as they are; and a speed
// that its client repeats is ordered once.
#include <algorithm>

#include "tests/unit/axis/cia402_words.hpp"

namespace axisgate {
namespace {
using namespace cia402;
using cia402_bench::bert, cia402_bench::Bench, cia402_bench::controller, cia402_bench::enable, cia402_bench::only, cia402_bench::place,
    cia402_bench::say, cia402_bench::speed;

void is_refused(Bench& b, const CommandBody& body) {
    const auto d = b.profile.on_command(body, bert);
    for (const auto& o : d.orders)
        b.profile.on_order_result(o, false, b.now);
    b.say();
}
std::vector<CommandBody> motions_of_another() {
    Move to, at;
    to.target = 77;
    at.kind = Move::Kind::velocity;
    at.target = 88;
    return {Home{99}, to, at};
}

TEST(Cia402Refused, AnAxisThatTurnsFollowsItsClientsNextSpeed) {
    for (const auto& body : motions_of_another()) {
        SCOPED_TRACE(name_of(body));
        Bench b;
        enable(b, mode_profile_velocity);
        ASSERT_TRUE(only<Move>(say(b, speed(500))));
        is_refused(b, body);
        EXPECT_EQ(b.picture().mode, mode_profile_velocity);
        EXPECT_TRUE(say(b, speed(500)).orders.empty()) << "it turns so";
        const auto d = say(b, speed(300));
        ASSERT_TRUE(only<Move>(d));
        EXPECT_EQ(only<Move>(d)->target, 300);
    }
}

TEST(Cia402Refused, ASetPointBehindARefusedHomingIsNoHoming) {
    for (const auto& body : motions_of_another()) {
        SCOPED_TRACE(name_of(body));
        Bench b;
        enable(b, mode_profile_position);
        ASSERT_TRUE(only<Move>(say(b, place(1000, 0x3F))));
        is_refused(b, body);
        (void)say(b, place(2000, 0x0F));
        const auto d = say(b, place(2000, 0x3F));
        ASSERT_TRUE(only<Move>(d)) << "the edge of bit 4 is a set-point's";
        EXPECT_EQ(only<Move>(d)->target, 2000);
    }
}

TEST(Cia402Refused, WhatWaitsBehindTheRunningMotionStillBegins) {
    for (const auto& body : motions_of_another()) {
        SCOPED_TRACE(name_of(body));
        Bench b;
        enable(b, mode_profile_position);
        ASSERT_TRUE(only<Move>(say(b, place(1000, 0x3F))));
        (void)say(b, place(2000, 0x0F));
        ASSERT_TRUE(say(b, place(2000, 0x1F)).waits);
        is_refused(b, body);
        b.drive.moving = false;
        b.drive.target_reached = true;
        const auto next = b.say();
        ASSERT_TRUE(next && std::holds_alternative<Move>(*next));
        EXPECT_EQ(std::get<Move>(*next).target, 2000);
    }
}

TEST(Cia402Refused, WhatWaitsDoesNotBeginWhileAnotherMotionIsOnItsWay) {
    Bench b;
    enable(b, mode_profile_position);
    ASSERT_TRUE(only<Move>(say(b, place(1000, 0x3F))));
    (void)say(b, place(2000, 0x0F));
    ASSERT_TRUE(say(b, place(2000, 0x1F)).waits);
    Move to;
    to.target = 77;
    const auto asked = b.profile.on_command(to, bert);
    b.drive.moving = false;
    b.drive.target_reached = true;
    EXPECT_FALSE(b.say());
    b.profile.on_order_result(asked.orders.at(0), true, b.now);
    EXPECT_FALSE(b.say()) << "and that one has taken its place";
}

/// A restarted gateway finds the axis moving, and its controller with its former words; the controller writes its mode once.
TEST(Cia402Refused, AModeThatWasSaidWhileTheAxisMovedForNobodyCountsWithTheNextFreshEdge) {
    Bench b;
    b.drive.power = cia402_bench::Power::on;
    b.drive.moving = true;
    b.drive.target_reached = false;
    b.say();
    ProcessData d;
    d.mode = mode_profile_velocity;
    d.controlword = 0x0F;
    EXPECT_TRUE(say(b, d).orders.empty());
    EXPECT_EQ(b.picture().mode, mode_none) << "words that may be as old as the motion change nothing of it";
    b.drive.moving = false;
    b.say();
    for (const int word : {0x00, 0x06, 0x07, 0x0F}) {
        ProcessData w;
        w.controlword = static_cast<std::uint16_t>(word);
        if (word == 0) w.target_velocity = 0;
        (void)say(b, w);
    }
    const auto moved = say(b, speed(400));
    ASSERT_TRUE(only<Move>(moved)) << "and its next speed is one";
    EXPECT_EQ(b.picture().mode, mode_profile_velocity);
}

TEST(Cia402Velocity, ASpeedThatIsRepeatedBeforeItsAnswerIsOrderedOnce) {
    for (const bool good : {true, false}) {
        Bench b;
        enable(b, mode_profile_velocity);
        const auto first = b.profile.on_process_data(speed(500), controller);
        ASSERT_TRUE(only<Move>(first));
        for (int i = 0; i < 3; ++i)
            EXPECT_TRUE(b.profile.on_process_data(speed(500), controller).orders.empty()) << "it is on its way";
        const auto other = b.profile.on_process_data(speed(0), controller);
        ASSERT_TRUE(only<Move>(other)) << "another speed does not wait";
        b.profile.on_order_result(first.orders.front(), true, b.now);
        b.profile.on_order_result(other.orders.front(), good, b.now);
        EXPECT_EQ(b.profile.on_process_data(speed(0), controller).orders.empty(), good) << "one that was refused is asked for again";
    }
}

TEST(Cia402Stream, AnAxisThatWasFoundEnabledIsEnabledAnewFirst) {
    Bench b;
    b.drive.power = cia402_bench::Power::on;
    b.say();
    ASSERT_EQ(b.profile.state(), PowerState::operation_enabled);
    EXPECT_EQ(b.profile.may_follow().reason, Reason::wrong_state);
    EXPECT_NE(b.profile.may_follow().text.find("enable it anew"), std::string::npos);
    b.obey(b.profile.on_command(Enable{}, bert));
    EXPECT_FALSE(b.profile.may_follow().refused);
    b.profile.on_presence(Presence::device);
    b.say();
    EXPECT_TRUE(b.profile.may_follow().refused) << "another drive serves it";
}

TEST(Cia402SetPosition, IsRefusedWhileTheAxisMoves) {
    Bench b;
    enable(b, mode_profile_velocity);
    (void)say(b, speed(500));
    EXPECT_EQ(b.profile.on_command(SetPosition{5}, bert).reason, Reason::wrong_state);
    b.drive.moving = false;
    b.say();
    EXPECT_FALSE(b.profile.on_command(SetPosition{5}, bert).refused);
}

}  // namespace
}  // namespace axisgate
