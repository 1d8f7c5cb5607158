// Compares the last word that was sent with the newest one; images in between are not kept. A value is never sent without a mode or word
// that uses it.
#include "gateway/doors/enip/output_lane.hpp"

#include "gateway/axis/cia402.hpp"

namespace axisgate::enip {
namespace {
constexpr std::uint16_t edges = cia402::cw_new_setpoint | cia402::cw_fault_reset;
constexpr std::int16_t velocity_mode = 3, streamed_position = 8, streamed_velocity = 9;
constexpr std::uint16_t enabled = cia402::cw_switch_on | cia402::cw_enable_voltage | cia402::cw_quick_stop | cia402::cw_enable_operation;

bool streams(const Wanted& w) noexcept { return w.mode == streamed_position || w.mode == streamed_velocity; }
bool is_enabled(const AxisPicture& axis) noexcept { return (axis.statusword & 0x6F) == 0x27; }  // operation enabled
}  // namespace

Wanted read_wanted(cip::View bytes) noexcept {
    cip::Reader r(bytes);
    Wanted w;
    w.controlword = r.u16();
    w.mode = static_cast<std::int16_t>(r.u16());
    w.target_position = static_cast<std::int32_t>(r.u32());
    w.profile_velocity = r.u32();
    w.profile_acceleration = r.u32();
    w.profile_deceleration = r.u32();
    w.target_velocity = static_cast<std::int32_t>(r.u32());
    w.homing_method = static_cast<std::int16_t>(r.u16());
    return w;
}

ProcessData all_of(const Wanted& w) noexcept {
    ProcessData d;
    d.controlword = w.controlword;
    d.mode = w.mode;
    d.target_position = w.target_position;
    d.profile_velocity = w.profile_velocity;
    d.profile_acceleration = w.profile_acceleration;
    d.profile_deceleration = w.profile_deceleration;
    d.target_velocity = w.target_velocity;
    d.homing_method = w.homing_method;
    return d;
}

std::uint8_t member_of(AxisPoint point) noexcept {
    switch (point) {
        case AxisPoint::controlword:
            return has_controlword;
        case AxisPoint::mode:
            return has_mode;
        case AxisPoint::target_position:
            return has_target_position;
        case AxisPoint::profile_velocity:
            return has_profile_velocity;
        case AxisPoint::profile_acceleration:
            return has_profile_acceleration;
        case AxisPoint::profile_deceleration:
            return has_profile_deceleration;
        case AxisPoint::target_velocity:
            return has_target_velocity;
        case AxisPoint::homing_method:
            return has_homing_method;
        default:
            return 0;
    }
}

void overlay(Wanted& w, const ProcessData& d) noexcept {
    w.controlword = d.controlword.value_or(w.controlword);
    w.mode = d.mode.value_or(w.mode);
    w.target_position = d.target_position.value_or(w.target_position);
    w.profile_velocity = d.profile_velocity.value_or(w.profile_velocity);
    w.profile_acceleration = d.profile_acceleration.value_or(w.profile_acceleration);
    w.profile_deceleration = d.profile_deceleration.value_or(w.profile_deceleration);
    w.target_velocity = d.target_velocity.value_or(w.target_velocity);
    w.homing_method = d.homing_method.value_or(w.homing_method);
}

/// A value of the first image counts when it changes, or when the originator itself enables the axis or ends its halt.
void OutputLane::compare(const Wanted& image, const AxisPicture& axis) {
    constexpr std::uint16_t halt = cia402::cw_halt;
    if (!any_) {
        base_ = newest_ = image;
        held_ = image.controlword & edges;
        halt_held_ = is_enabled(axis) && (axis.controlword & halt) && !(image.controlword & halt);
        any_ = true;
    }
    held_ &= image.controlword;
    const bool another_mode = has(has_mode) && image.mode != base_.mode;
    const bool enables = (image.controlword & ~newest_.controlword & cia402::cw_enable_operation) != 0;
    const bool releases = (newest_.controlword & ~image.controlword & halt) != 0;
    speed_counts_ = speed_counts_ || another_mode || image.target_velocity != base_.target_velocity || enables || releases;
    const bool another_place =
        image.mode == streamed_position ? image.target_position != base_.target_position : image.target_velocity != base_.target_velocity;
    stream_counts_ = stream_counts_ || another_mode || (streams(image) && another_place);
    const bool begins = (image.controlword & ~held_ & cia402::cw_new_setpoint) || (image.mode == velocity_mode && speed_counts_) ||
                        (streams(image) && stream_counts_);
    halt_held_ = halt_held_ && !(image.controlword & halt) && !begins;
    newest_ = image;
}

OutputLane::Step OutputLane::take(const Wanted& given, const AxisPicture& axis) {
    if (axis.current && axis.source != source_) {
        if (any_) reset();
        source_ = axis.source;
    }
    Wanted wanted = given;
    if (!has(has_mode)) wanted.mode = axis.mode;
    compare(wanted, axis);
    wanted_ = wanted;
    wanted_.controlword = static_cast<std::uint16_t>((wanted.controlword & ~held_) | (halt_held_ ? cia402::cw_halt : 0));
    Step step = next();
    const bool position = wanted_.mode == streamed_position;
    const std::uint16_t word = has(has_controlword) ? wanted_.controlword : axis.controlword;
    const bool follows = streams(wanted_) && stream_counts_ && has(position ? has_target_position : has_target_velocity) &&
                         (word & enabled) == enabled && !(word & cia402::cw_halt);
    if (follows && is_enabled(axis)) {
        SetPoint p;
        p.mode = position ? SetPoint::Mode::position : SetPoint::Mode::velocity;
        p.value = position ? wanted_.target_position : wanted_.target_velocity;
        if (position && wanted_.profile_velocity != 0) p.velocity = wanted_.profile_velocity;
        if (wanted_.profile_acceleration != 0) p.acceleration = wanted_.profile_acceleration;
        if (wanted_.profile_deceleration != 0) p.deceleration = wanted_.profile_deceleration;
        step.set_point = p;
    }
    return step;
}

OutputLane::Step OutputLane::done(bool taken) {
    if (on_their_way_ > 0) --on_their_way_;
    if (!any_) return {};
    if (!taken) {
        const auto word = sent_.controlword;
        sent_ = {};
        sent_.controlword = word;
        refused_ = wanted_;
    }
    return next();
}

OutputLane::Step OutputLane::next() {
    const bool streamed = streams(wanted_);
    const bool word = has(has_controlword) && sent_.controlword != wanted_.controlword;
    const bool mode = has(has_mode) && !streamed && sent_.mode != wanted_.mode;
    if (!word && refused_ == wanted_) return {};
    refused_.reset();
    ProcessData d;
    bool any = false;
    const auto put = [&](WantedMember member, auto& into, const auto& value, auto& before) {
        if (!has(member) || before == value) return;
        into = before = value;
        any = true;
    };
    put(has_controlword, d.controlword, wanted_.controlword, sent_.controlword);
    // A profile takes its values at an edge; a speed and its ramps are followed as they change, one command at a time.
    const bool edge = !streamed && (word || mode), follows = !streamed && wanted_.mode == velocity_mode && on_their_way_ == 0;
    if (edge) {
        put(has_mode, d.mode, wanted_.mode, sent_.mode);
        put(has_target_position, d.target_position, wanted_.target_position, sent_.target_position);
        put(has_homing_method, d.homing_method, wanted_.homing_method, sent_.homing_method);
    }
    if (edge || follows) {
        put(has_profile_velocity, d.profile_velocity, wanted_.profile_velocity, sent_.profile_velocity);
        put(has_profile_acceleration, d.profile_acceleration, wanted_.profile_acceleration, sent_.profile_acceleration);
        put(has_profile_deceleration, d.profile_deceleration, wanted_.profile_deceleration, sent_.profile_deceleration);
        if (speed_counts_) put(has_target_velocity, d.target_velocity, wanted_.target_velocity, sent_.target_velocity);
    }
    return any ? Step{d, std::nullopt} : Step{};
}

}  // namespace axisgate::enip
