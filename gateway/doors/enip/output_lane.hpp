// Turns the 32 bytes that an originator renews for one axis (registers 32..45) into commands at changes, and into set-points in modes 8 and
// 9. The first image is passed on as a whole, including zeros: a control word of 0 switches off an axis that others have switched on. The
// first image never moves anything: bits 4 and 7 of its control word count as held until they were low once, an axis that stands halted
// stays so, and its speed and positions are a base, so that only other values count. Values wait while a command is outstanding; a word
// does not. When a drive begins to answer, or another drive, channel or twin serves the axis, the next image is a first one, because the
// earlier ones were not meant for it.
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
/// The members that an output has; others are never sent, and a missing mode is that of the axis.
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
/// 0 if the point is not a set-point.
[[nodiscard]] std::uint8_t member_of(AxisPoint point) noexcept;
/// The members in `data` replace those of `wanted`.
void overlay(Wanted& wanted, const ProcessData& data) noexcept;
/// `bytes` has 32 bytes.
[[nodiscard]] Wanted read_wanted(cip::View bytes) noexcept;
/// All members, for a single write.
[[nodiscard]] ProcessData all_of(const Wanted& wanted) noexcept;

class OutputLane {
public:
    /// `members`: of WantedMember.
    explicit OutputLane(std::uint8_t members = has_all) : members_(members) {}
    struct Step {
        std::optional<ProcessData> command;
        std::optional<SetPoint> set_point;  ///< the caller sets axis, times and origin
    };
    /// Starts again as if nothing had been sent.
    void reset() { *this = OutputLane(members_); }
    [[nodiscard]] Step take(const Wanted& wanted, const AxisPicture& axis);
    /// A command of step() was passed on, or has its result: then waiting values may be sent. If it was refused, its values are unknown to
    /// the axis and are sent with the next different image; the same image is not refused again and again.
    void begun() noexcept { ++on_their_way_; }
    [[nodiscard]] Step done(bool taken);

private:
    void compare(const Wanted& image, const AxisPicture& axis);
    [[nodiscard]] Step next();
    [[nodiscard]] bool has(WantedMember m) const noexcept { return (members_ & m) != 0; }
    std::uint8_t members_;
    Wanted base_, newest_;  // received images: the first, and the one before the newest
    Wanted wanted_;
    std::optional<Wanted> refused_;  // the values of the last refused command
    ProcessData sent_;               // the values passed on last; values that were never passed on are unknown to the axis, not 0
    std::uint16_t held_ = 0;         // bits that were set from the start
    bool halt_held_ = false;         // the axis stood halted at the start, and the first word would have released it
    bool speed_counts_ = false, stream_counts_ = false;
    std::uint32_t on_their_way_ = 0;
    std::uint32_t source_ = 0;  // the serving side at the last command; 0: none yet
    bool any_ = false;
};

}  // namespace axisgate::enip
