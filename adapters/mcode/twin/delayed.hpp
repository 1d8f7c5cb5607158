// Delayed: a flag as it was some time ago: a drive that refreshes its flags slowly.
#pragma once

#include <deque>
#include <utility>

#include "gateway/core/instant.hpp"

namespace axisgate::mcode::twin {

class Delayed {
public:
    explicit Delayed(Duration by) noexcept : by_(by) {}

    /// The flag is this from now on.
    void note(bool value, Instant now) {
        if (by_ == Duration::zero()) {
            past_ = value;
            return;
        }
        forget(now);
        if (value != (changes_.empty() ? past_ : changes_.back().second)) changes_.emplace_back(now + by_, value);
    }
    /// As it is shown.
    [[nodiscard]] bool at(Instant now) {
        forget(now);
        return past_;
    }

private:
    void forget(Instant now) {
        while (!changes_.empty() && changes_.front().first <= now) {
            past_ = changes_.front().second;
            changes_.pop_front();
        }
    }

    Duration by_;
    bool past_ = false;
    std::deque<std::pair<Instant, bool>> changes_;  ///< that are not shown yet; at most those of `by_`
};

}  // namespace axisgate::mcode::twin
