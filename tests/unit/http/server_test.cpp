// The door on real sockets: keep-alive, pipelining, bounds, slow and broken clients, many connections, the end.
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <set>
#include <sstream>

#include "gateway/doors/http/connection.hpp"
#include "tests/unit/http/socket_harness.hpp"

namespace axisgate::http::test {
namespace {
using std::chrono::milliseconds;

class HttpServer : public ::testing::Test {
protected:
    Door door;
};

TEST_F(HttpServer, KeepsConnectionsAlive) {
    door.open();
    Client c(door.port);
    for (int i = 0; i < 5; ++i) {
        const auto a = c.get("/api/v1/about");
        EXPECT_EQ(a.status(), 200u);
        EXPECT_TRUE(a.message.keep_alive());
        EXPECT_EQ(a.message[beast::http::field::server], "axisgate");
        EXPECT_FALSE(a.message[beast::http::field::date].empty());
    }
    EXPECT_EQ(door.on([&] { return door.server().counters().connections_accepted; }), 1u);
    c.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n");
    EXPECT_FALSE(c.receive().message.keep_alive());
    EXPECT_TRUE(c.closed());
}

TEST_F(HttpServer, Http10) {
    door.open();
    Client c(door.port);
    c.send("GET /healthz HTTP/1.0\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 200u);
    EXPECT_TRUE(c.closed());
}

TEST_F(HttpServer, PipelinedAnswersKeepTheirOrder) {
    door.open();
    Client c(door.port);
    std::string all = Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"enable"})");
    for (int i = 0; i < 20; ++i)
        all += "GET /api/v1/axes/n" + std::to_string(i) + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
    ASSERT_TRUE(c.send(all));
    ASSERT_TRUE(door.until([&] { return door.gateway.waiting.size() == 1; }));
    door.on([&] { door.gateway.finish(good_result()); });
    EXPECT_EQ(c.receive().json().at("result"), "accepted") << "the one that took long comes first all the same";
    for (int i = 0; i < 20; ++i)
        EXPECT_EQ(c.receive().json().at("detail"), boost::json::value("there is no axis n" + std::to_string(i)));
}

TEST_F(HttpServer, RequestsInSinglePieces) {
    door.open();
    door.on([&] { door.gateway.at_once = [](const Command&) { return good_result(); }; });
    Client c(door.port);
    for (const char byte : Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"halt"})"))
        ASSERT_TRUE(c.send(std::string_view(&byte, 1)));
    EXPECT_EQ(c.receive().status(), 200u);
    c.send(
        "PUT /api/v1/axes/feeder/parameters/AC HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: "
        "chunked\r\n\r\n"
        "5\r\n{\"val\r\n8\r\nue\": 25}\r\n0\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 200u);
    EXPECT_EQ(door.on([&] { return std::get<WriteParameter>(door.gateway.submitted.back().body).value; }), Value{std::int64_t{25}});
}

TEST_F(HttpServer, ACommandThatCameWholeIsGivenWhereItIsRead) {
    door.open();
    Client c(door.port);
    ASSERT_EQ(c.get("/healthz").status(), 200u);
    std::promise<std::size_t> given;
    door.on([&] {
        ASSERT_TRUE(c.send(Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"enable"})")));
        // The order behind this is: a poll of the sockets, the first of these two, the ready sockets, and the second.
        asio::post(door.context(), [&] { asio::post(door.context(), [&] { given.set_value(door.gateway.waiting.size()); }); });
    });
    EXPECT_EQ(given.get_future().get(), 1u) << "a command waited for what became ready after it";
}

TEST_F(HttpServer, ABodyInTwoPiecesIsWhole) {
    door.open();
    door.on([&] { door.gateway.at_once = [](const Command&) { return good_result(); }; });
    Client c(door.port);
    const std::string text = Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"halt"})");
    for (std::size_t cut = text.find("\r\n\r\n") + 3; cut < text.size(); ++cut) {
        const auto before = door.on([&] { return door.server().counters().bytes_in; });
        ASSERT_TRUE(c.send(text.substr(0, cut)));
        ASSERT_TRUE(door.until([&] { return door.server().counters().bytes_in > before || cut < text.find("\r\n\r\n") + 4; }));
        ASSERT_TRUE(c.send(text.substr(cut)));
        ASSERT_EQ(c.receive().status(), 200u) << cut;
        EXPECT_EQ(door.on([&] { return door.server().counters().bytes_in; }) - before, text.size()) << cut;
    }
}

TEST_F(HttpServer, HeadAndStatusesWithoutABody) {
    door.open();
    Client c(door.port);
    c.send("HEAD /api/v1/axes HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const auto head = c.receive(true);
    EXPECT_EQ(head.status(), 200u);
    EXPECT_GT(std::stoi(std::string(head.message[beast::http::field::content_length])), 100);
    const auto page = c.get("/");
    const std::string tag(page.message[beast::http::field::etag]);
    EXPECT_EQ(c.get("/", "If-None-Match: " + tag + "\r\n").status(), 304u);
    c.send("DELETE /api/v1/drives/bare HTTP/1.1\r\nHost: localhost\r\n\r\n");
    const auto gone = c.receive();
    EXPECT_EQ(gone.status(), 204u);
    EXPECT_TRUE(gone.message[beast::http::field::content_length].empty());
    c.send("OPTIONS * HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 204u);
    EXPECT_EQ(c.get("/healthz").status(), 200u) << "the connection is still in step";
}

TEST_F(HttpServer, Bounds) {
    door.open();
    {
        Client c(door.port);
        c.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\nX: " + std::string(9000, 'x') + "\r\n\r\n");
        EXPECT_EQ(c.receive().status(), 431u);
        EXPECT_TRUE(c.closed());
    }
    {
        Client c(door.port);
        c.send("GET /" + std::string(9000, 'x') + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
        const auto a = c.receive();
        EXPECT_EQ(a.status(), 431u);
        EXPECT_EQ(a.json().at("reason"), "headers_too_large");
    }
    {
        Client c(door.port);
        std::string many = "GET /healthz HTTP/1.1\r\nHost: localhost\r\n";
        for (int i = 0; i < 1000; ++i)
            many += "A: b\r\n";
        c.send(many + "\r\n");
        EXPECT_EQ(c.receive().status(), 200u) << "6 KiB of small headers are within the bound";
    }
    {
        Client c(door.port);
        c.send("PUT /api/v1/site HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 1048577\r\n\r\n{");
        const auto a = c.receive();
        EXPECT_EQ(a.status(), 413u) << "before the body came";
        EXPECT_EQ(a.message[beast::http::field::content_type], "application/problem+json");
        EXPECT_TRUE(c.closed());
    }
    {
        Client c(door.port);
        c.send("PUT /api/v1/site HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\n");
        const std::string chunk = "10000\r\n" + std::string(65536, ' ') + "\r\n";
        for (int i = 0; i < 17 && c.send(chunk); ++i) {
        }
        EXPECT_EQ(c.receive().status(), 413u) << "chunks are counted";
    }
    {
        Client c(door.port);
        EXPECT_EQ(c.post("/api/v1/moves/start", R"({"axes":[]})" + std::string(1048576 - 11, ' ')).status(), 422u)
            << "exactly the bound is read";
    }
}

TEST_F(HttpServer, WhatIsNotHttp) {
    door.open();
    struct Row {
        const char* what;
        std::string bytes;
        unsigned status;
    };
    for (const auto& [what, bytes, status] : std::vector<Row>{
             {"garbage", "\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03\r\n\r\n", 400},
             {"version", "GET / HTTP/2.0\r\nHost: a\r\n\r\n", 505},
             {"no version", "GET /\r\n\r\n", 400},
             {"preface of HTTP/2", "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", 505},
             {"space in a name", "GET / HTTP/1.1\r\nHo st: a\r\n\r\n", 400},
             {"two lengths", "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1\r\nContent-Length: 2\r\n\r\n{}",
              400},
             {"length and chunks",
              "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
              400},
             {"negative length", "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: -1\r\n\r\n", 400},
             {"length that is none", "POST / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1x\r\n\r\n", 400},
             {"bad chunk",
              "PUT /api/v1/site HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
              400},
             {"NUL in a header", std::string("GET / HTTP/1.1\r\nHost: a\0b\r\n\r\n", 30), 400},
             {"another coding", "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: gzip\r\n\r\n", 501},
             {"a coding and a length",
              "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: identity\r\nContent-Length: 4\r\n\r\nGET ", 400},
             {"a length and a coding",
              "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4\r\nTransfer-Encoding: xchunked\r\n\r\nGET ", 400},
             {"two codings",
              "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\nTransfer-Encoding: "
              "identity\r\n\r\n0\r\n\r\n",
              400},
             {"a space before the colon",
              "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding : chunked\r\n\r\n0\r\n\r\n", 400},
             {"a line that goes on",
              "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nTransfer-Encoding:\r\n chunked\r\n\r\n0\r\n\r\n", 400},
             {"chunks in HTTP/1.0", "POST /api/v1/moves/start HTTP/1.0\r\nHost: localhost\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n",
              400},
             {"bare line feeds", "GET /healthz HTTP/1.1\nHost: localhost\r\n\r\n", 400},
             {"two hosts", "GET /healthz HTTP/1.1\r\nHost: localhost\r\nHost: localhost\r\n\r\n", 400},
             {"two authorizations",
              "GET /healthz HTTP/1.1\r\nHost: localhost\r\nAuthorization: Bearer a\r\nauthorization: Bearer b\r\n\r\n", 400},
             {"other expectation", "POST / HTTP/1.1\r\nHost: localhost\r\nExpect: magic\r\nContent-Length: 2\r\n\r\n{}", 417}}) {
        Client c(door.port);
        ASSERT_TRUE(c.send(bytes)) << what;
        const auto a = c.receive();
        EXPECT_EQ(a.status(), status) << what;
        EXPECT_FALSE(a.message.keep_alive()) << what;
        EXPECT_TRUE(c.closed()) << what;
    }
    Client good(door.port);
    EXPECT_EQ(good.get("/healthz").status(), 200u) << "nobody else is touched";
    EXPECT_EQ(door.on([&] { return door.server().counters().malformed; }), 22u);
}

TEST_F(HttpServer, TheBoundOfAHeadIsExact) {
    door.settings.max_header_bytes = 300;
    door.open();
    const std::string begin = "GET /healthz HTTP/1.1\r\nHost: localhost\r\nX: ";
    const auto of = [&begin](std::size_t bytes) { return begin + std::string(bytes - begin.size() - 4, 'x') + "\r\n\r\n"; };
    Client good(door.port);
    for (const std::size_t bytes : {100u, 299u, 300u}) {
        good.send(of(bytes));
        EXPECT_EQ(good.receive().status(), 200u) << bytes;
    }
    Client bad(door.port);
    bad.send(of(301));
    EXPECT_EQ(bad.receive().status(), 431u);
    EXPECT_TRUE(bad.closed());
    Client endless(door.port);
    endless.send(of(400).substr(0, 300));
    EXPECT_EQ(endless.receive().status(), 431u) << "it cannot become a good one any more";
}

TEST_F(HttpServer, EmptyLinesBeforeARequest) {
    door.settings.header_limit = milliseconds(100);
    door.open();
    Client c(door.port);
    EXPECT_EQ(c.get("/healthz").status(), 200u);
    c.send("\r\nGET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 200u);
    c.send("\r\n");
    std::this_thread::sleep_for(milliseconds(200));  // longer than half a request may take, because an empty line is no request
    c.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 200u);
    c.send("\r\n\r\n\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 400u);
}

TEST_F(HttpServer, HalfRequestsDoNotShutTheDoor) {
    door.settings.max_connections = 16;
    door.open();
    Client path(door.port), watching(door.port);
    path.send(Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"enable"})"));
    ASSERT_TRUE(door.until([&] { return door.gateway.waiting.size() == 1; }));
    door.on([&] { door.gateway.finish(good_result()); });
    EXPECT_EQ(path.receive().status(), 200u);
    EXPECT_EQ(watching.get("/api/v1/about").status(), 200u);
    std::vector<std::unique_ptr<Client>> half;
    for (int i = 0; i < 60; ++i) {
        half.push_back(std::make_unique<Client>(door.port));
        half.back()->send(
            i % 3 == 0 ? "GET /healthz HTTP/1.1\r\nHo"
            : i % 3 == 1
                ? "POST /api/v1/session HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{"
                : "");
    }
    Client fresh(door.port);
    EXPECT_EQ(fresh.get("/healthz").status(), 200u) << "there is always a place for one more";
    EXPECT_EQ(path.get("/healthz").status(), 200u) << "the path of a stop stays";
    EXPECT_EQ(watching.get("/healthz").status(), 200u) << "and so does who is known";
    EXPECT_GE(door.on([&] { return door.server().counters().connections_gave_way; }), 40u);
    EXPECT_EQ(door.on([&] { return door.server().counters().connections_refused; }), 0u);
    EXPECT_TRUE(half.front()->closed()) << "the oldest went first";
}

TEST_F(HttpServer, AnswersThatAreNotReadDoNotShutTheDoorEither) {
    door.settings.max_connections = 8;
    door.open();
    std::vector<std::unique_ptr<Client>> slow;
    for (int i = 0; i < 8; ++i) {
        slow.push_back(std::make_unique<Client>(door.port, 4096));
        slow.back()->send("GET /big.txt HTTP/1.1\r\nHost: localhost\r\n\r\n");
    }
    ASSERT_TRUE(door.until([&] { return door.server().counters().connections == 8; }));
    Client fresh(door.port);
    EXPECT_EQ(fresh.get("/healthz").status(), 200u);
}

TEST_F(HttpServer, WhatLargeAnswersHoldTogetherIsBounded) {
    door.settings.max_held_bytes = 20 * 1024 * 1024;  // two of the big file, not three
    door.open();
    Client a(door.port, 4096), b(door.port, 4096), c(door.port);
    for (auto* x : {&a, &b}) {
        x->send("GET /big.txt HTTP/1.1\r\nHost: localhost\r\n\r\n");
        ASSERT_TRUE(door.until([&] { return door.server().counters().bytes_out > 0; }));
    }
    ASSERT_TRUE(door.until(
        [&] { return door.server().counters().requests.size() == 1 && door.server().counters().requests.begin()->second == 2; }));
    const auto refused = c.get("/big.txt");
    EXPECT_EQ(refused.status(), 503u);
    EXPECT_EQ(refused.message[beast::http::field::retry_after], "2");
    EXPECT_EQ(c.get("/healthz").status(), 200u) << "small answers are not counted, and the connection goes on";
    c.send(Client::post_text("/api/v1/moves/start", R"({"axes":[]})" + std::string(1000000, ' ')));
    EXPECT_EQ(c.receive().status(), 422u) << "1 MB of the 4 that are left";
    a.close();
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 2; }));
    EXPECT_EQ(Client(door.port).get("/big.txt").status(), 200u) << "what a client that has gone held is free again";
}

TEST_F(HttpServer, AStrangersBodyIsAFewKiB) {
    door.open();
    const auto head = [](std::size_t bytes, const char* more) {
        return "POST /api/v1/session HTTP/1.1\r\nHost: localhost\r\nVia: proxy\r\nContent-Type: application/json\r\n" + std::string(more) +
               "Content-Length: " + std::to_string(bytes) + "\r\n\r\n";
    };
    Client c(door.port);
    c.send(head(8193, "") + "{");
    EXPECT_EQ(c.receive().status(), 413u);
    EXPECT_TRUE(c.closed());
    Client fits(door.port);
    fits.send(head(8192, "") + "{}" + std::string(8190, ' '));
    EXPECT_NE(fits.receive().status(), 413u);
    Client chunks(door.port);
    chunks.send(
        "POST /api/v1/session HTTP/1.1\r\nHost: localhost\r\nVia: proxy\r\nContent-Type: application/json\r\nTransfer-Encoding: "
        "chunked\r\n\r\n3000\r\n" +
        std::string(0x3000, ' ') + "\r\n");
    EXPECT_EQ(chunks.receive().status(), 413u);
}

TEST_F(HttpServer, ClientsThatGoAwayInTheMiddle) {
    door.open();
    for (const auto* part :
         {"", "G", "GET / HT", "GET / HTTP/1.1\r\nHost: loc",
          "PUT /api/v1/site HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{"}) {
        Client c(door.port);
        c.send(part);
        c.close();
    }
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 0; }));
    {
        Client c(door.port);
        c.send(Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"enable"})"));
        ASSERT_TRUE(door.until([&] { return door.gateway.waiting.size() == 1; }));
        c.close();
    }
    door.on([&] { door.gateway.finish(good_result()); });
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 0; }));
}

TEST_F(HttpServer, AClientThatOnlySendsIsStillAnswered) {
    door.open();
    Client c(door.port);
    c.send("GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n");
    c.shutdown_send();
    EXPECT_EQ(c.receive().status(), 200u);
    EXPECT_TRUE(c.closed());
}

TEST_F(HttpServer, SlowHeaders) {
    door.settings.header_limit = milliseconds(100);
    door.open();
    Client half(door.port), silent(door.port);
    half.send("GET /healthz HTTP/1.1\r\nHo");
    const auto a = half.receive();
    EXPECT_EQ(a.status(), 408u);
    EXPECT_EQ(a.json().at("reason"), "time_out");
    EXPECT_TRUE(half.closed());
    EXPECT_TRUE(silent.closed()) << "without a word there is nothing to answer";
    EXPECT_EQ(door.on([&] { return door.server().counters().connections_timed_out; }), 2u);
}

TEST_F(HttpServer, SlowHeadersOfALaterRequest) {
    door.settings.header_limit = milliseconds(100);
    door.open();
    Client c(door.port);
    EXPECT_EQ(c.get("/healthz").status(), 200u);
    c.send("G");
    EXPECT_EQ(c.receive().status(), 408u);
}

TEST_F(HttpServer, SlowBodies) {
    door.settings.body_limit = milliseconds(100);
    door.open();
    Client c(door.port);
    c.send("PUT /api/v1/site HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{");
    EXPECT_EQ(c.receive().status(), 408u);
    EXPECT_TRUE(c.closed());
}

TEST_F(HttpServer, IdleConnectionsAreClosed) {
    door.settings.idle_limit = milliseconds(100);
    door.open();
    Client c(door.port);
    EXPECT_EQ(c.get("/healthz").status(), 200u);
    EXPECT_TRUE(c.closed());
}

TEST_F(HttpServer, AClientThatDoesNotReadItsAnswer) {
    door.settings.write_limit = milliseconds(1000);  // sufficient for a reading client, on a slow machine too
    door.open();
    Client c(door.port, 4096);
    c.send("GET /big.txt HTTP/1.1\r\nHost: localhost\r\n\r\n");
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections_timed_out == 1; }));
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 0; }));
    EXPECT_LT(c.rest().size(), door.big_file.size());
    Client reads(door.port);
    EXPECT_EQ(reads.get("/big.txt").message.body().size(), door.big_file.size());
}

TEST_F(HttpServer, ContinueIsSaidBeforeABody) {
    door.open();
    Client c(door.port);
    c.send(
        "POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 2\r\nExpect: "
        "100-continue\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 100u);
    c.send("{}");
    EXPECT_EQ(c.receive().status(), 422u);
    c.send("POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9999999\r\nExpect: 100-continue\r\n\r\n");
    EXPECT_EQ(c.receive().status(), 413u) << "no continue for what is refused anyway";
}

TEST_F(HttpServer, TheWaitEndsAtTheSocketToo) {
    door.open();
    Client c(door.port);
    const auto a = c.post("/api/v1/axes/feeder/commands?wait=0.05", R"({"command":"home"})");
    EXPECT_EQ(a.status(), 200u);
    EXPECT_EQ(a.json().at("reason"), "not done after 0.05 s");
    door.on([&] { door.gateway.finish(good_result(Outcome::done)); });  // too late: the request has ended
    EXPECT_EQ(c.get("/healthz").json().at("status"), "ok") << "the late answer is not given to another request";
}

TEST_F(HttpServer, ManyConnections) {
    door.open();
    std::vector<std::unique_ptr<Client>> clients;
    for (int i = 0; i < 200; ++i)
        clients.push_back(std::make_unique<Client>(door.port));
    for (auto& c : clients)
        EXPECT_EQ(c->get("/healthz").status(), 200u);
    EXPECT_EQ(door.on([&] { return door.server().counters().connections; }), 200u);
    clients.clear();
    EXPECT_TRUE(door.until([&] { return door.server().counters().connections == 0; }));
}

TEST_F(HttpServer, OverTheNumberTheLongestIdleOneGoes) {
    door.settings.max_connections = 3;
    door.open();
    Client a(door.port), b(door.port), c(door.port);
    for (auto* x : {&a, &b, &c})
        EXPECT_EQ(x->get("/healthz").status(), 200u);
    EXPECT_EQ(a.get("/healthz").status(), 200u);  // now b is idle for the longest
    Client d(door.port);
    EXPECT_EQ(d.get("/healthz").status(), 200u);
    EXPECT_TRUE(b.closed());
    EXPECT_EQ(a.get("/healthz").status(), 200u);
    EXPECT_EQ(c.get("/healthz").status(), 200u);
}

TEST_F(HttpServer, WithoutAnIdleOneTheNewOneIsRefused) {
    door.settings.max_connections = 2;
    door.open();
    Client a(door.port), b(door.port);
    for (auto* x : {&a, &b})
        x->send(Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"enable"})"));
    ASSERT_TRUE(door.until([&] { return door.gateway.waiting.size() == 2; }));
    Client c(door.port);
    const auto refused = c.receive();
    EXPECT_EQ(refused.status(), 503u);
    EXPECT_EQ(refused.json().at("reason"), "busy");
    EXPECT_EQ(door.on([&] { return door.server().counters().connections_refused; }), 1u);
    door.on([&] {
        door.gateway.finish(good_result());
        door.gateway.finish(good_result());
    });
    EXPECT_EQ(a.receive().status(), 200u);
    EXPECT_EQ(b.receive().status(), 200u);
}

TEST_F(HttpServer, Metrics) {
    door.open();
    Client c(door.port);
    c.get("/api/v1/axes/feeder");
    c.get("/api/v1/axes/none");
    const std::string text = c.get("/metrics").message.body();
    EXPECT_NE(text.find("axisgate_up 1\n"), std::string::npos) << "the gateway's";
    EXPECT_NE(text.find("axisgate_http_requests_total{route=\"/api/v1/axes/{axis}\",method=\"GET\",status=\"200\"} 1\n"), std::string::npos)
        << text;
    EXPECT_NE(text.find("status=\"404\"} 1\n"), std::string::npos);
    EXPECT_NE(text.find("axisgate_http_request_duration_seconds_bucket{le=\"+Inf\"} 2\n"), std::string::npos) << text;
    EXPECT_NE(text.find("axisgate_http_connections 1\n"), std::string::npos);
    // Every sample has its HELP and TYPE.
    std::istringstream lines(text);
    std::set<std::string> typed;
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("# TYPE ")) {
            typed.insert(line.substr(7, line.find(' ', 7) - 7));
        } else if (!line.starts_with('#')) {
            std::string name = line.substr(0, line.find_first_of("{ "));
            for (const std::string_view tail : {"_bucket", "_sum", "_count"}) {
                if (name.ends_with(tail) && typed.contains(name.substr(0, name.size() - tail.size())))
                    name.resize(name.size() - tail.size());
            }
            EXPECT_TRUE(typed.contains(name)) << line;
        }
    }
}

TEST_F(HttpServer, StopsInOrder) {
    door.settings.answer_limit_at_stop = door.settings.stop_limit = milliseconds(10'000);
    door.open();
    Client idle(door.port), busy(door.port), half(door.port);
    EXPECT_EQ(idle.get("/healthz").status(), 200u);
    busy.send(Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"enable"})"));
    half.send("GET / HT");
    ASSERT_TRUE(door.until([&] { return door.gateway.waiting.size() == 1; }));
    bool stopped = false;
    door.on([&] { door.server().stop([&stopped] { stopped = true; }); });
    EXPECT_TRUE(idle.closed());
    EXPECT_TRUE(half.closed());
    EXPECT_FALSE(door.on([&] { return stopped; })) << "a request is in progress";
    EXPECT_TRUE(Client(door.port).connected.failed()) << "no new ones";
    door.on([&] { door.gateway.finish(good_result()); });
    const auto a = busy.receive();
    EXPECT_EQ(a.status(), 200u);
    EXPECT_FALSE(a.message.keep_alive());
    EXPECT_TRUE(busy.closed());
    busy.close();
    EXPECT_TRUE(door.until([&] { return stopped; }));
}

TEST_F(HttpServer, StopsEvenIfSomebodyNeverEnds) {
    door.settings.stop_limit = milliseconds(100);
    door.open();
    Client busy(door.port);
    busy.send(Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"enable"})"));
    ASSERT_TRUE(door.until([&] { return door.gateway.waiting.size() == 1; }));
    bool stopped = false;
    door.on([&] { door.server().stop([&stopped] { stopped = true; }); });
    EXPECT_TRUE(door.until([&] { return stopped; }));
    EXPECT_TRUE(busy.closed());
    door.on([&] { door.gateway.finish(good_result()); });  // without a client nothing happens
}

TEST_F(HttpServer, WhoWaitsForSomethingLongIsAnsweredAtTheStopAndHoldsNobodyUp) {
    door.open();
    Client waits(door.port), half(door.port), deaf(door.port, 4096);
    waits.send(Client::post_text("/api/v1/axes/feeder/commands?wait=60", R"({"command":"home"})"));
    half.send("POST /api/v1/moves/start HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n{");
    deaf.send("GET /big.txt HTTP/1.1\r\nHost: localhost\r\n\r\n");
    ASSERT_TRUE(door.until([&] { return door.gateway.waiting.size() == 1 && !door.server().counters().requests.empty(); }));
    bool stopped = false;
    const auto begun = std::chrono::steady_clock::now();
    door.on([&] { door.server().stop([&stopped] { stopped = true; }); });
    const auto a = waits.receive();
    EXPECT_EQ(a.status(), 200u);
    EXPECT_EQ(a.json().at("result"), "accepted") << "what he would have heard at his own limit";
    EXPECT_TRUE(half.closed());
    EXPECT_TRUE(door.until([&] { return stopped; }));
    EXPECT_LT(std::chrono::steady_clock::now() - begun, milliseconds(5'000)) << "0.6 s, and much for a busy machine";
}

TEST_F(HttpServer, APortThatIsTaken) {
    door.open();
    asio::io_context context;
    FakeGateway other;
    Settings settings;
    settings.bind = "127.0.0.1:" + std::to_string(door.port);
    Services services(other, steady_instant);
    Server second(context, other, services, settings, {});
    const std::string fault = second.start();
    EXPECT_NE(fault.find(settings.bind), std::string::npos) << fault;
    EXPECT_NE(fault.find("bind"), std::string::npos) << "with what to do";
    EXPECT_EQ(second.address(), "");
}

TEST(HttpBind, Addresses) {
    std::string fault;
    EXPECT_EQ(parse_bind("127.0.0.1:8080", fault), tcp::endpoint(asio::ip::make_address("127.0.0.1"), 8080));
    EXPECT_EQ(parse_bind("[::1]:80", fault), tcp::endpoint(asio::ip::make_address("::1"), 80));
    EXPECT_EQ(parse_bind("localhost:0", fault), tcp::endpoint(asio::ip::make_address("127.0.0.1"), 0));
    EXPECT_EQ(parse_bind(":8080", fault), tcp::endpoint(asio::ip::make_address("0.0.0.0"), 8080));
    EXPECT_EQ(parse_bind("*:8080", fault), tcp::endpoint(asio::ip::make_address("0.0.0.0"), 8080));
    for (const auto* bad : {"", "8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:65536", "host.example:80", "[::1:80"}) {
        fault.clear();
        EXPECT_FALSE(parse_bind(bad, fault)) << bad;
        EXPECT_FALSE(fault.empty()) << bad;
    }
}

TEST(HttpHead, ValuesCannotBeginHeadersOfTheirOwn) {
    Response r;
    r.headers.set("Location", "/a\r\nSet-Cookie: x=1");
    const std::string head = response_head(r, true, 784'111'777);
    EXPECT_EQ(head.find("\r\nSet-Cookie"), std::string::npos) << head;
    EXPECT_NE(head.find("Date: Sun, 06 Nov 1994 08:49:37 GMT\r\n"), std::string::npos) << head;
    EXPECT_TRUE(head.ends_with("\r\n\r\n"));
}
TEST_F(HttpServer, WithoutDescriptorsAStopStillComesIn) {
    door.open();
    door.on([this] {
        door.gateway.at_once = [](const Command&) {
            Result r;
            r.outcome = Outcome::accepted;
            return r;
        };
    });
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_NOFILE, &before), 0);
    for (int i = 0; i < 5; ++i) {
        const int next = ::dup(0);  // every number below this one is in use: it is the client's, and the door has none
        ::close(next);
        rlimit tight = before;
        tight.rlim_cur = static_cast<rlim_t>(next) + 1;
        ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &tight), 0);
        // Without an io_context, which would need descriptors.
        const int client = ::socket(AF_INET, SOCK_STREAM, 0);
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_port = htons(door.port);
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        const timeval patient{5, 0};
        (void)::setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patient, sizeof patient);
        ASSERT_EQ(::connect(client, reinterpret_cast<const sockaddr*>(&at), sizeof at), 0);
        const std::string request = Client::post_text("/api/v1/axes/feeder/commands", R"({"command":"quick_stop"})");
        ASSERT_EQ(::send(client, request.data(), request.size(), MSG_NOSIGNAL), static_cast<ssize_t>(request.size()));
        char answer[16] = {};
        (void)::recv(client, answer, 12, MSG_WAITALL);
        ::close(client);
        ASSERT_EQ(::setrlimit(RLIMIT_NOFILE, &before), 0);
        EXPECT_STREQ(answer, "HTTP/1.1 200") << i;
        ASSERT_TRUE(door.until([this] { return door.server().counters().connections == 0; }));
    }
}

}  // namespace
}  // namespace axisgate::http::test
