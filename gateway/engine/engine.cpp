// The entry points of Engine, and its time: which deadline is next, which sides are due, and the periodic checks. A side that was not
// touched and is not due is never visited.
#include "gateway/engine/engine.hpp"

#include <algorithm>

#include "gateway/engine/engine_parts.hpp"
#include "gateway/engine/flight_record.hpp"

namespace axisgate {
using engine::Axis, engine::LineUnit, engine::Machine, engine::Side, engine::Speaker;

Engine::Engine(Families families, EngineHost& host, Image& image, std::size_t trace_frames)
    : parts_(std::make_unique<Parts>(std::move(families), host, image, trace_frames)) {}

Engine::~Engine() = default;

// --- to the parts ---------------------------------------------------------------------------------------------------

void Engine::set_tap(FlightTap* tap) noexcept { parts_->publisher.set_tap(tap); }
void Engine::set_lease(Duration lease) noexcept { parts_->machine.lease = lease; }
void Engine::set_watchdog(Duration limit) noexcept { parts_->machine.watchdog = limit; }

std::shared_ptr<const SiteState> Engine::apply_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now) {
    return parts_->site_change.apply_at_once(std::move(site), std::move(memory), revision, now);
}
void Engine::change_site(Site site, SiteMemory memory, std::uint64_t revision, Instant now, Applied then) {
    parts_->site_change.begin(std::move(site), std::move(memory), revision, now, std::move(then));
}
const std::shared_ptr<const SiteState>& Engine::site() const noexcept { return parts_->machine.site; }

void Engine::on_command(Command command, Instant now) {
    end_lapsed_lease(command.axis, command.origin, now);
    parts_->commands.on_command(std::move(command), now);
}
std::optional<Refusal> Engine::on_set_point(const SetPoint& set_point, Instant now) {
    end_lapsed_lease(set_point.axis, set_point.origin, now);
    return parts_->streams.on_set_point(set_point, now);
}
void Engine::on_client_lost(const AuthorityClient& who, LossCause cause, Instant now) { parts_->loss.on_client_lost(who, cause, now); }
void Engine::on_stored(Ticket order, const std::string& fault, Instant now) { parts_->orders.on_stored(order, fault, now); }
void Engine::shut_down(Instant now) { parts_->loss.shut_down(now); }

std::string Engine::start_scan(LineId line, ScanWish wish, Instant now) { return parts_->scans.start(line, std::move(wish), now); }
void Engine::cancel_scan(LineId line, Instant now) { parts_->scans.cancel(line, now); }
ScanReport Engine::scan_report(LineId line) const { return parts_->scans.report(line); }
std::string Engine::look_closely(const std::vector<AxisId>& axes, Duration period, Instant until, Instant now) {
    return parts_->looks.ask_for(axes, period, until, now);
}
Twin* Engine::twin(DriveId drive) { return parts_->twins.of(drive); }
std::string Engine::set_hand(DriveId drive, const std::vector<std::pair<std::string, Value>>& items, const Origin& origin, Instant now) {
    if (FlightTap* tap = parts_->publisher.tap()) tap->hand(drive, items, origin, now);
    return parts_->twins.use_hand(drive, items, origin, now);
}

std::string Engine::adopt(DriveId drive, NonVolatile memory, const Origin& origin, Instant now) {
    if (FlightTap* tap = parts_->publisher.tap()) tap->adopt(drive, memory, origin, now);
    return parts_->twins.adopt(drive, std::move(memory), origin, now);
}

const Histogram& Engine::write_to_frame() const noexcept { return parts_->routing.write_to_frame(); }
std::uint64_t Engine::losses(LossCause cause) const noexcept { return parts_->loss.losses(cause); }

// --- time -----------------------------------------------------------------------------------------------------------

bool Engine::at_rest(Instant now) const noexcept {
    const auto& pending = parts_->pending;
    return pending.clients.empty() && pending.orders.empty() && !parts_->site_change.waits() &&
           now - parts_->machine.last_stir >= std::chrono::seconds(1);
}

Instant Engine::deadline() const {
    Machine& machine = parts_->machine;
    return std::min(machine.lines.empty() ? never : next_housekeeping_, machine.sides.earliest());
}

Instant Engine::wake_at() const {
    constexpr std::size_t most_looked_at = 32;  // no line has more orders than this outstanding
    const auto& orders = parts_->pending.orders;
    Machine& machine = parts_->machine;
    if (orders.size() > most_looked_at || parts_->site_change.waits()) return deadline();
    const auto waits = [&](const Side& side) {
        return std::ranges::none_of(orders, [&](const auto& o) {
            const Axis* a = o.second.at_drive() ? machine.axis(o.second.axis) : nullptr;
            return a && a->drive->line == &side.unit;
        });
    };
    return std::min(machine.lines.empty() ? never : next_housekeeping_, machine.sides.earliest(twins_wait, waits));
}

void Engine::on_deadline(Instant now) {
    Parts& p = *parts_;
    if (FlightTap* tap = p.publisher.tap()) tap->turn(now);
    const FlightWithin within(p.publisher.tap());
    Machine& machine = p.machine;
    machine.now = std::max(machine.now, now);
    // The loop is bounded: a side that is due again at once has its next turn in the next call.
    std::size_t at = 0;
    for (Side* next = machine.sides.due(at, now); next; next = machine.sides.due(at, now)) {
        Side& s = *next;
        at = s.place + 1;
        s.touched();
        if (s.line->deadline() <= now) s.line->on_deadline(now);
        for (std::size_t k = 0; k < s.speakers.size(); ++k) {
            Speaker& by = *s.speakers[k];
            if (by.adapter->deadline() <= now) p.routing.ask(by, now, [&](Out& out) { by.adapter->on_deadline(now, out); });
        }
    }
    if (now >= next_housekeeping_) {
        next_housekeeping_ = now + engine::housekeeping_period;
        housekeeping(now);
        p.site_change.check(now);
        for (Side* s : machine.sides)
            s->touched();
    }
}

/// Another client's message may come after the end of a lease and before the next housekeeping. The motion of the former holder ends first,
/// since it would have neither a holder nor a loss afterwards.
void Engine::end_lapsed_lease(AxisId axis, const Origin& origin, Instant now) {
    Axis* a = parts_->machine.axis(axis);
    if (a && a->authority.holder() != AuthorityClient::of(origin)) end_lapsed_lease(*a, now);
}

void Engine::end_lapsed_lease(Axis& a, Instant now) {
    if (a.authority.holder().door == Door::none || a.authority.held(now)) return;
    const AuthorityClient holder = a.authority.holder();
    const auto v = a.authority.expire(now);
    parts_->loss.on_lease_ended(a, holder, now);
    parts_->authority.changed(a, v, nullptr, now);
}

void Engine::housekeeping(Instant now) {
    Parts& p = *parts_;
    p.looks.end_those_over(now);
    for (const auto& unit : p.machine.lines) {
        if (unit) p.scans.turn(*unit, now);
    }
    for (const auto& slot : p.machine.axes) {
        if (!slot) continue;
        Axis& a = *slot;
        const bool stale = now - a.profile.feedback().at > a.drive->line->stale_after || !p.machine.image.picture(a.id).current;
        if (stale != a.stale) {
            a.stale = stale;
            p.publisher.publish(a, now);
        }
        if (!a.clients.empty()) p.clients.track(a, now);
        p.motions.check(a, now);
        p.loss.check_watchdog(a, now);
        p.streams.check(a, now);
        end_lapsed_lease(a, now);
    }
    for (const auto& slot : p.machine.drives) {
        if (!slot) continue;
        p.presences.decide(*slot, now);
        p.presences.end_handback(*slot, now);
        p.twins.save_memory(*slot);
    }
}

}  // namespace axisgate
