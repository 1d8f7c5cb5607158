// Descriptions in a site: named by drives, looked up on the shelf, and made into a catalogue once for all drives and changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/json/parse.hpp>

#include "gateway/site/site.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;
int made = 0;

OwnCatalogue one_more(const CatalogueWish& wish) {
    if (!wish.description) return {};
    ++made;
    if (wish.description->text == "broken") return {nullptr, "description " + wish.description->name + ", line 3: broken"};
    std::vector<std::string> faults;
    const json::array more{json::object{{"id", wish.description->text},
                                        {"name", "own"},
                                        {"group", "g"},
                                        {"type", "u8"},
                                        {"access", "R"},
                                        {"description", "d"},
                                        {"storage", "ram"}}};
    auto c = wish.page.with(more, faults);
    if (!c) return {nullptr, faults.front()};
    return {std::make_shared<const Catalogue>(std::move(*c)), {}};
}

class SiteDescriptions : public testing::Test {
protected:
    SiteDescriptions() {
        made = 0;
        std::vector<std::string> wrong;
        page = *Catalogue::parse(R"({"family": "demo", "number": 7, "parameters": [], "commands": [], "errors": []})", wrong);
        family.name = "demo";
        family.check_address = [](std::string_view) { return std::string(); };
        family.factory_address = "5";
        family.uses_can = true;
        family.own_catalogue = one_more;
        family.takes_description = true;
        families.entries.push_back({&family, &page});
        families.descriptions = std::make_shared<DescriptionShelf>();
        families.descriptions->put({{"a.eds", "A"}, "me", 1});
        families.descriptions->put({{"b.eds", "broken"}, "me", 1});
    }
    std::optional<Site> parse(const std::string& one, const std::string& two) {
        faults.clear();
        return parse_site(json::parse(R"({"lines": [{"name": "l", "uri": "twin", "family": "demo"}], "drives": [
            {"name": "x", "line": "l", "address": 1)" +
                                      one + R"(}, {"name": "y", "line": "l", "address": 2)" + two + "}]}"),
                          families, faults);
    }
    Catalogue page;
    Family family{};
    Families families;
    std::vector<SiteFault> faults;
};

TEST_F(SiteDescriptions, AreNamedByDrivesAndKeptInTheDocument) {
    const auto site = parse(R"(, "description": "a.eds")", "");
    ASSERT_TRUE(site);
    EXPECT_EQ(site->drive("x")->description, "a.eds");
    EXPECT_TRUE(catalogue_of(*site, *site->drive("x"), families)->find("A"));
    EXPECT_FALSE(catalogue_of(*site, *site->drive("y"), families)->find("A"));
    EXPECT_EQ(to_json(*parse_site(to_json(*site), families, faults)), to_json(*site));
    EXPECT_FALSE(*parse("", "")->drive("x") == *site->drive("x")) << "the drive is made anew";
}

TEST_F(SiteDescriptions, OneFileIsReadOnceForAllDrivesAndAsLongAsASiteHasIt) {
    {
        const auto site = parse(R"(, "description": "a.eds")", R"(, "description": "a.eds")");
        ASSERT_TRUE(site);
        EXPECT_EQ(made, 1);
        EXPECT_EQ(site->own_catalogues.at("x"), site->own_catalogues.at("y"));
        (void)parse(R"(, "description": "a.eds")", "");
        EXPECT_EQ(made, 1);
        (void)parse(R"(, "description": "a.eds", "options": {"more": "1"})", "");
        EXPECT_EQ(made, 2) << "with other options it may be another catalogue";
        families.descriptions->remove("a.eds");
        families.descriptions->put({{"a.eds", "B"}, "me", 2});
        const auto other = parse(R"(, "description": "a.eds")", "");
        ASSERT_TRUE(other);
        EXPECT_TRUE(other->own_catalogues.at("x")->find("B")) << "another file of the same name";
    }
    made = 0;
    (void)parse(R"(, "description": "a.eds")", "");
    EXPECT_EQ(made, 1);
}

TEST_F(SiteDescriptions, AnUnknownNameIsRefusedWithTheList) {
    EXPECT_FALSE(parse(R"(, "description": "c.eds")", ""));
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].pointer, "/drives/0/description");
    EXPECT_THAT(faults[0].text, testing::HasSubstr("c.eds"));
    EXPECT_THAT(faults[0].remedy, testing::HasSubstr("a.eds, b.eds"));
    EXPECT_FALSE(parse(R"(, "description": "b.eds")", ""));
    EXPECT_EQ(faults[0].pointer, "/drives/0/description");
    EXPECT_THAT(faults[0].text, testing::HasSubstr("line 3"));
    families.descriptions = nullptr;
    EXPECT_FALSE(parse(R"(, "description": "a.eds")", ""));
    EXPECT_THAT(faults[0].remedy, testing::HasSubstr("there are: none"));
    family.takes_description = false;
    EXPECT_FALSE(parse(R"(, "description": "a.eds")", ""));
    EXPECT_THAT(faults[0].text, testing::HasSubstr("family demo"));
}

}  // namespace
}  // namespace axisgate
