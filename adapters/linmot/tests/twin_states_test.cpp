// The twin: the printed exchanges, every state, and every edge of the control word.
#include <cmath>

#include "adapters/linmot/tests/twin_bench.hpp"

namespace axisgate::linmot::test {
namespace {
constexpr std::int64_t ramp = 1'000'000;  // 10 m/s2

TEST(LinmotTwin, PrintedExchangesByTheirFields) {
    std::size_t played = 0;
    for (const auto& c : cases()) {
        SCOPED_TRACE(c.name);
        const bool forced = std::ranges::count(c.given, std::string("forced")) != 0;
        Bench b(forced ? Bench::Options{{"force", "14"}} : Bench::Options{});
        for (const auto& g : c.given) {
            if (g == "stopped") (void)b.ask("01 11 03 02 03 06 04");
            if (g == "enabled") b.enable();
            if (g == "curve") {
                auto& curve = b.drive().curves[1];
                curve.info.resize(70);
                for (int i = 0; i <= 20; ++i)
                    Bench::put(curve.data, std::llround(500'000 * (1 - std::cos(M_PI * i / 20))), 4);
            }
        }
        for (const auto& x : c.exchanges) {
            auto answer = b.ask(x.request);
            if (answer.empty()) {
                b.run(5s);
                answer = b.late;
            }
            ++played;
            ASSERT_EQ(answer.size(), x.answer.size());
            if (c.compare.empty()) {
                EXPECT_EQ(answer, x.answer);
                continue;
            }
            for (const auto& name : c.compare) {
                const auto pick = [&](const std::vector<std::uint8_t>& a) -> int {
                    if (name == "comm") return a[6];
                    if (name == "status") return a[7] | a[8] << 8;
                    if (name == "state") return a[10];
                    if (name == "sub") return a[9];
                    if (name == "count") return a[9] & 15;
                    return static_cast<int>(a.size());
                };
                EXPECT_EQ(pick(answer), pick(x.answer)) << name;
            }
        }
    }
    EXPECT_EQ(played, 43u);
}

// --- state machine ----------------------------------------------------------------------------------------------------------
/// Brings a new drive to the state.
void bring(Bench& b, int state) {
    if (state == 0) return;
    b.control(0);
    if (state == 1) return;
    b.control(0x3E);
    if (state == 2) return;
    if (state == 3) return (void)b.hand("inject_error", Value{std::int64_t{0x50}});
    if (state == 4) return (void)b.hand("inject_error", Value{std::int64_t{0x40}});
    b.control(state == 6 ? 0x37 : 0x3F);
    if (state == 5) return;
    b.run(400ms);
    switch (state) {
        case 9:
            return b.control(0x083F);
        case 10:
            return b.control(0x103F);
        case 11:
            return b.control(0x203F);
        case 12:
            return b.control(0x2F);
        case 13:
            return b.control(0x1F);
        case 14:
            b.motion("010xh", {10'000'000, 1'000'000, ramp, ramp});
            b.run(200ms);
            return b.control(0x3B);
        case 15:
            return b.control(0x7F);
        case 16:
            return b.control(0x13F);
        case 17:
            return b.control(0x23F);
        case 19:
            return b.control(0x803F);
        default:
            return;
    }
}

TEST(LinmotTwin, EveryStateIsReached) {
    for (const int s : {0, 1, 2, 3, 4, 5, 6, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 19}) {
        Bench b;
        bring(b, s);
        EXPECT_EQ(b.state(), s);
    }
    Bench special(Bench::Options{{"series", "b1100"}});
    bring(special, 8);
    special.control(0x43F);
    EXPECT_EQ(special.state(), 20);
}

TEST(LinmotTwin, EveryControlWordEdgeFromEveryState) {
    struct Row {
        int from;
        std::uint16_t word;
        int to;
    };
    // From the text [L105-379]; 14 ends when the motor stands still.
    std::vector<Row> rows{{0, 0x3F, 0},  {0, 0x3E, 2},    {0, 0x00, 1},    {1, 0x06, 2},    {1, 0x02, 1},  {1, 0x04, 1},   {2, 0x3F, 5},
                          {2, 0x39, 1},  {3, 0x3F, 4},    {3, 0x3E, 3},    {4, 0x3E, 4},    {4, 0xBE, 2},  {5, 0x3E, 2},   {5, 0x3D, 1},
                          {5, 0x3B, 1},  {6, 0x3F, 8},    {6, 0x36, 2},    {6, 0x35, 1},    {6, 0x33, 1},  {8, 0x37, 6},   {8, 0x2F, 12},
                          {8, 0x1F, 13}, {8, 0x083F, 9},  {8, 0x103F, 10}, {8, 0x203F, 11}, {8, 0x7F, 15}, {8, 0x13F, 16}, {8, 0x23F, 17},
                          {8, 0x33F, 8}, {8, 0x803F, 19}, {8, 0x43F, 8},   {9, 0x3F, 8},    {10, 0x3F, 8}, {11, 0x3F, 8},  {12, 0x3F, 8},
                          {13, 0x3F, 8}, {15, 0x3F, 8},   {16, 0x3F, 8},   {17, 0x3F, 8},   {19, 0x3F, 8}, {12, 0x2F, 12}, {13, 0x1F, 13}};
    for (const int s : {8, 9, 10, 11, 12, 13, 15, 16, 17, 19}) {
        rows.push_back({s, 0x3E, 2});  // OFF1
        rows.push_back({s, 0x3D, 1});  // OFF2
        rows.push_back({s, 0x37, 6});  // enable operation is reset
    }
    for (const auto& r : rows) {
        Bench b;
        bring(b, r.from);
        ASSERT_EQ(b.state(), r.from);
        b.control(r.word);
        EXPECT_EQ(b.state(), r.to) << "from " << r.from << " by " << std::hex << r.word;
    }
    for (const int s : {8, 9, 12, 16}) {  // OFF3: quick stop, then switch on disabled
        Bench b;
        bring(b, s);
        b.control(0x3B);
        EXPECT_TRUE(b.state() == 14 || b.state() == 1) << s;
        b.run(2s);
        EXPECT_EQ(b.state(), 1);
    }
}

/// Every bit, changed alone, in every state that can be entered (18 has no trigger in the manual). Bits that are not listed change nothing.
TEST(LinmotTwin, EverySingleBitInEveryState) {
    struct Row {
        int state;
        std::uint16_t word;                   ///< with which the state is entered and held
        std::vector<std::pair<int, int>> to;  ///< bit, state
    };
    const auto powered = [](std::vector<std::pair<int, int>> more) {
        more.insert(more.end(), {{0, 2}, {1, 1}, {2, 14}, {3, 6}});
        return more;
    };
    const std::vector<Row> rows{
        {0, 0x0001, {{0, 1}}},
        {1, 0x0000, {}},
        {2, 0x003E, {{0, 5}, {1, 1}, {2, 1}}},
        {3, 0x003E, {{0, 4}}},
        {4, 0x003E, {{7, 2}}},  // 0, 1, 2: bit 0 is low
        {5, 0x003F, {{0, 2}, {1, 1}, {2, 1}}},
        {6, 0x0037, {{0, 2}, {1, 1}, {2, 1}, {3, 8}}},
        {8, 0x003F, powered({{4, 12}, {5, 13}, {6, 15}, {8, 16}, {9, 17}, {11, 9}, {12, 10}, {13, 11}, {15, 19}})},
        {9, 0x083F, powered({{11, 8}})},
        {10, 0x103F, powered({{12, 8}})},
        {11, 0x203F, powered({{13, 8}})},
        {12, 0x002F, powered({{4, 8}})},
        {13, 0x001F, powered({{5, 8}})},
        {14, 0x003B, {{0, 1}, {1, 1}}},  // the state ends when the motor stands still; OFF1 leads to 2, which OFF3 does not permit
        {15, 0x007F, powered({{6, 8}})},
        {16, 0x013F, powered({{8, 8}, {9, 8}})},
        {17, 0x023F, powered({{9, 8}, {8, 8}})},
        {19, 0x803F, powered({{15, 8}})},
        {20, 0x043F, powered({{10, 8}})},
    };
    std::size_t edges = 0;
    for (const Row& r : rows) {
        for (int bit = 0; bit < 16; ++bit) {
            Bench b(r.state == 20 ? Bench::Options{{"series", "b1100"}} : Bench::Options{});
            bring(b, r.state == 20 ? 8 : r.state);
            if (r.state == 20) b.control(r.word);
            ASSERT_EQ(b.state(), r.state);
            int to = r.state;
            for (const auto& [which, state] : r.to) {
                if (which == bit) to = state;
            }
            b.control(static_cast<std::uint16_t>(r.word ^ 1u << bit));
            EXPECT_EQ(b.state(), to) << "from " << r.state << " by bit " << bit;
            ++edges;
        }
    }
    EXPECT_EQ(edges, 19u * 16u);
}

TEST(LinmotTwin, ACompleteWordAtPowerOnRestsLocked) {
    Bench b;
    b.control(0x3F);
    b.run(2s);
    EXPECT_EQ(b.state(), 0);
    EXPECT_NE(b.drive().status_word() & 0x40, 0) << "switch on locked";
    b.control(0x3E);
    b.control(0x3F);
    EXPECT_EQ(b.drive().state_var(), 0x0500) << "the hardware tests take their time";
    b.run(299ms);
    EXPECT_EQ(b.state(), 5);
    b.run(1ms);
    EXPECT_EQ(b.state(), 8);
}

TEST(LinmotTwin, HomingEndsInStateNineUntilTheBitIsReleased) {
    Bench b;
    (void)b.hand("position", Value{std::int64_t{300'000}});
    b.enable();
    EXPECT_NE(b.drive().warn_word() & 0x80, 0);
    b.control(0x083F);
    EXPECT_EQ(b.drive().state_var(), 0x0900);
    EXPECT_EQ(b.drive().status_word() >> 11 & 1, 0) << "not homed meanwhile";
    b.run(10s);
    EXPECT_EQ(b.drive().state_var(), 0x090F);
    EXPECT_EQ(b.position(), 0);
    b.control(0x3F);
    EXPECT_EQ(b.state(), 8);
    EXPECT_NE(b.sub() & 0x80, 0);
    EXPECT_EQ(b.drive().warn_word() & 0x80, 0);
}

TEST(LinMotTwinTable, AnEntryThatStartsItselfGoesOnForEverAndStopsAtAStop) {
    Bench b;
    b.enable();
    twin::TableEntry entry{};
    entry[2] = entry[3] = 0xFF;
    entry[5] = 0x20;
    entry[6] = 2;  // each entry starts the other
    b.drive().table[1] = entry;
    entry[6] = 1;
    b.drive().table[2] = entry;
    b.motion("200xh", {1});
    const auto before = b.drive().commands_done();
    EXPECT_LT(before, 100u) << "one instant has an end";
    b.run(100ms);
    EXPECT_GT(b.drive().commands_done(), before + 300) << "it goes on";
    EXPECT_EQ(b.state(), 8);
    b.motion("017xh", {1'000'000});
    const auto stopped = b.drive().commands_done();
    b.run(100ms);
    EXPECT_EQ(b.drive().commands_done(), stopped);
}

}  // namespace
}  // namespace axisgate::linmot::test
