// Connection: one TCP connection that speaks HTTP/1.1: requests one after the other, answers in the same order.
// In: bytes. Out: bytes; a WebSocket session when a request was upgraded.
// Bounds: header and body bytes, time for each step (see Settings). While one request is answered nothing is read, so a client that sends
// many at once (pipelining) waits in its own socket. A fault is answered once and the connection is closed.
#pragma once

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_suffix.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <memory>
#include <optional>
#include <string>

#include "gateway/doors/http/session.hpp"

namespace axisgate::http {

class Connection final : public Session, public std::enable_shared_from_this<Connection> {
public:
    Connection(Transport socket, std::shared_ptr<SessionHost> host, std::string peer, PlaceHolder holder);

    void start();
    [[nodiscard]] Guest guest() const override;
    void stop() override;
    void abort() override;

private:
    using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    using ErrorCode = boost::system::error_code;
    enum class Phase : std::uint8_t { handshake, idle, header, body, answering, writing, lingering, closed };

    void await_handshake();
    void shake_hands();
    void await_request();
    void await_bytes();
    void read_header();
    void read_more_header();
    void parse_header(std::size_t bytes);
    void on_header(ErrorCode ec);
    void read_body();
    void on_body(ErrorCode ec);
    void read_failed(ErrorCode ec);
    void take_head();
    void answer_request();
    void refuse(Response response);
    [[nodiscard]] bool hold(std::size_t bytes);
    [[nodiscard]] Response too_much_held() const;
    void answer(std::uint64_t serial, Response response);
    void fail(unsigned status, std::string_view reason, std::string detail);
    void write(Response response, bool keep);
    void write_on(bool keep, bool upgraded);
    void on_written(bool keep, bool upgraded);
    void upgrade();
    void linger();
    void discard();
    void set_timer(std::chrono::nanoseconds after);
    void arm_timer();
    void end_timer();
    void on_timer();
    void close();

    Transport socket_;
    std::shared_ptr<SessionHost> host_;
    std::string peer_;
    PlaceHolder holder_;
    bool known_ = false;      ///< the last request came from somebody who had signed in, or from this machine
    bool stop_path_ = false;  ///< something was set in motion over it
    std::size_t held_ = 0;    ///< of the host's budget
    int empty_lines_ = 0;     ///< in front of the request, when nothing else came
    boost::asio::steady_timer timer_;
    /// The limit of the phase is a value. The timer itself is only touched when it would come too late: when it comes too early, it is set
    /// anew, so that a request costs none of the system's timers.
    SteadyTime due_{}, timer_due_{};
    bool timer_runs_ = false;
    std::uint64_t timer_serial_ = 0;
    boost::beast::flat_buffer buffer_;
    std::optional<Parser> parser_;
    Request request_;
    std::string_view route_ = "none";  ///< of the request, for the counters
    std::optional<Response> at_limit_;
    std::uint64_t serial_ = 0;  ///< of the request that is answered; a late answer to another one is ignored
    SteadyTime since_{};        ///< phases handshake, idle, header: when they began; later: when the request was whole
    Phase phase_ = Phase::idle;
    bool first_ = true;  ///< no request yet on this connection
    bool timed_out_ = false;
    bool commands_ = false;            ///< the request is of a route that may set something in motion
    bool close_after_ = false;         ///< the answer is the last: a body that was not read may still be coming
    std::size_t most_body_bytes_ = 0;  ///< of the request that is read
    bool stopping_ = false;
    std::size_t discarded_ = 0;
    std::string head_;  ///< of the answer that is being written
    std::string body_;
    std::optional<boost::beast::buffers_suffix<std::array<boost::asio::const_buffer, 2>>> unsent_;  ///< what is left of both
    SteadyTime write_end_{};  ///< when the answer must be out at the latest
};

/// Status line and headers of a response, up to and with the empty line.
[[nodiscard]] std::string response_head(const Response& response, bool keep, std::int64_t now_unix_s);

}  // namespace axisgate::http
