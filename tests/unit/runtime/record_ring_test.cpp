// Bytes from one thread to another: in order, complete, across the end of the ring, and counted if there is no space.
#include "gateway/runtime/record_ring.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace axisgate {
namespace {

TEST(RecordRing, WhatFindsNoRoomIsCountedAndTheRestIsWhole) {
    RecordRing ring(1024);
    const std::string payload(200, 'x');
    for (int i = 0; i < 10; ++i)
        (void)ring.push({FlightKind::event, static_cast<std::uint16_t>(i), at_ns(i), payload});
    int seen = 0;
    ring.empty([&](const FlightRecord& r) {
        EXPECT_EQ(r.index, seen);
        EXPECT_EQ(r.at, at_ns(seen));
        EXPECT_EQ(std::string(r.payload.begin(), r.payload.end()), payload);
        ++seen;
    });
    EXPECT_EQ(seen, 4);
    EXPECT_EQ(ring.lost(), 6u);
}

TEST(RecordRing, IsEmptiedInParts) {
    RecordRing ring(1024);
    for (int i = 0; i < 5; ++i)
        ASSERT_TRUE(ring.push({FlightKind::event, static_cast<std::uint16_t>(i), at_ns(i), "x"}));
    std::string seen;
    const auto take = [&](const FlightRecord& r) { seen += std::to_string(r.index); };
    EXPECT_FALSE(ring.empty(take, 2));
    EXPECT_EQ(seen, "01");
    EXPECT_FALSE(ring.empty(take, 0));
    EXPECT_TRUE(ring.empty(take, 3)) << "those were all";
    EXPECT_EQ(seen, "01234");
    EXPECT_TRUE(ring.empty(take));
    EXPECT_EQ(seen, "01234");
}

TEST(RecordRing, KeepsOrderBetweenTwoThreads) {
    RecordRing ring(4096);
    constexpr int many = 200'000;
    std::thread sender([&ring] {
        std::string payload;
        for (int i = 0; i < many; ++i) {
            payload.assign(static_cast<std::size_t>(i % 97), static_cast<char>('a' + i % 26));
            while (!ring.push({FlightKind::turn, 0xFFFF, at_ns(i), payload}))
                std::this_thread::yield();
        }
    });
    int next = 0;
    bool good = true;
    while (next < many) {
        ring.empty([&](const FlightRecord& r) {
            good = good && r.at == at_ns(next) && r.payload.size() == static_cast<std::size_t>(next % 97) &&
                   std::ranges::all_of(r.payload, [&](char c) { return c == static_cast<char>('a' + next % 26); });
            ++next;
        });
    }
    sender.join();
    EXPECT_TRUE(good);
}

}  // namespace
}  // namespace axisgate
