// Access register: who a request comes from: users, their sessions, tokens, local access, lockout, the first sign-in.
// In: credentials, peers, times; records from the store. Out: an Identity, or why not; records to store.
// Pure: no clock, thread, socket, store or log; passwords are only seen as hashes, secrets are kept as digests.
// Bounds: max_users, max_tokens, max_sessions in all (the longest idle one ends) and per user (its longest idle one ends), lockout's own.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "gateway/services/access/lockout.hpp"
#include "gateway/services/access/roles.hpp"

namespace axisgate {

struct User {
    std::string name;
    Role role = Role::viewer;
    bool enabled = true;
    std::string hash;  ///< of the password; never leaves the register and the store
    std::int64_t created_ns = 0;
    std::int64_t last_sign_in_ns = 0;      ///< 0: never
    std::vector<std::string> good_from{};  ///< where he signed in from, newest first; kept with his last use
};
struct Token {
    std::string id, name, owner;
    Role role = Role::viewer;
    std::string digest;
    std::int64_t created_ns = 0;
    std::int64_t expires_ns = 0;    ///< 0: never
    std::int64_t last_used_ns = 0;  ///< 0: never
};

/// A row for the store: kind "user", "token", "last_use" or "first_sign_in". When somebody was here last is a record of its own: it is
/// written beside changes, and must never bring back a user or a token as they were.
struct AccessRecord {
    std::string kind, name;
    std::optional<std::string> text;  ///< nothing: the record goes
};
[[nodiscard]] AccessRecord record_of(const User& user);
[[nodiscard]] AccessRecord record_of(const Token& token);
/// Takes the last use of a user or a token away.
[[nodiscard]] AccessRecord no_use_of_user(std::string_view name);
[[nodiscard]] AccessRecord no_use_of_token(std::string_view id);
[[nodiscard]] AccessRecord record_of_code(std::string_view digest);
inline constexpr std::string_view code_record_name = "code";
/// Nothing if the text is not what record_of writes.
[[nodiscard]] std::optional<User> user_of(std::string_view text);
[[nodiscard]] std::optional<Token> token_of(std::string_view text);
[[nodiscard]] std::string code_of(std::string_view text);

struct Identity {
    enum class Via : std::uint8_t { none, cookie, token, local };
    Via via = Via::none;
    Role role = Role::none;
    std::string user;     ///< empty for local access
    std::string token;    ///< the token's name
    std::string csrf;     ///< of a cookie session
    std::string session;  ///< digest of its id
    std::int64_t expires_ns = 0;
    bool wrong_token = false;    ///< a token was shown that is none: the request is refused, also from this machine
    bool session_ended = false;  ///< a session cookie was shown that is none any more: refused too, who signed out is not this machine
};
[[nodiscard]] std::string_view name_of(Identity::Via via) noexcept;
/// "anna 192.0.2.7:5123", "token line3 (anna) 192.0.2.7:5123", "local 127.0.0.1:5123".
[[nodiscard]] std::string who(const Identity& identity, std::string_view peer);
/// One sign-in, one token, or this machine: what is the same for all requests of it and of nothing else. Not for people's eyes.
[[nodiscard]] std::string session_of(const Identity& identity);

struct Credentials {
    std::vector<std::string_view> cookies;  ///< values of AccessSettings::cookie
    std::optional<std::string_view> bearer;
    std::string_view peer;   ///< "127.0.0.1:51123"
    bool forwarded = false;  ///< a header of proxies is there, or the host of another way in: the peer speaks for somebody else
};
/// "127.0.0.1:51123" and "[::1]:51123" without the port.
[[nodiscard]] std::string_view address_of(std::string_view peer) noexcept;
/// Whose place it is: an IPv4 address, or the /64 network of an IPv6 address, since its lower half is anybody's to choose.
[[nodiscard]] std::string network_of(std::string_view peer);
[[nodiscard]] bool is_loopback_peer(std::string_view peer) noexcept;
/// Local access alone: what a door without users uses.
[[nodiscard]] Identity local_identity(const Credentials& credentials, Role local_role);

struct AccessSettings {
    /// Name of the session's cookie: cookies belong to a host, whatever the port, so each gateway on it needs a name of its own.
    std::string cookie = "axisgate_session";
    Role local_role = Role::engineer;
    std::int64_t idle_ns = std::int64_t{60} * 60 * 1'000'000'000;   ///< a session without a request for so long ends
    std::int64_t max_ns = std::int64_t{12} * 3600 * 1'000'000'000;  ///< a session ends so long after the sign-in whatever happens
    std::size_t max_users = 256, max_tokens = 1024, max_sessions = 1024, max_sessions_per_user = 16;
};

class AccessRegister {
public:
    explicit AccessRegister(AccessSettings settings) : settings_(settings) {}

    // --- records -------------------------------------------------------------------------------------------------------
    void load(User user) { users_.insert_or_assign(user.name, std::move(user)); }
    void load(Token token) { tokens_.insert_or_assign(token.id, std::move(token)); }
    /// A record of kind "last_use", after users and tokens; one of somebody who is gone is passed over.
    void load_use(std::string_view name, std::string_view text);
    void load_code(std::string digest) { code_digest_ = std::move(digest); }

    // --- identities ----------------------------------------------------------------------------------------------------
    /// Cookie, then token, then local access, the last only without a session cookie. `touch`: the request keeps the session awake.
    [[nodiscard]] Identity identify(const Credentials& credentials, std::int64_t now_ns, bool touch = true);
    [[nodiscard]] bool has_users() const noexcept { return !users_.empty(); }
    [[nodiscard]] const AccessSettings& settings() const noexcept { return settings_; }

    /// Somebody was here, and it is not stored yet.
    [[nodiscard]] bool has_uses() const noexcept { return !uses_.empty(); }
    /// Those records, for whoever is still there; they count as stored.
    [[nodiscard]] std::vector<AccessRecord> take_uses();

    // --- signing in ------------------------------------------------------------------------------------------------------
    struct Attempt {
        std::int64_t pause_s = 0;  ///< not 0: refused, come again after it
        std::string hash;          ///< to be compared with the password; of nobody if there is no such user
    };
    /// Counts as failed until end_sign_in says otherwise. Failures count by user and address, so that nobody locks out another by guessing
    /// his name from elsewhere; and by address, for all names together. The second does not hold up a user who was let in from there
    /// before.
    [[nodiscard]] Attempt begin_sign_in(std::string_view user, std::string_view peer, std::int64_t now_ns);
    struct NewSession {
        std::string id;  ///< for the cookie; kept nowhere else
        Identity identity;
    };
    /// Nothing: wrong, or the user was changed meanwhile (`hash` is no longer his).
    [[nodiscard]] std::optional<NewSession> end_sign_in(std::string_view user, std::string_view hash, bool fits, std::string_view peer,
                                                        std::int64_t now_ns);
    /// Forgets what begin_sign_in counted: the password was right.
    void attempt_was_good(std::string_view user, std::string_view peer);
    void sign_out(std::string_view session);
    /// Seconds to wait (lockout by peer), or 0 and whether the code is right. A wrong one counts.
    struct CodeAnswer {
        std::int64_t pause_s = 0;
        bool right = false;
    };
    [[nodiscard]] CodeAnswer try_code(std::string_view typed, std::string_view peer, std::int64_t now_ns);
    void code_used() { code_digest_.clear(); }

    // --- users and tokens --------------------------------------------------------------------------------------------------
    [[nodiscard]] const std::map<std::string, User, std::less<>>& users() const noexcept { return users_; }
    [[nodiscard]] const User* user(std::string_view name) const;
    [[nodiscard]] const std::map<std::string, Token, std::less<>>& tokens() const noexcept { return tokens_; }
    [[nodiscard]] bool is_last_administrator(std::string_view name) const;
    /// Puts the user in place; what is known of his last use stays. Sessions of a user that was there end if role, password or enabled
    /// differ.
    void put(User user);
    /// The user, his sessions and his tokens go; ids of those tokens.
    std::vector<std::string> remove_user(std::string_view name);
    void put(Token token) { tokens_.insert_or_assign(token.id, std::move(token)); }
    void remove_token(std::string_view id);
    [[nodiscard]] std::size_t sessions() const noexcept { return sessions_.size(); }

private:
    struct SignedIn {
        std::string user, csrf;
        std::int64_t begun_ns = 0, used_ns = 0;
    };
    [[nodiscard]] std::optional<Identity> by_cookie(std::string_view id, std::int64_t now_ns, bool touch);
    [[nodiscard]] std::optional<Identity> by_token(std::string_view secret, std::int64_t now_ns, bool touch);
    [[nodiscard]] NewSession open_session(const User& user, std::int64_t now_ns);
    void end_sessions_of(std::string_view user);
    void make_room(std::string_view user);
    void was_good(User& user, std::string_view peer, std::int64_t now_ns);

    AccessSettings settings_;
    std::map<std::string, User, std::less<>> users_;
    std::map<std::string, Token, std::less<>> tokens_;       // by id
    std::map<std::string, SignedIn, std::less<>> sessions_;  // by the digest of the id
    std::set<std::string, std::less<>> uses_;                // names of "last_use" records
    std::string code_digest_;
    Lockout lockout_;
};

}  // namespace axisgate
