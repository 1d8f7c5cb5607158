// The freedoms of the link, the memory and the firmware: each one changes the drive as the page says, and nothing else.
#include <fstream>
#include <sstream>

#include "adapters/mcode/tests/twin_freedoms_bench.hpp"
#include "gateway/core/specimen.hpp"

namespace axisgate::mcode::twin::test {
namespace {

const Catalogue& page() {
    static const Catalogue c = [] {
        std::ifstream in(AXISGATE_SOURCE_DIR "/schema/families/mcode.json");
        std::stringstream s;
        s << in.rdbuf();
        std::vector<std::string> faults;
        auto read = Catalogue::parse(s.str(), faults);
        for (const auto& f : faults)
            ADD_FAILURE() << f;
        return *read;
    }();
    return c;
}

TEST(TwinFreedoms, ThePageHasThemAndItsDefaultsAreTheDriveOfTheManual) {
    EXPECT_GE(page().freedoms().size(), 40U);
    const Manners none, zero = manners_of(specimen_values(page(), "0"));
    const MotorManners motor = motor_manners_of(specimen_values(page(), "0"), 0);
    EXPECT_EQ(zero.execution, none.execution);
    EXPECT_EQ(zero.version, none.version);
    EXPECT_TRUE(zero.lists);
    EXPECT_TRUE(motor.shaft.none());
    EXPECT_EQ(motor.encoder_lines, 1000);
    FreeDrive plain({}), read(specimen_values(page(), "0"));
    for (const char* line : {"PR P\r", "PR AL\r", "PR VR\r", "MR 5000\r", "XX\r", "PR ER\r", "S\r"})
        EXPECT_EQ(plain.bytes(line), read.bytes(line)) << line;
}

TEST(TwinFreedoms, EveryNamedSpecimenDiffers) {
    for (const auto name : named_specimens)
        EXPECT_FALSE(specimen_in_words(page(), specimen_values(page(), name)).empty()) << name;
}

TEST(TwinFreedoms, DeliveredEchoAndChecksumModesEndWithFd) {
    FreeDrive d({{"delivered_em", 1}, {"delivered_ck", 1}});
    EXPECT_EQ(d.bytes("PR P\r"), "<NAK>") << "no checksum came";
    EXPECT_EQ(d.bytes("PR P\xEE\r"), "<ACK>0<D0><CR><LF>");
    (void)d.bytes(std::string("FD") + static_cast<char>(((0x100 - 'F' - 'D') & 0x7F) | 0x80) + "\r");
    EXPECT_EQ(d.bytes("PR P\r"), "PR P<CR><LF>0<CR><LF>>");
}

TEST(TwinFreedoms, TheEchoMayComeInOnePiece) {
    FreeDrive d({{"echo_whole", 1}});
    EXPECT_EQ(d.bytes("PR P"), "");
    EXPECT_EQ(d.bytes("\r"), "PR P<CR><LF>0<CR><LF>>");
    EXPECT_EQ(FreeDrive({}).bytes("PR P"), "PR P");
}

TEST(TwinFreedoms, TheEchoOfAPartyLineMayHaveTheName) {
    for (const int named : {0, 1}) {
        FreeDrive d({{"echo_name", named}}, 'a');
        (void)d.bytes("\n");
        EXPECT_EQ(d.bytes("aPR P\n"), std::string(named ? "a" : "") + "PR P<CR><LF>0<CR><LF>>");
        (void)d.bytes("aEM=3\n");
        EXPECT_EQ(d.bytes("aPR P\n"), std::string(named ? "a" : "") + "PR P<CR><LF>0<CR><LF>");
    }
}

TEST(TwinFreedoms, ThePromptComesLate) {
    FreeDrive d({{"prompt_late_ms", 30}});
    const Instant from = d.now;
    EXPECT_EQ(d.bytes("PR P\r"), "PR P<CR><LF>0<CR><LF>>");
    EXPECT_EQ(d.ms_of("0<CR><LF>", from), 1);
    EXPECT_EQ(d.ms_of_prompt(from), 31);
    const Instant second = d.now;
    (void)d.bytes("PR P\r", milliseconds(5));
    EXPECT_EQ(d.bytes("ER=0\r"), ">ER=0<CR><LF>>") << "bytes that come meanwhile are answered behind it";
    EXPECT_EQ(d.ms_of_prompt(second), 31);
}

TEST(TwinFreedoms, AnswersOnAPartyLineHaveAGap) {
    FreeDrive d({{"party_gap_ms", 20}}, 'a');
    (void)d.bytes("\n");
    (void)d.bytes("aEM=1\n");
    const Instant from = d.now;
    EXPECT_EQ(d.bytes("aPR P\n"), "<CR><LF>0<CR><LF>");
    ASSERT_EQ(d.sent.size(), 2U);
    EXPECT_EQ(d.sent[1].first - d.sent[0].first, milliseconds(20));
    EXPECT_EQ(d.ms_of("0", from), 21);
}

TEST(TwinFreedoms, AListingComesLineByLine) {
    FreeDrive d({{"listing_pause_ms", 40}});
    d.lines({"PG 1", "MR 1", "H", "E", "PG"});
    EXPECT_EQ(d.bytes("L\r"), "L<CR><LF>1 MR 1<CR><LF>6 H<CR><LF>8 E<CR><LF>>");
    ASSERT_GE(d.sent.size(), 3U);
    EXPECT_EQ(d.ms_of("8 E", d.sent.front().first), 81);
    EXPECT_EQ(d.ms_of("6 H", d.sent.front().first), 41);
}

TEST(TwinFreedoms, TheAcknowledgementStandsInFrontBehindOrNowhere) {
    const std::array expected{"<CR><LF>0<CR><LF>", "0<CR><LF><CR><LF>", "0<CR><LF>"};
    for (int order = 0; order < 3; ++order) {
        FreeDrive d({{"answer_order", order}});
        (void)d.bytes("EM=1\r");
        EXPECT_EQ(d.bytes("PR P\r"), expected[static_cast<std::size_t>(order)]);
        EXPECT_EQ(d.bytes("ER=0\r"), "<CR><LF>") << "a line that prints nothing has one in any case";
    }
}

TEST(TwinFreedoms, NumbersMayHaveBlanks) {
    const std::array whole{"7", "7", " 7"}, real{"1.500000", "  1.500000", "  1.500000"};
    for (int form = 0; form < 3; ++form) {
        FreeDrive d({{"number_form", form}});
        (void)d.bytes("R1=7\r");
        (void)d.bytes("F1=1.5\r");
        EXPECT_EQ(d.ask("PR R1"), whole[static_cast<std::size_t>(form)]);
        EXPECT_EQ(d.ask("PR F1"), real[static_cast<std::size_t>(form)]);
        (void)d.bytes("R1=-7\r");
        EXPECT_EQ(d.ask("PR R1"), "-7");
    }
}

TEST(TwinFreedoms, ExecutionTakesTime) {
    FreeDrive d({{"execution_ms", 30}});
    const Instant from = d.now;
    (void)d.bytes("PR P\rPR P\r");
    EXPECT_EQ(d.ms_of("0<CR>", from), 30);
    EXPECT_EQ(d.sent.back().first - from, milliseconds(60)) << "one line after the other";
}

TEST(TwinFreedoms, DeafBehindAnAnswer) {
    FreeDrive d({{"turnaround_ms", 10}});
    (void)d.bytes("ER=0\r", milliseconds(5));
    EXPECT_EQ(d.bytes("PR P\r"), "") << "lost";
    EXPECT_EQ(d.bytes("PR P\r"), "PR P<CR><LF>0<CR><LF>>");
}

TEST(TwinFreedoms, ALineOfAProgramIsStoredBeforeTheNextIsHeard) {
    FreeDrive d({{"store_ms", 20}});
    (void)d.bytes("PG 1\r");
    const Instant from = d.now;
    (void)d.bytes("MR 1\rMR 2\r");
    EXPECT_EQ(d.ms_of(">", from), 21);
    (void)d.bytes("MR 3\r");
    (void)d.bytes("PG\r");
    EXPECT_EQ(d.ask("L", milliseconds(50)), "1 MR 1\r\n6 MR 3");
}

TEST(TwinFreedoms, TheMemoryTakesTimeAndMayLoseCharacters) {
    for (const int deaf : {0, 1}) {
        FreeDrive d({{"memory_ms", 200}, {"memory_deaf", deaf}});
        for (const char* line : {"S\r", "IP\r", "FD\r"}) {
            const Instant from = d.now;
            (void)d.bytes(line, milliseconds(50));
            const std::string answer = d.bytes("PR P\r");
            EXPECT_EQ(d.ms_of(">", from), 201) << line;
            EXPECT_EQ(answer.find("<CR><LF>0<CR><LF>") == std::string::npos, deaf == 1) << line << answer;
            EXPECT_GE(d.sent.back().first - from, milliseconds(201));
        }
    }
}

TEST(TwinFreedoms, EscapeTakesTime) {
    FreeDrive d({{"escape_ms", 20}});
    (void)d.bytes("SL 51200\r", milliseconds(200));
    (void)d.bytes("\x1b", Duration::zero());
    const double from = d.place();
    d.pass(milliseconds(19));
    EXPECT_GT(d.place(), from + 900);
    d.pass(milliseconds(1));
    const double end = d.place();
    d.pass(milliseconds(100));
    EXPECT_EQ(d.place(), end);
}

TEST(TwinFreedoms, AnErrorOfTheMotorIsKnownLate) {
    FreeDrive d({{"error_late_ms", 100}});
    d.lines({"SL 51200"});
    d.hand("supply_voltage", 5.0);
    EXPECT_EQ(d.number("EF"), 0);
    d.pass(milliseconds(100));
    EXPECT_EQ(d.number("EF"), 1);
    EXPECT_EQ(d.number("ER"), 79);
    EXPECT_EQ(d.error_of("XX"), 60) << "errors of typed lines are not late";
}

TEST(TwinFreedoms, TheMovingFlagIsLateBothWays) {
    FreeDrive d({{"moving_late_ms", 50}});
    d.lines({"MT=0", "HT=0", "MR 5120"});
    EXPECT_EQ(d.number("MV"), 0);
    d.pass(milliseconds(50));
    EXPECT_EQ(d.number("MV"), 1);
    EXPECT_EQ(d.number("MP"), 1);
    d.pass(milliseconds(93));  // the move takes 142 ms
    EXPECT_EQ(d.number("P"), 5120);
    EXPECT_EQ(d.number("MV"), 1);
    d.pass(milliseconds(60));
    EXPECT_EQ(d.number("MV"), 0);
    EXPECT_EQ(d.number("MP"), 0);
}

TEST(TwinFreedoms, TheMovingFlagMayEndWithTheSteps) {
    for (const int early : {0, 1}) {
        FreeDrive d({{"moving_ends_with_steps", early}});
        d.lines({"MR 5120"});
        EXPECT_EQ(d.number("MV"), 1);
        d.pass(milliseconds(300));
        EXPECT_EQ(d.number("MV"), early ? 0 : 1);
        EXPECT_EQ(d.number("MP"), 1);
        d.pass(milliseconds(1000));
        EXPECT_EQ(d.number("MV"), 0);
    }
}

TEST(TwinFreedoms, AnOldFirmwareDoesNotKnowSomeWords) {
    FreeDrive d({{"firmware", 5007}});
    EXPECT_EQ(d.ask("PR VR"), "LMDCM 5.007, Hw: 3.2");
    for (const auto& [line, code] : std::map<std::string, int>{
             {"AT=2", 20}, {"PR AT", 35}, {"HI 1", 60}, {"F1=2", 20}, {"PR SI R1", 35}, {"LS=0,1,1", 20}, {"A=5000", 0}, {"R1=R2+1", 0}})
        EXPECT_EQ(d.error_of(line), code) << line;
    const std::string list = d.ask("PR AL");
    EXPECT_EQ(list.find("PF = "), std::string::npos);
    EXPECT_NE(list.find("VM = "), std::string::npos);
    d.lines({"PG 1"});
    EXPECT_EQ(d.ask("BL=5", milliseconds(5)), "");
    d.lines({"PG"});
    EXPECT_EQ(d.number("ER"), 20);
    EXPECT_EQ(d.ask("L"), "");
    EXPECT_EQ(FreeDrive({{"firmware", 5013}}).ask("PR VR"), "LMDCM 5.013, Hw: 3.2");
    EXPECT_EQ(FreeDrive({}).error_of("AT=2"), 0);
}

TEST(TwinFreedoms, TheVersionMayStandAlone) {
    EXPECT_EQ(FreeDrive({{"version_alone", 1}}).ask("PR VR"), "6.002");
    EXPECT_EQ(FreeDrive({{"version_alone", 1}, {"firmware", 5007}}).ask("PR VR"), "5.007");
}

TEST(TwinFreedoms, ListsMayBeMissing) {
    FreeDrive d({{"lists_missing", 1}});
    EXPECT_EQ(d.error_of("PR AL"), 35);
    EXPECT_EQ(d.error_of("PR UV"), 35);
    EXPECT_EQ(d.error_of("PR VR"), 0);
    EXPECT_EQ(FreeDrive({}).error_of("PR AL"), 0);
}

TEST(TwinFreedoms, ANoticeAtPowerUpAndAfterAReset) {
    FreeDrive d({{"sign_on", 1}});
    const std::string notice = "<CR><LF>Copyright 2016 by Schneider Electric Motion<CR><LF>All Rights Reserved<CR><LF>>";
    EXPECT_EQ(d.text(), notice);
    EXPECT_EQ(d.bytes("\x03"), notice);
    EXPECT_EQ(FreeDrive({{"sign_on", 1}}, 'a').text(), "") << "not in party mode";
    EXPECT_EQ(FreeDrive({{"sign_on", 1}}, '!', {{"ethernet", "on"}}).text(), "");
    EXPECT_EQ(FreeDrive({}).text(), "");
}

TEST(TwinFreedoms, AProgramThatSomebodyHasLeftPrintsByItself) {
    FreeDrive d({{"chatter_ms", 200}});
    d.sent.clear();
    d.pass(milliseconds(1000));
    EXPECT_EQ(d.text(), "Pos 0<CR><LF>Pos 0<CR><LF>Pos 0<CR><LF>Pos 0<CR><LF>Pos 0<CR><LF>");
    EXPECT_EQ(d.number("BY"), 1);
    EXPECT_EQ(d.ask("L").substr(0, 7), "1 LB SU");
    EXPECT_EQ(d.error_of("PG 1"), 41);
    (void)d.bytes("\x1b");
    d.lines({"FD"});
    (void)d.bytes("\x03");
    EXPECT_EQ(d.number("BY"), 0) << "FD has cleared it";
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
