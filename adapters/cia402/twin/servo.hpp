// Servo is the power state machine, homing, faults and stops of a simulated CiA 402 drive, on its object dictionary. Modes 1, 3, 4, 6, 7,
// 8, 9 and 10 (Orders). It knows no frames.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/cia402/twin/device.hpp"
#include "adapters/cia402/twin/homing.hpp"
#include "adapters/cia402/twin/orders.hpp"
#include "adapters/cia402/twin/probes.hpp"
#include "adapters/cia402/twin/switches.hpp"

namespace axisgate::cia402_drive::twin {

enum class State : std::uint8_t { switch_on_disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault };

/// The error codes that a fault of this drive may have.
[[nodiscard]] const std::vector<std::uint16_t>& error_codes();

class Servo : public Device {
public:
    /// `dictionary` must outlive the servo. `travel`: half the distance between the limit switches; 0: there are none. `shift`: offset of
    /// its objects from 6000h, 800h for each axis of the node before it.
    Servo(canopen::Dictionary& dictionary, double travel, std::uint16_t shift = 0)
        : o_(dictionary, shift), units_(o_), orders_(o_, units_, m_), probes_(o_), travel_(travel) {}

    void power_on(Instant now) override;
    void power_off(Instant now) override;
    [[nodiscard]] bool powered() const override { return state_ >= State::enabled && state_ <= State::fault_reaction; }
    [[nodiscard]] canopen::Abort may_write(canopen::Address address, std::int64_t value, Instant now) const override;
    void written(canopen::Address address, Instant now) override;
    void on_sync(Instant now) override;
    void refresh(Instant now) override;
    [[nodiscard]] Instant next_event(Instant now) const override;
    void on_event(Instant at) override;
    [[nodiscard]] bool keeps(canopen::Address address, const canopen::Entry& entry) const override;
    void connection_lost(Instant now) override;
    [[nodiscard]] std::vector<Reported> take_reported() override { return std::exchange(reported_, {}); }

    void fail(std::uint16_t code, Instant now);
    void set_cause(std::uint16_t code) { cause_ = code; }  ///< 0: faults can be reset again
    /// Enabled, and no other function controls the motion.
    [[nodiscard]] bool takes_orders() const { return state_ == State::enabled && !after_stop_ && !orders_.halted(); }
    [[nodiscard]] State state() const noexcept { return state_; }

    // the hand
    void hold(bool held, Instant now);
    /// The input that permits power to the motor (STO), bit 4 of the status word: without it the shaft coasts, and no control word switches
    /// it on.
    bool safe_voltage = true;
    std::uint32_t inputs = 0;  ///< 60FDh, bits 16 and up
    bool limit_negative = false, limit_positive = false, home_switch = false;
    void inputs_changed(Instant now);
    [[nodiscard]] TwinMechanics mechanics(Instant now) const;
    [[nodiscard]] std::uint16_t statusword(Instant now) const;

    // for a controller that moves the servo in addition to the bus
    [[nodiscard]] Mechanics& shaft() noexcept { return m_; }
    [[nodiscard]] const Mechanics& shaft() const noexcept { return m_; }
    /// "Target reached" by two readings that differ by less than this number of increments (Orders); empty: as in CiA 402.
    void reach_by_readings(std::optional<double> within) { orders_.readings_within = within; }
    [[nodiscard]] UserUnits& units() noexcept { return units_; }
    [[nodiscard]] const UserUnits& units() const noexcept { return units_; }
    /// Following errors are checked with this period, and only consecutive ones count as a fault: 6066h divided by this period.
    void set_watch(Duration every) { watch_every_ = look_after_ = every; }
    /// Homing methods below 0 are carried out by the family: homing stays in progress until the family gives the zero position, or reports
    /// that it failed.
    [[nodiscard]] const HomingSearch& homing() const noexcept { return homing_; }
    void homing_ended(std::optional<double> zero);

private:
    void command(unsigned cw, Instant now);
    void stop_then(State state, const Ramps& ramps, bool at_once, Instant now);
    void enter(State state, Instant now);
    void begin_homing(Instant now);
    void next_search(Instant now);
    void watch(Instant at);
    [[nodiscard]] bool watches() const;
    [[nodiscard]] bool follows_demand() const noexcept;

protected:
    void control(Instant now);   ///< carries out the control word that is in the dictionary
    void set_mode(Instant now);  ///< puts the mode that is in the dictionary in force
    [[nodiscard]] bool stands(Instant now) const;

    AxisObjects o_;
    Mechanics m_;
    UserUnits units_;
    Orders orders_;
    TouchProbes probes_;
    Switches switches_;
    double travel_;
    State state_ = State::switch_on_disabled;
    std::optional<State> after_stop_;
    unsigned cw_ = 0;
    HomingSearch homing_;
    std::uint16_t cause_ = 0;  ///< a fault whose cause persists
    Duration watch_every_ = std::chrono::milliseconds(1);
    Duration look_after_ = watch_every_;  ///< after `checked_`
    Instant checked_{};
    std::int64_t behind_ = 0;  ///< number of consecutive following errors
    std::vector<Reported> reported_;
};

}  // namespace axisgate::cia402_drive::twin
