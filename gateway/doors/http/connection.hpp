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
    Connection(Transport socket, std::shared_ptr<SessionHost> host, std::string peer);

    void start();
    [[nodiscard]] std::optional<SteadyTime> idle_since() const override;
    void stop() override;
    void abort() override;

private:
    using Parser = boost::beast::http::request_parser<boost::beast::http::string_body>;
    using ErrorCode = boost::system::error_code;
    enum class Phase : std::uint8_t { handshake, idle, header, body, answering, writing, lingering, closed };

    void await_handshake();
    void shake_hands();
    void await_request();
    void read_header();
    void on_header(ErrorCode ec);
    void read_body();
    void on_body(ErrorCode ec);
    void read_failed(ErrorCode ec);
    void take_head();
    void answer_request();
    void refuse(Response response);
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
    SteadyTime since_{};        ///< phase idle: when it began; later: when the request was whole
    Phase phase_ = Phase::idle;
    bool first_ = true;  ///< no request yet on this connection
    bool timed_out_ = false;
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
