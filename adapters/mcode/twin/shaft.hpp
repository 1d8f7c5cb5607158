// Shaft: the command and the rotor in the frame of P, the counters C1 and C2, the turns of the shaft.
// In: profiles of the command, what holds the rotor or lets it go. Out: places, speeds, instants at which a place is reached.
// Never changes what the shaft does by renumbering.
//
// Positions are in the unit of P: microsteps, or encoder counts with EE = 1. Command and rotor share that frame; they differ by the
// lag: slip of a stalled stepper, or the lead/lag register LL of hMT.
#pragma once

#include "adapters/mcode/twin/settings.hpp"

namespace axisgate::mcode::twin {

class Shaft {
public:
    enum class Rotor : std::uint8_t { follows, held, catching_up };
    /// C1, C2 and the turns, which stay while the unit or the frame changes: take, change, put back.
    struct Kept {
        double c1, c2, turns;
    };

    explicit Shaft(const Settings& settings) : settings_(settings) {}

    double stray = 0;  ///< of the real rotor from the place that is calculated here, in turns

    [[nodiscard]] const Profile& command() const noexcept { return command_; }
    [[nodiscard]] Travel commanded(Instant now) const noexcept { return command_.at(now); }
    [[nodiscard]] Rotor state() const noexcept { return state_; }
    [[nodiscard]] Travel rotor(Instant now) const noexcept;
    /// What P counts: the rotor with an encoder in use, else the command.
    [[nodiscard]] Travel position(Instant now) const noexcept { return settings_.feedback() ? rotor(now) : command_.at(now); }
    /// The rotor as the encoder shows it, and P with it: RealRotor's stray is in it.
    [[nodiscard]] Travel measured(Instant now) const noexcept;
    [[nodiscard]] Travel shown_position(Instant now) const noexcept { return settings_.feedback() ? measured(now) : command_.at(now); }
    [[nodiscard]] double lag(Instant now) const noexcept { return command_.at(now).position - rotor(now).position; }
    /// LL: lag positive, lead negative, seen in the direction of the command [L3868-3874].
    [[nodiscard]] double owed(Instant now) const noexcept { return lag(now) * way(now); }
    /// A reversal turns within one profile; after its end the last direction holds.
    [[nodiscard]] int way(Instant now) const noexcept;
    [[nodiscard]] double c1(Instant now) const noexcept;
    [[nodiscard]] double c2(Instant now) const noexcept;
    [[nodiscard]] double turns(Instant now) const noexcept;
    [[nodiscard]] bool index_here(Instant now) const noexcept;
    /// When a rotor that is catching up meets the command.
    [[nodiscard]] Instant meeting() const noexcept { return state_ == Rotor::catching_up ? meeting_ : never; }

    [[nodiscard]] Instant position_crossing(double x, Instant now, int way = 0) const noexcept;
    /// First instant at which the rotor passes these turns of the shaft.
    [[nodiscard]] Instant turns_crossing(double t, Instant now) const noexcept;
    /// When the command is this far from a held rotor.
    [[nodiscard]] Instant lag_crossing(double limit, Instant now) const noexcept;

    /// A new command; the rotor goes on as it did.
    void give(Profile p) noexcept { command_ = std::move(p); }
    void set_way(int way) noexcept { way_ = way; }
    /// The command stands here, whatever it was; C1 does not count the difference.
    void stand_at(double position, Instant now) noexcept;
    /// Command and rotor stand here; less than a unit is lost in rounding, in both alike.
    void settle_at(double position) noexcept;
    /// Both stand at once, at a whole unit; what an open-loop stepper has lost stays lost.
    void freeze(Instant now) noexcept;
    void hold_at(double position) noexcept;
    /// Free again: what the command has gone meanwhile is slip.
    void let_go(Instant now) noexcept;
    /// The shaft was turned to this place.
    void turn_to(double position, Instant now) noexcept;
    void chase(Profile p, Instant meeting) noexcept;
    /// Command and rotor are one again.
    void join() noexcept;
    void restart(bool held, Instant now) noexcept;

    [[nodiscard]] Kept keep(Instant now) const noexcept { return {c1(now), c2(now), turns(now)}; }
    void put_back(const Kept& k, Instant now) noexcept;
    /// As put_back, after a change of the unit: the slip is gone.
    void rescale(const Kept& k, Instant now) noexcept;
    /// At rest, and its number is this one from now on.
    void renumber(double position, const Kept& k, Instant now) noexcept;
    /// Moves the frame; C1, C2 and the turns stay.
    void shift(double by) noexcept;
    void add_c1(double by) noexcept { c1_.base += by; }
    void add_c2(double by) noexcept { c2_.base += by; }

private:
    /// A counter: a value at a place of the frame, and its scale.
    struct Counter {
        double base = 0;
        double at = 0;
    };
    [[nodiscard]] Instant rotor_crossing(double x, Instant now, int way) const noexcept;
    /// Where C1 counts from: step pulses, and with hMT the rotor.
    [[nodiscard]] double pulses(Instant now) const noexcept { return (settings_.hmt_mode() != 0 ? rotor(now) : command_.at(now)).position; }

    const Settings& settings_;
    Profile command_ = Profile::rest(0);
    Rotor state_ = Rotor::follows;
    double slip_ = 0;  ///< command - rotor while it follows
    double held_at_ = 0;
    Profile catch_up_ = Profile::rest(0);
    Instant meeting_ = never;
    Counter c1_, c2_, turns_;
    int way_ = 1;  ///< in which the present motion began, or the last one ended
};

}  // namespace axisgate::mcode::twin
