// Answers that the other end does not read wait in order and within their bound; each end is reported once.
#include "gateway/doors/enip/tcp_session.hpp"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <chrono>

namespace axisgate::enip {
namespace {

class TcpSessionTest : public ::testing::Test {
protected:
    static constexpr std::size_t bound = 1u << 20;
    boost::asio::io_context io{1};
    std::shared_ptr<TcpSession> session;
    Poller poller{io, [this](std::span<const epoll_event> events) {
                      for (const auto& e : events)
                          if (const auto s = session; s && e.data.u64 == 7) {
                              s->on_ready(e.events);
                              if (on_answered) on_answered();
                              s->flush();
                          }
                  }};
    cip::Bytes came;
    std::function<void()> on_arrival, on_answered;
    int far = -1, ends = 0;

    void SetUp() override {
        std::array<int, 2> pair{};
        ASSERT_EQ(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair.data()), 0);
        far = pair[1];
        ASSERT_TRUE(poller.add(pair[0], 7, TcpSession::watched));
        session = std::make_shared<TcpSession>(
            pair[0], poller, 7, bound,
            [this](cip::View bytes) {
                cip::put_bytes(came, bytes);
                if (on_arrival) on_arrival();
            },
            [this] {
                ++ends;
                session.reset();
            });
    }
    void TearDown() override {
        if (far >= 0) ::close(far);
    }
    void turn() {
        (void)io.run_for(std::chrono::milliseconds(5));
        io.restart();
    }
    cip::Bytes take() {
        cip::Bytes all;
        std::array<std::uint8_t, 65536> part;
        for (ssize_t n = 0; (n = ::recv(far, part.data(), part.size(), MSG_DONTWAIT)) > 0;)
            cip::put_bytes(all, {part.data(), static_cast<std::size_t>(n)});
        return all;
    }
    void write(std::size_t n) { ASSERT_EQ(::send(far, cip::Bytes(n, 1).data(), n, 0), static_cast<ssize_t>(n)); }
};

TEST_F(TcpSessionTest, WhatTheOtherEndDoesNotTakeWaitsInOrderAndNothingIsReadMeanwhile) {
    cip::Bytes wanted, got;
    for (std::uint8_t i = 0; i < 12; ++i) {
        const cip::Bytes part(50'000, i);
        session->send(part);
        cip::put_bytes(wanted, part);
    }
    write(10);
    turn();
    EXPECT_TRUE(came.empty()) << "a client that takes no answers is not read from";
    for (int i = 0; i < 100 && got.size() < wanted.size(); ++i) {
        cip::put_bytes(got, take());
        turn();
    }
    EXPECT_TRUE(got == wanted);
    turn();
    EXPECT_EQ(came.size(), 10u) << "and is again when it has taken them";
    EXPECT_EQ(ends, 0);
}

TEST_F(TcpSessionTest, BeyondItsBoundTheSessionEnds) {
    for (int i = 0; i < 40; ++i)
        if (session) session->send(cip::Bytes(50'000, 1));
    turn();
    EXPECT_EQ(ends, 1);
}

TEST_F(TcpSessionTest, TheOtherEndsEndIsToldOnceAndWhatCameBeforeItIsRead) {
    write(5);
    ::close(std::exchange(far, -1));
    turn();
    turn();
    EXPECT_EQ(came.size(), 5u);
    EXPECT_EQ(ends, 1);
}

TEST_F(TcpSessionTest, WhatIsMoreThanOneReadTakesIsReadToItsEnd) {
    write(30'000);
    turn();
    turn();
    EXPECT_EQ(came.size(), 30'000u);
    write(4096);  // as much as one read takes, so that it is unknown whether there is more
    turn();
    write(1);
    turn();
    EXPECT_EQ(came.size(), 34'097u);
    EXPECT_EQ(ends, 0);
}

TEST_F(TcpSessionTest, WhatCameWhileAnswersWaitedIsReadWhenTheyAreOut) {
    on_arrival = [this] { session->send(cip::Bytes(300'000, 9)); };
    write(1);
    turn();
    on_arrival = {};
    write(7);
    turn();
    EXPECT_EQ(came.size(), 1u);
    std::size_t taken = 0;
    for (int i = 0; i < 100 && taken < 300'000; ++i, turn())
        taken += take().size();
    turn();
    EXPECT_EQ(taken, 300'000u);
    EXPECT_EQ(came.size(), 8u);
}

TEST_F(TcpSessionTest, HungUpFromInsideWhatArrivedItEndsAfterItsAnswer) {
    on_arrival = [this] {
        session->send(cip::Bytes(3, 9));
        session->hang_up();
        session->send(cip::Bytes(3, 8));
    };
    write(1);
    turn();
    turn();
    EXPECT_EQ(take(), cip::Bytes(3, 9));
    EXPECT_EQ(ends, 1);
}

TEST_F(TcpSessionTest, AnswersOfATurnGoTogetherWhenItIsFlushed) {
    on_arrival = [this] {
        session->send(cip::Bytes(3, 1));
        session->send(cip::Bytes(3, 2));
    };
    std::size_t early = 0;
    on_answered = [&] { early += take().size(); };
    write(1);
    turn();
    EXPECT_EQ(early, 0u);
    EXPECT_EQ(take(), (cip::Bytes{1, 1, 1, 2, 2, 2}));
    session->send(cip::Bytes(1, 3));
    EXPECT_EQ(take(), cip::Bytes(1, 3)) << "outside of a turn at once";
}

TEST_F(TcpSessionTest, ManyAnswersToOneReadAreNotHeldBackBeyondABound) {
    std::size_t early = 0;
    on_answered = [&] { early += take().size(); };
    on_arrival = [this] {
        for (int i = 0; i < 100; ++i)
            session->send(cip::Bytes(1'000, 1));
    };
    write(1);
    turn();
    EXPECT_GE(early, 80'000u);
    EXPECT_EQ(early + take().size(), 100'000u);
    EXPECT_EQ(ends, 0);
}

TEST_F(TcpSessionTest, AnAnswerToWhoHasGoneEndsTheSessionOnce) {
    on_arrival = [this] {
        ::close(std::exchange(far, -1));
        session->send(cip::Bytes(3, 1));
        session->send(cip::Bytes(3, 2));
    };
    write(1);
    turn();
    turn();
    EXPECT_EQ(ends, 1);
}

}  // namespace
}  // namespace axisgate::enip
