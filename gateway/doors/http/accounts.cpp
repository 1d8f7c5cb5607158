// Reads bodies member by member, so that all faults are reported together. Bound: 20 s for a hash and the disk together.
#include "gateway/doors/http/accounts.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace axisgate::http {
namespace json = boost::json;
namespace {
constexpr std::chrono::seconds longest{20};  // for the queue of hashes on a slow processor, and the disk

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

Response no_accounts() { return problem(503, "not_ready", "this door keeps no users"); }
Handled soon() { return {longest, problem(504, "no_answer", "no result in time: look again whether it was done")}; }

}  // namespace axisgate::http
