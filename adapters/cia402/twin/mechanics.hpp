// Mechanics of the simulated servo: where its demand is at any instant, as pieces of a profile, and a shaft that lags behind it or is held.
// In: orders with an instant (to a place, at a speed, with a torque, to a stop). Out: demand and shaft at any later instant, in closed
// form. Never jumps: an order goes on from where the one before had come to. Increments of the motor, seconds.
#pragma once

#include <vector>

#include "adapters/cia402/twin/profile.hpp"
#include "gateway/core/instant.hpp"

namespace axisgate::cia402_drive::twin {

class Mechanics {
public:
    void move(double target, const Ramps& ramps, Instant now);
    void run(double velocity, const Ramps& ramps, Instant now);
    void stop(const Ramps& ramps, Instant now) { run(0, ramps, now); }
    /// One step of a cyclic mode: there in `seconds`, and then it waits for the next.
    void step_to(double target, double seconds, Instant now);
    /// A torque: a shaft without friction, up to a speed. `slope`: how fast the acceleration may change, increments/s^3; 0: at once.
    void push(double acceleration, double slope, double most_velocity, Instant now);
    /// The demand is here and stands: power was taken away, or the shaft has slipped.
    void rest_at(double position, Instant now);
    void hold(bool held, Instant now);
    /// What a position controller leaves: the shaft is behind its demand by the way of so many seconds.
    void set_lag(double seconds) { lag_ = seconds; }
    [[nodiscard]] bool lags() const noexcept { return lag_ > 0; }

    /// What the encoder says beside where the shaft is, from now on; a swing of so many increments to both sides in 7 ms.
    void misread(double by) { misread_ = by; }
    void swing(double size) { swing_ = size; }
    [[nodiscard]] double swings() const noexcept { return swing_; }
    [[nodiscard]] bool misreads() const noexcept { return misread_ != 0 || swing_ != 0; }

    [[nodiscard]] Motion demand(Instant now) const;
    [[nodiscard]] Motion shaft(Instant now) const;
    /// As the encoder has it.
    [[nodiscard]] double read(Instant now) const;
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// When the demand comes to rest, or to its last speed.
    [[nodiscard]] Instant end() const;
    [[nodiscard]] bool moves(Instant now) const;
    /// What is pushing now, as an acceleration; also where the top speed is reached.
    [[nodiscard]] double pushed(Instant now) const;

private:
    struct Piece {
        double begin;  // seconds after since_
        Motion from;
        Segment how;
    };
    void begin(Instant now);
    void take(const Profile& profile);
    void add(const Segment& segment);
    void rest() { pieces_.push_back({end_, at_, {}}); }
    std::vector<Piece> pieces_{{0, {}, {}}};
    Instant since_{};
    Motion at_;
    double end_ = 0, held_at_ = 0, step_velocity_ = 0, lag_ = 0, misread_ = 0, swing_ = 0;
    double push_from_ = 0, push_to_ = 0, push_slope_ = 0;
    bool held_ = false;
};

}  // namespace axisgate::cia402_drive::twin
