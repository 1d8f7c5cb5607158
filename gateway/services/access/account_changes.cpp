// All changes of users and tokens pass one queue, so that no older record is stored after a newer one. The digest of a password is never
// shown.
#include "gateway/services/access/account_changes.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "gateway/core/text.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
using Why = ServiceRefusal::Why;
constexpr std::int64_t ns_per_s = 1'000'000'000;

json::value moment_or_null(std::int64_t ns) { return ns == 0 ? json::value(nullptr) : json::value(format_time(ns)); }
std::string name_in(const Origin& by) { return by.who ? *by.who : std::string(); }

ServiceRefusal last_administrator(std::string_view name) {
    return {Why::conflict, fmt::format("{} is the last administrator that can sign in: make another one first", name)};
}

/// Refuses, with the present user, if the request refers to another state of it.
std::optional<ServiceRefusal> refuse_other_user(const MeantState& meant, const User& now) {
    if (!meant.another(tag_of(now))) return std::nullopt;
    return ServiceRefusal{
        .why = Why::overtaken,
        .text = fmt::format("user {} was changed meanwhile: read it again; the ETag is {}, not {}", now.name, tag_of(now), meant.text),
        .more = {{"current", document_of(now)}},
        .tag = tag_of(now)};
}

std::optional<ServiceRefusal> refuse_new_user(const AccessRegister& accounts, const std::string& name) {
    if (accounts.user(name)) return ServiceRefusal{Why::conflict, fmt::format("there is a user {} already", name)};
    if (accounts.users().size() >= accounts.settings().max_users)
        return ServiceRefusal{Why::conflict, fmt::format("there are {} users already: remove one first", accounts.users().size())};
    return std::nullopt;
}
}  // namespace

std::string tag_of(const User& u) {
    // The digest stands for the stored password: a change of it changes the tag, but the password cannot be derived from the tag.
    return tag_over({u.name, name_of(u.role), u.enabled ? "enabled" : "", digest_of(u.hash), std::to_string(u.created_ns)});
}

json::object document_of(const User& u) {
    return {{"name", u.name},
            {"etag", tag_of(u)},
            {"role", name_of(u.role)},
            {"enabled", u.enabled},
            {"created_at", format_time(u.created_ns)},
            {"last_sign_in_at", moment_or_null(u.last_sign_in_ns)}};
}

json::object document_of(const Token& t) {
    return {{"id", t.id},
            {"name", t.name},
            {"role", name_of(t.role)},
            {"owner", t.owner},
            {"created_at", format_time(t.created_ns)},
            {"expires_at", moment_or_null(t.expires_ns)},
            {"last_used_at", moment_or_null(t.last_used_ns)}};
}

void note_access(AccessPort& port, Door door, std::string by, std::string text, Severity severity) {
    Event e;
    e.kind = "access";
    e.severity = severity;
    e.text = std::move(text);
    e.who = std::move(by);
    e.door = std::string(name_of(door));
    port.note(std::move(e));
}

void keep_uses(const std::shared_ptr<AccessPort>& port) {
    if (port->uses_wait || !port->accounts().has_uses()) return;
    port->uses_wait = true;
    const bool queued = port->changes->run(
        [port](std::function<void()> done) {
            port->uses_wait = false;
            auto records = port->accounts().take_uses();
            if (records.empty()) return done();
            port->keep(std::move(records), "axisgate", [done](const std::string&) { done(); });
        },
        nullptr);
    if (!queued) port->uses_wait = false;  // the next use tries again
}

ServiceRefusal too_many_passwords() { return {Why::overloaded, "too many passwords are being checked: come again in a moment"}; }
ServiceRefusal too_many_account_changes() { return {Why::overloaded, "too many changes wait: come again in a moment"}; }
ServiceRefusal account_not_stored(const std::string& fault) {
    return {Why::not_stored, fmt::format("the change could not be stored and is not in force: {}", fault)};
}

Refusable<User> AccountChanges::find(const std::string& name, const MeantState& meant) const {
    const User* user = port_->accounts().user(name);
    if (!user) return no_such("user", name);
    if (auto refusal = refuse_other_user(meant, *user)) return *std::move(refusal);
    return *user;
}

void AccountChanges::change(const std::string& name, const Origin& by, Make make, std::function<void(Refusable<std::optional<User>>)> then,
                            Thrown thrown) const {
    const bool queued = port_->changes->run(
        [port = port_, name, by, make = std::move(make), then](std::function<void()> done) {
            AccessRegister& accounts = port->accounts();
            std::optional<User> user;
            if (const User* u = accounts.user(name)) user = *u;
            std::string text;
            if (auto refusal = make(accounts, user, text)) {
                then(*std::move(refusal));
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
            port->keep(std::move(records), name_in(by), [port, name, by, user, text, then, done](const std::string& fault) {
                if (!fault.empty()) {
                    then(account_not_stored(fault));
                    return done();
                }
                if (user) {
                    port->accounts().put(*user);
                } else {
                    (void)port->accounts().remove_user(name);
                }
                note_access(*port, by.door, name_in(by), text);
                then(user);
                done();
            });
        },
        std::move(thrown));
    if (!queued) then(too_many_account_changes());
}

std::function<void(Refusable<std::optional<User>>)> AccountChanges::as_user(UserEnd then) {
    return [then = std::move(then)](Refusable<std::optional<User>> answer) {
        if (auto* refusal = std::get_if<ServiceRefusal>(&answer)) return then(std::move(*refusal));
        then(*std::get<std::optional<User>>(std::move(answer)));
    };
}

std::function<void(Refusable<std::optional<User>>)> AccountChanges::as_end(Ended then) {
    return [then = std::move(then)](Refusable<std::optional<User>> answer) {
        auto* refusal = std::get_if<ServiceRefusal>(&answer);
        then(refusal ? std::optional(std::move(*refusal)) : std::nullopt);
    };
}

void AccountChanges::add_user(NewUser wish, const Origin& by, std::int64_t now_unix_ns, UserEnd then, Thrown thrown) const {
    if (auto refusal = refuse_new_user(port_->accounts(), wish.name)) return then(*std::move(refusal));
    const std::string password = std::exchange(wish.password, {});
    const bool taken = port_->derive(password, [self = *this, wish, by, now_unix_ns, then, thrown](const std::string& hash) {
        if (hash.empty()) return then(too_many_passwords());
        self.change(
            wish.name, by,
            [wish, hash, now_unix_ns](AccessRegister& accounts, std::optional<User>& user, std::string& text) {
                auto refusal = refuse_new_user(accounts, wish.name);
                user = User{wish.name, wish.role, wish.enabled, hash, now_unix_ns, 0};
                text = fmt::format("user {} added as {}", wish.name, name_of(wish.role));
                return refusal;
            },
            as_user(then), thrown);
    });
    if (!taken) then(too_many_passwords());
}

void AccountChanges::change_user(const std::string& name, UserChange wish, MeantState meant, const Origin& by, UserEnd then,
                                 Thrown thrown) const {
    const auto password = std::exchange(wish.password, std::nullopt);
    const auto apply = [self = *this, name, wish, meant, by, then, thrown](const std::string& hash) {
        self.change(
            name, by,
            [=](AccessRegister& accounts, std::optional<User>& user, std::string& text) -> std::optional<ServiceRefusal> {
                if (!user) return no_such("user", name);
                if (auto refusal = refuse_other_user(meant, *user)) return refusal;
                const Role new_role = wish.role.value_or(user->role);
                const bool new_enabled = wish.enabled.value_or(user->enabled);
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
            as_user(then), thrown);
    };
    if (!password) return apply({});
    const bool taken = port_->derive(*password, [apply, then](const std::string& hash) {
        if (hash.empty()) return then(too_many_passwords());
        apply(hash);
    });
    if (!taken) then(too_many_passwords());
}

void AccountChanges::remove_user(const std::string& name, MeantState meant, const Origin& by, Ended then, Thrown thrown) const {
    change(
        name, by,
        [name, meant = std::move(meant)](AccessRegister& accounts, std::optional<User>& user,
                                         std::string& text) -> std::optional<ServiceRefusal> {
            if (!user) return no_such("user", name);
            if (auto refusal = refuse_other_user(meant, *user)) return refusal;
            if (accounts.is_last_administrator(name)) return last_administrator(name);
            user.reset();
            text = fmt::format("user {} removed", name);
            return std::nullopt;
        },
        as_end(std::move(then)), std::move(thrown));
}

void AccountChanges::change_password(const std::string& name, std::string password, std::string hash, const Origin& by, Ended then,
                                     Thrown thrown) const {
    const bool queued = port_->derive(std::move(password), [self = *this, name, by, hash, then, thrown](const std::string& made) {
        if (made.empty()) return then(too_many_passwords());
        self.change(
            name, by,
            [=](AccessRegister&, std::optional<User>& user, std::string& text) -> std::optional<ServiceRefusal> {
                if (!user || user->hash != hash) return ServiceRefusal{Why::conflict, "the user was changed meanwhile: sign in again"};
                user->hash = made;
                text = fmt::format("user {} changed his password", name);
                return std::nullopt;
            },
            as_end(then), thrown);
    });
    if (!queued) then(too_many_passwords());
}

void AccountChanges::add_token(NewToken wish, const Origin& by, std::int64_t now_unix_ns, std::function<void(Refusable<MadeToken>)> then,
                               Thrown thrown) const {
    MadeToken made;
    made.secret = random_secret();
    Token& t = made.token;
    t.id = random_secret().substr(0, 12);
    t.name = std::move(wish.name);
    t.owner = std::move(wish.owner);
    t.role = wish.role;
    t.digest = digest_of(made.secret);
    t.created_ns = now_unix_ns;
    t.expires_ns = wish.expires_in_s ? now_unix_ns + *wish.expires_in_s * ns_per_s : 0;
    const bool queued = port_->changes->run(
        [port = port_, made, by, then](std::function<void()> done) {
            const AccessRegister& accounts = port->accounts();
            const Token& token = made.token;
            if (!accounts.user(token.owner) || accounts.tokens().size() >= accounts.settings().max_tokens) {
                then(ServiceRefusal{Why::conflict, fmt::format("there are {} tokens already: remove one first", accounts.tokens().size())});
                return done();
            }
            // Events name a token only by its owner and its name, so the name must be unique for the owner.
            if (std::ranges::any_of(accounts.tokens(),
                                    [&](const auto& x) { return x.second.owner == token.owner && x.second.name == token.name; })) {
                then(ServiceRefusal{Why::conflict, fmt::format("{} has a token {} already: choose another name, or remove that token first",
                                                               token.owner, token.name)});
                return done();
            }
            port->keep({record_of(token)}, name_in(by), [port, made, by, then, done](const std::string& fault) {
                if (!fault.empty()) {
                    then(account_not_stored(fault));
                    return done();
                }
                const Token& kept = made.token;
                port->accounts().put(kept);
                note_access(*port, by.door, name_in(by),
                            fmt::format("token {} made for {} as {}", kept.name, kept.owner, name_of(kept.role)));
                then(made);
                done();
            });
        },
        std::move(thrown));
    if (!queued) then(too_many_account_changes());
}

void AccountChanges::remove_token(Token token, const Origin& by, Ended then, Thrown thrown) const {
    const bool queued = port_->changes->run(
        [port = port_, t = std::move(token), by, then](std::function<void()> done) {
            port->keep({{"token", t.id, std::nullopt}, no_use_of_token(t.id)}, name_in(by),
                       [port, t, by, then, done](const std::string& fault) {
                           if (!fault.empty()) {
                               then(account_not_stored(fault));
                               return done();
                           }
                           port->accounts().remove_token(t.id);
                           note_access(*port, by.door, name_in(by), fmt::format("token {} of {} removed", t.name, t.owner));
                           then(std::nullopt);
                           done();
                       });
        },
        std::move(thrown));
    if (!queued) then(too_many_account_changes());
}

}  // namespace axisgate
