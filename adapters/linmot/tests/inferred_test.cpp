// Inferred messages and commands: each must be marked in the catalogue and in the code, and must not be sent if the option is off. All of
// the catalogue are enumerated.
#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "adapters/linmot/tests/line_bench.hpp"
#include "adapters/linmot/wire_inferred.hpp"
#include "gateway/core/command_arguments.hpp"

namespace axisgate::linmot::test {
namespace {

/// With the option off, everything that the catalogue marks as inferred is refused with the reason, and no byte of it is sent.
TEST(LinmotAdapter, WhatIsInferredCanBeSwitchedOffOneByOne) {
    LineBench b(1, 115200, {{"inferred", "off"}});
    b.run(1s);
    ASSERT_TRUE(b.enable());
    const auto marked = [](const boost::json::value& v) {
        const auto* mark = v.get_object().if_contains("inferred");
        return mark && mark->is_bool() && mark->get_bool();
    };
    const auto refused = [&](const std::string& what, CommandBody body) {
        SCOPED_TRACE(what);
        b.sent.clear();
        const Result r = b.ask(std::move(body));
        EXPECT_EQ(r.reason, Reason::not_supported) << r.text;
        EXPECT_NE(r.text.find("inferred"), std::string::npos) << r.text;
        for (const Frame& f : b.sent) {
            const auto bytes = f.data();
            EXPECT_TRUE(bytes.size() > 5 && bytes[5] == 0 && !inferred(bytes[5], bytes[4]))
                << "something else than a question for its state was sent: group " << int{bytes[5]};
        }
    };
    std::size_t commands = 0, parameters = 0;
    const auto& document = page().document();
    for (const auto& v : document.at("commands").get_array()) {
        if (!marked(v)) continue;
        ++commands;
        const std::string id(v.at("id").get_string());
        std::string arguments;
        for (const auto& x : page().command(id)->arguments)
            arguments += fmt::format("{}={} ", x.name, x.type == ValueType::text ? "x" : "1");
        refused(id, Action{id, arguments});
    }
    for (const auto& v : document.at("parameters").get_array()) {
        if (!marked(v)) continue;
        ++parameters;
        const std::string id(v.at("id").get_string());
        const Parameter* p = nullptr;
        std::uint16_t i = 0;
        for (; !p; ++i)
            if (page().parameters()[i].id == id) p = &page().parameters()[i];
        const Point point{static_cast<std::uint16_t>(i - 1), p->count ? p->first : std::uint16_t{0}};
        refused("read " + id, ReadParameter{point});
        if (p->writable()) refused("write " + id, WriteParameter{point, Value{std::string("VAI Stop: deceleration=1")}});
    }
    EXPECT_EQ(commands, 14u) << "8 motion commands, 2 of the table, 4 of curves";
    EXPECT_EQ(parameters, 3u) << "warn word, table, curve";
}

/// The marks of the catalogue must agree with the list of messages in the code: each action that is not a motion command sends an inferred
/// message if and only if it is marked. With the option off no such message is ever sent.
TEST(LinmotAdapter, MarksOfTheCatalogueAreThoseOfTheMessages) {
    const std::map<std::string, boost::json::object> given{
        {"table.write", {{"entry", 1}, {"command", "VAI Stop"}, {"arguments", "deceleration=1"}, {"next", 0}, {"label", "stop"}}},
        {"curve.write", {{"curve", 1}, {"content", "x=time; length=0.5; points=0 1 4 10"}}},
        {"parameter.info", {{"upid", 0x13A2}}}};
    std::size_t actions = 0, sent_inferred = 0;
    for (const auto& v : page().document().at("commands").get_array()) {
        const auto& o = v.get_object();
        if (o.at("kind").as_string() != "action") continue;
        const std::string id(o.at("id").get_string());
        SCOPED_TRACE(id);
        ++actions;
        boost::json::object arguments;
        if (const auto it = given.find(id); it != given.end())
            arguments = it->second;
        else
            for (const auto& a : page().command(id)->arguments)
                arguments[a.name] = 1;
        for (const bool allowed : {true, false}) {
            LineBench b(1, 115200, {{"inferred", allowed ? "on" : "off"}});
            b.run(1s);
            b.sent.clear();
            const Result r = b.act(id, arguments);
            EXPECT_NE(r.reason, Reason::out_of_range) << r.text;
            const auto n =
                static_cast<std::size_t>(std::ranges::count_if(b.sent, [](const Frame& f) { return inferred(f.data()[5], f.data()[4]); }));
            if (!allowed)
                EXPECT_EQ(n, 0u);
            else
                EXPECT_EQ(n > 0, o.at("inferred").as_bool() || id == "parameter.info") << r.text;
            sent_inferred += n > 0;
            if (!allowed && id == "parameter.info") EXPECT_NE(r.text.find("default not asked"), std::string::npos) << r.text;
        }
    }
    EXPECT_EQ(sent_inferred, 7u) << "6 that are marked, and the default of parameter.info";
    EXPECT_GT(actions, 12u);
}

}  // namespace
}  // namespace axisgate::linmot::test
