// Each rung call is answered once, by the receiver only, and no call of several senders is lost.
#include "gateway/runtime/doorbell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "gateway/runtime/mailbox.hpp"

namespace axisgate {
namespace {

struct DoorbellTest : ::testing::Test {
    boost::asio::io_context io;
    Doorbell bell{io};
    std::string received;
    Doorbell::Call a{bell, [this] { received += 'a'; }}, b{bell, [this] { received += 'b'; }};
};

TEST_F(DoorbellTest, WhatIsRungIsAnsweredOnceAndNothingElse) {
    b.ring();
    b.ring();
    EXPECT_EQ(received, "") << "not by who rings";
    (void)io.poll();
    EXPECT_EQ(received, "b");
    a.ring();
    b.ring();
    (void)io.poll();
    EXPECT_EQ(received, "bab");
    (void)io.poll();
    EXPECT_EQ(received, "bab");
}

TEST_F(DoorbellTest, WhatIsRungFromInsideAnAnswerIsAnsweredToo) {
    int left = 3;
    Doorbell::Call again(bell, [&] {
        received += 'c';
        if (--left > 0) again.ring();
        a.ring();  // before it in the list
    });
    again.ring();
    (void)io.poll();
    EXPECT_EQ(std::ranges::count(received, 'c'), 3);
    EXPECT_EQ(received.back(), 'a');
}

TEST_F(DoorbellTest, ACallThatIsGoneIsNotAnswered) {
    {
        Doorbell::Call gone(bell, [this] { received += 'x'; });
        gone.ring();
    }
    a.ring();
    (void)io.poll();
    EXPECT_EQ(received, "a");
}

TEST_F(DoorbellTest, AnEndedBellKeepsNobodyWaitingAndAnswersWhenItIsAsked) {
    a.ring();
    bell.end();
    io.run();  // returns
    EXPECT_EQ(received, "");
    bell.answer();
    EXPECT_EQ(received, "a");
}

TEST_F(DoorbellTest, NothingIsLostBetweenThreads) {
    constexpr int senders = 4, each = 5000;
    std::vector<int> got(senders);
    std::vector<std::unique_ptr<Mailbox<int>>> boxes;
    int whole = 0;
    for (int s = 0; s < senders; ++s) {
        boxes.push_back(std::make_unique<Mailbox<int>>(64, bell, [&, s](int&& n) {
            EXPECT_EQ(n, got[static_cast<std::size_t>(s)]++) << "in order";
            if (n == each - 1 && ++whole == senders) bell.end();
        }));
    }
    std::vector<std::thread> threads;
    for (int s = 0; s < senders; ++s) {
        threads.emplace_back([&box = *boxes[static_cast<std::size_t>(s)]] {
            for (int n = 0; n < each; ++n) {
                while (!box.push(int{n}))
                    std::this_thread::yield();
                box.announce();
            }
        });
    }
    io.run();
    for (auto& t : threads)
        t.join();
    EXPECT_EQ(got, std::vector<int>(senders, each));
}

}  // namespace
}  // namespace axisgate
