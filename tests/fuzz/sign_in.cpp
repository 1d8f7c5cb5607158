// Fuzz target for identities: sign-ins, cookies, tokens, the first code, users that change meanwhile; and the records of the store. Laws: a
// role comes only from a correct password, an existing token, or this machine; bounds hold; a written record is read back as the same.
#include "gateway/services/access/access_register.hpp"
#include "gateway/services/access/secrets.hpp"
#include "tests/fuzz/fuzz.hpp"

using namespace axisgate;
using fuzz::require;

namespace {

void records(std::string_view text) {
    if (const auto u = user_of(text)) {
        const auto again = user_of(*record_of(*u).text);
        require(again && again->name == u->name && again->role == u->role && again->enabled == u->enabled && again->hash == u->hash &&
                    again->created_ns == u->created_ns && again->last_sign_in_ns == u->last_sign_in_ns,
                "a user is read back as it was written");
        require(u->role != Role::none && !u->hash.empty(), "a user has a role and a password");
    }
    if (const auto t = token_of(text)) {
        const auto again = token_of(*record_of(*t).text);
        require(again && again->id == t->id && again->owner == t->owner && again->digest == t->digest && again->expires_ns == t->expires_ns,
                "a token is read back as it was written");
    }
    (void)code_of(text);
    (void)plain_code(text);
    (void)password_fault(text, "anna");
    (void)user_name_fault(text);
    (void)address_of(text);
    (void)is_loopback_peer(text);
}

constexpr std::string_view code = "K7QF-2M9D-XW3E-8HTR";

class Run {
public:
    explicit Run(FuzzedDataProvider& in) : in_(in) {}
    void run() {
        for (const char* name : {"anna", "bert"}) {
            User u;
            u.name = name;
            u.hash = std::string("hash of ") + name;
            u.role = Role::administrator;
            accounts_.load(std::move(u));
        }
        while (in_.remaining_bytes() > 0)
            one();
    }

private:
    void one() {
        now_ += in_.ConsumeIntegralInRange<std::int64_t>(0, 3'600'000'000'000);
        const std::string name = in_.ConsumeBool() ? in_.ConsumeBool() ? "anna" : "bert" : in_.ConsumeRandomLengthString(20);
        const std::string peer =
            in_.ConsumeBool() ? "192.0.2.7:" + std::to_string(in_.ConsumeIntegral<std::uint16_t>()) : in_.ConsumeRandomLengthString(24);
        switch (in_.ConsumeIntegralInRange<int>(0, 7)) {
            case 0:
            case 1:
                sign_in(name, peer);
                break;
            case 2: {
                User u;
                u.name = name;
                u.hash = "hash of " + name;
                u.enabled = in_.ConsumeBool();
                u.role = in_.ConsumeBool() ? Role::viewer : Role::engineer;
                if (!name.empty() && accounts_.users().size() < accounts_.settings().max_users) accounts_.put(std::move(u));
                break;
            }
            case 3:
                (void)accounts_.remove_user(name);
                break;
            case 4: {
                Token t;
                t.id = name + "-1";
                t.owner = name;
                t.name = "line 3";
                t.role = Role::operating;
                t.digest = digest_of("secret of " + name);
                t.expires_ns = in_.ConsumeBool() ? 0 : now_ + in_.ConsumeIntegralInRange<std::int64_t>(-1'000'000'000, 1'000'000'000'000);
                if (accounts_.user(name)) accounts_.put(std::move(t));
                break;
            }
            case 5:
                if (in_.ConsumeBool()) {
                    accounts_.load_code(digest_of(plain_code(code)));
                    there_is_a_code_ = true;
                }
                try_code(in_.ConsumeRandomLengthString(24), peer);
                break;
            case 6:
                if (!sessions_.empty())
                    accounts_.sign_out(digest_of(sessions_[in_.ConsumeIntegralInRange<std::size_t>(0, sessions_.size() - 1)]));
                break;
            default:
                identify(peer);
                break;
        }
        require(accounts_.sessions() <= accounts_.settings().max_sessions, "sessions are bounded");
    }
    void try_code(const std::string& typed, const std::string& peer) {
        if (!accounts_.try_code(typed, peer, now_).right) return;
        require(there_is_a_code_ && plain_code(typed) == plain_code(code), "only the code is the code");
        accounts_.code_used();
        there_is_a_code_ = false;
    }
    void sign_in(const std::string& name, const std::string& peer) {
        const auto attempt = accounts_.begin_sign_in(name, peer, now_);
        if (attempt.pause_s != 0) return;
        require(!attempt.hash.empty(), "there is always something to compare with");
        const bool fits = in_.ConsumeBool() && attempt.hash == "hash of " + name;
        const auto session = accounts_.end_sign_in(name, attempt.hash, fits, peer, now_);
        require(!session || fits, "nobody comes in with a wrong password");
        if (!session) return;
        const User* u = accounts_.user(name);
        require(u && u->enabled && session->identity.user == name && session->identity.role == u->role, "and only as who he is");
        if (sessions_.size() < 64) sessions_.push_back(session->id);
    }
    void identify(const std::string& peer) {
        const std::string cookie = !sessions_.empty() && in_.ConsumeBool()
                                       ? sessions_[in_.ConsumeIntegralInRange<std::size_t>(0, sessions_.size() - 1)]
                                       : in_.ConsumeRandomLengthString(48);
        const std::string bearer = in_.ConsumeBool() ? "secret of anna" : in_.ConsumeRandomLengthString(48);
        Credentials c;
        c.peer = peer;
        c.forwarded = in_.ConsumeBool();
        if (in_.ConsumeBool()) c.cookies.push_back(cookie);
        if (in_.ConsumeBool()) c.bearer = bearer;
        const Identity who = accounts_.identify(c, now_, in_.ConsumeBool());
        switch (who.via) {
            case Identity::Via::none:
                require(who.role == Role::none, "nobody has no role");
                break;
            case Identity::Via::cookie: {
                const User* u = accounts_.user(who.user);
                require(!c.cookies.empty() && u && u->enabled && u->role == who.role, "a session is a user's that is there");
                require(std::ranges::find(sessions_, cookie) != sessions_.end() || sessions_.size() == 64, "and was opened by a sign-in");
                break;
            }
            case Identity::Via::token:
                require(c.bearer && (*c.bearer).starts_with("secret of "), "a token is one that was given");
                require(accounts_.user(who.user) != nullptr, "and has an owner");
                break;
            case Identity::Via::local:
                require(!c.forwarded && is_loopback_peer(peer), "local access is from this machine");
                require(!c.bearer && c.cookies.empty() ? who.role == accounts_.settings().local_role : true, "and has its role");
                break;
        }
    }

    FuzzedDataProvider& in_;
    AccessRegister accounts_{AccessSettings{}};
    std::int64_t now_ = 1'700'000'000'000'000'000;
    std::vector<std::string> sessions_;
    bool there_is_a_code_ = false;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0 || size > 8 * 1024) return 0;
    // Records as texts begin with a brace; other inputs are sequences of actions.
    if (data[0] == '{') return records({reinterpret_cast<const char*>(data), size}), 0;
    FuzzedDataProvider in(data, size);
    Run(in).run();
    return 0;
}
