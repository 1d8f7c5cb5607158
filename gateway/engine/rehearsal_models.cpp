// Cuts one line out of the site, replaces it by a line with a cable, connects the models behind the cable, and advances the time on both
// sides. A model never receives frames of two gateways at once.
#include "gateway/engine/rehearsal_models.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/line_uri.hpp"
#include "gateway/engine/door.hpp"
#include "gateway/wire/specimen_twin.hpp"
#include "gateway/wire/twin_bus_end.hpp"

namespace axisgate {
namespace {
using namespace std::chrono_literals;

/// The far end of the cable while there is no gateway.
class NoGateway final : public LineEvents {
public:
    void on_frame(const Frame&) override {}
    void on_line_state(bool, const std::string&) override {}
    void on_sent(const Frame&) override {}
};

/// A line that has only embedded drives has no cable. It gets one on which a frame takes the same time.
void lay_cable(LineSpec& line, const Families& families) {
    const auto uri = parse_line_uri(line.uri);
    if (uri.good() && uri.uri.kind != LineUri::Kind::twin) return;
    const Family* family = families.find(line.family).family;
    if (kind_of(line, families) == LineKind::can) {
        constexpr std::uint32_t of_no_family = 1'000'000;  // the highest bit rate of CiA 301
        if (line.bitrate == 0) line.bitrate = family ? family->default_can_bit_rate : of_no_family;
        line.uri = "can:model";
    } else {
        line.uri = line.bitrate == 0 ? "serial:/dev/model" : fmt::format("serial:/dev/model?baud={}", line.bitrate);
    }
}

/// The line of the axis with all of its drives, each served by its model. Limits of position are left out, because they would end the
/// motion first.
Site only_its_line(const Site& site, const AxisSpec& axis, const Families& families) {
    Site s;
    const auto drive = std::ranges::find(site.drives, axis.drive, &DriveSpec::name);
    for (const auto& l : site.lines) {
        if (l.name != drive->line) continue;
        s.lines.push_back(l);
        lay_cable(s.lines.back(), families);
    }
    for (const auto& d : site.drives) {
        if (d.line != drive->line) continue;
        s.drives.push_back(d);
        s.drives.back().presence = PresenceRule::device;
        if (const auto own = site.own_catalogues.find(d.name); own != site.own_catalogues.end()) s.own_catalogues.insert(*own);
    }
    for (const auto& a : site.axes) {
        if (std::ranges::find(s.drives, a.drive, &DriveSpec::name) == s.drives.end()) continue;
        s.axes.push_back(a.name == axis.name ? axis : a);
        s.axes.back().position_min = s.axes.back().position_max = std::nullopt;
    }
    return s;
}
}  // namespace

RehearsalModels::RehearsalModels(const Families& families, const Site& site, const SiteMemory& memory, const AxisSpec& axis, Times times)
    : families_(families), memory_(memory), spec_(axis), times_(times), site_(only_its_line(site, axis, families)) {
    start_gateway();
}

RehearsalModels::~RehearsalModels() = default;

void RehearsalModels::start_gateway() {
    gateway_ = std::make_unique<Gateway>(families_, *this);
    Engine& e = gateway_->engine;
    e.set_watchdog(times_.watchdog);
    e.set_lease(times_.lease);
    const auto state = e.apply_site(site_, memory_, 1, now_);
    for (std::size_t i = 0; i < site_.axes.size(); ++i)
        if (site_.axes[i].name == spec_.name) axis_id_ = state->axis_ids[i];
    for (std::size_t i = 0; i < site_.drives.size(); ++i)
        if (site_.drives[i].name == spec_.drive) drive_id_ = state->drive_ids[i];
}

/// Without notice: frames on the wire or in a queue are lost.
void RehearsalModels::kill_gateway() {
    static NoGateway nobody;
    gateway_.reset();
    bus_->open(nobody, now_);
}

std::unique_ptr<Line> RehearsalModels::make_line(const LineSpec& spec, const LineSetup& setup) {
    if (!bus_) {
        TwinBusOptions o;
        o.kind = setup.kind;
        o.bit_rate = setup.bit_rate;
        o.bits_per_byte = setup.bits_per_byte;
        o.full_duplex = option(spec.options, "full_duplex", "false") == "true";
        o.converter = setup.kind == LineKind::bytes && families_.find(spec.family).family->uses_can;
        bus_ = std::make_unique<TwinBus>(o);
        plug_in(setup);
    }
    return std::make_unique<TwinBusEnd>(*bus_);
}

/// The model of each drive, with the channels that the site uses. A gateway numbers the drives in the order of the site.
void RehearsalModels::plug_in(const LineSetup& setup) {
    for (std::size_t i = 0; i < site_.drives.size(); ++i) {
        const DriveSpec& d = site_.drives[i];
        TwinSetup t;
        t.address = d.address;
        for (const auto& a : site_.axes)
            if (a.drive == d.name) t.axes = std::max(t.axes, a.channel);
        t.kind = setup.kind;
        t.bit_rate = site_.lines.front().bitrate;
        t.options = d.options;
        for (const auto& [k, v] : site_.lines.front().options)
            t.options.emplace(k, v);
        const auto kept = memory_.twins.find(d.name);
        bus_->add(DriveId{static_cast<std::uint16_t>(i)},
                  make_specimen(*families_.find(site_.family_of(d)).family, *catalogue_of(site_, d, families_), t),
                  kept == memory_.twins.end() ? NonVolatile{} : kept->second, now_);
    }
}

bool RehearsalModels::online() const { return gateway_ && (picture().flags & flag_online) != 0 && picture().ever_seen; }

void RehearsalModels::step() {
    const Instant due = gateway_ ? gateway_->engine.deadline() : bus_->deadline();
    now_ = std::clamp(due, now_ + 10us, now_ + 1ms);
    if (gateway_) {
        gateway_->engine.on_deadline(now_);
    } else {
        bus_->on_deadline(now_);
    }
    if (tend) tend();
}

Ticket RehearsalModels::give(CommandBody body, const Origin& by) {
    Command c;
    const Ticket t = c.ticket = make_ticket(first_service_door, ++tickets_);
    c.axis = axis_id_;
    c.origin = by;
    c.body = std::move(body);
    gateway_->engine.on_command(std::move(c), now_);
    return t;
}

std::optional<Result> RehearsalModels::ask(CommandBody body, const Origin& by, Duration limit) {
    answer_.reset();
    awaited_ = make_ticket(first_service_door, tickets_ + 1);  // the answer may come at once
    (void)give(std::move(body), by);
    (void)run_until([&] { return answer_.has_value(); }, limit);
    awaited_ = no_ticket;
    return std::exchange(answer_, std::nullopt);
}

void RehearsalModels::on_result(const Result& result) {
    if (result.ticket == awaited_) answer_ = result;
}

void RehearsalModels::on_event(Event event, Instant at) {
    if (event.axis == spec_.name && on_axis_event) on_axis_event(event, at);
}

}  // namespace axisgate
