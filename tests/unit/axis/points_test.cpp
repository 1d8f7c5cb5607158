// The content of the table of points, and that an additional row is found by everything that is derived from it.
#include "gateway/axis/points.hpp"

#include <gtest/gtest.h>

#include <set>

#include "gateway/doors/dds/words.hpp"
#include "tests/unit/axis/points_bench.hpp"

namespace axisgate::test {
namespace {
using Names = std::vector<std::string_view>;

template <class Rows>
Names document_members(const Rows& rows) {
    Names out;
    for (const auto& row : rows)
        if (row.document != PointInDocument::no) out.push_back(row.name);
    return out;
}
Names names_in(PointPlace AxisPointRow::*list, AxisPointRows rows) {
    Names out;
    for (const auto* row : in_order(list, rows))
        out.push_back((row->*list).name);
    return out;
}

TEST(Points, HaveOneNameEachAndAWayToBeRead) {
    std::set<std::string_view> names, members;
    std::set<AxisPoint> words;
    const std::set<std::string_view> by_no_picture{"line",  "family", "modes",  "set_points", "stop_latch_text",
                                                   "error", "at",     "age_ms", "heartbeat",  "mapping_revision"};
    for (const auto& row : axis_point_table) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " stands there twice";
        EXPECT_TRUE(!row.map || words.insert(*row.map).second) << row.name << ": its word of user maps has another row, too";
        EXPECT_TRUE(row.sample.empty() || members.insert(row.sample).second) << row.name;
        EXPECT_EQ(row.read == nullptr && row.flag == 0, by_no_picture.contains(row.name)) << row.name;
        EXPECT_TRUE(row.read == nullptr || row.flag == 0) << row.name << " is a flag and something else";
        EXPECT_TRUE(!row.trigger || row.flag != 0) << row.name << ": a capture's trigger is a flag";
    }
    for (const auto& info : axis_point_list)
        EXPECT_TRUE(words.contains(info.point)) << info.name;
}

TEST(Points, ListsHaveTheMembersAndTheOrderThatClientsKnow) {
    EXPECT_EQ(document_members(axis_point_table), (Names{"line",
                                                         "family",
                                                         "online",
                                                         "simulated",
                                                         "stale",
                                                         "presence",
                                                         "state",
                                                         "statusword",
                                                         "controlword",
                                                         "mode",
                                                         "mode_number",
                                                         "modes",
                                                         "set_points",
                                                         "moving",
                                                         "target_reached",
                                                         "referenced",
                                                         "fault",
                                                         "warning",
                                                         "internal_limit",
                                                         "fail_safe_cause",
                                                         "stop_latch",
                                                         "stop_latch_by",
                                                         "stop_latch_text",
                                                         "position",
                                                         "demand_known",
                                                         "demand_source",
                                                         "position_demand",
                                                         "following_error",
                                                         "velocity",
                                                         "target_position",
                                                         "target_velocity",
                                                         "position_increments",
                                                         "position_demand_increments",
                                                         "following_error_increments",
                                                         "velocity_increments",
                                                         "target_position_increments",
                                                         "error",
                                                         "native",
                                                         "authority",
                                                         "authority_holder",
                                                         "authority_until",
                                                         "setpoints_accepted",
                                                         "at",
                                                         "age_ms"}));
    EXPECT_EQ(recipe_points(), (Names{"online",
                                      "simulated",
                                      "stale",
                                      "presence",
                                      "state",
                                      "statusword",
                                      "controlword",
                                      "mode",
                                      "mode_number",
                                      "moving",
                                      "target_reached",
                                      "referenced",
                                      "fault",
                                      "warning",
                                      "internal_limit",
                                      "fail_safe_cause",
                                      "stop_latch",
                                      "position",
                                      "demand_known",
                                      "demand_source",
                                      "position_demand",
                                      "following_error",
                                      "velocity",
                                      "target_position",
                                      "target_velocity",
                                      "position_increments",
                                      "position_demand_increments",
                                      "following_error_increments",
                                      "velocity_increments",
                                      "target_position_increments",
                                      "native",
                                      "authority",
                                      "setpoints_accepted",
                                      "age_ms",
                                      "error_code",
                                      "number"}));
    EXPECT_EQ(names_in(&AxisPointRow::metric, axis_point_table), (Names{"position", "velocity", "following_error", "age_seconds", "state",
                                                                        "online", "simulated", "stale", "moving", "referenced", "fault"}));
    EXPECT_EQ(names_in(&AxisPointRow::channel, axis_point_table), (Names{"position", "velocity", "demand", "following_error", "state"}));
    Names always;
    for (const auto& row : axis_point_table)
        if (row.recipe == PointInRecipe::always) always.push_back(row.name);
    EXPECT_EQ(always, (Names{"online", "simulated", "stale", "presence", "number"}));
    for (const auto* other : {"name", "drive", "number", "unit", "position_min", "error_code", "flags", "heartbeat", ""})
        EXPECT_FALSE(is_document_member(other)) << other;
}

TEST(Points, HaveTheUnitsOfTheirRegisters) {
    const auto unit = [](std::string_view name, std::string_view of_axis) {
        return text_of(row_of(*axis_point_named(name))->unit, of_axis);
    };
    const auto all = [&unit](std::string_view expected, std::initializer_list<std::string_view> names) {
        for (const auto name : names)
            EXPECT_EQ(unit(name, "mm"), expected) << name;
    };
    all("increments", {"position", "position_demand", "following_error", "target_position"});
    all("increments/s", {"velocity", "profile_velocity", "target_velocity"});
    all("increments/s^2", {"profile_acceleration", "profile_deceleration"});
    all("ms", {"age_ms"});
    all("s", {"heartbeat"});
    all("mm", {"position_units"});
    all("mm/s", {"velocity_units"});
    EXPECT_EQ(unit("position_units", ""), "");
    EXPECT_EQ(unit("velocity_units", ""), "1/s");
    all("", {"statusword", "mode_display",    "error_code", "flags",          "native_status", "setpoints_accepted",
             "authority",  "controlword",     "mode",       "homing_method",  "online",        "simulated",
             "stale",      "referenced",      "moving",     "target_reached", "fault",         "warning",
             "family",     "mapping_revision"});
}

TEST(Points, AreReadAsNumbersByRegistersAndAsWordsByPeople) {
    AxisPicture p;
    const auto& position = *point_named("position");
    const auto& source = *point_named("demand_source");
    p.position = 500;
    EXPECT_EQ(measured(position, p, 200), PointValue(2.5));
    EXPECT_EQ(said(position, p, 200), PointValue()) << "no drive has said it";
    EXPECT_EQ(said(source, p, 1), PointValue());
    p.ever_seen = true;
    p.demand_source = DemandSource::computed;
    p.position_demand = 520;
    EXPECT_EQ(said(position, p, 200), PointValue(2.5));
    EXPECT_EQ(said(source, p, 1), PointValue(std::string_view("computed")));
    EXPECT_EQ(measured(source, p, 1), PointValue(std::int64_t{2}));
    EXPECT_EQ(said(*point_named("following_error_increments"), p, 200), PointValue(std::int64_t{20}));
    p.demand_source = DemandSource::open_loop;
    EXPECT_EQ(said(*point_named("following_error_increments"), p, 200), PointValue());
    EXPECT_EQ(measured(*point_named("following_error_increments"), p, 200), PointValue(std::int64_t{20}))
        << "a register has always a number";
    p.flags = flag_moving;
    EXPECT_EQ(said(*point_named("moving"), p, 1), PointValue(true));
    EXPECT_EQ(said(*point_named("fault"), p, 1), PointValue(false));
}

struct Change {
    const char* what;
    bool noticed;
    void (*make)(AxisPicture&);
};
const Change changes[] = {
    {"number", true, [](AxisPicture& p) { p.number = 9; }},
    {"family number", true, [](AxisPicture& p) { p.family_number = 9; }},
    {"position", true, [](AxisPicture& p) { p.position = 9; }},
    {"demand", true, [](AxisPicture& p) { p.position_demand = 9; }},
    {"velocity", true, [](AxisPicture& p) { p.velocity = 9; }},
    {"native status", true, [](AxisPicture& p) { p.native_status = 9; }},
    {"error code", true, [](AxisPicture& p) { p.error_code = 9; }},
    {"status word", true, [](AxisPicture& p) { p.statusword = 0x0200; }},
    {"mode display", true, [](AxisPicture& p) { p.mode_display = 9; }},
    {"flags", true, [](AxisPicture& p) { p.flags = 0x8000; }},
    {"cause", true, [](AxisPicture& p) { p.fail_safe_cause = 9; }},
    {"latch", true, [](AxisPicture& p) { p.stop_latch = 9; }},
    {"control word", true, [](AxisPicture& p) { p.controlword = 9; }},
    {"mode", true, [](AxisPicture& p) { p.mode = 9; }},
    {"target position", true, [](AxisPicture& p) { p.target_position = 9; }},
    {"profile velocity", true, [](AxisPicture& p) { p.profile_velocity = 9; }},
    {"profile acceleration", true, [](AxisPicture& p) { p.profile_acceleration = 9; }},
    {"profile deceleration", true, [](AxisPicture& p) { p.profile_deceleration = 9; }},
    {"target velocity", true, [](AxisPicture& p) { p.target_velocity = 9; }},
    {"homing method", true, [](AxisPicture& p) { p.homing_method = 9; }},
    {"set-points accepted", true, [](AxisPicture& p) { p.setpoints_accepted = 9; }},
    {"authority", true, [](AxisPicture& p) { p.authority = dds::clients; }},
    {"authority, until", true, [](AxisPicture& p) { p.authority_until = at_ns(9); }},
    {"authority, holder", true, [](AxisPicture& p) { p.authority_holder[0] = 'x'; }},
    {"latch, by", true, [](AxisPicture& p) { p.stop_latch_by[0] = 'x'; }},
    {"presence", true, [](AxisPicture& p) { p.presence = Presence::twin; }},
    {"seen", true, [](AxisPicture& p) { p.ever_seen = !p.ever_seen; }},
    {"demand source", true, [](AxisPicture& p) { p.demand_source = DemandSource::open_loop; }},
    {"streaming", true, [](AxisPicture& p) { p.streaming = !p.streaming; }},
    {"stream mode", true, [](AxisPicture& p) { p.stream_mode = SetPoint::Mode::torque; }},
    {"set-points", true, [](AxisPicture& p) { p.set_points = 9; }},
    {"set-points refused", true, [](AxisPicture& p) { p.set_points_refused = 9; }},
    {"refusal", true, [](AxisPicture& p) { p.set_point_refusal = Reason::busy; }},
    {"instant", false, [](AxisPicture& p) { p.at = at_ns(9); }},
    {"authority, since", false, [](AxisPicture& p) { p.authority_since = at_ns(9); }},
    {"authority, commander", false, [](AxisPicture& p) { p.authority_commander[0] = 'x'; }},
    {"current", false, [](AxisPicture& p) { p.current = !p.current; }},
    {"source", false, [](AxisPicture& p) { p.source = 9; }},
    {"motion", false, [](AxisPicture& p) { p.motion_ticket = 9; }},
};

TEST(Points, ArePartsOfTheComparisonOfTwoPictures) {
    AxisPicture never, running;
    running.ever_seen = running.current = running.streaming = true;
    running.demand_source = DemandSource::drive;
    for (const AxisPicture& before : {never, running}) {
        EXPECT_TRUE(same_but_time(before, before));
        for (const auto& c : changes) {
            AxisPicture after = before;
            c.make(after);
            EXPECT_EQ(same_but_time(before, after), !c.noticed) << c.what;
            EXPECT_EQ(same_but_time(after, before), !c.noticed) << c.what;
        }
    }
}

// The doors that walk the table are tested in tests/unit/runtime/points_at_doors_test.cpp.
TEST(Points, OneMoreIsFoundByAllThatIsDerived) {
    ASSERT_EQ(point_named("temperature"), nullptr);
    EXPECT_EQ(point_named("temperature", more_points), &more_points.back());
    EXPECT_EQ(row_of(temperature_point, more_points), &more_points.back());
    EXPECT_EQ(row_of(temperature_point), nullptr);
    EXPECT_TRUE(is_document_member("temperature", more_points));
    EXPECT_EQ(document_members(more_points).back(), "temperature");
    EXPECT_EQ(recipe_points(more_points).back(), "temperature");
    EXPECT_EQ(names_in(&AxisPointRow::metric, more_points).back(), "temperature_celsius");
    EXPECT_EQ(names_in(&AxisPointRow::channel, more_points).back(), "temperature");
    AxisPicture cool, warm;
    warm.motion_ticket = 41;
    EXPECT_TRUE(same_but_time(cool, warm));
    EXPECT_FALSE(same_values<more_points>(cool, warm));
    EXPECT_TRUE(same_values<more_points>(warm, warm));
    const AxisPointInfo word{temperature_point, "temperature", ValueType::i16, false, "temperature of the drive"};
    EXPECT_EQ(axis_point_named("temperature", std::span(&word, 1)), temperature_point);
}

}  // namespace
}  // namespace axisgate::test
