// Turnaround: the pause that one drive needs behind its answers, learned from requests that were sent at once and lost.
// In: the instants of its answers and of the requests to it, and which requests it has not received. Out: the pause, 0..25 ms.
// Never takes a lost request for a short pause's fault if it was sent 30 ms or more behind the last answer.
#pragma once

#include "gateway/core/instant.hpp"

namespace axisgate::mcode {

/// A drive may hear nothing for some time behind an answer [L1581, L5008]. The manual gives no figure, so two requests in a row that were
/// sent soon after an answer and lost, with answered ones between them, make the pause longer. It stays as long as the drive is in the
/// site.
class Turnaround {
public:
    static constexpr Duration first = std::chrono::milliseconds(5), longest = std::chrono::milliseconds(25);
    static constexpr int lost_in_a_row = 2;

    [[nodiscard]] Duration pause() const noexcept { return pause_; }
    void answered(Instant now) noexcept {
        answered_at_ = now;
        ever_ = true;
    }
    /// A request goes out.
    void sends(Instant now) noexcept { at_once_ = ever_ && now - answered_at_ < longest + std::chrono::milliseconds(5); }
    /// The request that was sent last followed an answer soon.
    [[nodiscard]] bool at_once() const noexcept { return at_once_; }
    /// A request of which this is known was received, or was lost. `at_once`: as it was when that request was sent. True: the pause is
    /// longer now.
    void received(bool at_once) noexcept {
        if (at_once) lost_ = 0;
    }
    bool lost(bool at_once) noexcept {
        if (!at_once || pause_ == longest || ++lost_ < lost_in_a_row) return false;
        lost_ = 0;
        pause_ = pause_ == Duration::zero() ? first : longest;
        return true;
    }

private:
    Duration pause_{};
    Instant answered_at_{};
    int lost_ = 0;
    bool ever_ = false, at_once_ = false;
};

}  // namespace axisgate::mcode
