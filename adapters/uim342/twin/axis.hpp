// The axis of the twin: which motion is under way, the position counter, the encoder, lost pulses and the stall.
// In: starts and stops with their values, the shaft held or moved by hand, time. Out: counter, speed, and what happened at its deadline.
// Never knows instructions, flags or notifications. The pulses follow the profile exactly; a specimen's shaft follows the pulses as its
// mechanics permit: in closed loop the counter shows the shaft, in open loop a motor that lacks force falls out of step.
#pragma once

#include <cstdint>

#include "adapters/uim342/twin/motion.hpp"
#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"

namespace axisgate::uim342::twin {

class Axis {
public:
    /// Table 3.5 of motion states. A locked drive is `idle` here.
    enum class State : std::uint8_t {
        idle,
        jog,
        ptp,
        slow_stop,       ///< on the DC ramp; a new start is allowed
        emergency_stop,  ///< on the SD ramp; no start before its end
        coast            ///< the driver is off and the shaft runs out, seen by the encoder (closed loop)
    };
    enum class Event : std::uint8_t {
        none,
        stopped,  ///< a motion is over without having reached a target
        arrived,  ///< a point-to-point motion is at its target
        stalled,  ///< lost pulses have reached the stall tolerance
        too_fast  ///< the shaft has become faster than the motor may turn; told once per start
    };
    /// Values of one start, as they are in the registers [L803-805, L825].
    struct Values {
        std::uint32_t ac = 1;
        std::uint32_t dc = 1;
        bool as_time = false;  ///< AC and DC are ms between the cut-in and the desired speed
        std::uint32_t ss = 0;
        std::uint32_t bl = 0;
    };

    /// How pulses, encoder and shaft hang together.
    struct Mechanics {
        bool closed_loop = true;
        std::uint32_t tolerance = 100;    ///< lost pulses at which a stall is told
        double pulses_per_turn = 3200;    ///< that the motor takes: 200 steps, each divided by the microstepping
        double feedback_per_turn = 3200;  ///< that the drive makes of the fitted encoder's turn; another number is a wrong QE or MT
        int direction = 1;                ///< of the shaft for a growing counter: +1 counter-clockwise, facing the shaft [L771]
        [[nodiscard]] double shaft_per_turn() const noexcept { return closed_loop ? feedback_per_turn : pulses_per_turn; }
    };

    /// `seed` is that of the encoder's noise.
    explicit Axis(const ShaftFreedoms& freedoms = {}, std::uint64_t seed = 0) noexcept
        : free_(freedoms), seed_(seed), real_(freedoms, seed) {}
    /// Advances the shaft of a specimen. To be called before a question about `now`; changes do it themselves.
    void follow(Instant now) noexcept;

    /// Power came back: driver off, the counter begins here (absolute encoder: where the shaft is, incremental: 0), the shaft stands.
    void power_up(std::int32_t position, Instant now) noexcept;
    /// At rest only.
    void configure(const Mechanics& mechanics, Instant now) noexcept;

    [[nodiscard]] bool driver_on() const noexcept { return driver_on_; }
    /// Off in motion: the shaft is free and runs out by its own friction. On again before it stands: it is caught where it is.
    void set_driver(bool on, Instant now) noexcept;

    [[nodiscard]] State state() const noexcept { return state_; }
    [[nodiscard]] bool moving() const noexcept { return state_ != State::idle; }
    /// Position counter: the encoder in closed loop, the pulses sent in open loop. It wraps at 32 bits.
    [[nodiscard]] std::int32_t position(Instant now) const noexcept;
    /// The same without the flicker of an encoder.
    [[nodiscard]] std::int32_t place(Instant now) const noexcept;
    /// Position since the last start of a motion; frozen at rest.
    [[nodiscard]] std::int32_t relative(Instant now) const noexcept;
    /// Of the encoder in closed loop (0 while the shaft is held), of the pulses sent in open loop; pulse/s.
    [[nodiscard]] double speed(Instant now) const noexcept;
    /// +1 or -1 against the present direction of motion, at rest against the last one, never moved: -1.
    [[nodiscard]] int reverse_direction(Instant now) const noexcept;
    /// The shaft itself, in the counter's numbering: it differs from the counter by pulses lost in open loop.
    [[nodiscard]] MotionState shaft(Instant now) const noexcept;
    /// Turns of the shaft since the model was made, counter-clockwise positive; no origin and no setting renumbers them.
    [[nodiscard]] double turns(Instant now) const noexcept;

    void jog(Instant now, double velocity, const Values& values) noexcept;
    void move_to(Instant now, std::int32_t target, double speed, const Values& values) noexcept;
    /// By this displacement from the present counter.
    void move_by(Instant now, std::int64_t displacement, double speed, const Values& values) noexcept;
    void stop_slowly(Instant now, std::uint32_t dc, bool as_time) noexcept;
    /// sd = 0: at once.
    void stop_fast(Instant now, std::uint32_t sd) noexcept;
    /// The counter becomes 0 here and now, in motion too; both counters.
    void set_origin(Instant now) noexcept;

    /// The shaft is held (true) or let go. In closed loop it catches up when let go; that may complete a motion.
    [[nodiscard]] Event hold(bool held, Instant now) noexcept;
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// Pulses that the motor did not follow. In closed loop they add up to a stall; in open loop the shaft stays behind for good.
    [[nodiscard]] Event lose(std::int64_t pulses, Instant now) noexcept;
    [[nodiscard]] std::int64_t lost() const noexcept { return lost_; }
    void forget_lost(Instant now) noexcept;
    /// Moved by hand while free. Nobody counts it in open loop.
    void displace(double position, Instant now) noexcept;

    [[nodiscard]] Instant deadline() const noexcept { return deadline_; }
    /// To be called at `deadline()`.
    [[nodiscard]] Event step(Instant at) noexcept;

private:
    [[nodiscard]] Ramps ramps_for(const Values& values, double speed, MotionState from) const noexcept;
    [[nodiscard]] MotionState begin(Instant now) noexcept;
    void run(State state, const Profile& profile, double speed, const Values& values, Instant now) noexcept;
    void start_move(Instant now, double target, double speed, const Values& values, MotionState from) noexcept;
    void run_stop(State state, double rate, Instant now) noexcept;
    void renumber(double pulses) noexcept;
    void rest_at(double position) noexcept;
    Event stall(Instant at) noexcept;
    void plan(Instant now) noexcept;
    void end_coast(Instant now) noexcept;
    void keep_turns(Instant now) noexcept;

    friend class AxisShaft;
    // The specimen: `real_` is the shaft without `slip_`.
    ShaftFreedoms free_;
    std::uint64_t seed_ = 0;
    Shaft real_;
    bool was_on_ = false;       // a motor that never had current does not drift when it has none
    bool out_of_step_ = false;  // the shaft stands while the pulses go on (open loop)
    bool overloaded_ = false;   // closed loop: it lacks the stall tolerance
    Instant followed_{};
    Instant watch_at_ = never;  // when a motor of finite force is looked at next

    Profile profile_ = Profile::rest(0);
    State state_ = State::idle;
    bool driver_on_ = false;
    Mechanics mechanics_;
    double relative_zero_ = 0;
    double speed_ = 0;   // desired speed of the motion under way, pulse/s
    double cut_in_ = 0;  // SS of the motion under way
    int last_direction_ = 0;
    // The shaft: held at a place, or `slip_` off the pulses (open loop only).
    bool held_ = false;
    double held_at_ = 0;
    double slip_ = 0;
    std::int64_t lost_ = 0;
    double started_at_ = 0;  // counter when it left its last standstill: from there a wrong resolution adds up
    bool coasting_ = false;  // ... and `coast_` says where the free shaft is, in the counter's numbering
    Profile coast_ = Profile::rest(0);
    double turns_zero_ = 0;  // turns when the shaft was at `turns_from_`
    double turns_from_ = 0;
    bool speed_armed_ = false;      // too much speed is told once per start
    bool stall_armed_ = false;      // a stall is told once per start
    bool give_up_ = false;          // after a stall: where the shaft stands becomes where the drive is
    bool arrival_pending_ = false;  // pulses are at the target, the held shaft is not
    Instant stall_at_ = never;
    Instant too_fast_at_ = never;
    Instant deadline_ = never;
};

/// The counter's 32 bits.
[[nodiscard]] std::int32_t wrap_i32(double pulses) noexcept;

}  // namespace axisgate::uim342::twin
