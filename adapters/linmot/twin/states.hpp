// States is the state machine of a simulated drive: transitions, errors, status word, StateVar, warn word.
#pragma once

#include <cstdint>

#include "adapters/linmot/twin/body.hpp"
#include "adapters/linmot/twin/control_word.hpp"

namespace axisgate::linmot::twin {

enum State : std::uint8_t {
    not_ready = 0,
    switch_on_disabled = 1,
    ready_to_switch_on = 2,
    setup_error = 3,
    error = 4,
    hardware_tests = 5,
    ready_to_operate = 6,
    operation_enabled = 8,
    homing = 9,
    clearance = 10,
    to_initial = 11,
    aborting = 12,
    freezing = 13,
    quick_stop = 14,
    to_position = 15,
    jog_plus = 16,
    jog_minus = 17,
    linearizing = 18,
    phase_search = 19,
    special = 20
};

class States {
public:
    explicit States(Body& body) : body_(body) {}

    void power_on() noexcept { word_.power_on(); }
    void start_software(Instant now);
    void stop_software(Instant now);
    [[nodiscard]] bool running() const noexcept { return running_; }

    /// The control word of the interface; the control word in force is made of it and of the other sources.
    void write(std::uint16_t word, Instant now);
    void decide(Instant now);
    /// Carries out transitions until the state no longer changes.
    void evaluate(Instant now);
    /// The first error is kept.
    void raise(Fault code, Instant now);
    /// Checks the conditions outside: errors, the force limit, limit switches.
    void check(Instant now);

    [[nodiscard]] std::uint8_t state() const noexcept { return state_; }
    [[nodiscard]] Fault error_code() const noexcept { return error_; }
    [[nodiscard]] bool in_error() const noexcept { return state_ == error || state_ == setup_error; }
    [[nodiscard]] bool stops_by_error() const noexcept { return state_ == quick_stop && by_error_; }
    [[nodiscard]] bool powered() const noexcept { return state_ >= operation_enabled; }
    [[nodiscard]] bool moves(Instant now) const { return powered() && body_.demand.moves(now); }
    [[nodiscard]] std::uint16_t control_word() const noexcept { return word_.value(); }
    [[nodiscard]] std::uint16_t status_word(Instant now) const;
    [[nodiscard]] std::uint16_t state_var(Instant now) const;
    [[nodiscard]] std::uint16_t warn_word(Instant now) const;
    [[nodiscard]] double demand(Instant now) const;

    // --- time ---
    /// When a test ends, or the conditions outside must be checked.
    [[nodiscard]] Instant due(Instant now) const;
    /// Checks conditions that have changed with time alone.
    void look(Instant now);
    /// True: a test has ended.
    bool finish_test(Instant now);
    /// Whether the state waits for the end of its motion, and when that is, including the brake.
    [[nodiscard]] bool awaits_end() const noexcept;
    [[nodiscard]] Instant motion_end() const;
    void finish_motion(Instant now);
    /// The motion of the present state has ended.
    [[nodiscard]] bool arrived() const noexcept { return sub_ == 0x0F; }

private:
    static constexpr Duration search_time = std::chrono::seconds(1);

    void enter(std::uint8_t state, Instant now);
    /// From one state with power to another.
    void pass_to(std::uint8_t state, Instant now, std::uint8_t sub = 0) noexcept;
    void unpower(Instant now);
    bool transit(Instant now);
    bool transit_powered(Instant now);
    bool transit_operating(Instant now);
    void brake_to(std::uint8_t state, Instant now);
    void move_to(std::uint8_t state, double target, Instant now);
    void limit_switch(Instant now);
    [[nodiscard]] bool released(Instant now);
    [[nodiscard]] bool brakes_on_abort() const noexcept { return body_.memory.ram(0x1717) != 0 && body_.memory.ram(0x1718) != 0; }
    [[nodiscard]] bool cw(int bit) const noexcept { return word_.bit(bit); }

    Body& body_;
    bool running_ = false;
    std::uint8_t state_ = not_ready, sub_ = 0;
    Instant since_{};  ///< start of the state
    Fault error_ = 0;  ///< of states 3, 4, and of 14 on the way to them
    bool fatal_ = false;
    bool by_error_ = false;  ///< an error caused the quick stop
    ControlWord word_;
    Instant abort_over_ = never;  ///< after the release of the brake
};

}  // namespace axisgate::linmot::twin
