// How many axes fit a cycle: the bound of bits against real frames, and the cycles of the handbook's table.
// In: frames whose bits are counted exactly. Out: bounds. Never an adapter.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "adapters/cia402/wire.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::cia402_drive::test {
namespace {
using namespace std::chrono_literals;

TEST(Cia402Cycle, NoFrameIsLongerThanItsBoundAndSomeComeNearIt) {
    std::mt19937 random(402);
    for (const std::uint32_t bytes : {0u, 2u, 4u, 7u, 8u}) {
        SCOPED_TRACE(bytes);
        std::uint32_t longest = 0;
        const auto look = [&](std::uint32_t id, std::vector<std::uint8_t> content) {
            longest = std::max(longest, can_bits(canopen::data_frame(id, content)) + can_intermission_bits);
        };
        for (std::uint32_t id = 0x80; id <= 0x57F; id += 0x11)
            for (const int pattern : {0x00, 0xFF, 0x0F, 0xF0, 0x1E, 0x3C, 0x78, 0x87, 0xC3, 0xE1})
                look(id, std::vector<std::uint8_t>(bytes, static_cast<std::uint8_t>(pattern)));
        for (int i = 0; i < 2'000; ++i) {
            std::vector<std::uint8_t> content(bytes);
            std::ranges::generate(content, [&] { return static_cast<std::uint8_t>(random()); });
            look(static_cast<std::uint32_t>(random() % 0x580), content);
        }
        EXPECT_LE(longest, most_bits(bytes));
        EXPECT_GE(longest + 8, most_bits(bytes)) << "the bound is not far off";
    }
}

TEST(Cia402Cycle, IsThatOfTheHandbooksTable) {
    EXPECT_EQ(most_bits(0), 55u);
    EXPECT_EQ(bits_of_cycle(1) - bits_of_cycle(0), 355u);
    const auto whole_ms = [](std::uint64_t axes, std::uint32_t rate) {
        return std::max<std::int64_t>(1, (least_cycle(axes, rate) + 999us) / 1ms);
    };
    constexpr std::pair<int, int> rows[] = {{1, 1}, {2, 2}, {4, 3}, {8, 6}, {16, 12}, {32, 23}};
    for (const auto& [axes, ms] : rows)
        EXPECT_EQ(whole_ms(static_cast<std::uint64_t>(axes), 1'000'000), ms) << axes;
    EXPECT_GT(whole_ms(3, 1'000'000), 2) << "two axes are the most at 2 ms";
    EXPECT_EQ(whole_ms(32, 500'000), 46);
    EXPECT_EQ(least_cycle(2, 0), least_cycle(2, 1'000'000)) << "a line that says no rate";
    EXPECT_LE(wire_time(bits_of_cycle(5), 1'000'000), 2ms);
    EXPECT_GT(wire_time(bits_of_cycle(6), 1'000'000), 2ms) << "five on a bus without anything else";
}

}  // namespace
}  // namespace axisgate::cia402_drive::test
