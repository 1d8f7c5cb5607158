// The place of every value in both word orders, with constants whose halves and bytes differ.
#include <gtest/gtest.h>

#include <limits>

#include "gateway/doors/http/words.hpp"
#include "gateway/registers/register_map.hpp"
#include "tests/unit/modbus/fake_port.hpp"

namespace axisgate::registers {
namespace test = modbus::test;
namespace {

AxisPicture sample() {
    AxisPicture p;
    p.number = 1;
    p.statusword = 0xC127;
    p.mode_display = -3;
    p.position = 0x01020304;
    p.velocity = -2;
    p.position_demand = 0x11223344;
    p.error_code = 0xABCD;
    p.flags = 0x00B3;
    p.native_status = 0xA1B2C3D4;
    p.family_number = 5;
    p.setpoints_accepted = 0x7788;
    p.authority = http::clients;
    p.controlword = 0x001F;
    p.mode = 6;
    p.target_position = -2;
    p.profile_velocity = 0xFEDCBA98;
    p.profile_acceleration = 0x01020304;
    p.profile_deceleration = 0x05060708;
    p.target_velocity = -0x01020304;
    p.homing_method = -17;
    p.ever_seen = true;
    return p;
}

std::string shown(const AxisPicture& p, WordOrder order, std::uint16_t from, std::uint16_t count) {
    std::array<std::uint8_t, block_size> block;
    block.fill(0xEE);
    render(p, 0xCAFE0123, order, block.data());
    return test::hex(std::span(block).subspan(2 * std::size_t{from}, 2 * std::size_t{count}));
}

TEST(RegisterMap, RendersHighWordFirst) {
    EXPECT_EQ(shown(sample(), WordOrder::high_first, 0, 32),
              "C1 27 FF FD 01 02 03 04 FF FF FF FE 11 22 33 44 AB CD 00 B3 A1 B2 C3 D4 00 00 00 00 00 00 00 05 "
              "77 88 00 03 CA FE 01 23 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00 00");
    EXPECT_EQ(shown(sample(), WordOrder::high_first, 32, 16),
              "00 1F 00 06 FF FF FF FE FE DC BA 98 01 02 03 04 05 06 07 08 FE FD FC FC FF EF 00 00 00 00 00 00");
}

TEST(RegisterMap, RendersLowWordFirst) {
    EXPECT_EQ(shown(sample(), WordOrder::low_first, 0, 20),
              "C1 27 FF FD 03 04 01 02 FF FE FF FF 33 44 11 22 AB CD 00 B3 C3 D4 A1 B2 00 00 00 00 00 00 00 05 "
              "77 88 00 03 01 23 CA FE");
    EXPECT_EQ(shown(sample(), WordOrder::low_first, 32, 16),
              "00 1F 00 06 FF FE FF FF BA 98 FE DC 03 04 01 02 07 08 05 06 FC FC FE FD FF EF 00 00 00 00 00 00");
}

TEST(RegisterMap, LeavesTheParameterChannelAlone) { EXPECT_EQ(shown(sample(), WordOrder::high_first, 48, 2), "EE EE EE EE"); }

TEST(RegisterMap, PositionWrapsAndVelocityStops) {
    AxisPicture p;
    p.position = (std::int64_t{1} << 31) + 5;
    p.position_demand = -(std::int64_t{1} << 31) - 1;
    p.velocity = std::int64_t{1} << 40;
    EXPECT_EQ(shown(p, WordOrder::high_first, 2, 6), "80 00 00 05 7F FF FF FF 7F FF FF FF");
    p.velocity = -(std::int64_t{1} << 40);
    EXPECT_EQ(shown(p, WordOrder::high_first, 4, 2), "80 00 00 00");
}

TEST(RegisterMap, AgeIsMillisecondsAndStopsAtTheTop) {
    AxisPicture p;
    p.at = at_ns(5'000'000'000);
    EXPECT_EQ(age_ms(p, at_ns(6'000'000'000)), 0xFFFFFFFFu) << "never seen";
    p.ever_seen = true;
    EXPECT_EQ(age_ms(p, at_ns(5'000'000'000)), 0u);
    EXPECT_EQ(age_ms(p, at_ns(4'000'000'000)), 0u) << "seen later than the caller's now";
    EXPECT_EQ(age_ms(p, at_ns(5'000'999'999)), 0u);
    EXPECT_EQ(age_ms(p, at_ns(5'001'000'000)), 1u);
    EXPECT_EQ(age_ms(p, at_ns(5'000'000'000) + std::chrono::milliseconds(0x01020304)), 0x01020304u);
    EXPECT_EQ(age_ms(p, at_ns(5'000'000'000) + std::chrono::milliseconds(0xFFFFFFFE)), 0xFFFFFFFEu);
    EXPECT_EQ(age_ms(p, at_ns(5'000'000'000) + std::chrono::hours(24 * 365)), 0xFFFFFFFFu);
}

TEST(RegisterMap, HeartbeatCountsSecondsAndWraps) {
    EXPECT_EQ(heartbeat(at_ns(0)), 0);
    EXPECT_EQ(heartbeat(at_ns(999'999'999)), 0);
    EXPECT_EQ(heartbeat(at_ns(1'000'000'000)), 1);
    EXPECT_EQ(heartbeat(at_ns(65'535'000'000'000)), 65535);
    EXPECT_EQ(heartbeat(at_ns(65'536'000'000'000)), 0);
}

TEST(RegisterMap, RowsAreInOrderAndDoNotOverlap) {
    std::uint16_t next = 0;
    for (const auto& row : standard_registers()) {
        EXPECT_GE(row.offset, next) << row.name;
        next = static_cast<std::uint16_t>(row.offset + row.width());
    }
    EXPECT_LE(next, registers_per_axis);
}

TEST(RegisterMap, WriteOffsets) {
    const auto single = [](std::uint16_t offset) { return check_write_offsets(offset, 1); };
    for (std::uint16_t o = 0; o < registers_per_axis; ++o) {
        Verdict expected = Verdict::no_address;
        if (o == 32 || o == 33 || o == 44 || o == 50) expected = Verdict::good;
        if ((o >= 34 && o <= 43) || o == 48 || o == 49 || o == 52 || o == 53) expected = Verdict::bad_value;
        EXPECT_EQ(single(o), expected) << "offset " << o;
    }
    struct Range {
        std::uint16_t offset, count;
        Verdict expected;
    };
    for (const auto& r : {Range{32, 13, Verdict::good},        // all set-points
                          Range{32, 2, Verdict::good},         // control word and mode
                          Range{32, 3, Verdict::bad_value},    // ends in the middle of the target position
                          Range{32, 4, Verdict::good},         //
                          Range{35, 2, Verdict::bad_value},    // second half of one, first half of the next
                          Range{35, 3, Verdict::bad_value},    // begins in the middle
                          Range{34, 10, Verdict::good},        // all 32-bit set-points
                          Range{43, 2, Verdict::bad_value},    //
                          Range{42, 3, Verdict::good},         //
                          Range{44, 2, Verdict::no_address},   // 45 is not mapped
                          Range{31, 2, Verdict::no_address},   // 31 is not mapped
                          Range{35, 12, Verdict::no_address},  // address comes before value
                          Range{48, 3, Verdict::good},         // selector and request
                          Range{48, 2, Verdict::good},         //
                          Range{49, 2, Verdict::bad_value},    //
                          Range{48, 4, Verdict::no_address},   // 51, the state, is read only
                          Range{52, 2, Verdict::good},         //
                          Range{52, 3, Verdict::no_address},   // 54, the error, is read only
                          Range{63, 2, Verdict::no_address},   // goes into the next axis
                          Range{0, 64, Verdict::no_address},  Range{32, 0, Verdict::no_address}}) {
        EXPECT_EQ(check_write_offsets(r.offset, r.count), r.expected) << r.offset << " x " << r.count;
    }
}

TEST(RegisterMap, ProcessDataOfAllSetPoints) {
    const auto data = test::bytes("00 1F 00 01 FF FF FF FE 01 02 03 04 05 06 07 08 F1 F2 F3 F4 FE FD FC FC FF EF");
    const ProcessData p = process_data(32, 13, data.data(), WordOrder::high_first);
    EXPECT_EQ(p.controlword, 0x001F);
    EXPECT_EQ(p.mode, 1);
    EXPECT_EQ(p.target_position, -2);
    EXPECT_EQ(p.profile_velocity, 0x01020304u);
    EXPECT_EQ(p.profile_acceleration, 0x05060708u);
    EXPECT_EQ(p.profile_deceleration, 0xF1F2F3F4u);
    EXPECT_EQ(p.target_velocity, -0x01020304);
    EXPECT_EQ(p.homing_method, -17);
    const ProcessData q = process_data(32, 13, data.data(), WordOrder::low_first);
    EXPECT_EQ(q.target_position, static_cast<std::int32_t>(0xFFFEFFFF));
    EXPECT_EQ(q.profile_velocity, 0x03040102u);
    EXPECT_EQ(q.target_velocity, static_cast<std::int32_t>(0xFCFCFEFD));
}

TEST(RegisterMap, ProcessDataHoldsOnlyWhatWasWritten) {
    const auto data = test::bytes("FF FD");
    const ProcessData p = process_data(33, 1, data.data(), WordOrder::high_first);
    EXPECT_EQ(p.mode, -3);
    EXPECT_FALSE(p.controlword || p.target_position || p.profile_velocity || p.profile_acceleration || p.profile_deceleration ||
                 p.target_velocity || p.homing_method);
    const auto middle = test::bytes("00 00 00 05 00 00 00 06");
    const ProcessData q = process_data(38, 4, middle.data(), WordOrder::high_first);
    EXPECT_EQ(q.profile_acceleration, 5u);
    EXPECT_EQ(q.profile_deceleration, 6u);
    EXPECT_FALSE(q.controlword || q.mode || q.target_position || q.profile_velocity || q.target_velocity || q.homing_method);
}

TEST(Verdicts, EveryReasonHasOne) {
    const std::pair<Reason, Verdict> table[] = {{Reason::none, Verdict::failed},
                                                {Reason::out_of_range, Verdict::bad_value},
                                                {Reason::unknown_point, Verdict::no_address},
                                                {Reason::not_writable, Verdict::no_address},
                                                {Reason::wrong_state, Verdict::failed},
                                                {Reason::not_supported, Verdict::failed},
                                                {Reason::drive_refused, Verdict::failed},
                                                {Reason::busy, Verdict::busy},
                                                {Reason::line_down, Verdict::no_path},
                                                {Reason::no_answer, Verdict::no_answer},
                                                {Reason::interrupted, Verdict::failed},
                                                {Reason::authority, Verdict::busy},
                                                {Reason::not_stored, Verdict::failed},
                                                {Reason::internal, Verdict::failed}};
    for (const auto& [reason, exception] : table) {
        Result r;
        r.outcome = Outcome::refused;
        r.reason = reason;
        EXPECT_EQ(verdict_of(r), exception) << name_of(reason);
        r.outcome = Outcome::failed;
        EXPECT_EQ(verdict_of(r), exception) << name_of(reason);
        r.outcome = Outcome::accepted;
        EXPECT_EQ(verdict_of(r), Verdict::good) << name_of(reason);
    }
}

}  // namespace
}  // namespace axisgate::registers
