// The simulated MACS on the bus: the life cycle of parameters, scopes, computed values, homing, limits, errors, gear. The expected values
// are those of the manual.
#include "adapters/aposs/tests/macs_bench.hpp"

namespace axisgate::aposs::test {
namespace {
TEST(ApossTwin, AnswersAsTheVectorsSay) { EXPECT_GE(Macs().answers_of_vectors("aposs"), 12u); }

TEST(ApossTwin, TheSameNumberIsAnotherParameterInTheOtherScopeAndOfTheOtherAxis) {
    Macs b;
    ASSERT_EQ(b.set(101, 77), Abort::none);
    EXPECT_EQ(b.get(101), 77);
    EXPECT_EQ(b.get(101, 1), 0) << "the second axis has its own";
    EXPECT_EQ(b.read(0x2200, 102), 5) << "CANBAUD";
    ASSERT_EQ(b.write(0x2200, 102, 7, 4), Abort::none);
    EXPECT_EQ(b.get(101), 77);
}

TEST(ApossTwin, AValueThatIsSetDiesWithTheProgramUnlessItIsStored) {
    Macs b;
    b.hand("program", Value{true});
    ASSERT_EQ(b.set(11, 55), Abort::none);  // KPROP, init value 30
    EXPECT_EQ(b.get(11), 55);
    b.hand("program", Value{false});
    EXPECT_EQ(b.get(11), 30) << "the program value is erased, there is no user value";
    ASSERT_EQ(b.set(11, 60), Abort::none);
    ASSERT_EQ(b.saveprom(), Abort::none);
    b.hand("program", Value{true});
    ASSERT_EQ(b.set(11, 61), Abort::none);
    b.hand("program", Value{false});
    EXPECT_EQ(b.get(11), 60) << "the user value returns";
    b.off_and_on();
    EXPECT_EQ(b.get(11), 60) << "over a power cycle, too";
    b.hand("reset_parameters", Value{true});
    EXPECT_EQ(b.get(11), 30);
}

TEST(ApossTwin, AValueSetWithoutAProgramDoesNotLeakIntoTheNextOne) {
    Macs b;
    ASSERT_EQ(b.set(12, 5), Abort::none);
    b.hand("program", Value{true});
    EXPECT_EQ(b.get(12), 0) << "user values are read again before every program start";
    ASSERT_EQ(b.set(12, 6), Abort::none);
    b.off_and_on();
    EXPECT_EQ(b.get(12), 0);
}

TEST(ApossTwin, EachSaveIsAWriteOfTheEprom) {
    Macs b;
    const auto writes = [&] {
        for (const HandItem& i : b.twin->hand())
            if (i.name == "eprom_writes") return as_integer(i.value).value_or(-1);
        return std::int64_t{-1};
    };
    EXPECT_EQ(writes(), 0);
    const auto revision = b.twin->non_volatile_revision();
    ASSERT_EQ(b.saveprom(), Abort::none);
    ASSERT_EQ(b.set(11, 31), Abort::none);
    EXPECT_EQ(writes(), 1) << "a SET writes no EPROM";
    ASSERT_EQ(b.saveprom(), Abort::none);
    EXPECT_EQ(writes(), 2);
    EXPECT_GT(b.twin->non_volatile_revision(), revision);
    b.off_and_on();
    EXPECT_EQ(writes(), 2) << "the count is worth as much as what it counts";
    EXPECT_EQ(b.write(0x1010, 1, 1, 4), Abort::transfer) << "without the word nothing is stored";
}

TEST(ApossTwin, ComputedValuesFollowTheirSources) {
    Macs b;
    EXPECT_EQ(b.get(9), 2'184'533);
    EXPECT_EQ(b.get(10), 2184);
    ASSERT_EQ(b.set(1, 3000), Abort::none);
    EXPECT_EQ(b.get(9), 6'553'600) << "3000 rpm, 500 counts: 100 qc/ms";
    ASSERT_EQ(b.set(31, 500), Abort::none);
    EXPECT_EQ(b.get(10), 13'107) << "0.2 qc/ms^2";
    ASSERT_EQ(b.set(27, 1), Abort::none);
    EXPECT_EQ(b.get(9), 1'638'400) << "an absolute encoder has its counts once";
    EXPECT_EQ(b.get(9, 1), 2'184'533) << "and the second axis its own";
    EXPECT_EQ(b.set(10, 1), Abort::read_only);
}

TEST(ApossTwin, VariableFourThousandOneHundredAndFiveIsWrittenAsASpeedAndReadAsAPlace) {
    Macs b;
    ASSERT_EQ(b.write(0x2500, 10, 20, 4), Abort::none);
    b.pass(100ms);
    EXPECT_NEAR(static_cast<double>(b.read(0x2500, 10)), 2000, 20);
    ASSERT_EQ(b.write(0x2500, 10, 0, 4), Abort::none);
    const auto stands = b.read(0x2500, 10);
    b.pass(100ms);
    EXPECT_EQ(b.read(0x2500, 10), stands);
}

TEST(ApossTwin, NothingMovesWhereHomingIsForcedUntilItIsDone) {
    Macs b;
    ASSERT_EQ(b.set(3, 1), Abort::none);
    b.enable_axis(0);
    b.go(0, 1000);
    EXPECT_EQ(b.error(), 0xFF06) << "error 6";
    b.pass(1s);
    EXPECT_EQ(b.position_of(0), 0);
    EXPECT_EQ(b.status_of(0) & 0x4F, 0x08) << "by ERRCOND 0 the loop is open";
    ASSERT_EQ(b.write(0x6040, 0, 0x80, 2), Abort::none);
    b.enable_axis(0, 6);
    ASSERT_EQ(b.write(0x6098, 0, 35, 1), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0x1F, 2), Abort::none);
    b.pass(100ms);
    EXPECT_EQ(b.get(3), 255) << "forced and done";
    ASSERT_EQ(b.write(0x6040, 0, 0x0F, 2), Abort::none);
    ASSERT_EQ(b.write(0x6060, 0, 1, 1), Abort::none);
    b.go(0, 1000);
    b.pass(2s);
    EXPECT_EQ(b.position_of(0), 1000);
    ASSERT_EQ(b.set(11, 44), Abort::none);
    EXPECT_EQ(b.get(3), 255) << "a SET revokes nothing";
    ASSERT_EQ(b.saveprom(), Abort::none);
    EXPECT_EQ(b.get(3), 1) << "a changed user parameter does (E-72)";
}

TEST(ApossTwin, PositioningOutsideASoftwareLimitIsNotStarted) {
    Macs b;
    ASSERT_EQ(b.set(5, 5000), Abort::none);
    b.enable_axis(0);
    b.go(0, 6000);
    b.pass(3s);
    EXPECT_EQ(b.position_of(0), 6000) << "a limit that is not active limits nothing";
    ASSERT_EQ(b.set(20, 1), Abort::none);
    b.go(0, 7000);
    EXPECT_EQ(b.error(), 0x8612);
    b.pass(1s);
    EXPECT_EQ(b.position_of(0), 6000);
    EXPECT_EQ(b.status_of(1) & 0x6F, 0x40) << "of the other axis nothing is said";
}

TEST(ApossTwin, APositionErrorTakesTheControlOffAllAxes) {
    Macs b;
    b.enable_axis(0);
    b.enable_axis(1);
    b.hand("stall", Value{true});
    b.go(0, 100'000);
    b.pass(2s);
    EXPECT_EQ(b.status_of(0) & 0x4F, 0x08);
    EXPECT_EQ(b.error(), 0x8611);
    EXPECT_EQ(b.status_of(1) & 0x4F, 0x08) << "the other one, too";
}

TEST(ApossTwin, ErrorConditionFiveLeavesTheControlOn) {
    Macs b;
    ASSERT_EQ(b.set(43, 5), Abort::none);
    ASSERT_EQ(b.set(3, 1), Abort::none);
    b.enable_axis(0);
    ASSERT_EQ(b.write(0x607A, 0, 1000, 4), Abort::none);
    b.out.clear();
    b.send(canopen::sdo_frame(0x605, 0x2B, {0x6040, 0}, 0x3F));
    EXPECT_TRUE(b.reported(0xFF06));
    b.pass(1s);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x27);
    EXPECT_EQ(b.position_of(0), 0);
}

TEST(ApossTwin, InElectronicGearTheSecondAxisFollowsTheFirst) {
    Macs b;
    EXPECT_NE(b.twin->set_hand("gear", Value{std::string("position")}, b.now, b.out), "") << "the second axis is off";
    ASSERT_EQ(b.set(49, 2, 1), Abort::none);    // SYNCFACTM
    ASSERT_EQ(b.set(50, 3, 1), Abort::none);    // SYNCFACTS
    ASSERT_EQ(b.set(34, 100, 1), Abort::none);  // DFLTACC: the acceleration of its master, times three halves
    b.enable_axis(0);
    b.enable_axis(1);
    b.pass(10ms);
    EXPECT_EQ(b.position_of(1), 0) << "nothing moves by itself";
    b.hand("gear", Value{std::string("position")});
    b.go(0, 2000);
    b.pass(200ms);
    const auto on_the_way = b.position_of(0);
    EXPECT_GT(on_the_way, 100);
    EXPECT_NEAR(static_cast<double>(b.position_of(1)), 1.5 * static_cast<double>(on_the_way), 60) << "one sample late";
    b.pass(2s);
    EXPECT_EQ(b.position_of(0), 2000);
    EXPECT_EQ(b.position_of(1), 3000);
    ASSERT_EQ(b.set(54, 250, 1), Abort::none);  // SYNCPOSOFFS acts at once with SYNCP
    b.pass(1s);
    EXPECT_EQ(b.position_of(1), 3250);
    ASSERT_EQ(b.write(0x6840, 0, 0x10F, 2), Abort::none);  // halt
    b.go(0, 0);
    b.pass(2s);
    EXPECT_EQ(b.position_of(0), 0);
    EXPECT_EQ(b.position_of(1), 3250) << "a stop of the slave ends the gear";
}

TEST(ApossTwin, ANegativeFactorTurnsTheSlaveAndWhatVelocityGearLosesIsLost) {
    Macs b;
    ASSERT_EQ(b.set(49, -1, 1), Abort::none);
    b.enable_axis(0);
    b.enable_axis(1);
    b.hand("gear", Value{std::string("velocity")});
    b.go(0, 1000);
    b.pass(2s);
    EXPECT_EQ(b.position_of(1), -1000);
    ASSERT_EQ(b.set(1, 1, 1), Abort::none);  // one turn per minute: 2000 qc in 60 s
    b.go(0, 3000);
    b.pass(2s);
    const auto behind = b.position_of(1);
    EXPECT_GT(behind, -1200) << "too slow for its master";
    b.pass(5s);
    EXPECT_EQ(b.position_of(1), behind) << "and nothing is made good";
}

}  // namespace
}  // namespace axisgate::aposs::test
