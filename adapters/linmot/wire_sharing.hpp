// SharedLine watches a line on which somebody else speaks, too: another master and its drives, or a drive that sends without a request.
// LinRS has no rule for this, and on one pair of wires two telegrams at once destroy each other. After such a telegram was heard, each
// request waits for a moment of silence, and its repetitions have growing pauses, so that a periodic telegram is not met again. A converter
// may pass a telegram on in pieces: the pauses between them are no silence.
#pragma once

#include <algorithm>
#include <cstddef>

#include "gateway/core/instant.hpp"

namespace axisgate::linmot {

class SharedLine {
public:
    /// A request is being sent, which takes `time`; 0: not known.
    void sends(Instant now, Duration time) noexcept {
        sends_until_ = now + time;
        busy_since_ = now;
    }
    /// `size` bytes have arrived, each of which takes `per_byte` (0: not known); `inside`: a telegram had begun before them. Returns the
    /// number of leading ones that were on the line while a request was still being sent: on a shared line they are no answer, and on one
    /// pair of wires they are corrupted. A simulated drive behind a pseudo terminal answers without the time on the wire; where nobody else
    /// speaks its bytes are taken.
    [[nodiscard]] std::size_t heard(Instant now, std::size_t size, Duration per_byte, bool inside) noexcept {
        if (now - heard_at_ > silence(now)) busy_since_ = now;
        if (inside) learn_gap(now - static_cast<std::int64_t>(size) * per_byte - heard_at_, now);
        heard_at_ = now;
        const Duration overlap = sends_until_ - (now - static_cast<std::int64_t>(size) * per_byte);
        return !shared(now) || per_byte <= Duration::zero() || overlap < per_byte
                   ? 0
                   : std::min(static_cast<std::size_t>(overlap / per_byte), size);
    }
    /// A telegram has arrived for which nobody here has asked.
    void strange(Instant now) noexcept { strange_at_ = now; }
    void line_changed() noexcept { *this = SharedLine(); }

    /// Somebody else has spoken during the last 20 s.
    [[nodiscard]] bool shared(Instant now) const noexcept { return strange_at_ >= now - memory; }
    /// A request may be sent from this instant on, unless further bytes arrive: after 15 ms of silence, or 100 ms without any. Where
    /// telegrams come in pieces, the silence is longer than the pauses inside of them, and it is awaited for two of the longest telegrams.
    [[nodiscard]] Instant silent_at(Instant now) const noexcept { return silent_at(now, busy_since_); }
    /// The same for a stop that has not been sent yet: it does not wait for the end of a telegram that comes in pieces.
    [[nodiscard]] Instant stop_at(Instant now) const noexcept {
        return shared(now) ? std::min(heard_at_ + shortest_silence, busy_since_ + patience) : now;
    }
    /// When a request whose time-out has expired at `since` is sent for the `n`th time.
    [[nodiscard]] Instant repeat_at(Instant now, Instant since, int n) const noexcept {
        return shared(now) ? std::max(since + n * step, silent_at(now, since)) : since;
    }

private:
    [[nodiscard]] Instant silent_at(Instant now, Instant since) const noexcept {
        return shared(now) ? std::min(heard_at_ + silence(now), since + std::max(patience, bytes_of_two * gap(now))) : now;
    }
    [[nodiscard]] Duration gap(Instant now) const noexcept { return gap_at_ >= now - memory ? gap_ : Duration{}; }
    [[nodiscard]] Duration silence(Instant now) const noexcept { return std::max(shortest_silence, gap(now) + gap(now) / 2); }
    void learn_gap(Duration pause, Instant now) noexcept {
        if (pause > longest_gap || 2 * pause < gap(now)) return;
        gap_ = std::max(gap(now), pause);
        gap_at_ = now;
    }
    static constexpr Duration memory = std::chrono::seconds(20), shortest_silence = std::chrono::milliseconds(15),
                              patience = std::chrono::milliseconds(100), step = std::chrono::milliseconds(17),
                              longest_gap = std::chrono::milliseconds(25);  ///< a longer pause is the loss of a telegram's end
    static constexpr int bytes_of_two = 40;
    static constexpr Instant long_ago = Instant{-std::chrono::hours(1000)};
    Instant sends_until_ = long_ago, heard_at_ = long_ago, strange_at_ = long_ago, busy_since_ = long_ago, gap_at_ = long_ago;
    Duration gap_{};  ///< the longest pause inside a telegram
};

}  // namespace axisgate::linmot
