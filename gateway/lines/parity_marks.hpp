// ParityMarks: takes the kernel's marks out of what a serial port delivers (PARMRK): 377 377 is one byte 377, 377 0 x was received badly.
// In: bytes as read, in pieces of any size. Out: the bytes meant, in place, and how many were bad.
// Never hides a bad byte: it becomes 0, which no checksum and no number forgives. Dropping it could turn 1200 into 120.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace axisgate {

class ParityMarks {
public:
    /// Works on `data` in place and returns how many bytes of it count. A mark may be split between two calls.
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
                    if (b != 0) data[kept++] = b;  // 377 377; anything else the kernel never writes, and is kept as it is
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
    /// Bytes with a parity or framing error, and breaks.
    [[nodiscard]] std::uint64_t bad() const noexcept { return bad_; }
    /// The port was opened anew: a mark that was begun will not be finished.
    void reset() noexcept { state_ = State::plain; }

private:
    enum class State : std::uint8_t { plain, mark, bad };
    State state_ = State::plain;
    std::uint64_t bad_ = 0;
};

}  // namespace axisgate
