// Encapsulation: sessions, lists and every status, byte for byte; messages and the packets around them.
#include <gtest/gtest.h>

#include "tests/unit/cip/bench.hpp"

namespace axisgate::cip {
namespace {
using bench::Bench;
using bench::hex;

TEST(CipEncapsulation, RegisterSessionGivesAHandleAndEchoesTheContext) {
    Bench b;
    b.connect(2);
    const Bytes answer = b.packet_of(2, 0x65, hex("0100 0000"));
    EXPECT_EQ(answer, hex("6500 0400 02000001 00000000 0102030405060708 00000000 0100 0000"));
}

TEST(CipEncapsulation, EveryStatusOfASession) {
    Bench b;
    b.connect(2);
    (void)b.packet_of(2, 0x6F, hex("00000000 0000 0000"));
    EXPECT_EQ(b.status, PacketStatus::invalid_session);
    (void)b.packet_of(2, 0x65, hex("0200 0000"));
    EXPECT_EQ(b.status, PacketStatus::unsupported_revision);
    (void)b.packet_of(2, 0x65, hex("0100 0100"));
    EXPECT_EQ(b.status, PacketStatus::unsupported_revision);
    (void)b.packet_of(2, 0x65, hex("0100"));
    EXPECT_EQ(b.status, PacketStatus::invalid_length);
    b.register_session(2);
    EXPECT_EQ(b.status, PacketStatus::success);
    (void)b.packet_of(2, 0x65, hex("0100 0000"));
    EXPECT_EQ(b.status, PacketStatus::invalid_command) << "one session for each connection";
    (void)b.packet_of(2, 0x1234, {});
    EXPECT_EQ(b.status, PacketStatus::invalid_command);
    (void)b.packet_of(2, 0x6F, hex("00000000 0000 0500"));
    EXPECT_EQ(b.status, PacketStatus::incorrect_data);
    (void)b.packet_of(2, 0x6F, hex("01000000 0000 0200 0000 0000 B200 0000"));
    EXPECT_EQ(b.status, PacketStatus::incorrect_data) << "no interface but 0";
}

TEST(CipEncapsulation, WhatHasNoAnswerGetsNone) {
    Bench b;
    EXPECT_TRUE(b.packet_of(1, 0x00, hex("AABB")).empty());
    EXPECT_TRUE(b.packet_of(1, 0x63, {}, 1).empty()) << "options that are not 0: thrown away";
    EXPECT_TRUE(b.packet_of(1, 0x70, hex("00000000 0000 0200 A100 0400 99000000 B100 0200 0100")).empty());
    EXPECT_TRUE(b.output.hung_up.empty());
}

TEST(CipEncapsulation, UnregisterClosesAndALieAboutTheLengthToo) {
    Bench b;
    EXPECT_TRUE(b.packet_of(1, 0x66, {}).empty());
    EXPECT_EQ(b.output.hung_up, std::vector<SessionKey>{1});
    b.connect(2);
    b.adapter.on_stream(2, hex("6F00 FFFF 00000000 00000000 0000000000000000 00000000"), b.now);
    EXPECT_EQ(read_header(b.output.streams[2]).status, 0x65u);
    EXPECT_EQ(b.output.hung_up.back(), 2u);
}

TEST(CipEncapsulation, AStreamMayBeCutAnywhere) {
    Bench b;
    b.connect(2);
    const Bytes whole = hex("6500 0400 00000000 00000000 0102030405060708 00000000 0100 0000");
    for (const std::uint8_t byte : whole)
        b.adapter.on_stream(2, {&byte, 1}, b.now);
    EXPECT_EQ(b.output.streams[2].size(), 28u);
}

TEST(CipEncapsulation, ListsByteForByte) {
    Bench b;
    EXPECT_EQ(b.packet_of(1, 0x04, {}), hex("0400 1A00 01000001 00000000 0102030405060708 00000000"
                                            "0100 0001 1400 0100 2001 436F6D6D756E69636174696F6E730000"));
    EXPECT_EQ(b.packet_of(1, 0x64, {}), hex("6400 0200 01000001 00000000 0102030405060708 00000000 0000"));
    EXPECT_EQ(b.packet_of(1, 0x63, {}), hex("6300 3000 01000001 00000000 0102030405060708 00000000"
                                            "0100 0C00 2A00 0100 0002 AF12 C0A80064 0000000000000000"
                                            "FFFF 0C00 0100 0307 3400 04030201 08 6178697367617465 03"));
}

TEST(CipEncapsulation, AListThatBringsDataHasAWrongLength) {
    Bench b;
    for (const std::uint16_t order : std::initializer_list<std::uint16_t>{0x04, 0x63, 0x64}) {
        const Bytes answer = b.packet_of(1, order, hex("AABBCC"));
        EXPECT_EQ(b.status, PacketStatus::invalid_length) << order;
        EXPECT_EQ(answer.size(), header_size) << "nothing but the header: " << order;
        Header h;
        h.command = order;
        b.output.datagrams.clear();
        b.adapter.on_datagram(packet(h, hex("AABBCC")), Bench::plc, false, b.now);
        ASSERT_EQ(b.output.datagrams.size(), 1u);
        EXPECT_EQ(read_header(b.output.datagrams[0].bytes).status, static_cast<std::uint32_t>(PacketStatus::invalid_length)) << order;
        b.output.datagrams.clear();
        b.adapter.on_datagram(hex("0400 FF00 00000000"), Bench::plc, false, b.now);
        b.adapter.on_datagram(hex("6300 1000 00000000 00000000 0000000000000000 00000000 AA"), Bench::plc, false, b.now);
        EXPECT_TRUE(b.output.datagrams.empty()) << "half a header, or a lie about the length: nothing to answer";
    }
    EXPECT_TRUE(b.packet_of(1, 0x00, Bytes(4000, 0xA5)).empty()) << "NOP brings what it likes";
    EXPECT_FALSE(b.packet_of(1, 0x04, {}).empty()) << "and the session goes on";
}

TEST(CipEncapsulation, ABroadcastIsAnsweredWithinItsDelayAndAQuestionToThisDeviceAtOnce) {
    Bench b;
    Header h;
    h.command = 0x63;
    h.context = {0x90, 0x01};  // 400 ms: 500 is the least that is spread over
    b.adapter.on_datagram(packet(h, {}), Bench::plc, false, b.now);
    ASSERT_EQ(b.output.datagrams.size(), 1u);
    b.adapter.on_datagram(packet(h, {}), Bench::plc, true, b.now);
    EXPECT_EQ(b.output.datagrams.size(), 1u);
    b.pass(std::chrono::milliseconds(500));
    ASSERT_EQ(b.output.datagrams.size(), 2u);
    EXPECT_EQ(b.output.datagrams[1].to, Bench::plc);
    for (int i = 0; i < 100; ++i)
        b.adapter.on_datagram(packet(h, {}), Bench::plc, true, b.now);
    b.pass(std::chrono::seconds(3));
    EXPECT_EQ(b.output.datagrams.size(), 2 + Adapter::most_late);
    h.command = 0x65;
    b.adapter.on_datagram(packet(h, hex("01000000")), Bench::plc, false, b.now);
    EXPECT_EQ(read_header(b.output.datagrams.back().bytes).status, 1u) << "no sessions over UDP";
}

TEST(CipEncapsulation, SessionsAreBoundedAndTheOwnersStays) {
    Bench b;
    const std::uint32_t id = b.opened({});
    ASSERT_NE(id, 0u);
    std::uint32_t sequence = 0;
    for (SessionKey key = 2; key < 10'000; ++key) {
        b.connect(key, Bench::other);
        if (key % 100 == 0) {
            b.pass(std::chrono::milliseconds(5));
            ++sequence;
            b.implicit(id, sequence, static_cast<std::uint16_t>(sequence), "01000000" + std::string(64, '0'));
        }
    }
    EXPECT_LE(b.adapter.sessions(), Adapter::most_sessions);
    EXPECT_EQ(b.adapter.connections().open(), 1u);
    EXPECT_EQ(std::count(b.output.hung_up.begin(), b.output.hung_up.end(), 1u), 0);
    b.pass(std::chrono::milliseconds(30));
    EXPECT_TRUE(b.adapter.connections().owned());
}

TEST(CipEncapsulation, BusySessionsOfOneAddressMakeRoomForAnother) {
    Bench b;
    for (SessionKey key = 2; key < 2 + Adapter::most_sessions; ++key) {
        b.connect(key, Bench::other);
        b.register_session(key);
    }
    EXPECT_GE(b.adapter.sessions(), Adapter::most_sessions - Adapter::kept_sessions);
    b.connect(1000, Endpoint{0xC0A80003, 50'002});
    b.register_session(1000);
    EXPECT_EQ(b.ask(get(1, 1, 1), 1000).general, General::success);
    EXPECT_EQ(std::count(b.output.hung_up.begin(), b.output.hung_up.end(), 1u), 0) << "who has one only keeps it";
}

TEST(CipEncapsulation, WhoOnlyKnocksIsClosed) {
    Bench b;
    b.connect(2);
    b.pass(std::chrono::seconds(12));
    EXPECT_EQ(b.output.hung_up, std::vector<SessionKey>{2});
    b.pass(std::chrono::seconds(120));
    EXPECT_EQ(b.output.hung_up.back(), 1u) << "the encapsulation's inactivity time-out";
}
}  // namespace
}  // namespace axisgate::cip
