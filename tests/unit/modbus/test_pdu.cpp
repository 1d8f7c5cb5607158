// Requests and their expected answers, for every function and every exception. The axes have numbers 1, 2 and 4; 3 is not configured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/modbus/responder_bench.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using test::ResponderBench;

struct Plant : ResponderBench {
    explicit Plant(WordOrder order = WordOrder::high_first) : ResponderBench(order) {
        for (const std::uint16_t n : std::initializer_list<std::uint16_t>{1, 2, 4}) {
            axes[n] = port.add_axis(n, &test::catalogue());
            port.edit(axes[n], [&](AxisPicture& p) {
                p.statusword = static_cast<std::uint16_t>(0x8027 + 0x100 * n);
                p.mode_display = static_cast<std::int16_t>(-n);
                p.position = 0x01020304 * std::int64_t{n};
                p.velocity = -2;
                p.error_code = 0xABCD;
                p.flags = static_cast<std::uint16_t>(0x0030 + n);
                p.controlword = 0x000F;
                p.mode = 1;
                p.target_position = 0x0A0B0C0D;
                p.ever_seen = true;
                p.at = port.time - std::chrono::milliseconds(0x00020003);
            });
        }
        port.time = at_ns(1'000'500'000'000);  // heartbeat 1000 = 0x03E8; half a second older
        port.set_mapping_revision(0xCAFE0123);
    }
    AxisId axes[5] = {};
};

struct Case {
    const char* name;
    const char* request;
    const char* answer;
    std::uint8_t unit = 1;
};
void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }
class Pdus : public testing::TestWithParam<Case> {};
TEST_P(Pdus, Answer) {
    Plant plant;
    EXPECT_EQ(plant.ask(GetParam().request, GetParam().unit), GetParam().answer);
    EXPECT_TRUE(plant.port.commands.empty());
    const bool is_exception = test::bytes(GetParam().answer)[0] >= 0x80;
    std::uint64_t exceptions = 0;
    for (const auto& c : plant.responder.counters().exceptions)
        exceptions += c.value();
    EXPECT_EQ(exceptions, is_exception ? 1u : 0u);
    EXPECT_EQ(plant.responder.counters().requests.value(), 1u);
}
const auto name_of_case = [](const auto& i) { return std::string(i.param.name); };

INSTANTIATE_TEST_SUITE_P(
    ReadRegisters, Pdus,
    testing::Values(Case{"fc3_ten", "03 00 00 00 0A", "03 14 81 27 FF FF 01 02 03 04 FF FF FF FE 00 00 00 00 AB CD 00 31"},
                    Case{"fc4_ten", "04 00 00 00 0A", "04 14 81 27 FF FF 01 02 03 04 FF FF FF FE 00 00 00 00 AB CD 00 31"},
                    Case{"one", "03 00 08 00 01", "03 02 AB CD"},                       //
                    Case{"axis_2", "03 00 40 00 04", "03 08 82 27 FF FE 02 04 06 08"},  //
                    Case{"axis_4", "03 00 C0 00 04", "03 08 84 27 FF FC 04 08 0C 10"},  //
                    Case{"across_two_axes", "03 00 3F 00 02", "03 04 00 00 82 27"},     //
                    Case{"age_and_heartbeat", "03 00 0A 00 06", "03 0C 00 00 00 00 00 02 01 F7 03 E8 00 00"},
                    Case{"second_half_of_the_age", "03 00 0D 00 01", "03 02 01 F7"},                  //
                    Case{"first_half_of_the_age", "03 00 0C 00 01", "03 02 00 02"},                   //
                    Case{"heartbeat_alone", "03 00 0E 00 01", "03 02 03 E8"},                         //
                    Case{"heartbeat_of_the_second", "03 00 4E 00 01", "03 02 03 E8"},                 //
                    Case{"half_of_a_value_may_be_read", "03 00 03 00 01", "03 02 03 04"},             //
                    Case{"mapping_revision", "03 00 12 00 02", "03 04 CA FE 01 23"},                  //
                    Case{"set_points_read_back", "03 00 20 00 04", "03 08 00 0F 00 01 0A 0B 0C 0D"},  //
                    Case{"others_read_0", "03 00 2D 00 03", "03 06 00 00 00 00 00 00"},               //
                    Case{"channel_at_rest", "03 00 30 00 07", "03 0E 00 00 00 00 00 00 00 00 00 00 00 00 00 00"},
                    Case{"unit_0", "03 00 08 00 01", "03 02 AB CD", 0},                 //
                    Case{"unit_255", "03 00 08 00 01", "03 02 AB CD", 255},             //
                    Case{"unit_2_has_no_map", "03 00 08 00 01", "83 0A", 2},            //
                    Case{"unit_254_has_no_map", "03 00 08 00 01", "83 0A", 254},        //
                    Case{"no_map_comes_before_function", "41 00", "C1 0A", 77},         //
                    Case{"count_0", "03 00 00 00 00", "83 03"},                         //
                    Case{"count_126", "03 00 00 00 7E", "83 03"},                       //
                    Case{"count_65535", "03 00 00 FF FF", "83 03"},                     //
                    Case{"fc4_count_0", "04 00 00 00 00", "84 03"},                     //
                    Case{"fc4_count_126", "04 00 00 00 7E", "84 03"},                   //
                    Case{"count_comes_before_address", "03 FF FF 00 7E", "83 03"},      //
                    Case{"beyond_65535", "03 FF FF 00 02", "83 02"},                    //
                    Case{"beyond_65535_by_one", "03 FF 84 00 7D", "83 02"},             //
                    Case{"up_to_65535", "03 FF 83 00 7D", "83 0A"},                     //
                    Case{"last_register", "03 FF FF 00 01", "83 0A"},                   //
                    Case{"axis_3_is_not_configured", "03 00 80 00 01", "83 0A"},        //
                    Case{"into_an_axis_that_is_not_there", "03 00 7F 00 02", "83 0A"},  //
                    Case{"from_an_axis_that_is_not_there", "03 00 BF 00 02", "83 0A"},  //
                    Case{"axis_5_is_beyond_the_last", "03 01 00 00 01", "83 0A"},       //
                    Case{"too_short", "03 00 00 00", "83 03"},                          //
                    Case{"function_alone", "03", "83 03"},                              //
                    Case{"too_long", "03 00 00 00 0A 00", "83 03"}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(
    ReadBits, Pdus,
    testing::Values(Case{"fc1_flags", "01 00 00 00 10", "01 02 31 00"}, Case{"fc2_flags", "02 00 00 00 10", "02 02 31 00"},
                    Case{"status_word", "02 00 10 00 10", "02 02 27 81"}, Case{"online", "01 00 00 00 01", "01 01 01"},
                    Case{"bit_4", "01 00 04 00 01", "01 01 01"}, Case{"bit_3", "01 00 03 00 01", "01 01 00"},
                    Case{"bits_3_to_6", "01 00 03 00 04", "01 01 06"}, Case{"across_axes_from_an_odd_bit", "01 00 3D 00 10", "01 02 90 01"},
                    Case{"across_bytes", "01 00 04 00 0E", "01 02 03 30"}, Case{"unused_bits_are_0", "01 00 00 00 05", "01 01 11"},
                    Case{"bits_32_to_63_read_0", "01 00 20 00 20", "01 04 00 00 00 00"},
                    Case{"across_axes", "01 00 3E 00 22", "01 05 C8 00 9C 08 02"}, Case{"axis_2", "02 00 40 00 20", "02 04 32 00 27 82"},
                    Case{"count_0", "01 00 00 00 00", "81 03"}, Case{"count_2001", "01 00 00 07 D1", "81 03"},
                    Case{"fc2_count_0", "02 00 00 00 00", "82 03"}, Case{"fc2_count_2001", "02 00 00 07 D1", "82 03"},
                    Case{"beyond_65535", "01 FF FF 00 02", "81 02"}, Case{"up_to_65535", "01 FF FF 00 01", "81 0A"},
                    Case{"not_configured", "02 00 80 00 01", "82 0A"}, Case{"into_not_configured", "02 00 7F 00 02", "82 0A"},
                    Case{"too_short", "01 00 00", "81 03"}, Case{"too_long", "02 00 00 00 01 00", "82 03"}),
    [](const auto& i) { return std::string("bits_") + i.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Writes, Pdus,
    testing::Values(
        Case{"fc6_control_word", "06 00 20 00 1F", "06 00 20 00 1F"}, Case{"fc6_mode", "06 00 61 FF FD", "06 00 61 FF FD"},
        Case{"fc6_read_only", "06 00 00 00 01", "86 02"}, Case{"fc6_not_mapped", "06 00 2D 00 01", "86 02"},
        Case{"fc6_first_half", "06 00 22 00 01", "86 03"}, Case{"fc6_second_half", "06 00 23 00 01", "86 03"},
        Case{"fc6_channel_half", "06 00 31 00 01", "86 03"}, Case{"fc6_channel_state", "06 00 33 00 01", "86 02"},
        Case{"fc6_not_configured", "06 00 A0 00 1F", "86 0A"}, Case{"fc6_read_only_of_an_axis_not_configured", "06 00 80 00 1F", "86 02"},
        Case{"fc6_too_short", "06 00 20 00", "86 03"}, Case{"fc6_too_long", "06 00 20 00 1F 00", "86 03"},
        Case{"fc6_last_address", "06 FF FF 00 01", "86 02"},
        Case{"fc16_all_set_points", "10 00 20 00 0D 1A 00 1F 00 01 FF FF FF FE 01 02 03 04 05 06 07 08 F1 F2 F3 F4 FE FD FC FC FF EF",
             "10 00 20 00 0D"},
        Case{"fc16_one", "10 00 20 00 01 02 00 1F", "10 00 20 00 01"},
        Case{"fc16_target", "10 00 22 00 02 04 01 02 03 04", "10 00 22 00 02"},
        Case{"fc16_ends_in_half", "10 00 20 00 03 06 00 1F 00 01 00 00", "90 03"},
        Case{"fc16_begins_in_half", "10 00 23 00 01 02 00 1F", "90 03"},
        Case{"fc16_over_unmapped", "10 00 2C 00 02 04 00 00 00 00", "90 02"}, Case{"fc16_count_0", "10 00 20 00 00 00", "90 03"},
        Case{"fc16_bytes_lie", "10 00 20 00 01 04 00 1F 00 00", "90 03"}, Case{"fc16_data_missing", "10 00 20 00 02 04 00 1F", "90 03"},
        Case{"fc16_data_too_long", "10 00 20 00 01 02 00 1F 00", "90 03"}, Case{"fc16_beyond", "10 FF FF 00 02 04 00 00 00 00", "90 02"},
        Case{"fc16_not_configured", "10 00 A0 00 01 02 00 1F", "90 0A"}, Case{"fc16_too_short", "10 00 20 00 01", "90 03"},
        Case{"fc16_function_alone", "10", "90 03"}, Case{"fc16_unit_9", "10 00 20 00 01 02 00 1F", "90 0A", 9},
        Case{"fc5_on", "05 00 00 FF 00", "85 02"}, Case{"fc5_off", "05 00 00 00 00", "85 02"},
        Case{"fc5_neither_on_nor_off", "05 00 00 00 01", "85 03"}, Case{"fc5_not_configured", "05 00 80 FF 00", "85 02"},
        Case{"fc5_too_short", "05 00 00 FF", "85 03"}, Case{"fc15", "0F 00 00 00 09 02 FF 01", "8F 02"},
        Case{"fc15_count_0", "0F 00 00 00 00 00", "8F 03"}, Case{"fc15_bytes_lie", "0F 00 00 00 09 01 FF", "8F 03"},
        Case{"fc15_too_long", "0F 00 00 00 08 01 FF 00", "8F 03"}, Case{"fc15_beyond", "0F FF FF 00 02 01 03", "8F 02"},
        Case{"fc15_too_short", "0F 00 00 00", "8F 03"}, Case{"fc22", "16 00 20 FF F0 00 05", "16 00 20 FF F0 00 05"},
        Case{"fc22_half", "16 00 22 FF FF 00 00", "96 03"}, Case{"fc22_read_only", "16 00 00 FF FF 00 00", "96 02"},
        Case{"fc22_not_configured", "16 00 A0 FF FF 00 00", "96 0A"},
        Case{"fc22_read_only_comes_before_not_configured", "16 00 80 FF FF 00 00", "96 02"},
        Case{"fc22_too_short", "16 00 20 FF FF 00", "96 03"}, Case{"fc22_too_long", "16 00 20 FF FF 00 00 00", "96 03"},
        Case{"fc23", "17 00 20 00 02 00 20 00 01 02 00 1F", "17 04 00 1F 00 01"},
        Case{"fc23_read_of_another_axis", "17 00 41 00 01 00 20 00 01 02 00 1F", "17 02 FF FE"},
        Case{"fc23_read_0", "17 00 00 00 00 00 20 00 01 02 00 1F", "97 03"},
        Case{"fc23_read_126", "17 00 00 00 7E 00 20 00 01 02 00 1F", "97 03"},
        Case{"fc23_write_0", "17 00 00 00 01 00 20 00 00 00", "97 03"},
        Case{"fc23_bytes_lie", "17 00 00 00 01 00 20 00 01 04 00 1F 00 00", "97 03"},
        Case{"fc23_data_missing", "17 00 00 00 01 00 20 00 01 02 00", "97 03"},
        Case{"fc23_read_beyond", "17 FF FF 00 02 00 20 00 01 02 00 1F", "97 02"},
        Case{"fc23_write_beyond", "17 00 00 00 01 FF FF 00 02 04 00 1F 00 00", "97 02"},
        Case{"fc23_write_half", "17 00 00 00 01 00 22 00 01 02 00 1F", "97 03"},
        Case{"fc23_write_read_only", "17 00 00 00 01 00 00 00 01 02 00 1F", "97 02"},
        Case{"fc23_write_not_configured", "17 00 00 00 01 00 A0 00 01 02 00 1F", "97 0A"},
        Case{"fc23_read_not_configured", "17 00 80 00 01 00 20 00 01 02 00 1F", "97 0A"},
        Case{"fc23_one_of_two_read_axes_not_configured", "17 00 7F 00 02 00 20 00 01 02 00 1F", "97 0A"},
        Case{"fc23_too_short", "17 00 00 00 01 00 20 00 01", "97 03"}),
    name_of_case);

INSTANTIATE_TEST_SUITE_P(Others, Pdus,
                         testing::Values(Case{"fc8_echo", "08 00 00 A5 37", "08 00 00 A5 37"},
                                         Case{"fc8_echo_of_nothing", "08 00 00", "08 00 00"},
                                         Case{"fc8_echo_of_much", "08 00 00 01 02 03 04 05 06", "08 00 00 01 02 03 04 05 06"},
                                         Case{"fc8_restart", "08 00 01 00 00", "88 01"}, Case{"fc8_counter", "08 00 0B 00 00", "88 01"},
                                         Case{"fc8_odd", "08 00 00 A5", "88 03"}, Case{"fc8_too_short", "08 00", "88 03"},
                                         Case{"fc17", "11", "11 10 01 FF 61 78 69 73 67 61 74 65 20 31 2E 32 2E 33"},
                                         Case{"fc17_unit_255", "11", "11 10 FF FF 61 78 69 73 67 61 74 65 20 31 2E 32 2E 33", 255},
                                         Case{"fc17_too_long", "11 00", "91 03"}, Case{"fc0", "00", "80 01"}, Case{"fc7", "07", "87 01"},
                                         Case{"fc11", "0B", "8B 01"}, Case{"fc20", "14 00", "94 01"}, Case{"fc24", "18 00 00", "98 01"},
                                         Case{"fc43_canopen", "2B 0D 00", "AB 01"}, Case{"fc43_alone", "2B", "AB 03"},
                                         Case{"fc100", "64", "E4 01"}, Case{"fc127", "7F 01 02", "FF 01"}, Case{"fc131", "83 02", "83 01"},
                                         Case{"fc255", "FF", "FF 01"}),
                         name_of_case);

TEST(Pdu, GreatestCounts) {
    Plant plant;
    for (std::uint16_t n = 5; n <= 40; ++n)
        plant.port.add_axis(n);
    EXPECT_EQ(plant.ask("03 00 C0 00 7D").substr(0, 11), "03 FA 84 27");
    EXPECT_EQ(test::bytes(plant.ask("04 00 C0 00 7D")).size(), 252u);
    EXPECT_EQ(plant.ask("01 00 C0 07 D0").substr(0, 17), "01 FA 34 00 27 84");
    EXPECT_EQ(test::bytes(plant.ask("02 00 C1 07 D0")).size(), 252u);
    EXPECT_EQ(test::bytes(plant.ask("17 00 C0 00 7D 00 20 00 01 02 00 1F")).size(), 252u);
}

TEST(Pdu, GreatestAndTooGreatCountsOfWrites) {
    // No range of the standard map is so long: an allowed count is refused by its address, one more by its count.
    Plant plant;
    const auto zeros = [](std::size_t n) {
        std::string s;
        for (std::size_t i = 0; i < n; ++i)
            s += " 00";
        return s;
    };
    EXPECT_EQ(plant.ask("10 00 20 00 7B F6" + zeros(246)), "90 02");
    EXPECT_EQ(plant.ask("10 00 20 00 7C F8" + zeros(247)), "90 03");
    EXPECT_EQ(plant.ask("10 00 20 00 7C F8" + zeros(248)), "90 03");
    EXPECT_EQ(plant.ask("10 FF FF 00 7C F8" + zeros(247)), "90 03") << "count before address";
    EXPECT_EQ(plant.ask("0F 00 00 07 B0 F6" + zeros(246)), "8F 02");
    EXPECT_EQ(plant.ask("0F 00 00 07 B1 F7" + zeros(247)), "8F 03");
    EXPECT_EQ(plant.ask("17 00 00 00 01 00 20 00 79 F2" + zeros(242)), "97 02");
    EXPECT_EQ(plant.ask("17 00 00 00 01 00 20 00 7A F4" + zeros(243)), "97 03");
    EXPECT_EQ(plant.ask("10 00 20 FF FF FE" + zeros(247)), "90 03");
    EXPECT_EQ(plant.ask("08 00 00" + zeros(250)), "08 00 00" + zeros(250));
    EXPECT_EQ(plant.port.submitted, 0u);
}

TEST(Pdu, LowWordFirst) {
    Plant plant(WordOrder::low_first);
    EXPECT_EQ(plant.ask("03 00 02 00 04"), "03 08 03 04 01 02 FF FE FF FF");
    EXPECT_EQ(plant.ask("03 00 0C 00 03"), "03 06 01 F7 00 02 03 E8");
    EXPECT_EQ(plant.ask("03 00 12 00 02"), "03 04 01 23 CA FE");
    plant.result = [&] {
        const auto& d = std::get<ProcessData>(plant.port.commands.front().body);
        EXPECT_EQ(d.target_position, 0x01020304);
        EXPECT_EQ(d.profile_velocity, 0xFFFFFFFEu);
        plant.port.answer();
    };
    EXPECT_EQ(plant.ask("10 00 22 00 04 08 03 04 01 02 FF FE FF FF"), "10 00 22 00 04");
    EXPECT_EQ(plant.ask("03 00 22 00 04"), "03 08 03 04 01 02 FF FE FF FF");
}

TEST(Pdu, AWriteBecomesOneCommandWithItsOrigin) {
    Plant plant;
    plant.result = [&] {
        ASSERT_EQ(plant.port.commands.size(), 1u);
        const Command& c = plant.port.commands.front();
        EXPECT_EQ(plant.port.doors.at(door_of(c.ticket) - 1u), &plant.door);
        EXPECT_EQ(c.axis, plant.axes[2]);
        EXPECT_FALSE(c.until_done);
        EXPECT_EQ(c.origin.text(), "modbus 192.0.2.7:51123");
        const auto& d = std::get<ProcessData>(c.body);
        EXPECT_EQ(d.controlword, 0x001F);
        EXPECT_EQ(d.mode, 1);
        EXPECT_EQ(d.target_position, -2);
        EXPECT_FALSE(d.profile_velocity || d.profile_acceleration || d.profile_deceleration || d.target_velocity || d.homing_method);
        plant.port.answer();
    };
    EXPECT_EQ(plant.ask("10 00 60 00 04 08 00 1F 00 01 FF FF FF FE"), "10 00 60 00 04");
    EXPECT_TRUE(plant.waited);
    EXPECT_EQ(plant.slots, std::vector<std::uint8_t>{7});
    EXPECT_EQ(plant.ask("03 00 60 00 04"), "03 08 00 1F 00 01 FF FF FF FE");
    EXPECT_EQ(plant.responder.writer().counters().commands.value(), 1u);
}

TEST(Pdu, MaskWriteCombinesWithWhatWasLastAccepted) {
    Plant plant;  // control word 0x000F
    struct Row {
        const char* request;
        std::uint16_t expected;
    };
    for (const Row& row : {Row{"16 00 20 FF EF 00 10", 0x001F},     // set bit 4
                           Row{"16 00 20 FF EF 00 00", 0x000F},     // clear it
                           Row{"16 00 20 00 F2 00 25", 0x0007},     // (000F & 00F2) | (0025 & FF0D) = 0002 | 0005
                           Row{"16 00 20 00 00 AB CD", 0xABCD},     // and-mask 0: the or-mask as it is
                           Row{"16 00 20 FF FF 12 34", 0xABCD}}) {  // and-mask all ones: unchanged
        plant.result = [&] {
            EXPECT_EQ(std::get<ProcessData>(plant.port.commands.front().body).controlword, row.expected) << row.request;
            plant.port.answer();
        };
        EXPECT_EQ(plant.ask(row.request), row.request);
    }
}

TEST(Pdu, EveryReasonIsAnsweredWithItsException) {
    struct Row {
        Reason reason;
        const char* fc6;
        const char* fc16;
        const char* fc22;
        const char* fc23;
    };
    for (const Row& row :
         {Row{Reason::out_of_range, "86 03", "90 03", "96 03", "97 03"}, Row{Reason::unknown_point, "86 02", "90 02", "96 02", "97 02"},
          Row{Reason::not_writable, "86 02", "90 02", "96 02", "97 02"}, Row{Reason::wrong_state, "86 04", "90 04", "96 04", "97 04"},
          Row{Reason::not_supported, "86 04", "90 04", "96 04", "97 04"}, Row{Reason::drive_refused, "86 04", "90 04", "96 04", "97 04"},
          Row{Reason::busy, "86 06", "90 06", "96 06", "97 06"}, Row{Reason::line_down, "86 0A", "90 0A", "96 0A", "97 0A"},
          Row{Reason::no_answer, "86 0B", "90 0B", "96 0B", "97 0B"}, Row{Reason::interrupted, "86 04", "90 04", "96 04", "97 04"},
          Row{Reason::authority, "86 06", "90 06", "96 06", "97 06"}, Row{Reason::not_stored, "86 04", "90 04", "96 04", "97 04"},
          Row{Reason::internal, "86 04", "90 04", "96 04", "97 04"}, Row{Reason::none, "86 04", "90 04", "96 04", "97 04"}}) {
        Plant plant;
        plant.result = [&] { plant.port.refuse(row.reason, 77); };
        EXPECT_EQ(plant.ask("06 00 20 00 1F"), row.fc6);
        EXPECT_EQ(plant.ask("10 00 22 00 02 04 00 00 00 01"), row.fc16);
        EXPECT_EQ(plant.ask("16 00 20 FF FF 00 00"), row.fc22);
        EXPECT_EQ(plant.ask("17 00 00 00 01 00 20 00 01 02 00 1F"), row.fc23);
        EXPECT_EQ(plant.ask("03 00 20 00 01"), "03 02 00 0F") << "nothing changed";
    }
}

TEST(Pdu, ReadWriteReadsAfterTheWrite) {
    Plant plant;
    plant.result = [&] {
        plant.port.answer();
        plant.port.edit(plant.axes[1], [](AxisPicture& p) { p.statusword = 0x1234; });
    };
    EXPECT_EQ(plant.ask("17 00 00 00 01 00 22 00 02 04 01 02 03 04"), "17 02 12 34");
    EXPECT_EQ(plant.ask("17 00 22 00 02 00 21 00 01 02 00 03"), "17 04 01 02 03 04");
}

TEST(Pdu, ReadWriteToldWhenTheReadAxisHasGoneMeanwhile) {
    Plant plant;
    plant.result = [&] {
        plant.port.remove_axis(2);
        plant.port.answer();
    };
    EXPECT_EQ(plant.ask("17 00 40 00 01 00 20 00 01 02 00 1F"), "97 0A");
}

TEST(Pdu, AResultThatNeverComesIsNoAnswer) {
    Plant plant;
    plant.result = [&] {
        plant.port.time += std::chrono::seconds(29);
        plant.responder.writer().sweep(plant.port.time);
        EXPECT_EQ(plant.late.outstanding, 1);
        plant.port.time += std::chrono::seconds(1);
        plant.responder.writer().sweep(plant.port.time);
    };
    EXPECT_EQ(plant.ask("06 00 20 00 1F"), "86 0B");
    EXPECT_EQ(plant.responder.writer().counters().results_timed_out.value(), 1u);
    EXPECT_TRUE(plant.port.answer());  // too late: no client is informed
    EXPECT_EQ(plant.responder.writer().counters().results_unclaimed.value(), 1u);
    EXPECT_EQ(plant.slots.size(), 1u);
}

TEST(Pdu, AResultCountsOnce) {
    Plant plant;
    Result copy;
    plant.result = [&] {
        copy.ticket = plant.port.commands.front().ticket;
        plant.port.refuse(Reason::busy);
    };
    EXPECT_EQ(plant.ask("06 00 20 00 1F"), "86 06");
    plant.responder.writer().on_result(copy);
    Result foreign;
    foreign.ticket = make_ticket(first_service_door, 1);
    plant.responder.writer().on_result(foreign);
    foreign.ticket = no_ticket;
    plant.responder.writer().on_result(foreign);
    EXPECT_EQ(plant.slots.size(), 1u);
    EXPECT_EQ(plant.responder.writer().counters().results_unclaimed.value(), 3u);
}

TEST(Pdu, CommandsOnTheirWayAreBounded) {
    test::FakePort port;
    port.add_axis(1, &test::catalogue());
    Responder::Settings settings;
    settings.max_commands = 2;
    test::ResponderDoor door(port, WordOrder::high_first, settings);
    Responder& responder = door.responder;
    struct Nobody : WriteOwner {
        void on_written(std::uint8_t, AxisId, Verdict) override {}
    } nobody;
    std::array<std::uint8_t, max_pdu> out{};
    const auto ask = [&](std::string_view pdu) {
        LateAnswer late;
        const auto n = responder.answer({&nobody, nullptr}, 0, 1, test::bytes(pdu), port.now(), out.data(), late);
        return test::hex(std::span(out).first(n));
    };
    EXPECT_EQ(ask("06 00 20 00 06"), "");
    EXPECT_EQ(ask("06 00 20 00 07"), "");
    EXPECT_EQ(ask("06 00 20 00 0F"), "86 06");
    EXPECT_EQ(ask("06 00 00 00 0F"), "86 02") << "an address fault is told as such";
    EXPECT_EQ(ask("10 00 30 00 03 06 00 00 00 00 00 01"), "90 06") << "the parameter channel needs a place too";
    EXPECT_EQ(ask("03 00 33 00 01"), "03 02 00 00") << "and has not begun";
    port.answer();
    EXPECT_EQ(ask("06 00 20 00 0F"), "");
    EXPECT_EQ(port.submitted, 3u);
}

/// A write that needs two commands, with one free place left, is refused as a whole.
TEST(Pdu, AWriteThatNeedsMorePlacesThanAreFreeIsNotBegun) {
    test::FakePort port;
    const AxisId x = port.add_axis(1, &test::catalogue()), y = port.add_axis(2, &test::catalogue());
    Responder::Settings settings;
    settings.max_commands = 1;
    test::ResponderDoor door(port, WordOrder::high_first, settings);
    struct Nobody : WriteOwner {
        void on_written(std::uint8_t, AxisId, Verdict) override {}
    } nobody;
    WritePlan plan;
    for (const AxisId axis : {x, y})
        plan.commands.push_back({axis, ProcessData{}, false, 0});
    const auto begun = door.responder.writer().give({&nobody, nullptr}, 0, door.image.standard(), plan, {}, port.now());
    EXPECT_EQ(begun.verdict, Verdict::busy);
    EXPECT_EQ(begun.outstanding, 0);
    EXPECT_EQ(port.submitted, 0u);
    EXPECT_EQ(door.responder.writer().waiting(), 0u);
}

TEST(Pdu, ATicketIsNeverGivenTwice) {
    TicketTable table(3);
    table.use_number(7);
    std::vector<Ticket> seen;
    for (int i = 0; i < 1000; ++i) {
        const Ticket t = table.open({}, at_ns(i));
        EXPECT_NE(t, no_ticket);
        EXPECT_EQ(door_of(t), 7);
        for (const Ticket other : seen)
            ASSERT_NE(t, other);
        seen.push_back(t);
        if (table.free() == 0) {
            EXPECT_TRUE(table.close(seen[seen.size() - 2]));   // from the middle
            EXPECT_FALSE(table.close(seen[seen.size() - 2]));  // only once
            EXPECT_TRUE(table.expired(never));
            EXPECT_EQ(table.used(), 1u);
        }
    }
}

/// What may take as long as the machine does is opened first, and does not keep later ones from their end.
TEST(Pdu, ATicketThatMayTakeADayHidesNoShorterOne) {
    TicketTable table(3);
    TicketTable::Waiting w;
    w.slot = 1;
    (void)table.open(w, at_ns(1'000'000));
    w.slot = 2;
    (void)table.open(w, at_ns(20));
    w.slot = 3;
    (void)table.open(w, at_ns(10));
    EXPECT_EQ(table.next_deadline(), at_ns(10));
    for (const int expected : {3, 2}) {
        const auto ended = table.expired(at_ns(30));
        ASSERT_TRUE(ended);
        EXPECT_EQ(ended->slot, expected);
    }
    EXPECT_FALSE(table.expired(at_ns(30)));
    EXPECT_EQ(table.next_deadline(), at_ns(1'000'000));
}

TEST(Pdu, TicketsExpireOldestFirst) {
    TicketTable table(4);
    TicketTable::Waiting w;
    std::vector<Ticket> tickets;
    for (std::uint8_t i = 0; i < 4; ++i) {
        w.slot = i;
        tickets.push_back(table.open(w, at_ns(10 * i)));
    }
    EXPECT_EQ(table.next_deadline(), at_ns(0));
    EXPECT_TRUE(table.close(tickets[1]));
    EXPECT_EQ(table.expired(at_ns(25))->slot, 0);
    EXPECT_EQ(table.expired(at_ns(25))->slot, 2);
    EXPECT_FALSE(table.expired(at_ns(29)));
    EXPECT_EQ(table.expired(at_ns(30))->slot, 3);
    EXPECT_EQ(table.next_deadline(), never);
}

// --- the standard map behind it -------------------------------------------------------------------------------------------------------

TEST(StandardMap, AnUnchangedAxisIsNotRenderedAgain) {
    Plant plant;
    auto& map = plant.image.standard();
    const auto before = map.renders();
    for (int i = 0; i < 100; ++i)
        EXPECT_EQ(plant.ask("03 00 00 00 01"), "03 02 81 27");
    EXPECT_EQ(map.renders(), before + 1);
    plant.port.edit(plant.axes[1], [](AxisPicture& p) { p.statusword = 0x0250; });
    EXPECT_EQ(plant.ask("03 00 00 00 01"), "03 02 02 50");
    EXPECT_EQ(plant.ask("03 00 40 00 01"), "03 02 82 27");
    EXPECT_EQ(map.renders(), before + 3);
}

TEST(StandardMap, ANewMappingRevisionShowsOnEveryAxis) {
    Plant plant;
    EXPECT_EQ(plant.ask("03 00 12 00 02"), "03 04 CA FE 01 23");
    EXPECT_EQ(plant.ask("03 00 52 00 02"), "03 04 CA FE 01 23");
    plant.port.set_mapping_revision(0x01020304);
    EXPECT_EQ(plant.ask("03 00 52 00 02"), "03 04 01 02 03 04");
    EXPECT_EQ(plant.ask("03 00 12 00 02"), "03 04 01 02 03 04");
}

TEST(StandardMap, AnAxisThatIsReplacedShowsTheNewOne) {
    Plant plant;
    EXPECT_EQ(plant.ask("03 00 08 00 01"), "03 02 AB CD");
    plant.port.remove_axis(1);
    EXPECT_EQ(plant.ask("03 00 08 00 01"), "83 0A");
    EXPECT_EQ(plant.ask("01 00 00 00 01"), "81 0A");
    EXPECT_EQ(plant.ask("06 00 20 00 0F"), "86 0A");
    const AxisId fresh = plant.port.add_axis(1);
    plant.port.edit(fresh, [](AxisPicture& p) { p.error_code = 0x0102; });
    EXPECT_EQ(plant.ask("03 00 08 00 01"), "03 02 01 02");
}

TEST(StandardMap, AnOfflineAxisIsServed) {
    Plant plant;
    plant.port.edit(plant.axes[1], [](AxisPicture& p) {
        p.flags = flag_stale;
        p.statusword = 0x4000;
        p.presence = Presence::offline;
        p.ever_seen = false;
    });
    EXPECT_EQ(plant.ask("03 00 09 00 05"), "03 0A 00 04 00 00 00 00 FF FF FF FF");
    EXPECT_EQ(plant.ask("03 00 00 00 01"), "03 02 40 00");
}

TEST(StandardMap, TheLastAxisEndsAtTheLastRegister) {
    Plant plant;
    const AxisId last = plant.port.add_axis(1024);
    plant.port.edit(last, [](AxisPicture& p) {
        p.statusword = 0x1234;
        p.flags = 0x0081;
    });
    EXPECT_EQ(plant.ask("03 FF C0 00 01"), "03 02 12 34");
    EXPECT_EQ(plant.ask("03 FF FF 00 01"), "03 02 00 00");
    EXPECT_EQ(plant.ask("03 FF FF 00 02"), "83 02");
    EXPECT_EQ(plant.ask("01 FF C0 00 40"), "01 08 81 00 34 12 00 00 00 00");
    EXPECT_EQ(plant.ask("06 FF E0 00 0F"), "06 FF E0 00 0F");
}

// --- the interface for user maps ------------------------------------------------------------------------------------------------------

/// A map that writes two axes with one request and records its calls.
struct TwoAxes final : UnitMap {
    Verdict check_read(Table, std::uint16_t, std::uint16_t) override { return Verdict::good; }
    Verdict read_registers(Table table, std::uint16_t address, std::uint16_t count, Instant, std::uint8_t* out) override {
        for (std::uint16_t i = 0; i < count; ++i)
            put16(out + 2 * i, static_cast<std::uint16_t>(address + i + 0x1000 * int(table)));
        return Verdict::good;
    }
    Verdict read_bits(Table, std::uint16_t, std::uint16_t, std::uint8_t* out) override {
        out[0] = 1;
        return Verdict::good;
    }
    Verdict check_write(Table, std::uint16_t, std::uint16_t) override { return Verdict::good; }
    Verdict write(Table table, std::uint16_t, std::uint16_t, const std::uint8_t* data, WritePlan& plan) override {
        ProcessData d;
        d.controlword = table == Table::coils ? data[0] : get16(data);
        plan.commands.push_back({first, d, false, 0});
        plan.commands.push_back({second, d, false, 0});
        plan.commands.push_back({first, d, true, 42});
        return Verdict::good;
    }
    void on_own_result(std::uint32_t note, const Result& result) override { own.emplace_back(note, result.reason); }
    AxisId first{}, second{};
    std::vector<std::pair<std::uint32_t, Reason>> own;
};

TEST(UnitMap, AMapBehindAnotherUnit) {
    Plant plant;
    TwoAxes map;
    map.first = plant.axes[1];
    map.second = plant.axes[2];
    plant.image.set_map(2, &map);
    EXPECT_EQ(plant.ask("03 00 05 00 02", 2), "03 04 20 05 20 06");
    EXPECT_EQ(plant.ask("04 00 05 00 01", 2), "04 02 30 05");
    EXPECT_EQ(plant.ask("01 00 05 00 01", 2), "01 01 01");
    EXPECT_EQ(plant.ask("05 00 05 FF 00", 2), "05 00 05 FF 00");
    EXPECT_EQ(plant.ask("06 00 00 00 0F", 2), "06 00 00 00 0F");
    // Results came in the order of the commands: the first request's own one with the second request's, whose own one is still outstanding.
    EXPECT_THAT(map.own, testing::ElementsAre(testing::Pair(42, Reason::none)));
    EXPECT_EQ(plant.port.commands.size(), 1u);
    plant.port.refuse(Reason::no_answer);
    EXPECT_THAT(map.own, testing::ElementsAre(testing::Pair(42, Reason::none), testing::Pair(42, Reason::no_answer)));
    plant.image.set_map(2, nullptr);
    EXPECT_EQ(plant.ask("03 00 05 00 02", 2), "83 0A");
}

TEST(UnitMap, TheFirstFailureDecides) {
    for (const bool first_fails : {true, false}) {
        Plant plant;
        TwoAxes map;
        map.first = plant.axes[1];
        map.second = plant.axes[2];
        plant.image.set_map(200, &map);
        int n = 0;
        plant.result = [&] {
            ++n;
            if (n == 1) {
                first_fails ? plant.port.refuse(Reason::no_answer) : plant.port.answer();
            } else {
                plant.port.refuse(Reason::wrong_state);
            }
        };
        EXPECT_EQ(plant.ask("06 00 00 00 0F", 200), first_fails ? "86 0B" : "86 04");
        EXPECT_EQ(n, 2) << "all results are awaited";
    }
}

TEST(UnitMap, AMapThatWasTakenAwayIsNotTold) {
    Plant plant;
    {
        TwoAxes map;
        map.first = plant.axes[1];
        map.second = plant.axes[2];
        plant.image.set_map(2, &map);
        EXPECT_EQ(plant.ask("06 00 00 00 0F", 2), "06 00 00 00 0F");
        plant.image.set_map(2, nullptr);
        EXPECT_TRUE(plant.port.answer());
        EXPECT_TRUE(map.own.empty());
    }
    EXPECT_EQ(plant.responder.writer().counters().results_unclaimed.value(), 1u);
}

TEST(UnitMap, TheStandardUnitsCannotBeReplaced) {
    Plant plant;
    for (const std::uint8_t unit : std::initializer_list<std::uint8_t>{0, 1, 255}) {
        plant.image.set_map(unit, nullptr);
        EXPECT_EQ(plant.ask("03 00 08 00 01", unit), "03 02 AB CD");
    }
}

}  // namespace
}  // namespace axisgate::modbus
