// Commands of this gateway to axes of others, from the order to the sample on the bus. Orders wait for an axis that was not seen yet; a
// stop never does: it is sent first, and the state of its gateway affects only its answer.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/axis/authority.hpp"
#include "gateway/doors/dds/fleet.hpp"

namespace axisgate::dds {
namespace {
Result refusal(Reason reason, std::string text) {
    Result r;
    r.outcome = Outcome::refused;
    r.reason = reason;
    r.text = std::move(text);
    return r;
}
}  // namespace

bool Fleet::has_other(std::string_view name) const {
    return std::ranges::any_of(
        known_, [&](const auto& k) { return k.first != instance_ && k.second.gateway.alive && k.second.gateway.name == name; });
}

Result Fleet::together(const std::vector<Result>& answers, std::string_view gateway) {
    if (answers.size() == 1) return answers.front();
    const bool any_good = std::ranges::any_of(answers, [](const Result& r) { return good(r); });
    const auto spoils = [any_good](const Result& r) { return !good(r) && !(any_good && r.reason == Reason::unknown_point); };
    if (const auto bad = std::ranges::find_if(answers, spoils); bad != answers.end()) {
        Result r = *bad;
        r.text = fmt::format("one of {} gateways called {}: {}", answers.size(), gateway, r.text);
        return r;
    }
    const auto accepted = std::ranges::find(answers, Outcome::accepted, &Result::outcome);
    return accepted != answers.end() ? *accepted : *std::ranges::find(answers, Outcome::done, &Result::outcome);
}

std::optional<std::string> Fleet::not_heard_yet(const FleetOrder& o, Instant now) const {
    Result fault;
    const FleetGateway* g = target(o, fault);
    if (!g) {
        const bool young = opened_ && now - *opened_ < heard_within;
        if (!young || fault.reason != Reason::unknown_point) return std::nullopt;
        return fmt::format("the gateway {} has not been heard of yet: this one has only just come into the domain; try again", o.gateway);
    }
    const Known& k = known_.at(g->instance);
    if (k.axes.contains(o.axis) || k.axes.size() >= k.axes_told) return std::nullopt;
    return fmt::format("the axis {}/{} has not been heard of yet: {} of its gateway's {} axes have; try again", o.gateway, o.axis,
                       k.axes.size(), k.axes_told);
}

void Fleet::try_unheard(Instant now) {
    std::vector<Unheard> still;
    for (auto& u : std::exchange(unheard_, {})) {
        auto why = not_heard_yet(u.order, now);
        if (!why) {
            command(u.order, std::move(u.then), now);
        } else if (now >= u.until) {
            u.then(refusal(Reason::line_down, std::move(*why)));
        } else {
            still.push_back(std::move(u));
        }
    }
    // Orders that an answer has caused meanwhile follow behind them.
    still.insert(still.end(), std::make_move_iterator(unheard_.begin()), std::make_move_iterator(unheard_.end()));
    unheard_ = std::move(still);
}

void Fleet::command(const FleetOrder& o, std::function<void(const Result&)> then, Instant now) {
    if (is_stop(o.wish.word)) return stop(o, std::move(then), now);
    const auto busy = [] { return refusal(Reason::busy, "too many commands to other gateways wait for their results; try again later"); };
    if (auto why = not_heard_yet(o, now)) {
        if (waiting() >= waiting_most) return then(busy());
        const Duration wait = o.wait > Duration::zero() ? std::min(o.wait, heard_within) : heard_within;
        unheard_.push_back({o, now + wait, std::move(then)});
        return;
    }
    Result fault;
    const FleetGateway* g = target(o, fault);
    if (!g) return then(fault);
    const auto& axes = known_.at(g->instance).axes;
    const auto axis = axes.find(o.axis);
    if (axis == axes.end()) return then(refusal(Reason::unknown_point, fmt::format("{} has no axis {}", o.gateway, o.axis)));
    // By the same rules as at the other gateway, so that all faults are reported before anything is sent.
    const auto made = make_command(o.wish, axis->second.increments_per_unit, axis->second.unit);
    if (!made.body) {
        const auto& f = made.faults.front();
        return then(refusal(Reason::out_of_range, f.text + (f.remedy.empty() ? "" : "; " + f.remedy)));
    }
    if (is_urgent(*made.body)) {
        end_overtaken(o.gateway, o.axis, o.wish.name);
    } else if (waiting() >= waiting_most) {
        return then(busy());
    }
    send(o, {g->instance}, std::move(then), now);
}

void Fleet::stop(const FleetOrder& o, std::function<void(const Result&)> then, Instant now) {
    end_overtaken(o.gateway, o.axis, o.wish.name);
    std::set<std::uint64_t> instances;
    for (const auto& [instance, k] : known_) {
        if (instance != instance_ && k.gateway.alive && k.gateway.name == o.gateway) instances.insert(instance);
    }
    send(o, std::move(instances), std::move(then), now);
}

void Fleet::end_overtaken(const std::string& gateway, const std::string& axis, std::string_view by) {
    const auto text = fmt::format("interrupted by {} before its answer came; whether it was begun is not known", by);
    std::vector<std::string> overtaken;
    for (const auto& [id, w] : waiting_) {
        const std::string_view command(w->sample.command);
        if (w->gateway == gateway && axis == w->sample.axis && !is_stop(command) && command != "disable") overtaken.push_back(id);
    }
    Result interrupted;
    interrupted.outcome = Outcome::failed;
    interrupted.reason = Reason::interrupted;
    interrupted.text = text;
    for (const auto& id : overtaken)
        end(id, interrupted);
    // An order that was not sent has not begun, and must not begin after the stop.
    std::vector<Unheard> mine;
    for (auto& u : std::exchange(unheard_, {}))
        (u.order.gateway == gateway && u.order.axis == axis ? mine : unheard_).push_back(std::move(u));
    for (auto& u : mine)
        u.then(refusal(Reason::interrupted, fmt::format("interrupted by {} before it was sent", by)));
}

namespace {
/// The wish as a sample, whose optional members point into `w`. A stop has no members; other given members are ignored.
template <class Waiting>
void put_wish(Waiting& w, const CommandWish& wish) {
    axisgate_AxisCommand& s = w.sample;
    put_text(s.command, wish.name);
    if (w.stops) return;
    const auto number = [](const WishedNumber& wished, auto& place, auto*& member) {
        const auto* d = std::get_if<double>(&wished);
        if (!d) return;
        place = static_cast<std::remove_reference_t<decltype(place)>>(*d);
        member = &place;
    };
    number(wish.position, w.numbers[0], s.position);
    number(wish.velocity, w.numbers[1], s.velocity);
    number(wish.acceleration, w.numbers[2], s.acceleration);
    number(wish.deceleration, w.numbers[3], s.deceleration);
    number(wish.method, w.whole[0], s.method);
    number(wish.hold_ms, w.whole[1], s.hold_ms);
    s.prepare = wish.prepare == WishedFlag::yes;
    s.renew = wish.renew == WishedFlag::yes;
}
}  // namespace

void Fleet::send(const FleetOrder& o, std::set<std::uint64_t> instances, std::function<void(const Result&)> then, Instant now) {
    auto w = std::make_unique<Waiting>();
    const std::string id = fmt::format("{:x}-{}", instance_, next_++);
    axisgate_AxisCommand& s = w->sample;
    put_text(s.gateway, o.gateway);
    put_text(s.axis, o.axis);
    put_text(s.source, fmt::format("{} {}", name_, AuthorityClient::of(o.origin).name));
    put_text(s.id, id);
    w->stops = is_stop(o.wish.word);
    w->unheard = instances.empty();
    s.instance = w->stops ? 0 : *instances.begin();
    w->awaited = std::move(instances);
    w->gateway = o.gateway;
    put_wish(*w, o.wish);
    s.until_done = o.until_done;
    Duration wait = o.wait > Duration::zero() ? std::min(o.wait, waits_most) : waits_most;
    if (w->unheard) wait = std::min(wait, heard_within);
    w->sent = now;
    w->until = now + wait;
    w->then = std::move(then);
    if (waiting() >= 2 * waiting_most) {
        send_(s);
        return w->then(refusal(Reason::busy, fmt::format("{} was sent to {}/{}; too many commands to other gateways wait for their results "
                                                         "to wait for this one's, too",
                                                         o.wish.name, o.gateway, o.axis)));
    }
    const auto& kept = *waiting_.emplace(id, std::move(w)).first->second;
    send_(kept.sample);
}

}  // namespace axisgate::dds
