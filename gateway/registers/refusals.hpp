// Refusals: what a door of registers refused, told as events: the sentence that the other doors would say, who asked, register and value.
// In: refusals with their instant. Out: events through `tell`, within the bounds of EventRows. Verdict codes alone leave a technician
// guessing; a PLC repeats its request a hundred times a second.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

#include "gateway/core/command.hpp"
#include "gateway/core/event_rows.hpp"
#include "gateway/registers/unit_map.hpp"

namespace axisgate::registers {

/// A request for people; kept while a drive is asked.
struct RequestNote {
    static constexpr std::size_t most_shown = 8;  ///< registers
    std::uint8_t unit = 0;
    std::uint8_t code = 0;  ///< the request's number in the door's protocol, told where nothing else is known of it
    bool write = false;
    Table table = Table::holding_registers;
    std::uint16_t address = 0;
    std::uint16_t count = 0;                ///< 0: the request was too short to say
    std::uint16_t values[most_shown] = {};  ///< the first registers of a write; of coils the first bit
};
/// "unit 1 register 34 = 80", "unit 2 registers 32..35 = 15 1 0 80", "unit 2 holding registers 10..19".
[[nodiscard]] std::string text_of(const RequestNote& note);

class RefusalLog {
public:
    RefusalLog(Door door, EventRows::Tell tell) : door_(door), rows_(std::move(tell)) {}

    /// `who`: "192.0.2.7:51123"; clients are told apart by their address. `answer`: what the client was told, in the door's words
    /// ("exception 3"); empty: nothing, the parameter channel shows it.
    void add(std::string_view who, Refused refused, const RequestNote& note, std::string_view answer, Instant now);
    /// The same of what is no register: `what` names it ("parameter 3 (feeder AC)").
    void add(std::string_view who, AxisId axis, std::string_view what, std::string_view why, Instant now);
    void flush(Instant now) { rows_.flush(now); }
    [[nodiscard]] bool pending() const noexcept { return rows_.pending(); }

private:
    [[nodiscard]] Event event_of(std::string_view who, Severity severity) const;

    Door door_;
    EventRows rows_;
};

}  // namespace axisgate::registers
