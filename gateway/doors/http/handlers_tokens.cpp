// Handlers of tokens: secrets for programs, each belonging to a user, never above his role, shown once.
// In: calls. Out: tokens without their secrets, except in the answer that makes one.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/http/accounts.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::int64_t longest_s = std::int64_t{3653} * 86'400;  // ten years
constexpr std::int64_t second = 1'000'000'000;

bool may_see(const Identity& i, const Token& t) { return i.role >= Role::administrator || (!i.user.empty() && i.user == t.owner); }
}  // namespace

Handled list_tokens(Call& c) {
    if (!c.context.access) return no_accounts();
    json::array list;
    for (const auto& [id, t] : c.context.access->accounts().tokens()) {
        if (may_see(c.identity, t)) list.push_back(document_of(t));
    }
    return json_response(list);
}

Handled add_token(Call& c, const ClockPort& clock) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    if (c.identity.via != Identity::Via::cookie) {
        return problem(403, "role", "a token belongs to a user: sign in with a password first (POST /api/v1/session)");
    }
    BodyReader body(c.body.get_object(), {"name", "role", "expires_in_s"});
    const auto name = body.text("name", true, 64);
    const auto role = body.role("role", true);
    const auto expires_in_s = body.whole("expires_in_s", 1, longest_s);
    if (name && (trimmed(*name).empty() || name->find_first_of("()\r\n\t") != std::string::npos)) {
        body.fault("name", "a token's name has 1 to 64 characters, without brackets", "name the program that will use it");
    }
    if (!body.good()) return body.refusal();
    if (auto refusal = refuse_below(c.identity, *role)) return *refusal;
    const std::int64_t now_ns = clock.now_unix_ns();
    const std::string secret = random_secret();
    Token t;
    t.id = random_secret().substr(0, 12);
    t.name = std::string(trimmed(*name));
    t.owner = c.identity.user;
    t.role = *role;
    t.digest = digest_of(secret);
    t.created_ns = now_ns;
    t.expires_ns = expires_in_s ? now_ns + *expires_in_s * second : 0;
    const bool queued = port->changes->run(
        [port, t, secret, by = c.who(), respond = c.respond](std::function<void()> done) {
            const AccessRegister& accounts = port->accounts();
            if (!accounts.user(t.owner) || accounts.tokens().size() >= accounts.settings().max_tokens) {
                respond(problem(409, "conflict", fmt::format("there are {} tokens already: remove one first", accounts.tokens().size())));
                return done();
            }
            // Whoever reads who did what finds a token by its owner and its name alone.
            if (std::ranges::any_of(accounts.tokens(),
                                    [&t](const auto& x) { return x.second.owner == t.owner && x.second.name == t.name; })) {
                respond(
                    problem(409, "conflict",
                            fmt::format("{} has a token {} already: choose another name, or remove that token first", t.owner, t.name)));
                return done();
            }
            port->keep({record_of(t)}, by, [port, t, secret, by, respond, done](const std::string& fault) {
                if (!fault.empty()) {
                    respond(not_kept(fault));
                    return done();
                }
                port->accounts().put(t);
                note_access(*port, by, fmt::format("token {} made for {} as {}", t.name, t.owner, name_of(t.role)));
                auto document = document_of(t);
                document["token"] = t.id + "." + secret;
                Response r = json_response(document, 201);
                r.headers.set("Location", "/api/v1/tokens/" + percent_encode(t.id));
                respond(std::move(r));
                done();
            });
        },
        thrown(c.respond));
    if (!queued) return problem(503, "busy", "too many changes wait: come again in a moment");
    return soon();
}

Handled remove_token(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    const auto it = port->accounts().tokens().find(c.names[0]);
    if (it == port->accounts().tokens().end() || !may_see(c.identity, it->second)) return nothing_named("token", c.names[0]);
    const bool queued = port->changes->run(
        [port, &axes, &sites, t = it->second, by = c.who(), respond = c.respond](std::function<void()> done) {
            port->keep({{"token", t.id, std::nullopt}, no_use_of_token(t.id)}, by,
                       [port, &axes, &sites, t, by, respond, done](const std::string& fault) {
                           if (!fault.empty()) {
                               respond(not_kept(fault));
                               return done();
                           }
                           port->accounts().remove_token(t.id);
                           end_leases_of(axes, sites, t.owner + ' ' + t.name, by);
                           note_access(*port, by, fmt::format("token {} of {} removed", t.name, t.owner));
                           Response r;
                           r.status = 204;
                           respond(std::move(r));
                           done();
                       });
        },
        thrown(c.respond));
    if (!queued) return problem(503, "busy", "too many changes wait: come again in a moment");
    return soon();
}

}  // namespace axisgate::http
