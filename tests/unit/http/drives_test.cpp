// Handlers with a fake gateway: drives and lines, native exchanges, conditions of twins, recorded frames, events.
#include "gateway/wire/frame_export.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {

// --- drives -----------------------------------------------------------------------------------------------------------

TEST_F(HttpTest, DriveAndLineDocuments) {
    gateway.drive_states[gateway.drive("feeder")] = {Presence::twin, true, false, "the device does not answer", 4, 800};
    const auto d = call("GET", "/api/v1/drives/feeder");
    EXPECT_EQ(d.at("presence"), "auto") << "the rule";
    EXPECT_EQ(d.at("family"), "demo");
    EXPECT_EQ(d.at("axes"), R"(["feeder"])");
    EXPECT_EQ(
        d.at("status"),
        R"({"presence":"twin","online":true,"simulated":true,"device_online":false,"text":"the device does not answer","silent_exchanges":4,"retry_pause_ms":800,"sync":null})");
    auto& l = gateway.line_states[gateway.line("can0")];
    l.status.state = LineStatus::State::up;
    l.status.load = 0.25;
    l.counters.timeouts = 3;
    l.scanned.timeouts = 40;
    l.families = {{"demo", {}}};
    l.families[0].counters.refused = 2;
    l.unclaimed = 7;
    const auto a = call("GET", "/api/v1/lines/can0");
    EXPECT_EQ(a.at("drives"), R"(["feeder","slide"])");
    EXPECT_EQ(a.json.at("status").at("state"), "up");
    EXPECT_EQ(json_text(a.json.at("status").at("load")), "0.25");
    EXPECT_EQ(json_text(a.json.at("status").at("counters").at("timeouts")), "3");
    EXPECT_EQ(json_text(a.json.at("status").at("scan_counters").at("timeouts")), "40");
    EXPECT_EQ(json_text(a.json.at("status").at("families").at(0).at("family")), R"("demo")");
    EXPECT_EQ(json_text(a.json.at("status").at("families").at(0).at("counters").at("refused")), "2");
    EXPECT_EQ(json_text(a.json.at("status").at("unclaimed")), "7");
    EXPECT_TRUE(a.json.at("status").at("twin").is_null());
    EXPECT_EQ(call("GET", "/api/v1/lines").array().size(), 2u);
    EXPECT_EQ(call("GET", "/api/v1/drives").array().size(), 3u);
}

TEST_F(HttpTest, Native) {
    call("POST", "/api/v1/drives/feeder/native", R"({"send":"PR P"})");
    ASSERT_EQ(gateway.submitted.size(), 1u);
    EXPECT_EQ(gateway.submitted[0].axis, gateway.axis("feeder"));
    const auto& native = std::get<Native>(gateway.submitted[0].body);
    EXPECT_TRUE(native.is_text);
    EXPECT_EQ(std::string(native.send.begin(), native.send.end()), "PR P");
    gateway.now_ns += 125'900;
    Result r = good_result(Outcome::done);
    r.text = "51200";
    r.bytes = {0x35, 0x0D};
    gateway.finish(r);
    EXPECT_EQ(answered().text, R"({"reply":"51200","reply_hex":"350D","took_ms":0.125})");

    call("POST", "/api/v1/drives/feeder/native", R"({"send_hex":"95 00"})");
    const auto& hex = std::get<Native>(gateway.submitted[1].body);
    EXPECT_FALSE(hex.is_text);
    EXPECT_EQ(hex.send, (std::vector<std::uint8_t>{0x95, 0x00}));
    gateway.finish(bad_result(Reason::no_answer, "drive feeder did not answer within 100 ms"));
    EXPECT_EQ(answered().status, 504u);

    // The drive has answered, although with an error: the answer is shown.
    call("POST", "/api/v1/drives/feeder/native", R"({"send":"MT[9]"})");
    gateway.now_ns += 250'000;
    Result no = bad_result(Reason::drive_refused, "MT[9]: the drive says 0x34 (sub-index)");
    no.bytes = {0x0F, 0x06, 0x00, 0x34};
    no.code = 0x34;
    gateway.finish(no);
    const auto refusal = answered();
    EXPECT_EQ(refusal.status, 409u);
    EXPECT_EQ(refusal.json.at("reply_hex"), "0F060034");
    EXPECT_EQ(json_text(refusal.json.at("took_ms")), "0.25");
    EXPECT_EQ(json_text(refusal.json.at("code")), "52");
    EXPECT_EQ(refusal.json.at("reason"), "drive_refused");

    for (const auto* bad : {R"({})", R"({"send":"a","send_hex":"00"})", R"({"send":""})", R"({"send":5})", R"({"send_hex":"0"})",
                            R"({"send_hex":"zz"})", R"({"send_hex":""})", R"({"send":"a","x":1})"}) {
        EXPECT_EQ(call("POST", "/api/v1/drives/feeder/native", bad).status, 422u) << bad;
    }
    EXPECT_EQ(call("POST", "/api/v1/drives/feeder/native", R"({"send":")" + std::string(1025, 'x') + R"("})").status, 422u);
    EXPECT_EQ(call("POST", "/api/v1/drives/none/native", R"({"send":"x"})").status, 404u);
    const auto bare = call("POST", "/api/v1/drives/bare/native", R"({"send":"x"})");
    EXPECT_EQ(bare.status, 409u) << "no axis can name it";
    EXPECT_EQ(gateway.submitted.size(), 3u) << "the three that were good requests";
}

TEST_F(HttpTest, NativeGoesToTheLowestChannel) {
    auto site = gateway.site()->site;
    site.axes[0].channel = 2;
    site.axes.push_back(axis_spec("first", "feeder", 3));
    gateway.put_site(site);
    call("POST", "/api/v1/drives/feeder/native", R"({"send":"x"})");
    EXPECT_EQ(gateway.submitted.at(0).axis, gateway.axis("first"));
}

TEST_F(HttpTest, Hand) {
    gateway.hands[gateway.drive("feeder")] = {{"stall", false, true, "the shaft is held"},
                                              {"temperature", 25.0, true, "deg C"},
                                              {"position", std::int64_t{5}, false, "true position"}};
    EXPECT_EQ(call("GET", "/api/v1/drives/feeder/hand").text, R"({"stall":false,"temperature":25,"position":5})");
    EXPECT_EQ(
        call("GET", "/api/v1/drives/feeder/hand?describe=1").text,
        R"([{"name":"stall","value":false,"writable":true,"description":"the shaft is held"},{"name":"temperature","value":25,"writable":true,"description":"deg C"},)"
        R"({"name":"position","value":5,"writable":false,"description":"true position"}])");
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":true})").text, R"({"stall":true,"temperature":25,"position":5})");
    EXPECT_EQ(call("PUT", "/api/v1/drives/feeder/hand", R"({"temperature":80.5,"stall":false})").text,
              R"({"stall":false,"temperature":80.5,"position":5})");
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder/hand", "{}").status, 200u);
    const auto unknown = call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":true,"fly":1,"position":3})");
    EXPECT_EQ(unknown.status, 422u);
    EXPECT_EQ(unknown.object().at("faults").get_array().size(), 2u);
    EXPECT_EQ(unknown.fault().at("remedy"), "use one of: stall, temperature");
    EXPECT_EQ(call("GET", "/api/v1/drives/feeder/hand").json.at("stall"), false) << "all or none";
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":null})").status, 422u);
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":[1]})").status, 422u);
    gateway.hand_fault = "temperature takes -40..200";
    const auto wrong = call("PATCH", "/api/v1/drives/feeder/hand", R"({"temperature":900})");
    EXPECT_EQ(wrong.status, 422u);
    EXPECT_EQ(wrong.at("detail"), "temperature takes -40..200");
    EXPECT_EQ(wrong.fault().at("pointer"), "/temperature");
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":true,"temperature":900})").fault().at("pointer"), "/temperature")
        << "the one that is named";
    gateway.hand_fault = "write true or false";
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":"yes"})").fault().at("pointer"), "/stall") << "there is only one";
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":"yes","temperature":900})").fault().at("pointer"), "")
        << "nobody knows which";
    EXPECT_EQ(call("GET", "/api/v1/drives/feeder/hand?describe=x").status, 400u);
}

TEST_F(HttpTest, NoHandForRealDrives) {
    gateway.drive_states[gateway.drive("feeder")] = {Presence::device, false, true, "answers", 0, 0};
    for (const auto& a : {call("GET", "/api/v1/drives/feeder/hand"), call("PATCH", "/api/v1/drives/feeder/hand", R"({"stall":true})")}) {
        EXPECT_EQ(a.status, 409u);
        EXPECT_EQ(a.at("reason"), "not_simulated");
        EXPECT_NE(a.at("detail").find("real drive"), std::string::npos) << a.at("detail");
    }
    EXPECT_NE(call("GET", "/api/v1/drives/slide/hand").at("detail").find("offline"), std::string::npos);
    EXPECT_EQ(call("GET", "/api/v1/drives/none/hand").status, 404u);
    EXPECT_EQ(call("PATCH", "/api/v1/drives/none/hand", "{}").status, 404u);
}

// --- records ----------------------------------------------------------------------------------------------------------

TraceEntry can_entry(std::uint64_t sequence) {
    TraceEntry e;
    e.sequence = sequence;
    e.at_unix_ns = 1'700'000'000'123'456'789;
    e.to_drive = true;
    const std::uint8_t data[] = {0x01, 0xAB};
    e.frame = Frame::can_extended(0x04280095, data);
    return e;
}

TEST_F(HttpTest, Trace) {
    auto& trace = gateway.traces[gateway.line("can0")];
    for (std::uint64_t i = 11; i <= 20; ++i)
        trace.push_back(can_entry(i));
    const auto a = call("GET", "/api/v1/lines/can0/trace?limit=2");
    EXPECT_EQ(
        a.text,
        R"({"line":"can0","missed":0,"next":21,"frames":[)"
        R"({"sequence":19,"at":"2023-11-14T22:13:20.123456Z","to_drive":true,"simulated":false,"kind":"can","id":69730453,"extended":true,"remote":false,"data":"01AB","text":"04280095#01AB","decoded":["to the drive, frame 1 of 2 bytes"]},)"
        R"({"sequence":20,"at":"2023-11-14T22:13:20.123456Z","to_drive":true,"simulated":false,"kind":"can","id":69730453,"extended":true,"remote":false,"data":"01AB","text":"04280095#01AB","decoded":["to the drive, frame 2 of 2 bytes"]}]})")
        << "without since: the newest";
    const auto since = call("GET", "/api/v1/lines/can0/trace?since=5&limit=3");
    EXPECT_EQ(since.at("missed"), "6");
    EXPECT_EQ(since.at("next"), "14");
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/trace?since=21").json.at("frames").get_array().size(), 0u);
    EXPECT_EQ(call("GET", "/api/v1/lines/can1/trace").at("frames"), "[]");
    EXPECT_EQ(call("GET", "/api/v1/lines/none/trace").status, 404u);
    for (const auto* bad : {"?limit=0", "?limit=65537", "?limit=x", "?since=-1", "?since=x", "?format=xml"})
        EXPECT_EQ(call("GET", "/api/v1/lines/can0/trace" + std::string(bad)).status, 400u) << bad;
}

TEST_F(HttpTest, ATraceIsReadInPiecesThatOthersGetBetween) {
    std::vector<std::function<void()>> pieces;
    const Router in_pieces(Context{.ports = gateway,
                                   .settings = settings,
                                   .asset = [](std::string_view) { return std::string_view(); },
                                   .own_metrics = {},
                                   .recipes = recipes,
                                   .alarms = alarms,
                                   .rehearsals = rehearsals,
                                   .recipe_rehearsals = recipe_rehearsals,
                                   .later = [&](std::function<void()> piece) { pieces.push_back(std::move(piece)); }});
    auto& trace = gateway.traces[gateway.line("can0")];
    for (std::uint64_t i = 1; i <= 200; ++i)
        trace.push_back(can_entry(i));
    const auto all = trace;
    const auto ask = [&](const std::string& query, auto between) {
        std::vector<Response> came;
        const auto handled =
            in_pieces.handle(request("GET", "/api/v1/lines/can0/trace" + query), [&](Response r) { came.push_back(std::move(r)); });
        EXPECT_FALSE(handled.now);
        std::size_t done = 0;
        for (; !pieces.empty(); ++done) {
            EXPECT_EQ(pieces.size(), 1u);
            EXPECT_TRUE(came.empty());
            const auto next = std::move(pieces.front());
            pieces.clear();
            next();
            between();
        }
        EXPECT_GE(done, 4u);
        EXPECT_EQ(came.size(), 1u);
        return came.empty() ? Answer{} : answer_from(std::move(came.front()));
    };
    std::uint64_t more = 200;
    const auto goes_on = [&] { trace.push_back(can_entry(++more)); };
    EXPECT_EQ(ask("?format=pcapng", goes_on).text, pcapng(all, "can0")) << "what comes meanwhile is the next question's";
    trace = all;
    EXPECT_EQ(ask("?format=candump", goes_on).text, candump_text(all, "can0"));
    trace = all;
    const auto listed = ask("?since=50&limit=100", goes_on);
    EXPECT_EQ(listed.at("next"), "150");
    ASSERT_EQ(listed.json.at("frames").get_array().size(), 100u);
    for (std::size_t i = 0; i < 100; ++i)
        EXPECT_EQ(listed.json.at("frames").get_array()[i].at("sequence").to_number<std::size_t>(), 50 + i);
    trace = all;
    const auto overtaken = ask("?since=1&limit=200", [&] {
        if (trace.size() > 40) trace.erase(trace.begin(), trace.begin() + 20);
    });
    EXPECT_EQ(overtaken.json.at("frames").get_array().size() + overtaken.json.at("missed").to_number<std::size_t>(), 200u)
        << "what the line overwrites meanwhile is counted";
    EXPECT_GT(overtaken.json.at("missed").to_number<int>(), 0);
}

TEST_F(HttpTest, TraceFormats) {
    gateway.traces[gateway.line("can0")] = {can_entry(1)};
    const auto dump = call("GET", "/api/v1/lines/can0/trace?format=candump");
    EXPECT_EQ(dump.headers.get("Content-Type"), "text/plain; charset=utf-8");
    EXPECT_EQ(dump.headers.get("Content-Disposition"), "attachment; filename=\"can0.log\"");
    EXPECT_NE(dump.text.find("can0 04280095#01AB"), std::string::npos) << dump.text;
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/trace", "", {{"Accept", "text/plain"}}).text, dump.text);
    const auto pcap = call("GET", "/api/v1/lines/can0/trace?format=pcapng");
    EXPECT_EQ(pcap.headers.get("Content-Type"), "application/x-pcapng");
    EXPECT_EQ(pcap.text.substr(0, 4), "\x0A\x0D\x0D\x0A") << "a section header block";
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/trace", "", {{"Accept", "application/x-pcapng"}}).text, pcap.text);
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/trace", "", {{"Accept", "image/png"}}).status, 406u);
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/trace?format=candump", "", {{"Accept", "image/png"}}).status, 200u) << "the query decides";
    EXPECT_EQ(call("GET", "/api/v1/lines/can0/trace").headers.get("Content-Type"), "application/json");
    TraceEntry bytes;
    bytes.sequence = 2;
    const std::uint8_t run[] = {0x50, 0x52};
    bytes.frame = Frame::run(run);
    gateway.traces[gateway.line("can1")] = {bytes};
    EXPECT_NE(call("GET", "/api/v1/lines/can1/trace?format=candump").text.find("50 52"), std::string::npos)
        << "a byte line has its text form";
    EXPECT_EQ(call("GET", "/api/v1/lines/can1/trace").json.at("frames").get_array()[0].at("id"), nullptr);
}

TEST_F(HttpTest, Events) {
    Event write = event("AC written", "feeder", Severity::info, "write");
    write.who = "127.0.0.1";
    write.door = "http";
    write.parameter = "AC";
    write.old_value = "1";
    write.new_value = "2";
    gateway.tell(write);
    Event alarm = event("too much current", "slide", Severity::alarm, "alarm");
    alarm.drive = "slide";
    alarm.line = "can0";
    alarm.code = 49;
    gateway.tell(alarm);
    const auto all = call("GET", "/api/v1/events").array();
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(
        json_text(all[0]),
        R"({"id":1,"at":"2026-01-02T03:04:05.678901Z","severity":"info","kind":"write","axis":"feeder","drive":null,"line":null,"code":null,"text":"AC written",)"
        R"("who":"127.0.0.1","door":"http","parameter":"AC","old":"1","new":"2"})");
    EXPECT_EQ(json_text(all[1].at("code")), "49");
    EXPECT_EQ(call("GET", "/api/v1/events?since=1").array().size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/events?since=2026-01-02T03:04:05.678901Z").array().size(), 2u);
    EXPECT_EQ(call("GET", "/api/v1/events?since=2026-01-02T03:04:06%2B00:00").array().size(), 0u);
    EXPECT_EQ(call("GET", "/api/v1/events?axis=slide").array().size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/events?severity=warning").array().size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/events?limit=1").array()[0].at("id"), 2) << "the newest if there are more";
    EXPECT_EQ(gateway.event_queries.back().limit, 1u);
    EXPECT_EQ(gateway.event_queries.front().limit, 200u);
    for (const auto* bad : {"since=x", "since=-1", "severity=loud", "limit=0", "limit=1001"})
        EXPECT_EQ(call("GET", "/api/v1/events?" + std::string(bad)).status, 400u) << bad;
}
}  // namespace
}  // namespace axisgate::http::test
