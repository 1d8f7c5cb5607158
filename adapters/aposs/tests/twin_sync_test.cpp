// Synchronisation of the simulated MACS without a controller: gear, offsets, filters, markers, windows and their counts. The expected
// values follow from the manual's formulas.
#include <gtest/gtest.h>

#include "adapters/aposs/tests/coupled.hpp"

namespace axisgate::aposs::test {
namespace {

TEST(ApossSync, NoQuadCountOfTheGearIsLost) {
    Coupled r;
    r.p.fact_m = 3;
    r.p.fact_s = 2;
    r.speed = 1;
    r.begin(SyncMode::position);
    r.pass(2999);
    EXPECT_EQ(r.slave, 1999) << "2999 * 2 / 3, whole";
    r.pass(1);
    EXPECT_EQ(r.slave, 2000);
    r.p.fact_m = -3;
    r.begin(SyncMode::position);
    r.pass(3000);
    EXPECT_EQ(r.slave, 0) << "a negative factor turns it";
}

TEST(ApossSync, TheWayIsMadeGoodWithinVelocityAndAccelerationAndWithVelocityGearItIsNot) {
    for (const auto mode : {SyncMode::position, SyncMode::velocity}) {
        Coupled r;
        r.p.velocity = 20;
        r.p.acceleration = r.p.deceleration = 0.5;
        r.begin(mode);
        double before = 0, speed = 0, most = 0;
        for (int i = 0; i < 400; ++i) {
            const double now = r.pass(1);
            EXPECT_LE(std::fabs(now - before - speed), 0.5 + 1e-9) << i;
            speed = now - before;
            most = std::max(most, speed);
            before = now;
        }
        EXPECT_NEAR(speed, 10, 0.2);
        if (mode == SyncMode::position) {
            EXPECT_NEAR(r.slave, 4000, 1) << "what was lost in the ramp is caught up";
            EXPECT_GT(most, 10.5);
        } else {
            EXPECT_LT(r.slave, 3950);
            EXPECT_LE(most, 10.01);
        }
    }
}

TEST(ApossSync, SyncvelrelBoundsHowMuchFasterAndSlowerItMayBe) {
    Coupled r;
    r.p.velocity_relation = 50;
    r.begin(SyncMode::position);
    r.pass(10);
    r.p.offset = 1000;
    double before = r.slave, most = 0, least = 100;
    for (int i = 0; i < 300; ++i) {
        const double now = r.pass(1);
        most = std::max(most, now - before);
        before = now;
    }
    EXPECT_NEAR(most, 15, 1e-6) << "MAVEL + 50 %";
    r.p.offset = 0;
    for (int i = 0; i < 300; ++i) {
        const double now = r.pass(1);
        least = std::min(least, now - before);
        before = now;
    }
    EXPECT_NEAR(least, 5, 1e-6) << "MAVEL - 50 %";
    EXPECT_NEAR(r.slave, 6100, 1e-6);
}

TEST(ApossSync, AnOffsetIsWorkedOffInStepsOfTheMarkerDistanceByTheTime) {  // [L2352-2368]
    EXPECT_EQ(offset_step(500, 100), 5);
    EXPECT_EQ(offset_step(500, 300), 1) << "integer part";
    EXPECT_EQ(offset_step(500, 0), 0) << "at once (E-57)";
    Coupled r;
    r.speed = 0;
    r.p.offset = 500;
    r.p.offset_time = 100;
    r.begin(SyncMode::position);
    double most = 0, before = 0;
    int taken = 0;
    while (r.slave < 499.999 && taken < 1000) {
        const double now = r.pass(1);
        most = std::max(most, now - before);
        before = now;
        ++taken;
    }
    EXPECT_NEAR(taken, 100, 8) << "SYNCOFFTIME for one SYNCMPULSM: 20 % up, 60 % constant, 20 % down";
    EXPECT_NEAR(most, 5 / 0.8, 0.1);
    r.p.offset_time = 0;
    r.p.offset = 700;
    r.pass(2);
    EXPECT_NEAR(r.slave, 700, 1e-6) << "changed online, at once";
}

TEST(ApossSync, WhatTheMasterGoesBackIsBufferedAndConsumed) {  // SYNCTYPE bit 2, SYSVAR 4315 [L4036-4050]
    Coupled r;
    r.p.type = 4;
    r.begin(SyncMode::position);
    r.pass(10);
    EXPECT_EQ(r.slave, 100);
    r.speed = -5;
    r.pass(10);
    EXPECT_EQ(r.slave, 100) << "it does not go back";
    EXPECT_EQ(r.s.negative_buffer(), 50);
    r.speed = 10;
    r.pass(4);
    EXPECT_EQ(r.slave, 100);
    EXPECT_EQ(r.s.negative_buffer(), 10);
    r.pass(2);
    EXPECT_EQ(r.slave, 110);
    EXPECT_EQ(r.s.negative_buffer(), 0);
}

TEST(ApossSync, TheVelocityFilterHasItsTableAndItsSign) {  // [L4668-4730]
    constexpr std::pair<int, int> table[] = {{250, 39500}, {256, 38600}, {500, 19500}, {512, 19000}, {1000, 9500}, {1024, 9300},
                                             {2000, 4500}, {2048, 4400}, {2500, 3500}, {4096, 1900}, {5000, 1400}};
    for (const auto& [counts, us] : table)
        for (const std::int64_t time : {0, 999, -999})
            EXPECT_EQ(velocity_filter_us(time, counts), us) << counts;
    EXPECT_EQ(velocity_filter_us(-100'000, 500), 100'000);
    EXPECT_EQ(velocity_filter_us(0, 4000), 2000) << "another resolution by the formula behind the table (E-36)";
    // Positive: only SYNCV. Cmdvel = Old + (Act - Old) * 1 ms / tau.
    Coupled v;
    v.p.velocity_time = 10'000;
    v.speed = 0;
    v.begin(SyncMode::velocity);
    v.pass(1);
    v.speed = 10;
    EXPECT_NEAR(v.pass(1), 1, 1e-9);
    EXPECT_NEAR(v.pass(1), 1 + 1.9, 1e-9);
    Coupled p;
    p.p.velocity_time = 10'000;
    p.begin(SyncMode::position);
    EXPECT_NEAR(p.pass(1), 10, 1e-9) << "not SYNCP";
    p.p.velocity_time = -10'000;
    p.speed = 0;
    p.begin(SyncMode::position);
    p.pass(1);
    const double from = p.slave;
    p.speed = 10;
    p.pass(20);
    EXPECT_LT(p.slave - from, 190) << "negative: SYNCP as well";
    EXPECT_GT(p.s.filter_error(), 10);
    p.speed = 0;
    p.pass(2000);
    EXPECT_NEAR(p.slave - from, 200, 0.5) << "the error sum is given back: 1000 / (tau * 10) of it each ms";
}

TEST(ApossSync, AFilterWhoseErrorIsTooBigFadesAndComesBack) {  // SYNCVFLIMIT [L5975-5990]
    VelocityFilter f;
    (void)f.step(0, 50'000, 100, true);
    EXPECT_EQ(f.tau_ms(), 50);
    double before = 50;
    for (int i = 0; i < 100; ++i) {
        (void)f.step(10, 50'000, 100, true);
        EXPECT_GE(f.tau_ms(), std::max(5.0, before - 1)) << "1 ms each ms, at least 5";
        before = f.tau_ms();
    }
    EXPECT_LT(before, 50);
    for (int i = 0; i < 3000; ++i)
        (void)f.step(10, 50'000, 100, true);
    EXPECT_EQ(f.tau_ms(), 50) << "below a fifth of the limit it is on again";
}

TEST(ApossSync, MarkersBringTheSlaveOntoTheMaster) {
    struct Row {
        int start;
        double low, high;  // of the first correction
    };
    // The slave's markers come 200 qc of its way after the master's: leading moves forward, subsequent back.
    for (const Row& row : {Row{0, 0, 500}, Row{1, -500, 0}, Row{3, 0, 500}, Row{4, -500, 0}, Row{5, -250, 250}, Row{6, -500, 500}}) {
        SCOPED_TRACE(row.start);
        Coupled r;
        r.p.start = row.start;
        r.marks_m = 500;
        r.marks_s = 500;
        r.first_s = 200;
        r.master = 13;
        r.begin(SyncMode::marker);
        r.pass(600);
        const double shift = r.slave - (static_cast<double>(r.master) - 13);
        EXPECT_GE(shift, row.low - 20);
        EXPECT_LE(shift, row.high + 20);
        // In phase: the slave's marker at 200 + 500 k coincides with the master at 500 j.
        const double phase = std::remainder((r.slave - 200) - static_cast<double>(r.master), 500);
        EXPECT_NEAR(phase, 0, 20);
        EXPECT_TRUE(r.s.status().accuracy);
        EXPECT_TRUE(r.s.status().ready) << "SYNCREADY 1";
        EXPECT_FALSE(r.s.status().fault);
    }
}

TEST(ApossSync, AnOffsetOfSyncmWaitsForTheFirstEvaluation) {  // [L4136]
    Coupled r;
    r.p.offset = 100;
    r.begin(SyncMode::marker);
    r.pass(100);
    EXPECT_EQ(r.slave, 1000) << "no marker yet";
    r.marks_m = 500;
    r.marks_s = 500;
    r.pass(300);
    const double phase = std::remainder(r.slave - static_cast<double>(r.master), 500);
    EXPECT_NEAR(phase, 100, 20);
}

TEST(ApossSync, AMarkerOutsideItsWindowCountsNothing) {  // 30000 +/- 1000 [L5031-5056]
    for (const auto& [distance, accepted] : {std::pair{29'000, true}, {31'000, true}, {28'999, false}, {31'001, false}}) {
        SCOPED_TRACE(distance);
        Synchronisation s;
        SyncParameters p = quick();
        p.pulse_m = 30'000;
        p.window_m = 1000;
        SyncInput in;
        s.begin(SyncMode::marker, p, in, 0, 0);
        in.master_marker = 0;
        (void)s.step(p, in);
        EXPECT_FALSE(s.status().master_window) << "watched from the first marker on";
        in.master = distance;
        in.master_marker = distance;
        (void)s.step(p, in);
        EXPECT_EQ(s.status().master_window, !accepted);
        s.clear_window_flags();
        EXPECT_FALSE(s.status().master_window);
        p.window_m = 0;  // changes are in force at once
        in.master = in.master_marker.emplace(90'000);
        (void)s.step(p, in);
        EXPECT_FALSE(s.status().master_window);
    }
}

TEST(ApossSync, MaxcorrClampsOrForbidsCorrections) {  // SYNCMMAXCORR [L1973-2007]
    for (const auto& [most, shift] : {std::pair{0, 100.0}, {30, 30.0}, {-1, 0.0}}) {
        SCOPED_TRACE(most);
        Synchronisation s;
        SyncParameters p = quick();
        p.start = 6;
        p.most_correction = most;
        SyncInput in;
        s.begin(SyncMode::marker, p, in, 0, 0);
        in.master_marker = 0;
        in.slave_marker = 100;
        double at = s.step(p, in);
        in.master_marker.reset();
        in.slave_marker.reset();
        for (int i = 0; i < 5; ++i)
            at = s.step(p, in);
        EXPECT_NEAR(at, shift, 1e-6);
    }
}

TEST(ApossSync, ReadyAndFaultCountEvaluations) {
    Synchronisation s;
    SyncParameters p = quick();
    p.start = 6;
    p.ready = 2;
    p.fault = 2;
    p.most_correction = -1;
    p.accuracy = -50;
    SyncInput in;
    s.begin(SyncMode::marker, p, in, 0, 0);
    const auto evaluate = [&](double difference) {
        in.master_marker = in.master;
        in.slave_marker = difference;
        (void)s.step(p, in);
        return s.status();
    };
    p.accuracy = 1'000'000;  // in force from the next SYNC command on [L4176]
    EXPECT_FALSE(evaluate(51).accuracy);
    EXPECT_TRUE(evaluate(51).fault) << "SYNCFAULT times inaccurate";
    EXPECT_TRUE(evaluate(50).accuracy);
    EXPECT_FALSE(s.status().fault);
    EXPECT_FALSE(s.status().ready);
    EXPECT_TRUE(evaluate(0).ready);
    EXPECT_FALSE(evaluate(60).ready);
    in.slave = 70;
    in.master_marker.reset();
    in.slave_marker.reset();
    (void)s.step(p, in);
    EXPECT_LT(s.error(), 0) << "a negative SYNCACCURACY gives SYNCERR its sign";
}

TEST(ApossSync, TheMarkerFilterHasTheFormulasOfTheManual) {  // [L2490-2602]
    EXPECT_EQ(marker_filter(1, 2000, 10, 500), 6) << "SYNCMFTIME / 300";
    EXPECT_EQ(marker_filter(1, 100, 10, 500), 1);
    EXPECT_NEAR(marker_filter(0, 2000, 10, 500), 10.0 * 2000 / 1500, 1e-9) << "Oldmfiltvel * SYNCMFTIME / (SYNCMPULSM * 3)";
    MarkerAverage a;
    a.reset(500);
    a.add(600, 500, 13);
    EXPECT_NEAR(a.distance(), 501, 1e-9) << "at least 100 markers";
    EXPECT_NEAR(a.gear_correction(500), (500.0 - 501) / 501, 1e-12);
    EXPECT_NEAR(a.deviation(), 100 - 100.0 / 13, 1e-9) << "the sum without its filtered part";
    // A single late marker moves the slave far less than without the filter.
    double moved[2] = {};
    for (const int filtered : {0, 1}) {
        Synchronisation s;
        SyncParameters p = quick();
        p.start = 6;
        p.filter_time = filtered ? 20'000 : 0;
        p.filter_par = 2;
        SyncInput in;
        s.begin(SyncMode::marker, p, in, 0, 0);
        double at = 0, mark = 0;
        for (int k = 1; k <= 4000; ++k) {
            in.master += 10;
            in.slave = at;
            in.master_marker.reset();
            in.slave_marker.reset();
            if (k % 50 == 0) {
                in.master_marker = in.master + (k == 3000 ? 40 : 0);
                in.slave_marker = static_cast<double>(in.master);
            }
            at = s.step(p, in);
            if (k > 3000) mark = std::max(mark, std::fabs(at - static_cast<double>(in.master)));
        }
        moved[filtered] = mark;
        EXPECT_NEAR(s.marker_distance(), 500, filtered ? 1 : 0) << "SYSVAR 4238";
    }
    EXPECT_GT(moved[0], 20);
    EXPECT_LT(moved[1], moved[0] / 4);
}

TEST(ApossSync, OnlyEachThirdSlaveMarkerIsTaken) {  // SYNCMARKM : SYNCMARKS (E-43)
    Coupled r;
    r.p.mark_s = 3;
    r.p.pulse_m = 1500;
    r.marks_m = 1500;
    r.marks_s = 500;
    r.first_s = 100;
    r.p.start = 6;
    r.begin(SyncMode::marker);
    r.pass(1500);
    const double phase = std::remainder(r.slave - 100 - static_cast<double>(r.master), 500);
    EXPECT_NEAR(phase, 0, 20);
    EXPECT_TRUE(r.s.status().ready);
}

TEST(ApossSync, FeedForwardAddsPerMilleOfTheVelocity) {  // SYNCFFVEL [L5926]
    Coupled r;
    r.p.feed_forward = 1000;
    r.begin(SyncMode::position);
    r.pass(5);
    EXPECT_NEAR(r.slave, 50 + 10, 1e-9) << "1000: one VCMD";
}

TEST(ApossSync, WithoutReverseTheSlaveWaits) {  // REVERS, backlog (E-59)
    Coupled r;
    r.p.reverse = 2;
    r.begin(SyncMode::position);
    r.pass(10);
    r.speed = -10;
    r.pass(5);
    EXPECT_EQ(r.slave, 100);
    r.speed = 10;
    r.pass(5);
    EXPECT_EQ(r.slave, 100) << "what was not gone back is not gone forth";
    r.pass(1);
    EXPECT_EQ(r.slave, 110);
}

TEST(ApossSync, TheVirtualMasterOfTheManual) {  // [L6915-6925]: VMENCRES 2000, PULSACC 1000, PULSVEL 1000
    VirtualMaster m;
    m.run(1000, {});
    m.step(0);
    EXPECT_EQ(m.place(), 0) << "without PULSACC it is off";
    m.accelerate(1000);
    EXPECT_FALSE(m.on()) << "and starts with PULSVEL";
    m.run(1000, {});
    for (int i = 0; i < 1000; ++i)
        m.step(0);
    EXPECT_NEAR(m.velocity(), 1000, 1e-6) << "within a second";
    EXPECT_EQ(m.place(), 500);
    for (int i = 0; i < 1000; ++i)
        m.step(0);
    EXPECT_EQ(m.place(), 1500);
    EXPECT_EQ(index_between(1990, 2010, 2000), 2000);
    EXPECT_EQ(index_between(2010, 1990, 2000), 2000);
    EXPECT_FALSE(index_between(2001, 3999, 2000));
    m.run(0, *virtual_master_of(100));
    m.step(-500);
    EXPECT_NEAR(m.velocity(), 999, 1e-6) << "an axis' velocity, PULSACC bounds it";
}

TEST(ApossSync, TheSquareOfTheCurrentIsFiltered) {  // I2T: 2.5 A steady are 6250 [L6190-6240]
    CurrentWatch w;
    for (int i = 0; i < 3000; ++i)
        w.step(2500, 1000);
    EXPECT_NEAR(static_cast<double>(w.value()), 6250 * 0.95, 30) << "after three times I2TFTIME nearly";
    for (int i = 0; i < 20'000; ++i)
        w.step(2500, 1000);
    EXPECT_EQ(w.value(), 6250);
    EXPECT_TRUE(w.exceeds(1000, 6249));
    EXPECT_FALSE(w.exceeds(1000, 6250));
    EXPECT_FALSE(w.exceeds(0, 0)) << "without a time it is not watched";
}

}  // namespace
}  // namespace axisgate::aposs::test
