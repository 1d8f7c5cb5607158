// Where the axis should be where nobody measures (open loop), where the drive tells (hMT), and where nobody aims (torque).
// In: moves, a hand at the shaft, drives that answer oddly. Out: the demand of every feedback, and what was asked for it.
// Never takes a demand from anything but the adapter's feedback.
#include "adapters/mcode/tests/demand_bench.hpp"

namespace axisgate::mcode::test {
namespace {

// --- nobody measures -------------------------------------------------------------------------------------------------------------

TEST(McodeDemand, APlainStepperCountsItsOwnSteps) {
    for (const std::string product : {"LMDC", "LMDO"}) {
        Track b("!", 115200, {{"product", product}});
        EXPECT_EQ(b.before_enable, DemandSource::none) << product << ": DE is 1, but nobody has enabled it";
        EXPECT_TRUE(b.only(DemandSource::open_loop, 200ms)) << product;
        b.move(400000);
        EXPECT_TRUE(b.only(DemandSource::open_loop, 200ms)) << product;
        b.hand(0, "stall", Value{true});
        EXPECT_TRUE(b.only(DemandSource::open_loop, 200ms)) << product << ": it cannot know";
        EXPECT_EQ(b.error(), 0) << product;
        EXPECT_FALSE(b.asked(",LL")) << product;
        EXPECT_FALSE(b.asked("BE,")) << product;
        EXPECT_EQ(b.wait(Disable{}).outcome, Outcome::done);
        EXPECT_TRUE(b.only(DemandSource::none, 200ms)) << product;
    }
}

TEST(McodeDemand, TorqueModeAimsAtNothing) {
    Track b;
    b.line("TS=51200");
    for (const std::string from : {"0", "1"}) {
        b.line("AS=" + from);
        b.run(200ms);
        EXPECT_EQ(b.asked(",LL"), from == "1");
        b.line("AS=3");
        EXPECT_EQ(b.source(), DemandSource::none) << from << ": from the first word on";
        EXPECT_TRUE(b.only(DemandSource::none, 500ms)) << from;
        EXPECT_TRUE(good(b.wait(Halt{})));
        b.run(1s);
    }
}

// --- the drive tells -------------------------------------------------------------------------------------------------------------

TEST(McodeDemand, ClosedLoopTellsItsLag) {
    for (const int mode : {1, 2}) {
        Track b;
        b.line(fmt::format("AS={}", mode));
        b.run(200ms);
        EXPECT_TRUE(b.asked(",LL")) << mode;
        b.trail.clear();
        b.move(300000);
        EXPECT_EQ(b.worst(2s, DemandSource::drive), 0) << mode;
        EXPECT_EQ(b.at().position, 300000);
        EXPECT_EQ(b.at().position_demand, 300000);
        EXPECT_EQ(b.wait(Disable{}).outcome, Outcome::done);
        EXPECT_TRUE(b.only(DemandSource::none, 200ms)) << mode;
    }
}

/// LL is positive when the rotor is behind: ahead of the position in the direction of the motion lies the demand.
TEST(McodeDemand, LagLiesInTheDirectionOfTheMotion) {
    for (const int way : {1, -1}) {
        for (const bool reverses : {false, true}) {
            const auto what = fmt::format("{} {}", way, reverses);
            Track b;
            b.line("AS=1");
            b.line("MU=1");
            b.line("LG=2000000000");
            b.line("LT=60000");
            if (reverses) {
                b.move(-way * 50000, Move::Kind::velocity);
                b.run(500ms);
            }
            b.move(way * 50000, Move::Kind::velocity);
            b.run(1s);
            b.hand(0, "stall", Value{true});
            const Instant held = b.now;
            b.run(400ms);
            const auto early = b.error() * way;
            EXPECT_NEAR(static_cast<double>(early), 50000 * 0.4, 50000 * 0.03) << what;
            b.run(400ms);
            const double grown = 50000 * std::chrono::duration<double>(b.now - held).count();
            EXPECT_NEAR(static_cast<double>(b.error() * way), grown, 50000 * 0.03) << what << ": one poll of latency";
            EXPECT_TRUE(good(b.wait(Halt{})));
            b.run(500ms);
            EXPECT_GT(b.error() * way, 40000) << what << ": also when the command is over";
            EXPECT_EQ(b.source(), DemandSource::drive);
            b.hand(0, "stall", Value{false});
            b.run(2s);
            EXPECT_EQ(b.error(), 0) << what;
        }
    }
}

TEST(McodeDemand, ALockedRotorAimsAtNothing) {
    Track b;
    b.line("AS=1");
    b.line("LT=300");
    b.move(50000, Move::Kind::velocity);
    b.run(500ms);
    b.hand(0, "stall", Value{true});
    b.run(200ms);
    EXPECT_EQ(b.source(), DemandSource::drive);
    b.run(300ms);
    EXPECT_TRUE(b.only(DemandSource::none, 200ms)) << "its bridges are off";
}

TEST(McodeDemand, ADriveThatDoesNotTellItsLagIsPolledAsBefore) {
    for (const std::string answer : {"", "x", "1,2"}) {
        Bench b;
        b.up();
        b.run(2s);
        EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        b.run(100ms);
        b.drives[0].values["AS"] = "1";
        if (!answer.empty()) b.drives[0].values["LL"] = answer;
        b.run(2s);
        b.drives[0].values["P"] = "4711";
        b.run(500ms);
        EXPECT_TRUE(b.online()) << answer;
        EXPECT_EQ(b.feedback[AxisId{0}].power, AxisFeedback::Power::on) << answer << ": nor was it looked for anew";
        EXPECT_EQ(b.feedback[AxisId{0}].position, 4711) << answer;
        EXPECT_EQ(b.feedback[AxisId{0}].demand_source, DemandSource::none) << answer;
        b.drives[0].values["LL"] = "-12";
        b.run(12s);
        EXPECT_EQ(b.feedback[AxisId{0}].demand_source, DemandSource::drive) << answer;
        EXPECT_EQ(b.feedback[AxisId{0}].position_demand, 4699) << answer;
    }
}

/// With hMT motion is in step pulses whatever EE says [L696], so LL counts; without it P is in counts, and LL is not asked for.
TEST(McodeDemand, LagAndEncoderCountsAreNotMixed) {
    for (const char* as : {"0", "1"}) {
        Bench b;
        b.drives[0].values["EE"] = "1";
        b.drives[0].values["AS"] = as;
        b.drives[0].values["LL"] = "500";
        b.up();
        b.run(3s);
        EXPECT_EQ(b.wait(Enable{}).outcome, Outcome::done);
        b.run(100ms);
        EXPECT_TRUE(b.online());
        const bool steps = as[0] == '1';
        const AxisFeedback& f = b.feedback[AxisId{0}];
        EXPECT_EQ(f.demand_source == DemandSource::drive, steps) << as;
        EXPECT_EQ(f.position_demand - f.position, steps ? 500 : 0) << as;
        EXPECT_EQ(std::ranges::any_of(b.sent, [](const std::string& s) { return s.find(",LL") != std::string::npos; }), steps) << as;
    }
}

}  // namespace
}  // namespace axisgate::mcode::test
