// Reports requests that a door with registers refused as events: the text that the other doors would give, the client, register and value.
// An exception code alone does not tell a technician the cause. A PLC repeats its request a hundred times a second, so the events stay
// within the bounds of EventRows.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/core/command.hpp"
#include "gateway/core/event_rows.hpp"
#include "gateway/registers/unit_map.hpp"

namespace axisgate::registers {

/// The content of a request for people; kept while a drive is asked.
struct RequestNote {
    static constexpr std::size_t most_shown = 8;  ///< number of registers
    std::uint8_t unit = 0;
    std::uint8_t code = 0;  ///< the number of the request in the protocol of the door, reported if nothing else is known of it
    bool write = false;
    Table table = Table::holding_registers;
    std::uint16_t address = 0;
    std::uint16_t count = 0;                ///< 0: the request was too short to contain it
    std::uint16_t values[most_shown] = {};  ///< the first registers of a write; of coils the first bit
};
/// "unit 1 register 34 = 80", "unit 2 registers 32..35 = 15 1 0 80", "unit 2 holding registers 10..19".
[[nodiscard]] std::string text_of(const RequestNote& note);

class RefusalLog {
public:
    RefusalLog(Door door, EventRows::Tell tell) : door_(door), rows_(std::move(tell)) {}

    /// `who`: "192.0.2.7:51123"; clients are distinguished by their address. `answer` is the answer to the client in the door's words
    /// ("exception 3"); empty if there was none because the parameter channel shows it.
    void add(std::string_view who, Refused refused, const RequestNote& note, std::string_view answer, Instant now);
    /// The same for something that is not a register: `what` names it ("parameter 3 (feeder AC)").
    void add(std::string_view who, AxisId axis, std::string_view what, std::string_view why, Instant now);
    void flush(Instant now) { rows_.flush(now); }
    [[nodiscard]] bool pending() const noexcept { return rows_.pending(); }

private:
    [[nodiscard]] Event event_of(std::string_view who, Severity severity) const;

    Door door_;
    EventRows rows_;
};

}  // namespace axisgate::registers
