// Which events are reported at once, which are only counted, and that the counts are reported even without further requests.
#include "gateway/core/event_rows.hpp"

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace axisgate {
namespace {
using namespace std::chrono_literals;

class EventRowsTest : public ::testing::Test {
protected:
    std::vector<std::string> told;
    Instant now = time_zero + 100s;
    EventRows rows{[this](Event e, AxisId) { told.push_back(std::move(e.text)); }, "refusals", 60s};
    void add(std::string_view host, std::string text, std::string row = {}) {
        Event e;
        e.text = std::move(text);
        rows.add(host, no_axis, std::move(e), std::move(row), now);
    }
};

TEST_F(EventRowsTest, IdenticalOnesAreOneEventAndThenTheirCount) {
    for (int i = 0; i < 4; ++i)
        add("192.0.2.7", "no");
    EXPECT_EQ(told, (std::vector<std::string>{"no"}));
    EXPECT_TRUE(rows.pending());
    now += 59s;
    rows.flush(now);
    EXPECT_EQ(told.size(), 1u) << "the row has not lasted long enough";
    now += 1s;
    rows.flush(now);
    EXPECT_EQ(told.back(), "no: 3 times more");
    EXPECT_FALSE(rows.pending());
    EXPECT_EQ(rows.counted_only(), 3u);
}

TEST_F(EventRowsTest, ANameMakesARowOfDifferentTexts) {
    add("192.0.2.7", "GET /a", "401");
    add("192.0.2.7", "GET /b", "401");
    add("192.0.2.7", "GET /c", "403");
    EXPECT_EQ(told, (std::vector<std::string>{"GET /a", "GET /a: once more", "GET /c"}));
}

TEST_F(EventRowsTest, AFloodOfOneClientLeavesTheOthersTheirEvents) {
    for (int i = 0; i < 1000; ++i)
        add("192.0.2.66", fmt::format("flood {}", i));
    EXPECT_EQ(told.size(), 5u);
    EXPECT_EQ(rows.counted_only(), 995u);
    add("192.0.2.7", "honest");
    EXPECT_EQ(told.back(), "honest");
    now += 1s;
    add("192.0.2.66", "flood again");
    EXPECT_EQ(told.back(), "flood again; 995 more refusals of 192.0.2.66 were not told one by one");
}

TEST_F(EventRowsTest, TheClientThatWasReceivedLongestAgoMakesRoomAndItsCountIsReported) {
    add("192.0.2.7", "no");
    add("192.0.2.7", "no");
    for (std::size_t i = 1; i < EventRows::most_clients; ++i) {
        now += 200ms;  // all of them stay below the rate of all clients
        add(fmt::format("198.51.100.{}", i), "no");
    }
    EXPECT_EQ(std::ranges::count(told, "no: once more"), 0);
    now += 200ms;
    add("203.0.113.1", "no");
    EXPECT_EQ(std::ranges::count(told, "no: once more"), 1) << "one client more than there is room for";
}

TEST_F(EventRowsTest, AHundredThousandClientsAreBounded) {
    for (int i = 0; i < 100'000; ++i)
        add(fmt::format("198.51.100.{}", i), "no");
    EXPECT_LE(told.size(), 32u);
}

}  // namespace
}  // namespace axisgate
