// Curves, cams and winding: the position that belongs to a count of the master encoder, in 0.1 um, and its change per count. Time is not
// known here; a drive asks for the count of an instant.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace axisgate::linmot::twin {

/// A position and its change per unit of the master.
struct Followed {
    double position = 0;
    double slope = 0;
};

/// A curve: the bytes of its info block, and its points.
struct Curve {
    std::vector<std::uint8_t> info;
    std::vector<std::uint8_t> data;
    [[nodiscard]] std::size_t points() const noexcept { return data.size() / 4; }
    [[nodiscard]] double point(std::size_t i) const noexcept;
    /// The x length of the info block: 10 us for time curves, counts for encoder curves.
    [[nodiscard]] double x_length() const noexcept;
    /// At the fraction 0..1 of its length, by linear interpolation; the slope is per whole length. Needs two points.
    [[nodiscard]] Followed at(double part) const noexcept;
    [[nodiscard]] double first() const noexcept { return point(0); }
    [[nodiscard]] double last() const noexcept { return point(points() - 1); }
};

/// A curve over a range of counts.
struct Cam {
    bool defined = false;
    bool enabled = true;
    std::uint16_t curve = 0;
    double start = 0;   ///< counts
    double length = 1;  ///< counts, at least 1
    double offset = 0;  ///< 0.1 um
    double scale = 1;
    std::optional<std::pair<double, double>> next;  ///< scale and length from its next start on (1y8xh)
    [[nodiscard]] double end() const noexcept { return start + length; }
    [[nodiscard]] bool used() const noexcept { return defined && enabled; }
    [[nodiscard]] Followed at(double count, const Curve& of) const noexcept;
};

/// Consecutive cams. Before the first and after the last the position stays at their ends; in modulo operation they are repeated.
struct CamRange {
    double first = 0;   ///< count
    double length = 0;  ///< from the first start to the last end; 0: there is no cam
    bool modulo = false;
    [[nodiscard]] static CamRange of(std::span<const Cam> cams, bool modulo) noexcept;
    [[nodiscard]] double wrapped(double count) const noexcept;
    /// Whether the way between two counts passes a place of the range.
    [[nodiscard]] bool passes(double from, double to, double place) const noexcept;
    /// The next count at which the place is reached in this direction; empty: never.
    [[nodiscard]] std::optional<double> meets(double from, double place, bool upwards) const noexcept;
};
/// The cam that is in force at a count: the one that started last before it, or the first.
[[nodiscard]] const Cam* cam_at(std::span<const Cam> cams, const CamRange& range, double count) noexcept;

/// Winding on a bobbin. The manual names these values without numbers or a formula: the model is a choice.
struct Winding {
    double left = 0, right = 500'000;             ///< 0.1 um, at the start
    double end_left = 0, end_right = 500'000;     ///< at the end
    double start_ratio = 8000, end_ratio = 8000;  ///< counts per stroke
    double revolutions = 100;                     ///< until the end ratio
    double disturbance_length = 0;                ///< strokes; 0: none
    double disturbance_stroke = 0;                ///< 0.1 um
    bool antiparallel = false;
    /// `turned`: counts since the start; `adapted`: the same without the time in which the adaptation was held.
    [[nodiscard]] double at(double turned, double adapted, double counts_per_revolution, const Curve* shape) const noexcept;
    [[nodiscard]] double strokes(double turned, double counts_per_revolution) const noexcept;
};

}  // namespace axisgate::linmot::twin
