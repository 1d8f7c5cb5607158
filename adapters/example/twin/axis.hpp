// Axis is one axis of the simulated drive: registers, power, and motion as segments of constant acceleration. The state is calculated for
// any instant. A specimen's shaft follows that motion as its mechanics permit.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/core/shaft.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::example::twin {

class Axis {
public:
    explicit Axis(const FreedomValues& freedoms = {}, std::uint64_t seed = 0);

    static constexpr std::size_t settings = 13;  ///< R06..R18, in order
    static constexpr std::array<std::int64_t, settings> factory{4000, 20000, 20000, 40000, 100, 50, 1000, 5, 20, 0, 0, 0, 0};

    /// Returns the code of the refusal, 0: accepted. 11 no such register, 12 out of range, 13 in motion, 14 off or in fault. The specimen
    /// decides what is refused in motion, and whether R14..R18 exist.
    [[nodiscard]] int write(int number, std::int64_t v, Instant now);
    [[nodiscard]] int read(int number, std::int64_t& v) const;
    [[nodiscard]] std::string state(Instant now);  ///< the answer to S00
    void advance(Instant now);                     ///< detects events until then: a following error
    void hold(bool held, Instant now);             ///< holds the shaft, by hand
    void fail(int code, Instant now);
    void power_off(Instant now);  ///< of the whole drive: it loses its zero position
    [[nodiscard]] TwinMechanics mechanics(Instant now);

    std::array<std::int64_t, settings> values = factory;

private:
    struct Piece {
        double begin, position, velocity, acceleration;  // s since `since_`, increments
    };
    struct State {
        double position, velocity;
    };
    [[nodiscard]] State planned(Instant now) const;
    [[nodiscard]] double rate(std::size_t i) const { return static_cast<double>(values[i]); }
    void begin(Instant now);
    void add(double seconds, double acceleration);
    void rest();
    void move(double target, Instant now);
    void run(double velocity, double deceleration, Instant now);
    [[nodiscard]] bool moves(Instant now) const;
    [[nodiscard]] bool has(int number) const { return number <= 13 || all_registers_; }
    [[nodiscard]] int refusal(int number, std::int64_t v, Instant now) const;
    [[nodiscard]] bool powered(Instant now) const { return on_ && now >= on_from_; }
    [[nodiscard]] double place(Instant now) const;
    [[nodiscard]] double shown_place(Instant now) const;
    [[nodiscard]] int bits(Instant now) const;
    [[nodiscard]] int shown_bits(Instant now) const;
    void note(Instant now);
    void advance_shaft(Instant now);

    // The specimen.
    Shaft shaft_;
    Duration state_late_, power_delay_;
    double start_;
    bool all_registers_, retargets_, settings_at_rest_;

    std::vector<Piece> pieces_{{0, 0, 0, 0}};
    Instant since_{}, checked_{}, on_from_{};
    State at_{};
    double end_ = 0, zero_ = 0, held_at_ = 0;
    bool on_ = false, was_on_ = false, held_ = false, referenced_ = false, to_target_ = false;
    int fault_ = 0;
    Instant changed_{};    ///< the last order or event that changed the bits of S00 ...
    int bits_before_ = 0;  ///< ... and the bits that were shown then
};

}  // namespace axisgate::example::twin
