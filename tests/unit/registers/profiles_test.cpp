// A unit with another device's language, through the Modbus door: reference words of the manuals, traps of their handshakes, refusals in
// the language's own way.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>

#include "gateway/core/assets.hpp"
#include "gateway/registers/profiles/cia402_block.hpp"
#include "gateway/registers/profiles/profile_map.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using test::ResponderBench;

std::shared_ptr<const Language> page(std::string_view name) {
    std::string fault;
    auto l = read_language(asset("schema/profiles/" + std::string(name) + ".json"), fault);
    EXPECT_TRUE(l) << fault;
    return l;
}

struct ProfileTest : testing::Test, ResponderBench {
    AxisId x = port.add_axis(1, &test::catalogue()), y = port.add_axis(2, &test::catalogue());
    std::unique_ptr<ProfileMap> map;

    void put(ProfileLanguage language, MapGaps gaps = MapGaps::zero, std::optional<MapWordOrder> order = {}, std::size_t axes = 1) {
        const auto l = page(name_of(language));
        ProfileMap::Setup setup{l, order.value_or(l->word_order), {}, gaps};
        for (std::size_t i = 0; i < axes; ++i) {
            PlacedProfileAxis a;
            a.id = i == 0 ? x : y;
            a.number = static_cast<int>(i) + 1;
            a.name = i == 0 ? "feeder" : "lift";
            a.increments_per_count = 10;
            a.velocity = 100;
            a.acceleration = 1000;
            a.lowest = -50;
            a.highest = 50;
            setup.axes.push_back(a);
        }
        map = make_profile(language, port, setup);
        image.set_map(10, map.get());
    }
    void SetUp() override {
        for (const AxisId id : {x, y})
            port.edit(id, [](AxisPicture& p) {
                p.flags = flag_online | flag_referenced | flag_target_reached;
                p.statusword = 0x0627;  // enabled, target reached
                p.ever_seen = true;
                p.position = 12'340;
                p.velocity = -500;
            });
    }
    std::string at(std::string_view pdu) { return ask(pdu, 10); }
    template <class T>
    const T* next() {
        return port.commands.empty() ? nullptr : std::get_if<T>(&port.commands.front().body);
    }
    /// The commands of a request, kept instead of answered.
    template <class T>
    T order(std::string_view pdu) {
        std::optional<T> seen;
        result = [&] {
            if (const auto* body = next<T>()) seen = *body;
            port.answer();
        };
        EXPECT_EQ(at(pdu).substr(0, 2), pdu.substr(0, 2));
        result = [this] { port.answer(); };
        if (!seen && next<T>()) {
            seen = *next<T>();
            port.answer();
        }
        EXPECT_TRUE(seen) << pdu;
        return seen.value_or(T{});
    }
};

TEST(ProfilePages, AreWholeAndSayWhatTheTranslatorsKnow) {
    for (const auto* name : {"cia402", "lexium", "pacontrol", "linmot"}) {
        const auto l = page(name);
        ASSERT_TRUE(l);
        EXPECT_EQ(l->name, name);
        EXPECT_FALSE(l->description.empty());
        EXPECT_GT(l->rows.size(), 12u);
    }
    const auto block = page("cia402");
    ASSERT_EQ(block->rows.size(), standard_registers().size());
    for (std::size_t i = 0; i < block->rows.size(); ++i) {
        EXPECT_EQ(block->rows[i].address, standard_registers()[i].offset);
        EXPECT_EQ(block->rows[i].name, standard_registers()[i].name);
        EXPECT_EQ(block->rows[i].type, standard_registers()[i].type);
        EXPECT_EQ(block->rows[i].writable, standard_registers()[i].writable);
    }
}

TEST(ProfilePages, AWrongOneIsRefusedWithItsFault) {
    std::string fault;
    EXPECT_FALSE(read_language("{", fault));
    EXPECT_FALSE(read_language(R"({"language":"x"})", fault));
    EXPECT_EQ(fault, "registers are missing");
    const std::string row = R"({"table":"both","address":0,"type":"i32","access":"RW","name":"A","meaning":"m"})";
    EXPECT_FALSE(read_language(
        R"({"registers":[)" + row + "," + R"({"table":"input","address":1,"type":"u16","access":"R","name":"B","meaning":"m"}]})", fault));
    EXPECT_EQ(fault, "B stands where another register does");
    EXPECT_FALSE(
        read_language(R"({"registers":[{"table":"both","address":0,"type":"f64","access":"RW","name":"A","meaning":"m"}]})", fault));
    EXPECT_FALSE(read_language(
        R"({"registers":[{"table":"both","address":0,"type":"u16","access":"RW","name":"A","meaning":"m","adress":1}]})", fault));
    EXPECT_TRUE(read_language(R"({"registers":[)" + row + "]}", fault)) << fault;
}

struct Lexium : ProfileTest {
    std::string error() { return at("03 00 21 00 01"); }
};

TEST_F(Lexium, ReadsTheAxisInCounts) {
    put(ProfileLanguage::lexium);
    EXPECT_EQ(at("03 00 57 00 02"), "03 04 04 D2 00 00") << "P 1234, low word first";
    EXPECT_EQ(at("04 00 85 00 02"), "04 04 FF CE FF FF") << "V -50";
    EXPECT_EQ(at("03 00 1C 00 01"), "03 02 00 01") << "DE";
    EXPECT_EQ(at("03 00 4A 00 01"), "03 02 00 00") << "MV";
    EXPECT_EQ(at("03 00 8B 00 02"), "03 04 00 64 00 00") << "VM as the site has it";
    EXPECT_EQ(at("03 00 29 00 01"), "03 02 00 05") << "HC, kept: its default";
    put(ProfileLanguage::lexium, MapGaps::zero, MapWordOrder::high_first);
    EXPECT_EQ(at("03 00 57 00 02"), "03 04 00 00 04 D2");
}

TEST_F(Lexium, WhatNobodyKnowsIsNoZero) {
    put(ProfileLanguage::lexium);
    EXPECT_EQ(at("03 00 2D 00 01"), "83 04") << "I1";
    EXPECT_EQ(at("03 00 02 00 01"), "83 02") << "no register of the language";
    EXPECT_EQ(at("03 00 29 00 05"), "03 0A 00 05 00 00 00 00 01 F4 00 00") << "in a block of others it is a gap, as HM, HI and I1 are";
    put(ProfileLanguage::lexium, MapGaps::refuse);
    EXPECT_EQ(at("03 00 29 00 05"), "83 02");
    EXPECT_EQ(at("01 00 00 00 01"), "81 02") << "no coils";
}

TEST_F(Lexium, AMoveTakesWhatIsKept) {
    put(ProfileLanguage::lexium);
    EXPECT_EQ(at("10 00 8B 00 02 04 01 F4 00 00"), "10 00 8B 00 02") << "VM 500";
    EXPECT_EQ(at("10 00 00 00 02 04 03 E8 00 00"), "10 00 00 00 02") << "A 1000";
    EXPECT_TRUE(port.commands.empty());
    const Move m = order<Move>("10 00 43 00 02 04 FF FF FF FF");
    EXPECT_EQ(m.kind, Move::Kind::absolute);
    EXPECT_EQ(m.target, -10);
    EXPECT_EQ(m.velocity, 5000);
    EXPECT_EQ(m.acceleration, 10'000);
    EXPECT_EQ(m.deceleration, 10'000) << "D as the site has it";
    EXPECT_EQ(order<Move>("10 00 46 00 02 04 00 02 00 00").kind, Move::Kind::relative);
    const Move run = order<Move>("10 00 78 00 02 04 FF 9C FF FF");
    EXPECT_EQ(run.kind, Move::Kind::velocity);
    EXPECT_EQ(run.target, -1000);
    (void)order<Halt>("10 00 78 00 02 04 00 00 00 00");
    EXPECT_EQ(order<Home>("06 00 2B 00 03").method, 19);
    EXPECT_EQ(order<Home>("06 00 2A 00 01").method, 33);
    EXPECT_EQ(order<SetPosition>("10 00 57 00 02 04 00 07 00 00").position, 70);
    (void)order<Disable>("06 00 1C 00 00");
    (void)order<Enable>("06 00 1C 00 01");
}

TEST_F(Lexium, ARefusalIsAnExceptionAndTheDrivesOwnError) {
    put(ProfileLanguage::lexium);
    EXPECT_EQ(error(), "03 02 00 00");
    EXPECT_EQ(at("06 00 4B 00 01"), "86 04") << "O1";
    EXPECT_EQ(error(), "03 02 00 25") << "not in this product";
    EXPECT_EQ(at("03 00 1F 00 01"), "03 02 00 01") << "EF";
    EXPECT_EQ(at("06 00 21 00 00"), "06 00 21 00 00");
    EXPECT_EQ(error(), "03 02 00 00");
    EXPECT_EQ(at("06 00 48 00 80"), "86 03") << "MS 128 would scale the axis anew";
    EXPECT_EQ(error(), "03 02 00 15") << "value not allowed";
    EXPECT_EQ(at("06 00 48 01 00"), "06 00 48 01 00") << "MS as it is";
    result = [this] { port.refuse(Reason::wrong_state); };
    EXPECT_EQ(at("10 00 43 00 02 04 00 01 00 00"), "90 04");
    EXPECT_EQ(error(), "03 02 00 5E") << "drive is disabled";
    EXPECT_EQ(at("06 00 43 00 01"), "86 03") << "half a value";
    EXPECT_EQ(at("06 00 2B 00 05"), "86 03") << "HM 5";
    EXPECT_EQ(at("06 00 21 00 07"), "86 03") << "ER takes 0 alone";
    EXPECT_TRUE(port.commands.empty());
    EXPECT_EQ(at("10 00 3F 00 03 06 00 00 00 00 00 00"), "90 02") << "a write over a gap writes nothing";
}

TEST_F(Lexium, ErZeroResetsAFault) {
    put(ProfileLanguage::lexium);
    port.edit(x, [](AxisPicture& p) { p.flags |= flag_fault; });
    EXPECT_EQ(error(), "03 02 00 4B");
    (void)order<ResetFault>("06 00 21 00 00");
}

/// A controller repeats SL while the axis accelerates, without an effect; a refused SL is ordered again.
TEST_F(Lexium, AnSlThatIsRepeatedIsOneOrderUnlessItWasRefused) {
    put(ProfileLanguage::lexium);
    const std::string sl = "10 00 78 00 02 04 00 64 00 00";
    (void)order<Move>(sl);
    result = [this] { ADD_FAILURE() << "once more: " << name_of(port.commands.front().body); };
    EXPECT_EQ(at(sl), "10 00 78 00 02") << "it is not seen to move yet";
    port.time += std::chrono::seconds(5);
    port.edit(x, [](AxisPicture& p) { p.flags |= flag_moving, p.mode_display = 3, p.target_velocity = 1000; });
    EXPECT_EQ(at(sl), "10 00 78 00 02") << "it turns so";
    port.edit(x, [](AxisPicture& p) { p.mode_display = 1; });
    EXPECT_EQ(order<Move>(sl).target, 1000) << "it moves for somebody else: the instruction acts, as in the drive";
    (void)order<Halt>("10 00 78 00 02 04 00 00 00 00");
    result = [this] { port.refuse(Reason::wrong_state); };
    EXPECT_EQ(at(sl).substr(0, 2), "90");
    result = [this] { port.answer(); };
    EXPECT_EQ(order<Move>(sl).target, 1000) << "a refusal is no order that is on its way";
}

/// The registers of the axis after another client has stopped it: register 23 and the status word.
void stopped_by_another(AxisPicture& p, std::uint16_t statusword) {
    p.stop_latch = 0b101;
    p.statusword = statusword;
    p.flags &= static_cast<std::uint16_t>(~flag_moving);
}
constexpr std::uint16_t still_enabled = 0x0627, quick_stopped = 0x0607;

/// DE 1, SL 100 and MA 50, which a controller writes in cycles.
TEST_F(Lexium, AfterAStopOfSomebodyElseWhatIsRepeatedBeginsNothing) {
    put(ProfileLanguage::lexium);
    const auto cycle = [&] {
        EXPECT_EQ(at("10 00 78 00 02 04 00 64 00 00"), "10 00 78 00 02");
        EXPECT_EQ(at("10 00 43 00 02 04 00 32 00 00"), "10 00 43 00 02");
        EXPECT_EQ(at("06 00 1C 00 01"), "06 00 1C 00 01");
    };
    result = [this] { port.answer(); };
    cycle();
    for (const std::uint16_t shown : {still_enabled, quick_stopped}) {
        SCOPED_TRACE(shown);
        result = [this] {
            ADD_FAILURE() << "a repeated word is an order: " << name_of(port.commands.front().body);
            port.answer();
        };
        port.edit(x, [&](AxisPicture& p) { stopped_by_another(p, shown); });
        for (int i = 0; i < 3; ++i)
            cycle();
        EXPECT_EQ(error(), "03 02 00 5E") << "and the drive's own error word says that it is held";
        // Another client moves it and it rests again: the latch is gone, and this client has still written nothing new.
        port.edit(x, [](AxisPicture& p) { p.stop_latch = 0, p.statusword = still_enabled; });
        cycle();
        result = [this] { port.answer(); };
        (void)order<Halt>("10 00 78 00 02 04 00 00 00 00");
        EXPECT_EQ(order<Move>("10 00 78 00 02 04 00 64 00 00").target, 1000) << "another value is a fresh word";
        EXPECT_EQ(order<Move>("10 00 43 00 02 04 00 32 00 00").target, 500) << "and from then on each write acts, as in the drive";
    }
    port.edit(x, [](AxisPicture& p) { stopped_by_another(p, quick_stopped); });
    (void)order<Disable>("06 00 1C 00 00");
    (void)order<Enable>("06 00 1C 00 01");
    port.edit(x, [](AxisPicture& p) { p.stop_latch = 0, p.statusword = still_enabled; });
    EXPECT_EQ(order<Move>("10 00 78 00 02 04 00 64 00 00").target, 1000) << "power that is asked for anew is a fresh word, too";
}

/// The gateway was restarted, found the axis moving and has stopped it: the words that its controller writes then are as old as the motion.
TEST_F(Lexium, TheFirstWordsBehindAStopAreAnOldImage) {
    put(ProfileLanguage::lexium);
    port.edit(x, [](AxisPicture& p) { stopped_by_another(p, still_enabled); });
    result = [this] {
        ADD_FAILURE() << "an old word is an order: " << name_of(port.commands.front().body);
        port.answer();
    };
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(at("10 00 78 00 02 04 00 64 00 00"), "10 00 78 00 02");
        EXPECT_EQ(at("06 00 1C 00 01"), "06 00 1C 00 01");
    }
    result = [this] { port.answer(); };
    EXPECT_EQ(order<Move>("10 00 78 00 02 04 00 65 00 00").target, 1010);
}

/// The drive is replaced by its twin, and back, while its controller repeats its words, which were meant for the former one.
TEST_F(Lexium, WhatWasSaidToADriveIsNotSaidToTheTwinThatTakesItsPlace) {
    put(ProfileLanguage::lexium);
    port.edit(x, [](AxisPicture& p) { p.current = true, p.source = 4; });
    EXPECT_EQ(order<Move>("10 00 78 00 02 04 00 64 00 00").target, 1000);
    for (const std::uint32_t source : {5u, 6u}) {
        result = [this] {
            ADD_FAILURE() << "a repeated word is an order: " << name_of(port.commands.front().body);
            port.answer();
        };
        port.time += std::chrono::seconds(5);
        port.edit(x, [&](AxisPicture& p) { p.source = source; });
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(at("10 00 78 00 02 04 00 64 00 00"), "10 00 78 00 02");
        result = [this] { port.answer(); };
        EXPECT_EQ(order<Move>("10 00 78 00 02 04 00 65 00 00").target, 1010) << "another value is a fresh word";
        EXPECT_EQ(order<Move>("10 00 78 00 02 04 00 64 00 00").target, 1000);
    }
}

struct PaControl : ProfileTest {
    /// Words of the CMD interface; returns those of the answer.
    std::string cmd(std::string_view words) {
        EXPECT_EQ(at("10 00 00 00 04 08 " + std::string(words)), "10 00 00 00 04");
        return at("04 00 00 00 04").substr(6);
    }
    void online() { EXPECT_THAT(cmd("00 00 00 00 00 00 86 03"), testing::EndsWith("00 1F A0 00")); }
};

TEST_F(PaControl, TheManualsExamplesOfElements) {
    put(ProfileLanguage::pacontrol);
    EXPECT_EQ(at("04 00 00 00 04"), "04 08 00 00 00 00 00 00 00 00") << "all zero at the start";
    EXPECT_EQ(cmd("44 20 00 00 00 01 89 07"), "44 20 00 00 00 01 A0 00") << "R1 := 640.0";
    EXPECT_EQ(cmd("00 00 00 00 00 01 19 07"), "44 20 00 00 00 01 20 00") << "R1, as the manual shows it";
    EXPECT_EQ(cmd("00 00 45 F2 00 11 89 05"), "00 00 45 F2 00 01 A0 00") << "flag word 2 by its flag 17";
    for (const auto& [flag, set] :
         {std::pair{"12", true}, {"13", false}, {"15", true}, {"19", true}, {"1B", true}, {"1F", true}, {"20", false}}) {
        const bool sf = at("04 00 03 00 01") == "04 02 A0 00";
        EXPECT_EQ(cmd("00 00 00 00 00 " + std::string(flag) + (sf ? " 19 04" : " 99 04")).substr(9, 2), set ? "01" : "00") << flag;
    }
}

TEST_F(PaControl, OnlyAToggleIsACommand) {
    put(ProfileLanguage::pacontrol);
    EXPECT_EQ(cmd("00 00 00 05 00 01 89 06"), "00 00 00 05 00 01 A0 00");
    EXPECT_EQ(cmd("00 00 00 09 00 01 89 06"), "00 00 00 05 00 01 A0 00") << "the same toggle: nothing new";
    EXPECT_EQ(cmd("00 00 00 00 00 01 19 06"), "00 00 00 05 00 01 20 00");
    EXPECT_EQ(cmd("00 00 00 00 00 01 99 99"), "00 00 00 00 00 01 C0 13") << "unknown command";
    EXPECT_EQ(cmd("00 00 00 00 04 01 19 06"), "00 00 00 00 00 01 40 26") << "N 1025";
    EXPECT_EQ(cmd("00 00 00 00 00 01 99 00"), "00 00 00 00 00 01 C0 23") << "no inputs";
}

TEST_F(PaControl, AMoveIsDoneWhenItIsThereAndShowsItsWay) {
    put(ProfileLanguage::pacontrol, MapGaps::zero, {}, 2);
    EXPECT_EQ(cmd("3F 80 00 00 00 02 8A 87"), "00 00 00 00 00 01 C0 14") << "not in home position";
    EXPECT_EQ(cmd("00 00 00 00 00 00 06 03"), "00 00 00 00 00 1F 20 00") << "ONLINE; both are enabled";
    EXPECT_TRUE(port.commands.empty());
    EXPECT_EQ(cmd("41 20 00 00 00 02 8A 87"), "44 9A 40 00 00 1F 80 00") << "recognised, at 1234.0";
    ASSERT_TRUE(next<Move>());
    EXPECT_EQ(port.commands.front().axis, y);
    EXPECT_TRUE(port.commands.front().until_done);
    EXPECT_EQ(next<Move>()->target, 100);
    EXPECT_EQ(next<Move>()->velocity, 1000);
    port.edit(y, [](AxisPicture& p) { p.position = 5000; });
    EXPECT_EQ(at("04 00 00 00 04"), "04 08 43 FA 00 00 00 1F 80 00") << "under way, at 500.0";
    port.answer(Outcome::done);
    EXPECT_EQ(at("04 00 00 00 04"), "04 08 43 FA 00 00 00 1F A0 00");
    EXPECT_EQ(cmd("41 20 00 00 00 03 0A 87"), "00 00 00 00 00 1F 40 20") << "axis 3";
    port.edit(y, [](AxisPicture& p) { p.flags |= flag_moving; });
    EXPECT_EQ(cmd("41 20 00 00 00 02 8A 94"), "00 00 00 00 00 1F C0 2A") << "it still moves";
}

TEST_F(PaControl, ALateResultIsNotANewCommands) {
    put(ProfileLanguage::pacontrol);
    online();
    (void)cmd("41 20 00 00 00 01 0A 87");
    EXPECT_EQ(cmd("00 00 00 00 00 01 99 0B").substr(18), "A0 00") << "another command";
    port.answer(Outcome::failed, Reason::interrupted);
    EXPECT_EQ(at("04 00 03 00 01"), "04 02 A0 00") << "is not failed by the one before";
    (void)cmd("41 20 00 00 00 01 0A 87");
    port.refuse(Reason::out_of_range);
    EXPECT_EQ(at("04 00 03 00 01"), "04 02 40 41") << "position outside range";
}

TEST_F(PaControl, AxisParametersAreWrittenInHomePositionAlone) {
    put(ProfileLanguage::pacontrol);
    EXPECT_EQ(cmd("00 00 00 00 01 01 98 00"), "42 C8 00 00 00 01 A0 00") << "traverse speed 100.0 of the site";
    EXPECT_EQ(cmd("43 48 00 00 01 01 08 00"), "43 48 00 00 00 01 20 00") << ":= 200.0";
    EXPECT_EQ(cmd("00 00 00 00 01 08 98 00"), "C2 48 00 00 00 01 A0 00") << "minimum traverse area -50";
    EXPECT_EQ(cmd("00 00 00 00 01 09 18 00"), "42 48 00 00 00 01 20 00");
    EXPECT_EQ(cmd("BF 80 00 00 01 01 88 00"), "00 00 00 00 00 01 C0 29") << "a speed below 0";
    EXPECT_EQ(cmd("7F C0 00 00 01 01 08 00"), "00 00 00 00 00 01 40 29") << "no number";
    EXPECT_EQ(cmd("00 00 00 00 02 01 98 00"), "00 00 00 00 00 01 C0 20");
    EXPECT_EQ(cmd("00 00 00 00 01 33 18 00"), "00 00 00 00 00 01 40 21");
    EXPECT_EQ(cmd("00 00 00 00 00 00 86 03"), "00 00 00 00 00 1F A0 00");
    EXPECT_EQ(cmd("00 00 00 00 01 01 18 00"), "00 00 00 00 00 1F 40 14") << "in ONLINE";
}

TEST_F(PaControl, TheControlWordIsLowActiveAndTheFormatLatched) {
    put(ProfileLanguage::pacontrol);
    EXPECT_EQ(at("06 00 04 80 07"), "06 00 04 80 07");
    EXPECT_EQ(at("04 00 04 00 01"), "04 02 00 03") << "integers only once it leaves home position";
    EXPECT_EQ(at("06 00 08 00 00").substr(0, 2), "86") << "half of a control word";
    EXPECT_EQ(at("06 00 04 80 17"), "06 00 04 80 17");
    EXPECT_EQ(at("04 00 04 00 01"), "04 02 84 03") << "ONLINE, integers";
    EXPECT_EQ(at("04 00 0C 00 02"), "04 04 00 12 D4 50") << "1234.0 as 1/1000";
    EXPECT_EQ(at("06 00 04 00 07"), "06 00 04 00 07");
    EXPECT_EQ(at("04 00 04 00 01"), "04 02 84 03") << "as they were taken";
    (void)order<Halt>("06 00 04 00 05");
    EXPECT_EQ(at("04 00 02 00 01"), "04 02 00 23") << "ONLINE stopped";
    EXPECT_EQ(at("06 00 04 00 07"), "06 00 04 00 07");
    EXPECT_EQ(at("06 00 04 00 17"), "06 00 04 00 17");
    EXPECT_EQ(at("04 00 02 00 01"), "04 02 00 1F") << "goes on";
    (void)order<Halt>("06 00 04 00 00");
    EXPECT_EQ(at("04 00 02 00 01"), "04 02 00 01") << "cancelled: home position";
}

TEST_F(PaControl, AnAxisInterfaceBlocksTheAxisCommands) {
    put(ProfileLanguage::pacontrol);
    EXPECT_EQ(at("10 00 08 00 06 0C 00 00 00 01 00 00 00 00 00 00 00 00"), "10 00 08 00 06");
    EXPECT_TRUE(port.commands.empty()) << "not in ONLINE";
    online();
    EXPECT_EQ(cmd("41 20 00 00 00 01 0A 94"), "00 00 00 00 00 1F 40 14");
    EXPECT_EQ(cmd("00 00 00 00 00 01 99 0C"), "44 9A 40 00 00 1F A0 00") << "reading goes on";
    EXPECT_EQ(at("10 00 08 00 06 0C 00 00 80 05 03 E8 01 F4 00 00 00 00"), "10 00 08 00 06") << "to the lowest position, at half speed";
    ASSERT_TRUE(next<Move>());
    EXPECT_EQ(next<Move>()->target, -500);
    EXPECT_EQ(next<Move>()->velocity, 500);
    EXPECT_EQ(next<Move>()->acceleration, 10'000);
    EXPECT_EQ(at("04 00 08 00 02"), "04 04 00 00 07 81") << "enabled, active, referenced, switches free";
    port.answer(Outcome::failed, Reason::interrupted);
    EXPECT_EQ(at("04 00 0A 00 01"), "04 02 00 15");
    EXPECT_EQ(at("04 00 0E 00 01"), "84 02") << "there is no second axis";
    (void)order<Disable>("10 00 08 00 02 04 00 00 00 00");
}

TEST_F(PaControl, AnImageThatIsLeftFromBeforeStartsNothing) {
    put(ProfileLanguage::pacontrol);
    EXPECT_EQ(at("06 00 04 00 17"), "06 00 04 00 17") << "ONLINE is held";
    EXPECT_EQ(at("04 00 02 00 01"), "04 02 00 01") << "home position";
    EXPECT_EQ(at("06 00 04 00 07"), "06 00 04 00 07");
    EXPECT_EQ(at("06 00 04 00 17"), "06 00 04 00 17");
    EXPECT_EQ(at("04 00 02 00 01"), "04 02 00 1F");
    EXPECT_EQ(at("10 00 08 00 06 0C 00 00 00 45 03 E8 01 F4 41 20 00 00"), "10 00 08 00 06") << "a traverse whose start is held";
    EXPECT_TRUE(port.commands.empty());
    EXPECT_EQ(at("10 00 08 00 06 0C 00 00 00 41 03 E8 01 F4 41 20 00 00"), "10 00 08 00 06");
    (void)order<Move>("10 00 08 00 06 0C 00 00 00 45 03 E8 01 F4 41 20 00 00");
}

TEST_F(PaControl, AfterAStopOfSomebodyElseWhatIsRepeatedBeginsNothing) {
    put(ProfileLanguage::pacontrol);
    online();
    const std::string traverse = "10 00 08 00 06 0C 00 00 00 45 03 E8 01 F4 41 20 00 00";
    EXPECT_EQ(at("10 00 08 00 06 0C 00 00 00 41 03 E8 01 F4 41 20 00 00"), "10 00 08 00 06");
    (void)order<Move>(traverse);
    port.answer(Outcome::failed, Reason::interrupted);
    for (const std::uint16_t shown : {still_enabled, quick_stopped}) {
        port.edit(x, [&](AxisPicture& p) { stopped_by_another(p, shown); });
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(at(traverse), "10 00 08 00 06");
        EXPECT_TRUE(port.commands.empty()) << "the traverse's start is held: " << name_of(port.commands.front().body);
    }
    port.edit(x, [](AxisPicture& p) { p.statusword = still_enabled; });
    EXPECT_EQ(at("10 00 08 00 06 0C 00 00 00 41 03 E8 01 F4 41 20 00 00"), "10 00 08 00 06");
    (void)order<Move>(traverse);
}

struct LinMot : ProfileTest {
    std::string state() { return at("04 00 00 00 01").substr(6); }
    void up() {
        EXPECT_EQ(at("06 00 00 00 3E"), "06 00 00 00 3E");
        (void)order<Enable>("06 00 00 00 3F");
    }
};

TEST_F(LinMot, StatesFollowTheControlWord) {
    put(ProfileLanguage::linmot);
    EXPECT_EQ(state(), "00 00");
    EXPECT_EQ(at("06 00 00 00 3F"), "06 00 00 00 3F");
    EXPECT_TRUE(port.commands.empty()) << "locked until bit 0 was seen low";
    EXPECT_EQ(at("04 00 01 00 01").substr(6), "0C 76") << "switch on, operation, voltage, no quick stop, locked; in target, homed";
    EXPECT_EQ(at("06 00 00 00 3E"), "06 00 00 00 3E");
    EXPECT_EQ(state(), "02 00");
    EXPECT_EQ(at("06 00 00 00 37"), "06 00 00 00 37");
    EXPECT_EQ(state(), "06 00");
    EXPECT_EQ(at("10 00 01 00 03 06 02 01 00 00 00 00"), "10 00 01 00 03");
    EXPECT_EQ(state(), "04 86") << "a motion command outside its state";
    EXPECT_EQ(at("06 00 00 00 B7"), "06 00 00 00 B7");
    EXPECT_EQ(state(), "00 00");
    EXPECT_EQ(at("06 00 00 00 3E"), "06 00 00 00 3E");
    EXPECT_EQ(at("06 00 00 00 3F"), "06 00 00 00 3F");
    EXPECT_EQ(state(), "05 00") << "until the axis is enabled";
    ASSERT_TRUE(next<Enable>());
    EXPECT_TRUE(port.commands.front().until_done);
    port.answer(Outcome::done);
    EXPECT_EQ(state(), "08 C1") << "homed, in target, count 1";
    EXPECT_EQ(at("06 00 00 00 7F"), "86 04") << "go to position: the drive's own setting";
    (void)order<Disable>("06 00 00 00 37");
    EXPECT_EQ(state(), "06 00");
}

TEST_F(LinMot, ACommandPerCountWithItsParameters) {
    put(ProfileLanguage::linmot);
    up();
    // 0101h: to 1000 (0.1 um), 2000 (1e-6 m/s), 30 and 40 (1e-5 m/s^2), low words first
    const Move m = order<Move>("10 00 01 00 09 12 01 01 03 E8 00 00 07 D0 00 00 00 1E 00 00 00 28 00 00");
    EXPECT_EQ(m.target, 10'000);
    EXPECT_EQ(m.velocity, 200'000);
    EXPECT_EQ(m.acceleration, 30'000);
    EXPECT_EQ(m.deceleration, 40'000);
    EXPECT_EQ(at("06 00 01 01 01"), "06 00 01 01 01");
    EXPECT_TRUE(port.commands.empty()) << "the same count";
    EXPECT_EQ(order<Move>("06 00 01 02 02").velocity, 1000) << "0202h: speed and ramps of the site, target still in the buffer";
    EXPECT_EQ(order<Move>("10 00 01 00 03 06 02 23 00 64 00 00").target, 11'000) << "target and increment";
    (void)order<Halt>("06 00 01 01 74");
    EXPECT_EQ(order<SetPosition>("10 00 01 00 03 06 00 95 00 05 00 00").position, 50);
    EXPECT_EQ(order<Move>("06 00 01 02 F6").kind, Move::Kind::velocity);
    result = [this] { port.answer(); };
    port.edit(x, [](AxisPicture& p) { p.flags |= flag_moving; });
    (void)order<QuickStop>("06 00 01 04 08");
    EXPECT_EQ(state(), "04 81") << "unknown motion command; it stops";
}

TEST_F(LinMot, AfterAStopOfSomebodyElseWhatIsRepeatedBeginsNothing) {
    put(ProfileLanguage::linmot);
    up();
    // The whole image: control word 013Fh (jog), header 0202h (a motion, count 2), its target.
    const std::string image_ = "10 00 00 00 04 08 01 3F 02 02 03 E8 00 00", same = "10 00 00 00 04";
    result = [this] { port.answer(); };
    EXPECT_EQ(at(image_), same);
    while (!port.commands.empty())
        port.answer();
    for (const std::uint16_t shown : {still_enabled, quick_stopped, still_enabled}) {
        port.edit(x, [&](AxisPicture& p) { stopped_by_another(p, shown); });
        for (int i = 0; i < 3; ++i)
            EXPECT_EQ(at(image_), same);
        EXPECT_TRUE(port.commands.empty()) << "at " << shown << ": " << name_of(port.commands.front().body);
    }
    // Its own edges: the enabling bits return, and the next count is a command.
    EXPECT_EQ(at("06 00 00 00 3E"), "06 00 00 00 3E");
    while (!port.commands.empty())
        port.answer();
    EXPECT_EQ(at("06 00 00 00 3F"), "06 00 00 00 3F");
    ASSERT_TRUE(next<Enable>());
    port.answer(Outcome::done);
    EXPECT_EQ(order<Move>("06 00 01 02 03").target, 10'000);
}

TEST_F(LinMot, HomingWaitsForItsBit) {
    put(ProfileLanguage::linmot);
    up();
    EXPECT_EQ(at("06 00 00 08 3F"), "06 00 00 08 3F");
    EXPECT_EQ(state(), "09 00");
    ASSERT_TRUE(next<Home>());
    port.answer(Outcome::done);
    EXPECT_EQ(state(), "09 0F");
    EXPECT_EQ(at("06 00 00 00 3F"), "06 00 00 00 3F");
    EXPECT_EQ(state().substr(0, 2), "08");
    (void)order<Halt>("06 00 00 00 1F");
    EXPECT_EQ(state(), "0D 00") << "frozen";
    (void)order<Move>("06 00 00 01 3F");
    EXPECT_EQ(state(), "10 0F");
    (void)order<Halt>("06 00 00 00 3F");
    EXPECT_EQ(state().substr(0, 2), "08");
}

TEST_F(LinMot, AFaultIsAnErrorUntilItIsAcknowledged) {
    put(ProfileLanguage::linmot);
    up();
    port.edit(x, [](AxisPicture& p) {
        p.flags |= flag_fault;
        p.statusword = 8;
    });
    EXPECT_EQ(state(), "04 0C");
    result = [this] { port.answer(); };
    EXPECT_EQ(at("06 00 00 00 BF"), "06 00 00 00 BF");
    EXPECT_TRUE(next<ResetFault>());
    port.answer();
    port.edit(x, [](AxisPicture& p) {
        p.flags &= static_cast<std::uint16_t>(~flag_fault);
        p.statusword = 0x0640;
    });
    EXPECT_EQ(state(), "00 00");
}

TEST_F(ProfileTest, TheBlockEndsWithTheAxis) {
    Cia402Block block(image.standard(), 2);
    image.set_map(11, &block);
    EXPECT_EQ(ask("03 00 02 00 02", 11), "03 04 00 00 30 34");
    EXPECT_EQ(ask("03 00 3F 00 02", 11), "83 02");
    result = [this] {
        EXPECT_EQ(port.commands.front().axis, y);
        port.answer();
    };
    EXPECT_EQ(ask("06 00 20 00 06", 11), "06 00 20 00 06");
    EXPECT_EQ(ask("06 00 00 00 06", 11), "86 02") << "the status word";
    image.set_map(11, nullptr);
}

}  // namespace
}  // namespace axisgate::modbus
