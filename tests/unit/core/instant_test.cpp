// Sums and differences of unchecked times are limited to 64 bits.
#include "gateway/core/instant.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {

TEST(Instant, TimesThatNobodyHasCheckedEndWhereTheirBitsEnd) {
    constexpr std::int64_t high = INT64_MAX, low = INT64_MIN;
    EXPECT_EQ(saturated_sum(3, -5), -2);
    EXPECT_EQ(saturated_sum(high - 1, 1), high);
    EXPECT_EQ(saturated_sum(high, 1), high);
    EXPECT_EQ(saturated_sum(low, -1), low);
    EXPECT_EQ(saturated_sum(low, high), -1);
    EXPECT_EQ(saturated_difference(3, 5), -2);
    EXPECT_EQ(saturated_difference(low, 1), low);
    EXPECT_EQ(saturated_difference(high, -1), high);
    EXPECT_EQ(saturated_difference(0, low), high);
    EXPECT_EQ(saturated_difference(low, low), 0);
}

}  // namespace
}  // namespace axisgate
