// A serial port or a CAN interface of this machine, as the system lists it. A listed port need not have anything connected to it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace axisgate {

struct SystemPort {
    enum class Kind : std::uint8_t { serial, can };
    Kind kind = Kind::serial;
    std::string name;  ///< the system's name: "ttyUSB0", "can0"
    std::string path;  ///< serial: the name that stays the same in every socket (/dev/serial/by-id/...), otherwise its device; can: empty
    std::string text;  ///< maker and product, or the driver's name; empty: unknown
    bool up = true;    ///< can: the interface is switched on; always true for a serial port
    bool operator==(const SystemPort&) const = default;
};
/// "serial", "can".
[[nodiscard]] constexpr std::string_view name_of(SystemPort::Kind k) noexcept { return k == SystemPort::Kind::can ? "can" : "serial"; }

}  // namespace axisgate
