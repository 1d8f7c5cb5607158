// The page of data of the APOSS / MACS controllers is complete, with separate scopes, and null where the manual is silent.
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "gateway/core/catalogue.hpp"

namespace axisgate {
namespace {

const Catalogue& aposs_page() {
    static const Catalogue page = [] {
        std::ifstream f(AXISGATE_SOURCE_DIR "/schema/families/aposs.json");
        std::vector<std::string> faults;
        auto c = Catalogue::parse(std::string(std::istreambuf_iterator<char>(f), {}), faults);
        EXPECT_TRUE(faults.empty()) << (faults.empty() ? "" : faults.front());
        if (!c) throw std::runtime_error("the page cannot be read");
        return std::move(*c);
    }();
    return page;
}

const Parameter* aposs_parameter(std::string_view id) {
    const auto point = aposs_page().find(id);
    return point ? aposs_page().parameter(*point) : nullptr;
}

std::string aposs_scope(const Parameter& p) { return std::string(p.wire.at("scope").as_string()); }

TEST(ApossCatalogue, AllParametersAreThereAndTheScopesAreApart) {
    std::map<std::string, std::set<std::int64_t>> numbers;
    std::set<std::pair<std::int64_t, std::int64_t>> addresses;
    for (const auto& p : aposs_page().parameters()) {
        if (p.storage == "state" || p.storage == "application") continue;  // not the manual's parameters
        const auto number = p.wire.at("number").as_int64();
        EXPECT_TRUE(numbers[aposs_scope(p)].insert(number).second) << p.id;
        EXPECT_TRUE(addresses.emplace(p.wire.at("index").as_int64(), p.wire.at("sub").as_int64()).second) << p.id;
        EXPECT_EQ(p.wire.at("sub").as_int64(), number + 1) << p.id;
    }
    EXPECT_EQ(numbers["axis"].size(), 106U);
    EXPECT_EQ(numbers["global"].size(), 14U);
    std::size_t both = 0;
    for (const auto n : numbers["global"])
        both += numbers["axis"].count(n);
    EXPECT_EQ(both, 14U);  // each number of a global parameter is an axis parameter's too
}

TEST(ApossCatalogue, TheSameNumberIsAnotherParameterInTheOtherScope) {
    const auto* jerk = aposs_parameter("JERKMIN3");
    const auto* baud = aposs_parameter("CANBAUD");
    ASSERT_TRUE(jerk && baud);
    EXPECT_EQ(jerk->wire.at("number").as_int64(), 101);
    EXPECT_EQ(baud->wire.at("number").as_int64(), 101);
    EXPECT_EQ(jerk->wire.at("index").as_int64(), 0x2300);
    EXPECT_EQ(baud->wire.at("index").as_int64(), 0x2200);
}

TEST(ApossCatalogue, DefaultsAreThoseOfTheDetailPages) {
    const std::map<std::string, std::int64_t> detail{{"KDER", 0},     {"KILIM", 1000},  {"POSERR", 1000},
                                                     {"PROFTIME", 1}, {"SYNCREADY", 1}, {"CANSYNCTIMER", 1}};
    for (const auto& [id, value] : detail) {
        const auto* p = aposs_parameter(id);
        ASSERT_TRUE(p) << id;
        EXPECT_EQ(p->factory_default, Value(value)) << id;
    }
    for (const char* id : {"VELMAXQC", "ACCMAXQC"}) {
        const auto* p = aposs_parameter(id);
        ASSERT_TRUE(p) << id;
        EXPECT_FALSE(p->writable()) << id;
    }
}

TEST(ApossCatalogue, EachDefaultLiesInsideWhatIsAccepted) {
    std::size_t bounded = 0;
    for (const auto& p : aposs_page().parameters()) {
        const auto* d = std::get_if<std::int64_t>(&p.factory_default);
        if (!d) continue;
        bounded += p.min || p.max;
        if (p.min) EXPECT_GE(static_cast<double>(*d), *p.min) << p.id;
        if (p.max) EXPECT_LE(static_cast<double>(*d), *p.max) << p.id;
    }
    EXPECT_GT(bounded, 50u);
}

TEST(ApossCatalogue, OnlyPrintedErrorNumbersAreThere) {
    std::set<std::int32_t> codes;
    for (const auto& e : aposs_page().errors())
        codes.insert(e.code);
    // In addition to the five of the manual there are EMCY codes of CiA 301 and CiA 402, which are not numbers of a MACS.
    std::erase_if(codes, [](std::int32_t code) { return code >= 0x1000; });
    EXPECT_EQ(codes, (std::set<std::int32_t>{6, 88, 89, 98, 99}));
}

TEST(ApossCatalogue, ThePrintedPairOfASystemVariable) {
    const auto* p = aposs_parameter("PFG_SYNCMNEGBUFFER");
    ASSERT_TRUE(p);
    EXPECT_EQ(p->wire.at("number").as_int64(), 4315);
    EXPECT_EQ(p->wire.at("index").as_int64(), 0x2500);
    EXPECT_EQ(p->wire.at("sub").as_int64(), 220);
}

}  // namespace
}  // namespace axisgate
