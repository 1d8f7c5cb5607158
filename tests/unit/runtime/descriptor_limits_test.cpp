// The numbers of connections with few descriptors, and the warning about them.
#include "gateway/runtime/descriptor_limits.hpp"

#include <gtest/gtest.h>

namespace axisgate {
namespace {
const std::vector<DoorShare> usual{{"[modbus] max_connections", 1024}, {"[limits] http_connections", 512}, {"", 256}};

std::vector<DoorShare> wanted(std::uint64_t modbus, std::uint64_t http, std::uint64_t enip) {
    auto doors = usual;
    doors[0].wanted = modbus, doors[1].wanted = http, doors[2].wanted = enip;
    return doors;
}

TEST(DescriptorLimits, WhatFitsStaysAndNothingIsSaid) {
    const auto f = fit_to_descriptors(usual, descriptors_kept + 1024 + 512 + 256);
    EXPECT_EQ(f.shares, (std::vector<std::uint64_t>{1024, 512, 256}));
    EXPECT_TRUE(f.told.empty());
}

TEST(DescriptorLimits, WhatDoesNotFitIsSharedAsItWasWanted) {
    const auto f = fit_to_descriptors(usual, 1024);
    EXPECT_LE(descriptors_kept + f.shares[0] + f.shares[1] + f.shares[2], 1024u);
    EXPECT_EQ(f.shares, (std::vector<std::uint64_t>{426, 213, 256})) << "the bound of a protocol stays";
    EXPECT_NE(f.told.find("[modbus] max_connections is 426 instead of 1024"), std::string::npos) << f.told;
    EXPECT_NE(f.told.find("[limits] http_connections 213 instead of 512"), std::string::npos) << f.told;
}

TEST(DescriptorLimits, EachDoorHasAFewEvenThen) {
    const auto f = fit_to_descriptors(usual, 64);
    EXPECT_EQ(f.shares[0], least_share);
    EXPECT_EQ(f.shares[1], least_share);
    EXPECT_EQ(fit_to_descriptors(wanted(1024, 2, 256), 64).shares[1], 2u) << "never more than was wanted";
    EXPECT_EQ(fit_to_descriptors(wanted(0, 512, 0), 64).shares[0], 0u) << "a door that is shut stays shut";
}

TEST(DescriptorLimits, ASeventhDoorHasItsShareLikeTheOthers) {
    auto doors = usual;
    doors.push_back({"[third] clients", 512});
    const auto f = fit_to_descriptors(doors, 1024);
    EXPECT_EQ(f.shares, (std::vector<std::uint64_t>{320, 160, 256, 160}));
    EXPECT_NE(f.told.find("[third] clients 160 instead of 512"), std::string::npos) << f.told;
}

}  // namespace
}  // namespace axisgate
