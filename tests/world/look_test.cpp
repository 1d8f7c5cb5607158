// Fast polling, for every family and wire: an axis is polled more often for a while, its neighbours no less often than before, and all of
// it ends by itself and can be replayed.
#include "tests/world/tape.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class Looked : public testing::TestWithParam<Subject> {};
INSTANTIATE_TEST_SUITE_P(Families, Looked, testing::ValuesIn(subjects()), name_of_subject);

TEST_P(Looked, ItIsAskedMoreOftenAndNobodyLessOften) {
    Tellings tape;
    World w(5);
    w.engine.set_tap(&tape);
    const auto state = w.apply(w.twins(GetParam(), 3));
    const AxisId axis = state->axis_ids[0];
    for (const AxisId a : state->axis_ids)
        ASSERT_TRUE(w.run_until_true([&] { return (w.picture(a).flags & flag_online) != 0; }, 20s));
    w.run_for(3s);
    const auto count = [&](Duration d) {
        const auto before = tape.published;
        w.run_for(d);
        std::map<AxisId, double> rate;
        for (const AxisId a : state->axis_ids)
            rate[a] =
                static_cast<double>(tape.published[a] - (before.contains(a) ? before.at(a) : 0)) / std::chrono::duration<double>(d).count();
        return rate;
    };
    auto plain = count(8s);
    ASSERT_EQ(w.engine.look_closely({axis}, 1ms, w.now + 10s, w.now), "");
    w.run_for(500ms);
    auto close = count(8s);
    const auto report_of_line = w.engine.line_report(state->line_ids[0], w.now);
    const double load = std::max(report_of_line.status.load, report_of_line.twin_status.load);
    EXPECT_TRUE(close[axis] >= 1.5 * plain[axis] || (load > 0.85 && close[axis] >= plain[axis]))
        << close[axis] << " Hz, not looked at " << plain[axis] << " Hz, load of the line " << load;
    for (const AxisId a : state->axis_ids)
        if (a != axis) EXPECT_GE(close[a], 0.93 * plain[a] - 0.3) << "the neighbour " << index_of(a);
    w.run_for(3s);  // the request was not ended
    auto after = count(8s);
    EXPECT_LE(after[axis], 1.1 * plain[axis] + 0.3);
    const auto report = tape.play();
    EXPECT_EQ(report.fault, "");
    EXPECT_EQ(report.differences, 0u);
}

TEST(Look, OfWhatIsNotThereOrOnTwoLinesIsRefused) {
    World w(5);
    const auto state = w.apply(w.twins(subjects()[0], 1));
    EXPECT_NE(w.engine.look_closely({AxisId{77}}, 1ms, w.now + 1s, w.now), "");
    EXPECT_EQ(w.engine.look_closely(state->axis_ids, 0ms, {}, w.now), "");
}

}  // namespace
}  // namespace axisgate::test
