// TwinBus: wire time, arbitration, collisions, lateness, bounds; all in virtual time.
// In: scripted twins. Out: pass or fail. Never sleeps.
#include "gateway/wire/twin_bus.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/wire/twin_bus_fixture.hpp"

namespace axisgate {
namespace {

using namespace test;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr Instant begin = time_zero + std::chrono::seconds(10);

TwinBusOptions can_bus(std::uint32_t bit_rate = 1'000'000) { return {LineKind::can, bit_rate, 10, false}; }
TwinBusOptions wires(std::uint32_t bit_rate, bool full_duplex = false) { return {LineKind::bytes, bit_rate, 10, full_duplex}; }

struct Bus {
    explicit Bus(const TwinBusOptions& o) : bus(o) {
        bus.open(owner, begin);
        bus.on_deadline(begin);
    }
    ScriptTwin& add(int key, Acceptance acceptance = {}) {
        auto twin = std::make_unique<ScriptTwin>();
        twin->accepts = acceptance;
        ScriptTwin& t = *twin;
        bus.add(static_cast<DriveId>(key), std::move(twin), {}, begin);
        return t;
    }
    void send(const Frame& f, Instant at = begin, Priority p = Priority::command) { EXPECT_TRUE(bus.send(f, p, at)); }
    void run_to(Instant until) { run(bus, until); }
    [[nodiscard]] std::vector<std::uint32_t> ids() const {
        std::vector<std::uint32_t> v;
        for (const auto& f : all)
            v.push_back(f.id);
        return v;
    }
    void keep_order() {
        owner.receives = [this](const Frame& f) { all.push_back(f); };
        owner.has_sent = [this](const Frame& f) { all.push_back(f); };
    }
    Owner owner;
    TwinBus bus;
    std::vector<Frame> all;
};

// --- CAN ------------------------------------------------------------------------------------------------------------

TEST(TwinBusCan, deliversAtTheEndOfTheFrame) {
    Bus b(can_bus());
    ScriptTwin& twin = b.add(1);
    twin.receives = [](const Frame&, Instant, Out& out) { out.send(can(0x04280095, {1})); };
    const Frame request = can(0x18FF1234, {1, 2, 3, 4, 5, 6, 7, 8});  // 140 bits with its stuff bits
    b.send(request);
    EXPECT_EQ(b.bus.deadline(), begin);
    b.run_to(begin + us(139));
    EXPECT_TRUE(twin.received.empty());
    EXPECT_EQ(b.bus.deadline(), begin + us(140));
    b.run_to(begin + ms(1));
    ASSERT_EQ(twin.received.size(), 1u);
    EXPECT_TRUE(twin.received[0].first.same(request));
    EXPECT_EQ(twin.received[0].second, begin + us(140));
    EXPECT_EQ(twin.received[0].first.at, begin + us(140));
    ASSERT_EQ(b.owner.sent.size(), 1u);
    EXPECT_EQ(b.owner.sent[0].at, begin + us(140));
    ASSERT_EQ(b.owner.frames.size(), 1u);
    EXPECT_EQ(b.owner.frames[0].at, begin + us(140 + 3 + 77));  // three bits of intermission, then the answer's 77
    EXPECT_EQ(b.bus.deadline(), never);
}

TEST(TwinBusCan, takesLongerAtALowerBitRate) {
    Bus b(can_bus(125'000));
    b.send(can(0x04280095, {1}));
    b.run_to(begin + ms(2));
    ASSERT_EQ(b.owner.sent.size(), 1u);
    EXPECT_EQ(b.owner.sent[0].at, begin + us(77 * 8));
}

TEST(TwinBusCan, arbitratesLowestIdentifierFirstAmongAllNodes) {
    Bus b(can_bus());
    b.keep_order();
    for (const int id : {7, 3, 5}) {
        ScriptTwin& t = b.add(id);
        t.next = begin + us(50);
        t.due = [id](Instant, Out& out) {
            out.send(can(static_cast<std::uint32_t>(id) * 16));
            out.send(can(1));  // behind it: a node offers one frame at a time
        };
        (void)b.bus.set_hand(static_cast<DriveId>(id), "", {}, begin);  // so that the bus looks at the deadline
    }
    b.send(can(4 * 16), begin + us(50));
    b.run_to(begin + ms(5));
    EXPECT_THAT(b.ids(), ElementsAre(3 * 16, 1, 4 * 16, 5 * 16, 1, 7 * 16, 1));
}

TEST(TwinBusCan, aWaitingFrameLosesToALowerOneThatCameLater) {
    Bus b(can_bus());
    b.keep_order();
    b.add(1);
    b.send(can(100));
    b.send(can(90), begin + us(1));
    b.bus.on_deadline(begin + us(2));
    ScriptTwin& twin = b.add(2);
    twin.shout = can(80);
    EXPECT_EQ(b.bus.set_hand(DriveId{2}, "shout", true, begin + us(20)), "");
    b.run_to(begin + ms(1));
    EXPECT_THAT(b.ids(), ElementsAre(100, 80, 90));  // the one on the wire is not interrupted
}

TEST(TwinBusCan, urgentFramesOfTheHostGoFirstWithinTheHost) {
    Bus b(can_bus());
    b.keep_order();
    ScriptTwin& twin = b.add(1);
    twin.shout = can(50);
    (void)b.bus.set_hand(DriveId{1}, "shout", true, begin);
    b.send(can(10), begin, Priority::poll);
    b.send(can(20), begin, Priority::command);
    b.send(can(60), begin, Priority::urgent);
    b.run_to(begin + ms(1));
    // The host offers its stop (60), which loses the bus to the twin's 50 and then goes before its own lower ones.
    EXPECT_THAT(b.ids(), ElementsAre(50, 60, 20, 10));
}

TEST(TwinBusCan, hasNoWireTimeAtBitRateZero) {
    Bus b(can_bus(0));
    ScriptTwin& twin = b.add(1);
    twin.receives = [](const Frame& f, Instant, Out& out) {
        if (f.id == 1) out.send(can(2));
    };
    b.send(can(1));
    b.bus.on_deadline(begin);
    ASSERT_EQ(b.owner.frames.size(), 1u);
    EXPECT_EQ(b.owner.frames[0].at, begin);
    EXPECT_EQ(b.bus.status(begin).load, 0.0);
}

TEST(TwinBusCan, everybodyHearsEverybodyElse) {
    Bus b(can_bus());
    ScriptTwin& one = b.add(1);
    ScriptTwin& two = b.add(2);
    one.shout = can(11);
    (void)b.bus.set_hand(DriveId{1}, "shout", true, begin);
    b.send(can(12), begin);
    b.run_to(begin + ms(1));
    ASSERT_EQ(one.received.size(), 1u);  // not its own
    EXPECT_EQ(one.received[0].first.id, 12u);
    ASSERT_EQ(two.received.size(), 2u);
    EXPECT_EQ(two.received[0].first.id, 11u);
    EXPECT_EQ(b.owner.frames.size(), 1u);
    EXPECT_EQ(b.owner.sent.size(), 1u);
}

TEST(TwinBusCan, aTwinIsCalledForWhatItsFiltersTake) {
    Bus b(can_bus());
    ScriptTwin& one = b.add(1, {{{{0xFF, 1}}}, 1});
    ScriptTwin& two = b.add(2, {{{{0xFF, 2}, {0xFF, 3}}}, 2});
    ScriptTwin& all = b.add(3);
    const auto counts = [&] { return std::array{one.received.size(), two.received.size(), all.received.size()}; };
    b.send(can(0x101));
    b.send(can(0x202));
    b.send(can(0x203));
    b.run_to(begin + ms(1));
    EXPECT_EQ(counts(), (std::array<std::size_t, 3>{1, 2, 3}));

    // Who leaves takes its filters along; whose filters change is asked by them from then on.
    b.bus.remove(DriveId{1});
    two.accepts = {{{{0xFF, 4}}}, 1};
    b.send(can(0x101), begin + ms(1));
    b.send(can(0x202), begin + ms(1));  // by the filters as they were: the twin is not asked before it is called
    b.send(can(0x202), begin + ms(1));
    b.send(can(0x204), begin + ms(1));
    b.run_to(begin + ms(2));
    EXPECT_EQ(two.received.size(), 4u);
    EXPECT_EQ(all.received.size(), 7u);
}

/// Two twins and a host that answer one another for a while; everything that happens, with its instants.
std::vector<std::string> conversation(Duration step) {
    Bus b(can_bus());
    std::vector<std::string> log;
    const auto note = [&log](std::string_view who, const Frame& f, Instant at) {
        log.push_back(std::string(who) + " " + to_text(f) + " " + std::to_string(ns_of(at)) + " " + std::to_string(ns_of(f.at)));
    };
    for (const int key : {1, 2}) {
        ScriptTwin& t = b.add(key);
        ScriptTwin* p = &t;
        t.receives = [=](const Frame& f, Instant now, Out& out) {
            note("twin" + std::to_string(key), f, now);
            if (f.id % 2 == static_cast<unsigned>(key) % 2) out.send(can(f.id + 3, {static_cast<std::uint8_t>(key)}));
            p->next = now + us(170);
        };
        t.due = [=](Instant now, Out& out) {
            if (now < begin + ms(5)) out.send(can(static_cast<std::uint32_t>(500 + key)));
        };
    }
    b.owner.receives = [&](const Frame& f) { note("host", f, f.at); };
    b.owner.has_sent = [&](const Frame& f) { note("sent", f, f.at); };
    b.send(can(1));
    for (Instant t = begin; t <= begin + ms(20); t += step)
        b.bus.on_deadline(t);
    b.bus.on_deadline(begin + ms(20));
    return log;
}

TEST(TwinBusCan, aLateCallGivesTheSameWorld) {
    const auto on_time = conversation(us(1));
    EXPECT_GT(on_time.size(), 60u);
    EXPECT_EQ(conversation(ms(20)), on_time);
    EXPECT_EQ(conversation(us(333)), on_time);
}

TEST(TwinBusCan, aFrameSentNowDoesNotTravelBackToEventsThatAreStillDue) {
    Bus b(can_bus());
    b.keep_order();
    ScriptTwin& twin = b.add(1);
    twin.next = begin + us(10);
    twin.due = [](Instant, Out& out) { out.send(can(900)); };
    (void)b.bus.set_hand(DriveId{1}, "", {}, begin);
    // The owner is late: at 10 ms it sends before it has let the bus go on.
    b.send(can(1), begin + ms(10));
    b.bus.on_deadline(begin + ms(11));
    ASSERT_EQ(b.all.size(), 2u);
    EXPECT_EQ(b.all[0].id, 900u);
    EXPECT_LT(b.all[0].at, begin + us(200));
    EXPECT_GE(b.all[1].at, begin + ms(10));
}

TEST(TwinBusCan, callsTwinsAtTheirDeadlinesInOrderOfTime) {
    Bus b(can_bus());
    std::vector<int> order;
    std::vector<ScriptTwin*> twins;
    for (int key = 0; key < 50; ++key) {
        ScriptTwin& t = b.add(key);
        t.next = begin + us((key * 37) % 50 + 1);
        t.due = [&order, key](Instant, Out&) { order.push_back((key * 37) % 50); };
        (void)b.bus.set_hand(static_cast<DriveId>(key), "", {}, begin);
        twins.push_back(&t);
    }
    b.bus.remove(DriveId{7});
    EXPECT_EQ(b.bus.deadline(), begin + us(1));
    b.bus.on_deadline(begin + ms(1));
    EXPECT_EQ(order.size(), 49u);
    EXPECT_TRUE(std::ranges::is_sorted(order));
    EXPECT_EQ(twins[3]->dues, (std::vector<Instant>{begin + us((3 * 37) % 50 + 1)}));
}

TEST(TwinBusCan, aTwinThatIsAlwaysDueDoesNotStopTheWorld) {
    Bus b(can_bus());
    ScriptTwin& stuck = b.add(1);
    stuck.next = begin + us(5);
    stuck.due = [&stuck](Instant now, Out&) { stuck.next = now; };
    (void)b.bus.set_hand(DriveId{1}, "", {}, begin);
    b.send(can(3));
    b.bus.on_deadline(begin + ms(1));
    EXPECT_EQ(b.owner.sent.size(), 1u);
    EXPECT_GT(stuck.dues.size(), 100u);
}

TEST(TwinBusCan, aCallIsBoundedEvenIfTwinsTalkForEverWithoutWireTime) {
    Bus b(can_bus(0));
    for (const int key : {1, 2}) {
        b.add(key).receives = [](const Frame&, Instant, Out& out) { out.send(can(5)); };
    }
    std::size_t received = 0;
    b.owner.receives = [&](const Frame&) { ++received; };
    b.send(can(1));
    b.bus.on_deadline(begin);
    EXPECT_LE(received, TwinBus::max_events_per_call);
    EXPECT_GT(received, 100u);
    EXPECT_LE(b.bus.deadline(), begin);  // it goes on at the next turn
}

TEST(TwinBusCan, aTwinThatFloodsLosesItsOwnFrames) {
    Bus b(can_bus());
    ScriptTwin& twin = b.add(1);
    twin.next = begin + us(1);
    twin.due = [](Instant, Out& out) {
        for (int i = 0; i < 300; ++i)
            out.send(can(7));
    };
    (void)b.bus.set_hand(DriveId{1}, "", {}, begin);
    b.run_to(begin + std::chrono::seconds(1));
    EXPECT_EQ(b.owner.frames.size(), SendQueue::default_capacity);
    EXPECT_EQ(b.bus.counters().twin_dropped, 300 - SendQueue::default_capacity);
}

TEST(TwinBusCan, refusesWhatDoesNotBelong) {
    Bus b(can_bus());
    ScriptTwin& twin = b.add(1);
    EXPECT_FALSE(b.bus.send(text("PR P"), Priority::command, begin));
    Frame report = can(0x40);
    report.kind = Frame::Kind::can_error;
    EXPECT_FALSE(b.bus.send(report, Priority::command, begin));
    twin.shout = text("hello");
    (void)b.bus.set_hand(DriveId{1}, "shout", true, begin);
    b.run_to(begin + ms(1));
    EXPECT_EQ(b.bus.counters().foreign, 3u);
    EXPECT_EQ(b.bus.status(begin).dropped, 2u);
    EXPECT_TRUE(b.owner.frames.empty());
}

TEST(TwinBusCan, isBoundedForTheHost) {
    Bus b(can_bus());
    for (std::size_t i = 0; i < SendQueue::default_capacity; ++i)
        b.send(can(1), begin, Priority::poll);
    EXPECT_FALSE(b.bus.send(can(2), Priority::command, begin));
    EXPECT_EQ(b.bus.status(begin).dropped, 1u);
    EXPECT_EQ(b.bus.status(begin).queued, SendQueue::default_capacity);
    EXPECT_TRUE(b.bus.send(can(3), Priority::urgent, begin));  // a stop finds room all the same
    EXPECT_EQ(b.bus.status(begin).dropped, 2u);
    b.run_to(begin + std::chrono::seconds(1));
    EXPECT_EQ(b.owner.sent.front().id, 3u);
    EXPECT_EQ(b.owner.sent.size(), SendQueue::default_capacity);
}

TEST(TwinBusCan, measuresItsLoad) {
    Bus b(can_bus());
    for (int i = 0; i < 100; ++i)
        b.send(can(0x15555555, {0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55}));  // 128 us each
    b.run_to(begin + ms(500));
    const LineStatus s = b.bus.status(begin + ms(500));
    EXPECT_NEAR(s.load, 0.0128, 0.0001);
    EXPECT_EQ(s.frames_out, 100u);
    EXPECT_EQ(s.bytes_out, 800u);
    EXPECT_EQ(s.state, LineStatus::State::up);
    EXPECT_THAT(s.text, HasSubstr("1000000 bit/s"));
}

// --- bytes ----------------------------------------------------------------------------------------------------------

TEST(TwinBusBytes, chargesEachByte) {
    Bus b(wires(9600));
    ScriptTwin& twin = b.add(1);
    twin.receives = [](const Frame&, Instant, Out& out) { out.send(text("0123456789")); };
    b.send(text("PR P\r"));
    b.run_to(begin + ms(100));
    ASSERT_EQ(twin.received.size(), 1u);
    EXPECT_EQ(twin.received[0].second, begin + Duration(5'208'333));  // 50 bits at 9600 bit/s
    ASSERT_EQ(b.owner.frames.size(), 1u);
    EXPECT_EQ(b.owner.frames[0].at, begin + Duration(5'208'333) + Duration(10'416'667));
    EXPECT_EQ(as_text(b.owner.frames[0]), "0123456789");
}

TEST(TwinBusBytes, oneSenderSendsItsRunsOneAfterTheOther) {
    Bus b(wires(1'000'000));
    b.send(text("aaaa"));
    b.send(text("bb"));
    b.run_to(begin + ms(1));
    ASSERT_EQ(b.owner.sent.size(), 2u);
    EXPECT_EQ(b.owner.sent[0].at, begin + us(40));
    EXPECT_EQ(b.owner.sent[1].at, begin + us(60));
    EXPECT_EQ(b.bus.counters().collisions, 0u);
}

TEST(TwinBusBytes, twoSendersAtOnceGarbleEachOther) {
    Bus b(wires(1'000'000));
    ScriptTwin& one = b.add(1);
    ScriptTwin& two = b.add(2);
    one.shout = text("11111111");  // 0..80 us
    (void)b.bus.set_hand(DriveId{1}, "shout", true, begin);
    b.send(text("hhhh"), begin + us(45));  // 45..85 us: over bytes 4..7 of the twin, and all of its own that end after 45 us
    b.run_to(begin + ms(1));
    ASSERT_EQ(b.owner.frames.size(), 1u);
    const std::string received = as_text(b.owner.frames[0]);
    EXPECT_EQ(received.substr(0, 4), "1111");
    for (std::size_t i = 4; i < 8; ++i)
        EXPECT_NE(received[i], '1') << i;
    ASSERT_EQ(two.received.size(), 2u);
    EXPECT_EQ(as_text(two.received[0].first), received);
    const std::string request = as_text(two.received[1].first);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_NE(request[i], 'h') << i;
    EXPECT_EQ(b.bus.counters().collisions, 2u);
    EXPECT_EQ(b.bus.status(begin + ms(1)).errors, 2u);
}

TEST(TwinBusBytes, aDriveDoesNotReceiveWhileItSendsOnThatPair) {
    Bus b(wires(1'000'000));
    ScriptTwin& one = b.add(1);
    one.shout = text("1111");  // 10 us each
    b.send(text("hhhhhhhh"));
    b.run_to(begin + us(20));
    (void)b.bus.set_hand(DriveId{1}, "shout", true, begin + us(20));  // over bytes 2 to 5
    b.run_to(begin + ms(1));
    ASSERT_EQ(one.received.size(), 1u);
    EXPECT_EQ(as_text(one.received[0].first), "hhhh");
    b.send(text("later"), begin + ms(1));
    b.run_to(begin + ms(2));
    ASSERT_EQ(one.received.size(), 2u);
    EXPECT_EQ(as_text(one.received[1].first), "later");
}

TEST(TwinBusBytes, aThirdSenderDoesNotMakeItGoodAgain) {
    Bus b(wires(1'000'000));
    for (const int key : {1, 2, 3}) {
        ScriptTwin& t = b.add(key);
        t.shout = text(std::string(4, static_cast<char>('0' + key)));
        (void)b.bus.set_hand(static_cast<DriveId>(key), "shout", true, begin);
    }
    b.run_to(begin + ms(1));
    ASSERT_EQ(b.owner.frames.size(), 3u);
    for (const Frame& f : b.owner.frames) {
        for (const char c : as_text(f))
            EXPECT_TRUE(c < '1' || c > '3');
    }
    EXPECT_EQ(b.bus.counters().collisions, 3u);
}

TEST(TwinBusBytes, backToBackIsNoCollision) {
    Bus b(wires(1'000'000));
    ScriptTwin& twin = b.add(1);
    twin.receives = [](const Frame&, Instant, Out& out) { out.send(text("answer")); };  // at once, in the bit after the request's last
    b.send(text("request"));
    b.run_to(begin + ms(1));
    EXPECT_EQ(b.bus.counters().collisions, 0u);
    ASSERT_EQ(b.owner.frames.size(), 1u);
    EXPECT_EQ(as_text(b.owner.frames[0]), "answer");
}

TEST(TwinBusBytes, fullDuplexHasTwoPairsOfWires) {
    Bus b(wires(1'000'000, true));
    ScriptTwin& one = b.add(1);
    ScriptTwin& two = b.add(2);
    one.shout = text("unasked");
    (void)b.bus.set_hand(DriveId{1}, "shout", true, begin);
    b.send(text("request"));
    b.run_to(begin + ms(1));
    EXPECT_EQ(b.bus.counters().collisions, 0u);
    ASSERT_EQ(b.owner.frames.size(), 1u);
    EXPECT_EQ(as_text(b.owner.frames[0]), "unasked");
    ASSERT_EQ(two.received.size(), 1u);  // drives hear the host alone
    EXPECT_EQ(as_text(two.received[0].first), "request");
}

TEST(TwinBusBytes, twoDrivesOnTheReturnPairCollideAlsoInFullDuplex) {
    Bus b(wires(1'000'000, true));
    for (const int key : {1, 2})
        b.add(key).receives = [](const Frame&, Instant, Out& out) { out.send(text("same address")); };
    b.send(text("?"));
    b.run_to(begin + ms(1));
    EXPECT_EQ(b.bus.counters().collisions, 2u);
    EXPECT_NE(as_text(b.owner.frames[0]), "same address");
}

TEST(TwinBusBytes, aConverterSendsWhatDrivesSayAtOnceOneAfterTheOther) {
    TwinBusOptions o = wires(10'000);
    o.converter = true;
    Bus b(o);
    auto& first = b.add(1);
    auto& second = b.add(2);
    for (auto* t : {&first, &second})
        t->receives = [](const Frame&, Instant, Out& out) { out.send(text("0123456789")); };
    b.send(text("ask"));
    b.run_to(begin + ms(100));
    ASSERT_EQ(b.owner.frames.size(), 2u);
    for (const auto& f : b.owner.frames)
        EXPECT_EQ(as_text(f), "0123456789");
    EXPECT_EQ(b.owner.frames[0].at, begin + ms(13));  // three bytes there, ten back
    EXPECT_EQ(b.owner.frames[1].at, begin + ms(23));
    EXPECT_EQ(first.received.size(), 1u);  // no drive hears another one's bytes
    EXPECT_EQ(b.bus.counters().collisions, 0u);
    b.send(text("more"), begin + ms(100));  // the host has a pair of its own
    b.run_to(begin + ms(105));
    b.send(text("still"), begin + ms(105));
    b.run_to(begin + ms(200));
    EXPECT_EQ(b.bus.counters().collisions, 0u);
}

TEST(TwinBusBytes, withoutABitRateNothingCollides) {
    Bus b(wires(0));
    for (const int key : {1, 2})
        b.add(key).receives = [](const Frame& f, Instant, Out& out) {
            if (as_text(f) == "?") out.send(text("here"));
        };
    b.send(text("?"));
    b.bus.on_deadline(begin);
    ASSERT_EQ(b.owner.frames.size(), 2u);
    EXPECT_EQ(as_text(b.owner.frames[0]), "here");
    EXPECT_EQ(b.owner.frames[1].at, begin);
}

// --- the line as such -----------------------------------------------------------------------------------------------

TEST(TwinBus, comesUpFromOnDeadlineAndNotFromOpen) {
    Owner owner;
    TwinBus bus(can_bus());
    EXPECT_EQ(bus.deadline(), never);
    EXPECT_FALSE(bus.send(can(1), Priority::command, begin));  // closed
    bus.open(owner, begin);
    EXPECT_TRUE(owner.states.empty());
    EXPECT_FALSE(bus.send(can(1), Priority::command, begin));  // not up yet
    EXPECT_EQ(bus.status(begin).state, LineStatus::State::opening);
    EXPECT_EQ(bus.deadline(), begin);
    bus.on_deadline(begin);
    EXPECT_TRUE(owner.up());
    EXPECT_EQ(bus.deadline(), never);
    EXPECT_EQ(bus.status(begin).dropped, 2u);
    bus.close();
    EXPECT_EQ(bus.status(begin).state, LineStatus::State::closed);
    EXPECT_EQ(bus.status(begin).text, "closed");
    EXPECT_FALSE(bus.send(can(1), Priority::command, begin));
    EXPECT_EQ(bus.deadline(), never);
}

TEST(TwinBus, neverCallsItsOwnerFromSend) {
    Bus b(can_bus(0));
    b.add(1).receives = [](const Frame& f, Instant, Out& out) {
        if (f.id == 1) out.send(can(2));
    };
    b.send(can(1));
    EXPECT_TRUE(b.owner.sent.empty());
    EXPECT_TRUE(b.owner.frames.empty());
}

TEST(TwinBus, theOwnerMaySendFromItsEvents) {
    Bus b(can_bus());
    b.keep_order();
    b.add(1).receives = [](const Frame& f, Instant, Out& out) {
        if (f.id < 10) out.send(can(f.id + 100));
    };
    b.owner.receives = [&](const Frame& f) {
        b.all.push_back(f);
        if (f.id < 105) b.send(can(f.id - 99), f.at);
    };
    b.send(can(1));
    b.run_to(begin + ms(10));
    EXPECT_THAT(b.ids(), ElementsAre(1, 101, 2, 102, 3, 103, 4, 104, 5, 105));
}

TEST(TwinBus, theOwnerMayCloseOrRemoveFromItsEvents) {
    {
        Bus b(can_bus(0));
        b.add(1).receives = [](const Frame&, Instant, Out& out) { out.send(can(2)); };
        b.owner.receives = [&](const Frame&) { b.bus.close(); };
        b.send(can(1));
        b.bus.on_deadline(begin);
        EXPECT_EQ(b.owner.frames.size(), 1u);
    }
    Bus b(can_bus(0));
    for (const int key : {1, 2, 3})
        b.add(key).receives = [](const Frame& f, Instant, Out& out) {
            if (f.id == 1) out.send(can(2));
        };
    b.owner.has_sent = [&](const Frame&) { b.bus.remove(DriveId{2}); };
    b.owner.receives = [&](const Frame&) {
        b.bus.remove(DriveId{1});
        if (b.bus.size() < 3) b.add(9);
    };
    b.send(can(1));
    b.bus.on_deadline(begin);
    EXPECT_EQ(b.bus.twin(DriveId{1}), nullptr);
    EXPECT_EQ(b.bus.twin(DriveId{2}), nullptr);
    EXPECT_NE(b.bus.twin(DriveId{3}), nullptr);
    EXPECT_NE(b.bus.twin(DriveId{9}), nullptr);
}

TEST(TwinBusBytes, whatATwinSaysReachesTheHostWhileItIsOnTheWire) {
    for (const std::uint32_t rate : {1200U, 9600U, 115200U}) {
        Bus b(wires(rate));
        ScriptTwin& other = b.add(2);
        ScriptTwin& twin = b.add(1);
        const std::string reported(200, 'x');
        twin.next = begin;
        twin.due = [&](Instant, Out& out) {
            out.send(Frame::run({reinterpret_cast<const std::uint8_t*>(reported.data()), reported.size()}));
        };
        (void)b.bus.set_hand(DriveId{1}, "", {}, begin);
        b.run_to(begin + std::chrono::seconds(3));
        const Duration byte = Duration{std::chrono::seconds(1)} * 10 / rate;
        std::size_t got = 0;
        Instant last = begin;
        for (const Frame& f : b.owner.frames) {
            got += f.size;
            EXPECT_LE(f.at - last, std::max<Duration>(TwinBus::run_time, byte) + us(1)) << "no byte waits longer";
            EXPECT_NEAR(static_cast<double>((f.at - begin).count()), static_cast<double>((byte * static_cast<std::int64_t>(got)).count()),
                        2e3);
            last = f.at;
        }
        EXPECT_EQ(got, 200U);
        EXPECT_EQ(b.bus.status(last).bytes_in, 200U);
        ASSERT_EQ(other.received.size(), 1U) << "a twin has it as a whole, at its end";
        EXPECT_EQ(other.received[0].second, last);
    }
}

TEST(TwinBus, aRemovedTwinCompletesTheFrameOnTheWireAndNoOther) {
    Bus b(can_bus());
    ScriptTwin& twin = b.add(1);
    ScriptTwin& other = b.add(2);
    twin.next = begin;
    twin.due = [](Instant, Out& out) {
        out.send(can(1));
        out.send(can(2));
    };
    (void)b.bus.set_hand(DriveId{1}, "", {}, begin);
    b.bus.on_deadline(begin + us(10));
    b.bus.remove(DriveId{1});
    ScriptTwin& next = b.add(3);  // takes over its place inside the bus, but not its frame
    b.run_to(begin + ms(1));
    ASSERT_EQ(b.owner.frames.size(), 1u);
    EXPECT_EQ(b.owner.frames[0].id, 1u);
    EXPECT_EQ(other.received.size(), 1u);
    EXPECT_EQ(next.received.size(), 1u);
    b.bus.remove(DriveId{77});  // nobody: nothing happens
}

TEST(TwinBus, powersTwinsOnWithTheirMemory) {
    Bus b(can_bus());
    auto first = std::make_unique<ScriptTwin>();
    b.bus.add(DriveId{1}, std::move(first), {{"VM", Value(std::int64_t{5})}}, begin);
    auto* twin = dynamic_cast<ScriptTwin*>(b.bus.twin(DriveId{1}));
    ASSERT_NE(twin, nullptr);
    EXPECT_EQ(twin->powered_on, 1);
    EXPECT_EQ(twin->memory.at("VM"), Value(std::int64_t{5}));
    b.bus.restart(DriveId{1}, {{"VM", Value(std::int64_t{6})}}, begin + ms(1));
    EXPECT_EQ(twin->powered_on, 2);
    EXPECT_EQ(twin->memory.at("VM"), Value(std::int64_t{6}));
    b.bus.restart(DriveId{9}, {}, begin);
    b.add(1);  // the same key: replaced
    EXPECT_EQ(b.bus.size(), 1u);
    EXPECT_EQ(dynamic_cast<ScriptTwin*>(b.bus.twin(DriveId{1}))->powered_on, 1);
    EXPECT_EQ(std::as_const(b.bus).twin(DriveId{2}), nullptr);
}

TEST(TwinBus, theHandReachesTheWire) {
    Bus b(can_bus());
    ScriptTwin& twin = b.add(1);
    twin.shout = can(5);
    EXPECT_EQ(b.bus.set_hand(DriveId{1}, "shout", true, begin), "");
    EXPECT_EQ(b.bus.set_hand(DriveId{1}, "dance", true, begin), "no such item: use shout");
    EXPECT_THAT(b.bus.set_hand(DriveId{2}, "shout", true, begin), HasSubstr("no twin"));
    b.run_to(begin + ms(1));
    EXPECT_EQ(b.owner.frames.size(), 1u);
}

}  // namespace
}  // namespace axisgate
