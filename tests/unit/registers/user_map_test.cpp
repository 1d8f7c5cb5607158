// Registers and bits of units 2 and up as mapped; parameters that are read in the background; writes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/registers/user_map.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using test::ResponderBench;
using namespace std::chrono_literals;

Mapping mapping(std::uint16_t address, std::variant<AxisPoint, Point> what, MapType type, MapAccess access = MapAccess::read,
                MapTable table = MapTable::holding_registers) {
    Mapping m;
    m.unit = 2;
    m.axis = "x";
    m.point = std::holds_alternative<AxisPoint>(what) ? std::string(name_of(std::get<AxisPoint>(what)))
                                                      : test::catalogue().id_of(std::get<Point>(what));
    m.address = address;
    m.what = what;
    m.type = type;
    m.access = access;
    m.table = table;
    return m;
}

struct UserMapTest : testing::Test, ResponderBench {
    AxisId x = port.add_axis(1, &test::catalogue());
    std::unique_ptr<UserMap> map;
    MapGaps gaps = MapGaps::zero;

    static Point parameter(std::string_view id) { return *test::catalogue().find(id); }
    void put(std::vector<Mapping> list) {
        std::vector<PlacedMapping> placed;
        for (auto& m : list)
            placed.push_back({std::move(m), x, 100});
        map = std::make_unique<UserMap>(port, std::move(placed), gaps,
                                        [this](UnitMap& asking, PlannedCommand c) { return image.ask_for(asking, std::move(c)); });
        image.set_map(2, map.get());
    }
    void SetUp() override {
        port.edit(x, [](AxisPicture& p) {
            p.position = 0x01020304;
            p.position_demand = 0x01020300;
            p.demand_source = DemandSource::drive;
            p.velocity = -250;
            p.flags = flag_online | flag_moving;
            p.ever_seen = true;
        });
    }
    std::string read(std::string_view pdu) { return ask(pdu, 2); }
};

TEST_F(UserMapTest, ReadsPointsOfTheAxis) {
    auto scaled = mapping(4, AxisPoint::velocity, MapType::i16);
    scaled.scale = 0.1;
    auto low = mapping(5, AxisPoint::position, MapType::i32);
    low.word_order = MapWordOrder::low_first;
    put({mapping(0, AxisPoint::position, MapType::i32), mapping(2, AxisPoint::position_units, MapType::f32), scaled, low,
         mapping(9, AxisPoint::moving, MapType::boolean), mapping(20, AxisPoint::position_demand, MapType::i32),
         mapping(22, AxisPoint::following_error, MapType::i32),
         mapping(3, AxisPoint::online, MapType::boolean, MapAccess::read, MapTable::discrete_inputs),
         mapping(4, AxisPoint::fault, MapType::boolean, MapAccess::read, MapTable::discrete_inputs)});
    EXPECT_EQ(read("03 00 00 00 02"), "03 04 01 02 03 04");
    EXPECT_EQ(read("03 00 00 00 07"), "03 0E 01 02 03 04 48 25 20 A6 FF E7 03 04 01 02");
    EXPECT_EQ(read("03 00 01 00 01"), "03 02 03 04") << "half of a value may be read";
    EXPECT_EQ(read("03 00 09 00 01"), "03 02 00 01");
    EXPECT_EQ(read("03 00 14 00 04"), "03 08 01 02 03 00 FF FF FF FC") << "demand, and demand less position";
    EXPECT_EQ(read("02 00 03 00 02"), "02 01 01");
    EXPECT_EQ(read("03 00 06 00 02"), "03 04 01 02 00 00") << "7 is a gap";
    EXPECT_EQ(read("03 00 0A 00 01"), "83 02");
    EXPECT_EQ(read("04 00 00 00 02"), "84 02") << "another table";
    EXPECT_EQ(ask("03 00 00 00 02", 3), "83 0A") << "another unit";
}

TEST_F(UserMapTest, AValueThatDoesNotFitSpoilsItselfAlone) {
    auto clamped = mapping(6, AxisPoint::position, MapType::u16);
    clamped.on_overflow = MapOverflow::clamp;
    auto below = mapping(7, AxisPoint::velocity, MapType::u16);
    below.on_overflow = MapOverflow::clamp;
    put({mapping(0, AxisPoint::position, MapType::i16), mapping(1, AxisPoint::position, MapType::i32),
         mapping(3, AxisPoint::position, MapType::u16), mapping(4, AxisPoint::velocity, MapType::u32), clamped, below});
    EXPECT_EQ(read("03 00 00 00 08"), "03 10 80 00 01 02 03 04 FF FF FF FF FF FF FF FF 00 00");
}

TEST_F(UserMapTest, APartOfAValueThatDoesNotFitIsNotChanged) {
    port.edit(x, [](AxisPicture& p) { p.target_position = 70'000; });
    put({mapping(0, AxisPoint::target_position, MapType::u16, MapAccess::read_write)});
    EXPECT_EQ(read("16 00 00 FF FE 00 01"), "96 04");
    EXPECT_TRUE(port.commands.empty());
    port.edit(x, [](AxisPicture& p) { p.target_position = 6; });
    EXPECT_EQ(read("16 00 00 FF FE 00 01"), "16 00 00 FF FE 00 01");
}

TEST_F(UserMapTest, GapsReadZeroWhereSomethingIsTouched) {
    put({mapping(2, AxisPoint::velocity, MapType::i16), mapping(5, AxisPoint::target_position, MapType::i32, MapAccess::write),
         mapping(8, AxisPoint::position, MapType::i32), mapping(3, AxisPoint::moving, MapType::boolean, MapAccess::read, MapTable::coils)});
    EXPECT_EQ(read("03 00 00 00 0C"), "03 18 00 00 00 00 FF 06 00 00 00 00 00 00 00 00 00 00 01 02 03 04 00 00 00 00")
        << "before, between, behind";
    EXPECT_EQ(read("03 00 09 00 02"), "03 04 03 04 00 00") << "the end of a value, and what follows";
    EXPECT_EQ(read("01 00 00 00 0A"), "01 02 08 00");
    EXPECT_EQ(read("17 00 01 00 03 00 05 00 02 04 00 00 00 07"), "17 06 00 00 FF 06 00 00") << "function 23 reads in the same way";
    EXPECT_EQ(read("03 00 03 00 05"), "83 02") << "nothing that can be read";
    EXPECT_EQ(read("04 00 02 00 01"), "84 02") << "another table";
    EXPECT_EQ(ask("10 00 04 00 03 06 00 00 00 00 00 00", 2), "90 02") << "never written";
    EXPECT_EQ(ask("06 00 00 00 01", 2), "86 02");
    std::string texts;
    for (const auto& [e, axis] : port.notes)
        texts += e.text + "\n";
    EXPECT_EQ(
        texts,
        "nothing is mapped in the holding registers that the request asks for, from address 3 on (unit 2 holding registers 3..7: exception "
        "2)\n"
        "nothing is mapped in the input registers that the request asks for, from address 2 on (unit 2 input register 2: exception 2)\n"
        "nothing is mapped at address 4 of the holding registers (unit 2 registers 4..6 = 0 0 0: exception 2)\n"
        "nothing is mapped at address 0 of the holding registers (unit 2 register 0 = 1: exception 2)\n");
}

TEST_F(UserMapTest, GapsAreRefusedWhereTheSiteSaysSo) {
    gaps = MapGaps::refuse;
    put({mapping(2, AxisPoint::velocity, MapType::i16), mapping(3, AxisPoint::target_position, MapType::i32, MapAccess::write),
         mapping(8, AxisPoint::velocity, MapType::i16)});
    EXPECT_EQ(read("03 00 02 00 01"), "03 02 FF 06");
    EXPECT_EQ(read("03 00 01 00 02"), "83 02");
    EXPECT_EQ(read("03 00 02 00 02"), "83 02");
    EXPECT_EQ(read("03 00 08 00 02"), "83 02");
    ASSERT_EQ(port.notes.size(), 3u);
    EXPECT_EQ(port.notes[0].first.text,
              "nothing is mapped at address 1 of the holding registers (unit 2 holding registers 1..2: exception 2)");
    EXPECT_EQ(
        port.notes[1].first.text,
        "address 3 of the holding registers (target_position of axis x) can only be written (unit 2 holding registers 2..3: exception 2)");
    EXPECT_EQ(port.notes[2].first.text,
              "nothing is mapped at address 9 of the holding registers (unit 2 holding registers 8..9: exception 2)");
    EXPECT_EQ(port.notes[0].first.severity, Severity::info);
}

TEST_F(UserMapTest, ARefusedWriteSaysWhatTheOtherDoorsSay) {
    auto half = mapping(0, parameter("A"), MapType::f32, MapAccess::read_write);
    put({half, mapping(2, AxisPoint::target_position, MapType::f64, MapAccess::read_write)});
    EXPECT_EQ(ask("10 00 00 00 02 04 44 FA 20 00", 2), "90 03") << "2001";
    EXPECT_EQ(ask("10 00 02 00 04 08 7E 37 E4 3C 88 00 75 9C", 2), "90 03") << "1e300";
    ASSERT_EQ(port.notes.size(), 2u);
    EXPECT_EQ(port.notes[0].first.text, "axis x: A: 2001 is outside -1000..1000 (unit 2 registers 0..1 = 17658 8192: exception 3)");
    EXPECT_EQ(port.notes[0].first.parameter, "A");
    EXPECT_EQ(port.notes[0].first.new_value, "2001");
    EXPECT_EQ(port.notes[0].second, x);
    EXPECT_EQ(ask("03 00 14 00 02"), "03 04 00 01 00 02") << "reason and count in the axis' own block";
}

TEST_F(UserMapTest, ParametersAreReadWhenTheyAreWanted) {
    put({mapping(0, parameter("A"), MapType::i32, MapAccess::read_write), mapping(2, parameter("E"), MapType::string)});
    map->begin(port.now());
    EXPECT_EQ(port.commands.size(), 2u);
    EXPECT_EQ(read("03 00 00 00 02"), "83 06") << "not known yet";
    EXPECT_EQ(port.commands.size(), 2u) << "it is being asked for";
    port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{-5}});
    port.answer(Outcome::done, Reason::none, 0, Value{std::string("hello")});
    EXPECT_EQ(read("03 00 00 00 02"), "03 04 FF FF FF FB");
    EXPECT_EQ(read("03 00 02 00 03"), "03 06 68 65 6C 6C 6F 00");
    EXPECT_TRUE(port.commands.empty()) << "fresh enough";
    port.time += 300ms;
    EXPECT_EQ(read("03 00 00 00 02"), "03 04 FF FF FF FB");
    ASSERT_EQ(port.commands.size(), 1u) << "and asked for again";
    EXPECT_EQ(std::get<ReadParameter>(port.commands[0].body).point, parameter("A"));
    port.refuse(Reason::no_answer);
    EXPECT_EQ(read("03 00 00 00 02"), "03 04 FF FF FF FB") << "the last one known";
    map->on_sample({x, parameter("A"), Value{std::int64_t{9}}, Quality::good, port.time});
    EXPECT_EQ(read("03 00 00 00 02"), "03 04 00 00 00 09") << "what another door wrote";
    port.edit(x, [](AxisPicture& p) { p.flags = 0; });
    EXPECT_EQ(read("03 00 00 00 02"), "83 0B") << "nothing is shown of a drive that does not answer";
}

TEST_F(UserMapTest, ReadingsAreBounded) {
    std::vector<Mapping> list;
    for (const auto* id : {"A", "B", "C", "E", "F", "N[3]", "N[4]", "N[5]", "N[6]", "G", "I", "H", "M"})
        list.push_back(mapping(static_cast<std::uint16_t>(64 * list.size()), parameter(id), MapType::string));
    put(list);
    for (int i = 0; i < 10; ++i)
        map->begin(port.now());
    EXPECT_EQ(port.commands.size(), list.size()) << "each once";
    EXPECT_LE(port.commands.size(), UserMap::most_readings);
}

TEST_F(UserMapTest, WritesGoToTheDriveAndAreAnsweredByIt) {
    auto scaled = mapping(0, parameter("A"), MapType::i16, MapAccess::read_write);
    scaled.scale = 10;
    put({scaled, mapping(1, parameter("B"), MapType::u32, MapAccess::write),
         mapping(3, AxisPoint::target_position, MapType::i32, MapAccess::read_write),
         mapping(5, AxisPoint::controlword, MapType::u16, MapAccess::read_write), mapping(6, AxisPoint::position, MapType::i32),
         mapping(0, parameter("G"), MapType::boolean, MapAccess::read_write, MapTable::coils)});
    std::vector<Command> seen;
    result = [&] {
        seen.push_back(port.commands.front());
        port.answer(Outcome::done);
    };
    EXPECT_EQ(ask("06 00 00 00 64", 2), "06 00 00 00 64");
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_EQ(std::get<WriteParameter>(seen[0].body).value, Value{std::int64_t{10}});
    EXPECT_EQ(ask("10 00 01 00 02 04 FF FF FF FF", 2), "10 00 01 00 02");
    EXPECT_EQ(std::get<WriteParameter>(seen[1].body).value, Value{std::int64_t{0xFFFFFFFF}});
    EXPECT_EQ(read("03 00 01 00 02"), "83 02") << "write only";
    EXPECT_EQ(ask("10 00 03 00 03 06 00 00 00 05 00 1F", 2), "10 00 03 00 03");
    ASSERT_EQ(seen.size(), 3u) << "one command for both";
    EXPECT_EQ(std::get<ProcessData>(seen[2].body).target_position, 5);
    EXPECT_EQ(std::get<ProcessData>(seen[2].body).controlword, 0x1F);
    EXPECT_EQ(ask("05 00 00 FF 00", 2), "05 00 00 FF 00");
    EXPECT_EQ(std::get<WriteParameter>(seen[3].body).value, Value{true});
    EXPECT_EQ(ask("06 00 00 27 11", 2), "86 03") << "1000.1 is above 1000";
    EXPECT_EQ(ask("06 00 03 00 00", 2), "86 03") << "half of a value";
    EXPECT_EQ(ask("06 00 06 00 00", 2), "86 02") << "read only";
    EXPECT_EQ(ask("06 00 63 00 00", 2), "86 02") << "not mapped";
    result = [&] { port.refuse(Reason::drive_refused, 51); };
    EXPECT_EQ(ask("06 00 00 00 64", 2), "86 04");
    EXPECT_EQ(seen.size(), 4u);
}

TEST_F(UserMapTest, AllOrNothing) {
    put({mapping(0, parameter("A"), MapType::i16, MapAccess::read_write), mapping(1, parameter("M"), MapType::u16, MapAccess::read_write)});
    EXPECT_EQ(ask("10 00 00 00 02 04 00 01 00 05", 2), "90 03") << "5 is none of the allowed values of M";
    EXPECT_TRUE(port.commands.empty()) << "A was not written either";
}

TEST_F(UserMapTest, AMapThatGoesTakesItsReadingsWithIt) {
    put({mapping(0, parameter("A"), MapType::i32)});
    map->begin(port.now());
    image.set_map(2, nullptr);
    map.reset();
    EXPECT_TRUE(port.answer(Outcome::done, Reason::none, 0, Value{std::int64_t{1}}));
    EXPECT_EQ(read("03 00 00 00 02"), "83 0A");
    EXPECT_EQ(responder.writer().waiting(), 0u);
}

TEST_F(UserMapTest, AnAxisThatIsGone) {
    put({mapping(0, AxisPoint::position, MapType::i32, MapAccess::read)});
    port.edit(x, [](AxisPicture& p) { p.number = 0; });
    EXPECT_EQ(read("03 00 00 00 02"), "83 0A");
}

}  // namespace
}  // namespace axisgate::modbus
