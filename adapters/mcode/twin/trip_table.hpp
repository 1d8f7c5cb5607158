// TripTable: the trips of the language: which subroutine each one calls, how often, and the time of TT.
// In: TI TP TC TT TR TA TM with their fields, TE, conditions that are met. Out: targets to call.
// Never calls one: the drive interrupts its program.
#pragma once

#include "adapters/mcode/twin/mechanism.hpp"
#include "adapters/mcode/twin/program.hpp"

namespace axisgate::mcode::twin {

class TripTable {
public:
    TripTable(const Program& program, Mechanism& motor) : program_(program), motor_(motor) {}

    [[nodiscard]] int define(const Statement& s, std::span<const Number> fields, Instant now);
    [[nodiscard]] int enable(std::int64_t mask, Instant now);
    [[nodiscard]] int enabled() const noexcept { return te_; }
    /// A condition is met: what it calls; null if it is not enabled.
    [[nodiscard]] const Target* met(Word word, Instant now);
    /// When TT is met.
    [[nodiscard]] Instant time() const noexcept { return time_; }
    void time_over() noexcept { time_ = never; }
    void clear() noexcept;

private:
    struct Trip {
        bool defined = false;
        Target target;
        std::int64_t repeats = 0;  ///< TR: 0 endless
        std::int64_t left = 0;     ///< of this series
        std::int64_t ms = 0;       ///< TT
    };
    [[nodiscard]] bool on(Word word) const noexcept { return (te_ >> trip_index(word) & 1) != 0; }

    const Program& program_;
    Mechanism& motor_;
    std::array<Trip, trip_words.size()> trips_{};
    int te_ = 0;
    Instant time_ = never;
};

}  // namespace axisgate::mcode::twin
