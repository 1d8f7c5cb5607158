// The heap compared with a plain search, and the rings.
#include "gateway/drive/schedule.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace axisgate::drive::test {
namespace {

TEST(Schedule, HeapAgainstAPlainSearch) {
    std::mt19937 random(7);
    DeadlineHeap heap;
    std::array<Instant, slot_limit> plain{};
    plain.fill(never);
    for (int i = 0; i < 20000; ++i) {
        const std::size_t slot = random() % slot_limit;
        const Instant at = random() % 5 == 0 ? never : at_ns(static_cast<std::int64_t>(random() % 1000));
        heap.set(slot, at);
        plain[slot] = at;
        const Instant best = *std::ranges::min_element(plain);
        ASSERT_EQ(heap.earliest(), best);
        if (best != never) {
            ASSERT_EQ(plain[heap.first()], best);
        }
        ASSERT_EQ(heap.empty(), best == never);
    }
}

TEST(Schedule, RingKeepsTheOrder) {
    Ring ring;
    for (int round = 0; round < 3; ++round) {
        for (std::size_t n = 0; n < slot_limit; ++n)
            ring.push((n * 5) % slot_limit);
        for (std::size_t n = 0; n < slot_limit; ++n)
            ASSERT_EQ(ring.pop(), (n * 5) % slot_limit);
        EXPECT_TRUE(ring.empty());
    }
}

}  // namespace
}  // namespace axisgate::drive::test
