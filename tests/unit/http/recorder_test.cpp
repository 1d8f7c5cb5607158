// The recorder over HTTP: trends in units as JSON and CSV, recordings made, renamed, downloaded, deleted; faults are refused.
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

// An axis runs, stands in fault, is silent, and has moved when it answers again: each column of a reduced period shows this, and its end is
// the last known value, not the greatest of the last column.
TEST_F(RecorderOverHttp, AThinnedStretchHasFirstMinMaxAndLastAndItsGaps) {
    constexpr std::int64_t begins_ms = 10'000;  // behind the reports of the fixture
    const AxisId axis = gateway.axis("feeder");
    const auto tell = [&](std::int64_t ms, std::int64_t position, std::int64_t velocity, std::uint16_t flags = 0) {
        PictureRecord p;
        p.current = true;
        p.position = position;
        p.velocity = velocity;
        p.statusword = velocity == 0 ? 0x08 : 0x27;
        p.flags = flags;
        gateway.trends.add(axis, p, at_ns((begins_ms + ms) * 1'000'000));
    };
    for (int ms = 0; ms <= 490; ms += 10)
        tell(ms, 88 * ms, ms == 250 ? 99 : 15);
    tell(495, 88 * 490, 0);              // the fault: it stands
    tell(750, 88 * 490, 0, flag_stale);  // the drive does not answer
    tell(1'520, 88 * 490, 0, flag_stale | flag_warning);
    tell(1'560, 40, 0);
    const auto answer = call("GET", "/api/v1/recorder/trends?axes=feeder&columns=20&points=position,velocity&from=" +
                                        std::to_string(second_ms + begins_ms) + "&to=" + std::to_string(second_ms + begins_ms + 2000));
    ASSERT_EQ(answer.status, 200u) << answer.text;
    const auto& trend = answer.object().at("axes").as_array().at(0).as_object();
    ASSERT_TRUE(trend.at("thinned").as_bool());
    const auto& at = trend.at("at").as_array();
    const auto of = [&](std::string_view point, std::string_view member) -> const boost::json::array& {
        return trend.at("points").as_object().at(point).as_object().at(member).as_array();
    };
    // Columns of 100 ms: five with motion, one in which the drive falls silent, one in which it returns. Unchanged values in between need
    // none.
    ASSERT_EQ(at.size(), 7u) << answer.text;
    const auto numbers = [&](std::string_view member) {
        std::vector<double> out;
        for (const auto& v : of("velocity", member))
            out.push_back(v.is_null() ? -1 : std::round(v.to_number<double>() * 3200));
        return out;
    };
    EXPECT_EQ(numbers("first"), (std::vector<double>{15, 15, 15, 15, 15, 0, -1}));
    EXPECT_EQ(numbers("min"), (std::vector<double>{15, 15, 15, 15, 0, 0, 0}));
    EXPECT_EQ(numbers("max"), (std::vector<double>{15, 15, 99, 15, 15, 0, 0}));
    EXPECT_EQ(numbers("last"), (std::vector<double>{15, 15, 15, 15, 0, -1, 0}));
    EXPECT_EQ(of("velocity", "low"), of("velocity", "min"));
    EXPECT_EQ(of("velocity", "high"), of("velocity", "max"));
    EXPECT_EQ(trend.at("gaps"), (boost::json::array{false, false, false, false, false, true, true}));
    EXPECT_EQ(trend.at("until").as_array().at(4).to_number<double>(), static_cast<double>(second_ms + begins_ms) + 495);
    EXPECT_EQ(trend.at("newest").to_number<double>(), static_cast<double>(second_ms + begins_ms) + 1560);
}

// The position of a silent axis is unknown: it has no value, reduced or not, and the newest one is that before the silence.
TEST_F(RecorderOverHttp, ASilentAxisHasNoValue) {
    PictureRecord p;
    p.position = 3200 * 99;
    p.flags = flag_stale;
    gateway.trends.add(gateway.axis("feeder"), p, at_ns(1'500'000'000));
    const auto answer = call("GET", "/api/v1/recorder/trends?axes=feeder&points=position&from=" + std::to_string(second_ms + 900) +
                                        "&to=" + std::to_string(second_ms + 2000));
    const auto& trend = answer.object().at("axes").as_array().at(0).as_object();
    const auto& values = trend.at("points").as_object().at("position").as_object().at("values").as_array();
    ASSERT_FALSE(values.empty());
    EXPECT_TRUE(values.back().is_null()) << answer.text;
    EXPECT_EQ(trend.at("newest").to_number<double>(), static_cast<double>(second_ms) + 990);
}

TEST_F(RecorderOverHttp, TrendsComeAsCsv) {
    const auto csv = call("GET", stretch("&points=position,state"), "", {{"Accept", "text/csv"}});
    ASSERT_EQ(csv.status, 200u);
    EXPECT_TRUE(csv.text.starts_with("time,axis,unit,position_low,position_high,state,position_first,position_last\r\n2026-01-02T03:04:05"))
        << csv.text.substr(0, 200);
    EXPECT_NE(csv.text.find(",feeder,mm,99,99,operation_enabled,99,99\r\n"), std::string::npos);
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
    EXPECT_EQ(gateway.noted.back().text, "recording crash was renamed to kept");
    EXPECT_EQ(call("DELETE", "/api/v1/recorder/recordings/kept").status, 204u);
    EXPECT_EQ(gateway.noted.back().text, "recording kept was deleted");
    EXPECT_EQ(gateway.noted.back().kind, "recording");
    EXPECT_EQ(gateway.noted.back().who, "127.0.0.1:51123");
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
