// Node: what the axes of one CANopen node share: their line, the setup, presence, open tickets, notices.
// In and out: members. Never knows which transfer is on its way: that is the drive's.
#pragma once

#include <optional>
#include <string>

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

/// What a drive's family has otherwise than this one, if it is served here: the member "dialect" of its page.
struct Dialect {
    std::string noun = "CiA 402 drive";
    int channels = 1;  ///< the page's own
    /// A node without the profile's objects is served, too: its parameters alone.
    bool profile_optional = false;
    /// What only its nodes have, and a search knows them by; device_type: the profile's number in it.
    Address mark = object::device_type;
    /// EMCY codes FF00h to FFFFh carry a number of the catalogue's in their low byte.
    bool errors_in_low_byte = false;
    /// A node's memory wears out: between two stores of its parameters there is at least this time. Zero: no such guard.
    Duration between_stores{};
    /// Options of the drive "object_2300" and so on may say where a row of the catalogue stands on this drive.
    bool places_move = false;
};
[[nodiscard]] Dialect dialect_of(const Catalogue& catalogue);

/// What the drives of one line share.
struct Line {
    explicit Line(const Catalogue& of_family) : catalogue(of_family) {}
    void take(const LineSetup& setup);
    const Catalogue& catalogue;
    drive::Timing timing;
    drive::Turns turns;
    AdapterCounters counters;
    std::uint32_t bit_rate = 0;
    std::uint8_t own_node = 127;  ///< the gateway's, for its heartbeat

    // --- beats ------------------------------------------------------------------------------------------------------------------
    canopen::SyncTurns plan;                          ///< whose beats are whose; targets go by its beat, which stands while an axis is led
    canopen::TargetTurns targets;                     ///< places of axes that are led
    int led = 0;                                      ///< so many
    std::uint64_t beat = 0;                           ///< SYNCs that were sent
    Instant synced_at{};                              ///< the last one
    Duration period = std::chrono::milliseconds(20);  ///< between two of them now
    /// Of an axis, now: between two pictures of it.
    [[nodiscard]] Duration cycle() const noexcept { return period * plan.turns; }
    /// What is sent now reaches a node before the next SYNC, in a beat that leaves `slot`; a node that has none waits for the plan.
    [[nodiscard]] bool in_turn(int slot, Instant now) const noexcept {
        if (slot < 0) return false;
        return plan.turns == 1 || (static_cast<int>(beat % static_cast<unsigned>(plan.turns)) == slot && now < synced_at + period / 2);
    }
};

/// What a drive shall do when the gateway's heartbeat stops: 6007h. `none`: it does not watch it.
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
    /// Its beats by the line's plan, which is in force.
    void take_slot(int of_plan, Turn& t) {
        slot = of_plan;
        if (!setup.axes.empty()) presence.beats({line.plan.beat, line.plan.turns}, t.out);
    }
    /// The number that a catalogue has for an error code.
    [[nodiscard]] std::uint16_t number_of(std::uint16_t code) const noexcept {
        return dialect.errors_in_low_byte && code >= 0xFF00 ? static_cast<std::uint16_t>(code & 0xFFu) : code;
    }

    Line& line;
    DriveSetup setup;
    const Dialect dialect;
    std::uint8_t number;
    int slot = -1;                                     ///< its beats by the line's plan
    bool stopped = false;                              ///< somebody else has stopped it (NMT): it answers nothing, and its PDOs do not come
    Duration mode_timeout = std::chrono::seconds(1);   ///< from 6060h until 6061h shows it
    Duration start_timeout = std::chrono::seconds(1);  ///< from the start bit until the drive shows that it has taken it
    bool keep_quick_stop = true;
    bool keep_limits = true;  ///< option drive_limits: the site's limits of position go into 607Dh
    Watch watch;
    Places places;
    Presence presence;
    drive::Tickets tickets;
    drive::Notices notices;
    /// Its parameters went into its EPROM: counted and told where it wears out.
    [[nodiscard]] std::string stored(Turn& t);
    std::optional<Instant> stored_at{};  ///< nothing: not since it was set up
    std::uint32_t stores = 0;
};

}  // namespace axisgate::cia402_drive
