// Memory of the twin: N, R, flags, parameters, the selected program, position and reference of the axes (E-65).
// In: named values. Out: the same. Only what differs from the factory state is kept; what it cannot read is left at that.
// Never keeps outputs, overrides, conditions or the operating mode.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "adapters/pacontrol/twin/control.hpp"

namespace axisgate::pacontrol::twin {
namespace {

/// `N17` -> 17 for the prefix `N`; nothing for anything else.
std::optional<std::int64_t> numbered(std::string_view name, std::string_view prefix) {
    if (!name.starts_with(prefix)) return std::nullopt;
    name.remove_prefix(prefix.size());
    std::int64_t n = 0;
    const auto [end, fault] = std::from_chars(name.data(), name.data() + name.size(), n);
    if (fault != std::errc{} || end != name.data() + name.size()) return std::nullopt;
    return n;
}

std::string axis_name(std::size_t i, std::string_view what) { return "axis" + std::to_string(i + 1) + "." + std::string(what); }

}  // namespace

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
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        for (std::size_t i = 1; i <= axis_parameters; ++i) {
            if (const float v = axes_[a].parameters()[i]; v != factory[i])
                m[axis_name(a, "parameter." + std::to_string(i))] = static_cast<double>(v);
        }
        if (axes_[a].parameters()[ap::absolute] != 0 && kept_[a].position != 0) m[axis_name(a, "position")] = kept_[a].position;
        if (kept_[a].shaft != 0) m[axis_name(a, "shaft")] = kept_[a].shaft;
        if (axes_[a].parameters()[ap::absolute] != 0 && kept_[a].shift != 0) m[axis_name(a, "shift")] = kept_[a].shift;
    }
    if (program_ != 0) m["program"] = program();
    return m;
}

void Control::power_on(const std::map<std::string, Value>& memory, Instant now) {
    const Bits inputs = elements_.inputs;  // outside conditions stay
    elements_ = {inputs, Bits{setup_.outputs}, Bits{setup_.flags}, Registers<std::int32_t>{setup_.n}, Registers<float>{setup_.r}};
    system_ = setup_.profile.usual_system(axes());
    if (setup_.profibus_switches > 1) system_[sp::profibus_address] = setup_.profibus_switches;
    const AxisParameters factory = factory_axis();
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        for (std::size_t i = 1; i <= axis_parameters; ++i)
            axes_[a].set_parameter(i, factory[i]);
        kept_[a] = {};
        overrides_[a] = {};
        next_condition_[a].reset();
        condition_[a].reset();
        condition_input_[a] = 1;
        limits_monitored_[a] = true;
    }
    program_ = 0;
    for (const auto& [name, value] : memory) {
        const auto number = as_number(value);
        if (const auto n = numbered(name, "M"); n && number) {
            elements_.flags.set(*n, *number != 0);
        } else if (const auto nn = numbered(name, "N"); nn && number) {
            elements_.n.set(*nn, whole(Datum::integer(*number)));
        } else if (const auto r = numbered(name, "R"); r && number) {
            elements_.r.set(*r, single(Datum::number(*number)).value_or(0));
        } else if (const auto s = numbered(name, "system."); s && number) {
            if (*s != static_cast<std::int64_t>(sp::profibus_address) || setup_.profibus_switches == 0)
                (void)set_system_parameter(*s, Datum::integer(*number));
        } else if (name == "program") {
            if (const auto* text = std::get_if<std::string>(&value)) (void)select_program(*text);
        } else if (number && std::isfinite(*number)) {
            for (std::size_t a = 0; a < axes_.size(); ++a) {
                const std::string own = axis_name(a, "");
                if (!name.starts_with(own)) continue;
                const std::string_view what = std::string_view(name).substr(own.size());
                const double place = std::clamp(*number, -1e9, 1e9);
                if (const auto p = numbered(what, "parameter.")) {
                    const auto v = single(Datum::number(*number));
                    if (*p >= 1 && *p <= static_cast<std::int64_t>(axis_parameters) && v) {
                        const auto& limits = axis_limits(static_cast<std::size_t>(*p));
                        axes_[a].set_parameter(static_cast<std::size_t>(*p), std::clamp(*v, limits.least, limits.largest));
                    }
                } else if (what == "position") {
                    kept_[a].position = place;
                } else if (what == "shaft") {
                    kept_[a].shaft = place;
                } else if (what == "shift") {
                    kept_[a].shift = place;
                }
            }
        }
    }
    for (std::size_t a = 0; a < axes_.size(); ++a) {
        axes_[a].boot(kept_[a]);
    }
    mode_.reset();
    error_ = setup_.profibus_switches == 1 ? error::rotary_switches : std::uint16_t{0};
    pending_ = {};
    last_ = {};
    ++revision_;
    if (system_[sp::autostart] != 0) (void)start_automatic(now);
}

void Control::power_off(Instant now) {
    advance(now);
    for (Axis& a : axes_)
        a.lose_power(now);
    collect(now);
    mode_.reset();
}

}  // namespace axisgate::pacontrol::twin
