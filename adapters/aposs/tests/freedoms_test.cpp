// Each freedom of the page: the simulated controller has it, and without it the same steps end otherwise.
#include <cmath>

#include "adapters/aposs/tests/macs_bench.hpp"
#include "gateway/protocols/canopen/nmt.hpp"

namespace axisgate::aposs::test {
namespace {
using Options = std::map<std::string, std::string>;
using canopen::NmtCommand;
constexpr std::uint32_t answer_id = 0x585, beat_id = 0x705;

/// A controller with these freedoms.
struct Free : Macs {
    explicit Free(Options options = {}) { be(std::move(options)); }
    void be(Options options) {
        twin = macs(std::move(options));
        out.clear();
        twin->power_on({}, now, out);
    }
    /// After how many milliseconds a frame of this identifier comes; -1: not within 20 s.
    int sent_after(std::uint32_t id) {
        for (int ms = 0; ms <= 20'000; ++ms) {
            if (count(id) > 0) return ms;
            pass(1ms);
        }
        return -1;
    }
    int answered_after(std::uint8_t command, canopen::Address a, std::uint32_t value = 0) {
        out.clear();
        send(canopen::sdo_frame(0x605, command, a, value));
        return sent_after(answer_id);
    }
    /// A read whose answer may be late.
    std::int64_t read_late(std::uint16_t index, std::uint8_t sub = 0) {
        EXPECT_NE(answered_after(0x40, {index, sub}), -1);
        return value_of_answer();
    }
    std::int64_t value_of_answer() {
        for (const auto& tx : out.frames)
            if (tx.frame.id == answer_id) return static_cast<std::int64_t>(canopen::value_of(tx.frame));
        return -1;
    }
    bool aborted() {
        for (const auto& tx : out.frames)
            if (tx.frame.id == answer_id) return tx.frame.storage[0] == 0x80;
        return false;
    }
    void nmt(NmtCommand c) { send(canopen::nmt_frame(c, 5)); }
    Abort set_object(std::uint16_t index, std::uint8_t sub, std::int64_t v, int size) { return write(index, sub, v, size); }
    std::size_t frames_in(Duration d, std::uint32_t id) {
        out.clear();
        const Instant end = now + d;
        while (now < end)
            pass(1ms);
        return count(id);
    }
};

// --- SDO ------------------------------------------------------------------------------------------------------------------------
TEST(ApossFreedoms, SdoAnswersTakeTheirTimeOneAfterTheOther) {
    Free exact, late(Options{{"sdo_answer_ms", "120"}});
    EXPECT_EQ(exact.answered_after(0x40, {0x6041, 0}), 0);
    EXPECT_EQ(late.answered_after(0x40, {0x6041, 0}), 120);
    late.out.clear();
    late.send(canopen::sdo_frame(0x605, 0x40, {0x6041, 0}));
    late.send(canopen::sdo_frame(0x605, 0x40, {0x6061, 0}));
    late.pass(120ms);
    EXPECT_EQ(late.count(answer_id), 1u);
    late.pass(120ms);
    EXPECT_EQ(late.count(answer_id), 2u);
    Free reply(Options{{"reply_ms", "30"}});
    EXPECT_EQ(reply.answered_after(0x40, {0x6041, 0}), 30);
}

TEST(ApossFreedoms, AShareOfTheSdoAnswersIsLateOrSentTwice) {
    const auto late = [](Options options) {
        Free b(std::move(options));
        int n = 0;
        for (int i = 0; i < 200; ++i)
            n += b.answered_after(0x40, {0x6041, 0}) >= 300;
        return n;
    };
    EXPECT_EQ(late({}), 0);
    const int n = late({{"sdo_late_per_mille", "200"}, {"sdo_late_ms", "300"}});
    EXPECT_GT(n, 15);
    EXPECT_LT(n, 80);
    Free doubles(Options{{"doubled_per_mille", "50"}});
    std::size_t answers = 0;
    for (int i = 0; i < 400; ++i) {
        (void)doubles.answered_after(0x40, {0x6041, 0});
        answers += doubles.count(answer_id);
    }
    EXPECT_GT(answers, 405u);
}

TEST(ApossFreedoms, ABusyControllerRefusesOrDoesNotAnswer) {
    const auto shares = [](const char* how) {
        Free b(Options{{"sdo_busy_per_mille", "200"}, {"sdo_busy_answer", how}});
        int aborts = 0, silent = 0;
        for (int i = 0; i < 200; ++i) {
            b.out.clear();
            b.send(canopen::sdo_frame(0x605, 0x40, {0x6041, 0}));
            aborts += b.aborted();
            silent += b.count(answer_id) == 0;
            if (b.aborted()) EXPECT_EQ(b.value_of_answer(), *how == '0' ? 0x08000022 : 0x08000020);
        }
        return std::pair(aborts, silent);
    };
    EXPECT_GT(shares("0").first, 15);
    EXPECT_EQ(shares("0").second, 0);
    EXPECT_GT(shares("1").first, 15);
    EXPECT_EQ(shares("2").first, 0);
    EXPECT_GT(shares("2").second, 15);
}

TEST(ApossFreedoms, AWriteToABusyControllerHasNoEffect) {
    Free b(Options{{"sdo_busy_per_mille", "200"}});
    int refused = 0;
    for (std::int64_t v = 100; v < 200; ++v) {
        const bool was = b.set(1, v) != Abort::none;
        refused += was;
        while (b.answered_after(0x40, {0x2300, 2}) != 0 || b.aborted()) {
        }
        EXPECT_EQ(b.value_of_answer() == v, !was);
    }
    EXPECT_GT(refused, 5);
}

TEST(ApossFreedoms, ObjectsOfTheProfileAreMissing) {
    const auto has = [](const char* lacks, std::uint16_t index, std::uint8_t sub = 0) {
        Free b(Options{{"lacking_objects", lacks}});
        const auto f = b.sdo(0x40, {index, sub});
        if (f.storage[0] == 0x80) EXPECT_EQ(canopen::value_of(f), 0x06020000u);
        return f.storage[0] != 0x80;
    };
    for (const std::uint16_t index : std::initializer_list<std::uint16_t>{0x6062, 0x606C, 0x60F4, 0x686C}) {
        EXPECT_TRUE(has("0", index));
        EXPECT_FALSE(has("1", index)) << std::hex << index;
    }
    EXPECT_TRUE(has("1", 0x6502));
    EXPECT_FALSE(has("2", 0x6502));
    EXPECT_FALSE(has("2", 0x1010, 1));
    EXPECT_FALSE(has("2", 0x1016, 1));
    EXPECT_TRUE(has("2", 0x6041));
    Free b(Options{{"lacking_objects", "1"}});
    ASSERT_EQ(b.write(0x1A00, 0, 0, 1), Abort::none);
    EXPECT_EQ(b.write(0x1A00, 1, 0x606C0020, 4), Abort::no_object) << "it cannot be mapped, either";
    EXPECT_EQ(b.write(0x1A00, 1, 0x60640020, 4), Abort::none);
}

// --- PDO, NMT, EMCY -------------------------------------------------------------------------------------------------------------
TEST(ApossFreedoms, PdosAreSetUpInPreOperationalOrWhileTheyAreNotValid) {
    Free free, early(Options{{"pdo_setup", "1"}}), strict(Options{{"pdo_setup", "2"}});
    EXPECT_EQ(free.write(0x1A00, 0, 0, 1), Abort::none);
    EXPECT_EQ(early.write(0x1A00, 0, 0, 1), Abort::none);
    EXPECT_EQ(strict.write(0x1A00, 0, 0, 1), Abort::device_state) << "PDO 1 is valid";
    EXPECT_EQ(strict.write(0x1800, 1, 0x0000'0190, 4), Abort::value) << "another identifier of a valid PDO";
    EXPECT_EQ(strict.write(0x1800, 1, 0x8000'0185, 4), Abort::none);
    EXPECT_EQ(strict.write(0x1A00, 0, 0, 1), Abort::none);
    for (Free* b : {&free, &early, &strict})
        b->nmt(NmtCommand::start);
    EXPECT_EQ(free.write(0x1A01, 0, 0, 1), Abort::none);
    EXPECT_EQ(early.write(0x1A01, 0, 0, 1), Abort::device_state);
    EXPECT_EQ(strict.write(0x1A01, 0, 0, 1), Abort::device_state);
    early.nmt(NmtCommand::pre_operational);
    EXPECT_EQ(early.write(0x1A01, 0, 0, 1), Abort::none);
}

TEST(ApossFreedoms, EmergenciesComeLateOrNotAtAll) {
    const auto after = [](Options options) {
        Free b(std::move(options));
        b.pass(10ms);
        b.out.clear();
        b.hand("inject_error", Value{std::int64_t{88}});
        for (int ms = 0; ms < 2000; ++ms) {
            if (b.reported(0xFF58)) return ms;
            b.pass(1ms);
        }
        return -1;
    };
    EXPECT_EQ(after({}), 0);
    EXPECT_EQ(after({{"emergency_late_ms", "500"}}), 500);
    EXPECT_EQ(after({{"emergencies", "0"}}), -1);
}

TEST(ApossFreedoms, HeartbeatsJitter) {
    const auto gaps = [](Options options) {
        Free b(std::move(options));
        EXPECT_EQ(b.write(0x1017, 0, 500, 2), Abort::none);
        std::int64_t low = 10'000, high = 0;
        Instant last{};
        for (int i = 0; i < 40; ++i) {
            b.out.clear();
            EXPECT_NE(b.sent_after(beat_id), -1);
            if (last != Instant{}) {
                const std::int64_t ms = (b.now - last) / 1ms;
                low = std::min(low, ms), high = std::max(high, ms);
            }
            last = b.now;
        }
        return std::pair(low, high);
    };
    EXPECT_EQ(gaps({}), std::pair(std::int64_t{500}, std::int64_t{500}));
    const auto [low, high] = gaps({{"heartbeat_jitter_ms", "300"}});
    EXPECT_LT(low, 450);
    EXPECT_GT(high, 550);
    EXPECT_LE(high, 801);
}

TEST(ApossFreedoms, AnotherNodeTalks) {
    Free quiet, b(Options{{"foreign_ms", "10"}});
    const std::uint32_t other = (5 + 62) % 127 + 1;
    EXPECT_EQ(quiet.frames_in(1s, 0x180 + other), 0u);
    EXPECT_GT(b.frames_in(1s, 0x180 + other), 70u);
    EXPECT_EQ(b.count(0x700 + other), 20u);
    EXPECT_EQ(b.count(0x80 + other), 2u);
    b.hand("silent", Value{true});
    EXPECT_GT(b.frames_in(1s, 0x180 + other), 70u) << "it is not the controller that talks";
}

TEST(ApossFreedoms, PdosComeWithoutASync) {
    const auto sent = [](Options options) {
        Free b(std::move(options));
        EXPECT_EQ(b.write(0x1800, 1, 0x8000'0185, 4), Abort::none);
        EXPECT_EQ(b.write(0x1800, 2, 1, 1), Abort::none) << "at each SYNC";
        EXPECT_EQ(b.write(0x1800, 5, 0, 2), Abort::none);
        EXPECT_EQ(b.write(0x1800, 1, 0x0000'0185, 4), Abort::none);
        b.nmt(NmtCommand::start);
        return b.frames_in(1s, 0x185);
    };
    EXPECT_EQ(sent({}), 0u);
    EXPECT_NEAR(static_cast<double>(sent({{"extra_pdo_ms", "20"}})), 50, 1);
}

// --- start and memory -----------------------------------------------------------------------------------------------------------
TEST(ApossFreedoms, TheSecondAxisStartsLater) {
    Free b(Options{{"axis_start_ms", "1000"}});
    EXPECT_NE(b.status_of(0), 0);
    EXPECT_EQ(b.status_of(1), 0);
    EXPECT_EQ(b.write(0x6840, 0, 6, 2), Abort::device_state);
    b.enable_axis(0);
    b.pass(999ms);
    EXPECT_EQ(b.status_of(1), 0);
    b.pass(1ms);
    EXPECT_NE(b.status_of(1), 0);
    b.enable_axis(1);
    b.off_and_on();
    EXPECT_EQ(b.status_of(1), 0) << "after each power-on";
    Free exact;
    EXPECT_NE(exact.status_of(1), 0);
}

TEST(ApossFreedoms, ItBootsAndPausesForItsEprom) {
    Free b(Options{{"boot_ms", "2000"}});
    EXPECT_EQ(b.frames_in(1990ms, beat_id), 0u);
    EXPECT_EQ(b.frames_in(20ms, beat_id), 1u);
    const auto pause = [](Options options) {
        Free c(std::move(options));
        (void)c.answered_after(0x23, {0x2300, 2}, 900);
        return c.answered_after(0x23, {0x1010, 1}, 0x65766173);
    };
    EXPECT_EQ(pause({}), 0);
    EXPECT_EQ(pause({{"flash_silence_ms", "1200"}}), 1200);
}

// --- the application ------------------------------------------------------------------------------------------------------------
TEST(ApossFreedoms, ACommandTakesEffectInTheNextCycle) {
    Free b(Options{{"program_cycle_ms", "60"}});
    b.now = at_ns(6'000'000'000);  // a multiple of the cycle
    b.pass(1ms);
    ASSERT_EQ(b.write(0x6040, 0, 6, 2), Abort::none);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x40) << "not yet";
    EXPECT_EQ(b.read(0x6040), 6) << "the object holds it already";
    b.pass(58ms);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x40);
    b.pass(1ms);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x21);
    ASSERT_EQ(b.write(0x6040, 0, 7, 2), Abort::none);
    ASSERT_EQ(b.write(0x6040, 0, 0, 2), Abort::none) << "what stood there in between is not seen";
    b.pass(60ms);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x40);
    ASSERT_EQ(b.set(1, 700), Abort::none);
    EXPECT_NE(b.read(0x607F), 0) << "a parameter is in force at once";
    Free exact;
    ASSERT_EQ(exact.write(0x6040, 0, 6, 2), Abort::none);
    EXPECT_EQ(exact.status_of(0) & 0x6F, 0x21);
}

TEST(ApossFreedoms, TheStatusWordIsShownLate) {
    Free b(Options{{"status_late_ms", "100"}});
    b.pass(1s);
    (void)b.status_of(0);
    ASSERT_EQ(b.write(0x6040, 0, 6, 2), Abort::none);
    b.pass(99ms);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x40);
    b.pass(1ms);
    EXPECT_EQ(b.status_of(0) & 0x6F, 0x21);
    b.nmt(NmtCommand::start);
    ASSERT_EQ(b.write(0x6040, 0, 0, 2), Abort::none);
    EXPECT_EQ(b.frames_in(99ms, 0x185), 0u);
    EXPECT_EQ(b.frames_in(2ms, 0x185), 1u) << "the event-driven PDO, too";
}

TEST(ApossFreedoms, ThePositionIsShownLate) {
    Free exact, late(Options{{"position_late_ms", "100"}});
    for (Free* b : {&exact, &late}) {
        b->enable_axis(0);
        b->go(0, 100'000);
    }
    for (int i = 0; i < 3000; ++i) {
        exact.pass(1ms), late.pass(1ms);
    }
    const auto here = exact.position_of(0), shown = late.position_of(0);
    exact.pass(-100ms + 200ms), late.pass(100ms);
    const auto later = late.position_of(0);
    EXPECT_NEAR(static_cast<double>(here - shown), 1667, 40) << "16667 qc/s";
    EXPECT_NEAR(static_cast<double>(later), static_cast<double>(here), 40);
}

// --- mechanics ------------------------------------------------------------------------------------------------------------------
TEST(ApossFreedoms, TheShaftFollowsBehindItsDemandAndOvershoots) {
    const auto behind = [](Options options) {
        Free b(std::move(options));
        b.enable_axis(0);
        b.go(0, 100'000);
        b.pass(3s);
        const auto error = b.read(0x60F4);
        b.pass(10s);
        EXPECT_NEAR(static_cast<double>(b.position_of(0)), 100'000, 1);
        EXPECT_EQ(b.error(), 0);
        return static_cast<double>(error);
    };
    const double plain = behind({});
    EXPECT_NEAR(behind({{"follow_ms", "10"}}) - plain, 333, 25) << "twice 10 ms at 16667 qc/s";
    const auto highest = [](const char* damping) {
        Free b(Options{{"follow_ms", "20"}, {"damping_percent", damping}});
        EXPECT_EQ(b.set(31, 20), Abort::none);  // RAMPMIN: a steep ramp
        EXPECT_EQ(b.set(34, 100), Abort::none);
        EXPECT_EQ(b.set(15, 100'000), Abort::none);  // POSERR
        EXPECT_EQ(b.write(0x6083, 0, 1'000'000, 4), Abort::none);
        EXPECT_EQ(b.write(0x6084, 0, 1'000'000, 4), Abort::none);
        b.enable_axis(0);
        b.go(0, 2000);
        std::int64_t most = 0;
        for (int i = 0; i < 1500; ++i) {
            b.pass(1ms);
            most = std::max(most, b.position_of(0));
        }
        return most;
    };
    EXPECT_LE(highest("100"), 2001);
    EXPECT_GT(highest("30"), 2020);
}

TEST(ApossFreedoms, AWeakMotorEndsInThePositionErrorOfTheDrive) {
    for (const bool weak : {false, true}) {
        Free b(weak ? Options{{"most_acceleration", "5000"}} : Options{});
        b.enable_axis(0);
        b.enable_axis(1);
        b.go(0, 100'000);
        b.pass(3s);
        EXPECT_EQ(b.error(), weak ? 0x8611 : 0);
        EXPECT_EQ((b.status_of(1) & 0x6F) == 0x27, !weak) << "a position error switches off all axes";
    }
    Free gentle(Options{{"most_acceleration", "20000"}});
    gentle.enable_axis(0);
    gentle.go(0, 100'000);
    gentle.pass(10s);
    EXPECT_EQ(gentle.error(), 0);
    EXPECT_EQ(gentle.position_of(0), 100'000);
}

TEST(ApossFreedoms, FrictionBacklashAndNoise) {
    const auto rests_at = [](Options options, std::initializer_list<std::int64_t> way) {
        Free b(std::move(options));
        b.enable_axis(0);
        for (const auto to : way) {
            b.go(0, to);
            b.pass(4s);
        }
        return b.position_of(0);
    };
    EXPECT_EQ(rests_at({}, {20'000}), 20'000);
    const auto stuck = rests_at({{"friction_increments", "10"}, {"follow_ms", "6"}}, {20'000});
    EXPECT_NE(stuck, 20'000);
    EXPECT_NEAR(static_cast<double>(stuck), 20'000, 11);
    EXPECT_EQ(rests_at({{"backlash_increments", "40"}}, {20'000}), 19'980);
    EXPECT_EQ(rests_at({{"backlash_increments", "40"}}, {20'000, 10'000}), 10'020);
    Free noisy(Options{{"noise_increments", "2"}});
    std::int64_t low = 0, high = 0;
    for (int i = 0; i < 100; ++i) {
        noisy.pass(1ms);
        low = std::min(low, noisy.position_of(0)), high = std::max(high, noisy.position_of(0));
    }
    EXPECT_EQ(low, -2);
    EXPECT_EQ(high, 2);
}

TEST(ApossFreedoms, WithoutPowerItDriftsAndEnablingDoesNotMoveIt) {
    Free b(Options{{"drift_increments", "800"}});
    b.pass(5s);
    EXPECT_EQ(b.position_of(0), 0) << "nothing was switched off yet";
    b.enable_axis(0);
    b.go(0, 20'000);
    b.pass(4s);
    EXPECT_EQ(b.position_of(0), 20'000);
    ASSERT_EQ(b.write(0x6040, 0, 0, 2), Abort::none);
    b.pass(5s);
    EXPECT_NEAR(static_cast<double>(b.position_of(0)), 20'800, 1);
    b.enable_axis(0);
    b.pass(1s);
    EXPECT_NEAR(static_cast<double>(b.position_of(0)), 20'800, 1);
    b.go(0, 0);
    b.pass(5s);
    EXPECT_EQ(b.position_of(0), 0);
}

TEST(ApossFreedoms, TheReferenceSwitchHasAHysteresis) {
    const auto zero_at = [](Options options) {
        options["travel"] = "100000";
        Free b(std::move(options));
        EXPECT_EQ(b.set(40, 1), Abort::none);  // HOME_TYPE: back from the switch, without an index
        b.enable_axis(0);
        b.go(0, 20'000);
        b.pass(5s);
        EXPECT_EQ(b.set(7, -10), Abort::none);  // HOME_VEL: downwards
        b.enable_axis(0, 6);
        EXPECT_EQ(b.write(0x6098, 0, -1, 1), Abort::none);
        b.word(0x1F);
        b.pass(120s);
        EXPECT_EQ(b.status_of(0) & 0x3000, 0x1000);
        return b.twin->mechanics(1, b.now).position;
    };
    const double plain = zero_at({}), wide = zero_at({{"switch_hysteresis_increments", "300"}});
    EXPECT_NEAR(wide - plain, 300, 3);
}

// --- the whole ------------------------------------------------------------------------------------------------------------------
TEST(ApossFreedoms, NamedSpecimensDifferAndASeedIsTheSameControllerAgain) {
    for (const auto name : named_specimens)
        EXPECT_GE(specimen_in_words(page(), specimen_values(page(), name)).size(), 2u) << name;
    EXPECT_TRUE(specimen_in_words(page(), specimen_values(page(), "0")).empty());
    const auto told = [] {
        Free b(Options{{"specimen", "77"}});
        std::string all;
        for (int i = 0; i < 200; ++i) {
            b.send(canopen::sdo_frame(0x605, 0x40, {0x6064, 0}));
            b.pass(20ms);
        }
        for (const auto& tx : b.out.frames)
            all += to_text(tx.frame) + "\n";
        return all;
    };
    EXPECT_EQ(told(), told());
}

TEST(ApossFreedoms, TheDefaultsOfThePageAreTheControllerWithoutFreedoms) {
    Macs without;
    Free with;
    for (Macs* b : {&without, static_cast<Macs*>(&with)}) {
        b->out.clear();
        b->enable_axis(0);
        b->go(0, 5000);
        b->send(canopen::nmt_frame(NmtCommand::start, 5));
        b->pass(2s);
        b->hand("inject_error", Value{std::int64_t{88}});
        b->pass(100ms);
    }
    ASSERT_EQ(without.out.frames.size(), with.out.frames.size());
    for (std::size_t i = 0; i < with.out.frames.size(); ++i)
        EXPECT_EQ(to_text(without.out.frames[i].frame), to_text(with.out.frames[i].frame));
}

}  // namespace
}  // namespace axisgate::aposs::test
