// ParityMarks: removes the kernel's PARMRK marks from the bytes of a serial port: 377 377 is one byte 377, 377 0 x is a bad byte.
// It works in place on bytes as they were read, in pieces of any size, and counts the bad ones. A bad byte is replaced by 0, which fails
// every checksum and is part of no number. If it were dropped, 1200 could become 120.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace axisgate {

class ParityMarks {
public:
    /// Works on `data` in place and returns the number of valid bytes at its beginning. A mark may be split between two calls.
    [[nodiscard]] std::size_t take_out(std::span<std::uint8_t> data) noexcept {
        std::size_t kept = 0;
        for (const std::uint8_t b : data) {
            switch (state_) {
                case State::plain:
                    if (b == 0xFF) {
                        state_ = State::mark;
                    } else {
                        data[kept++] = b;
                    }
                    break;
                case State::mark:
                    state_ = b == 0 ? State::bad : State::plain;
                    if (b != 0) data[kept++] = b;  // 377 377; the kernel writes no other pair, so any other is kept as it is
                    break;
                case State::bad:
                    state_ = State::plain;
                    ++bad_;
                    data[kept++] = 0;
                    break;
            }
        }
        return kept;
    }
    /// The number of bytes with a parity or framing error, and of breaks.
    [[nodiscard]] std::uint64_t bad() const noexcept { return bad_; }
    /// For a port that was opened again: a mark that had begun is discarded.
    void reset() noexcept { state_ = State::plain; }

private:
    enum class State : std::uint8_t { plain, mark, bad };
    State state_ = State::plain;
    std::uint64_t bad_ = 0;
};

}  // namespace axisgate
