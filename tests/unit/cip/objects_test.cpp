// Attributes and services with every possible general status, values that come later, several requests in one.
#include <gtest/gtest.h>

#include "tests/unit/cip/bench.hpp"

namespace axisgate::cip {
namespace {
using bench::Bench;
using bench::get;
using bench::hex;

General status_of(Bench& b, View message) { return b.ask(message).general; }

TEST(CipObjects, IdentityAloneAndAllTogether) {
    Bench b;
    EXPECT_EQ(b.ask(get(1, 1, 1)).data, hex("FFFF"));
    EXPECT_EQ(b.ask(get(1, 1, 0, service::get_all)).data, hex("FFFF 0C00 0100 0307 3400 04030201 08 6178697367617465"));
    EXPECT_EQ(b.ask(get(1, 0, 1)).data, hex("0100"));
    EXPECT_EQ(b.ask(get(1, 1, 0, service::get_list, hex("0200 0100 6300"))).general, General::attribute_list_error);
    EXPECT_EQ(b.ask(get(1, 1, 0, service::get_list, hex("0200 0100 6300"))).data, hex("0200 0100 0000 FFFF 6300 1400"));
}

TEST(CipObjects, EveryGeneralStatusOfARequest) {
    Bench b;
    EXPECT_EQ(status_of(b, get(1, 1, 99)), General::attribute_not_supported);
    EXPECT_EQ(status_of(b, get(1, 2, 1)), General::object_does_not_exist);
    EXPECT_EQ(status_of(b, get(0x99, 1, 1)), General::path_destination_unknown);
    EXPECT_EQ(status_of(b, get(1, 1, 1, 0x4F)), General::service_not_supported);
    EXPECT_EQ(status_of(b, get(1, 1, 1, service::get_single, hex("00"))), General::too_much_data);
    EXPECT_EQ(status_of(b, get(1, 1, 0, service::get_list, hex("0500 0100"))), General::not_enough_data);
    EXPECT_EQ(status_of(b, get(1, 1, 1, service::set_single, hex("0000"))), General::attribute_not_settable);
    EXPECT_EQ(status_of(b, hex("0E 02 20 01 FF 01")), General::path_segment_error);
    EXPECT_EQ(status_of(b, hex("0E 00")), General::path_segment_error);
    EXPECT_EQ(status_of(b, hex("0E 09 20 01")), General::path_size_invalid);
    EXPECT_EQ(status_of(b, hex("0E 03 91 03 61 62 63 00")), General::path_destination_unknown);
    EXPECT_EQ(status_of(b, hex("0E 08 34 04 0100 0000 0000 00 00 20 01 24 01 30 01")), General::key_failure);
    EXPECT_EQ(status_of(b, get(0xF5, 1, 13, service::set_single, hex("FFFF"))), General::invalid_attribute_value);
    EXPECT_EQ(status_of(b, get(0xF5, 1, 13, service::set_single, hex("0A"))), General::not_enough_data);
    EXPECT_EQ(status_of(b, get(0xF5, 1, 13, service::set_single, hex("0A0000"))), General::too_much_data);
    EXPECT_EQ(status_of(b, get(0xF5, 1, 13, service::set_single, hex("0A00"))), General::success);
    EXPECT_EQ(b.ask(get(0xF5, 1, 13)).data, hex("0A00"));
    EXPECT_EQ(b.ask(get(0xF5, 1, 0, service::set_list, hex("0200 0D00 3C00 0100 00000000"))).data, hex("0200 0D00 0000 0100 0E00"));
}

TEST(CipObjects, TheNetworkAsToolsBrowseIt) {
    Bench b;
    EXPECT_EQ(b.ask(get(0xF5, 1, 5)).data, hex("6400A8C0 00FFFFFF 00000000 00000000 00000000 0000"));
    EXPECT_EQ(b.ask(get(0xF5, 1, 4)).data, hex("0200 20F6 2401"));
    EXPECT_EQ(b.ask(get(0xF6, 1, 1)).data, hex("E8030000"));
    EXPECT_EQ(b.ask(get(0x48, 1, 5)).data, hex("2F"));
    EXPECT_EQ(b.ask(get(0xF3, 0, 2)).data, hex("00000000"));
    const Answer list = b.ask(get(2, 1, 1));
    EXPECT_EQ(list.data, hex("0900 0100 0200 0400 0600 0F00 4800 F300 F500 F600"));
}

TEST(CipObjects, MarksAreSetAloneInAListAndAllTogetherAndTheDataHaveThem) {
    Bench b;
    (void)b.opened({});
    EXPECT_EQ(b.ask(get(0x48, 1, 0, service::get_all)).data, hex("37 2F 2B 1F 1B"));
    const auto set = [&](std::uint32_t attribute, const char* value, std::uint8_t by = service::set_single) {
        return status_of(b, get(0x48, 1, attribute, by, hex(value)));
    };
    EXPECT_EQ(set(5, "40"), General::invalid_attribute_value) << "six bits";
    EXPECT_EQ(set(5, ""), General::not_enough_data);
    EXPECT_EQ(set(5, "2E00"), General::too_much_data);
    EXPECT_EQ(set(2, "01"), General::attribute_not_settable);
    EXPECT_EQ(set(9, "01"), General::attribute_not_supported);
    b.pass(std::chrono::milliseconds(1));
    EXPECT_EQ(b.output.implicits.back().dscp, 47);
    EXPECT_EQ(set(5, "2E"), General::success);
    b.pass(std::chrono::milliseconds(10));
    EXPECT_EQ(b.output.implicits.back().dscp, 46);
    EXPECT_EQ(b.ask(get(0x48, 1, 0, service::set_list, hex("0200 0400 30 0800 0A"))).data, hex("0200 0400 0000 0800 0000"));
    EXPECT_EQ(b.adapter.marks().explicit_mark(), 10);
    EXPECT_EQ(set(0, "01 02 03 04 40", service::set_all), General::invalid_attribute_value);
    EXPECT_EQ(b.ask(get(0x48, 1, 0, service::get_all)).data, hex("30 2E 2B 1F 0A")) << "all or nothing";
    EXPECT_EQ(set(0, "01 02 03 04", service::set_all), General::not_enough_data);
    EXPECT_EQ(set(0, "01 02 03 04 05 06", service::set_all), General::too_much_data);
    EXPECT_EQ(set(0, "01 02 03 04 05", service::set_all), General::success);
    EXPECT_EQ(b.ask(get(0x48, 1, 0, service::get_all)).data, hex("01 02 03 04 05"));
    EXPECT_EQ(status_of(b, get(0x48, 0, 0, service::set_all, hex("0102030405"))), General::service_not_supported);
    EXPECT_EQ(status_of(b, get(1, 1, 0, service::set_all, hex("00"))), General::service_not_supported) << "an identity is given";
    for (std::uint16_t priority = 0; priority < 4; ++priority)
        EXPECT_EQ(b.adapter.marks().implicit_mark(static_cast<std::uint8_t>(priority)), 4 - priority);
}

TEST(CipObjects, TheListOfOriginatedConnectionsIsEmptyAndSaysSo) {
    Bench b;
    EXPECT_EQ(b.ask(get(0xF3, 0, 1)).data, hex("0300"));
    EXPECT_EQ(b.ask(get(0xF3, 0, 2)).data, hex("00000000"));
    EXPECT_EQ(b.ask(get(0xF3, 0, 3)).data, hex("00000000"));
    EXPECT_EQ(b.ask(get(0xF3, 0, 6)).data, hex("0900"));
    EXPECT_EQ(b.ask(get(0xF3, 0, 8)).data, hex("0000"));
    EXPECT_EQ(b.ask(get(0xF3, 0, 9)).data, hex("00000000")) << "its signature";
    EXPECT_EQ(b.ask(get(0xF3, 0, 10)).general, General::attribute_not_supported);
    EXPECT_EQ(b.ask(get(0xF3, 1, 1)).general, General::object_does_not_exist);
    EXPECT_EQ(b.ask(get(0x0F, 0, 6)).data, hex("0A00")) << "the class of parameters has ten";
}

TEST(CipObjects, AssembliesAreReadAndOutputsWritten) {
    Bench b;
    EXPECT_EQ(b.ask(get(4, 101, 3)).data, Bytes(32, 0x11));
    EXPECT_EQ(b.ask(get(4, 101, 4)).data, hex("2000"));
    EXPECT_EQ(status_of(b, get(4, 101, 3, service::set_single, Bytes(32))), General::attribute_not_settable);
    EXPECT_EQ(status_of(b, get(4, 151, 3, service::set_single, Bytes(31))), General::not_enough_data);
    EXPECT_EQ(status_of(b, get(4, 151, 3, service::set_single, Bytes(33))), General::too_much_data);
    EXPECT_EQ(status_of(b, get(4, 151, 3, service::set_single, Bytes(32))), General::success);
    EXPECT_EQ(b.values.reported.size(), 1u) << "only what has the right size is written";
    ASSERT_NE(b.opened({}), 0u);
    EXPECT_EQ(status_of(b, get(4, 151, 3, service::set_single, Bytes(32))), General::object_state_conflict) << "a connection owns it";
    EXPECT_EQ(status_of(b, get(4, 152, 3, service::set_single, Bytes(32))), General::success);
    b.values.writes_later = true;
    EXPECT_EQ(b.ask(get(4, 152, 3, service::set_single, Bytes(32))).data, Bytes{});
    ASSERT_EQ(b.values.asked.size(), 1u) << "answered when it has been carried out";
    b.adapter.answered(b.values.asked[0], General::device_state_conflict, {}, 4);
    const Bytes& packet = b.output.streams[1];
    ASSERT_GE(packet.size(), 6u);
    EXPECT_EQ(Bytes(packet.end() - 6, packet.end()), hex("90 00 10 01 04 00")) << "with a word that says more";
    EXPECT_EQ(status_of(b, get(4, 152, 0, service::set_list, hex("0100 0300"))), General::attribute_list_error)
        << "in a list there is no later";
}

TEST(CipObjects, AParametersValueComesWhenTheDriveHasTold) {
    Bench b;
    const Answer none = b.ask(get(0x0F, 1, 1));
    EXPECT_EQ(none.data, Bytes{});
    ASSERT_EQ(b.values.asked.size(), 1u);
    b.output.streams[1].clear();
    b.adapter.answered(b.values.asked[0], General::success, hex("19"));
    const Bytes answer = b.output.streams[1];
    ASSERT_GT(answer.size(), header_size);
    EXPECT_EQ(Bytes(answer.end() - 5, answer.end()), hex("8E 00 00 00 19"));
    b.adapter.answered(b.values.asked[0], General::success, hex("19"));
    EXPECT_EQ(b.output.streams[1], answer) << "told once";
}

/// An answer over a connection may have that connection's size, here 20 bytes with the sequence count.
TEST(CipObjects, AnAnswerThatIsTooLargeIsNotCutButRefused) {
    Bench b;
    Open o;
    o.transport = 0xA3, o.path = "20 02 24 01", o.ot_size = 100, o.to_size = 20;
    const std::uint32_t id = b.opened(o);
    ASSERT_NE(id, 0u);
    std::uint16_t count = 0;
    const auto send = [&](View message) {
        Bytes d = hex("00000000 0000 0200 A100 0400");
        put32(d, id);
        put16(d, item::connected_data);
        put16(d, static_cast<std::uint16_t>(2 + message.size()));
        put16(d, ++count);
        put_bytes(d, message);
        b.output.streams[1].clear();
        return b.packet_of(1, 0x70, d);
    };
    const auto general = [&](const Bytes& answer) { return answer.empty() ? -1 : answer.at(header_size + 6 + 2 + 8 + 4 + 2 + 2); };
    EXPECT_EQ(general(send(get(1, 1, 1))), 0);
    EXPECT_EQ(general(send(get(4, 101, 3))), 0x11) << "32 bytes of an assembly";
    EXPECT_EQ(general(send(get(1, 1, 0, service::get_all))), 0x11);
    EXPECT_EQ(general(send(get(1, 1, 0, service::get_list, hex("0400 0100 0200 0300 0700")))), 0x11);
    Bytes several = hex("0200 0600 0E00");
    put_bytes(several, get(1, 1, 7));
    put_bytes(several, get(1, 1, 7));
    EXPECT_EQ(general(send(get(2, 1, 0, service::multiple, several))), 0x11) << "each fits, all together do not";
    EXPECT_TRUE(send(get(0x0F, 1, 1)).empty());
    ASSERT_FALSE(b.values.asked.empty());
    b.adapter.answered(b.values.asked.back(), General::success, Bytes(40, 0x41));
    EXPECT_EQ(general(b.output.streams[1]), 0x11) << "a value that came later";
    EXPECT_EQ(general(send(get(1, 1, 1))), 0) << "the connection goes on";
    Bench c;
    EXPECT_EQ(c.ask(get(0x0F, 1, 1)).data, Bytes{});
    c.output.streams[1].clear();
    c.adapter.answered(c.values.asked.at(0), General::success, Bytes(501, 0x41));
    const Bytes answer = c.output.streams[1];
    ASSERT_GT(answer.size(), 4u);
    EXPECT_EQ(Bytes(answer.end() - 4, answer.end()), hex("8E 00 11 00")) << "504 bytes of an unconnected answer";
}

TEST(CipObjects, AParameterDescribesItself) {
    Bench b;
    EXPECT_EQ(b.ask(get(0x0F, 1, 7)).data, hex("0B 72756E5F63757272656E74"));
    EXPECT_EQ(b.ask(get(0x0F, 4, 7)).data.front(), 16);
    EXPECT_EQ(b.ask(get(0x0F, 4, 4)).data, hex("1000"));
    EXPECT_EQ(b.ask(get(0x0F, 2, 4)).data, hex("0200"));
    EXPECT_EQ(b.ask(get(0x0F, 1, 11)).data, hex("64"));
    EXPECT_EQ(b.ask(get(0x0F, 2, 0, service::get_enum_string, hex("0100"))).data, hex("08 7265766572736564"));
    EXPECT_EQ(b.ask(get(0x0F, 2, 0, service::get_enum_string, hex("0500"))).general, General::invalid_parameter);
    EXPECT_EQ(b.ask(get(0x0F, 1, 0, service::get_enum_string, hex("0100"))).general, General::service_not_supported);
    EXPECT_EQ(b.ask(get(0x0F, 0, 2)).data, hex("0400"));
    EXPECT_EQ(b.ask(get(0x0F, 5, 1)).general, General::object_does_not_exist);
    EXPECT_EQ(status_of(b, get(0x0F, 4, 1, service::set_single, Bytes(4))), General::attribute_not_settable);
    EXPECT_EQ(status_of(b, get(0x0F, 1, 1, service::set_single, Bytes(2))), General::too_much_data);
    (void)b.ask(get(0x0F, 1, 1, service::set_single, hex("2A")));
    EXPECT_EQ(b.values.set_to, hex("2A"));
}

TEST(CipObjects, SeveralRequestsInOneWithAnswersThatComeLater) {
    Bench b;
    Bytes several = hex("0300 0800 1000 1800");
    put_bytes(several, get(1, 1, 1));
    put_bytes(several, get(0x0F, 1, 1));
    put_bytes(several, get(1, 1, 99));
    b.output.streams[1].clear();
    (void)b.ask(get(2, 1, 0, service::multiple, several));
    ASSERT_EQ(b.values.asked.size(), 1u);
    b.output.streams[1].clear();
    b.adapter.answered(b.values.asked[0], General::success, hex("2A"));
    const Bytes a = b.output.streams[1];
    const Bytes wanted = hex("8A 00 1E 00 0300 0800 0E00 1300 8E000000 FFFF 8E000000 2A 8E001400");
    ASSERT_GT(a.size(), wanted.size());
    EXPECT_EQ(Bytes(a.end() - static_cast<std::ptrdiff_t>(wanted.size()), a.end()), wanted);
    EXPECT_EQ(status_of(b, get(2, 1, 0, service::multiple, hex("0300 0800"))), General::not_enough_data);
    EXPECT_EQ(status_of(b, get(2, 1, 0, service::multiple, hex("0100 FF00 0E"))), General::invalid_parameter);
}

TEST(CipObjects, UnconnectedSendToItself) {
    Bench b;
    const Bytes inner = get(1, 1, 1);
    Bytes data = hex("0A 0E");
    put16(data, static_cast<std::uint16_t>(inner.size()));
    put_bytes(data, inner);
    Bytes here = data, away = data;
    put_bytes(here, hex("01 00 01 00"));
    put_bytes(away, hex("01 00 01 05"));
    const Answer good = b.ask(get(6, 1, 0, service::unconnected_send, here));
    EXPECT_EQ(good.service, service::get_single);
    EXPECT_EQ(good.data, hex("FFFF"));
    const Answer bad = b.ask(get(6, 1, 0, service::unconnected_send, away));
    EXPECT_EQ(bad.general, General::connection_failure);
    EXPECT_EQ(bad.extended, std::vector<std::uint16_t>{0x0312});
    const Answer empty = b.ask(get(6, 1, 0, service::unconnected_send, hex("0A 0E 0000 01 00 01 00")));
    EXPECT_EQ(empty.general, General::connection_failure);
    EXPECT_EQ(empty.extended, std::vector<std::uint16_t>{0x0205}) << "no message inside";
}

TEST(CipObjects, WaitingMessagesAreBounded) {
    Bench b;
    for (std::size_t i = 0; i < Adapter::most_waiting; ++i)
        (void)b.ask(get(0x0F, 1, 1));
    EXPECT_EQ(status_of(b, get(0x0F, 1, 1)), General::resource_unavailable);
    EXPECT_EQ(status_of(b, get(1, 1, 1)), General::success) << "what need not wait is answered";
    b.adapter.on_disconnected(1);
    b.adapter.answered(b.values.asked[0], General::success, hex("01"));
}

TEST(CipObjects, ResetEndsConnectionsButNotThoseOfAnotherOwner) {
    Bench b;
    ASSERT_NE(b.opened({}), 0u);
    b.connect(2, Bench::other);
    b.register_session(2);
    EXPECT_EQ(b.ask(get(1, 1, 0, service::reset), 2).general, General::device_state_conflict);
    EXPECT_EQ(b.ask(get(1, 1, 0, service::reset, hex("01"))).general, General::invalid_parameter);
    EXPECT_EQ(b.ask(get(1, 1, 0, service::reset)).general, General::success);
    EXPECT_EQ(b.values.reported.back(), "ended 151 closed");
}
}  // namespace
}  // namespace axisgate::cip
