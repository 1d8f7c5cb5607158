// Alarms over HTTP: the list, acknowledge, shelve, stored and restored alarms, the live feed; events as table and text.
#include <fmt/core.h>

#include "gateway/doors/http/stream_hub.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace json = boost::json;
namespace {
class Alarms : public HttpTest {
protected:
    Alarms() { alarms->begin(); }
    std::uint64_t fault(std::int32_t code = 49, const std::string& axis = "feeder") {
        Event e = event("fault", axis, Severity::alarm, "fault");
        e.code = code;
        gateway.tell(e);
        return gateway.last_event;
    }
    void cleared() { gateway.tell(event("over", "feeder", Severity::info, "fault_cleared")); }
    static Event event(std::string text, std::string axis, Severity severity, std::string kind) {
        Event e;
        e.text = std::move(text);
        e.axis = std::move(axis);
        e.severity = severity;
        e.kind = std::move(kind);
        return e;
    }
    /// The answer comes when it is on the disk; the fake's disk is immediate.
    Answer post(std::string target, std::string body) {
        auto a = call("POST", "/api/v1/alarms" + target, std::move(body));
        return promised ? answered() : a;
    }
    std::string state(std::size_t i = 0) {
        const auto list = call("GET", "/api/v1/alarms");
        const auto& all = list.object().at("alarms").get_array();
        return i < all.size() ? std::string(all[i].at("state").get_string()) : "none";
    }
};

TEST_F(Alarms, AreAcknowledgedByNameAndLeaveWhenCleared) {
    const auto id = fault();
    EXPECT_EQ(state(), "unacknowledged_active");
    const auto a = post(fmt::format("/{}/acknowledge", id), R"({"comment":"guard"})");
    EXPECT_EQ(a.status, 200u) << a.text;
    EXPECT_EQ(a.at("state"), "acknowledged_active");
    EXPECT_EQ(a.at("acknowledged_by"), "127.0.0.1:51123");
    EXPECT_EQ(a.at("comment"), "guard");
    ASSERT_EQ(gateway.noted.size(), 1u);
    EXPECT_EQ(gateway.noted[0].kind, "alarm");
    EXPECT_EQ(gateway.noted[0].who, "127.0.0.1:51123");
    EXPECT_NE(gateway.noted[0].text.find("acknowledged: guard"), std::string::npos);
    EXPECT_EQ(post(fmt::format("/{}/acknowledge", id), "{}").status, 409u);
    cleared();
    EXPECT_EQ(state(), "none");
    EXPECT_EQ(post(fmt::format("/{}/acknowledge", id), "{}").status, 404u);
}

TEST_F(Alarms, ListAndEventsAreNarrowedByState) {
    const auto one = fault(1), two = fault(2, "slide"), three = fault(3, "slide");
    gateway.tell(event("a note", "feeder", Severity::info, "note"));
    cleared();  // one
    EXPECT_EQ(post(fmt::format("/{}/acknowledge", two), "{}").status, 200u);
    EXPECT_EQ(post(fmt::format("/{}/shelve", three), R"({"for_s":60,"reason":"mended"})").status, 200u);
    using Ids = std::vector<std::uint64_t>;
    for (const auto& [state, wanted] : std::vector<std::pair<std::string, Ids>>{
             {"active", {two, three}}, {"cleared", {one}}, {"unacknowledged", {one}}, {"acknowledged", {two}}, {"shelved", {three}}}) {
        Ids listed, published;
        const auto list = call("GET", "/api/v1/alarms?state=" + state);
        for (const auto& a : list.object().at("alarms").get_array())
            listed.push_back(static_cast<std::uint64_t>(a.at("id").to_number<std::int64_t>()));
        std::ranges::sort(listed);
        EXPECT_EQ(listed, wanted) << state;
        EXPECT_EQ(list.at("unacknowledged"), "1") << "the counts are of all";
        const auto events = call("GET", "/api/v1/events?state=" + state);
        for (const auto& e : events.array())
            published.push_back(static_cast<std::uint64_t>(e.at("id").to_number<std::int64_t>()));
        EXPECT_EQ(published, wanted) << state;
    }
    EXPECT_EQ(call("GET", "/api/v1/events?state=active&axis=feeder").array().size(), 0u) << "together with the other filters";
    EXPECT_EQ(call("GET", "/api/v1/events?state=active&limit=1").array().at(0).at("id"), three) << "the newest";
    EXPECT_EQ(call("GET", "/api/v1/events?state=active&limit=1&order=newest").array().at(0).at("id"), three);
    EXPECT_EQ(call("GET", "/api/v1/events?state=active&limit=1&order=oldest").array().at(0).at("id"), two);
    EXPECT_EQ(call("GET", "/api/v1/events?order=backwards").status, 400u);
    std::vector<std::int64_t> read_on;
    for (std::int64_t last = 0; read_on.size() < 100;) {
        const auto page = call("GET", fmt::format("/api/v1/events?limit=2&order=oldest&since={}", last)).array();
        if (page.empty()) break;
        for (const auto& e : page)
            read_on.push_back(last = e.at("id").as_int64());
    }
    const auto whole = call("GET", "/api/v1/events?limit=1000").array();
    ASSERT_EQ(read_on.size(), whole.size()) << "reading on misses nothing";
    for (std::size_t i = 0; i < whole.size(); ++i)
        EXPECT_EQ(whole[i].at("id"), read_on[i]);
    EXPECT_EQ(call("GET", fmt::format("/api/v1/events?state=active&since={}", two)).array().size(), 1u);
    EXPECT_EQ(call("GET", fmt::format("/api/v1/events?state=active&before={}", three)).array().at(0).at("id"), two);
    EXPECT_NE(call("GET", "/api/v1/events?state=shelved&format=csv").text.find("slide"), std::string::npos);
    for (const auto* target :
         {"/api/v1/events?state=loud", "/api/v1/alarms?state=loud", "/api/v1/alarms?state=", "/api/v1/events?state=Active"}) {
        const auto a = call("GET", target);
        EXPECT_EQ(a.status, 400u) << target;
        EXPECT_EQ(a.at("detail"), "state must be active, cleared, unacknowledged, acknowledged or shelved") << target;
    }
}

TEST_F(Alarms, AllOrNoneOfSeveral) {
    const auto one = fault(1), two = fault(2);
    fault(3, "slide");
    EXPECT_EQ(post("/acknowledge", fmt::format(R"({{"ids":[{},999]}})", one)).status, 422u);
    EXPECT_EQ(call("GET", "/api/v1/alarms").at("unacknowledged"), "3");
    for (const auto* bad : {"{}", R"({"all":false})", R"({"all":true,"ids":[1]})", R"({"ids":[]})", R"({"ids":["1"]})",
                            R"({"all":true,"x":1})", R"({"all":true,"comment":5})"})
        EXPECT_EQ(post("/acknowledge", bad).status, 422u) << bad;
    EXPECT_EQ(post("/acknowledge", fmt::format(R"({{"ids":[{},{}]}})", one, one)).at("acknowledged"), "1");
    EXPECT_EQ(post("/acknowledge", fmt::format(R"({{"ids":[{},{}]}})", two, one)).status, 409u);
    EXPECT_EQ(call("GET", "/api/v1/alarms").at("unacknowledged"), "2");
    const auto a = post("/acknowledge", R"({"all":true})");
    EXPECT_EQ(a.at("acknowledged"), "2");
    EXPECT_EQ(a.at("unacknowledged"), "0");
}

TEST_F(Alarms, AShelfEndsByItself) {
    const auto id = fault();
    const auto path = fmt::format("/{}/shelve", id);
    for (const auto* bad : {"{}", R"({"for_s":60})", R"({"for_s":59,"reason":"r"})", R"({"for_s":86401,"reason":"r"})",
                            R"({"for_s":60.5,"reason":"r"})", R"({"for_s":60,"reason":"  "})"})
        EXPECT_EQ(post(path, bad).status, 422u) << bad;
    EXPECT_EQ(post(path, R"({"for_s":60,"reason":"known"})").at("state"), "shelved");
    EXPECT_EQ(post(fmt::format("/{}/acknowledge", id), "{}").status, 409u);
    EXPECT_EQ(call("GET", "/api/v1/alarms").at("unacknowledged"), "0");
    alarms->on_deadline(clock = at_ns(1'000'000'000));  // the list is told
    EXPECT_EQ(alarms->deadline(), clock + std::chrono::seconds(60));
    gateway.now_ns += 60'000'000'000;
    alarms->on_deadline(clock += std::chrono::seconds(60));
    EXPECT_EQ(state(), "unacknowledged_active");
    EXPECT_EQ(post(fmt::format("/{}/unshelve", id), "").status, 409u);
    (void)post(path, R"({"for_s":3600,"reason":"known"})");
    EXPECT_EQ(post(fmt::format("/{}/unshelve", id), "").at("state"), "unacknowledged_active");
}

TEST_F(Alarms, AreFoundAgainAfterARestartWithWhatCameMeanwhile) {
    const auto id = fault();
    (void)post(fmt::format("/{}/acknowledge", id), "{}");
    const auto two = fault(50, "slide");
    (void)post(fmt::format("/{}/shelve", two), R"({"for_s":600,"reason":"known"})");
    alarms->detach();
    Event e = event("line can0 is down", "", Severity::warning, "line");
    e.line = "can0";
    gateway.tell(e);  // in the store, but no listener was there
    auto fresh = std::make_shared<AlarmService>(gateway, [this] { return clock; });
    fresh->begin();
    ASSERT_EQ(fresh->list().all().size(), 3u);
    EXPECT_EQ(fresh->list().find(id)->state(), AlarmState::acknowledged_active);
    EXPECT_EQ(fresh->list().find(id)->acknowledged_by, "127.0.0.1:51123");
    EXPECT_EQ(fresh->list().find(two)->state(), AlarmState::shelved);
    EXPECT_EQ(fresh->list().find(gateway.last_event)->state(), AlarmState::unacknowledged_active);
}

TEST_F(Alarms, OldEventsOfADirectoryWithoutAlarmsAreNoNews) {
    alarms->detach();
    gateway.stored_documents.clear();
    fault();
    auto fresh = std::make_shared<AlarmService>(gateway, [this] { return clock; });
    fresh->begin();
    EXPECT_TRUE(fresh->list().all().empty());
}

TEST_F(Alarms, WhatCannotBeStoredIsSaid) {
    const auto id = fault();
    gateway.document_fault = "the disk is full";
    const auto a = post(fmt::format("/{}/acknowledge", id), "{}");
    EXPECT_EQ(a.status, 507u);
    EXPECT_EQ(gateway.noted.back().kind, "store");
}

TEST_F(Alarms, TheLiveFeedHasTheListAtMostFiveTimesASecond) {
    int published = 0;
    alarms->publish = [&](const json::object&) { ++published; };
    clock = at_ns(5'000'000'000);
    for (int i = 0; i < 100; ++i) {
        fault(i % 3 + 1);
        alarms->on_deadline(clock += std::chrono::milliseconds(10));
    }
    EXPECT_LE(published, 6);
    EXPECT_GE(published, 4);
}

TEST_F(Alarms, EventsAsTableAndText) {
    Event e = event("a \"b\", c\nd", "feeder", Severity::warning, "hold");
    e.who = "=anna";
    gateway.tell(e);
    fault();
    const auto csv = call("GET", "/api/v1/events?format=csv");
    EXPECT_EQ(csv.headers.get("Content-Type"), "text/csv; charset=utf-8");
    EXPECT_TRUE(csv.text.starts_with("id,at,severity,kind,axis,")) << csv.text;
    EXPECT_NE(csv.text.find(R"(,warning,hold,feeder,,,,"a ""b"", c)"), std::string::npos) << csv.text;
    EXPECT_NE(csv.text.find(",'=anna,"), std::string::npos) << csv.text;
    const auto text = call("GET", "/api/v1/events", "", {{"Accept", "text/plain"}});
    EXPECT_EQ(std::ranges::count(text.text, '\n'), 2) << text.text;
    EXPECT_EQ(call("GET", "/api/v1/events?kind=fault").array().size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/events?before=2").array().size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/events?before=x").status, 400u);
    EXPECT_EQ(call("GET", "/api/v1/events?format=xml").status, 400u);
    EXPECT_EQ(call("GET", "/api/v1/events", "", {{"Accept", "image/png"}}).status, 406u);
}
}  // namespace
}  // namespace axisgate::http::test
