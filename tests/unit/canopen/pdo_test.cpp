// PDO mapping: words, bits of frames, and the walks into and out of a node's dictionary.
#include "gateway/protocols/canopen/pdo.hpp"

#include <array>

#include "tests/unit/canopen/bench.hpp"

namespace axisgate::canopen::test {
namespace {

const PdoMapping status_and_position{{{0x6041, 0}, 16}, {{0x6064, 0}, 32}, {{0x6061, 0}, 8}};

TEST(PdoMapping, AWordIsIndexSubindexAndBits) {
    EXPECT_EQ(mapping_word({{0x6064, 0}, 32}), 0x60640020u);
    EXPECT_EQ(mapped_entry(0x60FE0120), (MappedEntry{{0x60FE, 1}, 32}));
}
TEST(PdoMapping, ValuesStandLowByteFirstOneBehindTheOther) {
    std::vector<std::uint64_t> v;
    ASSERT_EQ(unpack(status_and_position, frame("185#37 06 18FCFFFF 01").data(), v), PdoLength::fits);
    EXPECT_EQ(v, (std::vector<std::uint64_t>{0x0637, 0xFFFFFC18, 1}));
    EXPECT_EQ(as_signed(v[1], 32), -1000);
    EXPECT_EQ(as_signed(0x80, 8), -128);
    EXPECT_EQ(as_signed(~0ull, 64), -1);
    EXPECT_EQ(pack(status_and_position, v), (std::vector<std::uint8_t>{0x37, 0x06, 0x18, 0xFC, 0xFF, 0xFF, 0x01}));
}
TEST(PdoMapping, BitsNeedNoWholeBytes) {
    const PdoMapping m{{{0x2000, 1}, 1}, {{0x2000, 2}, 3}, {{0x2000, 3}, 5}};
    EXPECT_EQ(pack(m, std::array<std::uint64_t, 3>{1, 5, 0x11}), (std::vector<std::uint8_t>{0x1B, 0x01}));
    std::vector<std::uint64_t> v;
    EXPECT_EQ(unpack(m, std::array<std::uint8_t, 2>{0x1B, 0x01}, v), PdoLength::fits);
    EXPECT_EQ(v, (std::vector<std::uint64_t>{1, 5, 0x11}));
    EXPECT_EQ(pack(m, std::array<std::uint64_t, 1>{0xFF}), (std::vector<std::uint8_t>{0x01, 0x00})) << "cut to its bit; the others 0";
}
TEST(PdoMapping, AFrameThatIsTooShortIsNotTakenAndALongerOneIsCut) {
    std::vector<std::uint64_t> v{9};
    EXPECT_EQ(unpack(status_and_position, frame("185#370618FCFFFF").data(), v), PdoLength::shorter);
    EXPECT_EQ(v, std::vector<std::uint64_t>{9});
    EXPECT_EQ(unpack(status_and_position, frame("185#370618FCFFFF01FF").data(), v), PdoLength::longer);
    EXPECT_EQ(v.size(), 3u);
}
TEST(PdoMapping, SixtyFourBitsAreTheMost) {
    EXPECT_EQ(fault_of({{{0x2000, 1}, 64}}), Abort::none);
    EXPECT_EQ(fault_of({{{0x2000, 1}, 64}, {{0x2000, 2}, 1}}), Abort::pdo_length);
    EXPECT_EQ(fault_of(PdoMapping(64, MappedEntry{{0x2000, 1}, 1})), Abort::none);
    EXPECT_EQ(fault_of(PdoMapping(65, MappedEntry{{0x2000, 1}, 1})), Abort::pdo_length);
    EXPECT_EQ(fault_of({{{0x2000, 1}, 0}}), Abort::length);
    const PdoMapping full{{{0x2000, 1}, 64}};
    EXPECT_EQ(pack(full, std::array<std::uint64_t, 1>{~0ull}), std::vector<std::uint8_t>(8, 0xFF));
    EXPECT_FALSE(pack({{{0x2000, 1}, 0}}, {}));
    std::vector<std::uint64_t> v;
    EXPECT_EQ(unpack({{{0x2000, 1}, 64}, {{0x2000, 2}, 1}}, std::array<std::uint8_t, 8>{}, v), PdoLength::shorter);
}

TEST(PdoWrites, TakeItOutOfUseFillItAndPutItIntoUse) {
    const Pdo pdo{PdoDirection::transmit, 1, {.id = 0x185, .valid = true, .transmission = 1}, status_and_position};
    const std::vector<SdoWrite> expected{{{0x1800, 1}, {0x85, 0x01, 0x00, 0xC0}},
                                         {{0x1800, 2}, {1}},
                                         {{0x1A00, 0}, {0}},
                                         {{0x1A00, 1}, {0x10, 0x00, 0x41, 0x60}},
                                         {{0x1A00, 2}, {0x20, 0x00, 0x64, 0x60}},
                                         {{0x1A00, 3}, {0x08, 0x00, 0x61, 0x60}},
                                         {{0x1A00, 0}, {3}},
                                         {{0x1800, 1}, {0x85, 0x01, 0x00, 0x40}}};
    EXPECT_EQ(writes_of(pdo), expected);
}
TEST(PdoWrites, TimesAreWrittenIfThereAreSome) {
    const Pdo pdo{PdoDirection::receive, 3, {.id = 0x405, .remote_allowed = true, .inhibit_100us = 10, .event_ms = 100}, {}};
    const auto w = writes_of(pdo);
    ASSERT_EQ(w.size(), 6u) << "and it stays out of use";
    EXPECT_EQ(w[0], (SdoWrite{{0x1402, 1}, {0x05, 0x04, 0x00, 0x80}}));
    EXPECT_EQ(w[2], (SdoWrite{{0x1402, 3}, {10, 0}}));
    EXPECT_EQ(w[3], (SdoWrite{{0x1402, 5}, {100, 0}}));
    EXPECT_EQ(w[5], (SdoWrite{{0x1602, 0}, {0}}));
    EXPECT_TRUE(writes_of({PdoDirection::receive, 1, {}, {{{0x2000, 1}, 0}}}).empty());
}
TEST(PdoSettings, AnIdentifierMayHave29Bits) {
    PdoSettings s;
    set_id_word(s, 0x2123'4567);
    EXPECT_TRUE(s.extended && s.valid && s.remote_allowed);
    EXPECT_EQ(s.id, 0x0123'4567u);
    EXPECT_EQ(id_word(s), 0x2123'4567u);
}

struct Node : testing::Test {
    Dictionary d;
    Node() {
        d.add({0x1800, 1}, {.type = DataType::unsigned32, .bytes = {0x85, 0x01, 0x00, 0x40}});
        d.add({0x1800, 2}, {.type = DataType::unsigned8, .bytes = {255}});
        d.add({0x1800, 5}, {.type = DataType::unsigned16, .bytes = {20, 0}});
        d.add({0x1A00, 0}, {.type = DataType::unsigned8, .bytes = {2}});
        d.add({0x1A00, 1}, {.type = DataType::unsigned32, .bytes = {0x10, 0x00, 0x41, 0x60}});
        d.add({0x1A00, 2}, {.type = DataType::unsigned32, .bytes = {0x20, 0x00, 0x64, 0x60}});
        d.add({0x6041, 0}, {.type = DataType::unsigned16, .access = EntryAccess::read_only, .mappable = Mappable::transmit});
        d.add({0x6064, 0}, {.type = DataType::integer32, .access = EntryAccess::read_only, .mappable = Mappable::transmit});
        d.add({0x6040, 0}, {.type = DataType::unsigned16, .mappable = Mappable::receive});
        d.add({0x6081, 0}, {.type = DataType::unsigned32});
    }
};
TEST_F(Node, IsReadEntryByEntryWithoutWhatItNeedNotHave) {
    Abort fault{};
    const auto pdo = pdo_of(d, PdoDirection::transmit, 1, fault);
    ASSERT_TRUE(pdo);
    EXPECT_EQ(*pdo, (Pdo{PdoDirection::transmit,
                         1,
                         {.id = 0x185, .valid = true, .transmission = 255, .event_ms = 20},
                         {{{0x6041, 0}, 16}, {{0x6064, 0}, 32}}}));
}
TEST_F(Node, WhatIsWrittenIsReadAgain) {
    for (const auto& w :
         writes_of({PdoDirection::transmit, 1, {.id = 0x1C5, .valid = true, .transmission = 4, .event_ms = 5}, {{{0x6041, 0}, 16}}}))
        EXPECT_EQ(d.write(w.address, w.bytes, true), Abort::none) << to_text(w.address);
    Abort fault{};
    const auto pdo = pdo_of(d, PdoDirection::transmit, 1, fault);
    ASSERT_TRUE(pdo);
    EXPECT_EQ(pdo->settings.id, 0x1C5u);
    EXPECT_EQ(pdo->settings.transmission, 4);
    EXPECT_EQ(pdo->mapping.size(), 1u);
}
TEST_F(Node, WithoutThePdoTellsWhy) {
    Abort fault{};
    EXPECT_FALSE(pdo_of(d, PdoDirection::transmit, 2, fault));
    EXPECT_EQ(fault, Abort::no_object);
    d.add({0x1A00, 0}, {.type = DataType::unsigned8, .bytes = {3}});
    EXPECT_FALSE(pdo_of(d, PdoDirection::transmit, 1, fault));
    EXPECT_EQ(fault, Abort::no_subindex);
    d.add({0x1A00, 0}, {.type = DataType::unsigned8, .bytes = {65}});
    EXPECT_FALSE(pdo_of(d, PdoDirection::transmit, 1, fault));
    EXPECT_EQ(fault, Abort::pdo_length);
    d.add({0x1A00, 0}, {.type = DataType::unsigned16, .bytes = {2, 0}});
    EXPECT_FALSE(pdo_of(d, PdoDirection::transmit, 1, fault));
    EXPECT_EQ(fault, Abort::length);
}
TEST_F(Node, TakesOnlyWhatItHasAndMayMap) {
    const auto fault = [&](PdoDirection way, Address a, std::uint8_t bits) { return fault_of({{a, bits}}, way, d); };
    EXPECT_EQ(fault(PdoDirection::transmit, {0x6041, 0}, 16), Abort::none);
    EXPECT_EQ(fault(PdoDirection::receive, {0x6041, 0}, 16), Abort::not_mappable);
    EXPECT_EQ(fault(PdoDirection::receive, {0x6040, 0}, 16), Abort::none);
    EXPECT_EQ(fault(PdoDirection::receive, {0x6040, 0}, 8), Abort::length);
    EXPECT_EQ(fault(PdoDirection::receive, {0x6081, 0}, 32), Abort::not_mappable);
    EXPECT_EQ(fault(PdoDirection::receive, {0x6042, 0}, 16), Abort::no_object);
    EXPECT_EQ(fault(PdoDirection::receive, {0x6040, 1}, 16), Abort::no_subindex);
    EXPECT_EQ(fault(PdoDirection::receive, {0x0005, 0}, 8), Abort::none) << "a gap of an UNSIGNED8";
    EXPECT_EQ(fault(PdoDirection::receive, {0x0005, 0}, 16), Abort::length);
    EXPECT_EQ(fault(PdoDirection::receive, {0x0009, 0}, 8), Abort::not_mappable);
    EXPECT_EQ(fault(PdoDirection::transmit, {0x0005, 0}, 8), Abort::no_object);
}

}  // namespace
}  // namespace axisgate::canopen::test
