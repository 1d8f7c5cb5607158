// Recipes over HTTP: documents, runs through the Gateway in virtual time, reports, and who may run beside whom.
#include <fmt/format.h>

#include "gateway/doors/http/stream_hub.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace json = boost::json;
namespace {
constexpr auto simple = R"({"steps":[{"enable":{"axis":"feeder"}},{"wait_s":1}]})";

class Recipes : public HttpTest {
protected:
    Recipes() {
        gateway.set_picture("feeder", standing(3200));
        gateway.set_picture("slide", standing(0));
        clock = at_ns(1'000'000'000);
    }
    void pass(std::chrono::nanoseconds d) {
        clock += d;
        recipes->on_deadline(clock);
    }
    void put(const std::string& name, const std::string& document) {
        ASSERT_EQ(call("PUT", "/api/v1/recipes/" + name, document).status, 201u) << name;
    }
    Answer run(const std::string& name, std::string body = "{}") {
        auto a = call("POST", "/api/v1/recipes/" + name + "/run", std::move(body));
        recipes->on_deadline(clock);
        return a;
    }
    std::string state(const std::string& name, int n = 1) {
        return call("GET", fmt::format("/api/v1/recipes/{}/runs/{}", name, n)).at("state");
    }
    void answer_oldest(Result r = good_result()) {
        ASSERT_FALSE(gateway.waiting.empty());
        auto w = std::move(gateway.waiting.front());
        gateway.waiting.pop_front();
        r.ticket = w.ticket;
        w.then(r);
        recipes->on_deadline(clock);
    }
};

TEST_F(Recipes, ADocumentIsKeptAsItWasPut) {
    auto a = call("PUT", "/api/v1/recipes/warm-up", simple);
    EXPECT_EQ(a.status, 201u);
    EXPECT_EQ(a.headers.get("Location"), "/api/v1/recipes/warm-up");
    EXPECT_EQ(call("PUT", "/api/v1/recipes/warm-up", simple).status, 200u);
    EXPECT_EQ(json_text(call("GET", "/api/v1/recipes/warm-up").object().at("steps")), R"([{"enable":{"axis":"feeder"}},{"wait_s":1}])");
    EXPECT_EQ(call("GET", "/api/v1/recipes").array().size(), 1u);
    EXPECT_EQ(call("PUT", "/api/v1/recipes/other?dry_run=1", simple).status, 200u);
    EXPECT_EQ(call("GET", "/api/v1/recipes/other").status, 404u);
    EXPECT_EQ(call("DELETE", "/api/v1/recipes/warm-up").status, 204u);
    EXPECT_EQ(call("DELETE", "/api/v1/recipes/warm-up").status, 404u);
    for (const auto* name : {"a%20b", "..", "%C3%A4"})
        EXPECT_EQ(call("PUT", std::string("/api/v1/recipes/") + name, simple).status, 422u) << name;
    gateway.document_fault = "the disk is full";
    EXPECT_EQ(call("PUT", "/api/v1/recipes/warm-up", simple).status, 507u);
}

TEST_F(Recipes, AChangeCanBeTiedToWhatWasRead) {
    const auto made = call("PUT", "/api/v1/recipes/warm-up", simple, {{"If-None-Match", "*"}});
    ASSERT_EQ(made.status, 201u) << made.text;
    const std::string first(made.headers.get("ETag"));
    EXPECT_EQ(first.size(), 18u);
    EXPECT_EQ(call("GET", "/api/v1/recipes/warm-up").headers.get("ETag"), first);
    EXPECT_EQ(call("GET", "/api/v1/recipes").array().at(0).at("etag"), json::value(first));
    EXPECT_EQ(call("PUT", "/api/v1/recipes/warm-up", simple, {{"If-None-Match", "*"}}).status, 412u) << "there is one";
    gateway.now_ns += 1'000'000'000;
    const auto changed = call("PUT", "/api/v1/recipes/warm-up", R"({"steps":[{"wait_s":2}]})", {{"If-Match", first}});
    ASSERT_EQ(changed.status, 200u) << changed.text;
    const std::string second(changed.headers.get("ETag"));
    EXPECT_NE(second, first);
    for (const auto* method : {"PUT", "DELETE"}) {
        const auto stale = call(method, "/api/v1/recipes/warm-up", std::string_view(method) == "PUT" ? simple : "", {{"If-Match", first}});
        EXPECT_EQ(stale.status, 412u) << method;
        EXPECT_EQ(stale.headers.get("ETag"), second) << method;
        EXPECT_EQ(stale.at("etag"), second);
        EXPECT_EQ(json_text(stale.object().at("current").at("steps")), R"([{"wait_s":2}])") << "what is there now";
        EXPECT_NE(stale.at("detail").find(second), std::string::npos) << stale.text;
    }
    EXPECT_EQ(call("PUT", "/api/v1/recipes/warm-up?dry_run=1", simple, {{"If-Match", first}}).status, 412u);
    EXPECT_EQ(call("PUT", "/api/v1/recipes/none", simple, {{"If-Match", "*"}}).status, 412u) << "deleted meanwhile: not made again";
    EXPECT_EQ(call("PUT", "/api/v1/recipes/warm-up", simple, {{"If-Match", "\"x\", " + second}}).status, 200u) << "one of a list";
    EXPECT_EQ(call("PUT", "/api/v1/recipes/warm-up", simple).status, 200u) << "without the headers as ever";
    const std::string third(call("GET", "/api/v1/recipes/warm-up").headers.get("ETag"));
    EXPECT_EQ(call("DELETE", "/api/v1/recipes/warm-up", "", {{"If-Match", third}}).status, 204u);
}

TEST_F(Recipes, FaultsHavePointersIntoTheBody) {
    const auto a = call("PUT", "/api/v1/recipes/x", R"({"steps":[{"command":{"axis":"any","command":"fly"}},{"enable":{}}]})");
    EXPECT_EQ(a.status, 422u);
    EXPECT_EQ(a.fault(0).at("pointer"), json::value("/steps/1/enable")) << a.text;
    const auto b = call("PUT", "/api/v1/recipes/x", R"({"steps":[{"command":{"axis":"any","command":"fly"}}]})");
    EXPECT_EQ(b.fault(0).at("pointer"), json::value("/steps/0/command/command")) << b.text;
}

TEST_F(Recipes, ARunSendsItsCommandsInItsOwnName) {
    put("warm-up", simple);
    const auto a = run("warm-up");
    EXPECT_EQ(a.status, 202u);
    EXPECT_EQ(a.headers.get("Location"), "/api/v1/recipes/warm-up/runs/1");
    ASSERT_EQ(gateway.submitted.size(), 1u);
    EXPECT_TRUE(gateway.submitted[0].until_done);
    EXPECT_EQ(gateway.submitted[0].origin.text(), "http recipe warm-up by 127.0.0.1:51123");
    answer_oldest();
    pass(std::chrono::seconds(1));
    EXPECT_EQ(state("warm-up"), "done");
    EXPECT_EQ(gateway.stored_documents.count({"recipe_run", "warm-up/0000000001"}), 1u);
    ASSERT_EQ(gateway.noted.size(), 3u);
    EXPECT_EQ(gateway.noted[2].text, "recipe warm-up run 1 done");
    EXPECT_EQ(recipes->deadline(), never);
}

TEST_F(Recipes, OneRunPerRecipeAndNoAxisInTwo) {
    put("a", simple);
    put("b", R"({"steps":[{"disable":{"axis":"feeder"}}]})");
    put("c", R"({"steps":[{"enable":{"axis":"slide"}}]})");
    put("d", R"({"steps":[{"wait_s":1},{"check":{"axis":"feeder","point":"fault","is":false}}]})");
    put("e", R"({"steps":[{"wait_s":1}]})");
    put("f", R"({"steps":[{"wait_s":1}]})");
    EXPECT_EQ(run("a").status, 202u);
    EXPECT_EQ(run("a").at("reason"), "running");
    EXPECT_EQ(run("b").at("detail"), "axis feeder is in use by recipe a (run 1)");
    EXPECT_EQ(run("c").status, 202u);
    EXPECT_EQ(run("d").status, 202u) << "looking is free";
    EXPECT_EQ(run("e").status, 202u);
    EXPECT_EQ(run("f").status, 503u);
    EXPECT_EQ(call("DELETE", "/api/v1/recipes/a").status, 409u);
}

TEST_F(Recipes, AFailedRunHaltsWhatItSetInMotion) {
    put("go",
        R"({"steps":[{"command":{"axis":"feeder","command":"move_velocity","velocity":1}},{"command":{"axis":"feeder","command":"move_absolute","position":1,"wait_s":1}}]})");
    (void)run("go");
    answer_oldest();
    answer_oldest(bad_result(Reason::drive_refused, "data error", 51));
    ASSERT_EQ(gateway.submitted.size(), 3u);
    EXPECT_TRUE(std::holds_alternative<Halt>(gateway.submitted[2].body));
    answer_oldest();
    const auto r = call("GET", "/api/v1/recipes/go/runs/1");
    EXPECT_EQ(r.at("state"), "failed");
    EXPECT_EQ(r.at("at_step"), "/steps/1");
    EXPECT_EQ(r.at("text"), "data error (drive_refused, the drive's code 51)");
    EXPECT_EQ(gateway.noted.back().severity, Severity::warning);
}

TEST_F(Recipes, TwentyReportsAreKeptAndNumbersGoOn) {
    put("quick", R"({"steps":[{"wait_s":0}]})");
    for (int i = 0; i < 25; ++i)
        EXPECT_EQ(run("quick").status, 202u);
    const auto list = call("GET", "/api/v1/recipes/quick/runs").array();
    ASSERT_EQ(list.size(), RecipeDesk::kept_reports);
    EXPECT_EQ(list.front().at("n"), json::value(25));
    EXPECT_EQ(call("GET", "/api/v1/recipes/quick/runs/5").status, 404u);
    EXPECT_EQ(call("GET", "/api/v1/recipes/quick/runs/6").status, 200u);
    auto fresh = std::make_shared<RecipeDesk>(gateway, [this] { return clock; });  // as after a restart
    std::vector<SiteFault> faults;
    auto recipe = read_recipe(json::parse(R"({"steps":[{"wait_s":0}]})").get_object(), nullptr, faults);
    const auto started = fresh->start("quick", std::move(*recipe), {}, {});
    EXPECT_EQ(std::get<json::object>(started).at("n"), json::value(26));
}

TEST_F(Recipes, ProgressIsToldAtMostTenTimesASecond) {
    std::vector<std::string> told;
    recipes->tell = [&](const std::string&, const json::object& r) { told.emplace_back(r.at("state").get_string()); };
    put("steps", R"({"steps":[{"repeat":{"times":50,"steps":[{"wait_s":0.01}]}}]})");
    (void)run("steps");
    for (int i = 0; i < 60; ++i)
        pass(std::chrono::milliseconds(10));
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.back(), "done");
    EXPECT_LE(told.size(), 8u);
    EXPECT_GE(told.size(), 4u);
}

TEST_F(Recipes, AnAxisThatIsGoneEndsTheRun) {
    put("warm-up", R"({"steps":[{"wait_s":1},{"enable":{"axis":"feeder"}}]})");
    (void)run("warm-up");
    gateway.put_site(Site{});
    pass(std::chrono::seconds(1));
    recipes->on_deadline(clock);
    EXPECT_EQ(state("warm-up"), "failed");
    EXPECT_EQ(call("GET", "/api/v1/recipes/warm-up/runs/1").at("text"), "there is no axis feeder");
}

TEST_F(Recipes, ALineIsScanned) {
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/scan").at("state"), "none");
    const auto a = call("POST", "/api/v1/lines/can0/scan", R"({"from":5,"to":"9","limit_s":3})");
    EXPECT_EQ(a.status, 202u);
    EXPECT_EQ(a.headers.get("Location"), "/api/v1/lines/can0/scan");
    ASSERT_EQ(gateway.scan_wishes.size(), 1u);
    EXPECT_EQ(gateway.scan_wishes[0].from, "5");
    EXPECT_EQ(gateway.scan_wishes[0].to, "9");
    EXPECT_EQ(gateway.scan_wishes[0].limit, std::chrono::seconds(3));
    EXPECT_EQ(call("DELETE", "/api/v1/lines/can0/scan").at("state"), "cancelled");
    for (const auto* bad : {R"({"limit_s":0})", R"({"limit_s":601})", R"({"from":true})", R"({"x":1})"})
        EXPECT_EQ(call("POST", "/api/v1/lines/can0/scan", bad).status, 422u) << bad;
    gateway.scan_fault = "line can0 is down";
    EXPECT_EQ(call("POST", "/api/v1/lines/can0/scan", "{}").status, 409u);
    EXPECT_EQ(call("POST", "/api/v1/lines/nobody/scan", "{}").status, 404u);
}
}  // namespace
}  // namespace axisgate::http::test
