// Moves: MA, MR, SL, SC, jog, following and pause; what limits and the soft stop do to a motion, and what comes at its end.
// In: instructions with fields, inputs. Out: motions, MCode error codes, events.
// Never starts what it cannot finish: every refusal comes before anything changes.
#pragma once

#include "adapters/mcode/twin/homing.hpp"

namespace axisgate::mcode::twin {

class Moves {
public:
    Moves(Parts& parts, Course& course, Homing& homing) : p_(parts), course_(course), homing_(homing) {}

    void restart() noexcept;
    /// MA MR SL HM HI HF SC CF; SL with its one field.
    [[nodiscard]] int start(Word word, std::span<const Number> fields, Instant now);
    /// MD: the last of MA, MR, SL.
    [[nodiscard]] Word last() const noexcept { return last_; }

    void steps_over(Instant now);
    /// MT or HT is over.
    void phase_over(Instant now);
    /// The motion meets a limit in this direction (1, -1).
    void limit_met(int way, Instant now);
    /// Input of type 5; `ends_program`: one runs. Ignored when the program is paused [L776].
    void soft_stop(bool ends_program, Instant now);

    /// JE = 1: an active jog input runs the motor at VM, and its release stops it [L778, L3694-3697].
    void jog(Instant now);
    /// FL = 1: pulses at inputs 3 and 4 move the axis one to one, at the moment at which they come [L2912].
    void follow(double steps, Instant now);

    void pause(Instant now);
    /// Error of the motion that could not go on; nothing if none was paused.
    [[nodiscard]] std::optional<int> resume(Instant now);
    void forget_pause() noexcept;
    /// The frame moves.
    void shift(double by) noexcept;

private:
    [[nodiscard]] int start_move(Word word, std::span<const Number> fields, Instant now);
    [[nodiscard]] int start_slew(std::int64_t velocity, Instant now);
    [[nodiscard]] int start_calibration(std::span<const Number> fields, Instant now);
    void position(double target, std::optional<double> second, bool go_on, Instant now);

    Parts& p_;
    Course& course_;
    Homing& homing_;
    Word last_ = Word::MR;
    int last_way_ = 0;  ///< of the last MA or MR
    double slew_ = 0;
    bool paused_ = false;
    std::optional<Word> after_pause_;
    std::int64_t pause_value_ = 0;  ///< velocity of SL, type of a homing
    Course::Demand paused_demand_;  ///< of MA, MR
};

}  // namespace axisgate::mcode::twin
