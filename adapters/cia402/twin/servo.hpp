// Servo: the power state machine and the modes of operation of a simulated CiA 402 drive, over its object dictionary.
// In: objects written, the SYNC, the hand, time. Out: objects to be read, EMCY messages with the instant of their cause, the next instant
// at which something changes by itself. Modes 1, 3, 4, 6, 7, 8, 9 and 10. Never knows a frame.
#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "adapters/cia402/twin/mechanics.hpp"
#include "gateway/core/twin.hpp"
#include "gateway/protocols/canopen/dictionary.hpp"
#include "gateway/protocols/canopen/emergency.hpp"

namespace axisgate::cia402_drive::twin {

enum class State : std::uint8_t { switch_on_disabled, ready, switched_on, enabled, quick_stop, fault_reaction, fault };

class Servo {
public:
    struct Told {
        Instant at;
        canopen::Emergency emergency;
    };
    /// `dictionary` outlives the servo. `travel`: half the way between the limit switches; 0: there are none.
    Servo(canopen::Dictionary& dictionary, double travel) : d_(dictionary), travel_(travel) {}

    void power_on(Instant now);
    void power_off(Instant now);
    /// Asked before a write takes effect; what it does is done by `written`.
    [[nodiscard]] canopen::Abort may_write(canopen::Address address, std::int64_t value) const;
    void written(canopen::Address address, Instant now);
    /// The targets of cyclic modes that came by PDO are taken over.
    void on_sync(Instant now) { sync(now); }
    /// Sets the objects that are measured.
    void refresh(Instant now);
    /// What happens by itself until then, one event at a time.
    [[nodiscard]] Instant next_event(Instant now) const;
    void on_event(Instant at);

    void hold(bool held, Instant now);
    void fail(std::uint16_t code, Instant now);
    void set_cause(std::uint16_t code) { cause_ = code; }  ///< 0: a reset is taken again
    void place(double position, Instant now);
    /// Communication was lost or stopped (6007h).
    void connection_lost(Instant now);
    std::uint32_t inputs = 0;  ///< 60FDh, bits 16 and up
    bool limit_negative = false, limit_positive = false, home_switch = false;
    void inputs_changed(Instant now);

    [[nodiscard]] TwinMechanics mechanics(Instant now) const;
    [[nodiscard]] std::vector<Told> take_told() { return std::exchange(told_, {}); }
    [[nodiscard]] static const std::vector<std::uint16_t>& error_codes();
    [[nodiscard]] std::uint16_t statusword(Instant now) const;

private:
    [[nodiscard]] std::int64_t get(std::uint16_t index, std::uint8_t sub = 0) const { return d_.integer({index, sub}).value_or(0); }
    void put(std::uint16_t index, std::int64_t v) { (void)d_.set({index, 0}, Value{v}); }
    [[nodiscard]] double rate(std::uint16_t index) const { return static_cast<double>(std::max<std::int64_t>(1, get(index))); }
    [[nodiscard]] Ramps ramps() const;
    [[nodiscard]] bool powered() const { return state_ >= State::enabled && state_ <= State::fault_reaction; }
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
    void homed(Instant now);
    void halt(bool on, Instant now);
    void limit(Instant now);
    void probe(bool edge, Instant now);
    [[nodiscard]] double in_units(double mechanical) const { return mechanical - zero_; }

    canopen::Dictionary& d_;
    Mechanics m_;
    double travel_, zero_ = 0;
    State state_ = State::switch_on_disabled;
    std::optional<State> after_stop_;
    unsigned cw_ = 0;
    int mode_ = 1;
    bool halted_ = false, reached_ = false, acknowledged_ = false, limited_ = false;
    std::optional<double> target_;    ///< of the positioning under way, mechanical
    std::optional<double> buffered_;  ///< the next one, mechanical
    enum class Homing : std::uint8_t { none, to_switch, to_zero, attained, error } homing_ = Homing::none;
    double homing_zero_ = 0;
    std::uint16_t cause_ = 0;  ///< a fault whose cause stands
    Instant checked_{};
    std::optional<Instant> behind_since_;
    std::uint16_t probe_status_ = 0;
    std::vector<Told> told_;
};

}  // namespace axisgate::cia402_drive::twin
