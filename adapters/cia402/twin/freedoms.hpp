// Freedoms are the choices that CiA 301 and CiA 402 leave to a drive, as options of the twin: how often it samples its control word, when
// it shows a mode, whether and when it acknowledges a set-point, in which state it accepts mappings, and how long its SDO answers take. By
// default the drive answers and acts at once.
#pragma once

#include <array>
#include <charconv>
#include <map>
#include <string>
#include <string_view>

#include "gateway/core/instant.hpp"

namespace axisgate::cia402_drive::twin {

struct Freedoms {
    int control_sample_ms = 0;
    int mode_shown_ms = 0;
    int acknowledges = 1;
    int acknowledge_ms = 0;
    int pdo_setup = 0;
    int sdo_answer_ms = 0;

    [[nodiscard]] Duration control_sample() const noexcept { return std::chrono::milliseconds(control_sample_ms); }
    [[nodiscard]] Duration mode_shown() const noexcept { return std::chrono::milliseconds(mode_shown_ms); }
    [[nodiscard]] Duration acknowledge() const noexcept { return std::chrono::milliseconds(acknowledge_ms); }
    [[nodiscard]] Duration sdo_answer() const noexcept { return std::chrono::milliseconds(sdo_answer_ms); }
};

struct Freedom {
    std::string_view name;
    int Freedoms::*value;
    int low, high;
    std::string_view description;
};
inline constexpr std::array<Freedom, 6> freedoms{{
    {"control_sample_ms", &Freedoms::control_sample_ms, 0, 10,
     "the control word (6040h) is looked at once in this time; what stood there in between is not seen. 0: at once"},
    {"mode_shown_ms", &Freedoms::mode_shown_ms, 0, 6000, "a mode that 6060h orders is in force, and shown by 6061h, after this time"},
    {"acknowledges", &Freedoms::acknowledges, 0, 1, "whether status bit 12 acknowledges a set-point of mode 1 at all"},
    {"acknowledge_ms", &Freedoms::acknowledge_ms, 0, 6000, "status bit 12 follows the set-point after this time"},
    {"pdo_setup", &Freedoms::pdo_setup, 0, 2,
     "0: PDOs are set up in each state; 1: their mapping (1600h, 1A00h) in pre-operational alone; 2: all of them (1400h to 1BFFh)"},
    {"sdo_answer_ms", &Freedoms::sdo_answer_ms, 0, 400, "an SDO request is taken, and answered, after this time, one after the other"},
}};

/// Empty, or what a valid value would be. Unknown names are ignored.
[[nodiscard]] inline std::string set_freedom(Freedoms& of, const Freedom& freedom, std::int64_t value) {
    if (value < freedom.low || value > freedom.high)
        return std::string(freedom.name) + ": write " + std::to_string(freedom.low) + " to " + std::to_string(freedom.high);
    of.*freedom.value = static_cast<int>(value);
    return {};
}
[[nodiscard]] inline const Freedom* freedom_of(std::string_view name) noexcept {
    for (const Freedom& f : freedoms)
        if (f.name == name) return &f;
    return nullptr;
}
/// Values that are not given or cannot be read have their default.
[[nodiscard]] inline Freedoms freedoms_of(const std::map<std::string, std::string>& options) {
    Freedoms out;
    for (const Freedom& f : freedoms) {
        const auto it = options.find(std::string(f.name));
        if (it == options.end()) continue;
        int n = 0;
        const auto [end, ec] = std::from_chars(it->second.data(), it->second.data() + it->second.size(), n);
        if (ec == std::errc{} && end == it->second.data() + it->second.size()) (void)set_freedom(out, f, n);
    }
    return out;
}

}  // namespace axisgate::cia402_drive::twin
