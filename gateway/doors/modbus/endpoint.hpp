// Reads `[modbus] bind` ("127.0.0.1:1502", "[::1]:1502", "localhost:1502", "0.0.0.0:502") as a TCP address, or reports the fault with the
// correct form. A bind address is a number, so no name server is asked.
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <string>
#include <string_view>

namespace axisgate::modbus {

struct Endpoint {
    boost::asio::ip::tcp::endpoint endpoint;
    std::string fault;  ///< empty: good
};
/// Port 0 lets the system choose.
[[nodiscard]] Endpoint parse_endpoint(std::string_view text);
/// "127.0.0.1:1502", "[::1]:1502"
[[nodiscard]] std::string to_text(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace axisgate::modbus
