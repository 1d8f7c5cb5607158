// The phases of one drive and the pauses between its probes.
#include "gateway/drive/presence.hpp"

#include <gtest/gtest.h>

namespace axisgate::drive::test {
namespace {
using namespace std::chrono_literals;
using Phase = Presence::Phase;
using Silence = Presence::Silence;

struct PresenceOfOne : testing::Test {
    Timing timing;
    Presence p{DriveId{3}, timing};
    Instant now = time_zero + 10s;
    Out out;
    void SetUp() override { timing.silent_limit = 3; }
    void lose() {
        p.begin(now);
        for (int i = 0; i < 3; ++i)
            (void)p.silent(now);
    }
};

TEST_F(PresenceOfOne, ProbesFollowOneAnotherUntilTheLimit) {
    EXPECT_TRUE(p.is(Phase::down));
    p.begin(now);
    EXPECT_TRUE(p.probe_due(now));
    p.probe_sent();
    EXPECT_EQ(p.deadline(), never) << "one probe at a time";
    EXPECT_EQ(p.silent(now), Silence::counted);
    EXPECT_TRUE(p.probe_due(now)) << "the next at once";
    EXPECT_EQ(p.silent(now), Silence::counted);
    EXPECT_EQ(p.silent(now), Silence::lost);
    EXPECT_TRUE(p.is(Phase::absent));
    EXPECT_EQ(p.deadline(), now + 200ms);
}

TEST_F(PresenceOfOne, PausesDoubleUpToTheirBound) {
    lose();
    Duration before = p.retry_pause();
    EXPECT_EQ(before, timing.pause_min);
    for (int i = 0; i < 100; ++i) {
        now = p.deadline();
        p.probe_sent();
        EXPECT_EQ(p.silent(now), Silence::still_absent);
        EXPECT_EQ(p.retry_pause(), std::min(2 * before, timing.pause_max));
        EXPECT_EQ(p.deadline(), now + p.retry_pause());
        before = p.retry_pause();
    }
    EXPECT_EQ(before, timing.pause_max);
}

TEST_F(PresenceOfOne, OneAnswerUndoesTheBackOff) {
    lose();
    for (int i = 0; i < 5; ++i)
        (void)p.silent(now);
    p.found();
    EXPECT_TRUE(p.is(Phase::starting) && p.online() && p.ever_found());
    p.made_ready();
    (void)p.silent(now);
    (void)p.silent(now);
    p.answered();
    EXPECT_EQ(p.silent(now), Silence::counted) << "silences count in a row alone";
    EXPECT_TRUE(p.is(Phase::ready));
    (void)p.silent(now);
    EXPECT_EQ(p.silent(now), Silence::lost);
    EXPECT_EQ(p.retry_pause(), timing.pause_min) << "the pauses begin anew";
}

TEST_F(PresenceOfOne, WhoIsHeardIsAskedAtOnceButNotTwice) {
    lose();
    p.received(now + 1ms);
    EXPECT_TRUE(p.probe_due(now + 1ms));
    p.probe_sent();
    p.received(now + 2ms);
    EXPECT_EQ(p.deadline(), never) << "a probe is on its way already";
    p.found();
    p.made_ready();
    p.received(now + 3ms);
    EXPECT_EQ(p.deadline(), never) << "a drive that is there is not looked for";
}

TEST_F(PresenceOfOne, ARestartLeavesItAloneAndThenCountsAnew) {
    p.begin(now);
    p.found();
    p.made_ready();
    (void)p.silent(now);
    p.restart(now, 300ms);
    EXPECT_TRUE(p.online());
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(p.silent(now), Silence::counted) << "it was told to be silent";
    EXPECT_FALSE(p.probe_due(now + 299ms));
    EXPECT_TRUE(p.probe_due(now + 300ms));
    p.probe_sent();
    EXPECT_TRUE(p.is(Phase::probing));
    EXPECT_EQ(p.silences(), 0u);
}

TEST_F(PresenceOfOne, ALinkIsToldWhenItIsAnother) {
    p.begin(now);
    p.report("no answer yet", out);
    p.report("no answer yet", out);
    ASSERT_EQ(out.links.size(), 1u);
    EXPECT_FALSE(out.links[0].online);
    lose();
    p.report("silent", out);
    (void)p.silent(now);
    p.report("silent", out);
    ASSERT_EQ(out.links.size(), 3u) << "its pause has changed";
    EXPECT_EQ(out.links[2].retry_pause, 400ms);
    EXPECT_EQ(out.links[2].silent_exchanges, 4u);
    p.found();
    p.report("model 7", out);
    p.made_ready();
    p.report("model 7", out);
    ASSERT_EQ(out.links.size(), 4u);
    EXPECT_TRUE(out.links[3].online);
    EXPECT_EQ(out.links[3].drive, DriveId{3});
    EXPECT_EQ(out.links[3].retry_pause, Duration::zero());
    p.close();
    p.report("the line is down", out);
    EXPECT_FALSE(out.links[4].online);
    EXPECT_EQ(p.deadline(), never);
}

TEST_F(PresenceOfOne, LostForAnotherReason) {
    p.begin(now);
    p.lose(now, timing.pause_max);
    EXPECT_EQ(p.deadline(), now + timing.pause_max);
    EXPECT_EQ(p.silent(now), Silence::still_absent);
    EXPECT_EQ(p.retry_pause(), timing.pause_max);
}

}  // namespace
}  // namespace axisgate::drive::test
