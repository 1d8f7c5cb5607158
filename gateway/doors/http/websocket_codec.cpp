// Section numbers are those of RFC 6455. Reading stops at the first fault.
#include "gateway/doors/http/websocket_codec.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "gateway/doors/http/text.hpp"

namespace axisgate::http {
namespace {

constexpr std::string_view base64_digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string base64(std::span<const std::uint8_t> bytes) {
    std::string out;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t n = std::uint32_t{bytes[i]} << 16;
        if (i + 1 < bytes.size()) n |= std::uint32_t{bytes[i + 1]} << 8;
        if (i + 2 < bytes.size()) n |= bytes[i + 2];
        out += base64_digits[n >> 18];
        out += base64_digits[(n >> 12) & 63];
        out += i + 1 < bytes.size() ? base64_digits[(n >> 6) & 63] : '=';
        out += i + 2 < bytes.size() ? base64_digits[n & 63] : '=';
    }
    return out;
}

/// SHA-1 (FIPS 180-4 6.1): required by the handshake, no secret depends on it.
std::array<std::uint8_t, 20> sha1(std::string_view text) {
    std::vector<std::uint8_t> m(text.begin(), text.end());
    const std::uint64_t bits = std::uint64_t{m.size()} * 8;
    m.push_back(0x80);
    while (m.size() % 64 != 56)
        m.push_back(0);
    for (int shift = 56; shift >= 0; shift -= 8)
        m.push_back(static_cast<std::uint8_t>(bits >> shift));
    std::array<std::uint32_t, 5> h{0x67452301, 0xEFCDAB89, 0x98BADCFE, 0x10325476, 0xC3D2E1F0};
    for (std::size_t block = 0; block < m.size(); block += 64) {
        std::array<std::uint32_t, 80> w{};
        for (std::size_t i = 0; i < 16; ++i) {
            const std::size_t at = block + i * 4;
            w[i] = std::uint32_t{m[at]} << 24 | std::uint32_t{m[at + 1]} << 16 | std::uint32_t{m[at + 2]} << 8 | m[at + 3];
        }
        for (std::size_t i = 16; i < 80; ++i)
            w[i] = std::rotl(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
        auto [a, b, c, d, e] = h;
        for (std::size_t i = 0; i < 80; ++i) {
            std::uint32_t f = b ^ c ^ d, k = i < 40 ? 0x6ED9EBA1u : 0xCA62C1D6u;
            if (i < 20) {
                f = (b & c) | (~b & d);
                k = 0x5A827999;
            } else if (i >= 40 && i < 60) {
                f = (b & c) | (b & d) | (c & d);
                k = 0x8F1BBCDC;
            }
            const std::uint32_t next = std::rotl(a, 5) + f + e + k + w[i];
            e = d;
            d = c;
            c = std::rotl(b, 30);
            b = a;
            a = next;
        }
        h = {h[0] + a, h[1] + b, h[2] + c, h[3] + d, h[4] + e};
    }
    std::array<std::uint8_t, 20> out{};
    for (std::size_t i = 0; i < 20; ++i)
        out[i] = static_cast<std::uint8_t>(h[i / 4] >> (24 - 8 * (i % 4)));
    return out;
}

constexpr bool is_control(Opcode o) noexcept { return static_cast<std::uint8_t>(o) >= 8; }

/// Codes that may occur in a close frame (7.4).
constexpr bool is_close_code(unsigned code) noexcept {
    return (code >= 1000 && code <= 1003) || (code >= 1007 && code <= 1014) || (code >= 3000 && code <= 4999);
}
}  // namespace

bool is_handshake_key(std::string_view key) noexcept {
    if (key.size() != 24 || !key.ends_with("==")) return false;
    return std::ranges::all_of(key.substr(0, 22), [](char c) { return base64_digits.find(c) != std::string_view::npos; });
}

std::string handshake_accept(std::string_view key) { return base64(sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11")); }

std::string server_frame(Opcode opcode, std::string_view payload) {
    std::string out;
    out.reserve(payload.size() + 10);
    out += static_cast<char>(0x80u | static_cast<unsigned>(opcode));
    if (payload.size() < 126) {
        out += static_cast<char>(payload.size());
    } else if (payload.size() <= 0xFFFF) {
        out += static_cast<char>(126);
        for (int shift = 8; shift >= 0; shift -= 8)
            out += static_cast<char>((payload.size() >> shift) & 0xFF);
    } else {
        out += static_cast<char>(127);
        for (int shift = 56; shift >= 0; shift -= 8)
            out += static_cast<char>((std::uint64_t{payload.size()} >> shift) & 0xFF);
    }
    out += payload;
    return out;
}

std::string close_frame(std::uint16_t code, std::string_view reason) {
    if (code == close_no_status) return server_frame(Opcode::close, {});
    while (reason.size() > 123 || !is_utf8(reason))
        reason.remove_suffix(1);
    std::string payload;
    payload += static_cast<char>(code >> 8);
    payload += static_cast<char>(code & 0xFF);
    payload += reason;
    return server_frame(Opcode::close, payload);
}

std::optional<WebSocketFault> WebSocketParser::take(std::span<const std::uint8_t> bytes, std::vector<WebSocketMessage>& out) {
    while (!ended_) {
        if (!in_payload_) {
            // Header: 2 bytes, then 0, 2 or 8 bytes of length, then 4 of mask (5.2).
            std::size_t need = 2;
            if (header_.size() >= 2) {
                const unsigned length = header_[1] & 0x7Fu;
                need = 2u + (length == 126 ? 2u : length == 127 ? 8u : 0u) + ((header_[1] & 0x80u) ? 4u : 0u);
            }
            if (header_.size() < need) {
                if (bytes.empty()) return std::nullopt;
                const std::size_t n = std::min(need - header_.size(), bytes.size());
                header_.insert(header_.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(n));
                bytes = bytes.subspan(n);
                continue;
            }
            if (const auto fault = header_done()) {
                ended_ = true;
                return fault;
            }
        }
        const auto n = static_cast<std::size_t>(std::min<std::uint64_t>(payload_left_, bytes.size()));
        std::string& into = is_control(opcode_) ? control_ : message_;
        for (std::size_t i = 0; i < n; ++i)
            into += static_cast<char>(bytes[i] ^ mask_[(payload_at_ + i) % 4]);
        payload_at_ += n;
        payload_left_ -= n;
        bytes = bytes.subspan(n);
        if (payload_left_ > 0) return std::nullopt;
        if (const auto fault = frame_done(out)) {
            ended_ = true;
            return fault;
        }
    }
    return std::nullopt;
}

std::optional<WebSocketFault> WebSocketParser::header_done() {
    const std::uint8_t first = header_[0], second = header_[1];
    const unsigned code = first & 0x0Fu;
    opcode_ = static_cast<Opcode>(code);
    const bool known = code <= 2 || (code >= 8 && code <= 10);
    if (first & 0x70u) return WebSocketFault{close_protocol_error, "reserved bits are set, but no extension was agreed"};
    if (!known) return WebSocketFault{close_protocol_error, "unknown opcode"};
    if (!(second & 0x80u)) return WebSocketFault{close_protocol_error, "a client's frames must be masked"};
    const bool final = (first & 0x80u) != 0;
    std::uint64_t length = second & 0x7Fu;
    std::size_t at = 2;
    if (length >= 126) {
        const std::size_t n = length == 126 ? 2 : 8;
        const std::uint64_t smallest = length == 126 ? 126 : 0x10000;
        length = 0;
        for (std::size_t i = 0; i < n; ++i)
            length = length << 8 | header_[at + i];
        at += n;
        if (length < smallest) return WebSocketFault{close_protocol_error, "the length is not in its shortest form"};
        if (length >> 63) return WebSocketFault{close_protocol_error, "the length's top bit is set"};
    }
    std::copy_n(header_.begin() + static_cast<std::ptrdiff_t>(at), 4, mask_);
    header_.clear();
    if (is_control(opcode_)) {
        if (!final) return WebSocketFault{close_protocol_error, "a control frame cannot be fragmented"};
        if (length > 125) return WebSocketFault{close_protocol_error, "a control frame has at most 125 bytes"};
        control_.clear();
    } else {
        if (opcode_ == Opcode::continuation && !in_message_)
            return WebSocketFault{close_protocol_error, "a continuation without a beginning"};
        if (opcode_ != Opcode::continuation && in_message_)
            return WebSocketFault{close_protocol_error, "a message begins inside another one"};
        if (opcode_ == Opcode::binary) return WebSocketFault{close_unsupported, "send text: this feed speaks JSON"};
        if (opcode_ == Opcode::text) message_.clear();
        if (length > max_message_ - message_.size()) return WebSocketFault{close_too_big, "the message is too long"};
        in_message_ = !final;
    }
    final_ = final;
    payload_left_ = length;
    payload_at_ = 0;
    in_payload_ = true;
    return std::nullopt;
}

std::optional<WebSocketFault> WebSocketParser::frame_done(std::vector<WebSocketMessage>& out) {
    in_payload_ = false;
    switch (opcode_) {
        case Opcode::ping:
            out.push_back({WebSocketMessage::Kind::ping, control_, 0});
            return std::nullopt;
        case Opcode::pong:
            out.push_back({WebSocketMessage::Kind::pong, control_, 0});
            return std::nullopt;
        case Opcode::close: {
            WebSocketMessage m{WebSocketMessage::Kind::close, {}, close_no_status};
            if (control_.size() == 1) return WebSocketFault{close_protocol_error, "a close code has two bytes"};
            if (control_.size() >= 2) {
                const unsigned code =
                    static_cast<unsigned>(static_cast<std::uint8_t>(control_[0])) << 8 | static_cast<std::uint8_t>(control_[1]);
                if (!is_close_code(code)) return WebSocketFault{close_protocol_error, "this close code cannot be sent"};
                m.code = static_cast<std::uint16_t>(code);
                m.payload = control_.substr(2);
                if (!is_utf8(m.payload)) return WebSocketFault{close_not_utf8, "the close reason is not UTF-8"};
            }
            out.push_back(std::move(m));
            ended_ = true;
            return std::nullopt;
        }
        case Opcode::continuation:
        case Opcode::text:
        case Opcode::binary:
            break;
    }
    if (!final_) return std::nullopt;
    if (!is_utf8(message_)) return WebSocketFault{close_not_utf8, "the message is not UTF-8"};
    out.push_back({WebSocketMessage::Kind::text, std::move(message_), 0});
    message_.clear();
    return std::nullopt;
}

}  // namespace axisgate::http
