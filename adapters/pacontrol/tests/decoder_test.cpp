// The decoder: one line per frame or poll; checks are verified and said; what is no frame is said to be unknown.
#include "adapters/pacontrol/decoder.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace axisgate::pacontrol
