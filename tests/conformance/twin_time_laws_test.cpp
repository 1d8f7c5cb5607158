// Law of time, for every family: a twin's reaction has the instant of its cause, not of the host's wake-up. A conversation of a gateway
// with a twin is recorded once and played with twins that are called at every deadline, in steps, or only at frames: frames, their instants
// and motions must be equal.
#include <gtest/gtest.h>

#include <memory>

#include "tests/world/world.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

struct Reported {
    Instant at;
    std::string bytes;  ///< byte lines: all of one instant; CAN: identifier and data of one frame
};

class TwinTimeLaws : public testing::TestWithParam<FamilyEntry> {
protected:
    const FamilyEntry& e = GetParam();
    Instant begin{};
    std::vector<Frame> received;  ///< frames to the drive, at the instants of their arrival
    std::string address;
    LineKind kind = LineKind::bytes;

    /// An axis that is found, enabled and sent on a way of some seconds; then nothing more is sent.
    void converse() {
        World w;
        begin = w.now;
        const auto site = w.apply(w.make_site(e, "twin", 1));
        const AxisId a = site->axis_ids.at(0);
        address = addresses(e, 1).at(0);
        ASSERT_TRUE(w.run_until_true([&] { return (w.picture(a).flags & flag_online) != 0; }, 10s));
        w.run_for(500ms);
        const Result* r = w.wait(w.command(a, Enable{}, true), 5s);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "none");
        Move far;
        far.kind = Move::Kind::relative;
        far.target = 8000;
        far.velocity = 4000;
        far.acceleration = far.deceleration = 20000;
        (void)w.command(a, far, true);
        ASSERT_TRUE(w.run_until_true([&] { return (w.picture(a).flags & flag_moving) != 0; }, 5s));
        const auto log = w.engine.frame_log(site->line_ids.at(0))->read(1, 100000, 0);
        ASSERT_EQ(log.missed, 0U);
        for (const auto& entry : log.entries) {
            if (!entry.to_drive) continue;
            received.push_back(entry.frame);
            received.back().at = at_ns(entry.at_unix_ns);
        }
        ASSERT_GT(received.size(), 5U);
        kind = received.front().kind == Frame::Kind::can ? LineKind::can : LineKind::bytes;
    }

    struct Played {
        std::vector<Reported> reported;
        std::vector<TwinMechanics> seen;
    };
    /// `step` is how often the twin is called beside frames; zero: never. `punctual`: at each of its deadlines as well.
    Played play(Duration step, bool punctual) {
        TwinSetup t;
        t.address = address;
        t.kind = kind;
        t.bit_rate = kind == LineKind::can ? e.family->default_can_bit_rate : e.family->default_bit_rate;
        const auto twin = e.family->make_twin(*e.catalogue, t);
        Played p;
        Out out;
        const auto take = [&] {
            for (const auto& tx : out.frames) {
                const Frame& f = tx.frame;
                std::string bytes(reinterpret_cast<const char*>(f.data().data()), f.size);
                if (f.kind == Frame::Kind::bytes && !p.reported.empty() && p.reported.back().at == f.at) {
                    p.reported.back().bytes += bytes;
                } else {
                    p.reported.push_back({f.at, f.kind == Frame::Kind::can ? std::to_string(f.id) + ":" + bytes : bytes});
                }
            }
            out.clear();
        };
        twin->power_on({}, begin, out);
        take();
        Instant now = begin;
        const auto pass = [&](Instant until) {
            while (step > Duration::zero() && now < until) {
                Instant next = std::min(now + step, until);
                if (punctual) next = std::min(next, std::max(twin->deadline(), now + 1us));
                now = next;
                twin->on_deadline(now, out);
                take();
            }
            now = until;
        };
        for (const Frame& f : received) {
            pass(f.at);
            twin->on_frame(f, f.at, out);
            take();
        }
        // In the middle of the way the shaft is held and released: two causes without a call; then the way ends unobserved.
        const Instant last = now;
        for (const auto& [after, held] : {std::pair{700ms, true}, {900ms, false}}) {
            pass(last + after);
            EXPECT_EQ(twin->set_hand("stall", Value{held}, now, out), "");
            take();
            p.seen.push_back(twin->mechanics(1, now));
        }
        pass(last + 9s);
        // A twin that monitors its master has stopped meanwhile: a cause of its own, which needs one call, however late.
        if (twin->deadline() <= now) twin->on_deadline(now, out);
        take();
        p.seen.push_back(twin->mechanics(1, now));
        Frame again = received.back();  // the last question once more
        again.at = now;
        twin->on_frame(again, now, out);
        take();
        pass(now + 200ms);
        if (twin->deadline() <= now || step == Duration::zero()) twin->on_deadline(now, out);
        take();
        p.seen.push_back(twin->mechanics(1, now));
        return p;
    }
};

TEST_P(TwinTimeLaws, WhatItSaysAndDoesStandsAtTheInstantOfItsCause) {
    ASSERT_NO_FATAL_FAILURE(converse());
    const Played fine = play(1ms, true);
    ASSERT_GT(fine.reported.size(), 3U);
    for (const Duration step : {Duration{10ms}, Duration{86ms}, Duration{1s}, Duration{}}) {
        SCOPED_TRACE(testing::Message() << "called every " << step / 1ms << " ms (0: for frames alone)");
        const Played late = play(step, false);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < std::max(fine.reported.size(), late.reported.size()) && differ < 5; ++i) {
            const bool both = i < fine.reported.size() && i < late.reported.size();
            if (both && fine.reported[i].at == late.reported[i].at && fine.reported[i].bytes == late.reported[i].bytes) continue;
            ++differ;
            ADD_FAILURE() << "frame " << i << (both ? "" : " is missing or one too many") << ": "
                          << (i < fine.reported.size() ? testing::PrintToString(fine.reported[i].bytes) : "-") << " at "
                          << (i < fine.reported.size() ? (fine.reported[i].at - begin) / 1us : 0) << " us, called late "
                          << (i < late.reported.size() ? testing::PrintToString(late.reported[i].bytes) : "-") << " at "
                          << (i < late.reported.size() ? (late.reported[i].at - begin) / 1us : 0) << " us";
        }
        for (std::size_t i = 0; i < fine.seen.size(); ++i) {
            EXPECT_NEAR(fine.seen[i].position, late.seen[i].position, 1e-3) << "picture " << i;
            EXPECT_NEAR(fine.seen[i].velocity, late.seen[i].velocity, 1e-3) << "picture " << i;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Families, TwinTimeLaws, testing::ValuesIn(families().entries),
                         [](const testing::TestParamInfo<FamilyEntry>& i) { return std::string(i.param.family->name); });

}  // namespace
}  // namespace axisgate::test
