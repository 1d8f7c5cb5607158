// The table of points at every door: the known values have not changed, and an additional row is found at each door.
#include <gtest/gtest.h>

#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>
#include <fstream>
#include <iterator>
#include <set>

#include "gateway/core/text.hpp"
#include "gateway/doors/dds/axis_sample.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/registers/register_lists.hpp"
#include "gateway/registers/register_map.hpp"
#include "gateway/registers/user_map.hpp"
#include "gateway/runtime/axis_metrics.hpp"
#include "gateway/services/documents.hpp"
#include "gateway/services/recipes/recipe_point.hpp"
#include "gateway/services/recorder/channels.hpp"
#include "tests/unit/axis/points_bench.hpp"

namespace axisgate::test {
namespace {
namespace json = boost::json;

std::string file_text(const std::string& name) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/" + name, std::ios::binary);
    EXPECT_TRUE(file) << name;
    return {std::istreambuf_iterator<char>(file), {}};
}

AxisSpec feeder() {
    AxisSpec a;
    a.name = a.drive = "feeder";
    a.number = 3;
    a.unit = "mm";
    a.increments_per_unit = 100;
    return a;
}
AxisPicture running() {
    AxisPicture p;
    p.number = 3;
    p.family_number = 5;
    p.position = 250;
    p.position_demand = 260;
    p.velocity = -50;
    p.native_status = 4'000'000'000;
    p.error_code = 7;
    p.statusword = 0x0E27;
    p.mode_display = 8;
    p.flags = flag_online | flag_simulated | flag_moving;
    p.fail_safe_cause = 2;
    p.stop_latch = 3;
    p.controlword = 15;
    p.mode = 1;
    p.target_position = 300;
    p.profile_velocity = 70'000;
    p.profile_acceleration = 80'000;
    p.profile_deceleration = 90'000;
    p.target_velocity = -40;
    p.homing_method = -17;
    p.setpoints_accepted = 4;
    p.authority = http::clients;
    p.authority_until = at_ns(31'000'000'000);
    p.authority_holder = {'a', 'n', 'n', 'a'};
    p.presence = Presence::twin;
    p.ever_seen = p.current = true;
    p.demand_source = DemandSource::computed;
    p.at = at_ns(1'000'000'000);
    p.streaming = true;
    p.set_points = 11;
    p.set_points_refused = 2;
    p.set_point_refusal = Reason::busy;
    return p;
}

TEST(PointsAtDoors, TheDocumentOfAnAxisReadsAsBefore) {
    const AxisSpec spec = feeder();
    const AxisPicture p = running(), never;
    const auto text = [&spec](const AxisPicture& picture) {
        return json_text(axis_document({spec, "can0", "uim342", nullptr, picture, 1'700'000'000'000'000'000, 1'700'000'000'250'000'000}));
    };
    const std::string site =
        R"({"name":"feeder","drive":"feeder","channel":1,"number":3,"unit":"mm","increments_per_unit":100,"line":"can0","family":"uim342",)";
    EXPECT_EQ(
        text(p),
        site +
            R"("online":true,"simulated":true,"stale":false,"presence":"twin","state":"operation_enabled","statusword":3623,"controlword":15,)"
            R"("mode":"cyclic_position","mode_number":8,"modes":[],)"
            R"("set_points":{"streaming":true,"mode":"position","taken":11,"refused":2,"reason":"busy"},)"
            R"("moving":true,"target_reached":false,"referenced":false,"fault":false,"warning":false,"internal_limit":true,)"
            R"("fail_safe_cause":"modbus_silent","stop_latch":3,"stop_latch_by":null,)"
            R"("stop_latch_text":"the gateway (modbus_silent) has stopped it: it moves again by a new command, or when a controller changes its )"
            R"x(own words (a new set-point, the halt bit or the enable bits)",)x"
            R"("position":2.5,"demand_known":true,"demand_source":"computed","position_demand":2.6,"following_error":0.1,"velocity":-0.5,)"
            R"("target_position":3,"target_velocity":-0.4,"position_increments":250,"position_demand_increments":260,)"
            R"("following_error_increments":10,"velocity_increments":-50,"target_position_increments":300,)"
            R"("error":{"code":7,"text":"not in the catalogue"},"native":4000000000,"authority":"http","authority_holder":"anna",)"
            R"("authority_until":"2023-11-14T22:13:50.000000Z","setpoints_accepted":4,"at":"2023-11-14T22:13:20.000000Z","age_ms":250})");
    EXPECT_EQ(
        text(never),
        site +
            R"("online":false,"simulated":false,"stale":false,"presence":"offline","state":"not_ready_to_switch_on","statusword":0,"controlword":0,)"
            R"("mode":"none","mode_number":0,"modes":[],)"
            R"("set_points":{"streaming":false,"mode":null,"taken":0,"refused":0,"reason":null},)"
            R"("moving":false,"target_reached":false,"referenced":false,"fault":false,"warning":false,"internal_limit":false,)"
            R"("fail_safe_cause":null,"stop_latch":0,"stop_latch_by":null,"stop_latch_text":null,)"
            R"("position":null,"demand_known":false,"demand_source":null,"position_demand":null,"following_error":null,"velocity":null,)"
            R"("target_position":null,"target_velocity":null,"position_increments":null,"position_demand_increments":null,)"
            R"("following_error_increments":null,"velocity_increments":null,"target_position_increments":null,)"
            R"("error":{"code":0,"text":""},"native":0,"authority":"none","authority_holder":"","authority_until":null,"setpoints_accepted":0,)"
            R"("at":null,"age_ms":null})");
}

TEST(PointsAtDoors, MetricsReadAsBefore) {
    SiteState site;
    site.site.axes = {feeder(), feeder()};
    site.site.axes[1].name = "slide";
    const AxisPicture pictures[] = {running(), AxisPicture{}};
    const std::string text = axis_metrics(site, pictures, at_ns(1'250'000'000));
    const auto head = [](const std::string& name, const std::string& help) {
        return "# HELP axisgate_axis_" + name + " " + help + "\n# TYPE axisgate_axis_" + name + " gauge\n";
    };
    std::string expected =
        head("position", "Actual position in the axis' unit.") + "axisgate_axis_position{axis=\"feeder\",unit=\"mm\"} 2.5\n" +
        head("velocity", "Actual velocity in the axis' unit per second.") + "axisgate_axis_velocity{axis=\"feeder\",unit=\"mm\"} -0.5\n" +
        head("following_error", "Demanded less actual position in the axis' unit.") +
        "axisgate_axis_following_error{axis=\"feeder\",unit=\"mm\"} 0.1\n" +
        head("age_seconds", "Time since the drive said what is shown.") + "axisgate_axis_age_seconds{axis=\"feeder\"} 0.250\n" +
        head("state", "1: the CiA 402 state that the axis is in.");
    for (const auto* axis : {"feeder", "slide"}) {
        for (const auto* state : {"not_ready_to_switch_on", "switch_on_disabled", "ready_to_switch_on", "switched_on", "operation_enabled",
                                  "quick_stop_active", "fault_reaction_active", "fault"}) {
            const bool on =
                std::string(axis) == "feeder" ? std::string(state) == "operation_enabled" : std::string(state) == "not_ready_to_switch_on";
            expected += "axisgate_axis_state{axis=\"" + std::string(axis) + "\",state=\"" + state + "\"} " + (on ? "1\n" : "0\n");
        }
    }
    const auto flag = [&](const std::string& name, const std::string& help, const char* of_feeder) {
        expected += head(name, help) + "axisgate_axis_" + name + "{axis=\"feeder\"} " + of_feeder + "\naxisgate_axis_" + name +
                    "{axis=\"slide\"} 0\n";
    };
    flag("online", "1: the drive or its twin answers.", "1");
    flag("simulated", "1: the embedded twin serves the axis.", "1");
    flag("stale", "1: what is shown is too old to be trusted.", "0");
    flag("moving", "1: the axis moves.", "1");
    flag("referenced", "1: the position has a known zero.", "0");
    flag("fault", "1: the axis is in fault.", "0");
    EXPECT_EQ(text, expected);
}

// The other members of the IDL come from the gateway, the site and the sample itself.
TEST(PointsAtDoors, TheSampleHasTheMembersOfTheIdl) {
    const std::string idl = file_text("schema/axisgate.idl");
    const auto begin = idl.find("struct AxisState {");
    ASSERT_NE(begin, std::string::npos);
    std::set<std::string> members;
    for (std::size_t at = begin, end = idl.find("};", begin); at < end;) {
        const auto next = idl.find('\n', at);
        const std::string line = idl.substr(at, next - at);
        if (const auto semicolon = line.find(';'); semicolon != std::string::npos && line.find('}') == std::string::npos)
            members.insert(line.substr(line.rfind(' ', semicolon) + 1, semicolon - line.rfind(' ', semicolon) - 1));
        at = next + 1;
    }
    for (const auto* own : {"gateway", "axis", "instance", "family", "unit", "increments_per_unit", "at_unix_ns", "count"})
        EXPECT_EQ(members.erase(own), 1u) << own;
    std::set<std::string> points;
    for (const auto& row : axis_point_table)
        if (!row.sample.empty()) points.emplace(row.sample);
    EXPECT_EQ(points, members);
}

TEST(PointsAtDoors, TheSampleIsFilledAsBefore) {
    axisgate_AxisState s{};
    dds::put_points<axis_point_table, dds::axis_state_members>(s, running());
    EXPECT_EQ(s.number, 3);
    EXPECT_TRUE(s.online && s.simulated && s.moving && s.streaming);
    EXPECT_FALSE(s.stale || s.referenced || s.target_reached || s.fault || s.warning);
    EXPECT_EQ(s.statusword, 0x0E27);
    EXPECT_EQ(s.mode, 8);
    EXPECT_EQ(s.position, 250);
    EXPECT_EQ(s.velocity, -50);
    EXPECT_EQ(s.error_code, 7);
    EXPECT_EQ(s.fail_safe_cause, 2);
    EXPECT_STREQ(s.authority, "http");
    EXPECT_STREQ(s.authority_holder, "anna");
    EXPECT_EQ(s.set_points, 11u);
    EXPECT_EQ(s.set_points_refused, 2u);
    EXPECT_STREQ(s.set_point_refusal, "busy");
    EXPECT_EQ(s.position_demand, 260);
    EXPECT_STREQ(s.demand_source, "computed");
    dds::put_points<axis_point_table, dds::axis_state_members>(s, AxisPicture{});
    EXPECT_STREQ(s.demand_source, "none") << "a sample has no null";
    EXPECT_STREQ(s.set_point_refusal, "none");
    EXPECT_STREQ(s.authority, "none");
    EXPECT_FALSE(s.online || s.streaming);
}

TEST(PointsAtDoors, RegistersOfTheStandardMapHoldThePointsThatTheyAreNamedBy) {
    std::uint8_t block[registers::block_size] = {};
    const AxisPicture p = running();
    registers::render(p, 0, registers::WordOrder::high_first, block);
    std::set<std::string_view> of_the_door{"refusal_reason", "refusals", "age_ms", "heartbeat", "mapping_revision"};
    for (const auto& r : registers::standard_registers()) {
        if (r.point.empty() || of_the_door.contains(r.point)) continue;
        const auto word = axis_point_named(r.point);
        const auto* row = word ? row_of(*word) : point_named(r.point);
        ASSERT_NE(row, nullptr) << r.point;
        const PointValue v = measured(*row, p, 100);
        const auto* n = std::get_if<std::int64_t>(&v);
        ASSERT_NE(n, nullptr) << r.point;
        const std::uint8_t* at = block + 2 * std::size_t{r.offset};
        if (r.width() == 2) {
            EXPECT_EQ(registers::get32(at, registers::WordOrder::high_first), static_cast<std::uint32_t>(*n)) << r.point;
        } else {
            EXPECT_EQ(registers::get16(at), static_cast<std::uint16_t>(*n)) << r.point;
        }
        if (word) {
            EXPECT_EQ(name_of(info_of(*word).type), name_of(r.type)) << r.point;
        }
    }
}

/// A condition reads one value, which is the document's value of that name.
TEST(PointsAtDoors, ARecipeSeesOfEachPointWhatTheDocumentShows) {
    const AxisSpec spec = feeder();
    AxisPicture p = running();
    p.ever_seen = true;
    p.flags = static_cast<std::uint16_t>((p.flags | flag_online) & ~flag_stale);
    const auto document = axis_document({spec, "can0", "uim342", nullptr, p, 1'000'000'000, 1'700'000'000});
    std::size_t looked_at = 0;
    for (const auto& row : axis_point_table) {
        const Value seen = recipe_point(row, p, spec, 700);
        if (row.recipe == PointInRecipe::no) {
            EXPECT_EQ(seen, Value{}) << row.name;
        } else if (row.document != PointInDocument::no) {
            EXPECT_EQ(to_json(seen), document.at(row.name)) << row.name;
            ++looked_at;
        }
    }
    EXPECT_GT(looked_at, 30u);
    EXPECT_EQ(recipe_point(*point_named("error_code"), p, spec, 0), Value{std::int64_t{7}});
    EXPECT_EQ(recipe_point(*point_named("number"), AxisPicture{}, spec, 0), Value{std::int64_t{spec.number}}) << "as the site has it";
    EXPECT_EQ(recipe_point(*point_named("online"), AxisPicture{}, spec, 0), Value{false});
    for (const auto flags : {flag_stale | flag_online, 0}) {
        p.flags = static_cast<std::uint16_t>(flags);
        EXPECT_EQ(recipe_point(*point_named("position"), p, spec, 0), Value{}) << flags;
        EXPECT_TRUE(known(recipe_point(*point_named("presence"), p, spec, 0))) << flags;
    }
}

TEST(PointsAtDoors, TheSchemaOfRecipesNamesThePointsOfRecipes) {
    const auto schema = json::parse(file_text("schema/recipe.schema.json"));
    const auto points = recipe_points();
    const std::set<std::string> expected(points.begin(), points.end());
    std::size_t found = 0;
    const auto look = [&](const auto& self, const json::value& v) -> void {
        if (const auto* a = v.if_array())
            for (const auto& x : *a)
                self(self, x);
        const auto* o = v.if_object();
        if (!o) return;
        for (const auto& [key, x] : *o) {
            const auto* names = key == "point" && x.is_object() ? x.get_object().if_contains("enum") : nullptr;
            if (names) {
                std::set<std::string> there;
                for (const auto& name : names->as_array())
                    there.emplace(name.as_string());
                EXPECT_EQ(there, expected);
                ++found;
            }
            self(self, x);
        }
    };
    look(look, schema);
    EXPECT_EQ(found, 3u);
}

/// AxisState with one additional member.
struct LaterState {
    std::int16_t temperature = 0;
};
constexpr std::array later_members{dds::sample_member<&LaterState::temperature, LaterState>("temperature")};
constexpr std::array alone{temperature};

TEST(PointsAtDoors, OneMoreRowIsFoundAtEveryDoor) {
    const AxisSpec spec = feeder();
    AxisPicture p = running();
    const AxisView view{spec, "can0", "uim342", nullptr, p, 1, 2};
    const AxisPointRows rows = more_points;

    // HTTP, and its comparison for the live feed
    EXPECT_FALSE(axis_document(view).contains("temperature"));
    EXPECT_EQ(axis_document(view, rows).at("temperature"), json::value(nullptr)) << "nobody has said it yet";
    p.motion_ticket = 41;
    EXPECT_EQ(axis_document(view, rows).at("temperature"), json::value(41));
    EXPECT_FALSE(same_values<more_points>(running(), p));

    // recipes
    ASSERT_EQ(point_named("temperature"), nullptr) << "no point of the program's own table";
    const AxisPointRow& looked_at = *point_named("temperature", rows);
    EXPECT_EQ(recipe_point(looked_at, p, spec, 0), Value{std::int64_t{41}});
    p.flags |= flag_stale;
    EXPECT_EQ(recipe_point(looked_at, p, spec, 0), Value{}) << "too old for a recipe";

    // user maps
    const auto* row = row_of(temperature_point, rows);
    ASSERT_NE(row, nullptr);
    EXPECT_EQ(registers::axis_value(*row, Image{}, p, 100, {}), Value{std::int64_t{41}});

    // DDS
    LaterState sample;
    dds::put_points<alone, later_members>(sample, p);
    EXPECT_EQ(sample.temperature, 41);

    // metrics
    SiteState site;
    site.site.axes = {spec};
    const std::string metrics = axis_metrics(site, std::span(&p, 1), {}, rows);
    EXPECT_TRUE(
        metrics.ends_with("# HELP axisgate_axis_temperature_celsius Temperature of the drive.\n# TYPE axisgate_axis_temperature_celsius "
                          "gauge\naxisgate_axis_temperature_celsius{axis=\"feeder\"} 41\n"))
        << metrics;

    // recorder
    constexpr auto points = channel_names<more_points, false>();
    constexpr auto levels = channel_names<more_points, true>();
    EXPECT_EQ(points.back(), "temperature");
    EXPECT_EQ(levels.back(), "temperature");
    EXPECT_EQ(points.size(), trend_points.size() + 1);
}

TEST(PointsAtDoors, TheRecorderKnowsTheChannelsThatItsFilesHave) {
    EXPECT_EQ(listed_points(trend_points), "position, velocity, demand, following_error, state");
    EXPECT_EQ(listed_points(level_points, " or "), "position, velocity, demand or following_error");
}

}  // namespace
}  // namespace axisgate::test
