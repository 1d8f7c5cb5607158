// AxisValues, owners of outputs: the data of implicit connections become commands and set-points of their client, which holds its axes
// while it runs.
#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/doors/enip/axis_values.hpp"
#include "gateway/doors/enip/words.hpp"

namespace axisgate::enip {

void AxisValues::opened(std::uint32_t output, const cip::Peer& who, Duration time_out, Instant) {
    Owner& owner = owners_[output];
    owner = {};
    owner.origin = origin_of(output, who);
    owner.good_for = std::clamp(time_out, SetPoint::good_for_min, SetPoint::good_for_max);
    owner.axes = owner.held = layout_.axes_of(output);
    if (const auto* w = layout_.window(output)) {
        owner.window = std::make_unique<WindowOutput>(port_, image_, writer_, counters_.commands, w->spec, owner.origin);
        for (const auto& [axis, members] : owner.window->members())
            owner.lanes.emplace(axis, OutputLane(members));
        // An owner that leaves power and halt to other clients must let them command.
        std::erase_if(owner.held, [&](AxisId axis) {
            const auto it = owner.window->members().find(axis);
            return it != owner.window->members().end() && (it->second & has_controlword) == 0;
        });
    } else {
        for (const AxisId axis : owner.axes)
            owner.lanes.emplace(axis, OutputLane{});
    }
    Event e;
    e.kind = "ethernet_ip";
    e.door = std::string(name_of(clients));
    e.who = *owner.origin.who;
    e.text = fmt::format("connection opened: {} ({})", layout_.name_of(output), output);
    port_.note(std::move(e), no_axis);
}

void AxisValues::consumed(std::uint32_t output, cip::View data, const cip::Peer&, Instant now) {
    const auto it = owners_.find(output);
    if (it == owners_.end()) return;
    if (!std::exchange(it->second.runs, true)) leases_.hold(it->second.origin, it->second.held, true, now);
    if (WindowOutput* const window = it->second.window.get()) {
        window->take(data, now);
        for (auto& [axis, lane] : it->second.lanes)
            carry_out(output, it->second, axis, lane.take(window->wanted(axis), port_.image().picture(axis)), now);
        return;
    }
    layout_.each_axis(output, [&](std::uint16_t i, AxisId id) {
        const auto lane = it->second.lanes.find(id);
        if (lane == it->second.lanes.end()) return;
        const Wanted wanted = read_wanted(data.subspan(std::size_t{i} * bytes_per_axis, bytes_per_axis));
        carry_out(output, it->second, id, lane->second.take(wanted, port_.image().picture(id)), now);
    });
}

void AxisValues::carry_out(std::uint32_t output, Owner& owner, AxisId axis, OutputLane::Step step, Instant now) {
    if (step.command) {
        Asked asked;
        asked.kind = Asked::Kind::output;
        asked.output = output;
        asked.origin = owner.origin;
        asked.data = *step.command;
        counters_.commands.add();
        if (submit(axis, *step.command, std::move(asked), now)) owner.lanes[axis].begun();
    }
    if (!step.set_point) return;
    SetPoint p = *step.set_point;
    p.axis = axis;
    p.good_for = owner.good_for;
    p.at = now;
    p.origin = owner.origin;
    (port_.set_point(p) ? counters_.set_points_refused : counters_.set_points).add();
}

void AxisValues::lose(std::uint32_t output, LossCause cause) {
    const auto it = owners_.find(output);
    if (it == owners_.end()) return;
    for (auto& [axis, lane] : it->second.lanes)
        lane.reset();
    if (it->second.window) it->second.window->reset();
    lost_.lost(AuthorityClient::of(it->second.origin), cause);
    if (std::exchange(it->second.runs, false)) leases_.let_go(it->second.origin, it->second.held);
}

void AxisValues::idle(std::uint32_t output, const cip::Peer&, Instant) { lose(output, loss_idle); }

void AxisValues::ended(std::uint32_t output, const cip::Peer& who, cip::End why, Instant) {
    lose(output, why == cip::End::timed_out ? loss_timed_out : loss_closed);
    owners_.erase(output);
    Event e;
    e.severity = why == cip::End::closed ? Severity::info : Severity::warning;
    e.kind = "ethernet_ip";
    e.door = std::string(name_of(clients));
    e.who = text_of(who.from);
    e.text =
        fmt::format("connection {}: {} ({})",
                    why == cip::End::closed        ? "closed"
                    : why == cip::End::timed_out   ? "lost: its originator was silent for its time-out"
                    : why == cip::End::by_operator ? "closed by a person over another door"
                                                   : "closed by the gateway: the site was changed, and with it the bytes of its assemblies",
                    layout_.name_of(output), output);
    port_.note(std::move(e), no_axis);
}

}  // namespace axisgate::enip
