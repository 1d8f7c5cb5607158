// Body holds the parts of a simulated drive on which the states and the commands act: setup, parameters, command table, curves and others.
// It decides nothing; states.hpp and commands.hpp do.
#pragma once

#include "adapters/linmot/twin/follower.hpp"
#include "adapters/linmot/twin/force.hpp"
#include "adapters/linmot/twin/monitor.hpp"
#include "adapters/linmot/twin/table.hpp"
#include "adapters/linmot/twin/trigger.hpp"

namespace axisgate::linmot::twin {

/// The motion command buffer.
struct CommandBuffer {
    Bytes bytes{};
    std::uint8_t echo = 0;  ///< count of the last command
    std::uint16_t last_header = 0;
    /// `first`: the count of a command that an earlier master has left; 0: none.
    void power_on(std::uint8_t first) noexcept {
        echo = first, last_header = 0;
        if (first != 0) bytes[0] = static_cast<std::uint8_t>((bytes[0] & 0xF0) | first);
    }
    /// The content counts as old (choice O-09); `clears`: its count is 0.
    void forget(bool clears) noexcept { echo = clears ? std::uint8_t{0} : static_cast<std::uint8_t>(bytes[0] & 0x0F); }
};

struct Body {
    Body(const DriveSetup& with, Memory& parameters, TableEntries& entries, Curves& all)
        : setup(with), memory(parameters), curves(all), table(entries, parameters) {}

    /// A RAM value, including those that are not stored as parameters.
    [[nodiscard]] std::uint32_t ram(std::uint16_t upid) const {
        if (upid == 0x1DB0) return buffer.last_header;
        if (upid == 0x1B93) return static_cast<std::uint32_t>(outside.current);
        return upid == 0x1BCE ? monitor.hottest() : memory.ram(upid);
    }

    DriveSetup setup;
    Outside outside;
    Memory& memory;
    Curves& curves;
    MasterEncoder master{memory};
    Demand demand{memory, master, curves, setup.winding};
    Follower follower{memory, demand, outside, setup};
    Monitor monitor{memory, outside, setup.series};
    Table table;
    ForceWatch force;
    Trigger trigger{memory};
    Armed armed;
    CommandBuffer buffer;
};

}  // namespace axisgate::linmot::twin
