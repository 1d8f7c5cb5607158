// SendQueue and LoadMeter: order, bounds, ages.
// In: frames and instants. Out: pass or fail. Never allocates what it says it does not.
#include "gateway/wire/send_queue.hpp"

#include <gtest/gtest.h>

#include "gateway/wire/load_meter.hpp"
#include "tests/unit/wire/twin_bus_fixture.hpp"

namespace axisgate {
namespace {

using test::can;
using test::ms;

std::vector<std::uint32_t> drain(SendQueue& q) {
    std::vector<std::uint32_t> ids;
    while (const auto* e = q.front()) {
        ids.push_back(e->frame.id);
        q.pop();
    }
    return ids;
}

TEST(SendQueue, letsUrgentFirstAndKeepsTheOrderWithin) {
    SendQueue q;
    EXPECT_TRUE(q.push(can(1), Priority::poll, at_ns(0)));
    EXPECT_TRUE(q.push(can(2), Priority::command, at_ns(1)));
    EXPECT_TRUE(q.push(can(3), Priority::urgent, at_ns(2)));
    EXPECT_TRUE(q.push(can(4), Priority::poll, at_ns(3)));
    EXPECT_TRUE(q.push(can(5), Priority::urgent, at_ns(4)));
    EXPECT_TRUE(q.push(can(6), Priority::command, at_ns(5)));
    std::array<const SendQueue::Entry*, 4> first{};
    ASSERT_EQ(q.collect(first), 4u);
    EXPECT_EQ(first[0]->frame.id, 3u);
    EXPECT_EQ(first[3]->frame.id, 6u);
    EXPECT_EQ(q.size(), 6u);
    EXPECT_EQ(drain(q), (std::vector<std::uint32_t>{3, 5, 2, 6, 1, 4}));
    EXPECT_TRUE(q.empty());
}

TEST(SendQueue, isFullAtItsBound) {
    SendQueue q(4);
    for (std::uint32_t i = 0; i < 4; ++i)
        EXPECT_TRUE(q.push(can(i), Priority::command, at_ns(i)));
    EXPECT_FALSE(q.push(can(9), Priority::command, at_ns(9)));
    EXPECT_FALSE(q.push(can(9), Priority::poll, at_ns(9)));
    EXPECT_EQ(q.size(), 4u);
    q.pop();
    EXPECT_TRUE(q.push(can(9), Priority::poll, at_ns(9)));
    EXPECT_EQ(drain(q), (std::vector<std::uint32_t>{1, 2, 3, 9}));
}

TEST(SendQueue, neverRefusesAStopBecausePollsWait) {
    SendQueue q(4);
    (void)q.push(can(1), Priority::poll, at_ns(0));
    (void)q.push(can(2), Priority::poll, at_ns(0));
    (void)q.push(can(3), Priority::command, at_ns(0));
    (void)q.push(can(4), Priority::command, at_ns(0));
    EXPECT_TRUE(q.push(can(10), Priority::urgent, at_ns(1)));  // pushes out 2, the youngest poll
    EXPECT_TRUE(q.push(can(11), Priority::urgent, at_ns(1)));  // then 1
    EXPECT_TRUE(q.push(can(12), Priority::urgent, at_ns(1)));  // then 4, the youngest command
    EXPECT_TRUE(q.push(can(13), Priority::urgent, at_ns(1)));
    EXPECT_FALSE(q.push(can(14), Priority::urgent, at_ns(1)));  // nothing but stops: full is full
    EXPECT_EQ(q.displaced(), 4u);
    EXPECT_EQ(drain(q), (std::vector<std::uint32_t>{10, 11, 12, 13}));
}

TEST(SendQueue, seesOnlyWhatHasComeByAnInstant) {
    SendQueue q;
    EXPECT_EQ(q.earliest(), never);
    (void)q.push(can(1), Priority::poll, at_ns(10));
    (void)q.push(can(2), Priority::urgent, at_ns(20));
    EXPECT_EQ(q.earliest(), at_ns(10));
    EXPECT_EQ(q.front(at_ns(9)), nullptr);
    EXPECT_EQ(q.front(at_ns(10))->frame.id, 1u);
    EXPECT_EQ(q.front(at_ns(20))->frame.id, 2u);
    q.pop(at_ns(15));
    EXPECT_EQ(drain(q), (std::vector<std::uint32_t>{2}));
}

TEST(SendQueue, givesTheFrameThatItRemoves) {
    SendQueue q;
    (void)q.push(can(1), Priority::poll, at_ns(10));
    (void)q.push(can(2), Priority::urgent, at_ns(20));
    (void)q.push(can(3), Priority::command, at_ns(10));
    Frame f;
    q.take(f, at_ns(15));
    EXPECT_EQ(f.id, 3u) << "of those that have come by then";
    q.take(f, at_ns(20));
    EXPECT_EQ(f.id, 2u);
    EXPECT_EQ(q.earliest(), at_ns(10));
    q.take(f, at_ns(20));
    EXPECT_EQ(f.id, 1u);
    EXPECT_TRUE(q.empty());
    EXPECT_EQ(q.earliest(), never);
}

TEST(SendQueue, throwsAwayWhatIsTooOld) {
    SendQueue q;
    (void)q.push(can(1), Priority::poll, at_ns(10));
    (void)q.push(can(2), Priority::urgent, at_ns(20));
    (void)q.push(can(3), Priority::poll, at_ns(30));
    EXPECT_EQ(q.drop_older_than(at_ns(20)), 1u);
    EXPECT_EQ(q.drop_older_than(at_ns(25)), 1u);
    EXPECT_EQ(drain(q), (std::vector<std::uint32_t>{3}));
}

TEST(SendQueue, usesItsRoomAgain) {
    SendQueue q(8);
    std::uint32_t next = 0, expected = 0;
    for (int round = 0; round < 1000; ++round) {
        for (int i = 0; i < 1 + round % 7; ++i)
            ASSERT_TRUE(q.push(can(next++), Priority::command, at_ns(round)));
        for (const auto id : drain(q))
            ASSERT_EQ(id, expected++);
    }
    (void)q.push(can(1), Priority::urgent, at_ns(0));
    q.clear();
    EXPECT_TRUE(q.empty());
    EXPECT_EQ(q.front(), nullptr);
}

Frame of(std::uint8_t sender, std::uint32_t id) {
    Frame f = can(id);
    f.sender = sender;
    return f;
}

TEST(SendQueue, letsSendersLeaveInTurn) {
    SendQueue q;
    for (std::uint32_t i = 0; i < 4; ++i)
        (void)q.push(of(0, i), Priority::command, at_ns(i));
    (void)q.push(of(1, 10), Priority::command, at_ns(5));
    (void)q.push(of(1, 11), Priority::command, at_ns(5));
    (void)q.push(of(1, 12), Priority::urgent, at_ns(6));
    std::array<const SendQueue::Entry*, 7> all{};
    ASSERT_EQ(q.collect(all), 7u);
    const std::vector<std::uint32_t> order{12, 0, 10, 1, 11, 2, 3};
    for (std::size_t i = 0; i < order.size(); ++i)
        EXPECT_EQ(all[i]->frame.id, order[i]) << i;
    EXPECT_EQ(drain(q), order);
    (void)q.push(of(0, 1), Priority::poll, at_ns(7));
    (void)q.push(of(1, 2), Priority::poll, at_ns(9));
    EXPECT_EQ(q.front(at_ns(8))->frame.id, 1u) << "whose turn it is has nothing yet";
}

TEST(SendQueue, givesASenderItsShareOfAFullQueue) {
    SendQueue q(8);
    for (std::uint32_t i = 0; i < 8; ++i)
        ASSERT_TRUE(q.push(of(0, i), i < 4 ? Priority::poll : Priority::command, at_ns(i)));
    EXPECT_FALSE(q.push(of(0, 8), Priority::command, at_ns(8))) << "its own frames cost nobody a place";
    for (std::uint32_t i = 0; i < 4; ++i)
        EXPECT_TRUE(q.push(of(1, 20 + i), Priority::poll, at_ns(9))) << i;
    EXPECT_FALSE(q.push(of(1, 24), Priority::poll, at_ns(9))) << "half of it is its share";
    EXPECT_EQ(q.displaced(), 4u);
    EXPECT_EQ(q.size(), 8u);
    EXPECT_TRUE(q.push(of(1, 30), Priority::urgent, at_ns(10))) << "a stop costs the same sender a poll";
    EXPECT_EQ(drain(q), (std::vector<std::uint32_t>{30, 4, 5, 6, 7, 20, 21, 22})) << "the youngest of the least urgent ones went";
}

TEST(LoadMeter, tellsTheShareOfTheLastSecond) {
    LoadMeter m;
    EXPECT_EQ(m.share(time_zero + ms(5000)), 0.0);
    for (int t = 0; t < 3000; t += 10)
        m.add(time_zero + ms(t), ms(5));  // half of the time
    EXPECT_NEAR(m.share(time_zero + ms(3000)), 0.5, 0.02);
    EXPECT_NEAR(m.share(time_zero + ms(3500)), 0.25, 0.02);
    EXPECT_NEAR(m.share(time_zero + ms(3950)), 0.025, 0.02);
    EXPECT_EQ(m.share(time_zero + ms(4101)), 0.0);
}

TEST(LoadMeter, staysWithinOne) {
    LoadMeter m;
    m.add(time_zero + ms(100), ms(100'000));
    EXPECT_EQ(m.share(time_zero + ms(150)), 1.0);
    m.add(time_zero + ms(5000), ms(10));
    m.add(time_zero + ms(100), ms(100'000));  // long ago: counts no more, and does not disturb the present
    EXPECT_NEAR(m.share(time_zero + ms(5000)), 0.01, 0.001);
}

}  // namespace
}  // namespace axisgate
