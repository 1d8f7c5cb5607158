// AnswerTimes: which SDO answers a node still owes, and how long it takes for one.
// In: questions, answers, time. Out: when a question is worth repeating, how long it is worth waiting, and whether an answer that nobody
// waits for is a late one or a second one. Bounded: of more questions than it keeps, or of older ones, no answer is expected any more.
#pragma once

#include <algorithm>
#include <array>
#include <optional>

#include "adapters/cia402/wire.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::cia402_drive {

class AnswerTimes {
public:
    void asked(Address address, Instant now) noexcept {
        drop_old(now);
        if (size_ == owed_.size()) remove(0);
        owed_[size_++] = {address, now};
    }
    /// An answer about this object is here. False: nobody has asked, so that a second node has answered the same question. `learn`: the
    /// whole answer has come by one frame, so that its time says how fast the node is.
    bool answered(Address address, bool learn, Instant now) noexcept {
        drop_old(now);
        std::optional<std::size_t> oldest;
        std::size_t open = 0;
        for (std::size_t i = size_; i-- > 0;)
            if (owed_[i].address == address) oldest = i, ++open;
        if (!oldest) return false;
        const Duration took = now - owed_[*oldest].sent;
        remove(*oldest);
        // With two of them open it is not known which one this answers; the second answer tells.
        if (learn && open == 1) slowest_ = std::max(took, slowest_ - slowest_ / 16);
        return true;
    }
    /// A question without an answer may be sent again after this time: `base` for a node of which nothing is known.
    [[nodiscard]] Duration repeat_after(Duration base, Duration most) const noexcept {
        return std::clamp<Duration>(4 * slowest_, std::min(base, most), most);
    }
    /// What it owes comes before the answer to a new question.
    [[nodiscard]] Duration behind() const noexcept { return static_cast<int>(size_) * slowest_; }
    void forget() noexcept {
        size_ = 0;
        slowest_ = {};
    }

private:
    struct Owed {
        Address address;
        Instant sent;
    };
    static constexpr Duration oldest = std::chrono::seconds(5);
    void remove(std::size_t at) noexcept {
        for (--size_; at < size_; ++at)
            owed_[at] = owed_[at + 1];
    }
    void drop_old(Instant now) noexcept {
        while (size_ > 0 && now - owed_[0].sent > oldest)
            remove(0);
    }
    std::array<Owed, 8> owed_{};
    std::size_t size_ = 0;
    Duration slowest_{};
};

}  // namespace axisgate::cia402_drive
