// Output lane: what becomes of the 32 bytes that an originator renews for one axis: edges are commands, what is streamed are set-points.
// In: registers 32..45 as they were sent, the axis' picture. Out: a ProcessData where something has changed, a SetPoint in modes 8 and 9.
// The first image is handed on whole, zeros too: a control word of 0 switches off what others have switched on.
// Never moves anything by the first image: bits 4 and 7 of its control word count as held until they were low once, an axis that stands
// halted stays so, and its speed and positions are a base: another one counts. Values wait while a command is on its way; a word does not.
// Where a drive begins to answer, or another drive, channel or twin speaks for the axis, the next image is a first one: what was sent was
// sent to nobody, or to the one before.
#pragma once

#include <optional>

#include "gateway/axis/image.hpp"
#include "gateway/core/command.hpp"
#include "gateway/protocols/cip/bytes.hpp"
#include "gateway/site/mapping.hpp"

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
/// Members of it that an output has; what it has not is never sent, and its mode is the axis' own.
enum WantedMember : std::uint8_t {
    has_controlword = 1,
    has_mode = 2,
    has_target_position = 4,
    has_profile_velocity = 8,
    has_profile_acceleration = 16,
    has_profile_deceleration = 32,
    has_target_velocity = 64,
    has_homing_method = 128,
    has_all = 255
};
/// None: it is no set-point.
[[nodiscard]] std::uint8_t member_of(AxisPoint point) noexcept;
/// The members that `data` has replace those of `wanted`.
void overlay(Wanted& wanted, const ProcessData& data) noexcept;
/// Of 32 bytes.
[[nodiscard]] Wanted read_wanted(cip::View bytes) noexcept;
/// All of it, for a write that stands by itself.
[[nodiscard]] ProcessData all_of(const Wanted& wanted) noexcept;

class OutputLane {
public:
    /// `members`: of WantedMember.
    explicit OutputLane(std::uint8_t members = has_all) : members_(members) {}
    struct Step {
        std::optional<ProcessData> command;
        std::optional<SetPoint> set_point;  ///< axis, times and origin are the caller's
    };
    /// From here on as if nothing had been sent.
    void reset() { *this = OutputLane(members_); }
    [[nodiscard]] Step take(const Wanted& wanted, const AxisPicture& axis);
    /// A command of step() was handed on / has its result: then what waited may go. Not taken: its values are not known to the axis, and go
    /// with the next image that differs; the same image is not refused again and again.
    void begun() noexcept { ++on_their_way_; }
    [[nodiscard]] Step done(bool taken);

private:
    void compare(const Wanted& image, const AxisPicture& axis);
    [[nodiscard]] Step next();
    [[nodiscard]] bool has(WantedMember m) const noexcept { return (members_ & m) != 0; }
    std::uint8_t members_;
    Wanted base_, newest_;  // images as they came: the first, and the one before the newest
    Wanted wanted_;
    std::optional<Wanted> refused_;  // what was wanted when a command came back that was not taken
    ProcessData sent_;               // what was handed on last; what never was is not known to the axis, not 0
    std::uint16_t held_ = 0;         // bits that were set from the start
    bool halt_held_ = false;         // the axis stood halted at the start, and the first word would have released it
    bool speed_counts_ = false, stream_counts_ = false;
    std::uint32_t on_their_way_ = 0;
    std::uint32_t source_ = 0;  // who spoke for the axis when something was sent last; 0: nobody yet
    bool any_ = false;
};

}  // namespace axisgate::enip
