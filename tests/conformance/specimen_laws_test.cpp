// Laws over specimens: every family on each of its wires, as each of the named extremes and as two drawn drives.
#include <gtest/gtest.h>

#include "tests/conformance/laws.hpp"
#include "tests/world/specimen_day.hpp"

namespace axisgate::test {
namespace {

/// The named extremes, and seeds that are the same in each run.
std::vector<Subject> specimen_subjects() {
    std::vector<Subject> out;
    for (const Subject& s : subjects()) {
        if (s.catalogue->freedoms().empty()) continue;
        std::vector<std::string_view> specimens(named_specimens.begin(), named_specimens.end());
        specimens.insert(specimens.end(), {"1", "2"});
        for (const std::string_view name : specimens) {
            out.push_back(s);
            out.back().specimen = name;
        }
    }
    return out;
}

class SpecimenLaws : public testing::TestWithParam<Subject> {
protected:
    SpecimenDay day{GetParam()};
};

TEST_P(SpecimenLaws, IsFoundAndStaysServed) { day.is_found_and_stays_served(); }
TEST_P(SpecimenLaws, AMotionThatWasAcceptedIsMadeOrIsToldAsNotMade) { day.a_motion_is_made_or_told_as_not_made(); }
TEST_P(SpecimenLaws, AnAcceptedMotionBeginsWithinItsBound) { day.an_accepted_motion_begins_within_its_bound(); }
TEST_P(SpecimenLaws, AStopEndsEachMotionAndHasAnAnswer) { day.a_stop_ends_each_motion(); }
TEST_P(SpecimenLaws, AStreamBeginsWhereTheAxisIs) { day.a_stream_begins_where_the_axis_is(); }
TEST_P(SpecimenLaws, TheNextGatewayFindsTheDriveAsItIs) { day.the_next_gateway_finds_it(); }

INSTANTIATE_TEST_SUITE_P(Families, SpecimenLaws, testing::ValuesIn(specimen_subjects()), name_of_subject);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(SpecimenLaws);

}  // namespace
}  // namespace axisgate::test
