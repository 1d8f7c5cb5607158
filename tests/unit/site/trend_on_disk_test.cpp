// An axis whose trends are stored on the disk: read, written, shown as a difference that disturbs nothing.
#include <gtest/gtest.h>

#include <boost/json/parse.hpp>

#include "gateway/site/site.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

struct SiteTrends : testing::Test {
    SiteTrends() {
        std::vector<std::string> wrong;
        catalogue = *Catalogue::parse(R"({"family": "demo", "number": 7, "parameters": [], "commands": [], "errors": []})", wrong);
        family.name = "demo";
        family.check_address = [](std::string_view) { return std::string(); };
        family.uses_can = true;
        families.entries.push_back({&family, &catalogue});
    }
    std::optional<Site> read(const std::string& member) {
        faults.clear();
        return parse_site(json::parse(R"({"lines": [{"name": "l", "uri": "twin", "family": "demo"}],
            "drives": [{"name": "d", "line": "l", "address": 1}], "axes": [{"name": "x", "drive": "d", "number": 1)" +
                                      member + "}]}"),
                          families, faults);
    }
    Catalogue catalogue;
    Family family{};
    Families families;
    std::vector<SiteFault> faults;
};

TEST_F(SiteTrends, AreInMemoryUnlessTheSiteSaysOtherwise) {
    const auto without = read(""), off = read(R"(, "trend_on_disk": false)"), on = read(R"(, "trend_on_disk": true)");
    ASSERT_TRUE(without && off && on);
    EXPECT_FALSE(without->axes[0].trend_on_disk);
    EXPECT_TRUE(on->axes[0].trend_on_disk);
    EXPECT_EQ(off->axes[0], without->axes[0]);
    EXPECT_FALSE(to_json(without->axes[0]).contains("trend_on_disk"));
    EXPECT_EQ(to_json(on->axes[0]).at("trend_on_disk"), json::value(true));
    EXPECT_EQ(site_diff(*without, *on).size(), 1u);
    EXPECT_TRUE(site_diff(*without, *off).empty());
    EXPECT_TRUE(disturbed_axes(*without, *on).empty());
}

TEST_F(SiteTrends, AreOnTheDiskOrNot) {
    for (const auto* wrong : {R"("yes")", "1", "[]"}) {
        EXPECT_FALSE(read(std::string(R"(, "trend_on_disk": )") + wrong)) << wrong;
        ASSERT_EQ(faults.size(), 1u) << wrong;
        EXPECT_EQ(faults[0].pointer, "/axes/0/trend_on_disk");
    }
}

}  // namespace
}  // namespace axisgate
