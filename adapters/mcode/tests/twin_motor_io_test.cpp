// Tests of inputs, outputs, analog input, trips, jog, following, supply and temperature.
#include "adapters/mcode/tests/twin_motor_bench.hpp"

#include <cmath>

namespace axisgate::mcode::twin::test {
namespace {

using Kind = MotorEvent::Kind;

TEST(McodePoints, InputSetupHasItsCodes) {
    MotorBench b;
    struct Row {
        std::vector<double> is;
        int code;
    };
    const Row rows[] = {
        {{1, 0, 0}, 0},  {{1, 1, 0}, 0},  {{1, 1, 0}, 6},  {{1, 1, 1}, 6}, {{2, 1, 0}, 0},  {{2, 0, 0}, 0},
        {{2, 0, 0}, 0},  {{2, 12, 0}, 8}, {{2, 13, 0}, 8}, {{1, 9, 0}, 8}, {{1, 10, 0}, 8}, {{1, 16, 0}, 8},
        {{7, 0, 0}, 10}, {{0, 0, 0}, 10}, {{1, 2, 2}, 21}, {{1}, 21},      {{1, 12, 1}, 0}, {{5, 9, 1}, 0},
        {{5, 8, 0}, 8},  {{5, 10, 1}, 0}, {{6, 1}, 0},     {{6, 2}, 21},
    };
    for (const Row& r : rows)
        EXPECT_EQ(b.set("IS", r.is), r.code) << r.is[0] << ',' << (r.is.size() > 1 ? r.is[1] : -1);
    EXPECT_EQ(*b.motor.text(Word::IS, b.now),
              "IS = 1, 12, 1\r\nIS = 2, 0, 0\r\nIS = 3, 0, 0\r\nIS = 4, 0, 0\r\nIS = 5, 10, 1\r\nIS = 6, 0, 1");

    MotorBench small({lmdc, 17});
    EXPECT_EQ(small.set("IS", {4, 0, 0}), 10);
    EXPECT_EQ(small.set("IS", {1, 12, 0}), 8);
    EXPECT_EQ(small.set("IS", {3, 13, 0}), 11);  // there is no pair
    EXPECT_EQ(small.get("IN"), 7);
    EXPECT_EQ(small.set("FC", 1), 37);
    EXPECT_EQ(small.set("O1", 1), 37);
    EXPECT_EQ(small.set("OS", {1, 17, 0}), 10);
    EXPECT_EQ(small.set("OS", {3, 17, 0}), 0);
    MotorBench module({lmm, 23});
    EXPECT_EQ(module.set("IS", {5, 9, 0}), 24);
    EXPECT_EQ(module.read_error("AF"), 37);
    EXPECT_EQ(module.set("FL", 1), 37);
    EXPECT_EQ(module.read_error("OF"), 37);
}

TEST(McodePoints, ClockInputsAreAPair) {  // trap 22
    MotorBench b;
    EXPECT_EQ(b.set("IS", {3, 13, 0}), 0);
    EXPECT_NE(b.motor.text(Word::IS, b.now)->find("IS = 4, 13, 0"), std::string::npos);
    EXPECT_EQ(b.set("IS", {4, 15, 1}), 0);
    EXPECT_NE(b.motor.text(Word::IS, b.now)->find("IS = 3, 15, 0"), std::string::npos);
    EXPECT_EQ(b.set("IS", {4, 0, 0}), 0);
    EXPECT_NE(b.motor.text(Word::IS, b.now)->find("IS = 3, 0, 0"), std::string::npos);

    b.set("FL", 1);
    b.hand("clock_pulses", 500.0);
    EXPECT_EQ(b.get("P"), 0);  // no clock type
    b.set("IS", {3, 13, 1});
    EXPECT_EQ(b.set("IS", {4, 13, 1}), 0);
    b.hand("clock_pulses", 51200.0);
    b.hand("clock_pulses", -1200.0);
    EXPECT_EQ(b.get("P"), 50000);
    EXPECT_EQ(b.get("C1"), 50000);
    EXPECT_EQ(b.get("C2"), std::round(50000 * 4000 / 51200.0));
}

TEST(McodePoints, IFollowsActivityAndFilterAndInNeither) {  // trap 23
    MotorBench b;
    EXPECT_EQ(b.get("IN"), 15);  // open inputs are high
    EXPECT_EQ(b.get("I1"), 0);   // active low
    b.set("D1", 50);
    b.hand("inputs", std::int64_t{14});
    EXPECT_EQ(b.get("IN"), 14);
    EXPECT_EQ(b.get("I1"), 0);
    b.pass_ms(49);
    EXPECT_EQ(b.get("I1"), 0);
    b.pass_ms(1);
    EXPECT_EQ(b.get("I1"), 1);
    b.hand("inputs", std::int64_t{15});
    b.pass_ms(20);
    b.hand("inputs", std::int64_t{14});  // a bounce
    b.pass_ms(100);
    EXPECT_EQ(b.get("I1"), 1);
    b.set("IS", {2, 0, 1});
    EXPECT_EQ(b.get("I2"), 1);
    b.hand("active_inputs", std::int64_t{0});
    EXPECT_EQ(b.get("I2"), 0);
    EXPECT_EQ(b.get("IN"), 13);
}

TEST(McodePoints, TypedInputsActOnceWhenTheyBecomeActive) {
    MotorBench b;
    b.set("IS", {1, 4, 0});
    b.set("IS", {2, 6, 0});
    EXPECT_TRUE(b.events.empty());
    b.hand("active_inputs", std::int64_t{3});
    EXPECT_EQ(b.count(Kind::go), 1);
    EXPECT_EQ(b.count(Kind::pause), 1);
    b.hand("active_inputs", std::int64_t{0});
    EXPECT_EQ(b.count(Kind::go), 1);
    EXPECT_EQ(b.count(Kind::resume), 1);
    b.events.clear();
    b.set("IS", {3, 11, 0});
    EXPECT_EQ(b.count(Kind::reset), 0);
    b.set("IS", {3, 0, 0});
    b.hand("inputs", std::int64_t{15});
    b.set("IS", {3, 11, 1});  // an open input with a high active level resets at once [L780]
    b.pass_ms(0);
    EXPECT_EQ(b.count(Kind::reset), 1);
    // Saved so, it does not reset for ever.
    NonVolatile m;
    b.motor.save(m);
    b.motor.restart(b.now);
    b.motor.factory(b.now);
    b.motor.load(m, b.now);
    b.events.clear();
    b.pass_ms(10);
    EXPECT_EQ(b.count(Kind::reset), 0);
}

TEST(McodePoints, JogRunsAtVmWhileItsInputIsActive) {
    MotorBench b;
    b.set("IS", {1, 7, 0});
    b.set("IS", {2, 8, 0});
    b.hand("active_inputs", std::int64_t{1});
    EXPECT_EQ(b.get("MV"), 0);  // JE = 0
    b.set("JE", 1);
    b.pass_ms(1000);
    EXPECT_EQ(b.get("V"), 768000);
    b.hand("active_inputs", std::int64_t{2});
    b.pass_ms(2000);
    EXPECT_EQ(b.get("V"), -768000);
    b.hand("active_inputs", std::int64_t{0});
    b.pass_ms(100);
    EXPECT_NEAR(b.get("V"), -668000, 10);
    b.rest();
    EXPECT_EQ(b.count(Kind::finished), 0);
    EXPECT_EQ(b.errors(), Codes{});
}

TEST(McodePoints, OutputSetupHasItsCodesAndOutputsShowTheirFunction) {
    MotorBench b;
    EXPECT_EQ(b.set("OS", {1, 17, 1}), 0);
    EXPECT_EQ(b.set("OS", {1, 17, 1}), 6) << "the point has it already";
    EXPECT_EQ(b.set("OS", {2, 17, 1}), 0) << "another one may have it too";
    EXPECT_EQ(b.set("OS", {2, 16, 0}), 0);
    EXPECT_EQ(b.set("OS", {2, 16, 0}), 0) << "free (listing 9.3)";
    EXPECT_EQ(b.set("OS", {4, 16, 1}), 10);
    EXPECT_EQ(b.set("OS", {2, 22, 1}), 8);
    EXPECT_EQ(b.set("OS", {2, 28, 1}), 8);
    EXPECT_EQ(b.set("OS", {2, 26, 1}), 8);
    EXPECT_EQ(b.set("OS", {3, 29}), 0);
    EXPECT_EQ(*b.motor.text(Word::OS, b.now), "OS = 1, 17, 1\r\nOS = 2, 16, 0\r\nOS = 3, 29, 0");
    EXPECT_EQ(b.set("O1", 1), 9);
    EXPECT_EQ(b.set("OT", 7), 9);
    EXPECT_EQ(b.set("O2", 1), 0);
    EXPECT_EQ(b.outputs() & 3, 2);
    b.start("MR", 51200);
    EXPECT_EQ(b.outputs() & 3, 3);
    b.set("AO", 16384);
    EXPECT_EQ(b.outputs(), 7);
    b.rest();
    EXPECT_EQ(b.outputs(), 2);
    b.set("AO", 512 + 1);
    EXPECT_EQ(b.outputs(), 6);  // at hold current
    EXPECT_EQ(b.set("OS", {3, 18, 0}), 0);
    b.motor.tell(true, false, b.now);
    EXPECT_EQ(b.outputs(), 6);
    b.motor.tell(false, false, b.now);
    EXPECT_EQ(b.outputs(), 2);
    b.hand("output_fault", std::int64_t{3});
    EXPECT_EQ(b.get("OF"), 3);
    EXPECT_EQ(b.errors(), (Codes{1, 2}));
    MotorBench open({lmdo, 23});
    for (const int hmt_type : {21, 24, 25})
        EXPECT_EQ(open.set("OS", {1, static_cast<double>(hmt_type), 0}), 8);
}

TEST(McodePoints, AnalogInputHasRangesAndARunningAverage) {
    MotorBench b;
    struct Row {
        double sense, range, signal;
        int counts;
    };
    for (const Row& r : {Row{9, 0, 5, 4095}, Row{9, 1, 5, 2048}, Row{10, 0, 20, 4095}, Row{10, 1, 4, 0}, Row{10, 1, 20, 3200},
                         Row{10, 1, 12, 1600}, Row{9, 0, 7, 4095}}) {
        b.set("IS", {5, r.sense, r.range});
        b.hand("analog_signal", r.signal);
        EXPECT_EQ(b.get("I5"), r.counts) << r.sense << r.range << r.signal;
    }
    b.hand("analog", 0.0);
    b.set("D5", 10);
    b.hand("analog", 1000.0);
    double average = 0;
    for (int ms = 1; ms <= 30; ++ms) {
        average = (average * 9 + 1000) / 10;
        b.pass_ms(1);
        ASSERT_EQ(b.get("I5"), std::round(average)) << ms;
    }
}

TEST(McodePoints, TripsFireAtTheirConditionAndOnlySomeCaptureP) {  // trap 12, motor's part
    MotorBench b;
    EXPECT_EQ(b.arm("TC", {}), 12);
    EXPECT_EQ(b.arm("TI", {5}), 21);
    EXPECT_EQ(b.arm("TI", {2}), 0);
    EXPECT_EQ(b.arm("TP", {51200}), 0);
    b.start("SL", 100000);
    b.pass_ms(1000);
    EXPECT_EQ(b.trips(Word::TP), 0);  // not enabled
    b.motor.stop_at_once(b.now);
    b.set("P", 0);
    b.motor.enable_trips(1 | 2, b.now);
    b.start("SL", 100000);
    while (b.trips(Word::TP) == 0 && b.motor.deadline() != never)
        b.pass(b.motor.deadline() - b.now);
    EXPECT_EQ(b.get("P"), 51200);
    b.pass_ms(1000);
    EXPECT_EQ(b.trips(Word::TP), 1);
    EXPECT_EQ(b.get("PC"), 0);
    b.hand("active_inputs", std::int64_t{2});
    EXPECT_EQ(b.trips(Word::TI), 1);
    EXPECT_EQ(b.get("PC"), b.get("P"));
    b.hand("active_inputs", std::int64_t{0});
    EXPECT_EQ(b.trips(Word::TI), 1);
    b.set("IS", {1, 12, 0});
    EXPECT_EQ(b.arm("TC", {}), 0);
    b.motor.enable_trips(4, b.now);
    b.pass_ms(100);
    b.hand("active_inputs", std::int64_t{1});
    EXPECT_EQ(b.trips(Word::TC), 1);
    EXPECT_EQ(b.get("PC"), b.get("P"));
    b.motor.enable_trips(64, b.now);
    b.hand("supply_voltage", 0.0);
    EXPECT_EQ(b.trips(Word::TM), 1);
    EXPECT_EQ(b.get("V"), 0);
}

TEST(McodePoints, RelativeTripsComeEveryDistance) {
    MotorBench b;
    EXPECT_EQ(b.arm("TR", {0}), 21);
    EXPECT_EQ(b.set("OS", {3, 28, 0}), 0);
    b.start("MA", 333);
    b.rest();
    EXPECT_EQ(b.arm("TR", {10000}), 0);
    b.motor.enable_trips(16, b.now);
    EXPECT_EQ(b.arm("TP", {5}), 39);
    b.start("MR", 100500);
    b.rest();
    EXPECT_EQ(b.trips(Word::TR), 10);
    EXPECT_EQ(b.shown("trip_pulses"), Value{std::int64_t{10}});
    b.start("MR", -20000);  // from the last trip at 100333: 90333 and then 80833 is short
    b.rest();
    EXPECT_EQ(b.trips(Word::TR), 11);
    // At most 20 kHz: 768000 trips a second become no more than that.
    EXPECT_EQ(b.arm("TR", {1}), 0);
    b.events.clear();
    b.start("SL", 768000);
    b.pass_ms(1000);
    b.events.clear();
    b.pass_ms(100);
    EXPECT_GT(b.trips(Word::TR), 1500);
    EXPECT_LE(b.trips(Word::TR), 2001);
}

TEST(McodePoints, SupplyAndTemperatureRaiseTheirCodesOnce) {
    MotorBench b;
    EXPECT_EQ(*b.motor.text(Word::VT, b.now), "0, 24, 48");
    b.hand("aux_voltage", 0.0);  // unused: no error
    EXPECT_EQ(*b.motor.text(Word::VT, b.now), "1, 0, 48");
    EXPECT_EQ(b.errors(), Codes{});
    b.hand("aux_voltage", 40.0);
    EXPECT_EQ(b.errors(), (Codes{78}));
    b.hand("supply_voltage", 70.0);
    EXPECT_EQ(b.errors(), (Codes{79}));
    EXPECT_EQ(*b.motor.text(Word::VT, b.now), "3, 40, 70");
    b.hand("supply_voltage", 48.0);
    b.hand("aux_voltage", 24.0);
    EXPECT_EQ(b.errors(), Codes{});
    EXPECT_EQ(*b.motor.text(Word::IT, b.now), "25, 27");
    b.hand("controller_temperature", 81.0);
    b.hand("temperature", 82.0);
    EXPECT_EQ(b.errors(), (Codes{71}));
    EXPECT_EQ(b.start("MR", 1000000), 0);  // a warning
    b.pass_ms(500);
    b.hand("temperature", 90.0);
    EXPECT_EQ(b.errors(), (Codes{72}));
    EXPECT_EQ(b.get("DE"), 0);
    EXPECT_EQ(b.get("MV"), 0);
    EXPECT_EQ(b.set("DE", 1), 72);
    b.hand("temperature", 60.0);
    b.hand("controller_temperature", 60.0);
    EXPECT_EQ(b.set("DE", 1), 0);
    EXPECT_EQ(b.set("WT", 50), 0);
    EXPECT_EQ(b.errors(), (Codes{71}));
    MotorBench module({lmm, 23});
    EXPECT_EQ(*module.motor.text(Word::VT, module.now), "1, 48");
    module.start("SL", 100000);
    module.hand("enable_input", false);
    EXPECT_EQ(module.errors(), (Codes{14}));
    EXPECT_EQ(module.get("MV"), 0);
    EXPECT_EQ(module.start("MR", 1), 94);
    module.hand("enable_input", true);
    EXPECT_EQ(module.start("MR", 1), 0);
}

TEST(McodePoints, CurrentsFollowMotionAndDelays) {
    MotorBench b;
    EXPECT_EQ(b.shown("current"), Value{std::int64_t{5}});
    b.start("MR", 100);
    EXPECT_EQ(b.shown("current"), Value{std::int64_t{25}});
    b.pass_ms(900);
    EXPECT_EQ(b.shown("current"), Value{std::int64_t{25}});
    b.rest();
    EXPECT_EQ(b.shown("current"), Value{std::int64_t{5}});
    b.set("HC", 0);
    EXPECT_EQ(b.shown("current"), Value{std::int64_t{25}});  // E-24
    b.set("DE", 0);
    EXPECT_EQ(b.shown("current"), Value{std::int64_t{0}});
}

TEST(McodePoints, SavedWordsComeBackAndStatesDoNot) {
    MotorBench b;
    b.set("VM", 400000);
    b.set("MS", 128);
    b.set("LM", 3);
    b.set("IS", {2, 2, 1});
    b.set("OS", {1, 17, 1});
    b.set("LS", {1, 777, 1});
    b.set("FS", 123);
    b.start("MR", 500);
    b.rest();
    NonVolatile m;
    b.motor.save(m);
    EXPECT_FALSE(m.contains("P"));
    b.motor.factory(b.now);
    EXPECT_EQ(b.get("VM"), 768000);
    EXPECT_EQ(b.get("FS"), 123);  // outlives FD
    b.motor.restart(b.now);
    b.motor.factory(b.now);
    EXPECT_EQ(b.get("P"), 0);
    b.motor.load(m, b.now);
    EXPECT_EQ(b.get("VM"), 200000);
    EXPECT_EQ(b.get("MS"), 128);
    EXPECT_EQ(b.get("LM"), 3);
    EXPECT_EQ(b.get("FS"), 123);
    EXPECT_EQ(b.get("P"), 0);
    EXPECT_NE(b.motor.text(Word::IS, b.now)->find("IS = 2, 2, 1\r\n"), std::string::npos);
    EXPECT_EQ(*b.motor.text(Word::LS, b.now), "LS=0, 0, 0\r\nLS=1, 777, 1");
    NonVolatile again;
    b.motor.save(again);
    EXPECT_EQ(m, again);
}

TEST(McodePoints, EveryHandItemIsSaidAndBadValuesAreRefused) {
    MotorBench b;
    for (const HandItem& i : b.motor.hand(b.now)) {
        EXPECT_FALSE(i.description.empty()) << i.name;
        EXPECT_TRUE(known(i.value)) << i.name;
        const auto fault = b.motor.set_hand(i.name, Value{std::string("nonsense")}, b.now);
        ASSERT_TRUE(fault.has_value()) << i.name;
        EXPECT_FALSE(fault->empty()) << i.name;
    }
    EXPECT_FALSE(b.motor.set_hand("nothing", Value{true}, b.now).has_value());
    EXPECT_NE(*b.motor.set_hand("home_switch", Value{true}, b.now), "");  // no input of that type
}

/// A switch is shown as it is: at an input by its input, beside the axis by where the shaft stands, also before IS gives it an input.
TEST(McodePoints, TheHandShowsTheHomeSwitchAsItIs) {
    MotorBench b;
    const auto closed = [&] { return as_flag(b.shown("home_switch")).value_or(false); };
    EXPECT_FALSE(closed());
    b.hand("home_position", 1.0);
    EXPECT_FALSE(closed());
    ASSERT_EQ(b.start("MA", 51200 * 1.02), 0);
    b.rest();
    EXPECT_TRUE(closed());
    ASSERT_EQ(b.start("MA", 0), 0);
    b.rest();
    EXPECT_FALSE(closed());
    b.hand("home_position", std::string("none"));
    ASSERT_EQ(b.set("IS", {1, 1, 0}), 0);
    b.hand("home_switch", true);
    EXPECT_TRUE(closed());
    EXPECT_EQ(b.get("I1"), 1);
    b.hand("home_switch", false);
    EXPECT_FALSE(closed());
    EXPECT_EQ(b.get("I1"), 0);
}

}  // namespace
}  // namespace axisgate::mcode::twin::test
