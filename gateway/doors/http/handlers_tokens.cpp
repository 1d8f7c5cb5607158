// Handlers of tokens: secrets for programs that belong to a user, never above the user's role, shown once.
#include <fmt/core.h>

#include "gateway/doors/http/accounts.hpp"
#include "gateway/services/access/account_changes.hpp"
#include "gateway/services/access/authority_view.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::int64_t longest_s = std::int64_t{3653} * 86'400;  // ten years

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
    AccountChanges(port).add_token(
        {std::string(trimmed(*name)), c.identity.user, *role, expires_in_s}, c.origin(), clock.now_unix_ns(),
        [respond = c.respond](const Refusable<MadeToken>& answer) {
            respond(given(answer, [](const MadeToken& made) {
                auto document = document_of(made.token);
                document["token"] = made.token.id + "." + made.secret;
                Response r = json_response(document, 201);
                r.headers.set("Location", "/api/v1/tokens/" + percent_encode(made.token.id));
                return r;
            }));
        },
        thrown(c.respond));
    return soon();
}

Handled remove_token(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    const auto it = port->accounts().tokens().find(c.names[0]);
    if (it == port->accounts().tokens().end() || !may_see(c.identity, it->second)) return nothing_named("token", c.names[0]);
    AccountChanges(port).remove_token(
        it->second, c.origin(),
        [&axes, &sites, client = it->second.owner + ' ' + it->second.name, by = c.who(),
         respond = c.respond](const std::optional<ServiceRefusal>& refusal) {
            if (!refusal) end_leases_of(axes, sites, client, by);
            respond(refusal ? problem_of(*refusal) : nothing_left());
        },
        thrown(c.respond));
    return soon();
}

}  // namespace axisgate::http
