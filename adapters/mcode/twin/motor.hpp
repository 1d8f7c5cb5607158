// Motor: the motor of a Lexium: motion, rotor and encoder, homing, limits, hMT, inputs and outputs, currents, temperature and supply.
// In: words with worked-out fields, the tester's hand, time. Out: values, MCode error codes, a bounded queue of events.
// Never ticks: positions are evaluated in closed form when they are asked for, and deadline() is the next instant at which something
// happens. Never knows programs: a trip is a condition here.
//
// Positions are in the unit of P: microsteps, or encoder counts with EE = 1. The command and the rotor share that frame; they differ by
// the lag: slip of a stalled stepper, or the lead/lag register LL of hMT.
// Error codes are those of appendix "Error codes" [L8452-8630].
#pragma once

#include <deque>
#include <optional>

#include "adapters/mcode/twin/hmt.hpp"
#include "adapters/mcode/twin/homing.hpp"
#include "adapters/mcode/twin/io.hpp"
#include "adapters/mcode/twin/mechanism.hpp"
#include "adapters/mcode/twin/profile.hpp"
#include "adapters/mcode/twin/thermal.hpp"

namespace axisgate::mcode::twin {

class Motor final : public Mechanism {
public:
    explicit Motor(const MechanismSetup& setup);

    void restart(Instant now) override;
    void factory(Instant now) override;
    void save(NonVolatile& memory) const override;
    void load(const NonVolatile& memory, Instant now) override;

    Number read(Word word, Instant now, int& error) override;
    std::optional<std::string> text(Word word, Instant now) override;
    int write(Word word, std::span<const Number> fields, Instant now) override;
    int start(Word word, std::span<const Number> fields, Instant now) override;
    /// TI input; TP position; TR distance[,repeat]; TA mask; TC and TM have no field. Code 12: TC without an input of type 12.
    int arm(Word trip, std::span<const Number> fields, Instant now) override;
    void enable_trips(int te, Instant now) override;
    void capture(Instant now) override;
    void stop_at_once(Instant now) override;
    void pause(Instant now) override;
    void resume(Instant now) override;
    bool moving(Instant now) override;
    bool busy(bool any, Instant now) override;
    void tell(bool error_flag, bool program_running, Instant now) override;

    void advance(Instant now) override;
    Instant deadline() const override { return next_; }
    std::optional<MotorEvent> next_event() override;

    std::vector<HandItem> hand(Instant now) const override;
    std::optional<std::string> set_hand(const std::string& name, const Value& value, Instant now) override;
    TwinMechanics mechanics(Instant now) const override;

private:
    enum class Task : std::uint8_t { none, position, slew, homing, jog, torque, calibration, correction };
    enum class Phase : std::uint8_t {
        rest,
        steps,     ///< steps are given, or make-up is
        settling,  ///< MT
        holding    ///< HT
    };
    enum class Rotor : std::uint8_t { follows, held, catching_up };
    /// A counter: a value at a place of the frame, and its scale.
    struct Counter {
        double base = 0;
        double at = 0;
    };
    /// A switch beside the axis, in turns of the shaft.
    struct Cam {
        std::optional<double> turns;
        bool was = false;
    };
    /// Instants at which the present motion meets something.
    struct Due {
        Instant soft = never, mark = never, tp = never, tr = never, trip_pause = never, stall = never, lag = never, cam = never,
                wrap = never;
    };

    // Frame and counters: twin_encoder.cpp.
    [[nodiscard]] double setting(Word w) const noexcept { return settings_[static_cast<std::size_t>(w)]; }
    [[nodiscard]] std::int64_t whole(Word w) const noexcept { return static_cast<std::int64_t>(setting(w)); }
    void set(Word w, double v) noexcept { settings_[static_cast<std::size_t>(w)] = v; }
    /// Everything in encoder counts: EE = 1, and no hMT, with which motion is in step pulses whatever EE says [L696].
    [[nodiscard]] bool encoder_mode() const noexcept { return setting(Word::EE) != 0 && hmt_mode() == 0; }
    [[nodiscard]] int hmt_mode() const noexcept { return static_cast<int>(whole(Word::AS)); }
    [[nodiscard]] double counts_per_turn() const noexcept;
    [[nodiscard]] double steps_per_turn() const noexcept;
    [[nodiscard]] double units_per_turn() const noexcept { return encoder_mode() ? counts_per_turn() : steps_per_turn(); }
    [[nodiscard]] bool feedback() const noexcept { return encoder_mode() || hmt_mode() != 0; }
    [[nodiscard]] double direction() const noexcept { return setting(Word::RD) != 0 ? -1 : 1; }
    [[nodiscard]] Travel rotor(Instant now) const noexcept;
    /// What P counts: the rotor with an encoder in use, else the command.
    [[nodiscard]] Travel position(Instant now) const noexcept;
    [[nodiscard]] double lag(Instant now) const noexcept;
    /// LL: lag positive, lead negative, seen in the direction of the command [L3868-3874].
    [[nodiscard]] double owed(Instant now) const noexcept { return lag(now) * command_way(now); }
    [[nodiscard]] int command_way(Instant now) const noexcept;
    [[nodiscard]] double c1(Instant now) const noexcept;
    [[nodiscard]] double c2(Instant now) const noexcept;
    [[nodiscard]] double turns(Instant now) const noexcept;
    /// Keeps C1, C2 and the shaft where they are while the unit or the frame changes: take, change, place.
    struct Kept {
        double c1, c2, turns;
    };
    [[nodiscard]] Kept keep(Instant now) const noexcept { return {c1(now), c2(now), turns(now)}; }
    void put_back(const Kept& k, Instant now) noexcept;
    /// At rest with an encoder in use: the command begins where the rotor is.
    void resync(Instant now) noexcept;
    /// The command stands here, whatever it was; C1 does not count the difference.
    void stand_at(double position, Instant now) noexcept;
    void shift_frame(double by) noexcept;
    void write_counter(Word w, double value, Instant now);
    int set_encoder_mode(bool on, Instant now);
    void change_units(const Kept& k, Instant now);
    int set_microsteps(std::int64_t ms, Instant now);
    void stalled(Instant now);
    void correct(Instant now);
    void maintain(Instant now);
    [[nodiscard]] bool index_here(Instant now) const noexcept;

    // Motion: twin_motor_motion.cpp.
    [[nodiscard]] Kinematics kinematics() const noexcept;
    [[nodiscard]] double speed_limit() const noexcept;
    [[nodiscard]] int may_move(Word word, Instant now) const;
    int start_move(Word word, std::span<const Number> fields, Instant now);
    int start_slew(std::int64_t velocity, Instant now);
    int start_calibration(std::span<const Number> fields, Instant now);
    void command(Profile p, Instant now);
    void brake(Instant now);
    void freeze(Instant now);
    void steps_over(Instant now);
    void settled(Instant now);
    void finish(Instant now);
    void jog(Instant now);
    void follow(double steps, Instant now);

    // Homing: twin_homing.cpp. Limits and cams: twin_limits.cpp.
    int start_homing(Word word, std::span<const Number> fields, Instant now);
    void seek(int way, Instant now);
    void mark(bool active, Instant now);
    void home_leg_over(Instant now);
    void home_creep(Instant now);
    void homed(Instant now);
    [[nodiscard]] Instant mark_crossing(Instant now) const noexcept;
    int set_soft_limit(std::span<const std::int64_t> fields);
    [[nodiscard]] int held_limit(int way, Instant now) const noexcept;
    void limit_met(int way, Instant now);
    void judge_cams(Instant now);
    void place_switches(Instant now);
    [[nodiscard]] Instant cam_crossing(Instant now) const noexcept;
    [[nodiscard]] bool cam_active(std::size_t cam, Instant now) const noexcept;
    /// First instant at which the rotor passes these turns of the shaft.
    [[nodiscard]] Instant shaft_crossing(double t, Instant now) const noexcept;
    [[nodiscard]] Instant rotor_crossing(double x, Instant now, int way = 0) const noexcept;

    // hMT and the held shaft: twin_hmt.cpp.
    int set_hmt_mode(std::int64_t mode, Instant now);
    void run_torque(Instant now);
    void judge_rotor(Instant now);
    void make_up(Instant now);
    void caught_up(Instant now);
    void judge_lag(Instant now);
    void locked(Instant now);
    int clear_locked(Instant now);
    [[nodiscard]] bool waits_for_rotor() const noexcept;
    [[nodiscard]] double bound() const noexcept;
    [[nodiscard]] int status(Instant now) const noexcept;
    void status_trip(int bit, Instant now);

    // Points and supply: twin_motor_io.cpp.
    void edge(const InputEdge& e, Instant now);
    [[nodiscard]] bool output(std::size_t n, Instant now) const noexcept;
    [[nodiscard]] int current(Instant now) const noexcept;
    void judge_supply(Instant now);
    void bridges_off(Instant now);

    // twin_motor.cpp
    void raise(int code) { emit({MotorEvent::Kind::error, code, {}}); }
    void emit(const MotorEvent& e);
    void trip(Word w, Instant now, bool capture);
    void replan(Instant now);
    void handle(Instant t);
    [[nodiscard]] Instant position_crossing(double x, Instant now, int way = 0) const noexcept;
    [[nodiscard]] int available(Word word) const noexcept;
    int write_value(Word word, const Number& n, Instant now);
    void defaults() noexcept;
    void encoder_defaults() noexcept;

    MechanismSetup setup_;
    std::array<double, words.size()> settings_{};
    double index_offset_ = 0;  ///< FS: outlives FD [L2890]
    Inputs inputs_;
    Outputs outputs_;
    Supply supply_;

    // motion
    Task task_ = Task::none;
    Phase phase_ = Phase::rest;
    Instant phase_end_ = never;
    Profile command_ = Profile::rest(0);
    bool braking_ = false;          ///< towards a stop that was asked for, or that a limit made
    bool go_on_ = false;            ///< third field of MA, MR
    Instant passing_ = never;       ///< when a move that goes on passes its target
    std::optional<double> second_;  ///< second leg of mechanical backlash compensation
    int last_way_ = 0;              ///< of the last MA or MR
    double target_ = 0;
    double slew_ = 0;
    Word last_motion_ = Word::MR;
    int corrections_ = 0;
    Homing home_;
    bool aborted_ = false;  ///< stopped by a limit, input or fault: not a completion
    bool paused_ = false;
    std::optional<Word> after_pause_;
    double pause_value_ = 0;
    bool pause_go_on_ = false;
    std::optional<double> pause_second_;
    bool bridge_off_ = false;  ///< by a fault: locked rotor, over-temperature, LMM's enable input

    // rotor
    Rotor rotor_state_ = Rotor::follows;
    double slip_ = 0;  ///< command - rotor while it follows
    double held_at_ = 0;
    Profile catch_up_ = Profile::rest(0);
    Instant meeting_ = never;
    Counter c1_, c2_, shaft_;
    int way_ = 1;                ///< in which the present motion began, or the last one ended
    std::int64_t captured_ = 0;  ///< PC
    bool stall_flag_ = false;    ///< ST
    bool stall_told_ = false;
    bool held_ = false;  ///< by the hand
    double load_ = 0;
    Hmt hmt_;

    // soft limits and switches
    std::array<double, 2> soft_limit_{};  ///< minus, plus
    std::array<bool, 2> soft_on_{};
    std::array<Cam, 3> cams_{};  ///< limit minus, limit plus, home

    // trips
    int te_ = 0;
    int ti_input_ = 0;
    double tp_ = 0, tr_ = 0, tr_from_ = 0;
    int ta_mask_ = 0;
    Instant tr_pause_until_ = Instant::min();
    std::int64_t trip_pulses_ = 0;

    bool error_flag_ = false;
    bool program_running_ = false;
    int encoder_fault_ = 0;
    int output_fault_ = 0;
    bool enable_input_ = true;
    std::int64_t clock_pulses_ = 0;

    std::deque<MotorEvent> events_;
    Due due_;
    Instant next_ = never;
    Instant last_{};
};

}  // namespace axisgate::mcode::twin
