// The addresses of a scan, and the faults of a wrong request.
#include "gateway/drive/scan_range.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/core/text.hpp"

namespace axisgate::drive {
namespace {

std::string check(std::string_view address) { return parse_whole(address, 1, 9) ? "" : "a number from 1 to 9"; }
ScanPlan plan(std::string from, std::string to) {
    ScanWish wish;
    wish.from = std::move(from);
    wish.to = std::move(to);
    return scan_range(wish, 1, 9, check);
}

TEST(ScanRange, IsWhatWasWishedOrAll) {
    EXPECT_THAT(plan("3", "5").addresses, testing::ElementsAre("3", "4", "5"));
    EXPECT_THAT(plan("8", "").addresses, testing::ElementsAre("8", "9"));
    EXPECT_THAT(plan("", "2").addresses, testing::ElementsAre("1", "2"));
    EXPECT_THAT(plan("", "").addresses, testing::SizeIs(9));
}

TEST(ScanRange, WhatIsNoRangeIsToldAndAsksNobody) {
    for (const auto& [from, to] : {std::pair{"0", "3"}, {"1", "10"}, {"x", ""}, {"", "5x"}}) {
        EXPECT_EQ(plan(from, to).fault, "a number from 1 to 9");
        EXPECT_TRUE(plan(from, to).addresses.empty());
    }
    EXPECT_EQ(plan("5", "4").fault, "from 5 to 4 is no range: the first address is above the last");
    EXPECT_TRUE(plan("5", "4").addresses.empty());
}

}  // namespace
}  // namespace axisgate::drive
