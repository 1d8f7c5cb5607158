// Functions 17 and 43/14, byte for byte, and the paging of long answers.
#include <gtest/gtest.h>

#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace {
using test::ResponderBench;

std::string object(std::uint8_t id, std::string_view value) {
    std::vector<std::uint8_t> out{id, static_cast<std::uint8_t>(value.size())};
    out.insert(out.end(), value.begin(), value.end());
    return " " + test::hex(out);
}
const std::string basic = object(0, "axisgate") + object(1, "AXISGATE") + object(2, "1.2.3");
const std::string regular = basic + object(4, "axisgate fieldbus gateway") + object(5, "axisgate");

TEST(Identification, GatewaysOwn) {
    ResponderBench d;
    d.port.set_mapping_revision(0xCAFE0123);
    EXPECT_EQ(d.ask("2B 0E 01 00"), "2B 0E 01 83 00 00 03" + basic);
    EXPECT_EQ(d.ask("2B 0E 02 00"), "2B 0E 02 83 00 00 05" + regular);
    EXPECT_EQ(d.ask("2B 0E 03 00"), "2B 0E 03 83 00 00 07" + regular + object(0x80, "cafe0123") + object(0x81, "high_first"));
    EXPECT_EQ(d.ask("2B 0E 04 00"), "2B 0E 04 83 00 00 01" + object(0, "axisgate"));
    EXPECT_EQ(d.ask("2B 0E 04 05"), "2B 0E 04 83 00 00 01" + object(5, "axisgate"));
    EXPECT_EQ(d.ask("2B 0E 04 80"), "2B 0E 04 83 00 00 01" + object(0x80, "cafe0123"));
    d.port.set_mapping_revision(0x0000000A);
    EXPECT_EQ(d.ask("2B 0E 04 80"), "2B 0E 04 83 00 00 01" + object(0x80, "0000000a"));
    EXPECT_EQ(ResponderBench(WordOrder::low_first).ask("2B 0E 04 81"), "2B 0E 04 83 00 00 01" + object(0x81, "low_first"));
}

TEST(Identification, StreamFromAnObject) {
    ResponderBench d;
    EXPECT_EQ(d.ask("2B 0E 01 01"), "2B 0E 01 83 00 00 02" + object(1, "AXISGATE") + object(2, "1.2.3"));
    EXPECT_EQ(d.ask("2B 0E 02 05"), "2B 0E 02 83 00 00 01" + object(5, "axisgate"));
    EXPECT_EQ(d.ask("2B 0E 01 03"), "2B 0E 01 83 00 00 03" + basic) << "unknown: from the beginning";
    EXPECT_EQ(d.ask("2B 0E 01 04"), "2B 0E 01 83 00 00 03" + basic) << "known, but not of the category";
    EXPECT_EQ(d.ask("2B 0E 02 80"), "2B 0E 02 83 00 00 05" + regular);
    EXPECT_EQ(d.ask("2B 0E 03 77").substr(0, 20), "2B 0E 03 83 00 00 07");
}

TEST(Identification, Faults) {
    ResponderBench d;
    EXPECT_EQ(d.ask("2B 0E 04 03"), "AB 02") << "no vendor URL";
    EXPECT_EQ(d.ask("2B 0E 04 FF"), "AB 02");
    EXPECT_EQ(d.ask("2B 0E 00 00"), "AB 03");
    EXPECT_EQ(d.ask("2B 0E 05 00"), "AB 03");
    EXPECT_EQ(d.ask("2B 0E 01"), "AB 03");
    EXPECT_EQ(d.ask("2B 0E 01 00 00"), "AB 03");
    EXPECT_EQ(d.ask("2B 0D 01 00"), "AB 01");
    EXPECT_EQ(d.ask("2B"), "AB 03");
}

TEST(Identification, ConformityLevelFollowsTheObjects) {
    std::uint8_t out[max_pdu];
    Identity i;
    const auto level = [&] { return read_device_identification(i, 1, 0, out).size > 0 ? out[3] : 0; };
    i.objects = {{0, "v"}, {1, "p"}, {2, "r"}};
    EXPECT_EQ(level(), 0x81);
    i.objects.push_back({4, "n"});
    EXPECT_EQ(level(), 0x82);
    i.objects.push_back({0x80, "x"});
    EXPECT_EQ(level(), 0x83);
}

TEST(Identification, WhatDoesNotFitFollows) {
    Identity i;
    i.objects = {{0, std::string(100, 'v')}, {1, std::string(100, 'p')}, {2, std::string(60, 'r')}, {4, std::string(300, 'n')}};
    std::uint8_t out[max_pdu];
    auto a = read_device_identification(i, 2, 0, out);
    EXPECT_EQ(a.size, 7u + 2 * 102);
    EXPECT_EQ(test::hex(std::span(out, 7)), "2B 0E 02 82 FF 02 02") << "more follows, from object 2";
    a = read_device_identification(i, 2, 2, out);
    EXPECT_EQ(a.size, 7u + 62);
    EXPECT_EQ(test::hex(std::span(out, 9)), "2B 0E 02 82 FF 04 01 02 3C");
    a = read_device_identification(i, 2, 4, out);
    EXPECT_EQ(a.size, max_pdu) << "the longest value that can be sent";
    EXPECT_EQ(test::hex(std::span(out, 9)), "2B 0E 02 82 00 00 01 04 F4");
    a = read_device_identification(i, 4, 4, out);
    EXPECT_EQ(a.size, max_pdu);
}

TEST(Identification, ServerIdIsCutToTheAnswersSize) {
    Identity i;
    i.version = std::string(300, 'x');
    std::uint8_t out[max_pdu];
    EXPECT_EQ(report_server_id(i, 1, out), max_pdu);
    EXPECT_EQ(out[1], max_pdu - 2);
}

}  // namespace
}  // namespace axisgate::modbus
