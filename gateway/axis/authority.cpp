// The lease of an axis, by client. A lease that was handed to a user alone is bound to the first client of that user that commands. There
// are never two holders, and a longer lease is never shortened.
#include "gateway/axis/authority.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/core/door_names.hpp"

namespace axisgate {
namespace {
using Verdict = AxisAuthority::Verdict;
using Change = AxisAuthority::Change;

/// Cuts before a character of several bytes, never inside it.
std::string cut(std::string_view name) {
    std::size_t n = std::min(name.size(), AxisAuthority::name_most);
    while (n > 0 && n < name.size() && (static_cast<unsigned char>(name[n]) & 0xC0u) == 0x80u)
        --n;
    return std::string(name.substr(0, n));
}
}  // namespace

AuthorityClient AuthorityClient::of(const Origin& origin) {
    AuthorityClient c;
    c.door = origin.door;
    if (origin.client) {
        c.name = cut(*origin.client);
    } else if (origin.who) {
        // A client that uses another port each time is still the same client.
        const auto colon = origin.who->rfind(':');
        c.name = cut(std::string_view(*origin.who).substr(0, colon));
    }
    return c;
}

std::string AuthorityClient::text() const { return std::string(axisgate::name_of(door)) + (name.empty() ? "" : " ") + name; }

void AxisAuthority::give(const AuthorityClient& who, Duration lease, Instant now) {
    if (holder_ != who || !held(now)) since_ = now;
    if (holder_ != who) ++revision_;
    holder_ = who;
    until_ = now + lease;
    for_any_of_user_ = false;
}

void AxisAuthority::end_lease() {
    if (commander_ == holder_) given_up_ = true;
    holder_ = {};
    ++revision_;
    until_ = {};
}

bool AxisAuthority::mine(const AuthorityClient& who) const noexcept {
    if (holder_ == who) return true;
    return for_any_of_user_ && holder_.door == who.door && who.name.size() > holder_.name.size() && who.name.starts_with(holder_.name) &&
           who.name[holder_.name.size()] == ' ';
}

/// Binds a lease for a user to this client of the user. Returns true if it was not bound before.
bool AxisAuthority::bind(const AuthorityClient& who) noexcept {
    for_any_of_user_ = false;
    if (holder_ == who) return false;
    holder_ = who;
    ++revision_;
    return true;
}

Verdict AxisAuthority::refusal(Instant now) const {
    const auto rest = std::chrono::duration_cast<std::chrono::milliseconds>(until_ - now).count();
    return {false, Change::none,
            fmt::format("held by {} for {:.1f} s more; wait, ask for it to be handed over or released, or let an engineer take it over; a "
                        "stop is always possible",
                        holder_.text(), static_cast<double>(rest) / 1000.0)};
}

Verdict AxisAuthority::may(const AuthorityClient& who, Instant now) const {
    if (held(now) && !mine(who)) return refusal(now);
    return {};
}

Verdict AxisAuthority::command(const AuthorityClient& who, AuthorityMode mode, Duration lease, Instant now) {
    if (held(now) && !mine(who)) return refusal(now);
    Verdict v;
    const bool held_already = held(now);
    if (held_already && bind(who)) v = {true, Change::renewed, "held by " + who.text()};
    if (mode == AuthorityMode::lease) {
        // A command does not shorten a lease that was taken for longer.
        give(who, held_already ? std::max(lease, until_ - now) : lease, now);
        if (!held_already) v = {true, Change::taken, "held by " + who.text()};
    }
    given_up_ = false;
    if (commander_ != who) {
        if (v.change == Change::none) {
            v = {true, Change::commander,
                 commander_.door == Door::none ? "commanded by " + who.text()
                                               : fmt::format("commanded by {} (before: {})", who.text(), commander_.text())};
        }
        commander_ = who;
        ++revision_;
    }
    return v;
}

Verdict AxisAuthority::take(const AuthorityClient& who, Duration lease, bool take_over, Instant now) {
    if (held(now) && mine(who)) {
        (void)bind(who);
        give(who, lease, now);
        return {true, Change::renewed, "renewed by " + who.text()};
    }
    if (held(now) && !take_over) return refusal(now);
    const std::string before = held(now) ? holder_.text() : std::string();
    give(who, lease, now);
    if (before.empty()) return {true, Change::taken, "held by " + who.text()};
    return {true, Change::taken_over, fmt::format("taken over by {} (before: {})", who.text(), before)};
}

Verdict AxisAuthority::release(const AuthorityClient& who, Instant now) {
    if (!held(now)) return {};
    if (!mine(who)) return refusal(now);
    end_lease();
    return {true, Change::released, "released by " + who.text()};
}

Verdict AxisAuthority::hand_over(const AuthorityClient& who, std::string_view to, Duration lease, Instant now) {
    if (!held(now)) return {false, Change::none, "nobody holds it: take it first"};
    if (!mine(who)) return refusal(now);
    AuthorityClient next{who.door, {}};
    if (const auto blank = to.find(' '); blank != std::string_view::npos) {
        if (const auto door = door_named(to.substr(0, blank))) {
            next.door = *door;
            to.remove_prefix(blank + 1);
        }
    }
    next.name = cut(to);
    if (next.name.empty()) return {false, Change::none, "name the client that shall hold it, such as \"modbus 192.0.2.7\""};
    give(next, lease, now);
    for_any_of_user_ = true;
    return {true, Change::handed_over, fmt::format("handed over to {} by {}", next.text(), who.text())};
}

Verdict AxisAuthority::expire(Instant now) {
    if (holder_.door == Door::none || held(now)) return {};
    const std::string before = holder_.text();
    end_lease();
    return {true, Change::expired, fmt::format("free again: the lease of {} has expired", before)};
}

}  // namespace axisgate
