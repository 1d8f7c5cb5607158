// RTU receiver: cuts what a serial line carries into Modbus RTU frames: by silence, and by the checksum.
// In: bytes with the instant at which they were seen, the passing of time, what was sent. Out: good frames, and when it must be asked
// again. Never waits, never allocates, never looks at the address or the function. Bounds: 256 bytes; a longer run is thrown away whole.
//
// A frame ends with a silence of t3.5 (above 19200 bit/s 1.75 ms, as the specification says), and is one if its checksum is right. What is
// left of anything else is counted and forgotten: the next frame begins after the silence. Two manners that differ from the letter:
//   t1.5     a pause of more than 1.5 characters inside a frame does not spoil it: a process sees bytes when the kernel hands them on, in
//            runs, and cannot tell such a pause from its own lateness. It is counted.
//   late     bytes that come after the deadline, before on_silence() was called, belong to the frame before unless that one is whole: then
//            it was this thread that was late.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "gateway/core/counter.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::modbus {

/// CRC-16 of Modbus: polynomial 0xA001 (reflected), begun with 0xFFFF; sent low byte first.
[[nodiscard]] std::uint16_t rtu_crc(std::span<const std::uint8_t> bytes) noexcept;

inline constexpr std::size_t rtu_max_frame = 256;  ///< address, PDU of at most 253 bytes, checksum
inline constexpr std::size_t rtu_min_frame = 4;    ///< address, function, checksum

struct RtuTiming {
    Duration character{};  ///< one byte on the wire, start and stop bits included
    Duration t15{};        ///< longest pause between two bytes of a frame
    Duration t35{};        ///< shortest pause between two frames
    /// `baud` in bit/s, at least 1; `bits_per_byte` 10..12.
    [[nodiscard]] static RtuTiming of(std::uint32_t baud, unsigned bits_per_byte) noexcept;
};

/// One frame whose checksum is right.
struct RtuFrame {
    std::uint8_t address = 0;
    std::uint8_t size = 0;  ///< of the PDU, 1..253
    std::array<std::uint8_t, 253> bytes;
    [[nodiscard]] std::span<const std::uint8_t> pdu() const noexcept { return std::span(bytes).first(size); }
};

/// Written by the thread that receives, read by any.
struct RtuReceiverCounters {
    Counter frames;      ///< with a right checksum, for whomever
    Counter bad_frames;  ///< ended by silence with a wrong checksum, or shorter than a frame can be
    Counter overlong;    ///< more than 256 bytes without a silence
    Counter gaps;        ///< pauses of more than t1.5 within what was taken for one frame
    Counter echoes;      ///< answers that came back whole from the port's own receiver
};

class RtuReceiver {
public:
    explicit RtuReceiver(const RtuTiming& timing) noexcept : timing_(timing) {}

    /// Bytes in the order of the wire; `at` is when the last one was seen, and never goes back. A frame that had ended before them, though
    /// nobody has called on_silence() yet.
    [[nodiscard]] std::optional<RtuFrame> feed(std::span<const std::uint8_t> bytes, Instant at) noexcept;
    /// When the silence will be long enough; never: nothing is there that it could end.
    [[nodiscard]] Instant deadline() const noexcept;
    /// To be called at the deadline or later: the frame that the silence has ended, if it is one.
    [[nodiscard]] std::optional<RtuFrame> on_silence(Instant now) noexcept;
    /// Something is being received.
    [[nodiscard]] bool busy() const noexcept { return size_ > 0 || overlong_ || matched_ > 0; }

    /// An answer is on its way out. A two-wire port may give it back; it is taken out of what comes, and whether this port does so is
    /// learned. `repeats_request`: it has the very bytes of its request (functions 5, 6, 8): on a port without echo the master may send
    /// those again.
    void sent(std::span<const std::uint8_t> adu, bool repeats_request, Instant now) noexcept;
    /// The port was opened anew: what was begun is forgotten, and so is whether it echoes.
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
    // What was sent and may come back; `matched_` bytes of it have.
    std::array<std::uint8_t, rtu_max_frame> echo_bytes_{};
    std::size_t echo_size_ = 0;  // 0: nothing is expected
    std::size_t matched_ = 0;
    Instant echo_until_{};
    bool unechoed_ = false;  // nothing has come since the last answer, not even a part of a frame
    Echo echo_ = Echo::unknown;
};

}  // namespace axisgate::modbus
