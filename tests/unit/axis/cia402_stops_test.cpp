// A word that ends a motion or the power is followed whatever else it contains, and bit 12 answers bit 4 only. The words are those of real
// controllers, also to a drive that does not answer.
#include <algorithm>

#include "gateway/doors/http/words.hpp"
#include "tests/unit/axis/cia402_bench.hpp"

namespace axisgate {
namespace {
using namespace cia402;
using cia402_bench::Bench;
using Power = AxisFeedback::Power;

std::vector<std::uint16_t> words(std::initializer_list<int> list) {
    std::vector<std::uint16_t> out;
    for (const int w : list)
        out.push_back(static_cast<std::uint16_t>(w));
    return out;
}

template <class T>
bool has(const Cia402Axis::Decision& d) {
    return std::ranges::any_of(d.orders, [](const CommandBody& o) { return std::holds_alternative<T>(o); });
}

/// The drive does not answer any more, perhaps in the middle of a motion.
void fall_silent(Bench& b, bool enabled_before) {
    if (enabled_before) b.enable(mode_profile_position);
    b.profile.on_presence(Presence::offline);
}

void moving_to(Bench& b, std::int32_t target, std::uint16_t word = 0x1F) {
    ProcessData d;
    d.target_position = target;
    d.controlword = word;
    EXPECT_TRUE(has<Move>(b.data(d)));
}

TEST(Cia402Stops, AStopWithANewSetPointBesideItIsAStop) {
    for (const std::uint16_t word : words({0x1B, 0x10, 0x17, 0x16, 0x12, 0x11F, 0x3B})) {
        Bench b;
        b.enable(mode_profile_position);
        moving_to(b, 1000);
        b.word(0x0F);
        ProcessData d;
        d.target_position = 2000;
        d.controlword = word;
        const auto r = b.data(d);
        EXPECT_FALSE(r.refused) << std::hex << word;
        EXPECT_TRUE(has<QuickStop>(r) || has<Halt>(r) || has<Disable>(r)) << std::hex << word;
        EXPECT_FALSE(has<Move>(r)) << std::hex << word;
        EXPECT_FALSE(b.drive.moving && b.drive.power == Power::on) << std::hex << word;
    }
}

TEST(Cia402Stops, ASearchIsNotBegunByTheWordThatHalts) {
    Bench b;
    b.enable(mode_homing);
    const auto r = b.word(0x11F);
    EXPECT_TRUE(has<Halt>(r));
    EXPECT_FALSE(has<Home>(r));
}

TEST(Cia402Stops, AFaultIsResetByAWordWithBit4) {
    Bench b;
    b.enable(mode_profile_position);
    b.drive.fault = true;
    b.drive.error_code = 3;
    b.say();
    const auto r = b.word(0x9F);
    EXPECT_FALSE(r.refused);
    EXPECT_TRUE(has<ResetFault>(r));
    EXPECT_FALSE(has<Move>(r));
}

TEST(Cia402Stops, ASetPointToADriveThatIsOffIsStillRefused) {
    Bench b;
    ProcessData mode;
    mode.mode = mode_profile_position;
    b.data(mode);
    EXPECT_TRUE(b.word(0x10).refused);
    EXPECT_EQ(b.profile.state(), PowerState::switch_on_disabled);
}

TEST(Cia402Stops, WhatIsBeingSwitchedOnIsTakenBackByAnyLowerWord) {
    for (const std::uint16_t word : words({0x00, 0x02, 0x06, 0x07, 0x0B})) {
        Bench b;
        b.to(PowerState::switched_on);
        ProcessData on;
        on.controlword = 0x0F;
        const auto enabling = b.profile.on_process_data(on);
        ASSERT_TRUE(has<Enable>(enabling));
        ProcessData back;
        back.controlword = word;
        const auto off = b.profile.on_process_data(back);
        EXPECT_TRUE(has<Disable>(off)) << std::hex << word;
        b.obey(enabling);
        b.obey(off);
        EXPECT_NE(b.profile.state(), PowerState::operation_enabled) << std::hex << word;
        EXPECT_EQ(b.drive.power, Power::off) << std::hex << word;
    }
}

TEST(Cia402Stops, WithoutAnAnswerOnlyWhatStopsIsSent) {
    for (const bool seen_before : {false, true}) {
        for (const std::uint16_t word : words({0x00, 0x01, 0x05, 0x02, 0x0B, 0x1B, 0x10, 0x10F, 0x106})) {
            Bench b;
            fall_silent(b, seen_before);
            ProcessData d;
            d.controlword = word;
            const auto r = b.profile.on_process_data(d);
            EXPECT_FALSE(r.refused) << std::hex << word;
            ASSERT_EQ(r.orders.size(), 1U) << std::hex << word;
            EXPECT_TRUE(is_urgent(r.orders[0])) << std::hex << word;
            // The same word again is another attempt.
            if (!(word & cw_halt)) EXPECT_EQ(b.profile.on_process_data(d).orders.size(), 1U) << std::hex << word;
        }
        for (const std::uint16_t word : words({0x06, 0x07, 0x0F, 0x1F, 0x86, 0x8F, 0x9F})) {
            Bench b;
            fall_silent(b, seen_before);
            ProcessData d;
            d.controlword = word;
            const auto r = b.profile.on_process_data(d);
            EXPECT_TRUE(r.refused) << std::hex << word;
            EXPECT_EQ(r.reason, Reason::no_answer) << std::hex << word;
            EXPECT_EQ(b.picture().controlword, 0) << std::hex << word << ": a refused word is not taken";
        }
    }
}

TEST(Cia402Stops, ValuesAloneAreKeptWhileNobodyAnswers) {
    Bench b;
    b.profile.on_presence(Presence::offline);
    ProcessData d;
    d.profile_velocity = 77;
    EXPECT_FALSE(b.profile.on_process_data(d).refused);
    EXPECT_EQ(b.picture().profile_velocity, 77U);
}

TEST(Cia402Handshake, ABufferedSetPointThatStartsByItselfDoesNotAcknowledge) {
    Bench b;
    b.enable(mode_profile_position);
    moving_to(b, 1000);
    b.word(0x0F);
    ProcessData d;
    d.target_position = 2000;
    d.controlword = 0x1F;
    EXPECT_TRUE(b.data(d).orders.empty()) << "it waits";
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0);
    b.word(0x0F);
    EXPECT_NE(b.picture().statusword & sw_mode_12, 0) << "there is no room for another one";
    EXPECT_EQ(b.picture().setpoints_accepted, 2);
    b.drive.moving = false;
    b.drive.target_reached = true;
    const auto next = b.say();
    ASSERT_TRUE(next && std::holds_alternative<Move>(*next));
    b.profile.on_order_result(*next, true, b.now);
    EXPECT_EQ(b.picture().statusword & sw_mode_12, 0) << "bit 4 is 0";
    EXPECT_EQ(b.picture().setpoints_accepted, 2) << "it was counted when it was taken";
}

TEST(Cia402Handshake, TheEndOfAHaltGoesOnWithoutANewSetPoint) {
    Bench b;
    b.enable(mode_profile_position);
    moving_to(b, 1000);
    b.word(0x0F);
    b.word(0x10F);
    const auto on = b.word(0x0F);
    ASSERT_TRUE(has<Move>(on));
    EXPECT_EQ(b.picture().setpoints_accepted, 1);
    EXPECT_EQ(b.picture().statusword & sw_mode_12, 0);
    b.word(0x10F);
    ProcessData d;
    d.target_position = 3000;
    d.controlword = 0x1F;
    const auto both = b.data(d);
    ASSERT_EQ(both.orders.size(), 1U) << "the new one, not the old one before it";
    EXPECT_EQ(std::get<Move>(both.orders[0]).target, 3000);
    EXPECT_EQ(b.picture().setpoints_accepted, 2);
}

/// The target to which a halted axis would continue has another value when its position is set meanwhile.
TEST(Cia402Handshake, TheEndOfAHaltDoesNotGoOnToAPlaceByTheOldCount) {
    for (const bool taken : {true, false}) {
        Bench b;
        b.enable(mode_profile_position);
        moving_to(b, 1000);
        b.word(0x0F);
        b.word(0x10F);
        const auto set = b.profile.on_command(SetPosition{0});
        ASSERT_TRUE(has<SetPosition>(set));
        for (const auto& o : set.orders)
            b.profile.on_order_result(o, taken, b.now);
        b.say();
        EXPECT_EQ(has<Move>(b.word(0x0F)), !taken) << "a refusal changes nothing";
    }
}

/// A controller writes its speed in every cycle. This does not undo the action of another client; only another speed does.
TEST(Cia402Stops, ASpeedThatIsRepeatedDoesNotUndoWhatSomebodyElseHasDone) {
    Origin panel;
    panel.door = http::clients;
    panel.client = std::make_shared<const std::string>("panel");
    Move slow;
    slow.kind = Move::Kind::velocity;
    slow.target = 100;
    SetPoint streamed;
    streamed.mode = SetPoint::Mode::velocity;
    streamed.value = 100;
    for (const auto* what : {"a stop", "a motion", "a stream"}) {
        Bench b;
        b.enable(mode_profile_velocity);
        ProcessData d;
        d.controlword = 0x0F;
        d.target_velocity = 500;
        ASSERT_TRUE(has<Move>(b.data(d))) << what;
        if (what == std::string("a stop")) b.obey(b.profile.on_command(Halt{}, panel));
        if (what == std::string("a motion")) b.obey(b.profile.on_command(slow, panel));
        if (what == std::string("a stream")) {
            b.profile.follow(streamed);
            b.profile.end_following();
        }
        EXPECT_TRUE(b.data(d).orders.empty()) << what;
        EXPECT_TRUE(b.data(d).orders.empty()) << what << ", and again";
        d.target_velocity = 501;
        const auto r = b.data(d);
        ASSERT_TRUE(has<Move>(r)) << what;
        EXPECT_EQ(std::get<Move>(r.orders.back()).target, 501) << what;
    }
}

TEST(Cia402Stops, AModeThatIsRepeatedDoesNotEndWhatSomebodyElseIsAbout) {
    Origin panel;
    panel.door = http::clients;
    panel.client = std::make_shared<const std::string>("panel");
    Bench b;
    b.enable(mode_profile_velocity);
    Move m;
    m.kind = Move::Kind::absolute;
    m.target = 500;
    b.obey(b.profile.on_command(m, panel));
    ProcessData d;
    d.mode = mode_profile_velocity;
    (void)b.data(d);
    EXPECT_EQ(b.picture().mode, mode_profile_position);
    b.drive.moving = false;
    b.say();
    (void)b.data(d);
    EXPECT_EQ(b.picture().mode, mode_profile_velocity) << "at rest it is taken";
}

TEST(Cia402Stops, AnAxisThatRunsDownIsNotSwitchedOffWithEveryWord) {
    Bench b;
    b.enable(mode_profile_position);
    moving_to(b, 1000);
    EXPECT_TRUE(has<Disable>(b.word(0x00)));
    ASSERT_TRUE(b.drive.moving);
    EXPECT_TRUE(b.word(0x00).orders.empty());
    EXPECT_TRUE(has<Disable>(b.word(0x01))) << "another word that stops";
}

TEST(Cia402Stops, AFaultThatHasGoneDoesNotEnableByARepeatedWord) {
    Bench b;
    b.enable(mode_profile_position);
    b.drive.fault = true;
    b.say();
    b.drive.fault = false;
    b.drive.power = Power::off;
    b.drive.statusword = 0x21;  // ready to switch on, from which 0F enables
    b.say();
    ASSERT_EQ(b.profile.state(), PowerState::ready_to_switch_on);
    EXPECT_TRUE(b.word(0x0F).orders.empty());
    b.word(0x06);
    EXPECT_TRUE(has<Enable>(b.word(0x0F)));
}

TEST(Cia402Stops, AStopAtTheDriveIsNotUndoneByARepeatedSpeed) {
    Bench b;
    b.enable(mode_profile_velocity);
    ProcessData d;
    d.controlword = 0x0F;
    d.target_velocity = 500;
    ASSERT_TRUE(has<Move>(b.data(d)));
    b.drive.quick_stopping = true;
    b.drive.moving = false;
    b.say();
    ASSERT_EQ(b.profile.state(), PowerState::quick_stop_active);
    b.drive.quick_stopping = false;
    b.say();
    ASSERT_EQ(b.profile.state(), PowerState::operation_enabled);
    EXPECT_TRUE(b.data(d).orders.empty());
    d.target_velocity = 501;
    EXPECT_TRUE(has<Move>(b.data(d)));
}

TEST(Cia402Handshake, ACommandOfSomebodyElseDoesNotAcknowledge) {
    Bench b;
    b.enable(mode_profile_position);
    Move m;
    m.kind = Move::Kind::absolute;
    m.target = 500;
    b.obey(b.profile.on_command(m));
    EXPECT_EQ(b.picture().statusword & sw_mode_12, 0);
    EXPECT_EQ(b.picture().setpoints_accepted, 1);
}

TEST(Cia402Homing, ASearchThatStandsBetweenItsPartsIsUnderWay) {
    Bench b;
    b.enable(mode_homing);
    b.word(0x1F);
    b.drive.homing = true;
    b.drive.moving = false;
    b.say();
    EXPECT_EQ(b.picture().statusword & (sw_target_reached | sw_mode_12 | sw_mode_13), 0);
    EXPECT_FALSE(b.profile.at_rest());
    EXPECT_TRUE(has<Halt>(b.word(0x0F))) << "bit 4 falls: it is given up";
}

}  // namespace
}  // namespace axisgate
