// Handlers with a fake gateway: the program itself, catalogue, axes' documents, commands, the live feed's handshake.
#include <algorithm>

#include "gateway/core/text.hpp"
#include "gateway/doors/http/words.hpp"
#include "gateway/doors/modbus/words.hpp"
#include "gateway/services/documents.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
namespace json = boost::json;

// --- the program itself -----------------------------------------------------------------------------------------------

TEST_F(HttpTest, HealthReadyMetrics) {
    EXPECT_EQ(call("GET", "/healthz").text, R"({"status":"ok","uptime_s":12.5})");
    EXPECT_EQ(call("GET", "/readyz").text, R"({"ready":true,"missing":[]})");
    gateway.missing = {"line can0 is down", "the database is locked"};
    const auto a = call("GET", "/readyz");
    EXPECT_EQ(a.status, 503u);
    EXPECT_EQ(a.headers.get("Content-Type"), "application/problem+json");
    EXPECT_EQ(a.headers.get("Retry-After"), "1");
    EXPECT_EQ(a.at("ready"), "false");
    EXPECT_EQ(a.at("detail"), "line can0 is down; the database is locked");
    EXPECT_EQ(a.object().at("missing").get_array().size(), 2u);
    const auto m = call("GET", "/metrics");
    EXPECT_EQ(m.headers.get("Content-Type"), "text/plain; version=0.0.4; charset=utf-8");
    EXPECT_EQ(m.text, gateway.metrics() + "axisgate_http_own 1\n");
}

TEST_F(HttpTest, About) {
    settings.version = "1.2.3";
    const auto a = call("GET", "/api/v1/about");
    EXPECT_EQ(a.at("name"), "axisgate");
    EXPECT_EQ(a.at("version"), "1.2.3");
    EXPECT_EQ(a.at("uptime_s"), "12.5");
    EXPECT_EQ(a.at("now"), "2026-01-02T03:04:05.678901Z");
    EXPECT_EQ(a.at("families"), R"(["demo"])");
    EXPECT_EQ(a.at("doors"), R"([{"name":"http","address":"127.0.0.1:8080"},{"name":"modbus","address":"127.0.0.1:1502"}])");
    EXPECT_EQ(a.at("axes"), "2");
    EXPECT_EQ(call("GET", "/api/v1/openapi.yaml").text, "openapi: 3.0.3\n");
    files.erase("schema/openapi.yaml");
    EXPECT_EQ(call("GET", "/api/v1/openapi.yaml").status, 404u);
}

TEST_F(HttpTest, Catalogue) {
    EXPECT_EQ(call("GET", "/api/v1/families").array().size(), 1u);
    const auto f = call("GET", "/api/v1/families/demo");
    EXPECT_EQ(f.at("number"), "7");
    EXPECT_EQ(f.at("title"), "Demo drive") << "whatever else the catalogue says";
    EXPECT_EQ(f.at("parameters"), "6") << "how many, not the list";
    EXPECT_EQ(f.at("factory_address"), "5");
    EXPECT_EQ(f.at("default_bit_rate"), "57600");
    const auto p = call("GET", "/api/v1/families/demo/parameters").array();
    ASSERT_EQ(p.size(), 6u);
    EXPECT_EQ(
        json_text(p[0]),
        R"({"id":"AC","name":"acceleration","group":"motion","type":"u32","unit":"pulse/s^2","min":1,"max":65000000,"default":20000,"access":"RW",)"
        R"("storage":"eeprom","addressing":false,"live":false,"description":"Acceleration of motions.","allowed":null,"fields":null,"meanings":null,"alternate":null,"choice":[],"first":null,"count":null,"selector":0})");
    EXPECT_EQ(
        json_text(p[1]),
        R"({"id":"ML","name":"model","group":"identity","type":"text","unit":null,"min":null,"max":null,"default":null,"access":"R",)"
        R"("storage":null,"addressing":false,"live":false,"description":"Model name.","allowed":null,"fields":null,"meanings":null,"alternate":null,"choice":[],"first":null,"count":null,"selector":null})");
    EXPECT_EQ(json_text(p[3].at("allowed")), R"([{"value":1,"meaning":"full"},{"value":16,"meaning":"sixteenth"}])");
    EXPECT_EQ(json_text(p[4].at("first")) + json_text(p[4].at("count")), "18");
    EXPECT_EQ(json_text(p[4].at("selector")), std::to_string(65536 + 4)) << "of its first element";
    EXPECT_EQ(
        call("GET", "/api/v1/families/demo/commands").text,
        R"([{"id":"BG","name":"begin","description":"Starts.","completes":"acknowledged","confirm":"The axis moves.","arguments":[]},)"
        R"({"id":"GO","name":"go","description":null,"completes":"acknowledged","confirm":null,"arguments":[)"
        R"({"name":"position","type":"i32","unit":"mm","scale":0.0001,"min":null,"max":null,"default":null,"description":null},)"
        R"({"name":"speed","type":"u16","unit":null,"scale":1,"min":null,"max":null,"default":5,"description":null}]}])");
    EXPECT_EQ(
        call("GET", "/api/v1/families/demo/errors").text,
        R"([{"code":49,"through":null,"kind":"error","name":"overcurrent","text":"too much current","cause":"short","remedy":"look"}])");
    for (const auto* path :
         {"/api/v1/families/x", "/api/v1/families/x/parameters", "/api/v1/families/x/commands", "/api/v1/families/x/errors"})
        EXPECT_EQ(call("GET", path).status, 404u);
}

TEST_F(HttpTest, SpecimensOfAFamily) {
    EXPECT_EQ(
        call("GET", "/api/v1/families/demo").at("freedoms"),
        R"([{"name":"reply_ms","unit":"ms","min":0,"max":200,"default":0,"values":{},"named":{"slow":200},"source":"silent","description":"an answer comes this late"},)"
        R"({"name":"echo","unit":null,"min":0,"max":1,"default":1,"values":{"0":"off","1":"on"},"named":{},"source":"L12","description":"commands are repeated"}])");
    EXPECT_EQ(
        call("GET", "/api/v1/families/demo/specimens/slow").text,
        R"({"family":"demo","specimen":"slow","values":{"reply_ms":200,"echo":1},"words":["reply_ms = 200 ms: an answer comes this late"]})");
    EXPECT_EQ(call("GET", "/api/v1/families/demo/specimens/0").text,
              R"({"family":"demo","specimen":"0","values":{"reply_ms":0,"echo":1},"words":[]})");
    bool differs = false;  // half of the freedoms of a seed keep the manual's value, so one of a few seeds has another echo
    for (int seed = 1; seed < 10 && !differs; ++seed)
        differs = call("GET", "/api/v1/families/demo/specimens/" + std::to_string(seed)).text.find("echo = 0 (off)") != std::string::npos;
    EXPECT_TRUE(differs);
    const auto none = call("GET", "/api/v1/families/demo/specimens/fast");
    EXPECT_EQ(none.status, 404u);
    EXPECT_NE(none.text.find("write a seed from 0"), std::string::npos) << none.text;
    EXPECT_EQ(call("GET", "/api/v1/families/x/specimens/1").status, 404u);
}

// --- axes -------------------------------------------------------------------------------------------------------------

TEST_F(HttpTest, AxisDocument) {
    auto p = standing(12345);
    p.velocity = -6400;
    p.error_code = 49;
    p.flags |= flag_moving | flag_warning;
    gateway.set_picture("feeder", p);
    const auto a = call("GET", "/api/v1/axes/feeder");
    const auto expect = [&a](const char* key, const char* want) { EXPECT_EQ(a.at(key), want) << key; };
    expect("name", "feeder");
    expect("drive", "feeder");
    expect("line", "can0");
    expect("family", "demo");
    expect("channel", "1");
    expect("number", "1");
    expect("unit", "mm");
    expect("increments_per_unit", "3200");
    expect("online", "true");
    expect("simulated", "true");
    expect("stale", "false");
    expect("presence", "twin");
    expect("state", "operation_enabled");
    expect("statusword", "38455");
    expect("mode", "profile_position");
    expect("mode_number", "1");
    expect("moving", "true");
    expect("target_reached", "true");
    expect("referenced", "true");
    expect("warning", "true");
    expect("fault", "false");
    expect("position", "3.8578125");
    expect("position_increments", "12345");
    expect("velocity", "-2");
    expect("velocity_increments", "-6400");
    expect("target_position", "3.8578125");
    expect("error", R"({"code":49,"text":"too much current"})");
    expect("native", "4660");
    expect("authority", "http");
    expect("setpoints_accepted", "3");
    expect("at", "2026-01-02T03:04:05.600000Z");
    expect("age_ms", "78");
    EXPECT_EQ(a.headers.get("Site-Revision"), "1");
    EXPECT_EQ(call("GET", "/api/v1/axes").array().size(), 2u);
    EXPECT_EQ(json_text(call("GET", "/api/v1/axes").array()[0]), a.text) << "list and item say the same";
    EXPECT_EQ(call("GET", "/api/v1/axes/none").status, 404u);
}

TEST_F(HttpTest, WhatADriveNeverSaidIsNull) {
    const auto a = call("GET", "/api/v1/axes/slide");
    for (const auto* key : {"position", "velocity", "position_demand", "following_error", "demand_source", "target_position",
                            "position_increments", "velocity_increments", "at", "age_ms"})
        EXPECT_EQ(a.at(key), "null") << key;
    EXPECT_EQ(a.at("online"), "false");
    EXPECT_EQ(a.at("state"), "not_ready_to_switch_on");
    EXPECT_EQ(a.at("mode"), "none");
    EXPECT_EQ(a.at("error"), R"({"code":0,"text":""})");
    EXPECT_EQ(a.at("presence"), "offline");
    EXPECT_EQ(a.at("unit"), "");
}

TEST_F(HttpTest, ADemandIsShownWithWhoseWordItIs) {
    struct Row {
        DemandSource source;
        const char *name, *demand, *error;
    };
    for (const Row& row :
         {Row{DemandSource::none, "null", "null", "null"}, Row{DemandSource::drive, "drive", "1300", "300"},
          Row{DemandSource::computed, "computed", "1300", "300"}, Row{DemandSource::open_loop, "open_loop", "1000", "null"}}) {
        auto p = standing(1000);
        p.demand_source = row.source;
        if (p.following_error_known()) p.position_demand = 1300;
        gateway.set_picture("slide", p);
        const auto a = call("GET", "/api/v1/axes/slide");
        EXPECT_EQ(a.at("demand_source"), row.name);
        EXPECT_EQ(a.at("demand_known"), row.source == DemandSource::none ? "false" : "true") << row.name;
        EXPECT_EQ(a.at("position_demand_increments"), row.demand) << row.name;
        EXPECT_EQ(a.at("following_error_increments"), row.error) << row.name;
        EXPECT_EQ(a.at("position_demand") == "null", row.source == DemandSource::none) << row.name;
        EXPECT_EQ(a.at("following_error") == "null", std::string_view(row.error) == "null") << row.name;
    }
}

TEST_F(HttpTest, ErrorsThatTheCatalogueDoesNotKnow) {
    auto p = standing(0);
    p.error_code = 50;
    gateway.set_picture("slide", p);
    EXPECT_EQ(call("GET", "/api/v1/axes/slide").at("error"), R"({"code":50,"text":"not in the catalogue"})");
}

TEST_F(HttpTest, AnAxisIsTextOncePerPicture) {
    gateway.set_picture("slide", standing(10, 100));
    const auto age = [&] { return std::stol(call("GET", "/api/v1/axes/slide").at("age_ms")); };
    const auto first = age();
    const int read = gateway.pictures_read;
    gateway.now_ns += 250'000'000;
    EXPECT_EQ(age(), first + 250) << "the same picture grows older";
    EXPECT_EQ(gateway.pictures_read, read) << "and is not read again";
    // One axis has the same members in the same order as in the list of all axes.
    const auto list = call("GET", "/api/v1/axes").array();
    for (const auto& axis : list) {
        const std::string name(axis.at("name").as_string());
        EXPECT_EQ(call("GET", "/api/v1/axes/" + name).text, json_text(axis));
    }
    // Another picture, the same age.
    gateway.set_picture("slide", standing(11, 100));
    EXPECT_EQ(call("GET", "/api/v1/axes/slide").at("position_increments"), "11");
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder").at("name"), "feeder") << "one axis' text is not another's";
    // Another site, the same picture.
    EXPECT_EQ(call("PATCH", "/api/v1/axes/slide", R"({"unit":"inch"})").status, 200u);
    EXPECT_EQ(call("GET", "/api/v1/axes/slide").at("unit"), "inch");
}

TEST_F(HttpTest, AgesAreNeverNegative) {
    gateway.set_picture("slide", standing(0, 5000));
    EXPECT_EQ(call("GET", "/api/v1/axes/slide").at("age_ms"), "0");
}

TEST(HttpDocuments, StatesAndModes) {
    struct Row {
        std::uint16_t statusword;
        const char* state;
    };
    FakeGateway gateway;
    const auto place = axis_at(gateway, gateway.site(), 0);
    for (const auto& [word, state] : {Row{0x0000, "not_ready_to_switch_on"}, Row{0x0040, "switch_on_disabled"},
                                      Row{0x0021, "ready_to_switch_on"}, Row{0x0023, "switched_on"}, Row{0x0027, "operation_enabled"},
                                      Row{0x0007, "quick_stop_active"}, Row{0x000F, "fault_reaction_active"}, Row{0x0008, "fault"},
                                      Row{0xC1B7, "operation_enabled"}, Row{0x0950, "switch_on_disabled"}}) {
        AxisPicture p;
        p.statusword = word;
        EXPECT_EQ(axis_document({place.spec(), "", "", nullptr, p}).at("state"), state) << word;
    }
    EXPECT_EQ(mode_name(0), "none");
    EXPECT_EQ(mode_name(3), "profile_velocity");
    EXPECT_EQ(mode_name(6), "homing");
    EXPECT_EQ(mode_name(-1), "other");
}

TEST(HttpDocuments, ALatchedStopNamesItsClientAndWhatMovesTheAxisAgain) {
    FakeGateway gateway;
    const auto place = axis_at(gateway, gateway.site(), 0);
    AxisPicture p;
    const auto said = [&] {
        const auto o = axis_document({place.spec(), "", "", nullptr, p});
        return std::pair{json_text(o.at("stop_latch_by")), json_text(o.at("stop_latch_text"))};
    };
    const auto begins = [](const std::string& text, std::string_view with) { return text.starts_with("\"" + std::string(with) + ": "); };
    EXPECT_EQ(said(), (std::pair<std::string, std::string>{"null", "null"}));
    p.stop_latch = 0b101;
    EXPECT_TRUE(begins(said().second, "another client has stopped it")) << "of a recording that did not keep the name";
    constexpr std::string_view who = "modbus 192.0.2.7";
    std::ranges::copy(who, p.stop_latch_by.begin());
    EXPECT_EQ(said().first, "\"modbus 192.0.2.7\"");
    EXPECT_TRUE(begins(said().second, "modbus 192.0.2.7 has stopped it")) << said().second;
    p.stop_latch_by = {};
    p.stop_latch = 0b011;
    EXPECT_TRUE(begins(said().second, "the gateway has stopped it")) << said().second;
    p.fail_safe_cause = static_cast<std::uint16_t>(modbus::loss_silent);
    EXPECT_TRUE(begins(said().second, "the gateway (modbus_silent) has stopped it")) << said().second;
    p.stop_latch = 0b1001;
    EXPECT_NE(said().second.find("give the input back, then enable the axis"), std::string::npos) << said().second;
}

// --- commands ---------------------------------------------------------------------------------------------------------

TEST_F(HttpTest, ACommandIsAnsweredWhenTheDriveAcknowledges) {
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/commands", R"({"command":"move_absolute","position":100,"velocity":50})").status, 0u)
        << "still to come";
    EXPECT_TRUE(promised);
    EXPECT_EQ(limit, std::chrono::seconds(30));
    EXPECT_EQ(at_limit.status, 504u);
    ASSERT_EQ(gateway.submitted.size(), 1u);
    const Command& c = gateway.submitted[0];
    EXPECT_EQ(c.axis, gateway.axis("feeder"));
    EXPECT_FALSE(c.until_done);
    EXPECT_EQ(c.origin.door, http::clients);
    EXPECT_EQ(*c.origin.who, "127.0.0.1:51123");
    EXPECT_EQ(std::get<Move>(c.body).target, 320000);
    gateway.finish(good_result());
    const auto a = answered();
    EXPECT_EQ(a.status, 200u);
    EXPECT_EQ(
        a.text,
        R"({"ticket":17,"result":"accepted","reason":"","axis":"feeder","command":"move_absolute","code":null,"text":"","value":null})");
    EXPECT_EQ(a.headers.get("X-Content-Type-Options"), "nosniff") << "late answers are finished too";
}

TEST_F(HttpTest, WaitingForTheEnd) {
    call("POST", "/api/v1/axes/feeder/commands?wait=2.5", R"({"command":"home","method":35})");
    EXPECT_TRUE(gateway.submitted[0].until_done);
    EXPECT_EQ(limit, std::chrono::milliseconds(2500));
    EXPECT_EQ(at_limit.status, 200u);
    EXPECT_EQ(
        at_limit.body,
        R"({"ticket":17,"result":"accepted","reason":"not done after 2.5 s","axis":"feeder","command":"home","code":null,"text":"","value":null})");
    gateway.finish(good_result(Outcome::done));
    EXPECT_EQ(answered().at("result"), "done");
    call("POST", "/api/v1/axes/feeder/commands?wait=0", R"({"command":"enable"})");
    EXPECT_FALSE(gateway.submitted[1].until_done);
    for (const auto* bad : {"-1", "301", "x", "", "nan", "1s"}) {
        EXPECT_EQ(call("POST", "/api/v1/axes/feeder/commands?wait=" + std::string(bad), R"({"command":"enable"})").status, 400u) << bad;
    }
    EXPECT_EQ(gateway.submitted.size(), 2u);
}

TEST_F(HttpTest, ReasonsBecomeStatusCodes) {
    struct Row {
        Reason reason;
        unsigned status;
    };
    for (const auto& [reason, status] :
         {Row{Reason::out_of_range, 422}, Row{Reason::unknown_point, 404}, Row{Reason::not_writable, 409}, Row{Reason::wrong_state, 409},
          Row{Reason::not_supported, 409}, Row{Reason::drive_refused, 409}, Row{Reason::busy, 503}, Row{Reason::line_down, 503},
          Row{Reason::no_answer, 504}, Row{Reason::interrupted, 409}, Row{Reason::authority, 409}, Row{Reason::not_stored, 507},
          Row{Reason::internal, 500}, Row{Reason::none, 500}}) {
        gateway.at_once = [reason = reason](const Command&) { return bad_result(reason, "because", 49); };
        const auto a = call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})");
        EXPECT_EQ(a.status, status) << name_of(reason);
        EXPECT_EQ(a.headers.get("Content-Type"), "application/problem+json");
        EXPECT_EQ(a.at("reason"), reason == Reason::none ? "internal" : name_of(reason));
        EXPECT_EQ(a.at("detail"), "because");
        EXPECT_EQ(a.at("code"), "49") << "the drive's own";
        EXPECT_EQ(a.at("axis"), "feeder");
        EXPECT_EQ(a.at("result"), "refused");
        EXPECT_EQ(a.at("command"), "enable");
        EXPECT_NE(a.at("ticket"), "null");
        EXPECT_EQ(a.headers.get("Retry-After"), status == 503 ? "1" : "") << name_of(reason);
    }
    gateway.at_once = [](const Command&) { return bad_result(Reason::interrupted, "", 0, Outcome::failed); };
    const auto a = call("POST", "/api/v1/axes/feeder/commands", R"({"command":"enable"})");
    EXPECT_EQ(a.at("result"), "failed");
    EXPECT_EQ(a.at("code"), "null");
    EXPECT_NE(a.at("detail"), "") << "never without a word";
}

TEST_F(HttpTest, WrongCommandsNeverLeave) {
    const auto a = call("POST", "/api/v1/axes/feeder/commands", R"({"command":"move_absolute","position":1,"velocity":-5})");
    EXPECT_EQ(a.status, 422u);
    EXPECT_EQ(a.at("reason"), "out_of_range");
    EXPECT_EQ(a.at("result"), "refused");
    EXPECT_EQ(a.at("ticket"), "null");
    EXPECT_EQ(a.fault().at("pointer"), "/velocity");
    EXPECT_EQ(a.fault().at("document"), "body");
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/commands", R"({"command":"fly"})").at("reason"), "invalid");
    EXPECT_EQ(call("POST", "/api/v1/axes/none/commands", R"({"command":"enable"})").status, 404u);
    EXPECT_TRUE(gateway.submitted.empty());
}

TEST_F(HttpTest, AResultCarriesTextCodeAndValue) {
    gateway.at_once = [](const Command&) {
        Result r;
        r.outcome = Outcome::done;
        r.text = "\xFFpeed 5";
        r.code = 3;
        r.value = Value{2.5};
        return r;
    };
    const auto a = call("POST", "/api/v1/axes/feeder/commands", R"({"command":"halt"})");
    EXPECT_EQ(a.at("text"), "\xEF\xBF\xBDpeed 5") << "bytes of a drive that are not UTF-8 do not break the JSON";
    EXPECT_EQ(a.at("code"), "3");
    EXPECT_EQ(a.at("value"), "2.5");
}

TEST_F(HttpTest, Actions) {
    gateway.at_once = [](const Command&) { return good_result(Outcome::done); };
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions?wait=1", R"({"name":"program.start","argument":"1"})").at("command"),
              "program.start");
    const auto& action = std::get<Action>(gateway.submitted[0].body);
    EXPECT_EQ(action.name, "program.start");
    EXPECT_EQ(action.argument, "1");
    EXPECT_TRUE(gateway.submitted[0].until_done);
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions", R"({"name":"x"})").status, 200u);
    for (const auto* bad : {R"({})", R"({"name":""})", R"({"name":5})", R"({"name":"x","argument":5})", R"({"name":"x","extra":1})"}) {
        EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions", bad).status, 422u) << bad;
    }
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions", R"({"name":")" + std::string(129, 'x') + R"("})").status, 422u);
    EXPECT_EQ(call("POST", "/api/v1/axes/none/actions", R"({"name":"x"})").status, 404u);
    EXPECT_EQ(gateway.submitted.size(), 2u);
}

TEST_F(HttpTest, ActionsWithArgumentsByName) {
    gateway.at_once = [](const Command&) { return good_result(Outcome::done); };
    const auto values = [&] { return std::get<Action>(gateway.submitted.back().body).values; };
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions", R"({"name":"go","arguments":{"position":12.5}})").status, 200u);
    EXPECT_EQ(values(), (std::vector<Value>{std::int64_t{125000}, std::int64_t{5}}));
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions", R"({"name":"GO","argument":"position=-1 speed=7"})").status, 200u);
    EXPECT_EQ(values(), (std::vector<Value>{std::int64_t{-10000}, std::int64_t{7}}));
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions", R"({"name":"begin","arguments":{}})").status, 200u);
    ASSERT_EQ(gateway.submitted.size(), 3u);
    const auto wrong = call("POST", "/api/v1/axes/feeder/actions", R"({"name":"go","arguments":{"speed":70000,"x":1}})");
    EXPECT_EQ(wrong.status, 422u);
    for (const auto* place : {"/arguments/x", "/arguments/position", "/arguments/speed"})
        EXPECT_NE(wrong.text.find(place), std::string::npos) << place;
    for (const auto* bad : {R"({"name":"go","arguments":[]})", R"({"name":"go","argument":"position=1","arguments":{"position":1}})",
                            R"({"name":"go"})", R"({"name":"begin","arguments":{"a":1}})", R"({"name":"unlisted","arguments":{"a":1}})"}) {
        EXPECT_EQ(call("POST", "/api/v1/axes/feeder/actions", bad).status, 422u) << bad;
    }
    EXPECT_EQ(gateway.submitted.size(), 3u) << "nothing wrong reaches a drive";
}

TEST_F(HttpTest, StartingTogether) {
    gateway.at_once = [](const Command&) { return good_result(); };
    const auto a = call("POST", "/api/v1/moves/start", R"({"axes":["slide","feeder"]})");
    EXPECT_EQ(a.status, 200u);
    EXPECT_EQ(a.at("axis"), "slide");
    EXPECT_EQ(gateway.submitted[0].axis, gateway.axis("slide"));
    EXPECT_EQ(std::get<StartTogether>(gateway.submitted[0].body).axes,
              (std::vector<AxisId>{gateway.axis("slide"), gateway.axis("feeder")}));
    struct Row {
        const char* body;
        const char* pointer;
    };
    for (const auto& [body, pointer] : {Row{R"({})", "/axes"}, Row{R"({"axes":[]})", "/axes"}, Row{R"({"axes":"slide"})", "/axes"},
                                        Row{R"({"axes":["slide",5]})", "/axes/1"}, Row{R"({"axes":["none"]})", "/axes/0"},
                                        Row{R"({"axes":["slide","slide"]})", "/axes/1"}, Row{R"({"axes":["slide"],"x":1})", "/x"}}) {
        const auto r = call("POST", "/api/v1/moves/start", body);
        EXPECT_EQ(r.status, 422u) << body;
        EXPECT_EQ(r.fault().at("pointer"), pointer) << body;
    }
    auto site = gateway.site()->site;
    site.axes.push_back(axis_spec("other", "bare", 3));
    gateway.put_site(site);
    const auto r = call("POST", "/api/v1/moves/start", R"({"axes":["slide","other"]})");
    EXPECT_EQ(r.status, 422u);
    EXPECT_NE(r.at("detail").find("can1"), std::string::npos) << r.at("detail");
    EXPECT_EQ(gateway.submitted.size(), 1u);
}

// --- the handshake of the live feed -----------------------------------------------------------------------------------

TEST_F(HttpTest, StreamHandshake) {
    const auto with = [this](std::vector<std::pair<std::string, std::string>> changes) {
        std::map<std::string, std::string> h{{"Host", "127.0.0.1:8080"},
                                             {"Upgrade", "websocket"},
                                             {"Connection", "keep-alive, Upgrade"},
                                             {"Sec-WebSocket-Version", "13"},
                                             {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="}};
        for (auto& [k, v] : changes)
            h[k] = v;
        std::erase_if(h, [](const auto& x) { return x.second.empty(); });
        return call("GET", "/api/v1/stream", "", {h.begin(), h.end()});
    };
    const auto good = with({});
    EXPECT_EQ(good.status, 101u);
    EXPECT_EQ(good.headers.get("Sec-WebSocket-Accept"), "s3pPLMBiTxaQ9kYGzzhZRbK+xOo=");
    EXPECT_TRUE(good.without_body);
    EXPECT_EQ(with({{"Origin", "http://127.0.0.1:8080"}}).status, 101u);
    EXPECT_EQ(with({{"Origin", "http://evil.example"}}).status, 403u);
    EXPECT_EQ(with({{"Origin", "null"}}).status, 403u);
    EXPECT_EQ(with({{"Sec-Fetch-Site", "cross-site"}}).status, 403u);
    EXPECT_EQ(with({{"Host", "evil.example"}}).status, 421u);
    const auto plain = with({{"Upgrade", ""}});
    EXPECT_EQ(plain.status, 426u);
    EXPECT_EQ(plain.headers.get("Upgrade"), "websocket");
    EXPECT_EQ(with({{"Connection", "keep-alive"}}).status, 426u);
    EXPECT_EQ(with({{"Upgrade", "h2c"}}).status, 426u);
    EXPECT_EQ(with({{"Sec-WebSocket-Version", "8"}}).headers.get("Sec-WebSocket-Version"), "13");
    EXPECT_EQ(with({{"Sec-WebSocket-Key", "short"}}).status, 400u);
    EXPECT_EQ(with({{"Sec-WebSocket-Key", ""}}).status, 400u);
    EXPECT_EQ(call("HEAD", "/api/v1/stream", "", {{"Upgrade", "websocket"}, {"Connection", "Upgrade"}}).status, 426u);
}
}  // namespace
}  // namespace axisgate::http::test
