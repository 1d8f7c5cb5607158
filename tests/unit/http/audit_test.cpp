// The events of the HTTP door itself: refusals, bounded, and changes that no service reports.
#include "tests/unit/http/fake_access.hpp"
#include "tests/unit/http/harness.hpp"

#include <algorithm>

namespace axisgate::http::test {
namespace {
using namespace std::chrono_literals;

class AuditTest : public HttpTest {
protected:
    std::shared_ptr<FakeAccess> access = std::make_shared<FakeAccess>();
    Router door = with_users(access);
    unsigned stranger(std::string_view method, std::string target, std::string peer = "192.0.2.7:5123") {
        Request r = request(method, std::move(target), method == "GET" ? "" : "{}");
        r.peer = std::move(peer);
        const auto handled = door.handle(r, [](const Response&) {});
        return handled.now ? handled.now->status : 0;
    }
    std::vector<Event> refused() {
        auto list = gateway.noted;
        std::erase_if(list, [](const Event& e) { return e.kind != "refused"; });
        return list;
    }
};

TEST_F(AuditTest, AStrangersRefusalIsAnEventThatSaysWhoFromWhereAndWhat) {
    EXPECT_EQ(stranger("POST", "/api/v1/lines?secret=x"), 401u);
    ASSERT_EQ(refused().size(), 1u);
    const Event e = refused()[0];
    EXPECT_EQ(e.who, "192.0.2.7:5123");
    EXPECT_EQ(e.door, "http");
    EXPECT_EQ(e.severity, Severity::warning);
    EXPECT_EQ(e.text, "POST /api/v1/lines: sign in first: this needs the role engineer (401 sign_in)");
}

TEST_F(AuditTest, WhatAStrangerAsksForInARowIsOneRow) {
    for (int i = 0; i < 500; ++i)
        EXPECT_EQ(stranger(i % 2 ? "GET" : "DELETE", "/api/v1/axes/slide" + std::to_string(i)), 401u);
    EXPECT_EQ(refused().size(), 1u);
    EXPECT_EQ(door.audit().counted_only(), 499u);
    door.audit().flush(Instant{std::chrono::steady_clock::now().time_since_epoch()} + Audit::row_period + 1s);
    ASSERT_EQ(refused().size(), 2u);
    EXPECT_NE(refused()[1].text.find("499 times more"), std::string::npos) << refused()[1].text;
}

TEST_F(AuditTest, WhoseBodyIsNotWaitedForIsWrittenDownAsWell) {
    Request head = request("PUT", "/api/v1/site");
    head.peer = "192.0.2.8:1";
    EXPECT_EQ(door.admit(head).refusal->status, 401u);
    EXPECT_EQ(refused().size(), 1u);
}

TEST_F(AuditTest, AConflictIsWrittenDownWhereSomethingWasToBeChanged) {
    EXPECT_EQ(call("POST", "/api/v1/site/stage/apply", "{}").status, 409u);
    ASSERT_EQ(refused().size(), 1u);
    EXPECT_NE(refused()[0].text.find("POST /api/v1/site/stage/apply: "), std::string::npos);
    EXPECT_NE(refused()[0].text.find("(409 conflict)"), std::string::npos) << refused()[0].text;
    EXPECT_EQ(call("GET", "/api/v1/axes/nobody").status, 404u);
    EXPECT_EQ(refused().size(), 1u) << "404 is none of these";
}

TEST_F(AuditTest, ARefusalThatComesLateIsWrittenDown) {
    ASSERT_EQ(call("POST", "/api/v1/axes/slide/commands", R"({"command":"enable"})").status, 0u);
    gateway.finish(bad_result(Reason::authority, "anna holds it"));
    EXPECT_EQ(answered().status, 409u);
    ASSERT_EQ(refused().size(), 1u);
    EXPECT_EQ(refused()[0].axis, "slide");
    EXPECT_EQ(refused()[0].text, "POST /api/v1/axes/slide/commands: anna holds it (409 authority)");
}

TEST_F(AuditTest, StagingDeletingAndRenamingLeaveEvents) {
    const std::string site = call("GET", "/api/v1/site").text;
    ASSERT_EQ(call("POST", "/api/v1/site/stage", site).status, 200u);
    ASSERT_EQ(gateway.noted.size(), 1u);
    EXPECT_EQ(gateway.noted[0].text, "a site was staged");
    EXPECT_EQ(gateway.noted[0].kind, "site");
    EXPECT_EQ(gateway.noted[0].who, "127.0.0.1:51123");
    EXPECT_EQ(call("DELETE", "/api/v1/site/stage").status, 204u);
    EXPECT_EQ(gateway.noted.back().text, "the staged site was discarded");
    const auto noted = gateway.noted.size();
    EXPECT_EQ(call("DELETE", "/api/v1/site/stage").status, 204u);
    EXPECT_EQ(gateway.noted.size(), noted) << "there was none";
}

TEST_F(AuditTest, ANameOfTheBodyAndOnesOfThePathStandInTheText) {
    for (const auto& r : all_routes()) {
        if (r.event_kind.empty()) continue;
        EXPECT_NE(r.method, Method::get) << r.path;
        const auto wanted = std::count(r.event_text.begin(), r.event_text.end(), '{');
        EXPECT_EQ(wanted, std::count(r.event_text.begin(), r.event_text.end(), '}')) << r.path;
        EXPECT_FALSE(r.event_text.empty()) << r.path;
    }
}

}  // namespace
}  // namespace axisgate::http::test
