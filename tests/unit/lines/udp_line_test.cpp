// UdpLine on real loopback datagrams: both roles, refused ports, sizes, order, closing from inside an event.
#include "gateway/lines/udp_line.hpp"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netdb.h>

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
    /// One datagram, or empty.
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

    void connect(const std::string& host = "127.0.0.1") {
        line = std::make_unique<UdpLine>(base(), host, drive->port, UdpLine::Role::connects);
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
    EXPECT_TRUE(send(every_byte()));
    EXPECT_EQ(receive(*drive), every_byte());
    drive->to(drive->speaker, every_byte());
    ASSERT_TRUE(until([&] { return owner.received().size() >= 256; }));
    EXPECT_EQ(owner.received(), every_byte());
    EXPECT_EQ(owner.frames.size(), 1u);
    const LineStatus s = status();
    EXPECT_EQ(s.bytes_out, 266u);
    EXPECT_EQ(s.frames_out, 3u);
    EXPECT_EQ(s.frames_in, 1u);
    EXPECT_EQ(s.bytes_in, 256u);
    EXPECT_EQ(s.load, 0.0);
}

TEST_F(UdpLineTest, moreThanOneTurnsWorthIsCarriedInOrder) {
    connect();
    constexpr int many = 3 * UdpLine::datagrams_per_turn + 1;
    std::string wanted;
    for (int i = 0; i < many; ++i) {
        wanted += std::to_string(i) + "\n";
        EXPECT_TRUE(send(std::to_string(i) + "\n"));
    }
    std::string got;
    for (int i = 0; i < many; ++i)
        got += receive(*drive);
    EXPECT_EQ(got, wanted);
    EXPECT_EQ(owner.sent.size(), static_cast<std::size_t>(many));
    for (int i = 0; i < many; ++i)
        drive->to(drive->speaker, std::to_string(i) + "\n");
    ASSERT_TRUE(until([&] { return owner.frames.size() >= static_cast<std::size_t>(many); }));
    EXPECT_EQ(owner.received(), wanted);
}

TEST_F(UdpLineTest, sizesRoundAFramesCapacity) {
    connect();
    EXPECT_TRUE(send("x"));
    (void)receive(*drive);
    const struct {
        std::size_t size;
        std::size_t frames;
    } rows[] = {{1, 1}, {255, 1}, {256, 1}, {257, 2}, {512, 2}, {60'000, 235}};
    for (const auto& r : rows) {
        owner.frames.clear();
        std::string datagram;
        for (std::size_t i = 0; i < r.size; ++i)
            datagram += static_cast<char>('a' + i % 26);
        drive->to(drive->speaker, datagram);
        ASSERT_TRUE(until([&] { return owner.received().size() >= r.size; })) << r.size;
        EXPECT_EQ(owner.received(), datagram);
        EXPECT_EQ(owner.frames.size(), r.frames) << r.size;
    }
}

TEST_F(UdpLineTest, aLongDatagramArrivesInPiecesAndAnEmptyOneNotAtAll) {
    connect();
    EXPECT_TRUE(send("x"));
    (void)receive(*drive);
    drive->to(drive->speaker, "");
    const std::string big(1000, 'b');
    drive->to(drive->speaker, big);
    ASSERT_TRUE(until([&] { return owner.received().size() >= big.size(); }));
    EXPECT_EQ(owner.received(), big);
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
    EXPECT_EQ(owner.received(), "answer");
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

TEST_F(UdpLineTest, aRefusalIsSaidTheSameWhereverItIsNoticed) {
    const std::uint16_t port = drive->port;
    connect();
    drive.reset();
    for (const char* s : {"one ", "two ", "three "})  // the answer to the first comes back when the second is sent
        EXPECT_TRUE(send(s));
    ASSERT_TRUE(until([&] { return !owner.up(); }));
    EXPECT_THAT(owner.states.back().second, HasSubstr("nobody listens at 127.0.0.1:" + std::to_string(port)));
    EXPECT_FALSE(send("nobody there"));
    drive.emplace(port);
    ASSERT_TRUE(until([&] { return owner.up(); }));
    EXPECT_TRUE(send("new"));
    EXPECT_EQ(receive(*drive), "new") << "the drive does not get a command from another time";
}

TEST_F(UdpLineTest, resolvesNames) {
    connect("localhost");
    EXPECT_THAT(owner.states.back().second, HasSubstr("localhost:"));
    // The name may have ::1 first, where nothing listens: then the line goes down, and uses the other address.
    ASSERT_TRUE(until([&] {
        (void)send("x");
        return drive->take().has_value();
    }));
    drive->to(drive->speaker, "answer");
    EXPECT_TRUE(until([&] { return owner.received() == "answer"; }));
}

TEST_F(UdpLineTest, anUnknownNameIsSaid) {
    const std::string never_a_name(64, 'a');  // longer than a label may be, so that no name server is asked
    line = std::make_unique<UdpLine>(base(), never_a_name, std::uint16_t{503}, UdpLine::Role::connects);
    line->open(owner, clock.now());
    ASSERT_TRUE(until([&] { return !owner.states.empty(); }));
    EXPECT_FALSE(owner.up());
    EXPECT_THAT(status().text, HasSubstr("cannot reach " + never_a_name + ":503: the name " + never_a_name + " is not known"));
}

TEST_F(UdpLineTest, hearsAfterBeingOpenedAgainWhileItsNameIsLookedUp) {
    for (int turns = 0; turns < 20; ++turns) {
        line.reset();
        settle();
        owner.states.clear();
        line = std::make_unique<UdpLine>(base(), "localhost", drive->port, UdpLine::Role::connects);
        line->open(owner, clock.now());
        if (io.stopped()) io.restart();
        io.poll_one();                     // it asks for the name
        for (int i = 0; i < turns; ++i) {  // as long as the unwanted answer takes
            addrinfo* found = nullptr;
            (void)::getaddrinfo("localhost", "1", nullptr, &found);
            if (found != nullptr) ::freeaddrinfo(found);
        }
        line->close();
        line->open(owner, clock.now());
        ASSERT_TRUE(until([&] {
            (void)send("x");
            return drive->take().has_value();
        })) << turns;
        settle();
        while (drive->take()) {
        }
        owner.frames.clear();
        drive->to(line->port(), "answer");
        ASSERT_TRUE(until([&] { return owner.received() == "answer"; })) << turns;
    }
}

TEST_F(UdpLineTest, mayBeDestroyedAtAnyMoment) {
    for (int turns = 0; turns < 12; ++turns) {
        auto l = std::make_unique<UdpLine>(base(), turns % 2 == 0 ? "127.0.0.1" : "localhost", drive->port,
                                           turns % 3 == 0 ? UdpLine::Role::listens : UdpLine::Role::connects);
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

TEST_F(UdpLineTest, listeningAnswersTheLastSpeaker) {
    listen();
    EXPECT_TRUE(send("nobody is there"));
    settle();
    EXPECT_EQ(status().dropped, 1u);
    EXPECT_TRUE(owner.sent.empty());
    Socket a, b;
    a.to(line->port(), "a");
    ASSERT_TRUE(until([&] { return owner.received() == "a"; }));
    EXPECT_TRUE(send("to a"));
    EXPECT_EQ(receive(a), "to a");
    b.to(line->port(), "b");
    ASSERT_TRUE(until([&] { return owner.received() == "ab"; }));
    EXPECT_TRUE(send("to b"));
    EXPECT_EQ(receive(b), "to b");
    EXPECT_FALSE(a.take());
    a.to(line->port(), "");  // an empty datagram also counts
    ASSERT_TRUE(until([&] {
        (void)send("back to a");
        settle();
        while (b.take()) {
        }
        return a.take() == "back to a";
    }));
    EXPECT_EQ(owner.received(), "ab");
    EXPECT_TRUE(owner.up());
    EXPECT_EQ(owner.states.size(), 1u);
}

TEST_F(UdpLineTest, listeningOutlivesASpeakerThatIsGone) {
    listen();
    {
        Socket gone;
        gone.to(line->port(), "a");
        ASSERT_TRUE(until([&] { return owner.received() == "a"; }));
    }
    for (int i = 0; i < 3; ++i) {
        EXPECT_TRUE(send("nobody is there any more"));
        settle();
    }
    EXPECT_TRUE(owner.up());
    EXPECT_EQ(owner.states.size(), 1u);
    Socket b;
    b.to(line->port(), "b");
    ASSERT_TRUE(until([&] { return owner.received() == "ab"; }));
    EXPECT_TRUE(send("to b"));
    EXPECT_EQ(receive(b), "to b");
}

TEST_F(UdpLineTest, whoSpokeBeforeItWasClosedIsForgotten) {
    listen();
    Socket a;
    a.to(line->port(), "a");
    ASSERT_TRUE(until([&] { return owner.received() == "a"; }));
    line->close();
    owner.states.clear();
    ASSERT_TRUE(comes_up(*line));
    EXPECT_TRUE(send("not for a"));
    settle();
    EXPECT_FALSE(a.take());
    EXPECT_EQ(status().dropped, 1u);
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
    owner.on_received = [this](const Frame&) { line->close(); };
    drive->to(drive->speaker, "one");
    drive->to(drive->speaker, "two");
    ASSERT_TRUE(until([&] { return !owner.frames.empty(); }));
    settle();
    EXPECT_EQ(owner.received(), "one");
    EXPECT_EQ(status().state, LineStatus::State::closed);
    EXPECT_FALSE(send("y"));
}

TEST_F(UdpLineTest, mayBeDestroyedFromInsideItsOwnEvents) {
    connect();
    EXPECT_TRUE(send("x"));
    (void)receive(*drive);
    owner.on_received = [this](const Frame&) { line.reset(); };
    drive->to(drive->speaker, std::string(1000, 'b'));  // four frames, of which only the first arrives
    ASSERT_TRUE(until([&] { return line == nullptr; }));
    settle();
    EXPECT_EQ(owner.frames.size(), 1u);

    owner.changes = [this](bool up) {
        if (up) line->close();
    };
    line = std::make_unique<UdpLine>(base(), "127.0.0.1", drive->port, UdpLine::Role::connects);
    owner.states.clear();
    ASSERT_TRUE(comes_up(*line));
    settle();
    EXPECT_EQ(status().state, LineStatus::State::closed);
}

}  // namespace
}  // namespace axisgate
