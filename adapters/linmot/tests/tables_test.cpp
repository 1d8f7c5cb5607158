// Command table entries and curves: texts to bytes and back, faults in texts, and transfers, also over a faulty line.
#include "adapters/linmot/parameters_tables.hpp"
#include "adapters/linmot/tests/line_bench.hpp"

namespace axisgate::linmot::test {
namespace {
Point element(const char* id) { return *page().find(id); }
const Motions& motions() {
    static const Motions all(page());
    return all;
}

TEST(LinmotTables, EveryCommandAsAnEntryReadsBackToTheSameBytes) {
    std::size_t entries = 0;
    for (const auto& c : page().commands()) {
        const Motion* m = motions().named(c.id);
        if (!m) continue;
        std::vector<Value> values;
        for (const auto& a : c.arguments)
            values.emplace_back(a.min                      ? std::int64_t{3}
                                : a.type == ValueType::u16 ? std::int64_t{54'321}
                                                           : std::int64_t{a.type == ValueType::i16 ? -123 : 1'234'567});
        std::vector<std::uint8_t> entry(entry_size, 0);
        entry[0] = 0x01;
        entry[1] = 0xA7;
        entry[2] = entry[3] = 0xFF;
        std::ranges::copy(Motions::pack(*m, 0, values), entry.begin() + 4);
        std::ranges::copy(std::string_view("fifteen letters"), entry.begin() + 38);
        const auto text = entry_text(motions(), entry);
        EXPECT_FALSE(text.starts_with("hex=")) << c.id << ": " << text;
        EXPECT_EQ(entry_of(motions(), text).bytes, entry) << text;
        ++entries;
    }
    EXPECT_EQ(entries, 216u);
    std::vector<std::uint8_t> odd(entry_size, 0x5A);
    const auto text = entry_text(motions(), odd);
    EXPECT_TRUE(text.starts_with("hex=5A5A")) << text;
    EXPECT_EQ(entry_of(motions(), text).bytes, odd);
}

TEST(LinmotTables, FaultsNameTheirPlace) {
    const auto entry = [](const char* text) { return entry_of(motions(), text).fault; };
    EXPECT_NE(entry("VAI Go: position=1").find("no motion command VAI Go"), std::string::npos);
    EXPECT_NE(entry("VAI Go To Pos: position=1 velocity=1 acceleration=1").find("deceleration is missing"), std::string::npos);
    EXPECT_NE(entry("No Operation; next=256").find("next: 256"), std::string::npos);
    EXPECT_NE(entry("No Operation; next=5; next=6").find("twice"), std::string::npos);
    EXPECT_NE(entry("No Operation; nxt=5").find("not understood"), std::string::npos);
    EXPECT_NE(entry("No Operation; name=sixteen letters!").find("at most 15"), std::string::npos);
    EXPECT_NE(entry("hex=00").find("64 bytes"), std::string::npos);
    const auto curve = [](const char* text) { return curve_of(1, text).fault; };
    EXPECT_NE(curve("length=1; points=0 1 x 3").find("point 3: x"), std::string::npos);
    EXPECT_NE(curve("length=1; points=0 1 300000").find("point 3: 300000"), std::string::npos);
    EXPECT_NE(curve("length=1; points=0").find("at least 2"), std::string::npos);
    EXPECT_NE(curve("length=0; points=0 1").find("length"), std::string::npos);
    EXPECT_NE(curve("points=0 1").find("length"), std::string::npos);
    EXPECT_NE(curve("x=angle; length=1; points=0 1").find("angle"), std::string::npos);
    EXPECT_NE(curve("length=1; points=0 1; info=zz").find("info"), std::string::npos);
}

TEST(LinmotTables, TheSampleCurveOfThePages) {
    std::string points;
    for (const int p : {0, 3078, 12'236, 27'248, 47'746})
        points += fmt::format("{:.4f} ", p * 0.0001);
    const auto c = curve_of(7, "name=sine; length=0.5; points=" + points);
    ASSERT_EQ(c.fault, "");
    EXPECT_EQ(c.info.size(), 70u);
    EXPECT_EQ(c.info[30], 7);
    EXPECT_EQ(c.info[32] | c.info[33] << 8, 50'000);
    EXPECT_EQ(c.data.size(), 20u);
    EXPECT_EQ(c.data[4] | c.data[5] << 8, 3078);
    EXPECT_EQ(curve_text(7, c.info, c.data), "name=sine; x=time; length=0.5; points=0 0.3078 1.2236 2.7248 4.7746");
    auto other = c.info;
    other[42] = 9;  // a parameter of a configuration tool
    const auto text = curve_text(7, other, c.data);
    EXPECT_NE(text.find("; info="), std::string::npos);
    EXPECT_EQ(curve_of(7, text).info, other);
}

TEST(LinmotTables, EntriesAreParameters) {
    LineBench b;
    b.run(1s);
    EXPECT_EQ(b.ask(ReadParameter{element("table[5]")}).value, Value{std::string()}) << "no entry";
    const std::string text = "VAI Go To Pos: position=50 velocity=1 acceleration=10 deceleration=10; next=6; name=out";
    EXPECT_EQ(b.ask(WriteParameter{element("table[5]"), text}).value, Value{text});
    EXPECT_EQ(b.drive().table.at(5)[4], 0x00);
    EXPECT_EQ(b.drive().table.at(5)[5], 0x01);
    EXPECT_EQ(b.ask(ReadParameter{element("table[5]")}).value, Value{text});
    const auto before = b.adapter->counters().exchanges;
    const Result bad = b.ask(WriteParameter{element("table[5]"), std::string("VAI Go To Pos: position=50")});
    EXPECT_EQ(bad.reason, Reason::out_of_range);
    EXPECT_NE(bad.text.find("table[5]: arguments: velocity is missing"), std::string::npos) << bad.text;
    EXPECT_LE(b.adapter->counters().exchanges, before + 1);
    EXPECT_EQ(b.ask(WriteParameter{element("table[5]"), std::string()}).value, Value{std::string()});
    EXPECT_FALSE(b.drive().table.contains(5));
    EXPECT_TRUE(good(b.ask(WriteParameter{element("table[5]"), std::string()}))) << "what is not there may go";
}

TEST(LinmotTables, CurvesAreParametersAndPlay) {
    LineBench b;
    b.run(1s);
    ASSERT_TRUE(b.enable());
    EXPECT_EQ(b.ask(ReadParameter{element("curve[3]")}).value, Value{std::string()});
    const std::string text = "name=up; x=time; length=0.5; points=0 1 4 10";
    const Result w = b.ask(WriteParameter{element("curve[3]"), text});
    EXPECT_EQ(w.value, Value{text}) << w.text;
    EXPECT_EQ(b.ask(ReadParameter{element("curve[3]")}).value, Value{text});
    EXPECT_TRUE(good(b.act("Time Curve With Default Parameters", {{"curve", 3}})));
    b.run(1s);
    EXPECT_EQ(b.axis().position, 100'000);
    const std::string cam = "x=encoder; length=4000; points=0 -5.5";
    EXPECT_EQ(b.act("curve.write", {{"curve", 4}, {"content", cam}}).text, "written and read back");
    EXPECT_EQ(b.act("curve.read", {{"curve", 4}}).text, cam);
    EXPECT_TRUE(good(b.act("curve.delete", {{"curve", 4}})));
    EXPECT_FALSE(b.drive().curves.contains(4));
    EXPECT_EQ(b.act("curve.save").code, 0xD7) << "the software runs";
    {
        const Result r = b.act("program.stop");
        EXPECT_TRUE(good(r)) << r.text;
    }
    EXPECT_TRUE(good(b.act("curve.save")));
    EXPECT_TRUE(good(b.act("curve.delete_all")));
    EXPECT_TRUE(b.drive().curves.empty());
    LineBench strict(1, 115200, {{"inferred", "off"}});
    strict.run(1s);
    EXPECT_EQ(strict.ask(ReadParameter{element("curve[3]")}).reason, Reason::not_supported);
}

TEST(LinmotTables, ALostWordBeginsTheTransferAnew) {
    LineBench b;
    b.run(1s);
    const std::string text = "x=time; length=0.5; points=0 1 4 10 20 30";
    ASSERT_TRUE(good(b.ask(WriteParameter{element("curve[3]"), text})));
    for (int i = 0; i < 12; ++i) {
        const Ticket t = b.submit(ReadParameter{element("curve[3]")});
        b.run(Duration{3'000'000 + i * 4'700'000});
        (void)b.hand("silent", Value{true});
        b.run(70ms);
        (void)b.hand("silent", Value{false});
        for (int k = 0; k < 3000 && b.results[t].empty(); ++k)
            b.run(1ms);
        ASSERT_EQ(b.results[t].size(), 1u);
        EXPECT_EQ(b.results[t][0].value, Value{text}) << i << ": " << b.results[t][0].text;
    }
}

}  // namespace
}  // namespace axisgate::linmot::test
