// A socket that becomes ready while others are served is served in the same turn, and a turn has its bound.
#include "gateway/lines/poller.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <boost/asio/io_context.hpp>
#include <chrono>
#include <vector>

namespace axisgate {
namespace {

std::chrono::steady_clock::time_point test_time{};
std::chrono::steady_clock::time_point test_clock() { return test_time; }

struct Pairs {
    explicit Pairs(std::size_t n) : ours(n), theirs(n) {
        for (std::size_t i = 0; i < n; ++i) {
            int fds[2] = {-1, -1};
            EXPECT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, fds), 0);
            ours[i] = fds[0];
            theirs[i] = fds[1];
        }
    }
    ~Pairs() {
        for (const int fd : ours)
            ::close(fd);
        for (const int fd : theirs)
            ::close(fd);
    }
    Pairs(const Pairs&) = delete;
    Pairs& operator=(const Pairs&) = delete;
    void ask(std::size_t i) const { EXPECT_EQ(::send(theirs[i], "?", 1, 0), 1); }
    void take(std::size_t i) const {
        char byte = 0;
        EXPECT_EQ(::recv(ours[i], &byte, 1, 0), 1);
    }
    std::vector<int> ours, theirs;
};

TEST(Poller, WhoIsReadyWhileOthersAreServedIsServedInTheSameTurn) {
    boost::asio::io_context io;
    const Pairs pairs(3);
    std::vector<std::uint64_t> served;
    Poller poller(
        io,
        [&](std::span<const epoll_event> events) {
            for (const epoll_event& e : events) {
                const std::uint64_t i = e.data.u64;
                served.push_back(i);
                pairs.take(i);
                if (i + 1 < pairs.ours.size()) pairs.ask(i + 1);  // one client asks after the other
            }
        },
        test_clock);  // a turn also ends by its time; here no time passes
    for (std::size_t i = 0; i < pairs.ours.size(); ++i)
        ASSERT_TRUE(poller.add(pairs.ours[i], i, EPOLLIN));
    EXPECT_FALSE(poller.serve_now());
    pairs.ask(0);
    EXPECT_EQ(io.poll_one(), 1u);
    EXPECT_EQ(served, (std::vector<std::uint64_t>{0, 1, 2})) << "one turn of the loop for all of them";
    EXPECT_FALSE(poller.serve_now());
}

TEST(Poller, WhoAsksWithoutAnEndDoesNotKeepATurnForHimself) {
    boost::asio::io_context io;
    const Pairs pairs(1);
    int served = 0;
    Poller poller(
        io,
        [&](std::span<const epoll_event>) {
            ++served;
            pairs.take(0);
            pairs.ask(0);
        },
        test_clock);
    ASSERT_TRUE(poller.add(pairs.ours[0], 0, EPOLLIN));
    pairs.ask(0);
    EXPECT_EQ(io.poll_one(), 1u);
    EXPECT_EQ(served, Poller::events_per_turn);
    EXPECT_EQ(io.poll_one(), 1u) << "and he is asked for again";
    EXPECT_EQ(served, 2 * Poller::events_per_turn);
}

TEST(Poller, WhoTakesLongIsServedOnceAndWhatIsDueHasItsTurn) {
    boost::asio::io_context io;
    const Pairs pairs(1);
    int served = 0;
    std::chrono::microseconds takes = Poller::asks_again;
    Poller poller(
        io,
        [&](std::span<const epoll_event>) {
            ++served;
            test_time += takes;
            pairs.take(0);
            pairs.ask(0);
        },
        test_clock);
    ASSERT_TRUE(poller.add(pairs.ours[0], 0, EPOLLIN));
    pairs.ask(0);
    EXPECT_EQ(io.poll_one(), 1u);
    EXPECT_EQ(served, 1) << "its time is over";
    takes = Poller::asks_again / 5;
    EXPECT_EQ(io.poll_one(), 1u) << "and it is asked for again";
    EXPECT_EQ(served, 1 + 5) << "until the time is over";
}
}  // namespace
}  // namespace axisgate
