// Drive descriptions over HTTP: stored, shown, downloaded, refused with their lines, and kept while a drive names them.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>

#include "gateway/core/text.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace json = boost::json;
namespace {
std::string file(const std::string& name) {
    std::ifstream in(AXISGATE_SOURCE_DIR "/tests/unit/canopen/eds/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

class Descriptions : public HttpTest {
protected:
    Answer post(const std::string& query, std::string text) {
        return call("POST", "/api/v1/descriptions" + query, std::move(text), {{"Content-Type", "text/plain"}});
    }
    std::string servo = file("servo.eds");
};

TEST_F(Descriptions, AFileIsKeptShownAndGivenBackByteByByte) {
    const auto made = post("?name=servo-one.eds", servo);
    ASSERT_EQ(made.status, 201u) << made.text;
    EXPECT_EQ(made.headers.get("Location"), "/api/v1/descriptions/servo-one.eds");
    EXPECT_EQ(made.at("vendor"), "Example Motion");
    EXPECT_EQ(made.at("vendor_number"), "427");
    EXPECT_EQ(made.at("product_number"), "4660");
    EXPECT_EQ(made.at("used_by"), "[]");
    const auto facts = call("GET", "/api/v1/descriptions/servo-one.eds");
    EXPECT_EQ(facts.json, made.json);
    const auto& pdos = facts.object().at("pdos").as_array();
    ASSERT_EQ(pdos.size(), 2u);
    EXPECT_EQ(pdos[0].at("direction").as_string(), "receive");
    EXPECT_EQ(pdos[0].at("mapped").as_array().at(0).at("object").as_string(), "6040h");
    for (const auto& [path, accept] : {std::pair{"?format=eds", "*/*"}, {"", "text/plain"}}) {
        const auto back = call("GET", std::string("/api/v1/descriptions/servo-one.eds") + path, {}, {{"Accept", accept}});
        EXPECT_EQ(back.text, servo) << path;
        EXPECT_EQ(back.headers.get("Content-Type"), "text/plain; charset=utf-8");
    }
    EXPECT_EQ(call("GET", "/api/v1/descriptions/servo-one.eds?format=dcf").status, 400u);
    EXPECT_EQ(call("GET", "/api/v1/descriptions/servo-one.eds", {}, {{"Accept", "image/png"}}).status, 406u);
    EXPECT_EQ(call("GET", "/api/v1/descriptions/other.eds").status, 404u);
    const auto list = call("GET", "/api/v1/descriptions");
    ASSERT_EQ(list.array().size(), 1u);
    EXPECT_FALSE(list.array()[0].as_object().contains("pdos"));
    EXPECT_EQ(list.array()[0].at("product").as_string(), "Servo One");
}

TEST_F(Descriptions, ABodyOfJsonDoesTheSameAndTheSameFileTwiceIsNoConflict) {
    const auto body = json_text(json::object{{"name", "a.eds"}, {"text", servo}});
    ASSERT_EQ(call("POST", "/api/v1/descriptions", body).status, 201u);
    EXPECT_EQ(call("POST", "/api/v1/descriptions", body).status, 200u);
    EXPECT_EQ(post("?name=a.eds", servo + "\n").status, 409u) << "another text never takes the place of one that sites may rest on";
    EXPECT_EQ(gateway.shelf.find("a.eds")->text, servo);
}

TEST_F(Descriptions, OddRowsAreWarningsAndTheObjectsCanBeLookedAt) {
    auto odd = servo;
    const auto at = odd.find("DataType=0x0006");
    ASSERT_NE(at, std::string::npos);
    const auto line = std::count(odd.begin(), odd.begin() + static_cast<std::ptrdiff_t>(at), '\n') + 1;
    odd.replace(at, 15, "DataType=0x0999");
    const auto added = post("?name=a.eds", odd);
    ASSERT_EQ(added.status, 201u);
    EXPECT_THAT(added.at("warnings"), testing::HasSubstr("\"line\":" + std::to_string(line) + ",\"text\":\"DataType \\\"0x0999\\\""));
    const auto objects = call("GET", "/api/v1/descriptions/a.eds/objects");
    EXPECT_EQ(objects.status, 200u);
    EXPECT_THAT(objects.text, testing::HasSubstr(R"("object":"1000h")"));
    EXPECT_THAT(objects.text, testing::HasSubstr(R"("$NODEID + )"));
    EXPECT_EQ(call("GET", "/api/v1/descriptions/b.eds/objects").status, 404u);
}

TEST_F(Descriptions, WhatIsWrongIsToldWithItsLineAndNothingIsKept) {
    EXPECT_EQ(post("?name=a.eds", "").status, 422u);
    EXPECT_EQ(post("?name=a.eds", "no file of keys").status, 422u);
    auto pump = servo;
    pump.replace(pump.find("0x00020192"), 10, "0x00020191");
    EXPECT_THAT(post("?name=a.eds", pump).text, testing::HasSubstr("profile 401"));
    for (const auto* name : {"", "?name=a", "?name=.eds", "?name=a%2Fb.eds", "?name=a.exe"})
        EXPECT_EQ(post(name, servo).status, 422u) << name;
    EXPECT_EQ(call("POST", "/api/v1/descriptions", R"({"name": "a.eds", "txt": "x"})").status, 422u);
    EXPECT_EQ(call("POST", "/api/v1/descriptions?name=a.eds", servo, {{"Content-Type", "text/csv"}}).status, 415u);
    EXPECT_TRUE(gateway.shelf.all().empty());
    gateway.description_fault = "the disk is full";
    EXPECT_EQ(post("?name=a.eds", servo).status, 507u);
    EXPECT_TRUE(gateway.shelf.all().empty());
}

TEST_F(Descriptions, OneThatADriveNamesStays) {
    ASSERT_EQ(post("?name=a.eds", servo).status, 201u);
    Site site = gateway.site()->site;
    site.drives[0].description = "a.eds";
    gateway.put_site(site);
    const auto refused = call("DELETE", "/api/v1/descriptions/a.eds");
    EXPECT_EQ(refused.status, 409u);
    EXPECT_EQ(refused.at("used_by"), R"(["feeder"])");
    EXPECT_EQ(call("GET", "/api/v1/descriptions/a.eds").at("used_by"), R"(["feeder"])");
    site.drives[0].description.clear();
    gateway.put_site(site);
    EXPECT_EQ(call("DELETE", "/api/v1/descriptions/a.eds").status, 204u);
    EXPECT_EQ(call("DELETE", "/api/v1/descriptions/a.eds").status, 404u);
}

TEST_F(Descriptions, ADriveOfAFamilyThatTakesNoneCannotNameOne) {
    const auto refused = call("PATCH", "/api/v1/drives/feeder", R"({"description": "a.eds"})");
    EXPECT_EQ(refused.status, 422u);
    EXPECT_THAT(refused.text, testing::HasSubstr("family demo"));
}

}  // namespace
}  // namespace axisgate::http::test
