// The parameters of the control: its own values of the system parameters, what is admitted for both kinds, and their memory.
// In: numbers, data, memory. Out: values, command errors. Those of an axis are kept by the axis itself and set from here.
// Never asks for the operating mode: that parameters are set in home position alone is the commands'.
#pragma once

#include "adapters/pacontrol/twin/axes.hpp"
#include "adapters/pacontrol/twin/value.hpp"

namespace axisgate::pacontrol::twin {

class Settings {
public:
    /// `switches`: what the rotary switches of the Profibus address hold, 0: there are none.
    Settings(const Profile& profile, const AxisParameters& factory, int switches, Axes& axes);

    [[nodiscard]] const SystemParameters& system() const noexcept { return system_; }
    [[nodiscard]] const Limits<float>& axis_limits(std::size_t number) const { return profile_.axis(number); }
    [[nodiscard]] Limits<std::int32_t> system_limits(std::size_t number) const { return profile_.system(number, axes_.count()); }
    /// Built, and one of those that system parameter 02h counts.
    [[nodiscard]] bool has_axis(std::int64_t n) const noexcept;
    /// What entering AUTOMATIC or ONLINE finds wrong with those of the axes: a command error, or 0.
    [[nodiscard]] std::uint16_t inconsistency() const;

    // --- 0, or a command error ---
    [[nodiscard]] std::uint16_t set_system(std::int64_t number, const Datum& data);
    /// `parameter`: axis * 256 + number [L2231].
    [[nodiscard]] std::uint16_t set_axis(std::int64_t parameter, const Datum& data);

    /// So many axes, as `Axes::fit` does; system parameters that are as usual are what is usual for that many.
    void fit(int axes);

    // --- memory ---
    void keep(Memory& memory) const;
    /// False: it is not one of these.
    bool restore(std::string_view name, const Value& value);
    /// The system parameters are the factory's, but for the switches'.
    void forget();
    [[nodiscard]] std::uint64_t revision() const noexcept { return revision_; }

private:
    [[nodiscard]] bool by_switches(std::int64_t number) const noexcept;

    Profile profile_;
    AxisParameters factory_;
    int switches_;
    Axes& axes_;
    SystemParameters system_;
    std::uint64_t revision_ = 0;
};

}  // namespace axisgate::pacontrol::twin
