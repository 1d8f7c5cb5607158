// Converts users and tokens to the small JSON documents of the store and back. Text that is not such a record gives an empty result.
#include <algorithm>
#include <boost/json/object.hpp>
#include <boost/json/parse.hpp>

#include "gateway/core/text.hpp"
#include "gateway/services/access/access_register.hpp"

namespace axisgate {
namespace json = boost::json;
namespace {
std::optional<json::object> read(std::string_view text) {
    boost::system::error_code ec;
    auto v = json::parse(text, ec);
    if (ec || !v.is_object()) return std::nullopt;
    return std::move(v.get_object());
}
std::string text(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_string() ? std::string(v->get_string()) : std::string();
}
std::int64_t whole(const json::object& o, std::string_view key) {
    const auto* v = o.if_contains(key);
    return v && v->is_int64() ? v->get_int64() : 0;
}
}  // namespace

AccessRecord record_of(const User& u) {
    return {"user", u.name,
            json_text(json::object{{"name", u.name},
                                   {"role", name_of(u.role)},
                                   {"enabled", u.enabled},
                                   {"hash", u.hash},
                                   {"created_ns", u.created_ns},
                                   {"last_sign_in_ns", u.last_sign_in_ns}})};
}

AccessRecord record_of(const Token& t) {
    return {"token", t.id,
            json_text(json::object{{"id", t.id},
                                   {"name", t.name},
                                   {"owner", t.owner},
                                   {"role", name_of(t.role)},
                                   {"digest", t.digest},
                                   {"created_ns", t.created_ns},
                                   {"expires_ns", t.expires_ns},
                                   {"last_used_ns", t.last_used_ns}})};
}

AccessRecord no_use_of_user(std::string_view name) { return {"last_use", "user " + std::string(name), std::nullopt}; }
AccessRecord no_use_of_token(std::string_view id) { return {"last_use", "token " + std::string(id), std::nullopt}; }

std::vector<AccessRecord> AccessRegister::take_uses() {
    std::vector<AccessRecord> records;
    for (const auto& key : uses_) {
        json::object use;
        if (key.starts_with("user ")) {
            const auto it = users_.find(key.substr(5));
            if (it == users_.end()) continue;
            json::array good;
            for (const auto& place : it->second.good_from)
                good.emplace_back(place);
            use["at_ns"] = it->second.last_sign_in_ns;
            use["good_from"] = std::move(good);
        } else {
            const auto it = tokens_.find(key.substr(6));
            if (it == tokens_.end()) continue;
            use["at_ns"] = it->second.last_used_ns;
        }
        records.push_back({"last_use", key, json_text(use)});
    }
    uses_.clear();
    return records;
}

void AccessRegister::load_use(std::string_view name, std::string_view document) {
    const auto o = read(document);
    if (!o) return;
    if (name.starts_with("user ")) {
        const auto it = users_.find(name.substr(5));
        if (it == users_.end()) return;
        it->second.last_sign_in_ns = std::max(it->second.last_sign_in_ns, whole(*o, "at_ns"));
        const auto* good = o->if_contains("good_from");
        if (!good || !good->is_array()) return;
        for (const auto& place : good->get_array()) {
            if (place.is_string()) it->second.good_from.emplace_back(place.get_string());
        }
    } else if (name.starts_with("token ")) {
        const auto it = tokens_.find(name.substr(6));
        if (it != tokens_.end()) it->second.last_used_ns = std::max(it->second.last_used_ns, whole(*o, "at_ns"));
    }
}

AccessRecord record_of_code(std::string_view digest) {
    return {"first_sign_in", std::string(code_record_name), json_text(json::object{{"digest", digest}})};
}

std::optional<User> user_of(std::string_view document) {
    const auto o = read(document);
    if (!o) return std::nullopt;
    const auto role = role_named(text(*o, "role"));
    const auto* enabled = o->if_contains("enabled");
    User u{text(*o, "name"), role.value_or(Role::none), enabled && enabled->is_bool() && enabled->get_bool(),
           text(*o, "hash"), whole(*o, "created_ns"),   whole(*o, "last_sign_in_ns")};
    if (u.name.empty() || u.hash.empty() || u.role == Role::none) return std::nullopt;
    return u;
}

std::optional<Token> token_of(std::string_view document) {
    const auto o = read(document);
    if (!o) return std::nullopt;
    const auto role = role_named(text(*o, "role"));
    Token t{text(*o, "id"),     text(*o, "name"),        text(*o, "owner"),       role.value_or(Role::none),
            text(*o, "digest"), whole(*o, "created_ns"), whole(*o, "expires_ns"), whole(*o, "last_used_ns")};
    if (t.id.empty() || t.owner.empty() || t.digest.empty() || t.role == Role::none) return std::nullopt;
    return t;
}

std::string code_of(std::string_view document) {
    const auto o = read(document);
    return o ? text(*o, "digest") : std::string();
}

}  // namespace axisgate
