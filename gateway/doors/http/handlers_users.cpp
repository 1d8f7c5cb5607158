// Handlers of users: made, changed and removed by administrators; every user changes the own password. AccountChanges carries the changes
// out.
#include <fmt/core.h>

#include "gateway/doors/http/accounts.hpp"
#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/access/account_changes.hpp"
#include "gateway/services/access/authority_view.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Response user_answer(const User& user, unsigned status = 200) {
    Response r = with_tag(json_response(document_of(user), status), tag_of(user));
    if (status == 201) r.headers.set("Location", "/api/v1/users/" + percent_encode(user.name));
    return r;
}
}  // namespace

Handled list_users(Call& c) {
    if (!c.context.access) return no_accounts();
    json::array list;
    for (const auto& [name, u] : c.context.access->accounts().users())
        list.push_back(document_of(u));
    return json_response(list);
}

Handled get_user(Call& c) {
    if (!c.context.access) return no_accounts();
    return given(AccountChanges(c.context.access).find(c.names[0]), [](const User& user) { return user_answer(user); });
}

Handled add_user(Call& c, const ClockPort& clock) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    BodyReader body(c.body.get_object(), {"name", "password", "role", "enabled"});
    const auto typed = body.text("name", true, 256);
    const auto password = body.text("password", true);
    const auto role = body.role("role", true);
    const bool enabled = body.flag("enabled").value_or(true);
    const std::string name = typed ? lower(trimmed(*typed)) : std::string();
    if (typed) {
        if (const auto fault = user_name_fault(name); !fault.empty()) body.fault("name", fault, "choose another name");
    }
    if (password) {
        if (const auto fault = password_fault(*password, name); !fault.empty()) body.fault("password", fault, "choose a longer sentence");
    }
    if (!body.good()) return body.refusal();
    AccountChanges(port).add_user(
        {name, *password, *role, enabled}, c.origin(), clock.now_unix_ns(),
        [respond = c.respond](const Refusable<User>& answer) {
            respond(given(answer, [](const User& user) { return user_answer(user, 201); }));
        },
        thrown(c.respond));
    return soon();
}

Handled change_user(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    const std::string name = c.names[0];
    const AccountChanges accounts(port);
    const auto known = accounts.find(name, meant_state(c.request));  // checked before a password is hashed in vain
    if (const auto* refusal = std::get_if<ServiceRefusal>(&known)) return problem_of(*refusal);
    BodyReader body(c.body.get_object(), {"role", "enabled", "password"});
    const auto role = body.role("role", false);
    const auto enabled = body.flag("enabled");
    const auto password = body.text("password", false);
    if (password) {
        if (const auto fault = password_fault(*password, name); !fault.empty()) body.fault("password", fault, "choose a longer sentence");
    }
    if (!body.good()) return body.refusal();
    accounts.change_user(
        name, {role, enabled, password}, meant_state(c.request), c.origin(),
        [&axes, &sites, by = c.who(), respond = c.respond](const Refusable<User>& answer) {
            // A user that may not command any more loses all leases.
            const auto* now = std::get_if<User>(&answer);
            if (now && (!now->enabled || now->role < Role::operating)) end_leases_of(axes, sites, now->name, by);
            respond(given(answer, [](const User& user) { return user_answer(user); }));
        },
        thrown(c.respond));
    return soon();
}

Handled remove_user(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    AccountChanges(port).remove_user(
        c.names[0], meant_state(c.request), c.origin(),
        [&axes, &sites, name = c.names[0], by = c.who(), respond = c.respond](const std::optional<ServiceRefusal>& refusal) {
            if (!refusal) end_leases_of(axes, sites, name, by);
            respond(refusal ? problem_of(*refusal) : nothing_left());
        },
        thrown(c.respond));
    return soon();
}

Handled change_password(Call& c, const ClockPort& clock) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    const std::string name = c.names[0];
    if (c.identity.via != Identity::Via::cookie || c.identity.user != name) {
        return problem(
            403, "role",
            fmt::format("only {} changes this password, signed in on the page; an administrator sets another one with PATCH /users/{}",
                        name, name));
    }
    BodyReader body(c.body.get_object(), {"old", "new"});
    const auto old = body.text("old", true);
    const auto fresh = body.text("new", true);
    if (fresh) {
        if (const auto fault = password_fault(*fresh, name); !fault.empty()) body.fault("new", fault, "choose a longer sentence");
    }
    if (!body.good()) return body.refusal();
    // The same counting as for a sign-in, so that an open session cannot be used to try passwords.
    const std::string peer = c.request.peer;
    const auto attempt = port->accounts().begin_sign_in(name, peer, clock.now_unix_ns());
    if (attempt.pause_s > 0) {
        Response r = problem(429, "locked_out", fmt::format("too many wrong attempts: come again in {} s", attempt.pause_s));
        r.headers.set("Retry-After", std::to_string(attempt.pause_s));
        return r;
    }
    const bool taken = port->compare(
        *old, attempt.hash, [port, name, peer, fresh = *fresh, origin = c.origin(), hash = attempt.hash, respond = c.respond](bool fits) {
            if (!fits) {
                note_access(*port, origin.door, *origin.who,
                            fmt::format("change of the password of {} refused: the old one is wrong", name), Severity::warning);
                return respond(problem(403, "wrong_password", "the old password is wrong"));
            }
            port->accounts().attempt_was_good(name, peer);
            AccountChanges(port).change_password(
                name, fresh, hash, origin,
                [respond](const std::optional<ServiceRefusal>& refusal) { respond(refusal ? problem_of(*refusal) : nothing_left()); },
                thrown(respond));
        });
    if (!taken) return problem_of(too_many_passwords());
    return soon();
}

}  // namespace axisgate::http
