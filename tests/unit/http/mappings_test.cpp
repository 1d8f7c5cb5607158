// Mappings over REST: entries one by one, conflicts that name the other entry, CSV as a whole or not at all.
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {

TEST_F(HttpTest, MappingsOneByOne) {
    const auto list = call("GET", "/api/v1/mappings");
    ASSERT_EQ(list.array().size(), 1u);
    EXPECT_EQ(list.array()[0].at("id"), "m1") << "ids are given";
    EXPECT_EQ(list.array()[0].at("axis"), "slide");
    EXPECT_EQ(list.array()[0].at("table"), "holding_registers");
    const auto added = call("POST", "/api/v1/mappings", R"({"unit": 2, "address": 2, "axis": "feeder", "point": "AC", "type": "u32"})");
    EXPECT_EQ(added.status, 201u) << added.text;
    EXPECT_EQ(added.at("id"), "m2");
    EXPECT_EQ(added.at("access"), "RW");
    EXPECT_EQ(added.headers.get("Location"), "/api/v1/mappings/m2");
    EXPECT_EQ(call("GET", "/api/v1/mappings/m2").at("point"), "AC");
    EXPECT_EQ(call("GET", "/api/v1/mappings?axis=feeder").array().size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/mappings?unit=3").array().size(), 0u);
    EXPECT_EQ(call("GET", "/api/v1/mappings?unit=1").status, 400u);
    const auto put =
        call("PUT", "/api/v1/mappings/m2", R"({"unit": 2, "address": 10, "axis": "feeder", "point": "AC", "type": "f64", "scale": 2})");
    EXPECT_EQ(put.status, 200u) << put.text;
    EXPECT_EQ(put.at("id"), "m2");
    EXPECT_EQ(put.at("type"), "f64");
    EXPECT_EQ(call("DELETE", "/api/v1/mappings/m2").status, 204u);
    EXPECT_EQ(call("GET", "/api/v1/mappings/m2").status, 404u);
    EXPECT_EQ(call("DELETE", "/api/v1/mappings/m2").status, 404u);
    EXPECT_EQ(call("PUT", "/api/v1/mappings/m2", R"({"unit": 2, "address": 10, "point": "feeder.AC"})").status, 404u);
}

TEST_F(HttpTest, AMappingConflictNamesTheOther) {
    const auto a = call("POST", "/api/v1/mappings", R"({"unit": 2, "address": 1, "point": "feeder.position"})");
    EXPECT_EQ(a.status, 409u) << a.text;
    EXPECT_NE(a.at("detail").find("m1"), std::string::npos) << a.text;
    EXPECT_EQ(a.fault().at("pointer"), "/address");
    EXPECT_TRUE(gateway.applied.empty());
    const auto wrong = call("POST", "/api/v1/mappings", R"({"unit": 2, "address": 1, "point": "feeder.nothing"})");
    EXPECT_EQ(wrong.status, 422u);
    EXPECT_EQ(wrong.fault().at("pointer"), "/point");
}

TEST_F(HttpTest, MappingsAsCsv) {
    const auto csv = call("GET", "/api/v1/mappings.csv");
    EXPECT_EQ(csv.status, 200u);
    EXPECT_TRUE(csv.headers.get("Content-Type").starts_with("text/csv"));
    EXPECT_TRUE(csv.text.starts_with("id,unit,table,address,axis,point,")) << csv.text;
    const std::vector<std::pair<std::string, std::string>> type{{"Content-Type", "text/csv"}};
    const std::string two = "unit,address,axis,point\r\n2,0,feeder,position\r\n2,2,slide,velocity\r\n";
    const auto dry = call("PUT", "/api/v1/mappings.csv?dry_run=1", two, type);
    EXPECT_EQ(dry.status, 200u) << dry.text;
    EXPECT_EQ(dry.at("mappings"), "2");
    EXPECT_EQ(dry.at("rows"), "2") << "of the table";
    for (const auto* method : {"PUT", "POST"}) {
        const auto late = call(method, "/api/v1/mappings.csv?dry_run=1", two, {{"Content-Type", "text/csv"}, {"If-Match", "\"77\""}});
        EXPECT_EQ(late.status, 412u) << method << " tries as it would be: " << late.text;
        EXPECT_EQ(late.at("etag"), "\"1\"");
    }
    EXPECT_EQ(call("PUT", "/api/v1/mappings.csv?dry_run=1", two, {{"Content-Type", "text/csv"}, {"If-Match", "\"1\""}}).status, 200u);
    EXPECT_TRUE(gateway.applied.empty());
    EXPECT_EQ(call("PUT", "/api/v1/mappings.csv", two, type).status, 200u);
    EXPECT_EQ(gateway.site()->site.map().size(), 2u);
    const auto more =
        call("POST", "/api/v1/mappings.csv", "id,unit,address,axis,point\nm1,2,100,feeder,position\n,2,4,slide,flags\n", type);
    EXPECT_EQ(more.status, 200u) << more.text;
    ASSERT_EQ(gateway.site()->site.map().size(), 3u) << "m1 was replaced, one was added";
    EXPECT_EQ(call("GET", "/api/v1/mappings/m1").at("address"), "100");
    const auto faulty = call("POST", "/api/v1/mappings.csv",
                             "unit,address,axis,point\n2,200,feeder,position\n2,200,nobody,position\n2,4,slide,flags\n", type);
    EXPECT_EQ(faulty.status, 422u);
    EXPECT_EQ(faulty.object().at("faults").get_array().size(), 2u) << faulty.text;
    EXPECT_EQ(faulty.fault(0).at("pointer"), "/3");
    EXPECT_EQ(faulty.fault(1).at("pointer"), "/4");
    // A cell that cannot be read does not prevent the check of the other rows.
    const auto mixed =
        call("PUT", "/api/v1/mappings.csv?dry_run=1",
             "unit,address,axis,point\n1,0,feeder,position\n2,x,feeder,position\n2,5,nobody,position\n2,9,feeder,position\n", type);
    EXPECT_EQ(mixed.status, 422u);
    std::set<std::string> lines;
    for (const auto& f : mixed.object().at("faults").get_array())
        lines.insert(std::string(f.at("pointer").as_string()));
    EXPECT_EQ(lines, (std::set<std::string>{"/2", "/3", "/4"})) << mixed.text;
    EXPECT_EQ(gateway.site()->site.map().size(), 3u) << "all or nothing";
    EXPECT_EQ(call("POST", "/api/v1/mappings.csv", "{}").status, 415u);
}

TEST_F(HttpTest, RowsOfATableThatAreInEachOthersWayAreNamedByTheirLines) {
    const auto faulty = [this](const char* method, std::string table) {
        const auto a = call(method, "/api/v1/mappings.csv?dry_run=1", std::move(table), {{"Content-Type", "text/csv"}});
        EXPECT_EQ(a.status, 422u) << a.text;
        return std::string(a.fault().at("text").get_string());
    };
    const auto own = faulty("PUT", "unit,address,axis,point\n\n2,0,feeder,position\n2,1,slide,position\n");
    EXPECT_EQ(own,
              "unit 2 holding_registers 1..1 is taken by row 3 (position of axis feeder); choose another address, or take one of the two "
              "rows out");
    const auto added = faulty("POST", "unit,address,axis,point\n2,1,feeder,position\n");
    EXPECT_EQ(
        added,
        "unit 2 holding_registers 1..1 is taken by mapping m1 (position of axis slide); choose another address, or remove that mapping");
    const auto put_over = faulty("POST", "id,unit,address,axis,point\nm1,2,10,slide,position\n,2,11,feeder,position\n");
    EXPECT_NE(put_over.find("is taken by row 2 (position"), std::string::npos) << "in the place of the one that was there: " << put_over;
}

TEST_F(HttpTest, ATemplateIsTriedOnTheSiteThatIsMeant) {
    const std::string body = R"({"template":"standard_map","axis":"feeder","unit":9,"dry_run":true})";
    EXPECT_EQ(call("POST", "/api/v1/mappings/template", body, {{"If-Match", "\"77\""}}).status, 412u);
    EXPECT_EQ(call("POST", "/api/v1/mappings/template", body, {{"If-Match", "\"1\""}}).status, 200u);
    EXPECT_TRUE(gateway.applied.empty());
}

TEST_F(HttpTest, PointsThatCanBeMapped) {
    const auto a = call("GET", "/api/v1/mapping-points");
    ASSERT_GT(a.array().size(), 20u);
    EXPECT_EQ(json_text(a.array()[0]),
              R"({"point":"statusword","access":"R","description":"CiA 402 status word, with 8 simulated, 14 stale, 15 )"
              R"(referenced","type":"u16","unit":null,"member":"statusword"})");
    const auto of = [&a](std::string_view point) {
        for (const auto& p : a.array())
            if (p.at("point").get_string() == point)
                return std::string(p.at("type").get_string()) + " " + json_text(p.at("unit")) + " " + json_text(p.at("member"));
        return std::string("none");
    };
    EXPECT_EQ(of("position"), R"(i32 "increments" "position_increments")");
    EXPECT_EQ(of("velocity_units"), R"(f32 "unit/s" "velocity")");
    EXPECT_EQ(of("mode"), "i16 null null") << "the document's mode is another value";
    EXPECT_EQ(of("authority"), "u16 null null") << "the document has its word";
    EXPECT_EQ(of("moving"), R"(bool null "moving")");
}

TEST_F(HttpTest, SeveralMappingsAreRemovedAtOnceOrNone) {
    for (const auto* entry : {R"({"id": "a", "unit": 2, "address": 20, "point": "feeder.position"})",
                              R"({"id": "b", "unit": 3, "address": 0, "point": "feeder.position"})",
                              R"({"id": "c", "unit": 3, "address": 2, "point": "slide.position"})"})
        ASSERT_EQ(call("POST", "/api/v1/mappings", entry).status, 201u);
    EXPECT_EQ(call("DELETE", "/api/v1/mappings").status, 400u) << "never all by an oversight";
    EXPECT_EQ(call("DELETE", "/api/v1/mappings?all=1&unit=3").status, 400u);
    EXPECT_EQ(call("DELETE", "/api/v1/mappings?ids=").status, 400u);
    EXPECT_EQ(call("DELETE", "/api/v1/mappings?ids=a,z").status, 404u);
    EXPECT_EQ(call("GET", "/api/v1/mappings").array().size(), 4u);
    const auto dry = call("DELETE", "/api/v1/mappings?unit=3&dry_run=1");
    EXPECT_EQ(dry.status, 200u) << dry.text;
    EXPECT_EQ(dry.at("removed"), R"(["b","c"])");
    EXPECT_EQ(dry.at("mappings"), "2");
    EXPECT_EQ(call("GET", "/api/v1/mappings").array().size(), 4u);
    const auto some = call("DELETE", "/api/v1/mappings?unit=3&axis=slide");
    EXPECT_EQ(some.at("removed"), R"(["c"])") << some.text;
    EXPECT_EQ(call("DELETE", "/api/v1/mappings?ids=a,b").at("removed"), R"(["a","b"])");
    EXPECT_EQ(call("DELETE", "/api/v1/mappings?all=1").at("removed"), R"(["m1"])");
    EXPECT_EQ(call("GET", "/api/v1/mappings").array().size(), 0u);
}

TEST_F(HttpTest, AUnitSaysHowItAnswersWhereNothingIsMapped) {
    EXPECT_EQ(call("GET", "/api/v1/mappings/units").text, R"([{"unit":2,"gaps":null,"shown":"zero","mappings":1}])");
    const auto set = call("PUT", "/api/v1/mappings/units/7", R"({"gaps": "refuse"})");
    EXPECT_EQ(set.status, 200u) << set.text;
    EXPECT_EQ(set.text, R"({"unit":7,"gaps":"refuse","shown":"refuse","mappings":0})");
    EXPECT_EQ(call("GET", "/api/v1/mappings/units").array().size(), 2u);
    EXPECT_EQ(call("GET", "/api/v1/site").at("modbus_units"), R"([{"unit":7,"gaps":"refuse"}])");
    EXPECT_EQ(call("PUT", "/api/v1/mappings/units/7", R"({"gaps": null})").at("shown"), "zero");
    EXPECT_FALSE(call("GET", "/api/v1/site").object().contains("modbus_units"));
    EXPECT_EQ(call("PUT", "/api/v1/mappings/units/1", R"({"gaps": "zero"})").status, 404u);
    for (const auto* wrong : {R"({})", R"({"gaps": "none"})", R"({"gaps": 0})", R"({"gaps": "zero", "x": 1})"})
        EXPECT_EQ(call("PUT", "/api/v1/mappings/units/7", wrong).status, 422u) << wrong;
}

}  // namespace
}  // namespace axisgate::http::test
