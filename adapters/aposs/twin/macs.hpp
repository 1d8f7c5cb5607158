// Macs: the controller behind the node: parameters with their life cycle, two axes, and what couples them.
// In: objects written, statements of the direct mode, time. Out: objects to be read, errors as EMCY. Never knows a frame.
// A parameter has an init value in the firmware, a user value in the EPROM and a program value in RAM [L8-32]: the dictionary holds what
// is valid now, `user_` what the EPROM holds. A write over the bus counts as SET (E-01): it is in RAM until a program ends or power goes.
#pragma once

#include <array>
#include <deque>
#include <string>
#include <string_view>

#include "adapters/aposs/twin/objects.hpp"
#include "adapters/cia402/twin/servo.hpp"

namespace axisgate::aposs {
using cia402_drive::twin::Device;
using cia402_drive::twin::Servo;

class Macs final : public Device {
public:
    /// Errors with a number of the manual's go out as EMCY FF00h + number: the manual prints no EMCY codes.
    static constexpr std::uint16_t error_base = 0xFF00;
    static constexpr std::uint16_t homing_wanted = error_base + 6, guarding_failed = error_base + 88, limit_violated = error_base + 98,
                                   i2t_limit = error_base + 99;

    Macs(const Objects& objects, canopen::Dictionary& dictionary);

    void power_on(Instant now) override;
    void power_off(Instant now) override;
    [[nodiscard]] bool powered() const override;
    [[nodiscard]] canopen::Abort may_write(Address address, std::int64_t value) const override;
    void written(Address address, Instant now) override;
    void on_sync(Instant now) override;
    void refresh(Instant now) override;
    [[nodiscard]] Instant next_event(Instant now) const override;
    void on_event(Instant at) override;
    void connection_lost(Instant now) override;
    [[nodiscard]] std::vector<Told> take_told() override;
    [[nodiscard]] bool keeps(Address address, const canopen::Entry& entry) const override;
    void save(NonVolatile& memory) override;
    void load(const NonVolatile& memory) override;

    [[nodiscard]] Servo& axis(int channel) { return servos_[static_cast<std::size_t>(channel - 1)]; }
    [[nodiscard]] const Servo& axis(int channel) const { return servos_[static_cast<std::size_t>(channel - 1)]; }

    // the programs' side
    void start_program();     ///< user values are in force again before it begins [L18]
    void end_program();       ///< program values die [L71-75]
    void reset_parameters();  ///< Controller > Reset: init values [L10]
    [[nodiscard]] bool program_runs() const noexcept { return program_; }
    [[nodiscard]] std::int64_t eprom_writes() const noexcept { return eprom_writes_; }

    /// Electronic gear of the second axis to the first (SYNCV, SYNCP) or none; started by a program of the user, as no object for it is
    /// printed. Empty, or why not.
    enum class Gear : std::uint8_t { none, velocity, position };
    [[nodiscard]] std::string set_gear(Gear gear, Instant now);
    [[nodiscard]] Gear gear() const noexcept { return gear_; }

    [[nodiscard]] std::int64_t value(std::string_view id, int axis = 0) const;

private:
    void changed(const Key& key, Instant now);
    void settle_axis(int axis, bool defaults);
    void raise(int axis, std::uint16_t code, Instant now);
    void follow(Instant at);
    void use(const Row& row, std::int64_t value) { (void)d_.set(row.address, Value{value}); }
    [[nodiscard]] bool homing_due(int axis) const;

    const Objects& objects_;
    canopen::Dictionary& d_;
    struct Shown {
        const Row *place, *command, *old_command, *master, *home_force;
    };
    std::array<Shown, axes> shown_{};  ///< rows that are measured
    std::deque<Servo> servos_;
    std::map<Key, std::int64_t> user_;  ///< EPROM; what is not here is as the firmware has it
    std::array<bool, axes> homed_{};    ///< since power-on, and since a change of a stored parameter (E-72)
    std::vector<Told> told_;
    std::int64_t eprom_writes_ = 0;
    bool program_ = false;
    Gear gear_ = Gear::none;
    double gear_master_ = 0, gear_slave_ = 0;  ///< where both were when it began
    Instant ticked_{};
    std::array<double, axes> simulated_master_{};       ///< SYSVAR 4105 as it is read: qc
    std::array<std::int64_t, axes> simulated_speed_{};  ///< as it is written: qc per ms
};

}  // namespace axisgate::aposs
