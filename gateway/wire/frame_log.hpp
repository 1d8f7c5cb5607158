// The trace of one line: its newest frames in a bounded ring, written by the hot thread and copied by any thread. The writer is never
// delayed: a reader that is overtaken discards its copy and counts it as missed. No memory is allocated after construction.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "gateway/core/frame.hpp"

namespace axisgate {

/// Each slot has its own version number (a sequence lock): odd while it is written, otherwise the sequence number that it holds. Copying on
/// the hot thread was rejected: a reader that wants 4096 frames of nine lines would stop the loop for some 100 us, which a PLC notices. In
/// this way the hot thread pays a few plain stores per frame, and readers pay for reading.
class FrameLog {
public:
    /// `capacity` frames are kept (at least 1). `max_bytes` is the size per frame, 1..Frame::capacity: 8 is enough for CAN and makes the
    /// ring small; a longer run is recorded as several.
    explicit FrameLog(std::size_t capacity = 4096, std::size_t max_bytes = Frame::capacity);

    /// Hot thread only. `frame.at` is the instant. `simulated`: the frame was on the twin bus, not on the cable.
    void record(const Frame& frame, bool to_drive, bool simulated) noexcept;

    struct Reading {
        std::vector<TraceEntry> entries;  ///< oldest first, in order of sequence
        std::uint64_t missed = 0;         ///< number of overwritten frames with sequence >= `since`
        std::uint64_t next = 1;           ///< `since` for the next call
    };
    /// Any thread. Frames with sequence >= `since` (the first ever has 1), at most `limit`, the oldest ones if there are more.
    /// `unix_offset_ns` is the difference between nanoseconds since 1970 and those of an Instant.
    [[nodiscard]] Reading read(std::uint64_t since, std::size_t limit, std::int64_t unix_offset_ns) const;
    /// Any thread. The newest `limit` frames.
    [[nodiscard]] Reading read_newest(std::size_t limit, std::int64_t unix_offset_ns) const;

    /// Sequence number of the next frame, which is 1 + the number of frames recorded so far.
    [[nodiscard]] std::uint64_t next_sequence() const noexcept { return next_.load(std::memory_order_acquire); }
    [[nodiscard]] std::size_t capacity() const noexcept { return capacity_; }

private:
    using Word = std::atomic<std::uint64_t>;
    // A slot has `stride_` words: version, instant, header (kind, flags, size, id), then the bytes.
    static constexpr std::size_t head_words = 3;

    void write(std::span<const std::uint8_t> data, std::uint64_t header, Instant at) noexcept;
    [[nodiscard]] bool copy(std::uint64_t sequence, TraceEntry& to) const noexcept;
    [[nodiscard]] Word* slot(std::uint64_t sequence) const noexcept { return words_.get() + (sequence % capacity_) * stride_; }

    std::size_t capacity_;
    std::size_t max_bytes_;
    std::size_t stride_;
    std::unique_ptr<Word[]> words_;
    std::atomic<std::uint64_t> next_{1};
};

}  // namespace axisgate
