// The simulated node and SYNC: transmission types 1 to 240, SYNC start value, counter and its overflow (CiA 301, 7.5.2.17 and 7.5.2.37).
#include "adapters/cia402/tests/twin_bench.hpp"
#include "gateway/protocols/canopen/emergency.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using canopen::Abort;

/// TPDO 1 at every `every`th SYNC, then NMT start.
void set_up(Bench& b, int every, int start = 0) {
    ASSERT_EQ(b.write(0x1800, 1, 0xC0000185, 4), Abort::none);
    ASSERT_EQ(b.write(0x1800, 2, every, 1), Abort::none);
    ASSERT_EQ(b.write(0x1800, 6, start, 1), Abort::none);
    ASSERT_EQ(b.write(0x1800, 1, 0x40000185, 4), Abort::none);
    b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
}
/// The SYNCs, counted from 1, at which the PDO came. `counter` is that of the first SYNC; 0: SYNCs without a counter.
std::vector<int> came(Bench& b, int syncs, int counter = 0, int overflow = 0) {
    std::vector<int> at;
    for (int i = 1; i <= syncs; ++i) {
        b.out.clear();
        std::vector<std::uint8_t> data;
        if (counter != 0) data = {static_cast<std::uint8_t>((counter + i - 2) % overflow + 1)};
        b.send(canopen::data_frame(0x80, data));
        if (b.count(0x185) > 0) at.push_back(i);
    }
    return at;
}
using List = std::vector<int>;

TEST(Cia402TwinTurns, APdoOfTypeNComesAtEachNthSyncFromTheStartOfTheNode) {
    Bench b;
    set_up(b, 4);
    EXPECT_EQ(came(b, 12), (List{4, 8, 12}));
    EXPECT_EQ(came(b, 2), List{});
    b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
    EXPECT_EQ(came(b, 4), (List{2})) << "started already: it counts on";
    b.send(canopen::nmt_frame(canopen::NmtCommand::pre_operational, 5));
    EXPECT_EQ(came(b, 3), List{});
    b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
    EXPECT_EQ(came(b, 8), (List{4, 8})) << "anew";
}

TEST(Cia402TwinTurns, APdoThatIsTakenIntoUseCountsFromThere) {
    Bench b;
    set_up(b, 4);
    ASSERT_EQ(came(b, 5), (List{4}));
    ASSERT_EQ(b.write(0x1800, 1, 0xC0000185, 4), Abort::none);
    EXPECT_EQ(came(b, 6), List{});
    ASSERT_EQ(b.write(0x1800, 1, 0x40000185, 4), Abort::none);
    EXPECT_EQ(came(b, 8), (List{4, 8}));
}

TEST(Cia402TwinTurns, TheSyncOfItsStartValueIsTheFirstThatCounts) {
    Bench b;
    ASSERT_EQ(b.write(0x1019, 0, 12, 1), Abort::none);
    set_up(b, 4, 3);
    EXPECT_EQ(came(b, 14, 1, 12), (List{6, 10, 14})) << "3 is the first, 6 the fourth";
    set_up(b, 1, 12);
    EXPECT_EQ(came(b, 4, 11, 12), (List{2, 3, 4})) << "from 12 on, and over the end";
}

TEST(Cia402TwinTurns, AStartValueSaysNothingWhereSyncsHaveNoCounter) {
    Bench b;
    set_up(b, 3, 7);
    EXPECT_EQ(came(b, 6), (List{3, 6}));
}

TEST(Cia402TwinTurns, ASyncOfAnotherLengthIsNoneAndIsToldOnce) {
    Bench b;
    set_up(b, 1);
    b.out.clear();
    for (int i = 0; i < 5; ++i)
        b.send(canopen::data_frame(0x80, std::vector<std::uint8_t>{1}));
    EXPECT_EQ(b.count(0x185), 0u);
    ASSERT_EQ(b.count(0x085), 1u);
    const auto emcy = canopen::emergency_of(b.out.frames[0].frame, 5);
    ASSERT_TRUE(emcy);
    EXPECT_EQ(emcy->code, 0x8240);
    EXPECT_EQ(came(b, 1), (List{1}));
    ASSERT_EQ(b.write(0x1019, 0, 10, 1), Abort::none);
    EXPECT_EQ(came(b, 1), List{});
    EXPECT_EQ(came(b, 1, 5, 10), (List{1}));
}

TEST(Cia402TwinTurns, WhatTheStandardForbidsIsRefused) {
    Bench b;
    EXPECT_EQ(b.write(0x1019, 0, 1, 1), Abort::value);
    EXPECT_NE(b.write(0x1019, 0, 241, 1), Abort::none);
    ASSERT_EQ(b.write(0x1006, 0, 2000, 4), Abort::none);
    EXPECT_EQ(b.write(0x1019, 0, 8, 1), Abort::device_state) << "while a period is produced";
    EXPECT_EQ(b.write(0x1800, 6, 3, 1), Abort::device_state) << "while the PDO is in use";
    ASSERT_EQ(b.write(0x1800, 1, 0xC0000185, 4), Abort::none);
    EXPECT_EQ(b.write(0x1800, 6, 241, 1), Abort::value);
    EXPECT_EQ(b.write(0x1800, 6, 3, 1), Abort::none);
    EXPECT_EQ(b.read(0x1800, 6), 3);
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
