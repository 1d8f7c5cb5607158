// Synchronisation of an axis with its master: SYNCV, SYNCP and SYNCM, one step per millisecond [L3882-4783, L5011-5110, L5796-5998]. From
// the master's position in whole qc and passed markers follows the next command position of the slave. VEL, ACC and DEC are never exceeded,
// and no quad count of the gear is lost. Units: qc, ms.
#pragma once

#include <cstdint>
#include <optional>

#include "adapters/aposs/twin/approach.hpp"
#include "adapters/aposs/twin/filters.hpp"
#include "adapters/aposs/twin/superposition.hpp"

namespace axisgate::aposs {

enum class SyncMode : std::uint8_t { none, velocity, position, marker };

struct SyncParameters {
    std::int64_t fact_m = 1, fact_s = 1, offset = 0, accuracy = 1000, ready = 1, fault = 10;
    std::int64_t pulse_m = 500, pulse_s = 500, window_m = 0, window_s = 0, mark_m = 1, mark_s = 1, start = 0;
    std::int64_t offset_time = 0, filter_time = 0, filter_par = 0, slave_filter_time = 0, most_correction = 0;
    std::int64_t velocity_time = 0, velocity_limit = 0, velocity_relation = 0, feed_forward = 0, type = 0;
    std::int64_t resolution = 500;                            ///< MENCODER
    int reverse = 0;                                          ///< REVERS, units: 1: only while the master reverses, 2: never
    double velocity = 0, acceleration = 0, deceleration = 0;  ///< VEL, ACC, DEC: qc/ms, qc/ms^2
    double jerk = 0;                                          ///< from RAMPMIN and JERKMIN: qc/ms^3; 0: not set
    /// SYNCMFPAR & 64: markers are observed and averaged even without a synchronisation.
    [[nodiscard]] bool always_watches() const { return (filter_par & 64) != 0; }
};

struct SyncInput {
    std::int64_t master = 0;
    double slave = 0;                           ///< actual position
    std::optional<std::int64_t> master_marker;  ///< position of the master at a marker that was passed since the previous step
    std::optional<double> slave_marker;
};

/// SYNCSTAT: the manual prints no bit numbers (E-65), only names.
struct SyncStatus {
    bool accuracy = false, ready = false, fault = false, master_window = false, slave_window = false;
};

class Synchronisation {
public:
    /// The slave is at its command position with this speed (qc/ms). The size of the accuracy window is taken now [L4176]. The markers of
    /// `here` are known places that may be far behind: SYNCMSTART 7 needs them.
    void begin(SyncMode mode, const SyncParameters& p, const SyncInput& here, double command, double velocity);
    void end() { mode_ = SyncMode::none; }
    [[nodiscard]] SyncMode mode() const noexcept { return mode_; }
    /// One millisecond; returns the command position at its end.
    double step(const SyncParameters& p, const SyncInput& in);
    /// One millisecond without SYNCM: only markers, with SYNCMFPAR & 64 [L2424].
    void watch(const SyncParameters& p, const SyncInput& in);
    /// The polynomial of SYNCMSTART 7, or the wait for it.
    [[nodiscard]] bool approaches() const noexcept { return approach_.active(); }

    /// SYNCERR in qc; with a sign if SYNCACCURACY is negative.
    [[nodiscard]] double error() const { return accuracy_ < 0 ? error_ : std::fabs(error_); }
    /// DEFMORIGIN during synchronisation: this position of the master becomes 0. The slave does not move.
    void shift_master(std::int64_t by);
    [[nodiscard]] const SyncStatus& status() const noexcept { return status_; }
    void clear_window_flags() { status_.master_window = status_.slave_window = false; }
    [[nodiscard]] std::int64_t negative_buffer() const noexcept { return negative_; }             ///< SYSVAR 4315
    [[nodiscard]] double marker_distance() const noexcept { return master_.average.distance(); }  ///< SYSVAR 4238
    [[nodiscard]] double filter_error() const noexcept { return filter_.error(); }                ///< PFG_MFILTERROR
    [[nodiscard]] double velocity() const noexcept { return velocity_; }                          ///< of the command, qc/ms

private:
    /// The accepted markers of one side.
    struct Markers {
        std::optional<double> last;  ///< distances are measured from this one
        std::int64_t count = 0;      ///< accepted since the last pair
        MarkerAverage average;
    };
    [[nodiscard]] std::int64_t geared(std::int64_t master_way, const SyncParameters& p);
    [[nodiscard]] std::int64_t forward(std::int64_t master_way, const SyncParameters& p);
    [[nodiscard]] bool accepts(Markers& m, double place, std::int64_t pulse, std::int64_t window, bool& flag, std::int64_t filter_time,
                               const SyncParameters& p);
    void take_markers(const SyncParameters& p, const SyncInput& in);
    [[nodiscard]] std::pair<bool, bool> check_markers(const SyncParameters& p, const SyncInput& in);
    [[nodiscard]] double approach(const SyncParameters& p, const SyncInput& in, std::int64_t way);
    void pair(const SyncParameters& p, double wanted_at_master_marker, double slave_place);
    [[nodiscard]] double first_correction(const SyncParameters& p, double difference, double cycle) const;
    void correct(const SyncParameters& p, double difference);
    void evaluate(const SyncParameters& p, double difference);
    [[nodiscard]] double follow(const SyncParameters& p);

    SyncMode mode_ = SyncMode::none;
    std::int64_t master_at_ = 0, rest_ = 0, negative_ = 0, accuracy_ = 1000, offset_seen_ = 0;
    double wanted_ = 0, command_ = 0, velocity_ = 0, filtered_velocity_ = 0, error_ = 0;
    VelocityFilter filter_;
    Approach approach_;
    double marker_velocity_ = 0;  ///< Oldmfiltvel
    Superposition offset_, correction_;
    double per_ms_ = 0, per_ms_left_ = 0;  ///< KORRVAL: the addition per ms, and the remaining correction
    double start_value_ = 0, start_rest_ = 0, smoothed_ = 0;
    Markers master_, slave_;
    std::optional<double> master_mark_;  ///< the wanted position of the slave when that marker passed
    std::optional<double> slave_mark_;
    bool synchronous_ = false;  ///< the master's velocity was reached since the start
    bool paired_ = false, offset_allowed_ = false;
    std::int64_t accurate_ = 0, inaccurate_ = 0, since_filter_reset_ = 0;
    SyncStatus status_;
};

}  // namespace axisgate::aposs
