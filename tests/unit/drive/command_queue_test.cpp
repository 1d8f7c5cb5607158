// The waiting commands of an axis are bounded, leave in their order, and are ended by the stops that concern them.
#include "gateway/drive/command_queue.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive {
namespace {
Command command(Ticket ticket, CommandBody body) {
    Command c;
    c.ticket = ticket;
    c.axis = AxisId{0};
    c.body = std::move(body);
    return c;
}

TEST(CommandQueue, IsBoundedAndKeepsItsOrder) {
    CommandQueue queue(3);
    for (const Ticket t : {1u, 2u, 3u})
        EXPECT_TRUE(queue.push(command(t, Enable{}))) << t;
    EXPECT_FALSE(queue.push(command(4, Enable{}))) << "it is full";
    EXPECT_EQ(queue.size(), queue.limit());
    EXPECT_EQ(queue.pop().ticket, 1u);
    EXPECT_TRUE(queue.push(command(5, Enable{}))) << "and has a place again";
    for (const Ticket t : {2u, 3u, 5u})
        EXPECT_EQ(queue.pop().ticket, t);
    EXPECT_TRUE(queue.empty());
}

TEST(CommandQueue, EachStopEndsTheMotionsAndAPowerOffTheEnableToo) {
    Move move;
    for (const CommandBody& motion : {CommandBody{move}, CommandBody{Home{}}, CommandBody{StartTogether{}}})
        for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}})
            EXPECT_TRUE(ended_by(stop, motion)) << name_of(stop) << " and " << name_of(motion);
    EXPECT_TRUE(ended_by(Disable{}, Enable{})) << "an enable behind it would bring the power back";
    EXPECT_FALSE(ended_by(Halt{}, Enable{}));
    EXPECT_FALSE(ended_by(QuickStop{}, Enable{}));
    for (const CommandBody& stop : {CommandBody{Halt{}}, CommandBody{QuickStop{}}, CommandBody{Disable{}}}) {
        EXPECT_FALSE(ended_by(stop, ResetFault{}));
        EXPECT_FALSE(ended_by(stop, ReadParameter{}));
    }
}
}  // namespace
}  // namespace axisgate::drive
