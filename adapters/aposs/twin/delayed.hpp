// Delayed is a value as it was some time ago: a controller that copies its status or position late shows it. Changes are noted when they
// are seen; the value between two notes is that of the earlier one.
#pragma once

#include <cstdint>
#include <deque>
#include <utility>

#include "gateway/core/instant.hpp"

namespace axisgate::aposs {

class Delayed {
public:
    /// `late` 0: the present value is shown. At most as many notes as there are changes in that time.
    explicit Delayed(Duration late = {}) : late_(late) {}
    [[nodiscard]] bool late() const noexcept { return late_ > Duration::zero(); }
    void note(std::int64_t value, Instant now) {
        if (!late()) return;
        while (notes_.size() > 1 && notes_[1].first <= now - late_)
            notes_.pop_front();
        if (notes_.empty() || notes_.back().second != value) notes_.emplace_back(now, value);
    }
    /// After the first note.
    [[nodiscard]] std::int64_t at(Instant now) const {
        std::int64_t shown = notes_.front().second;
        for (const auto& [since, value] : notes_) {
            if (since <= now - late_) shown = value;
        }
        return shown;
    }
    /// When the next change is shown; `never`: the newest value is shown already.
    [[nodiscard]] Instant next(Instant now) const {
        for (const auto& note : notes_) {
            if (note.first > now - late_) return note.first + late_;
        }
        return never;
    }
    void forget() { notes_.clear(); }

private:
    Duration late_;
    std::deque<std::pair<Instant, std::int64_t>> notes_;  ///< in order of time
};

}  // namespace axisgate::aposs
