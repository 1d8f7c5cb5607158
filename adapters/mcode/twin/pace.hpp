// Pace: when the drive carries out its next typed line, when it does not hear, and what it learns of later than it happened.
// In: instants, the drive's manners. Out: instants.
// Never does anything itself.
#pragma once

#include <algorithm>
#include <deque>
#include <optional>
#include <utility>

#include "adapters/mcode/twin/manners.hpp"

namespace axisgate::mcode::twin {

class Pace {
public:
    explicit Pace(const Manners& manners) : manners_(manners) {}

    void restart(Instant now) noexcept {
        busy_until_ = deaf_until_ = now;
        stop_due_ = never;
        errors_.clear();
    }

    /// A typed line that comes now, with none before it, is carried out then.
    [[nodiscard]] Instant next_line(Instant now) const noexcept { return std::max(now, busy_until_) + manners_.execution; }
    [[nodiscard]] Instant busy_until() const noexcept { return busy_until_; }
    [[nodiscard]] bool deaf(Instant now) const noexcept { return now < deaf_until_; }
    void deaf_for(Duration d, Instant from) noexcept { deaf_until_ = std::max(deaf_until_, from + d); }
    void busy_for(Duration d, Instant from) noexcept { busy_until_ = std::max(busy_until_, from + d); }
    /// S, IP or FD is carried out.
    void memory_works(Instant now) noexcept {
        busy_for(manners_.memory, now);
        if (manners_.memory_deaf) deaf_for(manners_.memory, now);
    }

    /// The escape character has come.
    void stop_asked(Instant now) noexcept { stop_due_ = std::min(stop_due_, now + manners_.escape); }
    [[nodiscard]] bool take_stop(Instant now) noexcept {
        if (stop_due_ > now) return false;
        stop_due_ = never;
        return true;
    }

    /// The motor has an error, which the language learns of then.
    void error(int code, Instant now) { errors_.emplace_back(now + manners_.error_late, code); }
    [[nodiscard]] std::optional<int> take_error(Instant now) {
        if (errors_.empty() || errors_.front().first > now) return std::nullopt;
        const int code = errors_.front().second;
        errors_.pop_front();
        return code;
    }
    [[nodiscard]] Instant due() const noexcept { return errors_.empty() ? stop_due_ : std::min(stop_due_, errors_.front().first); }

private:
    const Manners& manners_;
    Instant busy_until_{}, deaf_until_{}, stop_due_ = never;
    std::deque<std::pair<Instant, int>> errors_;  ///< in order of time; a motor gives few of them
};

}  // namespace axisgate::mcode::twin
