// RtuReceiver finds Modbus RTU frames in the bytes of a serial line. A frame ends with a silence of t3.5 (above 19200 bit/s 1.75 ms, as
// specified) and counts if its checksum is correct; everything else is counted and dropped. A run of more than 256 bytes is dropped.
// Address and function are not examined; no memory is allocated.
// Two deviations from the specification:
// t1.5: a pause of more than 1.5 characters within a frame does not invalidate it. A process receives bytes in runs from the kernel, and
// cannot distinguish such a pause from its own delay. The pause is counted.
// Late calls: bytes that arrive after the deadline, but before on_silence() was called, belong to the previous frame unless that is
// complete; in that case this thread was late.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "gateway/core/counter.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::modbus {

/// CRC-16 of Modbus: polynomial 0xA001 (reflected), initial value 0xFFFF; sent low byte first.
[[nodiscard]] std::uint16_t rtu_crc(std::span<const std::uint8_t> bytes) noexcept;

inline constexpr std::size_t rtu_max_frame = 256;  ///< address, PDU of at most 253 bytes, checksum
inline constexpr std::size_t rtu_min_frame = 4;    ///< address, function, checksum

struct RtuTiming {
    Duration character{};  ///< one byte on the line, including start and stop bits
    Duration t15{};        ///< longest pause between two bytes of a frame
    Duration t35{};        ///< shortest pause between two frames
    /// `baud` in bit/s, at least 1; `bits_per_byte` 10..12.
    [[nodiscard]] static RtuTiming of(std::uint32_t baud, unsigned bits_per_byte) noexcept;
};

/// A frame with a correct checksum.
struct RtuFrame {
    std::uint8_t address = 0;
    std::uint8_t size = 0;  ///< of the PDU, 1..253
    std::array<std::uint8_t, 253> bytes;
    [[nodiscard]] std::span<const std::uint8_t> pdu() const noexcept { return std::span(bytes).first(size); }
};

/// Written by the receiving thread, read by any thread.
struct RtuReceiverCounters {
    Counter frames;      ///< with a correct checksum, for any address
    Counter bad_frames;  ///< ended by silence with a wrong checksum, or too short
    Counter overlong;    ///< more than 256 bytes without a silence
    Counter gaps;        ///< pauses of more than t1.5 within a frame
    Counter echoes;      ///< answers that the port's receiver has returned completely
};

class RtuReceiver {
public:
    explicit RtuReceiver(const RtuTiming& timing) noexcept : timing_(timing) {}

    /// Bytes in the order of the line; `at` is when the last one was seen, and never decreases. Returns a frame that had ended before them
    /// although on_silence() was not called.
    [[nodiscard]] std::optional<RtuFrame> feed(std::span<const std::uint8_t> bytes, Instant at) noexcept;
    /// When the silence will be long enough; never: no bytes wait for it.
    [[nodiscard]] Instant deadline() const noexcept;
    /// To be called at the deadline or later. Returns the frame that the silence has ended, if it is correct.
    [[nodiscard]] std::optional<RtuFrame> on_silence(Instant now) noexcept;
    /// A frame is being received.
    [[nodiscard]] bool busy() const noexcept { return size_ > 0 || overlong_ || matched_ > 0; }

    /// An answer is being sent. A two-wire port may return it; the echo is removed from the received bytes, and the receiver learns whether
    /// this port echoes. `repeats_request`: the answer equals its request (functions 5, 6, 8); on a port without echo, the same bytes may
    /// be a repeated request of the master.
    void sent(std::span<const std::uint8_t> adu, bool repeats_request, Instant now) noexcept;
    /// The port was opened again: the frame in progress is dropped, and it is unknown whether the port echoes.
    void reset() noexcept;

    [[nodiscard]] const RtuTiming& timing() const noexcept { return timing_; }
    [[nodiscard]] const RtuReceiverCounters& counters() const noexcept { return counters_; }

private:
    enum class Echo : std::uint8_t { unknown, absent, present };

    void put(std::uint8_t byte) noexcept;
    void no_echo() noexcept;
    [[nodiscard]] bool whole() const noexcept;
    [[nodiscard]] std::optional<RtuFrame> take() noexcept;

    RtuTiming timing_;
    RtuReceiverCounters counters_;
    std::array<std::uint8_t, rtu_max_frame> buffer_{};
    std::size_t size_ = 0;
    bool overlong_ = false;
    Instant last_{};
    // The expected echo; `matched_` bytes of it have arrived.
    std::array<std::uint8_t, rtu_max_frame> echo_bytes_{};
    std::size_t echo_size_ = 0;  // 0: no echo is expected
    std::size_t matched_ = 0;
    Instant echo_until_{};
    bool unechoed_ = false;  // no byte has arrived since the last answer
    Echo echo_ = Echo::unknown;
};

}  // namespace axisgate::modbus
