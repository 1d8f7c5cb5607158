// The 66 commands of the PA-CONTROL [L1806-3880] as a table: code, name, where it is allowed, what it does.
// In: a code. Out: its row. The same rows serve the serial port and the Profibus and Interbus images.
// Never knows how a command came.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "adapters/pacontrol/twin/control.hpp"

namespace axisgate::pacontrol::twin {

struct Call {
    std::uint16_t code = 0;
    std::int64_t parameter = 0;
    Datum data;
    Instant now{};
};

struct CommandRow {
    std::uint16_t code = 0;
    std::string_view name;            ///< the manual's
    std::uint8_t gate = 0;            ///< columns in which it is allowed (mode.hpp)
    bool blocked_by_modules = false;  ///< an axis command: 14h when the axis extension is configured [L640]
    CommandReply (*run)(Control&, const Call&) = nullptr;
};

/// All of them, by code as the manual's overview has them.
[[nodiscard]] std::span<const CommandRow> command_rows();
/// nullptr: 13h, unknown command.
[[nodiscard]] const CommandRow* find_command(std::uint16_t code);

}  // namespace axisgate::pacontrol::twin
