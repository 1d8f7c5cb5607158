// Snapshots, tables of parameters, staged sites, registers and register lists through the router, with the fake gateway.

#include <fmt/core.h>

#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
class Keep : public HttpTest {
protected:
    void drive_answers() {
        gateway.at_once = [](const Command& c) {
            Result r = good_result();
            if (const auto* w = std::get_if<WriteParameter>(&c.body))
                r.value = w->value;
            else
                r.value = std::int64_t{16};
            return r;
        };
    }
    Answer do_call(std::string_view method, std::string target, std::string body = {},
                   std::vector<std::pair<std::string, std::string>> headers = {}) {
        auto a = call(method, std::move(target), std::move(body), std::move(headers));
        return a.status != 0 ? a : answered();
    }
    static AxisPicture switched_off() {
        auto p = standing(0);
        p.statusword = 0x9650;
        return p;
    }
    static std::string stage_body(const char* unit) {
        return std::string(
                   R"({"lines":[{"name":"can0","uri":"twin","family":"demo"}],"drives":[{"name":"feeder","line":"can0","address":5}],"axes":[{"name":"feeder","drive":"feeder","number":1,"unit":")") +
               unit + R"("}],"mappings":[]})";
    }
};

TEST_F(Keep, ASnapshotReadsEverythingThatCanBeRead) {
    drive_answers();
    const auto a = do_call("POST", "/api/v1/axes/feeder/snapshots", R"({"name":"first"})");
    ASSERT_EQ(a.status, 201u) << a.text;
    EXPECT_EQ(a.headers.get("Location"), "/api/v1/axes/feeder/snapshots/1");
    EXPECT_EQ(gateway.kept_snapshots["feeder"].at(0).parameters.size(), 11u) << "AC, ML, MT and eight of PP; KEY cannot be read";
    EXPECT_EQ(a.at("left_out"), R"(["N"])");
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshots").array().size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshot-progress").at("state"), "done");
    EXPECT_EQ(do_call("DELETE", "/api/v1/axes/feeder/snapshots/1").status, 204u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshots/1").status, 404u);
    ASSERT_EQ(gateway.noted.size(), 2u) << "both are told";
    EXPECT_EQ(gateway.noted[0].text, "snapshot 1 \"first\" taken: 11 values");
    EXPECT_EQ(gateway.noted[1].text, "snapshot 1 \"first\" removed");
    for (const auto& e : gateway.noted) {
        EXPECT_EQ(e.kind, "snapshot");
        EXPECT_EQ(e.axis, "feeder");
        EXPECT_EQ(e.who, "127.0.0.1:51123");
        EXPECT_EQ(e.door, "http");
    }
}

TEST_F(Keep, AnAxisThatIsRemovedBeforeItsSnapshotIsStoredIsNotFound) {
    drive_answers();
    gateway.axis_gone = true;
    const auto a = do_call("POST", "/api/v1/axes/feeder/snapshots", R"({"name":"late"})");
    EXPECT_EQ(a.status, 404u) << a.text;
    gateway.axis_gone = false;
    gateway.keep_fault = "there is no room for it";
    EXPECT_EQ(do_call("POST", "/api/v1/axes/feeder/snapshots", R"({"name":"late"})").status, 507u);
    EXPECT_TRUE(gateway.noted.empty());
}

TEST_F(Keep, ASilentDriveGivesNoHalfSnapshot) {
    int asked = 0;
    gateway.at_once = [&asked](const Command&) {
        return ++asked < 4 ? good_result() : bad_result(Reason::no_answer, "the drive is silent");
    };
    const auto a = do_call("POST", "/api/v1/axes/feeder/snapshots", R"({"name":"first"})");
    EXPECT_EQ(a.status, 504u);
    EXPECT_EQ(a.at("read"), "3");
    EXPECT_TRUE(gateway.kept_snapshots["feeder"].empty());
    EXPECT_TRUE(gateway.noted.empty()) << "none was taken";
    EXPECT_EQ(asked, 4) << "a silent drive is not asked on";
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshot-progress").at("state"), "failed");
}

TEST_F(Keep, OneExchangeAtATimeAndOneJobPerAxis) {
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/snapshots", R"({"name":"first"})").status, 0u);
    EXPECT_EQ(gateway.waiting.size(), 1u);
    EXPECT_EQ(do_call("POST", "/api/v1/axes/feeder/snapshots", R"({"name":"second"})").status, 409u);
    gateway.finish(good_result());
    EXPECT_EQ(gateway.waiting.size(), 1u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshot-progress").at("done"), "1");
}

TEST_F(Keep, RestoreWritesWhatDiffersAndNotWhileMoving) {
    AxisSnapshot s;
    s.n = 1;
    s.parameters = {{"AC", std::int64_t{30000}}, {"ML", std::string("x")}, {"MT", std::int64_t{16}}};
    gateway.kept_snapshots["feeder"].push_back(s);
    gateway.stored_values["feeder"] = {{"MT", std::int64_t{16}, {}, "", "", 0}};
    const auto dry = call("POST", "/api/v1/axes/feeder/snapshots/1/restore", R"({"dry_run":true})");
    ASSERT_EQ(dry.status, 200u) << dry.text;
    EXPECT_EQ(dry.object().at("changes").get_array().size(), 1u);
    EXPECT_EQ(dry.object().at("skipped").get_array().size(), 2u);
    EXPECT_TRUE(gateway.submitted.empty());
    auto moving = standing(0);
    moving.flags |= flag_moving;
    gateway.set_picture("feeder", moving);
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/snapshots/1/restore", "{}").status, 409u);
    EXPECT_TRUE(gateway.submitted.empty());
    gateway.set_picture("feeder", switched_off());
    drive_answers();
    const auto a = do_call("POST", "/api/v1/axes/feeder/snapshots/1/restore", "{}");
    ASSERT_EQ(a.status, 200u) << a.text;
    EXPECT_EQ(a.at("changed"), R"([{"parameter":"AC","value":30000}])");
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/snapshots/1/restore", R"({"parameters":["zzz"]})").status, 422u);
    for (const auto* with : {"default", "stored", "snapshot:1", "axis:slide", "axis:feeder:1"})
        EXPECT_EQ(call("GET", std::string("/api/v1/axes/feeder/snapshots/1/diff?with=") + with).object().at("rows").get_array().size(), 3u)
            << with;
    const auto never = call("GET", "/api/v1/axes/feeder/snapshots/1/diff?with=axis:slide");
    EXPECT_EQ(never.at("not_known"), "3");
    EXPECT_NE(never.at("text").find("of slide: it was not read since the gateway's start"), std::string::npos) << never.text;
    EXPECT_EQ(never.object().at("rows").at(0).at("other_known"), false);
    const auto itself = call("GET", "/api/v1/axes/feeder/snapshots/1/diff?with=snapshot:1");
    EXPECT_EQ(itself.at("not_known"), "0");
    EXPECT_EQ(itself.at("text"), "") << itself.text;
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshots/1/diff?with=moon").status, 400u);
}

TEST_F(Keep, ATableWithWrongRowsChangesNothingAndTellsAll) {
    const auto a =
        call("PUT", "/api/v1/axes/feeder/parameters.csv", "parameter,value\nAC,0\nMT,16\nXX,1\nAC,abc\n", {{"Content-Type", "text/csv"}});
    EXPECT_EQ(a.status, 422u);
    EXPECT_EQ(a.object().at("faults").get_array().size(), 3u) << a.text;
    EXPECT_TRUE(gateway.submitted.empty());
    drive_answers();
    const auto good =
        do_call("PUT", "/api/v1/axes/feeder/parameters.csv", "value;parameter\r\n30000;AC\r\nx;ML\r\n", {{"Content-Type", "text/csv"}});
    EXPECT_EQ(good.status, 200u) << good.text;
    EXPECT_EQ(gateway.submitted.size(), 1u);
    gateway.live_values[{gateway.axis("feeder"), *gateway.catalogue.find("ML")}] = {std::string("=1+1"), 0, Quality::good};
    EXPECT_NE(call("GET", "/api/v1/axes/feeder/parameters.csv").text.find("'=1+1"), std::string::npos) << "no formula for a spreadsheet";
}

TEST_F(Keep, WhatTheDriveIsReachedByIsLeftOutUnlessAskedFor) {
    AxisSnapshot s;
    s.n = 1;
    s.parameters = {{"AC", std::int64_t{30000}}, {"PP[2]", std::int64_t{7}}, {"PP[3]", std::int64_t{9}}};
    gateway.kept_snapshots["feeder"].push_back(s);
    gateway.stored_values["feeder"] = {{"PP[3]", std::int64_t{9}, {}, "", "", 0}};
    drive_answers();
    const auto restore = [this](std::string body) { return do_call("POST", "/api/v1/axes/feeder/snapshots/1/restore", std::move(body)); };
    const auto table = [this](std::string query) {
        return do_call("PUT", "/api/v1/axes/feeder/parameters.csv" + query, "parameter,value\nAC,30001\nPP[2],7\n",
                       {{"Content-Type", "text/csv"}});
    };
    const std::string left_out =
        R"({"parameter":"PP[2]","why":"the drive is reached by it (protocol): it is written only with include_addressing"})";
    for (const auto& a : {restore(R"({"dry_run":true})"), restore("{}"), restore(R"({"parameters":["AC","PP[2]"]})"),
                          restore(R"({"include_addressing":false})"), table("?dry_run=1"), table(""), table("?include_addressing=0")}) {
        ASSERT_EQ(a.status, 200u) << a.text;
        EXPECT_NE(a.text.find(left_out), std::string::npos) << a.text;
    }
    for (const auto& c : gateway.submitted)
        EXPECT_EQ(std::get<WriteParameter>(c.body).point, *gateway.catalogue.find("AC"));
    gateway.submitted.clear();
    EXPECT_EQ(restore(R"({"dry_run":true,"include_addressing":true})").object().at("changes").get_array().size(), 2u);
    EXPECT_NE(restore("{}").text.find(R"({"parameter":"PP[3]","why":"has this value already"})"), std::string::npos);
    EXPECT_EQ(restore(R"({"include_addressing":true})").object().at("changed").get_array().size(), 2u);
    EXPECT_EQ(table("?include_addressing=1").object().at("changed").get_array().size(), 2u);
    EXPECT_EQ(restore(R"({"include_addressing":1})").status, 422u);
    EXPECT_EQ(table("?include_addressing=maybe").status, 400u);
    EXPECT_EQ(do_call("PUT", "/api/v1/axes/feeder/parameters/PP%5B2%5D", R"({"value":8})").status, 200u)
        << "by itself it is written as ever";
}

TEST_F(Keep, WhatActsAtOnceIsLeftOutUnlessAskedFor) {
    std::string text(catalogue_text);
    text.insert(
        text.find(R"({"id": "PP")"),
        R"({"id": "MO", "name": "motor_on", "group": "motor", "type": "u8", "min": 0, "max": 1, "access": "RW", "live": true, "description": "Switches."},)");
    std::vector<std::string> faults;
    gateway.catalogue = *Catalogue::parse(text, faults);
    AxisSnapshot s;
    s.n = 1;
    s.parameters = {{"AC", std::int64_t{30000}}, {"MO", std::int64_t{1}}};
    gateway.kept_snapshots["feeder"].push_back(s);
    gateway.stored_values["feeder"] = {{"MO", std::int64_t{0}, {}, "", "", 0}};
    gateway.set_picture("feeder", switched_off());
    drive_answers();
    const auto restore = [this](std::string body) { return do_call("POST", "/api/v1/axes/feeder/snapshots/1/restore", std::move(body)); };
    const auto table = [this](std::string query) {
        return do_call("PUT", "/api/v1/axes/feeder/parameters.csv" + query, "parameter,value\nAC,30001\nMO,1\n",
                       {{"Content-Type", "text/csv"}});
    };
    const std::string left_out =
        R"({"parameter":"MO","why":"it acts at once and is no setting (motor_on): it is written only with include_live"})";
    for (const auto& a :
         {restore(R"({"dry_run":true})"), restore("{}"), restore(R"({"parameters":["MO"]})"), restore(R"({"include_addressing":true})"),
          table("?dry_run=1"), table(""), table("?include_live=0&include_addressing=1")}) {
        ASSERT_EQ(a.status, 200u) << a.text;
        EXPECT_NE(a.text.find(left_out), std::string::npos) << a.text;
    }
    for (const auto& c : gateway.submitted)
        EXPECT_EQ(std::get<WriteParameter>(c.body).point, *gateway.catalogue.find("AC"));
    const auto diff = call("GET", "/api/v1/axes/feeder/snapshots/1/diff?with=stored");
    ASSERT_EQ(diff.object().at("rows").get_array().size(), 1u) << diff.text;
    EXPECT_EQ(diff.object().at("rows").at(0).at("parameter"), "AC");
    EXPECT_EQ(diff.object().at("live").at(0).at("parameter"), "MO");
    EXPECT_EQ(restore(R"({"include_live":true})").object().at("changed").get_array().size(), 2u);
    EXPECT_EQ(table("?include_live=1").object().at("changed").get_array().size(), 2u);
    EXPECT_EQ(restore(R"({"include_live":1})").status, 422u);
    EXPECT_EQ(table("?include_live=maybe").status, 400u);
}

TEST_F(Keep, AMovingAxisTakesNoRestoreAndNoTableUnlessNothingWouldBeWritten) {
    AxisSnapshot s;
    s.n = 1;
    s.parameters = {{"AC", std::int64_t{30000}}, {"ML", std::string("x")}};
    gateway.kept_snapshots["feeder"].push_back(s);
    AxisPicture moving = standing(0);
    moving.flags |= flag_moving;
    gateway.set_picture("feeder", moving);
    drive_answers();
    const auto refused = call("POST", "/api/v1/axes/feeder/snapshots/1/restore", "{}");
    EXPECT_EQ(refused.status, 409u) << refused.text;
    EXPECT_NE(refused.at("detail").find("the axis moves: stop it"), std::string::npos) << refused.text;
    EXPECT_EQ(call("PUT", "/api/v1/axes/feeder/parameters.csv", "parameter,value\nAC,30000\n", {{"Content-Type", "text/csv"}}).status,
              409u);
    EXPECT_TRUE(gateway.submitted.empty());
    EXPECT_EQ(do_call("POST", "/api/v1/axes/feeder/snapshots/1/restore", R"({"parameters":["ML"]})").status, 200u)
        << "nothing would be written";
    EXPECT_EQ(call("POST", "/api/v1/axes/feeder/snapshots/1/restore", R"({"dry_run":true})").status, 200u);
}

TEST_F(Keep, ASnapshotOfAnotherFamilyIsRefusedAndOneOfUnknownFamilyIfItsWordsDoNotFit) {
    const auto keep = [this](std::uint32_t n, std::string family, std::string parameter) {
        AxisSnapshot s;
        s.n = n;
        s.family = std::move(family);
        s.parameters = {{std::move(parameter), std::int64_t{30000}}};
        gateway.kept_snapshots["feeder"].push_back(s);
    };
    keep(1, "demo", "AC");
    keep(2, "other", "AC");
    keep(3, "", "AC");
    keep(4, "", "XX");
    drive_answers();
    const auto restore = [this](int n) {
        return do_call("POST", fmt::format("/api/v1/axes/feeder/snapshots/{}/restore", n), R"({"dry_run":true})");
    };
    EXPECT_EQ(restore(1).status, 200u);
    EXPECT_EQ(restore(3).status, 200u);
    for (const int n : {2, 4}) {
        const auto a = restore(n);
        EXPECT_EQ(a.status, 409u) << a.text;
        EXPECT_NE(a.at("detail").find(n == 2 ? "a other drive" : "has no XX"), std::string::npos) << a.text;
    }
    const auto diff = [this](int n, std::string with) {
        return do_call("GET", fmt::format("/api/v1/axes/feeder/snapshots/{}/diff?with={}", n, with)).status;
    };
    for (const auto* with : {"default", "device", "stored", "snapshot:1", "axis:slide", "axis:feeder:1"}) {
        EXPECT_EQ(diff(1, with), 200u) << with;
        EXPECT_EQ(diff(2, with), 409u) << with;
        EXPECT_EQ(diff(3, with), 200u) << with;
    }
    EXPECT_EQ(diff(2, "snapshot:2"), 200u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshots/2").at("family"), "other");
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder/snapshots/3").at("family"), "null");
}

TEST_F(Keep, TheHistoryOfTheSiteComesInPages) {
    for (std::uint64_t n = 1; n <= 150; ++n)
        gateway.kept_sites[n] = {n, 0, "me", "", 5};
    const auto revisions = [this](std::string query) {
        const auto a = call("GET", "/api/v1/site/history" + query);
        std::vector<std::int64_t> out;
        for (const auto& r : a.array())
            out.push_back(r.at("revision").as_int64());
        return out;
    };
    EXPECT_EQ(revisions("").size(), 100u);
    EXPECT_EQ(revisions("?limit=2"), (std::vector<std::int64_t>{150, 149}));
    EXPECT_EQ(revisions("?limit=2&before=3"), (std::vector<std::int64_t>{2, 1}));
    EXPECT_EQ(call("GET", "/api/v1/site/history?limit=1001").status, 400u);
}

TEST_F(Keep, AStagedSiteIsShownAppliedAndRolledBack) {
    const auto staged = call("POST", "/api/v1/site/stage", stage_body("deg"), {{"If-Match", "\"1\""}});
    ASSERT_EQ(staged.status, 200u) << staged.text;
    EXPECT_EQ(staged.at("state"), "staged");
    EXPECT_EQ(gateway.site()->revision, 1u) << "nothing is applied yet";
    EXPECT_NE(staged.text.find(R"("what":"axes/slide")"), std::string::npos);
    const auto stale = call("POST", "/api/v1/site/stage", stage_body("deg"), {{"If-Match", "\"9\""}});
    EXPECT_EQ(stale.status, 412u);
    EXPECT_TRUE(stale.object().contains("current")) << "what differs";
    EXPECT_EQ(call("POST", "/api/v1/site/stage/apply", R"({"confirm_within_s":4})").status, 422u);
    const auto applied = do_call("POST", "/api/v1/site/stage/apply", "{}");
    ASSERT_EQ(applied.status, 200u) << applied.text;
    EXPECT_EQ(applied.at("state"), "applied");
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})").status, 409u) << "no other change while one is on trial";
    auto other = request("POST", "/api/v1/site/stage/confirm");
    other.peer = "127.0.0.9:1";
    EXPECT_EQ(send(other).status, 409u) << "only who applied it";
    EXPECT_EQ(do_call("POST", "/api/v1/site/stage/roll-back").at("state"), "none");
    EXPECT_EQ(gateway.site()->site.axes.size(), 2u);
    EXPECT_EQ(do_call("POST", "/api/v1/site/stage/apply", "{}").status, 409u) << "nothing is staged";
}

TEST_F(Keep, AnotherClientsStageIsNotReplacedOrAppliedInSilence) {
    using Fields = std::vector<std::pair<std::string, std::string>>;
    const Fields anna{{"X-Client", "anna"}}, bert{{"X-Client", "bert"}};
    const auto first = call("POST", "/api/v1/site/stage", stage_body("deg"), anna);
    ASSERT_EQ(first.status, 200u) << first.text;
    EXPECT_EQ(first.at("client"), "127.0.0.1 anna");
    EXPECT_TRUE(first.object().at("id").is_string()) << first.text;
    EXPECT_EQ(call("GET", "/api/v1/site/stage").at("id"), first.at("id"));
    const auto taken = call("POST", "/api/v1/site/stage", stage_body("m"), bert);
    EXPECT_EQ(taken.status, 409u);
    EXPECT_EQ(taken.at("type"), "urn:axisgate:problem:stage_taken");
    EXPECT_NE(taken.at("detail").find("127.0.0.1 anna"), std::string::npos) << taken.text;
    EXPECT_EQ(call("POST", "/api/v1/site/stage?replace=maybe", stage_body("m"), bert).status, 400u);
    EXPECT_EQ(call("POST", "/api/v1/site/stage", stage_body("mm"), anna).status, 200u) << "one's own is replaced as ever";
    const auto second = call("POST", "/api/v1/site/stage?replace=true", stage_body("m"), bert);
    ASSERT_EQ(second.status, 200u) << second.text;
    EXPECT_NE(second.at("id"), first.at("id"));
    const auto apply = [&](std::string id, const Fields& who) {
        return do_call("POST", "/api/v1/site/stage/apply", R"({"stage":")" + id + R"("})", who);
    };
    const auto replaced = apply(first.at("id"), anna);
    EXPECT_EQ(replaced.status, 409u);
    EXPECT_EQ(replaced.at("type"), "urn:axisgate:problem:stage_replaced");
    EXPECT_NE(replaced.at("detail").find("127.0.0.1 bert"), std::string::npos) << replaced.text;
    EXPECT_EQ(gateway.site()->revision, 1u) << "nothing was applied";
    EXPECT_EQ(call("POST", "/api/v1/site/stage/apply", R"({"stage":7})").status, 422u);
    ASSERT_EQ(apply(second.at("id"), bert).status, 200u);
    const auto confirm = call("POST", "/api/v1/site/stage/confirm", "", anna);
    EXPECT_EQ(confirm.status, 409u) << "only the client that applied it";
    EXPECT_NE(confirm.at("detail").find("127.0.0.1 bert"), std::string::npos) << confirm.text;
    EXPECT_EQ(do_call("POST", "/api/v1/site/stage/confirm", "", bert).status, 200u);
    EXPECT_EQ(apply(second.at("id"), bert).status, 409u) << "it is not staged any more";
}

TEST_F(Keep, RegistersAreTheDoorsOwnAnswer) {
    gateway.registers_answer = registers::RegisterRead{registers::Verdict::good, {0, 0, 0x0C, 0x80}};
    const auto a = do_call("GET", "/api/v1/registers?unit=2&address=0&count=2");
    ASSERT_EQ(a.status, 200u) << a.text;
    EXPECT_EQ(gateway.registers_asked,
              std::tuple(std::uint8_t{2}, registers::Table::holding_registers, std::uint16_t{0}, std::uint16_t{2}));
    EXPECT_EQ(a.at("words"), "[0,3200]");
    EXPECT_EQ(a.object().at("decoded").at(0).at("value"), 3200);
    gateway.registers_answer = registers::RegisterRead{registers::Verdict::no_address, {}};
    EXPECT_EQ(do_call("GET", "/api/v1/registers?unit=3").object().at("exception").at("code"), 2);
    gateway.registers_answer.reset();
    EXPECT_EQ(do_call("GET", "/api/v1/registers").status, 503u);
    EXPECT_EQ(call("GET", "/api/v1/registers?count=126").status, 400u);
}

TEST_F(Keep, RegisterListsAreEscapedAndCarryTheRevision) {
    gateway.put_site(
        R"({"lines":[{"name":"can0","uri":"twin","family":"demo"}],"drives":[{"name":"feeder","line":"can0","address":5}],"axes":[{"name":"feeder","drive":"feeder","number":1}],
      "mappings":[{"unit":2,"table":"holding","address":4,"point":"feeder.position","type":"i32","comment":"<script>*) \"x\""}]})");
    const auto page = call("GET", "/api/v1/mappings/list?format=html");
    EXPECT_EQ(page.text.find("<script>"), std::string::npos);
    EXPECT_NE(page.text.find("&lt;script&gt;"), std::string::npos);
    const auto st = call("GET", "/api/v1/mappings/list?format=st");
    EXPECT_NE(st.text.find("feeder_position : DINT;"), std::string::npos) << st.text;
    EXPECT_EQ(st.text.find("*) \""), std::string::npos) << "a comment does not end a comment";
    for (const auto* format : {"csv", "html", "st"}) {
        const auto list = call("GET", std::string("/api/v1/mappings/list?format=") + format);
        const std::string revision(list.headers.get("Mapping-Revision"));
        EXPECT_EQ(revision.size(), 8u);
        EXPECT_NE(list.text.find(revision), std::string::npos) << format;
    }
    EXPECT_EQ(call("GET", "/api/v1/mappings/next-free?unit=2&words=4").at("address"), "0");
    EXPECT_EQ(call("GET", "/api/v1/mappings/next-free?unit=2&words=5").at("address"), "6");
    EXPECT_EQ(do_call("POST", "/api/v1/mappings/template", R"({"template":"standard_map","axis":"feeder","unit":3,"address":0})").status,
              201u);
    EXPECT_EQ(do_call("POST", "/api/v1/mappings/template", R"({"template":"standard_map","axis":"feeder","unit":3,"address":0})").status,
              409u);
}
}  // namespace
}  // namespace axisgate::http::test
