// The locks of the door: which functions are served, and which writes a read-only door accepts: only stops, verified with the CiA 402
// profile in all of its states.
#include <fmt/core.h>
#include <gtest/gtest.h>

#include "gateway/axis/cia402.hpp"
#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus::test {
namespace {
std::vector<std::uint8_t> write1(std::uint16_t address, std::uint16_t word) {
    return {6, static_cast<std::uint8_t>(address >> 8), static_cast<std::uint8_t>(address), static_cast<std::uint8_t>(word >> 8),
            static_cast<std::uint8_t>(word)};
}

struct Drive {
    Cia402Axis profile;
    AxisFeedback feedback;
    Instant now = at_ns(1'000'000);
    Drive() {
        profile.on_presence(Presence::twin);
        feedback.power = AxisFeedback::Power::off;
        feedback.target_reached = true;
        say();
    }
    void say() {
        now += std::chrono::milliseconds(1);
        feedback.at = now;
        (void)profile.on_feedback(feedback, now);
    }
    Cia402Axis::Decision word(std::uint16_t cw, std::optional<std::int32_t> target = std::nullopt) {
        ProcessData d;
        d.controlword = cw;
        if (target) {
            d.mode = cia402::mode_profile_position;
            d.target_position = target;
        }
        auto decision = profile.on_process_data(d);
        for (const auto& o : decision.orders) {
            if (std::holds_alternative<Enable>(o)) feedback.power = AxisFeedback::Power::on;
            if (std::holds_alternative<Disable>(o)) {
                feedback.power = AxisFeedback::Power::off;
                feedback.moving = false;  // adapters stop an axis before they switch it off
            }
            if (std::holds_alternative<Move>(o)) feedback.moving = true;
            if (std::holds_alternative<Halt>(o) || std::holds_alternative<QuickStop>(o)) feedback.moving = false;
            say();
            profile.on_order_result(o, true, now);
        }
        say();
        return decision;
    }
};

/// An axis in each state that control words lead to, moving and standing.
std::vector<std::pair<std::string, Drive>> states() {
    std::vector<std::pair<std::string, Drive>> out;
    const auto add = [&](std::string name, std::initializer_list<std::uint16_t> words) {
        Drive d;
        for (const auto w : words)
            w == 0x1F ? d.word(w, 64000) : d.word(w);
        out.emplace_back(std::move(name), d);
    };
    add("switch on disabled", {});
    add("ready", {0x06});
    add("switched on", {0x06, 0x07});
    add("enabled", {0x06, 0x07, 0x0F});
    add("moving", {0x06, 0x07, 0x0F, 0x1F});
    add("moving, set-point bit off", {0x06, 0x07, 0x0F, 0x1F, 0x0F});
    add("halted", {0x06, 0x07, 0x0F, 0x1F, 0x11F});
    add("quick stop active", {0x06, 0x07, 0x0F, 0x1F, 0x02});
    Drive fault;
    fault.feedback.fault = true;
    fault.say();
    out.emplace_back("fault", fault);
    return out;
}

TEST(ModbusAccess, WhatAReadOnlyDoorTakesOnlyStopsInEveryState) {
    int taken = 0, refused = 0;
    for (std::uint32_t w = 0; w <= 0xFFFF; w = w < 0x200 ? w + 1 : w * 2 - 0x1FF) {
        const auto word = static_cast<std::uint16_t>(w);
        if (!stops_only(1, write1(32, word))) {
            ++refused;
            continue;
        }
        ++taken;
        for (const auto& [name, at] : states()) {
            Drive d = at;
            // An axis without a brake falls when its power is switched off, so a powered axis must keep it.
            const bool powered = d.feedback.power == AxisFeedback::Power::on;
            for (const auto& o : d.word(word).orders) {
                EXPECT_TRUE(std::holds_alternative<QuickStop>(o) || std::holds_alternative<Halt>(o) ||
                            (std::holds_alternative<Disable>(o) && !powered))
                    << fmt::format("{:#x}, axis {}: {}", word, name, name_of(o));
            }
            EXPECT_FALSE(d.feedback.moving) << fmt::format("{:#x}, axis {}", word, name);
            EXPECT_NE(d.profile.state(), PowerState::operation_enabled) << fmt::format("{:#x}, axis {}", word, name);
        }
    }
    EXPECT_GE(taken, 32) << "bit 1 set, bits 2, 4 and 7 not: all that the other five of the lower nine can be";
    EXPECT_GT(refused, 300);
    for (const auto usual : std::initializer_list<std::uint16_t>{0x02, 0x03, 0x0B})
        EXPECT_TRUE(stops_only(1, write1(32, usual))) << usual;
    for (const auto not_a_stop :
         std::initializer_list<std::uint16_t>{0x00, 0x01, 0x04, 0x06, 0x07, 0x0D, 0x0F, 0x1F, 0x80, 0x82, 0x10F, 0x12, 0x10})
        EXPECT_FALSE(stops_only(1, write1(32, not_a_stop))) << not_a_stop;
}

struct ReadOnlyRow {
    const char* what;
    const char* pdu;
    const char* answer;
    std::uint8_t unit = 1;
};

TEST(ModbusAccess, AReadOnlyDoorTakesAStopByItselfAndNoOtherWrite) {
    ResponderBench bench;
    bench.port.add_axis(1);
    bench.responder.set_read_only(true);
    for (const auto& [what, pdu, answer, unit] :
         std::vector<ReadOnlyRow>{{"read", "03 00 20 00 01", "03 02 00 00"},
                                  {"quick stop", "06 00 20 00 02", "06 00 20 00 02"},
                                  {"switch off", "06 00 20 00 00", "86 01"},
                                  {"quick stop, unit 0", "06 00 20 00 02", "06 00 20 00 02", 0},
                                  {"quick stop, unit 255", "06 00 20 00 02", "06 00 20 00 02", 255},
                                  {"function 16, one register", "10 00 20 00 01 02 00 02", "10 00 20 00 01"},
                                  {"enable", "06 00 20 00 0F", "86 01"},
                                  {"ready", "06 00 20 00 06", "86 01"},
                                  {"fault reset", "06 00 20 00 80", "86 01"},
                                  {"stop with a fault reset", "06 00 20 00 82", "86 01"},
                                  {"stop with a set-point", "06 00 20 00 12", "86 01"},
                                  {"halt", "06 00 20 01 0F", "86 01"},
                                  {"another register", "06 00 21 00 02", "86 01"},
                                  {"a register that is none", "06 00 00 00 02", "86 01"},
                                  {"stop and mode", "10 00 20 00 02 04 00 02 00 01", "90 01"},
                                  {"wrong count of bytes", "10 00 20 00 01 03 00 02 00", "90 01"},
                                  {"mask write", "16 00 20 00 00 00 02", "96 01"},
                                  {"read and write", "17 00 00 00 01 00 20 00 01 02 00 02", "97 01"},
                                  {"a coil", "05 00 00 FF 00", "85 01"},
                                  {"a user map's unit", "06 00 20 00 02", "86 01", 2},
                                  {"an axis that is not there", "06 FF E0 00 02", "86 0A"}}) {
        EXPECT_EQ(bench.ask(pdu, unit), answer) << what;
    }
    bench.responder.set_read_only(false);
    EXPECT_EQ(bench.ask("06 00 20 00 06"), "06 00 20 00 06");
}

TEST(ModbusAccess, AFunctionThatIsLeftOutStaysOut) {
    Access a;
    a.read_only = true;
    EXPECT_TRUE(a.serves(1, write1(32, 2)));
    a.functions.set(3);
    EXPECT_FALSE(a.serves(1, write1(32, 2))) << "whoever leaves function 6 out has no stop either";
    EXPECT_TRUE(a.serves(1, std::vector<std::uint8_t>{3, 0, 0, 0, 1}));
    EXPECT_FALSE(a.serves(1, std::vector<std::uint8_t>{0xC8}));
}
}  // namespace
}  // namespace axisgate::modbus::test
