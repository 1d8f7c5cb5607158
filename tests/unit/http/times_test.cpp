// Times in documents: each is a text of UTC (RFC 3339) that parses back to the instant, or null; none is a number.
#include <boost/json.hpp>

#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {

constexpr std::int64_t instant = 1'772'323'445'500'000'000;  // 2026-03-01 00:04:05.5 UTC
constexpr const char* written = "2026-03-01T00:04:05.5";

TEST_F(HttpTest, SinceOfTheModbusDoorsConnections) {
    gateway.modbus_door.emplace();
    gateway.modbus_door->connections.push_back({"192.0.2.7:50123", 3, 1, 0, instant, {}});
    const auto a = call("GET", "/api/v1/modbus");
    ASSERT_EQ(a.status, 200u);
    const auto& since = a.json.at("connections").at(0).at("since");
    ASSERT_TRUE(since.is_string()) << json_text(since);
    EXPECT_EQ(since.get_string().find(written), 0u) << json_text(since);
    EXPECT_EQ(since.get_string().back(), 'Z');
}

TEST_F(HttpTest, SinceOfAnAuthority) {
    const auto nobody = call("GET", "/api/v1/axes/slide/authority");
    EXPECT_EQ(nobody.at("since"), "null");
    gateway.now_ns = instant + 2'000'000'000;
    AxisPicture p = standing(1);
    p.authority_since = at_ns(instant - gateway.to_unix_ns(time_zero));
    p.authority_until = at_ns(instant + 60'000'000'000 - gateway.to_unix_ns(time_zero));
    std::ranges::copy(std::string_view("anna"), p.authority_holder.begin());
    gateway.set_picture("slide", p);
    const auto a = call("GET", "/api/v1/axes/slide/authority");
    EXPECT_EQ(a.at("holder"), "anna");
    EXPECT_EQ(a.at("since").find(written), 0u) << a.at("since");
    EXPECT_EQ(a.at("since").back(), 'Z');
}

TEST_F(HttpTest, ConfirmByOfAStageOnTrial) {
    EXPECT_EQ(call("GET", "/api/v1/site/stage").at("confirm_by"), "null");
    ASSERT_EQ(gateway.stage.stage(Site(gateway.site()->site), gateway.site()->revision, "http anna"), "");
    EXPECT_EQ(call("GET", "/api/v1/site/stage").at("confirm_by"), "null") << "not on trial yet";
    ASSERT_EQ(gateway.stage.begin_apply(gateway.site()->revision, 60, instant - 60'000'000'000, "http anna"), "");
    gateway.stage.applied(true);
    const auto a = call("GET", "/api/v1/site/stage");
    EXPECT_EQ(a.at("confirm_by").find(written), 0u) << a.at("confirm_by");
    EXPECT_EQ(a.at("confirm_by").back(), 'Z');
}

}  // namespace
}  // namespace axisgate::http::test
