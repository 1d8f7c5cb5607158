// The order in which users and tokens are stored: a last use on its way never restores a revoked account; and the queue itself. The test
// compares the content of the store after a crash at any moment.
#include "gateway/services/access/secrets.hpp"
#include "tests/unit/http/fake_access.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
constexpr std::string_view far_peer = "192.0.2.7:5123";

class AccessQueueTest : public ::testing::Test, public Harness {
protected:
    std::shared_ptr<FakeAccess> access = std::make_shared<FakeAccess>();
    Router door = with_users(access);
    std::vector<std::pair<std::string, std::string>> admin;

    AccessQueueTest() {
        for (const auto* role : {"viewer", "administrator"})
            access->own_accounts.load(User{role, *role_named(role), true, std::string("hash of secret ") + role, 1, 0});
        access->own_accounts.load(Token{"id1", "line3", "viewer", Role::viewer, digest_of("secret"), 1, 0, 0});
        const auto a = from("POST", "/api/v1/session", R"({"user":"administrator","password":"secret administrator"})");
        const std::string cookie(a.headers.get("Set-Cookie"));
        admin = {{"Cookie", cookie.substr(0, cookie.find(';'))}, {"X-CSRF-Token", a.at("csrf")}};
        access->kept.clear();
        access->slow_disk = true;
    }
    Answer from(std::string_view method, std::string target, std::string body = {},
                std::vector<std::pair<std::string, std::string>> headers = {}) {
        Request r = request(method, std::move(target), std::move(body), std::move(headers));
        r.peer = std::string(far_peer);
        auto handled = door.handle(r, [this](Response x) { late.push_back(std::move(x)); });
        return handled.now ? answer_from(std::move(*handled.now)) : Answer{};
    }
    /// The state after a crash: users and tokens from the written records.
    AccessRegister after_a_crash() const {
        std::map<std::pair<std::string, std::string>, std::string> store;
        for (const auto* role : {"viewer", "administrator"})
            store[{"user", role}] = *record_of(User{role, *role_named(role), true, std::string("hash of secret ") + role, 1, 0}).text;
        store[{"token", "id1"}] = *record_of(Token{"id1", "line3", "viewer", Role::viewer, digest_of("secret"), 1, 0, 0}).text;
        for (const auto& r : access->kept) {
            if (r.text) {
                store[{r.kind, r.name}] = *r.text;
            } else {
                store.erase({r.kind, r.name});
            }
        }
        AccessRegister access{AccessSettings{}};
        for (const auto& [key, text] : store) {
            if (key.first == "user") access.load(*user_of(text));
            if (key.first == "token") access.load(*token_of(text));
        }
        for (const auto& [key, text] : store) {
            if (key.first == "last_use") access.load_use(key.second, text);
        }
        return access;
    }
    std::vector<Response> late;
};

TEST_F(AccessQueueTest, ATokenThatIsUsedWhileItIsRemovedStaysRemoved) {
    (void)from("DELETE", "/api/v1/tokens/id1", "", admin);
    ASSERT_EQ(access->writing.size(), 1u) << "the removal is on its way";
    EXPECT_EQ(from("GET", "/api/v1/session", "", {{"Authorization", "Bearer id1.secret"}}).at("via"), "token") << "and not in force yet";
    EXPECT_EQ(access->writing.size(), 1u) << "its use waits behind it";
    while (!access->writing.empty()) {
        access->write_one();
        EXPECT_FALSE(after_a_crash().tokens().contains("id1"));
    }
    ASSERT_EQ(late.size(), 1u);
    EXPECT_EQ(late[0].status, 204u);
    for (const auto& r : access->kept)
        EXPECT_FALSE(r.text) << r.kind << ' ' << r.name << ": nothing of it is stored any more";
    EXPECT_EQ(from("GET", "/api/v1/about", "", {{"Authorization", "Bearer id1.secret"}}).status, 401u);
}

TEST_F(AccessQueueTest, AUserWhoSignsInWhileHeIsChangedIsStoredAsHeWasChanged) {
    (void)from("PATCH", "/api/v1/users/viewer", R"({"role":"operator"})", admin);
    (void)from("POST", "/api/v1/session", R"({"user":"viewer","password":"secret viewer"})");
    (void)from("PATCH", "/api/v1/users/viewer", R"({"enabled":false})", admin);
    (void)from("POST", "/api/v1/session", R"({"user":"viewer","password":"secret viewer"})");
    access->write_one();
    EXPECT_EQ(after_a_crash().user("viewer")->role, Role::operating);
    while (!access->writing.empty()) {
        access->write_one();
        EXPECT_EQ(after_a_crash().user("viewer")->role, Role::operating);
    }
    const auto found = after_a_crash();
    EXPECT_FALSE(found.user("viewer")->enabled);
    EXPECT_GT(found.user("viewer")->last_sign_in_ns, 0) << "he was here all the same";
    EXPECT_EQ(found.user("viewer")->last_sign_in_ns, access->own_accounts.user("viewer")->last_sign_in_ns);
}

TEST_F(AccessQueueTest, AUserWhoSignsInWhileHeIsRemovedIsGone) {
    (void)from("DELETE", "/api/v1/users/viewer", "", admin);
    (void)from("POST", "/api/v1/session", R"({"user":"viewer","password":"secret viewer"})");
    (void)from("GET", "/api/v1/session", "", {{"Authorization", "Bearer id1.secret"}});
    while (!access->writing.empty())
        access->write_one();
    EXPECT_EQ(after_a_crash().user("viewer"), nullptr);
    EXPECT_TRUE(after_a_crash().tokens().empty());
    for (const auto& r : access->kept)
        EXPECT_FALSE(r.text) << r.kind << ' ' << r.name;
}

TEST_F(AccessQueueTest, UsesOfManyTakeOnePlaceInTheQueue) {
    for (int i = 0; i < 200; ++i) {
        const std::string id = "t" + std::to_string(i);
        access->own_accounts.load(Token{id, id, "viewer", Role::viewer, digest_of("secret"), 1, 0, 0});
        EXPECT_EQ(from("GET", "/api/v1/session", "", {{"Authorization", "Bearer " + id + ".secret"}}).at("via"), "token");
    }
    EXPECT_EQ(access->writing.size(), 1u);
    (void)from("PATCH", "/api/v1/users/viewer", R"({"role":"operator"})", admin);
    EXPECT_TRUE(late.empty()) << "taken, and not refused for a full queue";
    access->write_one();
    access->write_one();
    while (!access->writing.empty())
        access->write_one();
    EXPECT_EQ(late.size(), 1u);
    EXPECT_EQ(after_a_crash().user("viewer")->role, Role::operating);
}

TEST(ChangeQueue, AJobThatThrowsOrForgetsItsEndDoesNotHoldUpTheNext) {
    const auto queue = std::make_shared<ChangeQueue>();
    std::vector<std::string> reported;
    const auto failed = [&reported](const std::string& what) { reported.push_back("failed: " + what); };
    std::function<void()> end_first;
    EXPECT_TRUE(queue->run([&](auto done) { end_first = std::move(done); }, failed));
    EXPECT_TRUE(queue->run([&](auto) { throw std::runtime_error("at once"); }, failed));
    EXPECT_TRUE(queue->run([&](auto) { throw 7; }, failed));
    EXPECT_TRUE(queue->run([&](auto) { reported.push_back("forgets"); }, failed));
    EXPECT_TRUE(queue->run(
        [&](auto done) {
            done();
            throw std::runtime_error("after its end");
        },
        failed));
    EXPECT_TRUE(queue->run([&](auto) { throw std::runtime_error("nobody listens"); }, nullptr));
    EXPECT_TRUE(queue->run(
        [&](auto done) {
            reported.push_back("runs");
            done();
            done();
        },
        failed));
    EXPECT_TRUE(reported.empty());
    end_first();
    EXPECT_EQ(reported, (std::vector<std::string>{"failed: at once", "failed: unknown", "forgets", "failed: after its end", "runs"}));
}

TEST(ChangeQueue, AJobWhoseEndIsLostLaterFreesItsPlaceThen) {
    const auto queue = std::make_shared<ChangeQueue>();
    std::function<void()> kept;
    bool ran = false;
    EXPECT_TRUE(queue->run([&](auto done) { kept = std::move(done); }, nullptr));
    EXPECT_TRUE(queue->run(
        [&](auto done) {
            ran = true;
            done();
        },
        nullptr));
    EXPECT_FALSE(ran);
    kept = nullptr;  // no copy exists any more, as after an exception
    EXPECT_TRUE(ran);
}
}  // namespace
}  // namespace axisgate::http::test
