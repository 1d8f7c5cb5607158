// Rows for which nobody waits are collected, others are not, and nothing is lost at the end, with a real store and a real thread. The
// bounds on the number of transactions depend on the time that really passed; a slow machine can only make them easier.
#include "gateway/runtime/cold.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/unit/store/fixture.hpp"

namespace axisgate::test {
namespace {
using namespace std::chrono_literals;

struct Bench {
    TempDir dir;
    std::unique_ptr<Store> store = open_store(dir);
    std::mutex mutex;
    std::condition_variable changed;
    std::vector<Event> events;
    std::vector<Stored> stored;
    std::unique_ptr<Cold> cold;

    Bench() {
        Cold::Answers answers;
        answers.events = [this](std::vector<Event> list) {
            const std::lock_guard hold(mutex);
            events.insert(events.end(), list.begin(), list.end());
            changed.notify_all();
        };
        answers.stored = [this](std::vector<Stored> list) {
            const std::lock_guard hold(mutex);
            stored.insert(stored.end(), list.begin(), list.end());
            changed.notify_all();
        };
        cold = std::make_unique<Cold>(*store, std::move(answers));
        cold->start();
    }
    void tell(int number) {
        Event e;
        e.kind = "command";
        e.code = number;
        ASSERT_TRUE(cold->from_hot().push(EventAt{std::move(e), Instant{}}));
        cold->from_hot().announce();
    }
    template <class Condition>
    [[nodiscard]] bool until(Condition condition) {
        std::unique_lock hold(mutex);
        return changed.wait_for(hold, 10s, condition);
    }
};

TEST(Cold, EventsThatNobodyWaitsForShareTheirTransactions) {
    Bench b;
    const auto begun = std::chrono::steady_clock::now();
    constexpr int count = 150;
    for (int i = 0; i < count; ++i) {
        b.tell(i);
        std::this_thread::sleep_for(1ms);  // a controller that writes a target every millisecond
    }
    ASSERT_TRUE(b.until([&] { return b.events.size() == count; }));
    const auto took = std::chrono::steady_clock::now() - begun;
    EXPECT_LE(b.cold->batches(), static_cast<std::uint64_t>(took / cold_gathers) + 2);
    for (int i = 0; i < count; ++i) {
        EXPECT_EQ(b.events[static_cast<std::size_t>(i)].code, i);
        EXPECT_EQ(b.events[static_cast<std::size_t>(i)].id, static_cast<std::uint64_t>(i) + 1) << "ids count up without gaps";
    }
}

TEST(Cold, AWriteTakesWhatWasGatheredWithIt) {
    Bench b;
    b.tell(1);
    ASSERT_TRUE(b.until([&] { return b.events.size() == 1; }));
    Event second;
    second.kind = "command";
    ASSERT_TRUE(b.cold->from_hot().push(EventAt{std::move(second), Instant{}}));
    StoreOrder order;
    order.ticket = Ticket{7};
    order.axis_name = "x";
    order.parameter = "current_limit";
    order.value = std::int64_t{5};
    ASSERT_TRUE(b.cold->from_hot().push(std::move(order)));
    b.cold->from_hot().announce();
    ASSERT_TRUE(b.until([&] { return b.stored.size() == 1 && b.events.size() == 2; }));
    EXPECT_EQ(b.stored[0].fault, "");
    EXPECT_EQ(b.cold->batches(), 2u) << "the order and the event before it are one transaction";
}

TEST(Cold, WhoReadsEventsHasThemWrittenFirst) {
    Bench b;
    b.tell(1);
    ASSERT_TRUE(b.until([&] { return b.events.size() == 1; }));
    Event second;
    second.kind = "command";
    ASSERT_TRUE(b.cold->from_hot().push(EventAt{std::move(second), Instant{}}));  // and not announced
    std::uint64_t seen = 0;
    bool done = false;
    b.cold->flush([&] {
        const std::lock_guard hold(b.mutex);
        seen = must(b.store->last_event_id());
        done = true;
        b.changed.notify_all();
    });
    ASSERT_TRUE(b.until([&] { return done; }));
    EXPECT_EQ(seen, 2u);
}

TEST(Cold, WhatIsGatheredIsOnTheDiskWhenItHasStopped) {
    Bench b;
    b.tell(1);
    ASSERT_TRUE(b.until([&] { return b.events.size() == 1; }));
    for (int i = 2; i <= 20; ++i)
        b.tell(i);
    b.cold->stop();
    EXPECT_EQ(must(b.store->last_event_id()), 20u);
}

TEST(Cold, ManyAtOnceAreAllWritten) {
    Bench b;
    b.tell(0);
    ASSERT_TRUE(b.until([&] { return b.events.size() == 1; }));
    for (int i = 1; i <= 3000; ++i)
        b.tell(i);  // more than one batch holds, fewer than the ring
    ASSERT_TRUE(b.until([&] { return b.events.size() == 3001; }));
    EXPECT_EQ(must(b.store->last_event_id()), 3001u);
}

}  // namespace
}  // namespace axisgate::test
