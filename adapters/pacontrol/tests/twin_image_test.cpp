// The Profibus and Interbus images against the twin's control: handshake, low-active bits, formats, modules, axis interfaces.
#include "adapters/pacontrol/tests/twin_image_bench.hpp"

#include <fstream>
#include <sstream>

namespace axisgate::pacontrol::twin {
namespace {
using Bytes = std::vector<std::uint8_t>;

TEST(PacontrolImage, LengthsAreThoseOfTheModules) {
    EXPECT_EQ(ImageShape{}.bytes(), 8u);
    for (std::size_t n = 0; n <= 8; ++n)
        EXPECT_EQ(with_modules(n).bytes(), 16 + 12 * n);
    EXPECT_EQ(with_modules(9).bytes(), 112u);
    Rig r;
    const Bytes before = r.out;
    const Bytes wrong(7, 0xFF);
    const auto o = r.image.exchange(r.control, wrong, r.now + 10ms);
    EXPECT_EQ(Bytes(o.begin(), o.end()), before) << "an image of another length changes nothing";
}

TEST(PacontrolImage, TheWorkedExchangeByteForByte) {
    Rig r;
    r.control.set_input(5, true, r.now);
    r.control.set_n(2, 12345678);
    r.control.set_r(1, 640.0F);
    const std::pair<Bytes, Bytes> steps[] = {{{0, 0, 0, 0, 0, 5, 0x99, 0}, {0, 0, 0, 1, 0, 1, 0xA0, 0}},
                                             {{0, 0, 0, 0, 0, 2, 0x19, 6}, {0, 0xBC, 0x61, 0x4E, 0, 1, 0x20, 0}},
                                             {{0, 0, 1, 0x4D, 0, 3, 0x89, 6}, {0, 0, 1, 0x4D, 0, 1, 0xA0, 0}},
                                             {{0, 0, 0, 0, 0, 1, 0x19, 7}, {0x44, 0x20, 0, 0, 0, 1, 0x20, 0}}};
    for (const auto& [in, out] : steps) {
        r.in = in;
        r.in[6] ^= 0x80;
        const Bytes before = r.out;
        r.cycle();
        EXPECT_EQ(r.out, before) << "filled in, not toggled yet";
        r.in = in;
        r.cycle();
        EXPECT_EQ(r.out, out);
    }
    EXPECT_EQ(r.control.signals().elements().n.get(3), 333);
}

TEST(PacontrolImage, OnlyTheToggleIsACommand) {  // T-08
    Rig r;
    EXPECT_EQ(r.command(0x0906, 7, 11), 0x2000u);
    r.put(0, 99, 4);
    r.run(50ms);
    EXPECT_EQ(r.control.signals().elements().n.get(7), 11) << "data without a toggle";
    r.put(4, 8, 2);
    r.run(50ms);
    EXPECT_EQ(r.control.signals().elements().n.get(8), 0) << "another parameter without a toggle";
    EXPECT_EQ(r.command(0x0906, 8, 99), 0x2000u);
    EXPECT_EQ(r.control.signals().elements().n.get(8), 99) << "the falling edge is one too";
    EXPECT_EQ(r.command(0x0A99, 1), 0x4013u) << "KF, the number, and no BF";
    EXPECT_EQ(r.command(0x0700, 0x7F, 1), 0x4022u);
}

TEST(PacontrolImage, WordCommandsTakeAnElement) {  // T-09, T-10
    Rig r;
    EXPECT_EQ(r.command(0x0905, 17, 0x45F2), 0x2000u);
    EXPECT_EQ(r.get(0, 4), 0x45F2u);
    for (int n = 17; n <= 32; ++n)
        EXPECT_EQ(r.control.signals().elements().flags.get(n), n == 18 || (n >= 21 && n <= 25) || n == 27 || n == 31) << n;
    r.command(0x0905, 32, 0);
    r.command(0x1905, 17);
    EXPECT_EQ(r.get(0, 4), 0u) << "replaced, not added";
    r.control.set_input(1, true, r.now);  // and input 16, the external stop, has power
    r.control.set_input(17, true, r.now);
    r.control.set_input(18, true, r.now);
    for (const auto& [n, w] : {std::pair{10, 0x8001u}, {16, 0x8001u}, {17, 3u}, {32, 3u}}) {
        r.command(0x1901, static_cast<std::uint16_t>(n));
        EXPECT_EQ(r.get(0, 4), w) << n;
    }
}

TEST(PacontrolImage, LowActiveBitsOfCtrl) {  // T-14
    Rig r(with_modules(0));
    EXPECT_EQ(r.get(8, 2), 0x0003u) << "ready, battery";
    r.ctrl(0x0017);
    r.run(100ms);
    EXPECT_EQ(r.control.status(), 31);
    EXPECT_EQ(r.get(8, 2), 0x0403u);
    r.ctrl(0x0007);
    r.run(100ms);
    EXPECT_EQ(r.control.status(), 31) << "0007h idles";
    r.ctrl(0x0005);
    r.run(100ms);
    EXPECT_EQ(r.control.status(), 35);
    EXPECT_EQ(r.get(8, 2), 0x0803u);
    r.ctrl(0x0007);
    r.run(50ms);
    EXPECT_EQ(r.control.status(), 35) << "it takes a start to go on";
    r.ctrl(0x0017);
    r.run(50ms);
    EXPECT_EQ(r.control.status(), 31);
    r.ctrl(0x0000);
    r.run(100ms);
    EXPECT_EQ(r.control.status(), 1) << "all zero cancels";
    r.ctrl(0x0018);
    r.run(100ms);
    EXPECT_EQ(r.control.status(), 1) << "no start while stop and cancel are demanded";
}

TEST(PacontrolImage, AStartBitHeldStartsOnceAndErrorsAreShown) {
    Rig r(with_modules(0));
    r.ctrl(0x0017);
    r.run(100ms);
    EXPECT_EQ(r.command(0x0A81, 0) & 0x4000u, 0u);
    r.run(200ms);
    EXPECT_EQ(r.control.status(), 1) << "the bit still stands: no new edge";
    r.control.operation().raise(150, r.now);
    r.cycle();
    EXPECT_EQ(r.get(4, 2), 0x8009u) << "FE and status 9";
    EXPECT_EQ(r.get(8, 2) & 4u, 4u);
    EXPECT_EQ(r.get(12, 2), 150u) << "word 2 of the interface";
    EXPECT_EQ(r.get(10, 2), 0u);
    r.ctrl(0x0006);
    r.cycle();
    EXPECT_EQ(r.get(12, 2), 0u) << "reset at its falling edge";
    r.control.operation().raise(150, r.now);
    r.run(50ms);
    EXPECT_EQ(r.control.error(), 150) << "a level does not reset again";
}

TEST(PacontrolImage, TheFormatIsLatchedOnTheWayOutOfHome) {  // T-15
    Rig r(with_modules(1));
    r.control.axis(1).set_position_g26(25.045, true);
    r.cycle();
    EXPECT_FLOAT_EQ(r.real(r.module(1) + 8), 25.045F);
    r.ctrl(0x8007);
    r.cycle();
    EXPECT_EQ(r.get(r.module(1) + 8, 4), 25045u);
    r.ctrl(0x8017);
    r.run(100ms);
    ASSERT_EQ(r.control.status(), 31);
    r.ctrl(0x0007);
    r.run(50ms);
    EXPECT_EQ(r.get(r.module(1) + 8, 4), 25045u) << "no effect in ONLINE";
    EXPECT_EQ(r.get(8, 2) & 0x8000u, 0x8000u) << "what is in force";
    r.command(0x190C, 1);
    EXPECT_FLOAT_EQ(r.real(0), 25.045F) << "the CMD interface is IEEE always";
    r.ctrl(0x0003);
    r.run(100ms);
    EXPECT_EQ(r.get(8, 2) & 0x8000u, 0u) << "home position: it follows again";
}

TEST(PacontrolImage, AxisInterfaceMovesOncePerStart) {  // T-18
    Rig r(with_modules(2));
    r.online();
    r.axis(1, on | absolute, 20);
    r.run(50ms);
    EXPECT_FALSE(r.control.axis(1).running());
    r.axis(1, on | absolute | start, 20);
    r.cycle();
    EXPECT_TRUE(r.control.axis(1).running());
    EXPECT_EQ(r.status(1) & active, active);
    r.wait_for_rest(1);
    r.run(100ms);
    EXPECT_NEAR(static_cast<double>(r.real(r.module(1) + 8)), 20, 1e-3);
    EXPECT_EQ(r.status(1) & active, active) << "start still stands";
    r.axis(1, on | absolute | start, 5);
    r.run(100ms);
    EXPECT_FALSE(r.control.axis(1).running()) << "held start, new position: nothing";
    r.axis(1, on | absolute, 5);
    r.cycle();
    EXPECT_EQ(r.status(1) & active, 0u);
    EXPECT_FALSE(r.control.axis(2).running());
}

TEST(PacontrolImage, G26KeepsTheLimitsG29ShiftsThem) {  // T-16
    Rig r(with_modules(1));
    r.control.axis(1).set_parameter(ap::area_min, 0.0F);
    r.control.axis(1).set_parameter(ap::area_max, 500.0F);
    r.control.axis(1).set_position_g26(0, true);
    r.online();
    const auto go = [&](std::uint32_t what, float x) {
        r.axis(1, on);
        r.cycle();
        r.axis(1, on | what | start, x);
        r.cycle();
        const std::uint32_t e = r.get(r.module(1) + 4, 2);
        r.control.axis(1).traverse().finish(r.now);
        r.wait_for_rest(1);
        r.axis(1, on);
        r.cycle();
        return e;
    };
    EXPECT_EQ(go(g29, 100), 0u);
    EXPECT_EQ(go(absolute, 610), 0x41u);
    EXPECT_EQ(r.status(1) & cmd_error, cmd_error);
    EXPECT_EQ(go(absolute, 550), 0u);
    EXPECT_EQ(r.status(1) & cmd_error, 0u) << "gone at the next start";
    EXPECT_EQ(go(1u << 12, 0), 0u);
    EXPECT_EQ(go(absolute, 550), 0x41u) << "the offset is deleted";
    EXPECT_EQ(go(g26, 0), 0u);
    EXPECT_EQ(go(absolute, 510), 0x41u);
    EXPECT_EQ(r.status(1) & referenced, referenced);
}

TEST(PacontrolImage, LimitSwitchBitsAreZeroWhenActuated) {  // T-17
    Rig r(with_modules(1));
    EXPECT_EQ(r.status(1) & 0x600u, 0x600u);
    r.control.axis(1).set_limit(true, true, r.now);
    r.cycle();
    EXPECT_EQ(r.status(1) & 0x600u, 0x200u) << "positive is bit 10";
    r.control.axis(1).set_limit(true, false, r.now);
    r.control.axis(1).set_limit(false, true, r.now);
    r.cycle();
    EXPECT_EQ(r.status(1) & 0x600u, 0x400u);
}

TEST(PacontrolImage, AnAxisErrorStopsItsOwnAxisAndBlocksNothingElse) {  // T-19
    Rig r(with_modules(2));
    r.online();
    r.axis(1, on | absolute | start, 200);
    r.axis(2, on | absolute | start, 200);
    r.run(50ms);
    ASSERT_TRUE(r.control.axis(1).running() && r.control.axis(2).running());
    EXPECT_EQ(r.command(0x0A94, 2, std::bit_cast<std::uint32_t>(1.0F)), 0x4014u) << "blocked where there are axis interfaces";
    r.control.axis(1).set_limit(true, true, r.now);
    r.run(300ms);
    EXPECT_EQ(r.control.status(), 31);
    EXPECT_EQ(r.status(1) & axis_error, axis_error);
    EXPECT_EQ(r.get(r.module(1) + 6, 2), 529u);
    EXPECT_EQ(r.status(2) & axis_error, 0u);
    r.wait_for_rest(2);
    EXPECT_NEAR(r.control.axis(2).shaft().position(r.now), 200, 1e-3);
    r.control.axis(1).set_limit(true, false, r.now);
    r.axis(1, on | 1u << 16);
    r.cycle();
    EXPECT_EQ(r.status(1) & axis_error, 0u) << "bit 16 resets";
}

TEST(PacontrolImage, RefusedStarts) {  // T-22 and the rules of several, none, not referenced
    Rig r(with_modules(1));
    r.online();
    struct Row {
        std::uint32_t bits;
        std::uint16_t speed, acceleration, command_error, axis_error;
    };
    for (const Row& x : {Row{absolute, 0, 1000, 0x29, 0},
                         {absolute, 1001, 1000, 0x29, 0},
                         {absolute, 1000, 0, 0x29, 0},
                         {0, 1000, 1000, 0x15, 0},
                         {absolute | relative, 1000, 1000, 0x14, 0x14},
                         {absolute | 0x300, 1000, 1000, 0x14, 0x14}}) {
        r.axis(1, on | 1u << 16);
        r.cycle();
        r.axis(1, on | x.bits | start, 10, x.speed, x.acceleration);
        r.cycle();
        EXPECT_EQ(r.get(r.module(1) + 4, 2), x.command_error) << x.bits << " " << x.speed;
        EXPECT_EQ(r.get(r.module(1) + 6, 2), x.axis_error) << x.bits;
        EXPECT_EQ(r.status(1) & cmd_error, cmd_error);
        EXPECT_EQ(r.status(1) & active, 0u);
        EXPECT_FALSE(r.control.axis(1).running());
    }
    r.control.axis(1).set_referenced(false);
    r.axis(1, on | 1u << 16);
    r.cycle();
    r.axis(1, on | absolute | start, 10);
    r.cycle();
    EXPECT_EQ(r.get(r.module(1) + 4, 2), 0x2Bu);
    EXPECT_EQ(r.get(r.module(1) + 6, 2), 525u);
    r.axis(1, on | 1u << 16);
    r.cycle();
    r.axis(1, on | 1u << 10 | start, 5);
    r.cycle();
    EXPECT_TRUE(r.control.axis(1).running()) << "bit 10 needs no reference";
}

TEST(PacontrolImage, AccelerationAboveAThousandShortensTheRamp) {  // T-22
    const auto time_of = [](std::uint16_t acceleration) {
        Rig r(with_modules(1));
        r.online();
        r.axis(1, on | absolute | start, 20, 1000, acceleration);
        r.cycle();
        int cycles = 0;
        for (; cycles < 6000 && r.control.axis(1).running(); ++cycles)
            r.cycle(1ms);
        return cycles;
    };
    EXPECT_LT(time_of(2000), time_of(1000));
}

TEST(PacontrolImage, OverridesAndMonitoringEndWithOnline) {  // T-20
    Rig r(with_modules(0));
    r.online();
    EXPECT_EQ(r.command(0x0A8D, 1, std::bit_cast<std::uint32_t>(5.0F)), 0x2000u);
    EXPECT_EQ(r.command(0x0AA2, 1, 0) & 0x4000u, 0u);
    ASSERT_TRUE(r.control.orders().of(1).overrides.speed.has_value());
    EXPECT_FALSE(r.control.orders().of(1).limits_monitored);
    r.command(0x0A81, 0);
    r.run(100ms);
    r.online();
    EXPECT_FALSE(r.control.orders().of(1).overrides.speed.has_value());
    EXPECT_TRUE(r.control.orders().of(1).limits_monitored);
}

TEST(PacontrolImage, InAutomaticTheModulesOverwriteTheirElements) {  // T-21
    for (const bool wide : {false, true}) {
        ImageShape s = with_modules(2);
        s.wide_n = wide;
        Rig r(s);
        const std::size_t at = r.module(2);
        r.put(at + (wide ? 0 : 2), 0x8001, 2);
        r.put(wide ? at + 4 : at + 6, wide ? 0xFFFFFFFEu : 0xFFFEu, wide ? 4 : 2);
        r.put_real(at + 8, 12.5F);
        r.run(20ms);
        EXPECT_EQ(r.control.signals().elements().n.get(2), 0) << "not in home position";
        r.control.set_flag_word(16 * 18, 0x1234, r.now);
        r.control.set_n(18, -7);
        r.control.set_r(18, 3.5F);
        r.ctrl(0x000F);
        r.run(100ms);
        ASSERT_EQ(r.control.status(), 11);
        EXPECT_EQ(r.control.signals().elements().n.get(2), -2);
        EXPECT_FLOAT_EQ(r.control.signals().elements().r.get(2), 12.5F);
        EXPECT_TRUE(r.control.signals().elements().flags.get(17) && r.control.signals().elements().flags.get(32));
        EXPECT_EQ(r.get(at + (wide ? 0 : 2), 2), 0x1234u);
        EXPECT_EQ(r.get(wide ? at + 4 : at + 6, wide ? 4 : 2), wide ? 0xFFFFFFF9u : 0xFFF9u);
        EXPECT_FLOAT_EQ(r.real(at + 8), 3.5F);
        EXPECT_EQ(r.command(0x0904, 18, 1), 0x2000u);
        r.cycle();
        EXPECT_FALSE(r.control.signals().elements().flags.get(18)) << "the next cycle overwrites it";
    }
}

TEST(PacontrolImage, InterbusZerosAreAnEmergencyStopOnceCommandsHaveCome) {  // T-28
    ImageShape s;
    s.interbus = true;
    Rig r(s);
    EXPECT_EQ(r.control.operation().start_online(r.now), 0);
    r.run(100ms);
    ASSERT_EQ(r.control.status(), 31);
    r.run(200ms);
    EXPECT_EQ(r.control.status(), 31) << "zeros at start-up are none";
    EXPECT_EQ(r.command(0x0A94, 1, std::bit_cast<std::uint32_t>(100.0F)), 0x2000u);
    r.run(50ms);
    ASSERT_TRUE(r.control.axis(1).running());
    r.in.assign(8, 0);
    r.run(2s);
    EXPECT_FALSE(r.control.axis(1).running());
    EXPECT_LT(r.control.axis(1).shaft().position(r.now), 100);
    EXPECT_EQ(r.control.status(), 39) << "stopped with malfunction";
}

TEST(PacontrolImage, InterbusDiagnosisTellsOfDataCommandsAndTheStop) {
    ImageShape s;
    s.interbus = true;
    Rig r(s);
    const auto is = [&](InterbusDiagnosis d) { EXPECT_EQ(r.image.diagnosis(r.now), d); };
    r.run(30s);
    is({});  // zeros from the start: nobody has sent anything
    r.command(0x1900, 5);
    is({true, false, true, false});
    r.run(10s);
    is({true, false, true, false});
    r.cycle();
    is({false, true, true, false});
    r.put(0, 1, 4);
    r.cycle();
    is({true, false, true, false});
    r.in.assign(8, 0);
    r.cycle();
    is({true, false, true, true});
    r.put(6, 0x1900, 2);
    r.cycle();
    is({true, false, true, false});
}

TEST(PacontrolImage, GoldenImagesOfTheVectors) {
    std::ifstream file(AXISGATE_SOURCE_DIR "/adapters/pacontrol/vectors.txt");
    ASSERT_TRUE(file);
    std::string line, key;
    int seen = 0;
    while (std::getline(file, line)) {
        std::istringstream in(line.substr(0, line.find('#')));
        if (!(in >> key) || !key.starts_with("cmd8")) continue;
        Bytes b;
        for (std::string pair; in >> pair;)
            b.push_back(static_cast<std::uint8_t>(std::stoi(pair, nullptr, 16)));
        ASSERT_EQ(b.size(), 8u) << line;
        ++seen;
        if (!key.ends_with('>')) continue;
        const bool sf = (b[6] & 0x80) != 0;
        EXPECT_EQ(sf, key == "cmd8>") << line;
        Rig r;
        if (!sf) r.command(0x190B, 0);
        r.in = b;
        r.cycle();
        EXPECT_EQ((r.out[6] & 0x80) != 0, sf) << line << ": RF follows SF";
        EXPECT_NE(r.get(6, 2) & 0x5FFFu, 0x4013u) << line << ": a code of the manual is known";
    }
    EXPECT_GT(seen, 100);
}

}  // namespace
}  // namespace axisgate::pacontrol::twin
