// TcpLine on real loopback connections: names, refusals, time-outs, ends, full queues, order.
#include "gateway/lines/tcp_line.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/tcp.h>

#include "tests/unit/lines/fixture.hpp"

namespace axisgate {
namespace {

using namespace test;
using testing::HasSubstr;

/// A listening socket and its accepted connections.
struct Server {
    Fd listener;
    std::uint16_t port = 0;
    explicit Server(int backlog = 8, std::uint16_t wanted = 0, int receive_buffer = 0) {
        listener = Fd(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        const int yes = 1;
        (void)::setsockopt(listener.fd, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        if (receive_buffer != 0) (void)::setsockopt(listener.fd, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        a.sin_port = htons(wanted);
        EXPECT_EQ(::bind(listener.fd, reinterpret_cast<sockaddr*>(&a), sizeof a), 0);
        EXPECT_EQ(::listen(listener.fd, backlog), 0);
        socklen_t size = sizeof a;
        EXPECT_EQ(::getsockname(listener.fd, reinterpret_cast<sockaddr*>(&a), &size), 0);
        port = ntohs(a.sin_port);
    }
    [[nodiscard]] Fd take() const {
        Fd f(::accept4(listener.fd, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        return f;
    }
};

class TcpLineTest : public LineTest {
protected:
    Fd peer;
    std::unique_ptr<TcpLine> line;

    void connect(const Server& server, const std::string& host = "127.0.0.1") {
        line = std::make_unique<TcpLine>(base(), host, server.port);
        ASSERT_TRUE(comes_up(*line));
        peer = server.take();
        ASSERT_GE(peer.fd, 0);
    }
    bool send(const Frame& f, Priority p = Priority::command) { return line->send(f, p, clock.now()); }
    [[nodiscard]] LineStatus status() const { return line->status(clock.now()); }
    /// Reads at the other side until `size` bytes have arrived.
    std::string receive(std::size_t size) {
        std::string all;
        EXPECT_TRUE(until([&] {
            all += peer.read();
            return all.size() >= size;
        })) << all.size();
        return all;
    }
};

TEST_F(TcpLineTest, carriesBytesBothWays) {
    const Server server;
    connect(server);
    EXPECT_EQ(owner.states.back().second, "up, connected to 127.0.0.1:" + std::to_string(server.port));
    peer.write(every_byte());
    ASSERT_TRUE(until([&] { return owner.received().size() >= 256; }));
    EXPECT_EQ(owner.received(), every_byte());
    EXPECT_TRUE(send(text(every_byte())));
    EXPECT_TRUE(owner.sent.empty());  // never from inside send
    EXPECT_EQ(receive(256), every_byte());
    ASSERT_EQ(owner.sent.size(), 1u);
    EXPECT_EQ(as_text(owner.sent[0]), every_byte());
    const LineStatus s = status();
    EXPECT_EQ(s.bytes_in, 256u);
    EXPECT_EQ(s.bytes_out, 256u);
    EXPECT_EQ(s.frames_out, 1u);
    EXPECT_EQ(s.load, 0.0);
}

TEST_F(TcpLineTest, cutsLongRunsIntoFrames) {
    const Server server;
    connect(server);
    std::string long_text;
    for (int i = 0; i < 20'000; ++i)
        long_text += static_cast<char>('a' + i % 26);
    peer.write(long_text);
    ASSERT_TRUE(until([&] { return owner.received().size() >= long_text.size(); }));
    EXPECT_EQ(owner.received(), long_text);
    for (const Frame& f : owner.frames)
        EXPECT_LE(f.size, Frame::capacity);
    EXPECT_EQ(status().frames_in, owner.frames.size());
}

TEST_F(TcpLineTest, sendsWhatWaitsInOneGoUrgentFirst) {
    const Server server;
    connect(server);
    EXPECT_TRUE(send(text("poll "), Priority::poll));
    EXPECT_TRUE(send(text("command "), Priority::command));
    EXPECT_TRUE(send(text("stop "), Priority::urgent));
    settle();
    EXPECT_EQ(peer.read(), "stop command poll ");
    ASSERT_EQ(owner.sent.size(), 3u);
    EXPECT_EQ(as_text(owner.sent[0]), "stop ");
}

TEST_F(TcpLineTest, answersAtOnce) {
    const Server server;
    connect(server);
    int delay = -1;
    socklen_t size = sizeof delay;
    EXPECT_EQ(::getsockopt(peer.fd, IPPROTO_TCP, TCP_NODELAY, &delay, &size), 0);
    // Two small writes without an acknowledgement in between: without TCP_NODELAY the second would wait for some 40 ms.
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 20; ++i) {
        EXPECT_TRUE(send(text("a")));
        settle();
        EXPECT_TRUE(send(text("b")));
        settle();
        EXPECT_EQ(receive(2), "ab");
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, milliseconds(400));
}

TEST_F(TcpLineTest, opensAgainWhenThePeerEnds) {
    const Server server;
    connect(server);
    peer.write("last words");
    peer.close();
    ASSERT_TRUE(until([&] { return owner.states.size() == 2; }));
    EXPECT_EQ(owner.received(), "last words");
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(owner.states.back().second, HasSubstr("has closed the connection"));
    EXPECT_FALSE(send(text("nobody there")));
    ASSERT_TRUE(until([&] { return owner.up(); }));
    EXPECT_EQ(status().reopened, 1u);
    peer = server.take();
    EXPECT_TRUE(send(text("hello again")));
    EXPECT_EQ(receive(11), "hello again");
}

TEST_F(TcpLineTest, aHalfClosedConnectionIsOver) {
    const Server server;
    connect(server);
    peer.write("end");
    ASSERT_EQ(::shutdown(peer.fd, SHUT_WR), 0);  // it would still read, but can never answer again
    ASSERT_TRUE(until([&] { return owner.states.size() == 2; }));
    EXPECT_EQ(owner.received(), "end");
    EXPECT_TRUE(until([&] { return owner.up(); }));
}

TEST_F(TcpLineTest, aResetIsNoticedWhileSending) {
    const Server server;
    connect(server);
    const linger hard{1, 0};
    ASSERT_EQ(::setsockopt(peer.fd, SOL_SOCKET, SO_LINGER, &hard, sizeof hard), 0);
    peer.close();
    (void)send(text("into the void"));
    ASSERT_TRUE(until([&] { return owner.states.size() >= 2; }));
    EXPECT_FALSE(owner.states[1].first);
}

TEST_F(TcpLineTest, whatWaitedIsNotSentOverTheNextConnection) {
    const Server server;
    connect(server);
    peer.close();
    // Accepted before the loss is noticed; the drive must not get an old command.
    for (int i = 0; i < 3; ++i)
        (void)send(text("move "));
    ASSERT_TRUE(until([&] { return owner.states.size() >= 3 && owner.up(); }));
    peer = server.take();
    EXPECT_TRUE(send(text("new")));
    EXPECT_EQ(receive(3), "new");
}

TEST_F(TcpLineTest, saysThatNothingListensAndGoesOnTrying) {
    std::uint16_t port = 0;
    {
        const Server server;
        port = server.port;
    }
    line = std::make_unique<TcpLine>(base(), "127.0.0.1", port);
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_EQ(status().state, LineStatus::State::down);
    EXPECT_THAT(status().text, HasSubstr("nothing listens there"));
    run_for(milliseconds(100));
    EXPECT_EQ(owner.states.size(), 1u);  // reported once
    const Server server(8, port);
    ASSERT_TRUE(until([&] { return owner.up(); }));
    EXPECT_EQ(status().reopened, 0u);  // it came up for the first time
}

TEST_F(TcpLineTest, resolvesNames) {
    const Server server;
    connect(server, "localhost");
    EXPECT_THAT(owner.states.back().second, HasSubstr("localhost:"));
    peer.close();
    EXPECT_TRUE(until([&] { return owner.states.size() == 3 && owner.up(); }));
}

TEST_F(TcpLineTest, anUnknownNameIsSaid) {
    line = std::make_unique<TcpLine>(base(), "no-such-drive.invalid", 503, milliseconds(300));
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(status().text, HasSubstr("cannot reach no-such-drive.invalid:503: the name no-such-drive.invalid is not"));
}

TEST_F(TcpLineTest, givesUpAnAddressThatDoesNotAnswer) {
    const Server full(0);  // room for one waiting connection; further ones get no answer
    std::vector<Fd> waiting;
    for (int i = 0; i < 3; ++i) {
        waiting.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK, 0));
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        a.sin_port = htons(full.port);
        (void)::connect(waiting.back().fd, reinterpret_cast<sockaddr*>(&a), sizeof a);
    }
    line = std::make_unique<TcpLine>(base(), "127.0.0.1", full.port, milliseconds(60));
    const auto start = std::chrono::steady_clock::now();
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_GE(std::chrono::steady_clock::now() - start, milliseconds(55));
    EXPECT_THAT(status().text, HasSubstr("no answer within 60 ms"));
}

TEST_F(TcpLineTest, isBoundedTowardsAPeerThatDoesNotRead) {
    const Server server(8, 0, 2048);
    connect(server);
    const std::string block(Frame::capacity, 'x');
    int taken = 0, refused = 0;
    ASSERT_TRUE(until([&] {
        for (int i = 0; i < 32; ++i)
            (send(text(block)) ? taken : refused)++;
        settle();
        return refused >= 64;
    }));
    EXPECT_LT(taken, 2000);  // 64 KiB here, and the capacity of the two sockets
    EXPECT_GE(status().dropped, 64u);
    EXPECT_EQ(status().queued, 256u);
    EXPECT_TRUE(send(text("stop"), Priority::urgent));
    // The other side reads again at last: frames that are too old by then are dropped, and the half-sent frame is completed first.
    clock.ahead = stale_send_limit + milliseconds(1);
    EXPECT_TRUE(send(text("fresh"), Priority::urgent));
    std::string all;
    ASSERT_TRUE(until([&] {
        all += peer.read();
        return all.ends_with("fresh");
    })) << all.size();
    EXPECT_EQ((all.size() - 5) % block.size(), 0u);
    EXPECT_EQ(all.find("stop"), std::string::npos);
    EXPECT_EQ(std::ranges::count(all, 'x'), static_cast<std::ptrdiff_t>(all.size() - 5));
    EXPECT_EQ(status().queued, 0u);
}

TEST_F(TcpLineTest, losesNothingAndKeepsTheOrderAtFullSpeed) {
    const Server server(8, 0, 4096);
    connect(server);
    std::string wanted, got;
    int number = 0;
    ASSERT_TRUE(until([&] {
        while (number < 5000) {
            const std::string piece = std::to_string(number) + std::string(static_cast<std::size_t>(number % 200), '.') + "\n";
            if (!send(text(piece))) break;
            wanted += piece;
            ++number;
        }
        got += peer.read();
        return number == 5000 && got.size() >= wanted.size();
    }));
    EXPECT_EQ(got, wanted);
    EXPECT_EQ(owner.sent.size(), 5000u);
}

TEST_F(TcpLineTest, mayBeClosedOrDestroyedFromItsEvents) {
    const Server server;
    connect(server);
    owner.on_received = [&](const Frame&) { line->close(); };
    peer.write(std::string(2000, 'x'));
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    settle();
    EXPECT_EQ(owner.frames.size(), 1u);
    EXPECT_EQ(status().state, LineStatus::State::closed);
    EXPECT_EQ(status().text, "closed");
    EXPECT_FALSE(send(text("x")));

    owner.frames.clear();
    owner.states.clear();
    owner.on_received = [&](const Frame&) { line.reset(); };
    ASSERT_TRUE(comes_up(*line));
    peer = server.take();
    peer.write(std::string(2000, 'x'));
    ASSERT_TRUE(until([&] { return line == nullptr; }));
    settle();
    EXPECT_EQ(owner.frames.size(), 1u);
}

TEST_F(TcpLineTest, mayBeDestroyedAtAnyMoment) {
    const Server server;
    for (int turns = 0; turns < 12; ++turns) {  // before, while and after it connects
        auto l = std::make_unique<TcpLine>(base(), turns % 2 == 0 ? "127.0.0.1" : "localhost", server.port);
        l->open(owner, clock.now());
        for (int i = 0; i < turns; ++i)
            io.poll_one();
        l.reset();
        settle();
    }
    const auto before = owner.states.size();
    settle();
    EXPECT_EQ(owner.states.size(), before);
}

}  // namespace
}  // namespace axisgate
