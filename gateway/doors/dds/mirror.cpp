// Converts requests to orders of the fleet, and its axes to states. A state that was sent before the newest answer to a command is not
// passed on: it would show the axis at a target that it has just left.
#include "gateway/doors/dds/mirror.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::dds {
using mirror::Telegram;
namespace {
DemandSource demand_source_named(std::string_view name) {
    for (const DemandSource s : {DemandSource::drive, DemandSource::computed, DemandSource::open_loop}) {
        if (name_of(s) == name) return s;
    }
    return DemandSource::none;
}

/// As a client of the fleet would request it, in the axis' unit.
CommandWish wish_of(const mirror::Order& o, double increments_per_unit) {
    CommandWish wish = CommandWish::named(o.verb);
    const auto put = [](WishedNumber& member, const std::optional<std::int64_t>& v, double scale) {
        if (v) member = static_cast<double>(*v) / scale;
    };
    put(wish.position, o.position, increments_per_unit);
    put(wish.velocity, o.velocity, increments_per_unit);
    put(wish.acceleration, o.acceleration, increments_per_unit);
    put(wish.deceleration, o.deceleration, increments_per_unit);
    put(wish.method, o.method, 1);
    put(wish.hold_ms, o.hold_ms, 1);
    if (o.renew) wish.renew = WishedFlag::yes;
    return wish;
}
}  // namespace

Fleet::Seen Mirror::seen(std::string_view address) const {
    const auto slash = address.find('/');
    return fleet_.mirrored(address.substr(0, slash), address.substr(slash + 1));
}

void Mirror::receive(std::string_view bytes, std::int64_t now_unix_ns, Instant now) {
    framer_.push(bytes, [&](std::string_view line) {
        const auto t = mirror::telegram_of(line);
        if (t && t->kind == Telegram::Kind::request) request(*t, now_unix_ns, now);
    });
}

void Mirror::request(const Telegram& t, std::int64_t now_unix_ns, Instant now) {
    const auto order = mirror::order_of(t.body);
    if (!order) return;
    if (order->verb == "state") {
        const auto it = watched_.find(t.address);
        if (it == watched_.end() && watched_.size() >= watched_most)
            return send_(
                mirror::text_of({Telegram::Kind::gone, t.number, t.address, fmt::format("{} axes are mirrored already", watched_most)}));
        Watched& w = it == watched_.end() ? watched_[t.address] : it->second;
        w.asked = now;
        return tell(t.address, w, t.number, now_unix_ns);
    }
    if (order->verb == "read") return answer(t, read(t.address, order->name, now_unix_ns));
    const auto slash = t.address.find('/');
    FleetOrder to;
    to.gateway = t.address.substr(0, slash);
    to.axis = t.address.substr(slash + 1);
    const auto axis = fleet_.mirrored(to.gateway, to.axis);
    // A stop is sent to every gateway that may still receive it, also to an unknown one or to several; the gateway answers for its drive.
    const bool goes_all_the_same = is_stop(order->verb) ? !axis.circle : order->verb == "disable" && axis.known;
    if (!axis.axis && !goes_all_the_same) return answer(t, {Outcome::refused, Reason::line_down, 0, axis.why});
    to.wish = wish_of(*order, axis.axis ? axis.axis->increments_per_unit : 1);
    to.wait = std::max(wait_least, Duration(std::chrono::milliseconds(order->wait_ms)));
    static const auto who = std::make_shared<const std::string>("mirror");
    to.origin = {Door::internal, who, who};
    fleet_.command(
        to,
        [this, t, alive = std::weak_ptr<char>(alive_)](const Result& r) {
            if (!alive.expired()) answer(t, {r.outcome, r.reason, r.code, r.text});
        },
        now);
}

void Mirror::answer(const Telegram& request, const mirror::Answer& a) {
    send_(mirror::text_of({Telegram::Kind::answer, request.number, request.address, mirror::body_of(a)}));
}

void Mirror::tell(const std::string& address, Watched& w, std::uint64_t number, std::int64_t now_unix_ns) {
    const auto found = seen(address);
    if (number == 0) number = std::exchange(w.waits, 0);
    if (!found.axis) {
        w.published = false;
        return send_(mirror::text_of({Telegram::Kind::gone, number, address, found.why}));
    }
    const FleetAxis& a = *found.axis;
    if (Fleet::outdated(a)) {
        w.waits = number;  // an older waiting question is not answered any more
        return;
    }
    mirror::State s;
    s.simulated = a.simulated;
    s.stale = a.stale;
    s.referenced = a.referenced;
    s.moving = a.moving;
    s.target_reached = a.target_reached;
    s.fault = a.fault;
    s.warning = a.warning;
    s.statusword = a.statusword;
    s.mode = a.mode;
    s.position = a.position;
    s.demand_source = demand_source_named(a.demand_source);
    s.demand = s.demand_source == DemandSource::none ? a.position : a.position_demand;
    s.velocity = a.velocity;
    s.error_code = a.error_code;
    s.age_ms = std::max<std::int64_t>(0, Fleet::age_ms(*found.gateway, a, now_unix_ns));
    w.published = true;
    send_(mirror::text_of({Telegram::Kind::state, number, address, mirror::body_of(s)}));
}

void Mirror::on_axis(std::string_view gateway, std::string_view axis, std::int64_t now_unix_ns) {
    const auto it = watched_.find(fmt::format("{}/{}", gateway, axis));
    if (it == watched_.end() || (!it->second.published && !seen(it->first).axis)) return;
    tell(it->first, it->second, 0, now_unix_ns);
}

void Mirror::on_turn(std::int64_t now_unix_ns, Instant now) {
    std::erase_if(watched_, [now](const auto& w) { return now - w.second.asked >= watched_for; });
    if (std::exchange(comings_, fleet_.comings()) == fleet_.comings()) return;
    for (auto& [address, w] : watched_) {
        if (w.published && !seen(address).axis) tell(address, w, 0, now_unix_ns);
    }
}

mirror::Answer Mirror::read(const std::string& address, const std::string& name, std::int64_t now_unix_ns) const {
    const auto found = seen(address);
    if (!found.axis) return {Outcome::refused, Reason::line_down, 0, found.why};
    const FleetGateway& g = *found.gateway;
    const FleetAxis& a = *found.axis;
    const auto done = [](auto value) { return mirror::Answer{Outcome::done, Reason::none, 0, fmt::format("{}", value)}; };
    const auto flag = [](bool on) { return mirror::Answer{Outcome::done, Reason::none, 0, on ? "1" : "0"}; };
    if (name == "VERSION") return done(g.version);
    if (name == "UPTIME") return done(g.uptime_ms / 1000);
    if (name == "CLOCK_AHEAD") return done(g.clock_ahead_ns / 1'000'000);
    if (name == "FAMILY") return done(a.family);
    if (name == "NUMBER") return done(a.number);
    if (name == "UNIT") return done(a.unit);
    if (name == "INCREMENTS_PER_UNIT") return done(a.increments_per_unit);
    if (name == "ONLINE") return flag(a.online);
    if (name == "SIMULATED") return flag(a.simulated);
    if (name == "STATUSWORD") return done(a.statusword);
    if (name == "MODE") return done(a.mode);
    if (name == "POSITION") return done(a.position);
    if (name == "DEMAND") return done(a.position_demand);
    if (name == "VELOCITY") return done(a.velocity);
    if (name == "ERROR_CODE") return done(a.error_code);
    if (name == "FAIL_SAFE_CAUSE") return done(a.fail_safe_cause);
    if (name == "AGE") return done(std::max<std::int64_t>(0, Fleet::age_ms(g, a, now_unix_ns)));
    if (name == "AUTHORITY") return done(a.authority);
    if (name == "HOLDER") return done(a.holder.empty() ? std::string("-") : a.holder);
    return {Outcome::refused, Reason::unknown_point, 0, "there is no " + name};
}

}  // namespace axisgate::dds
