// Decoder of the UIM342: one line per message, in both directions, on both kinds of line, and honest about what it cannot read.
#include "adapters/uim342/decoder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <sstream>

namespace axisgate {
const Family& family_uim342();
}

namespace axisgate::uim342 {
namespace {

std::string can(std::uint32_t id, std::initializer_list<std::uint8_t> data) {
    LineDecoder d(LineKind::can);
    const std::vector<std::uint8_t> bytes(data);
    const auto lines = d.on_frame(Frame::can_extended(id, bytes), std::nullopt);
    EXPECT_EQ(lines.size(), 1u);
    return lines.empty() ? "" : lines[0];
}

TEST(Uim342Decoder, CanBothDirections) {
    EXPECT_EQ(can(0x04280095, {1}), "04280095#01  host -> 5  MO=1");
    EXPECT_EQ(can(0x05200015, {1}), "05200015#01  5 -> host  MO = 1 (driver on)");
    EXPECT_EQ(can(0x0428009D, {0x18, 0xFC, 0xFF, 0xFF}), "0428009D#18FCFFFF  host -> 5  JV=-1000");
    EXPECT_EQ(can(0x0520002E, {2, 0x18, 0xFC, 0xFF, 0xFF}), "0520002E#0218FCFFFF  5 -> host  DV[2] = -1000 (desired speed)");
    EXPECT_EQ(can(0x04000016, {}), "04000016#  host -> all  BG (no acknowledgement)");
    EXPECT_EQ(can(0x0520000F, {0, 0x33, 0x81, 5, 0, 0}), "0520000F#003381050000  5 -> host  error 0x33 (data error) about PP[5]");
    EXPECT_EQ(can(0x1E23005A, {0x04}), "1E23005A#04  126 -> host  notification: IN2 rising");
    EXPECT_EQ(can(0x0520005A, {0, 0x1D, 0, 0, 0}), "0520005A#001D000000  5 -> host  notification: alarm 0x1D (motor stall)");
    EXPECT_EQ(can(0x0520005A, {0x29, 0, 0, 0, 0x18, 0xFC, 0xFF, 0xFF}),
              "0520005A#2900000018FCFFFF  5 -> host  notification: PTP finished at -1000");
    EXPECT_EQ(can(0x04280091, {0, 0}), "04280091#0000  host -> 5  MS[0]=0");
    EXPECT_EQ(can(0x042800B4, {0, 0x06, 0x80}),
              "042800B4#000680  host -> 5  IL[0]=0x8006 (falling: origin, then stop (also at power-on); rising: none)");
}

TEST(Uim342Decoder, CanThatIsNotSimpleCan) {
    EXPECT_NE(can(0x05202015, {1}).find("unknown"), std::string::npos);
    LineDecoder d(LineKind::can);
    Frame f = Frame::can_extended(0x123, {});
    f.extended = false;
    EXPECT_NE(d.on_frame(f, false)[0].find("11-bit"), std::string::npos);
    f.extended = f.remote = true;
    EXPECT_NE(d.on_frame(f, false)[0].find("remote"), std::string::npos);
    Frame e;
    e.kind = Frame::Kind::can_error;
    e.id = 0x60;
    EXPECT_NE(d.on_frame(e, false)[0].find("no acknowledgement on the bus, bus off"), std::string::npos);
    EXPECT_NE(d.on_frame(Frame::run(std::array<std::uint8_t, 1>{1}), false)[0].find("unknown"), std::string::npos);
    EXPECT_NE(can(0x05200044, {1}).find("unknown control word"), std::string::npos);
}

TEST(Uim342Decoder, BytesWithTheCrcThatProvedThem) {
    LineDecoder d(LineKind::bytes);
    const Message m = message(5, 0x95, std::array<std::uint8_t, 1>{1});
    EXPECT_EQ(d.on_frame(Frame::run(to_uimessage(m, CrcMode::twelve)), true),
              std::vector<std::string>{"AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 95 CC  to 5  MO=1 [CRC good, ID to d8]"});
    EXPECT_EQ(d.on_frame(Frame::run(to_uimessage(m, CrcMode::thirteen)), true),
              std::vector<std::string>{"AA 05 95 01 01 00 00 00 00 00 00 00 00 27 D7 CC  to 5  MO=1 [CRC good, AA to d8]"});
    EXPECT_EQ(d.on_frame(Frame::run(to_uimessage(m, CrcMode::none)), std::nullopt),
              std::vector<std::string>{"AD 05 95 01 01 00 00 00 00 00 00 00 00 00 00 CC  to 5  MO=1 [no CRC]"});
    const Message a = message(5, 0x15, std::array<std::uint8_t, 1>{1});
    EXPECT_EQ(d.on_frame(Frame::run(to_uimessage(a, CrcMode::twelve)), false),
              std::vector<std::string>{"AA 05 15 01 01 00 00 00 00 00 00 00 00 71 57 CC  from 5  MO = 1 (driver on) [CRC good, ID to d8]"});
    EXPECT_NE(d.on_frame(Frame::run(to_uimessage(a, CrcMode::twelve)), std::nullopt)[0].find("direction not known"), std::string::npos);
    EXPECT_TRUE(d.finish().empty());
}

TEST(Uim342Decoder, BytesInPiecesAndBetweenGarbage) {
    LineDecoder d(LineKind::bytes);
    const auto good = to_uimessage(message(5, 0x97), CrcMode::twelve);
    auto bad = good;
    bad[13] ^= 0xFF;
    std::vector<std::uint8_t> s{0x01, 0x02};
    s.insert(s.end(), good.begin(), good.end());
    s.insert(s.end(), bad.begin(), bad.end());
    s.insert(s.end(), good.begin(), good.end());
    s.insert(s.end(), {0xAA, 0x05});
    std::vector<std::string> lines;
    for (const auto b : s) {
        for (auto& l : d.on_frame(Frame::run(std::array<std::uint8_t, 1>{b}), true))
            lines.push_back(std::move(l));
    }
    for (auto& l : d.finish())
        lines.push_back(std::move(l));
    ASSERT_EQ(lines.size(), 5u);
    EXPECT_NE(lines[0].find("2 bytes that are no UIMessage"), std::string::npos) << lines[0];
    EXPECT_NE(lines[1].find("ST"), std::string::npos);
    EXPECT_NE(lines[2].find("wrong CRC"), std::string::npos) << lines[2];
    EXPECT_NE(lines[3].find("ST"), std::string::npos);
    EXPECT_NE(lines[4].find("the first 2 of the 16 bytes of a UIMessage that had not ended"), std::string::npos) << lines[4];
    EXPECT_TRUE(d.finish().empty()) << "told once";
}

// A bounded recording gives the last runs: it begins, and ends, anywhere in a message.
TEST(Uim342Decoder, ARecordingCutAtAnyByteIsReadAndNothingOfItIsStrange) {
    std::vector<std::uint8_t> all;
    const auto data = std::array<std::uint8_t, 4>{0xAA, 0x01, 0xCC, 0xAA};  // start and end bytes among the data
    for (const Message& m : {message(5, 0x97), message(6, 0x95, data), message(5, 0x15, std::array<std::uint8_t, 1>{1})})
        std::ranges::copy(to_uimessage(m, CrcMode::twelve), std::back_inserter(all));
    const auto decoded = [&](std::size_t first, std::size_t last) {
        LineDecoder d(LineKind::bytes);
        std::vector<std::string> lines;
        for (std::size_t i = first; i < last; ++i)
            std::ranges::move(d.on_frame(Frame::run(std::array<std::uint8_t, 1>{all[i]}), false), std::back_inserter(lines));
        std::ranges::move(d.finish(), std::back_inserter(lines));
        return lines;
    };
    for (std::size_t first = 0; first < all.size(); ++first) {
        for (std::size_t last = first + 1; last <= all.size(); ++last) {
            for (const auto& l : decoded(first, last))
                EXPECT_EQ(l.find("unknown"), std::string::npos) << first << ".." << last << " " << l;
        }
        if (first >= 2 * uimessage_size) continue;
        const auto lines = decoded(first, all.size());
        EXPECT_EQ(lines.front().find("the end of a UIMessage that began before the recording") != std::string::npos,
                  first % uimessage_size != 0)
            << first << " " << lines.front();
        EXPECT_EQ(lines.size(), 3 - first / uimessage_size) << first;
    }
    LineDecoder d(LineKind::bytes);
    const auto whole = std::span(all).first(uimessage_size);
    EXPECT_EQ(d.on_frame(Frame::run(whole), true).size(), 1u);
    EXPECT_TRUE(d.on_frame(Frame::run(std::array<std::uint8_t, 2>{0x01, 0xCC}), true).empty());
    EXPECT_NE(d.on_frame(Frame::run(whole), true).front().find("unknown: 2 bytes"), std::string::npos)
        << "after a message they are strange";
}

TEST(Uim342Decoder, GarbageIsBounded) {
    LineDecoder d(LineKind::bytes);
    std::size_t lines = 0;
    for (int i = 0; i < 1000; ++i)
        lines += d.on_frame(Frame::run(std::array<std::uint8_t, 1>{0x11}), true).size();
    EXPECT_EQ(lines, 15u);
}

/// Every golden message has a line, and none of them is called unknown except those that are about something unknown.
TEST(Uim342Decoder, EveryGoldenMessageIsReadable) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/adapters/uim342/vectors.txt");
    std::string line, name;
    int n = 0;
    while (std::getline(file, line)) {
        std::istringstream in(line);
        std::string word, id;
        if (!(in >> word)) continue;
        if (word == "case") in >> name;
        if ((word != "can>" && word != "can<") || line.find("xx") != std::string::npos) continue;
        in >> id;
        std::vector<std::uint8_t> data;
        for (std::string b; in >> b;)
            data.push_back(static_cast<std::uint8_t>(std::stoul(b, nullptr, 16)));
        LineDecoder d(LineKind::can);
        const auto lines = d.on_frame(Frame::can_extended(static_cast<std::uint32_t>(std::stoul(id, nullptr, 16)), data), std::nullopt);
        ASSERT_EQ(lines.size(), 1u);
        const bool strange = lines[0].find("unknown") != std::string::npos || lines[0].find("does not") != std::string::npos;
        if (strange) {
            EXPECT_TRUE(name.find("error") != std::string::npos || name.find("printed") != std::string::npos ||
                        name.find("unknown") != std::string::npos)
                << name << ": " << lines[0];
        }
        ++n;
    }
    EXPECT_GE(n, 200);
}

TEST(Uim342Family, OffersEverything) {
    const Family& f = family_uim342();
    EXPECT_EQ(f.name, "uim342");
    EXPECT_TRUE(f.uses_can && f.uses_bytes);
    EXPECT_EQ(f.check_address(f.factory_address), "");
    EXPECT_EQ(f.default_bit_rate, 57600u);
    EXPECT_EQ(f.default_format, "8N1");
}

}  // namespace
}  // namespace axisgate::uim342
