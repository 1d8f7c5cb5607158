// Trigger is the input X4.6 with its modes [L4251-4363]: an accepted edge blocks others for some time, or is delayed, or both. Parameters
// 170Ch to 1710h. At most 16 edges are delayed at once.
#pragma once

#include <deque>
#include <optional>
#include <utility>

#include "adapters/linmot/twin/memory.hpp"
#include "adapters/linmot/twin/order.hpp"

namespace axisgate::linmot::twin {

class Trigger {
public:
    explicit Trigger(const Memory& memory) : memory_(memory) {}

    /// Whether the edge has its effect at once. `listens`: the software runs.
    [[nodiscard]] bool edge(bool rising, bool listens, Instant now) {
        if (rising == level_) return false;
        level_ = rising;
        const auto mode = memory_.ram(0x170C);
        if (mode == 0 || !listens) return false;
        if (mode == 2 || mode == 4) {
            if (now < inhibited_until_) return false;
            inhibited_until_ = now + span_ms(memory_.number(rising ? 0x170D : 0x170E));
        }
        if (mode != 3 && mode != 4) return true;
        if (delayed_.size() < 16) delayed_.emplace_back(now + span_ms(memory_.number(rising ? 0x170F : 0x1710)), rising);
        return false;
    }
    [[nodiscard]] Instant due() const { return delayed_.empty() ? never : delayed_.front().first; }
    /// A delayed edge that is due: whether it rises.
    [[nodiscard]] std::optional<bool> take(Instant now) {
        if (due() > now) return std::nullopt;
        const bool rising = delayed_.front().second;
        delayed_.pop_front();
        return rising;
    }
    void clear() noexcept { delayed_.clear(); }

private:
    const Memory& memory_;
    bool level_ = false;
    Instant inhibited_until_{};
    std::deque<std::pair<Instant, bool>> delayed_;
};

}  // namespace axisgate::linmot::twin
