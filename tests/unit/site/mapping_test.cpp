// Entries read and refused, conflicts, numbers in every type and word order, CSV in both directions.
#include "gateway/site/mapping.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <boost/json/parse.hpp>
#include <cmath>
#include <cstdio>
#include <limits>

#include "gateway/core/catalogue.hpp"
#include "gateway/core/text.hpp"

namespace axisgate {
namespace {
namespace json = boost::json;

struct Plant {
    Plant() {
        std::vector<std::string> why;
        catalogue = *Catalogue::parse(R"({"family": "demo", "number": 9, "commands": [], "errors": [], "parameters": [
            {"id": "AC", "name": "acceleration", "group": "g", "type": "u32", "access": "RW", "description": "d", "min": 1, "max": 1000},
            {"id": "ML", "name": "model", "group": "g", "type": "text", "access": "R", "description": "d"},
            {"id": "KEY", "name": "key", "group": "g", "type": "u16", "access": "W", "description": "d"},
            {"id": "ON", "name": "on", "group": "g", "type": "bool", "access": "RW", "description": "d"},
            {"id": "N", "name": "n", "group": "g", "type": "i32", "access": "RW", "description": "d", "first": 1, "count": 4}]})",
                                      why);
        family.name = "demo";
        family.check_address = [](std::string_view) { return std::string(); };
        family.default_format = "8N1";
        family.uses_can = family.uses_bytes = true;
        families.entries.push_back({&family, &catalogue});
        std::vector<SiteFault> wrong;
        site = *parse_site(json::parse(R"({"lines": [{"name": "l", "uri": "twin", "family": "demo"}],
            "drives": [{"name": "d", "line": "l", "address": 1}, {"name": "e", "line": "l", "address": 2}],
            "axes": [{"name": "x", "drive": "d", "number": 1}, {"name": "x.1", "drive": "e", "number": 2}], "mappings": []})"),
                           families, wrong);
    }
    std::optional<std::vector<Mapping>> read(std::string_view list) {
        faults.clear();
        return parse_mappings(json::parse(list).get_array(), site, families, faults);
    }
    Catalogue catalogue;
    Family family{};
    Families families;
    Site site;
    std::vector<SiteFault> faults;
};

TEST(Mapping, FillsInWhatIsLeftOut) {
    Plant p;
    const auto m = p.read(R"([{"unit": 2, "address": 0, "axis": "x", "point": "position"},
        {"unit": 2, "address": 2, "point": "x.1.AC"}, {"id": "m1", "unit": 3, "address": 65535, "table": "coil", "point": "x/moving"},
        {"unit": 2, "address": 10, "point": "x:ML"}, {"unit": 2, "address": 30, "point": "x/parameters/N[3]"},
        {"unit": 2, "address": 40, "point": "x.controlword", "type": "u16"}, {"unit": 2, "address": 41, "axis": "x", "point": "key", "type": "u16"}])");
    ASSERT_TRUE(m) << p.faults.front().text;
    EXPECT_EQ((*m)[0].id, "m2") << "m1 is taken by the third";
    EXPECT_EQ((*m)[0].type, MapType::i32);
    EXPECT_EQ((*m)[0].table, MapTable::holding_registers);
    EXPECT_EQ((*m)[0].access, MapAccess::read);
    EXPECT_EQ((*m)[1].axis, "x.1") << "the longest name that fits";
    EXPECT_EQ((*m)[1].access, MapAccess::read_write);
    EXPECT_EQ((*m)[2].type, MapType::boolean);
    EXPECT_EQ((*m)[3].type, MapType::string);
    EXPECT_EQ((*m)[3].size(), 16);
    EXPECT_EQ(std::get<Point>((*m)[4].what).element, 3);
    EXPECT_EQ((*m)[5].access, MapAccess::read_write);
    EXPECT_EQ((*m)[6].access, MapAccess::write);
    json::array again;
    for (const auto& x : *m)
        again.push_back(to_json(x));
    const auto same = parse_mappings(again, p.site, p.families, p.faults);
    ASSERT_TRUE(same) << p.faults.front().text;
    for (std::size_t i = 0; i < m->size(); ++i)
        EXPECT_EQ(to_json((*same)[i]), to_json((*m)[i]));
}

TEST(Mapping, AreParsedOnceWithTheirSiteAndSharedByItsCopies) {
    Plant p;
    json::object document = to_json(p.site);
    document["mappings"] = json::parse(R"([{"unit": 2, "address": 0, "axis": "x", "point": "position"}])");
    const auto site = parse_site(document, p.families, p.faults);
    ASSERT_TRUE(site);
    ASSERT_EQ(site->map().size(), 1u);
    const Site copy = *site;  // copied like the site in force, a stage, and every door's view
    EXPECT_EQ(&copy.map(), &site->map());
}

TEST(Mapping, ASiteHoldsThemOnceAndItsDocumentIsMadeOfThem) {
    Plant p;
    json::object document = to_json(p.site);
    document["mappings"] = json::parse(R"([{"unit": 2, "address": 0, "axis": "x", "point": "position", "scale": 2.5},
        {"id": "later", "unit": 2, "address": 9, "point": "x:ML", "length": 4, "on_overflow": "mark", "comment": "read by hand"}])");
    const auto site = parse_site(document, p.families, p.faults);
    ASSERT_TRUE(site) << p.faults.front().text;
    const auto shown = to_json(*site);
    EXPECT_EQ(json_text(shown.at("mappings")),
              R"([{"id":"m1","unit":2,"table":"holding_registers","address":0,"axis":"x","point":"position","type":"i32",)"
              R"("word_order":"high_first","scale":2.5,"offset":0,"access":"R"},)"
              R"({"id":"later","unit":2,"table":"holding_registers","address":9,"axis":"x","point":"ML","type":"string",)"
              R"("word_order":"high_first","scale":1,"offset":0,"access":"R","length":4,"comment":"read by hand"}])");
    EXPECT_EQ(json_text(to_json(*parse_site(shown, p.families, p.faults))), json_text(shown)) << "what is stored opens as it was";
    Site changed = *site;
    auto list = site->map();
    list[0].scale = 3;
    list.pop_back();
    changed.mappings = std::make_shared<const std::vector<Mapping>>(std::move(list));
    EXPECT_EQ(to_json(changed).at("mappings").get_array().size(), 1u);
    EXPECT_NE(mapping_revision(changed), mapping_revision(*site));
    EXPECT_EQ(differences(*site, changed),
              (std::vector<std::string>{"mapping later (unit 2 holding_registers 9, x.ML): removed",
                                        "mapping m1 (unit 2 holding_registers 0, x.position): scale 2.5 -> 3"}));
    EXPECT_TRUE(differences(*site, *parse_site(shown, p.families, p.faults)).empty()) << "the same entries of another reading";
}

TEST(Mapping, SaysWhatIsWrongAndWhatIsRight) {
    Plant p;
    const std::pair<const char*, const char*> rows[] = {
        {R"({"unit": 1, "address": 0, "point": "x.position"})", "/mappings/0/unit"},
        {R"({"unit": 255, "address": 0, "point": "x.position"})", "/mappings/0/unit"},
        {R"({"unit": 2, "address": 65536, "point": "x.position"})", "/mappings/0/address"},
        {R"({"unit": 2, "address": 65535, "point": "x.position"})", "/mappings/0/address"},
        {R"({"unit": 2, "point": "x.position"})", "/mappings/0/address"},
        {R"({"unit": 2, "address": 0})", "/mappings/0/point"},
        {R"({"unit": 2, "address": 0, "point": "y.position"})", "/mappings/0/axis"},
        {R"({"unit": 2, "address": 0, "axis": "y", "point": "position"})", "/mappings/0/axis"},
        {R"({"unit": 2, "address": 0, "point": "x.nonsense"})", "/mappings/0/point"},
        {R"({"unit": 2, "address": 0, "point": "x.N[9]"})", "/mappings/0/point"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "type": "i33"})", "/mappings/0/type"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "type": "string"})", "/mappings/0/type"},
        {R"({"unit": 2, "address": 0, "point": "x.ML", "type": "i32"})", "/mappings/0/type"},
        {R"({"unit": 2, "address": 0, "table": "coils", "point": "x.position", "type": "i32"})", "/mappings/0/type"},
        {R"({"unit": 2, "address": 0, "table": "drawer", "point": "x.position"})", "/mappings/0/table"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "access": "RW"})", "/mappings/0/access"},
        {R"({"unit": 2, "address": 0, "table": "input", "point": "x.AC", "access": "RW"})", "/mappings/0/access"},
        {R"({"unit": 2, "address": 0, "point": "x.KEY", "type": "u16", "access": "R"})", "/mappings/0/access"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "scale": 0})", "/mappings/0/scale"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "scale": "1"})", "/mappings/0/scale"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "word_order": "middle"})", "/mappings/0/word_order"},
        {R"({"unit": 2, "address": 0, "point": "x.ML", "length": 65})", "/mappings/0/length"},
        {R"({"id": "a b", "unit": 2, "address": 0, "point": "x.position"})", "/mappings/0/id"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "on_overflow": "cut"})", "/mappings/0/on_overflow"},
        {R"({"unit": 2, "address": 0, "point": "x.position", "colour": 1})", "/mappings/0/colour"},
        {R"(5)", "/mappings/0"}};
    for (const auto& [entry, pointer] : rows) {
        EXPECT_FALSE(p.read("[" + std::string(entry) + "]")) << entry;
        ASSERT_FALSE(p.faults.empty()) << entry;
        EXPECT_EQ(p.faults.front().pointer, pointer) << entry;
        EXPECT_FALSE(p.faults.front().remedy.empty());
        EXPECT_FALSE(p.faults.front().conflict);
    }
}

TEST(Mapping, AConflictNamesTheOther) {
    Plant p;
    EXPECT_FALSE(p.read(R"([{"id": "long", "unit": 2, "address": 10, "point": "x.ML", "length": 20},
        {"id": "first", "unit": 2, "address": 8, "point": "x.position"}, {"id": "second", "unit": 2, "address": 29, "point": "x.position"},
        {"id": "other_table", "unit": 2, "table": "input", "address": 10, "point": "x.position"},
        {"id": "other_unit", "unit": 3, "address": 10, "point": "x.position"}])"));
    ASSERT_EQ(p.faults.size(), 1u);
    EXPECT_EQ(p.faults[0].pointer, "/mappings/2/address");
    EXPECT_TRUE(p.faults[0].conflict);
    EXPECT_NE(p.faults[0].text.find("29..29 is taken by mapping long"), std::string::npos) << p.faults[0].text;
    EXPECT_FALSE(p.read(
        R"([{"id": "a", "unit": 2, "address": 0, "point": "x.position"}, {"id": "a", "unit": 2, "address": 4, "point": "x.position"}])"));
    EXPECT_TRUE(p.faults.front().conflict);
    // A mapping that spans several others conflicts with each of them.
    EXPECT_FALSE(p.read(R"([{"unit": 2, "address": 0, "point": "x.ML", "length": 64}, {"unit": 2, "address": 1, "point": "x.position"},
        {"unit": 2, "address": 60, "point": "x.position"}])"));
    EXPECT_EQ(p.faults.size(), 2u);
}

Mapping of(MapType type, MapWordOrder order = MapWordOrder::high_first, double scale = 1, double offset = 0) {
    Mapping m;
    m.type = type;
    m.word_order = order;
    m.scale = scale;
    m.offset = offset;
    m.length = 3;
    return m;
}
std::string bytes(const Mapping& m, const Value& v) {
    std::uint8_t out[128] = {};
    if (!encode(m, v, out)) return "no";
    std::string s;
    for (std::size_t i = 0; i < 2u * m.size(); ++i) {
        constexpr auto digits = "0123456789ABCDEF";
        s += digits[out[i] >> 4];
        s += digits[out[i] & 15];
    }
    return s;
}

TEST(MappingValues, EveryTypeAndWordOrder) {
    const auto i = [](std::int64_t n) { return Value{n}; };
    struct Row {
        Mapping mapping;
        Value value;
        const char* registers;
    };
    using T = MapType;
    const auto low = MapWordOrder::low_first;
    const Row rows[] = {{of(T::boolean), Value{true}, "0001"},
                        {of(T::boolean), i(7), "0001"},
                        {of(T::u16), i(65535), "FFFF"},
                        {of(T::u16), i(65536), "no"},
                        {of(T::u16), i(-1), "no"},
                        {of(T::i16), i(-2), "FFFE"},
                        {of(T::i16), i(-32769), "no"},
                        {of(T::i32), i(0x01020304), "01020304"},
                        {of(T::i32, low), i(0x01020304), "03040102"},
                        {of(T::i32), i(-2), "FFFFFFFE"},
                        {of(T::u32), i(0xFFFFFFFF), "FFFFFFFF"},
                        {of(T::u32), i(0x100000000), "no"},
                        {of(T::i64), i(0x0102030405060708), "0102030405060708"},
                        {of(T::i64, low), i(0x0102030405060708), "0708050603040102"},
                        {of(T::i64), i(std::numeric_limits<std::int64_t>::min()), "8000000000000000"},
                        {of(T::u64), i(std::numeric_limits<std::int64_t>::max()), "7FFFFFFFFFFFFFFF"},
                        {of(T::u64), i(-1), "no"},
                        {of(T::f32), Value{1.5}, "3FC00000"},
                        {of(T::f32, low), Value{1.5}, "00003FC0"},
                        {of(T::f32), Value{1e300}, "no"},
                        {of(T::f64), Value{1.5}, "3FF8000000000000"},
                        {of(T::f64, low), Value{1.5}, "0000000000003FF8"},
                        {of(T::i16, MapWordOrder::high_first, 0.1, 5), i(100), "000F"},
                        {of(T::i16, MapWordOrder::high_first, 0.1), i(26), "0003"},
                        {of(T::f32, MapWordOrder::high_first, 0.5), i(3), "3FC00000"},
                        {of(T::i32), Value{2.6}, "00000003"},
                        {of(T::string), Value{std::string("abc")}, "616263000000"},
                        {of(T::string), Value{std::string("abcdefgh")}, "616263646566"},
                        {of(T::string), i(3), "no"},
                        {of(T::i32), Value{std::string("3")}, "no"},
                        {of(T::i32), Value{}, "no"}};
    for (const auto& r : rows)
        EXPECT_EQ(bytes(r.mapping, r.value), r.registers) << name_of(r.mapping.type) << " " << to_text(r.value);
}

TEST(MappingValues, WhatDoesNotFitIsMarkedOrClamped) {
    using T = MapType;
    const auto shown = [](Mapping m, const Value& v, MapOverflow overflow) {
        m.on_overflow = overflow;
        std::uint8_t out[128];
        std::ranges::fill(out, std::uint8_t{0x55});
        EXPECT_FALSE(encode(m, v, out)) << name_of(m.type) << " " << to_text(v);
        std::string s;
        for (std::size_t i = 0; i < 2u * m.size(); ++i) {
            char hex[3];
            std::snprintf(hex, sizeof hex, "%02X", out[i]);
            s += hex;
        }
        return s;
    };
    const auto low = MapWordOrder::low_first;
    const Value above{1e300}, below{-1e300}, nothing{};
    struct Row {
        Mapping mapping;
        const char *mark, *highest, *lowest;
    };
    for (const auto& r :
         {Row{of(T::u16), "FFFF", "FFFF", "0000"}, Row{of(T::i16), "8000", "7FFF", "8000"},
          Row{of(T::u32), "FFFFFFFF", "FFFFFFFF", "00000000"}, Row{of(T::i32), "80000000", "7FFFFFFF", "80000000"},
          Row{of(T::i32, low), "00008000", "FFFF7FFF", "00008000"},
          Row{of(T::u64), "FFFFFFFFFFFFFFFF", "7FFFFFFFFFFFFFFF", "0000000000000000"},
          Row{of(T::i64), "8000000000000000", "7FFFFFFFFFFFFFFF", "8000000000000000"}, Row{of(T::f32), "7FC00000", "7F7FFFFF", "FF7FFFFF"},
          Row{of(T::f64, MapWordOrder::high_first, 1e300), "7FF8000000000000", "7FEFFFFFFFFFFFFF", "FFEFFFFFFFFFFFFF"}}) {
        EXPECT_EQ(shown(r.mapping, above, MapOverflow::mark), r.mark) << name_of(r.mapping.type);
        EXPECT_EQ(shown(r.mapping, nothing, MapOverflow::mark), r.mark) << name_of(r.mapping.type);
        EXPECT_EQ(shown(r.mapping, nothing, MapOverflow::clamp), r.mark) << "near to no end";
        EXPECT_EQ(shown(r.mapping, above, MapOverflow::clamp), r.highest) << name_of(r.mapping.type);
        EXPECT_EQ(shown(r.mapping, below, MapOverflow::clamp), r.lowest) << name_of(r.mapping.type);
    }
    EXPECT_EQ(shown(of(T::i16), Value{std::int64_t{40'000}}, MapOverflow::clamp), "7FFF");
    EXPECT_EQ(shown(of(T::string), Value{std::int64_t{3}}, MapOverflow::mark), "000000000000");
}

TEST(MappingValues, WhatIsWrittenIsReadBack) {
    for (const auto type :
         {MapType::u16, MapType::i16, MapType::u32, MapType::i32, MapType::u64, MapType::i64, MapType::f32, MapType::f64}) {
        for (const auto order : {MapWordOrder::high_first, MapWordOrder::low_first}) {
            for (const double scale : {1.0, 0.1, -2.5}) {
                for (const std::int64_t n : {0, 1, -1, 10, 120, -3200}) {
                    const Mapping m = of(type, order, scale, scale == 1.0 ? 0 : 20000);
                    std::uint8_t registers[8];
                    if (!encode(m, Value{n * 10}, registers)) continue;
                    EXPECT_EQ(decode(m, registers), (Value{n * 10})) << name_of(type) << " " << n << " scale " << scale;
                }
            }
        }
    }
    std::uint8_t text[6] = {'o', 'k', 0, 'x', 0, 0};
    EXPECT_EQ(decode(of(MapType::string), text), Value{std::string("ok")});
    std::uint8_t nan[4] = {0x7F, 0xC0, 0, 0};
    EXPECT_FALSE(known(decode(of(MapType::f32), nan)));
    std::uint8_t half[2] = {0, 1};
    EXPECT_EQ(decode(of(MapType::u16, MapWordOrder::high_first, 2), half), Value{0.5});
    std::uint8_t big[8] = {0x80, 0, 0, 0, 0, 0, 0, 0};
    EXPECT_FALSE(known(decode(of(MapType::u64), big))) << "beyond what a value carries";
}

TEST(MappingCsv, ThereAndBack) {
    Plant p;
    const auto m =
        *p.read(R"([{"id": "a", "unit": 2, "address": 0, "point": "x.position", "scale": 0.001, "comment": "say \"x\", twice\nand more"},
        {"id": "b", "unit": 2, "address": 4, "point": "x.ML", "length": 5, "comment": "=1+1"},
        {"id": "c", "unit": 2, "address": 20, "point": "x.position", "type": "i16", "on_overflow": "clamp"}])");
    EXPECT_EQ(m[2].on_overflow, MapOverflow::clamp);
    const std::string csv = mappings_to_csv(m);
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    const auto rows = mappings_from_csv(csv, lines, faults);
    ASSERT_TRUE(rows) << faults.front().text;
    EXPECT_EQ(lines, (std::vector<std::size_t>{2, 4, 5})) << "the first entry's comment has two lines";
    EXPECT_EQ(csv.find(",=1+1"), std::string::npos) << "a spreadsheet does not carry it out";
    const auto again = parse_mappings(*rows, p.site, p.families, p.faults);
    ASSERT_TRUE(again) << p.faults.front().text;
    for (std::size_t i = 0; i < m.size(); ++i)
        EXPECT_EQ(to_json((*again)[i]), to_json(m[i]));
}

TEST(MappingCsv, SemicolonsMarksAndFaults) {
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    const auto rows = mappings_from_csv("\xEF\xBB\xBFunit;address;point\r\n2;0;x.position\r\n\r\n3;1;x.AC", lines, faults);
    ASSERT_TRUE(rows);
    EXPECT_EQ(rows->size(), 2u);
    EXPECT_EQ(lines.back(), 4u);
    const std::pair<const char*, std::size_t> wrong[] = {
        {"", 1}, {"unit,nonsense\n2,3", 1}, {"unit,unit\n", 1}, {"unit\ntwo\n", 2}, {"unit\n2,3\n", 2}, {"unit,point\n2,\"open", 2}};
    for (const auto& [text, line] : wrong) {
        faults.clear();
        (void)mappings_from_csv(text, lines, faults);
        ASSERT_FALSE(faults.empty()) << text;
        EXPECT_EQ(faults.front().line, line) << text;
    }
    faults.clear();
    (void)mappings_from_csv("unit\n" + std::string(9000, 'x'), lines, faults);
    EXPECT_FALSE(faults.empty());
}

TEST(MappingCsv, RowsBehindAFaultyOneAreReadToo) {
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    const auto rows = mappings_from_csv("unit,address,point\n2,0,x.position\n2,x,x.AC\n2,9,nowhere\n", lines, faults);
    ASSERT_TRUE(rows);
    ASSERT_EQ(faults.size(), 1u);
    EXPECT_EQ(faults[0].line, 3u);
    EXPECT_EQ(lines, (std::vector<std::size_t>{2, 4})) << "what else is wrong with the file can be told at once";
}

TEST(MappingCsv, ADecimalCommaBetweenSemicolons) {
    std::vector<std::size_t> lines;
    std::vector<CsvFault> faults;
    const auto rows = mappings_from_csv("unit;address;scale;offset\n2;0;0,5;-1,25\n", lines, faults);
    ASSERT_TRUE(rows && faults.empty());
    EXPECT_EQ(rows->at(0).at("scale").as_double(), 0.5);
    EXPECT_EQ(rows->at(0).at("offset").as_double(), -1.25);
    for (const auto* wrong : {"unit;scale\n2;1,2,3\n", "unit;scale\n2;1.000,5\n", "unit,scale\n2,\"0,5\"\n"}) {
        faults.clear();
        (void)mappings_from_csv(wrong, lines, faults);
        EXPECT_EQ(faults.size(), 1u) << wrong;
    }
}

/// A family whose drives have the parameters named by their option `extra`, in addition to its page.
OwnCatalogue with_extra(const CatalogueWish& wish) {
    const auto it = wish.options.find("extra");
    if (it == wish.options.end()) return {};
    if (it->second == "?") return {nullptr, "extra = ?: write the name of a parameter"};
    std::vector<std::string> faults;
    auto made = wish.page.with(
        {json::object{{"id", it->second}, {"name", it->second}, {"group", "g"}, {"type", "u16"}, {"access", "RW"}, {"description", "d"}}},
        faults);
    EXPECT_TRUE(made) << faults.front();
    return {made ? std::make_shared<const Catalogue>(std::move(*made)) : nullptr, {}};
}

TEST(OwnCatalogue, MappingsOfADriveAreReadByItsOwn) {
    Plant p;
    p.family.own_catalogue = with_extra;
    auto document = to_json(p.site);
    document["drives"].as_array()[0].as_object()["options"] = json::object{{"extra", "Q1"}};
    document["mappings"] = json::parse(
        R"([{"unit": 2, "address": 0, "axis": "x", "point": "Q1", "type": "u16"}, {"unit": 2, "address": 1, "axis": "x.1", "point": "AC"}])");
    const auto site = parse_site(document, p.families, p.faults);
    ASSERT_TRUE(site) << p.faults.front().text;
    const auto own = catalogue_of(*site, site->drives[0], p.families), page = catalogue_of(*site, site->drives[1], p.families);
    EXPECT_EQ(page.get(), &p.catalogue);
    const auto point = own->find("Q1");
    ASSERT_TRUE(point);
    EXPECT_EQ(point->parameter, p.catalogue.parameters().size()) << "behind those of the page, whose points stay";
    EXPECT_EQ(own->find("AC"), p.catalogue.find("AC"));
    ASSERT_EQ(site->map().size(), 2u);
    EXPECT_EQ(site->map()[0].what, (std::variant<AxisPoint, Point>(*point)));
    EXPECT_NE(mapping_revision(*site), mapping_revision(p.site));

    auto renamed = document;
    renamed["drives"].as_array()[0].as_object()["options"] = json::object{{"extra", "Q2"}};
    p.faults.clear();
    EXPECT_FALSE(parse_site(renamed, p.families, p.faults));
    ASSERT_EQ(p.faults.size(), 1u);
    EXPECT_EQ(p.faults[0].pointer, "/mappings/0/point") << p.faults[0].text;
    renamed.erase("mappings");
    const auto other = parse_site(renamed, p.families, p.faults);
    auto bare = document;
    bare.erase("mappings");
    EXPECT_NE(mapping_revision(*other), mapping_revision(*parse_site(bare, p.families, p.faults)))
        << "a selector of the parameter channel names another one";

    document["drives"].as_array()[1].as_object()["options"] = json::object{{"extra", "?"}};
    p.faults.clear();
    EXPECT_FALSE(parse_site(document, p.families, p.faults));
    ASSERT_EQ(p.faults.size(), 1u);
    EXPECT_EQ(p.faults[0].pointer, "/drives/1/options");
    EXPECT_EQ(p.faults[0].text, "drive e: extra = ?: write the name of a parameter");
}

TEST(OwnCatalogue, FurtherParametersAreCheckedAsThoseOfThePage) {
    Plant p;
    std::vector<std::string> faults;
    const auto made = p.catalogue.with(
        {json::object{{"id", "Q1"}, {"name", "q1"}, {"group", "g"}, {"type", "i32"}, {"access", "RW"}, {"description", "d"}}}, faults);
    ASSERT_TRUE(made && faults.empty());
    EXPECT_EQ(made->document().at("parameters").as_array().size(), made->parameters().size())
        << "forms are read from the document by the same place";
    EXPECT_EQ(made->family(), "demo");
    EXPECT_EQ(p.catalogue.find("Q1"), std::nullopt);
    EXPECT_FALSE(
        made->with({json::object{{"id", "AC"}, {"name", "ac2"}, {"group", "g"}, {"type", "i32"}, {"access", "RW"}, {"description", "d"}},
                    json::value(3)},
                   faults));
    EXPECT_EQ(faults, (std::vector<std::string>{"parameters[6]: AC is there twice", "parameters[7]: not an object"}));
}

TEST(ModbusUnits, AreReadCheckedAndTold) {
    Plant p;
    auto document = to_json(p.site);
    EXPECT_FALSE(document.contains("modbus_units"));
    document["modbus_units"] = json::parse(R"([{"unit": 9, "gaps": "zero"}, {"unit": 2, "gaps": "refuse"}])");
    const auto site = parse_site(document, p.families, p.faults);
    ASSERT_TRUE(site) << p.faults.front().text;
    EXPECT_EQ(site->gaps, (std::map<std::uint8_t, MapGaps>{{2, MapGaps::refuse}, {9, MapGaps::zero}}));
    EXPECT_EQ(to_json(*parse_site(to_json(*site), p.families, p.faults)), to_json(*site));
    EXPECT_NE(mapping_revision(*site), mapping_revision(p.site)) << "what a register shows is another";
    EXPECT_EQ(differences(p.site, *site),
              (std::vector<std::string>{"modbus unit 2: gaps not set -> refuse", "modbus unit 9: gaps not set -> zero"}));
    const std::pair<const char*, const char*> rows[] = {
        {R"({})", "/modbus_units"},
        {R"([{"gaps": "zero"}])", "/modbus_units/0/unit"},
        {R"([{"unit": 1, "gaps": "zero"}])", "/modbus_units/0/unit"},
        {R"([{"unit": 2}])", "/modbus_units/0/gaps"},
        {R"([{"unit": 2, "gaps": "none"}])", "/modbus_units/0/gaps"},
        {R"([{"unit": 2, "gaps": "zero", "x": 1}])", "/modbus_units/0/x"},
        {R"([{"unit": 2, "gaps": "zero"}, {"unit": 2, "gaps": "zero"}])", "/modbus_units/1/unit"}};
    for (const auto& [list, pointer] : rows) {
        p.faults.clear();
        document["modbus_units"] = json::parse(list);
        EXPECT_FALSE(parse_site(document, p.families, p.faults)) << list;
        ASSERT_EQ(p.faults.size(), 1u) << list << p.faults.back().text;
        EXPECT_EQ(p.faults.front().pointer, pointer) << list;
    }
}

}  // namespace
}  // namespace axisgate
