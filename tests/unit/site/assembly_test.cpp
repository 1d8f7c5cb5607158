// Entries read and refused with the holder of a place, those of profiles, the layout's revision, the text of a change.
#include "gateway/site/assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/json/parse.hpp>
#include <boost/json/serialize.hpp>

#include "gateway/core/catalogue.hpp"
#include "gateway/site/mapping.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

struct AssemblySite {
    AssemblySite() {
        std::vector<std::string> why;
        catalogue = *Catalogue::parse(R"({"family": "demo", "number": 9, "commands": [], "errors": [], "parameters": [
            {"id": "AC", "name": "acceleration", "group": "g", "type": "u32", "access": "RW", "description": "d", "min": 1, "max": 1000}]})",
                                      why);
        family.name = "demo";
        family.check_address = [](std::string_view) { return std::string(); };
        family.default_format = "8N1";
        family.uses_can = family.uses_bytes = true;
        families.entries.push_back({&family, &catalogue});
    }
    std::optional<Site> read(std::string_view assemblies, std::string_view profiles = "[]") {
        faults.clear();
        const std::string text = R"({"lines": [{"name": "l", "uri": "twin", "family": "demo"}],
            "drives": [{"name": "d", "line": "l", "address": 1}, {"name": "e", "line": "l", "address": 2}],
            "axes": [{"name": "x", "drive": "d", "number": 1}, {"name": "y", "drive": "e", "number": 2}],
            "mappings": [{"id": "word", "unit": 40, "address": 0, "axis": "x", "point": "controlword", "type": "u16"},
                         {"id": "where", "unit": 40, "address": 1, "axis": "x", "point": "position", "type": "i32"},
                         {"id": "ramp", "unit": 40, "address": 3, "axis": "y", "point": "AC", "type": "u32"},
                         {"id": "seen", "unit": 40, "table": "input_registers", "address": 0, "axis": "y", "point": "statusword", "type": "u16"}],
            "profiles": )" + std::string(profiles) +
                                 R"(, "assemblies": )" + std::string(assemblies) + "}";
        return parse_site(json::parse(text), families, faults);
    }
    /// The one fault of such a list.
    SiteFault fault(std::string_view assemblies, std::string_view profiles = "[]") {
        EXPECT_FALSE(read(assemblies, profiles)) << assemblies;
        EXPECT_EQ(faults.size(), 1u) << assemblies << (faults.size() > 1 ? faults[1].text : "");
        return faults.empty() ? SiteFault{} : faults.front();
    }
    Catalogue catalogue;
    Family family{};
    Families families;
    std::vector<SiteFault> faults;
};

TEST(SiteAssemblies, AreReadWrittenAndPartOfTheRevision) {
    AssemblySite p;
    const auto plain = p.read("[]");
    const auto site = p.read(R"([{"instance": 300, "direction": "output", "unit": 40, "registers": 5},
        {"instance": 301, "direction": "input", "unit": 40, "address": 1, "registers": 4, "byte_order": "registers", "comment": "press"},
        {"instance": 302, "direction": "input", "unit": 40, "table": "input_registers", "registers": 1}])");
    ASSERT_TRUE(plain && site) << (p.faults.empty() ? "" : p.faults.front().text);
    EXPECT_NE(mapping_revision(*plain), mapping_revision(*site));
    const json::object document = to_json(*site);
    std::vector<SiteFault> faults;
    const auto again = parse_site(document, p.families, faults);
    ASSERT_TRUE(again);
    EXPECT_EQ(again->assemblies, site->assemblies);
    EXPECT_FALSE(to_json(*plain).contains("assemblies")) << "a site without any looks as it did";
    const auto all = assemblies_of(*site);
    ASSERT_EQ(all.size(), 3u);
    EXPECT_EQ(all[0].axes, (std::vector<std::string>{"x", "y"})) << "what can be written";
    EXPECT_EQ(all[0].partner, 301);
    EXPECT_EQ(all[1].name, "press to the originator");
    EXPECT_EQ(all[2].axes, std::vector<std::string>{"y"});
    const auto changes = differences(*plain, *site);
    ASSERT_EQ(changes.size(), 3u);
    EXPECT_TRUE(changes[0].starts_with("assembly 300: not set -> {")) << changes[0];
    const auto diff = site_diff(*site, *plain);
    ASSERT_EQ(diff.size(), 3u);
    EXPECT_EQ(diff[0].get_object().at("what").get_string(), "assemblies/300");
}

TEST(SiteAssemblies, AnInstanceThatIsTakenSaysByWhat) {
    AssemblySite p;
    const auto at = [&](int instance) {
        return p.fault(R"([{"instance": )" + std::to_string(instance) + R"(, "direction": "input", "unit": 40, "registers": 3}])");
    };
    for (const auto& [instance, holder] :
         std::initializer_list<std::pair<int, std::string>>{{100, "all axes together to the originator"},
                                                            {101, "axis number 1 to the originator"},
                                                            {140, "axis number 40 to the originator"},
                                                            {190, "axis number 40 from the originator"},
                                                            {199, "the configuration"},
                                                            {1041, "axis number 41 to the originator"},
                                                            {3024, "axis number 1024 from the originator"}}) {
        const auto f = at(instance);
        EXPECT_EQ(f.text, "instance " + std::to_string(instance) + " is taken by " + holder);
        EXPECT_EQ(f.pointer, "/assemblies/0/instance");
        EXPECT_TRUE(f.conflict);
    }
    for (const int free : {1, 99, 141, 149, 191, 196, 200, 1040, 2025, 3025, 65535})
        EXPECT_TRUE(p.read(R"([{"instance": )" + std::to_string(free) + R"(, "direction": "input", "unit": 40, "registers": 3}])")) << free;
    const auto twice = p.fault(R"([{"instance": 300, "direction": "input", "unit": 40, "registers": 3},
        {"instance": 300, "direction": "output", "unit": 40, "registers": 1}])");
    EXPECT_EQ(twice.text, "instance 300 is taken by the assembly of unit 40 holding_registers 0..2");
    const char* const lexium = R"([{"unit": 10, "language": "lexium", "axes": [{"axis": "x"}], "input_assembly": 300, "object_instance": 1},
        {"unit": 11, "language": "lexium", "axes": [{"axis": "y"}], "object_instance": 1}])";
    const auto objects = p.fault("[]", lexium);
    EXPECT_EQ(objects.text, "instance 1 is taken by the profile of unit 10");
    const auto profile = p.fault(R"([{"instance": 300, "direction": "input", "unit": 40, "registers": 3}])",
                                 R"([{"unit": 10, "language": "lexium", "axes": [{"axis": "x"}], "input_assembly": 300}])");
    EXPECT_EQ(profile.pointer, "/profiles/0/input_assembly");
    EXPECT_NE(profile.text.find("taken by the assembly of unit 40"), std::string::npos);
}

TEST(SiteAssemblies, ARangeHasValuesAndCutsNone) {
    AssemblySite p;
    EXPECT_EQ(p.fault(R"([{"instance": 300, "direction": "input", "unit": 40, "registers": 2}])").text,
              "assembly 300 (unit 40 holding_registers 0..1) cuts mapping where in two, which takes 1..2");
    EXPECT_NE(p.fault(R"([{"instance": 300, "direction": "input", "unit": 41, "registers": 2}])").text.find("nothing is mapped"),
              std::string::npos);
    EXPECT_NE(
        p.fault(R"([{"instance": 300, "direction": "output", "unit": 40, "address": 1, "registers": 2}])").text.find("nothing to write"),
        std::string::npos)
        << "a position can only be read";
    EXPECT_TRUE(p.read(R"([{"instance": 300, "direction": "output", "unit": 40, "registers": 2}])")) << "what is not written may be cut";
    EXPECT_EQ(p.fault(R"([{"instance": 300, "direction": "output", "unit": 40, "table": "input_registers", "registers": 1}])").pointer,
              "/assemblies/0/table");
    EXPECT_EQ(p.fault(R"([{"instance": 300, "direction": "sideways", "unit": 40, "registers": 5}])").pointer, "/assemblies/0/direction");
    EXPECT_EQ(p.fault(R"([{"instance": 300, "direction": "input", "unit": 40, "registers": 251}])").pointer, "/assemblies/0/registers");
    EXPECT_EQ(p.fault(R"([{"instance": 300, "direction": "input", "unit": 40, "registers": 5, "size": 1}])").pointer, "/assemblies/0/size");
    std::string many = "[";
    for (int i = 0; i < 65; ++i)
        many += (i ? "," : "") + std::string(R"({"instance": )") + std::to_string(300 + i) +
                R"(, "direction": "input", "unit": 40, "registers": 5})";
    EXPECT_EQ(p.fault(many + "]").text, "65 assemblies are too many");
}

TEST(SiteAssemblies, AProfileHasTheImageOfItsLanguage) {
    AssemblySite p;
    const auto site =
        p.read("[]", R"([{"unit": 10, "language": "lexium", "axes": [{"axis": "x"}], "input_assembly": 210, "output_assembly": 310},
        {"unit": 11, "language": "pacontrol", "axes": [{"axis": "x"}, {"axis": "y"}], "input_assembly": 211, "output_assembly": 311},
        {"unit": 12, "language": "linmot", "axes": [{"axis": "x"}], "input_assembly": 212, "output_assembly": 312},
        {"unit": 13, "language": "cia402", "axes": [{"axis": "y"}], "input_assembly": 213, "output_assembly": 313}])");
    ASSERT_TRUE(site) << (p.faults.empty() ? "" : p.faults.front().text);
    const auto all = assemblies_of(*site);
    ASSERT_EQ(all.size(), 8u);
    const auto bytes = [&](std::uint16_t instance) {
        return std::ranges::find(all, instance, [](const auto& a) { return a.spec.instance; })->spec.bytes();
    };
    EXPECT_EQ(bytes(210), 338);
    EXPECT_EQ(bytes(211), 40);
    EXPECT_EQ(bytes(311), 40);
    EXPECT_EQ(bytes(212), 20);
    EXPECT_EQ(bytes(312), 34);
    EXPECT_EQ(bytes(213), 64);
    EXPECT_EQ(bytes(313), 32);
    for (const auto& a : all)
        EXPECT_EQ(a.partner, a.spec.direction == AssemblyDirection::output ? a.spec.instance - 100 : 0);
    EXPECT_EQ(all[1].spec.order, AssemblyOrder::registers) << "the image of a PA-CONTROL begins with its highest byte";
    EXPECT_EQ(p.fault("[]", R"([{"unit": 12, "language": "linmot", "axes": [{"axis": "x"}], "object_instance": 1}])").pointer,
              "/profiles/0/object_instance");
}

TEST(AssemblyCsv, ThereAndBack) {
    AssemblySite p;
    const auto site = p.read(R"([{"instance": 300, "direction": "output", "unit": 40, "registers": 5},
        {"instance": 301, "direction": "input", "unit": 40, "address": 1, "registers": 4, "byte_order": "registers", "comment": "=press, \"2\""},
        {"instance": 302, "direction": "input", "unit": 40, "table": "input_registers", "registers": 1}])");
    ASSERT_TRUE(site);
    const std::string csv = assemblies_to_csv(site->assemblies);
    EXPECT_TRUE(
        csv.starts_with("instance,direction,unit,table,address,registers,byte_order,comment\r\n"
                        "300,output,40,holding_registers,0,5,little_endian,\r\n"))
        << csv;
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    const auto rows = assemblies_from_csv(csv, lines, faults);
    ASSERT_TRUE(rows && faults.empty());
    EXPECT_EQ(lines, (std::vector<std::size_t>{2, 3, 4}));
    const auto again = p.read(json::serialize(*rows));
    ASSERT_TRUE(again) << p.faults.front().text;
    EXPECT_EQ(again->assemblies, site->assemblies);
}

TEST(AssemblyCsv, RowsAreCalledByTheirLinesAndAProfileIsNotToBlame) {
    AssemblySite p;
    auto site = p.read("[]", R"([{"unit": 10, "language": "lexium", "axes": [{"axis": "x"}], "input_assembly": 300}])");
    ASSERT_TRUE(site);
    const json::value list = json::parse(R"([{"instance": 300, "direction": "input", "unit": 40, "registers": 5},
        {"instance": 301, "direction": "input", "unit": 40, "registers": 5}, {"instance": 301, "direction": "output", "unit": 40, "registers": 5}])");
    read_assemblies(&list, *site, p.faults);
    ASSERT_TRUE(p.faults.empty());
    check_assemblies(*site, p.faults, [](std::size_t i) { return "row " + std::to_string(i + 2); });
    ASSERT_EQ(p.faults.size(), 2u);
    EXPECT_EQ(p.faults[0].pointer, "/assemblies/0/instance");
    EXPECT_EQ(p.faults[0].text, "instance 300 is taken by the profile of unit 10");
    EXPECT_EQ(p.faults[1].pointer, "/assemblies/2/instance");
    EXPECT_EQ(p.faults[1].text, "instance 301 is taken by row 3 (unit 40 holding_registers 0..4)");
}

}  // namespace
}  // namespace axisgate
