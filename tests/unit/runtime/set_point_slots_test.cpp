// The newest set-point of each axis counts, none is permanently lost, and two threads never read a torn one.
#include "gateway/runtime/set_point_slots.hpp"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <thread>
#include <vector>

namespace axisgate {
namespace {

SetPoint point(std::uint16_t axis, std::int64_t value) {
    SetPoint p;
    p.axis = AxisId{axis};
    p.value = value;
    p.origin.who = std::make_shared<const std::string>("somebody");
    return p;
}

TEST(SetPointSlots, TheNewestOfEachAxisCounts) {
    boost::asio::io_context io;
    Doorbell bell(io);
    std::vector<std::pair<int, std::int64_t>> received;
    SetPointSlots slots(bell, [&](const SetPoint& p) { received.emplace_back(index_of(p.axis), p.value); });
    for (int i = 0; i < 100; ++i)
        slots.put(point(70, i));
    slots.put(point(3, 7));
    slots.put(point(0xFFFF, 1));  // no axis
    EXPECT_EQ(io.poll(), 1u) << "announced once";
    EXPECT_EQ(received, (std::vector<std::pair<int, std::int64_t>>{{3, 7}, {70, 99}}));
    io.restart();
    slots.put(point(70, 5));
    (void)io.poll();
    EXPECT_EQ(received.back(), (std::pair<int, std::int64_t>{70, 5}));
    slots.put(point(1, 1));  // set-points that are not taken any more are dropped with the slots
}

TEST(SetPointSlots, TheLastOfEachThreadArrives) {
    boost::asio::io_context io;
    Doorbell bell(io);
    constexpr int senders = 3;
    constexpr std::int64_t last = 20'000;
    std::array<std::int64_t, senders> newest{};
    bool backwards = false;
    int done = 0;
    SetPointSlots slots(bell, [&](const SetPoint& p) {
        auto& n = newest[index_of(p.axis)];
        backwards = backwards || p.value <= n;
        n = p.value;
        if (p.value == last && ++done == senders) bell.end();
    });
    std::vector<std::thread> threads;
    for (int s = 0; s < senders; ++s) {
        threads.emplace_back([&slots, s] {
            for (std::int64_t i = 1; i <= last; ++i)
                slots.put(point(static_cast<std::uint16_t>(s), i));
        });
    }
    io.run();
    for (auto& t : threads)
        t.join();
    EXPECT_FALSE(backwards);
    EXPECT_EQ(newest, (std::array<std::int64_t, senders>{last, last, last}));
}

}  // namespace
}  // namespace axisgate
