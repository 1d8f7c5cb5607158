// Coded values of the simulated MACS: every digit and bit that the manual names, and values without a meaning.
#include <gtest/gtest.h>

#include "adapters/aposs/tests/macs.hpp"
#include "adapters/aposs/twin/coded.hpp"

namespace axisgate::aposs::test {
namespace {

TEST(ApossCoded, EncodersAreToldByTheirNumber) {  // [L2941-3177, L4784-5003]
    struct Row {
        std::int64_t value;
        Encoder source;
        int number, device, pdo;
        bool guarded, slave_bus, absolute;
    };
    for (const Row& r :
         {Row{0, Encoder::incremental, 0, 0, 0, false, false, false}, Row{2, Encoder::absolute, 0, 0, 0, false, false, true},
          Row{3, Encoder::linear_absolute, 0, 0, 0, false, false, true}, Row{5, Encoder::sine_cosine, 0, 0, 0, false, false, false},
          Row{9, Encoder::simulation, 0, 0, 0, false, false, false}, Row{20, Encoder::incremental, 2, 0, 0, false, false, false},
          Row{1005, Encoder::can, 5, 1, 2, true, false, false}, Row{-1005, Encoder::can, 5, 1, 2, false, false, false},
          Row{101'257, Encoder::can, 1, 1, 3, true, true, false}, Row{100'007, Encoder::can, 7, 0, 2, true, true, false},
          Row{-150'127, Encoder::can, 127, 50, 2, false, true, true}, Row{94'003, Encoder::can, 3, 94, 2, true, false, false}}) {
        SCOPED_TRACE(r.value);
        const auto e = encoder_of(r.value, false);
        ASSERT_TRUE(e);
        EXPECT_EQ(e->source, r.source);
        EXPECT_EQ(e->number, r.number);
        EXPECT_EQ(e->device, r.device);
        EXPECT_EQ(e->pdo, r.pdo);
        EXPECT_EQ(e->guarded, r.guarded);
        EXPECT_EQ(e->slave_bus, r.slave_bus);
        EXPECT_EQ(e->absolute(), r.absolute);
    }
    const auto ethercat = encoder_of(251'105, false);
    ASSERT_TRUE(ethercat);
    EXPECT_EQ(ethercat->pdo, 1);
    EXPECT_EQ(ethercat->first_long, 5) << "position at the long with index 5, its index at 6";
    for (const std::int64_t none : {6, 7, 40, 1000, 1128, 1384, 2257, 51'001, 100'000, 200'000, -1, 252'000})
        EXPECT_FALSE(encoder_of(none, false)) << none;
    EXPECT_EQ(encoder_of(6, true)->source, Encoder::simulation) << "of a master";
    EXPECT_FALSE(encoder_of(9, true));
    EXPECT_FALSE(encoder_of(3, true));
    EXPECT_FALSE(encoder_of(94'003, true));
    EXPECT_EQ(encoder_of(-2, true)->source, Encoder::axis_command) << "and not CAN without guarding (E-37)";
    EXPECT_EQ(encoder_of(-2, true)->number, 2);
}

TEST(ApossCoded, ReversIsModeOutputAndNode) {  // the manual's samples [L4595-4616]
    EXPECT_EQ(revers_of(0), (ReversCode{0, 0, false, 0}));
    EXPECT_EQ(revers_of(11), (ReversCode{1, 1, false, 0}));
    EXPECT_EQ(revers_of(20), (ReversCode{0, 2, false, 0}));
    EXPECT_EQ(revers_of(100), (ReversCode{0, 0, false, 1}));
    EXPECT_EQ(revers_of(9602), (ReversCode{2, 0, false, 96}));
    EXPECT_EQ(revers_of(-30), (ReversCode{0, 3, true, 0})) << "outputs 3 and 4";
    for (const std::int64_t none : {3, 9, 13, 90, -5, -11, -100, 12'800})
        EXPECT_FALSE(revers_of(none)) << none;
}

TEST(ApossCoded, DirectionsOfVelocityPositionAndUnits) {  // [L3178-3260]
    EXPECT_EQ(direction_of(1), (DirectionCode{false, false, false}));
    EXPECT_EQ(direction_of(-1), (DirectionCode{false, false, true}));
    EXPECT_EQ(direction_of(2), (DirectionCode{true, true, false}));
    EXPECT_EQ(direction_of(22), direction_of(2));
    EXPECT_EQ(direction_of(-2), (DirectionCode{true, true, true}));
    EXPECT_EQ(direction_of(12), (DirectionCode{false, true, false}));
    EXPECT_EQ(direction_of(-21), (DirectionCode{true, false, true}));
    for (std::int64_t none = 3; none <= 11; ++none)
        EXPECT_FALSE(direction_of(none)) << none;
    for (const std::int64_t none : {0, 13, 20, -3, -13, 23})
        EXPECT_FALSE(direction_of(none)) << none;
}

TEST(ApossCoded, MarkersHaveKindInputAndGate) {  // [L4303-4418, L6934-6971]
    EXPECT_EQ(marker_of(42, true), (MarkerCode{true, false, 4, 0})) << "SET SYNCMTYPM x(1) 42: input 4, rising";
    EXPECT_EQ(marker_of(1, true), (MarkerCode{false, true, 0, 0}));
    EXPECT_EQ(marker_of(203, true), (MarkerCode{true, true, 0, 2}));
    EXPECT_EQ(marker_of(-103, true), (MarkerCode{true, true, 0, -1}));
    for (const std::int64_t none : {4, 14, -1, -42, 204})
        EXPECT_FALSE(marker_of(none, true)) << none;
    EXPECT_FALSE(marker_of(103, false)) << "the slave has no gate";
    EXPECT_TRUE(means_something("VMENCMTYP", 0) && means_something("VMENCMTYP", 43) && !means_something("VMENCMTYP", 1));
}

TEST(ApossCoded, TheOtherCodes) {
    EXPECT_EQ(drive_of(-110), (DriveCode{10, false, true})) << "the control word is left alone";
    EXPECT_EQ(drive_of(13), (DriveCode{13, true, false}));
    for (const std::int64_t none : {6, 9, 14, 90, 100, 106, 195})
        EXPECT_FALSE(drive_of(none)) << none;
    EXPECT_EQ(program_of(-1), (ProgramCode{-1, false}));
    EXPECT_EQ(program_of(999), (ProgramCode{-1, true}));
    EXPECT_EQ(program_of(1127), (ProgramCode{127, true}));
    EXPECT_FALSE(program_of(128));
    EXPECT_EQ(virtual_master_of(100'205), (VirtualMasterCode{2, 5, true}));
    EXPECT_EQ(baud_of(57), (std::pair{125, 500})) << "master, slave [L6497]";
    EXPECT_EQ(baud_of(5), (std::pair{125, 125}));
    EXPECT_FALSE(baud_of(59));
    EXPECT_TRUE(means_something("SYNCMSTART", 1007) && means_something("SYNCMSTART", 2000) && !means_something("SYNCMSTART", 8));
    EXPECT_TRUE(means_something("SYNCMFPAR", 87) && !means_something("SYNCMFPAR", 8));
    EXPECT_FALSE(means_something("SYNCFACTM", 0));
}

}  // namespace
}  // namespace axisgate::aposs::test
