// Every kind of segment, and invalid ones.
#include "gateway/protocols/cip/path.hpp"

#include <gtest/gtest.h>

#include "tests/unit/cip/bench.hpp"

namespace axisgate::cip {
namespace {
using bench::hex;

TEST(CipPath, LogicalSegmentsOfEverySize) {
    const auto p = read_path(hex("20 04 25 00 E8 03 30 03"));
    ASSERT_TRUE(p);
    EXPECT_EQ(p->class_id, 4u);
    EXPECT_EQ(p->instance(), 1000u);
    EXPECT_EQ(p->attribute, 3u);
    const auto wide = read_path(hex("20 0F 26 00 78 56 34 12"));
    ASSERT_TRUE(wide);
    EXPECT_EQ(wide->instance(), 0x12345678u);
    Bytes made;
    put_class(made, 4);
    put_instance(made, 1000);
    put_attribute(made, 3);
    EXPECT_EQ(made, hex("20 04 25 00 E8 03 30 03"));
}

TEST(CipPath, AConnectionsPath) {
    const auto p = read_path(hex("01 00 34 04 FFFF 0C00 0100 83 07 20 04 24 C7 2C 97 2C 65 43 05 80 01 AABB"));
    ASSERT_TRUE(p);
    ASSERT_EQ(p->ports.size(), 1u);
    EXPECT_EQ(p->ports[0].number, 1u);
    ASSERT_TRUE(p->key);
    EXPECT_EQ(p->key->product_code, 1u);
    EXPECT_TRUE(p->key->compatible);
    EXPECT_EQ(p->key->major, 3u);
    ASSERT_EQ(p->places.size(), 3u);
    EXPECT_FALSE(p->places[0].connection_point);
    EXPECT_EQ(p->places[2].instance, 0x65u);
    EXPECT_EQ(p->inhibit_ms, 5u);
    EXPECT_EQ(p->data, hex("AABB"));
}

TEST(CipPath, PortsWithLongLinksAndNames) {
    const auto p = read_path(hex("12 0A 31 30 2E 30 2E 30 2E 31 30 30 91 03 61 62 63 00 62 61 62 00"));
    ASSERT_TRUE(p);
    EXPECT_EQ(p->ports[0].number, 2u);
    EXPECT_EQ(p->ports[0].link.size(), 10u);
    EXPECT_EQ(p->symbols, (std::vector<std::string>{"abc", "ab"}));
}

TEST(CipPath, WhatIsNoPathSaysWhere) {
    for (const auto* text : {"20", "21 00 04", "34 04 FFFF", "34 05 0000 0000 0000 00 00", "24 01", "2F 00", "FF 00", "00 00", "40 00",
                             "91 09 61", "80 02 AABB", "20 04 01 00"}) {
        std::size_t at = 0;
        EXPECT_FALSE(read_path(hex(text), at)) << text;
    }
    std::size_t at = 0;
    EXPECT_FALSE(read_path(hex("20 04 24 01 FF 00"), at));
    EXPECT_EQ(at, 2u);
}
}  // namespace
}  // namespace axisgate::cip
