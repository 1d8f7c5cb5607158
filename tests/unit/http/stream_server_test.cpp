// The live feed on real sockets, checked by Beast's own WebSocket client, and by raw bytes for cases that this client does not produce.
#include "tests/unit/http/socket_harness.hpp"

namespace axisgate::http::test {
namespace {
using std::chrono::milliseconds;

class StreamServer : public ::testing::Test {
protected:
    Door door;
    void open() {
        gateway_picture("slide", 7);
        door.open();
    }
    void gateway_picture(const std::string& name, std::int64_t position) { door.gateway.set_picture(name, standing(position)); }
};

TEST_F(StreamServer, SnapshotChangesAndEvents) {
    open();
    StreamJudge judge(door.port);
    ASSERT_FALSE(judge.opened) << judge.opened.message();
    ASSERT_FALSE(judge.say(R"({"subscribe":["axes/slide","events"],"period_ms":10})"));
    auto m = judge.next_message();
    EXPECT_EQ(m.at("topic"), "axes/slide");
    EXPECT_EQ(m.at("data").at("position").to_number<int>(), 7);
    EXPECT_EQ(m.at("at").to_number<std::int64_t>(), 1'767'323'045'678'901'234) << "nanoseconds, not rounded";
    door.on([&] { gateway_picture("slide", 8); });
    EXPECT_EQ(judge.next_message().at("data").at("position").to_number<int>(), 8);
    door.on([&] { door.gateway.tell(event("hello", "slide", Severity::warning)); });
    m = judge.next_message();
    EXPECT_EQ(m.at("topic"), "events");
    EXPECT_EQ(m.at("data").at("text"), "hello");
    ASSERT_FALSE(judge.say("no json"));
    EXPECT_EQ(judge.next_message().at("topic"), "error");
    EXPECT_FALSE(judge.close()) << "the closing handshake is complete";
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 0; }));
    EXPECT_EQ(door.on([&] { return door.server().counters().stream_clients; }), 0u);
}

TEST_F(StreamServer, ManyMessagesAtOnceArriveWhole) {
    open();
    StreamJudge judge(door.port);
    ASSERT_FALSE(judge.say(R"({"subscribe":["events"]})"));
    // The answer to the second request shows that the first is in force.
    ASSERT_FALSE(judge.say(R"({"subscribe":["site"]})"));
    EXPECT_EQ(judge.next_message().at("topic"), "site");
    door.on([&] {
        for (int i = 0; i < 500; ++i)
            door.gateway.tell(event(std::string(static_cast<std::size_t>(i) * 10, 'e')));
    });
    for (int i = 0; i < 500; ++i) {
        const auto m = judge.next_message();
        ASSERT_FALSE(judge.ended) << i << ": " << judge.ended.message();
        ASSERT_EQ(m.at("data").at("text").get_string().size(), static_cast<std::size_t>(i) * 10);
        ASSERT_EQ(m.at("data").at("id").to_number<int>(), i + 1) << "in order, without gaps";
    }
}

TEST_F(StreamServer, FragmentedRequests) {
    open();
    StreamJudge judge(door.port);
    judge.stream().auto_fragment(true);
    judge.stream().write_buffer_bytes(8);
    ASSERT_FALSE(judge.say(R"({"subscribe":["axes/slide"],"period_ms":10})"));
    EXPECT_EQ(judge.next_message().at("topic"), "axes/slide");
}

TEST_F(StreamServer, BytesThatComeWithTheHandshake) {
    open();
    Client c(door.port);
    // A masked text frame {"subscribe":["site"]} with the mask 0, in the same segment as the request.
    const std::string body = R"({"subscribe":["site"]})";
    std::string frame("\x81");
    frame += static_cast<char>(0x80 | body.size());
    frame += std::string(4, '\0') + body;
    c.send(
        "GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: "
        "13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n" +
        frame);
    EXPECT_EQ(c.receive().status(), 101u);
    ASSERT_TRUE(door.until([&] { return door.server().counters().stream_frames_sent == 1; }));
    bool stopped = false;
    door.on([&] { door.server().stop([&stopped] { stopped = true; }); });
    c.shutdown_send();
    EXPECT_NE(c.rest().find("\"topic\":\"site\""), std::string::npos);
    EXPECT_TRUE(door.until([&] { return stopped; }));
}

TEST_F(StreamServer, PingsBothWays) {
    door.settings.ping_period = milliseconds(20);
    open();
    StreamJudge judge(door.port);
    ASSERT_FALSE(judge.ping());
    ASSERT_FALSE(judge.say(R"({"subscribe":["events"]})"));
    ASSERT_FALSE(judge.say(R"({"subscribe":["axes/slide"],"period_ms":10})"));
    EXPECT_EQ(judge.next_message().at("topic"), "axes/slide");
    EXPECT_EQ(judge.pongs, 1) << "answered before what was asked later";
    for (int i = 0; i < 200 && judge.pings < 3; ++i) {
        door.on([&] { gateway_picture("slide", 100 + i); });
        judge.next_message();
        ASSERT_FALSE(judge.ended);
    }
    EXPECT_GE(judge.pings, 3) << "a client that says much is asked too";
}

TEST_F(StreamServer, AClientThatIsSilentIsClosed) {
    door.settings.ping_period = milliseconds(20);
    door.settings.silence_limit = milliseconds(100);
    door.settings.linger_limit = milliseconds(100);
    open();
    Client c(door.port);
    c.send(
        "GET /api/v1/stream HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Version: "
        "13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 101u);
    const std::string all = c.rest();  // it answers no ping
    EXPECT_EQ(all.substr(0, 2), std::string("\x89\x00", 2)) << "it was asked";
    EXPECT_NE(all.find(std::string("\x88\x11\x03\xf0no sign of life", 19)), std::string::npos) << "and told: 1008";
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 0; }));
}

TEST_F(StreamServer, ClosesThatClientsBegin) {
    open();
    for (const std::uint16_t code : {std::uint16_t{1000}, std::uint16_t{1001}, std::uint16_t{4000}}) {
        StreamJudge judge(door.port);
        EXPECT_FALSE(judge.close(code));
    }
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 0; }));
    EXPECT_EQ(door.on([&] { return door.server().counters().stream_closed; }),
              (std::map<std::uint16_t, std::uint64_t>{{1000, 1}, {1001, 1}, {4000, 1}}));
}

TEST_F(StreamServer, FaultsAreClosedWithTheirCode) {
    open();
    struct Row {
        const char* what;
        std::string bytes;
        std::uint16_t code;
    };
    const std::string mask(4, '\0');
    for (const auto& [what, bytes, code] : std::vector<Row>{
             {"invalid UTF-8", std::string("\x81\x82", 2) + mask + "a\xFF", 1007},
             {"binary", std::string("\x82\x81", 2) + mask + "a", 1003},
             {"not masked", std::string("\x81\x01x", 3), 1002},
             {"too long", std::string("\x81\xff\x00\x00\x00\x00\x00\x01\x00\x01", 10) + mask, 1009},
             {"three times nonsense",
              std::string("\x81\x81", 2) + mask + "x" + std::string("\x81\x81", 2) + mask + "y" + std::string("\x81\x81", 2) + mask + "z",
              1003}}) {
        StreamJudge judge(door.port);
        judge.raw(bytes);
        for (int i = 0; i < 5 && !judge.ended; ++i)
            judge.next_message();
        EXPECT_EQ(judge.ended, beast::websocket::error::closed) << what << ": " << judge.ended.message();
        EXPECT_EQ(judge.close_code(), code) << what;
        EXPECT_FALSE(judge.close_reason().empty()) << what;
    }
    StreamJudge good(door.port);
    ASSERT_FALSE(good.say(R"({"subscribe":["site"]})"));
    EXPECT_EQ(good.next_message().at("topic"), "site") << "nobody else is touched";
}

TEST_F(StreamServer, OriginsOfOtherHosts) {
    open();
    EXPECT_FALSE(StreamJudge(door.port, "http://127.0.0.1:" + std::to_string(door.port)).opened);
    const StreamJudge evil(door.port, "http://evil.example");
    EXPECT_TRUE(evil.opened);
    EXPECT_EQ(evil.handshake_status, 403u);
}

TEST_F(StreamServer, AClientThatDoesNotReadItsEvents) {
    door.settings.max_events_waiting = 20;
    door.settings.linger_limit = patience;
    open();
    StreamJudge slow(door.port, {}, 4096), fast(door.port);
    for (auto* j : {&slow, &fast}) {
        ASSERT_FALSE(j->say(R"({"subscribe":["events"]})"));
        ASSERT_FALSE(j->say(R"({"subscribe":["site"]})"));
        ASSERT_EQ(j->next_message().at("topic"), "site");
    }
    const std::string big(20'000, 'e');
    int published = 0;
    for (; published < 2000; ++published) {
        const bool closed = door.on([&] {
            door.gateway.tell(event(big));
            const auto& by_code = door.server().counters().stream_closed;
            return by_code.contains(1013);
        });
        EXPECT_EQ(fast.next_message().at("data").at("id").to_number<int>(), published + 1) << "the fast one gets every one";
        if (closed) break;
    }
    ASSERT_LT(published, 2000) << "the slow one was never closed";
    EXPECT_GT(published, 20);
    // When it reads at last, it gets the messages on their way, and then the reason.
    int seen = 0;
    while (true) {
        const auto m = slow.next_message();
        if (slow.ended) break;
        EXPECT_EQ(m.at("data").at("id").to_number<int>(), ++seen) << "no hole before the end";
    }
    EXPECT_EQ(slow.ended, beast::websocket::error::closed) << slow.ended.message();
    EXPECT_EQ(slow.close_code(), 1013);
    EXPECT_NE(slow.close_reason().find("events"), std::string::npos) << slow.close_reason();
}

TEST_F(StreamServer, AClientThatNeverReadsIsCut) {
    door.settings.write_limit = milliseconds(100);
    door.settings.ping_period = milliseconds(50);
    open();
    StreamJudge judge(door.port, {}, 4096);
    ASSERT_FALSE(judge.say(R"({"subscribe":["events"]})"));
    ASSERT_TRUE(door.until([&] {
        door.gateway.tell(event(std::string(20'000, 'e')));
        return door.server().counters().connections == 0;
    }));
    EXPECT_GE(door.on([&] { return door.server().counters().connections_timed_out; }), 1u);
}

TEST_F(StreamServer, AClientThatDidNotReadForLongIsToldWhyWhenItGoesOn) {
    door.settings.write_limit = milliseconds(6000);
    open();
    StreamJudge judge(door.port, {}, 4096);
    ASSERT_FALSE(judge.say(R"({"subscribe":["events"]})"));
    // More than all buffers in between hold, and far fewer events than the bound.
    for (int i = 0; i < 800; ++i)
        door.on([&] { door.gateway.tell(event(std::string(20'000, 'e'))); });
    EXPECT_TRUE(door.until([&] { return door.server().counters().stream_closed.contains(1013); }));
    while (!judge.ended)
        (void)judge.next_message();
    EXPECT_EQ(judge.ended, beast::websocket::error::closed) << judge.ended.message();
    EXPECT_EQ(judge.close_code(), 1013);
    EXPECT_NE(judge.close_reason().find("not read"), std::string::npos) << judge.close_reason();
}

TEST_F(StreamServer, ABrokenConnectionLeavesNothing) {
    open();
    {
        StreamJudge judge(door.port);
        ASSERT_FALSE(judge.say(R"({"subscribe":["axes/*","events"],"period_ms":10})"));
        judge.next_message();
        judge.stream().next_layer().set_option(asio::socket_base::linger(true, 0));  // a reset, not a close
        judge.stream().next_layer().close();
    }
    EXPECT_TRUE(door.until([&] { return door.server().counters().stream_clients == 0; }));
    door.on([&] { door.gateway.tell(event("x")); });
}

TEST_F(StreamServer, ManyClientsShareOneFeed) {
    open();
    std::vector<std::unique_ptr<StreamJudge>> judges;
    for (int i = 0; i < 50; ++i) {
        judges.push_back(std::make_unique<StreamJudge>(door.port));
        ASSERT_FALSE(judges.back()->say(R"({"subscribe":["axes/slide"],"period_ms":10})"));
        EXPECT_EQ(judges.back()->next_message().at("data").at("position").to_number<int>(), 7);
    }
    EXPECT_EQ(door.on([&] { return door.server().counters().stream_clients; }), 50u);
    door.on([&] { gateway_picture("slide", 99); });
    for (auto& j : judges)
        EXPECT_EQ(j->next_message().at("data").at("position").to_number<int>(), 99);
}

TEST_F(StreamServer, TheEndIsToldWithAReason) {
    open();
    StreamJudge judge(door.port);
    ASSERT_FALSE(judge.say(R"({"subscribe":["site"]})"));
    judge.next_message();
    bool stopped = false;
    door.on([&] { door.server().stop([&stopped] { stopped = true; }); });
    judge.next_message();
    EXPECT_EQ(judge.ended, beast::websocket::error::closed);
    EXPECT_EQ(judge.close_code(), 1001);
    EXPECT_EQ(judge.close_reason(), "the gateway stops");
    EXPECT_TRUE(door.until([&] { return stopped; }));
}

TEST_F(StreamServer, WithoutAHandshakeItIsAProblem) {
    open();
    Client c(door.port);
    const auto a = c.get("/api/v1/stream");
    EXPECT_EQ(a.status(), 426u);
    EXPECT_EQ(a.message[beast::http::field::upgrade], "websocket");
    EXPECT_EQ(c.get("/healthz").status(), 200u);
}
}  // namespace
}  // namespace axisgate::http::test
