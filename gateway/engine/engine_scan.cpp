// Engine, scans. Addresses that the site does not name are given to the line's adapter as drives without axes, a few at a time;
// its own search for a drive is the question, its DriveLink the answer.
// In: wishes, links, the passing of time. Out: reports. Bounds: one scan per line, 16 addresses at once, 2 s per address, the wish's own
// limit. Never asks an address that the site has given to a drive, and ends when the site changes.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/engine_parts.hpp"

namespace axisgate {
namespace {
constexpr std::uint16_t first_probe = 0xFF00;
constexpr std::size_t most_at_once = 16;
constexpr Duration address_limit = std::chrono::seconds(2);
}  // namespace

bool Engine::is_probe(DriveId id) noexcept { return id != no_drive && index_of(id) >= first_probe; }

std::string Engine::start_scan(LineId id, ScanWish wish, Instant now) {
    LineUnit* unit = index_of(id) < lines_.size() ? lines_[index_of(id)].get() : nullptr;
    if (!unit) return "there is no such line";
    if (unit->scan && unit->scan->report.state == ScanReport::State::running)
        return fmt::format("line {} is being scanned already", unit->spec.name);
    const Family& family = *unit->family.family;
    if (!family.scan) return fmt::format("{} cannot be searched for: it has no question that every drive answers", family.name);
    wish.kind = unit->kind;
    for (const DriveId d : unit->drives)
        wish.known.push_back(drives_[index_of(d)]->spec.address);
    ScanPlan plan = family.scan(wish);
    if (!plan.fault.empty()) return plan.fault;
    Side* side = unit->real ? unit->real.get() : unit->twins.get();
    if (side && !side->up) return fmt::format("line {} is down: {}", unit->spec.name, side->why);
    auto scan = std::make_unique<Scan>();
    scan->ends_at = now + wish.limit;
    scan->at_once = std::clamp<std::size_t>(plan.at_once, 1, most_at_once);
    for (auto& a : plan.addresses) {
        if (std::ranges::find(wish.known, a) == wish.known.end()) scan->waiting.push_back(std::move(a));
    }
    std::ranges::reverse(scan->waiting);  // taken from the back
    for (const DriveId d : unit->drives) {
        const Drive& drive = *drives_[index_of(d)];
        if (side && !side->twin && !drive.device_online) continue;
        if (side && side->twin && !drive.twin_online) continue;
        scan->report.found.push_back(
            {drive.spec.address, std::string(family.name), side && !side->twin ? drive.device_link.text : drive.why, drive.spec.name});
    }
    scan->report.state = ScanReport::State::running;
    scan->report.of = scan->waiting.size();
    if (!side) scan->waiting.clear();  // a line of twins alone that has none
    if (!side) scan->report.asked = scan->report.of;
    unit->scan = std::move(scan);
    scan_turn(*unit, now);
    return {};
}

void Engine::cancel_scan(LineId id, Instant now) {
    LineUnit* unit = index_of(id) < lines_.size() ? lines_[index_of(id)].get() : nullptr;
    if (unit) end_scan(*unit, ScanReport::State::cancelled, "cancelled", now);
}

ScanReport Engine::scan_report(LineId id) const {
    const LineUnit* unit = index_of(id) < lines_.size() ? lines_[index_of(id)].get() : nullptr;
    return unit && unit->scan ? unit->scan->report : ScanReport{};
}

void Engine::end_scan(LineUnit& unit, ScanReport::State state, std::string why, Instant now) {
    if (!unit.scan || unit.scan->report.state != ScanReport::State::running) return;
    unit.scan->report.state = state;
    unit.scan->report.text = std::move(why);
    unit.scan->waiting.clear();
    Side* side = unit.real ? unit.real.get() : unit.twins.get();
    if (!side || unit.scan->asking.empty()) return;
    unit.scan->asking.clear();
    side->probes.clear();
    configure_side(*side, now);
}

/// From housekeeping: what was answered or waited for long enough makes room for the next addresses.
void Engine::scan_turn(LineUnit& unit, Instant now) {
    if (!unit.scan || unit.scan->report.state != ScanReport::State::running) return;
    Scan& scan = *unit.scan;
    last_stir_ = now;
    Side* side = unit.real ? unit.real.get() : unit.twins.get();
    if (side && !side->up)
        return end_scan(unit, ScanReport::State::failed, fmt::format("line {} is down: {}", unit.spec.name, side->why), now);
    bool changed = false;
    std::erase_if(scan.asking, [&](const Scan::Asking& a) {
        if (!a.over && now - a.since < address_limit) return false;
        ++scan.report.asked;
        changed = true;
        if (a.online) scan.report.found.push_back({a.address, std::string(unit.family.family->name), a.text, ""});
        return true;
    });
    if (now >= scan.ends_at && !(scan.asking.empty() && scan.waiting.empty()))
        return end_scan(unit, ScanReport::State::failed, "its limit_s was over before every address was asked", now);
    while (scan.asking.size() < scan.at_once && !scan.waiting.empty()) {
        scan.asking.push_back({DriveId{static_cast<std::uint16_t>(first_probe + scan.next_id++ % 0xF0)},
                               std::move(scan.waiting.back()),
                               now,
                               false,
                               false,
                               {}});
        scan.waiting.pop_back();
        changed = true;
    }
    if (changed && side) {
        side->probes.clear();
        for (const auto& a : scan.asking)
            side->probes.push_back({a.id, "scan " + a.address, a.address, {}, {}});
        configure_side(*side, now);
    }
    if (scan.asking.empty() && scan.waiting.empty()) scan.report.state = ScanReport::State::done;
}

void Engine::scan_link(Side& side, const DriveLink& l) {
    if (!side.unit.scan) return;
    for (auto& a : side.unit.scan->asking) {
        if (a.id != l.drive || a.over) continue;
        a.online = l.online;
        a.over = l.online || l.retry_pause > Duration::zero();  // given up for now: nobody is there
        a.text = l.text;
    }
}

}  // namespace axisgate
