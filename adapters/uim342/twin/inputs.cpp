// Sampling and trigger modes of the inputs.
// In: levels, modes, time. Out: edges.
// Never ticks when nothing changes: the grid is computed, not counted.
#include "adapters/uim342/twin/inputs.hpp"

#include <algorithm>

namespace axisgate::uim342::twin {
namespace {

constexpr Duration grid = std::chrono::milliseconds(1);

/// The first instant of the grid that is not before `t`. All drives of a bus share the grid.
Instant on_grid(Instant t) noexcept {
    const auto rest = t.time_since_epoch() % grid;
    if (rest == Duration::zero()) return t;
    return rest > Duration::zero() ? t + (grid - rest) : t - rest;
}

bool bit(std::uint8_t mask, std::size_t i) noexcept { return ((mask >> i) & 1u) != 0; }

}  // namespace

void Inputs::apply(std::uint8_t levels, Instant now) noexcept {
    applied_ = levels & 0x07;
    applied_at_ = now;
    plan(now);
}

void Inputs::restart(const std::array<std::uint16_t, input_count>& modes) noexcept {
    modes_ = modes;
    sampled_ = latched_ = applied_;
    since_.fill(never);
    sample_at_ = deadline_ = never;
}

void Inputs::set_mode(std::size_t input, std::uint16_t mode, Instant now) noexcept {
    modes_[input] = mode;
    if (since_[input] != never) since_[input] = on_grid(now);
    plan(now);
}

void Inputs::plan(Instant now) noexcept {
    sample_at_ = applied_ == sampled_ ? never : on_grid(std::max(now, applied_at_ + late_));
    deadline_ = sample_at_;
    for (std::size_t i = 0; i < input_count; ++i) {
        if (since_[i] == never) continue;
        const bool filtered = modes_[i] != trigger_continuous && modes_[i] != trigger_one_time;
        deadline_ = std::min(deadline_, filtered ? since_[i] + std::chrono::milliseconds(modes_[i]) : since_[i]);
    }
}

std::optional<Edge> Inputs::step(Instant at) noexcept {
    if (at < deadline_) return std::nullopt;
    if (at >= sample_at_) {
        for (std::size_t i = 0; i < input_count; ++i) {
            const bool now_high = bit(applied_, i);
            if (now_high == bit(sampled_, i)) continue;
            since_[i] = now_high == bit(latched_, i) ? never : at;  // back before the filter time was over: it never happened
        }
        sampled_ = applied_;
    }
    for (std::size_t i = 0; i < input_count; ++i) {
        if (since_[i] == never) continue;
        const bool filtered = modes_[i] != trigger_continuous && modes_[i] != trigger_one_time;
        if (filtered && at < since_[i] + std::chrono::milliseconds(modes_[i])) continue;
        since_[i] = never;
        latched_ = static_cast<std::uint8_t>(latched_ ^ (1u << i));
        plan(at);
        return Edge{i, bit(latched_, i)};
    }
    plan(at);
    return std::nullopt;
}

}  // namespace axisgate::uim342::twin
