// Mechanics of the simulated servo: where its demand is at any instant, as pieces of constant acceleration, and a shaft that can be held.
// In: orders with an instant (to a place, at a speed, with a torque, to a stop). Out: demand and shaft at any later instant, in closed
// form. Never jumps: an order goes on from where the one before had come to. Increments of the motor, seconds.
#pragma once

#include <vector>

#include "gateway/core/instant.hpp"

namespace axisgate::cia402_drive::twin {

struct Motion {
    double position = 0, velocity = 0;
};
struct Ramps {
    double velocity = 0, up = 0, down = 0;  ///< increments/s, increments/s^2
};

class Mechanics {
public:
    void move(double target, const Ramps& ramps, Instant now);
    void run(double velocity, const Ramps& ramps, Instant now);
    void stop(double down, Instant now) { run(0, {0, down, down}, now); }
    /// One step of a cyclic mode: there in `seconds`, and then it waits for the next.
    void step_to(double target, double seconds, Instant now);
    /// Constant torque: a shaft without friction, up to a speed.
    void push(double acceleration, double most_velocity, Instant now);
    /// The demand is here and stands: power was taken away, or the shaft has slipped.
    void rest_at(double position, Instant now);
    void hold(bool held, Instant now);

    [[nodiscard]] Motion demand(Instant now) const;
    [[nodiscard]] Motion shaft(Instant now) const;
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// When the demand comes to rest, or to its last speed.
    [[nodiscard]] Instant end() const;
    [[nodiscard]] bool moves(Instant now) const;

private:
    struct Piece {
        double begin, position, velocity, acceleration;  // seconds after since_
    };
    void begin(Instant now);
    void add(double seconds, double acceleration);
    void rest() { pieces_.push_back({end_, at_.position, at_.velocity, 0}); }
    std::vector<Piece> pieces_{{0, 0, 0, 0}};
    Instant since_{};
    Motion at_;
    double end_ = 0, held_at_ = 0, step_velocity_ = 0;
    bool held_ = false;
};

}  // namespace axisgate::cia402_drive::twin
