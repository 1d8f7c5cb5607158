// MacsAxis is one axis of the controller: it applies the MACS parameters to the CiA 402 servo, and adds homing, limits, errors and current
// monitoring. It starts no motion that homing, a limit or REVERS forbids.
#pragma once

#include <array>
#include <optional>

#include "adapters/aposs/twin/coded.hpp"
#include "adapters/aposs/twin/filters.hpp"
#include "adapters/aposs/twin/homing.hpp"
#include "adapters/aposs/twin/objects.hpp"
#include "adapters/aposs/twin/real_shaft.hpp"
#include "adapters/aposs/twin/synchronisation.hpp"
#include "adapters/cia402/twin/servo.hpp"

namespace axisgate::aposs {
using cia402_drive::twin::Servo;

/// Errors with a number of the manual are sent as EMCY FF00h + number: the manual prints no EMCY codes (E-73). The others have the codes of
/// CiA 402.
inline constexpr std::uint16_t error_base = 0xFF00;
inline constexpr std::uint16_t homing_wanted = error_base + 6, guarding_failed = error_base + 88, limit_violated = error_base + 98,
                               i2t_limit = error_base + 99;
inline constexpr std::uint16_t index_missed = 0x7305, position_error = 0x8611, end_limit = 0x8612;

/// The controller's terminals: inputs 1 to 16, outputs 1 to 8.
struct Terminals {
    std::uint32_t inputs = 0, outputs = 0;
    /// Parameters name an input with a sign: a negative input is active when it is low; 0 is none.
    [[nodiscard]] bool active(std::int64_t number) const {
        const auto n = number < 0 ? -number : number;
        return n >= 1 && n <= 32 && ((inputs >> (n - 1) & 1u) != 0) == (number > 0);
    }
    void set(std::int64_t number, bool active) {
        const auto n = number < 0 ? -number : number;
        if (n < 1 || n > 32) return;
        const std::uint32_t bit = 1u << (n - 1);
        outputs = active == (number > 0) ? outputs | bit : outputs & ~bit;
    }
};

class MacsAxis {
public:
    MacsAxis(const Objects& objects, canopen::Dictionary& dictionary, Terminals& terminals, int axis, double travel,
             const Manners& manners = {});
    MacsAxis(const MacsAxis&) = delete;
    MacsAxis& operator=(const MacsAxis&) = delete;

    void power_on(Instant now);
    [[nodiscard]] Servo& servo() noexcept { return servo_; }
    [[nodiscard]] const Servo& servo() const noexcept { return servo_; }
    [[nodiscard]] std::int64_t value(std::string_view id) const;
    void set(std::string_view id, std::int64_t v);

    /// Sets the profile's objects by the parameters; with `defaults` also velocity and acceleration, which a client may have changed.
    void settle(bool defaults);
    [[nodiscard]] SyncParameters sync_parameters() const;
    /// A write to an object of the profile; it is passed to the servo. True: it was a stop or another motion.
    bool written(canopen::Address address, Instant now);
    /// Inputs or switches have changed.
    void inputs_changed(Instant now);

    /// Whether the axis needs a calculation each millisecond.
    [[nodiscard]] bool ticks(bool led) const;
    void tick(bool led, Instant at);
    /// Handles the effects of a servo event: brake, homing.
    void after(Instant now);
    void raise(std::uint16_t code, Instant now);
    [[nodiscard]] std::vector<cia402_drive::twin::Device::Reported> take_reported() { return std::exchange(reported_, {}); }

    [[nodiscard]] bool homing_due() const { return value("HOME_FORCE") != 0 && !homed_; }
    void revoke_homing() { homed_ = false; }
    /// The error that prevents a motion in this direction (1, -1; 0: none); 0: it may start.
    [[nodiscard]] std::uint16_t forbids(double direction, Instant now) const;
    void define_origin(Instant now);
    [[nodiscard]] bool may_clear_error() const;
    void clear_error(Instant now);  ///< as I_ERRCLR and ERRCLR: the reset by the control word
    [[nodiscard]] bool moves(Instant now) const;
    /// ERRCOND 2 and 3: after the stop the axis is still controlled.
    [[nodiscard]] bool holds_in_error() const;

    [[nodiscard]] double place(Instant now) const { return machine.place(servo_.shaft(), now); }
    [[nodiscard]] std::int64_t track_error(Instant now) const;  ///< SYSVAR 4124, percent
    [[nodiscard]] const CurrentWatch& current() const noexcept { return current_; }
    /// The encoder as the controller counts it: 0 at power-on and where an origin command has set it to 0, independent of the zero of the
    /// axis.
    [[nodiscard]] double encoder(Instant now) const { return servo_.shaft().read(now) - encoder_zero_; }
    void reset_encoder(Instant now) { encoder_zero_ += encoder(now); }
    void shift_origin(double by) { servo_.units().set_zero(servo_.units().zero() + by); }
    /// The encoder reads too high by this number of qc: ENCODERTYPE 3 and 4 correct it for 100 readings of 1 ms [L2961-2967].
    void misread(double by, Instant now);
    struct Misreading {
        double by = 0, from = 0, velocity = 0;  ///< qc, qc/ms: position and velocity before the error
        Instant since{};
        std::int64_t readings = 0;
        std::int64_t count = 0;  ///< SYSVAR 16: wrong readings since power-on
    };
    [[nodiscard]] const Misreading& misreading() const noexcept { return jump_; }
    double load = 0;           ///< fraction of AMPMAXCUR that the motor needs under power, 0 to 1
    bool index_pulses = true;  ///< the encoder has index pulses
    RealShaft machine;         ///< follows the calculated shaft of the servo
    [[nodiscard]] std::int64_t of(std::uint16_t index, std::uint8_t sub = 0) const {
        return d_.integer({static_cast<std::uint16_t>(index + base_), sub}).value_or(0);
    }
    void put(std::uint16_t index, std::uint8_t sub, double v);

private:
    [[nodiscard]] HomingInput homing_input(Instant now);
    void homing_order(const HomingRun::Order& order, Instant now);
    [[nodiscard]] double limit_place(bool positive) const;
    [[nodiscard]] bool outside(bool positive, double place) const;
    void start_positioning(unsigned cw, Instant now);
    [[nodiscard]] std::uint16_t speed_refused(Instant now);
    void read_encoder(Instant at);

    const Objects& objects_;
    canopen::Dictionary& d_;
    Terminals& terminals_;
    int axis_;
    std::uint16_t base_;
    double travel_;
    Servo servo_;
    HomingRun homing_;
    CurrentWatch current_;
    bool homed_ = false;   ///< since power-on, and since the change of a stored parameter (E-72)
    bool braked_ = false;  ///< the brake output was set because of this error
    bool hot_ = false;     ///< error 99 was reported
    Misreading jump_;
    double encoder_zero_ = 0;
    double hysteresis_ = 0;  ///< of the reference cam
    bool in_cam_ = false;
    int violated_ = 0;  ///< the limit whose error was reported: -1, 1, until the axis is back inside
    std::array<bool, 2> at_switch_{};
    std::vector<cia402_drive::twin::Device::Reported> reported_;
};

}  // namespace axisgate::aposs
