// The WebSocket codec against golden bytes of RFC 6455 and every way to break it.
#include "gateway/doors/http/websocket_codec.hpp"

#include <gtest/gtest.h>

namespace axisgate::http {
namespace {
using Kind = WebSocketMessage::Kind;

std::string masked(std::uint8_t first, std::string_view payload, std::size_t claim = SIZE_MAX) {
    const std::size_t n = claim == SIZE_MAX ? payload.size() : claim;
    std::string s;
    s += static_cast<char>(first);
    if (n < 126) {
        s += static_cast<char>(0x80 | n);
    } else if (n <= 0xFFFF) {
        s += static_cast<char>(0x80 | 126);
        s += static_cast<char>(n >> 8);
        s += static_cast<char>(n & 0xFF);
    } else {
        s += static_cast<char>(0x80 | 127);
        for (int shift = 56; shift >= 0; shift -= 8)
            s += static_cast<char>((std::uint64_t{n} >> shift) & 0xFF);
    }
    const unsigned char mask[4] = {0x37, 0xFA, 0x21, 0x3D};
    for (const auto m : mask)
        s += static_cast<char>(m);
    for (std::size_t i = 0; i < payload.size(); ++i)
        s += static_cast<char>(static_cast<unsigned char>(payload[i]) ^ mask[i % 4]);
    return s;
}

struct Taken {
    std::vector<WebSocketMessage> messages;
    std::optional<WebSocketFault> fault;
};
Taken take(std::string_view bytes, std::size_t piece = SIZE_MAX, std::size_t max_message = 1000) {
    WebSocketParser parser(max_message);
    Taken t;
    while (!bytes.empty()) {
        const auto part = bytes.substr(0, piece);
        bytes.remove_prefix(part.size());
        const auto fault = parser.take({reinterpret_cast<const std::uint8_t*>(part.data()), part.size()}, t.messages);
        if (fault) {
            EXPECT_FALSE(t.fault) << "a fault is told once";
            t.fault = fault;
        }
    }
    return t;
}

TEST(WebSocketCodec, HandshakeOfTheStandard) {
    EXPECT_EQ(handshake_accept("dGhlIHNhbXBsZSBub25jZQ=="), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");  // RFC 6455 1.3
    EXPECT_TRUE(is_handshake_key("dGhlIHNhbXBsZSBub25jZQ=="));
    for (const auto* bad :
         {"", "dGhlIHNhbXBsZSBub25jZQ", "dGhlIHNhbXBsZSBub25jZQ==x", "dGhl HNhbXBsZSBub25jZQ==", "dGhlIHNhbXBsZSBub25jZQ=A"}) {
        EXPECT_FALSE(is_handshake_key(bad)) << bad;
    }
}

TEST(WebSocketCodec, GoldenFramesOfTheStandard) {
    const std::string hello("\x81\x85\x37\xfa\x21\x3d\x7f\x9f\x4d\x51\x58", 11);  // RFC 6455 5.7
    for (const std::size_t piece : {SIZE_MAX, std::size_t{1}, std::size_t{3}}) {
        const auto t = take(hello, piece);
        ASSERT_EQ(t.messages.size(), 1u);
        EXPECT_EQ(t.messages[0].kind, Kind::text);
        EXPECT_EQ(t.messages[0].payload, "Hello");
        EXPECT_FALSE(t.fault);
    }
    EXPECT_EQ(server_frame(Opcode::text, "Hello"), std::string("\x81\x05Hello", 7));
    EXPECT_EQ(server_frame(Opcode::pong, "Hello"), std::string("\x8a\x05Hello", 7));
    EXPECT_EQ(server_frame(Opcode::text, std::string(256, 'x')).substr(0, 4), std::string("\x81\x7e\x01\x00", 4));
    EXPECT_EQ(server_frame(Opcode::text, std::string(65536, 'x')).substr(0, 10),
              std::string("\x81\x7f\x00\x00\x00\x00\x00\x01\x00\x00", 10));
}

TEST(WebSocketCodec, CloseFrames) {
    EXPECT_EQ(close_frame(1013, "slow"), std::string("\x88\x06\x03\xf5slow", 8));
    EXPECT_EQ(close_frame(close_no_status, "ignored"), std::string("\x88\x00", 2));
    std::string long_reason(122, 'x');
    long_reason += "\xC3\xA4\xC3\xA4";
    EXPECT_EQ(close_frame(1000, long_reason).size(), 2u + 2u + 122u) << "cut before the character that does not fit";
}

TEST(WebSocketCodec, FragmentsWithAPingBetween) {
    const std::string bytes = masked(0x01, "Hel") + masked(0x89, "ping!") + masked(0x00, "") + masked(0x80, "lo") + masked(0x81, "next");
    for (const std::size_t piece : {SIZE_MAX, std::size_t{1}}) {
        const auto t = take(bytes, piece);
        ASSERT_EQ(t.messages.size(), 3u);
        EXPECT_EQ(t.messages[0].kind, Kind::ping);
        EXPECT_EQ(t.messages[0].payload, "ping!");
        EXPECT_EQ(t.messages[1].payload, "Hello");
        EXPECT_EQ(t.messages[2].payload, "next");
        EXPECT_FALSE(t.fault);
    }
}

TEST(WebSocketCodec, CloseCodesOfClients) {
    const auto closed = [](std::string_view payload) { return take(masked(0x88, payload)); };
    EXPECT_EQ(closed("").messages.at(0).code, close_no_status);
    EXPECT_EQ(closed(std::string("\x03\xe8"
                                 "bye",
                                 5))
                  .messages.at(0)
                  .code,
              1000);
    EXPECT_EQ(closed(std::string("\x03\xe8"
                                 "bye",
                                 5))
                  .messages.at(0)
                  .payload,
              "bye");
    EXPECT_EQ(closed(std::string("\x0f\xa0", 2)).messages.at(0).code, 4000);
    for (const auto& bad : {std::string("\x03", 1), std::string("\x03\xed", 2), std::string("\x03\xee", 2), std::string("\x03\xe7", 2),
                            std::string("\x07\xd0", 2), std::string("\x13\x88", 2)}) {
        ASSERT_TRUE(closed(bad).fault);
        EXPECT_EQ(closed(bad).fault->code, close_protocol_error);
    }
    EXPECT_EQ(closed(std::string("\x03\xe8\xff", 3)).fault->code, close_not_utf8);
    EXPECT_EQ(take(masked(0x88, "") + masked(0x81, "late")).messages.size(), 1u) << "nothing counts after a close";
}

TEST(WebSocketCodec, Faults) {
    struct Row {
        const char* what;
        std::string bytes;
        std::uint16_t code;
    };
    std::string unmasked("\x81\x05Hello", 7);
    std::string long_form = masked(0x81, "abc");
    long_form = std::string("\x81\xfe\x00\x03", 4) + long_form.substr(2);
    std::string top_bit("\x81\xff\x80\x00\x00\x00\x00\x00\x00\x00\x01\x02\x03\x04", 14);
    for (const auto& [what, bytes, code] :
         std::vector<Row>{{"not masked", unmasked, 1002},
                          {"reserved bit", masked(0xC1, "x"), 1002},
                          {"unknown opcode 3", masked(0x83, "x"), 1002},
                          {"unknown opcode 11", masked(0x8B, "x"), 1002},
                          {"binary", masked(0x82, "x"), 1003},
                          {"fragmented ping", masked(0x09, "x"), 1002},
                          {"ping of 126 bytes", masked(0x89, std::string(126, 'x')), 1002},
                          {"continuation first", masked(0x80, "x"), 1002},
                          {"message in message", masked(0x01, "x") + masked(0x81, "y"), 1002},
                          {"long form of a short length", long_form, 1002},
                          {"top bit of the length", top_bit, 1002},
                          {"too long", masked(0x81, "", 1001), 1009},
                          {"too long in pieces", masked(0x01, std::string(600, 'x')) + masked(0x80, "", 401), 1009},
                          {"far too long", masked(0x81, "", 0x7FFFFFFFFFFF), 1009},
                          {"not UTF-8", masked(0x81, "a\xFF"), 1007},
                          {"half a character", masked(0x01, "\xC3") + masked(0x80, ""), 1007}}) {
        for (const std::size_t piece : {SIZE_MAX, std::size_t{1}}) {
            const auto t = take(bytes, piece);
            ASSERT_TRUE(t.fault) << what;
            EXPECT_EQ(t.fault->code, code) << what;
            EXPECT_TRUE(t.messages.empty()) << what;
        }
    }
    EXPECT_FALSE(take(masked(0x01, "\xC3") + masked(0x80, "\xA4")).fault) << "a character may be split over fragments";
    EXPECT_FALSE(take(masked(0x81, std::string(1000, 'x'))).fault) << "exactly the bound is good";
}
}  // namespace
}  // namespace axisgate::http
