// Merge patches, and which mappings name an axis.
#include "gateway/services/site/site_edit.hpp"

#include <gtest/gtest.h>
#include <boost/json/parse.hpp>

namespace axisgate {
namespace {
namespace json = boost::json;

TEST(MergePatch, ExamplesOfRfc7396) {
    struct Row {
        const char *original, *patch, *result;
    };
    for (const auto& [original, patch, result] :
         {Row{R"({"a":"b"})", R"({"a":"c"})", R"({"a":"c"})"}, Row{R"({"a":"b"})", R"({"b":"c"})", R"({"a":"b","b":"c"})"},
          Row{R"({"a":"b"})", R"({"a":null})", R"({})"}, Row{R"({"a":"b","b":"c"})", R"({"a":null})", R"({"b":"c"})"},
          Row{R"({"a":["b"]})", R"({"a":"c"})", R"({"a":"c"})"}, Row{R"({"a":"c"})", R"({"a":["b"]})", R"({"a":["b"]})"},
          Row{R"({"a":{"b":"c"}})", R"({"a":{"b":"d","c":null}})", R"({"a":{"b":"d"}})"},
          Row{R"({"a":[{"b":"c"}]})", R"({"a":[1]})", R"({"a":[1]})"}, Row{R"(["a","b"])", R"(["c","d"])", R"(["c","d"])"},
          Row{R"({"a":"b"})", R"(["c"])", R"(["c"])"}, Row{R"({"a":"foo"})", "null", "null"},
          Row{R"({"e":null})", R"({"a":1})", R"({"e":null,"a":1})"}, Row{R"([1,2])", R"({"a":"b","c":null})", R"({"a":"b"})"},
          Row{"{}", R"({"a":{"bb":{"ccc":null}}})", R"({"a":{"bb":{}}})"}}) {
        auto v = json::parse(original);
        merge_patch(v, json::parse(patch));
        EXPECT_EQ(v, json::parse(result)) << original << " with " << patch;
    }
}

TEST(SiteEdit, MappingsThatNameAnAxis) {
    EXPECT_TRUE(mapping_names(json::parse(R"({"axis":"a"})"), "a"));
    EXPECT_TRUE(mapping_names(json::parse(R"({"point":"a.position"})"), "a"));
    EXPECT_TRUE(mapping_names(json::parse(R"({"point":"a/position"})"), "a"));
    EXPECT_FALSE(mapping_names(json::parse(R"({"point":"ab.position"})"), "a"));
    EXPECT_FALSE(mapping_names(json::parse(R"({"point":"a"})"), "a"));
    EXPECT_FALSE(mapping_names(json::parse(R"({"point":5})"), "a"));
    EXPECT_FALSE(mapping_names(json::parse(R"("a.position")"), "a"));
}

TEST(SiteEdit, ARefusalIsAValueOfNoProtocol) {
    const auto document =
        json::parse(R"({"lines":[{"name":"bus"}],"drives":[{"name":"d","line":"bus"}],"axes":[],"mappings":[]})").get_object();
    const auto absent = remove_entry(document, Collection::lines, "x", false);
    ASSERT_TRUE(std::holds_alternative<ServiceRefusal>(absent));
    EXPECT_EQ(std::get<ServiceRefusal>(absent).why, ServiceRefusal::Why::not_found);
    EXPECT_EQ(std::get<ServiceRefusal>(absent).text, "there is no line x");
    const auto used = remove_entry(document, Collection::lines, "bus", false);
    ASSERT_TRUE(std::holds_alternative<ServiceRefusal>(used));
    EXPECT_EQ(std::get<ServiceRefusal>(used).why, ServiceRefusal::Why::conflict);
    EXPECT_EQ(std::get<ServiceRefusal>(used).text, "line bus is still used by drives: d; remove them first, or add ?cascade=1");
    const auto gone = remove_entry(document, Collection::lines, "bus", true);
    ASSERT_TRUE(std::holds_alternative<Edit>(gone));
    EXPECT_TRUE(std::get<Edit>(gone).document.at("drives").get_array().empty());
}

}  // namespace
}  // namespace axisgate
