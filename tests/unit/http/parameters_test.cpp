// An axis' parameters: the list, one read from the drive, one written.
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
namespace json = boost::json;

class HttpParameters : public HttpTest {
protected:
    Point point(std::string_view id) { return *gateway.catalogue.find(id); }
    void know(std::string_view id, Value v) {
        gateway.live_values[{gateway.axis("feeder"), point(id)}] = {std::move(v), 1'767'323'045'000'000'000, Quality::good};
    }
    const std::string base = "/api/v1/axes/feeder/parameters";
};

TEST_F(HttpParameters, ListHasLiveAndStoredValues) {
    know("AC", std::int64_t{30000});
    gateway.stored_values["feeder"] = {{"AC", std::int64_t{25000}, std::int64_t{20000}, "127.0.0.1:5", "http", 1'700'000'000'000'000'000}};
    const auto a = call("GET", base).array();
    ASSERT_EQ(a.size(), 4u + 8u + 1u) << "4 plain ones, 8 elements of PP, and one entry for the long array";
    EXPECT_EQ(
        json_text(a[0]),
        R"({"id":"AC","name":"acceleration","group":"motion","type":"u32","unit":"pulse/s^2","min":1,"max":65000000,"default":20000,"access":"RW",)"
        R"("storage":"eeprom","addressing":false,"live":false,"description":"Acceleration of motions.","allowed":null,"fields":null,"meanings":null,"alternate":null,"choice":[],"first":null,"count":null,"selector":0,"value":30000,"quality":"good",)"
        R"("at":"2026-01-02T03:04:05.000000Z","stored":25000,"previous":20000,"written_at":"2023-11-14T22:13:20.000000Z","written_by":"127.0.0.1:5",)"
        R"("written_through":"http","text":"","meaning":null})");
    EXPECT_EQ(a[1].at("value"), nullptr);
    EXPECT_EQ(a[1].at("quality"), "unknown");
    EXPECT_EQ(a[1].at("stored"), nullptr);
    EXPECT_EQ(a[1].at("written_at"), nullptr);
    EXPECT_EQ(a[4].at("id"), "PP[1]");
    EXPECT_EQ(a[12].at("id"), "N");
    EXPECT_NE(a[12].at("text").get_string().find("?array=N"), json::string::npos);
    EXPECT_TRUE(gateway.submitted.empty()) << "no exchange";
    EXPECT_EQ(call("GET", base + "?group=motor").array().size(), 1u);
    EXPECT_EQ(call("GET", base + "?group=none").array().size(), 0u);
    const auto n = call("GET", base + "?array=N&first=1990").array();
    EXPECT_EQ(n.size(), 11u);
    EXPECT_EQ(n[0].at("id"), "N[1990]");
    EXPECT_EQ(call("GET", base + "?array=N").array().size(), 1024u);
    EXPECT_EQ(call("GET", base + "?array=registers").array().size(), 1024u) << "by name too";
    EXPECT_EQ(call("GET", base + "?array=AC").status, 404u);
    EXPECT_EQ(call("GET", base + "?first=x").status, 400u);
    EXPECT_EQ(call("GET", "/api/v1/axes/none/parameters").status, 404u);
}

/// Two parameters whose form depends on a third, one of bits, one of ranges.
constexpr std::string_view forms = R"({"family": "demo", "number": 9, "commands": [], "errors": [],
  "actions": [{"code": 0, "title": "no action"}, {"code": 3, "title": "stop"}],
  "parameters": [
    {"id": "AC", "name": "acceleration", "group": "motion", "description": "x", "type": "u32", "unit": "pulse/s^2", "min": 1, "max": 65000000, "access": "RW",
     "storage": "eeprom", "choice": ["storage"], "alternate": {"when": "IC[4]=1", "unit": "ms", "min": 1, "max": 60000}},
    {"id": "IC[4]", "name": "ramp_unit", "group": "initial", "description": "x", "type": "u16", "access": "RW", "allowed": {"0": "pulse/s^2", "1": "ms"}},
    {"id": "IL", "name": "logic", "group": "input", "description": "x", "type": "u16", "min": 0, "max": 255, "access": "RW",
     "fields": [{"name": "action", "bits": "6..0", "values": "actions"}, {"name": "flag", "bits": "7", "allowed": {"0": "always", "1": "on a change"}}]},
    {"id": "TG", "name": "trigger", "group": "input", "description": "x", "type": "u16", "min": 0, "max": 60001, "access": "RW",
     "meanings": {"0": "continuous", "1..60000": "filter", "60001": "one time"}}]})";

TEST_F(HttpParameters, UnitAndRangeAreThoseThatHoldNow) {
    std::vector<std::string> faults;
    gateway.catalogue = *Catalogue::parse(forms, faults);
    const auto list = [&] { return call("GET", base).array(); };
    EXPECT_EQ(json_text(list()[0].at("alternate")), R"({"parameter":"IC[4]","equals":1,"unit":"ms","min":1,"max":60000})");
    EXPECT_EQ(json_text(list()[0].at("choice")), R"(["storage"])");
    EXPECT_EQ(list()[0].at("unit"), "pulse/s^2") << "nobody knows IC[4]";
    know("IC[4]", std::int64_t{1});
    EXPECT_EQ(list()[0].at("unit"), "ms");
    EXPECT_EQ(json_text(list()[0].at("max")), "60000");
    auto no = call("PUT", base + "/AC", R"({"value":60001})");
    EXPECT_EQ(no.status, 422u);
    EXPECT_EQ(no.json.at("detail"), "AC: 60001 is outside 1..60000 ms, because IC[4] is 1");
    EXPECT_TRUE(gateway.submitted.empty()) << "before the wire";
    know("IC[4]", std::int64_t{0});
    EXPECT_EQ(list()[0].at("unit"), "pulse/s^2");
    call("PUT", base + "/AC", R"({"value":60001})");
    EXPECT_EQ(gateway.submitted.size(), 1u);
}

TEST_F(HttpParameters, ATableGivesTheFormItsOwnValuesNeed) {
    std::vector<std::string> faults;
    gateway.catalogue = *Catalogue::parse(forms, faults);
    know("IC[4]", std::int64_t{1});
    know("AC", std::int64_t{500});
    const auto put = [&](const std::string& rows) {
        return call("PUT", base + ".csv?dry_run=1", "parameter,value\n" + rows, {{"Content-Type", "text/csv"}});
    };
    EXPECT_EQ(put("AC,100000\n").status, 422u) << "the drive has times";
    const auto both = put("AC,100000\nIC[4],0\n");
    EXPECT_EQ(both.status, 200u) << both.text << "the table makes them rates";
    know("IC[4]", std::int64_t{0});
    EXPECT_EQ(put("AC,100000\nIC[4],1\n").status, 422u) << "and here times";
}

TEST_F(HttpParameters, BitsAndRangesAreLegible) {
    std::vector<std::string> faults;
    gateway.catalogue = *Catalogue::parse(forms, faults);
    know("IL", std::int64_t{0x83});
    know("TG", std::int64_t{100});
    const auto list = call("GET", base).array();
    EXPECT_EQ(list[1].at("meaning"), nullptr) << "not read yet";
    EXPECT_EQ(list[2].at("meaning"), "action: stop; flag: on a change");
    EXPECT_EQ(json_text(list[2].at("fields")),
              R"([{"name":"action","low_bit":0,"bits":7,"allowed":[{"value":0,"meaning":"no action"},{"value":3,"meaning":"stop"}]},)"
              R"({"name":"flag","low_bit":7,"bits":1,"allowed":[{"value":0,"meaning":"always"},{"value":1,"meaning":"on a change"}]}])");
    EXPECT_EQ(list[3].at("meaning"), "filter");
    EXPECT_EQ(
        json_text(list[3].at("meanings")),
        R"([{"from":0,"through":0,"meaning":"continuous"},{"from":1,"through":60000,"meaning":"filter"},{"from":60001,"through":60001,"meaning":"one time"}])");
    const auto no = call("PUT", base + "/IL", R"({"value":2})");
    EXPECT_EQ(no.status, 422u);
    EXPECT_EQ(no.json.at("detail"), "IL.action: 2 (bits 6..0 of 2) is not allowed; allowed: 0 (no action), 3 (stop)");
}

TEST_F(HttpParameters, ReadsFromTheDrive) {
    know("PP[5]", std::int64_t{1});
    call("GET", base + "/PP%5B5%5D");
    ASSERT_EQ(gateway.submitted.size(), 1u);
    EXPECT_EQ(std::get<ReadParameter>(gateway.submitted[0].body).point, point("PP[5]"));
    EXPECT_EQ(gateway.submitted[0].axis, gateway.axis("feeder"));
    Result r = good_result(Outcome::done);
    r.value = std::int64_t{3};
    gateway.finish(r);
    const auto a = answered();
    EXPECT_EQ(a.at("id"), "PP[5]");
    EXPECT_EQ(a.at("value"), "3") << "what the drive said now, not what was known";
    EXPECT_EQ(a.at("quality"), "good");
    EXPECT_EQ(a.at("at"), "2026-01-02T03:04:05.678901Z");
    call("GET", base + "/acceleration");
    EXPECT_EQ(std::get<ReadParameter>(gateway.submitted[1].body).point, point("AC")) << "by name";
    call("GET", base + "/PP[5]");
    EXPECT_EQ(gateway.submitted.size(), 3u) << "raw brackets are understood";
}

TEST_F(HttpParameters, ADriveThatDoesNotAnswer) {
    for (const auto reason : {Reason::no_answer, Reason::line_down, Reason::busy}) {
        gateway.live_values.clear();
        gateway.at_once = [reason](const Command&) { return bad_result(reason, "silence"); };
        const auto unknown = call("GET", base + "/AC");
        EXPECT_EQ(unknown.status, reason == Reason::no_answer ? 504u : 503u);
        EXPECT_EQ(unknown.at("axis"), "feeder");
        know("AC", std::int64_t{7});
        const auto stale = call("GET", base + "/AC");
        EXPECT_EQ(stale.status, 200u);
        EXPECT_EQ(stale.at("value"), "7");
        EXPECT_EQ(stale.at("quality"), "stale");
        EXPECT_EQ(stale.at("text"), "silence");
        EXPECT_EQ(stale.at("at"), "2026-01-02T03:04:05.000000Z") << "when it was said, not now";
    }
    gateway.at_once = [](const Command&) { return bad_result(Reason::drive_refused, "locked", 50); };
    const auto refused = call("GET", base + "/AC");
    EXPECT_EQ(refused.status, 409u) << "a refusal is not silence";
    EXPECT_EQ(refused.at("code"), "50");
}

TEST_F(HttpParameters, CachedAndWriteOnlyNeedNoExchange) {
    know("AC", std::int64_t{7});
    EXPECT_EQ(call("GET", base + "/AC?cached=1").at("value"), "7");
    EXPECT_EQ(call("GET", base + "/MT?cached=1").at("quality"), "unknown");
    const auto key = call("GET", base + "/KEY");
    EXPECT_EQ(key.status, 200u);
    EXPECT_EQ(key.at("value"), "null");
    EXPECT_EQ(key.at("text"), "can only be written");
    EXPECT_TRUE(gateway.submitted.empty());
    EXPECT_EQ(call("GET", base + "/AC?cached=maybe").status, 400u);
}

TEST_F(HttpParameters, History) {
    gateway.stored_values["feeder"] = {{"AC", std::int64_t{3}, std::int64_t{2}, "a", "http", 2'000'000'000},
                                       {"AC", std::int64_t{2}, Value{}, "b", "modbus", 1'000'000'000}};
    const auto a = call("GET", base + "/AC?cached=1&history=5");
    EXPECT_EQ(a.at("history"),
              R"([{"value":3,"previous":2,"written_at":"1970-01-01T00:00:02.000000Z","written_by":"a","written_through":"http"},)"
              R"({"value":2,"previous":null,"written_at":"1970-01-01T00:00:01.000000Z","written_by":"b","written_through":"modbus"}])");
    EXPECT_EQ(call("GET", base + "/AC?cached=1").at("history"), "(missing)");
    EXPECT_EQ(call("GET", base + "/AC?cached=1&history=1001").status, 400u);
}

TEST_F(HttpParameters, UnknownOnes) {
    const auto a = call("GET", base + "/XX");
    EXPECT_EQ(a.status, 404u);
    EXPECT_EQ(a.at("reason"), "unknown_point");
    EXPECT_EQ(a.at("detail"), "a demo has no parameter XX");
    for (const auto* id : {"PP", "PP%5B0%5D", "PP%5B9%5D", "PP[x]", "protocol"}) {
        const auto r = call("GET", base + "/" + std::string(id));
        EXPECT_EQ(r.status, 404u) << id;
        EXPECT_EQ(r.at("detail"), "PP is an array: PP[1] to PP[8]") << id;
    }
    EXPECT_EQ(call("GET", base + "/AC%5B1%5D").status, 404u) << "not an array";
    EXPECT_EQ(call("GET", "/api/v1/axes/none/parameters/AC").status, 404u);
    EXPECT_EQ(call("PUT", "/api/v1/axes/none/parameters/AC", R"({"value":1})").status, 404u);
    EXPECT_EQ(call("PUT", base + "/XX", R"({"value":1})").status, 404u);
}

TEST_F(HttpParameters, Writes) {
    call("PUT", base + "/AC", R"({"value":25000})");
    ASSERT_EQ(gateway.submitted.size(), 1u);
    const auto& w = std::get<WriteParameter>(gateway.submitted[0].body);
    EXPECT_EQ(w.point, point("AC"));
    EXPECT_EQ(w.value, Value{std::int64_t{25000}});
    EXPECT_EQ(gateway.submitted[0].origin.text(), "http 127.0.0.1:51123");
    Result r = good_result(Outcome::done);
    r.value = std::int64_t{24999};
    gateway.finish(r);
    const auto a = answered();
    EXPECT_EQ(a.status, 200u);
    EXPECT_EQ(a.at("result"), "done");
    EXPECT_EQ(a.at("value"), "24999") << "what the drive took";
    gateway.at_once = [](const Command&) { return good_result(); };
    EXPECT_EQ(call("PUT", base + "/MT", R"({"value":16.0})").status, 200u) << "a whole double is a whole number";
    EXPECT_EQ(call("PUT", base + "/N%5B3%5D", R"({"value":1.5})").status, 200u);
    EXPECT_EQ(std::get<WriteParameter>(gateway.submitted.back().body).value, Value{1.5});
    EXPECT_EQ(call("PUT", base + "/KEY", R"({"value":1})").status, 200u) << "write-only";
}

TEST_F(HttpParameters, TheCatalogueIsAskedFirst) {
    const auto range = call("PUT", base + "/AC", R"({"value":0})");
    EXPECT_EQ(range.status, 422u);
    EXPECT_EQ(range.at("reason"), "out_of_range");
    EXPECT_EQ(range.at("detail"), "AC: 0 is outside 1..65000000 pulse/s^2");
    EXPECT_EQ(range.fault().at("pointer"), "/value");
    EXPECT_NE(call("PUT", base + "/MT", R"({"value":3})").at("detail").find("allowed: 1 (full), 16 (sixteenth)"), std::string::npos);
    for (const auto* bad : {R"({"value":1.5})", R"({"value":"20000"})", R"({"value":1e30})"})
        EXPECT_EQ(call("PUT", base + "/AC", bad).status, 422u) << bad;
    for (const auto* bad :
         {R"({})", R"({"value":null})", R"({"value":[1]})", R"({"value":18446744073709551615})", R"({"value":1,"x":2})"}) {
        const auto a = call("PUT", base + "/AC", bad);
        EXPECT_EQ(a.status, 422u) << bad;
        EXPECT_EQ(a.at("reason"), "invalid") << bad;
    }
    const auto read_only = call("PUT", base + "/ML", R"({"value":"x"})");
    EXPECT_EQ(read_only.status, 409u);
    EXPECT_EQ(read_only.at("reason"), "not_writable");
    EXPECT_TRUE(gateway.submitted.empty());
}

TEST_F(HttpParameters, AWriteThatCouldNotBeStored) {
    gateway.at_once = [](const Command&) {
        return bad_result(Reason::not_stored, "the drive took it, the disk is full", 0, Outcome::failed);
    };
    const auto a = call("PUT", base + "/AC", R"({"value":25000})");
    EXPECT_EQ(a.status, 507u);
    EXPECT_EQ(a.at("result"), "failed");
    gateway.at_once = [](const Command&) { return bad_result(Reason::drive_refused, "locked", 50); };
    EXPECT_EQ(call("PUT", base + "/AC", R"({"value":25000})").at("code"), "50");
}
}  // namespace
}  // namespace axisgate::http::test
