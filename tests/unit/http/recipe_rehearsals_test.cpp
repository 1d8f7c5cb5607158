// Rehearsals of recipes over HTTP: order, progress, rows, end, and the orders that are refused. The player is the test.
#include <fmt/core.h>

#include <algorithm>

#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace json = boost::json;
namespace {
constexpr auto path = "/api/v1/recipes/warm-up/rehearsal";

class RecipeRehearsalsOverHttp : public HttpTest {
protected:
    RecipeRehearsalsOverHttp() { put("warm-up", R"({"steps":[{"enable":{"axis":"feeder"}},{"wait_s":1}]})"); }
    void put(const std::string& name, const std::string& document) {
        ASSERT_LE(call("PUT", "/api/v1/recipes/" + name, document).status, 201u) << name;
    }
    /// The answer, which comes later in the program and inside the call with this player.
    Answer order(const std::string& body, const std::string& at = path) {
        const auto now = call("POST", at, body);
        return promised ? answered() : now;
    }
    static void pass(RehearsedSpecimen& row) {
        row.passed = true;
        row.seconds = 1.25;
    }
    static void fail(RehearsedSpecimen& row) {
        row.step = "Step 1: enable feeder";
        row.pointer = "/steps/0";
        row.text = "the driver is off";
        row.event = "feeder: stalled";
    }
    std::vector<std::string> events() {
        std::vector<std::string> texts;
        for (const auto& e : gateway.noted)
            if (e.kind == "rehearsal") texts.push_back(e.text);
        return texts;
    }
};

TEST_F(RecipeRehearsalsOverHttp, PlayOneSpecimenAfterTheOtherAndShowEachRow) {
    EXPECT_EQ(call("GET", path).at("state"), "none");
    const auto begun = order(R"({"specimens":"1..2,slow"})");
    ASSERT_EQ(begun.status, 202u) << begun.text;
    EXPECT_EQ(begun.headers.get("Location"), path);
    EXPECT_EQ(begun.at("state"), "running");
    EXPECT_EQ(begun.at("total"), "3");
    ASSERT_EQ(gateway.specimens_wanted.size(), 1u) << "one at a time";
    EXPECT_EQ(gateway.give_specimens(1, pass), 1u);
    EXPECT_EQ(call("GET", path).at("done"), "1");
    EXPECT_EQ(gateway.give_specimens(1, fail), 1u);
    EXPECT_EQ(gateway.give_specimens(9, pass), 1u);
    const auto report = call("GET", path);
    EXPECT_EQ(report.at("state"), "done");
    EXPECT_EQ(report.at("passed"), "2");
    EXPECT_EQ(report.at("failed"), "1");
    EXPECT_EQ(report.at("outdated"), "false");
    const auto& rows = report.object().at("specimens").get_array();
    ASSERT_EQ(rows.size(), 3u);
    EXPECT_EQ(json_text(rows[1]),
              R"({"specimen":"2","passed":false,"step":"Step 1: enable feeder","pointer":"/steps/0","text":"the driver is off",)"
              R"("event":"feeder: stalled","seconds":0})");
    EXPECT_EQ(rows[2].at("specimen"), "slow");
    const auto last = call("GET", std::string(path) + "?first=2");
    ASSERT_EQ(last.object().at("specimens").get_array().size(), 1u);
    EXPECT_EQ(last.object().at("specimens").at(0).at("specimen"), "slow");
    EXPECT_EQ(call("GET", std::string(path) + "?first=3").object().at("specimens").get_array().size(), 0u);
    EXPECT_EQ(call("GET", std::string(path) + "?first=x").status, 400u);
    EXPECT_EQ(events(), (std::vector<std::string>{"recipe warm-up is rehearsed against 3 specimens",
                                                  "recipe warm-up was rehearsed: 2 of 3 specimens passed"}));
    EXPECT_TRUE(gateway.submitted.empty()) << "no command has reached an axis of the gateway";
}

TEST_F(RecipeRehearsalsOverHttp, AHundredSpecimensWhereNothingIsNamed) {
    EXPECT_EQ(order("{}").at("total"), "100");
    EXPECT_EQ(gateway.give_specimens(1000, pass), 100u);
    EXPECT_EQ(call("GET", path).at("passed"), "100");
}

TEST_F(RecipeRehearsalsOverHttp, TheOrderReachesThePlayerWithSiteFamiliesAndArguments) {
    put("way", R"({"parameters":{"pause":{"type":"number","default":1}},"steps":[{"enable":{"axis":"feeder"}},{"wait_s":"${pause}"}]})");
    const auto begun = order(R"({"specimens":"7","families":{"uim342":"slow"},"arguments":{"pause":2}})", "/api/v1/recipes/way/rehearsal");
    ASSERT_EQ(begun.status, 202u) << begun.text;
    ASSERT_EQ(gateway.recipes_wanted.size(), 1u);
    const auto& wish = gateway.recipes_wanted[0];
    EXPECT_EQ(wish.fixed.at("uim342"), "slow");
    EXPECT_EQ(wish.arguments.at("pause"), 2);
    EXPECT_EQ(wish.site.axes.size(), gateway.site()->site.axes.size());
    EXPECT_EQ(begun.object().at("families").at("uim342"), "slow");
    EXPECT_EQ(begun.object().at("arguments").at("pause"), 2);
}

TEST_F(RecipeRehearsalsOverHttp, AnOrderThatCannotBePlayedIsRefusedWithItsReason) {
    const auto refused = [&](const std::string& body, const std::string& recipe, unsigned status, std::string_view words) {
        const auto a = order(body, "/api/v1/recipes/" + recipe + "/rehearsal");
        EXPECT_EQ(a.status, status) << a.text;
        EXPECT_NE(a.text.find(words), std::string::npos) << a.text;
    };
    refused(R"({"specimens":"fast"})", "warm-up", 422, "/specimens");
    refused(R"({"specimens":"1..1001"})", "warm-up", 422, "at most 1000");
    refused(R"({"specimens":7})", "warm-up", 422, "specimens has the wrong type");
    refused(R"({"speed":7})", "warm-up", 422, "speed is not known here");
    gateway.recipe_faults = {{"/fixed", "there is no family nobody", "families: uim342", false}};
    refused(R"({"families":{"nobody":"1"}})", "warm-up", 422, R"("pointer":"/families")");
    refused(R"({"families":{"uim342":1}})", "warm-up", 422, "/families/uim342");
    gateway.recipe_faults = {{"/steps/0/enable/axis", "there is no axis nobody", "axes: feeder", false}};
    refused("{}", "warm-up", 422, "there is no axis nobody");
    refused("{}", "unknown", 404, "there is no recipe unknown");
    EXPECT_EQ(call("GET", path).at("state"), "none");
    EXPECT_EQ(call("DELETE", path).status, 409u) << "none is under way";
    EXPECT_EQ(order(R"({"specimens":"1"})").status, 202u) << "a refused order leaves the place free";
}

TEST_F(RecipeRehearsalsOverHttp, ASiteWithoutAxesIsRefused) {
    Site site = gateway.site()->site;
    site.axes.clear();
    gateway.put_site(site);
    const auto a = order("{}");
    EXPECT_EQ(a.status, 409u);
    EXPECT_NE(a.at("detail").find("the site has no axis"), std::string::npos) << a.text;
}

TEST_F(RecipeRehearsalsOverHttp, OneAtATime) {
    put("other", R"({"steps":[{"enable":{"axis":"slide"}}]})");
    gateway.prepare_at_once = false;
    (void)call("POST", path, "{}");
    const auto second = order("{}", "/api/v1/recipes/other/rehearsal");
    EXPECT_EQ(second.status, 409u) << "while the first one is checked";
    EXPECT_NE(second.at("detail").find("recipe warm-up is under way"), std::string::npos) << second.text;
    gateway.prepare_at_once = true;
    gateway.give_prepared();
    EXPECT_EQ(order("{}", "/api/v1/recipes/other/rehearsal").status, 409u) << "while it is played";
    gateway.give_specimens(1000, pass);
    EXPECT_EQ(order("{}", "/api/v1/recipes/other/rehearsal").status, 202u);
    EXPECT_EQ(call("GET", path).at("state"), "done") << "the report of the other recipe stays";
}

TEST_F(RecipeRehearsalsOverHttp, AnEndedOneKeepsItsRowsAndGivesUpTheSpecimenInProgress) {
    ASSERT_EQ(order(R"({"specimens":"1..50"})").status, 202u);
    EXPECT_EQ(gateway.give_specimens(4, pass), 4u);
    const auto wanted = gateway.specimens_wanted.front().ended;
    EXPECT_FALSE(*wanted);
    const auto ending = call("DELETE", path);
    EXPECT_EQ(ending.status, 202u);
    EXPECT_EQ(ending.at("state"), "cancelling");
    EXPECT_TRUE(*wanted) << "the player is told";
    EXPECT_EQ(call("DELETE", path).status, 202u);
    EXPECT_EQ(gateway.give_specimens(9, fail), 1u) << "no further specimen";
    const auto report = call("GET", path);
    EXPECT_EQ(report.at("state"), "cancelled");
    EXPECT_EQ(report.at("done"), "4") << "a specimen that was given up has no row";
    EXPECT_EQ(report.at("failed"), "0");
    EXPECT_EQ(events().back(), "the rehearsal of recipe warm-up was ended after 4 of 50 specimens");
    EXPECT_EQ(std::ranges::count(events(), events().back()), 1);
    EXPECT_EQ(order(R"({"specimens":"1"})").status, 202u);
}

TEST_F(RecipeRehearsalsOverHttp, AReportSaysWhenRecipeOrSiteHasChangedSince) {
    ASSERT_EQ(order(R"({"specimens":"1"})").status, 202u);
    gateway.give_specimens(1, pass);
    EXPECT_EQ(call("GET", path).at("outdated"), "false");
    put("warm-up", R"({"steps":[{"enable":{"axis":"feeder"}},{"wait_s":2}]})");
    EXPECT_EQ(call("GET", path).at("outdated"), "true");
    ASSERT_EQ(order(R"({"specimens":"1"})").status, 202u);
    gateway.give_specimens(1, pass);
    EXPECT_EQ(call("GET", path).at("outdated"), "false");
    gateway.put_site(gateway.site()->site);
    EXPECT_EQ(call("GET", path).at("outdated"), "true");
}

TEST_F(RecipeRehearsalsOverHttp, TheReportsAreLimited) {
    for (std::size_t i = 0; i <= RecipeRehearsals::kept_reports; ++i) {
        const std::string name = fmt::format("r{}", i);
        put(name, R"({"steps":[{"enable":{"axis":"feeder"}}]})");
        ASSERT_EQ(order(R"({"specimens":"1"})", "/api/v1/recipes/" + name + "/rehearsal").status, 202u);
        gateway.give_specimens(1, pass);
    }
    EXPECT_EQ(call("GET", "/api/v1/recipes/r0/rehearsal").at("state"), "none");
    EXPECT_EQ(call("GET", "/api/v1/recipes/r1/rehearsal").at("state"), "done");
}

TEST_F(RecipeRehearsalsOverHttp, TheEndOfTheGatewayGivesUpTheSpecimenInProgress) {
    auto own = std::make_shared<RecipeRehearsals>(gateway);
    std::vector<Fault> faults;
    own->start({"warm-up", {}, "tag"}, read_rehearsal_order({{"specimens", "1..3"}}, faults), Origin{}, [](const auto&) {});
    ASSERT_EQ(gateway.specimens_wanted.size(), 1u);
    const auto wanted = gateway.specimens_wanted.front().ended;
    EXPECT_FALSE(*wanted);
    own.reset();
    EXPECT_TRUE(*wanted);
    EXPECT_EQ(gateway.give_specimens(9, pass), 1u) << "a late row reaches nobody";
}

}  // namespace
}  // namespace axisgate::http::test
