// Each role against each route of the table, so that a new route is covered at once; and the handlers of sessions, users and tokens.
#include "gateway/services/access/secrets.hpp"
#include "tests/unit/http/fake_access.hpp"
#include "tests/unit/http/harness.hpp"

#include <set>

namespace axisgate::http::test {
namespace {
constexpr std::string_view faraway_peer = "192.0.2.7:5123";
using Fields = std::vector<std::pair<std::string, std::string>>;

class AccessTest : public ::testing::Test, public Harness {
protected:
    std::shared_ptr<FakeAccess> access = std::make_shared<FakeAccess>();
    Router door = with_users(access);
    AccessTest() {
        for (const auto* role : {"viewer", "operator", "engineer", "administrator"})
            access->own_accounts.load(User{role, *role_named(role), true, std::string("hash of secret ") + role, 1, 0});
    }
    /// Like Harness::send, at a door with users; the fake answers inside the call.
    Answer send(const Request& r) {
        std::optional<Response> late;
        auto handled = door.handle(r, [&late](Response x) { late = std::move(x); });
        if (handled.now) return answer_from(std::move(*handled.now));
        return late ? answer_from(std::move(*late)) : Answer{};
    }
    Answer from(std::string_view peer, std::string_view method, std::string target, std::string body = {}, Fields headers = {}) {
        Request r = request(method, std::move(target), std::move(body), std::move(headers));
        r.peer = std::string(peer);
        return send(r);
    }
    /// Cookie and X-CSRF-Token of a fresh session; none for "none".
    Fields as(std::string_view role) {
        if (role == "none") return {};
        const auto a = from(faraway_peer, "POST", "/api/v1/session",
                            R"({"user":")" + std::string(role) + R"(","password":"secret )" + std::string(role) + R"("})");
        EXPECT_EQ(a.status, 200u) << role << a.text;
        const std::string cookie(a.headers.get("Set-Cookie"));
        return {{"Cookie", cookie.substr(0, cookie.find(';'))}, {"X-CSRF-Token", a.at("csrf")}};
    }
};

std::string with_names(std::string_view path) {
    std::string out;
    for (std::size_t i = 0; i < path.size(); ++i) {
        if (path[i] != '{') {
            out += path[i];
            continue;
        }
        out += "nothing-of-this-name";
        i = path.find('}', i);
    }
    return out;
}

TEST_F(AccessTest, EachRoleAgainstEachRoute) {
    int checked = 0;
    for (const auto& route : all_routes()) {
        for (const auto* role : {"none", "viewer", "operator", "engineer", "administrator"}) {
            Fields headers = as(role);  // made anew each time, because one of the routes signs out
            std::string body;
            if (route.takes == Route::Takes::csv) {
                headers.emplace_back("Content-Type", "text/csv");
                body = "x\n";
            } else if (route.takes != Route::Takes::nothing) {
                body = "{}";
            }
            const auto a = from(faraway_peer, name_of(route.method), with_names(route.path), body, headers);
            const bool may = *role_named(role) >= route.needed();
            const std::string what = std::string(name_of(route.method)) + " " + std::string(route.path) + " as " + role + ": " + a.text;
            ++checked;
            if (may) {
                // Restrictions that a handler makes by its body or its owner have tests of their own.
                const bool refines = route.handler == take<change_password> || route.handler == take<add_token> ||
                                     route.handler == take<command_axis> || route.handler == take<command_fleet_axis>;
                if (!refines) EXPECT_TRUE(a.status != 401 && a.status != 403) << what;
                EXPECT_NE(a.at("reason"), "sign_in") << what;
                EXPECT_NE(a.at("reason"), "csrf") << what;
            } else {
                EXPECT_EQ(a.status, std::string_view(role) == "none" ? 401u : 403u) << what;
                EXPECT_EQ(a.at("reason"), std::string_view(role) == "none" ? "sign_in" : "role") << what;
                if (a.status == 401) EXPECT_TRUE(a.headers.get("WWW-Authenticate").starts_with("Bearer")) << what;
                if (a.status == 403) EXPECT_NE(a.at("detail").find(name_of(route.needed())), std::string::npos) << what;
            }
        }
    }
    EXPECT_EQ(checked, 5 * static_cast<int>(all_routes().size()));
    EXPECT_TRUE(gateway.submitted.empty());
}

TEST_F(AccessTest, ABackupThatCannotBeKeptIsNotCalledABadOne) {
    Fields headers = as("administrator");
    headers.emplace_back("Content-Type", "application/octet-stream");
    ASSERT_EQ(from(faraway_peer, "GET", "/api/v1/backup", "", headers).status, 200u);
    ASSERT_EQ(gateway.noted.size(), 1u) << "that all of it left the house is told";
    EXPECT_EQ(gateway.noted[0].kind, "site");
    EXPECT_NE(gateway.noted[0].text.find("the whole database"), std::string::npos) << gateway.noted[0].text;
    EXPECT_NE(gateway.noted[0].who.find("administrator"), std::string::npos);
    EXPECT_EQ(gateway.noted[0].door, "http");
    EXPECT_EQ(from(faraway_peer, "HEAD", "/api/v1/backup", "", headers).status, 200u);
    EXPECT_EQ(gateway.noted.size(), 1u) << "HEAD hands nothing out";
    const auto put = [&] { return from(faraway_peer, "PUT", "/api/v1/backup", std::string("SQLite format 3\0...", 19), headers); };
    EXPECT_EQ(put().status, 202u);
    gateway.keep_fault = "the file is damaged";
    EXPECT_EQ(put().status, 422u);
    gateway.no_room = true;
    gateway.keep_fault = "there is no room for it";
    const auto full = put();
    EXPECT_EQ(full.status, 507u);
    EXPECT_NE(full.text.find("there is no room"), std::string::npos);
}

TEST_F(AccessTest, TheBackupsPassphraseComesInAHeaderOfItsOwn) {
    Fields headers = as("administrator");
    headers.emplace_back("Content-Type", "application/octet-stream");
    headers.emplace_back("X-Backup-Passphrase", "");
    const auto with = [&](const char* value, const char* method) {
        headers.back().second = value;
        return from(faraway_peer, method, "/api/v1/backup", std::string_view(method) == "PUT" ? "a backup" : "", headers);
    };
    const auto sealed = with("x%20y%C3%A4", "GET");
    EXPECT_EQ(sealed.status, 200u);
    EXPECT_EQ(gateway.passphrase, "x y\xC3\xA4");
    EXPECT_NE(gateway.noted.at(0).text.find("sealed"), std::string::npos);
    EXPECT_EQ(gateway.noted[0].text.find("x y"), std::string::npos) << "it is told to nobody";
    EXPECT_EQ(with("", "GET").status, 200u);
    EXPECT_EQ(gateway.passphrase, "");
    EXPECT_NE(gateway.noted.at(1).text.find("in the open"), std::string::npos);
    EXPECT_EQ(with("unfit", "GET").status, 422u);
    EXPECT_EQ(with("50%", "GET").status, 422u);
    EXPECT_EQ(with("50%", "PUT").status, 422u);
    EXPECT_EQ(gateway.noted.size(), 2u);
    EXPECT_EQ(gateway.restored, "");
    EXPECT_EQ(with("x%2Fy", "PUT").status, 202u);
    EXPECT_EQ(gateway.passphrase, "x/y");
    EXPECT_EQ(gateway.restored, "a backup");
}

/// The connection's check before it reads a body: the same refusal as with the body, without any change.
TEST_F(AccessTest, EachRouteWithABodyRefusesBeforeItIsRead) {
    int with_body = 0, refused = 0;
    for (const auto& route : all_routes()) {
        if (route.takes == Route::Takes::nothing) continue;
        ++with_body;
        for (const auto* role : {"none", "viewer", "operator", "engineer", "administrator"}) {
            const std::string what = std::string(name_of(route.method)) + " " + std::string(route.path) + " as " + role;
            Fields headers = as(role);
            headers.emplace_back("Content-Type", route.takes == Route::Takes::csv     ? "text/csv"
                                                 : route.takes == Route::Takes::bytes ? "application/octet-stream"
                                                                                      : "application/json");
            Request head = request(name_of(route.method), with_names(route.path), {}, headers);
            head.peer = std::string(faraway_peer);
            const bool unknown = std::string_view(role) == "none";  // a sign-in has a short body
            head.announced_bytes = unknown ? 8'000 : 1'000'000;
            const auto a = door.admit(head);
            if (*role_named(role) >= route.needed()) {
                EXPECT_FALSE(a.refusal) << what << a.refusal->body;
                EXPECT_EQ(a.max_body_bytes, unknown                              ? settings.max_stranger_bytes
                                            : route.takes == Route::Takes::bytes ? settings.max_backup_bytes
                                                                                 : settings.max_body_bytes)
                    << what;
                head.announced_bytes = a.max_body_bytes + 1;
                const auto over = door.admit(head);
                ASSERT_TRUE(over.refusal) << what;
                EXPECT_EQ(over.refusal->status, 413u) << what;
                continue;
            }
            ++refused;
            ASSERT_TRUE(a.refusal) << what;
            EXPECT_EQ(a.refusal->status, std::string_view(role) == "none" ? 401u : 403u) << what;
            EXPECT_EQ(a.refusal->headers.get("Content-Type"), "application/problem+json") << what;
            EXPECT_EQ(a.refusal->body, from(faraway_peer, name_of(route.method), with_names(route.path), "{}", headers).text) << what;
        }
    }
    EXPECT_GE(with_body, 40);
    EXPECT_GE(refused, with_body) << "nobody at least is refused nearly everywhere";
}

TEST_F(AccessTest, AdmittingRenewsNoSession) {
    const auto headers = as("engineer");
    Request head = request("PUT", "/api/v1/site", {}, headers);
    head.headers.set("Content-Type", "application/json");
    head.peer = std::string(faraway_peer);
    const std::int64_t idle_ns = AccessSettings{}.idle_ns, second_ns = 1'000'000'000;
    gateway.now_ns += idle_ns - second_ns;
    EXPECT_FALSE(door.admit(head).refusal);
    gateway.now_ns += 2 * second_ns;
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/axes", "", headers).status, 401u) << "asking whether one may is no use of the session";
}

TEST_F(AccessTest, OpenRoutesAreTheseAlone) {
    std::set<std::string> open;
    for (const auto& r : all_routes()) {
        if (r.needed() == Role::none) open.insert(std::string(name_of(r.method)) + " " + std::string(r.path));
        if (r.method != Method::get && r.needed() == Role::viewer) {
            EXPECT_TRUE(r.handler == take<command_axis> || r.handler == take<command_fleet_axis> || r.handler == take<change_password> ||
                        r.handler == take<add_token> || r.handler == take<remove_token>)
                << r.path;
        }
    }
    EXPECT_EQ(open, (std::set<std::string>{"GET /healthz", "GET /readyz", "GET /api/v1/openapi.yaml", "GET /api/v1/session",
                                           "POST /api/v1/session", "DELETE /api/v1/session", "POST /api/v1/session/first"}));
}

TEST_F(AccessTest, WhetherItIsReadyIsForEverybodyAndTheNamesAreForWhoIsKnown) {
    gateway.missing = {"line press-7 is down", "drive secret-feeder does not answer"};
    const auto stranger = from(faraway_peer, "GET", "/readyz", "", as("none"));
    EXPECT_EQ(stranger.status, 503u);
    EXPECT_EQ(stranger.text.find("press-7"), std::string::npos) << stranger.text;
    EXPECT_EQ(stranger.text.find("secret-feeder"), std::string::npos) << stranger.text;
    EXPECT_EQ(stranger.object().at("missing").get_array().size(), 1u);
    EXPECT_NE(stranger.at("detail").find("2 things are missing"), std::string::npos) << stranger.text;
    const auto known = from(faraway_peer, "GET", "/readyz", "", as("viewer"));
    EXPECT_EQ(known.status, 503u);
    EXPECT_NE(known.text.find("press-7"), std::string::npos) << known.text;
    EXPECT_EQ(known.object().at("missing").get_array().size(), 2u);
}

TEST_F(AccessTest, EverybodyWhoIsKnownMayStopAndOperatorsMayMove) {
    gateway.at_once = [](const Command&) { return good_result(); };
    for (const auto* role : {"none", "viewer", "operator", "engineer"}) {
        const auto headers = as(role);
        for (const auto* word : {"halt", "quick_stop", "disable", "enable", "home", "reset_fault"}) {
            const bool stops = std::string_view(word) == "halt" || std::string_view(word) == "quick_stop";
            const auto a =
                from(faraway_peer, "POST", "/api/v1/axes/feeder/commands", R"({"command":")" + std::string(word) + "\"}", headers);
            const Role r = *role_named(role);
            const unsigned wanted = r == Role::none ? 401 : r == Role::viewer && !stops ? 403 : 200;
            const auto over_fleet = from(faraway_peer, "POST", "/api/v1/fleet/hall-2/axes/feeder/commands",
                                         R"({"command":")" + std::string(word) + "\"}", headers);
            EXPECT_EQ(over_fleet.status, wanted) << word << " over the fleet as " << role << over_fleet.text;
            EXPECT_EQ(a.status, wanted) << role << " " << word << a.text;
        }
    }
}

TEST_F(AccessTest, AChangeOverACookieNeedsItsToken) {
    auto headers = as("engineer");
    const auto good = headers.back().second;
    for (const std::string& token : {std::string(), std::string("x"), good + "x", good.substr(1)}) {
        headers.back().second = token;
        EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/axes/feeder/commands", R"({"command":"halt"})", headers).at("reason"), "csrf")
            << token;
        EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/session", "", headers).at("reason"), "csrf");
        EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/axes", "", headers).status, 200u) << "a read needs none";
    }
    headers.pop_back();
    EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/session", "", headers).status, 403u);
    EXPECT_TRUE(gateway.submitted.empty());
}

TEST_F(AccessTest, WhoseSessionHasEndedIsNotThisMachine) {
    auto headers = as("viewer");
    ASSERT_EQ(from("127.0.0.1:5", "PUT", "/api/v1/site", "{}", headers).status, 403u) << "a viewer, also on this machine";
    ASSERT_EQ(from(faraway_peer, "DELETE", "/api/v1/session", "", headers).status, 204u);
    const auto expires = [](const Answer& a) {
        const auto cookie = a.headers.get("Set-Cookie");
        return cookie.starts_with("axisgate_session=;") && cookie.find("Max-Age=0") != std::string_view::npos;
    };
    for (const auto& [method, target] :
         {std::pair{"GET", "/api/v1/axes"}, {"PUT", "/api/v1/site"}, {"GET", "/api/v1/stream"}, {"GET", "/metrics"}}) {
        const auto a = from("127.0.0.1:5", method, target, std::string_view(method) == "PUT" ? "{}" : "", headers);
        EXPECT_EQ(a.status, 401u) << target << a.text;
        EXPECT_EQ(a.at("type"), "urn:axisgate:problem:session_ended") << target;
        EXPECT_TRUE(expires(a)) << target << a.headers.get("Set-Cookie");
    }
    Request watching = request("GET", "/api/v1/stream", {}, headers);
    EXPECT_EQ(door.why_not_watched_on(watching), "signed out") << "a live feed does not go on as this machine";
    const auto session = from("127.0.0.1:5", "GET", "/api/v1/session", "", headers);
    EXPECT_EQ(session.status, 200u);
    EXPECT_EQ(session.at("via"), "none");
    EXPECT_NE(session.at("ended").find("has ended"), std::string::npos) << session.text;
    EXPECT_TRUE(expires(session));
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/", "", headers).at("reason"), "not_found") << "the page's files ask nobody (this door has none)";
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/healthz", "", headers).status, 200u);
    EXPECT_TRUE(expires(from("127.0.0.1:5", "DELETE", "/api/v1/session", "", headers)));
    EXPECT_EQ(from("127.0.0.1:5", "POST", "/api/v1/session", R"({"user":"viewer","password":"secret viewer"})", headers).status, 200u);
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/axes", "", {{"Cookie", "axisgate_session=; other=1"}}).at("reason"), "session_ended");
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/axes", "", {{"Cookie", "other=1"}}).status, 200u)
        << "no session cookie at all: this machine";
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/session").at("ended"), "null");
}

TEST_F(AccessTest, NobodyConfirmsWhatAnotherApplied) {
    const std::string site = R"({"lines":[],"drives":[],"axes":[],"mappings":[]})";
    ASSERT_EQ(from("127.0.0.1:5", "POST", "/api/v1/site/stage", site).status, 200u);
    ASSERT_EQ(from("127.0.0.1:5", "POST", "/api/v1/site/stage/apply", "{}").status, 200u);
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/site/stage/confirm", "", as("engineer")).status, 409u);
    EXPECT_EQ(from("127.0.0.1:5", "POST", "/api/v1/site/stage/confirm", "", {{"X-Client", "other"}}).status, 409u);
    const auto administrator = from(faraway_peer, "POST", "/api/v1/site/stage/confirm", "", as("administrator"));
    EXPECT_EQ(administrator.status, 409u) << "nor does an administrator from elsewhere";
    EXPECT_NE(administrator.at("detail").find("local 127.0.0.1"), std::string::npos);
    EXPECT_EQ(gateway.confirmed_by, "");
    EXPECT_EQ(from("127.0.0.1:7", "POST", "/api/v1/site/stage/confirm").status, 200u) << "another port is the same one";
}

TEST_F(AccessTest, WhoAppliedConfirmsInTheSameSession) {
    const std::string site = R"({"lines":[],"drives":[],"axes":[],"mappings":[]})";
    const auto first = as("engineer"), second = as("engineer");
    ASSERT_NE(first, second) << "signed in twice";
    ASSERT_EQ(from(faraway_peer, "POST", "/api/v1/site/stage", site, first).status, 200u);
    ASSERT_EQ(from(faraway_peer, "POST", "/api/v1/site/stage/apply", "{}", first).status, 200u);
    const auto other = from(faraway_peer, "POST", "/api/v1/site/stage/confirm", "", second);
    EXPECT_EQ(other.status, 409u) << "the same user, another session: " << other.text;
    EXPECT_NE(other.text.find("same session"), std::string::npos) << other.text;
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/site/stage/confirm", "", first).status, 200u);
}

TEST_F(AccessTest, LocalAccessIsAnEngineerAndAProxyIsNot) {
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/session").at("via"), "local");
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/session").at("role"), "engineer");
    for (const auto* header : {"Forwarded", "X-Forwarded-For", "x-forwarded-proto", "Via", "X-Real-IP"})
        EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/axes", "", {{header, "x"}}).status, 401u) << header;
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/axes", "", {{"Authorization", "Bearer nonsense"}}).at("reason"), "wrong_token");
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/axes", "", {{"Authorization", "Basic YTpi"}}).status, 401u);
    EXPECT_EQ(from("127.0.0.1:5", "GET", "/api/v1/users").status, 403u);
}

TEST_F(AccessTest, WhoIsToldWithEveryCommand) {
    gateway.at_once = [](const Command&) { return good_result(); };
    (void)from(faraway_peer, "POST", "/api/v1/axes/feeder/commands", R"({"command":"halt"})", as("viewer"));
    EXPECT_EQ(*gateway.submitted.back().origin.who, "viewer 192.0.2.7:5123");
    (void)from("127.0.0.1:5", "POST", "/api/v1/axes/feeder/commands", R"({"command":"halt"})");
    EXPECT_EQ(*gateway.submitted.back().origin.who, "local 127.0.0.1:5");
}

TEST_F(AccessTest, WrongUserAndWrongPasswordLookAlikeAndAreCompared) {
    const auto a = from(faraway_peer, "POST", "/api/v1/session", R"({"user":"viewer","password":"x"})");
    const auto b = from("192.0.2.8:1", "POST", "/api/v1/session", R"({"user":"nobody9","password":"x"})");
    EXPECT_EQ(a.status, 401u);
    EXPECT_EQ(a.text, b.text);
    EXPECT_EQ(access->compared, 2) << "an unknown user costs a hash too";
    ASSERT_EQ(access->published.size(), 2u);
    EXPECT_EQ(access->published[0].kind, "access");
    EXPECT_EQ(access->published[0].text, "sign-in refused: viewer");
    (void)from("192.0.2.9:1", "POST", "/api/v1/session", R"({"user":"My Secret Password","password":"x"})");
    EXPECT_EQ(access->published.back().text.find("secret"), std::string::npos) << access->published.back().text;
}

TEST_F(AccessTest, LockoutAnswersHowLong) {
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/session", R"({"user":"viewer","password":"x"})").status, 401u);
    const auto a = from(faraway_peer, "POST", "/api/v1/session", R"({"user":"viewer","password":"secret viewer"})");
    EXPECT_EQ(a.status, 429u) << "also the right password waits";
    EXPECT_EQ(a.headers.get("Retry-After"), "1");
    gateway.now_ns += 1'000'000'000;
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/session", R"({"user":"viewer","password":"secret viewer"})").status, 200u);
}

TEST_F(AccessTest, CookieIsGuardedAndSecureOverTls) {
    Request r = request("POST", "/api/v1/session", R"({"user":"viewer","password":"secret viewer"})");
    r.peer = std::string(faraway_peer);
    auto cookie = std::string(send(r).headers.get("Set-Cookie"));
    EXPECT_NE(cookie.find("; HttpOnly; SameSite=Strict; Path=/"), std::string::npos) << cookie;
    EXPECT_EQ(cookie.find("Secure"), std::string::npos);
    r.secure = true;
    cookie = send(r).headers.get("Set-Cookie");
    EXPECT_NE(cookie.find("; Secure"), std::string::npos) << cookie;
}

TEST_F(AccessTest, SignOutEndsTheSession) {
    const auto headers = as("viewer");
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/axes", "", headers).status, 200u);
    const auto a = from(faraway_peer, "DELETE", "/api/v1/session", "", headers);
    EXPECT_EQ(a.status, 204u);
    EXPECT_NE(a.headers.get("Set-Cookie").find("Max-Age=0"), std::string_view::npos);
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/axes", "", headers).status, 401u);
}

TEST_F(AccessTest, FirstSignInIsOnceAndNeedsTheCode) {
    const std::string body = R"({"code":"abcd-0000","user":"Eva","password":"correct-horse-9"})";
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/session/first", body).status, 409u);
    access->own_accounts = AccessRegister{AccessSettings{}};
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/session/first", body).status, 401u);
    access->own_accounts.load_code(digest_of(plain_code("ABCD-0000")));
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/session/first", R"({"code":"abcd-0000","user":"Eva","password":"short"})").status, 422u);
    access->store_fault = "the disk is full";
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/session/first", body).status, 507u);
    access->store_fault.clear();
    const auto a = from(faraway_peer, "POST", "/api/v1/session/first", body);
    EXPECT_EQ(a.status, 200u) << a.text;
    EXPECT_EQ(a.at("user"), "eva");
    EXPECT_EQ(a.at("role"), "administrator");
    EXPECT_EQ(from("192.0.2.8:1", "POST", "/api/v1/session/first", body).status, 409u);
}

TEST_F(AccessTest, UsersAreMadeChangedAndRemovedByAdministrators) {
    const auto admin = as("administrator");
    const auto make =
        from(faraway_peer, "POST", "/api/v1/users", R"({"name":"Ben","password":"a-long-sentence-1","role":"operator"})", admin);
    ASSERT_EQ(make.status, 201u) << make.text;
    EXPECT_EQ(make.at("name"), "ben");
    EXPECT_EQ(make.headers.get("Location"), "/api/v1/users/ben");
    EXPECT_EQ(access->kept.back().name, "ben");
    EXPECT_EQ(access->kept.back().text->find("a-long-sentence-1\""), access->kept.back().text->find("hash of ") + 8) << "the fake's hash";
    EXPECT_EQ(make.text.find("hash"), std::string::npos);
    EXPECT_EQ(
        from(faraway_peer, "POST", "/api/v1/users", R"({"name":"ben","password":"a-long-sentence-1","role":"operator"})", admin).status,
        409u);
    const auto wrong = from(faraway_peer, "POST", "/api/v1/users", R"({"name":"x y","password":"short","role":"king","more":1})", admin);
    EXPECT_EQ(wrong.status, 422u);
    EXPECT_EQ(wrong.object().at("faults").get_array().size(), 4u);
    EXPECT_EQ(from(faraway_peer, "PATCH", "/api/v1/users/ben", R"({"role":"engineer"})", admin).at("role"), "engineer");
    EXPECT_EQ(from(faraway_peer, "PATCH", "/api/v1/users/administrator", R"({"role":"viewer"})", admin).status, 409u);
    EXPECT_EQ(from(faraway_peer, "PATCH", "/api/v1/users/administrator", R"({"enabled":false})", admin).status, 409u);
    EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/users/administrator", "", admin).status, 409u);
    access->store_fault = "the disk is full";
    EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/users/ben", "", admin).status, 507u);
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/users/ben", "", admin).status, 200u) << "not stored, not in force";
    access->store_fault.clear();
    EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/users/ben", "", admin).status, 204u);
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/users/ben", "", admin).status, 404u);
    access->full = true;
    EXPECT_EQ(
        from(faraway_peer, "POST", "/api/v1/users", R"({"name":"cleo","password":"a-long-sentence-1","role":"viewer"})", admin).status,
        503u);
}

TEST_F(AccessTest, OnesOwnPasswordNeedsTheOldOne) {
    const auto viewer = as("viewer");
    EXPECT_EQ(from(faraway_peer, "PUT", "/api/v1/users/engineer/password", R"({"old":"secret engineer","new":"a-long-sentence-1"})", viewer)
                  .status,
              403u);
    EXPECT_EQ(from(faraway_peer, "PUT", "/api/v1/users/viewer/password", R"({"old":"wrong","new":"a-long-sentence-1"})", viewer).status,
              403u);
    EXPECT_EQ(from(faraway_peer, "PUT", "/api/v1/users/viewer/password", R"({"old":"secret viewer","new":"short"})", viewer).status, 422u);
    EXPECT_EQ(
        from(faraway_peer, "PUT", "/api/v1/users/viewer/password", R"({"old":"secret viewer","new":"a-long-sentence-1"})", viewer).status,
        204u);
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/axes", "", viewer).status, 401u) << "his sessions ended";
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/session", R"({"user":"viewer","password":"a-long-sentence-1"})").status, 200u);
}

TEST_F(AccessTest, TokensAreShownOnceAndNotAboveTheirOwner) {
    const auto engineer = as("engineer");
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/tokens", R"({"name":"line3","role":"administrator"})", engineer).status, 403u);
    EXPECT_EQ(from("127.0.0.1:5", "POST", "/api/v1/tokens", R"({"name":"line3","role":"viewer"})").status, 403u)
        << "local access is no user";
    const auto made = from(faraway_peer, "POST", "/api/v1/tokens", R"({"name":"line3","role":"operator","expires_in_s":60})", engineer);
    ASSERT_EQ(made.status, 201u) << made.text;
    const Fields bearer{{"Authorization", "Bearer " + made.at("token")}};
    const std::string secret = made.at("token").substr(made.at("token").find('.') + 1);
    EXPECT_EQ(access->kept.back().text->find(secret), std::string::npos) << "stored as a digest";
    for (const auto& e : access->published)
        EXPECT_EQ(e.text.find(secret), std::string::npos);
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/session", "", bearer).at("role"), "operator");
    EXPECT_EQ(from(faraway_peer, "POST", "/api/v1/tokens", R"({"name":"x","role":"viewer"})", bearer).status, 403u)
        << "a token makes no tokens";
    const auto list = from(faraway_peer, "GET", "/api/v1/tokens", "", engineer);
    EXPECT_EQ(list.array().size(), 1u);
    EXPECT_EQ(list.text.find(secret), std::string::npos);
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/tokens", "", as("viewer")).array().size(), 0u);
    EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/tokens/" + made.at("id"), "", as("viewer")).status, 404u);
    gateway.now_ns += 60'000'000'000;
    EXPECT_EQ(from(faraway_peer, "GET", "/api/v1/axes", "", bearer).status, 401u) << "expired";
    EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/tokens/" + made.at("id"), "", as("administrator")).status, 204u);
    EXPECT_TRUE(access->own_accounts.tokens().empty());
}

TEST_F(AccessTest, LiveFeedIsOverWhenItsSessionIs) {
    const auto headers = as("viewer");
    Request r = request("GET", "/api/v1/stream", "", headers);
    r.peer = std::string(faraway_peer);
    EXPECT_EQ(door.why_not_watched_on(r), "");
    EXPECT_EQ(from(faraway_peer, "DELETE", "/api/v1/session", "", headers).status, 204u);
    EXPECT_EQ(door.why_not_watched_on(r), "signed out");
    // A token is not signed out: it ends.
    const auto made = from(faraway_peer, "POST", "/api/v1/tokens", R"({"name":"feed","role":"viewer","expires_in_s":60})", as("viewer"));
    Request by_token = request("GET", "/api/v1/stream", "", {{"Authorization", "Bearer " + made.at("token")}});
    by_token.peer = std::string(faraway_peer);
    EXPECT_EQ(door.why_not_watched_on(by_token), "");
    gateway.now_ns += 60'000'000'000;
    EXPECT_EQ(door.why_not_watched_on(by_token), "the token has expired or was removed");
}
}  // namespace
}  // namespace axisgate::http::test
