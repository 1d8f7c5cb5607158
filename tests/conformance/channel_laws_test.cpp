// Laws of several axes at once, for every family and wire: as many as one drive of the family can have, or three drives on one line if each
// has one. A stopped axis stops, the others continue, and an axis without an order rests. Judged by the mechanics of the twins.
#include <gtest/gtest.h>

#include "tests/conformance/laws.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class ChannelLaws : public Laws {
protected:
    World& w = *world;

    /// Every channel of one drive; three drives if a drive has one channel.
    void start_all() {
        const int most = e.catalogue->most_channels();
        start(most > 1 ? 1 : 3, most);
        ASSERT_EQ(site->axis_ids.size(), static_cast<std::size_t>(most > 1 ? most : std::ssize(addresses(e, 3))));
    }
    void enable_all() {
        for (const AxisId axis : site->axis_ids)
            ASSERT_NO_FATAL_FAILURE(order(axis, Enable{}));
    }
    /// Two axes that move far away in opposite directions, by any means of their drive.
    void turn_two(AxisId one, AxisId other) {
        ASSERT_NO_FATAL_FAILURE(turn(one, 2000));
        ASSERT_NO_FATAL_FAILURE(turn(other, -2000));
    }
    [[nodiscard]] std::vector<double> places() const {
        std::vector<double> list;
        for (const AxisId axis : site->axis_ids)
            list.push_back(mechanics(axis).position);
        return list;
    }
    /// All other axes stand at their former positions.
    void rest(const std::vector<double>& before, std::initializer_list<AxisId> but) {
        for (std::size_t i = 0; i < before.size(); ++i) {
            const AxisId axis = site->axis_ids[i];
            if (std::ranges::find(but, axis) != but.end()) continue;
            EXPECT_EQ(speed(axis), 0) << "axis a" << i + 1 << " moves, and nobody has told it to";
            EXPECT_EQ(mechanics(axis).position, before[i]) << "axis a" << i + 1;
        }
    }
};

TEST_P(ChannelLaws, AStopOfOneLeavesTheOthersAlone) {
    start_all();
    enable_all();
    const AxisId one = site->axis_ids.front(), other = site->axis_ids.back();
    if (one == other) {  // this line can have only one axis
        EXPECT_EQ(e.catalogue->most_channels(), 1);
        EXPECT_EQ(addresses(e, 3).size(), 1u);
        return;
    }
    for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        const std::string by(name_of(stop));
        const auto before = places();
        turn_two(one, other);
        ASSERT_FALSE(HasFatalFailure());
        const auto asked = w.now;
        const Result* r = ask(one, stop);
        ASSERT_TRUE(r && good(*r)) << by << ": " << published(r);
        EXPECT_LT(w.now - asked, 5s) << by;
        if (std::holds_alternative<Disable>(stop)) {  // its power is off, so it cannot brake
            EXPECT_FALSE(mechanics(one).powered) << by;
            (void)w.run_until_true([&] { return speed(one) == 0; }, 2s);
        }
        EXPECT_EQ(speed(one), 0) << by << ": done, and it turns";
        EXPECT_GT(speed(other), 1900) << by << ": the other one goes on";
        const double place = mechanics(other).position;
        const std::int64_t shown = now(other).position;
        w.run_for(2s);
        EXPECT_LT(mechanics(other).position, place - 3500) << by << ": at its own speed, all the time";
        EXPECT_LT(now(other).position, shown - 1000) << by << ": and is seen to";
        EXPECT_FALSE(moving(one)) << by;
        rest(before, {one, other});
        order(other, Halt{});
        EXPECT_EQ(speed(other), 0);
        order(one, Enable{});
    }
}

TEST_P(ChannelLaws, StopsOfAllStopAllAndEachIsAnswered) {
    start_all();
    enable_all();
    for (const bool quick : {false, true}) {
        for (const AxisId axis : {site->axis_ids.front(), site->axis_ids.back()}) {
            if (speed(axis) == 0) ASSERT_NO_FATAL_FAILURE(turn(axis, 2000));
        }
        const auto asked = w.now;
        std::vector<Ticket> stops;
        for (const AxisId axis : site->axis_ids)
            stops.push_back(w.command(axis, quick ? CommandBody{QuickStop{}} : CommandBody{Halt{}}, true));
        ASSERT_TRUE(
            w.run_until_true([&] { return std::ranges::all_of(site->axis_ids, [&](AxisId axis) { return speed(axis) == 0; }); }, 5s))
            << "an axis goes on " << seconds(w.now - asked) << " s after its stop";
        for (const Ticket t : stops) {
            const Result* r = w.wait(t, 60s);
            EXPECT_TRUE(r && good(*r)) << published(r);
        }
        w.run_for(1s);
        for (const Ticket t : stops)
            EXPECT_EQ(w.results[t].size(), 1u);
        for (const AxisId axis : site->axis_ids) {
            EXPECT_EQ(power_state_of(now(axis).statusword), quick ? PowerState::quick_stop_active : PowerState::operation_enabled);
            EXPECT_EQ(speed(axis), 0);
        }
        for (const AxisId axis : site->axis_ids)
            order(axis, Enable{});
    }
}

TEST_P(ChannelLaws, WhatNoOrderMovesRests) {
    start_all();
    const auto before = places();
    // Some drives have power from their start; the others get it only by an enable of their own.
    std::vector<bool> had;
    for (const AxisId axis : site->axis_ids) {
        had.push_back(mechanics(axis).powered);
        EXPECT_EQ(power_state_of(now(axis).statusword), PowerState::switch_on_disabled) << "nothing is enabled because something started";
    }
    const auto none_gains = [&](AxisId but, const std::string& by) {
        for (std::size_t i = 0; i < had.size(); ++i) {
            const AxisId axis = site->axis_ids[i];
            if (axis != but) EXPECT_TRUE(had[i] || !mechanics(axis).powered) << by << " has switched on axis a" << i + 1;
        }
    };
    // Reading, writing the present value, reset, stop, switching on and off move no shaft, and enabling one axis enables one.
    const AxisId one = site->axis_ids.front();
    for (std::uint16_t i = 0; i < e.catalogue->parameters().size(); ++i) {
        if (e.catalogue->parameters()[i].readable()) (void)ask(one, ReadParameter{first_point(i)}, false);
    }
    rest(before, {});
    none_gains(no_axis, "reading");
    for (const CommandBody& body : {CommandBody{ResetFault{}}, CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        (void)ask(one, body);
        rest(before, {});
        none_gains(no_axis, std::string(name_of(body)));
    }
    order(one, Enable{});
    w.run_for(1s);
    rest(before, {});
    EXPECT_TRUE(mechanics(one).powered);
    none_gains(one, "the enable of another axis");
    ASSERT_NO_FATAL_FAILURE(turn(one, 2000));
    w.run_for(2s);
    rest(before, {one});
    order(one, Disable{});
    EXPECT_FALSE(mechanics(one).powered);
    (void)w.run_until_true([&] { return speed(one) == 0; }, 2s);
    EXPECT_EQ(speed(one), 0);
    none_gains(one, "the disable of another axis");
}

TEST_P(ChannelLaws, PreparedMovesBeginTogetherOrAreRefused) {
    start_all();
    enable_all();
    const auto before = places();
    const auto& all = site->axis_ids;
    bool able = true;
    for (const AxisId axis : all) {
        Move m = move_to(now(axis).position + 3000);
        m.prepare_only = true;
        const Result* r = ask(axis, m, false);
        ASSERT_TRUE(r);
        if (r->reason == Reason::not_supported) {
            EXPECT_FALSE(r->text.empty());
            able = false;
        } else {
            ASSERT_TRUE(good(*r)) << published(r);
        }
    }
    EXPECT_EQ(able, fact("prepared_moves"));
    w.run_for(2s);
    rest(before, {});
    StartTogether go;
    go.axes = all;
    const Result* r = ask(all[0], go);
    ASSERT_TRUE(r);
    if (!able) {
        EXPECT_FALSE(good(*r)) << "none of them is prepared";
        EXPECT_FALSE(r->text.empty());
        w.run_for(2s);
        return rest(before, {});
    }
    ASSERT_TRUE(good(*r)) << published(r);
    EXPECT_EQ(r->outcome, Outcome::done);
    w.run_for(500ms);
    for (const AxisId axis : all) {
        EXPECT_EQ(speed(axis), 0) << "done when all have arrived";
        EXPECT_EQ(now(axis).position, 3000);
    }
    r = ask(all[0], go, true);  // a started motion is not prepared any more
    ASSERT_TRUE(r);
    w.run_for(2s);
    for (const AxisId axis : all)
        EXPECT_EQ(now(axis).position, 3000) << published(r);
}

INSTANTIATE_TEST_SUITE_P(Families, ChannelLaws, testing::ValuesIn(law_subjects()), name_of_subject);

}  // namespace
}  // namespace axisgate::test
