// Bit counts of CAN frames compared with figures computed by polynomial division, and arbitration order. The expected figures do not come
// from the code under test.
#include "gateway/core/wire_time.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/wire/twin_bus_fixture.hpp"

namespace axisgate {
namespace {

Frame standard(std::uint32_t id, std::initializer_list<std::uint8_t> data = {}) {
    Frame f = test::can(id, data);
    f.extended = false;
    f.id = id & 0x7FF;
    return f;
}
Frame remote(Frame f) {
    f.remote = true;
    return f;
}

TEST(WireTime, countsBitsExactly) {
    const struct {
        Frame frame;
        std::uint32_t bits;
        std::uint16_t crc;
    } rows[] = {
        {standard(0x14, {1}), 55, 0x7753},
        {test::can(0x04280095, {1}), 77, 14086},
        {test::can(0x04280095), 68, 6208},
        {standard(0), 50, 0},  // 34 zeros: six stuff bits
        {test::can(0, {0, 0, 0, 0, 0, 0, 0, 0}), 147, 15791},
        {test::can(0x1FFFFFFF, {255, 255, 255, 255, 255, 255, 255, 255}), 146, 7017},
        {standard(0x123, {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}), 109, 16951},
        {test::can(0x15555555, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}), 128, 20252},  // nothing to stuff
        {test::can(0x18FF1234, {1, 2, 3, 4, 5, 6, 7, 8}), 140, 6472},
        {remote(standard(0x123, {0, 0, 0, 0})), 44, 17234},
    };
    for (const auto& r : rows) {
        EXPECT_EQ(can_bits(r.frame), r.bits) << to_text(r.frame);
        EXPECT_EQ(can_crc(r.frame), r.crc) << to_text(r.frame);
    }
}

/// The same by another method: a text of bits, long division, stuffing of the text.
std::uint32_t bits_by_hand(const Frame& f) {
    std::string bits = "0";
    const auto put = [&bits](std::uint32_t v, int n) {
        for (int i = n - 1; i >= 0; --i)
            bits += (v >> i & 1) != 0 ? '1' : '0';
    };
    if (f.extended) {
        put(f.id >> 18, 11);
        bits += "11";
        put(f.id & 0x3FFFF, 18);
        bits += f.remote ? "100" : "000";
    } else {
        put(f.id, 11);
        bits += f.remote ? "100" : "000";
    }
    put(f.size, 4);
    if (!f.remote) {
        for (const auto b : f.data())
            put(b, 8);
    }
    std::string division = bits + std::string(15, '0');
    const std::string divisor = "1100010110011001";
    for (std::size_t i = 0; i < bits.size(); ++i) {
        if (division[i] == '0') continue;
        for (std::size_t k = 0; k < divisor.size(); ++k)
            division[i + k] = division[i + k] == divisor[k] ? '0' : '1';
    }
    bits += division.substr(division.size() - 15);
    std::string stuffed;
    for (const char c : bits) {
        stuffed += c;
        if (stuffed.ends_with(std::string(5, c))) stuffed += c == '0' ? '1' : '0';
    }
    return static_cast<std::uint32_t>(stuffed.size()) + 10;
}

TEST(WireTime, agreesWithCountingByHandOnManyFrames) {
    std::mt19937 random(7);
    for (int i = 0; i < 3000; ++i) {
        Frame f;
        f.kind = Frame::Kind::can;
        f.extended = (random() & 1) != 0;
        f.remote = random() % 8 == 0;
        f.id = static_cast<std::uint32_t>(random()) & (f.extended ? 0x1FFFFFFFu : 0x7FFu);
        f.size = static_cast<std::uint16_t>(random() % 9);
        const bool flat = random() % 3 == 0;  // long runs of one bit are where stuffing matters
        for (std::size_t k = 0; k < f.size; ++k)
            f.storage[k] = static_cast<std::uint8_t>(flat ? (random() % 2) * 255 : random());
        ASSERT_EQ(can_bits(f), bits_by_hand(f)) << to_text(f);
    }
}

TEST(WireTime, staysWithinTheKnownBounds) {
    // Without stuffing 128 bits, with the most 157: figures of the standard for 29-bit identifiers and 8 bytes (131 and 160 with
    // intermission).
    std::mt19937 random(1);
    for (int i = 0; i < 2000; ++i) {
        Frame f = test::can(static_cast<std::uint32_t>(random()), {0, 0, 0, 0, 0, 0, 0, 0});
        for (std::size_t k = 0; k < 8; ++k)
            f.storage[k] = static_cast<std::uint8_t>(random());
        EXPECT_GE(can_bits(f), 128u);
        EXPECT_LE(can_bits(f), 157u);
    }
}

TEST(WireTime, arbitratesAsTheBitsAreSent) {
    const Frame in_order[] = {
        standard(0),
        test::can(0),
        standard(0x0F0),
        remote(standard(0x0F0)),
        test::can(0x0F0 << 18),  // the same first eleven bits: the longer one loses
        remote(test::can(0x0F0 << 18)),
        test::can((0x0F0 << 18) + 1),
        standard(0x0F1),
        test::can(0x1FFFFFFE),
        test::can(0x1FFFFFFF),
        remote(test::can(0x1FFFFFFF)),
    };
    for (std::size_t i = 1; i < std::size(in_order); ++i) {
        EXPECT_LT(can_arbitration(in_order[i - 1]), can_arbitration(in_order[i]))
            << to_text(in_order[i - 1]) << " before " << to_text(in_order[i]);
    }
}

TEST(WireTime, turnsBitsIntoTime) {
    EXPECT_EQ(wire_time(131, 1'000'000), std::chrono::microseconds(131));
    EXPECT_EQ(wire_time(10, 9600), Duration(1'041'667));
    EXPECT_EQ(wire_time(11, 115'200), Duration(95'486));
    EXPECT_EQ(wire_time(1000, 0), Duration::zero());
}

}  // namespace
}  // namespace axisgate
