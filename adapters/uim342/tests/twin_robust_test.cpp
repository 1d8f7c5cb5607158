// Seeded random traffic, hands and time against the twin's invariants; determinism; late callers; many drives at once.
// In: random frames. Out: nothing may crash, contradict itself or stop answering.
// Never depends on the wall clock but for one generous bound on CPU time.
#include <ctime>
#include <random>

#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

/// A frame that is mostly right, so that the drive gets somewhere, and sometimes anything at all.
Frame random_frame(std::mt19937& random) {
    struct Word {
        std::uint8_t cw;
        std::uint8_t dl;
        unsigned indices;  ///< sub-indices; 0: none
    };
    static constexpr Word words[] = {{0x15, 1, 0}, {0x15, 1, 0}, {0x16, 0, 0}, {0x16, 0, 0}, {0x16, 0, 0}, {0x17, 0, 0},  {0x18, 1, 0},
                                     {0x19, 4, 0}, {0x1A, 4, 0}, {0x1B, 4, 0}, {0x1C, 4, 0}, {0x1D, 4, 0}, {0x1E, 4, 0},  {0x1F, 4, 0},
                                     {0x20, 4, 0}, {0x21, 0, 0}, {0x2D, 4, 0}, {0x34, 3, 5}, {0x35, 3, 4}, {0x37, 4, 0},  {0x3D, 3, 6},
                                     {0x06, 3, 9}, {0x07, 3, 9}, {0x10, 3, 5}, {0x11, 1, 2}, {0x11, 2, 1}, {0x0F, 1, 20}, {0x2E, 1, 6}};
    const auto one_in = [&](unsigned n) { return random() % n == 0; };
    const Word& w = words[random() % std::size(words)];
    unsigned cw = w.cw;
    if (!one_in(4)) cw |= 0x80u;
    std::size_t dl = w.dl;
    std::array<std::uint8_t, 8> data{};
    const auto value = static_cast<std::uint32_t>(one_in(10) ? random() : one_in(3) ? random() % 64 : random() % 30000);
    const std::uint32_t with_sign = w.cw >= 0x1D && w.cw <= 0x20 && one_in(2) ? 0u - value : value;
    const std::size_t at = w.indices > 0 ? 1 : 0;
    data[0] = static_cast<std::uint8_t>(w.indices > 0 ? random() % w.indices : 0);
    for (std::size_t i = 0; i < 4; ++i)
        data[at + i] = static_cast<std::uint8_t>(with_sign >> (8 * i));
    if (w.cw == 0x15) data[0] = one_in(5) ? 0 : 1;
    if (w.cw == 0x18) data[0] = static_cast<std::uint8_t>(random() % 9);
    if (w.cw == 0x37) data = {static_cast<std::uint8_t>(random() % 2), 1};
    if (w.cw == 0x06 || w.cw == 0x07) data[1] = static_cast<std::uint8_t>(random() % 2), data[2] = 0;
    if (w.cw == 0x34 && data[0] < 3) {
        data[1] = static_cast<std::uint8_t>(random() % 12 | (one_in(3) ? 0u : 0x80u));
        data[2] = static_cast<std::uint8_t>(random() % 12 | (one_in(3) ? 0u : 0x80u));
    }
    if (w.cw == 0x35) data[2] = 0;
    if (one_in(60)) {
        cw = one_in(2) ? 0x7E : 0x01;
        dl = cw == 0x7E ? 1 : 2;
        data = {static_cast<std::uint8_t>(cw == 0x7E ? 1 + random() % 2 : 7 + random() % 2), static_cast<std::uint8_t>(random() % 130)};
    }
    if (one_in(20)) dl = random() % 9;
    if (one_in(40)) cw = random() & 0xFFu;
    Frame f = Frame::can_extended(host_id(0, cw), std::span(data).first(dl));
    if (one_in(50)) f.id = random() & 0x1FFFFFFFu;
    if (one_in(100)) f.extended = false;
    return f;
}

struct Happening {
    Instant at;
    std::string what;
    bool operator==(const Happening&) const = default;
};

/// Random traffic; `late`: deadlines are not served, the next frame finds them overdue.
std::vector<Happening> storm(unsigned seed, bool late, int rounds) {
    std::mt19937 random(seed);
    auto t = make(can_setup());
    std::vector<Happening> log;
    Instant now = time_zero;
    const auto take = [&](const Out& out) {
        for (const auto& tx : out.frames) {
            EXPECT_LE(tx.frame.at, now);
            log.push_back({tx.frame.at, to_text(tx.frame)});
        }
    };
    Out first;
    t->power_on({}, now, first);
    take(first);
    for (int i = 0; i < rounds; ++i) {
        const Instant next = now + Duration{static_cast<std::int64_t>(random() % 40'000'000)};
        while (!late && t->deadline() <= next) {
            now = std::max(now, t->deadline());
            Out out;
            t->on_deadline(now, out);
            take(out);
            EXPECT_GT(t->deadline(), now) << "what is due is done";
        }
        now = next;
        Out out;
        const auto what = random() % 40;
        if (what < 36) {
            t->on_frame(random_frame(random), now, out);
        } else if (what == 36) {
            (void)t->set_hand("inputs", Value{static_cast<std::int64_t>(random() % 8)}, now, out);
        } else if (what == 37) {
            (void)t->set_hand("stall", Value{random() % 3 == 0}, now, out);
        } else if (what == 38) {
            (void)t->set_hand("lost_pulses", Value{static_cast<std::int64_t>(random() % 60)}, now, out);
        } else {
            (void)t->set_hand(random() % 2 == 0 ? "encoder_error" : "battery_low", Value{random() % 2 == 0}, now, out);
        }
        take(out);
        EXPECT_GT(t->deadline(), now);

        // Invariants, by the wire: the whole status from everybody.
        Out status;
        t->on_frame(Frame::can_extended(host_id(0, 0x91), std::array<std::uint8_t, 1>{0}), now, status);
        t->on_frame(Frame::can_extended(host_id(0, 0x9D), no_data), now, status);
        EXPECT_EQ(status.frames.size(), 2u) << "the drive answers always";
        if (status.frames.size() != 2) return log;
        const auto ms = status.frames[0].frame.data();
        EXPECT_EQ(ms.size(), 8u);
        const auto jv = status.frames[1].frame.data();
        const bool turning = jv[0] != 0 || jv[1] != 0 || jv[2] != 0 || jv[3] != 0;
        const bool on = (ms[1] & 4u) != 0;
        const bool stop = (ms[2] & 1u) != 0;
        EXPECT_FALSE(turning && stop) << "STOP follows the speed";
        EXPECT_TRUE(on || stop || t->mechanics(1, now).velocity != 0) << "without the driver the shaft only runs out";
        EXPECT_EQ(ms[1] & 0x82u, 0u);
        EXPECT_EQ(ms[2] & 0x54u, 0u);
        EXPECT_EQ(ms[3], 0u);
        EXPECT_EQ(t->mechanics(1, now).powered, on);
        EXPECT_TRUE(std::isfinite(t->mechanics(1, now).position));
    }
    return log;
}

TEST(TwinRobust, RandomTrafficKeepsTheInvariants) {
    for (unsigned seed = 1; seed <= 12; ++seed) {
        SCOPED_TRACE(seed);
        const auto log = storm(seed, false, 2500);
        EXPECT_GT(log.size(), 1500u);
        if (HasFailure()) return;
    }
}

TEST(TwinRobust, TheSameCallsGiveTheSameResults) { EXPECT_EQ(storm(99, false, 800), storm(99, false, 800)); }

/// A caller that never serves a deadline still finds everything at its own instant, in order.
TEST(TwinRobust, EventsKeepTheirInstantsHoweverLateTheyAreAskedFor) {
    for (unsigned seed = 1; seed <= 6; ++seed)
        EXPECT_EQ(storm(seed, false, 1500), storm(seed, true, 1500)) << seed;
}

TEST(TwinRobust, TimeThatRunsBackwardsStandsStill) {
    Bench b;
    b.setup({"95 01", "9D E8 03 00 00", "96"});
    b.pass_ms(1000);
    const std::string there = b.ask("A0");
    Out out;
    b.drive().on_frame(Frame::can_extended(host_id(5, 0xA0), no_data), time_zero, out);
    ASSERT_EQ(out.frames.size(), 1u);
    EXPECT_EQ(out.frames[0].frame.at, b.now());
    EXPECT_EQ(there, "20 B6 03 00 00");  // 950
    EXPECT_EQ(text(out.frames[0].frame.data()), there.substr(3));
}

TEST(TwinRobust, ExtremeValues) {
    Bench b;
    b.setup({"9C FF FF FF FF", "95 01", "99 01 00 00 00", "9A 01 00 00 00", "9B FF FF FF FF", "A0 00 00 00 80", "9E 00 00 00 80", "96"});
    EXPECT_EQ(b.pass_ms(2000), Lines{"5A 29 00 00 00 00 00 00 80"});
    b.setup({"A0 FF FF FF 7F", "9E 01 00 00 00", "96"});  // 2^32 - 1 pulses at 1 pulse/s: 136 years
    EXPECT_TRUE(b.pass(std::chrono::hours(24)).empty());
    EXPECT_EQ(b.position(), -2147483648LL + 86400);
    b.setup({"9B 00 00 00 00", "9D 00 00 00 80", "96"});  // AC = 1: a ramp of 68 years
    b.pass(std::chrono::hours(1));
    EXPECT_EQ(b.speed(), -3599);  // first 1 s to brake from 1
    b.setup({"97"});
    b.pass_ms(1);
    EXPECT_TRUE(b.stopped());
    b.setup({"9F FF FF FF 7F", "9E FF FF FF 7F", "96", "96", "96"});
    b.pass_ms(10);
    b.setup({"95 00"});
    b.pass_ms(1);
    EXPECT_TRUE(b.stopped());
}

TEST(TwinRobust, AThousandMovingDrivesPolledAHundredTimesASecondLeaveTimeToSpare) {
    std::vector<std::unique_ptr<Twin>> drives;
    Out out;
    Instant now = time_zero;
    for (int i = 0; i < 1000; ++i) {
        drives.push_back(make(can_setup()));
        drives.back()->power_on({}, now, out);
        for (const char* s : {"15 01", "1D 10 27 00 00", "16"}) {
            const auto m = hex(s);
            drives.back()->on_frame(Frame::can_extended(host_id(5, m[0]), std::span(m).subspan(1)), now, out);
        }
    }
    const Frame ms0 = Frame::can_extended(host_id(5, 0x91), std::array<std::uint8_t, 1>{0});
    const Frame ms1 = Frame::can_extended(host_id(5, 0x91), std::array<std::uint8_t, 1>{1});
    std::size_t answers = 0;
    const std::clock_t began = std::clock();
    for (int poll = 0; poll < 100; ++poll) {
        now += std::chrono::milliseconds(10);
        for (auto& d : drives) {
            out.clear();
            d->on_frame(ms0, now, out);
            d->on_frame(ms1, now, out);
            answers += out.frames.size();
        }
    }
    const double cpu_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
    EXPECT_EQ(answers, 200'000u);
    RecordProperty("cpu_ms_per_simulated_second", static_cast<int>(cpu_s * 1000));
    EXPECT_LT(cpu_s, 0.9) << "one core, one simulated second, whatever the build";
    EXPECT_EQ(drives[0]->deadline(), never);
}

}  // namespace
}  // namespace axisgate::uim342::test
