// The owner of a motion is found by the ticket in the axis' picture and by the holder of the axis. A motion that another command had
// started before a run's action is not claimed.
#include "gateway/services/recipes/recipe_claims.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/axis/authority.hpp"
#include "gateway/axis/cia402.hpp"

namespace axisgate {
namespace {
using Motion = RecipeAnswer::Motion;
using Whose = RecipeWorld::Claim::Whose;

bool has(const std::vector<Ticket>& list, Ticket t) { return std::ranges::find(list, t) != list.end(); }

/// Another client that holds the axis at this moment; empty: none.
std::string other_holder(const AxisPicture& p, const Origin& run, const ClockPort& clock) {
    const std::string_view holder = p.authority_holder.data();
    if (holder.empty() || clock.to_unix_ns(p.authority_until) <= clock.now_unix_ns()) return {};
    const auto me = AuthorityClient::of(run);
    // After a hand-over to a user by name, any client of that user may command.
    const bool mine = p.authority == me.door && (me.name == holder || me.name.starts_with(std::string(holder) + " "));
    return mine ? std::string() : fmt::format("{} {}", name_of(p.authority), holder);
}
}  // namespace

void RecipeClaims::ask(const std::string& axis, const AxisPicture& before) {
    Claim& c = claims_[axis];
    c.waiting = true;
    c.waiting_before = before.motion_ticket;
    c.moved_before = (before.flags & flag_moving) != 0;
}

void RecipeClaims::sent(const std::string& axis, Ticket ticket) {
    Claim& c = claims_[axis];
    if (has(c.own, ticket)) return;
    if (c.own.size() >= most_tickets) c.own.erase(c.own.begin());
    c.own.push_back(ticket);
}

Motion RecipeClaims::answered(const RecipeStep& step, const CommandBody& body, const Result& r, const AxisPicture& now) {
    Claim& c = claims_[step.axis];
    c.waiting = false;
    if (r.outcome == Outcome::refused) {  // nothing reached the drive, or the drive refused: the owner of its motion has not changed
        std::erase(c.own, r.ticket);
        return Motion::by_result;
    }
    sent(step.axis, r.ticket);
    const auto take = [&](bool sure) {
        c.sure = sure;
        c.before = c.waiting_before;
    };
    if (!good(r)) {
        const bool interrupted = r.reason == Reason::interrupted;
        take(interrupted);
        return interrupted ? Motion::interrupted : Motion::unknown;
    }
    if (std::holds_alternative<Action>(body)) {
        // The effect of an action is known only to its family. An axis that another command was moving already is assumed to continue as
        // before.
        if (c.moved_before && !has(c.own, c.waiting_before)) return Motion::nothing;
        take(false);
        return Motion::by_result;
    }
    if (const auto* data = std::get_if<ProcessData>(&body)) {
        const bool begun = now.motion_ticket == r.ticket;
        const bool may_wait = data->controlword && (*data->controlword & cia402::cw_new_setpoint) != 0;
        if (!begun && !may_wait) return Motion::nothing;
        if (begun || !c.sure) take(begun);
        return Motion::by_result;
    }
    const auto* move = std::get_if<Move>(&body);
    if (!move && !std::holds_alternative<Home>(body)) return Motion::nothing;  // a register that is a parameter
    take(!move || !move->prepare_only);
    return Motion::by_result;
}

RecipeWorld::Claim RecipeClaims::claim(const std::string& axis, const AxisPicture& now, const Origin& run, const ClockPort& clock) const {
    if (const auto holder = other_holder(now, run, clock); !holder.empty())
        return {Whose::others, fmt::format("{} holds the axis now", holder)};
    const auto it = claims_.find(axis);
    if (it == claims_.end()) return {};
    const Claim& c = it->second;
    const Ticket t = now.motion_ticket;
    const bool own = has(c.own, t) || (!c.sure && t == c.before) || (c.waiting && t == c.waiting_before);
    if (!own && t == no_ticket) return {Whose::others, "a stop has ended its motion already"};
    if (!own) return {Whose::others, fmt::format("it moves by another command now, of {}", now.authority_commander.data())};
    const bool known = (now.flags & flag_online) != 0 && (now.flags & flag_stale) == 0;
    return {known && (now.flags & flag_moving) == 0 ? Whose::resting : Whose::own, {}};
}

}  // namespace axisgate
