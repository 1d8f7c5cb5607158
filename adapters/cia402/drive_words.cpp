#include "adapters/cia402/drive_words.hpp"

#include <fmt/core.h>

#include <string_view>

namespace axisgate::cia402_drive {
namespace {
std::string_view state_of(unsigned sw) {
    switch (sw & 0x4Fu) {
        case 0x00:
            return "not ready to switch on";
        case 0x40:
            return "switch on disabled";
        case 0x0F:
            return "fault reaction active";
        case 0x08:
            return "fault";
        default:
            break;
    }
    switch (sw & 0x6Fu) {
        case 0x21:
            return "ready to switch on";
        case 0x23:
            return "switched on";
        case 0x27:
            return "operation enabled";
        case 0x07:
            return "quick stop active";
        default:
            return "a state that CiA 402 does not have";
    }
}
}  // namespace

std::string status_in_words(std::uint16_t sw, int mode) {
    std::string out = fmt::format("status word {:04X}h: {}", sw, state_of(sw));
    const auto add = [&](bool is, std::string_view text) {
        if (is) out += fmt::format(", {}", text);
    };
    add((sw & 0x10u) == 0, "no voltage");
    add((sw & 0x80u) != 0, "warning");
    add((sw & 0x200u) == 0, "local control (bit 9 is 0)");
    add((sw & 0x400u) != 0, "target reached");
    add((sw & 0x800u) != 0, "internal limit active");
    add(mode == 1, (sw & 0x1000u) != 0 ? "set-point acknowledged" : "set-point not acknowledged");
    add(mode == 1 && (sw & 0x2000u) != 0, "following error");
    add(mode == 6, (sw & 0x1000u) != 0 ? "homing attained" : "homing not attained");
    add(mode == 6 && (sw & 0x2000u) != 0, "homing error");
    return out;
}

}  // namespace axisgate::cia402_drive
