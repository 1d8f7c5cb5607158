// Wire of the UIM342: the abstract message (ID, CW, DL, d0..d7) and its place in a 29-bit CAN frame ("SimpleCAN3.0").
// In: CAN frames or messages. Out: the other of the two; numbers out of data bytes; status words taken apart.
// Never has state, never decides what an answer means for an axis. Allocates nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "gateway/core/frame.hpp"

namespace axisgate::uim342 {

inline constexpr std::uint8_t host_id = 4;     ///< the one producer that the manual gives to a master [L676]
inline constexpr std::uint8_t global_id = 0;   ///< every device listens [L520]
inline constexpr std::uint8_t first_node = 5;  ///< nodes and groups: 5..126 [L1056, L1057]
inline constexpr std::uint8_t last_node = 126;
inline constexpr std::uint8_t ack_bit = 0x80;  ///< in an instruction: an answer is wanted [L526]

/// Control words without the acknowledge bit [L258-287].
namespace cw {
inline constexpr std::uint8_t PP = 0x01, IC = 0x06, IE = 0x07, ML = 0x0B, SN = 0x0C, ER = 0x0F, MT = 0x10, MS = 0x11, MO = 0x15, BG = 0x16,
                              ST = 0x17, MF = 0x18, AC = 0x19, DC = 0x1A, SS = 0x1B, SD = 0x1C, JV = 0x1D, SP = 0x1E, PR = 0x1F, PA = 0x20,
                              OG = 0x21, BL = 0x2D, DV = 0x2E, IL = 0x34, TG = 0x35, DI = 0x37, QE = 0x3D, RT = 0x5A, SY = 0x7E;
}  // namespace cw

/// One message in either direction. To a device `id` is the consumer (node, group or 0), from a device the producer.
struct Message {
    std::uint8_t id = 0;
    std::uint8_t cw = 0;  ///< with the acknowledge bit
    std::uint8_t dl = 0;  ///< 0..8
    std::array<std::uint8_t, 8> d{};

    [[nodiscard]] std::uint8_t function() const noexcept { return cw & 0x7F; }
    [[nodiscard]] bool wants_ack() const noexcept { return cw & ack_bit; }
    [[nodiscard]] std::span<const std::uint8_t> data() const noexcept { return {d.data(), dl}; }
    bool operator==(const Message&) const = default;
};

/// A message with these data bytes; more than 8 are dropped.
[[nodiscard]] Message message(std::uint8_t id, std::uint8_t cw, std::span<const std::uint8_t> data = {}) noexcept;

// --- numbers in data bytes: least significant byte first [L532] ---------------------------------------------------------

/// `width` 0..8 bytes, without a sign.
[[nodiscard]] std::uint64_t get_uint(const std::uint8_t* p, unsigned width) noexcept;
[[nodiscard]] std::uint16_t get_u16(const std::uint8_t* p) noexcept;
[[nodiscard]] std::int32_t get_i24(const std::uint8_t* p) noexcept;
[[nodiscard]] std::uint32_t get_u32(const std::uint8_t* p) noexcept;
[[nodiscard]] std::int32_t get_i32(const std::uint8_t* p) noexcept;
void put_uint(std::uint8_t* p, unsigned width, std::uint64_t v) noexcept;
void put_u16(std::uint8_t* p, std::uint16_t v) noexcept;

// --- CAN identifier [L623-690] ------------------------------------------------------------------------------------------

/// 29-bit identifier: bits 4:0 of both IDs stand in the SID, bits 6:5 in the EID.
[[nodiscard]] constexpr std::uint32_t can_id(std::uint8_t producer, std::uint8_t consumer, std::uint8_t cw) noexcept {
    const std::uint32_t sid = (producer & 0x1Fu) << 6 | (consumer & 0x1Fu) << 1;
    const std::uint32_t eid = (producer >> 5 & 3u) << 16 | (consumer >> 5 & 3u) << 14 | cw;
    return sid << 18 | eid;
}
[[nodiscard]] constexpr std::uint8_t producer_of(std::uint32_t id) noexcept {
    return static_cast<std::uint8_t>((id >> 24 & 0x1F) | (id >> 16 & 3) << 5);
}
[[nodiscard]] constexpr std::uint8_t consumer_of(std::uint32_t id) noexcept {
    return static_cast<std::uint8_t>((id >> 19 & 0x1F) | (id >> 14 & 3) << 5);
}
/// Bit 18 (SID 0) and bits 13..8 are reserved and 0 [L669-678].
inline constexpr std::uint32_t can_id_reserved = 1u << 18 | 0x3F00u;

/// An instruction as a CAN frame; DLC = DL, no padding.
[[nodiscard]] Frame to_can(const Message& m, std::uint8_t producer = host_id) noexcept;

struct CanMessage {
    std::uint8_t producer = 0;
    std::uint8_t consumer = 0;
    Message message;  ///< `id` is the producer
};
/// Nothing if it is not a SimpleCAN frame (base format, remote, reserved bits set, controller report).
[[nodiscard]] std::optional<CanMessage> from_can(const Frame& f) noexcept;

// --- status ---------------------------------------------------------------------------------------------------------------

/// MS[0] [L869-922].
struct Status {
    std::uint8_t mode = 0;  ///< 0 JOG, 1 PTP
    bool on = false;        ///< SON
    bool in1 = false, in2 = false, in3 = false, op1 = false;
    bool stop = false;  ///< stationary
    bool paif = false;  ///< in position
    bool tlif = false;  ///< stall detected
    bool lock = false;  ///< system locked
    bool err = false;   ///< system error
    std::int32_t relative_position = 0;
    std::uint32_t raw = 0;  ///< d1 | d2 << 8 | d3 << 16: what AxisFeedback::native_status holds
};
[[nodiscard]] Status status_of(const Message& ms0) noexcept;

/// What RT (CW 5A) tells [L577-607].
struct Notification {
    enum class Kind : std::uint8_t { unknown, alarm, input, finished };
    Kind kind = Kind::unknown;
    std::uint8_t code = 0;      ///< alarm: d1; else d0
    std::uint8_t input = 0;     ///< input: 1..3
    bool rising = false;        ///< input
    bool has_position = false;  ///< finished: d4..d7 were there
    std::int32_t position = 0;  ///< finished, pulses
};
/// d0 is read first and d1 only where it must be there: an input event has one byte on CAN.
[[nodiscard]] Notification notification_of(const Message& rt) noexcept;

// --- words ----------------------------------------------------------------------------------------------------------------

/// "data error" for 0x33 ...; "an error that the manual does not name" for codes it leaves free [L560-567].
[[nodiscard]] std::string_view error_text(std::uint8_t code) noexcept;
/// "motor stall" for 0x1D ... [L593-606]; empty if unknown.
[[nodiscard]] std::string_view alarm_text(std::uint8_t code) noexcept;

/// Model by ML's d0..d2 [L1143-1148]: "UIM342C02". Empty: none of this family. `gateway`: it is one of the makers' gateways.
struct Model {
    std::string_view name;
    bool gateway = false;
};
[[nodiscard]] Model model_of(const Message& ml) noexcept;

}  // namespace axisgate::uim342
