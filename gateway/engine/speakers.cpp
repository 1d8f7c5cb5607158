// Makes the LineSetup of each adapter from the site. An adapter gets only drives of its families that its side serves.
#include <algorithm>

#include "gateway/core/line_uri.hpp"
#include "gateway/engine/routing.hpp"
#include "gateway/engine/speakers.hpp"

namespace axisgate::engine {
namespace {
Duration stale_limit(const LineSpec& spec, LineKind kind) {
    if (spec.timing.stale_after > Duration::zero()) return spec.timing.stale_after;
    return kind == LineKind::can ? std::chrono::seconds(1) : std::chrono::seconds(3);
}
/// The bit rate of embedded drives on a line that names neither a rate nor a family: the highest one of CiA 301.
constexpr std::uint32_t can_bit_rate_of_no_family = 1'000'000;
}  // namespace

/// The setup of the line without drives.
LineSetup Speakers::setup_for(const LineUnit& unit) const {
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

/// The line with the drives of this side that the adapter serves.
LineSetup Speakers::setup_for(const Speaker& speaker) const {
    const Side& side = speaker.side;
    LineSetup s = setup_for(side.unit);
    for (const DriveId id : side.unit.drives) {
        const Drive& d = *machine_.drives[index_of(id)];
        const bool here = side.twin ? d.serving == Presence::twin : d.spec.presence != PresenceRule::twin;
        if (!here || &serving_family(*d.family.family) != speaker.family.family) continue;
        DriveSetup ds;
        ds.id = id;
        ds.name = d.spec.name;
        ds.address = d.spec.address;
        ds.options = d.spec.options;
        ds.catalogue = d.catalogue;
        for (const AxisId id_of_axis : d.axes) {
            const Axis& a = *machine_.axes[index_of(id_of_axis)];
            ds.axes.push_back({id_of_axis, a.spec.channel, a.look_period, a.limits.position_min, a.limits.position_max});
        }
        s.drives.push_back(std::move(ds));
    }
    s.drives.insert(s.drives.end(), speaker.probes.begin(), speaker.probes.end());
    return s;
}

/// Gives an adapter its drives; the frames that it receives follow from their addresses.
void Speakers::configure(Speaker& speaker, Instant now) {
    const LineSetup setup = setup_for(speaker);
    const auto identifiers = speaker.side.unit.kind == LineKind::can ? speaker.family.family->can_identifiers : nullptr;
    speaker.receives_all = identifiers == nullptr;
    if (identifiers) {
        std::vector<std::string> addresses;
        for (const auto& d : setup.drives)
            addresses.push_back(d.address);
        speaker.identifiers = identifiers(addresses);
    }
    routing_.ask(speaker, now, [&](Out& out) { speaker.adapter->configure(setup, now, out); });
}

void Speakers::configure_side(Side& side, Instant now) {
    for (const auto& s : side.speakers)
        configure(*s, now);
}

/// The adapter of a family on this side; it is made if it does not exist.
Speaker& Speakers::bring_in(Side& side, const FamilyEntry& family, Instant now) {
    if (Speaker* known = side.speaker_of(family)) return *known;
    const FamilyEntry serves{&serving_family(*family.family), family.catalogue};  // each drive's setup has its own catalogue
    std::uint8_t number = 0;
    while (std::ranges::any_of(side.speakers, [&](const auto& s) { return s->number == number; }))
        ++number;
    Speaker& fresh = *side.speakers.emplace_back(std::make_unique<Speaker>(side, serves, number));
    fresh.adapter = serves.family->make_adapter(*serves.catalogue, side.unit.kind);
    configure(fresh, now);
    if (side.up) routing_.ask(fresh, now, [&](Out& out) { fresh.adapter->on_line(true, now, out); });
    return fresh;
}

/// Makes adapters for the families of the line and gives each its drives. Adapters of families that have left the line end their work and
/// are removed.
void Speakers::fit(Side& side, Instant now) {
    const auto& families = side.unit.families;
    configure_side(side, now);
    std::erase_if(side.speakers, [&](const auto& s) { return s->probes.empty() && !serves_any(*s, families); });
    for (const FamilyEntry& f : families)
        (void)bring_in(side, f, now);
    side.touched();
}

/// Makes the sides of a new line and opens the real one. The twins' side is made when the first drive is simulated.
void Speakers::build_line(LineUnit& unit, Instant now) {
    const auto uri = parse_line_uri(unit.spec.uri);
    unit.kind = kind_of(unit.spec, machine_.families);
    unit.stale_after = stale_limit(unit.spec, unit.kind);
    unit.log = std::make_shared<FrameLog>(trace_frames_, unit.kind == LineKind::can ? 8 : Frame::capacity);
    if (uri.good() && uri.uri.kind == LineUri::Kind::twin) return;
    unit.real = std::make_unique<Side>(routing_, unit, false);
    unit.real->line = host_.make_line(unit.spec, setup_for(unit));
    machine_.sides.add(*unit.real);
    fit(*unit.real, now);
    unit.real->line->open(*unit.real, now);
    unit.real->touched();
}

}  // namespace axisgate::engine
