// The fleet over HTTP: gateways with their axes, and commands to axes of others, with the same roles as commands to axes of this one.
#include <gtest/gtest.h>

#include "gateway/doors/http/words.hpp"
#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {

class FleetOverHttp : public HttpTest {
protected:
    void SetUp() override {
        FleetGateway g;
        g.name = "hall-2";
        g.instance = 17;
        FleetAxis a;
        a.name = "lift";
        a.unit = "mm";
        a.increments_per_unit = 100;
        a.position = 1250;
        a.online = true;
        a.statusword = 0x0637;
        a.at_unix_ns = 1'000'000'000;
        a.age_ms = 300;
        g.silent_ms = 450;
        g.axes = {a};
        gateway.gateways = {g};
    }
};

TEST_F(FleetOverHttp, GatewaysAreToldWithTheirAxesInUnits) {
    const auto list = call("GET", "/api/v1/fleet");
    ASSERT_EQ(list.status, 200u) << list.text;
    const auto& g = list.object().at("gateways").as_array().at(0).as_object();
    EXPECT_EQ(g.at("gateway").as_string(), "hall-2");
    EXPECT_EQ(g.at("instance").as_string(), "17");
    EXPECT_EQ(g.at("axes").as_array().at(0).at("position").to_number<double>(), 12.5);
    EXPECT_EQ(g.at("silent_ms").as_int64(), 450);
    EXPECT_EQ(g.at("axes").as_array().at(0).at("state").as_string(), "operation_enabled");
    EXPECT_EQ(g.at("axes").as_array().at(0).at("increments_per_unit").to_number<double>(), 100);
    EXPECT_EQ(g.at("axes").as_array().at(0).at("age_ms").as_int64(), 300);
    gateway.gateways[0].axes[0].age_ms = -1;
    const auto never = call("GET", "/api/v1/fleet");
    EXPECT_TRUE(never.object().at("gateways").as_array().at(0).at("axes").as_array().at(0).at("age_ms").is_null());
    gateway.gateways.clear();
    EXPECT_EQ(call("GET", "/api/v1/fleet").at("enabled"), "false");
}

TEST_F(FleetOverHttp, ACommandGoesToItsGatewayAndComesBackWithItsOneResult) {
    gateway.fleet_result.outcome = Outcome::done;
    const auto good = call("POST", "/api/v1/fleet/hall-2/axes/lift/commands?wait=5", R"({"command":"enable"})");
    ASSERT_EQ(good.status, 200u) << good.text;
    EXPECT_EQ(good.at("result"), "done");
    ASSERT_EQ(gateway.orders.size(), 1u);
    EXPECT_EQ(gateway.orders[0].gateway, "hall-2");
    EXPECT_EQ(gateway.orders[0].axis, "lift");
    EXPECT_TRUE(gateway.orders[0].until_done);
    EXPECT_EQ(gateway.orders[0].wish.word, CommandWord::enable);
    EXPECT_EQ(gateway.orders[0].origin.door, http::clients);
    gateway.fleet_result.outcome = Outcome::refused;
    gateway.fleet_result.reason = Reason::wrong_state;
    gateway.fleet_result.text = "axis lift is not enabled";
    const auto refused = call("POST", "/api/v1/fleet/hall-2/axes/lift/commands", R"({"command":"home"})");
    EXPECT_EQ(refused.status, 409u);
    EXPECT_NE(refused.text.find("axis lift is not enabled"), std::string::npos) << refused.text;
    gateway.fleet_result.reason = Reason::unknown_point;
    gateway.fleet_result.text = "there is no gateway hall-9 in the domain";
    const auto nobody = call("POST", "/api/v1/fleet/hall-9/axes/lift/commands", R"({"command":"enable"})");
    EXPECT_EQ(nobody.status, 404u);
    EXPECT_EQ(nobody.at("reason"), "not_found");
    gateway.fleet_result.reason = Reason::line_down;
    gateway.fleet_result.text = "the axis hall-2/nobody has not been heard of yet";
    EXPECT_EQ(call("POST", "/api/v1/fleet/hall-2/axes/nobody/commands", R"({"command":"enable"})").status, 503u) << "and no 404 before";
}

TEST_F(FleetOverHttp, AStopIsHandedToTheFleetWhateverIsKnownOfItsGatewayAndAxis) {
    gateway.gateways.push_back(gateway.gateways[0]);  // two of one name
    gateway.gateways[1].instance = 18;
    gateway.fleet_result.outcome = Outcome::accepted;
    for (const auto* path : {"/api/v1/fleet/hall-2/axes/lift/commands", "/api/v1/fleet/hall-2/axes/nobody/commands",
                             "/api/v1/fleet/hall-9/axes/lift/commands"}) {
        gateway.orders.clear();
        EXPECT_EQ(call("POST", path, R"({"command":"quick_stop"})").status, 200u) << path;
        EXPECT_EQ(gateway.orders.size(), 1u) << path;
    }
}

}  // namespace
}  // namespace axisgate::http::test
