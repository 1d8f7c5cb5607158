// Conformance: the site's limits of position hold for velocity moves, too, by command and by registers, for every family.
// In: all_families(). Out: laws of guard and engine, on twins. Never names a family.
#include <gtest/gtest.h>

#include <cstdlib>

#include "tests/world/world.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class LimitLaws : public testing::TestWithParam<FamilyEntry> {
protected:
    const FamilyEntry& e = GetParam();
    World w;
    AxisId a = no_axis;
    static constexpr std::int64_t limit = 10'000;  // 100 units of 100 increments

    AxisPicture now() { return w.picture(a); }
    void start() {
        Site site = w.make_site(e, "twin", 1);
        site.axes[0].position_min = -100;
        site.axes[0].position_max = 100;
        a = w.apply(std::move(site))->axis_ids.at(0);
        ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_online) != 0; }, 10s));
        w.run_for(1s);
        const Result* r = w.wait(w.command(a, Enable{}, true), 10s);
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
    }
    const Result* jog(std::int64_t velocity) {
        Move m;
        m.kind = Move::Kind::velocity;
        m.target = velocity;
        m.acceleration = m.deceleration = 20'000;
        return w.wait(w.command(a, m), 10s);
    }
    /// It comes to rest at the limit: not beyond it by more than what one late feedback explains, and not far before it either.
    void rests_at(std::int64_t place) {
        ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) == 0; }, 30s));
        w.run_for(500ms);
        EXPECT_LE(std::llabs(now().position - place), 1'500) << "at " << now().position;
        EXPECT_LE(std::llabs(now().position), limit + 300) << "beyond its limit, at " << now().position;
        EXPECT_NE(now().statusword & cia402::sw_internal_limit, 0);
        EXPECT_EQ(std::ranges::count_if(w.events, [](const Event& v) { return v.kind == "limit" && v.severity == Severity::warning; }), 1);
        w.events.clear();
    }
};

TEST_P(LimitLaws, AVelocityMoveIsHaltedAtTheLimitAndMayOnlyGoBack) {
    start();
    for (const std::int64_t direction : {1, -1}) {
        const Result* r = jog(direction * 5'000);
        ASSERT_TRUE(r);
        if (r->reason == Reason::not_supported) {
            EXPECT_FALSE(r->text.empty()) << "where a drive cannot follow, it says so";
            return;
        }
        ASSERT_TRUE(good(*r)) << r->text;
        ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) != 0; }, 5s));
        rests_at(direction * limit);
        Move out;
        out.target = direction * limit;
        out.velocity = 2'000;
        r = w.wait(w.command(a, out, true), 30s);  // whatever was left to it, by a positioning
        ASSERT_TRUE(r && good(*r)) << (r ? r->text : "no result");
        EXPECT_EQ(now().statusword & cia402::sw_internal_limit, 0) << "another motion has begun and ended since";
        r = jog(direction * 5'000);
        ASSERT_TRUE(r);
        EXPECT_EQ(r->outcome, Outcome::refused) << "outwards";
        EXPECT_EQ(r->reason, Reason::out_of_range);
        EXPECT_NE(r->text.find(direction > 0 ? "position_max" : "position_min"), std::string::npos) << r->text;
    }
}

TEST_P(LimitLaws, RegistersDoNotLeadOutEither) {
    start();
    const auto write = [&](auto&& fill) {
        ProcessData d;
        fill(d);
        const Result* r = w.wait(w.command(a, d), 10s);
        return r ? *r : Result{};
    };
    (void)write([](ProcessData& d) {
        d.mode = cia402::mode_profile_velocity;
        d.profile_acceleration = d.profile_deceleration = 20'000;
    });
    for (const int cw : {0x06, 0x07, 0x0F}) (void)write([&](ProcessData& d) { d.controlword = static_cast<std::uint16_t>(cw); });
    const Result go = write([](ProcessData& d) { d.target_velocity = -5'000; });
    if (go.reason == Reason::not_supported) return;
    ASSERT_TRUE(good(go)) << go.text;
    ASSERT_TRUE(w.run_until_true([&] { return (now().flags & flag_moving) != 0; }, 5s));
    rests_at(-limit);
}

INSTANTIATE_TEST_SUITE_P(Families, LimitLaws, testing::ValuesIn(families().entries),
                         [](const testing::TestParamInfo<FamilyEntry>& i) { return std::string(i.param.family->name); });

}  // namespace
}  // namespace axisgate::test
