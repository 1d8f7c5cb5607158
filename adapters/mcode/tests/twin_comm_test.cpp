// The link of the twin: all shapes of replies, party mode, checksum, control characters, bounds.
// In: bytes. Out: bytes.
// Never shares code with the adapter: checksums are worked out by hand or by the test's own sum.
#include <array>
#include <random>

#include "adapters/mcode/tests/twin_bench.hpp"

namespace axisgate::mcode::twin::test {
namespace {

std::string with_sum(const std::string& s) {
    unsigned sum = 0;
    for (const char c : s)
        sum += static_cast<std::uint8_t>(c);
    return s + static_cast<char>(((256 * 64 - sum) & 0x7F) | 0x80);
}

TEST(TwinComm, ChecksumsOfTheManual) {
    struct Row {
        const char* text;
        int sum;
    };
    for (const Row& r : {Row{"MR 51200", 0xC9},
                         {"MR 1", 0x90},
                         {"mr 1", 0xD0},
                         {"PR P", 0xEE},
                         {"aPR P", 0x8D},
                         {"!MR 512000", 0xF8},
                         {"*MR 10000", 0xA6}}) {
        EXPECT_EQ(static_cast<std::uint8_t>(Comm::checksum(r.text)), r.sum) << r.text;
    }
    EXPECT_EQ(static_cast<std::uint8_t>(Comm::checksum("@@")), 0x80);  // a sum of 128 must not become a terminator
}

struct Shape {
    int em;
    bool py;
    int ck;
    const char* plain;
    const char* data;
};

class Shapes : public ::testing::TestWithParam<Shape> {};

TEST_P(Shapes, ReplyToACommandAndToPr) {
    const Shape& s = GetParam();
    DeviceSetup setup;
    if (s.py) setup.name = 'a';
    Bench b(setup);
    if (s.py) b.send("\n");
    const std::string dn = s.py ? "a" : "", end = s.py ? "\n" : "\r";
    b.send(dn + "EM=2" + end);
    b.send(dn + "P=0" + end);
    b.send(dn + "CK=" + std::to_string(s.ck) + end);
    const auto line = [&](const std::string& text) { return (s.ck > 0 ? with_sum(dn + text) : dn + text) + end; };
    b.send(line("EM=" + std::to_string(s.em)));
    EXPECT_EQ(shown(b.send(line("A=1000"))), s.plain);
    EXPECT_EQ(shown(b.send(line("PR A"))), s.data);
}

// 1000 is 31 30 30 30: sum C1, checksum BF. A=1000 sums to 13F with CK C1; PR A to 103, FD; with 'a' before: 1A0 E0, 164 9C.
INSTANTIATE_TEST_SUITE_P(AllSixteen, Shapes,
                         ::testing::Values(Shape{0, false, 0, "A=1000<CR><LF>>", "PR A<CR><LF>1000<CR><LF>>"},
                                           Shape{1, false, 0, "<CR><LF>", "<CR><LF>1000<CR><LF>"}, Shape{2, false, 0, "", "1000<CR><LF>"},
                                           Shape{3, false, 0, "A=1000<CR><LF>", "PR A<CR><LF>1000<CR><LF>"},
                                           Shape{0, true, 0, "A=1000<CR><LF>>", "PR A<CR><LF>1000<CR><LF>>"},
                                           Shape{1, true, 0, "<CR><LF>", "<CR><LF>1000<CR><LF>"}, Shape{2, true, 0, "", "1000<CR><LF>"},
                                           Shape{3, true, 0, "A=1000<CR><LF>", "PR A<CR><LF>1000<CR><LF>"},
                                           Shape{0, false, 1, "A=1000<C1><ACK>>", "PR A<FD><ACK>1000<BF><CR><LF>>"},
                                           Shape{1, false, 1, "<ACK>", "<ACK>1000<BF><CR><LF>"}, Shape{2, false, 1, "", "1000<BF><CR><LF>"},
                                           Shape{3, false, 1, "A=1000<C1><ACK>", "PR A<FD><ACK>1000<BF><CR><LF>"},
                                           Shape{0, true, 1, "A=1000<E0><ACK>>", "PR A<9C><ACK>1000<BF><CR><LF>>"},
                                           Shape{1, true, 1, "<ACK>", "<ACK>1000<BF><CR><LF>"}, Shape{2, true, 1, "", "1000<BF><CR><LF>"},
                                           Shape{3, true, 1, "A=1000<E0><ACK>", "PR A<9C><ACK>1000<BF><CR><LF>"}),
                         [](const auto& row) {
                             return "em" + std::to_string(row.param.em) + (row.param.py ? "_party" : "_single") + "_ck" +
                                    std::to_string(row.param.ck);
                         });

TEST(TwinComm, PartyModeWaitsForTheFirstLineFeed) {  // trap 1
    Bench b;
    EXPECT_EQ(shown(b.send("PY=1\r")), "PY=1<CR><LF>>");
    EXPECT_EQ(b.send("!PR P"), "");
    EXPECT_EQ(b.send("\n"), "");
    EXPECT_EQ(shown(b.send("!PR P\n")), "PR P<CR><LF>0<CR><LF>>");
    EXPECT_EQ(b.send("PR P\r"), "") << "without its name";
    b.send("\n");
    b.send("*PY=0\n");
    EXPECT_EQ(b.type("PR PY"), "0");
}

TEST(TwinComm, GlobalCommandsAreSilentUnlessToldOtherwise) {  // trap 2
    DeviceSetup s;
    s.name = 'a';
    Bench b(s);
    b.send("\n");
    EXPECT_EQ(b.send("*A=5000\n"), "");
    EXPECT_EQ(shown(b.send("aPR A\n")), "PR A<CR><LF>5000<CR><LF>>");
    b.send("aDG=0\n");
    EXPECT_EQ(shown(b.send("*A=6000\n")), "A=6000<CR><LF>>");
    EXPECT_EQ(b.send("^A=7000\n"), "") << "QD = 0: not one of the group";
    EXPECT_EQ(shown(b.send("aPR A\n")), "PR A<CR><LF>6000<CR><LF>>");
    b.send("aQD=1\n");
    b.send("^A=7000\n");
    EXPECT_EQ(shown(b.send("aPR A\n")), "PR A<CR><LF>7000<CR><LF>>");
    EXPECT_EQ(b.send("bPR A\n"), "");
    EXPECT_EQ(b.send("APR A\n"), "") << "names are case sensitive";
}

TEST(TwinComm, WrongChecksumIsRefusedAndChangesNothing) {  // trap 3
    Bench b;
    b.send("PY=1\r");
    b.send("\n!EM=1\n");
    b.send("!CK=1\n");
    EXPECT_EQ(shown(b.send("!MR 512000\xF8\n")), "<ACK>");
    b.pass(std::chrono::seconds(3));
    EXPECT_EQ(shown(b.send("!MR 513000\xF8\n")), "<NAK>");
    EXPECT_EQ(shown(b.send(with_sum("!PR P") + "\n")), "<ACK>512000" + shown(std::string(1, with_sum("512000").back())) + "<CR><LF>");
    EXPECT_NE(with_sum("mr 1"), with_sum("MR 1"));
}

TEST(TwinComm, SecondChecksumModeIsQuietWhileAProgramRuns) {  // trap 4
    Bench b;
    b.program({"LB K1", "H 60000", "E"});
    b.type("EM=1");
    b.send("CK=2\r");
    EXPECT_EQ(shown(b.send(with_sum("A=1000") + "\r")), "<ACK>");
    b.send(with_sum("EX K1") + "\r");
    EXPECT_EQ(shown(b.send(with_sum("A=2000") + "\r")), "");
    EXPECT_EQ(shown(b.send(with_sum("VM=X") + "\r")), "<NAK>");
    EXPECT_EQ(shown(b.send("A=3000\x80\r")), "<NAK>");
}

TEST(TwinComm, EchoComesCharacterByCharacterOrAfterwards) {  // trap 5
    Bench b;
    EXPECT_EQ(b.send("A"), "A");
    EXPECT_EQ(b.send("=1"), "=1");
    EXPECT_EQ(shown(b.send("000\r")), "000<CR><LF>>");
    b.type("EM=3");
    EXPECT_EQ(b.send("A=2"), "");
    EXPECT_EQ(shown(b.send("000\r")), "A=2000<CR><LF>");
}

TEST(TwinComm, PromptShowsTheErrorUntilItIsRead) {  // trap 6
    Bench b;
    b.type("QQQQ 1");
    EXPECT_EQ(b.prompt, '?');
    b.type("A=1000");
    EXPECT_EQ(b.prompt, '?');
    EXPECT_EQ(b.type("PR EF"), "1");
    EXPECT_EQ(b.type("PR ER"), "60");
    EXPECT_EQ(b.prompt, '>');
    EXPECT_EQ(b.type("PR ER"), "0");
    EXPECT_EQ(b.type("PR EF"), "0");
}

TEST(TwinComm, SixtyFourCharactersCommentIncluded) {  // trap 15
    Bench b;
    const std::string good = "A=5000 '" + std::string(56, 'x');
    ASSERT_EQ(good.size(), 64U);
    b.type(good);
    EXPECT_EQ(b.type("PR A"), "5000");
    EXPECT_EQ(shown(b.send(good + "x")), good + "x<CR><LF>?");
    EXPECT_EQ(b.send("more of it\r"), "");
    EXPECT_EQ(b.type("PR ER"), "20");
}

TEST(TwinComm, EscapeAndResetInAllModes) {
    struct Row {
        int es;
        const char* bytes;
        bool stops;
    };
    for (const Row& r : {Row{0, "\x05", true},
                         {0, "\x1B", false},
                         {1, "\x1B", true},
                         {1, "\x05", false},
                         {2, "!\x05", true},
                         {2, "\x05", false},
                         {2, "x\x05", false},
                         {3, "!\x1B", true},
                         {3, "\x1B", false}}) {
        Bench b;
        b.program({"LB K1", "H 60000", "E"});
        b.type("ES=" + std::to_string(r.es));
        b.type("EX K1");
        const int before = b.motor->stops;
        b.send(r.bytes);
        EXPECT_EQ(b.motor->stops - before, r.stops ? 1 : 0) << r.es;
        EXPECT_EQ(b.type("PR BY"), r.stops ? "0" : "1") << r.es;
    }
    struct Reset {
        int ce;
        bool py;
        const char* bytes;
        bool resets;
    };
    for (const Reset& r : {Reset{0, false, "\x03", false},
                           {1, false, "\x03", true},
                           {1, true, "\x03", true},
                           {2, true, "\x03", false},
                           {2, true, "a\x03", true},
                           {2, false, "\x03", true}}) {
        DeviceSetup s;
        s.name = r.py ? 'a' : '!';
        Bench b(s);
        if (r.py) b.send("\n");
        const std::string dn = r.py ? "a" : "", end = r.py ? "\n" : "\r";
        b.send(dn + "CE=" + std::to_string(r.ce) + end);
        b.send(dn + "R1=7" + end);
        b.send(r.bytes);
        if (r.py) b.send("\n");
        b.send(dn + "EM=2" + end);
        EXPECT_EQ(shown(b.send(dn + "PR R1" + end)), r.resets ? "0<CR><LF>" : "7<CR><LF>") << r.ce << r.py;
    }
}

TEST(TwinComm, BaudRateChangesWithSaveAndReset) {  // trap 18
    DeviceSetup s;
    s.bit_rate = 9600;
    Bench b(s);
    b.type("BD=19");
    EXPECT_EQ(b.type("PR BD"), "19");
    b.send("\x03");
    EXPECT_EQ(b.type("PR BD"), "96") << "not saved";
    b.type("BD=19");
    b.type("S");
    EXPECT_EQ(b.type("PR BD"), "19") << "the old speed holds until the reset";
    b.send("\x03");
    EXPECT_EQ(b.send("PR BD\r"), "");
    DeviceSetup fast;
    fast.bit_rate = 19200;
    Bench other(fast, b.device->non_volatile());
    EXPECT_EQ(other.type("PR BD"), "19");
    EXPECT_EQ(other.error_of("BD=12"), 61);
}

TEST(TwinComm, DeviceNameNeedsQuotes) {
    Bench b;
    EXPECT_EQ(b.error_of("DN=a"), 21);
    EXPECT_EQ(b.error_of("DN=\"ab\""), 21);
    EXPECT_EQ(b.error_of("DN=\"$\""), 21);
    EXPECT_EQ(b.error_of("DN=\"b\""), 0);
    EXPECT_EQ(b.type("PR DN"), "b");
}

TEST(TwinComm, EthernetHasNoSerialCommands) {
    DeviceSetup s;
    s.ethernet = true;
    Bench b(s);
    for (const char* line : {"BD=96", "CK=1", "DG=0", "DN=\"a\"", "PY=1", "QD=1", "PR PY"})
        EXPECT_EQ(b.error_of(line), 37) << line;
}

TEST(TwinComm, NeighboursAnswersAreNotCommands) {
    DeviceSetup s;
    s.name = 'b';
    Bench b(s);
    b.send("\n");
    b.send("\x06");
    b.send("\r\n12345\xBF\r\n");
    EXPECT_EQ(shown(b.send("bPR A\n")), "PR A<CR><LF>1000000<CR><LF>>");
}

TEST(TwinComm, NinthWaitingLineIsLostWithError63) {
    Bench b;
    b.type("EM=2");
    std::string burst;
    for (int i = 0; i < 9; ++i)
        burst += "IC R1\r";
    b.send(burst, milliseconds(20));
    EXPECT_EQ(shown(b.send("PR R1\r")), "8<CR><LF>");
    EXPECT_EQ(shown(b.send("PR ER\r")), "63<CR><LF>");
}

// Text of neighbours is passed over in runs: that must be the same as taking each byte alone.
TEST(TwinComm, BytesInARunAreTheSameAsBytesOneByOne) {
    std::mt19937 random(5);
    const std::array<std::string, 14> pieces{
        "aPR A\n",  "bPR A\n",   "*A=7\n", "^A=9\n",       "\x06",    "b0123456789",        "\n",
        "0.5\r\n>", "cA=1\bX\n", "\x1b",   "b\x1b PR A\n", "aPR A\b", "bPR\x03 A\raPR P\n", std::string(40, 'x')};
    std::size_t commands = 0, passed_over = 0, overruns = 0;
    for (unsigned round = 0; round < 500; ++round) {
        Comm in_runs, one_by_one;
        for (Comm* c : {&in_runs, &one_by_one}) {
            c->flags.py = round % 8 != 0;
            c->flags.dn = 'a';
            c->flags.ck = round % 3 == 0;
            c->flags.em = static_cast<int>(round % 4);
            c->flags.es = static_cast<int>(round % 5 % 4);
            c->flags.qd = round % 2 == 0;
        }
        std::string bytes = "\n";
        for (int i = 0; i < 20; ++i)
            bytes += pieces[random() % pieces.size()];
        const auto data = std::span(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
        std::string seen[2], echo[2];
        const auto take = [&](Comm& c, int which, std::size_t at) {
            const LinkEvent::Kind kind = c.receive(data[at], echo[which]).kind;
            if (kind == LinkEvent::Kind::none) return;
            seen[which] += std::to_string(at) + ":" + std::to_string(static_cast<int>(kind)) + " ";
            if (kind == LinkEvent::Kind::command) seen[which] += c.take().as_received + " ";
            if (which == 0) (kind == LinkEvent::Kind::overrun ? overruns : commands) += 1;
        };
        for (std::size_t at = 0; at < data.size(); ++at)
            take(one_by_one, 1, at);
        for (std::size_t at = 0; at < data.size();) {
            const auto run = data.subspan(at, std::min<std::size_t>(1 + random() % 64, data.size() - at));
            for (std::size_t i = 0; i < run.size(); ++i) {
                const std::size_t over = in_runs.pass_over(run.subspan(i));
                passed_over += over;
                i += over;
                if (i < run.size()) take(in_runs, 0, at + i);
            }
            at += run.size();
        }
        ASSERT_EQ(seen[0], seen[1]) << "round " << round << ": " << shown(bytes);
        ASSERT_EQ(shown(echo[0]), shown(echo[1])) << "round " << round << ": " << shown(bytes);
    }
    EXPECT_GT(commands, 500u);
    EXPECT_GT(passed_over, 5000u);
    EXPECT_GT(overruns, 5u);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
