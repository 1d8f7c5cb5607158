// One write has at most 64 KiB and the kernel holds 128 KiB, so that old states do not wait before new ones. Pings are also sent to a
// client that sends much, because only a pong shows that it reads.
#include "gateway/doors/http/websocket_session.hpp"

#include <boost/asio/write.hpp>

#include <algorithm>

namespace axisgate::http {
namespace asio = boost::asio;
namespace {
/// Size of one write: large enough to be worth the call, small enough that a newer state does not wait long.
constexpr std::size_t batch_bytes = 64 * 1024;
/// Limit of the kernel's buffer for one client. A large buffer would keep old states long after newer ones are known.
constexpr int send_buffer_bytes = 128 * 1024;
}  // namespace

WebSocketSession::WebSocketSession(Transport socket, std::shared_ptr<SessionHost> host, Request opened_by, PlaceHolder holder)
    : socket_(std::move(socket)),
      host_(std::move(host)),
      opened_by_(std::move(opened_by)),
      holder_(holder),
      timer_(socket_.get_executor()),
      parser_(host_->settings.max_message_bytes) {}

WebSocketSession::~WebSocketSession() = default;

void WebSocketSession::start(std::span<const std::uint8_t> early) {
    ErrorCode ignored;
    socket_.socket().set_option(asio::socket_base::send_buffer_size(send_buffer_bytes), ignored);
    client_ = host_->hub.add([self = weak_from_this()] {
        if (const auto me = self.lock()) me->pump();
    });
    // Looked up once, and again whenever the session is checked, because set-points may come a thousand times a second.
    client_->commander = [self = weak_from_this()]() -> std::optional<Origin> {
        const auto me = self.lock();
        if (!me) return std::nullopt;
        if (!me->commander_known_) me->commander_ = me->host_->router.commander_of(me->opened_by_);
        me->commander_known_ = true;
        return me->commander_;
    };
    client_->takes_at_once = true;
    received_ = pinged_ = looked_ = std::chrono::steady_clock::now();
    arm();
    if (!early.empty()) take(early);
    if (host_->stopping) stop();
    if (!closed_) read();
}

void WebSocketSession::stop() { begin_close(close_going_away, "the gateway stops"); }

void WebSocketSession::abort() { close(); }

void WebSocketSession::read() {
    socket_.async_read_some(asio::buffer(buffer_), [self = shared_from_this()](ErrorCode ec, std::size_t bytes) {
        if (self->closed_) return;
        if (ec) return self->close();
        self->host_->counters.bytes_in += bytes;
        self->received_ = std::chrono::steady_clock::now();
        self->take(std::span(self->buffer_).first(bytes));
        if (!self->closed_) self->read();
    });
}

void WebSocketSession::take(std::span<const std::uint8_t> bytes) {
    std::vector<WebSocketMessage> messages;
    const auto fault = parser_.take(bytes, messages);
    for (auto& m : messages) {
        if (close_received_) break;
        switch (m.kind) {
            case WebSocketMessage::Kind::text:
                if (closing_) break;
                host_->hub.on_text(*client_, m.payload, steady_instant());
                if (client_->closing()) begin_close(client_->closing(), {});
                break;
            case WebSocketMessage::Kind::ping:
                if (closing_) break;
                client_->queue.push_control(std::make_shared<const std::string>(server_frame(Opcode::pong, m.payload)));
                pump();
                break;
            case WebSocketMessage::Kind::pong:
                break;
            case WebSocketMessage::Kind::close:
                close_received_ = true;
                begin_close(m.code, {});
                if (closing_ && !writing_ && client_->queue.empty()) finish();
                break;
        }
        if (closed_) return;
    }
    if (fault) begin_close(fault->code, fault->text);
}

void WebSocketSession::begin_close(std::uint16_t code, std::string_view reason) {
    if (closing_ || closed_) return;
    closing_ = true;
    close_began_ = std::chrono::steady_clock::now();
    ++host_->counters.stream_closed[code];
    client_->close(code, reason);
    arm();
    pump();
}

void WebSocketSession::pump() {
    if (closed_ || finished_) return;
    // Closed by the hub because of a bound: the time for the close runs from now on, also while a write to a client that does not read is
    // blocked.
    if (client_->closing() && !closing_) return begin_close(client_->closing(), {});
    if (writing_) return;
    batch_ = client_->queue.take(batch_bytes);
    if (batch_.empty()) return;
    writing_ = true;
    client_->takes_at_once = false;
    write_began_ = std::chrono::steady_clock::now();
    std::vector<asio::const_buffer> buffers;
    buffers.reserve(batch_.size());
    for (const auto& f : batch_)
        buffers.push_back(asio::buffer(*f));
    asio::async_write(socket_, buffers, [self = shared_from_this()](ErrorCode ec, std::size_t bytes) { self->on_written(ec, bytes); });
}

void WebSocketSession::on_written(ErrorCode ec, std::size_t bytes) {
    writing_ = false;
    client_->takes_at_once = true;
    host_->counters.bytes_out += bytes;
    host_->counters.stream_frames_sent += batch_.size();
    batch_.clear();
    if (closed_) return;
    if (ec) return close();
    if (closing_ && client_->queue.empty()) return finish();
    pump();
}

void WebSocketSession::finish() {
    // Our close frame was sent. If the client's has arrived too, the connection ends; otherwise its answer is awaited for a short time.
    if (close_received_) {
        finished_ = true;
        socket_.end_sending([self = shared_from_this()] {});  // the read ends when the client's end arrives
    }
    close_began_ = std::chrono::steady_clock::now();
    arm();
}

/// A client that has stopped reading gets the reason behind the waiting batch if it continues within half the write limit.
SteadyTime WebSocketSession::close_due() const {
    return close_began_ + (writing_ ? host_->settings.write_limit / 2 : host_->settings.linger_limit);
}

void WebSocketSession::arm() {
    if (closed_) return;
    SteadyTime due = closing_ ? close_due()
                              : std::min({pinged_ + host_->settings.ping_period, looked_ + host_->settings.right_period,
                                          received_ + host_->settings.silence_limit});
    if (writing_) due = std::min(due, write_began_ + (closing_ ? host_->settings.write_limit : host_->settings.write_limit / 2));
    timer_.expires_at(due);
    timer_.async_wait([self = weak_from_this()](ErrorCode ec) {
        const auto me = self.lock();
        if (!ec && me && !me->closed_) me->on_timer();
    });
}

void WebSocketSession::on_timer() {
    const auto now = std::chrono::steady_clock::now();
    if ((closing_ && now >= close_due()) || (writing_ && now >= write_began_ + host_->settings.write_limit)) {
        ++host_->counters.connections_timed_out;
        return close();
    }
    if (!closing_ && now >= looked_ + host_->settings.right_period) {
        looked_ = now;
        commander_known_ = false;
        if (const auto why = host_->router.why_not_watched_on(opened_by_); !why.empty()) return begin_close(close_policy, why);
    }
    if (!closing_ && writing_ && now >= write_began_ + host_->settings.write_limit / 2) {
        begin_close(close_try_later, "not read in time");
    } else if (!closing_ && now >= received_ + host_->settings.silence_limit) {
        begin_close(close_policy, "no sign of life");
    } else if (!closing_ && now >= pinged_ + host_->settings.ping_period) {
        // Sent regularly, also to a client that sends much, because only a pong shows that it reads.
        pinged_ = now;
        client_->queue.push_control(std::make_shared<const std::string>(server_frame(Opcode::ping, {})));
        pump();
    }
    arm();
}

void WebSocketSession::close() {
    if (closed_) return;
    closed_ = true;
    timer_.cancel();
    ErrorCode ignored;
    socket_.close(ignored);
    host_->hub.remove(client_);
    host_->remove(this);
}

}  // namespace axisgate::http
