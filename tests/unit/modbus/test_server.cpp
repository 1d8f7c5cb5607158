// Real sockets on loopback, with the test's time: silence, slowness or garbage of one client do not affect another.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "gateway/doors/modbus/adu_framer.hpp"
#include "gateway/doors/modbus/endpoint.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "tests/unit/modbus/net.hpp"

namespace axisgate::modbus {
namespace {
using namespace registers;
using namespace std::chrono_literals;
using test::adu;
using test::Net;
using test::TcpClient;

const std::string read_one = "03 00 00 00 01", read_answer = "03 02 02 50", control = "06 00 20 00 0F";
constexpr std::size_t read_size = 11, control_size = 12;

bool serves(TcpClient& c, std::uint16_t transaction = 99) {
    return c.ask(adu(transaction, read_one), read_size) == adu(transaction, read_answer);
}

TEST(Server, AnswersOverTcp) {
    Net net;
    TcpClient c(net);
    c.connect();
    EXPECT_EQ(c.ask(adu(1, read_one), read_size), adu(1, read_answer));
    EXPECT_EQ(c.ask(adu(2, read_one) + adu(3, read_one), 2 * read_size), adu(2, read_answer) + " " + adu(3, read_answer));
    const Counters& n = net.server->counters();
    EXPECT_EQ(n.connections_accepted.value(), 1u);
    EXPECT_EQ(n.connections_open.value(), 1u);
    EXPECT_EQ(n.requests.value(), 3u);
    EXPECT_EQ(n.bytes_received.value(), 36u);
    EXPECT_EQ(n.bytes_sent.value(), 33u);
    c.close();
    net.turn();
    EXPECT_EQ(n.connections_open.value(), 0u);
}

TEST(Server, AnswersOfOneArrivalLeaveInOneSegment) {
    Net net;
    TcpClient c(net);
    c.connect();
    std::string requests;
    for (std::uint16_t i = 0; i < 8; ++i)
        requests += adu(i, read_one);
    c.send(requests);
    std::uint8_t buffer[1024];
    EXPECT_EQ(::recv(c.fd(), buffer, sizeof buffer, 0), static_cast<ssize_t>(8 * read_size));
}

TEST(Server, ByteByByte) {
    Net net;
    TcpClient c(net);
    c.connect();
    for (const auto b : test::bytes(adu(7, read_one)))
        c.send(test::hex(std::span(&b, 1)));
    EXPECT_EQ(c.receive(read_size), adu(7, read_answer));
}

TEST(Server, ASlowDriveHoldsUpOnlyItsOwnConnection) {
    Net net;
    TcpClient slow(net), other(net);
    slow.connect();
    other.connect();
    slow.send(adu(1, control) + adu(2, read_one) + adu(3, "06 00 60 00 06"));
    EXPECT_TRUE(slow.quiet());
    EXPECT_TRUE(serves(other));
    net.port.answer();  // the first write
    EXPECT_EQ(slow.receive(control_size + read_size), adu(1, control) + " " + adu(2, read_answer));
    EXPECT_TRUE(slow.quiet());
    net.port.refuse(Reason::no_answer);
    EXPECT_EQ(slow.receive(9), adu(3, "86 0B"));
}

TEST(Server, ResultsOfOneTurnLeaveInOneSegment) {
    Net net;
    TcpClient c(net);
    c.connect();
    c.send(adu(1, control) + adu(2, "06 00 60 00 06") + adu(3, read_one));
    net.port.answer();
    net.port.answer();
    net.turn();
    std::uint8_t buffer[1024];
    EXPECT_EQ(::recv(c.fd(), buffer, sizeof buffer, 0), static_cast<ssize_t>(2 * control_size + read_size));
}

struct Garbage {
    const char* name;
    const char* bytes;
};
class ServerGarbage : public testing::TestWithParam<Garbage> {};
TEST_P(ServerGarbage, ClosesThatConnectionAndNoOther) {
    Net net;
    TcpClient bad(net), good(net);
    good.connect();
    bad.connect();
    EXPECT_EQ(bad.ask(adu(1, read_one) + GetParam().bytes, read_size), adu(1, read_answer)) << "what came before is answered";
    EXPECT_TRUE(bad.closed());
    EXPECT_TRUE(serves(good));
    EXPECT_EQ(net.server->counters().closed_not_modbus.value(), 1u);
    EXPECT_EQ(net.server->counters().connections_open.value(), 1u);
    TcpClient again(net);
    EXPECT_TRUE(serves(again.connect()));
}
INSTANTIATE_TEST_SUITE_P(Table, ServerGarbage,
                         testing::Values(Garbage{"http", "47 45 54 20 2F 20 48 54 54 50 2F 31 2E 31 0D 0A 0D 0A"},
                                         Garbage{"protocol_id", "00 01 00 01 00 06 01 03 00 00 00 01"},
                                         Garbage{"length_0", "00 01 00 00 00 00"}, Garbage{"length_1", "00 01 00 00 00 01 01"},
                                         Garbage{"length_65535", "00 01 00 00 FF FF 01 03"},
                                         Garbage{"ones", "FF FF FF FF FF FF FF FF FF FF"}),
                         [](const auto& i) { return i.param.name; });

TEST(Server, HalfARequestCostsNobodyAndEndsAfterFiveSeconds) {
    Net net;
    TcpClient half(net), other(net);
    half.connect();
    other.connect();
    half.send("00 01 00 00 00 06 01");
    EXPECT_TRUE(serves(other));
    for (int i = 0; i < 4; ++i) {
        net.pass(1s);
        half.send("03");  // single bytes do not help: 03 03 03 03 never becomes a whole request
        EXPECT_TRUE(serves(other));
    }
    EXPECT_FALSE(half.closed());
    net.pass(999ms);
    EXPECT_FALSE(half.closed());
    net.pass(1ms);
    EXPECT_TRUE(half.closed());
    EXPECT_EQ(net.server->counters().closed_partial.value(), 1u);
    EXPECT_TRUE(serves(other));
}

TEST(Server, ASlowButWholeRequestStartsAFreshFiveSeconds) {
    Net net;
    TcpClient c(net);
    c.connect();
    const auto request = test::bytes(adu(1, read_one));
    for (int round = 0; round < 4; ++round) {
        c.send(test::hex(std::span(request).first(8)));
        net.pass(4s);
        EXPECT_EQ(c.ask(test::hex(std::span(request).subspan(8)), read_size), adu(1, read_answer)) << round;
    }
    // The end of one request together with the beginning of the next: the five seconds count from there.
    c.send(test::hex(std::span(request).first(8)));
    net.pass(4s);
    EXPECT_EQ(c.ask(test::hex(std::span(request).subspan(8)) + "00 02", read_size), adu(1, read_answer));
    net.pass(4s);
    EXPECT_FALSE(c.closed());
    net.pass(1s);
    EXPECT_TRUE(c.closed());
}

TEST(Server, IdleConnectionsAreClosedAfterAMinute) {
    Net net;
    TcpClient silent(net), polling(net);
    silent.connect();
    polling.connect();
    for (int i = 0; i < 3; ++i) {
        net.pass(19s);
        EXPECT_TRUE(serves(polling));
    }
    net.pass(2999ms);
    EXPECT_FALSE(silent.closed());
    net.pass(1ms);
    EXPECT_TRUE(silent.closed());
    EXPECT_TRUE(serves(polling));
    EXPECT_EQ(net.server->counters().closed_idle.value(), 1u);
}

TEST(Server, ACommandingConnectionIsNotIdleWhileItsAxisMoves) {
    Net net;
    TcpClient c(net);
    c.connect();
    c.send(adu(1, control));
    net.port.answer();
    EXPECT_EQ(c.receive(control_size), adu(1, control));
    net.port.edit(net.axes[1], [](AxisPicture& p) {
        p.flags = flag_moving;
        p.authority = modbus::clients;
    });
    net.pass(10min);
    EXPECT_FALSE(c.closed());
    net.port.edit(net.axes[1], [](AxisPicture& p) { p.flags = 0; });
    net.pass(0s);
    EXPECT_TRUE(c.closed());
}

TEST(Server, AWriteOnItsWayKeepsTheConnectionAndEndsAtTheResultTimeout) {
    ServerSettings settings;
    settings.responder.result_timeout = 90s;
    Net net(settings);
    TcpClient c(net);
    c.connect();
    c.send(adu(1, control));
    net.pass(89s);
    EXPECT_TRUE(c.quiet());
    net.pass(1s);
    EXPECT_EQ(c.receive(9), adu(1, "86 0B"));
    EXPECT_TRUE(net.port.answer());
    EXPECT_TRUE(c.quiet()) << "the late result is not sent";
}

TEST(Server, WhenFullTheLongestIdleOneMakesRoom) {
    ServerSettings settings;
    settings.max_connections = 3;
    Net net(settings);
    TcpClient commanding(net), idle(net), polling(net), fresh(net), last(net);
    commanding.connect().send(adu(1, control));  // the oldest, but its write is in progress
    net.pass(1s);
    idle.connect();
    net.pass(1s);
    EXPECT_TRUE(serves(polling.connect()));
    net.pass(1s);
    EXPECT_TRUE(serves(fresh.connect()));
    EXPECT_TRUE(idle.closed());
    EXPECT_EQ(net.server->counters().connections_evicted.value(), 1u);
    EXPECT_TRUE(serves(polling));
    EXPECT_EQ(net.server->counters().connections_open.value(), 3u);
    net.pass(50ms);  // now no connection is idle: two have sent requests less than 100 ms ago, one waits for its drive
    last.connect();
    EXPECT_TRUE(last.closed());
    EXPECT_EQ(net.server->counters().connections_refused.value(), 1u);
    EXPECT_TRUE(serves(fresh));
    net.port.answer();
    EXPECT_EQ(commanding.receive(control_size), adu(1, control));
}

TEST(Server, WhenFullAConnectionWhoseAxisMovesStays) {
    ServerSettings settings;
    settings.max_connections = 2;
    Net net(settings);
    TcpClient commanding(net), other(net), fresh(net);
    commanding.connect().send(adu(1, control));
    net.port.answer();
    EXPECT_EQ(commanding.receive(control_size), adu(1, control));
    net.port.edit(net.axes[1], [](AxisPicture& p) {
        p.flags = flag_moving;
        p.authority = modbus::clients;
    });
    net.pass(1s);
    EXPECT_TRUE(serves(other.connect()));
    net.pass(1s);
    EXPECT_TRUE(serves(fresh.connect()));
    EXPECT_TRUE(other.closed());
    EXPECT_TRUE(serves(commanding));
}

TEST(Server, AFloodOfSilentConnectionsDoesNotPushOutOneThatPolls) {
    ServerSettings settings;
    settings.max_connections = 4;
    Net net(settings);
    TcpClient polling(net);
    EXPECT_TRUE(serves(polling.connect()));
    std::vector<TcpClient> flood;
    for (int i = 0; i < 40; ++i)
        flood.emplace_back(net).connect();
    EXPECT_TRUE(serves(polling));
    EXPECT_EQ(net.server->counters().connections_evicted.value(), 37u);
}

TEST(Server, ABusyFloodOfOneAddressGivesWayToItselfAndNotWhoHasCommanded) {
    ServerSettings settings;
    settings.max_connections = 16;
    Net net(settings);
    TcpClient commanded(net);
    commanded.connect().send(adu(1, control));
    net.port.answer();
    EXPECT_EQ(commanded.receive(control_size), adu(1, control));
    net.pass(1s);
    std::vector<TcpClient> flood;
    for (int i = 0; i < 100; ++i) {
        flood.emplace_back(net);
        EXPECT_TRUE(serves(flood.back().connect())) << i << ": each has just asked, and the next gets in all the same";
    }
    EXPECT_EQ(net.server->counters().connections_refused.value(), 0u);
    EXPECT_LE(net.server->counters().connections_open.value(), 18u) << "16, and an eighth more for who has commanded";
    EXPECT_TRUE(serves(commanded)) << "it was silent for longer than any of them, but it has commanded";
}

TEST(Server, AClientThatDoesNotReadIsHeldBackAndClosed) {
    Net net;
    TcpClient deaf(net, 4096), other(net);
    deaf.connect();
    other.connect();
    const auto request = test::bytes(adu(1, "03 00 00 00 7D"));
    // The answers fill the sockets and one backlog; then requests stay in the kernel: more of them than the door's own buffer holds.
    const auto begun = [&] { return net.server->counters().requests.value() * request.size(); };
    std::size_t asked = 0;
    while (asked < begun() + 2 * AduFramer::capacity) {
        const auto n = ::send(deaf.fd(), request.data(), request.size(), MSG_NOSIGNAL);
        net.turn();
        if (n > 0) asked += static_cast<std::size_t>(n);
        ASSERT_LT(asked, 4u << 20) << "it is never held back";
    }
    const auto taken = net.server->counters().requests.value();
    EXPECT_TRUE(serves(other));
    net.pass(4999ms);
    EXPECT_EQ(net.server->counters().closed_not_reading.value(), 0u);
    EXPECT_EQ(net.server->counters().requests.value(), taken + 1);
    net.pass(1ms);
    EXPECT_EQ(net.server->counters().closed_not_reading.value(), 1u);
    EXPECT_TRUE(serves(other));
}

TEST(Server, AClientThatReadsLateGetsEverythingInOrder) {
    Net net;
    TcpClient late(net, 4096);
    late.connect();
    std::size_t asked = 0;
    std::vector<std::uint8_t> unsent;
    for (std::uint16_t i = 0; i < 3000 && unsent.empty(); ++i) {
        const auto request = test::bytes(adu(i, "03 00 00 00 7D"));
        const auto n = ::send(late.fd(), request.data(), request.size(), MSG_NOSIGNAL);
        const std::size_t sent = n > 0 ? static_cast<std::size_t>(n) : 0;
        if (sent > 0) ++asked;
        if (sent > 0 && sent < request.size()) unsent.assign(request.begin() + static_cast<std::ptrdiff_t>(sent), request.end());
        net.turn();
        if (n <= 0) break;
    }
    ASSERT_GT(asked, 100u);
    for (std::size_t i = 0; i + (unsent.empty() ? 0 : 1) < asked; ++i) {
        const auto answer = test::bytes(late.receive(259));
        ASSERT_EQ(answer.size(), 259u) << i;
        ASSERT_EQ(get16(answer.data()), static_cast<std::uint16_t>(i));
    }
    net.pass(30s);
    EXPECT_FALSE(late.closed()) << "having read, it is not deaf any more";
}

TEST(Server, TheEndOfAClientsStreamWaitsForItsAnswers) {
    Net net;
    TcpClient c(net);
    c.connect();
    c.send(adu(1, control) + adu(2, read_one));
    c.end_sending();
    EXPECT_TRUE(c.quiet());
    net.port.answer();
    EXPECT_EQ(c.receive(control_size + read_size), adu(1, control) + " " + adu(2, read_answer));
    EXPECT_TRUE(c.closed());
    EXPECT_EQ(net.server->counters().connections_open.value(), 0u);
}

TEST(Server, AClientThatGoesWithAWriteOnItsWay) {
    Net net;
    {
        TcpClient c(net);
        c.connect();
        c.send(adu(1, control));
    }
    net.turn();
    net.port.answer();
    net.turn();
    EXPECT_EQ(net.server->counters().connections_open.value(), 0u);
    TcpClient again(net);
    EXPECT_TRUE(serves(again.connect()));
}

TEST(Server, AHostIsLostWithItsLastConnectionAndHeardUntilThen) {
    Net net;
    TcpClient panel(net), tool(net);
    panel.connect();
    tool.connect();
    EXPECT_TRUE(serves(panel));
    const Instant asked = net.port.now();
    ASSERT_EQ(net.port.doors.back()->last_received({modbus::clients, "127.0.0.1"}), asked);
    EXPECT_EQ(net.port.doors.back()->last_received({modbus::clients, "127.0.0.2"}), std::nullopt);
    net.pass(2s);
    EXPECT_EQ(net.port.doors.back()->last_received({modbus::clients, "127.0.0.1"}), asked)
        << "an open connection that asks nothing is silent";
    panel.close();
    net.turn();
    EXPECT_TRUE(net.port.lost.empty()) << "another connection of the same host is there";
    tool.close();
    net.turn();
    ASSERT_EQ(net.port.lost.size(), 1u);
    EXPECT_EQ(net.port.lost[0], (std::pair{std::string("modbus 127.0.0.1"), modbus::loss_closed}));
    EXPECT_EQ(net.port.doors.back()->last_received({modbus::clients, "127.0.0.1"}), std::nullopt);
    TcpClient again(net);
    EXPECT_TRUE(serves(again.connect()));
    net.server->close();
    EXPECT_EQ(net.port.lost.size(), 1u) << "the gateway's own end is no client's";
}

TEST(Server, AResetIsNoHarm) {
    Net net;
    TcpClient c(net), other(net);
    c.connect();
    other.connect();
    c.send(adu(1, control));
    const linger hard{1, 0};
    ::setsockopt(c.fd(), SOL_SOCKET, SO_LINGER, &hard, sizeof hard);
    c.close();
    net.turn();
    EXPECT_EQ(net.server->counters().connections_open.value(), 1u);
    net.port.answer();
    EXPECT_TRUE(serves(other));
}

TEST(Server, AThousandConnectionsWithDescriptorsBeyond1023) {
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    rlimit wide = before;
    wide.rlim_cur = std::min<rlim_t>(before.rlim_max, 4096);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &wide), 0);
    ASSERT_GE(wide.rlim_cur, 2200u) << "this test needs 2200 descriptors: raise the hard limit (ulimit -Hn)";
    {
        Net net;
        std::vector<TcpClient> clients;
        for (int i = 0; i < 1024; ++i)
            clients.emplace_back(net).connect();
        EXPECT_EQ(net.server->counters().connections_open.value(), 1024u);
        EXPECT_GT(clients.back().fd(), 1023);
        for (std::uint16_t i = 0; i < 1024; ++i)
            ASSERT_TRUE(serves(clients[i], i)) << i;
        net.pass(1s);
        TcpClient one_more(net);
        EXPECT_TRUE(serves(one_more.connect()));
        EXPECT_TRUE(clients[0].closed()) << "the longest idle one";
        EXPECT_EQ(net.server->counters().connections_open.value(), 1024u);
    }
    ::setrlimit(RLIMIT_NOFILE, &before);
}

TEST(Server, OutOfDescriptorsItWaitsInsteadOfSpinning) {
    Net net;
    TcpClient first(net), second(net), third(net), fourth(net);
    EXPECT_TRUE(serves(first.connect()));
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    const int spare = ::dup(0);  // every number below this one is in use
    ::close(spare);
    rlimit tight = before;
    tight.rlim_cur = static_cast<rlim_t>(spare);
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &tight), 0);
    EXPECT_TRUE(serves(second.connect())) << "by the descriptor that is kept for this moment";
    EXPECT_TRUE(serves(first)) << "it has just asked: it is not closed to make room";
    third.connect();
    EXPECT_TRUE(serves(second));
    EXPECT_TRUE(serves(first));
    EXPECT_EQ(net.server->counters().connections_accepted.value(), 2u) << "it waits in the queue";
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
    net.pass(50ms);
    EXPECT_TRUE(serves(third));
    EXPECT_TRUE(serves(second));
    ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &tight), 0);
    net.pass(1s);
    fourth.connect();
    EXPECT_TRUE(first.closed()) << "idle by now";
    ::setrlimit(RLIMIT_NOFILE, &before);
    EXPECT_TRUE(serves(fourth));
    EXPECT_TRUE(serves(second));
}

TEST(Server, ListensOnSeveralAddresses) {
    boost::asio::io_context io;
    Net net;
    test::FakePort port;
    RegisterImage image(port, {});
    Server server(net.io, port, image, {});
    const std::vector<std::string> binds{"127.0.0.1:0", "127.0.0.1:0", "[::1]:0"};
    ASSERT_EQ(server.open(binds), "");
    const auto addresses = server.addresses();
    ASSERT_EQ(addresses.size(), 3u);
    EXPECT_THAT(addresses[2], testing::StartsWith("[::1]:"));
    for (std::size_t i = 0; i < 2; ++i) {
        TcpClient c(net);
        c.connect(Net::port_of(addresses[i]));
        EXPECT_EQ(c.ask(adu(1, "08 00 00 12 34"), 12), adu(1, "08 00 00 12 34"));
    }
}

TEST(Server, OpenTellsWhatIsWrongAndThenNothingIsOpen) {
    Net net;
    test::FakePort port;
    RegisterImage image(port, {});
    Server server(net.io, port, image, {});
    const std::vector<std::string> taken{"127.0.0.1:0", "127.0.0.1:" + std::to_string(net.tcp_port)};
    EXPECT_THAT(server.open(taken), testing::AllOf(testing::HasSubstr(taken[1]), testing::HasSubstr("choose another")));
    EXPECT_THAT(server.addresses(), testing::IsEmpty());
    const std::vector<std::string> foreign{"192.0.2.1:1502"};
    EXPECT_THAT(server.open(foreign), testing::HasSubstr("choose an address that this host has"));
    const std::vector<std::string> wrong{"localhost"};
    EXPECT_THAT(server.open(wrong), testing::HasSubstr("the port is missing"));
}

TEST(Server, ClosesWithEverythingOnItsWay) {
    Net net;
    TcpClient c(net), d(net);
    c.connect().send(adu(1, control));
    d.connect();
    net.server->close();
    EXPECT_TRUE(c.closed());
    EXPECT_TRUE(d.closed());
    EXPECT_TRUE(net.port.answer());
    net.turn();
    EXPECT_EQ(net.server->counters().connections_open.value(), 0u);
    net.server.reset();  // before its handlers in the io_context have run
    net.turn();
    EXPECT_EQ(net.port.doors.back(), nullptr);
}

TEST(Server, CanGoBetweenAResultAndItsAnswer) {
    Net net;
    TcpClient c(net);
    c.connect().send(adu(1, control));
    net.port.answer();
    net.server.reset();
    net.turn();
    EXPECT_TRUE(c.closed());
}

TEST(Server, CanBeOpenedAgain) {
    Net net;
    net.server->close();
    const std::vector<std::string> bind{"127.0.0.1:0"};
    ASSERT_EQ(net.server->open(bind), "");
    net.tcp_port = Net::port_of(net.server->addresses()[0]);
    TcpClient c(net);
    EXPECT_TRUE(serves(c.connect()));
}

TEST(Server, ServesAtOnceWhenItIsAsked) {
    Net net;
    EXPECT_FALSE(net.port.doors.back()->serve_now()) << "nobody has asked anything";
    TcpClient c(net);
    EXPECT_TRUE(serves(c.connect()));
    const auto answers = [&] { return net.server->counters().requests.value(); };
    const auto before = answers();
    const auto request = test::bytes(adu(1, control));
    ASSERT_EQ(::send(c.fd(), request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()))
        << "past c.send(), which runs the io_context";
    const auto limit = std::chrono::steady_clock::now() + 5s;
    bool served = false;
    while (!served && std::chrono::steady_clock::now() < limit)
        served = net.port.doors.back()->serve_now();
    EXPECT_TRUE(served) << "and says so";
    EXPECT_EQ(answers(), before + 1) << "the io_context has not run";
    EXPECT_FALSE(net.port.doors.back()->serve_now());
}

TEST(Server, LooksAtTheTimeByItself) {
    Net net;
    TcpClient first(net), second(net);
    first.connect();
    net.server->close();  // and opened again, with a client, before the old timer's handler has run
    const std::vector<std::string> bind{"127.0.0.1:0"};
    ASSERT_EQ(net.server->open(bind), "");
    second.connect(Net::port_of(net.server->addresses()[0]));
    net.port.time += 61s;
    const auto limit = std::chrono::steady_clock::now() + 5s;
    while (net.server->counters().closed_idle.value() == 0 && std::chrono::steady_clock::now() < limit) {
        net.io.restart();
        net.io.run_one_for(1s);
    }
    EXPECT_TRUE(second.closed());
}

TEST(Endpoint, Texts) {
    EXPECT_EQ(to_text(parse_endpoint("127.0.0.1:1502").endpoint), "127.0.0.1:1502");
    EXPECT_EQ(to_text(parse_endpoint("localhost:0").endpoint), "127.0.0.1:0");
    EXPECT_EQ(to_text(parse_endpoint("[::1]:65535").endpoint), "[::1]:65535");
    EXPECT_EQ(to_text(parse_endpoint("0.0.0.0:502").endpoint), "0.0.0.0:502");
    for (const auto* wrong : {"", "127.0.0.1", "127.0.0.1:", ":1502", "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:15x", "::1:1502",
                              "[::1:1502", "gateway.example:1502", "1502"}) {
        EXPECT_THAT(parse_endpoint(wrong).fault, testing::HasSubstr("127.0.0.1:1502")) << wrong;
    }
}

}  // namespace
}  // namespace axisgate::modbus
