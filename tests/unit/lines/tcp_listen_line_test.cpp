// TcpListenLine on real loopback connections: a bus with up to four clients.
#include "gateway/lines/tcp_listen_line.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>

#include "tests/unit/lines/fixture.hpp"

namespace axisgate {
namespace {

using namespace test;
using testing::HasSubstr;

class TcpListenLineTest : public LineTest {
protected:
    std::unique_ptr<TcpListenLine> line;

    void listen(const std::string& host = "127.0.0.1", std::uint16_t port = 0) {
        line = std::make_unique<TcpListenLine>(base(), host, port);
        ASSERT_TRUE(comes_up(*line));
    }
    /// A client that the line has accepted.
    Fd client(int receive_buffer = 0) {
        const std::uint64_t before = line->counters().accepted + line->counters().turned_away;
        Fd f(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
        if (receive_buffer != 0) (void)::setsockopt(f.fd, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        a.sin_port = htons(line->port());
        EXPECT_EQ(::connect(f.fd, reinterpret_cast<sockaddr*>(&a), sizeof a), 0) << errno;
        no_wait(f.fd);
        EXPECT_TRUE(until([&] { return line->counters().accepted + line->counters().turned_away > before; }));
        return f;
    }
    bool send(const Frame& f, Priority p = Priority::command) { return line->send(f, p, clock.now()); }
    [[nodiscard]] LineStatus status() const { return line->status(clock.now()); }
    bool receives(const Fd& f, const std::string& wanted) {
        std::string all;
        const bool good = until([&] {
            all += f.read();
            return all.size() >= wanted.size();
        });
        EXPECT_EQ(all, wanted);
        return good;
    }
    [[nodiscard]] static bool ended(const Fd& f) {
        char c = 0;
        return ::recv(f.fd, &c, 1, MSG_PEEK) == 0 || (errno != EAGAIN && errno != EWOULDBLOCK);
    }
};

TEST_F(TcpListenLineTest, isUpAsSoonAsItListens) {
    listen();
    EXPECT_NE(line->port(), 0);
    EXPECT_EQ(line->address(), "127.0.0.1:" + std::to_string(line->port()));
    EXPECT_EQ(status().text, "listening on " + line->address() + ", 0 clients");
    EXPECT_TRUE(send(text("nobody hears this")));  // as on a cable
    settle();
    EXPECT_EQ(owner.sent.size(), 1u);
    const Fd a = client();
    EXPECT_EQ(status().text, "listening on " + line->address() + ", 1 client");
    EXPECT_EQ(a.read(), "");
}

TEST_F(TcpListenLineTest, everyClientHearsEverything) {
    listen();
    const Fd a = client(), b = client(), c = client();
    EXPECT_EQ(line->clients(), 3u);
    a.write("question");
    ASSERT_TRUE(until([&] { return owner.received() == "question"; }));
    EXPECT_TRUE(receives(b, "question"));  // the others receive it as well
    EXPECT_TRUE(receives(c, "question"));
    EXPECT_EQ(a.read(), "");  // but a sender does not receive its own bytes
    EXPECT_TRUE(send(text("ans")));
    EXPECT_TRUE(send(text("wer")));
    EXPECT_TRUE(send(text("stop "), Priority::urgent));
    for (const Fd* f : {&a, &b, &c})
        EXPECT_TRUE(receives(*f, "stop answer"));
    EXPECT_EQ(owner.sent.size(), 3u);
    b.write(every_byte());
    ASSERT_TRUE(until([&] { return owner.received().size() >= 8 + 256; }));
    EXPECT_EQ(owner.received().substr(8), every_byte());
}

TEST_F(TcpListenLineTest, turnsAFifthClientAway) {
    listen();
    std::vector<Fd> clients;
    for (int i = 0; i < 4; ++i)
        clients.push_back(client());
    const Fd fifth = client();
    EXPECT_TRUE(until([&] { return ended(fifth); }));
    EXPECT_EQ(line->counters().turned_away, 1u);
    EXPECT_EQ(line->counters().accepted, 4u);
    EXPECT_EQ(line->clients(), 4u);
    clients.pop_back();  // one leaves, so there is a place again
    ASSERT_TRUE(until([&] { return line->clients() == 3; }));
    const Fd next = client();
    EXPECT_EQ(line->clients(), 4u);
    EXPECT_TRUE(send(text("hi")));
    EXPECT_TRUE(receives(next, "hi"));
    EXPECT_TRUE(owner.up());
    EXPECT_EQ(owner.states.size(), 1u);
}

TEST_F(TcpListenLineTest, closesAClientThatDoesNotRead) {
    listen();
    const Fd slow = client(2048), good = client();
    const std::string block(Frame::capacity, 'x');
    std::size_t sent = 0, read = 0;
    ASSERT_TRUE(until([&] {
        for (int i = 0; i < 16; ++i)
            sent += send(text(block)) ? block.size() : 0;
        settle();
        read += good.read().size();
        return line->counters().slow_closed == 1;
    }));
    EXPECT_EQ(line->clients(), 1u);
    EXPECT_EQ(status().errors, 1u);
    EXPECT_LT(sent, 4u * 1024 * 1024);
    EXPECT_TRUE(until([&] { return (read += good.read().size()) == sent; })) << read << " of " << sent;
    EXPECT_TRUE(send(text("goes on")));
    EXPECT_TRUE(receives(good, "goes on"));
}

TEST_F(TcpListenLineTest, aClientThatTalksIntoASlowOneIsNotHeldUp) {
    listen();
    const Fd slow = client(2048), talker = client();
    std::size_t wrote = 0;
    const std::string block(4096, 'y');
    ASSERT_TRUE(until([&] {
        const ssize_t n = ::write(talker.fd, block.data(), block.size());
        if (n > 0) wrote += static_cast<std::size_t>(n);
        settle();
        return line->counters().slow_closed == 1;
    }));
    EXPECT_TRUE(until([&] { return owner.received().size() == wrote; }));
    EXPECT_EQ(line->clients(), 1u);
}

TEST_F(TcpListenLineTest, survivesClientsThatGoAsTheyLike) {
    listen();
    for (int i = 0; i < 30; ++i) {
        Fd f = client();
        if (i % 3 == 0) {
            const linger hard{1, 0};
            (void)::setsockopt(f.fd, SOL_SOCKET, SO_LINGER, &hard, sizeof hard);
        }
        if (i % 2 == 0) f.write("x");
        (void)send(text("to whoever is there"));
        f.close();
        if (i % 5 == 0) settle();
    }
    EXPECT_TRUE(until([&] { return line->clients() == 0; }));
    EXPECT_GE(owner.received().size(), 10u);  // of 15; a reset drops the unread ones
    EXPECT_LE(owner.received().size(), 15u);
    EXPECT_TRUE(owner.up());
}

TEST_F(TcpListenLineTest, saysThatThePortIsTakenAndWaitsForIt) {
    listen();
    const std::uint16_t port = line->port();
    TcpListenLine second(base(), "127.0.0.1", port);
    Owner other;
    second.open(other, clock.now());
    ASSERT_TRUE(until([&] { return !other.states.empty(); }));
    EXPECT_FALSE(other.up());
    EXPECT_THAT(second.status(clock.now()).text, HasSubstr("another program has this port"));
    EXPECT_EQ(second.address(), "");
    line->close();
    EXPECT_EQ(line->address(), "");
    ASSERT_TRUE(until([&] { return other.up(); }));
    EXPECT_EQ(second.port(), port);
}

TEST_F(TcpListenLineTest, knowsOtherFormsOfAnAddress) {
    listen("localhost");
    EXPECT_THAT(line->address(), HasSubstr("127.0.0.1:"));
    owner.states.clear();
    const struct {
        const char* host;
        const char* says;
    } rows[] = {{"not-an-address", "127.0.0.1 or 0.0.0.0"}, {"203.0.113.9", "does not have that address"}};
    for (const auto& r : rows) {
        TcpListenLine l(base(), r.host, 0);
        Owner o;
        l.open(o, clock.now());
        ASSERT_TRUE(until([&] { return !o.states.empty(); }));
        EXPECT_FALSE(o.up());
        EXPECT_THAT(o.states[0].second, HasSubstr(r.says));
    }
}

TEST_F(TcpListenLineTest, mayBeClosedOrDestroyedFromItsEvents) {
    listen();
    Fd a = client(), b = client();
    owner.on_received = [&](const Frame&) { line->close(); };
    a.write(std::string(1000, 'x'));
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    settle();
    EXPECT_EQ(owner.frames.size(), 1u);
    EXPECT_TRUE(ended(a));

    owner.frames.clear();
    owner.states.clear();
    owner.on_received = [&](const Frame&) { line.reset(); };
    ASSERT_TRUE(comes_up(*line));
    a = client();
    b = client();
    b.write(std::string(1000, 'x'));
    ASSERT_TRUE(until([&] { return line == nullptr; }));
    settle();
    EXPECT_EQ(owner.frames.size(), 1u);
}

}  // namespace
}  // namespace axisgate
