// CiA 402 with streamed set-points, and with a drive that has the state machine itself.
#include "tests/unit/axis/cia402_bench.hpp"

namespace axisgate {
namespace {
using namespace cia402_bench;

SetPoint point(std::int64_t value, SetPoint::Mode mode = SetPoint::Mode::position) {
    SetPoint p;
    p.mode = mode;
    p.value = value;
    return p;
}

TEST(Cia402Stream, TheModeIsTheSetPointsWhileItLasts) {
    Bench b;
    b.enable(mode_profile_position);
    ASSERT_FALSE(b.profile.may_follow().refused);
    b.profile.follow(point(1234));
    EXPECT_EQ(b.picture().mode_display, mode_cyclic_position);
    EXPECT_EQ(b.picture().target_position, 1234);
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0) << "the drive follows the command value";
    b.profile.follow(point(-55, SetPoint::Mode::velocity));
    EXPECT_EQ(b.picture().mode_display, mode_cyclic_velocity);
    EXPECT_EQ(b.picture().target_velocity, -55);
    b.profile.follow(point(10, SetPoint::Mode::torque));
    EXPECT_EQ(b.picture().mode_display, mode_cyclic_torque);
    b.profile.end_following();
    EXPECT_EQ(b.picture().mode_display, mode_profile_position);
    EXPECT_EQ(b.picture().target_velocity, 0);
    EXPECT_EQ(b.picture().statusword & sw_mode_12, 0);
}

TEST(Cia402Stream, AModeThatIsChosenMeanwhileIsKept) {
    Bench b;
    b.enable(mode_profile_position);
    b.profile.follow(point(1));
    ProcessData d;
    d.mode = mode_profile_velocity;
    b.data(d);
    b.profile.follow(point(2));
    EXPECT_EQ(b.picture().mode_display, mode_cyclic_position) << "the stream goes on";
    b.profile.end_following();
    EXPECT_EQ(b.picture().mode_display, mode_profile_velocity);
    b.profile.follow(point(3));
    Move m;
    m.target = 500;
    b.obey(b.profile.on_command(m));
    b.profile.end_following();
    EXPECT_EQ(b.picture().mode_display, mode_profile_position) << "of the motion that ended it";
    EXPECT_EQ(b.picture().target_position, 500);
}

TEST(Cia402Stream, OnlyAnEnabledAxisWithoutHaltFollows) {
    Bench b;
    EXPECT_EQ(b.profile.may_follow().reason, Reason::wrong_state);
    b.enable(mode_profile_position);
    b.word(0x10F);
    EXPECT_NE(b.profile.may_follow().text.find("halt"), std::string::npos);
    b.profile.end_following();
    EXPECT_TRUE(b.profile.may_follow().refused) << "the end of a stream does not clear the halt";
    b.word(0x0F);
    EXPECT_FALSE(b.profile.may_follow().refused);
    b.to(PowerState::fault);
    EXPECT_NE(b.profile.may_follow().text.find("fault"), std::string::npos);
    b.profile.on_presence(Presence::offline);
    EXPECT_EQ(b.profile.may_follow().reason, Reason::no_answer);
}

TEST(Cia402Stream, TheFirstOneForgetsTheMotionAndWhatWaitsBehindIt) {
    Bench b;
    b.enable(mode_profile_position);
    ProcessData d;
    d.target_position = 1000;
    d.controlword = 0x1F;
    b.data(d);
    d.target_position = 2000;
    d.controlword = 0x0F;
    b.data(d);
    d.controlword = 0x1F;
    b.data(d);  // waits
    b.profile.follow(point(10));
    EXPECT_FALSE(b.profile.active_target());
    b.drive.moving = false;
    b.drive.target_reached = true;
    EXPECT_FALSE(b.say()) << "nothing begins behind it";
}

TEST(Cia402OwnState, StepsWithoutPowerAreTheDrives) {
    Bench b;
    const auto shown = [&](std::optional<std::uint16_t> word) {
        b.drive.statusword = word;
        b.say();
        return b.profile.state();
    };
    EXPECT_EQ(shown(0x0250), PowerState::switch_on_disabled);
    EXPECT_EQ(shown(0x0231), PowerState::ready_to_switch_on);
    EXPECT_EQ(shown(0x1233), PowerState::switched_on) << "other bits do not matter";
    EXPECT_EQ(shown(std::nullopt), PowerState::switch_on_disabled);
    // A word towards operation counts if the drive has no such step, and is never shown below the drive's own state.
    b.drive.statusword = 0x0231;
    b.word(0x06);
    EXPECT_EQ(b.profile.state(), PowerState::ready_to_switch_on);
    b.word(0x07);
    EXPECT_EQ(b.profile.state(), PowerState::switched_on);
    const auto on = b.word(0x0F);
    ASSERT_EQ(on.orders.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Enable>(on.orders[0]));
    EXPECT_EQ(b.profile.state(), PowerState::operation_enabled);
}

TEST(Cia402OwnState, FaultAndQuickStopAreTheDrives) {
    Bench b;
    b.enable(mode_profile_position);
    b.drive.statusword = 0x0207;
    b.say();
    EXPECT_EQ(b.profile.state(), PowerState::quick_stop_active);
    b.drive.statusword = 0x0227;
    b.say();
    EXPECT_EQ(b.profile.state(), PowerState::operation_enabled);
    b.drive.fault = true;
    b.drive.statusword = 0x020F;
    b.say();
    EXPECT_FALSE(b.say()) << "it is braking by itself";
    EXPECT_EQ(b.profile.state(), PowerState::fault_reaction_active) << "it brakes, though it does not call that moving";
    b.drive.statusword = 0x0208;
    b.drive.moving = true;
    b.say();
    EXPECT_EQ(b.profile.state(), PowerState::fault);
}

}  // namespace
}  // namespace axisgate
