// Parts of the twin whose behaviour the complete drive hides: stream, monitor, interpolator, the queued motion.
#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {
constexpr Instant start = at_ns(5'000'000'000);

TEST(LinmotTwinParts, ASetPointOfAStreamIsReachedOneAndAHalfPeriodsLater) {
    twin::Memory memory;
    twin::Stream stream(memory);
    const auto take = [&](std::int32_t place, Instant at) {
        twin::Bytes b{};
        for (std::size_t i = 0; i < 4; ++i)
            b[2 + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(place) >> 8 * i);
        return stream.take(0, b, {}, at);
    };
    ASSERT_EQ(take(1'000, start), 0);  // its period is not known yet: 2 ms
    EXPECT_EQ(stream.due(), start + 3ms);
    EXPECT_NEAR(stream.at(start + 1500us).position, 500, 1e-6);
    ASSERT_EQ(take(5'000, start + 4ms), 0);
    EXPECT_TRUE(stream.pass(start + 4ms));
    EXPECT_EQ(stream.due(), start + 4ms + 6ms) << "4 ms were measured";
    EXPECT_FALSE(stream.pass(start + 9ms));
    ASSERT_TRUE(stream.pass(start + 10ms));
    EXPECT_FALSE(stream.starved(start + 15ms));
    EXPECT_TRUE(stream.starved(start + 16ms)) << "three periods behind the last one that came";
}

TEST(LinmotTwinParts, AHotPtcWarnsAfterATenthOfASecondAndIsAnErrorAfterHalfOfOne) {
    twin::Memory memory;
    memory.restart();
    twin::Outside outside;
    outside.ptc1_hot = true;
    twin::Monitor monitor(memory, outside, twin::Series::e1100);
    monitor.seen(outside, start);
    EXPECT_EQ(monitor.warnings(start + 99ms) & 0x100, 0);
    EXPECT_EQ(monitor.warnings(start + 100ms) & 0x100, 0x100);
    EXPECT_EQ(monitor.fault(start + 499ms), 0);
    EXPECT_EQ(monitor.fault(start + 500ms), 0x06);
    EXPECT_EQ(monitor.due(start), start + 500ms);
}

TEST(LinmotTwinParts, AnEndlessMotionThatWasFrozenGoesOnInItsDirection) {
    const twin::Memory memory;
    twin::Interpolator vai(memory);
    vai.endless({}, -1, {1'000, 100'000, 100'000}, start);
    vai.freeze(vai.profile().at(start + 1s), false, true, start + 1s);
    EXPECT_EQ(vai.profile().at(start + 2s).velocity, 0);
    vai.thaw(vai.profile().at(start + 2s), start + 2s);
    EXPECT_TRUE(vai.profile().endless());
    EXPECT_NEAR(vai.profile().at(start + 4s).velocity, -1'000, 1e-6);
}

TEST(LinmotTwinParts, TheLastSetPointOfAStreamIsTheFormerTarget) {
    Bench b;
    b.enable();
    for (int i = 1; i <= 5; ++i) {
        b.motion("030xh", {i * 1'000});
        b.run(3ms);
    }
    b.motion("012xh", {500, 100'000, 1'000'000, 1'000'000});
    b.run(2s);
    EXPECT_EQ(b.state(), 8);
    EXPECT_NEAR(b.demand(), 5'500, 1);
}

TEST(LinmotTwinParts, AMotionBehindARunningOneBeginsAtOnceWhereNoneRuns) {
    Bench b;
    b.enable();
    b.motion("018xh", {20'000, 100'000, 1'000'000, 1'000'000});
    EXPECT_EQ(b.drive().status_word() >> 13 & 1, 1) << "in the answer to the command";
    b.run(2s);
    EXPECT_NEAR(b.demand(), 20'000, 1);
}

}  // namespace
}  // namespace axisgate::linmot::test
