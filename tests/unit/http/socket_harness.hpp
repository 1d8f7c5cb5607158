// The whole door on a loopback port in a thread of its own, and clients with a time limit of 10 s.
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
#include "gateway/doors/http/session.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
using asio::ip::tcp;
using ErrorCode = boost::system::error_code;

inline constexpr std::chrono::seconds patience{10};

class Door {
public:
    FakeGateway gateway;  // used only inside on() while the door is open
    Settings settings;
    std::string big_file = std::string(8 * 1024 * 1024, 'x');

    Door();
    ~Door();
    void open();
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
    asio::io_context& context() { return context_; }
    std::uint16_t port = 0;

private:
    void arm();
    asio::io_context context_;
    asio::executor_work_guard<asio::io_context::executor_type> work_ = asio::make_work_guard(context_);
    asio::steady_timer timer_{context_};
    std::unique_ptr<Services> services_;
    std::unique_ptr<Server> server_;
    std::thread thread_;
};

struct HttpAnswer {
    ErrorCode error;
    beast::http::response<beast::http::string_body> message;
    [[nodiscard]] unsigned status() const { return error ? 0 : message.result_int(); }
    [[nodiscard]] boost::json::value json() const;
};

/// A plain client: raw bytes out, answers or raw bytes in.
class Client {
public:
    explicit Client(std::uint16_t port, int receive_buffer = 0);
    ~Client();
    /// Returns false if the door closed the connection before everything was sent.
    bool send(std::string_view bytes);
    HttpAnswer receive(bool to_head = false);
    HttpAnswer get(std::string_view target, std::string_view more = {});
    HttpAnswer post(std::string_view target, std::string_view body);
    static std::string post_text(std::string_view target, std::string_view body, std::string_view method = "POST");
    /// Everything up to the end of the connection; the test fails if the end does not come.
    std::string rest();
    bool closed() { return rest().empty(); }
    void shutdown_send();
    void close();
    ErrorCode connected;

private:
    /// Runs one operation to its end, at most for `patience`.
    template <class Start>
    ErrorCode wait(Start start);
    asio::io_context context_;
    tcp::socket socket_;
    beast::flat_buffer buffer_{64 * 1024 * 1024};
};

/// Beast's own client as an independent check of our WebSocket.
class StreamJudge {
public:
    explicit StreamJudge(std::uint16_t port, std::string origin = {}, int receive_buffer = 0);
    ~StreamJudge();
    ErrorCode say(std::string_view text);
    /// The next message's object; null with `ended` set if there is none any more.
    boost::json::value next_message();
    ErrorCode close(std::uint16_t code = 1000);
    ErrorCode ping();
    /// Bytes below the WebSocket layer.
    void raw(std::string_view bytes);
    [[nodiscard]] std::uint16_t close_code() const { return ws_.reason().code; }
    [[nodiscard]] std::string close_reason() const { return std::string(ws_.reason().reason.c_str()); }
    beast::websocket::stream<tcp::socket>& stream() { return ws_; }

    ErrorCode opened, ended;
    unsigned handshake_status = 0;
    int pings = 0, pongs = 0;

private:
    template <class Start>
    ErrorCode wait(Start start);
    asio::io_context context_;
    beast::websocket::stream<tcp::socket> ws_;
};

}  // namespace axisgate::http::test
