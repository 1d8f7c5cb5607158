// The way from one cyclic target to the next: no step beyond the ramps, no target passed.
#include "gateway/drive/lead.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace axisgate::drive::test {
namespace {
constexpr LeadRamps ramps{.velocity = 10'000, .acceleration = 50'000, .deceleration = 100'000};

TEST(Lead, NoStepIsBeyondTheRampsAndTheTargetIsNotPassed) {
    for (const double cycle : {0.001, 0.002, 0.004, 0.02}) {
        for (const double target : {1.0, 37.0, 5000.0, -5000.0, 100'000.0}) {
            SCOPED_TRACE(target);
            Lead lead;
            lead.begin(100);
            double before = 100, speed = 0;
            int cycles = 0;
            for (; cycles < 100'000 && lead.place() != target; ++cycles) {
                const double at = lead.towards(target, ramps, cycle);
                const double v = (at - before) / cycle;
                ASSERT_LE(std::fabs(v), ramps.velocity * 1.001);
                ASSERT_LE(std::fabs(v - speed), (std::fabs(v) > std::fabs(speed) ? 1.001 : 3.001) * 100'000 * cycle + 0.6 / cycle)
                    << "a step";
                ASSERT_LE((at - target) * std::copysign(1, target - 100), 0.5) << "beyond";
                before = at, speed = v;
            }
            EXPECT_EQ(lead.place(), target);
            EXPECT_LT(cycles * cycle, std::fabs(target - 100) / ramps.velocity + 0.5) << "and it takes no longer than it must";
        }
    }
}

TEST(Lead, ASpeedIsReachedByItsRampAndLeftByTheOther) {
    Lead lead;
    lead.begin(0);
    for (int i = 0; i < 100; ++i)
        lead.speed_towards(5000, ramps, 0.001);
    EXPECT_DOUBLE_EQ(lead.velocity(), 5000);
    lead.speed_towards(0, ramps, 0.001);
    EXPECT_DOUBLE_EQ(lead.velocity(), 4900);
}

TEST(Lead, ACycleOfNothingChangesNothing) {
    Lead lead;
    lead.begin(7);
    EXPECT_EQ(lead.towards(100, ramps, 0), 7);
}

}  // namespace
}  // namespace axisgate::drive::test
