// Register lists through the router: the offsets that a PLC computes from the structures are the addresses of the mappings; numbers and
// units; templates. The offsets are computed from the text only, like a compiler with packed structures.
#include <fmt/core.h>

#include <regex>
#include <sstream>

#include "gateway/registers/register_lists.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
class Lists : public HttpTest {
protected:
    void put_mappings(const std::string& mappings) {
        gateway.put_site(R"({"lines":[{"name":"can0","uri":"twin","family":"demo"}],"drives":[{"name":"feeder","line":"can0","address":5}],
          "axes":[{"name":"feeder","drive":"feeder","number":1,"unit":"mm","increments_per_unit":3200}],"mappings":[)" +
                         mappings + "]}");
    }
    std::string list(const std::string& format) { return call("GET", "/api/v1/mappings/list?format=" + format).text; }
};

/// Number of registers, or bits, of a member by its type.
std::uint32_t size_of(const std::string& type) {
    std::smatch m;
    if (std::regex_match(type, m, std::regex(R"(ARRAY\[0\.\.(\d+)\] OF WORD)"))) return static_cast<std::uint32_t>(std::stoul(m[1])) + 1;
    if (type == "BOOL" || type == "WORD" || type == "UINT" || type == "INT") return 1;
    if (type == "UDINT" || type == "DINT" || type == "REAL") return 2;
    if (type == "ULINT" || type == "LINT" || type == "LREAL") return 4;
    ADD_FAILURE() << "a type that has no fixed length everywhere: " << type;
    return 0;
}

/// "unit table begin name" to the address of the member in a packed structure.
std::map<std::string, std::uint32_t> places_in(const std::string& text, int& structures, int& packed) {
    std::map<std::string, std::uint32_t> out;
    std::istringstream lines(text);
    std::smatch m;
    std::string place;
    std::uint32_t at = 0;
    bool attribute = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("{attribute 'pack_mode' := '1'}")) attribute = true;
        if (std::regex_match(line, m, std::regex(R"(  Unit(\d+)_(\w+)_(\d+) : STRUCT)"))) {
            place = m[1].str() + " " + m[2].str() + " " + m[3].str() + " ";  // names are unique within a structure
            at = static_cast<std::uint32_t>(std::stoul(m[3]));
            ++structures;
            packed += attribute ? 1 : 0;
            attribute = false;
        } else if (std::regex_match(line, m, std::regex(R"(    (\w+) : ([^;]+); \(\* .* \*\))"))) {
            EXPECT_TRUE(out.emplace(place + m[1].str(), at).second) << line;
            at += size_of(m[2]);
        }
    }
    return out;
}

TEST_F(Lists, AStructureHasEachMemberWhereItsMappingIs) {
    put_mappings(R"(
      {"unit":2,"address":0,"point":"feeder.statusword","type":"u16"}, {"unit":2,"address":1,"point":"feeder.position","type":"i32"},
      {"unit":2,"address":3,"point":"feeder.moving","type":"bool"}, {"unit":2,"address":4,"point":"feeder.mode_display","type":"i16"},
      {"unit":2,"address":7,"point":"feeder.position","type":"f64"}, {"unit":2,"address":11,"point":"feeder.ML","type":"string","length":5},
      {"unit":2,"address":16,"point":"feeder.native_status","type":"u32"}, {"unit":2,"address":18,"point":"feeder.position","type":"i64"},
      {"unit":2,"address":22,"point":"feeder.age_ms","type":"u64"}, {"unit":2,"address":26,"point":"feeder.velocity_units","type":"f32","word_order":"low_first"},
      {"unit":2,"address":40,"point":"feeder.ML","type":"string","length":1}, {"unit":2,"address":41,"point":"feeder.warning","type":"bool"},
      {"unit":2,"table":"coils","address":3,"point":"feeder.fault"}, {"unit":2,"table":"coils","address":4,"point":"feeder.moving"},
      {"unit":2,"table":"coils","address":9,"point":"feeder.online"}, {"unit":2,"table":"discrete_inputs","address":0,"point":"feeder.online"},
      {"unit":2,"table":"input_registers","address":0,"point":"feeder.position","type":"i32"}, {"unit":3,"address":0,"point":"feeder.position","type":"i32"})");
    const auto text = list("st");
    int structures = 0, packed = 0;
    const auto places = places_in(text, structures, packed);
    EXPECT_EQ(structures, 8) << "one for each run without a gap\n" << text;
    EXPECT_EQ(packed, structures);
    const auto mappings = call("GET", "/api/v1/mappings").array();
    ASSERT_EQ(mappings.size(), 18u);
    EXPECT_EQ(places.size(), mappings.size()) << text;
    // "unit table begin name": names are made from axis and point, the addresses are compared.
    std::multiset<std::string> wanted, got;
    for (const auto& m : mappings)
        wanted.insert(fmt::format("{} {} {}", m.at("unit").as_int64(), std::string(m.at("table").as_string()), m.at("address").as_int64()));
    for (const auto& [name, at] : places)
        got.insert(fmt::format("{} {}", name.substr(0, name.find(' ', name.find(' ') + 1)), at));
    EXPECT_EQ(got, wanted) << text;
    EXPECT_EQ(text.find("STRING"), std::string::npos) << "an end mark moves what comes after it";
    EXPECT_NE(text.find("feeder_moving : WORD; (* +3 holding_registers 3, bool: 0 or 1"), std::string::npos) << text;
}

TEST_F(Lists, PaperHasNumbersFromOneAndUnits) {
    EXPECT_EQ(register_number(MapTable::holding_registers, 0), "40001");
    EXPECT_EQ(register_number(MapTable::holding_registers, 9998), "49999");
    EXPECT_EQ(register_number(MapTable::holding_registers, 9999), "410000");
    EXPECT_EQ(register_number(MapTable::input_registers, 65535), "365536");
    EXPECT_EQ(register_number(MapTable::coils, 0), "00001");
    EXPECT_EQ(register_number(MapTable::discrete_inputs, 15), "10016");
    put_mappings(
        R"({"unit":2,"address":4,"point":"feeder.velocity_units","type":"f32"},{"unit":2,"address":6,"point":"feeder.AC","type":"u32"},
      {"unit":2,"address":8,"point":"feeder.position","type":"i32"})");
    const auto csv = list("csv");
    EXPECT_NE(csv.find("mapping_revision,register_number,engineering_unit\r\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find(",40005,mm/s\r\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find(",40007,pulse/s^2\r\n"), std::string::npos) << csv;
    EXPECT_NE(csv.find(",40009,increments\r\n"), std::string::npos) << csv;
    const auto page = list("html");
    EXPECT_NE(page.find("<td>40005</td>"), std::string::npos) << page;
    EXPECT_NE(page.find("<td>mm/s</td>"), std::string::npos) << page;
}

TEST_F(Lists, ABlockOfAnAxisIsGaplessAndStandsAtAMultipleOf64) {
    put_mappings(R"({"unit":3,"address":2,"point":"feeder.position","type":"i32"})");
    EXPECT_EQ(call("GET", "/api/v1/mappings/next-free?unit=3&words=64").at("address"), "64");
    EXPECT_EQ(call("GET", "/api/v1/mappings/next-free?unit=3&words=64&align=1").at("address"), "4");
    EXPECT_EQ(call("GET", "/api/v1/mappings/next-free?unit=3&words=2").at("address"), "0");
    EXPECT_EQ(call("GET", "/api/v1/mappings/next-free?unit=3&words=3&align=8").at("address"), "8");
    auto made = call("POST", "/api/v1/mappings/template", R"({"template":"standard_map","axis":"feeder","unit":3})");
    if (made.status == 0) made = answered();
    ASSERT_EQ(made.status, 201u) << made.text;
    std::uint32_t at = 64;
    for (const auto& m : made.object().at("mappings").get_array()) {
        if (at == 84) at = 96;  // 20..31 are not used
        EXPECT_EQ(m.at("address").to_number<std::uint32_t>(), at) << json_text(m);
        const auto type = m.at("type").as_string();
        at += type == "u32" || type == "i32" ? 2u : 1u;
    }
    EXPECT_EQ(at, 64u + 45u) << "0..19 and 32..44 can each be read at once";
    const std::string st = list("st");
    EXPECT_NE(st.find("Unit3_holding_registers_64 : STRUCT"), std::string::npos) << st;
    EXPECT_NE(st.find("20 registers"), std::string::npos) << st;
}
}  // namespace
}  // namespace axisgate::http::test
