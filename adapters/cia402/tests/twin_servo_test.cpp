// The simulated CiA 402 drive on the bus: recorded frames, power states, modes, homing, faults, PDOs, memory.
#include <sstream>

#include "adapters/cia402/tests/twin_bench.hpp"
#include "adapters/cia402/twin/homing.hpp"

namespace axisgate::cia402_drive::twin::test {
namespace {
using namespace std::chrono_literals;
using canopen::Abort;

TEST(Cia402Twin, AnswersAsTheVectorsSay) { EXPECT_GE(Bench().answers_of_vectors("cia402"), 12u); }

TEST(Cia402Twin, StatesFollowTheControlWord) {
    Bench b;
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "switch on disabled";
    b.word(0x0F);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "not from here";
    b.word(0x06);
    EXPECT_EQ(b.status() & 0x6Fu, 0x21u);
    b.word(0x07);
    EXPECT_EQ(b.status() & 0x6Fu, 0x23u);
    b.word(0x0F);
    EXPECT_EQ(b.status() & 0x6Fu, 0x27u);
    b.word(0x06);
    EXPECT_EQ(b.status() & 0x6Fu, 0x21u) << "transition 8";
    b.word(0x0F);
    b.word(0x02);
    b.pass(1ms);
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u) << "a quick stop by 605Ah = 2 ends off";
    ASSERT_EQ(b.write(0x605A, 0, 6, 2), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), 5000);
    b.word(0x0B);
    EXPECT_EQ(b.status() & 0x6Fu, 0x07u);
    b.pass(100ms);
    EXPECT_EQ(b.read(0x606C), 0);
    EXPECT_EQ(b.status() & 0x6Fu, 0x07u) << "and stays";
}

TEST(Cia402Twin, APositionIsReachedAndAcknowledgedAndHaltedWithoutBeingForgotten) {
    Bench b;
    b.enable(1);
    ASSERT_EQ(b.write(0x607A, 0, 10'000, 4), Abort::none);
    b.word(0x1F);
    EXPECT_NE(b.status() & 0x1000u, 0u) << "set-point acknowledged";
    EXPECT_EQ(b.status() & 0x400u, 0u);
    b.word(0x0F);
    EXPECT_EQ(b.status() & 0x1000u, 0u);
    b.pass(500ms);
    b.word(0x10F);
    b.pass(2s);
    const auto there = b.read(0x6064);
    EXPECT_GT(there, 1000);
    EXPECT_LT(there, 9000);
    EXPECT_NE(b.status() & 0x400u, 0u) << "halted: bit 10 says that it stands";
    b.word(0x0F);
    b.pass(3s);
    EXPECT_EQ(b.read(0x6064), 10'000);
    EXPECT_NE(b.status() & 0x400u, 0u);
    // Buffered: the second set-point waits for the first.
    ASSERT_EQ(b.write(0x607A, 0, 20'000, 4), Abort::none);
    b.word(0x1F), b.word(0x0F);
    ASSERT_EQ(b.write(0x607A, 0, 5'000, 4), Abort::none);
    b.word(0x1F);
    EXPECT_NE(b.status() & 0x1000u, 0u);
    b.word(0x0F);
    b.pass(1s);
    EXPECT_GT(b.read(0x6064), 15'000) << "goes on to the first";
    b.pass(6s);
    EXPECT_EQ(b.read(0x6064), 5'000);
}

TEST(Cia402Twin, LimitsOfPositionHold) {
    Bench b;
    ASSERT_EQ(b.write(0x607D, 1, -1000, 4), Abort::none);
    ASSERT_EQ(b.write(0x607D, 2, 1000, 4), Abort::none);
    b.enable(1);
    ASSERT_EQ(b.write(0x607A, 0, 5'000, 4), Abort::none);
    b.word(0x1F);
    b.pass(3s);
    EXPECT_EQ(b.read(0x6064), 1000);
    EXPECT_NE(b.status() & 0x800u, 0u);
    b.word(0x0F);
    ASSERT_EQ(b.write(0x60FF, 0, -3000, 4), Abort::none);
    ASSERT_EQ(b.write(0x6060, 0, 3, 1), Abort::none);
    b.pass(5s);
    EXPECT_EQ(b.read(0x6064), -1000);
}

TEST(Cia402Twin, HomingFindsItsPlaceOrSaysThatThereIsNone) {
    Bench without;
    without.enable(6);
    ASSERT_EQ(without.write(0x6098, 0, 17, 1), Abort::none);
    without.word(0x1F);
    EXPECT_NE(without.status() & 0x2000u, 0u) << "no switch: homing error";
    EXPECT_EQ(without.write(0x6098, 0, 99, 1), Abort::value);
    for (const auto& [method, place] : {std::pair{17, -20'000.0}, {18, 20'000.0}, {19, 0.0}, {33, -4096.0}, {34, 4096.0}}) {
        SCOPED_TRACE(method);
        Bench b(Bench::Options{{"travel", "20000"}});
        b.enable(6);
        ASSERT_EQ(b.write(0x6098, 0, method, 1), Abort::none);
        ASSERT_EQ(b.write(0x607C, 0, 250, 4), Abort::none);
        b.word(0x1F);
        if (method != 19) EXPECT_EQ(b.status() & 0x3000u, 0u) << "on its way";
        b.pass(60s);
        EXPECT_NE(b.status() & 0x1000u, 0u);
        EXPECT_EQ(b.read(0x6064), 250) << "the zero is called 607Ch";
        EXPECT_NEAR(b.twin->mechanics(1, b.now).position, place, 1);
    }
}

/// The zero position of each homing method (CiA 402-2). Limit switches at -20'000 and 20'000, an index pulse every 4096, the home switch
/// with its edge at 0 or as a cam from -1024 to 1024.
TEST(Cia402Twin, EachHomingMethodHasItsOwnPlace) {
    const std::map<int, double> places{{1, -16'384},  {2, 16'384},  {3, -4096}, {4, 4096},  {5, 4096},  {6, -4096},  {7, -4096},
                                       {8, 0},        {9, 0},       {10, 4096}, {11, 4096}, {12, 0},    {13, 0},     {14, -4096},
                                       {17, -20'000}, {18, 20'000}, {19, 0},    {20, 0},    {21, 0},    {22, 0},     {23, -1024},
                                       {24, -1024},   {25, 1024},   {26, 1024}, {27, 1024}, {28, 1024}, {29, -1024}, {30, -1024},
                                       {33, -4096},   {34, 4096},   {35, 0},    {37, 0}};
    Bench list;
    ASSERT_EQ(static_cast<std::size_t>(list.read(0x60E3)), places.size());
    std::uint8_t sub = 0;
    for (const auto& [method, place] : places) {
        SCOPED_TRACE(method);
        EXPECT_EQ(list.read(0x60E3, ++sub), method);
        Bench b(Bench::Options{{"travel", "20000"}});
        b.enable(6);
        ASSERT_EQ(b.write(0x6098, 0, method, 1), Abort::none);
        b.word(0x1F);
        b.pass(60s);
        EXPECT_EQ(b.status() & 0x3400u, 0x1400u) << "attained";
        EXPECT_NEAR(b.twin->mechanics(1, b.now).position, place, 0.01);
        EXPECT_EQ(b.read(0x6064), 0);
        if (method >= 33) continue;
        Bench without;
        without.enable(6);
        ASSERT_EQ(without.write(0x6098, 0, method, 1), Abort::none);
        without.word(0x1F);
        EXPECT_NE(without.status() & 0x2000u, 0u) << "no switch: homing error";
    }
    for (const int unknown : {0, 15, 16, 31, 32, 36, -1})
        EXPECT_EQ(list.write(0x6098, 0, unknown, 1), Abort::value) << unknown;
}

TEST(Cia402Twin, ACamThatLiesBehindIsFoundByWayOfTheLimitSwitch) {
    const HomingWay on_the_way = homing_way(9, -5000, 20'000), behind = homing_way(9, 5000, 20'000);
    EXPECT_EQ(on_the_way.search, (std::vector<double>{1024}));
    EXPECT_EQ(behind.search, (std::vector<double>{20'000, 1024}));
    EXPECT_EQ(homing_way(13, -5000, 20'000).search, (std::vector<double>{-20'000, -1024}));
    EXPECT_EQ(behind.zero, on_the_way.zero);
}

TEST(Cia402Twin, CyclicModesFollowTheirTargetsAtTheSync) {
    Bench b;
    canopen::Pdo target;
    target.direction = canopen::PdoDirection::receive;
    target.settings = {.id = 0x205, .valid = true, .transmission = 1};
    target.mapping = {{{0x607A, 0}, 32}};
    for (const auto& w : canopen::writes_of(target))
        ASSERT_EQ(b.write(w.address.index, w.address.sub, static_cast<std::int64_t>(canopen::low_first(w.bytes)),
                          static_cast<int>(w.bytes.size())),
                  Abort::none);
    ASSERT_EQ(b.write(0x60C2, 1, 10, 1), Abort::none);
    b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
    b.enable(8);
    for (int i = 1; i <= 100; ++i) {
        const std::array<std::uint8_t, 4> bytes{static_cast<std::uint8_t>(i * 10), static_cast<std::uint8_t>(i * 10 >> 8), 0, 0};
        b.send(canopen::data_frame(0x205, bytes));
        const double before = b.twin->mechanics(1, b.now).position;
        EXPECT_EQ(before, b.twin->mechanics(1, b.now).position) << "not before the SYNC";
        b.send(canopen::data_frame(0x80, {}));
        b.pass(5ms);
        EXPECT_NEAR(b.twin->mechanics(1, b.now).position, (i - 1) * 10 + 5, 0.01) << "half way after half the period";
        b.pass(5ms);
    }
    b.pass(10ms);
    EXPECT_EQ(b.read(0x6064), 1000);
    EXPECT_EQ(b.read(0x606C), 0);
    // A PDO that is too short is reported by EMCY 8210h and ignored.
    b.out.clear();
    b.send(canopen::data_frame(0x205, std::array<std::uint8_t, 2>{1, 2}));
    ASSERT_EQ(b.count(0x85), 1u);
    EXPECT_EQ(canopen::low_first(b.out.frames[0].frame.data().first(2)), 0x8210u);
    // Torque: 1/1000 of the rated torque gives 50 increments/s2.
    ASSERT_EQ(b.write(0x6071, 0, 100, 2), Abort::none);
    ASSERT_EQ(b.write(0x6060, 0, 10, 1), Abort::none);
    b.pass(1s);
    EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 5000, 1);
}

TEST(Cia402Twin, AHeldShaftIsAFollowingErrorAtTheSameInstantHoweverLateItIsAsked) {
    std::vector<Instant> reported;
    for (const Duration step : {1ms, 5000ms}) {
        Bench b;
        b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
        b.enable(3);
        ASSERT_EQ(b.write(0x60FF, 0, 4000, 4), Abort::none);
        b.pass(1s);
        ASSERT_EQ(b.twin->set_hand("stall", Value{true}, b.now, b.out), "");
        b.out.clear();
        for (Duration d{}; d < 5s; d += step)
            b.pass(step);
        ASSERT_EQ(b.count(0x85), 1u);
        for (const auto& tx : b.out.frames)
            if (tx.frame.id == 0x85) reported.push_back(tx.frame.at);
        EXPECT_EQ(b.status() & 0x4Fu, 0x08u);
        EXPECT_EQ(b.read(0x603F) & 0xFFFF, 0x8611);
        EXPECT_EQ(b.read(0x1001), 0x11);
        b.word(0x0F);
        EXPECT_EQ(b.status() & 0x4Fu, 0x08u) << "a fault is left by a reset alone";
        b.word(0x80);
        EXPECT_EQ(b.status() & 0x6Fu, 0x40u);
        EXPECT_EQ(b.read(0x603F), 0);
    }
    EXPECT_EQ(reported[0], reported[1]);
}

TEST(Cia402Twin, HeartbeatBootUpAndMemory) {
    Bench b;
    ASSERT_EQ(b.out.frames.size(), 1u);
    EXPECT_EQ(to_text(b.out.frames[0].frame), "705#00");
    ASSERT_EQ(b.write(0x1017, 0, 100, 2), Abort::none);
    b.out.clear();
    b.pass(1s);
    EXPECT_EQ(b.count(0x705), 10u);
    EXPECT_EQ(b.out.frames[0].frame.at, b.now - 900ms);
    ASSERT_EQ(b.write(0x6081, 0, 777, 4), Abort::none);
    EXPECT_TRUE(b.twin->non_volatile().empty()) << "not before it is saved";
    ASSERT_EQ(b.write(0x1010, 1, 0x65766173, 4), Abort::none);
    EXPECT_EQ(b.twin->non_volatile().size(), 2u);
    ASSERT_EQ(b.write(0x6081, 0, 888, 4), Abort::none);
    b.send(canopen::nmt_frame(canopen::NmtCommand::reset_node, 5));
    EXPECT_EQ(b.read(0x6081), 777);
    Bench again({}, nullptr, b.twin->non_volatile());
    EXPECT_EQ(again.read(0x6081), 777);
    ASSERT_EQ(again.write(0x1011, 1, 0x64616F6C, 4), Abort::none);
    EXPECT_EQ(again.read(0x6081), 777) << "not before the reset";
    again.send(canopen::nmt_frame(canopen::NmtCommand::reset_node, 5));
    EXPECT_EQ(again.read(0x6081), 10'000);
    EXPECT_TRUE(again.twin->non_volatile().empty());
}

TEST(Cia402Twin, ATouchProbeKeepsThePlaceOfTheEdge) {
    Bench b;
    ASSERT_EQ(b.write(0x60B8, 0, 0x11, 2), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 1000, 4), Abort::none);
    b.pass(2s);
    const auto here = b.read(0x6064);
    ASSERT_EQ(b.twin->set_hand("inputs", Value{std::int64_t{1}}, b.now, b.out), "");
    b.pass(1s);
    EXPECT_EQ(b.read(0x60BA), here);
    EXPECT_EQ(b.read(0x60B9), 3);
    EXPECT_EQ(b.read(0x60FD), 0x10000);
}

TEST(Cia402Twin, TwoTouchProbesKeepBothEdgesEachByItsByte) {
    Bench b;
    ASSERT_EQ(b.write(0x60B8, 0, 0x3131, 2), Abort::none) << "both probes, both edges, the first time";
    EXPECT_EQ(b.read(0x60B9), 0x0101);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 1000, 4), Abort::none);
    const auto at_level = [&](std::int64_t inputs) {
        b.pass(1s);
        const auto here = b.read(0x6064);
        EXPECT_EQ(b.twin->set_hand("inputs", Value{inputs}, b.now, b.out), "");
        return here;
    };
    const auto first_up = at_level(1), second_up = at_level(3), second_down = at_level(1), first_down = at_level(0);
    EXPECT_EQ(b.read(0x60BA), first_up);
    EXPECT_EQ(b.read(0x60BB), first_down);
    EXPECT_EQ(b.read(0x60BC), second_up);
    EXPECT_EQ(b.read(0x60BD), second_down);
    EXPECT_EQ(b.read(0x60B9), 0x0707);
    (void)at_level(3);
    EXPECT_EQ(b.read(0x60BA), first_up) << "once";
    ASSERT_EQ(b.write(0x60B8, 0, 0x3133, 2), Abort::none) << "probe 1 again and again; probe 2 as it was";
    EXPECT_EQ(b.read(0x60B9), 0x0701);
    (void)at_level(0);
    const auto again = at_level(1);
    (void)at_level(0);
    const auto last = at_level(1);
    EXPECT_GT(last, again);
    EXPECT_EQ(b.read(0x60BA), last);
    EXPECT_EQ(b.read(0x60BC), second_up);
}

TEST(Cia402Twin, UserUnitsAreWhatTheFactorsSay) {
    Bench b;
    // 4096 increments per motor revolution, gear 2:1, 10 units per revolution of the load: 819.2 increments per unit; speeds in units per
    // minute.
    const struct {
        std::uint16_t index;
        std::int64_t over, under;
    } factors[] = {{0x608F, 4096, 1}, {0x6091, 2, 1}, {0x6092, 10, 1}, {0x6096, 1, 60}};
    for (const auto& f : factors) {
        ASSERT_EQ(b.write(f.index, 1, f.over, 4), Abort::none);
        ASSERT_EQ(b.write(f.index, 2, f.under, 4), Abort::none);
    }
    ASSERT_EQ(b.write(0x6081, 0, 6000, 4), Abort::none) << "100 units/s";
    ASSERT_EQ(b.write(0x6083, 0, 1000, 4), Abort::none);
    ASSERT_EQ(b.write(0x6084, 0, 1000, 4), Abort::none);
    b.enable(1);
    EXPECT_EQ(b.write(0x6092, 1, 20, 4), Abort::device_state) << "not while it is led by them";
    ASSERT_EQ(b.write(0x607A, 0, 500, 4), Abort::none);
    b.word(0x1F);
    b.pass(2s);
    EXPECT_EQ(b.read(0x606C), 6000);
    EXPECT_NEAR(b.twin->mechanics(1, b.now).velocity, 81'920, 1);
    b.pass(8s);
    EXPECT_EQ(b.read(0x6064), 500);
    EXPECT_EQ(b.read(0x6063), 409'600);
    EXPECT_NE(b.status() & 0x400u, 0u);
}

TEST(Cia402Twin, EachOptionCodeHasItsRampAndItsState) {
    struct Case {
        const char* what;
        std::uint16_t index;
        int option;
        unsigned word;       // the control word that stops it
        std::int64_t after;  // its speed after 50 ms, from 10'000
        unsigned state;      // its state at the end
    };
    // 6084h 20'000/s2, 6085h 100'000/s2, 60C6h 160'000/s2: stops in 1/2 s, 1/10 s and 1/16 s.
    constexpr Case cases[] = {
        {"disabled: coasts", 0x605A, 0, 0x0B, 0, 0x40},      {"slow down", 0x605A, 1, 0x0B, 9000, 0x40},
        {"quick stop ramp", 0x605A, 2, 0x0B, 5000, 0x40},    {"by current", 0x605A, 3, 0x0B, 2000, 0x40},
        {"slow down, stays", 0x605A, 5, 0x0B, 9000, 0x07},   {"quick stop, stays", 0x605A, 6, 0x0B, 5000, 0x07},
        {"current, stays", 0x605A, 7, 0x0B, 2000, 0x07},     {"shutdown coasts", 0x605B, 0, 0x06, 0, 0x21},
        {"shutdown by ramp", 0x605B, 1, 0x06, 9000, 0x21},   {"disable by ramp", 0x605C, 1, 0x07, 9000, 0x23},
        {"halt by ramp", 0x605D, 1, 0x10F, 9000, 0x27},      {"halt as a quick stop", 0x605D, 2, 0x10F, 5000, 0x27},
        {"halt by current", 0x605D, 3, 0x10F, 2000, 0x27},   {"fault by ramp", 0x605E, 1, 0, 9000, 0x08},
        {"fault as a quick stop", 0x605E, 2, 0, 5000, 0x08},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.what);
        Bench b;
        for (const auto& [index, rate] : {std::pair{0x6084, 20'000}, {0x6085, 100'000}, {0x60C6, 160'000}})
            ASSERT_EQ(b.write(static_cast<std::uint16_t>(index), 0, rate, 4), Abort::none);
        ASSERT_EQ(b.write(c.index, 0, c.option, 2), Abort::none);
        b.enable(3);
        ASSERT_EQ(b.write(0x60FF, 0, 10'000, 4), Abort::none);
        b.pass(5s);
        ASSERT_EQ(b.read(0x606C), 10'000);
        if (c.word == 0) {
            ASSERT_EQ(b.twin->set_hand("inject_error", Value{std::int64_t{0x4210}}, b.now, b.out), "");
            EXPECT_EQ(b.status() & 0x4Fu, 0x0Fu) << "fault reaction active";
        } else {
            b.word(c.word);
        }
        b.pass(50ms);
        if (c.after > 0) {
            EXPECT_NEAR(static_cast<double>(b.read(0x606C)), static_cast<double>(c.after), 2);
        } else {
            EXPECT_EQ(b.status() & 0x6Fu, c.state) << "at once";
        }
        b.pass(2s);
        EXPECT_EQ(b.read(0x606C), 0);
        EXPECT_EQ(b.status() & (c.state == 0x08 ? 0x4Fu : 0x6Fu), c.state);
    }
}

TEST(Cia402Twin, ATargetIsReachedAfterItsTimeInTheWindow) {
    Bench b;
    ASSERT_EQ(b.write(0x6068, 0, 300, 2), Abort::none);
    b.enable(1);
    ASSERT_EQ(b.write(0x6081, 0, 10'000, 4), Abort::none);
    ASSERT_EQ(b.write(0x607A, 0, 10'000, 4), Abort::none);
    b.word(0x1F);
    b.pass(1250ms);  // 10'000 at 10'000/s, 200 ms for each ramp: 1.2 s
    EXPECT_EQ(b.read(0x6064), 10'000);
    EXPECT_EQ(b.status() & 0x400u, 0u) << "it is there, and not for 300 ms yet";
    b.pass(200ms);
    EXPECT_EQ(b.status() & 0x400u, 0u);
    b.pass(100ms);
    EXPECT_NE(b.status() & 0x400u, 0u);
}

TEST(Cia402Twin, TheOlderModesOfTorqueAndInterpolationAreThere) {
    Bench b;
    b.enable(4);
    ASSERT_EQ(b.write(0x6071, 0, 100, 2), Abort::none);
    b.pass(1s);
    EXPECT_NEAR(static_cast<double>(b.read(0x606C)), 5000, 1);
    EXPECT_EQ(b.read(0x6077), 100);
    Bench i;
    ASSERT_EQ(i.write(0x60C2, 1, 10, 1), Abort::none);
    i.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
    i.enable(7);
    for (int k = 1; k <= 20; ++k) {
        ASSERT_EQ(i.write(0x60C1, 1, 50 * k, 4), Abort::none);
        if (k == 11) i.word(0x1F);  // bit 4: interpolation is on
        i.send(canopen::data_frame(0x80, {}));
        i.pass(10ms);
        if (k == 10) EXPECT_EQ(i.read(0x6064), 0) << "not before bit 4";
    }
    EXPECT_EQ(i.read(0x6064), 1000);
}

TEST(Cia402Twin, StopsByItselfWhenTheHeartbeatThatItWatchesStops) {
    struct Case {
        int option;  // 6007h
        unsigned state;
        bool moves;
    };
    for (const Case c : {Case{0, 0x27, true}, Case{1, 0x08, false}, Case{2, 0x40, false}, Case{3, 0x07, false}}) {
        SCOPED_TRACE(c.option);
        Bench b;
        b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
        ASSERT_EQ(b.write(0x605A, 0, 6, 2), Abort::none);
        ASSERT_EQ(b.write(0x6007, 0, c.option, 2), Abort::none);
        ASSERT_EQ(b.write(0x1016, 1, 0x007F'012C, 4), Abort::none);  // node 127, 300 ms
        b.enable(3);
        ASSERT_EQ(b.write(0x60FF, 0, 10'000, 4), Abort::none);
        b.pass(2s);
        ASSERT_EQ(b.read(0x606C), 10'000) << "the watch begins with the first heartbeat";
        for (int i = 0; i < 10; ++i) {
            b.send(canopen::heartbeat_frame(127, canopen::NmtState::operational));
            b.send(canopen::heartbeat_frame(126, canopen::NmtState::operational));
            b.pass(100ms);
        }
        ASSERT_EQ(b.read(0x606C), 10'000);
        b.out.clear();
        b.send(canopen::heartbeat_frame(126, canopen::NmtState::operational));  // the heartbeat of another node has no effect
        b.pass(199ms);
        EXPECT_EQ(b.count(0x85), 0u) << "300 ms are not over";
        b.pass(1ms);
        EXPECT_EQ(b.count(0x85), 1u) << "EMCY, and once";
        b.pass(3s);
        EXPECT_EQ(b.count(0x85), 1u);
        EXPECT_EQ(b.read(0x606C) != 0, c.moves);
        EXPECT_EQ(b.status() & (c.state == 0x08 ? 0x4Fu : 0x6Fu), c.state);
        // Outside the operational state, until NMT start: no PDO after a SYNC.
        ASSERT_EQ(b.write(0x1800, 2, 1, 1), Abort::none);
        b.out.clear();
        b.send(canopen::data_frame(0x80, {}));
        EXPECT_EQ(b.count(0x185), 0u);
        b.send(canopen::nmt_frame(canopen::NmtCommand::start, 5));
        b.send(canopen::data_frame(0x80, {}));
        EXPECT_EQ(b.count(0x185), 1u);
    }
}

TEST(Cia402Twin, AWatchThatIsTakenBackIsNoWatch) {
    Bench b;
    ASSERT_EQ(b.write(0x6007, 0, 3, 2), Abort::none);
    ASSERT_EQ(b.write(0x1016, 1, 0x007F'012C, 4), Abort::none);
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 10'000, 4), Abort::none);
    b.send(canopen::heartbeat_frame(127, canopen::NmtState::operational));
    b.pass(200ms);
    ASSERT_EQ(b.write(0x1016, 1, 0, 4), Abort::none);
    b.pass(5s);
    EXPECT_EQ(b.read(0x606C), 10'000);
}

TEST(Cia402Twin, OutputsAreWhatTheMaskLetsThrough) {
    Bench b(Bench::Options{{"travel", "5000"}});
    EXPECT_EQ(b.read(0x60FD), 4) << "it stands on the home switch";
    ASSERT_EQ(b.write(0x60FE, 1, 0x50000, 4), Abort::none);
    const auto outputs = [&] {
        for (const auto& item : b.twin->hand())
            if (item.name == "outputs") return as_integer(item.value).value_or(-1);
        return std::int64_t{-1};
    };
    EXPECT_EQ(outputs(), 0);
    ASSERT_EQ(b.write(0x60FE, 2, 0x10000, 4), Abort::none);
    EXPECT_EQ(outputs(), 0x10000);
}

TEST(Cia402Twin, WithoutSafeVoltageTheShaftRunsDownAndNoWordSwitchesItOn) {
    Bench b;
    b.enable(3);
    ASSERT_EQ(b.write(0x60FF, 0, 5000, 4), Abort::none);
    b.pass(1s);
    EXPECT_NE(b.status() & 0x10u, 0u);
    Out out;
    ASSERT_EQ(b.twin->set_hand("safe_voltage_enable", Value{false}, b.now, out), "");
    EXPECT_EQ(b.status() & 0x7Fu, 0x40u) << "switch on disabled, and bit 4 is 0";
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), 0);
    for (const int word : {0x06, 0x07, 0x0F})
        b.word(static_cast<std::uint16_t>(word));
    EXPECT_EQ(b.status() & 0x6Fu, 0x40u);
    ASSERT_EQ(b.twin->set_hand("safe_voltage_enable", Value{true}, b.now, out), "");
    EXPECT_EQ(b.status() & 0x7Fu, 0x50u) << "nothing comes back by itself";
    b.pass(1s);
    EXPECT_EQ(b.read(0x606C), 0);
    b.enable(3);
}

}  // namespace
}  // namespace axisgate::cia402_drive::twin::test
