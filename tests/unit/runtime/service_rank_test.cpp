// The service thread has its rank for 30 of 50 milliseconds at most, and again in the next ones.
#include "gateway/runtime/service_rank.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {
using namespace std::chrono_literals;

TEST(ServiceRank, IsKeptForAPartOfAWindowAndGivenAgainInTheNext) {
    ServiceRank rank;
    Instant now = at_ns(1'000'000'000);
    Duration used = 3s;  // time that was used before does not count
    EXPECT_TRUE(rank.may_go_first(now, used));
    EXPECT_TRUE(rank.may_go_first(now += 29ms, used += 29ms));
    EXPECT_TRUE(rank.may_go_first(now += 1ms, used += 999us));
    EXPECT_FALSE(rank.may_go_first(now += 1us, used += 1us));
    EXPECT_FALSE(rank.may_go_first(now += 19ms, used)) << "asleep since, but in the same window";
    EXPECT_TRUE(rank.may_go_first(now += 999us, used)) << "the next one";
    EXPECT_FALSE(rank.may_go_first(now += 30ms, used += 30ms));
}

TEST(ServiceRank, AFloodOfWorkLeavesTwoFifthsOfTheProcessor) {
    ServiceRank rank;
    Instant now = at_ns(0);
    Duration used{}, first{};
    for (; now < at_ns(1'000'000'000); now += 50us) {  // never asleep
        if (rank.may_go_first(now, used)) first += 50us;
        used += 50us;
    }
    EXPECT_LE(first, 610ms);
    EXPECT_GE(first, 590ms);
}

TEST(ServiceRank, WhatUsesLittleKeepsIt) {
    ServiceRank rank;
    Instant now = at_ns(0);
    Duration used{};
    for (; now < at_ns(1'000'000'000); now += 1ms)
        ASSERT_TRUE(rank.may_go_first(now, used += 400us));
}

}  // namespace
}  // namespace axisgate
