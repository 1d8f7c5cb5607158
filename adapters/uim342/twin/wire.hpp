// The twin's own reading of the UIM342 wire: SimpleCAN 3.0 identifiers, 16-byte UIMessages and their CRC.
// In: CAN frames, runs of bytes, telegrams to send. Out: telegrams, frames.
// Never knows what a telegram means, and shares nothing with the adapter's packing code: it is a second reading of the manual.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "gateway/core/frame.hpp"

namespace axisgate::uim342::twin {

inline constexpr std::uint8_t host_id = 4;    ///< the only master that the manual names [L676]
inline constexpr std::uint8_t global_id = 0;  ///< heard by every device [L399]

/// One abstract message of section 2.1: `ID CW DL d0..d7` [L516-532].
struct Telegram {
    std::uint8_t producer = host_id;
    std::uint8_t consumer = global_id;
    std::uint8_t cw = 0;  ///< bits 6:0 function, bit 7 in an instruction: an acknowledgement is wanted
    std::uint8_t dl = 0;  ///< number of valid data bytes; on a byte line 9..255 can arrive and is a syntax error
    std::array<std::uint8_t, 8> d{};

    [[nodiscard]] std::uint8_t function() const noexcept { return cw & 0x7F; }
    [[nodiscard]] bool wants_ack() const noexcept { return (cw & 0x80) != 0; }
};

/// How a telegram crossed a byte line. An answer goes back in the form of its question.
enum class Form : std::uint8_t {
    crc12,  ///< AA ... CC, CRC over the 12 bytes ID..d8: what the maker's own gateways do
    crc13,  ///< AA ... CC, CRC over the 13 bytes AA..d8: what the manual's text says [L753, L1730]
    plain   ///< AD ... 00 00 CC, without a CRC [L749]
};

/// Which CRC ranges are taken as good.
enum class CrcRange : std::uint8_t { twelve, thirteen, automatic };
/// "12", "13", "auto"; nothing for other texts.
[[nodiscard]] std::optional<CrcRange> crc_range_named(std::string_view text) noexcept;

/// CRC-16/MODBUS: reflected polynomial A001h, start FFFFh, no final exclusive-or [L1704, L1730-1760].
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> data) noexcept;

/// 29-bit identifier: producer 4:0 in bits 28..24, consumer 4:0 in 23..19, producer 6:5 in 17..16, consumer 6:5 in 15..14, CW in 7..0
/// [L669-678].
[[nodiscard]] constexpr std::uint32_t can_id(std::uint8_t producer, std::uint8_t consumer, std::uint8_t cw) noexcept {
    const std::uint32_t p = producer;
    const std::uint32_t c = consumer;
    return ((p & 0x1Fu) << 24) | ((c & 0x1Fu) << 19) | ((p & 0x60u) << 11) | ((c & 0x60u) << 9) | cw;
}
/// Consumer of an identifier.
[[nodiscard]] constexpr std::uint8_t consumer_of(std::uint32_t id) noexcept {
    return static_cast<std::uint8_t>(((id >> 19) & 0x1Fu) | ((id >> 9) & 0x60u));
}

/// The telegram of a CAN frame; nothing for base frames, remote frames, controller reports, and set reserved bits (18, 13..8).
[[nodiscard]] std::optional<Telegram> read_can(const Frame& frame) noexcept;
[[nodiscard]] Frame write_can(const Telegram& telegram) noexcept;

/// A whole UIMessage. The ID byte is the producer, because only a device writes here.
[[nodiscard]] std::array<std::uint8_t, 16> write_message(const Telegram& telegram, Form form) noexcept;

/// Finds UIMessages in a byte stream by position: start byte at 0, end byte at 15, CRC where there is one; on failure it slides by
/// one byte, because AA, AD and CC may be data too. Garbage before a message never costs the message.
/// Holds at most 15 bytes of an unfinished message, without a time limit.
class MessageReader {
public:
    explicit MessageReader(CrcRange range) noexcept : range_(range) {}

    void reset() noexcept { held_ = 0; }
    [[nodiscard]] std::size_t held() const noexcept { return held_; }

    /// Calls `got(const Telegram&, Form)` for each message, in order. The ID byte is the consumer, because a host wrote it.
    template <class F>
    void feed(std::span<const std::uint8_t> bytes, F&& got) {
        while (!bytes.empty()) {
            if (held_ == 0) {  // the usual case: whole messages, read in place
                while (bytes.size() >= size) {
                    Form form{};
                    if (good(bytes.data(), form)) {
                        got(telegram_of(bytes.data()), form);
                        bytes = bytes.subspan(size);
                    } else {
                        bytes = bytes.subspan(1);
                    }
                }
            }
            while (!bytes.empty()) {
                window_[held_++] = bytes.front();
                bytes = bytes.subspan(1);
                if (held_ < size) continue;
                Form form{};
                if (good(window_.data(), form)) {
                    held_ = 0;
                    got(telegram_of(window_.data()), form);
                    break;  // in step again: read the rest in place
                }
                slide();
            }
        }
    }

private:
    static constexpr std::size_t size = 16;
    [[nodiscard]] bool good(const std::uint8_t* m, Form& form) const noexcept;
    [[nodiscard]] static Telegram telegram_of(const std::uint8_t* m) noexcept;
    void slide() noexcept;  // drops bytes up to the next possible start

    CrcRange range_;
    std::array<std::uint8_t, size> window_{};
    std::size_t held_ = 0;
};

}  // namespace axisgate::uim342::twin
