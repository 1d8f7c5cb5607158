// Twin, the wire: every frame that the manual prints, checks, polls, frames inside frames, numbers as text.
// In: bytes of the manual [L1207-L1501]. Out: the acknowledgements, byte for byte.
#include "adapters/pacontrol/tests/twin_bench.hpp"

namespace axisgate::pacontrol::twin::test {
namespace {

std::string text(const Bytes& b) {
    std::string s;
    for (const std::uint8_t x : b) {
        char two[4];
        std::snprintf(two, sizeof two, "%02X ", x);
        s += two;
    }
    if (!s.empty()) s.pop_back();
    return s;
}

TEST(TwinFrame, Section341WritesN5) {
    Bench b;
    b.bytes(hex("01 02 30 39 30 36 3B 35 3B 30 3B 31 32 33 34 35 03 30 04"));
    ASSERT_EQ(b.raw.size(), 1u);
    EXPECT_EQ(text(b.raw[0]), "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 32 33 34 35 03 35 37 04");
    EXPECT_EQ(b.value("1906;5;0;0"), 12345);
}

TEST(TwinFrame, Section342InOneRun) {
    Bench b;
    b.hand("I5", true);
    b.good("0906;2;0;222");
    b.good("0907;1;1;640.0");
    b.raw.clear();
    const std::vector<std::pair<const char*, const char*>> frames{
        {"01 02 31 39 30 30 3B 35 3B 30 3B 30 03 36 04", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 03 35 37 04"},
        {"01 02 31 39 30 36 3B 32 3B 30 3B 30 03 37 04", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 32 32 32 03 35 38 04"},
        {"01 02 30 39 30 36 3B 33 3B 30 3B 33 33 33 03 34 04", "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 33 33 33 03 35 39 04"},
        {"01 02 31 39 30 37 3B 31 3B 31 3B 30 03 34 04", "01 02 30 3B 31 3B 31 3B 30 3B 31 3B 36 34 30 2E 30 30 30 30 03 32 31 04"}};
    for (const auto& [request, reply] : frames) {
        b.bytes(hex(request));
        EXPECT_EQ(text(b.raw.back()), reply) << request;
    }
    EXPECT_EQ(b.raw.size(), 4u);
}

/// Positions of the polls are those of the print: the bench polls when the axis is there.
TEST(TwinFrame, Section343MovesAxis2) {
    NonVolatile memory{{"axis2.position", 1255.0}, {"axis2.shaft", 1255.0}, {"axis2.parameter.6", 1'000'000.0}};
    Bench b(setup(), memory);
    b.bytes(hex("01 02 30 36 30 33 3B 30 3B 30 3B 30 03 31 34 04"));
    b.pass(10ms);
    ASSERT_EQ(b.raw.size(), 1u);
    EXPECT_EQ(text(b.raw[0]), "01 02 30 3B 31 3B 33 31 3B 30 3B 30 3B 30 03 31 31 04") << "the repaired check, 11 for the printed 8";
    b.bytes(hex("01 02 30 41 38 37 3B 32 3B 31 3B 35 35 35 32 2E 30 03 39 35 04"));
    EXPECT_EQ(text(b.raw.back()), "01 02 30 3B 30 3B 33 31 3B 30 3B 31 3B 31 32 35 35 2E 30 30 30 03 33 38 04");
    // 500 AE/s; 0.125 AE and 0.25 ms go on the ramp.
    const Instant start = b.now;
    const auto at = [&](double x) { return start + Duration{static_cast<std::int64_t>(((x - 1255) / 500 + 0.00025) * 1e9)}; };
    b.pass(at(1516.95) - b.now);
    b.poll();
    EXPECT_EQ(text(b.raw.back()), "01 02 30 3B 30 3B 33 31 3B 30 3B 31 3B 31 35 31 36 2E 39 35 30 03 34 32 04");
    b.pass(at(2634.75) - b.now);
    b.poll();
    EXPECT_EQ(text(b.raw.back()), "01 02 30 3B 30 3B 33 31 3B 30 3B 31 3B 32 36 33 34 2E 37 35 30 03 33 36 04");
    b.pass(20s);
    b.poll();
    EXPECT_EQ(text(b.raw.back()), "01 02 30 3B 31 3B 33 31 3B 30 3B 31 3B 35 35 35 32 2E 30 30 30 03 33 35 04");
}

// T-01, T-02: the request's check is XOR of the text, decimal, or 0; the reply's has the ETX in it.
TEST(TwinFrame, CheckOfTheRequest) {
    const std::vector<std::pair<const char*, int>> cases{{"6", 0},  {"0", 0},   {"06", 0}, {"006", 0},   {"00", 0}, {"7", 16},
                                                         {"5", 16}, {"57", 16}, {"x", 16}, {"0006", 16}, {"-6", 16}};
    for (const auto& [check, quit] : cases) {
        Bench b;
        EXPECT_EQ(Bench::fields(b.one(b.bytes(frame("1900;5;0;0", check)), check)).quit, quit) << check;
    }
    Bench b;
    EXPECT_EQ(Bench::fields(b.one(b.bytes(hex("01 02 31 39 30 30 3B 35 3B 30 3B 30 03 04")), "no check")).quit, 16);
}

TEST(TwinFrame, LenientTakesTheCheckOfTheOtherDirection) {
    Bench strict;
    EXPECT_EQ(Bench::fields(strict.one(strict.bytes(frame("1900;5;0;0", "5")), "5")).quit, 16);
    Bench lenient(setup(1, {{"request_check", "lenient"}}));
    EXPECT_EQ(Bench::fields(lenient.one(lenient.bytes(frame("1900;5;0;0", "5")), "5")).quit, 0);
    EXPECT_EQ(Bench::fields(lenient.one(lenient.bytes(frame("1900;5;0;0", "7")), "7")).quit, 16);
}

TEST(TwinFrame, FormsOfTheReplyCheck) {
    const std::vector<std::pair<const char*, const char*>> forms{{"etx", "35 37 04"}, {"text", "35 38 04"}, {"zero", "30 04"}};
    for (const auto& [form, end] : forms) {
        Bench b(setup(1, {{"reply_check", form}}));
        b.check_replies = false;
        b.hand("I5", true);
        b.bytes(frame("1900;5;0;0"));
        EXPECT_EQ(text(b.raw.back()), "01 02 30 3B 31 3B 31 3B 30 3B 30 3B 31 03 " + std::string(end)) << form;
    }
}

// T-03: one reply per frame, one per lone EOT.
TEST(TwinFrame, PollsAndFramesAreCounted) {
    Bench b;
    EXPECT_EQ(b.bytes(frame("1909;0;0;0")).size(), 1u);
    EXPECT_EQ(b.bytes({4}).size(), 1u);
    EXPECT_EQ(b.bytes({4, 4, 4}).size(), 3u);
    Bytes two = frame("1909;0;0;0");
    two.push_back(4);
    EXPECT_EQ(b.bytes(two).size(), 2u);
}

// E-16: before any command, after one, after an error.
TEST(TwinFrame, PollWithNothingPending) {
    Bench b;
    EXPECT_EQ(b.poll(), "0;1;1;0;0;0");
    b.good("0906;5;0;12345");
    EXPECT_EQ(b.poll(), "0;1;1;0;0;12345");
    b.hand("inject_error", std::int64_t{529});
    EXPECT_EQ(b.poll(), "0;1;9;529;0;12345") << "status and error are fresh";
    b.bytes(frame("1900;5;0;0", "99"));
    EXPECT_EQ(Bench::fields(b.poll()).quit, 16);
}

TEST(TwinFrame, ErrorsOfTheFrame) {
    struct Case {
        const char* bytes;
        int quit;
        const char* why;
    };
    const std::vector<Case> cases{
        {"31 39 30 30 04", 18, "no SOH STX"},
        {"02 31 39 30 30 3B 35 3B 30 3B 30 03 36 04", 18, "no SOH"},
        {"01 31 39 30 30 3B 35 3B 30 3B 30 03 36 04", 18, "no STX"},
        {"01 04", 18, "nothing"},
        {"01 02 31 39 30 30 3B 35 3B 30 3B 30 04", 17, "no ETX"},
        {"01 02 31 39 30 30 02 3B 35 3B 30 3B 30 03 36 04", 17, "STX inside"},
        {"01 02 31 39 30 30 3B 35 3B 30 3B 30 03 36 03 04", 17, "ETX twice"},
        {"01 02 31 39 30 30 3B 35 3B 30 03 30 04", 17, "three fields"},
        {"01 02 31 39 30 30 3B 35 3B 30 3B 30 3B 30 03 30 04", 17, "five fields"},
        {"01 02 31 39 30 30 3B 35 3B 32 3B 30 03 30 04", 17, "type 2"},
        {"01 02 31 39 30 30 3B 35 3B 30 3B 03 30 04", 17, "no data"},
        {"01 02 31 39 30 30 3B 35 3B 30 3B 31 65 35 03 30 04", 17, "1e5"},
        {"01 02 31 B9 30 30 3B 35 3B 30 3B 30 03 30 04", 17, "a byte of 8 bits"},
        {"01 02 58 59 5A 30 3B 35 3B 30 3B 30 03 30 04", 19, "XYZ0"},
        {"01 02 31 39 30 3B 35 3B 30 3B 30 03 30 04", 19, "three digits"},
        {"01 02 30 41 30 33 3B 30 3B 30 3B 30 03 30 04", 19, "0A03, as printed at L1402"},
    };
    for (const Case& c : cases) {
        Bench b;
        EXPECT_EQ(Bench::fields(b.one(b.bytes(hex(c.bytes)), c.why)).quit, c.quit) << c.why;
    }
}

// The printed requests that contradict their own rule (E-04): refused by a strict control, each with its number.
TEST(TwinFrame, PrintedFramesThatAreWrong) {
    const std::vector<std::pair<const char*, int>> printed{
        {"01 02 30 39 30 36 3B 35 3B 30 3B 31 32 33 34 35 03 37 04", 16},        // L1220
        {"01 02 31 39 36 30 3B 32 3B 30 3B 30 03 36 04", 16},                    // L1295
        {"01 02 31 39 37 31 3B 33 3B 30 3B 30 03 36 04", 19},                    // L1355: its check fits its bytes
        {"01 02 30 41 30 33 3B 30 3B 30 3B 30 03 31 34 04", 16},                 // L1402
        {"01 02 30 41 38 37 3B 32 3B 31 3B 35 35 35 32 2E 30 03 31 34 04", 16},  // L1436
    };
    for (const auto& [bytes, quit] : printed) {
        Bench b;
        EXPECT_EQ(Bench::fields(b.one(b.bytes(hex(bytes)), bytes)).quit, quit) << bytes;
    }
}

TEST(TwinFrame, SohBeginsAnewInsideAFrame) {
    Bench b;
    Bytes cut{1, 2, '1', '9'};
    const Bytes whole = frame("0906;5;0;7");
    cut.insert(cut.end(), whole.begin(), whole.end());
    EXPECT_EQ(b.one(b.bytes(cut), "frame in a frame"), "0;1;1;0;0;7");
}

// E-17: half a frame is forgotten after 1 s without a word; a byte later than that is the beginning of something else.
TEST(TwinFrame, HalfAFrameIsForgotten) {
    Bench b;
    const Bytes whole = frame("0906;5;0;7");
    EXPECT_TRUE(b.bytes(Bytes(whole.begin(), whole.begin() + 8)).empty());
    b.pass(900ms);
    EXPECT_EQ(b.bytes(Bytes(whole.begin() + 8, whole.end())).size(), 1u) << "900 ms are not yet silence";
    EXPECT_TRUE(b.bytes(Bytes(whole.begin(), whole.begin() + 8)).empty());
    b.pass(1100ms);
    EXPECT_EQ(b.poll(), "0;1;1;0;0;7") << "the EOT is a poll";
}

TEST(TwinFrame, BytesMayComeOneByOneAndTextIsBounded) {
    Bench b;
    std::size_t replies = 0;
    for (const std::uint8_t x : frame("0906;5;0;7"))
        replies += b.bytes({x}).size();
    EXPECT_EQ(replies, 1u);
    EXPECT_EQ(Bench::fields(b.one(b.bytes(frame("0906;5;0;" + std::string(500, '1'))), "long")).quit, 17);
}

// T-04: 7 significant digits, fixed.
TEST(TwinFrame, RealsAsText) {
    const std::vector<std::pair<double, const char*>> cases{
        {640, "640.0000"},       {1255, "1255.000"},        {1516.95, "1516.950"},  {10, "10.00000"},     {50000, "50000.00"},
        {0, "0.000000"},         {-0.0, "0.000000"},        {-1e-9, "0.000000"},    {-1.5, "-1.500000"},  {0.5, "0.500000"},
        {9.9999999, "10.00000"}, {-99.999999, "-100.0000"}, {9999999.4, "9999999"}, {1234567, "1234567"}, {123456789, "123456789"}};
    for (const auto& [value, text] : cases)
        EXPECT_EQ(to_wire(Datum::number(value)), text) << value;
    EXPECT_EQ(to_wire(Datum::integer(-2147483647)), "-2147483647");
    EXPECT_EQ(to_wire(Datum::integer(1e12)), "2147483647");
}

// Real requests may have any number of decimals; the stated type decides (E-59).
TEST(TwinFrame, NumbersOfRequests) {
    Bench b;
    EXPECT_EQ(b.ask("0907;27;1;10.0"), "0;1;1;0;1;10.00000");
    EXPECT_EQ(b.ask("0907;27;1;200"), "0;1;1;0;1;200.0000");
    EXPECT_EQ(b.ask("0907;27;1;-.5"), "0;1;1;0;1;-0.500000");
    EXPECT_EQ(b.ask("0907;27;0;7"), "0;1;1;0;1;7.000000");
    EXPECT_EQ(b.ask("0906;5;1;-7.5"), "0;1;1;0;0;-8") << "halves away from zero";
    EXPECT_EQ(b.ask("0906;0005;0;1"), "0;1;1;0;0;1") << "leading zeros occur [L2309]";
    EXPECT_EQ(b.quit("0906;5;0;2147483648"), 41);
    EXPECT_EQ(b.quit("0906;5;0;-2147483647"), 0);
    EXPECT_EQ(b.quit("0907;27;1;999999999999999999999999999999999999999"), 41) << "more than a single holds";
}

}  // namespace
}  // namespace axisgate::pacontrol::twin::test
