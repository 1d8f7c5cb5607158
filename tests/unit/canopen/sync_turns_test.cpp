// The plan of SYNC turns by table, its laws over many lines, and the slots of targets.
#include "gateway/protocols/canopen/sync_turns.hpp"

#include <gtest/gtest.h>

#include <random>

#include "gateway/core/wire_time.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::canopen::test {
namespace {
using namespace std::chrono_literals;

constexpr std::uint32_t axis_bits = most_bits(7) + most_bits(8), target_bits = most_bits(4);

TurnsWish wish(int nodes, Duration beat, std::uint32_t bit_rate = 1'000'000, int axes = 1) {
    TurnsWish w{beat, bit_rate, axis_bits, target_bits, 0, {}};
    w.nodes.assign(static_cast<std::size_t>(nodes), {axes, -1});
    return w;
}

TEST(SyncTurns, NoFrameIsLongerThanItsBoundAndSomeComeNearIt) {
    std::mt19937 random(402);
    for (const std::uint32_t bytes : {0u, 2u, 4u, 7u, 8u}) {
        SCOPED_TRACE(bytes);
        std::uint32_t longest = 0;
        const auto look = [&](std::uint32_t id, const std::vector<std::uint8_t>& content) {
            longest = std::max(longest, can_bits(data_frame(id, content)) + can_intermission_bits);
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

TEST(SyncTurns, AreThoseOfTheHandbooksTable) {
    EXPECT_EQ(most_bits(0), 55u);
    EXPECT_EQ(axis_bits, 260u);
    EXPECT_EQ(target_bits, 95u);
    struct Row {
        int nodes;
        Duration beat;
        std::uint32_t bit_rate;
        int turns, places;
    };
    constexpr Row rows[] = {
        {1, 1ms, 1'000'000, 1, 1},   {2, 1ms, 1'000'000, 2, 1},    {32, 1ms, 1'000'000, 32, 1}, {1, 2ms, 1'000'000, 1, 7},
        {2, 2ms, 1'000'000, 1, 4},   {4, 2ms, 1'000'000, 2, 4},    {8, 2ms, 1'000'000, 4, 4},   {16, 2ms, 1'000'000, 8, 4},
        {32, 2ms, 1'000'000, 16, 4}, {4, 4ms, 1'000'000, 1, 9},    {8, 4ms, 1'000'000, 2, 9},   {32, 4ms, 1'000'000, 6, 4},
        {32, 10ms, 1'000'000, 2, 8}, {32, 20ms, 1'000'000, 1, 17}, {36, 20ms, 1'000'000, 1, 6}, {37, 20ms, 1'000'000, 2, 52},
        {32, 4ms, 500'000, 16, 4},   {32, 2ms, 0, 16, 4},          {0, 2ms, 1'000'000, 1, 9},
    };
    for (const Row& r : rows) {
        const SyncTurns p = plan_turns(wish(r.nodes, r.beat, r.bit_rate));
        EXPECT_EQ(p.turns, r.turns) << r.nodes << " nodes, " << milliseconds_of(r.beat) << " ms";
        EXPECT_EQ(p.places, r.places) << r.nodes << " nodes, " << milliseconds_of(r.beat) << " ms";
        EXPECT_EQ(p.beat, r.beat);
        EXPECT_EQ(p.cycle(), r.beat * r.turns);
    }
}

TEST(SyncTurns, ABeatInWhichNotEvenOneNodeFitsIsMadeLonger) {
    EXPECT_EQ(plan_turns(wish(1, 1ms, 125'000)).beat, 7ms);
    EXPECT_EQ(plan_turns(wish(1, 1ms, 1'000'000, 2)).beat, 2ms) << "both axes of a node tell in one beat";
    EXPECT_EQ(plan_turns(wish(3, Duration::zero())).beat, 1ms);
}

/// The bits of the fullest SYNC, with all targets in use, by the slots of the plan.
std::uint64_t bits_of_fullest(const SyncTurns& p, const TurnsWish& w) {
    std::vector<int> axes(static_cast<std::size_t>(p.turns), 0);
    for (std::size_t i = 0; i < w.nodes.size(); ++i)
        axes.at(static_cast<std::size_t>(p.slots.at(i))) += w.nodes[i].axes;
    return most_bits(0) + static_cast<std::uint64_t>(*std::ranges::max_element(axes)) * axis_bits +
           static_cast<std::uint64_t>(p.places) * target_bits;
}

TEST(SyncTurns, NoBeatCarriesMoreThanItsShareWhateverTheLine) {
    std::mt19937 random(17);
    for (int i = 0; i < 500; ++i) {
        constexpr std::uint32_t rates[] = {50'000, 125'000, 250'000, 500'000, 1'000'000};
        TurnsWish w = wish(0, std::chrono::milliseconds(random() % 30), rates[random() % 5]);
        for (auto n = random() % 128; n > 0; --n)
            w.nodes.push_back({static_cast<int>(random() % 3), static_cast<int>(random() % 20) - 1});
        w.places = static_cast<int>(random() % 5);
        const SyncTurns p = plan_turns(w);
        ASSERT_EQ(p.slots.size(), w.nodes.size());
        ASSERT_GE(p.turns, 1);
        ASSERT_LE(p.turns, most_turns);
        ASSERT_GE(p.beat, w.beat);
        ASSERT_LE(bits_of_fullest(p, w), pdo_share(p.beat, w.bit_rate))
            << w.nodes.size() << " nodes at " << milliseconds_of(w.beat) << " ms";
        ASSERT_GE(p.places, w.places);
        ASSERT_EQ(plan_turns(w), p);
    }
}

TEST(SyncTurns, ANodeKeepsItsBeatsWhenOthersComeAndGo) {
    TurnsWish w = wish(31, 2ms);
    const SyncTurns before = plan_turns(w);
    for (std::size_t i = 0; i < w.nodes.size(); ++i)
        w.nodes[i].slot = before.slots[i];
    w.nodes.push_back({1, -1});
    const SyncTurns more = plan_turns(w);
    ASSERT_EQ(more.turns, before.turns);
    for (std::size_t i = 0; i < before.slots.size(); ++i)
        EXPECT_EQ(more.slots[i], before.slots[i]) << i;
    w.nodes.erase(w.nodes.begin() + 3);
    const SyncTurns fewer = plan_turns(w);
    ASSERT_EQ(fewer.turns, before.turns);
    for (std::size_t i = 0; i < w.nodes.size() - 1; ++i)
        EXPECT_EQ(fewer.slots[i], w.nodes[i].slot) << i;
}

TEST(SyncTurns, TargetsThatAreInUseKeepTheirRoom) {
    TurnsWish w = wish(2, 2ms);
    ASSERT_EQ(plan_turns(w).axes, 2);
    w.places = 6;
    const SyncTurns p = plan_turns(w);
    EXPECT_EQ(p.axes, 1) << "rather seldom told than a target lost";
    EXPECT_EQ(p.turns, 2);
    EXPECT_EQ(p.places, 7);
}

TEST(TargetTurns, TheFirstAreLedInEachBeatAndEverybodyGetsAPlace) {
    TargetTurns t;
    const int longest = longest_turns(32, 4);
    ASSERT_EQ(longest, 16);
    std::vector<int> turns;
    std::array<int, TargetTurns::most> in{};
    for (int led = 0; led < 32; ++led) {
        const auto place = t.take(4, 31 - led, longest);
        ASSERT_TRUE(place) << led;
        turns.push_back(place->turns);
        for (std::uint64_t beat = 0; beat < in.size(); ++beat)
            in.at(beat) += place->due(beat) ? 1 : 0;
    }
    EXPECT_EQ(std::vector(turns.begin(), turns.begin() + 5), (std::vector<int>{1, 1, 8, 8, 16}));
    EXPECT_EQ(*std::ranges::max_element(turns), 16);
    EXPECT_EQ(*std::ranges::max_element(in), 4);
    EXPECT_FALSE(t.take(4, 0, longest)) << "full";
}

TEST(TargetTurns, WhatIsLeftOverGoesToWhoComesFirst) {
    TargetTurns t;
    std::vector<int> turns;
    for (int led = 0; led < 8; ++led)
        turns.push_back(t.take(4, 7 - led, longest_turns(8, 4))->turns);
    EXPECT_EQ(turns, (std::vector<int>{1, 1, 2, 2, 4, 4, 4, 4}));
    EXPECT_EQ(t.fullest(), 4);
}

TEST(TargetTurns, APlaceGivenBackIsThereForTheNext) {
    TargetTurns t;
    const auto first = t.take(1, 0, 1);
    ASSERT_TRUE(first);
    EXPECT_FALSE(t.take(1, 0, 1));
    EXPECT_FALSE(t.none());
    t.give_back(*first);
    EXPECT_TRUE(t.none());
    EXPECT_EQ(t.take(1, 0, 1), first);
}

}  // namespace
}  // namespace axisgate::canopen::test
