// Output lane: what becomes of the 32 bytes that an originator renews for one axis: edges are commands, what is streamed are set-points.
// In: registers 32..45 as they were sent, the axis' picture. Out: a ProcessData where something has changed, a SetPoint in modes 8 and 9.
// Never begins anything because it was begun itself: bits 4 and 7 of the first control word count as held until they were low once, and
// what is 0 from the start is not sent. Values wait while a command is on its way; a control word does not.
#pragma once

#include <optional>

#include "gateway/axis/image.hpp"
#include "gateway/core/command.hpp"
#include "gateway/protocols/cip/bytes.hpp"

namespace axisgate::enip {

/// Registers 32..45, little endian in 32 bytes.
struct Wanted {
    std::uint16_t controlword = 0;
    std::int16_t mode = 0;
    std::int32_t target_position = 0;
    std::uint32_t profile_velocity = 0, profile_acceleration = 0, profile_deceleration = 0;
    std::int32_t target_velocity = 0;
    std::int16_t homing_method = 0;
    bool operator==(const Wanted&) const = default;
};
/// Of 32 bytes.
[[nodiscard]] Wanted read_wanted(cip::View bytes) noexcept;
/// All of it, for a write that stands by itself.
[[nodiscard]] ProcessData all_of(const Wanted& wanted) noexcept;

class OutputLane {
public:
    struct Step {
        std::optional<ProcessData> command;
        std::optional<SetPoint> set_point;  ///< axis, times and origin are the caller's
    };
    /// From here on as if nothing had been sent.
    void reset() { *this = {}; }
    [[nodiscard]] Step take(const Wanted& wanted, const AxisPicture& axis);
    /// A command of step() was handed on / has its result: then what waited may go.
    void begun() noexcept { ++on_their_way_; }
    [[nodiscard]] Step done();

private:
    [[nodiscard]] Step next();
    Wanted wanted_, sent_;
    std::uint16_t held_ = 0;  // bits that were set from the start
    std::uint32_t on_their_way_ = 0;
    bool any_ = false;
};

}  // namespace axisgate::enip
