// The twin's reading of identifiers, UIMessages and the CRC against the manual's and independently computed figures.
// In: golden bytes. Out: telegrams, answers.
// Never runs the adapter.
#include "adapters/uim342/twin/wire.hpp"

#include <random>

#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

using twin::can_id;
using twin::consumer_of;
using twin::crc16;

TEST(TwinWire, IdentifiersOfTheManualAndDerivedOnes) {
    struct Case {
        unsigned producer, consumer, cw;
        std::uint32_t id;
    };
    const Case cases[] = {
        {4, 5, 0x95, 0x04280095},   {4, 5, 0x9D, 0x0428009D},  {4, 5, 0xA0, 0x042800A0},  {5, 4, 0x15, 0x05200015},
        {5, 4, 0x2E, 0x0520002E},   {5, 4, 0x0F, 0x0520000F},  {4, 37, 0x95, 0x04284095}, {4, 69, 0x95, 0x04288095},
        {4, 126, 0x95, 0x04F0C095}, {4, 32, 0x8B, 0x0400408B}, {37, 4, 0x15, 0x05210015}, {126, 4, 0x5A, 0x1E23005A},
        {4, 0, 0x16, 0x04000016},   {4, 10, 0x16, 0x04500016},
    };
    for (const Case& c : cases) {
        const auto id =
            can_id(static_cast<std::uint8_t>(c.producer), static_cast<std::uint8_t>(c.consumer), static_cast<std::uint8_t>(c.cw));
        EXPECT_EQ(id, c.id) << std::hex << id << " for " << std::dec << c.producer << " -> " << c.consumer;
        EXPECT_EQ(consumer_of(c.id), c.consumer);
        const auto t = twin::read_can(Frame::can_extended(c.id, no_data));
        ASSERT_TRUE(t);
        EXPECT_EQ(t->producer, c.producer);
        EXPECT_EQ(t->consumer, c.consumer);
        EXPECT_EQ(t->cw, c.cw);
    }
    for (unsigned p = 0; p < 128; ++p) {
        for (unsigned c = 0; c < 128; ++c) {
            const auto t =
                twin::read_can(Frame::can_extended(can_id(static_cast<std::uint8_t>(p), static_cast<std::uint8_t>(c), 0xFF), no_data));
            ASSERT_TRUE(t && t->producer == p && t->consumer == c && t->cw == 0xFF);
            if (p == 4) {
                ASSERT_EQ(can_id(4, static_cast<std::uint8_t>(c), 0x91), host_id(c, 0x91));
            }
        }
    }
}

TEST(TwinWire, FramesThatAreNotOursAreSilentlyIgnored) {
    Bench b;
    const std::vector<std::uint8_t> one{1};
    Frame good = Frame::can_extended(0x04280095, one);
    Frame base = good;
    base.extended = false;
    Frame remote = good;
    remote.remote = true;
    Frame controller = good;
    controller.kind = Frame::Kind::can_error;
    for (const Frame& f : {base, remote, controller, Frame::run(one)})
        EXPECT_TRUE(b.frame(f).empty());
    for (int bit : {18, 8, 9, 10, 11, 12, 13})
        EXPECT_TRUE(b.frame(Frame::can_extended(0x04280095u | (1u << bit), one)).empty()) << bit;
    EXPECT_EQ(b.ask("95"), "15 00");  // none of them switched the driver on
    EXPECT_EQ(b.frame(good), Lines{"15 01"});
}

TEST(TwinWire, CrcFigures) {
    const std::string check = "123456789";
    EXPECT_EQ(crc16({reinterpret_cast<const std::uint8_t*>(check.data()), check.size()}), 0x4B37);
    struct Case {
        const char* thirteen;
        unsigned crc13;
    };
    const Case cases[] = {{"AA 05 95 01 01 00 00 00 00 00 00 00 00", 0xD727}, {"AA 05 15 01 01 00 00 00 00 00 00 00 00", 0x158E},
                          {"AA 05 96 00 00 00 00 00 00 00 00 00 00", 0xC674}, {"AA 05 9D 04 18 FC FF FF 00 00 00 00 00", 0x26AE},
                          {"AA 05 AD 04 E9 03 00 00 00 00 00 00 00", 0xB60C}, {"AA 00 16 00 00 00 00 00 00 00 00 00 00", 0x08D1},
                          {"00 00 00 00 00 00 00 00 00 00 00 00 00", 0xEB03}};
    for (const Case& c : cases)
        EXPECT_EQ(crc16(hex(c.thirteen)), c.crc13) << c.thirteen;
}

/// A drive on a byte line; what it sends is one long run of bytes.
struct ByteBench {
    explicit ByteBench(const std::string& crc = {}, const std::string& address = "5") {
        TwinSetup s;
        s.address = address;
        s.kind = LineKind::bytes;
        if (!crc.empty()) s.options["crc"] = crc;
        drive = make(s);
        Out out;
        drive->power_on({}, now, out);
    }
    std::string send(std::string_view bytes, std::size_t piece = 256) {
        const auto all = hex(bytes);
        return send(all, piece);
    }
    std::string send(std::span<const std::uint8_t> all, std::size_t piece = 256) {
        std::vector<std::uint8_t> answer;
        while (!all.empty()) {
            const auto n = std::min(piece, all.size());
            Out out;
            drive->on_frame(Frame::run(all.first(n)), now, out);
            for (const auto& tx : out.frames) {
                EXPECT_EQ(tx.frame.kind, Frame::Kind::bytes);
                answer.insert(answer.end(), tx.frame.data().begin(), tx.frame.data().end());
            }
            all = all.subspan(n);
        }
        return text(answer);
    }
    std::unique_ptr<Twin> drive;
    Instant now = time_zero;
};

constexpr const char* mo_on_12 = "AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 95 CC";
constexpr const char* mo_on_12_ack = "AA 05 15 01 01 00 00 00 00 00 00 00 00 71 57 CC";
constexpr const char* mo_on_13 = "AA 05 95 01 01 00 00 00 00 00 00 00 00 27 D7 CC";
constexpr const char* mo_on_13_ack = "AA 05 15 01 01 00 00 00 00 00 00 00 00 8E 15 CC";
constexpr const char* mo_on_plain = "AD 05 95 01 01 00 00 00 00 00 00 00 00 00 00 CC";
constexpr const char* mo_on_plain_ack = "AD 05 15 01 01 00 00 00 00 00 00 00 00 00 00 CC";

TEST(TwinBytes, GoldenExchangesWithTwelveByteCrc) {
    ByteBench b;
    EXPECT_EQ(b.send("AA 05 A1 00 00 00 00 00 00 00 00 00 00 6E F0 CC"), "AA 05 21 00 00 00 00 00 00 00 00 00 00 C7 32 CC");
    EXPECT_EQ(b.send(mo_on_12), mo_on_12_ack);
    EXPECT_EQ(b.send("AA 00 16 00 00 00 00 00 00 00 00 00 00 2E 4A CC"), "");  // BG to all, no acknowledgement
    const auto jv = hex(b.send("AA 05 9D 04 18 FC FF FF 00 00 00 00 00 51 64 CC"));
    ASSERT_EQ(jv.size(), 16u);
    EXPECT_EQ(text(std::span(jv).first(13)), "AA 05 2E 05 02 18 FC FF FF 00 00 00 00");
    const auto bg = hex(b.send("AA 05 96 00 00 00 00 00 00 00 00 00 00 8B 84 CC"));
    ASSERT_EQ(bg.size(), 16u);
    EXPECT_EQ(text(std::span(bg).first(8)), "AA 05 16 04 00 00 00 00");
    EXPECT_EQ(bg[15], 0xCC);
}

TEST(TwinBytes, CrcRangeIsASettingAndAnswersComeAsTheyWereAsked) {
    struct Case {
        const char* option;
        bool takes12, takes13;
    };
    for (const Case& c : {Case{"", true, true}, Case{"12", true, false}, Case{"13", false, true}, Case{"auto", true, true}}) {
        EXPECT_EQ(ByteBench(c.option).send(mo_on_12), c.takes12 ? mo_on_12_ack : "") << c.option;
        EXPECT_EQ(ByteBench(c.option).send(mo_on_13), c.takes13 ? mo_on_13_ack : "") << c.option;
        EXPECT_EQ(ByteBench(c.option).send(mo_on_plain), mo_on_plain_ack) << c.option;
    }
    ByteBench mixed("auto");
    EXPECT_EQ(mixed.send(std::string(mo_on_12) + " " + mo_on_13 + " " + mo_on_plain),
              std::string(mo_on_12_ack) + " " + mo_on_13_ack + " " + mo_on_plain_ack);
}

TEST(TwinBytes, NotificationsFollowTheHostsForm) {
    ByteBench b("auto");
    const auto edge = [&](int level) {
        Out out;
        EXPECT_EQ(b.drive->set_hand("inputs", Value{std::int64_t{level}}, b.now, out), "");
        EXPECT_EQ(out.frames.size(), 1u);
        return out.frames.empty() ? std::string() : text(out.frames[0].frame.data());
    };
    EXPECT_EQ(edge(1).substr(0, 14), "AA 05 5A 01 02");  // nobody has spoken yet: CRC form
    (void)b.send(mo_on_plain);
    EXPECT_EQ(edge(0), "AD 05 5A 01 01 00 00 00 00 00 00 00 00 00 00 CC");
    (void)b.send("AD 06 95 01 01 00 00 00 00 00 00 00 00 00 00 CC");  // another drive was spoken to: same host
    EXPECT_EQ(edge(1), "AD 05 5A 01 02 00 00 00 00 00 00 00 00 00 00 CC");

    // Before anybody has spoken: as the setting has it.
    const std::pair<const char*, const char*> first[] = {{"12", "AA 05 5A 01 02 00 00 00 00 00 00 00 00 00 72 CC"},
                                                         {"auto", "AA 05 5A 01 02 00 00 00 00 00 00 00 00 00 72 CC"},
                                                         {"13", "AA 05 5A 01 02 00 00 00 00 00 00 00 00 FF 30 CC"},
                                                         {"none", "AD 05 5A 01 02 00 00 00 00 00 00 00 00 00 00 CC"}};
    for (const auto& [option, notification] : first) {
        ByteBench fresh(option);
        Out out;
        EXPECT_EQ(fresh.drive->set_hand("inputs", Value{std::int64_t{1}}, fresh.now, out), "");
        ASSERT_EQ(out.frames.size(), 1u);
        EXPECT_EQ(text(out.frames[0].frame.data()), notification) << option;
    }
    EXPECT_EQ(ByteBench("none").send(mo_on_12), mo_on_12_ack);
}

TEST(TwinBytes, BadCrcBadEndAndOtherNodesAreIgnored) {
    ByteBench b;
    EXPECT_EQ(b.send("AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 96 CC"), "");
    EXPECT_EQ(b.send("AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 95 CD"), "");
    EXPECT_EQ(b.send("AD 06 95 01 01 00 00 00 00 00 00 00 00 00 00 CC"), "");
    EXPECT_EQ(b.send("AD 05 95 00 00 00 00 00 00 00 00 00 00 00 00 CC"), "AD 05 15 01 00 00 00 00 00 00 00 00 00 00 00 CC");
}

TEST(TwinBytes, FillerAndAuxiliaryByteDoNotMatterWithoutCrc) {
    ByteBench b;
    EXPECT_EQ(b.send("AD 05 95 01 01 FF FF FF FF FF FF FF 77 12 34 CC"), mo_on_plain_ack);
}

TEST(TwinBytes, LengthAboveEightIsASyntaxErrorWhereTheCrcProvesTheFrame) {
    ByteBench b;
    std::vector<std::uint8_t> m = hex("AA 05 95 09 01 00 00 00 00 00 00 00 00 00 00 CC");
    const auto crc = crc16(std::span(m).subspan(1, 12));
    m[13] = static_cast<std::uint8_t>(crc);
    m[14] = static_cast<std::uint8_t>(crc >> 8);
    EXPECT_EQ(b.send(m).substr(0, 29), "AA 05 0F 06 00 32 95 00 00 00");
}

TEST(TwinBytes, EveryCutIsPutTogether) {
    for (std::size_t piece = 1; piece <= 33; ++piece) {
        ByteBench b;
        EXPECT_EQ(b.send(std::string(mo_on_12) + " " + mo_on_plain + " " + mo_on_12, piece),
                  std::string(mo_on_12_ack) + " " + mo_on_plain_ack + " " + mo_on_12_ack)
            << piece;
    }
}

TEST(TwinBytes, GarbageBeforeAFrameNeverCostsTheFrame) {
    // One byte of every value, then the traps: start bytes, half a frame, a frame with a bad CRC, BL (CW AD), data AA AD CC.
    for (int g = 0; g < 256; ++g) {
        ByteBench b;
        std::vector<std::uint8_t> all{static_cast<std::uint8_t>(g)};
        for (const auto x : hex(mo_on_12))
            all.push_back(x);
        for (const auto x : hex(mo_on_12))
            all.push_back(x);
        EXPECT_EQ(b.send(all, 7), std::string(mo_on_12_ack) + " " + mo_on_12_ack) << g;
    }
    const char* const traps[] = {"AA AA AA",
                                 "AD AD",
                                 "AA 05 95 01 01 00 00 00 00 00",
                                 "AA 05 95 01 01 00 00 00 00 00 00 00 00 D8 96 CC",
                                 "CC",
                                 "AA 05 AD 04 AA AD CC 00 00",
                                 "AD AA AD AA AD AA AD AA AD AA AD AA AD AA AD AA AD"};
    for (const char* t : traps) {
        for (std::size_t piece : {1u, 5u, 16u, 256u}) {
            ByteBench b;
            EXPECT_EQ(b.send(std::string(t) + " " + mo_on_12 + " " + mo_on_12, piece), std::string(mo_on_12_ack) + " " + mo_on_12_ack) << t;
        }
    }
}

/// Without a CRC the ID and the length must be possible; else a stray AD before a frame whose byte 14 is CC would swallow it.
TEST(TwinBytes, StrayStartBeforeAFrameThatEndsLikeOne) {
    std::vector<std::uint8_t> m = hex("AA 05 9D 04 00 00 00 00 00 00 00 00 00 00 00 CC");
    for (int v = 0; m[14] != 0xCC; ++v) {
        ASSERT_LT(v, 65536);
        m[4] = static_cast<std::uint8_t>(v);
        m[5] = static_cast<std::uint8_t>(v >> 8);
        const auto crc = crc16(std::span(m).subspan(1, 12));
        m[13] = static_cast<std::uint8_t>(crc);
        m[14] = static_cast<std::uint8_t>(crc >> 8);
    }
    const std::string answer = ByteBench().send(m);
    EXPECT_EQ(answer.substr(0, 17), "AA 05 2E 05 02 " + text(std::span(m).subspan(4, 1)));
    m.insert(m.begin(), 0xAD);
    EXPECT_EQ(ByteBench().send(m), answer);
    // An impossible length, an impossible ID.
    ByteBench b;
    EXPECT_EQ(b.send("AD 05 95 09 01 00 00 00 00 00 00 00 00 00 00 CC"), "");
    EXPECT_EQ(b.send("AD 85 95 01 01 00 00 00 00 00 00 00 00 00 00 CC"), "");
    EXPECT_EQ(b.send(mo_on_plain), mo_on_plain_ack);
}

TEST(TwinBytes, StartAndEndBytesInsideAFrameAreData) {
    ByteBench b;
    // BL = 0xAA: control word AD, data AA; PA = CCADAACC as 32 bits.
    EXPECT_EQ(b.send("AD 05 AD 04 AA 00 00 00 00 00 00 00 00 00 00 CC"), "AD 05 2D 04 AA 00 00 00 00 00 00 00 00 00 00 CC");
    EXPECT_EQ(b.send("AD 05 A0 04 CC AA AD CC 00 00 00 00 00 00 00 CC AD 05 97 00 00 00 00 00 00 00 00 00 00 00 00 CC"),
              "AD 05 2E 05 04 CC AA AD CC 00 00 00 00 00 00 CC AD 05 17 00 00 00 00 00 00 00 00 00 00 00 00 CC");
}

TEST(TwinBytes, SeveralDrivesOnOneByteBusAnswerOnlyForThemselves) {
    ByteBench five;
    ByteBench six({}, "6");
    const std::string to6 = "AD 06 95 01 01 00 00 00 00 00 00 00 00 00 00 CC";
    const std::string both = std::string(mo_on_plain) + " " + to6;
    EXPECT_EQ(five.send(both), mo_on_plain_ack);
    EXPECT_EQ(six.send(both), "AD 06 15 01 01 00 00 00 00 00 00 00 00 00 00 CC");
    // The answers of the neighbour pass by and are nobody's instruction.
    EXPECT_EQ(six.send(mo_on_plain_ack), "");
}

TEST(TwinBytes, RandomBytesNeverCrashAndTheTwinStaysAnswerable) {
    std::mt19937 random(342);
    for (const char* crc : {"12", "13", "auto"}) {
        ByteBench b(crc);
        for (int round = 0; round < 300; ++round) {
            std::vector<std::uint8_t> noise(random() % 200 + 1);
            for (auto& x : noise) {
                const auto r = random();
                // Many start and end bytes, so that false frames are common.
                x = static_cast<std::uint8_t>((r & 7u) == 0 ? 0xAA : (r & 7u) == 1 ? 0xAD : (r & 7u) == 2 ? 0xCC : r >> 8);
            }
            (void)b.send(noise);
        }
        // Noise without a CRC may have renumbered the drive, so all are asked; a false start holds at most 15 bytes, so the answer
        // comes at the latest after two questions.
        std::string answer;
        for (int attempt = 0; attempt < 2 && answer.empty(); ++attempt)
            answer = b.send("AD 00 8B 00 00 00 00 00 00 00 00 00 00 00 00 CC");
        ASSERT_GE(answer.size(), 47u) << crc;
        EXPECT_EQ(answer.substr(answer.size() - 47, 2), "AD") << answer;
        EXPECT_EQ(answer.substr(answer.size() - 41, 17), "0B 08 20 0A 11 00") << answer;
    }
}

}  // namespace
}  // namespace axisgate::uim342::test
