// Names, types, scales, ranges and defaults of command arguments; the same result by object and by text.
#include <gtest/gtest.h>
#include <boost/json/parse.hpp>

#include "gateway/core/command_arguments.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

constexpr const char* page = R"({"family": "test", "number": 9, "parameters": [], "errors": [], "commands": [
  {"id": "010", "name": "go", "arguments": [
    {"name": "position", "type": "i32", "unit": "mm", "scale": 0.0001, "description": "where to"},
    {"name": "velocity", "type": "u32", "unit": "m/s", "scale": 1e-6, "min": 0.001, "max": 5, "default": 0.1},
    {"name": "count", "type": "u8", "default": 3},
    {"name": "gain", "type": "f64", "scale": 0.5, "min": 0, "default": 1},
    {"name": "soft", "type": "bool", "default": false},
    {"name": "label", "type": "text", "default": "7"}]},
  {"id": "000", "name": "nothing"}]})";

struct CommandArguments : testing::Test {
    std::vector<std::string> faults;
    std::optional<Catalogue> catalogue = Catalogue::parse(page, faults);
    const CatalogueCommand& go = *catalogue->command("go");
    [[nodiscard]] CheckedArguments object(std::string_view text) const { return check_arguments(go, json::parse(text).as_object()); }
    [[nodiscard]] static std::string first(const CheckedArguments& c) { return c.faults.empty() ? "" : c.faults[0].text; }
};

TEST_F(CommandArguments, AreScaledIntoCountsInTheCataloguesOrder) {
    ASSERT_TRUE(faults.empty()) << faults[0];
    const auto c = object(R"({"velocity": 0.25, "position": 12.5, "soft": true, "label": "12", "gain": 2})");
    EXPECT_EQ(first(c), "");
    EXPECT_EQ(c.values, (std::vector<Value>{std::int64_t{125000}, std::int64_t{250000}, std::int64_t{3}, 4.0, true, std::string("12")}));
    EXPECT_EQ(check_arguments(go, "velocity=0.25, position=12.5 soft=true label=12\ngain=2").values, c.values) << "text says the same";
    EXPECT_EQ(object(R"({"position": -0.00004})").values[0], Value{std::int64_t{0}}) << "to the nearest count";
    EXPECT_EQ(object(R"({"position": 1})").values,
              (std::vector<Value>{std::int64_t{10000}, std::int64_t{100000}, std::int64_t{3}, 2.0, false, std::string("7")}));
}

TEST_F(CommandArguments, EachFaultIsToldByName) {
    const auto c = object(R"({"velocity": 6, "count": 256, "speed": 1, "gain": -1, "soft": 2, "label": 5})");
    std::vector<std::string> names;
    for (const auto& f : c.faults)
        names.push_back(f.argument);
    EXPECT_EQ(names, (std::vector<std::string>{"speed", "position", "velocity", "count", "gain", "soft", "label"}));
    EXPECT_EQ(c.faults[1].text, "position is missing");
    EXPECT_EQ(c.faults[1].remedy, "give a value in -214748.3648..214748.3647 mm");
    EXPECT_EQ(c.faults[2].text, "velocity: 6 is outside 0.001..5 m/s");
    EXPECT_EQ(c.faults[3].text, "count: 256 is outside 0..255");
}

TEST_F(CommandArguments, OnlyNumbersThatFitAreNumbers) {
    EXPECT_EQ(first(object(R"({"position": "12"})")), "position takes a number, not 12");
    EXPECT_EQ(first(object(R"({"position": true})")), "position takes a number, not true");
    EXPECT_EQ(first(object(R"({"position": null})")), "position takes one value");
    EXPECT_EQ(first(object(R"({"position": [1]})")), "position takes one value");
    EXPECT_EQ(first(object(R"({"position": 214748.3647})")), "");
    EXPECT_NE(first(object(R"({"position": 214748.3648})")), "");
    EXPECT_NE(first(object(R"({"position": 1e300})")), "");
    EXPECT_EQ(first(object(R"({"position": 1, "count": 1.5})")), "count takes a whole number, not 1.5");
}

TEST_F(CommandArguments, TextIsReadOrRefused) {
    EXPECT_EQ(check_arguments(go, "").faults.size(), 1u) << "position has no default";
    EXPECT_EQ(first(check_arguments(go, "position=1 12")), "12 is no argument");
    EXPECT_EQ(first(check_arguments(go, "position=1 position=2")), "position stands twice");
    EXPECT_EQ(first(check_arguments(go, "position=")), "position takes a number, not ");
    EXPECT_TRUE(check_arguments(*catalogue->command("nothing"), "").faults.empty());
    EXPECT_EQ(first(check_arguments(*catalogue->command("nothing"), "a=1")), "nothing has no argument a");
}

TEST_F(CommandArguments, AFaultyCatalogueIsRefused) {
    for (const char* bad :
         {R"({"name": "a"})", R"({"type": "i32"})", R"({"name": "a", "type": "i33"})", R"({"name": "a", "type": "i32", "scale": 0})",
          R"({"name": "a", "type": "i32", "min": 2, "max": 1})", R"({"name": "a", "type": "i32"}, {"name": "a", "type": "i32"})", "5"}) {
        std::vector<std::string> list;
        const std::string text =
            std::string(
                R"({"family": "t", "number": 9, "parameters": [], "errors": [], "commands": [{"id": "x", "name": "x", "arguments": [)") +
            bad + "]}]}";
        EXPECT_FALSE(Catalogue::parse(text, list)) << bad;
        EXPECT_FALSE(list.empty()) << bad;
    }
}

}  // namespace
}  // namespace axisgate
