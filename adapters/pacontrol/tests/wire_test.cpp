// The wire: every byte-exact frame of the manual's chapter 3.4, as printed and as repaired; checks, numbers, and what is no frame.
#include "adapters/pacontrol/wire.hpp"

#include <gtest/gtest.h>

#include "adapters/pacontrol/wire_commands.hpp"
#include "adapters/pacontrol/wire_number.hpp"

namespace axisgate::pacontrol {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Codes = std::initializer_list<std::uint16_t>;

Bytes bytes_of(std::string_view hex) {
    Bytes b;
    for (std::size_t i = 0; i + 1 < hex.size(); i += 3)
        b.push_back(static_cast<std::uint8_t>(std::stoi(std::string(hex.substr(i, 2)), nullptr, 16)));
    return b;
}

struct Seen {
    std::vector<std::pair<std::string, std::string>> frames;
    std::vector<FrameFault> faults;
    int polls = 0;
    std::size_t dropped = 0;
};
Seen read(const Bytes& bytes, std::size_t piece = 1000) {
    Seen s;
    Framer f;
    const Framer::Sink sink{[&](std::string_view t, std::string_view c) { s.frames.emplace_back(t, c); }, [&] { ++s.polls; },
                            [&](FrameFault x, std::span<const std::uint8_t> d) {
                                s.faults.push_back(x);
                                s.dropped += d.size();
                            }};
    for (std::size_t i = 0; i < bytes.size(); i += piece)
        f.push(std::span(bytes).subspan(i, std::min(piece, bytes.size() - i)), sink);
    return s;
}

struct Row {
    const char* line;
    const char* hex;
    const char* text;
    CheckForm rule;
    std::optional<CheckForm> found;  ///< what the tolerant reader finds; nothing: the printed check fits nothing
};

constexpr auto T = CheckForm::text, E = CheckForm::with_etx;

TEST(PacontrolWire, EveryPrintedFrameIsCutAndItsCheckIsNamed) {
    const Row rows[] = {
        {"L1220", "01 02 30 39 30 36 3B 35 3B 30 3B 31 32 33 34 35 03 37 04", "0906;5;0;12345", T, {}},
        {"L1241", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 32 33 34 35 03 35 37 04", "0;1;1;0;0;12345", E, E},
        {"L1265", "01 02 31 39 30 30 3B 35 3B 30 3B 30 03 36 04", "1900;5;0;0", T, T},
        {"L1273", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 03 35 37 04", "0;1;1;0;0;1", E, E},
        {"L1295", "01 02 31 39 36 30 3B 32 3B 30 3B 30 03 36 04", "1960;2;0;0", T, {}},
        {"L1303", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 32 32 32 03 35 38 04", "0;1;1;0;0;222", E, E},
        {"L1325", "01 02 30 39 30 36 3B 33 3B 30 3B 33 33 33 03 34 04", "0906;3;0;333", T, T},
        {"L1333", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 33 33 33 03 35 39 04", "0;1;1;0;0;333", E, E},
        {"L1355", "01 02 31 39 37 31 3B 33 3B 30 3B 30 03 36 04", "1971;3;0;0", T, T},
        {"L1368", "01 02 30 3B 31 3B 31 3B 30 3B 31 3B 36 34 30 2E 30 30 30 30 03 32 31 04", "0;1;1;0;1;640.0000", E, E},
        {"L1402", "01 02 30 41 30 33 3B 30 3B 30 3B 30 03 31 34 04", "0A03;0;0;0", T, {}},
        {"L1410", "01 02 30 3B 31 3B 33 31 3B 30 3B 30 3B 30 03 38 04", "0;1;31;0;0;0", E, T},
        {"L1436", "01 02 30 41 38 37 3B 32 3B 31 3B 35 35 35 32 2E 30 03 31 34 04", "0A87;2;1;5552.0", T, {}},
        {"L1447", "01 02 30 3B 30 3B 33 31 3B 30 3B 31 3B 31 32 35 35 2E 30 30 30 03 33 38 04", "0;0;31;0;1;1255.000", E, E},
        {"L1462", "01 02 30 3B 30 3B 33 31 3B 30 3B 31 3B 31 35 31 36 2E 39 35 30 03 34 32 04", "0;0;31;0;1;1516.950", E, E},
        {"L1477", "01 02 30 3B 30 3B 33 31 3B 30 3B 31 3B 32 36 33 34 2E 37 35 30 03 33 36 04", "0;0;31;0;1;2634.750", E, E},
        {"L1492", "01 02 30 3B 31 3B 33 31 3B 30 3B 31 3B 35 35 35 32 2E 30 30 30 03 33 35 04", "0;1;31;0;1;5552.000", E, E},
    };
    for (const Row& r : rows) {
        SCOPED_TRACE(r.line);
        for (const std::size_t piece : {std::size_t{1}, std::size_t{7}, std::size_t{1000}}) {
            const Seen s = read(bytes_of(r.hex), piece);
            ASSERT_EQ(s.frames.size(), 1u);
            EXPECT_TRUE(s.faults.empty());
            EXPECT_EQ(s.polls, 0) << "the EOT that ends a frame is no poll";
            EXPECT_EQ(s.frames[0].first, r.text);
            EXPECT_EQ(form_of_check(s.frames[0].first, s.frames[0].second, r.rule), r.found);
        }
        std::string fault;
        EXPECT_TRUE(r.rule == T ? request_of(r.text, fault).has_value() : reply_of(r.text, fault).has_value()) << fault;
        if (r.found == r.rule) {
            EXPECT_EQ(framed(r.text, r.rule), bytes_of(r.hex)) << "what is right is built byte for byte";
        }
    }
}

TEST(PacontrolWire, TheRepairedRequestsHaveTheirChecks) {
    struct Repaired {
        const char* text;
        int check;
    };
    for (const auto& r : {Repaired{"0906;5;0;12345", 0}, Repaired{"1906;2;0;0", 7}, Repaired{"1907;1;1;0", 4}, Repaired{"0603;0;0;0", 14},
                          Repaired{"0A87;2;1;5552.0", 95}, Repaired{"1900;5;0;0", 6}, Repaired{"0906;3;0;333", 4}}) {
        int sum = 0;
        for (const char* c = r.text; *c; ++c)
            sum ^= *c;
        EXPECT_EQ(sum, r.check) << r.text;
        EXPECT_EQ(check_of(r.text, T), r.check) << r.text;
        EXPECT_EQ(check_of(r.text, E), r.check ^ 3) << r.text;
        const Bytes b = framed(r.text, T);
        EXPECT_EQ(std::string(b.begin() + static_cast<std::ptrdiff_t>(std::string_view(r.text).size()) + 3, b.end() - 1),
                  std::to_string(r.check));
    }
    EXPECT_EQ(framed("0;1;1;0;0;1", E), bytes_of("01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 03 35 37 04"));
    EXPECT_EQ(framed("1900;5;0;0", CheckForm::zero), bytes_of("01 02 31 39 30 30 3B 35 3B 30 3B 30 03 30 04"));
    EXPECT_EQ(framed("0;1;31;0;0;0", E).at(16), '1') << "L1410 repaired: 11, not 8";
}

TEST(PacontrolWire, ChecksAreDecimalWithoutPaddingAndZeroIsLegal) {
    EXPECT_EQ(form_of_check("1900;5;0;0", "6", T), T);
    EXPECT_EQ(form_of_check("1900;5;0;0", "5", T), E);
    EXPECT_EQ(form_of_check("1900;5;0;0", "0", T), CheckForm::zero);
    EXPECT_EQ(form_of_check("0906;5;0;12345", "0", T), T) << "a natural 0 counts as computed";
    for (const char* bad : {"", "7", "256", "1000", "6x", "-6", "0x6"})
        EXPECT_EQ(form_of_check("1900;5;0;0", bad, T), std::nullopt) << bad;
    EXPECT_EQ(check_mode_named("learn"), CheckMode::learn);
    EXPECT_EQ(check_mode_named("xor"), std::nullopt);
}

TEST(PacontrolWire, RequestsAndRepliesAreReadAsTheyWereWritten) {
    std::string fault;
    const Request q{0x0A87, 2, true, "5552.0"};
    EXPECT_EQ(text_of(q), "0A87;2;1;5552.0");
    EXPECT_EQ(request_of("0A87;2;1;5552.0", fault), q);
    EXPECT_EQ(request_of("0906;0543;0;-7", fault), (Request{0x0906, 543, false, "-7"})) << "leading zeros occur [L2309]";
    const Reply p{41, false, 39, 529, true, "-12.5"};
    EXPECT_EQ(reply_of(text_of(p), fault), p);
    for (const char* bad :
         {"", "1900", "1900;5;0", "1900;5;0;", "1900;5;0;0;0", "190;5;0;0", "19G0;5;0;0", "1900;x;0;0", "1900;5;2;0", "1900;5;0;1e3"}) {
        fault.clear();
        EXPECT_FALSE(request_of(bad, fault)) << bad;
        EXPECT_FALSE(fault.empty()) << bad;
    }
    for (const char* bad :
         {"0;1;1;0;0", "0;2;1;0;0;1", "0;1;256;0;0;1", "0;1;1;70000;0;1", "0;1;1;0;7;1", "x;1;1;0;0;1", "0;1;1;0;0;nan", "0;1;1;0;0;1;1"}) {
        fault.clear();
        EXPECT_FALSE(reply_of(bad, fault)) << bad;
        EXPECT_FALSE(fault.empty()) << bad;
    }
}

TEST(PacontrolWire, WhatIsNoFrameIsNamedAndTheNextFrameIsFound) {
    const Bytes good = framed("0;1;1;0;0;1", E);
    struct Bad {
        Bytes bytes;
        FrameFault fault;
    };
    const auto cat = [](Bytes a, const Bytes& b) {
        a.insert(a.end(), b.begin(), b.end());
        return a;
    };
    const std::string text = "0;1;1;0;0;1";
    Bytes half(good.begin(), good.begin() + 7), no_eot(good.begin(), good.end() - 1), eight = good;
    eight[5] |= 0x80;
    for (const auto& [b, fault] :
         {Bad{{'x'}, FrameFault::stray}, Bad{half, FrameFault::restarted}, Bad{no_eot, FrameFault::no_eot},
          Bad{{SOH, 'x'}, FrameFault::no_stx}, Bad{cat(half, {EOT}), FrameFault::no_etx}, Bad{eight, FrameFault::eight_bits},
          Bad{cat(half, {0x11}), FrameFault::not_text}, Bad{{SOH, STX, '1', ETX, '1', '2', '3', '4'}, FrameFault::no_eot},
          Bad{cat({SOH, STX}, Bytes(130, '1')), FrameFault::too_long}}) {
        SCOPED_TRACE(std::string(name_of(fault)));
        const Seen s = read(cat(b, good));
        ASSERT_EQ(s.frames.size(), 1u);
        EXPECT_EQ(s.frames[0].first, text);
        ASSERT_FALSE(s.faults.empty());
        EXPECT_EQ(s.faults[0], fault);
    }
    EXPECT_EQ(read({EOT, EOT}).polls, 2);
    EXPECT_EQ(read(cat(good, {EOT})).polls, 1);
}

TEST(PacontrolNumber, RealsAndAxisUnits) {
    EXPECT_EQ(axis_text(5552000), "5552.0");
    EXPECT_EQ(axis_text(-1), "-0.001");
    EXPECT_EQ(axis_text(1250), "1.25");
    EXPECT_EQ(axis_text(0), "0.0");
    EXPECT_EQ(axis_text(-2147483647), "-2147483.647");
    EXPECT_EQ(increments_of(12.345), 12345) << "12345 is 12.345 [L601]";
    EXPECT_EQ(increments_of(25.045), 25045);
    EXPECT_EQ(increments_of(-0.0005), -1) << "half away from zero";
    EXPECT_EQ(increments_of(1e12), 2147483647);
    EXPECT_EQ(increments_of(-1e12), -2147483648LL);
    EXPECT_EQ(real_text(200), "200.0");
    EXPECT_EQ(real_text(0.1), "0.1");
    EXPECT_EQ(real_text(-0.25), "-0.25");
    EXPECT_EQ(real_text(1e10), "10000000000.0");
    EXPECT_EQ(real_text(1e-7), "0.0000001");
    for (const char* same : {"640.0", "640.0000", "640", "+640.00"})
        EXPECT_EQ(real_of(same), 640.0) << same;
    for (const char* bad : {"", "1e3", "inf", "nan", "1,5", "1.5 ", "--1"})
        EXPECT_EQ(real_of(bad), std::nullopt) << bad;
    EXPECT_EQ(integer_of("-2147483647"), -2147483647);
    EXPECT_EQ(integer_of("2147483648"), std::nullopt);
    EXPECT_EQ(integer_of("1.0"), std::nullopt);
}

TEST(PacontrolCommands, SixtySixCodesWithTheirGates) {
    EXPECT_EQ(all_commands().size(), 66u);
    for (const auto& c : all_commands()) {
        EXPECT_EQ(command_info(c.code), &c);
        EXPECT_EQ(command_named(c.name), &c);
        EXPECT_TRUE(c.name.starts_with("cmd_"));
    }
    for (const std::uint16_t late : Codes{0x0A96, 0x0A97, 0x0A98, 0x0A9A, 0x190E, 0x1934, 0x1935, 0x1937})
        EXPECT_NE(command_info(late), nullptr) << "missing or misnumbered in the manual's overview";
    for (const std::uint16_t home : Codes{0x0700, 0x0800, 0x1700, 0x1800, 0x0909})
        EXPECT_TRUE(command_info(home)->home_only);
    for (const std::uint16_t once : Codes{0x0A94, 0x0A95, 0x0A84, 0x0A87, 0x0A90, 0x0602, 0x0603})
        EXPECT_FALSE(command_info(once)->repeatable);
    EXPECT_EQ(command_named("0A83"), command_info(0x0A83));
    EXPECT_EQ(command_named("put_no_reference"), command_info(0x0A83));
    EXPECT_EQ(command_named("nothing"), nullptr);
}

TEST(PacontrolCommands, ErrorsAndStatusesInTheManualsWords) {
    EXPECT_EQ(describe_quit(44), "command error 44 (2Ch): external stop not defined");
    EXPECT_EQ(quit_text(0), "no error");
    EXPECT_EQ(quit_text(255), "AS-i master error");
    EXPECT_NE(quit_text(1).find("does not name"), std::string::npos);
    EXPECT_EQ(status_text(31), "31 (ONLINE)");
    EXPECT_EQ(status_text(9), "9 (home position with system error)");
    for (const int blank : {4, 8, 14, 21, 29, 33, 34, 36, 38})
        EXPECT_NE(status_text(blank).find("no meaning"), std::string::npos);
    EXPECT_EQ(describe(Request{0x1800, 774, true, "0"}), "1800 cmd_get_axis_parameter axis 3 parameter 6");
    EXPECT_EQ(describe(Request{0x0A87, 2, true, "5552.0"}), "0A87 cmd_pos_axis_absolut axis 2 = 5552.0");
}

TEST(PacontrolErrata, E38_E39_TheNumbersOfCommandErrorsAsRepaired) {
    const std::vector<std::pair<std::uint16_t, const char*>> rows{{30, "erase"},    {37, "flag"},          {46, "not ready"},
                                                                  {47, "servoTEC"}, {107, "acceleration"}, {109, "31 bits"}};
    for (const auto& [number, word] : rows)
        EXPECT_NE(describe_quit(number).find(word), std::string::npos) << describe_quit(number);
}

TEST(PacontrolErrata, E24_StatusesAreTheUnionOfTheLists) {
    for (const int s : {0, 1, 2, 3, 9, 10, 11, 12, 13, 15, 16, 17, 18, 19, 20, 30, 31, 32, 35, 37, 39})
        EXPECT_EQ(status_text(s).find("no meaning given"), std::string::npos) << s;
    EXPECT_NE(status_text(14).find("no meaning given"), std::string::npos);
}

}  // namespace
}  // namespace axisgate::pacontrol
