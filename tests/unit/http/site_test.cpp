// The site over REST: entries one by one, references, renaming, cascades, revisions, races; and the whole document.
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {
namespace json = boost::json;

TEST_F(HttpTest, AddingEntries) {
    const auto a = call("POST", "/api/v1/axes", R"({"name":"x.1","drive":"bare","number":3})");
    EXPECT_EQ(a.status, 201u) << a.text;
    EXPECT_EQ(a.headers.get("Location"), "/api/v1/axes/x.1");
    EXPECT_EQ(a.headers.get("Site-Revision"), "2");
    EXPECT_EQ(a.at("name"), "x.1");
    EXPECT_EQ(a.at("online"), "false") << "the whole document, with its state";
    EXPECT_EQ(gateway.site()->site.axes.size(), 3u);
    EXPECT_EQ(gateway.applied.back().second, 1u) << "for the revision it was made on";
    EXPECT_EQ(call("POST", "/api/v1/lines", R"({"name":"can2","uri":"twin","family":"demo"})").status, 201u);
    EXPECT_EQ(call("POST", "/api/v1/drives", R"({"name":"d","line":"can2","address":1})").status, 201u);
    const auto taken = call("POST", "/api/v1/lines", R"({"name":"can0","uri":"twin","family":"demo"})");
    EXPECT_EQ(taken.status, 409u);
    EXPECT_NE(taken.at("detail").find("can0"), std::string::npos);
}

TEST_F(HttpTest, FaultsPointIntoTheBodyWhereTheyAreThere) {
    const auto a = call("POST", "/api/v1/axes", R"({"name":"x y","drive":"none","speed":1})");
    EXPECT_EQ(a.status, 422u);
    EXPECT_EQ(a.at("reason"), "invalid");
    std::string pointers;
    for (const auto& f : a.object().at("faults").get_array())
        pointers += std::string(f.at("pointer").get_string()) + " ";
    EXPECT_EQ(pointers, "/name /number /speed /drive ");
    for (const auto& f : a.object().at("faults").get_array()) {
        EXPECT_EQ(f.at("document"), "body");
        EXPECT_FALSE(f.at("remedy").get_string().empty());
    }
    EXPECT_TRUE(gateway.applied.empty());
    // A line of another family makes an entry wrong that is not in the body.
    auto site = gateway.site()->site;
    site.axes[1].channel = 2;
    gateway.put_site(site);
    const auto other = call("PUT", "/api/v1/lines/can0", R"({"uri":"twin","family":"nothing"})");
    EXPECT_EQ(other.status, 422u);
    EXPECT_EQ(other.fault().at("pointer"), "/family");
}

TEST_F(HttpTest, ReplacingAndPatching) {
    const auto put = call("PUT", "/api/v1/axes/feeder", R"({"drive":"feeder","number":1,"unit":"deg","increments_per_unit":10})");
    EXPECT_EQ(put.status, 200u) << put.text;
    EXPECT_EQ(put.at("unit"), "deg");
    EXPECT_EQ(put.at("name"), "feeder") << "the name of the path";
    const auto patch = call("PATCH", "/api/v1/axes/feeder", R"({"position_max":90.5,"unit":null})");
    EXPECT_EQ(patch.at("unit"), "") << "null removes";
    EXPECT_EQ(patch.at("position_max"), "90.5");
    EXPECT_EQ(patch.at("increments_per_unit"), "10") << "the rest stays";
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"number":null})").status, 422u);
    const auto taken = call("PATCH", "/api/v1/axes/feeder", R"({"number":2})");
    EXPECT_EQ(taken.status, 422u);
    EXPECT_EQ(taken.fault().at("pointer"), "/axes/1/number") << "the entry that is wrong then is another one";
    EXPECT_EQ(taken.fault().at("document"), "site");
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder", R"({"presence":"twin","options":{"a":1}})").at("presence"), "twin");
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder", R"({"options":{"b":"x"}})").at("options"), R"({"a":"1","b":"x"})");
    EXPECT_EQ(call("PUT", "/api/v1/axes/none", R"({"drive":"feeder","number":9})").status, 404u) << "PUT replaces, POST adds";
    EXPECT_EQ(call("PATCH", "/api/v1/lines/none", "{}").status, 404u);
    EXPECT_EQ(call("PUT", "/api/v1/drives/none", R"({"line":"can0"})").status, 404u);
}

TEST_F(HttpTest, WhatWasReadCanBeWrittenBack) {
    gateway.set_picture("feeder", standing(5));
    for (const auto* path : {"/api/v1/axes/feeder", "/api/v1/drives/feeder", "/api/v1/lines/can0"}) {
        const auto read = call("GET", path);
        const auto written = call("PUT", path, read.text);
        EXPECT_EQ(written.status, 200u) << path << written.text;
    }
    EXPECT_TRUE(gateway.applied.empty()) << "nothing differs, so nothing is disturbed";
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"position":99,"online":true})").status, 200u) << "state is not a wish";
}

TEST_F(HttpTest, Renaming) {
    const auto line = call("PATCH", "/api/v1/lines/can0", R"({"name":"bus"})");
    EXPECT_EQ(line.status, 200u) << line.text;
    EXPECT_EQ(line.at("drives"), R"(["feeder","slide"])") << "drives follow";
    EXPECT_EQ(call("PATCH", "/api/v1/drives/feeder", R"({"name":"infeed"})").at("axes"), R"(["feeder"])");
    EXPECT_EQ(gateway.site()->site.axes[0].drive, "infeed");
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"name":"infeed"})").status, 200u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder").status, 404u);
    const auto mapped = call("PATCH", "/api/v1/axes/slide", R"({"name":"other"})");
    EXPECT_EQ(mapped.status, 409u);
    EXPECT_NE(mapped.at("detail").find("mapping 0"), std::string::npos) << mapped.at("detail");
    EXPECT_EQ(call("PUT", "/api/v1/lines/bus", R"({"name":"can1","uri":"twin","family":"demo"})").status, 409u) << "that name is taken";
    EXPECT_EQ(call("PATCH", "/api/v1/lines/bus", R"({"name":5})").status, 422u);
    EXPECT_EQ(call("PATCH", "/api/v1/lines/bus", R"({"name":null})").status, 422u);
    EXPECT_EQ(call("PUT", "/api/v1/lines/bus", R"({"name":"","uri":"twin","family":"demo"})").status, 422u);
    EXPECT_EQ(gateway.site()->site.drives[0].line, "bus") << "a refused or empty name moves nothing";
}

TEST_F(HttpTest, Removing) {
    const auto used = call("DELETE", "/api/v1/lines/can0");
    EXPECT_EQ(used.status, 409u);
    EXPECT_EQ(used.at("detail"), "line can0 is still used by drives: feeder, slide; remove them first, or add ?cascade=1");
    EXPECT_EQ(call("DELETE", "/api/v1/drives/feeder").at("detail"),
              "drive feeder is still used by axes: feeder; remove them first, or add ?cascade=1");
    EXPECT_EQ(call("DELETE", "/api/v1/axes/slide").status, 409u) << "a mapping names it";
    EXPECT_TRUE(gateway.applied.empty());
    const auto a = call("DELETE", "/api/v1/axes/feeder");
    EXPECT_EQ(a.status, 204u);
    EXPECT_EQ(a.text, "");
    EXPECT_EQ(a.headers.get("Site-Revision"), "2");
    EXPECT_EQ(call("DELETE", "/api/v1/axes/feeder").status, 404u);
    EXPECT_EQ(call("DELETE", "/api/v1/axes/slide?cascade=1").status, 204u);
    EXPECT_TRUE(gateway.site()->site.map().empty());
    EXPECT_EQ(call("DELETE", "/api/v1/lines/can0?cascade=x").status, 400u);
}

TEST_F(HttpTest, RemovingWithAllThatHangsOnIt) {
    EXPECT_EQ(call("DELETE", "/api/v1/lines/can0?cascade=1").status, 204u);
    const auto& site = gateway.site()->site;
    EXPECT_EQ(site.lines.size(), 1u);
    EXPECT_EQ(site.drives.size(), 1u);
    EXPECT_EQ(site.drives[0].name, "bare");
    EXPECT_TRUE(site.axes.empty());
    EXPECT_TRUE(site.map().empty());
}

TEST_F(HttpTest, RevisionsAndIfMatch) {
    const auto get = call("GET", "/api/v1/site");
    EXPECT_EQ(get.headers.get("ETag"), "\"1\"");
    EXPECT_EQ(call("GET", "/api/v1/site", "", {{"If-None-Match", "\"1\""}}).status, 304u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})", {{"If-Match", "\"1\""}}).status, 200u);
    const auto old = call("PATCH", "/api/v1/axes/feeder", R"({"unit":"km"})", {{"If-Match", "\"1\""}});
    EXPECT_EQ(old.status, 412u);
    EXPECT_EQ(old.headers.get("ETag"), "\"2\"");
    EXPECT_EQ(old.at("etag"), "\"2\"");
    EXPECT_EQ(old.object().at("current").at("axes").at(0).at("unit"), "m");
    EXPECT_EQ(old.at("changes"), "null") << "the history has no revision 1";
    EXPECT_EQ(call("DELETE", "/api/v1/axes/feeder", "", {{"If-Match", "\"1\""}}).status, 412u);
    EXPECT_EQ(call("POST", "/api/v1/lines", R"({"name":"l","uri":"twin","family":"demo"})", {{"If-Match", "\"9\""}}).status, 412u);
    EXPECT_EQ(call("PUT", "/api/v1/site", get.text, {{"If-Match", "\"1\""}}).status, 412u);
    EXPECT_EQ(call("PUT", "/api/v1/site", get.text, {{"If-Match", "*"}}).status, 200u);
    settings.require_if_match = true;
    EXPECT_EQ(call("PUT", "/api/v1/site", get.text).status, 428u);
    EXPECT_EQ(call("PUT", "/api/v1/site?dry_run=1", get.text).status, 200u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})").status, 200u) << "only the whole document";
}

TEST_F(HttpTest, WhoComesSecondIsToldWhatChangedMeanwhile) {
    const auto first = call("GET", "/api/v1/site").text;
    gateway.kept_sites[1] = {1, 0, "me", first, first.size()};
    ASSERT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})").status, 200u);
    ASSERT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"number":9})").status, 200u);
    for (const auto& [method, path, body] : {std::array<std::string, 3>{"PATCH", "/api/v1/axes/feeder", R"({"unit":"km"})"},
                                             {"PUT", "/api/v1/site", first},
                                             {"POST", "/api/v1/site/stage", first},
                                             {"DELETE", "/api/v1/axes/feeder", ""}}) {
        const auto second = call(method, path, body, {{"If-Match", "\"7\", \"1\""}});
        ASSERT_EQ(second.status, 412u) << method;
        const auto& changes = second.object().at("changes").as_array();
        ASSERT_EQ(changes.size(), 1u) << second.text;
        EXPECT_EQ(changes[0].at("what"), "axes/feeder");
        EXPECT_EQ(changes[0].at("before").at("unit"), "mm");
        EXPECT_EQ(changes[0].at("after").at("unit"), "m");
        EXPECT_EQ(changes[0].at("after").at("number"), 9);
    }
    gateway.kept_sites[1].text = "{";
    EXPECT_EQ(call("DELETE", "/api/v1/axes/feeder", "", {{"If-Match", "\"1\""}}).at("changes"), "null");
}

TEST_F(HttpTest, AChangeThatLostARaceIsMadeAgain) {
    gateway.apply = FakeGateway::Apply::overtake_once;
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})").status, 200u);
    EXPECT_EQ(gateway.applied.size(), 2u);
    EXPECT_EQ(gateway.applied[1].second, 2u);
    EXPECT_EQ(gateway.site()->site.axes[0].unit, "m");
    gateway.apply = FakeGateway::Apply::overtake_always;
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"km"})").status, 503u) << "but not for ever";
    EXPECT_EQ(gateway.applied.size(), 5u);
    gateway.apply = FakeGateway::Apply::overtake_once;
    const std::string tag = "\"" + std::to_string(gateway.site()->revision) + "\"";
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"km"})", {{"If-Match", tag}}).status, 412u)
        << "with If-Match it is for that revision alone";
}

TEST_F(HttpTest, ChangesAtTheSameTimeGoOneAfterTheOther) {
    gateway.apply = FakeGateway::Apply::later;
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})").status, 0u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"position_max":5})", {{"If-Match", "\"1\""}}).status, 0u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"number":9})").status, 0u);
    EXPECT_EQ(gateway.applied.size(), 1u) << "the others wait";
    gateway.apply_waiting();
    ASSERT_EQ(later.size(), 2u);
    EXPECT_EQ(later[0].status, 200u);
    EXPECT_EQ(later[1].status, 412u) << "it was for the revision before";
    ASSERT_EQ(gateway.applied.size(), 2u);
    EXPECT_EQ(gateway.applied[1].second, 2u) << "made on what the first one left";
    gateway.apply_waiting();
    EXPECT_EQ(later.size(), 3u);
    EXPECT_EQ(gateway.site()->site.axes[0].unit, "m");
    EXPECT_EQ(gateway.site()->site.axes[0].number, 9);
}

TEST_F(HttpTest, ChangesThatWaitAreBounded) {
    gateway.apply = FakeGateway::Apply::later;
    for (std::size_t i = 0; i <= ChangeQueue::most_waiting; ++i)
        EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})").status, 0u) << i;
    const auto a = call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})");
    EXPECT_EQ(a.status, 503u);
    EXPECT_EQ(a.at("reason"), "busy");
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder").status, 200u) << "reading does not wait";
    gateway.apply = FakeGateway::Apply::now;
    gateway.apply_waiting();  // the rest causes no more changes and is answered at once
    EXPECT_EQ(gateway.applied.size(), 1u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"km"})").status, 200u) << "room again";
}

TEST_F(HttpTest, ASiteThatCannotBeStored) {
    gateway.apply = FakeGateway::Apply::fail;
    const auto a = call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})");
    EXPECT_EQ(a.status, 507u);
    EXPECT_EQ(a.at("detail"), "the disk is full");
    EXPECT_EQ(a.at("reason"), "not_stored");
    EXPECT_EQ(call("PUT", "/api/v1/site", R"({"lines":[]})").status, 507u);
}

TEST_F(HttpTest, ALateAnswerOfTheGateway) {
    gateway.apply = FakeGateway::Apply::later;
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"unit":"m"})").status, 0u);
    EXPECT_TRUE(promised);
    EXPECT_EQ(at_limit.status, 504u);
    gateway.apply_waiting();
    EXPECT_EQ(answered().at("unit"), "m");
}

TEST_F(HttpTest, WholeSite) {
    const auto get = call("GET", "/api/v1/site");
    EXPECT_EQ(get.object().size(), 4u);
    EXPECT_EQ(get.json.at("mappings").get_array().size(), 1u);
    auto changed = get.json;
    changed.at("axes").get_array()[0].get_object()["unit"] = "deg";
    changed.at("drives").get_array().erase(changed.at("drives").get_array().begin() + 2);
    const auto dry = call("PUT", "/api/v1/site?dry_run=1", json_text(changed));
    EXPECT_EQ(dry.status, 200u);
    EXPECT_EQ(
        dry.text,
        R"({"dry_run":true,"valid":true,"revision":1,"differences":["drive bare: removed","axis feeder: unit \"mm\" -> \"deg\""],"faults":[]})");
    EXPECT_TRUE(gateway.applied.empty());
    const auto put = call("PUT", "/api/v1/site", json_text(changed));
    EXPECT_EQ(put.status, 200u);
    EXPECT_EQ(put.at("revision"), "2");
    EXPECT_EQ(put.headers.get("ETag"), "\"2\"");
    EXPECT_EQ(put.json.at("differences").get_array().size(), 2u);
    EXPECT_EQ(call("PUT", "/api/v1/site", json_text(changed)).at("revision"), "2") << "the same again changes nothing";
    EXPECT_EQ(gateway.applied.size(), 1u);
}

TEST_F(HttpTest, WrongSites) {
    const std::string wrong = R"({"lines":[{"name":"a","uri":"nonsense:","family":"x"}],"what":1})";
    const auto dry = call("PUT", "/api/v1/site?dry_run=true", wrong);
    EXPECT_EQ(dry.status, 200u);
    EXPECT_EQ(dry.at("valid"), "false");
    EXPECT_EQ(dry.json.at("faults").get_array().size(), 3u);
    const auto put = call("PUT", "/api/v1/site", wrong);
    EXPECT_EQ(put.status, 422u);
    EXPECT_EQ(put.object().at("faults").get_array().size(), 3u) << "all at once";
    EXPECT_EQ(put.fault().at("pointer"), "/what");
    EXPECT_EQ(put.fault(1).at("pointer"), "/lines/0/family");
    EXPECT_EQ(call("PUT", "/api/v1/site?dry_run=7", "{}").status, 400u);
    EXPECT_TRUE(gateway.applied.empty());
}
TEST_F(HttpTest, ANameThatAUrlCannotCarryIsRefusedWhereItIsGivenAndNotWhereItStoodBefore) {
    for (const auto* name : {".", "..", "...", "_x", "-x", ".x"}) {
        const auto a = call("PATCH", "/api/v1/axes/feeder", std::string(R"({"name":")") + name + "\"}");
        EXPECT_EQ(a.status, 422u) << name << a.text;
        EXPECT_NE(a.text.find("begin with a letter or digit"), std::string::npos) << a.text;
    }
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"name":"x_-."})").status, 200u);
    // A name that an older program accepted stays valid with other changes, and can be changed.
    Site old = gateway.site()->site;
    old.axes[0].name = "_old";
    gateway.put_site(std::move(old));
    EXPECT_EQ(call("PATCH", "/api/v1/axes/_old", R"({"unit":"m"})").status, 200u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/_old", R"({"name":"-old"})").status, 422u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/_old", R"({"name":"old"})").status, 200u);
}

}  // namespace
}  // namespace axisgate::http::test
