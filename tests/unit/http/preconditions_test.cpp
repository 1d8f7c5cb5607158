// Two clients that change the same object: users, the locks of the Modbus door and single parameters have an ETag, and an If-Match with
// another state is refused with the present one. And two tokens of one owner have two names.
#include "gateway/doors/http/preconditions.hpp"

#include "tests/unit/http/fake_access.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
using Fields = std::vector<std::pair<std::string, std::string>>;

class Preconditions : public ::testing::Test, public Harness {
protected:
    std::shared_ptr<FakeAccess> access = std::make_shared<FakeAccess>();
    Router door = with_users(access);
    Fields admin;
    Preconditions() {
        for (const auto* role : {"engineer", "administrator"})
            access->own_accounts.load(User{role, *role_named(role), true, std::string("hash of secret ") + role, 1, 0});
        admin = signed_in("administrator");
    }
    Answer ask(std::string_view method, std::string target, std::string body = {}, Fields headers = {}) {
        auto late = std::make_shared<std::optional<Response>>();  // an answer may come after its request has ended
        auto handled = door.handle(request(method, std::move(target), std::move(body), std::move(headers)),
                                   [late](Response x) { *late = std::move(x); });
        if (handled.now) return answer_from(std::move(*handled.now));
        return *late ? answer_from(std::move(**late)) : Answer{};
    }
    Fields signed_in(const std::string& name) {
        const auto a = ask("POST", "/api/v1/session", R"({"user":")" + name + R"(","password":"secret )" + name + R"("})");
        const std::string cookie(a.headers.get("Set-Cookie"));
        return {{"Cookie", cookie.substr(0, cookie.find(';'))}, {"X-CSRF-Token", a.at("csrf")}};
    }
    [[nodiscard]] Fields if_match(std::string tag) const {
        Fields all = admin;
        all.emplace_back("If-Match", std::move(tag));
        return all;
    }
};

TEST(Tags, DependOnEveryPartAndOnWhereItEnds) {
    EXPECT_EQ(tag_over({"a", "bc"}), tag_over({"a", "bc"}));
    EXPECT_NE(tag_over({"a", "bc"}), tag_over({"ab", "c"}));
    EXPECT_NE(tag_over({"a"}), tag_over({"a", ""}));
    EXPECT_FALSE(means_another("", "\"x\""));
    EXPECT_FALSE(means_another("*", "\"x\""));
    EXPECT_FALSE(means_another("\"y\", \"x\"", "\"x\""));
    EXPECT_TRUE(means_another("\"y\"", "\"x\""));
    EXPECT_TRUE(means_another("W/\"x\"", "\"x\"")) << "a weak one is not enough to change by";
}

TEST_F(Preconditions, AUserWhoWasChangedMeanwhile) {
    const auto seen = ask("GET", "/api/v1/users/engineer", "", admin);
    const std::string tag(seen.headers.get("ETag"));
    ASSERT_EQ(tag, seen.at("etag")) << seen.text;
    const auto list = ask("GET", "/api/v1/users", "", admin).array();
    ASSERT_EQ(list.size(), 2u);
    EXPECT_EQ(std::string_view(list[1].at("etag").as_string()), tag);
    EXPECT_NE(std::string_view(list[0].at("etag").as_string()), tag);
    const auto changed = ask("PATCH", "/api/v1/users/engineer", R"({"role":"operator"})", if_match(tag));
    ASSERT_EQ(changed.status, 200u) << changed.text;
    const std::string newer(changed.headers.get("ETag"));
    EXPECT_NE(newer, tag);
    EXPECT_EQ(newer, ask("GET", "/api/v1/users/engineer", "", admin).headers.get("ETag"));
    const auto kept = access->kept.size();
    for (const auto* method : {"PATCH", "DELETE"}) {
        const auto late =
            ask(method, "/api/v1/users/engineer", std::string_view(method) == "PATCH" ? R"({"enabled":false})" : "", if_match(tag));
        EXPECT_EQ(late.status, 412u) << method << late.text;
        EXPECT_EQ(late.at("reason"), "precondition_failed");
        EXPECT_EQ(late.at("etag"), newer);
        EXPECT_EQ(late.headers.get("ETag"), newer);
        EXPECT_EQ(late.json.at("current").at("role"), "operator");
    }
    EXPECT_EQ(access->kept.size(), kept) << "nothing was stored";
    EXPECT_EQ(ask("PATCH", "/api/v1/users/engineer", R"({"role":"viewer"})", admin).status, 200u) << "without If-Match as ever";
    EXPECT_EQ(ask("DELETE", "/api/v1/users/engineer", "", if_match("*")).status, 204u);
    EXPECT_EQ(ask("PATCH", "/api/v1/users/engineer", "{}", if_match(newer)).status, 404u);
}

TEST_F(Preconditions, ANewPasswordIsAnotherStateAndASignInIsNot) {
    const auto tag = [&] { return ask("GET", "/api/v1/users/engineer", "", admin).at("etag"); };
    const auto before = tag();
    (void)signed_in("engineer");
    EXPECT_EQ(tag(), before);
    EXPECT_EQ(ask("PATCH", "/api/v1/users/engineer", R"({"password":"a-long-sentence-1"})", admin).status, 200u);
    EXPECT_NE(tag(), before);
}

TEST_F(Preconditions, TheLocksOfTheModbusDoor) {
    EXPECT_EQ(ask("GET", "/api/v1/modbus", "", admin).status, 503u) << "switched off";
    EXPECT_EQ(ask("PATCH", "/api/v1/modbus", R"({"read_only":true})", if_match("\"x\"")).status, 503u);
    gateway.modbus_door = ModbusReport{"127.0.0.1:1502", {"127.0.0.0/8"}, {"3"}, false, {}};
    const auto seen = ask("GET", "/api/v1/modbus", "", admin);
    const std::string tag(seen.headers.get("ETag"));
    ASSERT_FALSE(tag.empty()) << seen.text;
    gateway.modbus_door->connections.push_back({});
    EXPECT_EQ(ask("GET", "/api/v1/modbus", "", admin).headers.get("ETag"), tag) << "a client that comes changes no lock";
    const auto changed = ask("PATCH", "/api/v1/modbus", R"({"read_only":true})", if_match(tag));
    EXPECT_EQ(changed.status, 200u) << changed.text;
    EXPECT_EQ(changed.at("read_only"), "true");
    const std::string newer(changed.headers.get("ETag"));
    EXPECT_NE(newer, tag);
    const auto late = ask("PATCH", "/api/v1/modbus", R"({"read_only":false})", if_match(tag));
    EXPECT_EQ(late.status, 412u) << late.text;
    EXPECT_EQ(late.at("etag"), newer);
    EXPECT_EQ(late.json.at("current").at("read_only"), true);
    EXPECT_TRUE(gateway.modbus_door->read_only) << "nothing was set";
    EXPECT_EQ(ask("PATCH", "/api/v1/modbus", R"({"read_only":false})", if_match(newer)).status, 200u) << "the queue goes on";
    EXPECT_EQ(ask("PATCH", "/api/v1/modbus", R"({"read_only":1,"bind":"x"})", admin).object().at("faults").get_array().size(), 2u);
}

TEST_F(Preconditions, AParameterThatWasWrittenMeanwhile) {
    const std::string path = "/api/v1/axes/feeder/parameters/AC";
    const auto tag = [&] { return std::string(ask("GET", path + "?cached=1", "", admin).headers.get("ETag")); };
    const auto write = [&](Fields headers) { return ask("PUT", path, R"({"value":30000})", std::move(headers)); };
    const auto unwritten = tag();
    EXPECT_EQ(unwritten, "\"never-written\"");
    EXPECT_EQ(write(if_match("\"x\"")).status, 412u);
    EXPECT_TRUE(write(if_match("\"x\"")).json.at("current").is_null()) << "nobody wrote it";
    gateway.stored_values["feeder"] = {
        {"AC", std::int64_t{25000}, std::int64_t{20000}, "ben 192.0.2.7:5", "http", 1'700'000'000'000'000'000}};
    const auto late = write(if_match(unwritten));
    EXPECT_EQ(late.status, 412u) << late.text;
    EXPECT_EQ(late.json.at("current").at("value"), 25000);
    EXPECT_EQ(late.json.at("current").at("written_by"), "ben 192.0.2.7:5");
    EXPECT_EQ(late.json.at("current").at("written_at"), "2023-11-14T22:13:20.000000Z");
    EXPECT_EQ(late.at("etag"), tag());
    EXPECT_TRUE(gateway.submitted.empty()) << "nothing went to the drive";
    const auto first = tag();
    gateway.stored_values["feeder"][0].at_unix_ns += 1;
    EXPECT_NE(tag(), first) << "the same value written again is another state";
    EXPECT_EQ(ask("GET", "/api/v1/axes/feeder/parameters/MT?cached=1", "", admin).headers.get("ETag"), unwritten) << "each by itself";
    EXPECT_EQ(write(if_match(tag())).status, 0u) << "on its way";
    ASSERT_EQ(gateway.submitted.size(), 1u);
    // Until it is answered, it is unknown whether another request refers to the right state.
    const auto busy = write(if_match(tag()));
    EXPECT_EQ(busy.status, 409u) << busy.text;
    EXPECT_EQ(busy.at("reason"), "busy");
    EXPECT_EQ(gateway.submitted.size(), 1u);
    gateway.finish(bad_result(Reason::no_answer, "silent"));
    EXPECT_EQ(write(if_match(tag())).status, 0u) << "a failed write is over too";
    EXPECT_EQ(write(admin).status, 0u) << "without If-Match as ever";
    EXPECT_EQ(gateway.submitted.size(), 3u);
}

TEST_F(Preconditions, TwoTokensOfOneOwnerHaveTwoNames) {
    const auto make = [&](std::string name, const Fields& who) {
        return ask("POST", "/api/v1/tokens", R"({"name":")" + name + R"(","role":"viewer"})", who);
    };
    ASSERT_EQ(make("line3", admin).status, 201u);
    const auto again = make(" line3 ", admin);
    EXPECT_EQ(again.status, 409u) << again.text;
    EXPECT_EQ(again.at("detail"), "administrator has a token line3 already: choose another name, or remove that token first");
    EXPECT_EQ(access->own_accounts.tokens().size(), 1u);
    EXPECT_EQ(make("line3", signed_in("engineer")).status, 201u) << "another's";
    EXPECT_EQ(make("line4", admin).status, 201u);
    EXPECT_EQ(ask("DELETE", "/api/v1/tokens/" + access->own_accounts.tokens().begin()->first, "", admin).status, 204u);
}

}  // namespace
}  // namespace axisgate::http::test
