// The RPDOs of the connection set belong to the first axis, so only that axis follows streams.
#include "adapters/cia402/demand.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "adapters/cia402/drive_axis.hpp"

namespace axisgate::cia402_drive {
namespace {
constexpr Duration longest_cycle = std::chrono::milliseconds(255);  ///< 60C2h in whole milliseconds
}

void SetPointStream::follow(const SetPoint& p) {
    if (!drive_.listens() || drive_.node.stopped || drive_.place() > 0) return;  // without a cyclic mode there are no set-points
    if (newest_ && newest_->mode != p.mode) end();
    newest_ = p;
}
void SetPointStream::end() noexcept {
    state_ = State::none;
    newest_.reset();
    led_.stand();
    give_back();
}
void SetPointStream::give_back() noexcept {
    if (!place_) return;
    Line& line = drive_.node.line;
    line.targets.give_back(*place_);
    --line.led;
    place_.reset();
}
Duration SetPointStream::cycle() const noexcept { return place_ ? drive_.node.line.plan.beat * place_->turns : Duration{}; }

std::optional<Job> SetPointStream::begin(Turn& t) {
    Line& line = drive_.node.line;
    if (!drive_.known.pdos.targets[static_cast<std::size_t>(newest_->mode)]) {
        t.out.stream_ends.push_back(
            {drive_.id(), Reason::not_supported, "the drive accepts no PDO with such a target: it follows no streamed set-points"});
        end();
        return std::nullopt;
    }
    const int nodes = static_cast<int>(line.plan.slots.size());
    int longest = canopen::longest_turns(nodes, line.plan.places);
    while (longest > 1 && longest * line.plan.beat > longest_cycle)
        longest /= 2;
    if (!place_) {
        place_ = line.targets.take(line.plan.places, nodes - line.led - 1, longest);
        if (!place_) {
            t.out.stream_ends.push_back(
                {drive_.id(), Reason::busy, fmt::format("the beats of this line have no room for one more: {} axes are led", line.led)});
            end();
            return std::nullopt;
        }
        ++line.led;
    }
    Job job;
    job.command.axis = drive_.id();
    plan_stream(drive_.node, drive_.known, newest_->mode, cycle(), job);
    state_ = State::starting;
    return job;
}
bool SetPointStream::has_another_time() const noexcept {
    const auto& has = drive_.known.interpolation;
    return has.value != 0 && !(has == interpolation_of(cycle()));
}
void SetPointStream::begun(std::int64_t here) {
    state_ = newest_ ? static_cast<State>(static_cast<int>(State::position) + static_cast<int>(newest_->mode)) : State::none;
    led_.begin(static_cast<double>(here));
}

void SetPointStream::mode_shown(int mode, Turn& t) {
    const bool followed = state_ < State::position || !newest_ || mode == drive_.known.stream_mode(newest_->mode);
    astray_ = followed ? 0 : astray_ + 1;
    if (astray_ < sure) return;
    t.out.stream_ends.push_back(
        {drive_.id(), Reason::drive_refused, fmt::format("the drive shows mode {} (6061h) by itself, and follows no longer", mode)});
    end();
}

void SetPointStream::before_sync(Turn& t) {
    const AxisKnown& known = drive_.known;
    if (!drive_.listens() || state_ < State::position || !newest_ || known.fb.power != AxisFeedback::Power::on) return;
    if (!place_ || !place_->due(drive_.node.line.beat + 1)) return;
    const double cycle_s = seconds(cycle());
    const SetPoint& p = *newest_;
    const auto rate = [&](const std::optional<std::int64_t>& v, std::size_t own) {
        return static_cast<double>(v.value_or(known.rates[own]));
    };
    const drive::LeadRamps ramps{rate(p.velocity, 0), rate(p.acceleration, 1), rate(p.deceleration, 2)};
    if (state_ == State::torque) return send(std::clamp<std::int64_t>(p.value, INT16_MIN, INT16_MAX), t);
    if (state_ == State::velocity) return send(std::llround(led_.speed_towards(static_cast<double>(p.value), ramps, cycle_s)), t);
    const double place = std::clamp(led_.towards(static_cast<double>(p.value), ramps, cycle_s), double{INT32_MIN}, double{INT32_MAX});
    send(std::llround(place), t);
}

void SetPointStream::send(std::int64_t target, Turn& t) {
    const AxisKnown& known = drive_.known;
    const auto& pdo = known.pdos.targets[static_cast<std::size_t>(newest_->mode)];
    if (!pdo) return;
    const Address object = target_object(newest_->mode, known.stream_mode(newest_->mode));
    t.out.send(canopen::data_frame(pdo->settings.id, target_bytes(pdo->mapping, {known.cw, known.ordered_mode, object, target})));
}

}  // namespace axisgate::cia402_drive
