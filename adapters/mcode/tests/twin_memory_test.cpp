// RAM against non-volatile memory, program memory and its editor.
// In: typed lines, power. Out: values, listings.
// Never reads the memory's map for what can be asked on the wire.
#include "adapters/mcode/tests/twin_bench.hpp"

namespace axisgate::mcode::twin::test {
namespace {

Bench again(const Bench& old) { return Bench(DeviceSetup{}, old.device->non_volatile()); }

TEST(TwinMemory, UnsavedIsLost) {
    Bench b;
    b.type("A=5000");
    b.type("R1=7");
    b.type("VA Q1=3");
    b.type("S");
    b.type("A=6000");
    b.type("Q1=4");
    b.send("\x03");
    EXPECT_EQ(b.type("PR A"), "5000");
    EXPECT_EQ(b.type("PR R1"), "7");
    EXPECT_EQ(b.type("PR Q1"), "3");
    Bench after = again(b);
    EXPECT_EQ(after.type("PR A"), "5000");
    EXPECT_EQ(after.type("PR UV"), "Q1 = G 3");
}

TEST(TwinMemory, CountersAndErrorsDoNotSurvive) {  // [E-66]
    Bench b;
    b.type("P=100");
    b.type("QQQQ 1");
    b.type("S");
    Bench after = again(b);
    EXPECT_EQ(after.type("PR P"), "0");
    EXPECT_EQ(after.type("PR ER"), "0");
}

TEST(TwinMemory, InitializeTakesSavedValuesBack) {
    Bench b;
    b.type("VA Q1=3");
    b.type("S");
    b.type("Q1=9");
    b.type("VA Q2=5");
    b.type("A=5000");
    b.type("IP");
    EXPECT_EQ(b.type("PR A"), "1000000");
    EXPECT_EQ(b.type("PR Q1"), "3");
    EXPECT_EQ(b.type("PR Q2"), "5") << "stays declared";
}

TEST(TwinMemory, FactoryDefaultsAtOnceAndWhatIsKept) {  // trap 17
    DeviceSetup s;
    s.name = 'c';
    Bench b(s);
    b.send("\ncEM=2\n");
    b.send("cPY=0\n");
    b.send("EM=0\r");
    b.program({"LB K1", "E"});
    b.type("VA Q1=1");
    b.type("LK=1");
    b.type("S");
    const std::string pn = b.type("PR PN");
    b.type("FD");
    EXPECT_EQ(b.type("PR DN"), "!");
    EXPECT_EQ(b.type("PR LK"), "0");
    EXPECT_EQ(b.type("PR PN"), pn);
    EXPECT_EQ(b.type("L"), "");
    EXPECT_EQ(b.type("PR UV"), "");
    Bench after(s, b.device->non_volatile());
    EXPECT_EQ(after.type("PR DN"), "!") << "the saved values are gone too";
}

TEST(TwinMemory, LockRefusesListingAndEditing) {
    Bench b;
    b.program({"LB K1", "E"});
    b.type("LK=1");
    for (const char* line : {"L", "PG 1", "CP K1"})
        EXPECT_EQ(b.error_of(line), 44) << line;
    b.send("\x03");
    EXPECT_EQ(b.type("PR LK"), "0") << "unsaved: a reset lifts it";
    b.program({"LB K1", "E"});
    b.type("LK=1");
    b.type("S");
    b.send("\x03");
    EXPECT_EQ(b.type("PR LK"), "1");
    EXPECT_EQ(b.error_of("LK=0"), 44);
    b.type("CP");
    EXPECT_EQ(b.type("PR LK"), "0");
    EXPECT_EQ(b.error_of("L"), 0);
}

TEST(TwinMemory, MotionRefusesSavingAndClearing) {
    Bench b;
    b.type("MR 7680000");
    EXPECT_EQ(b.error_of("S"), 73);
    EXPECT_EQ(b.error_of("FD"), 73);
    EXPECT_EQ(b.error_of("PG 1"), 73);
    EXPECT_EQ(b.error_of("IP"), 74);
    EXPECT_EQ(b.error_of("CP"), 74);
    b.send("\x1B");
    b.type("SL 1000");
    EXPECT_EQ(b.error_of("S"), 0) << "a slew lets it through [E-20]";
}

TEST(TwinMemory, ListingGivesAddressAndText) {
    Bench b;
    b.program({"LB K1", "MR 51200 'one turn", "", "' a comment", "E"});
    EXPECT_EQ(b.type("L"), "1 LB K1\r\n7 MR 51200 'one turn\r\n26 E") << "lines without a statement take no room";
    EXPECT_EQ(b.type("L K1"), b.type("L"));
    EXPECT_EQ(b.error_of("L ZZ"), 30);
}

TEST(TwinMemory, EditingReplacesWhatLiesThere) {
    Bench b;
    b.program({"LB K1", "R1=1", "E"});
    b.type("PG 7");
    b.type("R1=2");
    b.type("PG");
    EXPECT_EQ(b.type("L"), "1 LB K1\r\n7 R1=2\r\n12 E");
    b.type("PG 1");
    b.type("LB K2");
    b.type("PG");
    EXPECT_EQ(b.error_of("EX K1"), 30);
    b.type("PG 100");
    b.type("LB K2");
    EXPECT_EQ(b.prompt, '?') << "there is one at address 1";
    b.type("PG");
    EXPECT_EQ(b.type("PR ER"), "28");
}

TEST(TwinMemory, FaultyLinesAreNotStored) {
    Bench b;
    b.type("PG 1");
    b.type("LB K1");
    b.type("LB K1");
    EXPECT_EQ(b.prompt, '?');
    b.type("FOO 1 2");
    b.type("LB MR");
    b.type("E");
    b.type("PG");
    EXPECT_EQ(b.type("PR ER"), "29");
    EXPECT_EQ(b.type("L"), "1 LB K1\r\n7 E");
}

TEST(TwinMemory, ProgramSpaceIsBounded) {
    Bench b;
    b.type("PG 16380");
    b.type("LB K1");
    EXPECT_EQ(b.prompt, '?');
    b.type("PG");
    EXPECT_EQ(b.type("PR ER"), "45");
}

TEST(TwinMemory, ClearKeepsVariablesUnlessTold) {
    Bench b;
    b.type("VA Q1=5");
    b.program({"LB K1", "R1=1", "E", "LB K2", "E"});
    b.type("CP 0,K1");
    EXPECT_EQ(b.type("L"), "14 LB K2\r\n20 E");
    b.type("CP");
    EXPECT_EQ(b.type("L"), "");
    EXPECT_EQ(b.type("PR Q1"), "5");
    b.type("CP 1");
    EXPECT_EQ(b.type("PR UV"), "");
}

TEST(TwinMemory, StartUpLabelRunsAtPowerUpAndReset) {
    Bench b;
    b.program({"LB SU", "R1=42", "E"});
    EXPECT_EQ(b.type("PR R1"), "0");
    b.type("S");
    b.send("\x03", milliseconds(20));
    EXPECT_EQ(b.type("PR R1"), "42");
    Bench after = again(b);
    after.pass(milliseconds(20));
    EXPECT_EQ(after.type("PR R1"), "42");
}

TEST(TwinMemory, LocalVariablesAreMadeAnewByEachRun) {
    Bench b;
    b.program({"VA K5", "LB G1", "IC K5", "PR K5", "E"});
    EXPECT_NE(b.send("EX 1\r", milliseconds(20)).find(">1\r"), std::string::npos);
    EXPECT_NE(b.send("EX 1\r", milliseconds(20)).find(">1\r"), std::string::npos);
    EXPECT_EQ(b.type("PR UV"), "K5 = L 1");
}

TEST(TwinMemory, PowerByHand) {
    Bench b;
    Out out;
    b.type("A=5000");
    EXPECT_EQ(b.device->set_hand("power", Value{false}, b.now, out), "");
    EXPECT_EQ(b.send("PR A\r"), "");
    EXPECT_EQ(b.device->deadline(), never);
    EXPECT_EQ(b.device->set_hand("power", Value{true}, b.now, out), "");
    EXPECT_EQ(b.type("PR A"), "1000000");
    EXPECT_EQ(b.device->set_hand("silent", Value{true}, b.now, out), "");
    EXPECT_EQ(b.send("A=7000\r"), "");
    EXPECT_EQ(b.device->set_hand("silent", Value{false}, b.now, out), "");
    EXPECT_EQ(b.type("PR A"), "7000");
    EXPECT_EQ(b.device->set_hand("inject_error", Value{std::int64_t{86}}, b.now, out), "");
    EXPECT_EQ(b.type("PR ER"), "86");
    EXPECT_NE(b.device->set_hand("inject_error", Value{std::int64_t{500}}, b.now, out), "");
    EXPECT_NE(b.device->set_hand("nonsense", Value{true}, b.now, out), "");
}

TEST(TwinMemory, RevisionTellsOfEverySave) {
    Bench b;
    const auto before = b.device->non_volatile_revision();
    b.type("A=5000");
    EXPECT_EQ(b.device->non_volatile_revision(), before);
    b.type("S");
    EXPECT_EQ(b.device->non_volatile_revision(), before + 1);
    b.type("FD");
    EXPECT_EQ(b.device->non_volatile_revision(), before + 2);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
