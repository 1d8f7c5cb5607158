// Laws of the demand position, for every family: unknown while the axis is off, near the shaft in an undisturbed move, at the target
// afterwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class DemandLaws : public Laws {
protected:
    World& w = *world;

    void order(CommandBody body) { Laws::order(a1, std::move(body)); }
    static Move move(std::int64_t target) { return move_to(target); }
    /// The conditions for every picture at any time.
    void whole(const AxisPicture& p) {
        if (p.following_error_known()) return;
        EXPECT_EQ(p.position_demand, p.position) << "register 6 has no null: without a word of its own it is the position";
        EXPECT_EQ(p.following_error(), 0);
    }
    void ends_with(const CommandBody& stop) {
        start();
        w.run_for(1s);
        order(Enable{});
        w.run_for(500ms);
        w.command(a1, move(now().position + 40000), false);
        ASSERT_TRUE(w.run_until_true([&] { return now().velocity >= 3500; }, 5s));
        order(stop);
        w.run_for(3s);
        whole(now());
        EXPECT_EQ(now().flags & flag_moving, 0);
        EXPECT_LE(std::llabs(now().following_error()), 400) << "not at the target, where nobody wants it any more";
    }
};

TEST_P(DemandLaws, OffNobodyWantsItAnywhere) {
    start();
    w.run_for(1s);
    EXPECT_EQ(now().demand_source, DemandSource::none);
    whole(now());
    order(Enable{});
    w.run_for(500ms);
    EXPECT_NE(now().demand_source, DemandSource::none) << "on, and held at its place: everybody can tell";
    EXPECT_EQ(now().position_demand, now().position);
    order(Disable{});
    w.run_for(500ms);
    EXPECT_EQ(now().demand_source, DemandSource::none);
    whole(now());
}

TEST_P(DemandLaws, InAGoodMoveItIsWhereTheShaftIs) {
    start();
    w.run_for(1s);
    order(Enable{});
    w.run_for(500ms);
    const std::int64_t home = now().position;
    for (const std::int64_t target : {home + 8000, home - 4000}) {
        const Ticket go = w.command(a1, move(target), true);
        std::int64_t farthest = 0, most = 0;
        int moving = 0, nobodys = 0;
        for (int i = 0; i < 600; ++i) {
            w.run_for(10ms);
            const AxisPicture p = now();
            whole(p);
            if (p.flags & flag_moving) {
                ++moving;
                if (p.demand_source == DemandSource::none) ++nobodys;
            }
            farthest = std::max(farthest, static_cast<std::int64_t>(std::llabs(p.following_error())));
            most = std::max(most, static_cast<std::int64_t>(std::llabs(p.position_demand - target)));
        }
        EXPECT_GT(moving, 50) << "it was watched while it moved";
        EXPECT_EQ(nobodys, 0) << "an order of this gateway is carried out";
        EXPECT_GT(most, 3000) << "the demand does not jump to the target";
        // The distance in a tenth of a second at this speed: the slowest line polls ten times a second.
        EXPECT_LE(farthest, 400);
        const Result* r = w.result(go);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
        EXPECT_EQ(now().position, target);
        EXPECT_EQ(now().position_demand, target);
    }
}

TEST_P(DemandLaws, AHeldShaftFallsBehindIt) {
    start();
    w.run_for(1s);
    order(Enable{});
    w.run_for(500ms);
    if (now().demand_source == DemandSource::open_loop) {
        // This shaft is not measured, so no following error may be shown, and above all not a constant 0.
        EXPECT_FALSE(now().following_error_known());
        return;
    }
    w.command(a1, move(now().position - 40000), false);
    ASSERT_TRUE(w.run_until_true([&] { return now().velocity <= -3500; }, 5s));
    ASSERT_EQ(hand("stall", Value{true}), "");
    std::int64_t least = 0;
    Duration gave_up = 1h;
    const Instant held = w.now;
    for (int i = 0; i < 400; ++i) {
        w.run_for(5ms);
        whole(now());
        least = std::min(least, now().following_error());
        if (now().flags & flag_fault) gave_up = std::min(gave_up, w.now - held);
    }
    // A drive that gives up at once may do so before a slow line could report it even once more.
    if (gave_up > 100ms) EXPECT_LT(least, -50) << "it should be lower than it is, and is shown to be, until the drive gives up";
}

TEST_P(DemandLaws, AHaltEndsItWhereTheAxisStands) { ends_with(Halt{}); }
TEST_P(DemandLaws, AQuickStopEndsItWhereTheAxisStands) { ends_with(QuickStop{}); }

INSTANTIATE_TEST_SUITE_P(Families, DemandLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
