// Which requests wait in vain on a full bus, and for how long the others are held back.
#include "gateway/drive/overtaken.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive::test {
namespace {
using namespace std::chrono_literals;

struct Overtaking : testing::Test {
    Overtaken o;
    Instant now = at_ns(1'000'000);
    void SetUp() override { o.set(4, 2ms); }
    /// One exchange that is answered at once.
    void one(std::uint8_t slot) {
        o.began(slot);
        o.ended(slot);
    }
};

TEST_F(Overtaking, NobodyStandsBackBeforeTheLimit) {
    o.began(9);
    for (int i = 0; i < 3; ++i) {
        one(1);
        EXPECT_TRUE(o.may_begin(now));
    }
    one(1);
    EXPECT_FALSE(o.may_begin(now)) << "overtaken by four";
}

TEST_F(Overtaking, ItsAnswerEndsTheWait) {
    o.began(9);
    for (int i = 0; i < 4; ++i)
        one(1);
    o.began(2);
    EXPECT_FALSE(o.may_begin(now));
    EXPECT_EQ(o.deadline(), never) << "exchange 2 is on its way: the bus is not left to 9 alone";
    o.ended(9);
    EXPECT_TRUE(o.may_begin(now));
}

TEST_F(Overtaking, WhoHadTheBusAloneIsSilent) {
    o.began(9);
    for (int i = 0; i < 4; ++i)
        one(1);
    EXPECT_FALSE(o.may_begin(now));
    EXPECT_EQ(o.deadline(), now + 2ms);
    EXPECT_FALSE(o.may_begin(now + 1ms));
    EXPECT_TRUE(o.may_begin(now + 2ms));
    EXPECT_EQ(o.deadline(), never);
    for (int i = 0; i < 100; ++i) {
        one(1);
        EXPECT_TRUE(o.may_begin(now + 2ms)) << "the others do not wait for its time-out";
    }
    o.ended(9);
    o.began(9);  // a repeated request has a chance again
    for (int i = 0; i < 4; ++i)
        one(1);
    EXPECT_FALSE(o.may_begin(now + 3ms));
}

TEST_F(Overtaking, ACommandMeanwhileGivesItItsTimeAnew) {
    o.began(9);
    for (int i = 0; i < 4; ++i)
        one(1);
    EXPECT_FALSE(o.may_begin(now));
    one(1);
    EXPECT_EQ(o.deadline(), never);
    EXPECT_FALSE(o.may_begin(now + 1ms));
    EXPECT_EQ(o.deadline(), now + 3ms);
    o.clear();
    EXPECT_TRUE(o.may_begin(now));
}

TEST_F(Overtaking, AGraceWhoseReasonIsGoneLeavesNoDeadline) {
    o.began(9);
    for (int i = 0; i < 4; ++i)
        one(1);
    EXPECT_FALSE(o.may_begin(now));
    ASSERT_EQ(o.deadline(), now + 2ms);
    o.ended(9);
    EXPECT_TRUE(o.may_begin(now + 1ms));
    EXPECT_EQ(o.deadline(), never) << "nobody waits for it any more";
}

}  // namespace
}  // namespace axisgate::drive::test
