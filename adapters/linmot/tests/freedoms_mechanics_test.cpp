// The freedoms of the mechanics: the slider is not where its demand is, and without them the same steps end otherwise.
#include <algorithm>

#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {
using Options = Bench::Options;
constexpr std::int64_t slow_speed = 100'000, fast_speed = 500'000, steep = 1'000'000;  // 0.1 m/s, 0.5 m/s, 10 m/s2

TEST(LinmotFreedoms, TheSliderFollowsBehindItsDemandAndOvershoots) {
    Bench b(Options{{"follow_ms", "4"}});
    b.enable();
    b.motion("010xh", {500'000, slow_speed, steep, steep});
    b.run(300ms);
    EXPECT_NEAR(b.demand() - b.position(), 8000, 1500) << "twice 4 ms at 0.1 m/s";
    b.run(1s);
    EXPECT_EQ(b.position(), 500'000);
    const auto highest = [](const char* damping) {
        Bench c(Options{{"follow_ms", "10"}, {"damping_percent", damping}});
        c.drive().memory.set_ram(0x1473, 200'000);
        c.drive().memory.set_ram(0x1475, 200'000);
        c.enable();
        c.motion("010xh", {100'000, fast_speed, 10 * steep, 10 * steep});
        double most = 0;
        for (int i = 0; i < 500; ++i) {
            c.run(1ms);
            most = std::max(most, c.position());
        }
        return most;
    };
    EXPECT_LE(highest("100"), 100'010) << "a micrometre of the integration";
    EXPECT_GT(highest("30"), 100'200);
}

TEST(LinmotFreedoms, AWeakMotorEndsInThePositionLagError) {
    Bench strong, weak(Options{{"most_acceleration", "20000000"}});  // 2 m/s2
    for (Bench* b : {&strong, &weak}) {
        b->enable();
        b->motion("010xh", {5'000'000, fast_speed, steep, steep});  // 10 m/s2
        b->run(2s);
    }
    EXPECT_EQ(strong.position(), 5'000'000);
    EXPECT_EQ(weak.drive().state_var(), 0x040B) << "it could not follow";
    Bench gentle(Options{{"most_acceleration", "20000000"}});
    gentle.enable();
    gentle.motion("010xh", {500'000, slow_speed, steep / 10, steep / 10});  // 1 m/s2
    gentle.run(2s);
    EXPECT_EQ(gentle.state(), 8);
    EXPECT_NEAR(gentle.position(), 500'000, 1);
}

TEST(LinmotFreedoms, FrictionBacklashAndNoise) {
    Bench sticks(Options{{"friction_increments", "15"}, {"follow_ms", "4"}});
    sticks.enable();
    sticks.motion("010xh", {100'000, slow_speed, steep, steep});
    sticks.run(2s);
    EXPECT_NE(sticks.position(), 100'000);
    EXPECT_NEAR(sticks.position(), 100'000, 16);
    Bench plays(Options{{"backlash_increments", "60"}});
    plays.enable();
    for (const auto& [to, shown] : {std::pair{100'000, 99'970}, {50'000, 50'030}}) {
        plays.motion("010xh", {to, slow_speed, steep, steep});
        plays.run(2s);
        EXPECT_EQ(plays.position(), shown);
    }
    Bench noisy(Options{{"noise_increments", "3"}});
    double low = 0, high = 0;
    for (int i = 0; i < 100; ++i) {
        noisy.run(1ms);
        low = std::min(low, noisy.position()), high = std::max(high, noisy.position());
    }
    EXPECT_EQ(low, -3);
    EXPECT_EQ(high, 3);
}

TEST(LinmotFreedoms, WithoutPowerItDriftsAndEnablingDoesNotMoveIt) {
    Bench b(Options{{"drift_increments", "20000"}});
    b.enable();
    b.motion("010xh", {100'000, slow_speed, steep, steep});
    b.run(2s);
    EXPECT_EQ(b.position(), 100'000);
    b.control(0x3E);
    b.run(5s);
    EXPECT_NEAR(b.position(), 120'000, 5);
    const double here = b.position();
    b.enable();
    b.run(1s);
    EXPECT_NEAR(b.position(), here, 1);
    b.motion("010xh", {0, slow_speed, steep, steep});
    b.run(3s);
    EXPECT_EQ(b.position(), 0);
}

TEST(LinmotFreedoms, TheHomeSwitchHasAHysteresis) {
    const auto home_from = [](std::int64_t place, Options options) {
        Bench b(std::move(options));
        (void)b.hand("position", Value{place});
        b.enable();
        b.control(0x083F);
        b.run(20s);
        EXPECT_EQ(b.drive().state_var(), 0x090F);
        EXPECT_EQ(b.position(), 0);
        return b.drive().mechanics().position;
    };
    const Options with{{"switch_hysteresis_increments", "300"}};
    EXPECT_EQ(home_from(200'000, with), 0);
    EXPECT_EQ(home_from(-200'000, with), 300);
    EXPECT_EQ(home_from(-200'000, {}), 0);
}

}  // namespace
}  // namespace axisgate::linmot::test
