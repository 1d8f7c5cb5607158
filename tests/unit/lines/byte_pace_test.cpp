// BytePace: the bytes of a burst one byte time apart, late callers, idle wires, and lines that are so fast that bytes pass in groups.
#include "gateway/lines/byte_pace.hpp"

#include <gtest/gtest.h>

#include "gateway/core/wire_time.hpp"

namespace axisgate {
namespace {

using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Instant start = time_zero + std::chrono::seconds(1);
constexpr Duration slow = milliseconds(2);

/// Lets `bytes` pass, each as early as possible, from `at` on; returns the instant of the last one.
Instant burst(BytePace& pace, int bytes, Instant at) {
    while (bytes > 0) {
        const std::size_t room = pace.room(at);
        if (room == 0) {
            const Duration pause = pace.pause(at);
            EXPECT_GT(pause, Duration::zero()) << "no room and no pause: the caller would turn round and round";
            if (pause <= Duration::zero()) return at;
            at += pause;
            continue;
        }
        const int n = std::min<int>(bytes, static_cast<int>(std::min<std::size_t>(room, 1000)));
        bytes -= n;
        pace.pass(static_cast<std::size_t>(n), bytes > 0, at);
    }
    return at;
}

TEST(BytePace, withoutAByteTimeEverythingPasses) {
    BytePace pace;
    EXPECT_FALSE(pace.active());
    EXPECT_GT(pace.room(start), 1'000'000u);
    EXPECT_EQ(pace.pause(start), Duration::zero());
    pace.pass(100, true, start);
    EXPECT_GT(pace.room(start), 1'000'000u);
}

TEST(BytePace, aByteHasPassedWhenItsLastBitIsOut) {
    BytePace pace(slow);
    EXPECT_EQ(pace.room(start), 0u);
    EXPECT_EQ(pace.pause(start), slow);
    EXPECT_EQ(pace.room(start + slow - microseconds(1)), 0u);
    EXPECT_EQ(pace.room(start + slow), 1u);
    pace.pass(1, true, start + slow);
    EXPECT_EQ(pace.room(start + slow), 0u);
    EXPECT_EQ(pace.room(start + 2 * slow), 1u);
}

TEST(BytePace, aBurstTakesExactlyItsBytes) {
    const struct {
        std::uint32_t baud;
        std::uint8_t bits;
        int bytes;
    } rows[] = {{9600, 9, 26}, {9600, 10, 1}, {110, 9, 40}, {38400, 11, 256}, {50, 12, 3}};
    for (const auto& r : rows) {
        const Duration byte = wire_time(r.bits, r.baud);
        BytePace pace(byte);
        const Instant end = burst(pace, r.bytes, start);
        EXPECT_GE(end - start, byte * r.bytes) << r.baud;
        EXPECT_LE(end - start, byte * r.bytes + milliseconds(1)) << r.baud;
    }
}

TEST(BytePace, aQuietWireSavesNothingUp) {
    BytePace pace(slow);
    const Instant first = burst(pace, 3, start);
    EXPECT_EQ(first, start + 3 * slow);
    EXPECT_EQ(burst(pace, 3, first), first + 3 * slow) << "right behind it: no gap, no overlap";
    const Instant later = first + std::chrono::hours(1);
    EXPECT_EQ(pace.room(later), 0u) << "an hour of silence is no credit";
    EXPECT_EQ(burst(pace, 3, later), later + 3 * slow);
}

TEST(BytePace, aLateCallerCatchesUpButTheFirstByteDoesNot) {
    BytePace pace(slow);
    EXPECT_EQ(pace.room(start), 0u);
    const Instant late = start + 10 * slow;
    ASSERT_EQ(pace.room(late), 1u) << "the first byte alone: what a reader sees between first and last must be honest";
    pace.pass(1, true, late);
    EXPECT_EQ(pace.room(late), 0u);
    EXPECT_EQ(pace.room(late + 5 * slow), 5u);
    pace.pass(2, true, late + 5 * slow);
    EXPECT_EQ(pace.room(late + 5 * slow), 3u) << "what was not taken stays due";
}

TEST(BytePace, whatIsLostIsForgotten) {
    BytePace pace(slow);
    (void)pace.room(start);
    pace.pass(0, true, start + slow);
    pace.stop();
    EXPECT_EQ(pace.room(start + 50 * slow), 0u);
    EXPECT_EQ(pace.pause(start + 50 * slow), slow);
}

TEST(BytePace, fastLinesPassInGrains) {
    const Duration byte = microseconds(10);
    BytePace pace(byte);
    EXPECT_EQ(pace.room(start), 0u);
    EXPECT_EQ(pace.pause(start), milliseconds(1)) << "not a timer for each byte";
    EXPECT_EQ(pace.room(start + milliseconds(1)), 100u);
    BytePace other(byte);
    const Instant end = burst(other, 1000, start);
    EXPECT_EQ(end - start, milliseconds(10));
}

}  // namespace
}  // namespace axisgate
