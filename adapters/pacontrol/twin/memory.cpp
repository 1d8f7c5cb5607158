// Memory of the twin: N, R, flags, parameters, the selected program, position and reference of the axes (E-65).
// In: named values. Out: the same. Only what differs from the factory state is kept; what it cannot read is left at that.
// Never keeps outputs, overrides, conditions or the operating mode.
#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/twin/control.hpp"

namespace axisgate::pacontrol::twin {
Memory Control::memory() const {
    Memory m;
    signals_.keep(m);
    settings_.keep(m);
    axes_.keep(m);
    if (program_ != 0) m["program"] = program();
    return m;
}

void Control::power_on(const Memory& memory, Instant now) {
    signals_.forget();
    settings_.forget();
    axes_.forget();
    orders_.forget();
    program_ = 0;
    for (const auto& [name, value] : memory) {
        if (name == "program") {
            if (const auto* text = std::get_if<std::string>(&value)) (void)select_program(*text);
        } else {
            (void)(signals_.restore(name, value) || settings_.restore(name, value) || axes_.restore(name, value));
        }
    }
    axes_.boot();
    mode_.reset();
    error_.clear();
    if (setup_.profibus_switches == 1) error_.note(error::rotary_switches);
    pending_ = {};
    last_ = {};
    ++revision_;
    if (settings_.system()[sp::autostart] != 0) (void)start_automatic(now);
}

void Control::power_off(Instant now) {
    advance(now);
    axes_.lose_power(now);
    collect(now);
    mode_.reset();
}

}  // namespace axisgate::pacontrol::twin
