// Recipes over HTTP: documents, runs in virtual time, reports, and which recipes may run at the same time.
#include <fmt/core.h>

#include <algorithm>

#include "gateway/doors/http/stream_hub.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/services/recipes/recipe_read.hpp"
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
        const auto* move = std::get_if<Move>(&w.command.body);
        if (good(r) && ((move && !move->prepare_only) || std::holds_alternative<Home>(w.command.body))) moves(w.command.axis, w.ticket);
        w.then(r);
        recipes->on_deadline(clock);
    }
    /// The drive has accepted a motion: the picture shows it before the client is answered.
    void moves(AxisId axis, Ticket by, bool moving = true) {
        AxisPicture& p = gateway.pictures[axis];
        p.motion_ticket = by;
        p.flags = moving ? static_cast<std::uint16_t>(p.flags | flag_moving) : static_cast<std::uint16_t>(p.flags & ~flag_moving);
    }
    void holds(const std::string& axis, const std::string& who) {
        AxisPicture& p = gateway.pictures[gateway.axis(axis)];
        p.authority = http::clients;
        p.authority_holder = {};
        std::ranges::copy(who, p.authority_holder.begin());
        p.authority_until = clock + std::chrono::hours(24);
    }
    bool stop_sent() {
        return std::ranges::any_of(gateway.submitted, [](const Command& c) { return std::holds_alternative<Halt>(c.body); });
    }
    json::object report(const std::string& name, int n = 1) {
        return call("GET", fmt::format("/api/v1/recipes/{}/runs/{}", name, n)).object();
    }
    static constexpr Ticket others_ticket = 77;
};
constexpr auto moving_recipe = R"({"steps":[{"command":{"axis":"feeder","command":"move_absolute","position":1,"wait_s":9}}]})";
constexpr auto running_away = R"({"steps":[{"command":{"axis":"feeder","command":"move_velocity","velocity":1}},{"wait_s":100}]})";

TEST_F(Recipes, ARehearsalOfAFaultReachesTheTwinAndNeverARealDrive) {
    const auto step = [](std::string_view inside) { return fmt::format(R"({{"steps":[{{"simulate":{{"axis":"feeder"{}}}}}]}})", inside); };
    for (const auto* wrong : {"", R"(,"input":"stall")", R"(,"input":"","value":true)", R"(,"input":"stall","value":true,"wait_s":1)"})
        EXPECT_EQ(call("PUT", "/api/v1/recipes/wrong", step(wrong)).status, 422u) << wrong;
    put("stall", step(R"(,"input":"stall","value":true)"));
    AxisPicture& p = gateway.pictures[gateway.axis("feeder")];
    for (const auto presence : {Presence::device, Presence::offline}) {
        p.presence = presence;
        for (const auto* body : {"{}", R"({"dry_run":true})"}) {
            const auto no = call("POST", "/api/v1/recipes/stall/run", body);
            EXPECT_EQ(no.status, 422u) << no.text;
            EXPECT_NE(no.text.find("/steps/0/simulate/axis"), std::string::npos) << no.text;
            EXPECT_NE(no.text.find(presence == Presence::device ? "feeder is a real drive now: stall cannot be simulated on it"
                                                                : "feeder is not simulated now"),
                      std::string::npos)
                << no.text;
        }
    }
    p.presence = Presence::twin;
    EXPECT_EQ(call("POST", "/api/v1/recipes/stall/run", R"({"dry_run":true})").status, 200u);
    ASSERT_EQ(run("stall").status, 202u);
    ASSERT_EQ(gateway.submitted.size(), 1u);
    const auto* hand = std::get_if<Hand>(&gateway.submitted[0].body);
    ASSERT_TRUE(hand);
    EXPECT_EQ(hand->name, "stall");
    EXPECT_EQ(hand->value, Value{true});
    answer_oldest();
    EXPECT_EQ(state("stall"), "done");
}

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
    EXPECT_EQ(gateway.stored_documents.count({"recipe_run warm-up", "0000000001"}), 1u);
    EXPECT_EQ(gateway.stored_documents.count({"recipe_run_under_way", "warm-up"}), 0u);
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

// --- whose a motion is --------------------------------------------------------------------------------------------------------

TEST_F(Recipes, AnAxisThatAnotherClientHoldsIsNotStoppedForARefusedStep) {
    put("go", moving_recipe);
    moves(gateway.axis("feeder"), others_ticket);
    holds("feeder", "otto");
    (void)run("go");
    answer_oldest(bad_result(Reason::authority, "held by http otto"));
    EXPECT_EQ(state("go"), "failed");
    EXPECT_FALSE(stop_sent());
    EXPECT_TRUE(report("go").at("stops").get_array().empty()) << "nothing was in motion by the run";
}

TEST_F(Recipes, AnUnknownActionStopsNothing) {
    put("go", R"({"steps":[{"action":{"axis":"feeder","name":"juggle"}}]})");
    (void)run("go");
    answer_oldest(bad_result(Reason::not_supported, "there is no action juggle"));
    EXPECT_EQ(state("go"), "failed");
    EXPECT_FALSE(stop_sent());
}

TEST_F(Recipes, AMoveByHandThatEndsAStepIsNotHalted) {
    put("go", moving_recipe);
    (void)run("go");
    moves(gateway.axis("feeder"), gateway.submitted[0].ticket);
    // By the same client, as when the person who has started the recipe moves the axis on the same page: only the ticket distinguishes
    // them.
    answer_oldest(bad_result(Reason::interrupted, "ended by move_absolute", 0, Outcome::failed));
    EXPECT_EQ(state("go"), "stopping") << "the drive has not answered the other command yet";
    EXPECT_FALSE(stop_sent());
    moves(gateway.axis("feeder"), others_ticket);
    pass(RecipeRun::look_period);
    EXPECT_EQ(state("go"), "failed");
    EXPECT_FALSE(stop_sent());
    const auto r = report("go");
    const auto& s = r.at("stops").get_array().at(0).get_object();
    EXPECT_EQ(s.at("left_alone"), json::value(true));
    EXPECT_EQ(s.at("stopped"), json::value(false));
    EXPECT_TRUE(s.at("text").get_string().starts_with("left alone: it moves by another command now"));
}

TEST_F(Recipes, AMotionThatAnotherHolderTookOverIsLeftAlone) {
    put("go", running_away);
    (void)run("go");
    answer_oldest();
    holds("feeder", "otto");
    (void)call("POST", "/api/v1/recipes/go/runs/1/cancel");
    recipes->on_deadline(clock);
    EXPECT_EQ(state("go"), "cancelled");
    EXPECT_FALSE(stop_sent());
    EXPECT_EQ(report("go").at("stops").get_array().at(0).at("text"), json::value("left alone: http otto holds the axis now"));
}

TEST_F(Recipes, TheRunsOwnHolderIsNoOther) {
    put("go", running_away);
    (void)run("go");
    answer_oldest();
    holds("feeder", "127.0.0.1");
    (void)call("POST", "/api/v1/recipes/go/runs/1/cancel");
    recipes->on_deadline(clock);
    EXPECT_TRUE(stop_sent());
}

TEST_F(Recipes, AMotionThatAStopOrAnotherCommandHasReplacedIsLeftAlone) {
    put("go", running_away);
    for (int n = 1; const Ticket by : {no_ticket, others_ticket}) {
        (void)run("go");
        answer_oldest();
        moves(gateway.axis("feeder"), by);
        (void)call("POST", fmt::format("/api/v1/recipes/go/runs/{}/cancel", n));
        recipes->on_deadline(clock);
        EXPECT_FALSE(stop_sent()) << n;
        EXPECT_EQ(report("go", n).at("stops").get_array().size(), 1u) << n;
        ++n;
    }
}

TEST_F(Recipes, WhatGotNoAnswerIsStopped) {
    put("go", moving_recipe);
    (void)run("go");
    answer_oldest(bad_result(Reason::no_answer, "the drive did not answer", 0, Outcome::failed));
    EXPECT_TRUE(stop_sent());
}

TEST_F(Recipes, AnActionOnAnAxisThatMovedAlreadyIsNotItsMotion) {
    put("go", R"({"steps":[{"action":{"axis":"feeder","name":"list"}},{"check":{"axis":"feeder","point":"fault","is":true}}]})");
    moves(gateway.axis("feeder"), others_ticket);
    (void)run("go");
    answer_oldest();
    EXPECT_EQ(state("go"), "failed");
    EXPECT_FALSE(stop_sent());
    moves(gateway.axis("feeder"), others_ticket, false);
    (void)run("go");
    answer_oldest();
    EXPECT_TRUE(stop_sent()) << "it stood: what moves it now may be what the action has started";
}

// --- reports ------------------------------------------------------------------------------------------------------------------

TEST_F(Recipes, StepsAreCalledByTheirLabels) {
    put("go", R"({"steps":[{"repeat":{"times":5,"steps":[{"command":{"axis":"feeder","command":"halt"}}]}}]})");
    (void)run("go");
    answer_oldest();
    const auto r = report("go");
    EXPECT_EQ(r.at("steps").get_array().at(1).at("label"), json::value("Step 1.1 (pass 2 of 5): command halt of feeder"));
    EXPECT_EQ(r.at("steps").get_array().at(1).at("pointer"), json::value("/steps/0/repeat/steps/0"));
    EXPECT_EQ(r.at("at_label"), r.at("steps").get_array().at(1).at("label"));
}

TEST_F(Recipes, ARunUnderWayIsShownAsInterruptedAfterARestart) {
    put("go", running_away);
    (void)run("go");
    answer_oldest();
    pass(std::chrono::milliseconds(1100));
    const auto noted = gateway.noted.size();
    auto fresh = std::make_shared<RecipeService>(gateway, [this] { return clock; });  // as after a kill -9: the end was not reported
    fresh->begin();
    const auto r = fresh->report("go", 1);
    ASSERT_TRUE(r);
    EXPECT_EQ(r->at("state"), json::value("interrupted"));
    EXPECT_TRUE(r->at("text").get_string().starts_with("the gateway was restarted while the run was under way"))
        << r->at("text").get_string();
    EXPECT_TRUE(r->at("text").get_string().ends_with("see to feeder"));
    EXPECT_TRUE(r->at("ended_at").is_string());
    EXPECT_EQ(r->at("steps").get_array().at(0).at("state"), json::value("done"));
    EXPECT_EQ(r->at("steps").get_array().at(1).at("state"), json::value("interrupted"));
    ASSERT_EQ(gateway.noted.size(), noted + 1);
    EXPECT_EQ(gateway.noted.back().severity, Severity::warning);
    EXPECT_TRUE(gateway.noted.back().text.starts_with("recipe go run 1 interrupted at /steps/1: the gateway was restarted"))
        << gateway.noted.back().text;
    fresh->begin();
    EXPECT_EQ(gateway.noted.size(), noted + 1) << "it is told once";
    std::vector<SiteFault> faults;
    auto recipe = read_recipe(json::parse(R"({"steps":[{"wait_s":0}]})").get_object(), nullptr, faults);
    EXPECT_EQ(std::get<json::object>(fresh->start("go", std::move(*recipe), {}, {})).at("n"), json::value(2));
}

TEST_F(Recipes, ARunIsWrittenAtItsStartItsEndAndOnceASecond) {
    put("steps", R"({"steps":[{"repeat":{"times":250,"steps":[{"wait_s":0.01}]}}]})");
    const auto before = gateway.document_saves;
    ASSERT_EQ(call("POST", "/api/v1/recipes/steps/run", "{}").status, 202u);
    EXPECT_EQ(gateway.document_saves, before + 1) << "before anything is done";
    for (int i = 0; i < 240; ++i)
        pass(std::chrono::milliseconds(10));
    EXPECT_EQ(gateway.document_saves, before + 3) << "2.4 s";
    for (int i = 0; i < 30; ++i)
        pass(std::chrono::milliseconds(10));
    EXPECT_EQ(state("steps"), "done");
    EXPECT_EQ(gateway.document_saves, before + 4);
}

TEST_F(Recipes, NoMoreThanTwentyAreShownWhileTheDiskIsBehind) {
    put("quick", R"({"steps":[{"wait_s":0}]})");
    put("slow", R"({"steps":[{"wait_s":9}]})");
    gateway.disk_is_behind = true;
    for (int i = 0; i < 25; ++i)
        EXPECT_EQ(run("quick").status, 202u);
    EXPECT_EQ(call("GET", "/api/v1/recipes/quick/runs").array().size(), RecipeService::kept_reports);
    EXPECT_EQ(call("GET", "/api/v1/recipes/quick/runs/5").status, 404u);
    gateway.catch_up();
    EXPECT_EQ(call("GET", "/api/v1/recipes/quick/runs").array().size(), RecipeService::kept_reports);
}

TEST_F(Recipes, ALongReportIsCutAndNotLost) {
    std::string steps;
    for (int i = 0; i < 400; ++i)
        steps += std::string(i == 0 ? "" : ",") + R"({"message":"${x}"})";
    put("long", R"({"parameters":{"x":{"type":"text"}},"steps":[)" + steps + "]}");
    (void)run("long", R"({"arguments":{"x":")" + std::string(4000, 'x') + R"("}})");
    for (int i = 0; i < 400; ++i)
        pass(std::chrono::milliseconds(1));
    EXPECT_EQ(state("long"), "done");
    const auto d = gateway.stored_documents.find({"recipe_run long", "0000000001"});
    ASSERT_NE(d, gateway.stored_documents.end());
    EXPECT_LE(d->second.text.size(), 1'000'000u);
    EXPECT_EQ(json::parse(d->second.text).at("steps").get_array().size(), 400u);
}

TEST_F(Recipes, TwentyReportsAreKeptAndNumbersGoOn) {
    put("quick", R"({"steps":[{"wait_s":0}]})");
    for (int i = 0; i < 25; ++i)
        EXPECT_EQ(run("quick").status, 202u);
    const auto list = call("GET", "/api/v1/recipes/quick/runs").array();
    ASSERT_EQ(list.size(), RecipeService::kept_reports);
    EXPECT_EQ(list.front().at("n"), json::value(25));
    EXPECT_EQ(call("GET", "/api/v1/recipes/quick/runs/5").status, 404u);
    EXPECT_EQ(call("GET", "/api/v1/recipes/quick/runs/6").status, 200u);
    auto fresh = std::make_shared<RecipeService>(gateway, [this] { return clock; });  // as after a restart
    std::vector<SiteFault> faults;
    auto recipe = read_recipe(json::parse(R"({"steps":[{"wait_s":0}]})").get_object(), nullptr, faults);
    const auto started = fresh->start("quick", std::move(*recipe), {}, {});
    EXPECT_EQ(std::get<json::object>(started).at("n"), json::value(26));
}

TEST_F(Recipes, ProgressIsToldAtMostTenTimesASecond) {
    std::vector<std::string> published;
    recipes->publish = [&](const std::string&, const json::object& r) { published.emplace_back(r.at("state").get_string()); };
    put("steps", R"({"steps":[{"repeat":{"times":50,"steps":[{"wait_s":0.01}]}}]})");
    (void)run("steps");
    for (int i = 0; i < 60; ++i)
        pass(std::chrono::milliseconds(10));
    ASSERT_FALSE(published.empty());
    EXPECT_EQ(published.back(), "done");
    EXPECT_LE(published.size(), 8u);
    EXPECT_GE(published.size(), 4u);
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

TEST_F(Recipes, AStepToAUnitWithAProfileIsRefusedWhenTheRecipeIsStored) {
    ASSERT_EQ(call("PUT", "/api/v1/profiles/12", R"({"language":"lexium","axes":[{"axis":"feeder"}]})").status, 200u);
    const auto recipe = [](int unit) {
        return fmt::format(R"({{"steps":[{{"repeat":{{"times":2,"steps":[{{"write_register":{{"unit":{},"address":1,"value":2}}}}]}}}}]}})",
                           unit);
    };
    for (const auto* query : {"", "?dry_run=1"}) {
        const auto refused = call("PUT", std::string("/api/v1/recipes/other") + query, recipe(12));
        ASSERT_EQ(refused.status, 422u) << refused.text;
        EXPECT_EQ(refused.fault().at("pointer"), "/steps/0/repeat/steps/0/write_register/unit");
        EXPECT_EQ(refused.fault().at("document"), "body");
        EXPECT_EQ(refused.fault().at("text"), "unit 12 speaks the language lexium: a recipe does not write its registers");
    }
    EXPECT_EQ(call("GET", "/api/v1/recipes/other").status, 404u) << "nothing is stored";
    // A recipe that is stored before its unit gets a profile is refused in the same way when it runs.
    put("earlier", recipe(13));
    ASSERT_EQ(call("PUT", "/api/v1/profiles/13", R"({"language":"lexium","axes":[{"axis":"slide"}]})").status, 200u);
    const auto late = run("earlier");
    ASSERT_EQ(late.status, 422u) << late.text;
    EXPECT_EQ(late.fault().at("pointer"), "/steps/0/repeat/steps/0/write_register/unit");
    EXPECT_EQ(late.fault().at("text"), "unit 13 speaks the language lexium: a recipe does not write its registers");
}

TEST_F(Recipes, ALineIsScanned) {
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/scan").at("state"), "none");
    const auto a = call("POST", "/api/v1/lines/can0/scan", R"({"from":5,"to":"9","family":"demo","limit_s":3})");
    EXPECT_EQ(a.status, 202u);
    EXPECT_EQ(a.headers.get("Location"), "/api/v1/lines/can0/scan");
    ASSERT_EQ(gateway.scan_wishes.size(), 1u);
    EXPECT_EQ(gateway.scan_wishes[0].from, "5");
    EXPECT_EQ(gateway.scan_wishes[0].to, "9");
    EXPECT_EQ(gateway.scan_wishes[0].family, "demo");
    EXPECT_EQ(gateway.scan_wishes[0].limit, std::chrono::seconds(3));
    gateway.scans[gateway.line("can0")].parts = {{"demo", 3, 9, ""}, {"other", 0, 0, "it cannot be searched for"}};
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/scan").at("families"),
              R"([{"family":"demo","asked":3,"of":9,"text":""},{"family":"other","asked":0,"of":0,"text":"it cannot be searched for"}])");
    EXPECT_EQ(call("DELETE", "/api/v1/lines/can0/scan").at("state"), "cancelled");
    for (const auto* bad : {R"({"limit_s":0})", R"({"limit_s":601})", R"({"from":true})", R"({"family":1})", R"({"x":1})"})
        EXPECT_EQ(call("POST", "/api/v1/lines/can0/scan", bad).status, 422u) << bad;
    gateway.scan_fault = "line can0 is down";
    EXPECT_EQ(call("POST", "/api/v1/lines/can0/scan", "{}").status, 409u);
    EXPECT_EQ(call("POST", "/api/v1/lines/nobody/scan", "{}").status, 404u);
}
}  // namespace
}  // namespace axisgate::http::test
