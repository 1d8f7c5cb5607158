// Accounts: when users and tokens were last seen is kept through the same queue as changes, so that no older record comes behind a newer.
// In: bodies. Out: documents, answers. Bounds: 20 s for a hash and the disk together. Never shows a digest of a password.
#include "gateway/doors/http/accounts.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/http/preconditions.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::chrono::seconds longest{20};  // a queue of hashes on a slow processor, and the disk

json::value time_or_null(std::int64_t ns) { return ns == 0 ? json::value(nullptr) : json::value(format_time(ns)); }
}  // namespace

BodyReader::BodyReader(const json::object& body, std::initializer_list<std::string_view> known) : body_(body) {
    for (const auto& [k, v] : body) {
        if (std::ranges::find(known, std::string_view(k)) != known.end()) continue;
        if (faults_.size() >= most_faults) {
            ++more_;
            continue;
        }
        std::string list;
        for (const auto w : known)
            list += (list.empty() ? "" : ", ") + std::string(w);
        fault(k, fmt::format("{} is not known here", std::string_view(k)), "remove it, or use one of: " + list);
    }
}

void BodyReader::fault(std::string_view key, std::string text, std::string remedy) {
    if (faults_.size() >= most_faults) {
        ++more_;
        return;
    }
    faults_.push_back({"/" + std::string(key), std::move(text), std::move(remedy)});
}

std::optional<std::string> BodyReader::text(std::string_view key, bool needed, std::size_t most) {
    const auto* v = body_.if_contains(key);
    if (!v) {
        if (needed) fault(key, fmt::format("{} is missing", key), fmt::format("write \"{}\": \"...\"", key));
        return std::nullopt;
    }
    if (!v->is_string() || v->get_string().size() > most) {
        fault(key, fmt::format("{} must be a text of at most {} bytes", key, most), "write it in quotes");
        return std::nullopt;
    }
    return std::string(v->get_string());
}

std::optional<bool> BodyReader::flag(std::string_view key) {
    const auto* v = body_.if_contains(key);
    if (!v) return std::nullopt;
    if (!v->is_bool()) {
        fault(key, fmt::format("{} must be true or false", key), "write it without quotes");
        return std::nullopt;
    }
    return v->get_bool();
}

std::optional<Role> BodyReader::role(std::string_view key, bool needed) {
    const auto name = text(key, needed, 32);
    if (!name) return std::nullopt;
    const auto r = role_named(*name);
    if (r && *r != Role::none) return r;
    fault(key, fmt::format("{} is not a role", *name), "write viewer, operator, engineer or administrator");
    return std::nullopt;
}

std::optional<std::int64_t> BodyReader::whole(std::string_view key, std::int64_t low, std::int64_t high) {
    const auto* v = body_.if_contains(key);
    if (!v || v->is_null()) return std::nullopt;
    if (v->is_int64() && v->get_int64() >= low && v->get_int64() <= high) return v->get_int64();
    fault(key, fmt::format("{} must be a whole number from {} to {}", key, low, high), "or leave it out");
    return std::nullopt;
}

json::object session_document(AccessPort* port, const Identity& i) {
    const bool known = i.via != Identity::Via::none;
    return {{"user", text_or_null(i.user)},
            {"role", known ? json::value(name_of(i.role)) : json::value(nullptr)},
            {"via", name_of(i.via)},
            {"csrf", text_or_null(i.csrf)},
            {"expires_at", time_or_null(i.expires_ns)},
            {"ended", i.session_ended ? json::value(session_ended_text) : json::value(nullptr)},
            {"first_sign_in", port && !port->accounts().has_users()},
            {"roles", json::array{"viewer", "operator", "engineer", "administrator"}}};
}

std::string tag_of(const User& u) {
    // The digest stands for the stored password: a change of it is a change, but the tag leads nobody to it.
    return tag_over({u.name, axisgate::name_of(u.role), u.enabled ? "enabled" : "", digest_of(u.hash), std::to_string(u.created_ns)});
}

json::object document_of(const User& u) {
    return {{"name", u.name},
            {"etag", tag_of(u)},
            {"role", name_of(u.role)},
            {"enabled", u.enabled},
            {"created_at", format_time(u.created_ns)},
            {"last_sign_in_at", time_or_null(u.last_sign_in_ns)}};
}

json::object document_of(const Token& t) {
    return {{"id", t.id},
            {"name", t.name},
            {"role", name_of(t.role)},
            {"owner", t.owner},
            {"created_at", format_time(t.created_ns)},
            {"expires_at", time_or_null(t.expires_ns)},
            {"last_used_at", time_or_null(t.last_used_ns)}};
}

void note_access(AccessPort& port, std::string by, std::string text, Severity severity) {
    Event e;
    e.kind = "access";
    e.severity = severity;
    e.text = std::move(text);
    e.who = std::move(by);
    e.door = std::string(name_of(Door::http));
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

Response no_accounts() { return problem(503, "not_ready", "this door keeps no users"); }
Response too_many_passwords() { return problem(503, "busy", "too many passwords are being checked: come again in a moment"); }
Response not_kept(const std::string& fault) {
    return problem(507, "not_stored", fmt::format("the change could not be stored and is not in force: {}", fault));
}
Handled soon() { return {longest, problem(504, "no_answer", "no result in time: look again whether it was done")}; }

}  // namespace axisgate::http
