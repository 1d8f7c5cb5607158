// The axes of the control: 1 to 16 of them, what all of them are told at once, and what each keeps without supply.
// In: numbers from 1, time, memory. Out: the axes; what is to be kept.
// Never knows why they stop or go on, and never tells one of them what another does.
#pragma once

#include <deque>
#include <map>

#include "adapters/pacontrol/twin/axis.hpp"
#include "adapters/pacontrol/twin/memory.hpp"

namespace axisgate::pacontrol::twin {

class Axes {
public:
    static constexpr int most = 16;

    /// `n` of them, held to 1..16, as `model` and with the parameters `factory`; `rotary`: axis -> AE of a revolution.
    Axes(int n, const AxisModel& model, const std::map<int, double>& rotary, const AxisParameters& factory);

    [[nodiscard]] int count() const noexcept { return static_cast<int>(axes_.size()); }
    [[nodiscard]] const Axis& at(int n) const { return axes_.at(static_cast<std::size_t>(n - 1)); }
    [[nodiscard]] Axis& at(int n) { return axes_.at(static_cast<std::size_t>(n - 1)); }
    [[nodiscard]] auto begin() noexcept { return axes_.begin(); }
    [[nodiscard]] auto end() noexcept { return axes_.end(); }
    /// So many, if they are not that many yet; those that come new are as the factory made them, and have power.
    void fit(int n);

    [[nodiscard]] bool all_stand() const noexcept;
    void advance(Instant now);
    /// After something of them may have changed.
    void settle(Instant now);
    [[nodiscard]] Instant deadline() const noexcept;

    // --- what all of them are told ---
    void interrupt(Instant now);
    void resume(Instant now);
    /// Each ends its task by a ramp, and what was interrupted does not go on.
    void finish(Instant now);
    void clear_faults() noexcept;
    void clear_displaced() noexcept;

    // --- memory: position, shaft and shift of each (E-65) ---
    /// Takes over what axis `n` wants kept, if it stands.
    void keep_of(int n);
    void keep(Memory& memory) const;
    /// False: it is not one of these.
    bool restore(std::string_view name, const Value& value);
    /// Nothing is kept, and the parameters are the factory's.
    void forget();
    /// Power on, with what is kept.
    void boot();
    void lose_power(Instant now);
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

private:
    void add();

    AxisModel model_;
    std::map<int, double> rotary_;
    AxisParameters factory_;
    std::deque<Axis> axes_;
    std::vector<Axis::Kept> kept_;
    std::uint64_t revision_ = 0;
};

}  // namespace axisgate::pacontrol::twin
