// The timing of a line in site documents: the present name, and the one of earlier versions.
#include <gtest/gtest.h>

#include <boost/json/parse.hpp>
#include <chrono>

#include "gateway/site/site.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

std::optional<Site> read(std::string_view line_members, std::vector<SiteFault>& faults) {
    const std::string text = R"({"lines": [{"name": "l", "uri": "twin", "family": "demo")" + std::string(line_members) +
                             R"(}], "drives": [], "axes": [], "mappings": []})";
    static const auto page = [] {
        std::vector<std::string> wrong;
        return *Catalogue::parse(R"({"family": "demo", "number": 7, "parameters": [], "commands": [], "errors": []})", wrong);
    }();
    static Family family{};
    family.name = "demo";
    family.uses_can = true;
    Families families;
    families.entries.push_back({&family, &page});
    return parse_site(boost::json::parse(text), families, faults);
}

TEST(LineTiming, TheOldWordIsReadAndTheNewOneWritten) {
    for (const char* members : {R"(, "timing": {"retries": 3, "pause_ms": 7})", R"(, "manners": {"retries": 3, "pause_ms": 7})",
                                R"(, "timing": {"retries": 9, "pause_ms": 7}, "manners": {"retries": 3})"}) {
        std::vector<SiteFault> faults;
        const auto site = read(members, faults);
        ASSERT_TRUE(site) << members;
        EXPECT_EQ(site->lines.at(0).timing.retries, 3) << members;
        EXPECT_EQ(site->lines.at(0).timing.pause, 7ms) << members;
        const auto line = to_json(*site).at("lines").at(0).as_object();
        EXPECT_TRUE(line.contains("timing")) << members;
        EXPECT_FALSE(line.contains("manners")) << members;
    }
}

TEST(LineTiming, AFaultIsAtTheWordThatWasWritten) {
    for (const char* word : {"timing", "manners"}) {
        std::vector<SiteFault> faults;
        EXPECT_FALSE(read(std::string(R"(, ")") + word + R"(": {"retries": 21})", faults));
        ASSERT_EQ(faults.size(), 1u);
        EXPECT_EQ(faults[0].pointer, std::string("/lines/0/") + word + "/retries");
    }
}

}  // namespace
}  // namespace axisgate
