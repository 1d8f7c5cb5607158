// Exchange, LateMarks, LateTime, Timing, OptionReader and Notices.
#include "gateway/drive/exchange.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "gateway/drive/notices.hpp"
#include "gateway/drive/option_reader.hpp"
#include "gateway/drive/timing.hpp"

namespace axisgate::drive::test {
namespace {
using namespace std::chrono_literals;
using testing::ElementsAre;

TEST(DriveExchange, IsRepeatedAndThenOver) {
    Exchange<int> x;
    AdapterCounters c;
    Instant now = time_zero + 1s;
    EXPECT_EQ(x.deadline(), never);
    EXPECT_EQ(x.on_deadline(now, c), Late::no);
    x.begin(42, now, 50ms, 2);
    EXPECT_EQ(x.on_deadline(now + 49ms, c), Late::no);
    for (int i = 0; i < 2; ++i) {
        now = x.deadline();
        EXPECT_EQ(x.on_deadline(now, c), Late::repeat);
        EXPECT_EQ(x.deadline(), now + 50ms);
    }
    EXPECT_EQ(x.sent(), time_zero + 1s) << "for the first time";
    EXPECT_EQ(x.on_deadline(x.deadline(), c), Late::over);
    EXPECT_FALSE(x.active());
    EXPECT_EQ(x.request(), 42) << "still known to who asks what was given up";
    EXPECT_EQ(c.timeouts, 3u);
    EXPECT_EQ(c.retries, 2u);
    EXPECT_EQ(c.exchanges, 0u);
    EXPECT_EQ(x.tries(), 3);
}

TEST(DriveExchange, AnAnswerEndsIt) {
    Exchange<int> x;
    AdapterCounters c;
    x.begin(1, time_zero, 50ms, 1);
    EXPECT_EQ(x.answered(c), 1);
    EXPECT_EQ(c.exchanges, 1u);
    EXPECT_EQ(x.on_deadline(time_zero + 1h, c), Late::no);
    x.begin(2, time_zero, 50ms, 1);
    x.extend(time_zero + 80ms);
    x.extend(time_zero + 20ms);
    EXPECT_EQ(x.deadline(), time_zero + 80ms) << "never sooner than it was";
    x.no_repeats();
    EXPECT_FALSE(x.repeatable());
    EXPECT_EQ(x.on_deadline(time_zero + 80ms, c), Late::over);
    x.begin(3, time_zero, 50ms, 1);
    x.drop();
    EXPECT_EQ(x.deadline(), never);
    EXPECT_EQ(c.timeouts, 1u) << "what is dropped is not counted";
}

TEST(DriveExchange, LateAnswersAreKnownByTheirMarkOrByTime) {
    LateMarks<int, 3> marks;
    for (int m : {1, 2, 1, 3, 4})
        marks.add(m);
    EXPECT_TRUE(marks.has(1) && marks.has(2) && marks.has(3));
    EXPECT_FALSE(marks.has(4)) << "no more than three are kept";
    marks.clear();
    EXPECT_TRUE(marks.none() && !marks.has(1));

    LateTime late;
    const Instant now = time_zero + 5s;
    EXPECT_TRUE(late.over(now));
    late.missed(now, 100ms);
    late.missed(now - 50ms, 100ms);
    EXPECT_EQ(late.until(), now + 100ms) << "the later of the two";
    EXPECT_FALSE(late.over(now + 99ms));
    EXPECT_TRUE(late.over(now + 100ms));
    late.missed(now, 1h);
    late.settled();
    EXPECT_TRUE(late.over(now));
}

TEST(DriveTiming, TheSiteGoesBeforeTheFamilyAndStaysInItsRanges) {
    Timing own;
    own.reply_timeout = 120ms;
    own.pause = 3ms;
    own.retries = 4;
    Timing t = timing_of(LineTiming{}, own);
    EXPECT_EQ(t.reply_timeout, 120ms);
    EXPECT_EQ(t.pause, 3ms);
    EXPECT_EQ(t.retries, 4);
    EXPECT_EQ(t.silent_limit, 3);
    LineTiming site;
    site.reply_timeout = 30ms;
    site.poll_period = -1ms;
    site.retries = 1000;
    site.silent_limit = 0;
    site.retry_pause_min = 10s;
    site.retry_pause_max = 1s;
    t = timing_of(site, own);
    EXPECT_EQ(t.reply_timeout, 30ms);
    EXPECT_EQ(t.poll_period, own.poll_period);
    EXPECT_EQ(t.retries, 10);
    EXPECT_EQ(t.silent_limit, 1);
    EXPECT_EQ(t.pause_max, t.pause_min);
    EXPECT_EQ(fitting(25ms, 2ms, 1, 16), 12u);
    EXPECT_EQ(fitting(1ms, 2ms, 1, 16), 1u);
    EXPECT_EQ(fitting(1s, Duration::zero(), 1, 16), 16u) << "a bit rate that nobody knows";
}

TEST(DriveOptions, OneWordingForAllFamilies) {
    const std::map<std::string, std::string> options{{"crc", "14"},       {"notify", "on"},  {"strict", "1"}, {"half", "half"},
                                                     {"input", "4"},      {"speed", "12x"},  {"wait", "250"}, {"empty", ""},
                                                     {"order", "manual"}, {"good", "second"}};
    OptionReader r(options);
    EXPECT_EQ(r.word("crc", {"12", "13", "auto"}), "12");
    EXPECT_EQ(r.word("good", {"first", "second"}), "second");
    EXPECT_EQ(r.word("none", {"first", "second"}), "first");
    EXPECT_TRUE(r.flag("notify", false));
    EXPECT_TRUE(r.flag("strict", false));
    EXPECT_FALSE(r.flag("half", false));
    EXPECT_FALSE(r.flag("order", true, "auto", "manual"));
    EXPECT_TRUE(r.flag("none", true));
    EXPECT_EQ(r.whole("input", 1, 3, 0), 0);
    EXPECT_EQ(r.whole("speed", 1, 100, 7), 7) << "half of a number is none";
    EXPECT_EQ(r.whole("empty", 1, 3, 2), 2);
    EXPECT_EQ(r.milliseconds("wait", 100, 1000, 1s), 250ms);
    EXPECT_EQ(r.milliseconds("none", 100, 1000, 1s), 1s);
    EXPECT_THAT(r.take_faults(),
                ElementsAre("option crc = 14: write 12, 13 or auto; 12 is used", "option half = half: write on or off; off is used",
                            "option input = 4: write a whole number 1..3; 0 is used",
                            "option speed = 12x: write a whole number 1..100; 7 is used"));
}

TEST(DriveNotices, ABucketAndNoBoundForAlarms) {
    Notices n(DriveId{9});
    Out out;
    Instant now = time_zero + 1h;
    for (int i = 0; i < 50; ++i)
        n.tell(Severity::info, AxisId{2}, "input", i, "IN1", now, out);
    EXPECT_EQ(out.notices.size(), 20u);
    EXPECT_EQ(n.left_out(), 30u);
    n.tell(Severity::alarm, AxisId{2}, "alarm", 1, "stall", now, out);
    EXPECT_EQ(out.notices.size(), 21u);
    n.tell(Severity::info, AxisId{2}, "input", 1, "IN1", now + 99ms, out);
    EXPECT_EQ(out.notices.size(), 21u);
    n.tell(Severity::info, AxisId{2}, "input", 1, "IN1", now + 100ms, out);
    ASSERT_EQ(out.notices.size(), 22u);
    EXPECT_EQ(out.notices.back().text, "IN1 (31 more were not told: too many in a second)");
    EXPECT_EQ(out.notices.back().drive, DriveId{9});
    out.clear();
    for (int i = 0; i < 200; ++i)
        n.tell(Severity::warning, no_axis, "x", 0, "x", now + 1s + i * 10ms, out);
    EXPECT_LE(out.notices.size(), 30u + 10u);
    EXPECT_GE(out.notices.size(), 25u);
}

}  // namespace
}  // namespace axisgate::drive::test
