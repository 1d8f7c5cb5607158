// Settings: the values of the motor's words, and what they make of the drive: modes, units, speeds.
// In: values that were judged before. Out: the same, counts and steps per turn, ramps, what S saves.
// Never judges a value, except those of a memory that was edited by hand.
#pragma once

#include "adapters/mcode/twin/mechanism.hpp"
#include "adapters/mcode/twin/profile.hpp"

namespace axisgate::mcode::twin {

/// 3000 revolutions per minute: the most that make-up and torque mode run [L7567-7574].
inline constexpr double top_turns_per_second = 50;

class Settings {
public:
    explicit Settings(const MechanismSetup& setup) : setup_(setup) { factory(); }

    [[nodiscard]] double operator[](Word w) const noexcept { return values_[static_cast<std::size_t>(w)]; }
    [[nodiscard]] std::int64_t whole(Word w) const noexcept { return static_cast<std::int64_t>((*this)[w]); }
    void set(Word w, double v) noexcept { values_[static_cast<std::size_t>(w)] = v; }
    /// The figures of the factory; FS outlives them [L2890].
    void factory() noexcept;
    [[nodiscard]] const MotorManners& manners() const noexcept { return setup_.manners; }
    /// VI, VM, A and D of the present unit.
    void unit_defaults() noexcept;
    void save(NonVolatile& m) const;
    void load(const NonVolatile& m);

    /// Whether the drive is one of these products.
    [[nodiscard]] bool is(std::uint8_t products) const noexcept { return (setup_.product & products) != 0; }
    /// 37 for a word that this drive does not have, else 0.
    [[nodiscard]] int available(Word word) const noexcept;

    /// Everything in encoder counts: EE = 1, and no hMT, with which motion is in step pulses whatever EE says [L696].
    [[nodiscard]] bool encoder_mode() const noexcept { return (*this)[Word::EE] != 0 && hmt_mode() == 0; }
    [[nodiscard]] int hmt_mode() const noexcept { return static_cast<int>(whole(Word::AS)); }
    /// AS = 1 or 2: what the rotor owes is made up.
    [[nodiscard]] bool makes_up() const noexcept { return hmt_mode() == 1 || hmt_mode() == 2; }
    /// The rotor is what P counts, not the command.
    [[nodiscard]] bool feedback() const noexcept { return encoder_mode() || hmt_mode() != 0; }
    [[nodiscard]] double counts_per_turn() const noexcept { return 4 * (is(lmm) ? (*this)[Word::EL] : setup_.manners.encoder_lines); }
    [[nodiscard]] double steps_per_turn() const noexcept { return 360.0 / (*this)[Word::SA] * (*this)[Word::MS]; }
    [[nodiscard]] double units_per_turn() const noexcept { return encoder_mode() ? counts_per_turn() : steps_per_turn(); }
    [[nodiscard]] double direction() const noexcept { return (*this)[Word::RD] != 0 ? -1 : 1; }
    [[nodiscard]] Kinematics kinematics() const noexcept;
    /// VI as a speed to creep at, at least 1 unit/s.
    [[nodiscard]] double creep_speed() const noexcept;
    [[nodiscard]] double speed_limit() const noexcept;

private:
    MechanismSetup setup_;
    std::array<double, words.size()> values_{};
};

}  // namespace axisgate::mcode::twin
