// Delayed is a value as it was some time ago: a controller that copies its status or position late shows it. Changes are noted when they
// are seen; the value between two notes is that of the earlier one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <deque>
#include <iterator>
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

/// A value that changes evenly between two notes, as it was some time ago.
class DelayedCourse {
public:
    explicit DelayedCourse(Duration late = {}) : late_(late) {}
    [[nodiscard]] bool late() const noexcept { return late_ > Duration::zero(); }
    void note(double value, Instant now) {
        if (!late()) return;
        while (notes_.size() > 1 && notes_[1].at <= now - late_)
            notes_.pop_front();
        const std::size_t n = notes_.size();
        const bool stands = n > 1 && notes_[n - 1].value == value && notes_[n - 2].value == value;
        if (stands || (n > 0 && notes_.back().at >= now))
            notes_.back() = {now, value};
        else
            notes_.push_back({now, value});
    }
    /// After the first note.
    [[nodiscard]] double at(Instant now) const {
        const auto later = std::ranges::find_if(notes_, [&](const Note& n) { return n.at > now - late_; });
        if (later == notes_.begin()) return later->value;
        const Note& before = *std::prev(later);
        if (later == notes_.end()) return before.value;
        return before.value + (later->value - before.value) * seconds(now - late_ - before.at) / seconds(later->at - before.at);
    }
    void forget() { notes_.clear(); }

private:
    struct Note {
        Instant at;
        double value = 0;
    };
    Duration late_;
    std::deque<Note> notes_;  ///< in order of time
};

}  // namespace axisgate::aposs
