// Worked examples of the manual that other tests do not cover: scale factors, homing formulas, selection of a program, gears, SYNC. The
// expected numbers are those that the manual prints, with errata applied.
#include <gtest/gtest.h>

#include <cmath>

#include "adapters/aposs/tests/macs_bench.hpp"
#include "adapters/aposs/twin/coded.hpp"

namespace axisgate::aposs::test {
namespace {

TEST(ApossExamples, UserFactors) {  // POSFACT_Z [L2801-2845]
    struct Row {
        std::int64_t z, n, move;
        double qc;
    };
    // A spindle in 1/10 mm: 25/1 * 500 * 4 / 50 = 1000/1. A cylinder in 1/10 degrees: 5/1 * 500 * 4 / 3600 = 25/9. 50.375 qc.
    for (const Row& row :
         {Row{25 * 500 * 4, 50, 50, 50'000}, Row{5 * 500 * 4, 3600, 3600, 10'000}, Row{25, 9, 90, 250}, Row{50'375, 1'000, 8, 403}}) {
        SCOPED_TRACE(row.move);
        Macs b;
        ASSERT_EQ(b.set(23, row.z), Abort::none);
        ASSERT_EQ(b.set(26, row.n), Abort::none);
        b.enable_axis(0);
        b.go(0, row.move);
        b.pass(20s);
        EXPECT_EQ(b.read(0x6064), row.move);
        EXPECT_NEAR(static_cast<double>(b.read(0x6063)), row.qc, 1) << "quad counts of the encoder";
    }
}

TEST(ApossExamples, FrictionWheel) {  // SYNCFACTM, example 3 [L3971-3980], corrected (E-22)
    EXPECT_EQ(std::llround(2 * M_PI * 60 * 10), 3770);
}

TEST(ApossExamples, GearsOfTheSyncFactors) {  // [L3936-3970]: the master twice as fast; a conveyor belt, 2048 : 55
    struct Row {
        std::int64_t m, s, master, slave;
    };
    for (const Row& row : {Row{2, 1, 4'000, 2'000}, Row{2048, 55, 20'480, 550}}) {
        SCOPED_TRACE(row.m);
        Macs b;
        ASSERT_EQ(b.set(49, row.m, 1), Abort::none);
        ASSERT_EQ(b.set(50, row.s, 1), Abort::none);
        b.enable_axis(0);
        b.enable_axis(1);
        ASSERT_EQ(say(b, "SYNCP x(2)"), "SYNCP x(2)");
        b.go(0, row.master);
        b.pass(15s);
        EXPECT_EQ(b.position_of(0), row.master);
        EXPECT_NEAR(static_cast<double>(b.position_of(1)), static_cast<double>(row.slave), 1);
        // With a negative MENCODER the position is shown in those units [L3300].
        ASSERT_EQ(b.set(30, -500, 1), Abort::none);
        EXPECT_EQ(say(b, "MAPOS x(2)"), "MAPOS x(2): " + std::to_string(row.slave));
    }
}

TEST(ApossExamples,
     HomingVelocityAndRamp) {  // HOME_VEL * VELMAX / VELRES; VELRES / HOME_RAMP * RAMPMIN, not above DFLTACC [L2017, L3620-3636]
    Macs b;
    ASSERT_EQ(b.set(1, 3'000), Abort::none);
    ASSERT_EQ(b.set(7, 10), Abort::none);
    // 300 rpm at 2000 qc a turn are 10 000 qc/s.
    EXPECT_EQ(b.read(0x6099, 1), 10'000);
    ASSERT_EQ(b.set(41, 50), Abort::none);
    EXPECT_EQ(b.read(0x609A), 50'000) << "50 %: 100 000 qc/s in twice 1000 ms";
    ASSERT_EQ(b.set(41, 80), Abort::none);
    EXPECT_EQ(b.read(0x609A), 50'000) << "DFLTACC is 50";
}

TEST(ApossExamples, FeedForwardOfAnAmplifier) {  // FFVEL = 1000 * 1400 / 1600 [L3518-3527]: one eighth of the lag remains
    const auto lag = [](std::int64_t ffvel) {
        Macs b;
        EXPECT_EQ(b.set(1, 1'400), Abort::none);
        EXPECT_EQ(b.set(36, ffvel), Abort::none);
        b.enable_axis(0, 3);
        EXPECT_EQ(b.write(0x60FF, 0, 20'000, 4), Abort::none);
        b.pass(3s);
        return static_cast<double>(b.read(0x60F4));
    };
    EXPECT_NEAR(lag(1'000 * 1'400 / 1'600) / lag(0), 0.125, 0.05);
}

TEST(ApossExamples, AProgramIsChosenByInputs) {  // I_PRGCHOICE 3, I_PRGSTART 7: inputs 4 and 5 are program 6 [L6611-6637]
    EXPECT_EQ(chosen_program(0b0011000, 3, 7), 6);
    EXPECT_EQ(chosen_program(0b1111000011, 3, 7), 0) << "only 3 to 6";
    EXPECT_EQ(chosen_program(0x7F, 1, 8), std::nullopt) << "127: there are 0 to 89 (E-34)";
    EXPECT_EQ(chosen_program(0b1011001, 1, 8), 89);
    EXPECT_EQ(chosen_program(0xFF, 0, 7), std::nullopt);
    EXPECT_EQ(chosen_program(0xFF, 7, 7), std::nullopt);
    Macs b;
    ASSERT_EQ(b.write(0x2200, 105, 3, 4), Abort::none);
    ASSERT_EQ(b.write(0x2200, 104, 7, 4), Abort::none);
    ASSERT_EQ(b.saveprom(), Abort::none);
    b.hand("inputs", Value{std::int64_t{0b0011000}});
    EXPECT_EQ(seen(b, "program_number"), -1);
    b.hand("inputs", Value{std::int64_t{0b1011000}});
    EXPECT_EQ(seen(b, "program_number"), 6);
    b.hand("inputs", Value{std::int64_t{0}});
    b.hand("inputs", Value{std::int64_t{0b1000100}});
    EXPECT_EQ(seen(b, "program_number"), 6) << "one runs";
}

TEST(ApossExamples, PrgparDecidesWhichProgramFollows) {  // SET PRGPAR 5 in a program [L6537, L6572-6583] (E-06)
    Macs b;
    b.hand("program", Value{true});
    EXPECT_EQ(seen(b, "program_number"), 0);
    ASSERT_EQ(say(b, "SET PRGPAR 5"), "SET PRGPAR 5");
    b.hand("program", Value{false});
    EXPECT_EQ(seen(b, "program_number"), 5) << "read before the value dies";
    EXPECT_EQ(b.read(0x2200, 103), -1);
    b.hand("program", Value{false});
    EXPECT_EQ(seen(b, "program_number"), -1) << "none follows that one";
    b.hand("program", Value{true});
    ASSERT_EQ(say(b, "SET PRGPAR 1005"), "SET PRGPAR 1005");
    ASSERT_EQ(say(b, "SET I_BREAK 1"), "SET I_BREAK 1");
    b.hand("inputs", Value{std::int64_t{1}});
    EXPECT_EQ(seen(b, "program_number"), -1) << "an aborted one has no successor";
}

/// CURKPROP, CURKINT [L5304-5372]: beta 0.2, 125 us, 24 V, MACS4-DC3, 1 mH, 1 Ohm; ku is 2^-27 (E-24). The user calculates them for tuning;
/// the parameters must accept the results.
TEST(ApossExamples, GainsOfTheCurrentLoop) {
    const double beta = 0.2, ts = 0.000125, u = 24, kc = 3'495, l = 0.001, r = 1, ku = std::ldexp(1, -27);
    const double w = beta * M_PI / (2 * ts);
    const auto p = std::llround((2 * w - r / l) * l / (u * kc * ku)), i = std::llround(w * w * l / (kc * ku * u) * (ts / 4));
    EXPECT_EQ(p, 6'443);
    EXPECT_EQ(i, 316);
    Macs b;
    ASSERT_EQ(b.set(92, p), Abort::none);
    ASSERT_EQ(b.set(93, i), Abort::none);
    EXPECT_EQ(b.get(92), p);
}

TEST(ApossExamples, SyncIsGivenByItsTimer) {  // [L6802-6806]
    Macs b;
    for (const char* line : {"SET TIMER 2 / 4", "SET CANSYNCTIMER 2"})
        EXPECT_EQ(say(b, line), line);
    EXPECT_EQ(b.get(14, 0), 2);
    EXPECT_EQ(b.get(14, 1), 4);
    EXPECT_EQ(b.read(0x2200, 115), 2);
}

}  // namespace
}  // namespace axisgate::aposs::test
