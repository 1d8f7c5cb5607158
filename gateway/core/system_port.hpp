// System port: one place of this machine where a line can be: a serial port or a CAN interface, as the system lists it.
// In: nothing. Out: plain values. That one is listed says nothing of what hangs on it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate {

struct SystemPort {
    enum class Kind : std::uint8_t { serial, can };
    Kind kind = Kind::serial;
    std::string name;  ///< the system's: "ttyUSB0", "can0"
    std::string path;  ///< serial: the name that stays when it is plugged in elsewhere (/dev/serial/by-id/...), else its device; can: empty
    std::string text;  ///< maker and product, or the driver's name; empty: the system says no more
    bool up = true;    ///< can: the interface is switched on; a serial port is always so
    bool operator==(const SystemPort&) const = default;
};
/// "serial", "can".
[[nodiscard]] constexpr std::string_view name_of(SystemPort::Kind k) noexcept { return k == SystemPort::Kind::can ? "can" : "serial"; }

}  // namespace axisgate
