// Wire, framing, program check and decoder: golden bytes.
#include <gtest/gtest.h>

#include "adapters/mcode/decoder.hpp"
#include "adapters/mcode/wire.hpp"
#include "adapters/mcode/wire_reply.hpp"

namespace axisgate::mcode {
namespace {

TEST(Wire, ChecksumTable) {
    struct Row {
        const char* text;
        int sum;
    };
    for (const Row& r : {Row{"MR 51200", 0xC9}, Row{"MR 1", 0x90}, Row{"mr 1", 0xD0}, Row{"PR P", 0xEE}, Row{"aPR P", 0x8D},
                         Row{"!MR 512000", 0xF8}, Row{"*MR 10000", 0xA6}}) {
        EXPECT_EQ(static_cast<std::uint8_t>(checksum(r.text)), r.sum) << r.text;
        EXPECT_TRUE(checksum_good(r.text + std::string(1, checksum(r.text))));
        EXPECT_FALSE(checksum_good(r.text + std::string(1, static_cast<char>(checksum(r.text) ^ 1))));
    }
}
TEST(Wire, RequestsInAllFourForms) {
    EXPECT_EQ(request({'!', false}, "PR P"), "PR P\r");
    EXPECT_EQ(request({'!', true}, "PR P"), "PR P\xEE\r");
    EXPECT_EQ(request({'a', false}, "PR P"), "aPR P\n");
    EXPECT_EQ(request({'a', true}, "PR P"), "aPR P\x8D\n");
    EXPECT_EQ(escape({'!', false}), "\x1B");
    EXPECT_EQ(escape({'b', true}), "b\x1B");
}
TEST(Wire, LinesAndAddresses) {
    EXPECT_EQ(check_line(std::string(64, 'x')), "");
    for (const auto& bad : {std::string(), std::string(65, 'x'), std::string("MA 1\r"), std::string("MA 1\n"), std::string("MA \x1B"),
                            std::string("\xC3\xA4")})
        EXPECT_NE(check_line(bad), "");
    for (const char* good : {"!", "a", "Z", "0"})
        EXPECT_EQ(check_address(good), "");
    for (const char* bad : {"", "ab", "*", "^", "\n", " "})
        EXPECT_NE(check_address(bad), "");
}

/// The sixteen rows: what comes back for PR with data `#a7`, and for a command.
TEST(Framing, EveryEchoPartyAndChecksumMode) {
    for (int em = 0; em < 4; ++em) {
        for (int ck = 0; ck < 2; ++ck) {
            for (const bool party : {false, true}) {
                const auto shape = [&](const std::string& line, const std::string& data) {
                    std::string sent = request({party ? 'a' : '!', ck > 0}, line);
                    sent.pop_back();
                    std::string s;
                    if (em == 0 || em == 3) s += sent;
                    if (em != 2) s += ck ? "\x06" : "\r\n";
                    if (!data.empty()) s += data + (ck ? std::string(1, checksum(data)) : "") + "\r\n";
                    if (em == 0) s += '>';
                    return s;
                };
                Expect e;
                e.mark = "#a";
                e.checksum = ck > 0;
                e.prompt = em == 0;
                e.sent = party ? "aPR \"#a\",P" : "PR \"#a\",P";
                const std::string reply = shape("PR \"#a\",P", "#a7");
                ReplyReader r;
                r.begin(e);
                for (std::size_t i = 0; i + 1 < reply.size(); ++i)
                    ASSERT_EQ(r.push(reply.substr(i, 1)), Verdict::waiting) << em << ck << party << " at " << i;
                EXPECT_EQ(r.push(reply.substr(reply.size() - 1)), Verdict::answered) << em << ck << party;
                EXPECT_EQ(r.data(), "7");
                e.kind = em == 2 ? Expect::Kind::nothing : Expect::Kind::command;
                e.sent = party ? "aA=1000" : "A=1000";
                r.begin(e);
                const Verdict v = r.push(shape("A=1000", ""));
                if (em == 2) {
                    EXPECT_EQ(v, Verdict::waiting);
                    EXPECT_EQ(r.give_up(), Verdict::answered);
                } else {
                    EXPECT_EQ(v, Verdict::acknowledged) << em << ck << party;
                }
            }
        }
    }
}
TEST(Framing, ForeignAndLateTextIsNoAnswer) {
    Expect e;
    e.mark = "#b";
    ReplyReader r;
    r.begin(e);
    EXPECT_EQ(r.push("\r\n#a42\r\n"), Verdict::waiting) << "the answer to the question before";
    EXPECT_EQ(r.push("count 17\r\n"), Verdict::waiting) << "output of a program";
    EXPECT_EQ(r.push("aPR \"#b\",P\n"), Verdict::waiting) << "an echo of our own bytes";
    EXPECT_EQ(r.push("\r\n#b43\r\n"), Verdict::answered);
    EXPECT_EQ(r.data(), "43");
    EXPECT_NE(r.before().find("count 17"), std::string::npos);
}
TEST(Framing, OutputOfAProgramIsNoAcknowledgement) {
    Expect e;
    e.kind = Expect::Kind::command;
    e.sent = "aMA 100";
    ReplyReader r;
    r.begin(e);
    EXPECT_EQ(r.push("Pos 779\r\n"), Verdict::waiting);
    EXPECT_EQ(r.push("\r\n"), Verdict::acknowledged) << "CR LF alone is one";
    r.begin(e);
    EXPECT_EQ(r.push("x\r\n"), Verdict::acknowledged) << "one character before it is noise";
    r.begin(e);
    EXPECT_EQ(r.push("MA 100\r\n"), Verdict::acknowledged) << "it stands behind an echo";
    r.begin(e);
    EXPECT_EQ(r.push("Pos 779\r\n"), Verdict::waiting);
    EXPECT_EQ(r.give_up(), Verdict::waiting) << "nobody has acknowledged it";
    e.kind = Expect::Kind::query;
    e.sent = "PR \"#b\",P";
    e.mark = "#b";
    r.begin(e);
    EXPECT_EQ(r.push("Pos 779\r\n"), Verdict::waiting);
    EXPECT_EQ(r.give_up(), Verdict::waiting) << "a question is not refused by it";
    EXPECT_TRUE(r.nothing_of_it());
    r.begin(e);
    EXPECT_EQ(r.push("#b4"), Verdict::waiting);
    EXPECT_FALSE(r.nothing_of_it());
}
TEST(Framing, AnAcknowledgementMayStandBehindTheData) {
    for (const bool sums : {false, true}) {
        Expect e;
        e.mark = "#b";
        e.checksum = sums;
        e.trailing = true;
        const std::string ack = sums ? "\x06" : "\r\n", data = "#b43" + (sums ? std::string(1, checksum("#b43")) : "") + "\r\n";
        ReplyReader r;
        r.begin(e);
        EXPECT_EQ(r.push(data), Verdict::waiting);
        EXPECT_TRUE(r.awaits_trailing());
        EXPECT_EQ(r.push(ack), Verdict::answered);
        EXPECT_EQ(r.data(), "43");
        EXPECT_EQ(r.acknowledgement(), AckPlace::behind);
        r.begin(e);
        EXPECT_EQ(r.push(ack + data), Verdict::answered);
        EXPECT_EQ(r.acknowledgement(), AckPlace::before);
        r.begin(e);
        EXPECT_EQ(r.push(data), Verdict::waiting);
        EXPECT_EQ(r.give_up(), Verdict::answered) << "this drive has none";
        EXPECT_EQ(r.acknowledgement(), AckPlace::none);
        e.trailing = false;
        r.begin(e);
        EXPECT_EQ(r.push(data), Verdict::answered);
    }
}
TEST(Framing, SpoiledHalfAndRefused) {
    Expect e;
    e.mark = "#b";
    e.checksum = true;
    ReplyReader r;
    const std::string good = "\x06#b43" + std::string(1, checksum("#b43")) + "\r\n";
    std::string bad = good;
    bad[3] = '5';
    r.begin(e);
    EXPECT_EQ(r.push(bad), Verdict::garbled);
    r.begin(e);
    EXPECT_EQ(r.push(good.substr(0, 4)), Verdict::waiting);
    EXPECT_EQ(r.give_up(), Verdict::waiting) << "cut in the middle";
    r.begin(e);
    EXPECT_EQ(r.push("\x15"), Verdict::waiting) << "noise, if data follow";
    EXPECT_TRUE(r.maybe_refused());
    EXPECT_EQ(r.give_up(), Verdict::refused);
    e.checksum = false;
    r.begin(e);
    EXPECT_EQ(r.push("\r\n"), Verdict::waiting);
    EXPECT_EQ(r.give_up(), Verdict::refused) << "the line was obeyed, and nothing printed";
}
TEST(Framing, OnlyAnEchoIsTakenOutOfANativeAnswer) {
    EXPECT_EQ(plain_text("\r\n1 LB G1\r\n2 E\r\n", "L", false), "1 LB G1\r\n2 E") << "the request is a letter of its answer";
    EXPECT_EQ(plain_text("L\r\n1 LB G1\r\n>", "L", false), "1 LB G1");
    EXPECT_EQ(plain_text("aL\n\r\n1 LB aL\r\n", "aL", false), "1 LB aL");
}
TEST(Framing, SeveralLinesUpToTheEndMark) {
    Expect e;
    e.mark = "#c";
    e.end_mark = true;
    ReplyReader r;
    r.begin(e);
    EXPECT_EQ(r.push("\r\n#cIS = 1, 0, 0\r\n"), Verdict::waiting);
    EXPECT_EQ(r.push("IS = 2, 1, 1~\r\n"), Verdict::answered);
    EXPECT_EQ(r.data(), "IS = 1, 0, 0\r\nIS = 2, 1, 1");
}
TEST(Framing, PlainText) {
    EXPECT_EQ(plain_text("aPR P\r\n42\r\n>", "aPR P", false), "42");
    EXPECT_EQ(plain_text("\x06"
                         "42\x9A\r\n",
                         "aPR P\x8D", true),
              "42");
}

std::vector<std::string> decode(LineDecoder& d, std::string_view s, std::optional<bool> down) {
    return d.on_frame(Frame::run({reinterpret_cast<const std::uint8_t*>(s.data()), s.size()}), down);
}
TEST(Decoder, Lines) {
    LineDecoder d;
    EXPECT_EQ(decode(d, "\n", true),
              std::vector<std::string>{"-> wakes the party line, or the end of a line that began before the recording"});
    EXPECT_EQ(decode(d, "\n", true), std::vector<std::string>{"-> wakes the party line"});
    EXPECT_EQ(decode(d, "aPR P\x8D\n", true), std::vector<std::string>{"-> to a: PR P [checksum 8D good]"});
    EXPECT_EQ(decode(d, "aPR P\x8C\n", true), std::vector<std::string>{"-> to a: PR P [checksum 8C wrong]"});
    EXPECT_EQ(decode(d, "*SL 0\n", true), std::vector<std::string>{"-> to all: SL 0"});
    EXPECT_EQ(decode(d, "b\x1B", true), std::vector<std::string>{"-> ESC: stop at once for b"});
    EXPECT_EQ(decode(d, "\x06", false), std::vector<std::string>{"<- ACK"});
    EXPECT_EQ(decode(d, "\r\n42\r\n>", false), (std::vector<std::string>{"<- 42", "<- prompt"}));
    EXPECT_TRUE(decode(d, "ha", false).empty());
    EXPECT_EQ(d.finish(), std::vector<std::string>{"<- ha  (not ended)"});
}

// A bounded recording gives the last runs: it begins anywhere in a line, and a line of text does not tell whether it is whole.
TEST(Decoder, TheFirstLineOfARecordingCutAnywhereIsNotTakenForAWholeOne) {
    const std::string doubt = "  (first in the recording: perhaps only the end of a line)";
    struct Row {
        std::string bytes;
        bool down;
        std::string line;
        bool proved;  ///< by its checksum
    };
    const Row rows[] = {{"VM 100\r", true, "-> VM 100", false},
                        {"aPR P\x8D\n", true, "-> to a: PR P [checksum 8D good]", true},
                        {"aVM 5\n", true, "-> to a: VM 5", false},
                        {"-1280\r\n", false, "<- -1280", false}};
    for (const Row& r : rows) {
        for (std::size_t cut = 0; cut < r.bytes.size(); ++cut) {
            SCOPED_TRACE(r.line + " " + std::to_string(cut));
            LineDecoder d;
            const auto first = decode(d, std::string_view(r.bytes).substr(cut), r.down);
            if (first.empty()) {
                EXPECT_GE(cut + 2, r.bytes.size()) << "CR and LF alone are no line";
            } else {
                ASSERT_EQ(first.size(), 1u);
                EXPECT_EQ(first[0].find("unknown"), std::string::npos) << first[0];
                const bool reported =
                    first[0].ends_with(doubt) || first[0].find("the end of a line that began before") != std::string::npos;
                EXPECT_EQ(reported, cut != 0 || !r.proved) << first[0];
                if (cut == 0) EXPECT_EQ(first[0], r.line + (r.proved ? "" : doubt));
            }
            EXPECT_EQ(decode(d, r.bytes, r.down), std::vector<std::string>{r.line}) << "the second one began in the recording";
        }
    }
    LineDecoder d;
    EXPECT_EQ(decode(d, "\r\n42\r\n", false), std::vector<std::string>{"<- 42"}) << "it followed the end of another";
    LineDecoder both;
    EXPECT_TRUE(decode(both, "128", false).empty());
    EXPECT_EQ(both.finish(), std::vector<std::string>{"<- 128  (not ended)" + doubt});
}

}  // namespace
}  // namespace axisgate::mcode
