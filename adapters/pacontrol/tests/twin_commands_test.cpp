// Twin, commands: elements by their numbers and words, parameters, system views, order of the checks.
// In: commands. Out: acknowledgements on the wire.
#include <set>

#include "adapters/pacontrol/tests/twin_bench.hpp"
#include "adapters/pacontrol/twin/commands.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

// T-24: no command of the manual is unknown.
TEST(TwinCommands, AllAreKnown) {
    for (const char* code : {"0600", "0602", "0603", "0700", "1700", "1701", "1702", "0800", "1800", "1801", "1802", "1900", "1901", "0902",
                             "1902", "0903", "1903", "0904", "1904", "0905", "1905", "0906", "1906", "0907", "1907", "0909", "1909", "190B",
                             "190C", "190D", "190E", "190F", "1910", "1911", "1913", "1914", "1915", "1920", "1921", "1934", "1935", "1937",
                             "0A41", "0A81", "0A83", "0A84", "0A85", "0A86", "0A87", "0A89", "0A8D", "0A8E", "0A90", "0A91", "0A92", "0A93",
                             "0A94", "0A95", "0A96", "0A97", "0A98", "0A9A", "0AA0", "0AA1", "0AA2", "0AA3"}) {
        Bench b;
        EXPECT_NE(b.quit(std::string(code) + ";1;0;0"), 19) << code;
    }
    Bench b;
    for (const char* code : {"0000", "0601", "0A82", "0934", "0A99", "1938", "FFFF"})
        EXPECT_EQ(b.quit(std::string(code) + ";1;0;0"), 19) << code;
}

// T-09, T-10: a word is named by any element in it, and is replaced as a whole.
TEST(TwinCommands, Words) {
    Bench b;
    for (const int n : {1, 2, 9, 11, 12, 16})
        b.hand("I" + std::to_string(n), true);
    b.good("0700;4;0;0");  // the stop input reads as powered otherwise
    EXPECT_EQ(b.value("1901;10;0;0"), 0x8D03);
    EXPECT_EQ(b.value("1901;16;0;0"), 0x8D03);
    EXPECT_EQ(b.value("1901;1;0;0"), 0x8D03);
    EXPECT_EQ(b.value("1901;17;0;0"), 0);
    EXPECT_EQ(b.value("0903;25;0;15889"), 0x3E11);
    for (int n = 1; n <= 48; ++n) {
        const bool on = n == 17 || n == 21 || (n >= 26 && n <= 30);
        EXPECT_EQ(b.value("1902;" + std::to_string(n) + ";0;0"), on ? 1 : 0) << n;
    }
    b.good("0905;17;0;17906");
    for (int n = 1; n <= 48; ++n) {
        const bool on = n == 18 || (n >= 21 && n <= 25) || n == 27 || n == 31;
        EXPECT_EQ(b.value("1904;" + std::to_string(n) + ";0;0"), on ? 1 : 0) << n;
    }
    b.good("0905;32;0;0");
    EXPECT_EQ(b.value("1905;20;0;0"), 0) << "replaced, not added";
    EXPECT_EQ(b.quit("0905;1;0;65536"), 41);
    EXPECT_EQ(b.quit("0903;1;0;-1"), 41);
}

TEST(TwinCommands, NumbersOfElements) {
    struct Case {
        const char* code;
        int quit;
        int least, largest;
    };
    for (const Case& c : {Case{"1900", 35, 1, 1024},    Case{"1901", 35, 1, 1024}, Case{"0902", 36, 1, 1024}, Case{"1902", 36, 1, 1024},
                          Case{"0903", 36, 1, 1024},    Case{"1903", 36, 1, 1024}, Case{"0904", 37, 1, 1024}, Case{"1904", 37, 1, 1024},
                          Case{"0905", 37, 1, 1024},    Case{"1905", 37, 1, 1024}, Case{"0906", 38, 1, 1024}, Case{"1906", 38, 1, 1024},
                          Case{"0907", 39, 1, 1024},    Case{"1907", 39, 1, 1024}, Case{"190C", 32, 1, 4},    Case{"190D", 32, 1, 4},
                          Case{"190E", 32, 1, 4},       Case{"190F", 32, 1, 4},    Case{"1910", 32, 1, 4},    Case{"1913", 32, 1, 4},
                          Case{"1914", 32, 1, 4},       Case{"1915", 32, 1, 4},    Case{"1920", 32, 1, 4},    Case{"1921", 32, 1, 4},
                          Case{"1700", 34, 1, 20},      Case{"1701", 34, 1, 20},   Case{"1702", 34, 1, 20},   Case{"1800", 33, 257, 306},
                          Case{"1801", 33, 1025, 1074}, Case{"1802", 33, 513, 562}}) {
        Bench b;
        const auto quit = [&](int n) { return b.quit(std::string(c.code) + ";" + std::to_string(n) + ";0;0"); };
        EXPECT_EQ(quit(c.least), 0) << c.code;
        EXPECT_EQ(quit(c.largest), 0) << c.code;
        EXPECT_EQ(quit(c.least - 1), c.quit) << c.code;
        EXPECT_EQ(quit(c.largest + 1), c.quit) << c.code;
    }
    Bench b;
    EXPECT_EQ(b.quit("1800;1281;1;0"), 32) << "axis 5 of four";
    EXPECT_EQ(b.quit("0902;1;0;2"), 41);
    EXPECT_EQ(b.quit("1900;-5;0;0"), 35);
    EXPECT_EQ(b.quit("1900;99999999999;0;0"), 35);
}

TEST(TwinCommands, SixteenAxes) {
    Bench b(setup(16));
    b.online();
    for (int n = 1; n <= 16; ++n)
        b.good("0A94;" + std::to_string(n) + ";1;" + std::to_string(100 + n));
    EXPECT_EQ(b.value("1911;0;0;0"), 65535);
    b.pass(5s);
    for (int n = 1; n <= 16; ++n)
        EXPECT_EQ(b.position(n), 100 + n);
    EXPECT_EQ(b.quit("190C;17;1;0"), 32);
    b.home();
    b.good("0700;2;0;3");
    EXPECT_EQ(b.quit("190C;4;1;0"), 32) << "the number of axes is a parameter";
    EXPECT_EQ(b.quit("0700;2;0;17"), 41);
}

TEST(TwinCommands, SystemParameters) {
    Bench b;
    EXPECT_EQ(b.value("1701;2;0;0"), 4);
    EXPECT_EQ(b.value("1702;2;0;0"), 0);
    b.good("0700;1;0;3");
    EXPECT_EQ(b.ask("1700;1;0;0"), "0;1;1;0;0;3");
    for (int n = 1; n <= 20; ++n) {
        const std::string p = ";" + std::to_string(n) + ";0;";
        const double largest = b.value("1701" + p + "0");
        EXPECT_LT(b.value("1702" + p + "0"), largest);
        if (n != 2) EXPECT_EQ(b.quit("0700" + p + std::to_string(static_cast<long long>(largest))), 0) << n;
        if (largest < 2147483647) EXPECT_EQ(b.quit("0700" + p + std::to_string(static_cast<long long>(largest) + 1)), 41) << n;
    }
    EXPECT_EQ(b.quit("0700;17;0;1"), 41) << "Profibus address 1 is the master's";
    ControlSetup s;
    s.profibus_switches = true;
    Control c(s);
    EXPECT_EQ(c.settings().set_system(0x11, Datum::integer(5)), 57);
}

// T-13: all axis parameters are reals, addressed by one number.
TEST(TwinCommands, AxisParameters) {
    Bench b;
    EXPECT_EQ(b.ask("0800;774;1;200.00"), "0;1;1;0;1;200.0000");
    EXPECT_EQ(b.ask("1800;774;1;0"), "0;1;1;0;1;200.0000");
    EXPECT_EQ(b.ask("1800;262;1;0"), "0;1;1;0;1;1000.000") << "axis 1 has its own";
    EXPECT_EQ(b.ask("1800;543;1;0"), "0;1;1;0;1;0.000000");
    for (int n = 1; n <= 50; ++n) {
        const std::string p = ";" + std::to_string(256 + n) + ";1;";
        const Fields least = b.get("1802" + p + "0");
        const Fields largest = b.get("1801" + p + "0");
        const Fields is = b.get("1800" + p + "0");
        EXPECT_EQ(is.type, 1);
        EXPECT_LE(least.data, is.data) << n;
        EXPECT_LE(is.data, largest.data) << n;
        EXPECT_EQ(b.quit("0800" + p + std::to_string(largest.data * 2 + 1)), 41) << n;
    }
}

TEST(TwinCommands, Sixtysix) {
    std::set<int> codes;
    for (const CommandRow& r : command_rows()) {
        codes.insert(r.code);
        EXPECT_TRUE(r.name.starts_with("cmd_")) << r.code;
        EXPECT_NE(r.run, nullptr);
    }
    EXPECT_EQ(codes.size(), 66u);
}

TEST(TwinCommands, SystemViews) {
    Bench b;
    b.hand("inject_error", std::int64_t{510});
    EXPECT_EQ(b.value("1935;10;0;0"), 510);
    b.hand("inject_error", std::int64_t{0});
    b.online();
    b.good("0A94;2;1;700");
    b.pass(100ms);
    EXPECT_EQ(b.value("1934;52;0;0"), 1) << "referenced";
    EXPECT_EQ(b.value("1934;92;0;0"), 1) << "active";
    EXPECT_EQ(b.value("1934;91;0;0"), 0);
    EXPECT_EQ(b.value("1935;72;0;0"), 1) << "status";
    EXPECT_EQ(b.value("1937;72;1;0"), 700) << "target";
    b.hand("axis2.inject_error", std::int64_t{777});
    EXPECT_EQ(b.value("1934;232;0;0"), 1) << "fault";
    EXPECT_EQ(b.value("1934;66;0;0"), 0) << "an axis that is not built";
    EXPECT_EQ(b.quit("1934;1;0;0"), 37);
    EXPECT_EQ(b.quit("1934;247;0;0"), 37);
    EXPECT_EQ(b.quit("1935;11;0;0"), 38);
    EXPECT_EQ(b.quit("1937;87;0;0"), 39);
}

TEST(TwinCommands, ReadinessAndMalfunctionOutputs) {
    Bench b;
    b.good("0700;6;0;40");
    b.good("0700;7;0;41");
    EXPECT_EQ(b.value("1903;40;0;0"), 0x80) << "output 40 is bit 7 of its word";
    b.hand("inject_error", std::int64_t{510});
    EXPECT_EQ(b.value("1902;40;0;0"), 0);
    EXPECT_EQ(b.value("1902;41;0;0"), 1);
}

// Order of checks: frame, code, mode, parameter, value, state.
TEST(TwinCommands, Precedence) {
    Bench b(setup(1, {{"absolute", "off"}}));
    EXPECT_EQ(Bench::fields(b.one(b.bytes(frame("9999;9;0;0", "1")), "check first")).quit, 16);
    EXPECT_EQ(b.quit("9999;9;0;0"), 19);
    EXPECT_EQ(b.quit("0A94;9;1;99999"), 20);
    b.online();
    EXPECT_EQ(b.quit("0A94;9;1;99999"), 32);
    EXPECT_EQ(b.quit("0A94;1;1;99999"), 65);
    EXPECT_EQ(b.quit("0A94;1;1;9999"), 43);
    b.good("0A83;1;0;0");
    b.good("0A94;1;1;9999");
    EXPECT_EQ(b.quit("0A94;1;1;99999"), 65);
    EXPECT_EQ(b.quit("0A94;1;1;9999"), 42);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
