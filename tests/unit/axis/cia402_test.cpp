// Every transition of the power state machine and every rule of the control word, from a table.
#include <array>

#include "gateway/axis/guard.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/unit/axis/cia402_bench.hpp"

namespace axisgate {
namespace {
using namespace cia402;
using cia402_bench::Bench;
using Power = AxisFeedback::Power;

struct Transition {
    PowerState from;
    std::uint16_t controlword;
    PowerState to;
    const char* number;  ///< of IEC 61800-7-201, or the reason why the state stays
};

class EveryTransition : public testing::TestWithParam<Transition> {};

TEST_P(EveryTransition, EndsWhereTheStandardSays) {
    const auto& t = GetParam();
    Bench b;
    b.to(t.from);
    b.word(t.controlword);
    EXPECT_EQ(b.profile.state(), t.to) << t.number << ": " << name_of(b.profile.state());
    EXPECT_EQ(power_state_of(b.picture().statusword), t.to);
}

constexpr auto sod = PowerState::switch_on_disabled, rtso = PowerState::ready_to_switch_on, so = PowerState::switched_on,
               oe = PowerState::operation_enabled, qsa = PowerState::quick_stop_active, flt = PowerState::fault,
               far = PowerState::fault_reaction_active, nrtso = PowerState::not_ready_to_switch_on;

INSTANTIATE_TEST_SUITE_P(
    Cia402, EveryTransition,
    testing::Values(Transition{sod, 0x06, rtso, "2"}, Transition{sod, 0x07, sod, "switch on is not possible here"},
                    Transition{sod, 0x0F, sod, "nor is enable operation"}, Transition{sod, 0x00, sod, "disable voltage"},
                    Transition{sod, 0x02, sod, "quick stop"}, Transition{rtso, 0x07, so, "3"}, Transition{rtso, 0x0F, oe, "3+4"},
                    Transition{rtso, 0x00, sod, "7 by disable voltage"}, Transition{rtso, 0x02, sod, "7 by quick stop"},
                    Transition{rtso, 0x06, rtso, "stays"}, Transition{so, 0x0F, oe, "4"}, Transition{so, 0x06, rtso, "6"},
                    Transition{so, 0x00, sod, "10 by disable voltage"}, Transition{so, 0x02, sod, "10 by quick stop"},
                    Transition{so, 0x07, so, "stays"}, Transition{oe, 0x07, so, "5"}, Transition{oe, 0x06, rtso, "8"},
                    Transition{oe, 0x00, sod, "9"}, Transition{oe, 0x0D, sod, "9: bit 1 counts alone"}, Transition{oe, 0x02, qsa, "11"},
                    Transition{oe, 0x0B, qsa, "11 with the other bits set"}, Transition{oe, 0x0F, oe, "stays"},
                    Transition{qsa, 0x00, sod, "12"}, Transition{qsa, 0x0F, oe, "16"}, Transition{qsa, 0x02, qsa, "stays"},
                    Transition{qsa, 0x06, qsa, "shutdown is not possible here"}, Transition{flt, 0x80, sod, "15"},
                    Transition{flt, 0x0F, flt, "only the reset's edge"}, Transition{flt, 0x06, flt, "only the reset's edge"},
                    Transition{flt, 0x00, flt, "stays"}, Transition{far, 0x00, far, "left by the drive: 14"},
                    Transition{far, 0x0F, far, "left by the drive"}, Transition{nrtso, 0x0F, nrtso, "left by the drive: 0, 1"},
                    Transition{nrtso, 0x06, nrtso, "left by the drive"}));

TEST(Cia402, StatusWordCodesOfEveryState) {
    struct Row {
        PowerState state;
        std::uint16_t masked, mask;
    };
    for (const Row& r : {Row{nrtso, 0x00, 0x4F}, Row{sod, 0x40, 0x4F}, Row{rtso, 0x21, 0x6F}, Row{so, 0x23, 0x6F}, Row{oe, 0x27, 0x6F},
                         Row{qsa, 0x07, 0x6F}, Row{far, 0x0F, 0x4F}, Row{flt, 0x08, 0x4F}}) {
        Bench b;
        b.to(r.state);
        EXPECT_EQ(b.picture().statusword & r.mask, r.masked) << name_of(r.state);
    }
}

TEST(Cia402, FaultIsEnteredFromEveryStateAndLeftByTheEdgeAlone) {
    for (const auto from : {sod, rtso, so, oe, qsa}) {
        Bench b;
        b.to(from);
        b.drive.fault = true;
        b.drive.error_code = 51;
        b.drive.moving = from == oe;
        b.say();
        EXPECT_EQ(b.profile.state(), from == oe ? far : flt);
        b.drive.moving = false;
        b.say();
        EXPECT_EQ(b.profile.state(), flt);
        EXPECT_EQ(b.picture().error_code, 51);
        EXPECT_NE(b.picture().flags & flag_fault, 0);
        const auto d = b.word(0x80);
        ASSERT_EQ(d.orders.size(), from == oe || from == qsa ? 2u : 1u) << "a drive that kept its power is switched off with the reset";
        EXPECT_TRUE(std::holds_alternative<ResetFault>(d.orders[0]));
        EXPECT_EQ(b.profile.state(), sod);
        // The same level again is no edge.
        EXPECT_TRUE(b.word(0x80).orders.empty());
    }
}

TEST(Cia402, PowerLostByItselfGoesBackToTheFirstStepAndForgetsTargets) {
    Bench b;
    b.enable(mode_profile_velocity);
    ProcessData d;
    d.target_velocity = 500;
    b.data(d);
    b.drive.power = Power::off;
    b.drive.moving = false;
    b.say();
    EXPECT_EQ(b.profile.state(), sod);
    EXPECT_EQ(b.picture().target_velocity, 0);
}

TEST(Cia402, DrivePoweredByItselfShowsOperationEnabled) {
    Bench b;
    b.drive.power = Power::on;
    b.say();
    EXPECT_EQ(b.profile.state(), oe);
    b.word(0x00);
    EXPECT_EQ(b.profile.state(), sod);
}

TEST(Cia402, FeedbackOlderThanTheAcknowledgedOrderDoesNotUndoIt) {
    Bench b;
    b.to(so);
    ProcessData d;
    d.controlword = 0x0F;
    const auto decision = b.profile.on_process_data(d);
    ASSERT_EQ(decision.orders.size(), 1u);
    AxisFeedback late = b.drive;
    late.at = b.now;  // read before the drive acknowledged
    b.now += std::chrono::milliseconds(5);
    b.profile.on_order_result(decision.orders[0], true, b.now);
    EXPECT_EQ(b.profile.state(), oe);
    (void)b.profile.on_feedback(late, b.now);
    EXPECT_EQ(b.profile.state(), oe);
}

TEST(Cia402, RefusedEnableFallsBack) {
    Bench b;
    b.to(so);
    ProcessData d;
    d.controlword = 0x0F;
    const auto decision = b.profile.on_process_data(d);
    b.profile.on_order_result(decision.orders.at(0), false, b.now);
    b.say();
    EXPECT_EQ(b.profile.state(), sod);
    EXPECT_EQ(b.picture().controlword & cw_enable_operation, 0);
}

Origin client(std::string name) {
    Origin o;
    o.door = modbus::clients;
    o.client = std::make_shared<const std::string>(std::move(name));
    return o;
}

TEST(Cia402, EnableTakesTheActualPositionAsFirstTarget) {
    Bench b;
    ProcessData d;
    d.mode = mode_profile_position;
    d.target_position = 99999;
    b.obey(b.profile.on_process_data(d, client("panel")));
    b.drive.position = 1234;
    b.say();
    b.to(oe);  // another client enables
    EXPECT_EQ(b.picture().target_position, 1234);
    EXPECT_EQ(b.picture().setpoints_accepted, 0);
    d = {};
    d.profile_velocity = 100;
    d.controlword = 0x1F;
    const auto r = b.profile.on_process_data(d, client("panel"));
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(r.orders[0]).target, 1234) << "what was written before somebody else enabled moves nothing";
}

TEST(Cia402, ATargetThatTheEnablingClientHasWrittenIsTheTargetOfItsSetPoint) {
    Bench b;
    const Origin plc = client("plc");
    const auto say = [&](std::uint16_t cw) {
        ProcessData d;
        d.controlword = cw;
        auto r = b.profile.on_process_data(d, plc);
        b.obey(r);
        return r;
    };
    ProcessData d;
    d.mode = mode_profile_position;
    d.target_position = 5000;
    d.profile_velocity = 100;
    b.obey(b.profile.on_process_data(d, plc));
    b.drive.position = 1234;
    b.say();
    say(0x06);
    say(0x07);
    EXPECT_EQ(say(0x0F).orders.size(), 1u) << "enable, and nothing else";
    EXPECT_EQ(b.picture().target_position, 5000) << "register 34 reads what was written";
    const auto r = say(0x1F);
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(r.orders[0]).target, 5000);
    // It has been used: the next enable begins at the actual position again.
    b.drive.moving = false;
    b.drive.target_reached = true;
    b.drive.position = 5000;
    b.say();
    say(0x06);
    b.drive.position = 777;
    b.say();
    say(0x0F);
    EXPECT_EQ(b.picture().target_position, 777);
    const auto again = say(0x1F);
    ASSERT_EQ(again.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(again.orders[0]).target, 777);
}

TEST(Cia402, ASetPointNeedsAVelocityThatItsOwnDoorHasWritten) {
    Bench b;
    ProcessData mode;
    mode.mode = mode_profile_position;
    b.data(mode);
    b.to(oe);
    ProcessData d;
    d.target_position = 1000;
    d.controlword = 0x1F;
    const auto never_written = b.profile.on_process_data(d, client("plc"));
    EXPECT_TRUE(never_written.refused);
    EXPECT_EQ(never_written.reason, Reason::out_of_range);
    EXPECT_NE(never_written.text.find("36"), std::string::npos) << never_written.text;
    // Another door's move is no default for this one, but the registers show the values given to the drive.
    Move m;
    m.target = 10;
    m.velocity = 55;
    m.acceleration = 66;
    b.obey(b.profile.on_command(m));
    EXPECT_EQ(b.picture().profile_velocity, 55u);
    EXPECT_EQ(b.picture().profile_acceleration, 66u);
    EXPECT_TRUE(b.profile.on_process_data(d, client("plc")).refused);
    d.profile_velocity = 0;
    EXPECT_TRUE(b.profile.on_process_data(d, client("plc")).refused) << "0 is no velocity";
    d.profile_velocity = 20;
    d.profile_deceleration = 40;
    d.controlword = 0x3F;  // at once: the other door's motion is running
    const auto r = b.profile.on_process_data(d, client("plc"));
    b.obey(r);
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(r.orders[0]).velocity, 20);
    EXPECT_FALSE(std::get<Move>(r.orders[0]).acceleration.has_value());
    Move n;
    n.target = 30;
    n.velocity = 5;
    n.acceleration = 7;
    const auto by_command = b.profile.on_command(n);
    ASSERT_EQ(by_command.orders.size(), 1u);
    EXPECT_FALSE(std::get<Move>(by_command.orders[0]).deceleration.has_value())
        << "what stands in the registers is no default of a command";
}

TEST(Cia402, ADriveThatReportsAFaultAndMovesIsStoppedAndAskedAgain) {
    Bench b;
    b.to(oe);
    b.drive.moving = true;
    b.drive.fault = true;
    b.drive.error_code = 26;
    auto order = b.say();
    ASSERT_TRUE(order.has_value());
    EXPECT_TRUE(std::holds_alternative<QuickStop>(*order));
    EXPECT_FALSE(b.say().has_value()) << "it is on its way";
    b.profile.on_order_result(*order, false, b.now);
    EXPECT_FALSE(b.say().has_value()) << "not at once again";
    b.now += std::chrono::seconds(1);
    order = b.say();
    ASSERT_TRUE(order.has_value()) << "it still moves";
    b.profile.on_order_result(*order, true, b.now);
    EXPECT_EQ(b.profile.state(), far);
    b.drive.moving = false;
    EXPECT_FALSE(b.say().has_value());
    EXPECT_EQ(b.profile.state(), flt);
    Bench rest;
    rest.to(oe);
    rest.drive.fault = true;
    EXPECT_FALSE(rest.say().has_value()) << "at rest there is nothing to stop";
}

TEST(Cia402, AStopMadeAtTheDriveIsShownAndLeftByAnEdgeAlone) {
    Bench b;
    b.enable(mode_profile_position);
    ProcessData d;
    d.target_position = 1000;
    d.controlword = 0x1F;
    b.data(d);
    b.drive.quick_stopping = true;
    b.drive.moving = false;
    b.say();
    EXPECT_EQ(b.profile.state(), qsa);
    EXPECT_TRUE(b.word(0x0F).orders.empty()) << "the word that a controller repeats does not undo it";
    EXPECT_EQ(b.profile.state(), qsa);
    b.word(0x07);
    const auto on = b.word(0x0F);
    ASSERT_EQ(on.orders.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Enable>(on.orders[0]));
    EXPECT_EQ(b.profile.state(), qsa) << "the drive says that it is still stopped";
    b.drive.quick_stopping = false;
    b.say();
    EXPECT_EQ(b.profile.state(), oe);
    b.drive.quick_stopping = true;
    b.say();
    const auto by_command = b.profile.on_command(Enable{});
    ASSERT_EQ(by_command.orders.size(), 1u) << "enable does what is needed, and is not done without an order";
}

TEST(Cia402, ARefusedHomingIsAHomingErrorAndNoOlderOneCounts) {
    Bench b;
    b.enable(mode_homing);
    b.drive.homing_attained = true;
    b.say();
    ASSERT_NE(b.picture().statusword & sw_mode_12, 0);
    ProcessData d;
    d.homing_method = 99;
    d.controlword = 0x1F;
    const auto r = b.profile.on_process_data(d);
    ASSERT_EQ(r.orders.size(), 1u);
    b.profile.on_order_result(r.orders[0], false, b.now);
    b.say();
    EXPECT_EQ(b.picture().statusword & sw_mode_12, 0);
    EXPECT_NE(b.picture().statusword & sw_mode_13, 0);
    b.word(0x0F);
    d.homing_method = 35;
    const auto good = b.profile.on_process_data(d);
    ASSERT_EQ(good.orders.size(), 1u);
    b.profile.on_order_result(good.orders[0], true, b.now);
    EXPECT_EQ(b.picture().statusword & sw_mode_13, 0);
}

TEST(Cia402, SetPointHandshake) {
    Bench b;
    b.enable(mode_profile_position);
    ProcessData d;
    d.target_position = 1000;
    d.profile_velocity = 200;
    d.profile_acceleration = 300;
    d.profile_deceleration = 400;
    EXPECT_TRUE(b.data(d).orders.empty()) << "a target alone moves nothing";
    const auto r = b.word(0x1F);
    ASSERT_EQ(r.orders.size(), 1u);
    const auto& m = std::get<Move>(r.orders[0]);
    EXPECT_EQ(m.kind, Move::Kind::absolute);
    EXPECT_EQ(m.target, 1000);
    EXPECT_EQ(m.velocity, 200);
    EXPECT_EQ(m.acceleration, 300);
    EXPECT_EQ(m.deceleration, 400);
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0) << "acknowledged";
    EXPECT_EQ(b.picture().setpoints_accepted, 1);
    EXPECT_TRUE(b.word(0x1F).orders.empty()) << "a level is not an edge: a PLC repeats its image for ever";
    b.word(0x0F);
    EXPECT_EQ(b.picture().statusword & sw_mode_12, 0);
}

TEST(Cia402, RelativeByBit6) {
    Bench b;
    b.enable(mode_profile_position);
    ProcessData d;
    d.target_position = -50;
    d.controlword = 0x5F;
    const auto r = b.data(d);
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(r.orders[0]).kind, Move::Kind::relative);
    EXPECT_EQ(std::get<Move>(r.orders[0]).target, -50);
}

TEST(Cia402, SecondSetPointWaitsUnlessImmediate) {
    Bench b;
    b.enable(mode_profile_position);
    ProcessData d;
    d.target_position = 1000;
    d.controlword = 0x1F;
    b.data(d);
    b.word(0x0F);
    d.target_position = 2000;
    EXPECT_TRUE(b.data(d).orders.empty()) << "the first one runs";
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0) << "buffer full";
    b.word(0x0F);
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0) << "still full";
    d.target_position = 3000;
    const auto third = b.data(d);
    EXPECT_TRUE(third.refused);
    EXPECT_EQ(third.reason, Reason::busy);
    b.drive.moving = false;
    b.drive.target_reached = true;
    const auto next = b.say();
    ASSERT_TRUE(next.has_value());
    EXPECT_EQ(std::get<Move>(*next).target, 2000);
    // Bit 5: at once, and the waiting set-point is dropped.
    Bench c;
    c.enable(mode_profile_position);
    d.target_position = 1000;
    c.data(d);
    c.word(0x0F);
    d.target_position = 500;
    d.controlword = 0x3F;
    ASSERT_EQ(c.data(d).orders.size(), 1u);
}

TEST(Cia402, NewSetPointOutsideOperationEnabledIsRefusedAndChangesNothing) {
    Bench b;
    ProcessData d;
    d.mode = mode_profile_position;
    b.data(d);
    d = {};
    d.controlword = 0x1F;
    const auto before = b.picture();
    const auto r = b.profile.on_process_data(d);
    EXPECT_TRUE(r.refused);
    EXPECT_EQ(r.reason, Reason::wrong_state);
    EXPECT_EQ(b.picture().controlword, before.controlword);
    b.to(so);
    EXPECT_TRUE(b.profile.on_process_data(d).refused) << "also with the word that enables";
}

TEST(Cia402, HaltStopsAndItsEndContinues) {
    Bench b;
    b.enable(mode_profile_position);
    ProcessData d;
    d.target_position = 1000;
    d.controlword = 0x1F;
    b.data(d);
    const auto halt = b.word(0x11F);
    ASSERT_EQ(halt.orders.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Halt>(halt.orders[0]));
    EXPECT_NE(b.picture().statusword & sw_target_reached, 0) << "with halt, bit 10 says: speed 0";
    const auto on = b.word(0x1F);
    ASSERT_EQ(on.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(on.orders[0]).target, 1000);
    EXPECT_EQ(b.profile.state(), oe);
}

TEST(Cia402, HaltContinuesARelativeMotionToItsOwnTarget) {
    Bench b;
    b.enable(mode_profile_position);
    b.drive.position = 100;
    b.say();
    ProcessData d;
    d.target_position = 1000;
    d.controlword = 0x5F;
    b.data(d);
    b.drive.position = 400;
    b.word(0x15F);
    const auto on = b.word(0x5F);
    ASSERT_EQ(on.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(on.orders[0]).kind, Move::Kind::absolute);
    EXPECT_EQ(std::get<Move>(on.orders[0]).target, 1100);
}

TEST(Cia402, VelocityModeActsOnChangeAloneAndEnablesAtZero) {
    Bench b;
    ProcessData d;
    d.mode = mode_profile_velocity;
    d.target_velocity = 700;
    b.data(d);
    b.to(oe);
    EXPECT_EQ(b.picture().target_velocity, 0) << "an old speed must not start the axis";
    d = {};
    d.target_velocity = -700;
    auto r = b.data(d);
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(r.orders[0]).kind, Move::Kind::velocity);
    EXPECT_EQ(std::get<Move>(r.orders[0]).target, -700);
    EXPECT_TRUE(b.data(d).orders.empty()) << "the same speed again";
    b.drive.velocity = -700;
    b.say();
    EXPECT_NE(b.picture().statusword & sw_target_reached, 0);
    EXPECT_EQ(b.picture().statusword & sw_mode_12, 0);
    r = b.word(0x10F);
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Halt>(r.orders[0]));
    b.drive.velocity = 0;
    b.say();
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0) << "speed 0";
    r = b.word(0x0F);
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_EQ(std::get<Move>(r.orders[0]).target, -700);
    d = {};
    d.mode = mode_profile_position;
    r = b.data(d);
    ASSERT_EQ(r.orders.size(), 1u) << "leaving the mode stops the axis";
    EXPECT_TRUE(std::holds_alternative<Halt>(r.orders[0]));
}

TEST(Cia402, HomingByTheEdgeOfBit4) {
    Bench b;
    b.enable(mode_homing);
    ProcessData d;
    d.homing_method = 35;
    d.controlword = 0x1F;
    const auto r = b.data(d);
    ASSERT_EQ(r.orders.size(), 1u);
    EXPECT_EQ(std::get<Home>(r.orders[0]).method, 35);
    b.drive.homing_attained = true;
    b.drive.referenced = true;
    b.say();
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0);
    EXPECT_NE(b.picture().statusword & sw_referenced, 0);
    b.drive.homing_attained = false;
    b.drive.homing_error = true;
    b.say();
    EXPECT_NE(b.picture().statusword & sw_mode_13, 0);
    b.drive.homing_error = false;
    b.drive.moving = true;
    b.say();
    const auto off = b.word(0x0F);
    ASSERT_EQ(off.orders.size(), 1u) << "bit 4 taken away under way ends homing";
    EXPECT_TRUE(std::holds_alternative<Halt>(off.orders[0]));
}

TEST(Cia402, AModeIsOneOfTheDrivesAndTheRefusalNamesThem) {
    constexpr std::array<std::int16_t, 4> offered{1, 6, 7, 8};
    for (const int number : {0, 1, 6})
        EXPECT_FALSE(guard_mode(static_cast<std::int16_t>(number), offered)) << number;
    for (const int number : {-1, 2, 3, 4, 9, 10}) {
        const auto no = guard_mode(static_cast<std::int16_t>(number), offered);
        ASSERT_TRUE(no) << number;
        EXPECT_EQ(no->reason, Reason::out_of_range);
        EXPECT_NE(no->text.find("is not offered by this drive; use 1 (profile position), 6 (homing)"), std::string::npos) << no->text;
    }
    for (const int number : {7, 8}) {
        const auto streamed = guard_mode(static_cast<std::int16_t>(number), offered);
        ASSERT_TRUE(streamed) << number;
        EXPECT_NE(streamed->text.find("streamed set-point"), std::string::npos) << "offered, and still not written to a register";
    }
}

TEST(Cia402, CommandsOfPeopleGoTheSameWay) {
    Bench b;
    Move move;
    move.target = 500;
    EXPECT_TRUE(b.profile.on_command(move).refused) << "not enabled";
    b.obey(b.profile.on_command(Enable{}));
    EXPECT_EQ(b.profile.state(), oe);
    EXPECT_EQ(b.picture().controlword, 0x0F);
    EXPECT_TRUE(b.profile.on_command(Enable{}).orders.empty()) << "enabled already";
    b.obey(b.profile.on_command(move));
    EXPECT_EQ(b.picture().mode_display, mode_profile_position);
    EXPECT_EQ(b.picture().target_position, 500);
    EXPECT_EQ(b.picture().setpoints_accepted, 1);
    b.obey(b.profile.on_command(QuickStop{}));
    EXPECT_EQ(b.profile.state(), qsa);
    b.obey(b.profile.on_command(Enable{}));
    EXPECT_EQ(b.profile.state(), oe);
    b.obey(b.profile.on_command(Disable{}));
    EXPECT_EQ(b.profile.state(), sod);
    b.drive.fault = true;
    b.drive.error_code = 9;
    b.say();
    const auto r = b.profile.on_command(Enable{});
    EXPECT_TRUE(r.refused);
    EXPECT_NE(r.text.find("9"), std::string::npos);
    b.obey(b.profile.on_command(ResetFault{}));
    EXPECT_EQ(b.profile.state(), sod);
}

TEST(Cia402, OfflineRefusesButStops) {
    Bench b;
    b.profile.on_presence(Presence::offline);
    const auto r = b.profile.on_command(Enable{});
    EXPECT_TRUE(r.refused);
    EXPECT_EQ(r.reason, Reason::no_answer);
    EXPECT_FALSE(b.profile.on_command(QuickStop{}).refused) << "a stop is tried all the same";
}

TEST(Cia402, PresenceChangeForgetsEverythingThatCouldMove) {
    Bench b;
    b.enable(mode_profile_velocity);
    ProcessData d;
    d.target_velocity = 500;
    b.data(d);
    b.profile.on_presence(Presence::device);
    b.drive.power = Power::on;
    b.say();
    const auto p = b.picture();
    EXPECT_EQ(p.controlword, 0);
    EXPECT_EQ(p.target_velocity, 0);
    EXPECT_EQ(p.statusword & sw_simulated, 0);
    b.profile.on_presence(Presence::twin);
    b.say();
    EXPECT_NE(b.picture().statusword & sw_simulated, 0);
    EXPECT_NE(b.picture().flags & flag_simulated, 0);
}

}  // namespace
}  // namespace axisgate
