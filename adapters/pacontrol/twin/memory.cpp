// Memory of the twin: N, R, flags, parameters, the selected program, position and reference of the axes (E-65).
// In: named values. Out: the same. Only what differs from the factory state is kept; what it cannot read is left at that.
// Never keeps outputs, overrides, conditions or the operating mode.
#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/twin/control.hpp"

namespace axisgate::pacontrol::twin {
std::map<std::string, Value> Control::memory() const {
    std::map<std::string, Value> m;
    for (std::int64_t n = 1; n <= static_cast<std::int64_t>(twin::elements); ++n) {
        if (elements_.flags.get(n)) m["M" + std::to_string(n)] = true;
        if (const auto v = elements_.n.get(n); v != 0) m["N" + std::to_string(n)] = std::int64_t{v};
        if (const auto v = elements_.r.get(n); v != 0) m["R" + std::to_string(n)] = static_cast<double>(v);
    }
    const SystemParameters usual = setup_.profile.usual_system(axes());
    for (std::size_t i = 1; i <= system_parameters; ++i) {
        const bool by_switches = i == sp::profibus_address && setup_.profibus_switches != 0;
        if (system_[i] != usual[i] && !by_switches) m["system." + std::to_string(i)] = std::int64_t{system_[i]};
    }
    const AxisParameters factory = factory_axis();
    for (int n = 1; n <= axes(); ++n) {
        for (std::size_t i = 1; i <= axis_parameters; ++i) {
            if (const float v = axis(n).parameters()[i]; v != factory[i])
                m[axis_name(n, "parameter." + std::to_string(i))] = static_cast<double>(v);
        }
    }
    axes_.keep(m);
    if (program_ != 0) m["program"] = program();
    return m;
}

void Control::power_on(const std::map<std::string, Value>& memory, Instant now) {
    const Bits inputs = elements_.inputs;  // outside conditions stay
    elements_ = {inputs, Bits{setup_.outputs}, Bits{setup_.flags}, Registers<std::int32_t>{setup_.n}, Registers<float>{setup_.r}};
    system_ = setup_.profile.usual_system(axes());
    if (setup_.profibus_switches > 1) system_[sp::profibus_address] = setup_.profibus_switches;
    axes_.forget();
    const auto n = static_cast<std::size_t>(axes());
    overrides_.assign(n, {});
    next_condition_.assign(n, {});
    condition_.assign(n, {});
    condition_input_.assign(n, 1);
    limits_monitored_.assign(n, true);
    program_ = 0;
    for (const auto& [name, value] : memory) {
        const auto number = as_number(value);
        if (const auto mm = numbered(name, "M"); mm && number) {
            elements_.flags.set(*mm, *number != 0);
        } else if (const auto nn = numbered(name, "N"); nn && number) {
            elements_.n.set(*nn, whole(Datum::integer(*number)));
        } else if (const auto r = numbered(name, "R"); r && number) {
            elements_.r.set(*r, single(Datum::number(*number)).value_or(0));
        } else if (const auto s = numbered(name, "system."); s && number) {
            if (*s != static_cast<std::int64_t>(sp::profibus_address) || setup_.profibus_switches == 0)
                (void)set_system_parameter(*s, Datum::integer(*number));
        } else if (name == "program") {
            if (const auto* text = std::get_if<std::string>(&value)) (void)select_program(*text);
        } else if (!axes_.restore(name, value)) {
            const auto [axis_n, what] = axis_named(name, axes());
            const auto p = numbered(what, "parameter.");
            const auto v = number ? single(Datum::number(*number)) : std::nullopt;
            if (axis_n != 0 && p && v && *p >= 1 && *p <= static_cast<std::int64_t>(axis_parameters)) {
                const auto& limits = axis_limits(static_cast<std::size_t>(*p));
                axis(axis_n).set_parameter(static_cast<std::size_t>(*p), std::clamp(*v, limits.least, limits.largest));
            }
        }
    }
    axes_.boot();
    mode_.reset();
    error_ = setup_.profibus_switches == 1 ? error::rotary_switches : std::uint16_t{0};
    pending_ = {};
    last_ = {};
    ++revision_;
    if (system_[sp::autostart] != 0) (void)start_automatic(now);
}

void Control::power_off(Instant now) {
    advance(now);
    axes_.lose_power(now);
    collect(now);
    mode_.reset();
}

}  // namespace axisgate::pacontrol::twin
