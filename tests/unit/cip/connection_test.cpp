// Opening of connections, with every extended status; their data, times and ends.
#include <gtest/gtest.h>

#include "tests/unit/cip/bench.hpp"

namespace axisgate::cip {
namespace {
using namespace std::chrono_literals;
using bench::Bench;
using bench::get;
using bench::hex;
using bench::Open;

const std::string run = "01000000", idle = "00000000";
const std::string data = "1F000102" + std::string(56, '0');

TEST(CipConnections, ForwardOpenByteForByte) {
    Bench b;
    const Answer a = b.open({});
    EXPECT_EQ(a.general, General::success);
    EXPECT_EQ(a.data, hex("01000101 00500000 0100 3412 4D000000 10270000 10270000 00 00"));
    EXPECT_EQ(b.values.reported, std::vector<std::string>{"opened 151"});
    EXPECT_EQ(b.ask(Open{}.close()).data, hex("0100 3412 4D000000 00 00"));
    EXPECT_EQ(b.values.reported.back(), "ended 151 closed");
}

struct Wrong {
    const char* what;
    std::function<void(Open&)> change;
    std::vector<std::uint16_t> extended;
};

TEST(CipConnections, EveryExtendedStatus) {
    const Wrong list[] = {
        {"transport class 2", [](Open& o) { o.transport = 2; }, {0x0103}},
        {"transport class 4", [](Open& o) { o.transport = 4; }, {0x011C}},
        {"transport class 15", [](Open& o) { o.transport = 0x0F; }, {0x011C}},
        {"trigger 3", [](Open& o) { o.transport = 0x31; }, {0x011D}},
        {"trigger 7", [](Open& o) { o.transport = 0x73; }, {0x011D}},
        {"RPI under 1 ms", [](Open& o) { o.ot_rpi = 999; }, {0x0111}},
        {"time-out of 25 days", [](Open& o) { o.ot_rpi = 0xFFFFFFFF, o.multiplier = 7; }, {0x0111}},
        {"RPI above 10 s", [](Open& o) { o.ot_rpi = 10'000'001; }, {0x0111}},
        {"time-out above 2 min", [](Open& o) { o.ot_rpi = 300'000, o.multiplier = 7; }, {0x0111}},
        {"messages, time-out above 1 h",
         [](Open& o) { o.transport = 0xA3, o.path = "20 02 24 01", o.ot_rpi = 10'000'000, o.multiplier = 7; },
         {0x0111}},
        {"vendor", [](Open& o) { o.path = "34 04 0100 0000 0000 00 00 " + o.path; }, {0x0114}},
        {"product", [](Open& o) { o.path = "34 04 FFFF 0C00 0900 00 00 " + o.path; }, {0x0114}},
        {"type", [](Open& o) { o.path = "34 04 FFFF 0200 0100 00 00 " + o.path; }, {0x0115}},
        {"revision", [](Open& o) { o.path = "34 04 FFFF 0C00 0100 03 08 " + o.path; }, {0x0116}},
        {"compatible, but newer", [](Open& o) { o.path = "34 04 FFFF 0C00 0100 83 08 " + o.path; }, {0x0116}},
        {"inhibit time", [](Open& o) { o.path += " 43 14"; }, {0x011B}},
        {"O->T multicast", [](Open& o) { o.ot_type = 1; }, {0x0123}},
        {"T->O reserved", [](Open& o) { o.to_type = 3; }, {0x0124}},
        {"O->T size", [](Open& o) { o.ot_size = 36; }, {0x0127, 38}},
        {"T->O size", [](Open& o) { o.to_size = 32; }, {0x0128, 34}},
        {"too small, variable", [](Open& o) { o.variable = true, o.ot_size = 30; }, {0x0127, 38}},
        {"configuration", [](Open& o) { o.path = "20 04 24 65 2C 97 2C 65"; }, {0x0129}},
        {"configuration data", [](Open& o) { o.path += " 80 01 AABB"; }, {0x0126}},
        {"consuming", [](Open& o) { o.path = "20 04 24 C7 2C 65 2C 65"; }, {0x012A}},
        {"producing", [](Open& o) { o.path = "20 04 24 C7 2C 97 2C 97"; }, {0x012B}},
        {"four places", [](Open& o) { o.path = "20 04 24 C7 2C 97 2C 65 2C 66"; }, {0x012F}},
        {"another class", [](Open& o) { o.path = "20 05 24 C7 2C 97 2C 65"; }, {0x0117}},
        {"multiplier", [](Open& o) { o.multiplier = 8; }, {0x0133}},
        {"nobody to listen to", [](Open& o) { o.path = "20 04 24 C7 2C C5 2C 65", o.ot_size = 2; }, {0x0119}},
        {"another slot", [](Open& o) { o.path = "01 03 " + o.path; }, {0x0312}},
        {"another port", [](Open& o) { o.path = "02 00 " + o.path; }, {0x0311}},
        {"a segment", [](Open& o) { o.path += " FF 00"; }, {0x0315}},
        {"T->O RPI under 1 ms", [](Open& o) { o.to_rpi = 999; }, {0x0111}},
        {"a redundant owner", [](Open& o) { o.redundant = true; }, {0x0125}},
        {"nothing to the device", [](Open& o) { o.ot_type = 0; }, {0x0123}},
        {"an output without an axis", [](Open& o) { o.path = "20 04 24 C7 2C 99 2C 65", o.ot_size = 6; }, {0x0110}},
        {"an input without an axis", [](Open& o) { o.path = "20 04 24 C7 2C 97 2C 67", o.to_size = 2; }, {0x0110}},
        {"a class that is no router", [](Open& o) { o.transport = 0xA3, o.path = "20 04 24 01"; }, {0x0117}},
        {"messages by multicast", [](Open& o) { o.transport = 0xA3, o.path = "20 02 24 01", o.to_type = 1; }, {0x0124}},
        {"messages of a client", [](Open& o) { o.transport = 0x23, o.path = "20 02 24 01"; }, {0x011E}},
        {"messages too short to the device", [](Open& o) { o.transport = 0xA3, o.path = "20 02 24 01", o.ot_size = 7; }, {0x0127}},
        {"messages too short from it", [](Open& o) { o.transport = 0xA3, o.path = "20 02 24 01", o.to_size = 7; }, {0x0128}},
        {"messages too long",
         [](Open& o) { o.transport = 0xA3, o.path = "20 02 24 01", o.large = true, o.to_size = 4003; },
         {0x0109, 4002}},
    };
    for (const Wrong& w : list) {
        Bench b;
        Open o;
        w.change(o);
        const Answer a = b.open(o);
        EXPECT_EQ(a.general, General::connection_failure) << w.what;
        EXPECT_EQ(a.extended, w.extended) << w.what;
        EXPECT_EQ(Bytes(a.data.begin(), a.data.begin() + 8), hex("0100 3412 4D000000")) << w.what;
        EXPECT_EQ(b.adapter.connections().open(), 0u) << w.what;
    }
    Bench b;
    Open o;
    o.path_words = 20;
    EXPECT_EQ(b.open(o).general, General::not_enough_data);
    o.path_words = 2;
    EXPECT_EQ(b.open(o).general, General::too_much_data);
}

TEST(CipConnections, WhatIsAccepted) {
    for (const auto* path : {"20 04 24 C7 2C 97 2C 65", "20 04 2C 97 2C 65", "01 00 20 04 24 C7 2C 97 2C 65", "20 04 24 C7 24 97 24 65",
                             "34 04 FFFF 0C00 0100 03 07 20 04 24 C7 2C 97 2C 65", "34 04 FFFF 0C00 0100 83 06 20 04 24 C7 2C 97 2C 65",
                             "34 04 0000 0000 0000 00 00 20 04 24 C7 2C 97 2C 65"}) {
        Bench b;
        Open o;
        o.path = path;
        EXPECT_NE(b.opened(o), 0u) << path;
    }
    Bench b;
    Open large;
    large.large = true;
    EXPECT_NE(b.opened(large), 0u);
    Open class0;
    class0.serial = 2, class0.transport = 0, class0.ot_size = 36, class0.to_size = 32;
    class0.path = "20 04 24 C7 2C 98 2C 65";
    EXPECT_NE(b.opened(class0), 0u);
}

TEST(CipConnections, OneOwnerAndAsManyReadersAsThereIsRoomFor) {
    Bench b;
    ASSERT_NE(b.opened({}), 0u);
    EXPECT_EQ(b.open({}).extended, std::vector<std::uint16_t>{0x0100}) << "the same triad again";
    Open second;
    second.serial = 2;
    EXPECT_EQ(b.open(second).extended, std::vector<std::uint16_t>{0x0106});
    second.path = "20 04 24 C7 2C 96 2C 64";
    second.ot_size = 70, second.to_size = 66;
    EXPECT_EQ(b.open(second).extended, std::vector<std::uint16_t>{0x0106}) << "all axes are this one, too";
    Open listener;
    listener.path = "20 04 24 C7 2C C5 2C 65", listener.ot_size = 2, listener.serial = 3, listener.to_type = 1;
    EXPECT_NE(b.opened(listener), 0u);
    EXPECT_EQ(b.adapter.connections().open(), 2u);
    (void)b.ask(Open{}.close());
    EXPECT_EQ(b.adapter.connections().open(), 0u) << "who only listens goes with the last one that does not";
    Open reader;
    reader.path = "20 04 24 C7 2C C6 2C 65", reader.ot_size = 2;
    constexpr std::size_t share = ConnectionManager::most_connections - ConnectionManager::kept;
    for (reader.serial = 10; reader.serial < 10 + share; ++reader.serial)
        ASSERT_NE(b.opened(reader), 0u);
    EXPECT_EQ(b.open(reader).extended, std::vector<std::uint16_t>{0x0113});
}

TEST(CipConnections, WhatAnotherDoorHoldsIsNotOwned) {
    Bench b;
    b.values.held = true;
    EXPECT_EQ(b.open({}).extended, std::vector<std::uint16_t>{0x0106});
}

TEST(CipConnections, NullForwardOpenAsksAndOpensNothing) {
    Bench b;
    Open null;
    null.ot_type = null.to_type = 0;
    null.ot_size = null.to_size = 0;
    EXPECT_EQ(b.open(null).general, General::success);
    EXPECT_EQ(b.adapter.connections().open(), 0u);
    const std::uint32_t id = b.opened({});
    const Answer matching = b.open(null);
    EXPECT_EQ(Reader(matching.data).u32(), id) << "the same triad: it names the open one";
    null.path = "34 04 FFFF 0C00 0100 00 00 20 04 24 C7 2C 97 2C 65 80 00";
    EXPECT_EQ(b.open(null).general, General::success) << "a key and an empty configuration are no other path";
    null.path = "20 04 24 C7 2C 97 2C 65 80 01 AABB";
    EXPECT_EQ(b.open(null).extended, std::vector<std::uint16_t>{0x0126}) << "there is nothing to configure";
    null.path = "20 04 24 C7 2C 98 2C 65";
    EXPECT_EQ(b.open(null).extended, std::vector<std::uint16_t>{0x012F});
    null.serial = 2, null.path = "20 04 24 C7 2C 09 2C 65";
    EXPECT_EQ(b.open(null).extended, std::vector<std::uint16_t>{0x0117}) << "no such assembly";
    null.path = "34 04 0100 0000 0000 00 00 20 04 24 C7 2C 97 2C 65";
    EXPECT_EQ(b.open(null).extended, std::vector<std::uint16_t>{0x0114}) << "a ping of another device";
    null.path = "20 04 24 C7 2C 97 2C 65 80 01 AABB";
    EXPECT_EQ(b.open(null).extended, std::vector<std::uint16_t>{0x0126});
    EXPECT_EQ(b.values.reported, std::vector<std::string>{"opened 151"}) << "what is open does not notice any of it";
}

TEST(CipConnections, AMatchingForwardOpenIsADuplicateWhateverItsPath) {
    Bench b;
    ASSERT_NE(b.opened({}), 0u);
    Open again;
    again.path = "20 04 24 C7 2C 98 2C 66";
    EXPECT_EQ(b.open(again).extended, std::vector<std::uint16_t>{0x0100});
    again.transport = 0xA3, again.path = "20 02 24 01";
    EXPECT_EQ(b.open(again).extended, std::vector<std::uint16_t>{0x0100});
    EXPECT_EQ(b.adapter.connections().open(), 1u);
}

TEST(CipConnections, ForwardCloseNamesThePathOfTheConnection) {
    Bench b;
    ASSERT_NE(b.opened({}), 0u);
    Open wrong;
    wrong.path = "20 04 24 C7 2C 98 2C 65";
    const Answer a = b.ask(wrong.close());
    EXPECT_EQ(a.general, General::connection_failure);
    EXPECT_EQ(a.extended, std::vector<std::uint16_t>{0x0316});
    EXPECT_EQ(a.data, hex("0100 3412 4D000000 00 00"));
    wrong.path = "";
    EXPECT_EQ(b.ask(wrong.close()).extended, std::vector<std::uint16_t>{0x0316});
    wrong.path = "20 04 24 C7 FF 00";
    EXPECT_EQ(b.ask(wrong.close()).extended, std::vector<std::uint16_t>{0x0315});
    EXPECT_EQ(b.adapter.connections().open(), 1u);
    Open right;
    right.path = "34 04 FFFF 0C00 0100 00 00 20 04 24 C7 24 97 24 65 80 00";
    EXPECT_EQ(b.ask(right.close()).general, General::success) << "the same objects, otherwise written";
    EXPECT_EQ(b.adapter.connections().open(), 0u);
    EXPECT_EQ(b.adapter.connections().counters().close_other.value(), 2u);
    EXPECT_EQ(b.adapter.connections().counters().close_format.value(), 1u);
    ASSERT_NE(b.opened({}), 0u);
    Open router;
    router.path = "20 02 24 01";
    EXPECT_EQ(b.ask(router.close()).general, General::success) << "by the three numbers alone, as some clients close";
}

TEST(CipConnections, WhatNeverBringsAnythingIsClosedInTenSeconds) {
    Bench b;
    Open reader;
    reader.path = "20 04 24 C7 2C C6 2C 65", reader.ot_size = 2, reader.ot_rpi = 200'000, reader.multiplier = 7;
    const std::uint32_t id = b.opened(reader);
    reader.serial = 2;
    const std::uint32_t used = b.opened(reader);
    ASSERT_NE(id, 0u);
    b.implicit(used, 1, 1, "");
    b.pass(std::chrono::seconds(11));
    EXPECT_EQ(b.adapter.connections().open(), 1u) << "its time-out of 102 s counts from the first datagram on";
}

TEST(CipConnections, NoAddressTakesThePlacesOfOthers) {
    Bench b;
    b.connect(2, Bench::other);
    b.register_session(2);
    Open reader;
    reader.path = "20 04 24 C7 2C C6 2C 65", reader.ot_size = 2, reader.ot_rpi = 100'000;
    std::size_t taken = 0;
    for (reader.serial = 10; b.opened(reader, 2) != 0; ++reader.serial)
        ASSERT_LT(++taken, ConnectionManager::most_connections);
    EXPECT_EQ(taken, ConnectionManager::most_connections - ConnectionManager::kept);
    EXPECT_EQ(b.open(reader, 2).extended, std::vector<std::uint16_t>{0x0113});
    EXPECT_NE(b.opened({}), 0u) << "a quarter is kept for owners";
    reader.serial = 1;
    reader.originator = 1;
    EXPECT_NE(b.opened(reader), 0u) << "one of those that never brought anything gives way";
    EXPECT_EQ(b.adapter.connections().open(), taken + 1);
    EXPECT_EQ(b.adapter.connections().counters().evicted.value(), 1u);
}

TEST(CipConnections, TheEndOfAWayOfMessagesIsTold) {
    Bench b;
    Open o;
    o.transport = 0xA3, o.path = "20 02 24 01", o.ot_size = o.to_size = 500;
    ASSERT_NE(b.opened(o), 0u);
    b.pass(std::chrono::seconds(11));
    EXPECT_EQ(b.values.reported, std::vector<std::string>{"messages ended"}) << "its time-out";
    ASSERT_NE(b.opened(o), 0u);
    (void)b.ask(o.close());
    EXPECT_EQ(b.values.reported.size(), 2u);
    b.adapter.on_disconnected(1);
    EXPECT_EQ(b.values.reported.back(), "session ended");
}

TEST(CipConnections, MessagesNeverTakeTheLastPlaceOfAnOwner) {
    Bench b;
    Open o;
    o.transport = 0xA3, o.path = "20 02 24 01", o.ot_size = o.to_size = 500;
    for (o.serial = 10; o.serial < 10 + ConnectionManager::most_explicit - ConnectionManager::kept_explicit; ++o.serial)
        ASSERT_NE(b.opened(o), 0u);
    EXPECT_EQ(b.open(o).extended, std::vector<std::uint16_t>{0x011A});
    EXPECT_NE(b.opened({}), 0u);
}

TEST(CipConnections, DataInRunModeFallToIdleAndBack) {
    Bench b;
    const std::uint32_t id = b.opened({});
    b.implicit(id, 1, 1, run + data);
    EXPECT_EQ(b.values.reported.back(), "consumed 151 1f000102");
    b.implicit(id, 2, 1, run + data);
    EXPECT_EQ(b.values.reported.size(), 2u) << "the same count: nothing new";
    b.implicit(id, 3, 2, idle + data);
    EXPECT_EQ(b.values.reported.back(), "idle 151");
    b.implicit(id, 4, 3, idle);
    EXPECT_EQ(b.values.reported.size(), 3u);
    b.implicit(id, 5, 3, run + data);
    EXPECT_EQ(b.values.reported.back(), "consumed 151 1f000102") << "run again, even with the count of before";
}

TEST(CipConnections, WrongDataAreDroppedAndCounted) {
    Bench b;
    const std::uint32_t id = b.opened({});
    const auto& c = b.adapter.connections().counters();
    b.implicit(id, 10, 1, run + data);
    b.implicit(id, 10, 2, run + data);
    b.implicit(id, 9, 3, run + data);
    EXPECT_EQ(c.stale.value(), 2u);
    b.implicit(id, 11, 4, run + data + "00");
    b.implicit(id, 11, 4, "01");
    EXPECT_EQ(c.wrong_size.value(), 2u);
    b.implicit(id, 12, 5, run + data, Bench::other);
    EXPECT_EQ(c.from_wrong_address.value(), 1u);
    b.implicit(id + 0x10000, 12, 5, run + data);
    b.adapter.on_implicit(hex("0200 0280"), Bench::plc, b.now);
    EXPECT_EQ(c.unknown_connection.value(), 2u);
    EXPECT_EQ(b.values.reported.size(), 2u);
    b.implicit(id, 0x8000000Au, 6, run + data);
    EXPECT_EQ(c.stale.value(), 3u) << "half way round is behind";
}

TEST(CipConnections, SequencesGoRound) {
    Bench b;
    const std::uint32_t id = b.opened({});
    b.implicit(id, 0xFFFFFFFF, 1, run + data);
    b.implicit(id, 0, 2, run + data);
    EXPECT_EQ(b.values.reported.size(), 3u);
}

TEST(CipConnections, DataAreProducedAtTheirInterval) {
    Bench b;
    (void)b.opened({});
    b.pass(95ms);
    ASSERT_EQ(b.output.implicits.size(), 10u);
    const auto& first = b.output.implicits[0];
    EXPECT_EQ(first.to, (Endpoint{Bench::plc.address, default_io_port}));
    EXPECT_EQ(first.dscp, QosObject::dscp_scheduled);
    EXPECT_EQ(Bytes(first.bytes.begin(), first.bytes.begin() + 22), hex("0200 0280 0800 00500000 01000000 B100 2200 0100 1111"));
    EXPECT_EQ(first.bytes.size(), 20u + 32u);
    EXPECT_EQ(b.output.implicits[9].bytes[10], 10) << "a number of its own for each";
}

TEST(CipConnections, ASleepIsNotMadeUpFor) {
    Bench b;
    (void)b.opened({});
    b.now += 35ms;
    b.adapter.on_deadline(b.now);
    EXPECT_EQ(b.output.implicits.size(), 1u);
    EXPECT_EQ(b.adapter.deadline(), b.now + 10ms);
}

TEST(CipConnections, ChangeOfStateIsSentBetweenTheIntervals) {
    Bench b;
    Open o;
    o.transport = 0x11, o.to_rpi = 100'000, o.path += " 43 05";
    (void)b.opened(o);
    b.pass(50ms);
    EXPECT_EQ(b.output.implicits.size(), 1u);
    ++b.values.changes;
    b.pass(5ms);
    EXPECT_EQ(b.output.implicits.size(), 2u);
    b.pass(100ms);
    EXPECT_EQ(b.output.implicits.size(), 3u);
}

TEST(CipConnections, SilenceEndsAConnectionAfterItsTimeOut) {
    Bench b;
    const std::uint32_t id = b.opened({});
    b.pass(9s);
    b.implicit(id, 1, 1, run + data);
    const std::size_t sent = b.output.implicits.size();
    b.pass(39ms);
    EXPECT_EQ(b.values.reported.back(), "consumed 151 1f000102");
    b.pass(1ms);
    EXPECT_EQ(b.values.reported.back(), "ended 151 timed out");
    b.pass(1s);
    EXPECT_LE(b.output.implicits.size(), sent + 4) << "both halves stop";
    ASSERT_NE(b.opened({}), 0u);
    b.pass(9999ms);
    EXPECT_TRUE(b.adapter.connections().owned()) << "the first datagram has 10 s";
    b.pass(1ms);
    EXPECT_FALSE(b.adapter.connections().owned());
}

TEST(CipConnections, AMulticastGroupIsSentOnceAndOutlivesWhoBeganIt) {
    Bench b;
    Open owner;
    owner.to_type = 1;
    const Answer first = b.open(owner);
    const std::uint32_t group = Reader(View(first.data).subspan(4)).u32();
    EXPECT_NE(group, 0x5000u) << "the device names it";
    const auto list = read_items(b.items);
    ASSERT_TRUE(list && list->find(item::sockaddr_to));
    EXPECT_EQ(endpoint_of(*list->find(item::sockaddr_to))->address >> 16, 0xEFC0u);
    Open reader;
    reader.serial = 2, reader.path = "20 04 24 C7 2C C6 2C 65", reader.ot_size = 2, reader.to_type = 1;
    const Answer second = b.open(reader);
    EXPECT_EQ(Reader(View(second.data).subspan(4)).u32(), group);
    b.pass(95ms);
    EXPECT_EQ(b.output.implicits.size(), 10u);
    (void)b.ask(owner.close());
    b.pass(100ms);
    EXPECT_EQ(b.output.implicits.size(), 20u);
    EXPECT_EQ(b.output.implicits.back().bytes[10], 20) << "its numbers go on";
}

TEST(CipConnections, ExplicitMessagesOverAConnection) {
    Bench b;
    Open o;
    o.transport = 0xA3, o.path = "20 02 24 01", o.ot_size = o.to_size = 500;
    const std::uint32_t id = b.opened(o);
    ASSERT_NE(id, 0u);
    const auto send = [&](std::uint16_t count, View message) {
        Bytes d = hex("00000000 0000 0200 A100 0400");
        put32(d, id);
        put16(d, item::connected_data);
        put16(d, static_cast<std::uint16_t>(2 + message.size()));
        put16(d, count);
        put_bytes(d, message);
        return b.packet_of(1, 0x70, d);
    };
    const Bytes answer = send(1, get(1, 1, 1));
    EXPECT_EQ(Bytes(answer.begin() + 24, answer.end()), hex("00000000 0000 0200 A100 0400 00500000 B100 0800 0100 8E000000 FFFF"));
    EXPECT_EQ(send(1, get(1, 1, 3)), answer) << "a repetition gets the answer of before";
    EXPECT_NE(send(2, get(1, 1, 3)), answer);
    b.pass(10s);
    EXPECT_TRUE(send(3, get(1, 1, 1)).empty()) << "silent for too long";
    ASSERT_NE(b.opened(o), 0u);
    b.adapter.on_disconnected(1);
    EXPECT_EQ(b.adapter.connections().open(), 0u) << "it goes with its TCP connection";
}

TEST(CipConnections, ImplicitConnectionsOutliveTheirSession) {
    Bench b;
    ASSERT_NE(b.opened({}), 0u);
    b.adapter.on_disconnected(1);
    EXPECT_EQ(b.adapter.connections().open(), 1u);
}

TEST(CipConnections, ConnectionDataAndAWrongClose) {
    Bench b;
    ASSERT_NE(b.opened({}), 0u);
    const Answer a = b.ask(get(6, 1, 0, service::get_connection_data, hex("0100")));
    EXPECT_EQ(a.data, hex("0100 0300 0100 0100 0100 3412 4D000000 00000000 01000101 00000000 10270000 10270000"
                          "00500000 00500000 00000000 10270000 10270000"));
    EXPECT_EQ(b.ask(get(6, 1, 0, service::search_connection_data, hex("0100 3412 4D000000"))).data, a.data);
    EXPECT_EQ(b.ask(get(6, 1, 0, service::get_connection_data, hex("0900"))).general, General::path_destination_unknown);
    Open wrong;
    wrong.serial = 9;
    EXPECT_EQ(b.ask(wrong.close()).extended, std::vector<std::uint16_t>{0x0107});
    b.connect(2, Bench::other);
    b.register_session(2);
    EXPECT_EQ(b.ask(Open{}.close(), 2).extended, std::vector<std::uint16_t>{0x0107}) << "not another's";
    EXPECT_EQ(b.ask(get(6, 1, 1)).data, hex("0100"));
}

TEST(CipConnections, TheGatewayClosesThemWhenTheirAssembliesChange) {
    Bench b;
    ASSERT_NE(b.opened({}), 0u);
    b.adapter.connections().close_all(End::by_gateway, b.now);
    EXPECT_EQ(b.values.reported.back(), "ended 151 by gateway");
    EXPECT_EQ(b.adapter.connections().open(), 0u);
}
}  // namespace
}  // namespace axisgate::cip
