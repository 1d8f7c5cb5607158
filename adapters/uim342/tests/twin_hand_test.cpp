// The tester's hand: power, silence, held shaft and lost pulses with both stall behaviours, alarms, encoder, battery, position.
// In: hand items. Out: what a host sees on the wire.
// Never reaches inside.
#include "adapters/uim342/tests/twin_bench.hpp"

namespace axisgate::uim342::test {
namespace {

constexpr const char* rt_stall = "5A 00 1D 00 00 00";

Value item(Twin& t, const std::string& name) {
    for (const HandItem& i : t.hand()) {
        if (i.name == name) return i.value;
    }
    return {};
}

TEST(TwinHand, ItemsAndTheirValues) {
    Bench b;
    const std::vector<std::string> names = {"power",          "silent",         "stall",       "inputs",       "home_switch",
                                            "limit_positive", "limit_negative", "temperature", "inject_error", "lost_pulses",
                                            "encoder_error",  "battery_low",    "position",    "shaft_turns"};
    std::vector<std::string> got;
    for (const HandItem& i : b.drive().hand()) {
        got.push_back(i.name);
        EXPECT_FALSE(i.description.empty());
        EXPECT_TRUE(known(i.value)) << i.name;
        EXPECT_EQ(i.writable, i.name != "shaft_turns");
    }
    EXPECT_EQ(got, names);
    EXPECT_EQ(item(b.drive(), "power"), Value{true});
    b.inputs(5);
    EXPECT_EQ(item(b.drive(), "inputs"), Value{std::int64_t{5}});
    EXPECT_EQ(item(b.drive(), "home_switch"), Value{true}) << "the switches are the inputs by another name";
    EXPECT_EQ(item(b.drive(), "limit_positive"), Value{false});
    b.hand("limit_positive", true);
    b.hand("home_switch", false);
    EXPECT_EQ(item(b.drive(), "inputs"), Value{std::int64_t{6}});
    EXPECT_EQ(item(b.drive(), "limit_negative"), Value{true});
    b.hand("temperature", 61.5);
    EXPECT_EQ(item(b.drive(), "temperature"), Value{61.5});
    b.hand("stall", true);
    EXPECT_EQ(item(b.drive(), "stall"), Value{true});
    b.hand("position", 17);
    EXPECT_EQ(item(b.drive(), "position"), Value{std::int64_t{17}});
}

TEST(TwinHand, WrongValuesAreExplained) {
    Bench b;
    Out out;
    const auto fault = [&](const char* name, const Value& v) { return b.drive().set_hand(name, v, b.now(), out); };
    EXPECT_NE(fault("power", std::string("maybe")), "");
    EXPECT_NE(fault("silent", std::int64_t{2}), "");
    EXPECT_NE(fault("stall", Value{}), "");
    EXPECT_NE(fault("inputs", std::int64_t{8}), "");
    EXPECT_NE(fault("inputs", std::int64_t{-1}), "");
    EXPECT_NE(fault("inject_error", std::int64_t{0x1C}), "");
    EXPECT_NE(fault("inject_error", std::int64_t{0x33}), "");
    EXPECT_NE(fault("lost_pulses", std::int64_t{-1}), "");
    EXPECT_NE(fault("lost_pulses", std::int64_t{5}), "") << "driver off";
    EXPECT_NE(fault("position", std::string("here")), "");
    EXPECT_NE(fault("position", 1e300), "");
    EXPECT_NE(fault("temperature", 900.0), "");
    EXPECT_NE(fault("limit_positive", std::int64_t{2}), "");
    EXPECT_NE(fault("no_such_thing", true), "");
    b.setup({"95 01"});
    EXPECT_NE(fault("position", std::int64_t{5}), "") << "the driver holds the shaft";
    EXPECT_TRUE(out.frames.empty());
}

TEST(TwinHand, PowerOffIsDeafAndForgets) {
    Bench b;
    b.setup({"95 01", "9D E8 03 00 00", "96"});
    b.pass_ms(1000);
    EXPECT_TRUE(b.hand("power", false).empty());
    EXPECT_TRUE(b.send("95").empty());
    EXPECT_TRUE(b.inputs(1).empty());
    EXPECT_TRUE(b.pass_ms(1000).empty());
    EXPECT_FALSE(b.mechanics().powered);
    EXPECT_EQ(b.drive().deadline(), never);
    EXPECT_TRUE(b.hand("power", true).empty());
    EXPECT_EQ(b.ask("91 00"), "11 00 08 01 00 00 00 00 00") << "IN1 is high without an edge";
    EXPECT_EQ(b.position(), 0);
    EXPECT_TRUE(b.hand("power", true).empty()) << "on again: nothing";
    EXPECT_EQ(b.ask("95"), "15 00");
}

TEST(TwinHand, SilentHearsAndActs) {
    Bench b;
    b.hand("silent", true);
    EXPECT_TRUE(b.send("95 01").empty());
    EXPECT_TRUE(b.send("FF").empty());
    EXPECT_TRUE(b.inputs(1).empty());
    b.hand("silent", false);
    EXPECT_EQ(b.ask("95"), "15 01");
    EXPECT_EQ(b.ask("8F 00"), "0F 00 32 FF 00 00 00");
}

TEST(TwinHand, HeldShaftStallsInClosedLoop) {
    for (const bool freewheel : {false, true}) {
        Bench b;
        b.setup({freewheel ? "B4 03 01 00" : "B4 03 00 00", "9C " + le32(100000), "95 01", "9D 10 27 00 00", "96"});
        b.pass_ms(2000);
        const int at = b.position();
        EXPECT_EQ(at, 15000);
        EXPECT_TRUE(b.hand("stall", true).empty());
        // 10000 pulse/s: the tolerance of 100 pulses is reached after 10 ms.
        const Instant held = b.now();
        EXPECT_EQ(b.pass_ms(1000), Lines{rt_stall});
        EXPECT_EQ(b.last_instant() - held, std::chrono::milliseconds(10));
        EXPECT_TRUE(b.stalled());
        EXPECT_TRUE(b.error());
        EXPECT_TRUE(b.stopped());
        EXPECT_FALSE(b.locked()) << "holding the shaft is not the lock";
        EXPECT_EQ(b.position(), at) << "the encoder did not move";
        EXPECT_EQ(b.ask("95"), freewheel ? "15 00" : "15 01");
        EXPECT_EQ(b.ask("91 00 00").substr(9, 2), "01") << "TLIF and ERR go by MS[0]=0";
        // Let go and go on from where it is.
        b.hand("stall", false);
        b.setup({"95 01", "A0 " + le32(at + 500), "9E E8 03 00 00", "96"});
        EXPECT_EQ(b.pass_ms(5000).size(), 1u);
        EXPECT_EQ(b.position(), at + 500);
    }
}

TEST(TwinHand, StallOnTheSdRamp) {
    Bench b;
    b.setup({"9C " + le32(100000), "95 01", "9D 10 27 00 00", "96"});
    b.pass_ms(2000);
    b.hand("stall", true);
    b.pass_ms(11);
    EXPECT_TRUE(b.stalled());
    EXPECT_FALSE(b.stopped());
    EXPECT_EQ(b.ask("96"), "0F 00 3F 96 00 00 00");
    b.pass_ms(100);
    EXPECT_TRUE(b.stopped());
    // Held still: the next start stalls again.
    b.setup({"96"});
    EXPECT_EQ(b.pass_ms(1000), Lines{rt_stall});
}

TEST(TwinHand, ToleranceIsASetting) {
    Bench b;
    b.setup({"BD 01 0A 00", "95 01", "9B E8 03 00 00", "9D E8 03 00 00"});
    b.hand("stall", true);
    b.setup({"96"});
    const Instant began = b.now();
    EXPECT_EQ(b.pass_ms(1000), Lines{rt_stall});
    EXPECT_EQ(b.last_instant() - began, std::chrono::milliseconds(10));
}

TEST(TwinHand, OpenLoopKnowsNoStall) {
    Bench b;
    b.setup({"86 06 00 00", "95 01", "9F " + le32(5000), "9E 10 27 00 00"});
    b.hand("stall", true);
    b.setup({"96"});
    EXPECT_EQ(b.pass_ms(5000), Lines{"5A 29 00 00 00 " + le32(5000)});
    EXPECT_EQ(b.position(), 5000) << "the drive counts what it sent";
    EXPECT_FALSE(b.stalled());
    EXPECT_DOUBLE_EQ(b.mechanics().position, 0) << "the shaft knows better";
    b.hand("stall", false);
    b.setup({"96"});
    b.pass_ms(5000);
    EXPECT_EQ(b.position(), 10000);
    EXPECT_DOUBLE_EQ(b.mechanics().position, 5000) << "and stays behind";
    b.setup({"A1"});
    EXPECT_DOUBLE_EQ(b.mechanics().position, 0) << "a new origin is the zero of both";
    // Closing the loop: the counter takes the encoder's place.
    b.setup({"96"});
    b.pass_ms(1000);
    EXPECT_TRUE(b.hand("lost_pulses", 40).empty());
    b.pass_ms(4000);
    EXPECT_EQ(b.position(), 5000);
    EXPECT_DOUBLE_EQ(b.mechanics().position, 4960);
    b.setup({"86 06 01 00"});
    EXPECT_EQ(b.position(), 4960);
}

TEST(TwinHand, HeldBelowTheToleranceArrivesWhenLetGo) {
    Bench b;
    b.setup({"95 01", "9F 32 00 00 00", "9E E8 03 00 00"});
    b.hand("stall", true);
    b.setup({"96"});
    EXPECT_TRUE(b.pass_ms(1000).empty());
    EXPECT_TRUE(b.stopped());
    EXPECT_FALSE(b.in_position());
    EXPECT_EQ(b.position(), 0);
    EXPECT_EQ(b.hand("stall", false), Lines{"5A 29 00 00 00 " + le32(50)});
    EXPECT_TRUE(b.in_position());
    EXPECT_EQ(b.position(), 50);
}

TEST(TwinHand, LostPulsesAddUp) {
    for (const bool freewheel : {false, true}) {
        Bench b;
        b.setup({freewheel ? "B4 03 01 00" : "B4 03 00 00", "95 01", "9D E8 03 00 00", "96"});
        b.pass_ms(1000);
        EXPECT_TRUE(b.hand("lost_pulses", 60).empty());
        EXPECT_EQ(item(b.drive(), "lost_pulses"), Value{std::int64_t{60}});
        EXPECT_TRUE(b.hand("lost_pulses", 39).empty());
        EXPECT_EQ(b.hand("lost_pulses", 1), Lines{rt_stall});
        EXPECT_TRUE(b.stalled());
        b.pass_ms(100);
        EXPECT_TRUE(b.stopped());
        EXPECT_EQ(b.ask("95"), freewheel ? "15 00" : "15 01");
    }
    Bench b;
    b.setup({"95 01"});
    EXPECT_TRUE(b.hand("lost_pulses", 99).empty());
    EXPECT_TRUE(b.hand("lost_pulses", 0).empty());
    EXPECT_TRUE(b.hand("lost_pulses", 99).empty()) << "forgotten";
    EXPECT_EQ(b.hand("lost_pulses", 1), Lines{rt_stall}) << "at rest too";
    EXPECT_TRUE(b.stopped());
    EXPECT_EQ(b.ask("96"), "16 00 00 00 00");
    EXPECT_TRUE(b.hand("lost_pulses", 99).empty());
    b.setup({"9D E8 03 00 00", "96"});
    EXPECT_TRUE(b.hand("lost_pulses", 99).empty()) << "a start begins anew";
    // Pulses lost before count for a held shaft.
    b.pass_ms(1000);
    b.hand("stall", true);
    const Instant held = b.now();
    EXPECT_EQ(b.pass_ms(100), Lines{rt_stall});
    EXPECT_EQ(b.last_instant() - held, std::chrono::milliseconds(1));
}

TEST(TwinHand, AlarmsByInjection) {
    for (const int code : {0x0A, 0x19, 0x1A, 0x1B, 0x1D, 0x1E, 0x1F}) {
        Bench b;
        b.setup({"95 01", "9D E8 03 00 00", "96"});
        for (const char* ie : {"87 00 00 00", "87 01 00 00", "87 02 00 00", "87 08 00 00"})
            b.setup({ie});
        char want[24];
        std::snprintf(want, sizeof want, "5A 00 %02X 00 00 00", code);
        EXPECT_EQ(b.hand("inject_error", code), Lines{want}) << "alarms have no mask";
        EXPECT_TRUE(b.error());
        EXPECT_EQ(item(b.drive(), "inject_error"), Value{std::int64_t{code}});
        EXPECT_TRUE(b.hand("inject_error", code).empty()) << "once per entry";
        EXPECT_TRUE(b.pass_ms(100).empty());
        EXPECT_EQ(b.stopped(), code == 0x0A || code == 0x1A || code == 0x1B || code == 0x1D) << "limits stop with SD [L1409]";
        EXPECT_EQ(b.locked(), code == 0x0A);
        EXPECT_EQ(b.stalled(), code == 0x1D);
        EXPECT_TRUE(b.hand("inject_error", 0).empty());
        EXPECT_EQ(b.hand("inject_error", code), Lines{want}) << "a new entry";
        EXPECT_EQ(b.ask("8F 00"), "0F 00 00 00 00 00 00") << "alarms are not in the list of errors";
        (void)b.ask("91 00 00");
        EXPECT_FALSE(b.error());
    }
}

TEST(TwinHand, EncoderAndBattery) {
    Bench b;
    EXPECT_EQ(b.hand("encoder_error", true), Lines{"5A 00 1E 00 00 00"});
    EXPECT_TRUE(b.hand("encoder_error", true).empty());
    EXPECT_EQ(b.hand("battery_low", true), Lines{"5A 00 1F 00 00 00"});
    EXPECT_EQ(b.ask("BD 03"), "3D 03 00 00");
    // Still so at the next power-on: told again, and kept as the power-on error.
    EXPECT_EQ(b.send("7E 01"), (Lines{"5A 00 1E 00 00 00", "5A 00 1F 00 00 00"}));
    EXPECT_EQ(b.ask("8F 06"), "0F 06 1E 00 00 00 00");
    EXPECT_EQ(b.ask("8F 06 00"), "0F 06 00 00 00 00 00");
    EXPECT_EQ(b.ask("8F 06"), "0F 06 00 00 00 00 00");
    b.hand("encoder_error", false);
    b.hand("battery_low", false);
    EXPECT_EQ(b.ask("BD 03"), "3D 03 01 00");
    EXPECT_TRUE(b.send("7E 01").empty());
    EXPECT_EQ(b.ask("8F 06"), "0F 06 00 00 00 00 00");
}

TEST(TwinHand, TurnedByHandWhileFree) {
    Bench b;
    b.setup({"95 01", "9F E8 03 00 00", "9E 10 27 00 00", "96"});
    b.pass_ms(3000);
    b.setup({"95 00"});
    b.hand("position", 4321);
    EXPECT_EQ(b.position(), 4321) << "the encoder sees it";
    EXPECT_EQ(b.relative(), 1000) << "frozen at rest";
    b.setup({"95 01", "A0 00 00 00 00", "96"});
    EXPECT_EQ(b.pass_ms(5000), Lines{"5A 29 00 00 00 00 00 00 00"});
    // In open loop nobody counts.
    b.setup({"86 06 00 00", "95 00"});
    b.hand("position", 100);
    EXPECT_EQ(b.position(), 0);
    EXPECT_DOUBLE_EQ(b.mechanics().position, 100);
}

TEST(TwinHand, MechanicsOfChannelOneAlone) {
    Bench b;
    b.setup({"95 01", "9D E8 03 00 00", "96"});
    b.pass_ms(1000);
    EXPECT_DOUBLE_EQ(b.mechanics().velocity, 1000);
    EXPECT_TRUE(b.mechanics().powered);
    EXPECT_EQ(b.drive().mechanics(2, b.now()).velocity, 0);
    // Asked for a later instant without any event in between: closed form.
    EXPECT_NEAR(b.drive().mechanics(1, b.now() + std::chrono::hours(1)).position, 950 + 3'600'000.0, 1e-3);
}

}  // namespace
}  // namespace axisgate::uim342::test
