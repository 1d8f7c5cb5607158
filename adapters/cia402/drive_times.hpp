// AnswerTimes knows which SDO answers a node still owes and how long the node needs for an answer. From this follow the time after which a
// request is repeated, the time-out, and whether an unexpected answer is a late one or comes from a second node. The list is bounded:
// requests that no longer fit, or are too old, are not expected to be answered.
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
    /// An answer about this object has arrived. False: there was no such request, so a second node has answered the same request. `learn`:
    /// the answer was complete in one frame, so that its time shows how fast the node is.
    bool answered(Address address, bool learn, Instant now) noexcept {
        drop_old(now);
        std::optional<std::size_t> oldest;
        std::size_t open = 0;
        for (std::size_t i = size_; i-- > 0;)
            if (owed_[i].address == address) oldest = i, ++open;
        if (!oldest) return false;
        const Duration took = now - owed_[*oldest].sent;
        remove(*oldest);
        // With two requests outstanding it is not known which one this answers; the second answer decides.
        if (learn && open == 1) slowest_ = std::max(took, slowest_ - slowest_ / 16);
        return true;
    }
    /// The time after which a request without an answer may be repeated: `base` for a node without measured times.
    [[nodiscard]] Duration repeat_after(Duration base, Duration most) const noexcept {
        return std::clamp<Duration>(4 * slowest_, std::min(base, most), most);
    }
    /// The time for the answers that come before the answer to a new request.
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
