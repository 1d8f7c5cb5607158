// The controller's own bus, as far as the manual describes it: objects that coded parameters create, and control words of its drives.
#include <gtest/gtest.h>

#include "adapters/aposs/tests/macs_bench.hpp"

namespace axisgate::aposs::test {
namespace {

std::string shown(Macs& b, const std::string& name) {
    for (const HandItem& i : b.twin->hand())
        if (i.name == name) return to_text(i.value);
    return "?";
}

TEST(ApossBus, AutomaticObjectsStayUntilAnotherSetOrTheNextStart) {  // [L1552-1565]
    Macs b;
    EXPECT_EQ(shown(b, "can_objects"), "none");
    ASSERT_EQ(b.set(63, 300, 1), Abort::none);  // REVERS: node 3
    b.hand("program", Value{true});
    ASSERT_EQ(say(b, "SET DRIVETYPE x(2) 2"), "SET DRIVETYPE x(2) 2");
    ASSERT_EQ(say(b, "SET MENCODERTYPE x(2) 1003"), "SET MENCODERTYPE x(2) 1003");
    const std::string both = "DRIVETYPE x(2): PDO, SYNC, GUARD; MENCODERTYPE x(2): PDO, SYNC, GUARD";
    EXPECT_EQ(shown(b, "can_objects"), both);
    EXPECT_EQ(seen(b, "nmt0"), 2);
    ASSERT_EQ(say(b, "SET DRIVETYPE x(2) 2"), "SET DRIVETYPE x(2) 2");
    EXPECT_EQ(seen(b, "nmt0"), 2) << "the same value again: nothing";
    ASSERT_EQ(say(b, "CANINI"), "CANINI");
    EXPECT_EQ(shown(b, "can_objects"), both + "; application: 1");
    ASSERT_EQ(say(b, "CANDEL -1"), "CANDEL -1");
    EXPECT_EQ(shown(b, "can_objects"), both) << "CANDEL -1 is for the application's";
    ASSERT_EQ(say(b, "SET I_BREAK 1"), "SET I_BREAK 1");
    b.hand("inputs", Value{std::int64_t{1}});
    EXPECT_EQ(b.get(0, 1), 0) << "the program is aborted: its values have died";
    EXPECT_EQ(shown(b, "can_objects"), both) << "and the objects stay, guarding with them";
    b.hand("bus_silent", Value{true});
    b.pass(2s);
    EXPECT_EQ(b.error(), 0xFF00 + 88);
    b.hand("bus_silent", Value{false});
    EXPECT_EQ(say(b, "ERRCLR"), "ERRCLR");
    b.hand("program", Value{true});
    EXPECT_EQ(shown(b, "can_objects"), "none") << "the next start makes them of the permanent values";
    ASSERT_EQ(say(b, "SET DRIVETYPE x(2) -2"), "SET DRIVETYPE x(2) -2");
    EXPECT_EQ(shown(b, "can_objects"), "DRIVETYPE x(2): PDO, SYNC") << "below 0: without guarding";
    ASSERT_EQ(say(b, "SET DRIVETYPE x(2) 0"), "SET DRIVETYPE x(2) 0");
    EXPECT_EQ(shown(b, "can_objects"), "none") << "another SET takes them away";
    // Stored values are in force after power-on.
    ASSERT_EQ(say(b, "SET ENCODERTYPE x(1) -101005"), "SET ENCODERTYPE x(1) -101005");
    ASSERT_EQ(b.saveprom(), Abort::none);
    b.off_and_on();
    EXPECT_EQ(shown(b, "can_objects"), "ENCODERTYPE x(1): PDO, SYNC");
    EXPECT_EQ(seen(b, "nmt0"), 1);
    b.hand("program", Value{true});
    EXPECT_EQ(seen(b, "nmt0"), 2) << "a start makes them anew, also those that are the same";
}

TEST(ApossBus, TheServostarHasItsWords) {  // [L1667-1682]
    Macs b;
    const auto does = [&](const char* line) { EXPECT_EQ(say(b, line), line); };
    ASSERT_EQ(b.set(0, -11), Abort::none);
    does("MOTOR ON x(1)");
    EXPECT_EQ(seen(b, "drive_word"), 0x0F);
    EXPECT_EQ(seen(b, "drive_enabled"), 1);
    does("MOTOR OFF x(1)");
    EXPECT_EQ(seen(b, "drive_word"), 0x06);
    does("MOTOR ON x(1)");
    b.hand("inject_error", Value{std::int64_t{89}});
    EXPECT_EQ(seen(b, "drive_word"), 0x06) << "an error";
    b.hand("inject_error", Value{std::int64_t{0}});
    does("ERRCLR");
    // With ERRCOND 4 the stop is a quick stop, and it is left with ERRCOND 0.
    ASSERT_EQ(b.set(43, 4), Abort::none);
    does("MOTOR ON x(1)");
    EXPECT_EQ(seen(b, "drive_enabled"), 1);
    b.hand("inject_error", Value{std::int64_t{89}});
    EXPECT_EQ(seen(b, "drive_word"), 0x02);
    b.hand("inject_error", Value{std::int64_t{0}});
    does("ERRCLR");
    does("MOTOR OFF x(1)");
    EXPECT_EQ(seen(b, "drive_word"), 0x02);
    does("MOTOR ON x(1)");
    EXPECT_EQ(seen(b, "drive_enabled"), 0) << "from its quick stop the drive does not go back";
    ASSERT_EQ(b.set(43, 0), Abort::none);
    does("MOTOR OFF x(1)");
    EXPECT_EQ(seen(b, "drive_word"), 0x06) << "ready to switch on";
    ASSERT_EQ(b.set(43, 4), Abort::none);
    does("MOTOR ON x(1)");
    EXPECT_EQ(seen(b, "drive_word"), 0x0F);
    EXPECT_EQ(seen(b, "drive_enabled"), 1);
}

TEST(ApossBus, TheControllerLeavesTheWordAloneWhereItIsTheApplications) {  // DRIVETYPE +/-100 [L1632-1660]
    Macs b;
    const auto does = [&](const char* line) { EXPECT_EQ(say(b, line), line); };
    ASSERT_EQ(b.set(43, 5), Abort::none);
    EXPECT_NE(say(b, "OUTDA x(1) 75235328").find("+/-100"), std::string::npos);
    for (const int type : {110, -110, 111}) {
        SCOPED_TRACE(type);
        ASSERT_EQ(b.set(0, type), Abort::none);
        does("OUTDA x(1) 75235328");  // 047Ch << 16: run
        EXPECT_EQ(seen(b, "drive_word"), 0x047C);
        for (const char* line : {"MOTOR ON x(1)", "CSTART", "CVEL 50"})
            does(line);
        b.pass(600ms);
        does("OUTDA x(1) 104595456");  // 063Ch << 16: stop by ramp 2
        b.pass(5ms);
        does("MOTOR OFF x(1)");
        EXPECT_EQ(seen(b, "drive_word"), 0x063C) << "not even MOTOR OFF";
        b.pass(2s);
        does("OUTDA x(1) 74711040");
        EXPECT_EQ(seen(b, "drive_word"), 0x0474) << "coast";
    }
    // The control words of other drives are not printed, so none are sent.
    ASSERT_EQ(b.set(0, -2), Abort::none);
    does("MOTOR ON x(1)");
    EXPECT_EQ(seen(b, "drive_word"), -1);
}

}  // namespace
}  // namespace axisgate::aposs::test
