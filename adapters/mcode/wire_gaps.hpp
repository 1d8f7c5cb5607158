// Gaps finds the time between two lines that a program prints. On one pair of wires a request that meets such a line is lost with it, and
// the pauses behind a lost request may be a multiple of the program's period, so that each repetition meets the next line, too. In: what
// the line carries, lost exchanges. Out: from when on the next request may be sent.
#pragma once

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "gateway/core/instant.hpp"

namespace axisgate::mcode {

class Gaps {
public:
    /// Bytes that have arrived, but not those of a listing. A line of text without the mark of a question is printed by a program.
    void heard(std::string_view bytes, Instant now) noexcept {
        for (const char c : bytes) {
            if (c == '\n') {
                if (text_ >= shortest_text && !marked_) {
                    before_ = last_;
                    last_ = now;
                }
                text_ = 0;
                marked_ = false;
            } else {
                text_ += c >= 0x20 && c <= 0x7E ? 1U : 0U;
                marked_ = marked_ || c == '#';
            }
        }
    }
    /// An exchange has ended; `lost`: without its answer.
    void ended(bool lost, Instant now) noexcept {
        ended_ = now;
        if (lost) lost_ = now;
    }
    /// When the next request may be sent, unless a printed line ends before: at once, or after a pause that is longer than that between two
    /// of the lines.
    [[nodiscard]] Instant from(Instant now) const noexcept {
        const bool often = last_ - before_ <= longest_period && now - last_ <= 2 * longest_period;
        const bool needed = often && now - lost_ <= memory;
        return needed && now - last_ > behind ? ended_ + longest_period : now;
    }
    void line_changed() noexcept { *this = Gaps(); }

private:
    static constexpr std::size_t shortest_text = 3;
    /// A program that prints more seldom leaves room enough for a repetition.
    static constexpr Duration longest_period = std::chrono::milliseconds(500), memory = std::chrono::seconds(5),
                              behind = std::chrono::milliseconds(2);
    static constexpr Instant long_ago = Instant{-std::chrono::hours(1000)};
    std::size_t text_ = 0;  ///< characters of the line that is arriving
    bool marked_ = false;   ///< it contains the mark of an answer
    Instant last_ = long_ago, before_ = long_ago - 2 * longest_period, lost_ = long_ago, ended_ = long_ago;
};

}  // namespace axisgate::mcode
