// The adapter against a hostile or failing line: PDOs of a wrong length, EMCY storms, reboots, silence, two nodes of one number, refusals.
// In: a node's twin, frames of the test's own. Out: what is counted, told and shown; every command ends once. Never sleeps.
#include "adapters/cia402/tests/line_bench.hpp"

namespace axisgate::cia402_drive::test {
namespace {

Frame data(std::uint32_t id, std::vector<std::uint8_t> bytes) { return canopen::data_frame(id, bytes); }

TEST(Cia402Adapter, FindsSetsUpAndTellsANode) {
    LineBench b;
    b.run(2s);
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_NE(b.link.text.find("vendor"), std::string::npos) << b.link.text;
    EXPECT_FALSE(b.feedback.empty());
    ASSERT_TRUE(b.enable());
    EXPECT_EQ(b.axis.statusword.value_or(0) & 0x6F, 0x27) << "who hears enabled finds it shown";
}

TEST(Cia402Adapter, APdoOfAWrongLengthIsCountedAndTellsNothing) {
    LineBench b;
    b.run(2s);
    const auto garbled = b.adapter.counters().garbled;
    const auto before = b.feedback.size();
    const auto position = b.axis.position;
    for (const std::size_t n : {0u, 1u, 6u, 8u})
        b.inject(data(0x185, std::vector<std::uint8_t>(n, 0xFF)));
    for (const std::size_t n : {0u, 4u, 7u})
        b.inject(data(0x285, std::vector<std::uint8_t>(n, 0xFF)));
    EXPECT_EQ(b.adapter.counters().garbled, garbled + 7);
    EXPECT_EQ(b.feedback.size(), before);
    EXPECT_EQ(b.axis.position, position);
    b.run(1s);
    EXPECT_TRUE(b.link.online);
}

TEST(Cia402Adapter, AStormOfEmergenciesIsToldInBounds) {
    LineBench b;
    b.run(2s);
    for (int i = 0; i < 10'000; ++i)
        b.inject(data(0x085, {0x10, 0x23, 0x03, 0, 0, 0, 0, static_cast<std::uint8_t>(i)}));
    EXPECT_LT(b.notices.size(), 50u);
    EXPECT_GE(b.told("emergency"), 1);
    b.run(1s);
    EXPECT_TRUE(b.link.online) << "and it is served all the same";
    EXPECT_TRUE(b.enable());
}

TEST(Cia402Adapter, ANodeThatRebootsUnderWayEndsItsMotionAndIsSetUpAnew) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(LineBench::to(1'000'000))));
    b.run(200ms);
    ASSERT_TRUE(b.axis.moving);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "power", Value{false}, b.now), "");
    b.run(50ms);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "power", Value{true}, b.now), "");
    b.run(3s);
    EXPECT_TRUE(b.link.online) << b.link.text;
    EXPECT_FALSE(b.axis.moving);
    EXPECT_FALSE(b.axis.target_reached);
    EXPECT_NE(b.axis.statusword.value_or(0) & 0x6F, 0x27) << "nothing is enabled by itself";
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(LineBench::to(b.axis.position + 1000))));
    b.run(2s);
    EXPECT_TRUE(b.axis.target_reached);
}

TEST(Cia402Adapter, ANodeThatFallsSilentIsAskedAndLostAndFoundAgain) {
    LineBench b;
    b.run(2s);
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "silent", Value{true}, b.now), "");
    b.run(10s);
    EXPECT_FALSE(b.link.online);
    EXPECT_NE(b.link.text.find("does not answer"), std::string::npos) << b.link.text;
    ASSERT_EQ(b.bus->set_hand(DriveId{0}, "silent", Value{false}, b.now), "");
    b.run(10s);
    EXPECT_TRUE(b.link.online);
}

TEST(Cia402Adapter, TwoNodesOfOneNumberAnswerTwiceAndEachCommandEndsOnce) {
    LineBench b(2);
    b.run(3s);
    EXPECT_GT(b.adapter.counters().unexpected, 0u) << "the second answer to each question";
    (void)b.ask(Enable{});
    (void)b.ask(LineBench::to(1000));
    b.run(1s);
    for (const auto& [ticket, list] : b.results)
        EXPECT_EQ(list.size(), 1u);
}

TEST(Cia402Adapter, ReachedIsNotSaidByTheStatusOfTheMotionBefore) {
    LineBench b;
    b.run(2s);
    ASSERT_TRUE(b.enable());
    ASSERT_TRUE(good(b.ask(LineBench::to(1000))));
    b.run(2s);
    ASSERT_TRUE(b.axis.target_reached);
    ASSERT_TRUE(good(b.ask(LineBench::to(50'000))));
    b.feedback.clear();
    // A picture of before: bit 10 still set, at the old place.
    b.inject(data(0x185, {0x37, 0x16, 0xE8, 0x03, 0, 0, 1}));
    b.inject(data(0x285, {0, 0, 0, 0, 0xE8, 0x03, 0, 0}));
    ASSERT_FALSE(b.feedback.empty());
    for (const auto& f : b.feedback)
        EXPECT_FALSE(f.target_reached) << "at " << f.position;
    b.run(8s);
    EXPECT_TRUE(b.axis.target_reached);
    EXPECT_EQ(b.axis.position, 50'000);
}

TEST(Cia402Adapter, WhatTheDriveRefusesIsToldWithItsAbortCode) {
    LineBench b;
    b.run(2s);
    const Result r = b.ask(Native{{'1', '2', '3', '4', ':', '0', '0', '?'}, true});
    EXPECT_EQ(r.reason, Reason::drive_refused) << r.text;
    EXPECT_NE(r.text.find("0602"), std::string::npos) << r.text;
}

TEST(Cia402Adapter, FramesOfOthersAreNobodys) {
    LineBench b;
    b.run(2s);
    const auto before = b.feedback.size();
    for (const std::uint32_t id : {0x186u, 0x706u, 0x586u, 0x086u, 0x7FFu})
        b.inject(data(id, {1, 2, 3, 4, 5, 6, 7, 8}));
    Frame remote = data(0x185, {});
    remote.remote = true;
    b.inject(remote);
    EXPECT_EQ(b.feedback.size(), before);
    b.run(1s);
    EXPECT_TRUE(b.link.online);
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
