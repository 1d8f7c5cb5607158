// The listed and the accepted conditions of a twin are the same rows; a fault of a value contains the condition's name.
#include <gtest/gtest.h>

#include <limits>

#include "gateway/core/hand_table.hpp"

namespace axisgate {
namespace {

struct Model {
    bool stalled = false, has_fan = false;
    std::int64_t inputs = 0;
    double temperature = 25;
};

const HandRow<Model> rows[] = {
    {"stall", true, "the shaft is held", [](const Model& m, Instant) -> Value { return m.stalled; },
     [](Model& m, const HandWish& w) { return w.flag([&](bool on) { m.stalled = on; }); }},
    {"inputs", true, "bit mask", [](const Model& m, Instant) -> Value { return m.inputs; },
     [](Model& m, const HandWish& w) { return w.whole(0, 7, "0..7", [&](std::int64_t n) { m.inputs = n; }); }},
    {"temperature", true, "deg C", [](const Model& m, Instant) -> Value { return m.temperature; },
     [](Model& m, const HandWish& w) {
         return w.number(-50, 200, "-50..200", [&](double x) -> std::string {
             if (m.stalled) return "temperature: not while the shaft is held";
             m.temperature = x;
             return {};
         });
     }},
    {"fan", true, "turns", [](const Model&, Instant) -> Value { return true; }, [](Model&, const HandWish&) { return std::string(); },
     [](const Model& m) { return m.has_fan; }},
    {"hours", false, "since power-on", [](const Model&, Instant now) -> Value { return std::int64_t{now.time_since_epoch().count()}; }},
};

std::optional<std::string> set(Model& m, const std::string& name, const Value& value) {
    return set_hand_row(rows, m, m, {name, value, Instant{}});
}

TEST(HandTable, ListsTheRowsThatAreFittedInTheirOrder) {
    Model m;
    std::string names;
    for (const HandItem& i : hand_items(rows, m, Instant{Duration(5)}))
        names += i.name + (i.writable ? " " : "! ");
    EXPECT_EQ(names, "stall inputs temperature hours! ");
    EXPECT_EQ(hand_items(rows, m, Instant{Duration(5)}).back().value, Value{std::int64_t{5}});
    m.has_fan = true;
    EXPECT_EQ(hand_items(rows, m, Instant{}).size(), std::size(rows));
}

TEST(HandTable, SetsOneConditionOrSaysWhatIsWrong) {
    Model m;
    EXPECT_EQ(set(m, "inputs", Value{std::int64_t{7}}), "");
    EXPECT_EQ(m.inputs, 7);
    EXPECT_EQ(set(m, "inputs", Value{std::int64_t{8}}), "inputs: 8 is not 0..7");
    EXPECT_EQ(set(m, "inputs", Value{std::int64_t{-1}}), "inputs: -1 is not 0..7");
    EXPECT_EQ(set(m, "inputs", Value{std::string("many")}), "inputs: many is not 0..7");
    EXPECT_EQ(m.inputs, 7);
    EXPECT_EQ(set(m, "temperature", Value{200.0}), "");
    EXPECT_EQ(set(m, "temperature", Value{std::numeric_limits<double>::quiet_NaN()}), "temperature: nan is not -50..200");
    EXPECT_EQ(set(m, "temperature", Value{-50.5}), "temperature: -50.5 is not -50..200");
    EXPECT_EQ(m.temperature, 200);
    EXPECT_EQ(set(m, "stall", Value{std::string("perhaps")}), "stall: perhaps is not true or false");
    EXPECT_EQ(set(m, "stall", Value{std::int64_t{1}}), "");
    EXPECT_TRUE(m.stalled);
    EXPECT_EQ(set(m, "temperature", Value{20.0}), "temperature: not while the shaft is held");
}

TEST(HandTable, ARowThatIsNotFittedOrIsNotWrittenTakesNothing) {
    Model m;
    EXPECT_EQ(set(m, "fan", Value{true}), std::nullopt);
    m.has_fan = true;
    EXPECT_EQ(set(m, "fan", Value{true}), "");
    EXPECT_EQ(set(m, "hours", Value{true}), std::nullopt);
    EXPECT_EQ(set(m, "wind", Value{true}), std::nullopt);
}

}  // namespace
}  // namespace axisgate
