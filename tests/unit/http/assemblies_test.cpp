// Assemblies as CSV over REST: exported, tried, added, replacing all; every faulty line has its number, and nothing is accepted then.
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
const std::vector<std::pair<std::string, std::string>> csv_type{{"Content-Type", "text/csv"}};
constexpr const char* csv_path = "/api/v1/assemblies.csv";
constexpr const char* csv_names = "instance,direction,unit,table,address,registers,byte_order,comment\r\n";

std::set<std::pair<std::string, std::string>> published(const Answer& a) {
    std::set<std::pair<std::string, std::string>> out;
    for (const auto& f : a.object().at("faults").get_array())
        out.emplace(f.at("pointer").as_string(), f.at("text").as_string());
    return out;
}

TEST_F(HttpTest, AssembliesAsCsv) {
    const auto empty = call("GET", csv_path);
    EXPECT_EQ(empty.status, 200u);
    EXPECT_EQ(empty.headers.get("Content-Type"), "text/csv; charset=utf-8");
    EXPECT_EQ(empty.headers.get("Content-Disposition"), "attachment; filename=\"assemblies.csv\"");
    EXPECT_EQ(empty.text, csv_names);
    const std::string two =
        "\xEF\xBB\xBFinstance;direction;unit;registers;comment\r\n300;input;2;2;\"the \"\"press\"\"; left\"\r\n;;;;\r\n301;output;2;2;\r\n";
    const auto dry = call("PUT", std::string(csv_path) + "?dry_run=1", two, csv_type);
    EXPECT_EQ(dry.status, 422u) << "slide.position can only be read";
    EXPECT_EQ(dry.fault().at("pointer"), "/4");
    const std::string good = "instance\tdirection\tunit\tregisters\tcomment\n300\tinput\t2\t2\tthe \"press\"; left\n301\tinput\t2\t4\t\n";
    const auto tried = call("PUT", std::string(csv_path) + "?dry_run=1", good, csv_type);
    EXPECT_EQ(tried.status, 200u) << tried.text;
    EXPECT_EQ(tried.at("dry_run"), "true");
    EXPECT_EQ(tried.at("rows"), "2");
    EXPECT_EQ(tried.at("assemblies"), "2");
    ASSERT_EQ(tried.object().at("differences").get_array().size(), 2u) << tried.text;
    EXPECT_EQ(tried.object().at("differences").get_array()[0].as_string().find("assembly 300: not set ->"), 0u) << tried.text;
    for (const auto* method : {"PUT", "POST"})
        EXPECT_EQ(call(method, std::string(csv_path) + "?dry_run=1", good, {{"Content-Type", "text/csv"}, {"If-Match", "\"77\""}}).status,
                  412u);
    EXPECT_TRUE(gateway.applied.empty()) << "what is tried is not done";
    const auto put = call("PUT", csv_path, good, csv_type);
    EXPECT_EQ(put.status, 200u) << put.text;
    EXPECT_EQ(put.at("dry_run"), "false");
    const auto out = call("GET", csv_path);
    EXPECT_EQ(out.text, std::string(csv_names) +
                            "300,input,2,holding_registers,0,2,little_endian,\"the \"\"press\"\"; "
                            "left\"\r\n301,input,2,holding_registers,0,4,little_endian,\r\n");
    const auto same = call("PUT", std::string(csv_path) + "?dry_run=1", out.text, csv_type);
    EXPECT_TRUE(same.object().at("differences").get_array().empty()) << "what was written is what is there: " << same.text;
    const auto more = call("POST", csv_path, "instance,direction,unit,registers\n301,input,2,2\n302,input,2,3\n", csv_type);
    EXPECT_EQ(more.status, 200u) << more.text;
    EXPECT_EQ(more.at("assemblies"), "3") << "301 has its place, 302 is added";
    EXPECT_EQ(call("GET", "/api/v1/assemblies/301").at("registers"), "2");
    EXPECT_EQ(call("PUT", csv_path, csv_names, csv_type).at("assemblies"), "0") << "a table without rows is an empty list";
    EXPECT_EQ(call("POST", csv_path, "{}").status, 415u);
}

TEST_F(HttpTest, FaultyRowsOfAnAssemblyTableAreNamedByTheirLines) {
    ASSERT_EQ(call("PUT", "/api/v1/assemblies/300", R"({"direction": "input", "unit": 2, "registers": 2})").status, 200u);
    const auto before = gateway.applied.size();
    const auto wrong = call("POST", csv_path,
                            "instance,direction,unit,address,registers\n301,input,two,0,2\n302,sideways,2,0,2\n303,input,9,0,2\n\n304,"
                            "input,2,1,2\n101,input,2,0,2\n305,input,2,0,2\n305,input,2,0,4\n",
                            csv_type);
    EXPECT_EQ(wrong.status, 422u);
    EXPECT_EQ(wrong.at("detail"), "line 2: unit: \"two\" is no number (and 5 more)");
    const auto all = published(wrong);
    const std::pair<const char*, const char*> wanted[] = {{"/2", "unit: \"two\" is no number"},
                                                          {"/3", "\"sideways\" is no direction; use input"},
                                                          {"/4", "nothing is mapped"},
                                                          {"/6", "cuts mapping m1 in two"},
                                                          {"/7", "instance 101 is taken by axis number 1"},
                                                          {"/9", "instance 305 is taken by row 8 (unit 2"}};
    ASSERT_EQ(all.size(), std::size(wanted)) << wrong.text;
    for (const auto& w : wanted)
        EXPECT_TRUE(
            std::ranges::any_of(all, [&w](const auto& f) { return f.first == w.first && f.second.find(w.second) != std::string::npos; }))
            << w.first << " " << w.second << " in " << wrong.text;
    std::string many = "instance,direction,unit,registers\n";
    for (int i = 0; i < 65; ++i)
        many += std::to_string(400 + i) + ",input,2,2\n";
    EXPECT_EQ(call("PUT", csv_path, many, csv_type).fault().at("pointer"), "/66");
    const auto beyond = call("POST", csv_path, many.substr(0, many.size() - std::string("464,input,2,2\n").size()), csv_type);
    EXPECT_EQ(beyond.status, 422u) << "64 and the one that is there";
    EXPECT_EQ(beyond.fault().at("pointer"), "") << beyond.text;
    EXPECT_EQ(beyond.at("detail").find("65 assemblies are too many"), 0u) << beyond.text;
    EXPECT_EQ(gateway.applied.size(), before) << "nothing has been taken";
}

TEST_F(HttpTest, ATableThatTakesAwayWhatOthersNeedSaysSoWithoutALine) {
    ASSERT_EQ(call("PUT", "/api/v1/assemblies/300", R"({"direction": "input", "unit": 2, "registers": 2})").status, 200u);
    const auto a = call("PUT", "/api/v1/mappings.csv", "unit,address,axis,point\n3,0,feeder,position\n", csv_type);
    EXPECT_EQ(a.status, 422u);
    EXPECT_EQ(a.fault().at("pointer"), "");
    EXPECT_EQ(a.at("detail").find("assembly 300 has nothing to show"), 0u) << a.text;
}

}  // namespace
}  // namespace axisgate::http::test
