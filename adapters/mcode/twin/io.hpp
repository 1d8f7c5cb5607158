// Points: the four digital inputs with their filters, the analog input, and how the three outputs are set up.
// In: levels and signals from the tester's hand, IS, OS, D1..D5, time. Out: filtered activity, edges, counts, MCode error codes.
// Never acts on an edge: the motor does that by the type of the input.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "gateway/core/instant.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::mcode::twin {

/// Second field of IS [L768-786].
enum class InputType : std::uint8_t {
    general = 0,
    home = 1,
    limit_plus = 2,
    limit_minus = 3,
    go = 4,
    soft_stop = 5,
    pause = 6,
    jog_plus = 7,
    jog_minus = 8,
    reset = 11,
    capture = 12,
    step_direction = 13,
    encoder_ab = 14,
    up_down = 15
};
/// Second field of OS [L811-827].
enum class OutputType : std::uint8_t {
    general = 16,
    moving = 17,
    error = 18,
    stall = 19,
    velocity_changing = 20,
    locked_rotor = 21,
    to_position = 23,
    hmt_active = 24,
    makeup_active = 25,
    encoder_a = 26,
    encoder_b = 27,
    trip = 28,
    attention = 29
};

inline constexpr std::size_t input_count = 4;
inline constexpr std::size_t output_count = 3;
inline constexpr double analog_full = 4095;  ///< counts [E-45]

struct InputEdge {
    std::size_t input = 0;  ///< 0..3
    InputType type = InputType::general;
    bool active = false;
};

class Inputs {
public:
    /// `fitted`: 3 with NEMA 17, else 4 [L6919].
    Inputs(std::size_t fitted, bool configurable_analog) : fitted_(fitted), analog_set_(configurable_analog) {}
    void factory(Instant now);
    /// IS=n,type,active; IS=5,sense,range; IS=6,active. Codes: 6 another point has this type already, 8 the type does not
    /// belong on this point, 10 no such point, 11 a clock type without its pair, 21, 24 the analog input of an LMM.
    [[nodiscard]] int set_up(std::span<const std::int64_t> fields, Instant now);
    [[nodiscard]] std::string text() const;
    void save(NonVolatile& m) const;
    void load(const NonVolatile& m, Instant now);

    /// Levels of the pins, bit 0 = input 1. An open input is high.
    void levels(std::uint8_t mask, Instant now);
    /// Switches: these inputs are active whatever level IS makes that, also after IS changes it.
    void switches(std::uint8_t active_mask, Instant now);
    /// The pin of the input with this type becomes active or inactive; false: no input has it.
    [[nodiscard]] bool drive(InputType type, bool active, Instant now);
    [[nodiscard]] std::uint8_t levels() const noexcept { return levels_; }

    void filter(std::size_t input, int ms, Instant now);  ///< D1..D4
    [[nodiscard]] bool active(std::size_t input) const noexcept { return active_[input]; }
    [[nodiscard]] std::uint8_t active_mask() const noexcept;
    [[nodiscard]] std::optional<std::size_t> with_type(InputType type) const noexcept;
    [[nodiscard]] bool active(InputType type) const noexcept;
    [[nodiscard]] std::size_t fitted() const noexcept { return fitted_; }
    [[nodiscard]] InputType type(std::size_t input) const noexcept { return type_[input]; }

    [[nodiscard]] Instant deadline() const noexcept;
    /// Edges that are due up to `now`, oldest first, then by number; nothing when there is no more.
    [[nodiscard]] std::optional<InputEdge> next_edge(Instant now);

    void analog_counts(double counts, Instant now);
    /// V, or mA with IS=5,10: converted as IS says; an LMM has 0..3.6 V.
    void analog_signal(double value, Instant now);
    void analog_filter(int length, Instant now);  ///< D5
    /// I5: with D5 = n a running average over samples of 1 ms, A = (A*(n-1) + I)/n [L2244].
    [[nodiscard]] int analog(Instant now) const noexcept;
    [[nodiscard]] double analog_raw() const noexcept { return analog_; }
    [[nodiscard]] bool index_high() const noexcept { return index_high_; }

private:
    void judge(std::size_t input, Instant now);
    [[nodiscard]] bool raw(std::size_t input) const noexcept;
    [[nodiscard]] double filtered(Instant now) const noexcept;

    std::size_t fitted_;
    bool analog_set_;
    std::array<InputType, input_count> type_{};
    std::array<bool, input_count> high_{};       // active level
    std::array<bool, input_count> is_switch_{};  // hand gives activity, not level
    std::array<bool, input_count> closed_{};
    std::array<bool, input_count> active_{};
    std::array<int, input_count> filter_ms_{};
    std::array<Instant, input_count> due_{never, never, never, never};
    std::uint8_t levels_ = 0x0F;
    int sense_ = 9;
    int range_ = 0;
    bool index_high_ = false;
    double analog_ = 0;
    double average_ = 0;  // at average_at_
    Instant average_at_{};
    int average_length_ = 0;
};

class Outputs {
public:
    /// `only_third`: NEMA 17 has output 3 alone [L6919]. `closed_loop`: the types of hMT exist.
    Outputs(bool only_third, bool closed_loop) : only_third_(only_third), closed_loop_(closed_loop) {}
    void factory();
    /// OS=n,type[,active]. Codes: 6, 8, 10, 21 as with inputs.
    [[nodiscard]] int set_up(std::span<const std::int64_t> fields);
    /// O1..O3: code 37 for what NEMA 17 does not have, 9 for a point with a function.
    [[nodiscard]] int set(std::size_t output, bool on);
    [[nodiscard]] int set_all(std::int64_t mask);
    [[nodiscard]] std::string text() const;
    void save(NonVolatile& m) const;
    void load(const NonVolatile& m);
    [[nodiscard]] OutputType type(std::size_t output) const noexcept { return type_[output]; }
    [[nodiscard]] bool value(std::size_t output) const noexcept { return on_[output]; }
    [[nodiscard]] bool fitted(std::size_t output) const noexcept { return !only_third_ || output == 2; }
    [[nodiscard]] bool has(OutputType type) const noexcept;

private:
    bool only_third_;
    bool closed_loop_;
    std::array<OutputType, output_count> type_{OutputType::general, OutputType::general, OutputType::general};
    std::array<bool, output_count> high_{};
    std::array<bool, output_count> on_{};
};

/// Shortest pulse that passes the filters FC and FM, by their value 0..9 [L2850-2868, E-29].
[[nodiscard]] Duration shortest_pulse(int mode) noexcept;

}  // namespace axisgate::mcode::twin
