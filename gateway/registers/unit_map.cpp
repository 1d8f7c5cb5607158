// The default for clients that renew images: value by value, with the set-points of an axis together. A refused value never prevents
// another one.
#include "gateway/registers/unit_map.hpp"

#include <algorithm>
#include <cstring>

namespace axisgate::registers {
namespace {
/// Set-points of one axis in one image act together, the control word last, like those of one request.
void add(WritePlan& plan, PlannedCommand&& command) {
    const auto* const d = std::get_if<ProcessData>(&command.body);
    const auto same = !d ? plan.commands.end() : std::ranges::find_if(plan.commands, [&](const PlannedCommand& c) {
        return c.axis == command.axis && std::holds_alternative<ProcessData>(c.body);
    });
    if (same == plan.commands.end()) return plan.commands.push_back(std::move(command));
    auto& into = std::get<ProcessData>(same->body);
    const auto put = [](auto& to, const auto& from) {
        if (from) to = from;
    };
    put(into.controlword, d->controlword);
    put(into.mode, d->mode);
    put(into.target_position, d->target_position);
    put(into.profile_velocity, d->profile_velocity);
    put(into.profile_acceleration, d->profile_acceleration);
    put(into.profile_deceleration, d->profile_deceleration);
    put(into.target_velocity, d->target_velocity);
    put(into.homing_method, d->homing_method);
}
}  // namespace

void UnitMap::show(Table table, std::uint16_t address, std::uint16_t count, Instant now, std::uint8_t* out) {
    if (read_registers(table, address, count, now, out) != Verdict::good) std::memset(out, 0, 2 * std::size_t{count});
    refused_ = {};
}

void UnitMap::renew(Table table, std::uint16_t address, std::span<const MapValue> changed, const std::uint8_t* data, WritePlan& plan,
                    std::vector<Refused>& refused) {
    for (const MapValue& v : changed) {
        WritePlan one;
        if (write(table, v.address, v.registers, data + 2 * std::size_t(v.address - address), one) != Verdict::good) {
            refused.push_back(take_refused());
            continue;
        }
        for (auto& command : one.commands)
            add(plan, std::move(command));
    }
}

}  // namespace axisgate::registers
