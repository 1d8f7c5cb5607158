// Homing of a MACS: HOME by HOME_TYPE, HOME_VEL, HOME_RAMP and HOME_OFFSET, one step per millisecond [L3592-3662, L1810-1830]. It gives
// orders to the axis and calculates the zero position. The slow velocity is a fraction of HOME_VEL that is not printed: one quarter here
// (E-18).
#pragma once

#include <cstdint>
#include <optional>

namespace axisgate::aposs {

struct HomingParameters {
    std::int64_t type = 0;      ///< 0: reverse and index, 1: reverse, 2: forward and index, 3: forward
    double velocity = 0;        ///< qc/s; the sign is the direction of the search
    double offset = 0;          ///< qc
    double index_distance = 0;  ///< qc per turn of the encoder
    [[nodiscard]] bool to_index() const { return type == 0 || type == 2; }
    [[nodiscard]] bool reverses() const { return type <= 1; }
    [[nodiscard]] double leaving() const { return (reverses() ? -1 : 1) * velocity / 4; }
};
struct HomingInput {
    double place = 0;  ///< of the shaft, qc of the encoder: index pulses are at multiples of one turn
    bool on_switch = false;
    bool index_pulses = true;
    bool stands = false;  ///< the ordered motion has ended
};

class HomingRun {
public:
    enum class Phase : std::uint8_t { none, search, leave, index, offset, done, index_missed };
    struct Order {
        std::optional<double> run;  ///< qc/s from now on
        std::optional<double> go;   ///< to this position
    };
    Order begin(const HomingParameters& p, const HomingInput& in);
    /// One millisecond has passed.
    Order step(const HomingInput& in);
    void stop() noexcept { phase_ = Phase::none; }
    [[nodiscard]] Phase phase() const noexcept { return phase_; }
    [[nodiscard]] bool active() const noexcept { return phase_ >= Phase::search && phase_ <= Phase::offset; }
    [[nodiscard]] double zero() const noexcept { return zero_; }  ///< valid when homing has ended

private:
    Order leave();
    Order to_offset(double reference);
    HomingParameters p_;
    Phase phase_ = Phase::none;
    double from_ = 0, before_ = 0, zero_ = 0;
    bool was_on_ = false;  ///< state of the switch while the axis leaves it
};

}  // namespace axisgate::aposs
