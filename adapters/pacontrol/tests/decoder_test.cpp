// The decoder: one line per frame or poll; checks are verified and said; what is no frame is said to be unknown.
#include "adapters/pacontrol/decoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace axisgate::pacontrol {
namespace {

std::vector<std::string> decode(LineDecoder& d, const std::vector<std::uint8_t>& b, std::optional<bool> to_drive = {}) {
    return d.on_frame(Frame::run(b), to_drive);
}

TEST(PacontrolDecoder, RequestsAndReplies) {
    LineDecoder d;
    EXPECT_EQ(decode(d, framed("1900;5;0;0", CheckForm::text), true),
              std::vector<std::string>{"SOH STX 1900;5;0;0 ETX 6 EOT  to the control  1900 cmd_get_single_input 5 [check 6 good]"});
    EXPECT_EQ(decode(d, framed("0;1;1;0;0;1", CheckForm::with_etx), false),
              std::vector<std::string>{
                  "SOH STX 0;1;1;0;0;1 ETX 57 EOT  from the control  done, 1; operating status 1 (home position) [check 57 good]"});
    EXPECT_EQ(decode(d, {EOT}, true), std::vector<std::string>{"EOT  to the control  poll: asks for another acknowledgement"});
    const auto busy = decode(d, framed("0;0;31;0;1;1255.000", CheckForm::with_etx), false).at(0);
    EXPECT_NE(busy.find("being processed, 1255.000; operating status 31 (ONLINE)"), std::string::npos) << busy;
    const auto error = decode(d, framed("64;1;39;529;0;0", CheckForm::with_etx), false).at(0);
    EXPECT_NE(error.find("command error 64 (40h): limit switch actuated"), std::string::npos) << error;
    EXPECT_NE(error.find("PA-CONTROL error E529"), std::string::npos) << error;
}

TEST(PacontrolDecoder, ChecksAreVerifiedAndSaid) {
    LineDecoder d;
    const auto with = [&](std::string_view text, CheckForm f, bool down) { return decode(d, framed(text, f), down).at(0); };
    EXPECT_NE(with("1900;5;0;0", CheckForm::with_etx, true).find("check 5 as for the other direction, 6 would be right"),
              std::string::npos);
    EXPECT_NE(with("0;1;31;0;0;0", CheckForm::text, false).find("check 8 as for the other direction, 11 would be right"), std::string::npos)
        << "the frame that the manual prints so [L1410]";
    EXPECT_NE(with("1900;5;0;0", CheckForm::zero, true).find("check 0, not used"), std::string::npos);
    auto bad = framed("1900;5;0;0", CheckForm::text);
    bad[bad.size() - 2] = '7';
    EXPECT_NE(decode(d, bad, true).at(0).find("check 7 wrong, 6 would be right"), std::string::npos);
}

TEST(PacontrolDecoder, FramesThatTheManualPrintsWronglyAreReadAndNamed) {
    struct Row {
        const char* line;
        const char* text;
        const char* check;
        bool to_drive;
        const char* named;
    };
    const Row rows[] = {
        {"L1220", "0906;5;0;12345", "7", true, "check 7 wrong, 0 would be right"},
        {"L1295", "1960;2;0;0", "6", true, "unknown command"},
        {"L1355", "1971;3;0;0", "6", true, "unknown command"},
        {"L1402", "0A03;0;0;0", "14", true, "unknown command"},
        {"L1410", "0;1;31;0;0;0", "8", false, "check 8 as for the other direction, 11 would be right"},
        {"L1436", "0A87;2;1;5552.0", "14", true, "check 14 wrong, 95 would be right"},
    };
    for (const Row& r : rows) {
        SCOPED_TRACE(r.line);
        LineDecoder d;
        std::vector<std::uint8_t> bytes{SOH, STX};
        for (const char* c = r.text; *c; ++c)
            bytes.push_back(static_cast<std::uint8_t>(*c));
        bytes.push_back(ETX);
        for (const char* c = r.check; *c; ++c)
            bytes.push_back(static_cast<std::uint8_t>(*c));
        bytes.push_back(EOT);
        const auto lines = decode(d, bytes, r.to_drive);
        ASSERT_EQ(lines.size(), 1u);
        EXPECT_NE(lines[0].find(r.text), std::string::npos) << lines[0];
        EXPECT_NE(lines[0].find(r.named), std::string::npos) << lines[0];
    }
}

TEST(PacontrolDecoder, UnknownDirectionIsInferredAndSaid) {
    LineDecoder d;
    EXPECT_NE(decode(d, framed("0906;5;0;12345", CheckForm::text)).at(0).find("cmd_put_int_reg 5 = 12345 (direction not known)"),
              std::string::npos);
    EXPECT_NE(decode(d, framed("0;1;1;0;0;12345", CheckForm::with_etx)).at(0).find("from the control"), std::string::npos);
}

TEST(PacontrolDecoder, WhatIsNoFrameIsUnknown) {
    LineDecoder d;
    const auto half = std::vector<std::uint8_t>{SOH, STX, '1', '9'};
    EXPECT_TRUE(decode(d, half, true).empty());
    const auto lines = decode(d, framed("1900;5;0;0", CheckForm::text), true);
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0], "01 02 31 39  unknown: a frame inside a frame: SOH before EOT");
    EXPECT_NE(lines[1].find("cmd_get_single_input"), std::string::npos);
    EXPECT_EQ(decode(d, {'a', 'b', SOH}, false).size(), 0u);
    EXPECT_EQ(d.finish().size(), 2u) << "the strange bytes, and the frame that does not end";
    EXPECT_NE(decode(d, framed("FFFF;0;0;0", CheckForm::text), true).at(0).find("unknown command"), std::string::npos);
    EXPECT_NE(decode(d, framed("hello", CheckForm::text), true).at(0).find("unknown"), std::string::npos);
    EXPECT_NE(decode(d, {EOT}, false).at(0).find("unknown"), std::string::npos);
    EXPECT_NE(d.on_frame(Frame::can_extended(1, {}), true).at(0).find("unknown"), std::string::npos);
    std::size_t n = 0;
    for (int i = 0; i < 1000; ++i)
        n += decode(d, {'x'}, true).size();
    EXPECT_GE(n, 15u) << "strange bytes are written out, not gathered";
    EXPECT_LE(d.finish().size(), 1u);
}

struct Byte {
    std::uint8_t byte;
    bool to_drive;
};

/// Two requests with their acknowledgements, and a poll between them.
std::vector<Byte> recording() {
    std::vector<Byte> all;
    const auto add = [&](const std::vector<std::uint8_t>& bytes, bool to_drive) {
        for (const auto b : bytes)
            all.push_back({b, to_drive});
    };
    add(framed("190C;1;0;0", CheckForm::text), true);
    add(framed("0;0;31;0;1;1255.000", CheckForm::with_etx), false);
    add({EOT}, true);
    add(framed("0;1;31;0;1;1255.000", CheckForm::with_etx), false);
    add(framed("1900;5;0;0", CheckForm::text), true);
    add(framed("0;1;31;0;0;1", CheckForm::with_etx), false);
    return all;
}

std::vector<std::string> decoded(std::span<const Byte> bytes) {
    LineDecoder d;
    std::vector<std::string> lines;
    for (const Byte& b : bytes)
        std::ranges::move(decode(d, {b.byte}, b.to_drive), std::back_inserter(lines));
    std::ranges::move(d.finish(), std::back_inserter(lines));
    return lines;
}

bool any_holds(const std::vector<std::string>& lines, std::string_view text) {
    return std::ranges::any_of(lines, [&](const std::string& l) { return l.find(text) != std::string::npos; });
}

// A bounded recording gives the last runs: it begins, and ends, anywhere in a frame.
TEST(PacontrolDecoder, ARecordingCutAtAnyByteIsReadAndNothingOfItIsStrange) {
    const auto all = recording();
    const auto whole = decoded(all);
    ASSERT_EQ(whole.size(), 6u);
    for (std::size_t first = 0; first < all.size(); ++first) {
        for (std::size_t last = first + 1; last <= all.size(); ++last) {
            const auto lines = decoded(std::span(all).subspan(first, last - first));
            ASSERT_FALSE(any_holds(lines, "unknown")) << first << ".." << last << " " << testing::PrintToString(lines);
        }
        // Where the first byte opens a frame nothing is told of one before it; elsewhere one line is, and the frames that are whole follow.
        auto lines = decoded(std::span(all).subspan(first));
        const auto down =
            std::find_if(all.begin() + static_cast<std::ptrdiff_t>(first), all.end(), [](const Byte& b) { return b.to_drive; });
        const std::string either = ", or the end of a frame that began before the recording";
        const bool poll_first = down != all.end() && down->byte == EOT;
        EXPECT_EQ(any_holds(lines, either), poll_first) << first << ": the first byte to the control is an EOT";
        for (std::string& l : lines)
            l = l.substr(0, l.find(either));
        const bool eot_down = all[first].byte == EOT && all[first].to_drive;
        const bool is_poll = eot_down && first > 0 && !all[first - 1].to_drive;
        const std::size_t cut = all[first].byte == SOH || is_poll ? 0 : 1;
        EXPECT_EQ(any_holds(lines, "the end of a frame that began before the recording"), cut == 1 && !eot_down) << first;
        const auto following = std::span(lines).subspan(cut);
        ASSERT_LE(following.size(), whole.size());
        EXPECT_TRUE(std::ranges::equal(following, std::span(whole).last(following.size()))) << first << testing::PrintToString(lines);
    }
}

TEST(PacontrolDecoder, TheEdgesOfARecordingAreNamed) {
    const auto all = recording();
    const auto first_line = [&](std::size_t from) { return decoded(std::span(all).subspan(from)).front(); };
    EXPECT_EQ(first_line(4), "0C;1;0;0 ETX 113 EOT  to the control  the end of a frame that began before the recording");
    const std::size_t reply = framed("190C;1;0;0", CheckForm::text).size();
    EXPECT_EQ(first_line(reply + 1).substr(0, 9), "STX 0;0;3");
    const std::size_t poll = reply + framed("0;0;31;0;1;1255.000", CheckForm::with_etx).size();
    EXPECT_EQ(first_line(poll - 1), "EOT  from the control  the end of a frame that began before the recording");
    EXPECT_EQ(first_line(poll),
              "EOT  to the control  poll: asks for another acknowledgement, or the end of a frame that began before the recording");
    EXPECT_EQ(decoded(std::span(all).first(5)).front(), "SOH STX 190  to the control  a frame that had not ended when the recording did");
    EXPECT_EQ(decoded(std::span(all).subspan(3, 4)).front(),
              "90C;  to the control  bytes of a frame that began before the recording and ended after it");
}

TEST(PacontrolDecoder, OnlyTheFirstBytesOfADirectionCanBeTheEndOfAFrame) {
    const auto strange = [](const std::vector<std::uint8_t>& bytes, bool to_drive) {
        LineDecoder d;
        auto lines = decode(d, bytes, to_drive);
        std::ranges::move(d.finish(), std::back_inserter(lines));
        return any_holds(lines, "unknown");
    };
    EXPECT_TRUE(strange({'a', 'b', EOT}, false)) << "no check digits";
    EXPECT_TRUE(strange({ETX, EOT}, false));
    EXPECT_TRUE(strange({'1', ETX, '1', '2', '3', '4', EOT}, false)) << "four of them";
    EXPECT_TRUE(strange({'1', ETX, '1', '2', 'a', EOT}, false));
    EXPECT_TRUE(strange({0x07, ETX, '1', '2', EOT}, false)) << "a control symbol";
    EXPECT_TRUE(strange({'1', STX, ETX, '1', EOT}, false));
    EXPECT_TRUE(strange({'1', '2', SOH}, false)) << "SOH came before EOT";
    EXPECT_TRUE(strange({EOT, EOT}, false)) << "the second one is no end";
    EXPECT_TRUE(strange({'1', '2', EOT, '1', '2', EOT}, true));
    std::vector<std::uint8_t> longest{STX};
    longest.insert(longest.end(), Framer::text_limit, 'x');
    longest.insert(longest.end(), {ETX, '1', '2', '3', EOT});
    EXPECT_FALSE(strange(longest, false));
    longest.insert(longest.begin() + 1, 'x');
    EXPECT_TRUE(strange(longest, false)) << "no text is so long";
    auto frame = framed("0;1;31;0;0;1", CheckForm::with_etx);
    EXPECT_FALSE(strange(frame, false));
    frame.insert(frame.end(), {'5', '7', EOT});
    EXPECT_TRUE(strange(frame, false)) << "after a frame they are strange";
}

}  // namespace
}  // namespace axisgate::pacontrol
