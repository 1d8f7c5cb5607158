// One TCP connection with HTTP/1.1: requests one after the other, answers in the same order; a WebSocket session after an upgrade. Bounds:
// bytes of header and body, time for each step (Settings). While one request is answered nothing is read, so pipelined requests wait in the
// client's socket. A fault is answered once and the connection is closed.
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
    bool known_ = false;      ///< the last request came from a signed-in client, or from this machine
    bool stop_path_ = false;  ///< a motion was started over it
    std::size_t held_ = 0;    ///< of the host's budget
    int empty_lines_ = 0;     ///< before the request, when nothing else has arrived
    boost::asio::steady_timer timer_;
    /// The limit of the phase is a value. The timer is set only if it would expire too late; if it expires too early, it is set again. So a
    /// request needs no timer of the system.
    SteadyTime due_{}, timer_due_{};
    bool timer_runs_ = false;
    std::uint64_t timer_serial_ = 0;
    boost::beast::flat_buffer buffer_;
    std::optional<Parser> parser_;
    Request request_;
    std::string_view route_ = "none";  ///< of the request, for the counters
    std::optional<Response> at_limit_;
    std::uint64_t serial_ = 0;  ///< of the present request; a late answer to another one is ignored
    SteadyTime since_{};        ///< phases handshake, idle, header: their begin; later ones: when the request was complete
    Phase phase_ = Phase::idle;
    bool first_ = true;  ///< no request on this connection yet
    bool timed_out_ = false;
    bool commands_ = false;            ///< the route of the request may start a motion
    bool close_after_ = false;         ///< the answer is the last one: an unread body may still be arriving
    std::size_t most_body_bytes_ = 0;  ///< of the request that is being read
    bool stopping_ = false;
    std::size_t discarded_ = 0;
    std::string head_;  ///< of the answer that is being written
    std::string body_;
    std::optional<boost::beast::buffers_suffix<std::array<boost::asio::const_buffer, 2>>> unsent_;  ///< the unsent rest of both
    SteadyTime write_end_{};                                                                        ///< the deadline of the answer
};

/// Status line and headers of a response, up to and with the empty line.
[[nodiscard]] std::string response_head(const Response& response, bool keep, std::int64_t now_unix_s);

}  // namespace axisgate::http
