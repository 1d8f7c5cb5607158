// UIMessage: the 16-byte frame of the UIM2513 / UIM2523 / UIM2533 gateways, packed and found again in a byte stream.
// In: messages, or runs of bytes cut anywhere. Out: 16 bytes, or messages with the CRC range that proved them.
// Never holds more than one frame (16 bytes) and never searches for a start byte alone: AA, AD and CC may all be data.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string_view>

#include "adapters/uim342/wire.hpp"

namespace axisgate::uim342 {

/// Which bytes the CRC covers. The manual says 13 (AA to d8) [L753, L1730]; programs that talk to real gateways use 12 (ID to d8).
enum class CrcMode : std::uint8_t {
    twelve,     ///< ID to d8; the default
    thirteen,   ///< AA to d8
    automatic,  ///< both are taken until the first good frame, then that one
    none        ///< start byte AD, no CRC
};
/// "12", "13", "auto", "none".
[[nodiscard]] std::optional<CrcMode> crc_mode_named(std::string_view text) noexcept;
[[nodiscard]] std::string_view name_of(CrcMode mode) noexcept;

/// CRC-16/MODBUS: reflected polynomial A001, start FFFF [L1704].
[[nodiscard]] std::uint16_t crc16(std::span<const std::uint8_t> data) noexcept;

inline constexpr std::size_t uimessage_size = 16;
using UiBytes = std::array<std::uint8_t, uimessage_size>;

/// `automatic` is packed as `twelve`.
[[nodiscard]] UiBytes to_uimessage(const Message& m, CrcMode mode) noexcept;

/// What 16 bytes prove to be.
struct UiCheck {
    bool good = false;
    CrcMode proved = CrcMode::none;  ///< twelve, thirteen or none (an AD frame)
    Message message;
};
/// Start, end, length and CRC. AD frames are good only if `accept` is none: without a CRC sixteen bytes prove too little
/// to be mixed with frames that have one.
[[nodiscard]] UiCheck check_uimessage(const UiBytes& bytes, CrcMode accept) noexcept;

/// Finds frames by position: start byte at 0, end byte at 15, CRC between; on failure slides by one byte and tries again.
class UiFramer {
public:
    explicit UiFramer(CrcMode mode = CrcMode::twelve) noexcept : wanted_(mode), accept_(mode) {}

    /// Calls `f(const UiCheck&, const UiBytes&)` for each frame that the bytes complete and `junk(byte)` for each byte that
    /// belongs to none, in order.
    template <class F, class J>
    void push(std::span<const std::uint8_t> bytes, F&& f, J&& junk) {
        for (const std::uint8_t b : bytes) {
            if (fill_ == 0 && b != 0xAA && b != 0xAD) {
                junk(b);
                continue;
            }
            buffer_[fill_++] = b;
            while (fill_ == uimessage_size) {
                const UiCheck check = check_uimessage(buffer_, accept_);
                if (check.good) {
                    fill_ = 0;
                    if (accept_ == CrcMode::automatic) accept_ = check.proved;
                    f(check, buffer_);
                } else {
                    if (!other_ && buffer_[0] == 0xAA) {
                        if (const UiCheck with = check_uimessage(buffer_, CrcMode::automatic); with.good) other_ = with.proved;
                    }
                    slide(junk);
                }
            }
        }
    }
    /// Bytes of a frame that has not ended yet.
    [[nodiscard]] std::span<const std::uint8_t> pending() const noexcept { return {buffer_.data(), fill_}; }
    /// What is accepted now: for `automatic` the pinned range once a frame has proved one.
    [[nodiscard]] CrcMode accepting() const noexcept { return accept_; }
    /// The range of a CRC that was right, but is not the one that is accepted; nothing: none has been seen since `reset`.
    [[nodiscard]] std::optional<CrcMode> other_seen() const noexcept { return other_; }
    /// Forgets half a frame and what was pinned: the line was down.
    void reset() noexcept {
        fill_ = 0;
        accept_ = wanted_;
        other_.reset();
    }

private:
    /// Drops the first byte and everything up to the next possible start.
    template <class J>
    void slide(J&& junk) {
        std::size_t from = 1;
        while (from < fill_ && buffer_[from] != 0xAA && buffer_[from] != 0xAD)
            ++from;
        for (std::size_t i = 0; i < from; ++i)
            junk(buffer_[i]);
        fill_ -= from;
        std::memmove(buffer_.data(), buffer_.data() + from, fill_);
    }

    UiBytes buffer_{};
    std::size_t fill_ = 0;
    CrcMode wanted_;
    CrcMode accept_;
    std::optional<CrcMode> other_;
};

}  // namespace axisgate::uim342
