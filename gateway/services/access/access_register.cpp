// The session of a cookie goes before a token, and local access comes last. An unknown cookie or a wrong token is never taken for local
// access.
#include "gateway/services/access/access_register.hpp"

#include <arpa/inet.h>
#include <fmt/core.h>

#include <algorithm>
#include <array>

#include "gateway/core/text.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate {
namespace {
constexpr std::int64_t kept_use_ns = std::int64_t{3600} * 1'000'000'000;  // a token's last use is stored once an hour, to spare flash
                                                                          // memory

constexpr std::size_t most_good_places = 8;  // per user; at the limit, the address that was not used for the longest time is removed

std::string user_key(std::string_view user, std::string_view peer) {
    return fmt::format("user {} at {}", lower(user.substr(0, 64)), network_of(peer));
}
std::string peer_key(std::string_view peer) { return "peer " + network_of(peer); }
}  // namespace

std::string_view name_of(Identity::Via via) noexcept {
    constexpr std::array<std::string_view, 4> names{"none", "cookie", "token", "local"};
    return names[static_cast<std::size_t>(via)];
}

std::string who(const Identity& i, std::string_view peer) {
    switch (i.via) {
        case Identity::Via::cookie:
            return fmt::format("{} {}", i.user, peer);
        case Identity::Via::token:
            return fmt::format("token {} ({}) {}", i.token, i.user, peer);
        case Identity::Via::local:
            return fmt::format("local {}", peer);
        case Identity::Via::none:
            break;
    }
    return std::string(peer);
}

std::string session_of(const Identity& i) {
    switch (i.via) {
        case Identity::Via::cookie:
            return "session " + i.session;
        case Identity::Via::token:
            return fmt::format("token {} of {}", i.token, i.user);
        case Identity::Via::local:
        case Identity::Via::none:
            break;
    }
    return "local";
}

std::string_view address_of(std::string_view peer) noexcept {
    if (peer.starts_with('[')) return peer.substr(1, peer.find(']') - 1);
    return peer.substr(0, peer.rfind(':'));
}

std::string network_of(std::string_view peer) {
    std::string address(address_of(peer));
    if (address.starts_with("::ffff:")) return address.substr(7);
    std::array<unsigned char, 16> bytes{};
    if (::inet_pton(AF_INET6, address.c_str(), bytes.data()) != 1) return address;
    std::string network;
    for (std::size_t i = 0; i < 8; i += 2)
        network += fmt::format("{:x}:", bytes[i] << 8 | bytes[i + 1]);
    return network + ":/64";
}

bool is_loopback_peer(std::string_view peer) noexcept {
    auto address = address_of(peer);
    if (address.starts_with("::ffff:")) address.remove_prefix(7);
    return address == "::1" || address.starts_with("127.");
}

Identity local_identity(const Credentials& c, Role local_role) {
    Identity i;
    if (local_role == Role::none || c.forwarded || !is_loopback_peer(c.peer)) return i;
    i.via = Identity::Via::local;
    i.role = local_role;
    return i;
}

const User* AccessRegister::user(std::string_view name) const {
    const auto it = users_.find(name);
    return it == users_.end() ? nullptr : &it->second;
}

Identity AccessRegister::identify(const Credentials& c, std::int64_t now_ns, bool touch) {
    for (const auto cookie : c.cookies) {
        if (auto found = by_cookie(cookie, now_ns, touch)) return std::move(*found);
    }
    if (c.bearer) {
        if (auto found = by_token(*c.bearer, now_ns, touch)) return std::move(*found);
        Identity nobody;
        nobody.wrong_token = true;
        return nobody;
    }
    if (!c.cookies.empty()) {
        // Signed out, expired, or from before a restart: a former viewer on this machine must not get the role of local access by that.
        Identity nobody;
        nobody.session_ended = true;
        return nobody;
    }
    return local_identity(c, settings_.local_role);
}

std::optional<Identity> AccessRegister::by_cookie(std::string_view id, std::int64_t now_ns, bool touch) {
    if (id.empty() || id.size() > 128) return std::nullopt;
    const auto it = sessions_.find(digest_of(id));
    if (it == sessions_.end()) return std::nullopt;
    SignedIn& s = it->second;
    const User* u = user(s.user);
    const std::int64_t end_ns = s.begun_ns + settings_.max_ns;
    if (!u || !u->enabled || now_ns >= end_ns || now_ns >= s.used_ns + settings_.idle_ns) {
        sessions_.erase(it);
        return std::nullopt;
    }
    if (touch) s.used_ns = std::max(s.used_ns, now_ns);
    Identity i;
    i.via = Identity::Via::cookie;
    i.role = u->role;
    i.user = u->name;
    i.csrf = s.csrf;
    i.session = it->first;
    i.expires_ns = std::min(end_ns, s.used_ns + settings_.idle_ns);
    return i;
}

std::optional<Identity> AccessRegister::by_token(std::string_view secret, std::int64_t now_ns, bool touch) {
    // "ID.SECRET": the id finds the record, the digest decides.
    const auto dot = secret.find('.');
    if (dot == std::string_view::npos || secret.size() > 256) return std::nullopt;
    const auto it = tokens_.find(secret.substr(0, dot));
    if (it == tokens_.end() || !same_secret(it->second.digest, digest_of(secret.substr(dot + 1)))) return std::nullopt;
    Token& t = it->second;
    const User* u = user(t.owner);
    if (!u || !u->enabled || (t.expires_ns != 0 && now_ns >= t.expires_ns)) return std::nullopt;
    Identity i;
    i.via = Identity::Via::token;
    i.role = std::min(t.role, u->role);
    i.user = u->name;
    i.token = t.name;
    i.expires_ns = t.expires_ns;
    if (touch && now_ns - t.last_used_ns >= kept_use_ns) {
        t.last_used_ns = now_ns;
        uses_.insert("token " + t.id);
    }
    return i;
}

AccessRegister::Attempt AccessRegister::begin_sign_in(std::string_view name, std::string_view peer, std::int64_t now_ns) {
    const std::string by_user = user_key(name, peer), by_peer = peer_key(peer);
    const User* u = user(name);
    const bool was_here = u && std::ranges::find(u->good_from, network_of(peer)) != u->good_from.end();
    Attempt a;
    a.pause_s = lockout_.pause_s(by_user, now_ns);
    if (!was_here) a.pause_s = std::max(a.pause_s, lockout_.pause_s(by_peer, now_ns, Lockout::free_failures_of_peer));
    if (a.pause_s > 0) return a;
    lockout_.failed(by_user, now_ns);
    lockout_.failed(by_peer, now_ns);
    a.hash = u && u->enabled ? u->hash : std::string(hash_of_nobody);
    return a;
}

std::optional<AccessRegister::NewSession> AccessRegister::end_sign_in(std::string_view name, std::string_view hash, bool fits,
                                                                      std::string_view peer, std::int64_t now_ns) {
    const auto it = users_.find(name);
    if (!fits || it == users_.end() || !it->second.enabled || it->second.hash != hash) return std::nullopt;
    attempt_was_good(name, peer);
    was_good(it->second, peer, now_ns);
    return open_session(it->second, now_ns);
}

void AccessRegister::attempt_was_good(std::string_view name, std::string_view peer) {
    lockout_.clear(user_key(name, peer));
    lockout_.take_back(peer_key(peer));
}

void AccessRegister::was_good(User& u, std::string_view peer, std::int64_t now_ns) {
    u.last_sign_in_ns = now_ns;
    const std::string place = network_of(peer);
    std::erase(u.good_from, place);
    u.good_from.insert(u.good_from.begin(), place);
    if (u.good_from.size() > most_good_places) u.good_from.resize(most_good_places);
    uses_.insert("user " + u.name);
}

AccessRegister::NewSession AccessRegister::open_session(const User& u, std::int64_t now_ns) {
    make_room(u.name);
    NewSession n;
    n.id = random_secret();
    SignedIn s{u.name, random_secret(), now_ns, now_ns};
    n.identity.via = Identity::Via::cookie;
    n.identity.role = u.role;
    n.identity.user = u.name;
    n.identity.csrf = s.csrf;
    n.identity.session = digest_of(n.id);
    n.identity.expires_ns = now_ns + std::min(settings_.max_ns, settings_.idle_ns);
    sessions_.insert_or_assign(n.identity.session, std::move(s));
    return n;
}

void AccessRegister::make_room(std::string_view name) {
    std::size_t own = 0;
    auto oldest = sessions_.end(), oldest_own = sessions_.end();
    for (auto it = sessions_.begin(); it != sessions_.end(); ++it) {
        if (oldest == sessions_.end() || it->second.used_ns < oldest->second.used_ns) oldest = it;
        if (it->second.user != name) continue;
        ++own;
        if (oldest_own == sessions_.end() || it->second.used_ns < oldest_own->second.used_ns) oldest_own = it;
    }
    if (own >= settings_.max_sessions_per_user) {
        sessions_.erase(oldest_own);
    } else if (sessions_.size() >= settings_.max_sessions && oldest != sessions_.end()) {
        sessions_.erase(oldest);
    }
}

void AccessRegister::sign_out(std::string_view session) {
    if (const auto it = sessions_.find(session); it != sessions_.end()) sessions_.erase(it);
}

AccessRegister::CodeAnswer AccessRegister::try_code(std::string_view typed, std::string_view peer, std::int64_t now_ns) {
    const std::string key = peer_key(peer);
    CodeAnswer a;
    a.pause_s = lockout_.pause_s(key, now_ns);
    if (a.pause_s > 0) return a;
    a.right = !code_digest_.empty() && same_secret(code_digest_, digest_of(plain_code(typed)));
    if (!a.right) lockout_.failed(key, now_ns);
    return a;
}

bool AccessRegister::is_last_administrator(std::string_view name) const {
    const auto counts = [](const User& u) { return u.enabled && u.role == Role::administrator; };
    const User* u = user(name);
    return u && counts(*u) && std::ranges::count_if(users_, [&](const auto& e) { return counts(e.second); }) == 1;
}

void AccessRegister::put(User u) {
    const auto it = users_.find(u.name);
    if (it != users_.end() && (it->second.role != u.role || it->second.hash != u.hash || it->second.enabled != u.enabled)) {
        end_sessions_of(u.name);
    }
    if (it != users_.end()) {  // the user may have signed in while the change was being stored
        u.last_sign_in_ns = std::max(u.last_sign_in_ns, it->second.last_sign_in_ns);
        u.good_from = it->second.good_from;
    }
    users_.insert_or_assign(u.name, std::move(u));
}

void AccessRegister::end_sessions_of(std::string_view name) {
    std::erase_if(sessions_, [&](const auto& s) { return s.second.user == name; });
}

std::vector<std::string> AccessRegister::remove_user(std::string_view name) {
    std::vector<std::string> gone;
    for (const auto& [id, t] : tokens_) {
        if (t.owner == name) gone.push_back(id);
    }
    for (const auto& id : gone)
        tokens_.erase(id);
    end_sessions_of(name);
    if (const auto it = users_.find(name); it != users_.end()) users_.erase(it);
    return gone;
}

void AccessRegister::remove_token(std::string_view id) {
    if (const auto it = tokens_.find(id); it != tokens_.end()) tokens_.erase(it);
}

}  // namespace axisgate
