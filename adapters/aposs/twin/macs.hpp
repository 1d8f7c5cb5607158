// Macs is the controller behind the node: parameters with their life cycle, two axes, and their coupling. It knows no frames. A parameter
// has an init value in the firmware, a user value in the EPROM and a program value in RAM [L8-32]: the dictionary has the value in force,
// `user_` the EPROM. A write over the bus counts as SET (E-01): it is in RAM until a program ends or the power is switched off.
#pragma once

#include <array>
#include <deque>
#include <string>
#include <string_view>

#include "adapters/aposs/twin/bus_devices.hpp"
#include "adapters/aposs/twin/coupling.hpp"
#include "adapters/aposs/twin/delayed.hpp"

namespace axisgate::aposs {
using cia402_drive::twin::Device;

/// Status word and position of an axis as they are shown.
struct ShownLate {
    Delayed status;
    DelayedCourse position;
};

class Macs final : public Device {
public:
    Macs(const Objects& objects, canopen::Dictionary& dictionary, double travel, const Manners& manners = {});

    void power_on(Instant now) override;
    void power_off(Instant now) override;
    [[nodiscard]] bool powered() const override;
    [[nodiscard]] canopen::Abort may_write(Address address, std::int64_t value, Instant now) const override;
    void written(Address address, Instant now) override;
    void on_sync(Instant now) override;
    void refresh(Instant now) override;
    [[nodiscard]] Instant next_event(Instant now) const override;
    void on_event(Instant at) override;
    void connection_lost(Instant now) override;
    [[nodiscard]] std::vector<Reported> take_reported() override;
    [[nodiscard]] bool keeps(Address address, const canopen::Entry& entry) const override;
    void save(NonVolatile& memory) override;
    void load(const NonVolatile& memory) override;

    /// From 1.
    [[nodiscard]] MacsAxis& axis(int channel) { return axes_[static_cast<std::size_t>(channel - 1)]; }
    [[nodiscard]] const MacsAxis& axis(int channel) const { return axes_[static_cast<std::size_t>(channel - 1)]; }
    [[nodiscard]] Coupling& coupling() noexcept { return coupling_; }
    [[nodiscard]] const Coupling& coupling() const noexcept { return coupling_; }
    [[nodiscard]] BusDevices& bus() noexcept { return bus_; }
    [[nodiscard]] const BusDevices& bus() const noexcept { return bus_; }
    [[nodiscard]] const Objects& objects() const noexcept { return objects_; }
    [[nodiscard]] canopen::Dictionary& dictionary() noexcept { return d_; }

    void set_inputs(std::uint32_t mask, Instant now);
    [[nodiscard]] const Terminals& terminals() const noexcept { return terminals_; }
    [[nodiscard]] Terminals& terminals() noexcept { return terminals_; }
    /// The present outputs, including those with a function (O_AXMOVE, O_ERROR).
    [[nodiscard]] std::uint32_t outputs(Instant now) const;
    /// Devices on the controller's own bus do not answer guarding: error 88 as long as a coded type has a guarded device [L1569-1581].
    void set_bus_silent(bool silent, Instant now);
    [[nodiscard]] bool bus_silent() const noexcept { return bus_silent_; }

    // the programs' side
    void start_program(int number);  ///< before it begins, the user values are in force again [L18]
    /// Program values are lost [L71-75]. `concluded`: the program has ended by itself, and the one of PRGPAR begins, which is read before
    /// it is lost (E-06).
    void end_program(bool concluded = false);
    void escape(Instant now);                                                       ///< Esc, I_BREAK: the program ends as defined by
                                                                                    ///< ESCCOND
    void reset_parameters();                                                        ///< Controller > Reset: init values [L10]
    [[nodiscard]] std::optional<int> program() const noexcept { return program_; }  ///< number of the program in progress
    [[nodiscard]] std::int64_t eprom_writes() const noexcept { return eprom_writes_; }
    /// To be called after each change that did not use `written`: decides whether each millisecond must be calculated from now on.
    void begin_ticks(Instant now);

private:
    void apply(Address address, Instant now);
    void changed(const Key& key, Instant now);
    void save_user();
    void check_position_errors(Instant now);

    static constexpr std::size_t most_orders = 64;  ///< of one cycle; further ones are lost

    const Objects& objects_;
    canopen::Dictionary& d_;
    Manners manners_;
    Terminals terminals_;
    std::deque<MacsAxis> axes_;
    Coupling coupling_;
    BusDevices bus_;
    std::map<Key, std::int64_t> user_;  ///< EPROM; a missing value is that of the firmware
    std::int64_t eprom_writes_ = 0;
    std::optional<int> program_;
    bool bus_silent_ = false;
    Instant ticked_{}, silent_since_{};
    Duration tick_every_{};  ///< zero: nothing needs a calculation
    std::array<bool, axes> in_position_error_{};
    Instant powered_at_{};
    std::vector<Address> orders_;  ///< writes that the application takes in its next cycle
    Instant cycle_at_ = never;
    std::array<ShownLate, axes> shown_;
};

}  // namespace axisgate::aposs
