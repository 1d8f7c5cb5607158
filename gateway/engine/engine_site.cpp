// Engine, the site in force: what is kept, made anew and taken away when another one is applied.
// In: the wanted site. Out: lines, drives and axes; adapters configured, twins made and removed.
// Never disturbs what did not change.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/line_uri.hpp"
#include "gateway/engine/engine.hpp"
#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"
#include "gateway/site/options.hpp"
#include "gateway/site/site_stage.hpp"

namespace axisgate {
namespace {
Duration stale_limit(const LineSpec& spec, LineKind kind) {
    if (spec.timing.stale_after > Duration::zero()) return spec.timing.stale_after;
    return kind == LineKind::can ? std::chrono::seconds(1) : std::chrono::seconds(3);
}
/// Of embedded drives on a line that names neither a rate nor a family: CiA 301's highest.
constexpr std::uint32_t can_bit_rate_of_no_family = 1'000'000;
}  // namespace

// --- the site -------------------------------------------------------------------------------------------------------

/// Of the line alone.
LineSetup Engine::setup_for(const LineUnit& unit) const {
    LineSetup s;
    s.id = unit.id;
    s.name = unit.spec.name;
    s.kind = unit.kind;
    s.timing = unit.spec.timing;
    s.options = unit.spec.options;
    s.bit_rate = unit.spec.bitrate;
    const Family* family = unit.family.family;
    const auto uri =
        family ? parse_line_uri(unit.spec.uri, family->default_bit_rate, family->default_format) : parse_line_uri(unit.spec.uri);
    if (!uri.good()) return s;
    if (uri.uri.kind == LineUri::Kind::serial || (uri.uri.kind == LineUri::Kind::pty && uri.uri.serial.baud != 0)) {
        s.bit_rate = uri.uri.serial.baud;
        s.bits_per_byte = static_cast<std::uint8_t>(uri.uri.serial.format.bits_per_byte());
    } else if (uri.uri.kind == LineUri::Kind::twin) {
        if (const auto format = parse_serial_format(family ? family->default_format : "8N1")) s.bits_per_byte = format->bits_per_byte();
        if (s.bit_rate == 0)
            s.bit_rate = !family                      ? can_bit_rate_of_no_family
                         : unit.kind == LineKind::can ? family->default_can_bit_rate
                                                      : family->default_bit_rate;
    }
    return s;
}

/// The line with the drives of one family that this side serves.
LineSetup Engine::setup_for(const Speaker& speaker) const {
    const Side& side = speaker.side;
    LineSetup s = setup_for(side.unit);
    for (const DriveId id : side.unit.drives) {
        const Drive& d = *drives_[index_of(id)];
        const bool here = side.twin ? d.serving == Presence::twin : d.spec.presence != PresenceRule::twin;
        if (!here || d.family.family != speaker.family.family) continue;
        DriveSetup ds;
        ds.id = id;
        ds.name = d.spec.name;
        ds.address = d.spec.address;
        ds.options = d.spec.options;
        ds.catalogue = d.catalogue;
        for (const AxisId a : d.axes)
            ds.axes.push_back({a, axes_[index_of(a)]->spec.channel, axes_[index_of(a)]->look_period});
        s.drives.push_back(std::move(ds));
    }
    s.drives.insert(s.drives.end(), speaker.probes.begin(), speaker.probes.end());
    return s;
}

/// Tells an adapter its drives; the frames that it is given follow from their addresses.
void Engine::configure(Speaker& speaker, Instant now) {
    const LineSetup setup = setup_for(speaker);
    const auto identifiers = speaker.side.unit.kind == LineKind::can ? speaker.family.family->can_identifiers : nullptr;
    speaker.hears_all = identifiers == nullptr;
    if (identifiers) {
        std::vector<std::string> addresses;
        for (const auto& d : setup.drives)
            addresses.push_back(d.address);
        speaker.identifiers = identifiers(addresses);
    }
    ask(speaker, now, [&](Out& out) { speaker.adapter->configure(setup, now, out); });
}

void Engine::configure_side(Side& side, Instant now) {
    for (const auto& s : side.speakers)
        configure(*s, now);
}

/// The adapter of a family on this side, made where there is none.
Engine::Speaker& Engine::bring_in(Side& side, const FamilyEntry& family, Instant now) {
    if (Speaker* known = side.speaker_of(family)) return *known;
    std::uint8_t number = 0;
    while (std::ranges::any_of(side.speakers, [&](const auto& s) { return s->number == number; }))
        ++number;
    Speaker& fresh = *side.speakers.emplace_back(std::make_unique<Speaker>(side, family, number));
    fresh.adapter = family.family->make_adapter(*family.catalogue, side.unit.kind);
    configure(fresh, now);
    if (side.up) ask(fresh, now, [&](Out& out) { fresh.adapter->on_line(true, now, out); });
    return fresh;
}

/// Adapters for the line's families, each with its drives; those of families that have left it end with what they had in hand.
void Engine::fit_speakers(Side& side, Instant now) {
    const auto& families = side.unit.families;
    configure_side(side, now);
    std::erase_if(side.speakers, [&](const auto& s) {
        return s->probes.empty() && std::ranges::find(families, s->family.family, &FamilyEntry::family) == families.end();
    });
    for (const FamilyEntry& f : families)
        (void)bring_in(side, f, now);
    side.touched();
}

/// Makes the sides that a new line needs and opens the real one. The twins' side is made when the first drive is simulated.
void Engine::build_line(LineUnit& unit, Instant now) {
    const auto uri = parse_line_uri(unit.spec.uri);
    unit.kind = kind_of(unit.spec, families_);
    unit.stale_after = stale_limit(unit.spec, unit.kind);
    unit.log = std::make_shared<FrameLog>(trace_frames_);
    if (uri.good() && uri.uri.kind == LineUri::Kind::twin) return;
    unit.real = std::make_unique<Side>(*this, unit, false);
    unit.real->line = host_.make_line(unit.spec, setup_for(unit));
    sides_.push_back(unit.real.get());
    fit_speakers(*unit.real, now);
    unit.real->line->open(*unit.real, now);
    unit.real->touched();
}

void Engine::drop_axis(Axis& a, std::string_view why, Instant now) {
    const auto waiting = a.clients;
    for (const auto number : waiting) {
        Result r;
        r.outcome = Outcome::failed;
        r.reason = Reason::line_down;
        r.text = fmt::format("axis {}: {}", a.spec.name, why);
        finish(number, std::move(r), now);
    }
    std::erase_if(orders_, [&](const auto& entry) { return entry.second.axis == a.id; });
    image_.picture(a.id) = AxisPicture{};
    image_.publish(a.id);
}

/// Another drive, channel or twin speaks for the axis: all that was said until now is forgotten, here and by who reads the image.
void Engine::new_source(Axis& a) {
    a.source = ++sources_;
    a.said.clear();
    image_.picture(a.id).source = a.source;
    image_.publish(a.id);
}

std::shared_ptr<const SiteState> Engine::apply_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now) {
    if (tap_) tap_site(site, memory, revision, true, now);
    const FlightWithin within(tap_);
    return put_in_force(std::move(site), std::move(memory), revision, now);
}

/// All that a replay needs to begin with nothing else.
void Engine::tap_site(const Site& site, const SiteMemory& memory, std::uint64_t revision, bool at_once, Instant now) {
    auto input = std::make_shared<SiteInput>();
    input->site = site;
    input->memory = memory;
    input->revision = revision;
    input->at_once = at_once;
    input->lease = lease_;
    input->watchdog = watchdog_;
    for (const auto& d : site.drives) {
        const auto text = d.description.empty() || !families_.descriptions ? nullptr : families_.descriptions->find(d.description);
        if (text && std::ranges::find(input->descriptions, text->name, &DescriptionText::name) == input->descriptions.end())
            input->descriptions.push_back(*text);
    }
    tap_->site(std::move(input), now);
}

std::shared_ptr<const SiteState> Engine::put_in_force(Site site, SiteMemory memory, std::uint64_t revision, Instant now) {
    now_ = last_stir_ = std::max(now_, now);
    for (const auto& unit : lines_) {
        if (unit) end_scan(*unit, ScanReport::State::cancelled, "the site has changed: scan again", now);
    }
    const Site& old = site_->site;
    const KeptParts kept{old, site};

    // 1. what goes: axes, then drives, then lines. Their ids stay theirs if the name comes back.
    std::map<std::string, LineId> line_ids;
    std::map<std::string, DriveId> drive_ids;
    std::map<std::string, AxisId> axis_ids;
    for (std::size_t i = 0; i < old.lines.size(); ++i)
        line_ids[old.lines[i].name] = site_->line_ids[i];
    for (std::size_t i = 0; i < old.drives.size(); ++i)
        drive_ids[old.drives[i].name] = site_->drive_ids[i];
    for (std::size_t i = 0; i < old.axes.size(); ++i)
        axis_ids[old.axes[i].name] = site_->axis_ids[i];

    std::vector<std::unique_ptr<Axis>> gone_axes;
    for (const auto& a : old.axes) {
        if (kept.axis(a)) continue;
        auto& slot = axes_[index_of(axis_ids[a.name])];
        drop_axis(*slot, "it was removed or changed in the site", now);
        std::erase(slot->drive->axes, slot->id);
        gone_axes.push_back(std::move(slot));
    }
    for (const auto& d : old.drives) {
        if (kept.drive(d)) continue;
        auto& slot = drives_[index_of(drive_ids[d.name])];
        LineUnit& unit = *slot->line;
        if (slot->serving == Presence::twin && unit.twins) unit.twins->bus->remove(slot->id);
        std::erase(unit.drives, slot->id);
        slot.reset();
    }
    for (const auto& l : old.lines) {
        if (kept.line(l)) continue;
        auto& slot = lines_[index_of(line_ids[l.name])];
        for (Side* s : {slot->real.get(), slot->twins.get()}) {
            if (!s) continue;
            s->line->close();
            std::erase(sides_, s);
        }
        slot.reset();
    }

    // 2. what comes or changes.
    auto state = std::make_shared<SiteState>();
    state->revision = revision;
    std::vector<LineUnit*> fresh_lines;
    for (const auto& l : site.lines) {
        const auto known = line_ids.find(l.name);
        const LineId id = known != line_ids.end() ? known->second : LineId{static_cast<std::uint16_t>(lines_.size())};
        if (known == line_ids.end()) lines_.emplace_back();
        auto& slot = lines_[index_of(id)];
        if (!slot) {
            slot = std::make_unique<LineUnit>();
            slot->id = id;
            slot->spec = l;
            slot->family = families_.find(l.family);
            fresh_lines.push_back(slot.get());
        }
        slot->families.clear();
        for (const auto& name : site.families_on(l))
            slot->families.push_back(families_.find(name));
        state->line_ids.push_back(id);
    }
    std::vector<Drive*> fresh_drives;
    for (const auto& d : site.drives) {
        const auto known = drive_ids.find(d.name);
        const DriveId id = known != drive_ids.end() ? known->second : DriveId{static_cast<std::uint16_t>(drives_.size())};
        if (known == drive_ids.end()) drives_.emplace_back();
        auto& slot = drives_[index_of(id)];
        if (!slot) {
            slot = std::make_unique<Drive>();
            slot->id = id;
            slot->spec = d;
            slot->waiting_since = now;
            slot->device_link.drive = id;
            for (const auto& unit : lines_) {
                if (unit && unit->spec.name == d.line) slot->line = unit.get();
            }
            slot->line->drives.push_back(id);
            slot->family = families_.find(site.family_of(d));
            slot->catalogue = catalogue_of(site, d, families_);
            if (const auto m = memory.twins.find(d.name); m != memory.twins.end()) slot->memory = m->second;
            fresh_drives.push_back(slot.get());
        }
        state->drive_ids.push_back(id);
    }
    std::vector<AxisId> by_number;
    std::vector<LineUnit*> changed_lines;
    for (const auto& a : site.axes) {
        const auto known = axis_ids.find(a.name);
        const AxisId id = known != axis_ids.end() ? known->second : AxisId{static_cast<std::uint16_t>(axes_.size())};
        if (known == axis_ids.end()) axes_.emplace_back();
        (void)image_.grow(axes_.size());
        auto& slot = axes_[index_of(id)];
        if (!slot) {
            slot = std::make_unique<Axis>();
            slot->id = id;
            for (const auto& d : drives_) {
                if (d && d->spec.name == a.drive) slot->drive = d.get();
            }
            slot->drive->axes.push_back(id);
            new_source(*slot);
            changed_lines.push_back(slot->drive->line);
            if (slot->drive->serving != Presence::offline) slot->profile.on_presence(slot->drive->serving);
            if (const auto m = memory.stored.find(a.name); m != memory.stored.end()) {
                for (const auto& [parameter, value] : m->second) {
                    if (const auto point = slot->drive->catalogue->find(parameter)) slot->stored[*point] = value;
                }
            }
        }
        slot->leaving_until = {};
        slot->spec = a;  // number, unit, scale and limits change without disturbing anything
        slot->limits = AxisLimits::of(a);
        state->axis_ids.push_back(id);
        if (static_cast<std::size_t>(a.number) >= by_number.size()) by_number.resize(static_cast<std::size_t>(a.number) + 1, no_axis);
        by_number[static_cast<std::size_t>(a.number)] = id;
    }
    image_.set_numbers(std::move(by_number));
    image_.mapping_revision = mapping_revision(site);
    state->site = std::move(site);
    site_ = state;

    // 3. put it to work. Adapters of lines that stay are told the new set of drives; fresh lines are opened.
    for (const auto& d : drives_) {
        if (d) refit_twin(*d, now);
    }
    for (const auto& unit : lines_) {
        if (!unit || std::ranges::find(fresh_lines, unit.get()) != fresh_lines.end()) continue;
        if (unit->real) fit_speakers(*unit->real, now);
        if (unit->twins) fit_speakers(*unit->twins, now);
    }
    for (LineUnit* unit : fresh_lines)
        build_line(*unit, now);
    for (Drive* d : fresh_drives)
        decide_presence(*d, now);
    tell_options(fresh_lines, fresh_drives, now);
    for (const auto& a : axes_) {
        if (a) publish(*a, now);
    }
    return site_;
}

/// Options that nobody reads as they stand: said once, of what is new. What an adapter reads it complains of itself.
void Engine::tell_options(std::span<LineUnit* const> lines, std::span<Drive* const> drives, Instant now) {
    for (const OptionFault& f : check_options(site_->site, families_)) {
        const bool fresh = f.drive.empty() ? std::ranges::any_of(lines, [&](const LineUnit* l) { return l->spec.name == f.line; })
                                           : std::ranges::any_of(drives, [&](const Drive* d) { return d->spec.name == f.drive; });
        if (!fresh || f.adapter_says) continue;
        Event e;
        e.severity = Severity::warning;
        e.kind = "setup";
        e.line = f.line;
        e.drive = f.drive;
        e.text = f.text + "; it counts as not given";
        event(std::move(e), now);
    }
}

}  // namespace axisgate
