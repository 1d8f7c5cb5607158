// The recorder over HTTP: trends in units as JSON and CSV, recordings made, renamed, handed out, deleted; what is wrong is refused.
// In: a gateway without a disk. Out: answers. Never waits.
#include <gtest/gtest.h>

#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {

constexpr std::int64_t second_ms = 1'767'323'045'000;  // the instant 0 of the fake clock

class RecorderOverHttp : public HttpTest {
protected:
    void SetUp() override {
        for (int i = 0; i < 100; ++i) {
            PictureRecord p;
            p.current = true;
            p.position = 3200 * i;
            p.demand = 3200 * i + 1600;
            p.demand_source = DemandSource::drive;
            p.statusword = 0x27;
            gateway.trends.add(gateway.axis("feeder"), p, at_ns(i * 10'000'000));
        }
    }
    static std::string stretch(const std::string& more) {
        return "/api/v1/recorder/trends?axes=feeder&from=" + std::to_string(second_ms) + "&to=" + std::to_string(second_ms + 1000) + more;
    }
};

TEST_F(RecorderOverHttp, TrendsAreToldInUnitsAndThinnedToColumns) {
    const auto whole = call("GET", stretch("&points=position,following_error,state"));
    ASSERT_EQ(whole.status, 200u) << whole.text;
    const auto& axis = whole.object().at("axes").as_array().at(0).as_object();
    EXPECT_EQ(axis.at("thinned").as_bool(), false);
    ASSERT_EQ(axis.at("at").as_array().size(), 100u);
    EXPECT_EQ(axis.at("at").as_array().at(50).to_number<double>(), static_cast<double>(second_ms) + 500);
    const auto& points = axis.at("points").as_object();
    EXPECT_EQ(points.size(), 3u);
    EXPECT_EQ(points.at("position").as_object().at("values").as_array().at(50).to_number<double>(), 50);
    EXPECT_EQ(points.at("following_error").as_object().at("values").as_array().at(50).to_number<double>(), 0.5);
    EXPECT_EQ(points.at("state").as_object().at("values").as_array().at(50).as_string(), "operation_enabled");
    const auto thin = call("GET", stretch("&columns=10&points=position"));
    const auto& columns = thin.object().at("axes").as_array().at(0).as_object().at("points").as_object().at("position").as_object();
    ASSERT_EQ(columns.at("low").as_array().size(), 10u);
    EXPECT_EQ(columns.at("high").as_array().at(9).to_number<double>(), 99);
}

TEST_F(RecorderOverHttp, TrendsComeAsCsv) {
    const auto csv = call("GET", stretch("&points=position,state"), "", {{"Accept", "text/csv"}});
    ASSERT_EQ(csv.status, 200u);
    EXPECT_TRUE(csv.text.starts_with("time,axis,unit,position_low,position_high,state\r\n2026-01-02T03:04:05")) << csv.text.substr(0, 200);
    EXPECT_NE(csv.text.find(",feeder,mm,99,99,operation_enabled\r\n"), std::string::npos);
}

TEST_F(RecorderOverHttp, WhatIsWrongIsNamed) {
    EXPECT_EQ(call("GET", "/api/v1/recorder/trends?axes=nobody").status, 404u);
    for (const auto* query : {"points=speed", "columns=0", "columns=5001", "from=-1", "to=x"}) {
        const auto a = call("GET", std::string("/api/v1/recorder/trends?") + query);
        EXPECT_EQ(a.status, 400u) << query;
    }
    for (const auto* times : {"from=0&to=9223372036854", "from=9223372036854&to=9223372036854", "from=9223372036854&to=0"})
        EXPECT_EQ(call("GET", std::string("/api/v1/recorder/trends?axes=feeder&") + times).status, 200u) << times;
    EXPECT_EQ(call("GET", "/api/v1/recorder/trends", "", {{"Accept", "image/png"}}).status, 406u);
    for (const auto* body : {R"({})", R"({"name":"../x"})", R"({"name":1})", R"({"name":"a","x":1})"})
        EXPECT_EQ(call("POST", "/api/v1/recorder/recordings", body).status, 422u) << body;
    EXPECT_EQ(call("GET", "/api/v1/recorder/recordings/none").status, 404u);
    EXPECT_EQ(call("DELETE", "/api/v1/recorder/recordings/none").status, 404u);
}

TEST_F(RecorderOverHttp, ARecordingIsMadeHandedOutRenamedAndDeleted) {
    const auto made = call("POST", "/api/v1/recorder/recordings", R"({"name":"crash","why":"it hit its stop"})");
    ASSERT_EQ(made.status, 201u) << made.text;
    EXPECT_EQ(made.at("why"), "it hit its stop");
    EXPECT_EQ(call("GET", "/api/v1/recorder/recordings/crash").text, "the file");
    EXPECT_EQ(call("GET", "/api/v1/recorder/recordings/crash", "", {{"Accept", "application/json"}}).at("name"), "crash");
    EXPECT_EQ(call("PATCH", "/api/v1/recorder/recordings/crash", R"({"name":"kept"})").at("name"), "kept");
    EXPECT_EQ(call("GET", "/api/v1/recorder/recordings").object().at("recordings").as_array().size(), 1u);
    EXPECT_EQ(call("DELETE", "/api/v1/recorder/recordings/kept").status, 204u);
    gateway.next_fault = {RecordingFault::Kind::no_room, "the disk is full"};
    const auto full = call("POST", "/api/v1/recorder/recordings", R"({"name":"crash"})");
    EXPECT_EQ(full.status, 507u);
    EXPECT_NE(full.text.find("the disk is full"), std::string::npos);
}

TEST_F(RecorderOverHttp, ACaptureIsArmedInUnitsAndHandedOutAsBoth) {
    const std::string path = "/api/v1/recorder/captures";
    const auto armed = call("POST", path, R"({"name":"before","axes":["feeder"],"rate_hz":500,"before_ms":50,"after_ms":100,
        "trigger":{"kind":"level","point":"position","level":1.5,"edge":"falling"}})");
    ASSERT_EQ(armed.status, 201u) << armed.text;
    EXPECT_EQ(armed.at("state"), "armed");
    const auto& order = gateway.running.at(0).first;
    EXPECT_EQ(order.wish.trigger.level, 4800);
    EXPECT_FALSE(order.wish.trigger.rising);
    EXPECT_EQ(order.wish.period, std::chrono::milliseconds(2));
    EXPECT_EQ(order.line, "can0");
    auto& capture = gateway.running.at(0).second;
    for (int i = 0; i < 10; ++i) {
        PictureRecord p;
        p.current = true;
        p.position = 3200 * (5 - i);
        capture.on_picture(gateway.axis("feeder"), p, Instant(std::chrono::seconds(1) + i * std::chrono::milliseconds(2)));
    }
    const auto whole = call("GET", path + "/before");
    EXPECT_EQ(whole.at("state"), "triggered");
    EXPECT_EQ(whole.object().at("columns").as_array().at(0).as_object().at("position").as_array().at(0).to_number<double>(), 5);
    const auto csv = call("GET", path + "/before", "", {{"Accept", "text/csv"}});
    EXPECT_TRUE(csv.text.starts_with("seconds,axis,unit,position,")) << csv.text;
    EXPECT_EQ(call("PATCH", path + "/before", R"({"name":"tuned"})").at("name"), "tuned");
    EXPECT_EQ(call("GET", path).object().at("captures").as_array().size(), 1u);
    EXPECT_EQ(call("GET", path + "/before").status, 404u);
    EXPECT_EQ(call("DELETE", path + "/tuned").status, 204u);
    EXPECT_EQ(call("DELETE", path + "/tuned").status, 404u);
}

TEST_F(RecorderOverHttp, WishesForCapturesThatAreNoneAreNamed) {
    const std::string path = "/api/v1/recorder/captures";
    for (const auto& [body, place] : std::vector<std::pair<std::string, std::string>>{
             {R"({"axes":["feeder"]})", "/name"},
             {R"({"name":"a/b","axes":["feeder"]})", "/name"},
             {R"({"name":"a"})", "/axes"},
             {R"({"name":"a","axes":[]})", "/axes"},
             {R"({"name":"a","axes":["nobody"]})", "/axes/0"},
             {R"({"name":"a","axes":["feeder","feeder"]})", "/axes/1"},
             {R"({"name":"a","axes":["feeder"],"rate_hz":1001})", "/rate_hz"},
             {R"({"name":"a","axes":["feeder"],"before_ms":70000,"after_ms":70000})", "/after_ms"},
             {R"({"name":"a","axes":["feeder","slide"],"after_ms":110000})", "/after_ms"},
             {R"({"name":"a","axes":["feeder"],"trigger":{"kind":"moon"}})", "/trigger/kind"},
             {R"({"name":"a","axes":["feeder"],"trigger":{"kind":"level"}})", "/trigger/level"},
             {R"({"name":"a","axes":["feeder"],"trigger":{"kind":"level","level":1e300}})", "/trigger/level"},
             {R"({"name":"a","axes":["feeder"],"trigger":{"kind":"level","level":1,"point":"torque"}})", "/trigger/point"},
             {R"({"name":"a","axes":["feeder"],"trigger":{"kind":"state","state":"sad"}})", "/trigger/state"},
             {R"({"name":"a","axes":["feeder"],"trigger":{"kind":"command","axis":"slide"}})", "/trigger/axis"},
             {R"({"name":"a","axes":["feeder"],"trigger":7})", "/trigger"},
             {R"({"name":"a","axes":["feeder"],"colour":"red"})", "/colour"}}) {
        const auto a = call("POST", path, body);
        EXPECT_EQ(a.status, 422u) << body << a.text;
        EXPECT_NE(a.text.find("\"" + place + "\""), std::string::npos) << body << a.text;
    }
    EXPECT_EQ(gateway.running.size(), 0u);
    gateway.capture_fault = {RecordingFault::Kind::busy, "another runs"};
    EXPECT_EQ(call("POST", path, R"({"name":"a","axes":["feeder"]})").status, 503u);
    EXPECT_EQ(call("POST", path, R"({"name":"a","axes":["feeder"]})").status, 201u);
    gateway.capture_fault = {RecordingFault::Kind::damaged, "the recording was altered"};
    EXPECT_EQ(call("GET", path + "/a").status, 409u);
    EXPECT_EQ(call("GET", path + "/a", "", {{"Accept", "image/png"}}).status, 406u);
}

}  // namespace
}  // namespace axisgate::http::test
