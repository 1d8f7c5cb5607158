// The numbers of connections with few descriptors, and the warning about them.
#include "gateway/runtime/descriptor_limits.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {
constexpr DoorShares usual{1024, 512, 256};

TEST(DescriptorLimits, WhatFitsStaysAndNothingIsSaid) {
    const auto f = fit_to_descriptors(usual, descriptors_kept + 1024 + 512 + 256);
    EXPECT_EQ(f.shares, usual);
    EXPECT_TRUE(f.told.empty());
}

TEST(DescriptorLimits, WhatDoesNotFitIsSharedAsItWasWanted) {
    const auto f = fit_to_descriptors(usual, 1024);
    EXPECT_LE(descriptors_kept + f.shares.modbus + f.shares.http + f.shares.enip, 1024u);
    EXPECT_EQ(f.shares.modbus, 426u);
    EXPECT_EQ(f.shares.http, 213u);
    EXPECT_NE(f.told.find("[modbus] max_connections is 426 instead of 1024"), std::string::npos) << f.told;
    EXPECT_NE(f.told.find("[limits] http_connections 213 instead of 512"), std::string::npos) << f.told;
}

TEST(DescriptorLimits, EachDoorHasAFewEvenThen) {
    const auto f = fit_to_descriptors(usual, 64);
    EXPECT_EQ(f.shares.modbus, least_share);
    EXPECT_EQ(f.shares.http, least_share);
    EXPECT_EQ(fit_to_descriptors({1024, 2, 256}, 64).shares.http, 2u) << "never more than was wanted";
    EXPECT_EQ(fit_to_descriptors({0, 512, 0}, 64).shares.modbus, 0u) << "a door that is shut stays shut";
}

}  // namespace
}  // namespace axisgate
