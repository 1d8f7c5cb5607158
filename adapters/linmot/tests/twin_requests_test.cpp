// The twin: requests without data, RAM reads, and the messages that it leaves without an answer.
#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {

TEST(LinmotTwinRequests, TheFourRequestsWithoutData) {
    Bench b;
    const auto first = b.ask("01 11 03 02 01 00 04");
    ASSERT_EQ(first.size(), 16u);
    EXPECT_EQ(first[2], 0x0C);
    EXPECT_EQ(b.ask("01 11 03 02 02 00 04"), first);
    EXPECT_EQ(b.ask("01 11 03 02 04 00 04"), first);
    const auto third = b.ask("01 11 03 02 03 00 04");
    ASSERT_EQ(third.size(), 20u) << "warn word and two bytes behind the same answer";
    EXPECT_TRUE(std::equal(first.begin() + 6, first.begin() + 15, third.begin() + 6));
    EXPECT_EQ(third[15] | third[16] << 8, b.drive().warn_word());
    EXPECT_TRUE(b.ask("01 11 03 02 05 00 04").empty());
}

TEST(LinmotTwinRequests, RamIsReadBehindTheDefaultResponse) {
    Bench b;
    const auto known = b.ask("01 11 05 02 00 03 BE 14 04");  // 14BEh: 0.1 m/s
    ASSERT_EQ(known.size(), 20u);
    EXPECT_EQ(known[15] | known[16] << 8 | known[17] << 16, 100'000);
    const auto unknown = b.ask("01 11 05 02 00 03 FF FF 04");
    ASSERT_EQ(unknown.size(), 20u);
    EXPECT_EQ(unknown[15] | unknown[16] | unknown[17] | unknown[18], 0);
    EXPECT_TRUE(b.ask("01 11 09 02 01 03 BE 14 01 00 00 00 04").empty()) << "a write of RAM: no page shows it";
    EXPECT_TRUE(b.ask("01 11 09 02 02 05 BE 14 01 00 00 00 04").empty()) << "RAM and ROM together: no page shows it";
    EXPECT_EQ(b.drive().ram(0x14BE), 100'000u);
}

}  // namespace
}  // namespace axisgate::linmot::test
