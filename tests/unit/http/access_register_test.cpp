// The access register in virtual time: sessions, tokens, lockout, local access; and the rules for names and passwords.
#include <gtest/gtest.h>

#include "gateway/services/access/access_register.hpp"
#include "gateway/services/access/secrets.hpp"

namespace axisgate::http::test {
namespace {
constexpr std::int64_t s = 1'000'000'000;
constexpr std::int64_t t0 = 1'767'323'045 * s;
constexpr std::string_view peer = "192.0.2.7:5123";

AccessSettings small() {
    AccessSettings a;
    a.idle_ns = 600 * s;
    a.max_ns = 3600 * s;
    a.max_sessions = 3;
    a.max_sessions_per_user = 2;
    return a;
}
User person(std::string name, Role role) { return {std::move(name), role, true, "h", t0, 0}; }

struct AccessRegisterTest : ::testing::Test {
    AccessRegister access{small()};
    AccessRegisterTest() {
        access.load(person("anna", Role::administrator));
        access.load(person("ben", Role::viewer));
    }
    AccessRegister::NewSession in(std::string_view name, std::int64_t at) {
        const auto attempt = access.begin_sign_in(name, peer, at);
        EXPECT_EQ(attempt.pause_s, 0);
        auto session = access.end_sign_in(name, attempt.hash, true, peer, at);
        EXPECT_TRUE(session.has_value());
        return session.value_or(AccessRegister::NewSession{});
    }
    Identity by_cookie(std::string_view id, std::int64_t at) {
        Credentials c;
        c.cookies = {id};
        c.peer = peer;
        return access.identify(c, at);
    }
    Identity by_token(std::string_view secret, std::int64_t at) {
        Credentials c;
        c.bearer = secret;
        c.peer = "127.0.0.1:5";
        return access.identify(c, at);
    }
};

TEST_F(AccessRegisterTest, SessionIsTheUserWithHisRole) {
    const auto session = in("anna", t0);
    const auto i = by_cookie(session.id, t0 + s);
    EXPECT_EQ(i.via, Identity::Via::cookie);
    EXPECT_EQ(i.role, Role::administrator);
    EXPECT_EQ(i.csrf, session.identity.csrf);
    EXPECT_EQ(who(i, peer), "anna 192.0.2.7:5123");
    EXPECT_EQ(by_cookie(session.id + "x", t0 + s).role, Role::none);
    EXPECT_EQ(by_cookie(session.identity.session, t0 + s).role, Role::none) << "the digest is not the id";
}

TEST_F(AccessRegisterTest, IdleSessionEndsAndARequestKeepsItAwake) {
    const auto session = in("anna", t0);
    EXPECT_EQ(by_cookie(session.id, t0 + 599 * s).role, Role::administrator);
    EXPECT_EQ(by_cookie(session.id, t0 + 1198 * s).role, Role::administrator);
    EXPECT_EQ(by_cookie(session.id, t0 + 1798 * s).role, Role::none);
    EXPECT_EQ(access.sessions(), 0u);
}

TEST_F(AccessRegisterTest, ALookThatIsNotARequestDoesNotKeepItAwake) {
    const auto session = in("anna", t0);
    Credentials c;
    c.cookies = {session.id};
    c.peer = peer;
    EXPECT_EQ(access.identify(c, t0 + 599 * s, false).role, Role::administrator);
    EXPECT_EQ(by_cookie(session.id, t0 + 600 * s).role, Role::none);
}

TEST_F(AccessRegisterTest, SessionEndsAbsolutely) {
    const auto session = in("anna", t0);
    for (std::int64_t t = 0; t < 3600; t += 300)
        EXPECT_EQ(by_cookie(session.id, t0 + t * s).role, Role::administrator) << t;
    EXPECT_EQ(by_cookie(session.id, t0 + 3600 * s).role, Role::none);
}

TEST_F(AccessRegisterTest, SessionsAreBoundedPerUserAndInAll) {
    const auto first = in("anna", t0), second = in("anna", t0 + s), third = in("anna", t0 + 2 * s);
    EXPECT_EQ(by_cookie(first.id, t0 + 3 * s).role, Role::none);
    EXPECT_EQ(by_cookie(second.id, t0 + 4 * s).role, Role::administrator);
    (void)in("ben", t0 + 5 * s);
    (void)in("ben", t0 + 6 * s);
    EXPECT_EQ(access.sessions(), 3u);
    EXPECT_EQ(by_cookie(third.id, t0 + 7 * s).role, Role::none) << "the longest idle one of all went";
}

TEST_F(AccessRegisterTest, ChangingAUserEndsHisSessionsAlone) {
    for (int what = 0; what < 4; ++what) {
        const auto anna = in("anna", t0), ben = in("ben", t0);
        User u = *access.user("ben");
        if (what == 0) u.role = Role::engineer;
        if (what == 1) u.hash += "2";
        if (what == 2) u.enabled = false;
        if (what == 3) u.last_sign_in_ns = 5;
        access.put(u);
        EXPECT_EQ(by_cookie(ben.id, t0 + s).role, what == 3 ? u.role : Role::none) << what;
        EXPECT_EQ(by_cookie(anna.id, t0 + s).role, Role::administrator) << what;
        u.enabled = true;
        access.put(u);
    }
}

TEST_F(AccessRegisterTest, SignOutAndRemovalEndASession) {
    const auto anna = in("anna", t0);
    access.sign_out(anna.identity.session);
    EXPECT_EQ(by_cookie(anna.id, t0).role, Role::none);
    const auto ben = in("ben", t0);
    (void)access.remove_user("ben");
    EXPECT_EQ(by_cookie(ben.id, t0).role, Role::none);
}

TEST_F(AccessRegisterTest, TokenHasTheLowerOfItsRoleAndItsOwners) {
    Token t{"id1", "line3", "anna", Role::engineer, digest_of("secret"), t0, t0 + 100 * s, 0};
    access.put(t);
    const auto i = by_token("id1.secret", t0 + s);
    EXPECT_EQ(i.role, Role::engineer);
    EXPECT_EQ(who(i, peer), "token line3 (anna) 192.0.2.7:5123");
    auto uses = access.take_uses();
    ASSERT_EQ(uses.size(), 1u);
    EXPECT_EQ(uses[0].kind, "last_use");
    EXPECT_EQ(uses[0].name, "token id1");
    (void)by_token("id1.secret", t0 + 2 * s);
    EXPECT_FALSE(access.has_uses()) << "stored once an hour";
    User u = *access.user("anna");
    u.role = Role::viewer;
    access.put(u);
    EXPECT_EQ(by_token("id1.secret", t0 + s).role, Role::viewer);
}

TEST_F(AccessRegisterTest, WrongTokenIsNobodyEvenOnThisMachine) {
    access.put(Token{"id1", "line3", "anna", Role::engineer, digest_of("secret"), t0, t0 + 100 * s, 0});
    for (const auto* wrong : {"id1.secre", "id2.secret", "id1", "", ".", "id1.", "id1.secret.x"}) {
        const auto i = by_token(wrong, t0 + s);
        EXPECT_EQ(i.role, Role::none) << wrong;
        EXPECT_TRUE(i.wrong_token) << wrong;
    }
    EXPECT_EQ(by_token("id1.secret", t0 + 99 * s).role, Role::engineer);
    EXPECT_EQ(by_token("id1.secret", t0 + 100 * s).role, Role::none) << "expired";
    User u = *access.user("anna");
    u.enabled = false;
    access.put(u);
    EXPECT_EQ(by_token("id1.secret", t0 + s).role, Role::none) << "disabled owner";
    EXPECT_EQ(access.remove_user("anna"), std::vector<std::string>{"id1"});
    EXPECT_TRUE(access.tokens().empty());
}

TEST(LocalAccess, IsForThisMachineWithoutAProxyAlone) {
    struct {
        std::string_view peer;
        bool forwarded, let_in;
    } const table[]{{"127.0.0.1:5", false, true},
                    {"127.9.9.9:5", false, true},
                    {"[::1]:5", false, true},
                    {"[::ffff:127.0.0.1]:5", false, true},
                    {"127.0.0.1:5", true, false},
                    {"192.0.2.7:5", false, false},
                    {"[::2]:5", false, false},
                    {"[::ffff:192.0.2.7]:5", false, false},
                    {"128.0.0.1:5", false, false},
                    {"[2001:db8::127]:5", false, false},
                    {"", false, false}};
    for (const auto& row : table) {
        Credentials c;
        c.peer = row.peer;
        c.forwarded = row.forwarded;
        EXPECT_EQ(local_identity(c, Role::engineer).role, row.let_in ? Role::engineer : Role::none) << row.peer;
        EXPECT_EQ(local_identity(c, Role::none).via, Identity::Via::none);
    }
}

TEST_F(AccessRegisterTest, WhoGuessesNamesFromOneAddressIsHeldUpAndHisNeighbourIsNotAtOnce) {
    for (int n = 1; n <= Lockout::free_failures_of_peer; ++n) {
        EXPECT_EQ(access.begin_sign_in("anna", peer, t0).pause_s, 0) << "a neighbour's " << n - 1 << " wrong ones are not hers";
        access.attempt_was_good("anna", peer);
        EXPECT_EQ(access.begin_sign_in("guess" + std::to_string(n), peer, t0).pause_s, 0);
    }
    EXPECT_EQ(access.begin_sign_in("anna", peer, t0).pause_s, 1) << "but not without a bound";
    EXPECT_EQ(access.begin_sign_in("another", peer, t0).pause_s, 1);
    EXPECT_EQ(access.begin_sign_in("anna", "198.51.100.1:1", t0).pause_s, 0) << "from elsewhere";
}

TEST_F(AccessRegisterTest, WrongPasswordsCostAGrowingPause) {
    std::int64_t now = t0;
    for (int i = 0; i < Lockout::free_failures; ++i)
        EXPECT_EQ(access.begin_sign_in("ben", peer, now).pause_s, 0);
    for (const std::int64_t pause : {1, 2, 4, 8, 16, 32, 64, 128, 256, 300, 300}) {
        EXPECT_EQ(access.begin_sign_in("ben", "198.51.100.1:1", now).pause_s, 0) << "by user and address: nobody locks him out elsewhere";
        access.attempt_was_good("ben", "198.51.100.1:1");
        EXPECT_EQ(access.begin_sign_in("ben", peer, now + pause * s - 1).pause_s, 1);
        now += pause * s;
        EXPECT_EQ(access.begin_sign_in("ben", peer, now).pause_s, 0);
    }
}

TEST_F(AccessRegisterTest, WhoWasLetInFromAnAddressIsNotHeldUpByItsOtherPeople) {
    (void)in("anna", t0);
    for (int n = 0; n < 2 * Lockout::free_failures_of_peer; ++n)
        (void)access.begin_sign_in("guess" + std::to_string(n), peer, t0);
    EXPECT_EQ(access.begin_sign_in("ben", peer, t0).pause_s, 1);
    EXPECT_EQ(access.begin_sign_in("anna", peer, t0).pause_s, 0);
    EXPECT_EQ(access.begin_sign_in("anna", peer, t0).pause_s, 0);
    EXPECT_EQ(access.begin_sign_in("anna", peer, t0).pause_s, 0);
    EXPECT_EQ(access.begin_sign_in("anna", peer, t0).pause_s, 1) << "but her own wrong ones count there too";
    // The addresses of earlier sign-ins are known after a restart.
    AccessRegister again{small()};
    again.load(person("anna", Role::administrator));
    for (const auto& use : access.take_uses())
        again.load_use(use.name, *use.text);
    EXPECT_EQ(again.user("anna")->last_sign_in_ns, t0);
    for (int n = 0; n < 2 * Lockout::free_failures_of_peer; ++n)
        (void)again.begin_sign_in("guess" + std::to_string(n), peer, t0);
    EXPECT_EQ(again.begin_sign_in("anna", peer, t0).pause_s, 0);
}

TEST_F(AccessRegisterTest, ANetworkOfIPv6IsOnePlace) {
    for (int n = 0; n < Lockout::free_failures; ++n)
        EXPECT_EQ(access.begin_sign_in("ben", "[2001:db8:1:2::" + std::to_string(n + 1) + "]:5", t0).pause_s, 0);
    EXPECT_EQ(access.begin_sign_in("ben", "[2001:db8:1:2:ffff::9]:5", t0).pause_s, 1);
    EXPECT_EQ(access.begin_sign_in("ben", "[2001:db8:1:3::1]:5", t0).pause_s, 0);
    EXPECT_EQ(network_of("[::ffff:192.0.2.7]:5"), network_of("192.0.2.7:6"));
}

TEST_F(AccessRegisterTest, ARightPasswordClearsTheUserAndTakesOneBackFromThePeer) {
    (void)access.begin_sign_in("anna", peer, t0);
    (void)access.begin_sign_in("anna", peer, t0);
    (void)in("anna", t0);
    for (int n = 2; n < Lockout::free_failures_of_peer; ++n)
        EXPECT_EQ(access.begin_sign_in("guess" + std::to_string(n), peer, t0).pause_s, 0) << n;
    EXPECT_EQ(access.begin_sign_in("ben", peer, t0).pause_s, 1) << "the peer's two wrong ones still count, the right one does not";
    EXPECT_EQ(access.begin_sign_in("anna", "198.51.100.1:1", t0).pause_s, 0);
}

TEST_F(AccessRegisterTest, UnknownAndDisabledUsersCostAsMuchAsOthers) {
    EXPECT_EQ(access.begin_sign_in("nobody-here", peer, t0).hash, hash_of_nobody);
    User u = *access.user("ben");
    u.enabled = false;
    access.put(u);
    EXPECT_EQ(access.begin_sign_in("ben", peer, t0).hash, hash_of_nobody);
    EXPECT_FALSE(access.end_sign_in("ben", "h", true, peer, t0));
}

TEST_F(AccessRegisterTest, AHashThatWasChangedMeanwhileDoesNotSignIn) {
    const auto attempt = access.begin_sign_in("ben", peer, t0);
    User u = *access.user("ben");
    u.hash = "new";
    access.put(u);
    EXPECT_FALSE(access.end_sign_in("ben", attempt.hash, true, peer, t0));
}

TEST(LockoutTable, IsBoundedAndForgets) {
    Lockout l;
    for (std::size_t i = 0; i < Lockout::max_keys + 100; ++i)
        l.failed("peer " + std::to_string(i), t0 + static_cast<std::int64_t>(i));
    EXPECT_EQ(l.size(), Lockout::max_keys);
    for (int i = 0; i < 10; ++i)
        l.failed("user a", t0);
    EXPECT_GT(l.pause_s("user a", t0 + s), 0);
    EXPECT_EQ(l.pause_s("user a", t0 + (Lockout::forgotten_s + 1) * s), 0);
    EXPECT_LE(l.pause_s("user a", t0 - 100'000 * s), Lockout::max_pause_s) << "the clock was set back";
}

TEST_F(AccessRegisterTest, LastAdministratorIsKnown) {
    EXPECT_TRUE(access.is_last_administrator("anna"));
    EXPECT_FALSE(access.is_last_administrator("ben"));
    User u = person("cleo", Role::administrator);
    u.enabled = false;
    access.put(u);
    EXPECT_TRUE(access.is_last_administrator("anna")) << "a disabled one does not count";
    u.enabled = true;
    access.put(u);
    EXPECT_FALSE(access.is_last_administrator("anna"));
}

TEST_F(AccessRegisterTest, FirstCodeIsTakenAsItIsTypedAndWrongOnesArePaused) {
    const std::string code = random_code();
    EXPECT_EQ(code.size(), 19u);
    access.load_code(digest_of(plain_code(code)));
    std::string typed = code;
    for (auto& c : typed)
        c = c == '-' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    EXPECT_TRUE(access.try_code(typed, peer, t0).right);
    for (int i = 0; i < 3; ++i)
        EXPECT_FALSE(access.try_code("0000-0000-0000-0000", peer, t0).right);
    EXPECT_EQ(access.try_code(code, peer, t0).pause_s, 1);
    EXPECT_TRUE(access.try_code(code, peer, t0 + s).right);
    access.code_used();
    EXPECT_FALSE(access.try_code(code, "198.51.100.1:1", t0).right);
    EXPECT_FALSE(access.try_code("", "198.51.100.2:1", t0).right);
}

TEST(Records, ComeBackAsTheyWere) {
    const User u{"anna", Role::operating, false, "h", 5, 6};
    const auto back = user_of(*record_of(u).text);
    ASSERT_TRUE(back);
    EXPECT_EQ(record_of(*back).text, record_of(u).text);
    EXPECT_FALSE(back->enabled);
    const Token t{"i", "n", "anna", Role::viewer, "d", 1, 2, 3};
    const auto token = token_of(*record_of(t).text);
    ASSERT_TRUE(token);
    EXPECT_EQ(record_of(*token).text, record_of(t).text);
    AccessRegister access{AccessSettings{}};
    for (const auto* bad : {"", "[]", "{", R"({"at_ns":"x","good_from":7})", R"({"good_from":[1,null]})"}) {
        access.load_use("user anna", bad);
        access.load_use("token i", bad);
        access.load_use("nonsense", bad);
    }
    EXPECT_FALSE(access.has_users()) << "a use brings nobody back";
    EXPECT_TRUE(access.tokens().empty());
    EXPECT_EQ(code_of(*record_of_code("abc").text), "abc");
    for (const auto* bad : {"", "[]", "{", "{}", R"({"name":"a","role":"king","hash":"h"})", R"({"name":"a","role":"none","hash":"h"})",
                            R"({"name":"","role":"viewer","hash":"h"})"})
        EXPECT_FALSE(user_of(bad)) << bad;
}

TEST(Passwords, RulesAreKept) {
    struct {
        std::string password;
        bool good;
    } const table[]{{"correct-horse-9", true},    {"short-one-1", false},     {std::string(257, 'x') + "abcdefgh", false},
                    {"password1234", false},      {"PassWord1234", false},    {"aaaaaaaaaaaaaaaa", false},
                    {"123456789012", false},      {"abcdefghijklm", false},   {"anna-anna-1", false},
                    {"annaanna1234", true},       {"anna1234567", false},     {"\xff\xfe\xfd-not-utf8-text", false},
                    {"Werkstatt im Süden", true}, {"changemechangeme", false}};
    for (const auto& row : table)
        EXPECT_EQ(password_fault(row.password, "anna").empty(), row.good) << row.password;
    for (const auto* good : {"anna", "anna.b", "a@b.de", "x"})
        EXPECT_EQ(user_name_fault(good), "") << good;
    for (const auto* bad : {"", "Anna", "a b", "local", "token", "a\n", "ä", "a/b"})
        EXPECT_NE(user_name_fault(bad), "") << bad;
}

TEST(Secrets, HashesAreArgon2idAndNobodysHashCostsTheSame) {
    const std::string hash = derive_password("correct-horse-9");
    EXPECT_TRUE(hash.starts_with("$argon2id$v=19$m=65536,t=2,p=1$")) << hash;
    EXPECT_TRUE(std::string(hash_of_nobody).starts_with(hash.substr(0, hash.find("p=1$") + 4)));
    EXPECT_EQ(hash_of_nobody.size(), hash.size());
    EXPECT_TRUE(password_fits("correct-horse-9", hash));
    EXPECT_FALSE(password_fits("correct-horse-8", hash));
    EXPECT_FALSE(password_fits("", std::string(hash_of_nobody)));
    EXPECT_FALSE(password_fits("x", ""));
    EXPECT_NE(random_secret(), random_secret());
    EXPECT_EQ(random_secret().size(), 43u);
}
}  // namespace
}  // namespace axisgate::http::test
