// Parts of the simulated MACS that act on the controller as a whole: its inputs, the end of a program, the loop, and what a slave may go
// back.
#include <gtest/gtest.h>

#include "adapters/aposs/tests/coupled.hpp"
#include "adapters/aposs/tests/macs_bench.hpp"

namespace axisgate::aposs::test {
namespace {

TEST(ApossTwin, AnInputClearsTheErrorByItsEdge) {  // I_ERRCLR [L6707-6732], sign as in the list (E-69)
    for (const int input : {5, -5}) {
        SCOPED_TRACE(input);
        Macs b;
        const std::int64_t rest = input > 0 ? 0 : 16, acts = 16 - rest;
        ASSERT_EQ(b.write(0x2200, 108, input, 4), Abort::none);
        b.hand("inputs", Value{rest});
        b.enable_axis(0);
        b.hand("stall", Value{true});
        b.go(0, 100'000);
        b.pass(2s);
        ASSERT_EQ(b.error(), 0x8611);
        b.hand("stall", Value{false});
        b.hand("inputs", Value{acts});
        EXPECT_EQ(b.error(), 0);
        EXPECT_EQ(b.status_of(0) & 0x4F, 0x40) << "and the motor stays off";
    }
}

TEST(ApossTwin, TheEndOfAProgramStopsTheSimulatedMaster) {  // ESCCOND 0 [L5134]
    Macs b;
    b.hand("program", Value{true});
    for (const char* line : {"SET I_BREAK 6", "SET MENCODERTYPE x(2) 6", "SYSVAR[4105] x(2) = 5"})
        ASSERT_EQ(say(b, line), line);
    b.pass(100ms);
    EXPECT_NEAR(static_cast<double>(b.read(0x2501, 10)), 500, 10);
    b.hand("inputs", Value{std::int64_t{32}});
    const auto stands = b.read(0x2501, 10);
    b.pass(100ms);
    EXPECT_EQ(b.read(0x2501, 10), stands);
}

/// Plausible, not measured (E-17): directions alone.
TEST(ApossTwin, AnIntegralPartShortensTheLagAndALimitOfTheOutputLengthensIt) {
    const auto lag = [](std::initializer_list<std::pair<int, int>> values) {
        Macs b;
        for (const auto& [number, value] : values)
            EXPECT_EQ(b.set(number, value), Abort::none);
        b.enable_axis(0);
        b.go(0, 100'000);
        b.pass(3s);
        return static_cast<double>(b.read(0x60F4));
    };
    const double plain = lag({});
    EXPECT_LT(lag({{13, 10}}), plain) << "KINT";
    EXPECT_EQ(lag({{13, 10}, {21, 0}}), plain) << "KILIM 0: no integral part";
    EXPECT_EQ(lag({{13, 10}, {105, -10}}), plain) << "KILIMTIME below 0: only at standstill";
    EXPECT_GT(lag({{35, 500}}), plain) << "BANDWIDTH";
}

TEST(ApossSync, BackOnlyWhileTheMasterGoesBack) {  // REVERS 1 [L4508-4616]
    Coupled r;
    r.p.reverse = 1;
    r.begin(SyncMode::position);
    r.pass(10);
    r.speed = -10;
    r.pass(5);
    EXPECT_EQ(r.slave, 50) << "with its master";
    r.speed = 0;
    r.p.offset = -20;
    r.pass(50);
    EXPECT_EQ(r.slave, 50) << "and not for an offset";
}

TEST(ApossSync, TheSlavesMarkersHaveTheFilterToo) {  // SYNCSFTIME [L5796]: a single late marker of the slave
    double moved[2] = {};
    for (const int filtered : {0, 1}) {
        Synchronisation s;
        SyncParameters p = quick();
        p.start = 6;
        p.slave_filter_time = filtered ? 20'000 : 0;
        p.filter_par = 2;
        SyncInput in;
        s.begin(SyncMode::marker, p, in, 0, 0);
        double at = 0;
        for (int k = 1; k <= 4000; ++k) {
            in.master += 10;
            in.slave = at;
            in.master_marker.reset();
            in.slave_marker.reset();
            if (k % 50 == 0) {
                in.master_marker = in.master;
                in.slave_marker = static_cast<double>(in.master) + (k == 3000 ? 40 : 0);
            }
            at = s.step(p, in);
            if (k > 3000) moved[filtered] = std::max(moved[filtered], std::fabs(at - static_cast<double>(in.master)));
        }
    }
    EXPECT_GT(moved[0], 20);
    EXPECT_LT(moved[1], moved[0] / 4);
}

}  // namespace
}  // namespace axisgate::aposs::test
