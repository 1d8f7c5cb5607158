// Ports of the host over HTTP: the URI for a line at each, and the line that uses it already; the group of an axis.
#include <gtest/gtest.h>

#include "tests/unit/http/harness.hpp"

namespace axisgate::http::test {
namespace {

class HostPortsOverHttp : public HttpTest {};

TEST_F(HostPortsOverHttp, EachIsAUriToTakeAndTheLineThatIsThere) {
    EXPECT_EQ(call("GET", "/api/v1/host/ports").text, "[]");
    gateway.ports_of_host = {{SystemPort::Kind::can, "can7", "", "mcp251x", false},
                             {SystemPort::Kind::serial, "ttyUSB0", "/dev/serial/by-id/usb-A", "FTDI A", true},
                             {SystemPort::Kind::serial, "ttyS0", "/dev/ttyS0", "", true}};
    const auto put = [this](const char* name, const char* uri) {
        const auto r = call("POST", "/api/v1/lines", fmt::format(R"({{"name":"{}","uri":"{}","family":"demo"}})", name, uri));
        EXPECT_EQ(r.status, 201u) << r.text;
    };
    put("bus", "can:can7");
    put("pump", "serial:/dev/ttyUSB0?baud=9600");
    const auto list = call("GET", "/api/v1/host/ports");
    ASSERT_EQ(list.status, 200u) << list.text;
    EXPECT_EQ(list.text,
              R"([{"kind":"can","name":"can7","uri":"can:can7","text":"mcp251x","up":false,"line":"bus"},)"
              R"({"kind":"serial","name":"ttyUSB0","uri":"serial:/dev/serial/by-id/usb-A","text":"FTDI A","up":true,"line":"pump"},)"
              R"({"kind":"serial","name":"ttyS0","uri":"serial:/dev/ttyS0","text":"","up":true,"line":null}])");
}

TEST_F(HostPortsOverHttp, AGroupIsAPlainTextOfAnAxis) {
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"group":"Zufuhr 1"})").status, 200u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder").at("group"), "Zufuhr 1");
    for (const std::string bad : {R"("a\nb")", R"(" a")", R"("a ")", R"(1)"}) {
        EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"group":)" + bad + "}").status, 422u) << bad;
    }
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"group":")" + std::string(65, 'x') + "\"}").status, 422u);
    EXPECT_EQ(call("PATCH", "/api/v1/axes/feeder", R"({"group":null})").status, 200u);
    EXPECT_EQ(call("GET", "/api/v1/axes/feeder").text.find("group"), std::string::npos);
}

}  // namespace
}  // namespace axisgate::http::test
