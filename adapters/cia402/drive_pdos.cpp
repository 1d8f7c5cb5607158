#include "adapters/cia402/drive_pdos.hpp"

#include <algorithm>
#include <iterator>

namespace axisgate::cia402_drive {
namespace {
using canopen::Pdo;
using canopen::PdoDirection;

constexpr Address wanted_of_report[] = {object::statusword, object::position, object::mode_shown, object::velocity, object::demand};
constexpr Address zero_in_target[] = {object::target_position,
                                      object::interpolated_position,
                                      object::target_velocity,
                                      object::target_torque,
                                      {0x60B0, 0},
                                      {0x60B1, 0},
                                      {0x60B2, 0}};

bool carries(const Pdo& pdo, Address a) {
    return std::ranges::any_of(pdo.mapping, [&](const auto& m) { return m.address == a; });
}
bool is_gap(Address a) { return a.index <= 0x1F; }

/// In use, by its own identifier or by that of the connection set. Empty: it has none.
std::optional<Pdo> enabled(Pdo pdo, std::uint8_t node, int transmission) {
    constexpr std::uint16_t of_connection_set = 4;
    if (pdo.settings.extended) return std::nullopt;
    if (pdo.settings.id == 0) {
        if (pdo.number > of_connection_set) return std::nullopt;
        pdo.settings.id = (pdo.direction == PdoDirection::transmit ? 0x80u : 0x100u) + 0x100u * pdo.number + node;
    }
    pdo.settings.valid = true;
    pdo.settings.transmission = static_cast<std::uint8_t>(transmission);
    return pdo;
}
}  // namespace

std::string_view name_of(PdoPlan plan) noexcept {
    static constexpr std::string_view names[] = {"free", "file", "few", "sdo"};
    return names[static_cast<std::size_t>(plan)];
}

bool AxisPdos::carries(Address object) const noexcept {
    return std::ranges::any_of(reports, [&](const Pdo& p) {
        return std::ranges::any_of(p.mapping, [&](const auto& m) { return of_first_axis(m.address) == object; });
    });
}

std::vector<Pdo> own_reports(std::span<const Pdo> found, std::uint8_t node, std::size_t axis, int turns) {
    std::vector<Address> missing;
    for (const Address a : wanted_of_report)
        missing.push_back(of_axis(a, axis));
    std::vector<Pdo> out;
    while (out.size() < AxisPdos::most_reports && !missing.empty()) {
        std::optional<Pdo> best;
        std::ptrdiff_t most = 0;
        for (const Pdo& p : found) {
            if (p.direction != PdoDirection::transmit) continue;
            const auto carried = std::ranges::count_if(missing, [&](Address a) { return carries(p, a); });
            if (carried <= most) continue;
            if (auto usable = enabled(p, node, turns)) {
                best = std::move(usable);
                most = carried;
            }
        }
        if (!best) break;
        std::erase_if(missing, [&](Address a) { return carries(*best, a); });
        out.push_back(std::move(*best));
    }
    const auto is_missing = [&](Address a) { return std::ranges::find(missing, of_axis(a, axis)) != missing.end(); };
    if (is_missing(object::statusword) || is_missing(object::position)) out.clear();
    return out;
}

Address target_object(SetPoint::Mode kind, int mode) noexcept {
    if (kind == SetPoint::Mode::velocity) return object::target_velocity;
    if (kind == SetPoint::Mode::torque) return object::target_torque;
    return mode == 7 ? object::interpolated_position : object::target_position;
}

std::optional<Pdo> own_target(std::span<const Pdo> found, std::uint8_t node, Address target) {
    std::optional<Pdo> best;
    for (const Pdo& p : found) {
        const auto is_known = [](const auto& m) {
            return is_gap(m.address) || m.address == object::controlword || m.address == object::mode ||
                   std::ranges::find(zero_in_target, m.address) != std::end(zero_in_target);
        };
        if (p.direction != PdoDirection::receive || !carries(p, target) || !std::ranges::all_of(p.mapping, is_known)) continue;
        if (best && canopen::bits_of(best->mapping) <= canopen::bits_of(p.mapping)) continue;
        if (auto usable = enabled(p, node, 1)) best = std::move(usable);
    }
    return best;
}

std::vector<std::uint8_t> target_bytes(const canopen::PdoMapping& mapping, const TargetValues& v) {
    std::vector<std::uint64_t> values;
    for (const auto& m : mapping) {
        const std::int64_t value = m.address == v.target              ? v.value
                                   : m.address == object::controlword ? v.controlword
                                   : m.address == object::mode        ? v.mode
                                                                      : 0;
        values.push_back(static_cast<std::uint64_t>(value));
    }
    return canopen::pack(mapping, values).value_or(std::vector<std::uint8_t>{});
}

}  // namespace axisgate::cia402_drive
