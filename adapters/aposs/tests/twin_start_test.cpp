// The start of a synchronisation with markers: SYNCMSTART 7 and SYNCMFPAR 64 of the simulated MACS, without a controller.
#include <gtest/gtest.h>

#include <algorithm>

#include "adapters/aposs/tests/coupled.hpp"
#include "adapters/aposs/tests/macs_bench.hpp"

namespace axisgate::aposs::test {
namespace {

/// Its markers are known: the slave stands 150 qc after one, the master's markers are at multiples of 500.
struct Approaching : Coupled {
    Approaching() {
        p.start = 7;
        p.velocity = 100;
        p.acceleration = 0.05;
        p.offset_time = 0;
        marks_m = 500;
        marks_s = 500;
        first_s = -150;
        master = 1013;
    }
    void begin() {
        SyncInput in;
        in.master = master;
        in.master_marker = 1000;
        in.slave = slave;
        in.slave_marker = first_s;
        s.begin(SyncMode::marker, p, in, slave, 0);
    }
    /// Until the end of the curve: the highest acceleration and jerk, and the way of the master.
    struct Way {
        double acceleration = 0, jerk = 0;
        int stood = 0, ms = 0;
    };
    Way arrive(int most_ms = 20'000) {
        Way w;
        double v = 0, a = 0, at = slave;
        for (; w.ms < most_ms && s.approaches(); ++w.ms) {
            const double next = pass(1), now_v = next - at, now_a = now_v - v;
            if (next == 0) ++w.stood;
            if (w.stood < w.ms) {  // the last step continues with the master
                w.acceleration = std::max(w.acceleration, std::fabs(now_a));
                w.jerk = std::max(w.jerk, std::fabs(now_a - a));
            }
            at = next, v = now_v, a = now_a;
        }
        return w;
    }
    [[nodiscard]] double phase() const { return std::remainder(slave - first_s - static_cast<double>(master), 500); }
};

TEST(ApossStart, APolynomialReachesTheMasterExactlyInAMarker) {  // SYNCMSTART 7 [L4425-4446]
    Approaching r;
    r.begin();
    const auto w = r.arrive();
    EXPECT_GT(w.stood, 50) << "it waits until the markers fit";
    EXPECT_LT(w.stood, 50 + 2 * 50 + 2) << "within two master markers, after the time of the filter";
    EXPECT_NEAR(r.s.velocity(), 10, 0.1) << "at its end with the master's velocity";
    EXPECT_NEAR(r.phase(), 0, 1e-6);
    EXPECT_LE(std::fmod(static_cast<double>(r.master), 500), 10) << "and with the master at a marker";
    EXPECT_LE(w.acceleration, 0.05 * 1.05) << "ACC";
    // 10 qc/ms at 0.05 qc/ms^2 with a curve whose peak is 1.5 times its mean: 300 ms, 6 markers of 50 ms and a part of one.
    EXPECT_GE(w.ms - w.stood, 300);
    EXPECT_LE(w.ms - w.stood, 420);
    r.pass(2'000);
    EXPECT_NEAR(r.phase(), 0, 2) << "and stays there";
    EXPECT_TRUE(r.s.status().accuracy);
    EXPECT_FALSE(r.s.status().master_window || r.s.status().slave_window);
}

TEST(ApossStart, TheCurveIsLongerWithAJerkAndEndsAtAnOffset) {
    Approaching r;
    r.p.jerk = 0.0002;  // sqrt(6 * 10 / 0.0002) = 548 ms
    r.p.offset = 40;
    r.begin();
    const auto w = r.arrive();
    EXPECT_GE(w.ms - w.stood, 548);
    EXPECT_LE(w.jerk, 0.0002 * 1.1);
    EXPECT_NEAR(r.phase(), 40, 1e-6) << "SYNCPOSOFFS is in the curve";
    Approaching late;
    late.p.start = 1007;
    late.p.offset = 40;
    late.begin();
    (void)late.arrive();
    EXPECT_NEAR(late.phase(), 0, 1e-6) << "1007: not before the first correction";
    late.pass(2'000);
    EXPECT_NEAR(late.phase(), 40, 2);
}

TEST(ApossStart, AGearTurnsTheCurveToo) {
    Approaching r;
    r.p.fact_m = -2;  // backward, one way for two
    r.p.pulse_s = 250;
    r.marks_s = 250;
    r.begin();
    (void)r.arrive();
    EXPECT_NEAR(r.s.velocity(), -5, 0.1);
    EXPECT_NEAR(std::remainder(r.slave - r.first_s + static_cast<double>(r.master) / 2, 250), 0, 1e-6);
}

TEST(ApossStart, WithoutASteadyMasterItIsLeftToFive) {
    Approaching stands;
    stands.speed = 0;
    stands.begin();
    stands.pass(60);
    EXPECT_FALSE(stands.s.approaches()) << "the master's velocity is zero: no curve is begun";

    Approaching changes;
    changes.begin();
    for (int i = 0; i < 500 && changes.slave == 0; ++i)
        changes.pass(1);
    ASSERT_TRUE(changes.s.approaches()) << "under way";
    changes.pass(20);
    changes.speed = 12;  // 20 % more
    changes.pass(45);
    EXPECT_FALSE(changes.s.approaches()) << "more than a tenth since it began, by the filter of 50 ms";
    changes.pass(3'000);
    EXPECT_NEAR(changes.phase(), 0, 20) << "the closest marker then";
    Approaching little;
    little.begin();
    for (int i = 0; i < 500 && little.slave == 0; ++i)
        little.pass(1);
    little.speed = 11;  // less than 10 %
    little.master -= 1;
    EXPECT_LT(little.arrive().ms, 600);
    EXPECT_NEAR(little.phase(), 0, 12) << "it is by the master's way, not by time";

    Approaching unknown;
    unknown.Coupled::begin(SyncMode::marker);
    unknown.pass(60);
    EXPECT_FALSE(unknown.s.approaches()) << "no marker of the slave has passed";
    unknown.pass(3'000);
    EXPECT_NEAR(unknown.phase(), 0, 20);

    Approaching fast;
    fast.p.velocity = 5;
    fast.begin();
    fast.pass(60);
    EXPECT_FALSE(fast.s.approaches()) << "VEL is not enough to be with it";
}

TEST(ApossStart, MarkersAreWatchedWithoutSyncmWhereTheParameterSaysSo) {  // SYNCMFPAR 64 [L2424]
    for (const std::int64_t par : {0, 64}) {
        SCOPED_TRACE(par);
        Coupled r;
        r.p.filter_par = par;
        r.p.filter_time = 30'000;
        r.p.pulse_m = 500;
        r.p.window_m = 20;
        r.marks_m = 490;
        const auto watch = [&](int ms) {
            for (int i = 0; i < ms; ++i) {
                SyncInput in;
                if (const auto m =
                        index_between(static_cast<double>(r.master), static_cast<double>(r.master + 10), static_cast<double>(r.marks_m)))
                    in.master_marker = static_cast<std::int64_t>(*m);
                in.master = r.master += 10;
                r.s.watch(r.p, in);
            }
        };
        watch(49 * 1000);
        const double averaged = r.s.marker_distance();
        if (par == 64) EXPECT_NEAR(averaged, 490, 0.5);
        EXPECT_EQ(r.s.status().master_window, false);
        r.marks_m = 600;
        watch(600);
        EXPECT_EQ(r.s.status().master_window, par == 64) << "checked, too";
        r.s.clear_window_flags();
        r.begin(SyncMode::marker);
        if (par == 64) {
            EXPECT_NEAR(r.s.marker_distance(), averaged, 1) << "SYNCM goes on with it";
        } else {
            EXPECT_EQ(r.s.marker_distance(), 500) << "SYNCM begins with SYNCMPULSM";
        }
    }
}

TEST(ApossStart, TheControllerRemembersItsMarkers) {
    Macs b;
    b.enable_axis(0);
    b.enable_axis(1);
    for (const char* line : {"SET RAMPMIN 10 / 100", "SET SYNCMPULSM x(2) 2000", "SET SYNCMPULSS x(2) 2000", "SET SYNCMSTART x(2) 7",
                             "SET MENCODERTYPE x(2) 0"})
        ASSERT_EQ(say(b, line), line);
    b.go(1, 2'700);  // past its index at 2000
    b.pass(5s);
    ASSERT_EQ(b.write(0x6060, 0, 3, 1), Abort::none);
    ASSERT_EQ(b.write(0x60FF, 0, 4'000, 4), Abort::none);
    b.pass(200ms);
    ASSERT_EQ(say(b, "SYNCM x(2)"), "SYNCM x(2)");
    b.pass(3s);
    // The index pulses of slave and master coincide.
    const auto phase = std::remainder(static_cast<double>(b.position_of(1) - b.position_of(0)), 2'000);
    EXPECT_NEAR(phase, 0, 60) << "what the loop lags";
    EXPECT_NE(say(b, "SYNCSTAT x(2)").find("ACCURACY"), std::string::npos);
}

}  // namespace
}  // namespace axisgate::aposs::test
