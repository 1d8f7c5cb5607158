// The rate of reports of a twin under fast polling; the time of its frames on the wire is the limit.
#include <algorithm>

#include "tests/conformance/laws.hpp"
#include "tests/world/tape.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

class LookLaws : public Laws {
protected:
    Tellings tape;
    void TearDown() override { world->engine.set_tap(nullptr); }  // the world is destroyed last
};
INSTANTIATE_TEST_SUITE_P(Families, LookLaws, testing::ValuesIn(law_subjects()), name_of_subject);

TEST_P(LookLaws, ATwinTellsAThousandTimesASecondWhereItsWireLetsIt) {
    ASSERT_NO_FATAL_FAILURE(start());
    world->engine.set_tap(&tape);
    ASSERT_EQ(world->engine.look_closely({a1}, 1ms, world->now + 20s, world->now), "");
    world->run_for(500ms);
    const auto before = tape.published[a1];
    world->run_for(4s);
    const double rate = static_cast<double>(tape.published[a1] - before) / 4;
    const auto line = world->engine.line_report(site->line_ids[0], world->now);
    const double load = std::max(line.status.load, line.twin_status.load);
    EXPECT_TRUE(rate >= 990 || load > 0.85) << rate << " Hz, load of the line " << load;
}

}  // namespace
}  // namespace axisgate::test
