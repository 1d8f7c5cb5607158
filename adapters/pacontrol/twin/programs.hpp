// The programs of the AUTOMATIC mode: which of them the START key starts, and the moves of the one that runs.
// In: names, axes, time. Out: the program, moves that begin. Never decides whether a program runs: that is the operating mode's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/pacontrol/twin/mode.hpp"
#include "adapters/pacontrol/twin/settings.hpp"

namespace axisgate::pacontrol::twin {

class Programs {
public:
    /// The first one is the START program, until another is chosen. None: one of 10 s that is named START.
    explicit Programs(std::vector<Program> list);

    [[nodiscard]] const Program& chosen() const { return list_[chosen_]; }
    /// False: there is none of this name.
    bool choose(std::string_view name);

    /// The moves of `running`: the next one begins when the axis of the one before has come to its end. A round that moves nothing is
    /// waited for no further. 0, or the system error by which it ends.
    [[nodiscard]] std::uint16_t go_on(const Program& running, const Settings& settings, Axes& axes, Instant now);
    /// It runs no more, and begins with its first move the next time.
    void end() noexcept;

    // --- memory: the name of the chosen one, unless it is the first ---
    void keep(Memory& memory) const;
    bool restore(std::string_view name, const Value& value);
    void forget() noexcept { chosen_ = 0; }
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

private:
    std::vector<Program> list_;
    std::size_t chosen_ = 0;
    std::size_t move_ = 0;     ///< of the one that runs: the next one
    std::optional<int> axis_;  ///< that it waits for
    std::uint64_t revision_ = 0;
};

}  // namespace axisgate::pacontrol::twin
