// The demand with the encoder (EE = 1): computed from acknowledged orders, and each reason to have none.
// In: moves, a hand at the shaft, programs, somebody's text. Out: the demand and the following error of every feedback.
// Never bounds an error by more than a line's processing explains.
#include "adapters/mcode/tests/demand_bench.hpp"

namespace axisgate::mcode::test {
namespace {

TEST(McodeDemand, AGoodMoveWithTheEncoderFollows) {
    for (const std::uint32_t rate : {9600U, 115200U}) {
        for (const std::int64_t target : {12000, -9000}) {
            Track b("!", rate);
            b.encoder();
            EXPECT_EQ(b.worst(200ms, DemandSource::computed), 0);
            b.move(target, Move::Kind::absolute, 20000);
            EXPECT_LE(b.worst(1500ms, DemandSource::computed), latency(20000)) << rate << ' ' << target;
            EXPECT_EQ(b.at().position_demand, target);
            EXPECT_TRUE(b.at().target_reached);
            // At rest the demand stays, whatever the shaft does.
            b.hand(0, "position", Value{static_cast<double>(target + 40)});
            b.run(200ms);
            EXPECT_EQ(b.source(), DemandSource::computed);
            EXPECT_EQ(b.error(), -40);
            // The next motion begins where it is.
            b.hand(0, "position", Value{static_cast<double>(target + 400)});
            b.run(200ms);
            b.trail.clear();
            b.command(order(target - 2000, Move::Kind::absolute, 20000));
            b.run(1s);
            b.trail[0].erase(b.trail[0].begin(), std::ranges::find_if(b.trail[0], [](const auto& f) { return f.velocity != 0; }));
            EXPECT_GT(b.trail[0].size(), 3U);
            EXPECT_LE(b.worst(0ms, DemandSource::computed), latency(20000)) << rate << ' ' << target;
        }
    }
}

TEST(McodeDemand, SpeedsOfTheMoveAreThoseInForce) {
    Track b;
    b.encoder();
    Move m;
    m.target = 30000;
    m.velocity = 40000;
    m.acceleration = 30000;
    m.deceleration = 200000;
    EXPECT_TRUE(good(b.wait(m)));
    EXPECT_LE(b.worst(2500ms, DemandSource::computed), latency(40000));
    b.line("A=500000");  // somebody's text counts too
    b.line("VI=5000");
    b.run(200ms);
    b.trail.clear();
    b.move(0);
    EXPECT_LE(b.worst(2500ms, DemandSource::computed), latency(40000));
    EXPECT_EQ(b.at().position_demand, 0);
}

TEST(McodeDemand, ANewSpeedInMotionGoesOnFromWhereTheDemandIs) {
    Track b;
    b.encoder();
    for (const std::int64_t v : {10000, 40000, 15000, -20000, 5000, 0}) {
        b.move(v, Move::Kind::velocity);
        EXPECT_LE(b.worst(700ms, DemandSource::computed), latency(40000)) << v;
    }
    b.run(300ms);
    b.move(20000, Move::Kind::velocity);
    b.run(300ms);
    b.move(0, Move::Kind::absolute, 30000);  // stops first [L4110]
    EXPECT_LE(b.worst(2500ms, DemandSource::computed), latency(30000));
    EXPECT_EQ(b.at().position_demand, 0);
}

TEST(McodeDemand, HaltAndQuickStopBrakeTheDemand) {
    for (const bool quick : {false, true}) {
        Track b;
        b.encoder();
        b.move(20000, Move::Kind::velocity);
        b.run(500ms);
        const Ticket t = b.command(quick ? CommandBody{QuickStop{}} : CommandBody{Halt{}});
        EXPECT_LE(b.worst(600ms, DemandSource::computed), latency(20000)) << quick;
        ASSERT_TRUE(b.result(t));
        EXPECT_EQ(b.at().velocity, 0);
        EXPECT_EQ(b.error(), 0) << quick;
    }
}

TEST(McodeDemand, AStopOfTheWholeLineBrakesEveryDemand) {
    Track b("ab", 115200);
    for (const std::size_t i : {0U, 1U}) {
        b.encoder(i);
        b.move(20000, Move::Kind::velocity, {}, i);
    }
    b.run(500ms);
    const auto before = b.sent.size();
    for (int n = 0; n < 100 && b.sent.size() == before; ++n)
        b.run(1ms);  // a question is on the line: both stops wait behind it
    for (const std::size_t i : {0U, 1U})
        b.command(QuickStop{}, i);
    b.run(1s);
    EXPECT_TRUE(b.asked("*SL 0"));
    for (const std::size_t i : {0U, 1U}) {
        EXPECT_LE(b.worst(0ms, DemandSource::computed, i), latency(20000)) << i;
        EXPECT_EQ(b.at(i).velocity, 0);
    }
}

TEST(McodeDemand, AHeldShaftFallsBehind) {
    for (const int way : {1, -1}) {
        Track b;
        b.encoder();
        b.move(way * 40000, Move::Kind::absolute, 10000);
        b.run(1s);
        b.hand(0, "stall", Value{true});
        b.run(500ms);
        EXPECT_EQ(b.source(), DemandSource::computed);
        EXPECT_NEAR(static_cast<double>(b.error() * way), 5000, 300) << "10000 in a second, and one poll";
        b.run(500ms);
        EXPECT_NEAR(static_cast<double>(b.error() * way), 10000, 300);
    }
}

TEST(McodeDemand, AStallThatEndsTheMotionEndsTheDemand) {
    Track b;
    b.encoder();
    b.line("SF=200");
    b.move(40000, Move::Kind::absolute, 10000);
    b.run(1s);
    b.hand(0, "stall", Value{true});
    b.run(200ms);
    EXPECT_TRUE(b.only(DemandSource::none, 500ms));
    b.hand(0, "stall", Value{false});
    EXPECT_TRUE(good(b.wait(ResetFault{})));
    b.run(200ms);
    EXPECT_EQ(b.worst(200ms, DemandSource::computed), 0) << "where it stands";
}

TEST(McodeDemand, ALimitEndsTheDemand) {
    for (const std::string mode : {"LM=1", "LM=4"}) {  // with the ramp, and without
        Track b;
        b.encoder();
        b.line("LS=1,5000,1");
        b.line(mode);
        b.line("MT=1000");  // MV tells it late
        b.trail.clear();
        b.move(40000, Move::Kind::absolute, 10000);
        b.run(400ms);
        EXPECT_EQ(b.source(), DemandSource::computed) << mode;
        b.run(2s);
        EXPECT_TRUE(b.honest(800)) << mode << ": until the error is read";
        EXPECT_TRUE(b.only(DemandSource::computed, 200ms)) << mode << ": it stands again";
        EXPECT_EQ(b.error(), 0) << mode;
        EXPECT_LT(b.at().position_demand, 10000) << mode;
    }
}

/// V is 0 and MV still 1, as with a long MT: only the error tells that it is over. 71 (warm) ends nothing.
TEST(McodeDemand, AnErrorThatEndsAMotionEndsTheDemand) {
    for (const int code : {83, 84, 91, 96, 71}) {
        Bench b;
        auto& v = b.drives[0].values;
        v["EE"] = v["AT"] = v["DT"] = "1";
        v["BE"] = "0";
        b.up();
        b.run(3s);
        EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        b.run(100ms);
        EXPECT_TRUE(good(b.wait(order(5000, Move::Kind::velocity))));
        b.run(300ms);
        EXPECT_EQ(b.feedback[AxisId{0}].demand_source, DemandSource::computed) << code;
        v["V"] = "0";
        b.drives[0].er = code;
        b.run(300ms);
        EXPECT_EQ(b.feedback[AxisId{0}].demand_source, code == 71 ? DemandSource::computed : DemandSource::none) << code;
    }
}

TEST(McodeDemand, OffIsNoneAndOnIsHere) {
    Track b;
    b.encoder();
    b.move(4000);
    b.run(1s);
    EXPECT_EQ(b.wait(Disable{}).outcome, Outcome::done);
    EXPECT_TRUE(b.only(DemandSource::none, 200ms));
    b.hand(0, "position", Value{1234.0});
    EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    b.run(100ms);
    EXPECT_TRUE(b.only(DemandSource::computed, 200ms));
    EXPECT_EQ(b.error(), 0);
    EXPECT_EQ(b.at().position_demand, 1234);
    // Off by itself: too hot.
    b.hand(0, "temperature", Value{90.0});
    b.run(200ms);
    EXPECT_TRUE(b.only(DemandSource::none, 200ms));
    b.hand(0, "position", Value{2345.0});
    b.hand(0, "temperature", Value{20.0});
    EXPECT_TRUE(good(b.wait(ResetFault{})));
    EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    b.run(100ms);
    EXPECT_EQ(b.at().position_demand, 2345);
    EXPECT_EQ(b.source(), DemandSource::computed);
}

TEST(McodeDemand, WhatAProgramMovesHasNone) {
    Track b;
    b.encoder();
    EXPECT_TRUE(good(b.wait(Action{"program.download", "LB X1\nH 300\nVM=20000\nA=40000\nMR 8000\nH\nH 500\nE\n"})));
    b.line("IS=1,4,0");  // starts the program at address 1
    for (const bool by_input : {false, true}) {
        b.run(300ms);
        EXPECT_EQ(b.source(), DemandSource::computed);
        b.trail.clear();
        if (by_input) {
            b.hand(0, "active_inputs", Value{std::int64_t{1}});
        } else {
            EXPECT_TRUE(good(b.wait(Action{"program.start", "X1"})));
        }
        b.run(60ms);
        EXPECT_TRUE(b.only(DemandSource::none, 1400ms)) << by_input << ": also while it only waits";
        b.hand(0, "active_inputs", Value{std::int64_t{0}});
        b.run(1500ms);
        EXPECT_TRUE(b.only(DemandSource::computed, 200ms));
        EXPECT_EQ(b.error(), 0);
        EXPECT_EQ(b.at().position_demand, by_input ? 16000 : 8000);
    }
    // What it has set counts for the next move.
    b.move(0);
    EXPECT_LE(b.worst(2s, DemandSource::computed), latency(20000));
}

TEST(McodeDemand, WhatSomebodysTextMovesHasNone) {
    for (const std::string text : {"MR 8000", "MA 8000", "SL 4000", "MA 8000,0,1"}) {
        Track b;
        b.encoder();
        b.line(text);
        EXPECT_TRUE(b.honest(0)) << text;
        EXPECT_TRUE(b.only(DemandSource::none, 300ms)) << text;
        EXPECT_TRUE(good(b.wait(Halt{})));
        b.run(1s);
        EXPECT_TRUE(b.only(DemandSource::computed, 200ms));
        EXPECT_EQ(b.error(), 0) << text;
    }
}

/// Nothing of it came over the line: speed and MV tell.
TEST(McodeDemand, WhatAnInputMovesHasNone) {
    Track b;
    b.encoder();
    b.line("IS=1,7,0");
    b.line("VM=10000");
    b.line("JE=1");
    b.run(200ms);
    EXPECT_EQ(b.source(), DemandSource::computed);
    b.hand(0, "active_inputs", Value{std::int64_t{1}});
    b.run(150ms);
    EXPECT_TRUE(b.only(DemandSource::none, 500ms));
    b.hand(0, "active_inputs", Value{std::int64_t{0}});
    b.run(1s);
    EXPECT_TRUE(b.only(DemandSource::computed, 200ms));
    EXPECT_EQ(b.error(), 0);
    // Shorter than a poll: only the time for settling is left of it.
    b.line("A=40000000");
    b.line("D=40000000");
    b.run(200ms);
    const auto before = b.at().position;
    b.hand(0, "active_inputs", Value{std::int64_t{1}});
    b.now += 8ms;
    b.hand(0, "active_inputs", Value{std::int64_t{0}});
    b.run(600ms);
    EXPECT_NE(b.at().position, before);
    EXPECT_EQ(b.error(), 0);
}

TEST(McodeDemand, AnOrderThatNobodyAcknowledgesHasNone) {
    Track b;
    b.encoder();
    bool lose = true;
    b.on_way = [&](std::string s) {
        if (lose && s.starts_with("MA")) b.on_cable = [&](std::string) { return std::string(); };
        return s;
    };
    Move m;
    m.target = 20000;
    m.velocity = 10000;
    const Ticket t = b.command(m);
    b.run(100ms);
    lose = false;
    b.on_cable = nullptr;
    b.run(500ms);
    EXPECT_TRUE(b.result(t));
    EXPECT_TRUE(b.honest(0));
    EXPECT_TRUE(b.only(DemandSource::none, 500ms));
    b.run(3s);
    EXPECT_TRUE(b.only(DemandSource::computed, 200ms));
    EXPECT_EQ(b.error(), 0);
    EXPECT_EQ(b.at().position_demand, 20000);
}

TEST(McodeDemand, ARefusedOrderChangesNothing) {
    Track b;
    b.encoder();
    b.move(10000, Move::Kind::velocity);
    b.run(300ms);
    Move m;
    m.kind = Move::Kind::velocity;
    m.target = 300000;  // above 200000 [L5406]
    EXPECT_EQ(b.wait(m).outcome, Outcome::refused);
    EXPECT_LE(b.worst(300ms, DemandSource::computed), latency(10000));
}

TEST(McodeDemand, HomingHasNoneUntilItStandsAtItsZero) {
    Track b;
    b.encoder();
    b.move(1500);
    b.run(1s);
    b.line("VM=2000");
    b.trail.clear();
    EXPECT_TRUE(good(b.wait(Home{33})));
    EXPECT_TRUE(b.honest(0));
    EXPECT_TRUE(b.only(DemandSource::none, 300ms));
    b.run(8s);
    EXPECT_TRUE(b.at().homing_attained);
    EXPECT_TRUE(b.honest(0));
    EXPECT_TRUE(b.only(DemandSource::computed, 200ms));
    EXPECT_EQ(b.at().position_demand, 0);
}

TEST(McodeDemand, APositionThatIsSetIsWhereItRests) {
    Track b;
    b.encoder();
    b.move(4000);
    b.run(1s);
    b.hand(0, "position", Value{4030.0});
    b.run(100ms);
    EXPECT_EQ(b.error(), -30);
    EXPECT_EQ(b.wait(SetPosition{-70000}).outcome, Outcome::done);
    b.run(100ms);
    b.trail.clear();
    EXPECT_EQ(b.worst(200ms, DemandSource::computed), 0);
    EXPECT_EQ(b.at().position_demand, -70000);
}

TEST(McodeDemand, ACountThatRollsOverIsNoError) {
    Track b;
    b.encoder();
    EXPECT_EQ(b.wait(SetPosition{2147483000}).outcome, Outcome::done);
    b.trail.clear();
    b.move(10000, Move::Kind::velocity);
    EXPECT_LE(b.worst(1s, DemandSource::computed), latency(10000));
    EXPECT_LT(b.at().position, 0);
}

/// The job ends before its motion is acknowledged: whether the drive has it is not known.
TEST(McodeDemand, AStopThatComesIntoAnOrderLeavesNoWrongDemand) {
    for (int after_ms = 0; after_ms < 12; ++after_ms) {
        Track b("!", 9600);
        b.encoder();
        b.move(0, Move::Kind::absolute, 20000);
        b.line("A=2000000");
        b.line("D=100000");
        b.run(300ms);
        b.trail.clear();
        Move m;
        m.target = 40000;
        b.command(m);
        for (int n = 0; n < 300 && !b.asked("MA 40000"); ++n)
            b.run(1ms);
        ASSERT_TRUE(b.asked("MA 40000"));
        b.run(after_ms * 3ms);
        b.command(Halt{});
        b.run(1200ms);
        EXPECT_TRUE(b.honest(latency(20000))) << after_ms;
        EXPECT_EQ(b.source(), DemandSource::computed) << after_ms;
    }
}

/// Below firmware 6 there are neither S ramps nor backlash, and no words for them [L1030, L1031].
TEST(McodeDemand, OldFirmwareIsNotAskedForWhatItDoesNotKnow) {
    for (const std::string version : {"LMDCM 5.013, Hw: 3.2", "LMDCM 6.002, Hw: 3.2"}) {
        Bench b;
        b.drives[0].values["EE"] = "1";
        b.drives[0].values["VR"] = version;
        b.up();
        b.run(3s);
        EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        b.run(100ms);
        EXPECT_EQ(b.feedback[AxisId{0}].demand_source, DemandSource::computed) << version;
        const auto count = std::ranges::count_if(b.sent, [](const std::string& s) { return s.find("BE,") != std::string::npos; });
        EXPECT_EQ(count > 0, version[6] == '6') << version;
        EXPECT_LE(count, 3) << version << ": and not again and again";
    }
}

TEST(McodeDemand, SRampsAndBacklashAreNotReckoned) {
    for (const std::string text : {"AT=2", "DT=3", "BE=1"}) {
        Track b;
        b.encoder();
        b.line(text);
        b.run(300ms);
        EXPECT_EQ(b.source(), DemandSource::computed) << text << ": at rest";
        b.trail.clear();
        b.move(8000, Move::Kind::absolute, 10000);
        EXPECT_TRUE(b.honest(0)) << text;
        EXPECT_TRUE(b.only(DemandSource::none, 500ms)) << text;
        b.run(1s);
        EXPECT_TRUE(b.only(DemandSource::computed, 200ms)) << text;
        EXPECT_EQ(b.error(), 0) << text;
    }
    // Nobody tells.
    Bench b;
    b.drives[0].values["EE"] = "1";
    b.up();
    b.run(3s);
    EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
    b.run(100ms);
    EXPECT_EQ(b.feedback[AxisId{0}].demand_source, DemandSource::computed);
    EXPECT_TRUE(good(b.wait(order(5000, Move::Kind::velocity))));
    b.run(300ms);
    EXPECT_EQ(b.feedback[AxisId{0}].demand_source, DemandSource::none);
}

}  // namespace
}  // namespace axisgate::mcode::test
