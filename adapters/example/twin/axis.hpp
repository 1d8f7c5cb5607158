// Axis of the simulated drive: registers, power, motion as pieces of constant acceleration.
// In: registers written, time. Out: registers read, the state. Any instant can be asked; nothing runs between the questions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "gateway/core/instant.hpp"
#include "gateway/core/twin.hpp"

namespace axisgate::example::twin {

class Axis {
public:
    static constexpr std::size_t settings = 13;  ///< R06..R18, in order
    static constexpr std::array<std::int64_t, settings> factory{4000, 20000, 20000, 40000, 100, 50, 1000, 5, 20, 0, 0, 0, 0};

    /// The code of the refusal, 0: taken. 11 no such register, 12 out of range, 13 it moves, 14 off or in a fault.
    [[nodiscard]] int write(int number, std::int64_t v, Instant now);
    [[nodiscard]] int read(int number, std::int64_t& v) const;
    [[nodiscard]] std::string state(Instant now);  ///< the answer to S00
    void advance(Instant now);                     ///< finds out what has happened until then: a following error
    void hold(bool held, Instant now);             ///< the shaft, by hand
    void fail(int code, Instant now);
    void power_off(Instant now);  ///< of the whole drive: it has forgotten its zero
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

    std::vector<Piece> pieces_{{0, 0, 0, 0}};
    Instant since_{}, checked_{};
    State at_{};
    double end_ = 0, zero_ = 0, held_at_ = 0;
    bool on_ = false, held_ = false, referenced_ = false, to_target_ = false;
    int fault_ = 0;
};

}  // namespace axisgate::example::twin
