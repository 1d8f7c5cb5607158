// Handlers of users: made, changed and removed by administrators; everybody changes his own password.
// In: calls. Out: users without their hashes. A change is in force when it is on the disk; the last administrator stays.
#include <fmt/core.h>

#include "gateway/doors/http/accounts.hpp"
#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Response last_administrator(std::string_view name) {
    return problem(409, "conflict", fmt::format("{} is the last administrator that can sign in: make another one first", name));
}

/// 412 with the user as he is, if If-Match (empty: none) means him as he was.
std::optional<Response> refuse_other(std::string_view if_match, const User& now) {
    if (!means_another(if_match, tag_of(now))) return std::nullopt;
    return overtaken(fmt::format("user {} was changed meanwhile: read it again; the ETag is {}, not {}", now.name, tag_of(now), if_match),
                     tag_of(now), document_of(now));
}

using Respond = std::function<void(Response)>;
/// What a change makes of the user as he is then; or an answer that ends it.
using Change = std::function<std::optional<Response>(AccessRegister&, std::optional<User>& user, std::string& text)>;

/// Runs a change in its turn: looked at, stored, put in force, told, answered.
void change(const std::shared_ptr<AccessPort>& port, std::string name, std::string by, Change make, unsigned status, bool body,
            const Respond& respond) {
    const bool queued = port->changes->run(
        [=](std::function<void()> done) {
            AccessRegister& accounts = port->accounts();
            std::optional<User> user;
            if (const User* u = accounts.user(name)) user = *u;
            std::string text;
            if (auto refusal = make(accounts, user, text)) {
                respond(std::move(*refusal));
                return done();
            }
            std::vector<AccessRecord> records;
            if (user) {
                records.push_back(record_of(*user));
            } else {
                for (const auto& [id, t] : accounts.tokens()) {
                    if (t.owner != name) continue;
                    records.push_back({"token", id, std::nullopt});
                    records.push_back(no_use_of_token(id));
                }
                records.push_back({"user", name, std::nullopt});
                records.push_back(no_use_of_user(name));
            }
            port->keep(std::move(records), by, [=](const std::string& fault) {
                if (!fault.empty()) {
                    respond(not_kept(fault));
                    return done();
                }
                if (user) {
                    port->accounts().put(*user);
                } else {
                    (void)port->accounts().remove_user(name);
                }
                note_access(*port, by, text);
                Response r;
                r.status = status;
                if (body && user) r = with_tag(json_response(document_of(*user), status), tag_of(*user));
                if (status == 201) r.headers.set("Location", "/api/v1/users/" + percent_encode(name));
                respond(std::move(r));
                done();
            });
        },
        thrown(respond));
    if (!queued) respond(problem(503, "busy", "too many changes wait: come again in a moment"));
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
    const User* u = c.context.access->accounts().user(c.names[0]);
    if (!u) return nothing_named("user", c.names[0]);
    return with_tag(json_response(document_of(*u)), tag_of(*u));
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
    const auto refuse = [name](const AccessRegister& accounts) -> std::optional<Response> {
        if (accounts.user(name)) return problem(409, "conflict", fmt::format("there is a user {} already", name));
        if (accounts.users().size() >= accounts.settings().max_users)
            return problem(409, "conflict", fmt::format("there are {} users already: remove one first", accounts.users().size()));
        return std::nullopt;
    };
    if (auto refusal = refuse(port->accounts())) return *refusal;
    const bool taken =
        port->derive(*password, [=, by = c.who(), respond = c.respond, now_ns = clock.now_unix_ns()](const std::string& hash) {
            if (hash.empty()) return respond(too_many_passwords());
            change(
                port, name, by,
                [=](AccessRegister& accounts, std::optional<User>& user, std::string& text) -> std::optional<Response> {
                    if (auto refusal = refuse(accounts)) return refusal;
                    user = User{name, *role, enabled, hash, now_ns, 0};
                    text = fmt::format("user {} added as {}", name, name_of(*role));
                    return std::nullopt;
                },
                201, true, respond);
        });
    if (!taken) return too_many_passwords();
    return soon();
}

Handled change_user(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    const std::string name = c.names[0];
    const std::string if_match(c.request.headers.get("If-Match"));
    const User* known = port->accounts().user(name);
    if (!known) return nothing_named("user", name);
    if (auto refusal = refuse_other(if_match, *known)) return *std::move(refusal);  // before a password is hashed for nothing
    BodyReader body(c.body.get_object(), {"role", "enabled", "password"});
    const auto role = body.role("role", false);
    const auto enabled = body.flag("enabled");
    const auto password = body.text("password", false);
    if (password) {
        if (const auto fault = password_fault(*password, name); !fault.empty()) body.fault("password", fault, "choose a longer sentence");
    }
    if (!body.good()) return body.refusal();
    const auto answer = [port, name, &axes, &sites, by = c.who(), respond = c.respond](Response r) {
        // Who may not command any more holds nothing any more.
        const User* now = port->accounts().user(name);
        if (r.status < 300 && now && (!now->enabled || now->role < Role::operating)) end_leases_of(axes, sites, name, by);
        respond(std::move(r));
    };
    const auto apply = [port, name, role, enabled, if_match, by = c.who(), answer](const std::string& hash) {
        change(
            port, name, by,
            [=](AccessRegister& accounts, std::optional<User>& user, std::string& text) -> std::optional<Response> {
                if (!user) return nothing_named("user", name);
                if (auto refusal = refuse_other(if_match, *user)) return refusal;
                const Role new_role = role.value_or(user->role);
                const bool new_enabled = enabled.value_or(user->enabled);
                if (accounts.is_last_administrator(name) && (new_role != Role::administrator || !new_enabled))
                    return last_administrator(name);
                text = fmt::format("user {} changed:", name);
                if (new_role != user->role) text += fmt::format(" role {} to {}", name_of(user->role), name_of(new_role));
                if (new_enabled != user->enabled) text += new_enabled ? " enabled" : " disabled";
                if (!hash.empty()) text += " password";
                user->role = new_role;
                user->enabled = new_enabled;
                if (!hash.empty()) user->hash = hash;
                return std::nullopt;
            },
            200, true, answer);
    };
    if (!password) {
        apply({});
    } else if (!port->derive(*password, [apply, respond = c.respond](const std::string& hash) {
                   if (hash.empty()) return respond(too_many_passwords());
                   apply(hash);
               })) {
        return too_many_passwords();
    }
    return soon();
}

Handled remove_user(Call& c, AxisPort& axes, const SitePort& sites) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    const std::string name = c.names[0];
    change(
        port, name, c.who(),
        [name, if_match = std::string(c.request.headers.get("If-Match"))](AccessRegister& accounts, std::optional<User>& user,
                                                                          std::string& text) -> std::optional<Response> {
            if (!user) return nothing_named("user", name);
            if (auto refusal = refuse_other(if_match, *user)) return refusal;
            if (accounts.is_last_administrator(name)) return last_administrator(name);
            user.reset();
            text = fmt::format("user {} removed", name);
            return std::nullopt;
        },
        204, false,
        [&axes, &sites, name, by = c.who(), respond = c.respond](Response r) {
            if (r.status < 300) end_leases_of(axes, sites, name, by);
            respond(std::move(r));
        });
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
    // The same counting as for a sign-in: a session that was left open must not become a place to try passwords.
    const std::string peer = c.request.peer;
    const auto attempt = port->accounts().begin_sign_in(name, peer, clock.now_unix_ns());
    if (attempt.pause_s > 0) {
        Response r = problem(429, "locked_out", fmt::format("too many wrong attempts: come again in {} s", attempt.pause_s));
        r.headers.set("Retry-After", std::to_string(attempt.pause_s));
        return r;
    }
    const bool taken = port->compare(
        *old, attempt.hash, [port, name, peer, fresh = *fresh, by = c.who(), hash = attempt.hash, respond = c.respond](bool fits) {
            if (!fits) {
                note_access(*port, by, fmt::format("change of the password of {} refused: the old one is wrong", name), Severity::warning);
                return respond(problem(403, "wrong_password", "the old password is wrong"));
            }
            port->accounts().attempt_was_good(name, peer);
            const bool queued = port->derive(fresh, [port, name, by, hash, respond](const std::string& made) {
                if (made.empty()) return respond(too_many_passwords());
                change(
                    port, name, by,
                    [=](AccessRegister&, std::optional<User>& user, std::string& text) -> std::optional<Response> {
                        if (!user || user->hash != hash) return problem(409, "conflict", "the user was changed meanwhile: sign in again");
                        user->hash = made;
                        text = fmt::format("user {} changed his password", name);
                        return std::nullopt;
                    },
                    204, false, respond);
            });
            if (!queued) respond(too_many_passwords());
        });
    if (!taken) return too_many_passwords();
    return soon();
}

}  // namespace axisgate::http
