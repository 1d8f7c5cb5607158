// Determines the identity behind a request: users, their sessions, tokens, local access, lockout, the first sign-in. It has no clock,
// thread, socket, store or log; it sees passwords only as hashes and keeps secrets as digests. Bounds: max_users, max_tokens, max_sessions
// in total (the longest idle session ends) and per user (that user's longest idle session ends), and those of the lockout.
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
    std::vector<std::string> good_from{};  ///< addresses of earlier sign-ins, newest first; stored with the last use
};
struct Token {
    std::string id, name, owner;
    Role role = Role::viewer;
    std::string digest;
    std::int64_t created_ns = 0;
    std::int64_t expires_ns = 0;    ///< 0: never
    std::int64_t last_used_ns = 0;  ///< 0: never
};

/// A row for the store: kind "user", "token", "last_use" or "first_sign_in". The last use is a record of its own: it is written beside
/// changes, and must never restore an old state of a user or a token.
struct AccessRecord {
    std::string kind, name;
    std::optional<std::string> text;  ///< empty: the record is deleted
};
[[nodiscard]] AccessRecord record_of(const User& user);
[[nodiscard]] AccessRecord record_of(const Token& token);
/// The record that deletes the last use of a user or a token.
[[nodiscard]] AccessRecord no_use_of_user(std::string_view name);
[[nodiscard]] AccessRecord no_use_of_token(std::string_view id);
[[nodiscard]] AccessRecord record_of_code(std::string_view digest);
inline constexpr std::string_view code_record_name = "code";
/// Empty if record_of did not write the text.
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
    bool wrong_token = false;    ///< the request has an unknown token: it is refused, also from this machine
    bool session_ended = false;  ///< the request has the cookie of an ended session: it is refused, too, because a signed-out user must not
                                 ///< become local access
};
[[nodiscard]] std::string_view name_of(Identity::Via via) noexcept;
/// "anna 192.0.2.7:5123", "token line3 (anna) 192.0.2.7:5123", "local 127.0.0.1:5123".
[[nodiscard]] std::string who(const Identity& identity, std::string_view peer);
/// A key that is common to all requests of one sign-in, one token, or this machine. Not for display.
[[nodiscard]] std::string session_of(const Identity& identity);

struct Credentials {
    std::vector<std::string_view> cookies;  ///< values of AccessSettings::cookie
    std::optional<std::string_view> bearer;
    std::string_view peer;   ///< "127.0.0.1:51123"
    bool forwarded = false;  ///< there is a proxy's header, or the host of another way in: the peer forwards requests of others
};
/// "127.0.0.1:51123" and "[::1]:51123" without the port.
[[nodiscard]] std::string_view address_of(std::string_view peer) noexcept;
/// The network of an address: an IPv4 address itself, or the /64 network of an IPv6 address, because its lower half can be chosen freely.
[[nodiscard]] std::string network_of(std::string_view peer);
[[nodiscard]] bool is_loopback_peer(std::string_view peer) noexcept;
/// The identity of local access, for a door without users.
[[nodiscard]] Identity local_identity(const Credentials& credentials, Role local_role);

struct AccessSettings {
    /// Name of the session's cookie. Cookies belong to a host without its port, so each gateway on a host needs a name of its own.
    std::string cookie = "axisgate_session";
    Role local_role = Role::engineer;
    std::int64_t idle_ns = std::int64_t{60} * 60 * 1'000'000'000;   ///< a session without a request ends after this time
    std::int64_t max_ns = std::int64_t{12} * 3600 * 1'000'000'000;  ///< a session ends this long after the sign-in in any case
    std::size_t max_users = 256, max_tokens = 1024, max_sessions = 1024, max_sessions_per_user = 16;
};

class AccessRegister {
public:
    explicit AccessRegister(AccessSettings settings) : settings_(settings) {}

    // --- records -------------------------------------------------------------------------------------------------------
    void load(User user) { users_.insert_or_assign(user.name, std::move(user)); }
    void load(Token token) { tokens_.insert_or_assign(token.id, std::move(token)); }
    /// Loads a record of kind "last_use", after users and tokens; a record of a removed user or token is ignored.
    void load_use(std::string_view name, std::string_view text);
    void load_code(std::string digest) { code_digest_ = std::move(digest); }

    // --- identities ----------------------------------------------------------------------------------------------------
    // Cookie, then token, then local access, the last only without a session cookie. `touch`: the request renews the session.
    [[nodiscard]] Identity identify(const Credentials& credentials, std::int64_t now_ns, bool touch = true);
    [[nodiscard]] bool has_users() const noexcept { return !users_.empty(); }
    [[nodiscard]] const AccessSettings& settings() const noexcept { return settings_; }

    /// True if a last use is not stored yet.
    [[nodiscard]] bool has_uses() const noexcept { return !uses_.empty(); }
    /// The records of last uses for users and tokens that still exist; they count as stored.
    [[nodiscard]] std::vector<AccessRecord> take_uses();

    // --- signing in ------------------------------------------------------------------------------------------------------
    struct Attempt {
        std::int64_t pause_s = 0;  ///< not 0: refused, with the time to wait
        std::string hash;          ///< to compare with the password; hash_of_nobody if the user does not exist
    };
    /// Counts the attempt as failed until end_sign_in reports otherwise. Failures are counted by user and address, so that nobody can lock
    /// out a user from another place by guessing; and by address for all names together. The second count does not delay a user who signed
    /// in from there before.
    [[nodiscard]] Attempt begin_sign_in(std::string_view user, std::string_view peer, std::int64_t now_ns);
    struct NewSession {
        std::string id;  ///< for the cookie; stored nowhere else
        Identity identity;
    };
    /// Empty if the password is wrong, or the user was changed meanwhile (`hash` is out of date).
    [[nodiscard]] std::optional<NewSession> end_sign_in(std::string_view user, std::string_view hash, bool fits, std::string_view peer,
                                                        std::int64_t now_ns);
    /// Removes the failure that begin_sign_in counted, because the password was right.
    void attempt_was_good(std::string_view user, std::string_view peer);
    void sign_out(std::string_view session);
    /// Seconds to wait (lockout by peer), or 0 and whether the code is right. A wrong code counts as a failure.
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
    /// Replaces the user; the last use stays. Sessions of the user end if role, password or `enabled` changes.
    void put(User user);
    /// Removes the user with all sessions and tokens; returns the ids of those tokens.
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
