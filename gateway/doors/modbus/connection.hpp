// One TCP client of the Modbus door: a non-blocking socket around a Session. All answers of one wake-up are sent together. At most one
// AnswerBuffer (64 KiB) is unsent: a client that does not read its answers is not read from, and is closed by the server's sweep.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "gateway/doors/modbus/session.hpp"
#include "gateway/lines/poller.hpp"

namespace axisgate::modbus {

/// The deadlines of a connection without activity. They are kept apart from it, so that a sweep over a thousand connections reads only two
/// instants each.
struct ConnectionTimes {
    Instant last_request = time_zero;  ///< or when it was accepted
    Instant deadline = never;          ///< of half a request, or of unread answers
};

/// Identifies a connection for the life of the server: its place in the lower 32 bits, a count of the place's users in the upper.
using ConnectionToken = std::uint64_t;

/// The server, as a connection sees it.
struct ConnectionHost {
    [[nodiscard]] virtual Instant now() const = 0;
    [[nodiscard]] virtual ConnectionTimes& times(ConnectionToken token) = 0;
    /// The connection can continue; the server calls resume() soon, but not from inside this call.
    virtual void ready(ConnectionToken token) = 0;
    /// The connection is closed. It is destroyed later, not from inside this call.
    virtual void closed(ConnectionToken token) = 0;
    virtual ~ConnectionHost() = default;

    Duration partial_timeout{};
    Duration stall_timeout{};
    AnswerBuffer scratch;
};

class Connection final : private SessionWaker {
public:
    /// Owns `fd`, a connected non-blocking socket that `poller` watches for EPOLLIN under `token`.
    Connection(int fd, Poller& poller, ConnectionHost& host, Responder& responder, ConnectionToken token, std::string who);
    ~Connection() override;
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    void on_ready(std::uint32_t events);
    void resume();
    /// Closes now. Outstanding writes continue. `why` is counted if it is not nullptr.
    void close(Counter* why = nullptr);

    [[nodiscard]] ConnectionToken token() const noexcept { return token_; }
    [[nodiscard]] bool commands_now(const Image& image) const { return session_.commands_now(image); }
    /// It has sent at least one whole request.
    [[nodiscard]] const std::string& peer() const noexcept { return session_.who(); }
    [[nodiscard]] std::uint64_t requests() const noexcept { return session_.requests(); }
    [[nodiscard]] std::uint64_t writes() const noexcept { return session_.writes(); }
    [[nodiscard]] std::uint64_t exceptions() const noexcept { return session_.exceptions(); }
    [[nodiscard]] bool has_commanded() const noexcept { return session_.has_commanded(); }
    /// The last bytes were half a request.
    [[nodiscard]] bool holds_half() const noexcept { return had_partial_; }
    [[nodiscard]] bool has_asked() const noexcept { return session_.requests() > 0; }
    /// The reason why it stands still, for closing it at its deadline.
    [[nodiscard]] bool has_unsent() const noexcept { return !backlog_.empty(); }

private:
    void wake(Session& session) override;
    void read();
    void write();
    void pump();
    [[nodiscard]] bool send();
    void watch(std::uint64_t requests_before, Session::Work work, Instant now);
    void choose_events();

    int fd_;
    Poller& poller_;
    ConnectionHost& host_;
    Counters& counters_;
    ConnectionToken token_;
    std::uint32_t events_;
    bool ended_ = false;     // the client will send nothing more
    bool resuming_ = false;  // ready() was called and resume() was not
    bool had_partial_ = false;
    std::vector<std::uint8_t> backlog_;  // bytes that the socket did not accept
    std::size_t sent_ = 0;               // of it
    Session session_;
};

}  // namespace axisgate::modbus
