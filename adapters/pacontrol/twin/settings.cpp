// The parameters of the control. In: numbers, data, memory. Out: values, command errors.
// Never takes a value outside of the limits that 1701, 1702, 1801 and 1802 tell.
#include "adapters/pacontrol/twin/settings.hpp"

#include <algorithm>
#include <cmath>

#include "adapters/pacontrol/twin/errors.hpp"

namespace axisgate::pacontrol::twin {

Settings::Settings(const Profile& profile, const AxisParameters& factory, int switches, Axes& axes)
    : profile_(profile), factory_(factory), switches_(switches), axes_(axes), system_(profile.usual_system(axes.count())) {}

bool Settings::has_axis(std::int64_t n) const noexcept { return n >= 1 && n <= axes_.count() && n <= system_[sp::axes]; }

std::uint16_t Settings::inconsistency() const {
    for (int n = 1; has_axis(n); ++n) {
        if (const auto fault = inconsistent(axes_.at(n).parameters()); fault != 0) return fault;
    }
    return quit::ok;
}

bool Settings::by_switches(std::int64_t number) const noexcept {
    return number == static_cast<std::int64_t>(sp::profibus_address) && switches_ != 0;
}

std::uint16_t Settings::set_system(std::int64_t number, const Datum& data) {
    if (number < 1 || number > static_cast<std::int64_t>(system_parameters)) return quit::no_system_parameter;
    const auto i = static_cast<std::size_t>(number);
    const auto limits = system_limits(i);
    const double v = std::round(data.value);
    if (v < limits.least || v > limits.largest || (i == sp::profibus_address && v == 1)) return quit::value;  // 1 is the master's
    if (by_switches(number)) return quit::profibus_address;
    if (system_[i] != static_cast<std::int32_t>(v)) ++revision_;
    system_[i] = static_cast<std::int32_t>(v);
    return quit::ok;
}

std::uint16_t Settings::set_axis(std::int64_t parameter, const Datum& data) {
    const std::int64_t n = parameter >> 8;
    const auto number = static_cast<std::size_t>(parameter & 0xFF);
    if (parameter < 0 || !has_axis(n)) return quit::no_axis;
    if (number < 1 || number > axis_parameters) return quit::no_axis_parameter;
    const auto v = single(data);
    const auto& limits = axis_limits(number);
    if (!v || *v < limits.least || *v > limits.largest) return quit::value;
    Axis& a = axes_.at(static_cast<int>(n));
    if (a.parameters()[number] != *v) ++revision_;
    a.set_parameter(number, *v);
    return quit::ok;
}

void Settings::fit(int axes) {
    const int before = axes_.count();
    const SystemParameters was = profile_.usual_system(before);
    axes_.fit(axes);
    if (axes_.count() == before) return;
    const SystemParameters is = profile_.usual_system(axes_.count());
    for (std::size_t i = 1; i <= system_parameters; ++i) {
        if (system_[i] == was[i]) system_[i] = is[i];
    }
    ++revision_;
}

void Settings::keep(Memory& memory) const {
    const SystemParameters usual = profile_.usual_system(axes_.count());
    for (std::size_t i = 1; i <= system_parameters; ++i) {
        if (system_[i] != usual[i] && !by_switches(static_cast<std::int64_t>(i)))
            memory["system." + std::to_string(i)] = std::int64_t{system_[i]};
    }
    for (int n = 1; n <= axes_.count(); ++n) {
        for (std::size_t i = 1; i <= axis_parameters; ++i) {
            if (const float v = axes_.at(n).parameters()[i]; v != factory_[i])
                memory[axis_name(n, "parameter." + std::to_string(i))] = static_cast<double>(v);
        }
    }
}

bool Settings::restore(std::string_view name, const Value& value) {
    const auto number = as_number(value);
    if (!number) return false;
    if (const auto i = numbered(name, "system.")) {
        if (!by_switches(*i)) (void)set_system(*i, Datum::integer(*number));
        return true;
    }
    const auto [n, what] = axis_named(name, axes_.count());
    const auto i = numbered(what, "parameter.");
    const auto v = single(Datum::number(*number));
    if (n == 0 || !i || !v || *i < 1 || *i > static_cast<std::int64_t>(axis_parameters)) return false;
    const auto& limits = axis_limits(static_cast<std::size_t>(*i));
    axes_.at(n).set_parameter(static_cast<std::size_t>(*i), std::clamp(*v, limits.least, limits.largest));
    return true;
}

void Settings::forget() {
    system_ = profile_.usual_system(axes_.count());
    if (switches_ > 1) system_[sp::profibus_address] = switches_;
}

}  // namespace axisgate::pacontrol::twin
