// Every control word with every telegram form, the manual's examples byte by byte, each error code at its cause, addressing.
// In: instructions on a CAN bus. Out: checked answers.
// Never looks inside the twin.
#include <set>

#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

struct Exchange {
    const char* sent;
    const char* answer;  ///< nullptr: silence
};

void run(Bench& b, std::initializer_list<Exchange> exchanges) {
    for (const Exchange& e : exchanges) {
        const Lines got = b.send(e.sent);
        EXPECT_EQ(got, e.answer == nullptr ? Lines{} : Lines{e.answer}) << e.sent;
    }
}

TEST(TwinInstructions, ExamplesOfTheManual) {
    Bench b;
    run(b, {{"81 08", "01 08 0A"},
            {"81 05 02", "01 05 02"},
            {"86 00 01 00", "06 00 01 00"},
            {"86 00", "06 00 01 00"},
            {"86 06 01 00", "06 06 01 00"},
            {"87 00", "07 00 01 00"},
            {"87 01 01 00", "07 01 01 00"},
            {"8B", "0B 20 0A 11 00 00 00 00 00"},
            {"8C", "0C 01 02 03 04 05 06 07 08"},
            {"81 05 05", "0F 00 33 81 05 00 00"},
            {"8F 00", "0F 00 33 81 05 00 00"},
            {"8F 00 00", "0F 00 00 00 00 00 00"},
            {"BD 04", "3D 04 80 0C"},
            {"BD 00 E8 03", "3D 00 E8 03"},
            {"90 01", "10 01 1C 00"},
            {"90 00 10 00", "10 00 10 00"},
            {"95 01", "15 01"},
            {"95", "15 01"},
            {"95 00", "15 00"},
            {"98 03", "18 03"},
            {"98 00", "18 00"},
            {"99 F4 01 00 00", "19 F4 01 00 00"},
            {"99", "19 F4 01 00 00"},
            {"9A E9 03 00 00", "1A E9 03 00 00"},
            {"9A", "1A E9 03 00 00"},
            {"9B E9 03 00 00", "1B E9 03 00 00"},
            {"9B", "1B E9 03 00 00"},
            {"9C 00 6A 18 00", "1C 00 6A 18 00"},
            {"9C", "1C 00 6A 18 00"},
            {"9D 18 FC FF FF", "2E 02 18 FC FF FF"},
            {"9D", "1D 00 00 00 00"},
            {"9F E8 03 00 00", "2E 03 E8 03 00 00"},
            {"A0 E8 03 00 00", "2E 04 E8 03 00 00"},
            {"9E E8 03 00 00", "2E 02 E8 03 00 00"},
            {"9E", "1E 00 00 00 00"},
            {"9F", "1F 00 00 00 00"},
            {"A0", "20 00 00 00 00"},
            {"A1", "21"},
            {"AD E9 03 00 00", "2D E9 03 00 00"},
            {"AD", "2D E9 03 00 00"},
            {"AE 02", "2E 02 E8 03 00 00"},
            {"B4 00 06 80", "34 00 06 80"},
            {"B4 00", "34 00 06 80"},
            {"B5 00 64 00", "35 00 64 00"},
            {"B5 01", "35 01 00 00"},
            {"97", "17"}});
}

TEST(TwinInstructions, FactoryValues) {
    Bench b;
    run(b, {{"81 05", "01 05 02"},
            {"81 07", "01 07 05"},
            {"81 08", "01 08 0A"},
            {"86 00", "06 00 00 00"},
            {"86 01", "06 01 01 00"},
            {"86 02", "06 02 00 00"},
            {"86 03", "06 03 00 00"},
            {"86 04", "06 04 00 00"},
            {"86 05", "06 05 00 00"},
            {"86 06", "06 06 01 00"},
            {"86 07", "06 07 00 00"},
            {"87 00", "07 00 01 00"},
            {"87 01", "07 01 01 00"},
            {"87 02", "07 02 01 00"},
            {"87 08", "07 08 01 00"},
            {"BD 00", "3D 00 E8 03"},
            {"BD 01", "3D 01 64 00"},
            {"BD 02", "3D 02 11 00"},
            {"BD 03", "3D 03 01 00"},
            {"BD 04", "3D 04 80 0C"},
            {"90 00", "10 00 10 00"},
            {"90 01", "10 01 1C 00"},
            {"90 02", "10 02 32 00"},
            {"90 03", "10 03 00 00"},
            {"99", "19 10 27 00 00"},
            {"9A", "1A 10 27 00 00"},
            {"9B", "1B 00 00 00 00"},
            {"9C", "1C 00 6A 18 00"},
            {"AD", "2D 00 00 00 00"},
            {"B4 00", "34 00 80 80"},
            {"B4 01", "34 01 80 80"},
            {"B4 02", "34 02 80 80"},
            {"B4 03", "34 03 00 00"},
            {"B5 00", "35 00 00 00"},
            {"B5 02", "35 02 00 00"},
            {"98", "18 00"},
            {"95", "15 00"},
            {"B7", "37 00 00 00 00"},
            {"AE 00", "2E 00 00 00 00 00"},
            {"AE 01", "2E 01 00 00 00 00"},
            {"AE 02", "2E 02 00 00 00 00"},
            {"AE 03", "2E 03 00 00 00 00"},
            {"AE 04", "2E 04 00 00 00 00"},
            {"91 00", "11 00 00 01 00 00 00 00 00"},
            {"91 01", "11 01 00 00 00 00 00 00 00"},
            {"8F 00", "0F 00 00 00 00 00 00"},
            {"8F 06", "0F 06 00 00 00 00 00"}});
}

/// The status example [L1561]: PTP, on, IN1..3 high, OP1 low, stationary, in position, PR = -1000.
TEST(TwinInstructions, StatusExampleOfTheManual) {
    Bench b;
    b.inputs(7);
    b.pass_ms(1);
    b.setup({"95 01", "9F 18 FC FF FF", "9E E8 03 00 00", "96"});
    b.pass_ms(5000);
    EXPECT_EQ(b.ask("91 00"), "11 00 3D 03 00 18 FC FF FF");
    EXPECT_EQ(b.ask("91 00 00"), "11 00 3D 01 00 18 FC FF FF");  // the three flags go, the position stays
}

TEST(TwinInstructions, GetOrSetIsTheLengthAlone) {
    Bench b;
    EXPECT_EQ(b.ask("99"), "19 10 27 00 00");
    EXPECT_EQ(b.ask("99 88 13 00 00"), "19 88 13 00 00");
    EXPECT_EQ(b.ask("99"), "19 88 13 00 00");
    EXPECT_EQ(b.ask("90 01"), "10 01 1C 00");
    EXPECT_EQ(b.ask("90 01 28 00"), "10 01 28 00");
    EXPECT_EQ(b.ask("90 01"), "10 01 28 00");
}

TEST(TwinInstructions, LengthsOfAnswersAreExact) {
    Bench b;
    struct Case {
        const char* sent;
        std::size_t bytes;
    };
    const Case cases[] = {{"81 07", 2},
                          {"86 00", 3},
                          {"87 00", 3},
                          {"8B", 8},
                          {"8C", 8},
                          {"8F 00", 6},
                          {"BD 00", 3},
                          {"90 00", 3},
                          {"95", 1},
                          {"95 01", 1},
                          {"9D 00 00 00 00", 5},
                          {"96", 4},
                          {"97", 0},
                          {"A1", 0},
                          {"98", 1},
                          {"99", 4},
                          {"9A", 4},
                          {"9B", 4},
                          {"9C", 4},
                          {"9D", 4},
                          {"9E", 4},
                          {"9F", 4},
                          {"A0", 4},
                          {"AD", 4},
                          {"91 00", 8},
                          {"91 01", 8},
                          {"91 00 00", 8},
                          {"AE 00", 5},
                          {"B4 00", 3},
                          {"B5 00", 3},
                          {"B7", 4}};
    for (const Case& c : cases)
        EXPECT_EQ(hex(b.ask(c.sent)).size(), c.bytes + 1) << c.sent;
}

/// All control words, all lengths: only the listed forms are taken, everything else is one syntax error with the raw control word.
TEST(TwinInstructions, OnlyTheListedFormsAreTaken) {
    const std::map<unsigned, std::set<int>> forms = {{0x01, {1, 2}},
                                                     {0x06, {1, 3}},
                                                     {0x07, {1, 3}},
                                                     {0x0B, {0}},
                                                     {0x0C, {0}},
                                                     {0x0F, {1, 2, 3}},
                                                     {0x10, {1, 3}},
                                                     {0x11, {1, 2}},
                                                     {0x15, {0, 1}},
                                                     {0x16, {0}},
                                                     {0x17, {0}},
                                                     {0x18, {0, 1}},
                                                     {0x19, {0, 1, 2, 3, 4}},
                                                     {0x1A, {0, 1, 2, 3, 4}},
                                                     {0x1B, {0, 1, 2, 3, 4}},
                                                     {0x1C, {0, 1, 2, 3, 4}},
                                                     {0x1D, {0, 1, 2, 3, 4}},
                                                     {0x1E, {0, 1, 2, 3, 4}},
                                                     {0x1F, {0, 1, 2, 3, 4}},
                                                     {0x20, {0, 1, 2, 3, 4}},
                                                     {0x21, {0}},
                                                     {0x2D, {0, 1, 2, 3, 4}},
                                                     {0x2E, {1}},
                                                     {0x34, {1, 3}},
                                                     {0x35, {1, 3}},
                                                     {0x37, {0, 4}},
                                                     {0x3D, {1, 3}},
                                                     {0x7E, {1}}};
    ASSERT_EQ(forms.size(), 28u);
    int taken = 0;
    for (unsigned function = 0; function < 128; ++function) {
        for (int dl = 0; dl <= 8; ++dl) {
            Bench b;
            b.setup({"9F 00 00 00 00"});  // mode PTP, so that SP is not refused for another reason
            std::string sent = text(std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(function | 0x80u)});
            for (int i = 0; i < dl; ++i)
                sent += " 00";
            const Lines got = b.send(sent);
            const auto it = forms.find(function);
            const bool good = it != forms.end() && it->second.contains(dl);
            const bool syntax = got.size() == 1 && got[0].substr(0, 8) == "0F 00 32";
            EXPECT_EQ(syntax, !good) << sent << " -> " << testing::PrintToString(got);
            if (good) ++taken;
            if (!good && got.size() == 1) {
                EXPECT_EQ(got[0].substr(9, 2), sent.substr(0, 2));
                EXPECT_EQ(b.ask("8F 00"), got[0]);
            }
        }
    }
    EXPECT_EQ(taken, 49 + 27 + 1);  // the manual's lengths, the short forms (1..3) of nine 32-bit values, ER cleared with 3 bytes
}

TEST(TwinInstructions, ShortValuesAreFilledWithZeros) {
    Bench b;
    run(b, {{"9D F0 D8", "2E 02 F0 D8 00 00"},  // +55536, not -10000
            {"AE 02", "2E 02 F0 D8 00 00"},
            {"9D 10 27", "2E 02 10 27 00 00"},
            {"9D F0 D8 FF FF", "2E 02 F0 D8 FF FF"},
            {"9F 80 0C", "2E 03 80 0C 00 00"},
            {"9F 80 F3 FF FF", "2E 03 80 F3 FF FF"},
            {"A0 80 0C", "2E 04 80 0C 00 00"},
            {"9E 80 0C", "2E 02 80 0C 00 00"},
            {"A0 FF", "2E 04 FF 00 00 00"},
            {"A0 01 02 03", "2E 04 01 02 03 00"},
            {"99 64", "19 64 00 00 00"},
            {"9A 64", "1A 64 00 00 00"},
            {"9B 64 01", "1B 64 01 00 00"},
            {"9C 00 00 01", "1C 00 00 01 00"},
            {"AD 10", "2D 10 00 00 00"}});
}

TEST(TwinInstructions, MisprintedExamplesActAsTheirBytesSay) {
    Bench b;
    run(b, {{"90 00", "10 00 10 00"},                    // "MT SET" with DL 1 is a GET
            {"99", "19 10 27 00 00"},                    // "AC SET" with DL 0 is a GET
            {"BD 04 00 00 00", "0F 00 32 BD 04 00 00"},  // "QE GET" with DL 4 is nothing
            {"A0 00 00 00 00", "2E 04 00 00 00 00"},
            {"9E E8 03 00 00", "2E 02 E8 03 00 00"},  // the "PR SET" example has SP's control word
            {"98 01", "0F 00 33 98 00 00 00"},        // MF = 1 is reserved
            {"B4 10", "0F 00 34 B4 10 00 00"},        // IL[16] does not exist
            {"B4 10 01 00", "0F 00 34 B4 10 00 00"}});
}

TEST(TwinInstructions, WithoutBitSevenExecutedInSilence) {
    Bench b;
    run(b, {{"15 01", nullptr},
            {"95", "15 01"},
            {"19 88 13 00 00", nullptr},
            {"99", "19 88 13 00 00"},
            {"0B", nullptr},
            {"0C", nullptr},
            {"11 00", nullptr},
            {"18 03", nullptr},
            {"98", "18 03"},
            {"17", nullptr},
            {"21", nullptr}});
    // A wrong one is reported all the same, with bit 7 as it came.
    run(b, {{"15 02", "0F 00 33 15 00 00 00"}, {"22", "0F 00 32 22 00 00 00"}, {"11 02", "0F 00 34 11 02 00 00"}});
}

TEST(TwinInstructions, NotificationsAndUnknownWordsAreNotInstructions) {
    Bench b;
    run(b, {{"5A 01", "0F 00 32 5A 00 00 00"},
            {"DA", "0F 00 32 DA 00 00 00"},
            {"80", "0F 00 32 80 00 00 00"},
            {"FF", "0F 00 32 FF 00 00 00"},
            {"A2 00", "0F 00 32 A2 00 00 00"}});
}

TEST(TwinInstructions, DataErrors) {
    const char* const bad[] = {"81 05 05",       "81 07 04",       "81 07 7F",       "81 08 00",       "81 08 80",       "86 00 02 00",
                               "86 07 00 01",    "87 00 02 00",    "87 08 01 01",    "BD 00 00 00",    "BD 01 09 00",    "BD 02 10 00",
                               "BD 02 13 00",    "BD 03 00 00",    "BD 03 01 00",    "BD 04 C7 00",    "BD 04 01 64",    "90 00 00 00",
                               "90 00 03 00",    "90 00 80 00",    "90 01 04 00",    "90 01 51 00",    "90 02 65 00",    "90 03 61 EA",
                               "95 02",          "95 FF",          "98 01",          "98 08",          "98 FF",          "99 00 00 00 00",
                               "99 41 D2 DF 03", "9A 00 00 00 00", "9A 41 D2 DF 03", "AD 01 00 01 00", "AD FF FF FF FF", "91 00 01",
                               "8F 00 01",       "8F 0A 01",       "8F 00 00 01",    "B4 00 0C 80",    "B4 00 80 0C",    "B4 02 8C 80",
                               "B4 01 80 FF",    "B4 00 40 80",    "B4 03 02 00",    "B4 03 00 01",    "B5 00 62 EA",    "B5 02 FF FF",
                               "B7 01 00 00 00", "B7 01 02 00 00", "B7 02 01 00 00", "B7 01 01 01 00", "B7 01 01 00 01"};
    Bench b;
    for (const char* s : bad) {
        const auto bytes = hex(s);
        const bool indexed =
            bytes[0] != 0x95 && bytes[0] != 0x98 && bytes[0] != 0x99 && bytes[0] != 0x9A && bytes[0] != 0xAD && bytes[0] != 0xB7;
        char want[40];
        std::snprintf(want, sizeof want, "0F 00 33 %02X %02X 00 00", bytes[0], indexed ? bytes[1] : 0);
        EXPECT_EQ(b.ask(s), want) << s;
    }
    // The outermost good values.
    for (const char* s :
         {"81 05 00",       "81 05 04",       "81 07 05",       "81 07 7E",       "81 08 7E",       "BD 00 01 00",    "BD 00 FF FF",
          "BD 01 0A 00",    "BD 01 FF FF",    "BD 02 14 00",    "BD 04 C8 00",    "BD 04 00 64",    "90 00 01 00",    "90 00 40 00",
          "90 01 05 00",    "90 01 50 00",    "90 02 00 00",    "90 02 64 00",    "90 03 60 EA",    "98 07",          "98 00",
          "99 01 00 00 00", "99 40 D2 DF 03", "9C FF FF FF FF", "9A 40 D2 DF 03", "9B FF FF FF FF", "AD 00 00 01 00", "B4 00 8B 0B",
          "B4 02 0B 8B",    "B4 03 01 00",    "B5 01 61 EA",    "B5 01 60 EA",    "9D 00 00 00 80", "9D FF FF FF 7F", "A0 00 00 00 80"}) {
        EXPECT_NE(b.ask(s).substr(0, 2), "0F") << s;
    }
}

TEST(TwinInstructions, SubIndexErrors) {
    const char* const bad[] = {"81 00", "81 06",       "81 09 05", "86 08",    "86 FF 00 00", "87 03",    "87 07 01 00", "87 09",
                               "8F 01", "8F 05",       "8F 07",    "8F 09",    "8F 13",       "8F 13 00", "BD 05",       "BD 05 00 00",
                               "90 04", "90 04 01 00", "91 02",    "91 01 00", "91 02 00",    "AE 05",    "B4 04",       "B4 04 80 80",
                               "B5 03", "B5 03 00 00", "FE 00",    "FE 03",    "7E 00"};
    Bench b;
    for (const char* s : bad) {
        const auto bytes = hex(s);
        char want[40];
        std::snprintf(want, sizeof want, "0F 00 34 %02X %02X 00 00", bytes[0], bytes[1]);
        EXPECT_EQ(b.ask(s), want) << s;
    }
}

/// Index before value, value before state.
TEST(TwinInstructions, OrderOfValidation) {
    Bench b;
    b.setup({"95 01", "9D E8 03 00 00", "96"});
    b.pass_ms(100);
    run(b, {{"81 00 FF", "0F 00 34 81 00 00 00"},
            {"81 05 FF", "0F 00 33 81 05 00 00"},
            {"81 05 02", "0F 00 3D 81 05 00 00"},
            {"90 00 03 00", "0F 00 33 90 00 00 00"},
            {"90 00 20 00", "0F 00 3D 90 00 00 00"}});
}

TEST(TwinInstructions, NotWhileRunning) {
    Bench b;
    b.setup({"95 01", "9D E8 03 00 00", "96"});
    b.pass_ms(100);
    const char* const refused[] = {"81 05 02",    "81 07 06",    "81 08 0B",    "86 00 01 00", "86 06 00 00", "BD 00 E8 03",
                                   "BD 01 64 00", "BD 02 11 00", "BD 04 80 0C", "90 00 10 00", "FE 02"};
    for (const char* s : refused)
        EXPECT_EQ(b.ask(s).substr(0, 8), "0F 00 3D") << s;
    const char* const taken[] = {"99 88 13 00 00",
                                 "9A 88 13 00 00",
                                 "9B 00 00 00 00",
                                 "9C 00 6A 18 00",
                                 "9D E8 03 00 00",
                                 "9F 64 00 00 00",
                                 "A0 64 00 00 00",
                                 "9E E8 03 00 00",
                                 "98 00",
                                 "AD 00 00 00 00",
                                 "87 00 01 00",
                                 "B4 00 80 80",
                                 "B5 00 00 00",
                                 "B7 00 01 00 00",
                                 "90 01 1C 00",
                                 "90 02 32 00",
                                 "90 03 00 00",
                                 "95 01",
                                 "96",
                                 "81 05",
                                 "86 00",
                                 "BD 00",
                                 "97"};
    for (const char* s : taken)
        EXPECT_NE(b.ask(s).substr(0, 2), "0F") << s;
    b.pass_ms(1000);
    for (const char* s : refused) {
        if (std::string_view(s) == "FE 02") continue;
        EXPECT_NE(b.ask(s).substr(0, 2), "0F") << s;
    }
    EXPECT_TRUE(b.send("FE 02").empty());
}

TEST(TwinInstructions, SdBelowDc) {
    Bench b;
    run(b, {{"9C 0F 27 00 00", "0F 00 3C 9C 00 00 00"},  // SD 9999 < DC 10000
            {"9C 10 27 00 00", "1C 10 27 00 00"},        // equal is good
            {"9A 11 27 00 00", "0F 00 3C 9A 00 00 00"},  // DC 10001 > SD 10000
            {"9C 00 00 00 00", "0F 00 3C 9C 00 00 00"},  // SD = 0 never in rate mode
            {"9C", "1C 10 27 00 00"},
            {"9A", "1A 10 27 00 00"},
            {"98 02", "18 02"},
            {"9A 11 27 00 00", "1A 11 27 00 00"},  // groups of the inputs are not compared
            {"86 04 01 00", "06 04 01 00"},        // times cannot be compared with a rate
            {"9A 60 EA 00 00", "1A 60 EA 00 00"},
            {"9C 00 00 00 00", "1C 00 00 00 00"}});
}

TEST(TwinInstructions, BeginAndOriginRules) {
    Bench b;
    run(b, {{"96", "0F 00 3E 96 00 00 00"},
            {"16", "0F 00 3E 16 00 00 00"},
            {"95 01", "15 01"},
            {"9D 10 27 00 00", "2E 02 10 27 00 00"},
            {"96", "16 00 00 00 00"}});
    b.pass_ms(2000);
    run(b, {{"A1", "0F 00 41 A1 00 00 00"}, {"97", "17"}, {"96", "0F 00 3F 96 00 00 00"}, {"A1", "0F 00 41 A1 00 00 00"}});
    b.pass_ms(6.24);
    EXPECT_EQ(b.ask("96"), "0F 00 3F 96 00 00 00");
    b.pass_ms(0.011);
    EXPECT_TRUE(b.stopped());
    EXPECT_EQ(b.ask("A1"), "21");
    EXPECT_EQ(b.position(), 0);
    EXPECT_EQ(b.relative(), 0);
    EXPECT_EQ(b.ask("96"), "16 00 00 00 00");
}

TEST(TwinInstructions, SpeedNeedsPositionModeOrAGroup) {
    Bench b;
    run(b, {{"9E E8 03 00 00", "0F 00 32 9E 00 00 00"},
            {"98 02", "18 02"},
            {"9E E8 03 00 00", "2E 02 E8 03 00 00"},  // a group of an input: always
            {"AE 02", "2E 02 00 00 00 00"},           // and not the desired speed
            {"A0 00 00 00 00", "2E 04 00 00 00 00"},
            {"9E E8 03 00 00", "2E 02 E8 03 00 00"},
            {"9E E9 03 00 00", "2E 02 E9 03 00 00"},  // as often as wanted
            {"9D 05 00 00 00", "2E 02 05 00 00 00"},  // JV: one register for both
            {"AE 02", "2E 02 05 00 00 00"},
            {"9E E8 03 00 00", "0F 00 32 9E 00 00 00"}});
}

TEST(TwinInstructions, ModeWordChangesAtSet) {
    Bench b;
    EXPECT_EQ(b.ask("AE 00"), "2E 00 00 00 00 00");
    b.setup({"A0 00 00 00 00"});
    EXPECT_EQ(b.ask("AE 00"), "2E 00 01 00 00 00");
    EXPECT_EQ(b.status1() & 3u, 1u);
    b.setup({"9D 00 00 00 00"});
    EXPECT_EQ(b.ask("AE 00"), "2E 00 00 00 00 00");
    b.setup({"9F 00 00 00 00"});
    EXPECT_EQ(b.status1() & 3u, 1u);
}

TEST(TwinInstructions, MotionFrameIsOneShot) {
    Bench b;
    run(b, {{"98 03", "18 03"},
            {"99 E8 03 00 00", "19 E8 03 00 00"},
            {"98", "18 00"},
            {"99", "19 10 27 00 00"},
            {"98 03", "18 03"},
            {"98", "18 03"},             // reading MF does not spend it
            {"99", "19 E8 03 00 00"},    // group 3
            {"99", "19 10 27 00 00"}});  // group 0 again
    // Six groups, five values each, all apart.
    for (int g : {2, 3, 4, 5, 6, 7}) {
        const auto mf = "98 " + text(std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(g)});
        int k = 0;
        for (const char* cw : {"99", "9A", "9E", "9F", "A0"}) {
            b.setup({mf, std::string(cw) + " " + le32(1000 * g + k++)});
        }
    }
    for (int g : {7, 6, 5, 4, 3, 2}) {
        const auto mf = "98 " + text(std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(g)});
        int k = 0;
        for (const char* cw : {"99", "9A", "9E", "9F", "A0"}) {
            b.setup({mf});
            EXPECT_EQ(b.ask(cw).substr(3), le32(1000 * g + k++)) << g << " " << cw;
        }
    }
    EXPECT_EQ(b.ask("99"), "19 10 27 00 00");
    EXPECT_EQ(b.ask("A0"), "20 00 00 00 00");
    EXPECT_EQ(b.ask("AE 04"), "2E 04 00 00 00 00");
    EXPECT_EQ(b.ask("AE 00"), "2E 00 00 00 00 00");  // a group's PA does not change the mode
    // Single values act on themselves whatever MF is, and spend it.
    for (const char* cw : {"9B", "9C", "9D", "AD"}) {
        b.setup({"98 05", cw});
        EXPECT_EQ(b.ask("98"), "18 00") << cw;
    }
    b.setup({"98 05", "9D 07 00 00 00"});
    EXPECT_EQ(b.ask("AE 02"), "2E 02 07 00 00 00");
    EXPECT_EQ(b.ask("98"), "18 00");
    // A status poll in between does not spend it; an error does.
    b.setup({"98 05", "91 00", "AE 02", "95"});
    EXPECT_EQ(b.ask("98"), "18 05");
    EXPECT_EQ(b.ask("91 07"), "0F 00 34 91 07 00 00");
    EXPECT_EQ(b.ask("98"), "18 00");
    b.setup({"98 05"});
    EXPECT_EQ(b.ask("99 00 00 00 00"), "0F 00 33 99 00 00 00");
    EXPECT_EQ(b.ask("98"), "18 00");
}

TEST(TwinInstructions, PortsAreAsymmetric) {
    Bench b;
    b.inputs(3);
    b.pass_ms(1);
    run(b, {{"B7", "37 03 00 00 00"}, {"B7 01 01 00 00", "37 03 01 00 00"}, {"B7", "37 03 01 00 00"}});
    EXPECT_EQ(b.status1(), 0x18u | 0x40u);
    EXPECT_EQ(b.ask("B7 00 01 00 00"), "37 03 00 00 00");
    b.inputs(4);
    b.pass_ms(1);
    EXPECT_EQ(b.ask("B7"), "37 04 00 00 00");
    EXPECT_EQ(b.status1(), 0x20u);
}

TEST(TwinInstructions, ErrorHistory) {
    Bench b;
    for (int i = 0; i < 11; ++i)
        (void)b.ask("81 " + text(std::array<std::uint8_t, 1>{static_cast<std::uint8_t>(0x20 + i)}));
    EXPECT_EQ(b.ask("8F 00"), "0F 00 34 81 2A 00 00");
    for (int i = 0; i < 9; ++i) {
        char want[40];
        std::snprintf(want, sizeof want, "0F %02X 34 81 %02X 00 00", 10 + i, 0x2A - i);
        char ask[8];
        std::snprintf(ask, sizeof ask, "8F %02X", 10 + i);
        EXPECT_EQ(b.ask(ask), want);
    }
    EXPECT_EQ(b.ask("8F 0C 00"), "0F 0C 00 00 00 00 00");  // in place: the others stay
    EXPECT_EQ(b.ask("8F 0C"), "0F 0C 00 00 00 00 00");
    EXPECT_EQ(b.ask("8F 0B"), "0F 0B 34 81 29 00 00");
    EXPECT_EQ(b.ask("8F 0D"), "0F 0D 34 81 27 00 00");
    EXPECT_EQ(b.ask("8F 00 00 00"), "0F 00 00 00 00 00 00");
    EXPECT_EQ(b.ask("8F 0A"), "0F 0A 00 00 00 00 00");  // the same slot
    EXPECT_TRUE(b.error());
    (void)b.ask("91 00 00");
    EXPECT_FALSE(b.error());
    EXPECT_EQ(b.ask("8F 0B"), "0F 0B 34 81 29 00 00");  // the history is another thing
}

TEST(TwinInstructions, DesiredCurrent) {
    Bench b;
    EXPECT_EQ(b.ask("AE 01"), "2E 01 00 00 00 00");
    b.setup({"95 01"});
    EXPECT_EQ(b.ask("AE 01"), "2E 01 0E 00 00 00");  // 28 * 50 %
    b.setup({"9D E8 03 00 00", "96"});
    EXPECT_EQ(b.ask("AE 01"), "2E 01 1C 00 00 00");
    b.setup({"97"});
    b.pass_ms(100);
    b.setup({"90 01 50 00", "90 02 21 00"});
    EXPECT_EQ(b.ask("AE 01"), "2E 01 1A 00 00 00");  // 80 * 33 % = 26.4
}

TEST(TwinInstructions, MicrosteppingTakesPulsesPerTurnAlong) {
    Bench b;
    b.setup({"90 00 20 00"});
    EXPECT_EQ(b.ask("BD 04"), "3D 04 00 19");  // 32 * 200
    b.setup({"BD 04 88 13"});
    EXPECT_EQ(b.ask("BD 04"), "3D 04 88 13");
    EXPECT_EQ(b.ask("90 00"), "10 00 20 00");
    b.setup({"90 00 40 00"});
    EXPECT_EQ(b.ask("BD 04"), "3D 04 00 32");
}

// --- addressing ---------------------------------------------------------------------------------------------------------

TEST(TwinAddressing, HighBitsOfTheIdLiveInTheExtendedPart) {
    const std::vector<std::uint8_t> one{1};
    Bench five;
    EXPECT_TRUE(five.frame(Frame::can_extended(0x04284095, one)).empty());
    EXPECT_EQ(five.frame(Frame::can_extended(0x04280095, one)), Lines{"15 01"});
    auto d = make(can_setup("37"));
    Out out;
    d->power_on({}, time_zero, out);
    d->on_frame(Frame::can_extended(0x04284095, one), time_zero, out);
    ASSERT_EQ(out.frames.size(), 1u);
    EXPECT_EQ(to_text(out.frames[0].frame), "05210015#01");
}

TEST(TwinAddressing, FourNodesThatShareTheBasePart) {
    Bench b;
    for (const char* n : {"37", "69", "101"})
        b.add(can_setup(n));
    for (unsigned n : {5u, 37u, 69u, 101u}) {
        b.address(n);
        EXPECT_EQ(b.ask("95 01"), "15 01") << n;
    }
    Bench global(can_setup("32"));
    global.add(can_setup("64"));
    global.add(can_setup("96"));
    EXPECT_EQ(global.send_to(64, "95"), Lines{"64:15 00"});
    EXPECT_EQ(global.send_to(0, "95").size(), 3u);
}

TEST(TwinAddressing, GroupAndGlobalAreAcknowledgedByEachNodeUnderItsOwnId) {
    Bench b;
    b.add(can_setup("6"));
    b.add(can_setup("7"));
    EXPECT_EQ(b.send_to(0, "95 01"), (Lines{"15 01", "6:15 01", "7:15 01"}));
    EXPECT_EQ(b.send_to(10, "95"), (Lines{"15 01", "6:15 01", "7:15 01"}));
    EXPECT_TRUE(b.send_to(0, "16").empty());
    EXPECT_TRUE(b.send_to(10, "17").empty());
    EXPECT_TRUE(b.send_to(11, "95").empty());
    EXPECT_TRUE(b.send_to(4, "95").empty());
    EXPECT_EQ(b.send_to(0, "15 07").size(), 3u);  // errors are always told
    EXPECT_EQ(b.send_to(0, "8B").size(), 3u);     // discovery
}

TEST(TwinAddressing, AnswersGoToWhoAsked) {
    Bench b;
    auto d = make(can_setup());
    Out out;
    d->power_on({}, time_zero, out);
    // Producer 1 instead of 4: bits 28..24 are 1.
    d->on_frame(Frame::can_extended(0x01280095, no_data), time_zero, out);
    d->on_frame(Frame::can_extended(0x012800FF, no_data), time_zero, out);
    ASSERT_EQ(out.frames.size(), 2u);
    EXPECT_EQ(to_text(out.frames[0].frame), "05080015#00");  // consumer 1: bits 23..19
    EXPECT_EQ(out.frames[1].frame.id, 0x0508000Fu);
    out.clear();
    ASSERT_EQ(d->set_hand("inputs", Value{std::int64_t{1}}, time_zero, out), "");
    ASSERT_EQ(out.frames.size(), 1u);
    EXPECT_EQ(to_text(out.frames[0].frame), "0520005A#02");  // notifications to 4
}

/// A spoilt identifier can name a node as the producer; then its neighbour's report would be answered by a report, and so on for ever.
TEST(TwinAddressing, ReportsOfOtherNodesAreNotAnswered) {
    Bench b;
    const auto report = hex("00 32 2E 00 00 00");
    const auto id = [](unsigned producer) { return (producer & 0x1Fu) << 24 | 5u << 19 | 0x0Fu; };
    EXPECT_TRUE(b.frame(Frame::can_extended(id(6), report)).empty());
    EXPECT_FALSE(b.error());
    EXPECT_EQ(b.frame(Frame::can_extended(id(4), report)), Lines{"0F 00 32 0F 00 00 00"}) << "a host's instruction of that length is wrong";
}

TEST(TwinAddressing, SerialNumbersFollowTheAddressAndModelsTheOption) {
    std::set<std::string> serials;
    for (const char* n : {"5", "6", "7", "8", "9"}) {
        Bench b(can_setup(n));
        serials.insert(b.ask("8C"));
        Bench again(can_setup(n));
        EXPECT_TRUE(serials.contains(again.ask("8C")));
    }
    EXPECT_EQ(serials.size(), 5u);
    const std::pair<const char*, const char*> models[] = {{"342XS", "20 0A 11"},  {"342S", "21 0A 11"},   {"342C02", "22 14 13"},
                                                          {"342C04", "22 28 13"}, {"342C08", "22 50 13"}, {"342H08", "22 50 19"}};
    for (const auto& [name, bytes] : models) {
        TwinSetup s = can_setup();
        s.options["model"] = name;
        Bench b(s);
        EXPECT_EQ(b.ask("8B").substr(3, 8), bytes);
    }
}

}  // namespace
}  // namespace axisgate::uim342::test
