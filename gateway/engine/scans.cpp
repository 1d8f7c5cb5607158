// Turns the request for a scan into addresses that are asked a few at a time, and evaluates the answers. The configuration of the site's
// own drives stays unchanged.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/engine/flight_record.hpp"
#include "gateway/engine/publisher.hpp"
#include "gateway/engine/scans.hpp"
#include "gateway/engine/speakers.hpp"

namespace axisgate::engine {
namespace {
constexpr std::uint16_t first_probe = 0xFF00;
constexpr std::size_t most_at_once = 16;
constexpr Duration address_limit = std::chrono::seconds(2);
}  // namespace

bool Scans::is_probe(DriveId id) noexcept { return id != no_drive && index_of(id) >= first_probe; }

std::string Scans::start(LineId id, ScanWish wish, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->scan(id, wish, now);
    LineUnit* unit = index_of(id) < machine_.lines.size() ? machine_.lines[index_of(id)].get() : nullptr;
    if (!unit) return "there is no such line";
    if (unit->scan && unit->scan->report.state == ScanReport::State::running)
        return fmt::format("line {} is being scanned already", unit->spec.name);
    std::vector<FamilyEntry> families = unit->families;
    if (!wish.family.empty()) {
        const FamilyEntry wanted = machine_.families.find(wish.family);
        if (auto wrong = not_to_be_searched(*unit, wanted, wish.family); !wrong.empty()) return wrong;
        families = {wanted};
    }
    if (families.empty()) return fmt::format("line {} names no family and has no drives: say which family to search for", unit->spec.name);
    Side* side = unit->real ? unit->real.get() : unit->twins.get();
    auto scan = std::make_unique<Scan>();
    scan->ends_at = now + wish.limit;
    wish.kind = unit->kind;
    for (const FamilyEntry& family : families) {
        auto& row = scan->report.parts.emplace_back();
        row.family = family.family->name;
        if (!family.family->scan) {
            row.text = fmt::format("{} cannot be searched for: it has no question that every drive answers", row.family);
            continue;
        }
        wish.family = row.family;
        wish.known.clear();
        for (const DriveId d : unit->drives) {
            const Drive& drive = *machine_.drives[index_of(d)];
            if (&serving_family(*drive.family.family) == &serving_family(*family.family)) wish.known.push_back(drive.spec.address);
        }
        ScanPlan plan = family.family->scan(wish);
        if (!plan.fault.empty()) {
            row.text = std::move(plan.fault);
            continue;
        }
        auto& part = scan->parts.emplace_back();
        part.family = family;
        part.report = scan->report.parts.size() - 1;
        part.at_once = std::clamp<std::size_t>(plan.at_once, 1, most_at_once);
        for (auto& a : plan.addresses) {
            if (std::ranges::find(wish.known, a) == wish.known.end()) part.waiting.push_back(std::move(a));
        }
        std::ranges::reverse(part.waiting);  // addresses are taken from the back
        row.of = part.waiting.size();
        if (!side) {  // a line that has only twins, and none of them is running
            part.waiting.clear();
            row.asked = row.of;
        }
        scan->report.of += row.of;
        scan->report.asked += row.asked;
    }
    if (scan->parts.empty()) return scan->report.parts.front().text;
    if (side && !side->up) return fmt::format("line {} is down: {}", unit->spec.name, side->why);
    for (const DriveId d : unit->drives) {
        const Drive& drive = *machine_.drives[index_of(d)];
        if (std::ranges::find(scan->parts, drive.family.family, [](const Scan::Part& p) { return p.family.family; }) == scan->parts.end())
            continue;
        if (side && !side->twin && !drive.device_online) continue;
        if (side && side->twin && !drive.twin_online) continue;
        scan->report.found.push_back({drive.spec.address, std::string(drive.family.family->name),
                                      side && !side->twin ? drive.device_link.text : drive.why, drive.spec.name});
    }
    scan->report.state = ScanReport::State::running;
    unit->scan = std::move(scan);
    turn(*unit, now);
    return {};
}

/// The reason why a family cannot be searched for on this line; empty if it can.
std::string Scans::not_to_be_searched(const LineUnit& unit, const FamilyEntry& wanted, std::string_view name) const {
    if (!wanted.family) return fmt::format("there is no family {}; use one of: {}", name, machine_.families.names());
    const auto on_line = [&](const FamilyEntry& f) { return f.family == wanted.family; };
    if (std::ranges::any_of(unit.families, on_line)) return {};
    if (unit.kind == LineKind::bytes) return fmt::format("line {} carries bytes, and those of {} alone", unit.spec.name, unit.spec.family);
    if (!wanted.family->uses_can) return fmt::format("{} does not speak on CAN", name);
    const auto alone = [](const FamilyEntry& f) { return !f.family->can_identifiers; };
    if (!unit.families.empty() && (alone(wanted) || std::ranges::any_of(unit.families, alone)))
        return fmt::format("{} cannot be searched for on line {}: they cannot share a CAN line", name, unit.spec.name);
    return {};
}

void Scans::cancel(LineId id, Instant now) {
    if (FlightTap* tap = publisher_.tap()) tap->scan_cancel(id, now);
    LineUnit* unit = index_of(id) < machine_.lines.size() ? machine_.lines[index_of(id)].get() : nullptr;
    if (unit) end(*unit, ScanReport::State::cancelled, "cancelled", now);
}

ScanReport Scans::report(LineId id) const {
    const LineUnit* unit = index_of(id) < machine_.lines.size() ? machine_.lines[index_of(id)].get() : nullptr;
    return unit && unit->scan ? unit->scan->report : ScanReport{};
}

void Scans::end(LineUnit& unit, ScanReport::State state, std::string why, Instant now) {
    if (!unit.scan || unit.scan->report.state != ScanReport::State::running) return;
    unit.scan->report.state = state;
    unit.scan->report.text = std::move(why);
    unit.scan->parts.clear();
    Side* side = unit.real ? unit.real.get() : unit.twins.get();
    if (!side) return;
    for (const auto& s : side->speakers) {
        s->probes.clear();
        s->scanned = s->scanned_now(s->adapter->counters());
        s->before_scan.reset();
        if (!serves_any(*s, unit.families)) unit.scanned_gone += s->scanned;
    }
    speakers_.fit(*side, now);
}

/// Called by housekeeping: addresses that have answered or have been asked long enough make room for the next ones.
void Scans::turn(LineUnit& unit, Instant now) {
    if (!unit.scan || unit.scan->report.state != ScanReport::State::running) return;
    Scan& scan = *unit.scan;
    machine_.last_stir = now;
    Side* side = unit.real ? unit.real.get() : unit.twins.get();
    if (side && !side->up) return end(unit, ScanReport::State::failed, fmt::format("line {} is down: {}", unit.spec.name, side->why), now);
    std::vector<Scan::Part*> changed;
    for (auto& part : scan.parts) {
        const auto over = std::erase_if(part.asking, [&](const Scan::Asking& a) {
            if (!a.over && now - a.since < address_limit) return false;
            if (a.online) scan.report.found.push_back({a.address, std::string(part.family.family->name), a.text, ""});
            return true;
        });
        scan.report.asked += over;
        scan.report.parts[part.report].asked += over;
        if (over > 0) changed.push_back(&part);
    }
    if (now >= scan.ends_at && !scan.over())
        return end(unit, ScanReport::State::failed, "its limit_s was over before every address was asked", now);
    for (auto& part : scan.parts) {
        // Families with the same adapter have the same addresses, so one is searched for after the other.
        const auto before = std::ranges::find_if(scan.parts, [&](const Scan::Part& p) {
            return &serving_family(*p.family.family) == &serving_family(*part.family.family) && !p.over();
        });
        if (before != scan.parts.end() && &*before != &part) continue;
        if (part.asking.size() < part.at_once && !part.waiting.empty() && std::ranges::find(changed, &part) == changed.end())
            changed.push_back(&part);
        while (part.asking.size() < part.at_once && !part.waiting.empty()) {
            part.asking.push_back({DriveId{static_cast<std::uint16_t>(first_probe + scan.next_id++ % 0xF0)},
                                   std::move(part.waiting.back()),
                                   now,
                                   false,
                                   false,
                                   {}});
            part.waiting.pop_back();
        }
    }
    for (const Scan::Part* part : changed) {
        if (!side) break;
        Speaker& speaker = speakers_.bring_in(*side, part->family, now);
        speaker.probes.clear();
        if (!speaker.before_scan) speaker.before_scan = speaker.adapter->counters();
        for (const auto& a : part->asking)
            speaker.probes.push_back(
                {a.id, "scan " + a.address, a.address, {}, {}, {std::shared_ptr<const Catalogue>(), part->family.catalogue}});
        speakers_.configure(speaker, now);
    }
    if (scan.over()) end(unit, ScanReport::State::done, "", now);
}

void Scans::answered(Side& side, const DriveLink& l) {
    if (!side.unit.scan) return;
    for (auto& part : side.unit.scan->parts) {
        for (auto& a : part.asking) {
            if (a.id != l.drive || a.over) continue;
            a.online = l.online;
            a.over = l.online || l.retry_pause > Duration::zero();  // the adapter has given the address up for now: no drive is there
            a.text = l.text;
        }
    }
}

}  // namespace axisgate::engine
