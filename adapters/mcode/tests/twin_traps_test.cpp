// The traps of the family, T01 to T25: what a host sees from outside where a simpler model would answer otherwise.
// In: bytes, switches of the tester's hand, time. Out: bytes.
// Never looks inside the drive. One test per trap; details are in the tests of link, language, memory and motor.
#include "adapters/mcode/tests/twin_wire.hpp"

namespace axisgate::mcode::twin::test {
namespace {

std::string sum(const std::string& text) {
    unsigned total = 0;
    for (const char c : text)
        total += static_cast<std::uint8_t>(c);
    return text + static_cast<char>(((128U - total % 128U) % 128U) | 0x80U);
}

TEST(McodeTrap, T01_PartyModeIsSilentUntilTheFirstLineFeed) {
    Wire w;
    w.bytes("PY=1\r");
    EXPECT_EQ(w.bytes("PR P\r!PR P\r"), "");
    EXPECT_EQ(w.bytes("!PR P"), "");
    EXPECT_EQ(w.bytes("\n"), "") << "the first one only wakes";
    EXPECT_EQ(w.bytes("!PR P\n"), "PR P<CR><LF>0<CR><LF>>");
}

TEST(McodeTrap, T02_GlobalCommandsMoveWithoutAByte) {
    Wire w(lmdc, 'a');
    w.bytes("\n");
    EXPECT_EQ(w.bytes("*MR 10000\n", std::chrono::seconds(3)), "");
    EXPECT_EQ(w.bytes("aPR P\n"), "PR P<CR><LF>10000<CR><LF>>");
    w.bytes("aDG=0\n");
    EXPECT_EQ(w.bytes("*MR 10000\n"), "MR 10000<CR><LF>>");
}

TEST(McodeTrap, T03_TheChecksumIncludesTheName) {
    Wire w;
    w.bytes("PY=1\r");
    w.bytes("\n!EM=1\n");
    w.bytes("!CK=1\n");
    EXPECT_EQ(w.bytes("!MR 512000\xF8\n", std::chrono::seconds(4)), "<ACK>");
    EXPECT_EQ(w.bytes("!MR 512001\xF8\n", std::chrono::seconds(4)), "<NAK>");
    EXPECT_EQ(w.bytes(sum("!PR P") + "\n"), "<ACK>512000" + shown(sum("512000").substr(6)) + "<CR><LF>");
    EXPECT_EQ(w.bytes("!mr 1" + sum("!MR 1").substr(5) + "\n"), "<NAK>") << "small letters have another sum";
    EXPECT_EQ(w.bytes(sum("!mr 1") + "\n"), "<ACK>");
}

TEST(McodeTrap, T04_Ck2IsQuietWhileAProgramRuns) {
    Wire w;
    w.program({"LB G1", "H 60000", "E"});
    w.ask("EM=1");
    w.bytes("CK=2\r");
    EXPECT_EQ(w.bytes(sum("R1=1") + "\r"), "<ACK>");
    EXPECT_EQ(w.bytes(sum("EX G1") + "\r"), "<ACK>") << "no program runs when it comes";
    EXPECT_EQ(w.bytes(sum("R1=2") + "\r"), "");
    EXPECT_EQ(w.bytes(sum("R9Z=2") + "\r"), "<NAK>");
    EXPECT_EQ(w.bytes("R1=3\x80\r"), "<NAK>");
}

TEST(McodeTrap, T05_EchoModes) {
    Wire w;
    EXPECT_EQ(w.bytes("EM=2\r"), "EM=2<CR><LF>>");
    EXPECT_EQ(w.bytes("A=1000\r"), "");
    EXPECT_EQ(w.bytes("PR A\r"), "1000<CR><LF>");
    w.bytes("EM=3\r");
    EXPECT_EQ(w.bytes("A=2"), "");
    EXPECT_EQ(w.bytes("000\r"), "A=2000<CR><LF>");
}

TEST(McodeTrap, T06_TheErrorPromptStaysUntilErIsRead) {
    Wire w;
    EXPECT_EQ(w.bytes("QQQQ\r"), "QQQQ<CR><LF>?");
    EXPECT_EQ(w.bytes("A=1000\r"), "A=1000<CR><LF>?");
    EXPECT_EQ(w.bytes("PR EF\r"), "PR EF<CR><LF>1<CR><LF>?");
    EXPECT_EQ(w.bytes("PR ER\r"), "PR ER<CR><LF>60<CR><LF>>");
    EXPECT_EQ(w.bytes("PR ER\r"), "PR ER<CR><LF>0<CR><LF>>");
    EXPECT_EQ(w.ask("PR EF"), "0");
}

TEST(McodeTrap, T07_TheStallFlagOutlivesTheError) {
    Wire w;
    w.lines({"EE=1", "MR 40000"});
    w.pass(milliseconds(300));
    w.hand("stall", Value{true});
    w.pass(std::chrono::seconds(1));
    w.hand("stall", Value{false});
    EXPECT_EQ(w.number("ER"), 86);
    EXPECT_EQ(w.number("ER"), 0);
    EXPECT_EQ(w.number("ST"), 1);
    const std::int64_t here = w.number("P");
    EXPECT_EQ(w.error_of("MR 100"), 0);
    w.pass(std::chrono::seconds(3));
    EXPECT_EQ(w.number("P"), here + 100);
    EXPECT_EQ(w.number("ST"), 1);
    w.ask("ST=0");
    EXPECT_EQ(w.number("ST"), 0);
}

TEST(McodeTrap, T08_ThreeStops) {
    Wire w;
    w.ask("SL 500000", std::chrono::seconds(1));
    w.bytes("\x1B", Duration::zero());
    EXPECT_EQ(w.number("V"), 0) << "ESC has no ramp";
    w.ask("SL 500000", std::chrono::seconds(1));
    w.ask("SL 0", milliseconds(100));
    EXPECT_NEAR(static_cast<double>(w.number("V")), 401000, 3000) << "D = 1000000";
    w.pass(std::chrono::seconds(2));
    EXPECT_EQ(w.number("ER"), 0);
    w.program({"LB G1", "SL 500000", "H 60000", "E"});
    w.ask("IS=4,5,0");
    w.ask("EX G1", std::chrono::seconds(1));
    w.hand("inputs", Value{std::int64_t{7}});
    w.pass(milliseconds(100));
    EXPECT_NEAR(static_cast<double>(w.number("V")), 400000, 3000) << "the input stops with the ramp";
    EXPECT_EQ(w.number("BY"), 0);
    const std::int64_t code = w.number("ER");
    EXPECT_TRUE(code == 91 || code == 48) << code;
    w.hand("inputs", Value{std::int64_t{15}});
    w.pass(std::chrono::seconds(3));
    w.ask("SL 500000", std::chrono::seconds(1));
    w.hand("inputs", Value{std::int64_t{7}});
    w.pass(milliseconds(10));
    EXPECT_EQ(w.number("ER"), 91) << "motion without a program";
}

TEST(McodeTrap, T09_MvAndMpLastForMtAndHt) {
    Wire w;
    w.program({"LB G1", "MR 51200", "H", "R1=1", "E"});
    w.ask("EX G1");
    for (int i = 0; i < 5000 && w.number("V") != 0; ++i)
        w.pass(milliseconds(1));
    w.pass(milliseconds(900));
    EXPECT_EQ(w.number("MV"), 1);
    EXPECT_EQ(w.number("MP"), 1);
    EXPECT_EQ(w.number("R1"), 0) << "H waits as long";
    w.pass(milliseconds(110));
    EXPECT_EQ(w.number("MV"), 0);
    EXPECT_EQ(w.number("MP"), 0);
    EXPECT_EQ(w.number("R1"), 1);
}

TEST(McodeTrap, T10_VmCountsFromTheNextMoveSlAtOnce) {
    Wire w;
    w.ask("VM=100000");
    w.ask("MR 500000", std::chrono::seconds(1));
    w.ask("VM=200000", milliseconds(500));
    EXPECT_EQ(w.number("V"), 100000);
    w.pass(std::chrono::seconds(8));
    w.ask("MR 500000", std::chrono::seconds(1));
    EXPECT_EQ(w.number("V"), 200000);
    w.pass(std::chrono::seconds(8));
    w.ask("SL 100000", std::chrono::seconds(1));
    w.ask("SL 300000", milliseconds(100));
    const std::int64_t v = w.number("V");
    EXPECT_GT(v, 150000);
    EXPECT_LT(v, 250000);
    w.pass(std::chrono::seconds(1));
    EXPECT_EQ(w.number("V"), 300000);
}

TEST(McodeTrap, T11_MicrostepsRescaleAndTheEncoderLocksThem) {
    Wire w;
    w.ask("MS=2");
    EXPECT_EQ(w.number("VI"), 8);
    EXPECT_EQ(w.number("VM"), 6000);
    EXPECT_EQ(w.number("A"), 7813);
    EXPECT_EQ(w.number("D"), 7813);
    Wire e;
    e.ask("EE=1");
    EXPECT_EQ(e.number("VI"), 78);
    EXPECT_EQ(e.number("VM"), 60000);
    EXPECT_EQ(e.number("A"), 78125);
    EXPECT_NE(e.error_of("MS=2"), 0);
    EXPECT_EQ(e.number("MS"), 256);
}

TEST(McodeTrap, T12_TripsClearTheirOwnBitAndKnowEachOther) {
    Wire w;
    EXPECT_EQ(w.error_of("TE=2"), 27);
    w.program({"LB K1", "R1=R1+1", "RT", "LB G1", "H 60000", "E"});
    w.lines({"TP=10000,K1", "TR=1000,K1", "TT=60000,K1"});
    EXPECT_EQ(w.error_of("TE=18"), 39);
    w.ask("TE=10");
    w.ask("EX G1");
    w.ask("MA 20000", std::chrono::seconds(3));
    EXPECT_EQ(w.number("R1"), 1);
    EXPECT_EQ(w.number("TE"), 8) << "the other trip stays armed";
    EXPECT_EQ(w.number("PC"), 0) << "TP does not capture";
}

TEST(McodeTrap, T13_FieldsOfMa) {
    Wire w;
    w.ask("MA 51200,1");
    EXPECT_EQ(w.bytes("", std::chrono::seconds(4)), "!") << "the name, in single mode as well";
    w.ask("MA 100000,0,1");
    w.pass(std::chrono::seconds(10));
    EXPECT_EQ(w.number("MV"), 1) << "never stops";
    EXPECT_GT(w.number("P"), 1000000);
}

TEST(McodeTrap, T14_Numbers) {
    Wire w;
    w.lines({"F1=51200*PI", "R1=51200", "F2=LO R1", "F3=30/25", "F4=0"});
    EXPECT_EQ(w.ask("PR F1"), "160849.543885");
    EXPECT_EQ(w.ask("PR F2"), "10.843495");
    EXPECT_EQ(w.ask("PR F3"), "1.200000");
    w.ask("PF=8,4,1,1");
    EXPECT_EQ(w.ask("PR F4"), "0.0000E+00") << "the width is a minimum";
}

TEST(McodeTrap, T15_SixtyFourCharacters) {
    Wire w;
    const std::string line = "A=5000 '" + std::string(56, 'x');
    EXPECT_EQ(w.error_of(line), 0);
    EXPECT_EQ(w.number("A"), 5000);
    EXPECT_EQ(w.bytes(line + "x"), line + "x<CR><LF>?");
    EXPECT_EQ(w.bytes("\r"), "");
    EXPECT_EQ(w.number("ER"), 20);
}

TEST(McodeTrap, T16_Names) {
    Wire w;
    w.program({"LB K1", "E"});
    EXPECT_EQ(w.error_of("EX k1"), 0);
    EXPECT_EQ(w.error_of("VA FT"), 24);
    EXPECT_EQ(w.error_of("VA PW"), 0);
    EXPECT_EQ(Wire(lmm).error_of("VA PW"), 24);
    // K1 and PW are two of the 192.
    int made = 2;
    for (char c = 'A'; c <= 'Z' && made < 192; ++c) {
        for (int d = 0; d <= 9 && made < 192; ++d) {
            const std::string name = std::string(1, c) + std::to_string(d);
            if (word_named(name) || name == "K1") continue;
            EXPECT_EQ(w.error_of("VA " + name), 0) << name;
            ++made;
        }
    }
    ASSERT_EQ(made, 192);
    EXPECT_EQ(w.error_of("VA Bb"), 31);
}

TEST(McodeTrap, T17_FactoryDefaultsAndTheSavedLock) {
    Wire w(lmm);
    const std::string pn = w.ask("PR PN"), sn = w.ask("PR SN");
    w.program({"LB K1", "E"});
    w.lines({"PW=1,2,3,4", "FS=123", "DN=\"c\"", "LK=1", "S"});
    EXPECT_EQ(w.error_of("LK=0"), 44);
    EXPECT_EQ(w.error_of("CP 0,K1"), 44) << "only the full CP";
    w.ask("FD");
    EXPECT_EQ(w.ask("PR DN"), "!");
    EXPECT_EQ(w.number("LK"), 0);
    EXPECT_EQ(w.ask("L"), "");
    EXPECT_EQ(w.ask("PR PN"), pn);
    EXPECT_EQ(w.ask("PR SN"), sn);
    EXPECT_EQ(w.ask("PR PW"), "1,2,3,4");
    EXPECT_EQ(w.number("FS"), 123);
}

TEST(McodeTrap, T18_TheNewBitRateWaitsForSaveAndReset) {
    Wire w;
    w.ask("BD=19");
    EXPECT_EQ(w.ask("PR BD"), "19") << "still heard at the old rate";
    w.ask("S");
    EXPECT_EQ(w.ask("PR BD"), "19");
    w.bytes("\x03");
    EXPECT_EQ(w.bytes("PR BD\r"), "") << "now at 19200, and this line is at 9600";
}

TEST(McodeTrap, T19_Backlash) {
    Wire w;
    w.lines({"BE=1", "BL=1000", "MA 100000"});
    w.pass(std::chrono::seconds(5));
    w.ask("MR -50000", std::chrono::seconds(5));
    EXPECT_EQ(w.number("P"), 49000) << "51000 steps: BL comes on top";
    w.ask("MR -50000", std::chrono::seconds(5));
    EXPECT_EQ(w.number("P"), -1000) << "once per reversal";
    w.lines({"BM=1", "BL=15000", "VM=50000"});
    w.ask("MR -100000");
    std::int64_t least = 0;
    for (int i = 0; i < 600; ++i) {
        w.pass(milliseconds(10));
        least = std::min(least, w.number("P"));
    }
    EXPECT_NEAR(static_cast<double>(least), -116000, 300);
    w.pass(std::chrono::seconds(2));
    EXPECT_EQ(w.number("P"), -101000) << "a second move in the direction of BL";
}

TEST(McodeTrap, T20_ErrorHandler) {
    Wire w;
    w.program({"LB K9", "R1=R1+1", "E"});
    w.ask("OE K9");
    w.ask("QQQQ 1", milliseconds(20));
    EXPECT_EQ(w.number("R1"), 1) << "a typed error starts it";
    EXPECT_EQ(w.number("BY"), 0) << "its E ends the program";
    w.ask("ER=0");
    w.ask("PG 100");
    w.ask("QQQQ 1", milliseconds(20));
    w.ask("PG");
    EXPECT_EQ(w.number("R1"), 1) << "not while programming";
}

TEST(McodeTrap, T21_LimitsAndHoming) {
    const auto home = [](int mode, bool two) {
        Wire w;
        w.lines({"LM=" + std::to_string(mode), "IS=1,1,0", "IS=2,2,0", "IS=3,3,0", "VM=50000"});
        w.hand("limit_negative_position", Value{-1.0});
        if (two) {
            w.hand("limit_positive_position", Value{2.0});
        } else {
            w.hand("home_position", Value{1.0});
        }
        w.ask("HM 1", std::chrono::seconds(60));
        return w.number("ER");
    };
    for (const int mode : {1, 4}) {
        EXPECT_EQ(home(mode, false), 0) << mode;
        EXPECT_EQ(home(mode, true), 82) << mode;
    }
    for (const int mode : {2, 3, 5, 6})
        EXPECT_EQ(home(mode, false), 84) << mode;
    for (int mode = 1; mode <= 6; ++mode) {
        Wire w;
        w.lines({"LM=" + std::to_string(mode), "IS=2,2,0"});
        w.ask("SL 500000", std::chrono::seconds(1));
        w.hand("inputs", Value{std::int64_t{13}});
        w.pass(milliseconds(100));
        if (mode <= 3) {
            EXPECT_GT(w.number("V"), 300000) << mode;
        } else {
            EXPECT_EQ(w.number("V"), 0) << mode;
        }
        w.pass(std::chrono::seconds(3));
        EXPECT_EQ(w.number("ER"), 83) << mode;
        EXPECT_EQ(w.error_of("MR 1000"), 83) << mode << ": held";
        EXPECT_EQ(w.error_of("MR -1000"), 0) << mode << ": away is free";
    }
}

TEST(McodeTrap, T22_ClockInputsAreAPair) {
    Wire w;
    w.ask("IS=3,13,0");
    EXPECT_NE(w.ask("PR IS").find("IS = 4, 13, 0"), std::string::npos);
    w.ask("IS=4,15,0");
    EXPECT_NE(w.ask("PR IS").find("IS = 3, 15, 0"), std::string::npos);
}

TEST(McodeTrap, T23_InIgnoresLevelAndFilter) {
    Wire w;
    w.lines({"IS=1,0,0", "IS=2,0,1", "D1=50"});
    w.hand("inputs", Value{std::int64_t{14}});
    EXPECT_EQ(w.number("IN"), 14);
    EXPECT_EQ(w.number("I1"), 0) << "the filter";
    w.pass(milliseconds(60));
    EXPECT_EQ(w.number("I1"), 1) << "low is active";
    EXPECT_EQ(w.number("I2"), 1) << "high is active";
    EXPECT_EQ(w.number("IN"), 14);
}

TEST(McodeTrap, T24_TorqueModeMovesAtOnce) {
    Wire w;
    w.lines({"TS=51200", "AS=3"});
    w.pass(std::chrono::seconds(1));
    EXPECT_EQ(w.number("V"), 0);
    EXPECT_EQ(w.number("AV"), 51200);
    EXPECT_EQ(w.number("MV"), 1);
    EXPECT_EQ(w.error_of("AS=0"), 87);
}

TEST(McodeTrap, T25_CountersWrap) {
    Wire w;
    w.lines({"C1=2147483647", "C2=2147483647"});
    w.ask("MR 51200", std::chrono::seconds(4));
    EXPECT_EQ(w.number("ER"), 0);
    EXPECT_EQ(w.number("C1"), -2147483648LL + 51199);
    EXPECT_EQ(w.number("C2"), -2147483648LL + 3999);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
