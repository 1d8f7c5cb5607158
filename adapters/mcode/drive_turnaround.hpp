// Turnaround: the pause that one drive needs behind its answers, learned from requests that were sent at once and lost. TrailingAck:
// whether its answers end with their data. In: the instants of its answers and of the requests to it, and which requests it has not
// received. Out: the pause, 0..25 ms. Never takes a lost request for a short pause's fault if it was sent 30 ms or more behind the last
// answer.
#pragma once

#include "adapters/mcode/wire_reply.hpp"
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

/// Whether an acknowledgement is waited for behind the data of an answer. The manual does not say where it stands with EM = 1 (E-4); one
/// that comes behind the data, while the next request is sent already, would be taken for the answer to that, or spoil it.
class TrailingAck {
public:
    static constexpr int in_vain = 3;           ///< answers without any, in a drive that has sent none behind its data yet
    static constexpr int in_vain_behind = -20;  ///< it has: more of them

    [[nodiscard]] bool expected() const noexcept { return without_ < in_vain; }
    void stood(AckPlace place) noexcept {
        if (place == AckPlace::before) without_ = in_vain;
        if (place == AckPlace::behind) without_ = in_vain_behind;
        if (place == AckPlace::none && without_ < in_vain) ++without_;
    }
    void forget() noexcept { without_ = 0; }

private:
    int without_ = 0;
};

}  // namespace axisgate::mcode
