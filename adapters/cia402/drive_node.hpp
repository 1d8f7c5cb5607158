// Node holds the members that the axes of one CANopen node share: the line, the setup, presence, open tickets, notices.
#pragma once

#include <optional>
#include <string>

#include "adapters/cia402/drive_pdos.hpp"
#include "adapters/cia402/wire.hpp"
#include "gateway/core/adapter.hpp"
#include "gateway/core/catalogue.hpp"
#include "gateway/core/setup.hpp"
#include "gateway/core/wire_time.hpp"
#include "gateway/drive/notices.hpp"
#include "gateway/drive/presence.hpp"
#include "gateway/drive/tickets.hpp"
#include "gateway/drive/turn.hpp"
#include "gateway/drive/turns.hpp"
#include "gateway/protocols/canopen/sync_turns.hpp"

namespace axisgate::cia402_drive {
using drive::Presence;
using drive::Turn;

/// The differences of another family that this adapter serves: the member "dialect" of its catalogue.
struct Dialect {
    std::string noun = "CiA 402 drive";
    int channels = 1;  ///< of the catalogue
    /// Nodes without the profile's objects are accepted, with their parameters only.
    bool profile_optional = false;
    /// An object that only nodes of this family have, by which a search recognises them; for device_type, the profile number in it.
    Address mark = object::device_type;
    /// The low byte of EMCY codes FF00h to FFFFh is an error number of the catalogue.
    bool errors_in_low_byte = false;
    /// Minimum time between two stores of the parameters, to protect the memory of the drive. Zero: no limit.
    Duration between_stores{};
    /// Options of the drive such as "object_2300" may state the index of a catalogue row on this drive.
    bool places_move = false;
};
[[nodiscard]] Dialect dialect_of(const Catalogue& catalogue);

/// The members that the drives of one line share.
struct Line {
    explicit Line(const Catalogue& of_family) : catalogue(of_family) {}
    void take(const LineSetup& setup);
    const Catalogue& catalogue;
    drive::Timing timing;
    drive::Turns turns;
    AdapterCounters counters;
    std::uint32_t bit_rate = 0;
    std::uint8_t own_node = 127;  ///< node number of the gateway, for its heartbeat

    // --- SYNC cycles -----------------------------------------------------------------------------------------------------------
    canopen::SyncTurns plan;                          ///< which nodes report in which cycles; targets use its cycle, which is constant
                                                      ///< while an axis follows set-points
    canopen::TargetTurns targets;                     ///< places of the axes that follow set-points
    int led = 0;                                      ///< number of axes that follow set-points
    bool plan_anew = false;                           ///< a drive reports by more or longer PDOs than the plan knows
    std::uint64_t beat = 0;                           ///< number of SYNCs sent
    Instant synced_at{};                              ///< time of the last SYNC
    Duration period = std::chrono::milliseconds(20);  ///< present time between two SYNCs
    /// The present time between two reports of one axis.
    [[nodiscard]] Duration cycle() const noexcept { return period * plan.turns; }
    /// True if a frame sent now reaches the node before the next SYNC, in a cycle with remainder `slot`. A node without a slot waits for
    /// the plan.
    [[nodiscard]] bool in_turn(int slot, Instant now) const noexcept {
        if (slot < 0) return false;
        return plan.turns == 1 || (static_cast<int>(beat % static_cast<unsigned>(plan.turns)) == slot && now < synced_at + period / 2);
    }
};

/// The reaction of a drive when the gateway's heartbeat stops (6007h). `none`: the drive does not monitor it.
struct Watch {
    std::int64_t option = 3;  ///< 1 fault, 2 disable voltage, 3 quick stop
    std::string_view action = "quick_stop";
    Duration time = std::chrono::milliseconds(1000);
    bool on = true;
};

struct Node {
    Node(Line& of_line, const DriveSetup& of_drive, std::uint8_t own_number)
        : line(of_line),
          setup(of_drive),
          dialect(dialect_of(catalogue())),
          number(own_number),
          presence(of_drive.id, of_line.timing),
          notices(of_drive.id) {}
    [[nodiscard]] const Catalogue& catalogue() const noexcept { return setup.catalogue ? *setup.catalogue : line.catalogue; }
    [[nodiscard]] Address mark() const {
        const auto moved = places.find(dialect.mark.index);
        return {moved == places.end() ? dialect.mark.index : moved->second, dialect.mark.sub};
    }
    /// The plan of the line that is now in force gives the node this slot.
    void take_slot(int of_plan, Turn& t) {
        slot = of_plan;
        if (!setup.axes.empty()) presence.beats({line.plan.beat, line.plan.turns}, t.out);
    }
    /// The catalogue's number for an error code.
    [[nodiscard]] std::uint16_t number_of(std::uint16_t code) const noexcept {
        return dialect.errors_in_low_byte && code >= 0xFF00 ? static_cast<std::uint16_t>(code & 0xFFu) : code;
    }

    Line& line;
    DriveSetup setup;
    const Dialect dialect;
    std::uint8_t number;
    int weight = 1;                                    ///< its reports in one cycle, in units of those of an axis
    int slot = -1;                                     ///< its cycles in the plan of the line
    bool stopped = false;                              ///< another NMT master has stopped it: no SDO answers and no PDOs
    Duration mode_timeout = std::chrono::seconds(1);   ///< from the write of 6060h until 6061h shows the mode
    Duration start_timeout = std::chrono::seconds(1);  ///< from the start bit until the drive has acknowledged it
    bool restart_stopped = false;                      ///< a node that another NMT master has stopped is started again, also if it stands
    std::optional<PdoPlan> pdo_plan{};                 ///< the only one that is tried; empty: free, few or file, sdo
    bool keep_quick_stop = false;
    bool only_reads = false;  ///< nothing is set up: the values are read by SDO
    bool keep_limits = true;  ///< option drive_limits: the site's position limits are written to 607Dh
    Watch watch;
    Places places;
    Presence presence;
    drive::Tickets tickets;
    drive::Notices notices;
    /// The parameters were stored in the EPROM. Counts the stores and returns a warning if the memory of this drive wears out.
    [[nodiscard]] std::string stored(Turn& t);
    std::optional<Instant> stored_at{};  ///< empty: not since it was set up
    std::uint32_t stores = 0;
};

}  // namespace axisgate::cia402_drive
