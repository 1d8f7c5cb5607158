// Identifiers, data types, NMT, heartbeat, node guarding, SYNC and EMCY: frames as in the standard, in virtual time.
#include <gtest/gtest.h>

#include "gateway/protocols/canopen/data_type.hpp"
#include "gateway/protocols/canopen/emergency.hpp"
#include "gateway/protocols/canopen/nmt.hpp"
#include "gateway/protocols/canopen/sync.hpp"
#include "tests/unit/canopen/bench.hpp"

namespace axisgate::canopen::test {
namespace {

TEST(Identifiers, OfThePredefinedSet) {
    const std::pair<std::uint32_t, Role> cases[] = {{0x000, {Service::nmt, 0, 0}},
                                                    {0x080, {Service::sync, 0, 0}},
                                                    {0x081, {Service::emergency, 1, 0}},
                                                    {0x0FF, {Service::emergency, 127, 0}},
                                                    {0x100, {Service::time, 0, 0}},
                                                    {0x185, {Service::transmit_pdo, 5, 1}},
                                                    {0x205, {Service::receive_pdo, 5, 1}},
                                                    {0x285, {Service::transmit_pdo, 5, 2}},
                                                    {0x305, {Service::receive_pdo, 5, 2}},
                                                    {0x385, {Service::transmit_pdo, 5, 3}},
                                                    {0x405, {Service::receive_pdo, 5, 3}},
                                                    {0x485, {Service::transmit_pdo, 5, 4}},
                                                    {0x505, {Service::receive_pdo, 5, 4}},
                                                    {0x585, {Service::sdo_answer, 5, 0}},
                                                    {0x605, {Service::sdo_request, 5, 0}},
                                                    {0x705, {Service::error_control, 5, 0}},
                                                    {0x180, {}},
                                                    {0x101, {}},
                                                    {0x685, {}},
                                                    {0x7E5, {}},
                                                    {0x12345, {}}};
    for (const auto& [id, role] : cases)
        EXPECT_EQ(role_of(id), role) << std::hex << id;
}
TEST(Identifiers, TwentyNineBitsAreOfSomeoneElse) {
    const Frame f = Frame::can_extended(0x605, std::array<std::uint8_t, 8>{});
    EXPECT_FALSE(is_data(f, 0x605));
    EXPECT_FALSE(is_remote(f, 0x605));
}

TEST(DataTypes, ValuesKeepTheirSignAndWidth) {
    const std::tuple<DataType, std::vector<std::uint8_t>, Value> cases[] = {
        {DataType::boolean, {1}, Value{true}},
        {DataType::integer8, {0x80}, Value{std::int64_t{-128}}},
        {DataType::unsigned8, {0x80}, Value{std::int64_t{128}}},
        {DataType::integer24, {0xFF, 0xFF, 0xFF}, Value{std::int64_t{-1}}},
        {DataType::unsigned40, {1, 2, 3, 4, 5}, Value{std::int64_t{0x0504030201}}},
        {DataType::integer64, {0, 0, 0, 0, 0, 0, 0, 0x80}, Value{INT64_MIN}},
        {DataType::real32, {0x00, 0x00, 0x80, 0xBF}, Value{-1.0}},
        {DataType::real64, {0, 0, 0, 0, 0, 0, 0xF0, 0x3F}, Value{1.0}},
        {DataType::visible_string, {'a', 'b'}, Value{std::string("ab")}},
        {DataType::domain, {0x0A, 0xFF}, Value{std::string("0AFF")}},
        {DataType::time_of_day, {1, 2, 3, 4, 5, 6}, Value{std::string("010203040506")}},
    };
    for (const auto& [type, bytes, value] : cases) {
        EXPECT_EQ(decode(type, bytes), value) << name_of(type);
        EXPECT_EQ(encode(type, value), bytes) << name_of(type);
    }
}
TEST(DataTypes, WhatDoesNotFitIsRefused) {
    EXPECT_FALSE(decode(DataType::unsigned16, std::vector<std::uint8_t>{1}));
    EXPECT_FALSE(decode(DataType::unsigned64, std::vector<std::uint8_t>(8, 0xFF)));
    EXPECT_FALSE(encode(DataType::unsigned8, Value{std::int64_t{256}}));
    EXPECT_FALSE(encode(DataType::unsigned8, Value{std::int64_t{-1}}));
    EXPECT_FALSE(encode(DataType::integer24, Value{std::int64_t{0x800000}}));
    EXPECT_FALSE(encode(DataType::real32, Value{1e39}));
    EXPECT_FALSE(encode(DataType::time_of_day, Value{std::string("00")}));
    EXPECT_FALSE(encode(DataType::domain, Value{std::string("0")}));
    EXPECT_FALSE(encode(DataType::integer8, Value{std::string("1")}));
    EXPECT_FALSE(data_type_of(0x20)) << "a record";
    EXPECT_EQ(bits_of(DataType::boolean), 1u);
    EXPECT_FALSE(bits_of(DataType::domain));
}
TEST(DataTypes, EveryNumberHasItsNameAndItsEnds) {
    std::size_t types = 0, whole = 0;
    for (std::uint64_t n = 0; n < 0x40; ++n) {
        const auto type = data_type_of(n);
        if (!type) continue;
        ++types;
        EXPECT_NE(name_of(*type), "unknown type") << n;
        const auto range = range_of(*type);
        if (!range) continue;
        ++whole;
        for (const auto v : {range->min, range->max}) {
            const auto bytes = encode(*type, Value{v});
            ASSERT_TRUE(bytes) << name_of(*type);
            EXPECT_EQ(as_integer(decode(*type, *bytes).value()), v) << name_of(*type);
        }
        if (range->max < INT64_MAX) EXPECT_FALSE(encode(*type, Value{range->max + 1})) << name_of(*type);
    }
    EXPECT_GE(types, 12u);
    EXPECT_GE(whole, 8u) << "integers of each width, with and without a sign";
}

TEST(Nmt, CommandsReachOneNodeOrAll) {
    EXPECT_EQ(text(nmt_frame(NmtCommand::start, 5)), "000#0105");
    EXPECT_EQ(text(nmt_frame(NmtCommand::reset_communication, 0)), "000#8200");
    EXPECT_EQ(nmt_for(frame("000#8105"), 5), NmtCommand::reset_node);
    EXPECT_EQ(nmt_for(frame("000#8000"), 5), NmtCommand::pre_operational);
    EXPECT_FALSE(nmt_for(frame("000#0106"), 5));
    EXPECT_FALSE(nmt_for(frame("000#0305"), 5)) << "no command";
    EXPECT_FALSE(nmt_for(frame("000#01"), 5));
    EXPECT_FALSE(nmt_for(frame("080#0105"), 5));
}

struct Heartbeats : testing::Test {
    HeartbeatWatch watch{5, 100ms};
    Instant now = time_zero + 1s;
    NodeNews receive(std::string_view text) { return watch.on_frame(frame(text), now); }
};
TEST_F(Heartbeats, TheWatchBeginsWithTheFirstAndTellsALossOnce) {
    EXPECT_EQ(watch.deadline(), never);
    EXPECT_EQ(receive("705#7F"), NodeNews::state);
    EXPECT_EQ(watch.deadline(), now + 100ms);
    EXPECT_EQ(watch.on_deadline(now + 99ms), NodeNews::nothing);
    now += 50ms;
    EXPECT_EQ(receive("705#7F"), NodeNews::nothing);
    EXPECT_EQ(watch.on_deadline(now + 100ms), NodeNews::lost);
    EXPECT_TRUE(watch.lost());
    EXPECT_EQ(watch.on_deadline(now + 300ms), NodeNews::nothing);
    EXPECT_EQ(receive("705#05"), NodeNews::back);
    EXPECT_EQ(watch.state(), NmtState::operational);
    EXPECT_FALSE(watch.lost());
}
TEST_F(Heartbeats, ABootUpIsToldEveryTime) {
    EXPECT_EQ(receive("705#05"), NodeNews::state);
    EXPECT_EQ(receive("705#00"), NodeNews::started);
    EXPECT_EQ(receive("705#00"), NodeNews::started);
    EXPECT_EQ(receive("705#04"), NodeNews::state);
}
TEST_F(Heartbeats, WhatIsNoStateIsCounted) {
    EXPECT_EQ(receive("705#03"), NodeNews::nothing);
    EXPECT_EQ(receive("705#0505"), NodeNews::nothing);
    EXPECT_EQ(receive("705#"), NodeNews::nothing);
    EXPECT_EQ(receive("706#05"), NodeNews::nothing);
    EXPECT_EQ(watch.malformed(), 3u);
    EXPECT_EQ(watch.deadline(), never);
}
TEST_F(Heartbeats, AProducerComesEvenlyAndNeverTwice) {
    HeartbeatProducer p;
    EXPECT_EQ(p.deadline(), never);
    p.set_period(10ms, now);
    EXPECT_FALSE(p.on_deadline(now + 9ms, 5, NmtState::operational));
    const auto f = p.on_deadline(now + 12ms, 5, NmtState::operational);
    ASSERT_TRUE(f);
    EXPECT_EQ(text(*f), "705#05");
    EXPECT_EQ(p.deadline(), now + 20ms) << "no drift";
    EXPECT_TRUE(p.on_deadline(now + 55ms, 5, NmtState::operational));
    EXPECT_FALSE(p.on_deadline(now + 55ms, 5, NmtState::operational));
    p.set_period(0ms, now);
    EXPECT_EQ(p.deadline(), never);
}

struct Guarding : testing::Test {
    GuardMaster master{5};
    GuardSlave slave;
    Instant now = time_zero + 1s;
    Guarding() {
        master.set(100ms, 3, now);
        slave.set(100ms, 3);
    }
    /// One question; its answer reaches the master if `answered`.
    NodeNews round(bool answered = true) {
        auto step = master.on_deadline(now);
        EXPECT_TRUE(step.ask);
        EXPECT_EQ(text(*step.ask), "705#R");
        NodeNews news = step.news;
        if (answered) {
            const auto a = slave.on_frame(*step.ask, now, 5, NmtState::operational);
            news = master.on_frame(a.value(), now);
        }
        now += 100ms;
        return news;
    }
};
TEST_F(Guarding, AnswersAlternateTheirToggleBit) {
    const Frame ask = frame("705#R");
    EXPECT_EQ(text(slave.on_frame(ask, now, 5, NmtState::operational).value()), "705#05");
    EXPECT_EQ(text(slave.on_frame(ask, now, 5, NmtState::operational).value()), "705#85");
    EXPECT_EQ(text(slave.on_frame(ask, now, 5, NmtState::stopped).value()), "705#04");
    slave.reset();
    EXPECT_EQ(text(slave.on_frame(ask, now, 5, NmtState::pre_operational).value()), "705#7F");
    EXPECT_FALSE(slave.on_frame(frame("706#R"), now, 5, NmtState::operational));
    EXPECT_FALSE(slave.on_frame(frame("705#05"), now, 5, NmtState::operational));
}
TEST_F(Guarding, ANodeIsLostAfterItsLifeTimeAndComesBack) {
    EXPECT_EQ(round(), NodeNews::state);
    for (int i = 0; i < 5; ++i)
        EXPECT_EQ(round(), NodeNews::nothing);
    EXPECT_EQ(round(false), NodeNews::nothing);
    EXPECT_EQ(round(false), NodeNews::nothing);
    EXPECT_EQ(round(false), NodeNews::lost);
    EXPECT_EQ(round(false), NodeNews::nothing) << "told once";
    EXPECT_EQ(round(), NodeNews::back);
    EXPECT_EQ(round(), NodeNews::nothing);
}
TEST_F(Guarding, AWrongToggleIsNoAnswer) {
    EXPECT_EQ(master.on_frame(frame("705#05"), now), NodeNews::state);
    EXPECT_EQ(master.on_frame(frame("705#05"), now), NodeNews::nothing);
    EXPECT_EQ(master.wrong_toggles(), 1u);
    EXPECT_EQ(master.on_deadline(now + 300ms).news, NodeNews::lost);
    EXPECT_EQ(master.on_frame(frame("705#05"), now + 300ms), NodeNews::back) << "it was reset: its toggle says nothing";
    EXPECT_EQ(master.on_frame(frame("705#00"), now + 300ms), NodeNews::started);
    EXPECT_EQ(master.on_frame(frame("705#7F"), now + 400ms), NodeNews::state);
    EXPECT_EQ(master.wrong_toggles(), 1u);
}
TEST_F(Guarding, ANodeThatNobodyAsksAnyMoreNoticesIt) {
    EXPECT_FALSE(slave.on_deadline(now + 10s)) << "the first question begins it";
    (void)slave.on_frame(frame("705#R"), now, 5, NmtState::operational);
    EXPECT_EQ(slave.deadline(), now + 300ms);
    EXPECT_TRUE(slave.on_deadline(now + 300ms));
    EXPECT_FALSE(slave.on_deadline(now + 10s));
}
TEST_F(Guarding, WithoutATimeNobodyIsAsked) {
    master.set(0ms, 3, now);
    EXPECT_EQ(master.deadline(), never);
    EXPECT_EQ(master.on_frame(frame("705#05"), now), NodeNews::nothing);
}

TEST(Sync, ComesByThePlanAndNotByTheLastOne) {
    SyncProducer sync;
    const Instant t0 = time_zero + 1s;
    EXPECT_EQ(sync.deadline(), never);
    sync.set(2ms, 0, t0);
    EXPECT_FALSE(sync.on_deadline(t0 + 1999us));
    EXPECT_EQ(text(sync.on_deadline(t0 + 2100us).value()), "080#");
    EXPECT_EQ(sync.deadline(), t0 + 4ms);
    EXPECT_TRUE(sync.on_deadline(t0 + 9ms));
    EXPECT_EQ(sync.missed(), 2u);
    EXPECT_FALSE(sync.on_deadline(t0 + 9ms)) << "never two to make up for it";
    EXPECT_EQ(sync.deadline(), t0 + 10ms);
}
TEST(Sync, AnotherPeriodCountsFromTheLastOne) {
    SyncProducer sync;
    const Instant t0 = time_zero + 1s;
    sync.set_period(8ms, t0);
    EXPECT_EQ(sync.deadline(), t0) << "one that was off begins at once";
    EXPECT_TRUE(sync.on_deadline(t0 + 100us));
    EXPECT_EQ(sync.deadline(), t0 + 8ms);
    sync.set_period(2ms, t0 + 1ms);
    EXPECT_EQ(sync.deadline(), t0 + 2ms);
    sync.set_period(2ms, t0 + 1500us);
    EXPECT_EQ(sync.deadline(), t0 + 2ms) << "the same one changes nothing";
    sync.set_period(1ms, t0 + 1500us);
    EXPECT_EQ(sync.deadline(), t0 + 1500us) << "it is over: now";
    sync.set_period(0ms, t0 + 1500us);
    EXPECT_EQ(sync.deadline(), never);
}
TEST(Sync, OneThatIsLateByMostOfItsCycleStandsForTheNextToo) {
    SyncProducer sync;
    const Instant t0 = time_zero + 1s;
    sync.set(2ms, 0, t0);
    EXPECT_TRUE(sync.on_deadline(t0 + 2900us));
    EXPECT_EQ(sync.deadline(), t0 + 4ms);
    EXPECT_TRUE(sync.on_deadline(t0 + 5200us));
    EXPECT_EQ(sync.deadline(), t0 + 8ms) << "not 800 us behind it";
    EXPECT_EQ(sync.missed(), 1u);
}
TEST(Sync, CountsFromOneToItsOverflow) {
    SyncProducer sync(0x81);
    Instant t = time_zero;
    sync.set(1ms, 3, t);
    Texts seen;
    for (int i = 0; i < 5; ++i)
        seen.push_back(text(sync.on_deadline(t += 1ms).value()));
    EXPECT_EQ(seen, (Texts{"081#01", "081#02", "081#03", "081#01", "081#02"}));
}

TEST(Emergencies, HaveCodeRegisterAndTheMakersBytes) {
    const auto e = emergency_of(frame("085#3081110102030405"), 5);
    ASSERT_TRUE(e);
    EXPECT_EQ(*e, (Emergency{0x8130, 0x11, {1, 2, 3, 4, 5}}));
    EXPECT_EQ(text(emergency_frame(5, *e)), "085#3081110102030405");
    EXPECT_EQ(to_text(*e), "8130h heartbeat or life guarding error, register 11h (generic, communication)");
    EXPECT_EQ(to_text(Emergency{}), "no error any more");
    EXPECT_FALSE(emergency_of(frame("085#308111"), 5));
    EXPECT_FALSE(emergency_of(frame("086#3081110102030405"), 5));
}
TEST(Emergencies, TheMostSpecialClassNamesACode) {
    EXPECT_EQ(words_of_error(0x3210), "DC link over voltage");
    EXPECT_EQ(words_of_error(0x32FF), "voltage inside the device");
    EXPECT_EQ(words_of_error(0x3F00), "voltage");
    EXPECT_EQ(words_of_error(0x8611), "following error");
    EXPECT_EQ(words_of_error(0x5000), "device hardware");
    EXPECT_EQ(words_of_error(0xFF12), "the maker's own error");
    EXPECT_EQ(words_of_error(0xA000), "");
    EXPECT_EQ(to_text(Emergency{0xA000, 0, {}}), "A000h no class of the standards");
}
TEST(Emergencies, AStormIsCountedAndItsEndIsTold) {
    EmergencyGate gate(3, 1s);
    const Instant t = time_zero + 1s;
    const Emergency error{0x2310, 1, {}};
    int published = 0;
    for (int i = 0; i < 1000; ++i)
        published += gate.admits(error, t) ? 1 : 0;
    EXPECT_EQ(published, 3);
    EXPECT_EQ(gate.kept_back(), 997u);
    EXPECT_TRUE(gate.admits(Emergency{}, t));
    EXPECT_FALSE(gate.admits(Emergency{}, t)) << "once";
    EXPECT_TRUE(gate.admits(error, t + 1s));
    published = 0;
    for (int i = 0; i < 1000; ++i)
        published += gate.admits(i % 2 == 0 ? error : Emergency{}, t + 2s) ? 1 : 0;
    EXPECT_EQ(published, 4) << "one that comes and goes, too";
}

}  // namespace
}  // namespace axisgate::canopen::test
