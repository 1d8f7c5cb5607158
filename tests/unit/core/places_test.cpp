// Which connection is closed when a door is full, by table.
#include "gateway/core/places.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace axisgate {
namespace {
using enum Standing;
Guest guest(PlaceHolder holder, Standing standing, std::int64_t since) { return {holder, standing, at_ns(since)}; }

TEST(Places, WhileThereIsRoomNobodyGoes) {
    const std::vector<Guest> guests{guest(1, stranger, 1), guest(1, stranger, 2)};
    const auto v = find_place(guests, 1, false, {3, 1});
    EXPECT_TRUE(v.let_in);
    EXPECT_FALSE(v.closes);
}

TEST(Places, StrangersGoFirstTheOldestOfTheHolderWithMost) {
    const std::vector<Guest> guests{guest(7, known, 1),    guest(1, stranger, 2),  guest(2, stranger, 4),
                                    guest(2, stranger, 3), guest(2, stop_path, 0), guest(3, knowns_work, 0)};
    EXPECT_EQ(find_place(guests, 9, false, {6, 0}).closes, 3u);
    EXPECT_EQ(find_place(guests, 9, true, {5, 1}).closes, 3u) << "one who is known is no reason to close another who is";
    const std::vector<Guest> without{guest(7, known, 1), guest(7, known, 0), guest(8, known, 0), guest(2, stop_path, 0)};
    EXPECT_EQ(find_place(without, 9, false, {4, 0}).closes, 1u) << "without strangers the longest idle one of those who have most";
}

TEST(Places, KeptPlacesAreForThoseWhoAreKnown) {
    const std::vector<Guest> guests{guest(1, strangers_work, 1), guest(2, strangers_work, 2), guest(3, known, 3)};
    const PlaceRules rules{2, 2};
    EXPECT_TRUE(find_place(guests, 4, true, rules).let_in);
    EXPECT_FALSE(find_place(guests, 4, true, rules).closes);
    EXPECT_FALSE(find_place(guests, 4, false, rules).let_in) << "strangers hold their share, and none of them can go";
    const std::vector<Guest> idle{guest(1, stranger, 1), guest(2, strangers_work, 2), guest(3, known, 0)};
    EXPECT_EQ(find_place(idle, 4, false, rules).closes, 0u) << "a stranger makes room for a stranger, not one who is known";
}

TEST(Places, WorkIsSparedUnlessItsHolderHasMoreThanHisShare) {
    std::vector<Guest> guests;
    for (int i = 0; i < 8; ++i)
        guests.push_back(guest(1, strangers_work, i));
    EXPECT_FALSE(find_place(guests, 2, false, {8, 0}).let_in) << "eight are nobody's flood";
    EXPECT_EQ(find_place(guests, 1, false, {8, 0}).closes, 0u) << "the ninth of one holder";
    for (int i = 8; i < 80; ++i)
        guests.push_back(guest(1, knowns_work, i));
    guests.push_back(guest(2, strangers_work, -1));
    EXPECT_EQ(find_place(guests, 3, false, {81, 0}).closes, 0u) << "of the flood, not of the neighbour who is older";
}

TEST(Places, TheNewestPathsOfAStopNeverGo) {
    std::vector<Guest> guests;
    for (int i = 0; i < 100; ++i)
        guests.push_back(guest(1, stop_path, i));
    const PlaceRules rules{100, 0, 16};
    auto v = find_place(guests, 2, false, rules);
    ASSERT_TRUE(v.closes);
    EXPECT_EQ(*v.closes, 0u);
    int closed = 0;
    while (v.closes) {
        guests.erase(guests.begin() + static_cast<std::ptrdiff_t>(*v.closes));
        ++closed;
        v = find_place(guests, 2, false, {guests.size(), 0, 16});
    }
    EXPECT_EQ(closed, 84);
    for (const Guest& g : guests)
        EXPECT_GE(g.since, at_ns(84));
}

TEST(Places, FullForAnotherReasonClosesWhoeverMayGo) {
    const std::vector<Guest> guests{guest(1, known, 1)};
    EXPECT_EQ(find_place(guests, 0, false, {10, 2}, true).closes, 0u);
    EXPECT_FALSE(find_place(std::vector<Guest>{guest(1, stop_path, 1)}, 0, false, {10, 2}, true).let_in);
}

TEST(Places, HoldersAreAddressesOrNetworks) {
    const auto v4 = [](std::uint8_t d) { return std::array<std::uint8_t, 16>{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 192, 0, 2, d}; };
    const auto v6 = [](std::uint8_t net, std::uint8_t host) {
        return std::array<std::uint8_t, 16>{0x20, 1, 0x0d, 0xb8, 0, 0, 0, net, 0, 0, 0, 0, 0, 0, 0, host};
    };
    EXPECT_NE(place_holder(v4(1)), place_holder(v4(2)));
    EXPECT_EQ(place_holder(v6(1, 1)), place_holder(v6(1, 2)));
    EXPECT_NE(place_holder(v6(1, 1)), place_holder(v6(2, 1)));
    EXPECT_NE(place_holder(v4(1)), place_holder({}));
}
}  // namespace
}  // namespace axisgate
