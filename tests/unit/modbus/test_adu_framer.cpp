// Whole ADUs from pieces of any size, and verdicts on bytes that are not Modbus.
#include <gtest/gtest.h>

#include "gateway/doors/modbus/adu_framer.hpp"
#include "tests/unit/modbus/fake_port.hpp"

namespace axisgate::modbus {
namespace {
using test::bytes;
using test::hex;
using Framed = AduFramer::Verdict;

std::string all(AduFramer& framer) {
    std::string out;
    Adu a;
    for (;;) {
        switch (framer.peek(a)) {
            case Framed::need_more:
                return out;
            case Framed::bad_protocol:
                return out + "bad protocol";
            case Framed::bad_length:
                return out + "bad length";
            case Framed::adu:
                out += std::to_string(a.transaction) + "/" + std::to_string(a.unit) + " " + hex(a.pdu) + "; ";
                framer.pop();
        }
    }
}

TEST(AduFramer, OneWholeAdu) {
    AduFramer f;
    f.feed(bytes("12 34 00 00 00 06 FF 03 00 00 00 0A"));
    EXPECT_EQ(all(f), "4660/255 03 00 00 00 0A; ");
    EXPECT_EQ(f.buffered(), 0u);
}

TEST(AduFramer, PeekDoesNotTake) {
    AduFramer f;
    f.feed(bytes("00 01 00 00 00 02 01 11"));
    Adu a;
    EXPECT_EQ(f.peek(a), Framed::adu);
    EXPECT_EQ(f.peek(a), Framed::adu);
    f.pop();
    EXPECT_EQ(f.peek(a), Framed::need_more);
}

TEST(AduFramer, ByteByByteGivesTheSame) {
    const auto stream = bytes("00 01 00 00 00 06 01 03 00 00 00 0A 00 02 00 00 00 02 00 11 00 03 00 00 00 05 01 2B 0E 01 00");
    AduFramer whole;
    whole.feed(stream);
    const std::string expected = all(whole);
    EXPECT_EQ(expected, "1/1 03 00 00 00 0A; 2/0 11; 3/1 2B 0E 01 00; ");
    AduFramer dripped;
    std::string got;
    for (const auto b : stream) {
        dripped.feed(std::span(&b, 1));
        got += all(dripped);
    }
    EXPECT_EQ(got, expected);
}

struct Header {
    const char* name;
    const char* stream;
    const char* expected;
};
class AduFramerHeader : public testing::TestWithParam<Header> {};
TEST_P(AduFramerHeader, Verdict) {
    AduFramer f;
    f.feed(bytes(GetParam().stream));
    EXPECT_EQ(all(f), GetParam().expected);
}
INSTANTIATE_TEST_SUITE_P(Table, AduFramerHeader,
                         testing::Values(Header{"protocol_1", "00 01 00 01 00 06 01 03 00 00 00 0A", "bad protocol"},
                                         Header{"protocol_high_byte", "00 01 01 00 00 06 01 03", "bad protocol"},
                                         Header{"protocol_told_at_the_third_byte", "00 01 47", "bad protocol"},
                                         Header{"protocol_told_at_the_fourth_byte", "00 01 00 47", "bad protocol"},
                                         Header{"length_0", "00 01 00 00 00 00", "bad length"},
                                         Header{"length_1", "00 01 00 00 00 01 01", "bad length"},
                                         Header{"length_2_is_the_least", "00 01 00 00 00 02 01 11", "1/1 11; "},
                                         Header{"length_255", "00 01 00 00 00 FF", "bad length"},
                                         Header{"length_256_told_at_the_fifth_byte", "00 01 00 00 01", "bad length"},
                                         Header{"length_65535", "00 01 00 00 FF FF", "bad length"},
                                         Header{"http", "47 45 54 20 2F", "bad protocol"},
                                         Header{"good_then_bad", "00 01 00 00 00 02 01 11 00 02 00 00 00 01", "1/1 11; bad length"},
                                         Header{"length_says_less", "00 01 00 00 00 02 01 03 00 00 00 0A", "1/1 03; bad protocol"},
                                         Header{"length_says_more", "00 01 00 00 00 08 01 03 00 00 00 0A", ""}),
                         [](const auto& i) { return i.param.name; });

TEST(AduFramer, TheGreatestAduFits) {
    std::vector<std::uint8_t> stream{0, 1, 0, 0, 0, 254, 1};
    stream.resize(max_adu, 0x5A);
    AduFramer f;
    EXPECT_EQ(f.feed(stream), max_adu);
    Adu a;
    ASSERT_EQ(f.peek(a), Framed::adu);
    EXPECT_EQ(a.pdu.size(), max_pdu);
}

TEST(AduFramer, TakesNoMoreThanItsCapacityAndGoesOnWhenTaken) {
    std::vector<std::uint8_t> one{0, 1, 0, 0, 0, 254, 1};
    one.resize(max_adu, 0x5A);
    AduFramer f;
    std::size_t fed = 0;
    while (f.feed(one) == one.size())
        ++fed;
    EXPECT_EQ(fed, AduFramer::capacity / max_adu);
    EXPECT_TRUE(f.space().empty());
    Adu a;
    for (int i = 0; i < 1000; ++i) {  // full all the time, and moving through the buffer
        ASSERT_EQ(f.peek(a), Framed::adu);
        f.pop();
        ASSERT_EQ(f.feed(one), one.size());
    }
    EXPECT_TRUE(f.space().empty());
}

TEST(AduFramer, KeepsHalfAnAduWhenTheRestMoves) {
    AduFramer f;
    std::vector<std::uint8_t> stream;
    for (int i = 0; i < 1000; ++i) {
        const auto a = bytes("00 00 00 00 00 06 01 03 00 00 00 0A");
        stream.insert(stream.end(), a.begin(), a.end());
        stream[stream.size() - 12] = static_cast<std::uint8_t>(i >> 8);
        stream[stream.size() - 11] = static_cast<std::uint8_t>(i);
    }
    std::size_t at = 0;
    int seen = 0;
    for (std::size_t piece = 1; at < stream.size(); piece = piece % 401 + 7) {
        at += f.feed(std::span(stream).subspan(at, std::min(piece, stream.size() - at)));
        for (Adu a; f.peek(a) == Framed::adu; f.pop())
            EXPECT_EQ(a.transaction, seen++);
    }
    EXPECT_EQ(seen, 1000);
}

}  // namespace
}  // namespace axisgate::modbus
