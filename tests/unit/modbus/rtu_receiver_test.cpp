// Checksum, silence, half frames, garbage, echoes: bytes and virtual time in, frames out.
#include <gtest/gtest.h>

#include <vector>

#include "gateway/doors/modbus/rtu_receiver.hpp"
#include "tests/unit/modbus/fake_port.hpp"

namespace axisgate::modbus {
namespace rtu_receiver_test {
using namespace std::chrono_literals;
using test::bytes;
using test::hex;
using Bytes = std::vector<std::uint8_t>;

Bytes with_crc(std::string_view body) {
    Bytes b = bytes(body);
    const auto crc = rtu_crc(b);
    b.push_back(static_cast<std::uint8_t>(crc & 0xFF));
    b.push_back(static_cast<std::uint8_t>(crc >> 8));
    return b;
}

/// A line whose bytes come one after the other, as on a wire, with the receiver's owner.
struct Wire {
    explicit Wire(std::uint32_t baud = 19200, unsigned bits = 11) : receiver(RtuTiming::of(baud, bits)) {}
    void pass(Duration d) {
        const Instant until = now + d;
        while (receiver.deadline() <= until) {
            now = receiver.deadline();
            keep(receiver.on_silence(now));
        }
        now = until;
    }
    /// Byte by byte at the speed of the wire.
    void say(const Bytes& data) {
        for (const auto b : data) {
            pass(receiver.timing().character);
            keep(receiver.feed({&b, 1}, now));
        }
    }
    /// All at once, as an adapter delivers them.
    void burst(const Bytes& data) { keep(receiver.feed(data, now)); }
    void keep(const std::optional<RtuFrame>& f) {
        if (!f) return;
        Bytes b{f->address};
        b.insert(b.end(), f->pdu().begin(), f->pdu().end());
        frames.push_back(hex(b));
    }

    RtuReceiver receiver;
    Instant now = at_ns(1'000'000'000);
    std::vector<std::string> frames;
};

const std::string reading = "01 03 00 00 00 0A", other = "07 06 00 20 00 0F";

TEST(RtuReceiver, ChecksumsAreThoseOfTheSpecification) {
    EXPECT_EQ(rtu_crc(bytes("02 07")), 0x1241);              // the specification's own example: sent 41 12
    EXPECT_EQ(rtu_crc(bytes("01 03 00 00 00 0A")), 0xCDC5);  // sent C5 CD
    EXPECT_EQ(rtu_crc(bytes("11 03 00 6B 00 03")), 0x8776);
    EXPECT_EQ(rtu_crc({}), 0xFFFF);
}

TEST(RtuReceiver, PausesFollowTheBitRateUpTo19200AndAreFixedAbove) {
    const auto slow = RtuTiming::of(9600, 11);
    EXPECT_EQ(slow.character, Duration(1'145'833));
    EXPECT_EQ(slow.t15, Duration(1'718'750));
    EXPECT_EQ(slow.t35, Duration(4'010'416) + Duration(slow.t35.count() % 2 != 0 ? 1 : 0));
    const auto at_the_limit = RtuTiming::of(19200, 11);
    EXPECT_NEAR(static_cast<double>(at_the_limit.t35.count()), 2'005'208, 1);
    for (const std::uint32_t baud : {19201u, 38400u, 115200u, 1'000'000u}) {
        EXPECT_EQ(RtuTiming::of(baud, 11).t15, 750us) << baud;
        EXPECT_EQ(RtuTiming::of(baud, 10).t35, 1750us) << baud;
    }
}

TEST(RtuReceiver, AFrameEndsWithTheSilenceAndNotBefore) {
    Wire w;
    w.say(with_crc(reading));
    w.pass(w.receiver.timing().t35 - 1us);
    EXPECT_TRUE(w.frames.empty());
    EXPECT_TRUE(w.receiver.busy());
    w.pass(1us);
    EXPECT_EQ(w.frames, std::vector<std::string>{reading});
    EXPECT_FALSE(w.receiver.busy());
    EXPECT_EQ(w.receiver.deadline(), never);
}

TEST(RtuReceiver, TheLongestFrameIsTakenAndALongerRunIsNot) {
    std::string body = "01 10";
    for (int i = 0; i < 252; ++i)
        body += " 55";
    Wire w(115200);
    w.burst(with_crc(body));
    w.pass(2ms);
    EXPECT_EQ(w.frames, std::vector<std::string>{body});
    w.burst(with_crc(body + " 55"));
    w.pass(2ms);
    w.burst(Bytes(5000, 0x01));
    w.pass(2ms);
    EXPECT_EQ(w.frames.size(), 1u);
    EXPECT_EQ(w.receiver.counters().overlong.value(), 2u);
    w.say(with_crc(reading));
    w.pass(2ms);
    EXPECT_EQ(w.frames.back(), reading) << "the next one after the silence is good again";
}

TEST(RtuReceiver, HalfFramesGarbageAndWrongChecksumsAreForgottenWithTheSilence) {
    Wire w;
    const Bytes good = with_crc(reading);
    for (std::size_t n = 1; n < good.size(); ++n) {
        w.say(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(n)));
        w.pass(3ms);
        w.say(Bytes(good.begin() + static_cast<std::ptrdiff_t>(n), good.end()));  // the rest, too late
        w.pass(3ms);
        EXPECT_TRUE(w.frames.empty()) << n;
    }
    for (std::size_t bit = 0; bit < good.size() * 8; ++bit) {
        Bytes bad = good;
        bad[bit / 8] = static_cast<std::uint8_t>(bad[bit / 8] ^ (1u << bit % 8));
        w.say(bad);
        w.pass(3ms);
        EXPECT_TRUE(w.frames.empty()) << bit;
    }
    EXPECT_EQ(w.receiver.counters().bad_frames.value(), 2 * (good.size() - 1) + good.size() * 8);
    w.say(good);
    w.pass(3ms);
    EXPECT_EQ(w.frames.size(), 1u);
}

TEST(RtuReceiver, FramesOfOthersWithOnlyTheSilenceBetweenThemAreToldApart) {
    Wire w;
    for (int i = 0; i < 3; ++i) {
        w.say(with_crc(other));
        w.pass(w.receiver.timing().t35);
        w.say(with_crc(reading));
        w.pass(w.receiver.timing().t35);
    }
    EXPECT_EQ(w.frames, (std::vector<std::string>{other, reading, other, reading, other, reading}));
}

TEST(RtuReceiver, APauseWithinAFrameIsCountedAndTheChecksumDecides) {
    Wire w;
    const Bytes good = with_crc(reading);
    w.say(Bytes(good.begin(), good.begin() + 4));
    w.pass(w.receiver.timing().t15 + w.receiver.timing().character / 2);  // beyond t1.5, within t3.5
    w.say(Bytes(good.begin() + 4, good.end()));
    w.pass(3ms);
    EXPECT_EQ(w.frames.size(), 1u);
    EXPECT_EQ(w.receiver.counters().gaps.value(), 1u);
}

TEST(RtuReceiver, AThreadThatIsLateLosesNothing) {
    Wire w;
    const Bytes good = with_crc(reading);
    // The silence has passed unnoticed, and the next frame's bytes come first.
    w.burst(good);
    w.now += 10ms;
    w.burst(with_crc(other));
    EXPECT_EQ(w.frames, std::vector<std::string>{reading});
    w.pass(3ms);
    EXPECT_EQ(w.frames.size(), 2u);
    // The halves of one frame, delivered with a pause that was not on the wire, before the silence was evaluated.
    w.burst(Bytes(good.begin(), good.begin() + 3));
    w.now += 10ms;
    w.burst(Bytes(good.begin() + 3, good.end()));
    w.pass(3ms);
    EXPECT_EQ(w.frames.size(), 3u);
}

// --- echoes of the port's own bytes

const std::string answer = "01 03 02 12 34", writing = "01 06 00 20 00 0F";

TEST(RtuReceiver, AnEchoIsTakenOutInPiecesToo) {
    for (const bool at_once : {true, false}) {
        Wire w;
        w.receiver.sent(with_crc(answer), false, w.now);
        at_once ? w.burst(with_crc(answer)) : w.say(with_crc(answer));
        w.pass(5ms);
        w.say(with_crc(reading));
        w.pass(5ms);
        EXPECT_EQ(w.frames, std::vector<std::string>{reading});
        EXPECT_EQ(w.receiver.counters().echoes.value(), 1u);
        EXPECT_EQ(w.receiver.counters().bad_frames.value(), 0u);
    }
}

TEST(RtuReceiver, ARequestThatBeginsAsTheAnswerDidIsNoEcho) {
    Wire w;
    w.receiver.sent(with_crc(answer), false, w.now);  // 01 03 02 ...; the request 01 03 00 ...
    w.pass(5ms);
    w.say(with_crc(reading));
    w.pass(5ms);
    EXPECT_EQ(w.frames, std::vector<std::string>{reading});
    // The beginning of an echo, and then nothing more: garbage.
    w.receiver.sent(with_crc(answer), false, w.now);
    w.say(bytes("01 03 02"));
    w.pass(5ms);
    EXPECT_EQ(w.frames.size(), 1u);
    EXPECT_EQ(w.receiver.counters().bad_frames.value(), 1u);
}

TEST(RtuReceiver, WhereThePortIsKnownNotToEchoTheSameWriteMayComeAtOnce) {
    Wire w;
    w.receiver.sent(with_crc(answer), false, w.now);
    w.pass(5ms);
    w.say(with_crc(writing));  // a frame of the master and no echo: this port has none
    w.pass(2100us);
    w.receiver.sent(with_crc(writing), true, w.now);
    w.pass(5ms);
    w.say(with_crc(writing));
    w.pass(5ms);
    EXPECT_EQ(w.frames, (std::vector<std::string>{writing, writing}));
    EXPECT_EQ(w.receiver.counters().echoes.value(), 0u);
}

TEST(RtuReceiver, WhereNothingIsKnownTheSameWriteSoonIsAnEchoAndLaterARequest) {
    Wire w;
    w.receiver.sent(with_crc(writing), true, w.now);
    w.say(with_crc(writing));
    w.pass(5ms);
    EXPECT_TRUE(w.frames.empty());
    EXPECT_EQ(w.receiver.counters().echoes.value(), 1u);
    Wire v;
    v.receiver.sent(with_crc(writing), true, v.now);
    v.pass(100ms);
    v.say(with_crc(writing));
    v.pass(5ms);
    EXPECT_EQ(v.frames, std::vector<std::string>{writing});
}

TEST(RtuReceiver, AnEchoThatCameBackSpoiltTeachesNothing) {
    Wire w;
    Bytes spoilt = with_crc(answer);
    spoilt[3] = 0;
    w.receiver.sent(with_crc(answer), false, w.now);
    w.say(spoilt);
    w.pass(5ms);
    w.say(with_crc(writing));
    w.pass(3ms);
    w.receiver.sent(with_crc(writing), true, w.now);
    w.say(with_crc(writing));  // if it were taken for a request, it would be answered, and that answer again
    w.pass(5ms);
    EXPECT_EQ(w.frames, std::vector<std::string>{writing});
    EXPECT_EQ(w.receiver.counters().echoes.value(), 1u);
}

TEST(RtuReceiver, APortThatIsOpenedAnewBeginsAnew) {
    Wire w;
    w.say(bytes("01 03 00"));
    w.receiver.sent(with_crc(answer), false, w.now);
    w.receiver.reset();
    EXPECT_EQ(w.receiver.deadline(), never);
    w.say(with_crc(reading));
    w.pass(5ms);
    EXPECT_EQ(w.frames, std::vector<std::string>{reading});
}

}  // namespace rtu_receiver_test
}  // namespace axisgate::modbus
