// One live-feed client: moves bytes between its socket, the codec and its queue in the hub. One write at a time, of many frames together.
// Bounds: message size, time for a write, silence, time for the closing handshake (Settings); those of the queue.
#pragma once

#include <array>
#include <boost/asio/steady_timer.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gateway/doors/http/session.hpp"
#include "gateway/doors/http/websocket_codec.hpp"

namespace axisgate::http {

class WebSocketSession final : public Session, public std::enable_shared_from_this<WebSocketSession> {
public:
    /// `opened_by` is the handshake; when its session or token is not valid any more, the feed is closed with 1008 (checked every
    /// `right_period`).
    WebSocketSession(Transport socket, std::shared_ptr<SessionHost> host, Request opened_by, PlaceHolder holder);
    ~WebSocketSession() override;

    /// `early`: bytes that arrived with the handshake.
    void start(std::span<const std::uint8_t> early);
    [[nodiscard]] Guest guest() const override { return {holder_, Standing::knowns_work, Instant{received_.time_since_epoch()}}; }
    void stop() override;
    void abort() override;

private:
    using ErrorCode = boost::system::error_code;

    void read();
    void take(std::span<const std::uint8_t> bytes);
    void begin_close(std::uint16_t code, std::string_view reason);
    void pump();
    void on_written(ErrorCode ec, std::size_t bytes);
    [[nodiscard]] SteadyTime close_due() const;
    void arm();
    void on_timer();
    void finish();
    void close();

    Transport socket_;
    std::shared_ptr<SessionHost> host_;
    Request opened_by_;
    PlaceHolder holder_;
    boost::asio::steady_timer timer_;
    std::shared_ptr<StreamClient> client_;
    WebSocketParser parser_;
    std::array<std::uint8_t, 8192> buffer_{};
    std::vector<SharedFrame> batch_;  ///< being written
    SteadyTime received_{}, pinged_{}, looked_{}, write_began_{}, close_began_{};
    std::optional<Origin> commander_;  ///< the client for set-points; empty: its user may not command
    bool commander_known_ = false;
    bool writing_ = false;
    bool closing_ = false;  ///< a close frame is in the queue or was sent
    bool close_received_ = false;
    bool finished_ = false;  ///< our side of the stream is closed
    bool closed_ = false;
};

}  // namespace axisgate::http
