// Conversions, range checks with their messages, limits in an axis' own unit.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "gateway/axis/guard.hpp"
#include "gateway/axis/image.hpp"
#include "gateway/core/catalogue.hpp"

namespace axisgate {
namespace {

TEST(Value, ParsesByTypeAndNothingElse) {
    EXPECT_EQ(parse_value("12", ValueType::u8), Value{std::int64_t{12}});
    EXPECT_EQ(parse_value("-12", ValueType::i16), Value{std::int64_t{-12}});
    EXPECT_EQ(parse_value("0x1F", ValueType::u16), Value{std::int64_t{31}});
    EXPECT_EQ(parse_value("3.5", ValueType::f32), Value{3.5});
    EXPECT_EQ(parse_value("true", ValueType::boolean), Value{true});
    EXPECT_EQ(parse_value("abc", ValueType::text), Value{std::string("abc")});
    for (const auto* bad : {"", "12x", "1e400", "nan", "0x", "--1", " 1"}) {
        EXPECT_FALSE(parse_value(bad, ValueType::i32)) << bad;
        EXPECT_FALSE(parse_value(bad, ValueType::f64)) << bad;
    }
    EXPECT_FALSE(parse_value("2", ValueType::boolean));
}

TEST(Value, IntegersAreOnlyWhatIsWhole) {
    EXPECT_EQ(as_integer(Value{2.0}), 2);
    EXPECT_FALSE(as_integer(Value{2.5}));
    EXPECT_FALSE(as_integer(Value{1e19}));
    EXPECT_EQ(as_integer(Value{true}), 1);
    EXPECT_FALSE(as_integer(Value{std::string("2")}));
    EXPECT_FALSE(as_number(Value{}));
    EXPECT_EQ(to_text(Value{}), "unknown");
    for (int t = 0; t <= static_cast<int>(ValueType::bytes); ++t) {
        EXPECT_EQ(value_type_named(name_of(static_cast<ValueType>(t))), static_cast<ValueType>(t));
    }
}

constexpr const char* values_page = R"({"family": "test", "number": 9, "parameters": [
  {"id": "AC", "name": "acceleration", "group": "motion", "type": "u32", "unit": "pulse/s^2", "min": 1, "max": 65000000, "default": null, "access": "RW", "storage": "eeprom", "description": "d"},
  {"id": "MT[0]", "name": "microsteps", "group": "motor", "type": "u16", "unit": null, "min": null, "max": null, "default": 16, "access": "RW", "storage": "eeprom",
   "allowed": {"1": "full", "2": "half"}, "description": "d"},
  {"id": "T", "name": "temperature", "group": "state", "type": "f32", "unit": "degC", "min": -40, "max": 125.5, "default": null, "access": "R", "storage": "status", "description": "d"},
  {"id": "N", "name": "register", "group": "elements", "type": "i32", "unit": null, "min": null, "max": null, "default": null, "access": "RW", "storage": "ram", "first": 1, "count": 3, "description": "d"}],
  "commands": [], "errors": [{"code": 50, "kind": "error", "name": "syntax", "text": "t"}, {"code": 50, "kind": "alarm", "name": "other", "text": "t"}]})";

Catalogue read(std::string_view text) {
    std::vector<std::string> faults;
    auto c = Catalogue::parse(text, faults);
    for (const auto& f : faults)
        ADD_FAILURE() << f;
    return std::move(*c);
}

TEST(Catalogue, FindsByIdNameAndElement) {
    const auto c = read(values_page);
    EXPECT_EQ(c.find("AC"), (Point{0, 0}));
    EXPECT_EQ(c.find("acceleration"), (Point{0, 0}));
    EXPECT_EQ(c.find("MT[0]"), (Point{1, 0}));
    EXPECT_EQ(c.find("N[3]"), (Point{3, 3}));
    EXPECT_EQ(c.id_of({3, 2}), "N[2]");
    for (const auto* bad : {"N", "N[0]", "N[4]", "N[x]", "N[1", "XX", "", "AC[1]"})
        EXPECT_FALSE(c.find(bad)) << bad;
    EXPECT_EQ(c.parameter({0, 1}), nullptr);
    EXPECT_EQ(c.error(50, "alarm")->name, "other");
    EXPECT_EQ(c.error(51), nullptr);
}

TEST(Catalogue, ModesOfOperationAreThePagesOrTheCommonThree) {
    EXPECT_TRUE(std::ranges::equal(read(values_page).modes(), std::vector<std::int16_t>{1, 3, 6}));
    const auto with = [](std::string_view modes) {
        std::string text(values_page);
        text.insert(text.find('{') + 1, "\"modes\": " + std::string(modes) + ",");
        return text;
    };
    const auto c = read(with("[6, 8, -1]"));
    EXPECT_TRUE(std::ranges::equal(c.modes(), std::vector<std::int16_t>{6, 8, -1}));
    EXPECT_TRUE(c.offers_mode(8));
    EXPECT_FALSE(c.offers_mode(1));
    for (const auto* bad : {"[]", "5", "[0]", "[1, 1]", "[128]", "[\"1\"]", "[1.5]", "null"}) {
        std::vector<std::string> faults;
        EXPECT_FALSE(Catalogue::parse(with(bad), faults)) << bad;
        ASSERT_FALSE(faults.empty()) << bad;
        EXPECT_NE(faults.front().find("modes"), std::string::npos) << faults.front();
    }
}

TEST(Catalogue, ASelectorIsThePositionAndTheElementAndNothingForTexts) {
    const auto c = read(R"({"family": "x", "number": 1, "commands": [], "errors": [], "parameters": [
      {"id": "T", "name": "t", "group": "g", "type": "text", "access": "R", "description": "d"},
      {"id": "A", "name": "a", "group": "g", "type": "u8", "access": "R", "description": "d"},
      {"id": "N", "name": "n", "group": "g", "type": "i32", "access": "R", "description": "d", "first": 1, "count": 3}]})");
    EXPECT_EQ(c.selector({0, 0}), std::nullopt);
    EXPECT_EQ(c.selector({1, 0}), 1u);
    EXPECT_EQ(c.selector({2, 1}), 0x10002u);
    EXPECT_EQ(c.selector({2, 3}), 0x30002u);
    EXPECT_EQ(c.selector({2, 0}), std::nullopt);
    EXPECT_EQ(c.selector({3, 0}), std::nullopt);
}

TEST(Catalogue, WhatIsAskedBeforeACommandIsSentences) {
    const auto with = [](std::string_view confirm) {
        return fmt::format(R"({{"family": "x", "number": 1, "parameters": [], "errors": [], "commands": [{{"id": "FD", "name": "f"{}}}]}})",
                           confirm);
    };
    for (const auto* good : {"", R"(, "confirm": "All settings are lost.")"}) {
        std::vector<std::string> faults;
        EXPECT_TRUE(Catalogue::parse(with(good), faults)) << good;
    }
    for (const auto* bad : {R"(, "confirm": "")", R"(, "confirm": "Sure?")", R"(, "confirm": true)", R"(, "confirm": null)"}) {
        std::vector<std::string> faults;
        EXPECT_FALSE(Catalogue::parse(with(bad), faults)) << bad;
        ASSERT_EQ(faults.size(), 1u) << bad;
        EXPECT_NE(faults[0].find("FD: confirm"), std::string::npos) << faults[0];
    }
}

TEST(Catalogue, AClassSpeaksForTheCodesThatNothingElseNames) {
    const auto c = read(R"({"family": "x", "number": 1, "commands": [], "parameters": [], "errors": [
      {"code": 7, "kind": "system", "name": "seven", "text": "s"}, {"code": 1, "through": 99, "kind": "system", "name": "class", "text": "c"},
      {"code": 100, "kind": "system", "through": null, "name": "hundred", "text": "h"}, {"code": 64, "kind": "command", "name": "answer", "text": "a"}]})");
    EXPECT_EQ(c.error(7)->name, "seven");
    EXPECT_EQ(c.error(1)->name, "class");
    EXPECT_EQ(c.error(64)->name, "class") << "what stands first";
    EXPECT_EQ(c.error(64, "command")->name, "answer");
    EXPECT_EQ(c.error(99)->name, "class");
    EXPECT_EQ(c.error(100)->name, "hundred");
    for (const int none : {0, 101})
        EXPECT_EQ(c.error(none), nullptr) << none;
    for (const auto* wrong : {"\"9\"", "5", "4", "5.5"}) {
        std::vector<std::string> faults;
        const std::string written =
            std::string(
                R"({"family": "x", "number": 1, "commands": [], "parameters": [], "errors": [{"code": 5, "text": "t", "through": )") +
            wrong + "}]}";
        EXPECT_FALSE(Catalogue::parse(written, faults)) << wrong;
        ASSERT_EQ(faults.size(), 1u);
        EXPECT_NE(faults[0].find("errors[0].through"), std::string::npos) << faults[0];
    }
}

TEST(Catalogue, WritesAreCheckedAndRefusalsNameTheRange) {
    const auto c = read(values_page);
    EXPECT_EQ(c.check_write({0, 0}, Value{std::int64_t{65000000}}).fault, "");
    for (const auto& [point, value, part] :
         std::vector<std::tuple<Point, Value, std::string>>{{{0, 0}, Value{std::int64_t{0}}, "1..65000000 pulse/s^2"},
                                                            {{0, 0}, Value{std::int64_t{65000001}}, "1..65000000"},
                                                            {{0, 0}, Value{1.5}, "whole number"},
                                                            {{0, 0}, Value{std::string("x")}, "whole number"},
                                                            {{1, 0}, Value{std::int64_t{3}}, "1 (full), 2 (half)"},
                                                            {{2, 0}, Value{20.0}, "only be read"},
                                                            {{3, 1}, Value{std::int64_t{1} << 31}, "-2147483648..2147483647"},
                                                            {{3, 4}, Value{std::int64_t{1}}, "does not know"}}) {
        const auto r = c.check_write(point, value);
        EXPECT_NE(r.fault.find(part), std::string::npos) << r.fault << " should name " << part;
    }
}

TEST(Catalogue, AFractionHasTheRangeOfItsTypeWhereThePageNamesNone) {
    const auto c = read(R"({"family": "x", "number": 1, "commands": [], "errors": [], "parameters": [
      {"id": "S", "name": "s", "group": "g", "type": "f32", "access": "RW", "description": "d"},
      {"id": "D", "name": "d", "group": "g", "type": "f64", "access": "RW", "description": "d"}]})");
    for (const double fits : {0.0, -3.4028234e38, 3.4028234e38})
        EXPECT_EQ(c.check_write({0, 0}, Value{fits}).fault, "") << fits;
    for (const double too_much : {1e300, -1e300, 3.5e38}) {
        EXPECT_NE(c.check_write({0, 0}, Value{too_much}).fault.find("single precision"), std::string::npos) << too_much;
        EXPECT_EQ(c.check_write({1, 0}, Value{too_much}).fault, "") << too_much;
    }
    for (const std::uint16_t i : {std::uint16_t{0}, std::uint16_t{1}}) {
        for (const double none : {std::nan(""), HUGE_VAL})
            EXPECT_NE(c.check_write({i, 0}, Value{none}).fault.find("takes a number"), std::string::npos) << none;
    }
}

TEST(Catalogue, FormsThatCannotBeReadAreFaultsWithTheirPlace) {
    const auto faults_of = [](const std::string& members) {
        std::vector<std::string> faults;
        (void)Catalogue::parse(
            R"({"family": "f", "number": 1, "commands": [], "errors": [], "parameters": [{"id": "A", "name": "a", "group": "g",
            "description": "d", "type": "u16", "min": 0, "max": 100, "access": "RW", )" +
                members + "}]}",
            faults);
        return faults;
    };
    for (const auto& [members, says] :
         {std::pair<std::string, std::string>{R"("fields": [{"name": "x", "bits": "0..3"}])", "parameters[0].fields"},
          {R"("fields": [{"name": "x", "bits": "3..0"}, {"name": "y", "bits": "3"}])", "shares its bits"},
          {R"("fields": [{"name": "x", "bits": "3..0", "values": "none"}])", "names no list"},
          {R"("meanings": {"1..": "x"})", "parameters[0].meanings"},
          {R"("alternate": {"when": "B=1", "unit": "ms", "min": 0, "max": 9})", "parameters[0].alternate"},
          {R"("alternate": {"when": "A=1", "unit": "ms", "min": 0, "max": 101})", "within min..max"}}) {
        const auto faults = faults_of(members);
        ASSERT_EQ(faults.size(), 1u) << members;
        EXPECT_NE(faults[0].find(says), std::string::npos) << faults[0];
    }
    EXPECT_TRUE(
        faults_of(R"("alternate": {"when": "A=1", "unit": "ms", "min": 0, "max": 100}, "meanings": {"0": "x"}, "fields": null)").empty());
}

TEST(Catalogue, WhatADriveIsReachedByIsMarkedAndNothingElse) {
    const auto parse = [](std::string_view mark, std::vector<std::string>& faults) {
        return Catalogue::parse(
            fmt::format(
                R"({{"family": "x", "number": 1, "parameters": [{{"id": "A", "name": "a", "group": "g", "type": "u8", "access": "RW", "description": "d"{}}}],
          "commands": [], "errors": []}})",
                mark),
            faults);
    };
    std::vector<std::string> faults;
    EXPECT_FALSE(parse("", faults)->parameters()[0].addressing);
    EXPECT_FALSE(parse(R"(, "addressing": false)", faults)->parameters()[0].addressing);
    EXPECT_TRUE(parse(R"(, "addressing": true)", faults)->parameters()[0].addressing);
    EXPECT_TRUE(faults.empty());
    for (const auto* wrong : {R"(, "addressing": 1)", R"(, "addressing": "yes")", R"(, "addressing": null)"})
        EXPECT_FALSE(parse(wrong, faults)) << wrong;
    EXPECT_EQ(faults.size(), 3u);
    faults.clear();
    EXPECT_FALSE(parse("", faults)->parameters()[0].live);
    EXPECT_TRUE(parse(R"(, "live": true)", faults)->parameters()[0].live);
    EXPECT_FALSE(parse(R"(, "live": 1)", faults));
    EXPECT_EQ(faults.size(), 1u);
}
TEST(Catalogue, EveryFaultOfAPageIsFound) {
    std::vector<std::string> faults;
    EXPECT_FALSE(Catalogue::parse(
        R"({"family": "", "parameters": [{"id": "A", "name": "a", "group": "g", "type": "u9", "access": "X", "description": "d", "min": 2, "max": 1},
      {"id": "A", "name": "b", "group": "g", "type": "u8", "access": "R", "description": "d"}, 5], "commands": {}, "errors": [{"text": "t"}]})",
        faults));
    EXPECT_EQ(faults.size(), 9u);
    faults.clear();
    EXPECT_FALSE(Catalogue::parse("[", faults));
    EXPECT_EQ(faults.size(), 1u);
}

TEST(Guard, LimitsAreInIncrementsAndMessagesInTheAxisOwnUnit) {
    AxisSpec a;
    a.unit = "mm";
    a.increments_per_unit = 100;
    a.position_min = -10;
    a.position_max = 20;
    a.velocity_max = 5;
    a.acceleration_max = 50;
    const auto l = AxisLimits::of(a);
    Move m;
    m.target = 2000;
    EXPECT_FALSE(guard_move(m, l, 0));
    m.target = 2001;
    auto r = guard_move(m, l, 0);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->reason, Reason::out_of_range);
    EXPECT_NE(r->text.find("20.01 mm"), std::string::npos) << r->text;
    EXPECT_NE(r->text.find("20 mm"), std::string::npos) << r->text;
    m.kind = Move::Kind::relative;
    m.target = 100;
    EXPECT_FALSE(guard_move(m, l, 1900));
    EXPECT_TRUE(guard_move(m, l, 1901));
    m.target = std::numeric_limits<std::int64_t>::max();
    EXPECT_TRUE(guard_move(m, l, 1)) << "no overflow lets it pass";
    m = Move{};
    m.velocity = 501;
    EXPECT_TRUE(guard_move(m, l, 0));
    m.velocity = 0;
    EXPECT_TRUE(guard_move(m, l, 0));
    m.velocity = 500;
    m.deceleration = 5001;
    EXPECT_TRUE(guard_move(m, l, 0));
    Move jog;
    jog.kind = Move::Kind::velocity;
    jog.target = -501;
    EXPECT_TRUE(guard_move(jog, l, 0));
    jog.target = -500;
    EXPECT_FALSE(guard_move(jog, l, 0));
    Move far;
    far.target = std::int64_t{1} << 31;
    EXPECT_TRUE(guard_move(far, AxisLimits{}, 0)) << "a target must fit its register";
    ProcessData d;
    d.profile_velocity = 501;
    EXPECT_TRUE(guard_process_data(d, l));
    d.profile_velocity = 0;
    EXPECT_FALSE(guard_process_data(d, l)) << "0: as the drive has it";
}

TEST(Image, ReadersSeeWholePicturesAndIdsStay) {
    Image image;
    ASSERT_TRUE(image.grow(100));
    const AxisId id{70};
    image.picture(id).position = 42;
    const auto before = image.cell(id).revision();
    image.publish(id);
    EXPECT_EQ(image.cell(id).read().position, 42);
    EXPECT_GT(image.cell(id).revision(), before);
    const AxisCell* place = &image.cell(id);
    ASSERT_TRUE(image.grow(3000));
    EXPECT_EQ(place, &image.cell(id));
    EXPECT_FALSE(image.grow(Image::max_ids + 1));
    image.set_numbers({no_axis, id});
    EXPECT_EQ(image.by_number(1), id);
    EXPECT_EQ(image.by_number(0), no_axis);
    EXPECT_EQ(image.by_number(2), no_axis);
}

}  // namespace
}  // namespace axisgate
