// The server's side of RFC 6455 as pure functions of bytes: handshake answer, frames in, frames out. A library's stream is not used,
// because one prepared frame can be shared by all clients and many frames are sent in one write; the tests check it with an independent
// client.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace axisgate::http {

/// Close codes of RFC 6455 7.4.1 that this door uses.
inline constexpr std::uint16_t close_normal = 1000, close_going_away = 1001, close_protocol_error = 1002, close_unsupported = 1003,
                               close_no_status = 1005, close_not_utf8 = 1007, close_policy = 1008, close_too_big = 1009,
                               close_try_later = 1013;

/// True if this is base64 of 16 bytes, as Sec-WebSocket-Key must be.
[[nodiscard]] bool is_handshake_key(std::string_view key) noexcept;
/// Sec-WebSocket-Accept for a Sec-WebSocket-Key (RFC 6455 4.2.2).
[[nodiscard]] std::string handshake_accept(std::string_view key);

enum class Opcode : std::uint8_t { continuation = 0, text = 1, binary = 2, close = 8, ping = 9, pong = 10 };

/// One whole unmasked frame, as a server sends it.
[[nodiscard]] std::string server_frame(Opcode opcode, std::string_view payload);
/// A close frame; the reason is cut at 123 bytes, at a character's boundary.
[[nodiscard]] std::string close_frame(std::uint16_t code, std::string_view reason);

struct WebSocketMessage {
    enum class Kind : std::uint8_t { text, ping, pong, close };
    Kind kind = Kind::text;
    std::string payload;     ///< of close: the reason
    std::uint16_t code = 0;  ///< of close: the client's code, or 1005 if it gave none
};

struct WebSocketFault {
    std::uint16_t code;
    std::string_view text;
};

class WebSocketParser {
public:
    /// `max_message`: bytes of one message, over all its fragments; beyond: 1009.
    explicit WebSocketParser(std::size_t max_message) : max_message_(max_message) {}

    /// Takes bytes and adds the completed messages to `out`. On a fault: its close code; nothing is taken after it, nor after a close
    /// frame. Binary messages are a fault here (1003), because this door uses JSON.
    [[nodiscard]] std::optional<WebSocketFault> take(std::span<const std::uint8_t> bytes, std::vector<WebSocketMessage>& out);

private:
    [[nodiscard]] std::optional<WebSocketFault> header_done();
    [[nodiscard]] std::optional<WebSocketFault> frame_done(std::vector<WebSocketMessage>& out);

    std::size_t max_message_;
    std::vector<std::uint8_t> header_;  // of the present frame, at most 14 bytes
    std::uint64_t payload_left_ = 0;
    std::size_t payload_at_ = 0;  // position within the mask
    std::string control_;         // payload of a control frame
    std::string message_;         // payload of a data message, over its fragments
    Opcode opcode_ = Opcode::text;
    bool in_payload_ = false;
    bool final_ = false;
    bool in_message_ = false;  // a message was begun and is not complete
    bool ended_ = false;
    std::uint8_t mask_[4] = {};
};

}  // namespace axisgate::http
