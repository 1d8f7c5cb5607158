// Speakers makes, configures and removes the adapters of each line, and opens lines. A side has at most one adapter of a family.
#pragma once

#include "gateway/engine/machine.hpp"

namespace axisgate::engine {

class Speakers {
public:
    Speakers(Machine& machine, EngineHost& host, Routing& routing, std::size_t trace_frames)
        : machine_(machine), host_(host), routing_(routing), trace_frames_(trace_frames) {}
    /// Makes the sides of a new line and opens the real one. The twins' side is made when the first drive is simulated.
    void build_line(LineUnit& unit, Instant now);
    void fit(Side& side, Instant now);
    Speaker& bring_in(Side& side, const FamilyEntry& family, Instant now);
    void configure(Speaker& speaker, Instant now);
    void configure_side(Side& side, Instant now);
    [[nodiscard]] LineSetup setup_for(const LineUnit& unit) const;

private:
    [[nodiscard]] LineSetup setup_for(const Speaker& speaker) const;

    Machine& machine_;
    EngineHost& host_;
    Routing& routing_;
    std::size_t trace_frames_;
};

}  // namespace axisgate::engine
