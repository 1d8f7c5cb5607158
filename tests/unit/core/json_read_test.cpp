// Foreign JSON gives the same values as the library's own reader, but no object with two members of one name is accepted at any level.
#include "gateway/core/json_read.hpp"

#include <gtest/gtest.h>
#include <boost/json/parse.hpp>

#include <chrono>
#include <string>

namespace axisgate {
namespace {
namespace json = boost::json;

JsonFault fault_of(std::string_view text) {
    JsonFault fault;
    EXPECT_FALSE(read_json(text, fault)) << text.substr(0, 200);
    return fault;
}
std::string twice_at(std::string_view text) {
    const auto fault = fault_of(text);
    EXPECT_TRUE(fault.twice) << fault.text;
    return fault.pointer;
}

TEST(JsonRead, GivesWhatTheLibraryGives) {
    for (const std::string_view text : {R"({"a": 1, "b": [true, null, -2, 2.5, 18446744073709551615, "x\u00e9\n"], "": {"a": {}}})",
                                        " [ ] ", "3", "\"\"", "{\"a\":[{\"a\":1},{\"a\":2}]}\n",
                                        R"({"long\u0020name that has \"quotes\" and \\": "value\twith\u0000zero"})", "1e400", "-0.0"}) {
        JsonFault fault;
        const auto value = read_json(text, fault);
        boost::system::error_code ec;
        const auto wanted = json::parse(json::string_view(text.data(), text.size()), ec);
        ASSERT_EQ(value.has_value(), !ec) << text;
        if (!value) continue;
        EXPECT_EQ(*value, wanted) << text;
    }
}

TEST(JsonRead, NothingTimesAnyPowerOfTenIsNothing) {
    for (const std::string_view text : {"0e999", "-0e400", "0.0e15554", R"([{"position": 0E+999}])"}) {
        JsonFault fault;
        auto value = read_json(text, fault);
        ASSERT_TRUE(value) << text << ": " << fault.text;
        if (value->is_array()) value = value->get_array().at(0).at("position");
        EXPECT_EQ(value->as_double(), 0) << text;
    }
}

TEST(JsonRead, WhatIsNoJsonIsSaidInTheParsersWords) {
    for (const std::string_view text : {"", " ", "{", "{\"a\":}", "[1,]", "{} {}", "nul", "{'a':1}", "\"\xFF\"", "{\"a\":1}x", "// x\n1"}) {
        const auto fault = fault_of(text);
        EXPECT_FALSE(fault.twice) << text;
        EXPECT_FALSE(fault.text.empty()) << text;
        EXPECT_EQ(fault.pointer, "") << text;
    }
    EXPECT_EQ(fault_of("{\n\"a\": 1,\n b}").line, 3u);
}

TEST(JsonRead, NoMemberStandsTwice) {
    const auto fault = fault_of("{\"command\": \"halt\",\n \"command\": \"enable\"}");
    EXPECT_TRUE(fault.twice);
    EXPECT_EQ(fault.text, "the member \"command\" stands twice");
    EXPECT_EQ(fault.pointer, "/command");
    EXPECT_EQ(fault.line, 2u);
    EXPECT_EQ(twice_at(R"({"a": {"b": {"c": 1, "d": 2, "c": 1}}})"), "/a/b/c") << "nested, and equal values are no excuse";
    EXPECT_EQ(twice_at(R"({"a": 1, "b": 2, "\u0061": 3})"), "/a") << "escaped otherwise, but the same name";
    EXPECT_EQ(twice_at(R"({"é": 1, "\u00e9": 3})"), "/é");
    EXPECT_EQ(twice_at(R"({"steps": [{"x": 1}, 2, [3], {"x": 1, "y": 2, "x": 3}]})"), "/steps/3/x") << "objects in arrays, counted";
    EXPECT_EQ(twice_at(R"([[[], {}], [{"x": {}, "x": {}}]])"), "/1/0/x");
    EXPECT_EQ(twice_at(R"({"": 1, "": 2})"), "/") << "the empty name is a name";
    EXPECT_EQ(twice_at(R"({"a/b~c": 1, "a/b~c": 2})"), "/a~1b~0c");
    JsonFault none;
    EXPECT_TRUE(read_json(R"({"a": {"a": {"a": 1}}, "b": [{"a": 1}, {"a": 1}], "A": 1})", none))
        << "the same name in other objects, or in capitals";
}

TEST(JsonRead, DepthIsBounded) {
    const auto nested = [](int depth) {
        std::string text;
        for (int i = 0; i < depth; ++i)
            text += "{\"a\":";
        text += "{\"b\":1,\"b\":2}";
        return text + std::string(static_cast<std::size_t>(depth), '}');
    };
    EXPECT_EQ(twice_at(nested(20)).size(), 42u);
    EXPECT_FALSE(fault_of(nested(40)).twice) << "too deep is noticed first";
    EXPECT_FALSE(fault_of(std::string(1'000'000, '[')).twice);
}

TEST(JsonRead, LargeTextsAreReadInTimeAndFaultsStaySmall) {
    std::string text = "{";
    for (int i = 0; i < 200'000; ++i)
        text += "\"name" + std::to_string(i) + "\":" + std::to_string(i) + ",";
    const auto begun = std::chrono::steady_clock::now();
    JsonFault fault;
    EXPECT_TRUE(read_json(text + "\"last\":0}", fault));
    EXPECT_EQ(twice_at(text + "\"name7\":0}"), "/name7");
    EXPECT_LT(std::chrono::steady_clock::now() - begun, std::chrono::seconds(10)) << "not a square of the number of members";
    const std::string name(500'000, 'n');
    const auto long_name = fault_of("{\"in\":{\"" + name + "\":1,\"" + name + "\":2}}");
    EXPECT_TRUE(long_name.twice);
    EXPECT_LT(long_name.text.size(), 200u);
    EXPECT_EQ(long_name.pointer, "/in") << "the nearest place that can be shown";
}

}  // namespace
}  // namespace axisgate
