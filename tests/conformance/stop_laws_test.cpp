// Laws of stops by registers, for every family: to a drive that receives and whose answers are lost, beside a wrong value, and the values
// that are shown then.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <memory>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class StopLaws : public Laws {
protected:
    [[nodiscard]] static ProcessData word(std::uint16_t cw) {
        ProcessData data;
        data.controlword = cw;
        return data;
    }
    const Result* write(const ProcessData& data) { return world->wait(world->command(a1, data), 10s); }
    using Laws::speed;
    double speed() { return speed(a1); }

    /// Enabled by registers, and turning: in mode 3, or to a far target in mode 1 if the drive has no velocity mode.
    void turn() {
        world = fresh();
        start();
        ProcessData mode;
        mode.mode = cia402::mode_profile_velocity;
        mode.profile_acceleration = mode.profile_deceleration = 20000;
        ASSERT_TRUE(good(*write(mode)));
        for (const int cw : {0x06, 0x07, 0x0F}) {
            const Result* r = write(word(static_cast<std::uint16_t>(cw)));
            ASSERT_TRUE(r && good(*r)) << published(r);
        }
        ProcessData go;
        go.target_velocity = 4000;
        const Result* r = write(go);
        if (r && r->reason == Reason::not_supported) {
            go = word(0x1F);
            go.mode = cia402::mode_profile_position;
            go.profile_velocity = 4000;
            go.target_position = 400'000;
            r = write(go);
        }
        ASSERT_TRUE(r && good(*r)) << published(r);
        ASSERT_TRUE(world->run_until_true([&] { return moving(a1) && now().velocity != 0; }, 5s));
        ASSERT_TRUE(world->run_until_true([&] { return speed() > 1000; }, 5s));
        world->run_for(500ms);
    }
    void fall_silent() {
        ASSERT_EQ(hand("silent", Value{true}), "");
        ASSERT_TRUE(world->run_until_true([&] { return !(world->picture(a1).flags & flag_online); }, 20s));
    }
};

TEST_P(StopLaws, AStopReachesADriveThatHearsAndIsNotHeard) {
    for (const int cw : {0x0B, 0x00, 0x1B}) {
        turn();
        fall_silent();
        ASSERT_GT(speed(), 1000) << "it goes on";
        const Result* r = write(word(static_cast<std::uint16_t>(cw)));
        ASSERT_TRUE(r) << "an answer within the time";
        EXPECT_FALSE(good(*r)) << "nobody has acknowledged it";
        EXPECT_EQ(r->reason, Reason::no_answer);
        EXPECT_TRUE(world->run_until_true([&] { return speed() == 0; }, 5s)) << "but it was heard: control word " << cw;
    }
}

TEST_P(StopLaws, WhatSwitchesOnIsRefusedWhileNobodyAnswers) {
    turn();
    fall_silent();
    const auto last = world->picture(a1);
    for (const int cw : {0x06, 0x07, 0x0F, 0x1F, 0x86}) {
        const Result* r = write(word(static_cast<std::uint16_t>(cw)));
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::refused) << cw;
        EXPECT_EQ(r->reason, Reason::no_answer) << cw;
    }
    EXPECT_EQ(world->picture(a1).controlword, 0);
    // Its last report stays, with its age; its present activity is unknown.
    EXPECT_TRUE(last.ever_seen);
    EXPECT_EQ(world->picture(a1).position, last.position);
    EXPECT_EQ(world->picture(a1).at, last.at);
    EXPECT_NE(last.position, 0);
    EXPECT_EQ(world->picture(a1).flags & (flag_online | flag_moving | flag_target_reached), 0);
    EXPECT_NE(world->picture(a1).flags & flag_stale, 0);
    ASSERT_EQ(hand("silent", Value{false}), "");
    EXPECT_TRUE(world->run_until_true([&] { return (world->picture(a1).flags & (flag_online | flag_stale)) == flag_online; }, 20s));
    EXPECT_GT(world->picture(a1).at, last.at);
}

TEST_P(StopLaws, AWrongValueBesideAStopDoesNotKeepItBack) {
    for (const int cw : {0x0B, 0x10F, 0x00}) {
        for (const bool bad_mode : {true, false}) {
            turn();
            ProcessData data = word(static_cast<std::uint16_t>(cw));
            if (bad_mode) {
                data.mode = 9;
            } else {
                data.target_velocity = std::numeric_limits<std::int32_t>::min();
            }
            const Result* r = write(data);
            ASSERT_TRUE(r);
            EXPECT_EQ(r->reason, Reason::out_of_range) << cw;
            EXPECT_TRUE(world->run_until_true([&] { return speed() == 0; }, 5s)) << cw;
        }
    }
}

TEST_P(StopLaws, AnEnableThatWaitsIsOverWithADisable) {
    // However far it has come: the newest order counts.
    for (int reads = 0; reads < 4; ++reads) {
        for (const Duration between : {0ms, 7ms, 30ms}) {
            world = fresh();
            start();
            const bool powered = mechanics(a1).powered;
            for (int i = 0; i < reads; ++i)
                (void)world->command(a1, ReadParameter{first_point(0)});
            const Ticket on = world->command(a1, Enable{}, true);
            world->run_for(between);
            const Ticket off = world->command(a1, Disable{}, true);
            const Result* r = world->wait(off, 10s);
            ASSERT_TRUE(r && good(*r)) << published(r);
            r = world->wait(on, 10s);
            ASSERT_TRUE(r) << "it has its answer";
            for (int i = 0; i < 40; ++i) {
                world->run_for(50ms);
                ASSERT_NE(power_state_of(now().statusword), PowerState::operation_enabled)
                    << reads << " reads before it, " << between.count() << " ns";
                if (!powered) ASSERT_FALSE(mechanics(a1).powered) << reads << " reads before it, " << between.count() << " ns";
            }
        }
    }
}

TEST_P(StopLaws, AStopOnALineThatIsDownSaysSo) {
    turn();
    world->apply(Site{});
    world->results.clear();
    site = world->apply(world->make_site(e, e.cable(), 1, "device"));
    a1 = site->axis_ids.at(0);
    world->run_for(500ms);
    world->cables.at("line")->cut(world->now);
    world->run_for(2s);
    for (const int cw : {0x00, 0x0B, 0x06, 0x0F}) {
        const Result* r = write(word(static_cast<std::uint16_t>(cw)));
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::refused) << cw;
        EXPECT_EQ(r->reason, Reason::line_down) << cw << " " << r->text;
        EXPECT_NE(r->text.find("line"), std::string::npos) << r->text;
    }
}

INSTANTIATE_TEST_SUITE_P(Families, StopLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
