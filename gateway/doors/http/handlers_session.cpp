// Handlers of the session: the present identity, sign in, sign out, and the first sign-in of a new gateway. A wrong user and a wrong
// password have the same answer after the same time.
#include <fmt/core.h>

#include "gateway/doors/http/accounts.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
Response paused(std::int64_t pause_s) {
    Response r = problem(429, "locked_out", fmt::format("too many wrong attempts: come again in {} s", pause_s));
    r.headers.set("Retry-After", std::to_string(pause_s));
    return r;
}

Response signed_in(AccessPort& port, const AccessRegister::NewSession& session, bool secure) {
    Response r = json_response(session_document(&port, session.identity));
    r.headers.set("Set-Cookie", set_cookie(port, session.id, secure, false));
    return r;
}

/// For an event: the text typed as a user's name may be a password in the wrong field, so only possible names are written.
std::string shown_name(std::string_view typed) { return user_name_fault(typed).empty() ? std::string(typed) : "a name that is none"; }
}  // namespace

Handled get_session(Call& c) {
    Response r = json_response(session_document(c.context.access.get(), c.identity));
    // Sent once: without the cookie the next request is local access again, if that is permitted.
    if (c.identity.session_ended) r.headers.set("Set-Cookie", set_cookie(*c.context.access, "", c.request.secure, true));
    return r;
}

Handled sign_in(Call& c, const ClockPort& clock) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    BodyReader body(c.body.get_object(), {"user", "password"});
    const auto user = body.text("user", true, 256);
    const auto password = body.text("password", true);
    if (!body.good()) return body.refusal();
    const std::string peer = c.request.peer, name = lower(trimmed(*user));
    // Only known names are distinguished in events; the table of pauses treats all alike.
    const auto attempt = port->accounts().begin_sign_in(name, peer, clock.now_unix_ns());
    if (attempt.pause_s > 0) return paused(attempt.pause_s);
    const bool taken =
        port->compare(*password, attempt.hash,
                      [port, name, peer, hash = attempt.hash, secure = c.request.secure, respond = c.respond, old = c.identity.session,
                       &clock](bool fits) {
                          const auto session = port->accounts().end_sign_in(name, hash, fits, peer, clock.now_unix_ns());
                          if (!session) {
                              note_access(*port, clients, peer, fmt::format("sign-in refused: {}", shown_name(name)), Severity::warning);
                              return respond(problem(401, "wrong_sign_in", "the user or the password is wrong"));
                          }
                          if (!old.empty()) port->accounts().sign_out(old);  // another cookie replaces the old one
                          note_access(*port, clients, who(session->identity, peer), fmt::format("{} signed in", name));
                          keep_uses(port);
                          respond(signed_in(*port, *session, secure));
                      });
    if (!taken) return problem_of(too_many_passwords());
    return soon();
}

Handled sign_out(Call& c) {
    Response r;
    r.status = 204;
    if (const auto port = c.context.access; port && c.identity.via == Identity::Via::cookie) {
        port->accounts().sign_out(c.identity.session);
        note_access(*port, clients, c.who(), fmt::format("{} signed out", c.identity.user));
        r.headers.set("Set-Cookie", set_cookie(*c.context.access, "", c.request.secure, true));
    } else if (c.identity.session_ended) {
        r.headers.set("Set-Cookie", set_cookie(*c.context.access, "", c.request.secure, true));
    }
    return r;
}

Handled first_sign_in(Call& c, const ClockPort& clock) {
    const auto port = c.context.access;
    if (!port) return no_accounts();
    BodyReader body(c.body.get_object(), {"code", "user", "password"});
    const auto code = body.text("code", true, 64);
    const auto user = body.text("user", true, 256);
    const auto password = body.text("password", true);
    if (!body.good()) return body.refusal();
    const auto exists = [] {
        return problem(409, "conflict", "there are users already: sign in, or let an administrator make a user for you");
    };
    if (port->accounts().has_users()) return exists();
    const std::string peer = c.request.peer, name = lower(trimmed(*user));
    if (const auto fault = user_name_fault(name); !fault.empty()) body.fault("user", fault, "choose another name");
    if (const auto fault = password_fault(*password, name); !fault.empty())
        body.fault("password", fault, "choose a longer sentence that only you know");
    const auto answer = port->accounts().try_code(*code, peer, clock.now_unix_ns());
    if (answer.pause_s > 0) return paused(answer.pause_s);
    if (!answer.right) {
        note_access(*port, clients, peer, "first sign-in refused: the code is wrong", Severity::warning);
        return problem(401, "wrong_sign_in", "the code is wrong: it was printed when the gateway started for the first time");
    }
    if (!body.good()) return body.refusal();
    const bool taken =
        port->derive(*password, [port, name, peer, exists, secure = c.request.secure, respond = c.respond, &clock](std::string hash) {
            if (hash.empty()) return respond(problem(503, "busy", "there is not enough memory to compute the password's hash: come again"));
            const bool queued = port->changes->run(
                [port, name, peer, exists, hash = std::move(hash), secure, respond, &clock](std::function<void()> done) {
                    if (port->accounts().has_users()) {
                        respond(exists());
                        return done();
                    }
                    User u{name, Role::administrator, true, hash, clock.now_unix_ns(), 0};
                    port->keep({record_of(u), {"first_sign_in", std::string(code_record_name), std::nullopt}}, name,
                               [port, u, name, peer, secure, respond, done, &clock](const std::string& fault) {
                                   if (!fault.empty()) {
                                       respond(problem_of(account_not_stored(fault)));
                                       return done();
                                   }
                                   port->accounts().put(u);
                                   port->accounts().code_used();
                                   const auto session = port->accounts().end_sign_in(name, u.hash, true, peer, clock.now_unix_ns());
                                   keep_uses(port);
                                   note_access(*port, clients, session ? who(session->identity, peer) : peer,
                                               fmt::format("first sign-in: {} is administrator", name));
                                   respond(session ? signed_in(*port, *session, secure)
                                                   : problem(500, "internal", "the user was made, but not signed in"));
                                   done();
                               });
                },
                thrown(respond));
            if (!queued) respond(problem_of(too_many_passwords()));
        });
    if (!taken) return problem_of(too_many_passwords());
    return soon();
}

}  // namespace axisgate::http
