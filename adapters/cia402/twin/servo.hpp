// Servo: the power state machine and the modes of operation of a simulated CiA 402 drive, over its object dictionary.
// In: objects written, the SYNC, the hand, time. Out: objects to be read, EMCY messages with the instant of their cause, the next instant
// at which something changes by itself. Modes 1, 3, 4, 6, 7, 8, 9 and 10. Never knows a frame.
#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/cia402/twin/device.hpp"
#include "adapters/cia402/twin/mechanics.hpp"

namespace axisgate::cia402_drive::twin {

enum class State : std::uint8_t { switch_on_disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault };

class Servo : public Device {
public:
    /// `dictionary` outlives the servo. `travel`: half the way between the limit switches; 0: there are none. `shift`: by which its objects
    /// stand above 6000h, 800h for each axis of a node before it.
    Servo(canopen::Dictionary& dictionary, double travel, std::uint16_t shift = 0) : d_(dictionary), travel_(travel), shift_(shift) {}

    void power_on(Instant now) override;
    void power_off(Instant now) override;
    [[nodiscard]] bool powered() const override { return state_ >= State::enabled && state_ <= State::fault_reaction; }
    [[nodiscard]] canopen::Abort may_write(canopen::Address address, std::int64_t value) const override;
    void written(canopen::Address address, Instant now) override;
    void on_sync(Instant now) override { sync(now); }
    void refresh(Instant now) override;
    [[nodiscard]] Instant next_event(Instant now) const override;
    void on_event(Instant at) override;
    [[nodiscard]] bool keeps(canopen::Address address, const canopen::Entry& entry) const override;

    void hold(bool held, Instant now);
    void fail(std::uint16_t code, Instant now);
    void set_cause(std::uint16_t code) { cause_ = code; }  ///< 0: a reset is taken again
    void place(double position, Instant now);
    void connection_lost(Instant now) override;
    /// Enabled, and nothing else decides where it goes.
    [[nodiscard]] bool takes_orders() const { return state_ == State::enabled && !after_stop_ && !halted_; }
    /// Somebody beside the bus leads it: to this place of the shaft within the next millisecond. Only while it takes orders.
    void steer(double position, Instant now) { m_.step_to(position, 0.001, now); }
    [[nodiscard]] double demanded(Instant now) const { return m_.demand(now).position; }
    std::uint32_t inputs = 0;  ///< 60FDh, bits 16 and up
    bool limit_negative = false, limit_positive = false, home_switch = false;
    void inputs_changed(Instant now);
    /// 60FEh: what the mask lets through.
    [[nodiscard]] std::uint32_t outputs() const { return static_cast<std::uint32_t>(get(0x60FE, 1) & get(0x60FE, 2)); }

    [[nodiscard]] TwinMechanics mechanics(Instant now) const;
    [[nodiscard]] std::vector<Told> take_told() override { return std::exchange(told_, {}); }
    [[nodiscard]] static const std::vector<std::uint16_t>& error_codes();
    [[nodiscard]] std::uint16_t statusword(Instant now) const;

private:
    [[nodiscard]] canopen::Address at(std::uint16_t index, std::uint8_t sub) const noexcept {
        return {static_cast<std::uint16_t>(index >= 0x6000 ? index + shift_ : index), sub};
    }
    [[nodiscard]] std::int64_t get(std::uint16_t index, std::uint8_t sub = 0) const { return d_.integer(at(index, sub)).value_or(0); }
    void put(std::uint16_t index, std::int64_t v) { (void)d_.set(at(index, 0), Value{v}); }
    [[nodiscard]] double rate(std::uint16_t index) const { return static_cast<double>(std::max<std::int64_t>(1, get(index))); }
    [[nodiscard]] Ramps ramps() const;
    void control(Instant now);
    void command(unsigned cw, Instant now);
    void stop_then(State state, double down, bool at_once, Instant now);
    void enter(State state, Instant now);
    void set_mode(Instant now);
    void act(Instant now);  ///< what the mode does with its targets now
    void set_point(bool relative, bool now_please, Instant now);
    void go(Instant now);
    void sync(Instant now);
    void begin_homing(Instant now);
    void next_search(Instant now);
    void homed();
    void halt(bool on, Instant now);
    void limit(Instant now);
    void probe(unsigned k, bool high, Instant now);
    void arm_probes();
    void read_units();
    [[nodiscard]] double ratio(std::uint16_t index) const;
    [[nodiscard]] double in_units(double mechanical) const { return (mechanical - zero_) / per_unit_; }
    /// Of an object in user units: a place of the shaft.
    [[nodiscard]] double place_of(std::uint16_t index, std::uint8_t sub = 0) const {
        return zero_ + per_unit_ * static_cast<double>(get(index, sub));
    }
    [[nodiscard]] double speed(std::uint16_t index, std::uint8_t sub) const {
        return per_speed_ * static_cast<double>(std::max<std::int64_t>(1, get(index, sub)));
    }
    [[nodiscard]] double fastest() const { return per_speed_ * std::min(rate(0x607F), rate(0x6080)); }
    [[nodiscard]] double braking(std::int64_t option) const;
    [[nodiscard]] bool settles() const;
    [[nodiscard]] Duration window_time() const { return std::chrono::milliseconds(get(0x6068)); }

    canopen::Dictionary& d_;
    Mechanics m_;
    double travel_, zero_ = 0, per_unit_ = 1, per_speed_ = 1;
    std::uint16_t shift_;
    State state_ = State::switch_on_disabled;
    std::optional<State> after_stop_;
    unsigned cw_ = 0;
    int mode_ = 1;
    bool halted_ = false, reached_ = false, acknowledged_ = false, limited_ = false;
    std::optional<double> target_;    ///< of the positioning under way, mechanical
    std::optional<double> buffered_;  ///< the next one, mechanical
    enum class Homing : std::uint8_t { none, to_switch, to_zero, attained, error } homing_ = Homing::none;
    double homing_zero_ = 0;
    std::vector<double> search_;  ///< places still to go to before the zero
    std::uint16_t cause_ = 0;     ///< a fault whose cause stands
    Instant checked_{};
    std::optional<Instant> behind_since_;
    std::uint16_t probe_status_ = 0;
    unsigned probe_function_ = 0;
    std::array<bool, 2> probe_level_{};
    std::vector<Told> told_;
};

}  // namespace axisgate::cia402_drive::twin
