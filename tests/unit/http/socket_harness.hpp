// The whole door on a loopback port, in a thread of its own, and clients that never wait for ever.
// In: what a test sends. Out: what came back within 10 s; later is a failure, not a hang.
#pragma once

#include <gtest/gtest.h>

#include <boost/asio.hpp>
#include <boost/beast.hpp>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <type_traits>

#include "gateway/doors/http/server.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

inline constexpr std::chrono::seconds patience{10};

class Door {
public:
    FakeGateway gateway;  // touched inside on() alone while the door is open
    Settings settings;
    std::string big_file = std::string(8 * 1024 * 1024, 'x');

    Door() { settings.bind = "127.0.0.1:0"; }
    ~Door() {
        if (!thread_.joinable()) return;
        on([this] { server_.reset(); });
        work_.reset();
        context_.stop();
        thread_.join();
    }
    void open() {
        server_ = std::make_unique<Server>(context_, gateway, settings, [this](std::string_view path) {
            return path == "web/dist/index.html" ? std::string_view("<html>page</html>")
                   : path == "web/dist/big.txt"  ? std::string_view(big_file)
                                                 : std::string_view();
        });
        ASSERT_EQ(server_->start(), "");
        const std::string address = server_->address();
        port = static_cast<std::uint16_t>(std::stoi(address.substr(address.rfind(':') + 1)));
        thread_ = std::thread([this] { context_.run(); });
    }
    /// Runs `f` on the door's thread and waits for it.
    template <class F>
    std::invoke_result_t<F> on(F f) {
        std::packaged_task<std::invoke_result_t<F>()> task(std::move(f));
        auto result = task.get_future();
        asio::post(context_, [&task] { task(); });
        if (result.wait_for(patience) != std::future_status::ready) throw std::runtime_error("the door's thread hangs");
        return result.get();
    }
    /// Waits until `f()`, run on the door's thread, is true; false if that takes too long.
    template <class F>
    bool until(F f) {
        const auto end = std::chrono::steady_clock::now() + patience;
        while (std::chrono::steady_clock::now() < end) {
            if (on(f)) return true;
            std::this_thread::yield();
        }
        return false;
    }
    Server& server() { return *server_; }
    std::uint16_t port = 0;

private:
    asio::io_context context_;
    asio::executor_work_guard<asio::io_context::executor_type> work_ = asio::make_work_guard(context_);
    std::unique_ptr<Server> server_;
    std::thread thread_;
};

struct HttpAnswer {
    ErrorCode error;
    beast::http::response<beast::http::string_body> message;
    [[nodiscard]] unsigned status() const { return error ? 0 : message.result_int(); }
    [[nodiscard]] boost::json::value json() const {
        ErrorCode ec;
        return boost::json::parse(message.body(), ec);
    }
};

/// A plain client: raw bytes out, answers or raw bytes in.
class Client {
public:
    explicit Client(std::uint16_t port, int receive_buffer = 0) : socket_(context_) {
        socket_.open(tcp::v4());
        if (receive_buffer) socket_.set_option(asio::socket_base::receive_buffer_size(receive_buffer));
        socket_.connect({asio::ip::make_address("127.0.0.1"), port}, connected);
    }
    /// False if the door closed the connection before everything was sent.
    bool send(std::string_view bytes) {
        ErrorCode ec =
            wait([&](auto done) { asio::async_write(socket_, asio::buffer(bytes), [done](ErrorCode e, std::size_t) { done(e); }); });
        return !ec;
    }
    HttpAnswer receive(bool to_head = false) {
        HttpAnswer answer;
        beast::http::response_parser<beast::http::string_body> parser;
        parser.body_limit(64 * 1024 * 1024);
        parser.skip(to_head);
        answer.error =
            wait([&](auto done) { beast::http::async_read(socket_, buffer_, parser, [done](ErrorCode e, std::size_t) { done(e); }); });
        if (!answer.error) answer.message = parser.release();
        return answer;
    }
    HttpAnswer get(std::string_view target, std::string_view more = {}) {
        send(std::string("GET ").append(target).append(" HTTP/1.1\r\nHost: 127.0.0.1\r\n").append(more).append("\r\n"));
        return receive();
    }
    HttpAnswer post(std::string_view target, std::string_view body) {
        send(post_text(target, body));
        return receive();
    }
    static std::string post_text(std::string_view target, std::string_view body, std::string_view method = "POST") {
        return std::string(method) + " " + std::string(target) +
               " HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(body.size()) +
               "\r\n\r\n" + std::string(body);
    }
    /// Everything up to the end of the connection; the test fails if the end does not come.
    std::string rest() {
        std::string all(beast::buffers_to_string(buffer_.data()));
        buffer_.clear();
        for (;;) {
            std::array<char, 65536> piece;
            std::size_t n = 0;
            const ErrorCode ec = wait([&](auto done) {
                socket_.async_read_some(asio::buffer(piece), [done, &n](ErrorCode e, std::size_t bytes) {
                    n = bytes;
                    done(e);
                });
            });
            all.append(piece.data(), n);
            if (ec == asio::error::timed_out) {
                ADD_FAILURE() << "the connection was not closed";
                return all;
            }
            if (ec) return all;
        }
    }
    bool closed() { return rest().empty(); }
    void shutdown_send() {
        ErrorCode ignored;
        socket_.shutdown(tcp::socket::shutdown_send, ignored);
    }
    void close() {
        ErrorCode ignored;
        socket_.close(ignored);
    }
    ErrorCode connected;

private:
    /// Runs one operation to its end, at most for `patience`.
    template <class Start>
    ErrorCode wait(Start start) {
        std::optional<ErrorCode> result;
        start([&result](ErrorCode e) { result = e; });
        context_.restart();
        context_.run_for(patience);
        if (result) return *result;
        socket_.close();
        context_.restart();
        context_.run();
        return asio::error::timed_out;
    }
    asio::io_context context_;
    tcp::socket socket_;
    beast::flat_buffer buffer_{64 * 1024 * 1024};
};

/// An independent judge of our WebSocket: Beast's own client.
class StreamJudge {
public:
    explicit StreamJudge(std::uint16_t port, std::string origin = {}, int receive_buffer = 0) : ws_(context_) {
        auto& socket = ws_.next_layer();
        socket.open(tcp::v4());
        if (receive_buffer) socket.set_option(asio::socket_base::receive_buffer_size(receive_buffer));
        socket.connect({asio::ip::make_address("127.0.0.1"), port});
        ws_.set_option(beast::websocket::stream_base::decorator([origin](beast::websocket::request_type& r) {
            if (!origin.empty()) r.set("Origin", origin);
        }));
        ws_.control_callback([this](beast::websocket::frame_type type, beast::string_view) {
            if (type == beast::websocket::frame_type::ping) ++pings;
            if (type == beast::websocket::frame_type::pong) ++pongs;
        });
        beast::websocket::response_type response;
        opened = wait([&](auto done) { ws_.async_handshake(response, "127.0.0.1:" + std::to_string(port), "/api/v1/stream", done); });
        handshake_status = response.result_int();
    }
    ErrorCode say(std::string_view text) {
        return wait([&](auto done) { ws_.async_write(asio::buffer(text), [done](ErrorCode e, std::size_t) { done(e); }); });
    }
    /// The next message's object; null, with `ended` set, if there is none any more.
    boost::json::value hear() {
        beast::flat_buffer buffer;
        ended = wait([&](auto done) { ws_.async_read(buffer, [done](ErrorCode e, std::size_t) { done(e); }); });
        if (ended) return nullptr;
        return boost::json::parse(beast::buffers_to_string(buffer.data()));
    }
    ErrorCode close(std::uint16_t code = 1000) {
        return wait([&](auto done) { ws_.async_close(code, done); });
    }
    ErrorCode ping() {
        return wait([&](auto done) { ws_.async_ping({}, done); });
    }
    /// Bytes past the WebSocket layer.
    void raw(std::string_view bytes) { asio::write(ws_.next_layer(), asio::buffer(bytes)); }
    [[nodiscard]] std::uint16_t close_code() const { return ws_.reason().code; }
    [[nodiscard]] std::string close_reason() const { return std::string(ws_.reason().reason.c_str()); }
    beast::websocket::stream<tcp::socket>& stream() { return ws_; }

    ErrorCode opened, ended;
    unsigned handshake_status = 0;
    int pings = 0, pongs = 0;

private:
    template <class Start>
    ErrorCode wait(Start start) {
        std::optional<ErrorCode> result;
        start([&result](ErrorCode e) { result = e; });
        context_.restart();
        const auto end = std::chrono::steady_clock::now() + patience;
        while (!result && std::chrono::steady_clock::now() < end && context_.run_one_for(patience) > 0) {
        }
        if (result) return *result;
        ws_.next_layer().close();
        context_.restart();
        context_.run();
        return asio::error::timed_out;
    }
    asio::io_context context_;
    beast::websocket::stream<tcp::socket> ws_;
};

}  // namespace axisgate::http::test
