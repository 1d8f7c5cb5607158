// Drives that show their target as reached some time after the standstill: a command that waits for the end of its motion is done then, and
// one that was ended before its target is told all the same.
#include "tests/world/world.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class Settling : public testing::TestWithParam<const char*> {
protected:
    World w{5};
    std::shared_ptr<const SiteState> site;
    AxisId axis = no_axis;

    void SetUp() override {
        const auto all = subjects();
        const auto uim342 = std::ranges::find_if(all, [](const Subject& s) { return s.family->name == "uim342"; });
        ASSERT_NE(uim342, all.end());
        Site wanted = w.twins(*uim342);
        wanted.drives.at(0).options["in_position_ms"] = GetParam();
        site = w.apply(wanted);
        axis = site->axis_ids.at(0);
        ASSERT_TRUE(w.run_until_true([&] { return (w.picture(axis).flags & flag_online) != 0; }, 20s));
        ASSERT_TRUE(good(Enable{}));
    }
    const Result* ask(CommandBody body) { return w.wait(w.command(axis, std::move(body), true), 30s); }
    bool good(CommandBody body) {
        const Result* r = ask(std::move(body));
        return r && r->outcome == Outcome::done;
    }
    static Move to(std::int64_t target) {
        Move m;
        m.target = target;
        m.velocity = 20'000;
        return m;
    }
};
INSTANTIATE_TEST_SUITE_P(InPositionMs, Settling, testing::Values("0", "200", "300", "1000", "2000"));

TEST_P(Settling, AMoveIsDoneWhenTheDriveShowsItsTarget) {
    for (const std::int64_t target : {8'000, -3'000, 0}) {
        const Result* r = ask(to(target));
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::done) << r->text;
        EXPECT_EQ(w.picture(axis).position, target);
    }
}

TEST_P(Settling, AMoveThatEndsBeforeItsTargetIsToldSoon) {
    const Ticket t = w.command(axis, to(400'000), true);
    w.run_for(2s);
    ASSERT_EQ(w.engine.set_hand(site->drive_ids.at(0), {{"stall", Value{true}}}, {}, w.now), "");
    const Instant stalled = w.now;
    const Result* r = w.wait(t, 30s);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->outcome, Outcome::failed) << r->text;
    EXPECT_LT(w.now - stalled, 5s);
}

}  // namespace
}  // namespace axisgate::test
