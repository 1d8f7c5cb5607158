// Requests that only read give way to commands: while bytes wait at a socket, no further long job is begun.
#include "gateway/doors/http/later.hpp"

#include <gtest/gtest.h>

#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <string>

namespace axisgate::http {
namespace {
namespace asio = boost::asio;
using asio::local::stream_protocol;

void take_long() {
    const auto end = std::chrono::steady_clock::now() + 2 * Later::most_at_once;
    while (std::chrono::steady_clock::now() < end) {
    }
}

struct LaterTest : ::testing::Test {
    asio::io_context context;
    std::shared_ptr<Later> later = std::make_shared<Later>(context);
    std::string order;
};

TEST_F(LaterTest, BytesThatCameDuringAJobAreTakenUpBeforeTheNextOne) {
    stream_protocol::socket here(context), there(context);
    asio::local::connect_pair(here, there);
    char byte = 0;
    here.async_read_some(asio::buffer(&byte, 1), [&](const boost::system::error_code& ec, std::size_t) { order += ec ? '!' : 'C'; });
    later->put([&] {
        order += '1';
        there.write_some(asio::buffer("x", 1));
        take_long();
    });
    for (const char name : {'2', '3'})
        later->put([&, name] {
            order += name;
            take_long();
        });
    context.run();
    EXPECT_EQ(order, "1C23");
}

TEST_F(LaterTest, JobsAreDoneInTheirOrderAndNeverWhereTheyAreGiven) {
    later->put([&] {
        later->put([&] { order += 'b'; });
        order += 'a';
    });
    EXPECT_EQ(order, "");
    context.run();
    EXPECT_EQ(order, "ab");
}

TEST_F(LaterTest, WhatCommandsAllTheTimeLeavesOneJobATurn) {
    int commands = 0;
    std::function<void()> command = [&] {
        if (++commands < 1000 && order.size() < 20) asio::post(context, command);
    };
    asio::post(context, command);
    for (int i = 0; i < 20; ++i)
        later->put([&] {
            order += 'j';
            take_long();
        });
    context.run();
    EXPECT_EQ(order.size(), 20U);
    EXPECT_LT(commands, 100);
}

TEST_F(LaterTest, AJobOfOneThatIsGoneIsNotDone) {
    later->put([&] { order += 'x'; });
    later.reset();
    context.run();
    EXPECT_EQ(order, "");
}
}  // namespace
}  // namespace axisgate::http
