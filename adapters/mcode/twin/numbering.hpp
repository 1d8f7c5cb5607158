// Numbering: the words that give places other numbers or another unit: P, C1, C2, MS, EE, AS, RD, SA, EL.
// In: their values. Out: a frame that is moved or scaled, MCode error codes.
// Never turns the shaft, except that AS = 3 starts torque mode.
#pragma once

#include "adapters/mcode/twin/moves.hpp"

namespace axisgate::mcode::twin {

class Numbering {
public:
    Numbering(Parts& parts, Course& course, Moves& moves) : p_(parts), course_(course), moves_(moves) {}

    /// Nothing: the word is none of these.
    [[nodiscard]] std::optional<int> write(Word word, const Number& n, Instant now);
    /// The settings of the factory; P is C1 again.
    void factory(Instant now);
    /// Power-up and IP.
    void load(const NonVolatile& memory, Instant now);

private:
    /// At rest, for figures that scale what is counted.
    int scale(Word word, double value, Instant now);
    int set_microsteps(std::int64_t ms, Instant now);
    int set_encoder_mode(bool on, Instant now);
    int set_hmt_mode(std::int64_t mode, Instant now);
    void change_units(const Shaft::Kept& k, Instant now);
    [[nodiscard]] double in_present_unit(const Shaft::Kept& k) const noexcept;
    void shift(double by) noexcept;

    Parts& p_;
    Course& course_;
    Moves& moves_;
};

}  // namespace axisgate::mcode::twin
