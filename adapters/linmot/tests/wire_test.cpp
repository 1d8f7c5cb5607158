// The wire format of LinRS: every printed telegram of vectors.txt must be found, unpacked, and packed to the same bytes; bytes that belong
// to no telegram must be reported.
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "adapters/linmot/decoder.hpp"
#include "adapters/linmot/motion_commands.hpp"
#include "adapters/linmot/tests/page.hpp"
#include "adapters/linmot/tests/vectors.hpp"
#include "adapters/linmot/wire.hpp"

namespace axisgate::linmot {
namespace {
using test::cases;

struct Received {
    std::vector<Telegram> telegrams;
    std::vector<std::string> junk;
    std::size_t junk_bytes = 0;
};
Received frame(std::span<const std::uint8_t> bytes, std::size_t piece, const ChecksumRule& rule = {}) {
    Received h;
    Framer f;
    f.set(rule);
    while (!bytes.empty()) {
        const auto n = std::min(piece, bytes.size());
        f.push(
            bytes.first(n), [&](const Telegram& t, std::span<const std::uint8_t>) { h.telegrams.push_back(t); },
            [&](std::span<const std::uint8_t> b, std::string_view why) {
                h.junk.emplace_back(why);
                h.junk_bytes += b.size();
            });
        bytes = bytes.subspan(n);
    }
    return h;
}

TEST(LinmotWire, EveryPrintedTelegramIsOneAndPacksToItself) {
    std::size_t telegrams = 0;
    std::vector<std::uint8_t> all;
    for (const auto& c : cases()) {
        for (const auto& x : c.exchanges) {
            for (const auto& bytes : {x.request, x.answer}) {
                for (const std::size_t piece : {std::size_t{1}, bytes.size()}) {
                    const auto h = frame(bytes, piece);
                    ASSERT_EQ(h.telegrams.size(), 1u) << c.name;
                    EXPECT_TRUE(h.junk.empty()) << c.name;
                    EXPECT_EQ(h.telegrams[0].id, 0x11) << c.name;
                    EXPECT_EQ(pack(h.telegrams[0], {}), bytes) << c.name;
                }
                ++telegrams;
                all.insert(all.end(), bytes.begin(), bytes.end());
            }
        }
    }
    EXPECT_EQ(telegrams, 86u);
    EXPECT_EQ(frame(all, 7).telegrams.size(), telegrams) << "glued and cut, they are the same";
}

TEST(LinmotWire, FieldsOfThePrintedAnswers) {
    std::size_t fields = 0;
    for (const auto& c : cases()) {
        for (const auto& x : c.exchanges) {
            if (x.fields.empty()) continue;
            const Telegram t = frame(x.answer, 64).telegrams.at(0);
            const auto s = status_of(t);
            const auto a = config_of(t);
            for (const auto& [name, value] : x.fields) {
                ++fields;
                std::int64_t is = -1;
                if (name == "comm")
                    is = t.storage[0];
                else if (name == "status")
                    is = s->status;
                else if (name == "state")
                    is = s->state();
                else if (name == "sub")
                    is = s->sub_state();
                else if (name == "count")
                    is = s->sub_state() & 0x0F;
                else if (name == "position")
                    is = s->position;
                else if (name == "index")
                    is = a->index;
                else if (name == "value")
                    is = a->value;
                EXPECT_EQ(is, value) << c.name << " " << name;
            }
        }
    }
    EXPECT_GT(fields, 40u);
}

TEST(LinmotWire, StateEightSaysTheSameTwice) {
    // Flags of the StateVar's low byte and bits 8, 13, 10 and 11 of the status word, in every printed answer of state 8.
    std::size_t seen = 0;
    for (const auto& c : cases()) {
        for (const auto& x : c.exchanges) {
            const auto s = status_of(frame(x.answer, 64).telegrams.at(0));
            if (!s || frame(x.answer, 64).telegrams[0].sub != 0 || s->state() != state::enabled) continue;
            EXPECT_EQ((s->sub_state() >> 4 & 1) != 0, s->bit(8)) << c.name;
            EXPECT_EQ((s->sub_state() >> 5 & 1) != 0, s->bit(bit::moving)) << c.name;
            EXPECT_EQ((s->sub_state() >> 6 & 1) != 0, s->bit(bit::in_target)) << c.name;
            EXPECT_EQ((s->sub_state() >> 7 & 1) != 0, s->bit(bit::homed)) << c.name;
            ++seen;
        }
    }
    EXPECT_GE(seen, 3u);
}

TEST(LinmotWire, WhatIsNoTelegramIsGivenAway) {
    const auto good = test::bytes_of("01 11 03 02 01 00 04");
    for (const auto* bad : {"01 11 01 02 01 04", "01 11 40 02 01 00 04", "01 11 03 02 01 00 05", "01 11 03 03 01 00 04", "FF 00 04",
                            "02 04 04", "01 01 01"}) {
        auto bytes = test::bytes_of(bad);
        bytes.insert(bytes.end(), good.begin(), good.end());
        const auto h = frame(bytes, 3);
        EXPECT_EQ(h.telegrams.size(), 1u) << bad << ": the next one is found";
        EXPECT_FALSE(h.junk.empty()) << bad;
        EXPECT_EQ(h.junk_bytes + good.size(), bytes.size()) << bad;
    }
    Framer f;
    std::string why;
    f.push(std::span(good).first(5), [](const Telegram&, std::span<const std::uint8_t>) { FAIL(); }, {});
    EXPECT_TRUE(f.pending());
    f.reset([&](std::span<const std::uint8_t> b, std::string_view w) { why = std::string(w) + std::to_string(b.size()); });
    EXPECT_EQ(why, "a telegram that does not end5");
}

TEST(LinmotWire, ChecksumsAreTheCandidatesOfThePage) {
    const auto bytes = test::bytes_of("01 11 05 02 00 01 00 00");
    using Kind = ChecksumRule::Kind;
    const auto of = [&](Kind kind, std::uint8_t from, std::uint16_t start) { return checksum(bytes, {kind, from, start}); };
    EXPECT_EQ(of(Kind::sum, 0, 0), 0x001A);
    EXPECT_EQ(of(Kind::sum, 3, 0), 0x0003);
    EXPECT_EQ(of(Kind::crc, 0, 0x0000), 0xF87B);
    EXPECT_EQ(of(Kind::crc, 0, 0xFFFF), 0xC945);
    EXPECT_EQ(of(Kind::crc, 3, 0x0000), 0x73B3);
    EXPECT_EQ(of(Kind::crc, 3, 0xFFFF), 0x62BF);
    EXPECT_EQ(of(Kind::crc_reflected, 0, 0x0000), 0xF370);
    EXPECT_EQ(of(Kind::crc_reflected, 0, 0xFFFF), 0x8FFC);
    EXPECT_EQ(of(Kind::crc_reflected, 3, 0x0000), 0x4C54);
    EXPECT_EQ(of(Kind::crc_reflected, 3, 0xFFFF), 0x7CDC);
    for (const Kind kind : {Kind::sum, Kind::crc, Kind::crc_reflected}) {
        const ChecksumRule rule{kind, 0, 0xFFFF};
        const Telegram t = request16(0x11, Main::control_word, 0, 0x083F);
        auto whole = pack(t, rule);
        EXPECT_EQ(whole.size(), wire_size(2, rule));
        EXPECT_EQ(frame(whole, 4, rule).telegrams.at(0), t);
        whole[6] ^= 1;
        EXPECT_TRUE(frame(whole, 4, rule).telegrams.empty());
    }
}

TEST(LinmotMotions, AllOfTheCatalogueAndBack) {
    const Motions motions(test::page());
    EXPECT_EQ(motions.size(), 216u);
    std::size_t inferred = 0;
    for (const auto& c : test::page().commands()) {
        const Motion* m = motions.named(c.id);
        if (!m) continue;
        inferred += m->inferred;
        EXPECT_EQ(motions.named(c.name), m) << c.id;
        EXPECT_EQ(motions.of_header(static_cast<std::uint16_t>(m->header | 7)), m);
        std::vector<Value> values;
        std::int64_t n = 3;
        for (const auto& a : c.arguments)
            values.emplace_back(a.type == ValueType::i32 || a.type == ValueType::i16 ? -(n += 7) : (n += 11));
        const auto bytes = Motions::pack(*m, 0x15, values);
        EXPECT_EQ(bytes[0] & 0x0F, 5) << "the count is a nibble";
        EXPECT_LE(bytes.size(), 32u) << c.id << ": the buffer has 16 words";
        EXPECT_EQ(Motions::unpack(*m, bytes), values) << c.id;
        if (!c.arguments.empty()) EXPECT_FALSE(Motions::unpack(*m, std::span(bytes).first(bytes.size() - 1)));
        EXPECT_NE(motions.describe(bytes).find(c.name), std::string::npos);
    }
    EXPECT_EQ(inferred, 8u);
    EXPECT_EQ(motions.named("nothing"), nullptr);
    EXPECT_EQ(motions.of_header(0x0050), nullptr);
}

TEST(LinmotMotions, PrintedCommandsByName) {
    const Motions motions(test::page());
    const auto whole = [&](const char* name, std::uint8_t count, std::vector<Value> values) {
        Telegram t = request(0x11, Main::motion, 0);
        for (const auto b : Motions::pack(*motions.named(name), count, values))
            t.add(b);
        return pack(t, {});
    };
    const auto find = [](const char* name) {
        for (const auto& c : cases()) {
            if (c.name == name) return c.exchanges[0].request;
        }
        return std::vector<std::uint8_t>();
    };
    EXPECT_EQ(whole("Predef VAI Go To Pos", 2, {std::int64_t{0}}), find("LR-03"));
    EXPECT_EQ(whole("VAI Go To Pos", 3, {std::int64_t{150000}, std::int64_t{1000000}, std::int64_t{1000000}, std::int64_t{1000000}}),
              find("LR-04"));
    EXPECT_EQ(whole("VAI Go To Pos", 4, {std::int64_t{-50000}, std::int64_t{1000000}, std::int64_t{1000000}, std::int64_t{1000000}}),
              find("LR-05"));
}

TEST(LinmotDecoder, NamesTheMotionCommandAndWhatTheDriveSays) {
    LineDecoder d(test::page());
    const auto line = [&](const char* bytes, std::optional<bool> to_drive) {
        const auto lines = d.on_frame(Frame::run(test::bytes_of(bytes)), to_drive);
        return lines.size() == 1 ? lines[0] : "lines: " + std::to_string(lines.size());
    };
    EXPECT_NE(line("01 11 15 02 00 02 03 01 F0 49 02 00 40 42 0F 00 40 42 0F 00 40 42 0F 00 04", true)
                  .find("VAI Go To Pos (010xh), count 3: position 15 mm, velocity 1 m/s, acceleration 10 m/s^2, deceleration 10 m/s^2"),
              std::string::npos);
    EXPECT_NE(
        line("01 11 0C 02 00 00 00 37 28 A2 08 5E 81 01 00 04", false).find("operation enabled, count 2, position 9.8654 mm, status 2837h"),
        std::string::npos);
    EXPECT_NE(line("01 11 05 02 00 01 3F 08 04", std::nullopt)
                  .find("control word 083Fh: switch_on voltage_enable not_quick_stop enable_operation not_abort not_freeze home (direction "
                        "by its form)"),
              std::string::npos);
    EXPECT_NE(line("01 11 0C 02 00 00 00 08 00 86 04 00 00 00 00 04", false).find("error 86h (Motion Cmd In Wrong St)"), std::string::npos);
    EXPECT_NE(line("01 11 05 02 00 05 A6 13 04", true).find("reads the ROM value of 13A6h (max_current_a)"), std::string::npos);
    EXPECT_NE(line("01 11 05 02 05 08 01 00 04", true).find("command table message 05h, entry 1 [inferred]"), std::string::npos);
    EXPECT_EQ(line("01 11 05 02 07 08 00 00 04", true).find("[inferred]"), std::string::npos) << "printed, LR-21";
    EXPECT_NE(line("FF 05", true).find("unknown: no telegram begins here"), std::string::npos);
    (void)d.on_frame(Frame::run(test::bytes_of("01 11 0C")), false);
    EXPECT_EQ(d.finish().size(), 1u);
    for (const auto& c : cases()) {
        for (const auto& x : c.exchanges) {
            for (const bool to : {true, false}) {
                const auto lines = d.on_frame(Frame::run(to ? x.request : x.answer), to);
                ASSERT_EQ(lines.size(), 1u);
                EXPECT_EQ(lines[0].find("unknown"), std::string::npos) << lines[0];
            }
        }
    }
}

// A bounded recording has the last runs: it begins and ends anywhere in a telegram.
TEST(LinmotDecoder, ARecordingCutAtAnyByteIsReadAndNothingOfItIsStrange) {
    const auto one = test::bytes_of("01 11 15 02 00 02 03 01 F0 49 02 00 40 42 0F 04 40 42 0F 00 40 42 0F 00 04");  // 01 and 04 in it
    const auto two = test::bytes_of("01 11 05 02 00 01 3F 08 04"), three = test::bytes_of("01 11 05 02 00 05 A6 13 04");
    std::vector<std::uint8_t> all;
    std::vector<std::size_t> begins;
    for (const auto& t : {one, two, three}) {
        begins.push_back(all.size());
        all.insert(all.end(), t.begin(), t.end());
    }
    const auto decoded = [&](std::size_t first, std::size_t last) {
        LineDecoder d(test::page());
        std::vector<std::string> lines;
        for (std::size_t i = first; i < last; ++i)
            std::ranges::move(d.on_frame(Frame::run(std::array<std::uint8_t, 1>{all[i]}), true), std::back_inserter(lines));
        std::ranges::move(d.finish(), std::back_inserter(lines));
        return lines;
    };
    for (std::size_t first = 0; first < all.size(); ++first) {
        for (std::size_t last = first + 1; last <= all.size(); ++last) {
            for (const auto& l : decoded(first, last))
                EXPECT_EQ(l.find("unknown: "), std::string::npos) << first << ".." << last << " " << l;
        }
        if (first >= begins[2]) continue;
        const auto lines = decoded(first, all.size());
        EXPECT_EQ(lines.front().find("the end of a telegram that began before the recording") == std::string::npos,
                  std::ranges::find(begins, first) != begins.end())
            << first << " " << lines.front();
        EXPECT_EQ(lines.size(), first < begins[1] ? 3u : 2u) << first;
    }
    LineDecoder d(test::page());
    EXPECT_EQ(d.on_frame(Frame::run(two), true).size(), 1u);
    EXPECT_NE(d.on_frame(Frame::run(test::bytes_of("05 04")), true).at(0).find("unknown: no telegram begins here"), std::string::npos);
    LineDecoder noise(test::page());
    std::size_t reported = 0;
    for (int i = 0; i < 100; ++i)
        reported += noise.on_frame(Frame::run(test::bytes_of("05 04")), false).size();
    EXPECT_EQ(reported, 100u) << "no telegram is so long: all are strange";
}

}  // namespace
}  // namespace axisgate::linmot
