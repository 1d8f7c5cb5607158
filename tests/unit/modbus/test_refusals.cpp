// The effects of a refused write: an event with its text, and two registers of the axis; and the limit on events.
#include <gtest/gtest.h>

#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using test::ResponderBench;
using namespace std::chrono_literals;

struct Refusals : testing::Test, ResponderBench {
    AxisId x = port.add_axis(1, &test::catalogue());
    void refuse_with(Reason reason, std::string text, std::int32_t code = 0) {
        result = [this, reason, text, code] { port.answer(Outcome::refused, reason, code, {}, text); };
    }
    [[nodiscard]] std::string registers() { return ask("03 00 14 00 02"); }
};

TEST_F(Refusals, SentenceWhoRegisterAndValue) {
    EXPECT_EQ(registers(), "03 04 00 00 00 00");
    refuse_with(Reason::out_of_range, "axis feeder: target 80 mm is above the axis' position_max 50 mm");
    EXPECT_EQ(ask("10 00 20 00 04 08 00 1F 00 01 00 00 00 50"), "90 03");
    ASSERT_EQ(port.notes.size(), 1u);
    const auto& [e, axis] = port.notes[0];
    EXPECT_EQ(e.kind, "refused");
    EXPECT_EQ(e.severity, Severity::warning);
    EXPECT_EQ(e.door, "modbus");
    EXPECT_EQ(e.who, "192.0.2.7:51123");
    EXPECT_EQ(e.text, "axis feeder: target 80 mm is above the axis' position_max 50 mm (unit 1 registers 32..35 = 31 1 0 80: exception 3)");
    EXPECT_EQ(axis, x);
    EXPECT_EQ(registers(), "03 04 00 01 00 01");
    refuse_with(Reason::wrong_state, "axis feeder: it is not enabled");
    EXPECT_EQ(ask("06 00 20 00 1F"), "86 04");
    EXPECT_EQ(registers(), "03 04 00 04 00 02");
    port.edit(x, [](AxisPicture& p) { p.position = 5; });
    EXPECT_EQ(registers(), "03 04 00 04 00 02") << "a new picture leaves them";
    result = [this] { port.answer(); };
    EXPECT_EQ(ask("06 00 20 00 0F"), "06 00 20 00 0F");
    EXPECT_EQ(registers(), "03 04 00 04 00 02") << "and so does a good write";
    port.remove_axis(1);
    port.add_axis(1, &test::catalogue());
    EXPECT_EQ(registers(), "03 04 00 00 00 00") << "another axis";
}

TEST_F(Refusals, WhatTheDoorItselfRefuses) {
    const std::pair<const char*, const char*> rows[] = {
        {"06 00 02 00 07", "register 2 of the axis' 64 (position actual value) can only be read (unit 1 register 2 = 7: exception 2)"},
        {"06 00 18 00 07",
         "register 24 of the axis' 64 cannot be written: 32..45, 48..50, 52 and 53 can (unit 1 register 24 = 7: exception 2)"},
        {"06 00 22 00 07", "half of a 32-bit value: write both of its registers in one request (unit 1 register 34 = 7: exception 3)"},
        {"05 00 03 FF 00",
         "coils and inputs only show what is: write the control word, register 32 of the axis (unit 1 coil 3 = 1: exception 2)"},
        {"06 00 60 00 0F", "no axis has the number 2, to which addresses 64..127 belong (unit 1 register 96 = 15: exception 10)"},
        {"10 00 20 00 02 02 00 0F",
         "the request's count, length and data do not fit each other, or go beyond what one request may carry (unit 1 registers 32..33 = "
         "15 0: exception 3)"},
        {"06 00 32 00 09",
         "the parameter channel has no request 9: 1 reads, 2 writes, 0 goes back to idle (unit 1 register 50 = 9: exception 3)"}};
    for (const auto& [request, text] : rows) {
        port.notes.clear();
        port.time += 10s;
        (void)ask(request);
        ASSERT_EQ(port.notes.size(), 1u) << request;
        EXPECT_EQ(port.notes[0].first.text, text);
    }
    EXPECT_EQ(registers(), "03 04 00 01 00 06") << "the write to another axis' place is not this one's";
    port.notes.clear();
    port.time += 10s;
    EXPECT_EQ(ask("06 00 20 00 00", 7), "86 0A");
    EXPECT_EQ(
        port.notes.at(0).first.text,
        "unit 7 has no map: unit 1 is the standard map, others get theirs from the site's mappings (unit 7 register 32 = 0: exception 10)");
    responder.set_read_only(true);
    EXPECT_EQ(ask("06 00 20 00 0F"), "86 01");
    EXPECT_EQ(port.notes.at(1).first.text,
              "the Modbus door is read-only: it takes a quick stop or switching off by the control word alone (unit 1 register 32 = 15: "
              "exception 1)");
    EXPECT_EQ(registers(), "03 04 00 03 00 07");
}

TEST_F(Refusals, ReadsThatLeadNowhereAreToldAndCountForNoAxis) {
    EXPECT_EQ(ask("03 00 3F 00 02"), "83 0A");
    ASSERT_EQ(port.notes.size(), 1u);
    EXPECT_EQ(port.notes[0].first.severity, Severity::info);
    EXPECT_EQ(ask("03 00 00 00 00"), "83 03");
    EXPECT_EQ(ask("64"), "E4 01");
    EXPECT_EQ(port.notes.size(), 1u) << "what is no address is no news";
    EXPECT_EQ(registers(), "03 04 00 00 00 00");
}

TEST_F(Refusals, ADriveThatDoesNotAnswer) {
    result = [this] {
        port.time += 31s;
        responder.writer().sweep(port.time);
    };
    EXPECT_EQ(ask("06 00 20 00 0F"), "86 0B");
    ASSERT_EQ(port.notes.size(), 1u);
    EXPECT_EQ(port.notes[0].first.text, "the drive did not answer in time (unit 1 register 32 = 15: exception 11)");
    EXPECT_EQ(registers(), "03 04 00 09 00 01");
}

TEST_F(Refusals, AClientThatHasGoneIsStillTold) {
    std::array<std::uint8_t, max_pdu> out{};
    const auto request = test::bytes("06 00 20 00 0F");
    EXPECT_EQ(responder.answer(client(), 7, 1, request, port.now(), out.data(), late), 0u);
    responder.writer().forget(*this);
    port.answer(Outcome::refused, Reason::authority, 0, {}, "axis feeder: anna holds it");
    ASSERT_EQ(port.notes.size(), 1u);
    EXPECT_EQ(port.notes[0].first.text, "axis feeder: anna holds it (unit 1 register 32 = 15: exception 6)");
    EXPECT_TRUE(slots.empty());
}

TEST_F(Refusals, IdenticalOnesInARowAreOneEventWithACount) {
    refuse_with(Reason::wrong_state, "axis feeder: it is not enabled");
    for (int i = 0; i < 1000; ++i) {  // 10 ms apart
        (void)ask("06 00 20 00 1F");
        port.time += 10ms;
    }
    ASSERT_EQ(port.notes.size(), 1u);
    EXPECT_TRUE(responder.writer().waits());
    responder.writer().sweep(port.time);
    ASSERT_EQ(port.notes.size(), 2u);
    EXPECT_EQ(port.notes[1].first.text, "axis feeder: it is not enabled (unit 1 register 32 = 31: exception 4): 999 times more");
    EXPECT_FALSE(responder.writer().waits());
    (void)ask("06 00 20 00 1F");
    (void)ask("06 00 20 00 0F");
    ASSERT_EQ(port.notes.size(), 4u) << "another one ends the row";
    EXPECT_EQ(port.notes[2].first.text, "axis feeder: it is not enabled (unit 1 register 32 = 31: exception 4): once more");
    EXPECT_EQ(registers(), "03 04 00 04 03 EA") << "each of them counts";
}

TEST_F(Refusals, AtMostSoManyEvents) {
    const auto flood = [this](std::string_view from, int n) {
        who = std::make_shared<const std::string>(from);
        for (int i = 0; i < n; ++i) {
            char request[32];
            std::snprintf(request, sizeof request, "06 00 02 %02X %02X", i / 256, i % 256);
            (void)ask(request);
        }
    };
    flood("192.0.2.7:1000", 1000);
    EXPECT_EQ(port.notes.size(), 5u) << "the burst of one client";
    flood("192.0.2.7:1001", 1000);
    EXPECT_EQ(port.notes.size(), 5u) << "another connection is the same client";
    port.time += 1s;
    flood("192.0.2.7:1001", 1);
    ASSERT_EQ(port.notes.size(), 6u);
    EXPECT_NE(port.notes[5].first.text.find("; 1995 more refusals of 192.0.2.7 were not told one by one"), std::string::npos)
        << port.notes[5].first.text;
    port.notes.clear();
    port.time += 60s;
    for (int c = 0; c < 200; ++c)
        flood("198.51.100." + std::to_string(c) + ":1", 10);
    EXPECT_EQ(port.notes.size(), 32u) << "the burst of all";
    for (int s = 0; s < 10; ++s) {
        port.time += 1s;
        for (int c = 0; c < 200; ++c)
            flood("198.51.100." + std::to_string(c) + ":1", 3);
    }
    EXPECT_EQ(port.notes.size(), 32u + 80u) << "and 8 a second";
}

}  // namespace
}  // namespace axisgate::modbus
