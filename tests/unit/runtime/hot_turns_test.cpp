// Which time counts as work of a turn, with the test's clock.
#include "gateway/runtime/hot_turns.hpp"

#include <gtest/gtest.h>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>

namespace axisgate {
namespace {
using namespace std::chrono_literals;

Instant turns_time{};
Instant turns_clock() noexcept { return turns_time; }

TEST(HotTurns, ATurnBeginsWithTheFirstLookAtTheTimeAndNotWithTheSleep) {
    turns_time = at_ns(1'000'000'000);
    boost::asio::io_context io;
    const auto work = boost::asio::make_work_guard(io);
    HotTurns turns(io, turns_clock);
    turns.begin(turns.now());
    boost::asio::post(io, [&] {
        turns_time += 300us;  // the sleep
        (void)turns.now();
        turns_time += 40us;  // the work
        (void)turns.now();
    });
    turns.sleep();
    turns_time += 3us;  // what follows belongs to it
    turns.end(turns.now());
    EXPECT_EQ(turns.times().read().sum_ns, 43'000u);
    turns_time += 5us;  // goes on without a sleep
    turns.end(turns.now());
    EXPECT_EQ(turns.times().read().sum_ns, 48'000u);
    boost::asio::post(io, [] { turns_time += 200us; });  // a handler that does not read the time
    turns.sleep();
    turns.end(turns.now());
    EXPECT_EQ(turns.times().read().sum_ns, 48'000u);
    EXPECT_EQ(turns.times().read().count(), 3u);
}

TEST(HotTurns, HowLateTheTimerRingsIsTold) {
    turns_time = at_ns(1'000'000'000);
    boost::asio::io_context io;
    const auto work = boost::asio::make_work_guard(io);
    HotTurns turns(io, turns_clock);
    turns.arm(turns_time - 1ms);  // due already
    EXPECT_EQ(turns.armed(), at_ns(999'000'000));
    turns_time += 7us;
    turns.sleep();
    EXPECT_EQ(turns.armed(), never);
    EXPECT_EQ(turns.wake_delays().read().sum_ns, 1'007'000u);
}
}  // namespace
}  // namespace axisgate
