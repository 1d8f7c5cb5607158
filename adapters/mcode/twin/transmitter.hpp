// Transmitter: what the drive gives to the line: echo and replies at once, program output through a bounded buffer.
// In: text, instants. Out: frames.
// Never loses the reply to a typed line.
#pragma once

#include <string>

#include "gateway/core/twin.hpp"
#include "gateway/core/wire_time.hpp"

namespace axisgate::mcode::twin {

/// Bytes of program output that wait for the line; more is error 66 and lost.
inline constexpr std::size_t transmit_buffer = 256;

class Transmitter {
public:
    explicit Transmitter(std::uint32_t bit_rate) : bit_rate_(bit_rate) {}

    std::string now;      ///< leaves with the present call
    bool silent = false;  ///< by the hand: nothing reaches the line

    /// Program output. False: the buffer is full.
    [[nodiscard]] bool print(std::string_view text, Instant at) {
        if (free_ > at && free_ - at > wire_time(transmit_buffer * 10, bit_rate_)) return false;
        free_ = std::max(free_, at) + wire_time(text.size() * 10, bit_rate_);
        now += text;
        return true;
    }
    void restart(Instant at) noexcept { free_ = at; }
    void flush(bool powered, Instant at, Out& out) {
        std::string_view rest = now;
        while (!rest.empty() && !silent && powered) {
            const std::string_view piece = rest.substr(0, Frame::capacity);
            Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size()});
            f.at = at;
            out.send(f);
            rest.remove_prefix(piece.size());
        }
        now.clear();
    }

private:
    std::uint32_t bit_rate_;
    Instant free_{};
};

}  // namespace axisgate::mcode::twin
