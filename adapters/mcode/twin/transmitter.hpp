// Transmitter: what the drive gives to the line, in one order: text that leaves at once, text behind a pause, and program output through
// a bounded buffer.
// In: text, pauses, instants. Out: frames.
// Never loses the reply to a typed line, and never overtakes what was said before.
#pragma once

#include <algorithm>
#include <deque>
#include <string>

#include "gateway/core/twin.hpp"
#include "gateway/core/wire_time.hpp"

namespace axisgate::mcode::twin {

/// Bytes of program output that wait for the line; more is error 66 and lost.
inline constexpr std::size_t transmit_buffer = 256;

class Transmitter {
public:
    explicit Transmitter(std::uint32_t bit_rate) : bit_rate_(bit_rate) {}

    bool silent = false;  ///< by the hand: nothing reaches the line

    /// Leaves with the present call, or when the pauses before it are over.
    void say(std::string_view text, Instant at) {
        if (text.empty()) return;
        const Instant leaves = std::max(not_before_, at);
        if (later_.empty() && leaves == at) {
            now_ += text;
        } else if (!later_.empty() && later_.back().at >= leaves) {
            later_.back().text += text;
        } else {
            later_.push_back({leaves, std::string(text)});
        }
    }
    /// What is said from now on leaves this much behind what was said before.
    void pause(Duration d, Instant at) noexcept {
        if (d > Duration::zero()) not_before_ = std::max(not_before_, at) + d;
    }
    void pause_until(Instant t) noexcept { not_before_ = std::max(not_before_, t); }
    /// When everything that was said has left.
    [[nodiscard]] Instant end(Instant at) const noexcept { return later_.empty() ? at : later_.back().at; }

    /// Program output. False: the buffer is full.
    [[nodiscard]] bool print(std::string_view text, Instant at) {
        if (free_ > at && free_ - at > wire_time(transmit_buffer * 10, bit_rate_)) return false;
        free_ = std::max(free_, at) + wire_time(text.size() * 10, bit_rate_);
        say(text, at);
        return true;
    }
    void restart(Instant at) noexcept {
        free_ = at;
        not_before_ = at;
        later_.clear();
    }
    [[nodiscard]] Instant due() const noexcept { return later_.empty() ? never : later_.front().at; }
    void flush(bool powered, Instant at, Out& out) {
        send(now_, powered, at, out);
        now_.clear();
        while (due() <= at) {
            send(later_.front().text, powered, later_.front().at, out);
            later_.pop_front();
        }
    }

private:
    struct Later {
        Instant at;
        std::string text;
    };
    void send(std::string_view rest, bool powered, Instant at, Out& out) const {
        while (!rest.empty() && !silent && powered) {
            const std::string_view piece = rest.substr(0, Frame::capacity);
            Frame f = Frame::run({reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size()});
            f.at = at;
            out.send(f);
            rest.remove_prefix(piece.size());
        }
    }

    std::uint32_t bit_rate_;
    std::string now_;
    std::deque<Later> later_;  ///< in order of time
    Instant free_{}, not_before_{};
};

}  // namespace axisgate::mcode::twin
