// Tickets, CommandQueue, StopLane: one result each, bounds, and which commands a stop ends.
#include "gateway/drive/tickets.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gateway/drive/command_queue.hpp"

namespace axisgate::drive::test {
namespace {
using namespace std::chrono_literals;
using testing::HasSubstr;

Command command(Ticket ticket, CommandBody body, AxisId axis = AxisId{1}) { return {ticket, axis, std::move(body), false, {}}; }
std::vector<Ticket> tickets_of(const Out& out) {
    std::vector<Ticket> t;
    for (const auto& r : out.results)
        t.push_back(r.ticket);
    return t;
}

TEST(DriveTickets, ASecondAnswerIsNone) {
    Tickets t;
    Out out;
    ASSERT_TRUE(t.open(command(7, Enable{}, AxisId{4}), out));
    EXPECT_TRUE(t.answer(7, Outcome::failed, Reason::drive_refused, "no", out, 12, Value{std::int64_t{5}}, {1, 2}));
    EXPECT_FALSE(t.accepted(7, out));
    t.fail_all(Reason::line_down, "down", out);
    ASSERT_EQ(out.results.size(), 1u);
    const Result& r = out.results[0];
    EXPECT_EQ(r.axis, AxisId{4});
    EXPECT_EQ(r.outcome, Outcome::failed);
    EXPECT_EQ(r.code, 12);
    EXPECT_EQ(r.text, "no");
    EXPECT_EQ(r.value, Value{std::int64_t{5}});
    EXPECT_EQ(r.bytes, (std::vector<std::uint8_t>{1, 2}));
}

TEST(DriveTickets, NobodysTicketLeavesNoTrace) {
    Tickets t;
    Out out;
    EXPECT_TRUE(t.open(command(no_ticket, Enable{}), out));
    EXPECT_EQ(t.size(), 0u);
    EXPECT_FALSE(t.accepted(no_ticket, out));
    Tickets::refuse(command(no_ticket, Enable{}), Reason::busy, "x", out);
    EXPECT_TRUE(out.results.empty());
}

TEST(DriveTickets, WhatIsOpenEndsInItsOrder) {
    Tickets t;
    Out out;
    for (Ticket n = 1; n <= 5; ++n)
        ASSERT_TRUE(t.open(command(n, Enable{}, AxisId{static_cast<std::uint16_t>(n % 2)}), out));
    t.accepted(2, out);
    t.fail_axis(AxisId{1}, Reason::line_down, "gone", out);
    EXPECT_EQ(tickets_of(out), (std::vector<Ticket>{2, 1, 3, 5}));
    t.fail_all(Reason::no_answer, "silent", out);
    EXPECT_EQ(tickets_of(out).back(), 4u);
    EXPECT_EQ(out.results.back().reason, Reason::no_answer);
    EXPECT_EQ(t.size(), 0u);
}

TEST(DriveTickets, StopsHavePlacesOfTheirOwn) {
    Tickets t(40);
    Out out;
    for (Ticket n = 1; n <= 8; ++n)
        ASSERT_TRUE(t.open(command(n, Enable{}), out));
    EXPECT_FALSE(t.open(command(9, Enable{}), out));
    EXPECT_EQ(out.results.at(0).reason, Reason::busy);
    for (Ticket n = 10; n < 42; ++n)
        ASSERT_TRUE(t.open(command(n, Halt{}), out)) << n;
    EXPECT_FALSE(t.open(command(50, Halt{}), out));
    EXPECT_EQ(t.size(), 40u);
    EXPECT_EQ(out.results.size(), 2u);
}

struct Admitting : testing::Test {
    Timing timing;
    Presence presence{DriveId{1}, timing};
    CommandQueue queue{4};
    Tickets tickets;
    Out out;
    Turn t{time_zero + 1s, out};
    Admission admit_one(Ticket n, CommandBody b) { return admit(command(n, std::move(b)), "feeder (ID 5)", presence, queue, tickets, t); }
};

TEST_F(Admitting, NobodyWaitsForALineThatIsDown) {
    EXPECT_EQ(admit_one(1, Enable{}), Admission::answered);
    EXPECT_EQ(admit_one(2, Halt{}), Admission::answered);
    ASSERT_EQ(out.results.size(), 2u);
    EXPECT_EQ(out.results[1].reason, Reason::line_down);
}

TEST_F(Admitting, AStopIsSaidToASilentDriveAllTheSame) {
    presence.begin(t.now);
    presence.lose(t.now);
    EXPECT_EQ(admit_one(1, Enable{}), Admission::answered);
    EXPECT_EQ(out.results.at(0).reason, Reason::no_answer);
    EXPECT_THAT(out.results.at(0).text, HasSubstr("feeder (ID 5) does not answer; it is asked again every 200 ms"));
    EXPECT_EQ(admit_one(2, QuickStop{}), Admission::urgent);
    EXPECT_TRUE(tickets.is_open(2));
}

TEST_F(Admitting, OneMoreThanTheQueueHoldsIsBusy) {
    presence.begin(t.now);
    for (Ticket n = 1; n <= 4; ++n)
        EXPECT_EQ(admit_one(n, Enable{}), Admission::queued);
    EXPECT_EQ(admit_one(5, Enable{}), Admission::answered);
    EXPECT_EQ(out.results.at(0).reason, Reason::busy);
    EXPECT_EQ(queue.size(), 4u);
    EXPECT_EQ(queue.pop().ticket, 1u) << "in order";
}

TEST_F(Admitting, AStopEndsTheMotionsThatWait) {
    presence.begin(t.now);
    (void)admit_one(1, Move{});
    (void)admit_one(2, ReadParameter{});
    (void)admit_one(3, Home{});
    (void)admit_one(4, Enable{});
    EXPECT_EQ(queue.interrupt([](const Command& c) { return is_motion(c.body); }, "halt", tickets, t), 2u);
    EXPECT_EQ(tickets_of(out), (std::vector<Ticket>{1, 3}));
    EXPECT_EQ(out.results[0].reason, Reason::interrupted);
    EXPECT_EQ(out.results[0].text, "interrupted by halt");
    EXPECT_EQ(queue.pop().ticket, 2u);
    EXPECT_EQ(queue.pop().ticket, 4u);
}

TEST(DriveStopLane, KeepsPlacesAndOrder) {
    StopLane<int, 3> lane;
    EXPECT_TRUE(lane.empty() && !lane.first());
    int* a = lane.add(1);
    int* b = lane.add(2);
    int* c = lane.add(3);
    ASSERT_TRUE(a && b && c);
    EXPECT_EQ(lane.add(4), nullptr) << "full";
    lane.remove(a);
    EXPECT_EQ(lane.first(), b);
    EXPECT_EQ(lane.add(5), a) << "its place is free again, and behind the others in order";
    std::vector<int> seen;
    lane.each([&](int& s) {
        seen.push_back(s);
        if (s == 2) lane.remove(&s);
        if (s == 2) lane.remove(c);
    });
    EXPECT_EQ(seen, (std::vector<int>{2, 5})) << "what was taken out meanwhile is not called";
    EXPECT_EQ(lane.size(), 1u);
    lane.clear();
    EXPECT_TRUE(lane.empty());
}

}  // namespace
}  // namespace axisgate::drive::test
