// Plans turn a command into a short list of SDO transfers, by the known state of the axis, or state why the command is refused. A control
// word that starts a motion is the last transfer of its list.
#pragma once

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>

#include "adapters/cia402/drive_pdos.hpp"
#include "adapters/cia402/drive_steps.hpp"
#include "gateway/core/sample.hpp"

namespace axisgate::cia402_drive {
struct Node;

enum class Order : std::uint8_t { none, position, velocity, homing };

/// The known state of an axis.
struct AxisKnown {
    AxisFeedback fb;
    std::uint16_t cw = 0;         ///< as it was written to the drive
    int mode = 0;                 ///< 6061h, as last shown
    int ordered_mode = 0;         ///< 6060h, as it was written to the drive
    Instant low_since{};          ///< since when bit 4 of the control word is 0
    Instant left_at{};            ///< when the drive has acknowledged the last control word that does not enable operation
    bool acknowledged = false;    ///< status bit 12 has acknowledged the last set-point
    bool no_acknowledge = false;  ///< the drive has started a motion without acknowledgement
    std::uint32_t modes = 0;
    bool profile = true;  ///< it has a status word
    /// The measured values that the drive has (606Ch, 6062h, 6061h); feedback.hpp says how the others are replaced.
    bool has_velocity = true, has_demand = true, has_mode = true;
    bool polled = false;  ///< its values are read by SDO
    AxisPdos pdos;
    std::int64_t homing_method = 0;
    std::array<std::int64_t, 3> rates{10'000, 50'000, 50'000};  ///< 6081h, 6083h, 6084h
    Order order = Order::none;
    std::optional<std::int64_t> target{};  ///< of the positioning that was ordered last
    bool at_target = false;                ///< the drive shows that it has reached this target, and its position is near it
    /// 60C2h: value times ten to the power of the index, in seconds; as it was written to the drive.
    struct Interpolation {
        std::int64_t value = 0, index = -3;
        bool operator==(const Interpolation&) const = default;
    } interpolation;

    [[nodiscard]] bool offers(int m) const noexcept { return m >= 1 && m <= 32 && (modes >> (m - 1) & 1u); }
    /// The mode that follows set-points of this kind: 8, 9, 10, or the older 7 and 4 if the drive does not have those.
    [[nodiscard]] int stream_mode(SetPoint::Mode kind) const noexcept {
        const int cyclic = 8 + static_cast<int>(kind);
        const int older = kind == SetPoint::Mode::position ? 7 : kind == SetPoint::Mode::torque ? 4 : 0;
        return !offers(cyclic) && offers(older) ? older : cyclic;
    }
    /// True if the velocity is above what a drive shows at standstill: one thousandth of the profile velocity.
    [[nodiscard]] bool turns() const noexcept { return std::llabs(fb.velocity) > std::max<std::int64_t>(rates[0] / 1000, 0); }
    /// By the status word and the velocity that were read or shown last.
    [[nodiscard]] bool moves_under_power() const noexcept {
        const unsigned sw = fb.native_status, six = sw & 0x6Fu;
        return profile && turns() && (six == 0x27 || six == 0x07 || (sw & 0x4Fu) == 0x0F);
    }
    [[nodiscard]] unsigned state() const noexcept { return fb.statusword.value_or(0) & 0x6Fu; }
    /// The longest time by which a drive shows an older status word.
    static constexpr Duration oldest_report = std::chrono::seconds(1);
    [[nodiscard]] bool shows_on() const noexcept { return state() == 0x27; }
    /// It shows "operation enabled", and this is not older than a control word that has ended it.
    [[nodiscard]] bool on(Instant now) const noexcept {
        const bool outdated = (cw & 0x0Fu) != 0x0F && left_at != Instant{} && now < left_at + oldest_report;
        return shows_on() && !outdated;
    }
};

/// Returns an empty text, or why the command is refused. `axis` is its place on the node.
[[nodiscard]] std::string plan(const Node& node, const AxisKnown& known, std::size_t axis, Job& job, Instant now, Reason& reason);
/// An Enable was planned by a status word that was out of date: the drive has left its quick stop by itself (605Ah below 5), or has begun
/// one. True: the steps begin again, by the state that was just read; once for each job.
[[nodiscard]] bool plan_anew(const Node& node, const AxisKnown& known, std::size_t axis, Job& job, const Step& step, unsigned statusword,
                             Instant now);
/// The parts of the profile that the drive does not have, and their replacement; empty: none.
[[nodiscard]] std::string lacks(const AxisKnown& known);
/// A stop is planned when it is sent, by the state of the axis at that time.
void plan_stop(const AxisKnown& known, Job& job);
/// `cycle` is the time between two targets. Up to 255 ms it is given in ms, above in units of 10 ms.
[[nodiscard]] AxisKnown::Interpolation interpolation_of(Duration cycle) noexcept;
/// The first target is the actual position; the mode is changed after that.
void plan_stream(const Node& node, const AxisKnown& known, SetPoint::Mode mode, Duration cycle, Job& job);
/// The ordered mode is not reached: orders the mode that the drive shows again.
void plan_mode_back(const AxisKnown& known, Job& job);
// native.cpp
[[nodiscard]] std::string plan_native(const Node& node, Job& job, const Native& native, Reason& reason);
[[nodiscard]] std::string plan_action(const Node& node, const AxisKnown& known, Job& job, const Action& action, Instant now,
                                      Reason& reason);
[[nodiscard]] std::string plan_parameter(const Node& node, std::size_t axis, Job& job, Reason& reason);

}  // namespace axisgate::cia402_drive
