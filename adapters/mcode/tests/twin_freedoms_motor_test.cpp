// The freedoms of the motor and its mechanics: counters, encoder, lag, force, friction, play, noise, drift, switches.
#include "adapters/mcode/tests/twin_freedoms_bench.hpp"

namespace axisgate::mcode::twin::test {
namespace {

TEST(TwinFreedomsMotor, CountersStartAnywhere) {
    FreeDrive d({{"counter_start", 1234}, {"encoder_start", 77}});
    EXPECT_EQ(d.number("C1"), 1234);
    EXPECT_EQ(d.number("P"), 1234);
    EXPECT_EQ(d.number("C2"), 77);
    d.lines({"MR 5120"});
    d.pass(milliseconds(2000));
    EXPECT_EQ(d.number("P"), 6354);
    EXPECT_EQ(d.number("C2"), 477);
    (void)d.bytes("\x03");
    EXPECT_EQ(d.number("P"), 1234) << "also after CTRL+C";
    d.lines({"EE=1"});
    EXPECT_EQ(d.number("P"), 77);
}

TEST(TwinFreedomsMotor, AnEncoderOf512Lines) {
    FreeDrive d({{"encoder_lines", 512}});
    d.lines({"MR 51200"});
    d.pass(milliseconds(3000));
    EXPECT_EQ(d.number("C2"), 2048);
    d.lines({"EE=1"});
    EXPECT_EQ(d.number("A"), 40000) << "the figure of the detail pages [E-16]";
    EXPECT_EQ(d.number("VI"), 40);
    EXPECT_EQ(d.number("VM"), 30720);
}

/// Steps that the encoder is behind the command, of one instant.
double lag(FreeDrive& d) {
    const std::string both = d.ask("PR C1,\" \",C2");
    return std::stod(both) - 12.8 * std::stod(both.substr(both.find(' ')));
}

TEST(TwinFreedomsMotor, TheRotorLagsWhileItIsAccelerated) {
    FreeDrive d({{"follow_ms", 10}});
    d.lines({"MR 1000000"});
    d.pass(milliseconds(400));
    // 1e6 steps/s^2 times (10 ms)^2 are 100 steps; 12.8 steps are a count.
    EXPECT_NEAR(lag(d), 100, 13);
    const double steps = d.number("C1");
    EXPECT_NEAR(steps - d.place(), 100, 5);
    d.pass(milliseconds(600));  // constant speed
    EXPECT_NEAR(lag(d), 0, 8);
    d.pass(milliseconds(4000));
    EXPECT_EQ(d.number("C2"), 78125);
    FreeDrive plain({});
    plain.lines({"MR 1000000"});
    plain.pass(milliseconds(400));
    EXPECT_NEAR(lag(plain), 0, 7);
}

TEST(TwinFreedomsMotor, ALagBeyondSfIsAStall) {
    FreeDrive d({{"follow_ms", 16}});
    d.lines({"EE=1", "MR 40000"});  // 256 steps of lag are 20 counts, and SF is 15
    d.pass(milliseconds(300));
    EXPECT_EQ(d.number("ST"), 1);
    EXPECT_EQ(d.number("ER"), 86);
    d.pass(milliseconds(3000));
    const double stood = d.number("P");
    EXPECT_LT(stood, 10000);
    d.lines({"ST=0", "SF=40", "MR 40000"});
    d.pass(milliseconds(6000));
    EXPECT_EQ(d.number("ST"), 0);
    EXPECT_NEAR(d.number("P"), stood + 40000, 1);
}

TEST(TwinFreedomsMotor, WithLittleDampingItRings) {
    const auto beyond = [](std::int64_t damping) {
        FreeDrive d({{"follow_ms", 16}, {"damping_percent", damping}});
        d.lines({"VI=20000", "MR 5120"});
        double most = 0;
        for (int n = 0; n < 700; ++n) {
            d.pass(milliseconds(1));
            most = std::max(most, d.place());
        }
        EXPECT_NEAR(d.place(), 5120, 1) << damping;
        return most - 5120;
    };
    EXPECT_GT(beyond(20), 100);
    EXPECT_GT(beyond(20), 2 * beyond(100));
}

TEST(TwinFreedomsMotor, AMotorThatIsTooWeakLosesStepsWithoutAnEncoder) {
    FreeDrive d({{"most_acceleration", 1200000}});
    d.lines({"MR 512000"});
    d.pass(milliseconds(5000));
    EXPECT_NEAR(d.place(), 512000, 1) << "the factory A is not too much";
    d.lines({"A=3000000", "D=3000000", "MR 512000"});
    d.pass(milliseconds(5000));
    EXPECT_EQ(d.number("P"), 1024000) << "nobody has noticed";
    EXPECT_EQ(d.number("EF"), 0);
    EXPECT_LT(d.place(), 700000);
    EXPECT_LT(d.number("C2"), 700000 / 12.8);
    const double lost = d.number("P") - d.place();
    d.lines({"A=1000000", "D=1000000", "MR -512000"});
    d.pass(milliseconds(5000));
    EXPECT_NEAR(d.number("P") - d.place(), lost, 1) << "what is lost stays lost, and the motor runs again";
}

TEST(TwinFreedomsMotor, AMotorThatIsTooWeakStallsWithAnEncoder) {
    FreeDrive d({{"most_acceleration", 1200000}});
    d.lines({"EE=1", "MR 40000"});
    d.pass(milliseconds(5000));
    EXPECT_EQ(d.number("EF"), 0);
    EXPECT_EQ(d.number("P"), 40000);
    d.lines({"A=400000", "MR 40000"});
    d.pass(milliseconds(5000));
    EXPECT_EQ(d.number("ST"), 1);
    EXPECT_EQ(d.number("ER"), 86);
    EXPECT_LT(d.number("P"), 60000);
}

TEST(TwinFreedomsMotor, FrictionKeepsTheRotorFromItsPlace) {
    FreeDrive d({{"friction_increments", 200}, {"follow_ms", 8}});
    d.lines({"MR 10000"});
    d.pass(milliseconds(2000));
    const double off = 10000 - d.place();
    EXPECT_NE(off, 0);
    EXPECT_LE(std::abs(off), 201);
    EXPECT_EQ(d.number("P"), 10000) << "steps were given";
    FreeDrive counted({{"friction_increments", 200}, {"follow_ms", 8}});
    counted.lines({"EE=1", "MT=100", "MR 800"});
    counted.pass(milliseconds(5000));
    const bool came = std::abs(counted.number("P") - 800) <= 1;
    EXPECT_TRUE(came || counted.number("ER") == 92) << "corrected, or told: " << counted.number("P");
}

TEST(TwinFreedomsMotor, PlayStandsBetweenMotorAndEncoder) {
    FreeDrive d({{"backlash_increments", 256}});
    d.lines({"MR 12800"});
    d.pass(milliseconds(2000));
    EXPECT_EQ(d.number("C2"), 990) << "half of 20 counts behind";
    d.lines({"MR -12800"});
    d.pass(milliseconds(2000));
    EXPECT_EQ(d.number("C2"), 10);
    EXPECT_EQ(d.number("C1"), 0);
    FreeDrive counted({{"backlash_increments", 256}});
    counted.lines({"EE=1", "MT=50", "MR 1000"});
    counted.pass(milliseconds(5000));
    EXPECT_NEAR(counted.number("P"), 1000, 1) << "the drive corrects it";
    EXPECT_EQ(counted.number("ER"), 0);
}

TEST(TwinFreedomsMotor, TheEncoderFlickers) {
    FreeDrive d({{"noise_increments", 13}});
    std::map<double, int> seen;
    for (int n = 0; n < 100; ++n) {
        ++seen[d.number("C2")];
        d.pass(milliseconds(7));
    }
    EXPECT_GE(seen.size(), 2U);
    for (const auto& [value, times] : seen)
        EXPECT_LE(std::abs(value), 1);
    EXPECT_EQ(d.number("C1"), 0);
}

TEST(TwinFreedomsMotor, WithoutCurrentTheShaftDrifts) {
    FreeDrive d({{"drift_increments", 1280}});
    d.lines({"EE=1", "DE=0"});
    d.pass(milliseconds(2000));
    EXPECT_NEAR(d.number("P"), 100, 1);
    EXPECT_NEAR(d.place(), 100, 1);
    d.lines({"DE=1"});
    d.pass(milliseconds(1000));
    EXPECT_NEAR(d.number("P"), 0, 1) << "the field pulls it back";
}

TEST(TwinFreedomsMotor, ASwitchOpensBehindWhereItHasClosed) {
    const auto opens = [](std::int64_t hysteresis) {
        FreeDrive d({{"switch_hysteresis_increments", hysteresis}});
        d.lines({"IS=1,1,1", "VM=10000", "A=100000000", "D=100000000"});
        d.hand("home_position", 0.1);
        d.lines({"MR 6000"});
        d.pass(milliseconds(3000));
        EXPECT_EQ(d.number("I1"), 1);
        d.lines({"SL -5120"});
        for (int n = 0; n < 1000 && d.number("I1") == 1; ++n)
            d.pass(milliseconds(1));
        return d.number("P");
    };
    EXPECT_NEAR(opens(0), 5120, 12);
    EXPECT_NEAR(opens(300), 4820, 12);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
