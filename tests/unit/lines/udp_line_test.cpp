// UdpLine on real loopback datagrams: both roles, refused ports, sizes, order, closing from inside an event.
// In: what a socket of the test does. Out: pass or fail. Never sleeps, never leaves this machine.
#include "gateway/lines/udp_line.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>

#include "tests/unit/lines/fixture.hpp"

namespace axisgate {
namespace {

using namespace test;
using testing::HasSubstr;

/// A UDP socket of the test on the loopback.
struct Socket {
    Fd socket;
    std::uint16_t port = 0;
    explicit Socket(std::uint16_t wanted = 0) {
        socket = Fd(::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
        sockaddr_in a = at(wanted);
        EXPECT_EQ(::bind(socket.fd, reinterpret_cast<sockaddr*>(&a), sizeof a), 0);
        socklen_t size = sizeof a;
        EXPECT_EQ(::getsockname(socket.fd, reinterpret_cast<sockaddr*>(&a), &size), 0);
        port = ntohs(a.sin_port);
    }
    static sockaddr_in at(std::uint16_t port) {
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        a.sin_port = htons(port);
        return a;
    }
    void to(std::uint16_t where, std::string_view s) const {
        const sockaddr_in a = at(where);
        EXPECT_EQ(::sendto(socket.fd, s.data(), s.size(), 0, reinterpret_cast<const sockaddr*>(&a), sizeof a),
                  static_cast<ssize_t>(s.size()))
            << errno;
    }
    /// One datagram, or nothing.
    std::optional<std::string> take() {
        std::array<char, 65536> buffer{};
        sockaddr_in from{};
        socklen_t size = sizeof from;
        const ssize_t n = ::recvfrom(socket.fd, buffer.data(), buffer.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
        if (n < 0) return std::nullopt;
        speaker = ntohs(from.sin_port);
        return std::string(buffer.data(), static_cast<std::size_t>(n));
    }
    std::uint16_t speaker = 0;
};

class UdpLineTest : public LineTest {
protected:
    std::optional<Socket> drive{std::in_place};
    std::unique_ptr<UdpLine> line;

    void connect() {
        line = std::make_unique<UdpLine>(base(), "127.0.0.1", drive->port, UdpLine::Role::connects);
        ASSERT_TRUE(comes_up(*line));
    }
    void listen() {
        line = std::make_unique<UdpLine>(base(), "127.0.0.1", std::uint16_t{0}, UdpLine::Role::listens);
        ASSERT_TRUE(comes_up(*line));
        ASSERT_NE(line->port(), 0);
    }
    bool send(std::string_view s, Priority p = Priority::command) { return line->send(text(s), p, clock.now()); }
    std::string receive(Socket& s) {
        std::optional<std::string> got;
        EXPECT_TRUE(until([&] { return (got = s.take()).has_value(); }));
        return got.value_or("");
    }
    [[nodiscard]] LineStatus status() const { return line->status(clock.now()); }
};

TEST_F(UdpLineTest, eachFrameIsOneDatagram) {
    connect();
    EXPECT_EQ(owner.states.back().second, "up, UDP to 127.0.0.1:" + std::to_string(drive->port));
    EXPECT_TRUE(send("PR P\r"));
    EXPECT_TRUE(send("PR V\r"));
    EXPECT_TRUE(owner.sent.empty()) << "never from inside send";
    EXPECT_EQ(receive(*drive), "PR P\r");
    EXPECT_EQ(receive(*drive), "PR V\r");
    EXPECT_EQ(owner.sent.size(), 2u);
    drive->to(drive->speaker, every_byte());
    ASSERT_TRUE(until([&] { return owner.heard().size() >= 256; }));
    EXPECT_EQ(owner.heard(), every_byte());
    const LineStatus s = status();
    EXPECT_EQ(s.bytes_out, 10u);
    EXPECT_EQ(s.frames_out, 2u);
    EXPECT_EQ(s.bytes_in, 256u);
}

TEST_F(UdpLineTest, aLongDatagramArrivesInPiecesAndAnEmptyOneNotAtAll) {
    connect();
    EXPECT_TRUE(send("x"));
    (void)receive(*drive);
    drive->to(drive->speaker, "");
    const std::string big(1000, 'b');
    drive->to(drive->speaker, big);
    ASSERT_TRUE(until([&] { return owner.heard().size() >= big.size(); }));
    EXPECT_EQ(owner.heard(), big);
    EXPECT_EQ(owner.frames.size(), 4u);
}

TEST_F(UdpLineTest, strangersAreNotHeard) {
    connect();
    EXPECT_TRUE(send("x"));
    (void)receive(*drive);
    Socket stranger;
    stranger.to(drive->speaker, "not for you");
    drive->to(drive->speaker, "answer");
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    EXPECT_EQ(owner.heard(), "answer");
}

TEST_F(UdpLineTest, aPortWhereNobodyListensEndsTheLineUntilSomebodyDoes) {
    const std::uint16_t port = drive->port;
    connect();
    drive.reset();
    EXPECT_TRUE(send("anybody there"));
    ASSERT_TRUE(until([&] { return !owner.up(); }));
    EXPECT_THAT(owner.states.back().second, HasSubstr("nobody listens"));
    drive.emplace(port);
    ASSERT_TRUE(until([&] { return owner.up(); })) << "it opens again by itself";
    EXPECT_TRUE(send("now"));
    EXPECT_EQ(receive(*drive), "now");
    EXPECT_EQ(status().reopened, 1u);
}

TEST_F(UdpLineTest, listeningAnswersTheLastSpeaker) {
    listen();
    EXPECT_TRUE(send("nobody is there"));
    settle();
    EXPECT_EQ(status().dropped, 1u);
    EXPECT_TRUE(owner.sent.empty());
    Socket a, b;
    a.to(line->port(), "a");
    ASSERT_TRUE(until([&] { return owner.heard() == "a"; }));
    EXPECT_TRUE(send("to a"));
    EXPECT_EQ(receive(a), "to a");
    b.to(line->port(), "b");
    ASSERT_TRUE(until([&] { return owner.heard() == "ab"; }));
    EXPECT_TRUE(send("to b"));
    EXPECT_EQ(receive(b), "to b");
    EXPECT_FALSE(a.take());
}

TEST_F(UdpLineTest, urgentGoesFirst) {
    connect();
    EXPECT_TRUE(send("poll", Priority::poll));
    EXPECT_TRUE(send("command"));
    EXPECT_TRUE(send("stop", Priority::urgent));
    EXPECT_EQ(receive(*drive), "stop");
    EXPECT_EQ(receive(*drive), "command");
    EXPECT_EQ(receive(*drive), "poll");
}

TEST_F(UdpLineTest, aPortThatIsTakenIsTold) {
    line = std::make_unique<UdpLine>(base(), "127.0.0.1", drive->port, UdpLine::Role::listens);
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(owner.states.back().second, HasSubstr("cannot listen on 127.0.0.1:" + std::to_string(drive->port)));
    EXPECT_EQ(line->port(), 0);
    drive.reset();
    EXPECT_TRUE(until([&] { return owner.up(); }));
}

TEST_F(UdpLineTest, mayBeClosedFromInsideItsOwnEvents) {
    connect();
    EXPECT_TRUE(send("x"));
    (void)receive(*drive);
    owner.hears = [this](const Frame&) { line->close(); };
    drive->to(drive->speaker, "one");
    drive->to(drive->speaker, "two");
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    settle();
    EXPECT_EQ(owner.heard(), "one");
    EXPECT_EQ(status().state, LineStatus::State::closed);
    EXPECT_FALSE(send("y"));
}

}  // namespace
}  // namespace axisgate
