// Storage classes: FLASH at once and active after a reboot, EEPROM only with the driver off, RAM lost; reboot, factory defaults, image.
// In: instructions, power cycles. Out: what survived.
// Never looks at the registers but through the wire and the named image.
#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

struct Stored {
    const char* set;  ///< an instruction that changes the factory value
    const char* get;
    const char* factory;
    const char* changed;
    const char* name;  ///< in the image
    std::int64_t value;
};

const Stored eeprom_class[] = {
    {"99 88 13 00 00", "99", "19 10 27 00 00", "19 88 13 00 00", "AC", 5000},
    {"9A 88 13 00 00", "9A", "1A 10 27 00 00", "1A 88 13 00 00", "DC", 5000},
    {"9B 64 00 00 00", "9B", "1B 00 00 00 00", "1B 64 00 00 00", "SS", 100},
    {"9C 40 0D 03 00", "9C", "1C 00 6A 18 00", "1C 40 0D 03 00", "SD", 200000},
    {"AD 0A 00 00 00", "AD", "2D 00 00 00 00", "2D 0A 00 00 00", "BL", 10},
    {"BD 00 D0 07", "BD 00", "3D 00 E8 03", "3D 00 D0 07", "QE[0]", 2000},
    {"BD 01 C8 00", "BD 01", "3D 01 64 00", "3D 01 C8 00", "QE[1]", 200},
    {"BD 02 14 00", "BD 02", "3D 02 11 00", "3D 02 14 00", "QE[2]", 20},
    {"BD 04 00 19", "BD 04", "3D 04 80 0C", "3D 04 00 19", "QE[4]", 6400},
    {"90 00 20 00", "90 00", "10 00 10 00", "10 00 20 00", "MT[0]", 32},
    {"90 01 28 00", "90 01", "10 01 1C 00", "10 01 28 00", "MT[1]", 40},
    {"90 02 0A 00", "90 02", "10 02 32 00", "10 02 0A 00", "MT[2]", 10},
    {"90 03 E8 03", "90 03", "10 03 00 00", "10 03 E8 03", "MT[3]", 1000},
    {"B4 00 81 82", "B4 00", "34 00 80 80", "34 00 81 82", "IL[0]", 0x8281},
    {"B4 01 83 88", "B4 01", "34 01 80 80", "34 01 83 88", "IL[1]", 0x8883},
    {"B4 02 8B 80", "B4 02", "34 02 80 80", "34 02 8B 80", "IL[2]", 0x808B},
    {"B4 03 01 00", "B4 03", "34 03 00 00", "34 03 01 00", "IL[3]", 1},
    {"B5 00 64 00", "B5 00", "35 00 00 00", "35 00 64 00", "TG[0]", 100},
    {"B5 01 61 EA", "B5 01", "35 01 00 00", "35 01 61 EA", "TG[1]", 60001},
    {"B5 02 01 00", "B5 02", "35 02 00 00", "35 02 01 00", "TG[2]", 1},
    {"87 00 00 00", "87 00", "07 00 01 00", "07 00 00 00", "IE[0]", 0},
    {"87 01 00 00", "87 01", "07 01 01 00", "07 01 00 00", "IE[1]", 0},
    {"87 02 00 00", "87 02", "07 02 01 00", "07 02 00 00", "IE[2]", 0},
    {"87 08 00 00", "87 08", "07 08 01 00", "07 08 00 00", "IE[8]", 0},
};

std::int64_t stored(Twin& t, const std::string& name) {
    const NonVolatile all = t.non_volatile();
    const auto it = all.find(name);
    if (it == all.end()) return -999;
    return as_integer(it->second).value_or(-998);
}

TEST(TwinMemory, EepromIsWrittenWithTheDriverOffAlone) {
    for (const Stored& s : eeprom_class) {
        Bench off;
        EXPECT_EQ(off.ask(s.get), s.factory);
        const auto before = off.drive().non_volatile_revision();
        EXPECT_EQ(off.ask(s.set), s.changed);
        EXPECT_EQ(off.drive().non_volatile_revision(), before + 1) << s.name;
        EXPECT_EQ(stored(off.drive(), s.name), s.value);
        EXPECT_TRUE(off.send("7E 01").empty());
        EXPECT_EQ(off.ask(s.get), s.changed) << s.name << " survives SY[1]";
        off.hand("power", false);
        EXPECT_TRUE(off.send("95").empty());
        off.hand("power", true);
        EXPECT_EQ(off.ask(s.get), s.changed) << s.name << " survives the power";

        Bench on;
        on.setup({"95 01"});
        const auto revision = on.drive().non_volatile_revision();
        EXPECT_EQ(on.ask(s.set), s.changed);
        EXPECT_EQ(on.ask(s.get), s.changed) << s.name << " is used from RAM";
        EXPECT_EQ(on.drive().non_volatile_revision(), revision) << s.name;
        on.setup({"95 00"});
        EXPECT_EQ(on.ask(s.get), s.changed) << "switching off does not save";
        EXPECT_NE(stored(on.drive(), s.name), s.value);
        EXPECT_TRUE(on.send("7E 01").empty());
        EXPECT_EQ(on.ask(s.get), s.factory) << s.name << " is back";
    }
}

TEST(TwinMemory, GroupValuesFollowTheSameRule) {
    for (const char* group : {"02", "03", "04", "05", "06", "07"}) {
        for (const char* cw : {"99", "9A", "9E", "9F", "A0"}) {
            const std::string mf = std::string("98 ") + group;
            for (const bool on : {false, true}) {
                Bench b;
                b.setup({mf});
                const std::string factory = b.ask(cw);
                if (on) b.setup({"95 01"});
                b.setup({mf, std::string(cw) + " D2 04 00 00", mf});
                EXPECT_EQ(b.ask(cw).substr(3), "D2 04 00 00");
                (void)b.send("7E 01");
                b.setup({mf});
                if (on) {
                    EXPECT_EQ(b.ask(cw), factory) << group << " " << cw;
                } else {
                    EXPECT_EQ(b.ask(cw).substr(3), "D2 04 00 00") << group << " " << cw;
                }
            }
        }
    }
}

TEST(TwinMemory, InitialConfigurationIsAlwaysKept) {
    for (int i = 0; i < 8; ++i) {
        for (const bool on : {false, true}) {
            Bench b;
            const std::string get = "86 0" + std::to_string(i);
            const bool was = b.ask(get).substr(6, 2) == "01";
            if (on) b.setup({"95 01"});
            b.setup({get + (was ? " 00 00" : " 01 00")});
            (void)b.send("7E 01");
            EXPECT_EQ(b.ask(get), "06 0" + std::to_string(i) + (was ? " 00 00" : " 01 00"));
        }
    }
}

TEST(TwinMemory, ProtocolParametersAreKeptAtOnceAndActAfterAReboot) {
    for (const bool on : {false, true}) {
        Bench b;
        if (on) b.setup({"95 01"});
        EXPECT_EQ(b.ask("81 07 06"), "01 07 06");
        EXPECT_EQ(b.ask("81 07"), "01 07 06");  // still as node 5: `ask` would show "6:"
        EXPECT_TRUE(b.send_to(6, "95").empty());
        EXPECT_TRUE(b.send("7E 01").empty());
        EXPECT_TRUE(b.send("95").empty());
        EXPECT_EQ(b.send_to(6, "95"), Lines{"6:15 00"});
        EXPECT_EQ(b.send_to(6, "81 08 0B"), Lines{"6:01 08 0B"});
        EXPECT_EQ(b.send_to(10, "95").size(), 1u);
        EXPECT_TRUE(b.send_to(11, "95").empty());
        b.hand("power", false);
        b.hand("power", true);
        EXPECT_TRUE(b.send_to(10, "95").empty());
        EXPECT_EQ(b.send_to(11, "95"), Lines{"6:15 00"});
        EXPECT_EQ(b.send_to(6, "81 05 04"), Lines{"6:01 05 04"});
        (void)b.send_to(6, "7E 01");
        EXPECT_EQ(b.send_to(6, "81 05"), Lines{"6:01 05 04"});
    }
}

TEST(TwinMemory, TheSameValueAgainIsNoChange) {
    Bench b;
    const auto revision = b.drive().non_volatile_revision();
    b.setup({"81 08 0A", "99 10 27 00 00", "90 01 1C 00", "86 01 01 00"});
    EXPECT_EQ(b.drive().non_volatile_revision(), revision);
}

TEST(TwinMemory, VolatileByUse) {
    Bench b;
    b.setup({"98 03", "9D E8 03 00 00", "A0 64 00 00 00", "9F 65 00 00 00", "9E 66 00 00 00", "B7 01 01 00 00"});
    (void)b.ask("81 00");
    b.setup({"95 01", "97", "98 04"});
    EXPECT_TRUE(b.send("7E 01").empty());
    EXPECT_EQ(b.ask("98"), "18 00");
    EXPECT_EQ(b.ask("95"), "15 00");
    EXPECT_EQ(b.ask("B7"), "37 00 00 00 00");
    for (const char* dv : {"AE 00", "AE 02", "AE 03", "AE 04"})
        EXPECT_EQ(b.ask(dv).substr(6), "00 00 00 00") << dv;
    EXPECT_EQ(b.ask("91 00"), "11 00 00 01 00 00 00 00 00");
    EXPECT_EQ(b.ask("8F 00"), "0F 00 00 00 00 00 00");
}

TEST(TwinMemory, SystemOperationsAreSilent) {
    Bench b;
    EXPECT_TRUE(b.send("7E 01").empty());
    EXPECT_TRUE(b.send("FE 01").empty());
    EXPECT_TRUE(b.send("7E 02").empty());
    EXPECT_TRUE(b.send("FE 02").empty());
    EXPECT_EQ(b.ask("FE 01 00"), "0F 00 32 FE 01 00 00");
    EXPECT_EQ(b.ask("7E 03"), "0F 00 34 7E 03 00 00");
}

TEST(TwinMemory, RebootStopsTheMotor) {
    Bench b;
    b.setup({"95 01", "9D 10 27 00 00", "96"});
    b.pass_ms(2000);
    EXPECT_GT(b.position(), 9000);
    EXPECT_TRUE(b.send("FE 01").empty());
    EXPECT_TRUE(b.stopped());
    EXPECT_EQ(b.position(), 0);  // incremental encoder
    EXPECT_FALSE(b.mechanics().powered);
    EXPECT_TRUE(b.pass_ms(5000).empty());
    EXPECT_EQ(b.position(), 0);
}

TEST(TwinMemory, FactoryDefaultsSpareTheAddressAndTheSerialNumber) {
    Bench b;
    const std::string serial = b.ask("8C");
    b.setup({"81 05 03", "81 07 09", "81 08 21"});
    for (const Stored& s : eeprom_class)
        b.setup({s.set});
    b.setup({"86 00 01 00", "98 02", "9E 10 00 00 00", "98 02", "A0 11 00 00 00", "A0 05 00 00 00"});
    EXPECT_TRUE(b.send("FE 02").empty());
    for (const Stored& s : eeprom_class)
        EXPECT_EQ(b.ask(s.get), s.factory) << s.name;  // at once, in RAM
    EXPECT_EQ(b.ask("86 00"), "06 00 00 00");
    b.setup({"98 02"});
    EXPECT_EQ(b.ask("9E"), "1E 00 00 00 00");
    EXPECT_EQ(b.ask("81 05"), "01 05 03");
    EXPECT_EQ(b.ask("81 07"), "01 07 09");
    EXPECT_EQ(b.ask("81 08"), "01 08 21");
    EXPECT_EQ(b.ask("AE 04"), "2E 04 05 00 00 00") << "no reboot: what is volatile stays";
    (void)b.send("7E 01");
    b.address(9);
    for (const Stored& s : eeprom_class)
        EXPECT_EQ(b.ask(s.get), s.factory) << s.name;  // and in the EEPROM
    EXPECT_EQ(b.ask("8C"), serial);
    // What acts at once follows at once: the loop is closed again, the input is unfiltered.
    b.setup({"86 06 00 00", "B5 00 64 00"});
    (void)b.send("7E 02");
    EXPECT_EQ(b.inputs(1), Lines{"5A 02"});
    b.setup({"95 01", "9D E8 03 00 00", "96"});
    b.hand("stall", true);
    EXPECT_EQ(b.pass_ms(1000), Lines{"5A 00 1D 00 00 00"});
    b.hand("stall", false);
    b.setup({"95 00"});
    // With the driver on too.
    b.setup({"99 88 13 00 00", "95 01"});
    (void)b.send("7E 02");
    EXPECT_EQ(b.ask("99"), "19 10 27 00 00");
    EXPECT_EQ(b.ask("95"), "15 01");
}

TEST(TwinMemory, ImageRestoresAnotherDrive) {
    NonVolatile image;
    std::string serial;
    {
        Bench b(can_setup("17"));
        for (const Stored& s : eeprom_class)
            b.setup({s.set});
        b.setup({"81 08 21", "86 04 01 00", "98 07", "9F 18 FC FF FF", "98 02", "99 60 EA 00 00"});
        image = b.drive().non_volatile();
        serial = b.ask("8C");
    }
    EXPECT_EQ(as_integer(image.at("PP[7]")), 17);
    EXPECT_EQ(as_integer(image.at("PP[8]")), 0x21);
    EXPECT_EQ(as_integer(image.at("IC[4]")), 1);
    EXPECT_EQ(as_integer(image.at("MF7.PR")), -1000);
    EXPECT_EQ(as_integer(image.at("MF2.AC")), 60000);
    EXPECT_EQ(as_integer(image.at("SN")), 0x04030201 + 12);
    EXPECT_EQ(image.size(), 3u + 1 + 8 + 4 + 4 + 4 + 4 + 3 + 5 + 30);
    Bench b(can_setup("5"), image);
    b.address(17);  // the memory's node goes before the setup's address
    for (const Stored& s : eeprom_class)
        EXPECT_EQ(b.ask(s.get), s.changed) << s.name;
    EXPECT_EQ(b.ask("8C"), serial);
    EXPECT_EQ(b.send_to(0x21, "95").size(), 1u);
    b.setup({"98 07"});
    EXPECT_EQ(b.ask("9F"), "1F 18 FC FF FF");
    // Powering on with an empty memory is the factory's state again.
    Out out;
    b.drive().power_on({}, b.now(), out);
    b.address(5);
    for (const Stored& s : eeprom_class)
        EXPECT_EQ(b.ask(s.get), s.factory) << s.name;
    EXPECT_EQ(b.ask("8C"), "0C 01 02 03 04 05 06 07 08");
}

TEST(TwinMemory, ImpossibleImageValuesBecomeTheFactorys) {
    const NonVolatile image{{"PP[7]", std::int64_t{200}},
                            {"PP[8]", std::string("x")},
                            {"MT[0]", std::int64_t{3}},
                            {"AC", std::int64_t{0}},
                            {"IL[0]", std::int64_t{-1}},
                            {"TG[0]", std::int64_t{70000}},
                            {"SS", std::int64_t{1} << 40},
                            {"BL", Value{}},
                            {"QE[3]", std::int64_t{7}},
                            {"nonsense", true},
                            {"DC", 2000.0},
                            {"IC[0]", false}};
    Bench b(can_setup(), image);
    EXPECT_EQ(b.ask("81 08"), "01 08 0A");
    EXPECT_EQ(b.ask("90 00"), "10 00 10 00");
    EXPECT_EQ(b.ask("99"), "19 10 27 00 00");
    EXPECT_EQ(b.ask("9A"), "1A D0 07 00 00");
    EXPECT_EQ(b.ask("B4 00"), "34 00 80 80");
    EXPECT_EQ(b.ask("B5 00"), "35 00 00 00");
    EXPECT_EQ(b.ask("9B"), "1B 00 00 00 00");
    EXPECT_EQ(b.ask("BD 03"), "3D 03 01 00");
}

TEST(TwinMemory, FactoryBitRateIsTheLines) {
    const std::pair<std::uint32_t, const char*> rates[] = {{1'000'000, "00"}, {800'000, "01"}, {500'000, "02"}, {250'000, "03"},
                                                           {125'000, "04"},   {0, "02"},       {100'000, "02"}};
    for (const auto& [rate, code] : rates) {
        TwinSetup s = can_setup();
        s.bit_rate = rate;
        Bench b(s);
        EXPECT_EQ(b.ask("81 05"), std::string("01 05 ") + code);
    }
}

TEST(TwinMemory, AbsoluteEncoderKeepsThePosition) {
    Bench b;
    b.setup({"86 05 01 00"});
    (void)b.send("7E 01");  // acts after a reboot
    b.setup({"95 01", "A0 D2 04 00 00", "9E 10 27 00 00"});
    const auto revision = b.drive().non_volatile_revision();
    b.setup({"96"});
    b.pass_ms(3000);
    EXPECT_EQ(b.position(), 1234);
    EXPECT_GT(b.drive().non_volatile_revision(), revision);
    (void)b.send("7E 01");
    EXPECT_EQ(b.position(), 1234);
    EXPECT_EQ(b.relative(), 0);
    b.hand("power", false);
    b.hand("position", 1300);  // turned while without power: the encoder knows
    b.hand("power", true);
    EXPECT_EQ(b.position(), 1300);
    Bench other(can_setup(), b.drive().non_volatile());
    EXPECT_EQ(other.position(), 1300);
    // The image is whole as soon as the type is stored, before it acts, and tells of each change by its revision.
    Bench stored;
    stored.setup({"95 01", "9F 0A 00 00 00", "9E 10 27 00 00", "96"});
    stored.pass_ms(1000);
    EXPECT_FALSE(stored.drive().non_volatile().contains("encoder.position"));
    const auto before = stored.drive().non_volatile_revision();
    stored.setup({"86 05 01 00"});
    EXPECT_GT(stored.drive().non_volatile_revision(), before);
    EXPECT_EQ(as_integer(stored.drive().non_volatile().at("encoder.position")), 10);
    const auto image = stored.drive().non_volatile();
    EXPECT_EQ(Bench(can_setup(), image).drive().non_volatile(), image);
    const auto revision_before_boot = stored.drive().non_volatile_revision();
    (void)stored.send("7E 01");
    EXPECT_EQ(stored.drive().non_volatile(), image);
    EXPECT_EQ(stored.drive().non_volatile_revision(), revision_before_boot);
    EXPECT_EQ(stored.position(), 10);
    (void)stored.send("7E 02");
    EXPECT_FALSE(stored.drive().non_volatile().contains("encoder.position"));
    EXPECT_GT(stored.drive().non_volatile_revision(), revision_before_boot);
    // Setting the type back acts at the next boot only.
    b.setup({"86 05 00 00"});
    EXPECT_EQ(b.position(), 1300);
    (void)b.send("7E 01");
    EXPECT_EQ(b.position(), 0);
}

TEST(TwinMemory, AutomaticEnableAfterItsDelay) {
    Bench b;
    b.setup({"86 00 01 00", "90 03 F4 01"});
    (void)b.send("7E 01");
    EXPECT_EQ(b.ask("95"), "15 00");
    b.pass_ms(499.9);
    EXPECT_EQ(b.ask("95"), "15 00");
    b.pass_ms(0.2);
    EXPECT_EQ(b.ask("95"), "15 01");
    // A delay of 0: with the boot. An MO=0 before the delay is over is obeyed.
    Bench now;
    now.setup({"86 00 01 00"});
    (void)now.send("7E 01");
    EXPECT_EQ(now.ask("95"), "15 01");
    (void)b.send("7E 01");
    b.setup({"95 00"});
    b.pass_ms(1000);
    EXPECT_EQ(b.ask("95"), "15 00");
}

TEST(TwinMemory, LevelsAtBootAreNoEdges) {
    TwinSetup s = can_setup();
    s.freedoms["restart_ms"] = 80;
    Bench b(s);
    (void)b.send("7E 01");
    EXPECT_TRUE(b.send("95").empty());
    b.inputs(1);
    b.pass_ms(79.9);
    EXPECT_TRUE(b.send("95").empty());
    EXPECT_TRUE(b.pass_ms(0.1).empty()) << "levels at boot are no edges";
    EXPECT_EQ(b.ask("95"), "15 00");
    EXPECT_EQ(b.ask("B7"), "37 01 00 00 00");
}

}  // namespace
}  // namespace axisgate::uim342::test
