// PollTimer, Polls, Reading: periods, order, and that no drive starves.
#include "gateway/drive/polls.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

namespace axisgate::drive::test {
namespace {
using namespace std::chrono_literals;

TEST(DrivePolls, ATimerKeepsItsRhythmAndNeverAsksTwiceForWhatWasMissed) {
    PollTimer p;
    const Instant now = time_zero + 1s;
    EXPECT_FALSE(p.due(now));
    p.begin(now, 16ms, 3);
    EXPECT_EQ(p.deadline(), now + 3ms) << "a share of the period by place";
    p.asked(now + 4ms, 16ms);
    EXPECT_EQ(p.deadline(), now + 19ms) << "asked a little late: the rhythm stays";
    EXPECT_FALSE(p.late(now + 34ms, 16ms));
    EXPECT_TRUE(p.late(now + 35ms, 16ms));
    p.asked(now + 100ms, 16ms);
    EXPECT_EQ(p.deadline(), now + 116ms) << "far behind: from now on";
    p.soon(now + 105ms);
    p.asked(now + 105ms, 10ms);
    EXPECT_EQ(p.deadline(), now + 115ms);
    p.soon(now + 500ms);
    p.asked(now + 105ms, 10ms);
    EXPECT_EQ(p.deadline(), now + 115ms) << "never more than a period from now";
    p.stop();
    EXPECT_FALSE(p.late(now + 1h, 16ms));
}

TEST(DrivePolls, SoonGoesFirstAndOnceIsOnce) {
    Polls p;
    const Instant now = time_zero + 1s;
    EXPECT_FALSE(p.next(now));
    p.every(1, 10ms, now);
    p.every(2, 10ms, now);
    p.soon(9, now);
    EXPECT_EQ(p.next(now), 9u);
    EXPECT_EQ(p.next(now), 1u);
    EXPECT_EQ(p.next(now), 2u);
    EXPECT_FALSE(p.next(now + 9ms));
    EXPECT_EQ(p.size(), 2u) << "what was asked once is gone";
    EXPECT_EQ(p.deadline(), now + 10ms);
    p.soon(2, now + 1ms);
    EXPECT_EQ(p.next(now + 1ms), 2u);
    EXPECT_EQ(p.deadline(), now + 10ms);
    p.every(1, 20ms, now + 50ms);
    EXPECT_EQ(p.next(now + 10ms), 1u) << "a new period does not put off what is due";
    EXPECT_EQ(p.next(now + 30ms), 2u);
    p.drop(2);
    EXPECT_EQ(p.next(now + 30ms), 1u);
    p.clear();
    EXPECT_EQ(p.deadline(), never);
}

TEST(DrivePolls, OneMoreThanTheBoundIsNotTaken) {
    Polls p;
    for (Polls::Item i = 0; i < Polls::limit; ++i)
        ASSERT_TRUE(p.every(i, 1s, time_zero));
    EXPECT_FALSE(p.every(999, 1s, time_zero));
    EXPECT_FALSE(p.soon(999, time_zero));
    EXPECT_TRUE(p.every(5, 2s, time_zero)) << "a known one is no further one";
}

/// A line that carries a third of the requested polls: those of moving axes go first, and each of the others is polled all the same.
TEST(DrivePolls, QuickOnesGoFirstAndNobodyStarves) {
    Polls p;
    Instant now = time_zero + 1s;
    for (Polls::Item i = 0; i < 30; ++i) {
        p.every(i, 10ms, now);
        p.quick(i, i < 2);
    }
    std::map<Polls::Item, int> asked;
    for (int n = 0; n < 3000; ++n, now += 1ms) {
        const auto i = p.next(now);
        ASSERT_TRUE(i);
        ++asked[*i];
        ASSERT_LE(p.deadline(), now + 10ms);
    }
    for (Polls::Item i = 0; i < 30; ++i)
        EXPECT_GE(asked[i], i < 2 ? 290 : 60) << i << ": of 300 wanted";
    int least = 3000, most = 0;
    for (Polls::Item i = 2; i < 30; ++i) {
        least = std::min(least, asked[i]);
        most = std::max(most, asked[i]);
    }
    EXPECT_LE(most - least, 2) << "in turn";
}

TEST(DrivePolls, EvenWhereQuickOnesAloneFillTheLine) {
    Polls p;
    Instant now = time_zero + 1s;
    for (Polls::Item i = 0; i < 10; ++i) {
        p.every(i, 2ms, now);
        p.quick(i, i != 7);
    }
    int slow = 0;
    for (int n = 0; n < 400; ++n, now += 1ms)
        slow += p.next(now) == 7u ? 1 : 0;
    EXPECT_EQ(slow, 80) << "two places until it is due again, and three more at most";
}

TEST(DrivePolls, ReadingGoesCoreFirstAndGivesUpWhatIsNotAnswered) {
    Reading r;
    EXPECT_FALSE(r.pending());
    r.begin(2, 4);
    EXPECT_TRUE(r.core_pending());
    EXPECT_FALSE(r.done());
    r.silent();
    EXPECT_FALSE(r.given_up());
    r.silent();
    EXPECT_TRUE(r.given_up());
    EXPECT_TRUE(r.done()) << "the last of the core";
    EXPECT_FALSE(r.given_up()) << "counted anew for each";
    EXPECT_TRUE(r.pending() && !r.core_pending());
    EXPECT_FALSE(r.done());
    EXPECT_FALSE(r.done());
    EXPECT_FALSE(r.pending());
    EXPECT_FALSE(r.done());
    EXPECT_EQ(r.at(), 4u);
}

}  // namespace
}  // namespace axisgate::drive::test
