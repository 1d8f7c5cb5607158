// A simulated MACS on the bus, for the tests of its twin: parameters by number and axis, power, motion, simulated hand, direct mode.
#pragma once

#include <algorithm>
#include <string>

#include "adapters/aposs/tests/macs.hpp"
#include "adapters/cia402/tests/twin_bench.hpp"
#include "gateway/protocols/canopen/message.hpp"

namespace axisgate::aposs::test {
using namespace std::chrono_literals;
using canopen::Abort;

/// Parameter n of axis k (from 0) is 2300h + k, sub n + 1.
struct Macs : cia402_drive::twin::test::Bench {
    Macs() : Bench(macs()) {}
    std::int64_t get(int n, int axis = 0) { return read(static_cast<std::uint16_t>(0x2300 + axis), static_cast<std::uint8_t>(n + 1)); }
    Abort set(int n, std::int64_t v, int axis = 0) {
        return write(static_cast<std::uint16_t>(0x2300 + axis), static_cast<std::uint8_t>(n + 1), v, 4);
    }
    Abort saveprom() { return write(0x1010, 1, 0x65766173, 4); }
    void hand(const std::string& name, const Value& v) { EXPECT_EQ(twin->set_hand(name, v, now, out), "") << name; }
    void off_and_on() {
        hand("power", Value{false});
        pass(10ms);
        hand("power", Value{true});
    }
    void enable_axis(int axis, int mode = 1) {
        const auto shift = static_cast<std::uint16_t>(0x800 * axis);
        ASSERT_EQ(write(static_cast<std::uint16_t>(0x6060 + shift), 0, mode, 1), Abort::none);
        for (const unsigned cw : {6u, 7u, 0xFu})
            ASSERT_EQ(write(static_cast<std::uint16_t>(0x6040 + shift), 0, cw, 2), Abort::none);
        ASSERT_EQ(status_of(axis) & 0x6F, 0x27);
    }
    std::int64_t status_of(int axis) { return read(static_cast<std::uint16_t>(0x6041 + 0x800 * axis)) & 0xFFFF; }
    std::int64_t error() { return read(0x603F) & 0xFFFF; }
    std::int64_t position_of(int axis) { return read(static_cast<std::uint16_t>(0x6064 + 0x800 * axis)); }
    void go(int axis, std::int64_t to) {
        const auto shift = static_cast<std::uint16_t>(0x800 * axis);
        ASSERT_EQ(write(static_cast<std::uint16_t>(0x607A + shift), 0, to, 4), Abort::none);
        (void)write(static_cast<std::uint16_t>(0x6040 + shift), 0, 0x3F, 2);
        (void)write(static_cast<std::uint16_t>(0x6040 + shift), 0, 0x0F, 2);
    }
    /// The node has sent an EMCY with this code since the last transfer.
    bool reported(std::uint16_t code) const {
        return std::ranges::any_of(out.frames, [&](const auto& tx) {
            return tx.frame.id == 0x80u + node && tx.frame.size >= 2 && (tx.frame.storage[0] | tx.frame.storage[1] << 8) == code;
        });
    }
};

/// The answer of the direct mode.
inline std::string say(Macs& b, const std::string& line) {
    const std::string fault = b.twin->set_hand("direct", Value{line}, b.now, b.out);
    if (!fault.empty()) return fault;
    for (const HandItem& i : b.twin->hand())
        if (i.name == "direct") return to_text(i.value);
    return "?";
}
inline std::int64_t seen(Macs& b, const std::string& name) {
    for (const HandItem& i : b.twin->hand())
        if (i.name == name) return as_integer(i.value).value_or(-1);
    return -1;
}

}  // namespace axisgate::aposs::test
